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
    if 12_usize.is_multiple_of(dimension) {
        let mut lanes = Lanes::<12>::new();
        let (chunks, rest) = coordinates.as_chunks::<12>();
        chunks.iter().for_each(|chunk| lanes.widen(chunk));
        return lanes.joined(dimension, rest);
    }
    (0..dimension)
        .map(|i| {
            let mut lane = Lanes::<1>::new();
            coordinates.iter().skip(i).step_by(dimension).for_each(|&x| lane.widen(&[x]));
            let (low, high) = lane.joined(1, &[]);
            (low[0], high[0])
        })
        .unzip()
}

/// Running bounds of `N` interleaved sequences.
struct Lanes<const N: usize> {
    low: [f64; N],
    high: [f64; N],
    /// Zero as long as all values are finite, NaN afterwards.
    flaw: [f64; N],
}

impl<const N: usize> Lanes<N> {
    fn new() -> Self {
        Self { low: [f64::INFINITY; N], high: [f64::NEG_INFINITY; N], flaw: [0.0; N] }
    }

    #[inline]
    fn widen(&mut self, values: &[f64; N]) {
        for i in 0..N {
            let x = values[i];
            self.low[i] = if x < self.low[i] { x } else { self.low[i] };
            self.high[i] = if x > self.high[i] { x } else { self.high[i] };
            self.flaw[i] += x * 0.0;
        }
    }

    /// Bounds of each coordinate, where lane `i` holds coordinate `i % dimension` and `rest` goes on
    /// from lane 0; NaN where a value was not finite.
    fn joined(&self, dimension: usize, rest: &[f64]) -> (Vec<f64>, Vec<f64>) {
        (0..dimension)
            .map(|i| {
                let (mut low, mut high, mut flaw) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
                for lane in (i..N).step_by(dimension) {
                    low = low.min(self.low[lane]);
                    high = high.max(self.high[lane]);
                    flaw += self.flaw[lane];
                }
                for &x in rest.iter().skip(i).step_by(dimension) {
                    low = low.min(x);
                    high = high.max(x);
                    flaw += x * 0.0;
                }
                (low + flaw, high + flaw)
            })
            .unzip()
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
