//! Airfoil coordinates in the two common orders.
//!
//! Selig order: a line with the name, then pairs x y in one loop from the
//! trailing edge over one side to the nose and back over the other. Lednicer
//! order: the name, a line with two counts such as `61. 61.`, then so many
//! pairs of the upper side from the nose to the trailing edge and so many of
//! the lower side. Lednicer files become one loop in Selig order: the upper
//! side is reversed, and the nose point is kept once where both sides give
//! exactly the same one.
//!
//! Kept are the name, as title, and the pairs. Refused are rows that are not
//! two numbers, counts that do not fit, and halves that do not run from the
//! nose. A file that is not asked to be an airfoil is read as one only if its
//! first line cannot be a row or a header and its pairs run as an airfoil's.

use super::columns::{Offer, select};
use super::error::{Problem, ReadError, counted, shortened};
use super::lines::{Kind, LineRules, Lines};
use super::number::{Fault, looks_numeric, parse};
use super::options::{DecimalMark, Delimiter, ReadOptions};
use super::rows::plain_cells;
use super::table::{PointFormat, PointTable};

/// How much speaks for an airfoil before the content is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Likelihood {
    /// It was asked for.
    Certain,
    /// The file's name ends as an airfoil's does.
    Likely,
    /// Nothing speaks against it.
    Possible,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Pair {
    line: u32,
    x: f64,
    y: f64,
}

/// Reads the airfoil in `text`, or returns `None` if it is not one.
pub(super) fn read(
    text: &str,
    source: &str,
    likelihood: Likelihood,
    options: &ReadOptions,
    notes: &[String],
) -> Result<Option<PointTable>, ReadError> {
    let rules = LineRules { semicolon_comments: true, ..LineRules::unknown_separator(text) };
    let mut content = Lines::new(text).filter_map(|(number, line)| match rules.kind(line) {
        Kind::Content { text, .. } => Some((number, line.trim(), text)),
        _ => None,
    });
    let Some((title_line, title, _)) = content.next() else {
        return Ok(None);
    };
    let certain = likelihood == Likelihood::Certain;
    if !certain && !is_title(title, likelihood) {
        return Ok(None);
    }
    let mut pairs = Vec::new();
    for (line, _, row) in content {
        match pair(row, line, source) {
            Ok(pair) => pairs.push(pair),
            // One bad row far into the file of an airfoil is that row's fault.
            Err(error)
                if certain || (likelihood == Likelihood::Likely && is_begun(title, &pairs)) =>
            {
                return Err(error);
            }
            Err(_) => return Ok(None),
        }
    }
    let mut notes = notes.to_vec();
    let lednicer = halves(&pairs, source)?;
    let (format, pairs) = match lednicer {
        Some(upper) => {
            (PointFormat::AirfoilLednicer, one_loop(&pairs, upper, source, title_line, &mut notes)?)
        }
        None if certain || is_loop(&pairs) => {
            notes.push(format!(
                "Read as an airfoil in Selig order: line {title_line} is its name, and its points \
                 run in one loop from the trailing edge."
            ));
            (PointFormat::AirfoilSelig, pairs)
        }
        None => return Ok(None),
    };
    if pairs.is_empty() {
        let why = format!("there is only line {title_line}, a name");
        return Err(ReadError::file(source, Problem::NoRows(why)));
    }
    table(title, format, &pairs, source, options, notes).map(Some)
}

/// Whether the first line is a title: not a row of numbers, and not a header
/// of two columns unless the file's name speaks for an airfoil.
fn is_title(title: &str, likelihood: Likelihood) -> bool {
    let cells: Vec<&str> = plain_cells(title, Delimiter::Blanks).take(3).collect();
    if cells.iter().all(|cell| looks_numeric(cell)) {
        return false;
    }
    let texts = cells.iter().filter(|cell| !looks_numeric(cell)).count();
    let two_names = cells.len() == 2 && texts == 2;
    let x_y = two_names && cells[0].eq_ignore_ascii_case("x") && cells[1].eq_ignore_ascii_case("y");
    !x_y && (!two_names || likelihood == Likelihood::Likely)
}

/// Whether the rows read so far can be an airfoil's and nothing else.
fn is_begun(title: &str, pairs: &[Pair]) -> bool {
    let near_chord = |pair: &Pair| (-0.5..=1.5).contains(&pair.x);
    let points = pairs.get(1..).unwrap_or_default();
    plain_cells(title, Delimiter::Blanks).count() != 2
        && points.len() >= 3
        && points.iter().all(near_chord)
}

/// Whether the points leave one end of the chord, reach the other and return.
fn is_loop(pairs: &[Pair]) -> bool {
    let (Some(first), Some(last)) = (pairs.first(), pairs.last()) else {
        return false;
    };
    let most = pairs.iter().map(|p| p.x).fold(f64::NEG_INFINITY, f64::max);
    let least = pairs.iter().map(|p| p.x).fold(f64::INFINITY, f64::min);
    let near_tail = |p: &Pair| most - p.x < 0.2 * (most - least);
    pairs.len() >= 5 && near_tail(first) && near_tail(last)
}

