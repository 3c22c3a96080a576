//! Grids written with one point per line.
//!
//! The row and the column of a point follow from two columns of the file:
//! indices (`row,column` or `i,j`), or parameters (`u,v`) that are the same
//! along a whole row or column; then the lines may stand in any order. Without
//! them the shape must be given, and the lines stand row by row. The numbers
//! are read as the readers of points read them.

use std::ops::ControlFlow;

use super::grid::{GridFormat, GridLines, PointGrid};
use super::lattice::{Labels, Lattice, place};
use super::options::GridOptions;
use crate::points::columns::{Offer, Selection, select};
use crate::points::error::{counted, list};
use crate::points::layout::{self, Layout};
use crate::points::rows::Rows;
use crate::points::{ColumnChoice, Place, PointTable, Problem, ReadError, ReadOptions, text};

/// The two columns that say where a point belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pair {
    row: usize,
    column: usize,
    kind: PairKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum PairKind {
    Indices,
    Parameters,
    /// Indices if they can be, else parameters.
    Either,
}

/// The pair among columns of these names, by the names alone.
pub(super) fn pair_by_name(names: &[String]) -> Option<Pair> {
    const NAMES: [(&str, &str, PairKind); 4] = [
        ("row", "column", PairKind::Indices),
        ("row", "col", PairKind::Indices),
        ("i", "j", PairKind::Indices),
        ("u", "v", PairKind::Parameters),
    ];
    let one = |wanted: &str| {
        let mut found = (0..names.len()).filter(|at| names[*at].eq_ignore_ascii_case(wanted));
        found.next().filter(|_| found.next().is_none())
    };
    NAMES.iter().find_map(|(row, column, kind)| {
        Some(Pair { row: one(row)?, column: one(column)?, kind: *kind })
    })
}

/// The number of rows of text, the header included.
pub(super) fn count(rows: &Rows<'_>) -> Result<usize, ReadError> {
    let mut count = 0;
    rows.visit(|_, _| {
        count += 1;
        Ok::<_, ReadError>(ControlFlow::Continue(()))
    })?;
    Ok(count)
}

/// Reads the grid in `text`, whose rows of cells are `rows`.
pub(super) fn read(
    text: &str,
    extension: &str,
    rows: &Rows<'_>,
    source: &str,
    options: &GridOptions,
    mut notes: Vec<String>,
) -> Result<PointGrid, ReadError> {
    // The reader of points finds the same layout and notes it.
    let layout = layout::find(rows, source, &options.for_points(), &mut Vec::new())?;
    let pair = pair(&layout, source, options)?;
    if pair.is_none() && options.shape.is_none() {
        let points = count(rows)? - usize::from(layout.header.is_some());
        return Err(without_shape(points, &layout, source));
    }
    let selection = select(offer(&layout, pair), &options.for_points(), source, &mut notes)?;
    note_left_out(&layout, &selection, pair, &mut notes);
    let (wanted, slots) = with_pair(&selection, pair);
    let asked = ReadOptions {
        columns: Some(wanted.iter().map(|at| ColumnChoice::Number(at + 1)).collect()),
        ..options.for_points()
    };
    let table = text::read(text, source, extension, &asked, notes)
        .map_err(|error| for_grids(error, source, &layout))?;
    match (pair, options.shape) {
        (Some(pair), _) => by_labels(table, pair, slots, &layout, options),
        (None, Some(shape)) => by_shape(table, shape),
        (None, None) => Err(without_shape(table.rows(), &layout, source)),
    }
}

fn pair(layout: &Layout, source: &str, options: &GridOptions) -> Result<Option<Pair>, ReadError> {
    let named = layout.header.is_some();
    let Some((row, column)) = &options.index_columns else {
        return Ok(pair_by_name(&layout.names).filter(|_| named));
    };
    let offer = Offer { names: &layout.names, named, usual: Vec::new(), why: "" };
    let asked =
        ReadOptions { columns: Some(vec![row.clone(), column.clone()]), ..ReadOptions::default() };
    let found = select(offer, &asked, source, &mut Vec::new())?;
    match found.coordinates.as_slice() {
        [row, column] => Ok(Some(Pair { row: *row, column: *column, kind: PairKind::Either })),
        _ => Ok(None),
    }
}

