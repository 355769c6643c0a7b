//! What is marked on the time line of a recording: gaps in the tracks of individuals, what was flagged, what groups did.

use super::column;
use crate::store::StoreError;
use crate::store::table::Table;
use serde_json::{Value as Json, json};

/// Marks of each kind that the page is told, at most; of gaps the longest, of others the first.
const MOST: usize = 400;

/// Something from one frame to another, by their places among the frames.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// `gap`, `flag` or `event`.
    pub kind: &'static str,
    pub what: String,
    pub from: usize,
    pub to: usize,
}

/// Finds gaps while rows go by: frames between an individual's first and last without a position.
pub(super) struct Gaps {
    last: Vec<Option<usize>>,
    found: Vec<(usize, usize, usize)>,
}

impl Gaps {
    pub(super) fn new(individuals: usize) -> Self {
        Self { last: vec![None; individuals], found: Vec::new() }
    }
    /// An individual has a position in a frame. Frames come in their order.
    pub(super) fn see(&mut self, individual: usize, frame: usize) {
        let Some(last) = self.last.get_mut(individual) else { return };
        if let Some(before) = last.filter(|before| before + 1 < frame) {
            self.found.push((individual, before + 1, frame - 1));
        }
        *last = Some(frame);
    }
    /// The gaps as marks, in the order of time.
    pub(super) fn marks(mut self, names: &[String]) -> Vec<Mark> {
        self.found.sort_by_key(|&(individual, from, to)| (core::cmp::Reverse(to - from), from, individual));
        self.found.truncate(MOST);
        self.found.sort_by_key(|&(individual, from, _)| (from, individual));
        let mark = |(individual, from, to): (usize, usize, usize)| {
            let frames = to - from + 1;
            let frames = if frames == 1 { "1 frame".to_owned() } else { format!("{frames} frames") };
            Mark { kind: "gap", what: format!("{} is missing for {frames}", called(names, individual)), from, to }
        };
        self.found.into_iter().map(mark).collect()
    }
}

/// What an individual is called: a name that is a bare number says what it is a number of.
pub(super) fn called(names: &[String], individual: usize) -> String {
    match names.get(individual) {
        Some(name) if name.parse::<f64>().is_ok() => format!("individual {name}"),
        Some(name) => name.clone(),
        None => format!("individual {individual}"),
    }
}

/// What the table of events tells of a recording. The same of one individual in frames that follow each other is one mark.
pub(super) fn told(
    table: &Table,
    recording: usize,
    numbers: &[i64],
    names: &[String],
) -> Result<Vec<Mark>, StoreError> {
    let wanted =
        ["run", "frame", "event", "id"].map(|name| column(table, name)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut found: Vec<(String, i64, usize, usize)> = Vec::new();
    for group in 0..table.groups() {
        let read = table.read(group, &wanted)?;
        for row in (0..read[0].len()).filter(|&row| read[0].number(row) as usize == recording) {
            let Ok(frame) = numbers.binary_search(&(read[1].number(row) as i64)) else { continue };
            let (event, id) = (read[2].text(row), read[3].number(row) as i64);
            let same = |mark: &&mut (String, i64, usize, usize)| mark.0 == event && mark.1 == id && mark.3 + 1 >= frame;
            match found.iter_mut().rev().take(names.len() + 8).find(same) {
                Some(mark) => mark.3 = frame,
                None => found.push((event, id, frame, frame)),
            }
        }
    }
    found.truncate(MOST);
    let mark = |(event, id, from, to): (String, i64, usize, usize)| {
        let what = event.replace('_', " ");
        match usize::try_from(id) {
            Ok(id) => Mark { kind: "flag", what: format!("flagged: {what} of {}", called(names, id)), from, to },
            Err(_) => Mark { kind: "event", what, from, to },
        }
    };
    Ok(found.into_iter().map(mark).collect())
}

/// Marks as the scene lists them, in the order of time.
pub(super) fn listed(mut marks: Vec<Mark>, times: &[f64]) -> Vec<Json> {
    marks.sort_by_key(|mark| mark.from);
    let one = |mark: &Mark| {
        json!({
            "step": mark.from, "t": times.get(mark.from), "until_step": mark.to, "until_t": times.get(mark.to),
            "kind": mark.kind, "what": mark.what,
        })
    };
    marks.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_lies_between_two_positions_of_one_individual() {
        let mut gaps = Gaps::new(2);
        for (individual, frame) in [(0, 0), (1, 2), (0, 1), (1, 3), (0, 5), (1, 5), (7, 5)] {
            gaps.see(individual, frame);
        }
        let names = ["a".to_owned(), "4".to_owned()];
        let marks = gaps.marks(&names);
        let told: Vec<(&str, usize, usize)> =
            marks.iter().map(|mark| (mark.what.as_str(), mark.from, mark.to)).collect();
        // who is not there yet, or no longer, is not missing
        assert_eq!(told, [("a is missing for 3 frames", 2, 4), ("individual 4 is missing for 1 frame", 4, 4)]);
        let listed = listed(marks, &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(listed[0]["until_t"], 0.4);
    }
}
