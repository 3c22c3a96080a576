//! Chebyshev semi-iterative PIA (Liu, Han and Li 2017), by the three-term recurrence: products of
//! Chebyshev roots taken one by one blow up in doubles, the recurrence does not.

use super::{Step, UpdateRule};
use crate::memory;

/// PIA with the residual polynomial that is smallest on an interval of eigenvalues.
#[derive(Debug, Clone)]
pub struct Chebyshev {
    centre: f64,
    radius: f64,
    rho: f64,
    /// The adjusting vectors of the step before.
    previous: Vec<f64>,
}

impl Chebyshev {
    /// For eigenvalues in `[smallest, largest]`; a `largest` too small diverges, a `smallest` too
    /// large is slow. `length` is the number of coordinates, points times dimension.
    #[must_use]
    pub fn new(smallest: f64, largest: f64, length: usize) -> Self {
        Self {
            centre: 0.5 * (largest + smallest),
            radius: 0.5 * (largest - smallest),
            rho: 0.0,
            previous: memory::zeros(length),
        }
    }
}

impl UpdateRule for Chebyshev {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let sigma = self.centre / self.radius;
        if step.iteration == 0 || self.radius <= 0.0 {
            self.rho = sigma.recip();
            for (r, d) in vectors.iter_mut().zip(&mut self.previous) {
                *r /= self.centre;
                *d = *r;
            }
            return;
        }
        let rho = (2.0 * sigma - self.rho).recip();
        let (keep, add) = (rho * self.rho, 2.0 * rho / self.radius);
        self.rho = rho;
        for (r, d) in vectors.iter_mut().zip(&mut self.previous) {
            *r = keep * *d + add * *r;
            *d = *r;
        }
    }

    fn reset(&mut self) {
        self.rho = 0.0;
    }
}
