//! The shape of planar polygons: which way they turn at each corner.

mod guards;
mod polygon;
mod turn;

pub use polygon::Shape;
pub(crate) use polygon::point;
pub(crate) use turn::cross;
pub use turn::{Turn, turn};
