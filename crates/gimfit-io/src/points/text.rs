//! Tables of text: CSV, TSV, and columns between blanks.
//!
//! Kept are the numbers of the chosen columns and the line of each row. The
//! separator, the header and the decimal mark are found from the content
//! unless given (see `separator`, `layout`, `decimal`); comments and blank
//! lines are skipped and counted in the notes (see `lines`). Lost are all other
//! columns and the comments. Refused are rows of different lengths, and in the
//! chosen columns empty cells, text, infinities and NaN, numbers beyond a
//! double, and numbers that can be read in two ways.

use std::ops::ControlFlow;

use super::columns::{Offer, Selection, select};
use super::decimal::require_comma;
use super::error::{Problem, ReadError, counted, list, shortened};
use super::layout::{self, Layout};
use super::number::{Fault, parse, vanished};
use super::options::{DecimalMark, Delimiter, FormatChoice, ReadOptions};
use super::rows::{Cells, Rows, Skipped};
use super::separator;
use super::table::{PointFormat, PointTable};

/// Reads the table in `text`; `extension` is in lower case, empty if unknown.
pub(crate) fn read(
    text: &str,
    source: &str,
    extension: &str,
    options: &ReadOptions,
    mut notes: Vec<String>,
) -> Result<PointTable, ReadError> {
    let separator = separator::find(text, extension, options);
    let rows = Rows::new(text, separator, source)?;
    let layout = layout::find(&rows, source, options, &mut notes)?;
    let xyz = match options.format {
        Some(format) => format == FormatChoice::Xyz,
        None => extension == "xyz",
    };
    let selection = select(usual(&layout, xyz, options), options, source, &mut notes)?;
    let reader = Reader {
        rows: &rows,
        layout: &layout,
        selection: &selection,
        source,
        skip_missing: options.skip_missing,
        may_switch: options.decimal.is_none()
            && (separator != Delimiter::Comma || rows.may_be_quoted),
    };
    let mark = options.decimal.unwrap_or(DecimalMark::Point);
    let columns = match reader.read(mark) {
        Ok(columns) => columns,
        Err(Stop::Error(error)) => return Err(error),
        Err(Stop::Comma) => {
            let mut wanted = vec![false; layout.names.len()];
            selection.all().for_each(|at| wanted[at] = true);
            require_comma(&rows, &layout, &wanted, source, &mut notes)?;
            reader.read(DecimalMark::Comma).map_err(|stop| match stop {
                Stop::Error(error) => error,
                Stop::Comma => ReadError::file(
                    source,
                    Problem::Malformed("the decimal mark cannot be found".to_owned()),
                ),
            })?
        }
    };
    note_skipped(columns.skipped, columns.vanished, &mut notes);
    Ok(PointTable {
        source: source.to_owned(),
        format: match separator {
            _ if xyz => PointFormat::Xyz,
            Delimiter::Comma | Delimiter::Semicolon => PointFormat::Csv,
            Delimiter::Tab => PointFormat::Tsv,
            Delimiter::Blanks => PointFormat::Whitespace,
        },
        title: None,
        column_names: selection.coordinate_names(&layout.names),
        coordinates: columns.coordinates,
        row_lines: Some(columns.lines),
        row_positions: None,
        rows_left_out: 0,
        notes,
        abscissa: columns.abscissa,
        abscissa_name: selection.abscissa_name(&layout.names),
    })
}

