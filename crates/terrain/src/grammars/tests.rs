//! What holds of the shipped grammars.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::filters::{Corralling, Filter, Splitting};
use crate::geometry::Units;
use crate::grammar::{OnLimit, Pattern, Pick, Rule, RuleKind};
use crate::{Derivation, workspaces};

/// Share of candidates that pass a filter, in a sample.
fn share(grammar: &Grammar, filter: &dyn Filter, count: u64) -> f64 {
    let field = workspaces::field(None);
    let passes = |attempt: &u64| filter.check(&grammar.construct(1, *attempt).unwrap(), &field).pass;
    (0..count).filter(passes).count() as f64 / count as f64
}

#[test]
fn every_grammar_is_sound_finished_and_replayed() {
    for name in LIST {
        let grammar = find(name).unwrap();
        assert_eq!(grammar.name, *name);
        grammar.check().unwrap();
        for attempt in 0..20 {
            let derivation = grammar.derive(9, attempt).unwrap();
            assert_eq!(grammar.derive(9, attempt).unwrap(), derivation);
            assert_eq!(grammar.replay(&derivation.steps, &derivation).unwrap(), derivation, "{name}");
            let construct = derivation.clone().construct(&grammar).unwrap();
            assert!(!construct.pieces.is_empty(), "{name}");
            assert!(construct.walls().iter().all(|wall| wall.exact()));
            assert_eq!(grammar.construct(9, attempt).unwrap().hash(), construct.hash());
        }
        assert_ne!(grammar.derive(9, 1).unwrap(), grammar.derive(10, 1).unwrap());
    }
    assert!(find("spliting").unwrap_err().to_string().contains("did you mean `splitting`"));
}

#[test]
fn the_drawing_grows_step_by_step() {
    let grammar = corralling::grammar();
    let derivation = grammar.derive(3, 0).unwrap();
    let walls = |step: usize| derivation.after(step).filter(|instance| instance.shape == 0).count();
    let steps = derivation.steps.len();
    assert!([7, 8].contains(&steps));
    assert_eq!((0..=steps).map(walls).collect::<Vec<_>>(), (1..=steps + 1).collect::<Vec<_>>());
    // each wall begins where the one before it ends
    let last: Vec<_> = derivation.after(steps).filter(|instance| instance.shape == 0).collect();
    let joined = last.windows(2).filter(|two| (two[1].pose.at - two[0].end()).length() < 1e-9).count();
    assert_eq!(joined, steps);
    assert_eq!(last.iter().filter(|instance| instance.label == "tip").count(), 1);
    let first = derivation.after(0).find(|instance| instance.shape == 0).unwrap();
    let middle = (first.pose.at + first.end()) / 2.0;
    assert!((middle.length() - 30.0).abs() < 1e-9 && middle.dot(first.end() - first.pose.at).abs() < 1e-9);
}

/// G-7.1a.
#[test]
fn the_splitting_filter_passes_what_its_formula_says() {
    let tuned = splitting::pass_probability([0.327, 0.323, 0.350]).unwrap();
    assert!((tuned - 0.53695).abs() < 1e-12 && (tuned - 0.537).abs() < 0.001);
    assert!((splitting::pass_probability([2.0; 3]).unwrap() - 5.0 / 9.0).abs() < 1e-15);
    assert!(splitting::pass_probability([0.0, -1.0, 2.0]).is_err() && splitting::pass_probability([0.0; 3]).is_err());
    for (grammar, exact) in [(splitting::grammar(), tuned), (splitting_equal::grammar(), 5.0 / 9.0)] {
        let sampled = share(&grammar, &Splitting::default(), 10_000);
        let error = (exact * (1.0 - exact) / 10_000.0f64).sqrt();
        assert!((sampled - exact).abs() < 3.0 * error, "{}: {sampled}, exactly {exact}", grammar.name);
    }
}

/// G-7.1b.
#[test]
fn about_half_of_the_corrals_pass() {
    let share = share(&corralling::grammar(), &Corralling, 2000);
    assert!((0.46..=0.55).contains(&share), "{share}");
}

