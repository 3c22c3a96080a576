//! Interpolation of a grid of points by a tensor-product B-spline surface.

use super::curve::{finish_parameters, parameterization_name, placement_name};
use super::geometric::{self, Net, Pairs};
use super::method::choose_adaptive;
use super::rational::{fitted_weights, separate};
use super::solve::{Size, Solved, Task, norm, solve, unscaled};
use super::surface_method::{Directions, choose_across, choose_along, choose_both};
use super::{IterationWeight, KeptFit, Method, SurfaceOptions, SurfaceWeight};
use crate::Error;
use crate::collocation::{
    AcrossCollocation, AlongCollocation, CollocationOperator, Interpolation, NetLayout, NetWeights,
    RationalTensorCollocation, TensorCollocation, interpolation,
};
use crate::geometry::Surface;
use crate::iteration::update::AdaptiveRows;
use crate::iteration::{HistoryEntry, NoObserver, Observer, Stopping, Termination};
use crate::knots::{KnotPlacement, KnotVector, place_knots};
use crate::parameters::{Parameterization, Parameters, assign_grid_parameters};
use crate::points::{Extent, GridView, PointGrid, Points};
use crate::projection::{largest_surface_deviation, largest_surface_deviation_from};
use crate::report::{RunReport, SurfaceReport};
use std::borrow::Cow;

/// A fitted surface and the account of how it came about.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFit {
    /// The surface.
    pub surface: Surface,
    /// Parameters of the rows (u) and of the columns (v) of points, inside the surface's domain.
    pub parameters: [Vec<f64>; 2],
    /// Parameters (u, v) of every point, row by row, where geometric interpolation left each with its
    /// own; `None` where they are those of its row and column.
    pub foot_parameters: Option<Vec<[f64; 2]>>,
    /// Difference vectors `Q_ij - S(u_i, v_j)`, row by row; at `foot_parameters` where there are any.
    pub difference_vectors: Points,
    /// What happened.
    pub report: SurfaceReport,
    /// Fits kept on the way, with the net of each row by row.
    pub sequence: Vec<KeptFit>,
}

impl SurfaceFit {
    /// Norm of the difference vector at each point, row by row.
    #[must_use]
    pub fn residuals(&self) -> Vec<f64> {
        self.difference_vectors.iter().map(norm).collect()
    }
}

/// Fits a B-spline surface through a grid of points by progressive-iterative approximation.
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`]. A run that does not reach its
/// residual is no error: look at [`RunReport::termination`](crate::RunReport::termination).
///
/// # Examples
/// ```
/// use gimfit::points::GridView;
/// use gimfit::{SurfaceOptions, fit_surface};
/// let mut points = Vec::new();
/// for i in 0..8 {
///     for j in 0..6 {
///         let (x, y) = (f64::from(i), f64::from(j));
///         points.extend([x, y, (0.5 * x).sin() * y]);
///     }
/// }
/// let fit = fit_surface(GridView::new([8, 6], 3, &points)?, &SurfaceOptions::default())?;
/// assert!(fit.report.converged());
/// let corner = fit.surface.evaluate(0.0, 0.0)?;
/// assert_eq!(corner, [0.0, 0.0, 0.0]);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_surface(grid: GridView<'_>, options: &SurfaceOptions) -> Result<SurfaceFit, Error> {
    fit_surface_observed(grid, options, &mut NoObserver)
}

