//! A moment as scalable vector graphics.

use super::picture::{Colour, Mark, Picture};
use super::{Form, Look, Most, Recording};
use crate::report::escape::markup;
use crate::report::number::place;
use crate::store::StoreError;
use core::fmt::Write;

/// A drawing.
pub(super) struct Svg;

impl Form for Svg {
    fn id(&self) -> &'static str {
        "svg"
    }
    fn about(&self) -> &'static str {
        "a moment as a drawing, with the places of all agents in it"
    }
    fn still(&self) -> bool {
        true
    }
    fn most(&self) -> Most {
        Most { frames: 1, positions: 1_000_000 }
    }
    fn bytes(&self, recording: &Recording, look: &Look) -> Result<Vec<u8>, StoreError> {
        recording.needs_frames()?;
        let replay = &recording.replay;
        let frame = replay.times.len() - 1;
        let picture = Picture::of(replay, frame, f64::from(look.width));
        let mut data = String::from("agent,group,x,y,z,heading_x,heading_y,heading_z\n");
        for (agent, (at, to)) in replay.position[frame].iter().zip(&replay.heading[frame]).enumerate() {
            if at.iter().all(|value| value.is_finite()) {
                let group = replay.stage.groups.get(replay.group[agent]).map_or("", String::as_str);
                let numbers: Vec<String> = at.iter().chain(to).map(f32::to_string).collect();
                // writing to a string cannot fail, here and below
                let _ = writeln!(data, "{agent},{group},{}", numbers.join(","));
            }
        }
        Ok(drawn(&picture, &recording.title, &data).into_bytes())
    }
}

fn colour([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The drawing, with its data.
fn drawn(picture: &Picture, title: &str, data: &str) -> String {
    let (wide, tall) = (picture.wide, picture.tall);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{tall}\" viewBox=\"0 0 {wide} {tall}\" \
         font-family=\"system-ui, sans-serif\" font-size=\"13\">\n<title>{}</title>\n<metadata>{}</metadata>\n\
         <rect width=\"{wide}\" height=\"{tall}\" fill=\"{}\"/>\n",
        markup(title),
        markup(data),
        colour(picture.ground)
    );
    let at = |p: &[f64; 2]| format!("{} {}", place(p[0]), place(p[1]));
    for mark in &picture.marks {
        let _ = match mark {
            Mark::Fill { points, colour: fill } => {
                let points: Vec<String> = points.iter().map(at).collect();
                writeln!(svg, "<path fill=\"{}\" d=\"M{}z\"/>", colour(*fill), points.join("L"))
            }
            Mark::Line { points, width, colour: stroke, strength } => {
                let points: Vec<String> = points.iter().map(at).collect();
                writeln!(
                    svg,
                    "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-opacity=\"{strength:.2}\" d=\"M{}\"/>",
                    colour(*stroke),
                    place(*width),
                    points.join("L")
                )
            }
            Mark::Disc { centre, radius, colour: fill } => writeln!(
                svg,
                "<circle fill=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
                colour(*fill),
                place(centre[0]),
                place(centre[1]),
                place(*radius)
            ),
            Mark::Word { at, text, right, colour: fill } => writeln!(
                svg,
                "<text x=\"{}\" y=\"{}\" fill=\"{}\" text-anchor=\"{}\">{}</text>",
                place(at[0]),
                place(at[1]),
                colour(*fill),
                if *right { "end" } else { "start" },
                markup(text)
            ),
        };
    }
    svg.push_str("</svg>\n");
    svg
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn the_data_of_the_moment_is_in_the_drawing() {
        let bytes = Svg.bytes(&recording(2, 5, 6), &Look { width: 400, rate: 25.0 }).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let (_, data) = text.split_once("<metadata>").unwrap();
        let (data, _) = data.split_once("</metadata>").unwrap();
        // agent 1 is missing in every third frame, and this is frame 4
        assert_eq!(data.lines().count(), 1 + 6);
        assert!(data.lines().nth(1).unwrap().starts_with("0,fish,"));
        assert!(text.contains("A &lt;test&gt; &amp; more"));
    }
}
