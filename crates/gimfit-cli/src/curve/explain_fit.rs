//! Errors of a fit in the words of the command line: rows by their line, options by name.

use crate::arguments::{InputArguments, RuleOrFile, ShapeArguments};
use crate::explain::explain;
use anyhow::anyhow;
use gimfit::Error;
use gimfit_io::points::{PointTable, input_name};

/// Rewrites an error that names points so that it names the file and its rows.
pub(crate) fn explain_fit(
    error: Error,
    table: &PointTable,
    input: &InputArguments,
    shape: &ShapeArguments,
) -> anyhow::Error {
    // Given parameters may be one more than the points.
    let row = |index: usize| {
        if index < table.rows() { table.row_name(index) } else { "the closing point".into() }
    };
    let source = &table.source;
    match error {
        Error::RepeatedPoints { first, second, others } => {
            let more = match others {
                0 => String::new(),
                1 => " (and one more repetition)".into(),
                _ => format!(" (and {others} more repetitions)"),
            };
            let what = match &shape.parameters {
                _ if input.abscissa.is_some() => "the abscissa of ",
                Some(RuleOrFile::File(_)) => "the parameter of ",
                _ => "",
            };
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
            if let Some(RuleOrFile::File(path)) = &shape.parameters {
                return anyhow!(
                    "{}: number {} is {value} and does not exceed {previous} before it; \
                     parameters must increase (it belongs to {} of {source})",
                    input_name(path),
                    index + 1,
                    row(index)
                );
            }
            let hint = if input.abscissa.is_some() { "; --sort sorts the rows" } else { "" };
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
        Error::TooFewPoints { points, degree, needed } => anyhow!(
            "{source}: {points} distinct {} too few for degree {degree}, which needs {needed}; \
             lower it with --degree",
            if points == 1 { "point is" } else { "points are" }
        ),
        Error::AllPointsEqual { points } => {
            anyhow!("{source}: all {points} points are equal; there is no curve to fit")
        }
        other => explain(other, table),
    }
}
