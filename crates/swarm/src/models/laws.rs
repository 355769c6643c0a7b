//! Laws that hold for every listed model, whatever it says: generated from the list.

use crate::engine::{
    Checkpoint, Clock, Driver, GroupPlan, IndexChoice, Order, Phase, Placement, Start, World, WorldError, WorldPlan,
};
use crate::models::{Catalogue, Entry, LIST, Models};
use crate::motion::Injected;
use crate::parameters::{Kind, Scalar, Value, Values};
use space::random::{Purpose, uniform};
use space::{Space, Vector};
use std::fmt::Write as _;

/// Parameters under which random quantities are drawn.
fn noisy(entry: &Entry) -> Values {
    (entry.parameters)()
        .iter()
        .filter(|d| d.name.contains("noise") && d.default == Value::Number(0.0))
        .map(|d| (d.name.to_owned(), Value::Number(0.3)))
        .collect()
}

fn positions<R: Scalar, const D: usize>(agents: usize, side: f64) -> Vec<Vector<R, D>> {
    (0..agents as u64)
        .map(|i| Vector(core::array::from_fn(|a| R::of(side * uniform(77, Purpose::Init, i, a as u32)))))
        .collect()
}

fn velocities<R: Scalar, const D: usize>(agents: usize) -> Vec<Vector<R, D>> {
    (0..agents as u64)
        .map(|i| Vector(core::array::from_fn(|a| R::of(uniform(78, Purpose::Init, i, a as u32) - 0.5))))
        .collect()
}

fn plan<R: Scalar, const D: usize>(
    entry: &Entry,
    values: Values,
    space: Space<R, D>,
    position: Vec<Vector<R, D>>,
    velocity: Vec<Vector<R, D>>,
) -> WorldPlan<R, D> {
    let start = Start { position, velocity: Some(velocity), columns: Default::default() };
    let count = start.position.len();
    let mut plan = WorldPlan::new(space, GroupPlan::new("g", entry.card.id, values, count, Placement::Given(start)));
    plan.seed = 5;
    plan
}

#[track_caller]
fn world<R: Scalar, const D: usize>(plan: WorldPlan<R, D>) -> World<R, D>
where
    Models: Catalogue<R, D>,
{
    World::new(plan).unwrap_or_else(|error| unreachable!("{error}"))
}

/// Calls `$check::<R, D>(entry)` for every listed model in every dimension it works in, in both precisions.
macro_rules! for_all {
    ($check:ident) => {
        for entry in LIST {
            for &dimension in entry.dimensions {
                match dimension {
                    1 => {
                        $check::<f32, 1>(entry);
                        $check::<f64, 1>(entry);
                    }
                    2 => {
                        $check::<f32, 2>(entry);
                        $check::<f64, 2>(entry);
                    }
                    _ => {
                        $check::<f32, 3>(entry);
                        $check::<f64, 3>(entry);
                    }
                }
            }
        }
    };
}

mod explained;

#[test]
fn ids_are_file_names_and_cards_are_full() {
    for entry in LIST {
        let card = entry.card;
        assert!(LIST.iter().filter(|other| other.card.id == card.id).count() == 1, "{} is listed once", card.id);
        for text in [card.title, card.about, card.equations, card.departures, card.edge, card.stages.motion] {
            assert!(!text.trim().is_empty(), "{} leaves a part of its card empty", card.id);
        }
        assert!(card.reference.len() > 20, "{} needs a reference", card.id);
        let descriptors = (entry.parameters)();
        for (k, d) in descriptors.iter().enumerate() {
            assert!(
                !d.about.trim().is_empty() && !d.unit.is_empty() && !d.symbol.is_empty(),
                "{}: {}",
                card.id,
                d.name
            );
            let names = |e: &crate::parameters::Descriptor| [Some(e.name), e.alias];
            for other in &descriptors[..k] {
                let clash = names(d).into_iter().flatten().any(|n| names(other).contains(&Some(n)));
                assert!(!clash, "{}: `{}` and `{}` share a name", card.id, d.name, other.name);
            }
        }
    }
}

