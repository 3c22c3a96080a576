//! Interpolation of ordered points by a B-spline curve.

use super::convex::{Interpolating, Keeping};
use super::geometric;
use super::local::{Chosen, positions_fitted};
use super::prepare::{Prepared, prepare};
use super::rational::fitted_weights;
use super::solve::{Size, Task, norm, solve, unscaled};
use super::{CurveOptions, KeptFit, KeptFootPoints, Method, local};
use crate::Error;
use crate::collocation::{
    BandedCollocation, CollocationOperator, ControlLayout, LocalCollocation, interpolation,
    smallest_eigenvalue_of, wrap,
};
use crate::geometry::Curve;
use crate::iteration::{NoObserver, Observer};
use crate::knots::{KnotPlacement, KnotVector, place_knots};
use crate::parameters::{Parameterization, Parameters, assign_parameters};
use crate::points::{Extent, Points, PointsView, PowerOfTwoScale};
use crate::projection::{FootPointCollocation, largest_deviation};
use crate::report::CurveReport;

/// A fitted curve and the account of how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct CurveFit {
    /// The curve.
    pub curve: Curve,
    /// Parameter of each data point fitted, inside the curve's domain. They ascend, but for a
    /// closed curve whose domain starts between two data points: there the seam steps back once.
    pub parameters: Vec<f64>,
    /// Positions, in the caller's array, of the points fitted; `None` when all were.
    pub kept_points: Option<Vec<usize>>,
    /// Difference vectors `Q_j - C(t_j)` of the points fitted.
    pub difference_vectors: Points,
    /// What happened.
    pub report: CurveReport,
    /// Fits kept on the way, as [`CurveOptions::keep`] asked.
    pub sequence: Vec<KeptFit>,
}

impl CurveFit {
    /// Norm of the difference vector at each point fitted.
    #[must_use]
    pub fn residuals(&self) -> Vec<f64> {
        self.difference_vectors.iter().map(norm).collect()
    }
}

/// Fits a B-spline curve through ordered points by progressive-iterative approximation.
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`]. A run that does not reach its
/// residual is no error: look at [`RunReport::termination`](crate::RunReport::termination).
///
/// # Examples
/// ```
/// use gimfit::{CurveOptions, fit_curve};
/// let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 3.0], [4.0, 1.0], [6.0, 0.0]];
/// let fit = fit_curve(&points, &CurveOptions::default())?;
/// assert!(fit.report.converged());
/// for (point, &t) in points.iter().zip(&fit.parameters) {
///     let on_curve = fit.curve.evaluate(t)?;
///     assert!((on_curve[0] - point[0]).hypot(on_curve[1] - point[1]) < 1e-11);
/// }
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_curve<'a>(
    points: impl Into<PointsView<'a>>,
    options: &CurveOptions,
) -> Result<CurveFit, Error> {
    fit_curve_observed(points, options, &mut NoObserver)
}

/// As [`fit_curve`], watched step by step. Residuals and control points shown to the observer are
/// those the iteration works with: in the unit of the data, unless their squares would leave the
/// range of doubles (magnitudes beyond 2^300), where they are scaled by a power of two.
///
/// # Errors
/// As [`fit_curve`].
pub fn fit_curve_observed<'a>(
    points: impl Into<PointsView<'a>>,
    options: &CurveOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
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
    let rational_weights = fitted_weights(
        options.rational_weights.as_deref(),
        points.len(),
        view.len(),
        cleaned.original(),
    )?;
    let local = match &options.local {
        Some(list) => Some(positions_fitted(list, points, cleaned.kept.as_deref(), view.len())?),
        None => None,
    };
    let problem = Problem { data: view, size, parameters, knots, rational_weights };
    let mut fit = if local.is_some() {
        fit_problem(problem, &CurveOptions { local, ..options.clone() }, observer)
    } else {
        fit_problem(problem, options, observer)
    }
    .map_err(renumber)?;
    fit.report.parameterization = parameterization_name(&parameterization);
    fit.report.knot_placement = placement_name(&placement);
    choices.append(&mut fit.report.run.choices);
    fit.report.run.choices = choices;
    fit.kept_points = cleaned.kept;
    Ok(fit)
}

