//! Laws that hold for every listed metric, and a comparison with numbers computed elsewhere.

use super::sketch::{Members, Scene, sample};
use super::*;
use crate::sample::mean;
use crate::{Counted, EdgeCases};
use space::{Edge, Space, Vector};

type Metrics<const D: usize> = Vec<Box<dyn Measure<D>>>;

/// Numbers in [0, 1), the same in every run (splitmix64).
struct Numbers(u64);
impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
    /// A group in the box [0, `side`), drifting a little; every ninth member rests.
    fn group<const D: usize>(&mut self, n: usize, side: f64) -> Members<D> {
        let mut member = |k: usize| {
            let position = core::array::from_fn(|_| side * self.next());
            let velocity = core::array::from_fn(|_| if k % 9 == 4 { 0.0 } else { 2.0 * self.next() - 0.7 });
            (position, velocity)
        };
        (0..n).map(&mut member).collect()
    }
}

const SIZES: [usize; 7] = [0, 1, 2, 3, 8, 40, 150];

fn values<R: Real, const D: usize>(metrics: &Metrics<D>, scene: &Scene<R, D>) -> Vec<Option<f64>> {
    let sample = Sample::whole(&scene.frame());
    metrics.iter().map(|metric| metric.on(&sample)).collect()
}

/// The ids of the metrics that differ between two scenes by more than a tolerance.
fn differing<R: Real, const D: usize>(
    metrics: &Metrics<D>,
    one: &Scene<R, D>,
    other: &Scene<R, D>,
    tolerance: f64,
) -> Vec<&'static str> {
    let equal = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() <= tolerance * a.abs().max(1.0),
        (a, b) => a == b,
    };
    let pairs = values(metrics, one).into_iter().zip(values(metrics, other));
    metrics.iter().zip(pairs).filter(|(_, (a, b))| !equal(*a, *b)).map(|(metric, _)| metric.card().id).collect()
}

/// Positions and velocities changed member by member.
fn changed<const D: usize>(
    members: &Members<D>,
    position: impl Fn([f64; D]) -> [f64; D],
    velocity: impl Fn([f64; D]) -> [f64; D],
) -> Members<D> {
    members.iter().map(|&(x, v)| (position(x), velocity(v))).collect()
}

/// A rotation that mixes all axes; in one dimension the reflection.
fn rotated<const D: usize>(v: [f64; D]) -> [f64; D] {
    if D == 1 {
        return v.map(|x| -x);
    }
    let mut v = v;
    for (a, b, angle) in [(0, 1, 0.7f64), (1, 2, 2.1), (0, 2, -1.3)] {
        if b < D {
            let (x, y) = (v[a], v[b]);
            (v[a], v[b]) = (x * angle.cos() - y * angle.sin(), x * angle.sin() + y * angle.cos());
        }
    }
    v
}

/// Translation, rotation, mirror image and relabelling change nothing.
fn symmetries<R: Real, const D: usize>(metrics: &Metrics<D>, tolerance: f64) -> Vec<&'static str> {
    let mut numbers = Numbers(2002);
    let mut broken = Vec::new();
    for n in SIZES {
        for side in [4.0, 60.0, 400.0] {
            let members = numbers.group::<D>(n, side);
            for space in [Space::<f64, D>::open(), Space::walled([side; D]), Space::periodic([side; D])] {
                let scene = |members: &Members<D>| {
                    let placed = changed(members, |x| space.place(Vector(x)).0, |v| v);
                    let edges = space.edges.map(|edge| match edge {
                        Edge::Open => Edge::Open,
                        Edge::Walls(length) => Edge::Walls(R::of(length)),
                        Edge::Periodic(length) => Edge::Periodic(R::of(length)),
                    });
                    Scene::<R, D>::new(Space { edges }, &placed)
                };
                let here = scene(&members);
                let mut law = |other: &Scene<R, D>, tolerance| {
                    broken.extend(differing(metrics, &here, other, tolerance));
                };
                law(&scene(&changed(&members, |x| x.map(|c| c + 0.41 * side), |v| v)), tolerance);
                law(&scene(&changed(&members, |x| x.map(|c| side - c), |v| v.map(|c| -c))), tolerance);
                if !space.is_periodic() {
                    law(&scene(&changed(&members, rotated, rotated)), tolerance);
                }
                // other ids: the same up to rounding
                let mut order: Vec<usize> = (0..n).collect();
                for k in (1..n).rev() {
                    order.swap(k, (numbers.next() * (k + 1) as f64) as usize);
                }
                let renamed = scene(&order.iter().map(|&k| members[k]).collect());
                law(&renamed, tolerance);
                // other rows, the same ids: the same bits
                let mut stirred = renamed;
                for (row, &id) in order.iter().enumerate() {
                    stirred.columns.id[row] = id as u32;
                }
                law(&stirred, 0.0);
            }
        }
    }
    broken
}

