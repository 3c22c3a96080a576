//! Knot vectors: checked once, then trusted; and the rules that place them.

mod least_squares;
mod placement;
mod vector;

pub use least_squares::place_least_squares_knots;
pub use placement::{KnotPlacement, place_knots};
pub(crate) use placement::{check_period, mean as averaged_knot};
pub(crate) use vector::check_degree;
pub use vector::{Boundary, KnotVector, MAX_DEGREE};