#[test]
fn parameters_survive_a_round_trip() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        let prepared = Models::prepare(entry.card.id, &Values::new(), 3);
        assert!(matches!(prepared, Some(Ok(_))), "{}: defaults lie outside their own ranges", entry.card.id);
        let unknown: Values = [("no_such_parameter".to_owned(), Value::Number(1.0))].into();
        assert!(matches!(Models::prepare(entry.card.id, &unknown, 3), Some(Err(_))));
        for d in (entry.parameters)() {
            let given: Values = [(d.name.to_owned(), d.default.clone())].into();
            assert!(matches!(Models::prepare(entry.card.id, &given, 3), Some(Ok(_))), "{}: {}", entry.card.id, d.name);
        }
    }
    for_all!(check);
}

#[test]
fn degenerate_states_stay_finite() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        let id = entry.card.id;
        let run = |what: &str, space: Space<R, D>, at: Vec<Vector<R, D>>, going: Vec<Vector<R, D>>| {
            for index in [IndexChoice::Pairs, IndexChoice::Cells] {
                let mut p = plan(entry, noisy(entry), space, at.clone(), going.clone());
                p.index = index;
                let mut world = match World::new(p) {
                    Ok(world) => world,
                    // a clear refusal is an answer too
                    Err(WorldError::World(_) | WorldError::Group { .. } | WorldError::Parameter { .. }) => return,
                    Err(error) => unreachable!("{id}: {error}"),
                };
                world.run(25);
                assert!(world.frame().finite(), "{id} {D}-D {}: {what} ({index:?})", R::NAME);
            }
        };
        let point = Vector([R::of(3.0); D]);
        let still = Vector::ZERO;
        for space in [Space::open(), Space::periodic([R::of(40.0); D]), Space::walled([R::of(40.0); D])] {
            for n in [0, 1, 2, 3] {
                run("few members", space, positions(n, 10.0), velocities(n));
            }
            run("all at one point", space, vec![point; 20], velocities(20));
            run("all at one point, at rest", space, vec![point; 20], vec![still; 20]);
            run("at rest", space, positions(20, 10.0), vec![still; 20]);
            let huge = |v: Vector<R, D>| v * R::of(1e15);
            run("huge velocities", space, positions(20, 10.0), velocities(20).into_iter().map(huge).collect());
            run("tiny velocities", space, positions(20, 10.0), vec![Vector([R::of(1e-30); D]); 20]);
            run(
                "a line of equal distances",
                space,
                (0..12).map(|k| Vector::axis(0) * R::count(k)).collect(),
                vec![still; 12],
            );
        }
        run("far apart", Space::open(), positions(20, 1e12), velocities(20));
        run("huge numbers", Space::open(), positions(20, 1e25), velocities(20));
    }
    for_all!(check);
}

#[test]
fn huge_steps_stay_finite() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        for d in (entry.parameters)() {
            if !["time_step", "step_length", "speed"].contains(&d.name) {
                continue;
            }
            for size in [1e6, 1e12, 1e15] {
                let values: Values = [(d.name.to_owned(), Value::Number(size))].into();
                let p = plan(entry, values, Space::open(), positions::<R, D>(12, 5.0), velocities(12));
                let Ok(mut world) = World::new(p) else { continue };
                world.run(20);
                assert!(world.frame().finite(), "{} {D}-D {} {} = {size}", entry.card.id, R::NAME, d.name);
            }
        }
    }
    for_all!(check);
}