/// The columns of the table, and those taken when nobody chooses.
fn usual<'a>(layout: &'a Layout, xyz: bool, options: &ReadOptions) -> Offer<'a> {
    let named = layout.header.is_some();
    let offer = |usual, why| Offer { names: &layout.names, named, usual, why };
    let one = |name: &str| {
        let mut found =
            (0..layout.names.len()).filter(|at| layout.names[*at].eq_ignore_ascii_case(name));
        found.next().filter(|_| found.next().is_none())
    };
    if let (true, Some(x), Some(y)) = (named, one("x"), one("y")) {
        let columns = [x, y].into_iter().chain(one("z")).collect();
        return offer(columns, "because the header names them so");
    }
    if xyz && !named && layout.names.len() > 3 {
        return offer(vec![0, 1, 2], "the first three of an XYZ file");
    }
    let all = 0..layout.names.len();
    match options.abscissa {
        // The abscissa asked for says that the columns differ in kind, so
        // labels beside it are left out; without it they are an error.
        Some(_) => offer(
            all.filter(|at| !layout.text_first[*at]).collect(),
            "all columns of numbers but the abscissa",
        ),
        None => offer(all.collect(), "all columns"),
    }
}

struct Reader<'a> {
    rows: &'a Rows<'a>,
    layout: &'a Layout,
    selection: &'a Selection,
    source: &'a str,
    /// Whether a cell without a value is NaN, for its row to be left out.
    skip_missing: bool,
    /// Whether a comma in a cell may turn out to be the decimal mark.
    may_switch: bool,
}

#[derive(Default)]
struct Columns {
    coordinates: Vec<f64>,
    abscissa: Option<Vec<f64>>,
    lines: Vec<u32>,
    skipped: Skipped,
    vanished: usize,
}

/// Why reading ended early.
pub(crate) enum Stop {
    Error(ReadError),
    /// A cell that should be a number has a comma.
    Comma,
}

impl From<ReadError> for Stop {
    fn from(error: ReadError) -> Self {
        Stop::Error(error)
    }
}

/// Where the number of a column goes.
#[derive(Clone, Copy, Default)]
struct Slot {
    coordinate: Option<usize>,
    abscissa: bool,
}

