//! Members with parameters of their own, other parameters in a situation, and decisions now and then: kernels of one law, of which
//! each row is given its own.

use crate::adaptation::Adaptation;
use crate::engine::kernel::{Kernel, Scratch, Stages, View, Writer};
use crate::engine::plan::{GroupPlan, WorldError};
use crate::models::{self, Catalogue, Models, Prepared};
use crate::motion::{Motion, Start, Trace};
use crate::names::lasting;
use crate::parameters::{ParameterError, Scalar, Values};
use crate::sensing::robot::Memory;
use core::ops::Range;
use space::random::{Purpose, uniform};
use space::{Column, ColumnKind, Vector};

/// Counter of the draws of phases.
const PHASE: u64 = 1 << 45;

/// The laws of a group: one for all members or one each; then, if it adapts, as many that hold in the situation.
///
/// # Errors
/// Parameters that cannot be, and members that differ in what all of them must share.
pub(crate) fn laws<R: Scalar, const D: usize>(group: &GroupPlan<R, D>) -> Result<Vec<Prepared<R, D>>, WorldError>
where
    Models: Catalogue<R, D>,
{
    let wrong = |problem: String| WorldError::Group { group: group.name.clone(), problem };
    for varied in &group.varied {
        if varied.values.len() != group.count {
            let (found, count) = (varied.values.len(), group.count);
            return Err(wrong(format!("`{}` has {found} values for {count} members", varied.parameter)));
        }
    }
    let members = if group.varied.is_empty() { 1 } else { group.count.max(1) };
    let mut laws = Vec::new();
    let situations = [None, group.adapt.as_ref().map(|adapt| &adapt.parameters)];
    for (n, other) in situations.into_iter().enumerate().filter(|(n, other)| *n == 0 || other.is_some()) {
        for member in 0..members {
            let mut values = group.parameters.clone();
            for varied in &group.varied {
                if let Some(value) = varied.values.get(member) {
                    values.insert(varied.parameter.clone(), value.clone());
                }
            }
            values.extend(other.into_iter().flatten().map(|(name, value)| (name.clone(), value.clone())));
            let law = prepare(group, &values)?;
            let first: &Prepared<R, D> = laws.first().unwrap_or(&law);
            let shared = law.time_step == first.time_step
                && (law.body_radius == first.body_radius || group.radius.is_some())
                && law.contact == first.contact
                && law.bodies_meet == first.bodies_meet
                && law.velocity_is_step == first.velocity_is_step;
            if !shared {
                let who = if n == 0 { format!("member {member}") } else { "the adapted members".to_owned() };
                return Err(wrong(format!(
                    "{who} would have another step, body radius or contact than the first; these are those of the group"
                )));
            }
            laws.push(law);
        }
    }
    Ok(laws)
}

fn prepare<R: Scalar, const D: usize>(group: &GroupPlan<R, D>, values: &Values) -> Result<Prepared<R, D>, WorldError>
where
    Models: Catalogue<R, D>,
{
    match Models::prepare(&group.model, values, group.count) {
        Some(Ok(model)) => Ok(model),
        Some(Err(error)) => Err(of_parameter(group, error)),
        None => Err(match models::find(&group.model) {
            Some(entry) => WorldError::Dimension { id: group.model.clone(), asked: D, works: entry.dimensions },
            None => WorldError::Model {
                id: group.model.clone(),
                nearest: space::spelling::nearest(&group.model, models::LIST.iter().map(|e| e.card.id)),
            },
        }),
    }
}

fn of_parameter<R, const D: usize>(group: &GroupPlan<R, D>, error: ParameterError) -> WorldError {
    WorldError::Parameter { group: group.name.clone(), error }
}

/// The column that tells a parameter of which every member has its own value.
pub(crate) fn column_of<R, const D: usize>(group: &GroupPlan<R, D>, parameter: &str) -> Column {
    let unit = models::find(&group.model)
        .and_then(|entry| (entry.parameters)().into_iter().find(|descriptor| descriptor.name == parameter))
        .map_or("1", |descriptor| descriptor.unit);
    Column {
        name: lasting(&format!("parameter_{parameter}")),
        unit,
        kind: ColumnKind::Quantity,
        about: "Value of the parameter that the member was given.",
    }
}

/// Kernels of one law, of which each row is given its own.
pub(crate) struct Layered<R: Scalar, const D: usize> {
    /// Those of the usual situation, one or one for each member.
    pub(crate) usual: Vec<Box<dyn Kernel<R, D>>>,
    /// As many, which hold while the timer runs; or none.
    pub(crate) adapted: Vec<Box<dyn Kernel<R, D>>>,
    /// World column of the timer.
    pub(crate) timer: usize,
    /// Steps between two decisions and their phase, by member; empty where each decides in every step.
    intervals: Vec<(u64, u64)>,
    /// Whether a velocity is the step made.
    pub(crate) steps: bool,
}

