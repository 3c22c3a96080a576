//! The shape of planar polygons: which way they turn at each corner.

mod polygon;
mod turn;

pub use polygon::Shape;
pub(crate) use polygon::point;
pub use turn::{Turn, turn};
