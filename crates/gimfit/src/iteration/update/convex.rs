//! Convexity-preserving PIA for planar curves (Lin, Wang and Dong 2004, section 1.3, Algorithm 1):
//! `P <- P + eps (Q - A P)`, where eps in (0, 1] is found by bisection so that every turn of the
//! control polygon keeps its sign.
//!
//! The paper's Theorem 2 takes the product of `1 - eps_k lambda` for granted to vanish; it does so
//! only if the sum of the `eps_k` is infinite. Where a corner reaches the straight line before the
//! fit is close, the `eps_k` fall faster than that, and the run stalls.

use super::{Step, UpdateRule};
use crate::shape::Shape;

/// Steps in a row, cut and too short to matter, after which a run is called stalled.
const PATIENCE: usize = 4;
/// Halvings after which a step is nothing, whatever the scale of the data.
const MOST_HALVINGS: usize = 1100;

/// Cuts the steps of another rule so that a planar control polygon keeps its shape.
#[derive(Debug)]
pub struct ConvexityPreserving<R> {
    rule: R,
    shape: Shape,
    threshold: f64,
    /// Steps in a row that were cut to less than the threshold.
    short: usize,
}

impl<R: UpdateRule> ConvexityPreserving<R> {
    /// Guards the steps of `rule`, for points of dimension 2 and a start that has this shape.
    /// `threshold` is the paper's D: bisection ends when no control point would move farther than
    /// that by all that is left to decide.
    #[must_use]
    pub fn new(rule: R, shape: Shape, threshold: f64) -> Self {
        Self { rule, shape, threshold, short: 0 }
    }

    /// The paper's Algorithm 1, its two polylines as shares of the step: `kept` keeps the shape,
    /// `other` is where it is looked for still.
    fn admissible_share(&self, step: Step<'_>, vectors: &[f64], longest: f64) -> f64 {
        let is_kept = |share: f64| self.shape.is_kept_after(step.control, vectors, share);
        if is_kept(1.0) {
            return 1.0;
        }
        let mut kept = 0.5;
        let mut halvings = 1;
        while !is_kept(kept) {
            kept *= 0.5;
            halvings += 1;
            if halvings > MOST_HALVINGS {
                return 0.0;
            }
        }
        let mut other = 1.0;
        while (other - kept) * longest > self.threshold {
            let middle = 0.5 * (kept + other);
            if middle <= kept || middle >= other {
                break;
            }
            if is_kept(middle) {
                kept = middle;
            } else {
                other = middle;
            }
        }
        kept
    }
}

impl<R: UpdateRule> UpdateRule for ConvexityPreserving<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.rule.adjust(step, vectors);
        let longest = vectors.chunks_exact(2).fold(0.0, |most: f64, v| most.max(v[0].hypot(v[1])));
        let share = self.admissible_share(step, vectors, longest);
        if share < 1.0 {
            vectors.iter_mut().for_each(|x| *x *= share);
        }
        let cut_short = share < 1.0 && share * longest <= self.threshold;
        self.short = if cut_short { self.short + 1 } else { 0 };
    }

    fn is_stuck(&self) -> bool {
        self.short >= PATIENCE || self.rule.is_stuck()
    }

    fn reset(&mut self) {
        self.rule.reset();
        self.short = 0;
    }
}
