//! Collocation on grids: an operator in each direction, never their Kronecker product.

use std::sync::{Mutex, PoisonError};

use super::{CollocationOperator, ResidualNorms};
use crate::memory;

/// `A_u (x) A_v` on m x n points: applied one direction after the other.
#[derive(Debug)]
pub struct TensorCollocation<'a> {
    across: AcrossCollocation<'a>,
    along: AlongCollocation<'a>,
    /// `A_v P` on its way to `A_u A_v P`; allocated once, used by one call at a time.
    between: Mutex<Vec<f64>>,
}

impl<'a> TensorCollocation<'a> {
    /// Joins the operators of both directions, for points of a dimension.
    #[must_use]
    pub fn new(
        u: &'a dyn CollocationOperator,
        v: &'a dyn CollocationOperator,
        dimension: usize,
    ) -> Self {
        let length = u.points() * v.points() * dimension;
        Self {
            across: AcrossCollocation::new(u, v.points()),
            along: AlongCollocation::new(v, u.points()),
            between: Mutex::new(memory::zeros(length)),
        }
    }

    fn with_product<R>(&self, x: &[f64], dimension: usize, finish: impl FnOnce(&[f64]) -> R) -> R {
        let mut between = self.between.lock().unwrap_or_else(PoisonError::into_inner);
        between.resize(x.len(), 0.0);
        self.along.apply(x, dimension, &mut between);
        finish(&between)
    }
}

impl CollocationOperator for TensorCollocation<'_> {
    fn points(&self) -> usize {
        self.along.points()
    }

    fn control_points(&self) -> usize {
        self.along.points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.with_product(x, dimension, |y| self.across.apply(y, dimension, result));
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.with_product(control, dimension, |y| {
            self.across.difference_vectors(data, y, dimension, result)
        })
    }
}

/// An operator on the rows of a grid: each column of the grid is a curve of its own. A row of n
/// points is one point of n times the dimension to the kernels.
#[derive(Debug, Clone, Copy)]
pub struct AcrossCollocation<'a> {
    operator: &'a dyn CollocationOperator,
    columns: usize,
}

impl<'a> AcrossCollocation<'a> {
    /// Acts on grids with this many columns.
    #[must_use]
    pub fn new(operator: &'a dyn CollocationOperator, columns: usize) -> Self {
        Self { operator, columns }
    }
}

impl CollocationOperator for AcrossCollocation<'_> {
    fn points(&self) -> usize {
        self.operator.points() * self.columns
    }

    fn control_points(&self) -> usize {
        self.points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.operator.apply(x, self.columns * dimension, result);
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let wide = self.columns * dimension;
        self.operator.difference_vectors(data, control, wide, result);
        norms_of(result, dimension)
    }
}

/// An operator on the columns of a grid: each row of the grid is a curve of its own.
#[derive(Debug, Clone, Copy)]
pub struct AlongCollocation<'a> {
    operator: &'a dyn CollocationOperator,
    rows: usize,
}

impl<'a> AlongCollocation<'a> {
    /// Acts on grids with this many rows.
    #[must_use]
    pub fn new(operator: &'a dyn CollocationOperator, rows: usize) -> Self {
        Self { operator, rows }
    }
}

impl CollocationOperator for AlongCollocation<'_> {
    fn points(&self) -> usize {
        self.operator.points() * self.rows
    }

    fn control_points(&self) -> usize {
        self.points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        let line = self.operator.points() * dimension;
        for (x, result) in x.chunks_exact(line).zip(result.chunks_exact_mut(line)) {
            self.operator.apply(x, dimension, result);
        }
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let line = self.operator.points() * dimension;
        let lines = data.chunks_exact(line).zip(control.chunks_exact(line));
        for ((data, control), result) in lines.zip(result.chunks_exact_mut(line)) {
            self.operator.difference_vectors(data, control, dimension, result);
        }
        norms_of(result, dimension)
    }
}

/// Norms of difference vectors that stand in an array.
fn norms_of(vectors: &[f64], dimension: usize) -> ResidualNorms {
    let (mut largest, mut max_index, mut sum) = (0.0, 0, 0.0);
    for (j, vector) in vectors.chunks_exact(dimension).enumerate() {
        let square: f64 = vector.iter().map(|x| x * x).sum();
        sum += square;
        if square > largest {
            (largest, max_index) = (square, j);
        }
    }
    let max = if f64::is_finite(sum) { f64::sqrt(largest) } else { f64::NAN };
    let count = vectors.len() / dimension;
    ResidualNorms { max, max_index, rms: f64::sqrt(sum / count as f64) }
}
