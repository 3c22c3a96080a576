//! Surfaces within a distance of a grid, with few control points: least squares in which breakpoints
//! of both directions, and parameters, are sought as well.

mod attempt;
mod between;
mod cells;
mod heights;
mod layout;
mod options;
mod problem;
mod search;
mod settle;
mod verify;

pub use options::{SurfaceApproximationOptions, SurfaceGoal};

use super::SurfaceFit;
use super::approximate::{Measure, SPARE, centre_at_origin};
use super::solve::{Size, unscaled};
use super::surface::open_up;
use crate::Error;
use crate::collocation::{ControlLayout, NetLayout};
use crate::geometry::Surface;
use crate::iteration::{Flow, HistoryEntry, NoObserver, Observer, Snapshot, Termination, Trace};
use crate::knots::{KnotVector, check_degree};
use crate::parameters::{Parameterization, assign_grid_parameters};
use crate::points::{Extent, GridView, PointGrid, Points};
use crate::projection::MovingSurface;
use crate::report::{RunReport, SurfaceReport};
use attempt::{Attempt, Effort};
use cells::Cells;
use heights::Lattice;
use problem::Problem;

/// Rounds times points that take about a second.
const EFFORT: usize = 1_500_000;
/// Fewest and most rounds, where they are left to us.
const ROUNDS: std::ops::RangeInclusive<usize> = 300..=2000;

/// Finds a surface that keeps within a distance of a grid of points, with as few control points as it
/// can; or the closest one of a given size.
///
/// Breakpoints are added where the error of their direction is largest, placed anew after the jumps of
/// the highest derivative, traded between the directions, and taken out again as long as all demands
/// are met. Every attempt is a weighted least squares fit whose parameters move towards their foot
/// points (Rios and Juettler 2022) and whose weights move to the largest distances (Lawson 1961).
/// Between the points the surface may stray from the bilinear cells of the grid no farther than the
/// tolerance and 1.5 times what a local interpolant does.
///
/// Points over a lattice of two coordinates, and points of one coordinate, are heights: their
/// distance is the difference at the same place, and the lattice is reproduced exactly.
///
/// A goal that was not met is no error: see
/// [`ApproximationReport::met`](crate::ApproximationReport::met).
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`].
///
/// # Examples
/// ```
/// use gimfit::points::GridView;
/// use gimfit::{SurfaceApproximationOptions, approximate_surface};
/// let mut points = Vec::new();
/// for i in 0..30 {
///     for j in 0..20 {
///         let (x, y) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
///         points.extend([x, y, x.sin() * y.cos()]);
///     }
/// }
/// let grid = GridView::new([30, 20], 3, &points)?;
/// let fit = approximate_surface(grid, &SurfaceApproximationOptions::within(0.01))?;
/// let account = fit.report.approximation.as_ref().unwrap();
/// assert!(account.met && account.max_distance <= 0.01);
/// assert!(fit.surface.control_net().points().len() <= 25);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn approximate_surface(
    grid: GridView<'_>,
    options: &SurfaceApproximationOptions,
) -> Result<SurfaceFit, Error> {
    approximate_surface_observed(grid, options, &mut NoObserver)
}

