//! The basis of Delgado and Pena (2003): normalised totally positive, and evaluated in linear time.

use super::blending::{BlendingBasis, check_blending_degree};
use super::powers::{add_powers, mirror_rows};
use crate::Error;

/// The DP basis of degree n on [0, 1]: `D_0 = (1 - t)^n`, `D_i = t (1 - t)^(n - i)` up to the middle,
/// mirror images, and in the middle what is missing to 1: with `h = floor(n / 2)` and
/// `r(t) = 1 - t^(h + 1) - (1 - t)^(h + 1)`, `D_h = r` for even n and
/// `D_h = t (1 - t)^(h + 1) + r / 2` and its mirror image for odd n from 3.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dp {
    degree: usize,
}

impl Dp {
    /// Of a degree from 1 to 500.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(degree: usize) -> Result<Self, Error> {
        check_blending_degree(degree)?;
        Ok(Self { degree })
    }
}

/// `1 - t^(h + 1) - (1 - t)^(h + 1) = t (1 - t) sum_(k < h) (t^k + (1 - t)^k)`, without the
/// subtraction.
fn rest(t: f64, s: f64, h: usize) -> f64 {
    let (mut t_power, mut s_power, mut sum) = (1.0, 1.0, 0.0);
    for _ in 0..h {
        sum += t_power + s_power;
        t_power *= t;
        s_power *= s;
    }
    t * s * sum
}

impl BlendingBasis for Dp {
    fn name(&self) -> &str {
        "dp"
    }

    fn functions(&self) -> usize {
        self.degree + 1
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        let (n, h, s) = (self.degree, self.degree / 2, 1.0 - t);
        (values[0], values[n]) = (s.powi(n as i32), t.powi(n as i32));
        if n == 1 {
            return;
        }
        // Up to the middle: i < n / 2.
        for i in 1..n.div_ceil(2) {
            let power = (n - i) as i32;
            values[i] = t * s.powi(power);
            values[n - i] = s * t.powi(power);
        }
        let rest = rest(t, s, h);
        if n.is_multiple_of(2) {
            values[h] = rest;
        } else {
            values[h] += 0.5 * rest;
            values[h + 1] += 0.5 * rest;
        }
    }

    fn is_totally_positive(&self) -> bool {
        true
    }

    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        let (n, h, count) = (self.degree, self.degree / 2, self.degree + 1);
        let mut coefficients = vec![0.0; count * count];
        coefficients[0] = 1.0;
        for i in 1..n.div_ceil(2) {
            add_powers(1, n - i, 1.0, &mut coefficients[i * count..][..count]);
        }
        if n > 1 {
            let share = if n.is_multiple_of(2) { 1.0 } else { 0.5 };
            let row = &mut coefficients[h * count..][..count];
            for k in 0..h {
                add_powers(k + 1, 1, share, row);
                add_powers(1, k + 1, share, row);
            }
        }
        mirror_rows(&mut coefficients, count);
        Some(coefficients)
    }
}
