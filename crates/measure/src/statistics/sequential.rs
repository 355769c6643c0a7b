//! When to stop trying: rules for shares of successes that look after each trial.

use super::{StatisticsError, check, wilson};

/// What a rule says after some trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decision {
    /// Not yet: another trial is needed.
    Continue,
    /// The share is the higher one.
    Accept,
    /// The share is the lower one.
    Reject,
    /// The last trial was made without a decision.
    Undecided,
}

/// Wald's sequential test of a share: `lower` against `higher` (1945, Ann. Math. Stat. 16:117).
///
/// After each trial the log likelihood ratio is compared with ln((1 - beta) / alpha), accept, and ln(beta / (1 - alpha)),
/// reject. Without a last trial the probabilities of the two errors are at most about alpha and beta; what they are with
/// one, [`SequentialTest::behaviour`] tells exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SequentialTest {
    lower: f64,
    higher: f64,
    accept: f64,
    reject: f64,
    most: u32,
}

/// What a rule does where the true share of successes is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Behaviour {
    /// Probability of [`Decision::Accept`].
    pub accept: f64,
    /// Probability of [`Decision::Reject`].
    pub reject: f64,
    /// Probability of [`Decision::Undecided`].
    pub undecided: f64,
    /// Expected number of trials.
    pub trials: f64,
}

impl SequentialTest {
    /// The test of `lower` against `higher` with the errors `alpha` (to accept the lower share) and `beta` (to reject the
    /// higher one), and at most `most` trials.
    ///
    /// # Errors
    /// Where a share or an error is not between 0 and 1, the shares are not in order, the errors sum to 1 or more, or
    /// there is no trial, or more than 100,000.
    pub fn new(lower: f64, higher: f64, alpha: f64, beta: f64, most: u32) -> Result<Self, StatisticsError> {
        check::between_0_and_1("the lower share", lower)?;
        check::between_0_and_1("the higher share", higher)?;
        check::in_range("the higher share", "more than the lower one", higher, higher > lower)?;
        check::between_0_and_1("alpha", alpha)?;
        check::between_0_and_1("beta", beta)?;
        check::in_range("alpha + beta", "less than 1", alpha + beta, alpha + beta < 1.0)?;
        check::in_range(
            "the largest number of trials",
            "from 1 to 100000",
            most.into(),
            (1..=100_000).contains(&most),
        )?;
        let (accept, reject) = (libm::log((1.0 - beta) / alpha), libm::log(beta / (1.0 - alpha)));
        Ok(Self { lower, higher, accept, reject, most })
    }
    /// The log likelihood ratio of the higher against the lower share.
    pub fn evidence(&self, successes: u32, trials: u32) -> f64 {
        let failures = trials.saturating_sub(successes);
        f64::from(successes) * libm::log(self.higher / self.lower)
            + f64::from(failures) * libm::log((1.0 - self.higher) / (1.0 - self.lower))
    }
    /// What to do after so many successes in so many trials.
    pub fn decide(&self, successes: u32, trials: u32) -> Decision {
        let evidence = self.evidence(successes, trials);
        if evidence >= self.accept {
            Decision::Accept
        } else if evidence <= self.reject {
            Decision::Reject
        } else if trials >= self.most {
            Decision::Undecided
        } else {
            Decision::Continue
        }
    }
    /// What the test does where the true share is this, by adding up all courses it can take.
    ///
    /// # Errors
    /// Where the share is not in 0..=1.
    pub fn behaviour(&self, share: f64) -> Result<Behaviour, StatisticsError> {
        check::in_range("the share", "from 0 to 1", share, (0.0..=1.0).contains(&share))?;
        let mut behaviour = Behaviour { accept: 0.0, reject: 0.0, undecided: 0.0, trials: 0.0 };
        // probabilities of the successes so far, of the courses that go on
        let mut going = vec![1.0];
        for trials in 1..=self.most {
            behaviour.trials += going.iter().sum::<f64>();
            let mut next = vec![0.0; going.len() + 1];
            for (successes, probability) in going.iter().enumerate() {
                next[successes] += probability * (1.0 - share);
                next[successes + 1] += probability * share;
            }
            for (successes, probability) in (0..).zip(&mut next) {
                match self.decide(successes, trials) {
                    Decision::Continue => continue,
                    Decision::Accept => behaviour.accept += *probability,
                    Decision::Reject => behaviour.reject += *probability,
                    Decision::Undecided => behaviour.undecided += *probability,
                }
                *probability = 0.0;
            }
            going = next;
            if going.iter().all(|&probability| probability == 0.0) {
                break;
            }
        }
        Ok(behaviour)
    }
}

