//! Knot vectors: checked once, then trusted; and the rules that place them.

mod placement;
mod vector;

pub(crate) use placement::mean as averaged_knot;
pub use placement::{KnotPlacement, place_knots};
pub(crate) use vector::check_degree;
pub use vector::{Boundary, KnotVector, MAX_DEGREE};
