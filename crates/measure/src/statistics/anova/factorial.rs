//! Analysis of variance of several factors.

use super::{Effect, Residual};
use crate::statistics::descriptive::centre;
use crate::statistics::linear_model::explain;
use crate::statistics::{StatisticsError, check};

/// Which sums of squares, where cells are of different size. For cells of equal size they are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SquaresType {
    /// II: a term after all terms that do not contain it. More powerful, where interactions are absent.
    Second,
    /// III: a term after all other terms, with contrasts that sum to zero. Each factor averaged over the others' levels
    /// with equal weight.
    Third,
}

/// An analysis of variance of several factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Factorial {
    /// Each term: the places of its factors (one for a main effect, several for an interaction), and its effect. Main
    /// effects come first, then interactions of two, and so on.
    pub terms: Vec<(Vec<usize>, Effect)>,
    /// What no term explains.
    pub residual: Residual,
}

/// Which factors, and which of their interactions, change the mean?
///
/// `factors` are `[factors, values]`: the level of each factor for each value, from 0 without gaps. With `interactions`
/// the model has all of them, and every combination of levels needs a value; without, it is additive, and combinations
/// may be missing (so a block may be a factor in a design with missing cells). Least squares on contrasts that sum to
/// zero; equals `anova_lm(typ=2)` and `anova_lm(typ=3)` of statsmodels with `C(factor, Sum)`. Assumes independent normal
/// errors of equal variance.
///
/// # Errors
/// For no factor, a factor of one level or of another length than the values, a level or a needed combination without a
/// value, factors that cannot be told apart, no degree of freedom or no spread in the residual, values that are not
/// finite or too large for their squares.
pub fn factorial(
    values: &[f64],
    factors: &[&[usize]],
    interactions: bool,
    squares_type: SquaresType,
) -> Result<Factorial, StatisticsError> {
    check::values("the sample", values, 2)?;
    check::at_least("factors", 1, factors.len())?;
    let levels = factors
        .iter()
        .enumerate()
        .map(|(place, factor)| levels_of(place, factor, values.len()))
        .collect::<Result<Vec<_>, _>>()?;
    if interactions {
        every_cell(factors, &levels)?;
    }
    let size = check::size(values);
    let mean = check::not_overflown("a mean", centre(values))?;
    let centred: Vec<f64> = values.iter().map(|value| value - mean).collect();
    check::not_overflown("a sum of squares", centred.iter().map(|x| x * x).sum())?;

    let terms = terms(factors.len(), interactions);
    let columns: Vec<Vec<Vec<f64>>> = terms.iter().map(|term| contrasts(term, factors, &levels)).collect();
    let constant = [vec![1.0; values.len()]];
    let after = |kept: &dyn Fn(usize) -> bool, last: Option<usize>| {
        let others = (0..terms.len()).filter(|&other| kept(other));
        let runs = others.chain(last).map(|term| columns[term].as_slice());
        explain(&centred, &core::iter::once(&constant[..]).chain(runs).collect::<Vec<_>>())
    };
    let full = after(&|_| true, None)?;
    let parameters: usize = 1 + columns.iter().map(Vec::len).sum::<usize>();
    let residual = Residual::new(full.rest, values.len().saturating_sub(parameters))?;
    check::spread("within the cells", full.rest, values.len(), size)?;
    let effect = |term: usize| {
        let contains = |other: usize| terms[term].iter().all(|factor| terms[other].contains(factor));
        let explained = match squares_type {
            SquaresType::Second => after(&|other| !contains(other), Some(term)),
            SquaresType::Third => after(&|other| other != term, Some(term)),
        }?;
        let squares = explained.squares.last().copied().unwrap_or(0.0);
        Ok((terms[term].clone(), Effect::new(squares, columns[term].len(), &residual)?))
    };
    let terms = (0..terms.len()).map(effect).collect::<Result<Vec<_>, StatisticsError>>()?;
    Ok(Factorial { terms, residual })
}

/// The number of levels of a factor that has as many entries as there are values, and a value for each level.
fn levels_of(place: usize, factor: &[usize], values: usize) -> Result<usize, StatisticsError> {
    if factor.len() != values {
        return Err(StatisticsError::Lengths {
            what: format!("factor {place}"),
            expected: values,
            found: factor.len(),
        });
    }
    let mut present: Vec<usize> = factor.to_vec();
    present.sort_unstable();
    present.dedup();
    check::at_least(&format!("levels of factor {place}"), 2, present.len())?;
    match present.iter().enumerate().find(|(level, found)| level != *found) {
        Some((level, _)) => Err(StatisticsError::EmptyCell { what: format!("level {level} of factor {place}") }),
        None => Ok(present.len()),
    }
}

/// Every combination of levels has a value.
fn every_cell(factors: &[&[usize]], levels: &[usize]) -> Result<(), StatisticsError> {
    let values = factors[0].len();
    let mut cells: Vec<Vec<usize>> =
        (0..values).map(|value| factors.iter().map(|factor| factor[value]).collect()).collect();
    cells.sort_unstable();
    cells.dedup();
    // combinations in ascending order, as the cells are
    let mut wanted = vec![0; levels.len()];
    for cell in cells.iter().map(Some).chain([None]) {
        if cell != Some(&wanted) {
            let words = wanted.iter().enumerate().map(|(factor, level)| format!("level {level} of factor {factor}"));
            return Err(StatisticsError::EmptyCell { what: words.collect::<Vec<_>>().join(" with ") });
        }
        let Some(digit) = (0..levels.len()).rev().find(|&factor| wanted[factor] + 1 < levels[factor]) else { break };
        wanted[digit] += 1;
        wanted[digit + 1..].fill(0);
    }
    Ok(())
}

