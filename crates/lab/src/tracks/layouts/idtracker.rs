//! idtracker.ai: `trajectories.csv` with `time,x1,y1,x2,y2,...` (`seconds` in earlier versions) and `attributes.json` beside
//! it with the frame rate; its tidy export, as text or Parquet, is a long table `frame,time,individual,x,y,probability`.
//! Where it knew no frame rate its times are the numbers of the frames, or are left out.

use super::{Layout, Plan, beside, long, wide};
use crate::store::StoreError;
use crate::tracks::Ask;
use crate::tracks::names::plain;
use crate::tracks::text::{Head, number};

pub(super) const LAYOUT: Layout = Layout {
    id: "idtracker",
    about: "idtracker.ai: trajectories.csv with attributes.json beside it, or tidy",
    takes: &["frame", "time", "id", "clock"],
    plan,
};

/// Columns of the tidy export.
const TIDY: [&str; 6] = ["frame", "time", "individual", "x", "y", "probability"];

fn plan(head: &Head, ask: &Ask) -> Result<Option<Plan>, StoreError> {
    let Some(names) = head.header() else { return Ok(None) };
    let attributes = ["attributes.json", "attributes_tidy.json"].iter().find_map(|name| beside(head, name));
    let rate = attributes.as_ref().and_then(|json| json.get("frames_per_second")).and_then(serde_json::Value::as_f64);
    if names == TIDY {
        let Some(mut plan) = long::plan(head, ask)? else { return Ok(None) };
        let unknown = attributes.is_some() && rate.is_none() || head.comments.iter().any(|c| c == NO_RATE);
        if unknown || counts_frames(head) {
            plan.time = None;
        }
        (plan.fps, plan.unit) = (rate, Some("px".into()));
        return Ok(Some(plan));
    }
    let first = names.first().map(|name| plain(name)).unwrap_or_default();
    let asked = ask.layout.as_deref() == Some(LAYOUT.id);
    // a wide table with times may be anybody's
    let theirs = asked || first == "seconds" || attributes.is_some() && matches!(first.as_str(), "time" | "x1");
    if !theirs {
        return Ok(None);
    }
    let Some(mut plan) = wide::plan(head, ask)? else { return Ok(None) };
    plan.fps = rate;
    plan.unit = (asked || attributes.is_some()).then(|| "px".into());
    Ok(Some(plan))
}

/// What the reader of Parquet notes where the attributes have no frame rate.
pub(crate) const NO_RATE: &str = "framerate: unknown";

/// Whether the times of the tidy export are the numbers of its frames.
fn counts_frames(head: &Head) -> bool {
    let value = |row: &Vec<String>, column: usize| {
        row.get(column).and_then(|cell| number(cell.as_bytes(), head.decimal_comma()).ok())
    };
    let rows = || head.rows.iter().skip(1);
    let same = |row: &Vec<String>| value(row, 0).is_some_and(|frame| value(row, 1) == Some(frame));
    rows().any(|row| value(row, 0).is_some_and(|frame| frame > 0.0)) && rows().all(same)
}
