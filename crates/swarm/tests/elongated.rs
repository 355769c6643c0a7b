//! Elongated bodies: what they touch, how they are sensed, and that they are reproducible.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use space::obstacles::Obstacle;
use space::random::{Purpose, uniform};
use space::shape::Shape;
use space::{Space, Vector};
use swarm::engine::{Driver, GroupPlan, Order, Placement, Start, World, WorldPlan};
use swarm::parameters::{Value, Values};
use swarm::physics::{Contact, capsule};

const SIDE: f64 = 60.0;

/// Fish of the tank, 6 long and 2 wide, well apart, heading anywhere.
fn fish(count: usize, length: Option<f64>) -> GroupPlan<f64, 3> {
    let mut start = Start { velocity: Some(Vec::new()), ..Start::default() };
    for k in 0..count {
        let at = |n: usize| 8.0 + 11.0 * n as f64;
        start.position.push(Vector([at(k % 5), at(k / 5 % 5), at(k / 25)]));
        let draw = |slot: u32| 2.0 * uniform(5, Purpose::Init, k as u64, slot) - 1.0;
        start.velocity.as_mut().unwrap().push(Vector([draw(0), draw(1), draw(2)]).unit() * 6.0);
    }
    let mut group = GroupPlan::new("fish", "behaviour_selection", Values::new(), count, Placement::Given(start));
    group.length = length;
    group
}

fn tank(group: GroupPlan<f64, 3>) -> WorldPlan<f64, 3> {
    let mut plan = WorldPlan::new(Space::walled([SIDE; 3]), group);
    let ball = Shape::new_ball(Vector([33.0, 33.0, 55.0]), 4.0).unwrap();
    plan.obstacles.push(Obstacle::new(ball));
    plan
}

/// How much two bodies overlap at most, and how far one reaches into a wall or the ball.
fn overlaps(world: &World<f64, 3>, count: u32, half: f64) -> (f64, f64) {
    let axis = |id: u32| world.velocity(id).unit() * half;
    let (mut bodies, mut environment) = (0.0f64, 0.0f64);
    for i in 0..count {
        for j in 0..i {
            let way = capsule::between(world.position(j) - world.position(i), axis(i), axis(j));
            bodies = bodies.max(2.0 - way.length());
        }
        for along in capsule::points(half, 1.0) {
            let point = world.position(i) + axis(i) * (along / half);
            for a in 0..3 {
                environment = environment.max(1.0 - point[a]).max(point[a] - (SIDE - 1.0));
            }
            environment = environment.max(5.0 - (point - Vector([33.0, 33.0, 55.0])).length());
        }
    }
    (bodies, environment)
}

#[test]
fn bodies_that_refuse_never_touch_whatever_the_driver() {
    for driver in [Driver::Synchronous, Driver::Sequential(Order::Random)] {
        let mut plan = tank(fish(100, Some(6.0)));
        plan.driver = driver;
        let mut world = World::new(plan).unwrap();
        let mut refused = 0.0;
        for step in 0..400 {
            world.step();
            let (bodies, environment) = overlaps(&world, 100, 2.0);
            assert!(bodies <= 1e-9, "step {step}: bodies overlap by {bodies}");
            // between two points of an axis, half a radius apart, a ball may reach in by a hair
            assert!(environment <= 1e-9, "step {step}: {environment} deep in a wall or the obstacle");
            for id in 0..100 {
                // a law that keeps its own heading is told of a turn that was refused
                let [theta, phi] = ["theta", "phi"].map(|name| world.state(id, name).unwrap());
                let heading = Vector([phi.cos() * theta.cos(), phi.cos() * theta.sin(), phi.sin()]);
                let apart = (heading * 6.0 - world.velocity(id)).length();
                assert!(apart < 1e-9, "step {step}: {id} moves otherwise than it keeps in mind, by {apart}");
            }
            refused += (0..100).map(|id| world.state(id, "collided").unwrap()).sum::<f64>();
        }
        assert!(refused > 100.0, "{refused} moves were refused: nobody was near anybody");
    }
}

#[test]
fn bodies_that_slide_are_pushed_apart() {
    let mut group = fish(60, Some(6.0));
    group.contact = Some(Contact::Slide);
    let mut world = World::new(tank(group)).unwrap();
    let mut sum = 0.0;
    for _ in 0..300 {
        world.step();
        let (bodies, environment) = overlaps(&world, 60, 2.0);
        assert!(environment < 0.3, "{environment} deep in a wall or the obstacle");
        sum += bodies.max(0.0);
    }
    // each push is half of the overlap, so that some is left where several meet or turn
    assert!(sum / 300.0 < 0.5, "bodies overlap by {} at most, on average", sum / 300.0);
}