/// Everything displaced by the same vector moves alike. Draws depend on ids and steps alone, so they may be live.
#[test]
fn translation_changes_nothing() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        if R::NAME == "f32" {
            return;
        }
        let by = Vector([R::of(16.0); D]);
        // places that parameters give are displaced too
        let mut displaced = noisy(entry);
        for d in (entry.parameters)().iter().filter(|d| d.takes == Kind::Points && d.unit != "1") {
            if let Value::List(point) = &d.default {
                let moved = |c: &Value| if let Value::Number(c) = c { Value::Number(c + 16.0) } else { c.clone() };
                displaced.insert(d.name.to_owned(), Value::List(point.iter().map(moved).collect()));
            }
        }
        let at = positions::<R, D>(30, 6.0);
        let mut here = world(plan(entry, noisy(entry), Space::open(), at.clone(), velocities(30)));
        let moved = at.into_iter().map(|p| p + by).collect();
        let mut there = world(plan(entry, displaced, Space::open(), moved, velocities(30)));
        here.step();
        there.step();
        for id in 0..30 {
            let difference = (there.position(id) - by - here.position(id)).length().to_f64();
            let turned = (there.velocity(id) - here.velocity(id)).length().to_f64();
            let size = 1.0 + here.velocity(id).length().to_f64();
            assert!(
                difference < 1e-9 * size && turned < 1e-9 * size,
                "{} {D}-D agent {id}: {difference} {turned}",
                entry.card.id
            );
        }
    }
    for_all!(check);
}

/// Models in which an agent's number means something beyond the choice among equals.
const NUMBERED: [(&str, &str); 6] = [
    ("contact_only", "its bodies meet, and moves are refused in the order of numbers"),
    ("jadbabaie_2002_leader", "leaders are named by their number"),
    ("lch_group_bearing", "of equally large components the one with the lowest number is taken"),
    ("lch_group_pose", "of equally large components the one with the lowest number is taken"),
    ("gazi_passino_2005", "the order of members is the law"),
    ("behaviour_selection", "its draws are always live, and belong to ids"),
];

#[test]
fn relabelling_relabels() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        if R::NAME == "f32" || NUMBERED.iter().any(|(id, _)| *id == entry.card.id) {
            return;
        }
        let n = 24;
        let (at, going) = (positions::<R, D>(n, 6.0), velocities::<R, D>(n));
        let one = |order: &dyn Fn(usize) -> usize| {
            let mut world = world(plan(
                entry,
                Values::new(),
                Space::open(),
                (0..n).map(|i| at[order(i)]).collect(),
                (0..n).map(|i| going[order(i)]).collect(),
            ));
            world.inject(Injected::default());
            world.step();
            world
        };
        let (plain, reversed) = (one(&|i| i), one(&|i| n - 1 - i));
        for i in 0..n {
            let j = (n - 1 - i) as u32;
            let difference = (plain.position(i as u32) - reversed.position(j)).length().to_f64();
            assert!(difference < 1e-9, "{} {D}-D agent {i}: {difference}", entry.card.id);
        }
    }
    for_all!(check);
}

/// A law that streams gives the same bits through lists, over cells and over all pairs; and no index changes who is met.
#[test]
fn gather_is_decide_and_every_index_agrees() {
    fn check<R: Scalar, const D: usize>(entry: &Entry)
    where
        Models: Catalogue<R, D>,
    {
        let id = entry.card.id;
        let n = 150;
        let Some(Ok(prepared)) = Models::prepare(id, &noisy(entry), n) else { unreachable!("{id}") };
        // a law that is given lists anyway differs from itself only where it marks its own sets
        let streams = prepared.stream_reach.is_some();
        if !streams && R::NAME == "f32" {
            return;
        }
        let sets: Vec<_> = prepared.sets.iter().map(|s| (s.name.to_owned(), s.perception.clone())).collect();
        for side in if streams { &[30.0, 9.0][..] } else { &[9.0] }.iter().copied() {
            for space in [Space::open(), Space::periodic([R::of(side); D])] {
                for index in [IndexChoice::Pairs, IndexChoice::Cells] {
                    let run = |sets: Vec<_>| {
                        let mut p = plan(entry, noisy(entry), space, positions(n, side), velocities(n));
                        p.index = index;
                        p.groups[0].sets = sets;
                        let mut world = world::<R, D>(p);
                        world.run(12);
                        world.frame().hash()
                    };
                    let (own, listed) = (run(Vec::new()), run(sets.clone()));
                    assert_eq!(own, listed, "{id} {D}-D {} side {side} {index:?}", R::NAME);
                }
            }
        }
    }
    for_all!(check);
}

