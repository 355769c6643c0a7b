//! One-point crossover.

use super::{Crossover, SLOT};
use crate::Draws;

/// Genes of the first parent up to a point, of the second behind it. The point lies between two genes, each such place
/// with the same chance, so that both parents always give something; a single gene comes from the first.
#[derive(Clone, Copy, Debug, Default)]
pub struct OnePoint;

impl Crossover for OnePoint {
    fn cross(&self, first: &[f64], second: &[f64], offspring: u64, draws: &Draws) -> Vec<f64> {
        let point = match first.len() {
            0 | 1 => 1,
            genes => 1 + draws.below(genes - 1, offspring, SLOT),
        };
        first.iter().take(point).chain(second.iter().skip(point)).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_between_genes_has_the_same_chance() {
        let mut counts = [0; 4];
        for offspring in 0..3000 {
            let child = OnePoint.cross(&[0.0; 4], &[1.0; 4], offspring, &Draws::new(1, 1));
            assert!(child.is_sorted());
            counts[child.iter().filter(|&&gene| gene == 0.0).count()] += 1;
        }
        assert_eq!(counts[0], 0);
        assert!(counts[1..].iter().all(|&count| (900..1100).contains(&count)), "{counts:?}");
        assert_eq!(OnePoint.cross(&[5.0], &[6.0], 0, &Draws::new(1, 1)), [5.0]);
    }
}
