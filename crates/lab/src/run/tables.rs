//! The columns of the tables that a run leaves: names, units, meanings.

use crate::scenario::{Precision, Scenario, Sensing};
use crate::store::table::{Heading, Kind};
use measure::Measure;
use space::{Column, ColumnKind};
use std::sync::Arc;
use swarm::World;
use swarm::models::{Catalogue, Models};
use swarm::parameters::Scalar;
use swarm::physics::Contact;

/// The tables of a run.
pub struct Tables {
    /// Of the trajectory: a row for each agent in each frame.
    pub frames: Vec<Heading>,
    /// Of the metrics: a row for each group at each measurement.
    pub metrics: Vec<Heading>,
    /// Of the events.
    pub events: Vec<Heading>,
    /// Words of the columns that hold words.
    pub(crate) words: Words,
}

/// Lists of words, shared by all blocks.
pub(crate) struct Words {
    pub(crate) groups: Arc<Vec<String>>,
    /// For each declared column that holds named states.
    pub(crate) labels: Vec<Option<Arc<Vec<String>>>>,
    pub(crate) events: Arc<Vec<String>>,
    /// Whether contacts are counted.
    pub(crate) contacts: bool,
    /// Whether somebody's moves are refused.
    pub(crate) refuses: bool,
    /// Whether somebody has a scanner, whose detections are counted.
    pub(crate) detections: bool,
}

/// Names of the axes.
pub const AXES: [&str; 3] = ["x", "y", "z"];
/// Names of the events, in the order of their numbers.
pub(crate) const EVENTS: [&str; 4] = ["ate", "died", "obstacle_appeared", "obstacle_disappeared"];

/// A share of members in a named state, as a column name.
pub fn share_name(column: &str, label: &str) -> String {
    format!("{column}_{}", label.replace(' ', "_"))
}

impl Tables {
    /// The tables of a world.
    pub fn new<R: Scalar, const D: usize>(
        world: &World<R, D>,
        scenario: &Scenario,
        metrics: &[Box<dyn Measure<D>>],
    ) -> Self
    where
        Models: Catalogue<R, D>,
    {
        let declared = world.frame().declared;
        let real = if scenario.precision == Precision::Single { Kind::Single } else { Kind::Double };
        let (length, time) = (&scenario.units.length, &scenario.units.time);
        let speed = format!("{length}/{time}");
        let mut frames = vec![
            Heading::new("run", "1", "Number of the run: 0.", Kind::Whole),
            Heading::new("frame", "1", "Number of the kept frame, from 0.", Kind::Long),
            Heading::new("t", time, "Time since the start.", Kind::Double).always(),
            Heading::new("id", "1", "Number of the agent in the world, from 0.", Kind::Whole),
            Heading::new("group", "", "Name of its group.", Kind::Word),
        ];
        for axis in &AXES[..D] {
            frames.push(Heading::new(axis, length, "Position.", real).always());
        }
        for axis in &AXES[..D] {
            frames.push(Heading::new(&format!("v{axis}"), &speed, "Velocity.", real).always());
        }
        for (c, column) in declared.iter().enumerate() {
            let unit = scenario.units.of(column.unit);
            let heading = Heading::new(column.name, &unit, column.about, kind_of(column, real));
            let everyone = world.groups().iter().all(|group| group.declares(c));
            let quantity = matches!(column.kind, ColumnKind::Quantity);
            frames.push(if everyone && quantity { heading.always() } else { heading });
        }
        let mut rows = vec![
            Heading::new("run", "1", "Number of the run: 0.", Kind::Whole),
            Heading::new("step", "1", "Steps since the start.", Kind::Long),
            Heading::new("t", time, "Time since the start.", Kind::Double),
            Heading::new("group", "", "Name of the group, or `all` for everyone together.", Kind::Word),
            Heading::new("members", "1", "Number of members measured; the dead are not.", Kind::Long),
        ];
        for metric in metrics {
            let card = metric.card();
            rows.push(Heading::new(card.id, &scenario.units.of(card.unit), card.definition, Kind::Double));
        }
        let mut labels = Vec::new();
        for column in declared {
            let ColumnKind::Label(names) = column.kind else {
                labels.push(None);
                continue;
            };
            for label in names {
                let about = format!("Share of members whose {} is `{label}`.", column.name);
                rows.push(Heading::new(&share_name(column.name, label), "1", &about, Kind::Double));
            }
            labels.push(Some(Arc::new(names.iter().map(|&name| name.to_owned()).collect())));
        }
        let contacts = !world.met().is_empty();
        let refuses = contacts && world.groups().iter().any(|group| group.contact() == Contact::Refuse);
        if contacts {
            let since = "since the measurement before";
            for what in CONTACTS {
                let about = format!("Contacts of members with {what} {since}.");
                rows.push(Heading::new(&format!("contacts_{what}"), "1", &about, Kind::Long));
            }
        }
        if refuses {
            let about =
                "Moves that were not made since the measurement before, since they would have ended in contact.";
            rows.push(Heading::new("refused_moves", "1", about, Kind::Long));
        }
        let detections = scenario.group.0.iter().any(|(_, group)| matches!(group.sensing, Some(Sensing::Laser(_))));
        if detections {
            for (name, what) in DETECTIONS {
                let about = format!("{what} since the measurement before, over all scanners; none for a single group.");
                rows.push(Heading::new(name, "1", &about, Kind::Double));
            }
        }
        let mut groups: Vec<String> = scenario.group.0.iter().map(|(name, _)| name.clone()).collect();
        if groups.len() > 1 {
            groups.push(crate::scenario::build::WHOLE_GROUP.to_owned());
        }
        Self {
            frames,
            metrics: rows,
            events: vec![
                Heading::new("run", "1", "Number of the run: 0.", Kind::Whole),
                Heading::new("step", "1", "Steps since the start.", Kind::Long),
                Heading::new("t", time, "Time since the start.", Kind::Double),
                Heading::new("event", "", "What happened.", Kind::Word),
                Heading::new("id", "1", "The agent concerned; -1 for none.", Kind::Long),
                Heading::new("other", "1", "The item eaten or the obstacle; -1 for none.", Kind::Long),
            ],
            words: Words {
                groups: Arc::new(groups),
                labels,
                events: Arc::new(EVENTS.map(str::to_owned).to_vec()),
                contacts,
                refuses,
                detections,
            },
        }
    }
}

/// What is met, in the order in which contacts are counted.
pub(crate) const CONTACTS: [&str; 3] = ["members", "obstacles", "walls"];

/// What scanners detect, in the order in which it is counted: names of columns, and what they hold.
pub(crate) const DETECTIONS: [(&str, &str); 4] = [
    ("members_in_view", "Members in range and field of view of a scan"),
    ("members_missed", "Members in view that nothing was detected of"),
    ("detections", "Inputs that detection found among the readings"),
    ("false_detections", "Inputs that belong to no member"),
];

fn kind_of(column: &Column, real: Kind) -> Kind {
    match column.kind {
        ColumnKind::Quantity => real,
        // a count can be missing, in groups that do not have it
        ColumnKind::Count => Kind::Double,
        ColumnKind::Label(_) => Kind::Word,
    }
}
