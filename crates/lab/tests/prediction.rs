//! Macroscopic models against known answers: laws that are exactly linear, cells that are there, members that have a given state.
#![allow(clippy::unwrap_used, reason = "tests")]

use lab::prediction::cells::Cells;
use lab::prediction::form::ModelForm;
use lab::prediction::model::{Model, Transition};
use lab::prediction::regression::least_squares;
use lab::prediction::state::{Members, State, root, seen, unseen};
use lab::prediction::surroundings::{Sectors, Wall, free, walls};
use measure::behaviours::Moment;
use space::Vector;
use space::random::{Purpose, uniform};
use terrain::{Geometry, Point};

fn drawn(k: u64, slot: u32) -> f64 {
    uniform(5, Purpose::Init, k, slot)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn an_exact_law_is_found_and_what_follows_counts_once() {
    let inputs: Vec<Vec<f64>> = (0..3).map(|slot| (0..50).map(|k| drawn(k, slot)).collect()).collect();
    let output = (0..50).map(|k| 2.0 - 3.0 * inputs[0][k] + 0.5 * inputs[2][k]).collect::<Vec<f64>>();
    let sum = (0..50).map(|k| inputs[0][k] + inputs[1][k]).collect();
    let equal = vec![7.3; 50];
    let given = vec![inputs[0].clone(), equal, inputs[1].clone(), sum, inputs[2].clone()];
    let law = least_squares(given, &[output]);
    let wanted = [-3.0, 0.0, 0.0, 0.0, 0.5];
    assert!(close(law.constants[0], 2.0), "{law:?}");
    assert!(law.weights[0].iter().zip(wanted).all(|(found, wanted)| close(*found, wanted)), "{law:?}");
    assert!(close(law.of::<1>(&[1.0, 7.3, 5.0, 6.0, 2.0])[0], 0.0));
}

#[test]
fn the_line_of_least_squares_as_worked_out() {
    // slope 1 and 2/3 at 0, as in `measure::statistics::linear_regression`
    let law = least_squares(vec![vec![0.0, 1.0, 2.0]], &[vec![1.0, 1.0, 3.0]]);
    assert!(close(law.weights[0][0], 1.0) && close(law.constants[0], 2.0 / 3.0));
}

#[test]
fn cells_are_cut_where_values_change() {
    let places: Vec<Vec<f64>> = (0..2).map(|slot| (0..400).map(|k| drawn(k, slot)).collect()).collect();
    let value: Vec<f64> = places[1].iter().map(|y| if *y > 0.5 { 1.0 } else { -1.0 }).collect();
    let cells = Cells::grown(&places, std::slice::from_ref(&value), 20);
    for k in 0..100 {
        let place = [drawn(k, 4), drawn(k, 5)];
        let items = cells.at(&place);
        assert!(items.len() >= 20);
        if (place[1] - 0.5).abs() > 0.05 {
            let wanted = if place[1] > 0.5 { 1.0 } else { -1.0 };
            assert!(items.iter().all(|&item| value[item as usize] == wanted), "{place:?}");
        }
    }
    let mut seen = Vec::new();
    cells.each(|items| seen.extend_from_slice(items));
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..400), "every item is in one cell");
    assert_eq!(Cells::grown(&places, &[vec![3.0; 400]], 20).count(), 1, "what does not vary is not cut");
    assert_eq!(Cells::grown(&places, &[value], 300).count(), 1, "nor what would be too small");
}

fn state(k: u64) -> State {
    let angle = 6.0 * drawn(k, 0);
    let (a, b, c) = (0.3 + drawn(k, 1), 0.2 * (drawn(k, 2) - 0.5), 0.3 + drawn(k, 3));
    State {
        at: Vector([drawn(k, 4), drawn(k, 5)]),
        heading: Vector([angle.cos(), angle.sin()]),
        polarisation: 0.4 + 0.6 * drawn(k, 6),
        spread: [a, b, c],
        largest: drawn(k, 7),
    }
}

