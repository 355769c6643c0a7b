//! Well-known text (OGC 06-103r4): walls are `LINESTRING`s, polygons `POLYGON`s. Circles are the `CIRCULARSTRING`s of
//! SQL/MM whose first and last point are one, discs the `CURVEPOLYGON`s of such.

use super::{Cursor, line, ring};
use crate::TerrainError;
use crate::geometry::{Geometry, Point};
use space::Vector;
use std::fmt::Write;

/// Deepest nesting of collections that is read.
const DEEPEST: usize = 32;

/// The geometry as one `GEOMETRYCOLLECTION`.
pub fn write<'a>(geometry: impl IntoIterator<Item = &'a Geometry>) -> String {
    let mut parts = Vec::new();
    for piece in geometry {
        parts.push(match piece {
            Geometry::Wall(wall) => format!("LINESTRING ({})", list(&[wall.from, wall.to])),
            Geometry::Polygon(corners) => {
                let closed = [corners.as_slice(), corners.get(..1).unwrap_or_default()].concat();
                format!("POLYGON (({}))", list(&closed))
            }
            Geometry::Circle { centre, radius } => format!("CIRCULARSTRING ({})", list(&circle(*centre, *radius))),
            Geometry::Disc { centre, radius } => {
                format!("CURVEPOLYGON (CIRCULARSTRING ({}))", list(&circle(*centre, *radius)))
            }
        });
    }
    if parts.is_empty() {
        "GEOMETRYCOLLECTION EMPTY".into()
    } else {
        format!("GEOMETRYCOLLECTION ({})", parts.join(", "))
    }
}

/// A full circle by its two utmost points along x, the first twice.
fn circle(centre: Point, radius: f64) -> [Point; 3] {
    let (right, left) = (centre + Vector([radius, 0.0]), centre - Vector([radius, 0.0]));
    [right, left, right]
}

fn list(points: &[Point]) -> String {
    let mut text = String::new();
    for (k, p) in points.iter().enumerate() {
        let comma = if k == 0 { "" } else { ", " };
        // writing to a text cannot fail
        let _ = write!(text, "{comma}{} {}", p[0], p[1]);
    }
    text
}

/// The geometry of a text. Points are discs of the radius given, polygons with holes are several polygons.
///
/// # Errors
/// A text that is not WKT, a kind of geometry that is not read, arcs that are not full circles.
pub fn read(text: &str, point_radius: f64) -> Result<Vec<Geometry>, TerrainError> {
    let mut cursor = Cursor::new(text);
    let mut all = Vec::new();
    while !cursor.rest().is_empty() {
        one(&mut cursor, point_radius, 0, &mut all)?;
        cursor.take(";");
    }
    Ok(all)
}

const KINDS: [&str; 9] = [
    "POINT",
    "LINESTRING",
    "POLYGON",
    "MULTIPOINT",
    "MULTILINESTRING",
    "MULTIPOLYGON",
    "GEOMETRYCOLLECTION",
    "CIRCULARSTRING",
    "CURVEPOLYGON",
];

fn one(cursor: &mut Cursor<'_>, radius: f64, depth: usize, all: &mut Vec<Geometry>) -> Result<(), TerrainError> {
    if depth > DEEPEST {
        return cursor.fault("less deeply nested collections");
    }
    let start = cursor.at;
    let kind = cursor.word(|letter| letter.is_alphanumeric() || letter == '_').to_uppercase();
    if !KINDS.contains(&kind.as_str()) {
        let wrong = TerrainError::unknown("geometry", &kind, KINDS.into_iter());
        cursor.at = start;
        return Err(cursor.wrong(wrong.to_string()));
    }
    if cursor.rest().get(..5).is_some_and(|word| word.eq_ignore_ascii_case("empty")) {
        cursor.at += 5;
        return Ok(());
    }
    let disc = |centre: Point| Geometry::Disc { centre, radius };
    match kind.as_str() {
        "POINT" | "MULTIPOINT" => all.extend(points(cursor)?.into_iter().map(disc)),
        "LINESTRING" => all.extend(line(&points(cursor)?)),
        "POLYGON" => all.extend(several(cursor, points)?.into_iter().map(ring)),
        "MULTILINESTRING" => all.extend(several(cursor, points)?.iter().flat_map(|points| line(points))),
        "MULTIPOLYGON" => {
            all.extend(several(cursor, |cursor| several(cursor, points))?.into_iter().flatten().map(ring));
        }
        "CIRCULARSTRING" => {
            let (centre, radius) = full_circle(cursor)?;
            all.push(Geometry::Circle { centre, radius });
        }
        "CURVEPOLYGON" => {
            cursor.need("(")?;
            if cursor.word(char::is_alphabetic).to_uppercase() != "CIRCULARSTRING" {
                return cursor.fault("a CIRCULARSTRING");
            }
            let (centre, radius) = full_circle(cursor)?;
            cursor.need(")")?;
            all.push(Geometry::Disc { centre, radius });
        }
        _ => {
            several(cursor, |cursor| one(cursor, radius, depth + 1, all))?;
        }
    }
    Ok(())
}

/// A list in parentheses.
fn several<T>(
    cursor: &mut Cursor<'_>,
    mut each: impl FnMut(&mut Cursor<'_>) -> Result<T, TerrainError>,
) -> Result<Vec<T>, TerrainError> {
    cursor.need("(")?;
    let mut list = vec![each(cursor)?];
    while cursor.take(",") {
        list.push(each(cursor)?);
    }
    cursor.need(")")?;
    Ok(list)
}

/// Points in parentheses, each perhaps in parentheses of its own; heights are left aside.
fn points(cursor: &mut Cursor<'_>) -> Result<Vec<Point>, TerrainError> {
    several(cursor, |cursor| {
        let inner = cursor.take("(");
        let point = Vector([cursor.number()?, cursor.number()?]);
        while !matches!(cursor.rest().chars().next(), Some(',' | ')') | None) {
            cursor.number()?;
        }
        if inner {
            cursor.need(")")?;
        }
        Ok(point)
    })
}

fn full_circle(cursor: &mut Cursor<'_>) -> Result<(Point, f64), TerrainError> {
    match points(cursor)?.as_slice() {
        [first, opposite, last] if first == last => {
            Ok(((*first + *opposite) / 2.0, (*first - *opposite).length() / 2.0))
        }
        _ => Err(cursor.wrong("expected a full circle: a point, the one opposite, and the first again".into())),
    }
}
