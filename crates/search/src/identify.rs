//! Which of several hypotheses is true: questions with a few possible answers, how much an answer is expected to tell, and what
//! is believed after it.
//!
//! A [`Question`] holds how probable each answer is under each hypothesis. Its expected gain is the mutual information of
//! hypothesis and answer, in bits (D. V. Lindley, On a measure of the information provided by an experiment, Annals of
//! Mathematical Statistics 27, 1956); asking the question of greatest gain again and again, each time with what is believed by
//! then, is the greedy sequence. Beliefs follow Bayes' rule.

use crate::error::{SearchError, counted, hold};
use space::random::{Purpose, uniform};
use std::collections::BTreeMap;

/// Times that observations are drawn again for an interval.
const DRAWINGS: usize = 400;
/// Counts of answers that are enumerated for several trials, at most.
const ENUMERATED: f64 = 20_000.0;

/// How probable each answer is under each hypothesis.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// Probabilities `[hypotheses][answers]`; those of a hypothesis sum to 1.
    table: Vec<Vec<f64>>,
}

impl Question {
    /// A question by its probabilities, `[hypotheses][answers]`.
    ///
    /// # Errors
    /// No hypotheses, no answers, rows of different lengths, and rows that are no probabilities.
    pub fn new(table: Vec<Vec<f64>>) -> Result<Self, SearchError> {
        let answers = table.first().map_or(0, Vec::len);
        hold(answers > 0, "a question", "at least one hypothesis and one answer")?;
        for row in &table {
            counted("probabilities of a hypothesis", row.len(), answers)?;
            let sum: f64 = row.iter().sum();
            hold(
                row.iter().all(|p| *p >= 0.0) && (sum - 1.0).abs() < 1e-9,
                "probabilities of a hypothesis",
                "none below 0, with the sum 1",
            )?;
        }
        Ok(Self { table })
    }
    /// A question as far as it is known from counts of answers, `[hypotheses][answers]`. Half an answer is added to each (the mean
    /// under the prior of Jeffreys), so that no answer is held to be impossible because it was not seen.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_counts(counts: &[Vec<u64>]) -> Result<Self, SearchError> {
        let row = |counts: &Vec<u64>| {
            let all = counts.iter().sum::<u64>() as f64 + 0.5 * counts.len() as f64;
            counts.iter().map(|count| (*count as f64 + 0.5) / all).collect()
        };
        Self::new(counts.iter().map(row).collect())
    }
    /// Number of possible answers.
    pub fn answers(&self) -> usize {
        self.table.first().map_or(0, Vec::len)
    }
    /// How probable an answer is under what is believed.
    pub fn probability(&self, belief: &[f64], answer: usize) -> f64 {
        belief.iter().zip(&self.table).map(|(b, row)| b * row.get(answer).copied().unwrap_or(0.0)).sum()
    }
    /// What is believed after an answer. One that is impossible under every hypothesis tells nothing.
    pub fn after(&self, belief: &[f64], answer: usize) -> Vec<f64> {
        let all = self.probability(belief, answer);
        if all > 0.0 {
            let one = |(b, row): (&f64, &Vec<f64>)| b * row.get(answer).copied().unwrap_or(0.0) / all;
            belief.iter().zip(&self.table).map(one).collect()
        } else {
            belief.to_vec()
        }
    }
    /// How much one answer is expected to tell, in bits.
    pub fn gain(&self, belief: &[f64]) -> f64 {
        gain(belief, &self.table)
    }
    /// How much the answers of so many trials are expected to tell together, in bits; none where too many counts of answers are
    /// possible to go through all.
    pub fn gain_of(&self, belief: &[f64], trials: usize) -> Option<f64> {
        let answers = self.answers();
        // counts of so many answers: trials + answers - 1 over answers - 1
        let count = (1..answers).fold(1.0, |all, k| all * (trials + k) as f64 / k as f64);
        if count > ENUMERATED {
            return None;
        }
        let mut factorial = vec![0.0; trials + 1];
        for k in 1..=trials {
            factorial[k] = factorial[k - 1] + libm::log(k as f64);
        }
        let logarithms: Vec<Vec<f64>> =
            self.table.iter().map(|row| row.iter().map(|p| libm::log(*p)).collect()).collect();
        let mut left = 0.0;
        let mut counts = vec![0; answers];
        each_count(&mut counts, 0, trials, &mut |counts| {
            let ways = factorial[trials] - counts.iter().map(|count| factorial[*count]).sum::<f64>();
            let of = |row: &Vec<f64>| {
                // an answer that was not given may be impossible
                let given = counts.iter().zip(row).filter(|(count, _)| **count > 0);
                libm::exp(ways + given.map(|(count, log)| *count as f64 * log).sum::<f64>())
            };
            let joint: Vec<f64> = belief.iter().zip(&logarithms).map(|(b, row)| b * of(row)).collect();
            let all: f64 = joint.iter().sum();
            if all > 0.0 {
                let after: Vec<f64> = joint.iter().map(|p| p / all).collect();
                left += all * entropy(&after);
            }
        });
        Some((entropy(belief) - left).max(0.0))
    }
}

