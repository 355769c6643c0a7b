//! The page of an analysis of tracks.

use super::map;
use super::of_run::{DOWNLOADED, DRAWN, REPLAYED, REPLAYED_FRAMES, ordinal, paragraphs, short};
use super::{
    Axis, Border, Fact, Figure, Line, Lines, Map, MapCell, MapPanel, Moment, Page, Replay, Scenes, Seen, Stage,
    Table as Download,
};
use crate::tracks::analysis::{Analysed, Average, average};
use crate::tracks::folder::Request;
use crate::tracks::tables;
use crate::with_tracks;
use measure::{Counted, Ground, Listing, MetricCard, TrackCard, Tracks};
use space::{Edge, Vector};
use std::collections::BTreeMap;

/// Points of a line over time; more frames are averaged.
const POINTS: usize = 1200;
/// Bins of a distribution.
const BINS: usize = 40;
/// Points of an individual's path in a picture.
const PATH: usize = 250;
/// Points of all paths in a picture.
const PATHS: usize = 40_000;

/// The page of an analysis.
pub fn page(request: &Request<'_>, all: &[Analysed]) -> Page {
    let mut figures = Vec::new();
    for one in all {
        with_tracks!(&one.recording.table, tracks => {
            let seen = Seen3::of(tracks);
            figures.extend(seen.replay(one, all.len()));
            figures.extend(seen.scenes(one));
        });
    }
    for (card, one_unit) in charts(all) {
        figures.push(over_time(card, &one_unit));
        figures.extend(distribution(card, &one_unit));
    }
    figures.extend(over_time_charts(all));
    figures.extend(cell_maps(all));
    let mut csv = Vec::new();
    let values: usize = all.iter().map(|one| one.measured.positions.len() * (one.cards.len() + 7)).sum();
    let mut downloads = vec![Download {
        file: "summary.csv".into(),
        about: "The average of every metric over frames, with and without what was flagged.".into(),
        csv: summary_csv(all),
    }];
    if all.iter().any(|one| !one.cleaned.flags.is_empty()) {
        downloads.push(Download {
            file: "flags.csv".into(),
            about: "The positions that are flagged, and why.".into(),
            csv: flags_csv(all),
        });
    }
    // writing to memory cannot fail; where it did, the table is left out
    if values as u64 * 10 <= DOWNLOADED && tables::write_csv(all, &mut csv).is_ok() {
        downloads.push(Download {
            file: "metrics.csv".into(),
            about: "Every metric in every frame, with the number of individuals that entered.".into(),
            csv: String::from_utf8(csv).unwrap_or_default(),
        });
    }
    downloads.extend(over_time_tables(all));
    Page {
        title: request.file.title.clone(),
        lead: paragraphs(&request.file.about),
        methods: all.iter().flat_map(|one| methods(one, all.len() > 1)).collect(),
        summary: all.iter().flat_map(|one| facts(one, all.len() > 1)).collect(),
        figures,
        tables: downloads,
        command: request.command.clone(),
        source: request.text.1.clone(),
        made_by: request.program.clone(),
    }
}

/// An average written out, with its unit.
pub fn written(average: &Average, unit: &str) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    if average.frames > 1 {
        return format!("{} \u{b1} {}{unit}", short(average.mean), short(average.sd));
    }
    format!("{}{unit}", short(average.mean))
}

/// The average of a metric, and without what was flagged where that differs.
pub fn averages(one: &Analysed, metric: usize) -> (Option<Average>, Option<Average>) {
    let all = average(&one.measured.values[metric]);
    let rest = one.unflagged.as_ref().and_then(|rest| average(&rest.values[metric]));
    (all, rest.filter(|rest| Some(*rest) != all))
}

/// The unit of time behind a number of them.
fn time_word(understood: &crate::tracks::Understood) -> &str {
    if understood.time_unit == "frame" { "frames" } else { &understood.time_unit }
}

