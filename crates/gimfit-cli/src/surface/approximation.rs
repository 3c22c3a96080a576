//! Arguments that ask for few control points within a distance, in place of interpolation.

use super::arguments::SurfaceArguments;
use crate::arguments::{BasisChoice, MethodChoice};
use crate::values;
use anyhow::bail;
use clap::Args;
use gimfit::{SurfaceApproximationOptions, SurfaceGoal, SurfaceOptions};
use gimfit_io::grids::parse_shape;

/// What interpolation alone has.
const OF_INTERPOLATION: [&str; 15] = [
    "memory",
    "foot_points",
    "rational_weights",
    "basis",
    "parameters",
    "knots",
    "method",
    "weight",
    "bandwidth",
    "residual",
    "keep",
    "iterations",
    "per_direction",
    "only",
    "moves",
];

#[derive(Debug, Args)]
pub(crate) struct SurfaceApproximationArguments {
    /// Keep every point within this distance of the surface, with as few control points as can be
    /// found, and no wiggles between the points; of heights over a lattice, measured as heights
    #[arg(
        long,
        value_name = "DISTANCE",
        value_parser = values::number,
        allow_negative_numbers = true,
        group = "goal",
        conflicts_with_all = OF_INTERPOLATION,
        help_heading = "Approximation"
    )]
    pub(crate) tolerance: Option<f64>,

    /// Keep the root mean square of the distances below this, likewise
    #[arg(
        long,
        value_name = "DISTANCE",
        value_parser = values::number,
        allow_negative_numbers = true,
        group = "goal",
        conflicts_with_all = OF_INTERPOLATION,
        help_heading = "Approximation"
    )]
    pub(crate) rms: Option<f64>,

    /// Come as close as can be with this many rows and columns of control points, such as 12x8, knots
    /// and parameters being sought; with a method of least squares, such as --method least-squares,
    /// both stay
    #[arg(
        long,
        value_name = "MxN",
        value_parser = parse_shape,
        group = "goal",
        help_heading = "Approximation"
    )]
    pub(crate) control_points: Option<(usize, usize)>,
}

impl SurfaceApproximationArguments {
    /// Refuses what a search for knots and parameters does not have, as clap does for the other
    /// goals: `--control-points` has it with a method of least squares.
    pub(super) fn check(&self, arguments: &SurfaceArguments) -> anyhow::Result<()> {
        let Some(_) = self.control_points else { return Ok(()) };
        let (grid, iteration) = (&arguments.grid, &arguments.iteration);
        let others = [
            ("--memory", iteration.memory.is_some()),
            ("--foot-points", iteration.foot_points.is_some()),
            ("--rational-weights", grid.rational_weights.is_some()),
            ("--basis", grid.basis.0 != [BasisChoice::BSpline; 2]),
            ("--parameters", grid.parameters.is_some()),
            ("--knots", grid.knots.is_some()),
            ("--method", iteration.method != MethodChoice::Auto),
            ("--weight", iteration.weight != "auto"),
            ("--bandwidth", iteration.bandwidth.is_some()),
            ("--residual", iteration.residual.is_some()),
            ("--keep", !iteration.keep.is_empty()),
            ("--iterations", iteration.iterations != SurfaceOptions::default().iterations),
            ("--per-direction", arguments.per_direction),
            ("--only", !iteration.only.is_empty()),
            ("--move", !arguments.moves.is_empty()),
        ];
        match others.iter().find(|(_, given)| *given) {
            None => Ok(()),
            Some(("--method", _)) => bail!(
                "--method {} goes through all points, --control-points does not: use a method of \
                 least squares, such as --method least-squares, or none",
                iteration.method_name()
            ),
            Some((name, _)) => bail!(
                "{name} does not go with --control-points alone, which seeks knots and parameters; \
                 with --method least-squares they stay"
            ),
        }
    }

    /// The options, where an approximation is asked for.
    pub(crate) fn options(
        &self,
        degrees: [usize; 2],
        closed: [bool; 2],
    ) -> Option<SurfaceApproximationOptions> {
        let goal = match (self.tolerance, self.rms, self.control_points) {
            (Some(tolerance), _, _) => SurfaceGoal::Tolerance(tolerance),
            (_, Some(rms), _) => SurfaceGoal::Rms(rms),
            (_, _, Some((rows, columns))) => SurfaceGoal::ControlPoints([rows, columns]),
            _ => return None,
        };
        Some(SurfaceApproximationOptions {
            degrees,
            closed,
            ..SurfaceApproximationOptions::new(goal)
        })
    }
}