#[test]
fn members_have_the_state_that_they_are_made_of() {
    for (count, k) in [(3, 1), (7, 2), (10, 3), (25, 4)] {
        let state = state(k);
        let members = Members::new(count);
        let positions: Vec<Option<Point>> = members.positions(&state, &[]).into_iter().map(Some).collect();
        let velocities: Vec<Option<Point>> = members.headings(&state).into_iter().map(Some).collect();
        let found =
            State::of(&Moment { positions: &positions, velocities: &velocities, types: &[] }, 100.0, None).unwrap();
        assert!((found.at - state.at).length() < 1e-9 && (found.heading - state.heading).length() < 1e-9);
        assert!(close(found.polarisation, state.polarisation), "{count}: {found:?} {state:?}");
        assert!(found.spread.iter().zip(state.spread).all(|(a, b)| close(*a, b)), "{count}: {found:?} {state:?}");
        assert_eq!(found.largest, 1.0);
    }
    // one stands in the middle, two on their line
    let one = State { spread: [0.0; 3], ..state(5) };
    assert_eq!(Members::new(1).positions(&one, &[]), [one.at]);
    let two = [Vector([1.0, 2.0]), Vector([3.0, -2.0])].map(Some);
    let looked = State::of(&Moment { positions: &two, velocities: &[], types: &[] }, 1.0, Some(&one)).unwrap();
    assert_eq!((looked.heading, looked.polarisation, looked.largest), (one.heading, 0.0, 0.5));
    let mut again = Members::new(2).positions(&looked, &[]);
    again.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert!((again[0] - Vector([1.0, 2.0])).length() < 1e-9 && (again[1] - Vector([3.0, -2.0])).length() < 1e-9);
    assert!(State::of(&Moment { positions: &[None], velocities: &[], types: &[] }, 1.0, None).is_none());
    assert_eq!(State::from_words(&one.words()), one);
}

#[test]
fn members_stand_before_walls() {
    let state = State { at: Vector([0.0, 0.0]), spread: [1.0, 0.0, 1.0], ..state(1) };
    let wall = Wall { from: Vector([0.5, -9.0]), along: Vector([0.0, 18.0]) };
    assert!(Members::new(9).positions(&state, &[]).iter().any(|p| p[0] > 0.5));
    assert!(Members::new(9).positions(&state, &[wall]).iter().all(|p| p[0] < 0.5));
    assert_eq!(free(Vector([0.0, 0.0]), Vector([2.0, 0.0]), &[wall]), 0.25);
    assert_eq!(free(Vector([0.0, 0.0]), Vector([-2.0, 0.0]), &[wall]), 1.0);
}

#[test]
fn a_spread_is_the_same_from_every_side() {
    let matrix = [2.0, 0.5, 1.0];
    let half = root(matrix);
    let squared =
        [half[0] * half[0] + half[1] * half[1], half[1] * (half[0] + half[2]), half[1] * half[1] + half[2] * half[2]];
    assert!(squared.iter().zip(matrix).all(|(a, b)| close(*a, b)), "{squared:?}");
    let heading = Vector([0.6, 0.8]);
    let again = unseen(seen(matrix, heading), heading.0);
    assert!(again.iter().zip(matrix).all(|(a, b)| close(*a, b)), "{again:?}");
    // along x the variance is the first number
    assert_eq!(seen(matrix, Vector([1.0, 0.0])), matrix);
}

#[test]
fn sectors_tell_the_nearest_wall_in_the_frame_of_the_heading() {
    let sectors = Sectors::new(4, 2.0);
    // a wall across the way, 1 ahead, narrow; one to the left at 0.5 that reaches far; one behind, out of reach
    let ahead = Wall { from: Vector([1.0, -0.1]), along: Vector([0.0, 0.2]) };
    let left = Wall { from: Vector([-0.2, 0.5]), along: Vector([0.4, 0.0]) };
    let behind = Wall { from: Vector([-3.0, -1.0]), along: Vector([0.0, 2.0]) };
    let found = sectors.nearness(Vector([0.0, 0.0]), Vector([1.0, 0.0]), &[ahead, left, behind]);
    assert!(found.iter().zip([0.5, 0.75, 0.0, 0.0]).all(|(a, b)| close(*a, b)), "{found:?}");
    // the same turned by a quarter and moved
    let turned = |wall: &Wall| Wall { from: wall.from.left() + Vector([7.0, 1.0]), along: wall.along.left() };
    let all: Vec<Wall> = [ahead, left, behind].iter().map(turned).collect();
    let again = sectors.nearness(Vector([7.0, 1.0]), Vector([0.0, 1.0]), &all);
    assert!(again.iter().zip(&found).all(|(a, b)| close(*a, *b)), "{again:?}");
    // a long wall is nearest at the edge of the sectors beside it: 1 / cos 45 degrees
    let long = Wall { from: Vector([1.0, -9.0]), along: Vector([0.0, 18.0]) };
    let found = sectors.nearness(Vector([0.0, 0.0]), Vector([1.0, 0.0]), &[long]);
    let side = 1.0 - core::f64::consts::SQRT_2 / 2.0;
    assert!(found.iter().zip([0.5, side, 0.0, side]).all(|(a, b)| close(*a, b)), "{found:?}");
    assert!(walls(&[Geometry::Disc { centre: Vector([1.0, 0.0]), radius: 0.5 }]).len() > 12);
}

