//! `corralling`: the marker lies strictly inside the convex hull of the ends of all walls, and a point can get away from
//! it to the outside.

use super::{Filter, FilterCard, Verdict};
use crate::arrangement::Corral;
use crate::{Construct, Workspace};

/// `corralling`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Corralling;

impl Filter for Corralling {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "corralling",
            about: "the first marker is inside the convex hull of all walls and has a way to the outside.",
            parameters: &[],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let Some(marker) = construct.markers.first().map(|marker| marker.pose.at) else {
            return Verdict { pass: false, reason: "it has no marker", measure: 0.0 };
        };
        let corral = Corral::of(&construct.walls(), marker);
        let reason = if corral.in_hull { "the marker is shut in" } else { "the marker is outside the hull" };
        Verdict::unless(corral.pass(), reason, f64::from(u8::from(corral.in_hull)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::construct::Marker;
    use crate::filters::tests::construct;
    use crate::geometry::Pose;
    use crate::workspaces;

    #[test]
    fn a_horseshoe_passes_a_ring_and_a_line_do_not() {
        let ring = [[3., -3., 3., 3.], [3., 3., -3., 3.], [-3., 3., -3., -3.], [-3., -3., 3., -3.]];
        let reason = |walls: &[[f64; 4]]| {
            let mut construct = construct(walls);
            construct.markers.push(Marker { name: "cross".into(), pose: Pose::ORIGIN });
            Corralling.check(&construct, &workspaces::arena(10.0)).reason
        };
        assert_eq!(reason(&ring), "the marker is shut in");
        assert_eq!(reason(&ring[1..]), "");
        assert_eq!(reason(&ring[..1]), "the marker is outside the hull");
        let bare = Corralling.check(&construct(&ring), &workspaces::arena(10.0));
        assert_eq!(bare.reason, "it has no marker");
    }
}
