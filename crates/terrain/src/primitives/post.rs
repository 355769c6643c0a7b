//! `post`: a disc that is in the way.

use super::{PrimitiveType, length, place};
use crate::geometry::Geometry;
use crate::schema::known;
use space::Vector;

pub(super) fn primitive_type() -> PrimitiveType {
    let [x, y] = place();
    PrimitiveType {
        id: "post",
        about: "A disc that is in the way.",
        attributes: vec![x, y, length("radius", 0.1, "Its radius.")],
        build: |values| {
            let [x, y, radius] = known(values);
            vec![Geometry::Disc { centre: Vector([x, y]), radius }]
        },
    }
}
