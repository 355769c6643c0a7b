//! Texts are read back as they were written, and wrong ones refused with their line.

#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::construct::{Environment, Placement};
use crate::schema::Schema;
use crate::schemas::{self, dsdr::Dsdr, galton::Galton};
use crate::{Construct, Units, grammars, workspaces};
use space::Vector;

/// One environment of each grammar and schema.
fn environments() -> Vec<Environment> {
    let mut all = Vec::new();
    let mut place = |workspace: &Workspace, construct: Construct| {
        all.push(Environment::place(workspace, construct, Placement::Keep).unwrap().unwrap());
    };
    for name in grammars::LIST {
        let grammar = grammars::find(name).unwrap();
        let workspace =
            if grammar.units == Units::Field { workspaces::field(Some(300.0)) } else { workspaces::arena(10.0) };
        place(&workspace, grammar.construct(3, 1).unwrap());
    }
    for schema in schemas::all().into_iter().filter(|schema| schema.card().id != "dsdr") {
        let junction = workspaces::t_junction(2.0, workspaces::Stem::South);
        let values = schema.card().values(&[]).unwrap();
        place(&junction, schema.construct(&values, &junction, 3, 1).unwrap());
    }
    let corridor = workspaces::dsdr_corridor();
    place(&corridor, Dsdr.construct(&[10.0, 3.0, 0.1, 7.0], &corridor, 0, 0).unwrap());
    all
}

fn geometry(environment: &Environment) -> Vec<Geometry> {
    environment.geometry().cloned().collect()
}

#[test]
fn geometry_comes_back_from_wkt_and_svg() {
    for environment in environments() {
        let all = geometry(&environment);
        let found = wkt::read(&wkt::write(&all), 0.0).unwrap();
        assert_eq!(found.len(), all.len());
        for (found, expected) in found.iter().zip(&all) {
            match (found, expected) {
                // a circle is written by two points of it
                (Geometry::Disc { centre, radius }, Geometry::Disc { centre: at, radius: r })
                | (Geometry::Circle { centre, radius }, Geometry::Circle { centre: at, radius: r }) => {
                    assert!((*centre - *at).length() < 1e-12 && (radius - r).abs() < 1e-12);
                }
                _ => assert_eq!(found, expected),
            }
        }
        assert_eq!(svg::read(&svg::write(&environment)).unwrap(), all);
    }
    assert_eq!(wkt::write(&[]), "GEOMETRYCOLLECTION EMPTY");
    assert_eq!(wkt::read("GEOMETRYCOLLECTION EMPTY", 0.0), Ok(vec![]));
}

#[test]
fn everything_comes_back_from_geojson() {
    for environment in environments() {
        let text = geojson::write(&environment);
        let found = geojson::read(&text).unwrap();
        assert_eq!(geometry(&found), geometry(&environment));
        assert_eq!(found.construct.markers, environment.construct.markers);
        assert_eq!(found.construct.pieces, environment.construct.pieces);
        assert_eq!(found.construct.hash(), environment.construct.hash());
        let (there, here) = (&found.workspace, &environment.workspace);
        assert_eq!((&there.anchors, &there.gates, &there.boundary), (&here.anchors, &here.gates, &here.boundary));
        assert_eq!((&there.name, there.units, there.regions.len()), (&here.name, here.units, here.regions.len()));
        let provenance = &environment.construct.provenance;
        assert_eq!(
            (&found.construct.provenance.schema, found.construct.provenance.seed),
            (&provenance.schema, provenance.seed)
        );
        assert_eq!(geojson::write(&found), text, "a second time");
    }
}

#[test]
fn wkt_of_others() {
    let read = |text: &str| wkt::read(text, 0.5).unwrap();
    let walls =
        |all: &[Geometry]| all.iter().flat_map(Geometry::segments).map(|wall| wall.numbers()).collect::<Vec<_>>();
    assert_eq!(walls(&read("linestring(0 0,1 0 , 1 2)")), [[0., 0., 1., 0.], [1., 0., 1., 2.]]);
    assert_eq!(read("POINT (1 2)"), [Geometry::Disc { centre: Vector([1.0, 2.0]), radius: 0.5 }]);
    assert_eq!(read("MULTIPOINT ((1 2), (3 4))").len(), 2);
    assert_eq!(read("MULTIPOINT (1 2, 3 4)").len(), 2);
    assert_eq!(read("POLYGON ((0 0, 4 0, 0 4, 0 0), (1 1, 2 1, 1 2, 1 1))").len(), 2, "with a hole");
    assert_eq!(read("MULTIPOLYGON (((0 0, 4 0, 0 4, 0 0)), ((9 9, 8 9, 8 8, 9 9)))").len(), 2);
    assert_eq!(read("LINESTRING Z EMPTY;".replace(" Z", "").as_str()).len(), 0);
    assert_eq!(read("LINESTRING (0 0 7, 1e0 -.5 7)").len(), 1, "heights are left aside");
    assert_eq!(read("POINT (1 2); LINESTRING (0 0, 1 1)\nPOINT (3 3)").len(), 3);
    let wrong = |text: &str| wkt::read(text, 0.0).unwrap_err().to_string();
    assert!(
        wrong("POINT (1 2)\nLINESTRNG (0 0, 1 1)")
            .starts_with("line 2: unknown geometry `LINESTRNG`; did you mean `LINESTRING`")
    );
    assert!(wrong("LINESTRING (0 0, 1)").contains("a finite number"));
    assert!(wrong("LINESTRING (0 0, 1 nan)").contains("a finite number"));
    assert!(wrong("LINESTRING (0 0, 1 1").contains("`)`, found the end"));
    assert!(wrong("CIRCULARSTRING (0 0, 1 1, 2 0)").contains("full circle"));
    assert!(wrong(&"GEOMETRYCOLLECTION (".repeat(200)).contains("nested"));
}

