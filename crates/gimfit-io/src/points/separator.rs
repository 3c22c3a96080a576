//! Which separator a text uses, found from its first lines.
//!
//! Semicolons win over tabs, tabs over commas, commas over blanks, where half
//! of the lines hold them. Two readings are kept apart with care: blanks used
//! for alignment next to tabs or commas, and commas that are decimal marks
//! between blanks ("1,5 2,3").

use super::lines::{Kind, LineRules, Lines};
use super::number::looks_numeric;
use super::options::{DecimalMark, Delimiter, FormatChoice, ReadOptions};
use super::rows::plain_cells;

/// How many lines are looked at.
const SAMPLE: usize = 64;
/// How many bytes of each: a longer line tells nothing more.
const LINE_SAMPLE: usize = 1 << 16;

/// The separator of `text`.
pub(crate) fn find(text: &str, extension: &str, options: &ReadOptions) -> Delimiter {
    if let Some(delimiter) = options.delimiter {
        return delimiter;
    }
    if options.format == Some(FormatChoice::Tsv) {
        return Delimiter::Tab;
    }
    let (lines, comments): (Vec<&str>, Vec<&str>) =
        sample(text).into_iter().partition(|line| !line.starts_with(';'));
    let csv_asked = options.format == Some(FormatChoice::Csv);
    // A row may open with an empty cell, but not every row does.
    if semicolons(if lines.is_empty() { &comments } else { &lines }) {
        return Delimiter::Semicolon;
    }
    if csv_asked {
        return Delimiter::Comma;
    }
    if tabs(&lines, extension == "tsv") {
        return Delimiter::Tab;
    }
    if options.decimal != Some(DecimalMark::Comma) && commas(&lines) {
        return Delimiter::Comma;
    }
    // One column under a name of several words.
    let one_column = |line: &&str| plain_cells(line, Delimiter::Blanks).count() <= 1;
    if extension == "csv" && lines.len() > 1 && lines[1..].iter().all(one_column) {
        return Delimiter::Comma;
    }
    Delimiter::Blanks
}

/// The first lines with content.
fn sample(text: &str) -> Vec<&str> {
    let rules = LineRules::unknown_separator(text);
    Lines::new(text)
        .filter_map(|(_, line)| match rules.kind(line) {
            Kind::Content { text, .. } => Some(text),
            _ => None,
        })
        .take(SAMPLE)
        .map(|line| {
            let end =
                (0..=line.len().min(LINE_SAMPLE)).rev().find(|end| line.is_char_boundary(*end));
            &line[..end.unwrap_or(0)]
        })
        .collect()
}

fn semicolons(lines: &[&str]) -> bool {
    let with = |line: &&&str| outside_quotes(line.trim_start_matches(';'), b';');
    holds_in_half(lines, lines.iter().filter(with).count())
}

fn tabs(lines: &[&str], named_tsv: bool) -> bool {
    let with: Vec<&str> =
        lines.iter().copied().filter(|line| outside_quotes(line, b'\t')).collect();
    if named_tsv {
        return !with.is_empty();
    }
    if !holds_in_half(lines, with.len()) {
        return false;
    }
    // Several numbers between two tabs: the tabs only align.
    let aligned = with.iter().any(|line| {
        plain_cells(line, Delimiter::Tab).any(|cell| {
            let mut parts = cell.split_ascii_whitespace();
            parts.next().is_some_and(looks_numeric) && parts.next().is_some_and(looks_numeric)
        })
    });
    // A column empty on every line: two tabs in a row are one gap.
    let widest =
        with.iter().map(|line| plain_cells(line, Delimiter::Tab).count()).max().unwrap_or(0);
    let mut filled = vec![false; widest];
    for line in &with {
        for (at, cell) in plain_cells(line, Delimiter::Tab).enumerate() {
            filled[at] |= !cell.is_empty();
        }
    }
    let inner_gap = widest > 2 && filled[1..widest - 1].contains(&false);
    !aligned && !inner_gap
}

fn commas(lines: &[&str]) -> bool {
    let with: Vec<&str> = lines.iter().copied().filter(|line| outside_quotes(line, b',')).collect();
    holds_in_half(lines, with.len()) && !with.iter().any(|line| has_decimal_commas(line))
}

/// Whether the commas of a line can only be decimal marks between blanks: some
/// part between commas holds two numbers, and every part between blanks is one.
fn has_decimal_commas(line: &str) -> bool {
    let number_with_comma =
        |part: &str| looks_numeric(part) && !part.starts_with(',') && !part.ends_with(',');
    let two_numbers = plain_cells(line, Delimiter::Comma).any(|cell| {
        let mut parts = cell.split_ascii_whitespace();
        parts.next().is_some_and(looks_numeric) && parts.next().is_some_and(looks_numeric)
    });
    two_numbers && plain_cells(line, Delimiter::Blanks).all(number_with_comma)
}

fn holds_in_half(lines: &[&str], count: usize) -> bool {
    count > 0 && 2 * count >= lines.len()
}

/// Whether `byte` stands in `line` outside quotation marks.
fn outside_quotes(line: &str, byte: u8) -> bool {
    let mut quoted = false;
    for b in line.bytes() {
        if b == b'"' {
            quoted = !quoted;
        } else if b == byte && !quoted {
            return true;
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> Delimiter {
        find(text, "txt", &ReadOptions::default())
    }

    #[test]
    fn each_separator_is_found() {
        assert_eq!(found("1,2\n3,4\n"), Delimiter::Comma);
        assert_eq!(found("1, 2\n3, 4\n"), Delimiter::Comma);
        assert_eq!(found("1;2\n3;4\n"), Delimiter::Semicolon);
        assert_eq!(found("1,5;2\n3;4\n"), Delimiter::Semicolon);
        assert_eq!(found("1\t2\n3\t4\n"), Delimiter::Tab);
        assert_eq!(found("1 2\n3 4\n"), Delimiter::Blanks);
        assert_eq!(found("1\n2\n"), Delimiter::Blanks);
    }

    #[test]
    fn commas_between_blanks_are_decimal_marks_where_nothing_else_fits() {
        assert_eq!(found("1,5 2,3\n4,5 6,7\n"), Delimiter::Blanks);
        assert_eq!(found("x y\n1,5 2\n3 6,7\n"), Delimiter::Blanks);
        assert_eq!(found("1,5\n2,5\n"), Delimiter::Comma);
    }

    #[test]
    fn tabs_that_only_align_do_not_separate() {
        assert_eq!(found("1 2\t3\n4 5\t6\n"), Delimiter::Blanks);
        assert_eq!(found("1\t\t2\n3\t\t4\n"), Delimiter::Blanks);
        assert_eq!(found("a b\tc\n1\t\n2\t3\n"), Delimiter::Tab);
    }

    #[test]
    fn semicolons_that_open_comments_do_not_separate() {
        assert_eq!(found("; made by hand\n1,2\n3,4\n5,6\n"), Delimiter::Comma);
    }

    #[test]
    fn a_separator_inside_quotation_marks_is_none() {
        assert_eq!(found("\"a;b\",c\n\"1;2\",3\n"), Delimiter::Comma);
    }

    #[test]
    fn one_column_of_a_csv_file_may_have_a_name_of_several_words() {
        let options = ReadOptions::default();
        assert_eq!(find("Heart rate\n60\n61\n", "csv", &options), Delimiter::Comma);
        assert_eq!(find("1 2\n60 3\n61 4\n", "csv", &options), Delimiter::Blanks);
    }
}
