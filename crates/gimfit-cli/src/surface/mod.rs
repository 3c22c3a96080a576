//! `gimfit surface`: a surface through a grid of points.

mod approximation;
mod arguments;
mod draw;
mod edit;
mod least_squares;
mod plan;
mod print;
mod save;

pub(crate) use arguments::{GridArguments, SurfaceArguments};
pub(crate) use plan::{Form, form, form_inputs};

use crate::Ending;
use crate::basis::described;
use crate::finish::{Finish, Run, Sought};
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use anyhow::{anyhow, ensure};
use gimfit::basis::BlendingBasis;
use gimfit::fit::approximate_surface_observed;
use gimfit::fit::fit_blending_surface_observed;
use gimfit::iteration::Observer;
use gimfit::{
    BlendingSurfaceOptions, Error, GridView, SurfaceFit, SurfaceOptions, fit_least_squares_surface,
    fit_surface_observed,
};
use gimfit_io::document::{Seconds, SurfaceBlendingData, SurfaceDocument, surface_document_of};
use gimfit_io::grids::PointGrid;
use plan::Plan;
use std::sync::Arc;
use std::time::Instant;

/// A fit over other bases, in Bezier form, with what a document tells of the bases.
fn blended(
    grid: GridView<'_>,
    bases: &[Arc<dyn BlendingBasis>; 2],
    options: &SurfaceOptions,
    observer: &mut dyn Observer,
) -> Result<(SurfaceFit, Option<SurfaceBlendingData>), Error> {
    let options = BlendingSurfaceOptions {
        parameterizations: options.parameterizations.clone(),
        method: options.method,
        weight: options.weight.clone(),
        per_direction: options.per_direction,
        iterations: options.iterations,
        residual: options.residual,
        keep: options.keep.clone(),
    };
    let fit = fit_blending_surface_observed(grid, bases.clone(), &options, observer)?;
    Ok((fit.to_bezier()?, Some(SurfaceBlendingData::of(&fit.surface))))
}

/// A fit with everything that is told about it.
pub(crate) struct Job<'a> {
    grid: &'a PointGrid,
    fit: &'a SurfaceFit,
    /// What was blended in u and v, in words, if no B-splines were.
    bases: Option<[String; 2]>,
    /// Samples in place of control points.
    samples: Option<(usize, usize)>,
    seconds: Seconds,
    document: SurfaceDocument,
    /// What each move of a point did, a line each.
    edits: Vec<String>,
}

impl<'a> Job<'a> {
    pub(crate) fn new(
        grid: &'a PointGrid,
        fit: &'a SurfaceFit,
        bases: Option<[String; 2]>,
        samples: Option<(usize, usize)>,
        seconds: Seconds,
    ) -> Self {
        let mut document = surface_document_of(fit);
        document.coordinate_names = Some(grid.column_names.clone());
        if let Some(report) = &mut document.report {
            let notes = grid.notes.iter().map(|note| format!("reading: {note}"));
            report.source = Some(grid.source.clone());
            report.run.choices.splice(0..0, notes);
            report.run.seconds = Some(seconds);
        }
        Self { grid, fit, bases, samples, seconds, document, edits: Vec::new() }
    }
}

/// Most samples of a surface: beyond, the table would not fit into memory.
const MOST_SAMPLES: usize = 1_000_000_000;

pub(crate) fn run(arguments: &SurfaceArguments) -> anyhow::Result<Ending> {
    let wanted =
        Wanted::new(&arguments.writing, &arguments.iteration.keep, arguments.samples.is_some());
    wanted.check(&plan::inputs(arguments))?;
    ensure!(
        arguments.samples.is_none_or(|(m, n)| {
            m.min(n) >= 2 && m.checked_mul(n).is_some_and(|count| count <= MOST_SAMPLES)
        }),
        "--samples must be at least 2x2, and at most 1e9 in all"
    );
    signal::listen()?;
    let clock = Instant::now();
    let Plan { mut grid, options, bases, remarks, least_squares } = Plan::new(arguments)?;
    let read = clock.elapsed().as_secs_f64();

    let unused = [&grid.row_abscissae, &grid.column_abscissae].map(Option::is_some) == [true; 2]
        && arguments.grid.parameters.is_none();
    let view = GridView::new([grid.rows, grid.columns], grid.dimension(), &grid.coordinates)
        .map_err(|error| explain(error, &grid))?;
    let approximation = match least_squares {
        Some(_) => None,
        None => arguments.approximation.options(options.degrees, options.closed),
    };
    let quiet = arguments.writing.quiet;
    let mut progress = match &approximation {
        Some(_) => Progress::of_search(quiet, grid.dimension()),
        None => Progress::new(quiet, options.iterations),
    };
    let clock = Instant::now();
    let result = match (&bases, &approximation, &least_squares) {
        (_, _, Some(options)) => fit_least_squares_surface(view, options).map(|fit| (fit, None)),
        (_, Some(options), _) => {
            approximate_surface_observed(view, options, &mut progress).map(|fit| (fit, None))
        }
        (None, None, _) => {
            fit_surface_observed(view, &options, &mut progress).map(|fit| (fit, None))
        }
        (Some(bases), None, _) => blended(view, bases, &options, &mut progress),
    };
    progress.finish();
    let (mut fit, blending) = result.map_err(|error| explain(error, &grid))?;
    let edits = edit::run(&arguments.moves, &mut grid, &mut fit, options.residual)?;
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);
    fit.report.run.choices.splice(0..0, remarks);
    if unused && approximation.is_none() {
        fit.report.run.choices.push(
            "parameters: those in the file are left aside; --parameters axes takes them".into(),
        );
    }

    let seconds = Seconds { read, fit: fitted, write: None };
    let bases = bases.as_ref().map(|bases| bases.each_ref().map(|basis| described(&**basis)));
    let mut job = Job::new(&grid, &fit, bases, arguments.samples, seconds);
    job.document.blending = blending;
    job.edits = edits;
    let report = &fit.report;
    let finish = Finish {
        wanted,
        method: arguments.iteration.method,
        convex: None,
        run: Run::of(
            &report.run,
            match (&approximation, &least_squares) {
                (Some(_), _) => Sought::Distance,
                (_, Some(_)) => Sought::LeastSquares,
                _ => Sought::Residual,
            },
        ),
    };
    finish.finish(&mut job, print::report)
}

/// Errors of the library in the words of the file: points by their row and column.
pub(crate) fn explain(error: Error, grid: &PointGrid) -> anyhow::Error {
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
            "{source}: parameter {value} (number {}) does not exceed {previous} before it; parameters \
             from a file must rise, and abscissae serve as parameters only where they rise, or fall, \
             all along: use --parameters chord, or one rule for each direction, such as chord,axes",
            index + 1
        ),
        other => anyhow!("{source}: {other}"),
    }
}