/// As [`fit_surface`], watched step by step, as [`fit_curve_observed`](super::fit_curve_observed).
///
/// # Errors
/// As [`fit_surface`].
pub fn fit_surface_observed(
    grid: GridView<'_>,
    options: &SurfaceOptions,
    observer: &mut dyn Observer,
) -> Result<SurfaceFit, Error> {
    let needed = options.degrees.map(|p| p.saturating_add(1));
    if grid.points().is_empty() {
        return Err(Error::NoPoints { needed: needed[0].saturating_mul(needed[1]) });
    }
    let size = Size::of(Extent::of(grid.points())?);
    let mut choices = Vec::new();
    let (shape, data) = open_up(grid, &size, options, &mut choices);
    let dimension = grid.dimension();
    let data = size.scale.apply(&data);
    let view = GridView::new(shape, dimension, &data)?;
    let mut u = direction(view, 0, options, &mut choices)?;
    let mut v = direction(view, 1, options, &mut choices)?;
    let given = grid.shape();
    let rational_weights = fitted_weights(
        options.rational_weights.as_deref(),
        given[0] * given[1],
        shape[0] * shape[1],
        |j| j / shape[1] * given[1] + j % shape[1],
    )?;
    let parts = rational_weights.as_deref().map(|weights| separate(weights, shape[1]));
    if let Some(Some([of_rows, of_columns])) = &parts {
        choices.push("rational weights: a product of weights of rows and of columns".into());
        u.built.operator.weigh(of_rows);
        v.built.operator.weigh(of_columns);
    }
    let net = rational_weights
        .clone()
        .filter(|_| parts == Some(None))
        .map(|weights| NetWeights::new(&u.built.operator, &v.built.operator, weights));

    let directions =
        Directions { u: &u.built.operator, v: &v.built.operator, rational: net.as_ref() };
    let layout = NetLayout { u: u.built.layout, v: v.built.layout, columns: shape[1] };
    let expand = |control| layout.expand(control, dimension);
    let stopping = size.stopping(options.residual, options.iterations, &mut choices)?;
    let setting = Setting { view, size: &size, directions, options, stopping, expand: &expand };
    let geometric = matches!(options.method, Method::Geometric { .. }) && !options.per_direction;
    let ((mut solved, stages), foot_parameters) = if geometric {
        let net = Net {
            directions: [directions.u, directions.v],
            layout,
            knots: [&u.knots, &v.knots],
            parameters: [&u.parameters, &v.parameters],
            rational_weights: rational_weights.as_deref(),
            rational: directions.rational,
        };
        let (solved, pairs) = at_foot_points(&setting, net, observer)?;
        ((solved, None), pairs)
    } else {
        (run_net(&setting, observer)?, None)
    };
    choices.append(&mut solved.run.choices);
    solved.run.choices = choices;

    let finish = |direction: &Direction, parameters: Parameters| {
        finish_parameters(parameters, &direction.knots, direction.built.layout)
    };
    let (t_u, ratio_u) = finish(&u, u.parameters.clone());
    let (t_v, ratio_v) = finish(&v, v.parameters.clone());
    let knots = [u.knots.clone(), v.knots.clone()];
    let net_shape = knots.each_ref().map(KnotVector::control_points);
    let net = PointGrid::new(net_shape, dimension, expand(solved.control))?;
    let surface = match rational_weights {
        None => Surface::new(knots, net)?,
        Some(weights) => Surface::rational(knots, net, layout.expand(weights, 1))?,
    };
    let norms = solved.norms;
    let (max_deviation, deviation_index) = if norms.max <= size.rounding_level() {
        // Down there a foot point is decided by rounding; the residual bounds the distance.
        (norms.max, norms.max_index)
    } else {
        let residuals: Vec<f64> = solved.vectors.chunks_exact(dimension).map(norm).collect();
        let points = view.points();
        match &foot_parameters {
            Some(pairs) => largest_surface_deviation_from(&surface, points, pairs, &residuals)?,
            None => largest_surface_deviation(&surface, points, [&t_u, &t_v], &residuals)?,
        }
    };
    let scale = size.scale;
    let cell = |index: usize| [index / shape[1], index % shape[1]];
    let surface = if scale.is_identity() {
        surface
    } else {
        let net = unscaled(surface.control_net().points().clone(), scale)?;
        let net = PointGrid::new(net_shape, dimension, net.into_coordinates())?;
        surface.with_control_net(net)?
    };
    let report = SurfaceReport {
        points: shape,
        control_points: net_shape,
        degrees: options.degrees,
        dimension,
        closed: options.closed,
        parameterizations: [u.parameterization, v.parameterization],
        knot_placements: [u.knot_placement, v.knot_placement],
        spacing_ratios: [ratio_u, ratio_v],
        per_direction: options.per_direction,
        run: solved.run,
        stages,
        max_residual_index: cell(norms.max_index),
        max_deviation: scale.undo(max_deviation),
        max_deviation_index: cell(deviation_index),
    };
    Ok(SurfaceFit {
        surface,
        parameters: [t_u, t_v],
        foot_parameters,
        difference_vectors: unscaled(Points::new(dimension, solved.vectors)?, scale)?,
        report,
        sequence: solved.sequence,
    })
}

