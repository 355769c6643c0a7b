//! What any law may have beside itself: taxis, pace, parameters by member, parameters by situation, decisions now and then, one
//! neighbour out of a pool, members that are hidden in part.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use space::obstacles::Obstacle;
use space::shape::Shape;
use space::{Space, Vector};
use swarm::adaptation::{Adaptation, Varied};
use swarm::engine::{Driver, GroupPlan, Order, Placement, Sensing, Start, World, WorldPlan};
use swarm::pace::{Drive, Neighbours, Pace};
use swarm::parameters::{Value, Values};
use swarm::sensing::{Ideal, Occlusion, Pool, PoolWeight};
use swarm::stimulus::{Decay, Field, Stimulus, Taxis};

type State<const D: usize> = ([f64; D], [f64; D]);

fn group<const D: usize>(model: &str, agents: &[State<D>]) -> GroupPlan<f64, D> {
    let start = Start {
        position: agents.iter().map(|agent| Vector(agent.0)).collect(),
        velocity: Some(agents.iter().map(|agent| Vector(agent.1)).collect()),
        ..Start::default()
    };
    GroupPlan::new("fish", model, Values::new(), agents.len(), Placement::Given(start))
}

/// A shoal of the model of the study in its tank.
fn shoal(count: usize) -> WorldPlan<f64, 3> {
    let place = Placement::Uniform { low: Vector([40.0; 3]), high: Vector([70.0; 3]) };
    let fish = GroupPlan::new("fish", "behaviour_selection", Values::new(), count, place);
    let mut plan = WorldPlan::new(Space::walled([110.0; 3]), fish);
    plan.obstacles = vec![Obstacle::new(Shape::new_ball(Vector([20.0, 55.0, 55.0]), 10.0).unwrap())];
    plan
}

fn ran<const D: usize>(plan: WorldPlan<f64, D>, steps: u64) -> World<f64, D>
where
    swarm::models::Models: swarm::models::Catalogue<f64, D>,
{
    let mut world = World::new(plan).unwrap();
    world.run(steps);
    world
}

fn motion(world: &World<f64, 3>) -> Vec<[u64; 6]> {
    (0..world.frame().columns.id.len() as u32)
        .map(|id| {
            let (x, v) = (world.position(id), world.velocity(id));
            [x[0], x[1], x[2], v[0], v[1], v[2]].map(f64::to_bits)
        })
        .collect()
}

fn lamp() -> Vec<Stimulus<f64, 2>> {
    let field = Field::Point { at: Vector([100.0, 0.0]), strength: 2.0, length: 20.0, decay: Decay::Exponential };
    vec![Stimulus { name: "lamp".into(), field }]
}

fn taxis(informed: f64, weight: Option<f64>) -> Taxis<f64> {
    let sensors = vec![vec![1.0, 0.0], vec![0.0, 1.0], vec![-1.0, 0.0], vec![0.0, -1.0]];
    Taxis { up: "lamp".into(), informed, sensors, weight, threshold: 0.0, over: None }
}

