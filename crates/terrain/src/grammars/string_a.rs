//! `string-a`: A -> A a and A -> a with equal weights, the source's example of a grammar for strings, drawn as walls of
//! length 1 in a row. The number of walls is geometric with mean 2.

use super::{item, square, wall};
use crate::geometry::Units;
use crate::grammar::{Axiom, Grammar, ItemPlace, Kind, Rule, RuleKind, ShapeKind};

/// The grammar.
pub fn grammar() -> Grammar {
    let more = vec![item("a", ItemPlace::Origin, 0.0, 1.0), item("A", ItemPlace::EndOf(0), 0.0, 1.0)];
    let last = vec![item("a", ItemPlace::Origin, 0.0, 1.0)];
    let mut grammar = Grammar::new("string-a", Units::Field);
    grammar.shapes = vec![ShapeKind { name: "a".into(), ..wall() }, square("A", Kind::NonTerminal)];
    grammar.axioms = vec![Axiom::new("A", [0.0, 0.0])];
    grammar.rules = vec![
        Rule { right: more, ..Rule::new("more", RuleKind::Substitution, "A") },
        Rule { right: last, ..Rule::new("last", RuleKind::Substitution, "A") },
    ];
    grammar
}
