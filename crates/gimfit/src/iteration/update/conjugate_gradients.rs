//! Conjugate gradients on the normal equations (CGLS, Hestenes and Stiefel 1952), with or without a
//! preconditioner: the step along directions that do not undo each other is the longest that pays.
//!
//! With `s = A^T W (Q - A P)`, `z = M^-1 s` and `gamma = <s, z>`, coordinate by coordinate:
//! `d = z + (gamma / gamma_before) d`, `alpha = gamma / <d, A^T W A d>`, `P <- P + alpha d`. No weight
//! has to be found. The loop measures s anew in every step, so that rounding does not add up.
//!
//! M is the identity (CGLS), the diagonal of `A^T W A` or the column sums (PCG), or the factors of the
//! whole band, with which the first step is the last but for rounding.

use super::{Step, UpdateRule};
use crate::collocation::{CollocationOperator, Factorization};
use crate::memory;

/// What gradients are multiplied by before directions are made of them.
#[derive(Debug, Clone)]
pub enum Preconditioner {
    /// Nothing.
    Identity,
    /// One number per control point, such as reciprocal diagonal entries.
    Diagonal(Vec<f64>),
    /// The inverse of a matrix close to the normal matrix.
    Factors(Factorization),
}

/// Conjugate gradients of a normal matrix.
#[derive(Debug, Clone)]
pub struct ConjugateGradients<'a> {
    normal: &'a dyn CollocationOperator,
    preconditioner: Preconditioner,
    direction: Vec<f64>,
    /// The gradients, then the normal matrix times the direction.
    product: Vec<f64>,
    /// `<s, z>` of this step and of the one before, and `<d, N d>`: three numbers per coordinate.
    sums: Vec<[f64; 3]>,
    started: bool,
    /// Whether all coordinates share a step.
    joint: bool,
}

impl<'a> ConjugateGradients<'a> {
    /// For a symmetric normal matrix, on points of a dimension.
    #[must_use]
    pub fn new(
        normal: &'a dyn CollocationOperator,
        preconditioner: Preconditioner,
        dimension: usize,
    ) -> Self {
        let length = normal.control_points() * dimension;
        Self {
            normal,
            preconditioner,
            direction: memory::zeros(length),
            product: memory::zeros(length),
            sums: vec![[0.0; 3]; dimension],
            started: false,
            joint: false,
        }
    }

    /// Takes one step length for all coordinates: where constraints couple them, coordinates that go
    /// their own way would leave these.
    #[must_use]
    pub fn joint(mut self) -> Self {
        self.joint = true;
        self
    }

    /// Adds up a sum over all coordinates, where they share it.
    fn share(&mut self, which: usize) {
        if self.joint {
            let whole = self.sums.iter().map(|sums| sums[which]).sum();
            self.sums.iter_mut().for_each(|sums| sums[which] = whole);
        }
    }
}

impl UpdateRule for ConjugateGradients<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let dimension = step.dimension;
        self.product.copy_from_slice(vectors);
        match &self.preconditioner {
            Preconditioner::Identity => {}
            Preconditioner::Diagonal(factors) => {
                for (vector, factor) in vectors.chunks_exact_mut(dimension).zip(factors) {
                    vector.iter_mut().for_each(|x| *x *= factor);
                }
            }
            Preconditioner::Factors(factors) => factors.solve_in_place(vectors, dimension),
        }
        for sums in &mut self.sums {
            *sums = [0.0, sums[0], 0.0];
        }
        let pairs = self.product.chunks_exact(dimension).zip(vectors.chunks_exact(dimension));
        for (s, z) in pairs {
            for (sums, (s, z)) in self.sums.iter_mut().zip(s.iter().zip(z)) {
                sums[0] += s * z;
            }
        }
        self.share(0);
        let started = std::mem::replace(&mut self.started, true);
        let pairs = self.direction.chunks_exact_mut(dimension).zip(vectors.chunks_exact(dimension));
        for (d, z) in pairs {
            for ((d, z), sums) in d.iter_mut().zip(z).zip(&self.sums) {
                *d = if started { z + quotient(sums[0], sums[1]) * *d } else { *z };
            }
        }
        self.normal.apply(&self.direction, dimension, &mut self.product);
        let pairs =
            self.direction.chunks_exact(dimension).zip(self.product.chunks_exact(dimension));
        for (d, n) in pairs {
            for (sums, (d, n)) in self.sums.iter_mut().zip(d.iter().zip(n)) {
                sums[2] += d * n;
            }
        }
        self.share(2);
        let pairs = vectors.chunks_exact_mut(dimension).zip(self.direction.chunks_exact(dimension));
        for (vector, d) in pairs {
            for ((x, d), sums) in vector.iter_mut().zip(d).zip(&self.sums) {
                *x = quotient(sums[0], sums[2]) * d;
            }
        }
    }

    fn reset(&mut self) {
        self.started = false;
    }
}

/// A coordinate that is done has no gradient left, and no way to go.
fn quotient(gamma: f64, whole: f64) -> f64 {
    if whole > 0.0 && gamma > 0.0 { gamma / whole } else { 0.0 }
}
