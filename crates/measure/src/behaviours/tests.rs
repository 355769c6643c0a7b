//! Behaviours over courses that can be worked out by hand.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use space::segment::Passage;
use space::shape::Shape;
use space::{Segment, Vector};

type Point = Vector<f64, 2>;

fn disc(x: f64, y: f64, radius: f64) -> Shape<f64, 2> {
    Shape::Ball { centre: Vector([x, y]), radius }
}

/// Everything that any behaviour asks for.
fn setting() -> Setting {
    Setting {
        walls: vec![Segment::new([0.0, -5.0], [0.0, 5.0])],
        places: vec![("marker".into(), Vector([0.0, 0.0]))],
        regions: vec![("goal".into(), disc(0.0, 0.0, 2.0)), ("avoid".into(), disc(50.0, 0.0, 2.0))],
        gates: ["right", "left", "exit", "chute"]
            .map(|name| (name.to_owned(), Segment::new([5.0, -5.0], [5.0, 5.0])))
            .to_vec(),
        paths: Vec::new(),
    }
}

fn points(list: &[[f64; 2]]) -> Vec<Point> {
    list.iter().map(|&p| Vector(p)).collect()
}

/// A group of three that is together, but apart in the steps where it is said to be.
fn parted(apart: impl Fn(usize) -> bool, steps: usize) -> Vec<Vec<Point>> {
    let place = |k| points(&[[0.0, 0.0], [1.0, 0.0], [if apart(k) { 100.0 } else { 2.0 }, 0.0]]);
    (0..steps).map(place).collect()
}

fn fitness(id: &str, given: &[(&str, f64)], course: &[Vec<Point>]) -> f64 {
    find(id, given, &setting()).unwrap().fitness(course)
}

#[test]
fn every_behaviour_is_in_bounds_for_any_course() {
    let apart = parted(|k| k % 2 == 0, 30);
    let nobody = vec![Vec::new(); 30];
    let alone = vec![points(&[[0.0, 0.0]]); 30];
    let one_place = vec![vec![Vector([3.0, 3.0]); 5]; 30];
    let broken = vec![points(&[[f64::NAN, 0.0], [1e300, -1e300], [f64::INFINITY, 1.0]]); 3];
    for card in LIST {
        let behaviour = find(card.id, &[], &setting()).unwrap();
        for course in [&apart, &nobody, &alone, &one_place, &broken, &vec![]] {
            let fitness = behaviour.fitness(course);
            assert!((0.0..=1.0).contains(&fitness), "{}: {fitness}", card.id);
        }
        assert_eq!(behaviour.fitness(&[]), 0.0);
        for parameter in card.parameters {
            assert!(find(card.id, &[(parameter.name, -1.0)], &setting()).is_err());
            assert!(find(card.id, &[(parameter.name, f64::NAN)], &setting()).is_err());
        }
        let bare = find(card.id, &[], &Setting::default());
        let needs = card.needs.iter().any(|need| *need != "regions");
        assert_eq!(bare.is_err(), needs, "{}", card.id);
    }
    let wrong = |id: &str, given: &[(&str, f64)]| find(id, given, &setting()).unwrap_err().to_string();
    assert!(wrong("simple-spilt", &[]).contains("did you mean `simple-split`"));
    assert!(wrong("simple-split", &[("hlod", 1.0)]).contains("did you mean `hold`"));
}

#[test]
fn what_follows_step_by_step_knows_when_it_is_decided() {
    let behaviour = find("simple-split", &[("hold", 3.0), ("horizon", 10.0)], &setting()).unwrap();
    // step at which the fitness can no longer change, and the fitness at the end
    let decided = |apart: &dyn Fn(usize) -> bool| {
        let (mut watch, mut at) = (behaviour.watch(), None);
        for (k, positions) in parted(apart, 20).into_iter().enumerate() {
            let positions: Vec<_> = positions.into_iter().map(Some).collect();
            watch.step(&Moment { positions: &positions, velocities: &[], types: &[] });
            if watch.settled() && at.is_none() {
                at = Some((k, watch.fitness()));
            }
        }
        assert_eq!(at.map(|(_, fitness)| fitness), Some(watch.fitness()), "what is settled stays");
        at
    };
    assert_eq!(decided(&|k| k >= 4), Some((6, 1.0)));
    assert_eq!(decided(&|k| k >= 7), Some((9, 1.0)));
    assert_eq!(decided(&|_| false), Some((7, 0.0)), "three in a row no longer fit");
    assert_eq!(decided(&|k| k >= 8), Some((7, 0.0)));
    assert_eq!(decided(&|k| k != 5 && k != 2 && k != 8), Some((8, 0.0)));
}

