//! What holds of the computational schemas.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::filters::{Filter, SelfCrossing};
use crate::workspaces::{Stem, dsdr_corridor, t_junction};
use crate::{Draws, Geometry, escapes, escapes_with_clearance};

fn junction() -> Workspace {
    t_junction(2.0, Stem::South)
}

#[test]
fn every_schema_builds_from_its_defaults_and_within_its_domain_alone() {
    for schema in all() {
        let card = schema.card();
        let workspace = if card.id == "dsdr" { dsdr_corridor() } else { junction() };
        let values = card.values(&[]).unwrap();
        let construct = schema.construct(&values, &workspace, 5, 0).unwrap();
        assert_eq!(schema.construct(&values, &workspace, 5, 0).unwrap(), construct);
        assert!(!construct.pieces.is_empty() && construct.geometry().all(|g| g.points().iter().all(|p| p.finite())));
        assert_eq!(construct.provenance.parameters.len(), values.len());
        assert!(SelfCrossing.check(&construct, &workspace).pass, "{}", card.id);
        assert!(schema.construct(&values[1..], &workspace, 5, 0).is_err());
        for (k, parameter) in card.parameters.iter().enumerate() {
            assert!(parameter.domain.holds(parameter.default), "{} {}", card.id, parameter.name);
            for bad in [parameter.domain.bounds().1 + 1.0, f64::NAN] {
                let mut values = values.clone();
                values[k] = bad;
                let error = schema.construct(&values, &workspace, 5, 0).unwrap_err().to_string();
                assert!(error.contains(&*parameter.name), "{error}");
            }
        }
        assert!(card.values(&[("no such", 1.0)]).is_err());
    }
    assert!(find("dirtt").err().unwrap().to_string().contains("did you mean `dirt`"));
}

#[test]
fn anchored_walls_of_one_and_of_two() {
    let wall = dirt::Dirt.construct(&[200.0, 2.0, 4.0], &junction(), 0, 0).unwrap().walls()[0];
    let expected = [1.0, 2.0, -0.879_385_241_571_816_9, 1.315_959_713_348_662_7];
    assert!(wall.numbers().iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12));
    let unknown = dirt::Dirt.construct(&[200.0, 2.0, 9.0], &junction(), 0, 0).unwrap_err();
    assert!(unknown.to_string().contains("anchor `9`"));
    let walls = dsdr::Dsdr.construct(&[30.0, 2.0, 0.0, 4.0], &dsdr_corridor(), 0, 0).unwrap().walls();
    assert!((walls[0].to - Vector([-8.0 + 3f64.sqrt(), 1.0])).length() < 1e-12, "it leans the way the group goes");
    assert_eq!(walls[1].to, Vector([4.0, 0.0]));
    assert!(dsdr::Dsdr.construct(&[30.0, 2.0, 0.0, 4.0], &crate::workspaces::field(None), 0, 0).is_err(), "units");
    let two = itb::Itb { walls: 2 }.construct(&[0., 0., 90., 1., 1., 1., 0., 2.], &junction(), 0, 0).unwrap().walls();
    assert_eq!(two.iter().map(Segment::numbers).collect::<Vec<_>>(), [[0., 0., 0., 1.], [1., 1., 3., 1.]]);
}

#[test]
fn steps_follow_their_rules_and_chances() {
    let diagonal = sirt::points(Vector([1.0, 2.0]), -0.5, -0.25, &[3, 3, 3, 3]).unwrap();
    assert_eq!(diagonal, [[0.5, 1.75], [0.0, 1.5], [-0.5, 1.25], [-1.0, 1.0]].map(Vector));
    assert!(sirt::points(Vector([0.0, 0.0]), 1.0, 1.0, &[0]).is_err());
    let schema = sirt::Sirt::default();
    let only = |p1: f64, p2: f64, attempt: u64| {
        schema.construct(&[p1, p2, 21.0, -0.1, -0.1, 4.0], &junction(), 1, attempt).unwrap().walls()
    };
    assert_eq!(only(0.0, 0.0, 0).len(), 20);
    assert!((only(1.0, 0.0, 0)[19].to - Vector([-1.0, 2.0])).length() < 1e-12);
    assert!((only(0.0, 0.0, 0)[19].to - Vector([-1.0, 0.0])).length() < 1e-12);
    let along_x: usize =
        (0..200).map(|attempt| only(0.25, 0.5, attempt).iter().filter(|w| w.to[1] == w.from[1]).count()).sum();
    assert!((along_x as f64 / 4000.0 - 0.25).abs() < 0.03, "{along_x} of 4000");
    assert!(schema.construct(&[0.6, 0.6, 21.0, -0.1, -0.1, 4.0], &junction(), 1, 0).is_err());
    let discs =
        sirt::Sirt { join: sirt::Join::Points }.construct(&[0., 0., 5., -0.1, -0.2, 4.], &junction(), 1, 0).unwrap();
    assert!(discs.geometry().all(|g| matches!(g, Geometry::Disc { radius, .. } if *radius == 0.1)));
    let free = sirt::PointGrammar { moves: vec![], weights: vec![], within: Some(2.0), k: 50 };
    let points = free.points(Vector([0.0, 0.0]), &Draws::new(1, 0, 0));
    assert!(points.len() == 49 && points.windows(2).all(|two| (two[1] - two[0]).length() <= 2.0));
}

