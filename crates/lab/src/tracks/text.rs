//! Tables of text: comma, semicolon, tab or blanks between the cells, comments before and between the rows.
//!
//! A table is read twice: its beginning, from which a layout is recognised, and then row by row into columns of numbers,
//! with no text kept of a row.

use super::gather::{Bad, Row};
use super::wrong;
use crate::store::StoreError;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

/// Bytes of a line beyond which a file is no table of tracks: a wide row of 10,000 individuals has a third of it.
const LONGEST_LINE: usize = 1 << 20;
/// Rows of the beginning that are looked at.
const LOOKED_AT: usize = 32;

/// The beginning of a table: what a layout is recognised by.
#[derive(Clone, Debug, Default)]
pub struct Head {
    /// The file.
    pub path: PathBuf,
    /// Comment lines, without the mark.
    pub comments: Vec<String>,
    /// The first rows, cell by cell, without blanks around. Of a Parquet file: the names of the columns alone.
    pub rows: Vec<Vec<String>>,
    /// What parts cells; none for a Parquet file.
    pub delimiter: Option<u8>,
    /// Columns of a Parquet file that hold words.
    pub words: Vec<usize>,
}

impl Head {
    /// Reads the beginning of a table of text.
    ///
    /// # Errors
    /// A file that cannot be read, is empty, or is no table of text.
    pub fn of_text(path: &Path) -> Result<Self, StoreError> {
        let file = File::open(path).map_err(|error| StoreError::io("read", path, error))?;
        let mut reader = BufReader::new(Guard::new(file));
        let mut head = Self { path: path.to_owned(), ..Self::default() };
        let (mut line, mut lines, mut number) = (Vec::new(), Vec::new(), 0);
        while lines.len() < LOOKED_AT {
            line.clear();
            let count = reader.read_until(b'\n', &mut line).map_err(|error| read_error(path, error))?;
            if count == 0 {
                break;
            }
            number += 1;
            let text = match core::str::from_utf8(&line) {
                Ok(text) => text.into(),
                // what a comment says in another alphabet does no harm
                Err(_) if line.trim_ascii_start().starts_with(b"#") => String::from_utf8_lossy(&line),
                Err(_) => return Err(wrong(path, &format!("line {number} is not text in UTF-8"))),
            };
            let text = text.trim_start_matches('\u{feff}').trim_end_matches(['\n', '\r']);
            match text.trim_start().strip_prefix('#') {
                Some(comment) => head.comments.push(comment.trim().to_owned()),
                None if text.trim().is_empty() => {}
                None => lines.push(text.to_owned()),
            }
        }
        let Some(first) = lines.first() else {
            return Err(wrong(path, "the file is empty; expected a table of positions"));
        };
        let delimiter = delimiter_of(first);
        head.delimiter = Some(delimiter);
        let text = lines.join("\n");
        let mut rows = csv_reader(text.as_bytes(), delimiter).into_byte_records();
        while let Some(Ok(row)) = rows.next() {
            head.rows.push(cells(&row, delimiter).map(|c| String::from_utf8_lossy(c).into_owned()).collect());
        }
        Ok(head)
    }
    /// Whether every cell of a row is a number or missing, and one at least is a number.
    pub fn numeric(&self, row: usize) -> bool {
        let cells = || self.rows.get(row).into_iter().flatten();
        let reads = |cell: &String| number(cell.as_bytes(), self.decimal_comma());
        cells().all(|cell| reads(cell).is_ok()) && cells().any(|cell| reads(cell).is_ok_and(f64::is_finite))
    }
    /// Whether a column holds words behind the rows that are skipped.
    pub fn holds_words(&self, column: usize, skip: usize) -> bool {
        let cells = self.rows.iter().skip(skip).filter_map(|row| row.get(column));
        let mut words = cells.filter(|cell| number(cell.as_bytes(), self.decimal_comma()).is_err());
        self.words.contains(&column) || words.next().is_some()
    }
    /// The cells of a row as names; of a row of numbers, none.
    pub fn header(&self) -> Option<&[String]> {
        let first = self.rows.first()?;
        (self.delimiter.is_none() || !self.numeric(0)).then_some(first)
    }
    /// Whether a comma inside a number stands for the decimal point.
    pub fn decimal_comma(&self) -> bool {
        self.delimiter != Some(b',')
    }
    /// The file's name, without its ending.
    pub fn stem(&self) -> String {
        self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    }
}

/// What parts the cells of a line: a tab or a semicolon where there is one, else a comma, else blanks.
fn delimiter_of(line: &str) -> u8 {
    [b'\t', b';', b','].into_iter().find(|&mark| line.contains(mark as char)).unwrap_or(b' ')
}

fn csv_reader<R: Read>(from: R, delimiter: u8) -> csv::Reader<R> {
    csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter)
        .comment(Some(b'#'))
        .buffer_capacity(1 << 18)
        .from_reader(from)
}

/// The cells of a row without blanks around them; between blanks, none are empty.
fn cells(row: &csv::ByteRecord, delimiter: u8) -> impl Iterator<Item = &[u8]> {
    row.iter().map(<[u8]>::trim_ascii).filter(move |cell| delimiter != b' ' || !cell.is_empty())
}

