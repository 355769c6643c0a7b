//! From columns as they were read to rows of frames: which frame a time belongs to, which rows are of one moment, and
//! how fast time goes.

use super::gather::Gathered;
use super::layouts::{Plan, Who};
use super::{Ask, Rate, stamps, wrong};
use crate::report::of_run::short;
use crate::store::StoreError;
use measure::Clock;
use std::path::Path;

/// Two times (s) this close are one: what rounding to microseconds and to 64 bits leaves.
const SAME: f64 = 2e-6;

/// Rows sorted by frame, then by individual, each once, and when frames were.
pub(super) struct Settled {
    pub(super) names: Vec<String>,
    pub(super) frame: Vec<i64>,
    pub(super) who: Vec<u32>,
    pub(super) place: Vec<Vec<f64>>,
    pub(super) velocity: Vec<Vec<f64>>,
    pub(super) clock: Clock,
    /// Frames per second, where they come at a rate.
    pub(super) rate: Option<f64>,
    /// The moment of time 0, where times are dates.
    pub(super) origin: Option<String>,
    /// Rows left out since the individual has one in that frame already.
    pub(super) repeated: usize,
    pub(super) notes: Vec<String>,
}

/// What frames are, once it is known.
struct Frames {
    frame: Vec<i64>,
    clock: Clock,
    rate: Option<f64>,
    origin: Option<f64>,
    /// Whether the first of several rows in a frame is meant.
    first_counts: bool,
    notes: Vec<String>,
}

/// Settles which frame each row belongs to.
///
/// # Errors
/// Where frames have no rate, an individual is twice in a frame, or times are those of no common clock.
pub(super) fn settle(path: &Path, plan: &Plan, ask: &Ask, mut read: Gathered) -> Result<Settled, StoreError> {
    if read.who.is_empty() {
        let what = if read.lost > 0 {
            "no row names an individual; if all are of one, say --columns id=none"
        } else {
            "no row has a position; expected a table of positions"
        };
        return Err(wrong(path, what));
    }
    check_unit(path, plan, &read)?;
    rename(&mut read);
    add_empty_frames(&mut read);
    let mut frames = frames(path, plan, ask, &mut read)?;
    let order = order(&frames.frame, &read.who);
    if let Some(order) = order {
        let arrange = |column: &mut Vec<f64>| *column = order.iter().map(|&row| column[row as usize]).collect();
        read.place.iter_mut().chain(&mut read.velocity).for_each(arrange);
        read.who = order.iter().map(|&row| read.who[row as usize]).collect();
        frames.frame = order.iter().map(|&row| frames.frame[row as usize]).collect();
    }
    let repeated = keep_first(path, ask, &mut frames, &mut read)?;
    Ok(Settled {
        names: read.names,
        frame: frames.frame,
        who: read.who,
        place: read.place,
        velocity: read.velocity,
        clock: frames.clock,
        rate: frames.rate,
        origin: frames.origin.map(stamps::written),
        repeated,
        notes: frames.notes,
    })
}

/// Numbers that cannot be seconds, of this age of the world, have a unit that is to be said.
fn check_unit(path: &Path, plan: &Plan, read: &Gathered) -> Result<(), StoreError> {
    const LATEST: f64 = 1e11;
    let unsaid = plan.time.filter(|clock| !clock.stamps && clock.unit.is_none());
    match (unsaid, read.time.iter().find(|time| time.abs() > LATEST)) {
        (Some(clock), Some(time)) => {
            let name = plan.names.get(clock.column).map_or("?", String::as_str);
            Err(wrong(
                path,
                &format!("times of column `{name}`, as {time}, are no seconds: say --columns clock=ms (or us, ns)"),
            ))
        }
        _ => Ok(()),
    }
}

/// Individuals in the order of their numbers, where all are numbers: files name them in the order in which they appear.
fn rename(read: &mut Gathered) {
    let numbers: Option<Vec<i64>> = read.names.iter().map(|name| name.parse().ok()).collect();
    let Some(numbers) = numbers.filter(|numbers| !numbers.is_sorted()) else { return };
    let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
    order.sort_by_key(|&k| numbers[k as usize]);
    let mut to = vec![0; order.len()];
    order.iter().enumerate().for_each(|(new, &old)| to[old as usize] = new as u32);
    read.names = order.iter().map(|&old| core::mem::take(&mut read.names[old as usize])).collect();
    read.who.iter_mut().for_each(|who| *who = to[*who as usize]);
}

