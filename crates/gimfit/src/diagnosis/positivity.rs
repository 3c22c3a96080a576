//! Whether every minor is nonnegative.

use crate::collocation::{CollocationMatrix, DenseCollocation};

/// What is known of total positivity, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TotalPositivity {
    /// The basis and its knots imply it.
    Known,
    /// Elimination found no negative minor among those that decide.
    Verified,
    /// There is a negative minor.
    Refuted,
    /// Neither known nor tested: too many points.
    Unknown,
}

impl TotalPositivity {
    /// Whether it holds.
    #[must_use]
    pub fn holds(self) -> bool {
        matches!(self, Self::Known | Self::Verified)
    }
}

/// Points up to which minors are tested.
const MOST_TESTED: usize = 256;

/// Asks the matrix, then its minors: a nonsingular matrix is totally positive exactly if
/// elimination among neighbouring rows (Neville), and then columns, meets no negative multiplier
/// and no exchange (Gasca and Pena 1992).
pub(super) fn total_positivity(matrix: &dyn CollocationMatrix) -> TotalPositivity {
    if matrix.is_totally_positive() {
        return TotalPositivity::Known;
    }
    let count = matrix.points();
    let Some(window) = Some(count)
        .filter(|&n| n <= MOST_TESTED)
        .and_then(|n| DenseCollocation::window(matrix, 0, n).ok())
    else {
        // Rows of a closed curve that pass its seam: their corners make a negative minor.
        return if wraps(matrix) { TotalPositivity::Refuted } else { TotalPositivity::Unknown };
    };
    let transposed: Vec<f64> =
        (0..count * count).map(|k| window.entries()[(k % count) * count + k / count]).collect();
    if neville(window.entries().to_vec(), count) && neville(transposed, count) {
        TotalPositivity::Verified
    } else {
        TotalPositivity::Refuted
    }
}

/// Whether the first row reaches the last column past a gap: with the diagonal entry of a row in
/// that gap this makes a negative minor of order 2.
fn wraps(matrix: &dyn CollocationMatrix) -> bool {
    let count = matrix.points();
    let (mut last, mut middle) = (false, false);
    matrix.visit_row(0, &mut |column, weight| {
        last |= column + 1 == count && weight > 0.0;
        middle |= column == count / 2 && weight != 0.0;
    });
    last && !middle && matrix.diagonal(count / 2) > 0.0
}

/// Elimination that subtracts from each row a multiple of the one above.
fn neville(mut a: Vec<f64>, n: usize) -> bool {
    /// What rounding may leave of a zero, in units of the entries that cancelled.
    const ROUNDING: f64 = 1e-12;
    let size = a.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let zero = ROUNDING * size;
    if a.iter().any(|&x| x < -zero) {
        return false;
    }
    for k in 0..n {
        for i in (k + 1..n).rev() {
            let (above, below) = (a[(i - 1) * n + k], a[i * n + k]);
            if below.abs() <= zero {
                a[i * n + k] = 0.0;
                continue;
            }
            // An entry below a zero needs an exchange, which makes a negative minor.
            if below < 0.0 || above <= zero {
                return false;
            }
            let multiplier = below / above;
            for j in k..n {
                a[i * n + j] -= multiplier * a[(i - 1) * n + j];
            }
        }
        if a[k * n + k] < -zero {
            return false;
        }
    }
    true
}
