//! The box that is searched.

use crate::SearchError;

/// One number that is searched over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// Least value.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// The value about which it lies where nothing is known better; scale of changes.
    pub reference: f64,
    /// Whether it closes on itself, as an angle does.
    pub periodic: bool,
}

impl Axis {
    /// From `low` to `high`; the reference is the middle.
    pub fn new(low: f64, high: f64) -> Self {
        Self { low, high, reference: low + 0.5 * (high - low), periodic: false }
    }
    /// The same with a reference of its own.
    pub fn about(self, reference: f64) -> Self {
        Self { reference, ..self }
    }
    /// The same, closed on itself.
    pub fn closed(self) -> Self {
        Self { periodic: true, ..self }
    }
    /// The value a share of the way from low to high.
    pub fn at(&self, share: f64) -> f64 {
        (self.low + (self.high - self.low) * share).clamp(self.low, self.high)
    }
    /// The nearest value inside; a value that is not a number becomes the reference.
    pub fn inside(&self, value: f64) -> f64 {
        if value.is_nan() { self.reference.clamp(self.low, self.high) } else { value.clamp(self.low, self.high) }
    }
}

/// The numbers that are searched over, each with its bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    axes: Vec<Axis>,
}

impl Domain {
    /// A box.
    ///
    /// # Errors
    /// Without axes, or where one is no interval.
    pub fn new(axes: Vec<Axis>) -> Result<Self, SearchError> {
        if axes.is_empty() {
            return Err(SearchError::NoAxes);
        }
        for (axis, &Axis { low, high, .. }) in axes.iter().enumerate() {
            // the width has to be finite as well: it is multiplied with
            if low.partial_cmp(&high) != Some(core::cmp::Ordering::Less) || !(high - low).is_finite() {
                return Err(SearchError::NotAnInterval { axis, low, high });
            }
        }
        Ok(Self { axes })
    }
    /// The axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }
    /// How many numbers a point has.
    pub fn dimensions(&self) -> usize {
        self.axes.len()
    }
    /// Low bounds, `[dimensions]`.
    pub fn lows(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.low).collect()
    }
    /// High bounds, `[dimensions]`.
    pub fn highs(&self) -> Vec<f64> {
        self.axes.iter().map(|axis| axis.high).collect()
    }
    /// Brings each number of a point inside.
    pub fn clamp(&self, point: &mut [f64]) {
        for (value, axis) in point.iter_mut().zip(&self.axes) {
            *value = axis.inside(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_interval_is_refused() {
        assert_eq!(Domain::new(vec![]), Err(SearchError::NoAxes));
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-1e308, 1e308)] {
            let refused = Domain::new(vec![Axis::new(0.0, 1.0), Axis::new(low, high)]);
            assert!(matches!(refused, Err(SearchError::NotAnInterval { axis: 1, .. })), "{low} to {high}");
        }
    }

    #[test]
    fn points_are_brought_inside() {
        let domain = Domain::new(vec![Axis::new(-1.0, 3.0), Axis::new(0.0, 1.0).about(0.2)]).unwrap();
        let mut point = [7.0, f64::NAN];
        domain.clamp(&mut point);
        assert_eq!(point, [3.0, 0.2]);
        assert_eq!(domain.axes()[0].at(0.25), 0.0);
        assert_eq!((domain.lows(), domain.highs()), (vec![-1.0, 0.0], vec![3.0, 1.0]));
    }
}
