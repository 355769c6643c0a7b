//! Two-point crossover.

use super::{Crossover, SLOT};
use crate::Draws;

/// Genes of the second parent between two points, of the first elsewhere. The points are drawn on their own among all
/// places, both ends included; where they fall together the offspring is the first parent.
#[derive(Clone, Copy, Debug, Default)]
pub struct TwoPoint;

impl Crossover for TwoPoint {
    fn cross(&self, first: &[f64], second: &[f64], offspring: u64, draws: &Draws) -> Vec<f64> {
        let point = |slot| draws.below(first.len() + 1, offspring, slot);
        let (a, b) = (point(SLOT), point(SLOT + 1));
        let inside = a.min(b)..a.max(b);
        first
            .iter()
            .zip(second)
            .enumerate()
            .map(|(gene, (x, y))| if inside.contains(&gene) { *y } else { *x })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_run_of_genes_is_the_second_parents() {
        let mut lengths = [0; 6];
        for offspring in 0..2000 {
            let child = TwoPoint.cross(&[0.0; 5], &[1.0; 5], offspring, &Draws::new(1, 1));
            let changes = child.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(changes <= 2, "{child:?}");
            lengths[child.iter().filter(|&&gene| gene == 1.0).count()] += 1;
        }
        // of 36 pairs of points, 6 fall together and 2 take everything
        assert!((270..400).contains(&lengths[0]) && (80..150).contains(&lengths[5]), "{lengths:?}");
    }
}
