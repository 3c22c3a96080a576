//! Collocation among chosen points of a grid that are no crossings of rows with columns: no Kronecker
//! product is left, and rows of few weights take its place.

use super::grid::norms_of;
use super::{CollocationMatrix, CollocationOperator, Factorization, NetWeights, ResidualNorms};
use crate::Error;

/// The rows and columns of chosen points in `A_u (x) A_v`, or in `D^-1 (A_u (x) A_v) W` of a rational
/// surface. Memory: at most `12 (p + 1) (q + 1)` bytes a point.
#[derive(Debug, Clone)]
pub(crate) struct ChosenCollocation {
    /// Where each row starts, and where the last one ends.
    starts: Vec<usize>,
    columns: Vec<u32>,
    weights: Vec<f64>,
}

impl ChosenCollocation {
    /// For positions `points` of the grid, row by row, in ascending order.
    pub(crate) fn new(
        u: &dyn CollocationMatrix,
        v: &dyn CollocationMatrix,
        rational: Option<&NetWeights>,
        points: &[usize],
    ) -> Self {
        const ASIDE: u32 = u32::MAX;
        let line = v.points();
        let mut place = vec![ASIDE; u.points() * line];
        points.iter().enumerate().for_each(|(new, &old)| place[old] = new as u32);
        let mut rows = Self { starts: vec![0], columns: Vec::new(), weights: Vec::new() };
        let mut row: Vec<(u32, f64)> = Vec::new();
        for &old in points {
            row.clear();
            u.visit_row(old / line, &mut |i, across| {
                v.visit_row(old % line, &mut |j, along| {
                    let (at, product) = (i * line + j, across * along);
                    if place[at] != ASIDE {
                        let scale = rational.map_or(1.0, |net| net.weights()[at] / net.sums()[old]);
                        row.push((place[at], product * scale));
                    }
                });
            });
            row.sort_unstable_by_key(|(column, _)| *column);
            rows.columns.extend(row.iter().map(|(column, _)| *column));
            rows.weights.extend(row.iter().map(|(_, weight)| *weight));
            rows.starts.push(rows.columns.len());
        }
        rows
    }

    fn row(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let entries = self.starts[j]..self.starts[j + 1];
        let columns = self.columns[entries.clone()].iter().map(|&column| column as usize);
        columns.zip(self.weights[entries].iter().copied())
    }

    fn no_factors() -> Error {
        Error::Incompatible {
            what: "a factored matrix",
            with: "chosen points that are no crossings of rows with columns",
            why: "their matrix has no narrow band; use auto, anderson or gauss-seidel",
        }
    }
}

impl CollocationOperator for ChosenCollocation {
    fn points(&self) -> usize {
        self.starts.len() - 1
    }

    fn control_points(&self) -> usize {
        self.points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        result.fill(0.0);
        for (j, point) in result.chunks_exact_mut(dimension).enumerate() {
            for (column, weight) in self.row(j) {
                let control = &x[column * dimension..][..dimension];
                point.iter_mut().zip(control).for_each(|(x, c)| *x += weight * c);
            }
        }
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.apply(control, dimension, result);
        result.iter_mut().zip(data).for_each(|(x, q)| *x = q - *x);
        norms_of(result, dimension)
    }
}

impl CollocationMatrix for ChosenCollocation {
    fn visit_row(&self, j: usize, visit: &mut dyn FnMut(usize, f64)) {
        self.row(j).for_each(|(column, weight)| visit(column, weight));
    }

    fn sweep(&self, omega: f64, vectors: &mut [f64], dimension: usize) {
        for j in 0..self.points() {
            let (before, rest) = vectors.split_at_mut(j * dimension);
            let vector = &mut rest[..dimension];
            let mut diagonal = 1.0;
            for (column, weight) in self.row(j) {
                if column < j {
                    let moved = &before[column * dimension..][..dimension];
                    vector.iter_mut().zip(moved).for_each(|(x, y)| *x -= weight * y);
                } else if column == j {
                    diagonal = weight;
                }
            }
            vector.iter_mut().for_each(|x| *x *= omega / diagonal);
        }
    }

    fn factor(&self, _: Option<usize>) -> Result<Factorization, Error> {
        Err(Self::no_factors())
    }

    fn factor_comparison(&self) -> Result<Factorization, Error> {
        Err(Self::no_factors())
    }

    fn is_totally_positive(&self) -> bool {
        false
    }
}
