//! Finding walls for a task: leg by leg, by trials.
//!
//! Walls are anchored beside the path, on the outer side of a bend among other places (the schema `itb` of the source, of several
//! walls), one alone or two that mirror each other; beside them stand channels along the whole of a leg, which no few walls drawn at
//! random come near. For each leg the best of many candidates are kept that bring the targets through the next
//! gate, those with the least wall first; several partial solutions are followed, so that an early choice can be revised. In the end
//! walls that are not needed are left out.
//! Draws are those of `terrain`: the key is the task's seed, attempt = leg and place in the search, step = candidate.

use super::form::Solver;
use super::task::{ROOM, Task, Wall};
use super::trial::{self, Arena};
use core::cmp::Ordering;
use space::segment::Relation;
use space::{Segment, Vector};
use terrain::{Draws, Point};

/// How many of the first trials' best have further trials.
const FINALISTS: usize = 4;
/// Largest angle between a wall and its leg, degrees.
const LEANING: f64 = 75.0;
/// Where walls are anchored, in shares of the half width beside the path.
const BESIDE: [f64; 4] = [0.5, 0.6, 0.8, 1.0];
/// Channels end this far from the bounds.
const INSIDE: f64 = 0.05;
/// Steps of places along a leg and of lengths.
const STEP: f64 = 0.5;

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The walls.
    pub walls: Vec<Wall>,
    /// Share of targets that reached the goal in the trials of the search.
    pub share: f64,
    /// Trials that the search took.
    pub trials: u64,
}

/// A task to be solved.
pub struct Problem<'a> {
    /// How to search.
    pub solver: &'a Solver,
    /// The task.
    pub task: &'a Task,
    /// Seed of the search.
    pub seed: u64,
    /// An arena of the task without walls.
    pub bare: Arena<'a>,
    /// Seed of a trial of the search.
    pub trial_seed: &'a dyn Fn(usize) -> u64,
}

#[derive(Clone, Debug)]
struct State {
    walls: Vec<Wall>,
    share: f64,
}

impl State {
    fn material(&self) -> f64 {
        self.walls.iter().map(|wall| wall.at.length()).sum()
    }
}