impl Reader<'_> {
    fn read(&self, mark: DecimalMark) -> Result<Columns, Stop> {
        let mut slots = vec![Slot::default(); self.layout.names.len()];
        for (at, column) in self.selection.coordinates.iter().enumerate() {
            slots[*column].coordinate = Some(at);
        }
        if let Some(column) = self.selection.abscissa {
            slots[column].abscissa = true;
        }
        let mut out =
            Columns { abscissa: self.selection.abscissa.map(|_| Vec::new()), ..Columns::default() };
        let skipped = self.rows.visit(|line, cells| {
            if Some(line) != self.layout.header {
                self.row(line, cells, mark, &slots, &mut out)?;
            }
            Ok::<_, Stop>(ControlFlow::Continue(()))
        })?;
        out.skipped = skipped;
        Ok(out)
    }

    #[inline]
    fn row(
        &self,
        line: u32,
        cells: Cells<'_>,
        mark: DecimalMark,
        slots: &[Slot],
        out: &mut Columns,
    ) -> Result<(), Stop> {
        let start = out.coordinates.len();
        out.coordinates.resize(start + self.selection.coordinates.len(), 0.0);
        let mut count = 0;
        let mut last = "";
        let mut fault = None;
        for cell in cells {
            let slot = slots.get(count).copied().unwrap_or_default();
            if slot.coordinate.is_some() || slot.abscissa {
                let value = match parse(cell, mark) {
                    Err(_) if self.skip_missing && is_missing(cell) => Ok(f64::NAN),
                    value => value,
                };
                match value {
                    Ok(value) => {
                        if value == 0.0 && vanished(cell) {
                            out.vanished += 1;
                        }
                        if let Some(at) = slot.coordinate {
                            out.coordinates[start + at] = value;
                        }
                        if let (true, Some(abscissa)) = (slot.abscissa, &mut out.abscissa) {
                            abscissa.push(value);
                        }
                    }
                    // A row of the wrong length is the graver fault.
                    Err(found) => fault = fault.or(Some((count, cell, found))),
                }
            }
            count += 1;
            last = cell;
        }
        let width = slots.len();
        if count != width + usize::from(self.layout.ends_separated) {
            return Err(self.layout.ragged(self.source, line, count, self.rows.separator).into());
        }
        if self.layout.ends_separated && !last.is_empty() {
            let advice = format!(
                "line {line} has a value in this column; fill the cell in or remove the row"
            );
            let problem = Problem::EmptyCell { advice };
            return Err(ReadError::line(self.source, self.layout.first_line, problem)
                .in_column(width, &self.layout.names)
                .into());
        }
        match fault {
            None => {
                out.lines.push(line);
                Ok(())
            }
            Some((_, cell, Fault::NotANumber))
                if self.may_switch && cell.contains(',') && mark == DecimalMark::Point =>
            {
                Err(Stop::Comma)
            }
            Some((column, cell, found)) => {
                let problem = self.problem(column, cell, found, mark);
                Err(ReadError::line(self.source, line, problem)
                    .in_column(column, &self.layout.names)
                    .into())
            }
        }
    }

    #[cold]
    fn problem(&self, column: usize, cell: &str, fault: Fault, mark: DecimalMark) -> Problem {
        let cell = shortened(cell);
        match fault {
            Fault::NotFinite => Problem::NotFinite { cell },
            Fault::TooLarge => Problem::TooLarge { cell },
            Fault::Marks => Problem::Ambiguous {
                cell,
                why: "it holds more than one decimal mark; write it with one".to_owned(),
            },
            Fault::Empty => Problem::EmptyCell {
                advice: self.advice(column, "fill it in, remove the row", mark),
            },
            Fault::NotANumber => {
                Problem::NotANumber { cell, advice: self.advice(column, "remove the row", mark) }
            }
        }
    }

    /// What to do about a cell: about the cell where the column holds numbers
    /// otherwise, about the choice of columns where it holds none.
    fn advice(&self, column: usize, about_cell: &str, mark: DecimalMark) -> String {
        let width = self.layout.names.len();
        let mut numbers = vec![0_usize; width];
        let mut rows = 0_usize;
        // Nothing here fails, and a failure would only shorten the advice.
        let _ = self.rows.visit(|line, cells| {
            if Some(line) != self.layout.header {
                rows += 1;
                for (at, cell) in cells.enumerate().take(width) {
                    numbers[at] += usize::from(parse(cell, mark).is_ok());
                }
            }
            Ok::<_, ReadError>(ControlFlow::Continue(()))
        });
        let named = self.layout.header.is_some();
        let full: Vec<String> = (0..width)
            .filter(|at| numbers[*at] == rows)
            .map(|at| match named {
                true => self.layout.names[at].clone(),
                false => (at + 1).to_string(),
            })
            .collect();
        if numbers[column] > 0 || full.is_empty() {
            return format!("{about_cell} or choose other columns with --columns");
        }
        let list = list(&full).replace(", ", ",");
        format!("choose the columns of numbers with --columns {list}")
    }
}

/// Whether a cell says that there is no value.
fn is_missing(cell: &str) -> bool {
    const WORDS: [&str; 5] = ["", "nan", "na", "n/a", "null"];
    WORDS.iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Notes what stood between the rows, and how many numbers were read as 0.
pub(crate) fn note_skipped(skipped: Skipped, vanished: usize, notes: &mut Vec<String>) {
    let Skipped { comment_lines, comments_after_rows, blank_lines_between } = skipped;
    let were = |count| if count == 1 { "was" } else { "were" };
    if comment_lines > 0 {
        notes.push(format!(
            "{} {} skipped.",
            counted(comment_lines, "comment line"),
            were(comment_lines)
        ));
    }
    if comments_after_rows > 0 {
        notes.push(format!(
            "{} after a row {} skipped.",
            counted(comments_after_rows, "comment"),
            were(comments_after_rows)
        ));
    }
    if blank_lines_between > 0 {
        notes.push(format!(
            "{} between rows {} skipped; the rows before and after are one curve.",
            counted(blank_lines_between, "blank line"),
            were(blank_lines_between)
        ));
    }
    if vanished > 0 {
        notes.push(format!(
            "{} too small for a double-precision number {} read as 0.",
            counted(vanished, "number"),
            were(vanished)
        ));
    }
}