/// A frame in which nobody was found is a frame: it has a row without a place.
fn add_empty_frames(read: &mut Gathered) {
    // an individual's own row in the frame comes first when rows are sorted, and is the one that is kept
    for (frame, time) in core::mem::take(&mut read.empty) {
        read.who.push(0);
        if !read.frame.is_empty() {
            read.frame.push(frame);
        }
        if !read.time.is_empty() {
            read.time.push(time);
        }
        read.place.iter_mut().chain(&mut read.velocity).for_each(|column| column.push(f64::NAN));
    }
}

/// The order that sorts rows by frame and individual, earlier rows first; none where they are sorted.
fn order(frame: &[i64], who: &[u32]) -> Option<Vec<u32>> {
    let key = |row: usize| (frame[row], who[row]);
    if (1..frame.len()).all(|row| key(row - 1) <= key(row)) {
        return None;
    }
    let mut order: Vec<u32> = (0..frame.len() as u32).collect();
    order.sort_unstable_by_key(|&row| (frame[row as usize], who[row as usize], row));
    Some(order)
}

/// Leaves out rows after an individual's first in a frame.
fn keep_first(path: &Path, ask: &Ask, frames: &mut Frames, read: &mut Gathered) -> Result<usize, StoreError> {
    let count = frames.frame.len();
    let same = |k: usize| (frames.frame[k - 1], read.who[k - 1]) == (frames.frame[k], read.who[k]);
    if !(1..count).any(same) {
        return Ok(0);
    }
    let (mut kept, mut repeated) = (0, 0);
    for row in 0..count {
        let again = kept > 0 && (frames.frame[kept - 1], read.who[kept - 1]) == (frames.frame[row], read.who[row]);
        let there = |row: usize| read.place[0][row].is_finite();
        if again && there(kept - 1) {
            if there(row) {
                if !frames.first_counts && !ask.keep_first {
                    let (name, frame) = (&read.names[read.who[row] as usize], frames.frame[row]);
                    return Err(wrong(
                        path,
                        &format!(
                            "individual `{name}` is twice in frame {frame}; --keep-first keeps the first of such rows, \
                             --columns id=NAME names another column of individuals"
                        ),
                    ));
                }
                repeated += 1;
            }
            continue;
        }
        let to = if again { kept - 1 } else { kept };
        (frames.frame[to], read.who[to]) = (frames.frame[row], read.who[row]);
        read.place.iter_mut().chain(&mut read.velocity).for_each(|column| column[to] = column[row]);
        kept = to + 1;
    }
    frames.frame.truncate(kept);
    read.who.truncate(kept);
    read.place.iter_mut().chain(&mut read.velocity).for_each(|column| column.truncate(kept));
    Ok(repeated)
}

fn frames(path: &Path, plan: &Plan, ask: &Ask, read: &mut Gathered) -> Result<Frames, StoreError> {
    let long = plan.places.len() == 1;
    if plan.frame.is_none() && plan.time.is_none() && long {
        return moment(path, plan, read);
    }
    if plan.frame.is_none() && plan.time.is_some() {
        let time = core::mem::take(&mut read.time);
        return of_times(path, plan, ask, time, &read.who);
    }
    let frame = core::mem::take(&mut read.frame);
    let mut notes = Vec::new();
    let stated = match ask.fps {
        Some(Rate::Known(rate)) => Some(rate),
        Some(Rate::Unknown) => None,
        None if plan.time.is_some() => None,
        None => plan.fps,
    };
    if ask.fps == Some(Rate::Unknown) {
        notes.push("no frame rate: times are counted in frames".to_owned());
        return Ok(Frames { frame, clock: Clock::Rate(1.0), rate: None, origin: None, first_counts: false, notes });
    }
    if let Some(rate) = stated {
        let clock = Clock::Rate(rate);
        return Ok(Frames { frame, clock, rate: Some(rate), origin: None, first_counts: false, notes });
    }
    if plan.time.is_some() {
        return timed(path, plan, frame, core::mem::take(&mut read.time));
    }
    if frame.iter().all(|&number| number == frame[0]) {
        // one moment has no rate
        let clock = Clock::Stamps(vec![(frame[0], 0.0)]);
        return Ok(Frames { frame, clock, rate: None, origin: None, first_counts: false, notes });
    }
    Err(wrong(
        path,
        "it numbers frames and has no times: say how many frames a second with --fps F, or --fps unknown to measure in \
         frames",
    ))
}

