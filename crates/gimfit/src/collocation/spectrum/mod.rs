//! Eigenvalues that decide how fast an iteration runs, and the weights that follow from them.

mod eigenvalues;
mod jacobi;
mod weights;

pub use eigenvalues::{Eigenvalue, eigenvalues};
pub use jacobi::largest_jacobi_eigenvalue;
pub use weights::{best_weight, lemma2_weight, rate_with_weight};

use super::{CollocationMatrix, DenseCollocation, Factorization};
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
    /// The row that gives the lower bound: where the part of a residual that falls slowest sits.
    pub place: usize,
}

impl EigenvalueBounds {
    /// What weights are computed from: the lower bound is safe, but far off the estimate it would
    /// only be slow.
    #[must_use]
    pub fn for_weights(&self) -> f64 {
        self.lower.max(0.5 * self.estimate)
    }
}

const MOST_STEPS: usize = 60;
/// Relative accuracy at which the search ends.
const ENOUGH: f64 = 1e-3;
/// The same for many points: the best weight then costs a per cent of the steps at most.
const ENOUGH_FOR_MANY: f64 = 2e-2;
const MANY_POINTS: usize = 4096;

/// The smallest eigenvalue of a collocation matrix: from its law where there is one, enclosed
/// where the matrix is totally positive, and estimated, with the bounds 0 and 1, where it is dense
/// and not totally positive.
///
/// # Errors
/// [`Error::Singular`], [`Error::SingularBasis`].
pub fn smallest_eigenvalue_of(matrix: &dyn CollocationMatrix) -> Result<EigenvalueBounds, Error> {
    if let Some(value) = matrix.known_smallest_eigenvalue() {
        return Ok(EigenvalueBounds {
            lower: value,
            estimate: value,
            upper: value,
            steps: 0,
            place: 0,
        });
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
    EigenvalueBounds { lower: 0.0, estimate, upper: 1.0, steps, place: largest(&x) }
}

/// Encloses the smallest eigenvalue of `A` by inverse iteration on its factors.
///
/// The inverse of a totally positive matrix has alternating signs, so with `S = diag(+1, -1, ..)`
/// the matrix `S A^-1 S` is nonnegative and the quotients of Collatz and Wielandt bound its largest
/// eigenvalue, `1 / lambda_min`, from both sides at every step. Of many points the upper bound is
/// that of the best place and closes late; the lower one is that of the worst place, gains by a
/// steady ratio, and is followed to its limit (Aitken 1926), which is the estimate. On a closed
/// curve the matrix is not totally positive, signs may fail to alternate, and the bounds are
/// estimates.
#[must_use]
pub fn smallest_eigenvalue(factors: &Factorization) -> EigenvalueBounds {
    let count = factors.size();
    // No weight needs the eigenvalue closer, and with many points steps are dear.
    let (enough, enough_rest) = if count < MANY_POINTS {
        (ENOUGH, 0.1 * ENOUGH)
    } else {
        (ENOUGH_FOR_MANY, ENOUGH_FOR_MANY)
    };
    let mut x = vec![1.0; count];
    let mut work = vec![0.0; count];
    let mut bounds = EigenvalueBounds { lower: 0.0, estimate: 1.0, upper: 1.0, steps: 0, place: 0 };
    let mut gain_before = f64::NAN;
    for step in 1..=MOST_STEPS {
        let Some(quotients) = inverse_step(factors, &mut x, &mut work) else { break };
        let lower = bounds.lower.max(1.0 / quotients.most).min(1.0);
        let upper = bounds.upper.min(1.0 / quotients.least.max(1.0));
        let gain = lower - bounds.lower;
        let rest = rest_of_series(gain_before, gain);
        gain_before = gain;
        let enclosed = upper - lower <= enough * upper;
        let estimate = if enclosed { 1.0 / quotients.mean } else { lower + rest };
        bounds = EigenvalueBounds { lower, upper, steps: step, estimate, place: quotients.place };
        if enclosed || (step > 3 && rest <= enough_rest * lower) {
            break;
        }
    }
    bounds.estimate = bounds.estimate.clamp(bounds.lower, bounds.upper.max(bounds.lower));
    bounds
}

/// What one step of inverse iteration multiplies the entries of a vector by.
pub(super) struct Quotients {
    pub(super) least: f64,
    pub(super) most: f64,
    /// Where `most` is met.
    pub(super) place: usize,
    /// Of the norms.
    pub(super) mean: f64,
}

/// Replaces `x`, which is positive, by `|A^-1 S x|`, scaled; `None` once numbers run out.
pub(super) fn inverse_step(
    factors: &Factorization,
    x: &mut [f64],
    work: &mut [f64],
) -> Option<Quotients> {
    let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    for (j, (w, x)) in work.iter_mut().zip(&*x).enumerate() {
        *w = sign(j) * x;
    }
    factors.solve_in_place(work, 1);
    let (mut least, mut most, mut grown, mut was) = (f64::INFINITY, 0.0_f64, 0.0_f64, 0.0);
    let mut place = 0;
    for (j, (w, x)) in work.iter_mut().zip(&*x).enumerate() {
        *w = w.abs();
        let quotient = *w / x;
        least = least.min(quotient);
        if quotient > most {
            (most, place) = (quotient, j);
        }
        grown += *w * *w;
        was += x * x;
    }
    let mean = (grown / was).sqrt();
    if !(mean.is_finite() && mean > 0.0 && most.is_finite()) {
        return None;
    }
    // Entries kept positive, so that the quotients stay defined.
    let scale = 1.0 / mean;
    x.iter_mut().zip(&*work).for_each(|(x, w)| *x = (w * scale).max(f64::MIN_POSITIVE));
    Some(Quotients { least, most, place, mean })
}

/// What a series still gains after two successive gains, if their ratio holds.
fn rest_of_series(before: f64, last: f64) -> f64 {
    const HIGHEST_RATIO: f64 = 0.98;
    if last == 0.0 {
        return 0.0;
    }
    let ratio = last / before;
    if ratio >= 0.0 {
        last * ratio.min(HIGHEST_RATIO) / (1.0 - ratio.min(HIGHEST_RATIO))
    } else {
        last
    }
}

/// All eigenvalues of a matrix, those of largest real part first; `None` if the search fails. For a
/// few hundred points.
///
/// # Errors
/// [`Error::OutOfRange`] for more than [`MAX_DENSE_POINTS`](super::MAX_DENSE_POINTS).
pub fn all_eigenvalues(matrix: &dyn CollocationMatrix) -> Result<Option<Vec<Eigenvalue>>, Error> {
    let window = DenseCollocation::window(matrix, 0, matrix.points())?;
    Ok(eigenvalues(window.entries().to_vec(), matrix.points()))
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

/// Position of the entry of largest absolute value.
fn largest(x: &[f64]) -> usize {
    (0..x.len()).max_by(|&i, &j| x[i].abs().total_cmp(&x[j].abs())).unwrap_or(0)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
