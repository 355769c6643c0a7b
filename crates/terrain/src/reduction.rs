//! Why choosing an environment for a group is hard: the warehouse problem, made into an environment.
//!
//! In a warehouse, rectangles are to be slid inside a box from their starts to their goals without meeting. Whether they can
//! is PSPACE-hard (Hopcroft, Schwartz and Sharir 1984). The reduction turns time into height: the path of a rectangle is a
//! tunnel in (x, y, z) of its cross-section, and an agent that can only climb its tunnel shows the wanted behaviour, to arrive
//! at its goal, exactly where there is a plan. Its size is linear in agents times steps. This module shows the
//! reduction; it decides small instances alone.
//!
//! **Tunnels climb.** The source does not ask that height strictly increases along a tunnel. Without it a tunnel
//! is no path in time: it could wait at one height while another passes. So it is asked for here.
//!
//! All is exact, in fractions; touching sides are allowed.

use std::cmp::Ordering;
use std::collections::{HashMap, VecDeque};
use std::fmt;

/// A fraction in lowest terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fraction {
    over: i128,
    under: i128,
}

impl From<i64> for Fraction {
    fn from(whole: i64) -> Self {
        Self { over: i128::from(whole), under: 1 }
    }
}

impl Fraction {
    /// A fraction; `None` where the denominator is 0.
    pub fn new(over: i64, under: i64) -> Option<Self> {
        Self::reduced(i128::from(over), i128::from(under))
    }
    fn reduced(over: i128, under: i128) -> Option<Self> {
        let (mut a, mut b) = (over.checked_abs()?, under.checked_abs()?);
        while b != 0 {
            (a, b) = (b, a % b);
        }
        let divisor = if under < 0 { -a } else { a };
        (under != 0).then(|| Self { over: over / divisor, under: under / divisor })
    }
    /// The nearest number in floating point.
    pub fn number(self) -> f64 {
        self.over as f64 / self.under as f64
    }
    // `None` where the terms become too great
    fn plus(self, other: Self) -> Option<Self> {
        let (left, right) = (self.over.checked_mul(other.under)?, other.over.checked_mul(self.under)?);
        Self::reduced(left.checked_add(right)?, self.under.checked_mul(other.under)?)
    }
    fn negative(self) -> Self {
        Self { over: -self.over, ..self }
    }
    fn minus(self, other: Self) -> Option<Self> {
        self.plus(other.negative())
    }
    fn times(self, other: Self) -> Option<Self> {
        Self::reduced(self.over.checked_mul(other.over)?, self.under.checked_mul(other.under)?)
    }
    fn by(self, other: Self) -> Option<Self> {
        Self::reduced(self.over.checked_mul(other.under)?, self.under.checked_mul(other.over)?)
    }
    fn order(self, other: Self) -> Option<Ordering> {
        Some(self.over.checked_mul(other.under)?.cmp(&other.over.checked_mul(self.under)?))
    }
}

impl fmt::Display for Fraction {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.under == 1 { write!(out, "{}", self.over) } else { write!(out, "{}/{}", self.over, self.under) }
    }
}

/// A centre in the plane.
pub type Centre = [Fraction; 2];
/// The centres of all rectangles at each whole time from 0, `[times][rectangles]`.
pub type Plan = Vec<Vec<Centre>>;

/// Rectangles along the axes that are to be slid inside the box from (0, 0) to `size`.
#[derive(Clone, Debug, PartialEq)]
pub struct Warehouse {
    /// The sides of the box.
    pub size: [i64; 2],
    /// The sides of each rectangle, `[rectangles]`.
    pub rectangles: Vec<[i64; 2]>,
    /// Where the centre of each is, `[rectangles]`.
    pub start: Vec<Centre>,
    /// Where it is to be, `[rectangles]`.
    pub goal: Vec<Centre>,
}

/// A straight piece of a tunnel; a wait is vertical. Its cross-section is the rectangle of its agent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TunnelPiece {
    /// Whose it is.
    pub agent: usize,
    /// Its lower end, (x, y, z).
    pub from: [Fraction; 3],
    /// Its upper end.
    pub to: [Fraction; 3],
}