/// What comes next, exactly linear in the state and the walls, in the frame of the heading.
fn law(from: &State, sectors: &Sectors, walls: &[Wall]) -> State {
    let near = sectors.nearness(from.at, from.heading, walls);
    let [along, oblique, across] = seen(from.spread, from.heading);
    let ahead = 0.1 + 0.05 * from.polarisation - 0.02 * near[0];
    let left = 0.02 * along - 0.01 * near[1];
    let mean =
        from.heading * (0.2 + 0.5 * from.polarisation) + from.heading.left() * (0.1 + 0.05 * (near[5] - near[2]));
    let spread = [0.1 + 0.7 * along, 0.6 * oblique, 0.1 + 0.7 * across];
    State {
        at: from.at + from.heading * ahead + from.heading.left() * left,
        heading: mean.unit(),
        polarisation: mean.length(),
        spread: unseen(spread, from.heading.0),
        largest: 0.2 + 0.5 * from.largest + 0.1 * near[3],
    }
}

#[test]
fn a_group_whose_law_is_exactly_linear_is_predicted_exactly() {
    let sectors = Sectors::new(8, 2.0);
    let course = |from: State, walls: &[Wall], looks: usize| -> Vec<State> {
        let mut all = vec![from];
        (1..looks).for_each(|k| all.push(law(&all[k - 1], &sectors, walls)));
        all
    };
    let room = |half: f64| -> Vec<Wall> {
        walls(&[Geometry::Polygon([[-half, -half], [half, -half], [half, half], [-half, half]].map(Vector).to_vec())])
    };
    let rooms = [room(2.0), room(2.5), room(3.0)];
    let training: Vec<(Vec<State>, &[Wall])> = (0..60)
        .map(|k| {
            let walls = rooms[k as usize % 3].as_slice();
            (course(state(k), walls, 12), walls)
        })
        .collect();
    let transitions = || {
        training.iter().flat_map(|(looks, walls)| {
            looks.windows(2).map(move |pair| Transition { from: &pair[0], walls, to: &pair[1] })
        })
    };
    for cells in [true, false] {
        let form = ModelForm { about: String::new(), sectors: 8, reach: 2.0, cells, least: 20 };
        let model = Model::fitted(&form, transitions()).unwrap();
        assert_eq!((model.fit.transitions, model.fit.cells, model.fit.through), (660, 1, 0.0), "{:?}", model.fit);
        assert!(model.fit.explained.iter().all(|(linear, _)| *linear > 1.0 - 1e-9), "{:?}", model.fit);
        // among walls, and from a start, that it has not seen; whatever is drawn
        let other = room(2.2);
        let wanted = course(state(1000), &other, 15);
        for key in [1, 2] {
            let mut found = wanted[0];
            for (look, wanted) in wanted.iter().enumerate().skip(1) {
                found = model.step(&found, &other, key, look as u64);
                assert!((found.at - wanted.at).length() < 1e-7, "{look}: {found:?} {wanted:?}");
                assert!((found.heading - wanted.heading).length() < 1e-7, "{look}: {found:?} {wanted:?}");
                assert!((found.polarisation - wanted.polarisation).abs() < 1e-7);
                assert!(found.spread.iter().zip(wanted.spread).all(|(a, b)| (a - b).abs() < 1e-7));
                assert!((found.largest - wanted.largest).abs() < 1e-7);
            }
        }
    }
    let none = ModelForm { about: String::new(), sectors: 8, reach: 2.0, cells: true, least: 20 };
    assert!(Model::fitted(&none, std::iter::empty()).is_none());
}

