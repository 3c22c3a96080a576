//! PIA: every control point moves by the difference vector of its data point.
//!
//! `P <- P + (Q - A P)` (Lin, Wang and Dong 2004, eq. 5; Lin, Bao and Wang 2005). Converges for
//! every nonsingular collocation matrix of a normalised totally positive basis, at the rate
//! `1 - lambda_min`.

use super::{Step, UpdateRule};

/// Progressive-iterative approximation.
#[derive(Debug, Clone, Copy, Default)]
pub struct Pia;

impl UpdateRule for Pia {
    fn adjust(&mut self, _: Step<'_>, _: &mut [f64]) {}
}
