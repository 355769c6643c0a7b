//! Signals as they are written: `n_groups(25)`, `share_crossed(right)`, `centroid_dist(marker)`.

use measure::behaviours::{Membership, Setting, Signal};
use space::Vector;
use space::segment::Passage;
use space::shape::Shape;
use space::spelling::nearest;

/// Every signal: its name, how it is written, what it is.
pub const SIGNALS: &[(&str, &str, &str)] = &[
    (
        "n_groups",
        "n_groups(distance)",
        "number of groups, linked at most so far apart; `n_groups(distance, visible)`: walls cut links",
    ),
    ("largest_share", "largest_share(distance)", "share of the largest group"),
    ("entropy_ratio", "entropy_ratio(distance)", "entropy of the shares of the groups over that of equal shares"),
    ("centroid_dist", "centroid_dist(place)", "distance of the centroid to a place, or to x, y"),
    ("centroid_x", "centroid_x", "x of the centroid"),
    ("centroid_y", "centroid_y", "y of the centroid"),
    ("spread", "spread", "root mean squared distance to the centroid"),
    ("sd_x", "sd_x", "standard deviation of x (n - 1)"),
    ("sd_y", "sd_y", "standard deviation of y (n - 1)"),
    ("polarisation", "polarisation", "length of the mean heading"),
    ("line", "line", "how close to a line the members are, 0 to 1"),
    ("share_in", "share_in(region)", "share inside a region"),
    ("share_visited", "share_visited(region)", "share that has ever been inside a region"),
    (
        "share_crossed",
        "share_crossed(gate)",
        "share that has ever crossed a gate; `share_crossed(gate, left)` or `right`: to that side",
    ),
    ("type_share_in", "type_share_in(region, group)", "share of a group of the scenario inside a region"),
    ("purity", "purity(region, ...)", "share, of those in any of the regions, of the commonest group of theirs"),
    ("share_placed", "share_placed(region, ...)", "share inside any of the regions"),
    ("path_error", "path_error(path)", "mean distance to a wanted trajectory"),
    ("min_wall_dist", "min_wall_dist", "least distance of a member to a wall"),
    ("alive", "alive", "share that is there"),
];

/// The signal of a text. `groups` are the names of the scenario's groups, whose places are the types of members.
///
/// # Errors
/// What is wrong with it, in a sentence that names the nearest thing that is there.
pub fn parse(text: &str, setting: &Setting, groups: &[String]) -> Result<Signal, String> {
    let text = text.trim();
    let (name, inside) = match text.split_once('(') {
        Some((name, rest)) => match rest.trim_end().strip_suffix(')') {
            Some(inside) => (name.trim(), inside),
            None => return Err(format!("`{text}`: the bracket is not closed")),
        },
        None => (text, ""),
    };
    let arguments: Vec<&str> = inside.split(',').map(str::trim).filter(|argument| !argument.is_empty()).collect();
    let Some((_, usage, _)) = SIGNALS.iter().find(|(known, ..)| *known == name) else {
        let near = nearest(name, SIGNALS.iter().map(|(known, ..)| *known));
        return Err(match near {
            Some(near) => format!("unknown signal `{name}`; did you mean `{near}`?"),
            None => format!(
                "unknown signal `{name}`; there is {}",
                SIGNALS.iter().map(|(known, ..)| *known).collect::<Vec<_>>().join(", ")
            ),
        });
    };
    let takes = || format!("`{name}` is written {usage}, found {} in the brackets", arguments.len());
    let number = |text: &str| match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!("`{name}` takes a number, found `{text}`")),
    };
    let region = |name: &str| setting.region(name).map_err(|error| error.to_string());
    let regions = || arguments.iter().map(|name| region(name)).collect::<Result<Vec<Shape<f64, 2>>, _>>();
    let membership = || match *arguments.as_slice() {
        [distance] => Ok(Membership::within(number(distance)?)),
        [distance, "visible"] => Ok(Membership { distance: number(distance)?, walls: setting.walls.clone() }),
        _ => Err(takes()),
    };
    let none = |signal: Signal| if arguments.is_empty() { Ok(signal) } else { Err(takes()) };
    match (name, arguments.as_slice()) {
        ("n_groups", _) => membership().map(Signal::GroupCount),
        ("largest_share", _) => membership().map(Signal::LargestShare),
        ("entropy_ratio", _) => membership().map(Signal::EntropyRatio),
        ("centroid_dist", [place]) => {
            setting.place(place).map(Signal::CentroidDistance).map_err(|error| error.to_string())
        }
        ("centroid_dist", [x, y]) => Ok(Signal::CentroidDistance(Vector([number(x)?, number(y)?]))),
        ("centroid_x", _) => none(Signal::Centroid(0)),
        ("centroid_y", _) => none(Signal::Centroid(1)),
        ("spread", _) => none(Signal::Spread),
        ("sd_x", _) => none(Signal::Deviation(0)),
        ("sd_y", _) => none(Signal::Deviation(1)),
        ("polarisation", _) => none(Signal::Polarisation),
        ("line", _) => none(Signal::Line),
        ("share_in", [name]) => region(name).map(Signal::ShareIn),
        ("share_visited", [name]) => region(name).map(Signal::ShareVisited),
        ("share_crossed", [gate, side @ ..]) => {
            let gate = setting.gate(gate).map_err(|error| error.to_string())?;
            let side = match side {
                [] => None,
                ["left"] => Some(Passage::ToLeft),
                ["right"] => Some(Passage::ToRight),
                _ => return Err("the side of a gate is `left` or `right`".to_owned()),
            };
            Ok(Signal::ShareCrossed(gate, side))
        }
        ("type_share_in", [place, group]) => match groups.iter().position(|known| known == group) {
            Some(kind) => region(place).map(|region| Signal::TypeShareIn(region, kind)),
            None => {
                let near = nearest(group, groups.iter().map(String::as_str));
                let hint = near.map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
                Err(format!("there is no group `{group}`{hint}"))
            }
        },
        ("purity", [_, ..]) => regions().map(Signal::Purity),
        ("share_placed", [_, ..]) => regions().map(Signal::SharePlaced),
        ("path_error", [path]) => match setting.paths.iter().find(|(known, _)| known == path) {
            Some((_, points)) => Ok(Signal::PathError(points.clone())),
            None => Err(format!("there is no path `{path}`")),
        },
        ("min_wall_dist", _) => none(Signal::WallDistance(setting.walls.clone())),
        ("alive", _) => none(Signal::Alive),
        _ => Err(takes()),
    }
}
