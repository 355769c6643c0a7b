//! The table of tracks: where individuals were, frame by frame.

use crate::ground::arrival;
use crate::{Ground, Sample};
use core::ops::Range;
use space::Vector;

/// Rows of tracks as a reader finds them, in any order: one for each individual in each frame.
///
/// A row whose position is not finite says that the individual was not found; its frame is kept.
#[derive(Clone, Debug)]
pub struct Rows<const D: usize> {
    /// Number of the frame as in the source, `[rows]`.
    pub frame: Vec<i64>,
    /// The individual, by its place in the list of names, `[rows]`.
    pub individual: Vec<u32>,
    /// Positions, `[D][rows]`: lengths, or longitude and latitude in degrees.
    pub position: [Vec<f64>; D],
    /// Velocities, `[D][rows]`, length/s (m/s east and north on the globe), NaN where unknown. Left out: by backward difference.
    pub velocity: Option<[Vec<f64>; D]>,
    /// Directions of the bodies, `[D][rows]`, of any length, NaN where unknown.
    pub body: Option<[Vec<f64>; D]>,
}

impl<const D: usize> Default for Rows<D> {
    fn default() -> Self {
        let position = core::array::from_fn(|_| Vec::new());
        Self { frame: Vec::new(), individual: Vec::new(), position, velocity: None, body: None }
    }
}

/// When frames were.
#[derive(Clone, Debug, PartialEq)]
pub enum Clock {
    /// So many frames a second: frame 0 is at 0 s.
    Rate(f64),
    /// The time (s) of each frame by its number, both ascending. Frames without rows may be among them.
    Stamps(Vec<(i64, f64)>),
}

/// Tracks: the positions of individuals, frame by frame.
///
/// Rows are sorted by frame, then by individual, and every row has a position. Numbers stand in one array per quantity and
/// axis. Of ten million rows in the plane they take 360 MB.
#[derive(Clone, Debug)]
pub struct Tracks<const D: usize> {
    ground: Ground<D>,
    names: Vec<String>,
    group_names: Vec<String>,
    group: Vec<u32>,
    frames: Vec<i64>,
    times: Vec<f64>,
    step: i64,
    first: Vec<usize>,
    individual: Vec<u32>,
    position: [Vec<f64>; D],
    velocity: [Vec<f64>; D],
    body: Option<[Vec<f64>; D]>,
    /// Whether the velocities were told; else they are differences.
    told: bool,
}

impl<const D: usize> Tracks<D> {
    /// Tracks of rows in any order.
    ///
    /// Where the rows tell no velocities, `v(t) = (x(t) - x(t-1)) / dt`, known where the individual has a position in the frame
    /// and in the one before (minimum image on periodic axes; on the globe the geodesic, in the direction in which it arrives).
    /// The frame before is the one whose number is less by [`Tracks::step`]: where frames are missing altogether, nothing
    /// is known of the first one after them.
    ///
    /// # Errors
    /// Columns of different lengths, an individual without a name, an individual twice in a frame, a frame without a
    /// time, times that do not ascend, a place that is not on the earth.
    pub fn new(rows: Rows<D>, names: Vec<String>, clock: Clock, ground: Ground<D>) -> Result<Self, TracksError> {
        let Rows { frame, individual, position, velocity, body } = rows;
        let count = frame.len();
        check_lengths(count, individual.len(), &position, velocity.as_ref(), body.as_ref())?;
        if let Some(row) = individual.iter().position(|&individual| individual as usize >= names.len()) {
            return Err(TracksError::Nameless { row, individual: individual[row], names: names.len() });
        }
        if ground == Ground::Globe && D != 2 {
            return Err(TracksError::Globe { dimensions: D });
        }
        let mut tracks = Self {
            ground,
            group: vec![0; names.len()],
            group_names: vec!["all".to_owned()],
            names,
            frames: Vec::new(),
            times: Vec::new(),
            step: 1,
            first: Vec::new(),
            individual,
            position,
            told: velocity.is_some(),
            velocity: velocity.unwrap_or_else(|| core::array::from_fn(|_| Vec::new())),
            body,
        };
        let frame = tracks.sort(frame);
        if let Some(k) =
            (1..count).find(|&k| (frame[k - 1], tracks.individual[k - 1]) == (frame[k], tracks.individual[k]))
        {
            let name = tracks.names[tracks.individual[k] as usize].clone();
            return Err(TracksError::Duplicate { frame: frame[k], individual: name });
        }
        tracks.index(&frame);
        tracks.set_times(&clock)?;
        if ground == Ground::Globe {
            tracks.check_places()?;
        }
        if tracks.velocity.iter().all(Vec::is_empty) {
            tracks.differentiate();
        }
        Ok(tracks)
    }

