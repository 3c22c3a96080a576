//! `gimfit surface`: a surface through a grid of points.

mod arguments;
mod draw;
mod plan;
mod print;
mod save;

pub(crate) use arguments::SurfaceArguments;

use crate::Ending;
use crate::finish::{Finish, Run};
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use anyhow::{anyhow, ensure};
use gimfit::{Error, GridView, fit_surface_observed};
use gimfit_io::document::{Seconds, SurfaceDocument, surface_document_of};
use gimfit_io::grids::PointGrid;
use plan::Plan;
use std::time::Instant;

/// A fit with everything that is told about it.
struct Job<'a> {
    grid: &'a PointGrid,
    fit: &'a gimfit::SurfaceFit,
    /// Samples in place of control points.
    samples: Option<(usize, usize)>,
    document: SurfaceDocument,
}

/// Most samples of a surface: beyond, the table would not fit into memory.
const MOST_SAMPLES: usize = 1_000_000_000;

pub(crate) fn run(arguments: &SurfaceArguments) -> anyhow::Result<Ending> {
    Wanted::new(&arguments.writing, arguments.samples.is_some()).check(&plan::inputs(arguments))?;
    ensure!(
        arguments.samples.is_none_or(|(m, n)| {
            m.min(n) >= 2 && m.checked_mul(n).is_some_and(|count| count <= MOST_SAMPLES)
        }),
        "--samples must be at least 2x2, and at most 1e9 in all"
    );
    signal::listen()?;
    let clock = Instant::now();
    let Plan { grid, options } = Plan::new(arguments)?;
    let read = clock.elapsed().as_secs_f64();

    let unused = [&grid.row_abscissae, &grid.column_abscissae].map(Option::is_some) == [true; 2]
        && arguments.parameters.is_none();
    let explain = |error| explain(error, &grid);
    let view = GridView::new([grid.rows, grid.columns], grid.dimension(), &grid.coordinates)
        .map_err(explain)?;
    let mut progress = Progress::new(arguments.writing.quiet, options.iterations);
    signal::enter(Stage::Fitting);
    let clock = Instant::now();
    let result = fit_surface_observed(view, &options, &mut progress);
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);
    progress.finish();
    let mut fit = result.map_err(explain)?;
    if unused {
        fit.report.run.choices.push(
            "parameters: those in the file are left aside; --parameters axes takes them".into(),
        );
    }

    let mut document = surface_document_of(&fit);
    document.coordinate_names = Some(grid.column_names.clone());
    if let Some(report) = &mut document.report {
        report.source = Some(grid.source.clone());
        report.run.choices.splice(0..0, grid.notes.iter().map(|note| format!("reading: {note}")));
        report.run.seconds = Some(Seconds { read, fit: fitted, write: None });
    }
    let mut job = Job { grid: &grid, fit: &fit, samples: arguments.samples, document };
    let report = &fit.report;
    let finish = Finish {
        wanted: Wanted::new(&arguments.writing, arguments.samples.is_some()),
        method: arguments.iteration.method,
        run: Run {
            termination: report.run.termination,
            residual_target: report.run.residual_target,
            max_residual: report.run.max_residual,
            iterations: report.run.iterations,
        },
    };
    finish.finish(&mut job, print::report)
}

/// Errors of the library in the words of the file: points by their row and column.
fn explain(error: Error, grid: &PointGrid) -> anyhow::Error {
    let source = &grid.source;
    match error {
        Error::NotFinite { point, value, .. } => anyhow!(
            "{source}, {}: {value} is not a finite number",
            grid.point_name(point / grid.columns, point % grid.columns)
        ),
        Error::RepeatedLines { what, first, second } => anyhow!(
            "{source}: {what}s {} and {} coincide, or nearly so against the whole grid; remove one \
             of them, or use --parameters uniform",
            first + 1,
            second + 1
        ),
        Error::ParametersNotIncreasing { index, value, previous } => anyhow!(
            "{source}: abscissa {value} (number {}) does not exceed {previous} before it; abscissae \
             serve as parameters only where they rise along rows and columns: use --parameters chord, \
             or one rule for each direction, such as chord,axes",
            index + 1
        ),
        other => anyhow!("{source}: {other}"),
    }
}
