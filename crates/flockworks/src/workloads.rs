//! The benchmark workloads, as plans of worlds.

use crate::fault::{Fault, hint, wrong};
use crate::step::Precision;
use space::obstacles::Obstacle;
use space::random::{Purpose, uniform};
use space::shape::Shape;
use space::{Space, Vector};
use std::collections::BTreeMap;
use swarm::engine::{Driver, GroupPlan, Order, Placement, Sensing, Start};
use swarm::models::{Catalogue, Models};
use swarm::parameters::{Scalar, Value, Values};
use swarm::resources::{Gain, Metabolism, ResourcePlan, Respawn};
use swarm::sensing::{Ideal, Occlusion};
use swarm::{World, WorldPlan};

/// Seed of all workloads.
pub const SEED: u64 = 1;

/// A world whatever its precision and dimension.
pub trait Running {
    /// Makes steps.
    fn run(&mut self, steps: u64);
    /// Mean number of others in any named set, over every `every`-th agent.
    fn mean_neighbours(&mut self, every: usize) -> f64;
    /// Positions and velocities by id, all components.
    fn motion(&self) -> (Vec<Vec<f64>>, Vec<Vec<f64>>);
}

impl<R: Scalar, const D: usize> Running for World<R, D>
where
    Models: Catalogue<R, D>,
{
    fn run(&mut self, steps: u64) {
        World::run(self, steps);
    }
    fn mean_neighbours(&mut self, every: usize) -> f64 {
        World::mean_neighbours(self, every)
    }
    fn motion(&self) -> (Vec<Vec<f64>>, Vec<Vec<f64>>) {
        let frame = self.frame();
        let list = |v: Vector<R, D>| v.0.map(R::to_f64).to_vec();
        let rows = frame.rows_by_id();
        let positions = rows.iter().map(|&row| list(frame.columns.position(row))).collect();
        (positions, rows.iter().map(|&row| list(frame.columns.velocity(row))).collect())
    }
}

/// The law and the surroundings of a workload.
#[derive(Clone, Debug, PartialEq)]
enum Law {
    /// W1 and W1c: Vicsek with this noise amplitude.
    Vicsek { eta: f64 },
    /// W2: boids with unit headings.
    Boids,
    /// W3: the common benchmark of agent-based-model frameworks.
    Flocking,
    /// W4: a trial of the behaviour-selection study.
    Selection { midpoint: f64, growth: f64, nearest: Option<usize> },
    /// W5: a generation of foraging.
    Foraging,
    /// W6: a trial of group control.
    Control,
}

/// A workload at one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Workload {
    /// Name, as on the command line.
    pub name: String,
    /// Number of agents.
    pub agents: usize,
    /// Steps of one run.
    pub steps: u64,
    law: Law,
}

/// Names that a user may give, with what they stand for.
pub const NAMES: [(&str, &str); 15] = [
    ("W1", "Vicsek, 2-D, noise amplitude 4: near uniform"),
    ("W1c", "Vicsek, 2-D, noise amplitude 2: clustered"),
    ("W2", "boids with unit headings, 3-D"),
    ("W3", "flocking of agent-based-model frameworks, 2-D, one after the other"),
    ("W4", "a trial of the behaviour-selection study, all six variants"),
    ("W4/Align/6", "its variant Align with 6 neighbours"),
    ("W4/Prob/6", "its variant Prob with 6 neighbours"),
    ("W4/Attract/6", "its variant Attract with 6 neighbours"),
    ("W4/Align/199", "its variant Align with all neighbours"),
    ("W4/Prob/199", "its variant Prob with all neighbours"),
    ("W4/Attract/199", "its variant Attract with all neighbours"),
    ("W5", "a generation of competing flocks"),
    ("W6", "a trial of group control: boids among walls that hide"),
    ("models", "every model of the list, beside a plain loop where there is one"),
    ("compositions", "compositions of stock terms beside the compiled models of the same laws"),
];

