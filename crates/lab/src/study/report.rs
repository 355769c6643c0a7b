//! The page of a study: figures of means with their errors, statements with what the data say of them, tests as sentences
//! for a paper, and every number behind them as a table.

use super::claims::{self, DRAWINGS, Drawings, Judged, Judgement, Level, Verdict};
use super::execute::{Results, Selection};
use super::form::{Claim, Figure as Wanted, Test};
use super::plan::{Part, Plan, Varied};
use super::tables::{Summary, by_trial, of_cell};
use crate::report::{Axis, Fact, Figure, Line, Lines, Listing, Means, Page, Table, short};
use measure::statistics::{EffectSize, OneWay, PairComparison, Residual, blocked, one_way, tukey_kramer};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Level at which tests are called significant.
const LEVEL: f64 = 0.05;
/// Share of the drawings that may disagree with a statement that says nothing of it.
const DOUBT: f64 = 0.025;
/// Trials below which drawing them again tells of less doubt than there is.
const FEW: usize = 10;
/// How much less, of two means that are the same.
const FEW_TRIALS: &str = " Here some cells have fewer than ten trials, and with so few the drawings are too sure: of two means that \
     are the same a difference is then found in 12 % of studies with eight trials, 16 % with five, 24 % with three and 48 % with two, \
     not in 5 %.";
/// Cells that are listed in the page; all are in the table.
const LISTED: usize = 300;

/// The statements of a study with what the data say of them, part by part; last those about several parts.
pub fn judgements(plan: &Plan, results: &Results) -> Vec<Judgement> {
    let most = results.iter().filter_map(|trials| trials.keys().last()).copied().max().unwrap_or(0);
    let drawings = Drawings::of(plan.seed, most);
    let judge = |part: &Part, name: &str, claim: &Claim| Judgement {
        part: name.to_owned(),
        claim: claim.clone(),
        judged: claims::judge(plan, results, part, claim, &drawings),
    };
    let several = plan.parts.len() > 1;
    let of = |part: &Part| {
        let name = if several { part.name.as_str() } else { "" };
        part.claims.iter().map(|claim| judge(part, name, claim)).collect::<Vec<_>>()
    };
    let mut judgements: Vec<Judgement> = plan.parts.iter().flat_map(of).collect();
    // statements about several parts name the part before each reading
    judgements
        .extend(plan.parts.first().into_iter().flat_map(|part| plan.claims.iter().map(move |c| judge(part, "", c))));
    judgements
}

/// What the data say of everything that was asked: figures, tests as sentences, statements, cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct Answers {
    pub(crate) figures: Vec<Figure>,
    pub(crate) sentences: Vec<String>,
    pub(crate) tables: Vec<Table>,
    /// How many statements hold.
    pub(crate) facts: Vec<Fact>,
}

