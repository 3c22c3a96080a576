//! The workload W7: the nearest points of a cubic curve through 1000 points, for many queries.

use crate::clock::{Budget, Times, median, repeat};
use crate::data;
use crate::workload::DIMENSION;
use gimfit::projection::CurveProjector;
use gimfit::{Curve, KnotVector, Points, PointsView};
use serde_json::{Value, json};
use std::path::Path;

/// Its short name.
pub const NAME: &str = "W7";
/// The name of our column.
pub const PEER: &str = "gimfit.nearest";
/// What a reader should know about it.
pub const NOTE: &str = "nearest points of a cubic curve through 1000 points, global minima";
/// Queries in larger comparisons.
pub const SIZES: &str = "1000,10000,100000";

/// Runs the case, preparation of the curve included each time; `distances` names a file that
/// receives what was found.
///
/// # Errors
/// If the data cannot be read.
pub fn run(size: &str, seconds: f64, distances: Option<&Path>) -> anyhow::Result<Value> {
    let knots = KnotVector::open(3, data::read(&format!("{NAME}.t"))?)?;
    let curve = Curve::new(knots, Points::new(DIMENSION, data::read(&format!("{NAME}.c"))?)?)?;
    let queries = data::read(&format!("{NAME}_{size}.q"))?;
    let view = PointsView::new(DIMENSION, &queries)?;
    let mut first = Times::default();
    let feet = first.record(|| CurveProjector::new(&curve).project_all(view))?;
    let found: Vec<f64> = feet.iter().map(|foot| foot.distance).collect();
    if let Some(path) = distances {
        data::write(path, &found)?;
    }
    let budget = Budget { seconds, least: 5, most: 10_000 };
    let times = repeat(budget, || (), |()| CurveProjector::new(&curve).project_all(view));
    let wall: f64 = times.wall.iter().sum();
    Ok(json!({
        "workload": NAME,
        "peer": PEER,
        "size": size,
        "median": median(&times.wall),
        "min": times.wall.iter().copied().fold(f64::INFINITY, f64::min),
        "reps": times.wall.len(),
        "cpu_median": median(&times.processor),
        "cpu_per_wall": times.processor.iter().sum::<f64>() / wall,
        "first_call": first.wall[0],
        "sum_of_distances": found.iter().sum::<f64>(),
    }))
}