impl Workload {
    /// The workloads that a name stands for, at the sizes asked for.
    ///
    /// # Errors
    /// An unknown name.
    pub fn named(name: &str, sizes: &[usize], steps: Option<u64>) -> Result<Vec<Self>, Fault> {
        let selection = |variant: &str, nearest: Option<usize>| {
            let (midpoint, growth) = match variant {
                "Align" => (0.0, 4.0),
                "Prob" => (10.0, 2.0),
                _ => (20.0, 4.0),
            };
            Law::Selection { midpoint, growth, nearest }
        };
        let laws: Vec<(&str, Law, &[usize])> = match name {
            "W1" => vec![(name, Law::Vicsek { eta: 4.0 }, &[10_000, 100_000])],
            "W1c" => vec![(name, Law::Vicsek { eta: 2.0 }, &[10_000, 100_000])],
            "W2" => vec![(name, Law::Boids, &[10_000, 100_000])],
            "W3" => vec![(name, Law::Flocking, &[200, 400])],
            "W4" | "W4/Align/6" | "W4/Prob/6" | "W4/Attract/6" | "W4/Align/199" | "W4/Prob/199" | "W4/Attract/199" => {
                let of = |&(full, _): &(&'static str, &str)| {
                    let mut parts = full.split('/').skip(1);
                    let (variant, count) = (parts.next()?, parts.next()?);
                    let nearest = if count == "6" { Some(6) } else { None };
                    (name == "W4" || name == full).then(|| (full, selection(variant, nearest), &[200][..]))
                };
                NAMES.iter().filter_map(of).collect()
            }
            "W5" => vec![(name, Law::Foraging, &[100])],
            "W6" => vec![(name, Law::Control, &[25])],
            other => {
                let names: Vec<&str> = NAMES.iter().map(|(name, _)| *name).collect();
                return wrong(format!("unknown workload `{other}`{}", hint(other, &names)));
            }
        };
        let mut list = Vec::new();
        for (name, law, usual) in laws {
            for &agents in if sizes.is_empty() { usual } else { sizes } {
                let steps = steps.unwrap_or(law.usual_steps(agents));
                list.push(Self { name: name.to_owned(), agents, steps, law: law.clone() });
            }
        }
        Ok(list)
    }

