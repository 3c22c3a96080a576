//! Keeps the fits of chosen iterations while the caller's observer watches.

use super::solve::unscaled;
use crate::Error;
use crate::iteration::{Flow, HistoryEntry, Observer, Outcome, Snapshot};
use crate::points::{Points, PowerOfTwoScale};
use crate::report::FootPointReport;

/// A fit of an earlier iteration; its knots are those of the final one.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptFit {
    /// Steps taken and residuals reached.
    pub entry: HistoryEntry,
    /// Its control points as stored in the final geometry, shape (n, dimension), a net row by row.
    pub control_points: Points,
    /// Where its foot points were, of geometric interpolation.
    pub foot_points: Option<KeptFootPoints>,
}

/// The foot points of geometric interpolation after a step.
#[derive(Debug, Clone, PartialEq)]
pub struct KeptFootPoints {
    /// Parameters of the data points, inside the domain: of a curve one per point, of a surface u and
    /// v of each point, row by row. `None` where those of a surface are those of its rows and columns.
    pub parameters: Option<Vec<f64>>,
    /// How they fared up to there.
    pub report: FootPointReport,
    /// The smallest eigenvalue met up to there.
    pub smallest_eigenvalue: Option<f64>,
}

pub(super) struct Keeper<'a> {
    wanted: Vec<usize>,
    kept: Vec<(HistoryEntry, Vec<f64>, Option<KeptFootPoints>)>,
    expand: &'a dyn Fn(Vec<f64>) -> Vec<f64>,
    foot_points: Option<&'a dyn Fn() -> KeptFootPoints>,
    dimension: usize,
    observer: &'a mut dyn Observer,
}

impl<'a> Keeper<'a> {
    pub(super) fn new(
        wanted: &[usize],
        expand: &'a dyn Fn(Vec<f64>) -> Vec<f64>,
        foot_points: Option<&'a dyn Fn() -> KeptFootPoints>,
        dimension: usize,
        observer: &'a mut dyn Observer,
    ) -> Self {
        let mut wanted = wanted.to_vec();
        wanted.sort_unstable();
        wanted.dedup();
        Self { wanted, kept: Vec::new(), expand, foot_points, dimension, observer }
    }

    /// The fits kept, in the unit of the data; says which were never reached.
    pub(super) fn finish(
        self,
        scale: PowerOfTwoScale,
        outcome: &Outcome,
        choices: &mut Vec<String>,
    ) -> Result<Vec<KeptFit>, Error> {
        let missing: Vec<String> = self
            .wanted
            .iter()
            .filter(|&&k| k > outcome.iterations)
            .map(ToString::to_string)
            .collect();
        if !missing.is_empty() {
            choices.push(format!(
                "kept fits: the run ended after {} iterations, so there is none of iteration {}",
                outcome.iterations,
                missing.join(", ")
            ));
        }
        self.kept
            .into_iter()
            .map(|(mut entry, control, foot_points)| {
                undo(scale, &mut entry);
                let stored = (self.expand)(control);
                let control_points = unscaled(Points::new(self.dimension, stored)?, scale)?;
                Ok(KeptFit { entry, control_points, foot_points })
            })
            .collect()
    }
}

/// Brings residuals back into the unit of the data.
pub(super) fn undo(scale: PowerOfTwoScale, entry: &mut HistoryEntry) {
    entry.max_residual = scale.undo(entry.max_residual);
    entry.rms_residual = scale.undo(entry.rms_residual);
    entry.normal_residual = entry.normal_residual.map(|x| scale.undo(x));
}

impl Observer for Keeper<'_> {
    fn observe(&mut self, snapshot: Snapshot<'_>) -> Flow {
        if self.wanted.binary_search(&snapshot.entry.iteration).is_ok() {
            let foot_points = self.foot_points.map(|tell| tell());
            self.kept.push((snapshot.entry, snapshot.control.to_vec(), foot_points));
        }
        self.observer.observe(snapshot)
    }
}
