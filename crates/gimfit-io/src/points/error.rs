//! What can be wrong with a file, said in one sentence that names the place.

use std::fmt;

/// Why a file could not be read, and where.
///
/// Its `Display` is one sentence, such as `coast.csv, line 17, column 2
/// ("lat"): "n/a" is not a number; remove the row or choose other columns with
/// --columns`.
#[derive(Debug)]
pub struct ReadError(Box<Inner>);

#[derive(Debug)]
struct Inner {
    source: String,
    place: Place,
    column: Option<ColumnLabel>,
    problem: Problem,
}

/// Where in a file something stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// No one line: the file as a whole.
    File,
    /// A line, from 1.
    Line(u32),
    /// A row of a binary file, from 0.
    Point(usize),
}

/// A column of a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ColumnLabel {
    /// Its number, from 1.
    pub number: usize,
    /// Its name, where the file gives one.
    pub name: Option<String>,
}

impl ReadError {
    /// A problem with the file as a whole.
    pub(crate) fn file(source: &str, problem: Problem) -> Self {
        Self::at(source, Place::File, problem)
    }

    /// A problem with one line.
    pub(crate) fn line(source: &str, line: u32, problem: Problem) -> Self {
        Self::at(source, Place::Line(line), problem)
    }

    /// A problem at a place.
    pub(crate) fn at(source: &str, place: Place, problem: Problem) -> Self {
        ReadError(Box::new(Inner { source: source.to_owned(), place, column: None, problem }))
    }

    /// The same problem, in column `index` (from 0) of the columns `names`.
    pub(crate) fn in_column(mut self, index: usize, names: &[String]) -> Self {
        let number = index + 1;
        self.0.column = Some(ColumnLabel {
            number,
            name: names
                .get(index)
                .filter(|name| **name != column_name(index))
                .map(|name| shortened(name)),
        });
        self
    }

    /// The name of the file, or "standard input".
    pub fn source_name(&self) -> &str {
        &self.0.source
    }

    /// Where the problem stands.
    pub fn place(&self) -> Place {
        self.0.place
    }

    /// The column the problem stands in, where it is one cell's.
    pub fn column(&self) -> Option<&ColumnLabel> {
        self.0.column.as_ref()
    }

    /// What is wrong.
    pub fn problem(&self) -> &Problem {
        &self.0.problem
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.source)?;
        match self.0.place {
            Place::File => {}
            Place::Line(line) => write!(f, ", line {line}")?,
            Place::Point(row) => write!(f, ", point {row} (counted from 0)")?,
        }
        if let Some(column) = &self.0.column {
            write!(f, ", column {}", column.number)?;
            if let Some(name) = &column.name {
                write!(f, " (\"{name}\")")?;
            }
        }
        write!(f, ": {}", self.0.problem)
    }
}

// The sentence holds the cause already, so no `source` is given: a caller that
// prints the chain would say it twice.
impl std::error::Error for ReadError {}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// No file has this name.
    #[error("there is no such file; check the path")]
    NotFound,
    /// The operating system refused to read.
    #[error("the file cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// More bytes than any reader takes.
    #[error("the input is longer than {limit} bytes; thin it out first")]
    TooLong {
        /// The most bytes that are read.
        limit: u64,
    },
    /// Nothing at all in the file.
    #[error("the file is empty")]
    Empty,
    /// Nothing in the file is a point.
    #[error("the file holds no points: {0}")]
    NoRows(String),
    /// A line with more or fewer cells than the others.
    #[error("there {found}, but {set_by} has {expected}; {advice}")]
    Ragged {
        /// How many cells the line has, as "is 1 cell" or "are 4 cells".
        found: String,
        /// How many it should have.
        expected: usize,
        /// What set the number.
        set_by: String,
        /// What to do.
        advice: String,
    },
    /// A cell that is no number.
    #[error("\"{cell}\" is not a number; {advice}")]
    NotANumber {
        /// The cell.
        cell: String,
        /// What to do.
        advice: String,
    },
    /// A cell with nothing in it.
    #[error("the cell is empty; {advice}")]
    EmptyCell {
        /// What to do.
        advice: String,
    },
    /// An infinity or a NaN.
    #[error("{cell} is not a finite number; remove the row or give a value")]
    NotFinite {
        /// The cell, or the value.
        cell: String,
    },
    /// A number beyond the range of a double.
    #[error("{cell} is too large for a double-precision number (about 1.8e308 at most)")]
    TooLarge {
        /// The cell.
        cell: String,
    },
    /// A number that can be read in more than one way.
    #[error("\"{cell}\" can be read in more than one way: {why}")]
    Ambiguous {
        /// The cell.
        cell: String,
        /// The two readings and what to do.
        why: String,
    },
    /// A column asked for that the file does not have.
    #[error("there is no column {asked}; the columns are {there}")]
    UnknownColumn {
        /// What was asked for.
        asked: String,
        /// The columns of the file.
        there: String,
    },
    /// A choice of columns that cannot be followed.
    #[error("{0}")]
    Columns(String),
    /// A byte that is not UTF-8.
    #[error(
        "byte {byte} of the file (0x{value:02x}) is not UTF-8; save the file with UTF-8 encoding"
    )]
    NotUtf8 {
        /// Its position, from 1.
        byte: usize,
        /// The byte.
        value: u8,
    },
    /// Text in UTF-16.
    #[error("the text is encoded in UTF-16; save it as UTF-8")]
    Utf16,
    /// Bytes that are no text.
    #[error("the content is {0}, not text with points; export the points as CSV first")]
    Binary(&'static str),
    /// A quotation mark without its partner.
    #[error("the quotation mark opened here is never closed; close it or remove it")]
    UnclosedQuote,
    /// A file that breaks the rules of its format.
    #[error("{0}")]
    Malformed(String),
    /// A file of several pieces, and no choice among them.
    #[error("{0}")]
    Parts(String),
    /// A kind of array that is not read.
    #[error("{0}")]
    Array(String),
}

/// The name of column `index` (from 0) where the file names none.
pub(crate) fn column_name(index: usize) -> String {
    format!("column {}", index + 1)
}

/// A cell as it can stand in a message: control characters made visible, and
/// no longer than a line bears.
pub(crate) fn shortened(cell: &str) -> String {
    const MOST: usize = 40;
    let mut out = String::new();
    for (count, c) in cell.chars().enumerate() {
        if count == MOST {
            out.push_str("...");
            break;
        }
        if c.is_control() {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    out
}

/// Column names as a list for a message, cut where it grows too long.
pub(crate) fn list<S: AsRef<str>>(names: &[S]) -> String {
    const MOST: usize = 24;
    let mut out =
        names.iter().take(MOST).map(|name| shortened(name.as_ref())).collect::<Vec<_>>().join(", ");
    if names.len() > MOST {
        out.push_str(&format!(" and {} more", names.len() - MOST));
    }
    out
}

/// "1 cell", "2 cells".
pub(crate) fn counted(count: usize, noun: &str) -> String {
    match count {
        1 => format!("1 {noun}"),
        _ => format!("{count} {noun}s"),
    }
}