    /// The model it runs.
    pub fn model(&self) -> &'static str {
        match self.law {
            Law::Vicsek { .. } => "vicsek_1995",
            Law::Boids => "boids_unit_heading",
            Law::Flocking => "abm_flocking",
            Law::Selection { .. } => "behaviour_selection",
            Law::Foraging => "competing_flocks",
            Law::Control => "control_boids",
        }
    }
    /// Whether a run starts from the beginning each time (a trial), not from where the one before ended.
    pub fn is_trial(&self) -> bool {
        !matches!(self.law, Law::Vicsek { .. } | Law::Boids)
    }
    /// Precisions where none is asked for.
    pub fn usual_precision(&self) -> Precision {
        match self.law {
            Law::Vicsek { .. } | Law::Boids => Precision::F32,
            _ => Precision::F64,
        }
    }
    /// Whether more than one thread can be of use.
    pub fn threads_help(&self) -> bool {
        matches!(self.law, Law::Vicsek { .. } | Law::Boids)
    }

    /// The workload's world, at its start.
    ///
    /// # Errors
    /// A model that is not built in, or a size that cannot be.
    pub fn world(&self, precision: Precision, threads: usize) -> Result<Box<dyn Running>, Fault> {
        if swarm::models::find(self.model()).is_none() {
            let name = self.name.split('/').next().unwrap_or_default();
            return wrong(format!("{name}: model `{}` not built in", self.model()));
        }
        match (precision, &self.law) {
            (Precision::F32, Law::Boids | Law::Selection { .. }) => self.build::<f32, 3>(threads),
            (Precision::F64, Law::Boids | Law::Selection { .. }) => self.build::<f64, 3>(threads),
            (Precision::F32, _) => self.build::<f32, 2>(threads),
            (Precision::F64, _) => self.build::<f64, 2>(threads),
        }
    }

    fn build<R: Scalar, const D: usize>(&self, threads: usize) -> Result<Box<dyn Running>, Fault>
    where
        Models: Catalogue<R, D>,
    {
        let mut plan: WorldPlan<R, D> = match &self.law {
            Law::Vicsek { eta } => {
                let side = (self.agents as f64 / 4.0).sqrt();
                self.uniform(
                    side,
                    &[("radius", 1.0.into()), ("speed", 0.05.into()), ("eta", (*eta).into())],
                    Some("new_velocity"),
                )
            }
            Law::Boids => self.uniform((self.agents as f64 / 7.162).cbrt(), &[], None),
            Law::Flocking => {
                // small: 200 in a square of 100, radius 5; else the density of the large one: 400 in 150, radius 15
                let large = self.agents > 200;
                let side = if large { 150.0 * (self.agents as f64 / 400.0).sqrt() } else { 100.0 };
                let mut plan = self.uniform(side, &[("radius", if large { 15.0 } else { 5.0 }.into())], None);
                plan.driver = Driver::Sequential(Order::Random);
                plan
            }
            Law::Selection { midpoint, growth, nearest } => self.trial(*midpoint, *growth, *nearest)?,
            Law::Foraging => self.foraging(),
            Law::Control => self.control(),
        };
        plan.seed = SEED;
        plan.threads = threads;
        let world = World::new(plan).map_err(|error| Fault::Input(format!("{}: {error}", self.name)))?;
        Ok(Box::new(world))
    }

    fn uniform<R: Scalar, const D: usize>(
        &self,
        side: f64,
        values: &[(&str, Value)],
        position_update: Option<&str>,
    ) -> WorldPlan<R, D> {
        let mut parameters: Values = values.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
        if let Some(update) = position_update {
            parameters.insert("position_update".into(), update.into());
        }
        let sides = Vector([R::of(side); D]);
        let placement = Placement::Uniform { low: Vector::ZERO, high: sides };
        let group = GroupPlan::new("members", self.model(), parameters, self.agents, placement);
        WorldPlan::new(Space::periodic(sides.0), group)
    }

    /// A trial of the study, as it places obstacles and agents: spheres of radius 10 at a density of 1 percent.
    fn trial<R: Scalar, const D: usize>(
        &self,
        midpoint: f64,
        growth: f64,
        nearest: Option<usize>,
    ) -> Result<WorldPlan<R, D>, Fault> {
        let side = 335.0 * (self.agents as f64 / 200.0).cbrt();
        let (low, high) = ((side - side / 10.0) / 2.0, (side + side / 10.0) / 2.0);
        let radius = 10.0;
        let count = (0.01 * side.powi(3) / (core::f64::consts::PI * f64::powi(radius, 3)) + 0.5) as usize;
        let drawn = |purpose: Purpose, attempt: u64, low: f64, high: f64| -> [f64; 3] {
            core::array::from_fn(|a| low + (high - low) * uniform(SEED, purpose, attempt, a as u32))
        };
        let apart = |p: &[f64; 3], q: &[f64; 3]| (0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>().sqrt();
        let mut obstacles: Vec<[f64; 3]> = Vec::new();
        let mut attempt = 0;
        while obstacles.len() < count && attempt < 2000 * count as u64 + 10_000 {
            let centre = drawn(Purpose::Obstacles, attempt, radius, side - radius);
            let nearest = core::array::from_fn(|a| centre[a].clamp(low, high));
            if apart(&centre, &nearest) >= radius && obstacles.iter().all(|o| apart(&centre, o) >= 2.0 * radius) {
                obstacles.push(centre);
            }
            attempt += 1;
        }
        let mut agents: Vec<[f64; 3]> = Vec::new();
        attempt = 0;
        while agents.len() < self.agents && attempt < 2000 * self.agents as u64 + 10_000 {
            let place = drawn(Purpose::Init, attempt, low, high);
            if agents.iter().all(|other| apart(&place, other) >= 2.0) {
                agents.push(place);
            }
            attempt += 1;
        }
        if agents.len() < self.agents || obstacles.len() < count {
            return wrong(format!("{}: {} agents cannot be placed", self.name, self.agents));
        }
        let pi = core::f64::consts::PI;
        let start = |slot: u32| uniform(SEED, Purpose::Init, 1 << 40, slot);
        let (theta, phi) = (-pi + 2.0 * pi * start(0), -pi / 2.0 + pi * start(1));
        let five = 5f64.to_radians();
        let offset =
            |i: usize, slot: u32| five * (2.0 * uniform(SEED, Purpose::Init, (1 << 40) + 1 + i as u64, slot) - 1.0);
        let wrapped = |angle: f64| angle - 2.0 * pi * ((angle - pi) / (2.0 * pi)).ceil();
        let columns = BTreeMap::from([
            ("theta".to_owned(), (0..self.agents).map(|i| wrapped(theta + offset(i, 0))).collect()),
            ("phi".to_owned(), (0..self.agents).map(|i| (phi + offset(i, 1)).clamp(-pi / 2.0, pi / 2.0)).collect()),
        ]);
        let at = |p: &[f64; 3]| Vector(core::array::from_fn(|a| R::of(p.get(a).copied().unwrap_or(0.0))));
        let position = agents.iter().map(at).collect();
        let nearest = nearest.unwrap_or(self.agents.saturating_sub(1));
        let parameters = [("M", midpoint), ("K", growth), ("N", nearest as f64)];
        let parameters = parameters.iter().map(|&(name, value)| (name.to_owned(), value.into())).collect();
        let placement = Placement::Given(Start { position, velocity: None, columns });
        let group = GroupPlan::new("members", self.model(), parameters, self.agents, placement);
        let mut plan = WorldPlan::new(Space::walled([R::of(side); D]), group);
        let ball = |centre| Obstacle::new(Shape::Ball { centre: at(centre), radius: R::of(radius) });
        plan.obstacles = obstacles.iter().map(ball).collect();
        Ok(plan)
    }

    /// A generation: two flocks of equal size and 20 items in a square of 300 with walls.
    fn foraging<R: Scalar, const D: usize>(&self) -> WorldPlan<R, D> {
        let side = 300.0;
        let (low, high) = (Vector::ZERO, Vector([R::of(side); D]));
        let first = self.agents / 2;
        let flock = (0..self.agents).map(|i| Value::from(usize::from(i >= first))).collect();
        let parameters = Values::from([("flock".to_owned(), Value::List(flock))]);
        let group = GroupPlan::new("boids", self.model(), parameters, self.agents, Placement::Uniform { low, high });
        let mut plan = WorldPlan::new(Space::walled(high.0), group);
        let item = |k: u64| {
            let draw = |a: usize| uniform(SEED, Purpose::Environment, u64::MAX - 1, 8 * k as u32 + a as u32);
            Vector(core::array::from_fn(|a| R::of(side * draw(a))))
        };
        let gain = |column: &str, amount: f64| Gain {
            column: column.to_owned(),
            amount: R::of(amount),
            capacity: R::of(100.0),
        };
        plan.resources = Some(ResourcePlan {
            items: (0..20).map(item).collect(),
            within: R::of(5.0),
            gains: vec![gain("energy", 40.0), gain("health", 10.0)],
            respawn: Respawn::After(0.0),
            metabolism: Some(Metabolism::default()),
            ..ResourcePlan::default()
        });
        plan
    }
}

