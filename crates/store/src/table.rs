//! Tables: typed columns with names, units and meanings, as blocks of Parquet.
//!
//! A block is a small Parquet file of one row group, made apart from others; joined, blocks become one file without being
//! encoded again. Equal values give equal bytes.

use crate::StoreError;
use bytes::Bytes;
use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::reader::ColumnReader;
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, RowGroupMetaData};
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type};
use std::io::Write;
use std::sync::Arc;

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers of 64 bits; NaN where there is none.
    Double,
    /// Numbers of 32 bits.
    Single,
    /// Whole numbers of 64 bits.
    Long,
    /// Whole numbers of 32 bits.
    Whole,
    /// One of a few words; an empty one where there is none.
    Word,
}

/// A column of a table: what it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heading {
    /// Name.
    pub name: String,
    /// Unit; empty where it has none.
    pub unit: String,
    /// Meaning, in a sentence.
    pub about: String,
    /// What it holds.
    pub kind: Kind,
    /// Whether every row has a value; whole numbers always are there.
    pub always: bool,
}

impl Heading {
    /// A column; other than whole numbers, its values may be missing.
    pub fn new(name: &str, unit: &str, about: &str, kind: Kind) -> Self {
        let always = matches!(kind, Kind::Long | Kind::Whole);
        Self { name: name.to_owned(), unit: unit.to_owned(), about: about.to_owned(), kind, always }
    }
    /// The same column with a value in every row.
    pub fn always(self) -> Self {
        Self { always: true, ..self }
    }
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers of 64 bits.
    Double(Vec<f64>),
    /// Numbers of 32 bits.
    Single(Vec<f32>),
    /// Whole numbers of 64 bits.
    Long(Vec<i64>),
    /// Whole numbers of 32 bits.
    Whole(Vec<i32>),
    /// Words, by their place in a list.
    Word(Vec<u32>, Arc<Vec<String>>),
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::Double(values) => values.len(),
            Self::Single(values) => values.len(),
            Self::Long(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Word(values, _) => values.len(),
        }
    }
    /// Bytes they take.
    fn bytes(&self) -> usize {
        match self {
            Self::Double(values) => size_of_val(&values[..]),
            Self::Single(values) => size_of_val(&values[..]),
            Self::Long(values) => size_of_val(&values[..]),
            Self::Whole(values) => size_of_val(&values[..]),
            Self::Word(values, _) => size_of_val(&values[..]),
        }
    }
    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
    /// A value as a number; NaN for a word.
    pub fn number(&self, row: usize) -> f64 {
        match self {
            Self::Double(values) => values[row],
            Self::Single(values) => f64::from(values[row]),
            Self::Long(values) => values[row] as f64,
            Self::Whole(values) => f64::from(values[row]),
            Self::Word(..) => f64::NAN,
        }
    }
    /// A value as it is written into CSV: numbers so that they read back exactly, nothing where there is none.
    pub fn text(&self, row: usize) -> String {
        match self {
            Self::Double(values) if values[row].is_nan() => String::new(),
            Self::Double(values) => values[row].to_string(),
            Self::Single(values) if values[row].is_nan() => String::new(),
            Self::Single(values) => values[row].to_string(),
            Self::Long(values) => values[row].to_string(),
            Self::Whole(values) => values[row].to_string(),
            Self::Word(values, words) => {
                let word = words.get(values[row] as usize).map_or("", String::as_str);
                if word.contains([',', '"', '\n', '\r']) {
                    format!("\"{}\"", word.replace('"', "\"\""))
                } else {
                    word.to_owned()
                }
            }
        }
    }
}

fn fault(error: &ParquetError) -> StoreError {
    StoreError::Damaged(format!("a table could not be made or read: {error}"))
}

