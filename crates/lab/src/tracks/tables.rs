//! The tables that an analysis leaves: tracks, metrics and events.

use super::analysis::{Analysed, OverTime};
use super::clean::Flag;
use crate::run::tables::AXES;
use crate::store::StoreError;
use crate::store::export::{csv_names, csv_rows};
use crate::store::table::{Blocks, Heading, Kind, Values};
use crate::with_tracks;
use bytes::Bytes;
use measure::{Field, Ground, Kind as Of, MetricCard, Tracks};
use std::collections::HashMap;
use std::io::Write;
use std::sync::Arc;

/// Rows of a block.
const BLOCK_ROWS: usize = 131_072;
/// Words that a column can have.
const MOST_WORDS: usize = 60_000;

/// Headings of the tracks, in the layout of a run's trajectory.
pub fn trajectory(all: &[Analysed]) -> Vec<Heading> {
    let (length, time) = (common(all, "length"), common(all, "time"));
    let (length, time) = (length.as_str(), time.as_str());
    let speed = format!("{length}/{time}");
    let dimensions = all.iter().map(|one| one.recording.understood.extent.len()).max().unwrap_or(2);
    let mut headings = vec![
        Heading::new("run", "1", "Number of the recording, from 0.", Kind::Whole),
        Heading::new("frame", "1", "Number of the frame, as in the recording.", Kind::Long),
        Heading::new("t", time, "Time of the frame.", Kind::Double),
        Heading::new("id", "1", "Number of the individual in its recording, from 0.", Kind::Whole),
        Heading::new("group", "", "Name of the recording.", Kind::Word),
    ];
    for axis in &AXES[..dimensions] {
        headings.push(Heading::new(axis, length, "Position.", Kind::Double));
    }
    for axis in &AXES[..dimensions] {
        headings.push(Heading::new(&format!("v{axis}"), &speed, "Velocity; none where it is not known.", Kind::Double));
    }
    if all.iter().any(|one| one.recording.understood.geographic) {
        headings.push(Heading::new("longitude", "deg", "Longitude; x and y are m about the middle.", Kind::Double));
        headings.push(Heading::new("latitude", "deg", "Latitude.", Kind::Double));
    }
    if all.iter().all(|one| one.recording.understood.individuals < MOST_WORDS) {
        headings.push(Heading::new("individual", "", "Name of the individual in the recording.", Kind::Word));
    }
    headings
}

/// The blocks of the tracks.
///
/// # Errors
/// Where there can be no such table.
pub fn trajectory_blocks<'a>(
    all: &'a [Analysed],
    headings: &'a [Heading],
) -> Result<impl Iterator<Item = Result<Bytes, StoreError>> + 'a, StoreError> {
    let mut blocks = Blocks::new(headings)?;
    let groups = Arc::new(all.iter().map(|one| one.recording.name.clone()).collect::<Vec<_>>());
    let parts = all.iter().enumerate().flat_map(|(run, one)| {
        let parts = with_tracks!(&one.recording.table, tracks => parts(tracks));
        parts.into_iter().map(move |part| (run, one, part))
    });
    Ok(parts.map(move |(run, one, part)| {
        let columns = with_tracks!(&one.recording.table, tracks => {
            columns(tracks, headings, run, part, &groups)
        });
        blocks.next(columns)
    }))
}

/// Ranges of frames whose rows make up a block.
fn parts<const D: usize>(tracks: &Tracks<D>) -> Vec<(usize, usize)> {
    let frames = tracks.frames().len();
    let (mut parts, mut from) = (Vec::new(), 0);
    while from < frames {
        let begin = tracks.rows(from).start;
        let more = |frame: &usize| tracks.rows(*frame).end - begin <= BLOCK_ROWS;
        let to = (from + 1..frames).take_while(more).last().map_or(from + 1, |last| last + 1);
        parts.push((from, to));
        from = to;
    }
    parts
}

