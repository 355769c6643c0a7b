//! The world: columns, index, obstacles, resources, groups.

use crate::adaptation::Adaptation;
use crate::conduct::stored;
use crate::detection::readings::ErrorCount;
use crate::engine::beside::{Adapts, Pace, Taxis, Told};
use crate::engine::coarse::Coarse;
use crate::engine::compiled::Compiled;
use crate::engine::conduct::Conduct;
use crate::engine::kernel::{Body, Close, Index, Kernel, Scratch, Sensing, Stages, View};
use crate::engine::layered::{Layered, column_of, laws};
use crate::engine::plan::{Clock, ClockPlan, Driver, GroupPlan, IndexChoice, Phase, Placement, WorldError, WorldPlan};
use crate::models::{Catalogue, Models, Prepared};
use crate::motion::{Injected, Motion, Start as Completion};
use crate::parameters::{Scalar, Value};
use crate::physics::{Contact, Met, Mobility, capsule};
use crate::resources::Resources;
use crate::selection::{NamedSet, Perception, Reach, Rings};
use crate::sensing::robot::Memory;
use crate::sensing::{Ideal, Occlusion};
use space::obstacles::{MOST_LENGTHS, Obstacles};
use space::parallel::Workers;
use space::random::{Purpose, Stream as DrawStream, unit_vector};
use space::spelling::nearest;
use space::{Column, Columns, Frame, Grid, GroupRange, LiveGrid, PADDING, Real, Space, Vector};

/// Cells pay from this number of agents on, and from twice as many where rings of everyone are marked in single precision.
const CELLS_FROM: usize = 256;

/// A group of a running world.
pub struct Group<R: Scalar, const D: usize> {
    /// Name in files and tables.
    pub name: String,
    /// Id of its model.
    pub model: String,
    pub(crate) kernel: Box<dyn Kernel<R, D>>,
    pub(crate) contact: Contact,
    pub(crate) radius: R,
    /// Half the length of a body's axis; 0 where they are round.
    pub(crate) half: R,
    /// Whether its bodies meet others.
    pub(crate) meets: bool,
    /// Whether a refused move leaves no velocity.
    pub(crate) steps: bool,
}

/// What an asynchronous driver remembers.
#[derive(Clone, Debug)]
pub(crate) struct Clocks<R, const D: usize> {
    /// Time of the next decision, by id.
    pub(crate) due: Vec<f64>,
    /// Decisions made, by id.
    pub(crate) decisions: Vec<u64>,
    /// Motion per time that was last decided, by id.
    pub(crate) command: Vec<Motion<R, D>>,
    /// Older frames, the oldest first, where readings are stale.
    pub(crate) history: std::collections::VecDeque<Columns<R, D>>,
}

impl<R: Scalar, const D: usize> Clocks<R, D> {
    /// Whether an agent decides in the tick that begins at `time`.
    pub(crate) fn is_due(&self, id: usize, time: f64, tick: f64) -> bool {
        // half a tick of tolerance: sums of ticks are not exact
        self.due[id] <= time + 0.5 * tick
    }
    /// Lets a view read others as they were, where readings are `stale` frames old.
    pub(crate) fn age<'a>(&'a self, view: &mut View<'a, R, D>, stale: usize) {
        if let Some(old) = self.history.front()
            && stale > 0
        {
            view.others = old;
            view.index = Index::Pairs;
        }
    }
}

/// A world that can be stepped.
pub struct World<R: Scalar, const D: usize> {
    pub(crate) compiled: Compiled<R, D>,
    pub(crate) space: Space<R, D>,
    pub(crate) obstacles: Obstacles<R, D>,
    pub(crate) resources: Option<Resources<R, D>>,
    pub(crate) groups: Vec<Group<R, D>>,
    pub(crate) ranges: Vec<GroupRange>,
    pub(crate) declared: Vec<Column>,
    pub(crate) now: Columns<R, D>,
    pub(crate) next: Columns<R, D>,
    pub(crate) heading: [Vec<R>; D],
    pub(crate) headings: bool,
    /// Places in single precision, where agents mark rings among everyone and all read the newest state.
    pub(crate) coarse: Option<Coarse<D>>,
    pub(crate) reach: Option<Reach<R>>,
    pub(crate) grid: Option<Grid<R, D>>,
    pub(crate) live: Option<LiveGrid<R, D>>,
    /// Rows by id, where rows are sorted and somebody needs it.
    pub(crate) rows: Vec<u32>,
    pub(crate) needs_rows: bool,
    pub(crate) bodies: Vec<Body<R>>,
    /// The longest half axis of a body; 0 where all are round.
    pub(crate) longest: R,
    /// Whether members may be unequally fast.
    pub(crate) uneven: bool,
    pub(crate) driver: Driver,
    pub(crate) dt: R,
    pub(crate) clocks: Clocks<R, D>,
    /// Period and jitter of each agent's clock, by id.
    pub(crate) rhythm: Vec<(f64, f64)>,
    pub(crate) memory: Vec<Memory<R>>,
    pub(crate) seed: u64,
    pub(crate) step: u64,
    pub(crate) time: f64,
    /// Length of a step (of a tick) as it was written: a time is a multiple of it, without the rounding of a long sum.
    pub(crate) step_time: f64,
    /// Step and time from which time is counted.
    pub(crate) origin: (u64, f64),
    pub(crate) workers: Workers,
    pub(crate) scratch: Vec<Scratch<R, D>>,
    pub(crate) injected: Option<Injected>,
    /// Whether anybody's way can be blocked.
    pub(crate) contacts: bool,
    /// What each agent met in the last step, by id; empty where nobody can meet anything.
    pub(crate) met: Vec<Met>,
    pub(crate) met_total: [u64; 4],
    pub(crate) collided: Option<usize>,
    pub(crate) order: Vec<u32>,
    pub(crate) push: Vec<Vector<R, D>>,
    /// Places that count while moves are accepted one by one.
    pub(crate) places: [Vec<R>; D],
    /// Rows whose move is known to meet neither wall nor obstacle.
    pub(crate) clear: Vec<bool>,
    /// Who is close to whom, where bodies are refused without cells.
    pub(crate) close: Close<R>,
}

