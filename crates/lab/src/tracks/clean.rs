//! Cleaning, off unless asked for: gaps filled, paths smoothed, impossible speeds and swapped identities flagged. What was
//! done is counted, and what is flagged stays: averages are told with it and without it.

use measure::{Clock, Rows, Tracks, TracksError};
use space::Vector;
use std::collections::BTreeMap;

/// What is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cleaning {
    /// Longest gap, in frames, that is filled by a straight line.
    pub interpolate: Option<usize>,
    /// Window, in frames (odd), and order of a Savitzky-Golay filter.
    pub smooth: Option<(usize, usize)>,
    /// Speed above which a fix is impossible.
    pub greatest_speed: Option<f64>,
    /// Whether swapped identities are looked for.
    pub swaps: bool,
}

/// What is wrong with a fix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flag {
    /// It is farther from the last one that was not flagged than the greatest speed allows.
    ImpossibleSpeed,
    /// Two individuals went to where the other had been.
    IdentitySwap,
}

impl Flag {
    /// Its name in tables.
    pub fn word(self) -> &'static str {
        match self {
            Self::ImpossibleSpeed => "impossible_speed",
            Self::IdentitySwap => "identity_swap",
        }
    }
}

/// What cleaning did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cleaned {
    /// What was asked for.
    pub asked: Cleaning,
    /// Flagged rows of the cleaned tracks: the row, its frame (by its place in the list), and why; ascending.
    pub flags: Vec<(usize, usize, Flag)>,
    /// Positions put into gaps, and the number of gaps that were filled.
    pub filled: (usize, usize),
    /// Gaps that were too long.
    pub left: usize,
    /// Positions that were smoothed, and those in stretches shorter than the window.
    pub smoothed: (usize, usize),
}

impl Cleaned {
    /// How many positions are flagged for each reason that was looked for.
    pub fn flag_counts(&self) -> impl Iterator<Item = (Flag, usize)> {
        let looked =
            [(Flag::ImpossibleSpeed, self.asked.greatest_speed.is_some()), (Flag::IdentitySwap, self.asked.swaps)];
        let count = |flag: Flag| self.flags.iter().filter(|(.., other)| *other == flag).count();
        looked.into_iter().filter(|(_, asked)| *asked).map(move |(flag, _)| (flag, count(flag)))
    }
}

/// Cleans tracks: fills gaps, then flags, then smooths.
///
/// # Errors
/// Where the cleaned rows are no tracks, which only a fault of ours can cause.
pub fn clean<const D: usize>(tracks: Tracks<D>, ask: &Cleaning) -> Result<(Tracks<D>, Cleaned), TracksError> {
    let mut done = Cleaned { asked: *ask, ..Cleaned::default() };
    let tracks = match ask.interpolate {
        Some(longest) => interpolate(tracks, longest, &mut done)?,
        None => tracks,
    };
    if let Some(greatest) = ask.greatest_speed {
        impossible(&tracks, greatest, &mut done.flags);
    }
    if ask.swaps {
        swapped(&tracks, &mut done.flags);
    }
    done.flags.sort_by_key(|&(row, _, flag)| (row, flag == Flag::IdentitySwap));
    let tracks = match ask.smooth {
        Some((window, order)) => smooth(tracks, window, order, &mut done)?,
        None => tracks,
    };
    Ok((tracks, done))
}

/// The same tracks without the flagged rows.
///
/// # Errors
/// As [`clean`].
pub fn without_flagged<const D: usize>(tracks: &Tracks<D>, done: &Cleaned) -> Result<Tracks<D>, TracksError> {
    let mut rows = rows_of(tracks);
    // velocities that the table tells stay; differences go with their positions
    for &(row, ..) in &done.flags {
        (0..D).for_each(|a| rows.position[a][row] = f64::NAN);
    }
    rebuilt(tracks, rows, clock_of(tracks))
}

