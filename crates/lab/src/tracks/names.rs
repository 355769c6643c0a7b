//! Names of columns that tables of tracks are known to have, and units that names and comments carry.

use super::text::Head;
use super::{Ask, meant, wrong};
use crate::store::StoreError;

/// What a column can be, by the word that `--columns` knows it by, with the names it is known to have elsewhere.
pub const ROLES: &[(&str, &[&str])] = &[
    (
        "frame",
        &["frame", "frame_idx", "frame_index", "frame_number", "framenumber", "frame_no", "fnum", "imagenumber", "fr"],
    ),
    ("time", &["utc", "timestamp", "datetime", "date_time", "t", "time", "seconds", "sec"]),
    (
        "id",
        &[
            "id",
            "individual",
            "individual_id",
            "individual_local_identifier",
            "identity",
            "animal",
            "animal_id",
            "track",
            "track_id",
            "trackid",
            "tracked_id",
            "fish",
            "fish_id",
            "agent",
            "agent_id",
            "person",
            "persid",
            "pers_id",
            "person_id",
            "ped",
            "ped_id",
            "pedestrian",
            "pedestrian_id",
            "particle",
            "target",
            "name",
            "ind",
        ],
    ),
    (
        "x",
        &["x", "pos_x", "posx", "x_pos", "xpos", "x_position", "position_x", "centroid_x", "x_centroid", "xbody", "cx"],
    ),
    (
        "y",
        &["y", "pos_y", "posy", "y_pos", "ypos", "y_position", "position_y", "centroid_y", "y_centroid", "ybody", "cy"],
    ),
    ("z", &["z", "pos_z", "posz", "z_pos", "zpos", "z_position", "position_z", "centroid_z", "z_centroid", "cz"]),
    ("longitude", &["longitude", "lon", "long", "lng", "location_long", "location_lon"]),
    ("latitude", &["latitude", "lat", "location_lat"]),
    ("vx", &["vx"]),
    ("vy", &["vy"]),
    ("vz", &["vz"]),
];

/// Words of `--columns` that do not name a column.
pub const CHOICES: [(&str, &str); 3] = [
    ("clock", "the unit of times that are numbers: h, min, s, ms, us or ns"),
    ("point", "the body part that stands for an individual, or mean"),
    ("wide", "xy or xyz: how many numbers each individual has in a wide table without names"),
];

/// A name in small letters, without its unit, words parted by `_`: `X#wcentroid (cm)` becomes `x_wcentroid`.
pub fn plain(name: &str) -> String {
    let name = split_unit(name).0;
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_alphanumeric() {
            out.extend(letter.to_lowercase());
        } else if !out.ends_with('_') && !out.is_empty() {
            out.push('_');
        }
    }
    out.truncate(out.trim_end_matches('_').len());
    out
}

/// A name and the unit it carries: `x/m`, `X (cm)`, `x [px]`, `x_mm`. `x_m` may also be the x of somebody called m.
pub fn split_unit(name: &str) -> (&str, Option<&str>) {
    let name = name.trim();
    for (open, close) in [('(', ')'), ('[', ']')] {
        if let Some(inside) = name.strip_suffix(close)
            && let Some((before, unit)) = inside.rsplit_once(open)
        {
            return (before.trim_end(), Some(unit.trim()));
        }
    }
    match name.rsplit_once('/') {
        Some((before, unit)) if length_unit(unit).is_some() => return (before, Some(unit)),
        _ => {}
    }
    match name.rsplit_once('_') {
        Some((before, unit)) if before.len() == 1 && unit.len() > 1 && length_unit(unit).is_some() => {
            (before, Some(unit))
        }
        _ => (name, None),
    }
}

/// Units of length as files write them, and as they are written here.
const LENGTHS: [(&str, &str); 14] = [
    ("m", "m"),
    ("meter", "m"),
    ("meters", "m"),
    ("metre", "m"),
    ("metres", "m"),
    ("cm", "cm"),
    ("centimeter", "cm"),
    ("centimetre", "cm"),
    ("mm", "mm"),
    ("km", "km"),
    ("px", "px"),
    ("pixel", "px"),
    ("pixels", "px"),
    ("bl", "BL"),
];

