//! The grid that every reader returns.

use std::fmt;

/// Points in rows and columns: [`rows`](Self::rows) rows, counted in the
/// direction u, of [`columns`](Self::columns) points each, counted in the
/// direction v.
#[derive(Debug, Clone, PartialEq)]
pub struct PointGrid {
    /// The file's name as given, or "standard input".
    pub source: String,
    /// What the file was read as.
    pub format: GridFormat,
    /// The title, where the file gives one.
    pub title: Option<String>,
    /// The number of rows, at least 1.
    pub rows: usize,
    /// The number of points in each row, at least 1.
    pub columns: usize,
    /// The names of the coordinates in order.
    pub column_names: Vec<String>,
    /// The coordinates in C order: shape (rows, columns, dimension). Finite,
    /// but for holes that were to be kept.
    pub coordinates: Vec<f64>,
    /// Every choice made while reading, one sentence each.
    pub notes: Vec<String>,
    /// One finite number per row (u, or y of a grid of heights), where the
    /// file gives them.
    pub row_abscissae: Option<Vec<f64>>,
    /// One finite number per column (v, or x of a grid of heights), where the
    /// file gives them.
    pub column_abscissae: Option<Vec<f64>>,
    /// Where the points stand in the file.
    pub lines: GridLines,
}

/// Where the points of a grid stand in the file. Lines count from 1; those past
/// `u32::MAX` are given as `u32::MAX`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum GridLines {
    /// The file has no lines.
    Binary,
    /// Lines of the file do not follow the rows of the grid.
    Unknown,
    /// The line of each row.
    OfRows(Vec<u32>),
    /// The line of each point, in C order.
    OfPoints(Vec<u32>),
}

impl PointGrid {
    /// The number of coordinates of each point.
    pub fn dimension(&self) -> usize {
        self.column_names.len()
    }

    /// Row and column, from 0, of each cell without a value that was kept.
    pub fn holes(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.coordinates
            .chunks_exact(self.dimension().max(1))
            .enumerate()
            .filter(|(_, point)| point.iter().any(|x| x.is_nan()))
            .map(|(at, _)| (at / self.columns.max(1), at % self.columns.max(1)))
    }

    /// Where the point in row `row` and column `column` (both from 0) stands:
    /// "row 3, column 7 (line 12)", counted from 1 as lines are, or "row 3,
    /// column 7 (counted from 1)" where the file has no lines.
    pub fn point_name(&self, row: usize, column: usize) -> String {
        let (next_row, next_column) = (row.saturating_add(1), column.saturating_add(1));
        let line = match &self.lines {
            GridLines::Binary => {
                return format!("row {next_row}, column {next_column} (counted from 1)");
            }
            GridLines::Unknown => None,
            GridLines::OfRows(lines) => lines.get(row),
            GridLines::OfPoints(lines) => row
                .checked_mul(self.columns)
                .and_then(|start| start.checked_add(column))
                .filter(|_| column < self.columns)
                .and_then(|at| lines.get(at)),
        };
        match line {
            Some(line) => format!("row {next_row}, column {next_column} (line {line})"),
            None => format!("row {next_row}, column {next_column}"),
        }
    }
}

/// The format a grid was read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum GridFormat {
    /// Text with one point per line.
    Lines,
    /// Text with one row of heights per line.
    Matrix,
    /// An ESRI ASCII grid of heights.
    EsriAscii,
    /// A NumPy array file.
    Npy,
}

impl fmt::Display for GridFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            GridFormat::Lines => "one point per line",
            GridFormat::Matrix => "matrix of heights",
            GridFormat::EsriAscii => "ESRI ASCII grid",
            GridFormat::Npy => "NumPy array",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_named_as_exactly_as_the_file_allows() {
        let mut grid = PointGrid {
            source: "f".to_owned(),
            format: GridFormat::Lines,
            title: None,
            rows: 1,
            columns: 2,
            column_names: vec!["z".to_owned()],
            coordinates: vec![0.0, 1.0],
            notes: Vec::new(),
            row_abscissae: None,
            column_abscissae: None,
            lines: GridLines::OfPoints(vec![5, 9]),
        };
        assert_eq!(grid.point_name(0, 1), "row 1, column 2 (line 9)");
        assert_eq!(grid.point_name(0, 2), "row 1, column 3");
        assert_eq!(grid.point_name(usize::MAX, 0), format!("row {}, column 1", usize::MAX));
        grid.lines = GridLines::OfRows(vec![4]);
        assert_eq!(grid.point_name(0, 1), "row 1, column 2 (line 4)");
        grid.lines = GridLines::Unknown;
        assert_eq!(grid.point_name(0, 1), "row 1, column 2");
        grid.lines = GridLines::Binary;
        assert_eq!(grid.point_name(0, 1), "row 1, column 2 (counted from 1)");
    }
}
