//! TRex: a file for each individual, `VIDEO_fish0.csv` or `VIDEO_id0.csv`, with `frame`, `time`, `X#wcentroid (cm)`, ...;
//! lost frames are infinite. Give the folder for all individuals of a recording.

use super::{Clock, Layout, Place, Plan, Point, Who, asked_or};
use crate::store::StoreError;
use crate::tracks::names::plain;
use crate::tracks::text::Head;
use crate::tracks::{Ask, wrong};

pub(super) const LAYOUT: Layout = Layout {
    id: "trex",
    about: "TRex: a file for each individual; give the folder",
    takes: &["point", "frame", "time"],
    plan,
};

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(names) = head.header() else { return Ok(None) };
    let names = names.to_vec();
    let at = |name: &str| names.iter().position(|other| plain(other) == name);
    let hashed = names.iter().any(|name| name.contains('#'));
    if !hashed && individual(&head.stem()).is_none() {
        return Ok(None);
    }
    let parts: Vec<(&str, [usize; 2])> = [("wcentroid", "x_wcentroid", "y_wcentroid"), ("head", "x", "y")]
        .into_iter()
        .filter_map(|(part, x, y)| Some((part, [at(x)?, at(y)?])))
        .collect();
    if !hashed && parts.is_empty() {
        return Ok(None);
    }
    // the weighted centroid where it was exported: the head is a body part that turns about it
    let wanted = ask.column("point").unwrap_or(parts.first().map_or("wcentroid", |(part, _)| part));
    let Some((part, axes)) = parts.iter().find(|(part, _)| *part == wanted) else {
        let there = crate::tracks::names::shown(&names);
        return Err(wrong(
            &head.path,
            &format!(
                "a table of TRex without x and y of its {wanted}; export `X` and `Y`, with or without `#wcentroid`; there are {there}"
            ),
        ));
    };
    let notes = vec![format!("positions of the {}", if *part == "head" { "head" } else { "weighted centroid" })];
    let who = Who::Name(individual(&head.stem()).unwrap_or_else(|| head.stem()));
    let place = Place { who, points: vec![Point::at(axes.to_vec())], velocity: None };
    let time = asked_or(head, &names, ask, "time", at("time"))?.map(Clock::seconds);
    let frame = asked_or(head, &names, ask, "frame", at("frame"))?;
    Ok(Some(Plan { skip: 1, frame, time, places: vec![place], names, notes, ..Plan::default() }))
}

/// The individual that a file is of: what follows the last `_fish` or `_id` of its name.
pub(crate) fn individual(stem: &str) -> Option<String> {
    ["_fish", "_id"].iter().find_map(|mark| {
        let (_, number) = stem.rsplit_once(mark)?;
        (!number.is_empty() && number.bytes().all(|b| b.is_ascii_digit())).then(|| number.to_owned())
    })
}
