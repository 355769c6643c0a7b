//! Linear laws by least squares.

/// A linear law: constants and weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Linear {
    /// The outputs at inputs of 0, `[outputs]`.
    pub constants: Vec<f64>,
    /// What an input adds to an output, `[outputs][inputs]`; 0 of inputs that follow from those before them.
    pub weights: Vec<Vec<f64>>,
}

impl Linear {
    /// The outputs of inputs.
    pub fn of<const N: usize>(&self, inputs: &[f64]) -> [f64; N] {
        let one = |k: usize| -> f64 {
            let sum: f64 = self.weights[k].iter().zip(inputs).map(|(weight, input)| weight * input).sum();
            self.constants[k] + sum
        };
        core::array::from_fn(one)
    }
}

/// What an input leaves after those before it, as a share of its own length, must be more than this to count.
const FOLLOWS: f64 = 1e-9;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn subtract(from: &mut [f64], much: f64, of: &[f64]) {
    from.iter_mut().zip(of).for_each(|(x, of)| *x -= much * of);
}

/// Takes the mean off; the answer is the mean.
fn centred(values: &mut [f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    values.iter_mut().for_each(|value| *value -= mean);
    mean
}

/// The law of least squares of outputs over inputs, both by columns of equal length: inputs are made orthogonal in their order
/// (Gram-Schmidt, twice, which is as stable as reflections).
pub fn least_squares(mut inputs: Vec<Vec<f64>>, outputs: &[Vec<f64>]) -> Linear {
    let count = inputs.len();
    let means: Vec<f64> = inputs.iter_mut().map(|column| centred(column)).collect();
    // columns that count, orthonormal, and how those as given are made of them
    let mut basis: Vec<(usize, Vec<f64>)> = Vec::new();
    let mut made: Vec<Vec<f64>> = Vec::new();
    for (place, mut column) in inputs.into_iter().enumerate() {
        let length = dot(&column, &column).sqrt();
        let mut of = vec![0.0; basis.len()];
        for _ in 0..2 {
            for ((_, other), of) in basis.iter().zip(&mut of) {
                let much = dot(&column, other);
                subtract(&mut column, much, other);
                *of += much;
            }
        }
        let left = dot(&column, &column).sqrt();
        // a column of equal numbers leaves what rounding left of it
        let rounding = means[place].abs() * (column.len() as f64).sqrt() * 1e-12;
        if left <= (FOLLOWS * length).max(rounding) {
            continue;
        }
        column.iter_mut().for_each(|x| *x /= left);
        of.push(left);
        basis.push((place, column));
        made.push(of);
    }
    let mut law = Linear::default();
    for output in outputs {
        let mut rest = output.clone();
        let mean = centred(&mut rest);
        let mut along = Vec::with_capacity(basis.len());
        for (_, column) in &basis {
            let much = dot(&rest, column);
            subtract(&mut rest, much, column);
            along.push(much);
        }
        let mut weights = vec![0.0; count];
        for k in (0..basis.len()).rev() {
            let later: f64 = (k + 1..basis.len()).map(|j| made[j][k] * weights[basis[j].0]).sum();
            weights[basis[k].0] = (along[k] - later) / made[k][k];
        }
        law.constants.push(mean - dot(&weights, &means));
        law.weights.push(weights);
    }
    law
}
