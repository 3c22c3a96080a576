//! Which reader takes a file.

use super::grid::PointGrid;
use super::opening::{Opening, Start};
use super::options::{GridFormatChoice, GridOptions};
use super::{esri, esri_header, lines, matrix, npy};
use crate::points::error::counted;
use crate::points::format::{is_markup, note_text_options};
use crate::points::npy::MAGIC;
use crate::points::rows::Rows;
use crate::points::{Problem, ReadError, decode, layout, separator};

/// The most columns of a table without a header in which each line is thought
/// to be one point.
const MOST_COORDINATES: usize = 3;

/// Reads `bytes` with the reader that the options, the content or the ending
/// of the name call for.
pub(super) fn read(
    bytes: &[u8],
    source: &str,
    extension: Option<&str>,
    options: &GridOptions,
) -> Result<PointGrid, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::file(source, Problem::Empty));
    }
    let extension = extension.unwrap_or("").trim_start_matches('.').to_ascii_lowercase();
    let mut notes = Vec::new();
    let array = match options.format {
        Some(format) => format == GridFormatChoice::Npy,
        None => bytes.starts_with(MAGIC) || extension == "npy",
    };
    if array {
        note_text_options(&options.for_points(), &mut notes);
        return npy::read(bytes, source, options, notes);
    }
    let text = decode::text(bytes, source, false, &mut notes)?;
    if is_markup(text.as_bytes()) {
        let problem = Problem::Malformed(
            "the content is XML or HTML, not a grid of points; export the grid as CSV first"
                .to_owned(),
        );
        return Err(ReadError::file(source, problem));
    }
    let named_esri = || options.delimiter.is_none() && esri_header::opens(&text);
    if options.format == Some(GridFormatChoice::EsriAscii)
        || (options.format.is_none() && named_esri())
    {
        return esri::read(&text, source, options, notes);
    }
    let separator = separator::find(&text, &extension, &options.for_points());
    let rows = Rows::new(&text, separator, source)?;
    let start = Start::new(layout::first_two(&rows, source)?, source)?;
    let form = match options.format {
        Some(GridFormatChoice::Lines) => Form::Lines,
        Some(_) => Form::Matrix,
        None => find(&rows, &start, source, options)?,
    };
    let mut grid = match form {
        Form::Lines => lines::read(&text, &extension, &rows, source, options, notes),
        Form::Matrix => matrix::read(&rows, start, source, options, notes),
    }?;
    // What a blank line means to a curve, it means to a grid too.
    for note in &mut grid.notes {
        if let Some(kept) = note.strip_suffix("the rows before and after are one curve.") {
            *note = format!("{kept}the rows before and after are one grid.");
        }
    }
    Ok(grid)
}

/// Whether bytes say of themselves that they hold a grid.
pub(super) fn says_grid(bytes: &[u8], extension: Option<&str>) -> bool {
    let extension = extension.unwrap_or("").trim_start_matches('.').to_ascii_lowercase();
    if bytes.starts_with(MAGIC) {
        return crate::points::npy::axes(bytes) == Some(3);
    }
    let Ok(text) = decode::text(bytes, "", false, &mut Vec::new()) else { return false };
    if is_markup(text.as_bytes()) {
        return false;
    }
    if esri_header::opens(&text) {
        return true;
    }
    let options = GridOptions::default().for_points();
    let separator = separator::find(&text, &extension, &options);
    let start = Rows::new(&text, separator, "")
        .and_then(|rows| layout::first_two(&rows, ""))
        .and_then(|rows| Start::new(rows, ""));
    match start {
        Ok(Start { opening: Opening::Axis { corner }, .. }) => corner,
        Ok(Start { opening: Opening::Names, first, .. }) => {
            first.cells.len() > 2 && lines::pair_by_name(&first.cells).is_some()
        }
        _ => false,
    }
}

/// What one line of a table of text holds.
enum Form {
    /// One point.
    Lines,
    /// One row of heights.
    Matrix,
}

fn find(
    rows: &Rows<'_>,
    start: &Start,
    source: &str,
    options: &GridOptions,
) -> Result<Form, ReadError> {
    if options.index_columns.is_some() {
        return Ok(Form::Lines);
    }
    let named = match start.opening {
        Opening::Axis { .. } => return Ok(Form::Matrix),
        Opening::Names => true,
        Opening::Data => false,
    };
    if options.axes == Some(true) {
        return Ok(Form::Matrix);
    }
    if named && lines::pair_by_name(&start.first.cells).is_some() {
        return Ok(Form::Lines);
    }
    let count = lines::count(rows)? - usize::from(named);
    let width = start.data_width(rows.separator);
    match options.shape {
        Some(shape) if shape == (count, width) => Ok(Form::Matrix),
        Some(_) => Ok(Form::Lines),
        None if named => Ok(Form::Lines),
        None if width <= MOST_COORDINATES && count > width => {
            let problem = Problem::Malformed(format!(
                "{} of {} can be points or rows of heights; give the shape of the grid: of \
                 points row by row, such as --shape 20x30, or of heights, --shape {count}x{width}",
                counted(count, "line"),
                counted(width, "number"),
            ));
            Err(ReadError::file(source, problem))
        }
        None => Ok(Form::Matrix),
    }
}