fn schema(headings: &[Heading]) -> Result<Arc<Type>, ParquetError> {
    let field = |heading: &Heading| {
        let physical = match heading.kind {
            Kind::Double => Physical::DOUBLE,
            Kind::Single => Physical::FLOAT,
            Kind::Long => Physical::INT64,
            Kind::Whole => Physical::INT32,
            Kind::Word => Physical::BYTE_ARRAY,
        };
        // a missing number or word is null, which every reader knows
        let repetition = if heading.always { Repetition::REQUIRED } else { Repetition::OPTIONAL };
        let logical = (heading.kind == Kind::Word).then_some(LogicalType::String);
        let built = Type::primitive_type_builder(&heading.name, physical)
            .with_repetition(repetition)
            .with_logical_type(logical)
            .build();
        built.map(Arc::new)
    };
    let fields = headings.iter().map(field).collect::<Result<Vec<_>, _>>()?;
    Type::group_type_builder("table").with_fields(fields).build().map(Arc::new)
}

/// Rows of one value, one after the other, from which on a column is kept as runs.
const RUN: usize = 32;

/// Whether equal values mostly follow each other.
fn repeats<T: PartialEq>(values: &[T]) -> bool {
    let most = values.len() / RUN;
    values.windows(2).filter(|pair| pair[0] != pair[1]).take(most + 1).count() <= most
}

/// How columns are kept. Numbers that are always there and differ from row to row (positions, velocities) stand as they
/// are: compressing them takes several times as long as all the rest and gains less than a fifth. Where one number is repeated
/// (times), its bytes are compressed one after the other, which is quicker than to look each up in a dictionary.
fn properties(
    headings: &[Heading],
    columns: &[Values],
    notes: &[(String, String)],
) -> Result<WriterProperties, ParquetError> {
    let mut builder = WriterProperties::builder()
        .set_created_by("flockworks".into())
        .set_compression(Compression::ZSTD(ZstdLevel::try_new(1)?))
        .set_dictionary_enabled(false)
        .set_offset_index_disabled(true)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_data_page_row_count_limit(usize::MAX)
        .set_data_page_size_limit(1 << 22);
    for (k, heading) in headings.iter().enumerate() {
        let path = ColumnPath::new(vec![heading.name.clone()]);
        let runs = match columns.get(k) {
            Some(Values::Double(values)) => repeats(values),
            Some(Values::Single(values)) => repeats(values),
            _ => false,
        };
        builder = match heading.kind {
            Kind::Double | Kind::Single if heading.always && !runs => {
                builder.set_column_compression(path, Compression::UNCOMPRESSED)
            }
            Kind::Double | Kind::Single => builder.set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT),
            Kind::Long | Kind::Whole => builder.set_column_encoding(path, Encoding::DELTA_BINARY_PACKED),
            Kind::Word => builder.set_column_dictionary_enabled(path, true),
        };
    }
    let mut meta = Vec::new();
    for heading in headings {
        let note = serde_json::json!({ "unit": heading.unit, "about": heading.about });
        meta.push(KeyValue::new(format!("flockworks.column.{}", heading.name), note.to_string()));
    }
    meta.extend(notes.iter().map(|(key, value)| KeyValue::new(key.clone(), value.clone())));
    Ok(builder.set_key_value_metadata(Some(meta)).build())
}

/// What makes the blocks of a table, one after the other. A column that is the same as in the block before (the numbers of
/// the agents, the names of their groups) is taken from there, encoded as it is.
pub struct Blocks {
    headings: Vec<Heading>,
    schema: Arc<Type>,
    before: Option<(Vec<Values>, Bytes)>,
}

