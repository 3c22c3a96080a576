//! What hides what: the nearest facet at each of many places of the picture.

use crate::figure::decimate::Px;
use crate::figure::plot::Rect;

/// A point of the picture and how near to the viewer it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spot {
    pub(super) at: Px,
    pub(super) depth: f64,
}

impl Spot {
    pub(super) fn is_number(&self) -> bool {
        !(self.at.0.is_nan() || self.at.1.is_nan() || self.depth.is_nan())
    }
}

/// No facet.
const NONE: u32 = u32::MAX;

/// Nearest facet and its depth for each cell of a fine grid over the picture.
pub(super) struct DepthMap {
    area: Rect,
    /// Cells to each unit of the picture.
    fineness: f64,
    columns: usize,
    rows: usize,
    cells: Vec<(f64, u32)>,
}

impl DepthMap {
    pub(super) fn new(area: Rect, fineness: f64) -> Self {
        let count = |length: f64| (length * fineness).ceil().clamp(1.0, 4000.0) as usize;
        let (columns, rows) = (count(area.width), count(area.height));
        Self { area, fineness, columns, rows, cells: vec![(f64::MIN, NONE); columns * rows] }
    }

    /// Forgets all facets.
    pub(super) fn clear(&mut self) {
        self.cells.fill((f64::MIN, NONE));
    }

    /// Column and row, with fractions, of a place of the picture.
    fn cell(&self, at: Px) -> Px {
        ((at.0 - self.area.x) * self.fineness, (at.1 - self.area.y) * self.fineness)
    }

    /// Lays the facet `number` with these corners over what is there.
    pub(super) fn lay(&mut self, corners: [Spot; 4], number: u32) {
        let [a, b, c, d] = corners;
        self.lay_triangle([a, b, c], number);
        self.lay_triangle([a, c, d], number);
    }

    fn lay_triangle(&mut self, corners: [Spot; 3], number: u32) {
        let [a, b, c] = corners.map(|spot| self.cell(spot.at));
        let area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
        let depths = corners.map(|spot| spot.depth);
        let (columns, rows) = (self.columns, self.rows);
        let cells = &mut self.cells;
        each_cell_of(corners, [a, b, c], [columns, rows], |x, y, cell| {
            let wb = ((x - a.0) * (c.1 - a.1) - (y - a.1) * (c.0 - a.0)) / area;
            let wc = ((b.0 - a.0) * (y - a.1) - (b.1 - a.1) * (x - a.0)) / area;
            let depth = (1.0 - wb - wc) * depths[0] + wb * depths[1] + wc * depths[2];
            let cell = &mut cells[cell];
            if depth > cell.0 {
                *cell = (depth, number);
            }
        });
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// Calls `visit` with each cell whose centre a facet with these corners covers.
    pub(super) fn each_cell(&self, corners: [Spot; 4], mut visit: impl FnMut(usize)) {
        let [a, b, c, d] = corners;
        for corners in [[a, b, c], [a, c, d]] {
            let places = corners.map(|spot| self.cell(spot.at));
            each_cell_of(corners, places, [self.columns, self.rows], |_, _, cell| visit(cell));
        }
    }

    /// Whether a facet lies more than `slack` before `spot` and all around it.
    ///
    /// The cells around count too, since depth may change fast from cell to
    /// cell.
    pub(super) fn hides(&self, spot: Spot, slack: f64) -> bool {
        let (x, y) = self.cell(spot.at);
        let (column, row) = (x.floor() as i64, y.floor() as i64);
        (-1..=1).all(|down| {
            (-1..=1).all(|right| {
                let (row, column) = (row + down, column + right);
                let inside = (0..self.rows as i64).contains(&row)
                    && (0..self.columns as i64).contains(&column);
                inside
                    && self.cells[row as usize * self.columns + column as usize].0
                        > spot.depth + slack
            })
        })
    }

    /// For each of `count` facets the number of cells in which it is seen.
    pub(super) fn seen(&self, count: usize) -> Vec<u32> {
        let mut seen = vec![0; count];
        for (_, number) in &self.cells {
            if let Some(cells) = seen.get_mut(*number as usize) {
                *cells += 1;
            }
        }
        seen
    }
}

/// Calls `visit` with the centre and the number of each cell that a triangle covers.
fn each_cell_of(
    corners: [Spot; 3],
    [a, b, c]: [Px; 3],
    [columns, rows]: [usize; 2],
    mut visit: impl FnMut(f64, f64, usize),
) {
    let area = (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0);
    if area.abs() < 1.0e-12 || !corners.iter().all(Spot::is_number) {
        return;
    }
    for row in centres(a.1.min(b.1).min(c.1), a.1.max(b.1).max(c.1), rows) {
        let y = row as f64 + 0.5;
        let (from, to) = span([a, b, c], y);
        for column in centres(from, to, columns) {
            visit(column as f64 + 0.5, y, row * columns + column);
        }
    }
}

/// Those of the first `count` cells whose centres lie between `low` and `high`.
fn centres(low: f64, high: f64, count: usize) -> std::ops::Range<usize> {
    let index = |end: f64| (end - 0.5).ceil().clamp(0.0, count as f64) as usize;
    index(low)..index(high).max(index(low))
}

/// Where the triangle with these corners begins and ends at the height `y`.
fn span(corners: [Px; 3], y: f64) -> (f64, f64) {
    let mut ends = (f64::MAX, f64::MIN);
    for (p, q) in [(0, 1), (1, 2), (2, 0)].map(|(p, q)| (corners[p], corners[q])) {
        if (p.1 <= y) != (q.1 <= y) {
            let x = p.0 + (y - p.1) / (q.1 - p.1) * (q.0 - p.0);
            ends = (ends.0.min(x), ends.1.max(x));
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect { x: 10.0, y: 20.0, width: 40.0, height: 30.0 };

    fn square(low: f64, high: f64, depth: f64) -> [Spot; 4] {
        [(low, low), (high, low), (high, high), (low, high)].map(|at| Spot { at, depth })
    }

    #[test]
    fn nearer_facets_hide_farther_ones_in_any_order() {
        for near_first in [true, false] {
            let mut map = DepthMap::new(AREA, 2.0);
            let order = if near_first { [1, 0] } else { [0, 1] };
            for number in order {
                map.lay(square(22.0, 32.0, f64::from(number)), number);
            }
            assert_eq!(map.seen(2), [0, 400]);
            let at = (27.0, 27.0);
            assert!(map.hides(Spot { at, depth: 0.0 }, 0.1));
            assert!(!map.hides(Spot { at, depth: 1.0 }, 0.1));
            assert!(!map.hides(Spot { at: (45.0, 27.0), depth: -5.0 }, 0.0));
        }
    }

    #[test]
    fn facets_anywhere_are_taken() {
        let mut map = DepthMap::new(AREA, 1.0);
        map.lay(square(-1.0e9, 1.0e9, 0.0), 0);
        map.lay(square(f64::NAN, 1.0, 5.0), 1);
        map.lay(square(1.0e12, 1.0e13, 5.0), 2);
        map.lay(square(25.0, 25.0, 5.0), 3);
        assert_eq!(map.seen(4), [1200, 0, 0, 0]);
        assert!(!map.hides(Spot { at: (f64::NAN, f64::INFINITY), depth: 0.0 }, 0.0));
    }
}
