//! Laws that hold for every listed term, and closed forms of each.

use crate::engine::{World, WorldError};
use crate::models::composed::Terms;
use crate::models::oracle::{Oracle, close};
use crate::models::{Catalogue, Models};
use crate::parameters::{Parameter, Parameters, Scalar, Value, Values};
use crate::selection::Perception;
use crate::terms::{self, LIST};
use space::shape::Shape;
use space::{Space, Vector};

/// Terms by id with their parameters.
fn written(terms: &[(&str, &[(&str, Value)])]) -> Value {
    let given =
        |given: &[(&str, Value)]| given.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    Terms(terms.iter().map(|(id, all)| ((*id).to_owned(), given(all))).collect()).write()
}

/// The velocity of the first of some agents after a step of 1 in which a term alone is the acceleration.
#[track_caller]
fn acts(id: &str, given: &[(&str, Value)], agents: &[([f64; 2], [f64; 2])]) -> Vector<f64, 2> {
    alone(id, given).step(agents).velocity(0) - Vector(agents[0].1)
}

fn alone(id: &str, given: &[(&str, Value)]) -> Oracle<2> {
    Oracle::new("composed").set("terms", written(&[(id, given)])).set("max_speed", 1e9).set("dt", 1.0)
}

const REST: [f64; 2] = [0.0, 0.0];

#[test]
fn cards_are_full_and_parameters_have_their_defaults_in_range() {
    for (k, entry) in LIST.iter().enumerate() {
        let card = entry.card;
        assert!(LIST[..k].iter().all(|other| other.card.id != card.id), "{} is listed once", card.id);
        for text in [card.about, card.equation, card.edge] {
            assert!(!text.trim().is_empty(), "{} leaves a part of its card empty", card.id);
        }
        for descriptor in entry.parameters() {
            assert!((descriptor.check)(&descriptor, &descriptor.default).is_ok(), "{} {}", card.id, descriptor.name);
            // files give angles in degrees, and terms are not asked for any
            assert!(!descriptor.unit.contains("rad"), "{} {}", card.id, descriptor.name);
        }
        assert_eq!(terms::find(card.id).map(|found| found.card.id), Some(card.id));
    }
}

/// What a term needs beyond its defaults in a space of `D` dimensions.
fn needed<const D: usize>(id: &str) -> Vec<(&'static str, Value)> {
    match id {
        "goal" => vec![("point", [2.0; D].into())],
        "travel" => vec![("direction", [1.0; D].into())],
        _ => Vec::new(),
    }
}

#[test]
fn degenerate_states_stay_finite_with_every_term_alone() {
    fn check<R: Scalar, const D: usize>()
    where
        Models: Catalogue<R, D>,
    {
        for entry in LIST {
            for motion in ["acceleration", "direction", "velocity"] {
                let terms = written(&[(entry.card.id, &needed::<D>(entry.card.id))]);
                let values = Values::from([("terms".into(), terms), ("motion".into(), motion.into())]);
                let point = Vector([R::of(3.0); D]);
                for (at, going) in [
                    (vec![point; 20], vec![Vector::ZERO; 20]),
                    (vec![point; 20], vec![Vector([R::ONE; D]); 20]),
                    ((0..12).map(|k| Vector::axis(0) * R::count(k)).collect(), vec![Vector::ZERO; 12]),
                    (
                        (0..12).map(|k| Vector::axis(0) * R::of(1e25 * f64::from(k))).collect(),
                        vec![point * R::of(1e15); 12],
                    ),
                    (vec![point], vec![Vector::ZERO]),
                ] {
                    for space in [Space::open(), Space::walled([R::of(40.0); D])] {
                        let start = crate::engine::Start {
                            position: at.clone(),
                            velocity: Some(going.clone()),
                            columns: Default::default(),
                        };
                        let placement = crate::engine::Placement::Given(start);
                        let group = crate::engine::GroupPlan::new("g", "composed", values.clone(), at.len(), placement);
                        let Ok(mut world) = World::new(crate::WorldPlan::new(space, group)) else {
                            assert!(at.iter().any(|p| p.length() > R::of(40.0)), "{}", entry.card.id);
                            continue;
                        };
                        world.run(10);
                        assert!(world.frame().finite(), "{} {D}-D {} {motion}", entry.card.id, R::NAME);
                    }
                }
            }
        }
    }
    check::<f64, 1>();
    check::<f32, 2>();
    check::<f64, 2>();
    check::<f64, 3>();
}

