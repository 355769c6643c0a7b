//! What came of the question which group it is: tables, figures, lines.

use super::{Found, Streams, Sum, Way, counts};
use crate::design::plan::Plan;
use crate::design::results::Results;
use crate::design::tables::words;
use crate::environment::claims;
use crate::report::{Axis, Figure, Line, Lines, Listing, Means, short};
use crate::store::StoreError;
use crate::store::folder::Folder;
use crate::store::table::{Heading, Kind, Values, write_table};
use measure::statistics::{mean, variance, wilson};
use search::identify::{Course, Estimate, entropy, most_telling};

/// A row for each environment, group and outcome.
pub const OUTCOMES: &str = "outcomes.parquet";
/// A row for each environment.
pub const INFORMATION: &str = "information.parquet";
/// A row for each identification.
pub const IDENTIFICATIONS: &str = "identifications.parquet";
/// A row for each trial of an identification.
pub const COURSES: &str = "courses.parquet";

/// Environments in a figure, at most: those that tell most.
const SHOWN: usize = 12;
/// Trials whose gain together is shown, at most.
const TOGETHER: usize = 20;
/// Rows of the greedy sequence, at most.
const SEQUENCE: usize = 24;
/// Answers less probable than this are no part of it.
const SELDOM: f64 = 0.02;

/// Half the 95 % interval of a mean over identifications, drawn by their numbers; none of fewer than two.
fn half(numbers: &[f64]) -> Option<f64> {
    variance(numbers)
        .ok()
        .map(|variance| 1.96 * (variance / numbers.len() as f64).sqrt())
        .filter(|half| half.is_finite())
}

/// Mean number of trials in each identification, over groups and environments.
fn needed(found: &Found<'_>, of: &dyn Fn(&[usize]) -> f64) -> Vec<f64> {
    (0..found.each()).map(|number| of(&[number])).collect()
}

fn of_way(found: &Found<'_>, way: Way) -> (Sum, Option<f64>) {
    let numbers = needed(found, &|drawn| Sum::of(&found.courses(way, None, Some(drawn))).needed);
    (Sum::of(&found.courses(way, None, None)), half(&numbers))
}

fn of_place(found: &Found<'_>, place: usize) -> (Sum, Option<f64>) {
    let numbers = needed(found, &|drawn| Sum::of(&found.alone(place, Some(drawn))).needed);
    (Sum::of(&found.alone(place, None)), half(&numbers))
}

/// A number with its half interval.
fn about(number: f64, half: Option<f64>) -> String {
    match half {
        Some(half) => format!("{} ({} to {})", short(number), short(number - half), short(number + half)),
        None => short(number),
    }
}

fn percent(share: f64) -> String {
    if share.is_finite() { format!("{:.1} %", share * 100.0) } else { "\u{2013}".to_owned() }
}

fn bits(estimate: Option<Estimate>) -> String {
    match estimate {
        Some(one) => format!("{:.3} ({:.3} to {:.3})", one.gain, one.low, one.high),
        None => "\u{2013}".to_owned(),
    }
}

/// What came of it, in lines for a terminal.
pub fn lines(results: &Results<'_>, streams: &Streams) -> Vec<String> {
    let Some(found) = Found::of(results, streams) else { return Vec::new() };
    let Some(chosen) = found.telling.attempts.get(found.telling.chosen) else { return Vec::new() };
    let gain = found.estimates(results)[found.telling.chosen];
    let mut lines = vec![format!("a trial in environment {chosen} tells most: {} bits", bits(gain))];
    for (way, word, _) in Way::ALL {
        let (sum, half) = of_way(&found, way);
        lines.push(format!(
            "{word}: {} trials, {} named, {} of them rightly",
            about(sum.needed, half),
            percent(sum.identified),
            percent(sum.right)
        ));
    }
    lines.extend(judged(&found).iter().map(|row| claims::line(row)));
    lines
}

fn judged(found: &Found<'_>) -> Vec<Vec<String>> {
    let plan = found.plan;
    plan.form.inverse.as_ref().map_or_else(Vec::new, |form| claims::rows(&form.claim, found, plan.form.seed))
}

