//! Exact scaling of data whose squares would overflow or underflow.

use std::borrow::Cow;

/// Multiplication by a power of two, which rounds nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PowerOfTwoScale {
    exponent: i32,
}

/// Between these exponents squares of values and of their rounding errors are normal doubles.
const SAFE_EXPONENTS: std::ops::RangeInclusive<i32> = -300..=300;

impl PowerOfTwoScale {
    /// The scale that brings data of this magnitude near 1; none in the usual range.
    pub(crate) fn for_magnitude(largest: f64) -> Self {
        let exponent = if largest == 0.0 { 0 } else { -exponent_of(largest) };
        Self { exponent: if SAFE_EXPONENTS.contains(&exponent) { 0 } else { exponent } }
    }

    /// Whether nothing is scaled.
    pub(crate) fn is_identity(self) -> bool {
        self.exponent == 0
    }

    pub(crate) fn apply(self, values: &[f64]) -> Cow<'_, [f64]> {
        if self.exponent == 0 {
            return Cow::Borrowed(values);
        }
        Cow::Owned(values.iter().map(|&x| self.up(x)).collect())
    }

    pub(crate) fn undo_in_place(self, values: &mut [f64]) {
        if self.exponent != 0 {
            values.iter_mut().for_each(|x| *x = self.undo(*x));
        }
    }

    /// Scales one number.
    pub(crate) fn up(self, x: f64) -> f64 {
        ldexp(x, self.exponent)
    }

    /// Scales one number back.
    pub(crate) fn undo(self, x: f64) -> f64 {
        ldexp(x, -self.exponent)
    }
}

/// Binary exponent of a finite, non-zero number, subnormal ones included.
fn exponent_of(x: f64) -> i32 {
    let raw = ((x.to_bits() >> 52) & 0x7ff) as i32;
    if raw == 0 { exponent_of(x * 2f64.powi(64)) - 64 } else { raw - 1023 }
}

/// `x * 2^exponent` in two steps, so that neither factor leaves the range.
fn ldexp(x: f64, exponent: i32) -> f64 {
    let half = exponent / 2;
    x * 2f64.powi(half) * 2f64.powi(exponent - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scaling_there_and_back_changes_no_bit() {
        for largest in [1e-300, 3.7e-310, 1e300, 1.7e308, 5e-324] {
            let scale = PowerOfTwoScale::for_magnitude(largest);
            let up = scale.up(largest);
            assert!((0.5..=2.0).contains(&up), "{largest} became {up}");
            assert_eq!(scale.undo(up), largest);
        }
    }

    #[test]
    fn usual_data_are_left_alone() {
        for largest in [0.0, 1e-12, 1.0, 6.4e6, 1e80] {
            assert_eq!(PowerOfTwoScale::for_magnitude(largest), PowerOfTwoScale { exponent: 0 });
        }
    }
}
