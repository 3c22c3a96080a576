//! The list that a person reads.

use super::ladder::{Choice, Ladder};
use crate::report_text::{Lines, time};

pub(super) fn report(ladder: &Ladder<'_>, written: &[String]) -> String {
    let mut lines = Lines::new(ladder.source, ladder.title);
    lines.add("read", &ladder.read);
    lines.add_all("", ladder.notes);
    let kept = ladder.choices.iter().filter(|choice| choice.met).count();
    lines.add("fits", &format!("{kept}, {}, from few control points to many", ladder.kind));
    let seconds = ladder.seconds;
    lines.add("time", &format!("read {}, fit {}", time(seconds.read), time(seconds.fit)));
    for name in written {
        lines.add("wrote", name);
    }
    let mut text = lines.finish();
    text += &format!(
        "\n  {:>14} {:>11} {:>11} {:>11} {:>11} {:>11}\n",
        "control points", "tolerance", "largest", "rms", "mean", "between"
    );
    for choice in &ladder.choices {
        text += &row(choice);
    }
    let last = ladder.choices.iter().rev().find(|choice| choice.met);
    if let Some(choice) = last {
        text += &format!(
            "\nTo have one of them: {} FILE --tolerance T, such as --tolerance {}\n",
            ladder.command,
            plain(choice.distance)
        );
    }
    text
}

fn row(choice: &Choice) -> String {
    let size = match choice.net {
        Some([rows, columns]) => format!("{} ({rows}x{columns})", choice.control_points),
        None => choice.control_points.to_string(),
    };
    let mut row = format!(
        "  {size:>14} {:>11} {:>11.3e} {:>11.3e} {:>11.3e} {:>11.3e}",
        plain(choice.distance),
        choice.largest,
        choice.rms,
        choice.mean,
        choice.overshoot
    );
    if choice.corners > 0 {
        let plural = if choice.corners == 1 { "" } else { "s" };
        row += &format!("  {} corner{plural}", choice.corners);
    }
    if !choice.calm {
        row += "  not calm";
    }
    if !choice.met {
        row += "  not kept";
    }
    row + "\n"
}

/// A distance in plain digits where they are few.
pub(super) fn plain(x: f64) -> String {
    if (1e-6..1e9).contains(&x) { x.to_string() } else { format!("{x:e}") }
}