/// Answers everything that a plan asks of results.
pub(crate) fn answers(plan: &Plan, results: &Results, judgements: &[Judgement]) -> Answers {
    let mut figures = Vec::new();
    let statements: Vec<Vec<String>> =
        judgements.iter().map(|Judgement { part, claim, judged }| statement(part, claim, judged)).collect();
    let (mut sentences, mut test_rows) = (Vec::new(), Vec::new());
    for part in &plan.parts {
        figures.extend(part.figures.iter().flat_map(|wanted| drawn(plan, results, part, wanted)));
        for test in &part.tests {
            for (only, cells) in compared(plan, part, test) {
                let (sentence, rows) = tested(plan, results, part, test, &only, &cells);
                sentences.push(sentence);
                test_rows.extend(rows);
            }
        }
    }
    let mut listings = Vec::new();
    if !statements.is_empty() {
        let header = ["", "statement", "source", "strength", "ours", "95 % interval", "published", "verdict", "why"];
        let header: Vec<String> = header.iter().map(|&name| name.to_owned()).collect();
        let mut about = format!(
            "A statement holds where it is true of the means and of nearly every drawing of the trials, with replacement, \
             the same trials in all cells (bootstrap, {DRAWINGS} drawings, at most 2.5 % against it, where nothing else is \
             said)."
        );
        if tried(plan, results).0 < FEW {
            about += FEW_TRIALS;
        }
        listings.push(Listing { title: "Statements".into(), about, header, rows: statements });
    }
    if !test_rows.is_empty() {
        let names =
            ["reading", "cells", "first", "second", "difference", "q", "p", "p with trials as blocks", "effect (g)"];
        let header = names.iter().map(|&name| name.to_owned()).collect();
        let about =
            "Tukey-Kramer comparisons of all pairs after the analyses of variance in Methods. The effect is Hedges' g.";
        listings.push(Listing { title: "Pairs compared".into(), about: about.into(), header, rows: test_rows });
    }
    if plan.cells.len() <= LISTED {
        let several = plan.parts.len() > 1;
        for part in plan.parts.iter().filter(|part| !part.cells.is_empty()) {
            let (header, rows) = cell_rows(plan, results, part);
            listings.push(Listing {
                title: if several { format!("Cells: {}", part.name) } else { "Cells".to_owned() },
                about: "Means over trials with their standard errors.".into(),
                header,
                rows,
            });
        }
    }
    let mut tables = vec![Table {
        file: "cells.csv".into(),
        about: "A row for each cell: means and standard errors.".into(),
        csv: csv(&cells_in_full(plan, results)),
    }];
    for listing in &listings {
        let (file, about) = match listing.title.as_str() {
            "Statements" => ("statements.csv", "A row for each statement."),
            "Pairs compared" => ("pairs.csv", "A row for each pair of levels of each test."),
            _ => continue,
        };
        let rows: Vec<Vec<String>> =
            core::iter::once(listing.header.clone()).chain(listing.rows.iter().cloned()).collect();
        tables.push(Table { file: file.into(), about: about.into(), csv: csv(&rows) });
    }
    figures.extend(listings.into_iter().map(Figure::Listing));
    Answers { figures, sentences, tables, facts: held(judgements) }
}

/// The page.
pub fn page(plan: &Plan, results: &Results, judgements: &[Judgement], program: &str) -> Page {
    let Answers { figures, sentences, tables, facts } = answers(plan, results, judgements);
    let mut methods = methods(plan, results);
    methods.extend(sentences);
    let mut summary = summary(plan, results);
    summary.extend(facts);
    Page {
        title: plan.title.clone(),
        lead: paragraphs(&plan.about),
        methods,
        summary,
        figures,
        tables,
        command: command(plan),
        source: plan.sources.text(0).to_owned(),
        made_by: format!("{program}; trial t has the seed {} + t", plan.seed),
    }
}

fn paragraphs(text: &str) -> Vec<String> {
    let whole = |paragraph: &str| paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    text.split("\n\n").map(whole).filter(|paragraph| !paragraph.is_empty()).collect()
}

fn command(plan: &Plan) -> String {
    let sets: String = plan.sets.iter().map(|set| format!(" --set '{set}'")).collect();
    format!("flockworks run {}{}{sets}", plan.sources.name(0), if plan.quick { " --quick" } else { "" })
}

fn fact(label: &str, value: String) -> Fact {
    Fact { label: label.into(), value }
}

fn summary(plan: &Plan, results: &Results) -> Vec<Fact> {
    let trials: usize = results.iter().map(BTreeMap::len).sum();
    let wanted = Selection::default().units(plan);
    let left = wanted.iter().filter(|(condition, trial)| !results[*condition].contains_key(trial)).count();
    let updates: u64 =
        results.iter().zip(&plan.conditions).map(|(trials, condition)| trials.len() as u64 * condition.updates()).sum();
    let mut facts = vec![
        fact("Cells", plan.cells.len().to_string()),
        fact("Different conditions", plan.conditions.len().to_string()),
        fact("Trials", trials.to_string()),
        fact("Agent-updates", format!("{:.3} G", updates as f64 / 1e9)),
    ];
    if left > 0 {
        facts.push(fact("Trials still missing", left.to_string()));
    }
    facts
}

