//! Tables in other forms.

use super::StoreError;
use super::table::Table;
use std::io::Write;

/// Writes a table as CSV: a line of names, then a line for each row. Numbers read back exactly; what is not there is empty.
///
/// # Errors
/// Where the table is damaged or the system refuses to write.
pub fn csv(table: &Table, out: &mut dyn Write) -> Result<(), StoreError> {
    let failed = |error| StoreError::Io { doing: "write a table as CSV".into(), error };
    let names: Vec<&str> = table.headings().iter().map(|heading| heading.name.as_str()).collect();
    writeln!(out, "{}", names.join(",")).map_err(failed)?;
    let all: Vec<usize> = (0..names.len()).collect();
    let mut line = String::new();
    for group in 0..table.groups() {
        let columns = table.read(group, &all)?;
        for row in 0..columns.first().map_or(0, super::table::Values::len) {
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
    }
    Ok(())
}
