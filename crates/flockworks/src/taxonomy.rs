//! The dissertation's tables of design (3.2) and validation (3.4), read from the cards, and conditions on what they classify.

use crate::fault::{Fault, hint, wrong};
use crate::models::{information, yes};
use clap::ValueEnum;
use swarm::card::{Avoidance, Composition, Taxonomy};
use swarm::models::papers::{PAPERS, Paper};
use swarm::models::{LIST, find};

/// Which of the two tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Classification {
    /// By design: what members are, do and use (Table 3.2).
    Design,
    /// By validation: how it was shown, and with which information (Table 3.4).
    Validation,
}

/// Columns of the table of design, and those of the table of validation.
const COLUMNS: [&[&str]; 2] = [
    &[
        "composition",
        "mobility",
        "time",
        "collision_avoidance",
        "identification",
        "position",
        "velocity",
        "orientation",
    ],
    &["validation", "synchronous", "info_position", "info_velocity", "info_orientation", "environment"],
];

impl Classification {
    fn columns(self) -> &'static [&'static str] {
        COLUMNS[self as usize]
    }
    fn has(self, paper: &Paper) -> bool {
        match self {
            Self::Design => paper.design,
            Self::Validation => paper.validation,
        }
    }
}

/// What a model is in one column.
fn class(taxonomy: &Taxonomy, column: &str) -> &'static str {
    let [position, velocity, orientation] = taxonomy.uses;
    let [of_position, of_velocity, of_orientation] = taxonomy.information;
    match column {
        "composition" => match taxonomy.composition {
            Composition::Homogeneous => "homogeneous",
            Composition::Heterogeneous => "heterogeneous",
        },
        "mobility" => ["constrained", "idealized"][usize::from(taxonomy.idealized)],
        "time" => ["continuous", "discrete"][usize::from(taxonomy.discrete)],
        "collision_avoidance" => match taxonomy.avoidance {
            Avoidance::None => "none",
            Avoidance::Member => "member",
            Avoidance::Environment => "environment",
            Avoidance::All => "all",
        },
        "identification" => yes(taxonomy.identification),
        "position" => yes(position),
        "velocity" => yes(velocity),
        "orientation" => yes(orientation),
        "validation" => taxonomy.validation,
        "synchronous" => yes(taxonomy.synchronous),
        "info_position" => information(of_position),
        "info_velocity" => information(of_velocity),
        "info_orientation" => information(of_orientation),
        _ => taxonomy.environment,
    }
}

/// What a column must say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    column: &'static str,
    value: String,
}

impl core::fmt::Display for Condition {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(out, "{}={}", self.column, self.value)
    }
}

/// Reads conditions such as `velocity=no collision=all`. A word without `=` belongs to the value before it, as in
/// `environment=bounded free`.
///
/// # Errors
/// A key or a value that no model has, with the nearest one.
pub fn conditions(text: &str) -> Result<Vec<Condition>, Fault> {
    let mut pairs: Vec<(&str, String)> = Vec::new();
    for word in text.split_whitespace() {
        match (word.split_once('='), pairs.last_mut()) {
            (Some((key, value)), _) => pairs.push((key, value.to_owned())),
            (None, Some((_, value))) => *value += &format!(" {word}"),
            (None, None) => {
                return wrong(format!("--where: expected `key=value`, such as `velocity=no`, found `{word}`"));
            }
        }
    }
    if pairs.is_empty() {
        return wrong("--where: expected at least one `key=value`, such as `velocity=no collision=all`");
    }
    pairs.into_iter().map(|(key, value)| condition(key, value)).collect()
}

fn condition(key: &str, value: String) -> Result<Condition, Fault> {
    let all: Vec<&'static str> = COLUMNS.into_iter().flatten().copied().collect();
    let begins: Vec<&'static str> = all.iter().copied().filter(|column| column.starts_with(key)).collect();
    let column = match (all.iter().find(|&&column| column == key), &begins[..]) {
        (Some(column), _) => *column,
        (None, [column]) => column,
        (None, []) => {
            return wrong(format!("--where: unknown key `{key}`{}; keys are {}", hint(key, &all), all.join(", ")));
        }
        (None, several) => {
            return wrong(format!("--where: `{key}` could be {}; write more of it", several.join(" or ")));
        }
    };
    let mut values: Vec<&str> = LIST.iter().map(|entry| class(&entry.card.taxonomy, column)).collect();
    values.sort_unstable();
    values.dedup();
    if values.contains(&value.as_str()) {
        return Ok(Condition { column, value });
    }
    wrong(format!(
        "--where: no model has `{column}={value}`{}; values are {}",
        hint(&value, &values),
        values.join(", ")
    ))
}

/// Whether a model meets all conditions.
pub fn meets(taxonomy: &Taxonomy, conditions: &[Condition]) -> bool {
    conditions.iter().all(|condition| class(taxonomy, condition.column) == condition.value)
}

