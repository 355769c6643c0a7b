//! Primitive types: one file each, one line each in the list below. A primitive is a type with a value for each of its
//! attributes; the empty primitive is no piece at all, and a member of every set.

use crate::construct::Piece;
use crate::geometry::Geometry;
use crate::schema::{Domain, Parameter};
use crate::{Construct, TerrainError, Units};

/// A primitive type: attributes, and the rule that turns their values into geometry.
#[derive(Clone, Debug)]
pub struct PrimitiveType {
    /// Name in files.
    pub id: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// Its attributes, in the order in which values are given.
    pub attributes: Vec<Parameter>,
    /// Its geometry.
    pub build: fn(&[f64]) -> Vec<Geometry>,
}

/// A primitive: a type with a value for each attribute.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// Name of its type.
    pub kind: &'static str,
    /// The values, in the order of the attributes.
    pub values: Vec<f64>,
}

macro_rules! primitives {
    ($($file:ident;)*) => {
        $(mod $file;)*
        /// All primitive types, in the order of the list.
        pub fn all() -> Vec<PrimitiveType> {
            vec![$($file::primitive_type()),*]
        }
    };
}

primitives! {
    wall;
    post;
    circle;
    rectangle;
}

/// The primitive type of an id.
///
/// # Errors
/// Where none has this id.
pub fn find(id: &str) -> Result<PrimitiveType, TerrainError> {
    let mut all = all();
    match all.iter().position(|kind| kind.id == id) {
        Some(k) => Ok(all.swap_remove(k)),
        None => Err(TerrainError::unknown("primitive type", id, all.iter().map(|kind| kind.id))),
    }
}

impl PrimitiveType {
    /// A primitive of this type.
    ///
    /// # Errors
    /// Values that are too few, too many, or outside their domains.
    pub fn primitive(&self, values: &[f64]) -> Result<Primitive, TerrainError> {
        if values.len() != self.attributes.len() {
            let expected = format!("{} numbers", self.attributes.len());
            return Err(TerrainError::range(format!("attributes of `{}`", self.id), expected, values.len() as f64));
        }
        for (attribute, &value) in self.attributes.iter().zip(values) {
            if !attribute.domain.holds(value) {
                return Err(TerrainError::range(attribute.name.as_ref(), attribute.domain.words(), value));
            }
        }
        Ok(Primitive { kind: self.id, values: values.to_vec() })
    }
}

/// The construct of primitives.
///
/// # Errors
/// A type that is not in the list, or values outside their domains.
pub fn construct(units: Units, primitives: &[Primitive]) -> Result<Construct, TerrainError> {
    let mut pieces = Vec::with_capacity(primitives.len());
    for primitive in primitives {
        let kind = find(primitive.kind)?;
        kind.primitive(&primitive.values)?;
        pieces.push(Piece { name: kind.id.to_owned(), geometry: (kind.build)(&primitive.values) });
    }
    Ok(Construct::new(units, pieces))
}

/// The attributes by which a primitive has its place.
fn place() -> [Parameter; 2] {
    ["x", "y"]
        .map(|name| Parameter::new(name, "length", Domain::Range(-1e6, 1e6), 0.0, "Where it is, along this axis."))
}

/// An attribute that is a length.
fn length(name: &'static str, default: f64, about: &'static str) -> Parameter {
    Parameter::new(name, "length", Domain::Range(0.0, 1e6), default, about)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn every_type_builds_from_its_defaults_and_within_its_domains_alone() {
        for kind in all() {
            let mut values: Vec<f64> = kind.attributes.iter().map(|attribute| attribute.default).collect();
            let one = construct(Units::Metres, &[kind.primitive(&values).unwrap()]).unwrap();
            assert!(one.material() > 0.0, "{}", kind.id);
            assert!(kind.primitive(&values[1..]).is_err());
            values[0] = f64::INFINITY;
            assert!(kind.primitive(&values).is_err());
        }
        assert!(find("wal").unwrap_err().to_string().contains("did you mean `wall`"));
        assert_eq!(construct(Units::Field, &[]).unwrap().pieces.len(), 0, "the empty primitive");
    }

    #[test]
    fn walls_and_rectangles_stand_where_they_should() {
        let build = |id: &str, values: &[f64]| (find(id).unwrap().build)(values);
        let wall = build("wall", &[1.0, 2.0, 90.0, 3.0]);
        assert_eq!(wall[0].segments()[0].numbers(), [1.0, 2.0, 1.0, 5.0]);
        let rectangle = build("rectangle", &[0.0, 0.0, 90.0, 4.0, 2.0]);
        assert_eq!((rectangle[0].length(), rectangle[0].points()[0]), (12.0, space::Vector([1.0, -2.0])));
    }
}
