//! Line charts as static SVG, and the data behind them for the read-out.

use super::escape::markup;
use super::number::{axis_title, number, place};
use super::palette::{DASHES, SERIES};
use super::ticks::{FURTHEST, Ticks, ends, rounded_ends, ticks};
use super::{Line, Lines, Means};
use core::fmt::Write;
use serde_json::{Value, json};

/// Width of a chart; the page scales it to its column.
const WIDTH: f64 = 400.0;
/// Height of the plot alone.
const PLOT_HEIGHT: f64 = 180.0;
/// Width of an average letter of the labels.
const LETTER: f64 = 6.6;
/// Height of a row of the legend.
const ROW: f64 = 18.0;
/// Length of the stroke beside a name in the legend.
const SAMPLE: f64 = 24.0;
/// Columns in which a line keeps its extremes, per unit of the drawing.
const COLUMNS: f64 = 2.0;

/// About how many marks the axes have.
const X_MARKS: usize = 6;
const Y_MARKS: usize = 5;

/// A chart, ready for the page.
pub(super) struct Chart {
    /// The drawing.
    pub(super) svg: String,
    /// Data and scales, for the read-out and for the download as CSV.
    pub(super) data: Value,
}

/// The rectangle of the plot and the ends of its axes.
struct Plot {
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x: (f64, f64),
    y: (f64, f64),
    /// Room below the horizontal axis for names that stand aslant; zero where they do not.
    slant: f64,
}

impl Plot {
    fn across(&self, x: f64) -> f64 {
        self.left + (x.clamp(-FURTHEST, FURTHEST) - self.x.0) / (self.x.1 - self.x.0) * (self.right - self.left)
    }
    fn down(&self, y: f64) -> f64 {
        self.bottom - (y.clamp(-FURTHEST, FURTHEST) - self.y.0) / (self.y.1 - self.y.0) * (self.bottom - self.top)
    }
}

/// Draws a chart.
pub(super) fn chart(lines: &Lines, id: &str) -> Chart {
    drawn(lines, None, id)
}

/// Draws means with their spread.
pub(super) fn means(means: &Means, id: &str) -> Chart {
    drawn(&means.lines, Some(means), id)
}

fn drawn(lines: &Lines, means: Option<&Means>, id: &str) -> Chart {
    let names = means.map_or(&[][..], |means| &means.names);
    let values = || lines.lines.iter().flat_map(points);
    let y_values = || values().filter_map(|(_, y)| y);
    let bars = || means.into_iter().flat_map(whiskers).flat_map(|whisker| [whisker.low, whisker.high]);
    let y = match lines.y.range {
        Some(_) => ends(lines.y.range, y_values()),
        None => rounded_ends(ends(None, y_values().chain(bars())), Y_MARKS),
    };
    let y_ticks = ticks(y, Y_MARKS);
    let widest = y_ticks.labels.iter().map(|label| label.chars().count()).max().unwrap_or(0);
    let mut left = (widest as f64 * LETTER + 10.0).clamp(24.0, 120.0);
    let right = WIDTH - 14.0;
    let mut slant = 0.0;
    let (x, x_ticks) = if names.is_empty() {
        let x = ends(lines.x.range, values().map(|(x, _)| x));
        (x, ticks(x, X_MARKS))
    } else {
        // each name has its share of the width, less a gap; longer ones stand aslant
        let room = ((right - left) / names.len() as f64 / LETTER - 1.0).max(3.0) as usize;
        let longest = names.iter().map(|name| name.chars().count().min(SLANTED)).max().unwrap_or(0);
        if longest > room {
            slant = longest as f64 * LETTER * SLOPE;
            // the first name must not leave the drawing
            let first = names[0].chars().count().min(SLANTED) as f64 * LETTER * LEVEL;
            left = left.max(first - (right - left) / (2.0 * names.len() as f64));
        }
        let labels = names.iter().map(|name| markup(&shortened(name, SLANTED))).collect();
        let x_ticks = Ticks { places: (0..names.len()).map(|k| k as f64).collect(), labels, step: 1.0 };
        ((-0.5, names.len() as f64 - 0.5), x_ticks)
    };
    let legend = Legend::of(&lines.lines, WIDTH);
    let top = legend.height + 26.0;
    let plot = Plot { left, right, top, bottom: top + PLOT_HEIGHT, x, y, slant };
    let height = plot.bottom + 42.0 + slant;
    let mut svg = String::new();
    let description = describe(lines, y_values());
    // writing to a string cannot fail, here and below
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"chart\" viewBox=\"0 0 {WIDTH} {}\" role=\"img\" \
         aria-label=\"{}\">",
        place(height),
        markup(&description)
    );
    legend.draw(&mut svg);
    axes(&mut svg, lines, &plot, &x_ticks, &y_ticks);
    if y_values().next().is_none() {
        let (middle, centre) = ((plot.left + plot.right) / 2.0, (plot.top + plot.bottom) / 2.0);
        let _ = write!(
            svg,
            "<text class=\"none\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">no values</text>",
            place(middle),
            place(centre)
        );
    }
    for (index, line) in lines.lines.iter().enumerate() {
        // between names there is nothing that a line could stand for
        if names.is_empty() {
            draw_line(&mut svg, line, &plot, index);
        }
    }
    if let Some(means) = means {
        draw_means(&mut svg, means, &plot);
    }
    svg.push_str("</svg>");
    Chart { svg, data: data(lines, means, id, &plot) }
}

