//! Diagonal dominance, strict and generalised (Chen, Wang and Jin 2012, definitions 1 to 3).
//!
//! A matrix with a positive diagonal is generalised strictly diagonally dominant exactly if its
//! comparison matrix `M` (absolute values, negative off the diagonal) is a nonsingular M-matrix,
//! and that exactly if some `x > 0` has `M x > 0`; then `A diag(x)` is strictly dominant. The
//! solution of `M x = 1` is such an `x` if there is one, so one factorisation and one solution
//! decide, and the certificate is checked by products alone.

use crate::collocation::CollocationMatrix;

/// Whether the diagonal dominates. Then all eigenvalues have positive real parts, and plain PIA
/// converges if rows are nonnegative and sum to 1.
#[derive(Debug, Clone, PartialEq)]
pub enum Dominance {
    /// Every diagonal entry exceeds the sum of the others in its row.
    Strict,
    /// It does after columns are scaled by positive numbers.
    Generalised {
        /// Those numbers, one per column, the largest 1.
        scaling: Vec<f64>,
    },
    /// No positive numbers make it so.
    None,
}

impl Dominance {
    /// Whether the matrix has the property GDD of the paper; strict dominance is a special case.
    #[must_use]
    pub fn is_generalised(&self) -> bool {
        *self != Self::None
    }
}

/// Tests a matrix: linear cost for a band.
#[must_use]
pub fn dominance(matrix: &dyn CollocationMatrix) -> Dominance {
    let ones = vec![1.0; matrix.points()];
    if dominates(matrix, &ones) {
        return Dominance::Strict;
    }
    let Ok(factors) = matrix.factor_comparison() else { return Dominance::None };
    let mut scaling = ones;
    factors.solve_in_place(&mut scaling, 1);
    let largest = scaling.iter().fold(0.0, |most: f64, x| most.max(*x));
    scaling.iter_mut().for_each(|x| *x /= largest);
    if dominates(matrix, &scaling) { Dominance::Generalised { scaling } } else { Dominance::None }
}

/// Whether `A diag(x)` is strictly diagonally dominant with a positive diagonal, beyond rounding.
#[must_use]
pub fn dominates(matrix: &dyn CollocationMatrix, x: &[f64]) -> bool {
    x.len() == matrix.points()
        && x.iter().all(|x| *x > 0.0 && x.is_finite())
        && (0..matrix.points()).all(|j| {
            let (mut diagonal, mut others, mut entries) = (0.0, 0.0, 0.0);
            matrix.visit_row(j, &mut |column, weight| {
                entries += 1.0;
                if column == j {
                    diagonal += weight * x[column];
                } else {
                    others += weight.abs() * x[column];
                }
            });
            diagonal - others > entries * f64::EPSILON * (diagonal + others)
        })
}
