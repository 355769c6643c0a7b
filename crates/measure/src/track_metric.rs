//! What a metric over time is: its card, its table, and the door by which the list is used.

use crate::metric::{check_parameter, unknown_parameter};
use crate::{Counted, MeasureError, Parameter, Takes, Tracks};

/// What the numbers of a field are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A quantity.
    Number,
    /// A whole number of things.
    Count,
    /// Number of a frame, as in the source.
    Frame,
    /// An individual, by its place in [`Tracks::names`]; -1 for all together.
    Individual,
    /// A group, by its place in [`Tracks::group_names`].
    Group,
    /// One of these words, by its place in the list.
    Label(&'static [&'static str]),
}

/// A column of what a metric over time finds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name in tables.
    pub name: &'static str,
    /// Unit: `1`, `s`, `length`...
    pub unit: &'static str,
    /// What its numbers are.
    pub kind: Kind,
    /// One sentence.
    pub about: &'static str,
}

impl Field {
    /// A quantity.
    pub(crate) const fn number(name: &'static str, unit: &'static str, about: &'static str) -> Self {
        Self { name, unit, kind: Kind::Number, about }
    }
    /// A whole number of things.
    pub(crate) const fn count(name: &'static str, about: &'static str) -> Self {
        Self { name, unit: "1", kind: Kind::Count, about }
    }
    /// The number of a frame.
    pub(crate) const fn frame() -> Self {
        Self { name: "frame", unit: "1", kind: Kind::Frame, about: "Number of the frame, as in the source." }
    }
    /// A moment.
    pub(crate) const fn time() -> Self {
        Self::number("t", "s", "Time of the frame.")
    }
    /// An individual.
    pub(crate) const fn individual(name: &'static str, about: &'static str) -> Self {
        Self { name, unit: "", kind: Kind::Individual, about }
    }
}

/// A description, by itself, of a metric over time.
#[derive(Clone, Copy, Debug)]
pub struct TrackCard {
    /// Name in files, in tables and on the command line.
    pub id: &'static str,
    /// Name for readers.
    pub title: &'static str,
    /// The formula, as text.
    pub definition: &'static str,
    /// Which reading of its name this is, where several are in use.
    pub variant: &'static str,
    /// Where the definition comes from.
    pub source: &'static str,
    /// Which members count.
    pub counted: Counted,
    /// Numbers of dimensions it is defined in.
    pub dimensions: &'static [usize],
    /// The numbers it takes.
    pub parameters: &'static [Parameter],
    /// The columns of its table.
    pub fields: &'static [Field],
    /// What it gives where there is little to measure.
    pub edge: &'static str,
}

/// The table that a metric over time gives: one column for each field of its card.
#[derive(Clone, Debug, PartialEq)]
pub struct Listing {
    /// Numbers, `[fields][rows]`; NaN where something is undefined.
    pub columns: Vec<Vec<f64>>,
}

impl Listing {
    /// A table without rows.
    pub(crate) fn new(card: &TrackCard) -> Self {
        Self { columns: vec![Vec::new(); card.fields.len()] }
    }
    /// Adds a row.
    pub(crate) fn push<const F: usize>(&mut self, row: [f64; F]) {
        debug_assert_eq!(F, self.columns.len());
        self.columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    /// Number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// The numbers of a row.
    pub fn row(&self, row: usize) -> Vec<f64> {
        self.columns.iter().map(|column| column[row]).collect()
    }
}

/// Something that describes how a group moves over time.
pub trait TrackMetric: Default + Takes + Send + Sync + 'static {
    /// Its description of itself.
    const CARD: TrackCard;

    /// The table. Callers use [`TrackMetric::on`], which also checks what is needed.
    ///
    /// # Errors
    /// Where it needs something that the tracks do not have.
    fn listing<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError>;

    /// The table of tracks.
    ///
    /// # Errors
    /// Where a parameter was not given, or it needs something that the tracks do not have.
    fn on<const D: usize>(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        if let Some(parameter) = self.lacks() {
            let Parameter { name, about, .. } = *parameter;
            return Err(MeasureError::Missing { metric: Self::CARD.id, name, about });
        }
        if !Self::CARD.dimensions.contains(&D) {
            return Err(MeasureError::Unfit { metric: Self::CARD.id, needs: "another number of dimensions" });
        }
        self.listing(tracks)
    }
}

/// A metric over time chosen by its id: the door through which the list is used.
pub trait MeasureTracks<const D: usize>: Send + Sync {
    /// Its description of itself.
    fn card(&self) -> &'static TrackCard;
    /// Changes a parameter.
    ///
    /// # Errors
    /// Where the metric has no parameter of this name, or it may not have this value.
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError>;
    /// The table of tracks; see [`TrackMetric::on`].
    ///
    /// # Errors
    /// Where a parameter was not given, or it needs something that the tracks do not have.
    fn on(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError>;
}

impl<M: TrackMetric, const D: usize> MeasureTracks<D> for M {
    fn card(&self) -> &'static TrackCard {
        const { &M::CARD }
    }
    fn set(&mut self, name: &str, value: f64) -> Result<(), MeasureError> {
        let Some(place) = self.place(name) else {
            return Err(unknown_parameter(M::CARD.id, name, M::PARAMETERS));
        };
        check_parameter(M::CARD.id, name, M::PARAMETERS, value)?;
        *place = value;
        Ok(())
    }
    fn on(&self, tracks: &Tracks<D>) -> Result<Listing, MeasureError> {
        TrackMetric::on(self, tracks)
    }
}
