//! Velocities and pair forces of neighbours, summed, with a hard core before all else: the models of Gregoire, Chate and Tu (2003),
//! and what Camperi et al. (2012) made of them.

use crate::choice;
use crate::motion::*;
use crate::parameters::Scalar;
use crate::selection::{NamedSet, Perception};
use space::Vector;
use space::lanes::{Lanes, Mask};

choice! {
    /// Who counts as a neighbour.
    pub enum Neighbourhood {
        /// Everyone within the interaction radius.
        Metric = "metric",
        /// Those of them whose Voronoi cells touch one's own.
        Voronoi = "voronoi",
    }
}

/// Who counts as a neighbour.
#[derive(Clone, Copy, Debug)]
pub enum Neighbours {
    /// Everyone within the interaction radius.
    Metric,
    /// Those of them whose Voronoi cells touch one's own.
    VoronoiInRange,
    /// Whose Voronoi cells touch one's own, however far.
    Voronoi,
    /// The nearest so many.
    Topological(usize),
}

impl From<Neighbourhood> for Neighbours {
    fn from(choice: Neighbourhood) -> Self {
        match choice {
            Neighbourhood::Metric => Self::Metric,
            Neighbourhood::Voronoi => Self::VoronoiInRange,
        }
    }
}

/// How a member errs, with the amplitude.
#[derive(Clone, Copy, Debug)]
pub enum Noise<R> {
    /// A random vector, for each member that votes; none in the hard core.
    Vector(R),
    /// A random share of a half turn, also of a kept heading and in the hard core.
    Angle(R),
}

/// The law.
#[derive(Debug)]
pub struct PairLaw<R> {
    /// Weight of the summed velocities.
    pub alignment_weight: R,
    /// Weight of the summed pair forces.
    pub cohesion_weight: R,
    /// Distance below which a neighbour repels before all else.
    pub hard_core_radius: R,
    /// Distance at which the pair force vanishes.
    pub equilibrium_distance: R,
    /// Distance from which attraction is full.
    pub attraction_radius: R,
    /// Radius within which others are neighbours.
    pub interaction_radius: R,
    /// Speed, the same for all.
    pub speed: R,
    /// How a member errs.
    pub noise: Noise<R>,
    /// Length of a step.
    pub time_step: R,
    /// Who counts.
    pub neighbours: Neighbours,
}

/// Whether the pair force has a slope.
///
/// # Errors
/// An equilibrium that is not nearer than where attraction is full.
pub fn check<R: Scalar>(equilibrium_distance: R, attraction_radius: R) -> Result<(), String> {
    if equilibrium_distance < attraction_radius {
        Ok(())
    } else {
        Err("`equilibrium_distance` must be less than `attraction_radius`".into())
    }
}

impl<R: Scalar, const D: usize> Stream<R, D> for PairLaw<R> {
    /// Velocities, pair forces, directions to those in the hard core; how many neighbours and how many of them there.
    type Sums<L: Lanes<R>> = ([L; D], [L; D], [L; D], [L; 2]);
    const HEADINGS: bool = false;

    fn sets(&self) -> Vec<NamedSet<R, D>> {
        let near = Perception::distance(R::ZERO, self.interaction_radius);
        let neighbours = match self.neighbours {
            Neighbours::Metric => near,
            Neighbours::VoronoiInRange => near.both(Perception::Voronoi),
            Neighbours::Voronoi => Perception::Voronoi,
            Neighbours::Topological(count) => Perception::KNearest(count),
        };
        vec![NamedSet::new("neighbours", neighbours)]
    }
    fn reach(&self) -> R {
        match self.neighbours {
            Neighbours::Metric | Neighbours::VoronoiInRange => self.interaction_radius,
            Neighbours::Voronoi | Neighbours::Topological(_) => R::INFINITY,
        }
    }
    #[inline(always)]
    fn classify<L: Lanes<R>>(&self, _: &MeLanes<L, D>, _: &[L; D], _: L, _: &Other<'_, R, D>) -> SetMasks<L::Mask> {
        // asked for metric neighbours only: the other sets are ranks, which need lists
        let [yes, no] = [true, false].map(L::Mask::all_of);
        [yes, no, no, no]
    }
    #[inline(always)]
    fn gather<L: Lanes<R>>(
        &self,
        (velocities, forces, hard_core, counts): &mut Self::Sums<L>,
        _: &MeLanes<L, D>,
        offset: &[L; D],
        squared: L,
        other: &Other<'_, R, D>,
        sets: &SetMasks<L::Mask>,
    ) {
        let one = L::splat(R::ONE);
        let within = |radius: R| squared.less(L::splat(radius * radius));
        let towards = directions(offset, squared);
        let slope = R::ONE / (R::of(4.0) * (self.attraction_radius - self.equilibrium_distance));
        let linear = (squared.square_root() - L::splat(self.equilibrium_distance)) * L::splat(slope);
        let strength = L::choose(within(self.attraction_radius), linear, one);
        let touching = sets[0].and(within(self.hard_core_radius));
        add_where(velocities, sets[0], splat(other.velocity));
        add_where(forces, sets[0], towards.map(|part| part * strength));
        add_where(hard_core, touching, towards);
        counts[0] = counts[0].add_where(sets[0], one);
        counts[1] = counts[1].add_where(touching, one);
    }
    #[inline(always)]
    fn finish(
        &self,
        me: &mut Me<'_, R, D>,
        (velocities, forces, hard_core, counts): &Self::Sums<R>,
        draws: &Draws<'_>,
    ) -> Motion<R, D> {
        let mut wanted = -Vector(*hard_core);
        let touching = counts[1] > R::ZERO;
        me.value("neighbours in the hard core", counts[1], "1");
        me.either(["hard core", "alignment and cohesion"], usize::from(!touching));
        if touching {
            me.note("hard core", wanted);
        } else {
            let alignment = (me.velocity + Vector(*velocities)) * self.alignment_weight;
            let cohesion = Vector(*forces) * self.cohesion_weight;
            me.note("alignment", alignment);
            me.note("cohesion", cohesion);
            wanted = alignment + cohesion;
            if let Noise::Vector(eta) = self.noise
                && eta > R::ZERO
            {
                let unit: Vector<R, D> = draws.vector("unit", |s| s.unit(0));
                let noise = unit * ((counts[0] + R::ONE) * eta);
                me.note("noise", noise);
                wanted += noise;
            }
        }
        me.sum(wanted);
        wanted = wanted.unit();
        if wanted.is_tiny() {
            wanted = me.heading();
        }
        if let Noise::Angle(eta) = self.noise
            && eta > R::ZERO
        {
            let xi: R = draws.number("xi", 0.0, |s| core::f64::consts::TAU * (s.uniform(0) - 0.5));
            me.value("noise", eta * xi, "rad");
            wanted = wanted.turned_by(eta * xi, R::ZERO);
        }
        Motion::new_velocity(wanted * self.speed, self.time_step)
    }
}
