//! The shape of a table of text: its header, its columns, the ends of its rows.

use std::ops::ControlFlow;

use super::columns::MOST_COLUMNS;
use super::error::{Problem, ReadError, column_name, counted, list, shortened};
use super::number::{is_text, looks_numeric};
use super::options::{ColumnChoice, Delimiter, ReadOptions};
use super::rows::Rows;

/// The shape of a table.
pub(crate) struct Layout {
    /// The line of the header, if there is one.
    pub(crate) header: Option<u32>,
    /// The names of the columns; "column 1" and so on where none is given.
    pub(crate) names: Vec<String>,
    /// The line that set the number of columns.
    pub(crate) set_by: u32,
    /// The first line of data.
    pub(crate) first_line: u32,
    /// Whether the rows end with a separator.
    pub(crate) ends_separated: bool,
    /// For each column, whether the first row of data has text there.
    pub(crate) text_first: Vec<bool>,
}

/// One row of cells.
pub(crate) struct Row {
    /// Its line in the file.
    pub(crate) line: u32,
    /// Its cells.
    pub(crate) cells: Vec<String>,
}

impl Row {
    /// Whether the row has a separator after its last cell, or an empty cell
    /// there.
    pub(crate) fn ends_empty(&self, separator: Delimiter) -> bool {
        separator != Delimiter::Blanks
            && self.cells.len() > 1
            && self.cells.last().is_some_and(String::is_empty)
    }
}

/// The shape of the table in `rows`.
pub(crate) fn find(
    rows: &Rows<'_>,
    source: &str,
    options: &ReadOptions,
    notes: &mut Vec<String>,
) -> Result<Layout, ReadError> {
    let mut first_rows = first_two(rows, source)?.into_iter();
    let no_rows = |why: String| ReadError::file(source, Problem::NoRows(why));
    let first =
        first_rows.next().ok_or_else(|| no_rows("every line is blank or a comment".to_owned()))?;
    if !is_header(&first, first_rows.as_slice().first()) {
        return Ok(without_header(&first, rows.separator, notes));
    }
    refuse_mixed(&first, first_rows.as_slice().first(), source, options)?;
    let second = first_rows
        .next()
        .ok_or_else(|| no_rows(format!("there is only line {}, a header", first.line)))?;
    Ok(with_header(first, &second, rows.separator, notes))
}

/// A header holds a cell of text. Where it holds numbers too, it is a row of
/// data if the next row has text in the same cells, such as labels.
fn is_header(first: &Row, second: Option<&Row>) -> bool {
    if !first.cells.iter().any(|cell| is_text(cell)) {
        return false;
    }
    let numbers_too = first.cells.iter().any(|cell| looks_numeric(cell));
    let labels_again = second.is_some_and(|second| {
        first
            .cells
            .iter()
            .zip(&second.cells)
            .all(|(above, below)| !is_text(above) || is_text(below))
    });
    !(numbers_too && labels_again)
}

/// A row of text and numbers may be a header with years in it, or data with a cell mistyped.
/// Taking it for the one would drop a point silently in the other case, so it is a header only
/// where a column is asked for by a name in it.
fn refuse_mixed(
    first: &Row,
    second: Option<&Row>,
    source: &str,
    options: &ReadOptions,
) -> Result<(), ReadError> {
    let number = first.cells.iter().find(|cell| looks_numeric(cell));
    let text = first.cells.iter().position(|cell| is_text(cell));
    let (Some(number), Some(at)) = (number, text) else { return Ok(()) };
    // Rows of other lengths are refused for that, with advice that suits a title.
    let alike = second.is_none_or(|second| second.cells.len() == first.cells.len());
    let asked = options.columns.iter().flatten().chain(&options.abscissa).any(|choice| {
        matches!(choice, ColumnChoice::Name(name)
            if first.cells.iter().any(|cell| is_text(cell) && cell.eq_ignore_ascii_case(name)))
    });
    if asked || !alike {
        return Ok(());
    }
    let problem = Problem::NotANumber {
        cell: shortened(&first.cells[at]),
        advice: format!(
            "the row is data with a cell to correct, since \"{}\" is a number, or a header: then \
             put # before it, or ask for a column by its name with --columns",
            shortened(number)
        ),
    };
    Err(ReadError::line(source, first.line, problem).in_column(at, &[]))
}

