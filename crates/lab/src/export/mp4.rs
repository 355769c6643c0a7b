//! A recording as a film. The pictures are ours, the film is made by an `ffmpeg` of the user's.

use super::picture::Picture;
use super::raster::Raster;
use super::{Form, Look, Most, Recording, failed};
use crate::store::StoreError;
use std::io::{ErrorKind, Write};
use std::process::{Command, Stdio};

/// The program that makes films.
const MAKER: &str = "ffmpeg";

/// A film.
pub(super) struct Mp4;

impl Form for Mp4 {
    fn id(&self) -> &'static str {
        "mp4"
    }
    fn about(&self) -> &'static str {
        "a film; needs the program ffmpeg"
    }
    fn most(&self) -> Most {
        Most { frames: 3000, positions: 20_000_000 }
    }
    fn bytes(&self, recording: &Recording, look: &Look) -> Result<Vec<u8>, StoreError> {
        recording.needs_frames()?;
        let replay = &recording.replay;
        let first = Picture::of(replay, 0, f64::from(look.width));
        let target = std::env::temp_dir().join(format!("flockworks-{}.mp4", std::process::id()));
        let mut command = Command::new(MAKER);
        command.args(["-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]);
        command.args(["-s", &format!("{}x{}", first.wide, first.tall), "-r", &look.rate.to_string(), "-i", "-"]);
        command.args(["-pix_fmt", "yuv420p", "-movflags", "+faststart"]).arg(&target);
        command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut maker = command.spawn().map_err(|error| match error.kind() {
            ErrorKind::NotFound => StoreError::Refused(format!(
                "a film needs the program {MAKER}, which is not on the PATH: install it, or export --to gif or html"
            )),
            _ => failed("a film", error),
        })?;
        if let Some(mut pipe) = maker.stdin.take() {
            for frame in 0..replay.times.len() {
                let raster = Raster::of(&Picture::of(replay, frame, f64::from(look.width)));
                if pipe.write_all(&raster.bytes()).is_err() {
                    // why it stopped reading is what it says itself
                    break;
                }
            }
        }
        let done = maker.wait_with_output().map_err(|error| failed("a film", error))?;
        if !done.status.success() {
            let said = String::from_utf8_lossy(&done.stderr);
            return Err(failed("a film", format!("{MAKER} says: {}", said.lines().last().unwrap_or("nothing"))));
        }
        let bytes = std::fs::read(&target).map_err(|error| StoreError::io("read", &target, error))?;
        // a file left in the system's folder for such is no loss
        let _ = std::fs::remove_file(&target);
        Ok(bytes)
    }
}