/// Where the data sit, and over which knots.
pub(super) struct Located {
    pub(super) parameters: Parameters,
    pub(super) knots: KnotVector,
    pub(super) placement: KnotPlacement,
}

/// Assigns parameters and places knots.
pub(super) fn locate(
    points: PointsView<'_>,
    parameterization: &Parameterization,
    options: &CurveOptions,
    choices: &mut Vec<String>,
) -> Result<Located, Error> {
    let parameters = assign_parameters(points, options.closed, parameterization)?;
    let placement = match (&options.knot_placement, parameterization) {
        (Some(_), Parameterization::ChordRatio)
            if options.knot_placement != Some(KnotPlacement::Uniform) =>
        {
            return Err(Error::Incompatible {
                what: "the chord-ratio parameterization",
                with: "this knot placement",
                why: "the 2007 scheme stands on uniform knots",
            });
        }
        (Some(placement), _) => placement.clone(),
        (None, Parameterization::ChordRatio) => KnotPlacement::Uniform,
        (None, _) => {
            choices.push("knots: averaged, because they fit any parameters".into());
            KnotPlacement::Averaged
        }
    };
    let knots = place_knots(options.degree, &parameters, &placement)?;
    Ok(Located { parameters, knots, placement })
}

/// Interpolates points at parameters and over knots that are already known; of the options, those
/// on rational weights, methods and stopping count.
///
/// # Errors
/// As [`fit_curve`].
pub fn interpolate<'a>(
    points: impl Into<PointsView<'a>>,
    parameters: Parameters,
    knots: KnotVector,
    options: &CurveOptions,
) -> Result<CurveFit, Error> {
    let points = points.into();
    let extent = Extent::of(points)?;
    if points.len() != parameters.values().len() {
        return Err(Error::WrongCount {
            what: "parameters",
            given: parameters.values().len(),
            expected: points.len(),
            why: "one per point",
        });
    }
    let size = Size::of(extent);
    let data = size.scale.apply(points.coordinates());
    let view = PointsView::new(points.dimension(), &data)?;
    let count = points.len();
    let rational_weights =
        fitted_weights(options.rational_weights.as_deref(), count, count, |j| j)?;
    let problem = Problem { data: view, size, parameters, knots, rational_weights };
    fit_problem(problem, options, &mut NoObserver)
}

/// Everything a run needs; the data are scaled.
struct Problem<'a> {
    data: PointsView<'a>,
    size: Size,
    parameters: Parameters,
    knots: KnotVector,
    /// One per point.
    rational_weights: Option<Vec<f64>>,
}

/// The collocation matrix, at parameters that stay or that follow the foot points.
enum Rows {
    Fixed(BandedCollocation),
    Moving(Box<FootPointCollocation>),
}

