//! Grids that are heights: points over a lattice of two coordinates.

use crate::points::GridView;

/// Which coordinates make the lattice.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lattice {
    /// The coordinate that changes from row to row, and the one from column to column.
    pub(super) axes: [usize; 2],
    /// Their values at the lines, rising or falling.
    pub(super) abscissae: [Vec<f64>; 2],
}

impl Lattice {
    /// The lattice under a grid of points with a coordinate beyond two: one coordinate is the same all
    /// along each row and rises, or falls, from row to row; another is so along columns.
    pub(super) fn of(grid: GridView<'_>) -> Option<Self> {
        if grid.dimension() < 3 {
            return None;
        }
        let [rows, columns] = grid.shape();
        let find = |k: usize| {
            (0..grid.dimension()).find_map(|axis| {
                let at = |line: usize, across: usize| match k {
                    0 => grid.point(line, across)[axis],
                    _ => grid.point(across, line)[axis],
                };
                let (lines, others) = if k == 0 { (rows, columns) } else { (columns, rows) };
                let values: Vec<f64> = (0..lines).map(|line| at(line, 0)).collect();
                let monotone = values.windows(2).all(|pair| pair[0] < pair[1])
                    || values.windows(2).all(|pair| pair[0] > pair[1]);
                let same = || {
                    (0..lines).all(|line| (1..others).all(|other| at(line, other) == values[line]))
                };
                (monotone && same()).then_some((axis, values))
            })
        };
        let ((u, of_u), (v, of_v)) = (find(0)?, find(1)?);
        (u != v && rows > 1 && columns > 1)
            .then_some(Self { axes: [u, v], abscissae: [of_u, of_v] })
    }

    /// Parameters of the lines of direction `k`, on [0, 1].
    pub(super) fn parameters(&self, k: usize) -> Vec<f64> {
        let values = &self.abscissae[k];
        let (first, last) = (values[0], values[values.len() - 1]);
        values.iter().map(|x| (x - first) / (last - first)).collect()
    }

    /// The coordinate of direction `k` at a parameter.
    pub(super) fn abscissa(&self, k: usize, t: f64) -> f64 {
        let values = &self.abscissae[k];
        let (first, last) = (values[0], values[values.len() - 1]);
        (1.0 - t) * first + t * last
    }

    /// The coordinates that stand on the lattice.
    pub(super) fn heights(&self, point: &[f64]) -> Vec<f64> {
        let rest = point.iter().enumerate().filter(|(axis, _)| !self.axes.contains(axis));
        rest.map(|(_, x)| *x).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lattice_is_found_under_any_order_of_coordinates_and_only_where_it_is() {
        let points: Vec<f64> = (0..4)
            .flat_map(|i| {
                (0..3).flat_map(move |j| [f64::from(j * j), f64::from(i - j), -f64::from(i)])
            })
            .collect();
        let lattice = Lattice::of(GridView::new([4, 3], 3, &points).unwrap()).unwrap();
        assert_eq!(lattice.axes, [2, 0]);
        assert_eq!(lattice.parameters(1), [0.0, 0.25, 1.0]);
        assert_eq!(lattice.abscissa(0, 1.0), -3.0);
        assert_eq!(lattice.heights(&[1.0, 2.0, 3.0]), [2.0]);
        let mut bent = points.clone();
        bent[3] += 1e-9;
        assert_eq!(Lattice::of(GridView::new([4, 3], 3, &bent).unwrap()), None);
    }
}