/// A row of a table of text.
pub(super) struct TextRow<'a> {
    record: &'a csv::ByteRecord,
    /// Which cells count, where blanks part them.
    filled: Option<&'a [usize]>,
    decimal_comma: bool,
}

impl Row for TextRow<'_> {
    fn number(&self, column: usize) -> Result<f64, Bad> {
        let cell = self.word(column)?;
        number(cell, self.decimal_comma).map_err(|NotNumber| Bad::Word(String::from_utf8_lossy(cell).into_owned()))
    }
    fn word(&self, column: usize) -> Result<&[u8], Bad> {
        let at = match self.filled {
            Some(filled) => filled.get(column).copied(),
            None => Some(column),
        };
        let count = || self.filled.map_or(self.record.len(), <[usize]>::len);
        at.and_then(|at| self.record.get(at)).map(<[u8]>::trim_ascii).ok_or_else(|| Bad::Short(count()))
    }
    fn place(&self) -> String {
        format!("line {}", self.record.position().map_or(0, csv::Position::line))
    }
}

/// Calls `each` for every row behind those that are skipped.
///
/// # Errors
/// What `each` says, or a file that cannot be read or is no table of text.
pub(super) fn each_row(
    head: &Head,
    skip: usize,
    each: &mut dyn FnMut(&dyn Row) -> Result<(), StoreError>,
) -> Result<(), StoreError> {
    let path = &head.path;
    let delimiter = head.delimiter.unwrap_or(b',');
    let file = File::open(path).map_err(|error| StoreError::io("read", path, error))?;
    let mut reader = csv_reader(Guard::new(file), delimiter);
    let mut record = csv::ByteRecord::new();
    let mut filled = Vec::new();
    let mut number = 0;
    // as many as the first row has
    let expected = head.rows.get(skip).map_or(usize::MAX, Vec::len);
    while reader.read_byte_record(&mut record).map_err(|error| csv_error(path, error))? {
        if record.iter().all(|cell| cell.trim_ascii().is_empty()) {
            continue;
        }
        number += 1;
        if number <= skip {
            continue;
        }
        if delimiter == b' ' {
            filled.clear();
            filled.extend((0..record.len()).filter(|&k| !record[k].trim_ascii().is_empty()));
        }
        let filled = (delimiter == b' ').then_some(filled.as_slice());
        let count = filled.map_or(record.len(), <[usize]>::len);
        if count > expected
            && (filled.is_some() || record.iter().skip(expected).any(|cell| !missing(cell.trim_ascii())))
        {
            let line = record.position().map_or(0, csv::Position::line);
            return Err(wrong(path, &format!("line {line} has {count} cells, and the first row {expected}")));
        }
        each(&TextRow { record: &record, filled, decimal_comma: head.decimal_comma() })?;
    }
    Ok(())
}

fn csv_error(path: &Path, error: csv::Error) -> StoreError {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => read_error(path, error),
        other => wrong(path, &format!("{other:?}")),
    }
}

/// What the guard refuses is the file's fault; anything else is the system's.
fn read_error(path: &Path, error: std::io::Error) -> StoreError {
    if error.kind() == std::io::ErrorKind::InvalidData {
        return wrong(path, &error.to_string());
    }
    StoreError::io("read", path, error)
}

/// Passes bytes on until they cannot be those of a table of text: a zero byte, or a line without an end.
struct Guard<R> {
    inner: R,
    line: usize,
    column: usize,
}

impl<R> Guard<R> {
    fn new(inner: R) -> Self {
        Self { inner, line: 1, column: 0 }
    }
}

impl<R: Read> Read for Guard<R> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let refuse = |text: String| std::io::Error::new(std::io::ErrorKind::InvalidData, text);
        let count = self.inner.read(to)?;
        let read = &to[..count];
        if read.contains(&0) {
            return Err(refuse("binary data; expected a table of text (CSV, TSV) or a Parquet file".into()));
        }
        let mut rest = read;
        while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
            self.line += 1;
            self.column = 0;
            rest = &rest[end + 1..];
        }
        self.column += rest.len();
        if self.column > LONGEST_LINE {
            let what = format!("line {} is longer than {LONGEST_LINE} bytes; expected a table of text", self.line);
            return Err(refuse(what));
        }
        Ok(count)
    }
}

/// A cell as a number; not a number where it says that there is none.
///
/// # Errors
/// Where it is a word.
pub fn number(cell: &[u8], decimal_comma: bool) -> Result<f64, NotNumber> {
    if MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word)) {
        return Ok(f64::NAN);
    }
    let text = core::str::from_utf8(cell).map_err(|_| NotNumber)?;
    match text.parse::<f64>() {
        // infinity stands for a lost individual in TRex's exports
        Ok(number) if number.is_infinite() => Ok(f64::NAN),
        Ok(number) => Ok(number),
        Err(_) if decimal_comma && text.matches(',').count() == 1 => {
            text.replace(',', ".").parse().map_err(|_| NotNumber)
        }
        Err(_) => Err(NotNumber),
    }
}

/// Words for a value that is not there.
const MISSING: [&[u8]; 8] = [b"", b"NA", b"NaN", b"N/A", b"null", b"none", b"-", b"."];

/// A cell that is no number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotNumber;

/// Whether a cell says that there is no value.
pub fn missing(cell: &[u8]) -> bool {
    MISSING.iter().any(|word| cell.eq_ignore_ascii_case(word))
}
