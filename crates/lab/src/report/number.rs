//! Numbers as text: enough digits to read, a true minus sign, the unit after a thin space.

/// A thin space that does not break.
const THIN: char = '\u{202f}';
/// The sign of negative numbers.
const MINUS: char = '\u{2212}';

/// A number with four significant digits, in powers of ten (three digits) where it is very large or very small. What is
/// not a finite number is a dash.
pub(crate) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "\u{2013}".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let magnitude = value.abs();
    let text = if (1e-3..1e6).contains(&magnitude) {
        let before_point = magnitude.log10().floor() as i32 + 1;
        let decimals = usize::try_from(4 - before_point).unwrap_or(0);
        without_trailing_zeros(&format!("{magnitude:.decimals$}"))
    } else {
        in_powers_of_ten(magnitude, 2)
    };
    signed(value, text)
}

/// A number with a fixed number of decimals.
pub(super) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.bytes().all(|letter| matches!(letter, b'0' | b'.'));
    if is_zero { text } else { signed(value, text) }
}

/// A number in powers of ten with at most so many decimals: `1.25e-4`.
pub(super) fn scientific(value: f64, decimals: usize) -> String {
    if value == 0.0 { "0".into() } else { signed(value, in_powers_of_ten(value.abs(), decimals)) }
}

/// A number with its unit.
pub(crate) fn quantity(value: f64, unit: &str) -> String {
    let unit = unit.trim();
    if has_unit(unit) { format!("{}{THIN}{unit}", number(value)) } else { number(value) }
}

/// What stands at an axis: what it shows, and the unit in brackets.
pub(super) fn axis_title(label: &str, unit: &str) -> String {
    let (label, unit) = (label.trim(), unit.trim());
    match (label.is_empty(), has_unit(unit)) {
        (_, false) => label.to_owned(),
        (true, true) => unit.to_owned(),
        (false, true) => format!("{label} ({unit})"),
    }
}

/// Whether a unit is worth writing.
pub(super) fn has_unit(unit: &str) -> bool {
    !matches!(unit.trim(), "" | "1")
}

/// A place in a drawing: one decimal, as short as can be.
pub(crate) fn place(value: f64) -> String {
    // a drawing never reaches further; a place beyond it would upset programs that read it
    let value = if value.is_nan() { 0.0 } else { value.clamp(-1e5, 1e5) };
    let text = without_trailing_zeros(&format!("{value:.1}"));
    if text == "-0" { "0".into() } else { text }
}

/// A number of bytes.
pub(crate) fn bytes(count: usize) -> String {
    let count = count as f64;
    let steps = [(1e6, "MB"), (1e3, "kB")];
    let (size, unit) = steps.into_iter().find(|&(size, _)| count >= size).unwrap_or((1.0, "B"));
    let amount = count / size;
    let decimals = usize::from(size > 1.0 && amount < 10.0);
    format!("{amount:.decimals$}{THIN}{unit}")
}

fn signed(value: f64, magnitude: String) -> String {
    if value < 0.0 { format!("{MINUS}{magnitude}") } else { magnitude }
}

fn in_powers_of_ten(magnitude: f64, decimals: usize) -> String {
    let text = format!("{magnitude:.decimals$e}");
    match text.split_once('e') {
        Some((digits, exponent)) => format!("{}e{exponent}", without_trailing_zeros(digits)),
        None => text,
    }
}

fn without_trailing_zeros(text: &str) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensible_number_of_digits() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (0.831_249, "0.8312"),
            (1.25e-4, "1.25e-4"),
            (0.001, "0.001"),
            (1.0, "1"),
            (-2.5, "\u{2212}2.5"),
            (123.456, "123.5"),
            (98_765.4, "98765"),
            (100.0, "100"),
            (1.5e6, "1.5e6"),
            (-3.0e-9, "\u{2212}3e-9"),
            (f64::NAN, "\u{2013}"),
            (f64::INFINITY, "\u{2013}"),
            (0.999_99, "1"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text, "{value}");
        }
        assert_eq!(number(f64::MAX), "1.8e308");
        assert_eq!(number(5e-324), "4.94e-324");
    }

    #[test]
    fn units_stand_after_a_thin_space_and_one_is_not_written() {
        assert_eq!(quantity(1.5, "m/s"), "1.5\u{202f}m/s");
        assert_eq!(quantity(1.5, "1"), "1.5");
        assert_eq!(quantity(1.5, ""), "1.5");
        assert_eq!(axis_title("time", "s"), "time (s)");
        assert_eq!(axis_title("polarisation", "1"), "polarisation");
        assert_eq!(axis_title("", "s"), "s");
    }

    #[test]
    fn places_are_short_and_always_numbers() {
        assert_eq!(place(12.04), "12");
        assert_eq!(place(-0.01), "0");
        assert_eq!(place(0.25), "0.2");
        assert_eq!(place(f64::NAN), "0");
        assert_eq!(place(f64::INFINITY), "100000");
    }

    #[test]
    fn sizes() {
        assert_eq!(bytes(0), "0\u{202f}B");
        assert_eq!(bytes(1_234), "1.2\u{202f}kB");
        assert_eq!(bytes(56_000_000), "56\u{202f}MB");
    }
}
