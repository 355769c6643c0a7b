//! Contacts after everyone's motion: walls and obstacles first, then bodies.

use crate::engine::kernel::{Close, mask_of, minimal_lanes};
use crate::engine::world::World;
use crate::motion::{BLOCK, WIDEST, dot, splat};
use crate::parameters::Scalar;
use crate::physics::{Contact, Met, free_of_environment, resolve};
use space::lanes::{Lanes, Mask, Task, level, with_lanes};
use space::{LiveGrid, Vector};

/// Bodies are searched by cells from this number on.
const CELLS_FROM: usize = 512;

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
                let group = &self.groups[self.group_of(id)];
                let from = self.now.position(row);
                // the straight way, also where it leads through a seam
                let to = from + self.space.minimal(self.next.position(row) - from);
                let velocity = self.next.velocity(row);
                let out = resolve(group.contact, &self.space, &self.obstacles, from, to, velocity, group.radius);
                if out.met != Met::Nothing {
                    self.next.set_position(row, self.space.place(out.place));
                    self.next.set_velocity(row, out.velocity);
                    self.met[id as usize] = out.met;
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
        if refuse && agents < CELLS_FROM && self.reach.is_none() {
            let blocks = agents.div_ceil(BLOCK);
            self.close = Close { blocks, marks: vec![0; agents * blocks], within: vec![R::ZERO; agents] };
        }
    }

    /// Accepts moves one by one in the order of ids; each is tested against the new places of those before it and the old places of
    /// those after it. Bodies that already touch may move apart.
    fn refuse_bodies(&mut self) {
        let agents = self.now.len();
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius));
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
            if self.met[id] != Met::Nothing {
                continue;
            }
            let (from, to) = (self.now.position(row), self.next.position(row));
            let mut touched = false;
            let mut test = |other: u32, offset: Vector<R, D>| {
                if other as usize != row {
                    let reach = group.radius + self.radius(self.now.id[other as usize]);
                    let after = offset.length_squared();
                    let before = self.space.offset(from, places.position(other as usize)).length_squared();
                    touched |= after < reach * reach && after <= before;
                }
            };
            let searched = cells
                .as_ref()
                .is_some_and(|cells| cells.within(to, widest + widest, |other, offset, _| test(other, offset)));
            if !searched {
                for other in 0..agents {
                    test(other as u32, self.space.offset(to, places.position(other)));
                }
            }
            if touched {
                self.next.set_position(row, from);
                self.met[id] = Met::Member;
            } else {
                places.set_position(row, to);
                if let Some(cells) = &mut cells {
                    cells.follow(row, to);
                }
            }
        }
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
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius));
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
            let mut sum = Vector::ZERO;
            let mut test = |other: u32, offset: Vector<R, D>| {
                let j = self.next.id[other as usize];
                let reach = group.radius + self.radius(j);
                let distance = offset.length();
                if j != id && self.radius(j) > R::ZERO && distance < reach {
                    // coincident bodies part along the first axis, by their ids
                    let away = if distance > R::TINY {
                        -(offset / distance)
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
            let radius = self.radius(id);
            let (from, place) = (self.now.position(row), self.next.position(row));
            let to = place + push[row];
            let straight = from + self.space.minimal(self.space.place(to) - from);
            self.met[id as usize] = Met::Member;
            let free = free_of_environment(&self.space, &self.obstacles, place, to, radius) == Met::Nothing
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
        let from = self.now.position(row);
        let straight = from + self.space.minimal(to - from);
        let mut out = resolve(group.contact, &self.space, &self.obstacles, from, straight, velocity, group.radius);
        out.place = self.space.place(out.place);
        if group.contact == Contact::Refuse && group.radius > R::ZERO && group.meets && out.met == Met::Nothing {
            let touched = (0..self.now.len()).filter(|&other| other != row).any(|other| {
                let reach = group.radius + self.radius(other as u32);
                let after = self.space.offset(out.place, self.now.position(other)).length_squared();
                let before = self.space.offset(from, self.now.position(other)).length_squared();
                after < reach * reach && after <= before
            });
            if touched {
                out.place = from;
                out.met = Met::Member;
            }
        }
        self.met[row] = out.met;
        if group.steps && group.contact == Contact::Refuse && out.met != Met::Nothing {
            out.velocity = Vector::ZERO;
        }
        (out.place, out.velocity)
    }
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
