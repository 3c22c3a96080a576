//! The two generalisations of Ball's cubic basis to any degree: that of Wang, which is evaluated in
//! linear time and is not totally positive, and that of Said, which is.

use super::blending::{BlendingBasis, check_blending_degree};
use super::powers::{add_powers, mirror_rows};
use crate::Error;

/// The Wang-Ball basis of degree n on [0, 1] (Wang 1987; degree 4 in Chen, Wang and Jin 2012,
/// section 2.2): `W_i = (2t)^i (1 - t)^(i + 2)` for `i < n / 2 - 1 / 2`, a middle function
/// `(2t (1 - t))^(n / 2)` for even n, a pair `(2t)^h (1 - t)^(h + 1)` and its mirror image with
/// `h = (n - 1) / 2` for odd n, and mirror images. Not totally positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WangBall {
    degree: usize,
}

impl WangBall {
    /// Of a degree from 1 to 500.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(degree: usize) -> Result<Self, Error> {
        check_blending_degree(degree)?;
        Ok(Self { degree })
    }

    /// Exponents of 2t and of 1 - t in function i of the first half.
    fn exponents(self, i: usize) -> (usize, usize) {
        let (n, i2) = (self.degree, 2 * i);
        if i2 == n {
            (i, i)
        } else if i2 + 1 == n {
            (i, i + 1)
        } else {
            (i, i + 2)
        }
    }
}

impl BlendingBasis for WangBall {
    fn name(&self) -> &str {
        "wang-ball"
    }

    fn functions(&self) -> usize {
        self.degree + 1
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        let (n, s) = (self.degree, 1.0 - t);
        let half = |i: usize, t: f64, s: f64| {
            let (a, b) = self.exponents(i);
            // Together, so that neither factor underflows before its time.
            (2.0 * t * s).powi(a as i32) * s.powi((b - a) as i32)
        };
        for i in 0..=n / 2 {
            values[i] = half(i, t, s);
            values[n - i] = half(i, s, t);
        }
    }

    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        let (n, count) = (self.degree, self.degree + 1);
        let mut coefficients = vec![0.0; count * count];
        for i in 0..=n / 2 {
            let (a, b) = self.exponents(i);
            add_powers(a, b, 2f64.powi(a as i32), &mut coefficients[i * count..][..count]);
        }
        mirror_rows(&mut coefficients, count);
        Some(coefficients)
    }
}

/// The Said-Ball basis of degree n on [0, 1] (Said 1989; Goodman and Said 1991): with
/// `h = floor(n / 2)`, `S_i = C(h + i, i) t^i (1 - t)^(h + 1)` for `i < n / 2`, a middle function
/// `C(n, h) (t (1 - t))^h` for even n, and mirror images. Normalised totally positive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SaidBall {
    degree: usize,
}

impl SaidBall {
    /// Of a degree from 1 to 500.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn new(degree: usize) -> Result<Self, Error> {
        check_blending_degree(degree)?;
        Ok(Self { degree })
    }
}

impl BlendingBasis for SaidBall {
    fn name(&self) -> &str {
        "said-ball"
    }

    fn functions(&self) -> usize {
        self.degree + 1
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        let (n, h, s) = (self.degree, self.degree / 2, 1.0 - t);
        let (mut left, mut right) = (s.powi(h as i32 + 1), t.powi(h as i32 + 1));
        for i in 0..n.div_ceil(2) {
            (values[i], values[n - i]) = (left, right);
            let ratio = (h + i + 1) as f64 / (i + 1) as f64;
            left *= t * ratio;
            right *= s * ratio;
        }
        if n.is_multiple_of(2) {
            // C(n, h) as a product of ratios not above 4.
            values[h] = (1..=h).map(|k| (h + k) as f64 / k as f64 * (t * s)).product();
        }
    }

    fn is_totally_positive(&self) -> bool {
        true
    }

    fn bernstein_coefficients(&self) -> Option<Vec<f64>> {
        let (n, h, count) = (self.degree, self.degree / 2, self.degree + 1);
        let mut coefficients = vec![0.0; count * count];
        let mut binomial = 1.0;
        for i in 0..n.div_ceil(2) {
            add_powers(i, h + 1, binomial, &mut coefficients[i * count..][..count]);
            binomial *= (h + i + 1) as f64 / (i + 1) as f64;
        }
        if n.is_multiple_of(2) {
            coefficients[h * count + h] = 1.0;
        }
        mirror_rows(&mut coefficients, count);
        Some(coefficients)
    }
}
