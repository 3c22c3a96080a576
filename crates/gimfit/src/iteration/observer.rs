//! Watchers stand outside the loop and may ask it to stop: kept fits, progress bars, interrupts.

use super::HistoryEntry;

/// What an observer answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flow {
    /// Go on.
    Continue,
    /// Stop with [`Termination::Cancelled`](super::Termination::Cancelled).
    Stop,
}

/// What an observer sees after the start and after every step.
#[derive(Debug, Clone, Copy)]
pub struct Snapshot<'a> {
    /// Iteration and residuals, in the unit the iteration works in.
    pub entry: HistoryEntry,
    /// Moving control points, shape (points, dimension).
    pub control: &'a [f64],
}

/// Watches a run.
pub trait Observer {
    /// Called before the first step and after every step.
    fn observe(&mut self, snapshot: Snapshot<'_>) -> Flow;
}

/// Watches nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoObserver;

impl Observer for NoObserver {
    fn observe(&mut self, _: Snapshot<'_>) -> Flow {
        Flow::Continue
    }
}

impl<F: FnMut(Snapshot<'_>) -> Flow> Observer for F {
    fn observe(&mut self, snapshot: Snapshot<'_>) -> Flow {
        self(snapshot)
    }
}
