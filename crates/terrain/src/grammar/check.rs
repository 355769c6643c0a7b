//! What can be wrong with a grammar, found before it derives anything.

use super::{Axiom, AxiomPlace, Grammar, Item, ItemPlace, Rule, RuleKind};
use crate::TerrainError;
use crate::draws::Distribution;
use crate::expression::{Condition, Expression};
use space::spelling::nearest;
use std::collections::BTreeSet;

/// Most steps of a derivation.
const MOST_STEPS: u32 = 1_000_000;

impl Grammar {
    /// Refuses a grammar whose parts do not fit together.
    ///
    /// # Errors
    /// Names that are given twice or that nothing has, variables that nothing uses, left sides that no shape can have,
    /// weights that are not positive, items at the end of later items, no starting instance.
    pub fn check(&self) -> Result<(), TerrainError> {
        let wrong = |text: String| Err(TerrainError::Grammar(format!("grammar `{}`: {text}", self.name)));
        if let Some(name) = twice(self.shapes.iter().map(|shape| shape.name.as_str())) {
            return wrong(format!("two shapes are called `{name}`"));
        }
        if let Some(name) = twice(self.rules.iter().map(|rule| rule.name.as_str())) {
            return wrong(format!("two rules are called `{name}`"));
        }
        if self.axioms.is_empty() {
            return wrong("there is no axiom to start from".into());
        }
        if !(1..=MOST_STEPS).contains(&self.max_steps) {
            return wrong(format!("max_steps: expected 1 to {MOST_STEPS}, found {}", self.max_steps));
        }
        if let Some(steps) = self.steps.iter().find(|&&steps| steps > self.max_steps) {
            return wrong(format!("steps: {steps} are more than max_steps, which is {}", self.max_steps));
        }
        self.check_axioms().or_else(|error| wrong(error.to_string()))?;
        for rule in &self.rules {
            self.check_rule(rule).or_else(|error| wrong(format!("rule `{}`: {error}", rule.name)))?;
        }
        self.check_use().or_else(|error| wrong(error.to_string()))
    }

    fn check_axioms(&self) -> Result<(), TerrainError> {
        let known: Vec<&str> = self.variables.iter().map(|(name, _)| name.as_str()).collect();
        for (k, (name, distribution)) in self.variables.iter().enumerate() {
            distribution.check(name)?;
            check_names(distribution_names(distribution), &known[..k])?;
        }
        if let Some(name) = twice(known.iter().copied()) {
            return Err(TerrainError::Grammar(format!("two variables are called `{name}`")));
        }
        for axiom in &self.axioms {
            self.shape(&axiom.shape)?;
            check_names(axiom_expressions(axiom).flat_map(expression_names), &known)?;
        }
        Ok(())
    }

    fn check_rule(&self, rule: &Rule) -> Result<(), TerrainError> {
        let wrong = |text: String| Err(TerrainError::Grammar(text));
        if !(rule.weight > 0.0 && rule.weight.is_finite()) {
            return Err(TerrainError::range("weight", "a finite number above 0", rule.weight));
        }
        if rule.left.is_empty() {
            return wrong("the left side is empty".into());
        }
        for pattern in &rule.left {
            self.shape(&pattern.shape)?;
            if let Some(label) = pattern.label.as_deref().filter(|label| !self.labels(&pattern.shape).contains(label)) {
                return wrong(format!("no `{}` ever has the label \"{label}\"", pattern.shape));
            }
        }
        if rule.kind == RuleKind::Modification && rule.right.len() > rule.left.len() {
            let (right, left) = (rule.right.len(), rule.left.len());
            return wrong(format!("{right} changes for {left} matched shapes"));
        }
        if let Some(name) = twice(rule.variables.iter().map(|(name, _)| name.as_str())) {
            return wrong(format!("two variables are called `{name}`"));
        }
        let mut known: Vec<&str> = self.variables.iter().map(|(name, _)| name.as_str()).collect();
        known.extend(["level", "left.length", "left.scale", "left.level"]);
        let attributes: Vec<String> = self.attributes().into_iter().map(|name| format!("left.{name}")).collect();
        known.extend(attributes.iter().map(String::as_str));
        for condition in &rule.when {
            check_names(condition_names(condition), &known)?;
        }
        for (name, distribution) in &rule.variables {
            distribution.check(name)?;
            check_names(distribution_names(distribution), &known)?;
            known.push(name);
        }
        for (k, item) in rule.right.iter().enumerate() {
            if !(item.shape.is_empty() && rule.kind == RuleKind::Modification) {
                self.shape(&item.shape)?;
            }
            if let ItemPlace::EndOf(other) = item.place
                && other >= k
            {
                return wrong(format!("item {k} cannot stand at the end of item {other}, which comes later"));
            }
            check_names(item_expressions(item).flat_map(expression_names), &known)?;
        }
        Ok(())
    }