/// What is wrong with tunnels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TunnelFault {
    /// An agent that the instance does not have, or an instance whose lists differ in length.
    Agent(usize),
    /// An agent has no tunnel.
    Missing(usize),
    /// A piece does not begin where the last of its agent ends.
    Apart(usize),
    /// A piece does not climb.
    Level(usize),
    /// The first piece does not begin at the start, at height 0.
    Start(usize),
    /// The last piece does not end at the goal, or not at the height of the others.
    Goal(usize),
    /// A piece leaves the box.
    Outside(usize),
    /// The tunnels of two agents meet.
    Meet(usize, usize),
    /// Numbers too great to be computed with exactly.
    Size,
}

/// The tunnels of a plan: heights are times.
pub fn tunnels(plan: &[Vec<Centre>]) -> Vec<TunnelPiece> {
    let mut pieces = Vec::new();
    for (time, two) in (0i64..).zip(plan.windows(2)) {
        for (agent, (from, to)) in two[0].iter().zip(&two[1]).enumerate() {
            let at = |[x, y]: Centre, z: i64| [x, y, z.into()];
            pieces.push(TunnelPiece { agent, from: at(*from, time), to: at(*to, time + 1) });
        }
    }
    pieces
}

/// Checks that tunnels are what a plan without collisions gives: the pieces of each agent join and climb from its start, at
/// height 0, to its goal, at one height for all; they stay in the box, and no two meet.
///
/// # Errors
/// The first fault found.
pub fn check_tunnels(instance: &Warehouse, pieces: &[TunnelPiece]) -> Result<(), TunnelFault> {
    let agents = instance.rectangles.len();
    if instance.start.len() != agents || instance.goal.len() != agents {
        return Err(TunnelFault::Agent(agents));
    }
    if let Some(piece) = pieces.iter().find(|piece| piece.agent >= agents) {
        return Err(TunnelFault::Agent(piece.agent));
    }
    let top = pieces.iter().rfind(|piece| piece.agent == 0).map(|piece| piece.to[2]);
    for agent in 0..agents {
        let own: Vec<&TunnelPiece> = pieces.iter().filter(|piece| piece.agent == agent).collect();
        let (Some(first), Some(last)) = (own.first(), own.last()) else { return Err(TunnelFault::Missing(agent)) };
        if own.windows(2).any(|two| two[0].to != two[1].from) {
            return Err(TunnelFault::Apart(agent));
        }
        let [x, y] = instance.start[agent];
        if first.from != [x, y, 0.into()] {
            return Err(TunnelFault::Start(agent));
        }
        if last.to[..2] != instance.goal[agent] || Some(last.to[2]) != top {
            return Err(TunnelFault::Goal(agent));
        }
        for piece in own {
            if piece.from[2].order(piece.to[2]).ok_or(TunnelFault::Size)? != Ordering::Less {
                return Err(TunnelFault::Level(agent));
            }
            // the motion is straight: its ends tell
            for end in [piece.from, piece.to] {
                if !inside(instance, agent, [end[0], end[1]]).ok_or(TunnelFault::Size)? {
                    return Err(TunnelFault::Outside(agent));
                }
            }
        }
    }
    for (k, one) in pieces.iter().enumerate() {
        for two in pieces[k + 1..].iter().filter(|two| two.agent != one.agent) {
            if meet(instance, one, two).ok_or(TunnelFault::Size)? {
                return Err(TunnelFault::Meet(one.agent.min(two.agent), one.agent.max(two.agent)));
            }
        }
    }
    Ok(())
}

/// Half the sum of two sides.
fn half(a: i64, b: i64) -> Option<Fraction> {
    Fraction::reduced(i128::from(a) + i128::from(b), 2)
}

