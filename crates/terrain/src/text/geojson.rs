//! GeoJSON (RFC 7946, but coordinates are lengths in the plane, not degrees): everything an environment is.
//!
//! Each feature has a `role`: `wall` (of the workspace), `piece` (of the construct), `boundary`, `anchor`, `region`, `gate`,
//! `marker`. Discs and circles are points with a `radius`; a circle of thin wall also has `thin`. Features without a role
//! are walls, so that drawings from elsewhere can be read.

use super::json::{Json, quoted};
use super::{corners, line, ring};
use crate::TerrainError;
use crate::construct::{Construct, Environment, Marker, Piece};
use crate::geometry::{Geometry, Point, Pose, Units};
use crate::workspace::Workspace;
use space::Vector;
use space::shape::Shape;

/// Writes an environment as a collection of features.
pub fn write(environment: &Environment) -> String {
    let (workspace, construct) = (&environment.workspace, &environment.construct);
    let mut features = Vec::new();
    for geometry in &workspace.geometry {
        features.push(feature("wall", "", &drawn(geometry)));
    }
    if let Some(corners) = &workspace.boundary {
        features.push(feature("boundary", "", &polygon(corners)));
    }
    for (name, at) in &workspace.anchors {
        features.push(feature("anchor", name, &point(*at, "")));
    }
    for (name, region) in &workspace.regions {
        let geometry = match (region, corners(region)) {
            (_, Some(corners)) => polygon(&corners),
            (Shape::Ball { centre, radius }, None) => point(*centre, &format!(r#","radius":{radius}"#)),
            // a region without an outline cannot be drawn
            _ => continue,
        };
        features.push(feature("region", name, &geometry));
    }
    for (name, gate) in &workspace.gates {
        features.push(feature("gate", name, &lines(&[gate.from, gate.to])));
    }
    for (k, piece) in construct.pieces.iter().enumerate() {
        for geometry in &piece.geometry {
            let (shape, more) = drawn(geometry);
            features.push(feature("piece", &piece.name, &(shape, format!(r#"{more},"piece":{k}"#))));
        }
    }
    for marker in &construct.markers {
        let heading = format!(r#","heading":{}"#, marker.pose.heading);
        features.push(feature("marker", &marker.name, &point(marker.pose.at, &heading)));
    }
    let (name, schema) = (quoted(&workspace.name), quoted(&construct.provenance.schema));
    let (units, seed, attempt) = (workspace.units.word(), construct.provenance.seed, construct.provenance.attempt);
    format!(
        "{{\"type\":\"FeatureCollection\",\"name\":{name},\"units\":\"{units}\",\"schema\":{schema},\"seed\":\"{seed}\",\
         \"attempt\":\"{attempt}\",\"features\":[\n{}\n]}}\n",
        features.join(",\n")
    )
}

/// A geometry and further properties.
type Drawn = (String, String);

fn feature(role: &str, name: &str, (geometry, more): &Drawn) -> String {
    let name = if name.is_empty() { String::new() } else { format!(r#","name":{}"#, quoted(name)) };
    format!(r#"{{"type":"Feature","properties":{{"role":"{role}"{name}{more}}},"geometry":{geometry}}}"#)
}

fn pair(p: Point) -> String {
    format!("[{},{}]", p[0], p[1])
}

fn pairs(points: &[Point]) -> String {
    points.iter().map(|&p| pair(p)).collect::<Vec<_>>().join(",")
}

fn point(at: Point, more: &str) -> Drawn {
    (format!(r#"{{"type":"Point","coordinates":{}}}"#, pair(at)), more.to_owned())
}

fn lines(points: &[Point]) -> Drawn {
    (format!(r#"{{"type":"LineString","coordinates":[{}]}}"#, pairs(points)), String::new())
}

fn polygon(corners: &[Point]) -> Drawn {
    let closed = [corners, corners.get(..1).unwrap_or_default()].concat();
    (format!(r#"{{"type":"Polygon","coordinates":[[{}]]}}"#, pairs(&closed)), String::new())
}

fn drawn(geometry: &Geometry) -> Drawn {
    match geometry {
        Geometry::Wall(wall) => lines(&[wall.from, wall.to]),
        Geometry::Polygon(corners) => polygon(corners),
        Geometry::Disc { centre, radius } => point(*centre, &format!(r#","radius":{radius}"#)),
        Geometry::Circle { centre, radius } => point(*centre, &format!(r#","radius":{radius},"thin":1"#)),
    }
}

/// Reads an environment: a collection of features, a single feature, or a bare geometry. Regions come back as discs and
/// polygons. Of where a construct came from only the name of the schema, seed and attempt are kept.
///
/// # Errors
/// A text that is not JSON or not GeoJSON, roles that are not known, features that cannot have their role.
pub fn read(text: &str) -> Result<Environment, TerrainError> {
    let root = Json::read(text)?;
    let units = match root.text("units") {
        None | Some("metres") => Units::Metres,
        Some("field") => Units::Field,
        Some(other) => return Err(TerrainError::unknown("units", other, ["metres", "field"].into_iter())),
    };
    let mut workspace = Workspace::empty(root.text("name").unwrap_or("from-file"), units);
    let mut construct = Construct::new(units, Vec::new());
    construct.provenance.schema = root.text("schema").unwrap_or_default().to_owned();
    let whole = |key: &str| root.text(key).and_then(|text| text.parse().ok()).unwrap_or(0);
    (construct.provenance.seed, construct.provenance.attempt) = (whole("seed"), whole("attempt"));
    let features = match root.text("type") {
        Some("FeatureCollection") => root.get("features").map(Json::list).unwrap_or_default().to_vec(),
        Some("Feature") => vec![root],
        Some(_) => vec![Json::Object(vec![("geometry".into(), root)])],
        None => return Err(TerrainError::Text { line: 1, problem: "expected an object with a `type`".into() }),
    };
    let mut last = None;
    for (k, feature) in features.iter().enumerate() {
        take(feature, &mut workspace, &mut construct, &mut last)
            .map_err(|problem| TerrainError::Text { line: 1, problem: format!("features[{k}]: {problem}") })?;
    }
    Ok(Environment { workspace, construct, schedule: None })
}

const ROLES: [&str; 7] = ["wall", "piece", "boundary", "anchor", "region", "gate", "marker"];

/// Adds a feature to what it belongs to.
fn take(
    feature: &Json,
    workspace: &mut Workspace,
    construct: &mut Construct,
    last: &mut Option<f64>,
) -> Result<(), String> {
    let nothing = Json::Nothing;
    let properties = feature.get("properties").unwrap_or(&nothing);
    let geometry = geometry(feature.get("geometry").unwrap_or(&nothing), properties)?;
    let name = properties.text("name").unwrap_or_default().to_owned();
    let role = properties.text("role").unwrap_or("wall");
    match (role, geometry.as_slice()) {
        ("wall", _) => workspace.geometry.extend(geometry),
        ("piece", _) => {
            let number = properties.number("piece");
            match construct.pieces.last_mut() {
                Some(piece) if number.is_some() && number == *last => piece.geometry.extend(geometry),
                _ => construct.pieces.push(Piece { name, geometry }),
            }
            *last = number;
        }
        ("boundary", [Geometry::Polygon(corners)]) => workspace.boundary = Some(corners.clone()),
        ("anchor", [Geometry::Disc { centre, .. }]) => workspace.anchors.push((name, *centre)),
        ("marker", [Geometry::Disc { centre, .. }]) => {
            let heading = properties.number("heading").unwrap_or(0.0);
            construct.markers.push(Marker { name, pose: Pose { at: *centre, heading } });
        }
        ("gate", [Geometry::Wall(gate)]) => workspace.gates.push((name, *gate)),
        ("region", [Geometry::Polygon(corners)]) => {
            let region = Shape::new_polygon(corners.clone()).map_err(|error| error.to_string())?;
            workspace.regions.push((name, region));
        }
        ("region", [Geometry::Disc { centre, radius }]) => {
            workspace.regions.push((name, Shape::Ball { centre: *centre, radius: *radius }));
        }
        (known, _) if ROLES.contains(&known) => return Err(format!("this geometry cannot be of the role `{known}`")),
        (other, _) => return Err(TerrainError::unknown("role", other, ROLES.into_iter()).to_string()),
    }
    Ok(())
}

fn geometry(json: &Json, properties: &Json) -> Result<Vec<Geometry>, String> {
    let nothing = Json::Nothing;
    let coordinates = json.get("coordinates").unwrap_or(&nothing);
    let radius = properties.number("radius").unwrap_or(0.0);
    if radius < 0.0 {
        return Err(format!("radius: expected 0 or more, found {radius}"));
    }
    let round = |centre: Point| match properties.number("thin") {
        Some(_) => Geometry::Circle { centre, radius },
        None => Geometry::Disc { centre, radius },
    };
    let rings =
        |json: &Json| json.list().iter().map(|points| Ok(ring(list(points)?))).collect::<Result<Vec<_>, String>>();
    match json.text("type") {
        Some("Point") => Ok(vec![round(position(coordinates)?)]),
        Some("MultiPoint") => Ok(list(coordinates)?.into_iter().map(round).collect()),
        Some("LineString") => Ok(line(&list(coordinates)?)),
        Some("MultiLineString") => {
            let mut all = Vec::new();
            for points in coordinates.list() {
                all.extend(line(&list(points)?));
            }
            Ok(all)
        }
        Some("Polygon") => rings(coordinates),
        Some("MultiPolygon") => {
            let all = coordinates.list().iter().map(rings).collect::<Result<Vec<_>, _>>()?;
            Ok(all.into_iter().flatten().collect())
        }
        Some("GeometryCollection") => {
            let mut all = Vec::new();
            // collections of collections are not read: RFC 7946 advises against them
            for part in json.get("geometries").map(Json::list).unwrap_or_default() {
                if part.text("type") == Some("GeometryCollection") {
                    return Err("a collection inside a collection is not read".into());
                }
                all.extend(geometry(part, properties)?);
            }
            Ok(all)
        }
        Some(other) => Err(format!("unknown geometry `{other}`")),
        None => Err("it has no geometry".into()),
    }
}

fn position(json: &Json) -> Result<Point, String> {
    match json.list() {
        [Json::Number(x), Json::Number(y), ..] => Ok(Vector([*x, *y])),
        _ => Err("expected a position of two numbers".into()),
    }
}

fn list(json: &Json) -> Result<Vec<Point>, String> {
    json.list().iter().map(position).collect()
}