impl Blocks {
    /// For blocks of a table with these columns.
    ///
    /// # Errors
    /// Where there can be no such table.
    pub fn new(headings: &[Heading]) -> Result<Self, StoreError> {
        let schema = schema(headings).map_err(|error| fault(&error))?;
        Ok(Self { headings: headings.to_vec(), schema, before: None })
    }
    /// The next block: the bytes of a Parquet file of one row group.
    ///
    /// # Errors
    /// Where the columns are not of one length or of their kinds.
    pub fn next(&mut self, columns: Vec<Values>) -> Result<Bytes, StoreError> {
        let rows = columns.first().map_or(0, Values::len);
        if self.headings.len() != columns.len() || columns.iter().any(|c| c.len() != rows) {
            return Err(StoreError::Damaged("the columns of a table differ in length".into()));
        }
        let block = Bytes::from(self.encode(&columns).map_err(|error| fault(&error))?);
        self.before = Some((columns, block.clone()));
        Ok(block)
    }
    fn encode(&self, columns: &[Values]) -> Result<Vec<u8>, ParquetError> {
        let properties = Arc::new(properties(&self.headings, columns, &[])?);
        let raw: usize = columns.iter().map(Values::bytes).sum();
        let out = Vec::with_capacity(raw + raw / 8 + (1 << 12));
        let mut writer = SerializedFileWriter::new(out, Arc::clone(&self.schema), properties)?;
        let mut group = writer.next_row_group()?;
        let before = match &self.before {
            Some((columns, block)) => Some((columns, block, SerializedFileReader::new(block.clone())?)),
            None => None,
        };
        for (k, values) in columns.iter().enumerate() {
            if let Some((columns, block, reader)) = &before
                && columns[k] == *values
            {
                append(&mut group, block, reader.metadata().row_group(0), k)?;
                continue;
            }
            let Some(mut column) = group.next_column()? else { break };
            let always = self.headings[k].always;
            match values {
                Values::Double(values) => write::<DoubleType>(&mut column, values, always, |v| !v.is_nan())?,
                Values::Single(values) => write::<FloatType>(&mut column, values, always, |v| !v.is_nan())?,
                Values::Long(values) => write::<Int64Type>(&mut column, values, always, |_| true)?,
                Values::Whole(values) => write::<Int32Type>(&mut column, values, always, |_| true)?,
                Values::Word(values, words) => {
                    let words: Vec<ByteArray> =
                        words.iter().map(|word| ByteArray::from(word.as_bytes().to_vec())).collect();
                    let nothing = ByteArray::from(Vec::new());
                    let word = |k: &u32| words.get(*k as usize).unwrap_or(&nothing).clone();
                    let values: Vec<ByteArray> = values.iter().map(word).collect();
                    write::<ByteArrayType>(&mut column, &values, always, |word| !word.is_empty())?;
                }
            }
            column.close()?;
        }
        group.close()?;
        writer.into_inner()
    }
}

/// Writes values into a column, of which those that are not `there` are null unless all have to be there `always`.
fn write<T: DataType>(
    column: &mut SerializedColumnWriter<'_>,
    values: &[T::T],
    always: bool,
    there: impl Fn(&T::T) -> bool,
) -> Result<(), ParquetError> {
    if always {
        column.typed::<T>().write_batch(values, None, None)?;
    } else if values.iter().all(&there) {
        column.typed::<T>().write_batch(values, Some(&vec![1; values.len()]), None)?;
    } else {
        let levels: Vec<i16> = values.iter().map(|v| i16::from(there(v))).collect();
        let values: Vec<T::T> = values.iter().filter(|v| there(v)).cloned().collect();
        column.typed::<T>().write_batch(&values, Some(&levels), None)?;
    }
    Ok(())
}

/// Joins blocks into one file; `notes` go into its metadata.
///
/// # Errors
/// Where a block is damaged or the system refuses to write.
pub fn join<W: Write + Send>(
    out: W,
    headings: &[Heading],
    notes: &[(String, String)],
    blocks: impl Iterator<Item = Result<Bytes, StoreError>>,
) -> Result<W, StoreError> {
    let begin = || {
        let properties = Arc::new(properties(headings, &[], notes)?);
        SerializedFileWriter::new(out, schema(headings)?, properties)
    };
    let mut writer = begin().map_err(|error| fault(&error))?;
    for block in blocks {
        splice(&mut writer, &block?).map_err(written)?;
    }
    writer.into_inner().map_err(written)
}

