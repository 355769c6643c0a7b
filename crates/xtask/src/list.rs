//! The list of models in `crates/swarm/src/models/mod.rs`, read as text.

use crate::failure::Failure;
use crate::workspace::Workspace;
use core::ops::Range;

/// The folder of the models.
pub(crate) const FOLDER: &str = "crates/swarm/src/models";
/// The file with the list.
pub(crate) const FILE: &str = "crates/swarm/src/models/mod.rs";

/// The list of models.
pub(crate) struct List {
    /// The whole file.
    pub(crate) text: String,
    /// Where the lines of the list stand in it.
    lines: Range<usize>,
}

impl List {
    /// Reads the list.
    pub(crate) fn read(workspace: &Workspace) -> Result<Self, Failure> {
        Self::of(workspace.read(FILE)?)
    }
    fn of(text: String) -> Result<Self, Failure> {
        let missing = || Failure::Tool(format!("{FILE} has no list that starts with a line `models! {{`"));
        let opening = "\nmodels! {\n";
        let start = text.find(opening).ok_or_else(missing)? + opening.len();
        let length = text[start..].find("\n}").ok_or_else(missing)? + 1;
        Ok(Self { text, lines: start..start + length })
    }
    /// The ids in the list, in its order.
    pub(crate) fn ids(&self) -> Vec<String> {
        let id = |line: &str| {
            let line = line.trim();
            let (_, rest) = line.split_once(' ').filter(|_| !line.starts_with("//"))?;
            rest.split_once("::").map(|(id, _)| id.to_owned())
        };
        self.text[self.lines.clone()].lines().filter_map(id).collect()
    }
    /// Modules beside the models, which the file declares itself.
    pub(crate) fn other_modules(&self) -> Vec<String> {
        let name = |line: &str| {
            let line = line.trim().trim_start_matches("pub(crate) ").trim_start_matches("pub ");
            line.strip_prefix("mod ")?.strip_suffix(';').map(str::to_owned)
        };
        self.text.lines().filter_map(name).collect()
    }
    /// The file with one more line at the end of the list.
    pub(crate) fn with(&self, line: &str) -> String {
        let (before, after) = self.text.split_at(self.lines.end);
        format!("{before}    {line}\n{after}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
pub(crate) mod oracle;
macro_rules! models {
    () => {};
}
// a note
models! {
    // by age
    streams vicsek_1995::Vicsek1995 in [2, 3];
    lists hamilton_1d::Hamilton1d in [1];
}
fn after() {}
";

    #[test]
    fn reads_ids_and_adds_a_line() -> Result<(), Failure> {
        let list = List::of(TEXT.into())?;
        assert_eq!(list.ids(), ["vicsek_1995", "hamilton_1d"]);
        assert_eq!(list.other_modules(), ["oracle"]);
        let longer = List::of(list.with("streams other::Other in [2];"))?;
        assert_eq!(longer.ids(), ["vicsek_1995", "hamilton_1d", "other"]);
        assert_eq!(longer.text.replace("    streams other::Other in [2];\n", ""), TEXT);
        assert!(List::of("nothing".into()).is_err());
        Ok(())
    }
}
