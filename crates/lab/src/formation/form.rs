//! The forms of a formation file.

use super::controllers::By;
use crate::environment::workspace::Workspace;
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// Robots in the places of walls.
        Formation = "formation",
    }
}

form! {
    /// A wall of a task.
    pub struct WallForm {
        /// From its anchored end to its free end: [x0, y0, x1, y1].
        at: Vec<f64> = need, "length", Any;
        /// The leg of the path that it is for, from 1.
        leg: usize = need, "1", Within(1.0, 100.0);
    }
}

form! {
    /// A task: the targets start at the first point of a path and are to reach its last one, through a gate at each corner.
    pub struct TaskForm {
        /// What it is.
        about: String = [""], "", Any;
        /// The points of the path, each [x, y].
        path: Vec<Vec<f64>> = need, "length", Any;
        /// Half the width of the corridor about the path, and so of its gates.
        half_width: f64 = [1.2], "length", Positive;
        /// Radius of the disc in which the targets start.
        start_radius: f64 = [0.7], "length", Positive;
        /// Radius of the disc that is the goal.
        goal_radius: f64 = [0.9], "length", Positive;
        /// Standard deviation of the headings at the start about the first leg.
        heading_deviation: f64 = [11.459_155_902_616_464], "deg", NonNegative;
        /// Whether each wall is there only while the targets are on its leg or the one before.
        timed: bool = [false], "", Any;
        /// The walls; left out, they are searched.
        wall: Option<Vec<WallForm>> = none, "", Any;
    }
}

form! {
    /// How walls are searched: leg by leg, the shortest that bring enough targets through the next gate.
    pub struct Solver {
        /// Trials of each candidate at first.
        first_trials: usize = [6usize], "1", Within(1.0, 1000.0);
        /// Further trials of the best.
        further_trials: usize = [18usize], "1", Within(1.0, 10_000.0);
        /// Candidates that are drawn for each further wall.
        candidates: usize = [60usize], "1", Within(1.0, 10_000.0);
        /// Partial solutions that are kept.
        beam: usize = [2usize], "1", Within(1.0, 100.0);
        /// Walls of a leg, at most.
        walls_of_leg: usize = [6usize], "1", Within(0.0, 20.0);
        /// Share of targets that is enough.
        enough: f64 = [0.9], "1", Within(0.0, 1.0);
        /// Shortest wall.
        shortest: f64 = [1.0], "length", Positive;
        /// Longest wall.
        longest: f64 = [3.0], "length", Positive;
        /// Steps of the angles that are tried.
        angle_step: f64 = [5.0], "deg", Positive;
    }
}

impl Default for Solver {
    fn default() -> Self {
        Self {
            first_trials: 6,
            further_trials: 18,
            candidates: 60,
            beam: 2,
            walls_of_leg: 6,
            enough: 0.9,
            shortest: 1.0,
            longest: 3.0,
            angle_step: 5.0,
        }
    }
}

form! {
    /// The shepherds' bodies: discs that the targets sense as they sense walls.
    pub struct Shepherds {
        /// Body radius.
        radius: f64 = [0.17], "length", Positive;
        /// Largest speed.
        speed: f64 = [0.5], "length/time", Positive;
        /// Whether they drive on two wheels; else they move freely up to their speed.
        wheels: bool = [false], "", Any;
        /// Time between two decisions.
        period: f64 = [0.1], "time", Positive;
        /// Whether each decides on a clock of its own, with a phase and 5 % of jitter.
        asynchronous: bool = [false], "", Any;
        /// Whether wheels slip (3 %, and 2 % of bias for each robot), small speeds are lost (0.02 m/s) and commands take effect 0.05
        /// to 0.15 s late.
        noise: bool = [false], "", Any;
        /// Least gap that they keep to targets on their way.
        clearance: f64 = [0.35], "length", NonNegative;
    }
}

impl Default for Shepherds {
    fn default() -> Self {
        Self {
            radius: 0.17,
            speed: 0.5,
            wheels: false,
            period: 0.1,
            asynchronous: false,
            noise: false,
            clearance: 0.35,
        }
    }
}

form! {
    /// A way of bringing the targets along.
    pub struct MethodForm {
        /// What it is.
        about: String = [""], "", Any;
        /// What brings them along.
        by: By = need, "", Any;
        /// The shepherds' bodies; left out, those of the file.
        shepherds: Option<Shepherds> = none, "", Any;
        /// Values put over the scenario of the targets. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// Tasks that are tried; left out, all.
        tasks: Option<Vec<String>> = none, "", Any;
    }
}

form! {
    /// Formations: targets are brought along trajectories by walls, by robots in their places, or by herding.
    pub struct Formation {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of search and trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// What is there already; its boundary bounds the shepherds.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// The scenario of the targets: the name of a file beside this one, or the scenario itself as a table. Where they start, and
        /// which way they head, is the task's.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// The tasks, by names of yours.
        task: Named<TaskForm> = need, "", Any;
        /// The methods, by names of yours.
        method: Named<MethodForm> = need, "", Any;
        /// The shepherds' bodies.
        shepherds: Shepherds = [Shepherds::default()], "", Any;
        /// How walls are searched.
        solver: Solver = [Solver::default()], "", Any;
        /// Trials of each task with each method.
        trials: usize = [10usize], "1", Within(1.0, 100_000.0);
        /// Trials with `--quick`.
        quick_trials: usize = [2usize], "1", Within(1.0, 100_000.0);
        /// Task and method of the trials that the page plays, as "task, method".
        show: Vec<String> = [Vec::new()], "", Any;
        /// Statements to judge, over `fitness`, `fitnesses`, `success`, `time`, `path_length`, `dispersion`, `held`, `robots`, `walls`.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
