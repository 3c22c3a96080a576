//! A logarithmic axis of whole decades.

use super::text;

/// Residuals that lie further below the largest are rounding noise of no
/// interest, and would squeeze the rest into a line.
const MOST_DECADES: i32 = 24;

/// A map from positive values to positions, from decade to decade.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LogScale {
    bottom: i32,
    top: i32,
    start: f64,
    end: f64,
}

impl LogScale {
    /// The decades that hold the positive finite ones of `values`; `None` if
    /// there are none.
    pub(crate) fn around(values: impl Iterator<Item = f64>, start: f64, end: f64) -> Option<Self> {
        let mut ends: Option<(f64, f64)> = None;
        for value in values.filter(|v| *v > 0.0 && v.is_finite()) {
            let (low, high) = ends.unwrap_or((value, value));
            ends = Some((low.min(value), high.max(value)));
        }
        let (low, high) = ends?;
        // A hair of slack: 1e-5 itself must not open a decade of its own.
        let mut bottom = (low.log10() + 1.0e-9).floor() as i32;
        let mut top = (high.log10() - 1.0e-9).ceil() as i32;
        if top <= bottom {
            // One power of ten alone: it belongs in the middle.
            bottom -= 1;
            top = bottom + 2;
        }
        Some(Self { bottom: bottom.max(top - MOST_DECADES), top, start, end })
    }

    /// The same scale, lowered so that it reaches `value`, provided that this
    /// adds no more than `most` decades.
    pub(crate) fn reaching(self, value: f64, most: i32) -> Self {
        if !(value > 0.0 && value.is_finite()) {
            return self;
        }
        let bottom = (value.log10() + 1.0e-9).floor() as i32;
        if (self.bottom - most..self.bottom).contains(&bottom) {
            Self { bottom, ..self }
        } else {
            self
        }
    }

    /// Position of `value`, and whether it lies below the axis and has been
    /// put at its lower end.
    pub(crate) fn at(&self, value: f64) -> (f64, bool) {
        let exponent = if value > 0.0 { value.log10() } else { -1.0e6 };
        let t = (exponent - f64::from(self.bottom)) / f64::from(self.top - self.bottom);
        let below = t < -1.0e-9;
        (self.start + t.clamp(0.0, 1.0) * (self.end - self.start), below)
    }

    /// Whether `value` lies between the ends of the axis.
    pub(crate) fn holds(&self, value: f64) -> bool {
        value > 0.0
            && value.log10() >= f64::from(self.bottom)
            && value.log10() <= f64::from(self.top)
    }

    /// The value at the lower end, as a label.
    pub(crate) fn bottom_label(&self) -> String {
        text::power_of_ten(self.bottom)
    }

    /// Position and label of decades, `spacing` or more apart.
    pub(crate) fn marks(&self, spacing: f64) -> Vec<(f64, String)> {
        let decades = self.top - self.bottom;
        let per_decade = (self.end - self.start).abs() / f64::from(decades);
        let stride = [1, 2, 3, 4, 5, 6, 8, 10, 12]
            .into_iter()
            .find(|&stride| f64::from(stride) * per_decade >= spacing)
            .unwrap_or(decades.max(1));
        (self.bottom..=self.top)
            .filter(|exponent| exponent.rem_euclid(stride) == 0)
            .map(|exponent| (self.position(exponent), text::power_of_ten(exponent)))
            .collect()
    }

    fn position(&self, exponent: i32) -> f64 {
        let t = f64::from(exponent - self.bottom) / f64::from(self.top - self.bottom);
        self.start + t * (self.end - self.start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scale(values: &[f64]) -> LogScale {
        LogScale::around(values.iter().copied(), 100.0, 0.0).unwrap()
    }

    #[test]
    fn decades_hold_the_values() {
        let s = scale(&[3.0e-5, 0.2, 0.0, f64::NAN]);
        assert_eq!(s.at(1.0e-5).0, 100.0);
        assert_eq!(s.at(1.0), (0.0, false));
        assert_eq!(s.at(0.0), (100.0, true));
        assert_eq!(s.marks(15.0).len(), 6);
        assert_eq!(s.marks(15.0)[0].1, "10⁻⁵");
    }

    #[test]
    fn one_power_of_ten_lies_between_two() {
        let s = scale(&[1.0e-3]);
        assert!((s.at(1.0e-3).0 - 50.0).abs() < 1.0e-6);
        assert_eq!(s.marks(10.0).len(), 3);
    }

    #[test]
    fn extremes_keep_the_axis_short() {
        let s = scale(&[5.0e-324, 1.0e300]);
        assert!(s.marks(18.0).len() < 10);
        assert!(s.at(5.0e-324).1);
        assert!(LogScale::around([0.0].into_iter(), 0.0, 1.0).is_none());
    }

    #[test]
    fn a_level_close_below_is_reached_and_a_far_one_is_not() {
        let s = scale(&[1.0e-3, 1.0e-11]);
        assert!(s.reaching(5.0e-13, 3).holds(5.0e-13));
        assert!(!s.reaching(1.0e-20, 3).holds(1.0e-20));
    }
}
