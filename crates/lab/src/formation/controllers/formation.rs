//! Robots in the places of walls, a few walls at a time: when the targets have cleared the first of them, or a person says so, its robots go
//! to the posts of the next wall that has none. Who goes to which post is by least total distance (Kuhn 1955).

use super::flock::held;
use super::posts::Spacing;
use super::{Controller, Scene};
use crate::file::Nothing;
use crate::formation::task::{Task, Wall};
use crate::{form, tagged};
use space::obstacles::has_come;
use terrain::Point;
use terrain::posts::{assign_to_posts, posts};

/// Room between a parked robot and the corridor of the path.
const PARKED: f64 = 0.3;
/// Distance between places to park.
const PARKING: f64 = 0.5;
/// How near to its post a robot stands there.
const THERE: f64 = 0.12;

form! {
    /// When the targets have cleared a wall.
    pub struct Rule {
        /// How far beyond the wall's farther end every target has been.
        beyond: f64 = [0.5], "length", NonNegative;
        /// For how long.
        hold: f64 = [1.0], "time", NonNegative;
        /// After so long without a switch the posts are given out anew, for the walls of the leg on which the slower half is.
        timeout: f64 = [40.0], "time", Positive;
    }
}

impl Default for Rule {
    fn default() -> Self {
        Self { beyond: 0.5, hold: 1.0, timeout: 40.0 }
    }
}

tagged! {
    /// What lets robots go on to the next wall.
    pub enum Switch {
        /// That the targets have cleared the wall.
        rule => Rule(Rule);
        /// A person who watches, or the times of `switch_at` in place of one.
        manual => Manual(Nothing);
    }
}

form! {
    /// Robots in the places of walls.
    pub struct FormationForm {
        /// How many robots.
        robots: usize = [6usize], "1", Within(1.0, 1000.0);
        /// Posts of each wall: robots / posts walls stand at a time.
        per_wall: usize = [3usize], "1", Within(1.0, 100.0);
        /// Where posts stand along a wall.
        spacing: Spacing = [Spacing::Cells], "", Any;
        /// What lets robots go on.
        switch: Switch = [Switch::Rule(Rule::default())], "", Any;
        /// Times at which they go on whatever the rule says: those at which a person said so.
        switch_at: Option<Vec<f64>> = none, "time", NonNegative;
        /// Whether robots that stand at all posts of a wall are sensed as the wall itself.
        proxy_wall: bool = [false], "", Any;
    }
}

impl FormationForm {
    /// Whether nothing but a person lets it go on.
    pub(super) fn waits(&self) -> bool {
        matches!(self.switch, Switch::Manual(_)) && self.switch_at.is_none()
    }
}

/// The formation of one trial.
#[derive(Clone, Debug)]
pub struct Switching {
    form: FormationForm,
    walls: Vec<Wall>,
    /// Posts of each wall.
    posts: Vec<Vec<Point>>,
    /// Places to park.
    parking: Vec<Point>,
    /// The first wall that stands.
    first: usize,
    /// Where each robot is wanted.
    goals: Vec<Point>,
    /// Wall of each robot; none where it is parked.
    wall: Vec<Option<usize>>,
    /// Time since which every target is beyond the first wall.
    beyond: Option<f64>,
    /// Time of the last switch.
    switched: f64,
    /// Times at which it goes on whatever the rule says, in order, and how many of them are over.
    times: Vec<f64>,
    over: usize,
    /// Whether the robots of a wall all stand there.
    there: Vec<bool>,
}