#[test]
fn splits() {
    assert_eq!(fitness("simple-split", &[], &parted(|k| k >= 150, 200)), 1.0);
    assert_eq!(fitness("simple-split", &[], &parted(|k| k >= 151, 400)), 0.0);
    assert_eq!(fitness("simple-split", &[], &parted(|k| k % 49 != 48, 200)), 0.0);
    // 2 to 1 is a balance of 0.918
    assert_eq!(fitness("balanced-split", &[], &parted(|k| (10..15).contains(&k), 50)), 1.0);
    assert_eq!(fitness("balanced-split", &[], &parted(|k| (10..14).contains(&k), 50)), 0.0);
    assert_eq!(fitness("balanced-split", &[("fraction", 0.95)], &parted(|_| true, 50)), 0.0);
}

#[test]
fn corralling_with_and_without_stragglers() {
    let still = |list: &[[f64; 2]]| vec![points(list); 60];
    let together = [[0.0, 25.0], [10.0, 15.0], [-10.0, 35.0]];
    assert_eq!(fitness("corralling", &[], &still(&together)), 1.0, "at exactly 25");
    assert_eq!(fitness("corralling", &[("radius", 24.9)], &still(&together)), 0.0);
    let straggler = [[-1.0, 0.0], [1.0, 0.0], [60.0, 0.0]];
    assert_eq!(fitness("corralling", &[], &still(&straggler)), 0.0);
    assert_eq!(fitness("corralling", &[("connected", 2.0 / 3.0)], &still(&straggler)), 1.0);
}

#[test]
fn gates_are_latched() {
    let path = |out: usize| {
        let place = |k: usize| -> Vec<Point> {
            (0..10).map(|i| Vector([if i < out && k == 3 { 6.0 } else { 0.0 }, 0.1 * i as f64])).collect()
        };
        (0..8).map(place).collect::<Vec<_>>()
    };
    assert_eq!(fitness("turn-right", &[], &path(9)), 1.0);
    assert_eq!(fitness("turn-right", &[], &path(8)), 0.0);
    assert_eq!(fitness("turn-left", &[("horizon", 3.0)], &path(10)), 0.0, "too late");
    assert_eq!(fitness("throughput", &[], &path(7)), 0.7);
    let outward = |side| {
        let score = Score::Share(Signal::ShareCrossed(Segment::new([5.0, -5.0], [5.0, 5.0]), Some(side)));
        Behaviour { name: "one side".into(), score }.fitness(&path(4)[..4])
    };
    assert_eq!((outward(Passage::ToRight), outward(Passage::ToLeft)), (0.4, 0.0));
}

#[test]
fn trajectories_pass_their_gates_in_order() {
    let setting = Setting {
        regions: vec![("goal".into(), disc(9.0, 0.0, 1.0))],
        gates: [2.0, 4.0].map(|x| (format!("{x}"), Segment::new([x, -1.0], [x, 1.0]))).to_vec(),
        ..Setting::default()
    };
    let share = |paths: &[&[[f64; 2]]], horizon: f64| {
        let course: Vec<Vec<Point>> =
            (0..paths[0].len()).map(|k| paths.iter().map(|path| Vector(path[k])).collect()).collect();
        find("trajectory", &[("horizon", horizon)], &setting).unwrap().fitness(&course)
    };
    let good: &[[f64; 2]] = &[[0.0, 0.0], [3.0, 0.0], [5.0, 0.0], [8.5, 0.0]];
    let around: &[[f64; 2]] = &[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [8.5, 0.0]];
    let fast: &[[f64; 2]] = &[[0.0, 0.0], [5.0, 0.0], [8.5, 0.0], [0.0, 0.0]];
    let backwards: &[[f64; 2]] = &[[5.0, 0.0], [3.0, 0.0], [1.0, 0.0], [8.5, 2.0]];
    assert_eq!(share(&[good, around, fast, backwards], 10.0), 0.5);
    assert_eq!(share(&[good, fast], 3.0), 0.5, "one comes in time");
}

#[test]
fn shapes_of_groups() {
    let narrowing: Vec<Vec<Point>> = [4.0, 2.0, 1.0].iter().map(|&w| points(&[[-w, 0.0], [w, 5.0]])).collect();
    assert_eq!(fitness("reduce-x-sd", &[], &narrowing), 0.75);
    let widening: Vec<_> = narrowing.into_iter().rev().collect();
    assert_eq!(fitness("reduce-x-sd", &[], &widening), 0.0);
    let line = points(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]);
    assert!((fitness("line-formation", &[], &[line]) - 1.0).abs() < 1e-7);
    let square = points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert!(fitness("line-formation", &[], &[square]) < 1e-12);
}

