//! The collocation operator: rows of few weights, built once and applied many times.

mod band_kernel;
mod banded;
mod bordered;
mod build;
mod chosen;
mod constrained;
mod dense;
mod dense_factor;
// Fairing and surfaces over clouds come next.
#[allow(dead_code)]
mod energy;
mod factor;
mod folded;
mod grid;
pub(crate) mod kernel;
mod layout;
mod least_squares;
mod local;
mod net_least_squares;
mod net_rows;
mod normal;
mod normal_kernel;
mod rational_net;
mod scattered;
mod spectrum;
mod symmetric_band;
mod watch;
mod window;

pub use banded::BandedCollocation;
pub(crate) use build::wrap;
pub use build::{Interpolation, interpolation};
pub(crate) use chosen::ChosenCollocation;
pub(crate) use constrained::{ConstrainedCollocation, ConstraintRow, Metric, independent};
pub use dense::{DenseCollocation, MAX_DENSE_POINTS};
#[allow(unused_imports)]
pub(crate) use energy::EnergyBand;
pub use factor::Factorization;
pub use grid::{AcrossCollocation, AlongCollocation, TensorCollocation};
pub use layout::{ControlLayout, NetLayout};
pub(crate) use least_squares::DataRows;
pub(crate) use local::HeldCollocation;
pub use local::LocalCollocation;
pub(crate) use net_least_squares::{NetPreconditioner, WeightedPart, solve_weighted};
pub(crate) use net_rows::NetRows;
pub use normal::{LeastSquaresCollocation, NormalMatrix};
pub use rational_net::{NetWeights, RationalTensorCollocation};
pub(crate) use scattered::ScatteredCollocation;
pub use spectrum::{
    Eigenvalue, EigenvalueBounds, all_eigenvalues, best_weight, eigenvalues, gauss_seidel_rate,
    largest_jacobi_eigenvalue, lemma2_weight, rate_with_weight, smallest_eigenvalue,
    smallest_eigenvalue_of,
};
pub(crate) use watch::EigenvalueWatch;
pub(crate) use window::{LocalKnots, WindowCollocation, surroundings};

/// What an iteration needs of `A = [B_i(t_j)]`, whatever the geometry behind it. Vectors are flat
/// arrays of shape (points, dimension) and (control points, dimension), row-major.
pub trait CollocationOperator: std::fmt::Debug {
    /// Rows: data points.
    fn points(&self) -> usize;

    /// Columns: control points that move.
    fn control_points(&self) -> usize;

    /// Writes `A x` into `result`.
    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]);

    /// Writes the difference vectors `Q - A P` and returns their norms. Where there are more data
    /// points than control points, what is written are the difference vectors gathered at the control
    /// points, such as `A^T (Q - A P)`; the norms are those at the data still.
    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms;

    /// The rows of a band, where that is all there is: grids meet them faster.
    fn as_band(&self) -> Option<&BandedCollocation> {
        None
    }

    /// Forgets the calls made before, ahead of a run or its repetition. Only an operator whose rows
    /// move has anything to forget.
    fn reset(&self) {}
}

/// A square collocation matrix whose entries can be had: what rules beyond plain weights ask for.
pub trait CollocationMatrix: CollocationOperator {
    /// Calls `visit` with the column and the weight of each entry of row `j` that may not be zero.
    fn visit_row(&self, j: usize, visit: &mut dyn FnMut(usize, f64));

    /// The diagonal entry of row `j`.
    fn diagonal(&self, j: usize) -> f64 {
        let mut entry = 0.0;
        self.visit_row(j, &mut |column, weight| {
            if column == j {
                entry += weight;
            }
        });
        entry
    }

    /// Solves `(D / omega + L) y = r` in place, where D is the diagonal and L what stands left of
    /// it, for vectors of shape (points, dimension).
    fn sweep(&self, omega: f64, vectors: &mut [f64], dimension: usize);

    /// Factors the matrix, or its diagonally compensated reduction to a half bandwidth: entries
    /// farther from the diagonal are added to the diagonal of their row, so that rows sum to 1
    /// still (Liu and Liu 2020).
    ///
    /// # Errors
    /// [`Error::Singular`](crate::Error::Singular) if that is singular in doubles.
    fn factor(&self, half_bandwidth: Option<usize>) -> Result<Factorization, crate::Error>;

    /// Factors the comparison matrix, with the absolute values of the entries, negative off the
    /// diagonal: it tells whether the matrix is generalised diagonally dominant.
    ///
    /// # Errors
    /// As [`CollocationMatrix::factor`]. The comparison matrix may be singular though the matrix is
    /// not.
    fn factor_comparison(&self) -> Result<Factorization, crate::Error>;

    /// Whether every minor is known to be nonnegative: then the eigenvalues lie in (0, 1] and PIA
    /// converges (Lin, Bao and Wang 2005).
    fn is_totally_positive(&self) -> bool;

    /// Whether every entry may differ from zero: a matrix without a band.
    fn is_dense(&self) -> bool {
        false
    }

    /// The smallest eigenvalue, where a law gives it in closed form.
    fn known_smallest_eigenvalue(&self) -> Option<f64> {
        None
    }
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
    /// Of least squares: the largest norm, over the control points, of the mean of the difference
    /// vectors that each one takes part in, weighted by how much. It is 0 at the least squares fit,
    /// where difference vectors are not.
    pub normal: Option<f64>,
}

impl ResidualNorms {
    /// What tells how far the iteration is from its limit.
    #[must_use]
    pub fn to_limit(&self) -> f64 {
        self.normal.unwrap_or(self.max)
    }

    /// Whether every difference vector was a number.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.max.is_finite() && self.rms.is_finite() && self.to_limit().is_finite()
    }
}
