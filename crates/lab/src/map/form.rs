//! The forms of a map file.

use crate::design::form::{Sequential, Valid};
use crate::environment::behaviour::BehaviourForm;
use crate::environment::candidates::SchemaForm;
use crate::environment::workspace::Workspace;
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// A map of a parameter space.
        Map = "map",
    }
}

form! {
    /// An axis of the map: a parameter of the schema.
    pub struct AxisForm {
        /// Where it begins; left out, the least value of the parameter.
        low: Option<f64> = none, "", Any;
        /// Where it ends; left out, the greatest value.
        high: Option<f64> = none, "", Any;
        /// Cells of the base grid along it.
        cells: u32 = need, "1", Within(1.0, 65_536.0);
    }
}

form! {
    /// A map of its own beside others: values put over the scenario, and over the schema's.
    pub struct PanelForm {
        /// What it is.
        about: String = [""], "", Any;
        /// Parameters of the schema, by name.
        at: Named<f64> = [Named::default()], "", Any;
        /// Values put over the scenario's, as in `set`.
        set: Anything = [empty()], "", Any;
    }
}

words! {
    /// Which cells of a generation are divided.
    pub enum RuleWord {
        /// Valid ones, and those that share at least a corner with a valid one.
        Success = "success",
        /// Those that share at least a corner with one of the other label.
        Boundary = "boundary",
    }
}

words! {
    /// Into what a cell is divided.
    pub enum DivisionWord {
        /// Halves along every axis.
        Orthtree = "orthtree",
        /// Halves along one axis, the one along which labels vary most. For more than two axes.
        OneAxis = "one_axis",
    }
}

form! {
    /// How the map is refined.
    pub struct RefineForm {
        /// Which cells are divided.
        rule: RuleWord = [RuleWord::Success], "", Any;
        /// Into what.
        division: DivisionWord = [DivisionWord::Orthtree], "", Any;
        /// How often at most.
        iterations: u32 = [0u32], "1", Within(0.0, 30.0);
        /// Most evaluations of a panel; where they do not suffice the most uncertain cells are divided.
        budget: Option<usize> = none, "1", Positive;
    }
}

words! {
    /// What is measured on a map. Shares of the box leave out what lies outside the schema's domain.
    pub enum Quantity {
        /// Valid part of a box.
        Density = "density",
        /// Mean share of successes in a box, by area.
        MeanRate = "mean_rate",
        /// Number of valid cells whose centres lie in a box.
        ValidCells = "valid_cells",
        /// Number of cells whose centres lie in a box.
        Cells = "cells",
        /// Number of connected valid regions.
        Components = "components",
        /// The largest connected valid region, as a part of all that is valid.
        LargestComponent = "largest_component",
        /// Whether the largest connected valid region meets a box: 1 or 0.
        LargestMeets = "largest_meets",
        /// Evaluations made.
        Evaluations = "evaluations",
        /// Share of trials without a construct that succeeded.
        Control = "control",
        /// Rank correlation of the share of successes with a sum of axes (`along`).
        RankCorrelation = "rank_correlation",
        /// Share of successes in the cell that a point lies in: the middle of the box.
        RateAt = "rate_at",
    }
}

form! {
    /// Something measured on a map.
    pub struct MeasureForm {
        /// What.
        of: Quantity = need, "", Any;
        /// The panel; left out, the first.
        panel: Option<String> = none, "", Any;
        /// A box: [least, greatest] by axis; an axis left out is all of it.
        inside: Named<Vec<f64>> = [Named::default()], "", Any;
        /// Whether what lies outside the box is meant.
        outside: bool = [false], "", Any;
        /// With what a rate is correlated: a sum of axes, each with its factor.
        along: Named<f64> = [Named::default()], "1", Any;
    }
}

form! {
    /// A map of a parameter space.
    pub struct Map {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of constructs and trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// What is there already.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// The schema, with values of parameters that are no axes.
        schema: SchemaForm = need, "", Any;
        /// The axes, by names of parameters: at most 8; the first two are drawn.
        axis: Named<AxisForm> = need, "", Any;
        /// The scenario: the name of a file beside this one, or the scenario itself as a table.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// Maps beside each other, by names of yours: anchors, group sizes, models.
        panel: Named<PanelForm> = [Named::default()], "", Any;
        /// What is wanted.
        behaviour: BehaviourForm = need, "", Any;
        /// Constructs of each cell, where the schema draws.
        constructs: usize = [1usize], "1", Within(1.0, 10_000.0);
        /// Trials of each construct; with a sequential test, at most so many.
        trials: usize = [10usize], "1", Within(1.0, 100_000.0);
        /// Stop trying a cell as soon as it is decided.
        sequential: Option<Sequential> = none, "", Any;
        /// Least fitness of a trial that succeeded.
        success: f64 = [1.0], "1", Within(0.0, 1.0);
        /// When a cell counts as valid.
        valid: Valid = [Valid::Rate(0.8)], "", Any;
        /// Trials of each panel without any construct.
        control_trials: usize = [100usize], "1", NonNegative;
        /// How the map is refined.
        refine: RefineForm = [RefineForm { rule: RuleWord::Success, division: DivisionWord::Orthtree, iterations: 0, budget: None }], "", Any;
        /// Iterations with `--quick`.
        quick_iterations: u32 = [0u32], "1", Within(0.0, 30.0);
        /// Trials with `--quick`.
        quick_trials: usize = [2usize], "1", Within(1.0, 100_000.0);
        /// Whether cells are filled by their share of successes; else the map has a symbol at each centre.
        areas: bool = [true], "", Any;
        /// What is measured, by names of yours.
        measure: Named<MeasureForm> = [Named::default()], "", Any;
        /// Statements to judge, over measures.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
