//! `joint_angle`: two walls that share an end open at least so far between them.

use super::{Filter, FilterCard, Verdict};
use crate::arrangement::near_pairs;
use crate::{Construct, Workspace};
use space::segment::same;

/// `joint_angle`.
#[derive(Clone, Copy, Debug)]
pub struct JointAngle {
    /// Least angle of a joint, degrees.
    pub least: f64,
}

impl Default for JointAngle {
    fn default() -> Self {
        Self { least: 30.0 }
    }
}

impl Filter for JointAngle {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "joint_angle",
            about: "two walls that share an end open at least so far between them.",
            parameters: &[("least", "Least angle of a joint, degrees.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let walls = construct.walls();
        let mut sharpest = 180.0f64;
        for (i, j) in near_pairs(&walls) {
            for (a, b) in [(walls[i].from, walls[i].to), (walls[i].to, walls[i].from)] {
                for (c, d) in [(walls[j].from, walls[j].to), (walls[j].to, walls[j].from)] {
                    if same(a, c) && !same(a, b) && !same(c, d) {
                        sharpest = sharpest.min((b - a).angle_to(d - c).to_degrees());
                    }
                }
            }
        }
        // an angle just at the limit is not to fail by rounding
        Verdict::unless(sharpest >= self.least - 1e-9, "a joint is too sharp", sharpest)
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
    fn the_sharpest_joint_counts() {
        let filter = JointAngle { least: 45.0 };
        assert!(passes(&filter, &[[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 0.0, 4.0]]));
        assert!(!passes(&filter, &[[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 0.0, 1.0]]));
        assert!(passes(&filter, &[[0.0, 0.0, 4.0, 0.0], [2.0, 0.0, 4.0, 0.1]]), "no common end");
    }
}
