//! Interpolation of ordered points by a curve over any blending basis.

use super::curve::{parameterization_name, spacing_ratio};
use super::method::choose;
use super::prepare::check_extent;
use super::solve::{Size, Task, norm, solve, unscaled};
use super::{BlendingOptions, CurveFit, KeptFit, Method};
use crate::Error;
use crate::basis::BlendingBasis;
use crate::collocation::{
    CollocationMatrix, CollocationOperator, DenseCollocation, smallest_eigenvalue_of,
};
use crate::geometry::BlendingCurve;
use crate::iteration::{NoObserver, Observer, Termination};
use crate::parameters::{Parameterization, Parameters, assign_parameters};
use crate::points::{Extent, Points, PointsView};
use crate::projection::largest_deviation;
use crate::report::{CurveReport, RunReport};
use std::sync::Arc;

/// A fitted curve over a blending basis and the account of how it came about.
#[derive(Debug, Clone)]
pub struct BlendingCurveFit {
    /// The curve.
    pub curve: BlendingCurve,
    /// Parameter of each data point.
    pub parameters: Vec<f64>,
    /// Difference vectors `Q_j - C(t_j)`.
    pub difference_vectors: Points,
    /// What happened. The degree told is the number of functions less one.
    pub report: CurveReport,
    /// Fits kept on the way, with control points of the basis.
    pub sequence: Vec<KeptFit>,
}

impl BlendingCurveFit {
    /// The same fit told in Bezier form, kept fits included: a B-spline curve of one piece.
    ///
    /// # Errors
    /// As [`BlendingCurve::to_bezier`].
    pub fn to_bezier(&self) -> Result<CurveFit, Error> {
        let kept = self.sequence.iter().map(|kept| {
            let curve = self.curve.bezier_with(&kept.control_points)?;
            Ok(KeptFit {
                entry: kept.entry,
                control_points: curve.control_points().clone(),
                foot_points: None,
            })
        });
        Ok(CurveFit {
            curve: self.curve.to_bezier()?,
            parameters: self.parameters.clone(),
            kept_points: None,
            difference_vectors: self.difference_vectors.clone(),
            report: self.report.clone(),
            sequence: kept.collect::<Result<_, Error>>()?,
        })
    }
}

/// Fits a curve over a blending basis through ordered points, one function per point, by
/// progressive-iterative approximation.
///
/// # Errors
/// What is wrong with the points, the basis or the options; see [`Error`]. A run that does not
/// reach its residual is no error: look at
/// [`RunReport::termination`](crate::RunReport::termination).
///
/// # Examples
/// ```
/// use gimfit::basis::SaidBall;
/// use gimfit::{BlendingOptions, fit_blending_curve};
/// use std::sync::Arc;
/// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
/// let fit = fit_blending_curve(&points, Arc::new(SaidBall::new(4)?), &BlendingOptions::default())?;
/// assert!(fit.report.converged());
/// let on_curve = fit.curve.evaluate(0.25)?;
/// assert!((on_curve[0] - 1.0).hypot(on_curve[1] - 2.0) < 1e-11);
/// let bezier = fit.curve.to_bezier()?;
/// assert_eq!(bezier.degree(), 4);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_blending_curve<'a>(
    points: impl Into<PointsView<'a>>,
    basis: Arc<dyn BlendingBasis>,
    options: &BlendingOptions,
) -> Result<BlendingCurveFit, Error> {
    fit_blending_curve_observed(points, basis, options, &mut NoObserver)
}

