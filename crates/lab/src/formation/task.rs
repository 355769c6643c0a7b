//! A task: a path with a gate at each corner and a goal at its end, the walls that help, and how far each target has come.

use space::segment::Segment;
use terrain::Point;

/// Room between a wall and the disc in which targets start.
pub const ROOM: f64 = 0.2;
/// A channel is this much wider about the start than it must be, and this long until it is as narrow as it will be.
const MOUTH: f64 = 0.15;
const TAPER: f64 = 0.9;

/// A task.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// Its name.
    pub name: String,
    /// The points of its path; two at least, no two in a row equal.
    pub path: Vec<Point>,
    /// Half the width of its gates.
    pub half_width: f64,
    /// Radius of the disc in which the targets start.
    pub start_radius: f64,
    /// Radius of the goal.
    pub goal_radius: f64,
    /// Whether each wall is there only while it is needed.
    pub timed: bool,
}

/// A wall that is for a leg of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// From its anchored end to its free end.
    pub at: Segment,
    /// Number of the leg, from 0.
    pub leg: usize,
}

impl Wall {
    /// The part of it inside a box; none where that is nothing.
    pub fn within(&self, low: Point, high: Point) -> Option<Self> {
        let (from, step) = (self.at.from, self.at.to - self.at.from);
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            if step[axis] == 0.0 {
                if from[axis] < low[axis] || from[axis] > high[axis] {
                    return None;
                }
                continue;
            }
            let ends = [low, high].map(|end| (end[axis] - from[axis]) / step[axis]);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        let part = Segment { from: from + step * enter, to: from + step * leave };
        (enter < leave).then_some(Self { at: part, leg: self.leg })
    }
}

impl Task {
    /// Number of straight legs.
    pub fn legs(&self) -> usize {
        self.path.len() - 1
    }
    /// The way of a leg, a unit vector.
    pub fn way(&self, leg: usize) -> Point {
        (self.path[leg + 1] - self.path[leg]).unit()
    }
    /// Length of a leg.
    pub fn length(&self, leg: usize) -> f64 {
        (self.path[leg + 1] - self.path[leg]).length()
    }
    /// The last point of the path.
    pub fn goal(&self) -> Point {
        self.path[self.legs()]
    }
    /// The gates: at each corner across the middle of the two ways.
    pub fn gates(&self) -> Vec<Segment> {
        let gate = |corner: usize| {
            let (before, after) = (self.way(corner - 1), self.way(corner));
            let across = (before + after).unit_or(before).left() * self.half_width;
            Segment { from: self.path[corner] - across, to: self.path[corner] + across }
        };
        (1..self.legs()).map(gate).collect()
    }
    /// The point of the path at a distance from its start, and the leg it lies on; the ends are held.
    pub fn along(&self, distance: f64) -> (Point, usize) {
        let mut left = distance.max(0.0);
        for leg in 0..self.legs() {
            if left <= self.length(leg) || leg + 1 == self.legs() {
                return (self.path[leg] + self.way(leg) * left.min(self.length(leg)), leg);
            }
            left -= self.length(leg);
        }
        (self.goal(), self.legs() - 1)
    }
    /// The walls in the order in which the path comes by.
    pub fn ordered(&self, walls: &[Wall]) -> Vec<Wall> {
        let place = |wall: &Wall| (wall.at.at(0.5) - self.path[wall.leg]).dot(self.way(wall.leg));
        let mut walls = walls.to_vec();
        walls.sort_by(|a, b| a.leg.cmp(&b.leg).then(place(a).total_cmp(&place(b))));
        walls
    }
    /// Walls on both sides of a leg, as far beside it, from corner to corner, none longer than `longest`; about the start a mouth that
    /// is closed behind.
    pub fn channel(&self, leg: usize, beside: f64, longest: f64) -> Vec<Wall> {
        let (begin, end, way) = (self.path[leg], self.path[leg + 1], self.way(leg));
        // where the lines beside two legs meet
        let mitre = |corner: usize, side: f64| {
            let (before, after) = (self.way(corner - 1).left(), self.way(corner).left());
            self.path[corner] + (before + after) * (side * beside / (1.0 + before.dot(after)).max(0.2))
        };
        let mut lines: Vec<Vec<Point>> = Vec::new();
        for side in [1.0, -1.0] {
            let aside = |width: f64| way.left() * (side * width);
            let mut line = Vec::new();
            if leg > 0 {
                line.push(mitre(leg, side));
            } else {
                let wide = self.start_radius + ROOM + MOUTH;
                if side > 0.0 {
                    lines.push([-1.0, 1.0].map(|side| begin - way * wide + aside(side * wide)).to_vec());
                }
                line.extend([-wide, self.start_radius].map(|along| begin + way * along + aside(wide)));
                if beside < wide {
                    line.push(begin + way * (self.start_radius + TAPER) + aside(beside));
                }
            }
            line.push(if leg + 1 < self.legs() { mitre(leg + 1, side) } else { end + aside(beside) });
            lines.push(line);
        }
        let stretches = lines.iter().flat_map(|line| line.windows(2).map(|ends| (ends[0], ends[1])));
        let cut = |(from, to): (Point, Point)| {
            let count = ((to - from).length() / longest).ceil().max(1.0) as usize;
            let at = move |k: usize| from + (to - from) * (k as f64 / count as f64);
            (0..count).map(move |k| Wall { at: Segment { from: at(k), to: at(k + 1) }, leg })
        };
        stretches.flat_map(cut).collect()
    }
    /// How far beyond a wall, along its leg, a target is: 0 at the line through the wall's farther end, but no later than
    /// `before_end` from the end of the leg.
    pub fn beyond(&self, wall: &Wall, target: Point, before_end: f64) -> f64 {
        let (begin, way) = (self.path[wall.leg], self.way(wall.leg));
        let along = |p: Point| (p - begin).dot(way);
        let exit = along(wall.at.from).max(along(wall.at.to)).min(self.length(wall.leg) - before_end);
        along(target) - exit
    }
}