/// A mean with its bar.
struct Whisker {
    line: usize,
    x: f64,
    y: f64,
    low: f64,
    high: f64,
}

/// The means that are there, with their bars; over names those of several lines stand side by side.
fn whiskers(means: &Means) -> Vec<Whisker> {
    let lines = &means.lines.lines;
    let aside = |line: usize| {
        if means.names.is_empty() || lines.len() < 2 {
            return 0.0;
        }
        0.5 * (line as f64 / (lines.len() as f64 - 1.0) - 0.5)
    };
    let mut all = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        for (k, (&x, y)) in line.x.iter().zip(&line.y).enumerate() {
            let Some(y) = y.filter(|y| y.is_finite() && x.is_finite()) else { continue };
            let spread = means.spread.get(index).and_then(|spread| spread.get(k)).copied().flatten();
            let spread = spread.filter(|spread| spread.is_finite()).unwrap_or(0.0);
            all.push(Whisker { line: index, x: x + aside(index), y, low: y - spread, high: y + spread });
        }
    }
    all
}

fn draw_means(svg: &mut String, means: &Means, plot: &Plot) {
    for Whisker { line, x, y, low, high } in whiskers(means) {
        let (x, series) = (place(plot.across(x)), line % SERIES);
        if high > low {
            let (low, high) = (place(plot.down(low)), place(plot.down(high)));
            let _ = write!(svg, "<path class=\"whisker s{series}\" d=\"M{x} {low}V{high}\"/>");
        }
        let _ = write!(svg, "<circle class=\"dot s{series}\" cx=\"{x}\" cy=\"{}\" r=\"2.6\"/>", place(plot.down(y)));
    }
}

/// The points of a line with a place on the axis. A value that is not a finite number counts as missing.
fn points(line: &Line) -> impl Iterator<Item = (f64, Option<f64>)> {
    let pairs = line.x.iter().zip(&line.y);
    pairs.filter(|(x, _)| x.is_finite()).map(|(&x, y)| (x, y.filter(|y| y.is_finite())))
}

fn describe(lines: &Lines, values: impl Iterator<Item = f64>) -> String {
    let names: Vec<&str> = lines.lines.iter().map(|line| line.name.as_str()).collect();
    let extent = values.fold(None, |extent: Option<(f64, f64)>, value| {
        Some(extent.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
    });
    let range = match extent {
        Some((low, high)) => format!("values from {} to {}", number(low), number(high)),
        None => "no values".into(),
    };
    format!(
        "Line chart: {} over {}; {}; {range}",
        axis_title(&lines.y.label, &lines.y.unit),
        axis_title(&lines.x.label, &lines.x.unit),
        names.join(", ")
    )
}

/// Names of the lines, above the plot. A single line has none: the title names it.
struct Legend<'a> {
    /// Name, index of the line, left end, base line.
    entries: Vec<(&'a str, usize, f64, f64)>,
    height: f64,
}

impl<'a> Legend<'a> {
    fn of(lines: &'a [Line], width: f64) -> Self {
        let (mut entries, mut left, mut row) = (Vec::new(), 0.0, 0.0);
        if lines.len() < 2 {
            return Self { entries, height: 0.0 };
        }
        for (index, line) in lines.iter().enumerate() {
            let letters = line.name.chars().count().min(NAME);
            let wide = SAMPLE + 6.0 + letters as f64 * (LETTER + 0.4) + 14.0;
            if left > 0.0 && left + wide > width {
                (left, row) = (0.0, row + 1.0);
            }
            entries.push((line.name.as_str(), index, left, row * ROW + 12.0));
            left += wide;
        }
        Self { entries, height: (row + 1.0) * ROW + 4.0 }
    }
    fn draw(&self, svg: &mut String) {
        for &(name, index, left, base) in &self.entries {
            let _ = write!(
                svg,
                "<g><title>{}</title><path class=\"line s{}\"{} d=\"M{} {}h{SAMPLE}\"/><text x=\"{}\" y=\"{}\">{}</text></g>",
                markup(name),
                index % SERIES,
                dash(index),
                place(left),
                place(base - 4.0),
                place(left + SAMPLE + 6.0),
                place(base),
                markup(&shortened(name, NAME))
            );
        }
    }
}

/// Most letters of a name in a legend, and of the words at an axis.
const NAME: usize = 44;
const AXIS: usize = 48;

/// Most letters of a name below the axis.
const SLANTED: usize = 24;
/// What a letter's width becomes in height, and in width, in a text that stands aslant by 35 degrees.
const SLOPE: f64 = 0.574;
const LEVEL: f64 = 0.819;

/// A text of at most so many letters.
fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    text.chars().take(letters - 1).chain(['\u{2026}']).collect()
}

