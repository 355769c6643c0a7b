//! Generating environments: candidates from a grammar, a schema or a grid, placed, filtered, and handed to whoever can
//! tell whether a group does in them what is wanted (the source's algorithms 3 to 5).

use crate::construct::{Environment, Placement};
use crate::filters::Combined;
use crate::primitives::{Primitive, PrimitiveType, construct};
use crate::schema::Schema;
use crate::{Construct, Grammar, TerrainError, Workspace};
use std::collections::BTreeMap;

/// Something that proposes constructs, one for each attempt.
pub trait Candidates: Sync {
    /// The construct of an attempt under a seed; `None` where there are no more.
    ///
    /// # Errors
    /// [`TerrainError::Unfinished`] where this attempt comes to nothing; anything else ends the generation.
    fn candidate(&self, workspace: &Workspace, seed: u64, attempt: u64) -> Result<Option<Construct>, TerrainError>;
}

/// Algorithm 4: one derivation for each attempt.
impl Candidates for Grammar {
    fn candidate(&self, _: &Workspace, seed: u64, attempt: u64) -> Result<Option<Construct>, TerrainError> {
        self.construct(seed, attempt).map(Some)
    }
}

/// A schema at the same values for every attempt: what differs is what it draws.
pub struct Repeated<'a> {
    /// The schema.
    pub schema: &'a dyn Schema,
    /// Its values.
    pub values: Vec<f64>,
}

impl Candidates for Repeated<'_> {
    fn candidate(&self, workspace: &Workspace, seed: u64, attempt: u64) -> Result<Option<Construct>, TerrainError> {
        self.schema.construct(&self.values, workspace, seed, attempt).map(Some)
    }
}

/// A schema at every combination of values of a grid, in odometer order: the last parameter fastest.
pub struct Grid<'a> {
    schema: &'a dyn Schema,
    axes: Vec<Vec<f64>>,
}

impl<'a> Grid<'a> {
    /// The grid of these resolutions, one for each parameter of the schema.
    ///
    /// # Errors
    /// Too few or too many resolutions, or one that is not a positive number.
    pub fn new(schema: &'a dyn Schema, resolutions: &[f64]) -> Result<Self, TerrainError> {
        let card = schema.card();
        if resolutions.len() != card.parameters.len() {
            let expected = format!("{} numbers", card.parameters.len());
            return Err(TerrainError::range("resolutions", expected, resolutions.len() as f64));
        }
        let axis = |(parameter, &resolution): (&crate::schema::Parameter, &f64)| parameter.domain.grid(resolution);
        let axes = card.parameters.iter().zip(resolutions).map(axis).collect::<Result<_, _>>()?;
        Ok(Self { schema, axes })
    }
    /// Number of combinations.
    pub fn count(&self) -> f64 {
        self.axes.iter().map(|axis| axis.len() as f64).product()
    }
    /// The values of a combination; `None` beyond the last.
    pub fn values(&self, number: u64) -> Option<Vec<f64>> {
        odometer(&self.axes, number)
    }
}

impl Candidates for Grid<'_> {
    fn candidate(&self, workspace: &Workspace, seed: u64, attempt: u64) -> Result<Option<Construct>, TerrainError> {
        let Some(values) = self.values(attempt) else { return Ok(None) };
        self.schema.construct(&values, workspace, seed, attempt).map(Some)
    }
}

/// The values at a place of an odometer, the last axis fastest; `None` beyond the last.
pub fn odometer(axes: &[Vec<f64>], number: u64) -> Option<Vec<f64>> {
    let mut left = number;
    let mut values = vec![0.0; axes.len()];
    for (value, axis) in values.iter_mut().zip(axes).rev() {
        let count = axis.len() as u64;
        *value = *axis.get((left.checked_rem(count)?) as usize)?;
        left /= count;
    }
    (left == 0).then_some(values)
}

/// Algorithm 5: every environment of so many primitives, each of any of the types at any point of its grid.
pub struct Enumeration {
    kinds: Vec<(PrimitiveType, Vec<Vec<f64>>)>,
    primitives: u32,
}

