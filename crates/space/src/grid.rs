//! The neighbour index: agents sorted into cells, so that whoever is near lies near in memory.
//!
//! Cells are numbered row by row: the first axis runs fastest and is cut finer than the others. Inside a cell agents stand by id.
//! **Canonical order**: the others around an agent are met row by row in increasing (unwrapped) cell
//! coordinates, inside a cell by id. That order follows from the state alone, so a sum taken in it has the same
//! bits for any number of threads, any vector width, and after any restart.

use crate::frame::{Columns, PADDING};
use crate::parallel::{Shared, Workers};
use crate::{Edge, Real, Space, Vector};

/// Cells are this much larger than the reach, so that rounding never puts a neighbour outside the cells searched.
const MARGIN: f64 = 1.0 + 1e-4;

/// A run of consecutive rows to be met, displaced by `shift` (a multiple of the periods).
#[derive(Clone, Copy, Debug)]
pub struct Segment<R, const D: usize> {
    /// First row.
    pub first: u32,
    /// Row after the last.
    pub end: u32,
    /// To be added to the positions of these rows.
    pub shift: Vector<R, D>,
}

/// Cells per axis and how positions fall into them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layout<R, const D: usize> {
    low: [R; D],
    per_length: [R; D],
    cells: [usize; D],
    /// How many cells away a neighbour can be, per axis.
    span: [usize; D],
    period: [Option<R>; D],
}

