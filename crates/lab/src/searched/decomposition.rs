//! A decomposition: the construct with its fragments by cluster, what each approach came to, and any of its trials again; of marked
//! stretches, any variation of the fit.

use super::{At, Searched, Watched, all_rounded, drawing, rounded};
use crate::decomposition::directed::{variation, variations};
use crate::decomposition::execute::{self, Known};
use crate::decomposition::probe::NUMBERS;
use crate::decomposition::results::{Item, Results};
use crate::decomposition::{Plan, report};
use crate::design::report::put;
use crate::environment::trial;
use crate::formation::report::circle;
use crate::live::LiveError;
use crate::report::{Drawing, Page, Stroke};
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use std::path::Path;
use terrain::Geometry;

/// Share of a window, about its middle, that is drawn in the colour of its cluster: windows overlap, and their middles lie side by side.
const SHOWN: f64 = 0.25;
/// Length of the line that shows the way of the group at its start, in radii of the arena.
const WAY: f64 = 0.3;

/// A decomposition in its folder.
pub struct Decomposed {
    plan: Plan,
    known: Known,
}

/// What is tried at a place: a fragment approached at an offset, or a variation of the fit of a stretch.
enum Spot {
    Approach { number: usize, offset: usize },
    Variation { marked: usize, number: usize },
}

impl Decomposed {
    /// The decomposition in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (plan, known) = execute::look(path)?;
        Ok(Self { plan, known })
    }
    fn spot(&self, at: &At) -> Result<Spot, LiveError> {
        let plan = &self.plan;
        if at.number("interval").is_some() {
            let marked = at.below("interval", plan.marked.len())?;
            return Ok(Spot::Variation { marked, number: at.below("variation", variations(&plan.form.vary))? });
        }
        let number = at.below("approach", plan.approaches())?;
        // left out, the one that is most nearly none
        let offset = match at.number("offset") {
            Some(_) => at.below("offset", plan.form.offsets)?,
            None => plan.form.offsets / 2,
        };
        Ok(Spot::Approach { number, offset })
    }
    /// The walls of a variation, and where it is; without any wall where it is the last.
    fn varied(&self, marked: usize, number: usize) -> Vec<Geometry> {
        let (plan, variation) = (&self.plan, variation(&self.plan.form.vary, number));
        variation.map_or_else(Vec::new, |(angle, factor)| {
            plan.marked[marked].construct(plan.construct.units, angle, factor).geometry().cloned().collect()
        })
    }
    /// An approach: what stands in the arena, the rim of this, and the group at its start with its way.
    fn arena(&self, number: usize, offset: usize) -> Drawing {
        let probe = self.plan.probe(number, offset);
        let (begin, radius) = (&self.plan.begin, probe.arena.radius);
        let mut picture = Drawing::default();
        put(&mut picture, &probe.geometry, Stroke::Built);
        picture.strokes.push((Stroke::Structure, circle(probe.arena.centre, radius)));
        let ahead = begin.centre + begin.heading * (WAY * radius);
        picture.strokes.push((Stroke::Structure, vec![begin.centre.0, ahead.0]));
        picture.marks.push(begin.centre.0);
        picture
    }
    fn approach(&self, item: &Item) -> Json {
        let plan = &self.plan;
        let (fragment, heading) = plan.approach(item.approach);
        // stretches between peaks of curvature lie one behind the other
        let share = if plan.form.windows.contains(&fragment.width) { SHOWN } else { 1.0 };
        let half = fragment.width * share / 2.0;
        let points = plan.lines[fragment.line].between(fragment.middle - half, fragment.middle + half);
        json!({
            "approach": item.approach,
            "line": fragment.line + 1,
            "middle": rounded(fragment.middle),
            "window": rounded(fragment.width),
            "heading": rounded(heading),
            "effect": item.effect.word(),
            "cluster": item.cluster,
            "points": all_rounded(points.iter().flat_map(|point| point.0)),
            "found": all_rounded(item.descriptor),
            "relative": all_rounded(item.relative),
        })
    }
    /// A marked stretch with what was found of its variations.
    fn interval(&self, results: &Results<'_>, marked: usize) -> Json {
        let plan = &self.plan;
        let row = |(number, found): (usize, &crate::decomposition::directed::Found)| {
            let (angle, factor) = variation(&plan.form.vary, number).unzip();
            json!({ "angle": angle, "factor": factor, "successes": found.successes, "trials": found.trials })
        };
        json!({
            "name": plan.marked[marked].name,
            "expected": report::expected(plan, marked),
            "variations": results.varied[marked].iter().enumerate().map(row).collect::<Vec<_>>(),
        })
    }
}

