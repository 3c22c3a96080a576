//! A text as rows of cells, once its separator is known.
//!
//! Text without quotation marks is split where it lies; text with them goes
//! through the `csv` crate (see `quoted`), except that blank-separated cells
//! in quotation marks are split here.

use std::ops::ControlFlow;

use memchr::memchr;

use super::error::ReadError;
use super::lines::{Kind, LineRules, Lines};
use super::options::Delimiter;
use super::quoted::Quoted;

/// The rows of a text.
pub(crate) struct Rows<'a> {
    pub(crate) separator: Delimiter,
    /// Whether cells may have been in quotation marks.
    pub(crate) may_be_quoted: bool,
    text: &'a str,
    rules: LineRules,
    quoted: Option<Quoted>,
}

/// What stood between the rows.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Skipped {
    /// Lines that were comments alone.
    pub(crate) comment_lines: usize,
    /// Comments after content.
    pub(crate) comments_after_rows: usize,
    /// Blank lines with rows before and after them.
    pub(crate) blank_lines_between: usize,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(
        text: &'a str,
        separator: Delimiter,
        source: &str,
    ) -> Result<Self, ReadError> {
        let rules = LineRules {
            semicolon_comments: separator != Delimiter::Semicolon,
            tabs_separate: separator == Delimiter::Tab,
            has_hash: memchr(b'#', text.as_bytes()).is_some(),
        };
        let may_be_quoted = memchr(b'"', text.as_bytes()).is_some();
        let quoted = match separator_byte(separator) {
            Some(byte) if may_be_quoted => Some(Quoted::new(text, byte, rules, source)?),
            _ => None,
        };
        Ok(Rows { separator, may_be_quoted, text, rules, quoted })
    }

    /// Calls `visitor` with the line number and the cells of each row, until
    /// it breaks off or fails.
    pub(crate) fn visit<E: From<ReadError>>(
        &self,
        mut visitor: impl FnMut(u32, Cells<'_>) -> Result<ControlFlow<()>, E>,
    ) -> Result<Skipped, E> {
        if let Some(quoted) = &self.quoted {
            return quoted.visit(visitor);
        }
        let separator = separator_byte(self.separator);
        let mut skipped = Skipped::default();
        let mut rows = 0_usize;
        let mut blanks = 0;
        for (number, line) in Lines::new(self.text) {
            match self.rules.kind(line) {
                Kind::Blank => blanks += 1,
                Kind::Comment => skipped.comment_lines += 1,
                Kind::Content { text, commented } => {
                    if rows > 0 {
                        skipped.blank_lines_between += blanks;
                    }
                    blanks = 0;
                    rows += 1;
                    skipped.comments_after_rows += usize::from(commented);
                    let cells = match separator {
                        Some(separator) => Cells::Separated { rest: Some(text), separator },
                        None => Cells::Blanks { rest: text, may_be_quoted: self.may_be_quoted },
                    };
                    if visitor(number, cells)?.is_break() {
                        break;
                    }
                }
            }
        }
        Ok(skipped)
    }
}

fn separator_byte(separator: Delimiter) -> Option<u8> {
    match separator {
        Delimiter::Comma => Some(b','),
        Delimiter::Semicolon => Some(b';'),
        Delimiter::Tab => Some(b'\t'),
        Delimiter::Blanks => None,
    }
}

/// The cells of one row, trimmed.
pub(crate) enum Cells<'r> {
    /// Cells between single bytes.
    Separated {
        /// What is not yet given out; `None` after the last cell.
        rest: Option<&'r str>,
        /// The byte between cells.
        separator: u8,
    },
    /// Cells between runs of blanks.
    Blanks {
        /// What is not yet given out.
        rest: &'r str,
        /// Whether a quotation mark may open a cell.
        may_be_quoted: bool,
    },
    /// Cells already taken apart.
    Record(csv::StringRecordIter<'r>),
}

impl<'r> Iterator for Cells<'r> {
    type Item = &'r str;

    #[inline]
    fn next(&mut self) -> Option<&'r str> {
        match self {
            Cells::Separated { rest, separator } => {
                let text = (*rest)?;
                let cell = match memchr(*separator, text.as_bytes()) {
                    Some(at) => {
                        *rest = Some(&text[at + 1..]);
                        &text[..at]
                    }
                    None => {
                        *rest = None;
                        text
                    }
                };
                Some(cell.trim_ascii())
            }
            Cells::Blanks { rest, may_be_quoted } => next_between_blanks(rest, *may_be_quoted),
            Cells::Record(cells) => cells.next().map(str::trim_ascii),
        }
    }
}

#[inline]
fn next_between_blanks<'r>(rest: &mut &'r str, may_be_quoted: bool) -> Option<&'r str> {
    let text = rest.trim_ascii_start();
    if text.is_empty() {
        *rest = "";
        return None;
    }
    if may_be_quoted
        && let Some(inner) = text.strip_prefix('"')
        && let Some(end) = memchr(b'"', inner.as_bytes())
    {
        *rest = &inner[end + 1..];
        return Some(inner[..end].trim_ascii());
    }
    let end = text.bytes().position(|b| b.is_ascii_whitespace()).unwrap_or(text.len());
    *rest = &text[end..];
    Some(&text[..end])
}

/// The cells of `line`, as found with `separator` and without regard to
/// quotation marks across lines.
pub(super) fn plain_cells(line: &str, separator: Delimiter) -> Cells<'_> {
    match separator_byte(separator) {
        Some(separator) => Cells::Separated { rest: Some(line), separator },
        None => Cells::Blanks { rest: line, may_be_quoted: true },
    }
}
