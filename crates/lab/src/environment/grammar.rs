//! Shape grammars as they are written: shapes, variables drawn once, starting instances, rules.

use crate::file::form::{Desk, Form, Rule as Asked, Shape};
use crate::file::{Named, Node, Tree};
use crate::scenario::surroundings::Ball;
use crate::{form, tagged, words};
use space::{Segment, Vector};
use terrain::Expression;
use terrain::expression::Condition;
use terrain::geometry::Geometry;
use terrain::grammar as plain;

use super::workspace::Units;

/// A number, or an expression over variables: `"left.length * 0.8"`.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula(pub Expression);

impl From<f64> for Formula {
    fn from(number: f64) -> Self {
        Self(number.into())
    }
}

impl Form for Formula {
    fn read(node: &Node, rule: &Asked<'_>, desk: &mut Desk) -> Option<Self> {
        match &node.tree {
            Tree::Text(text) => match Expression::parse(text) {
                Ok(expression) => Some(Self(expression)),
                Err(error) => {
                    desk.problem(&node.span, error.to_string(), "a number or an expression", "");
                    None
                }
            },
            _ => desk.number(node, rule).map(Self::from),
        }
    }
    fn shape(rule: &Asked<'_>) -> Shape {
        Shape::Either(vec![f64::shape(rule), Shape::Text])
    }
    fn write(&self) -> Tree {
        match &self.0 {
            Expression::Number(number) => Tree::Number(*number),
            other => Tree::Text(other.to_string()),
        }
    }
}

tagged! {
    /// How a variable is drawn.
    pub enum Drawn {
        /// Each of these numbers with equal chance.
        choice in "", swarm::parameters::Range::Any => Choice(Vec<f64>);
        /// Uniform between two numbers.
        uniform in "", swarm::parameters::Range::Any => Uniform(Vec<f64>);
        /// Normal, by mean and standard deviation.
        normal in "", swarm::parameters::Range::Any => Normal(Vec<f64>);
    }
}

/// A variable: drawn, or an expression over those before it.
#[derive(Clone, Debug, PartialEq)]
pub enum Variable {
    /// Drawn.
    Drawn(Drawn),
    /// Computed.
    Computed(Formula),
}

impl Form for Variable {
    fn read(node: &Node, rule: &Asked<'_>, desk: &mut Desk) -> Option<Self> {
        if !matches!(node.tree, Tree::Table(_)) {
            return Formula::read(node, rule, desk).map(Self::Computed);
        }
        let drawn = Drawn::read(node, rule, desk)?;
        if let Drawn::Uniform(two) | Drawn::Normal(two) = &drawn
            && two.len() != 2
        {
            let what = format!("`{}` takes two numbers, found {}", rule.name, two.len());
            desk.problem(&node.span, what, "[least, greatest] or [mean, standard deviation]", "");
            return None;
        }
        Some(Self::Drawn(drawn))
    }
    fn shape(rule: &Asked<'_>) -> Shape {
        Shape::Either(vec![Drawn::shape(rule), Formula::shape(rule)])
    }
    fn write(&self) -> Tree {
        match self {
            Self::Drawn(drawn) => drawn.write(),
            Self::Computed(formula) => formula.write(),
        }
    }
}

impl Variable {
    fn plain(&self) -> terrain::Distribution {
        match self {
            Self::Drawn(Drawn::Choice(values)) => terrain::Distribution::Choice(values.clone()),
            Self::Drawn(Drawn::Uniform(two)) => terrain::Distribution::Uniform(two[0], two[1]),
            Self::Drawn(Drawn::Normal(two)) => terrain::Distribution::Normal(two[0], two[1]),
            Self::Computed(formula) => terrain::Distribution::Value(formula.0.clone()),
        }
    }
}

fn variables(named: &Named<Variable>) -> Vec<(String, terrain::Distribution)> {
    named.0.iter().map(|(name, variable)| (name.clone(), variable.plain())).collect()
}

/// Where an item of the right side stands: `"origin"`, `"end"`, `"end:0"` (the end of an item before it), or [x, y] in the
/// matched frame.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct At(pub plain::ItemPlace);

