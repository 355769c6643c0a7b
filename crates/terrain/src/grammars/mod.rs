//! The shipped grammars: one file each, one line each in the list below.

use crate::Expression;
use crate::TerrainError;
use crate::geometry::Geometry;
use crate::grammar::{Grammar, Item, ItemPlace, Kind, ShapeKind};
use space::Segment;

macro_rules! grammars {
    ($($file:ident: $id:literal;)*) => {
        $(pub mod $file;)*
        /// The names of all shipped grammars, in the order of the list.
        pub const LIST: &[&str] = &[$($id),*];
        /// The grammar of a name.
        ///
        /// # Errors
        /// Where none is called so.
        pub fn find(name: &str) -> Result<Grammar, TerrainError> {
            match name {
                $($id => Ok($file::grammar()),)*
                _ => Err(TerrainError::unknown("grammar", name, LIST.iter().copied())),
            }
        }
    };
}

grammars! {
    splitting: "splitting";
    splitting_equal: "splitting-equal";
    corralling: "corralling";
    straight: "straight";
    fish_weir: "fish-weir";
    figure_6_2: "figure-6-2";
    string_a: "string-a";
}

/// A shape made of lines in its unit frame.
fn lines(name: &str, kind: Kind, lines: &[[f64; 4]]) -> ShapeKind {
    let wall = |&[x0, y0, x1, y1]: &[f64; 4]| Geometry::Wall(Segment::new([x0, y0], [x1, y1]));
    ShapeKind { name: name.into(), kind, geometry: lines.iter().map(wall).collect() }
}

/// The wall of all grammars: a straight line from its beginning to its end.
fn wall() -> ShapeKind {
    lines("wall", Kind::Terminal, &[[0.0, 0.0, 1.0, 0.0]])
}

/// A square about its place.
fn square(name: &str, kind: Kind) -> ShapeKind {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(space::Vector);
    ShapeKind { name: name.into(), kind, geometry: vec![Geometry::Polygon(corners.to_vec())] }
}

/// A shape at a place, at an angle (degrees) and of a length.
fn item(shape: &str, place: ItemPlace, turn: impl Into<Expression>, length: impl Into<Expression>) -> Item {
    Item { shape: shape.into(), place, turn: Some(turn.into()), length: Some(length.into()), ..Item::default() }
}

#[cfg(test)]
mod tests;
