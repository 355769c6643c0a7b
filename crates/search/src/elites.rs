//! MAP-Elites: the best of every kind.
//!
//! J.-B. Mouret, J. Clune (2015), Illuminating search spaces by mapping elites, arXiv:1504.04909; cells by centroidal
//! Voronoi tessellation after V. Vassiliades, K. Chatzilygeroudis, J.-B. Mouret (2018), IEEE Transactions on Evolutionary
//! Computation 22:623 (on two descriptors, a regular grid), offspring by isotropic and line mutation after Vassiliades and
//! Mouret (2018), GECCO. The library `fcmaes-core` has archive and operators.

use crate::error::{counted, hold};
use crate::{Domain, SearchError};
use fcmaes_core::mapelites::iso_dd;
use fcmaes_core::{Archive, Rng};

/// How the archive is made and filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElitesOptions {
    /// Cells of the archive.
    pub cells: usize,
    /// Candidates a round.
    pub candidates: usize,
    /// Rounds of candidates drawn uniformly before elites are changed.
    pub random_rounds: usize,
    /// Standard deviation of the isotropic change, as a share of each axis's range.
    pub isotropic: f64,
    /// Standard deviation of the change along the line to another elite.
    pub along_line: f64,
}

impl Default for ElitesOptions {
    fn default() -> Self {
        Self { cells: 400, candidates: 40, random_rounds: 5, isotropic: 0.02, along_line: 0.2 }
    }
}

/// An elite.
#[derive(Clone, Debug, PartialEq)]
pub struct Elite {
    /// Number of its cell.
    pub cell: usize,
    /// Its numbers, `[dimensions]`.
    pub point: Vec<f64>,
    /// Its score.
    pub score: f64,
    /// What kind it is, `[descriptors]`.
    pub descriptors: Vec<f64>,
}

/// What is told of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    /// Its score.
    pub score: f64,
    /// What kind it is, `[descriptors]`.
    pub descriptors: Vec<f64>,
}

/// MAP-Elites, asked and told. It goes on from what was told to it so far, by being told that again.
pub struct Elites {
    domain: Domain,
    archive: Archive,
    options: ElitesOptions,
    random: Rng,
    candidates: Vec<Vec<f64>>,
    round: u64,
}

/// Samples a cell from which the tessellation is made.
const SAMPLES: usize = 20;

