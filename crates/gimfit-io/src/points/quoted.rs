//! Rows with cells in quotation marks, through the `csv` crate.
//!
//! The crate knows one comment mark and counts only some line ends, so the text
//! is first copied with comments and blank lines emptied and every line end
//! made LF; line numbers stay those of the file. Whether a line lies inside a
//! quoted cell follows from the number of quotation marks before it.

use std::ops::ControlFlow;

use memchr::{memchr_iter, memchr2};

use super::error::{Problem, ReadError};
use super::lines::{Kind, LineRules, Lines};
use super::rows::{Cells, Skipped};

/// A text prepared for the `csv` crate.
pub(super) struct Quoted {
    text: String,
    separator: u8,
    skipped: Skipped,
    source: String,
}

impl Quoted {
    pub(super) fn new(
        text: &str,
        separator: u8,
        rules: LineRules,
        source: &str,
    ) -> Result<Self, ReadError> {
        let mut copy =
            Copy { text: String::with_capacity(text.len() + 1), separator, opened: None, source };
        let mut skipped = Skipped::default();
        let mut rows = 0_usize;
        let mut blanks = 0;
        for (number, line) in Lines::new(text) {
            if copy.opened.is_some() {
                copy.content(line, number)?;
            } else {
                match rules.kind(line) {
                    Kind::Blank => blanks += 1,
                    Kind::Comment => skipped.comment_lines += 1,
                    Kind::Content { text, commented } => {
                        if rows > 0 {
                            skipped.blank_lines_between += blanks;
                        }
                        blanks = 0;
                        rows += 1;
                        skipped.comments_after_rows += usize::from(commented);
                        copy.content(text, number)?;
                    }
                }
            }
            copy.text.push('\n');
        }
        if let Some(opened) = copy.opened {
            return Err(ReadError::line(source, opened.line, Problem::UnclosedQuote));
        }
        Ok(Quoted { text: copy.text, separator, skipped, source: source.to_owned() })
    }

    /// As `Rows::visit`.
    pub(super) fn visit<E: From<ReadError>>(
        &self,
        mut visitor: impl FnMut(u32, Cells<'_>) -> Result<ControlFlow<()>, E>,
    ) -> Result<Skipped, E> {
        let bytes = self.text.as_bytes();
        let mut reader = csv::ReaderBuilder::new()
            .delimiter(self.separator)
            .has_headers(false)
            .flexible(true)
            .from_reader(bytes);
        let mut record = csv::StringRecord::new();
        let mut line: u32 = 1;
        let mut start = 0;
        loop {
            match reader.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => {
                    let problem = Problem::Malformed(format!("the cells cannot be read: {error}"));
                    return Err(ReadError::line(&self.source, line, problem).into());
                }
            }
            // The crate counts the empty lines before a record as its own.
            while bytes.get(start) == Some(&b'\n') {
                start += 1;
                line = line.saturating_add(1);
            }
            if visitor(line, Cells::Record(record.iter()))?.is_break() {
                break;
            }
            let end = usize::try_from(reader.position().byte())
                .unwrap_or(bytes.len())
                .clamp(start, bytes.len());
            let ends = memchr_iter(b'\n', &bytes[start..end]).count();
            line = line.saturating_add(u32::try_from(ends).unwrap_or(u32::MAX));
            start = end;
        }
        Ok(self.skipped)
    }
}

/// The copy while it is made.
struct Copy<'s> {
    text: String,
    separator: u8,
    opened: Option<Opened>,
    source: &'s str,
}

/// A quotation mark not yet closed.
#[derive(Clone, Copy)]
struct Opened {
    line: u32,
    /// Whether it stands first in its cell and so quotes the cell.
    first: bool,
}

impl Copy<'_> {
    /// Appends one line, without the blanks between a separator and a
    /// quotation mark: with them the crate would take the mark as part of the
    /// cell.
    fn content(&mut self, line: &str, number: u32) -> Result<(), ReadError> {
        let mut rest = line;
        let mut cell_starts = self.opened.is_none();
        while let Some(at) = memchr2(b'"', self.separator, rest.as_bytes()) {
            let (before, after) = rest.split_at(at + 1);
            self.text.push_str(before);
            rest = after;
            if before.ends_with('"') {
                self.opened = match self.opened {
                    None => Some(Opened { line: number, first: cell_starts && at == 0 }),
                    Some(opened) => {
                        self.check_closed(opened, rest, number)?;
                        None
                    }
                };
                cell_starts = false;
            } else if self.opened.is_none() {
                cell_starts = true;
                let unpadded = rest.trim_start_matches(' ');
                if unpadded.starts_with('"') {
                    rest = unpadded;
                }
            }
        }
        self.text.push_str(rest);
        Ok(())
    }

    /// The crate would join what follows a quoted cell to it: `"1"2` as 12.
    fn check_closed(&mut self, opened: Opened, rest: &str, number: u32) -> Result<(), ReadError> {
        let next = rest.trim_start_matches(' ').bytes().next();
        let ends = next.is_none_or(|b| b == self.separator) || rest.starts_with('"');
        if ends || !opened.first {
            return Ok(());
        }
        let problem = Problem::Malformed(
            "text follows the closing quotation mark of a cell; put a separator between them, or \
             double a quotation mark that belongs to the cell"
                .to_owned(),
        );
        Err(ReadError::line(self.source, number, problem))
    }
}
