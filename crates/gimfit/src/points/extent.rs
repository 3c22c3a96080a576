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
    const LANES: usize = 12;
    let lanes = if LANES.is_multiple_of(dimension) { LANES } else { dimension };
    let mut low = vec![f64::INFINITY; lanes];
    let mut high = vec![f64::NEG_INFINITY; lanes];
    // Zero as long as all values are finite.
    let mut flaw = vec![0.0; lanes];
    let mut widen = |values: &[f64]| {
        for (i, &x) in values.iter().enumerate() {
            low[i] = if x < low[i] { x } else { low[i] };
            high[i] = if x > high[i] { x } else { high[i] };
            flaw[i] += x * 0.0;
        }
    };
    let chunks = coordinates.chunks_exact(lanes);
    let rest = chunks.remainder();
    if lanes == LANES {
        // A length known at compile time lets the loop be unrolled.
        coordinates.as_chunks::<LANES>().0.iter().for_each(|chunk| widen(chunk));
    } else {
        chunks.for_each(&mut widen);
    }
    widen(rest);
    let fold = |lanes: &[f64], pick: fn(f64, f64) -> f64| -> Vec<f64> {
        (0..dimension)
            .map(|i| {
                let own = lanes.iter().zip(&flaw).skip(i).step_by(dimension);
                own.map(|(x, flaw)| x + flaw).reduce(pick_or_nan(pick)).unwrap_or(f64::NAN)
            })
            .collect()
    };
    (fold(&low, f64::min), fold(&high, f64::max))
}

/// `f64::min` and `f64::max` ignore NaN; here it must survive.
fn pick_or_nan(pick: fn(f64, f64) -> f64) -> impl Fn(f64, f64) -> f64 {
    move |a, b| if a.is_nan() || b.is_nan() { f64::NAN } else { pick(a, b) }
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
