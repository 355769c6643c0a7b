//! Where environments come from, as it is written: a grammar, a schema, a grid of one, all arrangements of primitives, stages, or files.

use super::grammar::GrammarSource;
use super::stages::{StageForm, Staged, staged};
use super::workspace::{Picture, Units, drawn};
use crate::file::{Desk, Named, Node, Span};
use crate::{form, tagged, words};
use search::Axis;
use space::spelling::nearest;
use terrain::generate::{Candidates as Propose, Enumeration, odometer};
use terrain::schema::Domain as Values;
use terrain::{Construct, Grammar, Placement, Schema, TerrainError, Workspace, primitives, schemas};

form! {
    /// A schema at one set of values; what differs between candidates is what it draws.
    pub struct SchemaForm {
        /// Its id.
        id: String = need, "", Any;
        /// Parameters that differ from their defaults, by name.
        at: Named<f64> = [Named::default()], "", Any;
    }
}

form! {
    /// A schema at every combination of some values: the last parameter that is named changes fastest.
    pub struct GridForm {
        /// Its id.
        id: String = need, "", Any;
        /// The values of parameters, by name.
        values: Named<Vec<f64>> = [Named::default()], "", Any;
        /// Parameters whose whole range is visited, with the distance between two values.
        resolution: Named<f64> = [Named::default()], "", Positive;
        /// Parameters that have one value other than their default.
        at: Named<f64> = [Named::default()], "", Any;
    }
}

form! {
    /// All arrangements of so many primitives, each of any of the types at any combination of values (k-MAEBE on a grid).
    pub struct PrimitivesForm {
        /// Number of primitives in each.
        count: u32 = [1u32], "1", Within(0.0, 16.0);
        /// The values of each attribute of each type, by the names of both.
        kind: Named<Named<Vec<f64>>> = need, "", Any;
        /// More candidates than this are refused.
        most: f64 = [1e6], "1", Positive;
    }
}

tagged! {
    /// Where environments come from.
    pub enum Candidates {
        /// A shape grammar: one derivation each. The name of a shipped one, of a file, or the grammar itself.
        grammar => Grammar(GrammarSource);
        /// A schema that draws.
        schema => Schema(SchemaForm);
        /// A grid over a schema.
        grid => Grid(GridForm);
        /// A grid over primitives.
        primitives => Primitives(PrimitivesForm);
        /// Drawings: each file is one.
        files => Files(Vec<String>);
        /// Stages that are built one behind the other, each by a schema of its own: a hierarchical schema.
        stages => Stages(Vec<StageForm>);
    }
}

words! {
    /// What becomes of the parts of a construct outside the workspace.
    pub enum Placing {
        /// They remain, and have no effect.
        Keep = "keep",
        /// Walls are cut at the walls of the workspace.
        Clip = "clip",
        /// The construct is refused.
        Reject = "reject",
    }
}

impl From<Placing> for Placement {
    fn from(placing: Placing) -> Self {
        match placing {
            Placing::Keep => Self::Keep,
            Placing::Clip => Self::Clip,
            Placing::Reject => Self::Reject,
        }
    }
}

/// What proposes constructs, one for each attempt.
pub enum Source {
    /// A grammar.
    Grammar(Box<Grammar>),
    /// A schema at values that are the same for every attempt.
    Schema(Box<dyn Schema>, Vec<f64>),
    /// A schema at the values of a grid.
    Grid(Box<dyn Schema>, Vec<Vec<f64>>),
    /// Primitives.
    Primitives(Enumeration),
    /// Given constructs.
    Given(Vec<Construct>),
    /// Stages.
    Stages(Staged),
}

impl Source {
    /// Its name.
    pub fn name(&self) -> String {
        match self {
            Self::Grammar(grammar) => format!("grammar {}", grammar.name),
            Self::Schema(schema, _) | Self::Grid(schema, _) => format!("schema {}", schema.card().id),
            Self::Primitives(_) => "primitives".to_owned(),
            Self::Given(_) => "drawings".to_owned(),
            Self::Stages(stages) => format!("stages {}", stages.names().join(", ")),
        }
    }
    /// How many candidates there are; none where there is no end.
    pub fn count(&self) -> Option<f64> {
        match self {
            Self::Grammar(_) | Self::Schema(..) => None,
            Self::Grid(_, axes) => Some(axes.iter().map(|axis| axis.len() as f64).product()),
            Self::Primitives(enumeration) => Some(enumeration.count()),
            Self::Given(list) => Some(list.len() as f64),
            Self::Stages(stages) => Some(stages.count()),
        }
    }
    /// Names of the parameters of which candidates have values of their own.
    pub fn parameters(&self) -> Vec<String> {
        match self {
            Self::Grid(schema, axes) => {
                let card = schema.card();
                let varied = card.parameters.iter().zip(axes).filter(|(_, axis)| axis.len() > 1);
                varied.map(|(parameter, _)| parameter.name.to_string()).collect()
            }
            Self::Stages(stages) => stages.parameters(),
            _ => Vec::new(),
        }
    }
}

