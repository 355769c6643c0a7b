//! From a decomposition file to fragments, approaches and a group.

use super::directed::{self, Marked};
use super::form::{Clustering, Decomposition};
use super::probe::Arena;
use super::results::Results;
use crate::design::plan::{opened, workspace};
use crate::environment::claims;
use crate::environment::trial::{self, Population};
use crate::environment::workspace::Resolved;
use crate::file::{Desk, Form, Node, Problems, Rule, Sources, Span};
use crate::scenario::build;
use crate::study::plan::{Files, Load};
use serde_json::{Value as Json, json};
use space::Vector;
use space::random::child_seed;
use terrain::fragments::{Fragment, Polyline, fragment, polylines, stretch};
use terrain::generate::Candidates as _;
use terrain::geometry::along;
use terrain::{Construct, Geometry, Point, Pose};

/// Kind of child seeds, beside those of designs, maps and optimisations: a trial with a fragment.
const PROBE: u32 = 14;
/// Windows move on by this share of their width.
const STRIDE: f64 = 0.25;
/// Most fragments.
const MOST: usize = 100_000;
/// Least polarisation of a group that has a way.
const ALIGNED: f64 = 0.5;

/// How the group begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Begin {
    /// Its middle.
    pub centre: Point,
    /// The direction in which it heads, a unit vector.
    pub heading: Point,
    /// Greatest distance of a member from the middle.
    pub extent: f64,
}

/// A decomposition as resolved.
pub struct Plan {
    /// What was written.
    pub form: Decomposition,
    /// Where the construct stands.
    pub workspace: Resolved,
    /// The construct.
    pub construct: Construct,
    /// Its lines.
    pub lines: Vec<Polyline>,
    /// Its fragments, window by window.
    pub fragments: Vec<Fragment>,
    /// How many there would be without a budget.
    pub possible: usize,
    /// Stretches whose effect is known, with their fits.
    pub marked: Vec<Marked>,
    /// The group.
    pub population: Population,
    /// How it begins.
    pub begin: Begin,
    /// Trials of each approach and offset.
    pub trials: usize,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

/// A trial with a fragment.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// Its arena.
    pub arena: Arena,
    /// What stands in it.
    pub geometry: Vec<Geometry>,
}

