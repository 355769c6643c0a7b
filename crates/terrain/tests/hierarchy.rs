//! Stages put together: rigid motions, and what does not fit.
#![allow(clippy::unwrap_used, reason = "tests")]

use space::shape::Shape;
use space::{Segment, Vector};
use terrain::hierarchy::{Port, Stage, compose};
use terrain::schemas::funnel::Funnel;
use terrain::schemas::sieve::Sieve;
use terrain::{Construct, Point, Pose, Schema, TerrainError, Units, workspaces};

fn port(x: f64, y: f64, heading: f64) -> Port {
    let region = Shape::Ball { centre: Vector([x, y]), radius: 0.4 };
    Port { pose: Pose::new([x, y], heading), region }
}
fn stage(name: &str, construct: Construct, entry: Port, exit: Port) -> Stage {
    Stage { name: name.into(), construct, entry, exit: Some(exit), clearance: 0.2 }
}
fn funnel() -> Stage {
    let construct = Funnel.construct(&[4.0, 1.0, 45.0, 2.0], &workspaces::arena(10.0), 0, 0).unwrap();
    stage("funnel", construct, port(-2.0, 0.0, 0.0), port(2.5, 0.0, 0.0))
}
fn sieve() -> Stage {
    let construct = Sieve.construct(&[5.0, 0.5, 0.0, 0.1], &workspaces::arena(10.0), 0, 0).unwrap();
    stage("sieve", construct, port(0.0, -1.0, 90.0), port(0.0, 1.0, 90.0))
}
fn walls(lines: &[[f64; 4]]) -> Construct {
    Construct::of_walls(Units::Metres, lines.iter().map(|&[a, b, c, d]| Segment::new([a, b], [c, d])))
}

#[test]
fn stages_stand_one_behind_the_other() {
    let whole = compose(&[funnel(), sieve()]).unwrap();
    assert_eq!(whole.construct.pieces.len(), funnel().construct.pieces.len() + 5);
    // the sieve is turned so that its entry, one below it, lies on the exit
    let posts: Vec<Point> =
        whole.construct.geometry().filter(|g| g.segments().is_empty()).map(|g| g.points()[0]).collect();
    assert!(posts.iter().all(|post| (post[0] - 3.6).abs() < 0.11), "{posts:?}");
    assert!(whole.entries[1].contains(Vector([2.5, 0.0])));
    assert_eq!(whole.construct.provenance.schema, "funnel -> sieve");
    assert_eq!(compose(&[funnel()]).unwrap().construct.walls(), funnel().construct.walls());
    assert_eq!(whole.construct.marker("entry sieve").unwrap().pose.at, Vector([2.5, 0.0]));
    // without an exit the last stage still stands
    let last = Stage { exit: None, ..sieve() };
    assert_eq!(compose(&[funnel(), last]).unwrap().construct, whole.construct);
}

/// Corridors that turn and go on: what was an end in one is a beginning in the next, by a rigid motion alone.
#[test]
fn corridors_meet_end_to_end() {
    let corridor = |k: usize, turn: f64| {
        let lines = walls(&[[0.0, 0.5, 2.0, 0.5], [0.0, -0.5, 2.0, -0.5]]);
        stage(&format!("{k}"), lines, port(0.05, 0.0, 0.0), port(2.05, 0.0, turn))
    };
    let turns = [90.0, 37.0, -90.0, 10.0];
    let whole = compose(&turns.map(|turn| corridor(0, turn))).unwrap();
    let corner = whole.construct.walls()[2].from;
    assert!((corner - Vector([1.55, -0.05])).length() < 1e-12, "{corner:?}");
    let mut heading = 0.0;
    for (k, part) in whole.parts.iter().enumerate() {
        let [upper, lower] = <[Segment; 2]>::try_from(part.walls()).unwrap();
        assert!((upper.length() - 2.0).abs() < 1e-12 && ((upper.from - lower.from).length() - 1.0).abs() < 1e-12);
        let along = (upper.to - upper.from).unit();
        assert!((along - terrain::geometry::turned(Vector([1.0, 0.0]), heading)).length() < 1e-12);
        if k > 0 {
            let exit = whole.poses[k - 1].place(Vector([2.05, 0.0]));
            let entry = whole.poses[k].place(Vector([0.05, 0.0]));
            assert!((exit - entry).length() < 1e-12);
        }
        heading += turns[k];
    }
}

#[test]
fn what_does_not_fit_is_named() {
    let error = |stages: &[Stage]| compose(stages).unwrap_err();
    let told = |stages: &[Stage]| error(stages).to_string();
    assert!(told(&[]).contains("no stage"));
    assert!(told(&[Stage { exit: None, ..funnel() }, sieve()]).contains("`funnel` has no exit"));
    let mut field = sieve();
    field.construct.units = Units::Field;
    assert!(told(&[funnel(), field]).contains("field"));
    let mut early = funnel();
    early.exit = Some(port(-1.5, 0.0, 180.0));
    let mut wall = stage("wall", walls(&[[-2.1, -5.0, -2.1, 5.0]]), port(-2.0, 0.0, 0.0), port(9.0, 0.0, 0.0));
    wall.entry.region = Shape::Ball { centre: Vector([-3.0, 0.0]), radius: 0.4 };
    let misfit = error(&[early, wall]);
    assert_eq!(misfit, TerrainError::Misfit("a wall of `wall` stands where `funnel` hands over".into()));
    // a post counts as a wall does
    let mut posts = sieve();
    posts.entry = port(0.0, -0.3, 90.0);
    posts.entry.region = Shape::Ball { centre: Vector([0.0, -0.3]), radius: 0.05 };
    let mut wide = funnel();
    wide.exit.as_mut().unwrap().region = Shape::Ball { centre: Vector([2.5, 0.0]), radius: 0.25 };
    assert!(told(&[wide, posts]).contains("a wall of `sieve` stands where `funnel` hands over"));
    // the next stage begins in a closed room
    let square = [[-1., -1.6, 1., -1.6], [1., -1.6, 1., 1.], [1., 1., -1., 1.], [-1., 1., -1., -1.6]];
    let shut = stage("shut", walls(&square), port(0.0, -1.0, 90.0), port(0.0, 0.5, 90.0));
    let closed = error(&[funnel(), shut]);
    let what = "no body fits through from the entry of `funnel` to that of `shut`";
    assert_eq!(closed, TerrainError::Misfit(what.into()));
    // the chute is 1 wide, and the exit beside its end
    let thick = Stage { clearance: 0.6, exit: Some(port(1.8, 0.0, 0.0)), ..funnel() };
    let thin = Stage { clearance: 0.4, ..thick.clone() };
    assert!(told(&[thick, sieve()]).contains("no body fits") && compose(&[thin, sieve()]).is_ok());
    assert!(compose(&[Stage { clearance: 0.0, ..funnel() }, sieve()]).is_err());
}
