//! `count`: the number of terminals is within bounds.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `count`.
#[derive(Clone, Copy, Debug)]
pub struct Count {
    /// Least number of terminals.
    pub least: f64,
    /// Greatest number of terminals.
    pub most: f64,
}

impl Default for Count {
    fn default() -> Self {
        Self { least: 0.0, most: 100.0 }
    }
}

impl Filter for Count {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "count",
            about: "the number of terminals is within bounds.",
            parameters: &[("least", "Least number of terminals."), ("most", "Greatest number of terminals.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let count = construct.pieces.len() as f64;
        let reason = if count < self.least { "too few terminals" } else { "too many terminals" };
        Verdict::unless((self.least..=self.most).contains(&count), reason, count)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        match name {
            "least" => Some(&mut self.least),
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
    fn bounds_are_allowed() {
        let filter = Count { least: 1.0, most: 2.0 };
        let passing: Vec<usize> = (0..4).filter(|&n| passes(&filter, &vec![[0.0, 0.0, 1.0, 0.0]; n])).collect();
        assert_eq!(passing, [1, 2]);
    }
}
