//! The stages together: any model under any sensing, bodies, obstacles, resources and drivers.
#![allow(clippy::unwrap_used, reason = "tests")]

use space::obstacles::{Obstacle, Plan};
use space::shape::Shape;
use space::{Space, Vector};
use swarm::detection::readings::{Clustering, Matching, ReadingDetection};
use swarm::engine::Checkpoint;
use swarm::engine::{Clock, GroupPlan, IndexChoice, Order, Phase, Placement, Sensing, Start};
use swarm::models::LIST;
use swarm::parameters::{Value, Values};
use swarm::physics::{Contact, DifferentialDrive, Met, Mobility};
use swarm::resources::{Gain, Metabolism, ResourcePlan, Respawn};
use swarm::selection::Perception;
use swarm::sensing::robot::Robot;
use swarm::sensing::scanner::{Origin, Scanner};
use swarm::sensing::{Ideal, Occlusion};
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
