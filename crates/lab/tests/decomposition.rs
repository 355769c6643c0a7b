//! The parts of decompositions by known answers: descriptors of ways, clusters of points, names of effects, ranges of variations.
#![allow(clippy::unwrap_used, reason = "tests")]

use lab::decomposition::clusters::{
    by_density, by_linkage, distances, medoids, silhouette, silhouette_of, standardised,
};
use lab::decomposition::directed::{Found, Marked, range, variation, variations};
use lab::decomposition::form::{Effects, Vary};
use lab::decomposition::probe::{Arena, Descriptor, NUMBERS, Sum, Watch, place};
use lab::decomposition::results::Effect;
use space::Vector;
use terrain::Point;
use terrain::fit::fit;

/// The descriptor of ways of one member each, by their corners, in an arena of radius 4 entered along x.
fn of(ways: &[&[[f64; 2]]]) -> Descriptor {
    let arena = Arena { centre: Vector([0.0, 0.0]), radius: 4.0, approach: Vector([1.0, 0.0]), link: 1.5 };
    let fine = |way: &[[f64; 2]]| -> Vec<Point> {
        let legs = way.windows(2).flat_map(|two| {
            (0..40).map(move |k| Vector(two[0]) + (Vector(two[1]) - Vector(two[0])) * (f64::from(k) / 40.0))
        });
        legs.chain(way.last().map(|end| Vector(*end))).collect()
    };
    let ways: Vec<Vec<Point>> = ways.iter().map(|way| fine(way)).collect();
    let mut watch = Watch::new(arena, ways.len());
    for step in 0..ways.iter().map(Vec::len).max().unwrap() {
        let now: Vec<Option<Point>> = ways.iter().map(|way| way.get(step).copied()).collect();
        if watch.step(&now) {
            break;
        }
    }
    let mut sum = Sum::default();
    watch.add_to(&mut sum);
    sum.descriptor().unwrap()
}

fn number(of: &Descriptor, name: &str) -> f64 {
    of[place(name)]
}

#[test]
fn a_straight_pass_turns_nobody_and_all_go_through() {
    let straight = of(&[&[[-4., 0.], [5., 0.]], &[[-4., 1.], [5., 1.]]]);
    let expected = [("turn", 0.0), ("turn_spread", 0.0), ("through", 1.0), ("groups", 1.0), ("entropy", 0.0)];
    for (name, value) in expected.into_iter().chain([("along", 0.0), ("across", 0.0), ("stay", 0.0)]) {
        assert!(number(&straight, name).abs() - value < 1e-12 && number(&straight, name) >= value - 1e-12, "{name}");
    }
    // 36 of 40 steps are 8 long and 9 of a diameter of 8: the first beyond the rim
    assert!((number(&straight, "transit") - 36.0 / 8.0).abs() < 0.2);
}

#[test]
fn turns_sides_and_those_who_stay() {
    let corner = of(&[&[[-4., 0.], [0., 0.], [0., 5.]]]);
    assert!((number(&corner, "turn") - 90.0).abs() < 1e-9 && number(&corner, "left") == 1.0);
    let back = of(&[&[[-4., 0.], [0., 0.], [-5., 0.1]]]);
    assert!(number(&back, "back") == 1.0 && number(&back, "turn").abs() > 170.0);
    let stuck = of(&[&[[-4., 0.], [0., 0.]]]);
    assert_eq!((number(&stuck, "stay"), number(&stuck, "through")), (1.0, 0.0));
    let split = of(&[&[[-4., 0.2], [0., 0.2], [0., 5.]], &[[-4., -0.2], [0., -0.2], [0., -5.]]]);
    assert!((number(&split, "turn")).abs() < 1e-9 && (number(&split, "turn_spread") - 90.0).abs() < 1e-9);
    assert_eq!([number(&split, "groups"), number(&split, "entropy"), number(&split, "left")], [2.0, 1.0, 0.5]);
    let narrowed = of(&[&[[-4., 0.7], [0., 0.07], [5., 0.07]], &[[-4., -0.7], [0., -0.07], [5., -0.07]]]);
    assert!((number(&narrowed, "across") + 0.9).abs() < 1e-9, "{}", number(&narrowed, "across"));
}

