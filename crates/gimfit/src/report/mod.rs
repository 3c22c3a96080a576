//! What happened, in numbers that can be checked.

mod curve;
mod run;
mod surface;

pub use curve::CurveReport;
pub use run::RunReport;
pub use surface::SurfaceReport;