/// How many statements of each strength hold.
fn held(judgements: &[Judgement]) -> Vec<Fact> {
    let mut facts = Vec::new();
    for strength in [super::form::Strength::A, super::form::Strength::B, super::form::Strength::C] {
        let of = |verdict: &str| {
            judgements
                .iter()
                .filter(|own| own.claim.strength == strength && own.judged.verdict.words() == verdict)
                .count()
        };
        let all = judgements.iter().filter(|own| own.claim.strength == strength).count();
        if all > 0 {
            let text = format!(
                "{} of {all} hold, {} do not, {} open{}",
                of("holds"),
                of("does not hold"),
                of("cannot be judged"),
                match of("reported only") {
                    0 => String::new(),
                    some => format!(", {some} reported only"),
                }
            );
            facts.push(fact(&format!("Statements, strength {}", strength.word()), text));
        }
    }
    facts
}

/// The least and the greatest number of trials that a cell has.
fn tried(plan: &Plan, results: &Results) -> (usize, usize) {
    let trials = || (0..plan.cells.len()).map(|cell| of_cell(plan, results, cell).count());
    (trials().min().unwrap_or(0), trials().max().unwrap_or(0))
}

fn methods(plan: &Plan, results: &Results) -> Vec<String> {
    let span = |least: usize, most: usize| if least == most { least.to_string() } else { format!("{least} to {most}") };
    let wanted = || plan.cells.iter().map(|cell| cell.trials);
    let wanted = span(wanted().min().unwrap_or(0), wanted().max().unwrap_or(0));
    let (least, most) = tried(plan, results);
    let trials = match span(least, most) {
        trials if trials == wanted => format!("{trials} times"),
        trials => format!("{trials} times (of {wanted} planned)"),
    };
    let mut text = format!(
        "Each of {} cells was tried {trials}; trial t has the seed {} + t in every cell, so that trials of different \
         cells begin alike. Cells that come to the same scenario share their trials: {} conditions differ.",
        plan.cells.len(),
        plan.seed,
        plan.conditions.len()
    );
    let time = &plan.units.1;
    let from = plan.looks.from.unwrap_or(plan.looks.interval);
    let _ = write!(
        text,
        " Trials were looked at every {} {time} from {} {time} on; a reading is the mean over these looks unless it says \
         otherwise. The unit of replication is the trial; errors are standard errors of the mean over trials.",
        short(plan.looks.interval),
        short(from)
    );
    let mut methods = vec![text];
    for part in &plan.parts {
        if plan.parts.len() > 1 {
            let about = paragraphs(&part.about).join(" ");
            methods.push(format!("{}. {}. {about}", part.name, part.title.trim_end_matches('.')));
        }
    }
    methods
}

/// The place of a factor of a part.
fn factor(part: &Part, name: &str) -> Option<usize> {
    part.factors.iter().position(|factor| factor.name == name)
}

fn with_units(plan: &Plan, unit: &str) -> String {
    unit.replace("length", &plan.units.0).replace("time", &plan.units.1)
}

