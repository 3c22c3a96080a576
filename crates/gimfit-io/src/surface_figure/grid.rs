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
        let mut ends = [[f64::NAN; 2]; 3];
        for i in 0..self.rows {
            for j in 0..self.columns {
                let point = self.point(i, j);
                for k in 0..3 {
                    // A number wins over what is none.
                    ends[k] = [ends[k][0].min(point[k]), ends[k][1].max(point[k])];
                }
            }
        }
        ends.map(|ends| Interval::around(ends.into_iter()))
    }

    /// Every how many-th row and column to keep so that about `most` points
    /// are left: a short side stays whole, long ones become equal.
    pub(super) fn strides(&self, most: usize) -> [usize; 2] {
        let (rows, columns) = (self.rows, self.columns);
        let side = most.isqrt().max(2);
        let stride =
            |count: usize, most: usize| stride_for(count.saturating_sub(1), most.max(2) - 1);
        if rows * columns <= most {
            [1, 1]
        } else if rows <= side {
            [1, stride(columns, most / rows.max(1))]
        } else if columns <= side {
            [stride(rows, most / columns.max(1)), 1]
        } else {
            [stride(rows, side), stride(columns, side)]
        }
    }

    /// Whether the first coordinate is the same all along each row and the
    /// second along each column, or the other way round: then the third is a
    /// height over a plane grid.
    pub(super) fn is_over_plane_grid(&self) -> bool {
        let [Some(x), Some(y), Some(_)] = self.intervals() else {
            return false;
        };
        let same = |a: f64, b: f64, along: Interval| (a - b).abs() <= 1.0e-6 * along.span();
        let over = |x_of_row: bool| {
            (0..self.rows).all(|i| {
                (0..self.columns).all(|j| {
                    let (p, in_row, in_column) =
                        (self.point(i, j), self.point(i, 0), self.point(0, j));
                    let (first, second) =
                        if x_of_row { (in_row, in_column) } else { (in_column, in_row) };
                    same(p[0], first[0], x) && same(p[1], second[1], y)
                })
            })
        };
        over(true) || over(false)
    }

    /// The grid of every so many-th row and column, and the last ones, so
    /// that about `most` points are left. In a `closed` direction the first
    /// row or column comes again at the end.
    pub(super) fn thinned(&self, most: usize, closed: [bool; 2]) -> Grid {
        let strides = self.strides(most);
        let mut down = every(self.rows, strides[0]);
        let mut across = every(self.columns, strides[1]);
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

/// Every `stride`-th of the numbers below `count`, and the last.
fn every(count: usize, stride: usize) -> Vec<usize> {
    let mut kept: Vec<usize> = (0..count).step_by(stride.max(1)).collect();
    if let Some(&last) = kept.last()
        && last + 1 < count
    {
        kept.push(count - 1);
    }
    kept
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

    #[test]
    fn heights_over_a_plane_grid_are_known_either_way_round() {
        let over = |at: &dyn Fn(f64, f64) -> [f64; 3]| {
            let flat: Vec<f64> =
                (0..20).flat_map(|k| at(f64::from(k / 5), f64::from(k % 5))).collect();
            Source::new([4, 5], &flat, 3, [&[], &[]]).is_over_plane_grid()
        };
        assert!(over(&|u, v| [u, v, u * v]));
        assert!(over(&|u, v| [-v, u, u * v]));
        assert!(!over(&|u, v| [u, v + 0.01 * u, u * v]));
        assert!(!over(&|u, v| [u, v, f64::NAN * v]));
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
