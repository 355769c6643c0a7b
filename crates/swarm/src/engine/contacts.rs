//! Contacts after everyone's motion: walls and obstacles first, then bodies.

use crate::engine::kernel::{Close, mask_of, minimal_lanes};
use crate::engine::world::{Group, World};
use crate::motion::{BLOCK, WIDEST, dot, splat};
use crate::parameters::Scalar;
use crate::physics::{Contact, Met, capsule, free_of_environment, resolve};
use space::lanes::{Lanes, Mask, Task, level, with_lanes};
use space::{Columns, Edge, LiveGrid, Vector};

/// Bodies are searched by cells from this number on.
const CELLS_FROM: usize = 512;

/// How a body lies.
#[derive(Clone, Copy)]
struct Pose<R, const D: usize> {
    place: Vector<R, D>,
    velocity: Vector<R, D>,
    /// From its place to the front end of its axis; zero where it is round.
    axis: Vector<R, D>,
}

impl<R: Scalar, const D: usize> World<R, D> {
    /// Radius of a body as others meet it.
    fn radius(&self, id: u32) -> R {
        let group = &self.groups[self.group_of(id)];
        if group.meets { group.radius } else { R::ZERO }
    }

    /// Resolves the moves from `now` to `next`, whose rows are in the same order.
    pub(crate) fn resolve_contacts(&mut self) {
        let agents = self.now.len();
        self.met.fill(Met::Nothing);
        let environment = self.space.has_walls() || !self.obstacles.is_empty();
        if environment {
            for row in 0..agents {
                if self.clear[row] {
                    continue;
                }
                let id = self.now.id[row];
                let (place, velocity, met) =
                    self.within_environment(id, row, self.next.position(row), self.next.velocity(row));
                if met != Met::Nothing {
                    self.next.set_position(row, self.space.place(place));
                    self.next.set_velocity(row, velocity);
                    self.met[id as usize] = met;
                }
            }
        }
        let bodies = |contact| self.groups.iter().any(|g| g.meets && g.contact == contact && g.radius > R::ZERO);
        let (refuse, slide) = (bodies(Contact::Refuse), bodies(Contact::Slide));
        if refuse {
            self.refuse_bodies();
        }
        if slide {
            self.push_apart();
        }
        self.stop_steps();
        self.count_collisions();
        if let Some(column) = self.collided {
            for row in 0..agents {
                let met = self.met[self.next.id[row] as usize] != Met::Nothing;
                self.next.state[column][row] = if met { R::ONE } else { R::ZERO };
            }
        }
    }

    /// A move as walls and obstacles let it end, and what was met.
    fn within_environment(
        &self,
        id: u32,
        row: usize,
        to: Vector<R, D>,
        velocity: Vector<R, D>,
    ) -> (Vector<R, D>, Vector<R, D>, Met) {
        let group = &self.groups[self.group_of(id)];
        let from = self.now.position(row);
        // the straight way, also where it leads through a seam
        let to = from + self.space.minimal(to - from);
        if group.half > R::ZERO {
            return self.elongated_within_environment(group, row, to, velocity);
        }
        let out = resolve(group.contact, &self.space, &self.obstacles, from, to, velocity, group.radius);
        (out.place, out.velocity, out.met)
    }

    /// The same for an elongated body: refused, it stays and turns where it can turn; sliding, it is pushed out all along.
    #[cold]
    fn elongated_within_environment(
        &self,
        group: &Group<R, D>,
        row: usize,
        to: Vector<R, D>,
        velocity: Vector<R, D>,
    ) -> (Vector<R, D>, Vector<R, D>, Met) {
        let from = pose(group.half, self.now.position(row), self.now.velocity(row));
        match group.contact {
            Contact::Slide => {
                let out = resolve(group.contact, &self.space, &self.obstacles, from.place, to, velocity, group.radius);
                let (place, met) = self.pushed_out(group, pose(group.half, out.place, out.velocity));
                (place, out.velocity, if out.met == Met::Nothing { met } else { out.met })
            }
            Contact::Refuse => {
                let moved = pose(group.half, to, velocity);
                let met = self.in_the_way(group, from, moved);
                if met == Met::Nothing {
                    return (to, velocity, met);
                }
                let turned = Pose { place: from.place, ..moved };
                let turns = self.in_the_way(group, from, turned) == Met::Nothing;
                (from.place, if turns { velocity } else { from.velocity }, met)
            }
            Contact::Free | Contact::Reflect | Contact::Clamp => (to, velocity, Met::Nothing),
        }
    }

