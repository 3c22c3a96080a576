//! Lines of a report that a person reads: a label, then a sentence.

use std::fmt::Write;

/// A report under way.
pub(crate) struct Lines(String);

impl Lines {
    /// Starts with the name of the file and its title.
    pub(crate) fn new(source: &str, title: Option<&str>) -> Self {
        let title = title.map(|title| format!(": {title}")).unwrap_or_default();
        Self(format!("{source}{title}\n"))
    }

    pub(crate) fn add(&mut self, label: &str, content: &str) {
        let _ = writeln!(self.0, "  {label:<10} {content}");
    }

    /// Several lines under one label.
    pub(crate) fn add_all(&mut self, label: &str, contents: &[String]) {
        for (index, content) in contents.iter().enumerate() {
            self.add(if index == 0 { label } else { "" }, content);
        }
    }

    pub(crate) fn finish(self) -> String {
        self.0
    }
}

pub(crate) fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// A length in plain digits where they are few.
pub(crate) fn length(x: f64) -> String {
    if (1e-4..1e9).contains(&x) { format!("{x:.6}") } else { format!("{x:.6e}") }
}

pub(crate) fn time(seconds: f64) -> String {
    if seconds < 1e-3 {
        format!("{:.0} us", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}
