//! The largest eigenvalue that Jacobi's rule meets.

use crate::collocation::CollocationMatrix;

/// Steps of the power method on a matrix that has no negative entry.
const POWER_STEPS: usize = 60;

/// Estimate of the largest eigenvalue of `D^-1 A`, where D is the diagonal, for a matrix without
/// negative entries: Jacobi's rule converges where it stays below 2.
#[must_use]
pub fn largest_jacobi_eigenvalue(operator: &dyn CollocationMatrix) -> f64 {
    let count = operator.points();
    let diagonal: Vec<f64> = (0..count).map(|j| operator.diagonal(j)).collect();
    let mut vector = vec![1.0; count];
    let mut next = vec![0.0; count];
    let mut ratio = 1.0;
    for _ in 0..POWER_STEPS {
        operator.apply(&vector, 1, &mut next);
        next.iter_mut().zip(&diagonal).for_each(|(x, d)| *x /= d);
        ratio = next.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if !(ratio.is_finite() && ratio > 0.0) {
            return ratio;
        }
        vector.iter_mut().zip(&next).for_each(|(x, y)| *x = y / ratio);
    }
    ratio
}
