//! `sirt`: a wall made of small steps, each along x, along y, or along both (the source's algorithm 7), and the more
//! general grammars of points that it is a case of.

use super::{anchor, anchor_parameter, towards};
use crate::construct::Piece;
use crate::geometry::{Geometry, Point, along};
use crate::schema::{Domain, Parameter, Schema, SchemaCard, known};
use crate::{Construct, Draws, TerrainError, Workspace};
use space::{Real, Vector};

/// How the points of a pointer become walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Join {
    /// Joined by walls in their order, the anchor first, so that no gap remains.
    #[default]
    Polyline,
    /// A disc each.
    Points,
}

/// A pointer that starts at an anchor and leaves a point wherever it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct PointGrammar {
    /// What a rule adds to the pointer.
    pub moves: Vec<Point>,
    /// How likely each rule is.
    pub weights: Vec<f64>,
    /// With a radius, the rules are left aside: each next point is uniform in the disc of this radius about the pointer.
    pub within: Option<f64>,
    /// One more than the number of points: the source counts from 1 to k - 1, and does not put down the anchor.
    pub k: usize,
}

impl PointGrammar {
    /// The points of one derivation.
    pub fn points(&self, anchor: Point, draws: &Draws) -> Vec<Point> {
        let mut pointer = anchor;
        let step = |i: usize| {
            let draws = draws.at(i as u64);
            match self.within {
                Some(radius) => {
                    let distance = radius * draws.uniform("distance", 0).root();
                    pointer = towards(pointer, 360.0 * draws.uniform("direction", 0), distance);
                }
                None => {
                    let rule = draws.weighted("rule", &self.weights);
                    pointer += rule.and_then(|rule| self.moves.get(rule)).copied().unwrap_or(Vector::ZERO);
                }
            }
            pointer
        };
        (1..self.k).map(step).collect()
    }
}

/// The three rules of `sirt`, in order: along x, along y, along both.
pub fn moves(x_step: f64, y_step: f64) -> [Point; 3] {
    [Vector([x_step, 0.0]), Vector([0.0, y_step]), Vector([x_step, y_step])]
}

/// The points of given rules (1, 2 or 3) from an anchor.
///
/// # Errors
/// A rule that is none of the three.
pub fn points(anchor: Point, x_step: f64, y_step: f64, rules: &[u64]) -> Result<Vec<Point>, TerrainError> {
    let moves = moves(x_step, y_step);
    let mut pointer = anchor;
    let step = |&rule: &u64| match usize::try_from(rule).ok().and_then(|rule| moves.get(rule.checked_sub(1)?)) {
        Some(&by) => {
            pointer += by;
            Ok(pointer)
        }
        None => Err(TerrainError::range("rule", "1, 2 or 3", rule as f64)),
    };
    rules.iter().map(step).collect()
}

/// `sirt`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sirt {
    /// How its points become walls.
    pub join: Join,
}

impl Schema for Sirt {
    fn card(&self) -> SchemaCard {
        let step = |name| {
            let about = "Signed step along this axis.";
            Parameter::new(name, "length", Domain::Range(-10.0, 10.0), -0.1, about)
        };
        let chance = |name, about| Parameter::new(name, "1", Domain::Range(0.0, 1.0), 1.0 / 3.0, about);
        SchemaCard {
            id: "sirt",
            about: "A wall of small steps from an anchor, each along x, along y, or along both.",
            source: "algorithm 7; that steps are signed, and negative from anchor 4, is inferred",
            version: 1,
            units: None,
            parameters: vec![
                chance("p1", "Chance of a step along x."),
                chance("p2", "Chance of a step along y; what is left of 1 is the chance of both."),
                Parameter::new("k", "1", Domain::Whole(1.0, 1e5), 21.0, "One more than the number of points."),
                step("x_res"),
                step("y_res"),
                anchor_parameter(4.0),
            ],
        }
    }
    fn build(&self, values: &[f64], workspace: &Workspace, draws: &Draws) -> Result<Construct, TerrainError> {
        let [p1, p2, k, x_step, y_step, number] = known(values);
        if p1 + p2 > 1.0 + 1e-12 {
            return Err(TerrainError::range("p1 + p2", "at most 1", p1 + p2));
        }
        let anchor = anchor(workspace, number)?;
        let grammar = PointGrammar {
            moves: moves(x_step, y_step).to_vec(),
            weights: vec![p1, p2, (1.0 - p1 - p2).max(0.0)],
            within: None,
            k: k as usize,
        };
        let points = grammar.points(anchor, draws);
        let geometry = match self.join {
            Join::Polyline => along(&[&[anchor], points.as_slice()].concat()),
            Join::Points => {
                let radius = x_step.abs().max(y_step.abs()) / 2.0;
                points.into_iter().map(|centre| Geometry::Disc { centre, radius }).collect()
            }
        };
        let piece = |geometry| Piece { name: "step".into(), geometry: vec![geometry] };
        Ok(Construct::new(workspace.units, geometry.into_iter().map(piece).collect()))
    }
}
