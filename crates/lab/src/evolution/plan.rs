//! From an evolution file to genes, a search and a fitness.

use super::form::{Evolution, Gene, Genetic, MapElites, Search};
use super::tables::RESERVED;
use super::variants::{self, Variants};
use crate::file::tree::parse;
use crate::file::{Desk, Form, Named, Node, Problems, Rule, Sources, Span, Tree};
use crate::scenario::Scenario;
use crate::scenario::agents::{in_radians, unit_in_files};
use crate::scenario::build::{self, Schedule};
use crate::study::expression::Expression;
use crate::study::plan::{Files, Load, entry_place, usual_readings, within};
use crate::study::{self, form::Window};
use search::elites::{Elites, ElitesOptions};
use search::evolution_strategy::{EvolutionStrategy, StrategyOptions};
use search::{Axis, Domain};
use serde_json::{Value as Json, json};
use space::spelling::nearest;
use swarm::parameters::{Descriptor, Kind, Range};

/// A number that is searched over.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneAxis {
    /// Its name in tables: that of the gene, with its place where the gene is a list.
    pub name: String,
    /// What it is.
    pub about: String,
    /// Its unit.
    pub unit: String,
    /// The gene it belongs to, by index.
    pub gene: usize,
    /// Its place in the gene, where that is a list.
    pub place: Option<usize>,
    /// Its bounds and reference.
    pub axis: Axis,
    /// Between which the first candidates are drawn.
    pub start: (f64, f64),
}

/// Where candidates share a world.
#[derive(Clone, Debug, PartialEq)]
pub struct SharedWorld {
    /// The group, by index.
    pub group: usize,
    /// Its members.
    pub count: usize,
    /// Members of a candidate.
    pub members: usize,
    /// Number of candidates, of each of the two groups where both evolve.
    pub candidates: usize,
    /// The group that evolves as well, by index.
    pub rival: Option<usize>,
    /// The parameter that each gene is.
    pub parameters: Vec<String>,
}

/// An evolution as resolved.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What was written.
    pub form: Evolution,
    /// The scenario in which genes are put.
    pub scenario: Scenario,
    /// Its tree.
    pub tree: Node,
    /// Its steps.
    pub schedule: Schedule,
    /// Number of its agents.
    pub agents: u64,
    /// The numbers that are searched over.
    pub axes: Vec<GeneAxis>,
    /// Where candidates share a world.
    pub shared: Option<SharedWorld>,
    /// Expressions by which values of the scenario follow from genes, by path.
    pub derive: Vec<(String, Expression)>,
    /// How good a candidate is.
    pub fitness: Expression,
    /// What is kept of a shared world.
    pub keep: Vec<(String, Expression)>,
    /// Numbers that are followed beside the genes: expressions over genes.
    pub follow: Vec<(String, Expression)>,
    /// What makes kinds differ, in a search for the best of every kind.
    pub kinds: Vec<(String, Expression)>,
    /// What is read off a world, and when it is looked at.
    pub readings: study::Plan,
    /// Generations of a run.
    pub generations: usize,
    /// The texts it was read from, with their names; the first is the file itself.
    pub sources: Sources,
    /// What was put over the file.
    pub sets: Vec<String>,
    /// Whether it was planned quick.
    pub quick: bool,
}

