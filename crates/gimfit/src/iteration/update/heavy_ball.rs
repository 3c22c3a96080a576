//! Heavy ball: each step goes on a share of the step before (Polyak 1964). With its published weights
//! the LSPIA with memory (MLSPIA, Huang and Wang 2020) is the same iteration, control point by control
//! point: its memory variable, one vector per data point, can be eliminated.
//!
//! `P_(k+1) = P_k + step A^T (Q - A P_k) + momentum (P_k - P_(k-1))`; with s and t the roots of the
//! largest and the smallest eigenvalue of `A^T A`, `step = 4 / (s + t)^2` and
//! `momentum = ((s - t) / (s + t))^2` leave `(s - t) / (s + t)` of the error in each step.

use super::{Step, UpdateRule};
use crate::memory;

/// Steps with momentum.
#[derive(Debug, Clone)]
pub struct HeavyBall {
    step: f64,
    momentum: f64,
    /// The adjusting vectors of the step before.
    previous: Vec<f64>,
}

impl HeavyBall {
    /// With a step and a momentum in [0, 1); `length` is the number of coordinates, control points
    /// times dimension.
    #[must_use]
    pub fn new(step: f64, momentum: f64, length: usize) -> Self {
        Self { step, momentum, previous: memory::zeros(length) }
    }

    /// With the best ones for eigenvalues of `A^T A` between these, neither of them 0.
    #[must_use]
    pub fn best_for(smallest: f64, largest: f64, length: usize) -> Self {
        let (s, t) = (largest.sqrt(), smallest.sqrt());
        let momentum = (s - t) / (s + t);
        Self::new(4.0 / ((s + t) * (s + t)), momentum * momentum, length)
    }
}

impl UpdateRule for HeavyBall {
    fn adjust(&mut self, _: Step<'_>, vectors: &mut [f64]) {
        for (x, before) in vectors.iter_mut().zip(&mut self.previous) {
            *x = self.step * *x + self.momentum * *before;
            *before = *x;
        }
    }

    fn reset(&mut self) {
        self.previous.fill(0.0);
    }
}
