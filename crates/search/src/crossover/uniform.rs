//! Uniform crossover.

use super::Crossover;
use crate::Draws;
use crate::draws::GENES;

/// Each gene from one parent or the other with equal chance.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uniform;

impl Crossover for Uniform {
    fn cross(&self, first: &[f64], second: &[f64], offspring: u64, draws: &Draws) -> Vec<f64> {
        let gene = |(gene, (x, y)): (usize, (&f64, &f64))| {
            if draws.uniform(offspring, GENES + gene as u32) < 0.5 { *x } else { *y }
        };
        first.iter().zip(second).enumerate().map(gene).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_genes_come_from_each() {
        let mut sums = [0.0; 3];
        for offspring in 0..2000 {
            let child = Uniform.cross(&[0.0; 3], &[1.0; 3], offspring, &Draws::new(1, 1));
            for (sum, gene) in sums.iter_mut().zip(child) {
                *sum += gene;
            }
        }
        assert!(sums.iter().all(|sum| (900.0..1100.0).contains(sum)), "{sums:?}");
    }
}
