//! Interpolation of ordered points by a B-spline curve.

use super::CurveOptions;
use super::keep::Keeper;
use super::method::{ChosenRule, choose};
use crate::Error;
use crate::collocation::{ControlLayout, Interpolation, interpolation, wrap};
use crate::geometry::Curve;
use crate::iteration::{
    HistoryEntry, IterationState, NoObserver, Observer, Outcome, ROUNDING, Stopping, Termination,
    run,
};
use crate::knots::{KnotPlacement, KnotVector, place_knots};
use crate::parameters::{Parameterization, Parameters, assign_parameters};
use crate::points::{Extent, Points, PointsView, PowerOfTwoScale};
use crate::projection::largest_deviation;
use crate::report::CurveReport;

use super::prepare::{Prepared, prepare};

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

/// A fit of an earlier iteration; its knots are those of the final curve.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptFit {
    /// Steps taken and residuals reached.
    pub entry: HistoryEntry,
    /// Its control points as stored in a curve, shape (n, dimension).
    pub control_points: Points,
}

/// Fits a B-spline curve through ordered points by progressive-iterative approximation.
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`]. A run that does not reach its
/// residual is no error: look at [`CurveReport::termination`].
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
    let prepared = prepare(points.into(), options)?;
    let Prepared { cleaned, extent, parameterization, mut choices, dimension } = prepared;
    let scale = PowerOfTwoScale::for_magnitude(extent.largest_coordinate());
    let data = scale.apply(&cleaned.coordinates);
    let view = PointsView::new(dimension, &data)?;
    let renumber = |error: Error| match &cleaned.kept {
        Some(kept) => error.renumbered(kept),
        None => error,
    };
    let parameters =
        assign_parameters(view, options.closed, &parameterization).map_err(renumber)?;
    let placement = match (&options.knot_placement, &parameterization) {
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
    let problem = Problem { data: view, scale, extent, parameters, knots };
    let mut fit = solve(problem, options, observer).map_err(renumber)?;
    fit.report.parameterization = parameterization_name(&parameterization);
    fit.report.knot_placement = placement_name(&placement);
    choices.append(&mut fit.report.choices);
    fit.report.choices = choices;
    fit.kept_points = cleaned.kept;
    Ok(fit)
}

/// Interpolates points at parameters and over knots that are already known; of the options, those
/// on methods and stopping count.
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
    let scale = PowerOfTwoScale::for_magnitude(extent.largest_coordinate());
    let data = scale.apply(points.coordinates());
    let view = PointsView::new(points.dimension(), &data)?;
    solve(Problem { data: view, scale, extent, parameters, knots }, options, &mut NoObserver)
}

/// Control points this many extents, and this many times the data, away from the origin are no fit
/// that anybody wants.
const WILD_SWING: f64 = 1e3;

/// Share of the extent that rounding may take where no residual was demanded.
const MOST_ROUNDING: f64 = 1e-9;

/// Everything a run needs, in scaled coordinates but for the extent.
struct Problem<'a> {
    data: PointsView<'a>,
    scale: PowerOfTwoScale,
    extent: Extent,
    parameters: Parameters,
    knots: KnotVector,
}

/// Share of the extent that a residual may keep by default.
const DEFAULT_RESIDUAL: f64 = 1e-12;

fn solve(
    problem: Problem<'_>,
    options: &CurveOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let Problem { data, scale, extent, parameters, knots } = problem;
    let Interpolation { operator, layout } = interpolation(&parameters, &knots)?;
    let dimension = data.dimension();
    let gradual = options.keep.iter().copied().max().unwrap_or(0).min(options.iterations);
    let ChosenRule { mut rule, name, mut choices, smallest_eigenvalue } =
        choose(options.method, &options.weight, &operator, dimension, gradual)?;

    let rounding_level = ROUNDING * scale.up(extent.largest_coordinate());
    let stopping = stopping(options, scale, &extent, rounding_level, &mut choices)?;
    let mut state = IterationState::begin(&operator, data.coordinates(), dimension);
    let mut keeper = Keeper::new(&options.keep, layout, dimension, observer);
    let outcome = run(&mut state, rule.as_mut(), stopping, &mut keeper);
    let sequence = keeper.finish(scale, &outcome, &mut choices)?;
    let Outcome { termination, iterations, mut history } = outcome;

    let norms = state.norms();
    // Every control point has its part in a difference vector, so these tell of all of them.
    if !norms.is_finite() {
        return Err(Error::LeavesDoubles);
    }
    let reached_rounding = state.rounding_level();
    let iteration_returned = state.iteration();
    let (control, vectors) = state.into_parts();
    drop(rule);
    drop(operator);
    if termination == Termination::Residual && norms.max > stopping.residual {
        choices.push(format!(
            "residual: {:e}, what rounding leaves with control points this large",
            scale.undo(reached_rounding)
        ));
    }

    let swing = reached_rounding / (ROUNDING * scale.up(extent.diagonal()));
    if swing > WILD_SWING && reached_rounding > WILD_SWING * rounding_level {
        choices.push(format!(
            "caution: control points reach {swing:.0e} times the extent of the data; this \
             interpolant swings wildly between points spaced so unevenly: lower the degree, or use \
             centripetal parameters"
        ));
    }

    let (parameters, spacing_ratio) = finish_parameters(parameters, &knots, layout);
    let stored = Points::new(dimension, layout.expand(control, dimension))?;
    let curve = Curve::new(knots, stored)?;
    let (max_deviation, max_deviation_index) = if norms.max <= rounding_level {
        // Down there a foot point is decided by rounding; the residual bounds the distance.
        (norms.max, norms.max_index)
    } else {
        let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
        largest_deviation(&curve, data, &parameters, &residuals)?
    };
    let curve = unscale(curve, scale)?;
    let difference_vectors = unscaled(Points::new(dimension, vectors)?, scale)?;
    for entry in &mut history {
        entry.max_residual = scale.undo(entry.max_residual);
        entry.rms_residual = scale.undo(entry.rms_residual);
    }
    let report = CurveReport {
        points: data.len(),
        control_points: curve.control_points().len(),
        degree: curve.degree(),
        dimension,
        closed: curve.is_periodic(),
        parameterization: "given",
        knot_placement: "given",
        method: name,
        choices,
        iterations,
        iteration_returned,
        termination,
        residual_target: scale.undo(stopping.residual),
        extent: extent.diagonal(),
        max_residual: scale.undo(norms.max),
        max_residual_index: norms.max_index,
        rms_residual: scale.undo(norms.rms),
        max_deviation: scale.undo(max_deviation),
        max_deviation_index,
        smallest_eigenvalue,
        spacing_ratio,
        history,
    };
    Ok(CurveFit { curve, parameters, kept_points: None, difference_vectors, report, sequence })
}

fn stopping(
    options: &CurveOptions,
    scale: PowerOfTwoScale,
    extent: &Extent,
    rounding_level: f64,
    choices: &mut Vec<String>,
) -> Result<Stopping, Error> {
    let residual = match options.residual {
        Some(residual) if residual >= 0.0 && residual.is_finite() => scale.up(residual),
        Some(value) => {
            return Err(Error::OutOfRange {
                what: "residual".into(),
                value,
                rule: "it must be 0 or more, and finite",
            });
        }
        None => {
            let share = DEFAULT_RESIDUAL * scale.up(extent.diagonal());
            if share < rounding_level {
                choices.push(format!(
                    "residual: {:e}, what rounding of the coordinates allows; 1e-12 of the extent \
                     would be less",
                    scale.undo(rounding_level)
                ));
            }
            share.max(rounding_level)
        }
    };
    Ok(Stopping {
        residual,
        max_iterations: options.iterations,
        accept_rounding: if options.residual.is_none() {
            residual.max(MOST_ROUNDING * scale.up(extent.diagonal()))
        } else {
            0.0
        },
    })
}

/// The parameters as stored with a curve, and the longest step over the shortest.
fn finish_parameters(
    parameters: Parameters,
    knots: &KnotVector,
    layout: ControlLayout,
) -> (Vec<f64>, f64) {
    let period = parameters.period();
    let mut values = parameters.into_values();
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
    if matches!(layout, ControlLayout::Periodic { .. }) {
        let period = period.unwrap_or_default();
        values.iter_mut().for_each(|t| *t = wrap(*t, knots.domain(), period));
    }
    (values, longest / shortest)
}

fn unscale(curve: Curve, scale: PowerOfTwoScale) -> Result<Curve, Error> {
    let knots = curve.knots().clone();
    if scale.is_identity() {
        return Ok(curve);
    }
    Curve::new(knots, unscaled(curve.control_points().clone(), scale)?)
}

/// Brings control points back into the unit of the data.
pub(super) fn unscaled(points: Points, scale: PowerOfTwoScale) -> Result<Points, Error> {
    if scale.is_identity() {
        return Ok(points);
    }
    let dimension = points.dimension();
    let mut coordinates = points.into_coordinates();
    scale.undo_in_place(&mut coordinates);
    if coordinates.iter().any(|x| !x.is_finite()) {
        return Err(Error::LeavesDoubles);
    }
    Points::new(dimension, coordinates)
}

fn norm(vector: &[f64]) -> f64 {
    let square: f64 = vector.iter().map(|x| x * x).sum();
    if square.is_normal() && square.is_finite() {
        return square.sqrt();
    }
    vector.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}

fn parameterization_name(parameterization: &Parameterization) -> &'static str {
    match parameterization {
        Parameterization::Chord => "chord",
        Parameterization::Centripetal => "centripetal",
        Parameterization::Uniform => "uniform",
        Parameterization::ChordRatio => "chord-ratio",
        Parameterization::Given(_) => "given",
    }
}

fn placement_name(placement: &KnotPlacement) -> &'static str {
    match placement {
        KnotPlacement::Averaged => "averaged",
        KnotPlacement::NotAKnot => "not-a-knot",
        KnotPlacement::AtData => "at-data",
        KnotPlacement::Uniform => "uniform",
        KnotPlacement::Given(_) => "given",
    }
}