/// A group across the seam of every axis has the values of the same group away from it, and in a wide box
/// those of open space.
fn seam<R: Real, const D: usize>(metrics: &Metrics<D>, tolerance: f64) -> Vec<&'static str> {
    let mut numbers = Numbers(2012);
    let mut broken = Vec::new();
    for n in SIZES {
        let members = numbers.group::<D>(n, 25.0);
        let at = |space: Space<R, D>, corner: f64| {
            let moved = changed(&members, |x| x.map(|c| c + corner), |v| v);
            let mut scene = Scene::new(space, &moved);
            for row in 0..n {
                scene.columns.set_position(row, space.place(scene.columns.position(row)));
            }
            scene
        };
        let [narrow, wide] = [64.0, 1_048_576.0].map(|side| Space::periodic([R::of(side); D]));
        let middle = at(narrow, 16.0);
        for corner in [-2.0, -12.0, -23.0, 41.0] {
            broken.extend(differing(metrics, &middle, &at(narrow, corner), tolerance));
        }
        broken.extend(differing(metrics, &at(Space::open(), 16.0), &at(wide, 16.0), tolerance.max(1e-8)));
    }
    broken
}

/// States that tempt a metric to divide by zero, to overflow or to find no neighbour.
fn degenerate<const D: usize>() -> Vec<Members<D>> {
    let mut numbers = Numbers(1992);
    let mut states: Vec<Members<D>> = Vec::new();
    for n in [0, 1, 2, 3, 90] {
        let group = numbers.group::<D>(n, 10.0);
        let line = |x: [f64; D]| core::array::from_fn(|a| if a == 0 { x[0] } else { 0.0 });
        states.push(changed(&group, |_| [5.0; D], |v| v)); // coincident
        states.push(changed(&group, |_| [5.0; D], |_| [0.0; D])); // coincident and at rest
        states.push(changed(&group, |x| x, |_| [0.0; D])); // at rest
        states.push(changed(&group, |x| x, |v| v.map(|c| 1e-14 * c))); // nearly at rest
        states.push(changed(&group, line, line)); // on a line
        states.push(changed(&group, |x| x.map(|c| 1e200 * c), |v| v.map(|c| 1e200 * c))); // too large to square
        states.push(changed(&group, |x| x.map(|c| 1e-300 * c), |v| v.map(|c| 1e-300 * c))); // too small to square
        states.push(changed(&group, |x| x, |_| [f64::NAN; D])); // velocities unknown
        states.push(changed(&group, |_| [f64::NAN; D], |v| v)); // nobody found
        let mut outlier = group;
        if let Some(member) = outlier.last_mut() {
            member.0 = [1e12; D];
        }
        states.push(outlier);
    }
    let ring = (0..8).map(|k| ([f64::from(k) * 1.25; D], [if k % 2 == 0 { 1.0 } else { -1.0 }; D]));
    states.push(ring.collect()); // evenly round the box, headings opposed
    states
}

