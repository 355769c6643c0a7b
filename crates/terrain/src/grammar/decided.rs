//! A grammar as a schema: its parameters are what a derivation decides.

use super::Grammar;
use crate::draws::{Decisions, Draws};
use crate::schema::{Domain, Parameter, Schema, SchemaCard};
use crate::{Construct, TerrainError, Workspace};

/// A grammar whose derivation is decided by numbers in place of draws, in the order in which it draws: variables, the number of
/// steps, and in each step which rule is applied to what with which variables. So whatever searches numbers searches
/// derivations, and two derivations that are crossed at one point share the drawing up to there.
///
/// A decision among several is made by dividing [0, 1] in shares of their chances; uniform numbers give the derivations that the
/// grammar itself gives. Decisions that a derivation does not come to have no effect; those beyond the last number are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Decided {
    /// The grammar.
    pub grammar: Grammar,
    /// How many decisions are parameters.
    pub decisions: usize,
}

impl Schema for Decided {
    fn card(&self) -> SchemaCard {
        let decision = |k| Parameter {
            name: format!("decision_{k}").into(),
            unit: "1",
            domain: Domain::Range(0.0, 1.0),
            default: 0.5,
            about: "What is decided in place of a draw.",
        };
        SchemaCard {
            id: "grammar",
            about: "A derivation of a grammar, by what it decides.",
            source: "derivations as trees to be varied: section 11 of the specification; that numbers stand for draws is ours",
            version: 1,
            units: Some(self.grammar.units),
            parameters: (1..=self.decisions).map(decision).collect(),
        }
    }
    fn build(&self, values: &[f64], _: &Workspace, draws: &Draws<'_>) -> Result<Construct, TerrainError> {
        let decisions = Decisions::new(values);
        self.grammar.derived(0, 0, &draws.decided(&decisions))?.construct(&self.grammar)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grammars;

    fn corralling() -> Decided {
        let grammar = grammars::find("corralling").unwrap_or_else(|error| unreachable!("{error}"));
        Decided { grammar, decisions: 19 }
    }
    fn made(schema: &Decided, values: &[f64]) -> Construct {
        let workspace = Workspace::empty("none", schema.grammar.units);
        schema.construct(values, &workspace, 3, 0).unwrap_or_else(|error| unreachable!("{error}"))
    }
    fn numbers(key: u64) -> Vec<f64> {
        (0..19).map(|k| Draws::new(key, 0, 0).uniform("number", k)).collect()
    }

    #[test]
    fn decisions_are_all_that_a_derivation_hangs_on() {
        let schema = corralling();
        let values = numbers(5);
        assert_eq!(made(&schema, &values).hash(), made(&schema, &values).hash());
        // bearing and length of the first wall, steps, then rule and length of each wall
        let mut other = values.clone();
        other[18] = 1.0 - other[18];
        let (one, two) = (made(&schema, &values), made(&schema, &other));
        let shared = one.pieces.len().min(two.pieces.len()) - 1;
        assert_eq!(one.pieces[..shared], two.pieces[..shared]);
        let quarter = [0.0, 0.25, 0.5, 0.75].map(|bearing| {
            let mut values = vec![0.5; 19];
            values[0] = bearing;
            made(&schema, &values)
        });
        assert!(quarter.iter().all(|construct| construct.pieces.len() == quarter[0].pieces.len()));
        assert_eq!(quarter[0].provenance.derivation.as_ref().map(|d| d.steps.len() + 1), Some(quarter[0].pieces.len()));
    }

    #[test]
    fn uniform_numbers_give_the_derivations_of_the_grammar() {
        let schema = corralling();
        let rule = |construct: &Construct| {
            construct
                .provenance
                .derivation
                .as_ref()
                .map_or(0, |d| d.steps.iter().filter(|s| s.rule == "tighten").count())
        };
        let decided: usize = (0..400).map(|key| rule(&made(&schema, &numbers(key)))).sum();
        let drawn: usize = (0..400)
            .map(|attempt| rule(&schema.grammar.construct(1, attempt).unwrap_or_else(|error| unreachable!("{error}"))))
            .sum();
        // 400 derivations of 7.5 steps, a third of them: 1000, with a standard deviation of 26 each
        assert!(decided.abs_diff(1000) < 110 && drawn.abs_diff(1000) < 110, "{decided} {drawn}");
    }

    #[test]
    fn numbers_beyond_the_unit_interval_and_other_units_are_refused() {
        let schema = corralling();
        let workspace = Workspace::empty("none", schema.grammar.units);
        assert!(schema.construct(&[2.0; 19], &workspace, 3, 0).is_err());
        assert!(schema.construct(&[0.5; 18], &workspace, 3, 0).is_err());
        let metres = Workspace::empty("none", crate::Units::Metres);
        assert!(matches!(schema.construct(&[0.5; 19], &metres, 3, 0), Err(TerrainError::Units { .. })));
    }
}
