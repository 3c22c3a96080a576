//! The recipes: from points to a curve and a report. The only room that knows all others.

mod curve;
mod keep;
mod method;
mod options;
mod prepare;
mod solve;
mod surface;
mod surface_method;

pub use curve::{CurveFit, fit_curve, fit_curve_observed, interpolate};
pub use keep::KeptFit;
pub use options::{CurveOptions, IterationWeight, Method, SurfaceOptions};
pub use surface::{SurfaceFit, fit_surface, fit_surface_observed};
