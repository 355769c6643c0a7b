//! `material`: the walls together are no longer than the limit; equal is allowed.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `material`.
#[derive(Clone, Copy, Debug)]
pub struct Material {
    /// Length of wall there is.
    pub limit: f64,
}

impl Default for Material {
    fn default() -> Self {
        Self { limit: 100.0 }
    }
}

impl Filter for Material {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "material",
            about: "the walls together are no longer than the limit; equal is allowed.",
            parameters: &[("limit", "Length of wall there is.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let length = construct.material();
        Verdict::unless(length <= self.limit, "more wall than there is", length)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        match name {
            "limit" => Some(&mut self.limit),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn equal_is_allowed() {
        let fence = [[0.0, 0.0, 60.0, 0.0], [0.0, 0.0, 0.0, 40.0]];
        assert!(passes(&Material { limit: 100.0 }, &fence));
        assert!(!passes(&Material { limit: 99.999 }, &fence));
    }
}
