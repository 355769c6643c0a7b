//! Searches to be looked at: studies, evolutions, designs, maps, optimisations, decompositions, formations. Each gives an overview, its parts as they
//! are asked for, and what is behind each of its places, which is computed anew when somebody wants to watch it.
//!
//! A kind of folder is one file here, and says in its list of kinds (`flockworks::kinds`) that it can be looked at. Nothing is
//! written: a folder can be looked at while it is being filled.

mod decomposition;
mod design;
mod evolution;
mod formation;
mod map;
mod optimisation;
mod study;

pub use decomposition::Decomposed;
pub use design::Designed;
pub use evolution::Evolved;
pub use formation::Formed;
pub use map::Mapped;
pub use optimisation::Optimised;
pub use study::{Studied, trial};

use crate::live::{Course, LiveError, Replayed, Shown, simulate};
use crate::report::{Drawing, Page, Stroke};
use serde_json::{Map, Value as Json, json};

/// A search.
pub trait Searched: Send + Sync {
    /// What the page draws at first.
    fn overview(&self) -> Json;
    /// A part of it.
    ///
    /// # Errors
    /// A place that is not there.
    fn part(&self, at: &At) -> Result<Json, LiveError>;
    /// What can be watched at a place.
    ///
    /// # Errors
    /// A place that is not there, or has no possible world.
    fn watched(&self, at: &At) -> Result<Watched, LiveError>;
    /// The places that tell most, which are sent where nobody names one; the first tells most. None where nothing was found yet.
    fn telling(&self) -> Vec<At>;
    /// The page of a complete folder; what is missing of an incomplete one is left out.
    fn page(&self, program: &str) -> Page;
    /// The names of the numbers of its places, as in `cell=3,trial=1`.
    fn words(&self) -> Vec<String>;
}

/// What can be watched.
#[derive(Clone, Debug, PartialEq)]
pub enum Watched {
    /// A scenario, which is simulated while one watches.
    Scenario {
        /// Name of its file.
        name: String,
        /// Its text.
        text: String,
        /// Its seed, where a file cannot say it.
        seed: Option<u64>,
    },
    /// A course: what no scenario can say is computed to its end first.
    Course(Box<Course>),
}

impl Watched {
    /// It, to be looked at; also whether it can be scrubbed through.
    ///
    /// # Errors
    /// A scenario without a possible world, a course without a frame.
    pub fn shown(self, threads: usize) -> Result<(Box<dyn Shown>, bool), LiveError> {
        Ok(match self {
            Self::Scenario { name, text, seed } => (simulate(&name, &text, &[], seed, threads)?, false),
            Self::Course(course) => (Box::new(Replayed::new(*course)?), true),
        })
    }
}

/// A place in a search: numbers by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct At(Map<String, Json>);

