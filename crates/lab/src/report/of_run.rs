//! The page of a run, from its folder.

use super::of_members;
use super::{
    Axis, Border, Fact, Figure, Line, Lines, Moment, Outline, Page, Replay, Scenes, Seen, Stage, Table as Download,
};
use crate::run::{EVENTS, METRICS, TRAJECTORY, tables};
use crate::scenario::build::{self, Read, Schedule};
use crate::scenario::{Scenario, describe};
use crate::store::StoreError;
use crate::store::table::{Table, Values};
use crate::with_types;
use space::obstacles::Obstacle;
use space::shape::Shape;
use space::{ColumnKind, Edge, Real};
use std::path::Path;

/// Positions in a replay: about 3 MB of a page.
pub(super) const REPLAYED: usize = 300_000;
/// Frames in a replay.
pub(super) const REPLAYED_FRAMES: usize = 600;
/// Agents that are drawn in a scene or a replay.
pub(super) const DRAWN: usize = 5_000;
/// Kept frames before a moment that make up its trails.
const TRAIL: usize = 12;
/// Bytes, about, of a table that is put into the page.
pub(super) const DOWNLOADED: u64 = 2 << 20;

/// The numbers that sum up the run in a folder.
///
/// # Errors
/// Where its metrics cannot be read.
pub fn summary_of(folder: &Path, read: &Read, seed: u64, quick: bool) -> Result<Vec<Fact>, StoreError> {
    let schedule = scheduled(&read.scenario, quick)?;
    let measured = Measured::read(&Table::open(&folder.join(METRICS))?)?;
    Ok(summary(&read.scenario, &schedule, seed, &measured))
}

fn scheduled(scenario: &Scenario, quick: bool) -> Result<Schedule, StoreError> {
    build::schedule(scenario, quick).map_err(|wrong| StoreError::Refused(format!("{}: {}", wrong.path, wrong.what)))
}

/// The page of the run in a folder.
///
/// # Errors
/// Where a table cannot be read.
pub fn page(folder: &Path, read: &Read, seed: u64, quick: bool, program: &str) -> Result<Page, StoreError> {
    let scenario = &read.scenario;
    let schedule = scheduled(scenario, quick)?;
    let metrics = Table::open(&folder.join(METRICS))?;
    let measured = Measured::read(&metrics)?;
    let mut figures = Vec::new();
    if scenario.record.trajectory {
        let setting = Setting::of(scenario, seed)?;
        let motion = Motion::read(&Table::open(&folder.join(TRAJECTORY))?, scenario)?;
        figures.extend(motion.replay(&setting, scenario));
        figures.extend(measured.figures(scenario));
        figures.extend(of_members::nearest_inputs(&Table::open(&folder.join(TRAJECTORY))?, scenario)?);
        figures.extend(of_members::turns(&Table::open(&folder.join(TRAJECTORY))?, scenario)?);
        figures.extend(motion.scenes(&setting, scenario));
    } else {
        figures.extend(measured.figures(scenario));
    }
    let mut downloads = Vec::new();
    let fits = |table: &Table| table.rows() * table.headings().len() as u64 * 10 <= DOWNLOADED;
    if fits(&metrics) {
        downloads.push(Download {
            file: "metrics.csv".into(),
            about: "Every metric at every measurement, a row for each group.".into(),
            csv: csv(&metrics)?,
        });
    }
    let events = Table::open(&folder.join(EVENTS))?;
    if events.rows() > 0 && fits(&events) {
        downloads.push(Download {
            file: "events.csv".into(),
            about: "What happened: food eaten, deaths, obstacles that came and went.".into(),
            csv: csv(&events)?,
        });
    }
    let name = read.sources.name(0);
    let sets: Vec<String> = (1..)
        .map(|k| read.sources.text(k))
        .take_while(|text| !text.is_empty())
        .map(|text| format!(" --set '{text}'"))
        .collect();
    Ok(Page {
        title: scenario.title.clone(),
        lead: paragraphs(&scenario.about),
        methods: describe::methods(scenario, &schedule, seed),
        summary: summary(scenario, &schedule, seed, &measured),
        figures,
        tables: downloads,
        command: format!("flockworks run {name} --seed {seed}{}{}", if quick { " --quick" } else { "" }, sets.concat()),
        source: read.sources.text(0).to_owned(),
        made_by: format!("{program}, seed {seed}"),
    })
}

