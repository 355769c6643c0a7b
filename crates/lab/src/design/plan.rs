//! From a design file to a workspace, candidates, groups and behaviours.

use super::form::Design;
use super::inverse::{self, Inverse};
use super::results::Results;
use crate::environment::behaviour::Around;
use crate::environment::candidates::Source;
use crate::environment::doors::{Door, DoorForm};
use crate::environment::filter;
use crate::environment::stages::{Staged, WHOLE};
use crate::environment::trial::{self, Population, Wanted};
use crate::environment::workspace::Resolved;
use crate::environment::{claims, trial::populations};
use crate::file::tree::parse;
use crate::file::{Desk, Form, Node, Problems, Rule, Sources, Span};
use crate::scenario::build;
use crate::study::plan::{Files, Load};
use measure::statistics::SequentialTest;
use serde_json::{Value as Json, json};
use space::random::child_seed;
use terrain::filters::Combined;
use terrain::generate::{Counts, Generation};
use terrain::hierarchy::Composition;
use terrain::{Construct, Environment};

/// Kinds of child seeds, beside those of searches: a candidate, and a trial of it.
pub(super) const CANDIDATE: u32 = 4;
pub(crate) const TRIAL: u32 = 5;
/// A trial of a stage by itself.
const STAGE: u32 = 14;
/// Candidates looked at for one that behaviours can be checked with.
const LOOKED_AT: u64 = 1000;

/// A design as resolved.
pub struct Plan {
    /// What was written.
    pub form: Design,
    /// What is there already.
    pub workspace: Resolved,
    /// Where candidates come from.
    pub source: Source,
    /// What makes them feasible.
    pub filter: Combined,
    /// The groups.
    pub populations: Vec<Population>,
    /// When to stop trying.
    pub sequential: Option<SequentialTest>,
    /// Which group it is, where that is asked.
    pub inverse: Option<Inverse>,
    /// Most candidates that are generated.
    pub attempts: u64,
    /// The texts of the files that candidates come from.
    pub texts: Vec<String>,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

/// The candidates that were generated.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// How many came how far.
    pub counts: Counts,
    /// The feasible ones, by their attempts.
    pub feasible: Vec<(u64, Construct)>,
}

