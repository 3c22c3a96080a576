//! Collocation of rational surfaces whose weights are no product: no Kronecker product any more, but
//! one between two diagonals, `D^-1 (A_u (x) A_v) W`, where W holds the weights and D the sums
//! `(A_u (x) A_v) w`. Positive diagonals keep total positivity, and leave the eigenvalues of whatever
//! is scaled by them likewise.

use super::grid::norms_of;
use super::{CollocationOperator, ResidualNorms, TensorCollocation};
use crate::memory;
use std::sync::{Mutex, PoisonError};

/// The weights of a net, and the values of their own surface at the data.
#[derive(Debug, Clone, PartialEq)]
pub struct NetWeights {
    weights: Vec<f64>,
    sums: Vec<f64>,
}

impl NetWeights {
    /// For weights of the control points that move, row by row.
    #[must_use]
    pub fn new(
        u: &dyn CollocationOperator,
        v: &dyn CollocationOperator,
        weights: Vec<f64>,
    ) -> Self {
        let mut sums = vec![0.0; weights.len()];
        TensorCollocation::new(u, v, 1).apply(&weights, 1, &mut sums);
        Self { weights, sums }
    }

    /// The weights and sums at some positions: what local PIA of these points sees.
    pub(crate) fn at(&self, points: &[usize]) -> Self {
        let gather = |all: &[f64]| points.iter().map(|&k| all[k]).collect();
        Self { weights: gather(&self.weights), sums: gather(&self.sums) }
    }

    /// The weights.
    #[must_use]
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Their sums `sum_ij B_i(u) B_j(v) w_ij` at the parameters of the data.
    #[must_use]
    pub fn sums(&self) -> &[f64] {
        &self.sums
    }
}

/// `D^-1 (A_u (x) A_v) W`.
#[derive(Debug)]
pub struct RationalTensorCollocation<'a> {
    tensor: TensorCollocation<'a>,
    net: &'a NetWeights,
    /// `W P` on its way; allocated once, used by one call at a time.
    lifted: Mutex<Vec<f64>>,
}

impl<'a> RationalTensorCollocation<'a> {
    /// Joins the operators of both directions and the weights, for points of a dimension.
    #[must_use]
    pub fn new(
        u: &'a dyn CollocationOperator,
        v: &'a dyn CollocationOperator,
        net: &'a NetWeights,
        dimension: usize,
    ) -> Self {
        let lifted = Mutex::new(memory::zeros(net.weights.len() * dimension));
        Self { tensor: TensorCollocation::new(u, v, dimension), net, lifted }
    }
}

impl CollocationOperator for RationalTensorCollocation<'_> {
    fn points(&self) -> usize {
        self.tensor.points()
    }

    fn control_points(&self) -> usize {
        self.tensor.control_points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        let mut lifted = self.lifted.lock().unwrap_or_else(PoisonError::into_inner);
        lifted.clear();
        let points = x.chunks_exact(dimension).zip(&self.net.weights);
        lifted.extend(points.flat_map(|(point, w)| point.iter().map(move |x| w * x)));
        self.tensor.apply(&lifted, dimension, result);
        for (point, sum) in result.chunks_exact_mut(dimension).zip(&self.net.sums) {
            point.iter_mut().for_each(|x| *x /= sum);
        }
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.apply(control, dimension, result);
        result.iter_mut().zip(data).for_each(|(x, q)| *x = q - *x);
        norms_of(result, dimension)
    }
}
