//! Rows with cells in quotation marks, through the `csv` crate.
//!
//! The crate knows one comment mark and counts only some line ends, so the text
//! is first copied with comments and blank lines emptied and every line end
//! made LF; line numbers stay those of the file. Whether a line lies inside a
//! quoted cell follows from the number of quotation marks before it.

use std::ops::ControlFlow;

use memchr::memchr_iter;

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
        let mut copy = String::with_capacity(text.len() + 1);
        let mut skipped = Skipped::default();
        let mut opened: Option<u32> = None;
        let mut rows = 0_usize;
        let mut blanks = 0;
        for (number, line) in Lines::new(text) {
            if opened.is_some() {
                opened = copy_content(line, separator, opened, number, &mut copy);
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
                        opened = copy_content(text, separator, None, number, &mut copy);
                    }
                }
            }
            copy.push('\n');
        }
        if let Some(line) = opened {
            return Err(ReadError::line(source, line, Problem::UnclosedQuote));
        }
        Ok(Quoted {
            text: copy,
            separator,
            skipped,
            source: source.to_owned(),
        })
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

/// Appends one line, without the blanks between a separator and a quotation
/// mark: with them the crate would take the mark as part of the cell. Returns
/// the line of a quotation mark still open at the end.
fn copy_content(
    line: &str,
    separator: u8,
    mut opened: Option<u32>,
    number: u32,
    copy: &mut String,
) -> Option<u32> {
    let mut rest = line;
    while let Some(at) = memchr::memchr2(b'"', separator, rest.as_bytes()) {
        let (before, after) = rest.split_at(at + 1);
        copy.push_str(before);
        rest = after;
        if before.ends_with('"') {
            opened = match opened {
                None => Some(number),
                Some(_) => None,
            };
        } else if opened.is_none() {
            let unpadded = rest.trim_start_matches(' ');
            if unpadded.starts_with('"') {
                rest = unpadded;
            }
        }
    }
    copy.push_str(rest);
    opened
}
