//! What is wanted stage after stage, and doors that follow what a group does.
#![allow(clippy::unwrap_used, reason = "tests")]

use lab::environment::doors::{Door, Guarded, Moved};
use lab::environment::relay::{Handover, Leg, Relay, when};
use lab::scenario::Obstacle;
use measure::behaviours::{Behaviour, Condition, Moment, Score, Signal};
use space::shape::Shape;
use space::{Segment, Vector};

fn ball(x: f64) -> Shape<f64, 2> {
    Shape::Ball { centre: Vector([x, 0.0]), radius: 1.0 }
}
fn inside(x: f64, share: f64, steps: u64) -> Handover {
    Handover::Inside { region: ball(x), types: Vec::new(), share, steps }
}
fn share(x: f64) -> Behaviour {
    Behaviour { name: "there".into(), score: Score::Share(Signal::ShareIn(ball(x))) }
}
/// Two members that go one unit a step along x, one behind the other.
fn walked(relay: &Relay, steps: usize) -> (Vec<f64>, Vec<u64>, bool) {
    let mut following = relay.follow();
    for step in 0..steps {
        let at = step as f64;
        let positions = [Some(Vector([at, 0.0])), Some(Vector([at - 0.5, 0.0]))];
        let velocity = Some(Vector([1.0, 0.0]));
        following.step(&Moment { positions: &positions, velocities: &[velocity, velocity], types: &[0, 1] });
    }
    let fitness = following.outcomes().iter().map(|outcome| outcome.fitness).collect();
    (fitness, following.handed.iter().map(|state| state.step).collect(), following.settled())
}

#[test]
fn each_stage_begins_where_the_group_is_handed_over() {
    let leg = |x: f64, ends: Option<Handover>| Leg { behaviour: share(x), ends };
    let relay =
        Relay { legs: vec![leg(0.0, Some(inside(5.0, 0.9, 2))), leg(5.0, Some(inside(9.0, 0.5, 1))), leg(9.0, None)] };
    // both are within one of 5 at steps 5 and 6; one is within one of 9 at step 8
    let (fitness, handed, settled) = walked(&relay, 10);
    assert_eq!(handed, [6, 8]);
    assert_eq!(fitness, [0.0, 0.0, 1.0, 0.0], "and the product of all");
    assert!(!settled);
    // half are there where the first ends, and half are at the end
    let ends = when("near", Condition::at_least(Signal::Centroid(0), 3.5));
    let two = Relay { legs: vec![leg(5.0, Some(ends)), leg(9.0, None)] };
    assert_eq!(walked(&two, 9), (vec![0.5, 0.5, 0.25], vec![4], false));
    // frozen where it was handed over: at step 6 both are in the second, which was its first step
    let (fitness, handed, _) = walked(&relay, 7);
    assert_eq!((handed, fitness), (vec![6], vec![0.0, 1.0, 0.0, 0.0]));
    // alone, a stage ends where it would hand over
    let (fitness, handed, settled) = walked(&relay.alone(1), 20);
    assert_eq!((handed, fitness, settled), (vec![8], vec![0.0, 0.0], true));
    let (_, handed, settled) = walked(&relay.alone(0), 3);
    assert_eq!((handed, settled), (vec![], false));
}

#[test]
fn only_those_still_wanted_are_waited_for_and_conditions_may_stand_instead() {
    let wanted = |types: Vec<usize>| Handover::Inside { region: ball(5.0), types, share: 1.0, steps: 1 };
    let first = |ends: Handover| {
        let relay = Relay { legs: vec![Leg { behaviour: share(0.0), ends: Some(ends) }] };
        walked(&relay, 12).1
    };
    assert_eq!((first(wanted(vec![0])), first(wanted(vec![1])), first(wanted(vec![]))), (vec![4], vec![5], vec![5]));
    assert!(first(wanted(vec![7])).is_empty(), "nobody is nobody inside");
    let far = when("far", Condition::at_least(Signal::Centroid(0), 3.0).sustained(2));
    assert_eq!(first(far), [5]);
}

fn beyond(x: f64) -> Option<Behaviour> {
    let score = Score::Binary(Condition::at_least(Signal::Centroid(0), x));
    Some(Behaviour { name: "door".into(), score })
}
fn moved(opens: Option<Behaviour>, shuts: Option<Behaviour>) -> (Vec<Moved>, Vec<Obstacle>) {
    let doors = [Door { wall: Segment::new([0.0, 0.0], [1.0, 0.0]), opens, shuts }];
    let mut guarded = Guarded::new(&doors);
    for step in 0..10 {
        let at = [Some(Vector([f64::from(step), 0.0]))];
        guarded.step(&Moment { positions: &at, velocities: &at, types: &[] }, 0.5 * f64::from(step));
    }
    let written = doors[0].written(guarded.moved.iter().copied());
    (guarded.moved, written)
}

#[test]
fn doors_open_and_shut_once() {
    let times = |list: &[Obstacle]| list.iter().map(|one| (one.appears, one.disappears)).collect::<Vec<_>>();
    let (events, written) = moved(beyond(3.0), None);
    assert_eq!(events, [Moved { door: 0, time: 1.5, shut: false }]);
    assert_eq!(times(&written), [(None, Some(1.5))]);
    let (events, written) = moved(None, beyond(3.0));
    assert_eq!(events, [Moved { door: 0, time: 1.5, shut: true }]);
    assert_eq!(times(&written), [(Some(1.5), None)]);
    // it is open for a step at least
    let (events, written) = moved(beyond(3.0), beyond(2.0));
    assert_eq!(events.len(), 2);
    assert_eq!(times(&written), [(None, Some(1.5)), (Some(2.0), None)]);
    let (events, written) = moved(beyond(30.0), beyond(2.0));
    assert_eq!((events.len(), times(&written)), (0, vec![(None, None)]));
}