/// A figure for each reading that is wanted.
fn drawn(plan: &Plan, results: &Results, part: &Part, wanted: &Wanted) -> Vec<Figure> {
    let Some(x) = factor(part, &wanted.x) else { return Vec::new() };
    let only = claims::asked(&wanted.only);
    let cells = claims::matching(plan, part, &only);
    // what is neither on the axis nor a line nor fixed makes lines too
    let fixed = |k: usize| k == x || only.iter().any(|(name, _)| *name == part.factors[k].name);
    let free: Vec<usize> = (0..part.factors.len()).filter(|&k| !fixed(k)).collect();
    let first = wanted.lines.as_ref().and_then(|name| factor(part, name));
    let mut by: Vec<usize> = first.into_iter().filter(|k| free.contains(k)).collect();
    by.extend(free.iter().copied().filter(|&k| Some(k) != first));
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    for cell in cells {
        let levels = by.iter().map(|&k| {
            let varied = &part.factors[k];
            let text = &varied.levels[plan.cells[cell].levels[k]].text;
            if varied.numeric() { format!("{} = {text}", varied.name) } else { text.clone() }
        });
        let name = levels.collect::<Vec<_>>().join(", ");
        match groups.iter_mut().find(|(own, _)| *own == name) {
            Some((_, cells)) => cells.push(cell),
            None => groups.push((name, vec![cell])),
        }
    }
    let varied = &part.factors[x];
    let names: Vec<String> =
        if varied.numeric() { Vec::new() } else { varied.levels.iter().map(|level| level.text.clone()).collect() };
    let fixed_at: String = only.iter().map(|(name, level)| format!("-{name}-{}", level.words())).collect();
    let several = wanted.y.len() > 1;
    let mut figures = Vec::new();
    for y in &wanted.y {
        let Some(reading) = plan.readings.iter().position(|(name, _)| name == y) else { continue };
        let (mut lines, mut spread) = (Vec::new(), Vec::new());
        for (name, cells) in &groups {
            let mut points: Vec<(f64, Summary)> = cells
                .iter()
                .map(|&cell| {
                    let level = plan.cells[cell].levels[x];
                    let at =
                        if names.is_empty() { varied.levels[level].number.unwrap_or(f64::NAN) } else { level as f64 };
                    (at, Summary::of(of_cell(plan, results, cell).map(|(_, values)| values[reading])))
                })
                .collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            let there = |value: f64| value.is_finite().then_some(value);
            let line = if name.is_empty() { about_of(plan, reading) } else { name.clone() };
            lines.push(Line {
                name: line,
                x: points.iter().map(|(x, _)| *x).collect(),
                y: points.iter().map(|(_, summary)| there(summary.mean)).collect(),
            });
            spread.push(points.iter().map(|(_, summary)| there(summary.error)).collect());
        }
        let title =
            if several { format!("{}: {}", wanted.title, about_of(plan, reading)) } else { wanted.title.clone() };
        let lines = Lines {
            id: format!("{}-{y}-{}{fixed_at}", part.name, wanted.x),
            title,
            about: wanted.about.clone(),
            x: Axis { label: varied.about.clone(), unit: with_units(plan, &varied.unit), range: None },
            y: Axis {
                label: about_of(plan, reading),
                unit: with_units(plan, &plan.readings[reading].1.unit),
                range: None,
            },
            lines,
        };
        figures.push(Figure::Means(Means {
            lines,
            spread,
            spread_name: "standard error".into(),
            names: names.clone(),
        }));
    }
    figures
}

fn about_of(plan: &Plan, reading: usize) -> String {
    let (name, reading) = &plan.readings[reading];
    if reading.about.is_empty() { name.clone() } else { reading.about.clone() }
}

fn percent(share: f64) -> String {
    format!("{} %", short(100.0 * share))
}

fn statement(part: &str, claim: &super::form::Claim, judged: &Judged) -> Vec<String> {
    let list = |numbers: Vec<String>| {
        if numbers.len() > 8 { format!("{}, ...", numbers[..8].join(", ")) } else { numbers.join(", ") }
    };
    let span = |&(low, high): &(f64, f64)| format!("{} to {}", short(low), short(high));
    let why = match (&judged.verdict, judged.share) {
        (Verdict::CannotBeJudged(why), _) => why.clone(),
        (_, Some(share)) if claim.doubt == DOUBT => format!("true in {} of the drawings", percent(share)),
        (_, Some(share)) => {
            format!("true in {} of the drawings; at most {} may disagree", percent(share), percent(claim.doubt))
        }
        (_, None) if claim.exact => "said of these very trials".to_owned(),
        (_, None) => String::new(),
    };
    let source = if part.is_empty() { claim.source.clone() } else { format!("{} ({part})", claim.source) };
    vec![
        claim.id.clone(),
        claim.text.clone(),
        source,
        claim.strength.word().to_owned(),
        list(judged.number.iter().map(|&x| short(x)).collect()),
        list(judged.interval.iter().filter(|(low, _)| !low.is_nan()).map(span).collect()),
        claim.published.clone(),
        judged.verdict.words().to_owned(),
        why,
    ]
}

