//! The stages together: any model under any sensing, bodies, obstacles, resources and drivers.
#![allow(clippy::unwrap_used, reason = "tests")]

use space::obstacles::{Obstacle, Plan};
use space::shape::Shape;
use space::{Space, Vector};
use swarm::detection::readings::{Clustering, Matching, ReadingDetection};
use swarm::engine::Checkpoint;
use swarm::engine::{Clock, ClockPlan, GroupPlan, IndexChoice, ObstaclePlan, Order, Phase, Placement, Sensing, Start};
use swarm::models::LIST;
use swarm::parameters::{Value, Values};
use swarm::physics::{Contact, DifferentialDrive, Met, Mobility};
use swarm::resources::{Gain, Metabolism, ResourcePlan, Respawn};
use swarm::selection::Perception;
use swarm::sensing::robot::Robot;
use swarm::sensing::scanner::{Origin, ScanNoise, Scanner};
use swarm::sensing::{Ideal, Occlusion, SensingNoise};
use swarm::{Driver, World, WorldPlan};

fn values(pairs: &[(&str, Value)]) -> Values {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect()
}

fn given(position: &[[f64; 2]], velocity: &[[f64; 2]]) -> Placement<f64, 2> {
    Placement::Given(Start {
        position: position.iter().map(|&p| Vector(p)).collect(),
        velocity: Some(velocity.iter().map(|&v| Vector(v)).collect()),
        columns: Default::default(),
    })
}

fn robot(detection: ReadingDetection<f64>, association: Option<f64>) -> Sensing<f64> {
    Sensing::Scanner(Box::new(Robot {
        scanner: Scanner::default(),
        detection,
        association,
        errors: None,
        widest_body: 0.17,
    }))
}

fn clustered() -> ReadingDetection<f64> {
    ReadingDetection::Clustered(Clustering::new(0.17))
}

/// Six robots in a walled field, laser at 10 Hz with own phases, physics at 100 Hz.
fn laser_robots(model: &str, parameters: Values, detection: ReadingDetection<f64>) -> WorldPlan<f64, 2> {
    let position: Vec<[f64; 2]> =
        (0..6).map(|k| [2.0 + 0.7 * f64::from(k % 3), 2.0 + 0.7 * f64::from(k / 3)]).collect();
    let mut group = GroupPlan::new("robots", model, parameters, 6, given(&position, &[[0.0, 0.05]; 6]));
    group.sensing = robot(detection, Some(0.3));
    group.mobility = Mobility::DifferentialDrive(DifferentialDrive::default());
    group.radius = Some(0.17);
    group.contact = Some(Contact::Slide);
    let mut plan = WorldPlan::new(Space::walled([6.0, 6.0]), group);
    plan.obstacles = vec![Obstacle::new(Shape::new_segment(Vector([1.0, 4.5]), Vector([4.0, 4.5])).unwrap())];
    plan.driver = Driver::Asynchronous {
        tick: 0.01,
        period: 0.1,
        phase: Phase::Random,
        clock: Clock::Regular { jitter: 0.05 },
        delay: 0.0,
    };
    plan
}

/// The metre set of the group-control specification, in robot mode.
fn metre_boids() -> Values {
    values(&[
        ("R", 2.0.into()),
        ("r_s", 0.6.into()),
        ("w_s", 1.0.into()),
        ("w_a", 3.0.into()),
        ("w_c", 1.0.into()),
        ("d_w", 0.6.into()),
        ("v", 0.05.into()),
        ("turn_max", 1.0.into()),
        ("eta", 0.3.into()),
        ("rho", 0.17.into()),
        ("fov_deg", 240.0.into()),
        ("dt", 0.2.into()),
    ])
}

#[test]
fn control_boids_runs_on_robots_with_a_laser_at_ten_hertz() {
    let mut world = World::new(laser_robots("control_boids", metre_boids(), clustered())).unwrap();
    let start: Vec<_> = (0..6).map(|id| world.position(id)).collect();
    let mut moved = 0.0f64;
    for _ in 0..2000 {
        world.step();
        for id in 0..6 {
            let p = world.position(id);
            assert!(p.finite() && (0..2).all(|a| (0.16..=5.84).contains(&p[a])), "inside the walls: {p:?}");
        }
    }
    for id in 0..6 {
        moved = moved.max((world.position(id) - start[id as usize]).length());
        assert!(world.state(id, "orientation").is_some());
    }
    assert!(moved > 0.3, "robots drive: {moved}");
    let errors = world.detection_errors();
    assert!(
        errors.members_in_view > 1000 && errors.detections > 0,
        "detections are counted against the truth: {errors:?}"
    );
    assert!(errors.members_missed < errors.members_in_view / 2);
}

#[test]
fn the_three_detections_drive_ha_extended() {
    let scanner = Scanner::default();
    for detection in [
        ReadingDetection::sensor_based(),
        ReadingDetection::MemberBased(Matching::new(&scanner, 0.17)),
        ReadingDetection::MemberExtrapolated(Matching::new(&scanner, 0.17)),
    ] {
        let parameters = values(&[("step", 0.05.into()), ("r_rep", 0.6.into())]);
        let mut plan = laser_robots("ha_extended", parameters, detection);
        plan.obstacles.clear();
        plan.space = Space::open();
        if let Sensing::Scanner(robot) = &mut plan.groups[0].sensing {
            robot.association = None;
        }
        let mut world = World::new(plan).unwrap();
        world.run(600);
        assert!(world.frame().finite());
        let labels: Vec<f64> = (0..6).map(|id| world.state(id, "mode").unwrap()).collect();
        assert!(labels.iter().any(|&l| l > 0.0), "somebody detects somebody: {labels:?}");
    }
}

