//! `circle`: a round thin wall.

use super::{PrimitiveType, length, place};
use crate::geometry::Geometry;
use crate::schema::known;
use space::Vector;

pub(super) fn primitive_type() -> PrimitiveType {
    let [x, y] = place();
    PrimitiveType {
        id: "circle",
        about: "A round thin wall, which may be inside as well as outside.",
        attributes: vec![x, y, length("radius", 1.0, "Its radius.")],
        build: |values| {
            let [x, y, radius] = known(values);
            vec![Geometry::Circle { centre: Vector([x, y]), radius }]
        },
    }
}
