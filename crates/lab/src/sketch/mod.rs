//! Sketches: what a person draws with a mouse, out of files and back into them.
//!
//! A sketch is a list of items in the plane: walls, discs, boxes, polygons, regions, gates, anchors, a boundary, starts of groups.
//! [`open`] reads it from a scenario, from the workspace of a design or map, or from a drawing (SVG, WKT, GeoJSON);
//! [`save`] puts it into the text it came from, which otherwise stays as it is, or writes a drawing. The page holds the sketch;
//! nothing is kept here in between.

mod item;
mod places;
mod standing;

pub use item::{Form, Item};

use crate::environment::workspace::{Picture, Units, Workspace, drawn};
use crate::file::edit::with_values;
use crate::file::kind::kind_of;
use crate::file::tree::parse;
use crate::file::{Desk, Form as _, Problems, Rule, Sources};
use crate::scenario::{self, build};
use serde_json::{Value as Json, json};
use terrain::text::{geojson, svg};
use terrain::{Construct, Environment};

/// Kinds of files that have a workspace.
const WITH_WORKSPACE: [&str; 2] = ["design", "map"];

/// What a sketch is saved as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The file that it came from; a new scenario where it came from none.
    File,
    /// A table `[workspace]`, for designs and maps.
    Workspace,
    /// A drawing to look at.
    Svg,
    /// A drawing with all names.
    GeoJson,
}

impl Target {
    /// The target of a word.
    pub fn of(word: &str) -> Option<Self> {
        Some(match word {
            "file" => Self::File,
            "workspace" => Self::Workspace,
            "svg" => Self::Svg,
            "geojson" => Self::GeoJson,
            _ => return None,
        })
    }
}

/// A sketch that was saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Saved {
    /// Name of its file.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Items that such a file cannot hold.
    pub left_out: usize,
}

fn told(problems: &Problems) -> String {
    problems.to_string()
}

/// The sketch of a file; without any text that of a new scenario.
///
/// # Errors
/// A file that cannot be read, or is not in the plane; in a sentence or as its problems are shown.
pub fn open(name: &str, text: &str) -> Result<Json, String> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    if ["svg", "wkt", "txt", "geojson", "json"].contains(&ending.as_str()) {
        let picture = Picture { name: name.to_owned(), units: Units::Field, point_radius: 0.5 };
        let (workspace, construct) = drawn(&picture, text)?;
        let items = places::of_workspace(&workspace, construct.iter().flat_map(Construct::geometry));
        return Ok(sketch(&items, ("drawing", name, ""), "", Json::Null, &json!([])));
    }
    let (name, text) = if text.trim().is_empty() { ("new.toml", scenario::TEMPLATE) } else { (name, text) };
    let known = ["scenario", "design", "map"];
    let kind = kind_of(name, text, &known).map_err(|problems| told(&problems))?.unwrap_or(known[0]);
    if WITH_WORKSPACE.contains(&kind) {
        let form = workspace_of(name, text)?;
        if form.picture().is_some() {
            return Err(format!("the workspace of `{name}` is a drawing of its own: open that"));
        }
        let resolved = form.resolved("").map_err(|wrong| format!("workspace.{}: {}", wrong.path, wrong.what))?;
        let items = places::of_workspace(&resolved.workspace, core::iter::empty());
        let unit = if resolved.workspace.units == terrain::Units::Metres { "m" } else { "unit" };
        return Ok(sketch(&items, (kind, name, text), unit, Json::Null, &json!([])));
    }
    let read = build::read(name, text, &[]).map_err(|problems| told(&problems))?;
    let scenario = &read.scenario;
    if scenario.space.dimensions != 2 {
        return Err(format!("`{name}` has {} dimensions; one draws in the plane", scenario.space.dimensions));
    }
    let space = build::plan::<f64, 2>(scenario, 1, 1).ok().map(|plan| {
        let edges = plan.space.edges.map(|edge| match edge {
            space::Edge::Open => json!({ "edge": "open" }),
            space::Edge::Periodic(side) => json!({ "edge": "periodic", "side": side }),
            space::Edge::Walls(side) => json!({ "edge": "walls", "side": side }),
        });
        json!(edges)
    });
    let groups = scenario.group.0.iter().map(|(name, group)| json!({ "name": name, "count": group.count }));
    let groups = Json::Array(groups.collect());
    let items = standing::of_scenario(scenario);
    Ok(sketch(&items, ("scenario", name, text), &scenario.units.length, json!(space), &groups))
}

