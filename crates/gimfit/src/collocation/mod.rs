//! The collocation operator: rows of few weights, built once and applied many times.

mod band_kernel;
mod banded;
mod bordered;
mod build;
mod factor;
mod folded;
mod grid;
pub(crate) mod kernel;
mod layout;
mod spectrum;

pub use banded::BandedCollocation;
pub(crate) use build::wrap;
pub use build::{Interpolation, interpolation};
pub use factor::BandFactors;
pub use grid::{AcrossCollocation, AlongCollocation, TensorCollocation};
pub use layout::{ControlLayout, NetLayout};
pub use spectrum::{EigenvalueBounds, gauss_seidel_rate, smallest_eigenvalue};

/// What an iteration needs of `A = [B_i(t_j)]`, whatever the geometry behind it. Vectors are flat
/// arrays of shape (points, dimension) and (control points, dimension), row-major.
pub trait CollocationOperator: std::fmt::Debug {
    /// Rows: data points.
    fn points(&self) -> usize;

    /// Columns: control points that move.
    fn control_points(&self) -> usize;

    /// Writes `A x` into `result`.
    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]);

    /// Writes the difference vectors `Q - A P` and returns their norms.
    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms;
}

/// Norms of the difference vectors.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ResidualNorms {
    /// Largest Euclidean norm of a difference vector.
    pub max: f64,
    /// The point where it is met, from 0.
    pub max_index: usize,
    /// Root of the mean squared norm.
    pub rms: f64,
}

impl ResidualNorms {
    /// Whether every difference vector was a number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.max.is_finite() && self.rms.is_finite()
    }
}
