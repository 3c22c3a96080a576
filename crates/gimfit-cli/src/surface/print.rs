//! The report of a surface that a person reads.

use super::Job;
use crate::report_text::{Lines, RunLines};

/// A few lines: what was read, chosen, run, found and written.
pub(super) fn report(job: &Job<'_>, written: &[String]) -> String {
    let (grid, report) = (job.grid, &job.fit.report);
    let mut lines = Lines::new(&grid.source, grid.title.as_deref());
    lines.add(
        "read",
        &format!(
            "{} x {} points of dimension {} ({}) as {}",
            grid.rows,
            grid.columns,
            grid.dimension(),
            grid.column_names.join(", "),
            grid.format
        ),
    );
    lines.add_all("", &grid.notes);
    let closed = match report.closed {
        [false, false] => "open",
        [true, false] => "closed in u",
        [false, true] => "closed in v",
        [true, true] => "closed in u and v",
    };
    let bases = match &job.bases {
        Some([u, v]) if u == v => format!("{u} of "),
        Some([u, v]) => format!("{u} and {v} of "),
        None => String::new(),
    };
    lines.add(
        "surface",
        &format!(
            "{bases}degrees {} and {}, {closed}, {} x {} control points",
            report.degrees[0],
            report.degrees[1],
            report.control_points[0],
            report.control_points[1]
        ),
    );
    lines.add_all("edits", &job.edits);
    let place = |[i, j]: [usize; 2]| grid.point_name(i, j);
    let columns = report.points[1];
    let outside = report.run.local.as_ref().map(|local| {
        let index = local.outside_max_residual_index;
        place([index / columns, index % columns])
    });
    if let Some(account) = &report.approximation {
        lines.approximation(
            account,
            report.run.residual_target > 0.0,
            "the cells of the grid",
            |k| place([k / report.points[1], k % report.points[1]]),
        );
    }
    lines.run(&RunLines {
        run: &report.run,
        max_residual_place: place(report.max_residual_index),
        outside_place: outside,
        max_deviation: report.max_deviation,
        max_deviation_place: place(report.max_deviation_index),
        seconds: job.document.report.as_ref().and_then(|report| report.run.seconds),
        written,
    });
    lines.finish()
}