impl Plan {
    /// The seed of a run, which counts from 1.
    pub fn seed_of(&self, run: usize) -> u64 {
        self.form.seed.wrapping_add(run as u64 - 1)
    }
    /// The box that is searched.
    ///
    /// # Errors
    /// As [`Domain::new`]; none for a plan that was read.
    pub fn domain(&self) -> Result<Domain, search::SearchError> {
        Domain::new(self.axes.iter().map(|gene| gene.axis).collect())
    }
    /// Names of what is kept of a candidate's worlds (or of a shared world), in order.
    pub fn kept(&self) -> Vec<&str> {
        match self.shared {
            Some(_) => self.keep.iter().map(|(name, _)| name.as_str()).collect(),
            None => self.readings.readings.iter().map(|(name, _)| name.as_str()).collect(),
        }
    }
    /// Which of the candidates of a generation are its own, not those of a rival.
    pub fn own<'a, T>(&self, candidates: &'a [T]) -> &'a [T] {
        match &self.shared {
            Some(shared) => &candidates[..shared.candidates.min(candidates.len())],
            None => candidates,
        }
    }
    /// Updates of agents in a generation of so many candidates.
    pub fn updates(&self, candidates: usize) -> u64 {
        let worlds = if self.shared.is_some() { 1 } else { candidates * self.form.trials };
        worlds as u64 * self.agents * self.schedule.steps
    }
    /// What the results depend on, apart from runs and generations, which may be added.
    pub fn identity(&self) -> Json {
        let mut form = self.form.clone();
        (form.runs, form.generations, form.quick_generations) = (1, 1, 1);
        (form.title, form.about) = (String::new(), String::new());
        let mut scenario = self.scenario.clone();
        (scenario.title, scenario.about, scenario.seed) = (String::new(), String::new(), None);
        // what is asked of the results
        (form.quick_runs, form.follow, form.vary, form.contest) = (None, Named::default(), Named::default(), None);
        (form.figure, form.test, form.claim) = (Vec::new(), Vec::new(), Vec::new());
        form.scenario = None;
        json!({ "evolution": form.write().json(), "scenario": scenario.write().json() })
    }
    /// The first candidates of a genetic algorithm.
    pub fn first(&self, genetic: &Genetic, seed: u64) -> Result<Vec<Vec<f64>>, search::SearchError> {
        let starts = self.axes.iter().map(|gene| Axis { low: gene.start.0, high: gene.start.1, ..gene.axis });
        let mut first =
            search::genetic::Genetic::random(&Domain::new(starts.collect())?, self.candidates(genetic), seed);
        if let (super::form::Start::WithReference, Some(one)) = (genetic.start, first.first_mut()) {
            *one = self.reference();
        }
        Ok(first)
    }
    /// The references of all genes.
    pub fn reference(&self) -> Vec<f64> {
        self.axes.iter().map(|gene| gene.axis.reference).collect()
    }
    /// Number of candidates of a genetic algorithm.
    pub fn candidates(&self, genetic: &Genetic) -> usize {
        match &self.shared {
            Some(shared) => shared.candidates,
            None => genetic.candidates.unwrap_or(20),
        }
    }
    /// How its evolution strategy begins.
    pub fn strategy(&self, form: &super::form::CmaEs) -> StrategyOptions {
        let candidates = match &self.shared {
            Some(shared) => shared.candidates,
            None => form.candidates.unwrap_or(0),
        };
        StrategyOptions { candidates, first_step: form.first_step }
    }
    /// How its map of elites is made, and over which kinds.
    ///
    /// # Errors
    /// Kinds that are no intervals.
    pub fn elites(&self, form: &MapElites) -> Result<(ElitesOptions, Domain), search::SearchError> {
        let options = ElitesOptions {
            cells: form.cells,
            candidates: form.candidates,
            random_rounds: form.random_generations,
            isotropic: form.isotropic,
            along_line: form.along_line,
        };
        Ok((options, Domain::new(form.kind.0.iter().map(|(_, kind)| Axis::new(kind.low, kind.high)).collect())?))
    }
    /// The genes as values of the scenario, by the index of the gene: a number or a list.
    pub fn values(&self, genes: &[f64]) -> Vec<Tree> {
        let of = |gene: usize| {
            let own: Vec<(&GeneAxis, f64)> =
                self.axes.iter().zip(genes.iter().copied()).filter(|(axis, _)| axis.gene == gene).collect();
            match own.as_slice() {
                [(axis, value)] if axis.place.is_none() => Tree::Number(*value),
                many => Tree::list(many.iter().map(|(_, value)| Tree::Number(*value))),
            }
        };
        (0..self.form.gene.0.len()).map(of).collect()
    }
}