impl Enumeration {
    /// Ordered tuples of `primitives` primitives of these types; with each type the values that each of its attributes
    /// takes. A count above `most` is refused.
    ///
    /// # Errors
    /// Types without values for each attribute, or too many candidates.
    pub fn new(kinds: Vec<(PrimitiveType, Vec<Vec<f64>>)>, primitives: u32, most: f64) -> Result<Self, TerrainError> {
        for (kind, axes) in &kinds {
            if axes.len() != kind.attributes.len() {
                let expected = format!("values for {} attributes", kind.attributes.len());
                return Err(TerrainError::range(format!("`{}`", kind.id), expected, axes.len() as f64));
            }
        }
        let enumeration = Self { kinds, primitives };
        let count = enumeration.count();
        if count <= most { Ok(enumeration) } else { Err(TerrainError::TooMany { count, limit: most }) }
    }
    /// Number of different primitives: the sum over the types.
    pub fn different(&self) -> f64 {
        self.kinds.iter().map(|(_, axes)| axes.iter().map(|axis| axis.len() as f64).product::<f64>()).sum()
    }
    /// Number of environments: the number of different primitives to the power of how many there are in each. (The
    /// source's bound counts one primitive at a time, and is [`Enumeration::different`].)
    pub fn count(&self) -> f64 {
        (0..self.primitives).map(|_| self.different()).product()
    }
    /// The primitives of an environment; `None` beyond the last.
    pub fn primitives(&self, number: u64) -> Option<Vec<Primitive>> {
        if number as f64 >= self.count() {
            return None;
        }
        let different = self.different() as u64;
        let mut left = number;
        let mut list: Vec<Primitive> = Vec::with_capacity(self.primitives as usize);
        for _ in 0..self.primitives {
            list.push(self.primitive(left % different)?);
            left /= different;
        }
        list.reverse();
        Some(list)
    }
    fn primitive(&self, mut number: u64) -> Option<Primitive> {
        for (kind, axes) in &self.kinds {
            let count = axes.iter().map(|axis| axis.len() as u64).product();
            if number < count {
                return Some(Primitive { kind: kind.id, values: odometer(axes, number)? });
            }
            number -= count;
        }
        None
    }
}

impl Candidates for Enumeration {
    fn candidate(&self, workspace: &Workspace, _: u64, attempt: u64) -> Result<Option<Construct>, TerrainError> {
        self.primitives(attempt).map(|primitives| construct(workspace.units, &primitives)).transpose()
    }
}

/// What is generated, and how long.
pub struct Generation<'a> {
    /// Where candidates come from.
    pub candidates: &'a dyn Candidates,
    /// Where they are placed.
    pub workspace: &'a Workspace,
    /// What becomes of what lies outside.
    pub placement: Placement,
    /// What makes them feasible.
    pub filter: &'a Combined,
    /// Seed of all draws.
    pub seed: u64,
    /// Number of feasible environments that are wanted.
    pub wanted: u64,
    /// First attempt, from 0: a run can be cut into shards.
    pub first: u64,
    /// Greatest number of attempts.
    pub attempts: u64,
}

/// How many candidates came how far.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counts {
    /// Attempts made.
    pub generated: u64,
    /// Constructs placed.
    pub placed: u64,
    /// Environments that passed the filter.
    pub feasible: u64,
    /// Environments in which the group did what was wanted.
    pub valid: u64,
    /// Why the others did not come so far, and how many.
    pub reasons: BTreeMap<String, u64>,
}

impl Counts {
    /// Share of the candidates that pass the filter; `None` of none.
    pub fn pass_rate(&self) -> Option<f64> {
        (self.generated > 0).then(|| self.feasible as f64 / self.generated as f64)
    }
    /// Tightness: the share that elicits the behaviour, of all generated and of the feasible ones.
    pub fn tightness(&self) -> (Option<f64>, Option<f64>) {
        let share = |of: u64| (of > 0).then(|| self.valid as f64 / of as f64);
        (share(self.generated), share(self.feasible))
    }
    fn reason(&mut self, reason: &str) {
        *self.reasons.entry(reason.to_owned()).or_default() += 1;
    }
}

