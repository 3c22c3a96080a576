//! What a fit asks of a basis that is no B-spline.

use crate::Error;
use std::sync::Arc;

/// Largest degree of the named bases: beyond it their functions underflow in doubles.
pub const MAX_BLENDING_DEGREE: usize = 500;

/// A basis of blending functions: nonnegative, and their sum is one everywhere on the domain, which
/// fits check at the parameters of the data. With it a curve is `C(t) = sum_i f_i(t) P_i`.
///
/// # Examples
/// ```
/// use gimfit::basis::{BlendingBasis, WangBall};
/// let basis = WangBall::new(4)?;
/// let mut values = [0.0; 5];
/// basis.evaluate_into(0.5, &mut values);
/// assert_eq!(values, [0.25, 0.125, 0.25, 0.125, 0.25]);
/// assert!(!basis.is_totally_positive());
/// # Ok::<(), gimfit::Error>(())
/// ```
pub trait BlendingBasis: std::fmt::Debug + Send + Sync {
    /// The name in reports and documents, such as `wang-ball`.
    fn name(&self) -> &str;

    /// Number of functions, which is the number of control points.
    fn functions(&self) -> usize;

    /// Where the functions blend, ends included.
    fn domain(&self) -> (f64, f64) {
        (0.0, 1.0)
    }

    /// Writes the values of all functions at `t` into `values` (length: number of functions).
    fn evaluate_into(&self, t: f64, values: &mut [f64]);

    /// Whether the basis is known to be normalised totally positive: no collocation matrix at
    /// increasing parameters has a negative minor. Then PIA converges (Lin, Bao and Wang 2005).
    fn is_totally_positive(&self) -> bool {
        false
    }

    /// Coefficients of the functions in the Bernstein basis of degree `functions() - 1` over the
    /// domain, shape (functions, functions), where they are such polynomials: then a curve is a
    /// Bezier curve too. Of a rational basis, those of the basis that its weights blend.
    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        None
    }

    /// Weights of a rational basis `w_i f_i / sum_l w_l f_l`.
    fn rational_weights(&self) -> Option<&[f64]> {
        None
    }

    /// Smallest eigenvalue of the collocation matrix at equal steps from end to end of the domain,
    /// where a law gives it.
    fn uniform_smallest_eigenvalue(&self) -> Option<f64> {
        None
    }
}

macro_rules! forward {
    ($($target:ty),*) => {$(
        impl<B: BlendingBasis + ?Sized> BlendingBasis for $target {
            fn name(&self) -> &str {
                (**self).name()
            }

            fn functions(&self) -> usize {
                (**self).functions()
            }

            fn domain(&self) -> (f64, f64) {
                (**self).domain()
            }

            fn evaluate_into(&self, t: f64, values: &mut [f64]) {
                (**self).evaluate_into(t, values);
            }

            fn is_totally_positive(&self) -> bool {
                (**self).is_totally_positive()
            }

            fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
                (**self).bernstein_coefficients()
            }

            fn rational_weights(&self) -> Option<&[f64]> {
                (**self).rational_weights()
            }

            fn uniform_smallest_eigenvalue(&self) -> Option<f64> {
                (**self).uniform_smallest_eigenvalue()
            }
        }
    )*};
}
forward!(Arc<B>, Box<B>, &B);

/// Refuses degrees that the named bases do not have.
pub(super) fn check_blending_degree(degree: usize) -> Result<(), Error> {
    if (1..=MAX_BLENDING_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: "degree of the basis".into(),
        value: degree as f64,
        rule: "it must lie between 1 and 500",
    })
}