impl<R: Real, const D: usize> Layout<R, D> {
    /// `None` where cells would not help: a period shorter than the cells that have to be searched.
    ///
    /// The first axis is cut finer, to about one agent a cell, but at most `finest` times.
    fn new(
        space: &Space<R, D>,
        reach: R,
        agents: usize,
        low: Vector<R, D>,
        high: Vector<R, D>,
        finest: f64,
    ) -> Option<Self> {
        let reach = reach.to_f64() * MARGIN;
        if !(reach > 0.0 && reach.is_finite()) {
            return None;
        }
        let mut extent = [0.0; D];
        let mut start = [R::ZERO; D];
        for a in 0..D {
            match space.side(a) {
                Some(side) => extent[a] = side.to_f64(),
                None => {
                    start[a] = low.0[a];
                    extent[a] = (high.0[a].to_f64() - low.0[a].to_f64()).max(0.0);
                }
            }
        }
        // at most two cells of reach size per agent: far-flung agents get larger cells instead of more of them
        let allowed = (2 * agents + 64) as f64;
        let mut size = reach;
        while (0..D).map(|a| (extent[a] / size).floor().max(1.0)).product::<f64>() > allowed {
            size *= 1.25;
        }
        let mut layout =
            Self { low: start, per_length: [R::ZERO; D], cells: [1; D], span: [1; D], period: space.periods() };
        let coarse: f64 = (0..D).map(|a| (extent[a] / size).floor().max(1.0)).product();
        for a in 0..D {
            let finer = if a == 0 { (agents as f64 / coarse).round().clamp(1.0, finest) } else { 1.0 };
            let mut cells = (extent[a] * finer / size).floor().max(1.0);
            let mut span = (reach * cells / extent[a].max(f64::MIN_POSITIVE)).ceil();
            if extent[a] == 0.0 || !span.is_finite() {
                (cells, span) = (1.0, 1.0);
            }
            if layout.period[a].is_some() && cells < 2.0 * span + 1.0 {
                return None;
            }
            layout.cells[a] = cells as usize;
            // no farther than there are cells, however small the box is beside the reach
            layout.span[a] = span.min(cells) as usize;
            layout.per_length[a] = if extent[a] > 0.0 { R::of(cells / extent[a]) } else { R::ZERO };
        }
        Some(layout)
    }
    #[inline(always)]
    fn coordinate(&self, axis: usize, x: R) -> usize {
        let cell = ((x - self.low[axis]) * self.per_length[axis]).index();
        cell.min(self.cells[axis] - 1)
    }
    #[inline(always)]
    fn cell(&self, position: Vector<R, D>) -> usize {
        let (line, along) = self.line_and_cell(position);
        line * self.cells[0] + along
    }
    /// The line of cells in which a place lies, and the cell in it.
    #[inline(always)]
    fn line_and_cell(&self, position: Vector<R, D>) -> (usize, usize) {
        let mut line = 0;
        for a in (1..D).rev() {
            line = line * self.cells[a] + self.coordinate(a, position.0[a]);
        }
        (line, self.coordinate(0, position.0[0]))
    }
    /// The lines of cells around a place, in canonical order, with their shift.
    #[inline(always)]
    fn each_line(&self, centre: [usize; D], span: [usize; D], mut visit: impl FnMut(usize, Vector<R, D>)) {
        let l = self;
        let mut step = [0isize; D];
        for a in 1..D {
            step[a] = -(span[a] as isize);
        }
        'lines: loop {
            let mut line = 0usize;
            let mut shift = Vector::ZERO;
            let mut inside = true;
            for a in (1..D).rev() {
                let cells = l.cells[a] as isize;
                let mut c = centre[a] as isize + step[a];
                if c < 0 || c >= cells {
                    match l.period[a] {
                        Some(period) if c < 0 => {
                            c += cells;
                            shift.0[a] = -period;
                        }
                        Some(period) => {
                            c -= cells;
                            shift.0[a] = period;
                        }
                        None => inside = false,
                    }
                }
                if inside {
                    line = line * l.cells[a] + c as usize;
                }
            }
            if inside {
                visit(line, shift);
            }
            for a in 1..D {
                step[a] += 1;
                if step[a] <= span[a] as isize {
                    continue 'lines;
                }
                step[a] = -(span[a] as isize);
            }
            return;
        }
    }
    /// The cell of a place and how many cells away to look for a radius; `None` where that closes on itself.
    #[inline(always)]
    fn search(&self, place: Vector<R, D>, radius: R) -> Option<([usize; D], [usize; D])> {
        let wide = R::of(radius.to_f64() * MARGIN);
        let (mut centre, mut span) = ([0usize; D], [0usize; D]);
        for a in 0..D {
            let cells = (wide * self.per_length[a]).ceil();
            span[a] = if cells.finite() { cells.index().clamp(1, self.cells[a]) } else { self.cells[a] };
            if self.period[a].is_some() && self.cells[a] < 2 * span[a] + 1 {
                return None;
            }
            centre[a] = self.coordinate(a, place.0[a]);
        }
        Some((centre, span))
    }
    /// The part of a line from cell `low` to cell `high` (unwrapped) as runs of cells of that line, each with the shift of its rows.
    #[inline(always)]
    fn runs(
        &self,
        low: isize,
        high: isize,
        shift: Vector<R, D>,
        mut visit: impl FnMut(core::ops::Range<usize>, Vector<R, D>),
    ) {
        let cells = self.cells[0] as isize;
        let mut part = |from: isize, to: isize, by: R| {
            let mut shift = shift;
            shift.0[0] = by;
            visit(from as usize..to as usize + 1, shift);
        };
        match self.period[0] {
            Some(period) => {
                if low < 0 {
                    part(low + cells, cells - 1, -period);
                }
                part(low.max(0), high.min(cells - 1), R::ZERO);
                if high >= cells {
                    part(0, high - cells, period);
                }
            }
            None => part(low.max(0), high.min(cells - 1), R::ZERO),
        }
    }
    /// The runs of cells around a place, in canonical order: their line, the cells in it, and the shift of their rows.
    #[inline(always)]
    fn each_run(
        &self,
        centre: [usize; D],
        span: [usize; D],
        mut visit: impl FnMut(usize, core::ops::Range<usize>, Vector<R, D>),
    ) {
        let (low, high) = (centre[0] as isize - span[0] as isize, centre[0] as isize + span[0] as isize);
        self.each_line(centre, span, |line, shift| {
            self.runs(low, high, shift, |cells, shift| visit(line, cells, shift));
        });
    }
    fn total(&self) -> usize {
        self.cells.iter().product()
    }
}

/// The sorted index over [`Columns`].
#[derive(Clone, Debug)]
pub struct Grid<R, const D: usize> {
    layout: Layout<R, D>,
    /// First row of each cell, and the number of agents at the end.
    first: Vec<u32>,
    /// Cell of each row before the sort.
    key: Vec<u32>,
    /// The rows before the sort, in the order after it.
    order: Vec<u32>,
    /// First cell of each part of the sort, and the number of cells at the end.
    bound: Vec<usize>,
    /// Rows of each part's share that stand in cells of other parts.
    strangers: Vec<Vec<u32>>,
    /// Number of agents in each part's cells.
    total: Vec<u32>,
}

