//! `fish-weir`: the leader, heart and pot of the classical fish trap, which start as drawings of unit size and are put in
//! place by rules: the leader is lengthened and the heart moved to its end and widened (modifications), then the pot is
//! added at the far side of the heart.

use super::lines;
use crate::Expression;
use crate::draws::Distribution;
use crate::geometry::Units;
use crate::grammar::{Axiom, Grammar, Item, ItemPlace, Kind, Pattern, Rule, RuleKind, ShapeKind};

/// The grammar.
pub fn grammar() -> Grammar {
    // two wings that open towards the leader and turn back, with a gap of 0.3 to the pot
    let heart = &[
        [0.0, 0.15, -0.2, 0.7],
        [-0.2, 0.7, 0.4, 1.0],
        [0.4, 1.0, 1.0, 0.15],
        [0.0, -0.15, -0.2, -0.7],
        [-0.2, -0.7, 0.4, -1.0],
        [0.4, -1.0, 1.0, -0.15],
    ];
    // a round chamber with a throat that points inwards
    let pot = &[
        [0.4, 0.1, 0.0, 0.3],
        [0.4, -0.1, 0.0, -0.3],
        [0.0, 0.3, 0.3, 0.6],
        [0.3, 0.6, 0.8, 0.6],
        [0.8, 0.6, 1.0, 0.0],
        [1.0, 0.0, 0.8, -0.6],
        [0.8, -0.6, 0.3, -0.6],
        [0.3, -0.6, 0.0, -0.3],
    ];
    let mut grammar = Grammar::new("fish-weir", Units::Field);
    grammar.shapes = vec![
        ShapeKind { name: "leader".into(), ..super::wall() },
        lines("heart", Kind::Terminal, heart),
        lines("pot", Kind::Terminal, pot),
    ];
    let drawn = |shape: &str| Axiom { heading: 90.0.into(), label: "drawn".into(), ..Axiom::new(shape, [0.0, 0.0]) };
    grammar.axioms = vec![drawn("leader"), drawn("heart")];
    let pattern =
        |shape: &str, label: &str| Pattern { label: Some(label.into()), shape: shape.into(), ..Pattern::default() };
    let uniform = |name: &str, low: f64, high: f64| (name.to_owned(), Distribution::Uniform(low, high));
    let built = || Some("built".to_owned());
    let size = |name: &str| Some(Expression::from(name));
    let lengthen = Rule {
        left: vec![pattern("leader", "drawn")],
        right: vec![Item { length: size("l"), label: built(), ..Item::default() }],
        variables: vec![uniform("l", 40.0, 80.0)],
        ..Rule::new("lengthen", RuleKind::Modification, "leader")
    };
    // the heart still stands where the leader begins
    let turn_back = Rule {
        left: vec![pattern("leader", "built"), pattern("heart", "drawn")],
        right: vec![
            Item::default(),
            Item { place: ItemPlace::End, scale: size("s"), label: built(), ..Item::default() },
        ],
        variables: vec![uniform("s", 15.0, 25.0)],
        ..Rule::new("turn-back", RuleKind::Modification, "leader")
    };
    let hold = Rule {
        left: vec![pattern("heart", "built")],
        right: vec![Item {
            shape: "pot".into(),
            place: ItemPlace::End,
            turn: Some(0.0.into()),
            scale: size("p"),
            label: built(),
            ..Item::default()
        }],
        relabel: Some("closed".into()),
        variables: vec![uniform("p", 15.0, 30.0)],
        ..Rule::new("hold", RuleKind::Addition, "heart")
    };
    grammar.rules = vec![lengthen, turn_back, hold];
    grammar
}
