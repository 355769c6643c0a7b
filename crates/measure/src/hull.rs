//! Convex hulls in the plane and in space.

use robust::{Coord3D, orient3d};
use space::Vector;

/// Where three places turn by less than this share of the lengths of their sides, they are on one line; a solid thinner than this share
/// of its length is none. Far above the rounding of positions, far below what is measured.
const STRAIGHT: f64 = 1e-12;

/// The convex hull of places in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// Indices of the corners, counter-clockwise.
    pub corners: Vec<usize>,
    /// Area, length^2.
    pub area: f64,
    /// Perimeter, length.
    pub perimeter: f64,
}

/// The convex hull of places, `[places]`, whose first two components are taken; places on its sides are no corners. `None`
/// where all are on one line.
///
/// A. M. Andrew (1979), Another efficient algorithm for convex hulls in two dimensions, Information Processing Letters 9:216.
pub fn flat_hull<const D: usize>(places: &[Vector<f64, D>]) -> Option<Hull> {
    let at = |k: usize| Vector([places[k].0[0], places[k].0[1]]);
    let mut order: Vec<usize> = (0..places.len()).collect();
    let key = |k: usize| (places[k].0[0], places[k].0[1]);
    order.sort_unstable_by(|&i, &j| {
        let (one, other) = (key(i), key(j));
        one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)).then(i.cmp(&j))
    });
    let mut corners: Vec<usize> = Vec::with_capacity(16);
    let turns_left = |a: usize, b: usize, c: usize| {
        let (one, other) = (at(b) - at(a), at(c) - at(a));
        let turn = one.0[0] * other.0[1] - one.0[1] * other.0[0];
        turn > STRAIGHT * one.length() * other.length()
    };
    // the lower side from left to right, then the upper one back
    let mut side = |places: &mut dyn Iterator<Item = usize>| {
        let kept = corners.len();
        for k in places {
            while corners.len() >= kept + 2 && !turns_left(corners[corners.len() - 2], corners[corners.len() - 1], k) {
                corners.pop();
            }
            corners.push(k);
        }
        corners.pop();
    };
    side(&mut order.iter().copied());
    side(&mut order.iter().rev().copied());
    if corners.len() < 3 {
        return None;
    }
    let origin = at(corners[0]);
    let (mut doubled, mut perimeter) = (0.0, 0.0);
    for k in 0..corners.len() {
        let (here, next) = (at(corners[k]) - origin, at(corners[(k + 1) % corners.len()]) - origin);
        doubled += here.0[0] * next.0[1] - here.0[1] * next.0[0];
        perimeter += (next - here).length();
    }
    Some(Hull { corners, area: doubled / 2.0, perimeter })
}

