//! The broken twin of `competing_flocks`: what it makes of a place is taken as it comes, and shows that the tests of the law itself
//! could fail.

#![allow(clippy::unwrap_used, reason = "tests")]

use space::{Space, Vector};
use swarm::engine::{GroupPlan, Placement, Start, World, WorldPlan};
use swarm::parameters::{Value, Values};
use swarm::resources::{Gain, Metabolism, ResourcePlan, Respawn};

/// Two boids that see each other, and one far away that sits on its food; gene 1 of all is 0.
fn world(safeguards: bool) -> World<f64, 2> {
    let places = [[50.0, 50.0], [60.0, 50.0], [250.0, 250.0]];
    let start = Start {
        position: places.iter().map(|&place| Vector(place)).collect(),
        velocity: Some(vec![Vector::ZERO; 3]),
        ..Start::default()
    };
    let genes = [1.0, 0.0, 1.0, 10.0, 0.025, 1.0, 1.0, 0.0025, 36.0, 1.0, 300.0, 1.0];
    let mut values = Values::new();
    values.insert("chromosome".into(), Value::List(genes.iter().map(|&gene: &f64| gene.into()).collect()));
    values.insert("safeguards".into(), safeguards.into());
    let group = GroupPlan::new("boids", "competing_flocks", values, 3, Placement::Given(start));
    let mut plan = WorldPlan::new(Space::walled([300.0, 300.0]), group);
    plan.resources = Some(ResourcePlan {
        items: vec![Vector([50.0, 52.0]), Vector([250.0, 252.0])],
        within: 20.0,
        gains: vec![Gain { column: "energy".into(), amount: 40.0, capacity: 100.0 }],
        // eaten items come back when this is over
        respawn: Respawn::After(1e9),
        metabolism: Some(Metabolism::default()),
        ..ResourcePlan::default()
    });
    World::new(plan).unwrap()
}

#[test]
fn a_gene_of_zero_loses_the_boid_for_good_and_nobody_sees_it_again() {
    let mut w = world(false);
    w.run(80);
    for id in [0, 1] {
        assert!(!w.position(id).finite(), "{:?}", w.position(id));
        assert_eq!(w.state(id, "health"), Some(48.0), "it never ate");
    }
    assert!(w.position(2).finite(), "who sees nobody divides by nothing");
    assert_eq!(w.state(2, "health"), Some(80.0), "it ate once, at once: 100 of energy for 120 s");
    assert_eq!(w.resources().unwrap().consumed, 1, "the item beside the lost one is still there");
}

#[test]
fn with_safeguards_the_same_gene_loses_nobody() {
    let mut w = world(true);
    w.run(80);
    assert!(w.frame().finite());
}
