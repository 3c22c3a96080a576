//! Fits to choose from: what each distance costs in control points.

use super::approximate::{ApproximationOptions, Goal, approximate_curve_observed};
use super::approximate_surface::{
    SurfaceApproximationOptions, SurfaceGoal, approximate_surface_observed,
};
use super::{CurveFit, SurfaceFit};
use crate::Error;
use crate::iteration::{Observer, Termination};
use crate::points::{GridView, PointsView};

/// Curves from few control points to many: for each distance, from the largest to the smallest, the fit
/// that [`approximate_curve`](super::approximate_curve) finds within it. Whatever goal the options
/// have is left aside.
///
/// A fit is left out if a later one is closer with no more control points. The sequence ends before
/// the distances do where one cannot be kept (that fit is the last, and its report says so), where a
/// fit has more than half as many control points as there are points, or where the observer stops it.
///
/// # Errors
/// As [`approximate_curve`](super::approximate_curve).
///
/// # Examples
/// ```
/// use gimfit::iteration::NoObserver;
/// use gimfit::{ApproximationOptions, curve_choices};
/// let points: Vec<[f64; 2]> = (0..200)
///     .map(|i| {
///         let x = f64::from(i) / 20.0;
///         [x, x.sin()]
///     })
///     .collect();
/// let options = ApproximationOptions::within(1.0);
/// let fits = curve_choices(&points, &[0.1, 0.01, 0.001], &options, &mut NoObserver)?;
/// assert!(fits.windows(2).all(|pair| {
///     pair[0].curve.control_points().len() < pair[1].curve.control_points().len()
/// }));
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn curve_choices<'a>(
    points: impl Into<PointsView<'a>>,
    distances: &[f64],
    options: &ApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<Vec<CurveFit>, Error> {
    let points = points.into();
    choices(distances, points.len(), |distance| {
        let options = ApproximationOptions { goal: Goal::Tolerance(distance), ..options.clone() };
        approximate_curve_observed(points, &options, observer)
    })
}

/// As [`curve_choices`], of surfaces within distances of a grid.
///
/// # Errors
/// As [`approximate_surface`](super::approximate_surface).
pub fn surface_choices(
    grid: GridView<'_>,
    distances: &[f64],
    options: &SurfaceApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<Vec<SurfaceFit>, Error> {
    choices(distances, grid.points().len(), |distance| {
        let options =
            SurfaceApproximationOptions { goal: SurfaceGoal::Tolerance(distance), ..*options };
        approximate_surface_observed(grid, &options, observer)
    })
}

/// Distances to choose between: 1, 2 and 5 times powers of ten, from half the extent down to a
/// hundred-thousandth of it. Empty unless the extent is a positive number.
#[must_use]
pub fn usual_distances(extent: f64) -> Vec<f64> {
    const MOST: f64 = 0.5;
    const LEAST: f64 = 1e-5;
    if !(extent > 0.0 && extent.is_finite()) {
        return Vec::new();
    }
    let decade = (MOST * extent).log10().floor() as i32;
    let all = (0..=6).flat_map(|k| [5, 2, 1].map(|digit| (digit, decade - k)));
    // As written, so that 0.05 is the double that a person types.
    let value = |(digit, exponent): (i32, i32)| format!("{digit}e{exponent}").parse::<f64>().ok();
    // A hair of slack for extents that are such a number themselves.
    let fits = |x: &f64| {
        *x <= MOST * extent * (1.0 + 1e-9) && *x >= LEAST * extent * (1.0 - 1e-9) && *x > 0.0
    };
    all.filter_map(value).filter(fits).collect()
}

/// What the sequences need of a fit.
trait Choice {
    fn control_points(&self) -> usize;
    fn termination(&self) -> Termination;
    fn met(&self) -> bool;
}

impl Choice for CurveFit {
    fn control_points(&self) -> usize {
        self.curve.free_control_points()
    }

    fn termination(&self) -> Termination {
        self.report.run.termination
    }

    fn met(&self) -> bool {
        self.report.approximation.as_ref().is_some_and(|account| account.met)
    }
}

impl Choice for SurfaceFit {
    fn control_points(&self) -> usize {
        self.surface.control_net().points().len()
    }

    fn termination(&self) -> Termination {
        self.report.run.termination
    }

    fn met(&self) -> bool {
        self.report.approximation.as_ref().is_some_and(|account| account.met)
    }
}

fn choices<F: Choice>(
    distances: &[f64],
    points: usize,
    mut fit: impl FnMut(f64) -> Result<F, Error>,
) -> Result<Vec<F>, Error> {
    let mut distances = distances.to_vec();
    distances.sort_by(|a, b| b.total_cmp(a));
    distances.dedup();
    let mut found: Vec<F> = Vec::new();
    for distance in distances {
        let next = fit(distance)?;
        let (size, met) = (next.control_points(), next.met());
        let stopped = next.termination() == Termination::Cancelled;
        if stopped && !met {
            break;
        }
        if met {
            while found.last().is_some_and(|last| last.control_points() >= size) {
                found.pop();
            }
        }
        found.push(next);
        if stopped || !met || 2 * size > points {
            break;
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_distances_are_what_people_type() {
        assert_eq!(usual_distances(1.0).len(), 15);
        assert_eq!(usual_distances(1.0)[..4], [0.5, 0.2, 0.1, 0.05]);
        assert_eq!(usual_distances(1.0).last(), Some(&1e-5));
        assert_eq!(usual_distances(37.0)[..3], [10.0, 5.0, 2.0]);
        for extent in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(usual_distances(extent).is_empty());
        }
        for extent in [1e-300, 1e300, 123.456] {
            let found = usual_distances(extent);
            assert!((14..=15).contains(&found.len()), "{found:?}");
            assert!(found.windows(2).all(|pair| pair[0] > pair[1] && pair[1] > 0.0));
        }
    }
}
