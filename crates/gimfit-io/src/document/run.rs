//! What every report of a fit holds, whatever its geometry.

use gimfit::{FootPointReport, RunReport};
use serde::{Deserialize, Serialize};

/// Residuals after an iteration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HistoryRow {
    /// Steps taken before.
    pub iteration: usize,
    /// Largest norm of a difference vector; null where a diverging run left the range of doubles.
    #[serde(with = "number_or_null")]
    pub max_residual: f64,
    /// Root mean square of the norms; null likewise.
    #[serde(with = "number_or_null")]
    pub rms_residual: f64,
    /// Of least squares: the largest mean difference vector of a control point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal_residual: Option<f64>,
}

impl HistoryRow {
    /// Takes an entry over.
    #[must_use]
    pub fn of(entry: &gimfit::HistoryEntry) -> Self {
        Self {
            iteration: entry.iteration,
            max_residual: entry.max_residual,
            rms_residual: entry.rms_residual,
            normal_residual: entry.normal_residual.filter(|x| x.is_finite()),
        }
    }
}

/// Measured times.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Seconds {
    /// Reading the points.
    pub read: f64,
    /// Fitting.
    pub fit: f64,
    /// Writing the files before this document; null in a document written before it was known.
    pub write: Option<f64>,
}

/// How the foot points of geometric interpolation fared.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FootPointData {
    /// How far the parameter of a data point ended from the one assigned to it, at most.
    pub largest_move: f64,
    /// Where they were given up for parameters that stay; null if they were not.
    pub fall_back: Option<FallBackData>,
}

/// Where foot points were given up, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FallBackData {
    /// The iteration whose foot points could not be used.
    pub iteration: usize,
    /// `order`, `schoenberg-whitney`, `eigenvalue` or `growth`.
    pub condition: String,
    /// The same as a sentence.
    pub reason: String,
}

impl FootPointData {
    fn of(report: &FootPointReport) -> Self {
        Self {
            largest_move: report.largest_move,
            fall_back: report.fall_back.map(|fall_back| FallBackData {
                iteration: fall_back.iteration,
                condition: fall_back.reason.as_str().into(),
                reason: fall_back.reason.to_string(),
            }),
        }
    }
}

/// Moves of single control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct MovesData {
    /// Moves made.
    pub made: usize,
    /// Moves that plain PIA would have made on top in as many steps.
    pub saved: usize,
}

/// What local PIA left aside.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LocalData {
    /// Points that took part.
    pub points: usize,
    /// Largest norm of a difference vector of all others.
    pub outside_max_residual: f64,
    /// The point where it is met, counted from 0 among those fitted.
    pub outside_max_residual_index: usize,
}

/// How far a least squares fit is from its limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LeastSquaresData {
    /// Largest mean difference vector of a control point, weighted by how much it takes part: 0 at the
    /// limit.
    pub normal_residual: f64,
    /// Control points that no data point meets.
    pub unmet_control_points: usize,
}

/// The account of a run. Lengths are in the unit of the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunData {
    /// The rule that ran.
    pub method: String,
    /// Sentences on what was chosen, and why.
    pub choices: Vec<String>,
    /// Steps run.
    pub iterations: usize,
    /// Steps behind the fit returned.
    pub iteration_returned: usize,
    /// `residual`, `iterations`, `stalled`, `constrained`, `diverged` or `cancelled`.
    pub termination: String,
    /// The residual aimed at.
    pub residual_target: f64,
    /// Diagonal of the data's bounding box.
    pub extent: f64,
    /// Largest norm of a difference vector, of the points that took part.
    pub max_residual: f64,
    /// Root mean square of the norms, of the same points.
    pub rms_residual: f64,
    /// Smallest eigenvalue of the collocation operator, where it was needed; of geometric interpolation
    /// the smallest met up to the fit returned.
    pub smallest_eigenvalue: Option<f64>,
    /// How the foot points of geometric interpolation fared; absent for other methods.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_points: Option<FootPointData>,
    /// Moves of control points made and saved, where the method saves any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub moves: Option<MovesData>,
    /// The points that took part, where not all did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub local: Option<LocalData>,
    /// How far a least squares fit is from its limit; absent for interpolation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub least_squares: Option<LeastSquaresData>,
    /// Measured times.
    #[serde(default)]
    pub seconds: Option<Seconds>,
    /// Residuals step by step.
    pub history: Vec<HistoryRow>,
}

impl RunData {
    /// Takes a report over.
    #[must_use]
    pub fn of(run: &RunReport) -> Self {
        Self {
            method: run.method.into(),
            choices: run.choices.clone(),
            iterations: run.iterations,
            iteration_returned: run.iteration_returned,
            termination: run.termination.as_str().into(),
            residual_target: run.residual_target,
            extent: run.extent,
            max_residual: run.max_residual,
            rms_residual: run.rms_residual,
            smallest_eigenvalue: run.smallest_eigenvalue,
            foot_points: run.foot_points.as_ref().map(FootPointData::of),
            moves: run.updates.map(|moves| MovesData { made: moves.done, saved: moves.saved }),
            local: run.local.as_ref().map(|local| LocalData {
                points: local.chosen.len(),
                outside_max_residual: local.outside_max_residual,
                outside_max_residual_index: local.outside_max_residual_index,
            }),
            least_squares: run.least_squares.map(|account| LeastSquaresData {
                normal_residual: account.normal_residual,
                unmet_control_points: account.unmet_control_points,
            }),
            seconds: None,
            history: run.history.iter().map(HistoryRow::of).collect(),
        }
    }
}

/// JSON has no infinities; the residuals of a run that diverged become null.
pub(super) mod number_or_null {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref)]
    pub(in super::super) fn serialize<S: Serializer>(
        value: &f64,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        value.is_finite().then_some(*value).serialize(serializer)
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<f64, D::Error> {
        Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
    }
}
