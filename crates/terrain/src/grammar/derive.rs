//! One derivation, step by step; its trace; the same again from the trace.

use super::matching::{Match, Seen, matches};
use super::{AxiomPlace, Grammar, Item, ItemPlace, Kind, OnLimit, Pick, Rule, RuleKind};
use crate::construct::{Marker, Piece, Provenance};
use crate::draws::{Distribution, Draws};
use crate::geometry::{Geometry, Point, Pose, sin_cos};
use crate::{Construct, Expression, TerrainError};
use space::Vector;

/// An instance of a shape in a derivation. Those that were removed or changed stay in the list, with the step in
/// which they ended, so that the drawing after any step is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Index of its shape in the grammar.
    pub shape: usize,
    /// Where it stands.
    pub pose: Pose,
    /// Factor of both its axes.
    pub scale: f64,
    /// Factor of its x axis.
    pub length: f64,
    /// Its label; empty for none.
    pub label: String,
    /// Attributes by name.
    pub attributes: Vec<(String, f64)>,
    /// How many rules lie between it and the start.
    pub level: u32,
    /// The step that made it; 0 for the start.
    pub begins: u32,
    /// The step that removed or changed it.
    pub ends: Option<u32>,
}

impl Instance {
    /// The point at the end of its x axis.
    pub fn end(&self) -> Point {
        self.pose.place(Vector([self.length * self.scale, 0.0]))
    }
    /// Whether it is there after a step (0: the start).
    pub fn there(&self, step: u32) -> bool {
        self.begins <= step && self.ends.is_none_or(|end| end > step)
    }
    /// Its geometry.
    pub fn geometry(&self, grammar: &Grammar) -> Vec<Geometry> {
        let stretch = [self.length * self.scale, self.scale];
        let shape = grammar.shapes.get(self.shape).map_or(&[][..], |shape| &shape.geometry);
        shape.iter().map(|geometry| geometry.moved(&self.pose, stretch)).collect()
    }
}

/// One application of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Name of the rule.
    pub rule: String,
    /// Index of each matched instance.
    pub matched: Vec<usize>,
    /// Whether the arrangement was mirrored.
    pub mirrored: bool,
    /// The rule's variables as drawn.
    pub variables: Vec<(String, f64)>,
}

/// A derivation: the steps that were taken, and all instances that ever were.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivation {
    /// Seed of the set of candidates.
    pub seed: u64,
    /// Number of the attempt.
    pub attempt: u64,
    /// The grammar's variables as drawn.
    pub variables: Vec<(String, f64)>,
    /// The steps.
    pub steps: Vec<Step>,
    /// Every instance, in the order of creation.
    pub instances: Vec<Instance>,
    /// Whether it ended by its own rules, and not at the limit.
    pub finished: bool,
}

impl Derivation {
    /// The instances there are after a step (0: the start), in the order of creation.
    pub fn after(&self, step: usize) -> impl Iterator<Item = &Instance> {
        let step = u32::try_from(step).unwrap_or(u32::MAX);
        self.instances.iter().filter(move |instance| instance.there(step))
    }
    /// What it made: terminals built, markers marked, non-terminals left out.
    ///
    /// # Errors
    /// Where it reached its limit, and the grammar rejects such.
    pub fn construct(self, grammar: &Grammar) -> Result<Construct, TerrainError> {
        if !self.finished && grammar.on_limit == OnLimit::Reject {
            return Err(TerrainError::Unfinished);
        }
        let mut construct = Construct::new(grammar.units, Vec::new());
        for instance in self.instances.iter().filter(|instance| instance.ends.is_none()) {
            let Some(shape) = grammar.shapes.get(instance.shape) else { continue };
            let name = shape.name.clone();
            match shape.kind {
                Kind::Terminal => construct.pieces.push(Piece { name, geometry: instance.geometry(grammar) }),
                Kind::Marker => construct.markers.push(Marker { name, pose: instance.pose }),
                Kind::NonTerminal => {}
            }
        }
        construct.provenance = Provenance {
            schema: grammar.name.clone(),
            version: 1,
            parameters: self.variables.clone(),
            seed: self.seed,
            attempt: self.attempt,
            derivation: Some(self),
        };
        Ok(construct)
    }
}

impl Grammar {
    /// Derives the instance of an attempt under a seed. The grammar must have passed [`Grammar::check`].
    ///
    /// # Errors
    /// An expression without a finite value.
    pub fn derive(&self, seed: u64, attempt: u64) -> Result<Derivation, TerrainError> {
        self.derived(seed, attempt, &Draws::new(seed, attempt, 0))
    }