impl<R: Scalar, const D: usize> Group<R, D> {
    /// Whether the group has a declared column of the world, by its place among them.
    pub fn declares(&self, column: usize) -> bool {
        let stages = self.kernel.stages();
        stages.columns.contains(&column) || stages.body_columns.contains(&column)
    }
    /// What happens to its bodies where the way is not free.
    pub fn contact(&self) -> Contact {
        self.contact
    }
    /// Whether contact may leave its bodies another heading than they wanted: a surface turns them round, or their turn is refused.
    pub(crate) fn turns(&self) -> bool {
        matches!(self.contact, Contact::Reflect | Contact::Clamp) || self.half > R::ZERO
    }
    /// Radius of its bodies.
    pub fn radius(&self) -> R {
        self.radius
    }
    /// Whether its bodies meet those of other members.
    pub fn meets(&self) -> bool {
        self.meets
    }
    /// From the centre of a body to the end of its axis; 0 where bodies are round.
    pub fn half_axis(&self) -> R {
        self.half
    }
}

impl<R: Scalar, const D: usize> World<R, D>
where
    Models: Catalogue<R, D>,
{
    /// Builds a world from its plan.
    ///
    /// # Errors
    /// Whatever in the plan cannot be, with the remedy where there is one.
    pub fn new(plan: WorldPlan<R, D>) -> Result<Self, WorldError> {
        Models::world(plan)
    }
    pub(crate) fn build(plan: WorldPlan<R, D>) -> Result<Self, WorldError> {
        check_world(&plan)?;
        let agents: usize = plan.groups.iter().map(|g| g.count).sum();
        if agents > u32::MAX as usize / 8 - PADDING {
            return Err(WorldError::World(format!("{agents} agents are more than the {} that ids hold", u32::MAX / 8)));
        }
        // the models, and the columns they and their bodies declare
        let mut declared: Vec<Column> = Vec::new();
        let mut column = |wanted: &Column| match declared.iter().position(|c| c.name == wanted.name) {
            Some(at) => at,
            None => {
                declared.push(*wanted);
                declared.len() - 1
            }
        };
        let mut prepared = Vec::new();
        for group in &plan.groups {
            let laws = laws::<R, D>(group)?;
            let own: Vec<usize> = laws[0].columns.iter().map(&mut column).collect();
            let mut body: Vec<usize> = group.mobility.columns().iter().map(&mut column).collect();
            let conduct = group.conduct.iter().flat_map(|conduct| conduct.columns());
            body.extend(conduct.map(&mut column));
            body.extend(beside_columns(group).iter().map(&mut column));
            let stores = plan.resources.iter().flat_map(|resources| &resources.stores);
            for at in stores.map(|store| column(&stored(&store.column))) {
                if !own.contains(&at) && !body.contains(&at) {
                    body.push(at);
                }
            }
            prepared.push((laws, own, body));
        }
        let radii = plan.groups.iter().zip(&prepared).map(|(g, (laws, ..))| g.radius.unwrap_or(laws[0].body_radius));
        let widest = radii.fold(R::ZERO, Real::most);
        let mut next = 0u32;
        let all: Vec<GroupRange> = plan
            .groups
            .iter()
            .map(|group| {
                let first = next;
                next += group.count as u32;
                GroupRange { name: group.name.clone(), first, count: group.count as u32 }
            })
            .collect();
        let find = |name: &str| declared.iter().position(|c| c.name == name);
        let dt = prepared.first().map_or(R::ONE, |(laws, ..)| laws[0].time_step);
        let adapting = plan.groups.iter().filter_map(|group| group.adapt.as_ref()?.obstacle);
        let reaches = prepared.iter().flat_map(|(laws, ..)| laws.iter().filter_map(|law| law.obstacle_reach));
        let asked = plan.groups.iter().filter_map(|group| group.obstacles.within);
        let obstacle_reach = reaches.chain(adapting).chain(asked).fold(R::ZERO, Real::most);
        let halves: Vec<R> = plan
            .groups
            .iter()
            .zip(&prepared)
            .map(|(group, (laws, ..))| half_axis(group, &laws[0]))
            .collect::<Result<_, _>>()?;
        let longest = halves.iter().copied().fold(R::ZERO, R::most);
        let elongated = longest > R::ZERO;
        let (mut groups, mut bodies) = (Vec::new(), Vec::new());
        let mut first = 0u32;
        let (mut identity, mut guarded) = (false, true);
        let mut reach: Option<Reach<R>> = None;
        let (mut headings, mut uneven) = (false, false);
        for ((group, (laws, own, body)), half) in plan.groups.iter().zip(prepared).zip(halves) {
            let mut kernels = Vec::new();
            let mut speeds = laws.iter().flat_map(|law| &law.initial_speeds);
            let first_speed = speeds.next();
            uneven |= group.conduct.is_some()
                || group.pace.as_ref().is_some_and(|pace| pace.least < pace.greatest)
                || speeds.any(|speed| Some(speed) != first_speed);
            let contact = group.contact.unwrap_or(laws[0].contact);
            let radius = group.radius.unwrap_or(laws[0].body_radius);
            let (meets, steps) = (laws[0].bodies_meet, laws[0].velocity_is_step);
            let own_range = GroupRange { name: group.name.clone(), first, count: group.count as u32 };
            let columns_of = |places: &[usize]| places.iter().map(|&at| declared[at]).collect::<Vec<Column>>();
            let (own_columns, body_columns) = (columns_of(&own), columns_of(&body));
            let told = Told { own: &own_columns, body: &body_columns };
            if !group.intervals.is_empty() {
                if matches!(plan.driver, Driver::Asynchronous { .. }) {
                    let problem = "decides: agents on their own clocks have periods, not intervals of steps";
                    return Err(in_group(group, problem.into()));
                }
                if group.intervals.len() != group.count {
                    let (found, count) = (group.intervals.len(), group.count);
                    return Err(in_group(group, format!("decides: {found} intervals for {count} members")));
                }
            }
            for model in laws {
                if model.time_step != dt {
                    return Err(in_group(
                        group,
                        format!(
                            "its step is {} and that of the first group {dt}; all groups share one step, so give them the same `time_step`",
                            model.time_step
                        ),
                    ));
                }
                let (sets, own_sets) = chosen_sets(group, &model.sets, agents)?;
                let set_reach =
                    sets.iter().map(|s| s.perception.reach()).reduce(Reach::and).unwrap_or(Reach::Within(R::TINY));
                let mut sensing = group.sensing.clone();
                if let Sensing::Ideal(ideal) = &mut sensing
                    && ideal.occlusion == Occlusion::Obstacles
                    && plan.obstacles.is_empty()
                {
                    // nothing is there that hides
                    ideal.occlusion = Occlusion::None;
                }
                let uses_sets = !own_sets || model.stream_reach.is_none();
                let mut needs = model.needs;
                needs.identity |= sets.iter().any(|s| s.perception.identifies());
                match &mut sensing {
                    Sensing::Ideal(ideal) if elongated && ideal.occlusion != Occlusion::None => {
                        let problem = "occlusion takes bodies for round; leave it out, or `length`";
                        return Err(in_group(group, problem.into()));
                    }
                    Sensing::Scanner(_) if elongated => {
                        let problem = "what a scanner finds is taken for round; leave `length` out, or sense ideally";
                        return Err(in_group(group, problem.into()));
                    }
                    Sensing::Ideal(ideal) => ideal.check().map_err(|problem| in_group(group, problem))?,
                    Sensing::Scanner(robot) => {
                        refuse_what_a_scanner_cannot_give(group, needs, robot.association.is_some(), D)?;
                        robot.widest_body = widest.most(radius);
                    }
                }
                check_obstacles(group, needs, model.obstacle_reach, &plan.space)?;
                let mut obstacle_reach = group.obstacles.within.or(model.obstacle_reach);
                if let Sensing::Ideal(Ideal { range: Some(range), .. }) = &sensing {
                    obstacle_reach = obstacle_reach.map(|reach| reach.least(*range));
                }
                let group_reach = match (&sensing, model.stream_reach) {
                    (Sensing::Scanner(robot), _) => Reach::Within(robot.scanner_range() + robot.widest_body),
                    (Sensing::Ideal(ideal), _) if ideal.range.is_some() => {
                        Reach::Within(ideal.range.unwrap_or(R::INFINITY).least(if let Reach::Within(r) = set_reach {
                            r
                        } else {
                            R::INFINITY
                        }))
                    }
                    (_, Some(r)) if !uses_sets => {
                        if r.finite() {
                            Reach::Within(r)
                        } else {
                            Reach::All
                        }
                    }
                    _ => set_reach,
                };
                // the index serves the largest finite reach; who needs everyone looks at all pairs
                reach = match (reach, group_reach) {
                    (None, Reach::All) => None,
                    (None, r) => Some(r),
                    (Some(before), Reach::All) => Some(before),
                    (Some(Reach::Within(a)), Reach::Within(b)) => Some(Reach::Within(a.most(b))),
                    (Some(Reach::Nearest(a)), Reach::Nearest(b)) => Some(Reach::Nearest(a.max(b))),
                    (Some(Reach::Within(a)), _) | (Some(_), Reach::Within(a)) => Some(Reach::Within(a)),
                    (Some(other), _) => Some(other),
                };
                identity |= needs.identity;
                let place = group.mobility.columns().len();
                let conduct =
                    group.conduct.as_ref().map(|plan| Conduct::new(plan, &all, own_range.clone(), place, find));
                let conduct = conduct.transpose().map_err(|problem| in_group(group, problem))?;
                let refused = |problem| in_group(group, problem);
                let taxis = group.taxis.as_ref().map(|taxis| Taxis::new(taxis, &plan.stimuli, &own_range, told));
                let taxis = taxis.transpose().map_err(refused)?;
                let pace = group.pace.as_ref().map(|pace| Pace::new(pace, &plan.stimuli, &own_range, told));
                let pace = pace.transpose().map_err(refused)?;
                let adapts = group.adapt.as_ref().map(|adapt| Adapts::new(adapt, &own_range, told));
                let adapts = adapts.transpose().map_err(refused)?;
                identity |= conduct.is_some() || pace.is_some() || adapts.is_some();
                guarded &= model.guarded;
                let perfect = !elongated
                    && !group.obstacles.members
                    && matches!(&sensing, Sensing::Ideal(ideal) if ideal.is_perfect());
                let stages = Stages {
                    rings: if perfect { Rings::of(&sets) } else { None },
                    nearest: if perfect { crate::selection::nearest_of(&sets) } else { None },
                    first,
                    count: group.count as u32,
                    columns: own.clone(),
                    body_columns: body.clone(),
                    sets,
                    own_sets,
                    reach: set_reach,
                    sensing,
                    obstacle_reach,
                    law_reach: group.obstacles.within.map(|_| model.obstacle_reach.unwrap_or(R::ZERO)),
                    obstacles_kept: group.obstacles.nearest.unwrap_or(usize::MAX),
                    virtual_members: group.obstacles.members,
                    conduct,
                    taxis,
                    pace,
                    adapts,
                    guarded: model.guarded,
                    mobility: group.mobility,
                    noise: group.noise,
                    dt,
                    radius,
                    half,
                    elongated,
                    plain: group.mobility == Mobility::Ideal
                        && group.conduct.is_none()
                        && group.taxis.is_none()
                        && group.pace.is_none()
                        && group.adapt.is_none()
                        && group.noise.execution_direction == R::ZERO
                        && group.noise.execution_speed == R::ZERO,
                };
                kernels.push((model.build)(stages));
            }
            let kernel = Layered::of(group, kernels, plan.seed, first, steps, find);
            headings |= kernel.headings();
            groups.push(Group {
                name: group.name.clone(),
                model: group.model.clone(),
                kernel,
                contact,
                radius,
                half,
                meets,
                steps,
            });
            bodies.push(Body { first, radius, half });
            first += group.count as u32;
        }
        let farthest = bodies.iter().fold(obstacle_reach, |far, body| far.most(body.radius)) + longest;
        let periods = plan.space.periods();
        let margin = if farthest > R::ZERO && !plan.obstacles.is_empty() { farthest } else { R::TINY };
        // across a seam one sees and moves half a period far, and a laser as far as it reports
        let mut sight = margin;
        if !plan.obstacles.is_empty() {
            let lasers = groups.iter().map(|group| match &group.kernel.stages().sensing {
                Sensing::Scanner(robot) => robot.scanner_range(),
                Sensing::Ideal(_) => R::ZERO,
            });
            let periods = || periods.into_iter().flatten();
            let farthest = periods().map(|period| period * R::HALF).chain(lasers).fold(margin, Real::most);
            sight = periods().map(|period| period * R::of(MOST_LENGTHS)).fold(farthest, Real::least);
        }
        let obstacles = Obstacles::with_sight(plan.obstacles.clone(), periods, margin, sight)
            .map_err(|error| WorldError::World(format!("obstacles: {error}")))?;
        let resources = match plan.resources.clone() {
            Some(resources) => Some(Resources::new(resources, &all, find).map_err(WorldError::World)?),
            None => None,
        };
        let body_contacts = groups
            .iter()
            .any(|g| g.meets && g.radius > R::ZERO && matches!(g.contact, Contact::Refuse | Contact::Slide));
        let contacts = groups.iter().any(|g| g.contact != Contact::Free)
            && (plan.space.has_walls() || !obstacles.is_empty() || body_contacts);
        let threads = plan.threads.max(1);
        let collided = declared.iter().position(|c| c.name == "collided");
        let workers = Workers::new(threads);
        let scratch = (0..workers.threads()).map(|_| Scratch::new(declared.len())).collect();
        let sequential = matches!(plan.driver, Driver::Sequential(_));
        let delayed = matches!(plan.driver, Driver::Asynchronous { .. });
        // rings of everyone can be marked in single precision
        let marked = size_of::<R>() > size_of::<f32>()
            && !(sequential || delayed || plan.space.is_periodic())
            && groups.iter().any(|g| g.kernel.marks());
        let cells = match plan.index {
            IndexChoice::Pairs => false,
            IndexChoice::Automatic => {
                agents
                    >= match (sequential, marked) {
                        (true, _) => 64,
                        (_, true) => 2 * CELLS_FROM,
                        _ => CELLS_FROM,
                    }
            }
            IndexChoice::Cells => agents > 0,
        };
        // a place that is no number is in no cell
        if !cells || delayed || !guarded {
            reach = None;
        }
        let gate_of = |g: &Group<R, D>| match &g.kernel.stages().sensing {
            Sensing::Scanner(robot) => robot.association,
            Sensing::Ideal(_) => None,
        };
        let mut memory = Vec::new();
        if groups.iter().any(|group| gate_of(group).is_some()) {
            for (group, range) in groups.iter().zip(&all) {
                // nobody asks for the memory of a group that associates nothing
                let gate = gate_of(group).unwrap_or(R::ZERO);
                memory.extend((0..range.count).map(|_| Memory::new(gate)));
            }
        }
        let rough = marked && reach.is_none();
        let mut world = Self {
            compiled: Models::engine(),
            space: plan.space,
            obstacles,
            needs_rows: resources.is_some() || body_contacts || identity,
            resources,
            uneven,
            groups,
            ranges: all,
            now: Columns::new(agents, declared.len()),
            next: Columns::new(agents, declared.len()),
            heading: core::array::from_fn(|_| Vec::new()),
            // one after the other, headings would be out of date as soon as somebody has turned
            headings: headings && !sequential,
            coarse: rough.then(Coarse::new),
            reach,
            grid: None,
            live: None,
            rows: Vec::new(),
            bodies,
            longest,
            driver: plan.driver,
            dt,
            clocks: Clocks { due: Vec::new(), decisions: Vec::new(), command: Vec::new(), history: Default::default() },
            rhythm: Vec::new(),
            memory,
            seed: plan.seed,
            step: plan.first_step,
            time: 0.0,
            step_time: match plan.driver {
                Driver::Asynchronous { tick, .. } => tick,
                // in f32 the number that was meant is the shortest one that reads back to it
                Driver::Synchronous | Driver::Sequential(_) => dt.to_string().parse().unwrap_or(dt.to_f64()),
            },
            origin: (plan.first_step, 0.0),
            workers,
            scratch,
            injected: None,
            met: if contacts { vec![Met::Nothing; agents] } else { Vec::new() },
            contacts,
            met_total: [0; 4],
            collided,
            order: Vec::new(),
            push: Vec::new(),
            places: core::array::from_fn(|_| Vec::new()),
            clear: vec![false; agents],
            close: Close::default(),
            declared,
        };
        world.place_groups(&plan)?;
        world.note_close();
        world.obstacles.advance(0.0);
        world.start_clocks(&plan.groups);
        world.settle();
        Ok(world)
    }

    fn place_groups(&mut self, plan: &WorldPlan<R, D>) -> Result<(), WorldError> {
        for (g, group) in plan.groups.iter().enumerate() {
            let first = self.ranges[g].first as usize;
            let kernel = &self.groups[g].kernel;
            let own = &kernel.stages().columns;
            let laws = laws::<R, D>(group)?;
            let speed_of = |member: usize| laws.get(member).unwrap_or(&laws[0]).initial_speeds[member];
            let given: Vec<bool> = match &group.placement {
                Placement::Given(start) => {
                    check_start(group, start, &self.declared)?;
                    own.iter().map(|&c| start.columns.contains_key(self.declared[c].name)).collect()
                }
                Placement::Uniform { low, high } => {
                    if !(low.finite() && high.finite()) || (0..D).any(|a| low[a] > high[a]) {
                        return Err(in_group(group, "the box it starts in needs finite corners, low <= high".into()));
                    }
                    vec![false; own.len()]
                }
            };
            for member in 0..group.count {
                let row = first + member;
                let id = row as u64;
                let draws = DrawStream::new(plan.seed, Purpose::Init, 1 << 41, row as u32);
                let (position, velocity) = match &group.placement {
                    Placement::Given(start) => {
                        for (name, values) in &start.columns {
                            if let Some(c) = self.declared.iter().position(|c| c.name == name) {
                                self.now.state[c][row] = R::of(values[member]);
                            }
                        }
                        (start.position[member], start.velocity.as_ref().map(|v| v[member]))
                    }
                    Placement::Uniform { low, high } => {
                        let draw = |slot| space::random::uniform(plan.seed, Purpose::Init, id, slot);
                        let at = Vector(core::array::from_fn(|a| low[a] + (high[a] - low[a]) * R::of(draw(a as u32))));
                        let heading: Vector<R, D> = unit_vector(draw(4), draw(5));
                        (at, Some(heading * speed_of(member)))
                    }
                };
                let mut moving = velocity.unwrap_or(Vector::ZERO);
                let mut columns: Vec<R> = own.iter().map(|&c| self.now.state[c][row]).collect();
                kernel.complete(&mut Completion {
                    member,
                    draws,
                    velocity: &mut moving,
                    velocity_given: velocity.is_some(),
                    own: &mut columns,
                    given: &given,
                });
                for (&c, &value) in own.iter().zip(&columns) {
                    self.now.state[c][row] = value;
                }
                if let (false, Some(&facing)) =
                    (group.mobility.columns().is_empty(), kernel.stages().body_columns.first())
                {
                    self.now.state[facing][row] = moving.angle();
                }
                for varied in &group.varied {
                    let name = column_of(group, &varied.parameter).name;
                    let at = self.declared.iter().position(|column| column.name == name);
                    if let (Some(at), Value::Number(value)) = (at, &varied.values[member]) {
                        self.now.state[at][row] = R::of(*value);
                    }
                }
                for store in plan.resources.iter().flat_map(|resources| &resources.stores) {
                    let at = self.declared.iter().position(|column| column.name == store.column);
                    let told = matches!(&group.placement, Placement::Given(start) if start.columns.contains_key(&store.column));
                    if let Some(at) = at.filter(|at| !told && kernel.stages().body_columns.contains(at)) {
                        self.now.state[at][row] = store.start;
                    }
                }
                self.now.set_position(row, self.space.place(position));
                self.now.set_velocity(row, moving);
            }
        }
        if !self.frame().finite() {
            return Err(WorldError::World("a start value is not a finite number".into()));
        }
        Ok(())
    }
}