#[test]
fn regions_reached_held_and_avoided() {
    let course =
        vec![points(&[[0.0, 0.0], [9.0, 0.0]]), points(&[[2.0, 0.0], [0.0, 1.0]]), points(&[[9.0, 0.0], [50.0, 0.0]])];
    assert_eq!(fitness("point-to-point", &[], &course), 1.0);
    assert_eq!(fitness("point-to-point", &[], &course[..1]), 0.5);
    assert!((fitness("hold", &[], &course) - 0.5).abs() < 1e-15);
    assert_eq!(fitness("avoid", &[], &course), 0.5);
}

#[test]
fn types_are_sorted_after_they_were_gathered_and_led() {
    let setting = Setting {
        regions: vec![("small".into(), disc(20.0, 5.0, 2.0)), ("large".into(), disc(20.0, -5.0, 2.0))],
        ..setting()
    };
    let types = [0, 0, 1, 1];
    let follow = |id: &str, stages: &[[[f64; 2]; 4]]| {
        let near = [("hold", 2.0), ("radius", 10.0)];
        let given = if id == "segregate" { &near[..1] } else { &near };
        let mut watch = find(id, given, &setting).unwrap().watch();
        for stage in stages {
            let positions = stage.map(|p| Some(Vector(p)));
            for _ in 0..3 {
                watch.step(&Moment { positions: &positions, velocities: &[], types: &types });
            }
        }
        watch
    };
    let gathered = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let led = [[6.0, 0.0], [7.0, 0.0], [6.0, 1.0], [7.0, 1.0]];
    let sorted = [[20.0, 5.0], [20.0, 6.0], [20.0, -5.0], [20.0, -6.0]];
    let mixed = [[20.0, 5.0], [20.0, -5.0], [20.0, 6.0], [20.0, -6.0]];
    let lost = [[20.0, 5.0], [20.0, 6.0], [20.0, -5.0], [99.0, 0.0]];
    assert_eq!([sorted, mixed, lost].map(|last| follow("segregate", &[last]).fitness()), [1.0, 0.5, 0.0]);
    let whole = follow("gather-and-sort", &[gathered, led, sorted]);
    assert_eq!((whole.fitness(), whole.parts()), (1.0, vec![1.0; 3]));
    assert_eq!(follow("gather-and-sort", &[gathered, led, lost]).parts(), [1.0, 1.0, 0.0]);
    assert_eq!(follow("gather-and-sort", &[led, gathered, sorted]).parts(), [1.0, 1.0, 1.0], "it was led out again");
    assert_eq!(follow("gather-and-sort", &[sorted, gathered]).parts(), [1.0, 0.0, 0.0], "in the wrong order");
    // when did each condition become true
    let lines = whole.explain();
    let first = |text: &str| lines.iter().find(|line| line.text.starts_with(text)).unwrap().first;
    assert_eq!(first("sustained for 2"), Some(1));
    assert_eq!(first("share_crossed"), Some(3));
    assert_eq!(
        lines.iter().filter(|line| line.text.starts_with("share_placed")).map(|line| line.first).next(),
        Some(Some(6))
    );
    assert!(lines.iter().all(|line| line.depth < 8));
}