/// As [`fit_blending_curve`], watched step by step, as
/// [`fit_curve_observed`](super::fit_curve_observed).
///
/// # Errors
/// As [`fit_blending_curve`].
pub fn fit_blending_curve_observed<'a>(
    points: impl Into<PointsView<'a>>,
    basis: Arc<dyn BlendingBasis>,
    options: &BlendingOptions,
    observer: &mut dyn Observer,
) -> Result<BlendingCurveFit, Error> {
    let points = points.into();
    let size = measure(points, &*basis)?;
    let dimension = points.dimension();
    let data = size.scale.apply(points.coordinates());
    let view = PointsView::new(dimension, &data)?;
    let mut choices = Vec::new();
    let Collocated { operator, parameters, parameterization: chosen } =
        collocate(view, &size, &*basis, options.parameterization.as_ref(), &mut choices)?;
    cautions(&operator, &*basis, options.method, "", &mut choices);

    let gradual = options.keep.iter().copied().max().unwrap_or(0).min(options.iterations);
    let mut rule = choose(options.method, &options.weight, &operator, dimension, gradual)?;
    let stopping = size.stopping(options.residual, options.iterations, &mut rule.choices)?;
    let task = Task {
        operator: &operator,
        data: view.coordinates(),
        dimension,
        size: &size,
        stopping,
        keep: &options.keep,
        expand: &|control| control,
        foot_points: None,
    };
    let mut solved = solve(&task, &mut rule, observer)?;
    drop(rule);
    note_near_singularity(&[&operator], &mut solved.run);

    let scale = size.scale;
    let curve = BlendingCurve::new(basis, Points::new(dimension, solved.control)?)?;
    let values = parameters.into_values();
    let norms = solved.norms;
    let (deviation, deviation_index) = match curve.to_bezier() {
        _ if norms.max <= size.rounding_level() => (norms.max, norms.max_index),
        Ok(bezier) => {
            let residuals: Vec<f64> = solved.vectors.chunks_exact(dimension).map(norm).collect();
            largest_deviation(&bezier, view, &values, &residuals)?
        }
        Err(_) => {
            choices.push(
                "deviation: not more than the residual, which is told in its place: foot points \
                 are looked for on Bezier curves only"
                    .into(),
            );
            (norms.max, norms.max_index)
        }
    };
    let control_points = unscaled(curve.control_points().clone(), scale)?;
    let curve = BlendingCurve::new(Arc::clone(curve.basis()), control_points)?;
    choices.append(&mut solved.run.choices);
    solved.run.choices = choices;
    let report = CurveReport {
        approximation: None,
        points: view.len(),
        control_points: view.len(),
        degree: view.len() - 1,
        dimension,
        closed: false,
        parameterization: parameterization_name(&chosen),
        knot_placement: "bezier",
        spacing_ratio: spacing_ratio(&values, None),
        shape: None,
        run: solved.run,
        max_residual_index: norms.max_index,
        max_deviation: scale.undo(deviation),
        max_deviation_index: deviation_index,
    };
    Ok(BlendingCurveFit {
        curve,
        parameters: values,
        difference_vectors: unscaled(Points::new(dimension, solved.vectors)?, scale)?,
        report,
        sequence: solved.sequence,
    })
}

/// Checks the points, and tells how large they are.
pub(super) fn measure(points: PointsView<'_>, basis: &dyn BlendingBasis) -> Result<Size, Error> {
    if points.is_empty() {
        return Err(Error::NoPoints { needed: basis.functions() });
    }
    check_function_count(basis, points.len())?;
    let size = Size::of(Extent::of(points)?);
    check_extent(&size.extent)?;
    Ok(size)
}

/// The matrix of a basis, and where it comes from.
pub(super) struct Collocated {
    pub(super) operator: DenseCollocation,
    pub(super) parameters: Parameters,
    pub(super) parameterization: Parameterization,
}

/// Assigns parameters to scaled points, and collocates.
pub(super) fn collocate(
    points: PointsView<'_>,
    size: &Size,
    basis: &dyn BlendingBasis,
    parameterization: Option<&Parameterization>,
    choices: &mut Vec<String>,
) -> Result<Collocated, Error> {
    let parameterization = parameterization.cloned().unwrap_or_else(|| {
        choices.push("parameters: uniform, as is usual for this kind of basis".into());
        Parameterization::Uniform
    });
    let equal = size.extent.diagonal() == 0.0 && points.len() > 1;
    if equal && parameterization.needs_distinct_points() {
        return Err(Error::AllPointsEqual { points: points.len() });
    }
    if equal {
        choices.push("caution: all points are equal; the curve is one point".into());
    }
    let parameters = assign_parameters(points, false, &parameterization)?;
    let parameters = onto_domain(parameters, basis, &parameterization, "", choices)?;
    let operator = DenseCollocation::new(basis, &parameters)?;
    Ok(Collocated { operator, parameters, parameterization })
}

