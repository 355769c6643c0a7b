//! `corralling`: a line of walls that bends around the place to be corralled at, by 30 or 60 degrees inwards or 30
//! outwards at each corner. A reconstruction: the source's figure of its rules is missing.

use super::{item, lines, wall};
use crate::Expression;
use crate::draws::Distribution;
use crate::geometry::Units;
use crate::grammar::{Axiom, AxiomPlace, Grammar, Item, ItemPlace, Kind, Pattern, Rule, RuleKind};

/// Name of the marker at the place to be corralled at.
pub const MARKER: &str = "cross";

/// The grammar.
pub fn grammar() -> Grammar {
    let length = || Distribution::Uniform(25.0, 35.0);
    let bend = |name: &str, turn: f64| Rule {
        left: vec![Pattern { shape: "wall".into(), label: Some("tip".into()), ..Pattern::default() }],
        relabel: Some(String::new()),
        right: vec![Item { label: Some("tip".into()), ..item("wall", ItemPlace::End, turn, "l") }],
        variables: vec![("l".into(), length())],
        ..Rule::new(name, RuleKind::Addition, "wall")
    };
    let mut grammar = Grammar::new("corralling", Units::Field);
    grammar.steps = vec![7, 8];
    grammar.shapes = vec![wall(), lines(MARKER, Kind::Marker, &[[-0.5, 0.0, 0.5, 0.0], [0.0, -0.5, 0.0, 0.5]])];
    grammar.variables = vec![("b".into(), Distribution::Uniform(0.0, 360.0)), ("l0".into(), length())];
    grammar.axioms = vec![
        Axiom::new(MARKER, [0.0, 0.0]),
        // the first wall: its middle at distance 30 on bearing b, tangential
        Axiom {
            place: AxiomPlace::Polar { radius: 30.0.into(), bearing: "b".into() },
            middle: true,
            heading: Expression::Both('+', Box::new(("b".into(), 90.0.into()))),
            length: "l0".into(),
            label: "tip".into(),
            ..Axiom::new("wall", [0.0, 0.0])
        },
    ];
    grammar.rules = vec![bend("tighten", 60.0), bend("curve", 30.0), bend("open", -30.0)];
    grammar
}
