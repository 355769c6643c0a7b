//! Flat Parquet tables, of whoever wrote them: pandas, polars, R, DuckDB, this program.

use super::gather::{Bad, Row};
use super::layouts::idtracker::NO_RATE;
use super::layouts::{Plan, Who};
use super::text::{Head, NotNumber, number};
use super::wrong;
use crate::store::StoreError;
use parquet::basic::{LogicalType, TimeUnit, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use std::collections::HashMap;
use std::fs::File;
use std::path::Path;

/// First bytes of a Parquet file.
pub(super) const MARK: &[u8; 4] = b"PAR1";

fn open(path: &Path) -> Result<SerializedFileReader<File>, StoreError> {
    let file = File::open(path).map_err(|error| StoreError::io("read", path, error))?;
    SerializedFileReader::new(file).map_err(|error| damaged(path, &error))
}

fn damaged(path: &Path, error: &ParquetError) -> StoreError {
    if let Some((_, name)) = error.to_string().split_once("Disabled feature at compile time: ") {
        return wrong(path, &format!("it is compressed by {name}; write it with zstd, snappy, gzip or lz4"));
    }
    wrong(path, &format!("a damaged or truncated Parquet file: {error}"))
}

/// The names of the columns, as the beginning of a table.
///
/// # Errors
/// A file that cannot be read or is damaged.
pub(super) fn head(path: &Path) -> Result<Head, StoreError> {
    let reader = open(path)?;
    let meta = reader.metadata().file_metadata();
    let columns = meta.schema_descr().columns();
    let names = columns.iter().map(|column| column.path().string()).collect();
    let words = (0..columns.len()).filter(|&c| columns[c].physical_type() == Physical::BYTE_ARRAY).collect();
    let mut comments = Vec::new();
    let notes = meta.key_value_metadata().into_iter().flatten();
    for note in notes {
        let Some(value) = &note.value else { continue };
        // what a producer says of the frame rate stands in the metadata
        let json: Option<serde_json::Value> = serde_json::from_str(value).ok();
        let rate = json.as_ref().and_then(|json| json.get("frames_per_second").or(json.get("fps")));
        if let Some(rate) = rate.and_then(serde_json::Value::as_f64) {
            comments.push(format!("framerate: {rate}"));
        } else if note.key == "idtrackerai_attributes" {
            comments.push(NO_RATE.to_owned());
        } else if note.key == "fps" {
            comments.push(format!("framerate: {value}"));
        }
    }
    Ok(Head { path: path.to_owned(), comments, rows: vec![names], delimiter: None, words })
}

/// The values of a column in a row group.
enum Cells {
    Numbers(Vec<f64>),
    /// Words by their place in a list.
    Words(Vec<u32>, Vec<Vec<u8>>),
}

struct FlatRow<'a> {
    columns: &'a [Option<Cells>],
    row: usize,
    first: u64,
}

impl Row for FlatRow<'_> {
    fn number(&self, column: usize) -> Result<f64, Bad> {
        match self.columns.get(column) {
            Some(Some(Cells::Numbers(values))) => Ok(values[self.row]),
            Some(Some(Cells::Words(places, words))) => {
                let word = &words[places[self.row] as usize];
                number(word, false).map_err(|NotNumber| Bad::Word(String::from_utf8_lossy(word).into_owned()))
            }
            _ => Err(Bad::Short(self.columns.len())),
        }
    }
    fn word(&self, column: usize) -> Result<&[u8], Bad> {
        match self.columns.get(column) {
            Some(Some(Cells::Words(places, words))) => Ok(&words[places[self.row] as usize]),
            _ => Err(Bad::Short(self.columns.len())),
        }
    }
    fn place(&self) -> String {
        format!("row {}", self.first + self.row as u64 + 1)
    }
}

/// Calls `each` for every row.
///
/// # Errors
/// What `each` says, a damaged file, or a column of a type that holds no numbers and no words.
pub(super) fn each_row(
    head: &Head,
    plan: &Plan,
    each: &mut dyn FnMut(&dyn Row) -> Result<(), StoreError>,
) -> Result<(), StoreError> {
    let path = &head.path;
    let reader = open(path)?;
    let meta = reader.metadata();
    let mut words: Vec<usize> = plan.time.filter(|clock| clock.stamps).map(|clock| clock.column).into_iter().collect();
    for place in &plan.places {
        match place.who {
            Who::Column(column) => words.push(column),
            Who::Columns(first, second) => words.extend([first, second]),
            Who::Name(_) => {}
        }
    }
    let mut first = 0;
    for group in 0..meta.num_row_groups() {
        let rows = usize::try_from(meta.row_group(group).num_rows()).unwrap_or(0);
        let mut columns: Vec<Option<Cells>> = plan.names.iter().map(|_| None).collect();
        for column in plan.columns() {
            let about = meta.file_metadata().schema_descr().column(column);
            let reader = reader.get_row_group(group).and_then(|group| group.get_column_reader(column));
            let reader = reader.map_err(|error| damaged(path, &error))?;
            let cells = read(reader, &about, rows, words.contains(&column)).map_err(|error| match error {
                ParquetError::NYI(what) => wrong(path, &format!("column `{}`: {what}", about.path().string())),
                error => damaged(path, &error),
            })?;
            columns[column] = Some(cells);
        }
        for row in 0..rows {
            each(&FlatRow { columns: &columns, row, first })?;
        }
        first += rows as u64;
    }
    Ok(())
}

