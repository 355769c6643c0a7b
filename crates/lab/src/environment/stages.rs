//! Hierarchical schemas as they are written: stages that are built one behind the other, each with what is wanted in it.

use super::behaviour::{Around, BehaviourForm, ConditionForm};
use super::candidates::{GridForm, schema_of, values_of};
use super::doors::{Door, DoorForm};
use super::relay::{Handover, Leg, Relay, when};
use super::workspace::{Region, point, segment};
use crate::file::{Desk, Named, Node};
use crate::form;
use crate::scenario::build::Wrong;
use measure::behaviours::{Behaviour, Setting};
use space::Segment;
use space::spelling::nearest;
use terrain::generate::odometer;
use terrain::hierarchy::{Composition, Port, Stage, compose, moved};
use terrain::{Construct, Geometry, Piece, Pose, Schema, TerrainError, Workspace};

/// The name of what is wanted of all stages together.
pub const WHOLE: &str = "whole";

form! {
    /// Where one goes in or out of a stage, in the frame of the stage.
    pub struct PortForm {
        /// The place, [x, y]. The entry of a stage comes to lie on the exit of the one before.
        at: Vec<f64> = need, "length", Any;
        /// The direction in which one passes it, counter-clockwise from the x axis.
        heading: f64 = [0.0], "deg", Any;
        /// The region in which a group is handed over. Nothing of another stage may stand in it.
        region: Region = need, "", Any;
    }
}

form! {
    /// When a group is handed over to a stage: enough of those who are still wanted are inside its entry region.
    pub struct HandoverForm {
        /// Least share of them, of those who are there.
        share: f64 = [0.9], "1", Within(0.0, 1.0);
        /// In so many steps in a row.
        steps: u64 = [10u64], "steps", Positive;
        /// Groups of the scenario that are still wanted; left out, all.
        groups: Vec<String> = [Vec::new()], "", Any;
        /// A condition in place of all this, over names of the stage.
        when: Option<ConditionForm> = none, "", Any;
    }
}

impl Default for HandoverForm {
    fn default() -> Self {
        Self { share: 0.9, steps: 10, groups: Vec::new(), when: None }
    }
}

form! {
    /// A stage: what is built in it, where a group comes in and goes out, what is wanted of it there. All is in the frame of
    /// the stage; that of the first is the workspace's.
    pub struct StageForm {
        /// Its name, for tables and the page.
        name: String = need, "", Any;
        /// The schema it is built by, at some values or at every combination of several.
        schema: GridForm = need, "", Any;
        /// Further walls of the stage, each [x0, y0, x1, y1].
        wall: Vec<Vec<f64>> = [Vec::new()], "length", Any;
        /// Where a group comes in.
        entry: PortForm = need, "", Any;
        /// Where it goes out; only the last stage may have none.
        exit: Option<PortForm> = none, "", Any;
        /// When a group is handed over to this stage from the one before; left out, as soon as 90 % are inside the entry
        /// region in 10 steps in a row. The first stage begins with the trial.
        handover: Option<HandoverForm> = none, "", Any;
        /// What is wanted of the group in this stage, over the steps from where it is handed over to it until it is handed on.
        behaviour: BehaviourForm = need, "", Any;
        /// Regions by name, for behaviours and handovers.
        region: Named<Region> = [Named::default()], "", Any;
        /// Doors by name: walls of the stage that open or shut when a condition holds, over names of the stage.
        door: Named<DoorForm> = [Named::default()], "", Any;
        /// Gates by name: [x0, y0, x1, y1].
        gate: Named<Vec<f64>> = [Named::default()], "length", Any;
        /// Places by name: [x, y].
        place: Named<Vec<f64>> = [Named::default()], "length", Any;
        /// Radius of the bodies for which there must be a way from the entry to that of the next stage; left out, that of the
        /// widest of the group.
        clearance: Option<f64> = none, "length", Positive;
    }
}

impl PortForm {
    fn port(&self) -> Result<Port, Wrong> {
        let pose = Pose { at: point(&self.at, "at")?, heading: self.heading };
        Ok(Port { pose, region: self.region.shape().map_err(|wrong| wrong.below("region"))? })
    }
}

/// Names of a stage and what they mean, in its frame.
#[derive(Clone, Debug, Default)]
struct Names {
    regions: Vec<(String, space::shape::Shape<f64, 2>)>,
    gates: Vec<(String, Segment)>,
    places: Vec<(String, terrain::Point)>,
    doors: Vec<Segment>,
}

/// A stage as resolved.
struct Planned {
    form: StageForm,
    schema: Box<dyn Schema>,
    axes: Vec<Vec<f64>>,
    walls: Vec<Segment>,
    entry: Port,
    exit: Option<Port>,
    names: Names,
}

/// Stages that are put together at every combination of their values: those of the last change fastest.
pub struct Staged {
    stages: Vec<Planned>,
    /// Radius of the widest body.
    widest: f64,
}

