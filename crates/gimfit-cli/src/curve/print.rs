//! The report that a person reads.

use super::Job;
use std::fmt::Write;

/// A few lines: what was read, chosen, run, found and written.
pub(super) fn report(job: &Job<'_>, written: &[String]) -> String {
    let (table, report) = (job.table, &job.fit.report);
    let mut text = String::new();
    let title = table.title.as_deref().map(|title| format!(": {title}")).unwrap_or_default();
    let _ = writeln!(text, "{}{title}", table.source);
    let mut line = |label: &str, content: &str| {
        let _ = writeln!(text, "  {label:<10} {content}");
    };
    line(
        "read",
        &format!(
            "{} points of dimension {} ({}) as {}",
            table.rows(),
            table.dimension(),
            table.column_names.join(", "),
            table.format
        ),
    );
    for note in &table.notes {
        line("", note);
    }
    line(
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
    for (index, choice) in report.choices.iter().enumerate() {
        line(if index == 0 { "chosen" } else { "" }, choice);
    }
    line(
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
        line("", &format!("the fit returned is that of iteration {}", report.iteration_returned));
    }
    line(
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
    line(
        "deviation",
        &format!(
            "largest {:.3e} at {}",
            report.max_deviation,
            place(job, report.max_deviation_index)
        ),
    );
    if let Some(smallest) = report.smallest_eigenvalue {
        line("spectrum", &format!("smallest eigenvalue {smallest:.6e}"));
    }
    if let Some(seconds) = job.document.report.as_ref().and_then(|report| report.seconds) {
        let write = seconds.write.map(|s| format!(", write {}", time(s))).unwrap_or_default();
        line("time", &format!("read {}, fit {}{write}", time(seconds.read), time(seconds.fit)));
    }
    for name in written {
        line("wrote", name);
    }
    text
}

/// The row of a fitted point, as the file numbers it.
fn place(job: &Job<'_>, fitted: usize) -> String {
    let row = job.fit.kept_points.as_ref().map_or(fitted, |kept| kept[fitted]);
    job.table.row_name(row)
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// A length in plain digits where they are few.
fn length(x: f64) -> String {
    if (1e-4..1e9).contains(&x) { format!("{x:.6}") } else { format!("{x:.6e}") }
}

fn time(seconds: f64) -> String {
    if seconds < 1e-3 {
        format!("{:.0} us", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}