/// The sets of cells that a test compares, each with what they have in common.
fn compared(plan: &Plan, part: &Part, test: &Test) -> Vec<(String, Vec<usize>)> {
    let mut only = vec![claims::asked(&test.only)];
    for name in &test.each {
        let Some(at) = factor(part, name) else { continue };
        let level = |level: &super::plan::Level| match level.number {
            Some(number) => Level::Number(number),
            None => Level::Text(level.text.clone()),
        };
        let with = |own: &Vec<(String, Level)>| -> Vec<Vec<(String, Level)>> {
            let each = part.factors[at].levels.iter().map(|l| [own.clone(), vec![(name.clone(), level(l))]].concat());
            each.collect()
        };
        only = only.iter().flat_map(with).collect();
    }
    let named = |only: &[(String, Level)]| {
        only.iter().map(|(name, level)| format!("{name} = {}", level.words())).collect::<Vec<_>>().join(", ")
    };
    only.iter().map(|only| (named(only), claims::matching(plan, part, only))).collect()
}

/// A test as a sentence, and its pairs as rows.
fn tested(
    plan: &Plan,
    results: &Results,
    part: &Part,
    test: &Test,
    only: &str,
    cells: &[usize],
) -> (String, Vec<Vec<String>>) {
    let (Some(reading), Some(between)) =
        (plan.readings.iter().position(|(name, _)| *name == test.y), factor(part, &test.between))
    else {
        return (String::new(), Vec::new());
    };
    let varied: &Varied = &part.factors[between];
    // all cells of a level together
    let mut levels: Vec<(usize, Vec<f64>, BTreeMap<usize, f64>)> = Vec::new();
    let mut left_out = 0;
    for (k, _) in varied.levels.iter().enumerate() {
        let own: Vec<usize> = cells.iter().copied().filter(|&cell| plan.cells[cell].levels[between] == k).collect();
        let whole = own.len();
        let mut trials: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
        for cell in own {
            for (trial, value) in by_trial(plan, results, cell, reading).into_iter().filter(|(_, v)| v.is_finite()) {
                let entry = trials.entry(trial).or_default();
                *entry = (entry.0 + value, entry.1 + 1);
            }
        }
        // a trial that some of the cells lack would be a mean of others
        let (common, partial): (Vec<_>, Vec<_>) = trials.into_iter().partition(|(_, (_, n))| *n == whole);
        left_out += partial.len();
        let means: BTreeMap<usize, f64> = common.into_iter().map(|(trial, (sum, n))| (trial, sum / n as f64)).collect();
        if !means.is_empty() {
            levels.push((k, means.values().copied().collect(), means));
        }
    }
    let place = if only.is_empty() { String::new() } else { format!(" ({only})") };
    let what = format!("{}{place}", about_of(plan, reading));
    let groups: Vec<&[f64]> = levels.iter().map(|(_, values, _)| values.as_slice()).collect();
    let one = match one_way(&groups) {
        Ok(one) => one,
        Err(error) => return (format!("{what}: no analysis of variance is possible: {error}."), Vec::new()),
    };
    let pairs = tukey_kramer(&one.groups, &one.residual, 1.0 - LEVEL).ok();
    let common: Vec<usize> =
        levels[0].2.keys().copied().filter(|trial| levels.iter().all(|(.., own)| own.contains_key(trial))).collect();
    let paired: Vec<Vec<f64>> =
        levels.iter().map(|(.., own)| common.iter().filter_map(|trial| own.get(trial).copied()).collect()).collect();
    let paired: Vec<&[f64]> = paired.iter().map(Vec::as_slice).collect();
    let in_blocks = blocked(&paired).ok();
    let blocked_pairs =
        in_blocks.as_ref().and_then(|blocked| tukey_kramer(&blocked.groups, &blocked.residual, 1.0 - LEVEL).ok());
    let names: Vec<&str> = levels.iter().map(|(k, ..)| varied.levels[*k].text.as_str()).collect();
    let mut text = sentence(&what, &varied.about, &one, pairs.as_ref(), &names);
    if let Some(blocked) = &in_blocks {
        let _ = write!(
            text,
            " With trials as blocks{}, F({}, {}) = {}, {}, partial eta squared = {}.",
            if groups.iter().all(|group| group.len() == common.len()) {
                String::new()
            } else {
                format!(" (the {} that all levels have)", common.len())
            },
            short(blocked.effect.degrees),
            short(blocked.residual.degrees),
            short(blocked.effect.f),
            probability(blocked.effect.p),
            short(blocked.effect.partial_eta_squared(&blocked.residual))
        );
        text += &apart(blocked_pairs.as_ref(), &blocked.residual, &names);
    }
    if left_out > 0 {
        let _ = write!(text, " Left out: {left_out} trials that some of the cells of their level lack.");
    }
    let rows = pairs.iter().flat_map(|pairs| &pairs.pairs).map(|pair| {
        let again = blocked_pairs.as_ref().and_then(|pairs| pairs.pair(pair.first, pair.second));
        let effect = EffectSize::HedgesG.of(&[groups[pair.first], groups[pair.second]]).ok();
        vec![
            test.y.clone(),
            only.to_owned(),
            names[pair.first].to_owned(),
            names[pair.second].to_owned(),
            short(pair.difference),
            short(pair.statistic),
            plain(pair.p),
            again.map_or_else(String::new, |pair| plain(pair.p)),
            effect.map_or_else(String::new, short),
        ]
    });
    (text, rows.collect())
}

