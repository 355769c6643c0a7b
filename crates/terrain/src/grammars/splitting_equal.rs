//! `splitting-equal`: the splitting grammar with equal weights, the condition that the source's proof of completeness
//! names.

use super::splitting;
use crate::grammar::Grammar;

/// The grammar.
pub fn grammar() -> Grammar {
    splitting::with_weights("splitting-equal", [1.0; 3])
}