impl<R: Scalar, const D: usize> Layered<R, D> {
    /// The kernel of a group, from those of its laws in the order of [`laws`].
    pub(crate) fn of(
        group: &GroupPlan<R, D>,
        mut kernels: Vec<Box<dyn Kernel<R, D>>>,
        seed: u64,
        first: u32,
        steps: bool,
        find: impl Fn(&str) -> Option<usize>,
    ) -> Box<dyn Kernel<R, D>> {
        if kernels.len() == 1 && group.intervals.is_empty() {
            return kernels.swap_remove(0);
        }
        let adapted = if group.adapt.is_some() { kernels.split_off(kernels.len() / 2) } else { Vec::new() };
        let phase = |(member, &interval): (usize, &u64)| {
            let interval = interval.max(1);
            let draw = uniform(seed, Purpose::Init, PHASE, (first + member as u32).wrapping_mul(8));
            (interval, (draw * interval as f64) as u64)
        };
        Box::new(Self {
            usual: kernels,
            adapted,
            timer: find(Adaptation::<R>::TIMER.name).unwrap_or(0),
            intervals: group.intervals.iter().enumerate().map(phase).collect(),
            steps,
        })
    }

    fn member(&self, view: &View<'_, R, D>, row: usize) -> usize {
        view.now.id[row].wrapping_sub(self.stages().first) as usize
    }
    /// The kernel of a row.
    fn kernel(&self, view: &View<'_, R, D>, row: usize) -> &dyn Kernel<R, D> {
        let adapted = !self.adapted.is_empty() && view.now.state[self.timer][row] > R::ZERO;
        let kernels = if adapted { &self.adapted } else { &self.usual };
        let member = if kernels.len() == 1 { 0 } else { self.member(view, row) };
        kernels[member].as_ref()
    }
    /// Whether a row decides in this step.
    fn is_due(&self, view: &View<'_, R, D>, row: usize) -> bool {
        match self.intervals.get(self.member(view, row)) {
            Some(&(interval, phase)) => (view.step + phase).is_multiple_of(interval),
            None => true,
        }
    }
    /// Straight on, with the columns of the row in the scratch.
    fn held(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> Motion<R, D> {
        let stages = self.stages();
        stages.load(view.now, row, scratch);
        let velocity = view.now.velocity(row);
        if self.steps { Motion::step(velocity) } else { Motion::new_velocity(velocity, stages.dt) }
    }
}

impl<R: Scalar, const D: usize> Kernel<R, D> for Layered<R, D> {
    fn stages(&self) -> &Stages<R, D> {
        self.usual[0].stages()
    }
    fn headings(&self) -> bool {
        self.usual.iter().chain(&self.adapted).any(|kernel| kernel.headings())
    }
    fn marks(&self) -> bool {
        self.usual.iter().chain(&self.adapted).any(|kernel| kernel.marks())
    }
    fn complete(&self, start: &mut Start<'_, R, D>) {
        let own = if self.usual.len() == 1 { 0 } else { start.member };
        self.usual[own].complete(start);
    }
    fn sweep(&self, view: &View<'_, R, D>, rows: Range<usize>, out: &Writer<'_, R, D>, scratch: &mut Scratch<R, D>) {
        let stages = self.stages();
        for row in rows {
            if !stages.mine(view.now.id[row]) {
                continue;
            }
            let kernel = self.kernel(view, row);
            if self.is_due(view, row) || view.dead(view.now, row) {
                kernel.sweep(view, row..row + 1, out, scratch);
                continue;
            }
            let wanted = self.held(view, row, scratch);
            let (place, velocity) = stages.perform(view, row, wanted, stages.dt, &scratch.own, &mut scratch.body);
            if velocity != wanted.velocity {
                kernel.performed(&mut scratch.own, velocity);
            }
            // SAFETY: rows of one sweep are written by it alone.
            unsafe {
                out.write(row, place, velocity);
                out.write_state(row, &stages.columns, &scratch.own);
                out.write_state(row, &stages.body_columns, &scratch.body);
            }
        }
    }
    fn one(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
    ) -> Motion<R, D> {
        if self.is_due(view, row) {
            return self.kernel(view, row).one(view, row, scratch, memory);
        }
        self.held(view, row, scratch)
    }
    fn explained(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        scratch: &mut Scratch<R, D>,
        memory: Option<&mut Memory<R>>,
        trace: &mut Trace<R, D>,
    ) -> Motion<R, D> {
        let decided = self.kernel(view, row).explained(view, row, scratch, memory, trace);
        if self.is_due(view, row) {
            return decided;
        }
        // what it perceives is told, and that it holds its heading
        trace.values.push(("held until the next decision", R::ONE, "1"));
        self.held(view, row, scratch)
    }
    fn performed(&self, own: &mut [R], velocity: Vector<R, D>) {
        self.usual[0].performed(own, velocity);
    }
    fn neighbours(&self, view: &View<'_, R, D>, row: usize, scratch: &mut Scratch<R, D>) -> usize {
        self.kernel(view, row).neighbours(view, row, scratch)
    }
}