/// Shows each way to share `left` among the counts from `place` on.
fn each_count(counts: &mut Vec<usize>, place: usize, left: usize, see: &mut dyn FnMut(&[usize])) {
    if place + 1 == counts.len() {
        counts[place] = left;
        see(counts);
        return;
    }
    for own in 0..=left {
        counts[place] = own;
        each_count(counts, place + 1, left - own, see);
    }
}

/// Uncertainty of a distribution, in bits.
pub fn entropy(distribution: &[f64]) -> f64 {
    distribution.iter().filter(|p| **p > 0.0).map(|p| -p * libm::log2(*p)).sum()
}

/// Mutual information of hypothesis and answer, in bits.
fn gain(belief: &[f64], table: &[Vec<f64>]) -> f64 {
    let answers = table.first().map_or(0, Vec::len);
    let mixed: Vec<f64> =
        (0..answers).map(|answer| belief.iter().zip(table).map(|(b, row)| b * row[answer]).sum()).collect();
    let noise: f64 = belief.iter().zip(table).map(|(b, row)| b * entropy(row)).sum();
    (entropy(&mixed) - noise).max(0.0)
}

/// The question whose answer is expected to tell most; of equals the first.
pub fn most_telling(questions: &[Question], belief: &[f64]) -> usize {
    let gains = questions.iter().map(|question| question.gain(belief)).enumerate();
    gains.reduce(|best, other| if other.1 > best.1 { other } else { best }).map_or(0, |(place, _)| place)
}

/// An expected gain as estimated, in bits, with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The gain.
    pub gain: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The expected gain of a question from observed answers, `[trials][hypotheses]`; none where a trial gave no answer. The answers
/// of one trial may depend on each other: trials are left out and drawn again whole.
///
/// The gain of observed shares is too great on average; the jackknife takes away what is of the order of 1 / trials. The
/// interval is that of 400 drawings of the trials with replacement, moved by as much. It has no value where a hypothesis was
/// answered in fewer than two trials.
pub fn estimated(belief: &[f64], observed: &[Vec<Option<usize>>], answers: usize, seed: u64) -> Option<Estimate> {
    let mut kinds: BTreeMap<&[Option<usize>], f64> = BTreeMap::new();
    for trial in observed {
        *kinds.entry(trial).or_default() += 1.0;
    }
    let kinds: Vec<(&[Option<usize>], f64)> = kinds.into_iter().collect();
    let place = |trial: &Vec<Option<usize>>| kinds.iter().position(|(kind, _)| *kind == trial.as_slice()).unwrap_or(0);
    let places: Vec<usize> = observed.iter().map(place).collect();
    let counted = |weights: &[f64]| {
        let mut counts = vec![vec![0.0; answers]; belief.len()];
        for ((kind, _), weight) in kinds.iter().zip(weights) {
            for (row, answer) in counts.iter_mut().zip(*kind) {
                if let Some(answer) = answer {
                    row[*answer] += weight;
                }
            }
        }
        counts
    };
    let of_counts = |counts: &[Vec<f64>]| {
        let share = |row: &Vec<f64>| {
            let all: f64 = row.iter().sum();
            (all > 0.0).then(|| row.iter().map(|count| count / all).collect::<Vec<f64>>())
        };
        let table: Option<Vec<Vec<f64>>> = counts.iter().map(share).collect();
        table.map(|table| gain(belief, &table))
    };
    let jackknifed = |weights: &[f64]| {
        let mut counts = counted(weights);
        let all: f64 = weights.iter().sum();
        let plain = of_counts(&counts)?;
        let mut without = 0.0;
        for ((kind, _), weight) in kinds.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
            let change = |counts: &mut Vec<Vec<f64>>, by: f64| {
                for (row, answer) in counts.iter_mut().zip(*kind) {
                    if let Some(answer) = answer {
                        row[*answer] += by;
                    }
                }
            };
            change(&mut counts, -1.0);
            without += weight * of_counts(&counts)?;
            change(&mut counts, 1.0);
        }
        Some((plain, all * plain - (all - 1.0) * without / all))
    };
    let weights: Vec<f64> = kinds.iter().map(|(_, count)| *count).collect();
    let (plain, corrected) = jackknifed(&weights)?;
    let trials = places.len();
    let drawing = |k: usize| {
        let mut weights = vec![0.0; kinds.len()];
        for j in 0..trials {
            let drawn = uniform(seed, Purpose::Resampling, k as u64, j as u32) * trials as f64;
            weights[places[(drawn as usize).min(trials - 1)]] += 1.0;
        }
        jackknifed(&weights).map(|(_, corrected)| corrected)
    };
    let mut drawn: Vec<f64> = (0..DRAWINGS).filter_map(drawing).collect();
    drawn.sort_by(f64::total_cmp);
    let at = |share: f64| drawn.get(((drawn.len() as f64 - 1.0) * share).round() as usize).copied();
    let within = |gain: f64| gain.clamp(0.0, entropy(belief));
    // the drawings scatter about the gain of the observed shares as the estimate does about the gain that is asked for
    let moved = |end: Option<f64>| within(end.map_or(corrected, |end| corrected + end - plain));
    Some(Estimate { gain: within(corrected), low: moved(at(0.025)), high: moved(at(0.975)) })
}

