//! What a map says: densities, rates, components; and the names by which statements ask for it.

use super::form::{MeasureForm, Quantity};
use super::plan::Plan;
use crate::environment::claims::{Data, hint};
use crate::study::expression::{Mistake, Selector, Value};
use core::ops::Range;
use measure::statistics::spearman;
use search::refine::{Leaf, Refinement};
use space::spelling::nearest;

/// What was found in a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CellResult {
    /// Trials that succeeded.
    pub successes: u64,
    /// Trials; none where the point is outside the schema's domain.
    pub trials: u64,
    /// Mean fitness; not a number of no trials.
    pub fitness: f64,
}

impl CellResult {
    /// Share of successes; 0 of no trials.
    pub fn rate(&self) -> f64 {
        if self.trials > 0 { self.successes as f64 / self.trials as f64 } else { 0.0 }
    }
}

/// A panel with its map.
#[derive(Clone)]
pub struct PanelMap {
    /// The map.
    pub map: Refinement,
    /// What was found in each evaluation, in their order.
    pub results: Vec<CellResult>,
    /// What was found without a construct.
    pub control: CellResult,
}

impl PanelMap {
    /// What was found in a leaf.
    pub fn result(&self, leaf: &Leaf) -> CellResult {
        self.results.get(leaf.evaluation).copied().unwrap_or_default()
    }
    /// The leaves inside the schema's domain.
    pub fn leaves(&self) -> impl Iterator<Item = (&Leaf, CellResult)> {
        self.map.leaves().iter().map(|leaf| (leaf, self.result(leaf))).filter(|(_, result)| result.trials > 0)
    }
}

/// All panels of a map.
pub struct Found<'a> {
    /// The plan.
    pub plan: &'a Plan,
    /// The panels, in order.
    pub panels: Vec<PanelMap>,
}

impl<'a> Found<'a> {
    /// Maps without leaves, to find out whether statements have a meaning.
    pub(super) fn example(plan: &'a Plan) -> Self {
        let control = CellResult { successes: 1, trials: 1, fitness: 1.0 };
        let panel = |_| plan.begin().ok().map(|map| PanelMap { map, results: Vec::new(), control });
        Self { plan, panels: (0..plan.panels.len()).filter_map(panel).collect() }
    }
    /// A measure.
    pub fn measure(&self, form: &MeasureForm) -> f64 {
        let number = form
            .panel
            .as_ref()
            .map_or(Some(0), |name| self.plan.panels.iter().position(|panel| panel.population.name == *name));
        let Some(panel) = number.and_then(|k| self.panels.get(k)) else { return f64::NAN };
        let (low, high) = self.bounds(form);
        let dimensions = low.len();
        let within = |leaf: &Leaf| {
            let centre = panel.map.centre(&leaf.cell);
            (0..dimensions).all(|a| (low[a]..=high[a]).contains(&centre[a])) != form.outside
        };
        // size of the part of a leaf in the box, or outside it
        let size = |leaf: &Leaf| -> f64 {
            let (from, to) = panel.map.bounds(&leaf.cell);
            let part = |a: usize| (to[a].min(high[a]) - from[a].max(low[a])).max(0.0);
            let inside: f64 = (0..dimensions).map(part).product();
            let whole: f64 = (0..dimensions).map(|a| to[a] - from[a]).product();
            if form.outside { whole - inside } else { inside }
        };
        let weighted = |of: &dyn Fn(&Leaf, CellResult) -> f64| {
            let (mut sum, mut all) = (0.0, 0.0);
            for (leaf, result) in panel.leaves() {
                sum += size(leaf) * of(leaf, result);
                all += size(leaf);
            }
            sum / all
        };
        let region = panel.map.region();
        let largest = || {
            let size = |leaves: &Vec<usize>| -> f64 {
                let one = |&k: &usize| -> f64 {
                    let (from, to) = panel.map.bounds(&panel.map.leaves()[k].cell);
                    from.iter().zip(&to).map(|(from, to)| to - from).product()
                };
                leaves.iter().map(one).sum()
            };
            let all: Vec<(f64, Vec<usize>)> =
                region.components().into_iter().map(|leaves| (size(&leaves), leaves)).collect();
            let total: f64 = all.iter().map(|(size, _)| size).sum();
            all.into_iter().reduce(|best, other| if other.0 > best.0 { other } else { best }).map(|best| (best, total))
        };
        match form.of {
            Quantity::Density => weighted(&|leaf, _| f64::from(u8::from(leaf.found.valid))),
            Quantity::MeanRate => weighted(&|_, result| result.rate()),
            Quantity::ValidCells => panel.leaves().filter(|(leaf, _)| leaf.found.valid && within(leaf)).count() as f64,
            Quantity::Cells => panel.leaves().filter(|(leaf, _)| within(leaf)).count() as f64,
            Quantity::Components => region.components().len() as f64,
            Quantity::LargestComponent => largest().map_or(0.0, |((size, _), total)| size / total),
            Quantity::LargestMeets => {
                let meets = |k: &usize| within(&panel.map.leaves()[*k]);
                f64::from(u8::from(largest().is_some_and(|((_, leaves), _)| leaves.iter().any(meets))))
            }
            Quantity::Evaluations => panel.map.evaluations().iter().sum::<usize>() as f64,
            Quantity::Control => panel.control.successes as f64 / panel.control.trials as f64,
            Quantity::RankCorrelation => {
                let factor = |name: &str| {
                    let given = form.along.0.iter().find(|(known, _)| known == name);
                    given.map_or(0.0, |(_, factor)| *factor)
                };
                let along = |centre: Vec<f64>| -> f64 {
                    self.plan.axes.iter().zip(centre).map(|(axis, value)| factor(&axis.name) * value).sum()
                };
                let points = panel.leaves().filter(|(leaf, _)| within(leaf));
                let (x, y): (Vec<f64>, Vec<f64>) =
                    points.map(|(leaf, result)| (along(panel.map.centre(&leaf.cell)), result.rate())).unzip();
                spearman(&x, &y, 0.95).map_or(f64::NAN, |found| found.r)
            }
            Quantity::RateAt => {
                let middle: Vec<f64> = low.iter().zip(&high).map(|(low, high)| (low + high) / 2.0).collect();
                let holds = |leaf: &Leaf| {
                    let (from, to) = panel.map.bounds(&leaf.cell);
                    (0..dimensions).all(|a| (from[a]..=to[a]).contains(&middle[a]))
                };
                panel.leaves().find(|(leaf, _)| holds(leaf)).map_or(f64::NAN, |(_, result)| result.rate())
            }
        }
    }
    /// The box of a measure.
    fn bounds(&self, form: &MeasureForm) -> (Vec<f64>, Vec<f64>) {
        let ends = |axis: &super::plan::MapAxis| {
            let given = form.inside.0.iter().find(|(name, _)| *name == axis.name).map(|(_, ends)| ends.as_slice());
            match given {
                Some(&[low, high]) => (low, high),
                _ => (axis.axis.low, axis.axis.high),
            }
        };
        self.plan.axes.iter().map(ends).unzip()
    }
}

