//! The workspace of a file: what is there already, and the names that schemas and behaviours refer to.

use crate::file::{Named, Nothing};
use crate::scenario::build::{Wrong, vector};
use crate::scenario::start::Region as Corners;
use crate::scenario::surroundings::Ball;
use crate::{form, tagged, words};
use measure::behaviours::Setting;
use space::shape::Shape;
use space::{Segment, Vector};
use terrain::geometry::Geometry;
use terrain::text::{geojson, svg, wkt, workspace as of_geometry};
use terrain::{Construct, Point, workspaces};

words! {
    /// In what lengths are measured.
    pub enum Units {
        /// Field units and discrete iterations.
        Field = "field",
        /// Metres and seconds.
        Metres = "metres",
    }
}

impl From<Units> for terrain::Units {
    fn from(units: Units) -> Self {
        match units {
            Units::Field => Self::Field,
            Units::Metres => Self::Metres,
        }
    }
}

form! {
    /// Nothing but the plane.
    pub struct Plane {
        /// In what lengths are measured.
        units: Units = [Units::Field], "", Any;
    }
}

form! {
    /// An open field (field units).
    pub struct Field {
        /// Side of a solid square boundary about the origin; left out, there is none.
        side: Option<f64> = none, "length", Positive;
    }
}

form! {
    /// A corridor along y that is open at both ends (metres). Gate: `exit`.
    pub struct Corridor {
        /// Its width.
        width: f64 = [2.4], "length", Positive;
        /// Its length.
        length: f64 = [12.0], "length", Positive;
    }
}

words! {
    /// On which side of the crossbar the stem is.
    pub enum Stem {
        /// Below: the group goes up.
        South = "south",
        /// Above.
        North = "north",
    }
}

form! {
    /// A T-junction (metres). Anchors `1` to `4`, gates `right` and `left`, region `start`.
    pub struct TJunction {
        /// Width of stem and crossbar.
        width: f64 = [2.0], "length", Positive;
        /// On which side of the crossbar the stem is.
        stem: Stem = [Stem::South], "", Any;
    }
}

form! {
    /// A square arena about the origin, with solid walls (metres).
    pub struct Arena {
        /// Its side.
        side: f64 = [10.0], "length", Positive;
    }
}

form! {
    /// A drawing: SVG, WKT or GeoJSON by the ending of its name. GeoJSON brings units and names with it.
    pub struct Picture {
        /// Name of a file beside this one.
        name: String = need, "", Any;
        /// In what lengths are measured, where the file does not say.
        units: Units = [Units::Field], "", Any;
        /// Radius of what is a point in the file.
        point_radius: f64 = [0.5], "length", Positive;
    }
}

tagged! {
    /// What is there already.
    pub enum Base {
        /// Nothing but the plane.
        empty => Empty(Plane);
        /// An open field, or a fenced one.
        field => Field(Field);
        /// A corridor.
        corridor => Corridor(Corridor);
        /// A T-junction.
        t_junction => TJunction(TJunction);
        /// The corridor of the two-wall schema `dsdr`: 16 m wide, anchors `left` and `right`, region `start`.
        dsdr_corridor => DsdrCorridor(Nothing);
        /// A square arena.
        arena => Arena(Arena);
        /// A drawing.
        file => File(Picture);
    }
}

tagged! {
    /// A region: what is inside or on its boundary belongs to it.
    pub enum Region {
        /// A box along the axes.
        box => Box(Corners);
        /// A disc.
        ball => Ball(Ball);
        /// A polygon, by its corners in order.
        polygon in "length", swarm::parameters::Range::Any => Polygon(Vec<Vec<f64>>);
    }
}

impl Region {
    pub(super) fn shape(&self) -> Result<Shape<f64, 2>, Wrong> {
        let shape = match self {
            Self::Box(corners) => {
                Shape::Cuboid { low: point(&corners.low, "box.low")?, high: point(&corners.high, "box.high")? }
            }
            Self::Ball(ball) => Shape::Ball { centre: point(&ball.centre, "ball.centre")?, radius: ball.radius },
            Self::Polygon(corners) => Shape::Polygon { vertices: points(corners, "polygon")? },
        };
        shape.checked().map_err(|error| Wrong::new("", error.to_string(), "not a possible region"))
    }
}

