//! How large a matrix and its inverse are.

use crate::Error;
use crate::collocation::{CollocationMatrix, Factorization};

/// Points up to which the inverse of a matrix that is not totally positive is formed.
const MOST_INVERTED: usize = 256;

/// The condition number in the maximum norm, `max_j sum_i |a_ji|` times the same of the inverse:
/// how much larger than the data control points can become.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Condition {
    /// Its value.
    pub value: f64,
    /// Whether that is exact to rounding; otherwise it is a lower bound.
    pub exact: bool,
    /// The row where the inverse is largest: the control point that data can move farthest.
    pub place: usize,
}

/// Measures a matrix by its factors.
pub(super) fn condition(
    matrix: &dyn CollocationMatrix,
    factors: &Factorization,
) -> Result<Condition, Error> {
    let count = matrix.points();
    let mut exact = true;
    let sums = if matrix.is_totally_positive() {
        // The signs of the inverse alternate, so that one solution gives all sums.
        alternating_solution(factors, count)
    } else if count <= MOST_INVERTED {
        let mut inverse = vec![0.0; count * count];
        (0..count).for_each(|j| inverse[j * count + j] = 1.0);
        factors.solve_in_place(&mut inverse, count);
        inverse.chunks_exact(count).map(|row| row.iter().map(|x| x.abs()).sum()).collect()
    } else {
        // Almost alternating: they need not fit together where the curve closes.
        exact = false;
        let one = alternating_solution(factors, count);
        let other = alternating_solution(factors, count / 2);
        one.into_iter().zip(other).map(|(a, b)| a.max(b)).collect()
    };
    let (place, inverse) = sums
        .iter()
        .enumerate()
        .fold((0, 0.0), |best, (j, &sum)| if sum > best.1 { (j, sum) } else { best });
    let value = norm(matrix) * inverse;
    if !value.is_finite() || value == 0.0 {
        return Err(Error::Singular { points: count });
    }
    Ok(Condition { value, exact, place })
}

/// `|A^-1 s|` with alternating signs `s`, which skip a beat at a place.
fn alternating_solution(factors: &Factorization, skip: usize) -> Vec<f64> {
    let mut x: Vec<f64> = (0..factors.size())
        .map(|j| if (j + usize::from(j >= skip)).is_multiple_of(2) { 1.0 } else { -1.0 })
        .collect();
    factors.solve_in_place(&mut x, 1);
    x.iter_mut().for_each(|x| *x = x.abs());
    x
}

/// Largest sum of absolute values of a row.
fn norm(matrix: &dyn CollocationMatrix) -> f64 {
    largest_row(matrix, |_, _, weight| weight.abs())
}

/// `||I - A||` in the maximum norm: below 1 it proves that PIA converges, each step at least by
/// this factor (Lin, Wang and Dong 2004).
pub(super) fn contraction(matrix: &dyn CollocationMatrix) -> f64 {
    largest_row(matrix, |j, column, weight| {
        // The part of the identity stands where the diagonal entry does, once.
        if column == j { (1.0 - weight).abs() } else { weight.abs() }
    })
}

fn largest_row(matrix: &dyn CollocationMatrix, size: impl Fn(usize, usize, f64) -> f64) -> f64 {
    (0..matrix.points()).fold(0.0, |most: f64, j| {
        let mut sum = 0.0;
        matrix.visit_row(j, &mut |column, weight| sum += size(j, column, weight));
        most.max(sum)
    })
}

/// Bounds of the largest singular value, by the power method on `A^T A`. For nonnegative matrices
/// the quotients of Collatz and Wielandt enclose it.
pub(super) fn largest_singular_value(matrix: &dyn CollocationMatrix) -> (f64, f64) {
    const ENOUGH: f64 = 1e-9;
    const MANY_POINTS: usize = 4096;
    let count = matrix.points();
    let most_steps = if count < MANY_POINTS { 300 } else { 10 };
    let mut x = vec![1.0; count];
    let mut ax = vec![0.0; count];
    let mut next = vec![0.0; count];
    let (mut lower, mut upper) = (0.0_f64, f64::INFINITY);
    for _ in 0..most_steps {
        matrix.apply(&x, 1, &mut ax);
        next.fill(0.0);
        for (j, ax) in ax.iter().enumerate() {
            matrix.visit_row(j, &mut |column, weight| next[column] += weight * ax);
        }
        let quotients = next.iter().zip(&x).filter(|(_, x)| **x > 0.0).map(|(y, x)| y / x);
        upper = upper.min(quotients.fold(0.0, f64::max).sqrt());
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        lower = lower.max((dot(&ax, &ax) / dot(&x, &x)).sqrt());
        if upper - lower <= ENOUGH * upper {
            break;
        }
        let largest = next.iter().fold(0.0, |most: f64, x| most.max(*x));
        x.iter_mut().zip(&next).for_each(|(x, y)| *x = (y / largest).max(f64::MIN_POSITIVE));
    }
    (lower, upper.max(lower))
}
