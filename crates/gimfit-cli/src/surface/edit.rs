//! Points of a grid that are moved after the fit.

use super::SurfaceArguments;
use crate::report_text::time;
use crate::values;
use anyhow::{anyhow, ensure};
use gimfit::{EditableSurface, GridView, SurfaceEditReport, SurfaceFit};
use gimfit_io::grids::PointGrid;
use std::ops::Range;
use std::time::Instant;

/// One move as it was given.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GridMove {
    /// Row and column of the point, from 1.
    place: [usize; 2],
    /// Where it goes.
    point: Vec<f64>,
    text: String,
}

impl GridMove {
    /// Reads `ROW,COLUMN=X,Y,...`.
    pub(crate) fn read(text: &str) -> Result<Self, String> {
        let malformed = || "it must be a row, a column and a place, such as 8,5=1,2,0.5".to_owned();
        let (place, point) = text.split_once('=').ok_or_else(malformed)?;
        let (row, column) = place.split_once(',').ok_or_else(malformed)?;
        let number = |part: &str| match part.trim().parse() {
            Ok(0) => Err("rows and columns count from 1".to_owned()),
            Ok(number) => Ok(number),
            Err(_) => Err(format!("\"{}\" is not the number of a row or column", part.trim())),
        };
        let place = [number(row)?, number(column)?];
        let point = point.split(',').map(|part| values::number(part.trim()));
        Ok(Self { place, point: point.collect::<Result<_, _>>()?, text: format!("--move {text}") })
    }
}

impl SurfaceArguments {
    /// Refuses moves of fits that no refit is.
    pub(super) fn ensure_moves_fit(&self) -> anyhow::Result<()> {
        let moves = !self.moves.is_empty();
        let why = "a point moves on the fit of all points";
        ensure!(!moves || self.iteration.keep.is_empty(), "--move does not go with --keep: {why}");
        ensure!(!moves || self.iteration.only.is_empty(), "--move does not go with --only: {why}");
        Ok(())
    }
}

/// Moves points one after another, each on the surface that the one before left, and tells what each
/// did. The grid and the fit become those of the points moved.
pub(super) fn run(
    moves: &[GridMove],
    grid: &mut PointGrid,
    fit: &mut SurfaceFit,
    residual: Option<f64>,
) -> anyhow::Result<Vec<String>> {
    if moves.is_empty() {
        return Ok(Vec::new());
    }
    let (source, dimension) = (grid.source.clone(), grid.dimension());
    let explain = |error| anyhow!("{source}: {error}");
    let view =
        GridView::new([grid.rows, grid.columns], dimension, &grid.coordinates).map_err(explain)?;
    let surface = EditableSurface::from_fit(view, fit).map_err(explain)?;
    let mut surface = surface.with_residual(residual);
    let mut told = Vec::new();
    for GridMove { place, point, text } in moves {
        let shape = surface.shape();
        for (k, what) in ["row", "column"].into_iter().enumerate() {
            ensure!(
                place[k] <= shape[k],
                "{text}: there is no {what} {}, the last one fitted is {}",
                place[k],
                shape[k]
            );
        }
        ensure!(
            point.len() == dimension,
            "{text}: {} given, but the points have {dimension}",
            if point.len() == 1 {
                "1 number is".into()
            } else {
                format!("{} numbers are", point.len())
            }
        );
        let clock = Instant::now();
        let [row, column] = [place[0] - 1, place[1] - 1];
        let report =
            surface.move_point(row, column, point).map_err(|error| anyhow!("{text}: {error}"))?;
        told.push(line(*place, &report, shape, clock.elapsed().as_secs_f64()));
        grid.coordinates[(row * grid.columns + column) * dimension..][..dimension]
            .copy_from_slice(point);
    }
    let choices = std::mem::take(&mut fit.report.run.choices);
    *fit = surface.fit()?;
    fit.report.run.choices.splice(0..0, choices);
    Ok(told)
}

/// What a move did.
fn line(place: [usize; 2], report: &SurfaceEditReport, shape: [usize; 2], seconds: f64) -> String {
    let within = if report.bound.is_finite() {
        format!("at most {:.1e} from a fit of all points", report.bound)
    } else {
        "no bound on the way to a fit of all points".into()
    };
    // Those of a closed direction go on past the last.
    let lines = |range: &Range<usize>, count: usize| {
        format!("{} to {} of {count}", range.start + 1, (range.end - 1) % count + 1)
    };
    format!(
        "moved {},{}: control points of rows {}, columns {} touched, residual {:.1e}, {within}, {}",
        place[0],
        place[1],
        lines(&report.window[0], shape[0]),
        lines(&report.window[1], shape[1]),
        report.max_residual,
        time(seconds)
    )
}