fn sentence(what: &str, between: &str, one: &OneWay, pairs: Option<&PairComparison>, names: &[&str]) -> String {
    let mut means = Vec::new();
    for (k, (name, group)) in names.iter().zip(&one.groups).enumerate() {
        let error = group.standard_error.map_or_else(String::new, |error| format!(" \u{b1} {}", short(error)));
        let letters = pairs.map_or("", |pairs| pairs.letters[k].as_str());
        let letters = if letters.is_empty() { String::new() } else { format!(", {letters}") };
        means.push(format!("{name} {}{error} (n = {}{letters})", short(group.mean), group.count));
    }
    let verb = if one.effect.p <= LEVEL { "differs" } else { "does not differ significantly" };
    let mut text = format!(
        "{what} {verb} between the levels of {between}: F({}, {}) = {}, {}, eta squared = {}, omega squared = {} (one-way \
         analysis of variance; mean \u{b1} standard error: {}).",
        short(one.effect.degrees),
        short(one.residual.degrees),
        short(one.effect.f),
        probability(one.effect.p),
        short(one.eta_squared),
        short(one.omega_squared),
        means.join(", ")
    );
    if pairs.is_some() {
        text += " Levels that share a letter do not differ significantly (Tukey-Kramer, p <= 0.05).";
    }
    text += &apart(pairs, &one.residual, names);
    text
}

