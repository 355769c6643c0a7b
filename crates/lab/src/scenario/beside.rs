//! What a group does beside its law: taxis up a stimulus, a pace, other parameters in a situation, decisions now and then.

use super::agents::{Given, PerMember};
use super::build::{Wrong, vector};
use crate::file::{Anything, Desk, Form, Named, Node, Rule, Tree};
use crate::{form, tagged, words};
use space::{Real, Vector};
use swarm::adaptation::Adaptation;
use swarm::engine::ClockPlan;
use swarm::parameters::Values;
use swarm::{pace, stimulus};

words! {
    /// How an intensity falls off with the distance d.
    pub enum Decay {
        /// exp(-d / length).
        Exponential = "exponential",
        /// 1 / (1 + (d / length)^2).
        InverseSquare = "inverse_square",
    }
}

form! {
    /// A point that sends out something.
    pub struct Point {
        /// Where it is.
        at: Vec<f64> = need, "length", Any;
        /// Intensity there.
        strength: f64 = [1.0], "1", Any;
        /// Length of the decay.
        length: f64 = need, "length", Positive;
        /// Law of the decay.
        decay: Decay = [Decay::Exponential], "", Any;
    }
}

tagged! {
    /// A scalar field over the space that bodies may sense.
    pub enum Stimulus {
        /// A point that sends out something.
        point => Point(Point);
        /// A field that grows evenly: its slope along each axis.
        gradient in "1/length", swarm::parameters::Range::Any => Gradient(Vec<f64>);
    }
}

impl Stimulus {
    /// The field; wrongs carry paths below it.
    pub(super) fn resolved<R: Real, const D: usize>(&self, name: &str) -> Result<stimulus::Stimulus<R, D>, Wrong> {
        let of = |numbers: &[f64], path: &str| -> Result<Vector<R, D>, Wrong> {
            vector(numbers).map_err(|what| Wrong::new(path, what, format!("{D} numbers")))
        };
        let field = match self {
            Self::Point(point) => stimulus::Field::Point {
                at: of(&point.at, "point.at")?,
                strength: R::of(point.strength),
                length: R::of(point.length),
                decay: match point.decay {
                    Decay::Exponential => stimulus::Decay::Exponential,
                    Decay::InverseSquare => stimulus::Decay::InverseSquare,
                },
            },
            Self::Gradient(slope) => stimulus::Field::Gradient(of(slope, "gradient")?),
        };
        Ok(stimulus::Stimulus { name: name.to_owned(), field })
    }
}

form! {
    /// How members go up a stimulus: towards the side of the body on which sensors read more.
    pub struct Taxis {
        /// The stimulus, by its name.
        up: String = need, "", Any;
        /// Share of the members that are informed: the first so many of the group.
        informed: f64 = [1.0], "1", Within(0.0, 1.0);
        /// Weight beside the direction of the law, which has 1; left out, it replaces that direction.
        weight: Option<f64> = none, "1", NonNegative;
        /// Places of the sensors on the body: ahead, to the left, up; left out, one at a length of 1 on each side.
        sensors: Option<Vec<Vec<f64>>> = none, "length", Any;
        /// Where the mean reading stays below, nothing is sensed.
        threshold: f64 = [0.0], "1", Any;
        /// States of the law in which it acts, so that the others go before it; left out, it acts in all.
        over: Option<Vec<String>> = none, "", Any;
        /// The column with these states.
        column: String = ["behaviour".to_owned()], "", Any;
    }
}