/// The values that are there, and for each row whether there is one.
fn values<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    about: &ColumnDescriptor,
    rows: usize,
) -> Result<(Vec<T::T>, Vec<i16>), ParquetError> {
    if about.max_rep_level() > 0 {
        return Err(ParquetError::NYI("a list in each row; expected a number or a word".into()));
    }
    let (mut values, mut levels) = (Vec::with_capacity(rows), Vec::new());
    let (read, ..) = reader.read_records(rows, Some(&mut levels), None, &mut values)?;
    if read != rows {
        return Err(ParquetError::EOF(format!("{read} of {rows} rows")));
    }
    let there = about.max_def_level();
    if there == 0 {
        levels.clear();
    }
    levels.iter_mut().for_each(|level| *level = i16::from(*level == there));
    Ok((values, levels))
}

fn numbers<T: DataType>(
    mut reader: ColumnReaderImpl<T>,
    about: &ColumnDescriptor,
    rows: usize,
    as_words: bool,
    number: impl Fn(&T::T) -> f64,
) -> Result<Cells, ParquetError> {
    let (read, levels) = values(&mut reader, about, rows)?;
    let mut read = read.iter().map(number);
    let values: Vec<f64> = match levels.as_slice() {
        [] => read.collect(),
        levels => {
            levels.iter().map(|&level| if level == 1 { read.next().unwrap_or(f64::NAN) } else { f64::NAN }).collect()
        }
    };
    if !as_words {
        return Ok(Cells::Numbers(values));
    }
    let mut list = Words::default();
    let places = values.iter().map(|value| {
        // names that pandas made numbers: 3.0 is 3
        let text = if value.is_nan() { String::new() } else { value.to_string() };
        list.place(text.as_bytes())
    });
    Ok(Cells::Words(places.collect(), list.words))
}

#[derive(Default)]
struct Words {
    words: Vec<Vec<u8>>,
    index: HashMap<Vec<u8>, u32>,
}

impl Words {
    fn place(&mut self, word: &[u8]) -> u32 {
        if let Some(&known) = self.index.get(word) {
            return known;
        }
        let place = self.words.len() as u32;
        self.words.push(word.to_vec());
        self.index.insert(word.to_vec(), place);
        place
    }
}

fn read(reader: ColumnReader, about: &ColumnDescriptor, rows: usize, as_words: bool) -> Result<Cells, ParquetError> {
    let seconds: f64 = match about.logical_type_ref() {
        Some(LogicalType::Timestamp(stamp)) => match stamp.unit {
            TimeUnit::MILLIS => 1e-3,
            TimeUnit::MICROS => 1e-6,
            TimeUnit::NANOS => 1e-9,
        },
        Some(LogicalType::Decimal { .. }) => {
            return Err(ParquetError::NYI("a decimal; expected a number or a word".into()));
        }
        _ => 1.0,
    };
    match reader {
        ColumnReader::BoolColumnReader(reader) => numbers(reader, about, rows, as_words, |&v| f64::from(u8::from(v))),
        ColumnReader::Int32ColumnReader(reader) => numbers(reader, about, rows, as_words, |&v| f64::from(v)),
        ColumnReader::Int64ColumnReader(reader) => {
            // whole seconds first: nanoseconds since 1970 have more digits than a number of 64 bits holds
            let per = (1.0 / seconds).round() as i64;
            numbers(reader, about, rows, as_words, |&v| v.div_euclid(per) as f64 + v.rem_euclid(per) as f64 * seconds)
        }
        ColumnReader::FloatColumnReader(reader) => numbers(reader, about, rows, as_words, |&v| f64::from(v)),
        ColumnReader::DoubleColumnReader(reader) => numbers(reader, about, rows, as_words, |&v| v),
        ColumnReader::ByteArrayColumnReader(mut reader) => {
            let (read, levels) = values(&mut reader, about, rows)?;
            let mut list = Words::default();
            let mut read = read.iter().map(ByteArray::data);
            let places = match levels.as_slice() {
                [] => read.map(|word| list.place(word)).collect(),
                levels => levels
                    .iter()
                    .map(|&level| list.place(if level == 1 { read.next().unwrap_or(b"") } else { b"" }))
                    .collect(),
            };
            Ok(Cells::Words(places, list.words))
        }
        ColumnReader::Int96ColumnReader(_) | ColumnReader::FixedLenByteArrayColumnReader(_) => {
            Err(ParquetError::NYI(format!("the type {}; expected a number or a word", about.physical_type())))
        }
    }
}