    /// The derivation that these draws give.
    pub(super) fn derived(&self, seed: u64, attempt: u64, draws: &Draws<'_>) -> Result<Derivation, TerrainError> {
        let mut derivation = self.start(seed, attempt, self.draw(&self.variables, draws, &[], None, &[])?)?;
        let wanted = self.steps.get(draws.below("steps", self.steps.len())).copied();
        let limit = wanted.unwrap_or(self.max_steps).min(self.max_steps);
        while (derivation.steps.len() as u32) < limit {
            let number = derivation.steps.len() as u32 + 1;
            let draws = draws.at(u64::from(number));
            let Some((rule, found)) = self.choose(&derivation, &draws)? else {
                derivation.finished = true;
                return Ok(derivation);
            };
            let rule = &self.rules[rule];
            let (known, instances) = (&derivation.variables, &derivation.instances);
            let left = found.instances.first().map(|&first| &instances[first]);
            let variables = self.draw(&rule.variables, &draws, known, left, instances)?;
            self.apply(rule, &found, &variables, &mut derivation)?;
            let Match { instances: matched, mirrored } = found;
            derivation.steps.push(Step { rule: rule.name.clone(), matched, mirrored, variables });
        }
        derivation.finished = wanted.is_some_and(|wanted| wanted <= self.max_steps)
            || self.choose(&derivation, &draws.at(u64::from(limit) + 1))?.is_none();
        Ok(derivation)
    }

    /// Takes the steps of a derivation again, without any draw: the result has the same instances.
    ///
    /// # Errors
    /// A step whose rule or match this grammar does not have.
    pub fn replay(&self, steps: &[Step], of: &Derivation) -> Result<Derivation, TerrainError> {
        let mut derivation = self.start(of.seed, of.attempt, of.variables.clone())?;
        for (k, step) in steps.iter().enumerate() {
            let wrong = |what: &str| TerrainError::Grammar(format!("step {}: {what}", k + 1));
            let Some(rule) = self.rules.iter().find(|rule| rule.name == step.rule) else {
                return Err(wrong(&format!("`{}` has no rule `{}`", self.name, step.rule)));
            };
            let there = |&matched: &usize| derivation.instances.get(matched).is_some_and(|i| i.ends.is_none());
            if step.matched.len() != rule.left.len() || !step.matched.iter().all(there) {
                return Err(wrong("it matches what is not there"));
            }
            let found = Match { instances: step.matched.clone(), mirrored: step.mirrored };
            self.apply(rule, &found, &step.variables, &mut derivation)?;
            derivation.steps.push(step.clone());
        }
        derivation.finished = of.finished && steps.len() == of.steps.len();
        Ok(derivation)
    }

    /// The starting instances.
    fn start(&self, seed: u64, attempt: u64, variables: Vec<(String, f64)>) -> Result<Derivation, TerrainError> {
        let seen = Seen { grammar: self, variables: &variables, left: None, instances: &[] };
        let mut instances = Vec::with_capacity(self.axioms.len());
        for axiom in &self.axioms {
            let (heading, length) = (axiom.heading.value(&seen)?, axiom.length.value(&seen)?);
            let at = match &axiom.place {
                AxiomPlace::At([x, y]) => Vector([x.value(&seen)?, y.value(&seen)?]),
                AxiomPlace::Polar { radius, bearing } => {
                    let (sin, cos) = sin_cos(bearing.value(&seen)?);
                    Vector([cos, sin]) * radius.value(&seen)?
                }
            };
            let back = if axiom.middle { -length / 2.0 } else { 0.0 };
            instances.push(Instance {
                shape: self.shape(&axiom.shape)?,
                pose: Pose { at: Pose { at, heading }.place(Vector([back, 0.0])), heading },
                scale: 1.0,
                length,
                label: axiom.label.clone(),
                attributes: Vec::new(),
                level: 0,
                begins: 0,
                ends: None,
            });
        }
        Ok(Derivation { seed, attempt, variables, steps: Vec::new(), instances, finished: false })
    }

    /// A rule and a match for the next step; `None` where no rule matches.
    fn choose(&self, derivation: &Derivation, draws: &Draws) -> Result<Option<(usize, Match)>, TerrainError> {
        let instances = &derivation.instances;
        let seen = Seen { grammar: self, variables: &derivation.variables, left: None, instances };
        let there: Vec<usize> = (0..instances.len()).filter(|&k| instances[k].ends.is_none()).collect();
        // by instance, then by rule: the matches that begin with it
        let mut all: Vec<(usize, usize, Vec<Match>)> = Vec::new();
        for &first in &there {
            for (k, rule) in self.rules.iter().enumerate() {
                let found = matches(self, rule, first, &seen)?;
                if !found.is_empty() {
                    all.push((first, k, found));
                }
            }
        }
        let weights = |rules: &[usize]| rules.iter().map(|&k| self.rules[k].weight).collect::<Vec<_>>();
        let (rule, mut found): (usize, Vec<Match>) = match self.pick {
            Pick::MatchFirst => {
                let mut matched: Vec<usize> = all.iter().map(|&(first, ..)| first).collect();
                matched.dedup();
                let Some(&first) = matched.get(draws.below("match", matched.len())) else { return Ok(None) };
                all.retain(|&(other, ..)| other == first);
                let rules: Vec<usize> = all.iter().map(|&(_, rule, _)| rule).collect();
                let Some(chosen) = draws.weighted("rule", &weights(&rules)) else { return Ok(None) };
                let (_, rule, found) = all.swap_remove(chosen);
                (rule, found)
            }
            Pick::RuleFirst => {
                let rules: Vec<usize> =
                    (0..self.rules.len()).filter(|&k| all.iter().any(|&(_, rule, _)| rule == k)).collect();
                let Some(chosen) = draws.weighted("rule", &weights(&rules)) else { return Ok(None) };
                let rule = rules[chosen];
                (rule, all.into_iter().filter(|&(_, other, _)| other == rule).flat_map(|(.., found)| found).collect())
            }
        };
        // one instance is chosen already where matches come first: then its arrangements are equally likely
        let name = if self.pick == Pick::MatchFirst { "arrangement" } else { "match" };
        let chosen = draws.below(name, found.len());
        Ok(Some((rule, found.swap_remove(chosen))))
    }

