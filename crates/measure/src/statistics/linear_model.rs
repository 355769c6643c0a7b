//! Least squares on the columns of a design.

use super::StatisticsError;

/// How much of the squares of values each run of columns explains after those before it.
///
/// Columns are `[values]` each, made orthogonal in their order (Gram-Schmidt, twice, which is as stable as reflections).
pub(super) struct Explained {
    /// Sum of squares for each run of columns.
    pub(super) squares: Vec<f64>,
    /// Sum of squares that none explains.
    pub(super) rest: f64,
}

/// Explains values by runs of columns.
///
/// # Errors
/// Where a column follows from those before it.
pub(super) fn explain(values: &[f64], runs: &[&[Vec<f64>]]) -> Result<Explained, StatisticsError> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let subtract =
        |from: &mut [f64], much: f64, of: &[f64]| from.iter_mut().zip(of).for_each(|(x, of)| *x -= much * of);
    let mut rest = values.to_vec();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut squares = Vec::new();
    for (place, run) in runs.iter().enumerate() {
        let mut explained = 0.0;
        for column in *run {
            let mut column = column.clone();
            let length = dot(&column, &column).sqrt();
            for _ in 0..2 {
                for other in &basis {
                    let much = dot(&column, other);
                    subtract(&mut column, much, other);
                }
            }
            let left = dot(&column, &column).sqrt();
            if left <= 1e-9 * length {
                return Err(StatisticsError::Confounded { what: format!("term {place}") });
            }
            column.iter_mut().for_each(|x| *x /= left);
            let much = dot(&rest, &column);
            subtract(&mut rest, much, &column);
            explained += much * much;
            basis.push(column);
        }
        squares.push(explained);
    }
    Ok(Explained { squares, rest: dot(&rest, &rest) })
}