impl Searched for Decomposed {
    fn overview(&self) -> Json {
        let plan = &self.plan;
        let results = self.known.results(plan);
        let mut construct = Drawing::default();
        put(&mut construct, plan.construct.geometry(), Stroke::There);
        let clusters = results.clusters.iter().map(|cluster| {
            json!({
                "name": cluster.name,
                "effect": cluster.effect.word(),
                "effects": report::effects(cluster).join(", "),
                "approaches": cluster.items.len(),
                "medoid": cluster.medoid,
            })
        });
        json!({
            "kind": "decomposition",
            "title": plan.form.title,
            "about": plan.form.about,
            "unit": report::unit(plan),
            "offsets": plan.form.offsets,
            "trials": plan.trials,
            "varied_trials": plan.varied_trials(),
            "tried": self.known.tried(plan),
            "planned": plan.approaches(),
            "construct": drawing(&construct),
            "numbers": NUMBERS.map(|(name, unit, about)| json!({ "name": name, "unit": unit, "about": about })),
            "clusters": clusters.collect::<Vec<_>>(),
            "approaches": results.items.iter().map(|item| self.approach(item)).collect::<Vec<_>>(),
            "intervals": (0..plan.marked.len()).map(|marked| self.interval(&results, marked)).collect::<Vec<_>>(),
        })
    }
    /// The drawing of an approach in its arena, or of a variation in the workspace.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        let picture = match self.spot(at)? {
            Spot::Approach { number, offset } => self.arena(number, offset),
            Spot::Variation { marked, number } => {
                let mut picture = Drawing::default();
                put(&mut picture, &self.plan.workspace.workspace.geometry, Stroke::There);
                put(&mut picture, &self.varied(marked, number), Stroke::Built);
                picture.marks.push(self.plan.marked[marked].first().0);
                picture
            }
        };
        Ok(json!({ "drawing": drawing(&picture) }))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let plan = &self.plan;
        let trial = at.perhaps("trial").unwrap_or(1).max(1);
        let (name, what, geometry, seed) = match self.spot(at)? {
            Spot::Approach { number, offset } => {
                let (fragment, heading) = plan.approach(number);
                let what = format!(
                    "line {} at {}, approached at {}\u{b0}, offset {}",
                    fragment.line + 1,
                    crate::report::short(fragment.middle),
                    crate::report::short(heading),
                    crate::report::short(plan.offset(fragment.width, offset))
                );
                (format!("approach-{number}"), what, plan.probe(number, offset).geometry, plan.seed_of(trial))
            }
            Spot::Variation { marked, number } => {
                let own = &plan.marked[marked].name;
                let what = match variation(&plan.form.vary, number) {
                    Some((angle, factor)) => format!("{own}, turned by {angle}\u{b0}, stretched by {factor}"),
                    None => format!("{own}, without any wall"),
                };
                let there = plan.workspace.workspace.geometry.iter().cloned();
                let geometry = there.chain(self.varied(marked, number)).collect();
                (own.clone(), what, geometry, plan.varied_seed(trial))
            }
        };
        let title = format!("{}: {what}, trial {trial}", plan.form.title);
        let text = trial::file(&plan.population, &geometry, Vec::new(), seed, &title);
        Ok(Watched::Scenario { name: format!("{name}-trial-{trial}.toml"), text, seed: None })
    }
    fn page(&self, program: &str) -> Page {
        report::page(&self.known.results(&self.plan), program)
    }
    fn telling(&self) -> Vec<At> {
        let plan = &self.plan;
        let results = self.known.results(plan);
        let medoid = |cluster: &crate::decomposition::results::Cluster| {
            let approach = results.items[cluster.medoid].approach;
            At::new(&[("approach", approach as f64), ("offset", (plan.form.offsets / 2) as f64), ("trial", 1.0)])
        };
        // of a stretch its fit as it is
        let own = (0..variations(&plan.form.vary)).find(|&k| variation(&plan.form.vary, k) == Some((0.0, 1.0)));
        let tried = |marked: &usize| own.is_some_and(|own| results.varied[*marked][own].trials > 0);
        let fit = |marked: usize| {
            let own = own.unwrap_or_default() as f64;
            At::new(&[("interval", marked as f64), ("variation", own), ("trial", 1.0)])
        };
        results.clusters.iter().map(medoid).chain((0..plan.marked.len()).filter(tried).map(fit)).collect()
    }
    fn words(&self) -> Vec<String> {
        ["approach", "offset", "interval", "variation", "trial"].map(str::to_owned).to_vec()
    }
}