fn never_nan<R: Real, const D: usize>() {
    for members in degenerate::<D>() {
        for side in [1e-3, 10.0, 1e6] {
            let side = R::of(side);
            for space in [Space::open(), Space::walled([side; D]), Space::periodic([side; D])] {
                let scene = Scene::<R, D>::new(space, &members);
                for (card, value) in LIST.iter().zip(values(&all(), &scene)) {
                    let least = card.range.map_or(0.0, |range| range.0);
                    let fine = value.is_none_or(|value| value.is_finite() && value >= least);
                    assert!(fine, "{} is {value:?} for {members:?} in {space:?}", card.id);
                }
            }
        }
    }
}

/// The edge cases hold what the cards promise.
fn promises<R: Real, const D: usize>() {
    let promised = |text: &str| match text {
        "undefined" => Some(None),
        text => text.parse::<f64>().ok().map(Some),
    };
    let mut numbers = Numbers(1954);
    for metric in all::<D>().iter().filter(|metric| metric.card().dimensions.contains(&D)) {
        let card = metric.card();
        let check = |promise: &str, members: &Members<D>| {
            for space in [Space::open(), Space::periodic([R::of(10.0); D])] {
                let found = metric.on(&Sample::whole(&Scene::<R, D>::new(space, members).frame()));
                let Some(expected) = promised(promise) else { continue };
                let equal = match (found, expected) {
                    (Some(found), Some(expected)) => (found - expected).abs() < 1e-12,
                    (found, expected) => found == expected,
                };
                assert!(equal, "{}: {found:?}, but the card says {promise}", card.id);
            }
        };
        check(card.edge.empty, &vec![]);
        check(card.edge.one, &numbers.group(1, 10.0));
        for n in [1, 2, 30] {
            check(card.edge.at_rest, &changed(&numbers.group(n, 10.0), |x| x, |_| [0.0; D]));
        }
    }
    for metric in all::<D>().iter().filter(|metric| !metric.card().dimensions.contains(&D)) {
        let scene = Scene::<R, D>::new(Space::open(), &numbers.group(20, 10.0));
        assert_eq!(metric.on(&Sample::whole(&scene.frame())), None, "{}", metric.card().id);
    }
}

macro_rules! for_each_space {
    ($($real:ident $tolerance:literal $dimension:literal $name:ident;)*) => {$(
        mod $name {
            use super::*;
            #[test]
            fn symmetries_hold() {
                assert_eq!(symmetries::<$real, $dimension>(&all(), $tolerance), [""; 0]);
            }
            #[test]
            fn the_seam_does_not_show() {
                assert_eq!(seam::<$real, $dimension>(&all(), $tolerance), [""; 0]);
            }
            #[test]
            fn degenerate_states_give_no_nan() {
                never_nan::<$real, $dimension>();
            }
            #[test]
            fn the_edge_cases_are_as_promised() {
                promises::<$real, $dimension>();
            }
        }
    )*};
}
for_each_space! {
    f32 1e-3 1 f32_1d;
    f32 1e-3 2 f32_2d;
    f32 1e-3 3 f32_3d;
    f64 1e-9 1 f64_1d;
    f64 1e-9 2 f64_2d;
    f64 1e-9 3 f64_3d;
}

/// An expanse whose centre is the mean of the stored positions, as if there were no seam.
#[derive(Default)]
struct BlindToTheSeam;
impl Metric for BlindToTheSeam {
    const CARD: MetricCard = MetricCard {
        id: "blind",
        title: "",
        symbol: "",
        unit: "",
        range: None,
        definition: "",
        variant: "",
        source: "",
        counted: Counted::Positions,
        dimensions: &[1, 2, 3],
        parameters: &[],
        edge: EdgeCases { empty: "", one: "", at_rest: "" },
    };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        let centre = crate::sample::mean_vector(sample.positions().iter().copied())?;
        mean(sample.positions().iter().map(|&place| (place - centre).length_squared())).map(f64::sqrt)
    }
}

/// The first member's speed: it depends on who is called first.
#[derive(Default)]
struct FirstSpeed;
impl Metric for FirstSpeed {
    const CARD: MetricCard = MetricCard { id: "first", ..BlindToTheSeam::CARD };
    fn value<const D: usize>(&self, sample: &Sample<D>) -> Option<f64> {
        sample.velocities().next().map(Vector::length)
    }
}

