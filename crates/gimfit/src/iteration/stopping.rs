//! When to stop, and the name of the reason.

use super::HistoryEntry;
use std::fmt;

/// Why an iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Termination {
    /// The largest residual fell to the one asked for.
    Residual,
    /// All iterations allowed were run.
    Iterations,
    /// The residual stopped falling above the one asked for.
    Stalled,
    /// The fit is the closest one that keeps what it has to keep, such as the shape of the data; the
    /// residual asked for lies beyond that.
    Constrained,
    /// The residual grew without bound or ceased to be a number.
    Diverged,
    /// An observer asked to stop.
    Cancelled,
}

impl Termination {
    /// The word used in reports and documents.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Residual => "residual",
            Self::Iterations => "iterations",
            Self::Stalled => "stalled",
            Self::Constrained => "constrained",
            Self::Diverged => "diverged",
            Self::Cancelled => "cancelled",
        }
    }
}

impl fmt::Display for Termination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// When an iteration stops. The residual judged is the largest norm of a difference vector; of least
/// squares, which leaves residuals, the largest mean difference vector of a control point
/// ([`HistoryEntry::to_limit`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopping {
    /// Largest residual to be reached, in the unit of the data; 0 runs all iterations.
    pub residual: f64,
    /// Most steps taken.
    pub max_iterations: usize,
    /// Where `residual` lies below the level of rounding, that level will do up to this one.
    pub accept_rounding: f64,
}

/// Steps without a new best residual that count as a stall.
const PATIENCE: usize = 100;
/// The same once rounding decides.
const PATIENCE_AT_ROUNDING: usize = 4;
/// Growth over the first residual that counts as divergence. Iterations with a matrix that is not
/// normal may rise before they fall, but by far less.
const DIVERGENCE: f64 = 1e8;

/// Applies [`Stopping`] to a run.
#[derive(Debug, Clone)]
pub(super) struct StoppingRule {
    settings: Stopping,
    first: f64,
    best: f64,
    best_iteration: usize,
    /// The root mean square when it last fell, and the iteration.
    least: f64,
    fell: usize,
}

/// By how much the root mean square of least squares must fall to count as a gain.
const FALL: f64 = 1.0 - 1e-9;

impl StoppingRule {
    pub(super) fn new(settings: Stopping) -> Self {
        let (first, best, least) = (f64::NAN, f64::INFINITY, f64::INFINITY);
        Self { settings, first, best, best_iteration: 0, least, fell: 0 }
    }

    /// Iteration of the smallest residual met.
    pub(super) fn best_iteration(&self) -> usize {
        self.best_iteration
    }

    /// Judges the residual after an iteration.
    /// `rounding_level` tells the residual below which rounding alone decides; it is asked for only
    /// after steps without gain.
    pub(super) fn judge(
        &mut self,
        entry: HistoryEntry,
        rounding_level: impl Fn() -> f64,
    ) -> Option<Termination> {
        let Stopping { residual, max_iterations, accept_rounding } = self.settings;
        let HistoryEntry { iteration, rms_residual, .. } = entry;
        let max_residual = entry.to_limit();
        if iteration == 0 {
            self.first = max_residual;
        }
        if !(max_residual.is_finite() && rms_residual.is_finite()) {
            return Some(Termination::Diverged);
        }
        if max_residual < self.best {
            self.best = max_residual;
            self.best_iteration = iteration;
        }
        if residual > 0.0 && max_residual <= residual {
            return Some(Termination::Residual);
        }
        if max_residual > DIVERGENCE * self.first && max_residual > DIVERGENCE * rounding_level() {
            return Some(Termination::Diverged);
        }
        if iteration >= max_iterations {
            return Some(Termination::Iterations);
        }
        // What least squares makes smallest is the root mean square; the normal residual may rest
        // meanwhile, where few data meet a control point.
        if entry.normal_residual.is_some() && rms_residual < FALL * self.least {
            (self.least, self.fell) = (rms_residual, iteration);
        }
        let without_gain = iteration - self.best_iteration.max(self.fell);
        if residual == 0.0 || without_gain == 0 {
            return None;
        }
        let level = rounding_level();
        let rounded = max_residual <= level;
        if rounded && level <= accept_rounding {
            return Some(Termination::Residual);
        }
        let patience = if rounded { PATIENCE_AT_ROUNDING } else { PATIENCE };
        (without_gain >= patience).then_some(Termination::Stalled)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(settings: Stopping, residuals: impl Iterator<Item = f64>) -> (Termination, usize) {
        let mut rule = StoppingRule::new(settings);
        for (iteration, r) in residuals.enumerate() {
            let entry =
                HistoryEntry { iteration, max_residual: r, rms_residual: r, normal_residual: None };
            if let Some(reason) = rule.judge(entry, || 1e-15) {
                return (reason, iteration);
            }
        }
        panic!("the run did not end")
    }

    const SETTINGS: Stopping =
        Stopping { residual: 1e-12, max_iterations: 1000, accept_rounding: 0.0 };

    #[test]
    fn every_reason_is_met() {
        let halving = (0..).map(|k| 0.5_f64.powi(k));
        assert_eq!(end(SETTINGS, halving.clone()), (Termination::Residual, 40));
        let all = Stopping { residual: 0.0, max_iterations: 70, ..SETTINGS };
        assert_eq!(end(all, halving), (Termination::Iterations, 70));
        let stuck = (0..).map(|k| 0.5_f64.powi(k).max(1e-3));
        assert_eq!(end(SETTINGS, stuck), (Termination::Stalled, 110));
        let growing = (0..).map(|k| 2.0_f64.powi(k));
        assert_eq!(end(SETTINGS, growing), (Termination::Diverged, 27));
        let broken = [1.0, f64::NAN].into_iter();
        assert_eq!(end(SETTINGS, broken), (Termination::Diverged, 1));
    }

    #[test]
    fn rounding_is_accepted_only_where_it_was_agreed() {
        let floor = (0..).map(|k| 0.01_f64.powi(k).max(5e-16));
        let strict = Stopping { residual: 1e-16, ..SETTINGS };
        assert_eq!(end(strict, floor.clone()), (Termination::Stalled, 12));
        let agreed = Stopping { accept_rounding: 1e-14, ..strict };
        assert_eq!(end(agreed, floor), (Termination::Residual, 9));
    }

    #[test]
    fn slow_but_steady_gain_is_no_stall() {
        let slow = (0..).map(|k| 0.9999_f64.powi(k));
        assert_eq!(end(SETTINGS, slow), (Termination::Iterations, 1000));
    }
}
