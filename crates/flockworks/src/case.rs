//! A conformance case: the JSON form in which the expected steps are kept, turned into the plan of a world.

use crate::fault::{Fault, hint, wrong};
use crate::json::At;
use serde_json::{Map, Value as Json};
use space::obstacles::Obstacle;
use space::shape::Shape;
use space::{ColumnKind, Real, Space, Vector};
use std::collections::BTreeMap;
use swarm::engine::{GroupPlan, Placement, Start};
use swarm::models::{Catalogue, Entry, Models};
use swarm::motion::Injected;
use swarm::parameters::{ParameterError, Scalar, Value, Values};
use swarm::physics::Contact;
use swarm::resources::{Gain, Metabolism, ResourcePlan, Respawn};
use swarm::{World, WorldError, WorldPlan};

const CASE_KEYS: [&str; 9] = ["model", "case", "dim", "space", "params", "aux", "state", "expected", "note"];
/// Keys of `params` that belong to the world where the model does not declare them.
const WORLD_KEYS: [&str; 12] =
    ["walls", "discs", "spheres", "planes", "food", "r_obs", "eat", "meal_e", "meal_h", "emax", "cost", "starve"];
/// Keys of `aux` that are no random quantities.
const AUX_KEYS: [&str; 5] = ["seed", "step", "obstacles", "food", "respawn"];
/// Models whose own rule is that a move into a wall or disc is not made: their contact is left to them.
const BLOCKED: [&str; 3] = ["boids_plus", "rm_plus", "snn_plus"];
/// Health cannot be raised above this.
const HEALTHY: f64 = 100.0;

/// A file of cases: either one case, or `cases` with a tolerance.
pub struct Cases<'a> {
    /// The cases, not yet read.
    pub list: Vec<At<'a>>,
    /// Tolerance of reals, absolute and relative.
    pub tolerance: f64,
}

/// Splits a file into its cases.
///
/// # Errors
/// A file that has neither form.
pub fn split(file: &Json) -> Result<Cases<'_>, Fault> {
    let root = At::root(file);
    let object = root.object()?;
    let tolerance = match root.get("tolerance")? {
        Some(at) => at.number()?,
        None => 1e-9,
    };
    if tolerance < 0.0 {
        return wrong(format!("tolerance: expected 0 or more, found {tolerance}"));
    }
    let list = match root.get("cases")? {
        Some(cases) => {
            root.only(&["tolerance", "note", "cases"])?;
            let list = cases.list()?;
            if list.is_empty() {
                return wrong("cases: the list is empty; expected at least one case");
            }
            list
        }
        None if object.contains_key("model") => vec![root],
        None => {
            return wrong("expected a case (an object with `model`, `state`, ...) or an object with a list `cases`");
        }
    };
    Ok(Cases { list, tolerance })
}

/// Names of a case for tables: its model and its own name, as far as they can be read.
pub fn names(at: &At<'_>) -> (String, String) {
    let text = |key: &str| match at.value.get(key) {
        Some(Json::String(text)) => text.clone(),
        Some(other) => other.to_string(),
        None => String::new(),
    };
    (text("model"), text("case"))
}

#[derive(Clone, Debug)]
enum Bounds {
    Open,
    Periodic(Vec<f64>),
    Walls(Vec<f64>),
}

#[derive(Clone, Debug)]
enum Solid {
    Segment(Vec<f64>),
    Ball(Vec<f64>, f64),
    Plane(Vec<f64>, Vec<f64>),
}