fn without_shape(points: usize, layout: &Layout, source: &str) -> ReadError {
    ReadError::file(
        source,
        Problem::Malformed(format!(
            "nothing says in which row and column each of the {} belongs (the columns are {}); \
             give the shape, such as --shape 20x30, if they stand row by row, or the two columns that \
             say it, with --index-columns or by the names row,column or u,v in the header",
            counted(points, "point"),
            list(&layout.names)
        )),
    )
}

/// The coordinates taken when nobody chooses.
fn offer(layout: &Layout, pair: Option<Pair>) -> Offer<'_> {
    let names = &layout.names;
    let free = |at: &usize| pair.is_none_or(|pair| *at != pair.row && *at != pair.column);
    let one = |name: &str| {
        let mut found =
            (0..names.len()).filter(free).filter(|at| names[*at].eq_ignore_ascii_case(name));
        found.next().filter(|_| found.next().is_none())
    };
    let named = layout.header.is_some();
    let usual = match (one("x"), one("y")) {
        (Some(x), Some(y)) if named => [x, y].into_iter().chain(one("z")).collect(),
        _ => (0..names.len()).filter(free).collect(),
    };
    Offer { names, named, usual, why: "" }
}

/// Notes the columns that a file has for neither the grid nor its points.
fn note_left_out(
    layout: &Layout,
    selection: &Selection,
    pair: Option<Pair>,
    notes: &mut Vec<String>,
) {
    let mut used = vec![false; layout.names.len()];
    let of_pair = pair.iter().flat_map(|pair| [pair.row, pair.column]);
    selection.coordinates.iter().copied().chain(of_pair).for_each(|at| used[at] = true);
    let left_out = layout.names.iter().zip(used).filter(|(_, used)| !used);
    let names: Vec<&str> = left_out.map(|(name, _)| name.as_str()).collect();
    if !names.is_empty() {
        notes.push(format!(
            "The coordinates are {}; left out: {}.",
            list(&selection.coordinate_names(&layout.names)),
            list(&names)
        ));
    }
}

/// Where the numbers stand in a row read for a grid.
struct Slots {
    /// The coordinates come first; this many.
    coordinates: usize,
    row: usize,
    column: usize,
}

/// The columns to read, each once, and where they then stand.
fn with_pair(selection: &Selection, pair: Option<Pair>) -> (Vec<usize>, Slots) {
    let mut wanted = selection.coordinates.clone();
    let mut slot = |column: usize| match wanted.iter().position(|at| *at == column) {
        Some(slot) => slot,
        None => {
            wanted.push(column);
            wanted.len() - 1
        }
    };
    let (row, column) = pair.map_or((0, 0), |pair| (slot(pair.row), slot(pair.column)));
    (wanted, Slots { coordinates: selection.coordinates.len(), row, column })
}

/// The same error with advice for grids: no row may be left out.
fn for_grids(error: ReadError, source: &str, layout: &Layout) -> ReadError {
    const ADVICE: &str = "a grid needs every point; give a value or choose other columns with \
                          --columns";
    let problem = match error.problem() {
        Problem::EmptyCell { .. } if !layout.ends_separated => {
            Problem::EmptyCell { advice: ADVICE.to_owned() }
        }
        Problem::NotANumber { cell, .. } => {
            Problem::NotANumber { cell: cell.clone(), advice: ADVICE.to_owned() }
        }
        Problem::NotFinite { cell } => {
            Problem::Malformed(format!("{cell} is not a finite number; {ADVICE}"))
        }
        _ => return error,
    };
    let mapped = ReadError::at(source, error.place(), problem);
    match error.column() {
        Some(label) => mapped.in_column(label.number - 1, &layout.names),
        None => mapped,
    }
}