impl Taxis {
    pub(super) fn resolved<R: Real>(&self, dimensions: usize) -> stimulus::Taxis<R> {
        let usual = || {
            let side = |k: usize, sign: f64| (0..dimensions).map(|a| if a == k { sign } else { 0.0 }).collect();
            (0..dimensions).flat_map(|k| [side(k, 1.0), side(k, -1.0)]).collect::<Vec<Vec<f64>>>()
        };
        let sensors = self.sensors.clone().unwrap_or_else(usual);
        stimulus::Taxis {
            up: self.up.clone(),
            informed: R::of(self.informed),
            sensors: sensors.iter().map(|sensor| sensor.iter().map(|&x| R::of(x)).collect()).collect(),
            weight: self.weight.map(R::of),
            threshold: R::of(self.threshold),
            over: self.over.as_ref().map(|states| (self.column.clone(), states.clone())),
        }
    }
}

form! {
    /// Neighbours whose speed is matched: acceleration in alignment.
    pub struct Matched {
        /// Members of the group nearer than this.
        within: f64 = need, "length", Positive;
        /// Share of their mean speed in the target.
        weight: f64 = need, "1", Within(0.0, 1.0);
    }
}

form! {
    /// A stimulus that makes faster or slower.
    pub struct Excited {
        /// The stimulus, by its name.
        by: String = need, "", Any;
        /// Share by which the target grows with an intensity of 1; negative: it becomes less.
        gain: f64 = need, "1", Any;
    }
}

form! {
    /// An internal drive that comes and goes: a Gaussian process with an exponential correlation.
    pub struct Drive {
        /// Standard deviation, as a share of the target.
        deviation: f64 = need, "1", NonNegative;
        /// Time in which its correlation falls to 1/e.
        time: f64 = need, "time", Positive;
    }
}

form! {
    /// How fast members are, where the law says the direction: the speed follows a target within limits of acceleration. The target
    /// is the speed of the law, times a factor of the state, times what stimulus and drive make of it, drawn to the mean speed of
    /// neighbours.
    pub struct Pace {
        /// Least speed.
        least: f64 = need, "length/time", Positive;
        /// Greatest speed.
        greatest: f64 = need, "length/time", Positive;
        /// Largest gain of speed per time; left out, any.
        acceleration: Option<f64> = none, "length/time^2", NonNegative;
        /// Largest loss of speed per time; left out, any.
        deceleration: Option<f64> = none, "length/time^2", NonNegative;
        /// Factors by state, as `{ avoid = 0.5, attract = 1.5 }`; other states have 1.
        factors: Named<f64> = [Named::default()], "1", NonNegative;
        /// The column with these states.
        column: String = ["behaviour".to_owned()], "", Any;
        /// Neighbours whose speed is matched.
        neighbours: Option<Matched> = none, "", Any;
        /// A stimulus that makes faster or slower.
        excited: Option<Excited> = none, "", Any;
        /// An internal drive.
        drive: Option<Drive> = none, "", Any;
    }
}

impl Pace {
    pub(super) fn resolved<R: Real>(&self) -> pace::Pace<R> {
        let factors = || self.factors.0.iter().map(|(state, factor)| (state.clone(), R::of(*factor))).collect();
        pace::Pace {
            least: R::of(self.least),
            greatest: R::of(self.greatest),
            acceleration: self.acceleration.map(R::of),
            deceleration: self.deceleration.map(R::of),
            states: (!self.factors.0.is_empty()).then(|| (self.column.clone(), factors())),
            neighbours: self
                .neighbours
                .as_ref()
                .map(|n| pace::Neighbours { within: R::of(n.within), weight: R::of(n.weight) }),
            stimulus: self.excited.as_ref().map(|excited| (excited.by.clone(), R::of(excited.gain))),
            drive: self
                .drive
                .as_ref()
                .map(|drive| pace::Drive { deviation: R::of(drive.deviation), time: R::of(drive.time) }),
        }
    }
}

form! {
    /// Others near by.
    pub struct Crowd {
        /// Members of the group nearer than this.
        within: f64 = need, "length", Positive;
        /// At least so many.
        count: usize = need, "1", Positive;
    }
}