/// A last row or column this close to the first, in units of the extent, repeats it.
const CLOSING_GAP: f64 = 1e-9;

/// The grid without the repetition of its first row or column in closed directions.
pub(super) fn open_up<'a>(
    grid: GridView<'a>,
    size: &Size,
    options: &SurfaceOptions,
    choices: &mut Vec<String>,
) -> ([usize; 2], Cow<'a, [f64]>) {
    let [mut rows, mut columns] = grid.shape();
    let limit = CLOSING_GAP * size.extent.diagonal();
    let near = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).fold(0.0, |sum: f64, (a, b)| sum.hypot(a - b)) <= limit
    };
    let given = |k: usize| matches!(options.parameterizations[k], Some(Parameterization::Given(_)));
    // Parameters that are given count the closing row in, or not; the caller knows.
    if options.closed[0] && rows > 1 && !given(0) {
        let repeats = (0..columns).all(|j| near(grid.point(0, j), grid.point(rows - 1, j)));
        if repeats {
            choices.push("closing: the last row repeats the first and is taken as the seam".into());
            rows -= 1;
        }
    }
    if options.closed[1] && columns > 1 && !given(1) {
        let repeats = (0..rows).all(|i| near(grid.point(i, 0), grid.point(i, columns - 1)));
        if repeats {
            choices
                .push("closing: the last column repeats the first and is taken as the seam".into());
            columns -= 1;
        }
    }
    let given = grid.points().coordinates();
    let (line, kept) = (grid.shape()[1] * grid.dimension(), columns * grid.dimension());
    let coordinates = if line == kept {
        // Whole rows lie one after another.
        Cow::Borrowed(&given[..rows * line])
    } else {
        Cow::Owned(
            given.chunks_exact(line).take(rows).flat_map(|row| &row[..kept]).copied().collect(),
        )
    };
    ([rows, columns], coordinates)
}

/// What one direction brings along.
pub(super) struct Direction {
    pub(super) parameters: Parameters,
    knots: KnotVector,
    pub(super) built: Interpolation,
    parameterization: &'static str,
    knot_placement: &'static str,
}

pub(super) fn direction(
    view: GridView<'_>,
    k: usize,
    options: &SurfaceOptions,
    choices: &mut Vec<String>,
) -> Result<Direction, Error> {
    let name = ["u", "v"][k];
    let degree = options.degrees[k];
    let count = view.shape()[k];
    if count < degree.saturating_add(1) {
        return Err(Error::TooFewLines {
            what: ["rows", "columns"][k],
            count,
            degree,
            needed: degree.saturating_add(1),
        });
    }
    let parameterization = match &options.parameterizations[k] {
        Some(parameterization) => parameterization.clone(),
        None if view.dimension() == 1 => {
            choices.push(format!("parameters in {name}: uniform, because heights have no chords"));
            Parameterization::Uniform
        }
        None => {
            choices.push(format!("parameters in {name}: chord lengths, averaged over the grid"));
            Parameterization::Chord
        }
    };
    let parameters = assign_grid_parameters(view, k, options.closed[k], &parameterization)
        .map_err(|error| error.in_lines(["row", "column"][k]))?;
    let placement = options.knot_placements[k].clone().unwrap_or_else(|| {
        choices.push(format!("knots in {name}: averaged, because they fit any parameters"));
        KnotPlacement::Averaged
    });
    let knots = place_knots(degree, &parameters, &placement)?;
    let built = interpolation(&parameters, &knots)?;
    Ok(Direction {
        parameters,
        knots,
        built,
        parameterization: parameterization_name(&parameterization),
        knot_placement: placement_name(&placement),
    })
}

/// Everything the two ways of running share.
pub(super) struct Setting<'a> {
    pub(super) view: GridView<'a>,
    pub(super) size: &'a Size,
    pub(super) directions: Directions<'a>,
    /// Only method, weight, order, iterations and kept fits count.
    pub(super) options: &'a SurfaceOptions,
    pub(super) stopping: Stopping,
    pub(super) expand: &'a dyn Fn(Vec<f64>) -> Vec<f64>,
}

