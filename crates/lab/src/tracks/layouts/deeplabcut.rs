//! DeepLabCut: three header lines (scorer, body parts, coordinates), four where there are several animals; then the
//! number of the frame, and x, y and likelihood of each body part.

use super::{Layout, Place, Plan, Point, Who, chosen_points};
use crate::store::StoreError;
use crate::tracks::Ask;
use crate::tracks::text::Head;

pub(super) const LAYOUT: Layout = Layout {
    id: "deeplabcut",
    about: "DeepLabCut and Lightning Pose: three or four header lines",
    takes: &["point"],
    plan,
};

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let line = |name: &str| head.rows.iter().take(4).position(|row| row.first().is_some_and(|cell| cell == name));
    let (Some(0), Some(parts), Some(coordinates)) = (line("scorer"), line("bodyparts"), line("coords")) else {
        return Ok(None);
    };
    let individuals = line("individuals");
    let cell = |row: usize, column: usize| head.rows[row].get(column).map_or("", String::as_str);
    let columns = head.rows[coordinates].len();
    let names: Vec<String> = (0..columns)
        .map(|c| {
            let rows = individuals.into_iter().chain([parts, coordinates]);
            rows.map(|row| cell(row, c)).collect::<Vec<_>>().join(".")
        })
        .collect();
    // an animal with its body parts, in the order of the file
    let mut animals: Vec<(String, Vec<(String, Point)>)> = Vec::new();
    for column in 1..columns {
        let who = individuals.map_or("individual", |row| cell(row, column));
        let part = cell(parts, column);
        let at = animals.iter().position(|(name, _)| name == who).unwrap_or_else(|| {
            animals.push((who.to_owned(), Vec::new()));
            animals.len() - 1
        });
        let list = &mut animals[at].1;
        let at = list.iter().position(|(name, _)| name == part).unwrap_or_else(|| {
            list.push((part.to_owned(), Point::at(Vec::new())));
            list.len() - 1
        });
        match cell(coordinates, column) {
            "x" | "y" | "z" => list[at].1.axes.push(column),
            "likelihood" => list[at].1.confidence = Some(column),
            _ => {}
        }
    }
    let mut places = Vec::new();
    for (name, list) in &mut animals {
        list.retain(|(_, point)| point.axes.len() >= 2);
        if list.is_empty() {
            continue;
        }
        // of several animals, unique body parts belong to none of them
        if individuals.is_some() && name == "single" {
            continue;
        }
        let points = chosen_points(head, ask, list, name)?;
        places.push(Place { who: Who::Name(name.clone()), points, velocity: None });
    }
    if places.is_empty() {
        return Ok(None);
    }
    let skip = coordinates + 1;
    Ok(Some(Plan { skip, frame: Some(0), places, unit: Some("px".into()), names, ..Plan::default() }))
}
