//! A diagnosis in place of a fit: what [`diagnose`](crate::diagnosis::diagnose) says of the points
//! and options of a curve.

use super::blending::{Collocated, collocate, measure};
use super::curve::{Located, locate, parameterization_name, placement_name, spacing_ratio};
use super::prepare::{Prepared, prepare};
use super::rational::fitted_weights;
use super::solve::Size;
use super::{BlendingOptions, CurveOptions};
use crate::Error;
use crate::basis::BlendingBasis;
use crate::collocation::{CollocationMatrix, interpolation};
use crate::diagnosis::{Diagnosis, Spacing, Start, diagnose};
use crate::iteration::ROUNDING;
use crate::parameters::Parameters;
use crate::points::PointsView;

/// The diagnosis of a curve before it is fitted. Positions in [`CurveDiagnosis::matrix`] count the
/// points fitted; see [`CurveDiagnosis::kept_points`].
#[derive(Debug, Clone, PartialEq)]
pub struct CurveDiagnosis {
    /// What the collocation matrix says.
    pub matrix: Diagnosis,
    /// Positions, in the caller's array, of the points fitted; `None` when all are.
    pub kept_points: Option<Vec<usize>>,
    /// Degree.
    pub degree: usize,
    /// Whether the curve closes.
    pub closed: bool,
    /// How parameters are assigned.
    pub parameterization: &'static str,
    /// How knots are placed.
    pub knot_placement: &'static str,
    /// Longest step of the parameters over the shortest.
    pub spacing_ratio: f64,
    /// Diagonal of the bounding box of the data.
    pub extent: f64,
    /// The residual that forecasts aim at, in the unit of the data.
    pub residual_target: f64,
    /// Largest residual before the first step.
    pub first_residual: f64,
    /// The residual that rounding leaves in control points as large as those of the interpolant.
    /// Where it exceeds the target, forecasts aim at it instead: a run gets no farther.
    pub rounding: f64,
    /// What was chosen for the caller, and why.
    pub choices: Vec<String>,
}

/// Tells how a curve fit with these options would go, without running it. The method of the options
/// is left aside: all are forecast.
///
/// # Errors
/// As [`fit_curve`](super::fit_curve).
///
/// # Examples
/// ```
/// use gimfit::{CurveOptions, Method, diagnose_curve, fit_curve};
/// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
/// let options = CurveOptions { method: Method::Pia, ..Default::default() };
/// let diagnosis = diagnose_curve(&points, &options)?;
/// let pia = &diagnosis.matrix.forecasts[0];
/// let run = fit_curve(&points, &options)?.report.run;
/// assert_eq!((pia.method, pia.iterations), ("pia", Some(run.iterations as u64)));
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn diagnose_curve<'a>(
    points: impl Into<PointsView<'a>>,
    options: &CurveOptions,
) -> Result<CurveDiagnosis, Error> {
    let points = points.into();
    let prepared = prepare(points, options)?;
    let Prepared { cleaned, extent, parameterization, mut choices, dimension } = prepared;
    let size = Size::of(extent);
    let data = size.scale.apply(&cleaned.coordinates);
    let view = PointsView::new(dimension, &data)?;
    let renumber = |error: Error| match &cleaned.kept {
        Some(kept) => error.renumbered(kept),
        None => error,
    };
    let Located { parameters, knots, placement } =
        locate(view, &parameterization, options, &mut choices).map_err(renumber)?;
    let mut operator = interpolation(&parameters, &knots).map_err(renumber)?.operator;
    let rational_weights = options.rational_weights.as_deref();
    let weights = fitted_weights(rational_weights, points.len(), view.len(), cleaned.original())?;
    if let Some(weights) = weights {
        operator.weigh(&weights);
    }
    let task = Task {
        operator: &operator,
        data: view,
        size: &size,
        parameters: &parameters,
        degree: options.degree,
        residual: options.residual,
    };
    let mut diagnosis = task.diagnose(choices)?;
    diagnosis.parameterization = parameterization_name(&parameterization);
    diagnosis.knot_placement = placement_name(&placement);
    diagnosis.kept_points = cleaned.kept;
    Ok(diagnosis)
}

/// As [`diagnose_curve`], over a blending basis.
///
/// # Errors
/// As [`fit_blending_curve`](super::fit_blending_curve).
pub fn diagnose_blending_curve<'a>(
    points: impl Into<PointsView<'a>>,
    basis: &dyn BlendingBasis,
    options: &BlendingOptions,
) -> Result<CurveDiagnosis, Error> {
    let points = points.into();
    let size = measure(points, basis)?;
    let data = size.scale.apply(points.coordinates());
    let view = PointsView::new(points.dimension(), &data)?;
    let mut choices = Vec::new();
    let Collocated { operator, parameters, parameterization } =
        collocate(view, &size, basis, options.parameterization.as_ref(), &mut choices)?;
    let task = Task {
        operator: &operator,
        data: view,
        size: &size,
        parameters: &parameters,
        degree: view.len() - 1,
        residual: options.residual,
    };
    let mut diagnosis = task.diagnose(choices)?;
    diagnosis.parameterization = parameterization_name(&parameterization);
    diagnosis.knot_placement = "bezier";
    Ok(diagnosis)
}

/// What is diagnosed; the data are scaled.
struct Task<'a> {
    operator: &'a dyn CollocationMatrix,
    data: PointsView<'a>,
    size: &'a Size,
    parameters: &'a Parameters,
    degree: usize,
    residual: Option<f64>,
}

impl Task<'_> {
    fn diagnose(&self, mut choices: Vec<String>) -> Result<CurveDiagnosis, Error> {
        let Self { operator, data, size, parameters, degree, residual } = *self;
        let dimension = data.dimension();
        let data = data.coordinates();
        let stopping = size.stopping(residual, 0, &mut choices)?;
        let mut vectors = vec![0.0; data.len()];
        let first = operator.difference_vectors(data, data, dimension, &mut vectors);
        let mut limit = data.to_vec();
        operator.factor(None)?.solve_in_place(&mut limit, dimension);
        let largest = limit.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        drop(limit);
        if !largest.is_finite() {
            return Err(Error::LeavesDoubles);
        }
        let rounding = ROUNDING * largest;
        let tolerance = stopping.residual.max(rounding);
        let start = Start { difference_vectors: &vectors, dimension, tolerance };
        let spacing = Spacing {
            parameters: parameters.values(),
            period: parameters.period(),
            reach: degree.div_ceil(2) + 1,
        };
        let matrix = diagnose(operator, Some(spacing), Some(start))?;
        let Size { scale, extent } = size;
        Ok(CurveDiagnosis {
            matrix,
            kept_points: None,
            degree,
            closed: parameters.period().is_some(),
            parameterization: "given",
            knot_placement: "given",
            spacing_ratio: spacing_ratio(parameters.values(), parameters.period()),
            extent: extent.diagonal(),
            residual_target: scale.undo(stopping.residual),
            first_residual: scale.undo(first.max),
            rounding: scale.undo(rounding),
            choices,
        })
    }
}
