//! `straight`: one wall made of small steps, the rules of the step-by-step schema as a grammar: 20 steps from anchor 4
//! of the T-junction, each along -x, along -y, or along both (0.1 m an axis).

use super::{item, lines, wall};
use crate::geometry::Units;
use crate::grammar::{Axiom, Grammar, ItemPlace, Kind, Rule, RuleKind};
use std::f64::consts::SQRT_2;

/// Length of a step along an axis, metres.
const STEP: f64 = 0.1;

/// The grammar.
pub fn grammar() -> Grammar {
    // the pointer keeps its heading, along the x axis
    let go = |name: &str, turn: f64, length: f64| Rule {
        right: vec![item("wall", ItemPlace::Origin, turn, length), item("pointer", ItemPlace::EndOf(0), 0.0, 1.0)],
        ..Rule::new(name, RuleKind::Substitution, "pointer")
    };
    let mut grammar = Grammar::new("straight", Units::Metres);
    grammar.steps = vec![20];
    grammar.shapes = vec![wall(), lines("pointer", Kind::NonTerminal, &[[0.0, 0.0, 0.0, 0.0]])];
    grammar.axioms = vec![Axiom::new("pointer", [1.0, 2.0])];
    grammar.rules = vec![go("along-x", 180.0, STEP), go("along-y", 270.0, STEP), go("diagonal", 225.0, STEP * SQRT_2)];
    grammar
}
