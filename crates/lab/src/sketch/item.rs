//! An item of a sketch, as the page has it.

use serde_json::{Value as Json, json};
use space::spelling::nearest;

/// Kinds of items, with the fewest points of each.
const KINDS: [(&str, usize); 10] = [
    ("wall", 2),
    ("disc", 1),
    ("box", 2),
    ("polygon", 3),
    ("region", 1),
    ("gate", 2),
    ("anchor", 1),
    ("boundary", 3),
    ("start", 1),
    ("other", 0),
];

/// The form of a region or start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A box, by two corners.
    Box,
    /// A disc, by its centre and radius.
    Disc,
    /// A polygon, by its corners.
    Polygon,
}

/// Something that was drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// What it is: one of `wall`, `disc`, `box`, `polygon`, `region`, `gate`, `anchor`, `boundary`, `start`; `other` is what stands in
    /// the file and cannot be drawn.
    pub is: String,
    /// Its name; of a start, that of its group.
    pub name: String,
    /// Its points: ends, corners, or the centre.
    pub points: Vec<[f64; 2]>,
    /// Its radius, where it is round.
    pub radius: f64,
    /// The form of a region or start.
    pub form: Form,
    /// Which obstacle of the file it was.
    pub index: Option<usize>,
}

impl Item {
    /// An item without name and radius.
    pub(super) fn new(is: &str, points: Vec<[f64; 2]>) -> Self {
        Self { is: is.to_owned(), name: String::new(), points, radius: 0.0, form: Form::Box, index: None }
    }
    /// From what the page says.
    ///
    /// # Errors
    /// What is missing, in a sentence.
    pub fn of(value: &Json) -> Result<Self, String> {
        let text = |key: &str| value.get(key).and_then(Json::as_str).unwrap_or_default();
        let is = text("is");
        let Some((_, least)) = KINDS.iter().find(|(known, _)| *known == is) else {
            let near = nearest(is, KINDS.iter().map(|(known, _)| *known));
            let help = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
            return Err(format!("nothing that is drawn is called `{is}`{help}"));
        };
        let pair = |point: &Json| {
            let number = |k: usize| point.get(k).and_then(Json::as_f64).filter(|number| number.is_finite());
            Some([number(0)?, number(1)?])
        };
        let points = value.get("points").and_then(Json::as_array).cloned().unwrap_or_default();
        let points: Option<Vec<[f64; 2]>> = points.iter().map(pair).collect();
        let points = points.filter(|points| points.len() >= *least);
        let points = points.ok_or_else(|| format!("a {is} needs {least} points of two numbers"))?;
        let form = match text("form") {
            "disc" => Form::Disc,
            "polygon" => Form::Polygon,
            _ => Form::Box,
        };
        let radius = value.get("radius").and_then(Json::as_f64).unwrap_or(0.0);
        let round = is == "disc" || (["region", "start"].contains(&is) && form == Form::Disc);
        if round && !(radius > 0.0 && radius.is_finite()) {
            return Err(format!("a {is} that is round needs a radius above 0"));
        }
        if ["region", "start"].contains(&is) && form == Form::Box && points.len() < 2 {
            return Err(format!("a {is} that is a box needs two corners"));
        }
        let index = value.get("index").and_then(Json::as_u64).map(|index| index as usize);
        Ok(Self { is: is.to_owned(), name: text("name").to_owned(), points, radius, form, index })
    }
    /// As the page is told of it.
    pub(super) fn told(&self) -> Json {
        let form = match self.form {
            Form::Box => "box",
            Form::Disc => "disc",
            Form::Polygon => "polygon",
        };
        json!({
            "is": self.is, "name": self.name, "points": self.points, "radius": self.radius, "form": form,
            "index": self.index,
        })
    }
    /// Lower and upper corner of its points.
    pub(super) fn corners(&self) -> ([f64; 2], [f64; 2]) {
        let each = |of: fn(f64, f64) -> f64, start: f64| -> [f64; 2] {
            core::array::from_fn(|a| self.points.iter().map(|point| point[a]).fold(start, of))
        };
        (each(f64::min, f64::INFINITY), each(f64::max, f64::NEG_INFINITY))
    }
    /// The first point.
    pub(super) fn first(&self) -> [f64; 2] {
        self.points.first().copied().unwrap_or_default()
    }
}
