//! An evolution: fitness and genes over the generations of each run, and the world of any generation.

use super::{At, Searched, Watched, all_rounded, rounded};
use crate::evolution::contest::Contest;
use crate::evolution::evaluate::{self, world_seed};
use crate::evolution::execute::{self, Run};
use crate::evolution::{Plan, Variants, report};
use crate::file::write::toml;
use crate::file::{Form, Node, Span, Tree};
use crate::live::LiveError;
use crate::report::Page;
use crate::store::StoreError;
use serde_json::{Value as Json, json};
use std::path::Path;

/// Numbers of genes that a page is told of one run; of more generations, only some are.
const TOLD: usize = 400_000;

/// An evolution in its folder.
pub struct Evolved {
    variants: Variants,
    /// Its runs, variant by variant.
    runs: Vec<Run>,
    /// Its contests, where all were held.
    contests: Vec<Contest>,
}

impl Evolved {
    /// The evolution in a folder.
    ///
    /// # Errors
    /// A folder that holds none, or one that cannot be read.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let (variants, runs, contests) = execute::look(path)?;
        Ok(Self { variants, runs, contests })
    }
    /// Plan, own number from 1, and what is known of a run.
    fn run(&self, at: &At) -> Result<(&Plan, usize, &Run), LiveError> {
        let run = at.below("run", self.runs.len())?;
        let (variant, own) = self.variants.of_run(run);
        Ok((&self.variants.plans[variant], own + 1, &self.runs[run]))
    }
    fn name(&self, run: usize) -> String {
        let (variant, own) = self.variants.of_run(run);
        match self.variants.name(variant).as_str() {
            "" => format!("run {}", own + 1),
            variant => format!("{variant}, run {}", own + 1),
        }
    }
}

/// Best, mean and worst of the scores that are there.
fn spread(scores: &[f64]) -> Json {
    let there = || scores.iter().copied().filter(|score| score.is_finite());
    let mean = there().sum::<f64>() / there().count() as f64;
    all_rounded([there().fold(f64::NAN, f64::max), mean, there().fold(f64::NAN, f64::min)])
}

impl Searched for Evolved {
    fn overview(&self) -> Json {
        let plan = self.variants.first();
        let gene = |gene: &crate::evolution::plan::GeneAxis| {
            json!({
                "name": gene.name, "about": gene.about, "unit": gene.unit,
                "low": gene.axis.low, "high": gene.axis.high, "reference": gene.axis.reference,
            })
        };
        let run = |(k, run): (usize, &Run)| {
            let (variant, _) = self.variants.of_run(k);
            let own = &self.variants.plans[variant];
            let generations: Vec<Json> =
                run.generations.iter().map(|one| spread(own.own(&one.evaluated.scores))).collect();
            json!({ "name": self.name(k), "spread": generations })
        };
        json!({
            "kind": "evolution",
            "title": plan.form.title,
            "about": plan.form.about,
            "shared": plan.shared.is_some(),
            "genes": plan.axes.iter().map(gene).collect::<Vec<_>>(),
            "runs": self.runs.iter().enumerate().map(run).collect::<Vec<_>>(),
        })
    }
    /// The candidates of a run: of each generation that is told its number and, candidate by candidate, score and genes.
    fn part(&self, at: &At) -> Result<Json, LiveError> {
        let (plan, _, run) = self.run(at)?;
        let numbers: usize = run.generations.iter().map(|one| one.candidates.len() * (plan.axes.len() + 1)).sum();
        let every = numbers.div_ceil(TOLD).max(1);
        let told = run.generations.iter().enumerate().step_by(every).map(|(number, one)| {
            let candidates = plan.own(&one.candidates).iter().zip(&one.evaluated.scores);
            let candidates =
                candidates.map(|(genes, &score)| all_rounded([score].into_iter().chain(genes.iter().copied())));
            json!({ "generation": number, "candidates": candidates.collect::<Vec<_>>() })
        });
        Ok(json!({ "generations": told.collect::<Vec<_>>() }))
    }
    fn watched(&self, at: &At) -> Result<Watched, LiveError> {
        let (plan, number, run) = self.run(at)?;
        let generation = at.below("generation", run.generations.len())?;
        let one = &run.generations[generation];
        let title = |of: String| format!("{}: run {number}, generation {generation}{of}", plan.form.title);
        if let Some(shared) = &plan.shared {
            let mut scenario = evaluate::owned(plan, shared, &one.candidates);
            scenario.title = title(String::new());
            let tree = Node { tree: scenario.write(), span: Span::default() };
            let name = format!("run-{number}-generation-{generation}.toml");
            let seed = Some(world_seed(plan.seed_of(number), generation as u64));
            return Ok(Watched::Scenario { name, text: toml(&tree), seed });
        }
        let best = || {
            let scored = one.evaluated.scores.iter().enumerate().filter(|(_, score)| score.is_finite());
            scored.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(candidate, _)| candidate)
        };
        let candidate = match at.perhaps("candidate") {
            Some(_) => at.below("candidate", one.candidates.len())?,
            None => best(),
        };
        let genes = one.candidates.get(candidate).ok_or_else(|| LiveError::Request("it has no candidates".into()))?;
        let mut tree = evaluate::condition(plan, genes).map_err(LiveError::Request)?.tree;
        let score = rounded(one.evaluated.scores.get(candidate).copied().unwrap_or(f64::NAN));
        let span = tree.span.clone();
        let title = title(format!(", candidate {candidate}, fitness {score}"));
        // the first of its worlds
        let seed = plan.seed_of(number).wrapping_add(1);
        for (key, value) in [("title", Tree::Text(title)), ("seed", Tree::Whole(seed as i64))] {
            tree.set(key, Node { tree: value, span: span.clone() }).map_err(LiveError::Request)?;
        }
        let name = format!("run-{number}-generation-{generation}-candidate-{candidate}.toml");
        Ok(Watched::Scenario { name, text: toml(&tree), seed: None })
    }
    fn page(&self, program: &str) -> Page {
        let asked = report::Asked::of(&self.variants, &self.runs, &self.contests);
        report::page(&self.variants, &self.runs, (&self.contests, &asked), program)
    }
    fn telling(&self) -> Vec<At> {
        // the last generation of the run that came furthest, and beside it the first
        let best = |run: &Run| {
            run.generations.last().map(|one| one.evaluated.scores.iter().copied().fold(f64::NEG_INFINITY, f64::max))
        };
        let scored = self.runs.iter().enumerate().filter_map(|(k, run)| Some((k, best(run)?)));
        let Some((run, _)) = scored.reduce(|best, other| if other.1 > best.1 { other } else { best }) else {
            return Vec::new();
        };
        let last = self.runs[run].generations.len() - 1;
        let mut chosen = vec![last, 0];
        chosen.dedup();
        chosen
            .into_iter()
            .map(|generation| At::new(&[("run", run as f64), ("generation", generation as f64)]))
            .collect()
    }
    fn words(&self) -> Vec<String> {
        ["run", "generation", "candidate"].map(str::to_owned).to_vec()
    }
}