#[test]
fn a_scan_repeats_and_continues_with_the_same_bits() {
    let make = || World::new(laser_robots("control_boids", Values::new(), clustered())).unwrap();
    let mut one = make();
    one.run(900);
    let mut before = make();
    before.run(333);
    let mut after = make();
    let saved = Checkpoint::from_bytes(&before.save().to_bytes(), &after.save()).unwrap();
    after.restore(&saved).unwrap();
    after.run(567);
    assert_eq!(one.frame().hash(), after.frame().hash());
}

#[test]
fn what_a_scanner_cannot_give_is_refused_with_the_remedy() {
    let refuse = |model: &str, association| {
        let mut plan = laser_robots(model, Values::new(), clustered());
        plan.groups[0].sensing = robot(clustered(), association);
        plan.groups[0].contact = None;
        plan.driver = Driver::Synchronous;
        match World::new(plan) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    let text = refuse("vicsek_1995", None);
    assert!(text.contains("velocities") && text.contains("association"), "{text}");
    assert_eq!(refuse("vicsek_1995", Some(0.3)), "");
    assert_eq!(refuse("viscido_snn", None), "", "positions suffice");
    let text = refuse("competing_flocks", Some(0.3));
    assert!(text.contains("ideal sensing"), "{text}");
}

/// Every model that works in the plane runs under every perfect-sensing perception function.
#[test]
fn every_model_under_every_perception_function() {
    let perceptions: Vec<Perception<f64, 2>> = vec![
        Perception::All,
        Perception::distance(0.5, 3.0),
        Perception::Nearest,
        Perception::KNearest(5),
        Perception::Voronoi,
        Perception::BoundingBox { low: Vector([-2.0, -1.0]), high: Vector([3.0, 1.0]), body_frame: true },
        Perception::angle(2.0),
        Perception::FixedSet(vec![vec![0, 1, 2]; 40]),
        Perception::Intersection(vec![Perception::distance(0.0, 4.0), Perception::Voronoi]),
        Perception::Union(vec![Perception::Nearest, Perception::distance(0.0, 1.0)]),
        Perception::Difference(Box::new(Perception::KNearest(6)), Box::new(Perception::Nearest)),
        Perception::Sequence(vec![Perception::distance(1.0, 9.0), Perception::Nearest]),
    ];
    for entry in LIST.iter().filter(|e| e.dimensions.contains(&2)) {
        for perception in &perceptions {
            let low = Vector([0.0, 0.0]);
            let mut group = GroupPlan::new(
                "g",
                entry.card.id,
                Values::new(),
                40,
                Placement::Uniform { low, high: Vector([8.0, 8.0]) },
            );
            // the names of the sets come with the refusal of a name that is none
            group.sets = vec![("no such set".to_owned(), perception.clone())];
            let text = World::new(WorldPlan::new(Space::open(), group.clone())).map(|_| ()).unwrap_err().to_string();
            let Some((_, names)) = text.split_once("it has ") else { unreachable!("{text}") };
            let names = names.split(": ").last().unwrap_or_default();
            group.sets = names.split(", ").map(|name| (name.trim().to_owned(), perception.clone())).collect();
            if names.contains("none") {
                continue;
            }
            let mut world = World::new(WorldPlan::new(Space::open(), group))
                .unwrap_or_else(|error| unreachable!("{} under {perception:?}: {error}", entry.card.id));
            world.run(10);
            assert!(world.frame().finite(), "{} under {perception:?}", entry.card.id);
        }
    }
}

#[test]
fn limits_of_ideal_sensing_hide_whom_they_say() {
    let run = |sensing: Ideal<f64>, radius: f64| {
        // 1 stands between 0 and 2; 3 stands behind 0
        let at = [[0.0, 0.0], [2.0, 0.0], [4.0, 0.1], [-3.0, 0.0]];
        let mut group = GroupPlan::new("g", "viscido_snn", Values::new(), 4, given(&at, &[[1.0, 0.0]; 4]));
        group.sensing = Sensing::Ideal(sensing);
        group.radius = Some(radius);
        group.sets = vec![("neighbours".into(), Perception::All)];
        let mut world = World::new(WorldPlan::new(Space::open(), group)).unwrap();
        world.mean_neighbours(1) * 4.0
    };
    let perfect = Ideal::default();
    assert_eq!(run(perfect, 0.3), 12.0);
    assert_eq!(run(Ideal { range: Some(3.5), ..perfect }, 0.3), 6.0, "0-1, 1-2, 0-3 both ways");
    let ahead = run(Ideal { field_of_view: Some(std::f64::consts::PI), ..perfect }, 0.3);
    assert_eq!(ahead, 6.0, "each sees those ahead of it");
    let hidden = run(Ideal { occlusion: Occlusion::All, ..perfect }, 0.3);
    assert_eq!(hidden, 6.0, "only the next body on the line is seen");
    let open = run(Ideal { occlusion: Occlusion::Obstacles, ..perfect }, 0.3);
    assert_eq!(open, 12.0, "bodies hide nobody where only obstacles do");
    let mut blind = perfect;
    blind.noise.miss = 1.0;
    assert_eq!(run(blind, 0.3), 0.0);
}

#[test]
fn sensing_errors_change_the_motion_and_zero_errors_do_not() {
    let run = |change: &dyn Fn(&mut Ideal<f64>)| {
        let low = Vector([0.0, 0.0]);
        let mut group =
            GroupPlan::new("g", "couzin_2002", Values::new(), 30, Placement::Uniform { low, high: Vector([9.0, 9.0]) });
        let mut ideal = Ideal::default();
        change(&mut ideal);
        group.sensing = Sensing::Ideal(ideal);
        let mut world = World::new(WorldPlan::new(Space::open(), group)).unwrap();
        world.run(20);
        assert!(world.frame().finite());
        world.frame().hash()
    };
    let exact = run(&|_| ());
    // a range beyond everybody takes the way over lists, and must give the same bits
    assert_eq!(exact, run(&|ideal| ideal.range = Some(1e6)));
    for change in [
        (|ideal: &mut Ideal<f64>| ideal.noise.distance = 0.2) as fn(&mut Ideal<f64>),
        |ideal| ideal.noise.direction = 0.2,
        |ideal| ideal.noise.heading = 0.2,
        |ideal| ideal.noise.miss = 0.3,
        |ideal| ideal.field_of_view = Some(1.0),
    ] {
        assert_ne!(exact, run(&change));
    }
}

#[test]
fn groups_of_different_models_share_one_world() {
    for threads in [1, 3] {
        for index in [IndexChoice::Pairs, IndexChoice::Cells] {
            let place = |x: f64| Placement::Uniform { low: Vector([x, 0.0]), high: Vector([x + 6.0, 12.0]) };
            let mut plan = WorldPlan::new(
                Space::periodic([12.0, 12.0]),
                GroupPlan::new("aligners", "vicsek_1995", values(&[("speed", 0.1.into())]), 40, place(0.0)),
            );
            plan.groups.push(GroupPlan::new("walkers", "viscido_snn", Values::new(), 25, place(6.0)));
            plan.threads = threads;
            plan.index = index;
            let mut world = World::new(plan).unwrap();
            world.run(50);
            assert!(world.frame().finite());
            for id in 0..40 {
                assert!((world.velocity(id).length() - 0.1).abs() < 1e-12, "aligners keep their speed");
            }
            for id in 40..65 {
                let step = world.velocity(id).length();
                assert!(step == 0.0 || (step - 1.0).abs() < 1e-12, "walkers step or stay");
            }
        }
    }
}

#[test]
fn groups_with_unlike_steps_are_refused() {
    let box_ = || Placement::Uniform { low: Vector([0.0, 0.0]), high: Vector([1.0, 1.0]) };
    let mut plan: WorldPlan<f64, 2> =
        WorldPlan::new(Space::open(), GroupPlan::new("a", "vicsek_1995", Values::new(), 2, box_()));
    plan.groups.push(GroupPlan::new("b", "couzin_2002", Values::new(), 2, box_()));
    let text = World::new(plan).map(|_| ()).unwrap_err().to_string();
    assert!(text.contains("group `b`") && text.contains("0.1"), "{text}");
}

#[test]
fn time_is_a_multiple_of_the_step_in_both_precisions() {
    let parameters = values(&[("time_step", 0.7.into())]);
    let group = GroupPlan::new(
        "two",
        "reynolds_opensteer",
        parameters.clone(),
        2,
        given(&[[1.0, 1.0], [5.0, 5.0]], &[[0.0; 2]; 2]),
    );
    let mut world = World::new(WorldPlan::new(Space::open(), group)).unwrap();
    let start = Start {
        position: vec![Vector([1.0f32, 1.0]), Vector([5.0, 5.0])],
        velocity: None,
        columns: Default::default(),
    };
    let group = GroupPlan::new("two", "reynolds_opensteer", parameters, 2, Placement::Given(start));
    let mut single = World::new(WorldPlan::new(Space::open(), group)).unwrap();
    for step in 1..=1000 {
        world.step();
        single.step();
        assert_eq!((world.time(), single.time()), (0.7 * f64::from(step), 0.7 * f64::from(step)));
    }
    // a state that was reached with another step goes on from its own time
    let saved = world.save();
    let group = GroupPlan::new(
        "two",
        "reynolds_opensteer",
        values(&[("time_step", 0.1.into())]),
        2,
        given(&[[1.0, 1.0]; 2], &[[0.0; 2]; 2]),
    );
    let mut other = World::new(WorldPlan::new(Space::open(), group)).unwrap();
    other.restore(&saved).unwrap();
    other.run(3);
    assert_eq!(other.time(), 700.0 + 0.1 * 3.0);
}

#[test]
fn bodies_turned_round_tell_their_law_under_every_driver() {
    let drivers = [
        Driver::Synchronous,
        Driver::Sequential(Order::Random),
        Driver::Asynchronous {
            tick: 1.0,
            period: 1.0,
            phase: Phase::Together,
            clock: Clock::Regular { jitter: 0.0 },
            delay: 0.0,
        },
    ];
    for driver in drivers {
        for contact in [Contact::Reflect, Contact::Clamp] {
            let start = Start {
                position: vec![Vector([0.05, 5.0, 5.0])],
                velocity: Some(vec![Vector([-1.0, 0.0, 0.0])]),
                columns: Default::default(),
            };
            let mut group = GroupPlan::new("one", "behaviour_selection", Values::default(), 1, Placement::Given(start));
            group.contact = Some(contact);
            let mut plan = WorldPlan::new(Space::walled([10.0; 3]), group);
            plan.driver = driver;
            let mut world = World::<f64, 3>::new(plan).unwrap();
            let column = world.frame().declared.iter().position(|column| column.name == "theta").unwrap();
            let mut turned = false;
            for _ in 0..20 {
                world.step();
                let columns = world.frame().columns;
                let velocity = columns.velocity(0);
                let heading = velocity[1].atan2(velocity[0]);
                let off = (columns.state[column][0] - heading).sin().abs();
                assert!(off < 1e-9, "{driver:?}, {contact:?}: theta is {} off its heading", off);
                turned |= world.met()[0] == Met::Wall;
            }
            assert!(turned, "{driver:?}, {contact:?}: it never met the wall");
        }
    }
}

#[test]
fn points_that_lack_a_coordinate_and_members_with_speeds_of_their_own() {
    let each = Value::List(vec![0.5.into(), 1.5.into()]);
    let target = |point: Vec<Value>| {
        let parameters = values(&[("desired_speed", each.clone()), ("target", Value::List(point))]);
        let place = Placement::Uniform { low: Vector([0.0, 0.0]), high: Vector([9.0, 9.0]) };
        World::<f64, 2>::new(WorldPlan::new(
            Space::open(),
            GroupPlan::new("crowd", "helbing_2005", parameters, 2, place),
        ))
    };
    let short = target(vec![1.0.into()]).err().unwrap().to_string();
    assert!(short.contains("`target` needs 2 coordinates for each point, found 1"), "{short}");
    let world = target(vec![1.0.into(), 2.0.into()]).unwrap();
    let speeds = [0, 1].map(|row| world.frame().columns.velocity(row).length());
    assert!((speeds[0] - 0.5).abs() < 1e-12 && (speeds[1] - 1.5).abs() < 1e-12, "{speeds:?}");
}

#[test]
fn obstacles_appear_move_and_block() {
    let at = [[0.0, 0.0]];
    let group = GroupPlan::new("g", "vicsek_1995", values(&[("speed", 1.0.into())]), 1, given(&at, &[[1.0, 0.0]]));
    let mut plan = WorldPlan::new(Space::open(), group);
    let wall = Shape::new_segment(Vector([4.5, -5.0]), Vector([4.5, 5.0])).unwrap();
    let mut obstacle = Obstacle::new(wall);
    obstacle.plan = Some(Plan { appears: 2.0, disappears: 8.0, ..Plan::default() });
    plan.obstacles = vec![obstacle];
    let mut world = World::new(plan).unwrap();
    world.run(8);
    assert_eq!(world.position(0), Vector([4.0, 0.0]), "stopped at the wall");
    assert_eq!(world.collisions().1, 4);
    world.run(3);
    assert_eq!(world.position(0), Vector([7.0, 0.0]), "and free when it is gone");
}

#[test]
fn agents_feed_starve_and_die() {
    let at = [[1.0, 1.0], [40.0, 40.0]];
    let mut group = GroupPlan::new("g", "competing_flocks", Values::new(), 2, given(&at, &[[0.0, 0.0]; 2]));
    if let Placement::Given(start) = &mut group.placement {
        start.columns.insert("health".into(), vec![100.0, 100.0]);
        start.columns.insert("energy".into(), vec![68.0, 68.0]);
    }
    let mut plan = WorldPlan::new(Space::walled([300.0, 300.0]), group);
    plan.resources = Some(ResourcePlan {
        items: vec![Vector([290.0, 290.0])],
        within: 5.0,
        gains: vec![Gain { column: "energy".into(), amount: 40.0, capacity: 100.0 }],
        respawn: Respawn::Never,
        metabolism: Some(Metabolism::default()),
        ..ResourcePlan::default()
    });
    // out of sight of the food, nobody eats: 68 of energy and then health, at 1.5 a step, 80 steps
    plan.groups[0].parameters = values(&[("see_food", 1.0.into())]);
    let mut world = World::new(plan).unwrap();
    world.run(80);
    assert_eq!(world.state(0, "health"), Some(48.0), "a boid that never eats ends a generation at exactly 48");
    world.run(40);
    assert_eq!(world.state(0, "health"), Some(0.0));
    let (place, still) = (world.position(0), world.velocity(0));
    world.run(10);
    assert_eq!((world.position(0), world.velocity(0)), (place, still), "the dead do not move");
}

#[test]
fn stale_readings_keep_the_order_of_gazi_and_passino() {
    let position: Vec<Vector<f64, 1>> = [0.0, 0.9, 2.5, 4.4, 5.0, 9.0].into_iter().map(|x| Vector([x])).collect();
    let start = Start { position, velocity: None, columns: Default::default() };
    let group = GroupPlan::new("g", "gazi_passino_2005", Values::new(), 6, Placement::Given(start));
    let mut plan = WorldPlan::new(Space::open(), group);
    plan.driver = Driver::Asynchronous {
        tick: 1.0,
        period: 1.0,
        phase: Phase::Together,
        clock: Clock::Regular { jitter: 0.0 },
        delay: 3.0,
    };
    let mut world = World::new(plan).unwrap();
    for _ in 0..600 {
        world.step();
    }
    for id in 1..6 {
        let gap = world.position(id)[0] - world.position(id - 1)[0];
        assert!((gap - 1.0).abs() < 0.05, "all gaps converge to the comfort distance: {gap}");
    }
}

#[test]
fn robots_turn_no_faster_than_they_can() {
    let at = [[0.0, 0.0], [0.0, 10.0]];
    let mut group =
        GroupPlan::new("g", "viscido_snn", values(&[("step", 0.1.into())]), 2, given(&at, &[[1.0, 0.0]; 2]));
    group.mobility = Mobility::TurnLimited { rate: 0.2, vertical: None };
    let mut world = World::new(WorldPlan::new(Space::open(), group)).unwrap();
    let mut heading = 0.0;
    for _ in 0..5 {
        world.step();
        let now = world.velocity(0).angle();
        assert!((now - heading).abs() <= 0.2 + 1e-12);
        heading = now;
    }
    assert!((heading - 1.0).abs() < 1e-9, "five turns of a fifth of a radian towards the other");
}

#[test]
fn across_a_seam_obstacles_stop_and_hide_as_anywhere() {
    let wall = |x: f64| Obstacle::new(Shape::new_segment(Vector([x, 4.0]), Vector([x, 6.0])).unwrap());
    let world = |model: &str, parameters: &[(&str, Value)], x: [f64; 2], wall_at: f64, hidden: bool| {
        let start = given(&[[x[0], 5.0], [x[1], 5.0]], &[[0.3, 0.0], [-0.3, 0.0]]);
        let mut group = GroupPlan::new("members", model, values(parameters), 2, start);
        group.radius = Some(0.1);
        group.contact = Some(Contact::Refuse);
        if hidden {
            group.sensing = Sensing::Ideal(Ideal { occlusion: Occlusion::Obstacles, ..Ideal::default() });
        }
        let mut plan = WorldPlan::new(Space::periodic([10.0, 10.0]), group);
        plan.obstacles = vec![wall(wall_at)];
        World::new(plan).unwrap()
    };
    for wall_at in [0.15, 0.95, 5.0, 9.1, 9.85] {
        let before = (wall_at + 9.7) % 10.0;
        let mut stopped = world("vicsek_1995", &[("speed", 0.3.into())], [before, 8.0], wall_at, false);
        stopped.run(6);
        let left = (wall_at - stopped.position(0)[0]).rem_euclid(10.0);
        assert!(left < 0.31, "a wall at {wall_at} lets through: {left}");
        let pair = [(wall_at + 8.5) % 10.0, (wall_at + 1.0) % 10.0];
        let mut hidden = world("viscido_snn", &[("step_length", 0.001.into())], pair, wall_at, true);
        for agent in [0, 1] {
            assert!(
                hidden.explain(agent).unwrap().detected.is_empty(),
                "a wall at {wall_at} hides nothing from {agent}"
            );
        }
    }
}

#[test]
fn every_group_of_robots_associates_by_its_own_gate() {
    let positions = |strict_first: bool| {
        let group = |name: &str, y: f64, gate: f64| {
            let start = given(&[[1.0, y], [2.0, y + 0.3]], &[[0.1, 0.0], [0.1, 0.05]]);
            let parameters = values(&[("radius", 2.0.into()), ("speed", 0.1.into()), ("time_step", 0.1.into())]);
            let mut group = GroupPlan::new(name, "vicsek_1995", parameters, 2, start);
            (group.radius, group.contact) = (Some(0.17), Some(Contact::Free));
            group.sensing = robot(clustered(), Some(gate));
            group
        };
        let (strict, wide) = (group("strict", 1.0, 1e-6), group("wide", 30.0, 0.5));
        let [one, other] = if strict_first { [strict, wide] } else { [wide, strict] };
        let mut plan = WorldPlan::new(Space::open(), one);
        plan.groups.push(other);
        let mut world = World::new(plan).unwrap();
        world.run(40);
        let pair = |first: u32| [world.velocity(first), world.velocity(first + 1)];
        if strict_first { [pair(0), pair(2)] } else { [pair(2), pair(0)] }
    };
    let [strict, wide] = positions(true);
    assert_eq!(positions(false), [strict, wide]);
    // only who associates knows velocities, and takes them
    assert!((strict[0] - strict[1]).length() > 0.04 && (wide[0] - wide[1]).length() < 0.01, "{strict:?} {wide:?}");
}

#[test]
fn tracks_outlive_a_seam() {
    let velocities = |x: f64| {
        let noise = ("noise_amplitude", 2.0.into());
        let parameters = values(&[("radius", 2.0.into()), ("speed", 0.1.into()), ("time_step", 0.1.into()), noise]);
        let start = given(&[[x, 5.0], [x - 0.01, 5.4]], &[[0.1, 0.0], [0.1, 0.0]]);
        let mut group = GroupPlan::new("robots", "vicsek_1995", parameters, 2, start);
        (group.radius, group.contact) = (Some(0.17), Some(Contact::Free));
        group.sensing = robot(clustered(), Some(0.3));
        let mut world = World::new(WorldPlan::new(Space::periodic([10.0, 10.0]), group)).unwrap();
        let (mut told, mut far) = (Vec::new(), 0.0f64);
        for _ in 0..8 {
            world.step();
            told.extend([world.velocity(0), world.velocity(1)]);
            far = far.max((world.position(0)[0] - x).abs());
        }
        (told, far)
    };
    // who loses a track goes its own way for a scan; later on, rounding of readings grows
    let ((seam, far), (middle, near)) = (velocities(9.97), velocities(4.97));
    assert!(far > 9.0 && near < 1.0, "one of them crosses a seam");
    for (a, b) in seam.into_iter().zip(middle) {
        assert!((a - b).length() < 1e-4, "{a:?} {b:?}");
    }
}

#[test]
fn lasers_see_bodies_as_wide_as_their_models_make_them() {
    let mut robots = GroupPlan::new("robots", "viscido_snn", Values::new(), 1, given(&[[0.0, 0.0]], &[[1.0, 0.0]]));
    robots.radius = Some(0.17);
    robots.sensing = robot(ReadingDetection::sensor_based(), None);
    let parameters = values(&[("rho", 3.0.into())]);
    let wide = GroupPlan::new("wide", "control_boids", parameters, 1, given(&[[7.0, 0.0]], &[[1.0, 0.0]]));
    let mut plan = WorldPlan::new(Space::open(), robots);
    plan.groups.push(wide);
    let mut world = World::new(plan).unwrap();
    let rays = world.explain(0).unwrap().rays;
    let hits = rays.iter().filter(|ray| matches!(ray.hit, Origin::Member(_))).count();
    assert!(hits > 100, "{hits} of {} rays meet a body of radius 3 at 7", rays.len());
}

/// A law that attracts and aligns, beside a wall: with the wall as a virtual member it moves as it does beside a real one there.
#[test]
fn obstacles_as_virtual_members_act_as_members_do() {
    let (place, velocity) = ([2.0, 3.0], [0.3, -0.4]);
    let wall = Obstacle::new(Shape::new_segment(Vector([4.0, -10.0]), Vector([4.0, 10.0])).unwrap());
    let disc = Obstacle::new(Shape::new_ball(Vector([2.0, 0.0]), 1.0).unwrap());
    let world = |obstacles: Vec<Obstacle<f64, 2>>, told: ObstaclePlan<f64>, others: &[([f64; 2], [f64; 2])]| {
        let group = |name: &str, at: &[[f64; 2]], going: &[[f64; 2]]| {
            let parameters = values(&[("turning_rate", 1800.0_f64.into())]);
            let mut group = GroupPlan::new(name, "couzin_2002", parameters, at.len(), given(at, going));
            group.obstacles = told;
            group.contact = Some(Contact::Free);
            group
        };
        let mut plan = WorldPlan::new(Space::open(), group("one", &[place], &[velocity]));
        let (at, going): (Vec<_>, Vec<_>) = others.iter().copied().unzip();
        plan.groups.push(group("others", &at, &going));
        plan.obstacles = obstacles;
        plan.seed = 3;
        let mut world = World::new(plan).unwrap();
        world.step();
        world.velocity(0)
    };
    let members = ObstaclePlan { within: Some(5.0), nearest: None, members: true };
    let alone = world(vec![wall.clone()], ObstaclePlan::default(), &[]);
    // along the wall only its own motion along it is left
    let beside_wall = world(vec![wall.clone()], members, &[]);
    let member = ([4.0, 3.0], [0.0, -0.4]);
    assert_eq!(beside_wall, world(Vec::new(), ObstaclePlan::default(), &[member]));
    assert_ne!(beside_wall, alone);
    // about a disc of radius 1 two lengths away, a third of it
    let round = ([2.0, 1.0], [0.1, 0.0]);
    let near = world(vec![disc.clone()], members, &[]);
    let expected = world(Vec::new(), ObstaclePlan::default(), &[round]);
    assert!((near - expected).length() < 1e-12 && near != alone, "{near:?} {expected:?}");
    // beside real ones, of whom some are not seen
    let others =
        [([-9.0, 3.0], [1.0, 1.0]), ([3.0, 2.0], [0.0, 1.0]), ([2.0, 30.0], [1.0, 0.0]), ([1.0, 1.0], [1.0, 0.2])];
    let among = world(vec![wall.clone()], members, &others);
    let all = [&others[..], &[member]].concat();
    assert!((among - world(Vec::new(), ObstaclePlan::default(), &all)).length() < 1e-12);
    assert_ne!(among, world(vec![wall.clone()], ObstaclePlan::default(), &others));
    // the nearest alone, where two are as near: the one met first; of unlike ones, the nearer
    let one = ObstaclePlan { nearest: Some(1), ..members };
    let far = Obstacle::new(Shape::new_ball(Vector([2.0, -1.0]), 1.0).unwrap());
    assert_eq!(world(vec![far.clone(), wall.clone()], one, &[]), beside_wall);
    assert_ne!(world(vec![far, wall], members, &[]), beside_wall);
}

#[test]
fn obstacles_handed_on_are_the_nearest_and_what_cannot_be_is_refused() {
    let discs = |radius: f64| {
        (0..8)
            .map(|k| {
                let (sin, cos) = f64::from(k).sin_cos();
                let at = Vector([cos, sin]) * (2.0 + 0.3 * f64::from(k)) + Vector([5.0, 5.0]);
                Obstacle::new(Shape::new_ball(at, radius).unwrap())
            })
            .collect::<Vec<_>>()
    };
    let seen = |told: ObstaclePlan<f64>, model: &str| {
        let mut group = GroupPlan::new("g", model, Values::new(), 1, given(&[[5.0, 5.0]], &[[0.5, 0.0]]));
        group.obstacles = told;
        let mut plan = WorldPlan::new(Space::open(), group);
        plan.obstacles = discs(0.25);
        let mut world = World::new(plan).map_err(|error| error.to_string())?;
        let mut distances: Vec<f64> = world.explain(0).unwrap().obstacles.iter().map(|near| near.distance).collect();
        distances.sort_by(f64::total_cmp);
        Ok::<_, String>(distances)
    };
    let told = |within, nearest| ObstaclePlan { within, nearest, members: false };
    let all = seen(told(None, None), "control_boids").unwrap();
    assert_eq!(all.len(), 8);
    assert_eq!(seen(told(None, Some(3)), "control_boids").unwrap(), all[..3]);
    assert_eq!(seen(told(Some(2.6), None), "control_boids").unwrap(), all[..all.partition_point(|&d| d < 2.6)]);
    // a law that looks at none is told of none: they can be members for it
    assert!(seen(told(Some(2.6), Some(1)), "vicsek_1995").unwrap().is_empty());
    let members = ObstaclePlan { within: None, nearest: None, members: true };
    for (told, model, says) in [
        (told(Some(0.0), None), "vicsek_1995", "within must be more than 0"),
        (told(None, Some(0)), "vicsek_1995", "nearest must be 1 or more"),
        (members, "vicsek_1995", "looks at no obstacles; say within which distance"),
        (ObstaclePlan { within: Some(1.0), ..members }, "tanner_2003_fixed", "who the others are"),
        (ObstaclePlan { within: Some(1.0), ..members }, "szabo_2008", "state of the others"),
    ] {
        let refused = seen(told, model).unwrap_err();
        assert!(refused.contains(says), "{refused}");
    }
}

/// Whoever stands somewhat beyond the reach may seem to be inside it, as whoever stands inside may seem to be beyond.
#[test]
fn errors_of_distances_go_both_ways() {
    let share = |distance: f64, range: Option<f64>| {
        let mut group = GroupPlan::new(
            "pair",
            "couzin_2002",
            Values::new(),
            2,
            given(&[[0.0, 0.0], [distance, 0.0]], &[[1.0, 0.0]; 2]),
        );
        group.sensing = Sensing::Ideal(Ideal {
            noise: SensingNoise { distance: 0.1, direction: 0.0, heading: 0.0, miss: 0.0 },
            range,
            ..Ideal::default()
        });
        let mut seen = 0;
        for seed in 0..400 {
            let mut plan = WorldPlan::new(Space::open(), group.clone());
            plan.seed = seed;
            seen += World::new(plan).unwrap().explain(0).unwrap().detected.len();
        }
        seen as f64 / 400.0
    };
    // the zone of attraction ends at 14 here; one standard deviation beyond it a sixth is seen, one inside five
    let reach = {
        let entry = LIST.iter().find(|entry| entry.card.id == "couzin_2002").unwrap();
        let Value::Number(reach) =
            (entry.parameters)().iter().find(|d| d.name == "attraction_radius").unwrap().default.clone()
        else {
            unreachable!("a number")
        };
        reach
    };
    for range in [None, Some(2.0 * reach)] {
        let (outside, inside) = (share(reach / 0.9, range), share(reach / 1.1, range));
        assert!((outside - 0.159).abs() < 0.06 && (inside - 0.841).abs() < 0.06, "{outside} {inside}");
        assert_eq!((share(reach * 1.99, range), share(reach * 0.5, range)), (0.0, 1.0));
    }
    assert_eq!(share(reach / 0.9, Some(reach)), 0.0, "beyond the range of sensing nobody is seen");
}

/// A member seen for the first time is taken to move as oneself: it changes no velocity that follows from differences.
#[test]
fn on_first_sight_a_member_seems_to_move_as_oneself() {
    let at = [[2.0, 2.0], [3.0, 2.0]];
    let mut group = GroupPlan::new(
        "robots",
        "cucker_smale_2007",
        values(&[("time_step", 0.1.into())]),
        2,
        given(&at, &[[0.0, 0.2], [0.0, -0.1]]),
    );
    group.sensing = robot(clustered(), Some(0.3));
    group.radius = Some(0.17);
    let mut world = World::new(WorldPlan::new(Space::open(), group)).unwrap();
    let before = world.velocity(0);
    assert_eq!(world.explain(0).unwrap().detected.len(), 1);
    world.step();
    assert_eq!(world.velocity(0), before);
    world.step();
    assert!(world.velocity(0)[1] < before[1], "then it knows: {:?}", world.velocity(0));
}

/// Members on clocks of their own decide as often as these say, from their own phase on.
#[test]
fn agents_have_clocks_of_their_own() {
    let decisions = |clocks: ClockPlan| {
        let mut group =
            GroupPlan::new("g", "control_random", Values::new(), 3, given(&[[0.0, 0.0]; 3], &[[1.0, 0.0]; 3]));
        group.clocks = clocks;
        let mut plan = WorldPlan::new(Space::open(), group);
        plan.driver = Driver::Asynchronous {
            tick: 0.01,
            period: 0.1,
            phase: Phase::Together,
            clock: Clock::Regular { jitter: 0.0 },
            delay: 0.0,
        };
        let mut world = World::<f64, 2>::new(plan).map_err(|error| error.to_string())?;
        let (mut count, mut first) = ([0; 3], [None; 3]);
        for tick in 0..300 {
            let before = [0, 1, 2].map(|id| world.velocity(id));
            world.step();
            for id in 0..3 {
                if world.velocity(id as u32) != before[id] {
                    count[id] += 1;
                    first[id].get_or_insert(tick);
                }
            }
        }
        Ok::<_, String>((count, first.map(Option::unwrap)))
    };
    assert_eq!(decisions(ClockPlan::default()), Ok(([30; 3], [0; 3])));
    let own = ClockPlan { period: vec![0.1, 0.2, 0.5], phase: vec![0.0, 0.05, 0.3], jitter: Vec::new() };
    assert_eq!(decisions(own.clone()), Ok(([30, 15, 6], [0, 5, 30])));
    let uneven = decisions(ClockPlan { jitter: vec![0.0, 0.5, 0.9], ..own.clone() }).unwrap();
    assert_eq!((uneven.0[0], uneven.1), (30, [0, 5, 30]));
    for (wrong, says) in [
        (ClockPlan { period: vec![0.1], ..ClockPlan::default() }, "1 periods for 3 members"),
        (ClockPlan { period: vec![0.001; 3], ..ClockPlan::default() }, "shorter than a tick"),
        (ClockPlan { phase: vec![-1.0; 3], ..ClockPlan::default() }, "phases must be 0 or more"),
        (ClockPlan { jitter: vec![1.0; 3], ..ClockPlan::default() }, "jitters must be from 0 to below 1"),
    ] {
        let refused = decisions(wrong).unwrap_err();
        assert!(refused.contains(says), "{refused}");
    }
    let mut group = GroupPlan::new("g", "vicsek_1995", Values::new(), 3, given(&[[0.0, 0.0]; 3], &[[1.0, 0.0]; 3]));
    group.clocks = own;
    let refused = World::new(WorldPlan::new(Space::open(), group)).err().unwrap().to_string();
    assert!(refused.contains("asynchronous driver alone"), "{refused}");
}

/// What a group of one is told of obstacles, by its sensing.
fn told_of(
    model: &str,
    obstacles: Vec<Obstacle<f64, 2>>,
    sensing: Sensing<f64>,
    told: ObstaclePlan<f64>,
) -> World<f64, 2> {
    let mut group = GroupPlan::new("one", model, Values::new(), 1, given(&[[3.0, 3.0]], &[[0.1, 0.0]]));
    group.sensing = sensing;
    group.obstacles = told;
    group.contact = Some(Contact::Free);
    let mut plan = WorldPlan::new(Space::open(), group);
    plan.obstacles = obstacles;
    World::new(plan).unwrap()
}

fn disc(x: f64, y: f64, radius: f64) -> Obstacle<f64, 2> {
    Obstacle::new(Shape::new_ball(Vector([x, y]), radius).unwrap())
}

/// A laser shows outlines in pieces; an obstacle is where one comes nearest.
#[test]
fn a_laser_tells_of_a_disc_once_and_of_a_wall_once() {
    let told = ObstaclePlan { within: Some(4.0), nearest: None, members: true };
    let seen = |obstacles: Vec<Obstacle<f64, 2>>, noise: Option<ScanNoise<f64>>, nearest: Option<usize>| {
        let Sensing::Scanner(mut robot) = robot(clustered(), None) else { unreachable!("a scanner") };
        robot.scanner.noise = noise;
        let told = ObstaclePlan { nearest, ..told };
        let explained = told_of("viscido_snn", obstacles, Sensing::Scanner(robot), told).explain(0).unwrap();
        // nobody else is there
        let mut offsets: Vec<[f64; 2]> = explained.detected.iter().map(|o| [o.offset[0], o.offset[1]]).collect();
        offsets.sort_by(|a, b| a[0].hypot(a[1]).total_cmp(&b[0].hypot(b[1])));
        offsets
    };
    let near = |found: &[[f64; 2]], expected: &[[f64; 2]], off: f64| {
        let all = found.iter().zip(expected).all(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) < off);
        assert!(found.len() == expected.len() && all, "{found:?} {expected:?}");
    };
    near(&seen(vec![disc(5.0, 3.0, 1.0)], None, None), &[[1.0, 0.0]], 0.03);
    let two = || vec![disc(5.0, 3.0, 1.0), disc(3.5, 5.0, 0.5)];
    near(&seen(two(), None, Some(2)), &[[1.0, 0.0], [0.364, 1.455]], 0.1);
    let wall = || vec![Obstacle::new(Shape::new_segment(Vector([4.5, -2.0]), Vector([4.5, 8.0])).unwrap())];
    near(&seen(wall(), None, None), &[[1.5, 0.0]], 0.03);
    // readings stray and are lost, so that far parts may stand apart
    let noisy = seen(wall(), Some(ScanNoise::default()), None);
    near(&noisy[..1], &[[1.5, 0.0]], 0.4);
    assert!(noisy.len() <= 3 && noisy[1..].iter().all(|far| far[1].abs() > 1.0), "{noisy:?}");
    // a corner of a room has two walls
    let corner = [([4.0, -1.0], [4.0, 5.0]), ([4.0, 5.0], [0.0, 5.0])]
        .map(|(from, to)| Obstacle::new(Shape::new_segment(Vector(from), Vector(to)).unwrap()));
    near(&seen(corner.to_vec(), None, None), &[[1.0, 0.0], [0.0, 2.0]], 0.03);
}

