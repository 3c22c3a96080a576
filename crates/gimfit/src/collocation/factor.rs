//! Band factors of a collocation matrix: the preconditioner of preconditioned PIA, and the way to
//! its smallest eigenvalue.
//!
//! Elimination runs without pivoting, which is stable for totally positive matrices (de Boor and
//! Pinkus 1977) and keeps the band. A closed curve's matrix wraps round; its last few unknowns are
//! set apart and met through their Schur complement.

use super::kernel::{self, Rows};
use super::{BandedCollocation, CollocationOperator};
use crate::{Error, memory};

/// Factors `M = L U` of a band, bordered for a closed curve. Memory: `8 (below + above + 1)` bytes
/// a row; border columns on top where the matrix wraps.
#[derive(Debug, Clone)]
pub struct BandFactors {
    count: usize,
    below: usize,
    above: usize,
    /// Multipliers of the `below` rows before each row.
    lower: Vec<f64>,
    /// Reciprocal pivot of each row, then the `above` entries after it.
    upper: Vec<f64>,
    border: Option<Border>,
}

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

impl BandFactors {
    /// Factors the whole band.
    ///
    /// # Errors
    /// [`Error::Singular`] if a pivot vanishes.
    pub fn new(operator: &BandedCollocation) -> Result<Self, Error> {
        Self::compensated(operator, usize::MAX)
    }

    /// Factors the entries within `half_bandwidth` of the diagonal, with those beyond added to the
    /// diagonal of their row (diagonally compensated reduction; Liu and Liu 2020).
    ///
    /// # Errors
    /// [`Error::Singular`] if a pivot vanishes.
    pub fn compensated(operator: &BandedCollocation, half_bandwidth: usize) -> Result<Self, Error> {
        let points = operator.points();
        let limit = i64::try_from(half_bandwidth).unwrap_or(i64::MAX);
        let Reach { below, above, wrapped: size } = Reach::of(operator, limit);
        let count = points - size;
        let mut factors = Self {
            count,
            below,
            above,
            lower: memory::zeros(count * below),
            upper: memory::zeros(count * (above + 1)),
            border: None,
        };
        let mut border = (size > 0).then(|| Border::new(size, count));
        let mut band = vec![0.0; below + above + 1];
        let eliminate = kernel::elimination(below, above);
        let Rows { width, first, weights, .. } = operator.rows();
        for (j, (&first, weights)) in first.iter().zip(weights.chunks_exact(width)).enumerate() {
            band.fill(0.0);
            let plain = limit == i64::MAX && first >= 0 && first as usize + width <= count;
            if plain && j < count {
                // All weights that are not zero lie within the band.
                let start = (first as usize + below).wrapping_sub(j);
                for (k, &weight) in weights.iter().enumerate() {
                    if let Some(entry) = band.get_mut(start.wrapping_add(k)) {
                        *entry = weight;
                    }
                }
            } else {
                for (k, &weight) in weights.iter().enumerate().filter(|(_, w)| **w != 0.0) {
                    let column = i64::from(first) + k as i64;
                    let beyond = (column - j as i64).abs() > limit;
                    let column = if beyond { j } else { operator.rows().column(first, k) };
                    match &mut border {
                        Some(border) if j >= count || column >= count => {
                            border.set(j, column, count, weight);
                        }
                        _ => band[column + below - j] += weight,
                    }
                }
            }
            let lower = &mut factors.lower;
            if j < count && !eliminate(j, below, above, &mut band, lower, &mut factors.upper) {
                return Err(singular(points));
            }
        }
        if let Some(mut border) = border {
            factors.substitute_band(&mut border.reach, size);
            if !border.complete() {
                return Err(singular(points));
            }
            factors.border = Some(border);
        }
        Ok(factors)
    }

    /// Number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.count + self.border.as_ref().map_or(0, |border| border.size)
    }

    /// Solves `M x = r` in place for vectors of shape (points, dimension).
    pub fn solve_in_place(&self, vectors: &mut [f64], dimension: usize) {
        let (band, apart) = vectors.split_at_mut(self.count * dimension);
        self.substitute_band(band, dimension);
        if let Some(border) = &self.border {
            border.solve(band, apart, dimension);
        }
    }

    fn substitute_band(&self, vectors: &mut [f64], dimension: usize) {
        kernel::substitute(self.below, &self.lower, self.above, &self.upper, vectors, dimension);
    }
}

/// How far rows reach from the diagonal to both sides, and how far those that wrap round do.
struct Reach {
    below: usize,
    above: usize,
    wrapped: usize,
}

impl Reach {
    /// Of the entries within `limit` of the diagonal.
    fn of(operator: &BandedCollocation, limit: i64) -> Self {
        let rows = operator.rows();
        let columns = rows.columns as i64;
        let (mut below, mut above, mut wrapped) = (0, 0, 0);
        for (j, (&first, weights)) in
            rows.first.iter().zip(rows.weights.chunks_exact(rows.width)).enumerate()
        {
            for (k, &weight) in weights.iter().enumerate() {
                let column = i64::from(first) + k as i64;
                let offset = column - j as i64;
                if weight != 0.0 && offset.abs() <= limit {
                    below = below.max(-offset);
                    above = above.max(offset);
                    if column < 0 || column >= columns {
                        wrapped = wrapped.max(offset.abs());
                    }
                }
            }
        }
        Self { below: below as usize, above: above as usize, wrapped: wrapped as usize }
    }
}

impl Border {
    fn new(size: usize, count: usize) -> Self {
        Self {
            size,
            reach: vec![0.0; count * size],
            rows: Vec::new(),
            inverse: vec![0.0; size * size],
        }
    }

    fn set(&mut self, j: usize, column: usize, count: usize, weight: f64) {
        if j < count {
            self.reach[j * self.size + column - count] += weight;
        } else if column < count {
            self.rows.push((j - count, column, weight));
        } else {
            self.inverse[(j - count) * self.size + column - count] += weight;
        }
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

fn singular(points: usize) -> Error {
    Error::Singular {
        points,
        why: "closed curves of even degree over an even number of points are singular when a knot \
              meets every point; choose averaged knots or an odd degree",
    }
}
