//! What happened, in numbers that can be checked.

mod curve;
mod surface;

pub use curve::CurveReport;
pub use surface::SurfaceReport;
