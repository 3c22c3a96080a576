//! The loop: measure, judge, step.

use super::stopping::StoppingRule;
use super::{
    Flow, HistoryEntry, IterationState, Observer, Snapshot, Stopping, Termination, Trace,
    UpdateRule,
};

/// How a run ended; the control points are in the state.
#[derive(Debug)]
pub struct Outcome {
    /// The named reason.
    pub termination: Termination,
    /// Steps run.
    pub iterations: usize,
    /// Residuals step by step.
    pub history: Vec<HistoryEntry>,
}

/// Runs a rule on a state until the stopping settings or the observer end it.
///
/// A run that diverged, stalled or came down to rounding leaves the control points of its smallest
/// residual in the state: it is repeated from the start up to there, which costs nothing in all
/// other cases.
pub fn run(
    state: &mut IterationState<'_>,
    rule: &mut dyn UpdateRule,
    stopping: Stopping,
    observer: &mut dyn Observer,
) -> Outcome {
    let mut judge = StoppingRule::new(stopping);
    let mut trace = Trace::with_room_for(stopping.max_iterations);
    let termination = loop {
        let entry = entry_of(state);
        trace.push(entry);
        let flow = observer.observe(Snapshot { entry, control: state.control() });
        let verdict = judge.judge(entry, || state.rounding_level());
        if let Some(reason) = verdict
            && !(reason == Termination::Stalled && rule.ends_itself())
        {
            break reason;
        }
        if flow == Flow::Stop {
            break Termination::Cancelled;
        }
        if let Some(reason) = rule.ending() {
            break reason;
        }
        state.step(rule);
    };
    let iterations = state.iteration();
    let best = judge.best_iteration();
    // All iterations, or as many as the observer allowed, are what the caller asked for; and a
    // closest fit is the last one, which is closest as a whole, not at its worst point.
    let asked = matches!(
        termination,
        Termination::Iterations | Termination::Cancelled | Termination::Constrained
    );
    if !asked && best < iterations {
        rule.reset();
        state.restart();
        (0..best).for_each(|_| state.step(rule));
    }
    Outcome { termination, iterations, history: trace.into_entries() }
}

fn entry_of(state: &IterationState<'_>) -> HistoryEntry {
    let norms = state.norms();
    HistoryEntry {
        iteration: state.iteration(),
        max_residual: norms.max,
        rms_residual: norms.rms,
        normal_residual: norms.normal,
    }
}
