//! Sketches of workspaces: walls, and the named places of designs and maps.

use super::item::{Form, Item};
use crate::environment::workspace::{Base, Plane, Region, Units, Workspace};
use crate::file::write::inline;
use crate::file::{Form as _, Named, Node, Span, Tree};
use crate::scenario::start::Region as Corners;
use crate::scenario::surroundings::Ball;
use space::shape::Shape;
use space::{Segment, Vector};
use terrain::geometry::Geometry;

/// Corners by which a circle of thin wall is drawn.
const ROUND: usize = 48;

/// The items of a workspace, and of what was built in it.
pub(super) fn of_workspace<'a>(
    workspace: &'a terrain::Workspace,
    built: impl Iterator<Item = &'a Geometry>,
) -> Vec<Item> {
    let geometry = |geometry: &Geometry| match geometry {
        Geometry::Wall(wall) => Item::new("wall", vec![wall.from.0, wall.to.0]),
        Geometry::Disc { centre, radius } => Item { radius: *radius, ..Item::new("disc", vec![centre.0]) },
        Geometry::Circle { centre, radius } => {
            let corner = |k: usize| {
                let (sin, cos) = (core::f64::consts::TAU * k as f64 / ROUND as f64).sin_cos();
                [centre[0] + radius * cos, centre[1] + radius * sin]
            };
            Item::new("polygon", (0..ROUND).map(corner).collect())
        }
        Geometry::Polygon(corners) => Item::new("polygon", corners.iter().map(|corner| corner.0).collect()),
    };
    let mut items: Vec<Item> = workspace.geometry.iter().chain(built).map(geometry).collect();
    if let Some(corners) = &workspace.boundary {
        items.push(Item::new("boundary", corners.iter().map(|corner| corner.0).collect()));
    }
    let named = |name: &String, item: Item| Item { name: name.clone(), ..item };
    items.extend(workspace.anchors.iter().map(|(name, at)| named(name, Item::new("anchor", vec![at.0]))));
    items.extend(
        workspace.gates.iter().map(|(name, gate)| named(name, Item::new("gate", vec![gate.from.0, gate.to.0]))),
    );
    items.extend(workspace.regions.iter().filter_map(|(name, shape)| {
        let item = match shape {
            Shape::Ball { centre, radius } => {
                Item { radius: *radius, form: Form::Disc, ..Item::new("region", vec![centre.0]) }
            }
            Shape::Cuboid { low, high } => Item::new("region", vec![low.0, high.0]),
            Shape::Polygon { vertices } => {
                let corners = vertices.iter().map(|corner| corner.0).collect();
                Item { form: Form::Polygon, ..Item::new("region", corners) }
            }
            // nothing that has an inside
            Shape::Segment { .. } | Shape::Plane { .. } => return None,
        };
        Some(named(name, item))
    }));
    items
}

/// Whether an item is a region of a workspace; a start is the region of that name.
fn region(item: &Item) -> Option<&str> {
    match item.is.as_str() {
        "region" => Some(if item.name.is_empty() { "region" } else { &item.name }),
        "start" => Some("start"),
        _ => None,
    }
}

/// The corners of a box.
fn rectangle(item: &Item) -> Vec<[f64; 2]> {
    let (low, high) = item.corners();
    vec![low, [high[0], low[1]], high, [low[0], high[1]]]
}

fn wall([from, to]: [[f64; 2]; 2]) -> Geometry {
    Geometry::Wall(Segment { from: Vector(from), to: Vector(to) })
}

