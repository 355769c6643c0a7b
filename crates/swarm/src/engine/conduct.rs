//! What a group with a conduct does in a step: which state it is in, and what motion that makes of the law's.

use crate::conduct::{self, Explore, Flee, Hunt, Lead, Rest};
use crate::engine::kernel::View;
use crate::motion::Motion;
use crate::parameters::Scalar;
use core::ops::Range;
use space::random::{Purpose, Stream as DrawStream, unit_vector};
use space::{GroupRange, Vector};

/// Slots of the draws of computation: two for the turn of a walk, its axis, leadership, and two for a heading out of rest.
const TURN: u32 = 3;
const AXIS: u32 = 5;
const BEGIN: u32 = 6;

/// Places of the states in [`conduct::STATES`].
const FORAGE: usize = 0;
const FLEE: usize = 1;
const HUNT: usize = 2;
const REST: usize = 3;
const LEAD: usize = 4;
const EXPLORE: usize = 5;

/// A conduct with the ids and columns it is about.
pub(crate) struct Conduct<R> {
    flee: Option<(Flee<R>, Vec<GroupRange>)>,
    hunt: Option<(Hunt<R>, Vec<GroupRange>)>,
    rest: Option<(Rest<R>, usize)>,
    lead: Option<Lead<R>>,
    explore: Option<Explore<R>>,
    acceleration: Option<R>,
    own: GroupRange,
    /// Places of its columns among those of the body.
    columns: Range<usize>,
}

impl<R: Scalar> Conduct<R> {
    /// Finds groups and columns.
    ///
    /// # Errors
    /// A sentence that names what is not there.
    pub(crate) fn new(
        plan: &conduct::Conduct<R>,
        groups: &[GroupRange],
        own: GroupRange,
        first: usize,
        column: impl Fn(&str) -> Option<usize>,
    ) -> Result<Self, String> {
        plan.check()?;
        let find = |name: &String| {
            groups.iter().find(|group| group.name == *name).cloned().ok_or_else(|| {
                let near = space::spelling::nearest(name, groups.iter().map(|group| group.name.as_str()));
                let help = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                format!("conduct: there is no group `{name}`{help}")
            })
        };
        let all = |names: &Vec<String>| names.iter().map(find).collect::<Result<Vec<_>, _>>();
        let store = |rest: &Rest<R>| {
            column(&rest.column)
                .map(|at| (rest.clone(), at))
                .ok_or_else(|| format!("conduct: rest looks at the column `{}`, which nobody declares", rest.column))
        };
        Ok(Self {
            flee: plan.flee.as_ref().map(|flee| Ok::<_, String>((flee.clone(), all(&flee.from)?))).transpose()?,
            hunt: plan.hunt.as_ref().map(|hunt| Ok::<_, String>((hunt.clone(), all(&hunt.prey)?))).transpose()?,
            rest: plan.rest.as_ref().map(store).transpose()?,
            lead: plan.lead,
            explore: plan.explore,
            acceleration: plan.acceleration,
            own,
            columns: first..first + plan.columns().len(),
        })
    }

    /// Whether an agent with these columns of its body follows its law.
    #[inline(always)]
    pub(crate) fn follows_law(&self, body: &[R]) -> bool {
        body.get(self.columns.start).is_none_or(|&state| state == R::count(FORAGE))
    }

