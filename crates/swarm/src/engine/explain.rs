//! One agent's step, told stage by stage.
//!
//! The decision is computed by the code that every step runs, with a [`Trace`] in it that the law writes to; what became
//! of it is read from the world after a real step, which is then taken back. So an explanation cannot tell anything else
//! than what happens, and changes nothing.

use crate::engine::kernel::{Scratch, Sensing, View};
use crate::engine::plan::Driver;
use crate::engine::world::{Clocks, World};
use crate::motion::{Choice, Motion, Trace};
use crate::parameters::Scalar;
use crate::physics::{Met, Mobility};
use crate::resources::Resources;
use crate::sensing::robot::Memory;
use crate::sensing::scanner::Origin;
use space::obstacles::Obstacles;
use space::{ColumnKind, Columns, Grid, LiveGrid, Real, Vector};

/// Everything that the engine computes for one agent in the step that begins at the present state. Lengths and times in
/// the units of the parameters, angles in radians.
///
/// Under a sequential driver this is the agent's own turn: others that act before it in the step have moved already.
/// Under an asynchronous driver it is the tick that begins now; where the agent's clock is not due it decides nothing
/// ([`Self::decides`]), and what it wants is the motion that it decided last.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// Its id.
    pub agent: u32,
    /// Name of its group.
    pub group: String,
    /// Id of its model.
    pub model: String,
    /// Number of the step.
    pub step: u64,
    /// Time at its beginning.
    pub time: f64,
    /// Whether it decides in this step: not if it is dead, or its clock is not due.
    pub decides: bool,
    /// Position before.
    pub position: Vec<f64>,
    /// Velocity before.
    pub velocity: Vec<f64>,
    /// Unit vector of the velocity; zero at rest.
    pub heading: Vec<f64>,
    /// Body radius.
    pub radius: f64,
    /// How it senses.
    pub sensing: Sensed,
    /// Rays of its scanner, from the rightmost to the leftmost; none where it has no scanner.
    pub rays: Vec<Ray>,
    /// Detected members, as far as its law's sets reach.
    pub detected: Vec<Seen>,
    /// The named sets of its law.
    pub sets: Vec<ExplainedSet>,
    /// Obstacles and walls that its law is given.
    pub obstacles: Vec<SeenObstacle>,
    /// Named vectors of the motion computation.
    pub components: Vec<Component>,
    /// Their unit.
    pub unit: &'static str,
    /// What the components add up to, where the law is their sum.
    pub sum: Option<Vec<f64>>,
    /// Numbers and words by stage.
    pub values: Vec<Value>,
    /// Behaviours among which the law chose.
    pub choice: Vec<Choice>,
    /// Velocity and displacement that it wants.
    pub wanted: Wanted,
    /// Where its body would be, and with which velocity, if nothing were in its way.
    pub unhindered: Placed,
    /// Where it is after the step, and with which velocity.
    pub performed: Placed,
    /// What it met.
    pub met: Met,
}

/// How an agent senses.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensed {
    /// Whether it scans with rays.
    pub scanner: bool,
    /// Range; `None`: unlimited.
    pub range: Option<f64>,
    /// Full field of view, rad; `None`: all round.
    pub field_of_view: Option<f64>,
}

/// A ray of a scanner.
#[derive(Clone, Debug, PartialEq)]
pub struct Ray {
    /// From the agent to where it ends: at what the reading shows, or at the longest range where there is no reading.
    pub to: Vec<f64>,
    /// What it truly met first.
    pub hit: Origin,
    /// Whether it met something that the reading does not show.
    pub lost: bool,
}

/// A detected member.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// From the agent to where it perceives the member.
    pub offset: Vec<f64>,
    /// Who it is; `None` behind a scanner, which does not show that.
    pub id: Option<u32>,
}

/// A named set of the selection stage.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplainedSet {
    /// Its name.
    pub name: &'static str,
    /// Who is in it, in words.
    pub rule: String,
    /// Whether it decides about this motion.
    pub acts: bool,
    /// Least distance of its members, where the rule is a shell.
    pub low: Option<f64>,
    /// First distance that is too far, where the rule is a shell.
    pub high: Option<f64>,
    /// Full opening about the heading, rad, where the rule is a cone.
    pub angle: Option<f64>,
    /// Its members.
    pub members: Vec<Seen>,
}

/// An obstacle or wall.
#[derive(Clone, Debug, PartialEq)]
pub struct SeenObstacle {
    /// From the agent to the nearest point of its surface.
    pub offset: Vec<f64>,
    /// Distance to the surface, negative inside.
    pub distance: f64,
    /// Unit vector to free space.
    pub away: Vec<f64>,
}

/// A named vector of the motion computation.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name.
    pub name: &'static str,
    /// The vector, in [`Explanation::unit`].
    pub vector: Vec<f64>,
}

