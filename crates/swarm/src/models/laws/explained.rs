//! What an explanation tells is what a step does, and telling it changes nothing: for every model, driver and sensing.

use super::*;
use crate::detection::readings::ReadingDetection;
use crate::engine::explain::Explanation;
use crate::engine::{MotionNoise, Sensing};
use crate::physics::{Contact, Met, Mobility};
use crate::sensing::robot::Robot;
use crate::sensing::scanner::Scanner;
use crate::sensing::{Ideal, Occlusion, SensingNoise};
use space::obstacles::Obstacle;
use space::shape::Shape;

const AGENTS: usize = 36;
const SIDE: f64 = 10.0;
/// Scanning robots: each casts hundreds of rays a step.
const ROBOTS: usize = 8;
/// Steps after which agents are explained.
const BEFORE: u64 = 5;
/// Steps after which the state must still be that of a world in which nobody was explained.
const AFTER: u64 = 100;

/// Drivers, with the index that goes with each.
fn drivers() -> [(Driver, IndexChoice); 6] {
    let (tick, period, delay) = (0.02, 0.06, 0.06);
    let regular = Clock::Regular { jitter: 0.1 };
    [
        (Driver::Synchronous, IndexChoice::Pairs),
        (Driver::Synchronous, IndexChoice::Cells),
        (Driver::Sequential(Order::RoundRobin), IndexChoice::Cells),
        (Driver::Sequential(Order::Random), IndexChoice::Pairs),
        (Driver::Asynchronous { tick, period, phase: Phase::Spread, clock: regular, delay }, IndexChoice::Pairs),
        (
            Driver::Asynchronous { tick, period, phase: Phase::Random, clock: Clock::Poisson, delay: 0.0 },
            IndexChoice::Pairs,
        ),
    ]
}

/// Perfect sensing in a torus.
const PERFECT: usize = 0;
/// Limited and erring sensing, with erring bodies, among walls and obstacles.
const LIMITED: usize = 1;
/// Robots that scan.
const LASER: usize = 2;

/// Puts a world into surroundings.
fn surroundings<R: Scalar, const D: usize>(plan: &mut WorldPlan<R, D>, which: usize) {
    if which == PERFECT {
        plan.space = Space::periodic([R::of(SIDE); D]);
        return;
    }
    plan.space = Space::walled([R::of(SIDE); D]);
    let ball = Shape::Ball { centre: Vector([R::of(0.4 * SIDE); D]), radius: R::ONE };
    plan.obstacles.push(Obstacle::new(ball));
    let group = &mut plan.groups[0];
    group.radius = Some(R::of(0.15));
    group.noise =
        MotionNoise { computation: R::of(0.05), execution_direction: R::of(0.1), execution_speed: R::of(0.1) };
    if which == LIMITED {
        group.mobility = Mobility::TurnLimited { rate: R::of(2.0), vertical: None };
        group.sensing = Sensing::Ideal(Ideal {
            range: Some(R::of(6.0)),
            field_of_view: Some(R::of(4.0)),
            occlusion: Occlusion::All,
            noise: SensingNoise {
                distance: R::of(0.05),
                direction: R::of(0.05),
                heading: R::of(0.1),
                miss: R::of(0.1),
            },
            ..Ideal::default()
        });
    } else {
        group.mobility = Mobility::DifferentialDrive(Default::default());
        group.contact = Some(Contact::Slide);
        group.sensing = Sensing::Scanner(Box::new(Robot {
            scanner: Scanner { noise: Some(Default::default()), ..Scanner::default() },
            detection: ReadingDetection::SensorBased { least_intensity: R::of(0.25) },
            association: Some(R::of(0.5)),
            errors: None,
            widest_body: R::ZERO,
        }));
    }
}

