//! Arguments that ask for few control points within a distance, in place of interpolation.

use crate::arguments::{BasisChoice, CurveArguments, DuplicatesChoice, MethodChoice};
use crate::values;
use anyhow::{bail, ensure};
use clap::{Args, ValueEnum};
use gimfit::{ApproximationOptions, Corners, CurveOptions, Goal, Robust};
use std::str::FromStr;

/// What interpolation alone has.
const OF_INTERPOLATION: [&str; 17] = [
    "only",
    "memory",
    "foot_points",
    "rational_weights",
    "convex_threshold",
    "convex",
    "basis",
    "parameters",
    "knots",
    "period",
    "duplicates",
    "method",
    "weight",
    "bandwidth",
    "residual",
    "keep",
    "iterations",
];

#[derive(Debug, Args)]
pub(crate) struct ApproximationArguments {
    /// Keep every point within this distance of the curve, with as few control points as can be
    /// found, and no wiggles between the points
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

    /// Leave out noise of this standard deviation in every coordinate, or auto to have it estimated:
    /// the smoothest curve whose distances from the points are what noise explains
    #[arg(
        long,
        value_name = "SIGMA|auto",
        allow_negative_numbers = true,
        group = "goal",
        conflicts_with_all = OF_INTERPOLATION,
        help_heading = "Approximation"
    )]
    pub(crate) noise: Option<NoiseChoice>,

    /// Come as close as can be with this many control points, knots and parameters being sought; with
    /// a method of least squares, such as --method least-squares, both stay
    #[arg(long, value_name = "N", group = "goal", help_heading = "Approximation")]
    pub(crate) control_points: Option<usize>,

    /// Find outliers, by Huber's weights or Tukey's, leave them out and list them
    #[arg(long, value_enum, requires = "goal", help_heading = "Approximation")]
    pub(crate) robust: Option<RobustChoice>,

    /// Corners that stay sharp: auto (those that the data show at the scale of the tolerance), none,
    /// or the smallest turn in degrees [default: auto]
    #[arg(
        long,
        value_name = "auto|none|ANGLE",
        allow_negative_numbers = true,
        requires = "goal",
        help_heading = "Approximation"
    )]
    pub(crate) corners: Option<CornersChoice>,
}

/// [`Robust`] as typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum RobustChoice {
    Huber,
    Tukey,
}

/// A standard deviation, or none to have it estimated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NoiseChoice(Option<f64>);

impl FromStr for NoiseChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(match text {
            "auto" => None,
            _ => Some(
                values::number(text)
                    .map_err(|_| format!("\"{text}\" is neither auto nor a standard deviation"))?,
            ),
        }))
    }
}

/// [`Corners`] as typed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CornersChoice(pub(crate) Corners);

impl FromStr for CornersChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(Self(match text {
            "auto" => Corners::Auto,
            "none" => Corners::None,
            _ => Corners::Angle(
                values::number(text)
                    .map_err(|_| format!("\"{text}\" is neither auto nor none nor an angle"))?,
            ),
        }))
    }
}

impl ApproximationArguments {
    /// Refuses what a search for knots and parameters does not have, as clap does for the other
    /// goals: `--control-points` has it with a method of least squares.
    pub(crate) fn check(&self, arguments: &CurveArguments) -> anyhow::Result<()> {
        let Some(_) = self.control_points else { return Ok(()) };
        let (shape, iteration) = (&arguments.shape, &arguments.iteration);
        let others = [
            ("--only", !iteration.only.is_empty()),
            ("--memory", iteration.memory.is_some()),
            ("--foot-points", iteration.foot_points.is_some()),
            ("--rational-weights", shape.rational_weights.is_some()),
            ("--convex", arguments.convex.is_some()),
            ("--basis", shape.basis != BasisChoice::BSpline),
            ("--parameters", shape.parameters.is_some()),
            ("--knots", shape.knots.is_some()),
            ("--period", shape.period.is_some()),
            ("--duplicates", shape.duplicates != DuplicatesChoice::Error),
            ("--method", iteration.method != MethodChoice::Auto),
            ("--weight", iteration.weight != "auto"),
            ("--bandwidth", iteration.bandwidth.is_some()),
            ("--residual", iteration.residual.is_some()),
            ("--keep", !iteration.keep.is_empty()),
            ("--iterations", iteration.iterations != CurveOptions::default().iterations),
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
        degree: usize,
        closed: bool,
        abscissae: Option<Vec<f64>>,
        hold_ends: bool,
    ) -> anyhow::Result<Option<ApproximationOptions>> {
        let goal = match (self.tolerance, self.rms, self.noise, self.control_points) {
            (Some(tolerance), ..) => Goal::Tolerance(tolerance),
            (_, Some(rms), ..) => Goal::Rms(rms),
            (_, _, Some(NoiseChoice(deviation)), _) => Goal::Noise(deviation),
            (.., Some(count)) => Goal::ControlPoints(count),
            _ => {
                ensure!(
                    !hold_ends,
                    "--hold-ends belongs to methods of least squares, such as --method least-squares, \
                     and to --tolerance, --rms, --noise and --control-points: a curve through all points \
                     ends at them"
                );
                return Ok(None);
            }
        };
        let corners = self.corners.map_or(Corners::Auto, |choice| choice.0);
        ensure!(
            self.control_points.is_none() || self.corners.is_none() || corners == Corners::None,
            "--corners belongs to --tolerance, --rms and --noise"
        );
        Ok(Some(ApproximationOptions {
            degree,
            closed,
            abscissae,
            hold_ends,
            corners,
            robust: self.robust.map(|choice| match choice {
                RobustChoice::Huber => Robust::Huber,
                RobustChoice::Tukey => Robust::Tukey,
            }),
            ..ApproximationOptions::new(goal)
        }))
    }
}
