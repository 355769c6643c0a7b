//! `self_crossing`: walls may touch, and neither cross nor lie on each other.

use super::{Filter, FilterCard, Verdict};
use crate::arrangement::near_pairs;
use crate::{Construct, Workspace};
use space::segment::Relation;

/// `self_crossing`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SelfCrossing;

impl Filter for SelfCrossing {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "self_crossing",
            about: "walls may touch, and neither cross nor lie on each other.",
            parameters: &[],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let walls = construct.walls();
        let crosses =
            |&(i, j): &(usize, usize)| matches!(walls[i].relation(&walls[j]), Relation::Proper | Relation::Overlap);
        let crossings = near_pairs(&walls).into_iter().filter(crosses).count();
        Verdict::unless(crossings == 0, "walls cross each other", crossings as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn touching_is_allowed() {
        assert!(passes(&SelfCrossing, &[[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 4.0, 4.0], [2.0, 0.0, 2.0, 2.0]]));
        assert!(!passes(&SelfCrossing, &[[0.0, 0.0, 4.0, 4.0], [0.0, 4.0, 4.0, 0.0]]));
        assert!(!passes(&SelfCrossing, &[[0.0, 0.0, 4.0, 0.0], [3.0, 0.0, 9.0, 0.0]]));
    }
}
