//! `flockworks new`, `schema`, `explain`, `completions`, `man`: what helps with files.

use crate::command::Line;
use crate::fault::Fault;
use crate::kinds;
use clap::{Args, CommandFactory, ValueEnum};
use lab::store::StoreError;
use std::io::Write;
use std::path::PathBuf;

/// Options of `new`.
#[derive(Args, Debug)]
pub struct KindOptions {
    /// Kind of file, as it stands behind `kind =` in it.
    pub kind: String,
}

/// Form of a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaForm {
    /// JSON schema.
    Json,
    /// Markdown, to read.
    Md,
}

/// Options of `schema`.
#[derive(Args, Debug)]
pub struct SchemaOptions {
    /// Kind of file, as it stands behind `kind =` in it. Left out, the kinds there are.
    pub kind: Option<String>,
    /// Form of the output.
    #[arg(long, value_enum, default_value = "json")]
    pub format: SchemaForm,
}

/// Options of `explain`.
#[derive(Args, Debug)]
pub struct ExplainOptions {
    /// Folder of a complete run.
    pub folder: PathBuf,
    /// Number of the kept frame, from 0.
    #[arg(long, value_name = "F")]
    pub frame: u64,
    /// Number of the agent in the world, from 0.
    #[arg(long, value_name = "I")]
    pub agent: u32,
}

/// Options of `completions`.
#[derive(Args, Debug)]
pub struct CompletionsOptions {
    /// The shell.
    pub shell: clap_complete::Shell,
}

/// Options of `man`.
#[derive(Args, Debug)]
pub struct ManOptions {
    /// Folder for the pages, one for each command.
    pub folder: PathBuf,
}

/// Prints a commented file to start from.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn new(options: &KindOptions, out: &mut dyn Write) -> Result<(), Fault> {
    out.write_all(kinds::find(&options.kind)?.template().as_bytes())?;
    Ok(())
}

/// Prints the schema of a kind of file, or the kinds there are.
///
/// # Errors
/// An unknown kind, or a reader that went away.
pub fn schema(options: &SchemaOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let Some(kind) = &options.kind else {
        writeln!(out, "{}", kinds::ids().join("\n"))?;
        return Ok(());
    };
    let kind = kinds::find(kind)?;
    match options.format {
        SchemaForm::Md => out.write_all(kind.reference().as_bytes())?,
        SchemaForm::Json => writeln!(out, "{}", serde_json::to_string_pretty(&kind.schema()).unwrap_or_default())?,
    }
    Ok(())
}

/// Prints what an agent does in the step that begins at a frame, stage by stage, as JSON.
///
/// # Errors
/// A folder that is of no complete run, a frame or an agent that is not there, or a reader that went away.
pub fn explain(options: &ExplainOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let explanation = lab::explain::at(&options.folder, options.frame, options.agent)?;
    writeln!(out, "{}", serde_json::to_string_pretty(&explanation).unwrap_or_default())?;
    Ok(())
}

/// Prints completions for a shell.
///
/// # Errors
/// A reader that went away.
pub fn completions(options: &CompletionsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let mut text = Vec::new();
    clap_complete::generate(options.shell, &mut Line::command(), "flockworks", &mut text);
    out.write_all(&text)?;
    Ok(())
}

/// Writes the man pages.
///
/// # Errors
/// A folder that cannot be written to.
pub fn man(options: &ManOptions, out: &mut dyn Write) -> Result<(), Fault> {
    let folder = &options.folder;
    std::fs::create_dir_all(folder).map_err(|error| StoreError::io("make the folder", folder, error))?;
    clap_mangen::generate_to(Line::command(), folder)
        .map_err(|error| StoreError::io("write man pages in", folder, error))?;
    writeln!(out, "{}", folder.join("flockworks.1").display())?;
    Ok(())
}
