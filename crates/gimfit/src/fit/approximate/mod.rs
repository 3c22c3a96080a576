//! Curves within a distance of the data, with few control points: least squares in which breakpoints
//! and parameters are sought as well.

mod abscissa;
mod attempt;
pub(super) mod breaks;
mod corners;
mod finish;
mod goal;
mod noise;
mod options;
mod pieces;
pub(super) mod polyline;
mod problem;
mod robust;
mod run;
mod sample;
mod search;
mod verify;

pub use options::{ApproximationOptions, Corners, Goal, Robust};
pub(super) use problem::Measure;

use super::CurveFit;
use crate::Error;
use crate::iteration::{NoObserver, Observer, Termination};
use crate::points::PointsView;
use crate::report::ApproximationReport;
use run::approximate;

/// Demands are met with this much to spare, so that rounding does not break them.
pub(super) const SPARE: f64 = 1.0 - 1e-6;

/// Finds a curve that keeps within a distance of ordered points, with as few control points as it
/// can; or the closest one of a given size.
///
/// Breakpoints go where the distance is largest, are placed anew after the jumps of the highest
/// derivative, and are taken out again as long as all demands are met. Every attempt is a weighted
/// least squares fit whose parameters move towards their foot points (Rios and Juettler 2022) and
/// whose weights move to the largest distances (Lawson 1961). Between the points the curve may stray
/// from their polyline no farther than the tolerance and 1.5 times what a local interpolant does.
/// At corners the curve meets the data point, with a knot of full multiplicity.
///
/// A goal that was not met is no error: see
/// [`ApproximationReport::met`](crate::ApproximationReport::met).
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`].
///
/// # Examples
/// ```
/// use gimfit::{ApproximationOptions, approximate_curve};
/// let points: Vec<[f64; 2]> = (0..200)
///     .map(|i| {
///         let x = f64::from(i) / 20.0;
///         [x, x.sin()]
///     })
///     .collect();
/// let fit = approximate_curve(&points, &ApproximationOptions::within(0.01))?;
/// let account = fit.report.approximation.as_ref().unwrap();
/// assert!(account.met && account.max_distance <= 0.01);
/// assert!(fit.curve.control_points().len() <= 10);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn approximate_curve<'a>(
    points: impl Into<PointsView<'a>>,
    options: &ApproximationOptions,
) -> Result<CurveFit, Error> {
    approximate_curve_observed(points, options, &mut NoObserver)
}

/// As [`approximate_curve`], watched round by round; the observer sees the largest distance of the
/// attempt at work, and may stop the search: the best attempt so far is returned.
///
/// # Errors
/// As [`approximate_curve`].
pub fn approximate_curve_observed<'a>(
    points: impl Into<PointsView<'a>>,
    options: &ApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let points = points.into();
    let fit = approximate(points, options, observer)?;
    let account = Account::of(&fit);
    let cheap = account.met && fit.report.control_points <= fit.report.points;
    let stopped = fit.report.run.termination == Termination::Cancelled;
    if options.corners != Corners::Auto || account.corners == 0 || cheap || stopped {
        return Ok(fit);
    }
    // Of a polygon each point is a corner, and costs as much as several smooth ones.
    let smooth = ApproximationOptions { corners: Corners::None, ..options.clone() };
    let mut smooth = approximate(points, &smooth, observer)?;
    if Account::of(&smooth).rank() <= account.rank() {
        return Ok(fit);
    }
    smooth.report.run.choices.push(format!(
        "corners: none are kept sharp, because with the {} that the data show the curve would have {} \
         control points{}",
        account.corners,
        account.control_points,
        if account.met { "" } else { " and be no closer" },
    ));
    Ok(smooth)
}

/// What decides between two fits.
struct Account {
    met: bool,
    calm: bool,
    corners: usize,
    control_points: usize,
}

impl Account {
    fn of(fit: &CurveFit) -> Self {
        let account = fit.report.approximation.as_ref();
        Self {
            met: account.is_some_and(|account| account.met),
            calm: account.is_some_and(ApproximationReport::is_calm),
            corners: account.map_or(0, |account| account.corners.len()),
            control_points: fit.report.control_points,
        }
    }

    /// Greater is better.
    fn rank(&self) -> (bool, bool, std::cmp::Reverse<usize>) {
        (self.met, self.calm, std::cmp::Reverse(self.control_points))
    }
}

/// Moves the middle of the bounding box to the origin, so that far-off data lose no digits to their
/// place; gives the middle.
pub(super) fn centre_at_origin(data: &mut [f64], dimension: usize) -> Vec<f64> {
    let mut low = vec![f64::INFINITY; dimension];
    let mut high = vec![f64::NEG_INFINITY; dimension];
    for point in data.chunks_exact(dimension) {
        for i in 0..dimension {
            low[i] = low[i].min(point[i]);
            high[i] = high[i].max(point[i]);
        }
    }
    let centre: Vec<f64> = low.iter().zip(&high).map(|(a, b)| a + 0.5 * (b - a)).collect();
    data.chunks_exact_mut(dimension).for_each(|point| {
        point.iter_mut().zip(&centre).for_each(|(x, c)| *x -= c);
    });
    centre
}