impl Plan {
    /// Generates and filters.
    ///
    /// # Errors
    /// A candidate that is impossible in the workspace, in a sentence.
    pub fn survey(&self) -> Result<Survey, String> {
        self.generated(self.attempts, self.form.feasible.unwrap_or(u64::MAX))
    }
    fn generated(&self, attempts: u64, wanted: u64) -> Result<Survey, String> {
        let generation = Generation {
            candidates: &self.source,
            workspace: &self.workspace.workspace,
            placement: self.form.placement.into(),
            filter: &self.filter,
            seed: self.form.seed,
            wanted,
            first: 0,
            attempts,
        };
        let mut feasible = Vec::new();
        let keep = |environment: Environment, _: bool| {
            feasible.push((environment.construct.provenance.attempt, environment.construct));
        };
        let counts = generation.run(|_| false, keep).map_err(|error| error.to_string())?;
        Ok(Survey { counts, feasible })
    }
    /// Names of what is wanted, in order: of stages, these and all together; then the behaviours of the file.
    pub fn behaviour_names(&self) -> Vec<&str> {
        let mut names = Vec::new();
        if let Source::Stages(stages) = &self.source {
            names.extend(stages.names());
            names.push(WHOLE);
        }
        names.extend(self.form.behaviour.0.iter().map(|(name, _)| name.as_str()));
        names
    }
    /// What each of them is, in a sentence.
    pub fn behaviour_words(&self) -> Vec<String> {
        let mut words = Vec::new();
        if let Source::Stages(stages) = &self.source {
            words.extend(stages.words());
            words.push("the product of the fitnesses of all stages".into());
        }
        words.extend(self.form.behaviour.0.iter().map(|(_, form)| form.words()));
        words
    }
    /// How many stages there are; none where candidates have none.
    pub fn stages(&self) -> usize {
        if let Source::Stages(stages) = &self.source { stages.names().len() } else { 0 }
    }
    /// What is wanted where a construct stands in the workspace, and the path and the words of what is wrong.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn behaviours(
        &self,
        population: &Population,
        construct: &Construct,
        built: bool,
    ) -> Result<Wanted, build::Wrong> {
        let mut wanted = self.of_workspace(population, construct, built)?;
        if let Some((stages, whole)) = self.composed(construct) {
            let around = |part: &Construct| self.workspace.setting(part, built);
            wanted.relay = Some(stages.relay(&whole, &population.groups, &around)?);
            for k in 0..if built { whole.parts.len() } else { 0 } {
                wanted.doors.extend(stages.doors(k, &whole, &population.groups, &around)?);
            }
        }
        Ok(wanted)
    }
    /// Each stage of a candidate by itself: what is built of it, and what is wanted. Nothing where candidates have no stages.
    ///
    /// # Errors
    /// As [`Plan::behaviours`].
    pub fn alone(
        &self,
        population: &Population,
        construct: &Construct,
    ) -> Result<Vec<(Construct, Wanted)>, build::Wrong> {
        let Some((stages, whole)) = self.composed(construct) else { return Ok(Vec::new()) };
        let around = |part: &Construct| self.workspace.setting(part, true);
        let relay = stages.relay(&whole, &population.groups, &around)?;
        let one = |(k, part): (usize, &Construct)| {
            let mut wanted = Wanted { behaviours: Vec::new(), ..self.of_workspace(population, part, true)? };
            wanted.relay = Some(relay.alone(k));
            wanted.doors.extend(stages.doors(k, &whole, &population.groups, &around)?);
            Ok((part.clone(), wanted))
        };
        whole.parts.iter().enumerate().map(one).collect()
    }
    /// The stages that a construct was put together of.
    fn composed(&self, construct: &Construct) -> Option<(&Staged, Composition)> {
        let Source::Stages(stages) = &self.source else { return None };
        let attempt = construct.provenance.attempt;
        // what was generated once is generated again
        let whole = stages.composed(&self.workspace.workspace, self.form.seed, attempt).ok().flatten()?;
        Some((stages, whole))
    }
    /// The behaviours and the doors of the file, without those of stages.
    fn of_workspace(
        &self,
        population: &Population,
        construct: &Construct,
        built: bool,
    ) -> Result<Wanted, build::Wrong> {
        let setting = self.workspace.setting(construct, built);
        let around = Around { setting: &setting, groups: &population.groups };
        let one = |(name, form): &(String, crate::environment::behaviour::BehaviourForm)| {
            form.plain(name, around).map_err(|wrong| wrong.below(&format!("behaviour.{name}")))
        };
        let behaviours = self.form.behaviour.0.iter().map(one).collect::<Result<_, _>>()?;
        let door = |(name, form): &(String, DoorForm)| {
            let door = form.wall().and_then(|wall| form.door(name, wall, around));
            door.map_err(|wrong| wrong.below(&format!("door.{name}")))
        };
        let doors = self.form.door.0.iter().map(door).collect::<Result<_, _>>()?;
        Ok(Wanted { relay: None, behaviours, doors })
    }
    /// The doors where a construct stands.
    pub fn doors(&self, construct: &Construct) -> Vec<Door> {
        let wanted = self.populations.first().map(|population| self.behaviours(population, construct, true));
        wanted.and_then(Result::ok).map_or_else(Vec::new, |wanted| wanted.doors)
    }
    /// The seed of a trial of a stage by itself.
    pub fn seed_alone(&self, attempt: u64, trial: usize, stage: usize) -> u64 {
        child_seed(child_seed(self.form.seed, CANDIDATE, attempt, 0), STAGE, trial as u64, stage as u32) >> 1
    }
    /// The seed of a trial of a candidate: the same for all groups, with the construct and without it. It has 63 bits, so
    /// that a file can give it.
    pub fn seed_of(&self, attempt: u64, trial: usize) -> u64 {
        child_seed(child_seed(self.form.seed, CANDIDATE, attempt, 0), TRIAL, trial as u64, 0) >> 1
    }
    /// What the results of a candidate depend on: candidates may be added, and statements are made afterwards.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.title, form.about) = (String::new(), String::new());
        (form.attempts, form.quick_attempts, form.feasible) = (1, 1, None);
        (form.show, form.export) = (0, 0);
        form.claim = Vec::new();
        // what unknown groups were seen to do is kept as it was seen, whatever is made of it
        form.inverse = None;
        form.scenario = None;
        let scenario = |population: &Population| {
            let mut scenario = population.scenario.clone();
            (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
            (population.name.clone(), scenario.write().json())
        };
        let scenarios: serde_json::Map<String, Json> = self.populations.iter().map(scenario).collect();
        let there = terrain::text::wkt::write(&self.workspace.workspace.geometry);
        json!({ "design": form.write().json(), "scenarios": scenarios, "workspace": there, "files": self.texts })
    }
}

