//! The forms of an evolution file: which values are searched over, for what, and how.

use crate::file::{Anything, Desk, Named, Node};
use crate::study::form::{Claim, Figure, Reading, Test, Window, empty};
use crate::{form, tagged, words};
use search::genetic::Operators;
use search::{crossover, mutation, selection};
use space::spelling::nearest;

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// A search over values of a scenario.
        Evolution = "evolution",
    }
}

form! {
    /// A value that is searched over: a number, or a list of numbers, each of which is a gene of its own.
    pub struct Gene {
        /// What it is, for axes and tables; left out, its name.
        about: String = [""], "", Any;
        /// Its unit.
        unit: String = [""], "", Any;
        /// The path of the value, as in `group.fish.model.couzin_2002.orientation_radius`. Without one it is a number for
        /// `derive` alone, and needs a reference.
        path: Option<String> = none, "", Any;
        /// Least value; left out, the least that the model's parameter can have.
        low: Option<f64> = none, "", Any;
        /// Greatest value; left out, the greatest that the model's parameter can have.
        high: Option<f64> = none, "", Any;
        /// The value about which it lies; left out, that of the scenario.
        reference: Option<f64> = none, "", Any;
        /// Whether low, high and start are multiples of the reference.
        relative: bool = [false], "", Any;
        /// Least and greatest value of the first candidates; left out, low and high.
        start: Option<Vec<f64>> = none, "", Any;
    }
}

form! {
    /// All candidates live in one world, and each owns members of a group.
    pub struct Shared {
        /// The group whose members are owned. Genes are parameters of its model that can differ from member to member.
        group: String = need, "", Any;
        /// Members of a candidate, in the order of their numbers.
        members: usize = [1usize], "1", Within(1.0, 1_000_000.0);
        /// A group of the same size and model that evolves as well, against the first: as many candidates, bred among
        /// themselves, whose fitness is that of the file with the names of the two groups exchanged. Left out, the first
        /// evolves alone.
        rival: Option<String> = none, "", Any;
    }
}

words! {
    /// Who begins.
    pub enum Start {
        /// All are drawn.
        Random = "random",
        /// One has the references, all others are drawn.
        WithReference = "with_reference",
    }
}

form! {
    /// A generational genetic algorithm.
    pub struct Genetic {
        /// Number of candidates; left out, 20, or as many as own the members of a shared world.
        candidates: Option<usize> = none, "1", Within(1.0, 1_000_000.0);
        /// Whose genes go on: `roulette`, `stochastic_universal`, `tournament`, `rank`.
        selection: String = ["rank"], "", Any;
        /// How many meet in a tournament.
        tournament_size: usize = [2usize], "1", Within(1.0, 1_000_000.0);
        /// How two parents make an offspring: `one_point`, `two_point`, `uniform`.
        crossover: String = ["one_point"], "", Any;
        /// How a gene changes: `creep`, `reset`.
        mutation: String = ["creep"], "", Any;
        /// Chance that one gene of an offspring changes.
        mutation_rate: f64 = [0.1], "1", Within(0.0, 1.0);
        /// Standard deviation of a creeping step, as a share of the reference.
        creep: f64 = [0.2], "1", Positive;
        /// How many of the best go on unchanged.
        elite: usize = [0usize], "1", NonNegative;
        /// Who begins.
        start: Start = [Start::Random], "", Any;
    }
}

