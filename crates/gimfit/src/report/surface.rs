//! The account of a surface fit.

use super::{ApproximationReport, RunReport};
use crate::iteration::HistoryEntry;

/// The account of a surface fit. Pairs hold direction u (rows), then direction v (columns). Lengths
/// are in the unit of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceReport {
    /// Rows and columns of points fitted, after repeated closing ones were taken out.
    pub points: [usize; 2],
    /// Rows and columns of the control net stored.
    pub control_points: [usize; 2],
    /// Degrees.
    pub degrees: [usize; 2],
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the surface closes.
    pub closed: [bool; 2],
    /// How parameters were assigned.
    pub parameterizations: [&'static str; 2],
    /// How knots were placed.
    pub knot_placements: [&'static str; 2],
    /// Longest step of the parameters over the shortest.
    pub spacing_ratios: [f64; 2],
    /// Whether the rule ran in one direction after the other.
    pub per_direction: bool,
    /// The run; per direction, the steps of both added up, and a history of the start and the end
    /// of the whole net: in between it is no fit of the grid.
    pub run: RunReport,
    /// Per direction: the residuals, step by step, of the columns as curves in u, then of the rows
    /// of what that gave as curves in v.
    pub stages: Option<[Vec<HistoryEntry>; 2]>,
    /// Row and column of the point with the largest residual.
    pub max_residual_index: [usize; 2],
    /// Largest distance of a data point from its foot point on the surface.
    pub max_deviation: f64,
    /// Row and column where it is met.
    pub max_deviation_index: [usize; 2],
    /// What an approximation achieved, with the worst points counted row by row; `None` for
    /// interpolation.
    pub approximation: Option<ApproximationReport>,
}

impl SurfaceReport {
    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.run.converged()
    }
}
