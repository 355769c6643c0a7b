//! A recording as a moving picture that every program shows.

use super::picture::{Colour, Picture};
use super::raster::Raster;
use super::{Form, Look, Most, Recording, failed};
use crate::store::StoreError;
use std::collections::HashMap;

/// Steps from the ground to a colour, for edges that are smooth.
const SHADES: usize = 12;

/// A moving picture.
pub(super) struct Gif;

impl Form for Gif {
    fn id(&self) -> &'static str {
        "gif"
    }
    fn about(&self) -> &'static str {
        "a moving picture without sound or controls"
    }
    fn most(&self) -> Most {
        Most { frames: 250, positions: 5_000_000 }
    }
    fn bytes(&self, recording: &Recording, look: &Look) -> Result<Vec<u8>, StoreError> {
        recording.needs_frames()?;
        let replay = &recording.replay;
        let first = Picture::of(replay, 0, f64::from(look.width));
        let colours = shades(&first);
        let told = |error: ::gif::EncodingError| failed("a moving picture", error);
        let (wide, tall) = (first.wide as u16, first.tall as u16);
        let flat: Vec<u8> = colours.iter().flatten().copied().collect();
        let mut bytes = Vec::new();
        let mut encoder = ::gif::Encoder::new(&mut bytes, wide, tall, &flat).map_err(told)?;
        encoder.set_repeat(::gif::Repeat::Infinite).map_err(told)?;
        let delay = (100.0 / look.rate).round().clamp(2.0, 1000.0) as u16;
        let mut nearest = HashMap::new();
        for frame in 0..replay.times.len() {
            let raster = Raster::of(&Picture::of(replay, frame, f64::from(look.width)));
            let pixels: Vec<u8> = raster.pixels.iter().map(|&pixel| place(pixel, &colours, &mut nearest)).collect();
            let frame = ::gif::Frame { delay, ..::gif::Frame::from_indexed_pixels(wide, tall, pixels, None) };
            encoder.write_frame(&frame).map_err(told)?;
        }
        drop(encoder);
        Ok(bytes)
    }
}

/// The colours of a picture with their mixtures with the ground, at most 256.
fn shades(picture: &Picture) -> Vec<Colour> {
    let mut all = vec![picture.ground];
    for colour in picture.colours() {
        for step in 1..=SHADES {
            let share = step as f64 / SHADES as f64;
            let mix = |k: usize| {
                let (from, to) = (f64::from(picture.ground[k]), f64::from(colour[k]));
                (from + share * (to - from)).round() as u8
            };
            all.push([mix(0), mix(1), mix(2)]);
        }
    }
    all.truncate(256);
    all
}

/// The place of the nearest colour.
fn place(pixel: Colour, colours: &[Colour], known: &mut HashMap<Colour, u8>) -> u8 {
    *known.entry(pixel).or_insert_with(|| {
        let distance = |colour: &Colour| -> i32 {
            colour.iter().zip(pixel).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
        };
        let best = colours.iter().enumerate().min_by_key(|(_, colour)| distance(colour));
        best.map_or(0, |(place, _)| place as u8)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn it_has_a_picture_for_each_frame_and_they_differ() {
        let bytes = Gif.bytes(&recording(2, 4, 6), &Look { width: 120, rate: 20.0 }).unwrap();
        let mut decoder = ::gif::DecodeOptions::new().read_info(&bytes[..]).unwrap();
        let mut pictures = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!(frame.delay, 5);
            pictures.push(frame.buffer.to_vec());
        }
        assert_eq!(pictures.len(), 4);
        assert_ne!(pictures[0], pictures[3]);
    }
}
