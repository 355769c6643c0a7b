//! What a trial with a fragment comes to: where members leave the arena, how far they have turned, and what became of the group.

use measure::behaviours::blocks::entropy_ratio;
use measure::near::linked;
use space::Space;
use terrain::Point;
use terrain::fragments::turn;

/// Share of the members that have left when the group is compared with its start.
const MOST: f64 = 0.9;
/// Over which share of the arena's radius a direction is taken: a single step says little of a member that wavers.
const STRETCH: f64 = 0.2;

/// Names, units and meanings of the numbers of a descriptor.
pub const NUMBERS: [(&str, &str, &str); 12] = [
    ("turn", "deg", "Mean net turn of members between their approach and their way out, counter-clockwise."),
    ("turn_spread", "deg", "Standard deviation of the net turn over members."),
    ("left", "1", "Share of members that leave on the left of the approach, by quarters of the rim."),
    ("right", "1", "Share that leaves on the right."),
    ("through", "1", "Share that leaves ahead."),
    ("back", "1", "Share that leaves where it came from."),
    ("stay", "1", "Share that does not leave within the trial."),
    ("groups", "1", "Number of groups when nine tenths have left, or at the end."),
    ("entropy", "1", "Entropy of their shares over that of equal ones, then."),
    (
        "along",
        "1",
        "Change of the standard deviation along the mean way of each group until then, in shares of the spread at the start.",
    ),
    ("across", "1", "The same across their ways."),
    ("transit", "steps/length", "Mean number of steps until a member leaves, per diameter of the arena."),
];

/// The numbers of [`NUMBERS`], in order.
pub type Descriptor = [f64; NUMBERS.len()];

/// The place of a number.
pub fn place(name: &str) -> usize {
    NUMBERS.iter().position(|(known, ..)| *known == name).unwrap_or(0)
}

/// The arena of a trial, in the frame of the scenario.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arena {
    /// Its middle.
    pub centre: Point,
    /// Its radius.
    pub radius: f64,
    /// Direction of the approach, a unit vector.
    pub approach: Point,
    /// Distance up to which members are of one group.
    pub link: f64,
}

/// Who watches a trial.
pub struct Watch {
    arena: Arena,
    /// The ways of the members, and the step at which each left.
    ways: Vec<Vec<Point>>,
    entered: Vec<bool>,
    left: Vec<Option<usize>>,
    /// Step at which the group is compared with its start.
    compared: Option<usize>,
}