#[test]
fn the_informed_go_up_the_stimulus() {
    // a law that goes straight on
    let law = "vicsek_1995";
    let agents = [([0.0, 0.0], [0.0, 0.03]), ([0.0, 500.0], [0.0, 0.03])];
    let with = |taxis: Taxis<f64>| {
        let mut fish = group(law, &agents);
        fish.parameters.insert("noise_amplitude".into(), 0.0.into());
        fish.taxis = Some(taxis);
        let mut plan = WorldPlan::new(Space::open(), fish);
        plan.stimuli = lamp();
        ran(plan, 1)
    };
    let w = with(taxis(0.5, None));
    // symmetric sensors: exactly towards the lamp, which lies along x
    assert!((w.velocity(0) - Vector([0.03, 0.0])).length() < 1e-9, "{:?}", w.velocity(0));
    assert_eq!(w.velocity(1), Vector([0.0, 0.03]), "the second is not informed");
    assert_eq!((w.state(0, "informed"), w.state(1, "informed")), (Some(1.0), Some(0.0)));
    let from = [(100.0f64, 1.0f64), (101.0, 0.0), (100.0, 1.0), (99.0, 0.0)];
    let mean = from.map(|(x, y)| (-x.hypot(y) / 20.0).exp() * 2.0).iter().sum::<f64>() / 4.0;
    assert!((w.state(0, "stimulus").unwrap() - mean).abs() < 1e-12);
    // with the law's own weight: halfway
    let w = with(taxis(1.0, Some(1.0)));
    assert!((w.velocity(0).angle() - std::f64::consts::FRAC_PI_4).abs() < 1e-9);
    // too faint to be sensed
    let w = with(Taxis { threshold: 1.0, ..taxis(1.0, None) });
    assert_eq!(w.velocity(0), Vector([0.0, 0.03]));
    // far beyond what is left of the intensity in steps of 1e-300 the way is still told, and where nothing is left, nothing is
    let mut fish = group(law, &[([-13_000.0, 0.0], [0.0, 0.03]), ([-1e6, 0.0], [0.0, 0.03])]);
    fish.parameters.insert("noise_amplitude".into(), 0.0.into());
    fish.taxis = Some(taxis(1.0, None));
    let mut plan = WorldPlan::new(Space::open(), fish);
    plan.stimuli = lamp();
    let w = ran(plan, 1);
    assert!((w.velocity(0) - Vector([0.03, 0.0])).length() < 1e-9, "{:?}", w.velocity(0));
    assert_eq!(w.velocity(1), Vector([0.0, 0.03]));
}

#[test]
fn a_priority_lets_the_law_have_its_states() {
    let mut plan = shoal(20);
    let sensors =
        [0, 1, 2].into_iter().flat_map(|a| [1.0, -1.0].map(|x| (0..3).map(|b| if a == b { x } else { 0.0 }).collect()));
    let sensors = sensors.collect();
    let over = Some(("behaviour".to_owned(), vec!["search".to_owned(), "align".to_owned(), "attract".to_owned()]));
    plan.groups[0].taxis =
        Some(Taxis { up: "light".into(), informed: 1.0, sensors, weight: None, threshold: 0.0, over });
    plan.stimuli = vec![Stimulus { name: "light".into(), field: Field::Gradient(Vector([0.0, 1.0, 0.0])) }];
    let mut world = World::new(plan).unwrap();
    let (mut led, mut avoided) = (0, 0);
    for _ in 0..20 {
        world.step();
        for id in 0..20 {
            let along = world.velocity(id).unit()[1];
            if world.state(id, "behaviour") == Some(0.0) {
                avoided += usize::from(along < 0.9);
            } else {
                assert!(along > 0.99, "{along}");
                led += 1;
            }
        }
    }
    assert!(led > 20 && avoided > 5, "{led} {avoided}");
}