/// What was done, in words.
pub fn methods(plan: &Plan) -> Vec<String> {
    let Some(asked) = &plan.inverse else { return Vec::new() };
    let prior: Vec<String> = plan
        .populations
        .iter()
        .zip(&asked.prior)
        .map(|(one, prior)| format!("{} {}", one.name, short(*prior)))
        .collect();
    vec![
        format!(
            "Which group is it: the outcome of a trial is one of {} ({}). The expected gain of a trial is the mutual information \
             of group and outcome with the prior {}; estimates are freed of their bias of the order of 1 / trials by the \
             jackknife, and their 95 % intervals are by drawing the trials again 400 times, the same for all groups.",
            asked.outcomes(),
            (0..asked.outcomes()).map(|outcome| asked.words(plan, outcome)).collect::<Vec<_>>().join("; "),
            prior.join(", ")
        ),
        format!(
            "{} unknown groups of each kind are put into the environments, with seeds of their own, until one group is believed in \
             with {} or after {} trials. Beliefs follow Bayes' rule from the shares of the table, with half a trial added to each \
             outcome. All ways to choose environments see the same trials, and the same seeds serve every true group.",
            asked.identifications, asked.ending.threshold, asked.ending.most
        ),
    ]
}

/// The figures; none where it was not asked, or something is missing.
pub fn figures(results: &Results<'_>, streams: &Streams) -> Vec<Figure> {
    let Some(found) = Found::of(results, streams).filter(|found| !found.telling.attempts.is_empty()) else {
        return Vec::new();
    };
    let estimates = found.estimates(results);
    let mut figures = vec![Figure::Listing(ways(&found))];
    let rows = judged(&found);
    if !rows.is_empty() {
        figures.push(Figure::Listing(Listing {
            title: "What was expected of identifications".into(),
            about: "Intervals and verdicts are by drawing the identifications again 400 times, with replacement."
                .into(),
            header: claims::header(),
            rows,
        }));
    }
    // those that tell most, in the order of their numbers
    let mut shown: Vec<usize> = (0..found.telling.attempts.len()).collect();
    let gain = |place: usize| found.telling.questions[place].gain(&found.asked.prior);
    shown.sort_by(|a, b| gain(*b).total_cmp(&gain(*a)).then(a.cmp(b)));
    shown.truncate(SHOWN);
    shown.sort_unstable();
    figures.push(Figure::Listing(told(&found, &estimates)));
    figures.push(Figure::Means(gains(&found, &estimates, &shown)));
    figures.extend(distributions(results, &found, &shown).into_iter().map(Figure::Means));
    figures.push(Figure::Lines(together(&found, &shown)));
    figures.push(Figure::Means(trials_needed(&found, &shown)));
    figures.push(Figure::Lines(over_trials(
        &found,
        ("beliefs", "What is believed of the true group", "mean probability of the true group"),
        "Mean over all unknown groups; a group that was named stays as it was then.",
        &|truth, course, trials| {
            let at = course.trials.len().min(trials);
            at.checked_sub(1).map_or(found.asked.prior[truth], |last| course.trials[last].belief[truth])
        },
    )));
    figures.push(Figure::Lines(over_trials(
        &found,
        ("named", "Named within so many trials", "share of unknown groups"),
        "Share of unknown groups that were named, rightly or not.",
        &|_, course, trials| f64::from(u8::from(course.named.is_some() && course.trials.len() <= trials)),
    )));
    figures.push(Figure::Listing(sequence(&found)));
    figures
}

fn ways(found: &Found<'_>) -> Listing {
    let row = |(way, word, about_it): (Way, &str, &str)| {
        let (sum, half) = of_way(found, way);
        let groups =
            (0..found.plan.populations.len()).map(|group| Sum::of(&found.courses(way, Some(group), None)).needed);
        let mut row = vec![word.to_owned(), about_it.to_owned(), about(sum.needed, half)];
        row.extend(groups.map(short));
        row.extend([percent(sum.identified), percent(sum.right)]);
        row
    };
    let mut header: Vec<String> = ["by", "environment", "trials needed (95 %)"].map(str::to_owned).to_vec();
    header.extend(found.plan.populations.iter().map(|group| format!("of {}", group.name)));
    header.extend(["named", "of these rightly"].map(str::to_owned));
    Listing {
        title: "Which group is it".into(),
        about: format!(
            "Trials until one group is believed in with {}, mean over {} unknown groups of each kind; those that were not named \
             count with {} trials, so that such means are too small.",
            found.asked.ending.threshold, found.asked.identifications, found.asked.ending.most
        ),
        header,
        rows: Way::ALL.map(row).to_vec(),
    }
}

