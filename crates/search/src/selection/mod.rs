//! Selection: whose genes go on. One file each, one line each in the list below.

use crate::Draws;

/// An operator that picks parents by their scores.
pub trait Selection: Send + Sync {
    /// Picks `count` parents (with repetition) among `scores.len()` candidates, which are not none; larger scores are
    /// better, and all are finite.
    fn pick(&self, scores: &[f64], count: usize, draws: &Draws) -> Vec<usize>;
}

macro_rules! selections {
    ($($file:ident::$name:ident, $id:literal, $about:literal;)*) => {
        $(pub mod $file;)*
        /// Every operator: its name in files and what it does.
        pub const LIST: &[(&str, &str)] = &[$(($id, $about)),*];
        /// The operator of a name.
        pub fn find(id: &str) -> Option<Box<dyn Selection>> {
            match id {
                $($id => Some(Box::new($file::$name::default())),)*
                _ => None,
            }
        }
    };
}

selections! {
    roulette::Roulette, "roulette", "each parent with a chance in proportion to its score";
    stochastic_universal::StochasticUniversal, "stochastic_universal",
        "in proportion to the scores, by one turn of a wheel with as many evenly spaced pointers as parents";
    tournament::Tournament, "tournament", "the best of two drawn at random (with repetition)";
    rank::Rank, "rank", "with a chance in proportion to the rank, the worst having rank 1";
}

/// Scores as they enter a search: what is not a number, or infinite, becomes the worst (or best) finite score.
pub(crate) fn finite(scores: &[f64]) -> Vec<f64> {
    let known = scores.iter().copied().filter(|score| score.is_finite());
    let (low, high) = known.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), score| (l.min(score), h.max(score)));
    let replaced = |score: f64| match score {
        _ if low > high => 0.0,
        score if score.is_finite() => score,
        f64::INFINITY => high,
        _ => low,
    };
    scores.iter().map(|&score| replaced(score)).collect()
}

/// Cumulated shares of a wheel, the last being 1: scores shifted by their minimum where any is negative. All alike where
/// no score is above zero then.
pub(crate) fn wheel(scores: &[f64]) -> Vec<f64> {
    let low = scores.iter().copied().fold(0.0, f64::min);
    // halved, so that the width of any two finite scores is finite
    let parts: Vec<f64> = scores.iter().map(|&score| score / 2.0 - low / 2.0).collect();
    let high = parts.iter().copied().fold(0.0, f64::max);
    let parts: Vec<f64> =
        if high > 0.0 { parts.iter().map(|part| part / high).collect() } else { vec![1.0; parts.len()] };
    let total: f64 = parts.iter().sum();
    let mut sum = 0.0;
    parts
        .iter()
        .map(|part| {
            sum += part;
            sum / total
        })
        .collect()
}

/// Where a pointer at `share` of a wheel points.
pub(crate) fn pointed(wheel: &[f64], share: f64) -> usize {
    wheel.partition_point(|&end| end <= share).min(wheel.len().saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often each candidate is picked in many generations.
    pub(super) fn shares(selection: &dyn Selection, scores: &[f64]) -> Vec<f64> {
        let mut counts = vec![0.0; scores.len()];
        let (generations, parents) = (4000, 10);
        for generation in 0..generations {
            for parent in selection.pick(scores, parents, &Draws::new(5, generation)) {
                counts[parent] += 1.0 / (generations * parents as u64) as f64;
            }
        }
        counts
    }

    /// Whether two lists of shares agree within what 40,000 draws allow.
    pub(super) fn close(found: &[f64], expected: &[f64]) {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 0.012, "{found} instead of {expected}");
        }
    }

    #[test]
    fn every_operator_picks_as_many_as_asked_among_all() {
        for (id, _) in LIST {
            let selection = find(id).unwrap();
            for scores in [vec![1.0], vec![0.0, 0.0], vec![-5.0, 2.0, 2.0], vec![f64::MAX, f64::MIN, 0.0]] {
                let picked = selection.pick(&scores, 7, &Draws::new(1, 2));
                assert_eq!(picked.len(), 7, "{id}");
                assert!(picked.iter().all(|&p| p < scores.len()), "{id}");
            }
            // equal scores: no preference
            close(&shares(&*selection, &[3.0; 4]), &[0.25; 4]);
        }
        assert!(find("roulete").is_none());
    }

    #[test]
    fn scores_that_are_no_numbers_are_worst() {
        assert_eq!(finite(&[f64::NAN, 2.0, 5.0]), [2.0, 2.0, 5.0]);
        assert_eq!(finite(&[f64::INFINITY, 2.0, f64::NEG_INFINITY]), [2.0, 2.0, 2.0]);
        assert_eq!(finite(&[f64::NAN; 2]), [0.0, 0.0]);
    }

    #[test]
    fn wheels() {
        assert_eq!(wheel(&[1.0, 1.0, 2.0]), [0.25, 0.5, 1.0]);
        // shifted by the minimum, since one is negative
        assert_eq!(wheel(&[-1.0, 0.0, 1.0]), [0.0, 1.0 / 3.0, 1.0]);
        assert_eq!(wheel(&[0.0, 0.0]), [0.5, 1.0]);
        assert_eq!([0.0, 0.3, 0.99].map(|share| pointed(&[0.0, 1.0 / 3.0, 1.0], share)), [1, 1, 2]);
    }
}
