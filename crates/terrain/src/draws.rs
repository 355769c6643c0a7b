//! Random numbers of a generated environment: each is keyed by the seed, the attempt, the derivation step, and the name
//! of what is drawn, never by a place in a list.

use core::cell::Cell;

use crate::expression::Names;
use crate::{Expression, TerrainError};
use space::random::{Purpose, child_seed, normal, uniform};

/// Kind of the child key of an attempt at a candidate.
const ATTEMPT: u32 = 0x7465_7272;

/// FNV-1a over bytes: keys of names, and fingerprints of geometry.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fnv(pub(crate) u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    pub(crate) fn take(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Numbers that stand for draws, in the order in which they are drawn.
#[derive(Debug)]
pub struct Decisions<'a> {
    numbers: &'a [f64],
    taken: Cell<usize>,
}

impl<'a> Decisions<'a> {
    /// Numbers of [0, 1].
    pub fn new(numbers: &'a [f64]) -> Self {
        Self { numbers, taken: Cell::new(0) }
    }
    /// The next one, below 1; `None` where all are taken.
    fn next(&self) -> Option<f64> {
        let number = self.numbers.get(self.taken.get())?;
        self.taken.set(self.taken.get() + 1);
        Some(number.clamp(0.0, 1.0 - f64::EPSILON))
    }
}

/// The draws of one step of one attempt.
#[derive(Clone, Copy, Debug)]
pub struct Draws<'a> {
    key: u64,
    step: u64,
    decided: Option<&'a Decisions<'a>>,
}

impl<'a> Draws<'a> {
    /// The draws of a step (0: before the first) of an attempt under a seed.
    pub fn new(seed: u64, attempt: u64, step: u64) -> Self {
        Self { key: child_seed(seed, ATTEMPT, attempt, 0), step, decided: None }
    }
    /// The same with numbers in place of the first draws.
    #[must_use]
    pub fn decided(self, by: &'a Decisions<'a>) -> Self {
        Self { decided: Some(by), ..self }
    }
    /// The draws of another step of the same attempt.
    #[must_use]
    pub fn at(self, step: u64) -> Self {
        Self { step, ..self }
    }
    /// Uniform in [0, 1), for the quantity of this name; `number` tells several of one name apart.
    pub fn uniform(&self, name: &str, number: u32) -> f64 {
        if let Some(decided) = self.decided.and_then(Decisions::next) {
            return decided;
        }
        let mut hash = Fnv::default();
        hash.take(name.as_bytes());
        hash.take(&number.to_le_bytes());
        let folded = (hash.0 ^ (hash.0 >> 32)) as u32;
        uniform(self.key, Purpose::Obstacles, self.step, folded)
    }
    /// A whole number below `count` (0 where that is 0), each as likely as any other. Of one there is nothing to draw.
    pub fn below(&self, name: &str, count: usize) -> usize {
        if count <= 1 {
            return 0;
        }
        ((self.uniform(name, 0) * count as f64) as usize).min(count.saturating_sub(1))
    }
    /// An index by weight; `None` where no weight is above 0. Of one there is nothing to draw.
    pub fn weighted(&self, name: &str, weights: &[f64]) -> Option<usize> {
        if let [only] = weights {
            return (*only > 0.0).then_some(0);
        }
        let total: f64 = weights.iter().sum();
        let mut left = self.uniform(name, 0) * total;
        let mut last = None;
        for (k, &weight) in weights.iter().enumerate().filter(|&(_, &weight)| weight > 0.0) {
            if left < weight {
                return Some(k);
            }
            left -= weight;
            last = Some(k);
        }
        last
    }
}

/// How a variable is distributed.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// Each of these numbers with equal chance.
    Choice(Vec<f64>),
    /// Uniform between two numbers.
    Uniform(f64, f64),
    /// Normal, by mean and standard deviation.
    Normal(f64, f64),
    /// No chance: what the expression gives.
    Value(Expression),
}

impl Distribution {
    /// The number drawn for the variable `name`.
    ///
    /// # Errors
    /// Where an expression names what is not there, or divides by zero.
    pub fn draw(&self, draws: &Draws, name: &str, names: &dyn Names) -> Result<f64, TerrainError> {
        Ok(match self {
            Self::Choice(values) => values.get(draws.below(name, values.len())).copied().unwrap_or(0.0),
            Self::Uniform(low, high) => low + (high - low) * draws.uniform(name, 0),
            Self::Normal(mean, deviation) => mean + deviation * normal(draws.uniform(name, 0), draws.uniform(name, 1)),
            Self::Value(expression) => expression.value(names)?,
        })
    }
    /// Refuses a distribution that nothing can be drawn from.
    ///
    /// # Errors
    /// An empty choice, numbers that are not finite, bounds in the wrong order, a negative deviation.
    pub fn check(&self, name: &str) -> Result<(), TerrainError> {
        let finite = |values: &[f64]| match values.iter().find(|value| !value.is_finite()) {
            Some(&bad) => Err(TerrainError::range(name, "finite numbers", bad)),
            None => Ok(()),
        };
        match self {
            Self::Choice(values) if values.is_empty() => {
                Err(TerrainError::Grammar(format!("{name}: a choice needs at least one number")))
            }
            Self::Choice(values) => finite(values),
            Self::Uniform(low, high) => {
                finite(&[*low, *high])?;
                if low > high {
                    return Err(TerrainError::range(name, format!("an upper bound of at least {low}"), *high));
                }
                Ok(())
            }
            Self::Normal(mean, deviation) => {
                finite(&[*mean, *deviation])?;
                if *deviation < 0.0 {
                    return Err(TerrainError::range(name, "a deviation of 0 or more", *deviation));
                }
                Ok(())
            }
            Self::Value(_) => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_keyed_by_name_step_and_attempt() {
        let draws = Draws::new(7, 0, 1);
        assert_eq!(draws.uniform("a", 0), Draws::new(7, 0, 0).at(1).uniform("a", 0));
        let others = [
            draws.uniform("b", 0),
            draws.uniform("a", 1),
            draws.at(2).uniform("a", 0),
            Draws::new(7, 1, 1).uniform("a", 0),
        ];
        assert!(others.iter().all(|&other| other != draws.uniform("a", 0)));
    }

    #[test]
    fn choices_keep_their_chances() {
        let mut counts = [0; 3];
        for attempt in 0..6000 {
            let draws = Draws::new(1, attempt, 1);
            assert!(draws.below("k", 0) == 0 && draws.below("k", 3) < 3);
            counts[draws.weighted("w", &[1.0, 0.0, 3.0]).unwrap_or(1)] += 1;
        }
        assert_eq!(counts[1], 0);
        assert!((counts[0] - 1500i32).abs() < 150, "{counts:?}");
        assert_eq!(Draws::new(1, 0, 0).weighted("w", &[]), None);
        assert_eq!(Draws::new(1, 0, 0).weighted("w", &[0.0]), None);
    }
}
