//! Gauss-Seidel PIA (Wang, Li and Deng 2018) and its over-relaxation: a sweep in which each control
//! point already sees its moved predecessors.
//!
//! Told in difference vectors, a sweep from `P` adds the solution of `(D / omega + L) delta = R`,
//! where D is the diagonal of the collocation matrix and L what stands left of it.

use super::{Step, UpdateRule};
use crate::collocation::CollocationMatrix;

/// Progressive-iterative approximation by Gauss-Seidel sweeps.
#[derive(Debug, Clone, Copy)]
pub struct GaussSeidel<'a> {
    sweep: Sor<'a>,
}

impl<'a> GaussSeidel<'a> {
    /// Sweeps over the rows of an operator.
    #[must_use]
    pub fn new(operator: &'a dyn CollocationMatrix) -> Self {
        Self { sweep: Sor::new(operator, 1.0) }
    }
}

impl UpdateRule for GaussSeidel<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.sweep.adjust(step, vectors);
    }
}

/// Successive over-relaxation of the Gauss-Seidel sweep.
#[derive(Debug, Clone, Copy)]
pub struct Sor<'a> {
    operator: &'a dyn CollocationMatrix,
    omega: f64,
}

impl<'a> Sor<'a> {
    /// Sweeps with relaxation factor `omega` in (0, 2).
    #[must_use]
    pub fn new(operator: &'a dyn CollocationMatrix, omega: f64) -> Self {
        Self { operator, omega }
    }

    /// The best factor where a Gauss-Seidel sweep leaves `rate` of the error
    /// (Young 1954; exact for tridiagonal matrices, where `rate` is the square of Jacobi's).
    #[must_use]
    pub fn best_for(rate: f64) -> f64 {
        2.0 / (1.0 + (1.0 - rate.clamp(0.0, 1.0)).sqrt())
    }
}

impl UpdateRule for Sor<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.operator.sweep(self.omega, vectors, step.dimension);
    }
}
