//! Published rules: how difference vectors become adjusting vectors. One file each.

mod chebyshev;
mod gauss_seidel;
mod grid;
mod jacobi;
mod pia;
mod preconditioned;
mod staged;
mod weighted;

pub use chebyshev::Chebyshev;
pub use gauss_seidel::{GaussSeidel, Sor};
pub use grid::{Across, Along, Both};
pub use jacobi::Jacobi;
pub use pia::Pia;
pub use preconditioned::Preconditioned;
pub use staged::Staged;
pub use weighted::{PerPoint, Weighted};

/// Turns difference vectors, one per data point, into adjusting vectors, one per control point.
pub trait UpdateRule: std::fmt::Debug {
    /// Works in place on vectors of shape (points, dimension); `iteration` counts the steps taken
    /// before. Allocates nothing after its first call.
    fn adjust(&mut self, iteration: usize, vectors: &mut [f64], dimension: usize);

    /// Forgets the steps taken, before a run is repeated.
    fn reset(&mut self) {}
}

impl<R: UpdateRule + ?Sized> UpdateRule for Box<R> {
    fn adjust(&mut self, iteration: usize, vectors: &mut [f64], dimension: usize) {
        (**self).adjust(iteration, vectors, dimension);
    }

    fn reset(&mut self) {
        (**self).reset();
    }
}
