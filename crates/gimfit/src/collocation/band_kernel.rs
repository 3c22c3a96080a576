//! Inner loops of band factors: elimination without pivoting, and substitution. Slices in, slices
//! out; callers check first.
//!
//! A band reaches equally far to both sides of the diagonal. How far is known at compile time
//! (`B`), so that the rows at work stay in registers; the next size above serves the sizes between.

use super::kernel::{LANES, Rows};
use crate::knots::MAX_DEGREE;

/// Calls a function for the least compiled reach that is enough, and for the dimension.
macro_rules! dispatch {
    ($function:ident, $reach:expr, $dimension:literal, $arguments:tt) => {
        match $reach {
            0 => $function::<0, 1, $dimension> $arguments,
            1 => $function::<1, 3, $dimension> $arguments,
            2 => $function::<2, 5, $dimension> $arguments,
            3 => $function::<3, 7, $dimension> $arguments,
            4 => $function::<4, 9, $dimension> $arguments,
            5 => $function::<5, 11, $dimension> $arguments,
            6 => $function::<6, 13, $dimension> $arguments,
            7..=9 => $function::<9, 19, $dimension> $arguments,
            _ => $function::<MAX_DEGREE, { 2 * MAX_DEGREE + 1 }, $dimension> $arguments,
        }
    };
}

/// The reach that factors of a band are stored with.
pub(super) fn stored_reach(reach: usize) -> usize {
    match reach {
        0..=6 => reach,
        7..=9 => 9,
        _ => MAX_DEGREE,
    }
}

/// Factors the first `count` rows and columns; entries in other columns are passed over.
///
/// `lower` and `upper`, empty at first, receive for each row the multipliers of the `reach` rows
/// before it, and the reciprocal pivot followed by the `reach` entries after it over the pivot.
/// False if a pivot vanishes.
pub(super) fn factor(
    rows: Rows<'_>,
    count: usize,
    reach: usize,
    lower: &mut Vec<f64>,
    upper: &mut Vec<f64>,
) -> bool {
    dispatch!(factor_of, reach, 0, (rows, count, lower, upper))
}

/// `N` is the length of a row, `2 B + 1`.
fn factor_of<const B: usize, const N: usize, const D: usize>(
    rows: Rows<'_>,
    count: usize,
    lower: &mut Vec<f64>,
    upper: &mut Vec<f64>,
) -> bool {
    let mut sound = true;
    // Entries right of the diagonal over the pivot, and reciprocal pivot, of the rows before.
    let mut before = [[0.0; B]; B];
    let mut pivots = [0.0; B];
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(rows.width));
    for (j, (&first, weights)) in lines.take(count).enumerate() {
        // The row's first column is j - B. What falls outside the band or the columns is zero, or
        // belongs to the border.
        let start = (j as isize - B as isize) - first as isize;
        let mut row: [f64; N] = std::array::from_fn(|place| {
            let column = (j + place).wrapping_sub(B);
            let k = (start + place as isize) as usize;
            if column < count { weights.get(k).copied().unwrap_or(0.0) } else { 0.0 }
        });
        for k in 0..B {
            let entry = row[k];
            row[k] = entry * pivots[k];
            for offset in 0..B {
                row[k + 1 + offset] -= entry * before[k][offset];
            }
        }
        let pivot = row[B].recip();
        sound &= pivot.is_finite();
        let mut after = [0.0; B];
        for offset in 0..B {
            after[offset] = row[B + 1 + offset] * pivot;
        }
        lower.extend_from_slice(&row[..B]);
        upper.push(pivot);
        upper.extend_from_slice(&after);
        for k in 1..B {
            before[k - 1] = before[k];
            pivots[k - 1] = pivots[k];
        }
        if B > 0 {
            before[B - 1] = after;
            pivots[B - 1] = pivot;
        }
    }
    sound
}

