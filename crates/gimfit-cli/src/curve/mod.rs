//! `gimfit curve`: the main job.

mod draw;
mod explain_fit;
mod plan;
mod print;
mod save;

use crate::Ending;
use crate::arguments::CurveArguments;
use crate::explain::explain;
use crate::finish::{Finish, Run};
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use anyhow::ensure;
use explain_fit::explain_fit;
use gimfit::{PointsView, fit_curve_observed};
use gimfit_io::document::{Document, Seconds, document_of};
use gimfit_io::points::PointTable;
use plan::Plan;
use std::time::Instant;

/// A fit with everything that is told about it.
struct Job<'a> {
    table: &'a PointTable,
    fit: &'a gimfit::CurveFit,
    /// Samples in place of control points.
    samples: Option<usize>,
    document: Document,
}

pub(crate) fn run(arguments: &CurveArguments) -> anyhow::Result<Ending> {
    Wanted::new(&arguments.writing, arguments.samples.is_some()).check(&plan::inputs(arguments))?;
    ensure!(arguments.samples.is_none_or(|n| n >= 2), "--samples must be at least 2");
    signal::listen()?;
    let clock = Instant::now();
    let plan = Plan::new(arguments)?;
    let Plan { table, options } = plan;
    let read = clock.elapsed().as_secs_f64();

    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let mut progress = Progress::new(arguments.writing.quiet, options.iterations);
    signal::enter(Stage::Fitting);
    let clock = Instant::now();
    let result = fit_curve_observed(view, &options, &mut progress);
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);
    progress.finish();
    let fit = result.map_err(|error| explain_fit(error, &table, arguments))?;

    let mut document = document_of(&fit);
    document.coordinate_names = Some(table.column_names.clone());
    if let Some(report) = &mut document.report {
        report.source = Some(table.source.clone());
        report.run.choices.splice(0..0, table.notes.iter().map(|note| format!("reading: {note}")));
        report.run.seconds = Some(Seconds { read, fit: fitted, write: None });
    }
    let mut job = Job { table: &table, fit: &fit, samples: arguments.samples, document };
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
