//! `gimfit curve`: the main job.

mod approximation;
mod constraints;
mod draw;
pub(crate) mod edit;
mod explain_fit;
mod least_squares;
mod plan;
mod print;
mod save;

pub(crate) use approximation::{ApproximationArguments, CornersChoice};
pub(crate) use least_squares::{
    LeastSquaresArguments, method as least_squares_method, weight as least_squares_weight,
};

use crate::Ending;
use crate::arguments::CurveArguments;
use crate::basis::described;
use crate::explain::explain;
use crate::finish::{Finish, Run, Sought};
use crate::outputs::Wanted;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use anyhow::ensure;
pub(crate) use explain_fit::explain_fit;
use gimfit::basis::BlendingBasis;
use gimfit::fit::fit_blending_curve_observed;
use gimfit::iteration::Observer;
use gimfit::{
    BlendingOptions, CurveFit, CurveOptions, Error, PointsView, approximate_curve_observed,
    fit_curve_observed, fit_least_squares_observed,
};
use gimfit_io::document::{BlendingData, Document, Seconds, document_of};
use gimfit_io::points::PointTable;
use plan::{Plan, Recipe};
pub(crate) use plan::{Shape, degree, knot_placement, shape};
use std::sync::Arc;
use std::time::Instant;

/// A fit over another basis, in Bezier form, with what a document tells of the basis.
fn blended(
    points: PointsView<'_>,
    basis: &Arc<dyn BlendingBasis>,
    options: &CurveOptions,
    observer: &mut dyn Observer,
) -> Result<(CurveFit, Option<BlendingData>), Error> {
    let options = BlendingOptions {
        parameterization: options.parameterization.clone(),
        method: options.method,
        weight: options.weight.clone(),
        iterations: options.iterations,
        residual: options.residual,
        keep: options.keep.clone(),
    };
    let fit = fit_blending_curve_observed(points, Arc::clone(basis), &options, observer)?;
    Ok((fit.to_bezier()?, Some(BlendingData::of(&fit.curve))))
}

/// A fit with everything that is told about it.
pub(crate) struct Job<'a> {
    table: &'a PointTable,
    fit: &'a CurveFit,
    /// What was blended, in words, if no B-splines were.
    basis: Option<String>,
    /// Samples in place of control points.
    samples: Option<usize>,
    seconds: Seconds,
    document: Document,
    /// What each edit did, a line each.
    edits: Vec<String>,
}

impl<'a> Job<'a> {
    pub(crate) fn new(
        table: &'a PointTable,
        fit: &'a CurveFit,
        basis: Option<String>,
        samples: Option<usize>,
        seconds: Seconds,
    ) -> Self {
        let mut document = document_of(fit);
        document.coordinate_names = Some(table.column_names.clone());
        if let Some(report) = &mut document.report {
            let notes = table.notes.iter().map(|note| format!("reading: {note}"));
            report.source = Some(table.source.clone());
            report.run.choices.splice(0..0, notes);
            report.run.seconds = Some(seconds);
        }
        Self { table, fit, basis, samples, seconds, document, edits: Vec::new() }
    }
}

pub(crate) fn run(arguments: &CurveArguments) -> anyhow::Result<Ending> {
    let wanted =
        Wanted::new(&arguments.writing, &arguments.iteration.keep, arguments.samples.is_some());
    wanted.check(&plan::inputs(arguments))?;
    ensure!(arguments.samples.is_none_or(|n| n >= 2), "--samples must be at least 2");
    signal::listen()?;
    let clock = Instant::now();
    let plan = Plan::new(arguments)?;
    let Plan { table, options, recipe } = plan;
    let read = clock.elapsed().as_secs_f64();

    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let quiet = arguments.writing.quiet;
    let mut progress = match &recipe {
        Recipe::Approximate(_) => Progress::of_search(quiet, table.dimension()),
        _ => Progress::new(quiet, options.iterations),
    };
    let clock = Instant::now();
    let result = match &recipe {
        Recipe::Interpolate => {
            fit_curve_observed(view, &options, &mut progress).map(|fit| (fit, None))
        }
        Recipe::Blend(basis) => blended(view, basis, &options, &mut progress),
        Recipe::Approximate(options) => {
            approximate_curve_observed(view, options, &mut progress).map(|fit| (fit, None))
        }
        Recipe::LeastSquares(options) => {
            fit_least_squares_observed(view, options, &mut progress).map(|fit| (fit, None))
        }
    };
    let fitted = clock.elapsed().as_secs_f64();
    signal::enter(Stage::Writing);
    progress.finish();
    let (fit, blending) =
        result.map_err(|error| match (&error, &arguments.least_squares.constraints) {
            (Error::ConstraintsConflict { positions, .. }, Some(path)) => {
                constraints::conflict(path, positions)
            }
            _ => explain_fit(error, &table, &arguments.input, &arguments.shape),
        })?;

    let basis = match &recipe {
        Recipe::Blend(basis) => Some(described(basis.as_ref())),
        _ => None,
    };
    let seconds = Seconds { read, fit: fitted, write: None };
    let mut job = Job::new(&table, &fit, basis, arguments.samples, seconds);
    job.document.blending = blending;
    let report = &fit.report;
    let kind = match recipe {
        Recipe::Approximate(_) => Sought::Distance,
        Recipe::LeastSquares(_) => Sought::LeastSquares,
        _ => Sought::Residual,
    };
    let finish = Finish {
        wanted,
        method: arguments.iteration.method,
        convex: arguments.convex,
        run: Run::of(&report.run, kind),
    };
    finish.finish(&mut job, print::report)
}
