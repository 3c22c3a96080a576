//! Points and numbers from files, as the arguments describe them.

use crate::arguments::InputArguments;
use anyhow::Context;
use gimfit_io::points::{PointTable, ReadOptions, read_numbers, read_points};
use std::path::Path;

/// Reads the points.
pub(crate) fn points(arguments: &InputArguments) -> anyhow::Result<PointTable> {
    Ok(read_points(&arguments.points, &options(arguments))?)
}

/// What the arguments say about reading.
pub(crate) fn options(arguments: &InputArguments) -> ReadOptions {
    ReadOptions {
        format: arguments.format,
        columns: (!arguments.columns.is_empty()).then(|| arguments.columns.clone()),
        abscissa: arguments.abscissa.clone(),
        delimiter: arguments.delimiter,
        decimal: arguments.decimal,
        part: arguments.part,
    }
}

/// Reads a list of numbers given for an option.
pub(crate) fn numbers(path: &Path, option: &str) -> anyhow::Result<Vec<f64>> {
    read_numbers(path).with_context(|| format!("{option} {}", path.display()))
}