fn pair(row: &str, line: u32, source: &str) -> Result<Pair, ReadError> {
    let mut cells = plain_cells(row, Delimiter::Blanks);
    let (Some(x), Some(y), None) = (cells.next(), cells.next(), cells.next()) else {
        let found = plain_cells(row, Delimiter::Blanks).count();
        let problem = Problem::Ragged {
            found: format!("{} {}", if found == 1 { "is" } else { "are" }, counted(found, "cell")),
            expected: 2,
            set_by: "each row of an airfoil".to_owned(),
            advice: "correct or remove the row".to_owned(),
        };
        return Err(ReadError::line(source, line, problem));
    };
    let number = |column: usize, cell: &str| {
        parse(cell, DecimalMark::Point).map_err(|fault| {
            let cell = shortened(cell);
            let problem = match fault {
                Fault::NotFinite => Problem::NotFinite { cell },
                Fault::TooLarge => Problem::TooLarge { cell },
                _ => Problem::NotANumber { cell, advice: "correct or remove the row".to_owned() },
            };
            ReadError::line(source, line, problem).in_column(column, &names())
        })
    };
    Ok(Pair { line, x: number(0, x)?, y: number(1, y)? })
}

/// The number of points of the upper side, if the first pair is the two counts
/// of a Lednicer file.
fn halves(pairs: &[Pair], source: &str) -> Result<Option<usize>, ReadError> {
    let Some((counts, points)) = pairs.split_first() else {
        return Ok(None);
    };
    let is_count = |value: f64| value >= 2.0 && value.fract() == 0.0 && value < 1e9;
    if points.is_empty() || !is_count(counts.x) || !is_count(counts.y) {
        return Ok(None);
    }
    if counts.x + counts.y == points.len() as f64 {
        return Ok(Some(counts.x as usize));
    }
    // Points on a unit chord under two counts: the counts are wrong. Larger
    // points may be a chord in millimetres whose first point is whole.
    if points.iter().all(|p| p.x.abs() <= 1.5 && p.y.abs() <= 1.5) {
        let problem = Problem::Malformed(format!(
            "the two counts of a Lednicer file announce {} and {} points, but {} follow; correct \
             the counts",
            counts.x,
            counts.y,
            points.len()
        ));
        return Err(ReadError::line(source, counts.line, problem));
    }
    Ok(None)
}

/// The points of a Lednicer file as one loop. `pairs` starts with the counts.
fn one_loop(
    pairs: &[Pair],
    upper_count: usize,
    source: &str,
    title_line: u32,
    notes: &mut Vec<String>,
) -> Result<Vec<Pair>, ReadError> {
    let points = pairs.get(1..).unwrap_or_default();
    let (upper, lower) = points.split_at(upper_count.min(points.len()));
    for (side, half) in [("upper", upper), ("lower", lower)] {
        if let (Some(first), Some(last)) = (half.first(), half.last())
            && first.x >= last.x
        {
            let problem = Problem::Malformed(format!(
                "the {side} side of a Lednicer file runs from the nose (least x) to the trailing \
                 edge, but this one starts here at x = {} and ends at x = {}; reverse its rows",
                first.x, last.x
            ));
            return Err(ReadError::line(source, first.line, problem));
        }
    }
    notes.push(format!(
        "Read as an airfoil in Lednicer order: line {title_line} is its name; the {} of the upper \
         side were reversed, so that the points run in one loop from the upper trailing edge \
         round the nose to the lower one.",
        counted(upper.len(), "point")
    ));
    let mut out: Vec<Pair> = upper.iter().rev().copied().collect();
    let doubled = match (upper.first(), lower.first()) {
        (Some(a), Some(b)) => a.x == b.x && a.y == b.y,
        _ => false,
    };
    if doubled {
        notes.push("The nose point, which both sides give, was kept once.".to_owned());
    }
    out.extend(&lower[usize::from(doubled).min(lower.len())..]);
    Ok(out)
}

fn names() -> [String; 2] {
    ["x".to_owned(), "y".to_owned()]
}

fn table(
    title: &str,
    format: PointFormat,
    pairs: &[Pair],
    source: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let names = names();
    let offer = Offer { names: &names, named: true, usual: vec![0, 1], why: "both columns" };
    let selection = select(offer, options, source, &mut notes)?;
    let value = |row: usize, column: usize| {
        Ok::<_, ReadError>(match column {
            0 => pairs[row].x,
            _ => pairs[row].y,
        })
    };
    let (coordinates, abscissa) = selection.gather(pairs.len(), value)?;
    Ok(PointTable {
        source: source.to_owned(),
        format,
        title: Some(title.to_owned()),
        column_names: selection.coordinate_names(&names),
        coordinates,
        row_lines: Some(pairs.iter().map(|pair| pair.line).collect()),
        row_positions: None,
        rows_left_out: 0,
        notes,
        abscissa,
        abscissa_name: selection.abscissa_name(&names),
    })
}

#[cfg(test)]
#[path = "test_airfoil.rs"]
mod tests;
