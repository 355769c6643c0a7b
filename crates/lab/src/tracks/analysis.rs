//! Metrics of recordings, frame by frame, with what their averages are.

use super::clean::{self, Cleaned, Cleaning};
use super::file::TracksFile;
use super::{Recording, Table, wrong};
use crate::scenario::Units;
use crate::store::StoreError;
use crate::with_tracks;
use measure::{Listing, Measure, MetricCard, Parameter, PerFrame, TrackCard, Tracks, over_time, per_frame};
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
    /// Metrics over time, each with its table.
    pub over_time: Vec<OverTime>,
    /// The same without what was flagged; empty where nothing was.
    pub over_time_unflagged: Vec<OverTime>,
    /// Why a metric over time has no table, though nothing was wrong with what was asked.
    pub undefined: Vec<String>,
    /// Metrics that were not measured since nobody gave their parameters, with the names of these.
    pub left_out: Vec<(&'static str, Vec<&'static str>)>,
}

/// A metric over time with its table.
pub type OverTime = (&'static TrackCard, Listing);

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
    let (cards, measured, unflagged, left_out, over) = with_tracks!(&table, tracks => {
        let (metrics, mut left_out) = chosen(tracks, file)?;
        let over = measured_over_time(tracks, file, &mut left_out)?;
        let measured = per_frame(tracks, &metrics, workers);
        let unflagged = if cleaned.flags.is_empty() {
            None
        } else {
            let rest = clean::without_flagged(tracks, &cleaned).map_err(failed)?;
            let (over, _) = measured_over_time(&rest, file, &mut Vec::new())?;
            Some((per_frame(&rest, &metrics, workers), over))
        };
        (metrics.iter().map(|metric| metric.card()).collect(), measured, unflagged, left_out, over)
    });
    let (over_time, undefined) = over;
    let (unflagged, over_time_unflagged) =
        unflagged.map_or_else(Default::default, |(measured, over)| (Some(measured), over));
    let recording = Recording { name, path, table, understood };
    Ok(Analysed {
        recording,
        cleaned,
        units,
        cards,
        measured,
        unflagged,
        over_time,
        over_time_unflagged,
        undefined,
        left_out,
    })
}

fn cleaned_of<const D: usize>(
    tracks: Tracks<D>,
    asked: &Cleaning,
) -> Result<(Tracks<D>, Cleaned), measure::TracksError> {
    if *asked == Cleaning::default() { Ok((tracks, Cleaned::default())) } else { clean::clean(tracks, asked) }
}

/// Metrics that want a parameter, with its name.
type LeftOut = Vec<(&'static str, Vec<&'static str>)>;

/// Ids of all metrics, of frames and over time, with their parameters.
pub fn known() -> impl Iterator<Item = (&'static str, &'static [Parameter])> {
    let frames = measure::metrics::LIST.iter().map(|card| (card.id, card.parameters));
    frames.chain(over_time::LIST.iter().map(|card| (card.id, card.parameters)))
}

/// The parameters that the user has to give: those without a default, and those with a default that is a length, a time or
/// a speed, which fits no recording in particular. Not those that are without limits where none is given.
fn open(parameters: &'static [Parameter], file: &TracksFile) -> Vec<&'static str> {
    let given = |name: &str| file.measure.parameters.0.iter().any(|(other, _)| other == name);
    let plain = |unit: &str| matches!(unit, "" | "1" | "deg" | "rad" | "frames");
    let wanting = |p: &&Parameter| !given(p.name) && p.default.is_none_or(|value| value.is_finite() && !plain(p.unit));
    parameters.iter().filter(wanting).map(|p| p.name).collect()
}

/// The metrics of frames that are measured, and those left out for want of a parameter.
fn chosen<const D: usize>(_: &Tracks<D>, file: &TracksFile) -> Result<(Vec<Box<dyn Measure<D>>>, LeftOut), StoreError> {
    let (mut metrics, mut left_out) = (Vec::new(), Vec::new());
    for mut metric in measure::metrics::all::<D>() {
        let card = metric.card();
        if !card.dimensions.contains(&D) {
            check_dimensions::<D>(card.id, file)?;
            continue;
        }
        if wanted(card.id, card.parameters, file, &mut left_out) {
            set(file, card.parameters, |name, value| metric.set(name, value))?;
            metrics.push(metric);
        }
    }
    Ok((metrics, left_out))
}

/// Whether a metric is to be measured; one that wants a parameter and was not asked for is noted.
fn wanted(id: &'static str, parameters: &'static [Parameter], file: &TracksFile, left_out: &mut LeftOut) -> bool {
    match &file.measure.metrics {
        Some(asked) => asked.iter().any(|other| other == id),
        None => {
            let open = open(parameters, file);
            let whole = open.is_empty();
            if !whole {
                left_out.push((id, open));
            }
            whole
        }
    }
}

fn check_dimensions<const D: usize>(id: &str, file: &TracksFile) -> Result<(), StoreError> {
    if file.measure.metrics.iter().flatten().any(|asked| asked == id) {
        return Err(StoreError::Refused(format!("`{id}` is not defined in {D} dimensions")));
    }
    Ok(())
}

/// Sets the parameters that a metric has and the user gave.
fn set(
    file: &TracksFile,
    known: &[Parameter],
    mut set: impl FnMut(&str, f64) -> Result<(), measure::MeasureError>,
) -> Result<(), StoreError> {
    let own = file.measure.parameters.0.iter().filter(|(name, _)| known.iter().any(|p| p.name == name));
    for (name, value) in own {
        set(name, *value).map_err(|error| StoreError::Refused(error.to_string()))?;
    }
    Ok(())
}

/// Positions beyond which metrics over time are measured on request only.
const OVER_TIME: usize = 1_000_000;

/// Metrics over time. Where no longest lag was given it is a quarter of the recording.
fn measured_over_time<const D: usize>(
    tracks: &Tracks<D>,
    file: &TracksFile,
    left_out: &mut LeftOut,
) -> Result<(Vec<OverTime>, Vec<String>), StoreError> {
    let (mut listings, mut undefined) = (Vec::new(), Vec::new());
    let asked = file.measure.metrics.is_some();
    if !asked && tracks.len() > OVER_TIME {
        undefined
            .push(format!("metrics over time are measured on request where there are more than {OVER_TIME} positions"));
        return Ok((listings, undefined));
    }
    let quarter = tracks.interval().map(|interval| (tracks.frames().len() as f64 / 4.0).floor().max(1.0) * interval);
    for mut metric in over_time::all::<D>() {
        let card = metric.card();
        if !card.dimensions.contains(&D) {
            check_dimensions::<D>(card.id, file)?;
            continue;
        }
        let lag = card.parameters.iter().any(|p| p.name == "lags") && open(card.parameters, file) == ["max_lag"];
        let mut noted = Vec::new();
        let wanted = wanted(card.id, card.parameters, file, &mut noted) || (lag && !asked);
        if !wanted {
            left_out.extend(noted);
            continue;
        }
        set(file, card.parameters, |name, value| metric.set(name, value))?;
        if let Some(quarter) = quarter.filter(|_| lag) {
            metric.set("max_lag", quarter).map_err(|error| StoreError::Refused(error.to_string()))?;
        }
        match metric.on(tracks) {
            Ok(listing) => listings.push((card, listing)),
            Err(error) if asked => return Err(StoreError::Refused(error.to_string())),
            Err(error) => undefined.push(error.to_string()),
        }
    }
    Ok((listings, undefined))
}