/// The number of trials after which Wilson's interval of any share is no wider than this: trials that are planned
/// for a share to be known, not for a decision.
///
/// # Errors
/// Where the confidence or the width is not between 0 and 1.
pub fn trials_for_width(width: f64, confidence: f64) -> Result<u64, StatisticsError> {
    check::between_0_and_1("the confidence", confidence)?;
    check::in_range("the width", "more than 1e-6 and less than 1", width, width > 1e-6 && width < 1.0)?;
    // the interval is widest at one half: z / sqrt(n + z^2)
    let z = -super::distribution::normal_quantile(0.5 * (1.0 - confidence));
    Ok(libm::ceil(z * z * (1.0 / (width * width) - 1.0)).max(1.0) as u64)
}

/// Whether the share is known well enough: whether its Wilson interval is no wider than `width`.
///
/// Looking after each trial does not spoil the interval much, since its width says little of where it lies.
///
/// # Errors
/// As [`wilson`].
pub fn is_narrow(successes: u64, trials: u64, width: f64, confidence: f64) -> Result<bool, StatisticsError> {
    let interval = wilson(successes, trials, confidence)?;
    Ok(interval.high - interval.low <= width)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn usual() -> SequentialTest {
        SequentialTest::new(0.5, 0.8, 0.05, 0.05, 40).unwrap()
    }

    #[test]
    fn all_of_one_kind() {
        let first = |successes: fn(u32) -> u32| {
            (1..=40).map(|n| (n, usual().decide(successes(n), n))).find(|(_, decision)| *decision != Decision::Continue)
        };
        assert_eq!(first(|n| n), Some((7, Decision::Accept)));
        assert_eq!(first(|_| 0), Some((4, Decision::Reject)));
        // two thirds between the shares stay open to the end
        assert_eq!(first(|n| (2 * n).div_ceil(3)), Some((40, Decision::Undecided)));
    }

    #[test]
    fn errors_are_as_stated() {
        let unending = SequentialTest::new(0.5, 0.8, 0.05, 0.05, 5_000).unwrap();
        let (low, high) = (unending.behaviour(0.5).unwrap(), unending.behaviour(0.8).unwrap());
        assert!(low.accept < 0.05 && low.accept > 0.02 && high.reject < 0.05 && high.reject > 0.02);
        assert!((low.accept + low.reject - 1.0).abs() < 1e-12);
        let cut = usual().behaviour(0.5).unwrap();
        assert!((cut.accept + cut.reject + cut.undecided - 1.0).abs() < 1e-12 && cut.accept < 0.05);
        assert!(cut.trials < 20.0 && cut.undecided < 0.1);
        assert_eq!(usual().behaviour(1.0).unwrap().trials, 7.0);
        // the broken twin that looks after each trial at a fixed test errs far more often than it says
        let twin = SequentialTest { accept: libm::log(0.95 / 0.5), ..unending };
        assert!(twin.behaviour(0.5).unwrap().accept > 0.2);
    }

    #[test]
    fn widths() {
        let trials = trials_for_width(0.1, 0.95).unwrap();
        assert!((380..=381).contains(&trials));
        assert_eq!(is_narrow(trials / 2, trials, 0.1, 0.95), Ok(true));
        assert_eq!(is_narrow(trials / 4, trials / 2, 0.1, 0.95), Ok(false));
        assert!(trials_for_width(0.0, 0.95).is_err() && is_narrow(1, 0, 0.1, 0.95).is_err());
    }

    #[test]
    fn bad_input() {
        let error = |lower, higher, alpha, most| SequentialTest::new(lower, higher, alpha, 0.05, most).is_err();
        assert!(error(0.8, 0.5, 0.05, 40) && error(0.5, 1.0, 0.05, 40) && error(0.5, 0.8, 0.0, 40));
        assert!(error(0.5, 0.8, 0.96, 40) && error(0.5, 0.8, 0.05, 0) && error(0.5, f64::NAN, 0.05, 40));
        assert!(usual().behaviour(1.1).is_err());
    }
}
