//! Weighted PIA: difference vectors times a weight, the same for all points or one for each.
//!
//! `P <- P + omega (Q - A P)` (Lu 2010) is fastest for `omega = 2 / (1 + lambda_min)`. With a
//! weight per point (Chen, Wang and Jin 2012, section 3) any weights in (0, 2) converge for totally
//! positive bases: the rows scaled by them stay totally positive, and no eigenvalue exceeds the
//! largest weight.

use super::{Step, UpdateRule};

/// One weight for all points.
#[derive(Debug, Clone, Copy)]
pub struct Weighted {
    omega: f64,
}

impl Weighted {
    /// Weights all difference vectors by `omega`.
    #[must_use]
    pub fn new(omega: f64) -> Self {
        Self { omega }
    }

    /// The best weight where the smallest eigenvalue is known.
    #[must_use]
    pub fn best_for(smallest_eigenvalue: f64) -> f64 {
        2.0 / (1.0 + smallest_eigenvalue)
    }
}

impl UpdateRule for Weighted {
    fn adjust(&mut self, _: Step<'_>, vectors: &mut [f64]) {
        vectors.iter_mut().for_each(|x| *x *= self.omega);
    }
}

/// One weight per point.
#[derive(Debug, Clone)]
pub struct PerPoint {
    omega: Vec<f64>,
}

impl PerPoint {
    /// Weights the difference vector of point `j` by `omega[j]`.
    #[must_use]
    pub fn new(omega: Vec<f64>) -> Self {
        Self { omega }
    }
}

impl UpdateRule for PerPoint {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        for (vector, omega) in vectors.chunks_exact_mut(step.dimension).zip(&self.omega) {
            vector.iter_mut().for_each(|x| *x *= omega);
        }
    }
}

/// A rule after difference vectors were weighted: on `W A` in place of A.
#[derive(Debug, Clone)]
pub struct Scaled<R> {
    weights: PerPoint,
    rule: R,
}

impl<R: UpdateRule> Scaled<R> {
    /// Weights the difference vector of point `j` by `weights[j]` before the rule.
    #[must_use]
    pub fn new(weights: Vec<f64>, rule: R) -> Self {
        Self { weights: PerPoint::new(weights), rule }
    }
}

impl<R: UpdateRule> UpdateRule for Scaled<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.weights.adjust(step, vectors);
        self.rule.adjust(step, vectors);
    }

    fn is_stuck(&self) -> bool {
        self.rule.is_stuck()
    }

    fn reset(&mut self) {
        self.rule.reset();
    }
}
