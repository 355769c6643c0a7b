//! Sketches of scenarios: obstacles and starts.

use super::item::{Form, Item};
use crate::file::Form as _;
use crate::file::write::inline;
use crate::scenario::Scenario;
use crate::scenario::start::{BallRegion, Place, Region};
use crate::scenario::surroundings::{Ball, Obstacle, ObstacleShape, Segment};

fn pair(numbers: &[f64]) -> [f64; 2] {
    core::array::from_fn(|a| numbers.get(a).copied().unwrap_or(0.0))
}

/// Obstacles and starts of a scenario.
pub(super) fn of_scenario(scenario: &Scenario) -> Vec<Item> {
    let obstacle = |(index, obstacle): (usize, &Obstacle)| {
        let item = match &obstacle.shape {
            ObstacleShape::Ball(ball) => Item { radius: ball.radius, ..Item::new("disc", vec![pair(&ball.centre)]) },
            ObstacleShape::Segment(wall) => Item::new("wall", vec![pair(&wall.from), pair(&wall.to)]),
            ObstacleShape::Polygon(corners) => {
                Item::new("polygon", corners.iter().map(|corner| pair(corner)).collect())
            }
            ObstacleShape::Box(region) => Item::new("box", vec![pair(&region.low), pair(&region.high)]),
            ObstacleShape::Plane(_) => Item::new("other", Vec::new()),
        };
        Item { index: Some(index), ..item }
    };
    let start = |(name, group): &(String, crate::scenario::Group)| {
        let item = match &group.start.as_ref()?.place {
            Place::Box(region) => Item::new("start", vec![pair(&region.low), pair(&region.high)]),
            Place::Ball(ball) => {
                let item = Item::new("start", vec![pair(&ball.centre)]);
                Item { radius: ball.radius, form: Form::Disc, ..item }
            }
            // anywhere, and what is told point by point, is not drawn
            Place::Anywhere(_) | Place::Lattice(_) | Place::Points(_) => return None,
        };
        Some(Item { name: name.clone(), ..item })
    };
    let obstacles = scenario.obstacle.iter().enumerate().map(obstacle);
    obstacles.chain(scenario.group.0.iter().filter_map(start)).collect()
}

/// The values that put a sketch into the text of a scenario, and how many items it cannot hold.
pub(super) fn sets(before: &Scenario, items: &[Item]) -> (Vec<(String, String)>, usize) {
    let (mut obstacles, mut sets, mut left_out) = (Vec::new(), Vec::new(), 0);
    for item in items {
        let shape = match item.is.as_str() {
            "wall" => segments(item),
            "disc" => vec![ObstacleShape::Ball(Ball { centre: item.first().to_vec(), radius: item.radius })],
            "box" => {
                let (low, high) = item.corners();
                vec![ObstacleShape::Box(Region { low: low.to_vec(), high: high.to_vec() })]
            }
            "polygon" => vec![ObstacleShape::Polygon(item.points.iter().map(|point| point.to_vec()).collect())],
            "other" => item
                .index
                .and_then(|index| before.obstacle.get(index))
                .map(|old| old.shape.clone())
                .into_iter()
                .collect(),
            "start" => Vec::new(),
            _ => {
                left_out += 1;
                Vec::new()
            }
        };
        for shape in shape {
            // what else the file said of it, it goes on saying
            let old = item.index.and_then(|index| before.obstacle.get(index));
            obstacles.push(match old {
                Some(old) => Obstacle { shape, ..old.clone() },
                None => {
                    Obstacle { shape, appears: None, disappears: None, path: Vec::new(), albedo: 0.2, opaque: true }
                }
            });
        }
    }
    if obstacles != before.obstacle {
        let lines: Vec<String> =
            obstacles.iter().map(|obstacle| format!("  {},\n", inline(&obstacle.write()))).collect();
        let list = if lines.is_empty() { "[]".to_owned() } else { format!("[\n{}]", lines.concat()) };
        sets.push(("obstacle".to_owned(), list));
    }
    for (name, group) in &before.group.0 {
        let path = format!("group.{name}.start.place");
        let drawn = items.iter().find(|item| item.is == "start" && item.name == *name);
        let before = group.start.as_ref().map(|start| start.place.clone());
        match drawn {
            Some(item) => {
                let place = place(item);
                if before.as_ref() != Some(&place) {
                    sets.push((path, inline(&place.write())));
                }
            }
            // what was drawn and is no longer
            None if matches!(before, Some(Place::Box(_) | Place::Ball(_))) => {
                sets.push((path, "\"anywhere\"".to_owned()));
            }
            None => {}
        }
    }
    let known = |item: &&Item| item.is == "start" && before.group.0.iter().all(|(name, _)| *name != item.name);
    (sets, left_out + items.iter().filter(known).count())
}

/// The walls along a line of points; those without length are left out.
fn segments(item: &Item) -> Vec<ObstacleShape> {
    let wall = |pair: &[[f64; 2]]| {
        let (from, to) = (pair[0], pair[1]);
        (from != to).then(|| ObstacleShape::Segment(Segment { from: from.to_vec(), to: to.to_vec() }))
    };
    item.points.windows(2).filter_map(wall).collect()
}

fn place(item: &Item) -> Place {
    match item.form {
        Form::Disc => Place::Ball(BallRegion { centre: item.first().to_vec(), radius: item.radius }),
        Form::Box | Form::Polygon => {
            let (low, high) = item.corners();
            Place::Box(Region { low: low.to_vec(), high: high.to_vec() })
        }
    }
}