/// The rows of tracks, with a row without a place for each frame in which nobody was found.
fn rows_of<const D: usize>(tracks: &Tracks<D>) -> Rows<D> {
    let mut rows = Rows {
        frame: Vec::with_capacity(tracks.len()),
        individual: tracks.individuals().to_vec(),
        position: core::array::from_fn(|a| tracks.positions(a).to_vec()),
        velocity: tracks.tells_velocities().then(|| core::array::from_fn(|a| tracks.velocities(a).to_vec())),
        body: None,
    };
    for (k, &frame) in tracks.frames().iter().enumerate() {
        rows.frame.resize(rows.frame.len() + tracks.rows(k).len(), frame);
    }
    for (k, &frame) in tracks.frames().iter().enumerate() {
        if tracks.rows(k).is_empty() {
            rows.frame.push(frame);
            rows.individual.push(0);
            columns(&mut rows).for_each(|column| column.push(f64::NAN));
        }
    }
    rows
}

/// The columns of positions, and of velocities where they are told.
fn columns<const D: usize>(rows: &mut Rows<D>) -> impl Iterator<Item = &mut Vec<f64>> {
    rows.position.iter_mut().chain(rows.velocity.iter_mut().flatten())
}

fn clock_of<const D: usize>(tracks: &Tracks<D>) -> BTreeMap<i64, f64> {
    tracks.frames().iter().copied().zip(tracks.times().iter().copied()).collect()
}

fn rebuilt<const D: usize>(
    tracks: &Tracks<D>,
    rows: Rows<D>,
    clock: BTreeMap<i64, f64>,
) -> Result<Tracks<D>, TracksError> {
    let clock = Clock::Stamps(clock.into_iter().collect());
    Tracks::new(rows, tracks.names().to_vec(), clock, *tracks.ground())?
        .with_groups(tracks.group_names().to_vec(), tracks.groups().to_vec())
}

/// Fills gaps of at most so many frames by straight lines (the shorter way round a periodic axis).
fn interpolate<const D: usize>(
    tracks: Tracks<D>,
    longest: usize,
    done: &mut Cleaned,
) -> Result<Tracks<D>, TracksError> {
    let mut rows = rows_of(&tracks);
    let mut clock = clock_of(&tracks);
    let (frames, times, step) = (tracks.frames(), tracks.times(), tracks.step().max(1));
    let paths = tracks.paths();
    for individual in 0..paths.len() {
        let mut path = paths.of(individual);
        let Some(mut last) = path.next() else { continue };
        for next in path {
            let missing = (frames[next.0] - frames[last.0]) / step - 1;
            if missing > 0 && missing as usize > longest {
                done.left += 1;
            } else if missing > 0 {
                done.filled.1 += 1;
                let from = tracks.position(last.1);
                let way = line(&tracks, from, tracks.position(next.1));
                for k in 1..=missing {
                    let frame = frames[last.0] + k * step;
                    let share = k as f64 / (missing + 1) as f64;
                    let time = times[last.0] + share * (times[next.0] - times[last.0]);
                    let time = *clock.entry(frame).or_insert(time);
                    // where frames come at no steady rate, the time decides, not the number
                    let share = ((time - times[last.0]) / (times[next.0] - times[last.0])).clamp(0.0, 1.0);
                    let at = from + way * share;
                    rows.frame.push(frame);
                    rows.individual.push(individual as u32);
                    (0..D).for_each(|a| rows.position[a].push(at.0[a]));
                    rows.velocity.iter_mut().flatten().for_each(|column| column.push(f64::NAN));
                    done.filled.0 += 1;
                }
            }
            last = next;
        }
    }
    if done.filled.0 == 0 {
        return Ok(tracks);
    }
    drop_empty_twins(&mut rows);
    rebuilt(&tracks, rows, clock)
}

/// Leaves out the placeholder of a frame in which individual 0 has a place by now.
fn drop_empty_twins<const D: usize>(rows: &mut Rows<D>) {
    let zero = |row: usize| rows.individual[row] == 0;
    let there = |row: usize| rows.position[0][row].is_finite();
    let filled: std::collections::HashSet<i64> =
        (0..rows.frame.len()).filter(|&row| zero(row) && there(row)).map(|row| rows.frame[row]).collect();
    let keep: Vec<bool> =
        (0..rows.frame.len()).map(|row| there(row) || !(zero(row) && filled.contains(&rows.frame[row]))).collect();
    let mut kept = keep.iter();
    rows.frame.retain(|_| *kept.next().unwrap_or(&true));
    let mut kept = keep.iter();
    rows.individual.retain(|_| *kept.next().unwrap_or(&true));
    for column in columns(rows) {
        let mut kept = keep.iter();
        column.retain(|_| *kept.next().unwrap_or(&true));
    }
}