/// A unit of length as it is written here; none where it is not known.
pub fn length_unit(text: &str) -> Option<&'static str> {
    let text = text.trim().trim_start_matches("in ").trim();
    LENGTHS.iter().find(|(known, _)| known.eq_ignore_ascii_case(text)).map(|&(_, unit)| unit)
}

/// Units of time by their seconds, as `--columns clock=UNIT` and names of columns say them.
const TIMES: [(&str, f64); 16] = [
    ("s", 1.0),
    ("sec", 1.0),
    ("second", 1.0),
    ("seconds", 1.0),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("millisecond", 1e-3),
    ("milliseconds", 1e-3),
    ("us", 1e-6),
    ("microseconds", 1e-6),
    ("ns", 1e-9),
    ("min", 60.0),
    ("minute", 60.0),
    ("minutes", 60.0),
    ("h", 3600.0),
    ("hours", 3600.0),
];

/// Seconds in a unit of time; none where it is not known.
pub fn time_unit(text: &str) -> Option<f64> {
    TIMES.iter().find(|(known, _)| known.eq_ignore_ascii_case(text.trim())).map(|&(_, seconds)| seconds)
}

/// Seconds in the unit of a column of times: what was asked for, or what its name carries, as `time (ms)` and `time_ms`.
///
/// # Errors
/// A unit that is not known.
pub fn time_unit_of(head: &Head, ask: &Ask, name: &str) -> Result<Option<f64>, StoreError> {
    if let Some(unit) = ask.column("clock") {
        return time_unit(unit).map(Some).ok_or_else(|| {
            wrong(&head.path, &format!("--columns clock={unit} is no unit of time; there are h, min, s, ms, us and ns"))
        });
    }
    let behind = name.trim().rsplit_once('_').map(|(_, unit)| unit);
    Ok(split_unit(name).1.or(behind).and_then(time_unit))
}

/// The unit that the names of coordinates carry.
///
/// # Errors
/// Where they carry different ones.
pub fn unit_of_columns<'a>(head: &Head, names: impl Iterator<Item = &'a str>) -> Result<Option<String>, StoreError> {
    let mut found: Option<(&str, &str)> = None;
    for name in names {
        let Some(unit) = split_unit(name).1.and_then(length_unit) else { continue };
        match found {
            Some((other, before)) if before != unit => {
                return Err(wrong(
                    &head.path,
                    &format!("mixed units: `{other}` is in {before} and `{name}` in {unit}; convert one of them"),
                ));
            }
            _ => found = Some((name, unit)),
        }
    }
    Ok(found.map(|(_, unit)| unit.to_owned()))
}

/// The frame rate and the unit of length that comments state, as in `framerate: 25 fps` and `x [in m]`.
pub fn comments(head: &Head) -> (Option<f64>, Option<&'static str>) {
    let (mut fps, mut unit) = (None, None);
    for comment in &head.comments {
        let lower = comment.to_lowercase();
        let rate =
            ["framerate", "frame rate", "fps"].iter().find_map(|word| lower.split_once(word).map(|(_, rest)| rest));
        if let (Some(rest), None) = (rate, fps) {
            let digits = rest.trim_start_matches([' ', ':', '=', '\t']);
            let end = digits.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(digits.len());
            fps = digits[..end].parse().ok().filter(|&rate: &f64| rate > 0.0);
        }
        if let Some((_, inside)) = lower.split_once("[in ") {
            unit = unit.or(inside.split(']').next().and_then(length_unit));
        }
        for word in ["units:", "unit:", "units =", "unit ="] {
            if let Some((_, rest)) = lower.split_once(word) {
                unit = unit.or(rest.split_whitespace().next().and_then(length_unit));
            }
        }
        // a line of names: id frame x/m y/m z/m
        let named = comment.split_whitespace().filter(|word| plain(word).len() == 1);
        for word in named {
            unit = unit.or(split_unit(word).1.and_then(length_unit));
        }
    }
    (fps, unit)
}