impl<R: Scalar, const D: usize> World<R, D> {
    fn start_clocks(&mut self, groups: &[GroupPlan<R, D>]) {
        let Driver::Asynchronous { period, phase, clock, .. } = self.driver else { return };
        let agents = self.now.len();
        let usual = if let Clock::Regular { jitter } = clock { jitter } else { 0.0 };
        for plan in groups {
            let own = |list: &[f64], member: usize, usual: f64| list.get(member).copied().unwrap_or(usual);
            for member in 0..plan.count {
                let id = self.rhythm.len();
                let period = own(&plan.clocks.period, member, period);
                let due = match phase {
                    Phase::Together => 0.0,
                    Phase::Spread => period * id as f64 / agents as f64,
                    Phase::Random => {
                        period * space::random::uniform(self.seed, Purpose::Environment, u64::MAX, id as u32 * 8)
                    }
                };
                self.clocks.due.push(own(&plan.clocks.phase, member, due));
                self.rhythm.push((period, own(&plan.clocks.jitter, member, usual)));
            }
        }
        self.clocks.decisions = vec![0; agents];
        let dt = self.dt;
        self.clocks.command = (0..agents)
            .map(|id| {
                let velocity = self.now.velocity(id);
                Motion { velocity, displacement: velocity * dt }
            })
            .collect();
    }

