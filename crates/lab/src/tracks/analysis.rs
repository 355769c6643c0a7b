//! Metrics of recordings, frame by frame, with what their averages are.

use super::clean::{self, Cleaned, Cleaning};
use super::file::TracksFile;
use super::{Recording, Table, wrong};
use crate::scenario::Units;
use crate::store::StoreError;
use crate::with_tracks;
use measure::{Measure, MetricCard, PerFrame, Tracks, per_frame};
use space::parallel::Workers;
use std::sync::Arc;

/// What was measured of a recording.
pub struct Analysed {
    /// The recording, as cleaned.
    pub recording: Recording,
    /// What cleaning did.
    pub cleaned: Cleaned,
    /// Units of length and time.
    pub units: Units,
    /// The metrics, in the order of their values.
    pub cards: Vec<&'static MetricCard>,
    /// Their values, frame by frame.
    pub measured: PerFrame,
    /// The same without what was flagged, where something was.
    pub unflagged: Option<PerFrame>,
    /// Metrics that were not measured since nobody gave their parameters, with the names of these.
    pub left_out: Vec<(&'static str, Vec<&'static str>)>,
}

/// An average over the frames in which a metric is defined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Average {
    /// Mean.
    pub mean: f64,
    /// Standard deviation, with n - 1; not a number for fewer than two frames.
    pub sd: f64,
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub greatest: f64,
    /// Number of frames in which it is defined.
    pub frames: usize,
}

/// The average of values; not-a-numbers are not there. `None` where none is.
pub fn average(values: &[f64]) -> Option<Average> {
    let there = || values.iter().copied().filter(|value| value.is_finite());
    let frames = there().count();
    let mean = there().sum::<f64>() / frames as f64;
    let squares: f64 = there().map(|value| (value - mean) * (value - mean)).sum();
    let ends = there().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    let sd = if frames > 1 { (squares / (frames as f64 - 1.0)).sqrt() } else { f64::NAN };
    (frames > 0).then_some(Average { mean, sd, least: ends.0, greatest: ends.1, frames })
}

/// Cleans and measures a recording.
///
/// # Errors
/// A metric or a parameter that does not fit, or a fault in cleaning.
pub fn analyse(recording: Recording, file: &TracksFile, workers: &Arc<Workers>) -> Result<Analysed, StoreError> {
    let Recording { name, path, table, understood } = recording;
    let units = Units { length: understood.unit.clone(), time: understood.time_unit.clone() };
    let asked = file.clean.ask();
    let failed = |error: measure::TracksError| wrong(&path, &error.to_string());
    let (table, cleaned) = match table {
        Table::Plane(tracks) => cleaned_of(tracks, &asked).map(|(t, done)| (Table::Plane(t), done)),
        Table::Space(tracks) => cleaned_of(tracks, &asked).map(|(t, done)| (Table::Space(t), done)),
    }
    .map_err(failed)?;
    let (cards, measured, unflagged, left_out) = with_tracks!(&table, tracks => {
        let (metrics, left_out) = chosen(tracks, file)?;
        let measured = per_frame(tracks, &metrics, workers);
        let unflagged = if cleaned.flags.is_empty() {
            None
        } else {
            let rest = clean::without_flagged(tracks, &cleaned).map_err(failed)?;
            Some(per_frame(&rest, &metrics, workers))
        };
        (metrics.iter().map(|metric| metric.card()).collect(), measured, unflagged, left_out)
    });
    let recording = Recording { name, path, table, understood };
    Ok(Analysed { recording, cleaned, units, cards, measured, unflagged, left_out })
}

fn cleaned_of<const D: usize>(
    tracks: Tracks<D>,
    asked: &Cleaning,
) -> Result<(Tracks<D>, Cleaned), measure::TracksError> {
    if *asked == Cleaning::default() { Ok((tracks, Cleaned::default())) } else { clean::clean(tracks, asked) }
}

/// The metrics that are measured, and those left out for want of a parameter.
fn chosen<const D: usize>(
    _: &Tracks<D>,
    file: &TracksFile,
) -> Result<(Vec<Box<dyn Measure<D>>>, Vec<(&'static str, Vec<&'static str>)>), StoreError> {
    let parameters = &file.measure.parameters.0;
    let given = |name: &str| parameters.iter().any(|(other, _)| other == name);
    let (mut ids, mut left_out) = (Vec::new(), Vec::new());
    for card in measure::metrics::LIST {
        if !card.dimensions.contains(&D) {
            continue;
        }
        let open: Vec<&'static str> = card.parameters.iter().map(|p| p.name).filter(|name| !given(name)).collect();
        match &file.measure.metrics {
            Some(asked) if asked.iter().any(|id| id == card.id) => ids.push(card.id),
            Some(_) => {}
            None if open.is_empty() => ids.push(card.id),
            None => left_out.push((card.id, open)),
        }
    }
    let refused = |text: String| StoreError::Refused(text);
    for id in file.measure.metrics.iter().flatten() {
        if !ids.contains(&id.as_str()) {
            return Err(refused(format!("`{id}` is not defined in {D} dimensions")));
        }
    }
    let mut metrics = Vec::new();
    for id in ids {
        let mut metric = measure::metrics::find::<D>(id).map_err(|error| refused(error.to_string()))?;
        for (name, value) in parameters {
            if metric.card().parameters.iter().any(|parameter| parameter.name == name) {
                metric.set(name, *value).map_err(|error| refused(error.to_string()))?;
            }
        }
        metrics.push(metric);
    }
    Ok((metrics, left_out))
}
