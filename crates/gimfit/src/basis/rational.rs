//! Any blending basis with positive weights.

use super::BlendingBasis;
use crate::Error;

/// `R_i(t) = w_i f_i(t) / sum_l w_l f_l(t)`: with Bernstein functions the basis of rational Bezier
/// curves. Positive weights keep total positivity (Shi and Wang 2006), so that whatever converges
/// without them does with them.
#[derive(Debug, Clone, PartialEq)]
pub struct Rational<B> {
    basis: B,
    name: String,
    weights: Vec<f64>,
}

impl<B: BlendingBasis> Rational<B> {
    /// Joins a basis and its weights, one per function; only their ratios count.
    ///
    /// # Errors
    /// [`Error::WrongCount`]; [`Error::OutOfRange`] for a weight that is not positive and finite;
    /// [`Error::Incompatible`] for a basis that is rational already.
    pub fn new(basis: B, weights: Vec<f64>) -> Result<Self, Error> {
        let most = check_weights(&weights, basis.functions())?;
        if basis.rational_weights().is_some() {
            return Err(Error::Incompatible {
                what: "rational weights",
                with: "a basis that has weights already",
                why: "multiply the weights, and give them once",
            });
        }
        // Only ratios count; near 1 no product leaves the range.
        let weights = weights.iter().map(|w| w / most).collect();
        let name = format!("rational {}", basis.name());
        Ok(Self { basis, name, weights })
    }
}

impl<B: BlendingBasis> BlendingBasis for Rational<B> {
    fn name(&self) -> &str {
        &self.name
    }

    fn functions(&self) -> usize {
        self.basis.functions()
    }

    fn domain(&self) -> (f64, f64) {
        self.basis.domain()
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        self.basis.evaluate_into(t, values);
        values.iter_mut().zip(&self.weights).for_each(|(value, w)| *value *= w);
        let sum: f64 = values.iter().sum();
        values.iter_mut().for_each(|value| *value /= sum);
    }

    fn is_totally_positive(&self) -> bool {
        self.basis.is_totally_positive()
    }

    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        self.basis.bernstein_coefficients()
    }

    fn rational_weights(&self) -> Option<&[f64]> {
        Some(&self.weights)
    }
}

/// Refuses weights that no rational basis has; gives back the largest.
pub(crate) fn check_weights(weights: &[f64], expected: usize) -> Result<f64, Error> {
    if weights.len() != expected {
        return Err(Error::WrongCount {
            what: "rational weights",
            given: weights.len(),
            expected,
            why: "one per basis function, thus per control point",
        });
    }
    if let Some(i) = weights.iter().position(|w| !(*w > 0.0 && w.is_finite())) {
        return Err(Error::OutOfRange {
            what: format!("rational weight {i}"),
            value: weights[i],
            rule: "rational weights must be positive and finite",
        });
    }
    let (least, most) =
        weights.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &w| (a.min(w), b.max(w)));
    if most / least > 1e100 {
        return Err(Error::OutOfRange {
            what: "ratio of the largest to the smallest rational weight".into(),
            value: most / least,
            rule: "it may not exceed 1e100",
        });
    }
    Ok(most)
}