fn near(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    let size = a.iter().chain(b).fold(1.0f64, |most, v| most.max(v.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= tolerance * size)
}

/// What is wrong with an explanation by itself.
fn inconsistent<R: Scalar>(told: &Explanation) -> Option<String> {
    let finite = |v: &[f64]| v.iter().all(|v| v.is_finite());
    if let Some(component) = told.components.iter().find(|component| !finite(&component.vector)) {
        return Some(format!("not finite: {component:?}"));
    }
    let members: usize = told.sets.iter().map(|set| set.members.len()).sum();
    if members > 0 && told.components.is_empty() {
        return Some("neighbours and no component".into());
    }
    if !told.decides && (members > 0 || !told.components.is_empty()) {
        return Some("told though nothing is decided".into());
    }
    if let Some(sum) = &told.sum {
        let mut added = vec![0.0; sum.len()];
        let mut size = 0.0f64;
        for component in &told.components {
            for (to, v) in added.iter_mut().zip(&component.vector) {
                *to += v;
                size = size.max(v.abs());
            }
        }
        let tolerance = if R::NAME == "f32" { 1e-5 } else { 1e-12 };
        if added.iter().zip(sum).any(|(a, b)| (a - b).abs() > tolerance * size) {
            return Some(format!("components add to {added:?}, not {sum:?}: {:?}", told.components));
        }
    }
    if !told.choice.is_empty() {
        let total: f64 = told.choice.iter().map(|choice| choice.probability).sum();
        let chosen: Vec<_> = told.choice.iter().filter(|choice| choice.chosen).collect();
        if (total - 1.0).abs() > 1e-12 || chosen.len() != 1 || chosen[0].probability <= 0.0 {
            return Some(format!("{:?}", told.choice));
        }
    }
    for set in &told.sets {
        if set.acts && set.members.is_empty() {
            return Some(format!("{} acts without members", set.name));
        }
        if !set.members.iter().all(|member| told.detected.contains(member)) {
            return Some(format!("{} has members that were not detected", set.name));
        }
    }
    None
}

/// Explains some agents, then steps, and compares with a world in which nobody was explained.
fn explained<R: Scalar, const D: usize>(entry: &Entry, driver: usize, which: usize) -> bool
where
    Models: Catalogue<R, D>,
{
    let (agents, after) = if which == LASER { (ROBOTS, AFTER / 5) } else { (AGENTS, AFTER) };
    let make = || {
        let mut p = plan(entry, noisy(entry), Space::open(), positions::<R, D>(agents, SIDE), velocities(agents));
        surroundings(&mut p, which);
        (p.driver, p.index) = drivers()[driver];
        World::new(p)
    };
    let (mut world, mut twin) = match (make(), make()) {
        (Ok(world), Ok(twin)) => (world, twin),
        // what the model cannot work with, such as a scanner that shows no identities
        (Err(WorldError::Group { .. }), _) => return false,
        _ => unreachable!("{}", entry.card.id),
    };
    for again in 0..2 {
        world.run(BEFORE);
        twin.run(BEFORE);
        let (state, met) = (world.save().to_bytes(), world.met().to_vec());
        let told: Vec<Explanation> =
            [0, 1, agents as u32 / 2, agents as u32 - 1].iter().filter_map(|&id| world.explain(id)).collect();
        assert_eq!(told.len(), 4);
        assert!(world.save().to_bytes() == state && world.met() == met, "{}: explaining changed it", entry.card.id);
        world.step();
        twin.step();
        for told in &told {
            let what = format!(
                "{} {D}-D {} agent {} driver {driver} surroundings {which} time {again}",
                entry.card.id,
                R::NAME,
                told.agent
            );
            assert_eq!(inconsistent::<R>(told), None, "{what}");
            let place = |v: Vector<R, D>| v.0.map(|v| v.to_f64()).to_vec();
            let (position, velocity) = (place(twin.position(told.agent)), place(twin.velocity(told.agent)));
            assert_eq!((&told.performed.position, &told.performed.velocity), (&position, &velocity), "{what}");
            if told.met == Met::Nothing {
                assert_eq!(told.unhindered.velocity, velocity, "{what}");
                // a turn that may be refused is computed anew from where it began
                let tolerance = if R::NAME == "f32" { 1e-5 } else { 1e-12 };
                let same = told.unhindered.position == position
                    || driver > 1 && which != PERFECT && near(&told.unhindered.position, &position, tolerance);
                assert!(same, "{what}: {:?} {position:?}", told.unhindered.position);
            }
            if which == PERFECT && told.decides {
                assert_eq!(told.wanted.velocity, told.unhindered.velocity, "{what}");
            }
        }
    }
    world.run(after);
    twin.run(after);
    assert!(world.save().to_bytes() == twin.save().to_bytes(), "{}: explaining changed what follows", entry.card.id);
    true
}

fn all_drivers<R: Scalar, const D: usize>(entry: &Entry)
where
    Models: Catalogue<R, D>,
{
    for which in [PERFECT, LIMITED] {
        for driver in 0..drivers().len() {
            // the drivers are the same code in both precisions: f32 sees each with one of the surroundings
            if R::NAME == "f32" && driver % 2 != which {
                continue;
            }
            assert!(explained::<R, D>(entry, driver, which), "{} refuses plain sensing", entry.card.id);
        }
    }
}

#[test]
fn an_explanation_is_what_a_step_does() {
    for_all!(all_drivers);
}

#[test]
fn an_explanation_behind_a_laser_is_what_a_step_does() {
    let mut models = 0;
    for entry in LIST.iter().filter(|entry| entry.dimensions.contains(&2)) {
        for driver in [0, 3, 4] {
            models += usize::from(explained::<f64, 2>(entry, driver, LASER));
        }
    }
    assert!(models >= 3 * 12, "only {models} laws and drivers work behind a laser");
}

/// Resources feed, starve and kill; contacts refuse, reflect and clamp: all of it is told, and taken back.
#[test]
fn what_happens_after_the_motion_is_told_and_taken_back() {
    let Some(entry) = LIST.iter().find(|e| e.card.id == "competing_flocks") else { unreachable!("it is listed") };
    for contact in [Contact::Refuse, Contact::Reflect, Contact::Clamp, Contact::Slide] {
        let make = || {
            let mut p = plan::<f64, 2>(
                entry,
                Values::new(),
                Space::walled([SIDE; 2]),
                positions(AGENTS, SIDE),
                velocities(AGENTS),
            );
            p.groups[0].contact = Some(contact);
            p.groups[0].radius = Some(0.2);
            p.resources = Some(crate::resources::ResourcePlan {
                items: positions(12, SIDE),
                within: 1.0,
                respawn: crate::resources::Respawn::After(1.5),
                gains: vec![crate::resources::Gain { column: "energy".into(), amount: 100.0, capacity: 200.0 }],
                metabolism: Some(crate::resources::Metabolism {
                    energy: "energy".into(),
                    cost: 20.0,
                    health: "health".into(),
                    starvation: 3.0,
                    ..Default::default()
                }),
                ..Default::default()
            });
            world(p)
        };
        let (mut world, mut twin) = (make(), make());
        let mut met = 0;
        for _ in 0..8 {
            let told: Vec<Explanation> = (0..AGENTS as u32).filter_map(|id| world.explain(id)).collect();
            world.step();
            twin.step();
            for told in told {
                assert_eq!(told.performed.position, twin.position(told.agent).0.to_vec());
                assert_eq!(told.met, twin.met()[told.agent as usize]);
                met += usize::from(told.met != Met::Nothing);
            }
        }
        assert!(met > 0, "{contact:?} met nothing");
        let dead = (0..AGENTS as u32).filter(|&id| world.state(id, "health") == Some(0.0)).count();
        assert!(dead > 0 && dead < AGENTS, "{dead} died");
        assert!(world.save().to_bytes() == twin.save().to_bytes(), "{contact:?}");
    }
}

#[test]
fn who_is_not_there_is_not_explained() {
    let Some(entry) = LIST.first() else { unreachable!("there are models") };
    let mut world = world(plan::<f64, 2>(entry, Values::new(), Space::open(), positions(3, 1.0), velocities(3)));
    assert!(world.explain(2).is_some() && world.explain(3).is_none());
}

/// The checks above can fail.
#[test]
fn a_wrong_explanation_is_noticed() {
    let Some(entry) = LIST.iter().find(|e| e.card.id == "couzin_2002") else { unreachable!("couzin_2002 is listed") };
    let mut school = world(plan::<f64, 2>(entry, noisy(entry), Space::open(), positions(20, 5.0), velocities(20)));
    let Some(told) = school.explain(4) else { unreachable!("there are 20") };
    assert_eq!(inconsistent::<f64>(&told), None);
    let wrong = |change: &dyn Fn(&mut Explanation)| {
        let mut told = told.clone();
        change(&mut told);
        inconsistent::<f64>(&told).is_some()
    };
    assert!(wrong(&|told| told.components.clear()));
    assert!(wrong(&|told| told.components[0].vector[1] = f64::NAN));
    assert!(wrong(&|told| told.sum = Some(vec![1e3, 0.0])));
    assert!(wrong(&|told| told.choice[0].probability += 0.5));
    assert!(wrong(&|told| told.detected.clear()));
    assert!(wrong(&|told| told.decides = false));
}