form! {
    /// What is there before anything is generated, and names in it. What is named here comes on top of what the base has.
    pub struct Workspace {
        /// What is there already.
        base: Base = [Base::Empty(Plane { units: Units::Field })], "", Any;
        /// Further walls, each [x0, y0, x1, y1].
        wall: Vec<Vec<f64>> = [Vec::new()], "length", Any;
        /// Further discs.
        disc: Vec<Ball> = [Vec::new()], "", Any;
        /// Further closed lines, each by its corners in order.
        polygon: Vec<Vec<Vec<f64>>> = [Vec::new()], "length", Any;
        /// Corners of the polygon inside which constructs are to stay; left out, that of the base.
        boundary: Option<Vec<Vec<f64>>> = none, "length", Any;
        /// Points at which walls may be anchored, by name: [x, y].
        anchor: Named<Vec<f64>> = [Named::default()], "length", Any;
        /// Regions by name.
        region: Named<Region> = [Named::default()], "", Any;
        /// Gates by name: [x0, y0, x1, y1].
        gate: Named<Vec<f64>> = [Named::default()], "length", Any;
        /// Places by name: [x, y]. Anchors are places too, and so are the markers of a construct (the first one also as `marker`).
        place: Named<Vec<f64>> = [Named::default()], "length", Any;
        /// Wanted trajectories by name, as lists of points.
        path: Named<Vec<Vec<f64>>> = [Named::default()], "length", Any;
    }
}

impl Default for Workspace {
    fn default() -> Self {
        Self {
            base: Base::Empty(Plane { units: Units::Field }),
            wall: Vec::new(),
            disc: Vec::new(),
            polygon: Vec::new(),
            boundary: None,
            anchor: Named::default(),
            region: Named::default(),
            gate: Named::default(),
            place: Named::default(),
            path: Named::default(),
        }
    }
}

/// A workspace, with the names that only behaviours know.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolved {
    /// The workspace.
    pub workspace: terrain::Workspace,
    /// Places by name.
    pub places: Vec<(String, Point)>,
    /// Wanted trajectories by name.
    pub paths: Vec<(String, Vec<Point>)>,
}

impl Resolved {
    /// What behaviours refer to where a construct stands here; `built` is whether its walls do.
    pub fn setting(&self, construct: &Construct, built: bool) -> Setting {
        let mut walls = self.workspace.walls();
        if built {
            walls.extend(construct.walls());
        }
        let marked = construct.markers.iter().map(|marker| (marker.name.clone(), marker.pose.at));
        let first = construct.markers.first().map(|marker| ("marker".to_owned(), marker.pose.at));
        let mut places: Vec<(String, Point)> = self.places.clone();
        // a name of the file's own comes before those of anchors and markers
        for (name, at) in self.workspace.anchors.iter().cloned().chain(marked).chain(first) {
            if places.iter().all(|(known, _)| *known != name) {
                places.push((name, at));
            }
        }
        Setting {
            walls,
            places,
            regions: self.workspace.regions.clone(),
            gates: self.workspace.gates.clone(),
            paths: self.paths.clone(),
        }
    }
}

pub(super) fn point(numbers: &[f64], path: &str) -> Result<Point, Wrong> {
    vector::<f64, 2>(numbers).map_err(|what| Wrong::new(path, what, "2 numbers"))
}

fn points(list: &[Vec<f64>], path: &str) -> Result<Vec<Point>, Wrong> {
    list.iter().enumerate().map(|(k, numbers)| point(numbers, &format!("{path}.{k}"))).collect()
}

pub(super) fn segment(numbers: &[f64], path: &str) -> Result<Segment, Wrong> {
    match *numbers {
        [x0, y0, x1, y1] => Ok(Segment { from: Vector([x0, y0]), to: Vector([x1, y1]) }),
        _ => Err(Wrong::new(path, format!("{} numbers for a line", numbers.len()), "[x0, y0, x1, y1]")),
    }
}

