//! The page of a design: what was generated, how often groups did what was wanted, what was published, what it looks like.

use super::export::{best, environment};
use super::plan::Plan;
use super::results::{NAMES, Results};
use crate::environment::{claims, trial};
use crate::report::of_run::paragraphs;
use crate::report::{Axis, Drawing, Drawings, Fact, Figure, Line, Lines, Listing, Page, Stroke, Table};
use measure::behaviours::Score;
use terrain::geometry::Geometry;
use terrain::{Construct, Environment, Grammar, Point};

/// Points of a way that is drawn, at most.
const POINTS: usize = 240;
/// Steps of a derivation that are drawn, at most.
const STEPS: usize = 12;

/// A share as a percentage with its interval.
fn percent(share: super::results::Share) -> String {
    match share.interval() {
        Some((low, high)) => {
            format!("{:.1} % ({:.1} to {:.1})", share.rate() * 100.0, low * 100.0, high * 100.0)
        }
        None => "\u{2013}".to_owned(),
    }
}

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>) -> Vec<String> {
    let counts = &results.survey.counts;
    let mut lines = vec![format!("{} generated, {} feasible", counts.generated, counts.feasible)];
    for row in rates(results).rows {
        lines.push(format!("{}, {}: {}; without the construct {}", row[0], row[1], row[2], row[3]));
    }
    if results.plan.stages() > 0 {
        let told = |row: Vec<String>| format!("{}, {}: alone {}; behind the others {}", row[1], row[0], row[2], row[4]);
        lines.extend(stages(results).rows.into_iter().map(told));
    }
    let judged = claims::rows(&results.plan.form.claim, results, results.plan.form.seed);
    lines.extend(judged.into_iter().map(|row| claims::line(&row)));
    lines
}

/// The page.
pub fn page(
    results: &Results<'_>,
    copies: &super::robustness::Copies,
    streams: &super::inverse::Streams,
    program: &str,
) -> Page {
    let plan = results.plan;
    let mut figures = vec![Figure::Listing(rates(results))];
    figures.extend((plan.stages() > 0).then(|| Figure::Listing(stages(results))));
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Beside what was published".into(),
            about: "Intervals and verdicts are by drawing the environments again 400 times, with replacement. The results are a \
                    reconstruction with the parameters of this file; equality with the source is not claimed."
                .into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, results, plan.form.seed),
        }));
    }
    figures.extend(super::inverse::figures(results, streams));
    figures.push(Figure::Listing(reasons(results)));
    figures.extend(values(results));
    figures.extend(super::robustness::figures(results, copies).into_iter().map(Figure::Lines));
    figures.extend(drawn(results).map(Figure::Drawings));
    figures.extend(derivation(results).map(Figure::Drawings));
    figures.extend(ways(results).map(Figure::Drawings));
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(plan).into_iter().chain(super::inverse::methods(plan)).collect(),
        summary: summary(results),
        figures,
        tables: vec![csv(results)],
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

fn summary(results: &Results<'_>) -> Vec<Fact> {
    let counts = &results.survey.counts;
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let rate = counts.pass_rate().map_or("\u{2013}".into(), |rate| format!("{:.1} %", rate * 100.0));
    vec![
        fact("Candidates generated", counts.generated.to_string()),
        fact("Feasible", format!("{} ({rate})", counts.feasible)),
        fact("Groups", results.plan.populations.len().to_string()),
        fact("Behaviours", results.plan.behaviour_names().len().to_string()),
        fact("Trials of each", results.plan.form.trials.to_string()),
    ]
}