fn columns<const D: usize>(
    tracks: &Tracks<D>,
    headings: &[Heading],
    run: usize,
    (from, to): (usize, usize),
    groups: &Arc<Vec<String>>,
) -> Vec<Values> {
    let rows = tracks.rows(from).start..tracks.rows(to - 1).end;
    let each = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
        (from..to).flat_map(|frame| core::iter::repeat_n(of(frame), tracks.rows(frame).len())).collect()
    };
    let globe = *tracks.ground() == Ground::Globe;
    let middle = if globe { middle(tracks) } else { [0.0; 2] };
    let planar = |row: usize| -> [f64; 2] {
        measure::ground::departure(middle, [tracks.positions(0)[row], tracks.positions(1)[row]]).0
    };
    let axis = |name: &str| AXES.iter().position(|axis| *axis == name);
    let column = |heading: &Heading| match heading.name.as_str() {
        "run" => Values::Whole(vec![run as i32; rows.len()]),
        "frame" => Values::Long(
            (from..to)
                .flat_map(|frame| core::iter::repeat_n(tracks.frames()[frame], tracks.rows(frame).len()))
                .collect(),
        ),
        "t" => Values::Double(each(&|frame| tracks.times()[frame])),
        "id" => Values::Whole(tracks.individuals()[rows.clone()].iter().map(|&id| id as i32).collect()),
        "group" => Values::Word(vec![run as u32; rows.len()], Arc::clone(groups)),
        "individual" => Values::Word(tracks.individuals()[rows.clone()].to_vec(), Arc::new(tracks.names().to_vec())),
        "longitude" | "latitude" => {
            let a = usize::from(heading.name == "latitude");
            Values::Double(if globe { tracks.positions(a)[rows.clone()].to_vec() } else { vec![f64::NAN; rows.len()] })
        }
        name => {
            let (position, a) = match (axis(name), name.strip_prefix('v').and_then(axis)) {
                (Some(a), _) => (true, a),
                (None, Some(a)) => (false, a),
                (None, None) => (true, D),
            };
            Values::Double(match (a < D, position) {
                (false, _) => vec![f64::NAN; rows.len()],
                (true, true) if globe => rows.clone().map(|row| planar(row)[a]).collect(),
                (true, true) => tracks.positions(a)[rows.clone()].to_vec(),
                (true, false) => tracks.velocities(a)[rows.clone()].to_vec(),
            })
        }
    };
    headings.iter().map(column).collect()
}

/// The middle of all places, in degrees.
pub(crate) fn middle<const D: usize>(tracks: &Tracks<D>) -> [f64; 2] {
    let mean = |a: usize| tracks.positions(a).iter().sum::<f64>() / tracks.len().max(1) as f64;
    [mean(0), mean(1)]
}

/// The corners of a box that holds the places as they are kept: on the globe, of what the extent in degrees spans.
pub(crate) fn box_of<const D: usize>(tracks: &Tracks<D>, extent: &[(f64, f64)]) -> (Vec<f64>, Vec<f64>) {
    if *tracks.ground() != Ground::Globe {
        return (extent.iter().map(|ends| ends.0).collect(), extent.iter().map(|ends| ends.1).collect());
    }
    let middle = middle(tracks);
    let corner = |east: bool, north: bool| {
        let pick = |ends: (f64, f64), high: bool| if high { ends.1 } else { ends.0 };
        measure::ground::departure(middle, [pick(extent[0], east), pick(extent[1], north)]).0
    };
    let corners = [corner(false, false), corner(true, false), corner(false, true), corner(true, true)];
    let ends = |a: usize, fold: fn(f64, f64) -> f64| corners.iter().map(|corner| corner[a]).reduce(fold).unwrap_or(0.0);
    ((0..2).map(|a| ends(a, f64::min)).collect(), (0..2).map(|a| ends(a, f64::max)).collect())
}

/// The metrics of all recordings, each once, in the order of the list.
pub fn cards(all: &[Analysed]) -> Vec<&'static MetricCard> {
    let measured = |card: &&'static MetricCard| all.iter().any(|one| one.cards.iter().any(|c| c.id == card.id));
    measure::metrics::LIST.iter().copied().filter(measured).collect()
}

/// Names of the counts of who entered a metric.
const COUNTS: [(&str, &str); 3] = [
    ("positions", "Individuals with a position."),
    ("velocities", "Individuals with a position and a velocity."),
    ("headings", "Individuals with a heading: a velocity that is not zero."),
];

