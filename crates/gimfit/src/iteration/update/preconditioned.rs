//! Preconditioned PIA (Liu and Liu 2020): `P <- P + M^-1 (Q - A P)`, where M is the band of A
//! within a half bandwidth q, what lies beyond added to the diagonal.
//!
//! With q = 0, M is the identity and the rule is PIA. With the whole band M is A itself: a step is
//! a forward and a backward sweep over the control points, the first reaches the interpolant to
//! rounding whatever the spacing of the data, and further ones refine it.

use super::{Step, UpdateRule};
use crate::Error;
use crate::collocation::{CollocationMatrix, Factorization};

/// Progressive-iterative approximation preconditioned by a band.
#[derive(Debug, Clone)]
pub struct Preconditioned {
    factors: Factorization,
}

impl Preconditioned {
    /// Factors the whole band, or that within a half bandwidth.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub fn new(
        operator: &dyn CollocationMatrix,
        half_bandwidth: Option<usize>,
    ) -> Result<Self, Error> {
        Ok(Self { factors: operator.factor(half_bandwidth)? })
    }
}

impl UpdateRule for Preconditioned {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.factors.solve_in_place(vectors, step.dimension);
    }
}
