//! A long table: a row for each individual at each time, under names that are known or given with `--columns`.

use super::{Clock, Layout, Place, Plan, Point, Who};
use crate::store::StoreError;
use crate::tracks::text::Head;
use crate::tracks::{Ask, names, wrong};

pub(super) const LAYOUT: Layout = Layout {
    id: "long",
    about: "any long table: a row for each individual at each time",
    takes: &["frame", "time", "id", "x", "y", "z", "longitude", "latitude", "vx", "vy", "vz", "clock"],
    plan,
};

pub(super) fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let headed = head.header().is_some();
    let names: Vec<String> = match head.header() {
        Some(names) => names.to_vec(),
        // without names, columns are numbers
        None => (1..=head.rows.first().map_or(0, Vec::len)).map(|number| number.to_string()).collect(),
    };
    let at = |role| names::column(head, &names, ask, role);
    let (longitude, latitude) = (at("longitude")?, at("latitude")?);
    let (x, y, z) = (at("x")?, at("y")?, at("z")?);
    let given = |role: &str| ask.column(role).is_some();
    let (axes, geographic) = match (x.zip(y), longitude.zip(latitude)) {
        (Some(_), Some(_)) if !given("x") && !given("longitude") => {
            return Err(wrong(
                &head.path,
                "it has both x and y and longitude and latitude: choose with --columns x=x,y=y or \
                 --columns longitude=NAME,latitude=NAME",
            ));
        }
        (Some((x, y)), place) if place.is_none() || given("x") => ([x, y].into_iter().chain(z).collect(), false),
        (_, Some((longitude, latitude))) => (vec![longitude, latitude], true),
        _ => return Ok(None),
    };
    let (frame, mut time, id) = (at("frame")?, at("time")?, at("id")?);
    if frame.is_some() && ask.column("time").is_none() && time.is_some_and(|column| !seconds(&names[column])) {
        // a date beside the number of the frame says when it was recorded, not where in it
        time = None;
    }
    let first = usize::from(headed);
    let time = time.map(|column| Clock::of(head, ask, &names, column, first)).transpose()?;
    let velocity: Option<Vec<usize>> = ["vx", "vy", "vz"][..axes.len()]
        .iter()
        .map(|role| at(role))
        .collect::<Result<Option<Vec<_>>, _>>()?
        .filter(|_| !geographic);
    let mut notes = Vec::new();
    if velocity.is_some() {
        notes.push("velocities are those of the file; --columns vx=none takes differences of positions".to_owned());
    }
    let who = id.map_or_else(|| Who::Name("1".into()), Who::Column);
    let unit = geographic.then(|| "m".to_owned());
    let places = vec![Place { who, points: vec![Point::at(axes)], velocity }];
    Ok(Some(Plan { skip: first, frame, time, places, geographic, unit, names, notes, ..Plan::default() }))
}

/// Whether a column of times counts seconds by its name.
fn seconds(name: &str) -> bool {
    matches!(names::untimed(name).as_str(), "t" | "time" | "seconds" | "sec")
}
