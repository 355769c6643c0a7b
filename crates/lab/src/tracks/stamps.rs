//! Time stamps: `2012-08-05 03:00:01.5`, with a T between date and time, with a zone behind, or the time of day alone.

/// Seconds of a day.
pub(super) const DAY: f64 = 86_400.0;

/// Seconds of a time stamp: since 1970 in UTC, or of a time of day since midnight; none where it is no time stamp.
pub(super) fn seconds(text: &[u8]) -> Option<f64> {
    let text = core::str::from_utf8(text).ok()?.trim();
    let bytes = text.as_bytes();
    let dated = bytes.len() >= 10 && matches!(bytes[4], b'-' | b'/') && bytes[7] == bytes[4];
    if !dated {
        return of_day(text);
    }
    let number = |from: usize, to: usize| text.get(from..to)?.parse::<i64>().ok();
    let (year, month, day) = (number(0, 4)?, number(5, 7)?, number(8, 10)?);
    if !(1..=12).contains(&month) || day < 1 {
        return None;
    }
    let (next_year, next_month) = if month == 12 { (year + 1, 1) } else { (year, month + 1) };
    let first = days(year, month, 1);
    if first + day > days(next_year, next_month, 1) {
        return None;
    }
    let date = (first + day - 1) as f64 * DAY;
    let rest = text.get(10..)?;
    if rest.is_empty() {
        return Some(date);
    }
    let rest = rest.strip_prefix(['T', ' ', 't'])?;
    let (clock, zone) = zoned(rest)?;
    Some(date + of_day(clock)? - zone)
}

/// A time without its zone, and the zone's seconds before UTC.
fn zoned(text: &str) -> Option<(&str, f64)> {
    let text = text.trim_end_matches("UTC").trim_end();
    if let Some(clock) = text.strip_suffix(['Z', 'z']) {
        return Some((clock, 0.0));
    }
    let Some(at) = text.rfind(['+', '-']) else { return Some((text, 0.0)) };
    let (clock, zone) = text.split_at(at);
    let digits: String = zone[1..].chars().filter(|&c| c != ':').collect();
    let hours = digits.get(0..2)?.parse::<f64>().ok()?;
    let minutes = digits.get(2..4).map_or(Some(0.0), |m| m.parse().ok())?;
    let sign = if zone.starts_with('-') { -1.0 } else { 1.0 };
    Some((clock.trim_end(), sign * (hours * 3600.0 + minutes * 60.0)))
}

/// Seconds since midnight of `HH:MM` or `HH:MM:SS.s`.
fn of_day(text: &str) -> Option<f64> {
    let mut parts = text.split(':');
    let whole = |part: Option<&str>| part?.parse::<u32>().ok().map(f64::from);
    let (hours, minutes) = (whole(parts.next())?, whole(parts.next())?);
    let seconds = match parts.next() {
        Some(part) if part.starts_with(|c: char| c.is_ascii_digit()) => part.parse::<f64>().ok()?,
        Some(_) => return None,
        None => 0.0,
    };
    let fits = hours < 25.0 && minutes < 60.0 && seconds < 61.0 && parts.next().is_none();
    fits.then_some(hours * 3600.0 + minutes * 60.0 + seconds)
}

/// Days since 1970-01-01 of a date of the Gregorian calendar (H. Hinnant's `days_from_civil`).
fn days(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let era = year.div_euclid(400);
    let of_era = year - era * 400;
    let of_year = (153 * (month + if month > 2 { -3 } else { 9 }) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468
}

/// A moment in UTC, or a time of day, as it is written, to the second.
pub(super) fn written(seconds: f64) -> String {
    let whole = seconds.floor() as i64;
    if (0.0..2.0 * DAY).contains(&seconds) {
        return format!("{:02}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    }
    let (day, clock) = (whole.div_euclid(86_400) + 719_468, whole.rem_euclid(86_400));
    let era = day.div_euclid(146_097);
    let of_era = day - era * 146_097;
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let shifted = (5 * of_year + 2) / 153;
    let day = of_year - (153 * shifted + 2) / 5 + 1;
    let month = if shifted < 10 { shifted + 3 } else { shifted - 9 };
    let year = year + era * 400 + i64::from(month <= 2);
    format!("{year:04}-{month:02}-{day:02} {:02}:{:02}:{:02}", clock / 3600, clock / 60 % 60, clock % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_are_read_and_written() {
        for (text, expected) in [
            ("1970-01-01 00:00:01", Some(1.0)),
            ("2012-08-05 03:00:43", Some(1_344_135_643.0)),
            ("2012-08-05T03:00:43.5Z", Some(1_344_135_643.5)),
            ("2012/08/05 06:00:43+03:00", Some(1_344_135_643.0)),
            ("2012-08-05 03:00:43.500 UTC", Some(1_344_135_643.5)),
            ("2000-02-29", Some(951_782_400.0)),
            ("01:00:01.25", Some(3601.25)),
            ("00:30", Some(1800.0)),
            ("12.5", None),
            ("2012-13-05", None),
            ("2012-02-30", None),
            ("2013-02-29 03:00", None),
            ("2012-02-29", Some(1_330_473_600.0)),
            ("2012-12-31", Some(1_356_912_000.0)),
            ("2012-12-32", None),
            ("05/08/2012 03:00", None),
            ("yesterday", None),
            ("", None),
        ] {
            assert_eq!(seconds(text.as_bytes()), expected, "{text}");
        }
        for stamp in [0.0, 951_782_400.0, 1_344_135_643.0, -86_401.0, 4_102_444_800.0] {
            assert_eq!(seconds(written(stamp).as_bytes()), Some(stamp));
        }
    }
}
