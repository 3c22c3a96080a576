//! Lines of a report that a person reads: a label, then a sentence.

use gimfit::{ApproximationReport, RunReport};
use gimfit_io::document::Seconds;
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

    /// What was chosen, run, found and written: the same for every geometry.
    pub(crate) fn run(&mut self, account: &RunLines<'_>) {
        let run = account.run;
        self.add_all("chosen", &run.choices);
        self.add(
            "run",
            &format!(
                "{}, {} iteration{}, ended by {} (target {:.3e})",
                run.method,
                run.iterations,
                if run.iterations == 1 { "" } else { "s" },
                run.termination,
                run.residual_target
            ),
        );
        if run.iteration_returned != run.iterations {
            self.add(
                "",
                &format!("the fit returned is that of iteration {}", run.iteration_returned),
            );
        }
        self.add(
            "residual",
            &format!(
                "largest {:.3e} at {}, rms {:.3e}; {:.1e} of the extent {}",
                run.max_residual,
                account.max_residual_place,
                run.rms_residual,
                share(run.max_residual, run.extent),
                length(run.extent)
            ),
        );
        if let Some(account) = run.least_squares {
            self.add(
                "normal",
                &format!(
                    "largest mean difference vector of a control point {:.3e}, which is 0 at the \
                     limit",
                    account.normal_residual
                ),
            );
        }
        self.add(
            "deviation",
            &format!("largest {:.3e} at {}", account.max_deviation, account.max_deviation_place),
        );
        if let (Some(local), Some(place)) = (&run.local, &account.outside_place) {
            self.add(
                "outside",
                &format!(
                    "largest residual of the points left aside {:.3e} at {place}",
                    local.outside_max_residual
                ),
            );
        }
        if let Some(moves) = run.updates {
            self.add(
                "moves",
                &format!("{} of control points made, {} saved", moves.done, moves.saved),
            );
        }
        if let Some(smallest) = run.smallest_eigenvalue {
            // Of a matrix that changes from step to step.
            let when = if run.foot_points.is_some() { "met on the way " } else { "" };
            self.add("spectrum", &format!("smallest eigenvalue {when}{smallest:.6e}"));
        }
        if let Some(seconds) = account.seconds {
            let write = seconds.write.map(|s| format!(", write {}", time(s))).unwrap_or_default();
            let (read, fit) = (time(seconds.read), time(seconds.fit));
            self.add("time", &format!("read {read}, fit {fit}{write}"));
        }
        for name in account.written {
            self.add("wrote", name);
        }
    }

    /// What an approximation achieved; `asked` tells whether a distance was, `between` what the fit
    /// stays near between the points.
    pub(crate) fn approximation(
        &mut self,
        account: &ApproximationReport,
        asked: bool,
        between: &str,
        place: impl Fn(usize) -> String,
    ) {
        self.add(
            "distance",
            &format!(
                "largest {:.3e}, rms {:.3e}, mean {:.3e}{}",
                account.max_distance,
                account.rms_distance,
                account.mean_distance,
                match (asked, account.met) {
                    (false, _) => "",
                    (true, true) => ": within what was asked",
                    (true, false) => ": more than was asked",
                }
            ),
        );
        let worst: Vec<String> = account.worst.iter().map(|&j| place(j)).collect();
        self.add("", &format!("the largest at {}", worst.join(", ")));
        self.add(
            "between",
            &format!(
                "at most {:.3e} from {between}, {} (up to {:.3e} is)",
                account.overshoot,
                if account.is_calm() { "calm" } else { "which is not calm" },
                account.calm_limit
            ),
        );
        if !account.corners.is_empty() {
            let corners: Vec<String> = account.corners.iter().map(|&j| place(j)).collect();
            self.add("corners", &format!("{} kept sharp: {}", corners.len(), listed(&corners)));
        }
    }

    pub(crate) fn finish(self) -> String {
        self.0
    }
}

/// The first few of a list.
pub(crate) fn listed(names: &[String]) -> String {
    const SHOWN: usize = 8;
    let shown = names[..names.len().min(SHOWN)].join(", ");
    if names.len() > SHOWN { format!("{shown}, and {} more", names.len() - SHOWN) } else { shown }
}

/// What [`Lines::run`] tells of.
pub(crate) struct RunLines<'a> {
    pub(crate) run: &'a RunReport,
    pub(crate) max_residual_place: String,
    /// Where the points that local PIA left aside are met worst.
    pub(crate) outside_place: Option<String>,
    pub(crate) max_deviation: f64,
    pub(crate) max_deviation_place: String,
    pub(crate) seconds: Option<Seconds>,
    /// Files, a line each.
    pub(crate) written: &'a [String],
}

fn share(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// A length in plain digits where they are few.
fn length(x: f64) -> String {
    if (1e-4..1e9).contains(&x) { format!("{x:.6}") } else { format!("{x:.6e}") }
}

/// A time in a unit that suits it.
pub(crate) fn time(seconds: f64) -> String {
    if seconds < 1e-3 {
        format!("{:.0} us", seconds * 1e6)
    } else if seconds < 1.0 {
        format!("{:.1} ms", seconds * 1e3)
    } else {
        format!("{seconds:.2} s")
    }
}