/// A failure to write, with the system's reason where there is one.
fn written(error: ParquetError) -> StoreError {
    match error {
        ParquetError::External(source) => match source.downcast::<std::io::Error>() {
            Ok(error) => StoreError::Io { doing: "write a table".into(), error: *error },
            Err(other) => StoreError::Damaged(format!("a table could not be written: {other}")),
        },
        other => fault(&other),
    }
}

fn splice<W: Write + Send>(writer: &mut SerializedFileWriter<W>, block: &Bytes) -> Result<(), ParquetError> {
    let reader = SerializedFileReader::new(block.clone())?;
    for group in reader.metadata().row_groups() {
        let mut to = writer.next_row_group()?;
        for column in 0..group.num_columns() {
            append(&mut to, block, group, column)?;
        }
        to.close()?;
    }
    Ok(())
}

/// Appends a column of a block as it is encoded there.
fn append<W: Write + Send>(
    to: &mut SerializedRowGroupWriter<'_, W>,
    block: &Bytes,
    group: &RowGroupMetaData,
    column: usize,
) -> Result<(), ParquetError> {
    let column = group.column(column);
    let close = ColumnCloseResult {
        bytes_written: u64::try_from(column.compressed_size()).unwrap_or(0),
        rows_written: u64::try_from(group.num_rows()).unwrap_or(0),
        metadata: column.clone(),
        bloom_filter: None,
        column_index: None,
        offset_index: None,
    };
    to.append_column(block, close)
}

/// Rows of a block of a table that is written at once.
const ROWS: usize = 65_536;

/// Writes a whole table into a folder; `columns` are those of `headings`, all of one length.
///
/// # Errors
/// Where the system refuses.
pub fn write_table(
    folder: &crate::folder::Folder,
    name: &str,
    headings: &[Heading],
    columns: &[Values],
    notes: &[(String, String)],
) -> Result<(), StoreError> {
    let rows = columns.first().map_or(0, Values::len);
    let mut made = Blocks::new(headings)?;
    let blocks = (0..rows.div_ceil(ROWS))
        .map(|k| made.next(columns.iter().map(|values| slice(values, k * ROWS, rows)).collect()));
    folder.write(name, |out| join(out, headings, notes, blocks).map(|_| ()))
}

/// Writes a table whose columns are made of its rows, a block at a time: of many rows only those of one block are held as columns.
///
/// # Errors
/// As of [`write_table`].
pub fn write_rows<R>(
    folder: &crate::folder::Folder,
    name: &str,
    mut rows: impl Iterator<Item = R>,
    columns: impl Fn(&[R]) -> (Vec<Heading>, Vec<Values>),
    notes: &[(String, String)],
) -> Result<(), StoreError> {
    let headings = columns(&[]).0;
    let mut made = Blocks::new(&headings)?;
    let blocks = core::iter::from_fn(|| {
        let block: Vec<R> = rows.by_ref().take(ROWS).collect();
        (!block.is_empty()).then(|| made.next(columns(&block).1))
    });
    folder.write(name, |out| join(out, &headings, notes, blocks).map(|_| ()))
}

fn slice(values: &Values, from: usize, rows: usize) -> Values {
    let range = from..(from + ROWS).min(rows);
    match values {
        Values::Double(values) => Values::Double(values[range].to_vec()),
        Values::Single(values) => Values::Single(values[range].to_vec()),
        Values::Long(values) => Values::Long(values[range].to_vec()),
        Values::Whole(values) => Values::Whole(values[range].to_vec()),
        Values::Word(values, words) => Values::Word(values[range].to_vec(), Arc::clone(words)),
    }
}

/// A table that is read row group by row group.
pub struct Table {
    reader: SerializedFileReader<std::fs::File>,
    headings: Vec<Heading>,
}

