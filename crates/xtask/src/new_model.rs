//! `cargo xtask new-model NAME`: a complete model file, and its line in the list of models. Nothing else is touched.

use crate::failure::Failure;
use crate::list::{self, List};
use crate::workspace::{Workspace, succeed};

/// A law that compiles and passes its tests, under a name of its own.
const TEMPLATE: &str = include_str!("../template/model.rs");
const NAME: &str = "new_model_name";
const TYPE: &str = "NewModelName";

/// Words of the language that cannot be the name of a file's module.
const KEYWORDS: &str = "abstract as async await become box break const continue crate do dyn else enum extern false final fn \
    for gen if impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try \
    type typeof unsafe unsized use virtual where while yield";

/// Writes the model file and the line.
pub(crate) fn new_model(workspace: &Workspace, name: &str) -> Result<(), Failure> {
    let list = List::read(workspace)?;
    check_name(name).map_err(Failure::Input)?;
    let file = format!("{}/{name}.rs", list::FOLDER);
    let taken = list.ids().iter().chain(&list.other_modules()).any(|other| other == name);
    if taken || workspace.path(&file).exists() {
        return Err(Failure::Input(format!("there is a model or a module `{name}` already, in {}", list::FOLDER)));
    }
    let type_name = type_name(name);
    workspace.write(&file, &TEMPLATE.replace(NAME, name).replace(TYPE, &type_name))?;
    succeed(
        workspace.tool("rustfmt").args(["--edition", "2024", &file]),
        &format!("rustfmt refuses {file}; remove it and try again"),
    )?;
    workspace.write(list::FILE, &list.with(&format!("streams {name}::{type_name} in [2, 3];")))?;
    say!(
        "wrote {file} and its line in {}.\n\
         Replace every text marked REPLACE ME, the law and its tests. When the law is final:\n  \
         FLOCKWORKS_BLESS=1 cargo test --package swarm --lib bits_never_change    (records the hashes of its states)\n  \
         cargo xtask docs                                                         (writes its page)\n  \
         cargo xtask test",
        list::FILE
    );
    Ok(())
}

fn check_name(name: &str) -> Result<(), String> {
    let letters = name.chars().all(|l| l.is_ascii_lowercase() || l.is_ascii_digit() || l == '_');
    let words = name.split('_').all(|word| !word.is_empty());
    if !(letters && words && name.starts_with(|l: char| l.is_ascii_lowercase())) {
        return Err(format!("`{name}` is not lower snake case: expected words such as `couzin_2002`"));
    }
    if KEYWORDS.split_whitespace().any(|word| word == name) {
        return Err(format!("`{name}` is a word of the language; choose another name"));
    }
    Ok(())
}

fn type_name(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
    };
    name.split('_').map(capital).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names() {
        for good in ["couzin_2002", "ring", "a_1"] {
            assert_eq!(check_name(good), Ok(()));
        }
        for bad in ["", "Couzin", "couzin__2002", "_a", "a_", "2002", "a-b", "type", "a b", "../a"] {
            assert!(check_name(bad).is_err(), "{bad}");
        }
        assert_eq!(type_name("couzin_2002"), "Couzin2002");
        assert_eq!(type_name("hamilton_1d"), "Hamilton1d");
    }
}
