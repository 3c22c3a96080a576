//! Values on the command line, checked where they are read.

use crate::evaluate::SampleCount;
use gimfit::knots::MAX_DEGREE;
use gimfit_io::grids::parse_shape;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Most samples of a curve: beyond, the table would not fit into memory.
const MOST_SAMPLES: usize = 1_000_000_000;

/// A finite number. One too close to zero for a double is not taken for zero, which may mean
/// something else.
pub(crate) fn number(text: &str) -> Result<f64, String> {
    let value = f64::from_str(text).map_err(|_| format!("\"{text}\" is not a number"))?;
    let mut mantissa = text.bytes().take_while(|b| !matches!(b, b'e' | b'E'));
    if value == 0.0 && mantissa.any(|b| matches!(b, b'1'..=b'9')) {
        return Err("it is too small for a double-precision number (about 4.9e-324 at least); \
                    give 0 if zero is meant"
            .into());
    }
    if !value.is_finite() {
        return Err("it must be a finite number (about 1.8e308 at most)".into());
    }
    Ok(value)
}

/// A number of samples.
pub(crate) fn samples(text: &str) -> Result<usize, String> {
    within(text, 1, MOST_SAMPLES)
}

/// A number of samples of a curve, or one in u and one in v of a surface.
pub(crate) fn sample_count(text: &str) -> Result<SampleCount, String> {
    if text.contains(['x', 'X', ',']) {
        let (m, n) = parse_shape(text).map_err(|error| error.to_string())?;
        return Ok(SampleCount::Surface(m, n));
    }
    samples(text).map(SampleCount::Curve)
}

/// Most samples along an edge of a triangle: half a billion in all.
pub(crate) const MOST_TRIANGLE_SAMPLES: usize = 30_000;

/// A number of samples along each edge of a triangle.
pub(crate) fn triangle_samples(text: &str) -> Result<usize, String> {
    within(text, 2, MOST_TRIANGLE_SAMPLES)
}

/// A highest derivative.
pub(crate) fn derivatives(text: &str) -> Result<usize, String> {
    within(text, 0, MAX_DEGREE).map_err(|error| {
        format!(
            "{error}, the highest degree: derivatives of polynomials above their degree are zero"
        )
    })
}

/// A position counted from 1, or a range of them such as 10-20.
pub(crate) fn positions(text: &str) -> Result<RangeInclusive<usize>, String> {
    let count = |part: &str| match part.trim().parse() {
        Ok(0) => Err("points count from 1".to_owned()),
        Ok(count) => Ok(count),
        Err(_) => Err(format!("\"{text}\" is neither a number nor a range such as 10-20")),
    };
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    let (first, last) = (count(first)?, count(last)?);
    if first > last {
        return Err(format!("the range runs from {first} back to {last}; swap them"));
    }
    Ok(first..=last)
}

fn within(text: &str, least: usize, most: usize) -> Result<usize, String> {
    match text.parse() {
        Ok(count) if (least..=most).contains(&count) => Ok(count),
        _ => Err(format!("it must be a whole number from {least} to {most}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_what_was_written_or_refused() {
        assert_eq!(number("-1.5e3"), Ok(-1500.0));
        assert_eq!(number("0.00e5"), Ok(0.0));
        assert_eq!(number("5e-324"), Ok(5e-324));
        for text in ["1e-400", "-0.0003E-999", "1e999", "nan", "inf", "x", ""] {
            assert!(number(text).is_err(), "{text}");
        }
    }

    #[test]
    fn counts_beyond_reason_are_refused() {
        assert_eq!(samples("1000000000"), Ok(1_000_000_000));
        assert!(samples("0").is_err() && samples("1000000001").is_err() && samples("-1").is_err());
        assert!(samples("18446744073709551616").is_err());
        assert_eq!(derivatives("25"), Ok(25));
        assert!(derivatives("26").is_err());
    }
}