/// The straight way between two places in the coordinates that are kept: degrees, on the globe.
fn line<const D: usize>(tracks: &Tracks<D>, from: Vector<f64, D>, to: Vector<f64, D>) -> Vector<f64, D> {
    match tracks.ground() {
        measure::Ground::Plane(space) => space.offset(from, to),
        measure::Ground::Globe => to - from,
    }
}

/// Flags fixes that are farther from the last one that was not flagged than the greatest speed allows.
fn impossible<const D: usize>(tracks: &Tracks<D>, greatest: f64, flags: &mut Vec<(usize, usize, Flag)>) {
    let paths = tracks.paths();
    for individual in 0..paths.len() {
        let mut good: Option<(usize, usize)> = None;
        for (frame, row) in paths.of(individual) {
            let fast = good.is_some_and(|(before, last)| {
                let way = tracks.offset(tracks.position(last), tracks.position(row)).length();
                way > greatest * (tracks.times()[frame] - tracks.times()[before])
            });
            if fast {
                flags.push((row, frame, Flag::ImpossibleSpeed));
            } else {
                good = Some((frame, row));
            }
        }
    }
}

/// Flags pairs that went to where the other had been: the way of the two is less than half as long if they are exchanged,
/// and each is nearer to where the other was than to where it was itself.
fn swapped<const D: usize>(tracks: &Tracks<D>, flags: &mut Vec<(usize, usize, Flag)>) {
    for frame in 1..tracks.frames().len() {
        if tracks.interval_before(frame).is_none() {
            continue;
        }
        let way = |from: usize, to: usize| tracks.offset(tracks.position(from), tracks.position(to)).length();
        let pairs: Vec<(usize, usize)> = tracks
            .rows(frame)
            .filter_map(|row| Some((tracks.row(frame - 1, tracks.individuals()[row])?, row)))
            .collect();
        // whom each went to: the nearest place of the frame before
        let nearest = |&(before, row): &(usize, usize)| {
            let own = way(before, row);
            let near = |best: Option<(f64, usize)>, (k, other): (usize, &(usize, usize))| {
                let distance = way(other.0, row);
                if other.0 != before && distance < best.map_or(own, |best| best.0) { Some((distance, k)) } else { best }
            };
            pairs.iter().enumerate().fold(None, near)
        };
        let nearest: Vec<Option<(f64, usize)>> = pairs.iter().map(nearest).collect();
        for (i, best) in nearest.iter().enumerate() {
            let Some((crossed, j)) = *best else { continue };
            let Some((back, i_again)) = nearest[j] else { continue };
            if i_again != i || i > j {
                continue;
            }
            let straight = way(pairs[i].0, pairs[i].1) + way(pairs[j].0, pairs[j].1);
            if 2.0 * (crossed + back) < straight {
                flags.push((pairs[i].1, frame, Flag::IdentitySwap));
                flags.push((pairs[j].1, frame, Flag::IdentitySwap));
            }
        }
    }
}

