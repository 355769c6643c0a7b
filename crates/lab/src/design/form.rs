//! The forms of a design file.

use crate::environment::behaviour::BehaviourForm;
use crate::environment::candidates::{Candidates, Placing};
use crate::environment::doors::DoorForm;
use crate::environment::filter::FilterForm;
use crate::environment::trial::PopulationForm;
use crate::environment::workspace::Workspace;
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, tagged, words};
use terrain::perturb::Perturbation;

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// Environments that are generated and tried.
        Design = "design",
    }
}

form! {
    /// Wald's sequential test: an environment is tried until it is clear whether the group succeeds with the higher
    /// probability or the lower one.
    pub struct Sequential {
        /// The lower probability.
        lower: f64 = [0.5], "1", Within(0.0001, 0.9999);
        /// The higher probability.
        higher: f64 = [0.8], "1", Within(0.0001, 0.9999);
        /// Chance to accept the lower one.
        alpha: f64 = [0.05], "1", Within(0.0001, 0.4999);
        /// Chance to reject the higher one.
        beta: f64 = [0.05], "1", Within(0.0001, 0.4999);
    }
}

tagged! {
    /// When an environment counts as valid.
    pub enum Valid {
        /// The share of successes is at least this.
        rate in "1", swarm::parameters::Range::Within(0.0, 1.0) => Rate(f64);
        /// The lower end of the 95 % Wilson interval of the share is at least this.
        lower_bound in "1", swarm::parameters::Range::Within(0.0, 1.0) => LowerBound(f64);
    }
}

impl Valid {
    /// Whether so many successes in so many trials make an environment valid.
    pub fn holds(&self, successes: u64, trials: u64) -> bool {
        match *self {
            Self::Rate(least) => trials > 0 && successes as f64 / trials as f64 >= least,
            Self::LowerBound(least) => {
                measure::statistics::wilson(successes, trials, 0.95).is_ok_and(|interval| interval.low >= least)
            }
        }
    }
}

words! {
    /// How environments are changed.
    pub enum ByWord {
        /// Each joint is displaced by at most so much.
        Joints = "joints",
        /// All of it is displaced by so much.
        Shift = "shift",
        /// All of it is turned by at most so many degrees.
        Turn = "turn",
        /// Each wall loses this share of its length.
        Shorten = "shorten",
        /// So many pieces are missing.
        Remove = "remove",
    }
}

impl ByWord {
    /// The change.
    pub fn perturbation(self) -> Perturbation {
        match self {
            Self::Joints => Perturbation::Joints,
            Self::Shift => Perturbation::Shift,
            Self::Turn => Perturbation::Turn,
            Self::Shorten => Perturbation::Shorten,
            Self::Remove => Perturbation::Remove,
        }
    }
}

form! {
    /// A change of environments, in several sizes.
    pub struct PerturbationForm {
        /// How they are changed.
        by: ByWord = need, "", Any;
        /// By how much: lengths, degrees, shares, or pieces.
        sizes: Vec<f64> = need, "", NonNegative;
    }
}

form! {
    /// How much the best environments may be off.
    pub struct Robustness {
        /// The behaviour; left out, the first.
        behaviour: Option<String> = none, "", Any;
        /// The group; left out, the first.
        population: Option<String> = none, "", Any;
        /// How many environments are changed: those with most successes.
        environments: usize = [3usize], "1", Within(1.0, 10_000.0);
        /// Changed copies of each, for every size; each is tried once.
        copies: usize = [20usize], "1", Within(1.0, 100_000.0);
        /// The changes.
        perturbation: Vec<PerturbationForm> = need, "", Any;
    }
}

form! {
    /// Which group is it: how well environments tell the groups of this file apart, and how soon an unknown one is named.
    pub struct Inverse {
        /// What is seen of a trial: behaviours, each with the fitnesses at which its outcomes part, ascending. Left out, all
        /// behaviours, each parted at `success`.
        outcome: Named<Vec<f64>> = [Named::default()], "1", Within(0.0, 1.0);
        /// How probable each group is beforehand, as weights; left out, all are the same.
        prior: Named<f64> = [Named::default()], "1", NonNegative;
        /// A group is named once it is this probable.
        threshold: f64 = [0.95], "1", Within(0.5, 0.999999);
        /// Unknown groups that are identified, of each group, in trials of their own.
        identifications: usize = [100usize], "1", Within(1.0, 100_000.0);
        /// The same with `--quick`.
        quick_identifications: usize = [10usize], "1", Within(1.0, 100_000.0);
        /// Most trials of an identification.
        most: usize = [50usize], "1", Within(1.0, 10_000.0);
        /// Statements to judge, over `needed`, `identified`, `right`.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}

form! {
    /// A design: environments are generated, filtered, and tried on groups.
    pub struct Design {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of generation and trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// What is there already.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// Doors by name: walls of the workspace that open or shut when a condition holds.
        door: Named<DoorForm> = [Named::default()], "", Any;
        /// Where environments come from.
        candidates: Candidates = need, "", Any;
        /// What becomes of the parts of a construct outside the workspace.
        placement: Placing = [Placing::Keep], "", Any;
        /// What makes a construct feasible: all of these must pass.
        filter: Vec<FilterForm> = [Vec::new()], "", Any;
        /// Most candidates that are generated.
        attempts: u64 = [1000u64], "1", Within(1.0, 10_000_000.0);
        /// Most candidates that are generated with `--quick`.
        quick_attempts: u64 = [20u64], "1", Within(1.0, 10_000_000.0);
        /// Generation ends with so many feasible candidates; left out, with the attempts.
        feasible: Option<u64> = none, "1", Positive;
        /// The scenario: the name of a file beside this one, or the scenario itself as a table. Its start is the group's;
        /// workspace and construct are put into it.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// Groups that are tried, by names of yours; left out, the scenario's alone.
        population: Named<PopulationForm> = [Named::default()], "", Any;
        /// What is wanted, by names of yours. All are watched in the same trials. Stages have their own.
        behaviour: Named<BehaviourForm> = [Named::default()], "", Any;
        /// Trials of each environment; with a sequential test, at most so many.
        trials: usize = [10usize], "1", Within(1.0, 100_000.0);
        /// Stop trying an environment as soon as it is decided (for all behaviours).
        sequential: Option<Sequential> = none, "", Any;
        /// Least fitness of a trial that succeeded.
        success: f64 = [1.0], "1", Within(0.0, 1.0);
        /// When an environment counts as valid.
        valid: Valid = [Valid::Rate(0.8)], "", Any;
        /// Whether every trial is made once more without the construct.
        control: bool = [true], "", Any;
        /// Whether the best environments still work where they are off a little.
        robustness: Option<Robustness> = none, "", Any;
        /// Which group is it: how well environments tell the groups apart.
        inverse: Option<Inverse> = none, "", Any;
        /// Environments that the page draws.
        show: usize = [12usize], "1", Within(0.0, 200.0);
        /// Environments written as SVG, GeoJSON and scenario, of each group and behaviour those with most successes.
        export: usize = [1usize], "1", Within(0.0, 1000.0);
        /// Statements to judge, over `rate`, `control`, `tightness`, `value`, `fitness`, `rates`, `generated`, `feasible`.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