fn fit_problem(
    problem: Problem<'_>,
    options: &CurveOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let Problem { data, size, parameters, knots, rational_weights } = problem;
    let scale = size.scale;
    let mut built = interpolation(&parameters, &knots)?;
    if let Some(weights) = &rational_weights {
        built.operator.weigh(weights);
    }
    let layout = built.layout;
    let dimension = data.dimension();
    if options.convexity.is_some() && rational_weights.is_some() {
        return Err(Error::Incompatible {
            what: "keeping the turns of the data",
            with: "rational weights",
            why: "it inserts knots, which is done for polynomial curves only",
        });
    }
    let mut notes = Vec::new();
    let stopping = size.stopping(options.residual, options.iterations, &mut notes)?;
    let mut keeping = match options.convexity {
        Some(_) if matches!(options.method, Method::Geometric { .. }) => {
            return Err(Error::Incompatible {
                what: "keeping the turns of the data",
                with: "geometric interpolation",
                why: "it needs parameters that stay; use pia or auto",
            });
        }
        Some(convexity) => {
            let closed = parameters.period().is_some();
            Some(Keeping::new(convexity, data, closed, knots.degree())?)
        }
        None => None,
    };
    let rows = if let Method::Geometric { global_start } = options.method {
        if options.local.is_some() {
            return Err(Error::Incompatible {
                what: "local PIA",
                with: "geometric interpolation",
                why: "foot points move on the whole curve; use another method",
            });
        }
        geometric::check_dimension(dimension, 2)?;
        let start = parameters.values();
        let weights = rational_weights.as_deref();
        let (least, note) = geometric::least_eigenvalue(options.least_eigenvalue, || {
            smallest_eigenvalue_of(&built.operator).map(|bounds| bounds.estimate)
        })?;
        notes.extend(note);
        let moving = FootPointCollocation::new(built, &knots, start, dimension, weights)?
            .with_least_eigenvalue(least);
        Rows::Moving(Box::new(if global_start { moving.with_global_start() } else { moving }))
    } else {
        Rows::Fixed(built.operator)
    };
    let local = match &rows {
        Rows::Fixed(fixed) => Chosen::of(options, fixed)?,
        Rows::Moving(_) => None,
    };
    let gradual = options.keep.iter().copied().max().unwrap_or(0).min(options.iterations);
    let (operator, mut chosen): (&dyn CollocationOperator, _) = match (&rows, &mut keeping) {
        (Rows::Moving(moving), _) => {
            (&**moving, geometric::curve_rule(moving, options.method, &options.weight)?)
        }
        (Rows::Fixed(fixed), Some(keeping)) => {
            let threshold = size.threshold(options.convexity)?;
            let problem = Interpolating { data, parameters: &parameters, knots: &knots, layout };
            (fixed, keeping.choose(&problem, options, fixed, threshold, gradual)?)
        }
        (Rows::Fixed(fixed), None) => {
            (fixed, local::choose(options, local.as_ref(), fixed, dimension, gradual, stopping)?)
        }
    };
    chosen.choices.append(&mut notes);
    let seen = local.as_ref().map(|local| LocalCollocation::new(operator, &local.points));
    let expand = |control| {
        let stored = layout.expand(control, dimension);
        match &keeping {
            Some(keeping) => keeping.refine(stored),
            None => stored,
        }
    };
    let foot_points = match &rows {
        Rows::Moving(moving) => Some(|| geometric::curve_account(moving)),
        Rows::Fixed(_) => None,
    };
    let task = Task {
        operator: seen.as_ref().map_or(operator, |seen| seen),
        data: data.coordinates(),
        dimension,
        size: &size,
        stopping,
        keep: &options.keep,
        expand: &expand,
        foot_points: foot_points.as_ref().map(|tell| tell as &dyn Fn() -> KeptFootPoints),
    };
    let mut solved = solve(&task, &mut chosen, observer)?;
    if let (Some(seen), Some(local)) = (&seen, &local) {
        local.look_outside(seen, data.coordinates(), dimension, scale, &mut solved);
    }
    drop(chosen);
    drop(seen);
    drop(local);
    let parameters = match rows {
        Rows::Fixed(_) => parameters,
        Rows::Moving(moving) => {
            let account = geometric::curve_account(&moving);
            let sentences = geometric::curve_sentences(&account.report);
            geometric::tell(&account, sentences, &mut solved.run);
            for kept in solved.sequence.iter_mut().filter_map(|kept| kept.foot_points.as_mut()) {
                // As they are stored with a curve.
                if let Some(values) = kept.parameters.take() {
                    let moved = parameters.clone().moved(values)?;
                    kept.parameters = Some(finish_parameters(moved, &knots, layout).0);
                }
            }
            parameters.moved(moving.rising_parameters())?
        }
    };

    let (parameters, spacing_ratio) = finish_parameters(parameters, &knots, layout);
    // A copy only where the shape is to be judged by what moved.
    let moved = keeping.as_ref().map(|_| solved.control.clone());
    let control_points = Points::new(dimension, expand(solved.control))?;
    let knots = match &keeping {
        Some(keeping) => keeping.knots(knots),
        None => knots,
    };
    let curve = match rational_weights {
        None => Curve::new(knots, control_points)?,
        Some(weights) => Curve::rational(knots, control_points, layout.expand(weights, 1))?,
    };
    let shape = keeping.zip(moved).map(|(keeping, moved)| keeping.report(&moved, &curve));
    let norms = solved.norms;
    let (max_deviation, max_deviation_index) =
        if solved.run.local.is_none() && norms.max <= size.rounding_level() {
            // Down there a foot point is decided by rounding; the residual bounds the distance.
            (norms.max, norms.max_index)
        } else {
            let residuals: Vec<f64> = solved.vectors.chunks_exact(dimension).map(norm).collect();
            largest_deviation(&curve, data, &parameters, &residuals)?
        };
    let curve = unscale(curve, scale)?;
    let report = CurveReport {
        points: data.len(),
        control_points: curve.control_points().len(),
        degree: curve.degree(),
        dimension,
        closed: curve.is_periodic(),
        parameterization: "given",
        knot_placement: "given",
        spacing_ratio,
        shape,
        run: solved.run,
        approximation: None,
        max_residual_index: norms.max_index,
        max_deviation: scale.undo(max_deviation),
        max_deviation_index,
    };
    Ok(CurveFit {
        curve,
        parameters,
        kept_points: None,
        difference_vectors: unscaled(Points::new(dimension, solved.vectors)?, scale)?,
        report,
        sequence: solved.sequence,
    })
}