/// A named number or word of a stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// The stage: sensing, detection, selection, motion, physics, or state.
    pub stage: &'static str,
    /// Its name.
    pub name: String,
    /// What it is.
    pub value: Told,
    /// Its unit; `-` for words.
    pub unit: &'static str,
}

/// A number or a word.
#[derive(Clone, Debug, PartialEq)]
pub enum Told {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

/// A wanted motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Velocity after the step.
    pub velocity: Vec<f64>,
    /// Displacement in the step.
    pub displacement: Vec<f64>,
}

/// A place with a velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Position.
    pub position: Vec<f64>,
    /// Velocity.
    pub velocity: Vec<f64>,
}

fn plain<R: Scalar, const D: usize>(vector: Vector<R, D>) -> Vec<f64> {
    vector.0.iter().map(|v| v.to_f64()).collect()
}

/// What a step changes.
#[derive(Clone)]
struct Kept<R, const D: usize> {
    now: Columns<R, D>,
    heading: [Vec<R>; D],
    grid: Option<Grid<R, D>>,
    live: Option<LiveGrid<R, D>>,
    rows: Vec<u32>,
    obstacles: Obstacles<R, D>,
    resources: Option<Resources<R, D>>,
    clocks: Clocks<R, D>,
    memory: Vec<Memory<R>>,
    met: Vec<Met>,
    met_total: [u64; 4],
    errors: Vec<crate::detection::readings::ErrorCount>,
    step: u64,
    time: f64,
}

/// Collects values of one stage after the other.
struct Values(Vec<Value>);

impl Values {
    fn number(&mut self, stage: &'static str, name: impl Into<String>, value: f64, unit: &'static str) {
        self.0.push(Value { stage, name: name.into(), value: Told::Number(value), unit });
    }
    fn word(&mut self, stage: &'static str, name: impl Into<String>, word: impl Into<String>) {
        self.0.push(Value { stage, name: name.into(), value: Told::Word(word.into()), unit: "-" });
    }
}

impl<R: Scalar, const D: usize> World<R, D> {
    /// Explains what an agent does in the step that begins at the present state; `None` where there is no such agent.
    /// The world is the same afterwards, to the last bit. It takes as long as a step, and copies the state.
    pub fn explain(&mut self, id: u32) -> Option<Explanation> {
        (self.compiled.explain)(self, id)
    }
    pub(crate) fn explained(&mut self, id: u32) -> Option<Explanation> {
        if id as usize >= self.now.len() {
            return None;
        }
        let kept = self.keep();
        let explanation = self.decision(id);
        self.put_back(kept.clone());
        let explanation = explanation.map(|mut explanation| {
            self.step();
            self.tell_performed(&mut explanation);
            explanation
        });
        self.put_back(kept);
        explanation
    }

    fn keep(&self) -> Kept<R, D> {
        Kept {
            now: self.now.clone(),
            heading: self.heading.clone(),
            grid: self.grid.clone(),
            live: self.live.clone(),
            rows: self.rows.clone(),
            obstacles: self.obstacles.clone(),
            resources: self.resources.clone(),
            clocks: self.clocks.clone(),
            memory: self.memory.clone(),
            met: self.met.clone(),
            met_total: self.met_total,
            errors: self.scratch.iter().map(|scratch| scratch.robot.errors).collect(),
            step: self.step,
            time: self.time,
        }
    }

    fn put_back(&mut self, kept: Kept<R, D>) {
        self.now = kept.now;
        self.heading = kept.heading;
        self.grid = kept.grid;
        self.live = kept.live;
        self.rows = kept.rows;
        self.obstacles = kept.obstacles;
        self.resources = kept.resources;
        self.clocks = kept.clocks;
        self.memory = kept.memory;
        self.met = kept.met;
        self.met_total = kept.met_total;
        for (scratch, errors) in self.scratch.iter_mut().zip(kept.errors) {
            scratch.robot.errors = errors;
        }
        self.step = kept.step;
        self.time = kept.time;
    }

    /// Explains up to the motion that is made if nothing is in the way. Leaves the world in the middle of the step.
    fn decision(&mut self, id: u32) -> Option<Explanation> {
        self.obstacles.advance(self.time);
        let mut scratch = self.scratch.pop()?;
        let mut stale = 0;
        match self.driver {
            Driver::Synchronous => {}
            Driver::Sequential(order) => {
                for earlier in self.sequence(order).into_iter().take_while(|&earlier| earlier != id) {
                    self.take_turn(earlier, &mut scratch);
                }
            }
            Driver::Asynchronous { tick, delay, .. } => stale = self.keep_history(tick, delay),
        }
        let explanation = self.decided(id, stale, &mut scratch);
        self.scratch.push(scratch);
        Some(explanation)
    }

