//! What positions are measured on: a plane (or a line, or space) of lengths, or the earth.

use geographiclib_rs::{Geodesic, InverseGeodesic, PolygonArea, Winding};
use space::{Real, Space, Vector};
use std::sync::LazyLock;

/// What the numbers of a position are, and what a distance is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground<const D: usize> {
    /// Lengths along straight axes, open or periodic.
    Plane(Space<f64, D>),
    /// Longitude and latitude, degrees, on the ellipsoid WGS84; in two dimensions only. Distances are geodesic, in metres.
    ///
    /// Where a plane is needed (centres, directions, hulls) it is the azimuthal equidistant plane about the centre of the frame:
    /// metres east and north, exact along every line through the centre, and between others wrong by a share of about
    /// (distance from the centre / 9000 km)^2.
    Globe,
}

/// The ellipsoid.
static WGS84: LazyLock<Geodesic> = LazyLock::new(Geodesic::wgs84);

/// Length (m) of the shortest way on WGS84 between two places, `[longitude, latitude]` in degrees.
///
/// C. F. F. Karney (2013), Algorithms for geodesics, Journal of Geodesy 87:43.
pub fn geodesic(here: [f64; 2], there: [f64; 2]) -> f64 {
    if here == there {
        return 0.0;
    }
    WGS84.inverse(here[1], here[0], there[1], there[0])
}

/// The offset (m east, m north) of a place seen from another: as long as the shortest way, in the direction in which it sets out.
pub fn departure(here: [f64; 2], there: [f64; 2]) -> Vector<f64, 2> {
    if here == there {
        return Vector::ZERO;
    }
    let (length, azimuth, _, _): (f64, f64, f64, f64) = WGS84.inverse(here[1], here[0], there[1], there[0]);
    let (sin, cos) = Real::sin_cos(azimuth.to_radians());
    Vector([length * sin, length * cos])
}

/// The same way, in the direction in which it arrives.
pub fn arrival(here: [f64; 2], there: [f64; 2]) -> Vector<f64, 2> {
    -departure(there, here)
}

/// Area (m^2) and perimeter (m) of a polygon whose sides are geodesics, `[corners]` of `[longitude, latitude]` in degrees.
pub fn polygon(corners: impl Iterator<Item = [f64; 2]>) -> (f64, f64) {
    let mut polygon = PolygonArea::new(&WGS84, Winding::CounterClockwise);
    for [longitude, latitude] in corners {
        polygon.add_point(latitude, longitude);
    }
    let (perimeter, area, _) = polygon.compute(true);
    (area.abs(), perimeter)
}

/// The mean of places, `[longitude, latitude]` in degrees, for places that do not reach round the earth: about this
/// one the plane of a frame is laid. `None` of no places.
pub(crate) fn middle(places: impl Iterator<Item = [f64; 2]> + Clone) -> Option<[f64; 2]> {
    let first = places.clone().next()?;
    let round = Space { edges: [space::Edge::Periodic(360.0), space::Edge::Open] };
    let mut sum = Vector::ZERO;
    let mut count = 0.0;
    for place in places {
        sum += round.offset(Vector(first), Vector(place));
        count += 1.0;
    }
    Some((Vector(first) + sum / count).0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_known_from_elsewhere() {
        // a degree of longitude on the equator, a pi/180 with a = 6378137 m
        assert!((geodesic([10.0, 0.0], [11.0, 0.0]) - 6_378_137.0 * 1f64.to_radians()).abs() < 1e-6);
        // Wellington to Salamanca, the example in the documentation of GeographicLib
        assert!((geodesic([174.81, -41.32], [-5.5, 40.96]) - 19_959_679.267).abs() < 1e-3);
        assert_eq!(geodesic([36.9, 0.35], [36.9, 0.35]), 0.0);
        // across the date line
        assert!((geodesic([179.5, 0.0], [-179.5, 0.0]) - geodesic([0.0, 0.0], [1.0, 0.0])).abs() < 1e-6);
    }

    #[test]
    fn directions_are_east_and_north() {
        let east = departure([0.0, 0.0], [0.001, 0.0]);
        assert!(east[0] > 111.0 && east[1].abs() < 1e-9);
        let north = arrival([0.0, 0.0], [0.0, 0.001]);
        assert!(north[1] > 110.0 && north[0].abs() < 1e-9);
        assert_eq!(departure([5.0, 5.0], [5.0, 5.0]), Vector::ZERO);
        assert_eq!(middle([[179.0, 1.0], [-179.0, 3.0]].into_iter()), Some([180.0, 2.0]));
        assert_eq!(middle(core::iter::empty()), None);
    }

    #[test]
    fn a_small_square() {
        let side = 0.001;
        let (area, perimeter) = polygon([[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]].into_iter());
        let (east, north) = (geodesic([0.0, 0.0], [side, 0.0]), geodesic([0.0, 0.0], [0.0, side]));
        assert!((area / (east * north) - 1.0).abs() < 1e-6, "{area}");
        assert!((perimeter / (2.0 * (east + north)) - 1.0).abs() < 1e-6, "{perimeter}");
    }
}
