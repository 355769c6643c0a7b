//! Conduct over any law: who flees, hunts, rests, leads and explores; and what the world gives to all its agents.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

use space::{Space, Vector};
use swarm::conduct::{Conduct, Explore, Flee, Hunt, Lead, Rest};
use swarm::engine::{Driver, GroupPlan, IndexChoice, Order, Placement, Start, World, WorldPlan};
use swarm::parameters::Values;
use swarm::resources::{Predation, ResourcePlan, Store};

const SIDE: f64 = 100.0;

fn group(name: &str, model: &str, agents: &[([f64; 2], [f64; 2])]) -> GroupPlan<f64, 2> {
    let start = Start {
        position: agents.iter().map(|agent| Vector(agent.0)).collect(),
        velocity: Some(agents.iter().map(|agent| Vector(agent.1)).collect()),
        ..Start::default()
    };
    GroupPlan::new(name, model, Values::new(), agents.len(), Placement::Given(start))
}

fn world(groups: Vec<GroupPlan<f64, 2>>, resources: Option<ResourcePlan<f64, 2>>) -> WorldPlan<f64, 2> {
    let mut groups = groups.into_iter();
    let mut plan = WorldPlan::new(Space::walled([SIDE, SIDE]), groups.next().unwrap());
    plan.groups.extend(groups);
    plan.resources = resources;
    plan
}

fn stores() -> ResourcePlan<f64, 2> {
    let store = |column: &str, start| Store { column: column.into(), start };
    ResourcePlan { stores: vec![store("health", 20.0), store("energy", 50.0)], ..ResourcePlan::default() }
}

/// Vicsek's model: its step is 1.
const LAW: &str = "vicsek_1995";

#[test]
fn prey_flees_straight_away_and_predators_follow() {
    let mut doves = group("doves", LAW, &[([50.0, 50.0], [0.0, 1.0]), ([90.0, 90.0], [0.0, 1.0])]);
    doves.conduct = Some(Conduct {
        flee: Some(Flee { from: vec!["hawks".into()], within: 20.0, speed: 2.0 }),
        ..Conduct::default()
    });
    let mut hawks = group("hawks", LAW, &[([40.0, 50.0], [1.0, 0.0])]);
    hawks.conduct = Some(Conduct {
        hunt: Some(Hunt { prey: vec!["doves".into()], within: 30.0, speed: 3.0 }),
        ..Conduct::default()
    });
    let mut plan = world(vec![doves, hawks], Some(stores()));
    plan.resources.as_mut().unwrap().predation = vec![Predation {
        hunters: "hawks".into(),
        prey: vec!["doves".into()],
        health: "health".into(),
        within: 2.0,
        damage: 30.0,
        rebuttal: 0.0,
    }];
    let mut w = World::new(plan).unwrap();
    assert_eq!((w.state(0, "health"), w.state(2, "energy")), (Some(20.0), Some(50.0)), "the world gives these to all");
    w.step();
    assert_eq!(w.position(0), Vector([52.0, 50.0]));
    assert_eq!(w.position(2), Vector([43.0, 50.0]));
    assert_eq!(
        (w.state(0, "conduct"), w.state(1, "conduct"), w.state(2, "conduct")),
        (Some(1.0), Some(0.0), Some(2.0))
    );
    // 10 ahead and 1 a step slower: caught before it reaches the wall, and dead then
    for _ in 0..30 {
        w.step();
    }
    assert_eq!(w.state(0, "health"), Some(0.0));
    assert_eq!(w.state(1, "health"), Some(20.0));
    assert_ne!(w.state(2, "conduct"), Some(2.0), "nobody hunts the dead");
}

