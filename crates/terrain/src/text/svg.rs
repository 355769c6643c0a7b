//! Scalable vector graphics. Drawings are written whole; read is a subset: `line`, `polyline`, `polygon`, `rect`,
//! `circle`, and `path` with M, L, H, V and Z. The y axis of a picture points down, that of an environment up: y changes
//! its sign on the way.

use super::{Cursor, line, ring};
use crate::TerrainError;
use crate::construct::Environment;
use crate::geometry::{Geometry, Point, bounds};
use crate::grammar::{Derivation, Grammar};
use space::{Segment, Vector};
use std::fmt::Write;

/// A drawing: elements with classes, and how far it reaches.
#[derive(Default)]
struct Drawing {
    body: String,
    points: Vec<Point>,
}

impl Drawing {
    fn element(&mut self, class: &str, geometry: &Geometry) {
        self.points.extend(geometry.points());
        let _ = match geometry {
            Geometry::Wall(Segment { from, to }) => writeln!(
                self.body,
                r#"<line class="{class}" x1="{}" y1="{}" x2="{}" y2="{}"/>"#,
                from[0],
                0.0 - from[1],
                to[0],
                0.0 - to[1]
            ),
            Geometry::Disc { centre, radius } | Geometry::Circle { centre, radius } => {
                // a disc is filled
                let fill = if matches!(geometry, Geometry::Disc { .. }) { "currentColor" } else { "none" };
                writeln!(
                    self.body,
                    r#"<circle class="{class}" fill="{fill}" cx="{}" cy="{}" r="{radius}"/>"#,
                    centre[0],
                    0.0 - centre[1]
                )
            }
            Geometry::Polygon(corners) => {
                let list: Vec<String> = corners.iter().map(|p| format!("{},{}", p[0], 0.0 - p[1])).collect();
                writeln!(self.body, r#"<polygon class="{class}" fill="none" points="{}"/>"#, list.join(" "))
            }
        };
    }
    fn whole(self, title: &str) -> String {
        let (low, high) = bounds(self.points).unwrap_or((Vector([0.0, 0.0]), Vector([1.0, 1.0])));
        let size = (high[0] - low[0]).max(high[1] - low[1]).max(1e-9);
        let margin = 0.05 * size;
        let stroke = size / 200.0;
        let (x, y) = (low[0] - margin, -high[1] - margin);
        let (width, height) = (high[0] - low[0] + 2.0 * margin, high[1] - low[1] + 2.0 * margin);
        let title = title.replace('&', "&amp;").replace('<', "&lt;");
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x} {y} {width} {height}\" stroke=\"currentColor\" \
             stroke-width=\"{stroke}\">\n<title>{title}</title>\n<style>.workspace{{color:#777}}.construct{{color:#06c}}\
             .marker,.nonterminal{{color:#c30}}</style>\n{}</svg>\n",
            self.body
        )
    }
}

/// An environment: the workspace grey, the construct blue, markers as crosses. What is built reads back by [`read`].
pub fn write(environment: &Environment) -> String {
    let mut drawing = Drawing::default();
    environment.workspace.geometry.iter().for_each(|geometry| drawing.element("workspace", geometry));
    environment.construct.geometry().for_each(|geometry| drawing.element("construct", geometry));
    for marker in &environment.construct.markers {
        let at = marker.pose.at;
        drawing.points.push(at);
        let (x, y) = (at[0], 0.0 - at[1]);
        // text: a mark, and no geometry
        let _ = writeln!(
            drawing.body,
            r#"<text class="marker" x="{x}" y="{y}" text-anchor="middle" stroke="none" fill="currentColor">+</text>"#
        );
    }
    drawing.whole(&environment.construct.provenance.schema)
}

/// A derivation after so many steps (0: its start), with its non-terminals.
pub fn derivation(grammar: &Grammar, derivation: &Derivation, step: usize) -> String {
    let mut drawing = Drawing::default();
    for instance in derivation.after(step) {
        let class = match grammar.shapes.get(instance.shape).map(|shape| shape.kind) {
            Some(crate::grammar::Kind::Terminal) => "construct",
            Some(crate::grammar::Kind::Marker) => "marker",
            _ => "nonterminal",
        };
        instance.geometry(grammar).iter().for_each(|geometry| drawing.element(class, geometry));
    }
    let rule = step.checked_sub(1).and_then(|last| derivation.steps.get(last));
    let title = rule.map_or("start".to_owned(), |rule| format!("step {step}: {}", rule.rule));
    drawing.whole(&format!("{}, {title}", grammar.name))
}