fn told(found: &Found<'_>, estimates: &[Option<Estimate>]) -> Listing {
    let row = |(place, attempt): (usize, &u64)| {
        let (sum, half) = of_place(found, place);
        let mark = if place == found.telling.chosen { "chosen" } else { "" };
        vec![
            attempt.to_string(),
            bits(estimates[place]),
            about(sum.needed, half),
            percent(sum.identified),
            percent(sum.right),
            mark.to_owned(),
        ]
    };
    Listing {
        title: "What environments tell".into(),
        about: format!(
            "Expected gain of one trial in bits, of {:.3} that are to be known; trials needed in this environment alone.",
            entropy(&found.asked.prior)
        ),
        header: ["environment", "gain (95 %)", "trials needed (95 %)", "named", "of these rightly", ""]
            .map(str::to_owned)
            .to_vec(),
        rows: found.telling.attempts.iter().enumerate().map(row).collect(),
    }
}

fn names(found: &Found<'_>, shown: &[usize]) -> Vec<String> {
    shown.iter().map(|place| found.telling.attempts[*place].to_string()).collect()
}

fn places(count: usize) -> Vec<f64> {
    (0..count).map(|place| place as f64).collect()
}

fn axis(label: &str, unit: &str, range: Option<(f64, f64)>) -> Axis {
    Axis { label: label.into(), unit: unit.into(), range }
}

/// What is left out of figures.
fn left_out(found: &Found<'_>, shown: &[usize]) -> String {
    match found.telling.attempts.len() - shown.len() {
        0 => String::new(),
        _ => format!(" Shown are the {} environments that tell most.", shown.len()),
    }
}

fn gains(found: &Found<'_>, estimates: &[Option<Estimate>], shown: &[usize]) -> Means {
    let y = shown.iter().map(|place| estimates[*place].map(|one| one.gain)).collect();
    let spread = shown.iter().map(|place| estimates[*place].map(|one| (one.high - one.low) / 2.0)).collect();
    Means {
        lines: Lines {
            id: "information".into(),
            title: "What one trial tells".into(),
            about: format!("Expected information gain of a trial.{}", left_out(found, shown)),
            x: axis("environment", "", None),
            y: axis("expected gain", "bits", None),
            lines: vec![Line { name: "one trial".into(), x: places(shown.len()), y }],
        },
        spread: vec![spread],
        spread_name: "half the 95 % interval".into(),
        names: names(found, shown),
    }
}

/// A figure for each outcome that was seen.
fn distributions(results: &Results<'_>, found: &Found<'_>, shown: &[usize]) -> Vec<Means> {
    let plan = found.plan;
    let all: Vec<Vec<Vec<u64>>> =
        shown.iter().map(|place| counts(results, found.asked, found.telling.attempts[*place])).collect();
    let figure = |outcome: usize| {
        let of = |group: usize| -> (Vec<Option<f64>>, Vec<Option<f64>>) {
            let share = |counts: &Vec<Vec<u64>>| {
                let (count, all) = (counts[group][outcome], counts[group].iter().sum::<u64>());
                let half = wilson(count, all, 0.95).ok().map(|interval| (interval.high - interval.low) / 2.0);
                (half.map(|_| count as f64 / all as f64), half)
            };
            all.iter().map(share).unzip()
        };
        let (shares, spread): (Vec<_>, Vec<_>) = (0..plan.populations.len()).map(of).unzip();
        let line = |(group, y): (&crate::environment::trial::Population, Vec<Option<f64>>)| Line {
            name: group.name.clone(),
            x: places(shown.len()),
            y,
        };
        let words = found.asked.words(plan, outcome);
        Means {
            lines: Lines {
                id: format!("outcome-{outcome}"),
                title: format!("How often: {words}"),
                about: format!("Share of the trials of each group.{}", left_out(found, shown)),
                x: axis("environment", "", None),
                y: axis("share of trials", "", Some((0.0, 1.0))),
                lines: plan.populations.iter().zip(shares).map(line).collect(),
            },
            spread,
            spread_name: "half the 95 % Wilson interval".into(),
            names: names(found, shown),
        }
    };
    let seen = |outcome: &usize| all.iter().flatten().any(|counts| counts[*outcome] > 0);
    (0..found.asked.outcomes()).filter(seen).map(figure).collect()
}

