//! What a group does beside its law: flee, hunt, rest, lead, explore.

use crate::form;
use space::Real;
use swarm::conduct;

form! {
    /// A state machine over the law of the group's model. The states that are given are tried in this order: who is threatened
    /// flees, else hunts, else rests, else leads, else explores, else moves by its law (`forage`).
    pub struct Conduct {
        /// Flight from the members of other groups.
        flee: Option<Flee> = none, "", Any;
        /// A hunt for the members of other groups.
        hunt: Option<Hunt> = none, "", Any;
        /// Rest while a store is full.
        rest: Option<Rest> = none, "", Any;
        /// Leadership of who is at the front edge of its group, for a while.
        lead: Option<Lead> = none, "", Any;
        /// A random walk where no food is near.
        explore: Option<Explore> = none, "", Any;
        /// Largest change of the velocity per time in these states; left out, any.
        acceleration: Option<f64> = none, "length/time^2", NonNegative;
    }
}

form! {
    /// Straight away from the nearest threat.
    pub struct Flee {
        /// The groups that are threats.
        from: Vec<String> = need, "", Any;
        /// A threat nearer than this is fled.
        within: f64 = need, "length", NonNegative;
        /// Speed of flight.
        speed: f64 = need, "length/time", NonNegative;
    }
}

form! {
    /// Straight towards the nearest prey.
    pub struct Hunt {
        /// The groups that are prey.
        prey: Vec<String> = need, "", Any;
        /// Prey nearer than this is hunted.
        within: f64 = need, "length", NonNegative;
        /// Speed of the hunt.
        speed: f64 = need, "length/time", NonNegative;
    }
}

form! {
    /// At rest while a store is full.
    pub struct Rest {
        /// The column of the store.
        column: String = ["energy".to_owned()], "", Any;
        /// Rest begins from this value on.
        from: f64 = need, "1", Any;
        /// Rest ends below this value, not above `from`.
        until: f64 = need, "1", Any;
    }
}

form! {
    /// Change of leadership by eccentricity.
    pub struct Lead {
        /// Members of the group nearer than this are seen.
        within: f64 = need, "length", Positive;
        /// Least eccentricity of who may lead: the distance to the centre of those seen over `within`, the centre lying behind.
        least: f64 = [0.3], "1", NonNegative;
        /// Chance of beginning per time, at an eccentricity of 1.
        rate: f64 = need, "1/time", NonNegative;
        /// How long it lasts.
        time: f64 = need, "time", NonNegative;
        /// Speed of a leader, straight on.
        speed: f64 = need, "length/time", NonNegative;
    }
}

form! {
    /// A random walk where no food is near.
    pub struct Explore {
        /// No item of food is nearer than this.
        without: f64 = need, "length", NonNegative;
        /// Speed of the walk.
        speed: f64 = need, "length/time", NonNegative;
        /// Standard deviation of the heading after a unit of time.
        turning: f64 = [20.0], "deg", NonNegative;
    }
}

impl Conduct {
    pub(super) fn resolved<R: Real>(&self) -> conduct::Conduct<R> {
        conduct::Conduct {
            flee: self.flee.as_ref().map(|flee| conduct::Flee {
                from: flee.from.clone(),
                within: R::of(flee.within),
                speed: R::of(flee.speed),
            }),
            hunt: self.hunt.as_ref().map(|hunt| conduct::Hunt {
                prey: hunt.prey.clone(),
                within: R::of(hunt.within),
                speed: R::of(hunt.speed),
            }),
            rest: self.rest.as_ref().map(|rest| conduct::Rest {
                column: rest.column.clone(),
                from: R::of(rest.from),
                until: R::of(rest.until),
            }),
            lead: self.lead.as_ref().map(|lead| conduct::Lead {
                within: R::of(lead.within),
                least: R::of(lead.least),
                rate: R::of(lead.rate),
                time: R::of(lead.time),
                speed: R::of(lead.speed),
            }),
            explore: self.explore.as_ref().map(|explore| conduct::Explore {
                without: R::of(explore.without),
                speed: R::of(explore.speed),
                turning: R::of(explore.turning.to_radians()),
            }),
            acceleration: self.acceleration.map(R::of),
        }
    }
    /// The states it has, in words.
    pub(super) fn states(&self) -> Vec<&'static str> {
        let there = [
            self.flee.is_some(),
            self.hunt.is_some(),
            self.rest.is_some(),
            self.lead.is_some(),
            self.explore.is_some(),
        ];
        let states = conduct::STATES[1..].iter().zip(there);
        states.filter(|(_, there)| *there).map(|(state, _)| *state).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]
mod tests {
    use crate::scenario::{build, describe};

    const FILE: &str = r#"
kind = "scenario"
title = "Hawks and doves"
time.duration = 20
[space]
dimensions = 2
edges = "walls"
size = 100
[food]
count = 4
within = 2
gains.energy = { amount = 5, capacity = 60 }
stores = { health = 10, energy = 50 }
sharing = { within = 5, share = 0.5 }
metabolism = { cost = 1, motion = 0.1, drafting = { within = 5, saving = 0.5 } }
predation.hawks = { hunters = "hawks", prey = ["doves"], within = 3, damage = 4, rebuttal = 1 }
[group.doves]
count = 20
model.vicsek_1995 = {}
conduct = { flee = { from = ["hawks"], within = 20, speed = 1 }, rest = { from = 58, until = 50 } }
[group.hawks]
count = 3
model.vicsek_1995 = {}
conduct = { hunt = { prey = ["doves"], within = 40, speed = 2 }, explore = { without = 10, speed = 2 } }
"#;

    #[test]
    fn hawks_catch_doves_of_any_model() {
        let read = build::read("file", FILE, &[]).unwrap();
        let mut world = build::world::<f64, 2>(&read.scenario, 3, 1).unwrap();
        assert_eq!((world.state(0, "health"), world.state(22, "energy")), (Some(10.0), Some(50.0)));
        world.run(20);
        let dead = (0..20).filter(|&id| world.state(id, "health") == Some(0.0)).count();
        assert!(dead > 0, "nobody was caught");
        let schedule = build::schedule(&read.scenario, false).unwrap();
        let text = describe::methods(&read.scenario, &schedule, 3).join(" ");
        for words in ["`hawks`", "flee and rest", "squared speed", "mate within 5"] {
            assert!(text.contains(words), "{words} is missing in: {text}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_at_its_place() {
        for (from, to, needle) in [
            ("from = [\"hawks\"]", "from = [\"hawk\"]", "did you mean `hawks`?"),
            ("prey = [\"doves\"], within = 3", "prey = [\"dove\"], within = 3", "did you mean `doves`?"),
            ("until = 50", "until = 70", "rest ends below 70"),
            ("rebuttal = 1", "rebutal = 1", "rebuttal"),
        ] {
            let text = FILE.replace(from, to);
            assert_ne!(text, FILE);
            let problems = build::read("file", &text, &[]).expect_err(needle).to_string();
            assert!(problems.contains(needle), "{problems}");
        }
    }
}
