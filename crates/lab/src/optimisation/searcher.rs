//! What proposes candidates: one face for all methods.

use super::form::{Archive, Search};
use super::plan::Plan;
use crate::evolution::form::Start;
use search::elites::{Elite, Elites, ElitesOptions, Told};
use search::evolution_strategy::{EvolutionStrategy, StrategyOptions};
use search::genetic::Genetic;
use search::{Axis, Domain, SearchError};
use space::random::child_seed;

/// Kind of child seeds: a new beginning.
const AGAIN: u32 = 11;
/// Candidates of a genetic algorithm that does not say.
const CANDIDATES: usize = 20;

enum Way {
    Uniform {
        each: usize,
        candidates: Vec<Vec<f64>>,
    },
    Genetic(Genetic),
    /// With the number of times that it began.
    Strategy(Box<EvolutionStrategy>, u64),
    Elites(Box<Elites>),
}

/// A run of a method, asked and told.
pub struct Searcher {
    domain: Domain,
    seed: u64,
    options: StrategyOptions,
    generation: u64,
    way: Way,
}

/// How an archive is made, and over which kinds.
fn archive(form: &Archive) -> Result<(ElitesOptions, Domain), SearchError> {
    let options = ElitesOptions {
        cells: form.cells,
        candidates: form.candidates,
        random_rounds: form.random_generations,
        isotropic: form.isotropic,
        along_line: form.along_line,
    };
    Ok((options, Domain::new(form.kind.0.iter().map(|(_, kind)| Axis::new(kind.low, kind.high)).collect())?))
}

/// A strategy that begins at a point drawn for it; the first begins in the middle of the box.
fn strategy(
    domain: &Domain,
    options: StrategyOptions,
    seed: u64,
    begun: u64,
) -> Result<EvolutionStrategy, SearchError> {
    let seed = child_seed(seed, AGAIN, begun, 0);
    let domain = match begun {
        0 => domain.clone(),
        _ => {
            let drawn = Genetic::random(domain, 1, seed);
            let axes = domain.axes().iter().enumerate();
            Domain::new(axes.map(|(k, axis)| axis.about(drawn[0][k])).collect())?
        }
    };
    EvolutionStrategy::new(domain, options, seed)
}

impl Searcher {
    /// A run that begins.
    ///
    /// # Errors
    /// Numbers of the method that cannot be.
    pub fn new(plan: &Plan, method: usize, run: usize) -> Result<Self, SearchError> {
        let (domain, seed) = (plan.domain.clone(), plan.seed_of(method, run));
        let mut options = StrategyOptions::default();
        let way = match &plan.form.method.0[method].1 {
            Search::Uniform(form) => Way::Uniform { each: form.candidates, candidates: Vec::new() },
            Search::Genetic(form) => {
                let mut first = Genetic::random(&domain, form.candidates.unwrap_or(CANDIDATES), seed);
                if let (Start::WithReference, Some(one)) = (form.start, first.first_mut()) {
                    *one = domain.axes().iter().map(|axis| axis.reference).collect();
                }
                Way::Genetic(Genetic::new(domain.clone(), form.operators(), seed, 0, first)?)
            }
            Search::CmaEs(form) => {
                options = StrategyOptions { candidates: form.candidates.unwrap_or(0), first_step: form.first_step };
                Way::Strategy(Box::new(strategy(&domain, options, seed, 0)?), 0)
            }
            Search::MapElites(form) => {
                let (options, kinds) = archive(form)?;
                Way::Elites(Box::new(Elites::new(domain.clone(), &kinds, options, seed)?))
            }
        };
        let mut searcher = Self { domain, seed, options, generation: 0, way };
        searcher.draw();
        Ok(searcher)
    }
    /// The candidates of uniform draws.
    fn draw(&mut self) {
        if let Way::Uniform { each, candidates } = &mut self.way {
            *candidates = Genetic::random(&self.domain, *each, child_seed(self.seed, AGAIN, self.generation, 0));
        }
    }
    /// The candidates of this generation.
    pub fn candidates(&self) -> &[Vec<f64>] {
        match &self.way {
            Way::Uniform { candidates, .. } => candidates,
            Way::Genetic(search) => search.candidates(),
            Way::Strategy(search, _) => search.candidates(),
            Way::Elites(search) => search.candidates(),
        }
    }
    /// The best of every kind that was reached, where kinds are told apart.
    pub fn elites(&self) -> Vec<Elite> {
        match &self.way {
            Way::Elites(search) => search.elites(),
            Way::Uniform { .. } | Way::Genetic(_) | Way::Strategy(..) => Vec::new(),
        }
    }
    /// The cell of the archive that a kind lies in; none where kinds are not told apart.
    pub fn cell_of(&self, kind: &[f64]) -> Option<usize> {
        match &self.way {
            Way::Elites(search) => search.cell_of(kind).ok(),
            Way::Uniform { .. } | Way::Genetic(_) | Way::Strategy(..) => None,
        }
    }
    /// Takes what was found of the candidates, in their order.
    ///
    /// # Errors
    /// Where there are not as many as candidates.
    pub fn tell(&mut self, told: &[Told]) -> Result<(), SearchError> {
        let scores: Vec<f64> = told.iter().map(|one| one.score).collect();
        self.generation += 1;
        match &mut self.way {
            Way::Uniform { .. } => {}
            Way::Genetic(search) => search.tell(&scores)?,
            Way::Strategy(search, begun) => {
                search.tell(&scores)?;
                if search.converged() {
                    *begun += 1;
                    **search = strategy(&self.domain, self.options, self.seed, *begun)?;
                }
            }
            Way::Elites(search) => search.tell(told)?,
        }
        self.draw();
        Ok(())
    }
}