fn axes(svg: &mut String, lines: &Lines, plot: &Plot, x_ticks: &Ticks, y_ticks: &Ticks) {
    let _ = write!(
        svg,
        "<text class=\"axis\" x=\"0\" y=\"{}\">{}</text>",
        place(plot.top - 12.0),
        markup(&shortened(&axis_title(&lines.y.label, &lines.y.unit), AXIS))
    );
    let mut grid = String::new();
    for (&value, label) in y_ticks.places.iter().zip(&y_ticks.labels) {
        let y = plot.down(value);
        let _ = write!(grid, "M{} {}H{}", place(plot.left), place(y), place(plot.right));
        let _ = write!(
            svg,
            "<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{label}</text>",
            place(plot.left - 6.0),
            place(y + 4.0)
        );
    }
    let _ = write!(svg, "<path class=\"grid\" d=\"{grid}\"/>");
    let mut marks = format!("M{} {}H{}", place(plot.left), place(plot.bottom), place(plot.right));
    for (&value, label) in x_ticks.places.iter().zip(&x_ticks.labels) {
        let x = plot.across(value);
        let _ = write!(marks, "M{} {}v4", place(x), place(plot.bottom));
        if plot.slant > 0.0 {
            let (x, y) = (place(x + 3.0), place(plot.bottom + 13.0));
            let _ = write!(
                svg,
                "<text class=\"tick\" x=\"{x}\" y=\"{y}\" text-anchor=\"end\" transform=\"rotate(-35 {x} {y})\">{label}</text>"
            );
            continue;
        }
        // the last label must not leave the drawing
        let half = label.chars().count() as f64 * LETTER / 2.0;
        let _ = write!(
            svg,
            "<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
            place(x.clamp(half, (WIDTH - half).max(half))),
            place(plot.bottom + 17.0)
        );
    }
    let _ = write!(svg, "<path class=\"base\" d=\"{marks}\"/>");
    let _ = write!(
        svg,
        "<text class=\"axis\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
        place((plot.left + plot.right) / 2.0),
        place(plot.bottom + 36.0 + plot.slant),
        markup(&shortened(&axis_title(&lines.x.label, &lines.x.unit), AXIS))
    );
}

fn dash(index: usize) -> String {
    match DASHES[index % DASHES.len()] {
        "" => String::new(),
        pattern => format!(" stroke-dasharray=\"{pattern}\""),
    }
}

/// Draws the unbroken pieces of a line as one path, and pieces of a single point as dots.
fn draw_line(svg: &mut String, line: &Line, plot: &Plot, index: usize) {
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for (x, y) in points(line) {
        match (y, pieces.last_mut()) {
            (Some(y), Some(piece)) => piece.push((plot.across(x), plot.down(y))),
            _ => pieces.push(Vec::new()),
        }
    }
    let (mut path, mut dots) = (String::new(), String::new());
    for piece in pieces {
        match piece.as_slice() {
            [] => {}
            [(x, y)] => {
                let _ = write!(
                    dots,
                    "<circle class=\"dot s{}\" cx=\"{}\" cy=\"{}\" r=\"2.2\"/>",
                    index % SERIES,
                    place(*x),
                    place(*y)
                );
            }
            piece => {
                let mut command = 'M';
                for (x, y) in reduced(piece) {
                    let _ = write!(path, "{command}{} {}", place(x), place(y));
                    command = 'L';
                }
            }
        }
    }
    if !path.is_empty() {
        let _ = write!(svg, "<path class=\"line s{}\"{} d=\"{path}\"/>", index % SERIES, dash(index));
    }
    svg.push_str(&dots);
}