#[test]
fn the_laws_can_fail() {
    assert!(seam::<f64, 2>(&vec![Box::new(BlindToTheSeam)], 1e-9).contains(&"blind"));
    assert!(symmetries::<f64, 2>(&vec![Box::new(BlindToTheSeam)], 1e-9).contains(&"blind"));
    assert!(symmetries::<f64, 2>(&vec![Box::new(FirstSpeed)], 1e-9).contains(&"first"));
}

#[test]
fn each_id_is_the_name_of_its_file_and_found_by_it() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src/metrics");
    for card in LIST {
        assert!(folder.join(card.id).with_extension("rs").is_file(), "{}", card.id);
        assert!(find::<2>(card.id).is_ok_and(|metric| metric.card().id == card.id));
        let texts = [card.title, card.symbol, card.unit, card.definition, card.source];
        let edge = [card.edge.empty, card.edge.one, card.edge.at_rest];
        assert!(texts.iter().chain(&edge).all(|text| !text.is_empty()), "{}", card.id);
    }
}

#[test]
fn parameters_are_set_by_name_and_wrong_requests_explained() {
    for card in LIST {
        let Ok(mut metric) = find::<1>(card.id) else { continue };
        for parameter in card.parameters {
            assert_eq!(metric.set(parameter.name, parameter.default.unwrap_or(1.0)), Ok(()));
            for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                let error = metric.set(parameter.name, wrong).err().map(|error| error.to_string());
                let explained = error.is_some_and(|error| error.contains(&parameter.bounds.to_string()));
                assert_eq!(explained, !parameter.bounds.allow(wrong), "{} of {}", parameter.name, card.id);
            }
        }
    }
    let fails = |result: Result<(), MeasureError>| result.map_err(|error| error.to_string());
    assert_eq!(
        fails(find::<2>("polarization").map(drop)),
        Err("unknown metric `polarization`; did you mean `polarisation`?".into())
    );
    let Ok(mut count) = find::<1>("group_count") else { return };
    assert_eq!(
        fails(count.set("linking", 1.0)),
        Err("metric `group_count` has no parameter `linking`; did you mean `linking_distance`?".into())
    );
    let places = [[0.0], [2.0], [4.5]].map(|place| (place, [0.0]));
    let group = sample(Space::open(), &places);
    assert_eq!(count.on(&group), Some(1.0));
    assert_eq!(count.set("linking_distance", 2.0), Ok(()));
    assert_eq!(count.on(&group), Some(2.0), "the groups kept were those of another distance");
}

#[test]
fn one_group_of_a_frame_is_measured_as_if_it_were_alone() {
    let members = Numbers(7).group::<2>(30, 40.0);
    let mut whole = Scene::<f64, 2>::new(Space::periodic([40.0; 2]), &members);
    // rows against ids, so that a group is no range of rows
    for row in 0..30 {
        let id = (row * 7) % 30;
        whole.columns.id[row] = id as u32;
        whole.columns.set_position(row, Vector(members[id].0));
        whole.columns.set_velocity(row, Vector(members[id].1));
    }
    let group = GroupRange { name: "fish".into(), first: 10, count: 12 };
    let alone = Scene::<f64, 2>::new(whole.space, &members[10..22]);
    for card in LIST {
        let expected = compute(card.id, &alone.frame(), None);
        assert_eq!(compute(card.id, &whole.frame(), Some(&group)), expected, "{}", card.id);
        assert!(expected.is_ok());
    }
    assert_eq!(Sample::of(&whole.frame(), &[3, 3, 1, 900]).len(), 2, "twice is once; a row too far is nobody");
}

#[test]
fn gaps_in_tracks_are_left_out() {
    let full = Numbers(8).group::<3>(12, 9.0);
    let mut gaps = full.clone();
    gaps.insert(5, ([f64::NAN, 1.0, 1.0], [9.0; 3]));
    let [full, gaps] = [full, gaps].map(|members| Scene::<f64, 3>::new(Space::open(), &members));
    assert_eq!(differing(&all(), &full, &gaps, 0.0), [""; 0]);
    assert_eq!(Sample::whole(&gaps.frame()).count(Counted::Positions), 12);
}