#[test]
fn the_same_bits_on_any_number_of_threads_and_after_a_restart() {
    let hash = |threads: usize, steps: u64| {
        let mut plan = tank(fish(120, Some(5.0)));
        plan.threads = threads;
        let mut world = World::new(plan).unwrap();
        world.run(steps);
        world.frame().hash()
    };
    assert_eq!(hash(1, 300), hash(3, 300));
    assert_ne!(hash(1, 300), {
        let mut world = World::new(tank(fish(120, None))).unwrap();
        world.run(300);
        world.frame().hash()
    });
}

#[test]
fn a_body_as_long_as_wide_is_a_round_one() {
    let run = |length| {
        let mut world = World::new(tank(fish(100, length))).unwrap();
        world.run(300);
        world.frame().hash()
    };
    assert_eq!(run(Some(2.0)), run(None));
}

#[test]
fn others_are_sensed_from_axis_to_axis() {
    // far apart by their centres, 1 between the tip of the one and the flank of the other
    let agents = [([10.0, 30.0, 30.0], [6.0, 0.0, 0.0]), ([19.0, 30.0, 30.0], [0.0, 6.0, 0.0])];
    let start = Start {
        position: agents.iter().map(|agent| Vector(agent.0)).collect(),
        velocity: Some(agents.iter().map(|agent| Vector(agent.1)).collect()),
        ..Start::default()
    };
    let behaviour = |length: Option<f64>| {
        let mut group =
            GroupPlan::new("fish", "behaviour_selection", Values::new(), 2, Placement::Given(start.clone()));
        group.length = length;
        let mut world = World::new(WorldPlan::new(Space::walled([SIDE; 3]), group)).unwrap();
        world.step();
        world.state(0, "behaviour").unwrap()
    };
    // 9 between the centres: aligned with; 3 between the axes: avoided
    assert_eq!((behaviour(None), behaviour(Some(14.0))), (1.0, 0.0));
}

#[test]
fn obstacles_are_sensed_from_the_axis() {
    let behaviour = |length: Option<f64>| {
        let start = Start {
            position: vec![Vector([11.0, 30.0, 30.0])],
            velocity: Some(vec![Vector([-6.0, 0.0, 0.0])]),
            ..Start::default()
        };
        let mut group = GroupPlan::new("fish", "behaviour_selection", Values::new(), 1, Placement::Given(start));
        group.length = length;
        let mut world = World::new(WorldPlan::new(Space::walled([SIDE; 3]), group)).unwrap();
        world.step();
        (world.state(0, "o_avoid").unwrap(), world.state(0, "behaviour").unwrap())
    };
    assert_eq!(behaviour(None), (0.0, 3.0));
    assert_eq!(behaviour(Some(16.0)), (1.0, 0.0));
}

#[test]
fn bodies_in_one_place_and_at_rest_are_finite() {
    for contact in [Contact::Refuse, Contact::Slide, Contact::Free] {
        let start = Start {
            position: vec![Vector([30.0; 3]); 6],
            velocity: Some([[0.0; 3], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0]].repeat(2).into_iter().map(Vector).collect()),
            ..Start::default()
        };
        let mut group = GroupPlan::new("fish", "behaviour_selection", Values::new(), 6, Placement::Given(start));
        (group.length, group.contact) = (Some(8.0), Some(contact));
        let mut world = World::new(tank(group)).unwrap();
        world.run(100);
        assert!((0..6).all(|id| world.position(id).finite() && world.velocity(id).finite()), "{contact:?}");
    }
}

#[test]
fn what_cannot_be_elongated_is_refused_with_the_remedy() {
    let problem = |change: &dyn Fn(&mut GroupPlan<f64, 3>)| {
        let mut group = fish(4, Some(6.0));
        change(&mut group);
        World::new(tank(group)).err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert!(problem(&|group| group.length = Some(1.0)).contains("from 2 to 66"), "shorter than wide");
    assert!(problem(&|group| group.length = Some(f64::NAN)).contains("found NaN"));
    assert!(problem(&|group| group.length = Some(67.0)).contains("from 2 to 66"));
    assert!(problem(&|group| group.radius = Some(0.0)).contains("has a radius"));
    assert!(problem(&|group| group.contact = Some(Contact::Reflect)).contains("contact: refuse, slide or free"));
    let hidden = problem(&|group| {
        group.sensing = swarm::engine::Sensing::Ideal(swarm::sensing::Ideal {
            occlusion: swarm::sensing::Occlusion::All,
            ..Default::default()
        });
    });
    assert!(hidden.contains("leave it out, or `length`"), "{hidden}");
    assert_eq!(problem(&|group| drop(group.parameters.insert("N".into(), Value::Number(6.0)))), "");
}