impl Genetic {
    /// Its operators.
    pub fn operators(&self) -> Operators {
        let selection: Box<dyn selection::Selection> = match self.selection.as_str() {
            "tournament" => Box::new(selection::tournament::Tournament { size: self.tournament_size }),
            other => selection::find(other).unwrap_or_else(|| Box::new(selection::rank::Rank)),
        };
        let mutation: Box<dyn mutation::Mutation> = match self.mutation.as_str() {
            "creep" => Box::new(mutation::creep::Creep { share: self.creep }),
            other => mutation::find(other).unwrap_or_else(|| Box::new(mutation::reset::Reset)),
        };
        Operators {
            selection,
            crossover: crossover::find(&self.crossover).unwrap_or_else(|| Box::new(crossover::one_point::OnePoint)),
            mutation,
            mutation_rate: self.mutation_rate,
            elite: self.elite,
        }
    }
    /// Whether its operators are known; what is wrong goes to the desk. It stands at `path`.
    pub fn check(&self, path: &str, file: &Node, desk: &mut Desk) {
        let mut known = |list: &[(&str, &str)], given: &str, key: &str| {
            if list.iter().any(|(id, _)| *id == given) {
                return;
            }
            let help = match nearest(given, list.iter().map(|(id, _)| *id)) {
                Some(near) => format!("did you mean `{near}`?"),
                None => String::new(),
            };
            let ids: Vec<&str> = list.iter().map(|(id, _)| *id).collect();
            let place = file.place(&format!("{path}.{key}"));
            desk.problem(&place, format!("no {key} is called `{given}`"), format!("one of {}", ids.join(", ")), help);
        };
        known(selection::LIST, &self.selection, "selection");
        known(crossover::LIST, &self.crossover, "crossover");
        known(mutation::LIST, &self.mutation, "mutation");
    }
}

form! {
    /// CMA-ES, an evolution strategy that learns which directions matter. It begins at the references.
    pub struct CmaEs {
        /// Candidates a generation; left out, as many as the number of genes suggests, 4 + 3 ln(genes).
        candidates: Option<usize> = none, "1", Within(2.0, 1_000_000.0);
        /// First step, as a share of half the range of each gene.
        first_step: f64 = [0.3], "1", Positive;
    }
}

form! {
    /// A number that says of what kind a candidate is.
    pub struct Descriptor {
        /// What it is, for axes and tables; left out, its name.
        about: String = [""], "", Any;
        /// Its unit.
        unit: String = [""], "", Any;
        /// An expression over readings and genes.
        of: String = need, "", Any;
        /// Where the map begins.
        low: f64 = need, "", Any;
        /// Where it ends.
        high: f64 = need, "", Any;
    }
}

form! {
    /// MAP-Elites: the best of every kind.
    pub struct MapElites {
        /// Candidates a generation.
        candidates: usize = [40usize], "1", Within(1.0, 1_000_000.0);
        /// Cells of the map.
        cells: usize = [400usize], "1", Within(1.0, 1_000_000.0);
        /// Generations of candidates drawn at random before elites are changed.
        random_generations: usize = [5usize], "1", NonNegative;
        /// Standard deviation of a change, as a share of the range of each gene.
        isotropic: f64 = [0.02], "1", NonNegative;
        /// Standard deviation of a change along the line to another elite.
        along_line: f64 = [0.2], "1", NonNegative;
        /// What makes kinds differ, by names of yours.
        kind: Named<Descriptor> = need, "", Any;
    }
}

tagged! {
    /// How it is searched.
    pub enum Search {
        /// A genetic algorithm.
        genetic => Genetic(Genetic);
        /// CMA-ES.
        cma_es => CmaEs(CmaEs);
        /// MAP-Elites.
        map_elites => MapElites(MapElites);
    }
}

form! {
    /// Something of this file that is varied: a value by its path, or several at once by levels with names.
    pub struct Vary {
        /// What it is, for axes and tables; left out, its name.
        about: String = [""], "", Any;
        /// Its unit.
        unit: String = [""], "", Any;
        /// The path of the value in this file, as `search.genetic.mutation_rate`, or below `set` in the scenario, as
        /// `set.food.count`.
        path: Option<String> = none, "", Any;
        /// The values, its levels.
        values: Vec<Anything> = [Vec::new()], "", Any;
        /// Levels by names of yours, in place of path and values: each is a table of paths and values.
        level: Named<Anything> = [Named::default()], "", Any;
    }
}

