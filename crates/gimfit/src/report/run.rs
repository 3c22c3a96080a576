//! The account of a run, whatever geometry it moved.

use crate::iteration::{HistoryEntry, Termination, UpdateCounts};
use crate::projection::FallBack;

/// How the foot points of geometric interpolation fared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FootPointReport {
    /// How far the parameter of a data point ended from the one assigned to it, at most.
    pub largest_move: f64,
    /// Where they were given up for parameters that stay, and why.
    pub fall_back: Option<FallBack>,
}

/// The account of a run. Lengths are in the unit of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct RunReport {
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
    /// Largest norm of a difference vector: of the points iterated, which are all but for local PIA.
    pub max_residual: f64,
    /// Root mean square of the norms, of the same points.
    pub rms_residual: f64,
    /// Smallest eigenvalue of the collocation operator, where the method asked for it; of geometric
    /// interpolation, the smallest met on the way.
    pub smallest_eigenvalue: Option<f64>,
    /// Moves of control points made and spared, where the method spares any.
    pub updates: Option<UpdateCounts>,
    /// What local PIA left aside; `None` where all points took part.
    pub local: Option<LocalReport>,
    /// How the foot points of geometric interpolation fared.
    pub foot_points: Option<FootPointReport>,
    /// How far a least squares fit is from its limit; `None` for interpolation.
    pub least_squares: Option<LeastSquaresReport>,
    /// Residuals step by step.
    pub history: Vec<HistoryEntry>,
}

/// The account of the points that local PIA left aside.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalReport {
    /// The points that took part, rising, counted from 0 among those fitted; of a grid row by row.
    pub chosen: Vec<usize>,
    /// Largest norm of a difference vector of all others.
    pub outside_max_residual: f64,
    /// The point where it is met, among those fitted.
    pub outside_max_residual_index: usize,
}

/// How far a least squares fit is from its limit, and what the data left free.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastSquaresReport {
    /// Largest norm, over the control points, of the mean of the difference vectors that a control
    /// point takes part in, weighted by how much: 0 at the limit. It is what stops the run.
    pub normal_residual: f64,
    /// Control points whose functions no data point meets: they stay where they started.
    pub unmet_control_points: usize,
}

impl RunReport {
    /// What the run stops by: the largest residual, or the normal residual of least squares.
    #[must_use]
    pub fn to_limit(&self) -> f64 {
        self.least_squares.map_or(self.max_residual, |account| account.normal_residual)
    }

    /// How much of that a step left towards the end of the run: the mean factor of the last third of
    /// the steps. `None` of fewer than three steps, or where rounding or a stop at 0 leaves no ratio.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        let last = self.history.last()?;
        let from = last.iteration - last.iteration / 3;
        let first = self.history.iter().rev().find(|entry| entry.iteration <= from)?;
        let steps = last.iteration - first.iteration;
        let ratio = last.to_limit() / first.to_limit();
        (last.iteration >= 3 && steps > 0 && ratio > 0.0 && ratio.is_finite())
            .then(|| ratio.powf((steps as f64).recip()))
    }

    /// Whether the run reached what was asked of it.
    #[must_use]
    pub fn converged(&self) -> bool {
        self.termination == Termination::Residual
    }
}
