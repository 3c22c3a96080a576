//! Collocation on grids: an operator in each direction, never their Kronecker product.

use std::sync::{Mutex, PoisonError};

use super::kernel::{self, Rows};
use super::{CollocationOperator, ResidualNorms};
use crate::{memory, threads};

/// `A_u (x) A_v` on m x n points: applied one direction after the other.
#[derive(Debug)]
pub struct TensorCollocation<'a> {
    across: AcrossCollocation<'a>,
    along: AlongCollocation<'a>,
    /// Allocated once, used by one call at a time.
    work: Mutex<Work>,
}

/// What is on its way.
#[derive(Debug, Default)]
struct Work {
    /// Of two bands: a row of `A_u P` for each thread. Otherwise `A_v P`.
    between: Vec<f64>,
    /// Largest squared norm of each row of difference vectors, its column, and the sum of all.
    norms: Vec<f64>,
}

/// Numbers in `norms` for each row.
const NORMS: usize = 3;

impl<'a> TensorCollocation<'a> {
    /// Joins the operators of both directions, for points of a dimension.
    #[must_use]
    pub fn new(
        u: &'a dyn CollocationOperator,
        v: &'a dyn CollocationOperator,
        dimension: usize,
    ) -> Self {
        let (rows, line) = (u.points(), v.points() * dimension);
        let work = if u.as_band().is_some() && v.as_band().is_some() {
            let bands = threads::bands(rows * line);
            Work { between: vec![0.0; bands * line], norms: vec![0.0; rows * NORMS] }
        } else {
            Work { between: memory::zeros(rows * line), norms: Vec::new() }
        };
        Self {
            across: AcrossCollocation::new(u, v.points()),
            along: AlongCollocation::new(v, u.points()),
            work: Mutex::new(work),
        }
    }

    fn bands(&self) -> Option<[Rows<'a>; 2]> {
        Some([self.across.operator.as_band()?.rows(), self.along.operator.as_band()?.rows()])
    }

    /// Rows of difference vectors one by one: a row of `A_u P` is made, and met by `A_v` while it is
    /// in the cache. The norms of each row are joined in the order of the rows.
    fn difference_of_bands(
        &self,
        [u, v]: [Rows<'a>; 2],
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let Work { between, norms } = &mut *work;
        let line = v.columns * dimension;
        let bands = threads::bands(result.len());
        between.resize(bands * line, 0.0);
        norms.resize(u.columns * NORMS, 0.0);
        threads::for_each_row(
            bands,
            [result, norms],
            [line, NORMS],
            between,
            |row, parts, line_of| {
                let [result, norms] = parts;
                kernel::combine(u, row, control, line, line_of);
                let start = row * line;
                let data = &data[start..start + line];
                let (largest, column, sum) = kernel::residual(v, data, line_of, dimension, result);
                norms.copy_from_slice(&[largest, column as f64, sum]);
            },
        );
        let (mut largest, mut max_index, mut sum) = (0.0, 0, 0.0);
        for (row, norms) in norms.chunks_exact(NORMS).enumerate() {
            sum += norms[2];
            if norms[0] > largest {
                (largest, max_index) = (norms[0], row * v.columns + norms[1] as usize);
            }
        }
        norms_from(largest, max_index, sum, u.columns * v.columns)
    }

    fn with_product<R>(&self, x: &[f64], dimension: usize, finish: impl FnOnce(&[f64]) -> R) -> R {
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        work.between.resize(x.len(), 0.0);
        self.along.apply(x, dimension, &mut work.between);
        finish(&work.between)
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
        if let Some(bands) = self.bands() {
            return self.difference_of_bands(bands, data, control, dimension, result);
        }
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
pub(super) fn norms_of(vectors: &[f64], dimension: usize) -> ResidualNorms {
    let (mut largest, mut max_index, mut sum) = (0.0, 0, 0.0);
    for (j, vector) in vectors.chunks_exact(dimension).enumerate() {
        let square: f64 = vector.iter().map(|x| x * x).sum();
        sum += square;
        if square > largest {
            (largest, max_index) = (square, j);
        }
    }
    norms_from(largest, max_index, sum, vectors.len() / dimension)
}

fn norms_from(largest: f64, max_index: usize, sum: f64, count: usize) -> ResidualNorms {
    let max = if f64::is_finite(sum) { f64::sqrt(largest) } else { f64::NAN };
    ResidualNorms { max, max_index, rms: f64::sqrt(sum / count as f64), normal: None }
}
