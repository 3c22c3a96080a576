//! Least squares curves with given knots and parameters, by the LSPIA family.

mod constrain;
mod method;
mod options;
mod place;
mod surface;

pub use options::{LeastSquaresKnots, LeastSquaresMethod, LeastSquaresOptions, LeastSquaresWeight};

pub use surface::{LeastSquaresSurfaceOptions, fit_least_squares_surface};

use super::curve::{parameterization_name, unscale};
use super::prepare::{check_extent, open_up};
use super::solve::{Size, Solved, Task, norm, solve_from, unscaled};
use super::{CurveFit, KeptFit};
use crate::Error;
use crate::collocation::{ControlLayout, LeastSquaresCollocation};
use crate::geometry::Curve;
use crate::iteration::{NoObserver, Observer};
use crate::knots::{Boundary, KnotVector, check_degree};
use crate::memory;
use crate::parameters::Parameterization;
use crate::points::{Extent, Points, PointsView};
use crate::projection::largest_deviation;
use crate::report::{CurveReport, RunReport};
use method::{Setting, choose};
use place::Sites;

/// Fits a B-spline curve with fewer control points than data points, so that the sum of the squares of
/// the difference vectors at given parameters is smallest: least-squares progressive-iterative
/// approximation (LSPIA, Deng and Lin 2014) and its relatives.
///
/// Where the data leave control points free, because they have a gap or are too few, the limit is the
/// least squares fit nearest the start (singular LSPIA, Lin, Cao and Zhang 2018).
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`]. A run that does not reach its limit is
/// no error: look at [`RunReport::termination`](crate::RunReport::termination) and
/// [`RunReport::rate`](crate::RunReport::rate).
///
/// # Examples
/// ```
/// use gimfit::{LeastSquaresOptions, fit_least_squares};
/// let points: Vec<[f64; 2]> = (0..200)
///     .map(|i| {
///         let x = f64::from(i) / 20.0;
///         [x, x.sin() + 0.01 * f64::from(i % 7)]
///     })
///     .collect();
/// let fit = fit_least_squares(&points, &LeastSquaresOptions::with_control_points(12))?;
/// assert!(fit.report.converged());
/// assert_eq!(fit.curve.control_points().len(), 12);
/// assert!(fit.report.run.rms_residual < 0.03);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_least_squares<'a>(
    points: impl Into<PointsView<'a>>,
    options: &LeastSquaresOptions,
) -> Result<CurveFit, Error> {
    fit_least_squares_observed(points, options, &mut NoObserver)
}

/// As [`fit_least_squares`], watched step by step; what the observer sees is scaled as in
/// [`fit_curve_observed`](super::fit_curve_observed).
///
/// # Errors
/// As [`fit_least_squares`].
pub fn fit_least_squares_observed<'a>(
    points: impl Into<PointsView<'a>>,
    options: &LeastSquaresOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let all = points.into();
    check_degree(options.degree)?;
    let needed = options.degree + 1;
    if all.is_empty() {
        return Err(Error::NoPoints { needed });
    }
    let size = Size::of(Extent::of(all)?);
    check_extent(&size.extent)?;
    let mut choices = Vec::new();
    let parameterization = parameterization(all, options, &mut choices);
    if size.extent.diagonal() == 0.0 && all.len() > 1 && parameterization.needs_distinct_points() {
        return Err(Error::AllPointsEqual { points: all.len() });
    }
    let diagonal = size.extent.diagonal();
    let points = open_up(all, diagonal, options.closed, &parameterization, &mut choices)?;
    let (count, dimension) = (points.len(), points.dimension());
    if count < needed {
        return Err(Error::TooFewPoints { points: count, degree: options.degree, needed });
    }
    let data = size.scale.apply(points.coordinates());
    let view = PointsView::new(dimension, &data)?;
    let sites = Sites::new(view, options.closed, &parameterization)?;
    let knots = sites.knots(options)?;
    let placed = matches!(options.knots, LeastSquaresKnots::ControlPoints(_));
    if placed {
        choices.push("knots: about as many data points in every span".into());
    }
    let problem = Problem {
        given: all.len(),
        data: view,
        size,
        sites,
        knots,
        placed,
        side_by_side: 1,
        choices,
    };
    let mut fit = fit_problem(problem, options, observer)?;
    fit.report.parameterization = parameterization_name(&parameterization);
    fit.kept_points = (count < all.len()).then(|| (0..count).collect());
    Ok(fit)
}