    /// Brings the index and what depends on it up to date with `now`.
    pub(crate) fn settle(&mut self) {
        if let Driver::Sequential(_) = self.driver {
            if self.live.is_none()
                && let Some(Reach::Within(reach)) = self.reach
            {
                self.live = LiveGrid::new(&self.space, reach, &self.now);
            }
        } else if let Some(reach) = self.reach {
            let reach = match reach {
                Reach::Within(reach) => reach,
                Reach::Nearest(count) => self.distance_of_nearest(count),
                Reach::All => R::INFINITY,
            };
            let grid = Grid::sort(self.grid.take(), &self.space, reach, &self.now, &mut self.next, &self.workers);
            if grid.is_some() {
                core::mem::swap(&mut self.now, &mut self.next);
            } else {
                self.unsort();
            }
            self.grid = grid;
        }
        self.update_rows();
        if self.headings {
            self.update_headings();
        }
        if let Some(coarse) = &mut self.coarse {
            coarse.update(&self.now);
        }
    }
    /// Puts rows back in the order of ids, for when cells cannot serve any more.
    fn unsort(&mut self) {
        if (0..self.now.len()).all(|row| self.now.id[row] as usize == row) {
            return;
        }
        self.now.write_by_id(&mut self.next);
        core::mem::swap(&mut self.now, &mut self.next);
    }
    fn update_rows(&mut self) {
        if !self.needs_rows || self.grid.is_none() {
            self.rows.clear();
            return;
        }
        self.rows.resize(self.now.len(), 0);
        for row in 0..self.now.len() {
            self.rows[self.now.id[row] as usize] = row as u32;
        }
    }
    fn update_headings(&mut self) {
        let padded = self.now.len() + PADDING;
        let now = &self.now;
        for column in &mut self.heading {
            column.resize(padded, R::ZERO);
        }
        let heading = self.heading.each_mut().map(|c| space::parallel::Shared::new(c));
        let tasks = if self.workers.threads() == 1 { 1 } else { 4 * self.workers.threads() };
        let rows = now.len();
        self.workers.each(tasks, |_, task| {
            let part = (rows * task / tasks)..(rows * (task + 1) / tasks);
            // SAFETY: tasks own disjoint rows.
            let mut to: [&mut [R]; D] = core::array::from_fn(|a| unsafe { heading[a].part(part.clone()) });
            space::lanes::with_lanes(space::lanes::level(), Headings { now, first: part.start, to: &mut to });
        });
    }
    /// A length that about `count` agents live within, from the box that holds them all.
    fn distance_of_nearest(&self, count: usize) -> R {
        let (low, high) = space::grid::bounds(&self.now);
        let mut volume = 1.0;
        for a in 0..D {
            let extent = self.space.side(a).unwrap_or(high.0[a] - low.0[a]).to_f64();
            volume *= extent.max(1e-9);
        }
        let share = volume * (count.max(1) as f64) / (self.now.len().max(1) as f64);
        R::of(root_of(share, D))
    }
    pub(crate) fn view(&self) -> View<'_, R, D> {
        View {
            now: &self.now,
            others: &self.now,
            heading: &self.heading,
            coarse: self.coarse.as_ref(),
            index: match (&self.grid, &self.live) {
                (Some(grid), _) => Index::Sorted(grid),
                (None, Some(live)) => Index::Live(live),
                (None, None) => Index::Pairs,
            },
            space: &self.space,
            obstacles: &self.obstacles,
            resources: self.resources.as_ref(),
            mortality: self.resources.as_ref().and_then(Resources::mortality),
            rows: if self.rows.is_empty() { None } else { Some(&self.rows) },
            bodies: &self.bodies,
            longest: self.longest,
            uneven: self.uneven,
            seed: self.seed,
            step: self.step,
            time: self.time,
            injected: self.injected.as_ref(),
        }
    }
    pub(crate) fn group_of(&self, id: u32) -> usize {
        self.ranges.partition_point(|range| range.first + range.count <= id)
    }
    /// The row of an agent.
    #[inline]
    pub fn row_of(&self, id: u32) -> usize {
        if self.rows.is_empty() && self.grid.is_none() {
            id as usize
        } else if self.rows.is_empty() {
            (0..self.now.len()).find(|&row| self.now.id[row] == id).unwrap_or(0)
        } else {
            self.rows[id as usize] as usize
        }
    }
    /// The state, read-only.
    pub fn frame(&self) -> Frame<'_, R, D> {
        Frame {
            columns: &self.now,
            declared: &self.declared,
            groups: &self.ranges,
            space: &self.space,
            time: self.time,
            step: self.step,
        }
    }
    /// Position of an agent.
    pub fn position(&self, id: u32) -> Vector<R, D> {
        self.now.position(self.row_of(id))
    }
    /// Velocity of an agent.
    pub fn velocity(&self, id: u32) -> Vector<R, D> {
        self.now.velocity(self.row_of(id))
    }
    /// A declared column of an agent; `None` where no model declares it.
    pub fn state(&self, id: u32, column: &str) -> Option<R> {
        let at = self.declared.iter().position(|c| c.name == column)?;
        Some(self.now.state[at][self.row_of(id)])
    }
    /// Steps made since the start.
    pub fn step_number(&self) -> u64 {
        self.step
    }
    /// Time since the start.
    pub fn time(&self) -> f64 {
        self.time
    }
    /// Number of threads.
    pub fn threads(&self) -> usize {
        self.workers.threads()
    }
    /// Supplies random quantities in place of draws, from now on.
    pub fn inject(&mut self, injected: Injected) {
        self.injected = Some(injected);
    }
    /// The resources.
    pub fn resources(&self) -> Option<&Resources<R, D>> {
        self.resources.as_ref()
    }
    /// The resources, to change them.
    pub fn resources_mut(&mut self) -> Option<&mut Resources<R, D>> {
        self.resources.as_mut()
    }
    /// The obstacles as they stand now.
    pub fn obstacles(&self) -> &Obstacles<R, D> {
        &self.obstacles
    }
    /// Puts obstacles, by index, at these offsets from their drawn places; `None` takes one away. For whoever steers obstacles
    /// that have no plan from outside, between two steps; a checkpoint does not hold it.
    pub fn put_obstacles(&mut self, places: &[(usize, Option<Vector<R, D>>)]) {
        self.obstacles.put(places);
    }
    /// Contacts since the start: with members, obstacles, walls.
    pub fn collisions(&self) -> (u64, u64, u64) {
        (self.met_total[1], self.met_total[2], self.met_total[3])
    }
    /// What each agent met in the last step, by id; empty where nobody can meet anything.
    pub fn met(&self) -> &[Met] {
        &self.met
    }
    /// Errors of detection behind scanners, summed since the start.
    pub fn detection_errors(&self) -> ErrorCount {
        let mut total = ErrorCount::default();
        for scratch in &self.scratch {
            total += scratch.robot.errors;
        }
        total
    }
    /// Which declared column tells the dead, at 0, from the living; none where nobody can die.
    pub fn mortality(&self) -> Option<usize> {
        self.resources.as_ref().and_then(Resources::mortality)
    }
    /// The groups.
    pub fn groups(&self) -> &[Group<R, D>] {
        &self.groups
    }
    /// Mean number of others in any named set, over every `every`-th agent.
    pub fn mean_neighbours(&mut self, every: usize) -> f64 {
        (self.compiled.mean_neighbours)(self, every)
    }
    pub(crate) fn count_neighbours(&mut self, every: usize) -> f64 {
        let mut scratch = match self.scratch.pop() {
            Some(scratch) => scratch,
            None => return 0.0,
        };
        let (mut sum, mut count) = (0usize, 0usize);
        for row in (0..self.now.len()).step_by(every.max(1)) {
            let view = self.view();
            let kernel = &self.groups[self.group_of(self.now.id[row])].kernel;
            sum += kernel.neighbours(&view, row, &mut scratch);
            count += 1;
        }
        self.scratch.push(scratch);
        sum as f64 / count.max(1) as f64
    }

    /// The full state, from which a world of the same plan continues with the same bits.
    pub fn save(&self) -> Checkpoint<R, D> {
        let mut columns = Columns::new(self.now.len(), self.declared.len());
        self.now.write_by_id(&mut columns);
        let mut memory = Vec::new();
        self.memory.iter().for_each(|m| m.save(&mut memory));
        Checkpoint {
            columns,
            step: self.step,
            time: self.time,
            resources: self.resources.clone(),
            clocks: self.clocks.clone(),
            memory,
            met_total: self.met_total,
            errors: self.detection_errors(),
        }
    }
    /// Continues from a saved state of a world of the same plan.
    ///
    /// # Errors
    /// When the saved state has another number of agents or columns, or is damaged.
    pub fn restore(&mut self, saved: &Checkpoint<R, D>) -> Result<(), WorldError> {
        (self.compiled.restore)(self, saved)
    }
    pub(crate) fn take_over(&mut self, saved: &Checkpoint<R, D>) -> Result<(), WorldError> {
        if saved.columns.len() != self.now.len() || saved.columns.state.len() != self.declared.len() {
            return Err(WorldError::World(format!(
                "the saved state has {} agents and {} columns, this world {} and {}",
                saved.columns.len(),
                saved.columns.state.len(),
                self.now.len(),
                self.declared.len()
            )));
        }
        let mut rest = saved.memory.as_slice();
        for memory in &mut self.memory {
            let used = memory.load(rest);
            rest = used
                .and_then(|used| rest.get(used..))
                .ok_or_else(|| WorldError::World("the saved memory of scans is damaged".into()))?;
        }
        self.now = saved.columns.clone();
        self.step = saved.step;
        self.time = saved.time;
        // a state that other steps led to goes on from its own time
        if self.time_at(saved.step) != saved.time {
            self.origin = (saved.step, saved.time);
        }
        self.resources = saved.resources.clone();
        self.clocks = saved.clocks.clone();
        self.met_total = saved.met_total;
        for (k, scratch) in self.scratch.iter_mut().enumerate() {
            scratch.robot.errors = if k == 0 { saved.errors } else { ErrorCount::default() };
        }
        self.live = None;
        self.obstacles.advance(self.time);
        self.settle();
        Ok(())
    }
}

