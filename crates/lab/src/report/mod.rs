//! The page: one self-contained file of figures, tables and words.
//!
//! What a page shows is plain data ([`Page`]); it does not know where it comes from. [`html`] writes it down. What can
//! be seen without JavaScript is drawn here (charts, scenes); `page.js` adds the read-outs, the player and the
//! downloads. The data of a figure lies in the page once, in a `<script>` element of JSON.

mod chart;
mod document;
mod drawing;
pub(crate) mod escape;
mod map;
pub(crate) mod number;
pub(crate) mod palette;
pub(crate) mod replay;
mod reread;
mod scene;
pub(crate) mod ticks;

pub use document::html;
pub(crate) use drawing::TIMES;
pub(crate) use drawing::bounds;
pub(crate) use number::number as short;
pub use reread::replays;

mod of_members;
pub mod of_run;
pub mod of_tracks;

/// A page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Title.
    pub title: String,
    /// Paragraphs below the title: what it is and what to look for.
    pub lead: Vec<String>,
    /// Paragraphs that say what was done, as in the methods section of a paper.
    pub methods: Vec<String>,
    /// Numbers that sum it up.
    pub summary: Vec<Fact>,
    /// Figures, in order.
    pub figures: Vec<Figure>,
    /// Tables to download as CSV.
    pub tables: Vec<Table>,
    /// The command that makes it again.
    pub command: String,
    /// The file as resolved, to read and to copy.
    pub source: String,
    /// Line at the foot: program, version, seed.
    pub made_by: String,
}

/// A number with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// What it is.
    pub label: String,
    /// Its value, written out, with its unit.
    pub value: String,
}

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    /// Lines over a common axis.
    Lines(Lines),
    /// Means with their spread.
    Means(Means),
    /// A table to read.
    Listing(Listing),
    /// Chosen moments, seen from outside.
    Scenes(Scenes),
    /// A recording to play.
    Replay(Replay),
    /// Drawings of places.
    Drawings(Drawings),
    /// Maps of a parameter space.
    Map(Map),
}

/// How a line of a drawing is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// What was there already.
    There,
    /// What was built.
    Built,
    /// Structure that is not built.
    Structure,
    /// The way of a member, in one of six parts of the time.
    Way(usize),
    /// What belongs to a series of this number, in its colour.
    Series(usize),
}

/// A drawing of a place in the plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// What stands below it.
    pub caption: String,
    /// Lines by their points.
    pub strokes: Vec<(Stroke, Vec<[f64; 2]>)>,
    /// Discs: whether they were built, centre and radius.
    pub discs: Vec<(bool, [f64; 2], f64)>,
    /// Marked places.
    pub marks: Vec<[f64; 2]>,
}

/// Drawings side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawings {
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// What all of them show: lower and upper corner; none where each shows what is in it.
    pub bounds: Option<([f64; 2], [f64; 2])>,
    /// The drawings.
    pub drawings: Vec<Drawing>,
}

/// A cell of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapCell {
    /// Lower corner.
    pub low: [f64; 2],
    /// Upper corner.
    pub high: [f64; 2],
    /// Share of successes.
    pub rate: f64,
    /// Whether it counts as valid.
    pub valid: bool,
}

/// A panel of a map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPanel {
    /// What stands below it.
    pub caption: String,
    /// Its cells.
    pub cells: Vec<MapCell>,
}

/// Maps of a parameter space over two axes, which need fixed ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Whether cells are filled by their rate; else there is a symbol at each centre.
    pub areas: bool,
    /// The panels.
    pub panels: Vec<MapPanel>,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows.
    pub label: String,
    /// Its unit; empty or `1` where it has none.
    pub unit: String,
    /// Fixed ends, where the quantity has natural ones.
    pub range: Option<(f64, f64)>,
}

/// Lines over a common axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Name of its file when it is downloaded.
    pub id: String,
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The lines.
    pub lines: Vec<Line>,
}

