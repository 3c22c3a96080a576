//! What a fit yields: a B-spline curve that can be evaluated, derived and drawn.

mod curve;

pub use curve::Curve;
