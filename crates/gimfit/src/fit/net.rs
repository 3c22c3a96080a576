//! Runs a rule on a net: both directions at once, or one after the other.

use super::method::choose_adaptive;
use super::solve::{Size, Solved, Task, solve};
use super::surface_method::{Directions, choose_across, choose_along, choose_both};
use super::{IterationWeight, Method, SurfaceOptions, SurfaceWeight};
use crate::Error;
use crate::collocation::{
    AcrossCollocation, AlongCollocation, CollocationOperator, HeldCollocation,
    RationalTensorCollocation, ResidualNorms, TensorCollocation,
};
use crate::iteration::update::AdaptiveRows;
use crate::iteration::{HistoryEntry, Observer, Stopping, Termination};
use crate::points::GridView;
use crate::report::RunReport;

/// Everything the two ways of running share.
pub(super) struct Setting<'a> {
    pub(super) view: GridView<'a>,
    pub(super) size: &'a Size,
    pub(super) directions: Directions<'a>,
    /// Only method, weight, order, iterations and kept fits count.
    pub(super) options: &'a SurfaceOptions,
    pub(super) stopping: Stopping,
    pub(super) expand: &'a dyn Fn(Vec<f64>) -> Vec<f64>,
    /// What the net is to meet in place of the points it starts from: less than these by what
    /// control points that are held add.
    pub(super) target: Option<&'a [f64]>,
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
    pub(super) fn task(&self, operator: &'a dyn CollocationOperator, data: &'a [f64]) -> Task<'a> {
        Task {
            operator,
            data,
            dimension: self.view.dimension(),
            size: self.size,
            stopping: self.stopping,
            keep: &[],
            expand: self.expand,
            foot_points: None,
        }
    }

    /// The operator with what is held taken off.
    fn held(
        &self,
        operator: Box<dyn CollocationOperator + 'a>,
    ) -> Box<dyn CollocationOperator + 'a> {
        match self.target {
            None => operator,
            Some(target) => Box::new(HeldCollocation::new(operator, target)),
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
    let operator = setting.held(tensor(directions, dimension));
    let data = setting.view.points().coordinates();
    let task = Task { keep: &options.keep, ..setting.task(&*operator, data) };
    solve(&task, &mut chosen, observer)
}

/// The operator of a net that moves as a whole.
pub(super) fn tensor<'a>(
    directions: Directions<'a>,
    dimension: usize,
) -> Box<dyn CollocationOperator + 'a> {
    let Directions { u, v, rational } = directions;
    match rational {
        None => Box::new(TensorCollocation::new(u, v, dimension)),
        Some(net) => Box::new(RationalTensorCollocation::new(u, v, net, dimension)),
    }
}

/// The weight of a net that moves as a whole.
pub(super) fn one_weight(options: &SurfaceOptions) -> Result<&IterationWeight, Error> {
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
    let both = setting.held(tensor(directions, dimension));
    // What is left of the first run adds to what is left of the second.
    let mut stopping = setting.stopping;
    stopping.residual *= 0.5;
    let across = AcrossCollocation::new(directions.u, directions.v.points());
    let across = setting.held(Box::new(across));
    let along = AlongCollocation::new(directions.v, directions.u.points());
    let mut work = vec![0.0; data.len()];
    let before = both.difference_vectors(data, data, dimension, &mut work);

    let method = options.method;
    let mut in_u = choose_across(method, weights[0], directions, dimension)?;
    let task = Task { stopping, ..setting.task(&*across, data) };
    let first = solve(&task, &mut in_u, observer)?;
    let mut in_v = choose_along(method, weights[1], directions, dimension)?;
    let task = Task { stopping, ..setting.task(&along, &first.control) };
    let second = solve(&task, &mut in_v, observer)?;

    let norms = both.difference_vectors(data, &second.control, dimension, &mut work);
    let (first, second_run) = (first.run, second.run);
    let iterations = first.iterations + second_run.iterations;
    let endings = [first.termination, second_run.termination];
    let termination = judged(endings, norms.max, setting.stopping);
    let undo = |x: f64| setting.size.scale.undo(x);
    let entry = |iteration, norms: ResidualNorms| HistoryEntry {
        iteration,
        max_residual: undo(norms.max),
        rms_residual: undo(norms.rms),
        normal_residual: None,
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
        least_squares: None,
        history: vec![entry(0, before), entry(iterations, norms)],
    };
    let solved =
        Solved { control: second.control, vectors: work, norms, run, sequence: Vec::new() };
    Ok((solved, [first.history, second_run.history]))
}

/// How two runs ended, seen as one.
fn judged(each: [Termination; 2], residual: f64, stopping: Stopping) -> Termination {
    if stopping.residual > 0.0 && residual <= stopping.residual {
        return Termination::Residual;
    }
    overall(each)
}

/// The worse of two endings.
pub(super) fn overall(each: [Termination; 2]) -> Termination {
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
        assert_eq!(judged(both, 1.0, stopping), Termination::Iterations);
        assert_eq!(judged(both, 1e-10, stopping), Termination::Residual);
    }
}