impl Data for Found<'_> {
    fn items(&self) -> usize {
        0
    }
    fn value(&self, name: &str, _: &[Selector], bytes: &Range<usize>, _: Option<&[usize]>) -> Result<Value, Mistake> {
        let measures = &self.plan.form.measure.0;
        match measures.iter().find(|(known, _)| known == name) {
            Some((_, form)) => Ok(Value::Number(self.measure(form))),
            None => {
                let near = nearest(name, measures.iter().map(|(known, _)| known.as_str()));
                let help = near.map_or_else(
                    || "measures are declared as [measure.NAME]".to_owned(),
                    |near| format!("did you mean `{near}`?"),
                );
                Err(Mistake { help, ..Mistake::new(bytes.clone(), format!("there is no measure `{name}`")) })
            }
        }
    }
}

/// What is wrong with the measures: path, sentence, remedy.
pub(super) fn check(plan: &Plan) -> Vec<(String, String, String)> {
    let mut wrongs = Vec::new();
    let panels: Vec<&str> = plan.panels.iter().map(|panel| panel.population.name.as_str()).collect();
    let axes: Vec<&str> = plan.axes.iter().map(|axis| axis.name.as_str()).collect();
    for (name, form) in &plan.form.measure.0 {
        let at = format!("measure.{name}");
        if let Some(panel) = form.panel.as_deref().filter(|panel| !panels.contains(panel)) {
            wrongs.push((format!("{at}.panel"), format!("there is no panel `{panel}`"), hint(panel, &panels)));
        }
        for (axis, ends) in &form.inside.0 {
            if !axes.contains(&axis.as_str()) {
                wrongs.push((format!("{at}.inside.{axis}"), format!("there is no axis `{axis}`"), hint(axis, &axes)));
            } else if !matches!(ends.as_slice(), [low, high] if low <= high) {
                let what = format!("`{axis}` takes [least, greatest]");
                wrongs.push((format!("{at}.inside.{axis}"), what, String::new()));
            }
        }
        for (axis, _) in form.along.0.iter().filter(|(axis, _)| !axes.contains(&axis.as_str())) {
            wrongs.push((format!("{at}.along.{axis}"), format!("there is no axis `{axis}`"), hint(axis, &axes)));
        }
        if form.of == Quantity::RankCorrelation && form.along.0.is_empty() {
            wrongs.push((at, "a correlation needs axes: along = { NAME = 1 }".to_owned(), hint("", &axes)));
        }
    }
    wrongs
}
