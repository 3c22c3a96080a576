//! Points and numbers from files, as the arguments describe them.

use crate::arguments::InputArguments;
use crate::targets::is_standard;
use anyhow::{anyhow, ensure};
use gimfit_io::points::{PointTable, Problem, ReadOptions, read_numbers, read_points};
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
        skip_missing: arguments.skip_missing,
    }
}

/// Reads a list of numbers given for an option, one for each row of the file of points: rows that were
/// sorted, or left out, take theirs along.
pub(crate) fn numbers_of_rows(
    path: &Path,
    option: &str,
    table: &PointTable,
) -> anyhow::Result<Vec<f64>> {
    let given = numbers(path, option, &[])?;
    let all = table.rows() + table.rows_left_out;
    ensure!(
        table.rows_left_out == 0 || given.len() == all,
        "{option} {}: there are {} numbers, but {} has {all} rows; give one for each, those left out \
         included",
        path.display(),
        given.len(),
        table.source
    );
    Ok(table.for_rows(given))
}

/// Reads a list of numbers given for an option, which takes one of `words` as well.
pub(crate) fn numbers(path: &Path, option: &str, words: &[String]) -> anyhow::Result<Vec<f64>> {
    read_numbers(path).map_err(|error| {
        let unknown = matches!(error.problem(), Problem::NotFound) && !words.is_empty();
        let error = anyhow!(error).context(format!("{option} {}", path.display()));
        if unknown {
            error.context(format!("{option} takes {} or a file of numbers", words.join(", ")))
        } else {
            error
        }
    })
}

/// Refuses standard input where it would be read more than once; each input has its name.
pub(crate) fn check_standard_input(inputs: &[(&str, &Path)]) -> anyhow::Result<()> {
    let names: Vec<&str> =
        inputs.iter().filter(|(_, path)| is_standard(path)).map(|(name, _)| *name).collect();
    ensure!(
        names.len() <= 1,
        "standard input can be read only once, but {} both ask for it; give a file for one",
        names.join(" and ")
    );
    Ok(())
}
