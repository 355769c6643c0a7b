//! The forms of a study file: what is varied, how often it is tried, what is read off, what is claimed.

use super::bearing::BearingReading;
use super::consensus::ConsensusReading;
use super::correlation::CorrelationReading;
use super::emptied::EmptiedReading;
use super::profile::ProfileReading;
use super::reversals::ReversalReading;
use crate::file::{Anything, Named, Nothing};
use crate::{form, tagged, words};

words! {
    /// What kind of file it is.
    pub enum FileKind {
        /// Many worlds, one scenario, varied.
        Study = "study",
    }
}

form! {
    /// Numbers with equal steps between them.
    pub struct Steps {
        /// The first.
        from: f64 = need, "", Any;
        /// The last; one that the steps do not meet is left out.
        to: f64 = need, "", Any;
        /// The step.
        by: f64 = need, "", Positive;
    }
}

form! {
    /// Something that is varied: a value of the scenario by its path, or several at once by levels with names.
    pub struct Factor {
        /// What it is, for axes and tables; left out, the factor's name.
        about: String = [""], "", Any;
        /// Its unit.
        unit: String = [""], "", Any;
        /// The path of the value, as in `group.fish.count`. Without path and levels it is a number for `define` and
        /// `derive` alone.
        path: Option<String> = none, "", Any;
        /// The values, its levels.
        values: Option<Vec<Anything>> = none, "", Any;
        /// Numbers with equal steps, in place of `values`.
        steps: Option<Steps> = none, "", Any;
        /// Least and greatest value, for the designs that draw.
        range: Option<Vec<f64>> = none, "", Any;
        /// Whether values drawn from the range are rounded to whole numbers.
        whole: bool = [false], "", Any;
        /// Levels by names of yours: each is a table of paths and values. A level named like one of `values` says how
        /// that value is put into the scenario, in place of the path.
        level: Named<Anything> = [Named::default()], "", Any;
    }
}

form! {
    /// So many cells.
    pub struct Samples {
        /// Number of cells.
        samples: usize = need, "1", Within(1.0, 100_000.0);
    }
}

tagged! {
    /// How the levels of the factors make cells.
    pub enum Design {
        /// Every level with every other.
        full => Full(Nothing);
        /// The first levels together, the second levels together, and so on.
        zip => Zip(Nothing);
        /// Drawn so that each factor's range is covered evenly: one value from each of so many equal parts.
        latin_hypercube => LatinHypercube(Samples);
        /// Drawn, each cell for itself: more samples add cells and change none.
        random => Random(Samples);
        /// Cell by cell: a list of tables with a value for every factor.
        table => Table(Vec<Named<Anything>>);
    }
}

form! {
    /// When a trial is looked at.
    pub struct Window {
        /// Time of the first look; left out, one interval after the start.
        from: Option<f64> = none, "time", NonNegative;
        /// Time between two looks.
        interval: f64 = need, "time", Positive;
    }
}

words! {
    /// What is made of the values of the looks.
    pub enum Statistic {
        /// Their mean.
        Mean = "mean",
        /// Their standard deviation (divisor n).
        Deviation = "deviation",
        /// The least.
        Least = "least",
        /// The greatest.
        Greatest = "greatest",
        /// That of the last look that has one.
        Last = "last",
        /// Their Binder cumulant, 1 - mean x^4 / (3 (mean x^2)^2).
        Binder = "binder",
    }
}