/// The stages of a file; what is wrong goes to the desk.
pub(super) fn staged(forms: &[StageForm], tree: &Node, desk: &mut Desk) -> Option<Staged> {
    let before = desk.problems.len();
    let mut stages = Vec::with_capacity(forms.len());
    if forms.is_empty() {
        desk.problem(&tree.place("candidates.stages"), "there is no stage", "at least one", "");
    }
    for (k, form) in forms.iter().enumerate() {
        let path = format!("candidates.stages.{k}");
        let mut wrong = |below: &str, what: String, expected: &str, help: &str| {
            desk.problem(&tree.place(&format!("{path}.{below}")), what, expected, help);
        };
        if form.name == WHOLE || forms[..k].iter().any(|other| other.name == form.name) {
            wrong("name", format!("`{}` is the name of something else", form.name), "a name of its own", "");
        }
        if k == 0 && form.handover.is_some() {
            wrong("handover", "the first stage begins with the trial".into(), "leave it out", "");
        }
        if k + 1 < forms.len() && form.exit.is_none() {
            let what = format!("`{}` has no exit to which `{}` could be joined", form.name, forms[k + 1].name);
            wrong("name", what, "an exit", "only the last stage may have none");
        }
        let schema = schema_of(&form.schema.id, &format!("{path}.schema.id"), tree, desk);
        let Some(schema) = schema else { continue };
        let values = values_of(&*schema, &form.schema.at, &format!("{path}.schema.at"), tree, desk);
        let axes = values.and_then(|values| form.schema.axes(&*schema, values, &format!("{path}.schema"), tree, desk));
        match (form.resolved(), axes) {
            (Ok((walls, entry, exit, names)), Some(axes)) => {
                stages.push(Planned { form: form.clone(), schema, axes, walls, entry, exit, names });
            }
            (Err(wrong), _) => {
                let place = tree.place(&format!("{path}.{}", wrong.path));
                desk.problem(&place, wrong.what, wrong.expected, wrong.help);
            }
            _ => {}
        }
    }
    (desk.problems.len() == before).then_some(Staged { stages, widest: 0.0 })
}

impl StageForm {
    fn resolved(&self) -> Result<(Vec<Segment>, Port, Option<Port>, Names), Wrong> {
        let lines = self.wall.iter().enumerate();
        let walls = lines.map(|(k, numbers)| segment(numbers, &format!("wall.{k}"))).collect::<Result<_, _>>()?;
        let entry = self.entry.port().map_err(|wrong| wrong.below("entry"))?;
        let exit = self.exit.as_ref().map(PortForm::port).transpose().map_err(|wrong| wrong.below("exit"))?;
        let mut names = Names::default();
        for (name, region) in &self.region.0 {
            let region = region.shape().map_err(|wrong| wrong.below(&format!("region.{name}")))?;
            names.regions.push((name.clone(), region));
        }
        for (name, numbers) in &self.gate.0 {
            names.gates.push((name.clone(), segment(numbers, &format!("gate.{name}"))?));
        }
        for (name, numbers) in &self.place.0 {
            names.places.push((name.clone(), point(numbers, &format!("place.{name}"))?));
        }
        for (name, door) in &self.door.0 {
            names.doors.push(door.wall().map_err(|wrong| wrong.below(&format!("door.{name}")))?);
        }
        Ok((walls, entry, exit, names))
    }
}