/// What several trials in one environment tell together.
fn together(found: &Found<'_>, shown: &[usize]) -> Lines {
    let most = found.asked.ending.most.min(TOGETHER);
    let line = |place: &usize| Line {
        name: format!("environment {}", found.telling.attempts[*place]),
        x: places(most + 1),
        y: (0..=most).map(|trials| found.telling.questions[*place].gain_of(&found.asked.prior, trials)).collect(),
    };
    Lines {
        id: "together".into(),
        title: "What several trials tell together".into(),
        about: format!(
            "Expected gain of so many trials in one environment, from the distributions with half a trial added to each outcome; {} \
             bits would be all.{}",
            short(entropy(&found.asked.prior)),
            left_out(found, shown)
        ),
        x: axis("trials", "", None),
        y: axis("expected gain", "bits", None),
        lines: shown.iter().map(line).collect(),
    }
}

fn trials_needed(found: &Found<'_>, shown: &[usize]) -> Means {
    let mut names: Vec<String> = Way::ALL.iter().map(|(_, word, _)| (*word).to_owned()).collect();
    names.extend(shown.iter().map(|place| format!("only {}", found.telling.attempts[*place])));
    let ways = Way::ALL.iter().map(|(way, ..)| of_way(found, *way));
    let all: Vec<(Sum, Option<f64>)> = ways.chain(shown.iter().map(|place| of_place(found, *place))).collect();
    Means {
        lines: Lines {
            id: "needed".into(),
            title: "Trials needed".into(),
            about: "Mean number of trials until a group is named, by the way environments are chosen, and in each \
                    environment alone."
                .into(),
            x: axis("environments", "", None),
            y: axis("trials", "", None),
            lines: vec![Line {
                name: "trials".into(),
                x: places(names.len()),
                y: all.iter().map(|(sum, _)| Some(sum.needed)).collect(),
            }],
        },
        spread: vec![all.iter().map(|(_, half)| *half).collect()],
        spread_name: "half the 95 % interval".into(),
        names,
    }
}

/// A mean over identifications by the number of trials, for each way.
fn over_trials(
    found: &Found<'_>,
    (id, title, label): (&str, &str, &str),
    about: &str,
    of: &dyn Fn(usize, &Course, usize) -> f64,
) -> Lines {
    let line = |(way, word, _): &(Way, &str, &str)| {
        let courses = found.courses(*way, None, None);
        let at = |trials: usize| {
            let numbers: Vec<f64> = courses.iter().map(|(truth, course)| of(*truth, course, trials)).collect();
            mean(&numbers).ok()
        };
        let y: Vec<Option<f64>> = (0..=found.asked.ending.most).map(at).collect();
        Line { name: (*word).to_owned(), x: places(y.len()), y }
    };
    Lines {
        id: id.into(),
        title: title.into(),
        about: about.into(),
        x: axis("trials", "", None),
        y: axis(label, "", Some((0.0, 1.0))),
        lines: Way::ALL.iter().map(line).collect(),
    }
}

/// The greedy sequence: which environment comes first, and which after what was seen.
fn sequence(found: &Found<'_>) -> Listing {
    let (plan, questions) = (found.plan, &found.telling.questions);
    let mut rows = Vec::new();
    // what was seen, how probable that is, what is believed then
    let mut after = vec![("nothing".to_owned(), 1.0, found.asked.prior.clone())];
    for _ in 0..3 {
        let mut next = Vec::new();
        for (seen, chance, belief) in after {
            let place = most_telling(questions, &belief);
            let question = &questions[place];
            let named = belief.iter().position(|own| *own >= found.asked.ending.threshold);
            let beliefs = belief.iter().map(|own| percent(*own));
            let (choice, gain) = match named {
                Some(group) => (format!("none: it is {}", plan.populations[group].name), String::new()),
                None => (found.telling.attempts[place].to_string(), short(question.gain(&belief))),
            };
            rows.push([vec![seen.clone(), percent(chance)], beliefs.collect(), vec![choice, gain]].concat());
            for outcome in (0..question.answers()).filter(|_| named.is_none()) {
                let chance = chance * question.probability(&belief, outcome);
                if chance >= SELDOM {
                    let before = if seen == "nothing" { String::new() } else { format!("{seen}; then ") };
                    let words = found.asked.words(plan, outcome);
                    let words = format!("{before}{words} in {}", found.telling.attempts[place]);
                    next.push((words, chance, question.after(&belief, outcome)));
                }
            }
        }
        after = next;
    }
    rows.truncate(SEQUENCE);
    let mut header: Vec<String> = ["what was seen", "how often"].map(str::to_owned).to_vec();
    header.extend(plan.populations.iter().map(|group| group.name.clone()));
    header.extend(["next environment", "gain (bits)"].map(str::to_owned));
    Listing {
        title: "The greedy sequence".into(),
        about: format!(
            "What is believed of each group after what was seen, and where the next trial is expected to tell most. What comes in \
             fewer than {} of identifications is left out.",
            percent(SELDOM)
        ),
        header,
        rows,
    }
}

