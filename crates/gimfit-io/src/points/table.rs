//! The table that every reader returns.

use std::fmt;

/// Points read from a file, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct PointTable {
    /// The file's name as given, or "standard input".
    pub source: String,
    /// What the file was read as.
    pub format: PointFormat,
    /// The airfoil's name or the track's name, where the file gives one.
    pub title: Option<String>,
    /// The names of the coordinate columns in order: those of the header, or
    /// "column 1" and so on, counted in the file.
    pub column_names: Vec<String>,
    /// The coordinates, row-major: [`PointTable::rows`] times
    /// [`PointTable::dimension`] finite numbers.
    pub coordinates: Vec<f64>,
    /// The line of each row in the file, from 1; `None` for binary files.
    /// Lines past `u32::MAX` are given as `u32::MAX`.
    pub row_lines: Option<Vec<u32>>,
    /// The position of each row in the file, from 0; `None` while the rows are
    /// in the order of the file.
    pub row_positions: Option<Vec<usize>>,
    /// Rows of the file that are not here because they lack a value.
    pub rows_left_out: usize,
    /// Every choice made while reading, one sentence each.
    pub notes: Vec<String>,
    /// The column asked for as abscissa, one finite number per row.
    pub abscissa: Option<Vec<f64>>,
    /// The name of that column.
    pub abscissa_name: Option<String>,
}

impl PointTable {
    /// The number of coordinates of each point.
    pub fn dimension(&self) -> usize {
        self.column_names.len()
    }

    /// The number of points.
    pub fn rows(&self) -> usize {
        match self.dimension() {
            0 => 0,
            dimension => self.coordinates.len() / dimension,
        }
    }

    /// Where row `row` (from 0) stands in the file: "line 17", or "point 16
    /// (counted from 0)" where the file has no lines.
    pub fn row_name(&self, row: usize) -> String {
        match self.row_lines.as_ref().and_then(|lines| lines.get(row)) {
            Some(line) => format!("line {line}"),
            None => {
                let position = self.row_positions.as_ref().and_then(|rows| rows.get(row));
                format!("point {} (counted from 0)", position.unwrap_or(&row))
            }
        }
    }

    /// Numbers given for the rows of the file, for the rows as they are now:
    /// sorted, or without some. Unless there is one for each row of the file, they
    /// are given back as they are.
    pub fn for_rows(&self, numbers: Vec<f64>) -> Vec<f64> {
        match &self.row_positions {
            Some(positions) if numbers.len() == self.rows() + self.rows_left_out => {
                positions.iter().map(|&row| numbers[row]).collect()
            }
            _ => numbers,
        }
    }

    /// Leaves out rows with a NaN, which stands for a value that is missing,
    /// and notes which.
    pub(super) fn leave_out_missing(&mut self) {
        const NAMED: usize = 5;
        let dimension = self.dimension();
        let is_there = |row: &usize| {
            let abscissa = self.abscissa.as_ref().map_or(0.0, |abscissa| abscissa[*row]);
            let point = &self.coordinates[row * dimension..][..dimension];
            !abscissa.is_nan() && !point.iter().any(|x| x.is_nan())
        };
        let (kept, missing): (Vec<usize>, Vec<usize>) = (0..self.rows()).partition(is_there);
        if missing.is_empty() {
            return;
        }
        let mut names: Vec<String> =
            missing.iter().take(NAMED).map(|&row| self.row_name(row)).collect();
        if missing.len() > NAMED {
            names.push(format!("and {} more", missing.len() - NAMED));
        }
        self.notes.push(format!(
            "{} without a value left out: {}.",
            super::error::counted(missing.len(), "row"),
            names.join(", ")
        ));
        self.rows_left_out = missing.len();
        self.keep(kept);
    }

    /// Takes these rows, in this order.
    fn keep(&mut self, rows: Vec<usize>) {
        let dimension = self.dimension();
        self.coordinates = rows
            .iter()
            .flat_map(|&row| &self.coordinates[row * dimension..][..dimension])
            .copied()
            .collect();
        if let Some(abscissa) = &mut self.abscissa {
            *abscissa = rows.iter().map(|&row| abscissa[row]).collect();
        }
        if let Some(lines) = &mut self.row_lines {
            *lines = rows.iter().map(|&row| lines[row]).collect();
        }
        self.row_positions = Some(match self.row_positions.take() {
            None => rows,
            Some(before) => rows.iter().map(|&row| before[row]).collect(),
        });
    }

    /// Sorts the rows by their abscissa, if there is one, and notes how many
    /// moved; rows of equal abscissa keep their order.
    pub fn sort_by_abscissa(&mut self) {
        let Some(abscissa) = &self.abscissa else { return };
        let mut order: Vec<usize> = (0..abscissa.len()).collect();
        order.sort_by(|&a, &b| abscissa[a].total_cmp(&abscissa[b]));
        let moved = order.iter().enumerate().filter(|(new, old)| new != *old).count();
        self.notes.push(format!("rows sorted by abscissa; {moved} of {} moved", order.len()));
        self.keep(order);
    }
}

/// The format a file was read as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PointFormat {
    /// Cells separated by commas or semicolons.
    Csv,
    /// Cells separated by tabs.
    Tsv,
    /// Cells separated by runs of blanks.
    Whitespace,
    /// An airfoil as one loop: a name, then pairs from the trailing edge.
    AirfoilSelig,
    /// An airfoil as two halves, each from the nose.
    AirfoilLednicer,
    /// A GPS track or route in GPX.
    Gpx,
    /// A NumPy array file.
    Npy,
    /// Text whose first three columns are coordinates.
    Xyz,
}

impl fmt::Display for PointFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            PointFormat::Csv => "CSV",
            PointFormat::Tsv => "TSV",
            PointFormat::Whitespace => "whitespace-separated text",
            PointFormat::AirfoilSelig => "airfoil, Selig order",
            PointFormat::AirfoilLednicer => "airfoil, Lednicer order",
            PointFormat::Gpx => "GPX track",
            PointFormat::Npy => "NumPy array",
            PointFormat::Xyz => "XYZ",
        })
    }
}
