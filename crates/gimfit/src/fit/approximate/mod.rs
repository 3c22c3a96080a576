//! Curves within a distance of the data, with few control points: least squares in which breakpoints
//! and parameters are sought as well.

mod abscissa;
mod attempt;
pub(super) mod breaks;
mod corners;
mod goal;
mod noise;
mod options;
mod pieces;
pub(super) mod polyline;
mod problem;
mod robust;
mod sample;
mod search;
mod verify;

pub use options::{ApproximationOptions, Corners, Goal, Robust};
pub(super) use problem::Measure;

use super::CurveFit;
use super::solve::{Size, unscaled};
use crate::Error;
use crate::geometry::Curve;
use crate::iteration::{Flow, HistoryEntry, NoObserver, Observer, Snapshot, Termination, Trace};
use crate::knots::check_degree;
use crate::points::{Extent, Points, PointsView};
use crate::report::{ApproximationReport, CurveReport, RunReport};
use abscissa::Abscissa;
use attempt::{Attempt, Effort};
use corners::{AUTO_ANGLE, find_corners};
use goal::check_goal;
use pieces::Piece;
use polyline::Polyline;
use problem::Problem;

/// Rounds times points that take about a second.
const EFFORT: usize = 2_000_000;
/// Fewest and most rounds, where they are left to us.
const ROUNDS: std::ops::RangeInclusive<usize> = 200..=4000;
/// A last point this close to the first, in units of the extent, repeats it.
const CLOSING_GAP: f64 = 1e-9;
/// Demands are met with this much to spare, so that rounding does not break them.
pub(super) const SPARE: f64 = 1.0 - 1e-6;

/// Finds a curve that keeps within a distance of ordered points, with as few control points as it
/// can; or the closest one of a given size.
///
/// Breakpoints go where the distance is largest, are placed anew after the jumps of the highest
/// derivative, and are taken out again as long as all demands are met. Every attempt is a weighted
/// least squares fit whose parameters move towards their foot points (Rios and Juettler 2022) and
/// whose weights move to the largest distances (Lawson 1961). Between the points the curve may stray
/// from their polyline no farther than the tolerance and 1.5 times what a local interpolant does.
/// At corners the curve meets the data point, with a knot of full multiplicity.
///
/// A goal that was not met is no error: see
/// [`ApproximationReport::met`](crate::ApproximationReport::met).
///
/// # Errors
/// What is wrong with the points or the options; see [`Error`].
///
/// # Examples
/// ```
/// use gimfit::{ApproximationOptions, approximate_curve};
/// let points: Vec<[f64; 2]> = (0..200)
///     .map(|i| {
///         let x = f64::from(i) / 20.0;
///         [x, x.sin()]
///     })
///     .collect();
/// let fit = approximate_curve(&points, &ApproximationOptions::within(0.01))?;
/// let account = fit.report.approximation.as_ref().unwrap();
/// assert!(account.met && account.max_distance <= 0.01);
/// assert!(fit.curve.control_points().len() <= 10);
/// # Ok::<(), gimfit::Error>(())
/// ```
pub fn approximate_curve<'a>(
    points: impl Into<PointsView<'a>>,
    options: &ApproximationOptions,
) -> Result<CurveFit, Error> {
    approximate_curve_observed(points, options, &mut NoObserver)
}

