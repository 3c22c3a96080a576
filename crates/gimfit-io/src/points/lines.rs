//! Lines of a text, and what each line is: blank, a comment, or content.
//!
//! A line ends with LF, CR LF or CR. A line whose first mark is `#`, `%`, `!`,
//! `//`, or `;` where that does not separate cells, is a comment; a comment
//! also follows `#` within a line, unless the `#` stands directly after a
//! letter (as in a column named `Point#`) or inside quotation marks.

use memchr::{memchr, memchr2, memchr2_iter};

/// The lines of a text with their numbers from 1, without their ends.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a str,
    number: u32,
    has_returns: bool,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Lines {
            rest: text,
            number: 0,
            // Looking for one byte is faster than for two.
            has_returns: memchr(b'\r', text.as_bytes()).is_some(),
        }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (u32, &'a str);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let bytes = self.rest.as_bytes();
        let end =
            if self.has_returns { memchr2(b'\n', b'\r', bytes) } else { memchr(b'\n', bytes) };
        let (line, rest) = match end {
            None => (self.rest, ""),
            Some(end) => {
                let pair = bytes[end] == b'\r' && bytes.get(end + 1) == Some(&b'\n');
                let next = end + if pair { 2 } else { 1 };
                (&self.rest[..end], &self.rest[next..])
            }
        };
        self.rest = rest;
        self.number = self.number.saturating_add(1);
        Some((self.number, line))
    }
}

/// What stands on a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind<'a> {
    /// Nothing.
    Blank,
    /// A comment alone.
    Comment,
    /// Content, without blanks around it.
    Content {
        /// The content.
        text: &'a str,
        /// Whether a comment followed it.
        commented: bool,
    },
}

/// How to tell the parts of a line apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct LineRules {
    /// `;` opens a comment line, because it does not separate cells.
    pub(super) semicolon_comments: bool,
    /// Tabs separate cells, so that leading and closing ones count.
    pub(super) tabs_separate: bool,
    /// The text has a `#` somewhere.
    pub(super) has_hash: bool,
}

impl LineRules {
    /// The rules before the separator is known.
    pub(super) fn unknown_separator(text: &str) -> Self {
        LineRules {
            semicolon_comments: false,
            tabs_separate: false,
            has_hash: memchr(b'#', text.as_bytes()).is_some(),
        }
    }

    /// What stands on `line`.
    #[inline]
    pub(super) fn kind<'a>(&self, line: &'a str) -> Kind<'a> {
        let trimmed = line.trim_ascii();
        match trimmed.as_bytes() {
            // A row of tabs alone is a row of empty cells.
            [] if !(self.tabs_separate && line.contains('\t')) => return Kind::Blank,
            [b'#' | b'%' | b'!', ..] | [b'/', b'/', ..] => return Kind::Comment,
            [b';', ..] if self.semicolon_comments => return Kind::Comment,
            _ => {}
        }
        let content = if self.tabs_separate { line.trim_matches(' ') } else { trimmed };
        if !self.has_hash {
            return Kind::Content { text: content, commented: false };
        }
        match comment_start(content) {
            None => Kind::Content { text: content, commented: false },
            Some(at) => {
                let kept = &content[..at];
                Kind::Content {
                    text: if self.tabs_separate {
                        kept.trim_end_matches(' ')
                    } else {
                        kept.trim_ascii_end()
                    },
                    commented: true,
                }
            }
        }
    }
}

/// Where a comment after content starts.
fn comment_start(content: &str) -> Option<usize> {
    let bytes = content.as_bytes();
    let mut quoted = false;
    for at in memchr2_iter(b'#', b'"', bytes) {
        let after_letter = at > 0 && bytes[at - 1].is_ascii_alphabetic();
        if bytes[at] == b'"' {
            quoted = !quoted;
        } else if !(quoted || after_letter) {
            return Some(at);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: LineRules =
        LineRules { semicolon_comments: true, tabs_separate: false, has_hash: true };

    fn content(line: &str) -> Option<&str> {
        match PLAIN.kind(line) {
            Kind::Content { text, .. } => Some(text),
            _ => None,
        }
    }

    #[test]
    fn all_three_line_ends_count_alike() {
        let lines: Vec<_> = Lines::new("a\nb\r\nc\rd\n\ne").collect();
        assert_eq!(lines, [(1, "a"), (2, "b"), (3, "c"), (4, "d"), (5, ""), (6, "e")]);
    }

    #[test]
    fn every_comment_mark_opens_a_comment_line() {
        for line in ["# a", "  % a", "//a", "! a", "; a"] {
            assert_eq!(PLAIN.kind(line), Kind::Comment, "{line}");
        }
        assert_eq!(PLAIN.kind(" \t"), Kind::Blank);
        let separated = LineRules { semicolon_comments: false, ..PLAIN };
        assert!(matches!(separated.kind(";1"), Kind::Content { .. }));
    }

    #[test]
    fn a_comment_after_content_is_cut() {
        assert_eq!(content("1 2 # end"), Some("1 2"));
        assert_eq!(content("1,2#end"), Some("1,2"));
        assert_eq!(content("Point#,x"), Some("Point#,x"));
        assert_eq!(content("\"a #1\",x # b"), Some("\"a #1\",x"));
    }

    #[test]
    fn leading_and_closing_tabs_stay_where_tabs_separate() {
        let tabs = LineRules { tabs_separate: true, ..PLAIN };
        assert_eq!(tabs.kind(" \t1\t"), Kind::Content { text: "\t1\t", commented: false });
    }
}
