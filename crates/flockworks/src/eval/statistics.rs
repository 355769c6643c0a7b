//! Questions about trials.

use super::{mismatch, positive};
use crate::fault::Fault;
use crate::json::At;
use measure::statistics::{Decision, SequentialTest, StatisticsError, wilson};
use serde_json::{Value as Json, json};

/// The place of an error of the statistics.
fn refused<T>(at: &At<'_>, answer: Result<T, StatisticsError>) -> Result<T, Fault> {
    answer.or_else(|error| at.fault(error))
}

pub(super) fn wilson95(input: &At<'_>) -> Result<Json, Fault> {
    let (successes, trials) = (input.need("s")?.whole()?, positive(&input.need("n")?)?);
    if successes > trials {
        return mismatch(format_args!("{successes} successes in {trials} trials cannot be"));
    }
    let interval = refused(input, wilson(successes, trials, 0.95))?;
    Ok(json!([interval.low, interval.high]))
}

pub(super) fn sprt(input: &At<'_>) -> Result<Json, Fault> {
    let number = |key: &str| input.need(key)?.number();
    let cap = input.need("cap")?;
    let Ok(most) = u32::try_from(positive(&cap)?) else { return cap.fault("expected at most 100000") };
    let test = SequentialTest::new(number("p0")?, number("p1")?, number("alpha")?, number("beta")?, most);
    let test = refused(input, test)?;
    let (mut successes, mut trials) = (0, 0);
    for outcome in input.need("seq")?.list()? {
        successes += match outcome.whole()? {
            won @ (0 | 1) => won as u32,
            other => return outcome.fault(format_args!("expected 0 or 1, found {other}")),
        };
        trials += 1;
        let word = match test.decide(successes, trials) {
            Decision::Accept => "accept",
            Decision::Reject => "reject",
            Decision::Undecided => "undecided",
            Decision::Continue => continue,
        };
        return Ok(json!([word, trials]));
    }
    Ok(json!(["undecided", trials]))
}
