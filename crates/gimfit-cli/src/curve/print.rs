//! The report that a person reads.

use super::Job;
use crate::report_text::{Lines, length, share, time};

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
            "degree {}, {}, {} control points{}",
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
    lines.add_all("chosen", &report.choices);
    lines.add(
        "run",
        &format!(
            "{}, {} iteration{}, ended by {} (target {:.3e})",
            report.method,
            report.iterations,
            if report.iterations == 1 { "" } else { "s" },
            report.termination,
            report.residual_target
        ),
    );
    if report.iteration_returned != report.iterations {
        lines.add(
            "",
            &format!("the fit returned is that of iteration {}", report.iteration_returned),
        );
    }
    lines.add(
        "residual",
        &format!(
            "largest {:.3e} at {}, rms {:.3e}; {:.1e} of the extent {}",
            report.max_residual,
            place(job, report.max_residual_index),
            report.rms_residual,
            share(report.max_residual, report.extent),
            length(report.extent)
        ),
    );
    lines.add(
        "deviation",
        &format!(
            "largest {:.3e} at {}",
            report.max_deviation,
            place(job, report.max_deviation_index)
        ),
    );
    if let Some(smallest) = report.smallest_eigenvalue {
        lines.add("spectrum", &format!("smallest eigenvalue {smallest:.6e}"));
    }
    if let Some(seconds) = job.document.report.as_ref().and_then(|report| report.seconds) {
        let write = seconds.write.map(|s| format!(", write {}", time(s))).unwrap_or_default();
        lines
            .add("time", &format!("read {}, fit {}{write}", time(seconds.read), time(seconds.fit)));
    }
    for name in written {
        lines.add("wrote", name);
    }
    lines.finish()
}

/// The row of a fitted point, as the file numbers it.
fn place(job: &Job<'_>, fitted: usize) -> String {
    let row = job.fit.kept_points.as_ref().map_or(fitted, |kept| kept[fitted]);
    job.table.row_name(row)
}
