//! Names of columns that tables of tracks are known to have, and units that names and comments carry.

use super::text::Head;
use super::{Ask, meant, wrong};
use crate::store::StoreError;

/// What a column can be, by the word that `--columns` knows it by, with the names it is known to have elsewhere.
pub const ROLES: &[(&str, &[&str])] = &[
    ("frame", &["frame", "frame_idx", "frame_index", "frame_number", "framenumber", "frame_no", "fnum", "imagenumber"]),
    ("time", &["utc", "timestamp", "datetime", "date_time", "t", "time", "seconds", "time_s", "sec", "time_sec"]),
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
pub const CHOICES: [(&str, &str); 2] = [
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
    let plain: Vec<String> = names.iter().map(|name| self::plain(name)).collect();
    Ok(known.iter().find_map(|known| plain.iter().position(|name| name == known)))
}

/// The column of a name, or of a number counted from 1.
fn named(head: &Head, names: &[String], role: &str, name: &str) -> Result<usize, StoreError> {
    let number = name.parse::<usize>().ok().filter(|&number| number >= 1 && number <= names.len());
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
    fn comments_state_rate_and_unit() {
        let head = |lines: &[&str]| Head { comments: lines.iter().map(|&l| l.to_owned()).collect(), ..Head::default() };
        assert_eq!(comments(&head(&["framerate: 25 fps", "id frame x/m y/m z/m"])), (Some(25.0), Some("m")));
        assert_eq!(comments(&head(&["framerate: 25.00", "x [in cm]"])), (Some(25.0), Some("cm")));
        assert_eq!(comments(&head(&["framerate: fast", "id frame x y"])), (None, None));
    }
}