fn rates(results: &Results<'_>) -> Listing {
    let plan = results.plan;
    let mut rows = Vec::new();
    for (one, behaviour) in plan.behaviour_names().into_iter().enumerate() {
        for (group, population) in plan.populations.iter().enumerate() {
            let valid = results.valid(group, one, None);
            let share = |all: f64| format!("{:.1} %", valid as f64 / all * 100.0);
            rows.push(vec![
                behaviour.to_owned(),
                population.name.clone(),
                percent(results.share(group, one, false, None)),
                if plan.form.control { percent(results.share(group, one, true, None)) } else { "not made".into() },
                format!("{valid} of {}", results.tried.len()),
                share(results.tried.len() as f64),
                share(results.survey.counts.generated as f64),
            ]);
        }
    }
    Listing {
        title: "How often groups did what was wanted".into(),
        about: "Shares of trials that succeeded, with 95 % Wilson intervals. The control has the same seeds and starts without \
                the construct. Tightness is the share of valid environments, of the feasible and of all generated ones."
            .into(),
        header: ["behaviour", "group", "with the construct", "without it", "valid", "tightness", "of all generated"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }
}

/// Each stage by itself beside the same stage behind the others.
fn stages(results: &Results<'_>) -> Listing {
    let plan = results.plan;
    let names = plan.behaviour_names();
    let fitness =
        |tried: Vec<f64>| measure::statistics::mean(&tried).map_or("\u{2013}".into(), |mean| format!("{mean:.2}"));
    let mut rows = Vec::new();
    for (group, population) in plan.populations.iter().enumerate() {
        for (stage, name) in names.iter().enumerate().take(plan.stages() + 1) {
            let joint = results.numbers(group, stage, None, |outcome| outcome.fitness);
            let alone = (stage < plan.stages()).then(|| {
                let all = results.alone(group, stage, None).into_iter().filter_map(|tried| tried.outcomes.first());
                let all = all.map(|outcome| outcome.fitness).filter(|fitness| fitness.is_finite()).collect();
                (percent(results.share_alone(group, stage, None)), fitness(all))
            });
            let (rate, mean) = alone.unwrap_or_else(|| {
                let rates = (0..plan.stages()).map(|stage| results.share_alone(group, stage, None).rate());
                let product: f64 = rates.product();
                let words =
                    if product.is_finite() { format!("{:.1} % (product)", product * 100.0) } else { "\u{2013}".into() };
                (words, "\u{2013}".into())
            });
            let share = results.share(group, stage, false, None);
            rows.push(vec![population.name.clone(), (*name).to_owned(), rate, mean, percent(share), fitness(joint)]);
        }
    }
    Listing {
        title: "Each stage alone, and behind the others".into(),
        about: "Alone, only the walls of the stage stand, and the group begins with the places and velocities in which it was handed \
                over by the stage before, alone too. Behind the others all walls stand and the group comes as it comes; a stage that \
                never began counts as a failure with fitness 0. The whole is the product of the fitnesses. Shares of trials that \
                succeeded, with 95 % Wilson intervals."
            .into(),
        header: ["group", "stage", "alone", "mean fitness", "behind the others", "mean fitness"].map(str::to_owned).to_vec(),
        rows,
    }
}

fn reasons(results: &Results<'_>) -> Listing {
    let counts = &results.survey.counts;
    let share = |count: u64| format!("{:.1} %", count as f64 / counts.generated.max(1) as f64 * 100.0);
    let mut rows = vec![vec!["feasible".to_owned(), counts.feasible.to_string(), share(counts.feasible)]];
    rows.extend(counts.reasons.iter().map(|(reason, count)| vec![reason.clone(), count.to_string(), share(*count)]));
    Listing {
        title: "What became of the candidates".into(),
        about: String::new(),
        header: ["outcome", "candidates", "share"].map(str::to_owned).to_vec(),
        rows,
    }
}

/// All values of behaviours that are no yes or no, along one line.
fn values(results: &Results<'_>) -> Option<Figure> {
    let plan = results.plan;
    let mut lines = Vec::new();
    for (one, name) in plan.behaviour_names().into_iter().enumerate() {
        // stages have figures of their own
        let Some(own) = one.checked_sub(if plan.stages() > 0 { plan.stages() + 1 } else { 0 }) else { continue };
        let binary =
            plan.populations.first().zip(results.survey.feasible.first()).is_none_or(|(group, (_, construct))| {
                plan.behaviours(group, construct, true)
                    .is_ok_and(|all| matches!(all.behaviours.get(own).map(|own| &own.score), Some(Score::Binary(_))))
            });
        if binary {
            continue;
        }
        for (group, population) in plan.populations.iter().enumerate() {
            let mut x = results.numbers(group, one, None, |outcome| outcome.value);
            x.sort_by(f64::total_cmp);
            let y = (1..=x.len()).map(|k| Some(k as f64 / x.len() as f64)).collect();
            lines.push(Line { name: format!("{name}, {}", population.name), x, y });
        }
    }
    (!lines.is_empty()).then(|| {
        Figure::Lines(Lines {
            id: "values".into(),
            title: "All values along one line".into(),
            about: "Share of trials whose signal was at most this at the end.".into(),
            x: Axis { label: "value".into(), unit: String::new(), range: None },
            y: Axis { label: "share of trials".into(), unit: String::new(), range: Some((0.0, 1.0)) },
            lines,
        })
    })
}

fn methods(plan: &Plan) -> Vec<String> {
    let form = &plan.form;
    let populations: Vec<String> = plan
        .populations
        .iter()
        .map(|group| {
            let models: Vec<String> =
                group.scenario.group.0.iter().map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
            let about = if group.about.is_empty() { String::new() } else { format!(" ({})", group.about) };
            format!("{}{about}: {}, {} steps", group.name, models.join(" and "), group.steps)
        })
        .collect();
    let behaviours: Vec<String> = plan
        .behaviour_names()
        .iter()
        .zip(plan.behaviour_words())
        .map(|(name, words)| format!("{name}: {words}"))
        .collect();
    let stopping = match &form.sequential {
        None => format!("Each environment is tried {} times", form.trials),
        Some(test) => format!(
            "Each environment is tried until Wald's test of {} against {} decides, at most {} times",
            test.lower, test.higher, form.trials
        ),
    };
    vec![
        format!(
            "Candidates come from the {} in the workspace `{}`. Groups: {}.",
            plan.source.name(),
            plan.workspace.workspace.name,
            populations.join("; ")
        ),
        format!("What is wanted: {}.", behaviours.join("; ")),
        format!(
            "{stopping}. A trial succeeds with a fitness of at least {}, and ends early once nothing can change. Seeds are those \
             of the candidate's number and the trial's, the same for all groups and for the control.",
            form.success
        ),
        "Nothing here equals the source's experiment: its parameters, starts and rules are not printed. The results are a \
         reconstruction with the parameters of the file below."
            .to_owned(),
        format!(
            "Statements are expressions over {}.",
            NAMES.iter().map(|(name, about)| format!("`{name}` ({about})")).collect::<Vec<_>>().join(", ")
        ),
    ]
}

fn csv(results: &Results<'_>) -> Table {
    let mut csv = String::from("behaviour,population,candidates,trials,successes,rate,control_rate,valid\n");
    for (one, behaviour) in results.plan.behaviour_names().into_iter().enumerate() {
        for (group, population) in results.plan.populations.iter().enumerate() {
            let (share, control) = (results.share(group, one, false, None), results.share(group, one, true, None));
            csv += &format!(
                "{behaviour},{},{},{},{},{},{},{}\n",
                population.name,
                results.tried.len(),
                share.trials,
                share.successes,
                share.rate(),
                if control.trials > 0 { control.rate().to_string() } else { String::new() },
                results.valid(group, one, None)
            );
        }
    }
    Table { file: "rates.csv".into(), about: "The shares of successes.".into(), csv }
}

/// Geometry as strokes and discs of a drawing.
pub(crate) fn put<'a>(drawing: &mut Drawing, geometry: impl IntoIterator<Item = &'a Geometry>, stroke: Stroke) {
    for geometry in geometry {
        match geometry {
            Geometry::Disc { centre, radius } => drawing.discs.push((stroke == Stroke::Built, centre.0, *radius)),
            other => drawing.strokes.extend(other.segments().iter().map(|wall| (stroke, vec![wall.from.0, wall.to.0]))),
        }
    }
}

