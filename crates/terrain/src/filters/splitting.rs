//! `splitting`: there are at least so many terminals.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `splitting`.
#[derive(Clone, Copy, Debug)]
pub struct Splitting {
    /// Least number of terminals.
    pub least: f64,
}

impl Default for Splitting {
    fn default() -> Self {
        Self { least: 3.0 }
    }
}

impl Filter for Splitting {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "splitting",
            about: "there are at least so many terminals.",
            parameters: &[("least", "Least number of terminals.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let count = construct.pieces.len() as f64;
        Verdict::unless(count >= self.least, "too few walls to split a group", count)
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
    fn three_are_enough() {
        assert!(passes(&Splitting::default(), &[[0.0, 0.0, 1.0, 0.0]; 3]));
        assert!(!passes(&Splitting::default(), &[[0.0, 0.0, 1.0, 0.0]; 2]));
    }
}