#[test]
fn what_is_mirrored_swaps_left_and_right() {
    let ways: [&[[f64; 2]]; 3] =
        [&[[-4., 0.3], [1., 0.], [2., 5.]], &[[-4., -0.8], [0.5, -0.2], [-1., -6.]], &[[-4., 0.1], [0., 1.], [6., 2.]]];
    let mirrored: Vec<Vec<[f64; 2]>> = ways.iter().map(|way| way.iter().map(|[x, y]| [*x, -y]).collect()).collect();
    let mirrored: Vec<&[[f64; 2]]> = mirrored.iter().map(Vec::as_slice).collect();
    let (one, other) = (of(&ways), of(&mirrored));
    for (name, ..) in NUMBERS {
        let twin = match name {
            "left" => "right",
            "right" => "left",
            same => same,
        };
        let sign = if name == "turn" { -1.0 } else { 1.0 };
        assert!((number(&one, name) - sign * number(&other, twin)).abs() < 1e-9, "{name}");
    }
    assert!(number(&one, "left") > 0.0);
}

fn line(places: &[f64]) -> Vec<Vec<f64>> {
    distances(&places.iter().map(|place| vec![*place]).collect::<Vec<_>>())
}

#[test]
fn average_linkage_joins_the_nearest_means() {
    // 0 and 1 first (1), then 10 and 12 (2), then 20 with those: mean of 10 and 8 is 9, less than 10.5 from 0 and 1 to 10 and 12
    let distances = line(&[0.0, 1.0, 10.0, 12.0, 20.0]);
    let cut = |clusters: usize| by_linkage(&distances, clusters, clusters).0;
    assert_eq!(cut(5), [0, 1, 2, 3, 4]);
    assert_eq!(cut(4), [0, 0, 1, 2, 3]);
    assert_eq!(cut(3), [0, 0, 1, 1, 2]);
    assert_eq!(cut(2), [0, 0, 1, 1, 1]);
    // by means, not by the nearest: 6.5 is 3.5 from 10, but 4.5 from the mean of 10 and 12 and 4 from that of 1 and 4
    let distances = line(&[1.0, 4.0, 6.5, 10.0, 12.0]);
    assert_eq!(by_linkage(&distances, 2, 2).0, [0, 0, 0, 1, 1]);
}

#[test]
fn silhouettes_as_worked_out() {
    // of the points of {0, 1} and {5, 6}: own distance 1; 5.5 and 4.5 to the other
    let value = silhouette(&line(&[0.0, 1.0, 5.0, 6.0]), &[0, 0, 1, 1]);
    assert!((value - (4.5 / 5.5 + 3.5 / 4.5) / 2.0).abs() < 1e-12);
    assert_eq!(silhouette(&line(&[0.0, 1.0]), &[0, 0]), 0.0);
    assert_eq!(silhouette(&line(&[3.0, 3.0, 3.0]), &[0, 1, 1]), 0.0, "no distance at all is no reason for anything");
    assert_eq!(silhouette(&line(&[0.0, 5.0, 5.0]), &[0, 1, 1]), 2.0 / 3.0, "a point alone counts as 0");
}

#[test]
fn the_best_cut_finds_what_was_put_there() {
    let places: Vec<f64> =
        [0.0, 10.0, 30.0].iter().flat_map(|at| (0..5).map(move |k| at + 0.1 * f64::from(k))).collect();
    let distances = line(&places);
    let (labels, silhouettes) = by_linkage(&distances, 2, 6);
    assert_eq!(labels, [[0; 5], [1; 5], [2; 5]].concat());
    assert_eq!(silhouettes.len(), 5);
    let labels: Vec<Option<usize>> = labels.into_iter().map(Some).collect();
    assert_eq!(medoids(&distances, &labels), [2, 7, 12]);
    assert_eq!(by_density(&distances, 0.15, 3), labels);
    assert_eq!(by_linkage(&line(&[3.0]), 2, 6).0, [0]);
    assert_eq!(by_linkage(&[], 2, 6).0, Vec::<usize>::new());
}