/// Headings of the metrics.
pub fn metrics(all: &[Analysed]) -> Vec<Heading> {
    let mut headings = vec![
        Heading::new("run", "1", "Number of the recording, from 0.", Kind::Whole),
        Heading::new("frame", "1", "Number of the frame, as in the recording.", Kind::Long),
        Heading::new("t", &common(all, "time"), "Time of the frame.", Kind::Double),
        Heading::new("group", "", "Name of the recording.", Kind::Word),
    ];
    headings.extend(COUNTS.iter().map(|(name, about)| Heading::new(name, "1", about, Kind::Long)));
    for card in cards(all) {
        headings.push(Heading::new(card.id, &common(all, card.unit), card.definition, Kind::Double));
    }
    headings
}

/// The metrics of a recording, a row for each frame.
pub fn metric_columns(all: &[Analysed], run: usize) -> Vec<Values> {
    let one = &all[run];
    let (frames, times) = with_tracks!(&one.recording.table, tracks => (tracks.frames(), tracks.times()));
    let count = frames.len();
    let long = |counts: &[u32]| Values::Long(counts.iter().map(|&count| i64::from(count)).collect());
    let names = Arc::new(vec![one.recording.name.clone()]);
    let mut columns = vec![
        Values::Whole(vec![run as i32; count]),
        Values::Long(frames.to_vec()),
        Values::Double(times.to_vec()),
        Values::Word(vec![0; count], names),
        long(&one.measured.positions),
        long(&one.measured.velocities),
        long(&one.measured.headings),
    ];
    for card in cards(all) {
        let values = one.cards.iter().position(|own| own.id == card.id).map(|k| one.measured.values[k].clone());
        columns.push(Values::Double(values.unwrap_or_else(|| vec![f64::NAN; count])));
    }
    columns
}

/// Headings of the events.
pub fn events(all: &[Analysed]) -> Vec<Heading> {
    vec![
        Heading::new("run", "1", "Number of the recording, from 0.", Kind::Whole),
        Heading::new("frame", "1", "Number of the frame, as in the recording.", Kind::Long),
        Heading::new("t", &common(all, "time"), "Time of the frame.", Kind::Double),
        Heading::new("event", "", "What happened.", Kind::Word),
        Heading::new("id", "1", "Number of the individual concerned; -1 for none.", Kind::Long),
    ]
}

/// The events of a recording in the order of time: what was flagged, and what groups did.
pub fn event_columns(one: &Analysed, run: usize) -> Vec<Values> {
    let mut words: Vec<String> =
        [Flag::ImpossibleSpeed, Flag::IdentitySwap].map(|flag| flag.word().to_owned()).to_vec();
    let mut rows: Vec<(i64, f64, u32, i64)> = with_tracks!(&one.recording.table, tracks => {
        let row = |&(row, frame, flag): &(usize, usize, Flag)| {
            let word = u32::from(flag == Flag::IdentitySwap);
            (tracks.frames()[frame], tracks.times()[frame], word, i64::from(tracks.individuals()[row]))
        };
        one.cleaned.flags.iter().map(row).collect()
    });
    for (card, listing) in one.over_time.iter().filter(|(card, _)| card.id.ends_with("_events")) {
        let at = |name: &str| card.fields.iter().position(|field| field.name == name);
        let (Some(frame), Some(time)) = (at("frame"), at("t")) else { continue };
        let event = at("event");
        for row in 0..listing.len() {
            let label = event.map_or_else(
                || card.id.to_owned(),
                |event| label(one, &card.fields[event], listing.columns[event][row]),
            );
            let word = words.iter().position(|word| *word == label).unwrap_or_else(|| {
                words.push(label);
                words.len() - 1
            });
            rows.push((listing.columns[frame][row] as i64, listing.columns[time][row], word as u32, -1));
        }
    }
    rows.sort_by_key(|row| row.0);
    vec![
        Values::Whole(vec![run as i32; rows.len()]),
        Values::Long(rows.iter().map(|row| row.0).collect()),
        Values::Double(rows.iter().map(|row| row.1).collect()),
        Values::Word(rows.iter().map(|row| row.2).collect(), Arc::new(words)),
        Values::Long(rows.iter().map(|row| row.3).collect()),
    ]
}

/// What a number of a field stands for, in words; empty where it is a number.
pub fn label(one: &Analysed, field: &Field, value: f64) -> String {
    let place = value as usize;
    match field.kind {
        Of::Individual if value < 0.0 => "all".to_owned(),
        Of::Individual => {
            with_tracks!(&one.recording.table, tracks => tracks.names().get(place).cloned().unwrap_or_default())
        }
        Of::Group => {
            with_tracks!(&one.recording.table, tracks => tracks.group_names().get(place).cloned().unwrap_or_default())
        }
        Of::Label(words) => words.get(place).map_or_else(String::new, |&word| word.to_owned()),
        Of::Number | Of::Count | Of::Frame => String::new(),
    }
}

