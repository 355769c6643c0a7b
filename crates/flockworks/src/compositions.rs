//! What a composition of stock terms costs beside the compiled model of the same law.

use crate::bench::{BenchOptions, NEIGHBOURS, Precisions, fitting_side, median};
use crate::fault::{Fault, wrong};
use crate::step::Precision;
use crate::table::Table;
use crate::workloads::{Running, SEED};
use serde_json::{Value as Json, json};
use space::{Space, Vector};
use std::io::Write;
use std::time::Instant;
use swarm::engine::{GroupPlan, Placement};
use swarm::models::composed::Terms;
use swarm::models::{Catalogue, Models};
use swarm::parameters::{Parameter, Scalar, Value, Values};
use swarm::selection::Perception;
use swarm::{World, WorldPlan};

/// Shortest time over which anything is measured, in seconds.
const SHORTEST: f64 = 0.2;

/// The models whose laws are composed too.
pub const LAWS: [&str; 3] = ["vicsek_1995", "couzin_2002", "boids_rule_vectors"];

fn term(id: &str, given: &[(&str, Value)]) -> (String, Values) {
    (id.to_owned(), given.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect())
}

/// The law of a model, with its defaults, as a composition: parameters and named sets.
fn composed<R: Scalar, const D: usize>(law: &str) -> (Values, Vec<(String, Perception<R, D>)>) {
    let (sum, constant, after) =
        (("take", "sum".into()), ("by_distance", "constant".into()), ("priority", 1usize.into()));
    let mut sets = Vec::new();
    let (terms, others): (Vec<_>, Vec<(&str, Value)>) = match law {
        "vicsek_1995" => (
            vec![term("keep_heading", &[]), term("align", &[sum])],
            vec![
                ("radius", 1.0.into()),
                ("speed", 0.03.into()),
                ("motion", "direction".into()),
                ("time_step", 1.0.into()),
                ("position_update", "old_velocity".into()),
            ],
        ),
        "couzin_2002" => {
            let view = || Perception::angle(R::of(270f64.to_radians()));
            let ring = |low: f64, high: f64| Perception::distance(R::of(low), R::of(high));
            sets = vec![
                ("repulsion".to_owned(), ring(0.0, 1.0)),
                ("orientation".to_owned(), ring(1.0, 6.0).both(view())),
                ("attraction".to_owned(), ring(6.0, 14.0).both(view())),
            ];
            let set = |name: &str| ("set", Value::from(name));
            (
                vec![
                    term("repel", &[set("repulsion"), constant.clone(), sum.clone()]),
                    term("align", &[set("orientation"), sum.clone(), after.clone()]),
                    term("attract", &[set("attraction"), constant, sum, after]),
                ],
                vec![
                    ("combine", "first".into()),
                    ("motion", "direction".into()),
                    ("speed", 3.0.into()),
                    ("turning_rate", 40f64.to_radians().into()),
                ],
            )
        }
        // the default composition is this law
        _ => return (Values::new(), sets),
    };
    let mut values: Values = others.into_iter().map(|(name, value)| (name.to_owned(), value)).collect();
    values.insert("terms".to_owned(), Terms(terms).write());
    (values, sets)
}

/// A world of the model, or of the composition of its law.
fn world<R: Scalar>(law: &str, as_composition: bool, agents: usize, side: f64) -> Result<Box<dyn Running>, Fault>
where
    Models: Catalogue<R, 2>,
{
    let placement = Placement::Uniform { low: Vector::ZERO, high: Vector([R::of(side); 2]) };
    let (values, sets) = if as_composition { composed::<R, 2>(law) } else { Default::default() };
    let model = if as_composition { "composed" } else { law };
    let mut group = GroupPlan::new("members", model, values, agents, placement);
    group.sets = sets;
    let mut plan = WorldPlan::new(Space::open(), group);
    plan.seed = SEED;
    match World::new(plan) {
        Ok(world) => Ok(Box::new(world)),
        Err(error) => wrong(error.to_string()),
    }
}