impl Staged {
    /// Names of the stages.
    pub fn names(&self) -> Vec<&str> {
        self.stages.iter().map(|stage| stage.form.name.as_str()).collect()
    }
    /// What is wanted of each, in a sentence.
    pub fn words(&self) -> Vec<String> {
        self.stages.iter().map(|stage| stage.form.behaviour.words()).collect()
    }
    /// Says how wide the widest body is.
    pub fn widest(&mut self, radius: f64) {
        self.widest = radius;
    }
    /// The first stage that needs to know it.
    pub fn unknown_width(&self) -> Option<usize> {
        let joined = &self.stages[..self.stages.len().saturating_sub(1)];
        joined.iter().position(|stage| stage.form.clearance.is_none())
    }
    /// How many combinations there are.
    pub fn count(&self) -> f64 {
        self.stages.iter().flat_map(|stage| &stage.axes).map(|axis| axis.len() as f64).product()
    }
    /// Names of the parameters that have several values, as `stage.parameter`.
    pub fn parameters(&self) -> Vec<String> {
        let of = |stage: &Planned| -> Vec<String> {
            let card = stage.schema.card();
            let varied = card.parameters.iter().zip(&stage.axes).filter(|(_, axis)| axis.len() > 1);
            varied.map(|(parameter, _)| format!("{}.{}", stage.form.name, parameter.name)).collect()
        };
        self.stages.iter().flat_map(of).collect()
    }
    /// The stages of a combination, put together; none beyond the last.
    ///
    /// # Errors
    /// What schemas and the composition refuse.
    pub fn composed(
        &self,
        workspace: &Workspace,
        seed: u64,
        attempt: u64,
    ) -> Result<Option<Composition>, TerrainError> {
        let all: Vec<Vec<f64>> = self.stages.iter().flat_map(|stage| stage.axes.iter().cloned()).collect();
        let Some(values) = odometer(&all, attempt) else { return Ok(None) };
        let (mut stages, mut parameters, mut from) = (Vec::new(), Vec::new(), 0);
        for planned in &self.stages {
            let own = &values[from..from + planned.axes.len()];
            from += planned.axes.len();
            let mut construct = planned.schema.construct(own, workspace, seed, attempt)?;
            let given = construct.provenance.parameters.drain(..);
            parameters.extend(given.map(|(name, value)| (format!("{}.{name}", planned.form.name), value)));
            let wall = |wall: &Segment| Piece { name: "wall".into(), geometry: vec![Geometry::Wall(*wall)] };
            construct.pieces.extend(planned.walls.iter().map(wall));
            stages.push(Stage {
                name: planned.form.name.clone(),
                construct,
                entry: planned.entry.clone(),
                exit: planned.exit.clone(),
                clearance: planned.form.clearance.unwrap_or(self.widest),
            });
        }
        let mut whole = compose(&stages)?;
        whole.construct.provenance.parameters = parameters;
        Ok(Some(whole))
    }
    /// What a stage's behaviours refer to: the names of the stage where it now is, then those that are there without it.
    fn setting(&self, k: usize, whole: &Composition, around: &dyn Fn(&Construct) -> Setting) -> Setting {
        let (planned, pose, part) = (&self.stages[k], &whole.poses[k], &whole.parts[k]);
        let mut setting = around(part);
        fn first<T>(own: Vec<(String, T)>, all: &mut Vec<(String, T)>) {
            all.retain(|(name, _)| own.iter().all(|(known, _)| known != name));
            all.splice(0..0, own);
        }
        let names = planned.names.clone();
        first(
            names.regions.into_iter().map(|(name, shape)| (name, moved(&shape, pose))).collect(),
            &mut setting.regions,
        );
        let line = |line: Segment| Segment { from: pose.place(line.from), to: pose.place(line.to) };
        first(names.gates.into_iter().map(|(name, gate)| (name, line(gate))).collect(), &mut setting.gates);
        first(names.places.into_iter().map(|(name, at)| (name, pose.place(at))).collect(), &mut setting.places);
        setting
    }
    /// The doors of a stage where it now is; `around` gives what is there around a construct. Wrongs carry paths from the file's
    /// root.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn doors(
        &self,
        k: usize,
        whole: &Composition,
        groups: &[String],
        around: &dyn Fn(&Construct) -> Setting,
    ) -> Result<Vec<Door>, Wrong> {
        let (planned, setting, pose) = (&self.stages[k], self.setting(k, whole, around), &whole.poses[k]);
        let one = |((name, form), wall): (&(String, DoorForm), &Segment)| {
            let wall = Segment { from: pose.place(wall.from), to: pose.place(wall.to) };
            form.door(name, wall, Around { setting: &setting, groups })
                .map_err(|wrong| wrong.below(&format!("candidates.stages.{k}.door.{name}")))
        };
        planned.form.door.0.iter().zip(&planned.names.doors).map(one).collect()
    }
    /// What is wanted, stage after stage; `around` gives what is there around a construct. Wrongs carry paths from the file's
    /// root.
    ///
    /// # Errors
    /// Names that are not there.
    pub fn relay(
        &self,
        whole: &Composition,
        groups: &[String],
        around: &dyn Fn(&Construct) -> Setting,
    ) -> Result<Relay, Wrong> {
        let mut legs: Vec<Leg> = Vec::with_capacity(self.stages.len());
        for (k, planned) in self.stages.iter().enumerate() {
            let setting = self.setting(k, whole, around);
            let below = |wrong: Wrong, key: &str| wrong.below(&format!("candidates.stages.{k}.{key}"));
            let names = Around { setting: &setting, groups };
            let name = &planned.form.name;
            let behaviour: Behaviour =
                planned.form.behaviour.plain(name, names).map_err(|wrong| below(wrong, "behaviour"))?;
            if let Some(before) = legs.last_mut() {
                let form = planned.form.handover.clone().unwrap_or_default();
                let ends = match &form.when {
                    Some(condition) => {
                        when(name, condition.plain(names).map_err(|wrong| below(wrong, "handover.when"))?)
                    }
                    None => Handover::Inside {
                        region: whole.entries[k].clone(),
                        types: types(&form.groups, groups).map_err(|wrong| below(wrong, "handover.groups"))?,
                        share: form.share,
                        steps: form.steps,
                    },
                };
                before.ends = Some(ends);
            }
            legs.push(Leg { behaviour, ends: None });
        }
        Ok(Relay { legs })
    }
}

/// The types of groups by their names.
fn types(names: &[String], groups: &[String]) -> Result<Vec<usize>, Wrong> {
    let place = |(k, name): (usize, &String)| {
        groups.iter().position(|known| known == name).ok_or_else(|| {
            let near = nearest(name, groups.iter().map(String::as_str));
            let help = near.map_or_else(String::new, |near| format!("did you mean `{near}`?"));
            Wrong::new(k.to_string(), format!("there is no group `{name}`"), "a group of the scenario").help(&help)
        })
    };
    names.iter().enumerate().map(place).collect()
}