/// The terms of the model as places of factors.
fn terms(factors: usize, interactions: bool) -> Vec<Vec<usize>> {
    let mut terms: Vec<Vec<usize>> = (0..factors).map(|factor| vec![factor]).collect();
    let mut begin = 0;
    while interactions && begin < terms.len() {
        let longer: Vec<Vec<usize>> = terms[begin..]
            .iter()
            .flat_map(|term| {
                let last = term.last().copied().unwrap_or(0);
                (last + 1..factors).map(move |next| [term.as_slice(), &[next]].concat())
            })
            .collect();
        begin = terms.len();
        terms.extend(longer);
    }
    terms
}

/// The columns of a term: products of each factor's contrasts, whose entries sum to zero over its levels.
fn contrasts(term: &[usize], factors: &[&[usize]], levels: &[usize]) -> Vec<Vec<f64>> {
    let mut columns = vec![vec![1.0; factors[0].len()]];
    for &factor in term {
        let last = levels[factor] - 1;
        let entry = |level: usize, column: usize| {
            if level == last { -1.0 } else { f64::from(u8::from(level == column)) }
        };
        columns = columns
            .iter()
            .flat_map(|before| {
                (0..last).map(move |column| {
                    before.iter().zip(factors[factor]).map(|(x, &level)| x * entry(level, column)).collect()
                })
            })
            .collect();
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::{blocked, one_way};

    #[test]
    fn one_factor_is_one_way() {
        let anova = one_way(&[&[1.0, 2.0, 4.0], &[3.0, 4.0, 6.0, 7.0]]).unwrap();
        let values = [1.0, 2.0, 4.0, 3.0, 4.0, 6.0, 7.0];
        for squares_type in [SquaresType::Second, SquaresType::Third] {
            let model = factorial(&values, &[&[0, 0, 0, 1, 1, 1, 1]], true, squares_type).unwrap();
            assert!((model.terms[0].1.f - anova.effect.f).abs() < 1e-12);
            assert!((model.residual.sum_of_squares - anova.residual.sum_of_squares).abs() < 1e-12);
        }
    }

    #[test]
    fn additive_model_is_blocked() {
        let (a, b) = ([10.0, 22.0, 31.0, 39.0], [10.9, 23.1, 32.0, 40.1]);
        let anova = blocked(&[&a, &b]).unwrap();
        let factors: [&[usize]; 2] = [&[0, 0, 0, 0, 1, 1, 1, 1], &[0, 1, 2, 3, 0, 1, 2, 3]];
        let model = factorial(&[a, b].concat(), &factors, false, SquaresType::Second).unwrap();
        assert!((model.terms[0].1.f / anova.effect.f - 1.0).abs() < 1e-10);
        assert!((model.terms[1].1.f / anova.blocks.f - 1.0).abs() < 1e-10);
        // a missing cell is no obstacle
        let less: [&[usize]; 2] = [&[0, 0, 0, 0, 1, 1, 1], &[0, 1, 2, 3, 0, 1, 2]];
        assert!(factorial(&[a, b].concat()[..7], &less, false, SquaresType::Second).is_ok());
    }

    #[test]
    fn balanced_by_hand() {
        // cell means 1 3 / 5 11, two values each at +-1: effects of 36 * 2, 2 * 16 and the interaction 2 * 4
        let values = [0.0, 2.0, 2.0, 4.0, 4.0, 6.0, 10.0, 12.0];
        let factors: [&[usize]; 2] = [&[0, 0, 0, 0, 1, 1, 1, 1], &[0, 0, 1, 1, 0, 0, 1, 1]];
        for squares_type in [SquaresType::Second, SquaresType::Third] {
            let model = factorial(&values, &factors, true, squares_type).unwrap();
            let squares: Vec<f64> = model.terms.iter().map(|(_, effect)| effect.sum_of_squares).collect();
            for (ours, exact) in squares.iter().zip([72.0, 32.0, 8.0]) {
                assert!((ours - exact).abs() < 1e-12);
            }
            assert_eq!(model.terms[2].0, [0, 1]);
            assert!((model.residual.sum_of_squares - 8.0).abs() < 1e-12 && model.residual.degrees == 4.0);
        }
    }

    #[test]
    fn bad_input() {
        let error = |values: &[f64], factors: &[&[usize]], interactions| {
            factorial(values, factors, interactions, SquaresType::Third).map_err(|error| error.to_string()).map(|_| ())
        };
        let values = [1.0, 2.0, 4.0, 3.0];
        assert_eq!(error(&values, &[&[0, 0, 2, 2]], true), Err("there is no value for level 1 of factor 0".into()));
        assert_eq!(
            error(&values, &[&[0, 0, 1, 1], &[0, 1, 0, 0]], true),
            Err("there is no value for level 1 of factor 0 with level 1 of factor 1".into())
        );
        assert!(
            error(&values, &[&[0, 0, 1, 1], &[0, 0, 1, 1]], false).is_err_and(|error| error.contains("told apart"))
        );
        assert!(error(&values, &[&[0, 0, 1]], false).is_err());
        assert!(error(&values, &[], false).is_err());
        assert!(error(&[1.0, f64::INFINITY, 4.0, 3.0], &[&[0, 0, 1, 1]], false).is_err());
        assert!(error(&[1e200, -1e200, 4.0, 3.0], &[&[0, 0, 1, 1]], false).is_err());
        assert!(error(&[1.0, 1.0, 3.0, 3.0], &[&[0, 0, 1, 1]], false).is_err());
    }
}