#[test]
fn speeds_follow_their_target_within_limits() {
    let pace = Pace {
        least: 2.0,
        greatest: 9.0,
        acceleration: Some(10.0),
        deceleration: Some(20.0),
        states: Some(("behaviour".into(), vec![("search".into(), 1.5)])),
        neighbours: None,
        stimulus: None,
        drive: None,
    };
    // one alone searches: 6, then 7, 8, 9 and no faster
    let alone = [([50.0; 3], [6.0, 0.0, 0.0])];
    let speeds = |pace: Pace<f64>, steps: usize| {
        let mut fish = group("behaviour_selection", &alone);
        fish.pace = Some(pace);
        let mut world = World::new(WorldPlan::new(Space::open(), fish)).unwrap();
        (0..steps)
            .map(|_| {
                world.step();
                world.velocity(0).length()
            })
            .collect::<Vec<f64>>()
    };
    let near = |found: Vec<f64>, expected: &[f64]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}, not {expected:?}");
    };
    near(speeds(pace.clone(), 5), &[7.0, 8.0, 9.0, 9.0, 9.0]);
    let slow = Pace { states: Some(("behaviour".into(), vec![("search".into(), 0.1)])), ..pace.clone() };
    near(speeds(slow, 4), &[4.0, 2.0, 2.0, 2.0]);
    let drive =
        Pace { states: None, drive: Some(Drive { deviation: 0.3, time: 1.0 }), acceleration: None, ..pace.clone() };
    let driven = speeds(drive, 400);
    let mean = driven.iter().sum::<f64>() / 400.0;
    assert!((mean - 6.0).abs() < 1.0, "{mean}");
    let within = |v: &f64| (2.0 - 1e-9..=9.0 + 1e-9).contains(v);
    assert!(driven.iter().any(|&v| v > 7.0) && driven.iter().all(within), "{driven:?}");
    // a pair: each goes halfway to the speed of the other
    let mut fish = group("vicsek_1995", &[([0.0, 0.0], [2.0, 0.0]), ([0.0, 5.0], [6.0, 0.0])]);
    fish.parameters.insert("noise_amplitude".into(), 0.0.into());
    fish.parameters.insert("speed".into(), 4.0.into());
    let neighbours = Some(Neighbours { within: 6.0, weight: 0.5 });
    fish.pace = Some(Pace { states: None, neighbours, acceleration: None, deceleration: None, ..pace });
    let w = ran(WorldPlan::new(Space::open(), fish), 1);
    assert!((w.velocity(0).length() - 5.0).abs() < 1e-12 && (w.velocity(1).length() - 3.0).abs() < 1e-12);
}

#[test]
fn a_constant_speed_is_the_special_case() {
    let mut plan = shoal(40);
    let plain = ran(plan.clone(), 80);
    let pace = Pace {
        least: 6.0,
        greatest: 6.0,
        acceleration: Some(1.0),
        deceleration: Some(1.0),
        states: Some(("behaviour".into(), vec![("avoid".into(), 0.5)])),
        neighbours: None,
        stimulus: None,
        drive: None,
    };
    plan.groups[0].pace = Some(pace);
    let paced = ran(plan, 80);
    assert!(motion(&plain) == motion(&paced));
}

#[test]
fn equal_values_by_member_are_one_value() {
    let base = shoal(40);
    let mut varied = base.clone();
    varied.groups[0].varied =
        vec![Varied { parameter: "preferred_neighbours".into(), values: vec![Value::Number(10.0); 40] }];
    let (one, each) = (ran(base.clone(), 60), ran(varied, 60));
    assert!(motion(&one) == motion(&each), "bit for bit");
    assert_eq!(each.state(7, "parameter_preferred_neighbours"), Some(10.0));
    // and those that differ differ: of two that search, each has its own speed
    let mut fish = group("behaviour_selection", &[([0.0; 3], [6.0, 0.0, 0.0]), ([500.0; 3], [6.0, 0.0, 0.0])]);
    fish.varied = vec![Varied { parameter: "speed".into(), values: vec![Value::Number(3.0), Value::Number(5.0)] }];
    let w = ran(WorldPlan::new(Space::open(), fish.clone()), 1);
    assert!((w.velocity(0).length() - 3.0).abs() < 1e-12 && (w.velocity(1).length() - 5.0).abs() < 1e-12);
    fish.varied =
        vec![Varied { parameter: "body_radius".into(), values: vec![Value::Number(1.0), Value::Number(2.0)] }];
    let text = World::new(WorldPlan::new(Space::open(), fish)).err().unwrap().to_string();
    assert!(text.contains("member 1 would have another step, body radius or contact"), "{text}");
}

