//! What a body does beside its law: it goes up a stimulus, keeps a pace, and notes what it adapts to. It stands between motion and the
//! body, so that every law may have it and no law knows of it.

use crate::adaptation::Adaptation;
use crate::engine::kernel::View;
use crate::motion::Motion;
use crate::pace::{self, Neighbours};
use crate::parameters::Scalar;
use crate::stimulus::{self, Field, Stimulus};
use space::random::{Purpose, Stream as DrawStream};
use space::spelling::nearest;
use space::{Column, ColumnKind, Edge, GroupRange, Real, Vector};

/// Slots of computation about oneself: two for the drive.
const DRIVE: u32 = 0;

/// Columns by which a group tells its states: those of its law, then those of its body, each by its place.
#[derive(Clone, Copy)]
pub(crate) struct Told<'a> {
    pub(crate) own: &'a [Column],
    pub(crate) body: &'a [Column],
}

/// Where a column is read.
#[derive(Clone, Copy)]
enum Place {
    Own(usize),
    Body(usize),
}

impl Told<'_> {
    /// A column with its named states.
    fn states(&self, name: &str) -> Result<(Place, &'static [&'static str]), String> {
        let find = |columns: &[Column]| columns.iter().position(|column| column.name == name);
        let (place, column) = match (find(self.own), find(self.body)) {
            (Some(at), _) => (Place::Own(at), &self.own[at]),
            (None, Some(at)) => (Place::Body(at), &self.body[at]),
            (None, None) => {
                let known = self.own.iter().chain(self.body).map(|column| column.name);
                let help = nearest(name, known).map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                return Err(format!("the group keeps no column `{name}`{help}"));
            }
        };
        match column.kind {
            ColumnKind::Label(states) => Ok((place, states)),
            _ => Err(format!("the column `{name}` has no named states")),
        }
    }
    /// The place of a column of the body.
    fn of_body(&self, name: &str) -> usize {
        self.body.iter().position(|column| column.name == name).unwrap_or(0)
    }
}

