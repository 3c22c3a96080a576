//! Eigenvalues that decide how fast an iteration runs.

use super::{CollocationMatrix, Factorization};
use crate::Error;

/// Where the smallest eigenvalue of a collocation matrix lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EigenvalueBounds {
    /// Lower bound.
    pub lower: f64,
    /// Best estimate.
    pub estimate: f64,
    /// Upper bound.
    pub upper: f64,
    /// Steps of inverse iteration taken.
    pub steps: usize,
}

const MOST_STEPS: usize = 60;
const ENOUGH: f64 = 1e-3;

/// The smallest eigenvalue of a collocation matrix: from its law where there is one, enclosed
/// where the matrix is totally positive, and estimated, with the bounds 0 and 1, where it is dense
/// and not totally positive.
///
/// # Errors
/// [`Error::Singular`], [`Error::SingularBasis`].
pub fn smallest_eigenvalue_of(matrix: &dyn CollocationMatrix) -> Result<EigenvalueBounds, Error> {
    if let Some(value) = matrix.known_smallest_eigenvalue() {
        return Ok(EigenvalueBounds { lower: value, estimate: value, upper: value, steps: 0 });
    }
    let factors = matrix.factor(None)?;
    if factors.is_dense() && !matrix.is_totally_positive() {
        return Ok(estimated(&factors));
    }
    Ok(smallest_eigenvalue(&factors))
}

/// Plain inverse iteration: converges where one real eigenvalue lies nearest to 0.
fn estimated(factors: &Factorization) -> EigenvalueBounds {
    const STEPS: usize = 200;
    // Rough, and without symmetry, so that no eigenvector is missed.
    let mut x: Vec<f64> = (0..factors.size())
        .map(|j| if j % 2 == 0 { 1.0 } else { -1.0 } + 0.37 * ((j * j % 11) as f64))
        .collect();
    let mut estimate = f64::NAN;
    let mut steps = 0;
    for step in 1..=STEPS {
        let before = norm(&x);
        x.iter_mut().for_each(|x| *x /= before);
        factors.solve_in_place(&mut x, 1);
        let next = norm(&x).recip();
        if !(next.is_finite() && next > 0.0) {
            break;
        }
        steps = step;
        let settled = (next - estimate).abs() <= 1e-9 * next;
        estimate = next;
        if settled {
            break;
        }
    }
    let estimate = if estimate.is_nan() { 0.0 } else { estimate.min(1.0) };
    EigenvalueBounds { lower: 0.0, estimate, upper: 1.0, steps }
}

/// Encloses the smallest eigenvalue of `A` by inverse iteration on its factors.
///
/// The inverse of a totally positive matrix has alternating signs, so with `S = diag(+1, -1, ..)`
/// the matrix `S A^-1 S` is nonnegative and the quotients of Collatz and Wielandt bound its largest
/// eigenvalue, `1 / lambda_min`, from both sides at every step. On a closed curve the matrix is not
/// totally positive, signs may fail to alternate, and the bounds are estimates.
#[must_use]
pub fn smallest_eigenvalue(factors: &Factorization) -> EigenvalueBounds {
    let count = factors.size();
    let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut x = vec![1.0; count];
    let mut work = vec![0.0; count];
    let mut bounds = EigenvalueBounds { lower: 0.0, estimate: 1.0, upper: 1.0, steps: 0 };
    for step in 1..=MOST_STEPS {
        for (j, (w, x)) in work.iter_mut().zip(&x).enumerate() {
            *w = sign(j) * x;
        }
        factors.solve_in_place(&mut work, 1);
        let (mut least, mut most, mut grown, mut was) = (f64::INFINITY, 0.0_f64, 0.0, 0.0);
        for (j, (w, x)) in work.iter_mut().zip(&x).enumerate() {
            *w = (*w * sign(j)).abs();
            let quotient = *w / x;
            least = least.min(quotient);
            most = most.max(quotient);
            grown += *w * *w;
            was += x * x;
        }
        let growth = (grown / was).sqrt();
        if !(growth.is_finite() && growth > 0.0 && most.is_finite()) {
            break;
        }
        bounds = EigenvalueBounds {
            lower: bounds.lower.max(1.0 / most).min(1.0),
            estimate: (1.0 / growth).min(1.0),
            upper: bounds.upper.min(1.0 / least.max(1.0)),
            steps: step,
        };
        if bounds.upper - bounds.lower <= ENOUGH * bounds.upper {
            break;
        }
        // Entries kept positive, so that the quotients stay defined.
        let scale = 1.0 / growth;
        x.iter_mut().zip(&work).for_each(|(x, w)| *x = (w * scale).max(f64::MIN_POSITIVE));
    }
    bounds.estimate = bounds.estimate.clamp(bounds.lower, bounds.upper.max(bounds.lower));
    bounds
}

/// Spectral radius of a Gauss-Seidel sweep, estimated by power iteration: how much of a smooth
/// residual is left after each sweep.
#[must_use]
pub fn gauss_seidel_rate(operator: &dyn CollocationMatrix) -> f64 {
    const STEPS: usize = 30;
    let count = operator.points();
    // Without symmetry, so that no mode is missed.
    let mut error: Vec<f64> =
        (0..count).map(|j| if j % 2 == 0 { 1.0 } else { -1.0 } + 0.1 * ((j % 7) as f64)).collect();
    let zero = vec![0.0; count];
    let mut work = vec![0.0; count];
    let mut rate = 0.0;
    for _ in 0..STEPS {
        let before = norm(&error);
        if !(before.is_finite() && before > 0.0) {
            break;
        }
        error.iter_mut().for_each(|x| *x /= before);
        // One sweep for the data 0 turns the error x into x + (D + L)^-1 (0 - A x).
        operator.difference_vectors(&zero, &error, 1, &mut work);
        operator.sweep(1.0, &mut work, 1);
        error.iter_mut().zip(&work).for_each(|(x, w)| *x += w);
        rate = norm(&error);
    }
    rate.clamp(0.0, 1.0)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
