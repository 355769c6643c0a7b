//! `wall`: a straight thin wall.

use super::{PrimitiveType, length, place};
use crate::geometry::Geometry;
use crate::schema::{Domain, Parameter, known};
use crate::schemas::anchored;
use space::Vector;

pub(super) fn primitive_type() -> PrimitiveType {
    let [x, y] = place();
    let angle = Parameter::new("angle", "deg", Domain::Periodic(0.0, 360.0), 0.0, "Its direction from its first end.");
    PrimitiveType {
        id: "wall",
        about: "A straight thin wall from a point.",
        attributes: vec![x, y, angle, length("length", 1.0, "Its length.")],
        build: |values| {
            let [x, y, angle, length] = known(values);
            vec![Geometry::Wall(anchored(Vector([x, y]), angle, length))]
        },
    }
}
