//! Row sums of the inverse of a collocation matrix, without its signs: the largest of them bounds how
//! far residuals can shift control points.
//!
//! The matrix is totally positive, so that its inverse has the signs of a chessboard, and the row sums
//! are, but for theirs, the control points of the data `1, -1, 1, -1, ...`. The matrix of a closed curve
//! is not; but that of the curve unrolled, round after round, is: bi-infinite, banded, and with an
//! inverse that has the signs of a chessboard again (de Boor 1982). What it makes of data that repeat
//! is what the closed curve makes of one round of them, so that the inverse of the latter is no larger.
//! The row sums of the former repeat from round to round; with an odd number of points the data above
//! repeat every second round only, and so two rounds are fitted.

use crate::Error;
use crate::collocation::ControlLayout;
use crate::fit::{CurveOptions, interpolate};
use crate::knots::KnotVector;
use crate::parameters::Parameters;
use crate::points::PointsView;

/// The row sums in the order of the data points, and their residual relative to 1.
pub(super) fn row_sums(
    parameters: &Parameters,
    knots: &KnotVector,
    layout: ControlLayout,
) -> Result<(Vec<f64>, f64), Error> {
    let count = parameters.values().len();
    let (parameters, knots) = match parameters.period() {
        Some(period) if !count.is_multiple_of(2) => {
            let twice = |values: &[f64]| -> Vec<f64> {
                let next = values[values.len() - count..].iter().map(|t| t + period);
                values.iter().copied().chain(next).collect()
            };
            let t = Parameters::closed(twice(parameters.values()), 2.0 * period)?;
            (t, KnotVector::periodic(knots.degree(), twice(knots.values()))?)
        }
        _ => (parameters.clone(), knots.clone()),
    };
    let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    let signs: Vec<f64> = (0..parameters.values().len()).map(sign).collect();
    let options = CurveOptions { degree: knots.degree(), ..CurveOptions::default() };
    let fit = interpolate(PointsView::new(1, &signs)?, parameters, knots, &options)?;
    let mut sums = layout.collect(fit.curve.control_points().coordinates(), 1);
    sums.truncate(count);
    sums.iter_mut().for_each(|sum| *sum = sum.abs());
    Ok((sums, fit.report.run.max_residual))
}