    /// The same tracks with their individuals in groups, `[individuals]` by place in the list of group names.
    ///
    /// # Errors
    /// Another number of individuals, or a group without a name.
    pub fn with_groups(mut self, group_names: Vec<String>, group: Vec<u32>) -> Result<Self, TracksError> {
        if group.len() != self.names.len() {
            let (found, expected) = (group.len(), self.names.len());
            return Err(TracksError::Length { column: "group", found, expected });
        }
        if let Some(k) = group.iter().position(|&group| group as usize >= group_names.len()) {
            return Err(TracksError::Nameless { row: k, individual: group[k], names: group_names.len() });
        }
        (self.group_names, self.group) = (group_names, group);
        Ok(self)
    }

    /// What positions are measured on.
    pub fn ground(&self) -> &Ground<D> {
        &self.ground
    }
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.individual.len()
    }
    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.individual.is_empty()
    }
    /// Names of the individuals, as in the source.
    pub fn names(&self) -> &[String] {
        &self.names
    }
    /// Names of the groups; one, `all`, where nothing was said.
    pub fn group_names(&self) -> &[String] {
        &self.group_names
    }
    /// The group of each individual, `[individuals]`.
    pub fn groups(&self) -> &[u32] {
        &self.group
    }
    /// Numbers of the frames as in the source, ascending, `[frames]`. A frame in which nobody was found has no rows.
    pub fn frames(&self) -> &[i64] {
        &self.frames
    }
    /// Times of the frames, s, ascending, `[frames]`.
    pub fn times(&self) -> &[f64] {
        &self.times
    }
    /// The usual step from one frame's number to the next: the least there is; 1 where there are not two frames.
    pub fn step(&self) -> i64 {
        self.step
    }
    /// Time (s) of the usual step: the median time between frames whose numbers differ by it. `None` where there are none.
    pub fn interval(&self) -> Option<f64> {
        let mut intervals: Vec<f64> = (1..self.frames.len()).filter_map(|f| self.interval_before(f)).collect();
        let middle = intervals.len() / 2;
        (!intervals.is_empty()).then(|| *intervals.select_nth_unstable_by(middle, f64::total_cmp).1)
    }
    /// Time (s) from the frame before to this frame (by its place in the list), where the frame before is there.
    pub fn interval_before(&self, frame: usize) -> Option<f64> {
        let before = frame.checked_sub(1)?;
        (self.frames[frame] - self.frames[before] == self.step).then(|| self.times[frame] - self.times[before])
    }
    /// The rows of a frame, by its place in the list.
    pub fn rows(&self, frame: usize) -> Range<usize> {
        self.first[frame]..self.first[frame + 1]
    }
    /// The individual of each row, `[rows]`; ascending within a frame.
    pub fn individuals(&self) -> &[u32] {
        &self.individual
    }
    /// Positions along an axis, `[rows]`.
    pub fn positions(&self, axis: usize) -> &[f64] {
        &self.position[axis]
    }
    /// Velocities along an axis, `[rows]`, NaN where unknown.
    pub fn velocities(&self, axis: usize) -> &[f64] {
        &self.velocity[axis]
    }
    /// Whether the rows told velocities; else they are differences of positions.
    pub fn tells_velocities(&self) -> bool {
        self.told
    }
    /// Whether directions of bodies were given.
    pub fn has_bodies(&self) -> bool {
        self.body.is_some()
    }
    /// Position of a row.
    pub fn position(&self, row: usize) -> Vector<f64, D> {
        Vector(core::array::from_fn(|a| self.position[a][row]))
    }
    /// Velocity of a row, where it is known.
    pub fn velocity(&self, row: usize) -> Option<Vector<f64, D>> {
        Some(Vector(core::array::from_fn(|a| self.velocity[a][row]))).filter(|v| v.finite())
    }
    /// Heading of a row: the unit vector of its velocity, where that is longer than 1e-12.
    pub fn heading(&self, row: usize) -> Option<Vector<f64, D>> {
        self.velocity(row).filter(|v| !v.is_tiny()).map(Vector::unit)
    }
    /// Direction of the body of a row, a unit vector, where it is known.
    pub fn body(&self, row: usize) -> Option<Vector<f64, D>> {
        let body = self.body.as_ref()?;
        let along = Vector(core::array::from_fn(|a| body[a][row]));
        Some(along).filter(|along| along.finite() && !along.is_tiny()).map(Vector::unit)
    }
    /// The row of an individual in a frame (by its place in the list), where it was found.
    pub fn row(&self, frame: usize, individual: u32) -> Option<usize> {
        let rows = self.rows(frame);
        self.individual[rows.clone()].binary_search(&individual).ok().map(|k| rows.start + k)
    }
    /// The offset from one place to another: by minimum image in the plane; on the globe m east and north, as long as the geodesic.
    pub fn offset(&self, from: Vector<f64, D>, to: Vector<f64, D>) -> Vector<f64, D> {
        match self.ground {
            Ground::Plane(space) => space.offset(from, to),
            Ground::Globe => Vector::of(&arrival([from.0[0], from.0[1]], [to.0[0], to.0[1]]).0),
        }
    }

    /// The members of a frame (by its place in the list), in the order of individuals, for metrics of frames.
    pub fn sample(&self, frame: usize) -> Sample<D> {
        let mut sample = Sample::empty();
        self.sample_into(frame, &mut sample);
        sample
    }
    /// As [`Tracks::sample`], into a sample whose memory is used again.
    pub fn sample_into(&self, frame: usize, sample: &mut Sample<D>) {
        self.sample_of(frame, |_| true, sample);
    }
    /// As [`Tracks::sample_into`], of some individuals only.
    pub fn sample_of(&self, frame: usize, keep: impl Fn(u32) -> bool, sample: &mut Sample<D>) {
        let rows = self.rows(frame).filter(|&row| keep(self.individual[row]));
        let nowhere = Vector([f64::NAN; D]);
        let member = |row| {
            let body = if self.body.is_some() { self.body(row) } else { None };
            (self.position(row), self.velocity(row).unwrap_or(nowhere), body)
        };
        sample.fill(&self.ground, rows.map(member));
    }

    /// The rows of each individual, in the order of frames.
    pub fn paths(&self) -> Paths {
        let mut first = vec![0usize; self.names.len() + 1];
        for &individual in &self.individual {
            first[individual as usize + 1] += 1;
        }
        for k in 1..first.len() {
            first[k] += first[k - 1];
        }
        let mut to = first.clone();
        let (mut row_of, mut frame_of) = (vec![0; self.len()], vec![0; self.len()]);
        for frame in 0..self.frames.len() {
            for row in self.rows(frame) {
                let place = &mut to[self.individual[row] as usize];
                (row_of[*place], frame_of[*place]) = (row as u32, frame as u32);
                *place += 1;
            }
        }
        Paths { first, rows: row_of, frames: frame_of }
    }

    /// Sorts the rows by frame, then by individual, one column at a time; returns the frames in that order.
    fn sort(&mut self, frame: Vec<i64>) -> Vec<i64> {
        let key = |row: usize| (frame[row], self.individual[row]);
        if (1..frame.len()).all(|row| key(row - 1) <= key(row)) {
            return frame;
        }
        let mut order: Vec<usize> = (0..frame.len()).collect();
        order.sort_unstable_by_key(|&row| key(row));
        let arrange = |column: &mut Vec<f64>| {
            if !column.is_empty() {
                *column = order.iter().map(|&row| column[row]).collect();
            }
        };
        self.individual = order.iter().map(|&row| self.individual[row]).collect();
        self.position.iter_mut().chain(&mut self.velocity).chain(self.body.iter_mut().flatten()).for_each(arrange);
        order.iter().map(|&row| frame[row]).collect()
    }

    /// Lists the frames, and leaves out rows without a position.
    fn index(&mut self, frame: &[i64]) {
        let mut kept = 0;
        for row in 0..frame.len() {
            if self.frames.last() != Some(&frame[row]) {
                self.frames.push(frame[row]);
                self.first.push(kept);
            }
            if !self.position.iter().all(|axis| axis[row].is_finite()) {
                continue;
            }
            self.individual[kept] = self.individual[row];
            let columns = self.position.iter_mut().chain(&mut self.velocity).chain(self.body.iter_mut().flatten());
            columns.filter(|column| !column.is_empty()).for_each(|column| column[kept] = column[row]);
            kept += 1;
        }
        self.first.push(kept);
        self.individual.truncate(kept);
        let columns = self.position.iter_mut().chain(&mut self.velocity).chain(self.body.iter_mut().flatten());
        columns.for_each(|column| column.truncate(kept));
        self.step = self.frames.windows(2).map(|pair| pair[1] - pair[0]).min().unwrap_or(1);
    }

    /// Gives each frame its time.
    fn set_times(&mut self, clock: &Clock) -> Result<(), TracksError> {
        let times = match clock {
            Clock::Rate(rate) => {
                if !(rate.is_finite() && *rate > 0.0) {
                    return Err(TracksError::Rate { found: *rate });
                }
                self.frames.iter().map(|&frame| frame as f64 / rate).collect()
            }
            Clock::Stamps(stamps) => {
                let time = |&frame: &i64| {
                    let place = stamps.binary_search_by_key(&frame, |stamp| stamp.0);
                    place.map(|k| stamps[k].1).map_err(|_| TracksError::Timeless { frame })
                };
                self.frames.iter().map(time).collect::<Result<Vec<f64>, _>>()?
            }
        };
        let ascends = |k: &usize| times[*k].is_finite() && (*k == 0 || times[*k - 1] < times[*k]);
        if let Some(k) = (0..times.len()).find(|k| !ascends(k)) {
            return Err(TracksError::Time { frame: self.frames[k], found: times[k] });
        }
        self.times = times;
        Ok(())
    }

    /// Refuses places that are not on the earth.
    fn check_places(&self) -> Result<(), TracksError> {
        for frame in 0..self.frames.len() {
            for row in self.rows(frame) {
                let [longitude, latitude] = [self.position[0][row], self.position[1][row]];
                if latitude.abs() > 90.0 || longitude.abs() > 540.0 {
                    let individual = self.names[self.individual[row] as usize].clone();
                    return Err(TracksError::Place { frame: self.frames[frame], individual, longitude, latitude });
                }
            }
        }
        Ok(())
    }

    /// Velocities by backward difference.
    fn differentiate(&mut self) {
        let mut velocity: [Vec<f64>; D] = core::array::from_fn(|_| vec![f64::NAN; self.len()]);
        // the row of each individual in the frame before
        let mut before: Vec<Option<usize>> = vec![None; self.names.len()];
        for frame in 0..self.frames.len() {
            if let Some(dt) = self.interval_before(frame) {
                for row in self.rows(frame) {
                    if let Some(old) = before[self.individual[row] as usize] {
                        let v = self.offset(self.position(old), self.position(row)) / dt;
                        (0..D).for_each(|a| velocity[a][row] = v.0[a]);
                    }
                }
            }
            if frame > 0 {
                self.rows(frame - 1).for_each(|row| before[self.individual[row] as usize] = None);
            }
            self.rows(frame).for_each(|row| before[self.individual[row] as usize] = Some(row));
        }
        self.velocity = velocity;
    }
}