fn facts(one: &Analysed, several: bool) -> Vec<Fact> {
    let of = if several { format!(", {}", one.recording.name) } else { String::new() };
    let fact = |label: &str, value: String| Fact { label: format!("{label}{of}"), value };
    let understood = &one.recording.understood;
    let mut facts = vec![
        fact("Individuals", understood.individuals.to_string()),
        fact("Frames", format!("{} in {} {}", understood.frames, short(understood.duration), time_word(understood))),
        fact("Positions", format!("{}, {} % missing", understood.positions, short(100.0 * understood.missing))),
    ];
    if !one.cleaned.flags.is_empty() {
        facts.push(fact("Flagged positions", one.cleaned.flags.len().to_string()));
    }
    for (k, card) in one.cards.iter().enumerate() {
        let unit = tables::unit_of(one, card.unit);
        let (all, rest) = averages(one, k);
        let Some(all) = all else { continue };
        let rest = rest.map_or_else(String::new, |rest| format!("; without flagged {}", written(&rest, &unit)));
        facts.push(fact(card.title, format!("{}{rest}", written(&all, &unit))));
    }
    facts
}

/// What was read and done, in sentences.
fn methods(one: &Analysed, several: bool) -> Vec<String> {
    let (understood, cleaned) = (&one.recording.understood, &one.cleaned);
    let lines: Vec<String> = understood.lines().into_iter().map(|(what, text)| format!("{what}: {text}")).collect();
    let whose = if several { format!("Recording {}: ", one.recording.name) } else { "Read: ".to_owned() };
    let mut paragraphs = vec![format!("{whose}{}.", lines.join("; "))];
    let mut done = Vec::new();
    if cleaned.asked.interpolate.is_some() {
        done.push(format!(
            "{} gaps were filled by straight lines ({} positions), {} were too long",
            cleaned.filled.1, cleaned.filled.0, cleaned.left
        ));
    }
    if cleaned.asked.smooth.is_some() {
        done.push(format!(
            "{} positions were smoothed by a Savitzky-Golay filter; {} lie in stretches shorter than its window",
            cleaned.smoothed.0, cleaned.smoothed.1
        ));
    }
    for (flag, count) in cleaned.flag_counts() {
        done.push(format!("{count} positions are flagged as {}", flag.word().replace('_', " ")));
    }
    if done.is_empty() {
        done.push("nothing was cleaned".to_owned());
    }
    paragraphs.push(format!("Cleaning: {}.", done.join("; ")));
    let velocities = "Velocities are backward differences of positions, known where an individual was found in both \
                      frames; averages are over the frames in which a metric is defined, with their standard deviation.";
    paragraphs.push(velocities.to_owned());
    let never = |k: &usize| one.measured.values[*k].iter().all(|value| !value.is_finite());
    let never: Vec<&str> = (0..one.cards.len()).filter(never).map(|k| one.cards[k].id).collect();
    if !never.is_empty() {
        paragraphs.push(format!("Undefined in every frame: {}.", never.join(", ")));
    }
    paragraphs.extend(one.undefined.iter().map(|what| format!("Not measured: {what}.")));
    if !one.left_out.is_empty() {
        let named = |(id, open): &(&str, Vec<&str>)| format!("{id} ({})", open.join(", "));
        let list: Vec<String> = one.left_out.iter().map(named).collect();
        paragraphs.push(format!("Not measured, for want of a parameter: {}.", list.join(", ")));
    }
    paragraphs
}

/// The charts: each metric with the recordings that share its unit.
fn charts(all: &[Analysed]) -> Vec<(&'static MetricCard, Vec<(&Analysed, usize)>)> {
    let mut charts = Vec::new();
    for card in tables::cards(all) {
        let mut by_unit: Vec<((String, &str), Vec<(&Analysed, usize)>)> = Vec::new();
        for one in all {
            let Some(k) = one.cards.iter().position(|own| own.id == card.id) else { continue };
            if one.measured.values[k].iter().all(|value| !value.is_finite()) {
                continue;
            }
            let key = (tables::unit_of(one, card.unit), one.units.time.as_str());
            match by_unit.iter_mut().find(|(known, _)| *known == key) {
                Some((_, list)) => list.push((one, k)),
                None => by_unit.push((key, vec![(one, k)])),
            }
        }
        charts.extend(by_unit.into_iter().map(|(_, list)| (card, list)));
    }
    charts
}

/// Name of a chart's file: with the unit where recordings differ in it.
fn chart_id(card: &MetricCard, of: &[(&Analysed, usize)], what: &str) -> String {
    format!("{}{what}_{}", card.id, of[0].0.units.length)
}

