//! Figures that tell members apart.

use super::{Axis, Figure, Line, Lines, Map, MapCell, MapPanel};
use crate::run::tables::AXES;
use crate::scenario::Scenario;
use crate::store::StoreError;
use crate::store::table::Table;
use space::Vector;
use std::collections::BTreeMap;

/// So many members are told apart in a figure.
const MOST: usize = 12;
/// Rows of a trajectory that are looked through for turns.
const LOOKED_AT: u64 = 400_000;
/// Times, and rows of members, of a map of their turns.
const CELLS: (usize, usize) = (80, 40);

/// How far each member's nearest input was when it last decided, over time: where members keep that, and are few. Reversion to following
/// the nearest shows as one band for each member.
///
/// # Errors
/// Where the trajectory cannot be read.
pub(super) fn nearest_inputs(table: &Table, scenario: &Scenario) -> Result<Option<Figure>, StoreError> {
    let members: usize = scenario.group.0.iter().map(|(_, group)| group.count).sum();
    let columns = ["t", "id", "nearest_ahead", "nearest_left"].map(|name| table.column(name));
    let ([Some(t), Some(id), Some(ahead), Some(left)], 1..=MOST) = (columns, members) else { return Ok(None) };
    let mut lines: Vec<Line> =
        (0..members).map(|id| Line { name: format!("member {id}"), x: Vec::new(), y: Vec::new() }).collect();
    for group in 0..table.groups() {
        let read = table.read(group, &[t, id, ahead, left])?;
        for row in 0..read[0].len() {
            let Some(line) = lines.get_mut(read[1].number(row) as usize) else { continue };
            let distance = read[2].number(row).hypot(read[3].number(row));
            line.x.push(read[0].number(row));
            line.y.push((distance > 0.0).then_some(distance));
        }
    }
    Ok(Some(Figure::Lines(Lines {
        id: "nearest_inputs".into(),
        title: "Distance to the nearest input".into(),
        about: "Of what each member's law was handed when it last decided; nothing where that was nobody.".into(),
        x: Axis { label: "time".into(), unit: scenario.units.time.clone(), range: None },
        y: Axis { label: "distance".into(), unit: scenario.units.length.clone(), range: None },
        lines,
    })))
}

/// A member at a moment.
#[derive(Clone, Copy)]
struct Seen {
    place: Vector<f64, 3>,
    velocity: Vector<f64, 3>,
    meets: bool,
}

