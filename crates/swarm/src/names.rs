//! Names that files give: of sets, and of terms with their sets. They are kept for as long as the program runs, so that they
//! can stand wherever the names of the models do.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());

/// The name, to be kept. Each different one is stored once.
pub fn lasting(name: &str) -> &'static str {
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(known) = names.get(name) {
        return known;
    }
    let kept: &'static str = Box::leak(name.to_owned().into_boxed_str());
    names.insert(kept);
    kept
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_name_is_stored_once() {
        let (one, other) = (super::lasting("near ones"), super::lasting(&String::from("near ones")));
        assert!(core::ptr::eq(one, other));
    }
}
