//! For the closed forms in the model files: a few agents, given parameters, one or more steps.

use crate::engine::{Driver, GroupPlan, IndexChoice, Placement, Start, World, WorldPlan};
use crate::models::{Catalogue, Models};
use crate::motion::Injected;
use crate::parameters::{Value, Values};
use space::obstacles::Obstacle;
use space::shape::Shape;
use space::{Space, Vector};

/// A model with parameters in a space, about to be asked.
pub(crate) struct Oracle<const D: usize> {
    pub(crate) plan: WorldPlan<f64, D>,
    injected: Injected,
    live: bool,
}

impl<const D: usize> Oracle<D>
where
    Models: Catalogue<f64, D>,
{
    /// A model with its default parameters in open space; random quantities take their neutral values.
    pub(crate) fn new(model: &str) -> Self {
        let group = GroupPlan::new("g", model, Values::new(), 0, Placement::Given(Start::default()));
        Self { plan: WorldPlan::new(Space::open(), group), injected: Injected::default(), live: false }
    }
    pub(crate) fn set(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.plan.groups[0].parameters.insert(name.to_owned(), value.into());
        self
    }
    pub(crate) fn space(mut self, space: Space<f64, D>) -> Self {
        self.plan.space = space;
        self
    }
    pub(crate) fn obstacle(mut self, shape: Shape<f64, D>) -> Self {
        self.plan.obstacles.push(Obstacle::new(shape));
        self
    }
    pub(crate) fn inject(mut self, name: &str, values: &[f64]) -> Self {
        self.injected.values.insert(name.to_owned(), values.iter().map(|&v| vec![v]).collect());
        self
    }
    /// Draws random quantities instead of taking neutral values.
    pub(crate) fn live(mut self) -> Self {
        self.live = true;
        self
    }
    /// Supplies a vector quantity.
    pub(crate) fn inject_vectors(mut self, name: &str, values: &[[f64; D]]) -> Self {
        self.injected.values.insert(name.to_owned(), values.iter().map(|v| v.to_vec()).collect());
        self
    }
    /// Gives the members a declared column at the start.
    pub(crate) fn column(mut self, name: &str, values: &[f64]) -> Self {
        if let Placement::Given(start) = &mut self.plan.groups[0].placement {
            start.columns.insert(name.to_owned(), values.to_vec());
        }
        self
    }
    pub(crate) fn driver(mut self, driver: Driver) -> Self {
        self.plan.driver = driver;
        self
    }
    /// Positions with velocities.
    pub(crate) fn world(mut self, agents: &[([f64; D], [f64; D])]) -> World<f64, D> {
        self.plan.groups[0].count = agents.len();
        if let Placement::Given(start) = &mut self.plan.groups[0].placement {
            start.position = agents.iter().map(|a| Vector(a.0)).collect();
            start.velocity = Some(agents.iter().map(|a| Vector(a.1)).collect());
        }
        self.plan.index = IndexChoice::Automatic;
        let mut world = World::new(self.plan).unwrap_or_else(|error| unreachable!("{error}"));
        if !self.live {
            world.inject(self.injected);
        }
        world
    }
    /// The world after one step.
    pub(crate) fn step(self, agents: &[([f64; D], [f64; D])]) -> World<f64, D> {
        let mut world = self.world(agents);
        world.step();
        world
    }
}

/// Asserts that a model with the parameter `eta` moves a small crowd in a torus as another one does, to the bit.
#[track_caller]
pub(crate) fn same_trajectories(model: &str, as_model: &str) {
    let place = |k: usize| (k as f64 * 0.7) % 3.0;
    let agents: Vec<_> = (0..20).map(|k| ([place(k), place(3 * k)], [0.03, 0.0])).collect();
    let hash = |model: &str| {
        let oracle = Oracle::new(model).set("eta", 1.2).space(Space::periodic([3.0, 3.0])).live();
        let mut world = oracle.world(&agents);
        world.run(50);
        world.frame().hash()
    };
    assert_eq!(hash(model), hash(as_model));
}

/// Asserts that a vector is close to what is expected.
#[track_caller]
pub(crate) fn close<const D: usize>(found: Vector<f64, D>, expected: [f64; D]) {
    assert!((found - Vector(expected)).length() < 1e-6, "{found:?}, expected {expected:?}");
}