impl Table {
    /// Opens a table.
    ///
    /// # Errors
    /// Where the system refuses, or it is no table of this program.
    pub fn open(path: &std::path::Path) -> Result<Self, StoreError> {
        let file = std::fs::File::open(path).map_err(|error| StoreError::io("open", path, error))?;
        let damaged = |what: String| StoreError::Damaged(format!("`{}`: {what}", path.display()));
        let reader =
            SerializedFileReader::new(file).map_err(|error| damaged(format!("not a Parquet table: {error}")))?;
        let meta = reader.metadata().file_metadata();
        let mut headings = Vec::new();
        for column in meta.schema_descr().columns() {
            let kind = match column.physical_type() {
                Physical::DOUBLE => Kind::Double,
                Physical::FLOAT => Kind::Single,
                Physical::INT64 => Kind::Long,
                Physical::INT32 => Kind::Whole,
                Physical::BYTE_ARRAY => Kind::Word,
                other => return Err(damaged(format!("column `{}` is of the type {other}", column.name()))),
            };
            let key = format!("flockworks.column.{}", column.name());
            let note = meta.key_value_metadata().and_then(|all| all.iter().find(|note| note.key == key));
            let note: serde_json::Value = note
                .and_then(|note| note.value.as_deref())
                .and_then(|text| serde_json::from_str(text).ok())
                .unwrap_or_default();
            let word = |key: &str| note.get(key).and_then(|v| v.as_str()).unwrap_or("");
            let heading = Heading::new(column.name(), word("unit"), word("about"), kind);
            headings.push(if column.max_def_level() == 0 { heading.always() } else { heading });
        }
        Ok(Self { reader, headings })
    }
    /// What the columns are.
    pub fn headings(&self) -> &[Heading] {
        &self.headings
    }
    /// Number of row groups.
    pub fn groups(&self) -> usize {
        self.reader.metadata().num_row_groups()
    }
    /// Number of rows.
    pub fn rows(&self) -> u64 {
        u64::try_from(self.reader.metadata().file_metadata().num_rows()).unwrap_or(0)
    }
    /// Number of rows in a row group.
    pub fn rows_in(&self, group: usize) -> u64 {
        u64::try_from(self.reader.metadata().row_group(group).num_rows()).unwrap_or(0)
    }
    /// The place of a column.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.headings.iter().position(|heading| heading.name == name)
    }
    /// The values of some columns in a row group.
    ///
    /// # Errors
    /// Where the file is damaged.
    pub fn read(&self, group: usize, columns: &[usize]) -> Result<Vec<Values>, StoreError> {
        columns.iter().map(|&column| self.values(group, column).map_err(|error| fault(&error))).collect()
    }
    fn values(&self, group: usize, column: usize) -> Result<Values, ParquetError> {
        let group = self.reader.get_row_group(group)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let mut levels = Vec::with_capacity(rows);
        Ok(match group.get_column_reader(column)? {
            ColumnReader::DoubleColumnReader(mut reader) => {
                let mut values = Vec::with_capacity(rows);
                reader.read_records(rows, Some(&mut levels), None, &mut values)?;
                Values::Double(spread(values, &levels, f64::NAN))
            }
            ColumnReader::FloatColumnReader(mut reader) => {
                let mut values = Vec::with_capacity(rows);
                reader.read_records(rows, Some(&mut levels), None, &mut values)?;
                Values::Single(spread(values, &levels, f32::NAN))
            }
            ColumnReader::Int64ColumnReader(mut reader) => {
                let mut values = Vec::with_capacity(rows);
                reader.read_records(rows, None, None, &mut values)?;
                Values::Long(values)
            }
            ColumnReader::Int32ColumnReader(mut reader) => {
                let mut values = Vec::with_capacity(rows);
                reader.read_records(rows, None, None, &mut values)?;
                Values::Whole(values)
            }
            ColumnReader::ByteArrayColumnReader(mut reader) => {
                let mut values = Vec::with_capacity(rows);
                reader.read_records(rows, Some(&mut levels), None, &mut values)?;
                let mut words = vec![String::new()];
                let mut places = Vec::with_capacity(values.len());
                for value in &values {
                    let word = value.as_utf8()?;
                    let at = words.iter().position(|other| other == word).unwrap_or_else(|| {
                        words.push(word.to_owned());
                        words.len() - 1
                    });
                    places.push(u32::try_from(at).map_err(|_| ParquetError::General("too many words".into()))?);
                }
                Values::Word(spread(places, &levels, 0), Arc::new(words))
            }
            _ => return Err(ParquetError::General("a column of an unknown type".into())),
        })
    }
}