/// Runs the rule on the net, in the order the options say.
pub(super) fn run_net(
    setting: &Setting<'_>,
    observer: &mut dyn Observer,
) -> Result<(Solved, Option<Stages>), Error> {
    if setting.options.per_direction {
        per_direction(setting, observer).map(|(solved, stages)| (solved, Some(stages)))
    } else {
        at_once(setting, observer).map(|solved| (solved, None))
    }
}

/// The histories of the columns, then of the rows.
pub(super) type Stages = [Vec<HistoryEntry>; 2];

impl<'a> Setting<'a> {
    fn task(&self, operator: &'a dyn CollocationOperator, data: &'a [f64]) -> Task<'a> {
        Task {
            operator,
            data,
            dimension: self.view.dimension(),
            size: self.size,
            stopping: self.stopping,
            keep: &[],
            expand: self.expand,
        }
    }
}

/// Moves the whole net in every step: the iterates of the 2004 paper, for PIA.
fn at_once(setting: &Setting<'_>, observer: &mut dyn Observer) -> Result<Solved, Error> {
    let (options, directions) = (setting.options, setting.directions);
    let dimension = setting.view.dimension();
    let gradual = options.keep.iter().copied().max().unwrap_or(0).min(options.iterations);
    let weight = one_weight(options)?;
    let mut chosen = if options.method == Method::Adaptive {
        let Directions { u, v, rational } = directions;
        if rational.is_some() {
            return Err(Error::Incompatible {
                what: "adaptive",
                with: "rational weights of a net",
                why: "its bound is that of polynomial surfaces; use another method",
            });
        }
        let rows = AdaptiveRows::Grid([u, v]);
        choose_adaptive(rows, weight, setting.view.points().len(), setting.stopping.residual)?
    } else {
        choose_both(options.method, weight, directions, dimension, gradual)?
    };
    let operator = tensor(directions, dimension);
    let data = setting.view.points().coordinates();
    let task = Task { keep: &options.keep, ..setting.task(&*operator, data) };
    solve(&task, &mut chosen, observer)
}

/// The operator of a net that moves as a whole.
fn tensor<'a>(directions: Directions<'a>, dimension: usize) -> Box<dyn CollocationOperator + 'a> {
    let Directions { u, v, rational } = directions;
    match rational {
        None => Box::new(TensorCollocation::new(u, v, dimension)),
        Some(net) => Box::new(RationalTensorCollocation::new(u, v, net, dimension)),
    }
}

/// Moves the whole net by the vectors from its foot points.
fn at_foot_points(
    setting: &Setting<'_>,
    net: Net<'_>,
    observer: &mut dyn Observer,
) -> Result<(Solved, Option<Pairs>), Error> {
    let (options, directions) = (setting.options, setting.directions);
    let operator = tensor(directions, setting.view.dimension());
    let data = setting.view.points().coordinates();
    let task = Task { keep: &options.keep, ..setting.task(&*operator, data) };
    geometric::solve_surface(&task, options.method, one_weight(options)?, net, observer)
}

/// The weight of a net that moves as a whole.
fn one_weight(options: &SurfaceOptions) -> Result<&IterationWeight, Error> {
    match &options.weight {
        SurfaceWeight::Both(weight) => Ok(weight),
        SurfaceWeight::PerDirection(_) => Err(Error::Incompatible {
            what: "a weight for each direction",
            with: "both directions at once",
            why: "a net that moves as a whole has one weight; run one direction after the other",
        }),
    }
}

