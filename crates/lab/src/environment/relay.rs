//! Behaviours one after the other: each stage has its own, and it begins where the group is handed over to it.

use super::trial::{Outcome, outcome};
use measure::behaviours::blocks::{Run, has_share};
use measure::behaviours::{Behaviour, Moment, Score, Watch};
use space::shape::Shape;
use terrain::Point;

/// When a group is handed over to a stage.
#[derive(Clone, Debug, PartialEq)]
pub enum Handover {
    /// So large a share of those who are still wanted has been inside the region for so many steps in a row.
    Inside {
        /// The entry region.
        region: Shape<f64, 2>,
        /// The types of members that are still wanted; empty: all.
        types: Vec<usize>,
        /// The share.
        share: f64,
        /// The steps.
        steps: u64,
    },
    /// A condition came to hold.
    When(Behaviour),
}

/// A stage of a relay.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// What is wanted of the group while it is in this stage.
    pub behaviour: Behaviour,
    /// When the group is handed over to the next stage; none for the last.
    pub ends: Option<Handover>,
}

/// Stages that follow each other, and what is wanted in each. The fitness of a stage is that of its behaviour over the steps
/// from where it began to where the group was handed over to the next, both included; a stage that never began has 0. That of
/// the whole is their product.
#[derive(Clone, Debug, PartialEq)]
pub struct Relay {
    /// The stages.
    pub legs: Vec<Leg>,
}

/// A group where it was handed over.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// The step.
    pub step: u64,
    /// Where everyone was, `[members]`.
    pub positions: Vec<Option<Point>>,
    /// The velocity with which each last moved, `[members]`; none for whom never did.
    pub velocities: Vec<Option<Point>>,
}

/// How far a handover is.
#[derive(Debug)]
enum Waiting {
    Inside(Run),
    When(Box<Watch>),
}

impl Handover {
    fn wait(&self) -> Waiting {
        match self {
            Self::Inside { .. } => Waiting::Inside(Run::default()),
            Self::When(behaviour) => Waiting::When(Box::new(behaviour.watch())),
        }
    }
    fn holds(&self, waiting: &mut Waiting, moment: &Moment<'_>) -> bool {
        match (self, waiting) {
            (Self::Inside { region, types, share, steps }, Waiting::Inside(run)) => {
                let wanted =
                    |k: &usize| types.is_empty() || moment.types.get(*k).is_some_and(|own| types.contains(own));
                let there = moment.positions.iter().enumerate().filter(|(k, _)| wanted(k));
                let there: Vec<Point> = there.filter_map(|(_, place)| *place).collect();
                let inside = there.iter().filter(|&&place| region.nearest(place).distance <= 0.0).count();
                run.sustained(has_share(inside, there.len(), *share), *steps)
            }
            (Self::When(_), Waiting::When(watch)) => {
                watch.step(moment);
                watch.fitness() >= 1.0
            }
            // each waits for itself
            _ => false,
        }
    }
}

/// A relay that is followed step by step.
#[derive(Debug)]
pub struct Following<'a> {
    relay: &'a Relay,
    /// Those of the stages that have begun; the last is the present one, unless the relay is over.
    watches: Vec<Watch>,
    waiting: Option<Waiting>,
    /// Where the group was handed over, once for each stage that has ended so.
    pub handed: Vec<State>,
    velocities: Vec<Option<Point>>,
    steps: u64,
}

impl Relay {
    /// Begins to follow a group.
    pub fn follow(&self) -> Following<'_> {
        let first = self.legs.first();
        Following {
            relay: self,
            watches: first.map(|leg| leg.behaviour.watch()).into_iter().collect(),
            waiting: first.and_then(|leg| leg.ends.as_ref()).map(Handover::wait),
            handed: Vec::new(),
            velocities: Vec::new(),
            steps: 0,
        }
    }
    /// A stage by itself; it ends where the group would be handed over.
    pub fn alone(&self, stage: usize) -> Self {
        Self { legs: self.legs.get(stage).cloned().into_iter().collect() }
    }
}

impl Following<'_> {
    /// Takes the next moment.
    pub fn step(&mut self, moment: &Moment<'_>) {
        self.velocities.resize(moment.positions.len(), None);
        for (last, now) in self.velocities.iter_mut().zip(moment.velocities) {
            *last = now.filter(|v| !v.is_tiny()).or(*last);
        }
        // a stage begins with the step in which the one before it ends, and may end there too
        while self.handed.len() < self.watches.len() {
            let stage = self.handed.len();
            if let Some(watch) = self.watches.get_mut(stage) {
                watch.step(moment);
            }
            let ends = self.relay.legs.get(stage).and_then(|leg| leg.ends.as_ref());
            let over = ends.zip(self.waiting.as_mut()).is_some_and(|(ends, waiting)| ends.holds(waiting, moment));
            if !over {
                break;
            }
            self.handed.push(State {
                step: self.steps,
                positions: moment.positions.to_vec(),
                velocities: self.velocities.clone(),
            });
            let Some(next) = self.relay.legs.get(stage + 1) else { break };
            self.watches.push(next.behaviour.watch());
            self.waiting = next.ends.as_ref().map(Handover::wait);
        }
        self.steps += 1;
    }
    /// Whether nothing can change any more: the relay is over, or it is in its last stage, and that is settled.
    pub fn settled(&self) -> bool {
        if self.handed.len() == self.relay.legs.len() {
            return true;
        }
        let last = self.watches.len() == self.relay.legs.len() && self.waiting.is_none();
        last && self.watches.last().is_some_and(Watch::settled)
    }
    /// What came of each stage, and of the whole: its value is the step at which the last stage began.
    pub fn outcomes(&self) -> Vec<Outcome> {
        let never = Outcome { fitness: 0.0, value: f64::NAN };
        let of = |(k, leg): (usize, &Leg)| self.watches.get(k).map_or(never, |watch| outcome(watch, &leg.behaviour));
        let mut all: Vec<Outcome> = self.relay.legs.iter().enumerate().map(of).collect();
        let fitness = all.iter().map(|outcome| outcome.fitness).product();
        let began = self.relay.legs.len().checked_sub(2).and_then(|k| self.handed.get(k));
        all.push(Outcome { fitness, value: began.map_or(f64::NAN, |state| state.step as f64) });
        all
    }
}

/// A condition as something to wait for.
pub fn when(name: &str, condition: measure::behaviours::Condition) -> Handover {
    Handover::When(Behaviour { name: name.to_owned(), score: Score::Binary(condition) })
}
