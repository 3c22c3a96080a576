//! The document as data.

use super::approximation::ApproximationData;
use super::run::{RunData, number_or_null};
use super::{BlendingData, PointRows};
use gimfit::{Curve, CurveReport, Error, KeptFit, KnotVector, Points, ShapeReport};
use serde::{Deserialize, Serialize};

/// A whole document; parts that were not asked for are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Always `gimfit`.
    pub format: String,
    /// Always 1.
    pub version: u32,
    /// The curve.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<Geometry>,
    /// The basis that was fitted, where it is no B-spline; the geometry is its Bezier form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blending: Option<BlendingData>,
    /// Parameter of each data point fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameters: Option<Vec<f64>>,
    /// Positions of the points fitted among those read, from 0; left out when all were fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept_points: Option<Vec<usize>>,
    /// Names of the coordinates, where the input had them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinate_names: Option<Vec<String>>,
    /// The account of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<ReportData>,
    /// Fits kept on the way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sequence: Option<Vec<SequenceFit>>,
}

impl Default for Document {
    fn default() -> Self {
        Self {
            format: "gimfit".into(),
            version: 1,
            geometry: None,
            blending: None,
            parameters: None,
            kept_points: None,
            coordinate_names: None,
            report: None,
            sequence: None,
        }
    }
}

/// What was fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
#[non_exhaustive]
pub enum Geometry {
    /// A B-spline curve.
    Curve(CurveGeometry),
}

/// A B-spline curve as any evaluator takes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurveGeometry {
    /// Degree p.
    pub degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the curve closes smoothly; its last p control points then repeat the first.
    pub periodic: bool,
    /// n + p + 1 knots.
    pub knots: Vec<f64>,
    /// n control points.
    pub control_points: PointRows,
    /// Weights of a rational curve; null for polynomial ones.
    pub weights: Option<Vec<f64>>,
}

impl CurveGeometry {
    /// Takes a curve apart.
    #[must_use]
    pub fn of(curve: &Curve) -> Self {
        Self {
            degree: curve.degree(),
            dimension: curve.dimension(),
            periodic: curve.is_periodic(),
            knots: curve.knots().values().to_vec(),
            control_points: curve.control_points().into(),
            weights: curve.rational_weights().map(<[f64]>::to_vec),
        }
    }

    /// Puts the curve together, checked.
    ///
    /// # Errors
    /// What the knots or control points lack.
    pub fn curve(&self) -> Result<Curve, Error> {
        self.curve_with(&self.control_points)
    }

    /// The curve with other control points: one of a sequence.
    ///
    /// # Errors
    /// As [`CurveGeometry::curve`].
    pub fn curve_with(&self, control_points: &PointRows) -> Result<Curve, Error> {
        if control_points.dimension != self.dimension {
            return Err(Error::WrongCount {
                what: "coordinates per control point",
                given: control_points.dimension,
                expected: self.dimension,
                why: "the dimension stated",
            });
        }
        let knots = if self.periodic {
            KnotVector::periodic(self.degree, self.knots.clone())?
        } else {
            KnotVector::open(self.degree, self.knots.clone())?
        };
        let points = Points::new(self.dimension, control_points.values.clone())?;
        match &self.weights {
            None => Curve::new(knots, points),
            Some(weights) => Curve::rational(knots, points, weights.clone()),
        }
    }
}

/// A fit of an earlier iteration, over the knots of the geometry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceFit {
    /// Steps taken.
    pub iteration: usize,
    /// Largest norm of a difference vector.
    #[serde(with = "number_or_null")]
    pub max_residual: f64,
    /// Root mean square of the norms.
    #[serde(with = "number_or_null")]
    pub rms_residual: f64,
    /// Its control points.
    pub control_points: PointRows,
    /// Parameters of the foot points on it; geometric interpolation only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameters: Option<Vec<f64>>,
}

impl SequenceFit {
    /// Takes a kept fit over.
    #[must_use]
    pub fn of(kept: &KeptFit) -> Self {
        Self {
            iteration: kept.entry.iteration,
            max_residual: kept.entry.max_residual,
            rms_residual: kept.entry.rms_residual,
            control_points: (&kept.control_points).into(),
            parameters: kept.foot_points.as_ref().and_then(|points| points.parameters.clone()),
        }
    }
}

/// The turns of a planar data polygon that were to be kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShapeData {
    /// Corners that turn left.
    pub left: usize,
    /// Corners that turn right.
    pub right: usize,
    /// Corners that do not turn.
    pub straight: usize,
    /// Corners of the control polygon written that turn left.
    #[serde(default)]
    pub control_left: usize,
    /// Corners of the control polygon written that turn right.
    #[serde(default)]
    pub control_right: usize,
    /// Knots inserted so that the control polygon shows the shape.
    pub inserted_knots: usize,
    /// Whether the control polygon turns as the data do, and the curve has no more inflections.
    pub kept: bool,
}

impl ShapeData {
    /// Takes a report over.
    #[must_use]
    pub fn of(shape: &ShapeReport) -> Self {
        let ShapeReport {
            left,
            right,
            straight,
            control_left,
            control_right,
            inserted_knots,
            kept,
        } = *shape;
        Self { left, right, straight, control_left, control_right, inserted_knots, kept }
    }
}

/// The account of a fit. Lengths are in the unit of the data; indices count the points fitted,
/// from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReportData {
    /// File or stream the points came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Data points fitted.
    pub points: usize,
    /// Control points stored.
    pub control_points: usize,
    /// Degree.
    pub degree: usize,
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the curve closes.
    pub closed: bool,
    /// How parameters were assigned.
    pub parameterization: String,
    /// How knots were placed.
    pub knot_placement: String,
    /// Longest step of the parameters over the shortest.
    pub spacing_ratio: f64,
    /// The turns kept, where they were to be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<ShapeData>,
    /// The run.
    #[serde(flatten)]
    pub run: RunData,
    /// What an approximation achieved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approximation: Option<ApproximationData>,
    /// Where the largest residual is met.
    pub max_residual_index: usize,
    /// Largest distance of a data point from its foot point.
    pub max_deviation: f64,
    /// Where it is met.
    pub max_deviation_index: usize,
}

impl ReportData {
    /// Takes a report over.
    #[must_use]
    pub fn of(report: &CurveReport) -> Self {
        Self {
            source: None,
            points: report.points,
            control_points: report.control_points,
            degree: report.degree,
            dimension: report.dimension,
            closed: report.closed,
            parameterization: report.parameterization.into(),
            knot_placement: report.knot_placement.into(),
            spacing_ratio: report.spacing_ratio,
            shape: report.shape.as_ref().map(ShapeData::of),
            run: RunData::of(&report.run),
            approximation: report.approximation.as_ref().map(ApproximationData::of),
            max_residual_index: report.max_residual_index,
            max_deviation: report.max_deviation,
            max_deviation_index: report.max_deviation_index,
        }
    }
}
