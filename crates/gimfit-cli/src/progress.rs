//! A progress bar on a terminal, once the work turns out to be long.

use crate::signal::{self, Stage};
use gimfit::iteration::{Flow, Observer, Snapshot};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// Work shorter than this needs no bar.
const PATIENCE: Duration = Duration::from_millis(500);

/// Watches an iteration: shows its residual, passes interrupts on.
pub(crate) struct Progress {
    started: Instant,
    bar: Option<ProgressBar>,
    enabled: bool,
    kind: Kind,
}

/// What is watched.
#[derive(Debug, Clone, Copy)]
enum Kind {
    /// A run of at most so many iterations.
    Run { most: usize },
    /// A search for few control points of a dimension, whose end nobody knows.
    Search { dimension: usize },
}

impl Progress {
    /// Shows nothing if `quiet`, or where no terminal is listening.
    pub(crate) fn new(quiet: bool, most: usize) -> Self {
        Self::of(quiet, Kind::Run { most })
    }

    /// Of a search for few control points.
    pub(crate) fn of_search(quiet: bool, dimension: usize) -> Self {
        Self::of(quiet, Kind::Search { dimension: dimension.max(1) })
    }

    fn of(quiet: bool, kind: Kind) -> Self {
        let enabled = !quiet && std::io::stderr().is_terminal();
        Self { started: Instant::now(), bar: None, enabled, kind }
    }

    fn show(&mut self, snapshot: &Snapshot<'_>) {
        if !self.enabled || self.started.elapsed() < PATIENCE {
            return;
        }
        let elapsed = self.started.elapsed();
        let position = snapshot.entry.iteration as u64;
        let error = snapshot.entry.max_residual;
        let (message, template, most) = match self.kind {
            Kind::Run { most } => (
                format!("residual {error:.2e}"),
                "{elapsed} [{bar:20}] {pos}/{len} {wide_msg}",
                most as u64,
            ),
            Kind::Search { dimension } => (
                format!(
                    "{} control points, largest distance {error:.2e}",
                    snapshot.control.len() / dimension
                ),
                "{elapsed} {spinner} round {pos}: {wide_msg}",
                u64::MAX,
            ),
        };
        // All is set before the bar is drawn first; what is too wide for the line is cut.
        let bar = self.bar.get_or_insert_with(|| {
            let style = ProgressStyle::with_template(template);
            let bar = ProgressBar::new(most)
                .with_elapsed(elapsed)
                .with_position(position)
                .with_message(message.clone());
            style.map_or(bar.clone(), |style| bar.with_style(style))
        });
        bar.set_message(message);
        bar.set_position(position);
    }

    /// Takes the bar away.
    pub(crate) fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Observer for Progress {
    fn observe(&mut self, snapshot: Snapshot<'_>) -> Flow {
        // From here on there is a fit; an interrupt before ends the program.
        signal::enter(Stage::Fitting);
        self.show(&snapshot);
        if signal::interrupted() { Flow::Stop } else { Flow::Continue }
    }
}
