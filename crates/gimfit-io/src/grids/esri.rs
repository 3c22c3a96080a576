//! ESRI ASCII grids (`.asc`): a header, then heights row by row from north to
//! south.
//!
//! The points stand at the centres of the cells and keep the order of the
//! file, so that y falls from row to row. Line ends among the heights mean
//! nothing: the header says how many make a row. Refused are cells without
//! data, all counted and the first named.

use std::ops::ControlFlow;

use super::esri_header::{self, Header};
use super::grid::{GridFormat, GridLines, PointGrid};
use super::heights::{CellPlace, Heights, Tally, cell_problem};
use super::lattice::shown;
use super::options::GridOptions;
use crate::points::error::counted;
use crate::points::rows::Rows;
use crate::points::text::note_skipped;
use crate::points::{DecimalMark, Delimiter, Problem, ReadError};

/// Reads the grid in `text`.
pub(super) fn read(
    text: &str,
    source: &str,
    options: &GridOptions,
    mut notes: Vec<String>,
) -> Result<PointGrid, ReadError> {
    let rows = Rows::new(text, options.delimiter.unwrap_or(Delimiter::Blanks), source)?;
    let mark = options.decimal.unwrap_or(DecimalMark::Point);
    let header = esri_header::read(&rows, mark, source)?;
    let (m, n) = (header.rows, header.columns);
    let fail = |text| Err(ReadError::file(source, Problem::Malformed(text)));
    if let Some((rows, columns)) = options.shape.filter(|shape| *shape != (m, n)) {
        return fail(format!(
            "the shape {rows}x{columns} is asked for, but the header gives {m}x{n}"
        ));
    }
    let mut body = Body { rows_whole: true, ..Body::default() };
    let skipped = rows.visit(|line, cells| {
        if line >= header.first_line {
            body.line(line, cells, &header, mark, source)?;
        }
        Ok::<_, ReadError>(ControlFlow::Continue(()))
    })?;
    if Some(body.z.len()) != m.checked_mul(n) {
        return fail(format!(
            "the header announces {} of {}, but the file holds {}",
            counted(m, "row"),
            counted(n, "height"),
            counted(body.z.len(), "height")
        ));
    }
    if !options.keep_holes {
        body.tally.refuse_holes(body.z.len(), source)?;
    }
    note_skipped(skipped, body.tally.vanished(), &mut notes);
    notes.push(
        "The points are (x, y, z): x and y are the centre of the cell as the header gives it, z \
         is the height; the rows run from north to south, as in the file."
            .to_owned(),
    );
    if let Some(value) = header.no_data
        && !body.z.iter().any(|z| z.is_nan())
    {
        notes.push(format!("No cell holds {}, which stands for no data.", shown(value)));
    }
    if !body.rows_whole {
        notes.push("Lines of the file are not rows of the grid; ncols parts the rows.".to_owned());
    }
    let heights = Heights {
        x: (0..n).map(|at| header.x + header.dx * at as f64).collect(),
        y: (0..m).map(|at| header.y + header.dy * (m - 1 - at) as f64).collect(),
        z: body.z,
    };
    let (column_names, coordinates) = heights.points(options, source)?;
    Ok(PointGrid {
        source: source.to_owned(),
        format: GridFormat::EsriAscii,
        title: None,
        rows: m,
        columns: n,
        column_names,
        coordinates,
        notes,
        row_abscissae: Some(heights.y),
        column_abscissae: Some(heights.x),
        lines: match body.rows_whole {
            true => GridLines::OfRows(body.lines),
            false => GridLines::Unknown,
        },
    })
}

/// The heights.
#[derive(Default)]
struct Body {
    z: Vec<f64>,
    /// The line on which each row starts.
    lines: Vec<u32>,
    /// Whether every line is one row.
    rows_whole: bool,
    tally: Tally,
}

impl Body {
    fn line<'c>(
        &mut self,
        line: u32,
        cells: impl Iterator<Item = &'c str>,
        header: &Header,
        mark: DecimalMark,
        source: &str,
    ) -> Result<(), ReadError> {
        let n = header.columns;
        self.rows_whole &= self.z.len().is_multiple_of(n);
        let (mut row, mut column) = (self.z.len() / n, self.z.len() % n);
        for (cell_at, cell) in cells.enumerate() {
            if row == header.rows {
                let problem = Problem::Malformed(format!(
                    "more heights follow the {} of {} that the header announces",
                    counted(header.rows, "row"),
                    counted(n, "height")
                ));
                return Err(ReadError::line(source, line, problem).in_column(cell_at, &[]));
            }
            let place = || CellPlace { line, cell: cell_at, row, column };
            let height = self.tally.height(cell, mark, header.no_data, place).map_err(|fault| {
                ReadError::line(source, line, cell_problem(cell, fault)).in_column(cell_at, &[])
            })?;
            if column == 0 {
                self.rows_whole &= cell_at == 0;
                self.lines.push(line);
            }
            self.z.push(height);
            column += 1;
            if column == n {
                (row, column) = (row + 1, 0);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
#[path = "test_esri.rs"]
mod tests;
