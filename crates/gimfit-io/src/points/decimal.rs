//! Whether commas in the cells are decimal marks.
//!
//! Asked only where a cell that should be a number has a comma. Commas are
//! decimal marks if every comma in the chosen columns can be one, no number
//! there has a point, and not every one of them could as well group thousands
//! (`12,345`). Between semicolons the last condition is dropped: programs
//! separate with semicolons just because the comma is the decimal mark.

use std::ops::ControlFlow;

use super::error::{Problem, ReadError, shortened};
use super::layout::Layout;
use super::number::{looks_numeric, parse};
use super::options::{DecimalMark, Delimiter};
use super::rows::Rows;

struct Seen {
    line: u32,
    column: usize,
    cell: String,
}

impl Seen {
    fn new(line: u32, column: usize, cell: &str) -> Self {
        Seen { line, column, cell: shortened(cell) }
    }
}

/// Returns if commas are decimal marks in the columns marked in `wanted`, and
/// fails if they can be something else.
pub(crate) fn require_comma(
    rows: &Rows<'_>,
    layout: &Layout,
    wanted: &[bool],
    source: &str,
    notes: &mut Vec<String>,
) -> Result<(), ReadError> {
    let mut comma: Option<Seen> = None;
    let mut point: Option<Seen> = None;
    let mut all_group = true;
    rows.visit(|line, cells| {
        if Some(line) == layout.header {
            return Ok(ControlFlow::Continue(()));
        }
        for (column, cell) in cells.enumerate().take(wanted.len()) {
            if !wanted[column] {
                continue;
            }
            let has_comma = cell.contains(',');
            if has_comma && parse(cell, DecimalMark::Comma).is_ok() {
                all_group = all_group && groups_thousands(cell);
                comma.get_or_insert_with(|| Seen::new(line, column, cell));
            } else if has_comma && looks_numeric(cell) {
                let seen = Seen::new(line, column, cell);
                let why = "write it with one decimal mark";
                return Err(ambiguous(source, layout, &seen, why));
            } else if cell.contains('.') && parse(cell, DecimalMark::Point).is_ok() {
                point.get_or_insert_with(|| Seen::new(line, column, cell));
            }
        }
        Ok(ControlFlow::Continue(()))
    })?;
    let Some(comma) = comma else {
        // The cell with a comma is text; the reader says so.
        return Ok(());
    };
    if let Some(point) = point {
        let why = format!(
            "its comma is a decimal mark or groups thousands, and line {} has \"{}\" with a \
             point; write all numbers with decimal points",
            point.line, point.cell
        );
        return Err(ambiguous(source, layout, &comma, &why));
    }
    if all_group && rows.separator != Delimiter::Semicolon {
        // With decimal commas, commas are no longer taken for separators unless named.
        let separator = match rows.separator {
            Delimiter::Comma => " --delimiter comma",
            _ => "",
        };
        let why = format!(
            "its comma is a decimal mark or groups thousands; write decimal points, or name the \
             mark with --decimal comma{separator}"
        );
        return Err(ambiguous(source, layout, &comma, &why));
    }
    notes.push(format!(
        "The comma is read as the decimal mark (first in \"{}\" on line {}).",
        comma.cell, comma.line
    ));
    Ok(())
}

fn ambiguous(source: &str, layout: &Layout, seen: &Seen, why: &str) -> ReadError {
    let problem = Problem::Ambiguous { cell: seen.cell.clone(), why: why.to_owned() };
    ReadError::line(source, seen.line, problem).in_column(seen.column, &layout.names)
}

/// Whether a cell with one comma reads as a whole number in groups of three.
fn groups_thousands(cell: &str) -> bool {
    let digits = cell.trim_start_matches(['+', '-']);
    let Some((before, after)) = digits.split_once(',') else {
        return false;
    };
    let all_digits = |part: &str| part.bytes().all(|b| b.is_ascii_digit());
    (1..=3).contains(&before.len())
        && !before.starts_with('0')
        && after.len() == 3
        && all_digits(before)
        && all_digits(after)
}