impl At {
    /// From an object of a message.
    pub fn of(value: &Json) -> Self {
        Self(value.as_object().cloned().unwrap_or_default())
    }
    /// Of names and numbers.
    pub fn new(numbers: &[(&str, f64)]) -> Self {
        Self(numbers.iter().map(|(key, value)| ((*key).to_owned(), json!(value))).collect())
    }
    /// From the words of an address: `cell=3&trial=1`.
    pub fn asked(words: &str) -> Self {
        Self(words.split('&').filter_map(|pair| pair.split_once('=').and_then(number)).collect())
    }
    /// From the words of a command: `cell=3,trial=1`.
    ///
    /// # Errors
    /// A word that is no name with a number.
    pub fn written(words: &str) -> Result<Self, String> {
        let pair = |word: &str| {
            let found = word.split_once('=').and_then(|(key, value)| number((key.trim(), value.trim())));
            found.filter(|(key, _)| !key.is_empty()).ok_or_else(|| format!("`{word}` is no NAME=NUMBER"))
        };
        words.split(',').map(pair).collect::<Result<_, _>>().map(Self)
    }
    /// The names that are not among these.
    pub fn unknown(&self, known: &[&str]) -> Vec<&str> {
        self.0.keys().map(String::as_str).filter(|key| !known.contains(key)).collect()
    }
    /// A number, where it is given.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.0.get(key).and_then(Json::as_f64).filter(|number| number.is_finite())
    }
    /// A whole number from 0, where it is given.
    pub fn perhaps(&self, key: &str) -> Option<usize> {
        self.number(key).filter(|number| *number >= 0.0 && number.fract() == 0.0 && *number < 1e15).map(|n| n as usize)
    }
    /// A whole number from 0 that is needed.
    ///
    /// # Errors
    /// Where it is missing.
    pub fn whole(&self, key: &str) -> Result<usize, LiveError> {
        self.perhaps(key).ok_or_else(|| LiveError::Request(format!("a place needs a whole number `{key}`")))
    }
    /// A whole number below another.
    ///
    /// # Errors
    /// Where it is missing or too large.
    pub fn below(&self, key: &str, count: usize) -> Result<usize, LiveError> {
        let number = self.whole(key)?;
        if number < count {
            return Ok(number);
        }
        Err(LiveError::Request(format!("there is no {key} {number}: there are {count}, counted from 0")))
    }
}

fn number((key, value): (&str, &str)) -> Option<(String, Json)> {
    Some((key.to_owned(), json!(value.parse::<f64>().ok()?)))
}

/// A number with six digits, for a picture; null where it is none.
fn rounded(value: f64) -> Json {
    if !value.is_finite() {
        return Json::Null;
    }
    format!("{value:.5e}").parse::<f64>().map_or(Json::Null, |value| json!(value))
}

/// Numbers with six digits.
fn all_rounded(values: impl IntoIterator<Item = f64>) -> Json {
    values.into_iter().map(rounded).collect()
}

/// A drawing as the page draws it: lines as flat lists of coordinates, discs, marks.
fn drawing(drawing: &Drawing) -> Json {
    let lines = |wanted: Stroke| -> Json {
        let of = drawing.strokes.iter().filter(|(stroke, _)| *stroke == wanted);
        of.map(|(_, points)| all_rounded(points.iter().flatten().copied())).collect()
    };
    let discs = |built: bool| -> Json {
        let of = drawing.discs.iter().filter(|disc| disc.0 == built);
        of.map(|(_, [x, y], radius)| all_rounded([*x, *y, *radius])).collect()
    };
    json!({
        "caption": drawing.caption,
        "there": lines(Stroke::There),
        "built": lines(Stroke::Built),
        "structure": lines(Stroke::Structure),
        "discs_there": discs(false),
        "discs": discs(true),
        "marks": drawing.marks.iter().map(|mark| all_rounded(*mark)).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_from_addresses_and_messages() {
        let at = At::asked("cell=3&trial=1&x=-0.5&word=cell&=");
        assert_eq!(at, At::of(&json!({ "cell": 3.0, "trial": 1.0, "x": -0.5 })));
        assert_eq!((at.whole("cell").unwrap(), at.number("x"), at.perhaps("x")), (3, Some(-0.5), None));
        assert!(at.below("cell", 3).unwrap_err().to_string().contains("no cell 3"));
        assert!(at.whole("word").is_err() && At::of(&json!(null)).whole("cell").is_err());
        assert_eq!(At::asked("cell=NaN").number("cell"), None);
        assert_eq!(At::written("cell = 3, trial=1,x=-0.5"), Ok(at));
        assert!(At::written("cell").unwrap_err().contains("`cell`") && At::written("=1").is_err());
        assert_eq!(At::written("cell=1,row=2").unwrap().unknown(&["cell", "trial"]), ["row"]);
    }

    #[test]
    fn numbers_for_pictures_are_short() {
        assert_eq!(all_rounded([0.1 + 0.2, f64::NAN, -1234567.0, 0.0]).to_string(), "[0.3,null,-1234570.0,0.0]");
    }
}
