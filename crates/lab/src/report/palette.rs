//! Colours, by name, on light and on dark ground.
//!
//! The series colours follow Okabe and Ito (2008), which people with the common kinds of colour blindness can tell
//! apart. They are darkened or lightened until each has a contrast of at least 3 to 1 with the ground.

use core::fmt::Write;

/// A colour: its name as a custom property of CSS, on light ground, on dark ground.
type Colour = (&'static str, &'static str, &'static str);

/// How many series have a colour of their own.
pub(crate) const SERIES: usize = 7;

/// Dashes, one for each series in turn; empty is a solid line. Lengths in units of the drawing.
pub(super) const DASHES: [&str; 6] = ["", "7 2.5", "3 1.6", "11 2.5 2.5 2.5", "5 3.5", "1.6 1.6"];

/// Every colour of the page.
pub(super) const COLOURS: &[Colour] = &[
    ("ground", "#ffffff", "#14171a"),
    ("panel", "#f5f6f7", "#1c2126"),
    ("text", "#1b1f23", "#e6e9ec"),
    ("faint", "#59626b", "#a3adb7"),
    ("rule", "#d9dde1", "#343b42"),
    ("grid", "#e9ecee", "#272d33"),
    ("accent", "#005a9c", "#6cb8f0"),
    ("stage", "#fbfcfc", "#181c20"),
    ("obstacle", "#c3c9cf", "#4b545d"),
    ("series-0", "#0072b2", "#56b4e9"),
    ("series-1", "#d55e00", "#ff8547"),
    ("series-2", "#00845f", "#1fc796"),
    ("series-3", "#b3518c", "#e59cc8"),
    ("series-4", "#a87700", "#f0c83c"),
    ("series-5", "#3c93cf", "#a9dcff"),
    ("series-6", "#5b5b5b", "#c4c4c4"),
];

/// A colour on light ground: red, green, blue; black for a name that is not there.
pub(crate) fn light(name: &str) -> [u8; 3] {
    let found = COLOURS.iter().find(|colour| colour.0 == name).map_or("#000000", |colour| colour.1);
    core::array::from_fn(|k| {
        found.get(1 + 2 * k..3 + 2 * k).and_then(|part| u8::from_str_radix(part, 16).ok()).unwrap_or(0)
    })
}

/// The style sheet that gives every colour its value: light, dark where the system is dark, and either where the reader
/// chose it.
pub(super) fn style() -> String {
    let mut light = String::from("color-scheme:light;");
    let mut dark = String::from("color-scheme:dark;");
    for (name, on_light, on_dark) in COLOURS {
        // writing to a string cannot fail
        let _ = write!(light, "--{name}:{on_light};");
        let _ = write!(dark, "--{name}:{on_dark};");
    }
    format!(
        ":root,[data-theme=light]{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root:not([data-theme])\
         {{{dark}}}}}\n@media screen{{[data-theme=dark]{{{dark}}}}}\n"
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests {
    use super::*;

    /// Relative luminance of a colour `#rrggbb`, as WCAG 2 defines it.
    fn luminance(colour: &str) -> f64 {
        let channel = |at: usize| {
            let part = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).unwrap()) / 255.0;
            if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5)
    }

    fn contrast(one: &str, other: &str) -> f64 {
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn contrast_with_the_ground() {
        let value = |name: &str| *COLOURS.iter().find(|colour| colour.0 == name).unwrap();
        let (ground, panel) = (value("ground"), value("panel"));
        for colour in COLOURS {
            let least = match colour.0 {
                "text" | "faint" | "accent" => 4.5,
                name if name.starts_with("series") => 3.0,
                _ => continue,
            };
            for behind in [ground, panel] {
                assert!(contrast(colour.1, behind.1) >= least, "{} on light", colour.0);
                assert!(contrast(colour.2, behind.2) >= least, "{} on dark", colour.0);
            }
        }
        assert_eq!(COLOURS.iter().filter(|colour| colour.0.starts_with("series")).count(), SERIES);
    }
}
