//! The tables of a map: its leaves, and what was measured.

use super::measures::Found;
use crate::design::tables::words;
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};
use search::refine::Leaf;

/// A row for each leaf of each panel.
pub const LEAVES: &str = "leaves.parquet";
/// A row for each measure.
pub const MEASURES: &str = "measures.parquet";

/// Writes the tables.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, found: &Found<'_>) -> Result<(), StoreError> {
    let notes = [("flockworks.title".to_owned(), found.plan.form.title.clone())];
    let (headings, columns) = leaves(found);
    write_table(folder, LEAVES, &headings, &columns, &notes)?;
    let measures = &found.plan.form.measure.0;
    let headings = [
        Heading::new("measure", "", "What was measured.", Kind::Word),
        Heading::new("value", "", "Its value.", Kind::Double),
    ];
    let columns = [
        words(measures.iter().map(|(name, _)| name.clone())),
        Values::Double(measures.iter().map(|(_, form)| found.measure(form)).collect()),
    ];
    write_table(folder, MEASURES, &headings, &columns, &notes)
}

fn leaves(found: &Found<'_>) -> (Vec<Heading>, Vec<Values>) {
    let rows: Vec<(usize, &Leaf)> = found
        .panels
        .iter()
        .enumerate()
        .flat_map(|(k, panel)| panel.map.leaves().iter().map(move |leaf| (k, leaf)))
        .collect();
    let result = |row: &(usize, &Leaf)| found.panels[row.0].result(row.1);
    let component = |row: &(usize, &Leaf), components: &[Vec<Vec<usize>>]| {
        let place = found.panels[row.0].map.leaves().iter().position(|leaf| leaf.evaluation == row.1.evaluation);
        let of = components[row.0].iter().position(|leaves| place.is_some_and(|k| leaves.binary_search(&k).is_ok()));
        of.map_or(0, |k| k as i64 + 1)
    };
    let components: Vec<Vec<Vec<usize>>> = found.panels.iter().map(|panel| panel.map.region().components()).collect();
    let mut headings = vec![Heading::new("panel", "", "The panel.", Kind::Word)];
    let mut columns = vec![words(rows.iter().map(|(panel, _)| found.plan.panels[*panel].population.name.clone()))];
    for (k, axis) in found.plan.axes.iter().enumerate() {
        let name = &axis.name;
        for (end, about) in [("low", "lower end"), ("centre", "centre"), ("high", "upper end")] {
            let value = |(panel, leaf): &(usize, &Leaf)| {
                let map = &found.panels[*panel].map;
                match end {
                    "low" => map.bounds(&leaf.cell).0[k],
                    "high" => map.bounds(&leaf.cell).1[k],
                    _ => map.centre(&leaf.cell)[k],
                }
            };
            let about = format!("`{name}`: {about} of the cell.");
            headings.push(Heading::new(&format!("{name}_{end}"), &axis.unit, &about, Kind::Double));
            columns.push(Values::Double(rows.iter().map(value).collect()));
        }
    }
    headings.extend([
        Heading::new("trials", "1", "Trials; 0 outside the schema's domain.", Kind::Long),
        Heading::new("rate", "1", "Share of successes.", Kind::Double),
        Heading::new("fitness", "1", "Mean fitness.", Kind::Double),
        Heading::new("valid", "1", "1 where the cell counts as valid.", Kind::Long),
        Heading::new("generation", "1", "The iteration that made it; 0: the base grid.", Kind::Long),
        Heading::new("component", "1", "Its connected valid region, from 1; 0 where it is not valid.", Kind::Long),
    ]);
    columns.extend([
        Values::Long(rows.iter().map(|row| result(row).trials as i64).collect()),
        Values::Double(rows.iter().map(|row| result(row).rate()).collect()),
        Values::Double(rows.iter().map(|row| result(row).fitness).collect()),
        Values::Long(rows.iter().map(|row| i64::from(row.1.found.valid)).collect()),
        Values::Long(rows.iter().map(|row| i64::from(row.1.cell.generation)).collect()),
        Values::Long(rows.iter().map(|row| component(row, &components)).collect()),
    ]);
    (headings, columns)
}
