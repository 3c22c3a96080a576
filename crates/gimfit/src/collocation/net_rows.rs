//! Rows of an approximating surface: more data points than control points, on the lines of a grid or
//! scattered. The Kronecker product is never formed.

use super::DataRows;
use crate::knots::KnotVector;

/// `[B_a(u_k) B_b(v_k)]` over data points `k` and the control points `(a, b)` that move.
#[derive(Debug, Clone)]
pub(crate) struct NetRows {
    points: usize,
    /// Points in a row, where parameters belong to the lines of a grid.
    line: Option<usize>,
    sides: [DataRows; 2],
}

impl NetRows {
    /// Of a grid whose rows and columns have parameters, inside the domain.
    pub(crate) fn of_lines(parameters: [&[f64]; 2], knots: [&KnotVector; 2]) -> Self {
        let sides = [0, 1].map(|k| DataRows::new(parameters[k], knots[k]));
        let line = parameters[1].len();
        Self { points: parameters[0].len() * line, line: Some(line), sides }
    }

    /// Of points with parameters (u, v) of their own, inside the domain.
    pub(crate) fn of_points(parameters: &[[f64; 2]], knots: [&KnotVector; 2]) -> Self {
        let sides = [0, 1].map(|k| {
            let each: Vec<f64> = parameters.iter().map(|pair| pair[k]).collect();
            DataRows::new(&each, knots[k])
        });
        Self { points: parameters.len(), line: None, sides }
    }

    /// Data points.
    pub(crate) fn points(&self) -> usize {
        self.points
    }

    /// Rows and columns of control points that move.
    pub(crate) fn net_shape(&self) -> [usize; 2] {
        self.sides.each_ref().map(DataRows::columns)
    }

    /// The rows of one direction, and the weights of the data summed over the other, where both
    /// belong to lines; otherwise the rows of all points.
    pub(super) fn marginal(&self, k: usize, weights: &[f64]) -> (&DataRows, Vec<f64>) {
        let rows = &self.sides[k];
        let Some(line) = self.line else { return (rows, weights.to_vec()) };
        let mut sums = vec![0.0; rows.points()];
        for (i, row) in weights.chunks_exact(line).enumerate() {
            for (j, weight) in row.iter().enumerate() {
                sums[if k == 0 { i } else { j }] += weight;
            }
        }
        (rows, sums)
    }

    /// Calls `visit` with each data point and its place on the surface of a net.
    pub(crate) fn visit(&self, net: &[f64], dimension: usize, visit: impl FnMut(usize, &[f64])) {
        match dimension {
            1 => self.visit_fixed::<1>(net, visit),
            2 => self.visit_fixed::<2>(net, visit),
            3 => self.visit_fixed::<3>(net, visit),
            _ => self.visit_any(net, dimension, visit),
        }
    }

    fn visit_fixed<const D: usize>(&self, net: &[f64], mut visit: impl FnMut(usize, &[f64])) {
        let [u, v] = &self.sides;
        let columns = v.columns();
        let Some(line) = self.line else {
            for k in 0..self.points {
                let (first_u, of_u) = u.entries(k);
                let (first_v, of_v) = v.entries(k);
                let mut point = [0.0; D];
                for (row, weight) in lines(first_u, of_u, u.columns()) {
                    let row = &net[row * columns * D..][..columns * D];
                    blend::<D>(row, first_v, of_v, columns, weight, &mut point);
                }
                visit(k, &point);
            }
            return;
        };
        let mut between = vec![0.0; columns * D];
        for i in 0..u.points() {
            let (first_u, of_u) = u.entries(i);
            between.fill(0.0);
            for (row, weight) in lines(first_u, of_u, u.columns()) {
                let row = &net[row * columns * D..][..columns * D];
                between.iter_mut().zip(row).for_each(|(x, p)| *x += weight * p);
            }
            for j in 0..line {
                let (first_v, of_v) = v.entries(j);
                let mut point = [0.0; D];
                blend::<D>(&between, first_v, of_v, columns, 1.0, &mut point);
                visit(i * line + j, &point);
            }
        }
    }

    fn visit_any(&self, net: &[f64], dimension: usize, mut visit: impl FnMut(usize, &[f64])) {
        let [u, v] = &self.sides;
        let columns = v.columns();
        let mut point = vec![0.0; dimension];
        for k in 0..self.points {
            let (i, j) = self.line.map_or((k, k), |line| (k / line, k % line));
            let (first_u, of_u) = u.entries(i);
            let (first_v, of_v) = v.entries(j);
            point.fill(0.0);
            for (row, in_u) in lines(first_u, of_u, u.columns()) {
                for (column, in_v) in lines(first_v, of_v, columns) {
                    let control = &net[(row * columns + column) * dimension..][..dimension];
                    let weight = in_u * in_v;
                    point.iter_mut().zip(control).for_each(|(x, p)| *x += weight * p);
                }
            }
            visit(k, &point);
        }
    }

