//! What a caller chooses for the approximation of a grid.

/// What the surface is to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SurfaceGoal {
    /// No data point farther from the surface than this, with as few control points as can be found.
    Tolerance(f64),
    /// The root of the mean squared distance no larger than this, likewise.
    Rms(f64),
    /// As close as can be with this many rows and columns of control points; the repeated ones of a
    /// closed direction not counted.
    ControlPoints([usize; 2]),
}

/// What a caller chooses for [`approximate_surface`](super::approximate_surface). Pairs hold
/// direction u (rows), then v (columns).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceApproximationOptions {
    /// What is to be reached.
    pub goal: SurfaceGoal,
    /// Degrees, from 1.
    pub degrees: [usize; 2],
    /// Whether the surface returns smoothly to its first row, or column, which may be repeated at the
    /// end.
    pub closed: [bool; 2],
    /// Most rounds of fitting and correcting parameters; `None`: as many as the size of the grid
    /// allows in a second or two, and at least 150.
    pub rounds: Option<usize>,
}

impl SurfaceApproximationOptions {
    /// A bicubic surface within a distance of all points.
    #[must_use]
    pub fn within(tolerance: f64) -> Self {
        Self::new(SurfaceGoal::Tolerance(tolerance))
    }

    /// A bicubic surface that reaches a goal.
    #[must_use]
    pub fn new(goal: SurfaceGoal) -> Self {
        Self { goal, degrees: [3, 3], closed: [false; 2], rounds: None }
    }
}