pub(crate) fn paragraphs(text: &str) -> Vec<String> {
    let joined = |part: &str| part.split_whitespace().collect::<Vec<_>>().join(" ");
    text.split("\n\n").map(joined).filter(|part| !part.is_empty()).collect()
}

fn csv(table: &Table) -> Result<String, StoreError> {
    let mut out = Vec::new();
    crate::store::export::csv(table, &mut out)?;
    Ok(String::from_utf8(out).unwrap_or_default())
}

/// Metrics over time, group by group.
struct Measured {
    /// Names of the columns, with their units.
    columns: Vec<(String, String)>,
    groups: Vec<String>,
    /// Times, `[groups][rows]`.
    time: Vec<Vec<f64>>,
    /// Values, `[groups][columns][rows]`.
    values: Vec<Vec<Vec<f64>>>,
}

/// Columns before the metrics: run, step, t, group, members.
const LEADING: usize = 5;

impl Measured {
    fn read(table: &Table) -> Result<Self, StoreError> {
        let columns: Vec<(String, String)> =
            table.headings()[LEADING..].iter().map(|h| (h.name.clone(), h.unit.clone())).collect();
        let mut all = Self { columns, groups: Vec::new(), time: Vec::new(), values: Vec::new() };
        let wanted: Vec<usize> = (2..table.headings().len()).collect();
        for group in 0..table.groups() {
            let read = table.read(group, &wanted)?;
            for row in 0..read[0].len() {
                let name = read[1].text(row);
                let at = all.groups.iter().position(|other| *other == name).unwrap_or_else(|| {
                    all.groups.push(name);
                    all.time.push(Vec::new());
                    all.values.push(vec![Vec::new(); all.columns.len()]);
                    all.groups.len() - 1
                });
                all.time[at].push(read[0].number(row));
                for (column, values) in all.values[at].iter_mut().enumerate() {
                    values.push(read[3 + column].number(row));
                }
            }
        }
        Ok(all)
    }
    fn line(&self, group: usize, column: usize, name: String) -> Line {
        let there = |&value: &f64| value.is_finite().then_some(value);
        Line { name, x: self.time[group].clone(), y: self.values[group][column].iter().map(there).collect() }
    }
    fn figures(&self, scenario: &Scenario) -> Vec<Figure> {
        let x = Axis { label: "time".into(), unit: scenario.units.time.clone(), range: None };
        let mut figures = Vec::new();
        let mut column = 0;
        while column < self.columns.len() {
            let (name, unit) = &self.columns[column];
            if let Some(card) = measure::metrics::LIST.iter().find(|card| card.id == name) {
                figures.push(Figure::Lines(Lines {
                    id: card.id.into(),
                    title: card.title.into(),
                    about: card.definition.split_whitespace().collect::<Vec<_>>().join(" "),
                    x: x.clone(),
                    y: Axis { label: card.title.to_lowercase(), unit: unit.clone(), range: card.range },
                    lines: (0..self.groups.len()).map(|g| self.line(g, column, self.groups[g].clone())).collect(),
                }));
                column += 1;
                continue;
            }
            if let Some((state, labels)) = states(scenario)
                .into_iter()
                .find(|(state, labels)| labels.first().is_some_and(|label| tables::share_name(state, label) == *name))
            {
                for group in 0..self.groups.len() {
                    // one state that never changes is no figure
                    let seen = |k: usize| self.values[group][column + k].iter().any(|&share| share > 0.0);
                    if (0..labels.len()).filter(|&k| seen(k)).count() < 2 {
                        continue;
                    }
                    let line = |(k, label): (usize, &&str)| self.line(group, column + k, (*label).to_owned());
                    figures.push(Figure::Lines(Lines {
                        id: format!("{state}_{}", self.groups[group]),
                        title: format!("Shares of each {state}{}", self.of(group)),
                        about: format!("Share of members in each {state} at the time of measurement."),
                        x: x.clone(),
                        y: Axis { label: "share of members".into(), unit: "1".into(), range: Some((0.0, 1.0)) },
                        lines: labels.iter().enumerate().map(line).collect(),
                    }));
                }
                column += labels.len();
                continue;
            }
            // the rest are counts, which figures of their own tell apart
            break;
        }
        figures.extend(self.counts(&x));
        figures
    }
    /// Figures of what was counted between measurements: contacts by what was touched, refused moves, detections of scanners.
    fn counts(&self, x: &Axis) -> Vec<Figure> {
        let column = |name: &str| self.columns.iter().position(|(other, _)| other == name);
        let happened = |line: &Line| line.y.iter().flatten().any(|&count| count > 0.0);
        let figure = |id: String, title: String, about: String, label: &str, lines: Vec<Line>| {
            let y = Axis { label: label.into(), unit: "1".into(), range: None };
            Figure::Lines(Lines { id, title, about, x: x.clone(), y, lines })
        };
        let mut figures = Vec::new();
        for group in 0..self.groups.len() {
            let with =
                |what: &&str| Some(self.line(group, column(&format!("contacts_{what}"))?, format!("with {what}")));
            let lines = tables::CONTACTS.iter().filter_map(with);
            // what was never touched is said and not drawn
            let (met, never): (Vec<Line>, Vec<Line>) = lines.partition(happened);
            if met.is_empty() {
                continue;
            }
            let never: Vec<&str> = never.iter().map(|line| line.name.as_str()).collect();
            let none = if never.is_empty() { String::new() } else { format!(" None {}.", never.join(" or ")) };
            let only = if met.len() == 1 { format!(" {}", met[0].name) } else { String::new() };
            figures.push(figure(
                format!("contacts_{}", self.groups[group]),
                format!("Contacts{only}{}", self.of(group)),
                format!(
                    "Steps in which a member touched something, over all members, since the measurement before.{none}"
                ),
                "contacts",
                met,
            ));
        }
        if let Some(column) = column("refused_moves") {
            let lines = (0..self.groups.len()).map(|group| self.line(group, column, self.groups[group].clone()));
            let lines: Vec<Line> = lines.filter(happened).collect();
            if !lines.is_empty() {
                let about =
                    "Moves that were not made since the measurement before, because they would have ended in contact.";
                figures.push(figure("refused_moves".into(), "Refused moves".into(), about.into(), "moves", lines));
            }
        }
        // all scanners are counted together, beside the last group
        if let Some(everyone) = self.groups.len().checked_sub(1) {
            let line = |&(name, _): &(&str, &str)| Some(self.line(everyone, column(name)?, name.replace('_', " ")));
            let lines: Vec<Line> = tables::DETECTIONS.iter().filter_map(line).collect();
            if lines.iter().any(happened) {
                let about = "Over all scanners, since the measurement before: members in range and field of view of a scan; those of them of \
                             whom nothing was detected; inputs that detection found; and inputs that belong to no member.";
                figures.push(figure("detections".into(), "Detections".into(), about.into(), "count", lines));
            }
        }
        figures
    }
    /// What a title of several groups ends in.
    fn of(&self, group: usize) -> String {
        if self.groups.len() > 1 { format!(", {}", self.groups[group]) } else { String::new() }
    }
    /// Whether contacts were counted, and there were none.
    fn untouched(&self) -> bool {
        let mut contacts = (0..self.columns.len()).filter(|&k| self.columns[k].0.starts_with("contacts_")).peekable();
        let none = |column: usize| self.values.iter().all(|group| group[column].iter().all(|&count| count == 0.0));
        contacts.peek().is_some() && contacts.all(none)
    }
    /// Mean of a column over the last quarter of the run.
    fn late(&self, group: usize, column: usize) -> Option<f64> {
        let values = &self.values[group][column];
        let late: Vec<f64> = values[values.len() * 3 / 4..].iter().copied().filter(|v| v.is_finite()).collect();
        (!late.is_empty()).then(|| late.iter().sum::<f64>() / late.len() as f64)
    }
}