    /// Refuses variables that nothing uses: most likely a slip of the keys elsewhere.
    fn check_use(&self) -> Result<(), TerrainError> {
        let axioms = self.axioms.iter().flat_map(axiom_expressions);
        let mut everywhere: BTreeSet<String> = axioms.flat_map(expression_names).collect();
        everywhere.extend(self.variables.iter().flat_map(|(_, distribution)| distribution_names(distribution)));
        for rule in &self.rules {
            let mut here: BTreeSet<String> =
                rule.right.iter().flat_map(item_expressions).flat_map(expression_names).collect();
            here.extend(rule.variables.iter().flat_map(|(_, distribution)| distribution_names(distribution)));
            here.extend(rule.when.iter().flat_map(condition_names));
            if let Some((name, _)) = rule.variables.iter().find(|(name, _)| !here.contains(name)) {
                return Err(TerrainError::Grammar(format!(
                    "rule `{}`: the variable `{name}` is never used",
                    rule.name
                )));
            }
            everywhere.append(&mut here);
        }
        match self.variables.iter().find(|(name, _)| !everywhere.contains(name)) {
            Some((name, _)) => Err(TerrainError::Grammar(format!("the variable `{name}` is never used"))),
            None => Ok(()),
        }
    }

    /// The labels that a shape can have.
    fn labels(&self, shape: &str) -> BTreeSet<&str> {
        let mut labels: BTreeSet<&str> =
            self.axioms.iter().filter(|axiom| axiom.shape == shape).map(|axiom| axiom.label.as_str()).collect();
        for rule in &self.rules {
            let is_left = rule.left.first().is_some_and(|first| first.shape == shape);
            labels.extend(rule.relabel.as_deref().filter(|_| is_left));
            for (k, item) in rule.right.iter().enumerate() {
                let kept = item.shape.is_empty() && rule.left.get(k).is_some_and(|pattern| pattern.shape == shape);
                if item.shape == shape || kept {
                    labels.insert(item.label.as_deref().unwrap_or(""));
                }
            }
        }
        labels
    }

    /// The attributes that some rule gives.
    fn attributes(&self) -> BTreeSet<&str> {
        self.rules
            .iter()
            .flat_map(|rule| &rule.right)
            .flat_map(|item| &item.set)
            .map(|(name, _)| name.as_str())
            .collect()
    }
}

/// A name that comes twice.
fn twice<'a>(names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let mut seen = BTreeSet::new();
    let mut names = names;
    names.find(|name| !seen.insert(*name))
}

fn expression_names(expression: &Expression) -> Vec<String> {
    let mut names = Vec::new();
    expression.names(&mut |name| names.push(name.to_owned()));
    names
}

fn condition_names(condition: &Condition) -> Vec<String> {
    let mut names = Vec::new();
    condition.names(&mut |name| names.push(name.to_owned()));
    names
}

fn distribution_names(distribution: &Distribution) -> Vec<String> {
    match distribution {
        Distribution::Value(expression) => expression_names(expression),
        Distribution::Choice(_) | Distribution::Uniform(..) | Distribution::Normal(..) => Vec::new(),
    }
}

fn axiom_expressions(axiom: &Axiom) -> impl Iterator<Item = &Expression> {
    let place = match &axiom.place {
        AxiomPlace::At(point) => point.each_ref(),
        AxiomPlace::Polar { radius, bearing } => [radius, bearing],
    };
    place.into_iter().chain([&axiom.heading, &axiom.length])
}

fn item_expressions(item: &Item) -> impl Iterator<Item = &Expression> {
    let place: &[Expression] = match &item.place {
        ItemPlace::At(point) => point,
        ItemPlace::Origin | ItemPlace::End | ItemPlace::EndOf(_) => &[],
    };
    place.iter().chain(&item.turn).chain(&item.length).chain(&item.scale).chain(item.set.iter().map(|(_, set)| set))
}

fn check_names(names: impl IntoIterator<Item = String>, known: &[&str]) -> Result<(), TerrainError> {
    match names.into_iter().find(|name| !known.contains(&name.as_str())) {
        Some(name) => {
            let nearest = nearest(&name, known.iter().copied()).map(str::to_owned);
            Err(TerrainError::Unknown { kind: "name", name, nearest })
        }
        None => Ok(()),
    }
}
