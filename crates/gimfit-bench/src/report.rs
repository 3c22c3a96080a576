//! One case from its files to its line of results.

use crate::clock::{Budget, Times, median, repeat};
use crate::workload::{Input, Workload};
use crate::{data, memory};
use serde_json::{Value, json};
use std::path::Path;

/// The name of our column.
pub const PEER: &str = "gimfit.interpolate";

/// Runs a case: once on fresh memory, then repeatedly. `control_points` names a file that receives
/// the result of the first run.
///
/// # Errors
/// If the data cannot be read or fitted.
pub fn run(
    workload: Workload,
    size: &str,
    seconds: f64,
    control_points: Option<&Path>,
) -> anyhow::Result<Value> {
    let count: usize = size.parse()?;
    let mut input = Input::read(workload, count)?;
    let before = memory::resident();
    let owned = input.take();
    let mut first = Times::default();
    let fit = first.record(|| input.interpolate(owned))?;
    let peak = memory::peak();
    let residuals = input.check(&fit)?;
    if let Some(path) = control_points {
        data::write(path, fit.curve.control_points().coordinates())?;
    }
    let report = fit.report.clone();
    drop(fit);

    // The arrays taken over by the first run are read again, and copied from then on.
    let input = Input::read(workload, count)?;
    let budget = Budget { seconds, least: 5, most: 10_000 };
    let times = repeat(budget, || input.copy(), |owned| input.interpolate(owned));
    let wall: f64 = times.wall.iter().sum();
    Ok(json!({
        "workload": workload.name(),
        "peer": PEER,
        "size": size,
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
        "iterations": report.run.iterations,
        "method": report.run.method,
        "converged": report.converged(),
    }))
}
