//! The recipes: from points to a curve and a report. The only room that knows all others.

mod curve;
mod keep;
mod method;
mod options;
mod prepare;

pub use curve::{CurveFit, KeptFit, fit_curve, fit_curve_observed, interpolate};
pub use options::{CurveOptions, IterationWeight, Method};
