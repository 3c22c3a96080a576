//! Blending functions: B-splines and their derivatives, and every other basis behind one trait.

mod ball;
mod bernstein;
mod blending;
mod dp;
mod kernel;
mod powers;
mod rational;
mod triangular;

pub use ball::{SaidBall, WangBall};
pub use bernstein::Bernstein;
pub(crate) use bernstein::factorial_over_power;
pub use blending::{BlendingBasis, MAX_BLENDING_DEGREE};
pub use dp::Dp;
pub(crate) use kernel::{basis_derivatives, basis_functions};
pub use rational::Rational;
pub(crate) use rational::check_weights;
pub(crate) use triangular::triangular_into;