/// A saved state.
#[derive(Clone, Debug)]
pub struct Checkpoint<R, const D: usize> {
    pub(crate) columns: Columns<R, D>,
    pub(crate) step: u64,
    pub(crate) time: f64,
    pub(crate) resources: Option<Resources<R, D>>,
    pub(crate) clocks: Clocks<R, D>,
    pub(crate) memory: Vec<f64>,
    pub(crate) met_total: [u64; 4],
    pub(crate) errors: ErrorCount,
}

/// Unit headings, several rows at a time.
struct Headings<'a, 'b, R, const D: usize> {
    now: &'a Columns<R, D>,
    first: usize,
    to: &'a mut [&'b mut [R]; D],
}
impl<R: Scalar, const D: usize> space::lanes::Task<R> for Headings<'_, '_, R, D> {
    type Output = ();
    #[inline(always)]
    fn run<L: space::lanes::Lanes<R>>(self) {
        let rows = self.to[0].len();
        let mut row = 0;
        while row < rows {
            let velocity: [L; D] = core::array::from_fn(|a| L::load(&self.now.velocity[a][self.first + row..]));
            let unit = crate::motion::directions(&velocity, crate::motion::dot(&velocity, &velocity));
            let count = (rows - row).min(L::WIDTH);
            for a in 0..D {
                if count == L::WIDTH {
                    unit[a].store(&mut self.to[a][row..]);
                } else {
                    let mut last = [R::ZERO; crate::motion::WIDEST];
                    unit[a].store(&mut last);
                    self.to[a][row..].copy_from_slice(&last[..count]);
                }
            }
            row += L::WIDTH;
        }
    }
}

