//! Rows of an approximating curve: more data points than control points.
//!
//! The normal operator `A^T W A` of a B-spline basis is a band, and a sum over data points; it is
//! stored as one more banded collocation, so that every rule and every factorisation serves it.

use super::BandedCollocation;
use super::build::collocate;
use super::kernel::Rows;
use crate::knots::{Boundary, KnotVector};
use crate::memory;

/// `A = [B_i(t_j)]` over data points `j` and the control points `i` that move. Memory:
/// `8 (p + 1) + 4` bytes a row.
#[derive(Debug, Clone)]
pub(crate) struct DataRows {
    degree: usize,
    columns: usize,
    first: Vec<i32>,
    weights: Vec<f64>,
}

impl DataRows {
    /// Collocates at parameters inside the domain, in any order.
    pub(crate) fn new(parameters: &[f64], knots: &KnotVector) -> Self {
        let degree = knots.degree();
        let repeated = if knots.boundary() == Boundary::Periodic { degree } else { 0 };
        let (first, weights) = collocate(parameters, knots).into_parts();
        Self { degree, columns: knots.control_points() - repeated, first, weights }
    }

    /// Control points that move.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// What the kernels take: no row wraps round more than once.
    pub(super) fn rows(&self) -> Rows<'_> {
        Rows {
            width: self.degree + 1,
            columns: self.columns,
            first: &self.first,
            weights: &self.weights,
        }
    }

    /// The first control point that data point `j` sees, and the weights of it and those after it,
    /// counted round a closed direction.
    pub(super) fn entries(&self, j: usize) -> (usize, &[f64]) {
        let order = self.degree + 1;
        let first = self.first[j] as usize;
        let first = if first < self.columns { first } else { first % self.columns };
        (first, &self.weights[j * order..][..order])
    }

    /// Data points.
    pub(super) fn points(&self) -> usize {
        self.first.len()
    }

    fn column(&self, first: i32, k: usize) -> usize {
        (first as usize + k) % self.columns
    }

    /// `A x` at one data point, added to `point`.
    pub(crate) fn add_point(&self, j: usize, control: &[f64], point: &mut [f64]) {
        let dimension = point.len();
        let weights = &self.weights[j * (self.degree + 1)..][..self.degree + 1];
        for (k, weight) in weights.iter().enumerate() {
            let near = &control[self.column(self.first[j], k) * dimension..][..dimension];
            point.iter_mut().zip(near).for_each(|(x, p)| *x += weight * p);
        }
    }

    /// Starts normal equations without data, for points of a dimension.
    pub(crate) fn equations(&self, dimension: usize) -> NormalEquations {
        let width = 2 * self.degree + 1;
        NormalEquations {
            degree: self.degree,
            columns: self.columns,
            dimension,
            band: memory::zeros(self.columns * width),
            right: memory::zeros(self.columns * dimension),
        }
    }

    /// Adds data point `j`, wanted at `point`, with a weight.
    pub(crate) fn add_to(
        &self,
        j: usize,
        weight: f64,
        point: &[f64],
        equations: &mut NormalEquations,
    ) {
        let (order, width) = (self.degree + 1, 2 * self.degree + 1);
        let weights = &self.weights[j * order..][..order];
        let first = self.first[j];
        for k in 0..order {
            let row = self.column(first, k);
            let scaled = weight * weights[k];
            // Entry (row, row + l - k) stands at place degree + l - k of the row.
            let band = &mut equations.band[row * width + self.degree - k..][..order];
            band.iter_mut().zip(weights).for_each(|(entry, other)| *entry += scaled * other);
            let right = &mut equations.right[row * point.len()..][..point.len()];
            right.iter_mut().zip(point).for_each(|(b, q)| *b += scaled * q);
        }
    }
}

/// `A^T W A x = A^T W q` on its way from data to a solution.
#[derive(Debug, Clone)]
pub(crate) struct NormalEquations {
    degree: usize,
    columns: usize,
    dimension: usize,
    /// Row by row, from `degree` columns before the diagonal to `degree` after it.
    band: Vec<f64>,
    right: Vec<f64>,
}

