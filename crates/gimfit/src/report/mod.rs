//! What happened, in numbers that can be checked.

mod curve;
mod run;
mod shape;
mod surface;

pub use curve::CurveReport;
pub use run::RunReport;
pub use shape::ShapeReport;
pub use surface::SurfaceReport;