/// The points that matter in a drawing: of each column the first, the lowest, the highest and the last, in their order.
fn reduced(piece: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut kept = Vec::new();
    let column = |point: &(f64, f64)| (point.0 * COLUMNS).floor();
    for points in piece.chunk_by(|one, next| column(one) == column(next)) {
        let last = points.len().saturating_sub(1);
        let (mut lowest, mut highest) = (0, 0);
        for at in 0..points.len() {
            if points[at].1 < points[lowest].1 {
                lowest = at;
            }
            if points[at].1 > points[highest].1 {
                highest = at;
            }
        }
        let mut places = [0, lowest, highest, last];
        places.sort_unstable();
        let mut before = None;
        for at in places {
            if before != Some(at) {
                kept.push(points[at]);
            }
            before = Some(at);
        }
    }
    kept
}

/// The data of a chart. Places that several lines share are written once.
fn data(lines: &Lines, means: Option<&Means>, id: &str, plot: &Plot) -> Value {
    let mut places: Vec<&[f64]> = Vec::new();
    let mut entries = Vec::new();
    for (index, line) in lines.lines.iter().enumerate() {
        let points = line.x.len().min(line.y.len());
        let x = &line.x[..points];
        let at = places.iter().position(|known| *known == x).unwrap_or_else(|| {
            places.push(x);
            places.len() - 1
        });
        let mut entry = json!({"name": line.name, "x": at, "y": &line.y[..points]});
        if let Some(spread) = means.and_then(|means| means.spread.get(index)) {
            entry["spread"] = json!(spread);
        }
        entries.push(entry);
    }
    let mut data = json!({
        "id": id,
        "x": {"label": lines.x.label, "unit": lines.x.unit, "ends": [plot.x.0, plot.x.1]},
        "y": {"label": lines.y.label, "unit": lines.y.unit, "ends": [plot.y.0, plot.y.1]},
        "plot": [plot.left, plot.right, plot.top, plot.bottom],
        "places": places,
        "lines": entries,
    });
    if let Some(means) = means {
        data["spread"] = json!(means.spread_name);
        if !means.names.is_empty() {
            data["x"]["names"] = json!(means.names);
        }
    }
    data
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
mod tests {
    use super::super::Axis;
    use super::*;

    fn axis(label: &str, unit: &str) -> Axis {
        Axis { label: label.into(), unit: unit.into(), range: None }
    }

    fn lines(of: Vec<Line>) -> Lines {
        Lines {
            id: "a".into(),
            title: "A".into(),
            about: String::new(),
            x: axis("time", "s"),
            y: axis("speed", "m/s"),
            lines: of,
        }
    }

    fn line(y: &[Option<f64>]) -> Line {
        Line { name: "one".into(), x: (0..y.len()).map(|i| i as f64).collect(), y: y.to_vec() }
    }

    /// The path data of the lines, without those of the legend.
    fn paths(svg: &str) -> Vec<&str> {
        let starts = svg.split("<path class=\"line").skip(1);
        let paths = starts.filter_map(|rest| rest.split("d=\"").nth(1)?.split('"').next());
        paths.filter(|path| !path.contains('h')).collect()
    }

    #[test]
    fn a_missing_value_interrupts_the_line() {
        let chart = chart(
            &lines(vec![line(&[Some(0.0), Some(1.0), None, Some(1.0), Some(0.0), Some(f64::NAN), Some(0.5)])]),
            "a",
        );
        let paths = paths(&chart.svg);
        assert_eq!(paths.len(), 1);
        assert_eq!(paths[0].matches('M').count(), 2);
        assert_eq!(paths[0].matches('L').count(), 2);
        assert_eq!(chart.svg.matches("<circle").count(), 1, "a lonely point is a dot");
        assert_eq!(chart.data["lines"][0]["y"][2], Value::Null);
        assert_eq!(chart.data["lines"][0]["y"][5], Value::Null, "what is not a number is missing");
    }

    #[test]
    fn many_points_are_few_in_the_drawing_and_keep_their_extremes() {
        let mut y: Vec<Option<f64>> = (0..100_000).map(|i| Some(f64::from(i % 7))).collect();
        y[54_321] = Some(100.0);
        let chart = chart(&lines(vec![line(&y)]), "a");
        assert!(chart.svg.len() < 60_000, "{}", chart.svg.len());
        let peak = paths(&chart.svg)[0].split(['M', 'L']).filter_map(|p| p.split(' ').nth(1)?.parse::<f64>().ok());
        let top = peak.fold(f64::INFINITY, f64::min);
        assert!((top - 26.0).abs() < 0.11, "the peak reaches the upper end: {top}");
        assert_eq!(chart.data["lines"][0]["y"].as_array().unwrap().len(), 100_000, "the read-out has all of it");
    }

    #[test]
    fn a_reduced_line_keeps_first_lowest_highest_and_last() {
        let piece: Vec<(f64, f64)> =
            [3.0, 9.0, 1.0, 5.0, 4.0].iter().enumerate().map(|(i, &y)| (i as f64 * 0.01, y)).collect();
        let kept: Vec<f64> = reduced(&piece).into_iter().map(|(_, y)| y).collect();
        assert_eq!(kept, [3.0, 9.0, 1.0, 4.0]);
    }

    #[test]
    fn degenerate_lines_give_a_chart() {
        let huge = [Some(f64::MAX), Some(-f64::MAX), Some(f64::INFINITY)];
        let cases: Vec<Vec<Line>> = vec![
            vec![],
            vec![line(&[])],
            vec![line(&[Some(1.0)])],
            vec![line(&[None, None])],
            vec![line(&[Some(2.0), Some(2.0)])],
            vec![line(&huge)],
            vec![Line { name: String::new(), x: vec![f64::NAN, 1.0], y: vec![Some(1.0), Some(2.0), Some(3.0)] }],
        ];
        for case in cases {
            let chart = chart(&lines(case.clone()), "a");
            assert!(chart.svg.ends_with("</svg>"));
            assert!(!chart.svg.contains("NaN") && !chart.svg.contains("inf"), "{case:?}: {}", chart.svg);
        }
        assert!(chart(&lines(vec![line(&[None])]), "a").svg.contains("no values"));
    }

    #[test]
    fn means_have_bars_and_names_their_places() {
        let shown = Means {
            lines: lines(vec![line(&[Some(1.0), Some(2.0)]), line(&[Some(3.0), None])]),
            spread: vec![vec![Some(0.5), None], vec![Some(f64::NAN)]],
            spread_name: "standard error".into(),
            names: vec!["<free>".into(), "filled".into()],
        };
        let chart = means(&shown, "a");
        assert_eq!((chart.svg.matches("<circle").count(), chart.svg.matches("whisker").count()), (3, 1));
        assert!(chart.svg.contains("&lt;free&gt;") && !chart.svg.contains("<free>"), "{}", chart.svg);
        assert_eq!(paths(&chart.svg), [""; 0], "no line between names");
        assert_eq!(chart.data["x"]["names"][1], "filled");
        assert_eq!(chart.data["lines"][0]["spread"][0], 0.5);
        assert!(!chart.svg.contains("rotate"));
        let long = ["a_name_that_is_too_long_for_its_share_of_the_width", "b", "c", "d", "e", "f"].map(str::to_owned);
        let slanted = means(&Means { names: long.to_vec(), ..shown.clone() }, "a");
        assert_eq!(slanted.svg.matches("rotate(-35").count(), 6);
        let numbers = means(&Means { names: vec![], ..shown }, "a");
        assert_eq!(paths(&numbers.svg).len(), 1);
        assert!(numbers.data["x"].get("names").is_none());
    }

    #[test]
    fn names_are_escaped_and_shared_places_written_once() {
        let named = |name: &str| Line { name: name.into(), ..line(&[Some(1.0), Some(2.0)]) };
        let chart = chart(&lines(vec![named("<b>"), named("c\"d")]), "a");
        assert!(!chart.svg.contains("<b>"));
        assert!(chart.svg.contains("&lt;b&gt;") && chart.svg.contains("c&quot;d"));
        assert_eq!(chart.data["places"].as_array().unwrap().len(), 1);
        assert_eq!(chart.svg.matches("stroke-dasharray").count(), 2, "the second line is dashed, and in the legend");
    }
}