/// The geometry of a picture. Filled circles are discs, others round walls; all else is lines, whether filled or not. Other
/// elements are passed over.
///
/// # Errors
/// A text that is not SVG, coordinates that cannot be read, curves in a path, and transformations.
pub fn read(text: &str) -> Result<Vec<Geometry>, TerrainError> {
    let mut all = Vec::new();
    let mut found = false;
    let mut cursor = Cursor::new(text);
    let mut hidden: Option<String> = None;
    while let Some(start) = text[cursor.at..].find('<') {
        cursor.at += start + 1;
        let rest = &text[cursor.at..];
        // comments, declarations, raw text: up to where they end
        let ends = [("!--", "-->"), ("![CDATA[", "]]>"), ("?", "?>"), ("!", ">")];
        if let Some((_, end)) = ends.into_iter().find(|(begin, _)| rest.starts_with(begin)) {
            cursor.at += rest.find(end).map_or(rest.len(), |at| at + end.len());
            continue;
        }
        let closing = cursor.take("/");
        let name = local(cursor.word(|letter| letter.is_alphanumeric() || "-_:.".contains(letter))).to_owned();
        if let Some(inside) = &hidden {
            if closing && name == *inside {
                hidden = None;
            }
            continue;
        }
        let attributes = attributes(&mut cursor)?;
        found |= name == "svg";
        if closing {
            continue;
        }
        if ["defs", "symbol", "clipPath", "mask", "pattern"].contains(&name.as_str()) && !attributes.closed {
            hidden = Some(name);
            continue;
        }
        if attributes.get("transform").is_some() {
            return Err(cursor.wrong(format!("`{name}` has a transform, which is not read: apply it before")));
        }
        element(&name, &attributes, &cursor, &mut all)?;
    }
    if found { Ok(all) } else { Err(cursor.wrong("expected an `svg` element".into())) }
}

/// A name without its namespace.
fn local(name: &str) -> &str {
    name.rsplit(':').next().unwrap_or(name)
}

struct Attributes<'a> {
    list: Vec<(&'a str, &'a str)>,
    /// Whether the element has no content.
    closed: bool,
}

impl<'a> Attributes<'a> {
    fn get(&self, name: &str) -> Option<&'a str> {
        self.list.iter().find(|(known, _)| *known == name).map(|&(_, value)| value)
    }
    /// A length, 0 where it is not there; `px` may follow it.
    fn length(&self, name: &str, cursor: &Cursor<'_>) -> Result<f64, TerrainError> {
        let Some(value) = self.get(name) else { return Ok(0.0) };
        match value.trim().trim_end_matches("px").parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => Err(cursor.wrong(format!("{name}: expected a finite number, found `{value}`"))),
        }
    }
}

/// The attributes of an element, up to the end of its tag.
fn attributes<'a>(cursor: &mut Cursor<'a>) -> Result<Attributes<'a>, TerrainError> {
    let mut list = Vec::new();
    loop {
        if cursor.take("/>") {
            return Ok(Attributes { list, closed: true });
        }
        if cursor.take(">") {
            return Ok(Attributes { list, closed: false });
        }
        let name = local(cursor.word(|letter| !letter.is_whitespace() && !"=/><\"'".contains(letter)));
        if name.is_empty() {
            return cursor.fault("an attribute or the end of the tag");
        }
        cursor.need("=")?;
        let quote = if cursor.take("\"") { '"' } else { '\'' };
        if quote == '\'' {
            cursor.need("'")?;
        }
        let rest = &cursor.text[cursor.at..];
        let Some(end) = rest.find(quote) else { return cursor.fault("the closing quote of an attribute") };
        list.push((name, &rest[..end]));
        cursor.at += end + 1;
    }
}