/// Whether a rectangle at a place is inside the box.
fn inside(instance: &Warehouse, agent: usize, centre: Centre) -> Option<bool> {
    for axis in 0..2 {
        let reach = half(instance.rectangles[agent][axis], 0)?;
        let (low, high) = (centre[axis].minus(reach)?, centre[axis].plus(reach)?);
        if low.order(0.into())? == Ordering::Less || high.order(instance.size[axis].into())? == Ordering::Greater {
            return Some(false);
        }
    }
    Some(true)
}

/// Whether two pieces have an inner point in common: over the heights they share, the distance of the centres is
/// linear in height, so that along each axis the rectangles overlap in one open interval of heights.
fn meet(instance: &Warehouse, one: &TunnelPiece, two: &TunnelPiece) -> Option<bool> {
    let later = |a: Fraction, b: Fraction| Some(if a.order(b)? == Ordering::Less { b } else { a });
    let earlier = |a: Fraction, b: Fraction| Some(if a.order(b)? == Ordering::Less { a } else { b });
    // an open interval: where it is not empty, it has inner points in common with the closed one of shared heights
    let (mut low, mut high) = (later(one.from[2], two.from[2])?, earlier(one.to[2], two.to[2])?);
    for axis in 0..2 {
        if low.order(high)? != Ordering::Less {
            return Some(false);
        }
        let reach = half(instance.rectangles[one.agent][axis], instance.rectangles[two.agent][axis])?;
        let (at_low, at_high) = (apart(one, two, axis, low)?, apart(one, two, axis, high)?);
        let slope = at_high.minus(at_low)?.by(high.minus(low)?)?;
        if slope == 0.into() {
            let near = at_low.order(reach)? == Ordering::Less && at_low.order(reach.negative())? == Ordering::Greater;
            if !near {
                return Some(false);
            }
            continue;
        }
        let reached = |distance: Fraction| low.plus(distance.minus(at_low)?.by(slope)?);
        let (first, second) = (reached(reach.negative())?, reached(reach)?);
        low = later(low, earlier(first, second)?)?;
        high = earlier(high, later(first, second)?)?;
    }
    Some(low.order(high)? == Ordering::Less)
}

/// Distance of the centres along an axis at a height.
fn apart(one: &TunnelPiece, two: &TunnelPiece, axis: usize, z: Fraction) -> Option<Fraction> {
    at_height(two, axis, z)?.minus(at_height(one, axis, z)?)
}

fn at_height(piece: &TunnelPiece, axis: usize, z: Fraction) -> Option<Fraction> {
    let share = z.minus(piece.from[2])?.by(piece.to[2].minus(piece.from[2])?)?;
    piece.from[axis].plus(share.times(piece.to[axis].minus(piece.from[axis])?)?)
}

/// The way back: where each agent that climbs its tunnel is at each whole height. `None` where some agent has no tunnel
/// at such a height.
pub fn plan_from(agents: usize, pieces: &[TunnelPiece]) -> Option<Plan> {
    let mut plan = Vec::new();
    let top = pieces.iter().map(|piece| piece.to[2]).max_by(|a, b| a.number().total_cmp(&b.number()))?;
    let mut z: i64 = 0;
    while Fraction::from(z).order(top)? != Ordering::Greater {
        let place = |agent: usize| {
            let piece = pieces.iter().filter(|piece| piece.agent == agent).find(|piece| {
                let holds = |a: Fraction, b: Fraction| a.order(b).is_some_and(|order| order != Ordering::Greater);
                holds(piece.from[2], z.into()) && holds(z.into(), piece.to[2])
            })?;
            Some([at_height(piece, 0, z.into())?, at_height(piece, 1, z.into())?])
        };
        plan.push((0..agents).map(place).collect::<Option<Vec<Centre>>>()?);
        z = z.checked_add(1)?;
    }
    Some(plan)
}

/// The behaviour of the reduction: share of the agents that end at their goals. 1 for nobody.
pub fn fitness(instance: &Warehouse, plan: &[Vec<Centre>]) -> f64 {
    let all = instance.goal.len();
    let Some(last) = plan.last() else { return 0.0 };
    let arrived = last.iter().zip(&instance.goal).filter(|(end, goal)| end == goal).count();
    if all == 0 { 1.0 } else { arrived as f64 / all as f64 }
}