/// The rows of tracks by individual; see [`Tracks::paths`].
#[derive(Clone, Debug)]
pub struct Paths {
    first: Vec<usize>,
    rows: Vec<u32>,
    frames: Vec<u32>,
}

impl Paths {
    /// Number of individuals.
    pub fn len(&self) -> usize {
        self.first.len() - 1
    }
    /// Whether there are no individuals.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// Place of the frame in the list, and row, of each position of an individual, in the order of frames.
    pub fn of(&self, individual: usize) -> impl ExactSizeIterator<Item = (usize, usize)> + Clone {
        let range = self.first[individual]..self.first[individual + 1];
        range.map(|k| (self.frames[k] as usize, self.rows[k] as usize))
    }
}

fn check_lengths<const D: usize>(
    expected: usize,
    individuals: usize,
    position: &[Vec<f64>; D],
    velocity: Option<&[Vec<f64>; D]>,
    body: Option<&[Vec<f64>; D]>,
) -> Result<(), TracksError> {
    if u32::try_from(expected).is_err() {
        return Err(TracksError::Many { rows: expected });
    }
    let lengths = |column: &'static str, columns: &[Vec<f64>; D]| columns.each_ref().map(|c| (column, c.len()));
    let given = core::iter::once(("individual", individuals))
        .chain(lengths("position", position))
        .chain(velocity.into_iter().flat_map(|columns| lengths("velocity", columns)))
        .chain(body.into_iter().flat_map(|columns| lengths("body", columns)));
    for (column, found) in given {
        if found != expected {
            return Err(TracksError::Length { column, found, expected });
        }
    }
    Ok(())
}

