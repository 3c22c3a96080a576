//! Blending functions: the B-spline basis and its derivatives.

mod kernel;

pub(crate) use kernel::{basis_derivatives, basis_functions};
