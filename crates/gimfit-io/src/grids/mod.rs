//! Readers of grids of points: one file per format, one grid as the result.
//!
//! [`read_grid`] takes a path (or `-` for standard input) and
//! [`read_grid_from`] takes bytes; both return a [`PointGrid`]: rows of points,
//! all of one length. Text, numbers, separators and decimal marks are read as
//! the readers of [`crate::points`] read them. Every choice made while reading
//! is a sentence in [`PointGrid::notes`]; a cell without a value is an error
//! that names it, and so is a shape that cannot be known with certainty.

mod esri;
mod esri_header;
mod format;
mod grid;
mod heights;
mod lattice;
mod lines;
mod matrix;
mod npy;
mod opening;
mod options;

#[cfg(test)]
mod test_broken;
#[cfg(test)]
mod test_lines;
#[cfg(test)]
mod test_matrix;

use std::path::Path;

pub use grid::{GridFormat, GridLines, PointGrid};
pub use options::{GridFormatChoice, GridOptions, parse_shape};

use crate::points::{ReadError, input};

/// Reads the grid in the file at `path`; the path `-` means standard input.
pub fn read_grid(path: &Path, options: &GridOptions) -> Result<PointGrid, ReadError> {
    let source = input::source_name(path);
    let bytes = input::read_bytes(path, &source)?;
    read_grid_from(&bytes, &source, input::extension(path).as_deref(), options)
}

/// Whether bytes say of themselves that they hold a grid rather than a list of
/// points: an ESRI ASCII grid, an array of three axes, a matrix of heights with
/// abscissae, or lines that name their row and column.
#[must_use]
pub fn says_grid(bytes: &[u8], extension: Option<&str>) -> bool {
    format::says_grid(bytes, extension)
}

/// Reads a grid from bytes. `source` names them in messages; `extension` is
/// the ending of the file's name, with or without its dot, where there is one.
pub fn read_grid_from(
    bytes: &[u8],
    source: &str,
    extension: Option<&str>,
    options: &GridOptions,
) -> Result<PointGrid, ReadError> {
    format::read(bytes, source, extension, options)
}
