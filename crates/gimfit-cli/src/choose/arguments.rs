//! What can be typed after `gimfit choose`: points, or with `--grid` a grid.

use crate::arguments::{InputArguments, WritingArguments};
use crate::curve::CornersChoice;
use crate::surface::GridArguments;
use crate::values;
use clap::Args;
use gimfit::CurveOptions;

#[derive(Debug, Args)]
#[command(
    after_help = "Each distance is met by as few control points as gimfit curve --tolerance \
finds. A fit is left out if a closer one has no more control points. The list ends where a distance \
cannot be kept, or where a fit has more than half as many control points as there are points.

Exit status: 0 done; 1 interrupted, or a distance asked for was not kept (the fits so far are written \
all the same); 2 wrong usage or input, nothing written; 130 interrupted before there was a fit.

Examples:
  gimfit choose scan.xyz
  gimfit choose airfoil.dat --distances 0.01,0.001,0.0001 -o choices.svg
  gimfit choose track.gpx --columns east,north -o choices.csv -o 'fit-{k}.json'
  gimfit choose heights.csv --grid"
)]
pub(crate) struct ChooseArguments {
    #[command(flatten)]
    pub(crate) input: InputArguments,

    /// POINTS is a grid, for surfaces: it is read as by gimfit surface, with the options of that
    /// command on reading (gimfit choose --grid --help)
    #[arg(long, help_heading = "Reading")]
    pub(crate) grid: bool,

    /// Degree of the curves
    #[arg(
        long,
        value_name = "P",
        default_value_t = CurveOptions::default().degree,
        help_heading = "Curves"
    )]
    pub(crate) degree: usize,

    /// Close the curves smoothly; the first point may be repeated at the end or not
    #[arg(long, help_heading = "Curves")]
    pub(crate) closed: bool,

    /// Corners that stay sharp: auto (those that the data show at the scale of each distance), none,
    /// or the smallest turn in degrees [default: auto]
    #[arg(
        long,
        value_name = "auto|none|ANGLE",
        allow_negative_numbers = true,
        help_heading = "Curves"
    )]
    pub(crate) corners: Option<CornersChoice>,

    #[command(flatten)]
    pub(crate) ladder: LadderArguments,

    #[command(flatten)]
    pub(crate) writing: WritingArguments,
}

#[derive(Debug, Args)]
#[command(
    after_help = "Exit status: 0 done; 1 interrupted, or a distance asked for was not kept (the \
fits so far are written all the same); 2 wrong usage or input, nothing written; 130 interrupted before \
there was a fit.

Examples:
  gimfit choose --grid heights.csv
  gimfit choose --grid hull.csv --degree 3,2 --distances 0.1,0.01 -o 'hull-{k}.json'"
)]
pub(crate) struct ChooseGridArguments {
    #[command(flatten)]
    pub(crate) grid: GridArguments,

    #[command(flatten)]
    pub(crate) ladder: LadderArguments,

    #[command(flatten)]
    pub(crate) writing: WritingArguments,
}

/// What the fits keep within.
#[derive(Debug, Args)]
pub(crate) struct LadderArguments {
    /// Distances to keep within [default: 1, 2 and 5 times powers of ten, from half the extent down
    /// to a hundred-thousandth of it]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_parser = values::number,
        allow_negative_numbers = true,
        help_heading = "Choices"
    )]
    pub(crate) distances: Vec<f64>,
}
