//! idtracker.ai: `trajectories.csv` with `seconds,x1,y1,x2,y2,...` (or `time`), and `attributes.json` beside it with the
//! frame rate; its tidy export is a long table.

use super::{Layout, Plan, beside, wide};
use crate::store::StoreError;
use crate::tracks::Ask;
use crate::tracks::names::plain;
use crate::tracks::text::Head;

pub(super) const LAYOUT: Layout =
    Layout { id: "idtracker", about: "idtracker.ai: trajectories.csv with attributes.json beside it", plan };

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(names) = head.header() else { return Ok(None) };
    let seconds = names.first().is_some_and(|name| matches!(plain(name).as_str(), "seconds" | "time"));
    let attributes = ["attributes.json", "attributes_tidy.json"].iter().find_map(|name| beside(head, name));
    let theirs = |json: &serde_json::Value| json.get("frames_per_second").and_then(serde_json::Value::as_f64);
    if !seconds || (ask.layout.is_none() && names.first().is_some_and(|n| n == "time") && attributes.is_none()) {
        return Ok(None);
    }
    let Some(mut plan) = wide::plan(head, ask)? else { return Ok(None) };
    plan.fps = attributes.as_ref().and_then(theirs);
    plan.unit = Some("px".into());
    Ok(Some(plan))
}
