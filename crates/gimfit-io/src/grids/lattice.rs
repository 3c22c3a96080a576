//! Points with two labels each, put in the rows and columns of a grid.

use super::heights::{MOST_NAMED, list};
use std::collections::HashMap;

use crate::points::{Place, Problem, ReadError};

/// The labels of the points in one direction.
#[derive(Debug)]
pub(super) struct Labels<'n> {
    /// The name of their column.
    name: &'n str,
    /// For each point, the row (or column) it belongs to, from 0.
    rank: Vec<usize>,
    /// How many rows (or columns) there are.
    count: usize,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// Indices counted from 0 or 1.
    Index { base: usize },
    /// Parameters: one for each row (or column).
    Parameter { values: Vec<f64> },
}

/// The points of a grid.
#[derive(Debug)]
pub(super) struct Lattice {
    /// For each place of the grid in C order, the point that stands there.
    pub(super) point: Vec<usize>,
    pub(super) rows: usize,
    pub(super) columns: usize,
}

impl<'n> Labels<'n> {
    /// Whole numbers from 0 or 1; otherwise the sentence that says what they
    /// are instead, and the point it says it of.
    pub(super) fn indices(name: &'n str, values: &[f64]) -> Result<Self, (Option<usize>, String)> {
        const MOST: f64 = (1_u64 << 53) as f64;
        let whole = |v: &f64| v.fract() == 0.0 && (0.0..=MOST).contains(v);
        if let Some(at) = values.iter().position(|v| !whole(v)) {
            let shown = shown(values[at]);
            return Err((
                Some(at),
                format!("{name} = {shown} is not an index, a whole number counted from 0 or 1"),
            ));
        }
        let indices = || values.iter().map(|v| *v as usize);
        let base = indices().min().unwrap_or(0);
        let end = indices().max().unwrap_or(0);
        if base > 1 {
            return Err((
                None,
                format!("the indices {name} start at {base}, but are counted from 0 or 1"),
            ));
        }
        Ok(Labels {
            name,
            rank: indices().map(|index| index - base).collect(),
            count: end - base + 1,
            kind: Kind::Index { base },
        })
    }

    /// Numbers that are equal where the row (or column) is the same.
    pub(super) fn parameters(name: &'n str, values: &[f64]) -> Self {
        // Adding 0 makes both zeros equal.
        let key = |v: f64| (v + 0.0).to_bits();
        let mut ranks: HashMap<u64, usize> = HashMap::new();
        let mut distinct: Vec<f64> = Vec::new();
        for v in values {
            ranks.entry(key(*v)).or_insert_with(|| {
                distinct.push(*v);
                distinct.len()
            });
        }
        if !distinct.is_sorted_by(|a, b| a > b) {
            distinct.sort_by(f64::total_cmp);
        }
        for (at, v) in distinct.iter().enumerate() {
            ranks.insert(key(*v), at);
        }
        Labels {
            name,
            rank: values.iter().map(|v| ranks.get(&key(*v)).copied().unwrap_or(0)).collect(),
            count: distinct.len(),
            kind: Kind::Parameter { values: distinct },
        }
    }

    /// Such as `row from 1`, for a note.
    pub(super) fn described(&self) -> String {
        match &self.kind {
            Kind::Index { base } => format!("{} (counted from {base})", self.name),
            Kind::Parameter { .. } => format!("{} (a parameter)", self.name),
        }
    }

    /// The parameters, if they are not indices.
    pub(super) fn into_parameters(self) -> Option<Vec<f64>> {
        match self.kind {
            Kind::Index { .. } => None,
            Kind::Parameter { values } => Some(values),
        }
    }

    /// Such as `row = 3`, as the file writes it.
    fn label(&self, rank: usize) -> String {
        match &self.kind {
            Kind::Index { base } => format!("{} = {}", self.name, rank + base),
            Kind::Parameter { values } => {
                format!("{} = {}", self.name, values.get(rank).map_or(String::new(), |v| shown(*v)))
            }
        }
    }
}

/// In place of the point of a cell that has none.
pub(super) const NONE: usize = usize::MAX;

/// The grid in which each point stands where its labels say; [`NONE`] where
/// there is no point, if such holes are kept.
pub(super) fn place(
    rows: &Labels<'_>,
    columns: &Labels<'_>,
    lines: &[u32],
    source: &str,
    keep_holes: bool,
) -> Result<Lattice, ReadError> {
    let points = rows.rank.len();
    let fail = |place, text| Err(ReadError::at(source, place, Problem::Malformed(text)));
    let size = rows.count.checked_mul(columns.count).filter(|size| *size <= 2 * points);
    let Some(size) = size else {
        return fail(
            Place::File,
            format!(
                "the {points} points make no grid: {} has {} values and {} has {}, and most of \
                 their pairs are missing; each must be the same along a whole row or column, or \
                 give the shape with --shape if the points stand row by row",
                rows.name, rows.count, columns.name, columns.count
            ),
        );
    };
    let mut point = vec![NONE; size];
    for (at, (row, column)) in rows.rank.iter().zip(&columns.rank).enumerate() {
        let here = &mut point[row * columns.count + column];
        if *here != NONE {
            let line = |at: usize| lines.get(at).copied().unwrap_or(0);
            return fail(
                Place::Line(line(at)),
                format!(
                    "the point {}, {} stands on line {} already; remove one of the two",
                    rows.label(*row),
                    columns.label(*column),
                    line(*here)
                ),
            );
        }
        *here = at;
    }
    let missing = point.iter().filter(|at| **at == NONE).count();
    if missing > 0 && !keep_holes {
        let holes = (0..size).filter(|&at| point[at] == NONE).take(MOST_NAMED);
        let name = |at: usize| {
            format!("{}, {}", rows.label(at / columns.count), columns.label(at % columns.count))
        };
        let names: Vec<String> = holes.map(name).collect();
        return fail(
            Place::File,
            format!(
                "there is no line for {} ({missing} of the {size} points of the grid are missing); a \
                 grid needs them all",
                list(&names, missing)
            ),
        );
    }
    Ok(Lattice { point, rows: rows.count, columns: columns.count })
}

/// A number for a message, with an exponent where it would grow long.
pub(super) fn shown(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
