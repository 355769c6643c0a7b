//! Trying constructs: an evaluation of a candidate, trials of the best, trials without any, lighter constructs.

use super::form::Objective;
use super::plan::Plan;
use crate::environment::trial;
use space::random::child_seed;
use terrain::{Construct, Draws, Geometry, Piece};

/// Kind of child seeds: a trial, a changed copy.
const TRIAL: u32 = 12;
const COPY: u32 = 13;

/// What was found of a construct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// How good it is: the objective less what material costs. Less than any other where there is no construct.
    pub score: f64,
    /// Trials that succeeded.
    pub successes: u64,
    /// Trials; none where there is no construct.
    pub trials: u64,
    /// Mean fitness.
    pub fitness: f64,
    /// Mean number of steps of the trials that succeeded; not a number without any.
    pub steps: f64,
    /// Length of wall.
    pub material: f64,
    /// Number of pieces.
    pub pieces: u64,
}

impl Found {
    /// No construct. A score, not infinity, so that a search may average.
    pub const NOTHING: Self =
        Self { score: -1e9, successes: 0, trials: 0, fitness: 0.0, steps: f64::NAN, material: 0.0, pieces: 0 };
    /// Share of successes; 0 of no trials.
    pub fn rate(&self) -> f64 {
        if self.trials > 0 { self.successes as f64 / self.trials as f64 } else { 0.0 }
    }
}

/// What trials are for: each has seeds of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// An evaluation.
    Search = 0,
    /// The choice of the best of a run.
    Choice = 1,
    /// What is reported of it.
    Report = 2,
    /// Without a construct.
    Control = 3,
    /// Whether a lighter construct still does.
    Lighten = 4,
}

/// Seeds of the trials for a purpose: those of one number have them in common. They have 63 bits, so that a file can give
/// them.
pub fn seed_of(plan: &Plan, purpose: Purpose, number: u64, trial: usize) -> u64 {
    let parent = child_seed(plan.form.seed, TRIAL, number, purpose as u32);
    child_seed(parent, TRIAL, trial as u64, 0) >> 1
}

#[derive(Default)]
struct Sum {
    successes: u64,
    trials: u64,
    fitness: f64,
    steps: f64,
    updates: u64,
}

/// Trials of a construct; none where it was stopped.
fn tried(
    plan: &Plan,
    construct: &Construct,
    built: bool,
    seeds: impl Iterator<Item = u64>,
    stop: &dyn Fn() -> bool,
) -> Result<Option<Sum>, String> {
    let behaviour = plan.behaviour(construct, built).map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?;
    let there = plan.workspace.workspace.geometry.iter();
    let scenario = plan.population.among(there.chain(construct.geometry()));
    let behaviours = [behaviour];
    let mut sum = Sum::default();
    for seed in seeds {
        sum.trials += 1;
        match trial::run(&scenario, &plan.population, &behaviours, seed, stop, &mut |_| ()) {
            // impossible with this seed: it counts as a failure
            Err(_) => {}
            Ok(None) => return Ok(None),
            Ok(Some(tried)) => {
                sum.updates += tried.steps * plan.population.members() as u64;
                for outcome in &tried.outcomes {
                    sum.fitness += outcome.fitness;
                    if outcome.fitness >= plan.form.success {
                        sum.successes += 1;
                        sum.steps += tried.steps as f64;
                    }
                }
            }
        }
    }
    Ok(Some(sum))
}

/// So many trials of a construct, for a purpose; none where it was stopped. With the number of agent-updates.
///
/// # Errors
/// A construct without a meaning, in a sentence.
pub fn of_construct(
    plan: &Plan,
    construct: &Construct,
    (purpose, number): (Purpose, u64),
    trials: usize,
    stop: &dyn Fn() -> bool,
) -> Result<Option<(Found, u64)>, String> {
    let seeds = |first: usize| (first..first + trials).map(|trial| seed_of(plan, purpose, number, trial));
    let value = |sum: &Sum| match plan.form.objective {
        Objective::Fitness => sum.fitness / sum.trials as f64,
        Objective::Rate => sum.successes as f64 / sum.trials as f64,
    };
    let (sum, objective) = match plan.form.robust.as_ref().filter(|_| purpose != Purpose::Control) {
        None => {
            let Some(sum) = tried(plan, construct, purpose != Purpose::Control, seeds(0), stop)? else {
                return Ok(None);
            };
            let objective = value(&sum);
            (sum, objective)
        }
        Some(robust) => {
            let (mut all, mut values) = (Sum::default(), Vec::new());
            for copy in 0..robust.copies {
                let draws = Draws::new(child_seed(plan.form.seed, COPY, number, purpose as u32), copy as u64, 0);
                let changed = robust.by.perturbation().apply(construct, robust.size, &draws);
                let Some(sum) = tried(plan, &changed, true, seeds(copy * trials), stop)? else { return Ok(None) };
                values.push(value(&sum));
                all.successes += sum.successes;
                all.trials += sum.trials;
                all.fitness += sum.fitness;
                all.steps += sum.steps;
                all.updates += sum.updates;
            }
            values.sort_by(f64::total_cmp);
            let place = (robust.quantile * (values.len() - 1) as f64).floor() as usize;
            (all, values[place])
        }
    };
    let material = construct.material();
    let found = Found {
        score: objective - plan.form.material * material,
        successes: sum.successes,
        trials: sum.trials,
        fitness: sum.fitness / sum.trials as f64,
        steps: if sum.successes > 0 { sum.steps / sum.successes as f64 } else { f64::NAN },
        material,
        // one that was made lighter keeps the places of those taken away
        pieces: construct.pieces.iter().filter(|piece| !piece.geometry.is_empty()).count() as u64,
    };
    Ok(Some((found, sum.updates)))
}

/// As [`of_construct`], of the construct at a point; where there is none, [`Found::NOTHING`].
///
/// # Errors
/// As there.
pub fn of_point(
    plan: &Plan,
    point: &[f64],
    purpose: (Purpose, u64),
    trials: usize,
    stop: &dyn Fn() -> bool,
) -> Result<Option<(Found, u64)>, String> {
    match plan.construct(point) {
        Ok(construct) => of_construct(plan, &construct, purpose, trials, stop),
        Err(_) => Ok(Some((Found::NOTHING, 0))),
    }
}

/// What can be made lighter: each piece of a construct with each share that may be taken off its walls, in order.
pub fn reductions(pieces: usize, shares: &[f64]) -> Vec<(usize, f64)> {
    let mut shares = shares.to_vec();
    shares.sort_by(|a, b| b.total_cmp(a));
    shares.iter().flat_map(|&share| (0..pieces).map(move |piece| (piece, share))).collect()
}

/// A construct with a share taken off the walls of a piece; none where that changes nothing, or would leave nothing at all.
pub fn reduced(construct: &Construct, piece: usize, share: f64) -> Option<Construct> {
    let mut lighter = construct.clone();
    let own: &mut Piece = lighter.pieces.get_mut(piece)?;
    if share >= 1.0 {
        own.geometry.clear();
    } else {
        for geometry in &mut own.geometry {
            if let Geometry::Wall(wall) = geometry {
                wall.to = wall.to + (wall.from - wall.to) * share;
            }
        }
    }
    let saved = lighter.material() < construct.material() && lighter.material() > 0.0;
    saved.then_some(lighter)
}