#[derive(Clone, Debug, Default)]
struct Food {
    items: Vec<Vec<f64>>,
    respawn: Option<Vec<Vec<f64>>>,
    within: f64,
    gains: Vec<(&'static str, f64, f64)>,
    metabolism: Option<(f64, f64)>,
}

/// A case, read and checked as far as that is possible without its world.
pub struct Case {
    /// The model.
    pub entry: &'static Entry,
    /// Dimensions of its space.
    pub dimension: usize,
    /// The state after one step, where it is given.
    pub expected: Option<Map<String, Json>>,
    /// Keys whose values the case writes as whole numbers.
    whole: Vec<String>,
    place: String,
    bounds: Bounds,
    parameters: Values,
    solids: Vec<Solid>,
    contact: Option<Contact>,
    food: Option<Food>,
    seed: Option<u64>,
    first_step: u64,
    injected: BTreeMap<String, Vec<Vec<f64>>>,
    position: Vec<Vec<f64>>,
    velocity: Option<Vec<Vec<f64>>>,
    columns: BTreeMap<String, Vec<f64>>,
}

/// The model of an id, or the error that names the nearest one.
///
/// # Errors
/// An id that no model has.
pub fn model(id: &str) -> Result<&'static Entry, Fault> {
    let ids: Vec<&str> = swarm::models::LIST.iter().map(|entry| entry.card.id).collect();
    match swarm::models::find(id) {
        Some(entry) => Ok(entry),
        None => wrong(format!("unknown model `{id}`{}", hint(id, &ids))),
    }
}

impl Case {
    /// Reads a case.
    ///
    /// # Errors
    /// Anything that cannot be, with its place and the nearest valid name.
    pub fn read(at: &At<'_>) -> Result<Self, Fault> {
        at.only(&CASE_KEYS)?;
        let model_at = at.need("model")?;
        let entry = model(model_at.text()?).map_err(|fault| fault.at(&model_at.place))?;
        let state = at.need("state")?;
        let pos = state.need("pos")?;
        let dimension = match at.get("dim")? {
            Some(dim) => match dim.whole()? {
                d @ 1..=3 => d as usize,
                d => return dim.fault(format_args!("expected 1, 2 or 3, found {d}")),
            },
            None => return at.fault("`dim` is missing; expected 1, 2 or 3"),
        };
        if !entry.dimensions.contains(&dimension) {
            let works: Vec<String> = entry.dimensions.iter().map(ToString::to_string).collect();
            let text = format!("`{}` works in {} dimensions, not in {dimension}", entry.card.id, works.join(" or "));
            return wrong(format!("{}: {text}", at.below("dim")));
        }
        let mut case = Self {
            entry,
            dimension,
            expected: None,
            whole: Vec::new(),
            place: at.place.clone(),
            bounds: Bounds::Open,
            parameters: Values::new(),
            solids: Vec::new(),
            contact: None,
            food: None,
            seed: None,
            first_step: 0,
            injected: BTreeMap::new(),
            position: points(&pos, dimension, None)?,
            velocity: None,
            columns: BTreeMap::new(),
        };
        if let Some(space) = at.get("space")? {
            case.bounds = case.read_space(&space)?;
        }
        case.read_state(&state)?;
        let radius = match at.get("params")? {
            Some(params) => case.read_parameters(&params)?,
            None => None,
        };
        if let Some(aux) = at.get("aux")? {
            case.read_aux(&aux, radius)?;
        }
        if let Some(expected) = at.get("expected")? {
            let expected = expected.object()?;
            for (key, value) in expected {
                case.note_form(key, value);
            }
            case.expected = Some(expected.clone());
        }
        Ok(case)
    }

    /// Number of agents.
    pub fn agents(&self) -> usize {
        self.position.len()
    }

    fn note_form(&mut self, key: &str, value: &Json) {
        if value.as_array().and_then(|list| list.first()).is_some_and(|first| first.is_i64() || first.is_u64()) {
            self.whole.push(key.to_owned());
        }
    }

    fn read_space(&self, at: &At<'_>) -> Result<Bounds, Fault> {
        at.only(&["kind", "size"])?;
        let kind_at = at.need("kind")?;
        let kind = kind_at.text()?;
        let size = || -> Result<Vec<f64>, Fault> {
            let size_at = at.need("size")?;
            let size = size_at.numbers(Some(self.dimension))?;
            match size.iter().position(|&side| side <= 0.0) {
                Some(k) => wrong(format!("{}[{k}]: a side must be more than 0, found {}", size_at.place, size[k])),
                None => Ok(size),
            }
        };
        match kind {
            "unbounded" => Ok(Bounds::Open),
            "periodic" => Ok(Bounds::Periodic(size()?)),
            "walls" | "tank" | "bounded" => Ok(Bounds::Walls(size()?)),
            other => kind_at.fault(format_args!(
                "expected unbounded, periodic, walls, tank or bounded, found \"{other}\"{}",
                hint(other, &["unbounded", "periodic", "walls", "tank", "bounded"])
            )),
        }
    }

