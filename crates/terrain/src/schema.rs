//! What a schema is: parameters to a construct, the same for the same seed.

use crate::construct::{Construct, Provenance};
use crate::draws::Draws;
use crate::geometry::Units;
use crate::{TerrainError, Workspace};
use std::borrow::Cow;

/// Which values a parameter may have.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Any number of a closed interval.
    Range(f64, f64),
    /// Any number of a closed interval whose ends are one: an angle.
    Periodic(f64, f64),
    /// A whole number of a closed interval.
    Whole(f64, f64),
}

impl Domain {
    /// Least and greatest value.
    pub fn bounds(&self) -> (f64, f64) {
        match *self {
            Self::Range(least, most) | Self::Periodic(least, most) | Self::Whole(least, most) => (least, most),
        }
    }
    /// Whether a value belongs to it.
    pub fn holds(&self, value: f64) -> bool {
        let (least, most) = self.bounds();
        (least..=most).contains(&value) && (!matches!(self, Self::Whole(..)) || value.fract() == 0.0)
    }
    /// The values on a grid of this resolution, both ends included where the grid meets them.
    ///
    /// # Errors
    /// A resolution that is not a positive number; for whole numbers one that is not whole.
    pub fn grid(&self, resolution: f64) -> Result<Vec<f64>, TerrainError> {
        let (least, most) = self.bounds();
        if matches!(self, Self::Whole(..)) && resolution.fract() != 0.0 {
            return Err(TerrainError::range("resolution", "a whole number for a whole parameter", resolution));
        }
        let mut count = grid_points(least, most, resolution)?;
        // the last value of a circle is the first
        if matches!(self, Self::Periodic(..)) && least + (count - 1.0) * resolution >= most - 1e-9 * resolution {
            count -= 1.0;
        }
        if count > 1e7 {
            return Err(TerrainError::TooMany { count, limit: 1e7 });
        }
        Ok((0..count.max(1.0) as usize).map(|k| (least + k as f64 * resolution).min(most)).collect())
    }
    pub(crate) fn words(&self) -> String {
        let (least, most) = self.bounds();
        match self {
            Self::Whole(..) => format!("a whole number from {least} to {most}"),
            Self::Range(..) | Self::Periodic(..) => format!("a number from {least} to {most}"),
        }
    }
}

/// How many values a grid has between two bounds, both included: `floor((most - least) / resolution) + 1`, where a
/// quotient that misses a whole number by rounding alone is that number.
///
/// # Errors
/// A resolution that is not a positive number, or bounds in the wrong order.
pub fn grid_points(least: f64, most: f64, resolution: f64) -> Result<f64, TerrainError> {
    if !(resolution > 0.0 && resolution.is_finite()) {
        return Err(TerrainError::range("resolution", "a finite number above 0", resolution));
    }
    let steps = (most - least) / resolution;
    if !(steps >= 0.0 && steps.is_finite()) {
        return Err(TerrainError::range("greatest value", format!("a finite number of at least {least}"), most));
    }
    Ok((steps * (1.0 + 1e-12) + 1e-12).floor() + 1.0)
}

/// A parameter of a schema.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name in files.
    pub name: Cow<'static, str>,
    /// Unit: `deg`, `length`, `1`.
    pub unit: &'static str,
    /// Which values it may have.
    pub domain: Domain,
    /// Its value where none is given.
    pub default: f64,
    /// One sentence.
    pub about: &'static str,
}

impl Parameter {
    /// A parameter.
    pub fn new(name: &'static str, unit: &'static str, domain: Domain, default: f64, about: &'static str) -> Self {
        Self { name: name.into(), unit, domain, default, about }
    }
}

/// A schema's description of itself.
#[derive(Clone, Debug, PartialEq)]
pub struct SchemaCard {
    /// Name in files.
    pub id: &'static str,
    /// What it builds, in a sentence.
    pub about: &'static str,
    /// Where it comes from, and which of its details are decisions of ours.
    pub source: &'static str,
    /// Its version: raised when equal parameters give other geometry.
    pub version: u32,
    /// In what lengths it builds; `None`: in those of the workspace.
    pub units: Option<Units>,
    /// Its parameters, in the order in which values are given.
    pub parameters: Vec<Parameter>,
}

