//! PeTrack and JuPedSim: a row for each person in each frame, `id frame x y z`, with comments that name the columns, the
//! frame rate and the unit. z is the height of a head: people are compared in the plane.

use super::{Layout, Place, Plan, Point, Who};
use crate::store::StoreError;
use crate::tracks::Ask;
use crate::tracks::names::plain;
use crate::tracks::text::Head;

pub(super) const LAYOUT: Layout = Layout {
    id: "pedestrian",
    about: "PeTrack and JuPedSim: id, frame, x, y, z under comments",
    takes: &["id", "frame", "x", "y", "z"],
    plan,
};

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(columns) = head.rows.first().map(Vec::len).filter(|_| head.numeric(0)) else { return Ok(None) };
    // the last comment of as many words names the columns
    let parts = |comment: &String| comment.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let Some(names) = head.comments.iter().rev().map(parts).find(|names| names.len() == columns) else {
        return Ok(None);
    };
    let at = |role| crate::tracks::names::column(head, &names, ask, role);
    let (Some(id), Some(frame), Some(x), Some(y)) = (at("id")?, at("frame")?, at("x")?, at("y")?) else {
        return Ok(None);
    };
    let mut axes = vec![x, y];
    let mut notes = Vec::new();
    if let Some(z) = ask.column("z").map(|_| at("z")).transpose()?.flatten() {
        axes.push(z);
    } else if names.iter().any(|name| plain(name) == "z") {
        notes.push("z is the height of heads and not used; --columns z=z takes it".to_owned());
    }
    let places = vec![Place { who: Who::Column(id), points: vec![Point::at(axes)], velocity: None }];
    Ok(Some(Plan { skip: 0, frame: Some(frame), places, names, notes, ..Plan::default() }))
}