impl Problem<'_> {
    /// Searches; none where it was stopped.
    ///
    /// # Errors
    /// A task that cannot be tried, in a sentence.
    pub fn solve(&self, stop: &dyn Fn() -> bool) -> Result<Option<Solution>, String> {
        let mut trials = 0;
        let mut beam = vec![State { walls: Vec::new(), share: 0.0 }];
        for leg in 0..self.task.legs() {
            let mut found: Vec<State> = Vec::new();
            for (place, state) in beam.iter().enumerate() {
                let Some(share) = self.share(&state.walls, leg, 0, self.solver.further_trials, &mut trials, stop)?
                else {
                    return Ok(None);
                };
                let mut level = vec![State { walls: state.walls.clone(), share }];
                found.extend(level.clone());
                let before = state.walls.len();
                let mut round = 0;
                while let Some(best) = level.first().cloned() {
                    let walls = best.walls.len() - before;
                    if best.share >= self.solver.enough || walls >= self.solver.walls_of_leg {
                        break;
                    }
                    let attempt = ((leg * 64 + place) * 64 + round) as u64;
                    let most = self.solver.walls_of_leg - walls;
                    let Some(next) = self.extended(&best, leg, attempt, most, &mut trials, stop)? else {
                        return Ok(None);
                    };
                    // a wall that does not help is not built
                    level = next.into_iter().filter(|state| state.share > best.share).collect();
                    found.extend(level.clone());
                    round += 1;
                }
            }
            self.rank(&mut found);
            found.dedup_by(|a, b| a.walls == b.walls);
            found.truncate(self.solver.beam);
            beam = found;
        }
        // what was best leg by leg need not be so on the whole: channels from the start to the goal, and nothing at all, are weighed as well
        let last = self.task.legs() - 1;
        let whole = BESIDE.into_iter().map(|beside| {
            let walls = (0..=last).map(|leg| self.channel(leg, beside));
            walls.filter(|walls| walls.len() <= self.solver.walls_of_leg).flatten().collect::<Vec<Wall>>()
        });
        for walls in whole.chain([Vec::new()]) {
            let Some(share) = self.share(&walls, last, 0, self.solver.further_trials, &mut trials, stop)? else {
                return Ok(None);
            };
            beam.push(State { walls, share });
        }
        self.rank(&mut beam);
        let Some(best) = beam.into_iter().next() else { return Ok(None) };
        let Some(best) = self.pruned(best, &mut trials, stop)? else { return Ok(None) };
        Ok(Some(Solution { walls: self.task.ordered(&best.walls), share: best.share, trials }))
    }
    /// The same without walls that are not needed: the longest first, each is left out where as many targets arrive as before, or
    /// enough.
    fn pruned(&self, mut state: State, trials: &mut u64, stop: &dyn Fn() -> bool) -> Result<Option<State>, String> {
        let mut order = state.walls.clone();
        order.sort_by(|a, b| b.at.length().total_cmp(&a.at.length()));
        for wall in order {
            let walls: Vec<Wall> = state.walls.iter().copied().filter(|other| *other != wall).collect();
            let last = self.task.legs() - 1;
            let Some(share) = self.share(&walls, last, 0, self.solver.further_trials, trials, stop)? else {
                return Ok(None);
            };
            if share >= state.share.min(self.solver.enough) {
                state = State { walls, share };
            }
        }
        Ok(Some(state))
    }
    /// Those that are enough first, by the least wall; then the others by their shares.
    fn rank(&self, states: &mut [State]) {
        let enough = |state: &State| state.share >= self.solver.enough;
        states.sort_by(|a, b| match (enough(a), enough(b)) {
            (true, true) => a.walls.len().cmp(&b.walls.len()).then(a.material().total_cmp(&b.material())),
            (false, false) => b.share.total_cmp(&a.share).then(a.material().total_cmp(&b.material())),
            (true, false) => Ordering::Less,
            (false, true) => Ordering::Greater,
        });
    }
    /// The best states with one more wall, or two.
    fn extended(
        &self,
        state: &State,
        leg: usize,
        attempt: u64,
        most: usize,
        trials: &mut u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Vec<State>>, String> {
        let mut tried = Vec::new();
        // a channel makes what stands beside its leg superfluous
        let channels =
            BESIDE.into_iter().map(|beside| self.channel(leg, beside)).filter(|channel| channel.len() <= most);
        let channels = channels.filter(|_| state.walls.iter().all(|wall| wall.leg != leg));
        let drawn = (0..self.solver.candidates)
            .map(|number| self.candidate(leg, most, &Draws::new(self.seed, attempt, number as u64)));
        for added in channels.chain(drawn) {
            if added.is_empty() {
                continue;
            }
            let walls: Vec<Wall> = state.walls.iter().copied().chain(added).collect();
            let Some(share) = self.share(&walls, leg, 0, self.solver.first_trials, trials, stop)? else {
                return Ok(None);
            };
            tried.push(State { walls, share });
        }
        self.rank(&mut tried);
        tried.sort_by(|a, b| b.share.total_cmp(&a.share));
        tried.truncate(FINALISTS);
        for state in &mut tried {
            let (first, further) = (self.solver.first_trials, self.solver.further_trials);
            let Some(share) = self.share(&state.walls, leg, first, further, trials, stop)? else { return Ok(None) };
            state.share = share;
        }
        self.rank(&mut tried);
        Ok(Some(tried))
    }
    /// A channel along a leg, as wide as so many half widths of the path, without what is out of bounds or would stand in the way.
    fn channel(&self, leg: usize, beside: f64) -> Vec<Wall> {
        let inside = |wall: Wall| match self.bare.bounds {
            Some((low, high)) => wall.within(low + Vector([INSIDE; 2]), high - Vector([INSIDE; 2])),
            None => Some(wall),
        };
        let walls = self.task.channel(leg, beside * self.task.half_width, self.solver.longest);
        walls.into_iter().filter_map(inside).filter(|wall| self.fits(wall)).collect()
    }
    /// A candidate: one wall, or two that mirror each other; none where it would stand in the way.
    fn candidate(&self, leg: usize, most: usize, draws: &Draws) -> Vec<Wall> {
        let (task, solver) = (self.task, self.solver);
        let (begin, way) = (task.path[leg], task.way(leg));
        let places = ((task.length(leg) + task.half_width) / STEP).floor() as usize + 1;
        let along = draws.below("along", places) as f64 * STEP - task.half_width;
        let beside = BESIDE[draws.below("beside", BESIDE.len())] * task.half_width;
        let side = if draws.uniform("side", 0) < 0.5 { 1.0 } else { -1.0 };
        let angles = (LEANING / solver.angle_step).floor() as usize;
        // channels along the way are as frequent as all walls that lean
        let leans = draws.uniform("leans", 0) < 0.5;
        let steps = draws.below("angle", 2 * angles + 1) as f64 - angles as f64;
        let lean = if leans { steps * solver.angle_step.to_radians() } else { 0.0 };
        let lengths = ((solver.longest - solver.shortest) / STEP).floor().max(0.0) as usize + 1;
        let length = solver.shortest + STEP * draws.below("length", lengths) as f64;
        let wall = |side: f64| {
            let from = begin + way * along + way.left() * (side * beside);
            let to = from + Vector::at_angle(way.angle() + side * lean) * length;
            Wall { at: Segment { from, to }, leg }
        };
        let two = most > 1 && draws.uniform("two", 0) < 0.5;
        let walls = if two { vec![wall(side), wall(-side)] } else { vec![wall(side)] };
        if walls.iter().all(|wall| self.fits(wall)) { walls } else { Vec::new() }
    }
    /// Whether a wall is inside the bounds, off the start, and off the path (of its own leg, where walls come and go).
    fn fits(&self, wall: &Wall) -> bool {
        let inside = |p: Point| {
            self.bare.bounds.is_none_or(|(low, high)| (0..2).all(|axis| p[axis] >= low[axis] && p[axis] <= high[axis]))
        };
        let off = |leg: usize| {
            let own = Segment { from: self.task.path[leg], to: self.task.path[leg + 1] };
            self.task.timed && leg != wall.leg || own.relation(&wall.at) == Relation::Apart
        };
        inside(wall.at.from)
            && inside(wall.at.to)
            && (0..self.task.legs()).all(off)
            && wall.at.distance(self.task.path[0]) >= self.task.start_radius + ROOM
    }
    /// Share of targets that come through the gate at the end of a leg, over some trials.
    fn share(
        &self,
        walls: &[Wall],
        leg: usize,
        first: usize,
        count: usize,
        trials: &mut u64,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<f64>, String> {
        let whole: f64 = (0..self.task.legs()).map(|leg| self.task.length(leg)).sum();
        let come: f64 = (0..=leg).map(|leg| self.task.length(leg)).sum();
        let mut arena = self.bare.clone();
        arena.walls = self.task.ordered(walls);
        arena.steps = (arena.steps as f64 * come / whole).ceil() as u64;
        arena.parts = Some(leg + 1);
        let mut sum = 0.0;
        for trial in first..first + count {
            *trials += 1;
            // a start that a wall makes impossible is a failure of the wall
            match trial::run(&arena, (self.trial_seed)(trial), stop, &mut |_| ()) {
                Ok(None) => return Ok(None),
                Ok(Some(tried)) => sum += tried.fitness,
                Err(what) if walls.is_empty() => return Err(what),
                Err(_) => {}
            }
        }
        Ok(Some(sum / count as f64))
    }
}
