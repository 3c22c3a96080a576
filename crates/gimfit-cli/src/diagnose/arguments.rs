//! What can be typed after `gimfit diagnose`: points, or with `--grid` a grid.

use crate::arguments::{InputArguments, ShapeArguments};
use crate::surface::GridArguments;
use crate::values;
use clap::Args;

#[derive(Debug, Args)]
#[command(after_help = "Exit status: 0 done; 2 wrong usage or input; 130 interrupted.

Examples:
  gimfit diagnose airfoil.dat
  gimfit diagnose track.gpx --columns east,north --degree 5 --tolerance 0.01
  gimfit diagnose coast.csv --closed --json
  gimfit diagnose heights.csv --grid")]
pub(crate) struct DiagnoseArguments {
    #[command(flatten)]
    pub(crate) input: InputArguments,

    #[command(flatten)]
    pub(crate) shape: ShapeArguments,

    /// POINTS is a grid, for a surface: it is read as by gimfit surface, with the options of that
    /// command on reading and on the surface (gimfit diagnose --grid --help)
    #[arg(long, help_heading = "Diagnosis")]
    pub(crate) grid: bool,

    #[command(flatten)]
    pub(crate) target: TargetArguments,

    /// Print as JSON, with all eigenvalues where there are few
    #[arg(long, help_heading = "Diagnosis")]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Exit status: 0 done; 2 wrong usage or input; 130 interrupted.

Examples:
  gimfit diagnose --grid heights.csv
  gimfit diagnose --grid hull.csv --degree 3,2 --parameters chord,uniform --closed v")]
pub(crate) struct DiagnoseGridArguments {
    #[command(flatten)]
    pub(crate) grid: GridArguments,

    #[command(flatten)]
    pub(crate) target: TargetArguments,

    /// Print as JSON
    #[arg(long, help_heading = "Diagnosis")]
    pub(crate) json: bool,
}

/// What points and grids are diagnosed for.
#[derive(Debug, Args)]
pub(crate) struct TargetArguments {
    /// Residual to which steps are predicted, in the unit of the points [default: 1e-12 of the
    /// extent, or what rounding allows]
    #[arg(
        long,
        value_name = "T",
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Diagnosis"
    )]
    pub(crate) tolerance: Option<f64>,
}
