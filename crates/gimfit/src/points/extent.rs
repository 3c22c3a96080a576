//! How large the data are: the scale against which residuals are judged.

use super::PointsView;
use crate::Error;

/// Bounding box of points.
#[derive(Debug, Clone, PartialEq)]
pub struct Extent {
    /// Smallest value of each coordinate.
    pub lower: Vec<f64>,
    /// Largest value of each coordinate.
    pub upper: Vec<f64>,
}

impl Extent {
    /// Measures points, checking on the way that every coordinate is finite.
    ///
    /// # Errors
    /// [`Error::NotFinite`], [`Error::ExtentOverflow`]; [`Error::NoPoints`] for none.
    pub fn of(points: PointsView<'_>) -> Result<Self, Error> {
        let dimension = points.dimension();
        if points.is_empty() {
            return Err(Error::NoPoints { needed: 1 });
        }
        let (lower, upper) = bounds(points.coordinates(), dimension);
        let finite = |bounds: &[f64]| bounds.iter().all(|x| x.is_finite());
        if !(finite(&lower) && finite(&upper)) {
            return Err(first_not_finite(points));
        }
        if let Some(coordinate) = (0..dimension).find(|&i| !(upper[i] - lower[i]).is_finite()) {
            return Err(Error::ExtentOverflow { coordinate });
        }
        let extent = Self { lower, upper };
        if !extent.diagonal().is_finite() {
            return Err(Error::ExtentOverflow { coordinate: dimension - 1 });
        }
        Ok(extent)
    }

    /// Length of the diagonal, free of overflow and underflow in between.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.lower.iter().zip(&self.upper).fold(0.0, |sum: f64, (low, high)| sum.hypot(high - low))
    }

    /// Largest absolute value of any coordinate.
    #[must_use]
    pub fn largest_coordinate(&self) -> f64 {
        self.lower.iter().chain(&self.upper).fold(0.0, |largest: f64, x| largest.max(x.abs()))
    }
}

/// Smallest and largest value of each coordinate; NaN where a value is not finite.
fn bounds(coordinates: &[f64], dimension: usize) -> (Vec<f64>, Vec<f64>) {
    // The usual dimensions divide 12, so that 12 lanes walk the flat array side by side.
    let mut lanes = [Lane::EMPTY; 12];
    let (chunks, rest) = coordinates.as_chunks::<12>();
    if lanes.len().is_multiple_of(dimension) {
        for chunk in chunks {
            for (lane, &x) in lanes.iter_mut().zip(chunk) {
                lane.widen(x);
            }
        }
        lanes.iter_mut().zip(rest).for_each(|(lane, &x)| lane.widen(x));
        let of = |i: usize| lanes.iter().skip(i).step_by(dimension);
        return (0..dimension).map(|i| of(i).fold(Lane::EMPTY, Lane::join).ends()).unzip();
    }
    let mut lanes = vec![Lane::EMPTY; dimension];
    for point in coordinates.chunks_exact(dimension) {
        lanes.iter_mut().zip(point).for_each(|(lane, &x)| lane.widen(x));
    }
    lanes.iter().map(Lane::ends).unzip()
}

/// Running bounds of some values.
#[derive(Debug, Clone, Copy)]
struct Lane {
    low: f64,
    high: f64,
    /// Zero as long as all values are finite, NaN afterwards.
    flaw: f64,
}

impl Lane {
    const EMPTY: Self = Self { low: f64::INFINITY, high: f64::NEG_INFINITY, flaw: 0.0 };

    #[inline]
    fn widen(&mut self, x: f64) {
        self.low = if x < self.low { x } else { self.low };
        self.high = if x > self.high { x } else { self.high };
        self.flaw += x * 0.0;
    }

    fn join(self, other: &Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            flaw: self.flaw + other.flaw,
        }
    }

    fn ends(&self) -> (f64, f64) {
        (self.low + self.flaw, self.high + self.flaw)
    }
}

fn first_not_finite(points: PointsView<'_>) -> Error {
    let dimension = points.dimension();
    let (position, &value) = points
        .coordinates()
        .iter()
        .enumerate()
        .find(|(_, x)| !x.is_finite())
        .unwrap_or((0, &f64::NAN));
    Error::NotFinite { point: position / dimension, coordinate: position % dimension, value }
}
