//! What every report of a fit holds, whatever its geometry.

use gimfit::RunReport;
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
}

impl HistoryRow {
    /// Takes an entry over.
    #[must_use]
    pub fn of(entry: &gimfit::HistoryEntry) -> Self {
        Self {
            iteration: entry.iteration,
            max_residual: entry.max_residual,
            rms_residual: entry.rms_residual,
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
    /// Largest norm of a difference vector.
    pub max_residual: f64,
    /// Root mean square of the norms.
    pub rms_residual: f64,
    /// Smallest eigenvalue of the collocation operator, where it was needed.
    pub smallest_eigenvalue: Option<f64>,
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