#[test]
fn who_is_full_rests_until_it_is_hungry() {
    let mut cows = group("cows", LAW, &[([50.0, 50.0], [0.0, 1.0])]);
    cows.conduct =
        Some(Conduct { rest: Some(Rest { column: "energy".into(), from: 50.0, until: 47.0 }), ..Conduct::default() });
    let mut resources = stores();
    resources.metabolism = Some(swarm::resources::Metabolism::default());
    let mut w = World::new(world(vec![cows], Some(resources))).unwrap();
    let mut rested = Vec::new();
    for _ in 0..6 {
        let before = w.position(0);
        w.step();
        let rests = w.state(0, "conduct") == Some(3.0);
        assert!(!rests || w.position(0) == before);
        rested.push(rests);
    }
    // energy before the steps: 50, 49, 48, 47, 46, 45
    assert_eq!(rested, [true, true, true, true, false, false]);
}

#[test]
fn one_at_the_front_leads_for_its_time() {
    let mates = [([50.0, 50.0], [0.0, 0.03]), ([50.0, 42.0], [0.0, 0.03]), ([51.0, 41.0], [0.0, 0.03])];
    let mut flock = group("flock", LAW, &mates);
    flock.conduct = Some(Conduct {
        lead: Some(Lead { within: 10.0, least: 0.5, rate: 1e9, time: 3.0, speed: 2.0 }),
        ..Conduct::default()
    });
    let mut w = World::new(world(vec![flock], None)).unwrap();
    w.step();
    let states: Vec<f64> = (0..3).map(|id| w.state(id, "conduct").unwrap()).collect();
    assert_eq!(states, [4.0, 0.0, 0.0], "only the one that has the others behind it");
    assert!((w.velocity(0) - Vector([0.0, 2.0])).length() < 1e-12);
    assert_eq!(w.state(0, "leading"), Some(2.0));
    w.run(2);
    assert_eq!((w.state(0, "conduct"), w.state(0, "leading")), (Some(4.0), Some(0.0)));
    w.step();
    assert_eq!(w.state(0, "conduct"), Some(0.0), "too far away by now to lead again");
}

#[test]
fn who_sees_no_food_explores() {
    let walkers = [([10.0, 10.0], [1.0, 0.0]), ([80.0, 80.0], [0.0, 0.0])];
    let mut ants = group("ants", LAW, &walkers);
    ants.conduct =
        Some(Conduct { explore: Some(Explore { without: 5.0, speed: 1.5, turning: 0.3 }), ..Conduct::default() });
    let resources = ResourcePlan { items: vec![Vector([12.0, 10.0])], ..ResourcePlan::default() };
    let mut w = World::new(world(vec![ants], Some(resources))).unwrap();
    w.step();
    assert_eq!((w.state(0, "conduct"), w.state(1, "conduct")), (Some(0.0), Some(5.0)));
    assert!((w.velocity(1).length() - 1.5).abs() < 1e-12, "out of rest, somewhere");
}

#[test]
fn velocities_change_no_faster_than_allowed() {
    let mut doves = group("doves", LAW, &[([50.0, 50.0], [0.0, 1.0])]);
    doves.conduct = Some(Conduct {
        flee: Some(Flee { from: vec!["hawks".into()], within: 20.0, speed: 2.0 }),
        acceleration: Some(0.25),
        ..Conduct::default()
    });
    let hawks = group("hawks", LAW, &[([50.0, 60.0], [0.0, 0.0])]);
    let mut w = World::new(world(vec![doves, hawks], None)).unwrap();
    w.step();
    assert_eq!(w.velocity(0), Vector([0.0, 0.75]));
}