#[test]
fn terms_about_members() {
    let agents = [([0.0, 0.0], [1.0, 0.0]), ([4.0, 0.0], [0.0, 2.0]), ([0.0, 2.0], [0.0, 3.0])];
    close(acts("align", &[], &agents), [0.0, 1.0]);
    close(acts("align", &[("take", "sum".into()), ("weight", 0.5.into())], &agents), [0.0, 1.0]);
    close(acts("match_velocity", &[], &agents), [-1.0, 2.5]);
    close(acts("attract", &[], &agents), [2.0, 1.0]);
    close(acts("attract", &[("scale", 2.0.into())], &agents), [1.0, 0.5]);
    close(acts("attract", &[("by_distance", "constant".into()), ("take", "sum".into())], &agents), [1.0, 1.0]);
    let half = 0.5f64.sqrt();
    close(acts("attract", &[("by_distance", "constant".into()), ("take", "direction".into())], &agents), [half, half]);
    close(acts("repel", &[("scale", 4.0.into())], &agents), [-0.5, -2.0]);
    close(acts("repel", &[("scale", 4.0.into()), ("by_distance", "inverse".into())], &agents), [-0.5, -1.0]);
    close(acts("repel", &[("scale", 4.0.into()), ("by_distance", "falling".into())], &agents), [0.0, -0.25]);
    // nothing where they coincide; inverse distances are floored at a thousandth of the scale
    close(acts("repel", &[], &[([0.0, 0.0], REST), ([0.0, 0.0], REST)]), [0.0, 0.0]);
    close(acts("repel", &[], &[([0.0, 0.0], REST), ([1e-5, 0.0], REST)]) * 1e-6, [-1.0, 0.0]);
    // one at twice the distance that is kept, one at it
    close(acts("keep_distance", &[("distance", 2.0.into())], &agents), [0.5, 0.0]);
    close(acts("follow", &[], &agents), [0.0, 1.0]);
    close(acts("follow", &[("gap", 2.0.into())], &agents), [0.0, 0.0]);
    // towards (2, 1), less what lies along the heading
    let [x, y] = [2.0 / 5f64.sqrt(), 1.0 / 5f64.sqrt()];
    close(acts("turn_toward", &[], &agents), [0.0, y]);
    close(acts("turn_toward", &[], &[([0.0, 0.0], REST), agents[1], agents[2]]), [x, y]);
    // farther than the radius of `neighbours`: nobody
    for entry in LIST.iter().filter(|entry| entry.card.members) {
        close(acts(entry.card.id, &[], &[([0.0, 0.0], [1.0, 0.0]), ([10.0, 0.0], [0.0, 2.0])]), [0.0, 0.0]);
    }
}

#[test]
fn terms_about_oneself_and_the_surroundings() {
    let one = [([1.0, 1.0], [3.0, 4.0])];
    close(acts("keep_heading", &[("weight", 5.0.into())], &one), [3.0, 4.0]);
    close(acts("keep_speed", &[("speed", 10.0.into())], &one), [3.0, 4.0]);
    close(acts("friction", &[("weight", 0.5.into())], &one), [-1.5, -2.0]);
    close(acts("travel", &[("direction", [0.0, 7.0].into())], &one), [0.0, 1.0]);
    close(acts("goal", &[("point", [1.0, 5.0].into())], &one), [0.0, 1.0]);
    close(acts("goal", &[("point", [1.0, 5.0].into()), ("arrive", 8.0.into())], &one), [0.0, 0.5]);
    close(
        alone("wander", &[]).inject_vectors("wander", &[[0.6, 0.8]]).step(&[([0.0, 0.0], REST)]).velocity(0),
        [0.6, 0.8],
    );
    let drawn = alone("wander", &[]).live().step(&[([0.0, 0.0], REST)]).velocity(0);
    assert!((drawn.length() - 1.0).abs() < 1e-12);
    let disc = Shape::Ball { centre: Vector([3.0, 0.0]), radius: 1.0 };
    let w = alone("walls", &[("reach", 8.0.into())]).obstacle(disc).step(&[([0.0, 0.0], REST)]);
    close(w.velocity(0), [-0.75, 0.0]);
    let w = alone("walls", &[("reach", 8.0.into())]).space(Space::walled([100.0, 100.0])).step(&[([2.0, 50.0], REST)]);
    close(w.velocity(0), [0.75, 0.0]);
}

