//! `wall_length`: no single wall is longer than the limit.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};
use space::Segment;

/// `wall_length`.
#[derive(Clone, Copy, Debug)]
pub struct WallLength {
    /// Greatest length of a wall.
    pub most: f64,
}

impl Default for WallLength {
    fn default() -> Self {
        Self { most: 10.0 }
    }
}

impl Filter for WallLength {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "wall_length",
            about: "no single wall is longer than the limit.",
            parameters: &[("most", "Greatest length of a wall.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let longest = construct.walls().iter().map(Segment::length).fold(0.0, f64::max);
        Verdict::unless(longest <= self.most, "a wall is too long", longest)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        match name {
            "most" => Some(&mut self.most),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn the_longest_counts() {
        let filter = WallLength { most: 3.0 };
        assert!(passes(&filter, &[[0.0, 0.0, 3.0, 0.0], [0.0, 0.0, 0.0, 1.0]]));
        assert!(!passes(&filter, &[[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 3.5]]));
    }
}
