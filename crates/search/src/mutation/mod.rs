//! Mutation: a change of one gene. One file each, one line each in the list below.

use crate::{Domain, Draws};

/// An operator that changes one gene of an offspring.
pub trait Mutation: Send + Sync {
    /// The new value of a gene, before it is brought inside its bounds.
    fn change(&self, value: f64, axis: &crate::Axis, offspring: u64, draws: &Draws) -> f64;
}

/// Slots: whether the offspring mutates, which gene, and from [`VALUE`] on the new value.
const WHETHER: u32 = 8;
const WHICH: u32 = 9;
/// First slot of the new value.
const VALUE: u32 = 10;

macro_rules! mutations {
    ($($file:ident::$name:ident, $id:literal, $about:literal;)*) => {
        $(pub mod $file;)*
        /// Every operator: its name in files and what it does.
        pub const LIST: &[(&str, &str)] = &[$(($id, $about)),*];
        /// The operator of a name.
        pub fn find(id: &str) -> Option<Box<dyn Mutation>> {
            match id {
                $($id => Some(Box::new($file::$name::default())),)*
                _ => None,
            }
        }
    };
}

mutations! {
    creep::Creep, "creep", "the gene goes up or down by a normal step of a fifth of its reference";
    reset::Reset, "reset", "the gene is drawn anew between its bounds";
}

/// Changes one gene of an offspring, drawn with equal chance, with a probability of `rate`. Says which.
pub(crate) fn mutate(
    mutation: &dyn Mutation,
    rate: f64,
    genes: &mut [f64],
    domain: &Domain,
    offspring: u64,
    draws: &Draws,
) -> Option<usize> {
    if draws.uniform(offspring, WHETHER) >= rate {
        return None;
    }
    let which = draws.below(genes.len(), offspring, WHICH);
    let axis = &domain.axes()[which];
    genes[which] = axis.inside(mutation.change(genes[which], axis, offspring, draws));
    Some(which)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    #[test]
    fn one_gene_changes_at_the_given_rate_and_stays_inside() {
        let domain = Domain::new(vec![Axis::new(0.0, 2.0), Axis::new(-1.0, 1.0).about(0.5)]).unwrap();
        for (id, _) in LIST {
            let mutation = find(id).unwrap();
            let mut changed = [0; 2];
            for offspring in 0..4000 {
                let mut genes = [1.9, 0.0];
                let which = mutate(&*mutation, 0.25, &mut genes, &domain, offspring, &Draws::new(4, 4));
                assert!((0.0..=2.0).contains(&genes[0]) && (-1.0..=1.0).contains(&genes[1]), "{id}: {genes:?}");
                for gene in 0..2 {
                    assert!(which == Some(gene) || genes[gene] == [1.9, 0.0][gene], "{id}");
                }
                if let Some(which) = which {
                    changed[which] += 1;
                }
            }
            assert!(changed.iter().all(|&count| (430..570).contains(&count)), "{id}: {changed:?}");
            assert_eq!(mutate(&*mutation, 0.0, &mut [1.0, 0.0], &domain, 1, &Draws::new(4, 4)), None);
        }
    }
}
