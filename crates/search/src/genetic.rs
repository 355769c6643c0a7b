//! A generational genetic algorithm.

use crate::crossover::{self, Crossover};
use crate::error::{counted, hold};
use crate::mutation::{self, Mutation, mutate};
use crate::selection::{self, Selection, finite};
use crate::{Domain, Draws, SearchError};

/// How generations follow each other.
pub struct Operators {
    /// Whose genes go on.
    pub selection: Box<dyn Selection>,
    /// How two parents make an offspring.
    pub crossover: Box<dyn Crossover>,
    /// How a gene changes.
    pub mutation: Box<dyn Mutation>,
    /// Chance that one gene of an offspring changes.
    pub mutation_rate: f64,
    /// How many of the best go on unchanged.
    pub elite: usize,
}

impl Operators {
    /// The parents of the next generation, two for each offspring, by their places among the candidates.
    pub fn parents(&self, scores: &[f64], seed: u64, generation: u64) -> Vec<usize> {
        let offspring = scores.len().saturating_sub(self.elite);
        self.selection.pick(&finite(scores), 2 * offspring, &Draws::new(seed, generation))
    }
}

impl Default for Operators {
    /// Rank selection, one-point crossover, a creeping gene in a tenth of the offspring, and no elite.
    fn default() -> Self {
        Self {
            selection: Box::new(selection::rank::Rank),
            crossover: Box::new(crossover::one_point::OnePoint),
            mutation: Box::new(mutation::creep::Creep::default()),
            mutation_rate: 0.1,
            elite: 0,
        }
    }
}

/// A population that evolves.
///
/// The next generation is a function of seed, number of the generation, candidates and their scores: a search goes on
/// from [`Genetic::generation`] and [`Genetic::candidates`] as if it had never stopped.
///
/// ```
/// use search::genetic::{Genetic, Operators};
/// use search::{Axis, Domain};
///
/// let domain = Domain::new(vec![Axis::new(-5.0, 5.0); 3])?;
/// let first = Genetic::random(&domain, 40, 7);
/// let operators = Operators { elite: 1, mutation_rate: 0.5, ..Operators::default() };
/// let mut search = Genetic::new(domain, operators, 7, 0, first)?;
/// let score = |genes: &Vec<f64>| -genes.iter().map(|gene| gene * gene).sum::<f64>();
/// for _ in 0..200 {
///     let scores: Vec<f64> = search.candidates().iter().map(score).collect();
///     search.tell(&scores)?;
/// }
/// assert!(search.candidates().iter().map(score).fold(f64::MIN, f64::max) > -0.1);
/// # Ok::<(), search::SearchError>(())
/// ```
pub struct Genetic {
    domain: Domain,
    operators: Operators,
    seed: u64,
    generation: u64,
    candidates: Vec<Vec<f64>>,
}