const PLACES: &str = "\"origin\", \"end\", \"end:0\" or [x, y]";

impl Form for At {
    fn read(node: &Node, rule: &Asked<'_>, desk: &mut Desk) -> Option<Self> {
        let place = match &node.tree {
            Tree::Text(text) => match text.as_str() {
                "origin" => Some(plain::ItemPlace::Origin),
                "end" => Some(plain::ItemPlace::End),
                other => other.strip_prefix("end:").and_then(|k| k.parse().ok()).map(plain::ItemPlace::EndOf),
            },
            Tree::List(list) if list.len() == 2 => {
                let [x, y] = [0, 1].map(|k| Formula::read(&list[k], rule, desk));
                return Some(Self(plain::ItemPlace::At([x?.0, y?.0])));
            }
            _ => None,
        };
        if place.is_none() {
            let what = format!("`{}` takes {PLACES}, found {}", rule.name, node.tree.describe());
            desk.problem(&node.span, what, format!("expected {PLACES}"), "");
        }
        place.map(Self)
    }
    fn shape(rule: &Asked<'_>) -> Shape {
        Shape::Either(vec![Shape::Text, Vec::<Formula>::shape(rule)])
    }
    fn write(&self) -> Tree {
        match &self.0 {
            plain::ItemPlace::Origin => "origin".into(),
            plain::ItemPlace::End => "end".into(),
            plain::ItemPlace::EndOf(k) => Tree::Text(format!("end:{k}")),
            plain::ItemPlace::At(point) => Tree::list(point.iter().map(|value| Formula(value.clone()).write())),
        }
    }
}

words! {
    /// Which is chosen first in a step.
    pub enum Pick {
        /// An instance that some rule matches, then one of those rules by weight.
        MatchFirst = "match-first",
        /// A rule by weight, then one of its matches.
        RuleFirst = "rule-first",
    }
}

words! {
    /// What becomes of a derivation that is stopped by its limit.
    pub enum OnLimit {
        /// Its non-terminals are dropped, its terminals kept.
        Drop = "drop",
        /// It is refused.
        Reject = "reject",
    }
}

form! {
    /// A grammar as a whole.
    pub struct Head {
        /// Its name.
        name: String = need, "", Any;
        /// In what lengths are measured.
        units: Units = [Units::Field], "", Any;
        /// Which is chosen first in a step.
        pick: Pick = [Pick::MatchFirst], "", Any;
        /// Numbers of applications, one of which is drawn with equal chance; left out, until no rule matches.
        steps: Vec<u32> = [Vec::new()], "1", NonNegative;
        /// Applications after which a derivation is stopped.
        max_steps: u32 = [1000u32], "1", Within(1.0, 1_000_000.0);
        /// What becomes of one that is stopped.
        on_limit: OnLimit = [OnLimit::Drop], "", Any;
    }
}

words! {
    /// What becomes of a shape in the end.
    pub enum ShapeKind {
        /// It is built, and agents sense it.
        Terminal = "terminal",
        /// It carries structure and is never built.
        NonTerminal = "nonterminal",
        /// It is never built, and behaviours and filters read it.
        Marker = "marker",
    }
}

form! {
    /// A shape, in a frame whose x axis is its heading and whose end is at 1.
    pub struct ShapeForm {
        /// Its name.
        name: String = need, "", Any;
        /// What becomes of it.
        kind: ShapeKind = [ShapeKind::Terminal], "", Any;
        /// Straight lines, each [x0, y0, x1, y1].
        lines: Vec<Vec<f64>> = [Vec::new()], "1", Any;
        /// Solid discs.
        points: Vec<Ball> = [Vec::new()], "", Any;
        /// A circle of thin wall.
        circle: Option<Ball> = none, "", Any;
        /// Corners of a closed line.
        polygon: Vec<Vec<f64>> = [Vec::new()], "1", Any;
    }
}

form! {
    /// A distance from the origin and a bearing (degrees, counter-clockwise from x).
    pub struct Polar {
        /// Distance.
        r: Formula = need, "length", Any;
        /// Direction.
        bearing: Formula = need, "deg", Any;
    }
}

