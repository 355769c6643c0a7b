//! Crossover: two parents, one offspring. One file each, one line each in the list below.

use crate::Draws;

/// An operator that makes one offspring of two parents.
pub trait Crossover: Send + Sync {
    /// The offspring number `offspring` of two parents with the same number of genes, which is not zero.
    fn cross(&self, first: &[f64], second: &[f64], offspring: u64, draws: &Draws) -> Vec<f64>;
}

/// Slots of a crossover; selection has those before, mutation those behind.
const SLOT: u32 = 4;

macro_rules! crossovers {
    ($($file:ident::$name:ident, $id:literal, $about:literal;)*) => {
        $(pub mod $file;)*
        /// Every operator: its name in files and what it does.
        pub const LIST: &[(&str, &str)] = &[$(($id, $about)),*];
        /// The operator of a name.
        pub fn find(id: &str) -> Option<Box<dyn Crossover>> {
            match id {
                $($id => Some(Box::new($file::$name)),)*
                _ => None,
            }
        }
    };
}

crossovers! {
    one_point::OnePoint, "one_point", "genes of the first parent up to a random point, of the second behind it";
    two_point::TwoPoint, "two_point", "genes of the second parent between two random points, of the first elsewhere";
    uniform::Uniform, "uniform", "each gene from one parent or the other with equal chance";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gene_comes_from_its_own_place_in_a_parent() {
        for (id, _) in LIST {
            let crossover = find(id).unwrap();
            for genes in 1..6 {
                let first: Vec<f64> = (0..genes).map(f64::from).collect();
                let second: Vec<f64> = (0..genes).map(|gene| f64::from(gene) + 100.0).collect();
                for offspring in 0..40 {
                    let child = crossover.cross(&first, &second, offspring, &Draws::new(2, 3));
                    assert_eq!(child.len(), first.len());
                    for (gene, value) in child.iter().enumerate() {
                        assert!([first[gene], second[gene]].contains(value), "{id}: gene {gene} is {value}");
                    }
                }
            }
        }
    }
}
