//! `gimfit curve`: the main job.

mod draw;
mod explain_fit;
mod plan;
mod print;
mod save;

use crate::arguments::{CurveArguments, MethodChoice};
use crate::explain::explain;
use crate::progress::Progress;
use crate::signal::{self, Stage};
use crate::targets::is_standard;
use crate::{Ending, output};
use explain_fit::explain_fit;
use gimfit::{PointsView, Termination, fit_curve_observed};
use gimfit_io::document::{Document, Seconds, document_of};
use gimfit_io::points::PointTable;
use plan::Plan;
use save::Outputs;
use std::time::Instant;

/// A fit with everything that is told about it.
struct Job<'a> {
    table: &'a PointTable,
    fit: &'a gimfit::CurveFit,
    document: Document,
}

pub(crate) fn run(arguments: &CurveArguments) -> anyhow::Result<Ending> {
    save::check(arguments)?;
    signal::listen()?;
    let clock = Instant::now();
    let plan = Plan::new(arguments)?;
    let Plan { table, options } = plan;
    let read = clock.elapsed().as_secs_f64();

    let view = PointsView::new(table.dimension(), &table.coordinates)
        .map_err(|error| explain(error, &table))?;
    let mut progress = Progress::new(arguments.quiet, options.iterations);
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
        report.choices.splice(0..0, table.notes.iter().map(|note| format!("reading: {note}")));
        report.seconds = Some(Seconds { read, fit: fitted, write: None });
    }
    let mut job = Job { table: &table, fit: &fit, document };
    let mut outputs = Outputs::prepare(&mut job, arguments)?;
    let text = print::report(&job, &outputs.written);
    let text = output::printable(&text);
    outputs.report(&job, arguments, &text)?;
    let document = outputs.keep()?;
    if let Some(document) = document {
        output::data(&document)?;
        if !arguments.quiet {
            output::remark(&text);
        }
    } else if arguments.json {
        output::data(&save::json_text(&job, arguments.geometry)?)?;
    } else if !arguments.quiet || arguments.report.as_deref().is_some_and(is_standard) {
        output::text(&text)?;
    }
    Ok(ending(&job, arguments))
}

/// Running all the iterations asked for is done, unless a residual was to be reached.
fn ending(job: &Job<'_>, arguments: &CurveArguments) -> Ending {
    let report = &job.fit.report;
    let met = match report.termination {
        Termination::Residual => true,
        Termination::Iterations => report.residual_target == 0.0,
        _ => false,
    };
    if met {
        return Ending::Done;
    }
    output::remark(&format!(
        "{}warning: the residual {:.3e} was not reached: the run ended by {} at {:.3e} after {} \
         iterations; what was found is written all the same{}\n",
        if arguments.quiet { "" } else { "\n" },
        report.residual_target,
        report.termination,
        report.max_residual,
        report.iterations,
        advice(report.termination, arguments.method)
    ));
    Ending::NotMet
}

/// What to try next.
fn advice(termination: Termination, method: MethodChoice) -> &'static str {
    let auto = method == MethodChoice::Auto;
    match termination {
        Termination::Iterations if auto => "; allow more with --iterations",
        Termination::Iterations => "; allow more with --iterations, or use --method auto",
        Termination::Stalled if auto => {
            "; rounding allows no less: try a lower --degree or --parameters centripetal"
        }
        Termination::Stalled => {
            "; rounding allows no less, or the method crawls: try --method auto"
        }
        Termination::Diverged if auto => "; try a lower --degree or --parameters centripetal",
        Termination::Diverged => "; use --method auto",
        _ => "",
    }
}