    /// Applies a rule to a match.
    fn apply(
        &self,
        rule: &Rule,
        found: &Match,
        drawn: &[(String, f64)],
        derivation: &mut Derivation,
    ) -> Result<(), TerrainError> {
        let number = derivation.steps.len() as u32 + 1;
        let Some(first) = found.instances.first().map(|&first| derivation.instances[first].clone()) else {
            return Ok(());
        };
        let variables = [derivation.variables.as_slice(), drawn].concat();
        let mut made: Vec<Instance> = Vec::with_capacity(rule.right.len());
        for (k, item) in rule.right.iter().enumerate() {
            let changed = found.instances.get(k).filter(|_| rule.kind == RuleKind::Modification);
            let changed = changed.map(|&matched| &derivation.instances[matched]);
            let seen =
                Seen { grammar: self, variables: &variables, left: Some(&first), instances: &derivation.instances };
            let new = self.make(item, &first, changed, found.mirrored, &made, &seen, number)?;
            made.push(new);
        }
        if rule.kind != RuleKind::Addition {
            let changed = if rule.kind == RuleKind::Modification { rule.right.len() } else { found.instances.len() };
            for &matched in found.instances.iter().take(changed) {
                derivation.instances[matched].ends = Some(number);
            }
        }
        if let (Some(label), Some(&matched)) = (&rule.relabel, found.instances.first())
            && derivation.instances[matched].ends.is_none()
        {
            // a relabelled shape is another instance from here on, so that earlier drawings keep the old label
            derivation.instances[matched].ends = Some(number);
            derivation.instances.push(Instance { label: label.clone(), begins: number, ends: None, ..first });
        }
        derivation.instances.append(&mut made);
        Ok(())
    }

    /// The instance that an item of the right side makes in the frame of the first match, or what it makes of the
    /// matched one that it changes.
    fn make(
        &self,
        item: &Item,
        first: &Instance,
        changed: Option<&Instance>,
        mirrored: bool,
        made: &[Instance],
        seen: &Seen<'_>,
        number: u32,
    ) -> Result<Instance, TerrainError> {
        let hand = if mirrored { -1.0 } else { 1.0 };
        let value = |expression: &Option<Expression>, without: f64| {
            expression.as_ref().map_or(Ok(without), |expression| expression.value(seen))
        };
        let kept = changed.unwrap_or(first);
        let at = match &item.place {
            ItemPlace::Origin => kept.pose.at,
            ItemPlace::End => first.end(),
            ItemPlace::EndOf(k) => made.get(*k).map_or(first.pose.at, Instance::end),
            ItemPlace::At([x, y]) => first.pose.place(Vector([x.value(seen)?, hand * y.value(seen)?]) * first.scale),
        };
        let heading = kept.pose.heading + hand * value(&item.turn, 0.0)?;
        let mut attributes = changed.map(|changed| changed.attributes.clone()).unwrap_or_default();
        for (name, expression) in &item.set {
            let value = expression.value(seen)?;
            match attributes.iter_mut().find(|(known, _)| known == name) {
                Some(known) => known.1 = value,
                None => attributes.push((name.clone(), value)),
            }
        }
        let label = item.label.clone().or_else(|| changed.map(|changed| changed.label.clone()));
        Ok(Instance {
            shape: if item.shape.is_empty() { kept.shape } else { self.shape(&item.shape)? },
            pose: Pose { at, heading },
            scale: value(&item.scale, changed.map_or(1.0, |changed| changed.scale))?,
            length: value(&item.length, changed.map_or(1.0, |changed| changed.length))?,
            label: label.unwrap_or_default(),
            attributes,
            level: first.level + 1,
            begins: number,
            ends: None,
        })
    }

    /// Draws variables one after the other; each may use those before it and those known already.
    fn draw(
        &self,
        variables: &[(String, Distribution)],
        draws: &Draws,
        known: &[(String, f64)],
        left: Option<&Instance>,
        instances: &[Instance],
    ) -> Result<Vec<(String, f64)>, TerrainError> {
        let mut all = known.to_vec();
        for (name, distribution) in variables {
            let seen = Seen { grammar: self, variables: &all, left, instances };
            let value = distribution.draw(draws, name, &seen)?;
            all.push((name.clone(), value));
        }
        Ok(all.split_off(known.len()))
    }
}
