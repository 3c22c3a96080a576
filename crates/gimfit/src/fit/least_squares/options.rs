//! What a caller chooses for a least squares fit.

use crate::fit::Constraints;
use crate::parameters::Parameterization;
use crate::points::Points;

/// The knots of a least squares fit.
#[derive(Debug, Clone, PartialEq)]
pub enum LeastSquaresKnots {
    /// Placed so that every span holds about as many data points (The NURBS Book, eq. 9.69), for this
    /// many control points; a closed curve's repeated ones not counted.
    ControlPoints(usize),
    /// The caller's full knot vector, `n + p + 1` values; of a closed curve with the degree spans that
    /// repeat past both ends of the period.
    Given(Vec<f64>),
}

/// The rule of a least squares fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum LeastSquaresMethod {
    /// Conjugate gradients preconditioned by the whole band of `A^T W A`: a step or two, whatever the
    /// data; where they leave control points free, these stay as near the start as can be.
    #[default]
    Auto,
    /// LSPIA (Deng and Lin 2014): `A^T` times the difference vectors, times a weight.
    Lspia,
    /// LSPIA with one weight per control point, the reciprocal column sum.
    ColumnSums,
    /// Gauss-Seidel sweeps over the control points.
    GaussSeidel,
    /// The same, over-relaxed.
    Sor,
    /// Heavy ball, which is MLSPIA (Huang and Wang 2020).
    HeavyBall,
    /// Nesterov's acceleration, with restarts.
    Nesterov,
    /// The Chebyshev recurrence on the steps of [`LeastSquaresMethod::ColumnSums`].
    Chebyshev,
    /// SaLSPIA (Peng and Li): steps from the last two gradients.
    SaLspia,
    /// Single control points in random order (Wu and Liu 2024).
    RandomColumns,
    /// Single data points in random order (Zouzias and Freris 2013).
    RandomRows,
    /// Extended PIA (Lin and Zhang 2011): means over the data points of each control point. Its limit
    /// is near the least squares fit, not that fit.
    Extended,
    /// Conjugate gradients (CGLS).
    Cgls,
    /// Conjugate gradients preconditioned by the diagonal.
    Pcg,
}

impl LeastSquaresMethod {
    /// The name in reports and in the program.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Auto => "least-squares",
            Self::Lspia => "lspia",
            Self::ColumnSums => "column-sums",
            Self::GaussSeidel => "gs-lspia",
            Self::Sor => "sor-lspia",
            Self::HeavyBall => "mlspia",
            Self::Nesterov => "nesterov",
            Self::Chebyshev => "chebyshev-lspia",
            Self::SaLspia => "salspia",
            Self::RandomColumns => "random-columns",
            Self::RandomRows => "random-rows",
            Self::Extended => "epia",
            Self::Cgls => "cgls",
            Self::Pcg => "pcg",
        }
    }
}

/// The step of the methods that have one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum LeastSquaresWeight {
    /// The best one, from the eigenvalues.
    #[default]
    Auto,
    /// That of the publication: of [`LeastSquaresMethod::Lspia`] 2 over the largest column sum, which is
    /// close to the largest that converges and slow; of [`LeastSquaresMethod::ColumnSums`] 1; of
    /// [`LeastSquaresMethod::Nesterov`] the momentum that takes the smallest eigenvalue, without
    /// restarts.
    Published,
    /// This one: of [`LeastSquaresMethod::Lspia`] the weight itself, below 2 over the largest eigenvalue
    /// of `A^T W A`; of [`LeastSquaresMethod::ColumnSums`] and [`LeastSquaresMethod::Sor`] a factor in
    /// (0, 2).
    Same(f64),
}

/// What a caller chooses for [`fit_least_squares`](super::fit_least_squares).
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSquaresOptions {
    /// Degree, from 1.
    pub degree: usize,
    /// Whether the curve returns smoothly to its first point, which may be repeated at the end or
    /// not.
    pub closed: bool,
    /// The knots, or how many control points.
    pub knots: LeastSquaresKnots,
    /// How parameters are assigned; `None`: chord length, uniform for values of dimension 1. Points
    /// that repeat their predecessor share its parameter. Given ones may stand in any order and may
    /// repeat.
    pub parameterization: Option<Parameterization>,
    /// Weights of the data points, none negative: the squares of residuals count so often. Only their
    /// ratios matter.
    pub data_weights: Option<Vec<f64>>,
    /// Whether an open curve starts at the first data point and ends at the last: their control points
    /// are held there, and the others are fitted to the rest.
    pub hold_ends: bool,
    /// What the curve meets exactly: with the methods auto, lspia, column-sums, cgls and pcg.
    pub constraints: Constraints,
    /// Control points to start from, one per control point that moves; `None`: chosen data points.
    /// They decide where the data leave control points free.
    pub start: Option<Points>,
    /// The rule that moves the control points.
    pub method: LeastSquaresMethod,
    /// Its weight.
    pub weight: LeastSquaresWeight,
    /// What the randomised methods draw from; the same seed draws the same.
    pub seed: u64,
    /// Most steps.
    pub iterations: usize,
    /// Normal residual to be reached, in the unit of the data: the largest norm, over the control
    /// points, of the weighted mean of the difference vectors that each takes part in. `None`: 1e-12 of
    /// the extent, or what rounding of the coordinates allows if that is more. 0: run all `iterations`.
    pub residual: Option<f64>,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl LeastSquaresOptions {
    /// A cubic of this many control points.
    #[must_use]
    pub fn with_control_points(count: usize) -> Self {
        Self::new(LeastSquaresKnots::ControlPoints(count))
    }

    /// A cubic over these knots.
    #[must_use]
    pub fn new(knots: LeastSquaresKnots) -> Self {
        Self {
            degree: 3,
            closed: false,
            knots,
            parameterization: None,
            data_weights: None,
            hold_ends: false,
            constraints: Constraints::new(),
            start: None,
            method: LeastSquaresMethod::Auto,
            weight: LeastSquaresWeight::Auto,
            seed: 0,
            iterations: 1000,
            residual: None,
            keep: Vec::new(),
        }
    }
}
