//! Matrices of heights in text: one row of the grid per line.
//!
//! The first row and the first column are the abscissae x and y where the
//! corner cell is empty, is text or is not there, or where the caller says so;
//! otherwise x and y are the indices. Cells without a value are refused, all
//! counted and the first named; so are rows of different lengths.

use std::ops::ControlFlow;

use super::grid::{GridFormat, GridLines, PointGrid};
use super::heights::{CellPlace, Heights, Tally, cell_problem, indices};
use super::opening::{Opening, Start};
use super::options::GridOptions;
use crate::points::decimal::require_comma;
use crate::points::error::{column_name, counted};
use crate::points::layout::{Layout, note_ends};
use crate::points::number::{Fault, parse};
use crate::points::rows::{Cells, Rows, Skipped};
use crate::points::text::{Stop, note_skipped};
use crate::points::{DecimalMark, Delimiter, Problem, ReadError};

/// Reads the matrix in `rows`, which open with `start`.
pub(super) fn read(
    rows: &Rows<'_>,
    start: Start,
    source: &str,
    options: &GridOptions,
    mut notes: Vec<String>,
) -> Result<PointGrid, ReadError> {
    let form = Form::new(&start, rows.separator, source, options, &mut notes)?;
    let reader = Reader {
        rows,
        form: &form,
        source,
        may_switch: options.decimal.is_none()
            && (rows.separator != Delimiter::Comma || rows.may_be_quoted),
    };
    let sheet = match reader.read(options.decimal.unwrap_or(DecimalMark::Point)) {
        Ok(sheet) => sheet,
        Err(Stop::Error(error)) => return Err(error),
        Err(Stop::Comma) => {
            let wanted = vec![true; form.layout.names.len()];
            require_comma(rows, &form.layout, &wanted, source, &mut notes)?;
            reader.read(DecimalMark::Comma).map_err(|stop| match stop {
                Stop::Error(error) => error,
                Stop::Comma => {
                    let text = "the decimal mark cannot be found".to_owned();
                    ReadError::file(source, Problem::Malformed(text))
                }
            })?
        }
    };
    if !options.keep_holes {
        sheet.tally.refuse_holes(sheet.z.len(), source)?;
    }
    let (m, n) = (sheet.lines.len(), form.columns);
    if let Some((rows, columns)) = options.shape.filter(|shape| *shape != (m, n)) {
        let problem = Problem::Malformed(format!(
            "the shape {rows}x{columns} is asked for, but the matrix is {m}x{n}"
        ));
        return Err(ReadError::file(source, problem));
    }
    note_skipped(sheet.skipped, sheet.tally.vanished(), &mut notes);
    notes.push(format!(
        "The file is read as a matrix of heights: {} of {}.",
        counted(m, "row"),
        counted(n, "number")
    ));
    notes.push(form.axes_note());
    let heights = Heights {
        x: sheet.x.clone().unwrap_or_else(|| indices(n)),
        y: sheet.y.clone().unwrap_or_else(|| indices(m)),
        z: sheet.z,
    };
    let (column_names, coordinates) = heights.points(options, source)?;
    Ok(PointGrid {
        source: source.to_owned(),
        format: GridFormat::Matrix,
        title: None,
        rows: m,
        columns: n,
        column_names,
        coordinates,
        notes,
        row_abscissae: sheet.y,
        column_abscissae: sheet.x,
        lines: GridLines::OfRows(sheet.lines),
    })
}

/// The parts of the matrix.
struct Form {
    layout: Layout,
    /// The number of heights in each row.
    columns: usize,
    /// The line of the first row, if it holds no heights.
    head: Option<u32>,
    /// Which cell of that row is the first abscissa, if it holds abscissae.
    x_from: Option<usize>,
    /// Whether the first column holds abscissae.
    has_y: bool,
    why: &'static str,
}

impl Form {
    fn new(
        start: &Start,
        separator: Delimiter,
        source: &str,
        options: &GridOptions,
        notes: &mut Vec<String>,
    ) -> Result<Self, ReadError> {
        let asked = options.axes == Some(true);
        const ASKED: &str = "as asked for";
        let (head, x_from, has_y, why) = match (start.opening, options.axes) {
            (Opening::Names, _) => (true, None, asked, ASKED),
            (_, Some(false)) | (Opening::Data, None) => (false, None, false, ""),
            (Opening::Data, Some(true)) => (true, Some(1), true, ASKED),
            (Opening::Axis { corner }, _) => {
                let corner_cell = start.first.cells.first().map_or("", String::as_str);
                let why = match (asked, corner, corner_cell) {
                    (true, ..) => ASKED,
                    (_, false, _) => "because the first row is one cell shorter",
                    (.., "") => "because the corner cell is empty",
                    _ => "because the corner cell is a name",
                };
                (true, Some(usize::from(corner)), true, why)
            }
        };
        if head && start.opening == Opening::Names {
            notes.push(format!(
                "Line {} holds names and is left out of the matrix.",
                start.first.line
            ));
        }
        let row = if head { start.second.as_ref() } else { Some(&start.first) };
        let Some(row) = row else {
            let problem =
                Problem::NoRows(format!("there is only line {}, a header", start.first.line));
            return Err(ReadError::file(source, problem));
        };
        let cells = row.cells.len();
        let head_fits = start.first.cells.len() + 1 == cells || start.first.ends_empty(separator);
        let ends_separated = row.ends_empty(separator) && (!head || head_fits);
        if ends_separated {
            note_ends(notes);
        }
        let width = cells - usize::from(ends_separated);
        let columns = width - usize::from(has_y);
        if columns == 0 {
            let problem = Problem::NoRows("no column is left beside the abscissae".to_owned());
            return Err(ReadError::line(source, row.line, problem));
        }
        let layout = Layout {
            // The first row counts as data in the search for the decimal mark.
            header: None,
            names: (0..width).map(column_name).collect(),
            set_by: row.line,
            first_line: row.line,
            ends_separated,
            text_first: Vec::new(),
        };
        let head = head.then_some(start.first.line);
        Ok(Form { layout, columns, head, x_from, has_y, why })
    }

