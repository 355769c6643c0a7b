//! The best environments as files: SVG to look at, GeoJSON to exchange, a scenario to run and to view.

use super::plan::Plan;
use super::results::{Results, Share};
use crate::environment::doors::Door;
use crate::environment::trial::{self, Population};
use crate::scenario::Obstacle;
use crate::store::StoreError;
use crate::store::folder::{Folder, whole_file};
use std::io::Write;
use terrain::text::{geojson, svg};
use terrain::{Construct, Environment};

/// The folder of exported environments, inside that of the design.
pub const ENVIRONMENTS: &str = "environments";

/// The attempts with most successes for a group and a behaviour, the best first; of equals the earliest.
pub fn best(results: &Results<'_>, population: usize, behaviour: usize, count: usize) -> Vec<(u64, Share)> {
    let shares = results.shares(population, behaviour, None);
    let mut ranked: Vec<(u64, Share)> = results.tried.iter().copied().zip(shares).collect();
    ranked.retain(|(_, share)| share.trials > 0);
    ranked.sort_by(|a, b| b.1.rate().total_cmp(&a.1.rate()).then(a.0.cmp(&b.0)));
    ranked.truncate(count);
    ranked
}

/// The environment of a construct.
pub fn environment(plan: &Plan, construct: &Construct) -> Environment {
    Environment { workspace: plan.workspace.workspace.clone(), construct: construct.clone(), schedule: None }
}

/// The scenario of a trial: run with its seed it is that trial, bit by bit. Doors open and shut in it at the times at which they
/// did in the trial, which is made once more.
pub fn scenario(plan: &Plan, population: &Population, construct: &Construct, seed: u64, title: &str) -> String {
    let geometry = || plan.workspace.workspace.geometry.iter().chain(construct.geometry());
    trial::file(population, geometry(), doors(plan, population, construct, seed), seed, title)
}

/// The doors of a trial as obstacles that come and go; nothing where there are none.
fn doors(plan: &Plan, population: &Population, construct: &Construct, seed: u64) -> Vec<Obstacle> {
    let wanted = plan.behaviours(population, construct, true).unwrap_or_default();
    if wanted.doors.is_empty() {
        return Vec::new();
    }
    let scenario = population.among(plan.workspace.workspace.geometry.iter().chain(construct.geometry()));
    let told = trial::relayed(&scenario, population, &wanted, seed, &|| false, &mut |_| ());
    let moved = told.ok().flatten().map_or_else(Vec::new, |told| told.moved);
    let of = |(k, door): (usize, &Door)| door.written(moved.iter().copied().filter(|moved| moved.door == k));
    wanted.doors.iter().enumerate().flat_map(of).collect()
}

/// Writes an environment as SVG, GeoJSON, and the scenario of a trial in it.
///
/// # Errors
/// Where the system refuses.
pub fn environment_files(
    folder: &Folder,
    stem: &str,
    environment: &Environment,
    trial: &str,
) -> Result<(), StoreError> {
    let below = folder.file(ENVIRONMENTS);
    std::fs::create_dir_all(&below).map_err(|error| StoreError::io("make the folder", &below, error))?;
    for (ending, text) in
        [("svg", svg::write(environment)), ("geojson", geojson::write(environment)), ("toml", trial.to_owned())]
    {
        let path = below.join(format!("{stem}.{ending}"));
        whole_file(&path, |out| out.write_all(text.as_bytes()).map_err(|error| StoreError::io("write", &path, error)))?;
    }
    Ok(())
}

/// Writes the best environments of each group and behaviour.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>) -> Result<(), StoreError> {
    let plan = results.plan;
    if plan.form.export == 0 {
        return Ok(());
    }
    for (behaviour, name) in plan.behaviour_names().into_iter().enumerate() {
        for (group, population) in plan.populations.iter().enumerate() {
            for (attempt, share) in best(results, group, behaviour, plan.form.export) {
                let Some((_, construct)) = results.survey.feasible.iter().find(|(own, _)| *own == attempt) else {
                    continue;
                };
                let stem = format!("{name}-{}-{attempt}", population.name);
                let success = |trial: &usize| {
                    let trials = results.trials.get(&attempt).and_then(|all| all.get(group));
                    let outcome =
                        trials.and_then(|trials| trials.built.get(trial - 1)?.outcomes.get(behaviour).copied());
                    outcome.is_some_and(|outcome| outcome.fitness >= plan.form.success)
                };
                let trial = (1..=plan.form.trials).find(success).unwrap_or(1);
                let title = format!(
                    "{name}, {}: candidate {attempt}, {} of {}",
                    population.name, share.successes, share.trials
                );
                let seed = plan.seed_of(attempt, trial);
                let trial = scenario(plan, population, construct, seed, &title);
                environment_files(folder, &stem, &environment(plan, construct), &trial)?;
            }
        }
    }
    Ok(())
}