    fn read_state(&mut self, at: &At<'_>) -> Result<(), Fault> {
        let declared = (self.entry.columns)();
        let agents = self.agents();
        if let Bounds::Walls(size) = &self.bounds {
            for (k, place) in self.position.iter().enumerate() {
                if let Some(a) = (0..size.len()).find(|&a| !(0.0..=size[a]).contains(&place[a])) {
                    let (found, end, at) = (place[a], size[a], at.below("pos"));
                    return wrong(format!("{at}[{k}][{a}]: the walls of this axis are at 0 and {end}, found {found}"));
                }
            }
        }
        for (key, value) in at.entries()? {
            match key {
                "pos" => continue,
                "vel" => {
                    self.velocity = Some(points(&value, self.dimension, Some(agents))?);
                    continue;
                }
                _ => self.note_form(key, value.value),
            }
            if let Some(column) = declared.iter().find(|column| column.name == key) {
                let list = of_length(&value, agents)?;
                let read = |entry: &At<'_>| match (entry.value, column.kind) {
                    (Json::String(word), ColumnKind::Label(words)) => match words.iter().position(|w| w == word) {
                        Some(label) => Ok(label as f64),
                        None => entry.fault(format_args!("unknown word \"{word}\"{}", hint(word, words))),
                    },
                    (Json::Bool(truth), _) => Ok(f64::from(u8::from(*truth))),
                    (_, ColumnKind::Label(words)) => match entry.whole()? {
                        label if (label as usize) < words.len() => Ok(label as f64),
                        label => {
                            entry.fault(format_args!("expected a label from 0 to {}, found {label}", words.len() - 1))
                        }
                    },
                    _ => entry.number(),
                };
                let values = list.iter().map(read).collect::<Result<_, _>>()?;
                self.columns.insert(key.to_owned(), values);
                continue;
            }
            let parts: Vec<String> = (0..self.dimension).map(|axis| component(key, axis)).collect();
            if parts.iter().all(|part| declared.iter().any(|column| column.name == part)) {
                let vectors = points(&value, self.dimension, Some(agents))?;
                for (axis, part) in parts.into_iter().enumerate() {
                    self.columns.insert(part, vectors.iter().map(|v| v[axis]).collect());
                }
                continue;
            }
            let mut known = vec!["pos", "vel"];
            known.extend(declared.iter().map(|column| column.name));
            return at.fault(format_args!("`{}` has no state `{key}`{}", self.entry.card.id, hint(key, &known)));
        }
        Ok(())
    }

    /// Reads `params`; returns the radius of obstacles that `aux` gives, where there is one.
    fn read_parameters(&mut self, at: &At<'_>) -> Result<Option<f64>, Fault> {
        let descriptors = (self.entry.parameters)();
        let declares = |key: &str| descriptors.iter().any(|d| d.name == key || d.alias == Some(key));
        let d = self.dimension;
        let mut radius = None;
        let mut food = Food::default();
        let (mut fed, mut full) = (false, f64::INFINITY);
        let (mut energy, mut health, mut cost, mut starve) = (None, None, None, None);
        for (key, value) in at.entries()? {
            let declared = declares(key);
            if declared {
                self.parameters.insert(key.to_owned(), parameter(&value)?);
            }
            match key {
                "r_obs" => radius = Some(value.number()?),
                _ if declared => {}
                "walls" => {
                    for wall in value.list()? {
                        self.solids.push(Solid::Segment(wall.numbers(Some(2 * d))?));
                    }
                }
                "discs" | "spheres" => {
                    for ball in value.list()? {
                        let numbers = ball.numbers(Some(d + 1))?;
                        self.solids.push(Solid::Ball(numbers[..d].to_vec(), numbers[d]));
                    }
                }
                "planes" => {
                    for plane in value.list()? {
                        let parts = of_length(&plane, 2)?;
                        self.solids.push(Solid::Plane(parts[0].numbers(Some(d))?, parts[1].numbers(Some(d))?));
                    }
                }
                "food" => {
                    food.items = points(&value, d, None)?;
                    fed = true;
                }
                "eat" => {
                    food.within = value.number()?;
                    fed = true;
                }
                "emax" => full = value.number()?,
                "meal_e" => energy = Some(value.number()?),
                "meal_h" => health = Some(value.number()?),
                "cost" => cost = Some(value.number()?),
                "starve" => starve = Some(value.number()?),
                _ => {
                    let mut known: Vec<&str> =
                        descriptors.iter().flat_map(|d| [Some(d.name), d.alias]).flatten().collect();
                    known.extend(WORLD_KEYS);
                    return at.fault(format_args!(
                        "`{}` has no parameter `{key}`{}",
                        self.entry.card.id,
                        hint(key, &known)
                    ));
                }
            }
        }
        if !self.solids.is_empty() && !matches!(self.bounds, Bounds::Walls(_)) && !BLOCKED.contains(&self.entry.card.id)
        {
            // the physical motion of the catalogue's models is ideal; where the space has walls, all that is solid stops
            self.contact = Some(Contact::Free);
        }
        if let Some(amount) = energy {
            food.gains.push(("energy", amount, full));
        }
        if let Some(amount) = health {
            food.gains.push(("health", amount, HEALTHY));
        }
        if cost.is_some() || starve.is_some() {
            food.metabolism = Some((cost.unwrap_or(0.0), starve.unwrap_or(1.0)));
        }
        if fed || !food.gains.is_empty() || food.metabolism.is_some() {
            self.food = Some(food);
        }
        Ok(radius)
    }

    fn read_aux(&mut self, at: &At<'_>, radius: Option<f64>) -> Result<(), Fault> {
        let descriptors = (self.entry.parameters)();
        let agents = self.agents();
        for (key, value) in at.entries()? {
            match key {
                "seed" => self.seed = Some(value.whole()?),
                "step" => {
                    self.first_step = value.whole()?;
                    self.seed = self.seed.or(Some(1));
                }
                "obstacles" => {
                    let Some(radius) = radius else {
                        return value.fault("obstacles need their radius, `r_obs` in params");
                    };
                    for centre in points(&value, self.dimension, None)? {
                        self.solids.push(Solid::Ball(centre, radius));
                    }
                }
                "food" => {
                    self.food.get_or_insert_default().items = points(&value, self.dimension, None)?;
                }
                "respawn" => {
                    self.food.get_or_insert_default().respawn = Some(points(&value, self.dimension, None)?);
                }
                _ if descriptors.iter().any(|d| d.name == key || d.alias == Some(key)) => {
                    if self.parameters.insert(key.to_owned(), parameter(&value)?).is_some() {
                        return value.fault("given in params already");
                    }
                }
                _ => {
                    let random = self.entry.card.random;
                    let Some(quantity) = random.iter().find(|quantity| quantity.name == key) else {
                        let mut known: Vec<&str> = random.iter().map(|quantity| quantity.name).collect();
                        known.extend(AUX_KEYS);
                        return at.fault(format_args!(
                            "`{}` has no random quantity `{key}`{}",
                            self.entry.card.id,
                            hint(key, &known)
                        ));
                    };
                    let components = quantity.components(self.dimension);
                    let read = |entry: &At<'_>| {
                        let numbers = match entry.value {
                            Json::Array(_) => entry.numbers(None)?,
                            _ => vec![entry.number()?],
                        };
                        if components.contains(&numbers.len()) {
                            return Ok(numbers);
                        }
                        entry.fault(format_args!(
                            "`{key}` has {} for a member, found {}",
                            match components.end() {
                                1 => "one number".to_owned(),
                                end => format!("{end} components"),
                            },
                            numbers.len()
                        ))
                    };
                    let values = of_length(&value, agents)?.iter().map(read).collect::<Result<_, _>>()?;
                    self.injected.insert(key.to_owned(), values);
                }
            }
        }
        if self.seed.is_some()
            && let Some(name) = self.injected.keys().next()
        {
            return at.fault(format_args!("gives both a seed to draw from and `{name}` in place of a draw"));
        }
        if let Some(Food { items, respawn: Some(respawn), .. }) = &self.food
            && items.len() != respawn.len()
        {
            return wrong(format!(
                "{}: expected {} places, one for each item, found {}",
                at.below("respawn"),
                items.len(),
                respawn.len()
            ));
        }
        Ok(())
    }

    /// The plan of the case's world.
    ///
    /// # Errors
    /// An obstacle that cannot be.
    pub fn plan<R: Scalar, const D: usize>(&self, threads: usize) -> Result<WorldPlan<R, D>, Fault> {
        let sides = |size: &[f64]| core::array::from_fn(|a| R::of(size[a]));
        let space = match &self.bounds {
            Bounds::Open => Space::open(),
            Bounds::Periodic(size) => Space::periodic(sides(size)),
            Bounds::Walls(size) => Space::walled(sides(size)),
        };
        let start = Start {
            position: vectors(&self.position),
            velocity: self.velocity.as_deref().map(vectors),
            columns: self.columns.clone(),
        };
        let id = self.entry.card.id;
        let mut group = GroupPlan::new("members", id, self.parameters.clone(), self.agents(), Placement::Given(start));
        group.contact = self.contact;
        group.sensing = self.entry.default_sensing();
        let mut plan = WorldPlan::new(space, group);
        for solid in &self.solids {
            let shape = match solid {
                Solid::Segment(ends) => Shape::new_segment(vector(&ends[..D]), vector(&ends[D..])),
                Solid::Ball(centre, radius) => Shape::new_ball(vector(centre), R::of(*radius)),
                Solid::Plane(point, normal) => Shape::new_plane(vector(point), vector(normal)),
            };
            let shape = shape.map_err(|error| Fault::Input(format!("obstacles: {error}")))?;
            plan.obstacles.push(Obstacle::new(shape));
        }
        if let Some(food) = &self.food {
            let gain = |&(column, amount, capacity): &(&str, f64, f64)| Gain {
                column: column.to_owned(),
                amount: R::of(amount),
                capacity: R::of(capacity),
            };
            plan.resources = Some(ResourcePlan {
                items: vectors(&food.items),
                within: R::of(food.within),
                gains: food.gains.iter().map(gain).collect(),
                respawn: Respawn::After(0.0),
                metabolism: food.metabolism.map(|(cost, starvation)| Metabolism {
                    cost: R::of(cost),
                    starvation: R::of(starvation),
                    ..Metabolism::default()
                }),
                ..ResourcePlan::default()
            });
        }
        plan.seed = self.seed.unwrap_or(1);
        plan.first_step = self.first_step;
        plan.threads = threads;
        Ok(plan)
    }

    /// The case's world, ready to step.
    ///
    /// # Errors
    /// Whatever in it cannot be.
    pub fn world<R: Scalar, const D: usize>(&self, threads: usize) -> Result<World<R, D>, Fault>
    where
        Models: Catalogue<R, D>,
    {
        let mut world = World::new(self.plan(threads)?).map_err(|error| self.explain(&error))?;
        if self.seed.is_none() {
            world.inject(Injected { values: self.injected.clone() });
        }
        if let (Some(resources), Some(Food { respawn: Some(respawn), .. })) = (world.resources_mut(), &self.food) {
            resources.respawn_at = Some(vectors(respawn));
        }
        Ok(world)
    }

    fn explain(&self, error: &WorldError) -> Fault {
        let below = |key: &str| if self.place.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place) };
        Fault::Input(match error {
            WorldError::Parameter { error, .. } => {
                let place = match error {
                    ParameterError::Type { name, .. } | ParameterError::Range { name, .. } => {
                        let alias = (self.entry.parameters)().iter().find(|d| d.name == name).and_then(|d| d.alias);
                        let written = alias.filter(|alias| self.parameters.contains_key(*alias)).unwrap_or(name);
                        below(&format!("params.{written}"))
                    }
                    _ => below("params"),
                };
                format!("{place}: {error}")
            }
            WorldError::Group { problem, .. } => format!("{}: {problem}", below("state")),
            other => format!("{}{}{other}", self.place, if self.place.is_empty() { "" } else { ": " }),
        })
    }

    /// The state of a world in the case's own form.
    pub fn state<R: Scalar, const D: usize>(&self, world: &World<R, D>) -> Map<String, Json> {
        let frame = world.frame();
        let rows = frame.rows_by_id();
        let mut state = Map::new();
        let list = |v: Vector<R, D>| Json::from(v.0.map(R::to_f64).to_vec());
        let each = |of: &dyn Fn(usize) -> Json| Json::from(rows.iter().map(|&row| of(row)).collect::<Vec<_>>());
        state.insert("pos".into(), each(&|row| list(frame.columns.position(row))));
        state.insert("vel".into(), each(&|row| list(frame.columns.velocity(row))));
        for (c, column) in frame.declared.iter().enumerate() {
            let values = &frame.columns.state[c];
            if let Some(whole) = column.name.strip_suffix("_x").filter(|_| D > 1) {
                let part = |axis| frame.declared.iter().position(|column| column.name == component(whole, axis));
                if let Some(parts) = (0..D).map(part).collect::<Option<Vec<usize>>>() {
                    let vector = |row: usize| {
                        Json::from(parts.iter().map(|&p| frame.columns.state[p][row].to_f64()).collect::<Vec<_>>())
                    };
                    state.insert(whole.into(), each(&vector));
                    continue;
                }
            }
            let other_part = (1..3).any(|axis| {
                let suffix = ["_x", "_y", "_z"][axis];
                column.name.strip_suffix(suffix).is_some_and(|whole| state.contains_key(whole))
            });
            if other_part {
                continue;
            }
            let count = |row: usize| {
                let value = values[row].to_f64();
                if value.fract() == 0.0 && value.abs() < 1e15 { Json::from(value as i64) } else { Json::from(value) }
            };
            let value = |row: usize| match column.kind {
                ColumnKind::Label(words) if !self.whole.iter().any(|key| key == column.name) => {
                    match words.get(values[row].to_f64() as usize) {
                        Some(&word) => Json::from(word),
                        None => count(row),
                    }
                }
                ColumnKind::Label(_) | ColumnKind::Count => count(row),
                ColumnKind::Quantity => Json::from(values[row].to_f64()),
            };
            state.insert(column.name.into(), each(&value));
        }
        if let Some(resources) = world.resources() {
            let eater = |consumer: &Option<u32>| consumer.map_or(Json::from(-1), Json::from);
            state.insert("food".into(), resources.place.iter().map(|&place| list(place)).collect());
            state.insert("eaten_by".into(), resources.consumer.iter().map(eater).collect());
        }
        state
    }
}

