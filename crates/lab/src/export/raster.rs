//! Pictures as pixels, with smooth edges.

use super::glyphs::{self, glyph};
use super::picture::{Colour, Mark, Picture};

/// Lines of samples in a row of pixels.
const SAMPLES: usize = 4;

/// A picture of pixels.
pub(super) struct Raster {
    /// Pixels in a row.
    pub(super) wide: usize,
    /// Rows.
    pub(super) tall: usize,
    /// Colours, row by row from above.
    pub(super) pixels: Vec<Colour>,
}

impl Raster {
    /// The pixels of a picture.
    pub(super) fn of(picture: &Picture) -> Self {
        let (wide, tall) = (picture.wide, picture.tall);
        let mut raster = Self { wide, tall, pixels: vec![picture.ground; wide * tall] };
        for mark in &picture.marks {
            match mark {
                Mark::Fill { points, colour } => raster.fill(points, *colour, 1.0),
                Mark::Disc { centre, radius, colour } => raster.fill(&round(*centre, *radius), *colour, 1.0),
                Mark::Line { points, width, colour, strength } => {
                    for pair in points.windows(2) {
                        raster.fill(&stroke(pair[0], pair[1], *width), *colour, *strength);
                    }
                }
                Mark::Word { at, text, right, colour } => raster.word(*at, text, *right, *colour),
            }
        }
        raster
    }
    /// Three bytes for each pixel.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.pixels.iter().flatten().copied().collect()
    }
    /// Fills a closed line of points (even-odd rule): each pixel by the share of it that is covered.
    fn fill(&mut self, points: &[[f64; 2]], colour: Colour, strength: f64) {
        if points.len() < 3 || !points.iter().flatten().all(|value| value.is_finite()) {
            return;
        }
        let ends = |axis: usize| {
            let values = points.iter().map(|p| p[axis]);
            (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (top, bottom)) = (ends(0), ends(1));
        let first = |value: f64, most: usize| value.floor().clamp(0.0, most as f64) as usize;
        let (from, to) = (first(left, self.wide), first(right + 1.0, self.wide));
        let mut cover = vec![0.0; to.saturating_sub(from)];
        let mut crossings: Vec<f64> = Vec::new();
        for row in first(top, self.tall)..first(bottom + 1.0, self.tall) {
            cover.fill(0.0);
            for sample in 0..SAMPLES {
                let y = row as f64 + (sample as f64 + 0.5) / SAMPLES as f64;
                crossings.clear();
                for (k, a) in points.iter().enumerate() {
                    let b = points[(k + 1) % points.len()];
                    if (a[1] <= y) != (b[1] <= y) {
                        crossings.push(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                    }
                }
                crossings.sort_by(f64::total_cmp);
                for span in crossings.chunks_exact(2) {
                    let (left, right) = (span[0].max(from as f64), span[1].min(to as f64));
                    for x in first(left, to)..first(right + 1.0, to) {
                        let part = right.min(x as f64 + 1.0) - left.max(x as f64);
                        if x >= from && part > 0.0 {
                            cover[x - from] += part / SAMPLES as f64;
                        }
                    }
                }
            }
            for (k, &share) in cover.iter().enumerate() {
                if share > 0.0 {
                    self.mix(row * self.wide + from + k, colour, share.min(1.0) * strength);
                }
            }
        }
    }
    fn mix(&mut self, at: usize, colour: Colour, share: f64) {
        let there = &mut self.pixels[at];
        for k in 0..3 {
            let (from, to) = (f64::from(there[k]), f64::from(colour[k]));
            there[k] = (from + share * (to - from)).round() as u8;
        }
    }
    /// A line of letters, whose base line and one end are given.
    fn word(&mut self, at: [f64; 2], text: &str, right: bool, colour: Colour) {
        let (size, advance) = (2usize, 2 * (glyphs::WIDE + 1));
        let long = text.chars().count() * advance;
        let left = if right { at[0] - long as f64 } else { at[0] };
        for (k, letter) in text.chars().enumerate() {
            for (row, bits) in glyph(letter).into_iter().enumerate() {
                for column in (0..glyphs::WIDE).filter(|column| bits >> (glyphs::WIDE - 1 - column) & 1 == 1) {
                    let x = left + (k * advance + column * size) as f64;
                    let y = at[1] - ((glyphs::TALL - row) * size) as f64;
                    let (x, y, size) = (x.round(), y.round(), size as f64);
                    self.fill(&[[x, y], [x + size, y], [x + size, y + size], [x, y + size]], colour, 1.0);
                }
            }
        }
    }
}

/// The outline of a stroke.
fn stroke(a: [f64; 2], b: [f64; 2], width: f64) -> [[f64; 2]; 4] {
    let along = [b[0] - a[0], b[1] - a[1]];
    let length = along[0].hypot(along[1]).max(1e-9);
    let aside = [-along[1] / length * width / 2.0, along[0] / length * width / 2.0];
    [
        [a[0] + aside[0], a[1] + aside[1]],
        [b[0] + aside[0], b[1] + aside[1]],
        [b[0] - aside[0], b[1] - aside[1]],
        [a[0] - aside[0], a[1] - aside[1]],
    ]
}

/// The outline of a disc.
fn round(centre: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let corners = (radius * 3.0).clamp(12.0, 90.0) as usize;
    let corner = |k: usize| {
        let (sin, cos) = (k as f64 / corners as f64 * core::f64::consts::TAU).sin_cos();
        [centre[0] + radius * cos, centre[1] + radius * sin]
    };
    (0..corners).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blank(wide: usize, tall: usize) -> Raster {
        Raster { wide, tall, pixels: vec![[0; 3]; wide * tall] }
    }

    #[test]
    fn pixels_are_covered_by_their_share() {
        let mut raster = blank(4, 4);
        raster.fill(&[[1.0, 1.0], [2.5, 1.0], [2.5, 2.5], [1.0, 2.5]], [200; 3], 1.0);
        let at = |x: usize, y: usize| raster.pixels[y * 4 + x][0];
        assert_eq!([at(0, 1), at(1, 1), at(2, 1), at(1, 2), at(2, 2), at(3, 3)], [0, 200, 100, 100, 50, 0]);
    }

    #[test]
    fn a_disc_has_its_area() {
        let mut raster = blank(40, 40);
        raster.fill(&round([20.0, 20.0], 15.0), [200; 3], 1.0);
        let area: f64 = raster.pixels.iter().map(|pixel| f64::from(pixel[0]) / 200.0).sum();
        assert!((area - core::f64::consts::PI * 225.0).abs() < 3.0, "{area}");
    }

    #[test]
    fn what_lies_outside_or_is_no_number_is_left_out() {
        let mut raster = blank(4, 4);
        raster.fill(&[[-9.0, -9.0], [-5.0, -9.0], [-5.0, -5.0]], [200; 3], 1.0);
        raster.fill(&[[90.0, 90.0], [95.0, 90.0], [95.0, 95.0]], [200; 3], 1.0);
        raster.fill(&[[f64::NAN, 0.0], [4.0, 0.0], [4.0, 4.0]], [200; 3], 1.0);
        raster.fill(&[[0.0, 0.0], [4.0, 4.0]], [200; 3], 1.0);
        assert!(raster.pixels.iter().all(|pixel| *pixel == [0; 3]));
        raster.fill(&[[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]], [200; 3], 1.0);
        assert!(raster.pixels.iter().all(|pixel| *pixel == [200; 3]), "cut off at all sides");
    }
}
