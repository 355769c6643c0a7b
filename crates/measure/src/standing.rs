//! Where members stand within their cluster: in the frame of the cluster, whose origin is its centre and whose first axis points along
//! its mean heading, in units of the root of its expanse.

use crate::near::linked;
use space::{Space, Vector};

/// The place of each member in its cluster: ahead, to the left, up. `None` where there is no such place: alone in a cluster, all of it
/// in one point, or headings that cancel. Members at most `distance` apart are linked.
pub fn standing<const D: usize>(
    space: &Space<f64, D>,
    places: &[Vector<f64, D>],
    velocities: &[Vector<f64, D>],
    distance: f64,
) -> Vec<Option<[f64; 3]>> {
    let clusters = linked(space, places, distance);
    let count = clusters.iter().max().map_or(0, |last| last + 1);
    let mut members = vec![Vec::new(); count];
    for (k, &cluster) in clusters.iter().enumerate() {
        members[cluster].push(k);
    }
    let mut found = vec![None; places.len()];
    for cluster in members {
        let number = cluster.len() as f64;
        // offsets from its first member, so that a cluster may lie across a seam
        let from = |k: usize| space.offset(places[cluster[0]], places[k]);
        let centre = cluster.iter().fold(Vector::ZERO, |sum, &k| sum + from(k)) / number;
        let heading = cluster.iter().fold(Vector::ZERO, |sum, &k| sum + velocities[k].unit()).unit();
        let expanse = cluster.iter().map(|&k| (from(k) - centre).length_squared()).sum::<f64>() / number;
        let root = expanse.sqrt();
        if root <= 1e-12 || heading.is_tiny() {
            continue;
        }
        let axes = axes(heading);
        for &k in &cluster {
            let offset = (from(k) - centre) / root;
            found[k] = Some(axes.map(|axis| axis.dot(offset)));
        }
    }
    found
}

/// Ahead, left and up for a heading; zero where the space has no such direction.
fn axes<const D: usize>(heading: Vector<f64, D>) -> [Vector<f64, D>; 3] {
    if D < 3 {
        return [heading, heading.left(), Vector::ZERO];
    }
    let left = Vector::axis(D - 1).cross3(heading).unit_or(Vector::axis(1));
    [heading, left, heading.cross3(left)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_and_one_alone() {
        // two behind each other, heading along y, and one far away
        let places = [Vector([0.0, 0.0]), Vector([0.0, 4.0]), Vector([90.0, 0.0])];
        let velocities = [Vector([0.0, 2.0]); 3];
        let found = standing(&Space::open(), &places, &velocities, 5.0);
        assert_eq!(found, vec![Some([-1.0, 0.0, 0.0]), Some([1.0, 0.0, 0.0]), None]);
        // across a seam it is the same
        let places = [Vector([50.0, 98.0]), Vector([50.0, 2.0]), Vector([90.0, 50.0])];
        assert_eq!(standing(&Space::periodic([100.0; 2]), &places, &velocities, 5.0), found);
        // headings that cancel have no mean
        let against = [Vector([0.0, 2.0]), Vector([0.0, -2.0]), Vector([0.0, 1.0])];
        assert!(standing(&Space::open(), &places, &against, 500.0)[0].is_some());
        assert_eq!(standing(&Space::periodic([100.0; 2]), &places, &against, 5.0), vec![None; 3]);
    }

    #[test]
    fn left_and_up_in_space() {
        let places =
            [Vector([0.0, 1.0, 0.0]), Vector([0.0, -1.0, 0.0]), Vector([0.0, 0.0, 1.0]), Vector([0.0, 0.0, -1.0])];
        let found = standing(&Space::open(), &places, &[Vector([1.0, 0.0, 0.0]); 4], 5.0);
        assert_eq!(found[0], Some([0.0, 1.0, 0.0]));
        assert_eq!(found[2], Some([0.0, 0.0, 1.0]));
    }
}
