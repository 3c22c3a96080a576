//! One list of numbers: parameters, knots or weights.
//!
//! Text with numbers separated by line ends, blanks, commas or semicolons, and
//! with comments as everywhere; or a NumPy array with one axis. Refused are
//! text, empty places between two separators, and commas that can be decimal
//! marks: directly between digits in a list that other marks separate as well.

use memchr::memchr;

use super::error::{Problem, ReadError, column_name, shortened};
use super::lines::{Kind, LineRules, Lines};
use super::number::{Fault, parse};
use super::options::DecimalMark;
use super::{decode, npy};

/// Reads the list in `bytes`.
pub(super) fn read(bytes: &[u8], source: &str) -> Result<Vec<f64>, ReadError> {
    if bytes.is_empty() {
        return Err(ReadError::file(source, Problem::Empty));
    }
    if bytes.starts_with(npy::MAGIC) {
        return npy::read_list(bytes, source);
    }
    let text = decode::text(bytes, source, false, &mut Vec::new())?;
    refuse_doubtful_commas(&text, source)?;
    let mut numbers = Vec::new();
    for (line, content) in content(&text) {
        read_line(content, line, source, &mut numbers)?;
    }
    if numbers.is_empty() {
        let text = "the file holds no numbers: every line is blank or a comment".to_owned();
        return Err(ReadError::file(source, Problem::Malformed(text)));
    }
    Ok(numbers)
}

fn content(text: &str) -> impl Iterator<Item = (u32, &str)> {
    let rules = LineRules { semicolon_comments: true, ..LineRules::unknown_separator(text) };
    Lines::new(text).filter_map(move |(number, line)| match rules.kind(line) {
        Kind::Content { text, .. } => Some((number, text)),
        _ => None,
    })
}

fn read_line(
    content: &str,
    line: u32,
    source: &str,
    numbers: &mut Vec<f64>,
) -> Result<(), ReadError> {
    // A separator at the end of a line belongs to the line end.
    let content = content.strip_suffix([',', ';']).unwrap_or(content);
    let mut position = 0;
    for piece in content.split([',', ';']) {
        let mut words = piece.split_ascii_whitespace().peekable();
        if words.peek().is_none() {
            let advice = "write the number or remove one of the separators".to_owned();
            return Err(ReadError::line(source, line, Problem::EmptyCell { advice })
                .in_column(position, &[]));
        }
        for word in words {
            let number = parse(word, DecimalMark::Point)
                .map_err(|fault| bad_number(word, fault, line, position, source))?;
            numbers.push(number);
            position += 1;
        }
    }
    Ok(())
}

fn bad_number(word: &str, fault: Fault, line: u32, position: usize, source: &str) -> ReadError {
    let cell = shortened(word);
    let problem = match fault {
        Fault::NotFinite => Problem::NotFinite { cell },
        Fault::TooLarge => Problem::TooLarge { cell },
        _ => Problem::NotANumber {
            cell,
            advice: "correct it, or put # before the line if it is a heading".to_owned(),
        },
    };
    ReadError::line(source, line, problem).in_column(position, &[column_name(position)])
}

/// `1,5 2,5` and `1,5;2,5` and one `1,5` per line can each be read with decimal
/// commas, and then as half as many numbers.
fn refuse_doubtful_commas(text: &str, source: &str) -> Result<(), ReadError> {
    if memchr(b',', text.as_bytes()).is_none() {
        return Ok(());
    }
    let mut lines = 0_usize;
    let mut lines_of_one_comma = 0_usize;
    let mut first: Option<(u32, &str)> = None;
    let mut other_separators = false;
    for (line, content) in content(text) {
        lines += 1;
        let bytes = content.as_bytes();
        let mut commas = 0_usize;
        let mut tight = 0_usize;
        for at in memchr::memchr_iter(b',', bytes) {
            commas += 1;
            let digit =
                |at: Option<usize>| at.and_then(|at| bytes.get(at)).is_some_and(u8::is_ascii_digit);
            if digit(at.checked_sub(1)) && digit(at.checked_add(1)) {
                tight += 1;
            }
        }
        if tight > 0 && first.is_none() {
            first = Some((line, content));
        }
        lines_of_one_comma += usize::from(tight == 1 && commas == 1 && !content.contains('.'));
        // Blanks that separate: between two pieces that no comma ends.
        other_separators |= content.contains(';')
            || content.split(',').any(|piece| piece.split_ascii_whitespace().nth(1).is_some());
    }
    let each_line = lines > 1 && lines_of_one_comma == lines;
    match first {
        Some((line, content)) if other_separators || each_line => {
            let problem = Problem::Ambiguous {
                cell: shortened(content),
                why: "its comma is a decimal mark or separates two numbers; write decimal points, \
                      or a blank after each separating comma"
                    .to_owned(),
            };
            Err(ReadError::line(source, line, problem))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn list(text: &str) -> Result<Vec<f64>, String> {
        read(text.as_bytes(), "knots").map_err(|e| e.to_string())
    }

    #[test]
    fn every_way_to_separate_gives_the_same_list() {
        for text in [
            "0\n0.5\n1\n",
            "0 0.5 1",
            "0,0.5,1",
            "0, 0.5, 1,\n",
            "0;0.5;1",
            "# knots\n0 0.5 # two\r\n\r\n1",
            "0\t0.5\r1\r",
        ] {
            assert_eq!(list(text), Ok(vec![0.0, 0.5, 1.0]), "{text:?}");
        }
    }

    #[test]
    fn commas_that_can_be_decimal_marks_are_refused() {
        for text in ["1,5;2,5", "1,5 2,5", "1,5\n2,5\n"] {
            assert!(list(text).unwrap_err().contains("decimal mark"), "{text:?}");
        }
        assert_eq!(list("1,5"), Ok(vec![1.0, 5.0]));
        assert_eq!(list("1,5,2\n3,4,6"), Ok(vec![1.0, 5.0, 2.0, 3.0, 4.0, 6.0]));
    }

    #[test]
    fn what_is_no_number_is_named_with_its_place() {
        assert_eq!(
            list("0\n1 knot\n").unwrap_err(),
            "knots, line 2, column 2: \"knot\" is not a number; correct it, or put # before the \
             line if it is a heading"
        );
        assert!(list("1,,2").unwrap_err().contains("line 1, column 2: the cell is empty"));
        assert!(list("nan").unwrap_err().contains("not a finite"));
        assert!(list("1e999").unwrap_err().contains("too large"));
        assert!(list("").unwrap_err().contains("empty"));
        assert!(list("# nothing\n").unwrap_err().contains("no numbers"));
    }

    #[test]
    fn a_one_dimensional_array_is_a_list() {
        let header = "{'descr': '|u1', 'fortran_order': False, 'shape': (2,), }";
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes.extend([3, 4]);
        assert_eq!(read(&bytes, "a").unwrap(), [3.0, 4.0]);
    }
}
