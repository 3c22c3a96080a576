//! Triangular patches in documents.

use super::{PointRows, RunData, SequenceFit};
use gimfit::geometry::TriangularPatch;
use gimfit::{Error, Points, TriangleFit, TriangleReport};
use serde::{Deserialize, Serialize};

/// The document of a triangular patch; parts that were not asked for are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriangleDocument {
    /// Always `gimfit`.
    pub format: String,
    /// Always 1.
    pub version: u32,
    /// The patch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<TriangleKind>,
    /// Names of the coordinates, where the input had them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinate_names: Option<Vec<String>>,
    /// The account of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<TriangleReportData>,
    /// Fits kept on the way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sequence: Option<Vec<SequenceFit>>,
}

/// The geometry of a triangle document, with its type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
#[non_exhaustive]
pub enum TriangleKind {
    /// A triangular Bernstein-Bezier patch.
    Triangle(TriangleGeometry),
}

/// A triangular patch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriangleGeometry {
    /// Degree n.
    pub degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// (n + 1) (n + 2) / 2 control points, in rows of the triangle.
    pub control_points: PointRows,
}

impl TriangleGeometry {
    /// Takes a patch apart.
    #[must_use]
    pub fn of(patch: &TriangularPatch) -> Self {
        Self {
            degree: patch.degree(),
            dimension: patch.dimension(),
            control_points: patch.control_points().into(),
        }
    }

    /// Puts the patch together, checked.
    ///
    /// # Errors
    /// What the degree or the control points lack.
    pub fn patch(&self) -> Result<TriangularPatch, Error> {
        self.patch_with(&self.control_points)
    }

    /// The patch with other control points: one of a sequence.
    ///
    /// # Errors
    /// As [`TriangleGeometry::patch`].
    pub fn patch_with(&self, control_points: &PointRows) -> Result<TriangularPatch, Error> {
        if control_points.dimension != self.dimension {
            return Err(Error::WrongCount {
                what: "coordinates per control point",
                given: control_points.dimension,
                expected: self.dimension,
                why: "the dimension stated",
            });
        }
        let points = Points::new(self.dimension, control_points.values.clone())?;
        TriangularPatch::new(self.degree, points)
    }
}

/// The account of a fit of a triangular patch. Lengths are in the unit of the data; indices count
/// the points, in rows of the triangle, from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TriangleReportData {
    /// File or stream the points came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Data points, as many as control points.
    pub points: usize,
    /// Degree; told apart from that of a curve by its name.
    pub triangle_degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// The run.
    #[serde(flatten)]
    pub run: RunData,
    /// Where the largest residual is met.
    pub max_residual_index: usize,
    /// Largest distance of a data point from its foot point.
    pub max_deviation: f64,
    /// Where it is met.
    pub max_deviation_index: usize,
}

impl TriangleReportData {
    /// Takes a report over.
    #[must_use]
    pub fn of(report: &TriangleReport) -> Self {
        Self {
            source: None,
            points: report.points,
            triangle_degree: report.degree,
            dimension: report.dimension,
            run: RunData::of(&report.run),
            max_residual_index: report.max_residual_index,
            max_deviation: report.max_deviation,
            max_deviation_index: report.max_deviation_index,
        }
    }
}

/// The document of a fit, without the times, which the library does not know.
#[must_use]
pub fn triangle_document_of(fit: &TriangleFit) -> TriangleDocument {
    TriangleDocument {
        format: "gimfit".into(),
        version: 1,
        geometry: Some(TriangleKind::Triangle(TriangleGeometry::of(&fit.patch))),
        coordinate_names: None,
        report: Some(TriangleReportData::of(&fit.report)),
        sequence: (!fit.sequence.is_empty())
            .then(|| fit.sequence.iter().map(SequenceFit::of).collect()),
    }
}
