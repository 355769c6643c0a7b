//! The forms of an optimisation file.

use crate::design::form::ByWord;
use crate::environment::behaviour::BehaviourForm;
use crate::environment::candidates::SchemaForm;
use crate::environment::filter::FilterForm;
use crate::environment::grammar::GrammarSource;
use crate::environment::workspace::Workspace;
use crate::evolution::form::{CmaEs, Genetic};
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, tagged, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// The search for the best construct of a schema.
        Optimisation = "optimisation",
    }
}

form! {
    /// A parameter of the schema that is searched over.
    pub struct AxisForm {
        /// Least value; left out, that of the parameter.
        low: Option<f64> = none, "", Any;
        /// Greatest value; left out, that of the parameter.
        high: Option<f64> = none, "", Any;
    }
}

words! {
    /// What is to be great.
    pub enum Objective {
        /// The mean fitness of the trials, which tells nearly from not at all where the behaviour is graded.
        Fitness = "fitness",
        /// The share of trials that succeeded.
        Rate = "rate",
    }
}

form! {
    /// Constructs that are never built quite as drawn: each is tried in changed copies, and counts as good as its worse ones.
    pub struct Robust {
        /// How copies are changed.
        by: ByWord = need, "", Any;
        /// By how much: a length, degrees, a share, or pieces.
        size: f64 = need, "", NonNegative;
        /// Changed copies, each tried as often as `trials` says.
        copies: usize = [5usize], "1", Within(1.0, 10_000.0);
        /// The copy that counts: 0 is the worst, 0.5 the median.
        quantile: f64 = [0.1], "1", Within(0.0, 1.0);
    }
}

form! {
    /// Candidates drawn uniformly from the box: what a search must beat.
    pub struct Uniform {
        /// Candidates a generation.
        candidates: usize = [20usize], "1", Within(1.0, 1_000_000.0);
    }
}

form! {
    /// A number that makes constructs differ in kind.
    pub struct KindForm {
        /// Where the archive begins.
        low: f64 = need, "", Any;
        /// Where it ends.
        high: f64 = need, "", Any;
    }
}

form! {
    /// MAP-Elites: the best construct of every kind.
    pub struct Archive {
        /// Candidates a generation.
        candidates: usize = [40usize], "1", Within(1.0, 1_000_000.0);
        /// Cells of the archive.
        cells: usize = [100usize], "1", Within(1.0, 1_000_000.0);
        /// Generations of candidates drawn at random before elites are changed.
        random_generations: usize = [2usize], "1", NonNegative;
        /// Standard deviation of a change, as a share of the range of each axis.
        isotropic: f64 = [0.05], "1", NonNegative;
        /// Standard deviation of a change along the line to another elite.
        along_line: f64 = [0.2], "1", NonNegative;
        /// What makes kinds differ: `material` (length of wall), `pieces`, `steps` (mean number of steps to success), or an axis.
        kind: Named<KindForm> = need, "", Any;
    }
}

tagged! {
    /// How it is searched.
    pub enum Search {
        /// Uniform draws.
        uniform => Uniform(Uniform);
        /// CMA-ES; where it comes to rest it begins again elsewhere.
        cma_es => CmaEs(CmaEs);
        /// A genetic algorithm.
        genetic => Genetic(Genetic);
        /// MAP-Elites.
        map_elites => MapElites(Archive);
    }
}

form! {
    /// The best construct made lighter: pieces are taken away and walls shortened, one after another, as long as the group
    /// still does what is wanted.
    pub struct Lighten {
        /// Least lower end of the 95 % Wilson interval of the share of successes.
        least: f64 = [0.8], "1", Within(0.0, 1.0);
        /// Trials of each lighter construct.
        trials: usize = [100usize], "1", Within(1.0, 100_000.0);
        /// Shares of a wall that are taken off its far end, the greatest first; 1 takes all of it.
        shares: Vec<f64> = [vec![1.0, 0.5, 0.25, 0.1]], "1", Within(0.001, 1.0);
    }
}

form! {
    /// The search for the best construct of a schema, by several methods with equally many evaluations.
    pub struct Optimisation {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of searches and trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// What is there already.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// The schema, with values of parameters that are not searched over.
        schema: Option<SchemaForm> = none, "", Any;
        /// In place of a schema a grammar, whose derivations are searched over: numbers of [0, 1] stand for what it draws.
        grammar: Option<GrammarSource> = none, "", Any;
        /// How many draws of the grammar are searched over, from the first on; those after them are the same for all.
        decisions: usize = [24usize], "1", Within(1.0, 1000.0);
        /// What is searched over, by names of parameters; of a grammar all decisions where none is named.
        axis: Named<AxisForm> = [Named::default()], "", Any;
        /// What a construct must be like to be tried at all: all of these hold. One that is not counts as an evaluation.
        filter: Vec<FilterForm> = [Vec::new()], "", Any;
        /// The scenario: the name of a file beside this one, or the scenario itself as a table.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// What is wanted.
        behaviour: BehaviourForm = need, "", Any;
        /// What is to be great.
        objective: Objective = [Objective::Fitness], "", Any;
        /// What is taken from the objective for each unit of length of wall.
        material: f64 = [0.0], "", NonNegative;
        /// Trials of each evaluation; of each changed copy, where constructs must be robust.
        trials: usize = [4usize], "1", Within(1.0, 100_000.0);
        /// Least fitness of a trial that succeeded.
        success: f64 = [1.0], "1", Within(0.0, 1.0);
        /// Whether constructs must work where they are off a little.
        robust: Option<Robust> = none, "", Any;
        /// How it is searched, by names of yours.
        method: Named<Search> = need, "", Any;
        /// Evaluations of each run.
        evaluations: usize = [200usize], "1", Within(1.0, 10_000_000.0);
        /// Evaluations of each run with `--quick`.
        quick_evaluations: usize = [40usize], "1", Within(1.0, 10_000_000.0);
        /// Runs of each method, each with a seed of its own.
        runs: usize = [5usize], "1", Within(1.0, 10_000.0);
        /// Runs of each method with `--quick`.
        quick_runs: usize = [2usize], "1", Within(1.0, 10_000.0);
        /// So many candidates with the best scores of a run are tried again, since the best of many noisy scores flatters.
        finalists: usize = [5usize], "1", Within(1.0, 10_000.0);
        /// Trials of each of them. The best then has as many new ones, which are what is reported.
        confirm_trials: usize = [100usize], "1", Within(1.0, 100_000.0);
        /// Trials without any construct.
        control_trials: usize = [100usize], "1", NonNegative;
        /// Whether the best construct is made lighter.
        lighten: Option<Lighten> = none, "", Any;
        /// Constructs of an archive that the page draws.
        show: usize = [24usize], "1", Within(0.0, 1000.0);
        /// Statements to judge, over `rate`, `rates`, `score`, `material_used`, `control`, `kinds`, `saved`.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
