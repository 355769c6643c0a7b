//! The forms of a prediction file.

use crate::environment::behaviour::BehaviourForm;
use crate::environment::candidates::SchemaForm;
use crate::environment::workspace::Workspace;
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// What constructs will do to a group, predicted by a macroscopic model.
        Prediction = "prediction",
    }
}

form! {
    /// Between which values a parameter of the schema is drawn.
    pub struct RangeForm {
        /// Its least value; left out, the least of the parameter.
        low: Option<f64> = none, "", Any;
        /// Its greatest value; left out, the greatest of the parameter.
        high: Option<f64> = none, "", Any;
    }
}

form! {
    /// Further constructs that no model is fitted to: other values of the schema, another group.
    pub struct TestForm {
        /// What it is.
        about: String = [""], "", Any;
        /// Number of constructs.
        constructs: usize = [30usize], "1", Within(1.0, 100_000.0);
        /// Parameters of the schema with one value, by name, over those of the file.
        at: Named<f64> = [Named::default()], "", Any;
        /// Ranges over those of the file.
        range: Named<RangeForm> = [Named::default()], "", Any;
        /// Values put over the scenario's, as in `set`.
        set: Anything = [empty()], "", Any;
    }
}

form! {
    /// A model of the group as a whole.
    pub struct ModelForm {
        /// What it is.
        about: String = [""], "", Any;
        /// Into how many equal sectors the surroundings of the centroid are divided; the first lies about the heading.
        sectors: usize = [8usize], "1", Within(3.0, 64.0);
        /// How far walls are seen from the centroid.
        reach: f64 = need, "length", Positive;
        /// Whether group states are divided into cells, each with deviations of its own from the linear law; else these are drawn from all.
        cells: bool = [true], "", Any;
        /// Fewest transitions of a cell.
        least: usize = [50usize], "1", Within(1.0, 1_000_000.0);
    }
}

form! {
    /// What constructs will do to a group, predicted by macroscopic models that are fitted to trials among other constructs.
    pub struct Prediction {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of constructs, of trials and of predicted trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// What is there already.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// The schema, with values of parameters that are not drawn.
        schema: SchemaForm = need, "", Any;
        /// The parameters that are drawn, uniformly and each by itself.
        range: Named<RangeForm> = [Named::default()], "", Any;
        /// Number of constructs.
        constructs: usize = [80usize], "1", Within(2.0, 100_000.0);
        /// Constructs with `--quick`; of tests as well, at most.
        quick_constructs: usize = [12usize], "1", Within(2.0, 100_000.0);
        /// Share of them that no model is fitted to: the test `held_out`.
        held_out: f64 = [0.25], "1", Within(0.0, 0.9);
        /// Further tests, by names of yours.
        test: Named<TestForm> = [Named::default()], "", Any;
        /// The scenario: the name of a file beside this one, or the scenario itself as a table.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// What is wanted.
        behaviour: BehaviourForm = need, "", Any;
        /// Simulated trials of each construct.
        trials: usize = [20usize], "1", Within(1.0, 100_000.0);
        /// The same with `--quick`.
        quick_trials: usize = [5usize], "1", Within(1.0, 100_000.0);
        /// Simulated trials without any construct.
        control_trials: usize = [100usize], "1", NonNegative;
        /// Least fitness of a trial that succeeded.
        success: f64 = [1.0], "1", Within(0.0, 1.0);
        /// Steps from one look at the group to the next: the time step of the models.
        every: u64 = [5u64], "steps", Positive;
        /// Distance between members up to which they are of one group.
        link: f64 = need, "length", Positive;
        /// The models, by names of yours.
        model: Named<ModelForm> = need, "", Any;
        /// Predicted trials of each construct.
        predicted: usize = [200usize], "1", Within(1.0, 1_000_000.0);
        /// The same with `--quick`.
        quick_predicted: usize = [40usize], "1", Within(1.0, 1_000_000.0);
        /// Constructs of each test whose courses the page draws.
        show: usize = [2usize], "1", NonNegative;
        /// Statements to judge, over `brier`, `mae`, `spearman` and others.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