fn root_of(value: f64, degree: usize) -> f64 {
    match degree {
        1 => value,
        2 => value.sqrt(),
        _ => <f64 as Real>::powf(value, 1.0 / degree as f64),
    }
}

fn in_group<R, const D: usize>(group: &GroupPlan<R, D>, problem: String) -> WorldError {
    WorldError::Group { group: group.name.clone(), problem }
}

/// Columns of what a body does beside its law.
fn beside_columns<R: Scalar, const D: usize>(group: &GroupPlan<R, D>) -> Vec<Column> {
    let mut columns = Vec::new();
    if group.taxis.is_some() {
        columns.extend(crate::stimulus::Taxis::<R>::COLUMNS);
    }
    if group.pace.as_ref().is_some_and(|pace| pace.drive.is_some()) {
        columns.push(crate::pace::Pace::<R>::DRIVE);
    }
    columns.extend(group.adapt.iter().flat_map(Adaptation::columns));
    columns.extend(group.varied.iter().map(|varied| column_of(group, &varied.parameter)));
    columns
}

fn check_world<R: Scalar, const D: usize>(plan: &WorldPlan<R, D>) -> Result<(), WorldError> {
    for a in 0..D {
        if let Some(side) = plan.space.side(a)
            && !(side > R::ZERO && side.finite())
        {
            return Err(WorldError::World(format!("side {a} of the space must be more than 0, found {side}")));
        }
    }
    for stimulus in &plan.stimuli {
        let told = |problem| WorldError::World(format!("stimulus `{}`: {problem}", stimulus.name));
        stimulus.field.check().map_err(told)?;
    }
    for (g, group) in plan.groups.iter().enumerate() {
        if plan.groups[..g].iter().any(|other| other.name == group.name) {
            return Err(WorldError::World(format!("two groups are named `{}`", group.name)));
        }
        if let Some(radius) = group.radius
            && !(radius >= R::ZERO && radius.finite())
        {
            return Err(in_group(group, format!("the body radius must be 0 or more, found {radius}")));
        }
        group.mobility.check(D).map_err(|problem| in_group(group, problem))?;
        let n = &group.noise;
        for value in [n.computation, n.execution_direction, n.execution_speed] {
            if !(value >= R::ZERO && value.finite()) {
                return Err(in_group(group, format!("noise must be 0 or more, found {value}")));
            }
        }
    }
    if let Driver::Asynchronous { tick, period, delay, clock, .. } = plan.driver {
        if !(tick > 0.0 && period > 0.0 && tick.is_finite() && period.is_finite()) {
            return Err(WorldError::World(format!(
                "the asynchronous driver needs a tick and a period of more than 0, found {tick} and {period}"
            )));
        }
        if !(delay >= 0.0 && delay <= 1e4 * tick) {
            return Err(WorldError::World(format!(
                "the delay of readings must be from 0 to 10,000 ticks, found {delay}"
            )));
        }
        if let Clock::Regular { jitter } = clock
            && !(0.0..1.0).contains(&jitter)
        {
            return Err(WorldError::World(format!("the jitter must be from 0 to below 1, found {jitter}")));
        }
    }
    plan.groups.iter().try_for_each(|group| check_clocks(group, plan.driver))
}

