//! Least squares surfaces over grids: the columns are fitted in u, then the rows of what that gave in v.
//!
//! The normal matrix of a grid is the Kronecker product of those of its directions, so that the limit
//! of one direction after the other is the least squares fit of the whole grid (methods of curves are
//! enough, and no step has to serve both directions).

use super::place::Sites;
use super::{
    DirectionOutcome, LeastSquaresKnots, LeastSquaresMethod, LeastSquaresOptions,
    LeastSquaresWeight, Problem, solve_problem,
};
use crate::Error;
use crate::collocation::{CollocationOperator, LeastSquaresCollocation, NetLayout};
use crate::fit::SurfaceFit;
use crate::fit::curve::parameterization_name;
use crate::fit::net::overall;
use crate::fit::prepare::check_extent;
use crate::fit::solve::{Size, norm, unscaled};
use crate::fit::surface::open_up;
use crate::geometry::Surface;
use crate::iteration::{HistoryEntry, NoObserver};
use crate::knots::{KnotVector, check_degree};
use crate::parameters::{Parameterization, assign_grid_parameters};
use crate::points::{Extent, GridView, PointGrid, Points, PointsView};
use crate::projection::largest_surface_deviation;
use crate::report::{LeastSquaresReport, RunReport, SurfaceReport};

/// What a caller chooses for [`fit_least_squares_surface`]. Pairs hold direction u (rows), then
/// direction v (columns); what is no pair counts for both.
#[derive(Debug, Clone, PartialEq)]
pub struct LeastSquaresSurfaceOptions {
    /// Degrees, from 1.
    pub degrees: [usize; 2],
    /// Whether the surface returns smoothly to its first row, its first column.
    pub closed: [bool; 2],
    /// The knots, or how many control points.
    pub knots: [LeastSquaresKnots; 2],
    /// How parameters are assigned; `None`: chord lengths averaged over the grid, uniform for heights
    /// of dimension 1. They increase strictly.
    pub parameterizations: [Option<Parameterization>; 2],
    /// Whether open directions start at the first and end at the last row or column: the control points
    /// there are the data, fitted in the other direction only.
    pub hold_ends: bool,
    /// The rule that moves the control points.
    pub method: LeastSquaresMethod,
    /// Its weight.
    pub weight: LeastSquaresWeight,
    /// What the randomised methods draw from.
    pub seed: u64,
    /// Most steps in each direction.
    pub iterations: usize,
    /// Normal residual to be reached in each direction, as in [`LeastSquaresOptions::residual`].
    pub residual: Option<f64>,
}

impl LeastSquaresSurfaceOptions {
    /// A bicubic of so many rows and columns of control points.
    #[must_use]
    pub fn with_control_points(counts: [usize; 2]) -> Self {
        Self::new(counts.map(LeastSquaresKnots::ControlPoints))
    }

    /// A bicubic over these knots.
    #[must_use]
    pub fn new(knots: [LeastSquaresKnots; 2]) -> Self {
        Self {
            degrees: [3, 3],
            closed: [false, false],
            knots,
            parameterizations: [None, None],
            hold_ends: false,
            method: LeastSquaresMethod::Auto,
            weight: LeastSquaresWeight::Auto,
            seed: 0,
            iterations: 1000,
            residual: None,
        }
    }
}