#[test]
fn strings_are_as_long_as_a_geometric_variable() {
    let grammar = string_a::grammar();
    let mut counts = [0.0; 5];
    let samples = 4000;
    for attempt in 0..samples {
        let length = grammar.construct(2, attempt).unwrap().pieces.len();
        counts[(length - 1).min(4)] += 1.0;
    }
    let expected = [0.5, 0.25, 0.125, 0.0625, 0.0625].map(|p: f64| p * samples as f64);
    let chi: f64 = counts.iter().zip(expected).map(|(found, expected)| (found - expected).powi(2) / expected).sum();
    assert!(chi < 13.28, "chi-square {chi} with 4 degrees of freedom, p < 0.01: {counts:?}");
}

#[test]
fn rules_of_each_kind() {
    let grammar = figure_6_2::grammar();
    for attempt in 0..5 {
        let derivation = grammar.derive(1, attempt).unwrap();
        assert_eq!(derivation.steps.len(), 3);
        let construct = derivation.construct(&grammar).unwrap();
        let mut names: Vec<_> = construct.pieces.iter().map(|piece| piece.name.as_str()).collect();
        names.sort_unstable();
        assert_eq!(names, ["square", "triangle"]);
        let square = construct.pieces.iter().find(|piece| piece.name == "square").unwrap();
        assert_eq!(square.geometry[0].length(), 6.0, "half as large again");
    }
    let weir = fish_weir::grammar().construct(4, 0).unwrap();
    let heart = weir.pieces.iter().find(|piece| piece.name == "heart").unwrap().geometry[0].points()[0];
    let leader = weir.pieces.iter().find(|piece| piece.name == "leader").unwrap().geometry[0].points()[1];
    assert!((heart[1] - leader[1]).abs() < 1e-9 && leader[1] >= 40.0, "the heart stands where the leader ends");
}

#[test]
fn straight_walls_go_towards_their_quadrant() {
    let construct = straight::grammar().construct(1, 0).unwrap();
    assert_eq!((construct.units, construct.pieces.len()), (Units::Metres, 20));
    let steps: Vec<_> = construct.walls().iter().map(|wall| wall.to - wall.from).collect();
    assert!(steps.iter().all(|step| step[0] < 1e-12 && step[1] < 1e-12 && step.length() < 0.1415));
}

#[test]
fn limits_drop_or_reject() {
    let mut grammar = string_a::grammar();
    grammar.rules.truncate(1);
    grammar.max_steps = 5;
    grammar.check().unwrap();
    let cut = grammar.construct(0, 0).unwrap();
    assert_eq!((cut.pieces.len(), cut.provenance.derivation.unwrap().finished), (5, false));
    grammar.on_limit = OnLimit::Reject;
    assert_eq!(grammar.construct(0, 0), Err(crate::TerrainError::Unfinished));
}

