//! The table of the obstacles of a run, where they were drawn: a row for each point that their shapes are given by.

use super::tables::AXES;
use crate::scenario::Scenario;
use crate::store::table::{Heading, Kind, Values};
use space::shape::Shape;
use space::{Vector, obstacles::Obstacle};
use std::sync::Arc;
use swarm::parameters::Scalar;

/// Names of the shapes.
const SHAPES: [&str; 5] = ["ball", "segment", "polygon", "box", "plane"];
/// What the points are.
const POINTS: [&str; 6] = ["centre", "end", "corner", "least corner", "greatest corner", "point and normal"];

/// Columns and values of the table.
pub(super) fn table<R: Scalar, const D: usize>(
    obstacles: &[Obstacle<R, D>],
    scenario: &Scenario,
) -> (Vec<Heading>, Vec<Values>) {
    let length = &scenario.units.length;
    let mut headings = vec![
        Heading::new("run", "1", "Number of the run: 0.", Kind::Whole),
        Heading::new("obstacle", "1", "Number of the obstacle, from 0, as events tell it.", Kind::Long),
        Heading::new("shape", "", "Its shape.", Kind::Word),
        Heading::new("point", "", "What the point is of the shape.", Kind::Word),
    ];
    headings.extend(AXES[..D].iter().map(|axis| Heading::new(axis, length, "The point.", Kind::Double).always()));
    headings.push(Heading::new("radius", length, "Radius of a ball.", Kind::Double));
    let normal = |axis: &&str| {
        Heading::new(&format!("n{axis}"), "1", "Unit vector out of what is behind a plane.", Kind::Double)
    };
    headings.extend(AXES[..D].iter().map(normal));

    let (mut numbers, mut shapes, mut points) = (Vec::new(), Vec::new(), Vec::new());
    let (mut places, mut radii, mut normals) = (vec![Vec::new(); D], Vec::new(), vec![Vec::new(); D]);
    let none = [f64::NAN; D];
    for (number, obstacle) in obstacles.iter().enumerate() {
        let mut row = |shape: u32, point: u32, place: &Vector<R, D>, radius: f64, normal: [f64; D]| {
            numbers.push(number as i64);
            shapes.push(shape);
            points.push(point);
            radii.push(radius);
            for a in 0..D {
                places[a].push(place[a].to_f64());
                normals[a].push(normal[a]);
            }
        };
        match &obstacle.shape {
            Shape::Ball { centre, radius } => row(0, 0, centre, radius.to_f64(), none),
            Shape::Segment { from, to } => [from, to].into_iter().for_each(|end| row(1, 1, end, f64::NAN, none)),
            Shape::Polygon { vertices } => vertices.iter().for_each(|corner| row(2, 2, corner, f64::NAN, none)),
            Shape::Cuboid { low, high } => {
                row(3, 3, low, f64::NAN, none);
                row(3, 4, high, f64::NAN, none);
            }
            Shape::Plane { point, normal } => row(4, 5, point, f64::NAN, normal.0.map(|n| n.to_f64())),
        }
    }
    let words = |names: &[&str]| Arc::new(names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>());
    let mut columns = vec![
        Values::Whole(vec![0; numbers.len()]),
        Values::Long(numbers),
        Values::Word(shapes, words(&SHAPES)),
        Values::Word(points, words(&POINTS)),
    ];
    columns.extend(places.into_iter().map(Values::Double));
    columns.push(Values::Double(radii));
    columns.extend(normals.into_iter().map(Values::Double));
    (headings, columns)
}