/// The pairs that do not differ, in words.
fn apart(pairs: Option<&PairComparison>, residual: &Residual, names: &[&str]) -> String {
    let Some(pairs) = pairs else { return String::new() };
    let alike: Vec<String> = pairs
        .pairs
        .iter()
        .filter(|pair| pair.p > LEVEL)
        .map(|pair| {
            let q = short(pair.statistic);
            let (first, second) = (names[pair.first], names[pair.second]);
            format!(
                "{first} and {second} (q({}, {}) = {q}, {})",
                names.len(),
                short(residual.degrees),
                probability(pair.p)
            )
        })
        .collect();
    match (alike.len(), pairs.pairs.len()) {
        (0, _) => " All pairs differ significantly.".to_owned(),
        (some, all) if some == all => " No pair differs significantly.".to_owned(),
        _ => format!(" Not significantly different: {}; all other pairs differ.", alike.join("; ")),
    }
}

/// A probability as papers write it: never as 0 or 1, nor on the other side of the level.
fn plain(p: f64) -> String {
    match p {
        p if p < 0.001 => "< 0.001".to_owned(),
        p if p > 0.999 => "> 0.999".to_owned(),
        p if p > LEVEL && p < LEVEL + 0.0005 => format!("{p:.4}"),
        p => format!("{p:.3}"),
    }
}

fn probability(p: f64) -> String {
    let plain = plain(p);
    if plain.starts_with(['<', '>']) { format!("p {plain}") } else { format!("p = {plain}") }
}

/// The cells of a part with their means and errors, written short; readings that none of them has are left out.
fn cell_rows(plan: &Plan, results: &Results, part: &Part) -> (Vec<String>, Vec<Vec<String>>) {
    let trials = |cell: usize| of_cell(plan, results, cell).map(|(_, values)| values).collect::<Vec<&Vec<f64>>>();
    let there =
        |reading: &usize| part.cells.clone().any(|cell| trials(cell).iter().any(|own| own[*reading].is_finite()));
    let readings: Vec<usize> = (0..plan.readings.len()).filter(there).collect();
    let mut header = vec!["cell".to_owned(), "levels".to_owned(), "trials".to_owned()];
    header.extend(readings.iter().map(|&k| plan.readings[k].0.clone()));
    let row = |cell: usize| {
        let trials = trials(cell);
        let mut row = vec![(cell + 1).to_string(), plan.name_of(&plan.cells[cell]), trials.len().to_string()];
        for &k in &readings {
            let summary = Summary::of(trials.iter().map(|values| values[k]));
            let mean = if summary.mean.is_finite() { short(summary.mean) } else { "none".to_owned() };
            let error =
                if summary.error.is_finite() { format!(" \u{b1} {}", short(summary.error)) } else { String::new() };
            row.push(mean + &error);
        }
        row
    };
    (header, part.cells.clone().map(row).collect())
}

/// Cells with their means and errors, as exact as they are.
fn cells_in_full(plan: &Plan, results: &Results) -> Vec<Vec<String>> {
    let mut header = vec!["cell".to_owned(), "levels".to_owned(), "trials".to_owned()];
    header.extend(plan.readings.iter().flat_map(|(name, _)| [format!("{name}_mean"), format!("{name}_sem")]));
    let exact = |value: f64| if value.is_finite() { value.to_string() } else { String::new() };
    let row = |(index, cell): (usize, &super::plan::Cell)| {
        let trials: Vec<&Vec<f64>> = of_cell(plan, results, index).map(|(_, values)| values).collect();
        let mut row = vec![(index + 1).to_string(), plan.name_of(cell), trials.len().to_string()];
        for k in 0..plan.readings.len() {
            let summary = Summary::of(trials.iter().map(|values| values[k]));
            row.extend([exact(summary.mean), exact(summary.error)]);
        }
        row
    };
    core::iter::once(header).chain(plan.cells.iter().enumerate().map(row)).collect()
}

pub(crate) fn csv(rows: &[Vec<String>]) -> String {
    let cell = |text: &String| {
        if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.clone() }
    };
    rows.iter().map(|row| row.iter().map(cell).collect::<Vec<_>>().join(",") + "\n").collect()
}
