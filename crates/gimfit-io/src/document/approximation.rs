//! What an approximation achieved, in documents.

use gimfit::ApproximationReport;
use serde::{Deserialize, Serialize};

/// The account of an approximation. Lengths are in the unit of the data; indices count the points
/// fitted, from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ApproximationData {
    /// Whether the goal was met.
    pub met: bool,
    /// Largest true distance of a data point from the curve.
    pub max_distance: f64,
    /// Root mean square of the distances.
    pub rms_distance: f64,
    /// Their mean.
    pub mean_distance: f64,
    /// The points farthest off, farthest first.
    pub worst: Vec<usize>,
    /// How far the curve strays from the polyline through the data.
    pub overshoot: f64,
    /// How far it may stray and be calm.
    pub calm_limit: f64,
    /// Standard deviation of the noise that was left out, in a coordinate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub noise: Option<f64>,
    /// Outliers, which were left out, among the points given.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub outliers: Vec<usize>,
    /// Corners kept sharp.
    pub corners: Vec<usize>,
    /// Polynomial pieces.
    pub pieces: usize,
    /// Rounds of fitting and correcting parameters, over all attempts.
    pub rounds: usize,
}

impl ApproximationData {
    /// Takes an account over.
    #[must_use]
    pub fn of(account: &ApproximationReport) -> Self {
        Self {
            met: account.met,
            max_distance: account.max_distance,
            rms_distance: account.rms_distance,
            mean_distance: account.mean_distance,
            worst: account.worst.clone(),
            overshoot: account.overshoot,
            calm_limit: account.calm_limit,
            noise: account.noise,
            outliers: account.outliers.clone(),
            corners: account.corners.clone(),
            pieces: account.pieces,
            rounds: account.rounds,
        }
    }
}
