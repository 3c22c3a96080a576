//! The end of every fit: files, what is printed, and how the run is judged.

use crate::arguments::{ConvexChoice, MethodChoice};
use crate::outputs::{Outputs, Product, Wanted};
use crate::targets::is_standard;
use crate::{Ending, output};
use gimfit::Termination;

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
    pub(crate) termination: Termination,
    pub(crate) residual_target: f64,
    pub(crate) max_residual: f64,
    pub(crate) iterations: usize,
    /// Whether a distance was to be kept rather than the points met.
    pub(crate) approximates: bool,
}

impl Finish<'_> {
    /// Writes and prints; `text` makes the report of the lines on what was written.
    pub(crate) fn finish<P: Product>(
        &self,
        product: &mut P,
        text: impl FnOnce(&P, &[String]) -> String,
    ) -> anyhow::Result<Ending> {
        let mut outputs = Outputs::prepare(product, self.wanted)?;
        let text = text(product, &outputs.written);
        let text = output::printable(&text);
        outputs.report(product, self.wanted, &text)?;
        if let Some(document) = outputs.keep()? {
            output::data(&document)?;
            if !self.wanted.arguments.quiet {
                output::remark(&text);
            }
        } else if self.wanted.arguments.json {
            output::data(&product.json(self.wanted.arguments.geometry)?)?;
        } else if !self.wanted.arguments.quiet || self.wanted.report().is_some_and(is_standard) {
            output::text(&text)?;
        }
        Ok(self.ending())
    }

    /// Running all the iterations asked for is done, unless a residual was to be reached.
    fn ending(&self) -> Ending {
        let Run { termination, residual_target, max_residual, iterations, approximates } = self.run;
        let met = match termination {
            Termination::Residual => true,
            Termination::Iterations => residual_target == 0.0,
            _ => false,
        };
        if met {
            return Ending::Done;
        }
        let what = if approximates { "distance" } else { "residual" };
        output::remark(&format!(
            "{}warning: the {what} {residual_target:.3e} was not reached: the run ended by \
             {termination} at {max_residual:.3e} after {iterations} iterations; what was found is \
             written all the same{}\n",
            if self.wanted.arguments.quiet { "" } else { "\n" },
            self.advice()
        ));
        Ending::NotMet
    }

    /// What to try next.
    fn advice(&self) -> &'static str {
        let auto = self.method == MethodChoice::Auto;
        if self.run.approximates {
            return "; allow a larger distance, or fewer demands";
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
