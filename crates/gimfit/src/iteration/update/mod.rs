//! Published rules: how difference vectors become adjusting vectors. One file each.

mod anderson;
mod chebyshev;
mod gauss_seidel;
mod grid;
mod jacobi;
mod net_preconditioned;
mod pia;
mod preconditioned;
mod staged;
mod weighted;

pub use anderson::Anderson;
pub use chebyshev::Chebyshev;
pub use gauss_seidel::{GaussSeidel, Sor};
pub use grid::{Across, Along, Both};
pub use jacobi::Jacobi;
pub use net_preconditioned::NetPreconditioned;
pub use pia::Pia;
pub use preconditioned::Preconditioned;
pub use staged::Staged;
pub use weighted::{PerPoint, Weighted};

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

/// Turns difference vectors, one per data point, into adjusting vectors, one per control point.
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

    fn reset(&mut self) {
        (**self).reset();
    }
}
