//! Tables in other forms.

use crate::StoreError;
use crate::table::{Heading, Table, Values};
use std::io::Write;

/// Writes a table as CSV: a line of names, then a line for each row. Numbers read back exactly; what is not there is empty.
///
/// # Errors
/// Where the table is damaged or the system refuses to write.
pub fn csv(table: &Table, out: &mut dyn Write) -> Result<(), StoreError> {
    csv_names(table.headings(), out)?;
    let all: Vec<usize> = (0..table.headings().len()).collect();
    for group in 0..table.groups() {
        csv_rows(&table.read(group, &all)?, out)?;
    }
    Ok(())
}

/// Writes the line of names.
///
/// # Errors
/// Where the system refuses to write.
pub fn csv_names(headings: &[Heading], out: &mut dyn Write) -> Result<(), StoreError> {
    let names: Vec<&str> = headings.iter().map(|heading| heading.name.as_str()).collect();
    writeln!(out, "{}", names.join(",")).map_err(failed)
}

/// Writes a line for each row of some columns.
///
/// # Errors
/// Where the system refuses to write.
pub fn csv_rows(columns: &[Values], out: &mut dyn Write) -> Result<(), StoreError> {
    let mut line = String::new();
    for row in 0..columns.first().map_or(0, Values::len) {
        line.clear();
        for (k, column) in columns.iter().enumerate() {
            if k > 0 {
                line.push(',');
            }
            line.push_str(&column.text(row));
        }
        line.push('\n');
        out.write_all(line.as_bytes()).map_err(failed)?;
    }
    Ok(())
}

fn failed(error: std::io::Error) -> StoreError {
    StoreError::Io { doing: "write a table as CSV".into(), error }
}