fn sketch(items: &[Item], (kind, name, base): (&str, &str, &str), unit: &str, space: Json, groups: &Json) -> Json {
    json!({
        "kind": kind, "name": name, "base": base, "unit": unit, "space": space, "groups": groups,
        "items": items.iter().map(Item::told).collect::<Vec<_>>(),
    })
}

/// The workspace of a design or map.
fn workspace_of(name: &str, text: &str) -> Result<Workspace, String> {
    let mut sources = Sources::default();
    let source = sources.add(name, text);
    let mut desk = Desk::default();
    let tree = parse(&sources, source, &mut desk.problems);
    let form = match tree.get("workspace") {
        Some(node) => Workspace::read(node, &Rule { name: "workspace", ..Rule::FREE }, &mut desk),
        None => Some(Workspace::default()),
    };
    match form.filter(|_| desk.problems.is_empty()) {
        Some(form) => Ok(form),
        None => Err(told(&Problems::new(sources, desk.problems))),
    }
}

/// Saves a sketch: `name` and `base` are those of the file it came from.
///
/// # Errors
/// Items that are none, and a file that would not be possible with them.
pub fn save(target: Target, name: &str, base: &str, items: &[Item]) -> Result<Saved, String> {
    let stem = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = stem.rsplit_once('.').map_or(stem, |(stem, _)| stem);
    let stem = if stem.is_empty() { "drawing" } else { stem };
    let kind = kind_of(name, base, &["scenario", "design", "map"]).ok().flatten();
    let drawing = |ending: &str, write: fn(&Environment) -> String| {
        let workspace = places::workspace(stem, terrain::Units::Metres, items);
        let units = workspace.units;
        let mut environment = Environment { workspace, construct: Construct::new(units, Vec::new()), schedule: None };
        stem.clone_into(&mut environment.construct.provenance.schema);
        Saved { name: format!("{stem}.{ending}"), text: write(&environment), left_out: 0 }
    };
    match target {
        Target::Svg => Ok(drawing("svg", svg::write)),
        Target::GeoJson => Ok(drawing("geojson", geojson::write)),
        Target::Workspace => {
            let form = places::form(&Workspace::default(), items);
            let text = crate::file::write::toml(&places::alone(&form));
            Ok(Saved { name: format!("{stem}-workspace.toml"), text, left_out: 0 })
        }
        Target::File if kind.is_some_and(|kind| WITH_WORKSPACE.contains(&kind)) => {
            let before = workspace_of(name, base)?;
            let text = with_values(base, &places::sets(&before, &places::form(&before, items)))?;
            workspace_of(name, &text)?
                .resolved("")
                .map_err(|wrong| format!("workspace.{}: {}", wrong.path, wrong.what))?;
            Ok(Saved { name: format!("{stem}.toml"), text, left_out: 0 })
        }
        Target::File => {
            // a drawing becomes a scenario by standing in a new one
            let base = if base.trim().is_empty() { scenario::TEMPLATE } else { base };
            let before = build::read(name, base, &[]).map_err(|problems| told(&problems))?.scenario;
            let (sets, left_out) = standing::sets(&before, items);
            let text = with_values(base, &sets)?;
            build::read(name, &text, &[]).map_err(|problems| told(&problems))?;
            Ok(Saved { name: format!("{stem}.toml"), text, left_out })
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn corral() -> &'static str {
        crate::gallery::find("corral").map_or("", |built| built.text)
    }

    fn items(sketch: &Json) -> Vec<Item> {
        sketch["items"].as_array().unwrap().iter().map(|item| Item::of(item).unwrap()).collect()
    }

    #[test]
    fn a_scenario_that_is_not_changed_stays_the_same_world() {
        let sketch = open("corral.toml", corral()).unwrap();
        let all = items(&sketch);
        assert_eq!(sketch["groups"][0]["name"], "flock");
        assert_eq!(all.iter().filter(|item| item.is == "wall").count(), 2);
        assert_eq!(all.iter().filter(|item| item.is == "start").count(), 1);
        let saved = save(Target::File, "corral.toml", corral(), &all).unwrap();
        let read = |text: &str| build::read("corral.toml", text, &[]).unwrap().scenario;
        assert_eq!(read(&saved.text), read(corral()));
        assert!(saved.text.contains("# the funnel") || saved.text.contains("A corral"));
    }

    #[test]
    fn a_wall_that_is_drawn_stands_in_the_file() {
        let mut all = items(&open("corral.toml", corral()).unwrap());
        all.push(Item::of(&json!({ "is": "wall", "points": [[90, 42], [90, 58]] })).unwrap());
        all.push(Item::of(&json!({ "is": "gate", "name": "throat", "points": [[80, 40], [80, 60]] })).unwrap());
        let saved = save(Target::File, "corral.toml", corral(), &all).unwrap();
        assert_eq!(saved.left_out, 1, "a scenario has no gates");
        let scenario = build::read("corral.toml", &saved.text, &[]).unwrap().scenario;
        assert_eq!(scenario.obstacle.len(), 3);
    }

    #[test]
    fn workspaces_come_back_from_every_form() {
        let given = [
            json!({ "is": "wall", "points": [[0, 0], [4, 0]] }),
            json!({ "is": "disc", "points": [[1, 1]], "radius": 0.5 }),
            json!({ "is": "polygon", "points": [[0, 2], [1, 2], [1, 3]] }),
            json!({ "is": "region", "name": "goal", "points": [[2, 2], [4, 4]], "form": "box" }),
            json!({ "is": "gate", "name": "exit", "points": [[4, 0], [4, 2]] }),
            json!({ "is": "anchor", "name": "a", "points": [[0, 0]] }),
        ];
        let all: Vec<Item> = given.iter().map(|item| Item::of(item).unwrap()).collect();
        let saved = save(Target::GeoJson, "yard.svg", "", &all).unwrap();
        assert_eq!(saved.name, "yard.geojson");
        let again = items(&open(&saved.name, &saved.text).unwrap());
        let count = |list: &[Item], is: &str| list.iter().filter(|item| item.is == is).count();
        for is in ["wall", "disc", "polygon", "region", "gate", "anchor"] {
            assert_eq!(count(&again, is), 1, "{is}: {again:?}");
        }
        let drawn = save(Target::Svg, "yard.geojson", "", &all).unwrap();
        assert!(count(&items(&open("yard.svg", &drawn.text).unwrap()), "wall") >= 1);
        let design = "kind = \"design\"\n# kept\n[workspace]\nbase.arena = { side = 8 }\nplace.home = [1, 1]\n";
        let mut inside = items(&open("d.toml", design).unwrap());
        assert!(count(&inside, "wall") + count(&inside, "polygon") > 0);
        inside.extend(all);
        let saved = save(Target::File, "d.toml", design, &inside).unwrap();
        assert!(saved.text.contains("# kept") && saved.text.contains("home"), "{}", saved.text);
        let resolved = workspace_of("d.toml", &saved.text).unwrap().resolved("").unwrap();
        assert!(resolved.workspace.gate("exit").is_ok() && resolved.workspace.anchor("a").is_ok());
        assert_eq!(resolved.places.len(), 1);
        assert!(save(Target::Workspace, "yard.svg", "", &inside).unwrap().text.contains("[workspace]"));
    }

    #[test]
    fn what_cannot_be_drawn_is_told() {
        assert!(open("a.toml", "kind = \"study\"").unwrap_err().contains("study"));
        let space = crate::gallery::find("starlings").map_or("", |built| built.text);
        assert!(open("starlings.toml", space).unwrap_err().contains("plane"));
        assert!(open("a.svg", "no picture").is_err());
        assert_eq!(open("", "").unwrap()["kind"], "scenario", "a new one");
        assert!(Item::of(&json!({ "is": "wall", "points": [[0, 0]] })).is_err());
        assert!(Item::of(&json!({ "is": "tower", "points": [[0, 0]] })).unwrap_err().contains("tower"));
    }
}
