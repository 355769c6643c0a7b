//! Resources that agents consume, and what consumption and its lack do to them.

mod metabolism;
mod near;
mod predation;

pub use metabolism::{Drafting, Metabolism};
pub use predation::Predation;

use crate::engine::{mask_of, minimal_lanes};
use crate::motion::{WIDEST, dot};
use near::Near;
use predation::Hunt;
use space::lanes::{Lanes, Mask, Task, level, with_lanes};
use space::obstacles::has_come;
use space::random::{Purpose, uniform, unit_vector};
use space::{Columns, GroupRange, Real, Space, Vector};

/// What a consumed item does to a declared column of its consumer.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain<R> {
    /// Name of the declared column.
    pub column: String,
    /// Added when an item is consumed.
    pub amount: R,
    /// The column is never raised above this.
    pub capacity: R,
}

/// When and where a consumed item comes back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Respawn {
    /// Not at all.
    Never,
    /// After this time (0: at once), uniformly at random in the space.
    After(f64),
}

/// A declared column that all agents of a world have, whatever their models declare.
#[derive(Clone, Debug, PartialEq)]
pub struct Store<R> {
    /// Its name.
    pub column: String,
    /// Its value at the start, in groups whose model does not declare it.
    pub start: R,
}

/// What mates get of a meal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharing<R> {
    /// Living members of the consumer's group that are nearer to it than this get some.
    pub within: R,
    /// Their share of what the consumer gets, each.
    pub share: R,
}

/// The plan of the resources of a world.
#[derive(Clone, Debug, PartialEq)]
pub struct ResourcePlan<R, const D: usize> {
    /// Places of the items at the start.
    pub items: Vec<Vector<R, D>>,
    /// An item closer than this is consumed, by the nearest living agent; ties go to the lower id.
    pub within: R,
    /// What it gives.
    pub gains: Vec<Gain<R>>,
    /// Its return.
    pub respawn: Respawn,
    /// What mates near by get of it.
    pub sharing: Option<Sharing<R>>,
    /// Columns that all agents have.
    pub stores: Vec<Store<R>>,
    /// Cost of living.
    pub metabolism: Option<Metabolism<R>>,
    /// Who harms whom.
    pub predation: Vec<Predation<R>>,
}

impl<R: Real, const D: usize> Default for ResourcePlan<R, D> {
    /// Nothing to consume, and nothing to pay.
    fn default() -> Self {
        Self {
            items: Vec::new(),
            within: R::ZERO,
            gains: Vec::new(),
            respawn: Respawn::Never,
            sharing: None,
            stores: Vec::new(),
            metabolism: None,
            predation: Vec::new(),
        }
    }
}

/// The group of an id.
fn group_of(groups: &[GroupRange], id: u32) -> usize {
    groups.partition_point(|group| group.first + group.count <= id)
}

/// The resources of a running world.
#[derive(Clone, Debug)]
pub struct Resources<R, const D: usize> {
    plan: ResourcePlan<R, D>,
    gains: Vec<usize>,
    energy: usize,
    health: Option<usize>,
    groups: Vec<GroupRange>,
    hunts: Vec<Hunt>,
    /// Place of each item.
    pub place: Vec<Vector<R, D>>,
    /// Time at which an absent item returns; `None` while it is there.
    pub absent_until: Vec<Option<f64>>,
    /// Who consumed each item in the last step.
    pub consumer: Vec<Option<u32>>,
    /// Items consumed since the start.
    pub consumed: u64,
    /// Where consumed items return, supplied by a caller.
    pub respawn_at: Option<Vec<Vector<R, D>>>,
}

