//! SLEAP: `track,frame_idx,instance.score,nose.x,nose.y,nose.score,...`, a row for each animal in each frame.

use super::{Layout, Place, Plan, Point, Who, asked_or, chosen_points};
use crate::store::StoreError;
use crate::tracks::text::Head;
use crate::tracks::{Ask, wrong};

pub(super) const LAYOUT: Layout = Layout {
    id: "sleap",
    about: "SLEAP: track, frame_idx, and x and y of each body part",
    takes: &["point", "id"],
    plan,
};

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(names) = head.header() else { return Ok(None) };
    let names = names.to_vec();
    let at = |name: &str| names.iter().position(|other| other == name);
    let Some(frame) = at("frame_idx") else { return Ok(None) };
    let instance = |name: &String| {
        let number = name.strip_prefix("inst").and_then(|rest| rest.split_once('.'));
        number.is_some_and(|(number, _)| !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit()))
    };
    if let Some(name) = names.iter().find(|name| instance(name)) {
        return Err(wrong(
            &head.path,
            &format!(
                "`{name}`: SLEAP numbers instances anew in each frame, they are no individuals; export its analysis CSV with \
                 tracks, or say --layout wide if yours are"
            ),
        ));
    }
    let Some(track) = at("track") else { return Ok(None) };
    let mut parts = Vec::new();
    for (column, name) in names.iter().enumerate() {
        let Some(part) = name.strip_suffix(".x") else { continue };
        let Some(y) = at(&format!("{part}.y")) else { continue };
        parts.push((part.to_owned(), Point { axes: vec![column, y], confidence: at(&format!("{part}.score")) }));
    }
    if parts.is_empty() {
        return Ok(None);
    }
    let points = chosen_points(head, ask, &parts, "the skeleton")?;
    // where nothing was tracked the column is empty: of one animal it does not matter
    let who = asked_or(head, &names, ask, "id", Some(track))?.map_or_else(|| Who::Name("1".into()), Who::Column);
    let places = vec![Place { who, points, velocity: None }];
    Ok(Some(Plan { skip: 1, frame: Some(frame), places, unit: Some("px".into()), names, ..Plan::default() }))
}
