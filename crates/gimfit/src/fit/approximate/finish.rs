//! From what a search has found to a curve and its account.

use super::abscissa::{self, Abscissa};
use super::goal::ScaledGoal;
use super::options::ApproximationOptions;
use super::pieces::Joined;
use super::polyline::Polyline;
use super::problem::{Measure, REPORTED, STRAY};
use super::verify;
use crate::Error;
use crate::fit::CurveFit;
use crate::fit::solve::{Size, unscaled};
use crate::geometry::Curve;
use crate::iteration::{HistoryEntry, Termination, Trace};
use crate::points::Points;
use crate::report::{CurveReport, RunReport};

/// What a search has found, in the unit that it works in.
pub(super) struct Found<'a> {
    pub(super) options: &'a ApproximationOptions,
    pub(super) size: Size,
    /// Points given, and those of them that are fitted.
    pub(super) given: usize,
    pub(super) kept: Vec<usize>,
    pub(super) dimension: usize,
    /// The points fitted, around the origin, which stands for `centre`.
    pub(super) data: Vec<f64>,
    pub(super) centre: Vec<f64>,
    pub(super) goal: ScaledGoal,
    /// The abscissa, and that of the points fitted on [0, 1].
    pub(super) over: Option<Abscissa>,
    pub(super) unit: Option<Vec<f64>>,
    pub(super) corners: Vec<usize>,
    pub(super) outliers: Vec<usize>,
    pub(super) joined: Joined,
    /// Whether the curve is periodic.
    pub(super) closed: bool,
    pub(super) choices: Vec<String>,
    pub(super) trace: Trace,
    pub(super) rounds: usize,
    pub(super) most_rounds: usize,
    pub(super) cancelled: bool,
}

/// Measures the curve, and says what was reached.
pub(super) fn finish(found: Found<'_>) -> Result<CurveFit, Error> {
    let Found { options, size, given, kept, dimension, mut data, centre, goal, over, unit, .. } =
        found;
    let Found { corners, outliers, joined, closed, mut choices, mut trace, .. } = found;
    let Found { rounds, most_rounds, cancelled, .. } = found;
    let count = kept.len();
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
    account.calm_limit = STRAY * limit + REPORTED * natural;
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