fn contract_plan<R: Scalar, const D: usize>(entry: &Entry, agents: usize, threads: usize) -> WorldPlan<R, D> {
    let side = 10.0;
    let mut p =
        plan(entry, noisy(entry), Space::periodic([R::of(side); D]), positions(agents, side), velocities(agents));
    p.index = IndexChoice::Cells;
    p.threads = threads;
    p
}

/// Hashes of states after 2,000 steps, of every model in every dimension and both precisions; the same on every machine. In its first
/// dimension each also runs on 2 threads, and on 8, stopped, and continued on 3. `FLOCKWORKS_BLESS=1` writes the file anew, for when a law has changed.
#[test]
fn bits_never_change() {
    const STEPS: u64 = 2000;
    fn line<R: Scalar, const D: usize>(entry: &Entry, place: usize, quick: bool) -> String
    where
        Models: Catalogue<R, D>,
    {
        let id = entry.card.id;
        let run = |threads: usize| {
            let mut world = world::<R, D>(contract_plan(entry, 72, threads));
            world.run(STEPS);
            assert!(world.frame().finite(), "{id}");
            world.frame().hash()
        };
        let streams = matches!(Models::prepare(id, &noisy(entry), 72), Some(Ok(p)) if p.stream_reach.is_some());
        if quick && !streams && !place.is_multiple_of(4) {
            // at another level a law given lists is the same code; how lists are made is seen in those that remain
            return String::new();
        }
        let one = run(1);
        if !quick && entry.dimensions.first() == Some(&D) {
            assert_eq!(run(2), one, "{id} {D}-D {} on 2 threads", R::NAME);
            let mut before = world::<R, D>(contract_plan(entry, 72, 8));
            before.run(STEPS / 3);
            let mut after = world::<R, D>(contract_plan(entry, 72, 3));
            let saved = through_bytes(&before, &after);
            after.restore(&saved).unwrap_or_else(|error| unreachable!("{error}"));
            after.run(STEPS - STEPS / 3);
            assert_eq!(after.frame().hash(), one, "{id} {D}-D {}: stopped and continued", R::NAME);
        }
        format!("{id} {D} {} {one:016x}\n", R::NAME)
    }
    let quick = std::env::var_os("FLOCKWORKS_LANES").is_some();
    let mut found = String::new();
    for (place, entry) in LIST.iter().enumerate() {
        for &dimension in entry.dimensions {
            match dimension {
                1 => {
                    found += &line::<f32, 1>(entry, place, quick);
                    found += &line::<f64, 1>(entry, place, quick);
                }
                2 => {
                    found += &line::<f32, 2>(entry, place, quick);
                    found += &line::<f64, 2>(entry, place, quick);
                }
                _ => {
                    found += &line::<f32, 3>(entry, place, quick);
                    found += &line::<f64, 3>(entry, place, quick);
                }
            }
        }
    }
    compare("models.txt", &found, !quick);
}

/// Lowered instruction levels compute the same bits: the test above, run again by itself at each.
#[test]
fn bits_do_not_depend_on_the_instruction_level() {
    let Ok(me) = std::env::current_exe() else { unreachable!("a test knows its own program") };
    for level in ["portable", "avx2"] {
        let run = std::process::Command::new(&me)
            .args(["--exact", "models::laws::bits_never_change", "--test-threads", "1"])
            .env("FLOCKWORKS_LANES", level)
            .env_remove("FLOCKWORKS_BLESS")
            .output();
        let Ok(run) = run else { unreachable!("the test program starts") };
        let said = String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success() && said.contains("1 passed"), "level {level}: {said}");
    }
}

