//! The JSON document of gimfit, version 1: a geometry, the parameters of the data, and the report
//! of the fit. Described for users in `docs/format.md` and `docs/gimfit-1.schema.json`.
//!
//! Numbers are written with as many digits as they need to come back bit by bit.

mod approximation;
mod blending;
mod model;
mod read;
mod rows;
mod run;
mod surface;
mod triangle;

pub use approximation::ApproximationData;
pub use blending::{BlendingData, SurfaceBlendingData};
pub use model::{CurveGeometry, Document, Geometry, ReportData, SequenceFit, ShapeData};
pub use read::{
    AnyDocument, DocumentError, is_document, parse_any_document, parse_document, read_document,
};
pub use rows::PointRows;
pub use run::{HistoryRow, LeastSquaresData, LocalData, MovesData, RunData, Seconds};
pub use surface::{
    NetFit, SurfaceDocument, SurfaceGeometry, SurfaceKind, SurfaceReportData, surface_document_of,
};

pub use triangle::{
    TriangleDocument, TriangleGeometry, TriangleKind, TriangleReportData, triangle_document_of,
};

/// The document of a fit, without the times, which the library does not know.
#[must_use]
pub fn document_of(fit: &gimfit::CurveFit) -> Document {
    Document {
        geometry: Some(Geometry::Curve(CurveGeometry::of(&fit.curve))),
        parameters: Some(fit.parameters.clone()),
        kept_points: fit.kept_points.clone(),
        report: Some(ReportData::of(&fit.report)),
        sequence: (!fit.sequence.is_empty())
            .then(|| fit.sequence.iter().map(SequenceFit::of).collect()),
        ..Document::default()
    }
}
