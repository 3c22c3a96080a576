//! Errors of the library about points, in the words of the file they came from.

use anyhow::anyhow;
use gimfit::Error;
use gimfit_io::points::PointTable;

/// Rewrites an error about points so that it names the file, its rows and its columns.
pub(crate) fn explain(error: Error, table: &PointTable) -> anyhow::Error {
    let source = &table.source;
    match error {
        Error::NotFinite { point, coordinate, value } => anyhow!(
            "{source}, {}, {}: {value} is not a finite number; remove the row or give a value",
            table.row_name(point),
            column(table, coordinate)
        ),
        Error::ExtentOverflow { coordinate } => anyhow!(
            "{source}, {}: the numbers span more than the range of doubles; scale the data down",
            column(table, coordinate)
        ),
        other => anyhow!("{source}: {other}"),
    }
}

/// A column as messages name it.
fn column(table: &PointTable, coordinate: usize) -> String {
    match table.column_names.get(coordinate) {
        Some(name) if name.starts_with("column ") => name.clone(),
        Some(name) => format!("column \"{name}\""),
        None => format!("column {}", coordinate + 1),
    }
}
