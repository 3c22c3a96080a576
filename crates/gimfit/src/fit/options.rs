//! What a caller chooses.

use crate::knots::KnotPlacement;
use crate::parameters::Parameterization;
use crate::points::Duplicates;
use std::ops::Range;

/// The rule that moves the control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Method {
    /// Reaches rounding level quickly on any spacing: [`Method::Preconditioned`] with the whole
    /// band; after plain PIA for as many steps as there are fits to keep.
    #[default]
    Auto,
    /// Plain PIA (Lin, Bao and Wang 2005).
    Pia,
    /// Weighted PIA (Lu 2010; per point: Chen, Wang and Jin 2012).
    Weighted,
    /// Jacobi-PIA (Liu and Deng 2015).
    Jacobi,
    /// Gauss-Seidel PIA (Wang, Li and Deng 2018).
    GaussSeidel,
    /// Successive over-relaxation.
    Sor,
    /// Chebyshev semi-iterative PIA (Liu, Han and Li 2017).
    Chebyshev,
    /// Anderson-accelerated PIA (Anderson 1965).
    Anderson {
        /// Steps remembered, from 1; `None`: 10, or the number of points if that is less; on dense
        /// matrices 40, or twice the number of points.
        memory: Option<usize>,
    },
    /// Preconditioned PIA (Liu and Liu 2020) with a half bandwidth, or the whole band.
    Preconditioned {
        /// Entries farther from the diagonal are added to it; `None` keeps all.
        half_bandwidth: Option<usize>,
    },
    /// Local PIA (Lin 2010): plain PIA of the points that the options choose, of curves and grids.
    Local,
    /// Adaptive PIA (Lin 2012): plain PIA that freezes points once they are met.
    Adaptive,
    /// Geometric interpolation (Maekawa, Matsumoto and Namiki 2007; Lin 2010): the steps of plain
    /// PIA from the foot points of the data in place of fixed parameters.
    Geometric {
        /// Whether the first foot points are the nearest of the whole curve or surface; otherwise
        /// they are looked for from the parameters assigned.
        global_start: bool,
    },
}

/// Weight of the difference vectors, for the methods that have one.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum IterationWeight {
    /// The best one, from the spectrum.
    #[default]
    Auto,
    /// The same for all points, in (0, 2).
    Same(f64),
    /// That of Chen, Wang and Jin (2012), Lemma 2, with which weighted PIA converges whenever all
    /// eigenvalues, complex ones included, have positive real parts; [`Method::Weighted`] only.
    Lemma2,
    /// One per point, each in (0, 2); [`Method::Weighted`] only.
    PerPoint(Vec<f64>),
}

/// How a planar control polygon keeps the turns of the data polygon, one by one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub enum Convexity {
    /// The interpolant where it turns as the data do, over more knots if its control polygon needs
    /// them; otherwise the closest fit that does, in the sense of least squares.
    #[default]
    Closest,
    /// Algorithm 1 of Lin, Wang and Dong (2004) around the steps of the method: plain PIA where that
    /// is [`Method::Auto`]. It may stall far from the data.
    Published {
        /// The paper's D, a length in the unit of the data: the bisection for the longest step ends
        /// when no control point would move farther than that. `None`: 1e-12 of the extent, or what
        /// rounding of the coordinates allows if that is more.
        threshold: Option<f64>,
    },
}

/// What a caller chooses for [`fit_curve`](super::fit_curve); the defaults interpolate by a cubic.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveOptions {
    /// Degree, from 1.
    pub degree: usize,
    /// Whether the curve returns smoothly to its first point, which may be repeated at the end or
    /// not.
    pub closed: bool,
    /// How parameters are assigned; `None`: chord length, uniform for values of dimension 1.
    pub parameterization: Option<Parameterization>,
    /// How knots are placed; `None`: averaged, uniform for the chord-ratio parameterization.
    pub knot_placement: Option<KnotPlacement>,
    /// Whether, and how, the control polygon keeps the turns of the data polygon; planar curves
    /// only.
    pub convexity: Option<Convexity>,
    /// Positive weights of the control points, one per data point, which make the curve rational;
    /// only their ratios count. Those of points that are left out go with them.
    pub rational_weights: Option<Vec<f64>>,
    /// The rule that moves the control points.
    pub method: Method,
    /// Its weight.
    pub weight: IterationWeight,
    /// Of [`Method::Geometric`]: the smallest eigenvalue of the collocation matrix with which foot
    /// points go on, the alpha of Lin (2010), theorem 1, in (0, 1). `None`:
    /// [`SMALLEST_EIGENVALUE`](crate::projection::SMALLEST_EIGENVALUE), or a tenth of the eigenvalue at
    /// the parameters assigned where that is less.
    pub least_eigenvalue: Option<f64>,
    /// Positions, in the array given, of the points whose control points move, in any order; `None`:
    /// all. The method then runs on the matrix of these points, and residual and stopping count them
    /// alone. A repetition that is dropped stands for the point it repeats. Not with
    /// [`CurveOptions::convexity`].
    pub local: Option<Vec<usize>>,
    /// Most steps.
    pub iterations: usize,
    /// Largest residual to be reached, in the unit of the data. `None`: 1e-12 of the extent, or
    /// what rounding of the coordinates allows if that is more. 0: run all `iterations`.
    pub residual: Option<f64>,
    /// What to do with repeated points.
    pub duplicates: Duplicates,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl Default for CurveOptions {
    fn default() -> Self {
        Self {
            degree: 3,
            closed: false,
            parameterization: None,
            knot_placement: None,
            convexity: None,
            rational_weights: None,
            method: Method::Auto,
            weight: IterationWeight::Auto,
            least_eigenvalue: None,
            local: None,
            iterations: 1000,
            residual: None,
            duplicates: Duplicates::Error,
            keep: Vec::new(),
        }
    }
}

