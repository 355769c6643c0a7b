//! Conditions on a group: comparisons of signals, put together, and in time.

use super::Signal;
use super::blocks::Run;
use super::signal::Followed;
use super::watch::{Explained, Moment};
use std::fmt;

/// How a signal is compared with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    More,
    /// `>=`
    AtLeast,
}

impl Comparison {
    /// As it is written.
    pub fn word(self) -> &'static str {
        match self {
            Self::Less => "<",
            Self::AtMost => "<=",
            Self::More => ">",
            Self::AtLeast => ">=",
        }
    }
    fn holds(self, value: f64, number: f64) -> bool {
        match self {
            Self::Less => value < number,
            Self::AtMost => value <= number,
            Self::More => value > number,
            Self::AtLeast => value >= number,
        }
    }
}

/// A condition on a group. Steps are counted from 0, from where the condition begins: at the start of the course, or in
/// [`Condition::Then`] where the first part came to hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// A signal compared with a number; it does not hold where the signal is undefined.
    Compare(Signal, Comparison, f64),
    /// All hold now.
    All(Vec<Condition>),
    /// One holds now.
    Any(Vec<Condition>),
    /// It does not hold now.
    Not(Box<Condition>),
    /// It has held in so many steps in a row; from then on this holds.
    Sustained(u64, Box<Condition>),
    /// It came to hold in one of the first so many steps; from then on this holds.
    Within(u64, Box<Condition>),
    /// It has held once.
    Eventually(Box<Condition>),
    /// It held in every step from one to another, both included; without a last step, in every step up to now.
    Always(u64, Option<u64>, Box<Condition>),
    /// The first held in every step until the second did, and the second did.
    Until(Box<Condition>, Box<Condition>),
    /// The first came to hold, and the second does, its steps counted from there.
    Then(Box<Condition>, Box<Condition>),
}

impl Condition {
    /// A signal of at least a number.
    pub fn at_least(signal: Signal, number: f64) -> Self {
        Self::Compare(signal, Comparison::AtLeast, number)
    }
    /// A signal of at most a number.
    pub fn at_most(signal: Signal, number: f64) -> Self {
        Self::Compare(signal, Comparison::AtMost, number)
    }
    /// Both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self::All(vec![self, other])
    }
    /// In so many steps in a row.
    #[must_use]
    pub fn sustained(self, steps: u64) -> Self {
        Self::Sustained(steps, Box::new(self))
    }
    /// In one of the first so many steps.
    #[must_use]
    pub fn within(self, steps: u64) -> Self {
        Self::Within(steps, Box::new(self))
    }
    /// And after it the other.
    #[must_use]
    pub fn then(self, next: Self) -> Self {
        Self::Then(Box::new(self), Box::new(next))
    }

    fn parts(&self) -> Vec<&Self> {
        match self {
            Self::Compare(..) => Vec::new(),
            Self::All(parts) | Self::Any(parts) => parts.iter().collect(),
            Self::Not(part)
            | Self::Sustained(_, part)
            | Self::Within(_, part)
            | Self::Eventually(part)
            | Self::Always(_, _, part) => vec![part],
            Self::Until(first, second) | Self::Then(first, second) => vec![first, second],
        }
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Compare(signal, comparison, number) => write!(out, "{signal} {} {number}", comparison.word()),
            Self::All(_) => out.write_str("all of"),
            Self::Any(_) => out.write_str("any of"),
            Self::Not(_) => out.write_str("not"),
            Self::Sustained(steps, _) => write!(out, "sustained for {steps} steps"),
            Self::Within(steps, _) => write!(out, "within {steps} steps"),
            Self::Eventually(_) => out.write_str("eventually"),
            Self::Always(from, Some(to), _) => write!(out, "always from step {from} to {to}"),
            Self::Always(from, None, _) => write!(out, "always from step {from}"),
            Self::Until(..) => out.write_str("the first until the second"),
            Self::Then(..) => out.write_str("the first, then the second"),
        }
    }
}

/// A condition as it is followed.
#[derive(Clone, Debug)]
pub(super) struct Node {
    condition: Condition,
    parts: Vec<Node>,
    signal: Option<Followed>,
    run: Run,
    steps: u64,
    /// Whether it holds now.
    pub(super) holds: bool,
    /// Whether that can no longer change.
    pub(super) settled: bool,
    /// The first step of the course at which it held.
    first: Option<u64>,
    /// Whether it was broken for good, or has begun its second part.
    turned: bool,
}