fn by_shape(table: PointTable, shape: (usize, usize)) -> Result<PointGrid, ReadError> {
    let (rows, columns) = shape;
    let points = table.rows();
    if rows.checked_mul(columns) != Some(points) {
        let problem = Problem::Malformed(format!(
            "the shape {rows}x{columns} takes {} points, but the file holds {points}",
            rows as u128 * columns as u128
        ));
        return Err(ReadError::file(&table.source, problem));
    }
    let mut notes = table.notes;
    notes.push(format!("The lines are taken row by row, as {rows} rows of {columns} points each."));
    Ok(PointGrid {
        source: table.source,
        format: GridFormat::Lines,
        title: None,
        rows,
        columns,
        column_names: table.column_names,
        coordinates: table.coordinates,
        notes,
        row_abscissae: None,
        column_abscissae: None,
        lines: table.row_lines.map_or(GridLines::Unknown, GridLines::OfPoints),
    })
}

fn by_labels(
    table: PointTable,
    pair: Pair,
    slots: Slots,
    layout: &Layout,
    options: &GridOptions,
) -> Result<PointGrid, ReadError> {
    let source = table.source;
    let lines = table.row_lines.unwrap_or_default();
    let width = table.column_names.len();
    let column = |slot: usize| -> Vec<f64> {
        table.coordinates.iter().skip(slot).step_by(width).copied().collect()
    };
    let (row_name, column_name) = (&layout.names[pair.row], &layout.names[pair.column]);
    let (of_rows, of_columns) = (column(slots.row), column(slots.column));
    let parameters =
        || (Labels::parameters(row_name, &of_rows), Labels::parameters(column_name, &of_columns));
    let indices = Labels::indices(row_name, &of_rows)
        .and_then(|rows| Ok((rows, Labels::indices(column_name, &of_columns)?)));
    let (rows, columns) = match (pair.kind, indices) {
        (PairKind::Parameters, _) => parameters(),
        (_, Ok(labels)) => labels,
        (PairKind::Either, Err(_)) => parameters(),
        (PairKind::Indices, Err((at, text))) => {
            let line = at.and_then(|at| lines.get(at));
            let place = line.map_or(Place::File, |line| Place::Line(*line));
            return Err(ReadError::at(&source, place, Problem::Malformed(text)));
        }
    };
    let lattice = place(&rows, &columns, &lines, &source, options.keep_holes)?;
    let Lattice { point, rows: m, columns: n } = lattice;
    if let Some((rows, columns)) = options.shape.filter(|shape| *shape != (m, n)) {
        let problem = Problem::Malformed(format!(
            "the shape {rows}x{columns} is asked for, but {row_name} and {column_name} make a grid \
             of {m}x{n}"
        ));
        return Err(ReadError::file(&source, problem));
    }
    let mut notes = table.notes;
    notes.push(format!(
        "The grid has {} along {} and {} along {}.",
        counted(m, "row"),
        rows.described(),
        counted(n, "column"),
        columns.described()
    ));
    let mut coordinates = Vec::with_capacity(point.len() * slots.coordinates);
    for at in &point {
        match at.checked_mul(width).and_then(|start| table.coordinates.get(start..)) {
            Some(rest) => coordinates.extend(&rest[..slots.coordinates]),
            None => coordinates.extend(std::iter::repeat_n(f64::NAN, slots.coordinates)),
        }
    }
    Ok(PointGrid {
        source,
        format: GridFormat::Lines,
        title: None,
        rows: m,
        columns: n,
        column_names: table.column_names[..slots.coordinates].to_vec(),
        coordinates,
        notes,
        row_abscissae: rows.into_parameters(),
        column_abscissae: columns.into_parameters(),
        lines: GridLines::OfPoints(
            point.iter().map(|at| lines.get(*at).copied().unwrap_or(0)).collect(),
        ),
    })
}