/// A table without a clock is one moment, if everyone is in it once.
fn moment(path: &Path, plan: &Plan, read: &Gathered) -> Result<Frames, StoreError> {
    let clockless = "no column of frames or times";
    if !matches!(plan.places[0].who, Who::Column(_) | Who::Columns(..)) {
        return Err(wrong(
            path,
            &format!(
                "{clockless}, and none of individuals: name them with --columns frame=NAME or --columns id=NAME; there \
                 are {}",
                super::names::shown(&plan.names)
            ),
        ));
    }
    let mut seen = vec![false; read.names.len()];
    for &who in &read.who {
        if core::mem::replace(&mut seen[who as usize], true) {
            let name = &read.names[who as usize];
            let there = super::names::shown(&plan.names);
            return Err(wrong(
                path,
                &format!(
                    "{clockless}, and individual `{name}` twice: name one with --columns frame=NAME; there are {there}"
                ),
            ));
        }
    }
    let notes = vec![format!("{clockless}: one moment")];
    let (frame, clock) = (vec![0; read.who.len()], Clock::Stamps(vec![(0, 0.0)]));
    Ok(Frames { frame, clock, rate: None, origin: None, first_counts: false, notes })
}

/// The rate nearest to a whole number where that fits as well.
fn round_rate(rate: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let whole = rate.round();
    if whole >= 1.0 && (whole - rate).abs() < 0.02 * rate && fits(whole) { whole } else { rate }
}

/// Frames with numbers and times.
fn timed(path: &Path, plan: &Plan, frame: Vec<i64>, time: Vec<f64>) -> Result<Frames, StoreError> {
    let mut pairs: Vec<(i64, f64)> = Vec::new();
    for (&frame, &time) in frame.iter().zip(&time) {
        if pairs.last().is_none_or(|last| last.0 != frame) {
            pairs.push((frame, time));
        }
    }
    pairs.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    pairs.dedup_by_key(|pair| pair.0);
    let dated = plan.time.is_some_and(|clock| clock.stamps);
    let origin = if dated { pairs[0].1 } else { 0.0 };
    pairs.iter_mut().for_each(|pair| pair.1 -= origin);
    let (first, last) = (pairs[0], pairs[pairs.len() - 1]);
    let mut notes = Vec::new();
    let mut clock = None;
    let mut rate = None;
    if last.1 > first.1 {
        let mean = (last.0 - first.0) as f64 / (last.1 - first.1);
        // times may be rounded, to 0.01 s by AnimalTA
        let most = (0.45 / mean).max(0.0051);
        let fits =
            |rate: f64| pairs.iter().all(|pair| ((pair.1 - first.1) - (pair.0 - first.0) as f64 / rate).abs() <= most);
        if fits(mean) {
            let mean = round_rate(mean, fits);
            rate = Some(mean);
            let begins = (first.1 - first.0 as f64 / mean).abs() <= most;
            // the numbers tell the time exactly, where frame 0 is at time 0
            clock = (begins && !dated).then_some(Clock::Rate(mean));
            if clock.is_none() {
                let at = |&(frame, _): &(i64, f64)| (frame, first.1 + (frame - first.0) as f64 / mean);
                clock = Some(Clock::Stamps(pairs.iter().map(at).collect()));
            }
        } else {
            notes.push("frames come at no steady rate: their times are taken as they are".to_owned());
        }
    }
    if pairs.len() > 1 && !pairs.windows(2).all(|pair| pair[0].1 < pair[1].1) && clock.is_none() {
        let names = |column: Option<usize>| column.and_then(|c| plan.names.get(c)).map_or("?", String::as_str);
        let (frame, time) = (names(plan.frame), names(plan.time.map(|clock| clock.column)));
        return Err(wrong(
            path,
            &format!(
                "times of column `{time}` do not ascend with the numbers of column `{frame}`: say --columns time=none and \
                 --fps F, or --columns frame=none"
            ),
        ));
    }
    let clock = clock.unwrap_or(Clock::Stamps(pairs));
    Ok(Frames { frame, clock, rate, origin: dated.then_some(origin), first_counts: false, notes })
}