/// Compares lines with those of a file; a `whole` comparison also notices lines of what is gone.
fn compare(file: &str, found: &str, whole: bool) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/hashes").join(file);
    if std::env::var_os("FLOCKWORKS_BLESS").is_some() {
        if let Some(folder) = path.parent() {
            let _ = std::fs::create_dir_all(folder);
        }
        assert!(std::fs::write(&path, found).is_ok(), "cannot write {}", path.display());
        return;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let key = |line: &str| line.rsplit_once(' ').map(|(key, _)| key.to_owned());
    let mut wrong = String::new();
    for line in found.lines() {
        // a new model has no line yet: until it is blessed, only its threads, restarts and levels are held to agree
        let pinned = expected.lines().any(|known| key(known) == key(line));
        if pinned && !expected.lines().any(|known| known == line) {
            let _ = writeln!(wrong, "{line}");
        }
    }
    assert!(wrong.is_empty(), "these differ from {}:\n{wrong}", path.display());
    assert!(!expected.is_empty(), "{} is missing or empty", path.display());
    for known in expected.lines().filter(|_| whole) {
        assert!(
            found.lines().any(|line| key(line) == key(known)),
            "{} has a line of what is gone: {known}",
            path.display()
        );
    }
}

/// Sequential and asynchronous drivers keep the contract too, and so do bodies, scanners and noise.
#[test]
fn drivers_continue_and_repeat() {
    let Some(entry) = LIST.iter().find(|e| e.card.id == "couzin_2002") else { unreachable!("couzin_2002 is listed") };
    let drivers = [
        Driver::Sequential(Order::RoundRobin),
        Driver::Sequential(Order::Random),
        Driver::Asynchronous {
            tick: 0.02,
            period: 0.1,
            phase: Phase::Random,
            clock: Clock::Regular { jitter: 0.05 },
            delay: 0.06,
        },
        Driver::Asynchronous { tick: 0.02, period: 0.1, phase: Phase::Spread, clock: Clock::Poisson, delay: 0.0 },
    ];
    let mut found = String::new();
    for (k, driver) in drivers.into_iter().enumerate() {
        let make = |threads| {
            let mut p = contract_plan::<f64, 2>(entry, 80, threads);
            p.driver = driver;
            p.groups[0].radius = Some(0.2);
            p.groups[0].noise.execution_direction = 0.1;
            p.groups[0].noise.computation = 0.05;
            world(p)
        };
        let mut one = make(1);
        one.run(2000);
        assert!(one.frame().finite());
        let mut before = make(2);
        before.run(700);
        let mut after = make(8);
        let saved = through_bytes(&before, &after);
        assert!(after.restore(&saved).is_ok());
        after.run(1300);
        assert_eq!(one.frame().hash(), after.frame().hash(), "driver {k}");
        let _ = writeln!(found, "driver {k} {:016x}", one.frame().hash());
    }
    compare("drivers.txt", &found, true);
}

/// Each law above can fail: a force that is not mirrored, a hash that sees one changed bit.
#[test]
fn the_hash_sees_a_single_bit() {
    let Some(entry) = LIST.iter().find(|e| e.card.id == "vicsek_1995") else { unreachable!("vicsek_1995 is listed") };
    let hash = |nudge: f64| {
        let mut at = positions::<f64, 2>(10, 5.0);
        at[7].0[1] += nudge;
        world(plan(entry, Values::new(), Space::open(), at, velocities(10))).frame().hash()
    };
    assert_ne!(hash(0.0), hash(1e-15));
}

/// A state as it comes back from a file, and proof that damage is noticed.
fn through_bytes<R: Scalar, const D: usize>(before: &World<R, D>, like: &World<R, D>) -> Checkpoint<R, D>
where
    Models: Catalogue<R, D>,
{
    let (bytes, like) = (before.save().to_bytes(), like.save());
    assert!(Checkpoint::from_bytes(&bytes[..bytes.len() - 1], &like).is_none(), "a state cut short");
    assert!(Checkpoint::from_bytes(&bytes[1..], &like).is_none(), "a state that begins elsewhere");
    match Checkpoint::from_bytes(&bytes, &like) {
        Some(saved) => saved,
        None => unreachable!("a saved state reads back"),
    }
}