/// How many gates each target has crossed in their order, and whether it then was at the goal (one more).
#[derive(Clone, Debug)]
pub struct Progress {
    gates: Vec<Segment>,
    goal: (Point, f64),
    before: Vec<Point>,
    /// Gates crossed, `[targets]`; one more at the goal.
    pub done: Vec<usize>,
}

impl Progress {
    /// Of targets that have done nothing yet.
    pub fn new(task: &Task, targets: usize) -> Self {
        let goal = (task.goal(), task.goal_radius);
        Self { gates: task.gates(), goal, before: Vec::new(), done: vec![0; targets] }
    }
    /// Takes the next moment.
    pub fn step(&mut self, targets: &[Point]) {
        for (k, done) in self.done.iter_mut().enumerate() {
            if let Some(&before) = self.before.get(k) {
                while self.gates.get(*done).is_some_and(|gate| gate.passage(before, targets[k]).is_some()) {
                    *done += 1;
                }
            }
            if *done == self.gates.len() && (targets[k] - self.goal.0).length() <= self.goal.1 {
                *done += 1;
            }
        }
        self.before.clear();
        self.before.extend_from_slice(targets);
    }
    /// Share of the targets that have done so many parts.
    pub fn share(&self, parts: usize) -> f64 {
        let through = self.done.iter().filter(|&&done| done >= parts).count();
        through as f64 / self.done.len().max(1) as f64
    }
    /// Whether a target was at the goal.
    pub fn arrived(&self, target: usize) -> bool {
        self.done[target] > self.gates.len()
    }
    /// The leg on which the slower half is: the lower median of what was done.
    pub fn leg(&self) -> usize {
        let mut sorted = self.done.clone();
        sorted.sort_unstable();
        let median = sorted.get(sorted.len().saturating_sub(1) / 2).copied().unwrap_or(0);
        median.min(self.gates.len())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests {
    use super::*;
    use space::Vector;

    pub(crate) fn turn() -> Task {
        Task {
            name: "1".into(),
            path: [[0.0, -4.0], [0.0, 0.0], [-4.0, 0.0]].map(Vector).to_vec(),
            half_width: 1.2,
            start_radius: 0.7,
            goal_radius: 0.9,
            timed: false,
        }
    }

    #[test]
    fn a_gate_lies_across_its_corner() {
        let task = turn();
        let gate = task.gates()[0];
        assert!((gate.length() - 2.4).abs() < 1e-12 && gate.at(0.5).length() < 1e-12);
        // across the way between up and left
        assert!(((gate.to - gate.from).unit().dot(Vector([-1.0, 1.0]).unit())).abs() < 1e-12);
        assert_eq!(task.along(5.0), (Vector([-1.0, 0.0]), 1));
        assert_eq!(task.along(99.0), (Vector([-4.0, 0.0]), 1));
    }

    #[test]
    fn a_channel_has_no_gap_and_leaves_its_path_free() {
        use space::segment::Relation;
        let task = turn();
        for beside in [0.6, 1.2] {
            let legs = [0, 1].map(|leg| task.channel(leg, beside, 3.0));
            let walls: Vec<Wall> = legs.concat();
            assert!(walls.iter().all(|wall| wall.at.length() <= 3.0 + 1e-12));
            // every end but those at the goal is the end of another wall
            let ends: Vec<Point> = walls.iter().flat_map(|wall| [wall.at.from, wall.at.to]).collect();
            let alone = |p: &&Point| ends.iter().filter(|q| (**q - **p).length() < 1e-9).count() == 1;
            let alone: Vec<&Point> = ends.iter().filter(alone).collect();
            assert_eq!(alone.len(), 2);
            assert!(alone.iter().all(|p| (p[0] + 4.0).abs() < 1e-12 && (p[1].abs() - beside).abs() < 1e-12));
            for leg in 0..2 {
                let path = Segment { from: task.path[leg], to: task.path[leg + 1] };
                assert!(walls.iter().all(|wall| wall.at.relation(&path) == Relation::Apart));
            }
            assert!(walls.iter().all(|wall| wall.at.distance(task.path[0]) >= task.start_radius + ROOM));
        }
    }

    #[test]
    fn of_a_wall_stays_what_is_in_a_box() {
        let part = |from, to| {
            let wall = Wall { at: Segment::new(from, to), leg: 1 };
            wall.within(Vector([-1.0, -1.0]), Vector([1.0, 1.0])).map(|wall| wall.at.numbers())
        };
        assert_eq!(part([-3.0, 0.5], [0.0, 0.5]), Some([-1.0, 0.5, 0.0, 0.5]));
        assert_eq!(part([0.0, -2.0], [0.0, 2.0]), Some([0.0, -1.0, 0.0, 1.0]));
        assert_eq!(part([0.2, 0.1], [0.3, 0.4]), Some([0.2, 0.1, 0.3, 0.4]));
        for outside in [[[2.0, 0.0], [3.0, 0.0]], [[-2.0, 1.5], [2.0, 1.5]], [[0.0, 3.0], [3.0, 0.0]]] {
            assert_eq!(part(outside[0], outside[1]), None);
        }
    }

    #[test]
    fn progress_counts_gates_in_order_and_the_goal_last() {
        let task = turn();
        let mut progress = Progress::new(&task, 2);
        let ways: [&[[f64; 2]]; 2] = [
            &[[0.0, -4.0], [0.1, -1.0], [-1.0, 0.5], [-4.0, 0.0]],
            &[[0.0, -4.0], [-4.0, -4.0], [-4.0, 0.0], [-4.0, 0.0]],
        ];
        for k in 0..4 {
            progress.step(&ways.map(|way| Vector(way[k])));
        }
        assert_eq!(progress.done, [2, 0], "the second came by another way");
        assert_eq!([progress.share(2), progress.share(1), progress.share(0)], [0.5, 0.5, 1.0]);
        assert_eq!((progress.arrived(0), progress.arrived(1), progress.leg()), (true, false, 0));
    }

    #[test]
    fn beyond_a_wall_is_beyond_its_farther_end() {
        let task = turn();
        let wall = Wall { at: Segment::new([1.2, -3.0], [0.8, -1.0]), leg: 0 };
        assert_eq!(task.beyond(&wall, Vector([0.0, -0.5]), 0.6), 0.5);
        let late = Wall { at: Segment::new([1.2, -1.0], [0.2, 1.0]), leg: 0 };
        assert!((task.beyond(&late, Vector([0.0, -0.6]), 0.6)).abs() < 1e-12);
        assert_eq!(task.ordered(&[late, wall]), [wall, late]);
    }
}