impl<R: Real, const D: usize> Grid<R, D> {
    /// Sorts `from` into `to` by cell, and by id inside a cell. Returns `None`, with `to` untouched, where a grid cannot serve this
    /// reach in this space. Buffers of an earlier grid are reused.
    pub fn sort(
        earlier: Option<Self>,
        space: &Space<R, D>,
        reach: R,
        from: &Columns<R, D>,
        to: &mut Columns<R, D>,
        workers: &Workers,
    ) -> Option<Self> {
        let agents = from.len();
        let (low, high) = if space.edges.iter().any(|e| matches!(e, Edge::Open)) {
            bounds(from)
        } else {
            (Vector::ZERO, Vector::ZERO)
        };
        let layout = Layout::new(space, reach, agents, low, high, if D < 3 { 4.0 } else { 2.0 })?;
        let mut grid = earlier.unwrap_or(Self {
            layout,
            first: Vec::new(),
            key: Vec::new(),
            order: Vec::new(),
            bound: Vec::new(),
            strangers: Vec::new(),
            total: Vec::new(),
        });
        grid.layout = layout;
        grid.count(from, workers);
        grid.permute(from, to, workers);
        Some(grid)
    }

    /// Counting sort of the rows by cell into `order`.
    ///
    /// Each part owns a share of the rows as they stand, and the cells that these begin and end with: whoever has not moved far is
    /// counted and placed by the part itself, and only the few strangers in another part's cells are handed over.
    fn count(&mut self, from: &Columns<R, D>, workers: &Workers) {
        let (agents, cells) = (from.len(), self.layout.total());
        let parts = if workers.threads() == 1 { 1 } else { 4 * workers.threads() };
        let layout = &self.layout;
        let share = |part: usize| (agents * part / parts)..(agents * (part + 1) / parts);
        self.first.resize(cells + 1, 0);
        self.key.resize(agents, 0);
        self.order.resize(agents, 0);
        self.strangers.resize_with(parts, Vec::new);
        self.total.resize(parts, 0);
        self.bound.clear();
        self.bound.push(0);
        for part in 1..parts {
            let row = share(part).start;
            let cell = if row < agents { layout.cell(from.position(row)) } else { 0 };
            self.bound.push(cell.max(self.bound[part - 1]));
        }
        self.bound.push(cells);
        let bound = &self.bound;
        let own = |part: usize| bound[part]..bound[part + 1];
        let first = Shared::new(&mut self.first[..cells]);
        let total = Shared::new(&mut self.total);
        {
            let key = Shared::new(&mut self.key);
            let strangers = Shared::new(&mut self.strangers);
            workers.each(parts, |_, part| {
                let (own, rows) = (own(part), share(part));
                // SAFETY: each part writes its own cells, its own rows' keys, its own list and its own total.
                let (count, keys) = unsafe { (first.part(own.clone()), key.part(rows.clone())) };
                // SAFETY: as above.
                let strangers = unsafe { &mut strangers.part(part..part + 1)[0] };
                strangers.clear();
                count.fill(0);
                for (key, row) in keys.iter_mut().zip(rows.clone()) {
                    let cell = layout.cell(from.position(row));
                    *key = cell as u32;
                    match count.get_mut(cell.wrapping_sub(own.start)) {
                        Some(count) => *count += 1,
                        None => strangers.push(row as u32),
                    }
                }
                // SAFETY: as above.
                unsafe { total.write(part, (rows.len() - strangers.len()) as u32) };
            });
        }
        let (key, strangers) = (&self.key, &self.strangers);
        if parts > 1 {
            workers.each(parts, |_, part| {
                let own = own(part);
                // SAFETY: each part writes its own cells and its own total.
                let (count, total) = unsafe { (first.part(own.clone()), &mut total.part(part..part + 1)[0]) };
                for &row in strangers.iter().flatten() {
                    if let Some(count) = count.get_mut((key[row as usize] as usize).wrapping_sub(own.start)) {
                        *count += 1;
                        *total += 1;
                    }
                }
            });
        }
        let order = Shared::new(&mut self.order);
        let total = &self.total;
        workers.each(parts, |_, part| {
            let own = own(part);
            // SAFETY: each part writes its own cells.
            let first = unsafe { first.part(own.clone()) };
            // every cell's end, which becomes its beginning as the rows are placed from the last to the first
            let mut end: u32 = total[..part].iter().sum();
            for cell in first.iter_mut() {
                end += *cell;
                *cell = end;
            }
            let mut place = |row: usize| {
                if let Some(first) = first.get_mut((key[row] as usize).wrapping_sub(own.start)) {
                    *first -= 1;
                    // SAFETY: the places of each part's cells are handed out once, by it.
                    unsafe { order.write(*first as usize, row as u32) };
                }
            };
            share(part).rev().for_each(&mut place);
            strangers.iter().flatten().for_each(|&row| place(row as usize));
        });
        self.first[cells] = agents as u32;
    }

