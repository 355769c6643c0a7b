//! A folder that a file of some kind fills, session by session, until it is complete.

use super::StoreError;
use super::folder::{self, Folder};
use super::texts::Texts;
use crate::file::{Problems, Sources};
use serde_json::{Value as Json, json};
use std::path::Path;

/// A kind of files whose folders are filled in sessions.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Its name, as manifests have it.
    pub name: &'static str,
    /// The name with its article.
    pub one: &'static str,
    /// What may be added to a folder.
    pub may_grow: &'static str,
}

impl Kind {
    fn named(&self, manifest: &Json) -> bool {
        manifest.get("kind").and_then(Json::as_str) == Some(self.name)
    }
    /// Where a manifest is of another kind; then nothing else about it need be compared.
    pub fn foreign(&self, manifest: &Json) -> Option<Vec<String>> {
        (!self.named(manifest)).then(|| vec![format!("it holds no {}", self.name)])
    }
    /// Where the identity that a manifest keeps differs from this one.
    pub fn differences(&self, manifest: &Json, identity: &Json) -> Vec<String> {
        let there = manifest.get("identity").unwrap_or(&Json::Null);
        self.foreign(manifest).unwrap_or_else(|| folder::differences(there, identity))
    }
    /// What is read again from the texts that the folder keeps.
    ///
    /// # Errors
    /// A folder of something else, or one that cannot be read.
    pub fn read<T>(&self, path: &Path, read: impl FnOnce(&Texts) -> Result<T, String>) -> Result<T, StoreError> {
        let manifest = folder::manifest(path)?
            .filter(|manifest| self.named(manifest))
            .ok_or_else(|| StoreError::Refused(format!("`{}` is not the folder of {}", path.display(), self.one)))?;
        let texts = Texts::of(&manifest).ok_or_else(|| "the manifest lacks what it should hold".to_owned());
        texts
            .and_then(|texts| read(&texts))
            .map_err(|what| StoreError::Damaged(format!("`{}`: {what}", path.display())))
    }
    /// The plan of a folder, read again from its texts: name and text of the file, what is put over it, whether it is quick, and
    /// who loads the files it names.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn plan<P>(
        &self,
        path: &Path,
        read: impl FnOnce(
            &str,
            &str,
            &[String],
            bool,
            &mut dyn FnMut(&str) -> Result<String, String>,
        ) -> Result<P, Problems>,
    ) -> Result<P, StoreError> {
        self.read(path, |texts| {
            let (name, first) = texts.file();
            read(name, first, &texts.sets, texts.quick, &mut |name| texts.text(name))
                .map_err(|problems| problems.to_string())
        })
    }
}

/// A file that fills a folder, with what was put over it.
pub struct File<'a> {
    /// Its title.
    pub title: &'a str,
    /// Its texts.
    pub sources: &'a Sources,
    /// What was put over it.
    pub sets: &'a [String],
    /// Whether it is run quick.
    pub quick: bool,
    /// What its results depend on.
    pub identity: Json,
}

/// A folder in a session of work.
#[derive(Debug)]
pub struct Job {
    /// The folder.
    pub folder: Folder,
    manifest: Json,
}

impl Job {
    /// Begins a session for a file: in the folder asked for, or in one below `runs` that has the file's name and is free or of the
    /// same file.
    ///
    /// # Errors
    /// As [`Self::begin`].
    pub fn of_file(
        kind: Kind,
        file: &File<'_>,
        out: Option<&Path>,
        session: (&str, usize),
    ) -> Result<Self, StoreError> {
        let stem = file.sources.stem(0).unwrap_or(kind.name);
        let differences = |manifest: &Json| kind.differences(manifest, &file.identity);
        let path = folder::place(out, stem, (kind.name, kind.may_grow), &differences)?;
        let about = [
            ("title", json!(file.title)),
            ("files", Texts::json(file.sources, file.sets, file.quick)),
            ("identity", file.identity.clone()),
        ];
        Self::begin(kind, &path, &about, &differences, session)
    }
    /// Begins a session in a folder, or goes on in it. `about` are the entries of the manifest that tell what it is of;
    /// `differences` tells from a manifest where it is of something else.
    ///
    /// # Errors
    /// Where the folder is of something else, or the system refuses.
    pub fn begin(
        kind: Kind,
        path: &Path,
        about: &[(&str, Json)],
        differences: &dyn Fn(&Json) -> Vec<String>,
        (program, threads): (&str, usize),
    ) -> Result<Self, StoreError> {
        let folder = Folder::claim(path)?;
        // another process may have had the folder in the meantime
        let before = folder::manifest(path)?;
        let lines = before.as_ref().map_or_else(Vec::new, differences);
        if !lines.is_empty() {
            return Err(folder::other(path, (kind.name, kind.may_grow), lines));
        }
        let mut manifest = before.unwrap_or_else(|| json!({ "format": 1, "kind": kind.name, "sessions": [] }));
        for (key, value) in about {
            manifest[*key] = value.clone();
        }
        manifest["status"] = json!("running");
        if let Some(Json::Array(sessions)) = manifest.get_mut("sessions") {
            sessions.push(crate::run::session(program, threads));
        }
        folder.write_manifest(&manifest)?;
        Ok(Self { folder, manifest })
    }
    /// Notes what the session did.
    pub fn note(&mut self, done: &[(&str, Json)]) {
        let sessions = self.manifest.get_mut("sessions").and_then(Json::as_array_mut);
        if let Some(Json::Object(session)) = sessions.and_then(|sessions| sessions.last_mut()) {
            session.extend(done.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));
        }
    }
    /// Ends the session.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn end(&mut self, complete: bool) -> Result<(), StoreError> {
        self.manifest["status"] = json!(if complete { "complete" } else { "stopped" });
        self.folder.write_manifest(&self.manifest)
    }
    /// Ends the session for an error, which is the one to tell.
    pub fn fail(&mut self, error: StoreError) -> StoreError {
        let _ = self.end(false);
        error
    }
}