/// Refuses another number of functions than points.
fn check_function_count(basis: &dyn BlendingBasis, points: usize) -> Result<(), Error> {
    if basis.functions() == points {
        return Ok(());
    }
    Err(Error::WrongCount {
        what: "points",
        given: points,
        expected: basis.functions(),
        why: "as many as the basis has functions; a basis of degree n has n + 1",
    })
}

/// Parameters on the domain of a basis: given ones that lie in it stay, all others are stretched
/// onto it. `place` is empty, or names the direction.
pub(super) fn onto_domain(
    parameters: Parameters,
    basis: &dyn BlendingBasis,
    parameterization: &Parameterization,
    place: &str,
    choices: &mut Vec<String>,
) -> Result<Parameters, Error> {
    let (start, end) = basis.domain();
    if !(start < end && (end - start).is_finite()) {
        return Err(Error::OutOfRange {
            what: format!("domain of the basis {} from {start:?} to", basis.name()),
            value: end,
            rule: "a domain must be finite, and its end must exceed its start",
        });
    }
    let values = parameters.values();
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return Ok(parameters);
    };
    let given = matches!(parameterization, Parameterization::Given(_));
    if (given && start <= first && last <= end) || (first == start && last == end) {
        return Ok(parameters);
    }
    if given {
        choices.push(format!(
            "parameters{place}: brought from [{first}, {last}] to the domain [{start}, {end}] of \
             the basis"
        ));
    }
    if last <= first {
        // A single point.
        return Parameters::open(vec![start]);
    }
    let share = |t: f64| ((t - first) / (last - first)).clamp(0.0, 1.0);
    let mut moved: Vec<f64> = values.iter().map(|&t| start + (end - start) * share(t)).collect();
    if let Some(t) = moved.last_mut() {
        *t = end;
    }
    Parameters::open(moved)
}

/// Below this smallest eigenvalue the data need more digits than doubles have.
const NEARLY_SINGULAR: f64 = 1e-11;

/// Explains a run that ended short of its residual because no run could reach it.
pub(super) fn note_near_singularity(operators: &[&DenseCollocation], run: &mut RunReport) {
    if run.termination != Termination::Stalled {
        return;
    }
    let mut smallest = 1.0;
    for operator in operators {
        smallest *= smallest_eigenvalue_of(*operator).map_or(0.0, |bounds| bounds.estimate);
    }
    if smallest < NEARLY_SINGULAR {
        run.choices.push(format!(
            "caution: the collocation matrix is close to singular in doubles (smallest eigenvalue \
             {smallest:.0e}), so that control points of rough data grow beyond their digits: fit \
             fewer points at once, or use B-splines"
        ));
    }
}

/// What a method rests on and a basis does not offer.
pub(super) fn cautions(
    operator: &DenseCollocation,
    basis: &dyn BlendingBasis,
    method: Method,
    place: &str,
    choices: &mut Vec<String>,
) {
    let rests = !matches!(
        method,
        Method::Auto | Method::Anderson { .. } | Method::Preconditioned { half_bandwidth: None }
    );
    if rests && !operator.is_totally_positive() {
        choices.push(format!(
            "caution: the basis {}{place} is not known to be totally positive, and the convergence \
             of this method is proved for bases that are; auto and anderson do without",
            basis.name()
        ));
    }
    let weak = (0..operator.points()).find(|&j| operator.diagonal(j) <= 0.5);
    if let (Method::Jacobi, Some(j)) = (method, weak) {
        choices.push(format!(
            "caution: jacobi is safe where the diagonal dominates, and here it does not (function \
             {j}{place} is {:.3} at its own parameter): expect it to diverge at high degrees",
            operator.diagonal(j)
        ));
    }
}