/// Reads a design from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String], quick: bool, load: Load<'_>) -> Result<Plan, Problems> {
    let (mut plan, sources) = Files::read(load, |files| planned(files, name, text, sets, quick))?;
    plan.sources = sources;
    Ok(plan)
}

/// The text of a file and what is put over it, as a tree.
pub(crate) fn opened(files: &mut Files<'_>, name: &str, text: &str, sets: &[String]) -> Option<Node> {
    let source = files.sources.add(name, text);
    let mut tree = parse(&files.sources, source, &mut files.desk.problems);
    build::put(&mut tree, sets, &mut files.sources, &mut files.desk);
    files.desk.problems.is_empty().then_some(tree)
}

/// The workspace of a file.
pub(crate) fn workspace(
    files: &mut Files<'_>,
    form: &crate::environment::workspace::Workspace,
    name: &str,
    tree: &Node,
) -> Option<Resolved> {
    let text = match form.picture() {
        Some(picture) => files.loaded(name, &picture.name, &tree.place("workspace.base.file.name"))?,
        None => (String::new(), String::new()),
    };
    if form.picture().is_some() {
        files.sources.add(&text.0, &text.1);
    }
    match form.resolved(&text.1) {
        Ok(resolved) => Some(resolved),
        Err(wrong) => {
            let place = tree.place(&format!("workspace.{}", wrong.path));
            files.desk.problem(&place, wrong.what, wrong.expected, wrong.help);
            None
        }
    }
}

fn planned(files: &mut Files<'_>, name: &str, text: &str, sets: &[String], quick: bool) -> Option<Plan> {
    let tree = opened(files, name, text, sets)?;
    let form = Design::read(&tree, &Rule { name: "the file", ..Rule::FREE }, &mut files.desk)
        .filter(|_| files.desk.problems.is_empty())?;
    let workspace = workspace(files, &form.workspace, name, &tree)?;
    let mut texts = Vec::new();
    for (path, file) in form.candidates.files() {
        let (path, text) = files.loaded(name, &file, &tree.place(&path))?;
        files.sources.add(&path, &text);
        texts.push(text);
    }
    let units = workspace.workspace.units;
    let mut source = form.candidates.source(&texts, units, &tree, &mut files.desk)?;
    let filter = filter::all_of(&form.filter, &tree, &mut files.desk);
    let start = Span { source: tree.span.source, bytes: 0..0 };
    let base = files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "design")?;
    let populations = populations(&base, &form.population, units, files)?;
    if let Source::Stages(stages) = &mut source {
        wide(stages, &populations, &tree, &mut files.desk)?;
    }
    let sequential = match &form.sequential {
        None => None,
        Some(test) => match SequentialTest::new(test.lower, test.higher, test.alpha, test.beta, form.trials as u32) {
            Ok(test) => Some(test),
            Err(error) => {
                files.desk.problem(&tree.place("sequential"), error.to_string(), "not possible", "");
                None
            }
        },
    };
    if let Some(robustness) = &form.robustness {
        let mut behaviours: Vec<&str> = form.behaviour.0.iter().map(|(name, _)| name.as_str()).collect();
        if let Source::Stages(stages) = &source {
            behaviours.extend(stages.names().into_iter().chain([WHOLE]));
        }
        let groups: Vec<&str> = populations.iter().map(|population| population.name.as_str()).collect();
        for (key, given, known) in
            [("behaviour", &robustness.behaviour, behaviours), ("population", &robustness.population, groups)]
        {
            if let Some(name) = given.as_deref().filter(|name| !known.contains(name)) {
                let near = space::spelling::nearest(name, known.iter().copied());
                let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
                let place = tree.place(&format!("robustness.{key}"));
                files.desk.problem(&place, format!("there is no {key} `{name}`"), "one of the file's", help);
            }
        }
    }
    if let Source::Stages(stages) = &source {
        for (name, _) in form.behaviour.0.iter().filter(|(name, _)| name == WHOLE || stages.names().contains(&&**name))
        {
            let what = format!("`{name}` is the name of a stage, or of all");
            files.desk.problem(&tree.place(&format!("behaviour.{name}")), what, "another name", "");
        }
    } else if form.behaviour.0.is_empty() {
        files.desk.problem(&tree.place("behaviour"), "nothing is wanted", "at least one [behaviour.NAME]", "");
    }
    let inverse = form
        .inverse
        .as_ref()
        .and_then(|asked| inverse::read(asked, &form, &populations, quick, &tree, &mut files.desk));
    let attempts = if quick { form.quick_attempts.min(form.attempts) } else { form.attempts };
    let plan = Plan {
        form,
        workspace,
        source,
        filter,
        populations,
        sequential,
        inverse,
        attempts,
        texts,
        sources: Sources::default(),
        sets: sets.to_vec(),
        quick,
    };
    if files.desk.problems.is_empty() {
        tried(&plan, &tree, &mut files.desk);
    }
    Some(plan)
}