impl Plan {
    /// Number of approaches: of each fragment at each heading.
    pub fn approaches(&self) -> usize {
        self.fragments.len() * self.form.headings
    }
    /// The fragment of an approach, and the heading at which it is approached, in its frame, degrees.
    pub fn approach(&self, number: usize) -> (&Fragment, f64) {
        let heading = (number % self.form.headings) as f64 * 360.0 / self.form.headings as f64;
        (&self.fragments[number / self.form.headings], heading)
    }
    /// Room between a fragment in a window and the rim of its arena.
    pub fn margin(&self, width: f64) -> f64 {
        self.form.margin.unwrap_or((2.0 * self.begin.extent).max(width * STRIDE))
    }
    /// The lateral offset of a number, length, to the left of the approach.
    pub fn offset(&self, width: f64, number: usize) -> f64 {
        width * self.form.span * ((number as f64 + 0.5) / self.form.offsets as f64 - 0.5)
    }
    /// A trial with a fragment that is approached at a heading and an offset. The group begins as its scenario says; the fragment is put
    /// in its way.
    pub fn probe(&self, number: usize, offset: usize) -> Probe {
        let (fragment, heading) = self.approach(number);
        let radius = fragment.radius + self.margin(fragment.width);
        let arena = self.arena(radius, self.offset(fragment.width, offset));
        let own = terrain::fragments::turn(Vector([1.0, 0.0]), self.begin.heading);
        let pose = Pose { at: arena.centre, heading: own - heading };
        Probe { arena, geometry: fragment.geometry.iter().map(|part| part.moved(&pose, [1.0, 1.0])).collect() }
    }
    fn arena(&self, radius: f64, offset: f64) -> Arena {
        let Begin { centre, heading, .. } = self.begin;
        let centre = centre + heading * radius - heading.left() * offset;
        Arena { centre, radius, approach: heading, link: self.form.link.unwrap_or(0.0) }
    }
    /// The arena of a window's width with nothing in it.
    pub fn empty(&self, width: f64) -> Probe {
        Probe { arena: self.arena(width / 2.0 + self.margin(width), 0.0), geometry: Vec::new() }
    }
    /// The seed of a trial: the same for all fragments and approaches. It has 63 bits, so that a file can give it.
    pub fn seed_of(&self, trial: usize) -> u64 {
        child_seed(self.form.seed, PROBE, trial as u64, 0) >> 1
    }
    /// Number of trials in all: with fragments, and in empty arenas.
    pub fn all_trials(&self) -> usize {
        let varied = self.marked.len() * directed::variations(&self.form.vary) * self.varied_trials();
        self.approaches() * self.form.offsets * self.trials + self.empty_trials() + varied
    }
    /// Number of trials in empty arenas.
    pub fn empty_trials(&self) -> usize {
        self.form.windows.len() * self.control_trials()
    }
    /// Trials in each empty arena.
    pub fn control_trials(&self) -> usize {
        self.form.offsets * self.trials
    }
    /// Updates of agents in all, at most: a trial ends when all have left.
    pub fn most_updates(&self) -> u64 {
        self.all_trials() as u64 * self.population.steps * self.population.members() as u64
    }
    /// The sum in words.
    pub fn cost(&self) -> String {
        let mut parts = Vec::new();
        if !self.fragments.is_empty() {
            let all =
                if self.fragments.len() < self.possible { format!(" of {}", self.possible) } else { String::new() };
            parts.push(format!(
                "{}{all} fragments x {} headings x {} offsets x {} trials",
                self.fragments.len(),
                self.form.headings,
                self.form.offsets,
                self.trials
            ));
        }
        if !self.marked.is_empty() {
            let variations = directed::variations(&self.form.vary);
            parts.push(format!(
                "{} stretches x {variations} variations x {} trials",
                self.marked.len(),
                self.varied_trials()
            ));
        }
        parts.join(", ")
    }
    /// What the results depend on: statements may be added, and clusters be made and named in another way.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about, form.claim) = (String::new(), String::new(), Vec::new());
        (form.trials, form.quick_trials, form.scenario) = (self.trials, 1, None);
        (form.cluster, form.effect) = super::form::defaults();
        (form.vary.trials, form.vary.quick_trials, form.vary.least) = (self.varied_trials(), 1, 0.0);
        let mut scenario = self.population.scenario.clone();
        (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
        let geometry: Vec<Geometry> = self.construct.geometry().cloned().collect();
        let construct = terrain::text::wkt::write(&geometry);
        json!({ "decomposition": form.write().json(), "scenario": scenario.write().json(), "construct": construct })
    }
}

/// Reads a decomposition from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String], quick: bool, load: Load<'_>) -> Result<Plan, Problems> {
    let (mut plan, sources) = Files::read(load, |files| planned(files, name, text, sets, quick))?;
    plan.sources = sources;
    Ok(plan)
}

