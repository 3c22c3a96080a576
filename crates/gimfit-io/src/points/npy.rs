//! NumPy array files (`.npy`), versions 1 to 3.
//!
//! Read are arrays of real numbers (float of 4 or 8 bytes, signed and unsigned
//! integers of 1 to 8 bytes, both byte orders, C and Fortran order) with shape
//! (m,) or (m, d): m points of d coordinates, d = 1 for the first. Nothing is
//! lost but the exactness of integers beyond 2^53, which is noted. Refused are
//! other kinds and shapes, files shorter or longer than the header says, and
//! NaN and infinities in the chosen columns.

use super::columns::{MOST_COLUMNS, Offer, select};
use super::error::{Place, Problem, ReadError, column_name, list, shortened};
use super::npy_header::{self, Header};
use super::options::ReadOptions;
use super::table::{PointFormat, PointTable};

/// What every array file starts with.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";

/// Integers up to here are doubles exactly.
const EXACT: u64 = 1 << 53;

/// How many axes the array in `bytes` has, if it is one.
pub(crate) fn axes(bytes: &[u8]) -> Option<usize> {
    let axes = std::cell::Cell::new(None);
    // Its shape is all that is asked for.
    let _ = open_as(bytes, |header| {
        axes.set(Some(header.shape.len()));
        Err(String::new())
    });
    axes.get()
}

/// Reads the array in `bytes`.
pub(super) fn read(
    bytes: &[u8],
    source: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let array = open(bytes).map_err(|text| ReadError::file(source, Problem::Array(text)))?;
    let names: Vec<String> = (0..array.columns).map(column_name).collect();
    let offer = Offer {
        names: &names,
        named: false,
        usual: (0..array.columns).collect(),
        why: "all columns but the abscissa",
    };
    let selection = select(offer, options, source, &mut notes)?;
    if array.columns > array.rows {
        notes.push(format!(
            "The array has {} rows and {} columns, and each row is one point; if each column is \
             one, save the transpose (a.T).",
            array.rows, array.columns
        ));
    }
    let mut inexact = 0_usize;
    let (coordinates, abscissa) = selection.gather(array.rows, |row, column| {
        let (value, exact) = array.value(row, column);
        inexact += usize::from(!exact);
        if value.is_finite() || (options.skip_missing && value.is_nan()) {
            return Ok(value);
        }
        let cell = value.to_string();
        let error = ReadError::at(source, Place::Point(row), Problem::NotFinite { cell });
        Err(error.in_column(column, &names))
    })?;
    if inexact > 0 {
        notes.push(format!(
            "{inexact} of the integers are beyond 2^53 and were rounded to the nearest double."
        ));
    }
    Ok(PointTable {
        source: source.to_owned(),
        format: PointFormat::Npy,
        title: None,
        column_names: selection.coordinate_names(&names),
        coordinates,
        row_lines: None,
        row_positions: None,
        rows_left_out: 0,
        notes,
        abscissa,
        abscissa_name: selection.abscissa_name(&names),
    })
}

/// Reads a one-dimensional array as a list of numbers.
pub(super) fn read_list(bytes: &[u8], source: &str) -> Result<Vec<f64>, ReadError> {
    let refuse = |text| ReadError::file(source, Problem::Array(text));
    let array = open(bytes).map_err(refuse)?;
    if array.shape.len() != 1 {
        return Err(refuse(format!(
            "the array has shape ({}, {}), but a list of numbers has one axis; save a.ravel()",
            array.rows, array.columns
        )));
    }
    (0..array.rows)
        .map(|row| match array.value(row, 0).0 {
            value if value.is_finite() => Ok(value),
            value => {
                let cell = value.to_string();
                Err(ReadError::at(source, Place::Point(row), Problem::NotFinite { cell }))
            }
        })
        .collect()
}

/// An array whose bytes are all there.
pub(crate) struct Array<'a> {
    data: &'a [u8],
    kind: Kind,
    rows: usize,
    columns: usize,
    /// The lengths along each axis.
    pub(crate) shape: Vec<u64>,
    pub(crate) fortran_order: bool,
}

/// The number kind: 'f', 'i' or 'u', bytes of each, and their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kind {
    letter: u8,
    size: usize,
    big_endian: bool,
}

/// Checks the header against the file, so that nothing is allocated for
/// numbers that are not there.
fn open(bytes: &[u8]) -> Result<Array<'_>, String> {
    open_as(bytes, shape)
}

