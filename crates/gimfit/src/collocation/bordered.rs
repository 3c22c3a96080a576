//! Band factors without pivoting, bordered where the matrix wraps round.
//!
//! Elimination without pivoting is stable for totally positive matrices (de Boor and Pinkus 1977)
//! and keeps the band. A closed curve's matrix wraps round; its last few unknowns are set apart and
//! met through their Schur complement, which is stable as long as the band left is well conditioned.

use super::band_kernel;
use super::{BandedCollocation, CollocationOperator};
use crate::memory;

/// Factors of a band, and of what lies around it. Memory: `8 (2 reach + 1)` bytes a row; border
/// columns on top where the matrix wraps.
#[derive(Debug, Clone)]
pub(super) struct BorderedFactors {
    count: usize,
    reach: usize,
    /// Multipliers of the `reach` rows before each row.
    lower: Vec<f64>,
    /// Reciprocal pivot of each row, then the `reach` entries after it over the pivot.
    upper: Vec<f64>,
    border: Option<Border>,
}

/// Largest error of a probe, in units of its solution, that factors may leave.
const MOST_ERROR: f64 = 1e-13;

/// The unknowns set apart, `x2`, in `[B E; F G] [x1; x2] = [r1; r2]`.
#[derive(Debug, Clone)]
struct Border {
    size: usize,
    /// `B^-1 E`, shape (band rows, size).
    reach: Vec<f64>,
    /// Entries of the rows set apart that lie left of the border: (row, column, weight).
    rows: Vec<(usize, usize, f64)>,
    /// Inverse of the Schur complement `G - F B^-1 E`, shape (size, size).
    inverse: Vec<f64>,
}

impl BorderedFactors {
    /// Factors an operator; `None` where that needs pivoting.
    pub(super) fn new(operator: &BandedCollocation, reach: usize, wrapped: usize) -> Option<Self> {
        let reach = band_kernel::stored_reach(reach);
        let count = operator.points() - wrapped;
        let mut factors = Self {
            count,
            reach,
            lower: memory::with_capacity(count * reach),
            upper: memory::with_capacity(count * (reach + 1)),
            border: None,
        };
        let (lower, upper) = (&mut factors.lower, &mut factors.upper);
        let mut sound = band_kernel::factor(operator.rows(), count, reach, lower, upper);
        if wrapped > 0 {
            let mut border = Border::new(operator, wrapped);
            factors.substitute_band(&mut border.reach, wrapped);
            sound &= border.complete();
            factors.border = Some(border);
        }
        (sound && (wrapped == 0 || factors.pass_probe(operator))).then_some(factors)
    }

    /// Factors another band of as many rows that does not wrap; false where that needs pivoting.
    pub(super) fn renew(&mut self, operator: &BandedCollocation, reach: usize) -> bool {
        let widest = band_kernel::stored_reach(operator.rows().width - 1);
        self.count = operator.points();
        self.reach = band_kernel::stored_reach(reach);
        self.border = None;
        self.lower.clear();
        self.upper.clear();
        self.lower.reserve(self.count * widest);
        self.upper.reserve(self.count * (widest + 1));
        let (lower, upper) = (&mut self.lower, &mut self.upper);
        band_kernel::factor(operator.rows(), self.count, self.reach, lower, upper)
    }

    /// Whether a right side made of a rough vector is met again: the band without its border may be
    /// so badly conditioned that the way round it loses all digits.
    fn pass_probe(&self, operator: &BandedCollocation) -> bool {
        let count = operator.points();
        // Of both signs, without a period.
        let probe: Vec<f64> =
            (0..count).map(|j| (1.0 + j as f64 * 2.399_963_229_728_653).sin()).collect();
        let mut right = memory::zeros(count);
        operator.apply(&probe, 1, &mut right);
        let mut solution = right.clone();
        self.solve_in_place(&mut solution, 1);
        let mut rest = probe;
        let left = operator.difference_vectors(&right, &solution, 1, &mut rest);
        let size = solution.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
        left.is_finite() && left.max <= MOST_ERROR * size
    }