/// Why rows are no tracks.
#[derive(Clone, Debug, PartialEq)]
pub enum TracksError {
    /// A column does not have as many numbers as there are rows.
    Length {
        /// The column.
        column: &'static str,
        /// Its length.
        found: usize,
        /// The number of rows.
        expected: usize,
    },
    /// More rows than can be told apart.
    Many {
        /// How many.
        rows: usize,
    },
    /// A row belongs to an individual (or an individual to a group) beyond the list of names.
    Nameless {
        /// The row (or the individual).
        row: usize,
        /// The number given.
        individual: u32,
        /// Length of the list.
        names: usize,
    },
    /// An individual has two rows in one frame.
    Duplicate {
        /// Number of the frame.
        frame: i64,
        /// Name of the individual.
        individual: String,
    },
    /// Frames a second that are not a finite number above zero.
    Rate {
        /// The number given.
        found: f64,
    },
    /// A frame has no time.
    Timeless {
        /// Number of the frame.
        frame: i64,
    },
    /// A time is not finite, or not after the one before.
    Time {
        /// Number of the frame.
        frame: i64,
        /// Its time.
        found: f64,
    },
    /// Longitude and latitude in other than two dimensions.
    Globe {
        /// The dimensions.
        dimensions: usize,
    },
    /// A longitude or latitude that does not exist.
    Place {
        /// Number of the frame.
        frame: i64,
        /// Name of the individual.
        individual: String,
        /// Degrees east.
        longitude: f64,
        /// Degrees north.
        latitude: f64,
    },
}

