//! The recipes: from points to a curve and a report. The only room that knows all others.

mod approximate;
mod approximate_surface;
mod blending;
mod blending_surface;
mod choices;
mod constraints;
mod convex;
mod curve;
mod diagnose;
mod diagnose_surface;
mod edit;
mod geometric;
mod intervals;
mod keep;
mod least_squares;
mod local;
mod local_surface;
mod member;
mod method;
mod net;
mod options;
mod prepare;
mod rational;
mod solve;
mod surface;
mod surface_method;
mod triangle;

pub use approximate::{
    ApproximationOptions, Corners, Goal, Robust, approximate_curve, approximate_curve_observed,
};
pub use approximate_surface::{
    SurfaceApproximationOptions, SurfaceGoal, approximate_surface, approximate_surface_observed,
};
pub use blending::{BlendingCurveFit, fit_blending_curve, fit_blending_curve_observed};
pub use blending_surface::{
    BlendingSurfaceFit, fit_blending_surface, fit_blending_surface_observed,
};
pub use choices::{curve_choices, surface_choices, usual_distances};
pub use constraints::{Constraints, CurveEnd};
pub use curve::{CurveFit, fit_curve, fit_curve_observed, interpolate};
pub use diagnose::{CurveDiagnosis, diagnose_blending_curve, diagnose_curve};
pub use diagnose_surface::{SurfaceDiagnosis, diagnose_blending_surface, diagnose_surface};
pub use edit::{EditReport, EditableCurve, EditableSurface, SurfaceEditReport};
pub use keep::{KeptFit, KeptFootPoints};
pub use least_squares::{
    LeastSquaresKnots, LeastSquaresMethod, LeastSquaresOptions, LeastSquaresSurfaceOptions,
    LeastSquaresWeight, fit_least_squares, fit_least_squares_observed, fit_least_squares_surface,
    least_squares,
};
pub use options::{
    BlendingOptions, BlendingSurfaceOptions, Convexity, CurveOptions, IterationWeight, Method,
    SurfaceOptions, SurfaceWeight, TriangleOptions,
};
pub use surface::{SurfaceFit, fit_surface, fit_surface_observed};
pub use triangle::{
    TriangleFit, fit_triangular_patch, fit_triangular_patch_observed, triangular_collocation,
};