fn over_time(card: &MetricCard, of: &[(&Analysed, usize)]) -> Figure {
    let units = &of[0].0.units;
    let mut abouts = vec![card.definition.split_whitespace().collect::<Vec<_>>().join(" ")];
    let mut lines = Vec::new();
    for &(one, k) in of {
        let values = &one.measured.values[k];
        let times = with_tracks!(&one.recording.table, tracks => tracks.times());
        let (x, y, each) = thinned(times, values);
        let defined = values.iter().filter(|value| value.is_finite()).count();
        let counts = one.measured.counts(card.counted);
        let (least, most) = (counts.iter().min().unwrap_or(&0), counts.iter().max().unwrap_or(&0));
        let mean = counts.iter().map(|&count| f64::from(count)).sum::<f64>() / counts.len().max(1) as f64;
        let who = match card.counted {
            Counted::Positions => "a position",
            Counted::Velocities => "a velocity",
            Counted::Headings => "a heading",
            Counted::Bodies => "a direction of the body",
        };
        let name = &one.recording.name;
        let thin = if each > 1 { format!("; each point is the mean of {each} frames") } else { String::new() };
        abouts.push(format!(
            "{name}: defined in {defined} of {} frames, {least} to {most} individuals with {who} (mean {}){thin}.",
            values.len(),
            short(mean)
        ));
        lines.push(Line { name: name.clone(), x, y });
    }
    Figure::Lines(Lines {
        id: chart_id(card, of, ""),
        title: card.title.into(),
        about: abouts.join(". ").replace("..", "."),
        x: Axis { label: "time".into(), unit: units.time.clone(), range: None },
        y: Axis { label: card.title.to_lowercase(), unit: tables::unit_of(of[0].0, card.unit), range: card.range },
        lines,
    })
}

/// A line over time of at most so many points: means of as many frames each as that takes.
fn thinned(times: &[f64], values: &[f64]) -> (Vec<f64>, Vec<Option<f64>>, usize) {
    let each = times.len().div_ceil(POINTS).max(1);
    let mean = |part: &[f64]| {
        let there = part.iter().filter(|value| value.is_finite());
        let (sum, count) = there.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
        (count > 0.0).then(|| sum / count)
    };
    let x = times.chunks(each).filter_map(mean).collect();
    (x, values.chunks(each).map(mean).collect(), each)
}

/// How often a metric has which values, over the frames.
fn distribution(card: &MetricCard, of: &[(&Analysed, usize)]) -> Option<Figure> {
    let values = || of.iter().flat_map(|&(one, k)| &one.measured.values[k]).copied().filter(|value| value.is_finite());
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    // one value needs no picture
    if values().count() < BINS / 2 || low >= high {
        return None;
    }
    let whole = high - low < BINS as f64 && values().all(|value| value.fract() == 0.0);
    let (low, high) = match card.range {
        // of counts, each has a bin
        _ if whole => (low - 0.5, high + 0.5),
        Some((least, most)) => (least.min(low), most.max(high)),
        None => (low, high),
    };
    let bins = if whole { (high - low) as usize } else { BINS };
    let width = (high - low) / bins as f64;
    let line = |&(one, k): &(&Analysed, usize)| {
        let there: Vec<f64> = one.measured.values[k].iter().copied().filter(|value| value.is_finite()).collect();
        let mut shares = vec![0.0; bins];
        there.iter().for_each(|value| shares[(((value - low) / width) as usize).min(bins - 1)] += 1.0);
        Line {
            name: one.recording.name.clone(),
            x: (0..bins).map(|k| low + (k as f64 + 0.5) * width).collect(),
            y: shares.iter().map(|count| (!there.is_empty()).then(|| count / there.len() as f64)).collect(),
        }
    };
    let unit = tables::unit_of(of[0].0, card.unit);
    let bin = if unit == "1" { short(width) } else { format!("{} {unit}", short(width)) };
    Some(Figure::Lines(Lines {
        id: chart_id(card, of, "_distribution"),
        title: format!("Distribution of {}", card.title.to_lowercase()),
        about: format!("Share of frames in bins of {bin}."),
        x: Axis { label: card.title.to_lowercase(), unit, range: Some((low, high)) },
        y: Axis { label: "share of frames".into(), unit: "1".into(), range: None },
        lines: of.iter().map(line).collect(),
    }))
}

