//! Contacts after everyone's motion: walls and obstacles first, then bodies.

use crate::engine::world::World;
use crate::parameters::Scalar;
use crate::physics::{Contact, Met, free_of_environment, resolve};
use space::{LiveGrid, Vector};

/// Bodies are searched by cells from this number on.
const CELLS_FROM: usize = 512;

impl<R: Scalar, const D: usize> World<R, D> {
    fn radius(&self, id: u32) -> R {
        self.groups[self.group_of(id)].radius
    }

    /// Resolves the moves from `now` to `next`, whose rows are in the same order.
    pub(crate) fn resolve_contacts(&mut self) {
        let agents = self.now.len();
        self.met.fill(Met::Nothing);
        let environment = self.space.has_walls() || !self.obstacles.is_empty();
        if environment {
            for row in 0..agents {
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
        let bodies = |contact| self.groups.iter().any(|g| g.contact == contact && g.radius > R::ZERO);
        let (refuse, slide) = (bodies(Contact::Refuse), bodies(Contact::Slide));
        if refuse {
            self.refuse_bodies();
        }
        if slide {
            self.push_apart();
        }
        self.count_collisions();
        if let Some(column) = self.collided {
            for row in 0..agents {
                let met = self.met[self.next.id[row] as usize] != Met::Nothing;
                self.next.state[column][row] = if met { R::ONE } else { R::ZERO };
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

    /// Accepts moves one by one in the order of ids; each is tested against the new places of those before it and the old places of
    /// those after it. Bodies that already touch may move apart.
    fn refuse_bodies(&mut self) {
        let agents = self.now.len();
        let widest = self.groups.iter().fold(R::ZERO, |w, g| w.most(g.radius));
        let same = self.groups.iter().all(|g| g.radius == widest);
        let row_of = |rows: &[u32], id: usize| if rows.is_empty() { id } else { rows[id] as usize };
        if agents < CELLS_FROM && same && self.rows.is_empty() {
            let limit = (widest + widest).squared();
            for id in 0..agents {
                if self.met[id] != Met::Nothing || self.groups[self.group_of(id as u32)].contact != Contact::Refuse {
                    continue;
                }
                let to = self.next.position(id);
                let touches = |columns: &space::Columns<R, D>, others: core::ops::Range<usize>| {
                    // a plain pass first: nearly always nobody is near
                    let near =
                        others.clone().any(|j| self.space.offset(to, columns.position(j)).length_squared() < limit);
                    near && others.into_iter().any(|j| {
                        let after = self.space.offset(to, columns.position(j)).length_squared();
                        let before = self.space.offset(self.now.position(id), columns.position(j)).length_squared();
                        after < limit && after <= before
                    })
                };
                if touches(&self.next, 0..id) || touches(&self.now, id + 1..agents) {
                    let from = self.now.position(id);
                    self.next.set_position(id, from);
                    self.met[id] = Met::Member;
                }
            }
            return;
        }
        // the places that count, in rows: old ones until a move is accepted
        let mut places = self.now.clone();
        let mut cells = LiveGrid::new(&self.space, widest + widest, &places);
        for id in 0..agents {
            let row = row_of(&self.rows, id);
            let group = &self.groups[self.group_of(id as u32)];
            if group.contact != Contact::Refuse {
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
            if group.contact != Contact::Slide || group.radius <= R::ZERO {
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
        if group.contact == Contact::Refuse && group.radius > R::ZERO && out.met == Met::Nothing {
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
        (out.place, out.velocity)
    }
}