/// As [`fit_least_squares`] at parameters and over knots that are already known; those of a closed
/// curve are periodic. Parameters lie in the domain, in any order. Of the options, those on weights,
/// ends, start, method and stopping count.
///
/// # Errors
/// As [`fit_least_squares`].
pub fn least_squares<'a>(
    points: impl Into<PointsView<'a>>,
    parameters: Vec<f64>,
    knots: KnotVector,
    options: &LeastSquaresOptions,
) -> Result<CurveFit, Error> {
    let points = points.into();
    if points.len() != parameters.len() {
        return Err(Error::WrongCount {
            what: "parameters",
            given: parameters.len(),
            expected: points.len(),
            why: "one per point",
        });
    }
    if points.is_empty() {
        return Err(Error::NoPoints { needed: 1 });
    }
    let size = Size::of(Extent::of(points)?);
    check_extent(&size.extent)?;
    let data = size.scale.apply(points.coordinates());
    let problem = Problem {
        given: points.len(),
        data: PointsView::new(points.dimension(), &data)?,
        size,
        sites: Sites::over(parameters, &knots)?,
        knots,
        placed: false,
        side_by_side: 1,
        choices: Vec::new(),
    };
    fit_problem(problem, options, &mut NoObserver)
}

/// Everything a run needs; the data are scaled.
struct Problem<'a> {
    /// Points given, a repeated closing one included.
    given: usize,
    data: PointsView<'a>,
    size: Size,
    sites: Sites,
    knots: KnotVector,
    /// Whether the knots were placed by the parameters.
    placed: bool,
    /// Points that a row of the data holds.
    side_by_side: usize,
    choices: Vec<String>,
}

fn fit_problem(
    problem: Problem<'_>,
    options: &LeastSquaresOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let (view, size, placed) = (problem.data, problem.size.clone(), problem.placed);
    let (data, count, dimension) = (view.coordinates(), view.len(), view.dimension());
    let knots = problem.knots.clone();
    let spacing_ratio = problem.sites.spacing_ratio();
    let outcome = solve_problem(problem, options, observer)?;
    let DirectionOutcome { operator, layout, control, parameters, run, sequence } = outcome;
    let mut vectors = memory::zeros(data.len());
    let norms = operator.at_data(data, &control, dimension, &mut vectors);
    let degree = knots.degree();
    let curve = Curve::new(knots, Points::new(dimension, layout.expand(control, dimension))?)?;
    let (max_deviation, max_deviation_index) = if norms.max <= size.rounding_level() {
        (norms.max, norms.max_index)
    } else {
        let mut residuals = memory::with_capacity(count);
        residuals.extend(vectors.chunks_exact(dimension).map(norm));
        if options.data_weights.is_some() {
            // Points that do not count are not looked at.
            (0..count).filter(|&j| operator.data_weight(j) == 0.0).for_each(|j| residuals[j] = 0.0);
        }
        largest_deviation(&curve, view, &parameters, &residuals)?
    };
    let curve = unscale(curve, size.scale)?;
    let report = CurveReport {
        points: count,
        control_points: curve.control_points().len(),
        degree,
        dimension,
        closed: curve.is_periodic(),
        parameterization: "given",
        knot_placement: if placed { "least-squares" } else { "given" },
        spacing_ratio,
        shape: None,
        run,
        approximation: None,
        max_residual_index: norms.max_index,
        max_deviation: size.scale.undo(max_deviation),
        max_deviation_index,
    };
    Ok(CurveFit {
        curve,
        parameters,
        kept_points: None,
        difference_vectors: unscaled(Points::new(dimension, vectors)?, size.scale)?,
        report,
        sequence,
    })
}

/// A run that has ended. Control points that move are scaled still; the report is in the unit of the
/// data.
struct DirectionOutcome {
    operator: LeastSquaresCollocation,
    layout: ControlLayout,
    control: Vec<f64>,
    /// Inside the domain.
    parameters: Vec<f64>,
    run: RunReport,
    sequence: Vec<KeptFit>,
}

