//! Points in rows and columns, as three coordinates each.

use crate::figure::decimate::stride_for;
use crate::figure::scale::Interval;

/// A place in space; not a number where there is no point.
pub(super) type Point = [f64; 3];

/// A grid of points as it was given.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'a> {
    rows: usize,
    columns: usize,
    flat: &'a [f64],
    dimension: usize,
    /// Places of rows and columns, of which single heights make use.
    floor: [&'a [f64]; 2],
}

impl<'a> Source<'a> {
    /// The grid of `shape`, with as many whole rows as `flat` holds.
    pub(super) fn new(
        shape: [usize; 2],
        flat: &'a [f64],
        dimension: usize,
        floor: [&'a [f64]; 2],
    ) -> Self {
        let count = flat.len().checked_div(dimension).unwrap_or(0);
        let rows = count.checked_div(shape[1]).unwrap_or(0).min(shape[0]);
        let columns = if rows == 0 { 0 } else { shape[1] };
        Self { rows, columns, flat, dimension, floor }
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    fn point(&self, row: usize, column: usize) -> Point {
        let start = (row * self.columns + column) * self.dimension;
        let value = |k: usize| self.flat.get(start + k).copied().unwrap_or(f64::NAN);
        let floor = |k: usize, i: usize| self.floor[k].get(i).copied().unwrap_or(f64::NAN);
        match self.dimension {
            1 => [floor(0, row), floor(1, column), value(0)],
            2 => [value(0), value(1), 0.0],
            _ => [value(0), value(1), value(2)],
        }
    }

    /// The intervals that hold the coordinates of all points.
    pub(super) fn intervals(&self) -> [Option<Interval>; 3] {
        let all = || (0..self.rows).flat_map(|i| (0..self.columns).map(move |j| (i, j)));
        [0, 1, 2].map(|k| Interval::around(all().map(|(i, j)| self.point(i, j)[k])))
    }

    /// The grid of every so many-th row and column, and the last ones, so
    /// that about `most` points are left. In a `closed` direction the first
    /// row or column comes again at the end.
    pub(super) fn thinned(&self, most: usize, closed: [bool; 2]) -> Grid {
        let [rows, columns] = share(self.rows, self.columns, most);
        let mut down = every(self.rows, rows);
        let mut across = every(self.columns, columns);
        let strides = [step(&down), step(&across)];
        let opens = |i: usize, j: usize, k: usize, l: usize| self.point(i, j) != self.point(k, l);
        if closed[0] && self.rows > 2 {
            let last = self.rows - 1;
            down.extend((0..self.columns).any(|j| opens(0, j, last, j)).then_some(0));
        }
        if closed[1] && self.columns > 2 {
            let last = self.columns - 1;
            across.extend((0..self.rows).any(|i| opens(i, 0, i, last)).then_some(0));
        }
        let points = down.iter().flat_map(|&i| across.iter().map(move |&j| self.point(i, j)));
        Grid { rows: down.len(), columns: across.len(), points: points.collect(), strides }
    }
}

/// A grid of few enough points to draw.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) points: Vec<Point>,
    /// Every how many-th row and column there is.
    pub(super) strides: [usize; 2],
}

/// How many of `rows` and `columns` to keep so that at most `most` points are
/// left: a short side stays whole, long ones become equal.
fn share(rows: usize, columns: usize, most: usize) -> [usize; 2] {
    let side = most.isqrt().max(2);
    if rows.saturating_mul(columns) <= most {
        [rows, columns]
    } else if rows <= side {
        [rows, (most / rows.max(1)).max(2)]
    } else if columns <= side {
        [(most / columns.max(1)).max(2), columns]
    } else {
        [side, side]
    }
}

/// About `most` of the numbers below `count`: evenly spaced, and the last.
fn every(count: usize, most: usize) -> Vec<usize> {
    let stride = stride_for(count.saturating_sub(1), most.saturating_sub(1));
    let mut kept: Vec<usize> = (0..count).step_by(stride).collect();
    if let Some(&last) = kept.last()
        && last + 1 < count
    {
        kept.push(count - 1);
    }
    kept
}

fn step(kept: &[usize]) -> usize {
    match kept {
        [first, second, ..] => second - first,
        _ => 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn impossible_shapes_hold_no_points() {
        for (shape, dimension) in [
            ([usize::MAX, usize::MAX], 3),
            ([0, 4], 1),
            ([4, 0], 1),
            ([2, 2], 0),
            ([2, 2], usize::MAX),
        ] {
            let source = Source::new(shape, &[1.0; 6], dimension, [&[], &[]]);
            assert_eq!((source.rows(), source.columns()), (0, 0));
            assert!(source.thinned(100, [true; 2]).points.is_empty());
            assert_eq!(source.intervals(), [None; 3]);
        }
        assert_eq!(Source::new([usize::MAX, 2], &[1.0; 7], 1, [&[], &[]]).rows(), 3);
    }

    #[test]
    fn a_closed_grid_ends_with_its_beginning_once() {
        let open = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
        let grid = Source::new([4, 1], &open, 2, [&[], &[]]).thinned(100, [true, false]);
        assert_eq!((grid.rows, grid.points[4]), (5, grid.points[0]));
        let again = Source::new([5, 1], &[&open[..], &open[..2]].concat(), 2, [&[], &[]])
            .thinned(100, [true, false]);
        assert_eq!(again.points, grid.points);
    }

    proptest! {
        #[test]
        fn thinned_grids_are_small_and_keep_their_corners(
            rows in 1_usize..300, columns in 1_usize..300, most in 16_usize..3000,
        ) {
            let flat: Vec<f64> = (0..rows * columns).flat_map(|i| [i as f64, 0.0, 0.0]).collect();
            let grid = Source::new([rows, columns], &flat, 3, [&[], &[]]).thinned(most, [false; 2]);
            prop_assert_eq!(grid.points.len(), grid.rows * grid.columns);
            prop_assert!(grid.points.len() <= 2 * most);
            prop_assert_eq!(grid.points[0][0], 0.0);
            prop_assert_eq!(grid.points[grid.points.len() - 1][0], (rows * columns - 1) as f64);
            prop_assert_eq!(grid.points[grid.columns - 1][0], (columns - 1) as f64);
        }
    }
}