/// The metrics over time whose tables are a line: over a lag, a distance, or time.
fn over_time_charts(all: &[Analysed]) -> Vec<Figure> {
    let mut figures = Vec::new();
    for card in measure::over_time::LIST {
        let at = |name: &str| card.fields.iter().position(|field| field.name == name);
        let across = match (at("lag"), at("r_low").zip(at("r_high")), at("t")) {
            (Some(lag), ..) => vec![lag],
            (_, Some((low, high)), _) => vec![low, high],
            (.., Some(time)) if at("event").is_none() && !card.id.ends_with("_events") => vec![time],
            _ => continue,
        };
        let last = across[across.len() - 1];
        let Some(up) = (last + 1..card.fields.len()).find(|&k| card.fields[k].kind == measure::Kind::Number) else {
            continue;
        };
        // a row for each individual is no line over time
        if card.fields[..up].iter().any(|field| field.kind == measure::Kind::Individual) {
            continue;
        }
        let (x, y) = (card.fields[across[0]], card.fields[up]);
        let mut by_unit: Vec<((String, String), Vec<&Analysed>)> = Vec::new();
        for one in all.iter().filter(|one| listing(one, card).is_some_and(|listing| listing.len() > 1)) {
            let key = (tables::unit_of(one, x.unit), tables::unit_of(one, y.unit));
            match by_unit.iter_mut().find(|(known, _)| *known == key) {
                Some((_, list)) => list.push(one),
                None => by_unit.push((key, vec![one])),
            }
        }
        for ((x_unit, y_unit), of) in by_unit {
            let line = |(name, columns): (String, &[Vec<f64>])| {
                let mean = |row: usize| across.iter().map(|&k| columns[k][row]).sum::<f64>() / across.len() as f64;
                Line {
                    name,
                    x: (0..columns[up].len()).map(mean).collect(),
                    y: columns[up].iter().map(|value| Some(*value).filter(|value| value.is_finite())).collect(),
                }
            };
            let shown = of.iter().flat_map(|one| {
                let ours = tables::over_time_of(one).filter(|(_, (own, _))| own.id == card.id);
                ours.map(|(flagged, (_, listing))| {
                    let without = if flagged == 1 { " without flagged" } else { "" };
                    (format!("{}{without}", one.recording.name), listing.columns.as_slice())
                })
            });
            let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
            let label = if across.len() > 1 { "distance".to_owned() } else { x.name.replace('_', " ") };
            figures.push(Figure::Lines(Lines {
                id: format!("{}_{}", card.id, of[0].units.length),
                title: card.title.into(),
                about: format!("{}. {}.", words(card.definition), words(card.variant)),
                x: Axis { label: if label == "t" { "time".into() } else { label }, unit: x_unit, range: None },
                y: Axis { label: y.name.replace('_', " "), unit: y_unit, range: None },
                lines: shown.map(line).collect(),
            }));
        }
    }
    figures
}

/// The metrics over time whose tables are cells in which members of a group were found, as maps seen from above: the darker a cell,
/// the more often.
fn cell_maps(all: &[Analysed]) -> Vec<Figure> {
    let mut figures = Vec::new();
    for card in measure::over_time::LIST {
        let at = |name: &str| card.fields.iter().position(|field| field.name == name);
        let (Some(group), Some(share)) = (at("group"), at("share")) else { continue };
        // the first two coordinates follow the group
        let (across, up) = (card.fields[group + 1], card.fields[group + 2]);
        let mut by_unit: Vec<(String, Vec<&Analysed>)> = Vec::new();
        for one in all.iter().filter(|one| listing(one, card).is_some_and(|listing| !listing.is_empty())) {
            let unit = tables::unit_of(one, across.unit);
            match by_unit.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, list)) => list.push(one),
                None => by_unit.push((unit, vec![one])),
            }
        }
        for (unit, of) in by_unit {
            let mut panels = Vec::new();
            for one in of {
                let Some(listing) = listing(one, card) else { continue };
                let mut cells: BTreeMap<u32, BTreeMap<[u64; 2], ([f64; 2], f64)>> = BTreeMap::new();
                for row in 0..listing.len() {
                    let value = |k: usize| listing.columns[k][row];
                    let middle = [value(group + 1), value(group + 2)];
                    // one behind the other, seen from above
                    let of_group = cells.entry(value(group) as u32).or_default();
                    of_group.entry(middle.map(f64::to_bits)).or_insert((middle, 0.0)).1 += value(share);
                }
                for (number, cells) in cells {
                    let name = tables::label(one, &card.fields[group], f64::from(number));
                    let of = if name.is_empty() { String::new() } else { format!(": {name}") };
                    let caption = format!("{}{of}", one.recording.name);
                    panels.push((caption, cells.into_values().collect::<Vec<_>>()));
                }
            }
            figures.extend(cell_map(card, (across.name, up.name), &unit, panels));
        }
    }
    figures
}