fn without_header(first: &Row, separator: Delimiter, notes: &mut Vec<String>) -> Layout {
    let ends_separated = first.ends_empty(separator);
    let width = first.cells.len() - usize::from(ends_separated);
    if ends_separated {
        note_ends(notes);
    }
    if first.cells.iter().any(|cell| is_text(cell)) {
        notes.push(format!(
            "Line {} is taken as data and not as a header, because the next row has text in the \
             same columns.",
            first.line
        ));
    }
    Layout {
        header: None,
        names: (0..width).map(column_name).collect(),
        set_by: first.line,
        first_line: first.line,
        ends_separated,
        text_first: texts(first, width),
    }
}

fn with_header(header: Row, row: &Row, separator: Delimiter, notes: &mut Vec<String>) -> Layout {
    let header_ends = header.ends_empty(separator);
    let row_ends = row.ends_empty(separator);
    let (wide, row_wide) = (header.cells.len(), row.cells.len());
    let ends_separated = row_ends && (row_wide == wide + 1 || (header_ends && row_wide == wide));
    let header_alone = header_ends && row_wide + 1 == wide;
    let width = if (ends_separated && row_wide == wide) || header_alone { wide - 1 } else { wide };
    if ends_separated {
        note_ends(notes);
    }
    let numbers_too = header.cells.iter().any(|cell| looks_numeric(cell));
    let names: Vec<String> = header
        .cells
        .into_iter()
        .take(width)
        .enumerate()
        .map(|(at, name)| match name.is_empty() {
            true => column_name(at),
            false => name,
        })
        .collect();
    let line = header.line;
    notes.push(match numbers_too {
        false => format!("Line {line} names the columns: {}.", list(&names)),
        true => format!(
            "Line {line} is taken as the header, although it holds numbers: {}.",
            list(&names)
        ),
    });
    if header_alone {
        notes.push("The separator at the end of the header was left out.".to_owned());
    }
    Layout {
        header: Some(line),
        names,
        set_by: line,
        first_line: row.line,
        ends_separated,
        text_first: texts(row, width),
    }
}

/// Notes that a closing separator is no empty cell.
pub(crate) fn note_ends(notes: &mut Vec<String>) {
    notes.push(
        "Each row ends with a separator, which is taken as its end and not as an empty cell."
            .to_owned(),
    );
}

fn texts(row: &Row, width: usize) -> Vec<bool> {
    let mut texts: Vec<bool> = row.cells.iter().map(|cell| is_text(cell)).collect();
    texts.resize(width, false);
    texts
}

/// The first two rows, or what there is of them.
pub(crate) fn first_two(rows: &Rows<'_>, source: &str) -> Result<Vec<Row>, ReadError> {
    let mut found: Vec<Row> = Vec::new();
    rows.visit(|line, cells| {
        let cells: Vec<String> = cells.take(MOST_COLUMNS + 2).map(str::to_owned).collect();
        if cells.len() > MOST_COLUMNS + 1 {
            let problem = Problem::Malformed(format!(
                "there are more than {MOST_COLUMNS} cells on one line; write one point per line"
            ));
            return Err(ReadError::line(source, line, problem));
        }
        found.push(Row { line, cells });
        Ok(match found.len() {
            2 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        })
    })?;
    Ok(found)
}

impl Layout {
    /// The error for a row of `found` cells.
    pub(crate) fn ragged(
        &self,
        source: &str,
        line: u32,
        found: usize,
        separator: Delimiter,
    ) -> ReadError {
        let set_by = match self.header {
            Some(header) => format!("line {header}, the header,"),
            None => format!("line {}", self.set_by),
        };
        // A title above blank-separated numbers reads as a header.
        let titled =
            self.header.is_some() && separator == Delimiter::Blanks && line == self.first_line;
        let advice = match titled {
            true => format!(
                "correct the row, or put # before line {} if it is a title (of an airfoil: read \
                 it with --format airfoil)",
                self.set_by
            ),
            false => "correct or remove the row".to_owned(),
        };
        let verb = if found == 1 { "is" } else { "are" };
        let problem = Problem::Ragged {
            found: format!("{verb} {}", counted(found, "cell")),
            expected: self.names.len(),
            set_by,
            advice,
        };
        ReadError::line(source, line, problem)
    }
}