impl Genetic {
    /// A search that begins, or goes on, with these candidates of a generation (0 at the start).
    ///
    /// # Errors
    /// Without candidates, where one has the wrong number of genes, with a rate of mutation outside 0 to 1, or an elite
    /// that leaves nobody to be replaced.
    pub fn new(
        domain: Domain,
        operators: Operators,
        seed: u64,
        generation: u64,
        mut candidates: Vec<Vec<f64>>,
    ) -> Result<Self, SearchError> {
        hold(!candidates.is_empty(), "number of candidates", "at least one")?;
        hold((0.0..=1.0).contains(&operators.mutation_rate), "rate of mutation", "a number from 0 to 1")?;
        hold(operators.elite < candidates.len(), "size of the elite", "fewer than there are candidates")?;
        for genes in &mut candidates {
            counted("genes of a candidate", genes.len(), domain.dimensions())?;
            domain.clamp(genes);
        }
        Ok(Self { domain, operators, seed, generation, candidates })
    }
    /// Candidates drawn uniformly between the bounds, to begin with.
    pub fn random(domain: &Domain, candidates: usize, seed: u64) -> Vec<Vec<f64>> {
        // generations count from 0, and 0 is bred from the first candidates
        let draws = Draws::new(seed, u64::MAX);
        let gene = |k: usize, gene: usize| domain.axes()[gene].at(draws.uniform(k as u64, gene as u32));
        (0..candidates).map(|k| (0..domain.dimensions()).map(|g| gene(k, g)).collect()).collect()
    }
    /// Number of the generation, from 0.
    pub fn generation(&self) -> u64 {
        self.generation
    }
    /// The candidates of this generation, whose scores are wanted.
    pub fn candidates(&self) -> &[Vec<f64>] {
        &self.candidates
    }
    /// Takes the scores of the candidates, in their order, and breeds the next generation.
    ///
    /// The elite stands first, best first (of equals the one that stood first); all others are replaced.
    ///
    /// # Errors
    /// Where there are not as many scores as candidates.
    pub fn tell(&mut self, scores: &[f64]) -> Result<(), SearchError> {
        counted("scores", scores.len(), self.candidates.len())?;
        let scores = finite(scores);
        let draws = Draws::new(self.seed, self.generation);
        let mut order: Vec<usize> = (0..scores.len()).collect();
        order.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]));
        let mut next: Vec<Vec<f64>> =
            order.iter().take(self.operators.elite).map(|&k| self.candidates[k].clone()).collect();
        let parents = self.operators.parents(&scores, self.seed, self.generation);
        for (k, pair) in parents.chunks_exact(2).enumerate() {
            let [first, second] = [pair[0], pair[1]].map(|parent| &self.candidates[parent]);
            let mut genes = self.operators.crossover.cross(first, second, k as u64, &draws);
            let Operators { mutation, mutation_rate, .. } = &self.operators;
            mutate(&**mutation, *mutation_rate, &mut genes, &self.domain, k as u64, &draws);
            next.push(genes);
        }
        self.candidates = next;
        self.generation += 1;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn domain() -> Domain {
        Domain::new(vec![Axis::new(0.0, 1.0), Axis::new(-3.0, 3.0), Axis::new(10.0, 20.0)]).unwrap()
    }

    fn score(genes: &[f64]) -> f64 {
        genes[0] - (genes[1] - 1.0).abs() - 0.1 * (genes[2] - 12.0).abs()
    }

    fn search(selection: &str, elite: usize, first: Vec<Vec<f64>>, generation: u64) -> Genetic {
        let operators = Operators {
            selection: selection::find(selection).unwrap(),
            mutation_rate: 0.4,
            elite,
            ..Operators::default()
        };
        Genetic::new(domain(), operators, 11, generation, first).unwrap()
    }

    fn run(search: &mut Genetic, generations: usize) {
        for _ in 0..generations {
            let scores: Vec<f64> = search.candidates().iter().map(|genes| score(genes)).collect();
            search.tell(&scores).unwrap();
        }
    }

    #[test]
    fn every_selection_improves_a_plain_hill() {
        for (selection, _) in selection::LIST {
            let first = Genetic::random(&domain(), 30, 11);
            let mean = |candidates: &[Vec<f64>]| candidates.iter().map(|genes| score(genes)).sum::<f64>() / 30.0;
            let before = mean(&first);
            let mut search = search(selection, 0, first, 0);
            run(&mut search, 150);
            assert!(mean(search.candidates()) > before + 0.5, "{selection}");
            assert_eq!(search.generation(), 150);
        }
    }

    #[test]
    fn goes_on_from_its_candidates_as_if_it_had_never_stopped() {
        let mut whole = search("stochastic_universal", 2, Genetic::random(&domain(), 12, 5), 0);
        run(&mut whole, 40);
        let mut part = search("stochastic_universal", 2, Genetic::random(&domain(), 12, 5), 0);
        run(&mut part, 17);
        let mut rest = search("stochastic_universal", 2, part.candidates().to_vec(), part.generation());
        run(&mut rest, 23);
        assert_eq!(rest.candidates(), whole.candidates());
    }

    #[test]
    fn the_elite_is_never_lost() {
        let mut search = search("roulette", 1, Genetic::random(&domain(), 6, 3), 0);
        let mut best = f64::MIN;
        for _ in 0..100 {
            let scores: Vec<f64> = search.candidates().iter().map(|genes| score(genes)).collect();
            let now = scores.iter().copied().fold(f64::MIN, f64::max);
            assert!(now >= best);
            best = now;
            search.tell(&scores).unwrap();
            assert_eq!(score(&search.candidates()[0]), best);
        }
    }

    #[test]
    fn without_mutation_no_new_allele_appears() {
        let first = Genetic::random(&domain(), 8, 3);
        let mut search =
            Genetic::new(domain(), Operators { mutation_rate: 0.0, ..Operators::default() }, 3, 0, first.clone())
                .unwrap();
        run(&mut search, 30);
        for genes in search.candidates() {
            assert!((0..3).all(|gene| first.iter().any(|old| old[gene] == genes[gene])));
        }
    }

    #[test]
    fn scores_that_are_no_numbers_lose_and_do_no_harm() {
        let mut search = search("roulette", 1, Genetic::random(&domain(), 5, 3), 0);
        let fit = search.candidates()[3].clone();
        search.tell(&[f64::NAN, f64::NEG_INFINITY, 1.0, 2.0, f64::NAN]).unwrap();
        assert_eq!(search.candidates()[0], fit);
        search.tell(&[f64::NAN; 5]).unwrap();
        assert!(search.candidates().iter().flatten().all(|gene| gene.is_finite()));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let new = |operators, candidates| Genetic::new(domain(), operators, 0, 0, candidates).err();
        assert!(new(Operators::default(), vec![]).is_some());
        assert!(new(Operators::default(), vec![vec![0.0; 2]]).is_some());
        assert!(new(Operators { elite: 1, ..Operators::default() }, vec![vec![0.0; 3]]).is_some());
        assert!(new(Operators { mutation_rate: 1.5, ..Operators::default() }, vec![vec![0.0; 3]]).is_some());
        assert!(new(Operators { mutation_rate: f64::NAN, ..Operators::default() }, vec![vec![0.0; 3]]).is_some());
        let mut search = search("rank", 0, vec![vec![0.0; 3]; 2], 0);
        assert_eq!(search.tell(&[1.0]), Err(SearchError::Length { what: "scores", found: 1, expected: 2 }));
    }
}
