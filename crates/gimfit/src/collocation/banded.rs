//! Collocation of univariate bases: every row holds a few neighbouring weights.

use super::kernel::{self, Rows};
use super::{CollocationMatrix, CollocationOperator, Factorization, ResidualNorms};
use crate::Error;

/// Square collocation matrix whose row `j` has `width` weights near column `j`, wrapping round for
/// closed curves. Memory: `8 width + 4` bytes a row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BandedCollocation {
    width: usize,
    first: Vec<i32>,
    weights: Vec<f64>,
}

impl BandedCollocation {
    pub(super) fn from_rows(width: usize, first: Vec<i32>, weights: Vec<f64>) -> Self {
        debug_assert_eq!(weights.len(), first.len() * width);
        Self { width, first, weights }
    }

    pub(super) fn into_rows(self) -> (usize, Vec<i32>, Vec<f64>) {
        (self.width, self.first, self.weights)
    }

    pub(crate) fn rows(&self) -> Rows<'_> {
        Rows {
            width: self.width,
            columns: self.first.len(),
            first: &self.first,
            weights: &self.weights,
        }
    }

    /// The non-zero entries of row `j` as (column, weight).
    pub fn row(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let rows = self.rows();
        self.signed_row(j).map(move |(column, weight)| (rows.column(column, 0), weight))
    }

    /// As [`BandedCollocation::row`], with columns that have not been wrapped.
    pub(super) fn signed_row(&self, j: usize) -> impl Iterator<Item = (i32, f64)> + '_ {
        let first = self.first[j];
        let weights = &self.weights[j * self.width..][..self.width];
        weights
            .iter()
            .enumerate()
            .map(move |(k, &weight)| (first + k as i32, weight))
            .filter(|&(_, weight)| weight != 0.0)
    }

    /// Collocates the rational functions `w_i B_i / sum_l w_l B_l` in place of the `B_i`, for positive
    /// weights of the control points that move. A totally positive matrix stays so.
    pub(crate) fn weigh(&mut self, rational_weights: &[f64]) {
        let columns = self.first.len() as i32;
        let rows = self.first.iter().zip(self.weights.chunks_exact_mut(self.width));
        for (&first, row) in rows {
            let mut sum = 0.0;
            for (k, entry) in row.iter_mut().enumerate() {
                *entry *= rational_weights[(first + k as i32).rem_euclid(columns) as usize];
                sum += *entry;
            }
            row.iter_mut().for_each(|entry| *entry /= sum);
        }
    }

    /// The diagonally compensated reduction to a half bandwidth.
    fn compensated(&self, half_bandwidth: usize) -> Self {
        let mut reduced = self.clone();
        let limit = i32::try_from(half_bandwidth).unwrap_or(i32::MAX);
        let rows = self.first.iter().zip(reduced.weights.chunks_exact_mut(self.width));
        for (j, (&first, weights)) in rows.enumerate() {
            let diagonal = j as i32 - first;
            for k in 0..weights.len() {
                if (k as i32 - diagonal).abs() > limit {
                    weights[diagonal as usize] += std::mem::take(&mut weights[k]);
                }
            }
        }
        reduced
    }
}

impl CollocationOperator for BandedCollocation {
    fn points(&self) -> usize {
        self.first.len()
    }

    fn control_points(&self) -> usize {
        self.first.len()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        kernel::apply(self.rows(), x, dimension, result);
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let (largest, max_index, sum) =
            kernel::residual(self.rows(), data, control, dimension, result);
        let max = if sum.is_finite() { largest.sqrt() } else { f64::NAN };
        ResidualNorms { max, max_index, rms: (sum / self.first.len() as f64).sqrt(), normal: None }
    }

    fn as_band(&self) -> Option<&BandedCollocation> {
        Some(self)
    }
}

impl CollocationMatrix for BandedCollocation {
    fn visit_row(&self, j: usize, visit: &mut dyn FnMut(usize, f64)) {
        self.row(j).for_each(|(column, weight)| visit(column, weight));
    }

    fn sweep(&self, omega: f64, vectors: &mut [f64], dimension: usize) {
        kernel::sweep(self.rows(), omega, vectors, dimension);
    }

    fn factor(&self, half_bandwidth: Option<usize>) -> Result<Factorization, Error> {
        match half_bandwidth {
            Some(q) => Factorization::of_band(&self.compensated(q)),
            None => Factorization::of_band(self),
        }
    }

    fn factor_comparison(&self) -> Result<Factorization, Error> {
        let mut comparison = self.clone();
        let rows = self.first.iter().zip(comparison.weights.chunks_exact_mut(self.width));
        for (j, (&first, weights)) in rows.enumerate() {
            weights.iter_mut().for_each(|x| *x = -x.abs());
            let diagonal = (j as i32 - first) as usize;
            weights[diagonal] = -weights[diagonal];
        }
        Factorization::of_band(&comparison)
    }

    fn is_totally_positive(&self) -> bool {
        // Rows of B-splines at ascending parameters; a row that wraps round spoils it.
        let columns = self.first.len();
        self.first.iter().all(|&first| first >= 0 && first as usize + self.width <= columns)
    }
}

/// Norms of the `count` difference vectors of an array that `counted` names.
pub(super) fn norms_of(
    vectors: &[f64],
    dimension: usize,
    count: usize,
    counted: impl Fn(usize) -> bool,
) -> ResidualNorms {
    let (mut largest, mut max_index, mut sum) = (-1.0, 0, 0.0);
    for (j, vector) in vectors.chunks_exact(dimension).enumerate() {
        if !counted(j) {
            continue;
        }
        let square: f64 = vector.iter().map(|x| x * x).sum();
        sum += square;
        if square > largest {
            (largest, max_index) = (square, j);
        }
    }
    let max = if f64::is_finite(sum) { f64::sqrt(largest.max(0.0)) } else { f64::NAN };
    ResidualNorms { max, max_index, rms: f64::sqrt(sum / count.max(1) as f64), normal: None }
}
