//! Jacobi-PIA: each difference vector divided by the diagonal entry of its row
//! (Liu and Deng 2015). Safe only where the diagonal dominates; it diverges on Bernstein bases and
//! on strongly graded data.

use super::{Step, UpdateRule};
use crate::collocation::CollocationMatrix;

/// Progressive-iterative approximation with the diagonal as weight.
#[derive(Debug, Clone)]
pub struct Jacobi {
    reciprocal: Vec<f64>,
}

impl Jacobi {
    /// Reads the diagonal of an operator.
    #[must_use]
    pub fn new(operator: &dyn CollocationMatrix) -> Self {
        let reciprocal = (0..operator.points()).map(|j| operator.diagonal(j).recip()).collect();
        Self { reciprocal }
    }
}

impl UpdateRule for Jacobi {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        for (vector, factor) in vectors.chunks_exact_mut(step.dimension).zip(&self.reciprocal) {
            vector.iter_mut().for_each(|x| *x *= factor);
        }
    }
}
