//! Heights over two axes, and cells that hold none.

use super::options::GridOptions;
use crate::points::columns::{Offer, select};
use crate::points::error::shortened;
use crate::points::number::{Fault, parse, says_missing, vanished};
use crate::points::{DecimalMark, Problem, ReadError};

/// A grid of heights: z in C order, one row for each y.
pub(super) struct Heights {
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
    pub(super) z: Vec<f64>,
}

impl Heights {
    /// The names and the coordinates of the points (x, y, z), or of those
    /// among x, y and z that are asked for.
    pub(super) fn points(
        &self,
        options: &GridOptions,
        source: &str,
    ) -> Result<(Vec<String>, Vec<f64>), ReadError> {
        let names = ["x", "y", "z"].map(str::to_owned);
        let offer = Offer { names: &names, named: true, usual: vec![0, 1, 2], why: "" };
        let selection = select(offer, &options.for_points(), source, &mut Vec::new())?;
        let wanted = selection.coordinates.as_slice();
        let mut out = Vec::with_capacity(self.z.len().saturating_mul(wanted.len()));
        if !self.x.is_empty() {
            for (y, row) in self.y.iter().zip(self.z.chunks_exact(self.x.len())) {
                for (x, z) in self.x.iter().zip(row) {
                    let point = [*x, *y, *z];
                    out.extend(wanted.iter().map(|at| point[*at]));
                }
            }
        }
        Ok((selection.coordinate_names(&names), out))
    }
}

/// The numbers 0, 1 and so on.
pub(super) fn indices(count: usize) -> Vec<f64> {
    (0..count).map(|at| at as f64).collect()
}

/// Where a cell stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct CellPlace {
    /// The line of the file, from 1.
    pub(super) line: u32,
    /// The cell of that line, from 0.
    pub(super) cell: usize,
    /// The row of the grid, from 0.
    pub(super) row: usize,
    /// The column of the grid, from 0.
    pub(super) column: usize,
}

/// What was met while the cells were read.
#[derive(Debug, Default)]
pub(super) struct Tally {
    holes: usize,
    /// The first of them, as many as a message names.
    named: Vec<CellPlace>,
    vanished: usize,
}

impl Tally {
    /// The height in a cell; NaN, counted as a hole, where there is none.
    #[inline]
    pub(super) fn height(
        &mut self,
        cell: &str,
        mark: DecimalMark,
        no_data: Option<f64>,
        place: impl Fn() -> CellPlace,
    ) -> Result<f64, Fault> {
        match parse(cell, mark) {
            Ok(value) => {
                if value == 0.0 && vanished(cell) {
                    self.vanished += 1;
                }
                if no_data == Some(value) {
                    return Ok(self.hole(place()));
                }
                Ok(value)
            }
            Err(Fault::Empty) => Ok(self.hole(place())),
            Err(Fault::NotFinite) if is_nan(cell) => Ok(self.hole(place())),
            Err(Fault::NotANumber) if says_missing(cell) => Ok(self.hole(place())),
            Err(fault) => Err(fault),
        }
    }

    fn hole(&mut self, place: CellPlace) -> f64 {
        self.holes += 1;
        if self.named.len() < MOST_NAMED {
            self.named.push(place);
        }
        f64::NAN
    }

    /// How many numbers were too small for a double.
    pub(super) fn vanished(&self) -> usize {
        self.vanished
    }

    /// Fails if one of `cells` cells held no height.
    pub(super) fn refuse_holes(&self, cells: usize, source: &str) -> Result<(), ReadError> {
        if let Some(CellPlace { line, cell, .. }) = self.named.first() {
            let name =
                |place: &CellPlace| format!("row {}, column {}", place.row + 1, place.column + 1);
            let names: Vec<String> = self.named.iter().map(name).collect();
            let problem = Problem::Malformed(holes(self.holes, cells, &names));
            return Err(ReadError::line(source, *line, problem).in_column(*cell, &[]));
        }
        Ok(())
    }
}

/// Most cells that a message names.
pub(super) const MOST_NAMED: usize = 10;

/// The first names of so many, and how many more there are.
pub(super) fn list(names: &[String], count: usize) -> String {
    let more = count - names.len();
    let rest = if more > 0 { format!("; and {more} more") } else { String::new() };
    names.join("; ") + &rest
}

/// The sentence about cells without a value; `names` names the first.
pub(super) fn holes(holes: usize, cells: usize, names: &[String]) -> String {
    let verb = if holes == 1 { "holds" } else { "hold" };
    format!(
        "{holes} of {cells} cells {verb} no data ({}); holes cannot be fitted yet: fill them in or cut \
         out a part without them",
        list(names, holes)
    )
}

fn is_nan(cell: &str) -> bool {
    cell.trim_start_matches(['+', '-']).eq_ignore_ascii_case("nan")
}

/// What is wrong with a cell that holds no number.
#[cold]
pub(super) fn cell_problem(cell: &str, fault: Fault) -> Problem {
    let advice = "a grid needs a number in every cell".to_owned();
    let cell = shortened(cell);
    match fault {
        Fault::Empty => Problem::EmptyCell { advice },
        Fault::NotANumber if cell.contains(',') => Problem::NotANumber {
            cell,
            advice: "if its comma is the decimal mark, say so with --decimal comma".to_owned(),
        },
        Fault::NotANumber => Problem::NotANumber { cell, advice },
        Fault::NotFinite => Problem::Malformed(format!("{cell} is not a finite number; {advice}")),
        Fault::TooLarge => Problem::TooLarge { cell },
        Fault::Marks => Problem::Ambiguous {
            cell,
            why: "it holds more than one decimal mark; write it with one".to_owned(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_run_along_the_rows_and_the_coordinates_follow_the_choice() {
        let heights = Heights { x: vec![0.0, 1.0], y: vec![5.0], z: vec![7.0, 8.0] };
        let (names, points) = heights.points(&GridOptions::default(), "f").unwrap();
        assert_eq!(names, ["x", "y", "z"]);
        assert_eq!(points, [0.0, 5.0, 7.0, 1.0, 5.0, 8.0]);
        let options =
            GridOptions { columns: Some(vec!["Z".parse().unwrap()]), ..GridOptions::default() };
        assert_eq!(heights.points(&options, "f").unwrap().1, [7.0, 8.0]);
    }

    #[test]
    fn every_spelling_of_nothing_is_a_hole_and_infinity_is_not() {
        let mut tally = Tally::default();
        let mut row = 1;
        let mut read = |cell: &str| {
            row += 1;
            let place = || CellPlace { line: 3, cell: 1, row, column: 1 };
            tally.height(cell, DecimalMark::Point, Some(-9999.0), place)
        };
        for cell in ["", "NaN", "-nan", "NA", "-", "-9999.0"] {
            assert!(read(cell).unwrap().is_nan(), "{cell}");
        }
        assert_eq!(read("inf"), Err(Fault::NotFinite));
        assert_eq!(read("4"), Ok(4.0));
        let error = tally.refuse_holes(10, "f").unwrap_err().to_string();
        assert!(
            error.starts_with(
                "f, line 3, column 2: 6 of 10 cells hold no data (row 3, column 2; row 4, column 2; \
                 row 5, column 2; row 6, column 2; row 7, column 2; row 8, column 2);"
            ),
            "{error}"
        );
    }
}
