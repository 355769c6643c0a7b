//! The page of an optimisation: how good the best came to be, by which method, what it looks like, what was stated.

use super::form::{Objective, Search};
use super::plan::{Plan, SearchAxis};
use super::results::{NAMES, Results, Run, mean};
use super::trials::{self, Found, Purpose};
use crate::design::report::{add_ways, put};
use crate::environment::{claims, trial};
use crate::report::of_run::paragraphs;
use crate::report::{Axis, Drawing, Drawings, Fact, Figure, Line, Lines, Listing, Page, Stroke, Table, short};
use measure::statistics::wilson;
use search::elites::Elite;
use terrain::{Construct, Point};

/// Points of a line over evaluations, at most.
const POINTS: usize = 200;

fn percent(found: &Found) -> String {
    match wilson(found.successes, found.trials, 0.95) {
        Ok(interval) => {
            format!("{:.1} % ({:.1} to {:.1})", found.rate() * 100.0, interval.low * 100.0, interval.high * 100.0)
        }
        Err(_) => "\u{2013}".to_owned(),
    }
}

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>) -> Vec<String> {
    let of = |row: Vec<String>| format!("{}: {} in new trials, {} of wall", row[0], row[2], row[4]);
    let judged = claims::rows(&results.plan.form.claim, results, results.plan.form.seed);
    methods(results).rows.into_iter().map(of).chain(judged.into_iter().map(|row| claims::line(&row))).collect()
}

/// The page.
pub fn page(results: &Results<'_>, program: &str) -> Page {
    let plan = results.plan;
    let mut figures = vec![Figure::Lines(progress(results)), Figure::Listing(methods(results))];
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Statements".into(),
            about: "Intervals and verdicts are by drawing the runs again 400 times, with replacement.".into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, results, plan.form.seed),
        }));
    }
    figures.extend(constructs(results).map(Figure::Drawings));
    figures.extend(lighter(results).map(Figure::Drawings));
    figures.extend((0..plan.form.method.0.len()).filter_map(|method| archive(results, method)).map(Figure::Drawings));
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: described(plan),
        summary: summary(results),
        figures,
        tables: vec![csv(results)],
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

fn summary(results: &Results<'_>) -> Vec<Fact> {
    let plan = results.plan;
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let mut facts = vec![
        fact("Methods", plan.form.method.0.len().to_string()),
        fact("Runs of each", plan.runs.to_string()),
        fact("Evaluations of each", plan.evaluations.to_string()),
    ];
    if let Some((method, run)) = results.best()
        && let Some((_, found)) = results.runs[method][run].best
    {
        facts.push(fact("Best construct", format!("{} of {}", found.successes, found.trials)));
    }
    facts.extend(results.control.map(|found| fact("Without a construct", percent(&found))));
    facts.extend(results.saved().map(|saved| fact("Material saved", format!("{:.0} %", saved * 100.0))));
    facts
}

/// The best score so far, by evaluations: the mean over the runs of each method.
fn progress(results: &Results<'_>) -> Lines {
    let plan = results.plan;
    let every = plan.evaluations.div_ceil(POINTS).max(1);
    let line = |(name, runs): (&str, &Vec<Run>)| {
        let mut best: Vec<f64> = vec![f64::NEG_INFINITY; runs.len()];
        let (mut x, mut y) = (Vec::new(), Vec::new());
        for number in 0..plan.evaluations {
            for (best, run) in best.iter_mut().zip(runs) {
                *best = run.evaluations.get(number).map_or(*best, |(_, found)| best.max(found.score));
            }
            if (number + 1) % every == 0 || number + 1 == plan.evaluations {
                let mean = mean(best.iter().copied());
                x.push((number + 1) as f64);
                // before a first construct there is nothing to show
                y.push(Some(mean).filter(|mean| *mean > Found::NOTHING.score / runs.len() as f64 + 1.0));
            }
        }
        Line { name: name.to_owned(), x, y }
    };
    Lines {
        id: "progress".into(),
        title: "The best score so far".into(),
        about: "Mean over the runs of each method. It is the best of noisy scores; what new trials found stands below."
            .into(),
        x: Axis { label: "evaluations".into(), unit: String::new(), range: None },
        y: Axis { label: objective(plan).into(), unit: String::new(), range: None },
        lines: plan.methods().into_iter().zip(&results.runs).map(line).collect(),
    }
}

fn objective(plan: &Plan) -> &'static str {
    match (plan.form.objective, plan.form.material > 0.0) {
        (Objective::Fitness, false) => "mean fitness",
        (Objective::Rate, false) => "share of successes",
        (_, true) => "score",
    }
}

