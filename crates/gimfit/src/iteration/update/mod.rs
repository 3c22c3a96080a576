//! Published rules: how difference vectors become adjusting vectors. One file each.

use super::Termination;

mod adaptive;
mod anderson;
mod chebyshev;
mod closest;
mod conjugate_gradients;
mod convex;
mod gauss_seidel;
mod grid;
mod heavy_ball;
mod jacobi;
mod local;
mod nesterov;
mod net_preconditioned;
mod pia;
mod preconditioned;
mod random_columns;
mod random_rows;
mod salspia;
mod staged;
mod weighted;

pub use adaptive::{Adaptive, AdaptiveRows};
pub use anderson::Anderson;
pub use chebyshev::Chebyshev;
pub use closest::ClosestConvex;
pub use conjugate_gradients::{ConjugateGradients, Preconditioner};
pub use convex::ConvexityPreserving;
pub use gauss_seidel::{GaussSeidel, Sor};
pub use grid::{Across, Along, Both, Rescaled};
pub use heavy_ball::HeavyBall;
pub use jacobi::Jacobi;
pub use local::Local;
pub use nesterov::Nesterov;
pub use net_preconditioned::NetPreconditioned;
pub use pia::Pia;
pub use preconditioned::Preconditioned;
pub use random_columns::RandomColumns;
pub use random_rows::RandomRows;
pub use salspia::SaLspia;
pub use staged::Staged;
pub use weighted::{PerPoint, Scaled, Weighted};

/// Where a run stands when a step is taken.
#[derive(Debug, Clone, Copy)]
pub struct Step<'a> {
    /// Steps taken before.
    pub iteration: usize,
    /// The control points that are to move, shape (points, dimension).
    pub control: &'a [f64],
    /// Coordinates per point.
    pub dimension: usize,
}

/// Moves of single control points, for rules that do not move all of them in every step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct UpdateCounts {
    /// Moves made.
    pub done: usize,
    /// Moves that plain PIA would have made on top in as many steps.
    pub saved: usize,
}

/// Turns difference vectors, one per control point, into adjusting vectors. Of an interpolation they
/// are those of the data points; of least squares those that the operator has gathered.
pub trait UpdateRule: std::fmt::Debug {
    /// Works in place on vectors of shape (points, dimension). Allocates nothing after its first
    /// call.
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]);

    /// Whether the last step moved nothing that mattered, and none after it would: a rule that
    /// guards a shape may find no way on. The run then ends
    /// [`Stalled`](crate::Termination::Stalled).
    fn is_stuck(&self) -> bool {
        false
    }

    /// Why the run must end after the last step, if it must. A rule that moves within limits knows
    /// when it has come as close as they let it: [`Constrained`](Termination::Constrained).
    fn ending(&self) -> Option<Termination> {
        self.is_stuck().then_some(Termination::Stalled)
    }

    /// Whether the rule tells by [`UpdateRule::ending`] when it gets no further, so that a largest
    /// residual that no longer falls is no reason to stop: that of a closest fit may rise.
    fn ends_itself(&self) -> bool {
        false
    }

    /// Moves made and spared since the start, where the rule spares any.
    fn updates(&self) -> Option<UpdateCounts> {
        None
    }

    /// Forgets the steps taken, before a run is repeated.
    fn reset(&mut self) {}
}

impl<R: UpdateRule + ?Sized> UpdateRule for Box<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        (**self).adjust(step, vectors);
    }

    fn is_stuck(&self) -> bool {
        (**self).is_stuck()
    }

    fn ending(&self) -> Option<Termination> {
        (**self).ending()
    }

    fn ends_itself(&self) -> bool {
        (**self).ends_itself()
    }

    fn updates(&self) -> Option<UpdateCounts> {
        (**self).updates()
    }

    fn reset(&mut self) {
        (**self).reset();
    }
}