    fn decided(&self, id: u32, stale: usize, scratch: &mut Scratch<R, D>) -> Explanation {
        let row = self.row_of(id);
        let group = &self.groups[self.group_of(id)];
        let stages = group.kernel.stages();
        let mut view = self.view();
        let (position, velocity) = (self.now.position(row), self.now.velocity(row));
        let heading = velocity.unit();
        let alive = view.mortality.is_none_or(|c| self.now.state[c][row] > R::ZERO);
        let mut values = Values(Vec::new());
        let (mut decides, mut dt) = (alive, self.dt);
        if let Driver::Asynchronous { tick, .. } = self.driver {
            decides &= self.clocks.is_due(row, self.time, tick);
            dt = R::of(tick);
            self.clocks.age(&mut view, stale);
        }
        let mut trace = Trace::default();
        let wanted = if decides {
            let mut memory = self.memory.get(id as usize).cloned();
            let wanted = group.kernel.explained(&view, row, scratch, memory.as_mut(), &mut trace);
            match self.driver {
                // what is decided is a motion per time, performed tick by tick
                Driver::Asynchronous { .. } => {
                    Motion { displacement: wanted.displacement * (R::ONE / self.dt) * dt, ..wanted }
                }
                _ => wanted,
            }
        } else {
            stages.load(&self.now, row, scratch);
            match self.clocks.command.get(row) {
                Some(command) if alive => Motion { displacement: command.displacement * dt, ..*command },
                _ => Motion { velocity, displacement: Vector::ZERO },
            }
        };
        let (unhindered, performed) = if alive {
            stages.perform(&view, row, wanted, dt, &scratch.own, &mut scratch.body)
        } else {
            (position, velocity)
        };
        let mut explanation = Explanation {
            agent: id,
            group: group.name.clone(),
            model: group.model.clone(),
            step: self.step,
            time: self.time,
            decides,
            position: plain(position),
            velocity: plain(velocity),
            heading: plain(heading),
            radius: group.radius.to_f64(),
            sensing: match &stages.sensing {
                Sensing::Ideal(ideal) => Sensed {
                    scanner: false,
                    range: ideal.range.map(Real::to_f64),
                    field_of_view: ideal.field_of_view.map(Real::to_f64),
                },
                Sensing::Scanner(robot) => Sensed {
                    scanner: true,
                    range: Some(robot.scanner_range().to_f64()),
                    field_of_view: Some(
                        (robot.scanner.resolution() * R::count(robot.scanner.readings().saturating_sub(1))).to_f64(),
                    ),
                },
            },
            rays: Vec::new(),
            detected: Vec::new(),
            sets: stages
                .sets
                .iter()
                .map(|set| {
                    let shell = set.perception.shell();
                    ExplainedSet {
                        name: set.name,
                        rule: set.perception.words(),
                        acts: false,
                        low: shell.low.map(Real::to_f64),
                        high: shell.high.map(Real::to_f64),
                        angle: shell.angle.map(Real::to_f64),
                        members: Vec::new(),
                    }
                })
                .collect(),
            obstacles: Vec::new(),
            components: trace.components.iter().map(|&(name, v)| Component { name, vector: plain(v) }).collect(),
            unit: trace.unit,
            sum: trace.sum.map(plain),
            values: Vec::new(),
            choice: trace.choice,
            wanted: Wanted { velocity: plain(wanted.velocity), displacement: plain(wanted.displacement) },
            unhindered: Placed { position: plain(unhindered), velocity: plain(performed) },
            performed: Placed { position: plain(position), velocity: plain(velocity) },
            met: Met::Nothing,
        };
        if decides {
            self.tell_perceived(&mut explanation, &view, scratch, &mut values);
            for (s, set) in explanation.sets.iter_mut().enumerate() {
                set.acts = !set.members.is_empty() && trace.acts.is_none_or(|bits| bits >> s & 1 == 1);
            }
            for (name, value, unit) in trace.values {
                values.number("motion", name, value.to_f64(), unit);
            }
            if let Some((_, aside)) = stages.computation_error(&view, row) {
                values.number("motion", "error of computation", aside.to_f64(), "rad");
            }
        } else {
            values.word("motion", "decision", if alive { "none: its clock is not due" } else { "none: it is dead" });
        }
        if alive {
            let turn = heading.angle_to(wanted.displacement);
            values.number("physics", "turn wanted", turn.to_f64(), "rad");
            match &stages.mobility {
                Mobility::Ideal => {}
                Mobility::ConstantSpeed(speed) => {
                    values.number("physics", "speed of the body", speed.to_f64(), "length/time");
                }
                Mobility::TurnLimited { rate, vertical } => {
                    values.number("physics", "turn allowed", (*rate * dt).to_f64(), "rad");
                    if let Some(vertical) = vertical {
                        values.number("physics", "rise allowed", (*vertical * dt).to_f64(), "rad");
                    }
                }
                Mobility::DifferentialDrive(drive) => {
                    values.number("physics", "turn allowed", (drive.turn_rate * dt).to_f64(), "rad");
                    values.number("physics", "speed allowed", drive.forward_speed.to_f64(), "length/time");
                }
            }
            if let Some((_, aside, faster)) = stages.execution_error(&view, row) {
                values.number("physics", "error of the direction", aside.to_f64(), "rad");
                values.number("physics", "factor of the speed", faster.to_f64(), "1");
            }
            values.number("physics", "turn performed", heading.angle_to(performed).to_f64(), "rad");
            values.number("physics", "speed wanted", wanted.velocity.length().to_f64(), "length/time");
            values.number("physics", "speed performed", performed.length().to_f64(), "length/time");
        }
        explanation.values = values.0;
        explanation
    }

