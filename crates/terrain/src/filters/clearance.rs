//! `clearance`: walls keep a distance from those of the workspace, but for those attached there by an end.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};
use space::segment::Relation;

/// `clearance`.
#[derive(Clone, Copy, Debug)]
pub struct Clearance {
    /// Least distance.
    pub least: f64,
}

impl Default for Clearance {
    fn default() -> Self {
        Self { least: 0.5 }
    }
}

impl Filter for Clearance {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "clearance",
            about: "walls keep a distance from those of the workspace, but for those attached there by an end.",
            parameters: &[("least", "Least distance.")],
        }
    }
    fn check(&self, construct: &Construct, workspace: &Workspace) -> Verdict {
        let fixed = workspace.walls();
        let mut nearest = f64::MAX;
        for wall in construct.walls() {
            for other in &fixed {
                if wall.relation(other) != Relation::Touch {
                    nearest = nearest.min(wall.distance_to(other));
                }
            }
        }
        Verdict::unless(nearest >= self.least, "too close to a wall of the workspace", nearest)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        match name {
            "least" => Some(&mut self.least),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn attached_walls_are_not_judged_by_their_wall() {
        let filter = Clearance { least: 1.0 };
        assert!(passes(&filter, &[[5.0, 0.0, 2.0, 0.0], [-4.0, -4.0, 4.0, 4.0]]));
        assert!(!passes(&filter, &[[4.5, 0.0, 2.0, 0.0]]));
        assert!(!passes(&filter, &[[6.0, 0.0, 2.0, 0.0]]), "it crosses");
    }
}
