//! Smallest and largest eigenvalues of a symmetric band, by counting.
//!
//! The pivots of `A - sigma I` have as many negative signs as A has eigenvalues below sigma
//! (Sylvester's law of inertia; Golub and Van Loan, section 8.4), so bisection encloses any of them,
//! however close they lie. A band that wraps round is folded first: numbering the unknowns
//! 0, n - 1, 1, n - 2, ... lays it beside the diagonal.

use super::{BandedCollocation, CollocationOperator};
use crate::knots::MAX_DEGREE;

/// Lower half of a symmetric band.
#[derive(Debug, Clone)]
pub(super) struct SymmetricBand {
    reach: usize,
    /// Row i holds columns i - reach ..= i.
    rows: Vec<f64>,
    /// Rows that count.
    count: usize,
}

/// Below this share of the largest eigenvalue, one is 0 but for rounding.
const ZERO: f64 = 64.0 * f64::EPSILON;
/// Relative width at which bisection ends.
const ENOUGH: f64 = 1e-12;
/// A pivot that vanishes is taken for one this small.
const SMALLEST_PIVOT: f64 = 1e-150;
/// Numbers of a row, folded, of the highest degree.
const MOST_WIDTH: usize = 2 * MAX_DEGREE + 1;

impl SymmetricBand {
    /// Takes a symmetric matrix without the unknowns left out, scaled from both sides by the inverse
    /// roots of `sums`.
    pub(super) fn new(matrix: &BandedCollocation, left_out: &[bool], sums: Option<&[f64]>) -> Self {
        let total = matrix.points();
        let mut kept = 0;
        let number: Vec<usize> = left_out
            .iter()
            .map(|&out| {
                kept += usize::from(!out);
                kept.wrapping_sub(1)
            })
            .collect();
        let wraps = |j: usize| {
            matrix.signed_row(j).any(|(column, _)| column < 0 || column as usize >= total)
        };
        let folds = (0..total).any(|j| !left_out[j] && wraps(j));
        let place = |j: usize| {
            let j = number[j];
            match (folds, 2 * j < kept) {
                (false, _) => j,
                (true, true) => 2 * j,
                (true, false) => 2 * (kept - 1 - j) + 1,
            }
        };
        let entries = |visit: &mut dyn FnMut(usize, usize, f64)| {
            for j in (0..total).filter(|&j| !left_out[j]) {
                for (column, weight) in matrix.row(j).filter(|&(column, _)| !left_out[column]) {
                    let scale = sums.map_or(1.0, |s| (s[j] * s[column]).sqrt().recip());
                    let (row, column) = (place(j), place(column));
                    if column <= row {
                        visit(row, column, scale * weight);
                    }
                }
            }
        };
        let mut reach = 0;
        entries(&mut |row, column, _| reach = reach.max(row - column));
        let mut rows = vec![0.0; kept * (reach + 1)];
        entries(&mut |row, column, weight| {
            rows[row * (reach + 1) + reach - (row - column)] += weight;
        });
        Self { reach, rows, count: kept }
    }

    /// How many eigenvalues lie below `sigma`; `work` holds the last rows of the factors.
    fn count_below(&self, sigma: f64, work: &mut Vec<f64>) -> usize {
        let (reach, width) = (self.reach, self.reach + 1);
        // Row c of the factors stands in place c modulo width: multipliers, then the pivot.
        work.clear();
        work.resize(width * width, 0.0);
        let mut held = [0.0; MOST_WIDTH];
        let row = &mut held[..width];
        let mut negative = 0;
        for (i, source) in self.rows.chunks_exact(width).enumerate() {
            row.copy_from_slice(source);
            row[reach] -= sigma;
            let low = reach.saturating_sub(i);
            let above = |k: usize| (i + k - reach) % width * width;
            // First the multipliers times their pivots.
            for k in low..reach {
                let other = &work[above(k)..][..width];
                for e in low..k {
                    row[k] -= row[e] * other[e + reach - k];
                }
            }
            for k in low..reach {
                let multiplier = row[k] / work[above(k) + reach];
                row[reach] -= row[k] * multiplier;
                row[k] = multiplier;
            }
            if row[reach].abs() < SMALLEST_PIVOT {
                row[reach] = -SMALLEST_PIVOT;
            }
            negative += usize::from(row[reach] < 0.0);
            work[i % width * width..][..width].copy_from_slice(row);
        }
        negative
    }

    /// The smallest eigenvalue above 0 and the largest.
    pub(super) fn extremes(&self) -> Option<(f64, f64)> {
        let width = self.reach + 1;
        let mut work = Vec::with_capacity(width * width);
        // Gershgorin's discs, both halves of a row.
        let mut discs = vec![0.0; self.count];
        for (i, row) in self.rows.chunks_exact(width).enumerate() {
            for (k, entry) in row.iter().enumerate().filter(|(_, entry)| **entry != 0.0) {
                let column = i + k - self.reach;
                discs[i] += entry.abs();
                if column != i {
                    discs[column] += entry.abs();
                }
            }
        }
        let bound = discs.iter().copied().fold(0.0, f64::max);
        if !(bound > 0.0 && bound.is_finite()) {
            return None;
        }
        let largest = self.bisect(self.count, 0.0, bound * (1.0 + 1e-14), &mut work);
        let zero = ZERO * largest;
        let below = self.count_below(zero, &mut work);
        (below < self.count)
            .then(|| (self.bisect(below + 1, zero, largest * (1.0 + 1e-11), &mut work), largest))
    }

    /// The eigenvalue number `which` from below, counted from 1, between bounds.
    fn bisect(&self, which: usize, mut low: f64, mut high: f64, work: &mut Vec<f64>) -> f64 {
        while high - low > ENOUGH * high {
            // Over many powers of ten, in the middle of the logarithms.
            let wide = low > 0.0 && high > 4.0 * low;
            let middle = if wide { (low * high).sqrt() } else { 0.5 * (low + high) };
            if middle <= low || middle >= high {
                break;
            }
            if self.count_below(middle, work) >= which {
                high = middle;
            } else {
                low = middle;
            }
        }
        0.5 * (low + high)
    }
}
