//! What a trial with a fragment comes to: where members leave the arena, how far they have turned, and what became of the group.

use measure::behaviours::{Membership, blocks::entropy_ratio};
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
        "Change of the standard deviation along the mean way out until then, in shares of the spread at the start.",
    ),
    ("across", "1", "The same across the way out."),
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
        let there: Vec<Point> = self.ways.iter().filter_map(|way| way.get(step)).copied().collect();
        let began: Vec<Point> = self.ways.iter().filter_map(|way| way.first()).copied().collect();
        if there.is_empty() {
            return;
        }
        let sizes = Membership::within(link).sizes(&there);
        let ways = (0..self.ways.len()).filter_map(|member| self.direction(member, step));
        let way = ways.fold(Point::ZERO, |sum, way| sum + way).unit_or(approach);
        let (before, after) = (deviations(&began, approach), deviations(&there, way));
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

/// Standard deviations of points along and across a direction.
fn deviations(points: &[Point], way: Point) -> [f64; 2] {
    [way, way.left()].map(|axis| {
        let first = points.first().map_or(0.0, |point| point.dot(axis));
        let off: Vec<f64> = points.iter().map(|point| point.dot(axis) - first).collect();
        let mean = off.iter().sum::<f64>() / off.len().max(1) as f64;
        (off.iter().map(|off| (off - mean) * (off - mean)).sum::<f64>() / off.len().max(1) as f64).sqrt()
    })
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use space::Vector;

    /// The descriptor of ways of one member each, by their corners, in an arena of radius 4 entered along x.
    fn of(ways: &[&[[f64; 2]]]) -> Descriptor {
        let arena = Arena { centre: Vector([0.0, 0.0]), radius: 4.0, approach: Vector([1.0, 0.0]), link: 1.5 };
        let fine = |way: &[[f64; 2]]| -> Vec<Point> {
            let legs = way.windows(2).flat_map(|two| {
                (0..40).map(move |k| Vector(two[0]) + (Vector(two[1]) - Vector(two[0])) * (f64::from(k) / 40.0))
            });
            legs.chain(way.last().map(|end| Vector(*end))).collect()
        };
        let ways: Vec<Vec<Point>> = ways.iter().map(|way| fine(way)).collect();
        let mut watch = Watch::new(arena, ways.len());
        for step in 0..ways.iter().map(Vec::len).max().unwrap() {
            let now: Vec<Option<Point>> = ways.iter().map(|way| way.get(step).copied()).collect();
            if watch.step(&now) {
                break;
            }
        }
        let mut sum = Sum::default();
        watch.add_to(&mut sum);
        sum.descriptor().unwrap()
    }

    fn number(of: &Descriptor, name: &str) -> f64 {
        of[place(name)]
    }

    #[test]
    fn a_straight_pass_turns_nobody_and_all_go_through() {
        let straight = of(&[&[[-4., 0.], [5., 0.]], &[[-4., 1.], [5., 1.]]]);
        let expected = [("turn", 0.0), ("turn_spread", 0.0), ("through", 1.0), ("groups", 1.0), ("entropy", 0.0)];
        for (name, value) in expected.into_iter().chain([("along", 0.0), ("across", 0.0), ("stay", 0.0)]) {
            assert!(
                number(&straight, name).abs() - value < 1e-12 && number(&straight, name) >= value - 1e-12,
                "{name}"
            );
        }
        // 36 of 40 steps are 8 long and 9 of a diameter of 8: the first beyond the rim
        assert!((number(&straight, "transit") - 36.0 / 8.0).abs() < 0.2);
    }

    #[test]
    fn turns_sides_and_those_who_stay() {
        let corner = of(&[&[[-4., 0.], [0., 0.], [0., 5.]]]);
        assert!((number(&corner, "turn") - 90.0).abs() < 1e-9 && number(&corner, "left") == 1.0);
        let back = of(&[&[[-4., 0.], [0., 0.], [-5., 0.1]]]);
        assert!(number(&back, "back") == 1.0 && number(&back, "turn").abs() > 170.0);
        let stuck = of(&[&[[-4., 0.], [0., 0.]]]);
        assert_eq!((number(&stuck, "stay"), number(&stuck, "through")), (1.0, 0.0));
        let split = of(&[&[[-4., 0.2], [0., 0.2], [0., 5.]], &[[-4., -0.2], [0., -0.2], [0., -5.]]]);
        assert!((number(&split, "turn")).abs() < 1e-9 && (number(&split, "turn_spread") - 90.0).abs() < 1e-9);
        assert_eq!([number(&split, "groups"), number(&split, "entropy"), number(&split, "left")], [2.0, 1.0, 0.5]);
        let narrowed = of(&[&[[-4., 1.], [0., 0.1], [5., 0.1]], &[[-4., -1.], [0., -0.1], [5., -0.1]]]);
        assert!((number(&narrowed, "across") + 0.9).abs() < 1e-9, "{}", number(&narrowed, "across"));
    }

    #[test]
    fn what_is_mirrored_swaps_left_and_right() {
        let ways: [&[[f64; 2]]; 3] = [
            &[[-4., 0.3], [1., 0.], [2., 5.]],
            &[[-4., -0.8], [0.5, -0.2], [-1., -6.]],
            &[[-4., 0.1], [0., 1.], [6., 2.]],
        ];
        let mirrored: Vec<Vec<[f64; 2]>> = ways.iter().map(|way| way.iter().map(|[x, y]| [*x, -y]).collect()).collect();
        let mirrored: Vec<&[[f64; 2]]> = mirrored.iter().map(Vec::as_slice).collect();
        let (one, other) = (of(&ways), of(&mirrored));
        for (name, ..) in NUMBERS {
            let twin = match name {
                "left" => "right",
                "right" => "left",
                same => same,
            };
            let sign = if name == "turn" { -1.0 } else { 1.0 };
            assert!((number(&one, name) - sign * number(&other, twin)).abs() < 1e-9, "{name}");
        }
        assert!(number(&one, "left") > 0.0);
    }
}
