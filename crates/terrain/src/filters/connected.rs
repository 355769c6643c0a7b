//! `connected`: all walls hang together.

use super::{Filter, FilterCard, Verdict};
use crate::arrangement::near_pairs;
use crate::{Construct, Workspace};
use space::segment::Relation;

/// `connected`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Connected;

impl Filter for Connected {
    fn card(&self) -> &'static FilterCard {
        &FilterCard { id: "connected", about: "all walls hang together.", parameters: &[] }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let walls = construct.walls();
        let pairs = near_pairs(&walls);
        let mut part: Vec<usize> = (0..walls.len()).collect();
        for (i, j) in pairs.into_iter().filter(|&(i, j)| walls[i].relation(&walls[j]) != Relation::Apart) {
            let (kept, lost) = (part[i].min(part[j]), part[i].max(part[j]));
            part.iter_mut().filter(|part| **part == lost).for_each(|part| *part = kept);
        }
        let parts = (0..walls.len()).filter(|&k| part[k] == k).count();
        Verdict::unless(parts <= 1, "it falls into parts", parts as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn a_wall_apart_is_seen() {
        assert!(passes(&Connected, &[[0.0, 0.0, 4.0, 0.0], [2.0, -1.0, 2.0, 1.0], [2.0, 1.0, 3.0, 1.0]]));
        assert!(!passes(&Connected, &[[0.0, 0.0, 4.0, 0.0], [0.0, 1.0, 4.0, 1.0]]));
    }
}