/// Clocks of its own that a group can have under a driver.
fn check_clocks<R: Scalar, const D: usize>(group: &GroupPlan<R, D>, driver: Driver) -> Result<(), WorldError> {
    let ClockPlan { period, phase, jitter } = &group.clocks;
    let wrong = |problem: String| Err(in_group(group, format!("decides: {problem}")));
    for (name, list) in [("periods", period), ("phases", phase), ("jitters", jitter)] {
        match driver {
            _ if list.is_empty() => {}
            Driver::Asynchronous { clock: Clock::Poisson, .. } if name == "jitters" => {
                return wrong("a clock at random times has no jitter; leave it out, or use a regular clock".into());
            }
            Driver::Asynchronous { .. } => {}
            _ => {
                return wrong(format!(
                    "{name} are those of clocks, which agents have under an asynchronous driver alone"
                ));
            }
        }
        if !list.is_empty() && list.len() != group.count {
            return wrong(format!("{} {name} for {} members", list.len(), group.count));
        }
    }
    if let Some(period) = period.iter().find(|&&period| !(period > 0.0 && period.is_finite())) {
        return wrong(format!(
            "periods must be more than 0, found {period}; where they are drawn, `truncated` keeps them so"
        ));
    }
    if let Driver::Asynchronous { tick, .. } = driver
        && let Some(period) = period.iter().find(|&&period| period < tick)
    {
        return wrong(format!("the period ({period}) is shorter than a tick ({tick})"));
    }
    if let Some(phase) = phase.iter().find(|&&phase| !(phase >= 0.0 && phase.is_finite())) {
        return wrong(format!("phases must be 0 or more, found {phase}"));
    }
    if let Some(jitter) = jitter.iter().find(|jitter| !(0.0..1.0).contains(*jitter)) {
        return wrong(format!("jitters must be from 0 to below 1, found {jitter}"));
    }
    Ok(())
}

