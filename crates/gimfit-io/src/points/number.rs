//! One cell of text into one number.
//!
//! Read are whole and decimal numbers with an optional sign, with or without
//! digits before or after the mark, with an exponent after `e`, `E`, or as
//! Fortran writes it after `d` or `D`. Conversion is correctly rounded, so a
//! number written with enough digits comes back bit by bit. Refused are
//! infinities, NaN, hexadecimal numbers and digit separators.

use super::options::DecimalMark;

/// Why a cell is no usable number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    /// Nothing in it.
    Empty,
    /// Something else in it.
    NotANumber,
    /// An infinity or a NaN.
    NotFinite,
    /// A number beyond the largest double.
    TooLarge,
    /// Two commas, or a point where commas are the decimal mark.
    Marks,
}

/// The number in `cell`, which is trimmed.
#[inline]
pub(crate) fn parse(cell: &str, mark: DecimalMark) -> Result<f64, Fault> {
    let plain = match mark {
        DecimalMark::Point => cell.parse().ok(),
        DecimalMark::Comma => short_with_comma(cell),
    };
    match plain {
        Some(value) if f64::is_finite(value) => Ok(value),
        _ => parse_other(cell, mark),
    }
}

/// The number in a cell of ordinary length with one comma or none, without an
/// allocation: files with decimal commas have millions of them.
fn short_with_comma(cell: &str) -> Option<f64> {
    let mut buffer = [0_u8; 32];
    let copy = buffer.get_mut(..cell.len())?;
    copy.copy_from_slice(cell.as_bytes());
    // Two commas become two points, which is no number.
    for byte in copy.iter_mut() {
        *byte = match *byte {
            b',' => b'.',
            b'.' => return None,
            other => other,
        };
    }
    std::str::from_utf8(copy).ok()?.parse().ok()
}

/// Everything but the plain case, kept apart so that the plain case inlines.
#[cold]
fn parse_other(cell: &str, mark: DecimalMark) -> Result<f64, Fault> {
    if cell.is_empty() {
        return Err(Fault::Empty);
    }
    let digits = cell.bytes().any(|b| b.is_ascii_digit());
    let with_point;
    let mut plain = cell;
    if mark == DecimalMark::Comma && digits {
        let commas = cell.bytes().filter(|b| *b == b',').count();
        if commas > 1 || cell.contains('.') {
            let numeric = looks_numeric(cell);
            return Err(if numeric { Fault::Marks } else { Fault::NotANumber });
        }
        with_point = cell.replace(',', ".");
        plain = &with_point;
    }
    let parsed = plain.parse::<f64>().ok().or_else(|| fortran(plain));
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) if digits => Err(Fault::TooLarge),
        Some(_) => Err(Fault::NotFinite),
        None => Err(Fault::NotANumber),
    }
}

/// `1.5D+03`: the exponent letter of Fortran's double precision.
fn fortran(cell: &str) -> Option<f64> {
    let at = cell.find(['d', 'D'])?;
    let before = cell.as_bytes().get(at.checked_sub(1)?)?;
    if !(before.is_ascii_digit() || *before == b'.') {
        return None;
    }
    let mut with_e = cell.to_owned();
    with_e.replace_range(at..=at, "e");
    with_e.parse().ok()
}

/// Whether a cell is meant as a number, readable or not: then the line it
/// stands in is no header, and a fault in it is the file's.
pub(crate) fn looks_numeric(cell: &str) -> bool {
    if matches!(parse(cell, DecimalMark::Point), Ok(_) | Err(Fault::NotFinite | Fault::TooLarge)) {
        return true;
    }
    let start = cell.trim_start_matches(['+', '-', '.', ',']);
    start.starts_with(|c: char| c.is_ascii_digit())
        && cell.bytes().all(|b| b"0123456789+-.,:/eEdDTZ ".contains(&b))
}

/// Whether a cell says that a value is missing.
pub(crate) fn says_missing(cell: &str) -> bool {
    const WORDS: [&str; 8] = ["na", "n/a", "null", "none", "missing", "-", "--", "?"];
    WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Whether a cell is text: neither empty, nor a number, nor a missing value.
pub(crate) fn is_text(cell: &str) -> bool {
    !cell.is_empty() && !looks_numeric(cell) && !says_missing(cell)
}

/// Whether `cell`, read as zero, was written as something else.
pub(crate) fn vanished(cell: &str) -> bool {
    cell.bytes().take_while(|b| !b.is_ascii_alphabetic()).any(|b| matches!(b, b'1'..=b'9'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use DecimalMark::{Comma, Point};

    #[test]
    fn the_usual_spellings_are_read() {
        for (cell, value) in [
            ("12", 12.0),
            ("+.5", 0.5),
            ("-5.", -5.0),
            ("1.0D+03", 1000.0),
            ("2d-1", 0.2),
            ("5.D0", 5.0),
            ("7E2", 700.0),
        ] {
            assert_eq!(parse(cell, Point), Ok(value), "{cell}");
        }
        assert_eq!(parse("-1,5D2", Comma), Ok(-150.0));
        assert_eq!(parse("7", Comma), Ok(7.0));
    }

    #[test]
    fn what_is_no_number_is_told_apart() {
        for (cell, fault) in [
            ("", Fault::Empty),
            ("n/a", Fault::NotANumber),
            ("D3", Fault::NotANumber),
            ("1.0D+03D", Fault::NotANumber),
            ("0x1p3", Fault::NotANumber),
            ("1_000", Fault::NotANumber),
            (".", Fault::NotANumber),
            ("NaN", Fault::NotFinite),
            ("-inf", Fault::NotFinite),
            ("1e999", Fault::TooLarge),
            ("1d400", Fault::TooLarge),
        ] {
            assert_eq!(parse(cell, Point), Err(fault), "{cell}");
        }
        assert_eq!(parse("1,234,567", Comma), Err(Fault::Marks));
        assert_eq!(parse("1.234,5", Comma), Err(Fault::Marks));
        assert_eq!(parse("inf", Comma), Err(Fault::NotFinite));
    }

    #[test]
    fn dates_and_broken_numbers_are_no_header_names() {
        for cell in ["2020-01-02", "10:20:30", "1,234.5", "1e999", "nan", "", "N/A"] {
            assert!(!is_text(cell), "{cell}");
        }
        for cell in ["x", "E1", "2nd", "lat [deg]", "D"] {
            assert!(is_text(cell), "{cell}");
        }
    }

    #[test]
    fn only_a_zero_written_as_zero_is_one() {
        assert!(vanished("1e-400") && vanished("-0.03E-999"));
        assert!(!vanished("0.00") && !vanished("0e12"));
    }
}
