//! The page of a prediction: predicted beside simulated shares, calibration, courses of both, scores, what was stated.

use super::execute::{foretold, starts};
use super::model::{Model, OUTPUTS};
use super::plan::BASELINES;
use super::results::{Item, NAMES, Results, Score};
use super::tables::{Courses, parameters, scored, value};
use crate::design::report::{add_ways, put};
use crate::environment::claims;
use crate::report::of_run::paragraphs;
use crate::report::{Axis, Drawing, Drawings, Fact, Figure, Line, Lines, Listing, Page, Stroke, Table, short};
use terrain::Point;

/// Ways in a drawing, at most.
const WAYS: usize = 20;
/// Parts of the range of predicted chances.
const BINS: usize = 5;

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for test in &results.tests {
        let items: Vec<&Item> = test.items.iter().collect();
        for (by, name) in results.plan.predictors().into_iter().enumerate() {
            let score = |score| short(results.score(score, &items, by));
            lines.push(format!(
                "{} by {name}: Brier score {}, mean absolute error {}, rank correlation {}",
                test.name,
                score(Score::Brier),
                score(Score::Mae),
                score(Score::Spearman)
            ));
        }
    }
    let judged = claims::rows(&results.plan.form.claim, results, results.plan.form.seed);
    lines.extend(judged.into_iter().map(|row| claims::line(&row)));
    lines
}

/// The page.
pub(super) fn page(results: &Results<'_>, courses: Courses<'_>, models: &[Option<Model>], program: &str) -> Page {
    let plan = results.plan;
    let mut figures: Vec<Figure> = Vec::new();
    for test in 0..results.tests.len() {
        figures.push(Figure::Lines(observed(results, test)));
        figures.push(Figure::Lines(calibration(results, test)));
    }
    figures.push(Figure::Listing(scores(results)));
    if let Some(drawn) = ways(results, courses, models) {
        figures.push(Figure::Drawings(drawn));
    }
    figures.push(Figure::Listing(fits(results)));
    if plan.form.control_trials > 0 {
        figures.push(Figure::Listing(bare(results)));
    }
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Statements".into(),
            about: "Each is judged by drawing the constructs of the tests again; models and training constructs are as they are.".into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, results, plan.form.seed),
        }));
    }
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(results),
        summary: summary(results),
        figures,
        tables: vec![csv(results)],
        command: format!("flockworks run {}", plan.sources.name(0)),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {}", plan.form.seed),
    }
}

fn share_axis(label: &str) -> Axis {
    Axis { label: label.into(), unit: String::new(), range: Some((0.0, 1.0)) }
}

/// The line on which both are equal.
fn identity() -> Line {
    Line { name: "equal".into(), x: vec![0.0, 1.0], y: vec![Some(0.0), Some(1.0)] }
}

/// Points that no line joins.
fn dots(name: &str, mut points: Vec<(f64, f64)>) -> Line {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut line = Line { name: name.to_owned(), x: Vec::new(), y: Vec::new() };
    for (x, y) in points {
        line.x.extend([x, x]);
        line.y.extend([Some(y), None]);
    }
    line
}

/// Predictors whose chances differ between constructs, with their places.
fn told<'a>(results: &'a Results<'_>) -> impl Iterator<Item = (usize, &'a str)> {
    let plain = usize::from(results.plan.lots[0].drawn.is_empty());
    results.plan.predictors().into_iter().enumerate().skip(1 + plain)
}

fn observed(results: &Results<'_>, test: usize) -> Lines {
    let own = &results.tests[test];
    let of = |(by, name): (usize, &str)| {
        dots(name, own.items.iter().map(|item| (item.chances[by], item.simulated.rate())).collect())
    };
    Lines {
        id: format!("observed-{}", own.name),
        title: format!("{}: predicted and simulated", own.name),
        about: format!(
            "A dot for each of {} constructs and each predictor; on the line both shares are equal.",
            own.items.len()
        ),
        x: share_axis("predicted share of successes"),
        y: share_axis("simulated share of successes"),
        lines: std::iter::once(identity()).chain(told(results).map(of)).collect(),
    }
}

