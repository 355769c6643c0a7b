//! Who is near, for what happens between agents after their motion.

use space::{Columns, Real, Space};

/// Rows in the order of their first coordinate: others within a distance are found in a band of it.
pub(super) struct Near<R> {
    sorted: Vec<(R, usize)>,
}

impl<R: Real> Near<R> {
    /// Of the rows that are to be found.
    pub(super) fn new<const D: usize>(columns: &Columns<R, D>, found: impl Fn(usize) -> bool) -> Self {
        let rows = (0..columns.len()).filter(|&row| found(row));
        // a place that is no number is near nobody
        let mut sorted: Vec<(R, usize)> =
            rows.map(|row| (columns.position[0][row], row)).filter(|(place, _)| place.finite()).collect();
        sorted.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(core::cmp::Ordering::Equal));
        Self { sorted }
    }
    /// Whether `holds` for anyone but `row` itself in a band that has everyone within a distance of it. The order in which
    /// others are asked is not that of ids.
    pub(super) fn any<const D: usize>(
        &self,
        space: &Space<R, D>,
        columns: &Columns<R, D>,
        row: usize,
        within: R,
        mut holds: impl FnMut(usize) -> bool,
    ) -> bool {
        let place = columns.position[0][row];
        if !place.finite() {
            return false;
        }
        let images = match space.periods()[0] {
            Some(side) if within + within >= side => return self.band(-R::INFINITY, R::INFINITY, row, &mut holds),
            Some(side) => [Some(R::ZERO), Some(side), Some(-side)],
            None => [Some(R::ZERO), None, None],
        };
        // the bands of images do not overlap, since the distance is below half of the period
        images.into_iter().flatten().any(|shift| {
            let middle = place + shift;
            self.band(middle - within, middle + within, row, &mut holds)
        })
    }
    fn band(&self, low: R, high: R, row: usize, holds: &mut impl FnMut(usize) -> bool) -> bool {
        let first = self.sorted.partition_point(|&(place, _)| place < low);
        self.sorted[first..]
            .iter()
            .take_while(|&&(place, _)| place <= high)
            .any(|&(_, other)| other != row && holds(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Vector;

    #[test]
    fn the_band_has_everyone_within_the_distance() {
        let mut columns = Columns::<f64, 2>::new(40, 0);
        for k in 0..40 {
            let angle = k as f64 * 2.4;
            columns.set_position(k, Vector([5.0 + 4.9 * angle.sin(), 5.0 + 4.9 * (1.7 * angle).cos()]));
        }
        for space in [Space::walled([10.0, 10.0]), Space::periodic([10.0, 10.0])] {
            let near = Near::new(&columns, |_| true);
            for within in [0.5, 2.0, 4.9, 7.0] {
                for row in 0..40 {
                    let distance = |other: usize| space.offset(columns.position(row), columns.position(other)).length();
                    let mut found = Vec::new();
                    near.any(&space, &columns, row, within, |other| {
                        if distance(other) < within {
                            found.push(other);
                        }
                        false
                    });
                    found.sort_unstable();
                    let expected: Vec<usize> = (0..40).filter(|&k| k != row && distance(k) < within).collect();
                    assert_eq!(found, expected, "{within} {row}");
                }
            }
        }
    }
}