impl Switching {
    pub(super) fn new(form: &FormationForm, task: &Task, walls: &[Wall]) -> Self {
        let walls = task.ordered(walls);
        let posts = walls.iter().map(|wall| posts(&wall.at, form.per_wall, form.spacing.into())).collect();
        let mut times = form.switch_at.clone().unwrap_or_default();
        times.sort_by(f64::total_cmp);
        Self {
            form: form.clone(),
            there: vec![false; walls.len()],
            walls,
            posts,
            parking: Vec::new(),
            first: 0,
            goals: Vec::new(),
            wall: vec![None; form.robots],
            beyond: None,
            switched: 0.0,
            times,
            over: 0,
        }
    }
    /// Walls that stand at a time.
    fn slots(&self) -> usize {
        (self.form.robots / self.form.per_wall).max(1)
    }
    /// Gives the posts of the walls that are to stand to the robots; those of a wall that stays keep theirs unless `anew`.
    fn assign(&mut self, robots: &[Point], anew: bool) {
        let wanted: Vec<usize> = (self.first..self.walls.len()).take(self.slots()).collect();
        let kept = |wall: &Option<usize>| !anew && wall.is_some_and(|wall| wanted.contains(&wall));
        let free: Vec<usize> = (0..robots.len()).filter(|&k| !kept(&self.wall[k])).collect();
        let taken: Vec<usize> = self.wall.iter().filter(|wall| kept(wall)).flatten().copied().collect();
        let open = wanted.iter().filter(|wall| !taken.contains(wall));
        let places: Vec<(usize, Point)> =
            open.flat_map(|&wall| self.posts[wall].iter().map(move |&post| (wall, post))).collect();
        let of = |k: &usize| robots[*k];
        let chosen =
            chosen(&free.iter().map(of).collect::<Vec<_>>(), &places.iter().map(|place| place.1).collect::<Vec<_>>());
        for (&k, post) in free.iter().zip(chosen) {
            self.wall[k] = post.map(|post| places[post].0);
            if let Some(post) = post {
                self.goals[k] = places[post].1;
            }
        }
        let parked: Vec<usize> = (0..robots.len()).filter(|&k| self.wall[k].is_none()).collect();
        let spots = self::chosen(&parked.iter().map(of).collect::<Vec<_>>(), &self.parking);
        for (&k, spot) in parked.iter().zip(spots) {
            self.goals[k] = spot.map_or(robots[k], |spot| self.parking[spot]);
        }
    }
    /// Whether every target is beyond a wall.
    fn cleared(&self, scene: &Scene<'_>, rule: &Rule) -> bool {
        let Some(wall) = self.walls.get(self.first) else { return false };
        let beyond = |(target, &done): (&Point, &usize)| {
            done > wall.leg || scene.task.beyond(wall, *target, rule.beyond + 0.1) >= rule.beyond
        };
        scene.targets.iter().zip(&scene.progress.done).all(beyond)
    }
    fn switch(&mut self, scene: &Scene<'_>) {
        if self.times.get(self.over).is_some_and(|&time| has_come(time, scene.time)) {
            self.over += 1;
            self.go_on(scene);
            return;
        }
        let Switch::Rule(rule) = self.form.switch.clone() else { return };
        if self.cleared(scene, &rule) {
            let since = *self.beyond.get_or_insert(scene.time);
            if scene.time - since >= rule.hold {
                self.go_on(scene);
            }
        } else {
            self.beyond = None;
            if scene.time - self.switched >= rule.timeout {
                let leg = scene.progress.leg();
                self.first = self.walls.iter().position(|wall| wall.leg >= leg).unwrap_or(self.walls.len());
                self.switched = scene.time;
                self.assign(scene.robots, true);
            }
        }
    }
    fn go_on(&mut self, scene: &Scene<'_>) {
        self.first += 1;
        self.switched = scene.time;
        self.beyond = None;
        self.assign(scene.robots, false);
    }
}

/// The post of each robot by least total distance. Coordinates are finite here, so that there always is an answer.
fn chosen(robots: &[Point], posts: &[Point]) -> Vec<Option<usize>> {
    assign_to_posts(robots, posts).map_or_else(|_| vec![None; robots.len()], |(_, chosen)| chosen)
}

/// Places along the bounds (or about the path) that are out of the way of path and posts.
fn parking(scene: &Scene<'_>, posts: &[Vec<Point>]) -> Vec<Point> {
    let path = &scene.task.path;
    let (low, high) = scene.bounds.unwrap_or_else(|| {
        let room = 2.0 * scene.task.half_width;
        let least = |axis: usize| path.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min) - room;
        let most = |axis: usize| path.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max) + room;
        (space::Vector([least(0), least(1)]), space::Vector([most(0), most(1)]))
    });
    let inset = scene.radii.1 + 0.05;
    let mut places = Vec::new();
    for axis in 0..2 {
        let steps = ((high[axis] - low[axis] - 2.0 * inset) / PARKING).floor().max(0.0) as usize;
        for step in 0..=steps {
            for side in [low[1 - axis] + inset, high[1 - axis] - inset] {
                let mut place = space::Vector([side; 2]);
                place[axis] = low[axis] + inset + step as f64 * PARKING;
                places.push(place);
            }
        }
    }
    let legs = || path.windows(2).map(|two| space::Segment { from: two[0], to: two[1] });
    let room = scene.task.half_width + PARKED;
    places.retain(|&place| legs().all(|leg| leg.distance(place) >= room));
    places.retain(|&place| posts.iter().flatten().all(|&post| (post - place).length() >= 4.0 * scene.radii.1));
    places
}

