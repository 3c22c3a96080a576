//! Maps from values to positions in the picture.

/// Values beyond this size are drawn as if they had it, so that differences
/// of two values never overflow.
const LARGEST: f64 = 1.0e300;

/// Brings `value` into the range that scales can handle; `None` if it is no
/// number.
pub(crate) fn drawable(value: f64) -> Option<f64> {
    (!value.is_nan()).then(|| value.clamp(-LARGEST, LARGEST))
}

/// A closed interval of values, with finite ends and more than one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    /// The smallest interval that holds all `values`; `None` without any.
    pub(crate) fn around(values: impl Iterator<Item = f64>) -> Option<Self> {
        let mut found: Option<Self> = None;
        for value in values.filter_map(drawable) {
            let (low, high) = match found {
                Some(old) => (old.low.min(value), old.high.max(value)),
                None => (value, value),
            };
            found = Some(Self { low, high });
        }
        found
    }

    pub(crate) fn span(&self) -> f64 {
        self.high - self.low
    }

    pub(crate) fn centre(&self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    /// The smallest interval that holds both.
    pub(crate) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The interval made longer by `amount` at both ends.
    pub(crate) fn grown(self, amount: f64) -> Self {
        Self { low: (self.low - amount).max(-LARGEST), high: (self.high + amount).min(LARGEST) }
    }

    /// The interval itself, or one about it that is long enough to draw if
    /// rounding is all that separates its ends.
    pub(crate) fn opened(self) -> Self {
        let size = self.low.abs().max(self.high.abs());
        if self.span() > shortest_span(size) {
            return self;
        }
        let half = if size > 1.0e-290 { 0.1 * size } else { 1.0 };
        let centre = self.centre();
        Self { low: centre - half, high: centre + half }
    }
}

/// The shortest span at which values of size `size` can be told apart well
/// enough to be given an axis.
pub(crate) fn shortest_span(size: f64) -> f64 {
    (64.0 * f64::EPSILON * size).max(1.0e-300)
}

/// A linear map from values to positions along one direction of the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    values: Interval,
    start: f64,
    end: f64,
}

impl Scale {
    /// The map that takes the ends of `values` to `start` and `end`.
    pub(crate) fn new(values: Interval, start: f64, end: f64) -> Self {
        Self { values: values.opened(), start, end }
    }

    pub(crate) fn values(&self) -> Interval {
        self.values
    }

    /// Length in the picture.
    pub(crate) fn length(&self) -> f64 {
        (self.end - self.start).abs()
    }

    /// Position of `value`; no number where it is none.
    pub(crate) fn at(&self, value: f64) -> f64 {
        let Some(value) = drawable(value) else {
            return f64::NAN;
        };
        let t = (value - self.values.low) / self.values.span();
        // Far enough outside to be cut away, near enough to stay exact.
        self.start + t.clamp(-1.0e3, 1.0e3) * (self.end - self.start)
    }
}

/// Two scales with the same number of units to a length of the picture: both
/// intervals are made longer about their centres to fill the rectangle, and
/// at least `margin` of it is left on each side.
pub(crate) fn equal_scales(
    x: Interval,
    y: Interval,
    across: (f64, f64),
    upward: (f64, f64),
    margin: f64,
) -> (Scale, Scale) {
    let width = (across.1 - across.0).abs();
    let height = (upward.1 - upward.0).abs();
    let inner = |length: f64| (length - 2.0 * margin).max(1.0);
    let units = (x.span() / inner(width)).max(y.span() / inner(height));
    let size = [x.low, x.high, y.low, y.high].iter().fold(0.0_f64, |size, v| size.max(v.abs()));
    // Where all points are one point any scale will do, if one can read it.
    let units = if units * width.max(height) > shortest_span(size) {
        units
    } else if size > 1.0e-290 {
        0.2 * size / width
    } else {
        2.0 / width
    };
    let about = |values: Interval, length: f64| {
        let half = 0.5 * units * length;
        let centre = values.centre();
        Interval { low: centre - half, high: centre + half }
    };
    (
        Scale::new(about(x, width), across.0, across.1),
        Scale::new(about(y, height), upward.0, upward.1),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extreme_intervals_map_to_numbers_within_reach() {
        for (low, high) in [
            (0.0, 0.0),
            (-f64::MAX, f64::MAX),
            (1.0e-300, 1.0e-300),
            (0.0, f64::MIN_POSITIVE),
            (1.0e9, 1.0e9 + 1.0e-7),
            (5.0, 5.0),
        ] {
            let values = Interval::around([low, high].into_iter()).unwrap();
            let scale = Scale::new(values, 0.0, 100.0);
            for value in [low, high, f64::INFINITY, -f64::MAX] {
                let at = scale.at(value);
                assert!(at.is_finite() && at.abs() <= 1.1e5, "{low} {high} {at}");
            }
            assert!((-1.0..=101.0).contains(&scale.at(low)));
        }
        assert!(Interval::around([f64::NAN].into_iter()).is_none());
    }

    #[test]
    fn equal_scales_agree_and_hold_everything() {
        let x = Interval { low: 0.0, high: 10.0 };
        let y = Interval { low: -1.0, high: 1.0 };
        let (sx, sy) = equal_scales(x, y, (0.0, 220.0), (100.0, 0.0), 10.0);
        let per_unit = |s: &Scale| (s.at(1.0) - s.at(0.0)).abs();
        assert!((per_unit(&sx) - per_unit(&sy)).abs() < 1e-9);
        assert!((sx.at(0.0), sx.at(10.0)) == (10.0, 210.0));
        assert!(sy.at(0.0) == 50.0);
    }
}
