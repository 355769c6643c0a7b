//! The words of the command line, and mistakes in them, said as all other mistakes are: one sentence with what was expected.

use crate::command::Line;
use crate::fault::{Fault, hint};
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{CommandFactory, FromArgMatches};

/// The command line that the program was called with.
///
/// # Errors
/// Words that make no command line, help and the version among them.
pub fn read() -> Result<Line, clap::Error> {
    // `--seed -1` is a wrong number, not an unknown option
    let negative = |arg: clap::Arg| {
        let takes = arg.get_action().takes_values();
        if takes { arg.allow_negative_numbers(true) } else { arg }
    };
    let command = Line::command().mut_subcommands(|command| command.mut_args(negative));
    Line::from_arg_matches(&command.try_get_matches()?)
}

/// What is wrong with a command line. Help and the version are no mistakes: none.
pub fn mistake(error: &clap::Error) -> Option<Fault> {
    if !error.use_stderr() || error.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        return None;
    }
    let words = |kind: ContextKind| match error.get(kind) {
        Some(ContextValue::String(text)) => vec![text.clone()],
        Some(ContextValue::Strings(list)) => list.clone(),
        _ => Vec::new(),
    };
    let quoted = |kind: ContextKind| words(kind).iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
    let argument = quoted(ContextKind::InvalidArg);
    let value = words(ContextKind::InvalidValue).concat();
    let known = quoted(ContextKind::ValidValue);
    let meant = [ContextKind::SuggestedArg, ContextKind::SuggestedValue];
    let meant = meant.map(quoted).concat();
    let meant = if meant.is_empty() { String::new() } else { format!("; did you mean {meant}?") };
    let what = match error.kind() {
        ErrorKind::InvalidValue if value.is_empty() => format!("{argument} needs a value"),
        ErrorKind::InvalidValue => format!("{argument} cannot be `{value}`; there are {known}{meant}"),
        ErrorKind::ValueValidation => {
            let why = std::error::Error::source(error).map(expected).unwrap_or_default();
            format!("{argument} takes {why}, found `{value}`")
        }
        ErrorKind::UnknownArgument => format!("{argument} is not known here{meant}"),
        ErrorKind::InvalidSubcommand => {
            let name = words(ContextKind::InvalidSubcommand).concat();
            let line = Line::command();
            let known: Vec<&str> = line.get_subcommands().map(clap::Command::get_name).collect();
            format!("no command is called `{name}`{}", hint(&name, &known))
        }
        ErrorKind::MissingRequiredArgument => format!("{argument} is missing"),
        ErrorKind::ArgumentConflict => {
            format!("{argument} cannot stand beside {}", quoted(ContextKind::PriorArg))
        }
        _ => {
            let text = error.to_string();
            text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned()
        }
    };
    Some(Fault::Input(format!("{what} (--help says more)")))
}

/// What a value should have been, by what its reader says.
fn expected(why: &(dyn std::error::Error + 'static)) -> String {
    if why.is::<core::num::ParseIntError>() {
        return "a whole number, 0 or more".into();
    }
    if why.is::<core::num::ParseFloatError>() {
        return "a number".into();
    }
    why.to_string()
}
