//! Errors of the library in the words of the command line: rows by their line, options by name.

use crate::arguments::CurveArguments;
use anyhow::anyhow;
use gimfit::Error;
use gimfit_io::points::PointTable;

/// Rewrites an error that names points so that it names the file and its rows.
pub(super) fn explain(
    error: Error,
    table: &PointTable,
    arguments: &CurveArguments,
) -> anyhow::Error {
    let row = |index: usize| table.row_name(index);
    let source = &table.source;
    match error {
        Error::RepeatedPoints { first, second, others } => {
            let more = match others {
                0 => String::new(),
                1 => " (and one more repetition)".into(),
                _ => format!(" (and {others} more repetitions)"),
            };
            let what = if arguments.input.abscissa.is_some() { "the abscissa of" } else { "" };
            let what = if what.is_empty() { String::new() } else { format!("{what} ") };
            anyhow!(
                "{source}: {} repeats {what}{}{more}; choose what to do with repeated points: \
                 --duplicates drop keeps the first of each run, --duplicates merge takes their mean",
                row(second),
                row(first)
            )
        }
        Error::ParametersCollide { first, second } => anyhow!(
            "{source}: the points of {} and {} lie too close together, against the length of the \
             whole curve, to have distinct parameters; remove one of them, or use --parameters \
             uniform",
            row(first),
            row(second)
        ),
        Error::ParametersNotIncreasing { index, value, previous } => {
            let hint =
                if arguments.input.abscissa.is_some() { "; --sort sorts the rows" } else { "" };
            anyhow!(
                "{source}: the parameter {value} of {} is less than {previous} before it; \
                 parameters must increase{hint}",
                row(index)
            )
        }
        Error::SchoenbergWhitney { point, parameter } => anyhow!(
            "{source}: the knots do not fit the points: at {} (parameter {parameter}) its own basis \
             function vanishes; --knots averaged always fits",
            row(point)
        ),
        Error::NotFinite { point, coordinate, value } => anyhow!(
            "{source}, {}: coordinate {} is {value}; every coordinate must be finite",
            row(point),
            coordinate + 1
        ),
        Error::TooFewPoints { points, degree, needed } => anyhow!(
            "{source}: {points} distinct points are too few for degree {degree}, which needs {needed}; \
             lower it with --degree"
        ),
        Error::AllPointsEqual { points } => {
            anyhow!("{source}: all {points} points are equal; there is no curve to fit")
        }
        other => anyhow!("{source}: {other}"),
    }
}