/// Maps of cells by their middles and the share found in each.
fn cell_map(
    card: &TrackCard,
    (across, up): (&str, &str),
    unit: &str,
    panels: Vec<(String, Vec<([f64; 2], f64)>)>,
) -> Option<Figure> {
    let middles = || panels.iter().flat_map(|(_, cells)| cells.iter().map(|(middle, _)| *middle));
    // the side of cells: the least distance between the middles of two
    let side = (0..2).filter_map(|a| {
        let mut along: Vec<f64> = middles().map(|middle| middle[a]).collect();
        along.sort_by(f64::total_cmp);
        along.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 1e-9).reduce(f64::min)
    });
    let side = side.reduce(f64::min).unwrap_or(1.0);
    let ends = |a: usize| {
        let span = middles().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), middle| {
            (low.min(middle[a] - side / 2.0), high.max(middle[a] + side / 2.0))
        });
        (span.0.is_finite() && span.1.is_finite()).then_some(span)
    };
    let (x, y) = (ends(0)?, ends(1)?);
    // equal lengths on both axes
    let scale = ((x.1 - x.0) / map::PLOT.0).max((y.1 - y.0) / map::PLOT.1);
    let about = |(low, high): (f64, f64), room: f64| {
        let (middle, half) = ((low + high) / 2.0, scale * room / 2.0);
        Some((middle - half, middle + half))
    };
    let axis = |name: &str, range| Axis { label: name.to_owned(), unit: unit.to_owned(), range };
    let panel = |(caption, cells): (String, Vec<([f64; 2], f64)>)| {
        let most = cells.iter().map(|(_, share)| *share).fold(0.0, f64::max);
        let cell = |([x, y], share): ([f64; 2], f64)| MapCell {
            low: [x - side / 2.0, y - side / 2.0],
            high: [x + side / 2.0, y + side / 2.0],
            rate: share / most,
            valid: false,
        };
        MapPanel {
            caption: format!("{caption}; in the darkest cell {} % of all that were found", short(100.0 * most)),
            cells: cells.into_iter().map(cell).collect(),
        }
    };
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    Some(Figure::Map(Map {
        title: card.title.into(),
        about: format!(
            "The darker a cell, the more often members were found in it: {}; {}.",
            words(card.definition),
            words(card.variant)
        ),
        x: axis(across, about(x, map::PLOT.0)),
        y: axis(up, about(y, map::PLOT.1)),
        areas: true,
        panels: panels.into_iter().map(panel).collect(),
    }))
}

fn listing<'a>(one: &'a Analysed, card: &TrackCard) -> Option<&'a Listing> {
    one.over_time.iter().find(|(own, _)| own.id == card.id).map(|(_, listing)| listing)
}

/// The tables of metrics over time, as far as they are small.
fn over_time_tables(all: &[Analysed]) -> Vec<Download> {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut downloads = Vec::new();
    for card in measure::over_time::LIST {
        let with = || {
            let of = |one| tables::over_time_of(one).filter(|(_, (own, _))| own.id == card.id).map(move |of| (one, of));
            all.iter().flat_map(of)
        };
        let rows: usize = with().map(|(_, (_, (_, listing)))| listing.len()).sum();
        if rows == 0 || (rows * card.fields.len() * 10) as u64 > DOWNLOADED {
            continue;
        }
        let names: Vec<&str> = card.fields.iter().map(|field| field.name).collect();
        let mut csv = format!("recording,flagged,{}\n", names.join(","));
        for (one, (flagged, (_, listing))) in with() {
            for row in 0..listing.len() {
                csv += &format!("{},{}", quoted(&one.recording.name), tables::FLAGGED[flagged as usize]);
                for (field, column) in card.fields.iter().zip(&listing.columns) {
                    let label = tables::label(one, field, column[row]);
                    csv.push(',');
                    match (label.is_empty(), column[row].is_finite()) {
                        (false, _) => csv += &quoted(&label),
                        (true, true) => csv += &column[row].to_string(),
                        (true, false) => {}
                    }
                }
                csv.push('\n');
            }
        }
        let about = format!("{}: {}.", card.title, card.definition.split_whitespace().collect::<Vec<_>>().join(" "));
        downloads.push(Download { file: format!("{}.csv", card.id), about, csv });
    }
    downloads
}