form! {
    /// Other parameters of the law, agent by agent, from the step after a situation was met on, and for a time after it was met last.
    /// The situation is any of those that are given.
    pub struct Adapt {
        /// The parameters that then hold, as `{ preferred_neighbours = 10, growth = 2 }`.
        to: Named<Anything> = need, "", Any;
        /// An obstacle or wall is nearer to the surface of the body than this.
        obstacle: Option<f64> = none, "length", Positive;
        /// The body met something in the step before.
        collision: bool = [false], "", Any;
        /// Many are near.
        crowd: Option<Crowd> = none, "", Any;
        /// How long they hold.
        hold: f64 = need, "time", NonNegative;
    }
}

impl Adapt {
    /// The plan for a group of a model; wrongs carry paths below it.
    pub(super) fn resolved<R: Real>(&self, model: &str) -> Result<Adaptation<R>, Wrong> {
        let mut parameters = Values::new();
        for (name, given) in &self.to.0 {
            let node = Node { tree: Tree::table([(name.clone(), given.0.tree.clone())]), span: given.0.span.clone() };
            let below = Tree::table([(model.to_owned(), node.tree)]);
            let mut desk = Desk::default();
            let read = super::Model::read(&Node { tree: below, span: node.span }, &Rule::FREE, &mut desk);
            if let Some(problem) = desk.problems.into_iter().next() {
                return Err(Wrong::new(format!("to.{name}"), problem.what, problem.expected).help(&problem.help));
            }
            let Some(read) = read else { continue };
            if read.parameters.iter().any(|(_, given)| matches!(given, Given::Drawn(_))) {
                let what = "parameters of a situation are the same for all members";
                return Err(Wrong::new(format!("to.{name}"), what, "one value"));
            }
            parameters.extend(read.values(0, 0, 0));
        }
        Ok(Adaptation {
            parameters,
            obstacle: self.obstacle.map(R::of),
            collision: self.collision,
            crowd: self.crowd.as_ref().map(|crowd| (R::of(crowd.within), crowd.count)),
            hold: R::of(self.hold),
        })
    }
}

form! {
    /// Decisions now and then; in between, the heading is held. Under an asynchronous driver, clocks that differ from the driver's;
    /// in between, the last decision is carried out. For all, a list with one for each member, or a distribution.
    pub struct Decides {
        /// Time between two decisions: rounded to steps, or under an asynchronous driver the period of the clock.
        every: PerMember = need, "time", Positive;
        /// Time of the first decision, under an asynchronous driver; left out, as the driver says.
        phase: Option<PerMember> = none, "time", NonNegative;
        /// Largest deviation from the period, as a share of it, under an asynchronous driver; left out, as the driver says.
        jitter: Option<PerMember> = none, "1", Within(0.0, 0.999);
    }
}

impl Decides {
    /// Times between two decisions of each member.
    fn times(&self, count: usize, seed: u64, first: u32) -> Result<Vec<f64>, Wrong> {
        let wrong = |found| Wrong::new("every", format!("{found} intervals for {count} members"), "one for each");
        self.every.values(count, seed, "decides", first).map_err(wrong)
    }
    /// Steps between two decisions of each member, where all have one step.
    pub(super) fn intervals(&self, step: f64, count: usize, seed: u64, first: u32) -> Result<Vec<u64>, Wrong> {
        for (key, given) in [("phase", &self.phase), ("jitter", &self.jitter)] {
            if given.is_some() {
                let what = format!("`{key}` is one of a clock, and there are none under this driver");
                return Err(Wrong::new(key, what, "`time.driver.asynchronous`, or leave it out"));
            }
        }
        let times = self.times(count, seed, first)?;
        Ok(times.iter().map(|time| (time / step).round().clamp(1.0, 1e15) as u64).collect())
    }
    /// The clocks of each member.
    pub(super) fn clocks(&self, count: usize, seed: u64, first: u32) -> Result<ClockPlan, Wrong> {
        let all = |key: &str, given: &Option<PerMember>| {
            let Some(given) = given else { return Ok(Vec::new()) };
            let wrong = |found| Wrong::new(key, format!("{found} values for {count} members"), "one for each");
            given.values(count, seed, &format!("decides.{key}"), first).map_err(wrong)
        };
        let (phase, jitter) = (all("phase", &self.phase)?, all("jitter", &self.jitter)?);
        Ok(ClockPlan { period: self.times(count, seed, first)?, phase, jitter })
    }
}