/// Runs the columns to their limit, then the rows: the same limit in far fewer steps, since no step
/// has to serve both directions.
fn per_direction(
    setting: &Setting<'_>,
    observer: &mut dyn Observer,
) -> Result<(Solved, Stages), Error> {
    let (options, directions) = (setting.options, setting.directions);
    if directions.rational.is_some() {
        return Err(Error::Incompatible {
            what: "these rational weights",
            with: "one direction after the other",
            why: "they are no product of weights of rows and weights of columns; run both directions \
                  at once",
        });
    }
    if !options.keep.is_empty() {
        return Err(Error::Incompatible {
            what: "keeping fits of the way",
            with: "one direction after the other",
            why: "half way through, the net is no fit of the grid; run both directions at once",
        });
    }
    let weights = match &options.weight {
        SurfaceWeight::Both(IterationWeight::PerPoint(_)) => {
            return Err(Error::Incompatible {
                what: "a weight per point",
                with: "one direction after the other",
                why: "a point has no weight of its own in a direction; give one per row and one per \
                      column, or run both directions at once",
            });
        }
        SurfaceWeight::Both(weight) => [weight, weight],
        SurfaceWeight::PerDirection(weights) => weights.each_ref(),
    };
    let dimension = setting.view.dimension();
    let data = setting.view.points().coordinates();
    let both = TensorCollocation::new(directions.u, directions.v, dimension);
    // What is left of the first run adds to what is left of the second.
    let mut stopping = setting.stopping;
    stopping.residual *= 0.5;
    let across = AcrossCollocation::new(directions.u, directions.v.points());
    let along = AlongCollocation::new(directions.v, directions.u.points());
    let mut work = vec![0.0; data.len()];
    let before = both.difference_vectors(data, data, dimension, &mut work);

    let method = options.method;
    let mut in_u = choose_across(method, weights[0], directions, dimension)?;
    let task = Task { stopping, ..setting.task(&across, data) };
    let first = solve(&task, &mut in_u, observer)?;
    let mut in_v = choose_along(method, weights[1], directions, dimension)?;
    let task = Task { stopping, ..setting.task(&along, &first.control) };
    let second = solve(&task, &mut in_v, observer)?;

    let norms = both.difference_vectors(data, &second.control, dimension, &mut work);
    let (first, second_run) = (first.run, second.run);
    let iterations = first.iterations + second_run.iterations;
    let endings = [first.termination, second_run.termination];
    let termination = overall(endings, norms.max, setting.stopping);
    let undo = |x: f64| setting.size.scale.undo(x);
    let entry = |iteration, norms: crate::collocation::ResidualNorms| HistoryEntry {
        iteration,
        max_residual: undo(norms.max),
        rms_residual: undo(norms.rms),
    };
    let stage = |run: &RunReport| {
        let start = run.history.first().map_or(0.0, |entry| entry.max_residual);
        format!("{} steps from {start:.2e} to {:.2e}", run.iterations, run.max_residual)
    };
    let mut choices = vec![format!(
        "directions: one after the other, each line a curve: the columns in u, {}, then the rows of \
         what that gave in v, {}",
        stage(&first),
        stage(&second_run)
    )];
    for (name, list) in [("u", &first.choices), ("v", &second_run.choices)] {
        choices.extend(list.iter().map(|choice| format!("{choice} (in {name})")));
    }
    let eigenvalues = first.smallest_eigenvalue.zip(second_run.smallest_eigenvalue);
    let run = RunReport {
        updates: None,
        local: None,
        choices,
        method: second_run.method,
        extent: second_run.extent,
        iterations,
        iteration_returned: first.iteration_returned + second_run.iteration_returned,
        termination,
        residual_target: undo(setting.stopping.residual).max(
            if termination == Termination::Residual {
                // What was accepted in each direction adds up.
                first.residual_target + second_run.residual_target
            } else {
                0.0
            },
        ),
        max_residual: undo(norms.max),
        rms_residual: undo(norms.rms),
        smallest_eigenvalue: eigenvalues.map(|(u, v)| u * v),
        foot_points: None,
        history: vec![entry(0, before), entry(iterations, norms)],
    };
    let solved =
        Solved { control: second.control, vectors: work, norms, run, sequence: Vec::new() };
    Ok((solved, [first.history, second_run.history]))
}

/// How two runs ended, seen as one.
fn overall(each: [Termination; 2], residual: f64, stopping: Stopping) -> Termination {
    if stopping.residual > 0.0 && residual <= stopping.residual {
        return Termination::Residual;
    }
    let worse = [
        Termination::Diverged,
        Termination::Cancelled,
        Termination::Stalled,
        Termination::Iterations,
    ];
    worse.into_iter().find(|reason| each.contains(reason)).unwrap_or(Termination::Residual)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worse_ending_counts() {
        let stopping = Stopping { residual: 1e-9, max_iterations: 9, accept_rounding: 0.0 };
        let both = [Termination::Residual, Termination::Iterations];
        assert_eq!(overall(both, 1.0, stopping), Termination::Iterations);
        assert_eq!(overall(both, 1e-10, stopping), Termination::Residual);
    }
}