/// Fits a tensor-product surface with fewer control points than grid points, so that the sum of the
/// squares of the difference vectors is smallest, by any method of
/// [`fit_least_squares`](super::fit_least_squares), first in u, then in v. The limit of extended PIA is
/// another one, as for curves.
///
/// The histories of both directions are in [`SurfaceReport::stages`]; there rows of points count as one
/// point. The normal residual of the report is that of the whole grid.
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`].
///
/// # Examples
/// ```
/// use gimfit::{GridView, LeastSquaresSurfaceOptions, fit_least_squares_surface};
/// let mut heights = Vec::new();
/// for i in 0..30 {
///     for j in 0..40 {
///         let (x, y) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
///         heights.push(x.sin() * y.cos() + 0.001 * f64::from((i * j) % 5));
///     }
/// }
/// let grid = GridView::new([30, 40], 1, &heights)?;
/// let options = LeastSquaresSurfaceOptions::with_control_points([8, 10]);
/// let fit = fit_least_squares_surface(grid, &options)?;
/// assert!(fit.report.converged());
/// assert_eq!(fit.report.control_points, [8, 10]);
/// assert!(fit.report.run.rms_residual < 0.003);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn fit_least_squares_surface(
    grid: GridView<'_>,
    options: &LeastSquaresSurfaceOptions,
) -> Result<SurfaceFit, Error> {
    for degree in options.degrees {
        check_degree(degree)?;
    }
    if grid.points().is_empty() {
        let needed = (options.degrees[0] + 1) * (options.degrees[1] + 1);
        return Err(Error::NoPoints { needed });
    }
    let size = Size::of(Extent::of(grid.points())?);
    check_extent(&size.extent)?;
    let mut choices = Vec::new();
    let parameterizations = &options.parameterizations;
    let (shape, data) = open_up(grid, &size, options.closed, parameterizations, &mut choices);
    let dimension = grid.dimension();
    let data = size.scale.apply(&data).into_owned();
    let view = GridView::new(shape, dimension, &data)?;
    let u = Direction::new(view, 0, options)?;
    let v = Direction::new(view, 1, options)?;
    let knots = [u.knots.clone(), v.knots.clone()];
    let spacing_ratios = [u.sites.spacing_ratio(), v.sites.spacing_ratio()];
    let names = [u.parameterization, v.parameterization];
    let placed = [u.placed, v.placed];

    // A row of the grid is a point of a curve in u, a row of what comes out, turned, one in v.
    let in_u = u.solve(&data, shape[1] * dimension, shape[1], size.clone())?;
    let turned = turn(&in_u.control, shape[1], dimension);
    let rows = in_u.control.len() / (shape[1] * dimension);
    let in_v = v.solve(&turned, rows * dimension, rows, size.clone())?;
    let control = turn(&in_v.control, rows, dimension);
    let columns = control.len() / (rows * dimension);

    let operators = [&in_u.operator, &in_v.operator];
    let whole = Whole { operators, shape, columns, dimension };
    let vectors = whole.difference_vectors(&data, &control);
    let normal = whole.normal_residual(&vectors, rows);
    let residuals: Vec<f64> = vectors.chunks_exact(dimension).map(norm).collect();
    let worst =
        (0..residuals.len()).fold(0, |w, j| if residuals[j] > residuals[w] { j } else { w });
    let square: f64 = residuals.iter().map(|x| x * x).sum();
    let rms = (square / residuals.len() as f64).sqrt();
    if !(rms.is_finite() && normal.is_finite()) {
        return Err(Error::LeavesDoubles);
    }

    let layout = NetLayout { u: in_u.layout, v: in_v.layout, columns };
    let net_shape = knots.each_ref().map(KnotVector::control_points);
    let net = PointGrid::new(net_shape, dimension, layout.expand(control, dimension))?;
    let surface = Surface::new(knots, net)?;
    let t = [in_u.parameters.as_slice(), in_v.parameters.as_slice()];
    let (max_deviation, deviation_index) = if residuals[worst] <= size.rounding_level() {
        (residuals[worst], worst)
    } else {
        let points = PointsView::new(dimension, &data)?;
        largest_surface_deviation(&surface, points, t, &residuals)?
    };
    let scale = size.scale;
    let net = unscaled(surface.control_net().points().clone(), scale)?;
    let surface =
        surface.with_control_net(PointGrid::new(net_shape, dimension, net.into_coordinates())?)?;
    let undo = |x: f64| scale.undo(x);
    let entry = HistoryEntry {
        iteration: in_u.run.iterations + in_v.run.iterations,
        max_residual: undo(residuals[worst]),
        rms_residual: undo(rms),
        normal_residual: Some(undo(normal)),
    };
    let run = together([&in_u.run, &in_v.run], entry, choices);
    let cell = |index: usize| [index / shape[1], index % shape[1]];
    let report = SurfaceReport {
        points: shape,
        control_points: net_shape,
        degrees: options.degrees,
        dimension,
        closed: options.closed,
        parameterizations: names,
        knot_placements: placed.map(|placed| if placed { "least-squares" } else { "given" }),
        spacing_ratios,
        per_direction: true,
        run,
        stages: Some([in_u.run.history, in_v.run.history]),
        max_residual_index: cell(worst),
        max_deviation: undo(max_deviation),
        max_deviation_index: cell(deviation_index),
        approximation: None,
    };
    Ok(SurfaceFit {
        surface,
        parameters: [in_u.parameters, in_v.parameters],
        foot_parameters: None,
        difference_vectors: unscaled(Points::new(dimension, vectors)?, scale)?,
        report,
        sequence: Vec::new(),
    })
}

/// What one direction brings along.
struct Direction {
    sites: Sites,
    knots: KnotVector,
    placed: bool,
    parameterization: &'static str,
    curve: LeastSquaresOptions,
}

impl Direction {
    fn new(
        view: GridView<'_>,
        k: usize,
        options: &LeastSquaresSurfaceOptions,
    ) -> Result<Self, Error> {
        let (count, degree) = (view.shape()[k], options.degrees[k]);
        if count < degree + 1 {
            let what = ["rows", "columns"][k];
            return Err(Error::TooFewLines { what, count, degree, needed: degree + 1 });
        }
        let parameterization =
            options.parameterizations[k].clone().unwrap_or(if view.dimension() == 1 {
                Parameterization::Uniform
            } else {
                Parameterization::Chord
            });
        let parameters = assign_grid_parameters(view, k, options.closed[k], &parameterization)
            .map_err(|error| error.in_lines(["row", "column"][k]))?;
        let curve = LeastSquaresOptions {
            degree,
            closed: options.closed[k],
            hold_ends: options.hold_ends && !options.closed[k],
            method: options.method,
            weight: options.weight,
            seed: options.seed,
            iterations: options.iterations,
            residual: options.residual,
            ..LeastSquaresOptions::new(options.knots[k].clone())
        };
        let sites = Sites::from(parameters);
        let knots = sites.knots(&curve)?;
        let placed = matches!(curve.knots, LeastSquaresKnots::ControlPoints(_));
        let parameterization = parameterization_name(&parameterization);
        Ok(Self { sites, knots, placed, parameterization, curve })
    }

