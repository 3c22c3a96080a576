//! gimfit fits B-spline curves to points by **geometric iterative methods**: progressive-iterative
//! approximation (PIA) and its relatives. Control points start at the data; each step moves every
//! control point by the difference between the data and the current curve; the sequence converges
//! to the interpolating curve, and every member of it is a legal B-spline.
//!
//! ```
//! use gimfit::{CurveOptions, Method, fit_curve};
//!
//! let points = [[0.0, 0.0], [1.0, 1.5], [2.5, 2.0], [4.0, 0.5], [5.0, 1.0]];
//! let options = CurveOptions { method: Method::Pia, keep: vec![0, 2, 4], ..Default::default() };
//! let fit = fit_curve(&points, &options)?;
//! assert!(fit.report.converged() && fit.report.run.max_residual < 1e-11);
//! assert_eq!(fit.sequence.len(), 3);
//! # Ok::<(), gimfit::Error>(())
//! ```
//!
//! The rooms, in the order the data pass them; each imports only rooms above it:
//!
//! * [`error`]: what can be wrong with a request
//! * [`points`]: what we are given
//! * [`shape`]: which way planar polygons turn
//! * [`parameters`]: where each data point sits on the curve
//! * [`knots`]: knot vectors and their placement
//! * [`basis`]: blending functions
//! * [`geometry`]: curves, surfaces, triangular patches: evaluate, derive
//! * [`collocation`]: rows of few weights, built once and applied many times; their spectrum
//! * [`projection`]: foot points
//! * [`iteration`]: the one loop and the rules that run through it
//! * [`diagnosis`]: what can be told before a run
//! * [`report`]: what happened
//! * [`fit`]: the recipes
//!
//! The library opens no file, prints nothing and reads no clock.

pub mod error;
mod memory;
pub mod points;
mod threads;

pub mod shape;

pub mod parameters;

pub mod knots;

pub mod basis;

pub mod geometry;

pub mod collocation;

pub mod projection;

pub mod iteration;

pub mod diagnosis;

pub mod report;

pub mod fit;

pub use error::Error;
pub use fit::{
    ApproximationOptions, BlendingCurveFit, BlendingOptions, BlendingSurfaceFit,
    BlendingSurfaceOptions, Constraints, Convexity, Corners, CurveDiagnosis, CurveEnd, CurveFit,
    CurveOptions, EditReport, EditableCurve, EditableSurface, Goal, IterationWeight, KeptFit,
    KeptFootPoints, LeastSquaresKnots, LeastSquaresMethod, LeastSquaresOptions,
    LeastSquaresSurfaceOptions, LeastSquaresWeight, Method, Robust, SurfaceApproximationOptions,
    SurfaceEditReport, SurfaceFit, SurfaceGoal, SurfaceOptions, SurfaceWeight, TriangleFit,
    TriangleOptions, approximate_curve, approximate_curve_observed, approximate_surface,
    diagnose_blending_curve, diagnose_curve, fit_blending_curve, fit_blending_surface, fit_curve,
    fit_curve_observed, fit_least_squares, fit_least_squares_observed, fit_least_squares_surface,
    fit_surface, fit_surface_observed, fit_triangular_patch,
};
pub use fit::{SurfaceDiagnosis, diagnose_blending_surface, diagnose_surface};
pub use fit::{curve_choices, surface_choices, usual_distances};
pub use geometry::{BlendingCurve, BlendingSurface, Curve, Surface, TriangularPatch};
pub use iteration::{HistoryEntry, Termination};
pub use knots::{KnotPlacement, KnotVector};
pub use parameters::Parameterization;
pub use points::{Duplicates, GridView, PointGrid, Points, PointsView};
pub use report::{
    ApproximationReport, CurveReport, FootPointReport, LeastSquaresReport, LocalReport, RunReport,
    ShapeReport, SurfaceReport, TriangleReport,
};

/// The Rust examples of the README and of the documentation pages, run as tests.
#[cfg(doctest)]
mod pages {
    macro_rules! pages {
        ($($name:ident: $path:literal,)*) => {
            $(#[doc = include_str!(concat!("../../../", $path))] struct $name;)*
        };
    }
    pages! {
        Readme: "README.md",
        Contributing: "CONTRIBUTING.md",
        Adaptive: "docs/methods/adaptive.md",
        Anderson: "docs/methods/anderson.md",
        Approximation: "docs/methods/approximation.md",
        Auto: "docs/methods/auto.md",
        Bases: "docs/methods/bases.md",
        Chebyshev: "docs/methods/chebyshev.md",
        Closed: "docs/methods/closed.md",
        Convex: "docs/methods/convex.md",
        Diagnose: "docs/methods/diagnose.md",
        Editing: "docs/methods/editing.md",
        FootPoints: "docs/methods/foot-points.md",
        Geometric: "docs/methods/geometric.md",
        GaussSeidel: "docs/methods/gauss-seidel.md",
        Jacobi: "docs/methods/jacobi.md",
        LeastSquares: "docs/methods/least-squares.md",
        Knots: "docs/methods/knots.md",
        Local: "docs/methods/local.md",
        Lspia: "docs/methods/lspia.md",
        Nurbs: "docs/methods/nurbs.md",
        Parameters: "docs/methods/parameters.md",
        Pia: "docs/methods/pia.md",
        Preconditioned: "docs/methods/preconditioned.md",
        Stopping: "docs/methods/stopping.md",
        SurfaceApproximation: "docs/methods/surface-approximation.md",
        Surfaces: "docs/methods/surfaces.md",
        Triangular: "docs/methods/triangular.md",
        Weighted: "docs/methods/weighted.md",
    }
}