#[test]
fn other_parameters_hold_after_an_obstacle_and_for_a_time() {
    let at = |x: f64| group("behaviour_selection", &[([x, 50.0, 50.0], [6.0, 0.0, 0.0])]);
    let adapt = Adaptation {
        parameters: Values::from([("speed".to_owned(), 2.0.into())]),
        obstacle: Some(5.0),
        collision: false,
        crowd: None,
        hold: 0.25,
    };
    // the wall at x = 0 is 4.9 from the surface; the agent moves away from it at 6 a time
    let mut fish = at(5.9);
    fish.adapt = Some(adapt.clone());
    let mut world = World::new(WorldPlan::new(Space::walled([100.0; 3]), fish)).unwrap();
    let mut speeds = Vec::new();
    for _ in 0..6 {
        world.step();
        speeds.push((world.velocity(0).length() * 1e6).round() / 1e6);
    }
    // noted in the first step; then held for 0.25, which are three steps
    assert_eq!(speeds, [6.0, 2.0, 2.0, 2.0, 6.0, 6.0]);
    let mut crowd =
        group("behaviour_selection", &[([50.0; 3], [6.0, 0.0, 0.0]), ([60.0, 50.0, 50.0], [6.0, 0.0, 0.0])]);
    crowd.adapt = Some(Adaptation { obstacle: None, crowd: Some((12.0, 1)), ..adapt.clone() });
    let w = ran(WorldPlan::new(Space::open(), crowd.clone()), 2);
    assert!((w.velocity(0).length() - 2.0).abs() < 1e-9);
    crowd.adapt = Some(Adaptation { obstacle: None, crowd: Some((12.0, 2)), ..adapt.clone() });
    let w = ran(WorldPlan::new(Space::open(), crowd.clone()), 2);
    assert!((w.velocity(0).length() - 6.0).abs() < 1e-9);
    crowd.adapt = Some(Adaptation { obstacle: None, crowd: None, ..adapt });
    assert!(World::new(WorldPlan::new(Space::open(), crowd)).err().unwrap().to_string().contains("never happens"));
}

#[test]
fn a_collision_is_remembered() {
    // heading for the wall, blind to it: refused until other parameters see it
    let mut fish = group("behaviour_selection", &[([1.3, 50.0, 50.0], [-6.0, 0.0, 0.0])]);
    fish.parameters.insert("avoidance_radius".into(), 0.0.into());
    fish.adapt = Some(Adaptation {
        parameters: Values::from([("avoidance_radius".to_owned(), 4.0.into())]),
        obstacle: None,
        collision: true,
        crowd: None,
        hold: 1.0,
    });
    let mut world = World::new(WorldPlan::new(Space::walled([100.0; 3]), fish)).unwrap();
    world.step();
    assert_eq!((world.state(0, "collided"), world.state(0, "o_avoid")), (Some(1.0), Some(0.0)));
    world.run(2);
    assert_eq!(world.state(0, "o_avoid"), Some(1.0));
}

#[test]
fn who_decides_seldom_holds_its_heading() {
    let mut fish = group("behaviour_selection", &[([0.0; 3], [6.0, 0.0, 0.0])]);
    fish.intervals = vec![5];
    let mut world = World::new(WorldPlan::new(Space::open(), fish)).unwrap();
    let mut turned = Vec::new();
    for _ in 0..20 {
        let before = world.velocity(0);
        world.step();
        turned.push(world.velocity(0) != before);
    }
    // one alone searches, which turns it in every decision
    let decisions: Vec<usize> = (0..20).filter(|&k| turned[k]).collect();
    assert_eq!(decisions.len(), 4);
    assert!(decisions.windows(2).all(|two| two[1] - two[0] == 5), "{decisions:?}");
}