/// Smooths paths by the filter of Savitzky and Golay (1964): in each window a polynomial is fitted, whose value at the place
/// in question is taken; at the ends of a stretch, that of the last whole window. Stretches shorter than it stay as they are.
fn smooth<const D: usize>(
    tracks: Tracks<D>,
    window: usize,
    order: usize,
    done: &mut Cleaned,
) -> Result<Tracks<D>, TracksError> {
    let weights: Vec<Vec<f64>> = (0..window).map(|at| savitzky_golay(window, order, at)).collect();
    // velocities are those of the smooth paths, also where the table tells others
    let mut rows = Rows { velocity: None, ..rows_of(&tracks) };
    let paths = tracks.paths();
    for individual in 0..paths.len() {
        let path: Vec<(usize, usize)> = paths.of(individual).collect();
        let mut from = 0;
        while from < path.len() {
            let follows = |k: &usize| {
                let (before, now) = (path[*k - 1].0, path[*k].0);
                now == before + 1 && tracks.interval_before(now).is_some()
            };
            let to = (from + 1..path.len()).take_while(follows).last().map_or(from + 1, |last| last + 1);
            let stretch = &path[from..to];
            from = to;
            if stretch.len() < window {
                done.smoothed.1 += stretch.len();
                continue;
            }
            done.smoothed.0 += stretch.len();
            // a path that crosses a seam is unrolled
            let mut unrolled = vec![tracks.position(stretch[0].1)];
            for pair in stretch.windows(2) {
                let way = line(&tracks, tracks.position(pair[0].1), tracks.position(pair[1].1));
                unrolled.push(unrolled[unrolled.len() - 1] + way);
            }
            for (k, &(_, row)) in stretch.iter().enumerate() {
                let begin = k.saturating_sub(window / 2).min(stretch.len() - window);
                let weights = &weights[k - begin];
                for a in 0..D {
                    let terms = weights.iter().zip(&unrolled[begin..]).map(|(weight, place)| weight * place.0[a]);
                    rows.position[a][row] = terms.sum();
                }
            }
        }
    }
    let clock = clock_of(&tracks);
    rebuilt(&tracks, rows, clock)
}

