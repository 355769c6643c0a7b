//! `gap`: walls of different terminals that do not meet leave a gap of some width.

use super::walls_by_piece;
use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `gap`.
#[derive(Clone, Copy, Debug)]
pub struct Gap {
    /// Least width of a gap.
    pub least: f64,
}

impl Default for Gap {
    fn default() -> Self {
        Self { least: 1.0 }
    }
}

impl Filter for Gap {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "gap",
            about: "walls of different terminals that do not meet leave a gap of some width.",
            parameters: &[("least", "Least width of a gap.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let (walls, pieces) = walls_by_piece(construct);
        let mut narrowest = f64::MAX;
        for i in 0..walls.len() {
            for j in (i + 1..walls.len()).filter(|&j| pieces[i] != pieces[j]) {
                let gap = walls[i].distance_to(&walls[j]);
                if gap > 0.0 && gap < narrowest {
                    narrowest = gap;
                }
            }
        }
        Verdict::unless(narrowest >= self.least, "a gap is too narrow", narrowest)
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
    fn walls_that_meet_leave_no_gap() {
        let filter = Gap { least: 1.0 };
        assert!(passes(&filter, &[[0.0, 0.0, 4.0, 0.0], [4.0, 0.0, 4.0, 3.0], [0.0, 1.0, 3.0, 1.0]]));
        assert!(!passes(&filter, &[[0.0, 0.0, 4.0, 0.0], [0.0, 0.5, 4.0, 3.0]]));
    }
}