impl Elites {
    /// A search over `domain` for elites that differ in what `kinds` bounds: one axis for each descriptor.
    ///
    /// # Errors
    /// Without cells or candidates, or with steps that are not above zero.
    pub fn new(domain: Domain, kinds: &Domain, options: ElitesOptions, seed: u64) -> Result<Self, SearchError> {
        hold(options.candidates > 0, "number of candidates", "at least one")?;
        for (step, what) in [(options.isotropic, "isotropic step"), (options.along_line, "step along the line")] {
            hold(step.is_finite() && step >= 0.0, what, "a number from 0 on")?;
        }
        let mut random = Rng::new(seed);
        let (lows, highs) = (kinds.lows(), kinds.highs());
        let archive = Archive::try_new(domain.dimensions(), &lows, &highs, options.cells, SAMPLES, &mut random)
            .map_err(SearchError::Refused)?;
        let mut search = Self { domain, archive, options, random, candidates: Vec::new(), round: 0 };
        search.ask();
        Ok(search)
    }
    /// A search that goes on where one stopped that had been told this, round by round.
    ///
    /// # Errors
    /// As for a new one, and where a round does not fit.
    pub fn resume(
        domain: Domain,
        kinds: &Domain,
        options: ElitesOptions,
        seed: u64,
        told: &[Vec<Told>],
    ) -> Result<Self, SearchError> {
        let mut search = Self::new(domain, kinds, options, seed)?;
        for round in told {
            search.tell(round)?;
        }
        Ok(search)
    }
    fn ask(&mut self) {
        let count = self.options.candidates;
        // parents and offspring are shares of the way from low to high, so that one step fits all axes
        let shares = if self.round < self.options.random_rounds as u64 || self.archive.occupied() == 0 {
            (0..count).map(|_| self.random.uniform_vec(self.domain.dimensions())).collect()
        } else {
            let elites: Vec<Vec<f64>> = self.elites().into_iter().map(|elite| elite.point).collect();
            let share = |point: &Vec<f64>| -> Vec<f64> {
                point.iter().zip(self.domain.axes()).map(|(v, axis)| (v - axis.low) / (axis.high - axis.low)).collect()
            };
            let shares: Vec<Vec<f64>> = elites.iter().map(share).collect();
            let mut parents = || -> Vec<Vec<f64>> {
                (0..count).map(|_| shares[self.random.int_below(shares.len() as i64) as usize].clone()).collect()
            };
            let (first, second) = (parents(), parents());
            let (low, high) = (vec![0.0; self.domain.dimensions()], vec![1.0; self.domain.dimensions()]);
            let ElitesOptions { isotropic, along_line, .. } = self.options;
            iso_dd(&first, &second, &low, &high, &mut self.random, isotropic, along_line)
        };
        let point = |shares: &Vec<f64>| -> Vec<f64> {
            shares.iter().zip(self.domain.axes()).map(|(&share, axis)| axis.at(share)).collect()
        };
        self.candidates = shares.iter().map(point).collect();
    }
    /// Number of the round, from 0.
    pub fn round(&self) -> u64 {
        self.round
    }
    /// The candidates of this round, whose scores and descriptors are wanted.
    pub fn candidates(&self) -> &[Vec<f64>] {
        &self.candidates
    }
    /// Takes what was found of the candidates, in their order. What is not a number is not kept.
    ///
    /// # Errors
    /// Where there are not as many as candidates, or one has the wrong number of descriptors.
    pub fn tell(&mut self, told: &[Told]) -> Result<(), SearchError> {
        counted("scores", told.len(), self.candidates.len())?;
        for Told { descriptors, .. } in told {
            counted("descriptors of a candidate", descriptors.len(), self.archive.qd_dim())?;
        }
        // the library keeps the smallest
        let costs: Vec<(f64, Vec<f64>)> = told.iter().map(|one| (-one.score, one.descriptors.clone())).collect();
        self.archive.update_evaluated(&self.candidates, &costs).map_err(SearchError::Refused)?;
        self.round += 1;
        self.ask();
        Ok(())
    }
    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.archive.capacity()
    }
    /// The cell that descriptors lie in.
    ///
    /// # Errors
    /// As many descriptors as there are kinds are needed.
    pub fn cell_of(&self, descriptors: &[f64]) -> Result<usize, SearchError> {
        counted("descriptors", descriptors.len(), self.archive.qd_dim())?;
        Ok(self.archive.index_of_niche(descriptors))
    }
    /// The best of every cell that was reached, by ascending cell.
    pub fn elites(&self) -> Vec<Elite> {
        let (scores, points, descriptors) = (self.archive.ys(), self.archive.xs(), self.archive.descriptors());
        let elite = |cell: usize| Elite {
            cell,
            point: points[cell].clone(),
            score: -scores[cell],
            descriptors: descriptors[cell].clone(),
        };
        (0..self.cells()).filter(|&cell| scores[cell].is_finite()).map(elite).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    fn domain() -> Domain {
        Domain::new(vec![Axis::new(-10.0, 10.0), Axis::new(0.0, 4.0), Axis::new(0.0, 1.0)]).unwrap()
    }

    fn kinds() -> Domain {
        Domain::new(vec![Axis::new(-10.0, 10.0), Axis::new(0.0, 4.0)]).unwrap()
    }

    /// The kind is where it stands; the third number decides how good it is, best at 0.3.
    fn told(point: &[f64]) -> Told {
        Told { score: -(point[2] - 0.3).abs(), descriptors: point[..2].to_vec() }
    }

    fn run(search: &mut Elites, rounds: usize) -> Vec<Vec<Told>> {
        let round = |search: &mut Elites| {
            let round: Vec<Told> = search.candidates().iter().map(|point| told(point)).collect();
            search.tell(&round).unwrap();
            round
        };
        (0..rounds).map(|_| round(search)).collect()
    }

    #[test]
    fn fills_the_cells_with_good_ones() {
        let options = ElitesOptions { cells: 100, ..ElitesOptions::default() };
        let mut search = Elites::new(domain(), &kinds(), options, 2).unwrap();
        run(&mut search, 120);
        let elites = search.elites();
        assert!(elites.len() > 95, "{} of 100 cells", elites.len());
        let mean = elites.iter().map(|elite| elite.score).sum::<f64>() / elites.len() as f64;
        assert!(mean > -0.02, "{mean}");
        for Elite { point, descriptors, score, .. } in &elites {
            assert_eq!((&point[..2], *score), (&descriptors[..], told(point).score));
        }
    }

    #[test]
    fn goes_on_from_what_was_told() {
        let options = ElitesOptions { cells: 30, candidates: 8, ..ElitesOptions::default() };
        let mut whole = Elites::new(domain(), &kinds(), options, 2).unwrap();
        let mut history = run(&mut whole, 20);
        history.truncate(9);
        let mut rest = Elites::resume(domain(), &kinds(), options, 2, &history).unwrap();
        run(&mut rest, 11);
        assert_eq!(rest.candidates(), whole.candidates());
        assert_eq!(rest.elites(), whole.elites());
    }

    #[test]
    fn what_is_no_number_is_not_kept() {
        let mut search = Elites::new(domain(), &kinds(), ElitesOptions::default(), 2).unwrap();
        let bad = Told { score: f64::NAN, descriptors: vec![0.0, 0.0] };
        let lost = Told { score: 1.0, descriptors: vec![f64::NAN, 0.0] };
        let count = search.candidates().len();
        search.tell(&[vec![bad; count - 1], vec![lost]].concat()).unwrap();
        assert_eq!(search.elites(), []);
        assert!(search.tell(&[]).is_err());
        let short = Told { score: 1.0, descriptors: vec![0.0] };
        assert!(search.tell(&vec![short; count]).is_err());
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let new = |options| Elites::new(domain(), &kinds(), options, 0).err();
        assert!(new(ElitesOptions { cells: 0, ..ElitesOptions::default() }).is_some());
        assert!(new(ElitesOptions { candidates: 0, ..ElitesOptions::default() }).is_some());
        assert!(new(ElitesOptions { isotropic: f64::NAN, ..ElitesOptions::default() }).is_some());
    }
}
