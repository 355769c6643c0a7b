//! A page that plays by itself, offline, in any browser.

use super::{Form, Look, Most, Recording};
use crate::report::of_run::paragraphs;
use crate::report::{Fact, Figure, Page, html, short};
use crate::store::StoreError;

/// A page.
pub(super) struct Html;

impl Form for Html {
    fn id(&self) -> &'static str {
        "html"
    }
    fn about(&self) -> &'static str {
        "one page that plays the recording in any browser, without a network"
    }
    fn most(&self) -> Most {
        Most { frames: 20_000, positions: 2_400_000 }
    }
    fn bytes(&self, recording: &Recording, _: &Look) -> Result<Vec<u8>, StoreError> {
        recording.needs_frames()?;
        let replay = &recording.replay;
        let fact = |label: &str, value: String| Fact { label: label.to_owned(), value };
        let last = replay.times.last().copied().unwrap_or(0.0);
        let mut figures = vec![Figure::Replay(replay.clone())];
        figures.extend(recording.charts.iter().cloned().map(Figure::Lines));
        Ok(html(&Page {
            title: recording.title.clone(),
            lead: paragraphs(&recording.about),
            methods: Vec::new(),
            summary: vec![
                fact("Agents", replay.group.len().to_string()),
                fact("Frames", replay.times.len().to_string()),
                fact("Until", format!("{} {}", short(last), replay.time_unit)),
            ],
            figures,
            tables: Vec::new(),
            command: recording.command.clone(),
            source: recording.source.clone(),
            made_by: recording.made_by.clone(),
        })
        .into_bytes())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn two_hundred_agents_in_six_thousand_frames_are_below_ten_megabytes() {
        for dimensions in [2, 3] {
            let bytes = Html.bytes(&recording(dimensions, 6000, 200), &Look { width: 100, rate: 25.0 }).unwrap();
            assert!(bytes.len() < 10_000_000, "{dimensions}-D: {}", bytes.len());
        }
    }
}