/// The parameters as stored with a curve, and the longest step over the shortest.
pub(super) fn finish_parameters(
    parameters: Parameters,
    knots: &KnotVector,
    layout: ControlLayout,
) -> (Vec<f64>, f64) {
    let period = parameters.period();
    let mut values = parameters.into_values();
    let ratio = spacing_ratio(&values, period);
    if matches!(layout, ControlLayout::Periodic { .. }) {
        let period = period.unwrap_or_default();
        values.iter_mut().for_each(|t| *t = wrap(*t, knots.domain(), period));
    }
    (values, ratio)
}

/// Longest step of ascending parameters over the shortest; a closed curve's last step leads back to
/// the first.
pub(super) fn spacing_ratio(values: &[f64], period: Option<f64>) -> f64 {
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0);
    let mut note = |step: f64| {
        shortest = if step < shortest { step } else { shortest };
        longest = if step > longest { step } else { longest };
    };
    values.windows(2).for_each(|t| note(t[1] - t[0]));
    if let Some(period) = period
        && let (Some(first), Some(last)) = (values.first(), values.last())
    {
        note(first + period - last);
    }
    if longest > 0.0 { longest / shortest } else { 1.0 }
}

/// Brings a curve back into the unit of the data.
pub(super) fn unscale(curve: Curve, scale: PowerOfTwoScale) -> Result<Curve, Error> {
    if scale.is_identity() {
        return Ok(curve);
    }
    curve.with_control_points(unscaled(curve.control_points().clone(), scale)?)
}

pub(super) fn parameterization_name(parameterization: &Parameterization) -> &'static str {
    match parameterization {
        Parameterization::Chord => "chord",
        Parameterization::Centripetal => "centripetal",
        Parameterization::Uniform => "uniform",
        Parameterization::ChordRatio => "chord-ratio",
        Parameterization::Given(_) => "given",
    }
}

pub(super) fn placement_name(placement: &KnotPlacement) -> &'static str {
    match placement {
        KnotPlacement::Averaged => "averaged",
        KnotPlacement::NotAKnot => "not-a-knot",
        KnotPlacement::AtData => "at-data",
        KnotPlacement::Uniform => "uniform",
        KnotPlacement::Bezier => "bezier",
        KnotPlacement::Given(_) => "given",
    }
}
