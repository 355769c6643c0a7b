//! How well a group holds an agreement against noise, from who listens to whom.
//!
//! Each member moves its opinion towards those it listens to and errs at random all the time, `dx = -L x dt + dW` with the directed graph
//! Laplacian L (unit weights). The H2 norm is the root of the steady sum of squared departures from the common mean.
//!
//! G. F. Young, L. Scardovi, N. E. Leonard (2010), Robustness of noisy consensus dynamics with directed communication, American
//! Control Conference, 6312.

/// Whom each member listens to: `count` others of each of `members`, `[members][count]`.
#[derive(Clone, Copy, Debug)]
pub struct Listening<'a> {
    /// The others, by their places.
    pub others: &'a [u32],
    /// How many each listens to.
    pub count: usize,
}

impl Listening<'_> {
    fn members(&self) -> usize {
        self.others.len().checked_div(self.count).unwrap_or(0)
    }
    fn of(&self, member: usize) -> &[u32] {
        &self.others[member * self.count..(member + 1) * self.count]
    }

    /// Whether there is somebody whose opinion reaches everyone: else the group never agrees.
    pub fn agrees(&self) -> bool {
        let n = self.members();
        let mut heard_by = vec![Vec::new(); n];
        for member in 0..n {
            self.of(member).iter().for_each(|&other| heard_by[other as usize].push(member));
        }
        let flood = |from: usize, reached: &mut Vec<bool>| {
            let mut pending = vec![from];
            reached[from] = true;
            while let Some(member) = pending.pop() {
                for &listener in &heard_by[member] {
                    if !reached[listener] {
                        reached[listener] = true;
                        pending.push(listener);
                    }
                }
            }
        };
        // whoever reaches all is reached by no flood before the last that was begun, or began it
        let (mut reached, mut last) = (vec![false; n], None);
        for member in 0..n {
            if !reached[member] {
                flood(member, &mut reached);
                last = Some(member);
            }
        }
        let Some(last) = last else { return false };
        let mut reached = vec![false; n];
        flood(last, &mut reached);
        reached.iter().all(|&reached| reached)
    }

    /// The H2 norm of the disagreement. `None` for fewer than two members, or where the group never agrees.
    ///
    /// The covariance S of the departures solves `M S + S M' = I`, M the Laplacian without its mean row and with the mean opinion held
    /// by a spring, whose share is known and taken off again. It is solved by doubling (R. A. Smith 1968, SIAM Journal on Applied
    /// Mathematics 16:198) after a Cayley transform: the work is some thirty products of matrices of the order of the group.
    pub fn h2_norm(&self) -> Option<f64> {
        let n = self.members();
        if n < 2 || !self.agrees() {
            return None;
        }
        let spring = self.count as f64;
        // the pole of the transform, near the middle of the spectrum
        let pole = 0.3 * spring;
        let mut laplacian = Matrix::zero(n);
        for member in 0..n {
            laplacian.row_mut(member)[member] = self.count as f64;
            self.of(member).iter().for_each(|&other| laplacian.row_mut(member)[other as usize] -= 1.0);
        }
        let mut mean = vec![0.0; n];
        for row in laplacian.0.chunks_exact(n) {
            mean.iter_mut().zip(row).for_each(|(mean, entry)| *mean += entry / n as f64);
        }
        let held = spring / n as f64;
        let (mut low, mut high) = (Matrix::zero(n), Matrix::zero(n));
        for member in 0..n {
            for other in 0..n {
                let entry = laplacian.0[member * n + other] - mean[other] + held;
                let own = if member == other { pole } else { 0.0 };
                low.0[member * n + other] = own + entry;
                high.0[member * n + other] = own - entry;
            }
        }
        let inverse = low.inverse()?;
        let mut step = inverse.times(&high);
        let mut sum = inverse.times_transposed(&inverse);
        sum.0.iter_mut().for_each(|entry| *entry *= 2.0 * pole);
        for _ in 0..MOST_DOUBLINGS {
            let more = step.times(&sum).times_transposed(&step);
            let (before, added) = (sum.trace(), more.trace());
            sum.0.iter_mut().zip(&more.0).for_each(|(sum, more)| *sum += more);
            if added <= 1e-14 * before {
                break;
            }
            step = step.times(&step);
        }
        let squared = sum.trace() - 0.5 / spring;
        (squared.is_finite() && squared > 0.0).then(|| squared.sqrt())
    }

    /// The robustness of the agreement, the root of the number of members over the H2 norm; 0 where the group never agrees. `None` for
    /// fewer than two members.
    pub fn robustness(&self) -> Option<f64> {
        let n = self.members();
        (n > 1).then(|| self.h2_norm().map_or(0.0, |norm| (n as f64).sqrt() / norm))
    }
}

/// Doublings after which even a chain of a million would have settled.
const MOST_DOUBLINGS: usize = 50;

/// A square matrix, row by row.
struct Matrix(Vec<f64>, usize);