words! {
    /// What of a shape stands at its place.
    pub enum Anchor {
        /// Its beginning.
        Start = "start",
        /// Its middle.
        Middle = "middle",
    }
}

form! {
    /// A starting instance.
    pub struct Axiom {
        /// Name of its shape.
        shape: String = need, "", Any;
        /// Where it stands.
        at: Vec<Formula> = [vec![Formula::from(0.0), Formula::from(0.0)]], "length", Any;
        /// Where it stands, by distance and bearing, in place of `at`.
        polar: Option<Polar> = none, "", Any;
        /// What of it stands there.
        anchor: Anchor = [Anchor::Start], "", Any;
        /// Its heading.
        heading: Formula = [0.0], "deg", Any;
        /// Its length.
        length: Formula = [1.0], "length", Any;
        /// Its label.
        label: String = [""], "", Any;
    }
}

form! {
    /// What a rule looks for: one shape of its left side.
    pub struct Pattern {
        /// Name of the shape.
        shape: String = need, "", Any;
        /// The label it must have; left out, any.
        label: Option<String> = none, "", Any;
        /// Where it stands in the frame of the first pattern.
        at: Vec<f64> = [vec![0.0, 0.0]], "length", Any;
        /// Its heading relative to the first pattern's.
        turn: f64 = [0.0], "deg", Any;
    }
}

form! {
    /// An item of the right side; in a modification, what becomes of the match at the same place.
    pub struct Item {
        /// Name of the shape; in a modification it may be left out, and stays.
        shape: String = [""], "", Any;
        /// Where it stands: "origin", "end" of the matched shape, "end:0" of an item before it, or [x, y] in the matched frame.
        at: At = [At::default()], "", Any;
        /// Its heading relative to the matched one's.
        turn: Option<Formula> = none, "deg", Any;
        /// Its length; left out, 1 (in a modification: as it was).
        length: Option<Formula> = none, "length", Any;
        /// Its scale; left out, 1 (in a modification: as it was).
        scale: Option<Formula> = none, "1", Any;
        /// Its label; left out, none (in a modification: as it was).
        label: Option<String> = none, "", Any;
        /// Attributes that it is given.
        set: Named<Formula> = [Named::default()], "", Any;
    }
}

words! {
    /// How a rule uses what it matched.
    pub enum RuleKind {
        /// The left side stays, the right side is added.
        Addition = "addition",
        /// The left side is removed, the right side put in.
        Substitution = "substitution",
        /// What was matched is changed, item by item.
        Modification = "modification",
    }
}

form! {
    /// A rule.
    pub struct RuleForm {
        /// Its name.
        name: String = need, "", Any;
        /// How it uses what it matched.
        kind: RuleKind = need, "", Any;
        /// How likely it is chosen, beside others.
        weight: f64 = [1.0], "1", Positive;
        /// What it looks for.
        left: Vec<Pattern> = need, "", Any;
        /// What it makes.
        right: Vec<Item> = [Vec::new()], "", Any;
        /// The label that the first match has afterwards, where it stays.
        relabel: Option<String> = none, "", Any;
        /// Variables drawn when it is applied.
        vars: Named<Variable> = [Named::default()], "", Any;
        /// What must hold for it to match, as `level < 4` or `count("wall") < 12`.
        when: Vec<String> = [Vec::new()], "", Any;
        /// Whether it also matches at any uniform scale.
        scale_free: bool = [false], "", Any;
        /// Whether it also matches mirrored.
        mirror: bool = [false], "", Any;
    }
}

form! {
    /// A shape grammar.
    pub struct GrammarForm {
        /// The grammar as a whole.
        grammar: Head = need, "", Any;
        /// Its shapes.
        shape: Vec<ShapeForm> = need, "", Any;
        /// Variables drawn once for each derivation, each an expression over those before it or `{ choice = [..] }`,
        /// `{ uniform = [a, b] }`, `{ normal = [mean, deviation] }`.
        vars: Named<Variable> = [Named::default()], "", Any;
        /// What it starts from.
        axiom: Vec<Axiom> = need, "", Any;
        /// Its rules.
        rule: Vec<RuleForm> = [Vec::new()], "", Any;
    }
}