impl Controller for Switching {
    fn begin(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        for post in self.posts.iter_mut().flatten() {
            *post = held(*post, scene);
        }
        self.parking = parking(scene, &self.posts);
        // they stand at their posts when the targets come; those that have none begin where they park
        let wanted = self.posts.iter().enumerate().take(self.slots());
        let mut places: Vec<(Option<usize>, Point)> =
            wanted.flat_map(|(wall, posts)| posts.iter().map(move |&post| (Some(wall), post))).collect();
        places.truncate(self.form.robots);
        let spots = self.parking.iter().copied().map(|spot| (None, spot));
        places.extend(spots.take(self.form.robots - places.len()));
        self.wall = places.iter().map(|place| place.0).collect();
        self.goals = places.iter().map(|place| place.1).collect();
        self.goals.clone()
    }
    fn goals(&mut self, scene: &Scene<'_>) -> Vec<Point> {
        self.switch(scene);
        for (wall, there) in self.there.iter_mut().enumerate() {
            let mut own = (0..scene.robots.len()).filter(|&k| self.wall[k] == Some(wall)).peekable();
            *there = own.peek().is_some() && own.all(|k| (scene.robots[k] - self.goals[k]).length() <= THERE);
        }
        self.goals.clone()
    }
    fn stands(&self, wall: usize) -> bool {
        self.form.proxy_wall && self.there[wall]
    }
    fn posts(&self) -> Vec<Point> {
        self.posts.iter().flatten().copied().collect()
    }
    fn switch_at(&mut self, time: f64) -> Option<Vec<f64>> {
        // those that are over came before
        let place = self.times.partition_point(|&other| other <= time).max(self.over);
        self.times.insert(place, time);
        Some(self.times.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formation::task::{Progress, tests::turn};
    use space::{Segment, Vector};

    #[test]
    fn robots_go_on_when_the_targets_have_cleared_a_wall() {
        let task = turn();
        let wall = |x: f64, leg: usize| Wall {
            at: if leg == 0 { Segment::new([x, -3.0], [x, -2.0]) } else { Segment::new([-1.0, x], [-2.0, x]) },
            leg,
        };
        let walls = [wall(1.2, 0), wall(-1.2, 0), wall(1.2, 1)];
        let form = FormationForm {
            robots: 6,
            per_wall: 3,
            spacing: Spacing::Cells,
            switch: Switch::Rule(Rule::default()),
            switch_at: None,
            proxy_wall: true,
        };
        let mut formation = Switching::new(&form, &task, &walls);
        let mut progress = Progress::new(&task, 2);
        let bounds = Some((Vector([-5.0, -5.0]), Vector([5.0, 5.0])));
        let at = |targets: &[Point], robots: &[Point], progress: &Progress, time: f64, formation: &mut Switching| {
            let scene = Scene { task: &task, progress, targets, robots, radii: (0.17, 0.17), bounds, time };
            if robots.is_empty() { formation.begin(&scene) } else { formation.goals(&scene) }
        };
        let early = [Vector([0.0, -4.0]), Vector([0.2, -3.9])];
        progress.step(&early);
        let places = at(&early, &[], &progress, 0.0, &mut formation);
        assert!(places.iter().all(|place| place[0].abs() == 1.2 && place[1] < -2.0), "{places:?}");
        assert_eq!(at(&early, &places, &progress, 0.1, &mut formation), places);
        assert!(formation.stands(0) && formation.stands(1) && !formation.stands(2));
        let late = [Vector([0.0, -1.4]), Vector([0.2, -1.3])];
        assert_eq!(at(&late, &places, &progress, 9.0, &mut formation), places, "not for long enough");
        let goals = at(&late, &places, &progress, 10.0, &mut formation);
        let moved: Vec<usize> = (0..6).filter(|&k| goals[k] != places[k]).collect();
        assert_eq!(moved.len(), 3, "one wall's robots");
        assert!(moved.iter().all(|&k| goals[k][1] == 1.2), "{goals:?}");
        // there is no fourth wall: the next to be free park out of the way
        at(&late, &places, &progress, 12.0, &mut formation);
        let goals = at(&late, &places, &progress, 14.0, &mut formation);
        let parked: Vec<Point> = goals.iter().copied().filter(|goal| goal[1] != 1.2).collect();
        assert_eq!(parked.len(), 3);
        assert!(parked.iter().all(|spot| spot[0].abs() > 4.5 || spot[1].abs() > 4.5), "{parked:?}");
    }

    #[test]
    fn robots_go_on_at_the_times_they_are_told() {
        let task = turn();
        let wall = |y: f64| Wall { at: Segment::new([1.2, y - 0.5], [1.2, y]), leg: 0 };
        let form = FormationForm {
            robots: 3,
            per_wall: 3,
            spacing: Spacing::Cells,
            switch: Switch::Manual(Nothing),
            switch_at: Some(vec![5.0]),
            proxy_wall: false,
        };
        assert!(!form.waits() && FormationForm { switch_at: None, ..form.clone() }.waits());
        let mut formation = Switching::new(&form, &task, &[wall(-3.0), wall(-2.0), wall(-1.0)]);
        let progress = Progress::new(&task, 1);
        let targets = [Vector([0.0, -4.0])];
        let at = |time: f64, robots: &[Point], formation: &mut Switching| {
            let scene = Scene {
                task: &task,
                progress: &progress,
                targets: &targets,
                robots,
                radii: (0.17, 0.17),
                bounds: None,
                time,
            };
            let goals = if robots.is_empty() { formation.begin(&scene) } else { formation.goals(&scene) };
            goals[0][1].ceil()
        };
        let robots = [Vector([0.0, 0.0]); 3];
        assert_eq!([at(0.0, &[], &mut formation), at(1.0, &robots, &mut formation)], [-3.0, -3.0]);
        // what is said now comes before what the file says for later
        assert_eq!(formation.switch_at(2.0), Some(vec![2.0, 5.0]));
        assert_eq!([2.0, 3.0, 4.9].map(|time| at(time, &robots, &mut formation)), [-2.0; 3]);
        assert_eq!([5.0, 90.0].map(|time| at(time, &robots, &mut formation)), [-1.0; 2]);
        assert_eq!(formation.switch_at(90.0), Some(vec![2.0, 5.0, 90.0]));
    }
}
