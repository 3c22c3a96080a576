//! Jacobi-PIA: each difference vector divided by the diagonal entry of its row
//! (Liu and Deng 2015). Safe only where the diagonal dominates; it diverges on Bernstein bases and
//! on strongly graded data.

use super::UpdateRule;
use crate::collocation::BandedCollocation;
use crate::collocation::CollocationOperator;

/// Progressive-iterative approximation with the diagonal as weight.
#[derive(Debug, Clone)]
pub struct Jacobi {
    reciprocal: Vec<f64>,
}

impl Jacobi {
    /// Reads the diagonal of an operator.
    #[must_use]
    pub fn new(operator: &BandedCollocation) -> Self {
        let reciprocal = (0..operator.points()).map(|j| operator.diagonal(j).recip()).collect();
        Self { reciprocal }
    }
}

impl UpdateRule for Jacobi {
    fn adjust(&mut self, _: usize, vectors: &mut [f64], dimension: usize) {
        for (vector, factor) in vectors.chunks_exact_mut(dimension).zip(&self.reciprocal) {
            vector.iter_mut().for_each(|x| *x *= factor);
        }
    }
}