/// An environment as a drawing.
pub(crate) fn of_environment(environment: &Environment, caption: String) -> Drawing {
    let mut drawing = Drawing { caption, ..Drawing::default() };
    put(&mut drawing, &environment.workspace.geometry, Stroke::There);
    put(&mut drawing, environment.construct.geometry(), Stroke::Built);
    drawing.marks = environment.construct.markers.iter().map(|marker| marker.pose.at.0).collect();
    drawing
}

/// Doors, dashed.
pub(crate) fn put_doors(drawing: &mut Drawing, plan: &Plan, construct: &Construct) {
    let doors = plan.doors(construct).into_iter().map(|door| door.wall);
    drawing.strokes.extend(doors.map(|wall| (Stroke::Structure, vec![wall.from.0, wall.to.0])));
}

/// The first feasible environments, with what groups did in them.
fn drawn(results: &Results<'_>) -> Option<Drawings> {
    let plan = results.plan;
    let caption = |attempt: u64| {
        let mut words = Vec::new();
        for (one, behaviour) in plan.behaviour_names().into_iter().enumerate() {
            for (group, population) in plan.populations.iter().enumerate() {
                let trials = results.trials.get(&attempt).and_then(|all| all.get(group))?;
                let share = super::results::Share::of(&trials.built, one, plan.form.success);
                words.push(format!("{behaviour} {}: {}/{}", population.name, share.successes, share.trials));
            }
        }
        Some(words.join(", "))
    };
    let one = |(attempt, construct): &(u64, Construct)| {
        let words = caption(*attempt).unwrap_or_default();
        let mut drawing = of_environment(&environment(plan, construct), format!("{attempt}: {words}"));
        put_doors(&mut drawing, plan, construct);
        drawing
    };
    let drawings: Vec<Drawing> = results.survey.feasible.iter().take(plan.form.show).map(one).collect();
    (!drawings.is_empty()).then(|| Drawings {
        title: "Environments".into(),
        about: "The first feasible candidates by their numbers, with successes and trials.".into(),
        bounds: None,
        drawings,
    })
}

