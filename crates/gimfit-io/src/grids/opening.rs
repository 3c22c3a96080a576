//! What the first row of a table of text holds.

use crate::points::layout::Row;
use crate::points::number::{Fault, is_text, parse};
use crate::points::{DecimalMark, Delimiter, Problem, ReadError};

/// What the first row holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Opening {
    /// Abscissae of the columns.
    Axis {
        /// Whether a cell stands above the first column.
        corner: bool,
    },
    /// Names.
    Names,
    /// Numbers as in every other row.
    Data,
}

/// The first rows of a table.
pub(super) struct Start {
    pub(super) opening: Opening,
    pub(super) first: Row,
    pub(super) second: Option<Row>,
}

impl Start {
    /// The start of the table whose first rows are `rows`.
    pub(super) fn new(rows: Vec<Row>, source: &str) -> Result<Self, ReadError> {
        let mut rows = rows.into_iter();
        let Some(first) = rows.next() else {
            let problem = Problem::NoRows("every line is blank or a comment".to_owned());
            return Err(ReadError::file(source, problem));
        };
        let second = rows.next();
        Ok(Start { opening: opening(&first, second.as_ref()), first, second })
    }

    /// The number of cells in the first row of data, without the empty one
    /// after a closing separator.
    pub(super) fn data_width(&self, separator: Delimiter) -> usize {
        let row = match (self.opening, &self.second) {
            (Opening::Data, _) | (_, None) => &self.first,
            (_, Some(second)) => second,
        };
        row.cells.len() - usize::from(row.ends_empty(separator))
    }
}

fn opening(first: &Row, second: Option<&Row>) -> Opening {
    let [corner, rest @ ..] = first.cells.as_slice() else {
        return Opening::Data;
    };
    // An empty cell may follow the closing separator.
    let (filled, empty) =
        rest.split_at(rest.iter().rposition(|cell| !cell.is_empty()).map_or(0, |last| last + 1));
    let numbers = !filled.is_empty() && empty.len() <= 1 && filled.iter().all(|c| is_number(c));
    let row_starts = second.and_then(|row| row.cells.first()).is_some_and(|c| is_number(c));
    if numbers && row_starts && (corner.is_empty() || is_text(corner)) {
        return Opening::Axis { corner: true };
    }
    let longer = second.is_some_and(|row| row.cells.len() == first.cells.len() + 1);
    let row_filled = second.and_then(|row| row.cells.last()).is_some_and(|cell| !cell.is_empty());
    if numbers && empty.is_empty() && is_number(corner) && row_starts && longer && row_filled {
        return Opening::Axis { corner: false };
    }
    match first.cells.iter().any(|cell| is_text(cell)) {
        true => Opening::Names,
        false => Opening::Data,
    }
}

/// Whether a cell is a number with either decimal mark.
fn is_number(cell: &str) -> bool {
    let with = |mark| matches!(parse(cell, mark), Ok(_) | Err(Fault::TooLarge));
    with(DecimalMark::Point) || with(DecimalMark::Comma)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(first: &str, second: &str) -> Opening {
        let row =
            |line, text: &str| Row { line, cells: text.split(',').map(str::to_owned).collect() };
        opening(&row(1, first), Some(&row(2, second)))
    }

    #[test]
    fn abscissae_are_known_by_the_corner_cell_or_by_its_absence() {
        assert_eq!(found(",0,1", "0,5,6"), Opening::Axis { corner: true });
        assert_eq!(found("y/x,0,1,", "0,5,6,"), Opening::Axis { corner: true });
        assert_eq!(found(",0,1", "0,,"), Opening::Axis { corner: true });
        assert_eq!(found("0,1", "0,5,6"), Opening::Axis { corner: false });
        assert_eq!(found("0,1", "5,6,"), Opening::Data);
        assert_eq!(found(",0,1", "a,5,6"), Opening::Data);
    }

    #[test]
    fn text_makes_names_and_numbers_make_data() {
        assert_eq!(found("x,y,z", "1,2,3"), Opening::Names);
        assert_eq!(found("x", "1"), Opening::Names);
        assert_eq!(found("1,2,3", "4,5,6"), Opening::Data);
        assert_eq!(found("1,,3", "4,5,6"), Opening::Data);
        assert_eq!(found("", ""), Opening::Data);
    }
}
