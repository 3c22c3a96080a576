//! What can be typed after `gimfit triangle`.

use crate::arguments::{InputArguments, IterationArguments, WritingArguments};
use crate::values;
use clap::Args;

#[derive(Debug, Args)]
#[command(
    after_help = "The points stand in rows of the triangle: one point, then two, then three, ...; \
their number gives the degree n: 3, 6, 10, 15, ... points for n = 1, 2, 3, 4, ...

Exit status: 0 done; 1 a residual was not reached (the best fit is written all the same); 2 wrong \
usage or input, nothing written; 130 interrupted before there was a fit.

Examples:
  gimfit triangle patch.csv -o patch.svg -o patch.json
  gimfit triangle patch.csv --method weighted --keep 0,10,100 -o patch.json
  gimfit triangle patch.csv -o samples.csv --samples 50"
)]
pub(crate) struct TriangleArguments {
    #[command(flatten)]
    pub(crate) input: InputArguments,

    #[command(flatten)]
    pub(crate) iteration: IterationArguments,

    #[command(flatten)]
    pub(crate) writing: WritingArguments,

    /// Samples along each edge written to .csv files instead of control points
    #[arg(long, value_name = "N", value_parser = values::triangle_samples, help_heading = "Writing")]
    pub(crate) samples: Option<usize>,
}
