//! What a caller may ask of the readers of grids.

use std::str::FromStr;

use crate::points::{ColumnChoice, DecimalMark, Delimiter, ReadOptions, UnknownChoice};

/// What to read and how; the default leaves every choice to the file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct GridOptions {
    /// The number of rows and of points in each. Needed where the file does
    /// not say it; checked where the file does.
    pub shape: Option<(usize, usize)>,
    /// The coordinates, in the order wanted; of a grid of heights these are
    /// chosen among x, y and z. The usual ones of the format if `None`.
    pub columns: Option<Vec<ColumnChoice>>,
    /// The format; found from the file's ending and content if `None`.
    pub format: Option<GridFormatChoice>,
    /// The two columns of a file with one point per line that say the row and
    /// the column of the point: whole numbers counted from 0 or 1, or
    /// parameters u and v. Found by their names if `None`.
    pub index_columns: Option<(ColumnChoice, ColumnChoice)>,
    /// Whether the first row and the first column of a matrix hold abscissae;
    /// found from the corner cell if `None`.
    pub axes: Option<bool>,
    /// The separator of text; found from the content if `None`.
    pub delimiter: Option<Delimiter>,
    /// The decimal mark of text; found from the content if `None`.
    pub decimal: Option<DecimalMark>,
    /// Whether cells without a value become NaN, to be counted, rather than
    /// an error.
    pub keep_holes: bool,
}

impl GridOptions {
    /// The same wishes to the readers of points.
    pub(super) fn for_points(&self) -> ReadOptions {
        ReadOptions {
            columns: self.columns.clone(),
            delimiter: self.delimiter,
            decimal: self.decimal,
            ..ReadOptions::default()
        }
    }
}

/// A format to read a grid as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum GridFormatChoice {
    /// Text with one point per line.
    Lines,
    /// Text with one row of heights per line.
    Matrix,
    /// An ESRI ASCII grid of heights.
    EsriAscii,
    /// A NumPy array file.
    Npy,
}

impl FromStr for GridFormatChoice {
    type Err = UnknownChoice;

    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        Ok(match given.to_ascii_lowercase().as_str() {
            "lines" => GridFormatChoice::Lines,
            "matrix" => GridFormatChoice::Matrix,
            "esri" | "asc" => GridFormatChoice::EsriAscii,
            "npy" => GridFormatChoice::Npy,
            _ => {
                return Err(UnknownChoice {
                    given: given.to_owned(),
                    wanted: "a format of grids; the formats are lines, matrix, esri and npy",
                });
            }
        })
    }
}

/// Reads a shape such as `20x30`: the number of rows, then of points in each.
pub fn parse_shape(given: &str) -> Result<(usize, usize), UnknownChoice> {
    let count = |text: &str| text.trim().parse().ok().filter(|count| *count > 0);
    given
        .split_once(['x', 'X', ','])
        .and_then(|(rows, columns)| Some((count(rows)?, count(columns)?)))
        .ok_or(UnknownChoice {
            given: given.to_owned(),
            wanted: "a shape; give the number of rows and of columns, as in 20x30",
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_formats_and_shapes_are_understood_or_refused_with_the_choice() {
        assert_eq!("Matrix".parse(), Ok(GridFormatChoice::Matrix));
        let error = "gpx".parse::<GridFormatChoice>().unwrap_err().to_string();
        assert!(error.contains("lines, matrix, esri and npy"), "{error}");
        assert_eq!(parse_shape("13x100"), Ok((13, 100)));
        assert_eq!(parse_shape("13, 100"), Ok((13, 100)));
        for given in ["", "13", "13x", "0x4", "-1x4", "3x4x5", "99999999999999999999x1"] {
            assert!(parse_shape(given).is_err(), "{given}");
        }
    }
}
