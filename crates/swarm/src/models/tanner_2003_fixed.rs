//! Everyone agrees on velocity with its fixed neighbours and keeps a distance to them.
//!
//! H. G. Tanner, A. Jadbabaie, G. J. Pappas (2003), Stable flocking of mobile agents, part I: fixed topology, Proceedings of the 42nd IEEE
//! Conference on Decision and Control, 2010-2015.

use crate::card::*;
use crate::models::families::tanner::StableFlock;
use crate::motion::*;
use crate::parameters;
use crate::parameters::Scalar;

parameters! {
    /// Parameters of `tanner_2003_fixed`.
    pub struct Tanner2003Fixed {
        /// Neighbours of each member, by index in the group; empty: all of the group.
        neighbour_lists alias "sets": Vec<Vec<usize>> = [0.0; 0], "S_i", "1", NonNegative, Ours;
        /// Length of a step.
        time_step alias "dt": R = 0.01, "Dt", "time", Positive, Ours;
    }
}

impl<R: Scalar> Law<R> for Tanner2003Fixed<R> {
    const CARD: Card = Card {
        id: "tanner_2003_fixed",
        title: "Tanner et al. 2003, fixed topology",
        about: "Members agree on velocity with given neighbours, however far, and keep a distance of one to them.",
        reference: "H. G. Tanner, A. Jadbabaie, G. J. Pappas (2003). Stable flocking of mobile agents, part I: fixed topology. \
                    Proceedings of the 42nd IEEE Conference on Decision and Control, 2010-2015. doi:10.1109/CDC.2003.1272910",
        equations: "u_i = sum_{j in I} (v_j - v_i) + sum_{j in I} V'(rho_ij) e_ij\n\
                    V = 1/rho^2 + ln(rho^2),  V' = -2/rho^3 + 2/rho\n\
                    v_i' = v_i + Dt u_i;  x_i' = x_i + Dt v_i'",
        stages: Stages {
            sensing: "ideal",
            detection: "ideal",
            selection: "neighbours = all; of these those of the own list (fixed_set by index in the group)",
            motion: "acceleration",
            physics: "ideal",
            obstacles: "",
        },
        departures: "the velocity term has the wrong sign in the table (it would drive velocities apart); log(L2)^2 is ln(rho^2)",
        edge: "coincident: no pair force; an empty list: straight on",
        random: &[],
        taxonomy: Taxonomy {
            composition: Composition::Homogeneous,
            idealized: true,
            discrete: false,
            avoidance: Avoidance::Member,
            identification: true,
            uses: [true, true, true],
            validation: "MS",
            synchronous: true,
            information: [Information::Global, Information::Global, Information::Global],
            environment: "bounded free",
        },
    };
    fn needs(&self) -> Needs {
        Needs { velocity: true, identity: true, ..Needs::default() }
    }
    fn time_step(&self) -> R {
        self.time_step
    }
    fn check(&self, members: usize) -> Result<(), String> {
        let lists = &self.neighbour_lists;
        if !lists.is_empty() && lists.len() != members {
            return Err(format!("`neighbour_lists` needs a list for each of {members} members, found {}", lists.len()));
        }
        match lists.iter().flatten().find(|&&number| number >= members) {
            Some(number) => {
                Err(format!("`neighbour_lists` names member {number}, but the group's {members} count from 0"))
            }
            None => Ok(()),
        }
    }
}

impl<R: Scalar> Variant<R> for Tanner2003Fixed<R> {
    type Shared = StableFlock<R>;
    fn shared(&self) -> Self::Shared {
        StableFlock { radius: None, lists: self.neighbour_lists.clone(), time_step: self.time_step }
    }
}

#[cfg(test)]
mod tests {
    use crate::models::oracle::{Oracle, close};

    use crate::parameters::Value;

    #[test]
    fn only_listed_neighbours_count_however_far() {
        let three = [([0.0, 0.0], [1.0, 0.0]), ([0.5, 0.0], [0.0, 0.0]), ([40.0, 0.0], [0.0, 2.0])];
        let lists = Value::List(vec![[1usize].into(), [0usize, 2].into(), Value::List(Vec::new())]);
        let w = Oracle::new("tanner_2003_fixed").set("sets", lists).step(&three);
        close(w.velocity(0), [0.87, 0.0]);
        let far = 2.0 / 39.5 - 2.0 / 39.5f64.powi(3);
        close(w.velocity(1), [0.13 + 0.01 * far, 0.02]);
        close(w.velocity(2), [0.0, 2.0]);
        // without lists all of the group are neighbours
        let w = Oracle::new("tanner_2003_fixed").step(&three[..2]);
        close(w.velocity(0), [0.87, 0.0]);
        close(w.position(1), [0.5013, 0.0]);
    }

    #[test]
    fn a_chain_keeps_its_momentum_and_agrees() {
        let lists = Value::List(vec![[1usize].into(), [0usize, 2].into(), [1usize].into()]);
        let mut w = Oracle::new("tanner_2003_fixed").set("sets", lists).world(&[
            ([0.0, 0.0, 0.0], [0.3, 0.0, 0.0]),
            ([1.0, 0.0, 0.0], [0.0, 0.3, 0.0]),
            ([2.0, 0.0, 0.0], [0.0, 0.0, 0.3]),
        ]);
        w.run(6000);
        for id in 0..3 {
            assert!((w.velocity(id) - space::Vector([0.1; 3])).length() < 1e-3, "{:?}", w.velocity(id));
        }
        let w = Oracle::new("tanner_2003_fixed").step(&[([1.0], [1.0]), ([1.0], [0.0])]);
        close(w.velocity(0), [0.99]);
    }
}
