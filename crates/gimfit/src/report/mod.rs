//! What happened, in numbers that can be checked.

mod approximation;
mod curve;
mod run;
mod shape;
mod surface;
mod triangle;

pub use approximation::ApproximationReport;
pub use curve::CurveReport;
pub use run::{FootPointReport, LeastSquaresReport, LocalReport, RunReport};
pub use shape::ShapeReport;
pub use surface::SurfaceReport;
pub use triangle::TriangleReport;