fn of_precision(
    precision: Precision,
    law: &str,
    as_composition: bool,
    agents: usize,
    side: f64,
) -> Result<Box<dyn Running>, Fault> {
    match precision {
        Precision::F32 => world::<f32>(law, as_composition, agents, side),
        Precision::F64 => world::<f64>(law, as_composition, agents, side),
    }
}

/// Largest difference of any component.
fn apart(a: &dyn Running, b: &dyn Running) -> f64 {
    let (a, b) = (a.motion(), b.motion());
    let of =
        |motion: (Vec<Vec<f64>>, Vec<Vec<f64>>)| motion.0.into_iter().chain(motion.1).flatten().collect::<Vec<_>>();
    of(a).iter().zip(of(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Measures each law both ways, turn by turn, and prints what an update costs.
///
/// # Errors
/// A reader that went away.
pub fn bench(options: &BenchOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let sizes: Vec<usize> = if options.agents.is_empty() {
        vec![200, 10_000]
    } else {
        options.agents.iter().map(|&n| n as usize).collect()
    };
    let precisions = match options.precision {
        Some(Precisions::F32) => vec![Precision::F32],
        Some(Precisions::F64) => vec![Precision::F64],
        None | Some(Precisions::Both) => vec![Precision::F32, Precision::F64],
    };
    let mut table = Table::new(&[
        "law",
        "agents",
        "precision",
        "mean neighbours",
        "compiled, ns per update",
        "composed, ns per update",
        "times the cost",
        "apart",
    ]);
    table.right(&[1, 3, 4, 5, 6, 7]);
    let mut list = Vec::new();
    for law in LAWS {
        for &agents in &sizes {
            for &precision in &precisions {
                let build = |side: f64| of_precision(precision, law, false, agents, side);
                let side = fitting_side(agents, 2, &build)?;
                let steps = options.steps.unwrap_or(20);
                let neighbours = build(side)?.mean_neighbours((agents / 200).max(1));
                let (mut walls, mut difference) = ([Vec::new(), Vec::new()], 0.0);
                for _ in 0..options.repeats {
                    let mut spent = [0.0; 2];
                    let mut runs = 0;
                    while spent[0] < SHORTEST {
                        let mut worlds = [build(side)?, of_precision(precision, law, true, agents, side)?];
                        for (world, spent) in worlds.iter_mut().zip(&mut spent) {
                            world.run(1);
                            let begin = Instant::now();
                            world.run(steps);
                            *spent += begin.elapsed().as_secs_f64();
                        }
                        difference = apart(&*worlds[0], &*worlds[1]);
                        runs += 1;
                    }
                    for (walls, spent) in walls.iter_mut().zip(spent) {
                        walls.push(1e9 * spent / (f64::from(runs) * steps as f64 * agents as f64));
                    }
                }
                let [compiled, composed] = walls.map(|walls| median(&walls));
                table.row(vec![
                    law.into(),
                    agents.to_string(),
                    precision.word().into(),
                    format!("{neighbours:.1}"),
                    format!("{compiled:.1}"),
                    format!("{composed:.1}"),
                    format!("{:.2}", composed / compiled),
                    format!("{difference:.1e}"),
                ]);
                list.push(json!({
                    "law": law, "agents": agents, "precision": precision.word(), "steps": steps,
                    "mean_neighbours": neighbours, "compiled_ns_per_update": compiled,
                    "composed_ns_per_update": composed, "apart": difference,
                }));
            }
        }
    }
    if options.json {
        writeln!(out, "{:#}", Json::from(list))?;
    } else {
        out.write_all(table.text().as_bytes())?;
        writeln!(
            out,
            "{NEIGHBOURS} neighbours are aimed at; compositions are the compiled laws to the bit where apart is 0."
        )?;
    }
    Ok(())
}