impl SchemaCard {
    /// The values of all parameters, in order: those given by name, and the defaults.
    ///
    /// # Errors
    /// A name that no parameter has, or a value outside its domain.
    pub fn values(&self, given: &[(&str, f64)]) -> Result<Vec<f64>, TerrainError> {
        let mut values: Vec<f64> = self.parameters.iter().map(|parameter| parameter.default).collect();
        for &(name, value) in given {
            match self.parameters.iter().position(|parameter| parameter.name == name) {
                Some(k) => values[k] = value,
                None => {
                    let names = self.parameters.iter().map(|parameter| &*parameter.name);
                    return Err(TerrainError::unknown("parameter", name, names));
                }
            }
        }
        self.check(&values)?;
        Ok(values)
    }
    /// Refuses values that are too few, too many, or outside their domains.
    ///
    /// # Errors
    /// The first such value.
    pub fn check(&self, values: &[f64]) -> Result<(), TerrainError> {
        if values.len() != self.parameters.len() {
            let expected = format!("{} numbers", self.parameters.len());
            return Err(TerrainError::range(format!("parameters of `{}`", self.id), expected, values.len() as f64));
        }
        for (parameter, &value) in self.parameters.iter().zip(values) {
            if !parameter.domain.holds(value) {
                return Err(TerrainError::range(parameter.name.as_ref(), parameter.domain.words(), value));
            }
        }
        Ok(())
    }
}

/// Values by place, as many as a schema has parameters: [`SchemaCard::check`] has counted them.
pub(crate) fn known<const N: usize>(values: &[f64]) -> [f64; N] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

/// Something that builds constructs from numbers.
pub trait Schema: Send + Sync {
    /// Its description of itself.
    fn card(&self) -> SchemaCard;
    /// The construct of these values, which are in their domains. What is random is taken from `draws` alone.
    ///
    /// # Errors
    /// A workspace without the anchors it needs.
    fn build(&self, values: &[f64], workspace: &Workspace, draws: &Draws) -> Result<Construct, TerrainError>;

    /// The construct of these values in a workspace, with its provenance.
    ///
    /// # Errors
    /// Values outside their domains, a workspace in other units or without the anchors it needs.
    fn construct(
        &self,
        values: &[f64],
        workspace: &Workspace,
        seed: u64,
        attempt: u64,
    ) -> Result<Construct, TerrainError> {
        let card = self.card();
        card.check(values)?;
        if let Some(units) = card.units.filter(|&units| units != workspace.units) {
            return Err(TerrainError::Units {
                first: format!("the schema `{}` in {} units", card.id, units.word()),
                second: format!("the workspace `{}` in {} units", workspace.name, workspace.units.word()),
            });
        }
        let mut construct = self.build(values, workspace, &Draws::new(seed, attempt, 0))?;
        let parameters =
            card.parameters.iter().zip(values).map(|(parameter, &value)| (parameter.name.to_string(), value));
        construct.provenance = Provenance {
            schema: card.id.to_owned(),
            version: card.version,
            parameters: parameters.collect(),
            seed,
            attempt,
            // of a schema that derives
            derivation: construct.provenance.derivation.take(),
        };
        Ok(construct)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn grids_include_both_ends() {
        assert_eq!(Domain::Range(0.0, 1.0).grid(0.5).unwrap(), [0.0, 0.5, 1.0]);
        assert_eq!(Domain::Range(0.0, 1.0).grid(0.4).unwrap().len(), 3);
        assert_eq!(Domain::Range(0.0, 0.3).grid(0.1).unwrap().len(), 4, "0.3 / 0.1 is less than 3 by rounding");
        assert_eq!(Domain::Range(2.0, 2.0).grid(1.0).unwrap(), [2.0]);
        assert_eq!(Domain::Periodic(0.0, 360.0).grid(90.0).unwrap(), [0.0, 90.0, 180.0, 270.0]);
        assert_eq!(Domain::Periodic(0.0, 360.0).grid(100.0).unwrap().len(), 4);
        assert_eq!(Domain::Whole(1.0, 4.0).grid(1.0).unwrap(), [1.0, 2.0, 3.0, 4.0]);
        assert!(Domain::Whole(1.0, 4.0).grid(0.5).is_err());
        assert!(Domain::Range(0.0, 1.0).grid(0.0).is_err() && Domain::Range(0.0, 1.0).grid(f64::NAN).is_err());
        assert!(Domain::Range(0.0, 1.0).grid(1e-12).is_err());
        assert_eq!(grid_points(0.0, 360.0, 90.0), Ok(5.0));
        assert!(grid_points(1.0, 0.0, 0.5).is_err());
    }
}
