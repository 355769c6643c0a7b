//! `rectangle`: four walls about a point.

use super::{PrimitiveType, length, place};
use crate::geometry::{Geometry, Pose};
use crate::schema::{Domain, Parameter, known};
use space::Vector;

pub(super) fn primitive_type() -> PrimitiveType {
    let [x, y] = place();
    let angle = Parameter::new("angle", "deg", Domain::Periodic(0.0, 360.0), 0.0, "Direction of its length.");
    let (long, wide) = (length("length", 2.0, "Its length."), length("width", 1.0, "Its width."));
    PrimitiveType {
        id: "rectangle",
        about: "Four walls about a point.",
        attributes: vec![x, y, angle, long, wide],
        build: |values| {
            let [x, y, angle, length, width] = known(values);
            let (l, w) = (length / 2.0, width / 2.0);
            let corners = [[-l, -w], [l, -w], [l, w], [-l, w]].map(Vector).to_vec();
            vec![Geometry::Polygon(corners).moved(&Pose::new([x, y], angle), [1.0, 1.0])]
        },
    }
}