/// The name of one component of a vector that is kept as declared columns.
fn component(name: &str, axis: usize) -> String {
    format!("{name}{}", ["_x", "_y", "_z"].get(axis).unwrap_or(&""))
}

fn vector<R: Real, const D: usize>(numbers: &[f64]) -> Vector<R, D> {
    Vector(core::array::from_fn(|a| R::of(numbers.get(a).copied().unwrap_or(0.0))))
}

fn vectors<R: Real, const D: usize>(list: &[Vec<f64>]) -> Vec<Vector<R, D>> {
    list.iter().map(|numbers| vector(numbers)).collect()
}

fn of_length<'a>(at: &At<'a>, count: usize) -> Result<Vec<At<'a>>, Fault> {
    let list = at.list()?;
    if list.len() == count {
        Ok(list)
    } else {
        at.fault(format_args!("expected {count} entries, found {}", list.len()))
    }
}

fn points(at: &At<'_>, dimension: usize, count: Option<usize>) -> Result<Vec<Vec<f64>>, Fault> {
    let list = match count {
        Some(count) => of_length(at, count)?,
        None => at.list()?,
    };
    list.iter().map(|point| point.numbers(Some(dimension))).collect()
}

fn parameter(at: &At<'_>) -> Result<Value, Fault> {
    Ok(match at.value {
        Json::Bool(truth) => Value::Truth(*truth),
        Json::Number(_) => Value::Number(at.number()?),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(_) => Value::List(at.list()?.iter().map(parameter).collect::<Result<_, _>>()?),
        Json::Object(_) => {
            let below = |(name, value): (&str, At<'_>)| Ok((name.to_owned(), parameter(&value)?));
            Value::Table(at.entries()?.into_iter().map(below).collect::<Result<_, Fault>>()?)
        }
        Json::Null => return at.fault("expected a number, true or false, a text, a list, or an object"),
    })
}