#[test]
fn svg_of_others() {
    let read = |inner: &str| svg::read(&format!("<?xml version=\"1.0\"?>\n<svg xmlns='x'>{inner}</svg>"));
    let walls = |inner: &str| {
        read(inner).unwrap().iter().flat_map(Geometry::segments).map(|wall| wall.numbers()).collect::<Vec<_>>()
    };
    assert_eq!(walls("<line x1='1' y1='2' x2='3px' y2=\"-4\"/>"), [[1., -2., 3., 4.]]);
    assert_eq!(walls("<g><path d='M0 0h2v3 l-1,0'/></g>"), [[0., 0., 2., 0.], [2., 0., 2., -3.], [2., -3., 1., -3.]]);
    assert_eq!(walls("<path d='m1 1 2 0 0 2z m5 5 H9'/>").len(), 4);
    assert_eq!(walls("<path d='M0,0L1-1'/>"), [[0., 0., 1., 1.]], "a sign parts numbers");
    assert_eq!(walls("<polyline points='0,0 1,0 1,1'/>").len(), 2);
    assert_eq!(walls("<polygon points='0 0 1 0 1 1'/>").len(), 3);
    assert_eq!(walls("<rect x='1' y='1' width='2' height='1'/>")[0], [1., -2., 3., -2.]);
    assert_eq!(
        read("<circle cx='1' cy='2' r='3' fill='none'/>").unwrap(),
        [Geometry::Circle { centre: Vector([1.0, -2.0]), radius: 3.0 }]
    );
    assert_eq!(walls("<!-- <line x1='1'/> --><defs><line x1='1'/></defs><text x='1'>a</text>").len(), 0);
    let wrong = |inner: &str| read(inner).unwrap_err().to_string();
    assert!(wrong("\n<path d='M0 0 C1 1 2 2 3 3'/>").starts_with("line 3: path: `C` is not read"));
    assert!(wrong("<line x1='a'/>").contains("x1: expected a finite number, found `a`"));
    assert!(wrong("<line transform='scale(2)'/>").contains("transform"));
    assert!(wrong("<polygon points='0 0 1'/>").contains("pairs"));
    assert!(wrong("<path d='L1 1'/>").contains("expected M first"));
    assert!(wrong("<path d='M1'/>").contains("lacks a number"));
    assert!(wrong("<line x1='1").contains("closing quote"));
    assert!(svg::read("<html/>").unwrap_err().to_string().contains("`svg`"));
    assert!(svg::read("").is_err());
}

#[test]
fn geojson_of_others() {
    let bare =
        geojson::read(r#"{"type": "LineString", "coordinates": [[0, 0], [1, 0, 7], [1, 2]], "bbox": null}"#).unwrap();
    assert_eq!((bare.workspace.geometry.len(), bare.workspace.units), (2, Units::Metres));
    let feature = r#"{"type": "Feature", "properties": {"role": "gate", "name": "a \"b\" \u00e9\n"}, "geometry":
        {"type": "LineString", "coordinates": [[0, 0], [1e1, -0.5]]}}"#;
    assert_eq!(geojson::read(feature).unwrap().workspace.gates[0].0, "a \"b\" \u{e9}\n");
    let wrong = |text: &str| geojson::read(text).unwrap_err().to_string();
    assert!(wrong("{\n\"type\": \n}").starts_with("line 3"));
    assert!(wrong("[]").contains("`type`"));
    assert!(wrong(&feature.replace("gate", "gat")).contains("features[0]: unknown role `gat`; did you mean `gate`?"));
    assert!(wrong(&feature.replace("gate", "anchor")).contains("cannot be of the role `anchor`"));
    assert!(wrong(r#"{"type": "Polygn"}"#).contains("unknown geometry `Polygn`"));
    assert!(wrong(r#"{"type": "Point", "coordinates": [1]}"#).contains("two numbers"));
    assert!(wrong(r#"{"type": "Point", "units": "feet"}"#).contains("feet"));
    assert!(wrong(&"[".repeat(500)).contains("nested"));
    assert!(wrong("{\"a").contains("closing quote"));
}

#[test]
fn derivations_are_drawn_step_by_step() {
    let grammar = grammars::find("splitting").unwrap();
    let derivation = (0..).map(|k| grammar.derive(1, k).unwrap()).find(|d| d.steps.len() > 4).unwrap();
    for step in 0..=derivation.steps.len() {
        let drawing = svg::derivation(&grammar, &derivation, step);
        assert_eq!(drawing.matches("nonterminal\" fill").count() > 0, derivation.after(step).any(|i| i.shape == 1));
        assert_eq!(svg::read(&drawing).unwrap().len(), derivation.after(step).count());
    }
    assert!(svg::derivation(&grammar, &derivation, 0).contains("splitting, start"));
    let board = Galton.construct(&Galton.card().values(&[]).unwrap(), &workspaces::arena(10.0), 0, 0).unwrap();
    let drawn = svg::write(&Environment::place(&workspaces::arena(10.0), board, Placement::Keep).unwrap().unwrap());
    assert_eq!(drawn.matches(">+</text>").count(), 9, "a mark in each bin");
}
