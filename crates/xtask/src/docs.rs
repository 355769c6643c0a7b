//! `cargo xtask docs`: a page with a drawing for each model and an index of them, the keys of files, the metrics, the stock terms: from what the code says
//! of itself.

use crate::failure::Failure;
use crate::list::List;
use crate::workspace::{Workspace, not_run};

const FOLDER: &str = "docs/models";
const PICTURES: &str = "docs/models/pictures";
const INDEX: &str = "docs/models/README.md";
const REFERENCE: &str = "docs/reference";
const METRICS: &str = "docs/reference/metrics.md";
const TERMS: &str = "docs/reference/terms.md";
const NOTE: &str = "<!-- Written by `cargo xtask docs` from the code; edit that instead. -->\n\n";

/// Writes the pages; removes those of models that are gone.
pub(crate) fn write(workspace: &Workspace) -> Result<(), Failure> {
    let pages = pages(workspace)?;
    let mut changed = 0;
    for (file, text) in &pages {
        if workspace.read(file).ok().as_ref() != Some(text) {
            workspace.write(file, text)?;
            changed += 1;
        }
    }
    let left = leftovers(workspace, &pages)?;
    for file in &left {
        std::fs::remove_file(workspace.path(file))
            .map_err(|error| Failure::Tool(format!("cannot remove {file}: {error}")))?;
    }
    say!("docs: {} pages, {changed} written, {} removed", pages.len(), left.len());
    Ok(())
}

/// Says which pages are not as the code would have them.
pub(crate) fn compare(workspace: &Workspace) -> Result<(), Failure> {
    let pages = pages(workspace)?;
    let differs = |(file, text): &&(String, String)| workspace.read(file).ok().as_ref() != Some(text);
    let mut files: Vec<String> = pages.iter().filter(differs).map(|(file, _)| file.clone()).collect();
    files.extend(leftovers(workspace, &pages)?);
    if files.is_empty() {
        say!("docs: {} pages, up to date", pages.len());
        return Ok(());
    }
    Err(Failure::No(format!(
        "these pages are not what the code says; run `cargo xtask docs`:\n  {}",
        files.join("\n  ")
    )))
}

/// Every page with its file.
fn pages(workspace: &Workspace) -> Result<Vec<(String, String)>, Failure> {
    let ids = List::read(workspace)?.ids();
    let mut pages = Vec::new();
    for id in &ids {
        let text = flockworks(workspace, &["models", id, "--format", "md"])?;
        let picture = flockworks(workspace, &["models", id, "--picture"])?;
        pages.push((format!("{FOLDER}/{id}.md"), format!("{NOTE}{}", with_picture(id, &text, &picture))));
        pages.push((format!("{PICTURES}/{id}.svg"), picture));
    }
    let table = flockworks(workspace, &["models", "--format", "md"])?;
    let index = index(&ids, &table);
    pages.push((INDEX.to_owned(), index));
    for kind in flockworks(workspace, &["schema"])?.lines() {
        let keys = flockworks(workspace, &["schema", kind, "--format", "md"])?;
        pages.push((format!("{REFERENCE}/{kind}.md"), format!("{NOTE}{keys}")));
    }
    let metrics = flockworks(workspace, &["metrics", "--format", "md"])?;
    pages.push((METRICS.to_owned(), format!("{NOTE}# The metrics\n\n{metrics}")));
    let terms = flockworks(workspace, &["terms", "--format", "md"])?;
    pages.push((TERMS.to_owned(), format!("{NOTE}# The stock terms of compositions\n\n{terms}")));
    Ok(pages)
}

/// A model's page with the drawing of a run, and what it says of itself, before its first section.
fn with_picture(id: &str, page: &str, picture: &str) -> String {
    let about =
        picture.split_once("<desc>").and_then(|(_, rest)| rest.split_once("</desc>")).map_or("", |(about, _)| about);
    let section = format!("## A typical run\n\n![A typical run of {id}](pictures/{id}.svg)\n\n{about}\n\n## ");
    page.replacen("## ", &section, 1)
}

/// The table of models with a link in each row.
fn index(ids: &[String], table: &str) -> String {
    let mut text =
        format!("{NOTE}# The models\n\nOne page each. The words are explained in [NOTATION](../NOTATION.md).\n\n");
    for line in table.lines() {
        let id = line.trim_start_matches("| ").split(" |").next().unwrap_or_default().trim_matches('`');
        let row = if ids.iter().any(|known| known == id) {
            line.replacen(id, &format!("[{id}]({id}.md)"), 1)
        } else {
            line.to_owned()
        };
        text += &row;
        text.push('\n');
    }
    text
}

/// Pages of models that are not in the list any more.
fn leftovers(workspace: &Workspace, pages: &[(String, String)]) -> Result<Vec<String>, Failure> {
    let mut files = Vec::new();
    for (folder, ending) in [(FOLDER, ".md"), (PICTURES, ".svg")] {
        if workspace.path(folder).is_dir() {
            let names = workspace.entries(folder)?;
            files.extend(names.iter().filter(|name| name.ends_with(ending)).map(|name| format!("{folder}/{name}")));
        }
    }
    files.retain(|file| pages.iter().all(|(page, _)| page != file));
    Ok(files)
}

fn flockworks(workspace: &Workspace, arguments: &[&str]) -> Result<String, Failure> {
    let mut cargo = workspace.cargo();
    cargo
        .args(["run", "--quiet", "--package", "flockworks", "--"])
        .args(arguments)
        .stderr(std::process::Stdio::inherit());
    let output = cargo.output().map_err(|error| not_run(&cargo, &error))?;
    if !output.status.success() {
        return Err(Failure::No(format!("`flockworks {}` did not end well", arguments.join(" "))));
    }
    String::from_utf8(output.stdout).map_err(|_| Failure::Tool("flockworks printed what is not text".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_stands_before_the_first_section() {
        let picture = "<svg><title>Some</title><desc>They mill.</desc></svg>";
        let page = with_picture("some", "# Some\n\nAbout.\n\n## Dimensions\n\n2\n\n## Reference\n", picture);
        let places = ["About.", "## A typical run", "pictures/some.svg", "They mill.", "## Dimensions", "## Reference"]
            .map(|part| page.find(part));
        assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{page}");
        assert_eq!(page.matches("## Dimensions").count(), 1);
    }

    #[test]
    fn the_index_links_each_model() {
        let table = "| id | title |\n| --- | --- |\n| vicsek_1995 | vicsek_1995 and more |\n";
        let text = index(&["vicsek_1995".into()], table);
        assert!(
            text.ends_with("| id | title |\n| --- | --- |\n| [vicsek_1995](vicsek_1995.md) | vicsek_1995 and more |\n")
        );
    }
}