impl Propose for Source {
    fn candidate(&self, workspace: &Workspace, seed: u64, attempt: u64) -> Result<Option<Construct>, TerrainError> {
        let mut made = match self {
            Self::Grammar(grammar) => grammar.candidate(workspace, seed, attempt),
            Self::Schema(schema, values) => schema.construct(values, workspace, seed, attempt).map(Some),
            Self::Grid(schema, axes) => match odometer(axes, attempt) {
                Some(values) => schema.construct(&values, workspace, seed, attempt).map(Some),
                None => Ok(None),
            },
            Self::Primitives(enumeration) => enumeration.candidate(workspace, seed, attempt),
            Self::Given(list) => Ok(usize::try_from(attempt).ok().and_then(|k| list.get(k)).cloned()),
            Self::Stages(stages) => {
                stages.composed(workspace, seed, attempt).map(|whole| whole.map(|whole| whole.construct))
            }
        }?;
        // by which it is known from here on
        if let Some(construct) = &mut made {
            (construct.provenance.seed, construct.provenance.attempt) = (seed, attempt);
        }
        Ok(made)
    }
}

/// A parameter of a schema as an axis: its place, its ends (those of its domain where they are left out), its unit. What is
/// wrong goes to the desk.
pub fn axis_of(
    schema: &dyn Schema,
    name: &str,
    (low, high): (Option<f64>, Option<f64>),
    place: &Span,
    desk: &mut Desk,
) -> Option<(usize, Axis, String)> {
    let card = schema.card();
    let Some(k) = card.parameters.iter().position(|parameter| parameter.name == name) else {
        let near = nearest(name, card.parameters.iter().map(|parameter| &*parameter.name));
        let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
        desk.problem(place, format!("`{}` has no parameter `{name}`", card.id), "not a parameter", help);
        return None;
    };
    let parameter = &card.parameters[k];
    let (least, most) = parameter.domain.bounds();
    let (low, high) = (low.unwrap_or(least), high.unwrap_or(most));
    let mut axis = Axis::new(low, high);
    // half of the whole circle is no circle
    axis.periodic = matches!(parameter.domain, Values::Periodic(..)) && (low, high) == (least, most);
    let unit = if parameter.unit == "1" { String::new() } else { parameter.unit.to_owned() };
    Some((k, axis, unit))
}

/// The schema of an id; what is wrong goes to the desk.
pub fn schema_of(id: &str, path: &str, tree: &Node, desk: &mut Desk) -> Option<Box<dyn Schema>> {
    schemas::find(id).map_err(|error| desk.problem(&tree.place(path), error.to_string(), "a schema", "")).ok()
}

/// The values of all parameters of a schema, of which some are given; what is wrong goes to the desk.
pub fn values_of(schema: &dyn Schema, at: &Named<f64>, path: &str, tree: &Node, desk: &mut Desk) -> Option<Vec<f64>> {
    let card = schema.card();
    let before = desk.problems.len();
    for (name, value) in &at.0 {
        if let Err(error) = card.values(&[(name, *value)]) {
            desk.problem(&tree.place(&format!("{path}.{name}")), error.to_string(), "not possible", "");
        }
    }
    let given: Vec<(&str, f64)> = at.0.iter().map(|(name, value)| (name.as_str(), *value)).collect();
    (desk.problems.len() == before).then(|| card.values(&given).ok()).flatten()
}