/// Obstacles are sensed as far as members are, and virtual members are missed and hidden as real ones.
#[test]
fn limits_of_ideal_sensing_hold_for_obstacles_too() {
    let told = ObstaclePlan { within: Some(9.0), nearest: None, members: true };
    let count = |obstacles: Vec<Obstacle<f64, 2>>, ideal: Ideal<f64>| {
        told_of("viscido_snn", obstacles, Sensing::Ideal(ideal), told).explain(0).unwrap().detected.len()
    };
    let behind = || vec![disc(0.5, 3.0, 0.5)];
    assert_eq!(count(behind(), Ideal::default()), 1);
    assert_eq!(count(behind(), Ideal { field_of_view: Some(3.0), ..Ideal::default() }), 0);
    assert_eq!(count(behind(), Ideal { range: Some(1.5), ..Ideal::default() }), 0);
    assert_eq!(count(behind(), Ideal { range: Some(2.5), ..Ideal::default() }), 1);
    let missed = SensingNoise { miss: 1.0, ..SensingNoise::default() };
    assert_eq!(count(behind(), Ideal { noise: missed, ..Ideal::default() }), 0);
    let hidden = || vec![disc(5.0, 3.0, 0.5), disc(8.0, 3.0, 0.5)];
    assert_eq!(count(hidden(), Ideal::default()), 2);
    assert_eq!(count(hidden(), Ideal { occlusion: Occlusion::Obstacles, ..Ideal::default() }), 1);
    // at the centre of a disc nothing is infinite, and the agent is not held for ever
    let mut world = told_of("cucker_smale_2007", vec![disc(3.0, 3.0, 1.0)], Sensing::default(), told);
    world.run(3);
    assert!(world.frame().finite() && world.position(0) != Vector([3.0, 3.0]));
}

