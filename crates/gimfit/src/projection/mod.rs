//! Foot points: the nearest points of a curve or surface, near known parameters or anywhere.

mod bernstein;
mod boxes;
mod correction;
mod curve;
mod fall_back;
mod geometric;
mod geometric_surface;
mod global_curve;
mod global_surface;
mod patch;
mod pieces;
mod query;
mod surface;
mod surface_correction;
mod triangle;

pub(crate) use correction::MovingCurve;
pub use curve::{FootPoint, largest_deviation, local_foot_point};
pub use fall_back::{FallBack, FallBackReason, SMALLEST_EIGENVALUE};
pub use geometric::FootPointCollocation;
pub use geometric_surface::SurfaceFootPointCollocation;
pub use global_curve::CurveProjector;
pub use global_surface::SurfaceProjector;
pub use surface::{
    SurfaceFootPoint, largest_surface_deviation, largest_surface_deviation_from,
    local_surface_foot_point,
};
pub(crate) use surface_correction::MovingSurface;
pub use triangle::{largest_triangle_deviation, local_triangle_distance};