/// The weights by which a window's values give the fitted polynomial's value at one of its places.
fn savitzky_golay(window: usize, order: usize, at: usize) -> Vec<f64> {
    // an orthogonal basis of the polynomials on the window: weights are sums of p(at) p(k) / |p|^2
    let half = (window as f64 - 1.0) / 2.0;
    let x: Vec<f64> = (0..window).map(|k| (k as f64 - half) / half.max(1.0)).collect();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for power in 0..=order {
        let mut p: Vec<f64> = match power {
            0 => vec![1.0; window],
            _ => basis[power - 1].iter().zip(&x).map(|(p, x)| p * x).collect(),
        };
        // twice: once leaves errors of rounding
        for _ in 0..2 {
            for q in &basis {
                let share: f64 = p.iter().zip(q).map(|(p, q)| p * q).sum();
                p.iter_mut().zip(q).for_each(|(p, q)| *p -= share * q);
            }
        }
        let length = p.iter().map(|p| p * p).sum::<f64>().sqrt();
        p.iter_mut().for_each(|p| *p /= length);
        basis.push(p);
    }
    (0..window).map(|k| basis.iter().map(|p| p[at] * p[k]).sum()).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use measure::Ground;
    use space::Space;

    fn tracks(fixes: &[(i64, u32, f64, f64)], names: usize) -> Tracks<2> {
        let rows = Rows {
            frame: fixes.iter().map(|f| f.0).collect(),
            individual: fixes.iter().map(|f| f.1).collect(),
            position: [fixes.iter().map(|f| f.2).collect(), fixes.iter().map(|f| f.3).collect()],
            ..Rows::default()
        };
        let names = (0..names).map(|k| k.to_string()).collect();
        Tracks::new(rows, names, Clock::Rate(1.0), Ground::Plane(Space::open())).unwrap()
    }

    #[test]
    fn weights_are_those_of_the_tables() {
        // Savitzky and Golay (1964), table I: five points, quadratic
        let expected = [-3.0, 12.0, 17.0, 12.0, -3.0].map(|w| w / 35.0);
        let weights = savitzky_golay(5, 2, 2);
        assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-14), "{weights:?}");
        // seven points, quartic
        let expected = [5.0, -30.0, 75.0, 131.0, 75.0, -30.0, 5.0].map(|w| w / 231.0);
        let weights = savitzky_golay(7, 4, 3);
        assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-14), "{weights:?}");
    }

    #[test]
    fn a_parabola_stays_itself_when_smoothed() {
        let fixes: Vec<_> = (0..9).map(|k| (k, 0, (k * k) as f64, 3.0 - k as f64)).collect();
        let (smoothed, done) =
            clean(tracks(&fixes, 1), &Cleaning { smooth: Some((5, 2)), ..Cleaning::default() }).unwrap();
        assert_eq!(done.smoothed, (9, 0));
        for (row, fix) in fixes.iter().enumerate() {
            assert!(
                (smoothed.positions(0)[row] - fix.2).abs() < 1e-12
                    && (smoothed.positions(1)[row] - fix.3).abs() < 1e-12
            );
        }
        let (_, done) =
            clean(tracks(&fixes[..4], 1), &Cleaning { smooth: Some((5, 2)), ..Cleaning::default() }).unwrap();
        assert_eq!(done.smoothed, (0, 4));
    }

    #[test]
    fn short_gaps_are_filled_and_long_ones_left() {
        let fixes = [(0, 0, 0.0, 0.0), (3, 0, 3.0, 6.0), (9, 0, 9.0, 0.0), (0, 1, 5.0, 5.0), (1, 1, 5.0, 5.0)];
        let ask = Cleaning { interpolate: Some(2), ..Cleaning::default() };
        let (filled, done) = clean(tracks(&fixes, 2), &ask).unwrap();
        assert_eq!((done.filled, done.left), ((2, 1), 1));
        let at = filled.frames().iter().position(|&frame| frame == 2).unwrap();
        assert_eq!(filled.position(filled.row(at, 0).unwrap()).0, [2.0, 4.0]);
        assert_eq!(filled.len(), 7);
        assert_eq!(filled.times()[at], 2.0);
    }

    #[test]
    fn a_jump_there_and_back_is_one_flag() {
        let fixes: Vec<_> = (0..6).map(|k| (k, 0, if k == 3 { 100.0 } else { k as f64 }, 0.0)).collect();
        let ask = Cleaning { greatest_speed: Some(2.0), ..Cleaning::default() };
        let (flagged, done) = clean(tracks(&fixes, 1), &ask).unwrap();
        assert_eq!(done.flags, [(3, 3, Flag::ImpossibleSpeed)]);
        assert_eq!(without_flagged(&flagged, &done).unwrap().len(), 5);
    }

    #[test]
    fn velocities_that_are_told_stay_until_paths_are_smoothed() {
        let rows = Rows {
            frame: (0..6).collect(),
            individual: vec![0; 6],
            position: [vec![0.0, 1.0, 2.0, 90.0, 4.0, 5.0], vec![0.0; 6]],
            velocity: Some([vec![7.0; 6], vec![0.0; 6]]),
            body: None,
        };
        let told = Tracks::new(rows, vec!["a".into()], Clock::Rate(1.0), Ground::Plane(Space::open())).unwrap();
        let ask = Cleaning { greatest_speed: Some(2.0), ..Cleaning::default() };
        let (flagged, done) = clean(told.clone(), &ask).unwrap();
        let rest = without_flagged(&flagged, &done).unwrap();
        assert_eq!((flagged.velocities(0), rest.velocities(0)), (&[7.0; 6][..], &[7.0; 5][..]));
        let (smoothed, _) = clean(told, &Cleaning { smooth: Some((3, 1)), ..Cleaning::default() }).unwrap();
        assert!(!smoothed.tells_velocities() && smoothed.velocity(0).is_none());
    }

    #[test]
    fn who_goes_to_where_the_other_was_is_swapped() {
        let path = |k: i64, who: u32| {
            // they pass each other's places at frame 3
            let lane = if (k >= 3) == (who == 0) { 10.0 } else { 0.0 };
            (k, who, k as f64 * 0.1, lane)
        };
        let fixes: Vec<_> = (0..6).flat_map(|k| [path(k, 0), path(k, 1), (k, 2, 50.0, 0.5 * k as f64)]).collect();
        let (_, done) = clean(tracks(&fixes, 3), &Cleaning { swaps: true, ..Cleaning::default() }).unwrap();
        assert_eq!(done.flags, [(9, 3, Flag::IdentitySwap), (10, 3, Flag::IdentitySwap)]);
    }
}
