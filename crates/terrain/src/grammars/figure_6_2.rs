//! `figure-6-2`: one rule of each kind, on simple shapes. A circle is added to a square, the circle becomes a triangle, the
//! square grows by half. A reconstruction of what the source's figure is for, not of its drawing.

use super::square;
use crate::Expression;
use crate::geometry::{Geometry, Units};
use crate::grammar::{Axiom, Grammar, Item, ItemPlace, Kind, Pattern, Rule, RuleKind, ShapeKind};
use space::Vector;

/// The grammar.
pub fn grammar() -> Grammar {
    let circle = Geometry::Circle { centre: Vector([0.0, 0.0]), radius: 0.5 };
    let triangle = Geometry::Polygon([[0.0, -0.5], [1.0, 0.0], [0.0, 0.5]].map(Vector).to_vec());
    let shape = |name: &str, geometry| ShapeKind { name: name.into(), kind: Kind::Terminal, geometry: vec![geometry] };
    let plain = |shape: &str| Item { shape: shape.into(), ..Item::default() };
    let labelled =
        |label: &str| vec![Pattern { shape: "square".into(), label: Some(label.into()), ..Pattern::default() }];
    let mut grammar = Grammar::new("figure-6-2", Units::Field);
    grammar.shapes = vec![square("square", Kind::Terminal), shape("circle", circle), shape("triangle", triangle)];
    grammar.axioms = vec![Axiom { label: "new".into(), ..Axiom::new("square", [0.0, 0.0]) }];
    grammar.rules = vec![
        Rule {
            left: labelled("new"),
            relabel: Some("small".into()),
            right: vec![Item { place: ItemPlace::At([1.5.into(), 0.0.into()]), ..plain("circle") }],
            ..Rule::new("add", RuleKind::Addition, "square")
        },
        Rule { right: vec![plain("triangle")], ..Rule::new("substitute", RuleKind::Substitution, "circle") },
        Rule {
            left: labelled("small"),
            right: vec![Item {
                scale: Some(Expression::Both('*', Box::new(("left.scale".into(), 1.5.into())))),
                label: Some("large".into()),
                ..Item::default()
            }],
            ..Rule::new("grow", RuleKind::Modification, "square")
        },
    ];
    grammar
}