form! {
    /// A metric of `flockworks metrics` over the looks.
    pub struct MetricReading {
        /// The metric.
        id: String = need, "", Any;
        /// Its parameters.
        parameters: Named<f64> = [Named::default()], "", Positive;
        /// What it is multiplied by, as 100 for percent.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// Counts looks instead: 1 where the metric is at least this, else 0. With `statistic = "last"` the reading is whether a trial ends so.
        at_least: Option<f64> = none, "", Any;
        /// Counts looks instead: 1 where the metric is at most this, else 0.
        at_most: Option<f64> = none, "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

form! {
    /// The number of members in a box along the axes, its edges included, over the looks.
    pub struct InsideReading {
        /// Lower corner.
        low: Vec<f64> = need, "length", Any;
        /// Upper corner.
        high: Vec<f64> = need, "length", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// What is made of the numbers.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

words! {
    /// Whose readings they are.
    pub enum Whose {
        /// Of everyone.
        Everyone = "everyone",
        /// Of the largest cluster.
        LargestCluster = "largest_cluster",
    }
}

form! {
    /// The share of members in a named state of the model, over all members and looks.
    pub struct ShareReading {
        /// The column of the model, as `behaviour`.
        column: String = need, "", Any;
        /// The state, as `align`.
        state: String = need, "", Any;
        /// What it is multiplied by, as 100 for percent.
        scale: f64 = [1.0], "", Any;
        /// Of whom.
        of: Whose = [Whose::Everyone], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// Members at most this far apart are of one cluster.
        linking_distance: f64 = [25.0], "length", Positive;
    }
}

form! {
    /// The mean of a quantity or count of the model, over all living members and looks.
    pub struct ColumnReading {
        /// The column of the model, as `n_align`.
        column: String = need, "", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// What is made of the means of the looks.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

form! {
    /// The share of the members that live, over the looks.
    pub struct AliveReading {
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// What is made of the shares.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

words! {
    /// What was met.
    pub enum Partner {
        /// Anything.
        Anything = "anything",
        /// Another member.
        Members = "members",
        /// An obstacle.
        Obstacles = "obstacles",
        /// A wall.
        Walls = "walls",
    }
}

form! {
    /// Contacts in the whole trial; where bodies refuse moves that would touch, these are the refused moves.
    pub struct ContactReading {
        /// What was met.
        with: Partner = [Partner::Anything], "", Any;
        /// Whether contacts that follow one of the same member in the step before count as one with it.
        events: bool = [false], "", Any;
        /// Scaled to so many updates of agents; left out, not scaled.
        per_updates: Option<f64> = none, "1", Positive;
    }
}

form! {
    /// The share of the space that was visited: of equal cells, those in which at least a share of the members was seen.
    /// In percent.
    pub struct CoverageReading {
        /// Cells along each axis; the space must end on every axis.
        cells: usize = need, "1", Within(1.0, 1000.0);
        /// Share of the members that must have been seen in a cell.
        share: f64 = [0.3], "1", Within(0.0, 1.0);
        /// Whether they must be there at once: then it is the mean over the looks. Else different members seen at any
        /// look count together.
        at_once: bool = [false], "", Any;
        /// Time of the first look, where it differs.
        from: Option<f64> = none, "time", NonNegative;
    }
}

words! {
    /// What is read off the largest cluster.
    pub enum ClusterQuantity {
        /// Length of its members' mean displacement between two looks, per time.
        Speed = "speed",
        /// Length of the mean heading of its members.
        Polarisation = "polarisation",
        /// How much it turns about its centre.
        AngularMomentum = "angular_momentum",
        /// Number of its members.
        Members = "members",
        /// Mean squared distance of its members to their centre.
        Expanse = "expanse",
        /// Mean angle between the heading of a member and the mean heading, in degrees.
        AngularDeviation = "angular_deviation",
    }
}

form! {
    /// Something of the largest cluster, its mean over the looks. Ties go to the cluster of the lowest member.
    pub struct ClusterReading {
        /// What.
        quantity: ClusterQuantity = need, "", Any;
        /// Members at most this far apart are linked; clusters are what hangs together.
        linking_distance: f64 = need, "length", Positive;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
    }
}

words! {
    /// What is read off the paths between two looks.
    pub enum PathQuantity {
        /// Mean angle between consecutive headings over mean distance moved, in degrees per length.
        Curvature = "curvature",
        /// Speed of the centre of all members.
        GroupSpeed = "group_speed",
    }
}

form! {
    /// Something of the members' paths.
    pub struct PathReading {
        /// What.
        quantity: PathQuantity = need, "", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
    }
}

form! {
    /// Mean distance from the centre of an obstacle to that of its nearest neighbour, at the start.
    pub struct ObstacleReading {
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
    }
}

words! {
    /// What is read off the food.
    pub enum FoodQuantity {
        /// Items consumed per member.
        Meals = "meals",
        /// Mean time from the appearance of an item to its consumption, of those that were consumed.
        Wait = "wait",
        /// Share of the contested items that were consumed by the group: a living member of another group was near as well.
        Won = "won",
    }
}

form! {
    /// Something of the food that a group consumes, over the whole trial.
    pub struct FoodReading {
        /// What.
        quantity: FoodQuantity = need, "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// Whoever is closer than this to an item, when it is consumed, contests it.
        near: f64 = [20.0], "length", Positive;
    }
}

words! {
    /// What is read off the ground.
    pub enum GroundQuantity {
        /// Area of the cells in which the group has members.
        Area = "area",
        /// Cells in which both groups have members, over those in which either has.
        Overlap = "overlap",
    }
}

form! {
    /// Something of the ground that a group holds, cell by cell, over the looks.
    pub struct GroundReading {
        /// What.
        quantity: GroundQuantity = need, "", Any;
        /// Side of the cells, which begin at the origin.
        cell: f64 = need, "length", Positive;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
        /// The other group, of an overlap; left out, everyone.
        with: Option<String> = none, "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

form! {
    /// How far those who walk to and fro along an axis have formed lanes, over the looks: 1 in perfect lanes, about 1/n by chance with n in
    /// one. The metric over time `lane_order` (2-D).
    pub struct LaneReading {
        /// Width of a lane.
        width: f64 = [0.8], "length", Positive;
        /// The axis along which they walk: 1 for x, 2 for y.
        axis: usize = [1usize], "1", Within(1.0, 2.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// What is made of its values.
        statistic: Statistic = [Statistic::Mean], "", Any;
    }
}

words! {
    /// What is read off the way-points that members choose.
    pub enum WayPointQuantity {
        /// Trace of their covariance in the member's own frame: smaller is smoother.
        Smoothness = "smoothness",
        /// Mean squared change from one cycle to the next.
        Jitter = "jitter",
        /// Percentage of HA and HA_PERP among these and SNN.
        Ha = "percentage_ha",
        /// Percentage of them whose direction differs by more than 5 degrees from that to the nearest input.
        EffectiveHa = "effective_percentage_ha",
        /// Mean distance to the nearest input.
        NearestInput = "nearest_input",
    }
}

form! {
    /// Something of the way-points of a model that keeps them, as `ha_extended` does; a look is taken for a cycle of control.
    pub struct WayPointReading {
        /// What.
        quantity: WayPointQuantity = need, "", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
    }
}

words! {
    /// What is read off the detections of lasers.
    pub enum DetectionQuantity {
        /// Share of the members in range and field of view that are not detected.
        FalseNegatives = "false_negatives",
        /// The same of those that are not fully hidden.
        VisibleFalseNegatives = "visible_false_negatives",
        /// Share of the detections that belong to no member.
        FalsePositives = "false_positives",
        /// Number of members detected, in all scans.
        Detected = "detected",
        /// Number of inputs handed to the law, in all scans.
        Inputs = "inputs",
    }
}

form! {
    /// What lasers detect, over the whole trial.
    pub struct DetectionReading {
        /// What.
        quantity: DetectionQuantity = need, "", Any;
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
    }
}

words! {
    /// What is read off those who come to a place.
    pub enum ArrivalQuantity {
        /// Share of the members that have come there at any look.
        Share = "share",
        /// Share of the members that are there at the last look.
        There = "there",
        /// Time at which so many had come; none where so many never do.
        Time = "time",
    }
}

form! {
    /// Who comes to a place: members nearer to it than a distance.
    pub struct ArrivalReading {
        /// What.
        quantity: ArrivalQuantity = need, "", Any;
        /// The place.
        at: Vec<f64> = need, "length", Any;
        /// Who is nearer than this is there.
        within: f64 = need, "length", Positive;
        /// The share whose arrival takes the time.
        part: f64 = [0.5], "1", Within(0.0, 1.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
    }
}

words! {
    /// What is read off a turn that passes through a group.
    pub enum TransferQuantity {
        /// Share of the others that have turned.
        Share = "share",
        /// Mean delay of those.
        Delay = "delay",
        /// Delay of who stood last along the mean heading.
        Rearmost = "rearmost",
        /// Speed at which the turn spreads: squared distances from the first, summed, over distances times delays.
        Speed = "speed",
        /// Rank correlation of delay and distance from the first.
        Correlation = "correlation",
    }
}

form! {
    /// A turn that passes through a group, from the first look on at which a count of the law is not 0 for somebody: that one is
    /// the first. Others have turned when their heading differs by more than an angle from what it was then.
    pub struct TransferReading {
        /// What.
        quantity: TransferQuantity = need, "", Any;
        /// The count, as `o_avoid`: obstacles that are avoided.
        column: String = ["o_avoid".to_owned()], "", Any;
        /// The angle.
        angle: f64 = [30.0], "deg", Within(0.0, 180.0);
        /// What it is multiplied by.
        scale: f64 = [1.0], "", Any;
        /// The group; left out, everyone.
        group: Option<String> = none, "", Any;
    }
}

words! {
    /// What is read off the places of members in their cluster.
    pub enum StandingQuantity {
        /// Ahead of the centre along the mean heading.
        Ahead = "ahead",
        /// Distance from the centre.
        Distance = "distance",
    }
}

form! {
    /// Where members stand in their cluster, over the looks, in units of the root of its expanse: the mean of those of a group, or how
    /// it goes together with a column over all members.
    pub struct StandingReading {
        /// What.
        quantity: StandingQuantity = need, "", Any;
        /// Members at most this far apart are linked; clusters are what hangs together.
        linking_distance: f64 = need, "length", Positive;
        /// The group whose mean it is; left out, everyone. Clusters are of everyone.
        group: Option<String> = none, "", Any;
        /// A column: then it is the rank correlation of the members' mean places with the means of this column.
        with: Option<String> = none, "", Any;
    }
}

tagged! {
    /// What is read off a trial: one number.
    pub enum Quantity {
        /// A metric.
        metric => Metric(MetricReading);
        /// Members in a box.
        inside => Inside(InsideReading);
        /// A share of a state.
        share => Share(ShareReading);
        /// A mean of a column.
        column => Column(ColumnReading);
        /// Who lives.
        alive => Alive(AliveReading);
        /// Contacts.
        contacts => Contacts(ContactReading);
        /// Coverage of the space.
        coverage => Coverage(CoverageReading);
        /// Something of the largest cluster.
        cluster => Cluster(ClusterReading);
        /// Something of the paths.
        path => Path(PathReading);
        /// Something of the ground that is held.
        ground => Ground(GroundReading);
        /// How far people who walk to and fro have formed lanes.
        lanes => Lanes(LaneReading);
        /// Something of the way-points that members choose.
        way_points => WayPoints(WayPointReading);
        /// What lasers detect.
        detection => Detection(DetectionReading);
        /// Something of the food.
        food => Food(FoodReading);
        /// Who comes to a place.
        arrival => Arrival(ArrivalReading);
        /// A turn that passes through a group.
        transfer => Transfer(TransferReading);
        /// Where members stand in their cluster.
        standing => Standing(StandingReading);
        /// The distance between obstacles.
        obstacle_distance => ObstacleDistance(ObstacleReading);
        /// How uneven the density is along the way.
        profile => Profile(ProfileReading);
        /// How far departures from the common motion reach.
        correlation => Correlation(CorrelationReading);
        /// How well an agreement would hold.
        consensus => Consensus(ConsensusReading);
        /// Which way a group went.
        bearing => Bearing(BearingReading);
        /// How often it turned round.
        reversals => Reversals(ReversalReading);
        /// How long it takes until a box is empty.
        emptied => Emptied(EmptiedReading);
    }
}

form! {
    /// A number that is kept of every trial.
    pub struct Reading {
        /// What it is, for axes and tables; left out, its name.
        about: String = [""], "", Any;
        /// Its unit, for axes and tables.
        unit: String = [""], "", Any;
        /// What is read.
        of: Quantity = need, "", Any;
    }
}

form! {
    /// A figure: means over trials with their standard errors.
    pub struct Figure {
        /// Title.
        title: String = need, "", Any;
        /// A sentence below it.
        about: String = [""], "", Any;
        /// The reading on the vertical axis.
        y: Vec<String> = need, "", Any;
        /// The factor on the horizontal axis.
        x: String = need, "", Any;
        /// A line for each level of this factor.
        lines: Option<String> = none, "", Any;
        /// Only cells with these levels.
        only: Named<Anything> = [Named::default()], "", Any;
    }
}

form! {
    /// A test whether a reading differs between the levels of a factor: one-way analysis of variance with Tukey-Kramer
    /// comparisons of all pairs, and the same with trials as blocks, since all cells have the same seeds.
    pub struct Test {
        /// The reading.
        y: String = need, "", Any;
        /// The factor whose levels are compared.
        between: String = need, "", Any;
        /// Only cells with these levels.
        only: Named<Anything> = [Named::default()], "", Any;
        /// A test for each combination of levels of these factors.
        each: Vec<String> = [Vec::new()], "", Any;
    }
}

words! {
    /// How firmly a statement is expected.
    pub enum Strength {
        /// It must hold.
        A = "A",
        /// It is expected.
        B = "B",
        /// It is reported, whatever comes.
        C = "C",
    }
}

form! {
    /// A statement that the data are asked about.
    pub struct Claim {
        /// Its name.
        id: String = need, "", Any;
        /// The statement.
        text: String = need, "", Any;
        /// Where it is made.
        source: String = [""], "", Any;
        /// How firmly it is expected.
        strength: Strength = [Strength::B], "", Any;
        /// A number that belongs to it: an expression over readings, as `coverage[variant = prob, N = 6]`.
        number: Option<String> = none, "", Any;
        /// What the source says that number is.
        published: String = [""], "", Any;
        /// When it holds: an expression that is true or false.
        holds: Option<String> = none, "", Any;
        /// Share of the drawings of the trials that may disagree with a verdict, on one side.
        doubt: f64 = [0.025], "1", Within(0.0, 0.5);
        /// Whether it is about these very trials, not about what they are drawn from: its values alone judge it.
        exact: bool = [false], "", Any;
    }
}

form! {
    /// A study: a scenario, varied and repeated, with what is read off, tested and claimed.
    pub struct Study {
        /// What kind of file this is.
        kind: FileKind = need, "", Any;
        /// A title of a few words.
        title: String = need, "", Any;
        /// What it is and what it asks; paragraphs are parted by empty lines.
        about: String = [""], "", Any;
        /// A study file whose keys hold where this one has none of its own; tables are joined key by key.
        extends: Option<String> = none, "", Any;
        /// Study files that make up this one: each is a part, equal conditions are computed once.
        parts: Vec<String> = [Vec::new()], "", Any;
        /// Trial t has the seed of the study plus t, in every cell.
        seed: u64 = [0u64], "1", NonNegative;
        /// Trials in each cell.
        trials: usize = [10usize], "1", Within(1.0, 1_000_000.0);
        /// Trials in each cell with `--quick`.
        quick_trials: usize = [5usize], "1", Within(1.0, 1_000_000.0);
        /// The scenario: the name of a file beside this one, or the scenario itself as a table.
        scenario: Option<Anything> = none, "", Any;
        /// Values put over the scenario's. Tables are joined key by key; a path in quotes puts its value as it is.
        set: Anything = [crate::study::form::empty()], "", Any;
        /// Names for expressions, in order.
        define: Named<String> = [Named::default()], "", Any;
        /// Values of the scenario that follow from others: path = expression, in order.
        derive: Named<String> = [Named::default()], "", Any;
        /// What is varied, by names of yours.
        factor: Named<Factor> = [Named::default()], "", Any;
        /// How cells are made of levels.
        design: Design = [Design::Full(Nothing)], "", Any;
        /// When a trial is looked at; left out, as the scenario measures.
        looks: Option<Window> = none, "", Any;
        /// What is read off each trial, by names of yours; left out, what the scenario measures.
        reading: Named<Reading> = [Named::default()], "", Any;
        /// Figures of the page.
        figure: Vec<Figure> = [Vec::new()], "", Any;
        /// Tests.
        test: Vec<Test> = [Vec::new()], "", Any;
        /// Statements to be judged.
        claim: Vec<Claim> = [Vec::new()], "", Any;
    }
}

/// A table without keys.
pub(crate) fn empty() -> Anything {
    Anything(crate::file::Node { tree: crate::file::Tree::Table(Vec::new()), span: crate::file::Span::default() })
}
