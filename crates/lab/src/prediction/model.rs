//! A macroscopic model: how the state of a group goes on from one look to the next, among walls.
//!
//! In the frame of the group's heading, the state at the next look is a linear law of the present state and the walls around (least squares),
//! and a deviation from it, drawn from those that were seen in the same cell of states: a Markov chain. A deviation is drawn whole, so that
//! what goes together (a turn, and where it leads) does so in what is predicted.

use super::cells::Cells;
use super::form::ModelForm;
use super::regression::{Linear, least_squares};
use super::state::{State, headed, not_negative, seen, unseen};
use super::surroundings::{Sectors, Wall, free};
use space::random::{Purpose, uniform};

/// What the law gives, with units and meanings; all in the frame of the heading at the look before.
pub const OUTPUTS: [(&str, &str, &str); 8] = [
    ("ahead", "length", "way of the centroid ahead"),
    ("left", "length", "way of the centroid to the left"),
    ("heading_ahead", "1", "mean heading, its part ahead"),
    ("heading_left", "1", "mean heading, its part to the left"),
    ("along", "length", "spread along the heading"),
    ("oblique", "length", "spread, the part that is neither along nor across"),
    ("across", "length", "spread across the heading"),
    ("largest", "1", "share of the largest group"),
];
const COUNT: usize = OUTPUTS.len();
/// Times that another deviation is drawn where one would lead the centroid through a wall.
const TIMES: u32 = 8;

/// What a model is fitted to: a state, the walls around, and the state at the next look.
#[derive(Clone, Copy, Debug)]
pub struct Transition<'a> {
    /// The state.
    pub from: &'a State,
    /// The walls.
    pub walls: &'a [Wall],
    /// The state at the next look.
    pub to: &'a State,
}

/// How well a model tells what it was fitted to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fit {
    /// Transitions it was fitted to.
    pub transitions: usize,
    /// Cells.
    pub cells: usize,
    /// Share of the variance of each output that the linear law explains, and with the means of the cells; not a number where it has none.
    pub explained: [(f64, f64); COUNT],
    /// Share of the transitions in which the centroid went through a wall.
    pub through: f64,
}

/// A macroscopic model.
#[derive(Clone, Debug)]
pub struct Model {
    sectors: Sectors,
    linear: Linear,
    deviations: Vec<[f64; COUNT]>,
    cells: Cells,
    /// How well it fits.
    pub fit: Fit,
}

/// The state and the walls around as the law takes them.
fn inputs(state: &State, sectors: &Sectors, walls: &[Wall]) -> Vec<f64> {
    let mut inputs = vec![state.polarisation];
    inputs.extend(seen(state.spread, state.heading));
    inputs.push(state.largest);
    inputs.extend(sectors.nearness(state.at, state.heading, walls));
    inputs
}

/// The next state as the law gives it.
fn outputs(from: &State, to: &State) -> [f64; COUNT] {
    let frame = |v: terrain::Point| [v.dot(from.heading), v.dot(from.heading.left())];
    let [ahead, left] = frame(to.at - from.at);
    let [heading_ahead, heading_left] = frame(to.heading * to.polarisation);
    let [along, oblique, across] = seen(to.spread, from.heading);
    [ahead, left, heading_ahead, heading_left, along, oblique, across, to.largest]
}

/// The next state of what the law gave.
fn next(from: &State, outputs: &[f64; COUNT]) -> State {
    let [ahead, left, heading_ahead, heading_left, along, oblique, across, largest] = *outputs;
    let place = |ahead: f64, left: f64| from.heading * ahead + from.heading.left() * left;
    let (heading, polarisation) = headed(place(heading_ahead, heading_left), from.heading);
    State {
        at: from.at + place(ahead, left),
        heading,
        polarisation,
        spread: unseen(not_negative([along, oblique, across]), from.heading.0),
        largest: largest.clamp(0.0, 1.0),
    }
}

fn columns(rows: &[impl AsRef<[f64]>]) -> Vec<Vec<f64>> {
    let count = rows.first().map_or(0, |row| row.as_ref().len());
    (0..count).map(|k| rows.iter().map(|row| row.as_ref()[k]).collect()).collect()
}

fn squares(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    values.map(|value| (value - mean) * (value - mean)).sum()
}

impl Model {
    /// Fits a model to transitions; none where there are none. Sums are taken in their order.
    pub fn fitted<'a>(form: &ModelForm, transitions: impl Iterator<Item = Transition<'a>>) -> Option<Self> {
        let sectors = Sectors::new(form.sectors, form.reach);
        let (mut given, mut wanted, mut through) = (Vec::new(), Vec::new(), 0usize);
        for Transition { from, walls, to } in transitions {
            given.push(inputs(from, &sectors, walls));
            wanted.push(outputs(from, to));
            through += usize::from(free(from.at, to.at - from.at, walls) < 1.0);
        }
        if given.is_empty() {
            return None;
        }
        let targets = columns(&wanted);
        let linear = least_squares(columns(&given), &targets);
        let deviation = |(inputs, wanted): (&Vec<f64>, &[f64; COUNT])| {
            let law: [f64; COUNT] = linear.of(inputs);
            core::array::from_fn(|k| wanted[k] - law[k])
        };
        let deviations: Vec<[f64; COUNT]> = given.iter().zip(&wanted).map(deviation).collect();
        let cells = if form.cells {
            Cells::grown(&columns(&given), &columns(&deviations), form.least)
        } else {
            Cells::one(deviations.len())
        };
        let mut left = deviations.clone();
        cells.each(|items| {
            for k in 0..COUNT {
                let mean = items.iter().map(|&item| deviations[item as usize][k]).sum::<f64>() / items.len() as f64;
                items.iter().for_each(|&item| left[item as usize][k] -= mean);
            }
        });
        let explained = core::array::from_fn(|k| {
            let all = squares(targets[k].iter().copied());
            let share = |rest: f64| 1.0 - rest / all;
            (share(squares(deviations.iter().map(|one| one[k]))), share(squares(left.iter().map(|one| one[k]))))
        });
        let transitions = given.len();
        let fit = Fit { transitions, cells: cells.count(), explained, through: through as f64 / transitions as f64 };
        Some(Self { sectors, linear, deviations, cells, fit })
    }
    /// The state at the next look, with the draws of a key at this look. A deviation that would lead the centroid through a wall is drawn
    /// again; at last the centroid stays where it is.
    pub fn step(&self, state: &State, walls: &[Wall], key: u64, look: u64) -> State {
        let inputs = inputs(state, &self.sectors, walls);
        let law: [f64; COUNT] = self.linear.of(&inputs);
        let items = self.cells.at(&inputs);
        let mut last = *state;
        for slot in 0..TIMES {
            let place = (uniform(key, Purpose::Behaviour, look, slot) * items.len() as f64) as usize;
            let deviation = &self.deviations[items[place.min(items.len() - 1)] as usize];
            last = next(state, &core::array::from_fn(|k| law[k] + deviation[k]));
            if free(state.at, last.at - state.at, walls) >= 1.0 {
                return last;
            }
        }
        State { at: state.at, ..last }
    }
}
