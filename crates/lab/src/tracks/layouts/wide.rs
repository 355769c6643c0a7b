//! A wide table: a row for each frame, with the coordinates of every individual side by side. With names, as
//! `x1,y1,x2,y2`, `fish1_x,fish1_y`, `a.x,a.y`; without, the frame and then two numbers for each individual.

use super::{Clock, Layout, Place, Plan, Point, Who};
use crate::store::StoreError;
use crate::tracks::text::{Head, number};
use crate::tracks::{Ask, names, wrong};

pub(super) const LAYOUT: Layout = Layout {
    id: "wide",
    about: "any wide table: a row for each frame, individuals side by side",
    takes: &["frame", "time", "id", "wide", "clock"],
    plan,
};

pub(super) fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    match head.header() {
        Some(names) => named(head, ask, names.to_vec()),
        None => nameless(head, ask),
    }
}

/// An axis and the individual of a name: x1, X_fish, fish1_x, a.y.
fn split(name: &str) -> Option<(usize, String)> {
    let name = names::split_unit(name).0;
    let axis = |letter: char| "xyz".find(letter.to_ascii_lowercase());
    let (first, last) = (name.chars().next()?, name.chars().next_back()?);
    let behind = &name[first.len_utf8()..];
    let before = &name[..name.len() - last.len_utf8()];
    let parts = ['_', '.', ' ', '-'];
    if let Some(a) = axis(first)
        && behind.starts_with(|c: char| c.is_ascii_digit() || parts.contains(&c))
    {
        return Some((a, behind.trim_start_matches(parts).to_owned()));
    }
    if let Some(a) = axis(last)
        && before.ends_with(|c: char| c.is_ascii_digit() || parts.contains(&c))
    {
        return Some((a, before.trim_end_matches(parts).to_owned()));
    }
    None
}

fn named(head: &Head, ask: &Ask, names: Vec<String>) -> Result<Option<Plan>, StoreError> {
    let mut individuals: Vec<(String, [Option<usize>; 3])> = Vec::new();
    for (column, name) in names.iter().enumerate() {
        let Some((axis, who)) = split(name) else { continue };
        let at = individuals.iter().position(|(other, _)| *other == who).unwrap_or_else(|| {
            individuals.push((who, [None; 3]));
            individuals.len() - 1
        });
        individuals[at].1[axis] = Some(column);
    }
    individuals.retain(|(_, axes)| axes[0].is_some() && axes[1].is_some());
    if individuals.is_empty() {
        return Ok(None);
    }
    let at = |role| names::column(head, &names, ask, role);
    if let ([(_, [Some(x), Some(y), _])], Some(id)) = (individuals.as_slice(), at("id")?) {
        let [x, y, id] = [x, y, &id].map(|&column| &names[column]);
        return Err(wrong(
            &head.path,
            &format!(
                "`{x}` and `{y}` are named as those of one individual, and `{id}` as a column of several: say --columns \
                 x={x},y={y}, or --columns id=none"
            ),
        ));
    }
    let flat = individuals.iter().filter(|(_, axes)| axes[2].is_none()).count();
    if flat != 0 && flat != individuals.len() {
        return Err(wrong(&head.path, "some individuals have a z and others none"));
    }
    let place = |(who, axes): (String, [Option<usize>; 3])| Place {
        who: Who::Name(who),
        points: vec![Point::at(axes.into_iter().flatten().collect())],
        velocity: None,
    };
    let places = individuals.into_iter().map(place).collect();
    let (frame, time) = (at("frame")?, at("time")?);
    let time = time.map(|column| Clock::of(head, ask, &names, column, 1)).transpose()?;
    Ok(Some(Plan { skip: 1, frame, time, places, names, ..Plan::default() }))
}

fn nameless(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let columns = head.rows.first().map_or(0, Vec::len);
    let first = |row: &Vec<String>| row.first().and_then(|cell| number(cell.as_bytes(), head.decimal_comma()).ok());
    let counts: Option<Vec<f64>> = head.rows.iter().map(first).collect();
    // a column that counts up by one is the frame; of a long table it repeats
    let counted = counts.is_some_and(|counts| counts.len() > 1 && counts.windows(2).all(|w| w[1] == w[0] + 1.0));
    if !counted || columns < 3 {
        return Ok(None);
    }
    let numbers = columns - 1;
    let dimensions = match (ask.column("wide"), numbers % 2, numbers % 3) {
        (Some("xy"), 0, _) | (None, 0, 1..) => 2,
        (Some("xyz"), _, 0) | (None, 1.., 0) => 3,
        (None, 0, 0) => {
            return Err(wrong(
                &head.path,
                &format!(
                    "a frame and {numbers} numbers without names: {} individuals in the plane or {} in space; say \
                     --columns wide=xy or --columns wide=xyz",
                    numbers / 2,
                    numbers / 3
                ),
            ));
        }
        (Some(other), ..) => {
            return Err(wrong(
                &head.path,
                &format!("--columns wide={other} does not fit {numbers} numbers; xy or xyz"),
            ));
        }
        _ => return Ok(None),
    };
    let place = |k: usize| Place {
        who: Who::Name((k + 1).to_string()),
        points: vec![Point::at((0..dimensions).map(|a| 1 + dimensions * k + a).collect())],
        velocity: None,
    };
    let names = (1..=columns).map(|number| number.to_string()).collect();
    let notes = vec![format!("no names of columns: the frame, then {dimensions} numbers for each individual")];
    let places = (0..numbers / dimensions).map(place).collect();
    Ok(Some(Plan { skip: 0, frame: Some(0), places, names, notes, ..Plan::default() }))
}
