//! The report that a person reads.

use super::Job;
use crate::report_text::{Lines, RunLines, listed};
use gimfit::ShapeReport;

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
        "curve",
        &format!(
            "{}degree {}, {}, {} control points{}",
            job.basis.as_ref().map(|basis| format!("{basis} of ")).unwrap_or_default(),
            report.degree,
            if report.closed { "closed" } else { "open" },
            report.control_points,
            if report.closed {
                format!(" ({} of them repeated at the end)", report.degree)
            } else {
                String::new()
            }
        ),
    );
    lines.add_all("edits", &job.edits);
    if let Some(shape) = &report.shape {
        lines.add("shape", &shape_line(shape));
    }
    if let Some(account) = &report.approximation {
        lines.approximation(
            account,
            report.run.residual_target > 0.0,
            "the polyline of the points",
            |j| place(job, j),
        );
        if !account.outliers.is_empty() {
            let rows: Vec<String> =
                account.outliers.iter().map(|&row| table.row_name(row)).collect();
            lines.add("outliers", &format!("{} left out: {}", rows.len(), listed(&rows)));
        }
    }
    lines.run(&RunLines {
        run: &report.run,
        max_residual_place: place(job, report.max_residual_index),
        outside_place: report
            .run
            .local
            .as_ref()
            .map(|local| place(job, local.outside_max_residual_index)),
        max_deviation: report.max_deviation,
        max_deviation_place: place(job, report.max_deviation_index),
        seconds: job.document.report.as_ref().and_then(|report| report.run.seconds),
        written,
    });
    lines.finish()
}

/// What turns were kept, and how.
fn shape_line(shape: &ShapeReport) -> String {
    let &ShapeReport { left, right, straight, control_left, control_right, .. } = shape;
    let ShapeReport { inserted_knots, kept, .. } = *shape;
    let mut line = format!(
        "{} turns of the data {} ({left} left, {right} right)",
        left + right,
        if kept { "kept" } else { "not all kept" }
    );
    if straight > 0 {
        line += &format!(
            ", {straight} straight corner{} on the side of {} neighbours",
            if straight == 1 { "" } else { "s" },
            if straight == 1 { "its" } else { "their" }
        );
    }
    if inserted_knots > 0 {
        line += &format!(
            ", over {inserted_knots} inserted knot{}",
            if inserted_knots == 1 { "" } else { "s" }
        );
    }
    if straight == 0 && (control_left, control_right) != (left, right) {
        line += &format!(
            "; the control polygon has {} ({control_left} left, {control_right} right)",
            control_left + control_right
        );
    }
    line
}

/// The row of a fitted point, as the file numbers it.
fn place(job: &Job<'_>, fitted: usize) -> String {
    // Edits count from 1, and so do the points that they leave.
    if !job.edits.is_empty() {
        return format!("point {}", fitted + 1);
    }
    let row = job.fit.kept_points.as_ref().map_or(fitted, |kept| kept[fitted]);
    job.table.row_name(row)
}