/// The median time between an individual's fix and its next one, where rows are in the order of time.
fn usual_interval(time: &[f64], who: &[u32]) -> Option<f64> {
    let mut last: Vec<f64> = vec![f64::NAN; who.iter().max().map_or(0, |&most| most as usize + 1)];
    let mut intervals = Vec::new();
    for (&t, &who) in time.iter().zip(who) {
        let before = core::mem::replace(&mut last[who as usize], t);
        if t - before > SAME {
            intervals.push(t - before);
        }
    }
    let middle = intervals.len() / 2;
    (!intervals.is_empty()).then(|| *intervals.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Frames of times alone.
fn of_times(path: &Path, plan: &Plan, ask: &Ask, mut time: Vec<f64>, who: &[u32]) -> Result<Frames, StoreError> {
    let stamped = plan.time.is_some_and(|clock| clock.stamps);
    let dated = stamped || time.iter().all(|&t| t > 1e8);
    let of_day = stamped && time.iter().all(|&t| (0.0..2.0 * stamps::DAY).contains(&t));
    let least = time.iter().copied().fold(f64::INFINITY, f64::min);
    let origin = if dated { least } else { 0.0 };
    time.iter_mut().for_each(|t| *t -= origin);
    let stamp = |dated: bool| dated.then_some(origin);
    let mut notes = Vec::new();
    if let Some(Rate::Known(rate)) = ask.fps {
        let frame: Vec<i64> = time.iter().map(|t| (t * rate).round() as i64).collect();
        let off = time.iter().zip(&frame).map(|(t, &f)| (t - f as f64 / rate).abs()).fold(0.0, f64::max);
        if off > 1e-3 / rate {
            notes.push(format!("times were put on ticks of {} s, at most {off:.3} s away", 1.0 / rate));
        }
        let clock = Clock::Rate(rate);
        return Ok(Frames { frame, clock, rate: Some(rate), origin: stamp(dated), first_counts: true, notes });
    }
    let mut ticks = time.clone();
    ticks.sort_unstable_by(f64::total_cmp);
    let mut last = f64::NEG_INFINITY;
    ticks.retain(|&t| {
        let new = t - last > SAME;
        last = if new { t } else { last };
        new
    });
    let mut gaps: Vec<f64> = ticks.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if gaps.is_empty() {
        let clock = Clock::Stamps(vec![(0, ticks[0])]);
        let frame = vec![0; time.len()];
        return Ok(Frames { frame, clock, rate: None, origin: stamp(dated), first_counts: true, notes });
    }
    gaps.sort_unstable_by(f64::total_cmp);
    if of_day && gaps[gaps.len() - 1] > stamps::DAY / 2.0 {
        let what =
            "times of day go past midnight, or leave half a day out: they need their dates, as 2012-08-05 03:00:01.5";
        return Err(wrong(path, what));
    }
    let (shortest, usual) = (gaps[0], gaps[gaps.len() / 2]);
    // of individuals with one clock, the time between an individual's fixes is that between ticks, or a few of them
    let own = usual_interval(&time, who).unwrap_or(usual);
    let steps = |gap: f64| gap / usual;
    let steady = gaps.iter().all(|&gap| (steps(gap) - steps(gap).round()).abs() < 0.05 * steps(gap).sqrt());
    if shortest < 0.4 * usual || usual < 0.2 * own || !steady && usual < 0.6 * own {
        return Err(wrong(
            path,
            &format!(
                "times have no common clock: an individual has a fix every {} s or so, and some are {} s apart; --fps F puts \
                 each on the nearest of F ticks a second and keeps the first of an individual's fixes on a tick",
                short(own),
                short(shortest)
            ),
        ));
    }
    let place = |t: f64| ticks.partition_point(|&tick| tick <= t + SAME).saturating_sub(1);
    let mut numbers: Vec<i64> = (0..ticks.len() as i64).collect();
    if steady {
        let mut number = 0;
        for k in 1..ticks.len() {
            number += steps(ticks[k] - ticks[k - 1]).round() as i64;
            numbers[k] = number;
        }
    } else {
        notes.push("times come at no steady rate: frames are the times that there are".to_owned());
    }
    let span = ticks[ticks.len() - 1] - ticks[0];
    let mean = numbers[numbers.len() - 1] as f64 / span;
    let rate = steady.then(|| round_rate(mean, |rate| (span * rate - span * mean).abs() < 0.5));
    let frame = time.iter().map(|&t| numbers[place(t)]).collect();
    let clock = Clock::Stamps(numbers.iter().copied().zip(ticks).collect());
    Ok(Frames { frame, clock, rate, origin: stamp(dated), first_counts: true, notes })
}