fn calibration(results: &Results<'_>, test: usize) -> Lines {
    let own = &results.tests[test];
    let of = |(by, name): (usize, &str)| {
        let bin = |item: &Item| ((item.chances[by] * BINS as f64) as usize).min(BINS - 1);
        let mean = |k: usize| {
            let inside: Vec<&Item> = own.items.iter().filter(|item| bin(item) == k).collect();
            let count = inside.len() as f64;
            let told = inside.iter().map(|item| item.chances[by]).sum::<f64>() / count;
            let found = inside.iter().map(|item| item.simulated.rate()).sum::<f64>() / count;
            (!inside.is_empty()).then_some((told, found))
        };
        let points: Vec<(f64, f64)> = (0..BINS).filter_map(mean).collect();
        let (x, y) = points.into_iter().map(|(x, y)| (x, Some(y))).unzip();
        Line { name: name.to_owned(), x, y }
    };
    Lines {
        id: format!("calibration-{}", own.name),
        title: format!("{}: calibration", own.name),
        about: format!("Means over the constructs in each of {BINS} equal parts of the range of predicted shares."),
        x: share_axis("mean predicted share"),
        y: share_axis("mean simulated share"),
        lines: std::iter::once(identity()).chain(told(results).map(of)).collect(),
    }
}