/// Reads an evolution from its text, the values put over it, and the files it names.
///
/// # Errors
/// Everything that is wrong with it, at its place.
pub fn read(name: &str, text: &str, sets: &[String], quick: bool, load: Load<'_>) -> Result<Variants, Problems> {
    let mut reader = Reader { files: Files { sources: Sources::default(), desk: Desk::default(), load } };
    let variants = reader.variants(name, text, sets, quick);
    let Reader { files } = reader;
    match variants {
        Some(mut variants) if files.desk.problems.is_empty() => {
            for plan in &mut variants.plans {
                plan.sources.clone_from(&files.sources);
            }
            Ok(variants)
        }
        _ => Err(Problems::new(files.sources, files.desk.problems)),
    }
}

struct Reader<'a> {
    files: Files<'a>,
}

impl Reader<'_> {
    fn variants(&mut self, name: &str, text: &str, sets: &[String], quick: bool) -> Option<Variants> {
        let source = self.files.sources.add(name, text);
        let mut file = parse(&self.files.sources, source, &mut self.files.desk.problems);
        build::put(&mut file, sets, &mut self.files.sources, &mut self.files.desk);
        if !self.files.desk.problems.is_empty() {
            return None;
        }
        let file = self.files.extended(name, file, 0)?;
        let form = self.form(&file)?;
        let (factors, files) = variants::of(&form, &file, &mut self.files.desk)?;
        let (levels, files): (Vec<Vec<usize>>, Vec<Node>) = files.into_iter().unzip();
        let plans = files.iter().map(|file| self.plan(file, sets, quick)).collect::<Option<Vec<Plan>>>()?;
        let names = |plan: &Plan| plan.axes.iter().map(|axis| axis.name.clone()).collect::<Vec<_>>();
        if let Some(other) =
            plans.iter().position(|plan| names(plan) != names(&plans[0]) || plan.kept() != plans[0].kept())
        {
            let what = format!("the genes and readings of variant {} are not those of the first", other + 1);
            self.files.desk.problem(&file.place("vary"), what, "the same for all variants", "");
        }
        let variants = Variants { plans, factors, levels };
        self.names_are_free(&variants, &file);
        if self.files.desk.problems.is_empty() {
            super::answers::check(&variants, &file, &self.files.sources, &mut self.files.desk);
        }
        self.files.desk.problems.is_empty().then_some(variants)
    }
    fn form(&mut self, file: &Node) -> Option<Evolution> {
        Evolution::read(file, &Rule { name: "the file", ..Rule::FREE }, &mut self.files.desk)
            .filter(|_| self.files.desk.problems.is_empty())
    }

    /// Whether every name can be one of expressions and columns, and is there once.
    fn names_are_free(&mut self, variants: &Variants, file: &Node) {
        let plan = variants.first();
        let of = |key: &'static str, name: &str, entry: &str| (key, name.to_owned(), entry.to_owned());
        let genes = plan.axes.iter().map(|axis| of("gene", &axis.name, &plan.form.gene.0[axis.gene].0));
        let given = |key: &'static str, names: Vec<String>| names.into_iter().map(move |name| of(key, &name, &name));
        let first = |list: &[(String, Expression)]| list.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        let kept = plan.kept().into_iter().map(str::to_owned).collect();
        let readings = given(if plan.shared.is_some() { "keep" } else { "reading" }, kept);
        let varied = variants.factors.iter().map(|factor| factor.name.clone()).collect();
        let all = genes
            .chain(readings)
            .chain(given("search.map_elites.kind", first(&plan.kinds)))
            .chain(given("follow", first(&plan.follow)))
            .chain(given("vary", varied));
        let mut seen: Vec<(&str, String)> = Vec::new();
        for (key, name, entry) in all {
            let place = file.place(&format!("{key}.{entry}"));
            let mut refuse = |what: String, expected: &str| self.files.desk.problem(&place, what, expected, "");
            let letters = name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
            if !letters || !name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') {
                refuse(format!("`{name}` cannot be a name"), "names have letters, digits and `_`");
            } else if RESERVED.contains(&name.as_str()) {
                refuse(format!("a column of the tables is called `{name}` already"), "another name");
            } else if let Some((other, _)) = seen.iter().find(|(_, own)| *own == name) {
                refuse(format!("`{name}` is in `{other}` already"), "another name");
            }
            seen.push((key, name));
        }
    }

    /// One variant.
    fn plan(&mut self, file: &Node, sets: &[String], quick: bool) -> Option<Plan> {
        let source = file.span.source;
        let mut form = self.form(file)?;
        if let (true, Some(runs)) = (quick, form.quick_runs) {
            form.runs = runs;
        }
        let start = Span { source, bytes: 0..0 };
        let tree = self.files.scenario(form.scenario.as_ref(), &form.title, &form.set.0, &start, "evolution")?;
        let scenario = build::resolved(&tree, &mut self.files.desk)?;
        let schedule = build::schedule(&scenario, false).ok()?;
        let agents = scenario.group.0.iter().map(|(_, group)| group.count as u64).sum();
        let defaults = Node { tree: scenario.write(), span: tree.span.clone() };
        let mut axes = Vec::new();
        for (k, (name, gene)) in form.gene.0.iter().enumerate() {
            let place = file.place(&format!("gene.{name}"));
            self.gene(k, name, gene, &place, &scenario, &defaults, &mut axes);
        }
        if axes.is_empty() && self.files.desk.problems.is_empty() {
            self.files.desk.problem(&file.place("gene"), "there is nothing to search over", "at least one gene", "");
        }
        let shared = self.shared(&form, &scenario, file);
        if let Search::Genetic(genetic) = &form.search {
            genetic.check("search.genetic", file, &mut self.files.desk);
        }
        let derive = self.expressions("derive", &form.derive, file);
        let keep = self.expressions("keep", &form.keep, file);
        let follow = self.expressions("follow", &form.follow, file);
        let kinds = match &form.search {
            Search::MapElites(elites) => {
                let of = elites.kind.0.iter().map(|(name, kind)| (name.clone(), kind.of.clone())).collect();
                self.expressions("search.map_elites.kind", &Named(of), file)
            }
            _ => Vec::new(),
        };
        let fitness = self.expression(&form.fitness, &file.place("fitness"));
        if let (Some(_), Some((_, first))) = (&form.shared, form.reading.0.first()) {
            let what = "readings are read off worlds of a candidate's own; `keep` says what is kept of a shared world";
            let place = entry_place(file, "reading", &form.reading.0[0].0);
            self.files.desk.problem(&place, what, "leave it out", first.about.clone());
        }
        if form.shared.is_none() && !form.keep.0.is_empty() {
            let what = "`keep` is for a shared world; readings say what is kept of a candidate's own";
            self.files.desk.problem(&file.place("keep"), what, "leave it out", "");
        }
        let usual = Window { from: None, interval: schedule.measure as f64 * schedule.step };
        let readings = study::Plan {
            title: form.title.clone(),
            about: String::new(),
            seed: form.seed,
            parts: Vec::new(),
            claims: Vec::new(),
            cells: Vec::new(),
            conditions: Vec::new(),
            readings: if form.reading.0.is_empty() { usual_readings(&scenario) } else { form.reading.0.clone() },
            looks: form.looks.clone().unwrap_or(usual),
            units: (scenario.units.length.clone(), scenario.units.time.clone()),
            sources: Sources::default(),
            sets: Vec::new(),
            quick,
        };
        if !self.files.desk.problems.is_empty() {
            return None;
        }
        let generations = if quick { form.quick_generations } else { form.generations };
        let plan = Plan {
            form,
            scenario,
            tree,
            schedule,
            agents,
            axes,
            shared,
            derive,
            fitness: fitness?,
            keep,
            follow,
            kinds,
            readings,
            generations,
            sources: Sources::default(),
            sets: sets.to_vec(),
            quick,
        };
        self.tried(&plan, file);
        Some(plan)
    }

    /// The axes of a gene.
    fn gene(
        &mut self,
        index: usize,
        name: &str,
        gene: &Gene,
        place: &Span,
        scenario: &Scenario,
        defaults: &Node,
        axes: &mut Vec<GeneAxis>,
    ) {
        let desk = &mut self.files.desk;
        let descriptor = gene.path.as_deref().and_then(|path| descriptor(scenario, path));
        let at = |path: &str| path.split('.').try_fold(defaults.clone(), |node, part| node.get(part).cloned());
        let value = gene.path.as_deref().and_then(at).map(|node| node.tree);
        let references: Vec<f64> = match (&value, gene.reference) {
            (Some(Tree::List(list)), given) => match list.iter().map(|node| node.tree.number()).collect() {
                Some(numbers) => {
                    let numbers: Vec<f64> = numbers;
                    numbers.into_iter().map(|number| given.unwrap_or(number)).collect()
                }
                None => {
                    desk.problem(place, format!("`{name}` is no list of numbers"), "numbers can be searched over", "");
                    return;
                }
            },
            (_, Some(reference)) => vec![reference],
            (Some(tree), None) => match tree.number() {
                Some(number) => vec![number],
                None => {
                    let what = format!("`{name}` is {}", tree.describe());
                    desk.problem(place, what, "numbers can be searched over", "");
                    return;
                }
            },
            (None, None) => {
                let what = match &gene.path {
                    Some(path) => format!("`{path}` names no value of the scenario"),
                    None => format!("the gene `{name}` has neither a path nor a reference"),
                };
                let help = "paths are as in group.fish.model.couzin_2002.orientation_radius; give `reference` where \
                            the scenario has no value yet";
                desk.problem(place, what, "expected a number", help);
                return;
            }
        };
        let natural = descriptor.as_ref().map_or((None, None), natural_ends);
        let (Some(low), Some(high)) = (gene.low.or(natural.0), gene.high.or(natural.1)) else {
            let missing = if gene.low.or(natural.0).is_none() { "low" } else { "high" };
            let what = format!("the gene `{name}` has no `{missing}`, and its parameter none of its own");
            desk.problem(place, what, format!("`{missing}` is missing"), "");
            return;
        };
        let list = matches!(value, Some(Tree::List(_)));
        for (k, &reference) in references.iter().enumerate() {
            let scaled = |given: f64| if gene.relative { given * reference } else { given };
            let ends = |(a, b): (f64, f64)| (scaled(a).min(scaled(b)), scaled(a).max(scaled(b)));
            let (low, high) = if gene.relative { ends((low, high)) } else { (low, high) };
            let start = match gene.start.as_deref() {
                None => (low, high),
                Some([a, b]) if a <= b => ends((*a, *b)),
                Some(_) => {
                    desk.problem(place, "start takes [least, greatest]", "two numbers in order", "");
                    return;
                }
            };
            // a gene that does not differ at the start still has a range to be drawn from
            let start = (start.0.clamp(low, high), start.1.clamp(low, high));
            let start = if start.0 < start.1 { start } else { (low, high) };
            if Domain::new(vec![Axis::new(low, high)]).is_err() {
                let what = format!("the gene `{name}` runs from {low} to {high}");
                let help = if gene.relative && reference == 0.0 { "no multiple of 0 is another number" } else { "" };
                desk.problem(place, what, "two finite numbers, the lower first", help);
                return;
            }
            if !(low..=high).contains(&reference) {
                let what = format!("the reference of `{name}`, {reference}, is not between {low} and {high}");
                desk.problem(place, what, "a reference between the bounds", "");
                return;
            }
            let about = if gene.about.is_empty() { name } else { &gene.about };
            axes.push(GeneAxis {
                name: if list { format!("{name}_{k}") } else { name.to_owned() },
                about: if list { format!("{about}, entry {k}") } else { about.to_owned() },
                unit: if gene.unit.is_empty() {
                    descriptor.as_ref().map_or(String::new(), |d| scenario.units.of(&unit_in_files(d)))
                } else {
                    gene.unit.clone()
                },
                gene: index,
                place: list.then_some(k),
                axis: Axis::new(low, high).about(reference),
                start,
            });
        }
    }

    /// The shared world.
    fn shared(&mut self, form: &Evolution, scenario: &Scenario, file: &Node) -> Option<SharedWorld> {
        let desk = &mut self.files.desk;
        let shared = form.shared.as_ref()?;
        let place = file.place("shared.group");
        let groups = &scenario.group.0;
        let Some(at) = groups.iter().position(|(name, _)| *name == shared.group) else {
            let near = nearest(&shared.group, groups.iter().map(|(name, _)| name.as_str()));
            let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
            desk.problem(&place, format!("there is no group `{}`", shared.group), "the name of a group", help);
            return None;
        };
        let (name, group) = &groups[at];
        if shared.members == 0 || group.count % shared.members != 0 || group.count == 0 {
            let what = format!("{} members cannot be shared out by {} each", group.count, shared.members);
            desk.problem(&file.place("shared.members"), what, "a divisor of the number of members", "");
            return None;
        }
        let candidates = group.count / shared.members;
        if form.trials != 1 {
            let what = "a shared world is one, new in every generation";
            desk.problem(&file.place("trials"), what, "leave it out", "`confirm` tries the last candidates in many");
        }
        let given = match &form.search {
            Search::Genetic(genetic) => genetic.candidates,
            Search::CmaEs(cma_es) => cma_es.candidates,
            Search::MapElites(_) => {
                let what = "the best of every kind are searched for in worlds of their own";
                desk.problem(&file.place("shared"), what, "leave it out", "");
                None
            }
        };
        if given.is_some_and(|given| given != candidates) {
            let what = format!("{} members with {} to each candidate make {candidates}", group.count, shared.members);
            desk.problem(&file.place("search"), what, "leave `candidates` out", "");
        }
        if !form.derive.0.is_empty() {
            let what = "values that follow from genes are for worlds of a candidate's own";
            desk.problem(&file.place("derive"), what, "leave it out", "");
        }
        let below = format!("group.{name}.model.{}.", group.model.id);
        let descriptors = group.model.descriptors();
        let mut parameters = Vec::new();
        for (gene, Gene { path, .. }) in &form.gene.0 {
            let own = path.as_deref().and_then(|path| path.strip_prefix(&below));
            let descriptor = own.and_then(|own| descriptors.iter().find(|d| d.name == own || d.alias == Some(own)));
            match descriptor.filter(|descriptor| matches!(descriptor.takes, Kind::PerAgent(_))) {
                Some(descriptor) => parameters.push(descriptor.name.to_owned()),
                None => {
                    let what = format!("the gene `{gene}` cannot differ from member to member of `{name}`");
                    let expected = format!("a path below {below} of a parameter that can");
                    desk.problem(&file.place(&format!("gene.{gene}")), what, expected, "");
                }
            }
        }
        let rival = match &shared.rival {
            Some(rival) => Some(self.rival(rival, at, form, scenario, file)?),
            None => None,
        };
        Some(SharedWorld { group: at, count: group.count, members: shared.members, candidates, rival, parameters })
    }

    /// The group that evolves against another.
    fn rival(&mut self, name: &str, other: usize, form: &Evolution, scenario: &Scenario, file: &Node) -> Option<usize> {
        let groups = &scenario.group.0;
        let found = groups.iter().position(|(own, _)| own == name).filter(|&found| found != other);
        let fits = |found: &usize| {
            let (own, first) = (&groups[*found].1, &groups[other].1);
            own.count == first.count && own.model.id == first.model.id
        };
        let rival = found.filter(fits).filter(|_| matches!(form.search, Search::Genetic(_)));
        if rival.is_none() {
            let what = format!("`{name}` cannot evolve against `{}`", groups[other].0);
            let expected = "another group with as many members of the same model, and a genetic algorithm";
            self.files.desk.problem(&file.place("shared.rival"), what, expected, "");
        }
        rival
    }

    fn expressions(&mut self, key: &str, given: &Named<String>, file: &Node) -> Vec<(String, Expression)> {
        let mut read = Vec::new();
        for (name, text) in &given.0 {
            let place = match key.contains('.') {
                true => file.place(&format!("{key}.{name}.of")),
                false => entry_place(file, key, name),
            };
            if let Some(expression) = self.expression(text, &place) {
                read.push((name.clone(), expression));
            }
        }
        read
    }
    fn expression(&mut self, text: &str, place: &Span) -> Option<Expression> {
        match Expression::parse(text) {
            Ok(expression) => Some(expression),
            Err(mistake) => {
                let span = within(&self.files.sources, place, &mistake.bytes);
                self.files.desk.problem(&span, mistake.what, "", mistake.help);
                None
            }
        }
    }

    /// Tries what can be tried without running anything: the search can be made, and the references give a world in which
    /// everything can be read.
    fn tried(&mut self, plan: &Plan, file: &Node) {
        let made = plan.domain().and_then(|domain| match &plan.form.search {
            Search::Genetic(genetic) => {
                let first = plan.first(genetic, 0)?;
                search::genetic::Genetic::new(domain, genetic.operators(), 0, 0, first).map(|_| ())
            }
            Search::CmaEs(form) => EvolutionStrategy::new(domain, plan.strategy(form), 0).map(|_| ()),
            Search::MapElites(form) => {
                let (options, kinds) = plan.elites(form)?;
                Elites::new(domain, &kinds, options, 0).map(|_| ())
            }
        });
        if let Err(error) = made {
            self.files.desk.problem(&file.place("search"), error.to_string(), "not possible", "");
            return;
        }
        if plan.shared.is_none()
            && let Ok(condition) = super::evaluate::condition(plan, &plan.reference())
        {
            study::trial::check(&condition, &plan.readings, file, &mut self.files.desk);
        }
        for (key, mistake) in super::evaluate::check(plan) {
            let place = file.place(&key);
            let expression = ["keep.", "follow."].iter().any(|table| key.starts_with(table));
            let span = if key == "fitness" || expression || key.ends_with(".of") {
                within(&self.files.sources, &place, &mistake.bytes)
            } else {
                place
            };
            self.files.desk.problem(&span, mistake.what, "", mistake.help);
        }
    }
}

/// The parameter of a model that a path names.
fn descriptor(scenario: &Scenario, path: &str) -> Option<Descriptor> {
    let mut parts = path.split('.');
    let (Some("group"), Some(group), Some("model"), Some(model), Some(name)) =
        (parts.next(), parts.next(), parts.next(), parts.next(), parts.next())
    else {
        return None;
    };
    let (_, group) = scenario.group.0.iter().find(|(other, _)| other == group)?;
    (group.model.id == model).then_some(())?;
    group.model.descriptors().into_iter().find(|d| d.name == name || d.alias == Some(name))
}

/// The ends that a parameter has of its own, as a file gives them.
fn natural_ends(descriptor: &Descriptor) -> (Option<f64>, Option<f64>) {
    let ends = match descriptor.range {
        Range::Any => (None, None),
        Range::NonNegative => (Some(0.0), None),
        // the next number above 0 would be no useful bound
        Range::Positive => (None, None),
        Range::Within(low, high) => (Some(low), Some(high)),
    };
    let own = |end: f64| if in_radians(descriptor) { end.to_degrees() } else { end };
    (ends.0.map(own), ends.1.map(own))
}
