//! A scenario in the words of a methods section.

use super::agents::{Distribution, Given, default_in_files, unit_in_files};
use super::build::Schedule;
use super::sensing::{Detection, Occlusion};
use super::start::{Heading, Place};
use super::{Choice, Clock, Driver, Edges, Group, Order, Scenario, Sensing, Start, body::BodyMobility};
use crate::file::Form;
use swarm::parameters::{Kind, Value};

/// The paragraphs.
pub fn methods(scenario: &Scenario, schedule: &Schedule, seed: u64) -> Vec<String> {
    let mut paragraphs = vec![world(scenario, schedule)];
    paragraphs.extend(scenario.group.0.iter().map(|(name, group)| of_group(name, group, scenario)));
    paragraphs.push(kept(scenario, schedule, seed));
    paragraphs
}

fn number(value: f64) -> String {
    let text = format!("{value:.6}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A word with its number, in the singular where it is one: `1 agent`, `2 agents`.
fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// An amount of time. Some scenarios count in steps, which is a word and no symbol.
fn span(value: f64, time: &str) -> String {
    match time {
        "steps" if value == 1.0 => "1 step".to_owned(),
        _ => format!("{} {time}", number(value)),
    }
}

/// How often: `every 2 s`, `every step`.
fn every(value: f64, time: &str) -> String {
    if value == 1.0 && time == "steps" { "every step".to_owned() } else { format!("every {}", span(value, time)) }
}

/// What is drawn for each member, in words.
fn drawn(distribution: &Distribution, unit: &str) -> String {
    match distribution {
        Distribution::Normal(v) => format!(
            "from a normal distribution with a mean of {}{unit} and a standard deviation of {}{unit}",
            number(v[0]),
            number(v[1])
        ),
        Distribution::Truncated(v) => format!(
            "from a normal distribution with a mean of {}{unit} and a standard deviation of {}{unit}, cut off at {} and {}{unit}",
            number(v[0]),
            number(v[1]),
            number(v[2]),
            number(v[3])
        ),
        Distribution::Uniform(v) => format!("uniformly between {} and {}{unit}", number(v[0]), number(v[1])),
        other => format!("from `{}`{unit}", other.write().json()),
    }
}

fn listed(parts: &[String]) -> String {
    match parts {
        [] => String::new(),
        [one] => one.clone(),
        [most @ .., last] => format!("{} and {last}", most.join(", ")),
    }
}

fn world(scenario: &Scenario, schedule: &Schedule) -> String {
    let (length, time) = (&scenario.units.length, &scenario.units.time);
    let dimensions = scenario.space.dimensions;
    let axis = |a: usize| {
        let size =
            scenario.space.size.as_ref().and_then(|size| size.of(a)).map(|s| format!(" {} {length} long", number(s)));
        let size = size.unwrap_or_default();
        match scenario.space.edges.of(a) {
            Some(Edges::Walls) => format!("{size} between solid walls"),
            Some(Edges::Periodic) => format!("{size} and periodic"),
            Some(Edges::Open) | None => " open".to_owned(),
        }
    };
    // axes that are alike are told once
    let all: Vec<String> = (0..dimensions).map(axis).collect();
    let axes = match all.as_slice() {
        [one] => format!(", x{one}"),
        [first, rest @ ..] if rest.iter().all(|other| other == first) => format!(", each{first}"),
        all => {
            let parts: Vec<String> =
                ["x", "y", "z"].iter().zip(all).map(|(name, axis)| format!("{name}{axis}")).collect();
            format!(": {}", listed(&parts))
        }
    };
    let mut text = format!("The space had {}{axes}.", counted(dimensions, "dimension"));
    if !scenario.obstacle.is_empty() {
        text += &format!(" It held {}.", counted(scenario.obstacle.len(), "obstacle"));
    }
    for (name, scatter) in &scenario.scatter.0 {
        let many = match (scatter.count, scatter.percent) {
            (Some(count), _) => count.to_string(),
            (None, percent) => format!("as many as fill {} % of it", number(percent.unwrap_or(0.0))),
        };
        text += &format!(
            " Obstacles `{name}` were scattered at random: {many}, of radius {} {length}, none overlapping another.",
            number(scatter.radius)
        );
    }
    if let Some(food) = &scenario.food {
        let count = food.count.or(food.places.as_ref().map(Vec::len)).unwrap_or(0);
        text += &format!(
            " There {} {} of food; an item was consumed by the nearest living agent within {} {length}.",
            if count == 1 { "was" } else { "were" },
            counted(count, "item"),
            number(food.within)
        );
        if let Some(sharing) = &food.sharing {
            text += &format!(
                " Each mate within {} {length} of it got {} times what it got.",
                number(sharing.within),
                number(sharing.share)
            );
        }
        if let Some(living) = food.metabolism.as_ref().filter(|living| living.motion > 0.0) {
            text += &format!(" Motion cost {} times the squared speed per {time}", number(living.motion));
            text += &match &living.drafting {
                Some(drafting) => {
                    format!(", less {} of it for those who drafted behind a mate.", number(drafting.saving))
                }
                None => ".".to_owned(),
            };
        }
        for (_, predation) in &food.predation.0 {
            let prey: Vec<String> = predation.prey.iter().map(|name| format!("`{name}`")).collect();
            text += &format!(
                " Members of `{}` harmed the nearest of {} within {} {length}.",
                predation.hunters,
                listed(&prey),
                number(predation.within)
            );
        }
    }
    let order = match &scenario.time.driver {
        Driver::Synchronous(_) => "all agents read the state of one time and then moved together".to_owned(),
        Driver::Sequential(s) => match s.order {
            Order::Random => "agents moved one after the other, in a new random order every step".to_owned(),
            Order::RoundRobin => "agents moved one after the other, by number".to_owned(),
        },
        Driver::Asynchronous(a) => format!(
            "each agent decided on its own clock, {}{}; bodies moved in every step",
            every(a.period, time),
            match a.clock {
                Clock::Regular if a.jitter > 0.0 => format!(" give or take {} %", number(100.0 * a.jitter)),
                Clock::Regular => String::new(),
                Clock::Poisson => " in the mean, at random".to_owned(),
            }
        ),
    };
    let duration = schedule.step * schedule.steps as f64;
    // where time is counted in steps, that says it all
    let in_steps = if time == "steps" && schedule.step == 1.0 {
        String::new()
    } else {
        format!(" in {} of {}", counted(schedule.steps as usize, "step"), span(schedule.step, time))
    };
    text + &format!(" The simulation covered {}{in_steps}; {order}.", span(duration, time))
}

fn of_group(name: &str, group: &Group, scenario: &Scenario) -> String {
    let length = &scenario.units.length;
    let card = swarm::models::find(&group.model.id).map(|entry| entry.card);
    let (title, about, reference) = card.map_or(("", "", ""), |card| (card.title, card.about, card.reference));
    let mut text = format!(
        "The group `{name}` had {} of the model `{}` ({title}). {about} Reference: {}.",
        counted(group.count, "agent"),
        group.model.id,
        reference.trim_end_matches('.')
    );
    let descriptors = group.model.descriptors();
    let mut changed = Vec::new();
    for (parameter, given) in &group.model.parameters {
        let Some(descriptor) = descriptors.iter().find(|d| d.name == parameter) else { continue };
        let unit = unit_in_files(descriptor);
        let unit = if unit == "1" || unit == "-" { String::new() } else { format!(" {}", scenario.units.of(&unit)) };
        match given {
            Given::Value(value) if *value == default_in_files(descriptor) => {}
            Given::Value(Value::List(terms)) if descriptor.takes == Kind::Terms => {
                changed.push(format!("`{parameter}`: {}", listed(&terms.iter().map(term).collect::<Vec<_>>())));
            }
            Given::Value(value) => {
                let text = value.to_string();
                let text = if text.chars().count() > 60 {
                    "given for each member".to_owned()
                } else {
                    format!("{text}{unit}")
                };
                changed.push(format!("`{parameter}` = {text}"));
            }
            Given::Drawn(distribution) => {
                changed.push(format!("`{parameter}` drawn for each member {}", drawn(distribution, &unit)));
            }
        }
    }
    text += &if changed.is_empty() {
        " All parameters had their default values.".to_owned()
    } else {
        format!(" Parameters that differ from their defaults: {}.", changed.join("; "))
    };
    let default = Start::default();
    let start = group.start.as_ref().unwrap_or(&default);
    text += &match &start.place {
        Place::Anywhere(_) => " They began at random places in the space".to_owned(),
        Place::Box(_) => " They began at random places in a box".to_owned(),
        Place::Ball(ball) => format!(" They began at random places within {} {length} of a point", number(ball.radius)),
        Place::Lattice(lattice) => {
            format!(" They began on a square lattice with a spacing of {} {length}", number(lattice.spacing))
        }
        Place::Points(_) => " They began at given points".to_owned(),
    };
    if start.spacing > 0.0 {
        text += &format!(", at least {} {length} apart", number(start.spacing));
    }
    text += &match (&start.velocities, &start.heading) {
        (Some(_), _) => ", with given velocities.".to_owned(),
        (None, Heading::Random(_)) => ", each with a random heading.".to_owned(),
        (None, Heading::Along(_)) => ", all heading in the same, given direction.".to_owned(),
        (None, Heading::About(about)) => {
            format!(", heading in a given direction, with a standard deviation of {} degrees.", number(about.deviation))
        }
        (None, Heading::Common(common)) => {
            format!(", heading in one direction drawn for all, give or take {} degrees.", number(common.spread))
        }
    };
    text += &sensing(group, scenario);
    for (set, choice) in &group.select.0 {
        text += &format!(" The set `{set}` held those that `{}` selects.", selection(choice));
    }
    if let Some(conduct) = &group.conduct {
        let states: Vec<String> = conduct.states().into_iter().map(str::to_owned).collect();
        if !states.is_empty() {
            text += &format!(
                " A state machine stood over this law: in the states {} it gave way to them.",
                listed(&states)
            );
        }
    }
    text += &beside(group, scenario);
    if let Some(physics) = &group.physics {
        text += match &physics.mobility {
            BodyMobility::Ideal(_) => "",
            BodyMobility::ConstantSpeed(_) => " Bodies moved at a constant speed.",
            BodyMobility::TurnLimited(_) => " Bodies turned at a limited rate.",
            BodyMobility::DifferentialDrive(_) => " Bodies were robots that drive on two wheels.",
        };
        if let Some(radius) = physics.radius {
            text += &format!(" Bodies had a radius of {} {length}.", number(radius));
        }
        if let Some(contact) = physics.contact {
            text += &format!(" Where the way was not free, bodies obeyed the policy `{}`.", contact.word());
        }
        let noise = &physics.noise;
        if noise.computation > 0.0 || noise.execution_direction > 0.0 || noise.execution_speed > 0.0 {
            text += &format!(
                " Errors (standard deviations): of the wanted direction {} degrees, of the direction taken {} degrees, of the speed {} %.",
                number(noise.computation),
                number(noise.execution_direction),
                number(100.0 * noise.execution_speed)
            );
        }
    }
    text
}

/// What the group did beside its law.
fn beside(group: &Group, scenario: &Scenario) -> String {
    let (length, time) = (&scenario.units.length, &scenario.units.time);
    let mut text = String::new();
    if let Some(taxis) = &group.taxis {
        let share = number(100.0 * taxis.informed);
        let weight = match taxis.weight {
            Some(weight) => format!("with the weight {} beside the direction of the law", number(weight)),
            None => "in place of following the law".to_owned(),
        };
        let over = taxis.over.as_ref().map_or_else(String::new, |states| format!(", in the states {}", listed(states)));
        text += &format!(" Of its members {share} % went up the stimulus `{}`, {weight}{over}.", taxis.up);
    }
    if let Some(pace) = &group.pace {
        text += &format!(" Speeds varied from {} to {} {length}/{time}", number(pace.least), number(pace.greatest));
        let limits = [("gains", pace.acceleration), ("losses", pace.deceleration)];
        for (what, limit) in limits {
            if let Some(limit) = limit {
                text += &format!(", with {what} of up to {} per {time}", number(limit));
            }
        }
        let mut by: Vec<String> =
            pace.factors.0.iter().map(|(state, factor)| format!("{} times in `{state}`", number(*factor))).collect();
        if let Some(matched) = &pace.neighbours {
            let (share, within) = (number(100.0 * matched.weight), number(matched.within));
            by.push(format!("{share} % the mean speed of those within {within} {length}"));
        }
        if let Some(excited) = &pace.excited {
            by.push(format!("{} times the stimulus `{}` more", number(excited.gain), excited.by));
        }
        if let Some(drive) = &pace.drive {
            let (deviation, memory) = (number(100.0 * drive.deviation), number(drive.time));
            by.push(format!("an internal drive of {deviation} % that lasts {memory} {time}"));
        }
        text += &if by.is_empty() { ".".to_owned() } else { format!("; the target was the law's, {}.", listed(&by)) };
    }
    if let Some(told) = &group.obstacles {
        let within =
            told.within.map_or_else(|| "in reach".to_owned(), |within| format!("within {} {length}", number(within)));
        let which = match told.nearest {
            Some(1) => format!("the nearest obstacle or wall {within}"),
            Some(nearest) => format!("the {nearest} nearest obstacles and walls {within}"),
            None => format!("all obstacles and walls {within}"),
        };
        let taken = if told.members { ", and took them for members" } else { "" };
        text += &format!(" They were told of {which}{taken}.");
    }
    if let Some(adapt) = &group.adapt {
        let other: Vec<String> =
            adapt.to.0.iter().map(|(name, value)| format!("{name} = {}", value.0.tree.json())).collect();
        text += &format!(
            " Each changed to {} when {}, and for {} {time} after that.",
            listed(&other),
            super::beside::of_situation(adapt).join(" or "),
            number(adapt.hold)
        );
    }
    if let Some(decides) = &group.decides {
        let every = match &decides.every {
            super::PerMember::All(every) => number(*every),
            other => other.write().json().to_string(),
        };
        text += &match &scenario.time.driver {
            Driver::Asynchronous(_) => {
                let mut own = format!(" Members' own clocks had a period of {every} {time}");
                let given = [("phases", &decides.phase), ("jitters", &decides.jitter)];
                for (name, values) in given.into_iter().filter_map(|(name, values)| Some((name, values.as_ref()?))) {
                    own += &format!(", {name} of {}", values.write().json());
                }
                own + "."
            }
            _ => format!(" Members decided every {every} {time} and held their heading in between."),
        };
    }
    text
}

/// A stock term with its parameters.
fn term(term: &Value) -> String {
    let Value::Table(tagged) = term else { return String::new() };
    let one = |(id, given): (&String, &Value)| {
        let Value::Table(given) = given else { return id.clone() };
        let given: Vec<String> = given.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        format!("{id} ({})", given.join(", "))
    };
    tagged.iter().map(one).collect()
}

fn selection(choice: &Choice) -> String {
    choice.write().json().to_string()
}

fn sensing(group: &Group, scenario: &Scenario) -> String {
    match &group.sensing {
        None if super::build::blinded(&group.model.id, scenario) => {
            " They sensed the others exactly, but not behind obstacles.".to_owned()
        }
        None => " They sensed the others exactly.".to_owned(),
        Some(Sensing::Ideal(ideal)) => {
            let mut limits = Vec::new();
            if let Some(range) = ideal.range {
                limits.push(format!("within {} {}", number(range), scenario.units.length));
            }
            if let Some(opening) = ideal.field_of_view {
                limits.push(format!("in a cone of {} degrees about the heading", number(opening)));
            }
            match ideal.occlusion {
                Occlusion::None => {}
                Occlusion::Obstacles => limits.push("not behind obstacles".to_owned()),
                Occlusion::All => limits.push("not behind obstacles or bodies".to_owned()),
            }
            if let Some(free) = ideal.free.filter(|_| ideal.occlusion != Occlusion::None) {
                limits.push(format!("if at least {} % of their disc was free", number(100.0 * free)));
            }
            if let Some(pool) = &ideal.one_of {
                limits.push(format!(
                    "one at a time, drawn from the {} nearest by {}",
                    pool.nearest,
                    pool.weights.write().json()
                ));
            }
            let noise = &ideal.noise;
            if noise.distance > 0.0 || noise.direction > 0.0 || noise.heading > 0.0 || noise.miss > 0.0 {
                limits.push(format!(
                    "with errors (distance {} %, direction {} degrees, heading {} degrees, {} % missed)",
                    number(100.0 * noise.distance),
                    number(noise.direction),
                    number(noise.heading),
                    number(100.0 * noise.miss)
                ));
            }
            if limits.is_empty() {
                " They sensed the others exactly.".to_owned()
            } else {
                format!(" They sensed others {}.", listed(&limits))
            }
        }
        Some(Sensing::Laser(laser)) => {
            let detection = match laser.detection {
                Detection::SensorBased(_) => "every bright reading was an input",
                Detection::MemberBased(_) => "there was one input for each segment with the profile of a body",
                Detection::MemberExtrapolated(_) => {
                    "every reading of a segment with the profile of a body was an input"
                }
                Detection::Clustered(_) => "there was one input for each bright cluster about as wide as a body",
            };
            format!(
                " Each sensed the others with a laser scanner of {} rays and a range of {} m{}; {detection}{}.",
                laser.last_step - laser.first_step + 1,
                number(laser.longest_range),
                if laser.noise.is_some() { ", with noisy readings" } else { "" },
                if laser.association.is_some() { ", associated over time" } else { "" }
            )
        }
    }
}

fn kept(scenario: &Scenario, schedule: &Schedule, seed: u64) -> String {
    let time = &scenario.units.time;
    let of_steps = |steps: u64| every(steps as f64 * schedule.step, time);
    let mut text = format!("Metrics were computed {}", of_steps(schedule.measure));
    if scenario.record.trajectory {
        text += &format!(", and positions and velocities were kept {}", of_steps(schedule.record));
    }
    text + &format!(
        ". Random draws were counter-based (Philox4x32-10) with the seed {seed}; numbers had {} bits. The same file and seed give the same results to the last bit, on any number of threads.",
        match super::build::precision(scenario) {
            "f32" => 32,
            _ => 64,
        }
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_singular_and_steps_are_words() {
        assert_eq!([1, 2].map(|count| counted(count, "agent")), ["1 agent", "2 agents"]);
        assert_eq!(
            [every(1.0, "steps"), every(4.0, "steps"), every(1.0, "s")],
            ["every step", "every 4 steps", "every 1 s"]
        );
        assert_eq!([span(1.0, "steps"), span(0.5, "s")], ["1 step", "0.5 s"]);
        assert_eq!(drawn(&Distribution::Uniform(vec![1.0, 2.0]), " m"), "uniformly between 1 and 2 m");
    }
}
