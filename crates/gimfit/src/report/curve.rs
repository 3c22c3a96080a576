//! The account of a curve fit.

use crate::iteration::{HistoryEntry, Termination};

/// The account of a curve fit. Lengths are in the unit of the data.
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
    /// The rule that ran.
    pub method: &'static str,
    /// What was chosen for the caller, and why.
    pub choices: Vec<String>,
    /// Steps run.
    pub iterations: usize,
    /// Steps behind the fit returned; fewer than `iterations` where a later step was worse.
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
    /// The point where it is met, counted among the points fitted.
    pub max_residual_index: usize,
    /// Root mean square of the norms.
    pub rms_residual: f64,
    /// Largest distance of a data point from its foot point on the curve.
    pub max_deviation: f64,
    /// The point where it is met, counted among the points fitted.
    pub max_deviation_index: usize,
    /// Smallest eigenvalue of the collocation matrix, where the method asked for it.
    pub smallest_eigenvalue: Option<f64>,
    /// Longest chord over the shortest.
    pub spacing_ratio: f64,
    /// Residuals step by step.
    pub history: Vec<HistoryEntry>,
}

impl CurveReport {
    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.termination == Termination::Residual
    }
}