/// The metrics that were computed with numpy; the others have their own references.
const BY_NUMPY: [&str; 13] = [
    "polarisation",
    "weighted_polarisation",
    "mean_angular_deviation",
    "angular_momentum",
    "nearest_neighbour_distance",
    "expanse",
    "mean_distance_to_centre",
    "median_distance_to_centre",
    "group_count",
    "largest_group_share",
    "balance",
    "stragglers",
    "mean_speed",
];

/// Groups and values computed independently with numpy 2.4.6 and scipy 1.17.1, in the textbook way: complex
/// exponentials for circular means, arccos for angles, `cdist`-like matrices for distances,
/// `scipy.sparse.csgraph.connected_components` for groups. Positions and velocities were drawn with
/// `default_rng(1995)` and rounded; in each group one member rests.
fn numpy<const D: usize>(space: Space<f64, D>, members: &Members<D>, parameters: [f64; 2], expected: &[(&str, f64)]) {
    let [linking_distance, straggling] = parameters;
    let wide = Scene::<f64, D>::new(space, members);
    let narrow_edges = space.edges.map(|edge| match edge {
        Edge::Open => Edge::Open,
        Edge::Periodic(length) => Edge::Periodic(length as f32),
        Edge::Walls(length) => Edge::Walls(length as f32),
    });
    let narrow = Scene::<f32, D>::new(Space { edges: narrow_edges }, members);
    for mut metric in all::<D>() {
        let id = metric.card().id;
        if !BY_NUMPY.contains(&id) {
            continue;
        }
        for parameter in metric.card().parameters {
            let value = if parameter.name == "linking_distance" { linking_distance } else { straggling };
            assert_eq!(metric.set(parameter.name, value), Ok(()));
        }
        let expected = expected.iter().find(|(name, _)| *name == id).map(|&(_, value)| value);
        let samples = [(Sample::whole(&wide.frame()), 1e-12), (Sample::whole(&narrow.frame()), 1e-5)];
        for (sample, tolerance) in samples {
            let found = metric.on(&sample);
            let equal = match (found, expected) {
                (Some(found), Some(expected)) => (found - expected).abs() <= tolerance * expected.abs().max(1.0),
                (found, expected) => found == expected,
            };
            assert!(equal, "{id} in {D} dimensions: {found:?}, numpy found {expected:?}");
        }
    }
}

#[test]
fn numpy_agrees_in_a_periodic_plane() {
    let members = vec![
        ([35.96, 9.25], [-0.08, 0.58]),
        ([29.76, 13.05], [1.24, 0.56]),
        ([34.6, 15.32], [0.97, 0.0]),
        ([33.61, 27.88], [0.04, -0.03]),
        ([39.81, 23.73], [0.0, 0.0]),
        ([29.86, 1.92], [0.48, 0.22]),
        ([39.83, 1.83], [-0.42, 0.26]),
        ([35.58, 16.96], [0.94, 0.2]),
        ([16.68, 6.08], [0.92, -0.58]),
        ([4.87, 1.07], [0.14, 1.04]),
        ([7.68, 12.21], [0.55, 1.49]),
        ([5.14, 21.69], [0.76, 0.16]),
    ];
    let expected = [
        ("polarisation", 0.6274471307754602),
        ("weighted_polarisation", 0.7168648658528698),
        ("mean_angular_deviation", 44.31369655592741),
        ("angular_momentum", 0.2237220442222468),
        ("nearest_neighbour_distance", 5.726956538208249),
        ("expanse", 11.291036329204921),
        ("mean_distance_to_centre", 10.515738264183728),
        ("median_distance_to_centre", 10.038970622547392),
        ("group_count", 7.0),
        ("largest_group_share", 0.25),
        ("balance", 0.9577420562022179),
        ("stragglers", 0.8333333333333334),
        ("mean_speed", 0.7875812534622543),
    ];
    numpy(Space::periodic([40.0, 30.0]), &members, [6.0, 5.0], &expected);
}