/// As [`approximate_curve`], watched round by round; the observer sees the largest distance of the
/// attempt at work, and may stop the search: the best attempt so far is returned.
///
/// # Errors
/// As [`approximate_curve`].
pub fn approximate_curve_observed<'a>(
    points: impl Into<PointsView<'a>>,
    options: &ApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    let points = points.into();
    let fit = approximate(points, options, observer)?;
    let account = Account::of(&fit);
    let cheap = account.met && fit.report.control_points <= fit.report.points;
    let stopped = fit.report.run.termination == Termination::Cancelled;
    if options.corners != Corners::Auto || account.corners == 0 || cheap || stopped {
        return Ok(fit);
    }
    // Of a polygon each point is a corner, and costs as much as several smooth ones.
    let smooth = ApproximationOptions { corners: Corners::None, ..options.clone() };
    let mut smooth = approximate(points, &smooth, observer)?;
    if Account::of(&smooth).rank() <= account.rank() {
        return Ok(fit);
    }
    smooth.report.run.choices.push(format!(
        "corners: none are kept sharp, because with the {} that the data show the curve would have {} \
         control points{}",
        account.corners,
        account.control_points,
        if account.met { "" } else { " and be no closer" },
    ));
    Ok(smooth)
}

/// What decides between two fits.
struct Account {
    met: bool,
    calm: bool,
    corners: usize,
    control_points: usize,
}

impl Account {
    fn of(fit: &CurveFit) -> Self {
        let account = fit.report.approximation.as_ref();
        Self {
            met: account.is_some_and(|account| account.met),
            calm: account.is_some_and(ApproximationReport::is_calm),
            corners: account.map_or(0, |account| account.corners.len()),
            control_points: fit.report.control_points,
        }
    }

    /// Greater is better.
    fn rank(&self) -> (bool, bool, std::cmp::Reverse<usize>) {
        (self.met, self.calm, std::cmp::Reverse(self.control_points))
    }
}

