//! Directed decomposition: stretches of the construct whose effect is known are fitted by segments and arcs, and the fit is turned and
//! stretched to find the range of its attributes that still has that effect.

use super::form::{Interval, Vary};
use super::plan::Plan;
use super::results::Effect;
use crate::environment::behaviour::Around;
use crate::environment::trial;
use crate::file::{Desk, Node};
use crate::scenario::build::Wrong;
use measure::behaviours::Behaviour;
use space::random::child_seed;
use terrain::fit::{Fit, fit};
use terrain::{Construct, Geometry, Piece, Point, Pose};

/// Kind of child seeds: a trial of a variation.
const VARIED: u32 = 15;

/// A stretch of the construct with its fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Marked {
    /// Its name.
    pub name: String,
    /// The stretch, by its points.
    pub stretch: Vec<Point>,
    /// The pieces that fit it, from its first end to its last.
    pub fits: Vec<Fit>,
}

impl Marked {
    /// Where the fit begins: it is turned and stretched about this point.
    pub fn first(&self) -> Point {
        self.fits.first().and_then(|fit| fit.shape.points().first().copied()).unwrap_or(Point::ZERO)
    }
    /// Root mean squared distance of the stretch from the worst of its pieces.
    pub fn error(&self) -> f64 {
        self.fits.iter().map(|fit| fit.error).fold(0.0, f64::max)
    }
    /// The walls of the fit about the origin, turned by an angle (degrees) and stretched by a factor.
    pub fn shape(&self, angle: f64, factor: f64) -> Vec<Geometry> {
        let to_origin = Pose { at: -self.first(), heading: 0.0 };
        let turned = Pose { at: Point::ZERO, heading: angle };
        let walls = self.fits.iter().flat_map(|fit| fit.shape.geometry());
        walls.map(|wall| wall.moved(&to_origin, [1.0, 1.0]).moved(&turned, [factor, factor])).collect()
    }
    /// The same where the stretch stands, as a construct.
    pub fn construct(&self, units: terrain::Units, angle: f64, factor: f64) -> Construct {
        let there = Pose { at: self.first(), heading: 0.0 };
        let geometry = self.shape(angle, factor).iter().map(|wall| wall.moved(&there, [1.0, 1.0])).collect();
        Construct::new(units, vec![Piece { name: self.name.clone(), geometry }])
    }
}

/// What was found of a variation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Found {
    /// Trials that succeeded.
    pub successes: u64,
    /// Trials.
    pub trials: u64,
}

impl Found {
    /// Share of successes; 0 of no trials.
    pub fn rate(&self) -> f64 {
        if self.trials > 0 { self.successes as f64 / self.trials as f64 } else { 0.0 }
    }
}

/// Angles and factors of a variation by its number, factors fastest; none for the trials without any wall, which come last.
pub fn variation(vary: &Vary, number: usize) -> Option<(f64, f64)> {
    let (angle, factor) = (number / vary.lengths.len(), number % vary.lengths.len());
    vary.angles.get(angle).map(|angle| (*angle, vary.lengths[factor]))
}

/// Number of variations of a stretch, the trials without any wall among them.
pub fn variations(vary: &Vary) -> usize {
    vary.angles.len() * vary.lengths.len() + 1
}

/// The largest box of variations around the fit itself in which all succeed often enough: least and greatest angle and factor. None
/// where the fit itself does not.
pub fn range(vary: &Vary, found: &[Found]) -> Option<[(f64, f64); 2]> {
    let (rows, columns) = (vary.angles.len(), vary.lengths.len());
    let row = vary.angles.iter().position(|angle| *angle == 0.0)?;
    let column = vary.lengths.iter().position(|factor| *factor == 1.0)?;
    let holds = |a: usize, b: usize| found.get(a * columns + b).is_some_and(|found| found.rate() >= vary.least);
    let mut best: Option<(usize, [usize; 4])> = None;
    for top in 0..=row {
        for bottom in row..rows {
            for left in 0..=column {
                for right in column..columns {
                    let all = (top..=bottom).all(|a| (left..=right).all(|b| holds(a, b)));
                    let size = (bottom - top + 1) * (right - left + 1);
                    if all && best.is_none_or(|best| size > best.0) {
                        best = Some((size, [top, bottom, left, right]));
                    }
                }
            }
        }
    }
    best.map(|(_, [top, bottom, left, right])| {
        [(vary.angles[top], vary.angles[bottom]), (vary.lengths[left], vary.lengths[right])]
    })
}