impl Matrix {
    fn zero(n: usize) -> Self {
        Self(vec![0.0; n * n], n)
    }
    fn row_mut(&mut self, row: usize) -> &mut [f64] {
        &mut self.0[row * self.1..(row + 1) * self.1]
    }
    fn trace(&self) -> f64 {
        self.0.iter().step_by(self.1 + 1).sum()
    }
    fn times(&self, other: &Self) -> Self {
        let n = self.1;
        let mut product = Self::zero(n);
        for (sums, row) in product.0.chunks_exact_mut(n).zip(self.0.chunks_exact(n)) {
            for (&factor, other) in row.iter().zip(other.0.chunks_exact(n)) {
                sums.iter_mut().zip(other).for_each(|(sum, entry)| *sum += factor * entry);
            }
        }
        product
    }
    /// The product with the transpose of the other.
    fn times_transposed(&self, other: &Self) -> Self {
        let n = self.1;
        let mut transposed = Self::zero(n);
        for (row, entries) in other.0.chunks_exact(n).enumerate() {
            entries.iter().enumerate().for_each(|(column, &entry)| transposed.0[column * n + row] = entry);
        }
        self.times(&transposed)
    }
    /// The inverse, by elimination with the greatest entry of each column. `None` where there is none.
    fn inverse(mut self) -> Option<Self> {
        let n = self.1;
        let mut inverse = Self::zero(n);
        (0..n).for_each(|k| inverse.0[k * n + k] = 1.0);
        for k in 0..n {
            let size = |row: usize| self.0[row * n + k].abs();
            let most = (k..n).fold(k, |most, row| if size(row) > size(most) { row } else { most });
            let pivot = self.0[most * n + k];
            if pivot == 0.0 || !pivot.is_finite() {
                return None;
            }
            for matrix in [&mut self, &mut inverse] {
                (0..n).for_each(|column| matrix.0.swap(most * n + column, k * n + column));
                matrix.row_mut(k).iter_mut().for_each(|entry| *entry /= pivot);
            }
            let (own, unit) = (self.row_mut(k).to_vec(), inverse.row_mut(k).to_vec());
            for row in (0..n).filter(|&row| row != k) {
                let factor = self.0[row * n + k];
                if factor != 0.0 {
                    self.row_mut(row).iter_mut().zip(&own).for_each(|(entry, own)| *entry -= factor * own);
                    inverse.row_mut(row).iter_mut().zip(&unit).for_each(|(entry, unit)| *entry -= factor * unit);
                }
            }
        }
        Some(inverse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn norm(count: usize, others: &[u32]) -> Option<f64> {
        Listening { others, count }.h2_norm()
    }
    #[track_caller]
    fn close(found: Option<f64>, squared: f64) {
        let fine = found.is_some_and(|found| (found * found - squared).abs() < 1e-9 * squared);
        assert!(fine, "{found:?} squared, expected {squared}");
    }

    #[test]
    fn everyone_listens_to_everyone() {
        // n - 1 modes of the rate n
        for n in [2u32, 3, 10, 40] {
            let others: Vec<u32> = (0..n).flat_map(|i| (0..n).filter(move |&j| j != i)).collect();
            close(norm(n as usize - 1, &others), f64::from(n - 1) / (2.0 * f64::from(n)));
        }
    }

    #[test]
    fn rings() {
        for n in [3u32, 8, 50] {
            // to both sides: sum over modes of 1 / (4 - 4 cos), which is (n^2 - 1) / 24
            let both: Vec<u32> = (0..n).flat_map(|i| [(i + 1) % n, (i + n - 1) % n]).collect();
            close(norm(2, &both), (f64::from(n).powi(2) - 1.0) / 24.0);
            // to one side: circulant, so normal; rates 1 - cos, sum of 1 / (2 - 2 cos), which is (n^2 - 1) / 12
            let one: Vec<u32> = (0..n).map(|i| (i + 1) % n).collect();
            close(norm(1, &one), (f64::from(n).powi(2) - 1.0) / 12.0);
        }
    }

    #[test]
    fn two_and_one_who_listens() {
        // 0 and 1 listen to each other, 2 to 0. Over (1, -1, 0)/sqrt 2 and (1, 1, -2)/sqrt 6 the Laplacian is
        // [[2, 0], [1/sqrt 3, 1]]: s11 = 1/4, s12 = -1/(12 sqrt 3), s22 = 1/2 - s12/sqrt 3
        let found = norm(1, &[1, 0, 0]);
        close(found, 0.25 + 0.5 + 1.0 / 36.0);
    }

    #[test]
    fn who_never_agrees() {
        // two pairs that listen to themselves alone
        assert_eq!(norm(1, &[1, 0, 3, 2]), None);
        assert_eq!(Listening { others: &[1, 0, 3, 2], count: 1 }.robustness(), Some(0.0));
        assert!(Listening { others: &[1, 0, 0, 2], count: 1 }.agrees());
        assert_eq!(norm(1, &[]), None);
        assert_eq!(Listening { others: &[], count: 3 }.robustness(), None);
        assert_eq!(Listening { others: &[], count: 0 }.robustness(), None);
    }
}