    /// Solves `M x = r` in place for vectors of shape (points, dimension).
    pub(super) fn solve_in_place(&self, vectors: &mut [f64], dimension: usize) {
        let (band, apart) = vectors.split_at_mut(self.count * dimension);
        self.substitute_band(band, dimension);
        if let Some(border) = &self.border {
            border.solve(band, apart, dimension);
        }
    }

    fn substitute_band(&self, vectors: &mut [f64], dimension: usize) {
        band_kernel::substitute(self.reach, &self.lower, &self.upper, vectors, dimension);
    }
}

impl Border {
    /// Collects the entries outside the band: those of the last `size` rows and columns.
    fn new(operator: &BandedCollocation, size: usize) -> Self {
        let points = operator.points();
        let count = points - size;
        let mut border = Self {
            size,
            reach: memory::zeros(count * size),
            rows: Vec::new(),
            inverse: vec![0.0; size * size],
        };
        // No row reaches farther than `size` round the seam, nor farther than its width.
        let near = operator.rows().width.max(size);
        for j in (0..points).filter(|&j| j < near || j + 2 * near >= points) {
            for (column, weight) in operator.row(j) {
                if j < count && column >= count {
                    border.reach[j * size + column - count] += weight;
                } else if j >= count && column < count {
                    border.rows.push((j - count, column, weight));
                } else if j >= count {
                    border.inverse[(j - count) * size + column - count] += weight;
                }
            }
        }
        border
    }

    /// Forms and inverts the Schur complement, once `reach` holds `B^-1 E`.
    fn complete(&mut self) -> bool {
        for &(row, column, weight) in &self.rows {
            for k in 0..self.size {
                self.inverse[row * self.size + k] -= weight * self.reach[column * self.size + k];
            }
        }
        match invert(&self.inverse, self.size) {
            Some(inverse) => {
                self.inverse = inverse;
                true
            }
            None => false,
        }
    }

    /// Finishes a solve whose band part has been substituted.
    fn solve(&self, band: &mut [f64], apart: &mut [f64], dimension: usize) {
        let size = self.size;
        for &(row, column, weight) in &self.rows {
            for i in 0..dimension {
                apart[row * dimension + i] -= weight * band[column * dimension + i];
            }
        }
        let mut solution = [0.0; crate::knots::MAX_DEGREE + 1];
        for i in 0..dimension {
            for row in 0..size {
                solution[row] = (0..size)
                    .map(|k| self.inverse[row * size + k] * apart[k * dimension + i])
                    .sum();
            }
            for row in 0..size {
                apart[row * dimension + i] = solution[row];
            }
        }
        for (point, reach) in band.chunks_exact_mut(dimension).zip(self.reach.chunks_exact(size)) {
            for (k, &factor) in reach.iter().enumerate() {
                if factor != 0.0 {
                    for i in 0..dimension {
                        point[i] -= factor * apart[k * dimension + i];
                    }
                }
            }
        }
    }
}

/// Rows of weights sum to 1, so a pivot this small is what rounding leaves of a cancelled one.
const SMALLEST_PIVOT: f64 = 16.0 * f64::EPSILON;

/// Inverse of a small dense matrix by Gauss-Jordan elimination with row pivoting.
fn invert(matrix: &[f64], size: usize) -> Option<Vec<f64>> {
    let wide = 2 * size;
    let mut work = vec![0.0; size * wide];
    for row in 0..size {
        work[row * wide..][..size].copy_from_slice(&matrix[row * size..][..size]);
        work[row * wide + size + row] = 1.0;
    }
    for column in 0..size {
        let pivot_row = (column..size).max_by(|&a, &b| {
            work[a * wide + column].abs().total_cmp(&work[b * wide + column].abs())
        })?;
        let pivot = work[pivot_row * wide + column];
        if !(pivot.abs() > SMALLEST_PIVOT && pivot.is_finite()) {
            return None;
        }
        (0..wide).for_each(|k| work.swap(column * wide + k, pivot_row * wide + k));
        (0..wide).for_each(|k| work[column * wide + k] /= pivot);
        for row in (0..size).filter(|&row| row != column) {
            let factor = work[row * wide + column];
            for k in 0..wide {
                work[row * wide + k] -= factor * work[column * wide + k];
            }
        }
    }
    Some((0..size).flat_map(|row| work[row * wide + size..][..size].to_vec()).collect())
}