    /// Puts each cell's rows in the order of their ids and copies the columns.
    fn permute(&mut self, from: &Columns<R, D>, to: &mut Columns<R, D>, workers: &Workers) {
        let (agents, cells) = (from.len(), self.layout.total());
        // a few thousand rows at a time stay in the cache for all columns
        let tasks = (agents / 4096).max(workers.threads() * 4).min(cells);
        let (first, key) = (&self.first, &self.key);
        let order = Shared::new(&mut self.order);
        let id = Shared::new(&mut to.id);
        let position = to.position.each_mut().map(|c| Shared::new(c));
        let velocity = to.velocity.each_mut().map(|c| Shared::new(c));
        let state: Vec<_> = to.state.iter_mut().map(|c| Shared::new(c)).collect();
        workers.each(tasks, |_, task| {
            let range = (cells * task / tasks)..(cells * (task + 1) / tasks);
            let rows = first[range.start] as usize..first[range.end] as usize;
            debug_assert!(rows.end <= agents);
            // SAFETY: tasks own disjoint ranges of cells and therefore of rows.
            let (order, id) = unsafe { (order.part(rows.clone()), id.part(rows.clone())) };
            for (id, &row) in id.iter_mut().zip(order.iter()) {
                *id = from.id[row as usize];
            }
            // few move to another cell in a step, so most cells are in order already
            let mut k = 1;
            while k < order.len() {
                let cell = key[order[k] as usize];
                if cell == key[order[k - 1] as usize] && id[k] < id[k - 1] {
                    let cell = cell as usize;
                    let members = (first[cell] as usize - rows.start)..(first[cell + 1] as usize - rows.start);
                    k = members.end;
                    sort_by_id(&mut order[members.clone()], &from.id);
                    for member in members {
                        id[member] = from.id[order[member] as usize];
                    }
                }
                k += 1;
            }
            let copy = |from: &[R], to: &Shared<'_, R>| {
                // SAFETY: as above.
                let to = unsafe { to.part(rows.clone()) };
                for (place, &row) in to.iter_mut().zip(order.iter()) {
                    *place = from[row as usize];
                }
            };
            for a in 0..D {
                copy(&from.position[a], &position[a]);
                copy(&from.velocity[a], &velocity[a]);
            }
            for (from, to) in from.state.iter().zip(&state) {
                copy(from, to);
            }
        });
    }

    /// Number of lines of cells: the product of the cells along all axes but the first.
    #[inline(always)]
    pub fn lines(&self) -> usize {
        self.first.len().saturating_sub(1) / self.layout.cells[0]
    }
    /// Rows of agents in a line of cells.
    #[inline(always)]
    pub fn line(&self, line: usize) -> core::ops::Range<usize> {
        let width = self.layout.cells[0];
        self.first[line * width] as usize..self.first[(line + 1) * width] as usize
    }
    /// The line of cells that holds a row of agents: the last one that starts at or before it.
    pub fn line_at(&self, row: usize) -> usize {
        let (mut low, mut high) = (0, self.lines());
        while high - low > 1 {
            let middle = (low + high) / 2;
            if self.line(middle).start <= row {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
    /// How many of the rows from `row` on, up to `most`, can be searched together: their neighbourhood must not close on itself.
    #[inline(always)]
    pub fn together(&self, from: &Columns<R, D>, row: usize, most: usize) -> usize {
        if self.layout.period[0].is_none() {
            return most;
        }
        let widest = self.layout.cells[0] - 2 * self.layout.span[0];
        let first = self.layout.coordinate(0, from.position[0][row]);
        let mut count = most;
        while count > 1 && self.layout.coordinate(0, from.position[0][row + count - 1]) + 1 - first > widest {
            count -= 1;
        }
        count
    }
    /// The rows around a block of rows that stand in one line of cells, in canonical order. `to` is cleared first.
    ///
    /// A list rather than a visitor: what is computed per segment runs at an instruction level that closures do not
    /// inherit.
    pub fn around(
        &self,
        columns: &Columns<R, D>,
        line: usize,
        rows: core::ops::Range<usize>,
        to: &mut Vec<Segment<R, D>>,
    ) {
        to.clear();
        let low = self.layout.coordinate(0, columns.position[0][rows.start]) as isize;
        let high = self.layout.coordinate(0, columns.position[0][rows.end - 1]) as isize;
        let mut centre = [0usize; D];
        let mut rest = line;
        for a in 1..D {
            centre[a] = rest % self.layout.cells[a];
            rest /= self.layout.cells[a];
        }
        let span = self.layout.span[0] as isize;
        self.layout.each_line(centre, self.layout.span, |line, shift| {
            self.stretch(line, low - span, high + span, shift, &mut |segment| to.push(segment));
        });
    }
    /// The part of a line from cell `low` to cell `high` (unwrapped).
    #[inline(always)]
    fn stretch(
        &self,
        line: usize,
        low: isize,
        high: isize,
        shift: Vector<R, D>,
        visit: &mut impl FnMut(Segment<R, D>),
    ) {
        let base = line * self.layout.cells[0];
        self.layout.runs(low, high, shift, |cells, shift| {
            let (first, end) = (self.first[base + cells.start], self.first[base + cells.end]);
            if end > first {
                visit(Segment { first, end, shift });
            }
        });
    }
    /// Calls `visit(row, offset, squared distance)` for every agent closer than `radius` to a place, the agent at the
    /// place included. In canonical order while the radius is at most the grid's reach.
    ///
    /// Returns false, having visited nothing, where the radius is too large for a periodic grid (search all pairs then).
    pub fn within(
        &self,
        columns: &Columns<R, D>,
        place: Vector<R, D>,
        radius: R,
        mut visit: impl FnMut(u32, Vector<R, D>, R),
    ) -> bool {
        let limit = radius * radius;
        self.each_segment(place, radius, |segment| {
            for row in segment.first..segment.end {
                let offset = (columns.position(row as usize) + segment.shift) - place;
                let squared = offset.length_squared();
                if squared < limit {
                    visit(row, offset, squared);
                }
            }
        })
    }
    /// As [`Self::within`], but hands out whole runs of rows that hold everyone closer than `radius`, for the caller to test.
    pub fn each_segment(&self, place: Vector<R, D>, radius: R, mut visit: impl FnMut(Segment<R, D>)) -> bool {
        let Some((centre, span)) = self.layout.search(place, radius) else { return false };
        let (low, high) = (centre[0] as isize - span[0] as isize, centre[0] as isize + span[0] as isize);
        self.layout.each_line(centre, span, |line, shift| self.stretch(line, low, high, shift, &mut visit));
        true
    }
    /// A length of the order of the distance between neighbours, to start a search for the nearest ones.
    pub fn spacing(&self) -> R {
        let coarse = self.layout.per_length[D - 1];
        if coarse > R::ZERO { R::ONE / coarse } else { R::ONE }
    }
}

/// Cells that follow agents moving one at a time. Rows stay where they are; inside a cell they stand in
/// ascending order, so that neighbours are met in the same canonical order as in [`Grid`] when rows are ids.
#[derive(Clone, Debug)]
pub struct LiveGrid<R, const D: usize> {
    layout: Layout<R, D>,
    reach: R,
    lines: Vec<Line<R, D>>,
    cell_of: Vec<u32>,
    /// Where each row stands in its line.
    place_of: Vec<u32>,
    /// The runs of cells around each cell, for the grid's own reach: `around[first[c]..first[c + 1]]`.
    around: Vec<Run<R, D>>,
    first: Vec<u32>,
}

/// A run of cells in one line of a [`LiveGrid`].
#[derive(Clone, Copy, Debug)]
pub struct Run<R, const D: usize> {
    line: u32,
    /// First cell in the line, and the one after the last.
    cells: [u32; 2],
    /// To be added to the positions of its agents.
    pub shift: Vector<R, D>,
}

/// The agents in a line of cells, cell by cell, with copies of their positions side by side.
#[derive(Clone, Debug)]
struct Line<R, const D: usize> {
    /// Rows, ascending inside a cell, with [`PADDING`] places more at the end.
    rows: Vec<u32>,
    /// Their positions, `[D][rows]`, as long.
    position: [Vec<R>; D],
    /// First place of each cell, and the number of agents at the end.
    first: Vec<u32>,
}

/// The agents in a run of cells: the first `count` of these columns, which are [`PADDING`] places longer at least.
#[derive(Clone, Copy, Debug)]
pub struct Members<'a, R, const D: usize> {
    /// Number of agents.
    pub count: usize,
    /// Their rows, in canonical order.
    pub rows: &'a [u32],
    /// Their positions.
    pub position: [&'a [R]; D],
}

impl<R: Real, const D: usize> Line<R, D> {
    fn empty(cells: usize) -> Self {
        Self {
            rows: vec![0; PADDING],
            position: core::array::from_fn(|_| vec![R::ZERO; PADDING]),
            first: vec![0; cells + 1],
        }
    }
    /// Where a row stands in a cell, or would.
    #[inline(always)]
    fn find(&self, cell: usize, row: u32) -> usize {
        let (first, end) = (self.first[cell] as usize, self.first[cell + 1] as usize);
        first + self.rows[first..end].partition_point(|&other| other < row)
    }
    /// Tells the rows from a place on where they are now.
    fn tell(&self, from: usize, place_of: &mut [u32]) {
        let count = self.first[self.first.len() - 1] as usize;
        for (at, &row) in self.rows[..count].iter().enumerate().skip(from) {
            place_of[row as usize] = at as u32;
        }
    }
    fn insert(&mut self, cell: usize, row: u32, place: Vector<R, D>, place_of: &mut [u32]) {
        let at = self.find(cell, row);
        self.rows.insert(at, row);
        for a in 0..D {
            self.position[a].insert(at, place.0[a]);
        }
        self.first[cell + 1..].iter_mut().for_each(|first| *first += 1);
        self.tell(at, place_of);
    }
    fn remove(&mut self, cell: usize, row: u32, place_of: &mut [u32]) {
        let at = self.find(cell, row);
        self.rows.remove(at);
        for a in 0..D {
            self.position[a].remove(at);
        }
        self.first[cell + 1..].iter_mut().for_each(|first| *first -= 1);
        self.tell(at, place_of);
    }
}

impl<R: Real, const D: usize> LiveGrid<R, D> {
    /// Sorts all rows in; `None` where a grid cannot serve this reach in this space. In open space the cells
    /// cover the positions of this moment, and outer cells hold whoever leaves.
    pub fn new(space: &Space<R, D>, reach: R, columns: &Columns<R, D>) -> Option<Self> {
        let (low, high) = bounds(columns);
        let layout = Layout::new(space, reach, columns.len(), low, high, 1.0)?;
        let width = layout.cells[0];
        let mut grid = Self {
            layout,
            reach,
            lines: vec![Line::empty(width); layout.total() / width],
            cell_of: Vec::new(),
            place_of: vec![0; columns.len()],
            around: Vec::new(),
            first: vec![0],
        };
        for row in 0..columns.len() {
            let cell = layout.cell(columns.position(row));
            grid.cell_of.push(cell as u32);
            grid.lines[cell / width].insert(cell % width, row as u32, columns.position(row), &mut grid.place_of);
        }
        for cell in 0..layout.total() {
            let mut centre = [0; D];
            let mut rest = cell;
            for a in 0..D {
                centre[a] = rest % layout.cells[a];
                rest /= layout.cells[a];
            }
            layout.each_run(centre, layout.span, |line, cells, shift| {
                let cells = [cells.start as u32, cells.end as u32];
                grid.around.push(Run { line: line as u32, cells, shift });
            });
            grid.first.push(grid.around.len() as u32);
        }
        Some(grid)
    }
    /// Follows a row to its new place.
    #[inline]
    pub fn follow(&mut self, row: usize, place: Vector<R, D>) {
        let (line, along) = self.layout.line_and_cell(place);
        let width = self.layout.cells[0];
        let (old, new) = (self.cell_of[row] as usize, line * width + along);
        let line = &mut self.lines[line];
        if old == new {
            let at = self.place_of[row] as usize;
            for a in 0..D {
                line.position[a][at] = place.0[a];
            }
        } else {
            // both may be in one line
            self.lines[old / width].remove(old % width, row as u32, &mut self.place_of);
            self.lines[new / width].insert(along, row as u32, place, &mut self.place_of);
            self.cell_of[row] = new as u32;
        }
    }
    /// The runs of cells around a row in canonical order for the grid's own reach.
    #[inline(always)]
    pub fn around(&self, row: usize) -> &[Run<R, D>] {
        let cell = self.cell_of[row] as usize;
        &self.around[self.first[cell] as usize..self.first[cell + 1] as usize]
    }
    /// The reach the cells were made for.
    #[inline(always)]
    pub fn reach(&self) -> R {
        self.reach
    }
    /// The agents in a run of cells.
    #[inline(always)]
    pub fn members(&self, run: &Run<R, D>) -> Members<'_, R, D> {
        let line = &self.lines[run.line as usize];
        let (first, end) = (line.first[run.cells[0] as usize] as usize, line.first[run.cells[1] as usize] as usize);
        let mut position = [&[][..]; D];
        for a in 0..D {
            position[a] = &line.position[a][first..];
        }
        Members { count: end - first, rows: &line.rows[first..], position }
    }
    /// As [`Grid::within`], with the positions that this grid followed.
    pub fn within(&self, place: Vector<R, D>, radius: R, mut visit: impl FnMut(u32, Vector<R, D>, R)) -> bool {
        let Some((centre, span)) = self.layout.search(place, radius) else { return false };
        let limit = radius * radius;
        self.layout.each_run(centre, span, |line, cells, shift| {
            let cells = [cells.start as u32, cells.end as u32];
            let members = self.members(&Run { line: line as u32, cells, shift });
            for at in 0..members.count {
                let other = Vector(core::array::from_fn(|a| members.position[a][at]));
                let offset = (other + shift) - place;
                let squared = offset.length_squared();
                if squared < limit {
                    visit(members.rows[at], offset, squared);
                }
            }
        });
        true
    }
}

/// Insertion sort: a cell holds few agents.
#[inline(always)]
fn sort_by_id(rows: &mut [u32], id: &[u32]) {
    if rows.len() > 24 {
        rows.sort_unstable_by_key(|&row| id[row as usize]);
        return;
    }
    for k in 1..rows.len() {
        let row = rows[k];
        let mut place = k;
        while place > 0 && id[rows[place - 1] as usize] > id[row as usize] {
            rows[place] = rows[place - 1];
            place -= 1;
        }
        rows[place] = row;
    }
}

/// The corners of the box that holds all positions.
pub fn bounds<R: Real, const D: usize>(columns: &Columns<R, D>) -> (Vector<R, D>, Vector<R, D>) {
    let n = columns.len();
    let mut low = Vector([R::ZERO; D]);
    let mut high = low;
    for a in 0..D {
        let mut it = columns.position[a][..n].iter();
        let Some(&start) = it.next() else { return (low, high) };
        let (mut least, mut most) = (start, start);
        for &x in it {
            least = least.least(x);
            most = most.most(x);
        }
        low.0[a] = least;
        high.0[a] = most;
    }
    (low, high)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::random::{Purpose, uniform};

    fn scattered<const D: usize>(agents: usize, size: f64, seed: u64) -> Columns<f64, D> {
        let mut columns = Columns::new(agents, 1);
        for i in 0..agents {
            for a in 0..D {
                let mut x = size * uniform(seed, Purpose::Init, i as u64, a as u32);
                if i % 7 == 0 && size > 0.0 {
                    x = (x / size * 4.0).floor() * size / 4.0; // on faces of cells, and coincident
                }
                columns.position[a][i] = x;
            }
            columns.state[0][i] = i as f64;
        }
        columns
    }

    fn brute<const D: usize>(columns: &Columns<f64, D>, space: &Space<f64, D>, i: usize, reach: f64) -> Vec<u32> {
        (0..columns.len())
            .filter(|&j| space.offset(columns.position(i), columns.position(j)).length_squared() < reach * reach)
            .map(|j| columns.id[j])
            .collect()
    }

    /// Blocks of every width and the point query meet the same neighbours as the comparison of all pairs.
    fn agrees<const D: usize>(space: Space<f64, D>, agents: usize, size: f64, reach: f64) -> bool {
        let from = scattered::<D>(agents, size, 3);
        let mut to = Columns::new(agents, 1);
        let workers = Workers::new(3);
        let Some(grid) = Grid::sort(None, &space, reach, &from, &mut to, &workers) else { return false };
        let mut live = LiveGrid::new(&space, reach, &from).unwrap();
        for row in 0..agents {
            live.follow(row, to.position(row));
        }
        let mut seen = vec![false; agents];
        for row in 0..agents {
            assert_eq!(from.position(to.id[row] as usize), to.position(row));
            assert_eq!(to.state[0][row], f64::from(to.id[row]));
            assert!(!std::mem::replace(&mut seen[to.id[row] as usize], true));
        }
        for width in [1, 4, 16] {
            for line in 0..grid.lines() {
                let rows = grid.line(line);
                let mut row = rows.start;
                while row < rows.end {
                    let count = grid.together(&to, row, width.min(rows.end - row));
                    for me in row..row + count {
                        let mut met = Vec::new();
                        let mut segments = Vec::new();
                        grid.around(&to, line, row..row + count, &mut segments);
                        for s in segments {
                            for j in s.first as usize..s.end as usize {
                                let offset = (to.position(j) + s.shift) - to.position(me);
                                if offset.length_squared() < reach * reach {
                                    met.push(to.id[j]);
                                }
                            }
                        }
                        let mut by_query = Vec::new();
                        grid.within(&to, to.position(me), reach, |j, _, _| by_query.push(to.id[j as usize]));
                        assert_eq!(met, by_query, "the same neighbours in the same order");
                        let mut alive = Vec::new();
                        live.within(to.position(me), reach, |j, _, _| alive.push(to.id[j as usize]));
                        alive.sort_unstable();
                        met.sort_unstable();
                        assert_eq!(met, alive);
                        let mut all = brute(&to, &space, me, reach);
                        all.sort_unstable();
                        assert_eq!(met, all, "width {width}");
                    }
                    row += count;
                }
            }
        }
        true
    }

    #[test]
    fn grid_and_all_pairs_agree() {
        assert!(agrees::<1>(Space::periodic([20.0]), 60, 20.0, 1.0));
        assert!(agrees::<2>(Space::periodic([10.0, 10.0]), 300, 10.0, 1.0));
        assert!(agrees::<2>(Space::periodic([3.1, 3.1]), 100, 3.1, 1.0), "three cells wide");
        assert!(agrees::<2>(Space::walled([1.0, 1.0]), 50, 1.0, 1.0), "one cell");
        assert!(agrees::<2>(Space::walled([2.0, 2.0]), 50, 2.0, 0.9), "two cells");
        assert!(agrees::<2>(Space::open(), 200, 30.0, 1.0));
        assert!(agrees::<3>(Space::open(), 300, 5.0, 1.0));
        assert!(agrees::<3>(Space::periodic([5.0, 5.0, 5.0]), 300, 5.0, 1.0));
        assert!(agrees::<2>(Space { edges: [Edge::Periodic(8.0), Edge::Walls(8.0)] }, 200, 8.0, 1.0));
        assert!(
            !agrees::<2>(Space::periodic([2.0, 2.0]), 50, 2.0, 1.0),
            "two cells around a period: all pairs instead"
        );
        assert!(agrees::<2>(Space::open(), 1, 5.0, 1.0) && agrees::<2>(Space::open(), 2, 0.0, 1.0));
    }

    #[test]
    fn a_reach_far_beyond_the_agents_is_searched_in_no_time() {
        let mut from = Columns::<f64, 2>::new(300, 0);
        for i in 0..300 {
            from.position[0][i] = 1e-9 * i as f64;
        }
        let mut to = Columns::new(300, 0);
        let workers = Workers::new(1);
        let grid = Grid::sort(None, &Space::open(), 1e9, &from, &mut to, &workers).unwrap();
        let mut met = 0;
        assert!(grid.within(&to, Vector([0.0, 0.0]), 1e9, |_, _, _| met += 1));
        assert_eq!(met, 300);
        assert!(LiveGrid::new(&Space::open(), 1e9, &from).is_some());
    }

    #[test]
    fn the_order_does_not_depend_on_threads_or_on_the_order_before() {
        let space = Space::periodic([10.0, 10.0]);
        let from = scattered::<2>(500, 10.0, 9);
        let sorted = |from: &Columns<f64, 2>, threads| {
            let mut to = Columns::new(500, 1);
            let grid = Grid::sort(None, &space, 1.0, from, &mut to, &Workers::new(threads));
            assert!(grid.is_some());
            to
        };
        let one = sorted(&from, 1);
        for threads in [2, 3, 8] {
            assert_eq!(one.id, sorted(&from, threads).id);
        }
        assert_eq!(one.id, sorted(&one, 2).id);
    }
}