/// One search, with the corners asked for.
fn approximate(
    points: PointsView<'_>,
    options: &ApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    check_degree(options.degree)?;
    let needed = options.degree.saturating_add(1);
    if points.is_empty() {
        return Err(Error::NoPoints { needed });
    }
    let size = Size::of(Extent::of(points)?);
    let (dimension, given) = (points.dimension(), points.len());
    let mut choices = Vec::new();
    let mut data = size.scale.apply(points.coordinates()).into_owned();
    let centre = centre_at_origin(&mut data, dimension);
    let diagonal = size.scale.up(size.extent.diagonal());
    if diagonal == 0.0 && given > 1 && options.abscissae.is_none() {
        return Err(Error::AllPointsEqual { points: given });
    }
    // A constant has no extent.
    let diagonal = if diagonal > 0.0 { diagonal } else { 1.0 };
    let mut closed = options.closed;
    if closed && given > 1 {
        let last = &data[(given - 1) * dimension..];
        if polyline::distance(&data[..dimension], last) <= CLOSING_GAP * diagonal {
            choices.push(
                "closing: the last point repeats the first and is taken as the closing point"
                    .into(),
            );
            data.truncate((given - 1) * dimension);
        }
    }
    let count = data.len() / dimension;
    if count < needed {
        return Err(Error::TooFewPoints { points: count, degree: options.degree, needed });
    }

    let over = abscissa::of(options, given, count, dimension, closed, &mut choices)?;
    let mut unit = over.as_ref().map(Abscissa::unit);
    let polyline = Polyline { data: &data, dimension, closed, over: unit.as_deref() };
    let goal = check_goal(options, &size, &polyline)?;
    if let Some((deviation, true)) = goal.noise {
        let deviation = size.scale.undo(deviation);
        choices.push(format!("noise: standard deviation {deviation:.3e} a coordinate, estimated"));
    }
    let mut rounds = 0;
    let mut cancelled = false;
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
        observer.observe(Snapshot { entry, control: &attempt.control }) == Flow::Continue
    };
    let tolerance = goal.tolerance.unwrap_or(1e-6 * diagonal) * SPARE;
    let most_rounds = options.rounds.unwrap_or_else(|| {
        let looked_at = if count > sample::ALL { sample::FEW } else { count };
        (EFFORT / looked_at).clamp(*ROUNDS.start(), *ROUNDS.end())
    });
    let mut outliers = Vec::new();
    if options.robust.is_some() {
        let mut problem = Problem::new(polyline, options.degree, goal.measure, tolerance);
        problem.robust = options.robust;
        let mut effort =
            Effort { rounds, most: most_rounds, watch: &mut watch, stopped: cancelled };
        outliers = robust::outliers(&problem, goal.breaks, &mut effort)?;
        cancelled |= effort.stopped;
        rounds = effort.rounds;
    }
    let is_kept = |j: &usize| outliers.binary_search(j).is_err();
    let kept: Vec<usize> = (0..count).filter(is_kept).collect();
    let mut data: Vec<f64> =
        kept.iter().flat_map(|&j| &data[j * dimension..][..dimension]).copied().collect();
    let count = kept.len();
    if count < needed {
        return Err(Error::TooFewPoints { points: count, degree: options.degree, needed });
    }

    if let Some(unit) = &mut unit {
        *unit = kept.iter().map(|&j| unit[j]).collect();
    }
    let polyline = Polyline { data: &data, dimension, closed, over: unit.as_deref() };
    let scale_of_corners = goal.detail.unwrap_or(1e-3 * diagonal);
    let mut corners = match options.corners {
        Corners::None => Vec::new(),
        _ if over.is_some() => Vec::new(),
        Corners::Auto => find_corners(&polyline, scale_of_corners, AUTO_ANGLE),
        Corners::Angle(least) => find_corners(&polyline, scale_of_corners, least),
    };
    if matches!(options.goal, Goal::ControlPoints(_)) && !corners.is_empty() {
        corners.clear();
        choices.push(
            "corners: none are kept sharp where the number of control points is given".into(),
        );
    }
    if closed && !corners.is_empty() {
        closed = false;
        choices.push(format!(
            "closing: the curve closes with a corner, at point {}, so it is stored as an open one \
             whose ends meet",
            corners[0]
        ));
    }

    let mut found: Vec<(Piece, Attempt)> = Vec::new();
    let most_rounds = rounds + most_rounds;
    let mut spent = 0;
    let to_split = Polyline { closed: options.closed, ..polyline };
    for piece in pieces::split(&to_split, &corners) {
        let mut problem = Problem::new(piece.polyline(), options.degree, goal.measure, tolerance);
        problem.pinned = !corners.is_empty();
        let mut watch = |round: usize, attempt: &Attempt, tolerance: f64| {
            watch(spent + round, attempt, tolerance)
        };
        let mut effort =
            Effort { rounds, most: most_rounds, watch: &mut watch, stopped: cancelled };
        let attempt = sample::search(&mut problem, goal.breaks, &mut effort)?;
        cancelled |= effort.stopped;
        spent += effort.rounds - rounds;
        found.push((piece, attempt));
    }
    rounds += spent;

    let joined = pieces::join(&found, options.degree, closed, dimension)?;
    drop(found);
    let mut control = joined.control;
    control.chunks_exact_mut(dimension).for_each(|point| {
        point.iter_mut().zip(&centre).for_each(|(x, c)| *x += c);
    });
    let knots = match &over {
        Some(over) => over.knots(&joined.knots)?,
        None => joined.knots.clone(),
    };
    let curve = Curve::new(knots.clone(), Points::new(dimension, control)?)?;
    data.chunks_exact_mut(dimension).for_each(|point| {
        point.iter_mut().zip(&centre).for_each(|(x, c)| *x += c);
    });
    let natural = joined.natural;
    // A closed curve with corners is cut at the first of them: back to the order of the data.
    let mut starts = joined.parameters;
    if options.closed
        && let Some(&first) = corners.first()
    {
        starts.truncate(count);
        starts.rotate_right(first);
    }
    if let Some(over) = &over
        && !closed
    {
        starts = kept.iter().map(|&j| over.values[j]).collect();
    }
    let polyline =
        Polyline { data: &data, dimension, closed: options.closed, over: unit.as_deref() };
    let verified =
        verify::verify(&curve, &polyline, &starts, goal.judged.unwrap_or(f64::INFINITY))?;
    let mut account = verified.account;
    account.met = goal.judged.is_none_or(|limit| match goal.measure {
        Measure::Largest => account.max_distance <= limit,
        Measure::Rms | Measure::Noise => account.rms_distance <= limit,
    });
    if goal.measure == Measure::Largest
        && let Some(asked) = goal.judged
        && let Some(([a, b], apart)) = abscissa::widest_at_one(&polyline)
        && 0.5 * apart > asked
    {
        choices.push(format!(
            "caution: points {} and {} are {:.3e} apart at one abscissa, so that no curve comes closer \
             than half of that",
            kept[a],
            kept[b],
            size.scale.undo(apart)
        ));
    }
    let limit = goal.tolerance.map_or(account.max_distance, |t| goal.measure.stray(t));
    account.calm_limit = 1.05 * limit + 1.5 * natural;
    account.corners = corners;
    account.outliers = outliers;
    account.noise = goal.noise.map(|(deviation, _)| deviation);
    account.rounds = rounds;
    account.pieces = joined.knots.nonempty_spans().count();
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
    account.noise = account.noise.map(undo);
    let termination = match (cancelled, account.met) {
        (_, true) if !cancelled => Termination::Residual,
        (true, _) => Termination::Cancelled,
        _ if rounds >= most_rounds => Termination::Iterations,
        _ => Termination::Stalled,
    };
    let control = unscaled(curve.control_points().clone(), size.scale)?;
    let curve = Curve::new(knots, control)?;
    let worst = account.worst.first().copied().unwrap_or(0);
    // After all attempts, the one that is returned.
    trace.push(HistoryEntry {
        iteration: rounds + 1,
        max_residual: account.max_distance,
        rms_residual: account.rms_distance,
        normal_residual: None,
    });
    let run = RunReport {
        updates: None,
        local: None,
        foot_points: None,
        method: "approximation",
        choices,
        iterations: rounds,
        iteration_returned: rounds,
        termination,
        residual_target: goal.judged.map_or(0.0, undo),
        extent: size.extent.diagonal(),
        max_residual: account.max_distance,
        rms_residual: account.rms_distance,
        smallest_eigenvalue: None,
        least_squares: None,
        history: trace.into_entries(),
    };
    let report = CurveReport {
        points: count,
        control_points: curve.control_points().len(),
        degree: options.degree,
        dimension,
        closed: curve.is_periodic(),
        parameterization: over.as_ref().map_or("foot points", |over| over.name),
        knot_placement: "sought",
        spacing_ratio: verified.spacing_ratio,
        shape: None,
        run,
        max_residual_index: worst,
        max_deviation: account.max_distance,
        max_deviation_index: worst,
        approximation: Some(account),
    };
    Ok(CurveFit {
        curve,
        parameters: verified.parameters,
        kept_points: (count < given).then_some(kept),
        difference_vectors: unscaled(
            Points::new(dimension, verified.difference_vectors)?,
            size.scale,
        )?,
        report,
        sequence: Vec::new(),
    })
}

/// Moves the middle of the bounding box to the origin, so that far-off data lose no digits to their
/// place; gives the middle.
pub(super) fn centre_at_origin(data: &mut [f64], dimension: usize) -> Vec<f64> {
    let mut low = vec![f64::INFINITY; dimension];
    let mut high = vec![f64::NEG_INFINITY; dimension];
    for point in data.chunks_exact(dimension) {
        for i in 0..dimension {
            low[i] = low[i].min(point[i]);
            high[i] = high[i].max(point[i]);
        }
    }
    let centre: Vec<f64> = low.iter().zip(&high).map(|(a, b)| a + 0.5 * (b - a)).collect();
    data.chunks_exact_mut(dimension).for_each(|point| {
        point.iter_mut().zip(&centre).for_each(|(x, c)| *x -= c);
    });
    centre
}