    /// What walls and obstacles stand in the way of a body, all along its axis.
    fn in_the_way(&self, group: &Group<R, D>, from: Pose<R, D>, to: Pose<R, D>) -> Met {
        for along in capsule::points(group.half, group.radius) {
            let share = along / group.half.most(R::TINY);
            let (start, end) = (from.place + from.axis * share, to.place + to.axis * share);
            let met = free_of_environment(&self.space, &self.obstacles, start, end, group.radius);
            if met != Met::Nothing {
                return met;
            }
        }
        Met::Nothing
    }

    /// Where an elongated body comes to lie when it is pushed out of obstacles and walls, and what pushed.
    fn pushed_out(&self, group: &Group<R, D>, body: Pose<R, D>) -> (Vector<R, D>, Met) {
        let (mut place, mut met) = (body.place, Met::Nothing);
        // what pushes out of one obstacle may push into the next; a corner takes two
        for _ in 0..2 {
            let (mut deepest, mut push) = (R::ZERO, Vector::ZERO);
            for along in capsule::points(group.half, group.radius) {
                let point = place + body.axis * (along / group.half);
                self.obstacles.near(point, group.radius, |_, _, near| {
                    let depth = group.radius - near.distance;
                    if depth > deepest {
                        (deepest, push) = (depth, near.away * depth);
                    }
                });
            }
            if deepest <= R::ZERO {
                break;
            }
            met = Met::Obstacle;
            let out = place + push;
            if out.finite() && self.obstacles.first_crossing(place, out).is_none() {
                place = out;
            }
        }
        for a in 0..D {
            if let Edge::Walls(length) = self.space.edges[a] {
                let middle = length * R::HALF;
                let room = group.radius + body.axis[a].abs();
                let within = place[a].clamped(room.least(middle), (length - room).most(middle));
                if within != place[a] {
                    (place.0[a], met) = (within, Met::Wall);
                }
            }
        }
        (place, met)
    }

    /// The shortest way from the axis of a body to that of another, whose centre lies at an offset.
    #[inline(always)]
    fn way(&self, mine: Vector<R, D>, other: u32, velocity: Vector<R, D>, offset: Vector<R, D>) -> Vector<R, D> {
        if self.longest > R::ZERO {
            let half = self.groups[self.group_of(other)].half;
            capsule::between(offset, mine, pose(half, Vector::ZERO, velocity).axis)
        } else {
            offset
        }
    }

    /// Where the velocity is the step made, it is zero after a refused move.
    fn stop_steps(&mut self) {
        for (group, range) in self.groups.iter().zip(&self.ranges) {
            if !group.steps || group.contact != Contact::Refuse {
                continue;
            }
            for id in (range.first..range.first + range.count).map(|id| id as usize) {
                if self.met[id] != Met::Nothing {
                    let row = if self.rows.is_empty() { id } else { self.rows[id] as usize };
                    self.next.set_velocity(row, Vector::ZERO);
                }
            }
        }
    }

    fn count_collisions(&mut self) {
        for &met in &self.met {
            self.met_total[met as usize] += 1;
        }
    }

    /// After a sequential step: counters and the declared column.
    pub(crate) fn note_collisions(&mut self) {
        if !self.contacts {
            return;
        }
        self.count_collisions();
        if let Some(column) = self.collided {
            for row in 0..self.now.len() {
                let met = self.met[row] != Met::Nothing;
                self.now.state[column][row] = if met { R::ONE } else { R::ZERO };
            }
        }
    }

    /// Has decisions note who is close to whom, where moves of bodies of one radius are refused without cells.
    pub(crate) fn note_close(&mut self) {
        let agents = self.now.len();
        let refuse = self.groups.iter().any(|g| g.meets && g.contact == Contact::Refuse && g.radius > R::ZERO);
        if refuse && self.longest == R::ZERO && agents < CELLS_FROM && self.reach.is_none() {
            let blocks = agents.div_ceil(BLOCK);
            self.close = Close { blocks, marks: vec![0; agents * blocks], within: vec![R::ZERO; agents] };
        }
    }

