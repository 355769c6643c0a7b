//! What a model says about itself beyond its parameters.

use core::ops::RangeInclusive;

/// How a group is composed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Composition {
    /// Every member has the same motion computation with the same parameters.
    Homogeneous,
    /// Some members have parameters of their own.
    Heterogeneous,
}

/// Which collisions a law avoids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Avoidance {
    /// None.
    None,
    /// Other members.
    Member,
    /// The environment.
    Environment,
    /// Both.
    All,
}

/// How an attribute of others is had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Information {
    /// From an oracle.
    Global,
    /// From the member's own sensor.
    Local,
    /// Combined from two kinds of reading or two scans.
    Inferred,
    /// Known beforehand and the same for all.
    Constant,
    /// Not had.
    None,
}

/// The two tables in which the dissertation classifies control-laws (design: 3.2, validation: 3.4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taxonomy {
    /// Same computation for all members, or not.
    pub composition: Composition,
    /// Whether the computed motion is performed exactly.
    pub idealized: bool,
    /// Whether time goes in fixed sense-compute-act intervals.
    pub discrete: bool,
    /// Which collisions are avoided.
    pub avoidance: Avoidance,
    /// Whether members carry an id that others read.
    pub identification: bool,
    /// Whether the law uses position, velocity, orientation of others.
    pub uses: [bool; 3],
    /// How the publication validates: letters M (mathematically), S (simulation), P (physical robots).
    pub validation: &'static str,
    /// Whether all members run all stages at the same times.
    pub synchronous: bool,
    /// How position, velocity and orientation were had.
    pub information: [Information; 3],
    /// The environment of the publication.
    pub environment: &'static str,
}

/// The five rows of the stage table, and the two that concern obstacles where the model has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stages {
    /// Visible environment to raw data.
    pub sensing: &'static str,
    /// Raw data to detected members.
    pub detection: &'static str,
    /// Detected members to the named sets.
    pub selection: &'static str,
    /// Named sets to the wanted motion.
    pub motion: &'static str,
    /// Wanted to actual motion.
    pub physics: &'static str,
    /// Obstacle detection and selection, or empty.
    pub obstacles: &'static str,
}

/// A random quantity of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RandomQuantity {
    /// Name under which a caller may supply it.
    pub name: &'static str,
    /// Its distribution and the draws it consumes.
    pub about: &'static str,
}

impl RandomQuantity {
    /// How many numbers it has for a member in so many dimensions.
    pub fn components(&self, dimension: usize) -> RangeInclusive<usize> {
        match self.name {
            "unit" | "noise_vec" | "jitter" => dimension..=dimension,
            // an angle in laws, a vector in compositions
            "wander" => 1..=dimension,
            _ => 1..=1,
        }
    }
}

/// A model's description of itself.
#[derive(Clone, Copy, Debug)]
pub struct Card {
    /// Id: file name, name in files, docs page.
    pub id: &'static str,
    /// Title in a few words.
    pub title: &'static str,
    /// One plain sentence: what members do.
    pub about: &'static str,
    /// Reference of the publication.
    pub reference: &'static str,
    /// The equations, in the order of computation.
    pub equations: &'static str,
    /// The stage table.
    pub stages: Stages,
    /// How this differs from the publication, or "none".
    pub departures: &'static str,
    /// What happens with no neighbour, coincident members, zero sums.
    pub edge: &'static str,
    /// Random quantities.
    pub random: &'static [RandomQuantity],
    /// Classification.
    pub taxonomy: Taxonomy,
}
