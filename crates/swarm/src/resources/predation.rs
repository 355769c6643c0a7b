//! Predation: members of one group harm members of others, and may be harmed by them.

use super::Near;
use space::{Columns, GroupRange, Real, Space};

/// Members of a group that harm members of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Predation<R> {
    /// Name of the group that hunts.
    pub hunters: String,
    /// Names of the groups that it hunts.
    pub prey: Vec<String>,
    /// Declared column from which damage is taken; an agent at 0 is dead.
    pub health: String,
    /// A hunter harms the nearest living prey that is nearer than this.
    pub within: R,
    /// Health taken from it per time.
    pub damage: R,
    /// Health that each living prey within reach takes from the hunter per time.
    pub rebuttal: R,
}

/// Predation with the ids it is about.
#[derive(Clone, Debug)]
pub(super) struct Hunt {
    hunters: GroupRange,
    prey: Vec<GroupRange>,
}

fn among(groups: &[GroupRange], id: u32) -> bool {
    groups.iter().any(|group| id.wrapping_sub(group.first) < group.count)
}

impl<R: Real> Predation<R> {
    /// Finds the groups.
    ///
    /// # Errors
    /// A sentence that names a group that is not there, or a value that cannot be.
    pub(super) fn resolved(&self, groups: &[GroupRange]) -> Result<Hunt, String> {
        for (what, value) in [("distance", self.within), ("damage", self.damage), ("rebuttal", self.rebuttal)] {
            if !(value >= R::ZERO && value.finite()) {
                return Err(format!("the {what} of predation must be 0 or more, found {value}"));
            }
        }
        let find = |name: &String| {
            groups.iter().find(|group| group.name == *name).cloned().ok_or_else(|| {
                let near = space::spelling::nearest(name, groups.iter().map(|group| group.name.as_str()));
                let help = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                format!("predation: there is no group `{name}`{help}")
            })
        };
        Ok(Hunt { hunters: find(&self.hunters)?, prey: self.prey.iter().map(find).collect::<Result<_, _>>()? })
    }
    /// What a step of it does to the health of hunters and prey. Everything is taken at once, from the state before.
    pub(super) fn bite<const D: usize>(
        &self,
        hunt: &Hunt,
        health: usize,
        space: &Space<R, D>,
        columns: &mut Columns<R, D>,
        dt: R,
    ) {
        let alive = |row: usize| columns.state[health][row] > R::ZERO;
        let near = Near::new(columns, |row| alive(row) && among(&hunt.prey, columns.id[row]));
        let limit = self.within * self.within;
        // whole numbers, so that the order does not matter
        let mut bites = vec![0usize; columns.len()];
        let mut rebuttals = vec![0usize; columns.len()];
        let hunters = (0..columns.len())
            .filter(|&row| columns.id[row].wrapping_sub(hunt.hunters.first) < hunt.hunters.count && alive(row));
        for hunter in hunters {
            let mut nearest: Option<(R, u32, usize)> = None;
            near.any(space, columns, hunter, self.within, |prey| {
                let squared = space.offset(columns.position(hunter), columns.position(prey)).length_squared();
                if squared < limit {
                    rebuttals[hunter] += 1;
                    let id = columns.id[prey];
                    if nearest.is_none_or(|(least, lower, _)| (squared, id) < (least, lower)) {
                        nearest = Some((squared, id, prey));
                    }
                }
                false
            });
            if let Some((.., prey)) = nearest {
                bites[prey] += 1;
            }
        }
        for row in 0..columns.len() {
            let harm = R::count(bites[row]) * self.damage + R::count(rebuttals[row]) * self.rebuttal;
            if harm > R::ZERO {
                let left = columns.state[health][row] - harm * dt;
                columns.state[health][row] = left.most(R::ZERO);
            }
        }
    }
}
