//! Readers of points: one file per format, one table as the result.
//!
//! [`read_points`] takes a path (or `-` for standard input) and
//! [`read_points_from`] takes bytes; both return a [`PointTable`]. The format
//! follows from the file's ending, or from its content when the ending says
//! nothing or is contradicted by it. Every choice made while reading is a
//! sentence in [`PointTable::notes`]; nothing is repaired without one, and what
//! cannot be read with certainty is refused with a [`ReadError`] that names the
//! file, the line and the column.

mod airfoil;
pub(crate) mod columns;
pub(crate) mod decimal;
pub(crate) mod decode;
pub(crate) mod error;
pub(crate) mod format;
mod gpx;
mod gpx_guard;
mod gpx_plane;
pub(crate) mod input;
pub(crate) mod layout;
mod lines;
pub(crate) mod npy;
pub(crate) mod npy_header;
pub(crate) mod number;
mod number_list;
mod options;
mod quoted;
pub(crate) mod rows;
pub(crate) mod separator;
mod table;
pub(crate) mod text;

#[cfg(test)]
mod test_broken;
#[cfg(test)]
mod test_text;

use std::path::Path;

pub use error::{ColumnLabel, Place, Problem, ReadError};
pub use options::{
    ColumnChoice, DecimalMark, Delimiter, FormatChoice, PartChoice, ReadOptions, UnknownChoice,
};
pub use table::{PointFormat, PointTable};

/// Reads the points of the file at `path`; the path `-` means standard input.
pub fn read_points(path: &Path, options: &ReadOptions) -> Result<PointTable, ReadError> {
    let source = input::source_name(path);
    let bytes = input::read_bytes(path, &source)?;
    read_points_from(&bytes, &source, input::extension(path).as_deref(), options)
}

/// Reads all bytes of the file at `path`, and no more than any reader takes; the path `-` means
/// standard input.
///
/// # Errors
/// A file that cannot be read, or is too long.
pub fn read_input(path: &Path) -> Result<Vec<u8>, ReadError> {
    input::read_bytes(path, &input::source_name(path))
}

/// How messages name the input at `path`: as it is given, or "standard input".
#[must_use]
pub fn input_name(path: &Path) -> String {
    input::source_name(path)
}

/// Reads points from bytes. `source` names them in messages; `extension` is
/// the ending of the file's name, with or without its dot, where there is one.
pub fn read_points_from(
    bytes: &[u8],
    source: &str,
    extension: Option<&str>,
    options: &ReadOptions,
) -> Result<PointTable, ReadError> {
    format::read(bytes, source, extension, options)
}

/// Reads one list of numbers, such as parameters, knots or weights.
///
/// The file holds text (one number per line, or several separated by blanks,
/// commas or semicolons; comments are skipped) or a one-dimensional NumPy
/// array. The path `-` means standard input.
pub fn read_numbers(path: &Path) -> Result<Vec<f64>, ReadError> {
    let source = input::source_name(path);
    let bytes = input::read_bytes(path, &source)?;
    number_list::read(&bytes, &source)
}
