//! The forms of a decomposition file.

use crate::environment::behaviour::BehaviourForm;
use crate::environment::candidates::Candidates;
use crate::environment::workspace::Workspace;
use crate::file::{Anything, Named};
use crate::study::form::{Claim, empty};
use crate::{form, tagged, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// A decomposition of a construct into primitives.
        Decomposition = "decomposition",
    }
}

form! {
    /// Average linkage, cut where the mean silhouette is greatest.
    pub struct Linkage {
        /// Fewest clusters.
        least: usize = [2usize], "1", Within(2.0, 1000.0);
        /// Most clusters.
        most: usize = [12usize], "1", Within(2.0, 1000.0);
    }
}

form! {
    /// Clusters by density (DBSCAN, Ester et al. 1996): what is near enough to enough others belongs together; the rest is noise.
    pub struct Density {
        /// How near, in standard deviations of the descriptors.
        radius: f64 = need, "1", Positive;
        /// To how many, itself included.
        least: usize = [4usize], "1", Within(1.0, 100_000.0);
    }
}

tagged! {
    /// How fragments are put into clusters, by the distances of their standardised descriptors.
    pub enum Clustering {
        /// Average linkage, cut at the best silhouette.
        average_linkage => AverageLinkage(Linkage);
        /// By density.
        dbscan => Dbscan(Density);
    }
}

form! {
    /// Peaks of curvature.
    pub struct Split {
        /// Least turn of a peak.
        corner: f64 = [30.0], "deg", Within(0.1, 360.0);
        /// The length within which the line turns so much.
        over: f64 = need, "length", Positive;
    }
}

form! {
    /// How great an effect must be, in comparison with an empty arena, to give a cluster its name. The effect that exceeds its size
    /// most often is the dominant one; where none reaches its size the name is `none`.
    pub struct Effects {
        /// Mean net turn, to either side.
        turn: f64 = [30.0], "deg", Within(0.001, 180.0);
        /// Decrease of the standard deviation across the track, in shares of the spread at the start.
        narrowing: f64 = [0.25], "1", Within(0.001, 1.0);
        /// Groups that are there in addition.
        splitting: f64 = [0.5], "1", Positive;
        /// Share of members that leave on the side from which they came.
        back: f64 = [0.5], "1", Within(0.001, 1.0);
    }
}

form! {
    /// A stretch of the construct whose effect is known.
    pub struct Interval {
        /// What it is.
        about: String = [""], "", Any;
        /// The line of the construct, from 1; lines count in the order of their first walls.
        line: usize = [1usize], "1", Within(1.0, 1_000_000.0);
        /// Arc length at which it begins.
        from: f64 = [0.0], "length", NonNegative;
        /// Arc length at which it ends.
        to: f64 = need, "length", Positive;
        /// What it is expected to elicit, in the workspace and without the rest of the construct.
        behaviour: BehaviourForm = need, "", Any;
    }
}

form! {
    /// How stretches are fitted, and the fits varied.
    pub struct Vary {
        /// A stretch is split until each piece is at most so far off, in the root mean square.
        tolerance: f64 = [0.1], "length", Positive;
        /// Angles by which the fit is turned about its first end, ascending, 0 among them.
        angles: Vec<f64> = [vec![-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0]], "deg", Within(-180.0, 180.0);
        /// Factors by which it is stretched, ascending, 1 among them.
        lengths: Vec<f64> = [vec![0.5, 0.75, 1.0, 1.25, 1.5]], "1", Positive;
        /// Trials of each variation.
        trials: usize = [20usize], "1", Within(1.0, 100_000.0);
        /// Trials with `--quick`.
        quick_trials: usize = [2usize], "1", Within(1.0, 100_000.0);
        /// Least fitness of a trial that succeeded.
        success: f64 = [1.0], "1", Within(0.0, 1.0);
        /// Least share of successes of a variation that still elicits what is expected.
        least: f64 = [0.8], "1", Within(0.0, 1.0);
    }
}

/// How fits are varied where a file does not say.
pub(super) fn vary() -> Vary {
    Vary {
        tolerance: 0.1,
        angles: vec![-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0],
        lengths: vec![0.5, 0.75, 1.0, 1.25, 1.5],
        trials: 20,
        quick_trials: 2,
        success: 1.0,
        least: 0.8,
    }
}

/// How clusters are made and named where a file does not say.
pub(super) fn defaults() -> (Clustering, Effects) {
    let linkage = Linkage { least: 2, most: 12 };
    (Clustering::AverageLinkage(linkage), Effects { turn: 30.0, narrowing: 0.25, splitting: 0.5, back: 0.5 })
}

form! {
    /// The decomposition of a construct into primitives: by what its fragments do to a group (`windows`), or by stretches whose effect is
    /// known (`interval`).
    pub struct Decomposition {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// Seed of what is drawn and of trials.
        seed: u64 = [0u64], "1", NonNegative;
        /// Where the construct comes to stand: units, and what schemas are anchored at. Fragments are tried alone, without it.
        workspace: Workspace = [Workspace::default()], "", Any;
        /// Where the construct comes from, as in a design; the first is taken that these give.
        candidates: Option<Candidates> = none, "", Any;
        /// Which of the candidates is taken, from 0.
        attempt: u64 = [0u64], "1", NonNegative;
        /// Lines of wall that belong to the construct: each a list of points [x, y].
        line: Vec<Vec<Vec<f64>>> = [Vec::new()], "length", Any;
        /// Widths of the windows that slide along the lines of the construct, a quarter of their width at a time.
        windows: Vec<f64> = [Vec::new()], "length", Positive;
        /// Whether lines are also split where their curvature has peaks; each stretch between is a fragment of its own.
        split: Option<Split> = none, "", Any;
        /// Most trials with fragments. Where all would be more, fragments are left out evenly, and the page says so.
        budget: Option<usize> = none, "1", Positive;
        /// The scenario: the name of a file beside this one, or the scenario itself as a table. Its group is tried as it begins
        /// there; fragments are put in its way.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [empty()], "", Any;
        /// Headings at which each fragment is approached, evenly all around.
        headings: usize = [8usize], "1", Within(1.0, 360.0);
        /// Lateral offsets of each approach.
        offsets: usize = [5usize], "1", Within(1.0, 1000.0);
        /// Over which share of the window's width they lie, in the middles of as many equal parts.
        span: f64 = [0.5], "1", Within(0.0, 2.0);
        /// Trials of each approach and offset.
        trials: usize = [4usize], "1", Within(1.0, 100_000.0);
        /// Trials with `--quick`.
        quick_trials: usize = [1usize], "1", Within(1.0, 100_000.0);
        /// Distance between members up to which they are of one group. Windows need it.
        link: Option<f64> = none, "length", Positive;
        /// Room between a fragment and the rim of its arena, where the group begins; left out, twice the greatest distance of a member
        /// from the middle of the group at its start.
        margin: Option<f64> = none, "length", Positive;
        /// How clusters are made.
        cluster: Clustering = [defaults().0], "", Any;
        /// How great effects must be to be named.
        effect: Effects = [defaults().1], "", Any;
        /// Stretches whose effect is known, by names of yours.
        interval: Named<Interval> = [Named::default()], "", Any;
        /// How they are fitted and varied.
        vary: Vary = [vary()], "", Any;
        /// Statements to judge, over `clusters`, `named`, `apart`, `rate`, `bare` and others.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}
