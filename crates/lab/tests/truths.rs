//! Truths about published models that follow on paper, held against the engine step by step. The table of all is in
//! `studies/literature/README.md`; what takes long is a study there.

use measure::near::nearest_others;
use space::{Space, Vector};
use std::collections::BTreeMap;
use std::error::Error;
use swarm::engine::{GroupPlan, Placement, Start};
use swarm::models::{Catalogue, Models};
use swarm::parameters::Values;
use swarm::{World, WorldPlan};

type Fine = Result<(), Box<dyn Error>>;

/// Numbers in [0, 1), the same in every run (splitmix64).
fn number(place: u64) -> f64 {
    let mut z = place.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Vectors of components in [low, high).
fn vectors<const D: usize>(count: usize, seed: u64, low: f64, high: f64) -> Vec<Vector<f64, D>> {
    let component = |k: usize, a: usize| low + (high - low) * number(seed * 1_000_003 + (k * D + a) as u64);
    (0..count).map(|k| Vector(core::array::from_fn(|a| component(k, a)))).collect()
}

fn world<const D: usize>(
    space: Space<f64, D>,
    model: &str,
    values: &[(&str, f64)],
    position: Vec<Vector<f64, D>>,
    velocity: Vec<Vector<f64, D>>,
) -> Result<World<f64, D>, Box<dyn Error>>
where
    Models: Catalogue<f64, D>,
{
    let values: Values = values.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
    let count = position.len();
    let start = Start { position, velocity: Some(velocity), columns: BTreeMap::new() };
    let mut plan = WorldPlan::new(space, GroupPlan::new("group", model, values, count, Placement::Given(start)));
    plan.seed = 11;
    World::new(plan).map_err(|error| error.to_string().into())
}

/// Places and velocities, in the order of ids.
type State<const D: usize> = (Vec<Vector<f64, D>>, Vec<Vector<f64, D>>);

fn state<const D: usize>(world: &World<f64, D>) -> State<D> {
    let frame = world.frame();
    let of = |row: &usize| (frame.columns.position(*row), frame.columns.velocity(*row));
    frame.rows_by_id().iter().map(of).unzip()
}

/// T1.7: at speed 0 nobody moves; every step is as long as the speed; nobody leaves the box.
#[test]
fn points_of_vicsek_keep_their_speed_and_their_box() -> Fine {
    let side = 7.0;
    for (speed, noise) in [(0.0, 0.0), (0.03, 1.0), (0.9, 6.0)] {
        let values = [("radius", 1.0), ("speed", speed), ("noise_amplitude", noise)];
        let space = Space::periodic([side; 2]);
        let mut world = world(space, "vicsek_1995", &values, vectors(90, 1, 0.0, side), vectors(90, 2, -1.0, 1.0))?;
        world.step();
        for _ in 0..40 {
            let (before, _) = state(&world);
            world.step();
            let (after, _) = state(&world);
            for (from, to) in before.iter().zip(&after) {
                assert!((space.offset(*from, *to).length() - speed).abs() < 1e-12);
                assert!(to.0.iter().all(|x| (0.0..side).contains(x)), "{to:?}");
                assert!(speed > 0.0 || from == to);
            }
        }
    }
    Ok(())
}

/// T3.5: no turn is wider than the turning rate allows, and every step is speed times time; two within the zone of repulsion part.
#[test]
fn fish_of_couzin_turn_within_their_rate() -> Fine {
    let limit = 40f64.to_radians() * 0.1;
    let values = [("orientation_radius", 3.0), ("attraction_radius", 17.0), ("speed", 3.0), ("turning_rate", 40.0)];
    let mut fish =
        world(Space::open(), "couzin_2002", &values, vectors::<3>(60, 3, 0.0, 8.0), vectors(60, 4, -1.0, 1.0))?;
    fish.step();
    for _ in 0..200 {
        let (places, before) = state(&fish);
        fish.step();
        let (there, after) = state(&fish);
        for k in 0..60 {
            assert!(before[k].angle_to(after[k]) <= limit + 1e-9, "fish {k}");
            assert!(((there[k] - places[k]).length() - 0.3).abs() < 1e-9, "fish {k}");
        }
    }
    let pair = vec![Vector([0.0, 0.0, 0.0]), Vector([0.4, 0.0, 0.0])];
    let side_by_side = vec![Vector([0.0, 3.0, 0.0]); 2];
    let mut pair = world(Space::open(), "couzin_2002", &values, pair, side_by_side)?;
    let mut apart = 0.4;
    for _ in 0..6 {
        pair.step();
        let (places, _) = state(&pair);
        let now = (places[1] - places[0]).length();
        assert!(now > apart, "{now} after {apart}");
        apart = now;
    }
    Ok(())
}

/// T3.5: a lone fish turns by normal angles of 0.05 rad, where its turning rate allows them (the usual one cuts them at 0.07 rad).
#[test]
fn a_lone_fish_of_couzin_wanders_by_its_noise() -> Fine {
    let values = [("noise_deviation", 0.05), ("turning_rate", 400.0)];
    let mut fish = world(Space::open(), "couzin_2002", &values, vec![Vector([0.0, 0.0])], vec![Vector([3.0, 0.0])])?;
    let (mut squares, mut sum) = (0.0, 0.0);
    let steps = 4000;
    for _ in 0..steps {
        let (_, before) = state(&fish);
        fish.step();
        let (_, after) = state(&fish);
        let turn = before[0].left().dot(after[0]).atan2(before[0].dot(after[0]));
        squares += turn * turn;
        sum += turn;
    }
    let n = f64::from(steps);
    // four standard errors: 0.05 / sqrt(2 n), and 0.05 / sqrt n
    assert!(((squares / n).sqrt() - 0.05).abs() < 4.0 * 0.05 / (2.0 * n).sqrt(), "{}", (squares / n).sqrt());
    assert!((sum / n).abs() < 4.0 * 0.05 / n.sqrt(), "{}", sum / n);
    Ok(())
}

/// T4.1: a flock that is stretched keeps its neighbours by rank, and loses those by distance; so do the laws that use them.
#[test]
fn ranks_survive_stretching_and_distances_do_not() -> Fine {
    let places = vectors::<3>(120, 5, 0.0, 10.0);
    let velocity = vectors::<3>(120, 6, -1.0, 1.0);
    let wide: Vec<_> = places.iter().map(|&place| place * 2.0).collect();
    let seven = |places: &[Vector<f64, 3>]| {
        let nearest = nearest_others(&Space::open(), places, 7).unwrap_or_default();
        nearest.iter().map(|&(_, other)| other).collect::<Vec<_>>()
    };
    assert_eq!(seven(&places).len(), 7 * 120);
    assert_eq!(seven(&places), seven(&wide));
    let headings = |model: &str, places: &[Vector<f64, 3>]| {
        let values = [if model == "vicsek_1995" { ("radius", 2.5) } else { ("neighbour_count", 7.0) }];
        let mut flock = world(Space::open(), model, &values, places.to_vec(), velocity.clone())?;
        flock.step();
        Ok::<_, Box<dyn Error>>(state(&flock).1.into_iter().map(Vector::unit).collect::<Vec<_>>())
    };
    let turned = |model: &str| {
        let (narrow, wide) = (headings(model, &places)?, headings(model, &wide)?);
        Ok::<_, Box<dyn Error>>(narrow.iter().zip(&wide).filter(|(one, other)| one.angle_to(**other) > 1e-6).count())
    };
    assert_eq!(turned("ballerini_2008")?, 0);
    assert!(turned("vicsek_1995")? > 60);
    Ok(())
}

/// T5.1: total momentum stays to rounding, and the greatest difference of velocities never grows.
#[test]
fn agents_of_cucker_and_smale_keep_their_momentum() -> Fine {
    for exponent in [0.25, 1.0, 3.0] {
        let values = [("decay_exponent", exponent), ("coupling", 0.05)];
        let mut agents = world(
            Space::open(),
            "cucker_smale_2007",
            &values,
            vectors::<3>(25, 7, 0.0, 3.0),
            vectors(25, 8, -1.0, 1.0),
        )?;
        let momentum = |velocities: &[Vector<f64, 3>]| velocities.iter().fold(Vector::ZERO, |sum, v| sum + *v);
        let widest = |velocities: &[Vector<f64, 3>]| {
            let differences = velocities.iter().flat_map(|v| velocities.iter().map(move |w| (*v - *w).length()));
            differences.fold(0.0, f64::max)
        };
        let (_, first) = state(&agents);
        let mut before = widest(&first);
        for _ in 0..300 {
            agents.step();
            let (_, now) = state(&agents);
            assert!((momentum(&now) - momentum(&first)).length() < 1e-11);
            assert!(widest(&now) <= before * (1.0 + 1e-12));
            before = widest(&now);
        }
        assert!(before < widest(&first));
    }
    Ok(())
}

/// T9.1: the speed of a lone particle approaches alpha/beta exponentially, or the square root of it.
#[test]
fn lone_particles_reach_the_speed_of_their_friction() -> Fine {
    let at = |x: f64| Vector([x, 0.0]);
    let mut levine = world(Space::open(), "levine_2000", &[], vec![at(0.0)], vec![at(0.5)])?;
    let (alpha, beta, step) = (1.0, 0.5f64, 0.05);
    for n in 1..400u32 {
        levine.step();
        let (_, velocity) = state(&levine);
        // the same with steps in place of the exponential
        let decayed = (1.0 - beta * step).powi(n as i32);
        assert!((velocity[0].0[0] - (alpha / beta + (0.5 - alpha / beta) * decayed)).abs() < 1e-9, "step {n}");
    }
    let mut dorsogna = world(Space::open(), "dorsogna_2006", &[], vec![at(0.0)], vec![at(0.5)])?;
    for _ in 0..4000 {
        dorsogna.step();
    }
    let (_, velocity) = state(&dorsogna);
    assert!((velocity[0].length() - 3.2f64.sqrt()).abs() < 1e-9);
    Ok(())
}