impl<R: Real, const D: usize> Resources<R, D> {
    /// Resolves the plan's columns and groups.
    ///
    /// # Errors
    /// A sentence that names a column no model declares, a group that is not there, or a value that cannot be.
    pub fn new(
        plan: ResourcePlan<R, D>,
        groups: &[GroupRange],
        column: impl Fn(&str) -> Option<usize>,
    ) -> Result<Self, String> {
        let find = |name: &str| {
            column(name)
                .ok_or_else(|| {
                    format!(
                        "resources change the column `{name}`, which no model of this world declares; name one that a model \
                         has (`flockworks models ID` lists them), or give a group a model that has it"
                    )
                })
        };
        if plan.within < R::ZERO || !plan.within.finite() {
            return Err(format!("the distance of consumption must be 0 or more, found {}", plan.within));
        }
        if plan.items.iter().any(|item| !item.finite()) {
            return Err("an item's place is not a finite point".into());
        }
        let gains = plan.gains.iter().map(|gain| find(&gain.column)).collect::<Result<_, _>>()?;
        if let Some(sharing) = &plan.sharing
            && ![sharing.within, sharing.share].iter().all(|&value| value >= R::ZERO && value.finite())
        {
            return Err("what mates get of resources must be 0 or more, within a distance of 0 or more".into());
        }
        let (energy, mut health) = match &plan.metabolism {
            Some(m) => {
                m.check()?;
                (find(&m.energy)?, Some(find(&m.health)?))
            }
            None => (0, None),
        };
        for predation in &plan.predation {
            let column = find(&predation.health)?;
            if health.is_some_and(|other| other != column) {
                return Err("resources: metabolism and predation take from different columns of health".into());
            }
            health = Some(column);
        }
        let hunts = plan.predation.iter().map(|predation| predation.resolved(groups)).collect::<Result<_, _>>()?;
        let items = plan.items.len();
        Ok(Self {
            place: plan.items.clone(),
            plan,
            gains,
            energy,
            health,
            groups: groups.to_vec(),
            hunts,
            absent_until: vec![None; items],
            consumer: vec![None; items],
            consumed: 0,
            respawn_at: None,
        })
    }
    /// The column whose zero means death, where agents can die.
    pub fn mortality(&self) -> Option<usize> {
        self.health
    }
    /// The nearest item that is there; ties go to the lower number.
    #[inline]
    pub fn nearest(&self, space: &Space<R, D>, from: Vector<R, D>) -> Option<(u32, Vector<R, D>)> {
        let (mut nearest, mut least) = (usize::MAX, R::INFINITY);
        for (item, &place) in self.place.iter().enumerate() {
            let squared = space.offset(from, place).length_squared();
            // choices, since which item is nearer than those before cannot be foretold
            let nearer = (squared < least) & self.absent_until[item].is_none();
            nearest = if nearer { item } else { nearest };
            least = if nearer { squared } else { least };
        }
        self.place.get(nearest).map(|&place| (nearest as u32, space.offset(from, place)))
    }
    /// For agents abreast, the number of the item that [`Self::nearest`] finds for each; negative where there is none.
    #[inline(always)]
    pub(crate) fn nearest_abreast<L: Lanes<R>>(&self, space: &Space<R, D>, from: &[L; D]) -> L {
        let (mut nearest, mut least) = (L::splat(-R::ONE), L::splat(R::INFINITY));
        for (item, place) in self.place.iter().enumerate() {
            if self.absent_until[item].is_some() {
                continue;
            }
            let mut offset = *from;
            for a in 0..D {
                offset[a] = minimal_lanes(space, a, L::splat(place.0[a]) - from[a]);
            }
            let squared = dot(&offset, &offset);
            let nearer = squared.less(least);
            nearest = L::choose(nearer, L::splat(R::count(item)), nearest);
            least = L::choose(nearer, squared, least);
        }
        nearest
    }
    /// Consumption in item order, then predation, metabolism and death, after everyone moved.
    pub fn update(&mut self, space: &Space<R, D>, columns: &mut Columns<R, D>, seed: u64, step: u64, time: f64, dt: R) {
        for item in 0..self.place.len() {
            self.consumer[item] = None;
            if let Some(until) = self.absent_until[item] {
                if has_come(until, time) {
                    self.absent_until[item] = None;
                }
                continue;
            }
            let limit = self.plan.within * self.plan.within;
            let place = self.place[item];
            let consumer = Consumer { space, columns, place, limit, health: self.health };
            let Some(row) = with_lanes(level(), consumer) else { continue };
            let id = columns.id[row];
            self.feed(columns, row, R::ONE);
            if let Some(sharing) = self.plan.sharing {
                self.share(sharing, space, columns, row);
            }
            self.consumer[item] = Some(id);
            self.consumed += 1;
            let anew = match &self.respawn_at {
                Some(places) => places.get(item).copied().unwrap_or(self.place[item]),
                None => somewhere(space, self.place[item], seed, step, item as u32),
            };
            match self.plan.respawn {
                Respawn::Never => self.absent_until[item] = Some(f64::INFINITY),
                Respawn::After(delay) if delay > 0.0 => {
                    self.absent_until[item] = Some(time + delay);
                    self.place[item] = anew;
                }
                Respawn::After(_) => self.place[item] = anew,
            }
        }
        if let Some(health) = self.health {
            for (predation, hunt) in self.plan.predation.iter().zip(&self.hunts) {
                predation.bite(hunt, health, space, columns, dt);
            }
            if let Some(metabolism) = &self.plan.metabolism {
                metabolism.pay((self.energy, health), space, columns, &self.groups, dt);
            }
        }
    }
    /// Gives a row a share of what an item gives.
    fn feed(&self, columns: &mut Columns<R, D>, row: usize, share: R) {
        for (gain, &column) in self.plan.gains.iter().zip(&self.gains) {
            let value = &mut columns.state[column][row];
            *value = (*value + gain.amount * share).least(gain.capacity.most(*value));
        }
    }
    /// Gives mates near a consumer their share.
    fn share(&self, sharing: Sharing<R>, space: &Space<R, D>, columns: &mut Columns<R, D>, consumer: usize) {
        let own = group_of(&self.groups, columns.id[consumer]);
        let (place, limit) = (columns.position(consumer), sharing.within * sharing.within);
        for row in 0..columns.len() {
            let near = row != consumer
                && group_of(&self.groups, columns.id[row]) == own
                && self.health.is_none_or(|health| columns.state[health][row] > R::ZERO)
                && space.offset(place, columns.position(row)).length_squared() < limit;
            if near {
                self.feed(columns, row, sharing.share);
            }
        }
    }
}