#[test]
fn one_of_the_nearest_is_perceived() {
    // three to one side at different distances; the law takes the mean heading of those it sees
    let places = [([0.0, 0.0], 0.0f64), ([1.0, 0.0], 0.5), ([2.0, 0.0], 1.0), ([3.0, 0.0], 1.5)];
    let agents: Vec<State<2>> = places.iter().map(|&(at, angle)| (at, [angle.cos(), angle.sin()])).collect();
    let drawn = |pool: Pool<f64>| {
        let mut counts = [0; 3];
        for seed in 0..300 {
            let mut fish = group("vicsek_1995", &agents);
            fish.parameters = Values::from([
                ("noise_amplitude".to_owned(), 0.0.into()),
                ("speed".to_owned(), 1.0.into()),
                ("radius".to_owned(), 10.0.into()),
            ]);
            fish.sensing = Sensing::Ideal(Ideal { one_of: Some(pool), ..Ideal::default() });
            let mut plan = WorldPlan::new(Space::open(), fish);
            plan.seed = seed;
            let angle = ran(plan, 1).velocity(0).angle();
            // the mean of its own heading and that of one other
            let other = (0..3).find(|&k| (angle - 0.25 * (k + 1) as f64).abs() < 1e-6).expect("one of them");
            counts[other] += 1;
        }
        counts
    };
    let uniform = drawn(Pool { nearest: 3, weight: PoolWeight::Uniform });
    assert!(uniform.iter().all(|&n| (70..130).contains(&n)), "{uniform:?}");
    let two = drawn(Pool { nearest: 2, weight: PoolWeight::Uniform });
    assert!(two[2] == 0 && two[0] > 110 && two[1] > 110, "{two:?}");
    // 1, 1/4, 1/9 of 49/36
    let square = drawn(Pool { nearest: 3, weight: PoolWeight::InverseSquare });
    assert!((200..240).contains(&square[0]) && (38..73).contains(&square[1]), "{square:?}");
    let side = drawn(Pool { nearest: 3, weight: PoolWeight::Angle { preferred: 1.0, width: 1e-3 } });
    assert!(side.iter().sum::<usize>() == 300, "all weights vanish: the nearest, {side:?}");
}

#[test]
fn a_member_hidden_in_part_is_seen_if_enough_of_it_is_free() {
    // the second hides the third's centre, and 11 of the 19 points of its diameter
    let agents = [([0.0, 0.0], [1.0, 0.0]), ([5.0, -0.9], [0.0, 1.0]), ([10.0, 0.0], [0.0, 1.0])];
    let seen = |free: Option<f64>| {
        let mut fish = group("vicsek_1995", &agents);
        fish.parameters = Values::from([
            ("noise_amplitude".to_owned(), 0.0.into()),
            ("speed".to_owned(), 1.0.into()),
            ("radius".to_owned(), 20.0.into()),
        ]);
        fish.radius = Some(1.0);
        fish.contact = Some(swarm::physics::Contact::Free);
        fish.sensing = Sensing::Ideal(Ideal { occlusion: Occlusion::All, free, ..Ideal::default() });
        // headings 1 along x and one or two along y
        ran(WorldPlan::new(Space::open(), fish), 1).velocity(0).angle()
    };
    let (one, two) = (std::f64::consts::FRAC_PI_4, 2f64.atan());
    assert!((seen(None) - one).abs() < 1e-9, "its centre is hidden");
    assert!((seen(Some(0.4)) - two).abs() < 1e-9);
    assert!((seen(Some(0.5)) - one).abs() < 1e-9);
}

