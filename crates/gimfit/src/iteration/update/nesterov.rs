//! Nesterov's acceleration: the gradient is taken where the momentum leads to (Nesterov 1983;
//! NmLSPIA, Liu, Wu, Li and Hu 2024).
//!
//! `Y = P_k + eta (P_k - P_(k-1))`, `P_(k+1) = Y + step A^T (Q - A Y)`, with `P_(-1) = P_0`. The gradient
//! is affine, so that at Y is made of those at `P_k` and `P_(k-1)`, and the loop measures at the control
//! points themselves.
//!
//! With the smallest and the largest eigenvalue of `A^T A` known, `eta = (s - t) / (s + t)` from their
//! roots. Without the smallest one, `eta_k = (k - 1) / (k + 2)`, counted from the last restart: momentum
//! that leads uphill is given up (O'Donoghue and Candes 2015).

use super::{Step, UpdateRule};
use crate::memory;

/// Steps from where the momentum leads to.
#[derive(Debug, Clone)]
pub struct Nesterov {
    step: f64,
    /// `None`: grows from 0 after every restart.
    momentum: Option<f64>,
    /// Steps since the last restart.
    since: usize,
    /// Gradients and adjusting vectors of the step before.
    gradients: Vec<f64>,
    moves: Vec<f64>,
}

impl Nesterov {
    /// With a growing momentum and restarts, for a largest eigenvalue of `A^T A`; `length` is the
    /// number of coordinates, control points times dimension.
    #[must_use]
    pub fn with_restarts(largest: f64, length: usize) -> Self {
        Self {
            step: largest.recip(),
            momentum: None,
            since: 0,
            gradients: memory::zeros(length),
            moves: memory::zeros(length),
        }
    }

    /// With the momentum that suits eigenvalues of `A^T A` between these, neither of them 0.
    #[must_use]
    pub fn best_for(smallest: f64, largest: f64, length: usize) -> Self {
        let (s, t) = (largest.sqrt(), smallest.sqrt());
        Self { momentum: Some((s - t) / (s + t)), ..Self::with_restarts(largest, length) }
    }

    fn momentum(&mut self, vectors: &[f64]) -> f64 {
        let uphill = vectors.iter().zip(&self.moves).map(|(g, moved)| g * moved).sum::<f64>() < 0.0;
        match self.momentum {
            Some(eta) => eta,
            None => {
                self.since = if uphill { 1 } else { self.since + 1 };
                (self.since - 1) as f64 / (self.since + 2) as f64
            }
        }
    }
}

impl UpdateRule for Nesterov {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        // Nothing has moved before the first step.
        let eta = if step.iteration == 0 { 0.0 } else { self.momentum(vectors) };
        if step.iteration == 0 {
            self.since = 1;
        }
        let memory = self.gradients.iter_mut().zip(&mut self.moves);
        for (x, (gradient, moved)) in vectors.iter_mut().zip(memory) {
            let ahead = *x + eta * (*x - *gradient);
            *gradient = *x;
            *x = eta * *moved + self.step * ahead;
            *moved = *x;
        }
    }

    fn reset(&mut self) {
        self.since = 0;
        self.moves.fill(0.0);
    }
}