/// The number of a state.
fn number_of(states: &[&'static str], state: &str) -> Result<usize, String> {
    states.iter().position(|own| *own == state).ok_or_else(|| {
        let near = nearest(state, states.iter().copied());
        let help = near.map_or_else(|| states.join(", "), |near| format!("did you mean `{near}`?"));
        format!("there is no state `{state}`: {help}")
    })
}

fn field_of<R: Real, const D: usize>(stimuli: &[Stimulus<R, D>], name: &str) -> Result<Field<R, D>, String> {
    match stimuli.iter().find(|stimulus| stimulus.name == name) {
        Some(stimulus) => Ok(stimulus.field),
        None => {
            let near = nearest(name, stimuli.iter().map(|stimulus| stimulus.name.as_str()));
            let help = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            Err(format!("there is no stimulus `{name}`{help}"))
        }
    }
}

#[inline(always)]
fn read<R: Real>(place: Place, own: &[R], body: &[R]) -> R {
    match place {
        Place::Own(at) => own.get(at).copied().unwrap_or(R::ZERO),
        Place::Body(at) => body.get(at).copied().unwrap_or(R::ZERO),
    }
}

/// Taxis with what it needs of the world.
pub(crate) struct Taxis<R, const D: usize> {
    field: Field<R, D>,
    first: u32,
    informed: u32,
    sensors: Vec<Vector<R, D>>,
    weight: Option<R>,
    threshold: R,
    over: Option<(Place, Vec<R>)>,
    /// Place of its columns among those of the body.
    columns: usize,
}

impl<R: Scalar, const D: usize> Taxis<R, D> {
    /// Finds field and states.
    ///
    /// # Errors
    /// A sentence that names what is not there.
    pub(crate) fn new(
        plan: &stimulus::Taxis<R>,
        stimuli: &[Stimulus<R, D>],
        group: &GroupRange,
        told: Told<'_>,
    ) -> Result<Self, String> {
        plan.check(D)?;
        let named = |what: String| format!("taxis: {what}");
        let over = match &plan.over {
            Some((column, chosen)) => {
                let (place, states) = told.states(column).map_err(named)?;
                let numbers = chosen.iter().map(|state| number_of(states, state).map(R::count));
                Some((place, numbers.collect::<Result<_, _>>().map_err(named)?))
            }
            None => None,
        };
        Ok(Self {
            field: field_of(stimuli, &plan.up).map_err(named)?,
            first: group.first,
            informed: plan.count(group.count as usize),
            sensors: plan.sensors.iter().map(|s| Vector(core::array::from_fn(|a| s[a]))).collect(),
            weight: plan.weight,
            threshold: plan.threshold,
            over,
            columns: told.of_body(stimulus::Taxis::<R>::COLUMNS[0].name),
        })
    }

    /// The way up as the sensors of a body at a place tell it, not of unit length, and their mean reading.
    fn sensed(&self, view: &View<'_, R, D>, place: Vector<R, D>, heading: Vector<R, D>) -> (Vector<R, D>, R) {
        let ahead = heading.unit_or(Vector::axis(0));
        let mut axes = [Vector::ZERO; D];
        axes[0] = ahead;
        if D == 2 {
            axes[1] = ahead.left();
        } else if D > 2 {
            axes[1] = Vector::axis(2).cross3(ahead).unit_or(Vector::axis(1));
            axes[2] = ahead.cross3(axes[1]);
        }
        let at = |sensor: &Vector<R, D>| (0..D).fold(Vector::ZERO, |sum, a| sum + axes[a] * sensor.0[a]);
        let number = R::count(self.sensors.len());
        let reading = |sensor: &Vector<R, D>| self.field.at(view.space, place + at(sensor));
        let mean = self.sensors.iter().fold(R::ZERO, |sum, sensor| sum + reading(sensor)) / number;
        let up = self.sensors.iter().fold(Vector::ZERO, |sum, sensor| sum + at(sensor) * (reading(sensor) - mean));
        (up, mean)
    }

    /// The motion of an agent that wants to move as `wanted`.
    #[inline(never)]
    pub(crate) fn motion(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        wanted: Motion<R, D>,
        own: &[R],
        body: &mut [R],
    ) -> Motion<R, D> {
        let informed = view.now.id[row].wrapping_sub(self.first) < self.informed;
        let heading = view.now.velocity(row).unit();
        let (up, mean) = self.sensed(view, view.now.position(row), heading);
        if let [is, reading, ..] = &mut body[self.columns..] {
            *is = R::of(f64::from(u8::from(informed)));
            *reading = mean;
        }
        let acts = self.over.as_ref().is_none_or(|(place, states)| states.contains(&read(*place, own, body)));
        // the direction is taken before it is scaled, so that it is told however faint the stimulus is
        let largest = up.0.iter().fold(R::ZERO, |most, c| most.most(c.abs()));
        if !informed || !acts || mean < self.threshold || largest <= R::ZERO || !up.finite() {
            return wanted;
        }
        let up = (up / largest).unit();
        let towards = |from: Vector<R, D>| match self.weight {
            Some(weight) => (from.unit() + up * weight).unit_or(from.unit()),
            None => up,
        };
        Motion {
            velocity: towards(wanted.velocity) * wanted.velocity.length(),
            displacement: towards(wanted.displacement) * wanted.displacement.length(),
        }
    }
}

/// A pace with what it needs of the world.
pub(crate) struct Pace<R, const D: usize> {
    plan: pace::Pace<R>,
    factors: Option<(Place, Vec<R>)>,
    stimulus: Option<(Field<R, D>, R)>,
    drive: usize,
    own: GroupRange,
}

impl<R: Scalar, const D: usize> Pace<R, D> {
    /// Finds states and field.
    ///
    /// # Errors
    /// A sentence that names what is not there.
    pub(crate) fn new(
        plan: &pace::Pace<R>,
        stimuli: &[Stimulus<R, D>],
        group: &GroupRange,
        told: Told<'_>,
    ) -> Result<Self, String> {
        plan.check()?;
        let named = |what: String| format!("pace: {what}");
        let factors = match &plan.states {
            Some((column, chosen)) => {
                let (place, states) = told.states(column).map_err(named)?;
                let mut factors = vec![R::ONE; states.len()];
                for (state, factor) in chosen {
                    factors[number_of(states, state).map_err(named)?] = *factor;
                }
                Some((place, factors))
            }
            None => None,
        };
        let stimulus = match &plan.stimulus {
            Some((name, gain)) => Some((field_of(stimuli, name).map_err(named)?, *gain)),
            None => None,
        };
        Ok(Self {
            factors,
            stimulus,
            drive: told.of_body(pace::Pace::<R>::DRIVE.name),
            own: group.clone(),
            plan: plan.clone(),
        })
    }

    /// The motion of an agent that wants to move as `wanted`, at the speed that it comes to.
    #[inline(never)]
    pub(crate) fn motion(
        &self,
        view: &View<'_, R, D>,
        row: usize,
        wanted: Motion<R, D>,
        own: &[R],
        dt: R,
        body: &mut [R],
    ) -> Motion<R, D> {
        let plan = &self.plan;
        let (asked, now) = (wanted.velocity.length(), view.now.velocity(row));
        let mut target = asked;
        if let Some((place, factors)) = &self.factors {
            let state = read(*place, own, body).to_f64() as usize;
            target *= factors.get(state).copied().unwrap_or(R::ONE);
        }
        if let Some((field, gain)) = self.stimulus {
            target *= R::ONE + gain * field.at(view.space, view.now.position(row));
        }
        if let (Some(drive), Some(value)) = (plan.drive, body.get_mut(self.drive)) {
            let draws = DrawStream::new(view.seed, Purpose::Computation, view.step, view.now.id[row]);
            let kept = (-dt / drive.time).exp();
            let fresh = (R::ONE - kept * kept).most(R::ZERO).root();
            *value = *value * kept + drive.deviation * fresh * R::of(draws.normal_about(view.now.id[row], DRIVE));
            target *= R::ONE + *value;
        }
        if let Some(neighbours) = plan.neighbours
            && let Some(mean) = self.mean_speed(view, row, neighbours)
        {
            target += (mean - target) * neighbours.weight;
        }
        let target = target.clamped(plan.least, plan.greatest);
        let before = now.length();
        let gain = plan.acceleration.map_or(R::INFINITY, |most| most * dt);
        let loss = plan.deceleration.map_or(R::INFINITY, |most| most * dt);
        let speed = if target > before { target.least(before + gain) } else { target.most(before - loss) };
        let speed = speed.clamped(plan.least, plan.greatest);
        // a speed that is the law's own leaves its numbers as they are
        if (speed - asked).abs() <= R::of(1e-6) * R::of(1e-6) * asked.most(R::ONE) || !speed.finite() {
            return wanted;
        }
        let heading = wanted.velocity.unit_or(now.unit());
        let displacement = if asked > R::TINY { wanted.displacement * (speed / asked) } else { heading * (speed * dt) };
        Motion { velocity: heading * speed, displacement }
    }

    /// Mean speed of the living members of the own group nearer than a distance, in the order of ids.
    fn mean_speed(&self, view: &View<'_, R, D>, row: usize, neighbours: Neighbours<R>) -> Option<R> {
        let (place, limit) = (view.now.position(row), neighbours.within * neighbours.within);
        let (mut sum, mut count) = (R::ZERO, R::ZERO);
        for other in others(view, &self.own, row) {
            if view.space.offset(place, view.others.position(other)).length_squared() < limit {
                sum += view.others.velocity(other).length();
                count += R::ONE;
            }
        }
        (count > R::ZERO).then(|| sum / count)
    }
}

/// Rows of the other living members of a group, in the order of ids.
fn others<'a, R: Scalar, const D: usize>(
    view: &'a View<'_, R, D>,
    group: &GroupRange,
    row: usize,
) -> impl Iterator<Item = usize> + 'a {
    (group.first..group.first + group.count)
        .map(|id| view.rows.map_or(id as usize, |rows| rows[id as usize] as usize))
        .filter(move |&other| other != row && !view.dead(view.others, other))
}

