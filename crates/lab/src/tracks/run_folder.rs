//! Folders of our own: of a run of a scenario, and of tracks that were analysed before.

use super::layouts::{Clock, Place, Plan, Point, Who};
use super::text::Head;
use super::wrong;
use crate::run::TRAJECTORY;
use crate::run::tables::AXES;
use crate::store::table::Table;
use crate::store::{StoreError, folder};
use serde_json::Value as Json;
use space::{Edge, Space};
use std::path::{Path, PathBuf};

/// A folder of this program.
pub(super) struct RunFolder {
    path: PathBuf,
    manifest: Json,
}

impl RunFolder {
    /// The folder at a path; none where it is another's.
    ///
    /// # Errors
    /// A folder that is not complete, or holds several recordings.
    pub(super) fn open(path: &Path) -> Result<Option<Self>, StoreError> {
        let Some(manifest) = folder::manifest(path)? else { return Ok(None) };
        if manifest.get("status").and_then(Json::as_str) != Some("complete") {
            return Err(wrong(path, "the run in it is not complete; the command that began it continues it"));
        }
        if !path.join(TRAJECTORY).exists() {
            return Err(wrong(path, "the run in it kept no trajectory"));
        }
        let recordings = manifest.get("recordings").and_then(Json::as_array).map_or(0, Vec::len);
        if recordings > 1 {
            return Err(wrong(path, "it holds several recordings; name the files that they were read from"));
        }
        Ok(Some(Self { path: path.to_owned(), manifest }))
    }

    /// The plan of its trajectory.
    ///
    /// # Errors
    /// A trajectory that lacks a column.
    pub(super) fn plan(&self, head: &Head) -> Result<Plan, StoreError> {
        let names = head.rows.first().cloned().unwrap_or_default();
        let at = |name: &str| names.iter().position(|other| other == name);
        let need = |name: &str| at(name).ok_or_else(|| wrong(&head.path, &format!("the trajectory lacks `{name}`")));
        let dimensions = AXES.iter().take_while(|axis| at(axis).is_some()).count();
        if dimensions < 2 {
            return Err(wrong(&self.path, "a run on a line: tracks need two or three dimensions"));
        }
        let axes = AXES[..dimensions].iter().map(|axis| need(axis)).collect::<Result<Vec<_>, _>>()?;
        let velocity = AXES[..dimensions].iter().map(|axis| at(&format!("v{axis}"))).collect::<Option<Vec<_>>>();
        let table = Table::open(&self.path.join(TRAJECTORY))?;
        // places on the earth are kept beside those in the plane
        let globe = at("longitude").zip(at("latitude"));
        let (axes, velocity) = globe.map_or((axes, velocity), |(east, north)| (vec![east, north], None));
        let unit = table.headings().iter().find(|heading| heading.name == "x").map(|heading| heading.unit.clone());
        let places = vec![Place {
            who: Who::Column(at("individual").map_or_else(|| need("id"), Ok)?),
            points: vec![Point::at(axes)],
            velocity,
        }];
        Ok(Plan {
            layout: "run",
            frame: Some(need("frame")?),
            time: Some(Clock::seconds(need("t")?)),
            geographic: globe.is_some(),
            places,
            unit,
            notes: if globe.is_some() { Vec::new() } else { vec!["velocities are those of the folder".to_owned()] },
            names,
            ..Plan::default()
        })
    }

    /// The space of the run.
    ///
    /// # Errors
    /// A manifest that lacks it.
    pub(super) fn space<const D: usize>(&self) -> Result<Space<f64, D>, StoreError> {
        let Some(space) = self.manifest.pointer("/identity/scenario/space") else { return Ok(Space::open()) };
        // one for all axes, or one for each
        let of = |key: &str, axis: usize| {
            let value = space.get(key)?;
            Some(value.get(axis).unwrap_or(value).clone())
        };
        let mut edges = [Edge::Open; D];
        for (axis, edge) in edges.iter_mut().enumerate() {
            let size = of("size", axis).as_ref().and_then(Json::as_f64);
            *edge = match (of("edges", axis).as_ref().and_then(Json::as_str), size) {
                (Some("periodic"), Some(size)) => Edge::Periodic(size),
                (Some("walls"), Some(size)) => Edge::Walls(size),
                (Some("open"), _) => Edge::Open,
                _ => return Err(wrong(&self.path, "the manifest does not say how the space ends")),
            };
        }
        Ok(Space { edges })
    }
}
