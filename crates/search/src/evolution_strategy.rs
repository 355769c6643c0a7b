//! CMA-ES: an evolution strategy that learns which directions matter.
//!
//! N. Hansen, A. Ostermeier (2001), Completely derandomized self-adaptation in evolution strategies, Evolutionary
//! Computation 9:159, in its active form; the library `fcmaes-core` does it. Points are searched in the unit box of the
//! domain and brought inside it.

use crate::error::{counted, hold};
use crate::selection::finite;
use crate::{Domain, SearchError};
use fcmaes_core::{Cmaes, CmaesParams, Fitness};

/// How the strategy begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrategyOptions {
    /// Candidates a generation; 0: as many as the number of dimensions suggests, 4 + 3 ln D.
    pub candidates: usize,
    /// First step, as a share of half the range of each axis.
    pub first_step: f64,
}

impl Default for StrategyOptions {
    fn default() -> Self {
        Self { candidates: 0, first_step: 0.3 }
    }
}

/// CMA-ES, asked and told. It goes on from the values told to it so far, by being told them again.
pub struct EvolutionStrategy {
    domain: Domain,
    strategy: Cmaes,
    candidates: Vec<Vec<f64>>,
    generation: u64,
    /// Whether the library has come to rest; candidates are still handed out then.
    converged: bool,
}

impl EvolutionStrategy {
    /// A search that begins at the references of the axes.
    ///
    /// # Errors
    /// With fewer than two candidates, or a first step that is not above zero.
    pub fn new(domain: Domain, options: StrategyOptions, seed: u64) -> Result<Self, SearchError> {
        hold(options.candidates != 1, "number of candidates", "0 (by the number of dimensions), or at least 2")?;
        hold(options.first_step.is_finite() && options.first_step > 0.0, "first step", "a number above 0")?;
        let mut start: Vec<f64> = domain.axes().iter().map(|axis| axis.reference).collect();
        domain.clamp(&mut start);
        let mut fitness = Fitness::bounded(domain.dimensions(), 1, &domain.lows(), &domain.highs());
        fitness.set_normalize(true);
        let parameters = CmaesParams {
            popsize: i32::try_from(options.candidates).unwrap_or(i32::MAX),
            // a budget of the library's own would shape its step sizes: the caller stops
            max_evaluations: u64::MAX / 2,
            seed,
            ..CmaesParams::default()
        };
        let strategy = Cmaes::new(fitness, &start, &[options.first_step], &parameters);
        let mut search = Self { domain, strategy, candidates: Vec::new(), generation: 0, converged: false };
        search.ask();
        Ok(search)
    }
    /// A search that goes on where one stopped that had been told these scores, generation by generation.
    ///
    /// # Errors
    /// As for a new one, and where a generation has the wrong number of scores.
    pub fn resume(domain: Domain, options: StrategyOptions, seed: u64, told: &[Vec<f64>]) -> Result<Self, SearchError> {
        let mut search = Self::new(domain, options, seed)?;
        for scores in told {
            search.tell(scores)?;
        }
        Ok(search)
    }
    fn ask(&mut self) {
        self.candidates = self.strategy.ask();
        for candidate in &mut self.candidates {
            self.domain.clamp(candidate);
        }
    }
    /// Number of the generation, from 0.
    pub fn generation(&self) -> u64 {
        self.generation
    }
    /// The candidates of this generation, whose scores are wanted.
    pub fn candidates(&self) -> &[Vec<f64>] {
        &self.candidates
    }
    /// Whether the steps have become so small, or the scores so equal, that going on is of no use.
    pub fn converged(&self) -> bool {
        self.converged
    }
    /// Takes the scores of the candidates, in their order.
    ///
    /// # Errors
    /// Where there are not as many scores as candidates.
    pub fn tell(&mut self, scores: &[f64]) -> Result<(), SearchError> {
        counted("scores", scores.len(), self.candidates.len())?;
        // the library makes small what it is told
        let costs: Vec<f64> = finite(scores).into_iter().map(|score| -score).collect();
        self.converged |= self.strategy.tell_x(&costs, &self.candidates) != 0;
        self.generation += 1;
        self.ask();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn domain() -> Domain {
        Domain::new(vec![Axis::new(-2.0, 2.0), Axis::new(0.0, 300.0), Axis::new(-1.0, 3.0)]).unwrap()
    }

    /// A bent valley whose best place is (1, 250, 1).
    fn score(x: &[f64]) -> f64 {
        -(10.0 * (x[2] - x[0] * x[0]).powi(2) + (1.0 - x[0]).powi(2) + ((x[1] - 250.0) / 50.0).powi(2))
    }

    fn run(search: &mut EvolutionStrategy, generations: usize) -> Vec<Vec<f64>> {
        let round = |search: &mut EvolutionStrategy| {
            let scores: Vec<f64> = search.candidates().iter().map(|x| score(x)).collect();
            search.tell(&scores).unwrap();
            scores
        };
        (0..generations).map(|_| round(search)).collect()
    }

    #[test]
    fn finds_the_end_of_a_bent_valley() {
        let mut search = EvolutionStrategy::new(domain(), StrategyOptions::default(), 4).unwrap();
        run(&mut search, 250);
        let best = search.candidates().iter().max_by(|a, b| score(a).total_cmp(&score(b))).unwrap();
        assert!(score(best) > -1e-6, "{best:?}");
    }

    #[test]
    fn goes_on_from_the_scores_told() {
        let options = StrategyOptions { candidates: 9, ..StrategyOptions::default() };
        let mut whole = EvolutionStrategy::new(domain(), options, 4).unwrap();
        let mut told = run(&mut whole, 12);
        told.truncate(5);
        let mut rest = EvolutionStrategy::resume(domain(), options, 4, &told).unwrap();
        run(&mut rest, 7);
        assert_eq!(rest.candidates(), whole.candidates());
        assert_eq!((rest.generation(), rest.candidates().len()), (12, 9));
    }

    #[test]
    fn candidates_stay_inside_and_scores_that_are_no_numbers_do_no_harm() {
        let mut search =
            EvolutionStrategy::new(domain(), StrategyOptions { candidates: 4, first_step: 3.0 }, 4).unwrap();
        for generation in 0..30 {
            for x in search.candidates() {
                for (value, axis) in x.iter().zip(search.domain.axes()) {
                    assert!((axis.low..=axis.high).contains(value));
                }
            }
            let good = score(&search.candidates()[1]);
            let scores = if generation % 3 == 0 { [f64::NAN; 4] } else { [f64::NEG_INFINITY, good, f64::NAN, 0.0] };
            search.tell(&scores).unwrap();
        }
    }

    #[test]
    fn one_axis_is_enough() {
        let domain = Domain::new(vec![Axis::new(0.0, 1.0).about(0.9)]).unwrap();
        let mut search = EvolutionStrategy::new(domain, StrategyOptions::default(), 1).unwrap();
        for _ in 0..60 {
            let scores: Vec<f64> = search.candidates().iter().map(|x| -(x[0] - 0.25).abs()).collect();
            search.tell(&scores).unwrap();
        }
        assert!(search.candidates().iter().any(|x| (x[0] - 0.25).abs() < 0.01));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for (candidates, first_step) in [(1, 0.3), (0, 0.0), (0, f64::NAN), (0, -1.0)] {
            let options = StrategyOptions { candidates, first_step };
            assert!(EvolutionStrategy::new(domain(), options, 0).is_err());
        }
    }
}