/// The column that has a role: the one that was asked for, or one of a known name.
///
/// # Errors
/// Where the one asked for is not there.
pub fn column(head: &Head, names: &[String], ask: &Ask, role: &str) -> Result<Option<usize>, StoreError> {
    if let Some(name) = ask.column(role) {
        if name == "none" {
            return Ok(None);
        }
        return named(head, names, role, name).map(Some);
    }
    let known = ROLES.iter().find(|(word, _)| *word == role).map_or(&[][..], |(_, known)| known);
    let timely = role == "time";
    let plain: Vec<String> = names.iter().map(|name| if timely { untimed(name) } else { self::plain(name) }).collect();
    let Some(found) = known.iter().find_map(|known| plain.iter().position(|name| name == known)) else {
        return Ok(None);
    };
    if let Some(again) = (found + 1..names.len()).find(|&k| names[k] == names[found]) {
        return Err(twice(head, role, &names[found], found, again));
    }
    Ok(Some(found))
}

/// Two columns of one name are told apart by their numbers.
fn twice(head: &Head, role: &str, name: &str, first: usize, second: usize) -> StoreError {
    let (first, second) = (first + 1, second + 1);
    let how = format!("say which with --columns {role}={first} or --columns {role}={second}");
    wrong(&head.path, &format!("two columns are called `{name}`: {how}"))
}

/// A name of a column of times without its unit: `time_ms` is `time`.
pub fn untimed(name: &str) -> String {
    let plain = plain(name);
    match plain.rsplit_once('_') {
        Some((before, unit)) if time_unit(unit).is_some() && !before.is_empty() => before.to_owned(),
        _ => plain,
    }
}

/// The column of a name, or of a number counted from 1.
fn named(head: &Head, names: &[String], role: &str, name: &str) -> Result<usize, StoreError> {
    let number = name.parse::<usize>().ok().filter(|&number| number >= 1 && number <= names.len());
    let alike: Vec<usize> = (0..names.len()).filter(|&k| names[k] == name).collect();
    if let [first, second, ..] = alike[..] {
        return Err(twice(head, role, name, first, second));
    }
    let found =
        names.iter().position(|other| other == name).or_else(|| names.iter().position(|n| plain(n) == plain(name)));
    found.or(number.map(|number| number - 1)).ok_or_else(|| {
        let near = meant(name, names.iter().map(String::as_str));
        let there = shown(names);
        wrong(&head.path, &format!("no column `{name}` for --columns {role}={name}; there are {there}{near}"))
    })
}

/// Names for a message: the first of them.
pub fn shown(names: &[String]) -> String {
    const SHOWN: usize = 12;
    let quoted: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    let more = names.len().saturating_sub(SHOWN);
    if more > 0 { format!("{} and {more} more", quoted.join(", ")) } else { quoted.join(", ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_units() {
        for (name, expected, unit) in [
            ("X#wcentroid (cm)", "x_wcentroid", Some("cm")),
            ("x/m", "x", Some("m")),
            ("location-long", "location_long", None),
            (" Frame Idx ", "frame_idx", None),
            ("speed (cm/s)", "speed", Some("cm/s")),
            ("a/b", "a_b", None),
            ("x_mm", "x", Some("mm")),
            ("x_m", "x_m", None),
        ] {
            assert_eq!((plain(name).as_str(), split_unit(name).1), (expected, unit), "{name}");
        }
    }

    #[test]
    fn times_carry_their_units() {
        let head = Head::default();
        let of = |name: &str| time_unit_of(&head, &Ask::default(), name).unwrap_or(None);
        assert_eq!(of("time_ms"), Some(1e-3));
        assert_eq!(of("Time (min)"), Some(60.0));
        assert_eq!(of("t [s]"), Some(1.0));
        assert_eq!(of("timestamp"), None);
        let asked = |unit: &str| Ask { columns: vec![("clock".into(), unit.into())], ..Ask::default() };
        assert_eq!(time_unit_of(&head, &asked("us"), "time_ms").ok(), Some(Some(1e-6)));
        assert!(time_unit_of(&head, &asked("weeks"), "time").is_err());
        assert_eq!(untimed("time_ms"), "time");
        assert_eq!(untimed("date_time"), "date_time");
    }

    #[test]
    fn comments_state_rate_and_unit() {
        let head = |lines: &[&str]| Head { comments: lines.iter().map(|&l| l.to_owned()).collect(), ..Head::default() };
        assert_eq!(comments(&head(&["framerate: 25 fps", "id frame x/m y/m z/m"])), (Some(25.0), Some("m")));
        assert_eq!(comments(&head(&["framerate: 25.00", "x [in cm]"])), (Some(25.0), Some("cm")));
        assert_eq!(comments(&head(&["framerate: fast", "id frame x y"])), (None, None));
    }
}
