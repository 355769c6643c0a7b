//! `bounding_box`: the box around the construct, along the axes, is within limits.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `bounding_box`.
#[derive(Clone, Copy, Debug)]
pub struct BoundingBox {
    /// Greatest extent along x.
    pub width: f64,
    /// Greatest extent along y.
    pub height: f64,
}

impl Default for BoundingBox {
    fn default() -> Self {
        Self { width: 100.0, height: 100.0 }
    }
}

impl Filter for BoundingBox {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "bounding_box",
            about: "the box around the construct, along the axes, is within limits.",
            parameters: &[("width", "Greatest extent along x."), ("height", "Greatest extent along y.")],
        }
    }
    fn check(&self, construct: &Construct, _: &Workspace) -> Verdict {
        let Some((low, high)) = construct.bounds() else { return Verdict::pass(0.0) };
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let excess = (width - self.width).max(height - self.height);
        Verdict::unless(excess <= 0.0, "too wide or too high", excess)
    }
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        match name {
            "width" => Some(&mut self.width),
            "height" => Some(&mut self.height),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn both_extents_count() {
        let filter = BoundingBox { width: 4.0, height: 2.0 };
        assert!(passes(&filter, &[[0.0, 0.0, 4.0, 2.0]]));
        assert!(!passes(&filter, &[[0.0, 0.0, 2.0, 4.0]]));
    }
}
