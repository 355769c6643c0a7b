//! Questions about metrics.

use crate::Question;
use crate::asked::{Answer, Asked};
use measure::{Sample, metrics};
use serde_json::json;
use space::{Space, Vector};

pub(crate) const QUESTIONS: &[Question] = &[("metric", |asked| match asked.lists("positions")?.first() {
    Some(first) if first.len() == 1 => metric::<1>(asked),
    Some(first) if first.len() == 3 => metric::<3>(asked),
    _ => metric::<2>(asked),
})];

/// Any listed metric of one moment: `id`, `positions` and `velocities` as `[agents, D]`, and `parameters` by name. The
/// space is open, or a periodic box of the edges `period`, `[D]`.
fn metric<const D: usize>(asked: Asked<'_>) -> Answer {
    let vector =
        |numbers: &Vec<f64>| Vector::<f64, D>(core::array::from_fn(|axis| numbers.get(axis).copied().unwrap_or(0.0)));
    let (positions, velocities) = (asked.lists("positions")?, asked.lists("velocities")?);
    let members = positions.iter().zip(&velocities).map(|(position, velocity)| (vector(position), vector(velocity)));
    let space = match asked.maybe("period") {
        Some(_) => Space::periodic(vector(&asked.numbers("period")?).0),
        None => Space::open(),
    };
    let mut metric = metrics::find::<D>(asked.text("id")?).map_err(|error| error.to_string())?;
    if let Some(parameters) = asked.maybe("parameters").and_then(|parameters| parameters.as_object()) {
        for (name, value) in parameters {
            metric.set(name, value.as_f64().unwrap_or(f64::NAN)).map_err(|error| error.to_string())?;
        }
    }
    Ok(json!(metric.on(&Sample::new(space, members))))
}