#[test]
fn left_sides_of_several_shapes_match_turned_scaled_and_mirrored() {
    // an L of two walls: the second begins at (2, 1) in the frame of the first, a quarter turn to the left
    let corner = |scale_free: bool, mirror: bool| {
        let mut grammar = Grammar::new("corner", Units::Field);
        grammar.shapes = vec![wall(), square("mark", Kind::Terminal)];
        grammar.rules = vec![Rule {
            left: vec![
                Pattern { shape: "wall".into(), label: Some("a".into()), ..Pattern::default() },
                Pattern { shape: "wall".into(), label: Some("b".into()), at: [2.0, 1.0], turn: 90.0 },
            ],
            right: vec![Item {
                place: ItemPlace::At([2.0.into(), 1.0.into()]),
                ..item("mark", ItemPlace::Origin, 10.0, 1.0)
            }],
            relabel: Some("done".into()),
            scale_free,
            mirror,
            ..Rule::new("corner", RuleKind::Addition, "wall")
        }];
        grammar
    };
    let axiom = |at, heading: f64, label: &str| crate::grammar::Axiom {
        heading: heading.into(),
        label: label.into(),
        ..crate::grammar::Axiom::new("wall", at)
    };
    let marks = |mut grammar: Grammar, axioms: Vec<crate::grammar::Axiom>| -> Derivation {
        grammar.axioms = axioms;
        grammar.check().unwrap();
        grammar.derive(0, 0).unwrap()
    };
    let turned = vec![axiom([5.0, 5.0], 90.0, "a"), axiom([4.0, 7.0], 180.0, "b")];
    let found = marks(corner(false, false), turned.clone());
    assert_eq!(found.steps.len(), 1);
    let mark = found.instances.last().unwrap();
    assert!((mark.pose.at - space::Vector([4.0, 7.0])).length() < 1e-12 && mark.pose.heading == 100.0);
    let shifted = vec![turned[0].clone(), axiom([4.0, 7.0 + 1e-5], 180.0, "b")];
    assert_eq!(marks(corner(false, false), shifted).steps.len(), 0);
    let scaled = vec![axiom([0.0, 0.0], 0.0, "a"), axiom([6.0, 3.0], 90.0, "b")];
    assert_eq!(marks(corner(false, false), scaled.clone()).steps.len(), 0);
    assert_eq!(marks(corner(true, false), scaled).steps.len(), 1);
    let mirrored = vec![axiom([0.0, 0.0], 0.0, "a"), axiom([2.0, -1.0], -90.0, "b")];
    assert_eq!(marks(corner(false, false), mirrored.clone()).steps.len(), 0);
    let found = marks(corner(false, true), mirrored);
    assert!(found.steps[0].mirrored && found.instances.last().unwrap().pose.heading == -10.0);
}

#[test]
fn rules_can_be_picked_first_and_conditions_count() {
    let mut grammar = string_a::grammar();
    grammar.pick = Pick::RuleFirst;
    grammar.rules[0].when = vec![crate::expression::Condition::parse("count(\"a\") < 3").unwrap()];
    grammar.rules[1].when = vec![crate::expression::Condition::parse("level >= 3").unwrap()];
    grammar.check().unwrap();
    for attempt in 0..5 {
        assert_eq!(grammar.construct(0, attempt).unwrap().pieces.len(), 4);
    }
}

#[test]
fn what_is_wrong_with_a_grammar_is_named() {
    let wrong = |change: &dyn Fn(&mut Grammar)| {
        let mut grammar = corralling::grammar();
        change(&mut grammar);
        grammar.check().unwrap_err().to_string()
    };
    assert!(wrong(&|g| g.rules[0].weight = 0.0).contains("rule `tighten`: weight: expected a finite number above 0"));
    assert!(wrong(&|g| g.rules[0].left[0].shape = "wal".into()).contains("did you mean `wall`"));
    assert!(wrong(&|g| g.rules[0].left[0].label = Some("top".into())).contains("no `wall` ever has the label \"top\""));
    assert!(wrong(&|g| g.rules[0].right[0].length = Some("ll".into())).contains("unknown name `ll`"));
    assert!(wrong(&|g| g.rules[0].right[0].length = None).contains("`l` is never used"));
    assert!(wrong(&|g| g.rules[0].right[0].place = ItemPlace::EndOf(0)).contains("comes later"));
    assert!(wrong(&|g| g.axioms.clear()).contains("no axiom"));
    assert!(wrong(&|g| g.steps = vec![2000]).contains("max_steps"));
    assert!(wrong(&|g| g.variables[0].1 = crate::Distribution::Choice(vec![])).contains("at least one"));
    assert!(wrong(&|g| g.variables[0].1 = crate::Distribution::Uniform(2.0, 1.0)).contains("upper bound"));
    assert!(wrong(&|g| g.rules[1].name = "tighten".into()).contains("two rules"));
    let divided = "1 / (l - l)";
    let grammar = {
        let mut grammar = corralling::grammar();
        grammar.rules.truncate(1);
        grammar.rules[0].right[0].length = Some(Expression::parse(divided).unwrap());
        grammar
    };
    grammar.check().unwrap();
    assert!(grammar.derive(0, 0).unwrap_err().to_string().contains("finite"));
}
