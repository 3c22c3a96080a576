//! The header of an ESRI ASCII grid: lines of a word and a number.

use std::ops::ControlFlow;

use super::heights::cell_problem;
use crate::points::error::shortened;
use crate::points::number::{Fault, looks_numeric, parse};
use crate::points::rows::Rows;
use crate::points::{DecimalMark, Delimiter, Problem, ReadError};

/// The words, in lower case, and what they give.
const WORDS: [(&str, Entry); 12] = [
    ("ncols", Entry::Columns),
    ("nrows", Entry::Rows),
    ("xllcorner", Entry::XCorner),
    ("xllcenter", Entry::XCenter),
    ("yllcorner", Entry::YCorner),
    ("yllcenter", Entry::YCenter),
    ("cellsize", Entry::CellSize),
    ("dx", Entry::Dx),
    ("dy", Entry::Dy),
    ("nodata_value", Entry::NoData),
    ("nodata", Entry::NoData),
    ("no_data_value", Entry::NoData),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Entry {
    Columns,
    Rows,
    XCorner,
    XCenter,
    YCorner,
    YCenter,
    CellSize,
    Dx,
    Dy,
    NoData,
}

/// What the header says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Header {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The centre of the cell in the south-west.
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) dx: f64,
    pub(super) dy: f64,
    /// The height that stands for none; `None` where the header gives none, or
    /// NaN, which is a hole in any case.
    pub(super) no_data: Option<f64>,
    /// The line of the first heights, from 1.
    pub(super) first_line: u32,
}

/// Whether `text` opens as such a grid does.
pub(super) fn opens(text: &str) -> bool {
    let mut found = false;
    if let Ok(rows) = Rows::new(text, Delimiter::Blanks, "") {
        // Nothing here fails.
        let _ = rows.visit(|_, mut cells| {
            let word = cells.next().and_then(entry);
            found = word.is_some()
                && word != Some(Entry::Dx)
                && word != Some(Entry::Dy)
                && cells.next().is_some_and(looks_numeric)
                && cells.next().is_none();
            Ok::<_, ReadError>(ControlFlow::Break(()))
        });
    }
    found
}

fn entry(word: &str) -> Option<Entry> {
    WORDS.iter().find(|(name, _)| word.eq_ignore_ascii_case(name)).map(|(_, entry)| *entry)
}

/// Reads the header at the start of `rows`.
pub(super) fn read(rows: &Rows<'_>, mark: DecimalMark, source: &str) -> Result<Header, ReadError> {
    let mut found: Vec<(Entry, u32, f64)> = Vec::new();
    let mut first_line = None;
    rows.visit(|line, mut cells| {
        let fail = |text| Err(ReadError::line(source, line, Problem::Malformed(text)));
        let word = cells.next().unwrap_or("");
        let Some(entry) = entry(word) else {
            if looks_numeric(word) || word.eq_ignore_ascii_case("nan") {
                first_line = Some(line);
                return Ok(ControlFlow::Break(()));
            }
            return fail(format!(
                "\"{}\" is no word of the header of an ESRI ASCII grid; the words are ncols, \
                 nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize (or dx and dy) \
                 and NODATA_value",
                shortened(word)
            ));
        };
        let (Some(number), None) = (cells.next(), cells.next()) else {
            return fail(format!("{word} takes one number"));
        };
        let value = match parse(number, mark) {
            Ok(value) => value,
            Err(Fault::NotFinite) if entry == Entry::NoData => f64::NAN,
            Err(fault) => {
                let problem = cell_problem(number, fault);
                return Err(ReadError::line(source, line, problem).in_column(1, &[]));
            }
        };
        if let Some((_, before, _)) = found.iter().find(|(there, ..)| *there == entry) {
            return fail(format!("{word} stands on line {before} already; remove one of the two"));
        }
        found.push((entry, line, value));
        Ok(ControlFlow::Continue(()))
    })?;
    let Some(first_line) = first_line else {
        let problem = Problem::NoRows("no heights follow the header".to_owned());
        return Err(ReadError::file(source, problem));
    };
    Entries { found, source }.header(first_line)
}

struct Entries<'s> {
    found: Vec<(Entry, u32, f64)>,
    source: &'s str,
}

impl Entries<'_> {
    fn get(&self, wanted: Entry) -> Option<(u32, f64)> {
        self.found.iter().find(|(entry, ..)| *entry == wanted).map(|(_, line, v)| (*line, *v))
    }

    fn lacks(&self, what: &str) -> ReadError {
        let problem = Problem::Malformed(format!("the header lacks {what}; add it"));
        ReadError::file(self.source, problem)
    }

    fn fail<T>(&self, line: u32, text: String) -> Result<T, ReadError> {
        Err(ReadError::line(self.source, line, Problem::Malformed(text)))
    }

    fn count(&self, entry: Entry, name: &str) -> Result<usize, ReadError> {
        const MOST: f64 = (1_u64 << 53) as f64;
        let (line, value) = self.get(entry).ok_or_else(|| self.lacks(name))?;
        if value.fract() != 0.0 || !(1.0..=MOST).contains(&value) {
            return self.fail(line, format!("{name} is no whole number from 1"));
        }
        Ok(value as usize)
    }

    fn step(&self, entry: Entry, name: &str) -> Result<f64, ReadError> {
        let (line, value) = match (self.get(entry), self.get(Entry::CellSize)) {
            (Some(found), _) | (None, Some(found)) => found,
            (None, None) => return Err(self.lacks(&format!("cellsize or {name}"))),
        };
        if value <= 0.0 {
            return self.fail(line, "the size of a cell is not above 0".to_owned());
        }
        Ok(value)
    }

    /// The centre of the first cell.
    fn centre(
        &self,
        corner: Entry,
        centre: Entry,
        step: f64,
        name: &str,
    ) -> Result<f64, ReadError> {
        match (self.get(corner), self.get(centre)) {
            (Some((_, corner)), None) => Ok(corner + step / 2.0),
            (None, Some((_, centre))) => Ok(centre),
            (Some(_), Some((line, _))) => {
                self.fail(line, format!("the header gives both {name}corner and {name}center"))
            }
            (None, None) => Err(self.lacks(&format!("{name}corner or {name}center"))),
        }
    }

    fn header(&self, first_line: u32) -> Result<Header, ReadError> {
        let columns = self.count(Entry::Columns, "ncols")?;
        let rows = self.count(Entry::Rows, "nrows")?;
        let dx = self.step(Entry::Dx, "dx")?;
        let dy = self.step(Entry::Dy, "dy")?;
        let x = self.centre(Entry::XCorner, Entry::XCenter, dx, "xll")?;
        let y = self.centre(Entry::YCorner, Entry::YCenter, dy, "yll")?;
        let far = [x, y, x + dx * columns as f64, y + dy * rows as f64];
        if far.iter().any(|v| !v.is_finite()) {
            let text = "the grid reaches beyond the range of a double-precision number".to_owned();
            return Err(ReadError::file(self.source, Problem::Malformed(text)));
        }
        let no_data = self.get(Entry::NoData).map(|(_, v)| v).filter(|v| !v.is_nan());
        Ok(Header { columns, rows, x, y, dx, dy, no_data, first_line })
    }
}
