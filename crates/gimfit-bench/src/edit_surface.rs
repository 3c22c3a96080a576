//! The workload W10 on grids: single points of a bicubic surface moved.

use crate::clock::{Budget, Times, median, repeat};
use crate::edit::{Kind, MOST, farthest};
use crate::surface::Grid;
use crate::{data, workload::DIMENSION};
use gimfit::{EditableSurface, Error, GridView, KnotPlacement, SurfaceOptions, fit_surface};
use gimfit_testkit::generate::Random;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

/// Its short name.
pub const NAME: &str = "W10-grid";
/// What a reader should know about it.
pub const NOTE: &str =
    "points of a bicubic surface over averaged knots moved; a refit; m x m points of W3";
/// Rows, and columns, in larger comparisons.
pub const SIZES: &str = "100,300,1000";

/// Runs the case: random moves, then a refit of what they left; `control_points` names a file that
/// receives the control points of the edited surface. Its data points are written beside the data, as
/// `.ep`, for others to fit.
///
/// # Errors
/// If the data cannot be read or edited.
pub fn run(size: &str, seconds: f64, control_points: Option<&Path>) -> anyhow::Result<Value> {
    let count: usize = size.parse()?;
    let grid = Grid::read(count)?;
    let options = SurfaceOptions {
        knot_placements: [const { Some(KnotPlacement::Averaged) }; 2],
        ..grid.options()
    };
    let clock = Instant::now();
    let mut surface = EditableSurface::new(grid.view()?, &options)?;
    let preparing = clock.elapsed().as_secs_f64();
    let moves = shake(&mut surface, seconds)?;

    let edited = surface.points()?;
    data::write(&data::folder().join(format!("{NAME}_{size}.ep.f64")), edited.coordinates())?;
    let refit =
        |points: &[f64]| fit_surface(GridView::new([count; 2], DIMENSION, points)?, &options);
    let whole = refit(edited.coordinates())?;
    let fit = surface.fit()?;
    let ours = fit.surface.control_net().points();
    if let Some(path) = control_points {
        data::write(path, ours.coordinates())?;
    }
    let budget = Budget { seconds, least: 3, most: 100 };
    let times: Times = repeat(budget, || (), |()| refit(edited.coordinates()));
    Ok(json!({
        "workload": NAME,
        "peer": crate::edit::PEER,
        "size": size,
        "prepare": preparing,
        "move": moves.account(),
        "refit": median(&times.wall),
        "bound": surface.bound(),
        "difference": farthest(ours, whole.surface.control_net().points()),
        "extent": fit.report.run.extent,
        "max_res": fit.report.run.max_residual,
    }))
}

/// Moves random points by up to half the way to a neighbour.
fn shake(surface: &mut EditableSurface, seconds: f64) -> Result<Kind, Error> {
    let mut moves = Kind::default();
    let mut random = Random::new(5);
    let clock = Instant::now();
    for turn in 0..3 * MOST {
        let [rows, columns] = surface.shape();
        let pick =
            |count: usize, random: &mut Random| (random.unit() * (count - 1) as f64) as usize;
        let (i, j) = (pick(rows, &mut random), pick(columns, &mut random));
        let (mut point, next) = (surface.point(i, j), surface.point(i + 1, j + 1));
        for (x, y) in point.iter_mut().zip(&next) {
            *x += 0.5 * random.signed() * (y - *x);
        }
        let begin = Instant::now();
        let report = surface.move_point(i, j, &point)?;
        moves.seconds.push(begin.elapsed().as_secs_f64());
        moves.touched = moves.touched.max(report.control_points_touched);
        if turn > 30 && clock.elapsed().as_secs_f64() > seconds {
            break;
        }
    }
    Ok(moves)
}
