//! Workspaces and environments as text: WKT and SVG for geometry, GeoJSON for everything.
//!
//! Numbers are written so that they read back to the same bits.

pub mod geojson;
pub mod svg;
pub mod wkt;

mod json;

use crate::TerrainError;
use crate::geometry::{Geometry, Point};
use crate::workspace::Workspace;
use space::Segment;
use space::shape::Shape;

/// What reads a text from its beginning to its end, and knows the line it is in.
struct Cursor<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Cursor<'a> {
    fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }
    /// What is left, without leading blanks.
    fn rest(&mut self) -> &'a str {
        let rest = &self.text[self.at..];
        let trimmed = rest.trim_start();
        self.at += rest.len() - trimmed.len();
        trimmed
    }
    /// Takes this word where it comes next.
    fn take(&mut self, word: &str) -> bool {
        let found = self.rest().starts_with(word);
        if found {
            self.at += word.len();
        }
        found
    }
    /// Takes this word, or fails.
    fn need(&mut self, word: &str) -> Result<(), TerrainError> {
        if self.take(word) { Ok(()) } else { self.fault(&format!("`{word}`")) }
    }
    /// Takes letters as long as a condition holds.
    fn word(&mut self, belongs: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let word = &rest[..rest.find(|letter| !belongs(letter)).unwrap_or(rest.len())];
        self.at += word.len();
        word
    }
    /// A finite number.
    fn number(&mut self) -> Result<f64, TerrainError> {
        let rest = self.rest();
        let longest = number_length(rest);
        match rest[..longest].parse::<f64>() {
            Ok(number) if number.is_finite() => {
                self.at += longest;
                Ok(number)
            }
            _ => self.fault("a finite number"),
        }
    }
    fn fault<T>(&mut self, expected: &str) -> Result<T, TerrainError> {
        let found: String = self.rest().chars().take_while(|letter| *letter != '\n').take(20).collect();
        let found = if found.is_empty() { "the end".to_owned() } else { format!("`{found}`") };
        Err(self.wrong(format!("expected {expected}, found {found}")))
    }
    fn wrong(&self, problem: String) -> TerrainError {
        TerrainError::Text { line: self.text[..self.at].matches('\n').count() + 1, problem }
    }
}

/// How many letters at the beginning make a number: sign, digits, point, digits, exponent.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let sign = |at: usize| at + usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let mut end = digits(sign(0));
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let exponent = sign(end + 1);
        if digits(exponent) > exponent {
            end = digits(exponent);
        }
    }
    end
}

/// The geometry of a closed line of points, whose last may repeat the first.
fn ring(mut points: Vec<Point>) -> Geometry {
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    Geometry::Polygon(points)
}

/// The walls along an open line of points; a single point is a wall without length.
fn line(points: &[Point]) -> Vec<Geometry> {
    match points {
        [only] => vec![Geometry::Wall(Segment { from: *only, to: *only })],
        _ => crate::geometry::along(points),
    }
}

/// A workspace of geometry that was read, without any names.
pub fn workspace(name: &str, units: crate::Units, geometry: Vec<Geometry>) -> Workspace {
    Workspace { geometry, ..Workspace::empty(name, units) }
}

/// The corners of a region, where it has straight sides; `None` of a disc and of what has no corners.
fn corners(region: &Shape<f64, 2>) -> Option<Vec<Point>> {
    match region {
        Shape::Polygon { vertices } => Some(vertices.clone()),
        Shape::Cuboid { low, high } => Some(
            [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]].map(space::Vector).to_vec(),
        ),
        Shape::Ball { .. } | Shape::Segment { .. } | Shape::Plane { .. } => None,
    }
}

#[cfg(test)]
mod tests;
