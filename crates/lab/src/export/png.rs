//! A moment as a picture of pixels.

use super::picture::Picture;
use super::raster::Raster;
use super::{Form, Look, Most, Recording, failed};
use crate::store::StoreError;

/// A picture.
pub(super) struct Png;

impl Form for Png {
    fn id(&self) -> &'static str {
        "png"
    }
    fn about(&self) -> &'static str {
        "a moment as a picture"
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
        let picture = Picture::of(replay, replay.times.len() - 1, f64::from(look.width));
        let raster = Raster::of(&picture);
        let mut bytes = Vec::new();
        let mut encoder = ::png::Encoder::new(&mut bytes, raster.wide as u32, raster.tall as u32);
        encoder.set_color(::png::ColorType::Rgb);
        encoder.set_depth(::png::BitDepth::Eight);
        let told = |error| failed("a picture", error);
        let mut writer = encoder.write_header().map_err(told)?;
        writer.write_image_data(&raster.bytes()).map_err(told)?;
        writer.finish().map_err(told)?;
        Ok(bytes)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::super::tests::recording;
    use super::*;

    #[test]
    fn it_reads_back_as_it_was_drawn() {
        let (all, look) = (recording(2, 5, 6), Look { width: 240, rate: 25.0 });
        let bytes = Png.bytes(&all, &look).unwrap();
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
        let mut read = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut read).unwrap();
        let raster = Raster::of(&Picture::of(&all.replay, 4, 240.0));
        assert_eq!((info.width as usize, info.height as usize), (raster.wide, raster.tall));
        assert_eq!(read, raster.bytes());
        let colours: std::collections::BTreeSet<&[u8]> = read.chunks(3).collect();
        assert!(colours.len() > 20, "it shows something");
    }
}