fn methods(results: &Results<'_>) -> Listing {
    let row = |(method, name): (usize, &str)| {
        let bests = results.bests(method, None);
        let rates: Vec<f64> = bests.iter().map(Found::rate).collect();
        let (low, high) =
            rates.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &rate| (low.min(rate), high.max(rate)));
        let of = |of: &dyn Fn(&Found) -> f64| {
            let mean = mean(bests.iter().map(of));
            if mean.is_finite() { short(mean) } else { "\u{2013}".to_owned() }
        };
        let range = if low <= high { format!("{} to {}", short(low), short(high)) } else { "\u{2013}".to_owned() };
        let kinds = results.archive(method, None).map_or("\u{2013}".to_owned(), |(kinds, _)| short(kinds));
        vec![name.to_owned(), of(&|found| found.score), of(&Found::rate), range, of(&|found| found.material), kinds]
    };
    Listing {
        title: "What new trials found".into(),
        about: format!(
            "Of the {} best candidates of each run the best in {} trials each, tried again in as many new ones: means over runs.",
            results.plan.form.finalists, results.plan.form.confirm_trials
        ),
        header: ["method", "score", "share of successes", "worst to best run", "length of wall", "kinds reached"]
            .map(str::to_owned)
            .to_vec(),
        rows: results.plan.methods().into_iter().enumerate().map(row).collect(),
    }
}

fn described(plan: &Plan) -> Vec<String> {
    let ends = |axis: &SearchAxis| format!("{} from {} to {}", axis.name, short(axis.axis.low), short(axis.axis.high));
    let over = plan.over(&ends);
    let filter = if plan.form.filter.is_empty() {
        ""
    } else {
        " What a filter does not let through is not tried, and counts as an evaluation."
    };
    let models = plan.population.scenario.group.0.iter();
    let models: Vec<String> = models.map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
    let trials = match &plan.form.robust {
        None => format!("{} trials", plan.form.trials),
        Some(robust) => format!(
            "{} copies changed by `{}` of {}, {} trials each; the {} quantile of the copies counts",
            robust.copies,
            robust.by.word(),
            robust.size,
            plan.form.trials,
            robust.quantile
        ),
    };
    let cost = match plan.form.material {
        0.0 => String::new(),
        cost => format!(", less {cost} for each unit of length of wall"),
    };
    vec![
        format!(
            "Searched: {} in the workspace `{}`, over {over}.{filter} The group: {}, {} steps.",
            plan.builder,
            plan.workspace.workspace.name,
            models.join(" and "),
            plan.population.steps
        ),
        format!(
            "What is wanted: {}. A score is the {}{cost}. An evaluation is {trials}; candidates of a generation meet in the same \
             trials, and every method has equally many evaluations.",
            plan.form.behaviour.words(),
            match plan.form.objective {
                Objective::Fitness => "mean fitness",
                Objective::Rate => "share of successes",
            }
        ),
        format!(
            "Statements are expressions over {}.",
            NAMES.iter().map(|(name, about)| format!("`{name}` ({about})")).collect::<Vec<_>>().join(", ")
        ),
    ]
}

fn csv(results: &Results<'_>) -> Table {
    let names: Vec<&str> = results.plan.axes.iter().map(|axis| axis.name.as_str()).collect();
    let mut csv = format!("method,run,{},successes,trials,rate,score,material\n", names.join(","));
    for (name, runs) in results.plan.methods().into_iter().zip(&results.runs) {
        for (number, run) in runs.iter().enumerate() {
            let (Some(point), Some((_, found))) = (run.point(), run.best) else { continue };
            let values: Vec<String> = point.iter().map(ToString::to_string).collect();
            csv += &format!(
                "{name},{},{},{},{},{},{},{}\n",
                number + 1,
                values.join(","),
                found.successes,
                found.trials,
                found.rate(),
                found.score,
                found.material
            );
        }
    }
    Table { file: "best.csv".into(), about: "The best of each run, as new trials found it.".into(), csv }
}

/// A construct in its workspace.
pub(crate) fn drawing(plan: &Plan, construct: &Construct, caption: String) -> Drawing {
    let mut drawing = Drawing { caption, ..Drawing::default() };
    put(&mut drawing, &plan.workspace.workspace.geometry, Stroke::There);
    put(&mut drawing, construct.geometry(), Stroke::Built);
    drawing.marks = construct.markers.iter().map(|marker| marker.pose.at.0).collect();
    drawing
}

/// The run of a method whose best new trials found best.
fn best_run<'a>(results: &'a Results<'_>, method: usize) -> Option<(usize, &'a Run, Found)> {
    let all = results.runs[method].iter().enumerate().filter_map(|(number, run)| Some((number, run, run.best?.1)));
    all.reduce(|best, other| if other.2.score > best.2.score { other } else { best })
}

