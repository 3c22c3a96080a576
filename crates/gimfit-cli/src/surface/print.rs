//! The report of a surface that a person reads.

use super::Job;
use crate::report_text::{Lines, length, share, time};

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
    lines.add(
        "surface",
        &format!(
            "degrees {} and {}, {closed}, {} x {} control points",
            report.degrees[0],
            report.degrees[1],
            report.control_points[0],
            report.control_points[1]
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
    let place = |[i, j]: [usize; 2]| grid.point_name(i, j);
    lines.add(
        "residual",
        &format!(
            "largest {:.3e} at {}, rms {:.3e}; {:.1e} of the extent {}",
            report.max_residual,
            place(report.max_residual_index),
            report.rms_residual,
            share(report.max_residual, report.extent),
            length(report.extent)
        ),
    );
    lines.add(
        "deviation",
        &format!("largest {:.3e} at {}", report.max_deviation, place(report.max_deviation_index)),
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