    /// Accepts moves one by one in the order of ids; each is tested against the new places of those before it and the old places of
    /// those after it. Bodies that already touch may move apart.
    fn refuse_bodies(&mut self) {
        let agents = self.now.len();
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius + g.half));
        let same = self.groups.iter().all(|g| g.radius == widest && g.meets);
        let row_of = |rows: &[u32], id: usize| if rows.is_empty() { id } else { rows[id] as usize };
        if agents < CELLS_FROM && same {
            let mut places = core::mem::replace(&mut self.places, core::array::from_fn(|_| Vec::new()));
            for (places, now) in places.iter_mut().zip(&self.now.position) {
                places.clear();
                places.extend_from_slice(&now[..agents]);
                // nobody is where the last vector reaches beyond the rows
                places.resize(now.len(), R::INFINITY);
            }
            let reach = widest + widest;
            with_lanes(level(), RefuseBodies { world: self, places: &mut places, limit: reach * reach });
            self.places = places;
            return;
        }
        // the places that count, in rows: old ones until a move is accepted
        let mut places = self.now.clone();
        let mut cells = LiveGrid::new(&self.space, widest + widest, &places);
        for id in 0..agents {
            let row = row_of(&self.rows, id);
            let group = &self.groups[self.group_of(id as u32)];
            if group.contact != Contact::Refuse || !group.meets {
                let to = self.next.position(row);
                places.set_position(row, to);
                if let Some(cells) = &mut cells {
                    cells.follow(row, to);
                }
                continue;
            }
            let from = pose(group.half, self.now.position(row), self.now.velocity(row));
            let mut to = pose(group.half, self.next.position(row), self.next.velocity(row));
            if self.met[id] == Met::Nothing {
                if self.meets_body(row, &from, &to, &places, cells.as_ref()) {
                    self.met[id] = Met::Member;
                    to.place = from.place;
                }
            } else if group.half == R::ZERO {
                continue;
            }
            if group.half > R::ZERO && self.met[id] != Met::Nothing {
                // a body that stays turns where that touches nothing
                let turns = self.in_the_way(group, from, to) == Met::Nothing
                    && !self.meets_body(row, &from, &to, &places, cells.as_ref());
                to.velocity = if turns { to.velocity } else { from.velocity };
                self.next.set_velocity(row, to.velocity);
                places.set_velocity(row, to.velocity);
            }
            if self.met[id] == Met::Nothing {
                places.set_velocity(row, to.velocity);
                places.set_position(row, to.place);
                if let Some(cells) = &mut cells {
                    cells.follow(row, to.place);
                }
            } else {
                self.next.set_position(row, from.place);
            }
        }
    }

    /// Whether a body that comes to lie so touches another, in the poses that count, which it does not move away from; one that
    /// stays where it is may touch whom it touched.
    fn meets_body(
        &self,
        row: usize,
        from: &Pose<R, D>,
        to: &Pose<R, D>,
        places: &Columns<R, D>,
        cells: Option<&LiveGrid<R, D>>,
    ) -> bool {
        let group = &self.groups[self.group_of(self.now.id[row])];
        let (radius, stays) = (group.radius, group.half > R::ZERO && from.place == to.place);
        let mut touched = false;
        let mut test = |other: usize, offset: Vector<R, D>| {
            if other != row {
                let (id, velocity) = (self.now.id[other], places.velocity(other));
                let reach = radius + self.radius(id);
                let after = self.way(to.axis, id, velocity, offset).length_squared();
                if after < reach * reach {
                    let offset = self.space.offset(from.place, places.position(other));
                    let before = self.way(from.axis, id, velocity, offset).length_squared();
                    touched |= after < before || (after == before && !stays);
                }
            }
        };
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius + g.half));
        let searched =
            cells.is_some_and(|cells| cells.within(to.place, widest + widest, |o, offset, _| test(o as usize, offset)));
        if !searched {
            for other in 0..self.now.len() {
                test(other, self.space.offset(to.place, places.position(other)));
            }
        }
        touched
    }

    /// Whether a move would end in contact with a body that it does not move away from.
    fn touches(&self, row: usize, places: &[Vec<R>; D], limit: R) -> bool {
        (0..self.now.len()).any(|other| other != row && self.touches_other(row, other, places, limit))
    }

    /// As [`Self::touches`], one other body alone.
    #[inline(always)]
    fn touches_other(&self, row: usize, other: usize, places: &[Vec<R>; D], limit: R) -> bool {
        let mut place = Vector::ZERO;
        for a in 0..D {
            place.0[a] = places[a][other];
        }
        let after = self.space.offset(self.next.position(row), place).length_squared();
        after < limit && after <= self.space.offset(self.now.position(row), place).length_squared()
    }

    /// As [`Self::touches`], those alone that were close before the step.
    #[inline(always)]
    fn touches_close(&self, row: usize, places: &[Vec<R>; D], limit: R) -> bool {
        let blocks = self.close.blocks;
        // four blocks at a time, since most are empty
        let (fours, rest) = self.close.marks[row * blocks..(row + 1) * blocks].as_chunks::<4>();
        let touches = |first: usize, mut bits: u64| {
            while bits != 0 {
                if self.touches_other(row, first * BLOCK + bits.trailing_zeros() as usize, places, limit) {
                    return true;
                }
                bits &= bits - 1;
            }
            false
        };
        for (four, &[a, b, c, d]) in fours.iter().enumerate() {
            let [a, b, c, d] = [a, b, c, d].map(u64::from);
            if touches(4 * four, a | b << BLOCK | c << (2 * BLOCK) | d << (3 * BLOCK)) {
                return true;
            }
        }
        let first = 4 * fours.len();
        rest.iter().enumerate().any(|(block, &bits)| touches(first + block, u64::from(bits)))
    }

    /// So close together two must be before the step to touch after it, whoever they are and however they move.
    #[inline(always)]
    fn closest<L: Lanes<R>>(&self, reach: R) -> R {
        let mut farthest = L::splat(R::ZERO);
        let (now, next) = (&self.now.position, &self.next.position);
        for first in (0..self.now.len()).step_by(L::WIDTH) {
            let mut moved = [farthest; D];
            for a in 0..D {
                let step = L::load(&next[a][first..]) - L::load(&now[a][first..]);
                moved[a] = minimal_lanes(&self.space, a, step);
            }
            let there = L::Mask::from_bits(mask_of(self.now.len() - first));
            farthest = L::choose(there, farthest.greater(dot(&moved, &moved)), farthest);
        }
        let mut each = [R::ZERO; WIDEST];
        farthest.store(&mut each);
        let farthest = each.into_iter().fold(R::ZERO, R::most).root();
        (reach + farthest + farthest) * R::of(1.000_001)
    }

    /// Pushes overlapping bodies apart by half the overlap each, never through a wall.
    fn push_apart(&mut self) {
        let agents = self.now.len();
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius + g.half));
        self.push.clear();
        self.push.resize(agents, Vector::ZERO);
        let cells = if agents >= 64 { LiveGrid::new(&self.space, widest + widest, &self.next) } else { None };
        let mut push = core::mem::take(&mut self.push);
        for row in 0..agents {
            let id = self.next.id[row];
            let group = &self.groups[self.group_of(id)];
            if group.contact != Contact::Slide || group.radius <= R::ZERO || !group.meets {
                continue;
            }
            let place = self.next.position(row);
            let axis = pose(group.half, place, self.next.velocity(row)).axis;
            let mut sum = Vector::ZERO;
            let mut test = |other: u32, offset: Vector<R, D>| {
                let j = self.next.id[other as usize];
                let reach = group.radius + self.radius(j);
                let way = self.way(axis, j, self.next.velocity(other as usize), offset);
                let distance = way.length();
                if j != id && self.radius(j) > R::ZERO && distance < reach {
                    // bodies that lie across each other part as their centres do, coincident ones along the first axis, by their ids
                    let away = if distance > R::TINY {
                        -(way / distance)
                    } else if offset.length() > R::TINY {
                        -offset.unit()
                    } else {
                        Vector::axis(0) * if id < j { -R::ONE } else { R::ONE }
                    };
                    sum += away * ((reach - distance) * R::HALF);
                }
            };
            let searched = cells
                .as_ref()
                .is_some_and(|cells| cells.within(place, widest + widest, |other, offset, _| test(other, offset)));
            if !searched {
                for other in 0..agents {
                    test(other as u32, self.space.offset(place, self.next.position(other)));
                }
            }
            push[row] = sum;
        }
        for row in 0..agents {
            if push[row] == Vector::ZERO {
                continue;
            }
            let id = self.next.id[row];
            let group = &self.groups[self.group_of(id)];
            let (from, place) = (self.now.position(row), self.next.position(row));
            let to = place + push[row];
            let straight = from + self.space.minimal(self.space.place(to) - from);
            self.met[id as usize] = Met::Member;
            let body = pose(group.half, place, self.next.velocity(row));
            let free = self.in_the_way(group, body, Pose { place: to, ..body }) == Met::Nothing
                && self.obstacles.first_crossing(from, straight).is_none();
            if free {
                self.next.set_position(row, self.space.place(to));
            }
        }
        self.push = push;
    }

    /// One move in a sequential step: against the environment and everyone's newest place.
    pub(crate) fn resolve_one(
        &mut self,
        row: usize,
        to: Vector<R, D>,
        velocity: Vector<R, D>,
    ) -> (Vector<R, D>, Vector<R, D>) {
        let group = &self.groups[self.group_of(row as u32)];
        let (place, mut velocity, mut met) = self.within_environment(row as u32, row, to, velocity);
        let mut place = self.space.place(place);
        if group.contact == Contact::Refuse && group.radius > R::ZERO && group.meets {
            let from = pose(group.half, self.now.position(row), self.now.velocity(row));
            let mut to = pose(group.half, place, velocity);
            if met == Met::Nothing && self.meets_body(row, &from, &to, &self.now, None) {
                met = Met::Member;
                to.place = from.place;
                place = from.place;
            }
            let turns = || {
                self.in_the_way(group, from, to) == Met::Nothing && !self.meets_body(row, &from, &to, &self.now, None)
            };
            if group.half > R::ZERO && met != Met::Nothing && !turns() {
                velocity = from.velocity;
            }
        }
        let stops = group.steps && group.contact == Contact::Refuse && met != Met::Nothing;
        self.met[row] = met;
        (place, if stops { Vector::ZERO } else { velocity })
    }
}

