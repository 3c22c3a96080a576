//! The Bernstein basis, at degrees where powers and binomials alone would leave doubles.

use super::blending::{BlendingBasis, check_blending_degree};
use crate::Error;

/// `B_i(t) = C(n, i) t^i (1 - t)^(n - i)` on [0, 1]: the basis of Bezier curves, normalised totally
/// positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bernstein {
    degree: usize,
}

impl Bernstein {
    /// Of a degree from 1 to 500.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(degree: usize) -> Result<Self, Error> {
        check_blending_degree(degree)?;
        Ok(Self { degree })
    }
}

impl BlendingBasis for Bernstein {
    fn name(&self) -> &str {
        "bernstein"
    }

    fn functions(&self) -> usize {
        self.degree + 1
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        bernstein_into(t, values);
    }

    fn is_totally_positive(&self) -> bool {
        true
    }

    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        let count = self.degree + 1;
        let mut identity = vec![0.0; count * count];
        (0..count).for_each(|i| identity[i * count + i] = 1.0);
        Some(identity)
    }

    fn uniform_smallest_eigenvalue(&self) -> Option<f64> {
        Some(factorial_over_power(self.degree))
    }
}

/// `n! / n^n`, the smallest eigenvalue of Bernstein collocation at `i / n`.
pub(crate) fn factorial_over_power(n: usize) -> f64 {
    (1..=n).map(|k| k as f64 / n as f64).product()
}

/// The Bernstein polynomials of degree `values.len() - 1` at `t` in [0, 1]: ratios of neighbours
/// from the largest outwards, brought to the sum 1. No step subtracts, and only values below the
/// range of doubles vanish.
pub(crate) fn bernstein_into(t: f64, values: &mut [f64]) {
    let n = values.len() - 1;
    let peak = (((n + 1) as f64 * t) as usize).min(n);
    let s = 1.0 - t;
    values.fill(0.0);
    values[peak] = 1.0;
    for j in peak..n {
        values[j + 1] = values[j] * ((n - j) as f64 * t / ((j + 1) as f64 * s));
    }
    for j in (0..peak).rev() {
        values[j] = values[j + 1] * ((j + 1) as f64 * s / ((n - j) as f64 * t));
    }
    let sum: f64 = values.iter().sum();
    values.iter_mut().for_each(|value| *value /= sum);
}