impl NormalEquations {
    /// Pulls every control point towards `start` with a small share of the mean diagonal: where data
    /// leave a control point free, it stays (singular LSPIA, Lin, Cao and Zhang 2018).
    pub(crate) fn hold(&mut self, start: &[f64], share: f64) {
        let width = 2 * self.degree + 1;
        let trace: f64 = (0..self.columns).map(|i| self.band[i * width + self.degree]).sum();
        let pull = share * trace / self.columns as f64;
        for i in 0..self.columns {
            self.band[i * width + self.degree] += pull;
        }
        self.right.iter_mut().zip(start).for_each(|(b, p)| *b += pull * p);
    }

    /// Adds a multiple of a band laid out like this one.
    #[allow(dead_code)]
    pub(super) fn add_band(&mut self, factor: f64, band: &[f64]) {
        self.band.iter_mut().zip(band).for_each(|(entry, other)| *entry += factor * other);
    }

    /// Fixes a control point.
    pub(crate) fn pin(&mut self, index: usize, point: &[f64]) {
        let (width, dimension) = (2 * self.degree + 1, self.dimension);
        for offset in 0..width {
            let Some(row) = (index + offset).checked_sub(self.degree) else { continue };
            if row >= self.columns || row == index {
                continue;
            }
            let entry = std::mem::take(&mut self.band[row * width + 2 * self.degree - offset]);
            let right = &mut self.right[row * dimension..][..dimension];
            right.iter_mut().zip(point).for_each(|(b, p)| *b -= entry * p);
        }
        self.band[index * width..][..width].fill(0.0);
        self.band[index * width + self.degree] = 1.0;
        self.right[index * dimension..][..dimension].copy_from_slice(point);
    }

    /// The matrix and the right side.
    pub(crate) fn into_parts(self) -> (BandedCollocation, Vec<f64>) {
        let first = (0..self.columns).map(|i| i as i32 - self.degree as i32).collect();
        (BandedCollocation::from_rows(2 * self.degree + 1, first, self.band), self.right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collocation::{CollocationMatrix, CollocationOperator};

    #[test]
    fn the_normal_band_is_the_product_of_the_matrices() {
        let open = KnotVector::open(2, vec![0.0, 0.0, 0.0, 0.4, 0.5, 1.0, 1.0, 1.0]).unwrap();
        let closed = KnotVector::periodic(2, (-2..8).map(f64::from).collect()).unwrap();
        for knots in [open, closed] {
            let (start, end) = knots.domain();
            let t: Vec<f64> =
                (0..23).map(|j| start + (end - start) * (f64::from(j) / 22.0)).collect();
            let rows = DataRows::new(&t, &knots);
            let n = rows.columns();
            let dense: Vec<Vec<f64>> = (0..t.len())
                .map(|j| {
                    let unit = |i: usize| {
                        let mut x = vec![0.0; n];
                        x[i] = 1.0;
                        let mut value = [0.0];
                        rows.add_point(j, &x, &mut value);
                        value[0]
                    };
                    (0..n).map(unit).collect()
                })
                .collect();
            let mut equations = rows.equations(1);
            (0..t.len()).for_each(|j| rows.add_to(j, 1.0 + j as f64, &[2.0], &mut equations));
            let (matrix, right) = equations.into_parts();
            for i in 0..n {
                let mut row = vec![0.0; n];
                matrix.visit_row(i, &mut |column, weight| row[column] += weight);
                for k in 0..n {
                    let sum: f64 =
                        (0..t.len()).map(|j| (1.0 + j as f64) * dense[j][i] * dense[j][k]).sum();
                    assert!((row[k] - sum).abs() < 1e-12, "{i} {k}");
                }
                let sum: f64 = (0..t.len()).map(|j| (1.0 + j as f64) * dense[j][i] * 2.0).sum();
                assert!((right[i] - sum).abs() < 1e-12);
            }
            assert_eq!(matrix.points(), n);
        }
    }
}