/// The situation of an adaptation, in words.
pub(super) fn of_situation(adapt: &Adapt) -> Vec<String> {
    let mut when = Vec::new();
    if let Some(within) = adapt.obstacle {
        when.push(format!("an obstacle or wall was nearer than {within}"));
    }
    if adapt.collision {
        when.push("it had met something".to_owned());
    }
    if let Some(crowd) = &adapt.crowd {
        when.push(format!("{} others were nearer than {}", crowd.count, crowd.within));
    }
    when
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]
mod tests {
    use crate::scenario::{build, describe};

    const FILE: &str = r#"
kind = "scenario"
title = "Everything at once"
time.duration = 4
[space]
dimensions = 3
edges = "walls"
size = 80
[stimulus.lamp.point]
at = [70, 40, 40]
length = 30
[group.fish]
count = 30
start = { place.ball = { centre = [40, 40, 40], radius = 12 }, spacing = 2 }
[group.fish.model.behaviour_selection]
preferred_neighbours = { normal = [10, 3] }
considered = { uniform = [2, 8] }
speed = { truncated = [6, 2, 4, 8] }
field_of_view = { constant = 300 }
[group.fish.taxis]
up = "lamp"
informed = 0.2
over = ["search", "align", "attract"]
[group.fish.pace]
least = 2
greatest = 10
acceleration = 5
factors = { avoid = 0.5 }
neighbours = { within = 20, weight = 0.3 }
excited = { by = "lamp", gain = -0.2 }
drive = { deviation = 0.1, time = 3 }
[group.fish.adapt]
to = { growth = 4 }
obstacle = 4
collision = true
hold = 2
[group.fish.decides]
every = { uniform = [0.1, 0.5] }
[group.fish.sensing.ideal]
occlusion = "all"
free = 0.4
one_of = { nearest = 5, weights = { inverse_square = {} } }
"#;

    #[test]
    fn everything_may_stand_beside_a_law() {
        let read = build::read("file", FILE, &[]).unwrap();
        let mut world = build::world::<f64, 3>(&read.scenario, 5, 1).unwrap();
        let of = |world: &swarm::World<f64, 3>, column: &str| -> Vec<f64> {
            (0..30).map(|id| world.state(id, column).unwrap()).collect()
        };
        let speeds = of(&world, "parameter_speed");
        assert!(speeds.iter().all(|v| (4.0..=8.0).contains(v)) && speeds.iter().any(|v| *v != speeds[0]));
        let mean = speeds.iter().sum::<f64>() / 30.0;
        assert!((mean - 6.0).abs() < 0.8, "{mean}");
        assert!(of(&world, "parameter_considered").iter().all(|n| n.fract() == 0.0 && (2.0..=8.0).contains(n)));
        let view = world.state(3, "parameter_field_of_view").unwrap();
        assert_eq!(view, 300.0, "this law takes degrees");
        world.run(40);
        assert!(world.frame().finite());
        assert_eq!(of(&world, "informed").iter().sum::<f64>(), 6.0);
        assert!((0..30).all(|id| (2.0 - 1e-9..=10.0 + 1e-9).contains(&world.velocity(id).length())));
        // the same seed gives the same values, another one others
        let again = build::world::<f64, 3>(&read.scenario, 5, 1).unwrap();
        let other = build::world::<f64, 3>(&read.scenario, 6, 1).unwrap();
        assert!(of(&again, "parameter_speed") == speeds && of(&other, "parameter_speed") != speeds);
        let schedule = build::schedule(&read.scenario, false).unwrap();
        let text = describe::methods(&read.scenario, &schedule, 5).join(" ");
        for words in [
            "20 % went up the stimulus `lamp`",
            "Speeds varied from 2 to 10",
            "it had met something",
            "one at a time",
            "40 % of their disc",
            "Members decided every",
        ] {
            assert!(text.contains(words), "{words} is missing in: {text}");
        }
    }