#[test]
fn priorities_and_budgets() {
    let level = |k: usize| ("priority", Value::from(k));
    let east = ("direction", Value::from([1.0, 0.0]));
    let north = ("direction", Value::from([0.0, 1.0]));
    let ask = |combine: &str, terms: &[(&str, &[(&str, Value)])]| {
        let oracle = Oracle::new("composed").set("terms", written(terms)).set("combine", combine).set("budget", 1.5);
        oracle.set("max_speed", 1e9).set("dt", 1.0).step(&[([0.0, 0.0], REST)]).velocity(0)
    };
    let both: &[(&str, &[(&str, Value)])] =
        &[("travel", &[level(1), north.clone()]), ("travel", &[level(0), east.clone()])];
    close(ask("sum", both), [1.0, 1.0]);
    close(ask("first", both), [1.0, 0.0]);
    close(ask("budget", both), [1.0, 0.5]);
    // a level that comes to nothing gives way
    close(ask("first", &[("friction", &[level(0)]), ("travel", &[level(1), north.clone()])]), [0.0, 1.0]);
    close(ask("budget", &[("travel", &[("weight", 2.0.into()), east]), ("travel", &[level(1), north])]), [1.5, 0.0]);
}

/// A small crowd in a torus after some steps, in both ways of summing.
fn crowd(model: &str, given: &[(&str, Value)], sets: &[(&str, Perception<f64, 2>)], listed: bool) -> World<f64, 2> {
    let mut oracle = Oracle::new(model).space(Space::periodic([40.0, 40.0])).live();
    for (name, value) in given {
        oracle = oracle.set(name, value.clone());
    }
    oracle.plan.groups[0].sets = sets.iter().map(|(name, p)| ((*name).to_owned(), p.clone())).collect();
    if listed {
        // a limit beyond everyone, which lists obey and lanes do not know
        let sensing = crate::sensing::Ideal { range: Some(1e6), ..Default::default() };
        oracle.plan.groups[0].sensing = crate::engine::Sensing::Ideal(sensing);
    }
    // nobody stands just between two others: a sum that comes to nothing gives way, where a published law may not
    let place = |k: usize| (k as f64 * 7.31 + (k * k) as f64 * 0.0173) % 40.0;
    let agents: Vec<_> =
        (0..300).map(|k| ([place(k), place(5 * k + 1)], [(k as f64).cos(), (k as f64).sin()])).collect();
    let mut world = oracle.world(&agents);
    world.run(60);
    world
}

/// Asserts that a composition moves a crowd as the compiled model of the same law does, to the last bit.
#[track_caller]
fn same(model: &str, own: &[(&str, Value)], composed: &[(&str, Value)], sets: &[(&str, Perception<f64, 2>)]) {
    let compiled = crowd(model, own, &[], false).frame().hash();
    assert_eq!(crowd("composed", composed, sets, false).frame().hash(), compiled, "{model} in lanes");
    assert_eq!(crowd("composed", composed, sets, true).frame().hash(), compiled, "{model} over lists");
}

#[test]
fn compositions_of_published_laws_are_these_laws_to_the_bit() {
    same("boids_rule_vectors", &[], &[], &[]);
    let terms = written(&[("keep_heading", &[]), ("align", &[("take", "sum".into())])]);
    let common =
        [("radius", 2.0.into()), ("speed", 0.3.into()), ("noise_amplitude", 0.5.into()), ("time_step", 1.0.into())];
    let mut vicsek = vec![("terms", terms), ("motion", "direction".into()), ("position_update", "old_velocity".into())];
    vicsek.extend(common.clone());
    same("vicsek_1995", &common, &vicsek, &[]);
    let sum = || ("take", Value::from("sum"));
    let constant = || ("by_distance", Value::from("constant"));
    let set = |name: &str| ("set", Value::from(name));
    let after = || ("priority", Value::from(1usize));
    let terms = written(&[
        ("repel", &[set("repulsion"), constant(), sum()]),
        ("align", &[set("orientation"), sum(), after()]),
        ("attract", &[set("attraction"), constant(), sum(), after()]),
    ]);
    let view = || Perception::angle(270f64.to_radians());
    let zones = [
        ("repulsion", Perception::distance(0.0, 1.0)),
        ("orientation", Perception::distance(1.0, 6.0).both(view())),
        ("attraction", Perception::distance(6.0, 14.0).both(view())),
    ];
    let couzin = [
        ("terms", terms),
        ("combine", "first".into()),
        ("motion", "direction".into()),
        ("speed", 3.0.into()),
        ("turning_rate", 40f64.to_radians().into()),
    ];
    same("couzin_2002", &[], &couzin, &zones);
}

