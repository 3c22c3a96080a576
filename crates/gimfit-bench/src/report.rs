//! One case from its files to its line of results.

use crate::clock::{Budget, Times, median, repeat};
use crate::surface::{self, Grid};
use crate::workload::{Input, Residuals, Workload};
use crate::{data, least_squares, memory};
use gimfit::RunReport;
use serde_json::{Value, json};
use std::path::Path;

/// The name of our column.
pub const PEER: &str = "gimfit.interpolate";

/// Runs a case: once on fresh memory, then repeatedly. `control_points` names a file that receives
/// the result of the first run.
///
/// # Errors
/// If there is no such workload, or the data cannot be read or fitted.
pub fn run(
    workload: &str,
    size: &str,
    seconds: f64,
    control_points: Option<&Path>,
) -> anyhow::Result<Value> {
    let count: usize = size.parse()?;
    let mut case = Case { workload, peer: PEER, size, seconds, control_points };
    if workload == least_squares::NAME {
        case.peer = least_squares::PEER;
        let input = least_squares::Input::read(count)?;
        return case.run(
            || Ok(input.copy()),
            |owned| input.fit(owned),
            |fit| {
                let control = fit.curve.control_points().coordinates();
                Ok((input.check(fit)?, fit.report.run.clone(), control))
            },
        );
    }
    if workload == surface::NAME {
        let grid = Grid::read(count)?;
        let options = grid.options();
        return case.run(
            || Ok(()),
            |()| grid.interpolate(&options),
            |fit| {
                let net = fit.surface.control_net().points().coordinates();
                Ok((grid.check(fit)?, fit.report.run.clone(), net))
            },
        );
    }
    let named = Workload::named(workload)?;
    let input = Input::read(named, count)?;
    let mut untouched = Some(Input::read(named, count)?);
    case.run(
        // The arrays taken over by the first run are copied from then on.
        || Ok(untouched.take().map_or_else(|| input.copy(), |mut input| input.take())),
        |owned| input.interpolate(owned),
        |fit| {
            let control = fit.curve.control_points().coordinates();
            Ok((input.check(fit)?, fit.report.run.clone(), control))
        },
    )
}

/// What is asked for on the command line.
struct Case<'a> {
    workload: &'a str,
    peer: &'a str,
    size: &'a str,
    seconds: f64,
    control_points: Option<&'a Path>,
}

impl Case<'_> {
    /// `prepare` makes what `fit` takes over, outside the time measured; `judge` finds the residuals
    /// of a fit, the account of its run, and its control points.
    fn run<T, F>(
        &self,
        mut prepare: impl FnMut() -> anyhow::Result<T>,
        mut fit: impl FnMut(T) -> Result<F, gimfit::Error>,
        judge: impl Fn(&F) -> anyhow::Result<(Residuals, RunReport, &[f64])>,
    ) -> anyhow::Result<Value> {
        let owned = prepare()?;
        let before = memory::resident();
        let mut first = Times::default();
        let result = first.record(|| fit(owned))?;
        let peak = memory::peak();
        let (residuals, run, control) = judge(&result)?;
        if let Some(path) = self.control_points {
            data::write(path, control)?;
        }
        drop(result);

        let budget = Budget { seconds: self.seconds, least: 5, most: 10_000 };
        let times = repeat(budget, &mut prepare, |owned| owned.map(&mut fit));
        let wall: f64 = times.wall.iter().sum();
        Ok(json!({
            "workload": self.workload,
            "peer": self.peer,
            "size": self.size,
            "median": median(&times.wall),
            "min": times.wall.iter().copied().fold(f64::INFINITY, f64::min),
            "reps": times.wall.len(),
            "cpu_median": median(&times.processor),
            "cpu_per_wall": times.processor.iter().sum::<f64>() / wall,
            "first_call": first.wall[0],
            "rss_mb": peak,
            "work_mb": peak.zip(before).map(|(peak, before)| peak - before),
            "max_res": residuals.largest,
            "rms": residuals.root_mean_square,
            "extent": residuals.extent,
            "iterations": run.iterations,
            "method": run.method,
            "converged": run.converged(),
        }))
    }
}
