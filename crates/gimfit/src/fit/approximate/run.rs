//! One search: data made ready, outliers left out, corners found, and each piece between them sought.

use super::abscissa::{self, Abscissa};
use super::attempt::{Attempt, Effort};
use super::corners::{AUTO_ANGLE, find_corners};
use super::finish::{Found, finish};
use super::goal::check_goal;
use super::options::{ApproximationOptions, Corners, Goal};
use super::pieces::{self, Piece};
use super::polyline::{self, Polyline};
use super::problem::Problem;
use super::{SPARE, centre_at_origin, robust, sample};
use crate::Error;
use crate::fit::CurveFit;
use crate::fit::solve::Size;
use crate::iteration::{Flow, HistoryEntry, Observer, Snapshot, Trace};
use crate::knots::check_degree;
use crate::points::{Extent, PointsView};

/// Rounds times points that take about a second.
const EFFORT: usize = 2_000_000;
/// Fewest and most rounds, where they are left to us.
const ROUNDS: std::ops::RangeInclusive<usize> = 200..=4000;
/// A last point this close to the first, in units of the extent, repeats it.
const CLOSING_GAP: f64 = 1e-9;
/// One search, with the corners asked for.
pub(super) fn approximate(
    points: PointsView<'_>,
    options: &ApproximationOptions,
    observer: &mut dyn Observer,
) -> Result<CurveFit, Error> {
    check_degree(options.degree)?;
    if options.hold_ends && options.closed {
        return Err(Error::Incompatible {
            what: "held ends",
            with: "a closed curve",
            why: "it has no ends",
        });
    }
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
    let data: Vec<f64> =
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
        problem.pinned = options.hold_ends || !corners.is_empty();
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
    finish(Found {
        options,
        size,
        given,
        dimension,
        kept,
        data,
        centre,
        goal,
        over,
        unit,
        corners,
        outliers,
        joined,
        closed,
        choices,
        trace,
        rounds,
        most_rounds,
        cancelled,
    })
}
