//! What every recipe shares: run a rule to its stop, look at what it left, and bring everything
//! back into the unit of the data.

use super::keep::{Keeper, undo};
use super::method::ChosenRule;
use super::{Convexity, KeptFit, KeptFootPoints};
use crate::Error;
use crate::collocation::{CollocationOperator, ResidualNorms};
use crate::iteration::{IterationState, Observer, Outcome, ROUNDING, Stopping, Termination, run};
use crate::points::{Extent, Points, PowerOfTwoScale};
use crate::report::{LeastSquaresReport, RunReport};

/// Share of the extent that a residual may keep by default.
pub(super) const DEFAULT_RESIDUAL: f64 = 1e-12;
/// Share of the extent that rounding may take where no residual was demanded.
pub(super) const MOST_ROUNDING: f64 = 1e-9;
/// Control points this many extents, and this many times the data, away from the origin are no fit
/// that anybody wants.
const WILD_SWING: f64 = 1e3;

/// The size of the data, in their own unit and as the iteration sees them.
#[derive(Debug, Clone)]
pub(super) struct Size {
    pub(super) scale: PowerOfTwoScale,
    pub(super) extent: Extent,
}

impl Size {
    pub(super) fn of(extent: Extent) -> Self {
        Self { scale: PowerOfTwoScale::for_magnitude(extent.largest_coordinate()), extent }
    }

    /// Residual that rounding of the data alone explains, scaled.
    pub(super) fn rounding_level(&self) -> f64 {
        ROUNDING * self.scale.up(self.extent.largest_coordinate())
    }

    fn diagonal(&self) -> f64 {
        self.scale.up(self.extent.diagonal())
    }

    /// The length, scaled, below which convexity-preserving PIA decides no more.
    pub(super) fn threshold(&self, convexity: Option<Convexity>) -> Result<f64, Error> {
        match convexity {
            Some(Convexity::Published { threshold: Some(length) }) => {
                if length > 0.0 && length.is_finite() {
                    Ok(self.scale.up(length))
                } else {
                    Err(Error::OutOfRange {
                        what: "threshold of convexity".into(),
                        value: length,
                        rule: "it must be a length above 0, and finite",
                    })
                }
            }
            _ => Ok((DEFAULT_RESIDUAL * self.diagonal()).max(self.rounding_level())),
        }
    }

    /// When to stop, for the residual asked for, or the default.
    pub(super) fn stopping(
        &self,
        residual: Option<f64>,
        max_iterations: usize,
        choices: &mut Vec<String>,
    ) -> Result<Stopping, Error> {
        let target = match residual {
            Some(residual) if residual >= 0.0 && residual.is_finite() => self.scale.up(residual),
            Some(value) => {
                return Err(Error::OutOfRange {
                    what: "residual".into(),
                    value,
                    rule: "it must be 0 or more, and finite",
                });
            }
            None => {
                let share = DEFAULT_RESIDUAL * self.diagonal();
                let level = self.rounding_level();
                if share < level {
                    choices.push(format!(
                        "residual: {:e}, what rounding of the coordinates allows; 1e-12 of the \
                         extent would be less",
                        self.scale.undo(level)
                    ));
                }
                share.max(level)
            }
        };
        let accept_rounding = match residual {
            None => target.max(MOST_ROUNDING * self.diagonal()),
            Some(_) => 0.0,
        };
        Ok(Stopping { residual: target, max_iterations, accept_rounding })
    }
}

/// A run that has ended. Control points, difference vectors and norms are scaled still; the rest is
/// in the unit of the data.
pub(super) struct Solved {
    pub(super) control: Vec<f64>,
    pub(super) vectors: Vec<f64>,
    pub(super) norms: ResidualNorms,
    pub(super) run: RunReport,
    pub(super) sequence: Vec<KeptFit>,
}

/// What is to be solved.
pub(super) struct Task<'a> {
    pub(super) operator: &'a dyn CollocationOperator,
    /// Scaled, shape (points, dimension).
    pub(super) data: &'a [f64],
    pub(super) dimension: usize,
    pub(super) size: &'a Size,
    pub(super) stopping: Stopping,
    /// Iterations to keep.
    pub(super) keep: &'a [usize],
    /// Makes stored control points of moving ones.
    pub(super) expand: &'a dyn Fn(Vec<f64>) -> Vec<f64>,
    /// Tells where foot points are, if they move.
    pub(super) foot_points: Option<&'a dyn Fn() -> KeptFootPoints>,
}

/// Runs a rule from the data to its stop.
pub(super) fn solve(
    task: &Task<'_>,
    chosen: &mut ChosenRule<'_>,
    observer: &mut dyn Observer,
) -> Result<Solved, Error> {
    solve_from(task, task.data, chosen, observer)
}

/// Runs a rule from given control points, scaled as the data, to its stop.
pub(super) fn solve_from(
    task: &Task<'_>,
    start: &[f64],
    chosen: &mut ChosenRule<'_>,
    observer: &mut dyn Observer,
) -> Result<Solved, Error> {
    let &Task { operator, data, dimension, size, stopping, keep, expand, foot_points } = task;
    let scale = size.scale;
    let mut choices = std::mem::take(&mut chosen.choices);
    let mut state = IterationState::begin_at(operator, data, start, dimension);
    let mut keeper = Keeper::new(keep, expand, foot_points, dimension, observer);
    let outcome = run(&mut state, chosen.rule.as_mut(), stopping, &mut keeper);
    let sequence = keeper.finish(scale, &outcome, &mut choices)?;
    let Outcome { termination, iterations, mut history } = outcome;
    let norms = state.norms();
    // Every control point has its part in a difference vector, so these tell of all of them.
    if !norms.is_finite() {
        return Err(Error::LeavesDoubles);
    }
    let reached_rounding = state.rounding_level();
    let mut target = stopping.residual;
    if termination == Termination::Residual && norms.to_limit() > target {
        target = reached_rounding;
        choices.push(format!(
            "residual: {:e}, what rounding leaves with control points this large",
            scale.undo(reached_rounding)
        ));
    }
    let swing = reached_rounding / (ROUNDING * size.diagonal());
    if swing > WILD_SWING && reached_rounding > WILD_SWING * size.rounding_level() {
        choices.push(format!(
            "caution: control points reach {swing:.0e} times the extent of the data; this \
             interpolant swings wildly between its points: lower the degree, or use \
             centripetal parameters"
        ));
    }
    history.iter_mut().for_each(|entry| undo(scale, entry));
    let iteration_returned = state.iteration();
    let (control, vectors) = state.into_parts();
    let run = RunReport {
        method: chosen.name,
        choices,
        iterations,
        iteration_returned,
        termination,
        residual_target: scale.undo(target),
        extent: size.extent.diagonal(),
        max_residual: scale.undo(norms.max),
        rms_residual: scale.undo(norms.rms),
        smallest_eigenvalue: chosen.smallest_eigenvalue,
        updates: chosen.rule.updates(),
        local: None,
        foot_points: None,
        least_squares: norms.normal.map(|normal| LeastSquaresReport {
            normal_residual: scale.undo(normal),
            unmet_control_points: 0,
        }),
        history,
    };
    Ok(Solved { control, vectors, norms, run, sequence })
}

/// Brings points back into the unit of the data.
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

/// Euclidean norm; vectors whose squares underflow or overflow are met with `hypot`.
pub(super) fn norm(vector: &[f64]) -> f64 {
    let square: f64 = vector.iter().map(|x| x * x).sum();
    if square.is_normal() && square.is_finite() {
        return square.sqrt();
    }
    vector.iter().fold(0.0, |sum: f64, x| sum.hypot(*x))
}