/// How a body of a half axis lies.
#[inline(always)]
fn pose<R: Scalar, const D: usize>(half: R, place: Vector<R, D>, velocity: Vector<R, D>) -> Pose<R, D> {
    let axis = if half > R::ZERO { velocity.unit() * half } else { Vector::ZERO };
    Pose { place, velocity, axis }
}

/// Bodies of one radius: every move, in the order of ids, against all places that count, several at a time.
struct RefuseBodies<'a, R: Scalar, const D: usize> {
    world: &'a mut World<R, D>,
    /// Old places until a move is accepted.
    places: &'a mut [Vec<R>; D],
    limit: R,
}

impl<R: Scalar, const D: usize> Task<R> for RefuseBodies<'_, R, D> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes<R>>(self) {
        let Self { world, places, limit } = self;
        let limits = L::splat(limit);
        let closest = if world.close.blocks > 0 { world.closest::<L>(limit.root()) } else { R::INFINITY };
        let images = world.space.is_periodic();
        for group in 0..world.groups.len() {
            let refuses = world.groups[group].contact == Contact::Refuse;
            let first = world.ranges[group].first as usize;
            for id in first..first + world.ranges[group].count as usize {
                let row = if world.rows.is_empty() { id } else { world.rows[id] as usize };
                if world.met[id] != Met::Nothing {
                    for a in 0..D {
                        places[a][row] = world.next.position[a][row];
                    }
                    continue;
                }
                let to = world.next.position(row);
                let mut touched = false;
                if refuses && world.close.blocks > 0 && world.close.within[row] >= closest {
                    touched = world.touches_close(row, places, limit);
                } else if refuses {
                    // the own old place does not count
                    for places in places.iter_mut() {
                        places[row] = R::INFINITY;
                    }
                    let least = if images {
                        least::<R, L, D, true>(world, places, to)
                    } else {
                        least::<R, L, D, false>(world, places, to)
                    };
                    touched = least.less(limits).any() && world.touches(row, places, limit);
                }
                if touched {
                    let from = world.now.position(row);
                    world.next.set_position(row, from);
                    world.met[id] = Met::Member;
                    for a in 0..D {
                        places[a][row] = from.0[a];
                    }
                } else {
                    for a in 0..D {
                        places[a][row] = to.0[a];
                    }
                }
            }
        }
    }
}

/// Squared distances from a place to the nearest of those that count, among each lane's share of them.
#[inline(always)]
fn least<R: Scalar, L: Lanes<R>, const D: usize, const IMAGES: bool>(
    world: &World<R, D>,
    places: &[Vec<R>; D],
    to: Vector<R, D>,
) -> L {
    let to: [L; D] = splat(to);
    let mut least = L::splat(R::INFINITY);
    for first in (0..world.now.len()).step_by(L::WIDTH) {
        let mut offset = to;
        for a in 0..D {
            offset[a] = L::load(&places[a][first..]) - to[a];
            if IMAGES {
                offset[a] = minimal_lanes(&world.space, a, offset[a]);
            }
        }
        least = least.lesser(dot(&offset, &offset));
    }
    least
}
