//! The end of every fit: files, what is printed, and how the run is judged.

use crate::arguments::{ConvexChoice, MethodChoice};
use crate::outputs::{Outputs, Product, Wanted};
use crate::targets::is_standard;
use crate::{Ending, output};
use gimfit::{RunReport, Termination};

/// What is printed, and of which run.
pub(crate) struct Finish<'a> {
    pub(crate) wanted: Wanted<'a>,
    pub(crate) method: MethodChoice,
    pub(crate) convex: Option<ConvexChoice>,
    pub(crate) run: Run,
}

/// How a run ended.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    termination: Termination,
    residual_target: f64,
    /// The residual, or whatever it was to bring down.
    reached: f64,
    iterations: usize,
    /// How much of that a step left towards the end.
    rate: Option<f64>,
    kind: Sought,
}

impl Run {
    /// How a run ended that was to bring this down.
    pub(crate) fn of(run: &RunReport, kind: Sought) -> Self {
        Self {
            termination: run.termination,
            residual_target: run.residual_target,
            reached: run.to_limit(),
            iterations: run.iterations,
            rate: run.rate(),
            kind,
        }
    }
}

/// What a run was to bring down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sought {
    /// The largest residual.
    Residual,
    /// The largest distance.
    Distance,
    /// The normal residual of least squares.
    LeastSquares,
}

/// Writes the files and prints what is asked for; `text` makes the report of the lines on what was
/// written.
pub(crate) fn present<P: Product>(
    product: &mut P,
    wanted: Wanted<'_>,
    text: impl FnOnce(&P, &[String]) -> String,
) -> anyhow::Result<()> {
    let mut outputs = Outputs::prepare(product, wanted)?;
    let text = text(product, &outputs.written);
    let text = output::printable(&text);
    outputs.report(product, wanted, &text)?;
    if let Some(document) = outputs.keep()? {
        output::data(&document)?;
        if !wanted.arguments.quiet {
            output::remark(&text);
        }
    } else if wanted.arguments.json {
        output::data(&product.json(wanted.arguments.geometry)?)?;
    } else if !wanted.arguments.quiet || wanted.report().is_some_and(is_standard) {
        output::text(&text)?;
    }
    Ok(())
}

impl Finish<'_> {
    /// Writes and prints; `text` makes the report of the lines on what was written.
    pub(crate) fn finish<P: Product>(
        &self,
        product: &mut P,
        text: impl FnOnce(&P, &[String]) -> String,
    ) -> anyhow::Result<Ending> {
        present(product, self.wanted, text)?;
        Ok(self.ending())
    }

    /// Running all the iterations asked for is done, unless a residual was to be reached.
    fn ending(&self) -> Ending {
        let Run { termination, residual_target, reached, iterations, rate, kind } = self.run;
        let met = match termination {
            Termination::Residual => true,
            Termination::Iterations => residual_target == 0.0,
            _ => false,
        };
        if met {
            return Ending::Done;
        }
        let what = match kind {
            Sought::Residual => "residual",
            Sought::Distance => "distance",
            Sought::LeastSquares => "normal residual",
        };
        // How slow it was is worth knowing where more steps would help.
        let pace = rate
            .filter(|rate| termination == Termination::Iterations && *rate < 1.0)
            .map(|rate| pace(rate, reached, residual_target))
            .unwrap_or_default();
        output::remark(&format!(
            "{}warning: the {what} {residual_target:.3e} was not reached: the run ended by \
             {termination} at {reached:.3e} after {iterations} iterations{pace}; what was found is \
             written all the same{}\n",
            if self.wanted.arguments.quiet { "" } else { "\n" },
            self.advice()
        ));
        Ending::NotMet
    }

    /// What to try next.
    fn advice(&self) -> &'static str {
        let auto = matches!(self.method, MethodChoice::Auto | MethodChoice::LeastSquares);
        if self.run.kind == Sought::Distance {
            return "; allow a larger distance, or fewer demands";
        }
        if self.run.kind == Sought::LeastSquares {
            return match self.run.termination {
                Termination::Iterations if auto => "; allow more with --iterations",
                Termination::Iterations => {
                    "; allow more with --iterations, or use --method least-squares"
                }
                Termination::Stalled | Termination::Diverged if !auto => {
                    "; use --method least-squares"
                }
                _ => "",
            };
        }
        match self.run.termination {
            Termination::Constrained => {
                "; no fit nearby that turns as the data do comes closer: without --convex the curve \
                 passes through the points"
            }
            Termination::Stalled if self.convex == Some(ConvexChoice::Published) => {
                "; the published algorithm stalls where a corner has become straight: try --convex"
            }
            Termination::Stalled if self.convex.is_some() => {
                "; rounding, or control points that fall together, allow no further step"
            }
            Termination::Iterations if self.convex.is_some() => "; allow more with --iterations",
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
}

/// How far the run got in a step, and how many more would do if that went on.
fn pace(rate: f64, reached: f64, target: f64) -> String {
    let steps = ((target / reached).ln() / rate.ln()).ceil();
    let more = if target > 0.0 && steps.is_finite() && steps < 1e9 {
        format!(", so that about {steps:.0} more are needed")
    } else {
        String::new()
    };
    format!(" (the last steps left {rate:.4} of it each{more})")
}
