//! A behaviour that is followed step by step.

use super::Score;
use super::score::Scored;
use space::{Frame, Real, Vector};

/// A group at one step: everyone who ever belonged to it, in the order of their ids.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a> {
    /// Positions, `[members]`; `None` for who is not there.
    pub positions: &'a [Option<Vector<f64, 2>>],
    /// Velocities, `[members]`; may be left empty where no signal reads headings.
    pub velocities: &'a [Option<Vector<f64, 2>>],
    /// Number of the type of each, `[members]`; left empty, all are of type 0.
    pub types: &'a [usize],
}

/// A behaviour: a name and a score.
#[derive(Clone, Debug, PartialEq)]
pub struct Behaviour {
    /// Its name.
    pub name: String,
    /// What it is worth.
    pub score: Score,
}

impl Behaviour {
    /// Begins to follow a group.
    pub fn watch(&self) -> Watch {
        Watch { scored: Scored::new(&self.score), steps: 0 }
    }
    /// The fitness of a whole course: positions by step and member, all there throughout.
    pub fn fitness(&self, course: &[Vec<Vector<f64, 2>>]) -> f64 {
        let mut watch = self.watch();
        for positions in course {
            let positions: Vec<_> = positions.iter().map(|&p| Some(p)).collect();
            watch.step(&Moment { positions: &positions, velocities: &[], types: &[] });
        }
        watch.fitness()
    }
}

/// What there is to say of a part of a behaviour.
#[derive(Clone, Debug, PartialEq)]
pub struct Explained {
    /// How deep it is nested, from 0.
    pub depth: usize,
    /// What it is.
    pub text: String,
    /// The first step, from 0, at which it held; `None` where it never did, and for scores.
    pub first: Option<u64>,
    /// Whether it holds now, or the score is full.
    pub holds: bool,
    /// The present value of its signal or score, where there is one.
    pub value: Option<f64>,
}

/// A behaviour that is followed step by step.
#[derive(Clone, Debug)]
pub struct Watch {
    scored: Scored,
    steps: u64,
}

impl Watch {
    /// Takes the next moment; the first is step 0.
    pub fn step(&mut self, moment: &Moment<'_>) {
        self.scored.step(moment, self.steps);
        self.steps += 1;
    }
    /// Takes the next moment from a frame; agents without finite positions are not there. `types` as in [`Moment`].
    pub fn frame<R: Real>(&mut self, frame: &Frame<'_, R, 2>, types: &[usize]) {
        let wide = |v: Vector<R, 2>| Some(Vector(v.0.map(R::to_f64))).filter(|v: &Vector<f64, 2>| v.finite());
        let rows = frame.rows_by_id();
        let positions: Vec<_> = rows.iter().map(|&row| wide(frame.columns.position(row))).collect();
        let velocities: Vec<_> = rows.iter().map(|&row| wide(frame.columns.velocity(row))).collect();
        self.step(&Moment { positions: &positions, velocities: &velocities, types });
    }
    /// Steps taken.
    pub fn steps(&self) -> u64 {
        self.steps
    }
    /// The fitness if the course ended here, in [0, 1]; 0 before the first step.
    pub fn fitness(&self) -> f64 {
        if self.steps == 0 { 0.0 } else { self.scored.value() }
    }
    /// The fitness of each part of a product, mean or the like; of the whole where it has no parts.
    pub fn parts(&self) -> Vec<f64> {
        match self.scored.parts.as_slice() {
            [] => vec![self.fitness()],
            parts => parts.iter().map(Scored::value).collect(),
        }
    }
    /// Whether the fitness can no longer change: the trial may stop.
    pub fn settled(&self) -> bool {
        self.scored.settled()
    }
    /// When each condition first held, from the outermost inwards.
    pub fn explain(&self) -> Vec<Explained> {
        let mut lines = Vec::new();
        self.scored.explain(0, &mut lines);
        lines
    }
}