/// How a turn passes through a group that meets an obstacle: by how much each member's heading has changed since the first one had an
/// obstacle or a wall in its zone of avoidance. Of runs with that column, one group and kept velocities in which it happens.
///
/// # Errors
/// Where the trajectory cannot be read.
pub(super) fn turns(table: &Table, scenario: &Scenario) -> Result<Vec<Figure>, StoreError> {
    let axes = AXES.map(|axis| (table.column(axis), table.column(&format!("v{axis}"))));
    let columns = ["t", "id", "o_avoid"].map(|name| table.column(name));
    let ([Some(t), Some(id), Some(meets)], [(Some(x), Some(vx)), (Some(y), Some(vy)), third]) = (columns, axes) else {
        return Ok(Vec::new());
    };
    if scenario.group.0.len() != 1 || scenario.obstacle.is_empty() || table.rows() > LOOKED_AT {
        return Ok(Vec::new());
    }
    let mut frames: BTreeMap<u64, (f64, BTreeMap<u32, Seen>)> = BTreeMap::new();
    let mut wanted = vec![t, id, meets, x, y, vx, vy];
    if let (Some(z), Some(vz)) = third {
        wanted.extend([z, vz]);
    }
    for group in 0..table.groups() {
        let read = table.read(group, &wanted)?;
        for row in 0..read[0].len() {
            let number = |column: usize| read.get(column).map_or(0.0, |values| values.number(row));
            let seen = Seen {
                place: Vector([number(3), number(4), number(7)]),
                velocity: Vector([number(5), number(6), number(8)]),
                meets: number(2) > 0.0,
            };
            // times are never negative, so that their bits are in their order
            frames.entry(number(0).to_bits()).or_insert((number(0), BTreeMap::new())).1.insert(number(1) as u32, seen);
        }
    }
    let frames: Vec<(f64, BTreeMap<u32, Seen>)> = frames.into_values().collect();
    let began = frames.iter().find_map(|(time, all)| Some((time, all, all.iter().find(|(_, seen)| seen.meets)?)));
    let Some((&start, then, (&first, met))) = began else { return Ok(Vec::new()) };
    let mean = then.values().fold(Vector::ZERO, |sum, seen| sum + seen.velocity.unit());
    // who the others are, by their distance from the first
    let mut order: Vec<(u32, f64)> = then.iter().map(|(&id, seen)| (id, (seen.place - met.place).length())).collect();
    order.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    let along = |seen: &Seen| seen.place.dot(mean);
    let rearmost = then.iter().min_by(|a, b| along(a.1).total_cmp(&along(b.1))).map_or(first, |(&id, _)| id);
    let turned = |all: &BTreeMap<u32, Seen>, id: u32| {
        let (now, before) = (all.get(&id)?.velocity, then.get(&id)?.velocity);
        (!now.is_tiny() && !before.is_tiny()).then(|| now.angle_to(before).to_degrees())
    };
    let time = Axis { label: "time".into(), unit: scenario.units.time.clone(), range: None };
    let mut lines: Vec<Line> =
        ["the first", "the rearmost", "mean of all", "a tenth has turned less", "a tenth has turned more"]
            .map(|name| Line { name: name.into(), x: Vec::new(), y: Vec::new() })
            .into();
    for (at, all) in &frames {
        let mut each: Vec<f64> = order.iter().filter_map(|&(id, _)| turned(all, id)).collect();
        each.sort_by(f64::total_cmp);
        let share = |share: f64| each.get((share * each.len().saturating_sub(1) as f64).round() as usize).copied();
        let mean = (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64);
        for (line, value) in
            lines.iter_mut().zip([turned(all, first), turned(all, rearmost), mean, share(0.1), share(0.9)])
        {
            line.x.push(*at);
            line.y.push(value);
        }
    }
    let mut cells: BTreeMap<(usize, usize), (f64, usize)> = BTreeMap::new();
    let (columns, rows) = (CELLS.0.min(frames.len()), CELLS.1.min(order.len()));
    for (frame, (_, all)) in frames.iter().enumerate() {
        for (rank, &(id, _)) in order.iter().enumerate() {
            if let Some(angle) = turned(all, id) {
                let cell = cells.entry((frame * columns / frames.len(), rank * rows / order.len())).or_default();
                *cell = (cell.0 + angle, cell.1 + 1);
            }
        }
    }
    let (from, to) = (frames.first().map_or(0.0, |frame| frame.0), frames.last().map_or(1.0, |frame| frame.0));
    let edges =
        (|k: usize| from + (to - from) * k as f64 / columns as f64, |k: usize| (order.len() * k) as f64 / rows as f64);
    let cell = |(&(column, row), &(sum, count)): (&(usize, usize), &(f64, usize))| MapCell {
        low: [edges.0(column), edges.1(row)],
        high: [edges.0(column + 1), edges.1(row + 1)],
        rate: sum / count as f64 / 180.0,
        valid: false,
    };
    let shown = |value: f64| format!("{value:.1}");
    let farthest = order.last().map_or(0.0, |last| last.1);
    let moment = format!(
        "Member {first} is the first that has an obstacle or a wall in its zone of avoidance, at {} {}; member {rearmost} is then the rearmost.",
        shown(start),
        scenario.units.time
    );
    Ok(vec![
        Figure::Lines(Lines {
            id: "turns".into(),
            title: "How a turn passes through the group".into(),
            about: format!("Change of each heading since the first met something. {moment}"),
            x: time.clone(),
            y: Axis { label: "change of heading".into(), unit: "deg".into(), range: Some((0.0, 180.0)) },
            lines,
        }),
        Figure::Map(Map {
            title: "Change of heading of every member".into(),
            about: format!(
                "The darker, the more a heading differs from what it was when the first met something (white 0, darkest 180 degrees). \
                 {moment} Members stand in the order of their distance from it then, itself at the bottom, the farthest, {} {} away, on top.",
                shown(farthest),
                scenario.units.length
            ),
            x: Axis { range: Some((from, to.max(from + f64::MIN_POSITIVE))), ..time },
            y: Axis {
                label: "members, by distance from the first".into(),
                unit: String::new(),
                range: Some((0.0, order.len() as f64)),
            },
            areas: true,
            panels: vec![MapPanel { caption: String::new(), cells: cells.iter().map(cell).collect() }],
        }),
    ])
}