/// The averages as CSV.
fn summary_csv(all: &[Analysed]) -> String {
    let mut text =
        "recording,metric,unit,mean,sd,least,greatest,frames,mean_without_flagged,frames_without_flagged\n".to_owned();
    let cell = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    for one in all {
        for (k, card) in one.cards.iter().enumerate() {
            let Some(a) = average(&one.measured.values[k]) else { continue };
            let rest = one.unflagged.as_ref().and_then(|rest| average(&rest.values[k]));
            let (rest, frames) = rest.map_or_else(Default::default, |rest| (cell(rest.mean), rest.frames.to_string()));
            let name = format!("\"{}\"", one.recording.name.replace('"', "\"\""));
            let numbers = [a.mean, a.sd, a.least, a.greatest].map(cell).join(",");
            text += &format!(
                "{name},{},{},{numbers},{},{rest},{frames}\n",
                card.id,
                tables::unit_of(one, card.unit),
                a.frames
            );
        }
    }
    text
}

/// What is flagged as CSV.
fn flags_csv(all: &[Analysed]) -> String {
    let quoted = |text: &str| format!("\"{}\"", text.replace('"', "\"\""));
    let mut text = "recording,frame,t,individual,flag\n".to_owned();
    for one in all {
        with_tracks!(&one.recording.table, tracks => {
            for &(row, frame, flag) in &one.cleaned.flags {
                let (number, time) = (tracks.frames()[frame], tracks.times()[frame]);
                let who = &tracks.names()[tracks.individuals()[row] as usize];
                let recording = quoted(&one.recording.name);
                text += &format!("{recording},{number},{time},{},{}\n", quoted(who), flag.word());
            }
        });
    }
    text
}

/// Tracks as they are drawn: three coordinates, on the globe m about the middle.
struct Seen3<'a, const D: usize> {
    tracks: &'a Tracks<D>,
    middle: [f64; 2],
    stage: Stage,
    /// Every so manieth individual is drawn.
    every: usize,
}