/// As [`open`], the array taken as the rows and columns that `shape` says.
pub(crate) fn open_as(
    bytes: &[u8],
    shape: impl Fn(&Header) -> Result<(u64, u64), String>,
) -> Result<Array<'_>, String> {
    let short = || "the file ends within the header of the array; save it again".to_owned();
    let rest = bytes
        .strip_prefix(MAGIC)
        .ok_or("the file does not start as a NumPy array file does; save it with numpy.save")?;
    let [major, _minor, rest @ ..] = rest else {
        return Err(short());
    };
    let (length, rest) = match (major, rest) {
        (1, [a, b, rest @ ..]) => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        (2 | 3, [a, b, c, d, rest @ ..]) => {
            let length = u32::from_le_bytes([*a, *b, *c, *d]);
            (usize::try_from(length).map_err(|_| short())?, rest)
        }
        (1..=3, _) => return Err(short()),
        _ => {
            return Err(format!(
                "version {major} of the array format is not known; versions 1 to 3 are read"
            ));
        }
    };
    let (header, data) = rest.split_at_checked(length).ok_or_else(short)?;
    let header = std::str::from_utf8(header)
        .map_err(|_| "the header of the array is not UTF-8; save it again with numpy.save")?;
    let header = npy_header::parse(header)?;
    let kind = kind(&header.descr)?;
    let (rows, columns) = shape(&header)?;
    let wanted = (rows as u128) * (columns as u128) * (kind.size as u128);
    if wanted != data.len() as u128 {
        return Err(format!(
            "the array of shape ({}) and dtype {} takes {wanted} bytes, but {} follow the header; \
             save it again, alone in its file",
            shape_text(&header),
            shortened(&header.descr),
            data.len()
        ));
    }
    let (Ok(rows), Ok(columns)) = (usize::try_from(rows), usize::try_from(columns)) else {
        return Err("the array is larger than the memory of this machine".to_owned());
    };
    if rows == 0 {
        return Err("the array holds no points; its shape is (0, ...)".to_owned());
    }
    Ok(Array {
        data,
        kind,
        rows,
        columns,
        shape: header.shape,
        fortran_order: header.fortran_order,
    })
}

fn shape(header: &Header) -> Result<(u64, u64), String> {
    match header.shape.as_slice() {
        [rows] => Ok((*rows, 1)),
        [_, 0] => Err("the array has no columns; save it with shape (m, d)".to_owned()),
        [_, columns] if *columns > MOST_COLUMNS as u64 => Err(format!(
            "the array has {columns} columns, more than the {MOST_COLUMNS} that are read; save it \
             with one point per row"
        )),
        [rows, columns] => Ok((*rows, *columns)),
        _ => Err(format!(
            "the array has shape ({}); save it with shape (m,) or (m, d), one point per row, such \
             as a.reshape(-1, 3)",
            shape_text(header)
        )),
    }
}

/// The shape as Python writes it, without the brackets.
pub(crate) fn shape_text(header: &Header) -> String {
    let lengths: Vec<String> = header.shape.iter().map(u64::to_string).collect();
    match lengths.as_slice() {
        [one] => format!("{one},"),
        several => list(several),
    }
}

fn kind(descr: &str) -> Result<Kind, String> {
    let refuse = || {
        Err(format!(
            "the array has dtype {}; save it as real numbers with a.astype('<f8')",
            shortened(descr)
        ))
    };
    let [order, letter, size @ ..] = descr.as_bytes() else {
        return refuse();
    };
    let size = match (letter, size) {
        (b'f', b"4") | (b'i' | b'u', b"4") => 4,
        (b'f', b"8") | (b'i' | b'u', b"8") => 8,
        (b'i' | b'u', b"1") => 1,
        (b'i' | b'u', b"2") => 2,
        _ => return refuse(),
    };
    let big_endian = match order {
        b'<' => false,
        b'>' => true,
        b'=' => cfg!(target_endian = "big"),
        b'|' if size == 1 => false,
        _ => return refuse(),
    };
    Ok(Kind { letter: *letter, size, big_endian })
}

impl Array<'_> {
    /// The number in a row and a column, and whether it is exact.
    pub(crate) fn value(&self, row: usize, column: usize) -> (f64, bool) {
        let index = match self.fortran_order {
            true => column * self.rows + row,
            false => row * self.columns + column,
        };
        let Kind { letter, size, big_endian } = self.kind;
        let Some(bytes) = self.data.get(index * size..(index + 1) * size) else {
            return (f64::NAN, true);
        };
        let mut bits: u64 = 0;
        for at in 0..size {
            let byte = bytes[if big_endian { at } else { size - 1 - at }];
            bits = (bits << 8) | u64::from(byte);
        }
        match (letter, size) {
            (b'f', 4) => (f64::from(f32::from_bits(bits as u32)), true),
            (b'f', _) => (f64::from_bits(bits), true),
            (b'u', _) => (bits as f64, bits <= EXACT),
            _ => {
                // Moves the sign to the top and back, which copies it down.
                let unused = 64 - 8 * size as u32;
                let signed = (bits << unused) as i64 >> unused;
                (signed as f64, signed.unsigned_abs() <= EXACT)
            }
        }
    }
}

#[cfg(test)]
#[path = "test_npy.rs"]
mod tests;
