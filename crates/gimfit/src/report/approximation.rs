//! The account of an approximation: how close, how calm, with how many control points.

/// What a fit with fewer control points than data points achieved. Lengths are in the unit of the
/// data; distances are true ones, from foot points.
#[derive(Debug, Clone, PartialEq)]
pub struct ApproximationReport {
    /// Whether the goal was met; true where no distance was demanded.
    pub met: bool,
    /// Largest distance of a data point from the curve.
    pub max_distance: f64,
    /// Root of the mean squared distance.
    pub rms_distance: f64,
    /// Mean distance.
    pub mean_distance: f64,
    /// The largest distances: positions among the points fitted, farthest first.
    pub worst: Vec<usize>,
    /// How far the curve strays from the polyline through the data.
    pub overshoot: f64,
    /// How far it may stray and still be calm: 1.05 times the distance allowed, and 1.5 times what a
    /// local interpolant of the same points strays.
    pub calm_limit: f64,
    /// Standard deviation of the noise in a coordinate, given or estimated, where the goal is to leave
    /// it out.
    pub noise: Option<f64>,
    /// Positions of the outliers among the points given: they are not fitted, and no figure here counts
    /// them.
    pub outliers: Vec<usize>,
    /// Positions of the corners kept sharp, among the points fitted.
    pub corners: Vec<usize>,
    /// Polynomial pieces.
    pub pieces: usize,
    /// Rounds of fitting and correcting parameters, over all attempts; a round over more than 65536
    /// points counts once per 65536.
    pub rounds: usize,
}

impl ApproximationReport {
    /// Whether the curve strays no farther between the points than is calm.
    #[must_use]
    pub fn is_calm(&self) -> bool {
        self.overshoot <= self.calm_limit
    }
}
