//! Feasibility filters: one file each, one line each in the list below. A filter looks at a construct alone, before any
//! group is simulated in it.

use crate::{Construct, TerrainError, Workspace};
use space::Segment;

/// What a filter says of a construct.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// Whether the construct is feasible.
    pub pass: bool,
    /// Why not, in a few words; the same words for the same reason, so that reasons can be counted. Empty where it passes.
    pub reason: &'static str,
    /// The number that decided.
    pub measure: f64,
}

impl Verdict {
    /// It passes.
    pub fn pass(measure: f64) -> Self {
        Self { pass: true, reason: "", measure }
    }
    /// It passes where a condition holds, and fails for this reason otherwise.
    pub fn unless(holds: bool, reason: &'static str, measure: f64) -> Self {
        if holds { Self::pass(measure) } else { Self { pass: false, reason, measure } }
    }
}

/// A filter's description of itself.
#[derive(Clone, Copy, Debug)]
pub struct FilterCard {
    /// Name in files.
    pub id: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// The numbers it takes: name and sentence.
    pub parameters: &'static [(&'static str, &'static str)],
}

/// A condition of feasibility.
pub trait Filter: Send + Sync {
    /// Its description of itself.
    fn card(&self) -> &'static FilterCard;
    /// What it says of a construct that is to be placed in a workspace.
    fn check(&self, construct: &Construct, workspace: &Workspace) -> Verdict;
    /// The place of a parameter of the card, to be changed; `None` for any other name.
    fn parameter(&mut self, name: &str) -> Option<&mut f64> {
        let _ = name;
        None
    }
}

macro_rules! filters {
    ($($file:ident::$name:ident;)*) => {
        $(mod $file; pub use $file::$name;)*
        /// All filters with their parameters at the defaults, in the order of the list.
        pub fn all() -> Vec<Box<dyn Filter>> {
            vec![$(Box::new($name::default())),*]
        }
    };
}

filters! {
    splitting::Splitting;
    corralling::Corralling;
    material::Material;
    count::Count;
    wall_length::WallLength;
    bounding_box::BoundingBox;
    inside_workspace::InsideWorkspace;
    gap::Gap;
    self_crossing::SelfCrossing;
    clearance::Clearance;
    connected::Connected;
    joint_angle::JointAngle;
}

/// The filter of an id, with its parameters changed as given.
///
/// # Errors
/// Where no filter has this id, the filter has no such parameter, or a value is not a finite number.
pub fn find(id: &str, parameters: &[(&str, f64)]) -> Result<Box<dyn Filter>, TerrainError> {
    let Some(mut filter) = all().into_iter().find(|filter| filter.card().id == id) else {
        return Err(TerrainError::unknown("filter", id, all().iter().map(|filter| filter.card().id)));
    };
    for &(name, value) in parameters {
        if !value.is_finite() {
            return Err(TerrainError::range(name, "a finite number", value));
        }
        let known = filter.card().parameters.iter().map(|(known, _)| *known);
        match filter.parameter(name) {
            Some(place) => *place = value,
            None => return Err(TerrainError::unknown("parameter", name, known)),
        }
    }
    Ok(filter)
}

/// Filters put together.
pub enum Combined {
    /// A single one.
    One(Box<dyn Filter>),
    /// All must pass; the first that does not gives the reason.
    All(Vec<Combined>),
    /// One must pass; where none does, the last gives the reason.
    Any(Vec<Combined>),
    /// It must not pass.
    Not(Box<Combined>),
}

impl Combined {
    /// What they say of a construct.
    pub fn check(&self, construct: &Construct, workspace: &Workspace) -> Verdict {
        match self {
            Self::One(filter) => filter.check(construct, workspace),
            Self::All(filters) => {
                let mut verdicts = filters.iter().map(|filter| filter.check(construct, workspace));
                verdicts.find(|verdict| !verdict.pass).unwrap_or(Verdict::pass(filters.len() as f64))
            }
            Self::Any(filters) => {
                let mut last = Verdict { pass: false, reason: "no alternative is given", measure: 0.0 };
                for filter in filters {
                    last = filter.check(construct, workspace);
                    if last.pass {
                        break;
                    }
                }
                last
            }
            Self::Not(filter) => {
                let verdict = filter.check(construct, workspace);
                Verdict::unless(!verdict.pass, "passes a filter that it must not pass", verdict.measure)
            }
        }
    }
}

/// The walls of each piece, with the index of the piece.
fn walls_by_piece(construct: &Construct) -> (Vec<Segment>, Vec<usize>) {
    let pieces = construct.pieces.iter().enumerate();
    let walls = pieces
        .flat_map(|(k, piece)| piece.geometry.iter().flat_map(crate::Geometry::segments).map(move |wall| (wall, k)));
    walls.unzip()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use crate::geometry::Units;
    use crate::workspaces;

    pub(super) fn construct(walls: &[[f64; 4]]) -> Construct {
        let segment = |&[x0, y0, x1, y1]: &[f64; 4]| Segment::new([x0, y0], [x1, y1]);
        Construct::of_walls(Units::Metres, walls.iter().map(segment))
    }
    /// Whether each of these constructs passes in a 10 x 10 arena.
    pub(super) fn passes(filter: &dyn Filter, walls: &[[f64; 4]]) -> bool {
        filter.check(&construct(walls), &workspaces::arena(10.0)).pass
    }

    #[test]
    fn every_filter_has_its_parameters_and_takes_degenerate_constructs() {
        let arena = workspaces::arena(10.0);
        for mut filter in all() {
            let card = filter.card();
            for (name, _) in card.parameters {
                assert!(filter.parameter(name).is_some(), "{} {name}", card.id);
            }
            assert!(filter.parameter("no such").is_none());
            for walls in
                [&[][..], &[[1.0; 4]], &[[1.0; 4], [1.0; 4]], &[[0.0, 0.0, 1e300, 1e300], [0.0, 0.0, 1.0, 1.0]]]
            {
                let verdict = filter.check(&construct(walls), &arena);
                assert_eq!(verdict.pass, verdict.reason.is_empty(), "{}", card.id);
                assert!(!verdict.measure.is_nan(), "{} {walls:?}", card.id);
            }
        }
        assert!(find("materiel", &[]).err().unwrap().to_string().contains("did you mean `material`"));
        assert!(find("material", &[("limt", 1.0)]).err().unwrap().to_string().contains("did you mean `limit`"));
        assert!(find("material", &[("limit", f64::NAN)]).is_err());
    }

    #[test]
    fn filters_combine() {
        let arena = workspaces::arena(10.0);
        let one = |limit: f64| Combined::One(find("material", &[("limit", limit)]).unwrap());
        let three = construct(&[[0.0, 0.0, 3.0, 0.0]]);
        let pass = |filter: Combined| filter.check(&three, &arena).pass;
        assert!(pass(Combined::All(vec![one(3.0), one(4.0)])) && pass(Combined::All(vec![])));
        assert!(!pass(Combined::All(vec![one(3.0), one(2.0)])));
        assert!(pass(Combined::Any(vec![one(2.0), one(3.0)])) && !pass(Combined::Any(vec![])));
        assert!(pass(Combined::Not(Box::new(one(2.0)))) && !pass(Combined::Not(Box::new(one(3.0)))));
    }
}