/// Builds the operator and runs the method.
fn solve_problem(
    problem: Problem<'_>,
    options: &LeastSquaresOptions,
    observer: &mut dyn Observer,
) -> Result<DirectionOutcome, Error> {
    let Problem { given, data: view, size, mut sites, knots, placed, side_by_side, mut choices } =
        problem;
    let (data, count, dimension) = (view.coordinates(), view.len(), view.dimension());
    let mut start = start(options, &sites, &size, data, dimension, &knots, placed)?;
    let columns = start.len() / dimension;
    let ends = sites.ends();
    sites.bring_inside(&knots);
    let mut operator =
        LeastSquaresCollocation::new(&sites.values, &knots)?.with_points_side_by_side(side_by_side);
    if let Some(weights) = &options.data_weights {
        if weights.len() != given {
            return Err(wrong_weights(weights.len(), given));
        }
        operator = operator.with_data_weights(&weights[..count])?;
    }
    if options.hold_ends {
        check_ends(&knots)?;
        operator = operator.with_held(&[0, columns - 1]);
        let ends = ends.map(|j| &data[j * dimension..][..dimension]);
        start[..dimension].copy_from_slice(ends[0]);
        start[(columns - 1) * dimension..].copy_from_slice(ends[1]);
    }
    if options.method == LeastSquaresMethod::Extended {
        operator = operator.grouped();
    }
    let unmet = operator.unmet();
    if unmet > 0 {
        choices.push(format!(
            "caution: {unmet} of {columns} control points are met by no data point and stay where \
             they start"
        ));
    }
    let normal = operator.normal_matrix();
    let setting = Setting {
        operator: &operator,
        normal: &normal,
        data,
        dimension,
        weight: options.weight,
        seed: options.seed,
        gradual: options.keep.iter().copied().max().unwrap_or(0).min(options.iterations),
        coupled: !options.constraints.is_empty(),
    };
    let mut chosen = choose(options.method, &setting)?;
    let constrained = constrain::constrained(
        options,
        &constrain::Setting {
            operator: &operator,
            normal: &normal,
            data,
            dimension,
            parameters: &sites.values,
            knots: &knots,
            size: &size,
        },
        &mut start,
    )?;
    let stopping = size.stopping(options.residual, options.iterations, &mut choices)?;
    choices.append(&mut chosen.choices);
    chosen.choices = choices;
    let layout = match knots.boundary() {
        Boundary::Open => ControlLayout::Free,
        Boundary::Periodic => ControlLayout::Periodic { shift: 0, degree: knots.degree() },
    };
    let expand = |control| layout.expand(control, dimension);
    let task = Task {
        operator: constrained.as_ref().map_or(&operator as _, |constrained| constrained as _),
        data,
        dimension,
        size: &size,
        stopping,
        keep: &options.keep,
        expand: &expand,
        foot_points: None,
    };
    let Solved { mut control, mut run, sequence, .. } =
        solve_from(&task, &start, &mut chosen, observer)?;
    drop(chosen);
    if let Some(constrained) = &constrained {
        // Steps keep the constraints but for rounding.
        constrained.make_feasible(&mut control, dimension);
        run.choices.push(format!(
            "constraints: met within {:.1e}",
            size.scale.undo(constrained.residual(&control))
        ));
    }
    drop(constrained);
    if let Some(account) = &mut run.least_squares {
        account.unmet_control_points = unmet;
    }
    Ok(DirectionOutcome { operator, layout, control, parameters: sites.values, run, sequence })
}

/// The parameterization asked for, or the default.
fn parameterization(
    points: PointsView<'_>,
    options: &LeastSquaresOptions,
    choices: &mut Vec<String>,
) -> Parameterization {
    match &options.parameterization {
        Some(parameterization) => parameterization.clone(),
        None if points.dimension() == 1 => {
            choices
                .push("parameters: uniform, because values of dimension 1 have no chords".into());
            Parameterization::Uniform
        }
        None => {
            choices.push("parameters: chord length".into());
            Parameterization::Chord
        }
    }
}

/// Where the control points start, scaled.
fn start(
    options: &LeastSquaresOptions,
    sites: &Sites,
    size: &Size,
    data: &[f64],
    dimension: usize,
    knots: &KnotVector,
    placed: bool,
) -> Result<Vec<f64>, Error> {
    let own = sites.start(data, dimension, knots, placed);
    let Some(given) = &options.start else { return Ok(own) };
    let view = PointsView::from(given);
    if view.dimension() != dimension {
        return Err(Error::WrongCount {
            what: "coordinates per control point of the start",
            given: view.dimension(),
            expected: dimension,
            why: "the dimension of the data",
        });
    }
    if view.len() * dimension != own.len() {
        return Err(Error::WrongCount {
            what: "control points of the start",
            given: view.len(),
            expected: own.len() / dimension,
            why: "one per control point that moves",
        });
    }
    Extent::of(view)?;
    Ok(size.scale.apply(view.coordinates()).into_owned())
}

/// Ends are held on open curves that begin and end at their control points.
fn check_ends(knots: &KnotVector) -> Result<(), Error> {
    if knots.boundary() == Boundary::Periodic {
        return Err(Error::Incompatible {
            what: "held ends",
            with: "a closed curve",
            why: "it has no ends",
        });
    }
    let values = knots.values();
    let (start, end) = knots.domain();
    if values[0] == start && values[values.len() - 1] == end {
        return Ok(());
    }
    Err(Error::Incompatible {
        what: "held ends",
        with: "these knots",
        why: "the curve begins and ends at its control points only where the end knots stand degree + 1 \
              times",
    })
}

fn wrong_weights(given: usize, expected: usize) -> Error {
    Error::WrongCount { what: "data weights", given, expected, why: "one per point" }
}