/// The row of the living agent nearest to an item, of those that reach it; ties go to the lower id.
struct Consumer<'a, R, const D: usize> {
    space: &'a Space<R, D>,
    columns: &'a Columns<R, D>,
    place: Vector<R, D>,
    limit: R,
    health: Option<usize>,
}

impl<R: Real, const D: usize> Task<R> for Consumer<'_, R, D> {
    type Output = Option<usize>;
    #[inline(always)]
    fn run<L: Lanes<R>>(self) -> Option<usize> {
        let Self { space, columns, place, limit, health } = self;
        let mut best: Option<(R, u32, usize)> = None;
        for first in (0..columns.len()).step_by(L::WIDTH) {
            let mut offset = [L::splat(R::ZERO); D];
            for a in 0..D {
                let from = L::load(&columns.position[a][first..]);
                offset[a] = minimal_lanes(space, a, L::splat(place.0[a]) - from);
            }
            let squared = dot(&offset, &offset);
            let mut reaching = squared.less(L::splat(limit)).bits() & mask_of(columns.len() - first);
            while reaching != 0 {
                let lane = reaching.trailing_zeros() as usize;
                reaching &= reaching - 1;
                let mut each = [R::ZERO; WIDEST];
                squared.store(&mut each);
                let (row, id) = (first + lane, columns.id[first + lane]);
                let alive = health.is_none_or(|h| columns.state[h][row] > R::ZERO);
                if alive && best.is_none_or(|(least, lower, _)| (each[lane], id) < (least, lower)) {
                    best = Some((each[lane], id, row));
                }
            }
        }
        best.map(|(.., row)| row)
    }
}