impl Watch {
    /// Of so many members.
    pub fn new(arena: Arena, members: usize) -> Self {
        let ways = vec![Vec::new(); members];
        Self { arena, ways, entered: vec![false; members], left: vec![None; members], compared: None }
    }
    /// Takes the next moment; whether all have left. Who is not there any more stays where it was last.
    pub fn step(&mut self, positions: &[Option<Point>]) -> bool {
        for (member, position) in positions.iter().enumerate() {
            let way = &mut self.ways[member];
            let Some(at) = position.or(way.last().copied()) else { continue };
            way.push(at);
            if self.left[member].is_some() {
                continue;
            }
            if (at - self.arena.centre).length() <= self.arena.radius {
                self.entered[member] = true;
            } else if self.entered[member] {
                self.left[member] = Some(way.len() - 1);
            }
        }
        let gone = self.left.iter().flatten().count();
        if self.compared.is_none() && gone as f64 >= MOST * positions.len() as f64 {
            self.compared = self.ways.iter().map(Vec::len).max().map(|length| length - 1);
        }
        gone == positions.len()
    }
    /// The direction in which a member came to where it was at a step; none where it has not moved that far.
    fn direction(&self, member: usize, step: usize) -> Option<Point> {
        let way = self.ways[member].get(..=step)?;
        let end = *way.last()?;
        let far = STRETCH * self.arena.radius;
        let from = way.iter().rev().find(|point| (end - **point).length() >= far)?;
        Some((end - *from).unit())
    }
    /// Adds what came of the trial. Members who never came into the arena are left out of what is told of members.
    pub fn add_to(&self, sum: &mut Sum) {
        let Arena { centre, radius, approach, link } = self.arena;
        for member in (0..self.ways.len()).filter(|&member| self.entered[member]) {
            let last = self.ways[member].len() - 1;
            let step = self.left[member].unwrap_or(last);
            let turned = self.direction(member, step).map_or(0.0, |way| turn(approach, way));
            sum.members += 1.0;
            sum.turn += turned;
            sum.turn_squared += turned * turned;
            sum.transit += step as f64 / (2.0 * radius);
            let side = turn(approach, self.ways[member][step] - centre);
            let counted = match self.left[member] {
                None => &mut sum.sides[4],
                Some(_) if side.abs() <= 45.0 => &mut sum.sides[2],
                Some(_) if side.abs() >= 135.0 => &mut sum.sides[3],
                Some(_) if side > 0.0 => &mut sum.sides[0],
                Some(_) => &mut sum.sides[1],
            };
            *counted += 1.0;
        }
        let last = self.ways.iter().map(Vec::len).max().unwrap_or(0).saturating_sub(1);
        let step = self.compared.unwrap_or(last);
        let at = |step: usize| -> (Vec<Point>, Vec<Point>) {
            let there = (0..self.ways.len()).filter_map(|member| Some((member, *self.ways[member].get(step)?)));
            there.map(|(member, place)| (place, self.direction(member, step).unwrap_or(approach))).unzip()
        };
        let ((began, _), (there, ways)) = (at(0), at(step));
        if there.is_empty() {
            return;
        }
        let groups = linked(&Space::open(), &there, link);
        let mut sizes = vec![0; groups.iter().max().map_or(0, |most| most + 1)];
        groups.iter().for_each(|&group| sizes[group] += 1);
        let start = linked(&Space::open(), &began, link);
        let before = deviations(&began, &vec![approach; began.len()], &start);
        let after = deviations(&there, &ways, &groups);
        let spread = (before[0] * before[0] + before[1] * before[1]).sqrt();
        sum.trials += 1.0;
        sum.groups += sizes.len() as f64;
        sum.entropy += entropy_ratio(&sizes);
        if spread > 0.0 {
            sum.along += (after[0] - before[0]) / spread;
            sum.across += (after[1] - before[1]) / spread;
        }
    }
    /// The ways of the members, `[step][member]`.
    pub fn course(&self) -> Vec<Vec<Option<Point>>> {
        let steps = self.ways.iter().map(Vec::len).max().unwrap_or(0);
        (0..steps).map(|step| self.ways.iter().map(|way| way.get(step).copied()).collect()).collect()
    }
}

/// Standard deviations along and across the mean way of each group, about its middle, over all members. That groups go apart is told by
/// their number: how wide each is would be lost in it.
fn deviations(places: &[Point], ways: &[Point], groups: &[usize]) -> [f64; 2] {
    let mut squares = [0.0; 2];
    for group in 0..groups.iter().max().map_or(0, |most| most + 1) {
        let own: Vec<usize> = (0..places.len()).filter(|&member| groups[member] == group).collect();
        let way = own.iter().fold(Point::ZERO, |sum, &member| sum + ways[member]).unit_or(Point::axis(0));
        for (axis, square) in [way, way.left()].into_iter().zip(&mut squares) {
            let first = places[own[0]].dot(axis);
            let off: Vec<f64> = own.iter().map(|&member| places[member].dot(axis) - first).collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            *square += off.iter().map(|off| (off - mean) * (off - mean)).sum::<f64>();
        }
    }
    squares.map(|square| (square / places.len().max(1) as f64).sqrt())
}

/// What trials came to, added up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sum {
    members: f64,
    turn: f64,
    turn_squared: f64,
    sides: [f64; 5],
    transit: f64,
    trials: f64,
    groups: f64,
    entropy: f64,
    along: f64,
    across: f64,
}

impl Sum {
    /// The descriptor; none where nobody came into the arena.
    pub fn descriptor(&self) -> Option<Descriptor> {
        if self.members == 0.0 || self.trials == 0.0 {
            return None;
        }
        let (m, t) = (self.members, self.trials);
        let mean = self.turn / m;
        let [left, right, through, back, stay] = self.sides.map(|count| count / m);
        let spread = (self.turn_squared / m - mean * mean).max(0.0).sqrt();
        let rest = [self.groups / t, self.entropy / t, self.along / t, self.across / t, self.transit / m];
        let [groups, entropy, along, across, transit] = rest;
        Some([mean, spread, left, right, through, back, stay, groups, entropy, along, across, transit])
    }
}
