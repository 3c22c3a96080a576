//! Band factors with partial pivoting, for matrices that wrap round.
//!
//! Numbering the unknowns of a closed curve 0, n - 1, 1, n - 2, ... lays the band on itself: what
//! wrapped round the seam stands next to the diagonal, at the price of twice the reach. Elimination
//! with row exchanges (Golub and Van Loan, section 4.3.3) is then stable for every matrix.

use super::{BandedCollocation, CollocationOperator};
use crate::memory;

/// Factors of the folded matrix. Memory: `8 (6 reach + 1)` bytes a row.
#[derive(Debug, Clone)]
pub(super) struct FoldedFactors {
    count: usize,
    /// Reach to both sides after folding.
    reach: usize,
    /// Row `r` holds columns `r - reach ..= r + 2 reach`: multipliers left of the diagonal, factors
    /// from it on.
    rows: Vec<f64>,
    /// The row exchanged with row `k` before step `k`.
    exchanged: Vec<u32>,
}

impl FoldedFactors {
    /// Factors an operator; `None` if it is singular in doubles.
    pub(super) fn new(operator: &BandedCollocation, reach: usize) -> Option<Self> {
        let count = operator.points();
        let reach = (2 * reach).min(count - 1);
        let width = 3 * reach + 1;
        let mut factors =
            Self { count, reach, rows: memory::zeros(count * width), exchanged: Vec::new() };
        for j in 0..count {
            let row = folded(j, count);
            for (column, weight) in operator.row(j) {
                *factors.entry(row, folded(column, count)) += weight;
            }
        }
        for k in 0..count {
            let last = (k + reach).min(count - 1);
            let size = |row: usize| factors.rows[row * width + k + reach - row].abs();
            let pivot_row =
                (k..=last).fold(k, |best, row| if size(row) > size(best) { row } else { best });
            let pivot = size(pivot_row);
            // However small: rows of graded data scale down as a whole without being dependent.
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            factors.exchanged.push(pivot_row as u32);
            factors.eliminate(k, pivot_row, last);
        }
        Some(factors)
    }

    fn entry(&mut self, row: usize, column: usize) -> &mut f64 {
        &mut self.rows[row * (3 * self.reach + 1) + column + self.reach - row]
    }

    /// Step `k`: exchanges rows, then clears column `k` below the diagonal.
    fn eliminate(&mut self, k: usize, pivot_row: usize, last: usize) {
        let end = (k + 2 * self.reach).min(self.count - 1);
        if pivot_row != k {
            for column in k..=end {
                let upper = *self.entry(k, column);
                let lower = std::mem::replace(self.entry(pivot_row, column), upper);
                *self.entry(k, column) = lower;
            }
        }
        let pivot = *self.entry(k, k);
        for row in k + 1..=last {
            let multiplier = *self.entry(row, k) / pivot;
            *self.entry(row, k) = multiplier;
            if multiplier != 0.0 {
                for column in k + 1..=end {
                    let part = multiplier * *self.entry(k, column);
                    *self.entry(row, column) -= part;
                }
            }
        }
    }

    /// Solves in place for vectors of shape (points, dimension), in their usual order.
    pub(super) fn solve_in_place(&self, vectors: &mut [f64], dimension: usize) {
        let (count, reach) = (self.count, self.reach);
        let width = 3 * reach + 1;
        let start = |place: usize| unfolded(place, count) * dimension;
        for k in 0..count {
            let pivot_row = self.exchanged[k] as usize;
            for i in 0..dimension {
                vectors.swap(start(k) + i, start(pivot_row) + i);
            }
            for row in k + 1..=(k + reach).min(count - 1) {
                let multiplier = self.rows[row * width + k + reach - row];
                for i in 0..dimension {
                    vectors[start(row) + i] -= multiplier * vectors[start(k) + i];
                }
            }
        }
        for k in (0..count).rev() {
            let row = &self.rows[k * width + reach..][..2 * reach + 1];
            for column in k + 1..=(k + 2 * reach).min(count - 1) {
                for i in 0..dimension {
                    vectors[start(k) + i] -= row[column - k] * vectors[start(column) + i];
                }
            }
            for i in 0..dimension {
                vectors[start(k) + i] /= row[0];
            }
        }
    }
}

/// Place of an index in the order 0, n - 1, 1, n - 2, ...
fn folded(index: usize, count: usize) -> usize {
    if 2 * index < count { 2 * index } else { 2 * (count - 1 - index) + 1 }
}

/// Index at a place of that order.
fn unfolded(place: usize, count: usize) -> usize {
    if place.is_multiple_of(2) { place / 2 } else { count - 1 - place / 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folding_is_a_permutation_that_keeps_neighbours_near() {
        for count in 1..40 {
            for index in 0..count {
                assert_eq!(unfolded(folded(index, count), count), index);
                let next = (index + 1) % count;
                assert!(folded(index, count).abs_diff(folded(next, count)) <= 2);
            }
        }
    }
}