/// A grammar: the name of a shipped one, the name of a file beside this one (it ends in `.toml`), or the grammar itself.
#[derive(Clone, Debug, PartialEq)]
pub enum GrammarSource {
    /// A name.
    Named(String),
    /// As it is written.
    Written(Box<GrammarForm>),
}

impl GrammarSource {
    /// The file that it is in, where it is in one.
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Named(name) if name.ends_with(".toml") => Some(name),
            _ => None,
        }
    }
    /// The grammar, checked; `text` is that of [`Self::file`], `path` where the grammar is asked for. What is wrong goes to the desk.
    pub fn found(&self, text: Option<&str>, path: &str, tree: &Node, desk: &mut Desk) -> Option<plain::Grammar> {
        match (self, text) {
            (Self::Named(name), Some(text)) => match read(name, text) {
                Ok(grammar) => Some(grammar),
                Err(problems) => {
                    let what = format!("`{name}` is no grammar:\n{}", problems.show(false));
                    desk.problem(&tree.place(path), what, "a grammar file", "");
                    None
                }
            },
            (Self::Named(name), None) => terrain::grammars::find(name).ok(),
            (Self::Written(form), _) => match form.plain() {
                Ok(grammar) => Some(grammar),
                Err((below, what)) => {
                    desk.problem(&tree.place(&format!("{path}.{below}")), what, "", "");
                    None
                }
            },
        }
    }
}

impl Form for GrammarSource {
    fn read(node: &Node, rule: &Asked<'_>, desk: &mut Desk) -> Option<Self> {
        match &node.tree {
            Tree::Table(_) => GrammarForm::read(node, rule, desk).map(|form| Self::Written(Box::new(form))),
            Tree::Text(name) if name.ends_with(".toml") => Some(Self::Named(name.clone())),
            Tree::Text(name) => match terrain::grammars::find(name) {
                Ok(_) => Some(Self::Named(name.clone())),
                Err(error) => {
                    let expected = format!("one of {}, or a file", terrain::grammars::LIST.join(", "));
                    desk.problem(&node.span, error.to_string(), expected, "a file's name ends in .toml");
                    None
                }
            },
            _ => {
                desk.kind(node, rule, "the name of a grammar or a table");
                None
            }
        }
    }
    fn shape(rule: &Asked<'_>) -> Shape {
        Shape::Either(vec![Shape::Text, GrammarForm::shape(rule)])
    }
    fn write(&self) -> Tree {
        match self {
            Self::Named(name) => Tree::Text(name.clone()),
            Self::Written(form) => form.write(),
        }
    }
}

impl GrammarForm {
    /// The grammar, checked.
    ///
    /// # Errors
    /// What is wrong with it: the path below the grammar, and a sentence.
    pub fn plain(&self) -> Result<plain::Grammar, (String, String)> {
        let mut grammar = plain::Grammar::new(&self.grammar.name, self.grammar.units.into());
        grammar.pick = match self.grammar.pick {
            Pick::MatchFirst => plain::Pick::MatchFirst,
            Pick::RuleFirst => plain::Pick::RuleFirst,
        };
        grammar.on_limit = match self.grammar.on_limit {
            OnLimit::Drop => plain::OnLimit::Drop,
            OnLimit::Reject => plain::OnLimit::Reject,
        };
        grammar.steps.clone_from(&self.grammar.steps);
        grammar.max_steps = self.grammar.max_steps;
        for (k, shape) in self.shape.iter().enumerate() {
            grammar.shapes.push(shape.plain().map_err(|(path, what)| (format!("shape.{k}.{path}"), what))?);
        }
        grammar.variables = variables(&self.vars);
        for (k, axiom) in self.axiom.iter().enumerate() {
            grammar.axioms.push(axiom.plain().map_err(|what| (format!("axiom.{k}.at"), what))?);
        }
        for (k, rule) in self.rule.iter().enumerate() {
            grammar.rules.push(rule.plain().map_err(|(path, what)| (format!("rule.{k}.{path}"), what))?);
        }
        if let Err(error) = grammar.check() {
            let what = error.to_string();
            // the rule that the sentence names is the place to look at
            let rule = self.rule.iter().position(|rule| what.contains(&format!("rule `{}`", rule.name)));
            return Err((rule.map_or_else(|| "grammar".to_owned(), |k| format!("rule.{k}")), what));
        }
        Ok(grammar)
    }
}

