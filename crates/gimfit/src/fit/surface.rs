//! Interpolation of a grid of points by a tensor-product B-spline surface.

use super::curve::{finish_parameters, parameterization_name, placement_name};
use super::geometric::{self, Net, Pairs};
use super::local_surface::ChosenNet;
use super::net::{Setting, one_weight, run_net, tensor};
use super::rational::{fitted_weights, separate};
use super::solve::{Size, Solved, Task, norm, unscaled};
use super::surface_method::Directions;
use super::{KeptFit, Method, SurfaceOptions};
use crate::Error;
use crate::collocation::{Interpolation, NetLayout, NetWeights, interpolation};
use crate::geometry::Surface;
use crate::iteration::{NoObserver, Observer};
use crate::knots::{KnotPlacement, KnotVector, place_knots};
use crate::parameters::{Parameterization, Parameters, assign_grid_parameters};
use crate::points::{Extent, GridView, PointGrid, Points};
use crate::projection::{largest_surface_deviation, largest_surface_deviation_from};
use crate::report::SurfaceReport;
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
    let (shape, data) =
        open_up(grid, &size, options.closed, &options.parameterizations, &mut choices);
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
    let setting =
        Setting { view, size: &size, directions, options, stopping, expand: &expand, target: None };
    let bands = [&u.built.operator, &v.built.operator];
    let local = ChosenNet::of(options, given, shape, bands, net.as_ref())?;
    let geometric = matches!(options.method, Method::Geometric { .. }) && !options.per_direction;
    let ((mut solved, stages), foot_parameters) = if let Some(local) = &local {
        (local.run(&setting, observer)?, None)
    } else if geometric {
        let net = Net {
            directions: [directions.u, directions.v],
            layout,
            knots: [&u.knots, &v.knots],
            parameters: [&u.parameters, &v.parameters],
            rational_weights: rational_weights.as_deref(),
            rational: directions.rational,
            least_eigenvalue: options.least_eigenvalue,
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
    let exact = local.is_none() && norms.max <= size.rounding_level();
    let (max_deviation, deviation_index) = if exact {
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
        approximation: None,
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
    closed: [bool; 2],
    parameterizations: &[Option<Parameterization>; 2],
    choices: &mut Vec<String>,
) -> ([usize; 2], Cow<'a, [f64]>) {
    let [mut rows, mut columns] = grid.shape();
    let limit = CLOSING_GAP * size.extent.diagonal();
    let near = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).fold(0.0, |sum: f64, (a, b)| sum.hypot(a - b)) <= limit
    };
    let given = |k: usize| matches!(parameterizations[k], Some(Parameterization::Given(_)));
    // Parameters that are given count the closing row in, or not; the caller knows.
    if closed[0] && rows > 1 && !given(0) {
        let repeats = (0..columns).all(|j| near(grid.point(0, j), grid.point(rows - 1, j)));
        if repeats {
            choices.push("closing: the last row repeats the first and is taken as the seam".into());
            rows -= 1;
        }
    }
    if closed[1] && columns > 1 && !given(1) {
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