/// The named states that models of a scenario declare.
fn states(scenario: &Scenario) -> Vec<(&'static str, &'static [&'static str])> {
    let entries = scenario.group.0.iter().filter_map(|(_, group)| swarm::models::find(&group.model.id));
    entries
        .flat_map(|entry| (entry.columns)())
        .filter_map(|column| match column.kind {
            ColumnKind::Label(labels) => Some((column.name, labels)),
            ColumnKind::Quantity | ColumnKind::Count => None,
        })
        .collect()
}

fn summary(scenario: &Scenario, schedule: &Schedule, seed: u64, measured: &Measured) -> Vec<Fact> {
    let fact = |label: &str, value: String| Fact { label: label.to_owned(), value };
    let agents: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
    let time = &scenario.units.time;
    let mut facts = vec![
        fact("Agents", agents.to_string()),
        fact(
            "Simulated",
            format!("{} {time} in {} steps", short(schedule.step * schedule.steps as f64), schedule.steps),
        ),
        fact("Seed", seed.to_string()),
    ];
    let last = measured.groups.len().saturating_sub(1);
    for (column, (name, unit)) in measured.columns.iter().enumerate() {
        let Some(card) = measure::metrics::LIST.iter().find(|card| card.id == name) else { continue };
        let Some(value) = measured.groups.get(last).and_then(|_| measured.late(last, column)) else { continue };
        let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
        facts.push(fact(&format!("{} (mean, last quarter)", card.title), format!("{}{unit}", short(value))));
    }
    if measured.untouched() {
        facts.push(fact("Contacts", "none".into()));
    }
    facts
}

/// 2nd, 3rd, 4th, ...
pub(super) fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1, n) if n != 11 => "st",
        (2, n) if n != 12 => "nd",
        (3, n) if n != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Four digits that count.