impl Node {
    pub(super) fn new(condition: &Condition) -> Self {
        let signal = match condition {
            Condition::Compare(signal, ..) => Some(Followed::new(signal)),
            _ => None,
        };
        Self {
            condition: condition.clone(),
            parts: condition.parts().into_iter().map(Self::new).collect(),
            signal,
            run: Run::default(),
            steps: 0,
            holds: false,
            settled: false,
            first: None,
            turned: false,
        }
    }

    /// Takes the next moment, which is step `course` of the whole course.
    pub(super) fn step(&mut self, moment: &Moment<'_>, course: u64) {
        let now = self.steps;
        self.steps += 1;
        if !self.settled {
            self.update(moment, course, now);
        }
        if self.holds && self.first.is_none() {
            self.first = Some(course);
        }
    }

    fn update(&mut self, moment: &Moment<'_>, course: u64, now: u64) {
        if let Condition::Then(..) = self.condition {
            self.update_then(moment, course);
            return;
        }
        for part in &mut self.parts {
            part.step(moment, course);
        }
        let held = |k: usize| self.parts.get(k).is_some_and(|part| part.holds);
        let settled = |k: usize| self.parts.get(k).is_some_and(|part| part.settled);
        match &self.condition {
            Condition::Compare(_, comparison, number) => {
                let value = self.signal.as_mut().and_then(|signal| {
                    signal.step(moment);
                    signal.now
                });
                self.holds = value.is_some_and(|value| comparison.holds(value, *number));
            }
            Condition::All(_) => {
                self.holds = self.parts.iter().all(|part| part.holds);
                self.settled = self.parts.iter().all(|part| part.settled)
                    || self.parts.iter().any(|part| part.settled && !part.holds);
            }
            Condition::Any(_) => {
                self.holds = self.parts.iter().any(|part| part.holds);
                self.settled = self.parts.iter().all(|part| part.settled)
                    || self.parts.iter().any(|part| part.settled && part.holds);
            }
            Condition::Not(_) => (self.holds, self.settled) = (!held(0), settled(0)),
            Condition::Sustained(steps, _) => {
                let (holds, never) = (held(0), settled(0) && !held(0));
                self.holds = self.run.sustained(holds, (*steps).max(1));
                self.settled = self.holds || never;
            }
            Condition::Within(steps, _) => {
                self.holds = held(0) && now < *steps;
                let part = &self.parts[0];
                self.settled = self.holds || part.settled || now + part.soonest() >= *steps;
            }
            Condition::Eventually(_) => {
                self.holds = held(0);
                self.settled = held(0) || settled(0);
            }
            Condition::Always(from, to, _) => {
                self.turned |= now >= *from && to.is_none_or(|to| now <= to) && !held(0);
                let complete = to.is_some_and(|to| now >= to);
                self.holds = !self.turned && (complete || to.is_none());
                self.settled = self.turned || complete;
            }
            Condition::Until(..) => {
                self.holds = held(1);
                self.settled = held(1) || !held(0);
            }
            Condition::Then(..) => {}
        }
    }

    /// The second part begins with the step in which the first comes to hold.
    fn update_then(&mut self, moment: &Moment<'_>, course: u64) {
        let [first, second] = self.parts.as_mut_slice() else { return };
        if !self.turned {
            first.step(moment, course);
            self.turned = first.holds;
            self.settled = first.settled && !first.holds;
        }
        if self.turned {
            second.step(moment, course);
            (self.holds, self.settled) = (second.holds, second.settled);
        }
    }

    /// How many further steps it takes at least until it holds, 1 or more.
    fn soonest(&self) -> u64 {
        let parts = self.parts.iter().map(Self::soonest);
        match &self.condition {
            Condition::Compare(..) | Condition::Not(_) => 1,
            Condition::All(_) => parts.max().unwrap_or(1),
            Condition::Any(_) => parts.min().unwrap_or(1),
            Condition::Sustained(steps, _) => steps.saturating_sub(self.run.length).max(1),
            Condition::Within(..) | Condition::Eventually(_) => parts.max().unwrap_or(1),
            Condition::Always(_, to, _) => to.map_or(1, |to| (to + 1).saturating_sub(self.steps).max(1)),
            Condition::Until(..) => self.parts[1].soonest(),
            Condition::Then(..) if self.turned => self.parts[1].soonest(),
            Condition::Then(..) => self.parts[0].soonest() + self.parts[1].soonest() - 1,
        }
    }

    /// Adds what there is to say of it and its parts.
    pub(super) fn explain(&self, depth: usize, to: &mut Vec<Explained>) {
        let value = self.signal.as_ref().and_then(|signal| signal.now);
        let text = self.condition.to_string();
        to.push(Explained { depth, text, first: self.first, holds: self.holds, value });
        for part in &self.parts {
            part.explain(depth + 1, to);
        }
    }
}