/// Farther obstacles than the law looks for are virtual members, and do not act as obstacles.
#[test]
fn a_wider_detection_does_not_widen_a_law() {
    let velocity = |told: Option<ObstaclePlan<f64>>| {
        let start = Start {
            position: vec![Vector([0.0; 3])],
            velocity: Some(vec![Vector([1.0, 0.0, 0.0])]),
            columns: Default::default(),
        };
        let mut group = GroupPlan::new("one", "behaviour_selection", Values::new(), 1, Placement::Given(start));
        group.obstacles = told.unwrap_or_default();
        let mut plan = WorldPlan::new(Space::open(), group);
        plan.obstacles = vec![Obstacle::new(Shape::new_ball(Vector([60.0, 1.0, 0.0]), 5.0).unwrap())];
        let mut world = World::<f64, 3>::new(plan).unwrap();
        world.run(5);
        world.velocity(0)
    };
    let wide = ObstaclePlan { within: Some(200.0), nearest: None, members: false };
    assert_eq!(velocity(Some(wide)), velocity(None));
}

/// A law that looks at everyone does so beside a group whose reach makes cells, under every index.
#[test]
fn who_needs_everyone_meets_everyone_beside_a_group_with_a_reach() {
    let run = |index: IndexChoice, threads: usize| {
        let place = |name: &str, model: &str, low: f64| {
            let uniform = Placement::Uniform { low: Vector([low, 0.0]), high: Vector([low + 30.0, 40.0]) };
            GroupPlan::new(name, model, Values::new(), 150, uniform)
        };
        let mut plan = WorldPlan::<f64, 2>::new(Space::open(), place("flock", "vicsek_1995", 0.0));
        plan.groups.push(place("herd", "viscido_lch", 20.0));
        (plan.index, plan.threads, plan.seed) = (index, threads, 4);
        let mut world = World::new(plan).unwrap();
        world.step();
        (0..300).map(|id| world.position(id)).collect::<Vec<_>>()
    };
    let (pairs, cells) = (run(IndexChoice::Pairs, 1), run(IndexChoice::Cells, 1));
    assert!(pairs.iter().zip(&cells).all(|(a, b)| (*a - *b).length() < 1e-9));
    assert_eq!(cells, run(IndexChoice::Cells, 2));
}