form! {
    /// Worlds that neither search nor confirmation had, in which the champions meet what is good without a search. Every
    /// contender is tried in all of them: the reference, the champion of each run, and those named here.
    pub struct Contest {
        /// Number of worlds.
        worlds: usize = [20usize], "1", Within(2.0, 1_000_000.0);
        /// Number of worlds with `--quick`.
        quick_worlds: usize = [4usize], "1", Within(2.0, 1_000_000.0);
        /// Factors: each gene alone is multiplied by each of them, and the best such change of the reference is a
        /// contender, `single`.
        single: Vec<f64> = [Vec::new()], "1", Any;
        /// Candidates drawn like the first ones of a search, of which the best is a contender, `random`; with `--quick` a
        /// tenth of them.
        random: usize = [0usize], "1", NonNegative;
        /// Worlds in which the best of these are chosen, others than those in which contenders meet.
        chosen_in: usize = [5usize], "1", Within(1.0, 1_000_000.0);
        /// Contenders by names of yours, each the champion with these genes at their references.
        without: Named<Vec<String>> = [Named::default()], "", Any;
        /// Figures of the contest; its factor beside what is varied is `who`.
        figure: Vec<Figure> = [Vec::new()], "", Any;
        /// Tests between contenders (`who`) or what is varied.
        test: Vec<Test> = [Vec::new()], "", Any;
    }
}

form! {
    /// An evolution: genes of a scenario, a fitness, a search.
    pub struct Evolution {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// An evolution file whose keys hold where this one has none of its own; tables are joined key by key.
        extends: Option<String> = none, "", Any;
        /// Seed; run r (from 1) has this seed plus r - 1.
        seed: u64 = [0u64], "1", NonNegative;
        /// Independent runs of the whole search.
        runs: usize = [1usize], "1", Within(1.0, 100_000.0);
        /// Independent runs with `--quick`; left out, as many as without.
        quick_runs: Option<usize> = none, "1", Within(1.0, 100_000.0);
        /// Generations of a run.
        generations: usize = [100usize], "1", Within(1.0, 10_000_000.0);
        /// Generations of a run with `--quick`.
        quick_generations: usize = [10usize], "1", Within(1.0, 10_000_000.0);
        /// Worlds in which a candidate is tried: their seeds are those of the run plus 1, 2, ..., the same for all
        /// candidates. A shared world is one, and new in every generation.
        trials: usize = [1usize], "1", Within(1.0, 1_000_000.0);
        /// The scenario: the name of a file beside this one, or the scenario itself as a table.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// What is searched over, by names of yours.
        gene: Named<Gene> = need, "", Any;
        /// Values of the scenario that follow from genes: path = expression, in order.
        derive: Named<String> = [Named::default()], "", Any;
        /// Where candidates share a world; left out, each has worlds of its own.
        shared: Option<Shared> = none, "", Any;
        /// How it is searched.
        search: Search = need, "", Any;
        /// When a world is looked at; left out, as the scenario measures.
        looks: Option<Window> = none, "", Any;
        /// What is read off a world of a candidate's own, by names of yours; left out, what the scenario measures.
        reading: Named<Reading> = [Named::default()], "", Any;
        /// What is kept of a shared world at its end, by names of yours: expressions, as `sum(health[group = red])`.
        keep: Named<String> = [Named::default()], "", Any;
        /// How good a candidate is, the larger the better: an expression over readings and genes. In a shared world it is
        /// one over the columns of a member at the end (`health`), `meals`, and those of all members of a group
        /// (`health[group = red]`, a list); a candidate has the mean of its members.
        fitness: String = need, "", Any;
        /// Worlds with seeds of their own in which the last candidates are tried again, so that the champion owes nothing
        /// to luck; 0: none. Who shared a world has the whole group then.
        confirm: usize = [0usize], "1", NonNegative;
        /// Numbers that are followed through the generations beside the genes, by names of yours: expressions over genes.
        follow: Named<String> = [Named::default()], "", Any;
        /// What of this file is varied, by names of yours: every level with every other is searched in all runs.
        vary: Named<Vary> = [Named::default()], "", Any;
        /// Where champions meet what is good without a search; left out, nowhere.
        contest: Option<Contest> = none, "", Any;
        /// Figures of readings of runs over what is varied.
        figure: Vec<Figure> = [Vec::new()], "", Any;
        /// Tests whether a reading of runs differs with what is varied.
        test: Vec<Test> = [Vec::new()], "", Any;
        /// Statements to be judged: over readings of runs, and those of contenders as `contest.fitness[who = champion]`.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
