//! Two objects swap in a corridor with a bay: the instance, a plan, and its tunnels as an oblique projection (SVG on
//! standard output, everything else before it as a comment).

#![allow(clippy::print_stdout, reason = "an example")]

use terrain::reduction::{Fraction, TunnelPiece, Warehouse, check_tunnels, solve_small, tunnels};

/// Of the objects, in their order; they can be told apart by whoever does not see all colours.
const COLOURS: [&str; 4] = ["#0072b2", "#e69f00", "#009e73", "#cc79a7"];
/// Lengths of a unit across, back and up, in the picture.
const ACROSS: f64 = 90.0;
const BACK: (f64, f64) = (38.0, 26.0);
const UP: f64 = 62.0;
/// Where the corner of the box stands, and the size of the picture.
const FOOT: (f64, f64) = (60.0, 520.0);
const SIZE: (f64, f64) = (520.0, 570.0);

fn project([x, y, z]: [f64; 3]) -> String {
    format!("{:.1},{:.1}", FOOT.0 + ACROSS * x + BACK.0 * y, FOOT.1 - UP * z - BACK.1 * y)
}

fn polygon(corners: &[[f64; 3]], style: &str) {
    let points: Vec<String> = corners.iter().map(|&corner| project(corner)).collect();
    println!("<polygon points=\"{}\" {style}/>", points.join(" "));
}

/// The corners of an object's cross-section.
fn section(instance: &Warehouse, agent: usize, end: [Fraction; 3]) -> [[f64; 3]; 4] {
    let [w, h] = instance.rectangles[agent].map(|side| side as f64 / 2.0);
    let [x, y, z] = end.map(Fraction::number);
    [[-w, -h], [w, -h], [w, h], [-w, h]].map(|[dx, dy]| [x + dx, y + dy, z])
}

fn draw(instance: &Warehouse, pieces: &[TunnelPiece]) {
    println!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"15\" \
         stroke-linejoin=\"round\"><title>Tunnels of a warehouse</title>",
        SIZE.0, SIZE.1
    );
    let [width, depth] = instance.size.map(|side| side as f64);
    let height = pieces.iter().map(|piece| piece.to[2].number()).fold(0.0, f64::max);
    let floor = |z: f64| [[0.0, 0.0, z], [width, 0.0, z], [width, depth, z], [0.0, depth, z]];
    polygon(&floor(0.0), "fill=\"#808080\" fill-opacity=\"0.12\" stroke=\"#808080\"");
    // what is further back and lower comes first
    let mut order: Vec<&TunnelPiece> = pieces.iter().collect();
    let depth_of = |piece: &TunnelPiece| piece.from[1].number() + piece.to[1].number();
    order.sort_by(|a, b| a.from[2].number().total_cmp(&b.from[2].number()).then(depth_of(b).total_cmp(&depth_of(a))));
    for piece in order {
        let colour = COLOURS[piece.agent % COLOURS.len()];
        let (low, high) = (section(instance, piece.agent, piece.from), section(instance, piece.agent, piece.to));
        let face = format!("fill=\"{colour}\" fill-opacity=\"0.28\" stroke=\"{colour}\" stroke-width=\"1.2\"");
        // back, left, right, front
        for (a, b) in [(2, 3), (3, 0), (1, 2), (0, 1)] {
            polygon(&[low[a], low[b], high[b], high[a]], &face);
        }
    }
    for piece in pieces.iter().filter(|piece| piece.to[2].number() == height) {
        let colour = COLOURS[piece.agent % COLOURS.len()];
        let top = section(instance, piece.agent, piece.to);
        polygon(&top, &format!("fill=\"{colour}\" fill-opacity=\"0.75\" stroke=\"{colour}\""));
    }
    polygon(&floor(height), "fill=\"none\" stroke=\"#808080\" stroke-dasharray=\"4 4\"");
    for time in 0..=height as usize {
        let (x, y) = (FOOT.0 - 14.0, FOOT.1 - UP * time as f64 + 5.0);
        println!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\" fill=\"#808080\">{time}</text>");
    }
    println!("<text x=\"8\" y=\"{}\" fill=\"#808080\">time, upwards</text></svg>", SIZE.1 - 12.0);
}

fn main() {
    let centre = |x: i64, y: i64| [Fraction::new(x, 2), Fraction::new(y, 2)].map(|half| half.unwrap_or(0.into()));
    let instance = Warehouse {
        size: [3, 3],
        rectangles: vec![[1, 1], [1, 1], [1, 2], [1, 2]],
        start: vec![centre(1, 1), centre(5, 1), centre(1, 4), centre(5, 4)],
        goal: vec![centre(5, 1), centre(1, 1), centre(1, 4), centre(5, 4)],
    };
    let Some(plan) = solve_small(&instance, 100_000) else { return };
    println!("<!-- a box of {} x {}", instance.size[0], instance.size[1]);
    for (agent, [width, height]) in instance.rectangles.iter().enumerate() {
        let [from, to] = [&instance.start, &instance.goal].map(|ends| &ends[agent]);
        println!("object {agent}: {width} x {height}, from ({}, {}) to ({}, {})", from[0], from[1], to[0], to[1]);
    }
    for (time, places) in plan.iter().enumerate() {
        let places: Vec<String> = places.iter().map(|[x, y]| format!("({x}, {y})")).collect();
        println!("time {time}: {}", places.join(" "));
    }
    let pieces = tunnels(&plan);
    println!("tunnels: {:?} -->", check_tunnels(&instance, &pieces));
    draw(&instance, &pieces);
}