pub fn short(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    if value.abs() < 1e-4 {
        return format!("{value:.3e}");
    }
    let digits = (3 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// What stands around the agents.
struct Setting {
    dimensions: usize,
    edges: [Border; 3],
    size: [Option<f64>; 3],
    obstacles: Vec<Standing>,
    radius: Vec<f64>,
}

/// An obstacle with its plan, in three coordinates.
struct Standing {
    outline: Outline,
    plan: Option<space::obstacles::Plan<f64, 3>>,
}

impl Setting {
    fn of(scenario: &Scenario, seed: u64) -> Result<Self, StoreError> {
        with_types!(scenario, R, D => {
            let plan = build::plan::<R, D>(scenario, seed, 1).map_err(|wrongs| {
                StoreError::Refused(wrongs.first().map_or_else(String::new, |wrong| wrong.what.clone()))
            })?;
            let mut edges = [Border::Open; 3];
            let mut size = [None; 3];
            for a in 0..D {
                (edges[a], size[a]) = match plan.space.edges[a] {
                    Edge::Open => (Border::Open, None),
                    Edge::Periodic(side) => (Border::Seam, Some(side.to_f64())),
                    Edge::Walls(side) => (Border::Wall, Some(side.to_f64())),
                };
            }
            let obstacles = plan.obstacles.iter().filter_map(|obstacle| standing(obstacle, &size)).collect();
            let world = swarm::World::new(plan).map_err(|error| StoreError::Refused(error.to_string()))?;
            let radius = world.groups().iter().map(|group| (group.radius() + group.half_axis()).to_f64()).collect();
            Ok(Self { dimensions: D, edges, size, obstacles, radius })
        })
    }
    /// The obstacles that are there at a time, where they are.
    fn at(&self, time: f64) -> Vec<Outline> {
        let there = |standing: &&Standing| standing.plan.as_ref().is_none_or(|plan| plan.present(time));
        let placed = |standing: &Standing| match &standing.plan {
            Some(plan) => moved(&standing.outline, plan.offset(time).0),
            None => standing.outline.clone(),
        };
        self.obstacles.iter().filter(there).map(placed).collect()
    }
    fn moves(&self) -> bool {
        self.obstacles.iter().any(|standing| standing.plan.is_some())
    }
}

fn moved(outline: &Outline, by: [f64; 3]) -> Outline {
    let at = |p: &[f64; 3]| core::array::from_fn(|a| p[a] + by[a]);
    match outline {
        Outline::Ball { centre, radius } => Outline::Ball { centre: at(centre), radius: *radius },
        Outline::Segment { from, to } => Outline::Segment { from: at(from), to: at(to) },
        Outline::Polygon(corners) => Outline::Polygon(corners.iter().map(at).collect()),
        Outline::Cuboid { low, high } => Outline::Cuboid { low: at(low), high: at(high) },
    }
}

fn wide<R: Real, const D: usize>(vector: space::Vector<R, D>) -> [f64; 3] {
    core::array::from_fn(|a| if a < D { vector.0[a].to_f64() } else { 0.0 })
}

/// An obstacle to be drawn. A plane is drawn as the line where it cuts the box, in two dimensions only.
fn standing<R: Real, const D: usize>(obstacle: &Obstacle<R, D>, size: &[Option<f64>; 3]) -> Option<Standing> {
    let outline = match &obstacle.shape {
        Shape::Ball { centre, radius } => Outline::Ball { centre: wide(*centre), radius: radius.to_f64() },
        Shape::Segment { from, to } => Outline::Segment { from: wide(*from), to: wide(*to) },
        Shape::Polygon { vertices } => Outline::Polygon(vertices.iter().map(|&v| wide(v)).collect()),
        Shape::Cuboid { low, high } => Outline::Cuboid { low: wide(*low), high: wide(*high) },
        Shape::Plane { point, normal } => {
            if D != 2 {
                return None;
            }
            let (point, normal) = (wide(*point), wide(*normal));
            let far = size.iter().flatten().fold(100.0, |far: f64, &side| far.max(2.0 * side));
            let along = |sign: f64| [point[0] - sign * far * normal[1], point[1] + sign * far * normal[0], 0.0];
            Outline::Segment { from: along(-1.0), to: along(1.0) }
        }
    };
    let plan = obstacle.plan.as_ref().map(|plan| space::obstacles::Plan {
        appears: plan.appears,
        disappears: plan.disappears,
        waypoints: plan.waypoints.iter().map(|&(time, offset)| (time, space::Vector(wide(offset)))).collect(),
    });
    Some(Standing { outline, plan })
}

/// Positions and velocities of the agents that are drawn, frame by frame.
///
/// Only the frames that are shown are held: a long run has more than a page, or memory, has room for.
struct Motion {
    agents: usize,
    /// Number of kept frames.
    frames: usize,
    /// The frames that are held, ascending.
    held: Vec<usize>,
    /// Those of them that are replayed, `[..]` of `held`, and how many kept frames lie between two.
    replayed: Vec<usize>,
    every: usize,
    /// Those of them that are scenes, and where each one's trail begins, by place in `held`.
    scenes: Vec<(usize, usize)>,
    /// Group of each drawn agent.
    group: Vec<usize>,
    /// Whether only some agents are drawn.
    some: bool,
    time: Vec<f64>,
    /// `[frames][agents]`.
    position: Vec<Vec<[f32; 3]>>,
    heading: Vec<Vec<[f32; 3]>>,
}

impl Motion {
    fn read(table: &Table, scenario: &Scenario) -> Result<Self, StoreError> {
        let dimensions = scenario.space.dimensions;
        let agents: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
        let every = agents.div_ceil(DRAWN).max(1);
        let mut group = Vec::new();
        for (g, (_, part)) in scenario.group.0.iter().enumerate() {
            group.resize(group.len() + part.count, g);
        }
        let group: Vec<usize> = group.into_iter().step_by(every).collect();
        let frames = (table.rows() as usize).checked_div(agents).unwrap_or(0);
        let places = ["frame", "t", "id", "x", "vx"].map(|name| table.column(name));
        let [Some(frame), Some(t), Some(id), Some(x), Some(vx)] = places else {
            return Err(StoreError::Damaged("the trajectory lacks a column".into()));
        };
        let mut wanted = vec![frame, t, id];
        wanted.extend((0..dimensions).map(|a| x + a));
        wanted.extend((0..dimensions).map(|a| vx + a));
        let most = (REPLAYED / group.len().max(1)).clamp(2, REPLAYED_FRAMES);
        let between = frames.div_ceil(most).max(1);
        let replayed: Vec<usize> = (0..frames).step_by(between).collect();
        let count = if dimensions == 3 { 3 } else { 4 };
        let mut scenes: Vec<usize> = (0..count).map(|k| k * frames.saturating_sub(1) / (count - 1)).collect();
        scenes.dedup();
        scenes.retain(|&frame| frame < frames);
        let mut held = replayed.clone();
        scenes.iter().for_each(|&frame| held.extend(frame.saturating_sub(TRAIL)..=frame));
        held.sort_unstable();
        held.dedup();
        let place = |frame: usize| held.partition_point(|&other| other < frame);
        let blank = || vec![[f32::NAN; 3]; group.len()];
        let mut motion = Self {
            agents,
            frames,
            every: between,
            replayed: replayed.iter().map(|&frame| place(frame)).collect(),
            scenes: scenes.iter().map(|&frame| (place(frame), place(frame.saturating_sub(TRAIL)))).collect(),
            some: every > 1,
            time: vec![0.0; held.len()],
            position: held.iter().map(|_| blank()).collect(),
            heading: held.iter().map(|_| vec![[0.0; 3]; group.len()]).collect(),
            group,
            held,
        };
        let mut first = 0;
        for block in 0..table.groups() {
            // rows stand in the order of the frames
            let begin = first / agents.max(1) as u64;
            first += table.rows_in(block);
            let end = first.div_ceil(agents.max(1) as u64);
            let next = motion.held.partition_point(|&frame| (frame as u64) < begin);
            if motion.held.get(next).is_none_or(|&frame| frame as u64 >= end) {
                continue;
            }
            let read = table.read(block, &wanted)?;
            let (Values::Long(frame), Values::Whole(id)) = (&read[0], &read[2]) else {
                return Err(StoreError::Damaged("the trajectory has columns of other kinds".into()));
            };
            for row in 0..frame.len() {
                let (frame, id) = (frame[row] as usize, id[row] as usize);
                if frame >= frames || id >= agents {
                    return Err(StoreError::Damaged(
                        "the trajectory names a frame or an agent that is not there".into(),
                    ));
                }
                let Ok(at) = motion.held.binary_search(&frame) else { continue };
                motion.time[at] = read[1].number(row);
                if id % every != 0 {
                    continue;
                }
                let of = |from: usize| -> [f64; 3] {
                    core::array::from_fn(|a| if a < dimensions { read[from + a].number(row) } else { 0.0 })
                };
                let velocity = of(3 + dimensions);
                let speed = velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
                motion.position[at][id / every] = of(3).map(|v| v as f32);
                motion.heading[at][id / every] = velocity.map(|v| if speed > 1e-12 { (v / speed) as f32 } else { 0.0 });
            }
        }
        Ok(motion)
    }
    /// The stage that holds everything drawn.
    fn stage(&self, setting: &Setting, scenario: &Scenario) -> Stage {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let mut hold = |point: [f64; 3], margin: f64| {
            for a in 0..3 {
                low[a] = low[a].min(point[a] - margin);
                high[a] = high[a].max(point[a] + margin);
            }
        };
        let widest = setting.radius.iter().copied().fold(0.0, f64::max);
        for position in self.position.iter().flatten().filter(|p| p[0].is_finite()) {
            hold(position.map(f64::from), widest);
        }
        let open = setting.size.iter().take(setting.dimensions).any(Option::is_none);
        if open {
            for outline in setting.obstacles.iter().map(|standing| &standing.outline) {
                match outline {
                    Outline::Ball { centre, radius } => hold(*centre, *radius),
                    Outline::Segment { .. } => {}
                    Outline::Polygon(corners) => corners.iter().for_each(|corner| hold(*corner, 0.0)),
                    Outline::Cuboid { low, high } => {
                        hold(*low, 0.0);
                        hold(*high, 0.0);
                    }
                }
            }
        }
        for a in 0..3 {
            match setting.size[a] {
                Some(side) => (low[a], high[a]) = (0.0, side),
                None if a >= setting.dimensions || low[a] > high[a] => (low[a], high[a]) = (0.0, 0.0),
                None => {}
            }
        }
        Stage {
            dimensions: setting.dimensions,
            low,
            high,
            edges: setting.edges,
            unit: scenario.units.length.clone(),
            groups: scenario.group.0.iter().map(|(name, _)| name.clone()).collect(),
            radius: setting.radius.clone(),
        }
    }
    fn drawn(&self) -> String {
        if self.some {
            format!(" Every {} of {} agents is drawn.", ordinal(self.agents.div_ceil(DRAWN)), self.agents)
        } else {
            String::new()
        }
    }
    fn scenes(&self, setting: &Setting, scenario: &Scenario) -> Option<Figure> {
        if self.frames == 0 {
            return None;
        }
        let narrow = |p: [f32; 3]| p.map(f64::from);
        let moment = |&(frame, trail): &(usize, usize)| Moment {
            time: self.time[frame],
            agents: (0..self.group.len())
                .filter(|&k| self.position[frame][k][0].is_finite())
                .map(|k| Seen {
                    group: self.group[k],
                    position: narrow(self.position[frame][k]),
                    heading: narrow(self.heading[frame][k]),
                    trail: (trail..frame).map(|f| narrow(self.position[f][k])).collect(),
                })
                .collect(),
            items: Vec::new(),
            obstacles: setting.at(self.time[frame]),
        };
        let views =
            if setting.dimensions == 3 { " Each is seen from above, from the front and from the side." } else { "" };
        let open = if setting.edges[..setting.dimensions].contains(&Border::Open) {
            " Each shows where the agents are; its bar says how large that is."
        } else {
            ""
        };
        Some(Figure::Scenes(Scenes {
            title: "Moments".into(),
            about: format!(
                "From the first to the last kept frame, with trails of up to {TRAIL} frames.{views}{open}{}",
                self.drawn()
            ),
            stage: self.stage(setting, scenario),
            time_unit: scenario.units.time.clone(),
            moments: self.scenes.iter().map(moment).collect(),
        }))
    }
    fn replay(&self, setting: &Setting, scenario: &Scenario) -> Option<Figure> {
        if self.frames < 2 || self.group.is_empty() {
            return None;
        }
        let (every, chosen) = (self.every, &self.replayed);
        let thinned = if every > 1 { format!(" Every {} kept frame is shown.", ordinal(every)) } else { String::new() };
        Some(Figure::Replay(Replay {
            title: "Replay".into(),
            about: format!("The run as it was.{thinned}{}", self.drawn()),
            stage: self.stage(setting, scenario),
            time_unit: scenario.units.time.clone(),
            times: chosen.iter().map(|&frame| self.time[frame]).collect(),
            group: self.group.clone(),
            position: chosen.iter().map(|&frame| self.position[frame].clone()).collect(),
            heading: chosen.iter().map(|&frame| self.heading[frame].clone()).collect(),
            obstacles: if setting.moves() {
                chosen.iter().map(|&frame| setting.at(self.time[frame])).collect()
            } else {
                vec![setting.at(0.0)]
            },
        }))
    }
}

#[cfg(test)]
#[allow(clippy::panic, reason = "tests")]
mod tests {
    use super::*;

    fn measured(columns: &[(&str, [f64; 3])]) -> Measured {
        Measured {
            columns: columns.iter().map(|(name, _)| ((*name).to_owned(), "1".to_owned())).collect(),
            groups: vec!["robots".into()],
            time: vec![vec![0.0, 1.0, 2.0]],
            values: vec![columns.iter().map(|(_, values)| values.to_vec()).collect()],
        }
    }

    fn counts(measured: &Measured) -> Vec<(String, Vec<String>, String)> {
        let x = Axis { label: "time".into(), unit: "s".into(), range: None };
        let told = |figure: Figure| match figure {
            Figure::Lines(it) => (it.title, it.lines.into_iter().map(|line| line.name).collect(), it.about),
            other => panic!("{other:?}"),
        };
        measured.counts(&x).into_iter().map(told).collect()
    }

    #[test]
    fn contacts_refused_moves_and_detections_are_figures_of_their_own() {
        let all = counts(&measured(&[
            ("contacts_members", [0.0, 2.0, 1.0]),
            ("contacts_obstacles", [0.0; 3]),
            ("contacts_walls", [0.0, 0.0, 4.0]),
            ("refused_moves", [0.0, 2.0, 5.0]),
            ("members_in_view", [0.0, 40.0, 41.0]),
            ("members_missed", [0.0, 8.0, 9.0]),
            ("detections", [0.0, 32.0, 32.0]),
            ("false_detections", [0.0; 3]),
        ]));
        let named: Vec<(&str, Vec<&str>)> =
            all.iter().map(|(title, lines, _)| (title.as_str(), lines.iter().map(String::as_str).collect())).collect();
        assert_eq!(
            named,
            [
                ("Contacts", vec!["with members", "with walls"]),
                ("Refused moves", vec!["robots"]),
                ("Detections", vec!["members in view", "members missed", "detections", "false detections"]),
            ]
        );
        assert!(all[0].2.ends_with("None with obstacles."), "what was never touched is said: {}", all[0].2);
    }

    #[test]
    fn what_never_happened_is_no_figure() {
        let none = [("contacts_members", [0.0; 3]), ("contacts_obstacles", [0.0; 3]), ("contacts_walls", [0.0; 3])];
        assert_eq!(counts(&measured(&none)), []);
        assert!(measured(&none).untouched() && !measured(&[]).untouched());
        let one = [none[0], none[1], ("contacts_walls", [0.0, 1.0, 0.0])];
        assert_eq!(counts(&measured(&one))[0].0, "Contacts with walls", "a line alone has its name in the title");
        assert!(!measured(&one).untouched());
        assert_eq!(counts(&measured(&[])), []);
    }
}