/// Solves `L U x = r` in place for the arrays that [`factor`] filled.
pub(super) fn substitute(
    reach: usize,
    lower: &[f64],
    upper: &[f64],
    vectors: &mut [f64],
    dimension: usize,
) {
    match dimension {
        1 => dispatch!(substitute_of, reach, 1, (lower, upper, vectors, dimension)),
        2 => dispatch!(substitute_of, reach, 2, (lower, upper, vectors, dimension)),
        3 => dispatch!(substitute_of, reach, 3, (lower, upper, vectors, dimension)),
        _ if dimension >= LANES => {
            dispatch!(substitute_wide, reach, 0, (lower, upper, vectors, dimension));
        }
        _ => dispatch!(substitute_of, reach, 0, (lower, upper, vectors, dimension)),
    }
}

/// `D` is the dimension when known at compile time, 0 when not.
fn substitute_of<const B: usize, const N: usize, const D: usize>(
    lower: &[f64],
    upper: &[f64],
    vectors: &mut [f64],
    dimension: usize,
) {
    let dimension = if D == 0 { dimension } else { D };
    let count = vectors.len() / dimension;
    for j in 1..if B > 0 { count } else { 0 } {
        let multipliers = &lower[j * B..][..B];
        let reach = B.min(j);
        let window = &mut vectors[(j - reach) * dimension..(j + 1) * dimension];
        let (near, here) = window.split_at_mut(reach * dimension);
        for k in 0..reach {
            for i in 0..dimension {
                here[i] -= multipliers[B - reach + k] * near[k * dimension + i];
            }
        }
    }
    for j in (0..count).rev() {
        let row = &upper[j * (B + 1)..][..B + 1];
        let reach = B.min(count - 1 - j);
        let window = &mut vectors[j * dimension..(j + 1 + reach) * dimension];
        let (here, near) = window.split_at_mut(dimension);
        here.iter_mut().for_each(|x| *x *= row[0]);
        // The nearest neighbour last: it is the one that has only just been found.
        for k in (0..reach).rev() {
            for i in 0..dimension {
                here[i] -= row[k + 1] * near[k * dimension + i];
            }
        }
    }
}

/// As [`substitute_of`] for wide points, whose coordinates stay in registers [`LANES`] at a time.
fn substitute_wide<const B: usize, const N: usize, const D: usize>(
    lower: &[f64],
    upper: &[f64],
    vectors: &mut [f64],
    dimension: usize,
) {
    let count = vectors.len() / dimension;
    for j in 1..if B > 0 { count } else { 0 } {
        let multipliers = &lower[j * B..][..B];
        let reach = B.min(j);
        let window = &mut vectors[(j - reach) * dimension..(j + 1) * dimension];
        let (near, here) = window.split_at_mut(reach * dimension);
        if reach == B {
            subtract::<B, false>(std::array::from_fn(|k| multipliers[k]), 1.0, near, here);
        } else {
            for k in 0..reach {
                for i in 0..dimension {
                    here[i] -= multipliers[B - reach + k] * near[k * dimension + i];
                }
            }
        }
    }
    for j in (0..count).rev() {
        let row = &upper[j * (B + 1)..][..B + 1];
        let reach = B.min(count - 1 - j);
        let window = &mut vectors[j * dimension..(j + 1 + reach) * dimension];
        let (here, near) = window.split_at_mut(dimension);
        if reach == B {
            subtract::<B, true>(std::array::from_fn(|k| row[k + 1]), row[0], near, here);
        } else {
            here.iter_mut().for_each(|x| *x *= row[0]);
            for k in (0..reach).rev() {
                for i in 0..dimension {
                    here[i] -= row[k + 1] * near[k * dimension + i];
                }
            }
        }
    }
}

/// `here = scale * here - sum_k factors[k] near[k]`, the nearest neighbour last: the first in `near`
/// where the sweep runs backward.
#[inline(always)]
fn subtract<const B: usize, const BACKWARD: bool>(
    factors: [f64; B],
    scale: f64,
    near: &[f64],
    here: &mut [f64],
) {
    let dimension = here.len();
    let near: [&[f64]; B] = std::array::from_fn(|k| &near[k * dimension..][..dimension]);
    for i in 0..dimension {
        let mut x = if BACKWARD { here[i] * scale } else { here[i] };
        for step in 0..B {
            let k = if BACKWARD { B - 1 - step } else { step };
            x -= factors[k] * near[k][i];
        }
        here[i] = x;
    }
}