fn element(
    name: &str,
    attributes: &Attributes<'_>,
    cursor: &Cursor<'_>,
    all: &mut Vec<Geometry>,
) -> Result<(), TerrainError> {
    let number = |name: &str| attributes.length(name, cursor);
    let at = |x: f64, y: f64| Vector([x, 0.0 - y]);
    match name {
        "line" => all.push(Geometry::wall(at(number("x1")?, number("y1")?), at(number("x2")?, number("y2")?))),
        "polyline" => all.extend(line(&points(attributes.get("points").unwrap_or(""), cursor)?)),
        "polygon" => all.push(ring(points(attributes.get("points").unwrap_or(""), cursor)?)),
        "rect" => {
            let (x, y, width, height) = (number("x")?, number("y")?, number("width")?, number("height")?);
            let corners = [[x, y + height], [x + width, y + height], [x + width, y], [x, y]];
            all.push(Geometry::Polygon(corners.map(|[x, y]| at(x, y)).to_vec()));
        }
        "circle" => {
            let (centre, radius) = (at(number("cx")?, number("cy")?), number("r")?);
            if radius < 0.0 {
                return Err(cursor.wrong(format!("r: expected 0 or more, found {radius}")));
            }
            let filled = attributes.get("fill") != Some("none");
            all.push(if filled { Geometry::Disc { centre, radius } } else { Geometry::Circle { centre, radius } });
        }
        "path" => path(attributes.get("d").unwrap_or(""), cursor, all)?,
        _ => {}
    }
    Ok(())
}

/// The points of a list of coordinates.
fn points(text: &str, cursor: &Cursor<'_>) -> Result<Vec<Point>, TerrainError> {
    let mut inner = Cursor::new(text);
    let mut numbers = Vec::new();
    while !inner.rest().is_empty() {
        numbers.push(inner.number().map_err(|_| cursor.wrong(format!("points: `{}` is no number", inner.rest())))?);
        inner.take(",");
    }
    if numbers.len() % 2 != 0 {
        return Err(cursor.wrong(format!("points: expected pairs of numbers, found {} numbers", numbers.len())));
    }
    Ok(numbers.chunks_exact(2).map(|two| Vector([two[0], 0.0 - two[1]])).collect())
}

/// The lines of a path, with y pointing up.
fn path(text: &str, cursor: &Cursor<'_>, all: &mut Vec<Geometry>) -> Result<(), TerrainError> {
    let mut inner = Cursor::new(text);
    let mut open: Vec<Point> = Vec::new();
    let (mut pen, mut start): (Point, Point) = (Vector::ZERO, Vector::ZERO);
    let mut command = ' ';
    let finish = |open: &mut Vec<Point>, all: &mut Vec<Geometry>| {
        if open.len() > 1 {
            all.extend(line(open));
        }
        open.clear();
    };
    loop {
        inner.take(",");
        let Some(next) = inner.rest().chars().next() else { break };
        if next.is_ascii_alphabetic() {
            command = next;
            inner.at += 1;
        } else if command == ' ' || command.eq_ignore_ascii_case(&'z') {
            return Err(cursor.wrong(format!("path: expected a command, found `{next}`")));
        }
        let mut number = || {
            inner.take(",");
            inner.number().map_err(|_| cursor.wrong(format!("path: `{command}` lacks a number")))
        };
        let base = if command.is_ascii_lowercase() { pen } else { Vector::ZERO };
        match command.to_ascii_lowercase() {
            'm' => {
                finish(&mut open, all);
                pen = base + Vector([number()?, 0.0 - number()?]);
                (start, open) = (pen, vec![pen]);
                // what follows without a command are lines
                command = if command == 'm' { 'l' } else { 'L' };
                continue;
            }
            'l' => pen = base + Vector([number()?, 0.0 - number()?]),
            'h' => pen[0] = base[0] + number()?,
            'v' => pen[1] = base[1] - number()?,
            'z' => {
                if open.len() > 1 {
                    all.push(ring(core::mem::take(&mut open)));
                }
                pen = start;
                open = vec![pen];
                continue;
            }
            _ => return Err(cursor.wrong(format!("path: `{command}` is not read; only M, L, H, V and Z are"))),
        }
        if open.is_empty() {
            return Err(cursor.wrong("path: expected M first".into()));
        }
        open.push(pen);
    }
    finish(&mut open, all);
    Ok(())
}