/// Writes the tables, where it was asked.
///
/// # Errors
/// Where the system refuses.
pub fn write(folder: &Folder, results: &Results<'_>, streams: &Streams) -> Result<(), StoreError> {
    let Some(found) = Found::of(results, streams) else { return Ok(()) };
    outcomes(folder, results, &found)?;
    information(folder, results, &found)?;
    identifications(folder, &found)?;
    courses(folder, &found)
}

fn long(numbers: impl Iterator<Item = u64>) -> Values {
    Values::Long(numbers.map(|number| number as i64).collect())
}

fn outcomes(folder: &Folder, results: &Results<'_>, found: &Found<'_>) -> Result<(), StoreError> {
    let (plan, mut rows) = (found.plan, Vec::new());
    for attempt in &found.telling.attempts {
        for (group, counts) in counts(results, found.asked, *attempt).into_iter().enumerate() {
            let all: u64 = counts.iter().sum();
            rows.extend(counts.into_iter().enumerate().map(|(outcome, count)| (*attempt, group, outcome, count, all)));
        }
    }
    let bound = |count: u64, all: u64, high: bool| {
        let found = wilson(count, all, 0.95);
        found.map_or(f64::NAN, |interval| if high { interval.high } else { interval.low })
    };
    let headings = [
        Heading::new("candidate", "1", "Number of the attempt that made it, from 0.", Kind::Long),
        Heading::new("population", "", "The group.", Kind::Word),
        Heading::new("outcome", "", "The outcome of a trial.", Kind::Word),
        Heading::new("count", "1", "Trials with this outcome.", Kind::Long),
        Heading::new("trials", "1", "Trials that were possible.", Kind::Long),
        Heading::new("share", "1", "Share of the trials with this outcome.", Kind::Double),
        Heading::new("share_low", "1", "Lower end of its 95 % Wilson interval.", Kind::Double),
        Heading::new("share_high", "1", "Upper end of its 95 % Wilson interval.", Kind::Double),
    ];
    let columns = [
        long(rows.iter().map(|row| row.0)),
        words(rows.iter().map(|row| plan.populations[row.1].name.clone())),
        words(rows.iter().map(|row| found.asked.words(plan, row.2))),
        long(rows.iter().map(|row| row.3)),
        long(rows.iter().map(|row| row.4)),
        Values::Double(rows.iter().map(|row| row.3 as f64 / row.4 as f64).collect()),
        Values::Double(rows.iter().map(|row| bound(row.3, row.4, false)).collect()),
        Values::Double(rows.iter().map(|row| bound(row.3, row.4, true)).collect()),
    ];
    write_table(folder, OUTCOMES, &headings, &columns, &[])
}

fn information(folder: &Folder, results: &Results<'_>, found: &Found<'_>) -> Result<(), StoreError> {
    let estimates = found.estimates(results);
    let sums: Vec<Sum> = (0..estimates.len()).map(|place| Sum::of(&found.alone(place, None))).collect();
    let of = |of: fn(Estimate) -> f64| Values::Double(estimates.iter().map(|one| one.map_or(f64::NAN, of)).collect());
    let headings = [
        Heading::new("candidate", "1", "Number of the attempt that made it, from 0.", Kind::Long),
        Heading::new("gain", "bit", "Expected information gain of one trial.", Kind::Double),
        Heading::new("gain_low", "bit", "Lower end of its 95 % interval.", Kind::Double),
        Heading::new("gain_high", "bit", "Upper end of its 95 % interval.", Kind::Double),
        Heading::new("chosen", "1", "1 for the environment that tells most.", Kind::Long),
        Heading::new("needed", "1", "Mean number of trials until a group is named, in it alone.", Kind::Double),
        Heading::new("identified", "1", "Share of unknown groups that are named.", Kind::Double),
        Heading::new("right", "1", "Share of those named that are what they are named.", Kind::Double),
    ];
    let columns = [
        long(found.telling.attempts.iter().copied()),
        of(|one| one.gain),
        of(|one| one.low),
        of(|one| one.high),
        long((0..estimates.len()).map(|place| u64::from(place == found.telling.chosen))),
        Values::Double(sums.iter().map(|sum| sum.needed).collect()),
        Values::Double(sums.iter().map(|sum| sum.identified).collect()),
        Values::Double(sums.iter().map(|sum| sum.right).collect()),
    ];
    write_table(folder, INFORMATION, &headings, &columns, &[])
}

