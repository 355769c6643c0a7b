//! Figures with a line for each member, of runs with few.

use super::{Axis, Figure, Line, Lines};
use crate::scenario::Scenario;
use crate::store::StoreError;
use crate::store::table::Table;

/// So many members are told apart in a figure.
const MOST: usize = 12;

/// How far each member's nearest input was when it last decided, over time: where members keep that, and are few. Reversion to following
/// the nearest shows as one band for each member.
///
/// # Errors
/// Where the trajectory cannot be read.
pub(super) fn nearest_inputs(table: &Table, scenario: &Scenario) -> Result<Option<Figure>, StoreError> {
    let members: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
    let columns = ["t", "id", "nearest_ahead", "nearest_left"].map(|name| table.column(name));
    let ([Some(t), Some(id), Some(ahead), Some(left)], 1..=MOST) = (columns, members) else { return Ok(None) };
    let mut lines: Vec<Line> =
        (0..members).map(|id| Line { name: format!("member {id}"), x: Vec::new(), y: Vec::new() }).collect();
    for group in 0..table.groups() {
        let read = table.read(group, &[t, id, ahead, left])?;
        for row in 0..read[0].len() {
            let Some(line) = lines.get_mut(read[1].number(row) as usize) else { continue };
            let distance = read[2].number(row).hypot(read[3].number(row));
            line.x.push(read[0].number(row));
            line.y.push((distance > 0.0).then_some(distance));
        }
    }
    Ok(Some(Figure::Lines(Lines {
        id: "nearest_inputs".into(),
        title: "Distance to the nearest input".into(),
        about: "Of what each member's law was handed when it last decided; nothing where that was nobody.".into(),
        x: Axis { label: "time".into(), unit: scenario.units.time.clone(), range: None },
        y: Axis { label: "distance".into(), unit: scenario.units.length.clone(), range: None },
        lines,
    })))
}