impl Candidates {
    /// The names of files that it needs, each with its path.
    pub fn files(&self) -> Vec<(String, String)> {
        match self {
            Self::Grammar(grammar) => {
                grammar.file().map(|name| ("candidates.grammar".into(), name.to_owned())).into_iter().collect()
            }
            Self::Files(names) => {
                names.iter().enumerate().map(|(k, name)| (format!("candidates.files.{k}"), name.clone())).collect()
            }
            _ => Vec::new(),
        }
    }
    /// The source; `texts` are those of [`Candidates::files`]. What is wrong goes to the desk.
    pub fn source(&self, texts: &[String], units: terrain::Units, tree: &Node, desk: &mut Desk) -> Option<Source> {
        match self {
            Self::Grammar(grammar) => {
                let grammar = grammar.found(texts.first().map(String::as_str), "candidates.grammar", tree, desk)?;
                Some(Source::Grammar(Box::new(grammar)))
            }
            Self::Schema(form) => {
                let schema = schema_of(&form.id, "candidates.schema.id", tree, desk)?;
                let values = values_of(&*schema, &form.at, "candidates.schema.at", tree, desk)?;
                Some(Source::Schema(schema, values))
            }
            Self::Grid(form) => {
                let schema = schema_of(&form.id, "candidates.grid.id", tree, desk)?;
                let values = values_of(&*schema, &form.at, "candidates.grid.at", tree, desk)?;
                form.axes(&*schema, values, "candidates.grid", tree, desk).map(|axes| Source::Grid(schema, axes))
            }
            Self::Primitives(form) => form.enumeration(tree, desk).map(Source::Primitives),
            Self::Stages(forms) => staged(forms, tree, desk).map(Source::Stages),
            Self::Files(names) => {
                let units = if units == terrain::Units::Field { Units::Field } else { Units::Metres };
                let mut list = Vec::new();
                for (k, (name, text)) in names.iter().zip(texts).enumerate() {
                    let picture = Picture { name: name.clone(), units, point_radius: 0.5 };
                    match drawn(&picture, text) {
                        // a plain drawing is all construct
                        Ok((workspace, construct)) => list.push(construct.unwrap_or_else(|| {
                            let mut construct = Construct::new(workspace.units, Vec::new());
                            let piece = |geometry| terrain::Piece { name: "wall".into(), geometry: vec![geometry] };
                            construct.pieces = workspace.geometry.into_iter().map(piece).collect();
                            construct.provenance.schema.clone_from(name);
                            construct
                        })),
                        Err(what) => {
                            desk.problem(&tree.place(&format!("candidates.files.{k}")), what, "a drawing", "");
                        }
                    }
                }
                (list.len() == names.len()).then_some(Source::Given(list))
            }
        }
    }
}

impl GridForm {
    /// The values of each parameter of the schema, in its order; `path` is that of this form.
    pub(super) fn axes(
        &self,
        schema: &dyn Schema,
        values: Vec<f64>,
        path: &str,
        tree: &Node,
        desk: &mut Desk,
    ) -> Option<Vec<Vec<f64>>> {
        let card = schema.card();
        let before = desk.problems.len();
        let mut axes: Vec<Vec<f64>> = values.into_iter().map(|value| vec![value]).collect();
        let place = |name: &str| card.parameters.iter().position(|parameter| parameter.name == name);
        let mut unknown = |key: &str, name: &str| {
            let near = nearest(name, card.parameters.iter().map(|parameter| &*parameter.name));
            let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
            let what = format!("`{}` has no parameter `{name}`", card.id);
            desk.problem(&tree.place(&format!("{path}.{key}.{name}")), what, "not a parameter", help);
        };
        let mut wrongs: Vec<(String, String)> = Vec::new();
        for (name, list) in &self.values.0 {
            let Some(k) = place(name) else {
                unknown("values", name);
                continue;
            };
            let domain = &card.parameters[k].domain;
            match list.iter().find(|value| !domain.holds(**value)) {
                _ if list.is_empty() => wrongs.push((format!("values.{name}"), format!("`{name}` has no values"))),
                Some(bad) => {
                    let (least, most) = domain.bounds();
                    wrongs
                        .push((format!("values.{name}"), format!("`{name}` lies from {least} to {most}, found {bad}")));
                }
                None => axes[k].clone_from(list),
            }
        }
        for (name, resolution) in &self.resolution.0 {
            let Some(k) = place(name) else {
                unknown("resolution", name);
                continue;
            };
            match card.parameters[k].domain.grid(*resolution) {
                Ok(list) => axes[k] = list,
                Err(error) => wrongs.push((format!("resolution.{name}"), error.to_string())),
            }
        }
        for (below, what) in wrongs {
            desk.problem(&tree.place(&format!("{path}.{below}")), what, "not possible", "");
        }
        (desk.problems.len() == before).then_some(axes)
    }
}

impl PrimitivesForm {
    fn enumeration(&self, tree: &Node, desk: &mut Desk) -> Option<Enumeration> {
        let mut kinds = Vec::new();
        let mut wrong = |path: &str, what: String| {
            desk.problem(&tree.place(&format!("candidates.primitives.{path}")), what, "not possible", "");
        };
        for (name, given) in &self.kind.0 {
            let kind = match primitives::find(name) {
                Ok(kind) => kind,
                Err(error) => {
                    wrong(&format!("kind.{name}"), error.to_string());
                    return None;
                }
            };
            let mut axes = Vec::new();
            for attribute in &kind.attributes {
                match given.0.iter().find(|(known, _)| *known == *attribute.name) {
                    Some((_, values)) => axes.push(values.clone()),
                    None => {
                        wrong(&format!("kind.{name}"), format!("`{}` of `{name}` has no values", attribute.name));
                        return None;
                    }
                }
            }
            kinds.push((kind, axes));
        }
        Enumeration::new(kinds, self.count, self.most).map_err(|error| wrong("most", error.to_string())).ok()
    }
}