/// Half the length of the axis of a group's bodies.
fn half_axis<R: Scalar, const D: usize>(group: &GroupPlan<R, D>, law: &Prepared<R, D>) -> Result<R, WorldError> {
    let Some(length) = group.length else { return Ok(R::ZERO) };
    let radius = group.radius.unwrap_or(law.body_radius);
    let wrong = |problem| Err(in_group(group, problem));
    let (round, most) = (radius + radius, capsule::longest(radius));
    if !(length >= round && length <= most) || radius <= R::ZERO {
        return wrong(format!(
            "length: an elongated body has a radius and is from twice to {} times as long as that, here from {round} to {most}; found {length}",
            most / radius.most(R::TINY)
        ));
    }
    let contact = group.contact.unwrap_or(law.contact);
    if matches!(contact, Contact::Reflect | Contact::Clamp) {
        return wrong(
            "length: elongated bodies are neither reflected nor clamped; contact: refuse, slide or free".into(),
        );
    }
    if law.velocity_is_step && contact == Contact::Refuse {
        return wrong(
            "length: with this model a refused move leaves no heading, along which a body could lie; contact: slide or free"
                .into(),
        );
    }
    Ok(capsule::half_axis(length, radius))
}

fn chosen_sets<R: Scalar, const D: usize>(
    group: &GroupPlan<R, D>,
    own: &[NamedSet<R, D>],
    agents: usize,
) -> Result<(Vec<NamedSet<R, D>>, bool), WorldError> {
    let mut sets = own.to_vec();
    for (name, perception) in &group.sets {
        let Some(set) = sets.iter_mut().find(|set| set.name == name) else {
            let names: Vec<&str> = own.iter().map(|set| set.name).collect();
            // the sets of a composition are those that its terms name
            let owner = if own.iter().any(NamedSet::is_unsaid) { "its terms name" } else { "it has" };
            let there = if names.is_empty() { "it has none".into() } else { format!("{owner} {}", names.join(", ")) };
            let meant = nearest(name, names.into_iter()).map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
            return Err(in_group(group, format!("`{}` has no named set `{name}`; {there}{meant}", group.model)));
        };
        set.perception = perception.clone();
    }
    for set in &sets {
        if set.is_unsaid() && !group.sets.iter().any(|(name, _)| name == set.name) {
            let said = group.sets.iter().map(|(name, _)| name.as_str());
            // of a composition, this set alone is said by the model itself
            let known: Vec<&str> = said.chain([crate::terms::NEIGHBOURS]).collect();
            let problem = format!(
                "set `{}` is named by a term, but the selection does not say who is in it; {}",
                set.name,
                match nearest(set.name, known.iter().copied()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => format!("say it there, or let the term name one of {}", known.join(", ")),
                }
            );
            return Err(in_group(group, problem));
        }
        set.perception.check().map_err(|problem| in_group(group, format!("set `{}`: {problem}", set.name)))?;
        if let Perception::FixedSet(lists) = &set.perception {
            if lists.len() != group.count {
                let found = lists.len();
                let problem = format!("fixed_set needs a list for each of {} members, found {found}", group.count);
                return Err(in_group(group, problem));
            }
            if let Some(nobody) = lists.iter().flatten().find(|&&id| id as usize >= agents) {
                let there =
                    if agents == 0 { "nobody is there".into() } else { format!("ids go from 0 to {}", agents - 1) };
                return Err(in_group(group, format!("set `{}`: fixed_set names {nobody}; {there}", set.name)));
            }
        }
    }
    Ok((sets, group.sets.is_empty()))
}

/// What a law cannot be told of obstacles, and what nobody can.
fn check_obstacles<R: Scalar, const D: usize>(
    group: &GroupPlan<R, D>,
    needs: crate::motion::Needs,
    reach: Option<R>,
    space: &Space<R, D>,
) -> Result<(), WorldError> {
    let (told, model) = (&group.obstacles, &group.model);
    let half = space.periods().into_iter().flatten().fold(R::INFINITY, R::least) * R::HALF;
    let problem = if let Some(within) = told.within.filter(|within| *within > half) {
        format!("obstacles.within must be at most half a period, {half}, found {within}")
    } else if told.within.is_some_and(|within| !(within > R::ZERO && within.finite())) {
        format!("obstacles.within must be more than 0, found {}", told.within.unwrap_or(R::ZERO))
    } else if told.nearest == Some(0) {
        "obstacles.nearest must be 1 or more, found 0; leave it out for all".to_owned()
    } else if told.members && needs.identity {
        format!("obstacles.members: `{model}` needs to know who the others are, and obstacles are nobody; leave it out")
    } else if told.members && needs.state {
        format!("obstacles.members: `{model}` needs state of the others that obstacles do not have; leave it out")
    } else if told.members && told.within.is_none() && reach.is_none() {
        format!(
            "obstacles.members: `{model}` looks at no obstacles; say within which distance they are members, with `within`"
        )
    } else {
        return Ok(());
    };
    Err(in_group(group, problem))
}

fn refuse_what_a_scanner_cannot_give<R: Scalar, const D: usize>(
    group: &GroupPlan<R, D>,
    needs: crate::motion::Needs,
    associated: bool,
    dimension: usize,
) -> Result<(), WorldError> {
    let model = &group.model;
    let problem = if dimension != 2 {
        "a scanner is planar; use ideal sensing, or two dimensions".to_owned()
    } else if needs.identity {
        format!("`{model}` needs to know who the others are, which a scanner does not show; use ideal sensing")
    } else if needs.state {
        format!("`{model}` needs state of the others that a scanner does not show; use ideal sensing")
    } else if needs.velocity && !associated {
        format!(
            "`{model}` needs velocities of the others, and a scanner shows positions only; \
             add association of readings over time, or use ideal sensing"
        )
    } else {
        return Ok(());
    };
    Err(in_group(group, problem))
}

fn check_start<R: Scalar, const D: usize>(
    group: &GroupPlan<R, D>,
    start: &crate::engine::plan::Start<R, D>,
    declared: &[Column],
) -> Result<(), WorldError> {
    let count = group.count;
    let fits = |what: &str, found: usize| {
        if found == count { Ok(()) } else { Err(in_group(group, format!("{found} {what} for {count} members"))) }
    };
    fits("start positions", start.position.len())?;
    if let Some(velocity) = &start.velocity {
        fits("start velocities", velocity.len())?;
    }
    for (name, values) in &start.columns {
        if !declared.iter().any(|c| c.name == name) {
            let near = nearest(name, declared.iter().map(|c| c.name));
            let hint = near.map_or_else(String::new, |n| format!("; did you mean `{n}`?"));
            return Err(in_group(group, format!("`{}` declares no column `{name}`{hint}", group.model)));
        }
        fits(&format!("start values of `{name}`"), values.len())?;
    }
    Ok(())
}