/// Weight of the difference vectors of a grid, for the methods that have one.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceWeight {
    /// One choice for both directions; one per point, row by row, where both run at once.
    Both(IterationWeight),
    /// One choice for u and one for v, where one runs after the other: per point means one per row
    /// in u, one per column in v.
    PerDirection([IterationWeight; 2]),
}

impl Default for SurfaceWeight {
    fn default() -> Self {
        Self::Both(IterationWeight::Auto)
    }
}

impl From<IterationWeight> for SurfaceWeight {
    fn from(weight: IterationWeight) -> Self {
        Self::Both(weight)
    }
}

/// What a caller chooses for [`fit_blending_curve`](super::fit_blending_curve); the basis gives the
/// degree.
#[derive(Debug, Clone, PartialEq)]
pub struct BlendingOptions {
    /// How parameters are assigned; `None`: uniform. They are brought onto the domain of the basis,
    /// unless given ones lie in it.
    pub parameterization: Option<Parameterization>,
    /// The rule that moves the control points.
    pub method: Method,
    /// Its weight.
    pub weight: IterationWeight,
    /// Most steps.
    pub iterations: usize,
    /// Largest residual to be reached, as in [`CurveOptions::residual`].
    pub residual: Option<f64>,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl Default for BlendingOptions {
    fn default() -> Self {
        Self {
            parameterization: None,
            method: Method::Auto,
            weight: IterationWeight::Auto,
            iterations: 1000,
            residual: None,
            keep: Vec::new(),
        }
    }
}

/// What a caller chooses for [`fit_blending_surface`](super::fit_blending_surface). Pairs hold
/// direction u (rows), then direction v (columns).
#[derive(Debug, Clone, PartialEq)]
pub struct BlendingSurfaceOptions {
    /// How parameters are assigned, as in [`BlendingOptions::parameterization`].
    pub parameterizations: [Option<Parameterization>; 2],
    /// The rule that moves the control points.
    pub method: Method,
    /// Its weight.
    pub weight: SurfaceWeight,
    /// Whether the columns are run to their limit first, then the rows.
    pub per_direction: bool,
    /// Most steps; per direction, in each.
    pub iterations: usize,
    /// Largest residual to be reached, as in [`CurveOptions::residual`].
    pub residual: Option<f64>,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl Default for BlendingSurfaceOptions {
    fn default() -> Self {
        Self {
            parameterizations: [None, None],
            method: Method::Auto,
            weight: SurfaceWeight::default(),
            per_direction: false,
            iterations: 1000,
            residual: None,
            keep: Vec::new(),
        }
    }
}

/// What a caller chooses for [`fit_triangular_patch`](super::fit_triangular_patch).
#[derive(Debug, Clone, PartialEq)]
pub struct TriangleOptions {
    /// The rule that moves the control points.
    pub method: Method,
    /// Its weight.
    pub weight: IterationWeight,
    /// Most steps.
    pub iterations: usize,
    /// Largest residual to be reached, as in [`CurveOptions::residual`].
    pub residual: Option<f64>,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl Default for TriangleOptions {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            weight: IterationWeight::Auto,
            iterations: 1000,
            residual: None,
            keep: Vec::new(),
        }
    }
}

/// What a caller chooses for [`fit_surface`](super::fit_surface); the defaults interpolate by a
/// bicubic. Pairs hold direction u (rows), then direction v (columns).
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceOptions {
    /// Degrees, from 1.
    pub degrees: [usize; 2],
    /// Whether the surface returns smoothly to its first row, its first column.
    pub closed: [bool; 2],
    /// How parameters are assigned; `None`: chord lengths averaged over the grid, uniform for
    /// heights of dimension 1.
    pub parameterizations: [Option<Parameterization>; 2],
    /// How knots are placed; `None`: averaged.
    pub knot_placements: [Option<KnotPlacement>; 2],
    /// Positive weights of the control points, one per data point, row by row, which make the
    /// surface rational, as in [`CurveOptions::rational_weights`].
    pub rational_weights: Option<Vec<f64>>,
    /// The rule that moves the control points.
    pub method: Method,
    /// Its weight.
    pub weight: SurfaceWeight,
    /// As [`CurveOptions::least_eigenvalue`].
    pub least_eigenvalue: Option<f64>,
    /// Windows of the points whose control points move, rows and columns of the grid given, counted
    /// from 0; `None`: all. Their union moves, as in [`CurveOptions::local`]. Where it is all crossings
    /// of some rows with some columns, every method goes with it but geometric interpolation; of other
    /// unions only those that need no factored matrix.
    pub local: Option<Vec<[Range<usize>; 2]>>,
    /// Whether the columns are run to their limit first, then the rows.
    pub per_direction: bool,
    /// Most steps; per direction, in each.
    pub iterations: usize,
    /// Largest residual to be reached, as in [`CurveOptions::residual`].
    pub residual: Option<f64>,
    /// Iterations whose fits are kept.
    pub keep: Vec<usize>,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self {
            degrees: [3, 3],
            closed: [false, false],
            parameterizations: [None, None],
            knot_placements: [None, None],
            rational_weights: None,
            method: Method::Auto,
            weight: SurfaceWeight::default(),
            least_eigenvalue: None,
            local: None,
            per_direction: false,
            iterations: 1000,
            residual: None,
            keep: Vec::new(),
        }
    }
}