#[test]
fn ranked_sets_are_summed_over_lists() {
    let terms = written(&[("align", &[("set", "nearest ones".into())])]);
    let given = [("terms", terms)];
    let seven = crowd("composed", &given, &[("nearest ones", Perception::KNearest(7))], false);
    let all = crowd("composed", &given, &[("nearest ones", Perception::All)], false);
    assert!(seven.frame().finite() && seven.frame().hash() != all.frame().hash());
}

#[test]
fn wrong_compositions_are_refused_by_name() {
    let refused = |terms: Value, sets: &[(&str, Perception<f64, 2>)]| {
        let mut plan = Oracle::<2>::new("composed").set("terms", terms).plan;
        plan.groups[0].sets = sets.iter().map(|(name, p)| ((*name).to_owned(), p.clone())).collect();
        match World::new(plan) {
            Err(error @ (WorldError::Parameter { .. } | WorldError::Group { .. })) => error.to_string(),
            _ => String::new(),
        }
    };
    let says = |text: String, parts: &[&str]| assert!(parts.iter().all(|part| text.contains(part)), "{text}");
    says(refused(written(&[("algin", &[])]), &[]), &["`algin`", "did you mean `align`"]);
    says(refused(written(&[("align", &[("wieght", 1.0.into())])]), &[]), &["`wieght`", "did you mean `weight`"]);
    says(refused(written(&[("align", &[("weight", f64::NAN.into())])]), &[]), &["`weight` must be"]);
    says(refused(written(&[("align", &[("weight", f64::INFINITY.into())])]), &[]), &["`weight` must be"]);
    says(refused(Value::List(Vec::new()), &[]), &["at least one term"]);
    says(refused(written(&[("align", &[("set", "near".into())])]), &[]), &["set `near`", "selection"]);
    says(
        refused(written(&[("align", &[("set", "near".into())])]), &[("neer", Perception::All)]),
        &["`neer`", "did you mean `near`"],
    );
    says(refused(written(&[("goal", &[])]), &[]), &["`goal`", "`point` of 2 coordinates"]);
    says(refused(written(&[("goal", &[("point", [1.0].into())])]), &[]), &["2 coordinates, found 1"]);
    says(refused(written(&[("wander", &[][..]); 3]), &[]), &["there can be 2"]);
    says(refused(written(&[("align", &[][..]); 9]), &[]), &["8 terms"]);
    let sets: Vec<(&str, Vec<(&str, Value)>)> =
        ["a", "b", "c", "d", "e"].map(|s| ("align", vec![("set", s.into())])).to_vec();
    let sets: Vec<(&str, &[(&str, Value)])> = sets.iter().map(|(id, given)| (*id, &given[..])).collect();
    says(refused(written(&sets), &[]), &["4 named sets"]);
    let composed = crate::models::composed::Composed::<f64>::from_values(&Values::new());
    assert!(composed.is_ok_and(|composed| composed.terms.0.len() == 3));
}

#[test]
fn explanations_tell_terms_levels_and_sets() {
    let terms =
        written(&[("repel", &[]), ("repel", &[("scale", 2.0.into())]), ("keep_speed", &[("priority", 1usize.into())])]);
    let oracle = Oracle::<2>::new("composed").set("terms", terms).set("combine", "first");
    let mut world = oracle.world(&[([0.0, 0.0], [1.0, 0.0]), ([2.0, 0.0], REST)]);
    let names = |world: &mut World<f64, 2>| -> Vec<&str> {
        world.explain(0).map(|told| told.components.iter().map(|c| c.name).collect()).unwrap_or_default()
    };
    assert_eq!(names(&mut world), ["repel neighbours", "repel neighbours (2)"]);
    let sets = world.explain(0).map(|told| told.sets.iter().map(|set| (set.name, set.acts)).collect::<Vec<_>>());
    assert_eq!(sets, Some(vec![("neighbours", true)]));
}
