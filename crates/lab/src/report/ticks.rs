//! Where an axis is marked, and what is written there.

use super::number;

/// The marks of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks {
    /// Places, ascending.
    pub(super) places: Vec<f64>,
    /// What is written at each, `[places]`.
    pub(super) labels: Vec<String>,
    /// Distance between two marks.
    pub(super) step: f64,
}

/// Nothing of what is drawn may lie further out: differences stay finite.
pub(super) const FURTHEST: f64 = 1e300;

/// What is equal within this share of its size is one value with the noise of its rounding, since a number in single precision
/// has seven digits.
const NOISE: f64 = 1e-6;

/// The ends of an axis: the fixed ends where they make sense, moved outwards so far that every value is shown. Values
/// that are all equal, but for rounding, get room on both sides. Without values: 0 to 1. The ends are finite, and the first is
/// less.
pub(super) fn ends(fixed: Option<(f64, f64)>, values: impl Iterator<Item = f64>) -> (f64, f64) {
    let fixed = fixed.filter(|(low, high)| low.is_finite() && high.is_finite() && low < high);
    let (mut low, mut high) = fixed.unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
    for value in values.filter(|value| value.is_finite()) {
        let value = value.clamp(-FURTHEST, FURTHEST);
        low = low.min(value);
        high = high.max(value);
    }
    if low > high {
        return (0.0, 1.0);
    }
    let (low, high) = (low.max(-FURTHEST), high.min(FURTHEST));
    // ends that were asked for may lie as near to each other as can be told apart on an axis
    let apart = if fixed.is_some() { 1e-9 } else { NOISE };
    let least = (low.abs().max(high.abs()) * apart).max(1e-300);
    if high - low > least {
        return (low, high);
    }
    let room = if high == 0.0 { 1.0 } else { (high.abs() * 0.1).max(1e-290) };
    (low - room, high + room)
}

/// The ends moved outwards to the next mark.
pub(super) fn rounded_ends((low, high): (f64, f64), count: usize) -> (f64, f64) {
    let step = step(low, high, count);
    let slack = step * 1e-6;
    let rounded = (((low + slack) / step).floor() * step, ((high - slack) / step).ceil() * step);
    if rounded.0.is_finite() && rounded.1.is_finite() && rounded.0 < rounded.1 {
        (rounded.0.min(low), rounded.1.max(high))
    } else {
        (low, high)
    }
}

/// About so many marks between two ends, at multiples of 1, 2 or 5 times a power of ten.
pub(super) fn ticks((low, high): (f64, f64), count: usize) -> Ticks {
    let step = step(low, high, count);
    let slack = step * 1e-6;
    let first = ((low - slack) / step).ceil();
    let last = ((high + slack) / step).floor();
    let mut places = Vec::new();
    let mut index = first;
    // the bound holds for any input; in earnest there are never more than three times `count`
    while index <= last && places.len() <= 4 * count.max(1) {
        places.push(index * step);
        index += 1.0;
    }
    let labels = labels(&places, step);
    Ticks { places, labels, step }
}

/// A round length (1, 2 or 5 times a power of ten) of at most `most`; 1 where that makes no sense.
pub(crate) fn round_length(most: f64) -> f64 {
    if !most.is_finite() || most <= 0.0 {
        return 1.0;
    }
    let power = 10f64.powi(most.log10().floor() as i32);
    let length = [5.0, 2.0, 1.0].into_iter().map(|digit| digit * power).find(|length| *length <= most * (1.0 + 1e-9));
    length.filter(|length| *length > 0.0).unwrap_or(most)
}

