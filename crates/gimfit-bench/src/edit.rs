//! The workload W10: single points of a long cubic curve moved, inserted and removed.

use crate::clock::{Budget, Times, median, repeat};
use crate::data;
use crate::workload::DIMENSION;
use gimfit::fit::interpolate;
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::{
    CurveOptions, EditableCurve, Error, KnotPlacement, Parameterization, Points, PointsView,
};
use gimfit_testkit::generate::Random;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

/// Its short name.
pub const NAME: &str = "W10";
/// The name of our column.
pub const PEER: &str = "gimfit.edit";
/// What a reader should know about it.
pub const NOTE: &str =
    "points of a cubic curve over averaged knots moved, inserted, removed; a refit";
/// Points in larger comparisons.
pub const SIZES: &str = "1000,10000,100000,1000000";

/// Edits of each kind at most.
pub(crate) const MOST: usize = 3000;

/// Seconds and control points touched of edits of one kind.
#[derive(Debug, Default)]
pub(crate) struct Kind {
    pub(crate) seconds: Vec<f64>,
    pub(crate) touched: usize,
}

impl Kind {
    pub(crate) fn account(&self) -> Value {
        json!({
            "median": median(&self.seconds),
            "slowest": self.seconds.iter().copied().fold(0.0, f64::max),
            "count": self.seconds.len(),
            "most_touched": self.touched,
        })
    }
}

/// Runs the case: random edits, then a refit of what they left; `control_points` names a file that
/// receives the control points of the edited curve. Its data points and their parameters are written
/// beside the data, as `.ep` and `.eu`, for others to fit.
///
/// # Errors
/// If the data cannot be read or edited.
pub fn run(size: &str, seconds: f64, control_points: Option<&Path>) -> anyhow::Result<Value> {
    let name = format!("{NAME}_{size}");
    let points = data::read(&format!("{name}.p"))?;
    let options = CurveOptions {
        parameterization: Some(Parameterization::Given(data::read(&format!("{name}.u"))?)),
        knot_placement: Some(KnotPlacement::Averaged),
        ..CurveOptions::default()
    };
    let clock = Instant::now();
    let mut curve = EditableCurve::new(PointsView::new(DIMENSION, &points)?, &options)?;
    let preparing = clock.elapsed().as_secs_f64();
    let kinds = edit(&mut curve, seconds)?;

    let (edited, t) = (curve.points()?, curve.parameters());
    data::write(&data::folder().join(format!("{name}.ep.f64")), edited.coordinates())?;
    data::write(&data::folder().join(format!("{name}.eu.f64")), &t)?;
    let refit = |parameters: Result<Parameters, Error>| {
        let parameters = parameters?;
        let knots = place_knots(3, &parameters, &KnotPlacement::Averaged)?;
        interpolate(&edited, parameters, knots, &CurveOptions::default())
    };
    let whole = refit(Parameters::open(t.clone()))?;
    let fit = curve.fit()?;
    if let Some(path) = control_points {
        data::write(path, fit.curve.control_points().coordinates())?;
    }
    let budget = Budget { seconds, least: 5, most: 1000 };
    let times: Times = repeat(budget, || Parameters::open(t.clone()), refit);
    Ok(json!({
        "workload": NAME,
        "peer": PEER,
        "size": size,
        "prepare": preparing,
        "move": kinds[0].account(),
        "insert": kinds[1].account(),
        "remove": kinds[2].account(),
        "refit": median(&times.wall),
        "bound": curve.bound(),
        "difference": farthest(fit.curve.control_points(), whole.curve.control_points()),
        "extent": fit.report.run.extent,
        "max_res": fit.report.run.max_residual,
    }))
}

/// Moves, insertions and removals in turns, so that the number of points stays about the same, each
/// of a random point to somewhere near the line to its successor.
fn edit(curve: &mut EditableCurve, seconds: f64) -> Result<[Kind; 3], Error> {
    let mut kinds: [Kind; 3] = Default::default();
    let mut random = Random::new(5);
    let clock = Instant::now();
    for turn in 0..3 * MOST {
        let at = 1 + (random.unit() * (curve.len() - 2) as f64) as usize;
        let (here, next) = (curve.point(at), curve.point(at + 1));
        let share = 0.3 + 0.4 * random.unit();
        let near: Vec<f64> = here.iter().zip(&next).map(|(a, b)| a + share * (b - a)).collect();
        let begin = Instant::now();
        let report = match turn % 3 {
            0 => curve.move_point(at, &near),
            1 => curve.insert_point(at + 1, &near),
            _ => curve.remove_point(at),
        }?;
        let kind = &mut kinds[turn % 3];
        kind.seconds.push(begin.elapsed().as_secs_f64());
        kind.touched = kind.touched.max(report.control_points_touched);
        if turn > 30 && clock.elapsed().as_secs_f64() > seconds {
            break;
        }
    }
    Ok(kinds)
}

/// Largest distance between points of the same number.
pub(crate) fn farthest(a: &Points, b: &Points) -> f64 {
    let gaps = a.iter().zip(b.iter());
    let squares = gaps.map(|(a, b)| a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>());
    squares.fold(0.0, f64::max).sqrt()
}
