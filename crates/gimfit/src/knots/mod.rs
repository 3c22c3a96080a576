//! Knot vectors: checked once, then trusted; and the rules that place them.

mod placement;
mod vector;

pub use placement::{KnotPlacement, place_knots};
pub use vector::{Boundary, KnotVector, MAX_DEGREE};
