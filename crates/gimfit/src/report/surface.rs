//! The account of a surface fit.

use crate::iteration::{HistoryEntry, Termination};

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
    /// The rule that ran.
    pub method: &'static str,
    /// Whether it ran in one direction after the other.
    pub per_direction: bool,
    /// What was chosen for the caller, and why.
    pub choices: Vec<String>,
    /// Steps run; per direction, those of both added up.
    pub iterations: usize,
    /// Steps behind the fit returned.
    pub iteration_returned: usize,
    /// Why the run ended.
    pub termination: Termination,
    /// The residual it aimed at; where that lay below rounding and none was demanded, the level of
    /// rounding that was accepted.
    pub residual_target: f64,
    /// Diagonal of the bounding box of the data.
    pub extent: f64,
    /// Largest norm of a difference vector.
    pub max_residual: f64,
    /// Row and column where it is met.
    pub max_residual_index: [usize; 2],
    /// Root mean square of the norms.
    pub rms_residual: f64,
    /// Largest distance of a data point from its foot point on the surface.
    pub max_deviation: f64,
    /// Row and column where it is met.
    pub max_deviation_index: [usize; 2],
    /// Smallest eigenvalue of the collocation operator, where the method asked for it.
    pub smallest_eigenvalue: Option<f64>,
    /// Longest step of the parameters over the shortest.
    pub spacing_ratios: [f64; 2],
    /// Residuals step by step; per direction, of the start and the end.
    pub history: Vec<HistoryEntry>,
}

impl SurfaceReport {
    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.termination == Termination::Residual
    }
}