    /// The motion of an agent that its law wants to move as `wanted`; its state is kept among the columns of its body.
    #[inline(never)]
    pub(crate) fn motion<const D: usize>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        wanted: Motion<R, D>,
        dt: R,
        body: &mut [R],
    ) -> Motion<R, D> {
        let own = &mut body[self.columns.clone()];
        let draws = DrawStream::new(view.seed, Purpose::Computation, view.step, view.now.id[row]);
        let velocity = view.now.velocity(row);
        let heading = velocity.unit();
        let threat = self.flee.as_ref().and_then(|(flee, from)| nearest(view, row, from, flee.within));
        let prey = self.hunt.as_ref().and_then(|(hunt, prey)| nearest(view, row, prey, hunt.within));
        let tired = self.rest.as_ref().is_some_and(|(rest, column)| {
            let store = view.now.state[*column][row];
            store >= rest.from || own[0] == R::count(REST) && store >= rest.until
        });
        let (state, aim) = match (&self.flee, &self.hunt, threat, prey) {
            (Some((flee, _)), _, Some(offset), _) => {
                // on top of each other, straight on
                (FLEE, (-offset).unit_or(heading) * flee.speed)
            }
            (_, Some((hunt, _)), None, Some(offset)) => {
                // no farther than the prey
                let speed = if dt > R::ZERO { hunt.speed.least(offset.length() / dt) } else { hunt.speed };
                (HUNT, offset.unit() * speed)
            }
            _ if tired => (REST, Vector::ZERO),
            _ => match self.leads(view, row, heading, dt, &draws, own) {
                Some(speed) => (LEAD, heading * speed),
                None => match self.explores(view, row, velocity, dt, &draws) {
                    Some(aim) => (EXPLORE, aim),
                    None => (FORAGE, Vector::ZERO),
                },
            },
        };
        own[0] = R::count(state);
        if state != LEAD && own.len() > 1 {
            own[1] = R::ZERO;
        }
        if state == FORAGE {
            return wanted;
        }
        let next = match self.acceleration {
            Some(acceleration) => velocity + (aim - velocity).clip(acceleration * dt),
            None => aim,
        };
        Motion::new_velocity(next, dt)
    }

    /// The speed of a leader; none for who does not lead.
    fn leads<const D: usize>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        heading: Vector<R, D>,
        dt: R,
        draws: &DrawStream,
        own: &mut [R],
    ) -> Option<R> {
        let lead = self.lead?;
        let left = own.get_mut(1)?;
        if *left > R::ZERO {
            *left = (*left - dt).most(R::ZERO);
            return Some(lead.speed);
        }
        if heading.is_tiny() {
            return None;
        }
        let place = view.now.position(row);
        let limit = lead.within * lead.within;
        let (mut centre, mut count) = (Vector::<R, D>::ZERO, R::ZERO);
        for id in self.own.first..self.own.first + self.own.count {
            let other = row_of(view, id);
            let offset = view.space.offset(place, view.others.position(other));
            if other != row && !view.dead(view.others, other) && offset.length_squared() < limit {
                centre += offset;
                count += R::ONE;
            }
        }
        if count <= R::ZERO || lead.within <= R::ZERO {
            return None;
        }
        let centre = centre / count;
        let eccentricity = centre.length() / lead.within;
        let may = eccentricity >= lead.least && -centre.dot(heading) > R::ZERO;
        if may && R::of(draws.uniform(BEGIN)) < lead.rate * dt * eccentricity {
            *left = (lead.time - dt).most(R::ZERO);
            return Some(lead.speed);
        }
        None
    }

    /// The velocity of who explores; none where an item is near.
    fn explores<const D: usize>(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        velocity: Vector<R, D>,
        dt: R,
        draws: &DrawStream,
    ) -> Option<Vector<R, D>> {
        let explore = self.explore?;
        let place = view.now.position(row);
        let near = view.resources.and_then(|resources| resources.nearest(view.space, place));
        if near.is_some_and(|(_, offset)| offset.length_squared() < explore.without * explore.without) {
            return None;
        }
        let mut heading = velocity.unit();
        if heading.is_tiny() {
            heading = unit_vector(draws.uniform(TURN), draws.uniform(TURN + 1));
        }
        let angle = explore.turning * dt.root() * R::of(draws.normal(TURN));
        let axis = if D == 3 { R::of(draws.uniform(AXIS)) * R::TAU } else { R::ZERO };
        Some(heading.turned_by(angle, axis) * explore.speed)
    }
}

/// The row of an agent.
fn row_of<R: Scalar, const D: usize>(view: &View<'_, R, D>, id: u32) -> usize {
    view.rows.map_or(id as usize, |rows| rows[id as usize] as usize)
}

/// The way to the nearest living member of some groups that is nearer than a distance; ties go to the lower id.
fn nearest<R: Scalar, const D: usize>(
    view: &View<'_, R, D>,
    row: usize,
    groups: &[GroupRange],
    within: R,
) -> Option<Vector<R, D>> {
    let place = view.now.position(row);
    let (mut least, mut found) = (within * within, None);
    for id in groups.iter().flat_map(|group| group.first..group.first + group.count) {
        let other = row_of(view, id);
        let offset = view.space.offset(place, view.others.position(other));
        let squared = offset.length_squared();
        if squared < least && other != row && !view.dead(view.others, other) {
            (least, found) = (squared, Some(offset));
        }
    }
    found
}