    /// Fits all lines of the direction at once.
    fn solve(
        self,
        data: &[f64],
        dimension: usize,
        side_by_side: usize,
        size: Size,
    ) -> Result<DirectionOutcome, Error> {
        let view = PointsView::new(dimension, data)?;
        let problem = Problem {
            given: view.len(),
            data: view,
            size,
            sites: self.sites,
            knots: self.knots,
            placed: self.placed,
            side_by_side,
            choices: Vec::new(),
        };
        solve_problem(problem, &self.curve, &mut NoObserver)
    }
}

/// Rows of `columns` points become columns.
fn turn(rows: &[f64], columns: usize, dimension: usize) -> Vec<f64> {
    let count = rows.len() / (columns * dimension);
    let mut turned = Vec::with_capacity(rows.len());
    for j in 0..columns {
        for i in 0..count {
            turned.extend_from_slice(&rows[(i * columns + j) * dimension..][..dimension]);
        }
    }
    turned
}

/// Both directions, to measure the whole grid.
struct Whole<'a> {
    operators: [&'a LeastSquaresCollocation; 2],
    shape: [usize; 2],
    /// Columns of control points that move.
    columns: usize,
    dimension: usize,
}

impl Whole<'_> {
    /// `Q - A_u P A_v^T`.
    fn difference_vectors(&self, data: &[f64], control: &[f64]) -> Vec<f64> {
        let [u, v] = self.operators;
        let (line, long) = (self.columns * self.dimension, self.shape[1] * self.dimension);
        let mut across = vec![0.0; self.shape[0] * line];
        u.apply(control, line, &mut across);
        let mut vectors = vec![0.0; data.len()];
        let lines = across.chunks_exact(line).zip(data.chunks_exact(long));
        for ((across, data), vectors) in lines.zip(vectors.chunks_exact_mut(long)) {
            v.at_data(data, across, self.dimension, vectors);
        }
        vectors
    }

    /// The largest mean difference vector of a control point that moves in both directions.
    fn normal_residual(&self, vectors: &[f64], rows: usize) -> f64 {
        let [u, v] = self.operators;
        let long = self.shape[1] * self.dimension;
        let mut across = vec![0.0; rows * long];
        u.difference_vectors(vectors, &vec![0.0; rows * long], long, &mut across);
        let zero = vec![0.0; self.columns * self.dimension];
        let mut line = zero.clone();
        let mut largest = 0.0_f64;
        let weight = |operator: &LeastSquaresCollocation, i: usize| {
            // Groups have been divided by their sums.
            if operator.is_grouped() { 1.0 } else { operator.column_sums()[i].recip() }
        };
        for (i, row) in across.chunks_exact(long).enumerate().filter(|(i, _)| !u.stays()[*i]) {
            v.difference_vectors(row, &zero, self.dimension, &mut line);
            let points = line.chunks_exact(self.dimension).enumerate();
            for (j, vector) in points.filter(|(j, _)| !v.stays()[*j]) {
                largest = largest.max(norm(vector) * weight(u, i) * weight(v, j));
            }
        }
        largest
    }
}

/// Two runs told as one.
fn together(runs: [&RunReport; 2], entry: HistoryEntry, mut choices: Vec<String>) -> RunReport {
    let [u, v] = runs;
    choices.push(format!(
        "directions: one after the other, each line a curve: the columns in u, {} steps, then the rows \
         of what that gave in v, {} steps",
        u.iterations, v.iterations
    ));
    for (name, run) in [("u", u), ("v", v)] {
        choices.extend(run.choices.iter().map(|choice| format!("{choice} (in {name})")));
    }
    let unmet = |run: &RunReport| run.least_squares.map_or(0, |a| a.unmet_control_points);
    RunReport {
        choices,
        iterations: entry.iteration,
        iteration_returned: u.iteration_returned + v.iteration_returned,
        termination: overall([u.termination, v.termination]),
        // What is left in u adds to what is left in v.
        residual_target: u.residual_target + v.residual_target,
        max_residual: entry.max_residual,
        rms_residual: entry.rms_residual,
        smallest_eigenvalue: u.smallest_eigenvalue.zip(v.smallest_eigenvalue).map(|(u, v)| u * v),
        least_squares: entry.normal_residual.map(|normal_residual| LeastSquaresReport {
            normal_residual,
            unmet_control_points: unmet(u) + unmet(v),
        }),
        history: vec![entry],
        ..v.clone()
    }
}
