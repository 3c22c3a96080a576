//! The report of a triangular patch that a person reads.

use super::{Job, row_and_column};
use crate::report_text::{Lines, RunLines};

/// A few lines: what was read, chosen, run, found and written.
pub(super) fn report(job: &Job<'_>, written: &[String]) -> String {
    let (table, report) = (job.table, &job.fit.report);
    let mut lines = Lines::new(&table.source, table.title.as_deref());
    lines.add(
        "read",
        &format!(
            "{} points of dimension {} ({}) as {}",
            table.rows(),
            table.dimension(),
            table.column_names.join(", "),
            table.format
        ),
    );
    lines.add_all("", &table.notes);
    lines.add(
        "triangle",
        &format!(
            "degree {}, {} control points in {} rows",
            report.degree,
            report.points,
            report.degree + 1
        ),
    );
    let place = |index: usize| {
        let (row, column) = row_and_column(index);
        format!("{} (row {row}, column {column})", table.row_name(index))
    };
    lines.run(&RunLines {
        run: &report.run,
        max_residual_place: place(report.max_residual_index),
        outside_place: None,
        max_deviation: report.max_deviation,
        max_deviation_place: place(report.max_deviation_index),
        seconds: job.document.report.as_ref().and_then(|report| report.run.seconds),
        written,
    });
    lines.finish()
}
