//! Layouts: where a table of a producer keeps the individuals, the time and the places.
//!
//! A layout is one file and one line in [`LIST`]. From the beginning of a table it makes a [`Plan`], which says what each
//! row holds; reading the rows by it is the same for all, of text and of Parquet.

mod animalta;
mod deeplabcut;
pub(crate) mod idtracker;
mod long;
mod pedestrian;
mod sleap;
pub(crate) mod trex;
mod wide;

use super::text::Head;
use super::{Ask, meant, wrong};
use crate::store::StoreError;

/// A layout of tables.
pub struct Layout {
    /// Name on the command line and in files.
    pub id: &'static str,
    /// Who writes it, and how it looks.
    pub about: &'static str,
    /// What can be said of its columns, of [`super::names::ROLES`] and [`super::names::CHOICES`].
    pub takes: &'static [&'static str],
    /// The plan of a table; none where it is not of this layout.
    pub plan: fn(&Head, &Ask) -> Result<Option<Plan>, StoreError>,
}

/// The layouts, in the order in which `auto` tries them: the most particular first.
pub const LIST: &[Layout] = &[
    trex::LAYOUT,
    deeplabcut::LAYOUT,
    sleap::LAYOUT,
    animalta::LAYOUT,
    idtracker::LAYOUT,
    pedestrian::LAYOUT,
    long::LAYOUT,
    wide::LAYOUT,
];

/// What the rows of a table hold.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The layout.
    pub layout: &'static str,
    /// Rows before the first with numbers.
    pub skip: usize,
    /// Column of the frame's number.
    pub frame: Option<usize>,
    /// Column of the time.
    pub time: Option<Clock>,
    /// The places in a row: one of a long table, one for each individual of a wide one.
    pub places: Vec<Place>,
    /// Whether places are longitude and latitude.
    pub geographic: bool,
    /// Unit of length that the table states.
    pub unit: Option<String>,
    /// Frames per second that the table states.
    pub fps: Option<f64>,
    /// Names of the columns, for messages.
    pub names: Vec<String>,
    /// What the reader decided and the user should know.
    pub notes: Vec<String>,
}

/// A column of times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// The column.
    pub column: usize,
    /// Whether it holds dates with a time of day in words; else numbers.
    pub stamps: bool,
    /// Seconds in the unit of its numbers, where that is said; else they are taken for seconds.
    pub unit: Option<f64>,
}

impl Clock {
    /// A column of seconds.
    pub fn seconds(column: usize) -> Self {
        Self { column, stamps: false, unit: Some(1.0) }
    }
    /// A column of numbers or of time stamps, behind the rows that are skipped.
    ///
    /// # Errors
    /// A unit of time that is not known.
    fn of(head: &Head, ask: &Ask, names: &[String], column: usize, skip: usize) -> Result<Self, StoreError> {
        let unit = super::names::time_unit_of(head, ask, &names[column])?;
        Ok(Self { column, stamps: head.holds_words(column, skip), unit })
    }
}

/// A place in a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Whose it is.
    pub who: Who,
    /// The points whose mean it is, most often one.
    pub points: Vec<Point>,
    /// Columns of the velocity, where the table has them.
    pub velocity: Option<Vec<usize>>,
}

/// Whose a place is.
#[derive(Clone, Debug, PartialEq)]
pub enum Who {
    /// The one that a column names.
    Column(usize),
    /// The one that two columns name: an arena and a number in it.
    Columns(usize, usize),
    /// One by name.
    Name(String),
}

/// A point in a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Columns of its coordinates: two or three.
    pub axes: Vec<usize>,
    /// Column of the confidence in it.
    pub confidence: Option<usize>,
}

impl Point {
    /// A point without a confidence.
    pub fn at(axes: Vec<usize>) -> Self {
        Self { axes, confidence: None }
    }
}

impl Plan {
    /// Number of coordinates of a place.
    pub fn dimensions(&self) -> usize {
        self.places.first().and_then(|place| place.points.first()).map_or(2, |point| point.axes.len())
    }
    /// Names of the columns that hold coordinates.
    pub fn coordinates(&self) -> impl Iterator<Item = &str> {
        let columns = self.places.iter().flat_map(|place| &place.points).flat_map(|point| &point.axes);
        columns.filter_map(|&column| self.names.get(column)).map(String::as_str)
    }
    /// All columns that are read.
    pub fn columns(&self) -> Vec<usize> {
        let mut columns: Vec<usize> = self.frame.into_iter().chain(self.time.map(|clock| clock.column)).collect();
        for place in &self.places {
            match place.who {
                Who::Column(column) => columns.push(column),
                Who::Columns(first, second) => columns.extend([first, second]),
                Who::Name(_) => {}
            }
            for point in &place.points {
                columns.extend(point.axes.iter().copied().chain(point.confidence));
            }
            columns.extend(place.velocity.iter().flatten());
        }
        columns.sort_unstable();
        columns.dedup();
        columns
    }
}

