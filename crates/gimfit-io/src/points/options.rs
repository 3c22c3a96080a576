//! What a caller may ask of the readers.

use std::fmt;
use std::str::FromStr;

/// What to read and how; the default leaves every choice to the file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// The format; found from the file's ending and content if `None`.
    pub format: Option<FormatChoice>,
    /// The coordinate columns, in the order wanted; the usual columns of the
    /// format if `None`.
    pub columns: Option<Vec<ColumnChoice>>,
    /// The column to take as abscissa. It is left out of the coordinates
    /// unless `columns` names it too.
    pub abscissa: Option<ColumnChoice>,
    /// The separator of text; found from the content if `None`.
    pub delimiter: Option<Delimiter>,
    /// The decimal mark of text; found from the content if `None`.
    pub decimal: Option<DecimalMark>,
    /// Which piece to read of a file with several (segments of a GPX track).
    pub part: Option<PartChoice>,
    /// Whether rows without a value in a chosen column are left out, with a
    /// note, rather than refused: empty cells, NaN, NA, N/A and null.
    pub skip_missing: bool,
}

/// A name given for an option that stands for none of its values.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{given}\" is not {wanted}")]
pub struct UnknownChoice {
    /// What was given.
    pub given: String,
    /// What would have been understood.
    pub wanted: &'static str,
}

fn unknown(given: &str, wanted: &'static str) -> UnknownChoice {
    UnknownChoice { given: given.to_owned(), wanted }
}

/// A format to read a file as.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FormatChoice {
    /// Any text in rows; the separator is found from the content.
    Text,
    /// Text separated by commas or semicolons.
    Csv,
    /// Text separated by tabs.
    Tsv,
    /// Text whose first three columns are coordinates.
    Xyz,
    /// An airfoil file, in Selig or Lednicer order.
    Airfoil,
    /// A GPX track.
    Gpx,
    /// A NumPy array file.
    Npy,
}

impl FromStr for FormatChoice {
    type Err = UnknownChoice;

    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        Ok(match given.to_ascii_lowercase().as_str() {
            "text" | "txt" => FormatChoice::Text,
            "csv" => FormatChoice::Csv,
            "tsv" => FormatChoice::Tsv,
            "xyz" => FormatChoice::Xyz,
            "airfoil" => FormatChoice::Airfoil,
            "gpx" => FormatChoice::Gpx,
            "npy" => FormatChoice::Npy,
            _ => {
                return Err(unknown(
                    given,
                    "a format; the formats are text, csv, tsv, xyz, airfoil, gpx and npy",
                ));
            }
        })
    }
}

/// A column of the file.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum ColumnChoice {
    /// By its number in the file, from 1.
    Number(usize),
    /// By its name in the header; upper and lower case count as equal.
    Name(String),
}

impl FromStr for ColumnChoice {
    type Err = UnknownChoice;

    /// Digits alone are a number; anything else is a name.
    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        const WANTED: &str = "a column; give its name, or its number counted from 1";
        let name = given.trim();
        if name.is_empty() {
            return Err(unknown(given, WANTED));
        }
        if name.bytes().all(|b| b.is_ascii_digit()) {
            return match name.parse() {
                Ok(number) if number > 0 => Ok(ColumnChoice::Number(number)),
                _ => Err(unknown(given, WANTED)),
            };
        }
        Ok(ColumnChoice::Name(name.to_owned()))
    }
}

impl fmt::Display for ColumnChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ColumnChoice::Number(number) => write!(f, "{number}"),
            ColumnChoice::Name(name) => write!(f, "\"{name}\""),
        }
    }
}

/// What separates the cells of a line of text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Delimiter {
    /// A comma.
    Comma,
    /// A semicolon.
    Semicolon,
    /// A tab.
    Tab,
    /// A run of spaces and tabs.
    Blanks,
}

impl FromStr for Delimiter {
    type Err = UnknownChoice;

    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        Ok(match given.to_ascii_lowercase().as_str() {
            "," | "comma" => Delimiter::Comma,
            ";" | "semicolon" => Delimiter::Semicolon,
            "\t" | "\\t" | "tab" => Delimiter::Tab,
            " " | "blanks" | "blank" | "space" | "whitespace" => Delimiter::Blanks,
            _ => {
                return Err(unknown(
                    given,
                    "a separator; the separators are comma, semicolon, tab and blanks",
                ));
            }
        })
    }
}

impl fmt::Display for Delimiter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Delimiter::Comma => "commas",
            Delimiter::Semicolon => "semicolons",
            Delimiter::Tab => "tabs",
            Delimiter::Blanks => "blanks",
        })
    }
}

/// What stands between the whole and the fractional digits of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum DecimalMark {
    /// As in 3.14.
    Point,
    /// As in 3,14.
    Comma,
}

impl FromStr for DecimalMark {
    type Err = UnknownChoice;

    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        match given.to_ascii_lowercase().as_str() {
            "." | "point" => Ok(DecimalMark::Point),
            "," | "comma" => Ok(DecimalMark::Comma),
            _ => Err(unknown(given, "a decimal mark; the decimal marks are point and comma")),
        }
    }
}

/// Which piece of a file with several.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PartChoice {
    /// One piece, counted from 1.
    Number(usize),
    /// All pieces, joined in the order of the file.
    All,
}

impl FromStr for PartChoice {
    type Err = UnknownChoice;

    fn from_str(given: &str) -> Result<Self, UnknownChoice> {
        if given.eq_ignore_ascii_case("all") {
            return Ok(PartChoice::All);
        }
        match given.parse() {
            Ok(number) if number > 0 => Ok(PartChoice::Number(number)),
            _ => Err(unknown(given, "a part; give its number from 1, or all")),
        }
    }
}
