//! `splitting`: a tree of walls that grows away from the approaching group. A reconstruction: the source's figures of
//! its rules are missing, and the weights are those under which its filter passes the published share.

use super::{item, square, wall};
use crate::TerrainError;
use crate::draws::Distribution;
use crate::geometry::Units;
use crate::grammar::{Axiom, Grammar, ItemPlace, Kind, Rule, RuleKind};

/// The weights of the rules `fork`, `extend` and `stop`.
const WEIGHTS: [f64; 3] = [0.327, 0.323, 0.350];

/// The grammar with its calibrated weights.
pub fn grammar() -> Grammar {
    with_weights("splitting", WEIGHTS)
}

/// The grammar with other weights of `fork`, `extend` and `stop`.
pub fn with_weights(name: &str, weights: [f64; 3]) -> Grammar {
    let length = || Distribution::Uniform(20.0, 40.0);
    let fork = Rule {
        right: vec![
            item("wall", ItemPlace::Origin, "a", "l1"),
            item("square", ItemPlace::EndOf(0), "a", 1.0),
            item("wall", ItemPlace::Origin, -super::Expression::from("a"), "l2"),
            item("square", ItemPlace::EndOf(2), -super::Expression::from("a"), 1.0),
        ],
        variables: vec![
            ("a".into(), Distribution::Choice(vec![20.0, 30.0, 45.0])),
            ("l1".into(), length()),
            ("l2".into(), length()),
        ],
        ..Rule::new("fork", RuleKind::Substitution, "square")
    };
    let extend = Rule {
        right: vec![item("wall", ItemPlace::Origin, 0.0, "l1"), item("square", ItemPlace::EndOf(0), 0.0, 1.0)],
        variables: vec![("l1".into(), length())],
        ..Rule::new("extend", RuleKind::Substitution, "square")
    };
    let stop = Rule::new("stop", RuleKind::Substitution, "square");
    let mut grammar = Grammar::new(name, Units::Field);
    grammar.max_steps = 30;
    grammar.shapes = vec![wall(), square("square", Kind::NonTerminal)];
    grammar.axioms = vec![
        Axiom { heading: 90.0.into(), length: 30.0.into(), ..Axiom::new("wall", [0.0, 0.0]) },
        Axiom { heading: 90.0.into(), ..Axiom::new("square", [0.0, 30.0]) },
    ];
    grammar.rules = [fork, extend, stop].into_iter().zip(weights).map(|(rule, weight)| rule.weighing(weight)).collect();
    grammar
}

/// The exact probability that a derivation has at least three walls, for any weights of `fork`, `extend` and `stop`.
///
/// Walls are 1 + 2 forks + extends. Fewer than three are there where the first rule is `stop`, or the first is
/// `extend` and the second `stop`: P = 1 - w_stop (1 + w_extend) in weights whose sum is 1. The limit of steps is far
/// beyond and changes nothing.
///
/// # Errors
/// A weight that is negative or not finite, or weights of which none is positive.
pub fn pass_probability(weights: [f64; 3]) -> Result<f64, TerrainError> {
    for (name, weight) in ["fork", "extend", "stop"].into_iter().zip(weights) {
        if !(weight >= 0.0 && weight.is_finite()) {
            return Err(TerrainError::range(format!("weight of `{name}`"), "a finite number of 0 or more", weight));
        }
    }
    let total: f64 = weights.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return Err(TerrainError::range("sum of the weights", "a finite number above 0", total));
    }
    let [_, extend, stop] = weights.map(|weight| weight / total);
    Ok(1.0 - stop * (1.0 + extend))
}