impl<'a, const D: usize> Seen3<'a, D> {
    fn of(tracks: &'a Tracks<D>) -> Self {
        let middle = if *tracks.ground() == Ground::Globe { tables::middle(tracks) } else { [0.0; 2] };
        let stage = Stage {
            dimensions: D,
            low: [0.0; 3],
            high: [0.0; 3],
            edges: [Border::Open; 3],
            unit: String::new(),
            groups: Vec::new(),
            radius: vec![0.0],
        };
        let every = tracks.names().len().div_ceil(DRAWN).max(1);
        let mut seen = Self { tracks, middle, stage, every };
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        let stride = (tracks.len() / 200_000).max(1);
        for row in (0..tracks.len()).step_by(stride) {
            let at = seen.place(row);
            for a in 0..3 {
                (low[a], high[a]) = (low[a].min(at[a]), high[a].max(at[a]));
            }
        }
        if let Ground::Plane(space) = tracks.ground() {
            for a in 0..D {
                let (border, side) = match space.edges[a] {
                    Edge::Open => (Border::Open, None),
                    Edge::Periodic(side) => (Border::Seam, Some(side)),
                    Edge::Walls(side) => (Border::Wall, Some(side)),
                };
                seen.stage.edges[a] = border;
                if let Some(side) = side {
                    (low[a], high[a]) = (0.0, side);
                }
            }
        }
        (seen.stage.low, seen.stage.high) = (low, high);
        seen
    }
    fn place(&self, row: usize) -> [f64; 3] {
        let at = self.tracks.position(row).0;
        let mut place = [0.0; 3];
        if *self.tracks.ground() == Ground::Globe {
            place[..2].copy_from_slice(&measure::ground::departure(self.middle, [at[0], at[1]]).0);
        } else {
            place[..D].copy_from_slice(&at);
        }
        place
    }
    fn heading(&self, row: usize) -> [f64; 3] {
        let along = self.tracks.heading(row).unwrap_or(Vector::ZERO).0;
        core::array::from_fn(|a| if a < D { along[a] } else { 0.0 })
    }
    fn stage(&self, one: &Analysed) -> Stage {
        Stage { unit: one.units.length.clone(), groups: vec![one.recording.name.clone()], ..self.stage.clone() }
    }
    fn drawn(&self) -> String {
        if self.every == 1 {
            return String::new();
        }
        format!(" Every {} of {} individuals is drawn.", ordinal(self.every), self.tracks.names().len())
    }
    fn replay(&self, one: &Analysed, recordings: usize) -> Option<Figure> {
        let frames = self.tracks.frames().len();
        if frames < 2 {
            return None;
        }
        let agents = self.tracks.names().len().div_ceil(self.every);
        let most = (REPLAYED / recordings / agents).clamp(2, REPLAYED_FRAMES);
        let each = frames.div_ceil(most).max(1);
        let chosen: Vec<usize> = (0..frames).step_by(each).collect();
        let moment = |&frame: &usize, of: &dyn Fn(usize) -> [f64; 3], none: f32| {
            let mut column = vec![[none; 3]; agents];
            for row in self.tracks.rows(frame) {
                let individual = self.tracks.individuals()[row] as usize;
                if individual.is_multiple_of(self.every) {
                    column[individual / self.every] = of(row).map(|c| c as f32);
                }
            }
            column
        };
        let thinned = if each > 1 { format!(" Every {} frame is shown.", ordinal(each)) } else { String::new() };
        Some(Figure::Replay(Replay {
            title: format!("Replay of {}", one.recording.name),
            about: format!("The individuals as they were recorded, y upwards.{thinned}{}", self.drawn()),
            stage: self.stage(one),
            time_unit: one.units.time.clone(),
            times: chosen.iter().map(|&frame| self.tracks.times()[frame]).collect(),
            group: vec![0; agents],
            position: chosen.iter().map(|frame| moment(frame, &|row| self.place(row), f32::NAN)).collect(),
            heading: chosen.iter().map(|frame| moment(frame, &|row| self.heading(row), 0.0)).collect(),
            obstacles: vec![Vec::new()],
        }))
    }
    /// The paths in four parts of the recording, one after the other.
    fn scenes(&self, one: &Analysed) -> Option<Figure> {
        let frames = self.tracks.frames().len();
        if frames < 2 {
            return None;
        }
        let paths = self.tracks.paths();
        let parts = if D == 3 { 2 } else { 4.min(frames - 1) };
        let points = (PATHS / parts / self.tracks.names().len().max(1)).clamp(2, PATH);
        let moments = (0..parts).map(|part| {
            let (from, to) = (part * (frames - 1) / parts, (part + 1) * (frames - 1) / parts);
            let agents = (0..paths.len()).step_by(self.every).filter_map(|individual| {
                let mut trail = Vec::new();
                let mut last: Option<(usize, usize)> = None;
                let each = (to - from).div_ceil(points).max(1);
                for (frame, row) in paths.of(individual).skip_while(|at| at.0 < from).take_while(|at| at.0 <= to) {
                    if last.is_some_and(|last| last.0 + 1 < frame) || (frame - from).is_multiple_of(each) {
                        trail.push(self.place(row));
                    }
                    last = Some((frame, row));
                }
                let (_, row) = last?;
                Some(Seen { group: 0, position: self.place(row), heading: self.heading(row), trail })
            });
            Moment { time: self.tracks.times()[to], agents: agents.collect(), items: Vec::new(), obstacles: Vec::new() }
        });
        let moments: Vec<Moment> = moments.collect();
        Some(Figure::Scenes(Scenes {
            title: format!("Paths of {}", one.recording.name),
            about: format!(
                "Where individuals went in each part of the recording, up to the time named, y upwards.{}",
                self.drawn()
            ),
            stage: self.stage(one),
            time_unit: one.units.time.clone(),
            moments,
        }))
    }
}
