//! Scores: numbers in [0, 1] made of conditions and signals.

use super::condition::Node;
use super::signal::Followed;
use super::watch::{Explained, Moment};
use super::{Condition, Signal};

/// A value of a signal at which a ramp begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// This number.
    Number(f64),
    /// The signal's value at the start.
    Initial,
}

/// A fitness in [0, 1]. What a signal is at the end counts, where it is undefined then 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Score {
    /// 1 where the condition holds at the end, otherwise 0.
    Binary(Condition),
    /// The signal at the end.
    Share(Signal),
    /// The mean of the signal over all steps in which it is defined.
    Average(Signal),
    /// The signal at the end on the way from its worst value (0) to its best (1).
    Ramp {
        /// The signal.
        signal: Signal,
        /// Where the score is 0.
        worst: Bound,
        /// Where the score is 1.
        best: Bound,
    },
    /// The product.
    Product(Vec<Score>),
    /// The least.
    Min(Vec<Score>),
    /// The mean.
    Mean(Vec<Score>),
    /// The mean by weight; weights of which none is positive give 0.
    Weighted(Vec<(f64, Score)>),
}

/// A score as it is followed.
#[derive(Clone, Debug)]
pub(super) struct Scored {
    score: Score,
    node: Option<Node>,
    signal: Option<Followed>,
    pub(super) parts: Vec<Scored>,
}

impl Scored {
    pub(super) fn new(score: &Score) -> Self {
        let (mut node, mut signal, mut parts) = (None, None, Vec::new());
        match score {
            Score::Binary(condition) => node = Some(Node::new(condition)),
            Score::Share(of) | Score::Average(of) | Score::Ramp { signal: of, .. } => signal = Some(Followed::new(of)),
            Score::Product(all) | Score::Min(all) | Score::Mean(all) => parts = all.iter().map(Self::new).collect(),
            Score::Weighted(all) => parts = all.iter().map(|(_, score)| Self::new(score)).collect(),
        }
        Self { score: score.clone(), node, signal, parts }
    }

    pub(super) fn step(&mut self, moment: &Moment<'_>, course: u64) {
        if let Some(node) = &mut self.node {
            node.step(moment, course);
        }
        if let Some(signal) = &mut self.signal {
            signal.step(moment);
        }
        self.parts.iter_mut().for_each(|part| part.step(moment, course));
    }

    /// Its value so far, in [0, 1].
    pub(super) fn value(&self) -> f64 {
        let signal = self.signal.as_ref();
        let values = || self.parts.iter().map(Self::value);
        let value = match &self.score {
            Score::Binary(_) => f64::from(u8::from(self.node.as_ref().is_some_and(|node| node.holds))),
            Score::Share(_) => signal.and_then(|signal| signal.now).unwrap_or(0.0),
            Score::Average(_) => signal.and_then(Followed::mean).unwrap_or(0.0),
            Score::Ramp { worst, best, .. } => signal.and_then(|signal| ramp(signal, *worst, *best)).unwrap_or(0.0),
            Score::Product(_) => values().product(),
            Score::Min(_) => values().fold(1.0, f64::min),
            Score::Mean(all) => values().sum::<f64>() / all.len().max(1) as f64,
            Score::Weighted(all) => {
                let weight: f64 = all.iter().map(|(weight, _)| weight.max(0.0)).sum();
                let sum: f64 = all.iter().zip(values()).map(|((weight, _), value)| weight.max(0.0) * value).sum();
                if weight > 0.0 { sum / weight } else { 0.0 }
            }
        };
        value.clamp(0.0, 1.0)
    }

    /// Whether its value can no longer change.
    pub(super) fn settled(&self) -> bool {
        match &self.score {
            Score::Binary(_) => self.node.as_ref().is_some_and(|node| node.settled),
            Score::Share(_) | Score::Ramp { .. } => self.signal.as_ref().is_some_and(Followed::full),
            Score::Average(_) => false,
            Score::Product(_) | Score::Min(_) => {
                self.parts.iter().all(Self::settled)
                    || self.parts.iter().any(|part| part.settled() && part.value() == 0.0)
            }
            Score::Mean(_) | Score::Weighted(_) => self.parts.iter().all(Self::settled),
        }
    }

    pub(super) fn explain(&self, depth: usize, to: &mut Vec<Explained>) {
        let (text, value) = match &self.score {
            Score::Binary(_) => {
                if let Some(node) = &self.node {
                    node.explain(depth, to);
                }
                return;
            }
            Score::Share(_) | Score::Average(_) | Score::Ramp { .. } => {
                let signal = self.signal.as_ref();
                let name = signal.map(|signal| signal.signal().to_string()).unwrap_or_default();
                let kind = match &self.score {
                    Score::Share(_) => "share",
                    Score::Average(_) => "average",
                    _ => "ramp",
                };
                (format!("{kind} of {name}"), signal.and_then(|signal| signal.now))
            }
            Score::Product(_) => ("product of".into(), Some(self.value())),
            Score::Min(_) => ("least of".into(), Some(self.value())),
            Score::Mean(_) => ("mean of".into(), Some(self.value())),
            Score::Weighted(_) => ("weighted mean of".into(), Some(self.value())),
        };
        to.push(Explained { depth, text, first: None, holds: self.value() >= 1.0, value });
        self.parts.iter().for_each(|part| part.explain(depth + 1, to));
    }
}

/// The present value of a signal on its way from the worst to the best. Where the two are one, 1 if it is there.
fn ramp(signal: &Followed, worst: Bound, best: Bound) -> Option<f64> {
    let number = |bound| match bound {
        Bound::Number(number) => Some(number),
        Bound::Initial => signal.first,
    };
    let (now, worst, best) = (signal.now?, number(worst)?, number(best)?);
    Some(if worst == best { f64::from(u8::from(now == best)) } else { (now - worst) / (best - worst) })
}