/// Means with their spread, over numbers or over names.
#[derive(Clone, Debug, PartialEq)]
pub struct Means {
    /// The means; over names, places are 0, 1, 2, ...
    pub lines: Lines,
    /// Half the length of the bar through each mean, `[lines][points]`.
    pub spread: Vec<Vec<Option<f64>>>,
    /// What the spread is: `standard error`.
    pub spread_name: String,
    /// The names on the horizontal axis; none where it shows numbers.
    pub names: Vec<String>,
}

/// A table to read.
#[derive(Clone, Debug, PartialEq)]
pub struct Listing {
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows, each as long as the header.
    pub rows: Vec<Vec<String>>,
}

/// A line; a missing value interrupts it.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// What it shows.
    pub name: String,
    /// Places, `[points]`, ascending.
    pub x: Vec<f64>,
    /// Values, `[points]`.
    pub y: Vec<Option<f64>>,
}

/// What stands in a scene besides agents. Unused axes are zero.
#[derive(Clone, Debug, PartialEq)]
pub enum Outline {
    /// A disc or sphere.
    Ball {
        /// Centre.
        centre: [f64; 3],
        /// Radius.
        radius: f64,
    },
    /// A line.
    Segment {
        /// One end.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
    },
    /// A closed polygon in the plane.
    Polygon(Vec<[f64; 3]>),
    /// A box along the axes.
    Cuboid {
        /// Lower corner.
        low: [f64; 3],
        /// Upper corner.
        high: [f64; 3],
    },
}

/// The stage on which a scene or a replay plays.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Number of axes: 1, 2 or 3.
    pub dimensions: usize,
    /// Lower corner of what is shown.
    pub low: [f64; 3],
    /// Upper corner of what is shown.
    pub high: [f64; 3],
    /// Whether each axis ends at a wall (drawn solid), closes on itself (dashed) or has no end (no frame).
    pub edges: [Border; 3],
    /// Unit of length.
    pub unit: String,
    /// Names of the groups, in the order of their colours.
    pub groups: Vec<String>,
    /// Body radius of each group, `[groups]`; zero where members are points.
    pub radius: Vec<f64>,
}

/// How an axis ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Border {
    /// At a wall.
    Wall,
    /// At a seam.
    Seam,
    /// Nowhere.
    Open,
}

/// An agent in a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Index of its group.
    pub group: usize,
    /// Position.
    pub position: [f64; 3],
    /// Heading, a unit vector; zero at rest.
    pub heading: [f64; 3],
    /// Where it was before, the oldest first. A jump across a seam is not drawn.
    pub trail: Vec<[f64; 3]>,
}

/// A moment.
#[derive(Clone, Debug, PartialEq)]
pub struct Moment {
    /// Time.
    pub time: f64,
    /// The agents.
    pub agents: Vec<Seen>,
    /// Items of food that are there.
    pub items: Vec<[f64; 3]>,
    /// Obstacles as they stand.
    pub obstacles: Vec<Outline>,
}

/// Chosen moments. In three dimensions each is seen from above, from the front and from the side.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenes {
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// The stage.
    pub stage: Stage,
    /// Unit of time.
    pub time_unit: String,
    /// The moments.
    pub moments: Vec<Moment>,
}

/// A recording to play.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// Title.
    pub title: String,
    /// A sentence below it.
    pub about: String,
    /// The stage.
    pub stage: Stage,
    /// Unit of time.
    pub time_unit: String,
    /// Time of each frame, `[frames]`.
    pub times: Vec<f64>,
    /// Group of each agent, `[agents]`.
    pub group: Vec<usize>,
    /// Positions, `[frames][agents]`; not a number where an agent is not there.
    pub position: Vec<Vec<[f32; 3]>>,
    /// Headings, `[frames][agents]`, unit vectors; zero at rest.
    pub heading: Vec<Vec<[f32; 3]>>,
    /// Obstacles, `[frames]` where they move, else one entry.
    pub obstacles: Vec<Vec<Outline>>,
}

/// A table to download.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// File name.
    pub file: String,
    /// What it holds, in a sentence.
    pub about: String,
    /// The table as CSV, with a line of names.
    pub csv: String,
}