/// The distance between marks: 1, 2 or 5 times a power of ten, the first that gives at most `count` distances.
fn step(low: f64, high: f64, count: usize) -> f64 {
    let rough = (high - low) / count.max(1) as f64;
    if !rough.is_finite() || rough < 1e-305 {
        return 1.0;
    }
    let power = 10f64.powi(rough.log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power);
    steps.into_iter().find(|step| *step >= rough * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

fn labels(places: &[f64], step: f64) -> Vec<String> {
    let largest = places.iter().fold(0.0, |largest: f64, place| largest.max(place.abs()));
    let exponent = |value: f64| if value > 0.0 { (value.log10() + 1e-9).floor() as i32 } else { 0 };
    let decimals = -exponent(step);
    if largest < 1e6 && decimals <= 4 {
        let decimals = usize::try_from(decimals).unwrap_or(0);
        places.iter().map(|&place| number::fixed(place, decimals)).collect()
    } else {
        let decimals = usize::try_from(exponent(largest) - exponent(step)).unwrap_or(0).min(12);
        places.iter().map(|&place| number::scientific(place, decimals)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels_of(low: f64, high: f64, count: usize) -> Vec<String> {
        ticks((low, high), count).labels
    }

    #[test]
    fn round_numbers() {
        assert_eq!(labels_of(0.0, 1.0, 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels_of(0.0, 97.0, 5), ["0", "20", "40", "60", "80"]);
        assert_eq!(labels_of(-3.0, 3.0, 4), ["\u{2212}2", "0", "2"]);
        assert_eq!(labels_of(0.0, 3e-5, 3), ["0", "1e-5", "2e-5", "3e-5"]);
        assert_eq!(labels_of(0.0, 3e6, 3), ["0", "1e6", "2e6", "3e6"]);
        assert_eq!(labels_of(1.0e6, 1.2e6, 4), ["1e6", "1.05e6", "1.1e6", "1.15e6", "1.2e6"]);
    }

    #[test]
    fn marks_lie_between_the_ends_and_there_are_about_so_many() {
        for (low, high) in [(0.0, 1.0), (-7.3, 22.9), (1e-12, 3e-12), (1e9, 1e9 + 7.0), (-1e300, 1e300), (0.1, 0.3)] {
            for count in [1, 2, 5, 8] {
                let marks = ticks((low, high), count);
                assert!(marks.places.len() <= count + 1, "{low} {high} {count}: {marks:?}");
                let slack = marks.step * 1e-5;
                assert!(marks.places.iter().all(|&place| place >= low - slack && place <= high + slack));
                assert!(marks.places.is_sorted());
                assert_eq!(marks.places.len(), marks.labels.len());
            }
        }
    }

    #[test]
    fn ends_of_anything_are_finite_and_apart() {
        let none: [f64; 0] = [];
        let cases: [(Option<(f64, f64)>, &[f64]); 11] = [
            (None, &none),
            (None, &[3.0]),
            (None, &[0.0, 0.0]),
            (None, &[f64::NAN, f64::INFINITY]),
            (None, &[-f64::MAX, f64::MAX]),
            (None, &[1e-310, 2e-310]),
            (None, &[1.0, 1.0 + 1e-15]),
            (Some((0.0, 1.0)), &none),
            (Some((1.0, 1.0)), &none),
            (Some((f64::NAN, 1.0)), &[2.0, 4.0]),
            (Some((f64::NEG_INFINITY, f64::INFINITY)), &[5.0]),
        ];
        for (fixed, values) in cases {
            let (low, high) = ends(fixed, values.iter().copied());
            assert!(
                low.is_finite() && high.is_finite() && low < high && (high - low).is_finite(),
                "{fixed:?} {values:?}"
            );
            let (low, high) = rounded_ends((low, high), 4);
            assert!(low < high);
            let marks = ticks((low, high), 4);
            assert!(marks.step > 0.0, "{fixed:?} {values:?} {marks:?}");
        }
    }

    #[test]
    fn fixed_ends_give_way_to_values_outside() {
        assert_eq!(ends(Some((0.0, 1.0)), [0.5, 1.5].into_iter()), (0.0, 1.5));
        assert_eq!(ends(Some((0.0, 1.0)), [0.5].into_iter()), (0.0, 1.0));
        assert_eq!(rounded_ends((0.03, 0.97), 5), (0.0, 1.0));
        assert_eq!(rounded_ends((0.0, 1.0), 5), (0.0, 1.0));
    }

    #[test]
    fn rounding_is_not_a_change() {
        let noise = [6.0000001, 5.9999998, 6.0, 5.9999995];
        let constant = ends(None, noise.into_iter());
        assert!(constant.0 < 5.5 && constant.1 > 6.5, "{constant:?}");
        let (low, high) = rounded_ends(constant, 5);
        let labels = labels_of(low, high, 5);
        assert!(labels.contains(&"6.0".to_owned()), "{labels:?}");
        assert!(labels.iter().all(|label| label.len() <= 4), "{labels:?}");
        assert_eq!(ends(None, [-2.0, -2.0 - 1e-7].into_iter()).0.round(), -2.0);
        // what changes by more is a change, and so is what somebody asked to see
        assert_eq!(ends(None, [6.0, 6.0001].into_iter()), (6.0, 6.0001));
        assert_eq!(ends(Some((1e8, 1e8 + 1.0)), [].into_iter()), (1e8, 1e8 + 1.0));
    }

    #[test]
    fn lengths_of_scale_bars() {
        let lengths = [9.9, 1.0, 0.03, 45.0, 0.0, f64::NAN].map(round_length);
        assert_eq!(lengths, [5.0, 1.0, 0.02, 20.0, 1.0, 1.0]);
    }
}