/// The best construct of each method, with the ways of the group.
fn constructs(results: &Results<'_>) -> Option<Drawings> {
    let plan = results.plan;
    let mut drawings = Vec::new();
    for (method, name) in plan.methods().into_iter().enumerate() {
        let Some((number, run, found)) = best_run(results, method) else { continue };
        let Some(construct) = run.point().and_then(|point| plan.construct(point).ok()) else { continue };
        let caption = format!("{name}, run {}: {} of {}", number + 1, found.successes, found.trials);
        let mut drawing = drawing(plan, &construct, caption);
        if let Ok(behaviour) = plan.behaviour(&construct, true) {
            let there = plan.workspace.workspace.geometry.iter();
            let scenario = plan.population.among(there.chain(construct.geometry()));
            let mut course: Vec<Vec<Option<Point>>> = Vec::new();
            let seed = trials::seed_of(plan, Purpose::Report, number as u64, 0);
            // a trial that was possible is possible again
            let _ = trial::run(&scenario, &plan.population, &[behaviour], seed, &|| false, &mut |now| {
                course.push(now.to_vec());
            });
            add_ways(&mut drawing, &course);
        }
        drawings.push(drawing);
    }
    (!drawings.is_empty()).then(|| Drawings {
        title: "The best constructs".into(),
        about:
            "Of each method that of its best run, with the ways of the first new trial, from blue to orange with time."
                .into(),
        bounds: None,
        drawings,
    })
}

fn lighter(results: &Results<'_>) -> Option<Drawings> {
    let lighter = results.lighter.as_ref()?;
    let one = |(construct, found): &(Construct, Found), word: &str| {
        let caption = format!("{word}: {} of wall, {} of {}", short(found.material), found.successes, found.trials);
        drawing(results.plan, construct, caption)
    };
    Some(Drawings {
        title: "Made lighter".into(),
        about: format!(
            "{} lighter constructs were tried. One stays where the lower end of the interval of its share of successes is at least \
             {}.",
            lighter.tried,
            results.plan.form.lighten.as_ref().map_or(0.0, |form| form.least)
        ),
        bounds: None,
        drawings: vec![one(&lighter.before, "as found"), one(&lighter.after, "made lighter")],
    })
}

/// The best of every kind in the first run of an archive.
fn archive(results: &Results<'_>, method: usize) -> Option<Drawings> {
    let plan = results.plan;
    let Search::MapElites(form) = &plan.form.method.0[method].1 else { return None };
    let run = results.runs[method].first()?;
    let mut elites: Vec<&Elite> = run.elites.iter().collect();
    elites.sort_by(|a, b| b.score.total_cmp(&a.score).then(a.cell.cmp(&b.cell)));
    let one = |elite: &&Elite| {
        let construct = plan.construct(&elite.point).ok()?;
        let kinds = form.kind.0.iter().zip(&elite.descriptors);
        let kinds: Vec<String> = kinds.map(|((name, _), value)| format!("{name} {}", short(*value))).collect();
        Some(drawing(plan, &construct, format!("{}: score {}", kinds.join(", "), short(elite.score))))
    };
    let drawings: Vec<Drawing> = elites.iter().take(plan.form.show).filter_map(one).collect();
    (!drawings.is_empty()).then(|| Drawings {
        title: format!("The best of every kind: {}", plan.methods()[method]),
        about: format!("Of the first run, {} kinds of {} cells; the best scores first.", run.elites.len(), form.cells),
        bounds: None,
        drawings,
    })
}

/// What is written as files: a stem, a construct, the seed of a trial, a title.
pub fn exported(results: &Results<'_>) -> Vec<(String, Construct, u64, String)> {
    let plan = results.plan;
    let mut files = Vec::new();
    for (method, name) in plan.methods().into_iter().enumerate() {
        let Some((number, run, found)) = best_run(results, method) else { continue };
        let Some(construct) = run.point().and_then(|point| plan.construct(point).ok()) else { continue };
        let title = format!("{}: {name}, {} of {}", plan.form.title, found.successes, found.trials);
        files.push((name.to_owned(), construct, trials::seed_of(plan, Purpose::Report, number as u64, 0), title));
    }
    if let Some(lighter) = &results.lighter {
        let (construct, found) = &lighter.after;
        let title = format!("{}: made lighter, {} of {}", plan.form.title, found.successes, found.trials);
        files.push(("lighter".into(), construct.clone(), trials::seed_of(plan, Purpose::Lighten, 0, 0), title));
    }
    files
}
