//! Foot points: the nearest points of a curve or surface, looked for near known parameters.

mod curve;
mod surface;

pub use curve::{FootPoint, largest_deviation, local_foot_point};
pub use surface::{SurfaceFootPoint, largest_surface_deviation, local_surface_foot_point};
