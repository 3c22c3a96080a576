//! Surfaces in documents.

use super::{ApproximationData, HistoryRow, PointRows, RunData, SurfaceBlendingData};
use gimfit::{Error, KeptFit, KnotVector, PointGrid, Surface, SurfaceFit, SurfaceReport};
use serde::{Deserialize, Serialize};

/// The document of a surface; parts that were not asked for are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceDocument {
    /// Always `gimfit`.
    pub format: String,
    /// Always 1.
    pub version: u32,
    /// The surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<SurfaceKind>,
    /// The bases that were fitted, where they are no B-splines; the geometry is their Bezier form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blending: Option<SurfaceBlendingData>,
    /// Parameters of the rows and of the columns of points fitted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameters: Option<[Vec<f64>; 2]>,
    /// Parameters (u, v) of each point fitted, in rows, where geometric interpolation left each with
    /// its own; residuals are those there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_parameters: Option<Vec<Vec<[f64; 2]>>>,
    /// Names of the coordinates, where the input had them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coordinate_names: Option<Vec<String>>,
    /// The account of the fit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub report: Option<SurfaceReportData>,
    /// Fits kept on the way.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sequence: Option<Vec<NetFit>>,
}

/// The geometry of a surface document, with its type.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
#[non_exhaustive]
pub enum SurfaceKind {
    /// A tensor-product B-spline surface.
    Surface(SurfaceGeometry),
}

/// A fit of an earlier iteration, over the knots of the geometry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct NetFit {
    /// Residuals reached after how many steps.
    #[serde(flatten)]
    pub entry: HistoryRow,
    /// Its control net.
    pub control_points: Vec<PointRows>,
    /// Parameters (u, v) of the foot points on it, in rows, as those of the document.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foot_parameters: Option<Vec<Vec<[f64; 2]>>>,
}

impl NetFit {
    /// `columns` and `points_in_row`: of the net and of the points fitted.
    fn of(kept: &KeptFit, columns: usize, points_in_row: usize) -> Self {
        let points = &kept.control_points;
        let flat = kept.foot_points.as_ref().and_then(|points| points.parameters.as_deref());
        let pairs = |row: &[f64]| row.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect();
        Self {
            entry: HistoryRow::of(&kept.entry),
            control_points: rows(points.coordinates(), columns, points.dimension()),
            foot_parameters: flat
                .map(|flat| flat.chunks_exact((2 * points_in_row).max(1)).map(pairs).collect()),
        }
    }
}

/// The document of a surface fit, without the times, which the library does not know.
#[must_use]
pub fn surface_document_of(fit: &SurfaceFit) -> SurfaceDocument {
    let columns = fit.surface.control_net().shape()[1];
    let points_in_row = fit.parameters[1].len();
    SurfaceDocument {
        format: "gimfit".into(),
        version: 1,
        geometry: Some(SurfaceKind::Surface(SurfaceGeometry::of(&fit.surface))),
        blending: None,
        parameters: Some(fit.parameters.clone()),
        foot_parameters: fit
            .foot_parameters
            .as_ref()
            .map(|pairs| pairs.chunks(fit.parameters[1].len().max(1)).map(<[_]>::to_vec).collect()),
        coordinate_names: None,
        report: Some(SurfaceReportData::of(&fit.report)),
        sequence: (!fit.sequence.is_empty()).then(|| {
            fit.sequence.iter().map(|kept| NetFit::of(kept, columns, points_in_row)).collect()
        }),
    }
}

/// A tensor-product B-spline surface as any evaluator takes it. Pairs hold direction u, then v.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceGeometry {
    /// Degrees p and q.
    pub degrees: [usize; 2],
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the surface closes smoothly; its last p rows, its last q columns of control points
    /// then repeat the first.
    pub periodic: [bool; 2],
    /// n_u + p + 1 knots, and n_v + q + 1.
    pub knots: [Vec<f64>; 2],
    /// n_u rows of n_v control points.
    pub control_points: Vec<PointRows>,
    /// Weights of a rational surface; null for polynomial ones.
    pub weights: Option<Vec<Vec<f64>>>,
}

impl SurfaceGeometry {
    /// Takes a surface apart.
    #[must_use]
    pub fn of(surface: &Surface) -> Self {
        let net = surface.control_net();
        let dimension = surface.dimension();
        Self {
            degrees: surface.degrees(),
            dimension,
            periodic: surface.is_periodic(),
            knots: surface.knots().each_ref().map(|knots| knots.values().to_vec()),
            control_points: rows(net.points().coordinates(), net.shape()[1], dimension),
            weights: surface
                .rational_weights()
                .map(|weights| weights.chunks(net.shape()[1]).map(<[f64]>::to_vec).collect()),
        }
    }