#[test]
fn by_density_some_are_noise() {
    let labels = by_density(&line(&[0.0, 1.0, 2.0, 3.5, 20.0, 30.0, 31.0]), 1.5, 3);
    // 3.5 is at the border of the first, 30 and 31 are too few
    assert_eq!(labels, [Some(0), Some(0), Some(0), Some(0), None, None, None]);
    assert_eq!(
        silhouette_of(&line(&[0.0, 1.0, 9.0, 5.0, 6.0]), &[Some(0), Some(0), None, Some(1), Some(1)]),
        (4.5 / 5.5 + 3.5 / 4.5) / 2.0
    );
}

#[test]
fn what_does_not_vary_says_nothing() {
    let scaled = standardised(&[vec![1.0, 7.0], vec![3.0, 7.0]]);
    assert_eq!(scaled, [[-1.0, 0.0], [1.0, 0.0]]);
}

#[test]
fn the_effect_that_exceeds_its_size_most_gives_the_name() {
    let sizes = Effects { turn: 30.0, narrowing: 0.25, splitting: 0.5, back: 0.5 };
    let of = |given: &[(&str, f64)]| {
        let mut numbers = [0.0; NUMBERS.len()];
        given.iter().for_each(|(name, value)| numbers[place(name)] = *value);
        Effect::dominant(&numbers, &sizes)
    };
    assert_eq!(of(&[]), Effect::None);
    assert_eq!(of(&[("turn", 29.0), ("across", -0.2)]), Effect::None);
    assert_eq!(of(&[("turn", 31.0), ("across", -0.2)]), Effect::TurnLeft);
    assert_eq!(of(&[("turn", -31.0), ("across", -0.5)]), Effect::Narrowing);
    assert_eq!(of(&[("turn", -80.0), ("across", -0.5)]), Effect::TurnRight);
    assert_eq!(of(&[("groups", 0.9), ("back", 0.6)]), Effect::Splitting);
    assert_eq!(of(&[("back", 0.6), ("across", 3.0)]), Effect::TurningBack);
}

fn vary(angles: &[f64], lengths: &[f64]) -> Vary {
    Vary {
        tolerance: 0.1,
        angles: angles.to_vec(),
        lengths: lengths.to_vec(),
        trials: 20,
        quick_trials: 2,
        success: 1.0,
        least: 0.8,
    }
}

#[test]
fn the_range_is_the_largest_box_around_the_fit() {
    let vary = vary(&[-10.0, 0.0, 10.0], &[0.5, 1.0, 1.5]);
    let found = |rows: [&str; 3]| -> Vec<Found> {
        let of = |letter| Found { successes: if letter == 'x' { 10 } else { 0 }, trials: 10 };
        rows.iter().flat_map(|row| row.chars()).map(of).collect()
    };
    assert_eq!(range(&vary, &found(["x..", "xx.", "xx."])), Some([(0.0, 10.0), (0.5, 1.0)]));
    assert_eq!(range(&vary, &found(["...", ".x.", "..."])), Some([(0.0, 0.0), (1.0, 1.0)]));
    assert_eq!(range(&vary, &found(["xxx", "x.x", "xxx"])), None, "the fit itself does not");
    assert_eq!((variations(&vary), variation(&vary, 5), variation(&vary, 9)), (10, Some((0.0, 1.5)), None));
}

#[test]
fn a_fit_is_turned_and_stretched_about_its_first_end() {
    let line =
        terrain::fragments::Polyline { points: vec![Point::of(&[1.0, 2.0]), Point::of(&[3.0, 2.0])], closed: false };
    let marked = Marked { name: "a".into(), stretch: line.points.clone(), fits: fit(&line, 0.0, 2.0, 0.1) };
    let turned = marked.construct(terrain::Units::Metres, 90.0, 1.5);
    let wall = turned.walls()[0];
    assert!((wall.from - Point::of(&[1.0, 2.0])).length() < 1e-9 && (wall.to - Point::of(&[1.0, 5.0])).length() < 1e-9);
}