/// The derivation of the first feasible candidate, step by step.
fn derivation(results: &Results<'_>) -> Option<Drawings> {
    let crate::environment::candidates::Source::Grammar(grammar) = &results.plan.source else { return None };
    let (attempt, construct) = results.survey.feasible.first()?;
    let derivation = construct.provenance.derivation.as_ref()?;
    let drawing = |step: usize| {
        let rule = step.checked_sub(1).and_then(|k| derivation.steps.get(k));
        let caption = rule.map_or_else(|| "start".to_owned(), |rule| format!("{step}: {}", rule.rule));
        let mut drawing = Drawing { caption, ..Drawing::default() };
        for instance in derivation.after(step) {
            let stroke = match grammar.shapes.get(instance.shape).map(|shape| shape.kind) {
                Some(terrain::grammar::Kind::Terminal) => Stroke::Built,
                _ => Stroke::Structure,
            };
            put(&mut drawing, &instance.geometry(grammar), stroke);
        }
        drawing
    };
    let drawings: Vec<Drawing> = (0..=derivation.steps.len().min(STEPS)).map(drawing).collect();
    let name = |grammar: &Grammar| grammar.name.clone();
    Some(Drawings {
        title: format!("How candidate {attempt} came about"),
        about: format!(
            "The derivation by the grammar `{}`, step by step; structure that is not built is dashed.",
            name(grammar)
        ),
        bounds: drawings.last().and_then(crate::report::bounds),
        drawings,
    })
}

/// The ways of the members in the best environment of each group and behaviour.
fn ways(results: &Results<'_>) -> Option<Drawings> {
    let plan = results.plan;
    if plan.form.show == 0 {
        return None;
    }
    let mut drawings = Vec::new();
    for (one, behaviour) in plan.behaviour_names().into_iter().enumerate() {
        for (group, population) in plan.populations.iter().enumerate() {
            let Some((attempt, share)) = best(results, group, one, 1).into_iter().next() else { continue };
            let Some((_, construct)) = results.survey.feasible.iter().find(|(own, _)| *own == attempt) else {
                continue;
            };
            let words = format!(
                "{behaviour}, {}: candidate {attempt}, {} of {}",
                population.name, share.successes, share.trials
            );
            let environment = environment(plan, construct);
            let scenario = population.among(environment.geometry());
            let mut course: Vec<Vec<Option<Point>>> = Vec::new();
            let Ok(wanted) = plan.behaviours(population, construct, true) else { continue };
            let seed = plan.seed_of(attempt, 1);
            // a trial that was possible is possible again
            let _ =
                trial::relayed(&scenario, population, &wanted, seed, &|| false, &mut |now| course.push(now.to_vec()));
            let mut drawing = of_environment(&environment, words);
            put_doors(&mut drawing, plan, construct);
            add_ways(&mut drawing, &course);
            drawings.push(drawing);
        }
    }
    (!drawings.is_empty()).then(|| Drawings {
        title: "Ways in the best environments".into(),
        about: "The first trial in the environment with most successes; the ways go from blue to orange with time."
            .into(),
        bounds: None,
        drawings,
    })
}

/// The ways of members, cut into parts of the time.
pub(crate) fn add_ways(drawing: &mut Drawing, course: &[Vec<Option<Point>>]) {
    let members = course.first().map_or(0, Vec::len);
    let every = course.len().div_ceil(POINTS).max(1);
    let parts = crate::report::TIMES;
    for part in 0..parts {
        let from = part * course.len() / parts;
        // one point more, so that the parts meet
        let to = ((part + 1) * course.len() / parts + 1).min(course.len());
        for member in 0..members {
            let own = (from..to).step_by(every).chain(to.checked_sub(1)).filter_map(|k| course[k][member]);
            let way: Vec<[f64; 2]> = own.map(|at| at.0).collect();
            if way.len() > 1 {
                drawing.strokes.push((Stroke::Way(part), way));
            }
        }
    }
}