/// Values with a filling where the level says that there is none; a column whose values are always there has no levels.
fn spread<T: Copy>(values: Vec<T>, levels: &[i16], none: T) -> Vec<T> {
    if levels.is_empty() || values.len() == levels.len() {
        return values;
    }
    let mut values = values.into_iter();
    levels.iter().map(|&level| if level == 1 { values.next().unwrap_or(none) } else { none }).collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn headings() -> Vec<Heading> {
        vec![
            Heading::new("frame", "1", "Number of the frame.", Kind::Long),
            Heading::new("id", "1", "Number of the agent.", Kind::Whole),
            Heading::new("x", "m", "Position.", Kind::Double),
            Heading::new("y", "m", "Position.", Kind::Single).always(),
            Heading::new("group", "", "Name of its group.", Kind::Word),
            Heading::new("t", "s", "Time.", Kind::Double).always(),
        ]
    }

    fn columns(first: i64, rows: usize) -> Vec<Values> {
        let words = Arc::new(vec!["a, \"b\"".to_owned(), String::new(), "c".to_owned()]);
        vec![
            Values::Long((0..rows as i64).map(|k| first + k).collect()),
            Values::Whole((0..rows as i32).collect()),
            Values::Double((0..rows).map(|k| if k % 3 == 1 { f64::NAN } else { 0.1 * k as f64 }).collect()),
            Values::Single((0..rows).map(|k| k as f32).collect()),
            Values::Word((0..rows).map(|k| (k % 3) as u32).collect(), words),
            Values::Double((0..rows).map(|k| first as f64 + (k / 50) as f64).collect()),
        ]
    }

    #[test]
    fn blocks_joined_read_back() {
        let path = std::env::temp_dir().join(format!("flockworks-table-{}.parquet", std::process::id()));
        // as one goes on, or as one who begins anew with every block
        let make = |anew: bool| {
            let mut made = Blocks::new(&headings()).unwrap();
            let blocks = [(0, 5), (5, 1), (6, 700), (7, 700), (7, 700)].map(|(first, rows)| {
                if anew {
                    made = Blocks::new(&headings()).unwrap();
                }
                made.next(columns(first, rows))
            });
            let notes = [("note".to_owned(), "text".to_owned())];
            join(Vec::new(), &headings(), &notes, blocks.into_iter()).unwrap()
        };
        let bytes = make(false);
        assert_eq!(bytes, make(true), "equal values give equal bytes, whatever came before them");
        std::fs::write(&path, bytes).unwrap();
        let table = Table::open(&path).unwrap();
        assert_eq!(table.headings(), headings());
        assert_eq!((table.groups(), table.rows()), (5, 2106));
        let read = table.read(2, &[0, 1, 2, 3, 4, 5]).unwrap();
        let written = columns(6, 700);
        for (column, (read, written)) in read.iter().zip(&written).enumerate() {
            for row in 0..700 {
                assert_eq!(read.text(row), written.text(row), "column {column}, row {row}");
            }
        }
        assert_eq!(read[4].text(0), "\"a, \"\"b\"\"\"");
        assert_eq!(table.column("y"), Some(3));
        std::fs::remove_file(&path).unwrap();
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut uneven = columns(0, 3);
        uneven[2] = Values::Double(vec![1.0]);
        assert!(Blocks::new(&headings()).unwrap().next(uneven).is_err());
        let damaged = [Ok(Bytes::from(vec![1, 2, 3]))];
        assert!(join(Vec::new(), &headings(), &[], damaged.into_iter()).is_err());
    }
}