    #[test]
    fn clocks_and_obstacles_of_a_group_are_its_own() {
        let text = FILE
            .replacen(
                "[group.fish.decides]",
                "[group.fish.obstacles]\nwithin = 9\nnearest = 2\nmembers = true\n[group.fish.decides]",
                1,
            )
            .replacen(
                "every = { uniform = [0.1, 0.5] }",
                "every = { uniform = [0.1, 0.5] }\nphase = 0.3\njitter = 0.05",
                1,
            );
        let clocks = ["time.driver={ asynchronous = { tick = 0.02, period = 0.1 } }".to_owned()];
        let read = build::read("file", &text, &clocks).unwrap();
        let mut world = build::world::<f64, 3>(&read.scenario, 5, 1).unwrap();
        world.run(100);
        assert!(world.frame().finite());
        let schedule = build::schedule(&read.scenario, false).unwrap();
        let told = describe::methods(&read.scenario, &schedule, 5).join(" ");
        for words in [
            "clocks had a period of {\"uniform\":[0.1,0.5]}",
            "phases of 0.3, jitters of 0.05",
            "the 2 nearest obstacles and walls within 9",
            "took them for members",
        ] {
            assert!(told.contains(words), "{words} is missing in: {told}");
        }
        let short = build::read("file", &text.replacen("phase = 0.3", "phase = [0.3, 0.1]", 1), &clocks);
        let problems = short.expect_err("two phases").to_string();
        assert!(problems.contains("2 values for 30 members"), "{problems}");
    }

    #[test]
    fn what_is_wrong_is_told_at_its_place() {
        for (from, to, needle) in [
            ("up = \"lamp\"", "up = \"lamb\"", "did you mean `lamp`?"),
            ("over = [\"search\"", "over = [\"serch\"", "did you mean `search`?"),
            ("factors = { avoid", "factors = { avoidd", "did you mean `avoid`?"),
            ("least = 2", "least = 20", "not above the greatest"),
            ("to = { growth = 4 }", "to = { grwth = 4 }", "did you mean `growth`?"),
            ("to = { growth = 4 }", "to = { growth = -4 }", "0 or more"),
            ("to = { growth = 4 }", "to = { growth = { normal = [4, 1] } }", "the same for all members"),
            ("at = [70, 40, 40]", "at = [70, 40]", "2 coordinates in a space of 3 dimensions"),
            ("every = { uniform = [0.1, 0.5] }", "every = [0.1, 0.5]", "2 intervals for 30 members"),
            ("every = { uniform = [0.1, 0.5] }", "every = 0.5\njitter = 0.1", "none under this driver"),
            ("[group.fish.adapt]", "[group.fish.obstacles]\nnearest = 0\n[group.fish.adapt]", "nearest"),
            ("[group.fish.adapt]", "[group.fish.obstacles]\nwithn = 3\n[group.fish.adapt]", "did you mean `within`?"),
            (
                "field_of_view = { constant = 300 }",
                "field_of_view = { list = [300, 270] }",
                "has 2 values for 30 members",
            ),
            ("truncated = [6, 2, 4, 8]", "truncated = [6, 2, 8, 4]", "the third not above the last"),
            ("preferred_neighbours", "body_radius = { uniform = [1, 2] }\npreferred_neighbours", "body radius"),
        ] {
            let text = FILE.replacen(from, to, 1);
            assert_ne!(text, FILE);
            let problems = build::read("file", &text, &[]).expect_err(needle).to_string();
            assert!(problems.contains(needle), "{needle} is not in: {problems}");
        }
    }
}