#[test]
fn bits_are_the_same_for_every_thread_and_after_a_stop() {
    let plan = |driver: Driver, threads: usize| {
        let mut plan = shoal(120);
        plan.driver = driver;
        plan.threads = threads;
        plan.stimuli = vec![Stimulus { name: "light".into(), field: Field::Gradient(Vector([0.0, 1.0, 0.1])) }];
        let fish = &mut plan.groups[0];
        let sensors = vec![vec![1.0, 0.0, 0.0], vec![0.0, 1.0, 0.0], vec![0.0, 0.0, 1.0]];
        let up = "light".to_owned();
        fish.taxis = Some(Taxis { up, informed: 0.2, sensors, weight: Some(0.3), threshold: 0.0, over: None });
        fish.pace = Some(Pace {
            least: 2.0,
            greatest: 9.0,
            acceleration: Some(3.0),
            deceleration: None,
            states: Some(("behaviour".into(), vec![("attract".into(), 1.3)])),
            neighbours: Some(Neighbours { within: 15.0, weight: 0.5 }),
            stimulus: Some(("light".into(), 0.001)),
            drive: Some(Drive { deviation: 0.2, time: 2.0 }),
        });
        let values = (0..120).map(|k| Value::Number(f64::from(k % 12))).collect();
        fish.varied = vec![Varied { parameter: "preferred_neighbours".into(), values }];
        fish.adapt = Some(Adaptation {
            parameters: Values::from([("growth".to_owned(), 4.0.into())]),
            obstacle: Some(4.0),
            collision: true,
            crowd: Some((8.0, 6)),
            hold: 0.5,
        });
        fish.intervals = (0..120).map(|k| 1 + k % 4).collect();
        plan
    };
    for driver in [Driver::Synchronous, Driver::Sequential(Order::Random)] {
        let one = ran(plan(driver, 1), 60);
        assert!(one.frame().finite());
        assert!((0..120).any(|id| one.state(id, "adapted") > Some(0.0)));
        let kept = ran(plan(driver, 3), 25).save();
        let mut again = World::new(plan(driver, 2)).unwrap();
        again.restore(&kept).unwrap();
        again.run(35);
        assert!(motion(&one) == motion(&again), "threads or a stop change bits");
        assert!(one.save().to_bytes() == again.save().to_bytes());
    }
    let mut other = plan(Driver::Synchronous, 1);
    let mut world = ran(other.clone(), 10);
    let told: Vec<Vec<f64>> = (0..120).map(|id| world.explain(id).unwrap().performed.position).collect();
    world.step();
    assert!((0..120).all(|id| world.position(id).0.to_vec() == told[id as usize]), "what is told is done");
    other.driver = Driver::Asynchronous {
        tick: 0.1,
        period: 0.1,
        phase: swarm::engine::Phase::Together,
        clock: swarm::engine::Clock::Regular { jitter: 0.0 },
        delay: 0.0,
    };
    let text = World::new(other).err().unwrap().to_string();
    assert!(text.contains("own clocks"), "{text}");
}

#[test]
fn names_that_are_not_there_are_refused() {
    let refused = |change: &dyn Fn(&mut GroupPlan<f64, 2>)| {
        let mut fish = group("vicsek_1995", &[([0.0, 0.0], [1.0, 0.0])]);
        change(&mut fish);
        let mut plan = WorldPlan::new(Space::open(), fish);
        plan.stimuli = lamp();
        World::new(plan).err().unwrap().to_string()
    };
    let pace = |states: &str| Pace {
        least: 1.0,
        greatest: 2.0,
        acceleration: None,
        deceleration: None,
        states: Some((states.to_owned(), Vec::new())),
        neighbours: None,
        stimulus: None,
        drive: None,
    };
    let text = refused(&|fish| fish.taxis = Some(Taxis { up: "lamb".into(), ..taxis(1.0, None) }));
    assert!(text.contains("did you mean `lamp`?"), "{text}");
    let text = refused(&|fish| fish.pace = Some(pace("behavior")));
    assert!(text.contains("keeps no column `behavior`"), "{text}");
    let text = refused(&|fish| fish.pace = Some(Pace { states: None, least: 0.0, ..pace("") }));
    assert!(text.contains("least speed"), "{text}");
    let text = refused(&|fish| fish.taxis = Some(Taxis { sensors: vec![vec![1.0, 0.0]], ..taxis(1.0, None) }));
    assert!(text.contains("one sensor cannot tell"), "{text}");
}
