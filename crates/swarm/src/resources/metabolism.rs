//! What it costs to live: time, motion against drag, and what drafting saves of it.

use super::{Near, group_of};
use space::{Columns, GroupRange, Real, Space};

/// What it costs to live.
#[derive(Clone, Debug, PartialEq)]
pub struct Metabolism<R> {
    /// Declared column that pays.
    pub energy: String,
    /// Paid per time.
    pub cost: R,
    /// Paid per time and squared speed: the power of a drag that grows with speed.
    pub motion: R,
    /// Who follows others closely saves some of what motion costs.
    pub drafting: Option<Drafting<R>>,
    /// Declared column from which what energy cannot pay is taken; an agent at 0 is dead.
    pub health: String,
    /// Health taken per unpaid unit of energy.
    pub starvation: R,
}

/// Moving aligned behind a member of the own group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drafting<R> {
    /// The one ahead is nearer than this.
    pub within: R,
    /// It lies within this angle of the own heading, rad.
    pub ahead: R,
    /// Its heading differs from the own by no more than this, rad.
    pub aligned: R,
    /// Share of the cost of motion that is saved (0 to 1).
    pub saving: R,
}

impl<R: Real> Default for Metabolism<R> {
    /// One unit of `energy` per time, and one of `health` for each that is missing.
    fn default() -> Self {
        Self {
            energy: "energy".into(),
            cost: R::ONE,
            motion: R::ZERO,
            drafting: None,
            health: "health".into(),
            starvation: R::ONE,
        }
    }
}

impl<R: Real> Metabolism<R> {
    /// What can be known before a world is made.
    ///
    /// # Errors
    /// A sentence that says what does not fit.
    pub(super) fn check(&self) -> Result<(), String> {
        if !(self.motion >= R::ZERO && self.motion.finite()) {
            return Err(format!("the cost of motion of resources must be 0 or more, found {}", self.motion));
        }
        match &self.drafting {
            Some(d) if !(d.within > R::ZERO && d.within.finite()) => {
                Err(format!("the distance of drafting among resources must be more than 0, found {}", d.within))
            }
            Some(d) if !(d.saving >= R::ZERO && d.saving <= R::ONE) => {
                Err(format!("what drafting saves of resources must be from 0 to 1, found {}", d.saving))
            }
            _ => Ok(()),
        }
    }
    /// Takes from every living agent what a step costs.
    pub(super) fn pay<const D: usize>(
        &self,
        (energy, health): (usize, usize),
        space: &Space<R, D>,
        columns: &mut Columns<R, D>,
        groups: &[GroupRange],
        dt: R,
    ) {
        let living = self.cost * dt;
        let saved = match &self.drafting {
            Some(drafting) if self.motion > R::ZERO => drafting.followers(health, space, columns, groups),
            _ => Vec::new(),
        };
        for row in 0..columns.len() {
            if columns.state[health][row] <= R::ZERO {
                continue;
            }
            let mut cost = living;
            if self.motion > R::ZERO {
                let share = match (&self.drafting, saved.get(row)) {
                    (Some(drafting), Some(true)) => R::ONE - drafting.saving,
                    _ => R::ONE,
                };
                cost += self.motion * columns.velocity(row).length_squared() * share * dt;
            }
            let store = columns.state[energy][row];
            let unpaid = (cost - store).most(R::ZERO);
            columns.state[energy][row] = (store - cost).most(R::ZERO);
            let left = columns.state[health][row] - unpaid * self.starvation;
            columns.state[health][row] = left.most(R::ZERO);
        }
    }
}

impl<R: Real> Drafting<R> {
    /// Whether each row follows a living member of its own group closely.
    fn followers<const D: usize>(
        &self,
        health: usize,
        space: &Space<R, D>,
        columns: &Columns<R, D>,
        groups: &[GroupRange],
    ) -> Vec<bool> {
        let near = Near::new(columns, |row| columns.state[health][row] > R::ZERO);
        let (ahead, aligned) = (self.ahead.cos(), self.aligned.cos());
        let limit = self.within * self.within;
        let follows = |row: usize| {
            let heading = columns.velocity(row).unit();
            if heading.is_tiny() {
                return false;
            }
            let own = group_of(groups, columns.id[row]);
            near.any(space, columns, row, self.within, |other| {
                let offset = space.offset(columns.position(row), columns.position(other));
                let squared = offset.length_squared();
                squared < limit
                    && squared > R::ZERO
                    && offset.unit().dot(heading) >= ahead
                    && columns.velocity(other).unit().dot(heading) >= aligned
                    && group_of(groups, columns.id[other]) == own
            })
        };
        (0..columns.len()).map(follows).collect()
    }
}