/// The stretches that a file marks; what is wrong goes to the desk.
pub fn marked(
    intervals: &[(String, Interval)],
    vary: &Vary,
    lines: &[terrain::fragments::Polyline],
    tree: &Node,
    desk: &mut Desk,
) -> Vec<Marked> {
    let mut all = Vec::new();
    for (name, interval) in intervals {
        let mut wrong = |key: &str, what: String, expected: String| {
            desk.problem(&tree.place(&format!("interval.{name}.{key}")), what, expected, "");
        };
        // primitives are files by their names, and clusters have those of effects
        if Effect::ALL.iter().any(|effect| name.starts_with(effect.word())) {
            wrong("behaviour", format!("`{name}` may be the name of a cluster"), "a name of its own".to_owned());
            continue;
        }
        let Some(line) = interval.line.checked_sub(1).and_then(|number| lines.get(number)) else {
            let expected = format!("a number from 1 to {}", lines.len());
            wrong("line", format!("the construct has no line {}", interval.line), expected);
            continue;
        };
        let length = line.length();
        if interval.from >= interval.to || interval.to > length * (1.0 + 1e-9) {
            let what = format!("line {} has no stretch from {} to {}", interval.line, interval.from, interval.to);
            wrong("to", what, format!("from 0 up to its length {}, in order", crate::report::short(length)));
            continue;
        }
        let (from, to) = (interval.from, interval.to.min(length));
        let fits = fit(line, from, to, vary.tolerance);
        all.push(Marked { name: name.clone(), stretch: line.between(from, to), fits });
    }
    for (key, list, own, what) in
        [("angles", &vary.angles, 0.0, "turned by no angle"), ("lengths", &vary.lengths, 1.0, "of its own length")]
    {
        if !intervals.is_empty() && (!list.contains(&own) || list.windows(2).any(|two| two[0] >= two[1])) {
            let expected = format!("numbers in ascending order, {own} among them");
            let what = format!("the fit itself, {what}, must be one of its variations");
            desk.problem(&tree.place(&format!("vary.{key}")), what, expected, "");
        }
    }
    all
}

impl Plan {
    /// Trials of each variation.
    pub fn varied_trials(&self) -> usize {
        let vary = &self.form.vary;
        if self.quick { vary.quick_trials.min(vary.trials) } else { vary.trials }
    }
    /// The seed of a trial of a variation: the same for all of them.
    pub fn varied_seed(&self, trial: usize) -> u64 {
        child_seed(self.form.seed, VARIED, trial as u64, 0) >> 1
    }
    /// The behaviour that a stretch is to elicit, where a construct stands in the workspace.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn expected(&self, marked: usize, construct: &Construct, built: bool) -> Result<Behaviour, Wrong> {
        let setting = self.workspace.setting(construct, built);
        let around = Around { setting: &setting, groups: &self.population.groups };
        let (name, interval) = &self.form.interval.0[marked];
        let plain = interval.behaviour.plain(name, around);
        plain.map_err(|wrong| wrong.below(&format!("interval.{name}.behaviour")))
    }
    /// The trials of a variation, with the number of agent-updates; none where they were stopped.
    ///
    /// # Errors
    /// A behaviour without a meaning, in a sentence.
    pub fn vary(&self, marked: usize, number: usize, stop: &dyn Fn() -> bool) -> Result<Option<(Found, u64)>, String> {
        let own = &self.marked[marked];
        let variation = variation(&self.form.vary, number);
        let (angle, factor) = variation.unwrap_or((0.0, 1.0));
        let construct = own.construct(self.construct.units, angle, factor);
        let built = variation.is_some();
        let behaviour = self.expected(marked, &construct, built);
        let behaviours = [behaviour.map_err(|wrong| format!("{}: {}", wrong.path, wrong.what))?];
        let there = self.workspace.workspace.geometry.iter();
        let scenario = self.population.among(there.chain(construct.geometry().filter(|_| built)));
        let (mut found, mut updates) = (Found::default(), 0);
        for trial in 1..=self.varied_trials() {
            found.trials += 1;
            let seed = self.varied_seed(trial);
            match trial::run(&scenario, &self.population, &behaviours, seed, stop, &mut |_| ()) {
                // impossible with this seed: it counts as a failure
                Err(_) => {}
                Ok(None) => return Ok(None),
                Ok(Some(tried)) => {
                    updates += tried.steps * self.population.members() as u64;
                    let fitness = tried.outcomes.first().map_or(0.0, |outcome| outcome.fitness);
                    found.successes += u64::from(fitness >= self.form.vary.success);
                }
            }
        }
        Ok(Some((found, updates)))
    }
}