#[test]
fn numpy_agrees_in_open_space() {
    let members = vec![
        ([20.41, -15.11, 10.49], [0.06, 0.19, 0.99]),
        ([-7.68, -5.3, 2.37], [1.36, -0.38, -1.54]),
        ([2.87, 0.93, -13.56], [1.04, 0.37, -0.28]),
        ([8.37, -4.46, 10.22], [1.01, -0.06, 0.92]),
        ([12.39, -10.7, 3.65], [-0.44, -0.47, -0.0]),
        ([6.16, 4.45, -21.38], [1.09, -0.35, -0.68]),
        ([-6.42, 14.31, 15.93], [-0.22, 0.57, 0.91]),
        ([-9.19, -13.73, -1.04], [0.0, 0.0, 0.0]),
        ([-5.19, 6.17, 13.82], [0.82, -0.04, 0.29]),
        ([4.45, -7.12, -6.11], [1.57, -0.62, 0.49]),
        ([-7.53, -1.8, 14.6], [-0.94, 1.42, 0.58]),
    ];
    let expected = [
        ("polarisation", 0.40950114291498685),
        ("weighted_polarisation", 0.4306081115059857),
        ("mean_angular_deviation", 60.5808173592841),
        ("angular_momentum", 0.33740044510859396),
        ("nearest_neighbour_distance", 9.484001253638764),
        ("expanse", 17.158906802142965),
        ("mean_distance_to_centre", 16.29388220110578),
        ("median_distance_to_centre", 15.759668867394307),
        ("group_count", 3.0),
        ("largest_group_share", 0.45454545454545453),
        ("balance", 0.9713067383178074),
        ("stragglers", 0.7272727272727273),
        ("mean_speed", 1.1913076028368588),
    ];
    numpy(Space::open(), &members, [13.0, 9.0], &expected);
}

#[test]
fn numpy_agrees_on_a_line() {
    let positions = [96.9, 12.3, 2.3, 68.2, 88.2, 71.3, 78.5, 96.7, 31.0];
    let velocities = [0.0, 0.88, 0.0, 0.88, 0.72, -0.25, 1.03, 0.16, 0.16];
    let members = positions.into_iter().zip(velocities).map(|(x, v)| ([x], [v])).collect();
    let expected = [
        ("polarisation", 0.7142857142857143),
        ("weighted_polarisation", 0.8774509803921569),
        ("mean_angular_deviation", 25.714285714285715),
        ("nearest_neighbour_distance", 6.777777777777778),
        ("expanse", 34.12926408035583),
        ("mean_distance_to_centre", 30.266666666666666),
        ("median_distance_to_centre", 29.599999999999994),
        ("group_count", 5.0),
        ("largest_group_share", 0.3333333333333333),
        ("balance", 0.9101415926479804),
        ("stragglers", 0.5555555555555556),
        ("mean_speed", 0.45333333333333337),
    ];
    numpy(Space::open(), &members, [9.0, 5.0], &expected);
}

