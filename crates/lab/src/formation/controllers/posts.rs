//! Robots that rest at the posts of all walls, and the walls that posts stand for.

use super::{Controller, Scene};
use crate::formation::task::Wall;
use crate::{form, words};
use terrain::Point;
use terrain::posts::{posts, posts_for_gap, walls_of};

words! {
    /// Where posts stand along a wall.
    pub enum Spacing {
        /// In the middles of equal cells.
        Cells = "cells",
        /// From end to end.
        Ends = "ends",
    }
}

impl From<Spacing> for terrain::posts::Spacing {
    fn from(spacing: Spacing) -> Self {
        match spacing {
            Spacing::Cells => Self::Cells,
            Spacing::Ends => Self::Ends,
        }
    }
}

form! {
    /// Robots that rest at posts.
    pub struct Posts {
        /// Posts of each wall.
        per_wall: usize = [3usize], "1", Within(1.0, 100.0);
        /// Where they stand along it.
        spacing: Spacing = [Spacing::Cells], "", Any;
        /// Widest gap between two bodies; where given, it says how many posts there are in place of `per_wall`.
        gap: Option<f64> = none, "length", Positive;
    }
}

form! {
    /// The walls that posts stand for.
    pub struct Restored {
        /// Posts of each wall of the task.
        per_wall: usize = [3usize], "1", Within(1.0, 100.0);
        /// Where they stand along it.
        spacing: Spacing = [Spacing::Cells], "", Any;
        /// Posts no farther apart are of one wall.
        joined: f64 = [1.05], "length", Positive;
    }
}

impl Restored {
    /// The walls, each of the leg of the nearest of those from which the posts come.
    pub fn restored(&self, walls: &[Wall]) -> Vec<Wall> {
        let spacing = self.spacing.into();
        let all: Vec<Point> = walls.iter().flat_map(|wall| posts(&wall.at, self.per_wall, spacing)).collect();
        let (found, _) = walls_of(&all, self.joined, spacing);
        let leg = |at: &space::Segment| {
            let apart = |wall: &Wall| (wall.at.at(0.5) - at.at(0.5)).length();
            walls.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).map_or(0, |wall| wall.leg)
        };
        let mut found: Vec<Wall> = found.into_iter().map(|at| Wall { leg: leg(&at), at }).collect();
        found.sort_by_key(|wall| wall.leg);
        found
    }
}

/// Resting robots.
#[derive(Clone, Debug)]
pub struct Resting {
    form: Posts,
    walls: Vec<Wall>,
    places: Vec<Point>,
}

impl Resting {
    pub(super) fn new(form: &Posts, walls: &[Wall]) -> Self {
        Self { form: form.clone(), walls: walls.to_vec(), places: Vec::new() }
    }
}

impl Controller for Resting {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        let spacing = self.form.spacing.into();
        let places = |wall: &Wall| {
            let by_gap = self.form.gap.and_then(|gap| posts_for_gap(&wall.at, gap, scene.radii.1, spacing).ok());
            posts(&wall.at, by_gap.unwrap_or(self.form.per_wall), spacing)
        };
        self.places = self.walls.iter().flat_map(places).map(|place| super::flock::held(place, scene)).collect();
        self.places.clone()
    }
    fn goals(&mut self, _: &Scene<'_>) -> Vec<Point> {
        self.places.clone()
    }
    fn posts(&self) -> Vec<Point> {
        self.places.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use space::Segment;

    #[test]
    fn walls_come_back_from_their_posts() {
        let form = Restored { per_wall: 3, spacing: Spacing::Cells, joined: 1.0 };
        let walls = [
            Wall { at: Segment::new([1.0, 0.0], [1.0, 2.0]), leg: 0 },
            Wall { at: Segment::new([-3.0, 0.5], [-1.0, 0.5]), leg: 1 },
        ];
        let back = form.restored(&walls);
        assert_eq!(back.len(), 2);
        for (wall, back) in walls.iter().zip(back) {
            assert_eq!(wall.leg, back.leg);
            assert!((wall.at.at(0.5) - back.at.at(0.5)).length() < 1e-12);
            assert!((wall.at.length() - back.at.length()).abs() < 1e-12);
        }
    }
}
