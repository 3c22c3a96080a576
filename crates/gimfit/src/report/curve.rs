//! The account of a curve fit.

use super::{ApproximationReport, RunReport, ShapeReport};

/// The account of a curve fit. Lengths are in the unit of the data; indices count the points
/// fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveReport {
    /// Data points fitted, after duplicates and a repeated closing point were taken out.
    pub points: usize,
    /// Control points stored.
    pub control_points: usize,
    /// Degree.
    pub degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the curve closes.
    pub closed: bool,
    /// How parameters were assigned.
    pub parameterization: &'static str,
    /// How knots were placed.
    pub knot_placement: &'static str,
    /// Longest step of the parameters over the shortest.
    pub spacing_ratio: f64,
    /// The shape kept, where one was to be.
    pub shape: Option<ShapeReport>,
    /// The run.
    pub run: RunReport,
    /// What an approximation achieved; `None` for interpolation.
    pub approximation: Option<ApproximationReport>,
    /// The point with the largest residual.
    pub max_residual_index: usize,
    /// Largest distance of a data point from its foot point on the curve.
    pub max_deviation: f64,
    /// The point where it is met.
    pub max_deviation_index: usize,
}

impl CurveReport {
    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.run.converged()
    }
}
