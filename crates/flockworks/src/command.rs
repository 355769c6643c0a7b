//! The commands and their options.

use crate::analyze::{AnalyzeOptions, analyze};
use crate::bench::{BenchOptions, bench};
use crate::conformance::{ConformanceOptions, conformance};
use crate::eval::{EvalOptions, eval};
use crate::export::{ExportOptions, export};
use crate::fault::Fault;
use crate::files::{self, CompletionsOptions, ExplainOptions, KindOptions, ManOptions, SchemaOptions};
use crate::kinds::study::{MergeOptions, merge};
use crate::metrics::{MetricsOptions, metrics};
use crate::models::{ModelsOptions, models};
use crate::run::{self, CheckOptions, ReportOptions, RunOptions};
use crate::step::{StepOptions, step};
use crate::terms::{TermsOptions, terms};
use crate::view::{ViewOptions, view};
use clap::{Parser, Subcommand};
use std::io::Write;

/// A laboratory for collective motion: simulate, perceive, measure.
#[derive(Parser, Debug)]
#[command(
    name = "flockworks",
    version,
    max_term_width = 100,
    after_help = "\
To begin: flockworks new scenario > flock.toml, then flockworks run flock.toml

Exit codes: 0 done; 1 ran, and the answer is no (a case failed); 2 the input is wrong; 70 our fault;\n130 interrupted."
)]
pub struct Line {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// A command.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Run a file: results, tables and a page in a folder. The same command again continues where it stopped.
    Run(RunOptions),
    /// Measure tracks of animals, people or simulations: tables of text or Parquet, or folders of runs.
    Analyze(Box<AnalyzeOptions>),
    /// Look at a world while it runs and change it, or at runs that were recorded: a page on this machine alone.
    View(ViewOptions),
    /// Check files and run nothing: everything that is wrong, at its place.
    Check(CheckOptions),
    /// Print a commented file to start from.
    New(KindOptions),
    /// Print the JSON schema of a kind of file, for editors, or the table of its keys; without a kind, all kinds.
    Schema(SchemaOptions),
    /// Say what moved one agent of a recorded run: what it perceived, whom it selected, what each rule asked, as JSON.
    Explain(ExplainOptions),
    /// Make the page of a complete run anew.
    Report(ReportOptions),
    /// Join the folders that runs of one study with `--shard` left.
    Merge(MergeOptions),
    /// Write what is in a folder in another form: a page that plays offline, pictures, films, scenes in space, tables.
    Export(ExportOptions),
    /// List the metrics, or show one: definition, unit, source, parameters, edge cases.
    Metrics(MetricsOptions),
    /// Print the state of a case after some steps, as JSON.
    Step(StepOptions),
    /// Run every case of a file and compare with the state it expects.
    ///
    /// The last line is `N of M`: cases passed of cases run.
    /// The exit code is 1 if a case fails or its model is unknown.
    #[command(verbatim_doc_comment)]
    Conformance(ConformanceOptions),
    /// Answer small exact questions about environments and behaviours, as JSON: one value for each case of a file.
    Eval(EvalOptions),
    /// List the models, or show one: equations, parameters, stages, state, random quantities, classification.
    Models(ModelsOptions),
    /// List the stock terms of compositions, or show one: vector, parameters, edge rules.
    Terms(TermsOptions),
    /// Measure the speed of the workloads, or of every model.
    ///
    /// W1, W1c  Vicsek, 2-D: near uniform, and clustered
    /// W2       boids with unit headings, 3-D
    /// W3       the flocking benchmark of agent-based-model frameworks, 2-D, one agent after the other
    /// W4       a trial of the behaviour-selection study, 3-D: W4/Align/6, W4/Prob/6, W4/Attract/6 and .../199
    /// W5       a generation of competing flocks, 2-D
    /// W6       a trial of group control: 25 boids among walls that hide, 2-D
    /// models   each model beside a plain hand-written loop, where there is one
    /// compositions  compositions of stock terms beside the compiled models of the same laws
    ///
    /// Seeds are fixed. Times are medians after a warm-up, of runs interleaved over threads and precisions.
    #[command(verbatim_doc_comment)]
    Bench(BenchOptions),
    /// Print completions for a shell.
    Completions(CompletionsOptions),
    /// Write man pages into a folder.
    Man(ManOptions),
}

/// Runs a command; the answer is its exit code.
///
/// # Errors
/// See [`Fault`].
pub fn run(line: &Line, out: &mut dyn Write) -> Result<u8, Fault> {
    match &line.command {
        Command::Run(options) => run::run(options, out),
        Command::Analyze(options) => analyze(options, out).map(|()| 0),
        Command::View(options) => view(options, out).map(|()| 0),
        Command::Check(options) => run::check(options, out).map(|()| 0),
        Command::New(options) => files::new(options, out).map(|()| 0),
        Command::Schema(options) => files::schema(options, out).map(|()| 0),
        Command::Explain(options) => files::explain(options, out).map(|()| 0),
        Command::Report(options) => run::report(options, out).map(|()| 0),
        Command::Merge(options) => merge(options, out).map(|()| 0),
        Command::Export(options) => export(options, out).map(|()| 0),
        Command::Metrics(options) => metrics(options, out).map(|()| 0),
        Command::Completions(options) => files::completions(options, out).map(|()| 0),
        Command::Man(options) => files::man(options, out).map(|()| 0),
        Command::Step(options) => step(options, out).map(|()| 0),
        Command::Conformance(options) => conformance(options, out).map(|good| u8::from(!good)),
        Command::Eval(options) => eval(options, out).map(|()| 0),
        Command::Models(options) => models(options, out).map(|()| 0),
        Command::Terms(options) => terms(options, out).map(|()| 0),
        Command::Bench(options) => bench(options, out).map(|()| 0),
    }
}