#[test]
fn bits_are_the_same_for_every_index_thread_and_after_a_stop() {
    let herd = |name: &str, count: usize, model: &str| {
        let low = Vector([0.0, 0.0]);
        let placement = Placement::Uniform { low, high: Vector([SIDE, SIDE]) };
        GroupPlan::<f64, 2>::new(name, model, Values::new(), count, placement)
    };
    let plan = |driver: Driver, threads: usize| {
        let mut sheep = herd("sheep", 400, "couzin_2002");
        sheep.conduct = Some(Conduct {
            flee: Some(Flee { from: vec!["wolves".into()], within: 8.0, speed: 2.0 }),
            rest: Some(Rest { column: "energy".into(), from: 48.0, until: 45.0 }),
            lead: Some(Lead { within: 10.0, least: 0.3, rate: 0.5, time: 1.0, speed: 2.0 }),
            explore: Some(Explore { without: 15.0, speed: 1.0, turning: 0.5 }),
            ..Conduct::default()
        });
        let mut wolves = herd("wolves", 8, "couzin_2002");
        wolves.conduct = Some(Conduct {
            hunt: Some(Hunt { prey: vec!["sheep".into()], within: 30.0, speed: 3.0 }),
            ..Conduct::default()
        });
        let mut resources = stores();
        resources.items = (0..20).map(|k| Vector([5.0 * f64::from(k), 50.0])).collect();
        resources.within = 1.0;
        resources.sharing = Some(swarm::resources::Sharing { within: 3.0, share: 0.5 });
        resources.gains = vec![swarm::resources::Gain { column: "energy".into(), amount: 5.0, capacity: 60.0 }];
        resources.respawn = swarm::resources::Respawn::After(0.0);
        resources.metabolism = Some(swarm::resources::Metabolism {
            motion: 0.1,
            drafting: Some(swarm::resources::Drafting { within: 5.0, ahead: 0.6, aligned: 0.6, saving: 0.4 }),
            ..swarm::resources::Metabolism::default()
        });
        resources.predation = vec![Predation {
            hunters: "wolves".into(),
            prey: vec!["sheep".into()],
            health: "health".into(),
            within: 2.0,
            damage: 50.0,
            rebuttal: 0.5,
        }];
        let mut plan = world(vec![sheep, wolves], Some(resources));
        plan.driver = driver;
        plan.threads = threads;
        plan
    };
    let state = |w: &World<f64, 2>| w.save().to_bytes();
    for driver in [Driver::Synchronous, Driver::Sequential(Order::Random)] {
        let mut one = World::new(plan(driver, 1)).unwrap();
        one.run(60);
        let columns = |id: u32| one.state(id, "conduct").unwrap();
        let seen: std::collections::BTreeSet<u64> = (0..408).map(|id| columns(id) as u64).collect();
        assert!(seen.len() >= 4, "{seen:?}");
        assert!((0..408).any(|id| one.state(id, "health") == Some(0.0)), "somebody was eaten");
        assert!(one.frame().finite());
        let mut more = World::new(plan(driver, 3)).unwrap();
        more.run(25);
        let kept = more.save();
        let mut again = World::new(plan(driver, 2)).unwrap();
        again.restore(&kept).unwrap();
        again.run(35);
        assert!(state(&one) == state(&again), "threads or a stop change bits");
    }
    let mut pairs = plan(Driver::Synchronous, 1);
    pairs.index = IndexChoice::Pairs;
    assert!(World::new(pairs).is_ok());
}

#[test]
fn names_that_are_not_there_are_refused() {
    let mut doves = group("doves", LAW, &[([50.0, 50.0], [0.0, 1.0])]);
    doves.conduct = Some(Conduct {
        flee: Some(Flee { from: vec!["hawk".into()], within: 20.0, speed: 2.0 }),
        ..Conduct::default()
    });
    let hawks = group("hawks", LAW, &[([50.0, 60.0], [0.0, 0.0])]);
    let text = World::new(world(vec![doves.clone(), hawks], None)).err().unwrap().to_string();
    assert!(text.contains("did you mean `hawks`?"), "{text}");
    doves.conduct =
        Some(Conduct { rest: Some(Rest { column: "energy".into(), from: 1.0, until: 2.0 }), ..Conduct::default() });
    assert!(World::new(world(vec![doves], None)).err().unwrap().to_string().contains("rest ends"));
}
