//! `flockworks terms`: the stock terms of compositions.

use crate::fault::{Fault, hint, wrong};
use crate::metrics::MetricsForm;
use crate::models::{card_parameters, parameters_table};
use crate::table::Table;
use clap::Args;
use std::io::Write;
use swarm::terms::{Entry, LIST, find};

/// Options of `terms`.
#[derive(Args, Debug)]
pub struct TermsOptions {
    /// A term's id, for all there is to know about it; without it, a table of all terms.
    pub id: Option<String>,
    /// Form of the output.
    #[arg(long, value_enum, default_value = "text")]
    pub format: MetricsForm,
}

/// Prints the table of terms, or one term's card.
///
/// # Errors
/// An unknown id, or a reader that went away.
pub fn terms(options: &TermsOptions, out: &mut dyn Write) -> Result<(), Fault> {
    if let Some(id) = &options.id {
        let Some(entry) = find(id) else {
            let ids: Vec<&str> = LIST.iter().map(|entry| entry.card.id).collect();
            return wrong(format!("unknown term `{id}`{}", hint(id, &ids)));
        };
        out.write_all(card(entry, options.format).as_bytes())?;
        return Ok(());
    }
    let mut table = Table::new(&["id", "about", "what it does"]);
    for Entry { card, .. } in LIST {
        let about = if card.members { "members of a set" } else { "itself, surroundings" };
        table.row(vec![card.id.into(), about.into(), card.about.into()]);
    }
    if options.format == MetricsForm::Md {
        writeln!(out, "{}", table.markdown())?;
        for entry in LIST {
            writeln!(out, "{}", card(entry, options.format))?;
        }
        return Ok(());
    }
    write!(out, "{}\n{} terms; `flockworks terms ID` shows one.\n", table.text(), LIST.len())?;
    Ok(())
}

/// All there is to know about a term.
fn card(entry: &Entry, form: MetricsForm) -> String {
    let card = entry.card;
    match form {
        MetricsForm::Text => format!(
            "{}: {}\n\nVector, before the weight\n{}\nParameters\n{}\nEdge rules\n  {}\n",
            card.id,
            card.about,
            card.equation.lines().map(|line| format!("  {}\n", line.trim())).collect::<String>(),
            card_parameters(&entry.parameters()),
            card.edge
        ),
        MetricsForm::Md => format!(
            "## `{}`\n\n{}\n\n```\n{}\n```\n\n{}\nEdge rules: {}.\n",
            card.id,
            card.about,
            card.equation,
            parameters_table(&entry.parameters()).markdown(),
            card.edge
        ),
    }
}
