//! The page of a formation file: how often targets did each task, what it took, what was published, and what it looks like.

use super::plan::Plan;
use super::results::{NAMES, Results, reading};
use super::task::Task;
use super::{course, trial};
use crate::design::report::{add_ways, put};
use crate::environment::claims;
use crate::report::of_run::paragraphs;
use crate::report::{Drawing, Drawings, Fact, Figure, Listing, Page, Replay, Stroke, Table, short};
use space::Vector;
use terrain::Point;

/// Frames of a trial that is played.
const FRAMES: u64 = 500;
/// Corners of a circle that is drawn dashed.
const CORNERS: usize = 32;

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for row in compared(results).rows {
        lines.push(format!("{}: targets {}, all of them {}", row[0], row[1], row[2]));
    }
    let judged = claims::rows(&results.plan.form.claim, results, results.plan.form.seed);
    lines.extend(judged.into_iter().map(|row| claims::line(&row)));
    lines
}

/// The page.
pub fn page(results: &Results<'_>, program: &str) -> Page {
    let plan = results.plan;
    let mut figures = vec![Figure::Listing(by_task(results)), Figure::Listing(compared(results))];
    if !plan.form.claim.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "Beside what was published".into(),
            about:
                "Intervals and verdicts are by drawing the trials again 400 times, with replacement. The results are a \
                    reconstruction with the parameters of this file; equality with the source is not claimed."
                    .into(),
            header: claims::header(),
            rows: claims::rows(&plan.form.claim, results, plan.form.seed),
        }));
    }
    figures.extend(plan.show.iter().filter_map(|&(task, method)| played(results, task, method)).map(Figure::Replay));
    figures.extend(drawn(results).map(Figure::Drawings));
    Page {
        title: plan.form.title.clone(),
        lead: paragraphs(&plan.form.about),
        methods: methods(plan),
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
    vec![
        fact("Tasks", plan.tasks.len().to_string()),
        fact("Methods", plan.methods.len().to_string()),
        fact("Targets", plan.targets.members().to_string()),
        fact("Trials of each", plan.trials.to_string()),
    ]
}

/// A share with its Wilson interval over targets.
fn share((done, all): (u64, u64)) -> String {
    match measure::statistics::wilson(done, all, 0.95) {
        Ok(found) => format!("{:.3} ({:.2} to {:.2})", done as f64 / all as f64, found.low, found.high),
        Err(_) => "\u{2013}".to_owned(),
    }
}

fn number(value: f64) -> String {
    if value.is_finite() { short(value) } else { "\u{2013}".to_owned() }
}

fn by_task(results: &Results<'_>) -> Listing {
    let plan = results.plan;
    let mut header = vec!["task".to_owned(), "walls".to_owned()];
    header.extend(plan.methods.iter().map(|method| method.name.clone()));
    let row = |task: usize| {
        let mut row = vec![plan.tasks[task].name.clone(), results.walls[task].len().to_string()];
        row.extend((0..plan.methods.len()).map(|method| share(results.targets(task, method))));
        row
    };
    Listing {
        title: "How many targets did the tasks".into(),
        about: "Share of the targets of all trials that passed the gates in order and reached the goal in time, with the 95 % Wilson \
                interval over targets. Methods have the same seeds."
            .into(),
        header,
        rows: (0..plan.tasks.len()).map(row).collect(),
    }
}

fn compared(results: &Results<'_>) -> Listing {
    let plan = results.plan;
    let row = |method: usize| {
        let tasks = &plan.methods[method].tasks;
        let total = tasks.iter().map(|&task| results.targets(task, method));
        let mut row = vec![
            plan.methods[method].name.clone(),
            share(total.fold((0, 0), |sum, own| (sum.0 + own.0, sum.1 + own.1))),
        ];
        for name in ["success", "time", "path_length", "dispersion", "held", "robots"] {
            let of = reading(name);
            let means = tasks.iter().map(|&task| of.map_or(f64::NAN, |of| results.mean(task, method, of)));
            row.push(number(super::results::mean(means)));
        }
        row.push(number(super::results::mean(
            tasks.iter().map(|&task| results.mean(task, method, |tried| tried.bumps)),
        )));
        row
    };
    Listing {
        title: "The methods side by side".into(),
        about: "Means over tasks: share of targets that did the task, share of trials in which all did, time at which the last arrived (where \
                all did), way of all shepherds together, mean distance of targets from their middle, share of the time in which all targets \
                were inside the hull of the shepherds, their number, and moves of shepherds that somebody was in the way of."
            .into(),
        header: ["method", "targets", "all of them", "time", "path length", "dispersion", "held", "robots", "bumps"]
            .map(str::to_owned)
            .to_vec(),
        rows: (0..plan.methods.len()).map(row).collect(),
    }
}