/// Geometry and names from the text of a drawing, by the ending of its name.
///
/// # Errors
/// Another ending, and what the text does not allow; in a sentence.
pub fn drawn(picture: &Picture, text: &str) -> Result<(terrain::Workspace, Option<Construct>), String> {
    let stem = std::path::Path::new(&picture.name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("file");
    let ending = std::path::Path::new(&picture.name).extension().and_then(|ending| ending.to_str()).unwrap_or("");
    let plain = |geometry: Vec<Geometry>| (of_geometry(stem, picture.units.into(), geometry), None);
    let read = match ending.to_ascii_lowercase().as_str() {
        "svg" => svg::read(text).map(plain),
        "wkt" | "txt" => wkt::read(text, picture.point_radius).map(plain),
        "geojson" | "json" => geojson::read(text).map(|read| (read.workspace, Some(read.construct))),
        _ => return Err(format!("`{}` ends neither in .svg, .wkt nor .geojson", picture.name)),
    };
    read.map_err(|error| format!("{}: {error}", picture.name))
}

impl Workspace {
    /// The drawing that it is based on.
    pub fn picture(&self) -> Option<&Picture> {
        if let Base::File(picture) = &self.base { Some(picture) } else { None }
    }
    /// The workspace; `text` is that of its drawing. Wrongs carry paths below it.
    ///
    /// # Errors
    /// A drawing that cannot be read, and points that are none.
    pub fn resolved(&self, text: &str) -> Result<Resolved, Wrong> {
        let mut workspace = match &self.base {
            Base::Empty(plane) => workspaces::empty(plane.units.into()),
            Base::Field(field) => workspaces::field(field.side),
            Base::Corridor(corridor) => workspaces::corridor(corridor.width, corridor.length),
            Base::TJunction(junction) => {
                let stem = match junction.stem {
                    Stem::South => workspaces::Stem::South,
                    Stem::North => workspaces::Stem::North,
                };
                workspaces::t_junction(junction.width, stem)
            }
            Base::DsdrCorridor(_) => workspaces::dsdr_corridor(),
            Base::Arena(arena) => workspaces::arena(arena.side),
            Base::File(picture) => {
                let (mut workspace, construct) =
                    drawn(picture, text).map_err(|what| Wrong::new("base.file.name", what, "a drawing"))?;
                // what was a construct elsewhere is there already here
                workspace.geometry.extend(construct.iter().flat_map(Construct::geometry).cloned());
                workspace
            }
        };
        for (k, numbers) in self.wall.iter().enumerate() {
            workspace.geometry.push(Geometry::Wall(segment(numbers, &format!("wall.{k}"))?));
        }
        for (k, disc) in self.disc.iter().enumerate() {
            let centre = point(&disc.centre, &format!("disc.{k}.centre"))?;
            workspace.geometry.push(Geometry::Disc { centre, radius: disc.radius });
        }
        for (k, corners) in self.polygon.iter().enumerate() {
            workspace.geometry.push(Geometry::Polygon(points(corners, &format!("polygon.{k}"))?));
        }
        if let Some(corners) = &self.boundary {
            workspace.boundary = Some(points(corners, "boundary")?);
        }
        fn named<T>(list: &mut Vec<(String, T)>, name: &str, value: T) {
            list.retain(|(known, _)| known != name);
            list.push((name.to_owned(), value));
        }
        for (name, numbers) in &self.anchor.0 {
            named(&mut workspace.anchors, name, point(numbers, &format!("anchor.{name}"))?);
        }
        for (name, region) in &self.region.0 {
            let shape = region.shape().map_err(|wrong| wrong.below(&format!("region.{name}")))?;
            named(&mut workspace.regions, name, shape);
        }
        for (name, numbers) in &self.gate.0 {
            named(&mut workspace.gates, name, segment(numbers, &format!("gate.{name}"))?);
        }
        let (mut places, mut paths) = (Vec::new(), Vec::new());
        for (name, numbers) in &self.place.0 {
            places.push((name.clone(), point(numbers, &format!("place.{name}"))?));
        }
        for (name, list) in &self.path.0 {
            paths.push((name.clone(), points(list, &format!("path.{name}"))?));
        }
        Ok(Resolved { workspace, places, paths })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::file::form::{Desk, Form, Rule};
    use crate::file::tree::parse;
    use crate::file::{Sources, source::Problem};

    fn read(text: &str) -> Result<Workspace, Vec<Problem>> {
        let mut sources = Sources::default();
        let source = sources.add("w.toml", text);
        let mut desk = Desk::default();
        let node = parse(&sources, source, &mut desk.problems);
        let read = Workspace::read(&node, &Rule::FREE, &mut desk);
        read.filter(|_| desk.problems.is_empty()).ok_or(desk.problems)
    }

    #[test]
    fn a_workspace_is_its_base_and_what_is_named() {
        let text = "base.t_junction = {}\nwall = [[0, 0, 1, 1]]\ngate.goal = [2, 0, 2, 2]\nanchor.4 = [5, 5]\n\
                    place.home = [0, -4]\nregion.pen.ball = { centre = [0, 1], radius = 2 }\npath.way = [[0, 0], [1, 2]]";
        let written = read(text).unwrap();
        let resolved = written.resolved("").unwrap();
        let base = workspaces::t_junction(2.0, workspaces::Stem::South);
        assert_eq!(resolved.workspace.geometry.len(), base.geometry.len() + 1);
        assert_eq!(resolved.workspace.anchor("4"), Ok(Vector([5.0, 5.0])), "its own name replaces that of the base");
        assert!(resolved.workspace.gate("goal").is_ok() && resolved.workspace.gate("right").is_ok());
        let setting = resolved.setting(&Construct::new(terrain::Units::Metres, Vec::new()), true);
        assert!(setting.place("home").is_ok() && setting.place("1").is_ok() && setting.region("pen").is_ok());
        assert_eq!(setting.paths.len(), 1);
        // as it writes itself it reads again
        let again = crate::file::write::toml(&crate::file::Node { tree: written.write(), span: Default::default() });
        assert_eq!(read(&again).unwrap(), written);
    }

    #[test]
    fn drawings_are_workspaces() {
        let read = |name: &str, text: &str| {
            let picture = Picture { name: name.into(), units: Units::Metres, point_radius: 0.5 };
            Workspace { base: Base::File(picture), ..Workspace::default() }.resolved(text)
        };
        let walls = |name: &str, text: &str| read(name, text).unwrap().workspace.walls().len();
        assert_eq!(walls("a.wkt", "LINESTRING (0 0, 1 0, 1 1)"), 2);
        assert_eq!(walls("a.svg", "<svg><line x1=\"0\" y1=\"0\" x2=\"1\" y2=\"1\"/></svg>"), 1);
        let environment = terrain::Environment::place(
            &workspaces::arena(10.0),
            Construct::of_walls(terrain::Units::Metres, [Segment::new([0.0, 0.0], [1.0, 1.0])]),
            terrain::Placement::Keep,
        );
        let text = geojson::write(&environment.unwrap().unwrap());
        assert_eq!(walls("a.geojson", &text), 5);
        let wrong = |name: &str, text: &str| read(name, text).unwrap_err();
        assert!(wrong("a.dxf", "").what.contains("neither in .svg"));
        assert_eq!(wrong("a.wkt", "LINESTRING (0 0, 1 x)").path, "base.file.name");
    }

    #[test]
    fn what_is_wrong_is_told_at_its_place() {
        let wrong = |text: &str| read(text).unwrap().resolved("").unwrap_err().path;
        assert_eq!(wrong("wall = [[0, 0, 1]]"), "wall.0");
        assert_eq!(wrong("anchor.a = [1]"), "anchor.a");
        assert_eq!(wrong("region.r.box = { low = [0], high = [1, 1] }"), "region.r.box.low");
        let problems = read("base.t_junktion = {}").unwrap_err();
        assert!(problems[0].help.contains("t_junction"), "{problems:?}");
    }
}
