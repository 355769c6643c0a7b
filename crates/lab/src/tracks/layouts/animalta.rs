//! AnimalTA: semicolons between the cells, and either `Frame;Time;X_Arena0_Ind0;Y_Arena0_Ind0;...` or, detailed,
//! `Frame;Time;Arena;Ind;X;Y;...`. Times are rounded to 0.01 s.

use super::{Clock, Layout, Place, Plan, Point, Who, asked_or};
use crate::store::StoreError;
use crate::tracks::Ask;
use crate::tracks::text::Head;

pub(super) const LAYOUT: Layout = Layout {
    id: "animalta",
    about: "AnimalTA: coordinates by arena and individual, wide or detailed",
    takes: &["frame", "time"],
    plan,
};

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(names) = head.header() else { return Ok(None) };
    let names = names.to_vec();
    let at = |name: &str| names.iter().position(|other| other == name);
    let mut places = Vec::new();
    if let (Some(arena), Some(number), Some(x), Some(y)) = (at("Arena"), at("Ind"), at("X"), at("Y")) {
        let who = Who::Columns(arena, number);
        places.push(Place { who, points: vec![Point::at(vec![x, y])], velocity: None });
    } else {
        for (x, name) in names.iter().enumerate() {
            let Some(rest) = name.strip_prefix("X_").filter(|rest| rest.starts_with("Arena")) else { continue };
            let Some(y) = at(&format!("Y_{rest}")) else { continue };
            let who = Who::Name(rest.to_owned());
            places.push(Place { who, points: vec![Point::at(vec![x, y])], velocity: None });
        }
    }
    if places.is_empty() {
        return Ok(None);
    }
    let time = asked_or(head, &names, ask, "time", at("Time"))?.map(Clock::seconds);
    let frame = asked_or(head, &names, ask, "frame", at("Frame"))?;
    Ok(Some(Plan { skip: 1, frame, time, places, names, ..Plan::default() }))
}