/// Volume (length^3) and surface (length^2) of the convex hull of places in space, `[places]`. `None` where all are in one plane.
///
/// The hull grows place by place from a tetrahedron: the faces that a place outside sees, also edge on, are replaced by those
/// from their rim to it. Who sees what is decided exactly. The cost grows with the number of places times that of faces.
pub fn solid_hull(places: &[Vector<f64, 3>]) -> Option<(f64, f64)> {
    let first = *places.first()?;
    let offset = |k: usize| places[k] - first;
    let farthest = |measure: &dyn Fn(usize) -> f64| {
        let most = |best: (f64, usize), k: usize| if measure(k) > best.0 { (measure(k), k) } else { best };
        (0..places.len()).fold((0.0, 0), most)
    };
    let (length, a) = farthest(&|k| offset(k).length());
    let along = offset(a).unit();
    let (width, b) = farthest(&|k| (offset(k) - along * offset(k).dot(along)).length());
    let normal = offset(a).unit().cross3(offset(b).unit()).unit();
    let (height, c) = farthest(&|k| offset(k).dot(normal).abs());
    if !(length.is_finite() && width > STRAIGHT * length && height > STRAIGHT * length) {
        return None;
    }
    // positive where the place is outside the face, whose corners stand counter-clockwise seen from outside
    let outside = |face: &[usize; 3], k: usize| {
        let [i, j, l, k] = [face[0], face[1], face[2], k].map(|k| offset(k).0).map(|[x, y, z]| Coord3D { x, y, z });
        -orient3d(i, j, l, k)
    };
    let mut faces = vec![[0, a, b], [0, b, c], [0, c, a], [a, c, b]];
    let turned = outside(&faces[0], c);
    if turned == 0.0 {
        return None;
    }
    if turned > 0.0 {
        faces.iter_mut().for_each(|face| face.swap(1, 2));
    }
    for k in 0..places.len() {
        if !faces.iter().any(|face| outside(face, k) > 0.0) {
            continue;
        }
        let mut rim: Vec<[usize; 2]> = Vec::new();
        faces.retain(|face| {
            // with a face seen edge on goes every side that is in line with the place: no new face is without an area
            let seen = outside(face, k) >= 0.0;
            if seen {
                for side in 0..3 {
                    let edge = [face[side], face[(side + 1) % 3]];
                    // a side of two faces that are seen is none of the rim
                    match rim.iter().position(|&[from, to]| [to, from] == edge) {
                        Some(twin) => drop(rim.swap_remove(twin)),
                        None => rim.push(edge),
                    }
                }
            }
            !seen
        });
        faces.extend(rim.iter().map(|&[from, to]| [from, to, k]));
    }
    let inner = (offset(a) + offset(b) + offset(c)) / 4.0;
    let (mut volume, mut surface) = (0.0, 0.0);
    for face in faces {
        let [i, j, l] = face.map(|k| offset(k) - inner);
        volume += i.dot(j.cross3(l)) / 6.0;
        surface += (j - i).cross3(l - i).length() / 2.0;
    }
    Some((volume, surface))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
    }

    #[test]
    fn a_lattice_has_four_corners() {
        let lattice: Vec<Vector<f64, 2>> = (0..25).map(|k| Vector([f64::from(k % 5), f64::from(k / 5)])).collect();
        let hull = flat_hull(&lattice);
        assert_eq!(hull, Some(Hull { corners: vec![0, 4, 24, 20], area: 16.0, perimeter: 16.0 }));
        let moved: Vec<_> = lattice.iter().map(|&p| p * 0.1 + Vector([1000.3, -0.7])).collect();
        assert!(flat_hull(&moved).is_some_and(|hull| hull.corners == [0, 4, 24, 20]));
    }

    #[test]
    fn no_hull_on_a_line() {
        for n in [0, 1, 2, 9] {
            let line: Vec<_> = (0..n).map(|k| Vector([0.1 * f64::from(k), 0.3 * f64::from(k)])).collect();
            assert_eq!(flat_hull(&line), None, "{n}");
            assert_eq!(flat_hull(&vec![Vector([3.0, 3.0]); n as usize]), None);
        }
        let plane: Vec<_> =
            (0..16).map(|k| Vector([f64::from(k % 4), f64::from(k / 4), 0.1 * f64::from(k % 4)])).collect();
        assert_eq!(solid_hull(&plane), None);
        assert_eq!(solid_hull(&[]), None);
        assert_eq!(solid_hull(&[Vector([1.0; 3]); 9]), None);
    }

    #[test]
    fn solids() {
        let cube: Vec<_> =
            (0..125).map(|k| Vector([f64::from(k % 5), f64::from(k / 5 % 5), f64::from(k / 25)])).collect();
        let (volume, surface) = solid_hull(&cube).unwrap_or_default();
        close(volume, 64.0);
        close(surface, 96.0);
        let turn = |p: Vector<f64, 3>| {
            let (x, y) = (0.8 * p[0] - 0.6 * p[1], 0.6 * p[0] + 0.8 * p[1]);
            Vector([x, 0.28 * y - 0.96 * p[2], 0.96 * y + 0.28 * p[2]])
        };
        let turned: Vec<_> = cube.iter().map(|&p| turn(p)).rev().collect();
        let (volume, surface) = solid_hull(&turned).unwrap_or_default();
        close(volume, 64.0);
        close(surface, 96.0);
        let corner = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1, 0.1, 0.1]].map(Vector);
        let (volume, surface) = solid_hull(&corner).unwrap_or_default();
        close(volume, 1.0 / 6.0);
        close(surface, 1.5 + 0.75f64.sqrt());
        // on a sphere: below its volume, and near it
        let sphere: Vec<_> = (0..400)
            .map(|k| {
                let z = 1.0 - (2.0 * f64::from(k) + 1.0) / 400.0;
                let (sin, cos) = (2.4 * f64::from(k)).sin_cos();
                Vector([(1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z])
            })
            .collect();
        let (volume, surface) = solid_hull(&sphere).unwrap_or_default();
        let pi = core::f64::consts::PI;
        assert!((0.97..1.0).contains(&(volume / (4.0 / 3.0 * pi))), "{volume}");
        assert!((0.97..1.0).contains(&(surface / (4.0 * pi))), "{surface}");
    }
}