/// What a body adapts to.
pub(crate) struct Adapts<R> {
    obstacle: Option<R>,
    collided: Option<usize>,
    crowd: Option<(R, usize)>,
    hold: R,
    timer: usize,
    own: GroupRange,
}

impl<R: Scalar> Adapts<R> {
    pub(crate) fn new(plan: &Adaptation<R>, group: &GroupRange, told: Told<'_>) -> Result<Self, String> {
        plan.check()?;
        Ok(Self {
            obstacle: plan.obstacle,
            collided: plan.collision.then(|| told.of_body(Adaptation::<R>::COLLIDED.name)),
            crowd: plan.crowd,
            hold: plan.hold,
            timer: told.of_body(Adaptation::<R>::TIMER.name),
            own: group.clone(),
        })
    }

    /// Notes the situation before a step.
    #[inline(never)]
    pub(crate) fn note<const D: usize>(&self, view: &View<'_, R, D>, row: usize, radius: R, dt: R, body: &mut [R]) {
        let met = self.collided.is_some_and(|at| body.get(at).is_some_and(|&count| count > R::ZERO))
            || self.obstacle.is_some_and(|within| near_obstacle(view, row, within + radius))
            || self.crowd.is_some_and(|crowd| self.crowded(view, row, crowd));
        if let Some(left) = body.get_mut(self.timer) {
            *left = if met { self.hold } else { (*left - dt).most(R::ZERO) };
        }
    }

    fn crowded<const D: usize>(&self, view: &View<'_, R, D>, row: usize, (within, least): (R, usize)) -> bool {
        let (place, limit) = (view.now.position(row), within * within);
        let near = |&other: &usize| view.space.offset(place, view.others.position(other)).length_squared() < limit;
        others(view, &self.own, row).filter(near).take(least).count() >= least
    }
}

/// Whether an obstacle or wall is nearer to a place than a distance.
fn near_obstacle<R: Scalar, const D: usize>(view: &View<'_, R, D>, row: usize, within: R) -> bool {
    let place = view.now.position(row);
    let wall = (0..D).any(|a| match view.space.edges[a] {
        Edge::Walls(length) => place.0[a] < within || length - place.0[a] < within,
        _ => false,
    });
    wall || !view.obstacles.is_empty() && view.obstacles.overlapping(place, within).is_some()
}