/// A trial of an identification.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// The question.
    pub question: usize,
    /// Its answer; none where the trial gave none.
    pub answer: Option<usize>,
    /// What is believed afterwards, `[hypotheses]`.
    pub belief: Vec<f64>,
}

/// An identification: question after question, until one hypothesis is believed in enough.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Course {
    /// Its trials.
    pub trials: Vec<Asked>,
    /// The hypothesis that was believed in enough at last; none where that never came.
    pub named: Option<usize>,
}

/// When an identification ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// Belief in one hypothesis that is enough.
    pub threshold: f64,
    /// Most trials.
    pub most: usize,
}

/// Identifies the hypothesis behind answers. `choose` says which question is asked, by the number of trials made and what is
/// believed; `answer` gives the answer to the question, which was asked so many times before. None where it does not know it.
pub fn identify(
    questions: &[Question],
    prior: &[f64],
    ending: Ending,
    mut choose: impl FnMut(usize, &[f64]) -> usize,
    mut answer: impl FnMut(usize, usize) -> Option<Option<usize>>,
) -> Option<Course> {
    let mut course = Course::default();
    let mut belief = prior.to_vec();
    let mut asked = vec![0; questions.len()];
    let enough = |belief: &[f64]| belief.iter().position(|own| *own >= ending.threshold);
    course.named = enough(&belief);
    while course.named.is_none() && course.trials.len() < ending.most && !questions.is_empty() {
        let question = choose(course.trials.len(), &belief);
        let given = answer(question, asked[question])?;
        asked[question] += 1;
        if let Some(given) = given {
            belief = questions[question].after(&belief, given);
        }
        course.trials.push(Asked { question, answer: given, belief: belief.clone() });
        course.named = enough(&belief);
    }
    Some(course)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary(p: f64, q: f64) -> Question {
        Question::new(vec![vec![p, 1.0 - p], vec![q, 1.0 - q]]).unwrap()
    }

    /// Uncertainty of a yes with probability `p`.
    fn h(p: f64) -> f64 {
        entropy(&[p, 1.0 - p])
    }

    #[test]
    fn the_gain_is_the_mutual_information() {
        let even = [0.5, 0.5];
        for (p, q) in [(0.2, 0.7), (0.0, 0.5), (0.9, 0.1)] {
            let known = h(0.5 * (p + q)) - 0.5 * (h(p) + h(q));
            assert!((binary(p, q).gain(&even) - known).abs() < 1e-12);
        }
        // the Z-channel of one half: log2(5) - 2 at a prior of 2/5
        assert!((binary(0.0, 0.5).gain(&[0.6, 0.4]) - (5f64.log2() - 2.0)).abs() < 1e-12);
        assert_eq!(binary(0.0, 1.0).gain(&even), 1.0);
        assert_eq!(binary(0.3, 0.3).gain(&even), 0.0);
        assert_eq!(binary(0.1, 0.9).gain(&[1.0, 0.0]), 0.0, "who knows learns nothing");
        let three = Question::new(vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]]).unwrap();
        assert!((three.gain(&[1.0 / 3.0; 3]) - 3f64.log2()).abs() < 1e-12);
    }

    #[test]
    fn several_trials_tell_more_but_not_as_often_the_same() {
        let even = [0.5, 0.5];
        let question = binary(0.3, 0.6);
        let of = |trials| question.gain_of(&even, trials).unwrap();
        assert_eq!(of(0), 0.0);
        assert!((of(1) - question.gain(&even)).abs() < 1e-12);
        for trials in 2..30 {
            assert!(of(trials) > of(trials - 1) && of(trials) < trials as f64 * of(1) && of(trials) <= 1.0);
        }
        // never seen under the first, with one half under the second: left uncertain only where it is never seen
        let left = |n: i32| (1.0 + 0.5f64.powi(n)) / 2.0;
        let known = 1.0 - left(3) * h(0.5 / left(3));
        assert!((binary(0.0, 0.5).gain_of(&even, 3).unwrap() - known).abs() < 1e-12);
        assert_eq!(binary(0.4, 0.4).gain_of(&even, 9), Some(0.0));
        let wide = Question::new(vec![vec![0.125; 8]; 2]).unwrap();
        assert_eq!(wide.gain_of(&even, 50), None);
    }

    #[test]
    fn beliefs_follow_bayes() {
        let question = binary(0.2, 0.6);
        let after = question.after(&[0.5, 0.5], 0);
        assert!((after[0] - 0.25).abs() < 1e-15 && (after[1] - 0.75).abs() < 1e-15);
        assert_eq!(binary(0.0, 0.0).after(&[0.5, 0.5], 0), [0.5, 0.5], "the impossible tells nothing");
        let counts = Question::of_counts(&[vec![3, 0], vec![0, 0]]).unwrap();
        assert_eq!(counts, Question::new(vec![vec![0.875, 0.125], vec![0.5, 0.5]]).unwrap());
        assert_eq!(most_telling(&[binary(0.5, 0.5), binary(0.1, 0.9), binary(0.1, 0.9)], &[0.5, 0.5]), 1);
    }

    #[test]
    fn what_is_no_question_is_refused() {
        for table in [vec![], vec![vec![]], vec![vec![1.0], vec![0.5, 0.5]], vec![vec![0.7, 0.7]], vec![vec![f64::NAN]]]
        {
            assert!(Question::new(table.clone()).is_err(), "{table:?}");
        }
    }

    /// Answers by probabilities, independent of each other.
    fn drawn(p: &[f64], trials: usize, seed: u64) -> Vec<Vec<Option<usize>>> {
        let one = |t: usize, k: usize| usize::from(uniform(seed, Purpose::Search, t as u64, k as u32) >= p[k]);
        (0..trials).map(|t| (0..p.len()).map(|k| Some(one(t, k))).collect()).collect()
    }

    #[test]
    fn estimates_scatter_about_the_gain() {
        let even = [0.5, 0.5];
        let known = binary(0.3, 0.6).gain(&even);
        let estimates: Vec<Estimate> =
            (0..200).map(|seed| estimated(&even, &drawn(&[0.3, 0.6], 100, seed), 2, seed).unwrap()).collect();
        let mean = estimates.iter().map(|one| one.gain).sum::<f64>() / 200.0;
        assert!((mean - known).abs() < 0.005, "{mean}, {known}");
        let within = estimates.iter().filter(|one| one.low <= known && known <= one.high).count();
        assert!((180..=200).contains(&within), "{within} of 200 intervals hold the gain");
        // hypotheses alike, but observed apart: nothing is told within the interval
        let alike = (0..100).filter(|seed| estimated(&even, &drawn(&[0.4, 0.4], 100, *seed), 2, 1).unwrap().low > 0.0);
        assert!(alike.count() <= 8);
    }

    #[test]
    fn who_answers_alike_tells_nothing_exactly() {
        let twins: Vec<Vec<Option<usize>>> = (0..50).map(|k| vec![Some(k % 3); 2]).collect();
        let none = Estimate { gain: 0.0, low: 0.0, high: 0.0 };
        assert_eq!(estimated(&[0.5, 0.5], &twins, 3, 7), Some(none));
        assert_eq!(estimated(&[0.5, 0.5], &[vec![Some(0), None], vec![Some(1), Some(1)]], 2, 7), None);
        assert_eq!(estimated(&[0.5, 0.5], &[], 2, 7), None);
    }

    #[test]
    fn identifications_end_where_belief_is_enough() {
        let ending = Ending { threshold: 0.95, most: 20 };
        let question = [binary(0.9, 0.1)];
        let course = identify(&question, &[0.5, 0.5], ending, |_, _| 0, |_, _| Some(Some(0))).unwrap();
        // odds of 9 a trial: 9 / 10, then 81 / 82
        assert_eq!((course.trials.len(), course.named), (2, Some(0)));
        assert!((course.trials[1].belief[0] - 81.0 / 82.0).abs() < 1e-12);
        let alike = [binary(0.4, 0.4)];
        let course = identify(&alike, &[0.5, 0.5], ending, |_, _| 0, |_, k| Some(Some(k % 2))).unwrap();
        assert_eq!((course.trials.len(), course.named), (20, None));
        let known = identify(&alike, &[0.01, 0.99], ending, |_, _| 0, |_, _| None).unwrap();
        assert_eq!((known.trials.len(), known.named), (0, Some(1)), "known before");
        assert_eq!(identify(&alike, &[0.5, 0.5], ending, |_, _| 0, |_, _| None), None);
        let silent = identify(&question, &[0.5, 0.5], ending, |_, _| 0, |_, _| Some(None)).unwrap();
        assert_eq!((silent.trials.len(), silent.named), (20, None), "trials without an answer count and tell nothing");
    }
}
