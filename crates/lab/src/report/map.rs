//! Maps of a parameter space as static SVG: cells by what was found in them, or symbols at their centres.

use super::escape::markup;
use super::number::{axis_title, place};
use super::ticks::ticks;
use super::{Map, MapCell, MapPanel};
use core::fmt::Write;

/// Width and height of a panel, and of its plot.
const WIDTH: f64 = 400.0;
const LEFT: f64 = 62.0;
const TOP: f64 = 10.0;
pub(super) const PLOT: (f64, f64) = (322.0, 250.0);
const HEIGHT: f64 = 306.0;
/// About so many marks along an axis.
const TICKS: usize = 5;

/// A panel as SVG.
pub(super) fn panel(map: &Map, panel: &MapPanel) -> String {
    let ends = |axis: &super::Axis| axis.range.unwrap_or((0.0, 1.0));
    let (x_ends, y_ends) = (ends(&map.x), ends(&map.y));
    let x = |value: f64| LEFT + (value - x_ends.0) / (x_ends.1 - x_ends.0) * PLOT.0;
    let y = |value: f64| TOP + PLOT.1 - (value - y_ends.0) / (y_ends.1 - y_ends.0) * PLOT.1;
    let mut svg = String::new();
    // writing to a string cannot fail, here and below
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scene map\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" \
         aria-label=\"{}\"><rect class=\"floor\" x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\"/>",
        markup(&panel.caption),
        PLOT.0,
        PLOT.1
    );
    for cell in &panel.cells {
        let (left, top) = (x(cell.low[0]), y(cell.high[1]));
        let (width, height) = (x(cell.high[0]) - left, y(cell.low[1]) - top);
        let rate = cell.rate.clamp(0.0, 1.0);
        if map.areas && rate > 0.0 {
            let _ = write!(
                svg,
                "<rect class=\"rate\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill-opacity=\"{}\"/>",
                place(left),
                place(top),
                place(width),
                place(height),
                place(0.08 + 0.92 * rate)
            );
        }
        let (cx, cy) = (left + width / 2.0, top + height / 2.0);
        let arm = (width.min(height) * 0.35).clamp(0.6, 4.0);
        if cell.valid {
            let _ = write!(
                svg,
                "<path class=\"plus\" d=\"M{} {}h{}M{} {}v{}\"/>",
                place(cx - arm),
                place(cy),
                place(2.0 * arm),
                place(cx),
                place(cy - arm),
                place(2.0 * arm)
            );
        } else if !map.areas {
            let _ = write!(
                svg,
                "<circle class=\"not\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
                place(cx),
                place(cy),
                place(arm * 0.45)
            );
        }
    }
    let _ = write!(svg, "<rect class=\"frame\" x=\"{LEFT}\" y=\"{TOP}\" width=\"{}\" height=\"{}\"/>", PLOT.0, PLOT.1);
    let marks = ticks(x_ends, TICKS);
    for (&at, label) in marks.places.iter().zip(&marks.labels) {
        let (x, y) = (place(x(at)), place(TOP + PLOT.1 + 16.0));
        let _ = write!(svg, "<text class=\"tick\" text-anchor=\"middle\" x=\"{x}\" y=\"{y}\">{label}</text>");
    }
    let marks = ticks(y_ends, TICKS);
    for (&at, label) in marks.places.iter().zip(&marks.labels) {
        let (x, y) = (place(LEFT - 6.0), place(y(at) + 4.0));
        let _ = write!(svg, "<text class=\"tick\" text-anchor=\"end\" x=\"{x}\" y=\"{y}\">{label}</text>");
    }
    let _ = write!(
        svg,
        "<text class=\"view\" text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text>\
         <text class=\"view\" text-anchor=\"middle\" transform=\"translate(13 {}) rotate(-90)\">{}</text></svg>",
        place(LEFT + PLOT.0 / 2.0),
        place(HEIGHT - 10.0),
        markup(&axis_title(&map.x.label, &map.x.unit)),
        place(TOP + PLOT.1 / 2.0),
        markup(&axis_title(&map.y.label, &map.y.unit))
    );
    svg
}

/// The cells of a panel as CSV.
pub(super) fn data(map: &Map, panel: &MapPanel) -> String {
    let mut csv = format!("{0}_low,{0}_high,{1}_low,{1}_high,rate,valid\n", map.x.label, map.y.label);
    for MapCell { low, high, rate, valid } in &panel.cells {
        let _ = writeln!(csv, "{},{},{},{},{rate},{}", low[0], high[0], low[1], high[1], u8::from(*valid));
    }
    csv
}