/// A shortest plan in unit steps along the axes (or none) of all rectangles at once, by breadth-first search; `None` where
/// there is none, or more than `most` arrangements would have to be looked at.
pub fn solve_small(instance: &Warehouse, most: usize) -> Option<Plan> {
    const STEPS: [[i64; 2]; 5] = [[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]];
    let agents = instance.rectangles.len();
    let begin = instance.start.clone();
    let mut before: HashMap<Vec<Centre>, Option<Vec<Centre>>> = HashMap::from([(begin.clone(), None)]);
    let mut queue = VecDeque::from([begin]);
    while let Some(now) = queue.pop_front() {
        if now == instance.goal {
            let mut plan = vec![now];
            while let Some(Some(previous)) = plan.last().and_then(|last| before.get(last)) {
                plan.push(previous.clone());
            }
            plan.reverse();
            // a plan takes at least one step, so that there are tunnels
            if plan.len() == 1 {
                plan.push(instance.goal.clone());
            }
            return Some(plan);
        }
        for choice in 0..5usize.checked_pow(u32::try_from(agents).ok()?)? {
            let (mut left, mut next) = (choice, Vec::with_capacity(agents));
            for centre in &now {
                let step = STEPS[left % 5];
                left /= 5;
                next.push([centre[0].plus(step[0].into())?, centre[1].plus(step[1].into())?]);
            }
            if !before.contains_key(&next) && moves(instance, &now, &next)? {
                if before.len() >= most {
                    return None;
                }
                before.insert(next.clone(), Some(now.clone()));
                queue.push_back(next);
            }
        }
    }
    None
}

