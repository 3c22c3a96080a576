//! SaLSPIA (Peng and Li): LSPIA with a step that is found on the way, from the last two gradients, and
//! checked by a line search that need not descend in every step. No eigenvalue is asked for.
//!
//! Between the long and the short step of Barzilai and Borwein (1988), `rho / b` and `b / c`, the root of
//! `(1 - m) c x^2 + (2 m - 1) b x - m rho = 0` is taken, where m follows from how `b / rho` compares with
//! the largest column sum; it is halved until the sum of squares falls below the largest of the last
//! ten (Grippo, Lampariello and Lucidi 1986). The sum of squares is known but for a constant from
//! gradients and the normal matrix, without another pass over the data.

use super::{Step, UpdateRule};
use crate::collocation::CollocationOperator;
use crate::memory;

/// Values of the sum of squares that a step is compared with.
const REMEMBERED: usize = 10;
/// Share of the expected decrease that is demanded.
const DECREASE: f64 = 1e-4;
/// Below this, two weights are the same.
const TINY: f64 = 1e-8;
/// Most halvings of a step.
const HALVINGS: usize = 60;

/// LSPIA with steps from its own history.
#[derive(Debug, Clone)]
pub struct SaLspia<'a> {
    normal: &'a dyn CollocationOperator,
    /// The largest column sum.
    largest_sum: f64,
    gradients: Vec<f64>,
    product: Vec<f64>,
    /// The step before, 0 at first, and the square of its gradients.
    step: f64,
    square: f64,
    /// Half the sum of squares, less that of the start, of the last steps, in turns.
    values: [f64; REMEMBERED],
    count: usize,
}

impl<'a> SaLspia<'a> {
    /// For a normal matrix and the largest column sum of A, on points of a dimension.
    #[must_use]
    pub fn new(normal: &'a dyn CollocationOperator, largest_sum: f64, dimension: usize) -> Self {
        let length = normal.control_points() * dimension;
        Self {
            normal,
            largest_sum,
            gradients: memory::zeros(length),
            product: memory::zeros(length),
            step: 0.0,
            square: 0.0,
            values: [0.0; REMEMBERED],
            count: 0,
        }
    }

    /// The step to try, for the square of the gradients and their product with those before.
    fn trial(&self, square: f64, product: f64) -> f64 {
        let first = self.largest_sum.recip();
        if self.step == 0.0 {
            return first;
        }
        let (before, alpha) = (self.square, self.step);
        let b = (before - product) / alpha;
        let c = (before - 2.0 * product + square) / (alpha * alpha);
        if !(b > f64::EPSILON * before && c > 0.0) {
            return first;
        }
        let mu = b / (self.largest_sum * before);
        if 1.0 - mu <= TINY {
            return b / c;
        }
        let m = (1.0 - mu.clamp(0.0, 1.0)).max(TINY);
        let linear = (2.0 * m - 1.0) * b;
        let root = (linear * linear + 4.0 * (1.0 - m) * c * m * before).sqrt();
        // The form without a difference of like numbers.
        let step = if linear >= 0.0 {
            2.0 * m * before / (linear + root)
        } else {
            (root - linear) / (2.0 * (1.0 - m) * c)
        };
        if step.is_finite() && step > 0.0 { step } else { first }
    }
}

impl UpdateRule for SaLspia<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let square = dot(vectors, vectors);
        let along = dot(vectors, &self.gradients);
        let mut trial = self.trial(square, along);
        self.normal.apply(vectors, step.dimension, &mut self.product);
        let curvature = dot(vectors, &self.product);
        let here = self.values[self.count % REMEMBERED];
        let known = &self.values[..(self.count + 1).min(REMEMBERED)];
        let ceiling = known.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let value = |x: f64| here - x * square + 0.5 * x * x * curvature;
        for _ in 0..HALVINGS {
            if value(trial) <= ceiling - DECREASE * trial * square {
                break;
            }
            trial *= 0.5;
        }
        self.count += 1;
        self.values[self.count % REMEMBERED] = value(trial);
        self.gradients.copy_from_slice(vectors);
        (self.step, self.square) = (trial, square);
        vectors.iter_mut().for_each(|x| *x *= trial);
    }

    fn reset(&mut self) {
        (self.step, self.square, self.count) = (0.0, 0.0, 0);
        self.values = [0.0; REMEMBERED];
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