/// Refuses conditions that no model meets together: names the first that leaves none, and what those before it leave.
///
/// # Errors
/// No model meets them all.
pub fn leave_some(conditions: &[Condition]) -> Result<(), Fault> {
    let mut left: Vec<&Taxonomy> = LIST.iter().map(|entry| &entry.card.taxonomy).collect();
    for (k, last) in conditions.iter().enumerate() {
        let before = &conditions[..k];
        if let Some(other) = before.iter().find(|other| other.column == last.column && other.value != last.value) {
            return wrong(format!("--where: no model meets both `{other}` and `{last}`: each has one value"));
        }
        let (met, others): (Vec<&Taxonomy>, Vec<&Taxonomy>) =
            left.into_iter().partition(|taxonomy| class(taxonomy, last.column) == last.value);
        if met.is_empty() {
            let before: Vec<String> = before.iter().map(ToString::to_string).collect();
            let mut values: Vec<&str> = others.iter().map(|taxonomy| class(taxonomy, last.column)).collect();
            values.sort_unstable();
            values.dedup();
            return wrong(format!(
                "--where: no model meets all conditions: none of the {} with `{}` has `{last}`, only {}",
                others.len(),
                before.join(" "),
                values.join(", ")
            ));
        }
        left = met;
    }
    Ok(())
}

/// Headings and rows of a table: the publications, then the models that are in none of them.
pub fn rows_of(which: Classification, conditions: &[Condition]) -> (Vec<&'static str>, Vec<Vec<String>>) {
    let mut headings = vec!["paper", "model_ids"];
    headings.extend(which.columns());
    headings.push("note");
    let mut rows = Vec::new();
    let mut add = |name: String, ids: String, taxonomy: &Taxonomy, note: &str| {
        if meets(taxonomy, conditions) {
            let mut row = vec![name, ids];
            row.extend(which.columns().iter().map(|column| class(taxonomy, column).to_owned()));
            row.push(note.to_owned());
            rows.push(row);
        }
    };
    let papers = || PAPERS.iter().filter(|paper| which.has(paper));
    for paper in papers() {
        if let Some(entry) = paper.models.first().and_then(|id| find(id)) {
            add(paper.name.into(), paper.models.join(";"), &entry.card.taxonomy, paper.note);
        }
    }
    for entry in LIST {
        let card = entry.card;
        if !papers().any(|paper| paper.models.contains(&card.id)) {
            add(format!("ours: {}", card.title), card.id.into(), &card.taxonomy, "ours");
        }
    }
    (headings, rows)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    /// The rows of a file of comma-separated values.
    fn csv(text: &str) -> Vec<Vec<String>> {
        let cells = |line: &str| {
            let (mut cells, mut quoted) = (vec![String::new()], false);
            for letter in line.chars() {
                match letter {
                    '"' => quoted = !quoted,
                    ',' if !quoted => cells.push(String::new()),
                    other => cells.last_mut().unwrap().push(other),
                }
            }
            cells
        };
        text.lines().map(cells).collect()
    }

    /// The transcription of both tables, with our own rows, as the project's specification has it.
    #[test]
    fn the_tables_are_those_of_the_dissertation() {
        let expected = csv(include_str!("../tests/expected/taxonomy.csv"));
        let (headings, expected) = expected.split_first().unwrap();
        for which in [Classification::Design, Classification::Validation] {
            let (columns, rows) = rows_of(which, &[]);
            let place = |column: &str| headings.iter().position(|heading| heading == column).unwrap();
            let in_table = |row: &&Vec<String>| !row[place(which.columns()[0])].is_empty();
            let mut count = 0;
            for expected in expected.iter().filter(in_table) {
                let found = rows.iter().find(|row| row[0] == expected[0]).unwrap();
                for (k, column) in columns.iter().enumerate() {
                    // of two publications the sources give no law, so that the specification has no model of them
                    let unnamed = *column == "model_ids" && expected[place(column)].is_empty();
                    assert!(unnamed || found[k] == expected[place(column)], "{}: {column}", expected[0]);
                }
                count += 1;
            }
            // in the order of the file, and only then the models that have no row in it
            assert!(rows[..count].iter().map(|row| &row[0]).eq(expected.iter().filter(in_table).map(|row| &row[0])));
            assert!(rows[count..].iter().all(|row| row[0].starts_with("ours: ")));
        }
    }

    #[test]
    fn conditions_choose_and_wrong_ones_name_the_nearest() {
        let ids = |text: &str| {
            let conditions = conditions(text).unwrap();
            let chosen = LIST.iter().filter(|entry| meets(&entry.card.taxonomy, &conditions));
            chosen.map(|entry| entry.card.id).collect::<Vec<_>>()
        };
        let found = ids("velocity=no collision=all");
        assert!(found.contains(&"olfati_saber_2006") && found.contains(&"mataric_1993"), "{found:?}");
        assert!(!found.contains(&"helbing_2005") && !found.contains(&"vicsek_1995"));
        assert!(ids("environment=bounded free identification=yes").contains(&"kelly_keating_1996"));
        let told = |text: &str| conditions(text).unwrap_err().to_string();
        assert!(told("velocty=no").contains("did you mean `velocity`?"));
        assert!(told("velocity=nope").contains("values are no, yes"));
        assert!(told("info=global").contains("info_position or info_velocity"));
        let left = |text: &str| leave_some(&conditions(text).unwrap());
        assert!(left("velocity=no collision=all").is_ok() && left("velocity=no velocity=no").is_ok());
        let none = |text: &str| left(text).unwrap_err().to_string();
        assert!(none("velocity=no time=discrete velocity=yes").contains("both `velocity=no` and `velocity=yes`"));
        let nobody = none("velocity=no identification=yes collision=environment time=discrete");
        assert!(nobody.contains("with `velocity=no identification=yes` has `collision_avoidance=environment`, only "));
        assert!(told("no").contains("expected `key=value`") && told(" ").contains("at least one"));
    }
}