/// Whether all can move at once without meeting or leaving the box.
fn moves(instance: &Warehouse, now: &[Centre], next: &[Centre]) -> Option<bool> {
    let pieces = tunnels(&[now.to_vec(), next.to_vec()]);
    for (agent, centre) in next.iter().enumerate() {
        if !inside(instance, agent, *centre)? {
            return Some(false);
        }
    }
    for (k, one) in pieces.iter().enumerate() {
        for two in &pieces[k + 1..] {
            if meet(instance, one, two)? {
                return Some(false);
            }
        }
    }
    Some(true)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::draws::Draws;

    fn halves(x: i64, y: i64) -> Centre {
        [Fraction::new(x, 2).unwrap(), Fraction::new(y, 2).unwrap()]
    }
    fn warehouse(size: [i64; 2], objects: &[([i64; 2], [i64; 2], [i64; 2])]) -> Warehouse {
        Warehouse {
            size,
            rectangles: objects.iter().map(|object| object.0).collect(),
            start: objects.iter().map(|object| halves(object.1[0], object.1[1])).collect(),
            goal: objects.iter().map(|object| halves(object.2[0], object.2[1])).collect(),
        }
    }

    #[test]
    fn plans_become_tunnels_and_tunnels_plans() {
        let mut solved = 0;
        for attempt in 0..25 {
            let draws = Draws::new(11, attempt, 0);
            let whole = |name: &str, k: usize, below: usize| draws.below(&format!("{name} {k}"), below) as i64;
            let objects: Vec<_> = (0..2 + draws.below("count", 2))
                .map(|k| {
                    let sides = [1 + whole("w", k, 2), 1 + whole("h", k, 2)];
                    let place =
                        |name: &str| [0, 1].map(|a| sides[a] + 2 * whole(name, 2 * k + a, (5 - sides[a]) as usize));
                    (sides, place("start"), place("goal"))
                })
                .collect();
            let instance = warehouse([4, 4], &objects);
            if moves(&instance, &instance.start, &instance.start) != Some(true) {
                continue;
            }
            let Some(plan) = solve_small(&instance, 4_000) else { continue };
            let pieces = tunnels(&plan);
            assert_eq!(check_tunnels(&instance, &pieces), Ok(()));
            assert_eq!(pieces.len(), objects.len() * (plan.len() - 1), "linear in agents and steps");
            let back = plan_from(objects.len(), &pieces).unwrap();
            assert_eq!((fitness(&instance, &back), &back), (1.0, &plan));
            solved += 1;
        }
        assert!(solved >= 6, "{solved}");
    }

    #[test]
    fn two_cannot_swap_in_a_corridor_but_for_a_bay() {
        let corridor = warehouse([4, 1], &[([1, 1], [1, 1], [7, 1]), ([1, 1], [7, 1], [1, 1])]);
        assert_eq!(solve_small(&corridor, 100_000), None);
        // above the corridor stand two shelves that leave a bay between them
        let shelf = |x| ([1, 2], [x, 4], [x, 4]);
        let bay = warehouse([3, 3], &[([1, 1], [1, 1], [5, 1]), ([1, 1], [5, 1], [1, 1]), shelf(1), shelf(5)]);
        let plan = solve_small(&bay, 100_000).unwrap();
        assert_eq!(check_tunnels(&bay, &tunnels(&plan)), Ok(()));
        assert_eq!(fitness(&bay, &plan), 1.0);
        assert_eq!(fitness(&bay, &plan[..1]), 0.5);
    }

    #[test]
    fn every_fault_is_found() {
        let instance = warehouse([4, 2], &[([1, 1], [1, 1], [7, 1]), ([1, 1], [1, 3], [1, 3])]);
        let plan = solve_small(&instance, 10_000).unwrap();
        let good = tunnels(&plan);
        let fault = |change: &dyn Fn(&mut Vec<TunnelPiece>)| {
            let mut pieces = good.clone();
            change(&mut pieces);
            check_tunnels(&instance, &pieces).unwrap_err()
        };
        let last = good.len() - 2;
        assert_eq!(fault(&|p| p.truncate(0)), TunnelFault::Missing(0));
        assert_eq!(fault(&|p| p[0].agent = 9), TunnelFault::Agent(9));
        assert_eq!(fault(&|p| p.retain(|piece| *piece != good[2])), TunnelFault::Apart(0));
        assert_eq!(fault(&|p| p[0].from[0] = 1.into()), TunnelFault::Start(0));
        assert_eq!(fault(&|p| p[last].to[0] = 1.into()), TunnelFault::Goal(0));
        assert_eq!(fault(&|p| p[1].to[2] = 0.into()), TunnelFault::Apart(1));
        let level = |p: &mut Vec<TunnelPiece>| {
            p[1].to[2] = 0.into();
            p[3].from[2] = 0.into();
        };
        assert_eq!(fault(&level), TunnelFault::Level(1));
        let aside = |y: i64| {
            move |p: &mut Vec<TunnelPiece>| {
                p[1].to[1] = Fraction::new(y, 2).unwrap();
                p[3].from[1] = Fraction::new(y, 2).unwrap();
            }
        };
        assert_eq!(fault(&aside(4)), TunnelFault::Outside(1));
        // one that dips into the other's way, and one that only touches it
        let down = warehouse([4, 2], &[([1, 1], [1, 1], [7, 1]), ([1, 1], [3, 3], [3, 3])]);
        let mut plan: Plan = vec![
            vec![halves(1, 1), halves(3, 3)],
            vec![halves(3, 1), halves(3, 3)],
            vec![halves(5, 1), halves(3, 3)],
            vec![halves(7, 1), halves(3, 3)],
        ];
        assert_eq!(check_tunnels(&down, &tunnels(&plan)), Ok(()), "sides may touch");
        plan[1][1] = [Fraction::new(3, 2).unwrap(), Fraction::new(1_499_999, 1_000_000).unwrap()];
        assert_eq!(check_tunnels(&down, &tunnels(&plan)), Err(TunnelFault::Meet(0, 1)));
        let huge = Fraction { over: i128::MAX, under: 3 };
        assert_eq!(
            fault(&|p| {
                p[0].to[1] = huge;
                p[2].from[1] = huge;
            }),
            TunnelFault::Size
        );
    }
}