/// A place for an item that returns: uniform over bounded axes, around its old place (normal, sd 1) on open ones.
fn somewhere<R: Real, const D: usize>(
    space: &Space<R, D>,
    old: Vector<R, D>,
    seed: u64,
    step: u64,
    item: u32,
) -> Vector<R, D> {
    let draw = |slot: u32| uniform(seed, Purpose::Environment, step, item.wrapping_mul(8).wrapping_add(slot));
    let around: Vector<R, D> = unit_vector(draw(4), draw(5));
    Vector(core::array::from_fn(|a| match space.side(a) {
        Some(side) => side * R::of(draw(a as u32)),
        None => old.0[a] + around.0[a],
    }))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn world() -> (Resources<f64, 2>, Columns<f64, 2>) {
        let plan = ResourcePlan {
            items: vec![Vector([1.0, 0.0]), Vector([50.0, 50.0])],
            within: 5.0,
            gains: vec![Gain { column: "energy".into(), amount: 40.0, capacity: 100.0 }],
            respawn: Respawn::After(0.0),
            metabolism: Some(Metabolism::default()),
            ..ResourcePlan::default()
        };
        let names = ["health", "energy"];
        let resources = Resources::new(plan, &[], |name| names.iter().position(|&n| n == name)).unwrap();
        let mut columns = Columns::new(3, 2);
        columns.state[0][..3].fill(10.0);
        columns.state[1][..3].fill(70.0);
        columns.set_position(1, Vector([2.0, 0.0]));
        columns.set_position(2, Vector([0.0, 0.0]));
        (resources, columns)
    }

    #[test]
    fn the_nearest_living_agent_eats_and_ties_go_to_the_lower_id() {
        let (mut r, mut c) = world();
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 1.0);
        assert_eq!(r.consumer, [Some(0), None], "agents 0 and 1 and 2 are at distance 1: the lowest eats");
        assert_eq!(c.state[1][..3], [99.0, 69.0, 69.0], "capped at capacity, then one unit paid");
        assert_ne!(r.place[0], Vector([1.0, 0.0]), "the item is elsewhere");
        assert!((0..2).all(|a| (0.0..100.0).contains(&r.place[0][a])));
    }

    #[test]
    fn who_cannot_pay_starves_and_the_dead_neither_eat_nor_pay() {
        let (mut r, mut c) = world();
        c.state[1][..3].copy_from_slice(&[0.25, 0.0, 5.0]);
        c.state[0][1] = 0.5;
        c.state[0][0] = 0.0;
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 1.0);
        assert_eq!(r.consumer[0], Some(1), "agent 0 is dead");
        c.state[1][1] = 0.5;
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 1, 1.0, 1.0);
        assert_eq!((c.state[0][1], c.state[1][1]), (0.0, 0.0), "half a unit unpaid takes the last half of health");
        assert_eq!(c.state[1][0], 0.25, "the dead pay nothing");
    }

    fn changed(change: impl FnOnce(&mut ResourcePlan<f64, 2>)) -> (Resources<f64, 2>, Columns<f64, 2>) {
        let (r, mut c) = world();
        let mut plan = r.plan;
        change(&mut plan);
        let group = |name: &str, first, count| GroupRange { name: name.into(), first, count };
        let names = ["health", "energy"];
        let groups = [group("red", 0, 2), group("blue", 2, 1)];
        c.state[0][..3].fill(50.0);
        let find = |name: &str| names.iter().position(|&n| n == name);
        (Resources::new(plan, &groups, find).unwrap(), c)
    }

    #[test]
    fn mates_near_the_eater_get_their_share() {
        let (mut r, mut c) = changed(|plan| {
            plan.metabolism = None;
            plan.gains[0].capacity = 1000.0;
            plan.sharing = Some(Sharing { within: 5.0, share: 0.25 });
        });
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 1.0);
        assert_eq!(r.consumer[0], Some(0));
        assert_eq!(c.state[1][..3], [110.0, 80.0, 70.0], "a mate gets a quarter, the stranger nothing");
        let (mut far, mut c) = changed(|plan| {
            plan.metabolism = None;
            plan.gains[0].capacity = 1000.0;
            plan.sharing = Some(Sharing { within: 1.0, share: 0.25 });
        });
        far.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 1.0);
        assert_eq!(c.state[1][..3], [110.0, 70.0, 70.0]);
    }

    #[test]
    fn motion_costs_and_drafting_saves_some_of_it() {
        let drafting = Drafting { within: 10.0, ahead: 0.5, aligned: 0.5, saving: 0.5 };
        let run = |drafting: Option<Drafting<f64>>, turn: bool| {
            let (mut r, mut c) = changed(|plan| {
                plan.items.clear();
                plan.metabolism = Some(Metabolism { motion: 0.5, drafting, ..Metabolism::default() });
            });
            c.state[1][..3].fill(70.0);
            // 1 follows 0; 2, of the other group, follows both
            c.set_position(0, Vector([20.0, 0.0]));
            c.set_position(1, Vector([15.0, 0.5]));
            c.set_position(2, Vector([10.0, 0.0]));
            let ahead = if turn { Vector([0.0, 2.0]) } else { Vector([2.0, 0.0]) };
            c.set_velocity(0, ahead);
            c.set_velocity(1, Vector([2.0, 0.0]));
            c.set_velocity(2, Vector([2.0, 0.0]));
            r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 1.0);
            [c.state[1][0], c.state[1][1], c.state[1][2]]
        };
        assert_eq!(run(None, false), [67.0; 3], "1 for the time, 0.5 x 4 for the speed");
        assert_eq!(run(Some(drafting), false), [67.0, 68.0, 67.0], "half of it for who follows a mate");
        assert_eq!(run(Some(drafting), true), [67.0; 3], "not behind one who goes elsewhere");
    }

    #[test]
    fn hunters_harm_the_nearest_prey_and_prey_within_reach_hit_back() {
        let (mut r, mut c) = changed(|plan| {
            plan.items.clear();
            plan.metabolism = None;
            plan.predation = vec![Predation {
                hunters: "blue".into(),
                prey: vec!["red".into()],
                health: "health".into(),
                within: 5.0,
                damage: 8.0,
                rebuttal: 3.0,
            }];
        });
        c.set_position(1, Vector([3.0, 0.0]));
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 0, 0.0, 0.5);
        assert_eq!(c.state[0][..3], [46.0, 50.0, 47.0], "the nearest loses 4, the hunter 1.5 for each of two");
        c.state[0][0] = 0.0;
        r.update(&Space::walled([100.0, 100.0]), &mut c, 1, 1, 0.5, 0.5);
        assert_eq!(c.state[0][..3], [0.0, 46.0, 45.5], "the dead are left alone, and harm nobody");
        let text = Resources::new(
            ResourcePlan { predation: r.plan.predation.clone(), ..ResourcePlan::<f64, 2>::default() },
            &[GroupRange { name: "blues".into(), first: 0, count: 1 }],
            |_| Some(0),
        );
        assert!(text.unwrap_err().contains("did you mean `blues`?"));
    }

    #[test]
    fn an_unknown_column_is_named() {
        let (r, _) = world();
        let text = Resources::new(r.plan, &[], |_| None).unwrap_err();
        assert!(text.contains("`energy`"), "{text}");
    }
}