#[test]
fn independent_walkers_fill_the_bins_binomially() {
    // each passes left or right of the peg below it with equal chance, and lands on a peg of the next row
    let rows = 8;
    let board = galton::Galton;
    let construct = board.construct(&board.card().values(&[]).unwrap(), &junction(), 0, 0).unwrap();
    let pegs = galton::pegs(rows, 2.0);
    assert_eq!(construct.pieces.iter().filter(|piece| piece.name == "peg").count(), pegs.len());
    let mut counts = vec![0.0; rows + 1];
    for walker in 0..2000 {
        let mut x = 0.0;
        for row in 0..rows {
            assert!(pegs.iter().any(|peg| (*peg - Vector([x, -(row as f64 + 1.0) * 2.0])).length() < 1e-9));
            x += if Draws::new(3, walker, row as u64).uniform("side", 0) < 0.5 { -1.0 } else { 1.0 };
        }
        counts[galton::bin(x, rows, 2.0)] += 1.0;
    }
    let choose = [1.0, 8.0, 28.0, 56.0, 70.0, 56.0, 28.0, 8.0, 1.0].map(|c: f64| c / 256.0 * 2000.0);
    let chi: f64 = counts.iter().zip(choose).map(|(found, expected)| (found - expected).powi(2) / expected).sum();
    assert!(chi < 20.09, "chi-square {chi} with 8 degrees of freedom, p < 0.01: {counts:?}");
    assert_eq!([galton::bin(-99.0, rows, 2.0), galton::bin(99.0, rows, 2.0)], [0, rows]);
    // the middle of each bin is in that bin
    for (k, marker) in construct.markers.iter().enumerate() {
        assert_eq!(galton::bin(marker.pose.at[0], rows, 2.0), k);
    }
}

#[test]
fn traps_hold_bodies_and_let_points_out() {
    let weir = weir::Weir;
    let values = weir.card().values(&[]).unwrap();
    let construct = weir.construct(&values, &junction(), 0, 0).unwrap();
    let pot = construct.markers[0].pose.at;
    assert!(escapes(&construct.walls(), pot), "a point finds its way out");
    assert_eq!(escapes_with_clearance(&construct.walls(), pot, 0.35), Ok(false), "the throat is half a gate wide");
    assert_eq!(escapes_with_clearance(&construct.walls(), pot, 0.15), Ok(true));
    assert!(weir.construct(&[8.0, 1.0, 2.0, 1.0, 0.0], &junction(), 0, 0).unwrap_err().to_string().contains("gate"));
    let pen = pen::Pen.construct(&pen::Pen.card().values(&[("gates", 0.0)]).unwrap(), &junction(), 0, 0).unwrap();
    let exit = pen.markers.last().unwrap().pose.at;
    assert!(!pen.walls().iter().any(|wall| wall.distance(exit) < 0.49), "the chute is as wide as it says");
    let narrow = pen::Pen.construct(&[6.0, 30.0, 1.0, 0.4, 2.0], &junction(), 0, 0).unwrap_err();
    assert!(narrow.to_string().contains("curve_radius"));
    let sieve = sieve::Sieve.construct(&[3.0, 0.5, 90.0, 0.1], &junction(), 0, 0).unwrap();
    let heights: Vec<f64> = sieve.geometry().map(|g| g.points()[0][1]).collect();
    assert!(heights.iter().zip([-0.7, 0.0, 0.7]).all(|(found, expected)| (found - expected).abs() < 1e-12));
    let funnel = funnel::Funnel.construct(&[3.0, 1.0, 45.0, 2.0], &junction(), 0, 0).unwrap().walls();
    assert!((funnel[0].from - Vector([-1.0, 1.5])).length() < 1e-12 && funnel[1].to == Vector([2.0, 0.5]));
    assert!(funnel::Funnel.construct(&[1.0, 3.0, 45.0, 2.0], &junction(), 0, 0).is_err());
}