    /// What the first three stages left in the buffers of a decision.
    fn tell_perceived(
        &self,
        explanation: &mut Explanation,
        view: &View<'_, R, D>,
        scratch: &Scratch<R, D>,
        values: &mut Values,
    ) {
        let stages = self.groups[self.group_of(explanation.agent)].kernel.stages();
        if let Sensing::Scanner(robot) = &stages.sensing {
            let scan = &scratch.robot.scan;
            let ends = scan.ranges.iter().zip(&scan.directions).zip(&scan.origin);
            explanation.rays.extend(ends.map(|((&range, &direction), &hit)| {
                let shown = range.finite();
                let end = direction * if shown { range } else { robot.scanner_range() };
                Ray { to: plain(end), hit, lost: !shown && hit != Origin::Nothing }
            }));
            let lost = explanation.rays.iter().filter(|ray| ray.lost).count();
            values.number("sensing", "readings", explanation.rays.len() as f64, "1");
            values.number("sensing", "readings lost", lost as f64, "1");
            values.number("detection", "points of obstacles", scratch.robot.readings.obstacles.len() as f64, "1");
        }
        for (other, offset, sets) in scratch.detected() {
            let id = match &stages.sensing {
                Sensing::Scanner(_) => None,
                // obstacles among them are nobody
                Sensing::Ideal(_) if stages.virtual_members => {
                    Some(scratch.sensed.id[other]).filter(|&id| (id as usize) < view.others.len())
                }
                // headings that are sensed with errors are copied, with the ids beside them
                Sensing::Ideal(ideal) if ideal.noise.heading > R::ZERO => Some(scratch.sensed.id[other]),
                Sensing::Ideal(_) => Some(view.others.id[other]),
            };
            let seen = Seen { offset: plain(offset), id };
            for (s, set) in explanation.sets.iter_mut().enumerate() {
                if sets >> s & 1 == 1 {
                    set.members.push(seen.clone());
                }
            }
            explanation.detected.push(seen);
        }
        values.number("detection", "members", explanation.detected.len() as f64, "1");
        for set in &explanation.sets {
            values.number("selection", set.name, set.members.len() as f64, "1");
        }
        if stages.obstacle_reach.is_some() {
            explanation.obstacles.extend(scratch.obstacles.iter().map(|near| SeenObstacle {
                offset: plain(near.offset),
                distance: near.distance.to_f64(),
                away: plain(near.away),
            }));
            values.number("selection", "obstacles and walls", explanation.obstacles.len() as f64, "1");
        }
    }

    /// What became of the agent, in a world that has made the step.
    fn tell_performed(&self, explanation: &mut Explanation) {
        let id = explanation.agent;
        let row = self.row_of(id);
        let performed = Placed { position: plain(self.now.position(row)), velocity: plain(self.now.velocity(row)) };
        explanation.performed = performed;
        explanation.met = self.met.get(id as usize).copied().unwrap_or(Met::Nothing);
        let mut values = Values(core::mem::take(&mut explanation.values));
        let group = &self.groups[self.group_of(id)];
        for (c, column) in self.declared.iter().enumerate().filter(|(c, _)| group.declares(*c)) {
            let value = self.now.state[c][row].to_f64();
            match column.kind {
                ColumnKind::Label(words) => {
                    values.word("state", column.name, words.get(value as usize).copied().unwrap_or("none"));
                }
                ColumnKind::Quantity | ColumnKind::Count => values.number("state", column.name, value, column.unit),
            }
        }
        if let Some(resources) = &self.resources {
            let eaten = resources.consumer.iter().filter(|&&by| by == Some(id)).count();
            values.number("state", "items consumed", eaten as f64, "1");
        }
        explanation.values = values.0;
    }
}
