//! The account of a fit of a triangular patch.

use super::RunReport;

/// The account of a fit of a triangular patch. Lengths are in the unit of the data; indices count
/// the points, in rows of the triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleReport {
    /// Data points, as many as control points.
    pub points: usize,
    /// Degree.
    pub degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// The run.
    pub run: RunReport,
    /// The point with the largest residual.
    pub max_residual_index: usize,
    /// Largest distance of a data point from its foot point on the patch.
    pub max_deviation: f64,
    /// The point where it is met.
    pub max_deviation_index: usize,
}

impl TriangleReport {
    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.run.converged()
    }
}
