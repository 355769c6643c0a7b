//! Neighbour selection: the eight perception functions and their combinations, as written.

use crate::file::Nothing;
use crate::{form, tagged, words};
use swarm::parameters::{Range, Scalar};
use swarm::selection::Perception;

words! {
    /// Whose axes a box has.
    pub enum Axes {
        /// The world's.
        World = "world",
        /// The first along the heading (2-D).
        Body = "body",
    }
}

form! {
    /// Distances from `low` to below `high`.
    pub struct Distances {
        /// Nearest distance selected.
        low: f64 = [0.0], "length", NonNegative;
        /// First distance no longer selected.
        high: f64 = need, "length", Positive;
    }
}

form! {
    /// Displacements between two corners.
    pub struct Corners {
        /// Lower corner relative to the agent.
        low: Vec<f64> = need, "length", Any;
        /// Upper corner relative to the agent.
        high: Vec<f64> = need, "length", Any;
        /// Whose axes the box has.
        axes: Axes = [Axes::World], "", Any;
    }
}

form! {
    /// A difference of two selections.
    pub struct Difference {
        /// Those selected.
        from: Box<Choice> = need, "", Any;
        /// Those left out.
        without: Box<Choice> = need, "", Any;
    }
}

tagged! {
    /// A selection of neighbours.
    pub enum Choice {
        /// Everyone sensed.
        all => All(Nothing);
        /// Given ids: a list for each member of the group.
        fixed_set => FixedSet(Vec<Vec<u32>>);
        /// Those at certain distances.
        distance_based => DistanceBased(Distances);
        /// The nearest one.
        nearest => Nearest(Nothing);
        /// Those whose Voronoi cell touches the agent's own.
        voronoi => Voronoi(Nothing);
        /// The so many nearest.
        k_nearest in "1", Range::Positive => KNearest(usize);
        /// Those in a box.
        bounding_box => BoundingBox(Corners);
        /// Those in a cone about the heading, by its full opening.
        angle in "deg", Range::Within(0.0, 360.0) => Angle(f64);
        /// Those in every one of these.
        intersection => Intersection(Vec<Choice>);
        /// Those in any of these.
        union => Union(Vec<Choice>);
        /// Those in one selection and not in another.
        difference => Difference(Difference);
        /// Each takes what the one before it selected.
        sequence => Sequence(Vec<Choice>);
    }
}

impl Choice {
    /// The perception function.
    ///
    /// # Errors
    /// A sentence where corners have another number of coordinates than the space.
    pub(super) fn resolved<R: Scalar, const D: usize>(&self) -> Result<Perception<R, D>, String> {
        let all = |parts: &[Self]| parts.iter().map(Self::resolved).collect::<Result<Vec<_>, _>>();
        Ok(match self {
            Self::All(_) => Perception::All,
            Self::FixedSet(lists) => Perception::FixedSet(lists.clone()),
            Self::DistanceBased(d) => Perception::distance(R::of(d.low), R::of(d.high)),
            Self::Nearest(_) => Perception::Nearest,
            Self::Voronoi(_) => Perception::Voronoi,
            Self::KNearest(k) => Perception::KNearest(*k),
            Self::BoundingBox(corners) => Perception::BoundingBox {
                low: super::build::vector(&corners.low)?,
                high: super::build::vector(&corners.high)?,
                body_frame: corners.axes == Axes::Body,
            },
            Self::Angle(opening) => Perception::angle(R::of(opening.to_radians())),
            Self::Intersection(parts) => Perception::Intersection(all(parts)?),
            Self::Union(parts) => Perception::Union(all(parts)?),
            Self::Difference(parts) => {
                Perception::Difference(Box::new(parts.from.resolved()?), Box::new(parts.without.resolved()?))
            }
            Self::Sequence(parts) => Perception::Sequence(all(parts)?),
        })
    }
}