#[test]
fn conditions_in_time() {
    // x of a single member, step by step
    let held = |condition: &Condition, xs: &[f64]| {
        let behaviour = Behaviour { name: "x".into(), score: Score::Binary(condition.clone()) };
        let mut watch = behaviour.watch();
        xs.iter()
            .map(|&x| {
                watch.step(&Moment { positions: &[Some(Vector([x, 0.0]))], velocities: &[], types: &[] });
                watch.fitness() == 1.0
            })
            .collect::<Vec<_>>()
    };
    let x = |comparison, number| Condition::Compare(Signal::Centroid(0), comparison, number);
    let above = |number| x(Comparison::More, number);
    let (t, f) = (true, false);
    assert_eq!(held(&above(1.0), &[0.0, 2.0, 1.0]), [f, t, f]);
    assert_eq!(held(&Condition::Not(Box::new(above(1.0))), &[0.0, 2.0]), [t, f]);
    assert_eq!(held(&Condition::Eventually(Box::new(above(1.0))), &[0.0, 2.0, 0.0]), [f, t, t]);
    assert_eq!(held(&above(1.0).sustained(2), &[2.0, 0.0, 2.0, 2.0, 0.0]), [f, f, f, t, t]);
    let always = |from, to| Condition::Always(from, to, Box::new(x(Comparison::Less, 1.0)));
    assert_eq!(held(&always(1, Some(2)), &[5.0, 0.0, 0.0, 5.0]), [f, f, t, t]);
    assert_eq!(held(&always(1, Some(2)), &[0.0, 5.0, 0.0, 0.0]), [f; 4]);
    assert_eq!(held(&always(0, None), &[0.0, 0.0, 5.0, 0.0]), [t, t, f, f]);
    let until = Condition::Until(Box::new(x(Comparison::AtLeast, 0.0)), Box::new(above(3.0)));
    assert_eq!(held(&until, &[0.0, 1.0, 4.0, -1.0]), [f, f, t, t]);
    assert_eq!(held(&until, &[0.0, -1.0, 4.0]), [f; 3]);
    let then = above(1.0).then(x(Comparison::Less, 0.0).within(3));
    assert_eq!(held(&then, &[-5.0, 2.0, 1.0, -1.0, 1.0]), [f, f, f, t, t]);
    assert_eq!(held(&then, &[-5.0, 2.0, 1.0, 1.0, -1.0]), [f; 5], "steps are counted from the first part");
    assert_eq!(held(&Condition::Any(vec![above(3.0), x(Comparison::AtMost, -3.0)]), &[0.0, 4.0, -3.0]), [f, t, t]);
    assert_eq!(held(&Condition::All(vec![]), &[0.0]), [t]);
}

#[test]
fn scores_combine() {
    let still = |score| Behaviour { name: "s".into(), score }.fitness(&[points(&[[0.0, 0.0], [9.0, 0.0]])]);
    let half = || Score::Share(Signal::ShareIn(disc(0.0, 0.0, 1.0)));
    let one = || Score::Share(Signal::Alive);
    assert_eq!(still(Score::Product(vec![half(), half()])), 0.25);
    assert_eq!(still(Score::Min(vec![one(), half()])), 0.5);
    assert_eq!(still(Score::Mean(vec![one(), half()])), 0.75);
    assert_eq!(still(Score::Weighted(vec![(1.0, one()), (3.0, half())])), 0.625);
    assert_eq!(still(Score::Weighted(vec![])), 0.0);
    let ramp = |worst, best| Score::Ramp {
        signal: Signal::Centroid(0),
        worst: Bound::Number(worst),
        best: Bound::Number(best),
    };
    assert_eq!(
        [still(ramp(0.0, 9.0)), still(ramp(9.0, 0.0)), still(ramp(5.0, 9.0)), still(ramp(4.5, 4.5))],
        [0.5, 0.5, 0.0, 1.0]
    );
}

#[test]
fn signals_of_walls_paths_and_headings() {
    let read = |signal: Signal, positions: &[[f64; 2]], velocities: &[[f64; 2]]| {
        let positions: Vec<_> = positions.iter().map(|&p| Some(Vector(p))).collect();
        let velocities: Vec<_> = velocities.iter().map(|&v| Some(Vector(v))).collect();
        let mut watch = Behaviour { name: "s".into(), score: Score::Share(signal) }.watch();
        watch.step(&Moment { positions: &positions, velocities: &velocities, types: &[] });
        watch.explain()[0].value
    };
    let wall = setting().walls;
    let pair = [[-2.0, 0.0], [1.0, 0.0]];
    assert_eq!(read(Signal::WallDistance(wall.clone()), &pair, &[]), Some(1.0));
    assert_eq!(read(Signal::WallDistance(vec![]), &pair, &[]), None);
    let groups = |walls| Signal::GroupCount(Membership { distance: 5.0, walls });
    assert_eq!(read(groups(vec![]), &pair, &[]), Some(1.0));
    assert_eq!(read(groups(wall), &pair, &[]), Some(2.0), "the wall cuts the link");
    let path = Signal::PathError(points(&[[-9.0, 1.0], [9.0, 1.0], [9.0, 9.0]]));
    assert_eq!(read(path, &[[0.0, 0.0], [10.0, 5.0], [3.0, 2.0]], &[]), Some(1.0));
    assert_eq!(read(Signal::Polarisation, &pair, &[[3.0, 0.0], [0.0, 0.0]]), Some(1.0));
    assert_eq!(read(Signal::Polarisation, &pair, &[]), None);
    assert_eq!(read(Signal::Spread, &[[0.0, 3.0], [0.0, -3.0]], &[]), Some(3.0));
    assert_eq!(read(Signal::TypeShareIn(disc(1.0, 0.0, 1.0), 0), &pair, &[]), Some(0.5));
    assert_eq!(read(Signal::TypeShareIn(disc(1.0, 0.0, 1.0), 7), &pair, &[]), None);
}
