//! Two objects swap in a corridor with a bay: the instance, a plan, and its tunnels as an oblique projection (SVG on
//! standard output, everything else before it as a comment).

#![allow(clippy::print_stdout, reason = "an example")]

use terrain::geometry::{Geometry, Units};
use terrain::reduction::{Fraction, Warehouse, check_tunnels, solve_small, tunnels};
use terrain::text::svg;
use terrain::{Construct, Environment, Piece, Placement, TerrainError, workspaces};

fn main() -> Result<(), TerrainError> {
    let centre = |x: i64, y: i64| [Fraction::new(x, 2), Fraction::new(y, 2)].map(|half| half.unwrap_or(0.into()));
    let instance = Warehouse {
        size: [3, 3],
        rectangles: vec![[1, 1], [1, 1], [1, 2], [1, 2]],
        start: vec![centre(1, 1), centre(5, 1), centre(1, 4), centre(5, 4)],
        goal: vec![centre(5, 1), centre(1, 1), centre(1, 4), centre(5, 4)],
    };
    let Some(plan) = solve_small(&instance, 100_000) else { return Ok(()) };
    println!("<!-- {instance:?}");
    for (time, places) in plan.iter().enumerate() {
        let places: Vec<String> = places.iter().map(|[x, y]| format!("({x}, {y})")).collect();
        println!("time {time}: {}", places.join(" "));
    }
    let pieces = tunnels(&plan);
    println!("tunnels: {:?} -->", check_tunnels(&instance, &pieces));
    // heights go up, depth goes back to the right
    let project = |[x, y, z]: [f64; 3]| space::Vector([x + 0.4 * y, 0.7 * z + 0.3 * y]);
    let edges = pieces.iter().flat_map(|piece| {
        let [w, h] = instance.rectangles[piece.agent].map(|side| side as f64 / 2.0);
        let number = |end: [Fraction; 3]| end.map(Fraction::number);
        let (from, to) = (number(piece.from), number(piece.to));
        [[-w, -h], [w, -h], [w, h], [-w, h]].map(|[x, y]| {
            let corner = |end: [f64; 3]| project([end[0] + x, end[1] + y, end[2]]);
            Piece { name: format!("tunnel {}", piece.agent), geometry: vec![Geometry::wall(corner(from), corner(to))] }
        })
    });
    let mut construct = Construct::new(Units::Metres, edges.collect());
    construct.provenance.schema = "tunnels of a warehouse".into();
    let drawn = Environment::place(&workspaces::empty(Units::Metres), construct, Placement::Keep)?;
    if let Some(environment) = drawn {
        println!("{}", svg::write(&environment));
    }
    Ok(())
}