fn planned(files: &mut Files<'_>, name: &str, text: &str, sets: &[String], quick: bool) -> Option<Plan> {
    let tree = opened(files, name, text, sets)?;
    let form = Decomposition::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let construct = construct(files, &form, &workspace.workspace, name, &tree)?;
    let lines = polylines(construct.geometry());
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "decomposition")?;
    let scenario = build::resolved(&base, &mut files.desk)?;
    let population = match Population::new("group", "", base.clone(), scenario, workspace.workspace.units) {
        Ok(population) => population,
        Err(wrong) => {
            files.desk.problem(&base.place(&wrong.path), wrong.what, wrong.expected, wrong.help);
            return None;
        }
    };
    let sliding = !form.windows.is_empty();
    if sliding && !population.scenario.obstacle.is_empty() {
        let what = "the scenario has obstacles of its own, and a fragment is tried alone";
        files.desk.problem(&base.place("obstacle"), what, "no obstacle", "");
        return None;
    }
    let mut fragments = fragments(&form, &construct, &lines, &tree, &mut files.desk)?;
    if let Clustering::AverageLinkage(linkage) = &form.cluster
        && linkage.least > linkage.most
    {
        let what = format!("{} clusters at least are more than {} at most", linkage.least, linkage.most);
        files.desk.problem(&tree.place("cluster.average_linkage"), what, "least up to most", "");
    }
    let trials = if quick { form.quick_trials.min(form.trials) } else { form.trials };
    let possible = fragments.len();
    if let Some(budget) = form.budget.filter(|_| sliding) {
        let each = form.headings * form.offsets * trials;
        let count = (budget / each).min(possible);
        if count == 0 {
            let what = format!("a budget of {budget} trials is less than a single fragment takes");
            files.desk.problem(
                &tree.place("budget"),
                what,
                format!("at least {each}"),
                "fewer headings, offsets or trials",
            );
            return None;
        }
        fragments = (0..count).map(|k| fragments[k * possible / count].clone()).collect();
    }
    let marked = directed::marked(&form.interval.0, &form.vary, &lines, &tree, &mut files.desk);
    let begin = match begun(&population, child_seed(form.seed, PROBE, 1, 0) >> 1) {
        Ok(begin) => begin,
        // stretches stand where they are
        Err(_) if !sliding => Begin { centre: Point::ZERO, heading: Vector([1.0, 0.0]), extent: 0.0 },
        Err(what) => {
            files.desk.problem(&tree.place("scenario"), what, "a group that heads somewhere", "");
            return None;
        }
    };
    if let Some(margin) = form.margin.filter(|margin| *margin < begin.extent) {
        let what = format!("members begin up to {} from their middle", crate::report::short(begin.extent));
        let expected = format!("a margin of at least that, found {margin}");
        files.desk.problem(&tree.place("margin"), what, expected, "");
    }
    let plan = Plan {
        form,
        workspace,
        construct,
        lines,
        fragments,
        possible,
        marked,
        population,
        begin,
        trials,
        sources: Sources::default(),
        sets: sets.to_vec(),
        quick,
    };
    if files.desk.problems.is_empty() {
        if sliding {
            crossed(&plan, &tree, &mut files.desk);
        }
        for number in 0..plan.marked.len() {
            let construct = plan.marked[number].construct(plan.construct.units, 0.0, 1.0);
            if let Err(wrong) = plan.expected(number, &construct, true) {
                files.desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help);
            }
        }
        claims::check(&plan.form.claim, &Results::example(&plan), "claim", &tree, &mut files.desk);
    }
    Some(plan)
}

/// The construct: the candidate, and the lines of the file.
fn construct(
    files: &mut Files<'_>,
    form: &Decomposition,
    workspace: &terrain::Workspace,
    name: &str,
    tree: &Node,
) -> Option<Construct> {
    let mut construct = Construct::new(workspace.units, Vec::new());
    if let Some(candidates) = &form.candidates {
        let mut texts = Vec::new();
        for (path, file) in candidates.files() {
            let (path, text) = files.loaded(name, &file, &tree.place(&path))?;
            files.sources.add(&path, &text);
            texts.push(text);
        }
        let source = candidates.source(&texts, workspace.units, tree, &mut files.desk)?;
        match source.candidate(workspace, form.seed, form.attempt) {
            Ok(Some(made)) if made.units == workspace.units => construct = made,
            Ok(Some(made)) => {
                let what =
                    format!("the construct is in {}, the workspace in {}", made.units.word(), workspace.units.word());
                files.desk.problem(&tree.place("workspace"), what, "the same units", "nothing is converted");
            }
            Ok(None) => {
                let what = format!("there is no candidate {}", form.attempt);
                files.desk.problem(&tree.place("attempt"), what, "a smaller number", "candidates count from 0");
            }
            Err(error) => files.desk.problem(&tree.place("candidates"), error.to_string(), "a construct", ""),
        }
    }
    for (k, line) in form.line.iter().enumerate() {
        let corner = |(j, numbers): (usize, &Vec<f64>)| {
            build::vector::<f64, 2>(numbers).map_err(|what| (format!("line.{k}.{j}"), what))
        };
        match line.iter().enumerate().map(corner).collect::<Result<Vec<Point>, _>>() {
            Ok(points) if points.len() > 1 => {
                let piece = terrain::Piece { name: "line".into(), geometry: along(&points) };
                construct.pieces.push(piece);
            }
            Ok(_) => {
                let what = "a line has at least two points";
                files.desk.problem(&tree.place(&format!("line.{k}")), what, "[[x, y], [x, y], ...]", "");
            }
            Err((path, what)) => files.desk.problem(&tree.place(&path), what, "2 numbers", ""),
        }
    }
    if files.desk.problems.is_empty() && construct.material() <= 0.0 {
        let help = "give lines, line = [[[0, 0], [10, 0]]], or candidates, candidates.files = [\"drawing.wkt\"]";
        files.desk.problem(&tree.span, "there is no construct to be decomposed", "`line` or `candidates`", help);
    }
    files.desk.problems.is_empty().then_some(construct)
}