fn methods(plan: &Plan) -> Vec<String> {
    let models: Vec<String> =
        plan.targets.scenario.group.0.iter().map(|(_, own)| format!("{} of {}", own.count, own.model.id)).collect();
    let lines: Vec<String> = plan
        .methods
        .iter()
        .filter(|method| !method.form.about.is_empty())
        .map(|method| format!("{}: {}", method.name, method.form.about))
        .collect();
    let mut words = vec![
        format!(
            "Targets: {}, in the workspace `{}`, {} steps at most. A task is a path; at each corner a gate lies across the middle of the \
             two ways, and its end is a disc. A trial's fitness is the share of targets that crossed the gates in order and then reached \
             the disc.",
            models.join(" and "),
            plan.workspace.workspace.name,
            plan.targets.steps
        ),
        "Targets sense shepherds as they sense walls, never as members. Walls that the file does not give were searched leg by leg, by \
         trials with seeds of their own. Nothing here equals the source's experiment: its shapes, walls and parameters are not printed."
            .to_owned(),
        format!(
            "Statements are expressions over {}.",
            NAMES.iter().map(|(name, about)| format!("`{name}` ({about})")).collect::<Vec<_>>().join(", ")
        ),
    ];
    if !lines.is_empty() {
        words.insert(1, format!("Methods. {}.", lines.join("; ")));
    }
    words
}

fn csv(results: &Results<'_>) -> Table {
    let plan = results.plan;
    let mut csv =
        String::from("task,method,trials,targets_done,targets,success,time,path_length,dispersion,held,robots\n");
    for &(task, method) in results.trials.keys() {
        let (done, all) = results.targets(task, method);
        let trials = results.of(task, method).len();
        csv += &format!("{},{},{trials},{done},{all}", plan.tasks[task].name, plan.methods[method].name);
        for name in ["success", "time", "path_length", "dispersion", "held", "robots"] {
            let value = reading(name).map_or(f64::NAN, |of| results.mean(task, method, of));
            csv += &if value.is_finite() { format!(",{value}") } else { ",".to_owned() };
        }
        csv.push('\n');
    }
    Table { file: "outcomes.csv".into(), about: "What came of each task with each method.".into(), csv }
}

pub(crate) fn circle(centre: Point, radius: f64) -> Vec<[f64; 2]> {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / CORNERS as f64;
    (0..=CORNERS).map(|k| (centre + Vector::at_angle(angle(k)) * radius).0).collect()
}

/// Path, gates, start and goal of a task, as lines.
pub(crate) fn lines_of(task: &Task) -> Vec<Vec<[f64; 2]>> {
    let mut lines = vec![task.path.iter().map(|p| p.0).collect()];
    lines.extend(task.gates().into_iter().map(|gate| vec![gate.from.0, gate.to.0]));
    lines.push(circle(task.path[0], task.start_radius));
    lines.push(circle(task.goal(), task.goal_radius));
    lines
}

/// A task in its workspace.
pub(crate) fn of_task(plan: &Plan, task: usize, caption: String) -> Drawing {
    let mut drawing = Drawing { caption, ..Drawing::default() };
    put(&mut drawing, &plan.workspace.workspace.geometry, Stroke::There);
    let lines = lines_of(&plan.tasks[task]).into_iter();
    drawing.strokes.extend(lines.map(|line| (Stroke::Structure, line)));
    drawing
}

/// The first trial of every task with every method.
fn drawn(results: &Results<'_>) -> Option<Drawings> {
    let plan = results.plan;
    let mut drawings = Vec::new();
    for &(task, method) in results.trials.keys() {
        let own = &plan.methods[method];
        let arena = plan.arena(task, own, &results.walls[task]);
        let (mut course, mut shepherds, mut ever) = (Vec::new(), Vec::new(), vec![false; arena.walls.len()]);
        // a trial that was possible is possible again
        let _ = trial::run(&arena, plan.seed_of(task, 1), &|| false, &mut |shown| {
            course.push(shown.targets.iter().copied().map(Some).collect::<Vec<_>>());
            shepherds.push(shown.robots.to_vec());
            ever.iter_mut().zip(shown.standing).for_each(|(ever, standing)| *ever |= standing);
        });
        let fitness = results.of(task, method).first().map_or(f64::NAN, |tried| tried.fitness);
        let caption = format!("{}, {}: {}", plan.tasks[task].name, own.name, number(fitness));
        let mut drawing = of_task(plan, task, caption);
        let walls = arena.walls.iter().zip(ever).filter(|(_, ever)| *ever);
        drawing.strokes.extend(walls.map(|(wall, _)| (Stroke::Built, vec![wall.at.from.0, wall.at.to.0])));
        add_ways(&mut drawing, &course);
        if let Some(last) = shepherds.last() {
            drawing.discs.extend(last.iter().map(|robot| (true, robot.0, own.shepherds.radius)));
        }
        drawings.push(drawing);
    }
    (!drawings.is_empty()).then(|| Drawings {
        title: "The first trial of each".into(),
        about: "The task (dashed), walls that stood at any time, the ways of the targets from blue to orange with time, and where the \
                shepherds were in the end; with the share of targets that did it."
            .into(),
        bounds: None,
        drawings,
    })
}

/// A trial to play: the first.
fn played(results: &Results<'_>, task: usize, method: usize) -> Option<Replay> {
    let steps = results.of(task, method).first()?.steps;
    course::replay(results.plan, &results.walls[task], (task, method, 1), (steps / FRAMES).max(1)).ok()
}