impl Generation<'_> {
    /// Generates (algorithm 3): places and filters each candidate, asks `validate` of every feasible one whether the
    /// group does in it what is wanted, and hands it to `emit` with the answer.
    ///
    /// # Errors
    /// What candidates and placement refuse; attempts that come to nothing are counted.
    pub fn run(
        &self,
        mut validate: impl FnMut(&Environment) -> bool,
        mut emit: impl FnMut(Environment, bool),
    ) -> Result<Counts, TerrainError> {
        let mut counts = Counts::default();
        let end = self.first.saturating_add(self.attempts);
        for attempt in self.first..end {
            if counts.feasible >= self.wanted {
                break;
            }
            let construct = match self.candidates.candidate(self.workspace, self.seed, attempt) {
                Ok(Some(construct)) => construct,
                Ok(None) => break,
                Err(TerrainError::Unfinished) => {
                    counts.generated += 1;
                    counts.reason("the derivation reached its limit");
                    continue;
                }
                Err(TerrainError::Misfit(what)) => {
                    counts.generated += 1;
                    counts.reason(&what);
                    continue;
                }
                Err(other) => return Err(other),
            };
            counts.generated += 1;
            let Some(environment) = Environment::place(self.workspace, construct, self.placement)? else {
                counts.reason("it does not fit the workspace");
                continue;
            };
            counts.placed += 1;
            let verdict = self.filter.check(&environment.construct, self.workspace);
            if !verdict.pass {
                counts.reason(verdict.reason);
                continue;
            }
            counts.feasible += 1;
            let valid = validate(&environment);
            counts.valid += u64::from(valid);
            emit(environment, valid);
        }
        Ok(counts)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::filters;
    use crate::schemas::dirt::Dirt;
    use crate::workspaces::{self, Stem};
    use crate::{grammars, primitives};

    fn pass() -> Combined {
        Combined::All(Vec::new())
    }

    #[test]
    fn grammar_candidates_are_filtered_until_there_are_enough() {
        let (grammar, field) = (grammars::find("corralling").unwrap(), workspaces::field(None));
        let filter = Combined::One(filters::find("corralling", &[]).unwrap());
        let generation = Generation {
            candidates: &grammar,
            workspace: &field,
            placement: Placement::Keep,
            filter: &filter,
            seed: 3,
            wanted: 40,
            first: 0,
            attempts: 1000,
        };
        let mut kept = Vec::new();
        let counts = generation.run(|e| e.construct.pieces.len() == 8, |e, valid| kept.push((e, valid))).unwrap();
        assert_eq!((counts.feasible, kept.len(), counts.placed), (40, 40, counts.generated));
        assert_eq!(counts.valid, kept.iter().filter(|(_, valid)| *valid).count() as u64);
        assert_eq!(counts.reasons.values().sum::<u64>(), counts.generated - 40);
        assert!(counts.reasons.contains_key("the marker is outside the hull"));
        let (all, feasible) = counts.tightness();
        assert!(all.unwrap() < feasible.unwrap() && counts.pass_rate().unwrap() > 0.3);
        // two shards are the whole
        let mut shards = Vec::new();
        for (first, attempts) in [(0, 30), (30, 1000)] {
            let shard = Generation { first, attempts, wanted: 40 - shards.len() as u64, ..generation };
            shard.run(|_| true, |e, _| shards.push(e)).unwrap();
        }
        assert!(shards.iter().eq(kept.iter().map(|(e, _)| e)));
    }

    #[test]
    fn nothing_and_never() {
        let (grammar, field) = (grammars::find("corralling").unwrap(), workspaces::field(None));
        let never = Combined::Any(Vec::new());
        let generation = Generation {
            candidates: &grammar,
            workspace: &field,
            placement: Placement::Keep,
            filter: &never,
            seed: 3,
            wanted: 1,
            first: 0,
            attempts: 25,
        };
        let counts = generation.run(|_| true, |_, _| ()).unwrap();
        assert_eq!((counts.generated, counts.feasible, counts.tightness()), (25, 0, (Some(0.0), None)));
        assert_eq!(Counts::default().pass_rate(), None);
        let metres = workspaces::arena(10.0);
        assert!(Generation { workspace: &metres, ..generation }.run(|_| true, |_, _| ()).is_err());
    }

    /// G-C: the grid visits each combination once, and finds a valid region that is planted in it.
    #[test]
    fn a_grid_is_complete_at_its_resolution() {
        let junction = workspaces::t_junction(2.0, Stem::South);
        let mut all = std::collections::BTreeSet::new();
        let grid = Grid::new(&Dirt, &[90.0, 1.25, 1e6]).unwrap();
        // angle 4, length 4, one anchor on this grid
        assert_eq!(grid.count(), 16.0);
        for k in 0..16 {
            all.insert(grid.values(k).unwrap().iter().map(|v| v.to_bits()).collect::<Vec<_>>());
        }
        assert_eq!((all.len(), grid.values(16)), (16, None));
        assert_eq!(grid.values(1).unwrap(), [0.0, 1.5, 1.0], "the second parameter runs before the first");
        let filter = pass();
        let generation = Generation {
            candidates: &grid,
            workspace: &junction,
            placement: Placement::Keep,
            filter: &filter,
            seed: 0,
            wanted: u64::MAX,
            first: 0,
            attempts: u64::MAX,
        };
        let planted =
            |e: &Environment| (e.construct.walls()[0].to[0] + 1.0).abs() < 1e-9 && e.construct.material() > 1.0;
        let counts = generation.run(planted, |_, _| ()).unwrap();
        assert_eq!((counts.generated, counts.valid), (16, 6), "two of each four angles keep x");
    }

    /// G-C: a sampler finds a valid region of positive size.
    #[test]
    fn a_grammar_finds_what_is_planted() {
        let (grammar, field) = (grammars::find("splitting").unwrap(), workspaces::field(None));
        let filter = pass();
        let generation = Generation {
            candidates: &grammar,
            workspace: &field,
            placement: Placement::Keep,
            filter: &filter,
            seed: 1,
            wanted: u64::MAX,
            first: 0,
            attempts: 3000,
        };
        // exactly seven walls of which none is long
        let planted = |e: &Environment| {
            e.construct.pieces.len() == 7 && e.construct.walls().iter().all(|wall| wall.length() < 37.0)
        };
        let counts = generation.run(planted, |_, _| ()).unwrap();
        assert!(counts.valid > 10, "{}", counts.valid);
    }

    #[test]
    fn every_environment_of_some_primitives() {
        let wall = primitives::find("wall").unwrap();
        let post = primitives::find("post").unwrap();
        let range = |n: usize| (0..n).map(|k| k as f64).collect::<Vec<_>>();
        let kinds = || {
            vec![
                (wall.clone(), vec![range(11), vec![0.0], range(5), vec![1.0]]),
                (post.clone(), vec![range(3), vec![0.0], vec![0.5]]),
            ]
        };
        let all = Enumeration::new(kinds(), 2, 1e4).unwrap();
        assert_eq!((all.different(), all.count()), (58.0, 3364.0));
        let mut seen = std::collections::BTreeSet::new();
        for k in 0..3364 {
            let two = all.primitives(k).unwrap();
            assert_eq!(two.len(), 2);
            seen.insert(format!("{two:?}"));
        }
        assert_eq!((seen.len(), all.primitives(3364)), (3364, None));
        assert!(Enumeration::new(kinds(), 3, 1e4).is_err());
        assert_eq!(Enumeration::new(kinds(), 0, 1e4).unwrap().primitives(0), Some(vec![]));
        let environment = all.candidate(&workspaces::field(None), 0, 57).unwrap().unwrap();
        assert_eq!(environment.pieces.iter().map(|piece| piece.name.as_str()).collect::<Vec<_>>(), ["wall", "post"]);
    }
}