/// The workspace of a sketch.
pub(super) fn workspace(name: &str, units: terrain::Units, items: &[Item]) -> terrain::Workspace {
    let mut workspace = terrain::Workspace::empty(name, units);
    let points = |points: &[[f64; 2]]| points.iter().copied().map(Vector).collect::<Vec<_>>();
    for item in items {
        match item.is.as_str() {
            "wall" => workspace.geometry.extend(item.points.windows(2).map(|pair| wall([pair[0], pair[1]]))),
            "disc" => {
                workspace.geometry.push(Geometry::Disc { centre: Vector(item.first()), radius: item.radius });
            }
            "box" => workspace.geometry.push(Geometry::Polygon(points(&rectangle(item)))),
            "polygon" => workspace.geometry.push(Geometry::Polygon(points(&item.points))),
            "boundary" => workspace.boundary = Some(points(&item.points)),
            "anchor" => workspace.anchors.push((item.name.clone(), Vector(item.first()))),
            "gate" => {
                if let [from, to, ..] = item.points[..] {
                    workspace.gates.push((item.name.clone(), Segment { from: Vector(from), to: Vector(to) }));
                }
            }
            _ => {}
        }
        if let Some(name) = region(item) {
            let (low, high) = item.corners();
            let shape = match item.form {
                Form::Box => Shape::Cuboid { low: Vector(low), high: Vector(high) },
                Form::Disc => Shape::Ball { centre: Vector(item.first()), radius: item.radius },
                Form::Polygon => Shape::Polygon { vertices: points(&item.points) },
            };
            workspace.regions.push((name.to_owned(), shape));
        }
    }
    workspace
}

/// A sketch as the table of a file: what the file had and nobody can draw stays.
pub(super) fn form(before: &Workspace, items: &[Item]) -> Workspace {
    let units = match before.resolved("").map(|resolved| resolved.workspace.units) {
        Ok(terrain::Units::Metres) => Units::Metres,
        _ => Units::Field,
    };
    let mut form = Workspace {
        base: Base::Empty(Plane { units }),
        place: before.place.clone(),
        path: before.path.clone(),
        ..Workspace::default()
    };
    let list = |points: &[[f64; 2]]| points.iter().map(|point| point.to_vec()).collect::<Vec<_>>();
    fn put<T>(to: &mut Named<T>, name: &str, value: T) {
        to.0.retain(|(known, _)| known != name);
        to.0.push((name.to_owned(), value));
    }
    for item in items {
        match item.is.as_str() {
            "wall" => form.wall.extend(item.points.windows(2).map(|pair| pair.concat())),
            "disc" => form.disc.push(Ball { centre: item.first().to_vec(), radius: item.radius }),
            "box" => form.polygon.push(list(&rectangle(item))),
            "polygon" => form.polygon.push(list(&item.points)),
            "boundary" => form.boundary = Some(list(&item.points)),
            "anchor" => put(&mut form.anchor, &item.name, item.first().to_vec()),
            "gate" => put(&mut form.gate, &item.name, item.points.concat()),
            _ => {}
        }
        if let Some(name) = region(item) {
            let (low, high) = item.corners();
            let shape = match item.form {
                Form::Box => Region::Box(Corners { low: low.to_vec(), high: high.to_vec() }),
                Form::Disc => Region::Ball(Ball { centre: item.first().to_vec(), radius: item.radius }),
                Form::Polygon => Region::Polygon(list(&item.points)),
            };
            put(&mut form.region, name, shape);
        }
    }
    form
}

/// The values that put a workspace into the text of a file: the keys that changed, or all of it where one is no longer there.
pub(super) fn sets(before: &Workspace, after: &Workspace) -> Vec<(String, String)> {
    let (before, after) = (before.write(), after.write());
    let (Tree::Table(old), Tree::Table(new)) = (&before, &after) else { return Vec::new() };
    if old.iter().any(|entry| new.iter().all(|other| other.key != entry.key)) {
        return vec![("workspace".to_owned(), inline(&after))];
    }
    let there = |key: &str| old.iter().find(|entry| entry.key == *key).map(|entry| inline(&entry.node.tree));
    let values = new.iter().map(|entry| (&entry.key, inline(&entry.node.tree)));
    let changed = values.filter(|(key, value)| there(key).as_ref() != Some(value));
    changed.map(|(key, value)| (format!("workspace.{key}"), value)).collect()
}

/// A tree with nothing but a workspace.
pub(super) fn alone(form: &Workspace) -> Node {
    let span = Span { source: 0, bytes: 0..0 };
    let mut tree = Node { tree: Tree::Table(Vec::new()), span: span.clone() };
    // a table takes any key
    let _ = tree.set("workspace", Node { tree: form.write(), span });
    tree
}