    /// Adds `A^T x` to a net, for vectors `x` of shape (points, dimension).
    pub(crate) fn add_transposed(&self, vectors: &[f64], dimension: usize, net: &mut [f64]) {
        let [u, v] = &self.sides;
        let columns = v.columns();
        let width = columns * dimension;
        let mut between = vec![0.0; width];
        let spread = |line: &mut [f64], j: usize, factor: f64, vector: &[f64]| {
            let (first, of_v) = v.entries(j);
            for (column, weight) in lines(first, of_v, columns) {
                let target = &mut line[column * dimension..][..dimension];
                let weight = factor * weight;
                target.iter_mut().zip(vector).for_each(|(x, y)| *x += weight * y);
            }
        };
        if let Some(line) = self.line {
            for (i, row) in vectors.chunks_exact(line * dimension).enumerate() {
                between.fill(0.0);
                for (j, vector) in row.chunks_exact(dimension).enumerate() {
                    spread(&mut between, j, 1.0, vector);
                }
                let (first, of_u) = u.entries(i);
                for (row, weight) in lines(first, of_u, u.columns()) {
                    let target = &mut net[row * width..][..width];
                    target.iter_mut().zip(&between).for_each(|(x, y)| *x += weight * y);
                }
            }
            return;
        }
        for (k, vector) in vectors.chunks_exact(dimension).enumerate() {
            let (first, of_u) = u.entries(k);
            for (row, weight) in lines(first, of_u, u.columns()) {
                spread(&mut net[row * width..][..width], k, weight, vector);
            }
        }
    }
}

/// The lines of a net that a point sees, with their weights.
fn lines(
    first: usize,
    weights: &[f64],
    columns: usize,
) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
    let wrapped = move |k: usize| if k < columns { k } else { k % columns };
    weights.iter().enumerate().map(move |(k, &weight)| (wrapped(first + k), weight))
}

/// Adds `factor` times the point of a line of control points.
#[inline]
fn blend<const D: usize>(
    line: &[f64],
    first: usize,
    weights: &[f64],
    columns: usize,
    factor: f64,
    point: &mut [f64; D],
) {
    let mut sum = [0.0; D];
    if first + weights.len() <= columns {
        let run = &line[first * D..][..weights.len() * D];
        for (control, weight) in run.chunks_exact(D).zip(weights) {
            for (x, p) in sum.iter_mut().zip(control) {
                *x += weight * p;
            }
        }
    } else {
        for (column, weight) in lines(first, weights, columns) {
            for (x, p) in sum.iter_mut().zip(&line[column * D..][..D]) {
                *x += weight * p;
            }
        }
    }
    for (x, y) in point.iter_mut().zip(sum) {
        *x += factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_points_agree_and_the_transpose_is_one() {
        let u = KnotVector::open(2, vec![0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0]).unwrap();
        let v = KnotVector::periodic(3, (-3..9).map(|i| f64::from(i) / 5.0).collect()).unwrap();
        let t_u = [0.0, 0.1, 0.5, 0.9, 1.0];
        let t_v = [0.0, 0.15, 0.3, 0.8, 0.95, 1.0];
        let pairs: Vec<[f64; 2]> =
            t_u.iter().flat_map(|&a| t_v.iter().map(move |&b| [a, b])).collect();
        let of_lines = NetRows::of_lines([&t_u, &t_v], [&u, &v]);
        let of_points = NetRows::of_points(&pairs, [&u, &v]);
        for dimension in [1, 2, 3, 5] {
            let [rows, columns] = of_lines.net_shape();
            assert_eq!([rows, columns], [4, 5]);
            let size = rows * columns * dimension;
            let net: Vec<f64> = (0..size).map(|i| (i * i % 17) as f64).collect();
            let mut found = [Vec::new(), Vec::new()];
            for (out, rows) in found.iter_mut().zip([&of_lines, &of_points]) {
                rows.visit(&net, dimension, |_, point| out.extend_from_slice(point));
            }
            let [a, b] = found;
            assert!(a.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-12));
            let y: Vec<f64> = (0..a.len()).map(|i| (i % 7) as f64 - 2.0).collect();
            for rows in [&of_lines, &of_points] {
                let mut back = vec![0.0; size];
                rows.add_transposed(&y, dimension, &mut back);
                let left: f64 = a.iter().zip(&y).map(|(a, y)| a * y).sum();
                let right: f64 = net.iter().zip(&back).map(|(a, y)| a * y).sum();
                assert!((left - right).abs() < 1e-9 * left.abs(), "{left} {right}");
            }
        }
    }
}