/// Tells stages how wide the widest body of all groups is.
fn wide(stages: &mut Staged, populations: &[Population], tree: &Node, desk: &mut Desk) -> Option<()> {
    let mut widest: f64 = 0.0;
    for population in populations {
        match population.widest() {
            Ok(radius) => widest = widest.max(radius),
            Err(what) => {
                let what = format!("`{}` cannot begin: {what}", population.name);
                desk.problem(&tree.place("scenario"), what, "not possible", "");
                return None;
            }
        }
    }
    if let Some(stage) = stages.unknown_width().filter(|_| widest <= 0.0) {
        let place = tree.place(&format!("candidates.stages.{stage}.name"));
        desk.problem(&place, "bodies have no radius", "a `clearance` for its ways", "");
        return None;
    }
    stages.widest(widest);
    Some(())
}

/// Whether a first feasible candidate gives a world in which the behaviours have a meaning.
fn tried(plan: &Plan, tree: &Node, desk: &mut Desk) {
    let construct = match plan.generated(LOOKED_AT, 1) {
        Ok(survey) => match survey.feasible.into_iter().next() {
            Some((_, construct)) => construct,
            None => {
                let why: Vec<String> =
                    survey.counts.reasons.iter().map(|(reason, count)| format!("{count}: {reason}")).collect();
                let what = format!("none of the first {} candidates is feasible", survey.counts.generated);
                desk.problem(&tree.place("filter"), what, why.join("; "), "");
                return;
            }
        },
        Err(what) => {
            desk.problem(&tree.place("candidates"), what, "not possible", "");
            return;
        }
    };
    for population in &plan.populations {
        match plan.behaviours(population, &construct, true) {
            Err(wrong) => desk.problem(&tree.place(&wrong.path), wrong.what, wrong.expected, wrong.help),
            Ok(behaviours) => {
                let geometry = plan.workspace.workspace.geometry.iter().chain(construct.geometry());
                let scenario = population.among(geometry);
                // stopped at once: that it can begin is what is asked
                if let Err(what) =
                    trial::relayed(&scenario, population, &behaviours, plan.seed_of(0, 1), &|| true, &mut |_| ())
                {
                    let what = format!("`{}` cannot begin: {what}", population.name);
                    desk.problem(&tree.place("scenario"), what, "not possible", "");
                }
            }
        }
    }
    claims::check(&plan.form.claim, &Results::example(plan), "claim", tree, desk);
    inverse::check(plan, tree, desk);
}
