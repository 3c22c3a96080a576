//! NumPy array files of shape (m, n), heights, and (m, n, d), points.
//!
//! The bytes are read as the reader of points reads them. An array of shape
//! (k, d) is k points where the shape asked for has k points. Refused are
//! other shapes, NaN and infinities, and an array (m, n) with n up to 3 that
//! could as well be a list of points.

use super::grid::{GridFormat, GridLines, PointGrid};
use super::heights::{Heights, MOST_NAMED, holes, indices};
use super::options::GridOptions;
use crate::points::columns::{MOST_COLUMNS, Offer, select};
use crate::points::error::column_name;
use crate::points::npy::{Array, open_as, shape_text};
use crate::points::npy_header::Header;
use crate::points::{Problem, ReadError};

/// The most coordinates of a point that a row of two axes is taken for.
const MOST_COORDINATES: u64 = 3;

/// What the array holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Content {
    /// One height for each point.
    Heights,
    /// The coordinates of the points, along a third axis.
    Points,
    /// The coordinates of the points, one after the other.
    List,
}

struct Shape {
    rows: u64,
    columns: u64,
    dimension: u64,
    content: Content,
}

/// Reads the array in `bytes`.
pub(super) fn read(
    bytes: &[u8],
    source: &str,
    options: &GridOptions,
    mut notes: Vec<String>,
) -> Result<PointGrid, ReadError> {
    let refuse = |text| ReadError::file(source, Problem::Array(text));
    let asked = options.shape;
    let array = open_as(bytes, |header| {
        let shape = shape(header, asked)?;
        let points = shape.rows.checked_mul(shape.columns);
        Ok((points.ok_or("the array is larger than any memory")?, shape.dimension))
    })
    .map_err(refuse)?;
    let header = Header {
        descr: String::new(),
        fortran_order: array.fortran_order,
        shape: array.shape.clone(),
    };
    let Shape { rows, columns, dimension, content } = shape(&header, asked).map_err(refuse)?;
    // The bytes are all there, so the lengths fit.
    let (rows, columns, dimension) = (rows as usize, columns as usize, dimension as usize);
    if let Some((m, n)) = asked.filter(|asked| *asked != (rows, columns)) {
        return Err(refuse(format!(
            "the shape {m}x{n} is asked for, but the array has shape ({})",
            shape_text(&header)
        )));
    }
    let mut values = Values { array: &array, rows, columns, content, inexact: 0 };
    let (column_names, coordinates) = if content == Content::Heights {
        values.check(&[0], options.keep_holes).map_err(refuse)?;
        let z = (0..rows * columns).map(|at| values.at(at, 0)).collect();
        notes.push(
            "The points are (x, y, z): x is the second index of the array, y the first, both from \
             0, and z the number there."
                .to_owned(),
        );
        Heights { x: indices(columns), y: indices(rows), z }.points(options, source)?
    } else {
        let names: Vec<String> = (0..dimension).map(column_name).collect();
        let usual = (0..dimension).collect();
        let offer = Offer { names: &names, named: false, usual, why: "" };
        let selection = select(offer, &options.for_points(), source, &mut notes)?;
        values.check(&selection.coordinates, options.keep_holes).map_err(refuse)?;
        if content == Content::List {
            notes.push(format!(
                "The points are taken row by row, as {rows} rows of {columns} points each."
            ));
        }
        let gathered =
            selection.gather(rows * columns, |at, k| Ok::<_, ReadError>(values.at(at, k)))?;
        (selection.coordinate_names(&names), gathered.0)
    };
    if values.inexact > 0 {
        notes.push(format!(
            "{} of the integers are beyond 2^53 and were rounded to the nearest double.",
            values.inexact
        ));
    }
    Ok(PointGrid {
        source: source.to_owned(),
        format: GridFormat::Npy,
        title: None,
        rows,
        columns,
        column_names,
        coordinates,
        notes,
        row_abscissae: None,
        column_abscissae: None,
        lines: GridLines::Binary,
    })
}

fn shape(header: &Header, asked: Option<(usize, usize)>) -> Result<Shape, String> {
    let refuse = |why: &str| {
        Err(format!(
            "the array has shape ({}){why}; save heights with shape (m, n) or points with shape \
             (m, n, d), such as a.reshape(m, n, -1)",
            shape_text(header)
        ))
    };
    let asked = asked.map(|(m, n)| (m as u64, n as u64));
    match header.shape.as_slice() {
        lengths if lengths.contains(&0) => refuse(" and holds no points"),
        [_, _, d] if *d > MOST_COLUMNS as u64 => {
            refuse(&format!(" and more than {MOST_COLUMNS} coordinates"))
        }
        [m, n, d] => Ok(Shape { rows: *m, columns: *n, dimension: *d, content: Content::Points }),
        [m, n] if asked == Some((*m, *n)) => {
            Ok(Shape { rows: *m, columns: *n, dimension: 1, content: Content::Heights })
        }
        [k, d] => match asked {
            Some((m, n)) if m.checked_mul(n) == Some(*k) && *d <= MOST_COLUMNS as u64 => {
                Ok(Shape { rows: m, columns: n, dimension: *d, content: Content::List })
            }
            None if *d <= MOST_COORDINATES && k > d => refuse(&format!(
                ", which can be points or rows of heights; give the shape of the grid with \
                 --shape (--shape {k}x{d} means heights)"
            )),
            _ => Ok(Shape { rows: *k, columns: *d, dimension: 1, content: Content::Heights }),
        },
        _ => refuse(""),
    }
}

/// The numbers of the array by the index of their point in C order.
struct Values<'a> {
    array: &'a Array<'a>,
    rows: usize,
    columns: usize,
    content: Content,
    inexact: usize,
}

impl Values<'_> {
    fn at(&mut self, point: usize, coordinate: usize) -> f64 {
        // The reader takes points in the order of the file.
        let point = match self.array.fortran_order && self.content != Content::List {
            true => point / self.columns + self.rows * (point % self.columns),
            false => point,
        };
        let (value, exact) = self.array.value(point, coordinate);
        self.inexact += usize::from(!exact);
        value
    }

    /// Fails if a value of the coordinates `wanted` is not finite; holes may be kept.
    fn check(&mut self, wanted: &[usize], keep_holes: bool) -> Result<(), String> {
        let mut missing = 0;
        let mut names = Vec::new();
        for at in 0..self.rows * self.columns {
            let mut hole = false;
            for k in wanted {
                let value = self.at(at, *k);
                if value.is_finite() {
                    continue;
                }
                let (i, j) = (at / self.columns, at % self.columns);
                let place = match self.content {
                    Content::Heights => format!("[{i}, {j}]"),
                    Content::Points => format!("[{i}, {j}, {k}]"),
                    Content::List => format!("[{at}, {k}]"),
                };
                if value.is_infinite() {
                    return Err(format!("the value at {place} is {value}, not a finite number"));
                }
                if !hole && names.len() < MOST_NAMED {
                    names.push(place);
                }
                hole = true;
            }
            missing += usize::from(hole);
        }
        self.inexact = 0;
        match missing {
            0 => Ok(()),
            _ if keep_holes => Ok(()),
            _ => Err(holes(missing, self.rows * self.columns, &names)),
        }
    }
}

#[cfg(test)]
#[path = "test_npy.rs"]
mod tests;
