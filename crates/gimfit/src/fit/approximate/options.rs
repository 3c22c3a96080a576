//! What a caller chooses for an approximation.

/// What the curve is to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Goal {
    /// No data point farther from the curve than this, with as few control points as can be found.
    Tolerance(f64),
    /// The root of the mean squared distance no larger than this, likewise.
    Rms(f64),
    /// As smooth as noise of this standard deviation in every coordinate lets the data be, with as
    /// few control points as can be found; `None`: the noise is estimated.
    Noise(Option<f64>),
    /// As close as can be with this many control points; a closed curve's repeated ones not counted.
    ControlPoints(usize),
}

/// Points where the curve may turn at once.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Corners {
    /// Those that the data show at the scale of the tolerance.
    #[default]
    Auto,
    /// None: the curve is smooth everywhere.
    None,
    /// As [`Corners::Auto`], with the smallest turn given in degrees.
    Angle(f64),
}

/// By which weights outliers are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Robust {
    /// Weights fall as distances grow (Huber 1964).
    Huber,
    /// Weights fall to nothing (Beaton and Tukey 1974).
    Tukey,
}

/// What a caller chooses for [`approximate_curve`](super::approximate_curve).
#[derive(Debug, Clone, PartialEq)]
pub struct ApproximationOptions {
    /// What is to be reached.
    pub goal: Goal,
    /// Degree, from 1.
    pub degree: usize,
    /// Whether the curve returns smoothly to its first point, which may be repeated at the end.
    pub closed: bool,
    /// Where the points are values over an abscissa, such as a signal over time: that of each point, in
    /// order, repeated ones allowed. They are the parameters of the curve, distances are those of the
    /// values at the same abscissa, and there are no corners. `None`: points of a curve; of values of
    /// dimension 1, which have no chords, the abscissa is their number.
    pub abscissae: Option<Vec<f64>>,
    /// Corners that stay sharp.
    pub corners: Corners,
    /// Whether an open curve starts at the first point and ends at the last.
    pub hold_ends: bool,
    /// Whether outliers are looked for, to be left out of the fit and named in the report.
    pub robust: Option<Robust>,
    /// Most rounds of fitting and correcting parameters; `None`: as many as take a second or two.
    pub rounds: Option<usize>,
}

impl ApproximationOptions {
    /// A cubic within a distance of all points.
    #[must_use]
    pub fn within(tolerance: f64) -> Self {
        Self::new(Goal::Tolerance(tolerance))
    }

    /// A cubic that reaches a goal.
    #[must_use]
    pub fn new(goal: Goal) -> Self {
        Self {
            goal,
            degree: 3,
            closed: false,
            abscissae: None,
            corners: Corners::Auto,
            hold_ends: false,
            robust: None,
            rounds: None,
        }
    }
}
