//! Inner loops of band factors: elimination without pivoting, and substitution. Slices in, slices
//! out; callers check first.
//!
//! Constant parameters are sizes known at compile time, 0 (or a row width of 0) when they are not;
//! one body serves both.

use super::kernel::Rows;

/// How far a band reaches from the diagonal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Band {
    /// Entries left of the diagonal.
    pub(super) below: usize,
    /// Entries right of it.
    pub(super) above: usize,
}

/// Factors the first `count` rows and columns; entries in other columns are passed over.
///
/// `lower` and `upper`, empty at first, receive for each row the multipliers of the `below` rows before it, and the
/// reciprocal pivot and the `above` entries after it. False if a pivot vanishes.
pub(super) fn factor(
    rows: Rows<'_>,
    count: usize,
    band: Band,
    lower: &mut Vec<f64>,
    upper: &mut Vec<f64>,
) -> bool {
    match (rows.width, band.below, band.above) {
        (4, 1, 1) => factor_of::<4, 1, 1, 3>(rows, count, band, lower, upper),
        (4, 2, 2) => factor_of::<4, 2, 2, 5>(rows, count, band, lower, upper),
        (4, 3, 3) => factor_of::<4, 3, 3, 7>(rows, count, band, lower, upper),
        _ => factor_of::<0, 0, 0, LONGEST>(rows, count, band, lower, upper),
    }
}

/// Longest band of a row: `MAX_DEGREE` to both sides of the diagonal.
const LONGEST: usize = 2 * crate::knots::MAX_DEGREE + 1;

#[inline(always)]
fn factor_of<const W: usize, const B: usize, const A: usize, const N: usize>(
    rows: Rows<'_>,
    count: usize,
    band: Band,
    lower: &mut Vec<f64>,
    upper: &mut Vec<f64>,
) -> bool {
    let Band { below, above } = if W == 0 { band } else { Band { below: B, above: A } };
    let width = if W == 0 { rows.width } else { W };
    let (length, wide) = (below + above + 1, above + 1);
    let mut sound = true;
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(width));
    for (j, (&first, weights)) in lines.take(count).enumerate() {
        let mut entries = [0.0; N];
        let entries = &mut entries[..length];
        // Column of the first entry is j - below. What falls outside the band or the columns is
        // zero, or belongs to the border.
        let start = first as isize + below as isize - j as isize;
        for k in 0..width {
            let column = first as isize + k as isize;
            let place = start + k as isize;
            if (0..count as isize).contains(&column) && (0..length as isize).contains(&place) {
                entries[place as usize] = weights[k];
            }
        }
        for k in below.saturating_sub(j)..below {
            let pivot_row = &upper[(j + k - below) * wide..][..wide];
            let multiplier = entries[k] * pivot_row[0];
            entries[k] = multiplier;
            for offset in 1..wide {
                entries[k + offset] -= multiplier * pivot_row[offset];
            }
        }
        entries[below] = entries[below].recip();
        sound &= entries[below].is_finite();
        lower.extend_from_slice(&entries[..below]);
        upper.extend_from_slice(&entries[below..]);
    }
    sound
}

/// Solves `L U x = r` in place for the arrays that [`factor`] filled.
pub(super) fn substitute(
    band: Band,
    lower: &[f64],
    upper: &[f64],
    vectors: &mut [f64],
    dimension: usize,
) {
    match (band.below, band.above, dimension) {
        (1, 1, 2) => substitute_of::<1, 1, 2>(band, lower, upper, vectors, dimension),
        (2, 2, 2) => substitute_of::<2, 2, 2>(band, lower, upper, vectors, dimension),
        (1, 1, 3) => substitute_of::<1, 1, 3>(band, lower, upper, vectors, dimension),
        (2, 2, 3) => substitute_of::<2, 2, 3>(band, lower, upper, vectors, dimension),
        (_, _, 1) => substitute_of::<0, 0, 1>(band, lower, upper, vectors, dimension),
        (_, _, 2) => substitute_of::<0, 0, 2>(band, lower, upper, vectors, dimension),
        (_, _, 3) => substitute_of::<0, 0, 3>(band, lower, upper, vectors, dimension),
        _ => substitute_of::<0, 0, 0>(band, lower, upper, vectors, dimension),
    }
}

#[inline(always)]
fn substitute_of<const B: usize, const A: usize, const D: usize>(
    band: Band,
    lower: &[f64],
    upper: &[f64],
    vectors: &mut [f64],
    dimension: usize,
) {
    let Band { below, above } = if B == 0 { band } else { Band { below: B, above: A } };
    let dimension = if D == 0 { dimension } else { D };
    let count = vectors.len() / dimension;
    for j in 1..if below > 0 { count } else { 0 } {
        let multipliers = &lower[j * below..][..below];
        let reach = below.min(j);
        let window = &mut vectors[(j - reach) * dimension..(j + 1) * dimension];
        let (near, here) = window.split_at_mut(reach * dimension);
        for k in 0..reach {
            for i in 0..dimension {
                here[i] -= multipliers[below - reach + k] * near[k * dimension + i];
            }
        }
    }
    for j in (0..count).rev() {
        let pivot_row = &upper[j * (above + 1)..][..above + 1];
        let reach = above.min(count - 1 - j);
        let window = &mut vectors[j * dimension..(j + 1 + reach) * dimension];
        let (here, near) = window.split_at_mut(dimension);
        for k in 0..reach {
            for i in 0..dimension {
                here[i] -= pivot_row[k + 1] * near[k * dimension + i];
            }
        }
        for x in here {
            *x *= pivot_row[0];
        }
    }
}