/// The plan of a table, by the layout asked for or the first that knows it.
///
/// # Errors
/// A table of no known layout, or one that leaves something open; the message names the option that settles it.
pub fn plan(head: &Head, ask: &Ask) -> Result<Plan, StoreError> {
    // that there is no such column can be said of any table
    let said = || ask.columns.iter().filter(|(_, name)| name != "none");
    let unused = |layout: &Layout| said().find(|(role, _)| !layout.takes.contains(&role.as_str()));
    let layouts: Vec<&Layout> = match ask.layout.as_deref() {
        // who names columns means a layout that has use for the names
        None | Some("auto") => LIST.iter().filter(|layout| unused(layout).is_none()).collect(),
        Some(id) => {
            let found = LIST.iter().find(|layout| layout.id == id);
            let found = found.ok_or_else(|| {
                let ids = LIST.iter().map(|layout| layout.id);
                let near = meant(id, ids.clone());
                let ids: Vec<&str> = ids.collect();
                StoreError::Refused(format!("no layout is called `{id}`{near}; there are auto, {}", ids.join(", ")))
            })?;
            if let Some((role, name)) = unused(found) {
                let takes = found.takes.join(", ");
                return Err(wrong(
                    &head.path,
                    &format!("a table of the layout `{id}` has no use for --columns {role}={name}; it takes {takes}"),
                ));
            }
            vec![found]
        }
    };
    for layout in layouts {
        let Some(mut plan) = (layout.plan)(head, ask)? else { continue };
        plan.layout = layout.id;
        let (fps, unit) = super::names::comments(head);
        plan.fps = plan.fps.or(fps);
        let stated = super::names::unit_of_columns(head, plan.coordinates())?;
        plan.unit = stated.or(plan.unit).or(unit.map(str::to_owned));
        return Ok(plan);
    }
    let what = match head.header() {
        Some(names) => format!("the columns are {}", super::names::shown(names)),
        None => format!("it has {} columns of numbers and no names", head.rows.first().map_or(0, Vec::len)),
    };
    let how = "name the columns, as in --columns frame=frame,id=fish,x=px,y=py (or by their numbers from 1)";
    Err(wrong(&head.path, &format!("no table of tracks that is known: {what}; {how}")))
}

/// The column that was asked for in a role, or the one that tables of a layout have.
fn asked_or(
    head: &Head,
    names: &[String],
    ask: &Ask,
    role: &str,
    own: Option<usize>,
) -> Result<Option<usize>, StoreError> {
    if ask.column(role).is_some() { super::names::column(head, names, ask, role) } else { Ok(own) }
}

/// The file of a folder that has the rest of what a table's producer says of it, read as JSON.
fn beside(head: &Head, name: &str) -> Option<serde_json::Value> {
    let text = std::fs::read_to_string(head.path.with_file_name(name)).ok()?;
    serde_json::from_str(&text).ok()
}

/// The points that stand for an individual among its body parts: the only one, the one asked for, or all for their mean.
///
/// # Errors
/// Where there are several and none was asked for.
fn chosen_points(head: &Head, ask: &Ask, parts: &[(String, Point)], of: &str) -> Result<Vec<Point>, StoreError> {
    let names: Vec<String> = parts.iter().map(|(name, _)| name.clone()).collect();
    match ask.column("point") {
        Some("mean") => Ok(parts.iter().map(|(_, point)| point.clone()).collect()),
        Some(name) => {
            let found = parts.iter().find(|(part, _)| part.eq_ignore_ascii_case(name));
            found.map(|(_, point)| vec![point.clone()]).ok_or_else(|| {
                let near = meant(name, names.iter().map(String::as_str));
                let there = super::names::shown(&names);
                wrong(&head.path, &format!("{of} has no body part `{name}`; there are {there}{near}"))
            })
        }
        None => match parts {
            [(_, only)] => Ok(vec![only.clone()]),
            _ => Err(wrong(
                &head.path,
                &format!(
                    "{} body parts ({}) and one position is wanted: choose with --columns point={}, or take their mean \
                     with --columns point=mean",
                    parts.len(),
                    super::names::shown(&names),
                    names.first().map_or("NAME", String::as_str)
                ),
            )),
        },
    }
}