fn two(numbers: &[f64]) -> Result<[f64; 2], String> {
    <[f64; 2]>::try_from(numbers).map_err(|_| format!("{} numbers for a point", numbers.len()))
}

impl ShapeForm {
    fn plain(&self) -> Result<plain::ShapeKind, (String, String)> {
        let mut geometry = Vec::new();
        for (k, line) in self.lines.iter().enumerate() {
            let &[x0, y0, x1, y1] = line.as_slice() else {
                return Err((format!("lines.{k}"), format!("{} numbers for a line", line.len())));
            };
            geometry.push(Geometry::Wall(Segment::new([x0, y0], [x1, y1])));
        }
        for (k, disc) in self.points.iter().enumerate() {
            let centre = two(&disc.centre).map_err(|what| (format!("points.{k}.centre"), what))?;
            geometry.push(Geometry::Disc { centre: Vector(centre), radius: disc.radius });
        }
        if let Some(circle) = &self.circle {
            let centre = two(&circle.centre).map_err(|what| ("circle.centre".to_owned(), what))?;
            geometry.push(Geometry::Circle { centre: Vector(centre), radius: circle.radius });
        }
        if !self.polygon.is_empty() {
            let corner = |(k, corner): (usize, &Vec<f64>)| {
                two(corner).map(Vector).map_err(|what| (format!("polygon.{k}"), what))
            };
            geometry.push(Geometry::Polygon(self.polygon.iter().enumerate().map(corner).collect::<Result<_, _>>()?));
        }
        let kind = match self.kind {
            ShapeKind::Terminal => plain::Kind::Terminal,
            ShapeKind::NonTerminal => plain::Kind::NonTerminal,
            ShapeKind::Marker => plain::Kind::Marker,
        };
        Ok(plain::ShapeKind { name: self.name.clone(), kind, geometry })
    }
}

impl Axiom {
    fn plain(&self) -> Result<plain::Axiom, String> {
        let place = match (&self.polar, self.at.as_slice()) {
            (Some(polar), _) => {
                plain::AxiomPlace::Polar { radius: polar.r.0.clone(), bearing: polar.bearing.0.clone() }
            }
            (None, [x, y]) => plain::AxiomPlace::At([x.0.clone(), y.0.clone()]),
            (None, other) => return Err(format!("{} numbers for a point", other.len())),
        };
        Ok(plain::Axiom {
            shape: self.shape.clone(),
            place,
            middle: self.anchor == Anchor::Middle,
            heading: self.heading.0.clone(),
            length: self.length.0.clone(),
            label: self.label.clone(),
        })
    }
}

impl RuleForm {
    fn plain(&self) -> Result<plain::Rule, (String, String)> {
        let kind = match self.kind {
            RuleKind::Addition => plain::RuleKind::Addition,
            RuleKind::Substitution => plain::RuleKind::Substitution,
            RuleKind::Modification => plain::RuleKind::Modification,
        };
        let pattern = |(k, pattern): (usize, &Pattern)| -> Result<plain::Pattern, (String, String)> {
            Ok(plain::Pattern {
                shape: pattern.shape.clone(),
                label: pattern.label.clone(),
                at: two(&pattern.at).map_err(|what| (format!("left.{k}.at"), what))?,
                turn: pattern.turn,
            })
        };
        let item = |item: &Item| plain::Item {
            shape: item.shape.clone(),
            place: item.at.0.clone(),
            turn: item.turn.as_ref().map(|formula| formula.0.clone()),
            length: item.length.as_ref().map(|formula| formula.0.clone()),
            scale: item.scale.as_ref().map(|formula| formula.0.clone()),
            label: item.label.clone(),
            set: item.set.0.iter().map(|(name, formula)| (name.clone(), formula.0.clone())).collect(),
        };
        let when = |(k, text): (usize, &String)| {
            Condition::parse(text).map_err(|error| (format!("when.{k}"), error.to_string()))
        };
        Ok(plain::Rule {
            name: self.name.clone(),
            kind,
            weight: self.weight,
            left: self.left.iter().enumerate().map(pattern).collect::<Result<_, _>>()?,
            right: self.right.iter().map(item).collect(),
            relabel: self.relabel.clone(),
            variables: variables(&self.vars),
            when: self.when.iter().enumerate().map(when).collect::<Result<_, _>>()?,
            scale_free: self.scale_free,
            mirror: self.mirror,
        })
    }
}