#[test]
fn a_group_as_a_whole_does_not_go_through_walls() {
    // transitions of half a length in any direction, seen without walls
    let pairs: Vec<(State, State)> = (0..200)
        .map(|k| {
            let from = State { at: Vector([0.0, 0.0]), ..state(k) };
            let angle = core::f64::consts::TAU * drawn(k, 9);
            (from, State { at: Vector([angle.cos(), angle.sin()]) * 0.5, ..state(k + 300) })
        })
        .collect();
    let transitions = pairs.iter().map(|(from, to)| Transition { from, walls: &[], to });
    let form = ModelForm { about: String::new(), sectors: 8, reach: 2.0, cells: true, least: 20 };
    let model = Model::fitted(&form, transitions).unwrap();
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Vector).to_vec();
    let cage = walls(&[Geometry::Polygon(corners)]);
    let mut now = State { at: Vector([0.0, 0.0]), ..state(7) };
    let mut far: f64 = 0.0;
    for look in 0..500 {
        now = model.step(&now, &cage, 3, look);
        assert!(now.at[0].abs() < 1.0 && now.at[1].abs() < 1.0, "{look}: {now:?}");
        assert!(now.polarisation.is_finite() && now.spread.iter().all(|s| s.is_finite()) && now.heading.finite());
        far = far.max(now.at[0].abs());
    }
    assert!(far > 0.5, "it goes about");
}

/// What is held out of the template's eight walls, with shares that are made up.
#[test]
fn scores_as_worked_out() {
    use lab::design::results::Share;
    use lab::prediction::results::{Item, Predicted, Results, Score};
    let set = ["constructs=8", "predicted=9"].map(str::to_owned);
    let text = lab::prediction::TEMPLATE;
    let plan = lab::prediction::read("wall.toml", text, &set, false, &mut |_| Err("no other file".into())).unwrap();
    assert_eq!((plan.numbers(0, true), plan.numbers(0, false)), (vec![3, 7], vec![0, 1, 2, 4, 5, 6]));
    // of what is not held out half succeed, but all of the wall that is nearest to wall 3
    let built = |number: u64| plan.built(0, number).unwrap().values;
    let apart = |number: &u64| -> f64 {
        let one = |k: usize| {
            let axis = plan.lots[0].drawn[k].axis;
            let share = ((built(*number)[k] - built(3)[k]) / (axis.high - axis.low)).abs();
            // an angle is near from both sides
            if k == 0 { share.min(1.0 - share).powi(2) } else { share * share }
        };
        one(0) + one(1)
    };
    let nearest = plan.numbers(0, false).into_iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap();
    let simulated = |lot: usize, number: u64| match (lot, number) {
        (0, 3) => (Share { successes: 1, trials: 2 }, 140),
        (0, 7) => (Share { successes: 4, trials: 4 }, 280),
        (0, number) if number == nearest => (Share { successes: 2, trials: 2 }, 1),
        _ => (Share { successes: 1, trials: 2 }, 1),
    };
    let predicted = |model: usize, _: usize, number: u64| {
        let successes = if number == 3 { 3 } else { 9 * (1 - model as u64) };
        Predicted { share: Share { successes, trials: 9 }, transitions: 90 }
    };
    let share = Share { successes: 1, trials: 2 };
    let results = Results::new(&plan, &simulated, &predicted, Vec::new(), (share, vec![share; 2]));
    let items: Vec<&Item> = results.tests[0].items.iter().collect();
    assert_eq!((results.tests.len(), results.tests[1].items.len(), results.training.len()), (2, 10, 6));
    let score = |score, by| results.score(score, &items, by);
    // by the mean: 7 of 12 succeed
    let p: f64 = 7.0 / 12.0;
    assert!(close(score(Score::Brier, 0), (0.5 * (p * p + (1.0 - p) * (1.0 - p)) + (1.0 - p) * (1.0 - p)) / 2.0));
    assert!(close(score(Score::Bias, 0), p - 0.75) && score(Score::Spearman, 0).is_nan());
    assert!(items[0].chances[1] > 0.5, "the nearest wall counts: {:?}", items[0]);
    // by the first model a third and all, by the second a third and none
    assert!(close(score(Score::Brier, 2), (0.5 * (1.0 / 9.0 + 4.0 / 9.0)) / 2.0));
    assert!(
        close(score(Score::Mae, 2), (0.5 - 1.0 / 3.0) / 2.0)
            && close(score(Score::Mae, 3), (0.5 - 1.0 / 3.0 + 1.0) / 2.0)
    );
    // no chance is less than that of half a success among the nine
    let loss = -0.5 * (0.5 * (1.0f64 / 3.0).ln() + 0.5 * (2.0f64 / 3.0).ln());
    assert!(close(score(Score::LogLoss, 3), loss - 0.5 * 0.05f64.ln()));
    // of two trials at an even chance half are off by a half
    assert!(close(results.sampling(&items), 0.125));
}
