//! The course of a group as a whole: of a simulated trial, look by look, and predicted among walls, without agents.

use super::model::Model;
use super::state::{Members, State};
use super::surroundings::Wall;
use crate::environment::trial::{self, Population};
use crate::scenario::Scenario;
use measure::behaviours::{Behaviour, Moment};
use terrain::Point;

/// A trial by looks at the group as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// Its fitness; not a number where the trial was impossible.
    pub fitness: f64,
    /// Steps made: it ends when the fitness can no longer change.
    pub steps: u64,
    /// The state at each look, from the start on.
    pub looks: Vec<State>,
}

/// How a group is looked at, and what is wanted of it.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The group.
    pub population: &'a Population,
    /// What is wanted.
    pub behaviour: &'a Behaviour,
    /// Steps from look to look.
    pub every: u64,
    /// Distance up to which members are of one group.
    pub link: f64,
}

/// Runs a trial in a scenario with everything in it; none where it was stopped. A trial that its seed makes impossible has no looks.
pub fn simulated(asked: Asked<'_>, scenario: &Scenario, seed: u64, stop: &dyn Fn() -> bool) -> Option<Course> {
    let mut watch = asked.behaviour.watch();
    let mut looks: Vec<State> = Vec::new();
    let mut step = 0u64;
    let mut lost = false;
    let mut see = |moment: &Moment<'_>| {
        watch.step(moment);
        if step.is_multiple_of(asked.every) && !lost {
            match State::of(moment, asked.link, looks.last()) {
                Some(state) => looks.push(state),
                // nobody is there any more
                None => lost = true,
            }
        }
        step += 1;
        watch.settled()
    };
    match trial::follow(scenario, asked.population, seed, stop, &mut see) {
        Ok(None) => None,
        Ok(Some(steps)) => Some(Course { fitness: watch.fitness(), steps, looks }),
        Err(_) => Some(Course { fitness: f64::NAN, steps: 0, looks: Vec::new() }),
    }
}

/// The state in which a trial begins; none where its seed makes it impossible.
pub fn start(asked: Asked<'_>, scenario: &Scenario, seed: u64) -> Option<State> {
    let mut state = None;
    let mut see = |moment: &Moment<'_>| {
        state = State::of(moment, asked.link, None);
        true
    };
    let _ = trial::follow(scenario, asked.population, seed, &|| false, &mut see);
    state
}

/// Predicts a trial from a start, with the draws of a key. What is wanted is asked of members that have the state of the group between
/// them; from look to look they go straight.
pub fn predicted(
    asked: Asked<'_>,
    model: &Model,
    members: &Members,
    start: &State,
    walls: &[Wall],
    key: u64,
) -> Course {
    let mut watch = asked.behaviour.watch();
    let mut looks = vec![*start];
    let there = |all: Vec<Point>| -> Vec<Option<Point>> { all.into_iter().map(Some).collect() };
    let mut see = |positions: Vec<Point>, velocities: &[Option<Point>]| {
        let positions = there(positions);
        watch.step(&Moment { positions: &positions, velocities, types: &asked.population.types });
        watch.settled()
    };
    let (mut now, mut state) = (members.positions(start, walls), *start);
    let (mut step, last) = (0, asked.population.steps);
    let mut settled = see(now.clone(), &there(members.headings(start)));
    while step < last && !settled {
        let to = model.step(&state, walls, key, step / asked.every);
        let (next, headings) = (members.positions(&to, walls), there(members.headings(&to)));
        for part in 1..=asked.every.min(last - step) {
            let share = part as f64 / asked.every as f64;
            let between = now.iter().zip(&next).map(|(&now, &next)| now + (next - now) * share).collect();
            step += 1;
            settled = see(between, &headings);
            if settled {
                break;
            }
        }
        (now, state) = (next, to);
        looks.push(state);
    }
    Course { fitness: watch.fitness(), steps: step, looks }
}