/// Reads a grammar from the text of a file of its own.
///
/// # Errors
/// All that is wrong with it, at its place.
pub fn read(name: &str, text: &str) -> Result<plain::Grammar, crate::file::Problems> {
    use crate::file::tree::parse;
    let mut sources = crate::file::Sources::default();
    let source = sources.add(name, text);
    let mut desk = Desk::default();
    let tree = parse(&sources, source, &mut desk.problems);
    if desk.problems.is_empty()
        && let Some(form) = GrammarForm::read(&tree, &Asked { name: "the file", ..Asked::FREE }, &mut desk)
        && desk.problems.is_empty()
    {
        match form.plain() {
            Ok(grammar) => return Ok(grammar),
            Err((path, what)) => desk.problem(&tree.place(&path), what, "", ""),
        }
    }
    Err(crate::file::Problems::new(sources, desk.problems))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    const CORRALLING: &str = include_str!("../../../../studies/environments/grammars/corralling.toml");
    const SPLITTING: &str = include_str!("../../../../studies/environments/grammars/splitting.toml");

    #[test]
    fn the_shipped_files_are_the_shipped_grammars() {
        for (name, text) in [("corralling", CORRALLING), ("splitting", SPLITTING)] {
            let (read, shipped) = (read(name, text).unwrap(), terrain::grammars::find(name).unwrap());
            for attempt in 0..200 {
                let (a, b) = (read.construct(5, attempt).unwrap(), shipped.construct(5, attempt).unwrap());
                assert_eq!(a.hash(), b.hash(), "{name} {attempt}");
                assert_eq!(a.markers, b.markers, "{name} {attempt}");
            }
        }
    }

    #[test]
    fn what_is_wrong_is_told_at_its_place() {
        let wrong = |from: &str, to: &str| {
            assert!(CORRALLING.contains(from), "{from}");
            read("g.toml", &CORRALLING.replacen(from, to, 1)).unwrap_err().to_string()
        };
        let text = wrong("kind = \"addition\"", "kind = \"adition\"");
        assert!(text.contains("did you mean \"addition\"") && text.contains("g.toml:"), "{text}");
        assert!(wrong("label = \"tip\" }]", "label = \"top\" }]").contains("ever has the label \"top\""));
        assert!(wrong("weight = 1", "weight = 0").contains("more than 0"));
        assert!(wrong("length = \"l\"", "length = \"k\"").contains("unknown name `k`"));
        assert!(wrong("at = \"end\"", "at = \"edn\"").contains("\"end:0\""));
        assert!(wrong("heading = \"b + 90\"", "heading = \"b +\"").contains("g.toml:"));
    }

    #[test]
    fn a_grammar_writes_itself() {
        use crate::file::{Sources, tree::parse};
        let form = |text: &str| {
            let mut sources = Sources::default();
            let source = sources.add("g", text);
            let mut desk = Desk::default();
            let node = parse(&sources, source, &mut desk.problems);
            GrammarForm::read(&node, &Asked::FREE, &mut desk).unwrap()
        };
        let one = form(CORRALLING);
        let text = crate::file::write::toml(&Node { tree: one.write(), span: Default::default() });
        assert_eq!(form(&text), one, "{text}");
    }
}