impl Workload {
    /// A group that sets out from the left of a field of ten walls, which hide what is behind them.
    fn control<R: Scalar, const D: usize>(&self) -> WorldPlan<R, D> {
        let at = |x: f64, y: f64| Vector(core::array::from_fn(|a| R::of([x, y].get(a).copied().unwrap_or(0.0))));
        let columns = (self.agents as f64).sqrt().ceil().max(1.0) as usize;
        let places = (0..self.agents).map(|k| at(-80.0 - 2.0 * (k / columns) as f64, 2.0 * (k % columns) as f64 - 4.0));
        let start = Start {
            position: places.collect(),
            velocity: Some(vec![at(1.0, 0.0); self.agents]),
            columns: BTreeMap::new(),
        };
        let mut group = GroupPlan::new("boids", self.model(), Values::new(), self.agents, Placement::Given(start));
        group.sensing = Sensing::Ideal(Ideal { occlusion: Occlusion::Obstacles, ..Ideal::default() });
        let mut plan = WorldPlan::new(Space::open(), group);
        for k in 0..10 {
            let draw = |slot: u32| uniform(SEED, Purpose::Environment, k, slot);
            let (x, y, angle) = (120.0 * draw(0) - 60.0, 80.0 * draw(1) - 40.0, core::f64::consts::PI * draw(2));
            let (along, up) = (10.0 * angle.cos(), 10.0 * angle.sin());
            let (from, to) = (at(x - along, y - up), at(x + along, y + up));
            plan.obstacles.push(Obstacle::new(Shape::Segment { from, to }));
        }
        plan
    }
}

impl Law {
    fn usual_steps(&self, agents: usize) -> u64 {
        let agents = agents.max(1) as u64;
        match self {
            Self::Vicsek { .. } | Self::Boids => (4_000_000 / agents).clamp(6, 200),
            Self::Flocking => (1_000_000 / agents).clamp(4, 100),
            Self::Selection { .. } => 6000,
            Self::Foraging => 80,
            Self::Control => 500,
        }
    }
}