    /// Puts the surface together, checked.
    ///
    /// # Errors
    /// What the knots or control points lack.
    pub fn surface(&self) -> Result<Surface, Error> {
        self.surface_with(&self.control_points)
    }

    /// The surface with another control net: one of a sequence.
    ///
    /// # Errors
    /// As [`SurfaceGeometry::surface`].
    pub fn surface_with(&self, control_points: &[PointRows]) -> Result<Surface, Error> {
        let columns = control_points.first().map_or(0, |row| row.values.len());
        for row in control_points {
            if row.dimension != self.dimension || row.values.len() != columns {
                return Err(Error::WrongCount {
                    what: "numbers in a row of control points",
                    given: row.values.len(),
                    expected: columns,
                    why: "every row holds as many points, of the dimension stated",
                });
            }
        }
        let knots = |k: usize| {
            let values = self.knots[k].clone();
            if self.periodic[k] {
                KnotVector::periodic(self.degrees[k], values)
            } else {
                KnotVector::open(self.degrees[k], values)
            }
        };
        let shape = [control_points.len(), columns / self.dimension.max(1)];
        let flat = control_points.iter().flat_map(|row| &row.values).copied().collect();
        let (knots, net) = ([knots(0)?, knots(1)?], PointGrid::new(shape, self.dimension, flat)?);
        let Some(weights) = &self.weights else { return Surface::new(knots, net) };
        if let Some(row) = weights.iter().find(|row| row.len() != shape[1]) {
            return Err(Error::WrongCount {
                what: "rational weights in a row",
                given: row.len(),
                expected: shape[1],
                why: "one per control point",
            });
        }
        Surface::rational(knots, net, weights.concat())
    }
}

/// A flat net as rows of points.
pub(super) fn rows(coordinates: &[f64], columns: usize, dimension: usize) -> Vec<PointRows> {
    coordinates
        .chunks_exact((columns * dimension).max(1))
        .map(|row| PointRows { dimension, values: row.to_vec() })
        .collect()
}

/// The account of a surface fit. Pairs hold direction u (rows), then v (columns); lengths are in
/// the unit of the data; indices count the points fitted, from 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceReportData {
    /// File or stream the points came from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// Rows and columns of points fitted.
    pub points: [usize; 2],
    /// Rows and columns of control points stored.
    pub control_points: [usize; 2],
    /// Degrees.
    pub degrees: [usize; 2],
    /// Coordinates per point.
    pub dimension: usize,
    /// Whether the surface closes.
    pub closed: [bool; 2],
    /// How parameters were assigned.
    pub parameterizations: [String; 2],
    /// How knots were placed.
    pub knot_placements: [String; 2],
    /// Longest step of the parameters over the shortest.
    pub spacing_ratios: [f64; 2],
    /// Whether the rule ran in one direction after the other.
    pub per_direction: bool,
    /// The run.
    #[serde(flatten)]
    pub run: RunData,
    /// Per direction: residuals of the columns as curves in u, then of the rows of what that gave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stages: Option<[Vec<HistoryRow>; 2]>,
    /// Row and column of the largest residual.
    pub max_residual_index: [usize; 2],
    /// Largest distance of a data point from its foot point.
    pub max_deviation: f64,
    /// Row and column where it is met.
    pub max_deviation_index: [usize; 2],
    /// What an approximation achieved; points are counted row by row.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub approximation: Option<ApproximationData>,
}

impl SurfaceReportData {
    /// Takes a report over.
    #[must_use]
    pub fn of(report: &SurfaceReport) -> Self {
        Self {
            source: None,
            points: report.points,
            control_points: report.control_points,
            degrees: report.degrees,
            dimension: report.dimension,
            closed: report.closed,
            parameterizations: report.parameterizations.map(Into::into),
            knot_placements: report.knot_placements.map(Into::into),
            spacing_ratios: report.spacing_ratios,
            per_direction: report.per_direction,
            run: RunData::of(&report.run),
            stages: report.stages.as_ref().map(|stages| {
                stages.each_ref().map(|stage| stage.iter().map(HistoryRow::of).collect())
            }),
            max_residual_index: report.max_residual_index,
            max_deviation: report.max_deviation,
            max_deviation_index: report.max_deviation_index,
            approximation: report.approximation.as_ref().map(ApproximationData::of),
        }
    }
}
