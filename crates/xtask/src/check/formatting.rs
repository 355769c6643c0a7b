//! Every Rust file is formatted.

use super::Rule;

pub(super) const RULE: Rule = Rule {
    name: "formatting",
    sentence: "these files are not formatted; run `cargo xtask fmt`:",
    broken: crate::rustfmt::unformatted,
};