    fn axes_note(&self) -> String {
        let why = self.why;
        let read = match (self.x_from, self.has_y) {
            (Some(_), _) => format!(
                "x is the number above the column and y the number that opens the row, {why}"
            ),
            (None, true) => {
                format!(
                    "x is the index of the column, from 0, and y the number that opens the row, {why}"
                )
            }
            (None, false) => {
                "x is the index of the column and y that of the row, from 0".to_owned()
            }
        };
        format!("The points are (x, y, z): z is the height; {read}.")
    }
}

struct Reader<'a> {
    rows: &'a Rows<'a>,
    form: &'a Form,
    source: &'a str,
    /// Whether a comma in a cell may turn out to be the decimal mark.
    may_switch: bool,
}

#[derive(Default)]
struct Sheet {
    x: Option<Vec<f64>>,
    y: Option<Vec<f64>>,
    z: Vec<f64>,
    lines: Vec<u32>,
    tally: Tally,
    skipped: Skipped,
}

impl Reader<'_> {
    fn read(&self, mark: DecimalMark) -> Result<Sheet, Stop> {
        let mut out = Sheet { y: self.form.has_y.then(Vec::new), ..Sheet::default() };
        out.skipped = self.rows.visit(|line, cells| {
            if Some(line) != self.form.head {
                self.row(line, cells, mark, &mut out)?;
            } else if let Some(from) = self.form.x_from {
                out.x = Some(self.x(line, cells, from, mark)?);
            }
            Ok::<_, Stop>(ControlFlow::Continue(()))
        })?;
        Ok(out)
    }

    #[cold]
    fn stop(&self, line: u32, at: usize, cell: &str, fault: Fault, mark: DecimalMark) -> Stop {
        let comma = fault == Fault::NotANumber && cell.contains(',');
        if comma && self.may_switch && mark == DecimalMark::Point {
            return Stop::Comma;
        }
        ReadError::line(self.source, line, cell_problem(cell, fault)).in_column(at, &[]).into()
    }

    /// The abscissae in the first row.
    fn x(
        &self,
        line: u32,
        cells: Cells<'_>,
        from: usize,
        mark: DecimalMark,
    ) -> Result<Vec<f64>, Stop> {
        let columns = self.form.columns;
        let mut x = Vec::new();
        let mut count = 0;
        for (at, cell) in cells.enumerate().skip(from) {
            count += 1;
            // The header may end with a separator.
            if count <= columns || !cell.is_empty() {
                x.push(parse(cell, mark).map_err(|f| self.stop(line, at, cell, f, mark))?);
            }
        }
        if x.len() == columns {
            return Ok(x);
        }
        let problem = Problem::Malformed(format!(
            "there are {} for {} of heights; correct the row of abscissae",
            counted(x.len(), "abscissa").replace("abscissas", "abscissae"),
            counted(columns, "column")
        ));
        Err(ReadError::line(self.source, line, problem).into())
    }

    #[inline]
    fn row(
        &self,
        line: u32,
        cells: Cells<'_>,
        mark: DecimalMark,
        out: &mut Sheet,
    ) -> Result<(), Stop> {
        let width = self.form.layout.names.len();
        let first = usize::from(self.form.has_y);
        let row = out.lines.len();
        let mut count = 0;
        let mut last = "";
        let mut fault = None;
        for cell in cells {
            if count < first {
                match (parse(cell, mark), &mut out.y) {
                    (Ok(value), Some(y)) => y.push(value),
                    (Err(found), _) => fault = fault.or(Some((count, cell, found))),
                    (Ok(_), None) => {}
                }
            } else if count < width {
                let place = || CellPlace { line, cell: count, row, column: count - first };
                match out.tally.height(cell, mark, None, place) {
                    Ok(value) => out.z.push(value),
                    // A row of the wrong length is the graver fault.
                    Err(found) => fault = fault.or(Some((count, cell, found))),
                }
            }
            count += 1;
            last = cell;
        }
        let layout = &self.form.layout;
        if count != width + usize::from(layout.ends_separated) {
            return Err(layout.ragged(self.source, line, count, self.rows.separator).into());
        }
        if layout.ends_separated && !last.is_empty() {
            let advice = format!("line {line} has a value in this column; fill the cell in");
            let problem = Problem::EmptyCell { advice };
            return Err(ReadError::line(self.source, layout.first_line, problem)
                .in_column(width, &[])
                .into());
        }
        if let Some((at, cell, found)) = fault {
            return Err(self.stop(line, at, cell, found, mark));
        }
        out.lines.push(line);
        Ok(())
    }
}