/// The flock of 20 and the mill of 24 of the project's shared expected values (`synthetic_expected.json`; expanse, median,
/// balance and stragglers at distance 1 from the script above).
#[test]
fn the_shared_flock_and_mill_agree() {
    let flock = vec![
        ([7.018666, 2.594310], [1.053898, 0.346443]),
        ([3.596061, 4.023598], [0.794757, 0.778798]),
        ([0.432892, 2.595947], [0.681861, 0.532129]),
        ([6.335262, 4.417395], [0.824954, 0.257216]),
        ([7.936632, 2.005091], [0.874137, 0.546165]),
        ([2.376438, 2.846685], [0.807043, 0.541775]),
        ([8.618771, 4.563554], [0.961047, 0.458501]),
        ([6.577241, 5.169310], [1.082471, 0.467414]),
        ([7.017983, 0.953843], [0.965221, 0.127358]),
        ([2.025313, 4.294164], [0.785956, 0.479208]),
        ([2.600419, 4.265777], [0.868817, 0.463911]),
        ([1.875020, 4.550081], [1.078521, 0.223940]),
        ([1.843751, 4.630100], [0.939726, 0.241532]),
        ([8.429644, 5.339142], [0.659314, 0.694914]),
        ([1.837947, 5.935209], [0.684281, 0.856283]),
        ([7.693125, 1.422213], [1.037231, 0.371998]),
        ([2.024532, 0.056415], [0.798592, 0.259271]),
        ([4.554835, 1.390838], [1.089300, 0.393857]),
        ([8.981342, 0.553495], [0.822539, 0.756419]),
        ([1.672481, 5.023006], [1.071703, 0.439864]),
    ];
    let expected = [
        ("polarisation", 0.978111927818039),
        ("weighted_polarisation", 0.978024899736566),
        ("mean_angular_deviation", 10.240362328246707),
        ("angular_momentum", 0.05704622745649601),
        ("nearest_neighbour_distance", 1.0020576222328426),
        ("expanse", 3.3227219863553157),
        ("mean_distance_to_centre", 3.184058240031388),
        ("median_distance_to_centre", 3.226205983612708),
        ("group_count", 8.0),
        ("largest_group_share", 0.4),
        ("balance", 0.8406426982957875),
        ("stragglers", 0.35),
        ("mean_speed", 1.0289225721976076),
    ];
    numpy(Space::open(), &flock, [1.5, 1.0], &expected);
    let mill = vec![
        ([24.897738, -9.466982], [-0.221945, 1.483489]),
        ([24.615427, -9.403153], [0.208488, 1.485440]),
        ([25.058334, -8.735287], [-0.119510, 1.495232]),
        ([24.629924, -8.197867], [-0.775150, 1.284190]),
        ([24.891937, -7.264387], [-1.188605, 0.914996]),
        ([23.561205, -5.936333], [-1.353226, 0.647131]),
        ([22.962826, -6.170063], [-0.974806, 1.140067]),
        ([21.391249, -5.347062], [-1.270094, 0.798037]),
        ([19.580373, -4.257195], [-1.491448, -0.159948]),
        ([19.638563, -5.241963], [-1.494572, -0.127489]),
        ([17.379352, -5.243124], [-1.354832, -0.643764]),
        ([15.121367, -9.122070], [-0.018332, -1.499888]),
        ([14.720991, -9.094974], [-0.105397, -1.496293]),
        ([15.281061, -10.075828], [-0.287456, -1.472199]),
        ([15.766316, -11.282623], [0.727996, -1.311496]),
        ([15.439458, -12.324960], [0.809784, -1.262636]),
        ([16.368516, -12.787666], [0.766815, -1.289184]),
        ([16.501909, -13.233153], [1.079023, -1.041974]),
        ([17.221568, -13.982817], [0.975581, -1.139404]),
        ([17.740219, -14.499845], [1.307383, -0.735357]),
        ([18.949779, -14.838241], [1.369759, -0.611359]),
        ([19.013214, -14.799005], [1.487334, -0.194522]),
        ([19.483921, -14.846949], [1.492438, 0.150432]),
        ([24.346438, -11.847536], [0.679184, 1.337426]),
    ];
    let expected = [
        ("polarisation", 0.06285414093115547),
        ("weighted_polarisation", 0.06285416485397717),
        ("mean_angular_deviation", 86.16983762595298),
        ("angular_momentum", 0.9826113401086699),
        ("nearest_neighbour_distance", 0.8148473726087805),
        ("expanse", 4.991397874817559),
        ("mean_distance_to_centre", 4.978489159970345),
        ("median_distance_to_centre", 4.94967121086802),
        ("group_count", 7.0),
        ("largest_group_share", 0.5),
        ("balance", 0.7630241360275564),
        ("stragglers", 0.20833333333333334),
        ("mean_speed", 1.500000089925037),
    ];
    numpy(Space::open(), &mill, [1.6, 1.0], &expected);
}
