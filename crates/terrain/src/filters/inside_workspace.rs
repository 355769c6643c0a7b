//! `inside_workspace`: everything lies inside the boundary of the workspace or on it.

use super::{Filter, FilterCard, Verdict};
use crate::{Construct, Workspace};

/// `inside_workspace`.
#[derive(Clone, Copy, Debug, Default)]
pub struct InsideWorkspace;

impl Filter for InsideWorkspace {
    fn card(&self) -> &'static FilterCard {
        &FilterCard {
            id: "inside_workspace",
            about: "everything lies inside the boundary of the workspace or on it.",
            parameters: &[],
        }
    }
    fn check(&self, construct: &Construct, workspace: &Workspace) -> Verdict {
        let outside = construct.geometry().filter(|geometry| !workspace.holds(geometry)).count();
        Verdict::unless(outside == 0, "part of it lies outside the workspace", outside as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filters::tests::passes;

    #[test]
    fn the_boundary_is_inside() {
        assert!(passes(&InsideWorkspace, &[[-5.0, 0.0, 5.0, 5.0]]));
        assert!(!passes(&InsideWorkspace, &[[0.0, 0.0, 5.1, 0.0]]));
    }
}