/// A unit of a metric or a field as a recording writes it: s where times are in s, `length^D` in its dimensions.
pub fn unit_of(one: &Analysed, unit: &str) -> String {
    let unit = &unit.replace("^D", &format!("^{}", one.recording.understood.extent.len()));
    let unit = match unit.strip_suffix('s') {
        Some(before) if before.is_empty() || before.ends_with('/') => format!("{before}time"),
        _ => unit.to_owned(),
    };
    one.units.of(&unit)
}

/// The unit that all recordings write; where they differ, the manifest says each one's.
fn common(all: &[Analysed], unit: &str) -> String {
    let first = unit_of(&all[0], unit);
    if all.iter().all(|one| unit_of(one, unit) == first) { first } else { "differs".to_owned() }
}

/// Name of the table of metrics over time.
pub const OVER_TIME: &str = "over_time.parquet";

/// Headings of the metrics over time: a row for each number.
pub fn over_time() -> Vec<Heading> {
    vec![
        Heading::new("run", "1", "Number of the recording, from 0.", Kind::Whole),
        Heading::new("group", "", "Name of the recording.", Kind::Word),
        Heading::new("metric", "", "The metric.", Kind::Word),
        Heading::new(
            "flagged",
            "",
            "Whether flagged positions are in it: `kept`, or `left_out` where any were flagged.",
            Kind::Word,
        ),
        Heading::new("row", "1", "Row of its table, from 0.", Kind::Long),
        Heading::new("field", "", "Column of its table.", Kind::Word),
        Heading::new("unit", "", "Unit of the column.", Kind::Word),
        Heading::new("value", "", "The number.", Kind::Double),
        Heading::new("label", "", "What the number stands for, of individuals, groups and events.", Kind::Word),
    ]
}

/// What was done with flagged positions.
pub const FLAGGED: [&str; 2] = ["kept", "left_out"];

/// The tables over time of a recording, each with its place in [`FLAGGED`].
pub fn over_time_of(one: &Analysed) -> impl Iterator<Item = (u32, &OverTime)> {
    one.over_time.iter().map(|over| (0, over)).chain(one.over_time_unflagged.iter().map(|over| (1, over)))
}

/// The metrics over time of a recording.
pub fn over_time_columns(one: &Analysed, run: usize) -> Vec<Values> {
    let mut lists: [Vec<String>; 4] = Default::default();
    let mut index: [HashMap<String, u32>; 4] = Default::default();
    let mut word = |list: usize, text: String| {
        *index[list].entry(text).or_insert_with_key(|text| {
            lists[list].push(text.clone());
            (lists[list].len() - 1) as u32
        })
    };
    let (mut metric, mut flagged, mut row, mut field, mut unit, mut value, mut named) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (place, (card, listing)) in over_time_of(one) {
        for r in 0..listing.len() {
            for (of, column) in card.fields.iter().zip(&listing.columns) {
                metric.push(word(0, card.id.to_owned()));
                flagged.push(place);
                row.push(r as i64);
                field.push(word(1, of.name.to_owned()));
                unit.push(word(2, unit_of(one, of.unit)));
                value.push(column[r]);
                named.push(word(3, label(one, of, column[r])));
            }
        }
    }
    let count = metric.len();
    let [metrics, fields, units, labels] = lists.map(Arc::new);
    vec![
        Values::Whole(vec![run as i32; count]),
        Values::Word(vec![0; count], Arc::new(vec![one.recording.name.clone()])),
        Values::Word(metric, metrics),
        Values::Word(flagged, Arc::new(FLAGGED.map(str::to_owned).to_vec())),
        Values::Long(row),
        Values::Word(field, fields),
        Values::Word(unit, units),
        Values::Double(value),
        Values::Word(named, labels),
    ]
}

/// Writes the metrics of all recordings as CSV: one line of names, a line for each frame of each.
///
/// # Errors
/// Where the system refuses to write.
pub fn write_csv(all: &[Analysed], out: &mut dyn Write) -> Result<(), StoreError> {
    csv_names(&metrics(all), out)?;
    (0..all.len()).try_for_each(|run| csv_rows(&metric_columns(all, run), out))
}