impl core::fmt::Display for TracksError {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Length { column, found, expected } => {
                write!(out, "the column of `{column}` has {found} numbers for {expected} rows")
            }
            Self::Many { rows } => write!(out, "{rows} rows are more than {}", u32::MAX),
            Self::Nameless { row, individual, names } => {
                write!(out, "row {row} is of number {individual}, but there are {names} names")
            }
            Self::Duplicate { frame, individual } => {
                write!(out, "individual `{individual}` is twice in frame {frame}")
            }
            Self::Rate { found } => write!(out, "frames a second must be a number above 0, found {found}"),
            Self::Timeless { frame } => write!(out, "frame {frame} has no time"),
            Self::Time { frame, found } => {
                write!(out, "the time of frame {frame}, {found} s, must be a number after that of the frame before")
            }
            Self::Globe { dimensions } => {
                write!(out, "longitude and latitude need two dimensions, found {dimensions}")
            }
            Self::Place { frame, individual, longitude, latitude } => write!(
                out,
                "individual `{individual}` in frame {frame} is at longitude {longitude}, latitude {latitude}: not on the earth"
            ),
        }
    }
}
impl core::error::Error for TracksError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Counted, metrics, per_frame};
    use space::Space;
    use space::parallel::Workers;

    /// Rows of (frame, individual, x).
    fn rows(rows: &[(i64, u32, f64)]) -> Rows<1> {
        Rows {
            frame: rows.iter().map(|row| row.0).collect(),
            individual: rows.iter().map(|row| row.1).collect(),
            position: [rows.iter().map(|row| row.2).collect()],
            ..Rows::default()
        }
    }
    fn names(count: usize) -> Vec<String> {
        (0..count).map(|k| format!("fish {k}")).collect()
    }
    fn open() -> Ground<1> {
        Ground::Plane(Space::open())
    }

    #[test]
    fn rows_in_any_order_become_one_table() -> Result<(), TracksError> {
        let given = rows(&[(7, 1, 5.0), (5, 0, 1.0), (6, 1, 4.0), (5, 1, 3.0), (6, 0, f64::NAN), (7, 0, 2.0)]);
        let tracks = Tracks::new(given, names(2), Clock::Rate(10.0), open())?;
        assert_eq!(tracks.frames(), [5, 6, 7]);
        assert_eq!(tracks.times(), [0.5, 0.6, 0.7]);
        assert_eq!((0..3).map(|f| tracks.rows(f)).collect::<Vec<_>>(), [0..2, 2..3, 3..5]);
        assert_eq!(tracks.individuals(), [0, 1, 1, 0, 1]);
        assert_eq!(tracks.positions(0), [1.0, 3.0, 4.0, 2.0, 5.0]);
        // known where the individual was found in the frame before
        let known: Vec<bool> = (0..5).map(|row| tracks.velocity(row).is_some()).collect();
        assert_eq!(known, [false, false, true, false, true]);
        assert!((tracks.velocities(0)[2] - 10.0).abs() < 1e-12);
        assert_eq!(tracks.row(1, 0), None);
        assert_eq!(tracks.row(2, 1), Some(4));
        let paths = tracks.paths();
        assert_eq!(Vec::from_iter(paths.of(0)), [(0, 0), (2, 3)]);
        assert_eq!(Vec::from_iter(paths.of(1)), [(0, 1), (1, 2), (2, 4)]);
        assert!(tracks.interval().is_some_and(|dt| (dt - 0.1).abs() < 1e-12));
        Ok(())
    }

    #[test]
    fn nothing_is_known_after_missing_frames_and_frames_without_anyone_stay() -> Result<(), TracksError> {
        let given = rows(&[(0, 0, 0.0), (2, 0, 1.0), (6, 0, 2.0), (8, 0, 9.0), (10, 0, f64::NAN)]);
        let clock = Clock::Stamps(vec![(0, 0.0), (2, 0.5), (6, 3.0), (8, 4.0), (10, 5.0)]);
        let tracks = Tracks::new(given, names(1), clock, open())?;
        assert_eq!(tracks.step(), 2);
        let velocities: Vec<Option<f64>> = (0..4).map(|row| tracks.velocity(row).map(|v| v[0])).collect();
        assert_eq!(velocities, [None, Some(2.0), None, Some(7.0)]);
        assert_eq!(tracks.rows(4), 4..4);
        assert!(tracks.sample(4).is_empty());
        Ok(())
    }

    #[test]
    fn what_was_given_is_kept_and_sorted_along() -> Result<(), TracksError> {
        let mut given = rows(&[(1, 0, 8.0), (0, 0, 9.5)]);
        given.velocity = Some([vec![3.0, f64::NAN]]);
        given.body = Some([vec![-2.0, 0.0]]);
        let ring = Ground::Plane(Space::periodic([10.0]));
        let tracks = Tracks::new(given.clone(), names(1), Clock::Rate(1.0), ring)?;
        assert_eq!(tracks.velocity(0), None);
        assert_eq!(tracks.velocity(1), Some(Vector([3.0])));
        assert_eq!(tracks.body(0), None);
        assert_eq!(tracks.body(1), Some(Vector([-1.0])));
        assert_eq!(tracks.sample(1).count(Counted::Bodies), 1);
        given.velocity = None;
        given.position = [vec![0.5, 9.5]];
        let tracks = Tracks::new(given, names(1), Clock::Rate(1.0), ring)?;
        assert_eq!(tracks.velocity(1), Some(Vector([1.0])), "across the seam");
        let grouped = tracks.clone().with_groups(vec!["a".into(), "b".into()], vec![1]);
        assert!(grouped.is_ok_and(|grouped| grouped.groups() == [1]));
        assert!(tracks.with_groups(vec!["a".into()], vec![1]).is_err());
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_named() -> Result<(), TracksError> {
        let fails = |rows: Rows<1>, clock: Clock| {
            Tracks::new(rows, names(2), clock, open()).map(drop).map_err(|error| error.to_string())
        };
        let rate = || Clock::Rate(25.0);
        let twice = rows(&[(4, 1, 0.0), (4, 0, 0.0), (4, 1, 1.0)]);
        assert_eq!(fails(twice, rate()), Err("individual `fish 1` is twice in frame 4".into()));
        assert_eq!(fails(rows(&[(4, 2, 0.0)]), rate()), Err("row 0 is of number 2, but there are 2 names".into()));
        assert!(fails(rows(&[(4, 0, 0.0)]), Clock::Rate(0.0)).is_err_and(|e| e.contains("above 0")));
        let stamps = Clock::Stamps(vec![(1, 2.0), (2, 2.0)]);
        assert!(fails(rows(&[(1, 0, 0.0), (3, 0, 0.0)]), stamps.clone()).is_err_and(|e| e == "frame 3 has no time"));
        assert!(fails(rows(&[(1, 0, 0.0), (2, 0, 0.0)]), stamps).is_err_and(|e| e.contains("frame 2")));
        let mut short = rows(&[(1, 0, 0.0)]);
        short.velocity = Some([Vec::new()]);
        assert!(fails(short, rate()).is_err_and(|e| e.contains("`velocity` has 0 numbers for 1 rows")));
        let globe = Tracks::<1>::new(rows(&[]), names(2), rate(), Ground::Globe);
        assert_eq!(globe.map(drop), Err(TracksError::Globe { dimensions: 1 }));
        let far = Rows { frame: vec![0], individual: vec![0], position: [vec![0.0], vec![91.0]], ..Rows::default() };
        assert!(Tracks::<2>::new(far, names(1), rate(), Ground::Globe).is_err());
        let empty = Tracks::new(rows(&[]), names(0), rate(), open())?;
        assert!(
            empty.is_empty() && empty.frames().is_empty() && empty.interval().is_none() && empty.paths().is_empty()
        );
        Ok(())
    }

    #[test]
    fn on_the_globe_lengths_are_metres() -> Result<(), TracksError> {
        let position = [vec![36.0, 36.0, 36.001, 36.0], vec![0.5, 0.5, 0.5, 0.501]];
        let given = Rows { frame: vec![0, 1, 0, 1], individual: vec![0, 0, 1, 1], position, ..Rows::default() };
        let tracks = Tracks::<2>::new(given, names(2), Clock::Rate(2.0), Ground::Globe)?;
        let sample = tracks.sample(0);
        let apart = crate::ground::geodesic([36.0, 0.5], [36.001, 0.5]);
        assert_eq!(sample.distance(0, 1), apart);
        let plane = (sample.positions()[0] - sample.positions()[1]).length();
        assert!((plane / apart - 1.0).abs() < 1e-9);
        // 111.3 m west and 110.6 m north in half a second
        let v = tracks.velocity(tracks.row(1, 1).unwrap_or(0)).unwrap_or(Vector::ZERO);
        assert!((-222.8..-222.4).contains(&v[0]) && (221.0..221.3).contains(&v[1]), "{v:?}");
        assert_eq!(tracks.velocity(tracks.row(1, 0).unwrap_or(0)), Some(Vector::ZERO));
        Ok(())
    }

    #[test]
    fn metrics_frame_by_frame_are_the_same_for_any_number_of_threads() -> Result<(), TracksError> {
        let count = 150;
        let mut given = Rows::<2>::default();
        for frame in 0..count {
            for individual in 0..7u32 {
                let angle = f64::from(individual) + 0.1 * frame as f64;
                given.frame.push(frame);
                given.individual.push(individual);
                given.position[0].push(angle.cos() * f64::from(individual));
                given.position[1].push(if (frame + i64::from(individual)) % 11 == 0 { f64::NAN } else { angle.sin() });
            }
        }
        let ground = Ground::Plane(Space::open());
        let tracks = Tracks::new(given, names(7), Clock::Rate(5.0), ground)?;
        let metrics = metrics::all::<2>();
        let bits =
            |table: &crate::PerFrame| table.values.iter().flatten().map(|value| value.to_bits()).collect::<Vec<_>>();
        let one = per_frame(&tracks, &metrics, &Workers::new(1));
        assert_eq!(one.positions.len(), count as usize);
        for threads in [2, 3] {
            let many = per_frame(&tracks, &metrics, &Workers::new(threads));
            assert_eq!(bits(&one), bits(&many));
            assert_eq!(one.counts(Counted::Headings), many.counts(Counted::Headings));
        }
        for (frame, metric) in [(0, 0), (77, 4), (149, 8)] {
            let alone = metrics[metric].on(&tracks.sample(frame)).unwrap_or(f64::NAN);
            assert_eq!(alone.to_bits(), one.values[metric][frame].to_bits());
        }
        Ok(())
    }
}