/// Every course: true group, number, how environments were chosen (one alone by its attempt), and the course.
fn each<'a>(found: &'a Found<'_>) -> Vec<(usize, usize, String, &'a Course)> {
    let mut all = Vec::new();
    for (truth, own) in found.courses.iter().enumerate() {
        for (number, one) in own.iter().enumerate() {
            let alone = found.telling.attempts.iter().zip(&one.alone);
            let alone = alone.map(|(attempt, course)| (format!("only {attempt}"), course));
            let by = [("greedy".to_owned(), &one.greedy), ("drawn".to_owned(), &one.drawn)];
            all.extend(by.into_iter().chain(alone).map(|(by, course)| (truth, number + 1, by, course)));
        }
    }
    all
}

fn of_course() -> Vec<Heading> {
    vec![
        Heading::new("population", "", "What the group is in truth.", Kind::Word),
        Heading::new("number", "1", "Number of the unknown group, from 1.", Kind::Long),
        Heading::new("by", "", "How environments are chosen; `only N` is N alone.", Kind::Word),
    ]
}

fn identifications(folder: &Folder, found: &Found<'_>) -> Result<(), StoreError> {
    let (all, groups) = (each(found), &found.plan.populations);
    let mut headings = of_course();
    headings.extend([
        Heading::new("trials", "1", "Trials made.", Kind::Long),
        Heading::new("named", "", "What it is named; empty where it is not.", Kind::Word),
        Heading::new("right", "1", "1 where that is what it is.", Kind::Long),
    ]);
    let columns = [
        words(all.iter().map(|one| groups[one.0].name.clone())),
        long(all.iter().map(|one| one.1 as u64)),
        words(all.iter().map(|one| one.2.clone())),
        long(all.iter().map(|one| one.3.trials.len() as u64)),
        words(all.iter().map(|one| one.3.named.map_or_else(String::new, |group| groups[group].name.clone()))),
        long(all.iter().map(|one| u64::from(one.3.named == Some(one.0)))),
    ];
    write_table(folder, IDENTIFICATIONS, &headings, &columns, &[])
}

fn courses(folder: &Folder, found: &Found<'_>) -> Result<(), StoreError> {
    let (plan, groups) = (found.plan, &found.plan.populations);
    let all = each(found);
    let rows: Vec<_> =
        all.iter().flat_map(|one| one.3.trials.iter().enumerate().map(move |(k, asked)| (one, k, asked))).collect();
    let mut headings = of_course();
    headings.extend([
        Heading::new("trial", "1", "Number of the trial, from 1.", Kind::Long),
        Heading::new("candidate", "1", "The environment.", Kind::Long),
        Heading::new("outcome", "", "Its outcome; empty where it was impossible.", Kind::Word),
    ]);
    let mut columns = vec![
        words(rows.iter().map(|(one, ..)| groups[one.0].name.clone())),
        long(rows.iter().map(|(one, ..)| one.1 as u64)),
        words(rows.iter().map(|(one, ..)| one.2.clone())),
        long(rows.iter().map(|(_, k, _)| *k as u64 + 1)),
        long(rows.iter().map(|(.., asked)| found.telling.attempts[asked.question])),
        words(rows.iter().map(|(.., asked)| asked.answer.map_or_else(String::new, |one| found.asked.words(plan, one)))),
    ];
    for (k, group) in groups.iter().enumerate() {
        let about = format!("How probable `{}` is afterwards.", group.name);
        headings.push(Heading::new(&format!("belief_{}", group.name), "1", &about, Kind::Double));
        columns.push(Values::Double(rows.iter().map(|(.., asked)| asked.belief[k]).collect()));
    }
    write_table(folder, COURSES, &headings, &columns, &[])
}