/// As [`approximate_surface`], watched round by round; the observer sees the largest distance of the
/// attempt at work, and may stop the search: the best attempt so far is returned.
///
/// # Errors
/// As [`approximate_surface`].
pub fn approximate_surface_observed(
    grid: GridView<'_>,
    options: &SurfaceApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<SurfaceFit, Error> {
    for degree in options.degrees {
        check_degree(degree)?;
    }
    if grid.points().is_empty() {
        let needed = options.degrees.map(|p| p.saturating_add(1));
        return Err(Error::NoPoints { needed: needed[0].saturating_mul(needed[1]) });
    }
    let size = Size::of(Extent::of(grid.points())?);
    let goal = check_goal(options, &size)?;
    let mut choices = Vec::new();
    let (shape, data) = open_up(grid, &size, options.closed, &[None, None], &mut choices);
    let dimension = grid.dimension();
    let data = size.scale.apply(&data);
    let view = GridView::new(shape, dimension, &data)?;
    for k in 0..2 {
        let needed = options.degrees[k] + 1;
        if shape[k] < needed {
            return Err(Error::TooFewLines {
                what: ["rows", "columns"][k],
                count: shape[k],
                degree: options.degrees[k],
                needed,
            });
        }
    }
    if let Some(net) = goal.net
        && let Some(k) = (0..2).find(|&k| net[k] > shape[k])
    {
        return Err(Error::OutOfRange {
            what: format!("{} of control points", ["rows", "columns"][k]),
            value: net[k] as f64,
            rule: "there may be no more than rows, or columns, of points",
        });
    }
    let diagonal = size.scale.up(size.extent.diagonal());
    if diagonal == 0.0 {
        return Err(Error::AllPointsEqual { points: grid.points().len() });
    }
    let field = Field::of(view, options.closed, &mut choices)?;
    let mut sought = field.sought(&data, dimension);
    let centre = centre_at_origin(&mut sought, field.dimension);
    let cells = Cells {
        shape,
        dimension: field.dimension,
        closed: options.closed,
        data: &sought,
        in_place: field.kept,
    };
    let tolerance = goal.tolerance.unwrap_or(1e-6 * diagonal) * SPARE;
    let mut problem =
        Problem::new(cells, options.degrees, field.lines.clone(), goal.measure, tolerance);

    let most = options
        .rounds
        .unwrap_or_else(|| (EFFORT / problem.points()).clamp(*ROUNDS.start(), *ROUNDS.end()));
    let mut trace = Trace::with_room_for(0);
    let mut watch = |round: usize, attempt: &Attempt, tolerance: f64| {
        let [largest, rms] = attempt.distances().map(|d| size.scale.undo(d * tolerance));
        let entry = HistoryEntry {
            iteration: round,
            max_residual: largest,
            rms_residual: rms,
            normal_residual: None,
        };
        trace.push(entry);
        observer.observe(Snapshot { entry, control: &attempt.net }) == Flow::Continue
    };
    let mut effort = Effort { rounds: 0, most, watch: &mut watch, stopped: false };
    let attempt = match goal.net {
        Some(net) => {
            let breaks = [0, 1].map(|k| problem.breaks_for(k, net[k]));
            search::best_with(&mut problem, breaks, &mut effort)?
        }
        None => search::fewest(&problem, &mut effort)?,
    };
    let (rounds, cancelled) = (effort.rounds, effort.stopped);

    let knots = attempt.knots(&problem)?;
    let surface = field.surface(&attempt, &problem, knots, &centre, dimension)?;
    let full = Cells { dimension, data: &data, ..cells };
    let moving = MovingSurface::new(surface.knots().each_ref(), &[], dimension);
    let starts = (0..problem.points()).map(|k| moving.inside(attempt.pair(&problem, k)));
    let verified = verify::verify(&surface, &full, starts)?;
    let overshoot = verify::overshoot(&surface, &full, |cell, share| {
        moving.inside(attempt.place(&problem, cell, share))
    })?;
    let mut account = verified.account;
    let limit = goal.tolerance.unwrap_or(account.max_distance);
    account.met = goal.tolerance.is_none_or(|tolerance| match goal.measure {
        Measure::Largest => account.max_distance <= tolerance,
        Measure::Rms | Measure::Noise => account.rms_distance <= tolerance,
    });
    account.overshoot = overshoot;
    account.calm_limit = 1.05 * limit + 1.5 * problem.natural;
    account.rounds = rounds;
    let undo = |x: f64| size.scale.undo(x);
    for length in [
        &mut account.max_distance,
        &mut account.rms_distance,
        &mut account.mean_distance,
        &mut account.overshoot,
        &mut account.calm_limit,
    ] {
        *length = undo(*length);
    }
    let termination = match (cancelled, account.met) {
        (true, _) => Termination::Cancelled,
        (_, true) => Termination::Residual,
        _ if rounds >= most => Termination::Iterations,
        _ => Termination::Stalled,
    };
    // After all attempts, the one that is returned.
    trace.push(HistoryEntry {
        iteration: rounds + 1,
        max_residual: account.max_distance,
        rms_residual: account.rms_distance,
        normal_residual: None,
    });
    let lines = [0, 1].map(|k| {
        let at = |&t: &f64| moving.inside(if k == 0 { [t, 0.0] } else { [0.0, t] })[k];
        problem.lines[k].iter().map(at).collect::<Vec<f64>>()
    });
    let spacing_ratios = problem.lines.each_ref().map(|lines| spacing_ratio(lines));
    let surface = if size.scale.is_identity() {
        surface
    } else {
        let net = surface.control_net();
        let points = unscaled(net.points().clone(), size.scale)?.into_coordinates();
        surface.with_control_net(PointGrid::new(net.shape(), dimension, points)?)?
    };
    let worst = account.worst.first().copied().unwrap_or(0);
    let worst = [worst / shape[1], worst % shape[1]];
    let run = RunReport {
        updates: None,
        local: None,
        foot_points: None,
        least_squares: None,
        method: "approximation",
        choices,
        iterations: rounds,
        iteration_returned: rounds,
        termination,
        residual_target: goal.tolerance.map_or(0.0, undo),
        extent: size.extent.diagonal(),
        max_residual: account.max_distance,
        rms_residual: account.rms_distance,
        smallest_eigenvalue: None,
        history: trace.into_entries(),
    };
    let report = SurfaceReport {
        points: shape,
        control_points: surface.control_net().shape(),
        degrees: options.degrees,
        dimension,
        closed: options.closed,
        parameterizations: [field.parameterization; 2],
        knot_placements: ["sought"; 2],
        spacing_ratios,
        per_direction: false,
        run,
        stages: None,
        max_residual_index: worst,
        max_deviation: account.max_distance,
        max_deviation_index: worst,
        approximation: Some(account),
    };
    Ok(SurfaceFit {
        surface,
        parameters: lines,
        foot_parameters: (!field.kept).then_some(verified.parameters),
        difference_vectors: unscaled(
            Points::new(dimension, verified.difference_vectors)?,
            size.scale,
        )?,
        report,
        sequence: Vec::new(),
    })
}

/// What is sought over which parameters.
struct Field {
    lattice: Option<Lattice>,
    /// Whether parameters stay.
    kept: bool,
    lines: [Vec<f64>; 2],
    /// Coordinates sought.
    dimension: usize,
    parameterization: &'static str,
}

impl Field {
    fn of(view: GridView<'_>, closed: [bool; 2], choices: &mut Vec<String>) -> Result<Self, Error> {
        let lattice = if closed == [false; 2] { Lattice::of(view) } else { None };
        if let Some(lattice) = lattice {
            choices.push(format!(
                "distances: of the heights, each at its place, since coordinates {} and {} form a \
                 lattice, which the surface reproduces",
                lattice.axes[0] + 1,
                lattice.axes[1] + 1
            ));
            let lines = [0, 1].map(|k| lattice.parameters(k));
            for (k, lines) in lines.iter().enumerate() {
                if let Some(index) = (1..lines.len()).find(|&j| lines[j] <= lines[j - 1]) {
                    return Err(Error::ParametersCollide { first: index - 1, second: index }
                        .in_lines(["row", "column"][k]));
                }
            }
            return Ok(Self {
                kept: true,
                lines,
                dimension: view.dimension() - 2,
                parameterization: "abscissae",
                lattice: Some(lattice),
            });
        }
        let single = view.dimension() == 1;
        let rule = if single {
            choices.push(
                "distances: of the heights, each at its place; parameters: uniform, because heights \
                 have no chords"
                    .into(),
            );
            Parameterization::Uniform
        } else {
            Parameterization::Chord
        };
        let mut lines = |k: usize| {
            let first = assign_grid_parameters(view, k, closed[k], &rule);
            let parameters = match first {
                // Lines that coincide have no chords between them, but can be approximated.
                Err(Error::RepeatedPoints { .. } | Error::ParametersCollide { .. }) => {
                    choices.push(format!(
                        "parameters in {} begin uniform, because {}s coincide",
                        ["u", "v"][k],
                        ["row", "column"][k]
                    ));
                    assign_grid_parameters(view, k, closed[k], &Parameterization::Uniform)
                }
                other => other,
            };
            parameters
                .map(|parameters| scaled_to_one(&parameters, closed[k]))
                .map_err(|error| error.in_lines(["row", "column"][k]))
        };
        Ok(Self {
            lattice: None,
            kept: single,
            lines: [lines(0)?, lines(1)?],
            dimension: view.dimension(),
            parameterization: if single { "uniform" } else { "foot points" },
        })
    }

    /// The coordinates sought, point by point.
    fn sought(&self, data: &[f64], dimension: usize) -> Vec<f64> {
        match &self.lattice {
            None => data.to_vec(),
            Some(lattice) => {
                data.chunks_exact(dimension).flat_map(|point| lattice.heights(point)).collect()
            }
        }
    }

    /// The surface of an attempt, with all coordinates, where the data are.
    fn surface(
        &self,
        attempt: &Attempt,
        problem: &Problem<'_>,
        knots: [KnotVector; 2],
        centre: &[f64],
        dimension: usize,
    ) -> Result<Surface, Error> {
        let layout = |k: usize| match problem.closed()[k] {
            true => ControlLayout::Periodic { shift: 0, degree: problem.degrees[k] },
            false => ControlLayout::Free,
        };
        let columns = attempt.net_shape(problem)[1];
        let layout = NetLayout { u: layout(0), v: layout(1), columns };
        let mut net = layout.expand(attempt.net.clone(), self.dimension);
        net.chunks_exact_mut(self.dimension).for_each(|point| {
            point.iter_mut().zip(centre).for_each(|(x, c)| *x += c);
        });
        let shape = knots.each_ref().map(KnotVector::control_points);
        if let Some(lattice) = &self.lattice {
            // A linear coordinate has its values at the Greville abscissae as control points.
            let greville = knots.each_ref().map(KnotVector::greville_abscissae);
            let mut full = Vec::with_capacity(shape[0] * shape[1] * dimension);
            for (k, heights) in net.chunks_exact(self.dimension).enumerate() {
                let place = [k / shape[1], k % shape[1]];
                let mut rest = heights.iter();
                for axis in 0..dimension {
                    let along = (0..2).find(|&k| lattice.axes[k] == axis);
                    full.push(match along {
                        Some(k) => lattice.abscissa(k, greville[k][place[k]]),
                        None => rest.next().copied().unwrap_or(0.0),
                    });
                }
            }
            net = full;
        }
        Surface::new(knots, PointGrid::new(shape, dimension, net)?)
    }
}

/// Parameters on [0, 1], or from 0 on with period 1.
fn scaled_to_one(parameters: &crate::parameters::Parameters, closed: bool) -> Vec<f64> {
    let values = parameters.values();
    let first = values[0];
    let length = match parameters.period() {
        Some(period) if closed => period,
        _ => values[values.len() - 1] - first,
    };
    values.iter().map(|t| (t - first) / length).collect()
}

fn spacing_ratio(lines: &[f64]) -> f64 {
    let steps = || lines.windows(2).map(|t| t[1] - t[0]);
    let ratio = steps().fold(0.0, f64::max) / steps().fold(f64::INFINITY, f64::min);
    if ratio.is_finite() { ratio } else { 1.0 }
}

/// A goal in the unit that the search works in.
struct ScaledGoal {
    measure: Measure,
    tolerance: Option<f64>,
    net: Option<[usize; 2]>,
}

fn check_goal(options: &SurfaceApproximationOptions, size: &Size) -> Result<ScaledGoal, Error> {
    let within = |measure: Measure, what: &str, value: f64| {
        if value > 0.0 && value.is_finite() {
            let tolerance = Some(size.scale.up(value));
            return Ok(ScaledGoal { measure, tolerance, net: None });
        }
        Err(Error::OutOfRange {
            what: what.into(),
            value,
            rule: "it must be a distance above 0, in the unit of the points",
        })
    };
    match options.goal {
        SurfaceGoal::Tolerance(tolerance) => within(Measure::Largest, "tolerance", tolerance),
        SurfaceGoal::Rms(rms) => within(Measure::Rms, "rms distance", rms),
        SurfaceGoal::ControlPoints(net) => {
            for (k, given) in net.into_iter().enumerate() {
                let least = options.degrees[k] + 1;
                if given < least {
                    return Err(Error::WrongCount {
                        what: ["rows of control points", "columns of control points"][k],
                        given,
                        expected: least,
                        why: "a direction has at least degree + 1; ask for more, or lower the \
                              degree",
                    });
                }
            }
            Ok(ScaledGoal { measure: Measure::Largest, tolerance: None, net: Some(net) })
        }
    }
}
