//! Arguments that ask for few control points within a distance, in place of interpolation.

use crate::values;
use clap::Args;
use gimfit::{SurfaceApproximationOptions, SurfaceGoal};
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

    /// Come as close as can be with this many rows and columns of control points, such as 12x8
    #[arg(
        long,
        value_name = "MxN",
        value_parser = parse_shape,
        group = "goal",
        conflicts_with_all = OF_INTERPOLATION,
        help_heading = "Approximation"
    )]
    pub(crate) control_points: Option<(usize, usize)>,
}

impl SurfaceApproximationArguments {
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