fn fragments(
    form: &Decomposition,
    construct: &Construct,
    lines: &[Polyline],
    tree: &Node,
    desk: &mut Desk,
) -> Option<Vec<Fragment>> {
    if form.windows.is_empty() && form.interval.0.is_empty() {
        let what = "there is neither a window nor a stretch";
        desk.problem(&tree.place("windows"), what, "at least one width, or [interval.NAME]", "");
        return None;
    }
    if form.split.is_some() && form.windows.is_empty() {
        let what = "what is split is compared with the empty arena of a window, and there is none";
        desk.problem(&tree.place("split"), what, "windows as well", "");
        return None;
    }
    if !form.windows.is_empty() && form.link.is_none() {
        let what = "windows need to know who is of one group, and `link` is missing";
        desk.problem(&tree.place("windows"), what, "a distance", "link = 3");
        return None;
    }
    let mut fragments = Vec::new();
    for (k, &width) in form.windows.iter().enumerate() {
        let count: f64 = lines.iter().map(|line| line.length() / (width * STRIDE) + 1.0).sum();
        if count > MOST as f64 {
            let what = format!("windows of {width} make about {count:.0} fragments");
            desk.problem(&tree.place(&format!("windows.{k}")), what, format!("at most {MOST}"), "a greater width");
            return None;
        }
        for (number, line) in lines.iter().enumerate() {
            let middles = line.middles(width, width * STRIDE);
            fragments.extend(
                middles.into_iter().filter_map(|middle| fragment(construct.geometry(), lines, number, middle, width)),
            );
        }
    }
    if let Some(split) = form.split.as_ref().filter(|_| !form.windows.is_empty()) {
        for (number, line) in lines.iter().enumerate() {
            let stretches = line.stretches(split.corner, split.over);
            fragments.extend(stretches.into_iter().filter_map(|(from, to)| stretch(lines, number, from, to)));
        }
    }
    Some(fragments)
}

/// How a group begins.
fn begun(population: &Population, seed: u64) -> Result<Begin, String> {
    let mut begin = None;
    let mut first = |moment: &measure::behaviours::Moment<'_>| {
        let places: Vec<Point> = moment.positions.iter().flatten().copied().collect();
        let count = places.len().max(1) as f64;
        let centre = places.iter().fold(Point::ZERO, |sum, at| sum + *at) / count;
        let ways = moment.velocities.iter().flatten().map(|velocity| velocity.unit());
        let heading = ways.fold(Point::ZERO, |sum, way| sum + way) / count;
        let extent = places.iter().map(|at| (*at - centre).length()).fold(0.0, f64::max);
        begin = Some((centre, heading, extent));
        true
    };
    trial::follow(&population.scenario, population, seed, &|| false, &mut first)
        .map_err(|what| format!("the group cannot begin: {what}"))?;
    match begin {
        Some((centre, heading, extent)) if heading.length() >= ALIGNED => {
            Ok(Begin { centre, heading: heading.unit(), extent })
        }
        _ => Err(
            "the group heads nowhere in common at its start, so that nothing can be put in its way; give its start a \
                 heading, heading.along = [1, 0]"
                .to_owned(),
        ),
    }
}

/// Whether a trial lasts long enough to cross the largest arena where nothing is in the way.
fn crossed(plan: &Plan, tree: &Node, desk: &mut Desk) {
    let widths = plan.fragments.iter().map(|fragment| 2.0 * fragment.radius).chain(plan.form.windows.iter().copied());
    let largest = widths.fold(0.0, f64::max);
    let probe = plan.empty(largest);
    match super::execute::once(plan, &probe, plan.seed_of(1), &|| false) {
        Err(what) => desk.problem(&tree.place("scenario"), what, "not possible", ""),
        Ok(None) => {}
        Ok(Some((watch, steps))) => {
            let mut sum = super::probe::Sum::default();
            watch.add_to(&mut sum);
            let stay = sum.descriptor().map_or(1.0, |numbers| numbers[super::probe::place("stay")]);
            if stay > 0.5 {
                let what = format!(
                    "after {steps} steps {:.0} % of the group are still in an empty arena of radius {}",
                    stay * 100.0,
                    crate::report::short(probe.arena.radius)
                );
                let help = "a longer time.duration, smaller windows, or a model that keeps its heading";
                desk.problem(&tree.place("scenario"), what, "at most half", help);
            }
        }
    }
}