fn scores(results: &Results<'_>) -> Listing {
    let mut rows = Vec::new();
    for (test, own) in results.tests.iter().enumerate() {
        for (by, name) in results.plan.predictors().into_iter().enumerate() {
            let mut row = vec![own.name.clone(), name.to_owned()];
            row.extend(Score::ALL.into_iter().map(|score| {
                let (value, low, high) = scored(results, test, by, score);
                if low.is_finite() {
                    format!("{} ({} to {})", short(value), short(low), short(high))
                } else {
                    short(value)
                }
            }));
            rows.push(row);
        }
    }
    let sampling = |test: &super::results::Test| {
        let items: Vec<&Item> = test.items.iter().collect();
        format!("{} in {}", short(results.sampling(&items)), test.name)
    };
    let sampling: Vec<String> = results.tests.iter().map(sampling).collect();
    Listing {
        title: "Scores".into(),
        about: format!(
            "With 95 % intervals, by drawing the constructs of a test again. The number of trials alone gives a mean error of {} to whoever \
             knows the chances.",
            sampling.join(", ")
        ),
        header: ["test", "by", "Brier score", "log loss", "mean absolute error", "bias", "rank correlation"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    }
}

/// Constructs with the ways of the centroid in simulated trials, and in predicted ones.
fn ways(results: &Results<'_>, courses: Courses<'_>, models: &[Option<Model>]) -> Option<Drawings> {
    let plan = results.plan;
    let mut drawings = Vec::new();
    for test in &results.tests {
        let begun = starts(plan, test.lot, WAYS.min(plan.predicted)).ok()?;
        for item in test.items.iter().take(plan.form.show) {
            let built = plan.built(test.lot, item.number).ok()?;
            let parameters = parameters(results);
            let values = parameters
                .iter()
                .map(|(place, name, _)| format!("{name} {}", short(value(results, test.lot, item, *place))));
            let values = values.collect::<Vec<_>>().join(", ");
            let mut draw = |what: &str, all: &[super::course::Course]| {
                let mut drawing = Drawing {
                    caption: format!("{} {} ({values}): {what}", test.name, item.number),
                    ..Drawing::default()
                };
                put(&mut drawing, &plan.workspace.workspace.geometry, Stroke::There);
                put(&mut drawing, built.construct.geometry(), Stroke::Built);
                let longest = all.iter().map(|course| course.looks.len()).max().unwrap_or(0);
                let at = |look: usize| -> Vec<Option<Point>> {
                    all.iter().take(WAYS).map(|course| course.looks.get(look).map(|state| state.at)).collect()
                };
                add_ways(&mut drawing, &(0..longest).map(at).collect::<Vec<_>>());
                drawings.push(drawing);
            };
            let simulated = item.simulated;
            let what = format!("simulated, {} of {} succeed", simulated.successes, simulated.trials);
            draw(&what, courses(test.lot, item.number));
            // one model, so that both stand side by side
            let (Some((name, _)), Some(Some(model))) = (plan.form.model.0.first(), models.first()) else { continue };
            let all = foretold(plan, model, test.lot, Some(item.number), &begun, &|| false).ok()??;
            draw(&format!("by {name}, {} succeed", short(item.chances[BASELINES.len()])), &all);
        }
    }
    (!drawings.is_empty()).then(|| Drawings {
        title: "Ways of the group".into(),
        about: format!("The ways of the centroid in at most {WAYS} simulated trials, and in as many that the first model predicts, from blue to orange with \
             time; a trial ends when it is decided."),
        bounds: None,
        drawings,
    })
}

fn fits(results: &Results<'_>) -> Listing {
    let row = |(fit, (name, _)): (&super::model::Fit, &(String, super::form::ModelForm))| {
        let both = |k: usize| {
            let (linear, cells) = fit.explained[k];
            format!("{} / {}", short(linear), short(cells))
        };
        let mut row = vec![name.clone(), fit.transitions.to_string(), fit.cells.to_string()];
        row.extend((0..OUTPUTS.len()).map(both));
        row.push(format!("{:.2} %", fit.through * 100.0));
        row
    };
    let names = OUTPUTS.iter().map(|(name, ..)| name.replace('_', " "));
    let header = ["model", "transitions", "cells"].map(str::to_owned).into_iter().chain(names);
    let about: Vec<String> =
        OUTPUTS.iter().map(|(name, _, about)| format!("{}: {about}", name.replace('_', " "))).collect();
    Listing {
        title: "What a transition is told by".into(),
        about: format!(
            "Shares of the variance of what the next look brings, in the frame of the heading, that are explained: by the linear law, and with the \
             means of the cells. The rest is drawn. {}. Through walls: transitions in which the centroid was behind a wall afterwards.",
            about.join("; ")
        ),
        header: header.chain(["through walls".to_owned()]).collect(),
        rows: results.fits.iter().zip(&results.plan.form.model.0).map(row).collect(),
    }
}

fn bare(results: &Results<'_>) -> Listing {
    let share = |share: crate::design::results::Share| {
        let interval =
            share.interval().map_or_else(String::new, |(low, high)| format!(" ({} to {})", short(low), short(high)));
        format!("{} of {}{interval}", short(share.rate()), share.trials)
    };
    let models =
        results.plan.form.model.0.iter().zip(&results.bare.1).map(|((name, _), of)| vec![name.clone(), share(*of)]);
    Listing {
        title: "Without a construct".into(),
        about: "What the group does where nothing is built: shares of successes.".into(),
        header: ["", "successes"].map(str::to_owned).to_vec(),
        rows: std::iter::once(vec!["simulated".to_owned(), share(results.bare.0)]).chain(models).collect(),
    }
}

fn summary(results: &Results<'_>) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.into(), value };
    let mut facts = vec![
        fact("Constructs to fit to", results.training.len().to_string()),
        fact("Simulated trials of each", results.plan.trials.to_string()),
        fact("Predicted trials of each", results.plan.predicted.to_string()),
    ];
    facts.extend(
        results.tests.iter().map(|test| fact(&format!("Constructs of {}", test.name), test.items.len().to_string())),
    );
    facts
}

fn methods(results: &Results<'_>) -> Vec<String> {
    let plan = results.plan;
    let form = &plan.form;
    let lot = |lot: &super::plan::Lot| {
        let models = lot.population.scenario.group.0.iter();
        let models: Vec<String> = models.map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
        let ranges: Vec<String> =
            lot.drawn.iter().map(|one| format!("{} from {} to {}", one.name, one.axis.low, one.axis.high)).collect();
        let about =
            if lot.population.about.is_empty() { String::new() } else { format!(" ({})", lot.population.about) };
        let ranges = if ranges.is_empty() { "nothing".to_owned() } else { ranges.join(", ") };
        format!(
            "{}{about}: {} constructs, drawn {ranges}, {}",
            lot.population.name,
            lot.constructs,
            models.join(" and ")
        )
    };
    let models: Vec<String> = form
        .model
        .0
        .iter()
        .map(|(name, model)| {
            let cells = if model.cells {
                format!("cells of {} transitions at least", model.least)
            } else {
                "no cells".to_owned()
            };
            format!("{name}: {} sectors that see {} far, {cells}", model.sectors, model.reach)
        })
        .collect();
    let lots: Vec<String> = plan.lots.iter().map(lot).collect();
    vec![
        format!(
            "The schema `{}` in the workspace `{}`. {}. Of the first, a share of {} is held out; models are fitted to the others.",
            plan.schema.card().id,
            plan.workspace.workspace.name,
            lots.join(". "),
            form.held_out
        ),
        format!("What is wanted: {}. {} simulated trials of each construct.", form.behaviour.words(), plan.trials),
        format!(
            "The state of the group at every {} steps: centroid, direction and length of the mean heading, the square root of the matrix of mean \
             products of offsets from the centroid (spread), the share of the largest group (members at most {} apart are linked). In the frame \
             of the heading, the next state is a linear law (least squares) of polarisation, spread, largest group and the nearness of the nearest wall \
             in each sector around the centroid, and a deviation from it, drawn whole from those seen in the same cell: the leaves of a regression tree \
             over the same numbers. A deviation that would lead the centroid through a wall is drawn again, eight times at most; then it stays \
             where it is. {}.",
            form.every,
            form.link,
            models.join("; ")
        ),
        "A predicted trial begins as a trial does and goes on from state to state among the walls of the construct; no agent is simulated. What is \
         wanted is asked of as many members as the group has, on an ellipse that has its centroid and spread, before walls that hide their places \
         from the centroid; between two looks they go straight. So the number and the places of groups within the group are not told, but for how \
         far the ellipse reaches."
            .to_owned(),
        format!(
            "Beside the models: `{}`, the share of successes over all trials of the training constructs, and `{}`, the mean of the {} training \
             constructs that are nearest by parameters (each by its range; as many as tell the training constructs best when each is left out). It knows \
             nothing of other parameters and other groups.",
            BASELINES[0], BASELINES[1], results.neighbours
        ),
        format!(
            "Statements are expressions over {}.",
            NAMES.iter().map(|(name, about)| format!("`{name}` ({about})")).collect::<Vec<_>>().join(", ")
        ),
    ]
}

fn csv(results: &Results<'_>) -> Table {
    let parameters = parameters(results);
    let names: Vec<String> = parameters.iter().map(|(_, name, _)| format!("{name},")).collect();
    let predictors = results.plan.predictors();
    let mut csv = format!("test,construct,{}trials,rate,{}\n", names.concat(), predictors.join(","));
    for test in &results.tests {
        for item in &test.items {
            let values: Vec<String> =
                parameters.iter().map(|(place, ..)| format!("{},", value(results, test.lot, item, *place))).collect();
            let chances: Vec<String> = item.chances.iter().map(ToString::to_string).collect();
            let (trials, rate) = (item.simulated.trials, item.simulated.rate());
            csv += &format!("{},{},{}{trials},{rate},{}\n", test.name, item.number, values.concat(), chances.join(","));
        }
    }
    Table {
        file: "predictions.csv".into(),
        about: "The constructs of the tests: simulated and predicted shares.".into(),
        csv,
    }
}
