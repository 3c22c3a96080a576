//! The sum of squared residuals of a square collocation matrix, and what Newton's method asks of it.

use super::normal::SymmetricBand;
use crate::collocation::CollocationMatrix;

/// `|Q - A P|^2 / 2` for planar points. Unknowns are numbered two by two along the curve; those of
/// a closed curve in the order 0, n - 1, 1, n - 2, ..., which lays the band on itself, so that it
/// stays one.
#[derive(Debug)]
pub(super) struct LeastSquares {
    /// Where each row starts in `columns` and `weights`; one more for the end.
    starts: Vec<usize>,
    columns: Vec<usize>,
    weights: Vec<f64>,
    closed: bool,
    normal: SymmetricBand,
}

impl LeastSquares {
    /// For constraints that tie points up to `ties` apart.
    pub(super) fn new(operator: &dyn CollocationMatrix, closed: bool, ties: usize) -> Self {
        let points = operator.points();
        let mut fit = Self {
            starts: vec![0],
            columns: Vec::new(),
            weights: Vec::new(),
            closed,
            normal: SymmetricBand::zeros(0, 0),
        };
        // Folding sets neighbours up to two places apart.
        let mut reach = if closed { 2 * ties } else { ties };
        for j in 0..points {
            let (columns, weights) = (&mut fit.columns, &mut fit.weights);
            operator.visit_row(j, &mut |column, weight| {
                columns.push(column);
                weights.push(weight);
            });
            let row = &fit.columns[fit.starts[j]..];
            let places = row.iter().map(|&column| fit.place(column, points));
            let (low, high) =
                places.fold((usize::MAX, 0), |(low, high), p| (low.min(p), high.max(p)));
            reach = reach.max(high.saturating_sub(low));
            fit.starts.push(fit.columns.len());
        }
        fit.normal = SymmetricBand::zeros(2 * points, 2 * reach + 1);
        for j in 0..points {
            let row = fit.starts[j]..fit.starts[j + 1];
            for (a, b) in row.clone().flat_map(|a| row.clone().map(move |b| (a, b))) {
                let product = fit.weights[a] * fit.weights[b];
                let (a, b) = (fit.unknown(fit.columns[a]), fit.unknown(fit.columns[b]));
                fit.normal.add(a, b, product);
                fit.normal.add(a + 1, b + 1, product);
            }
        }
        fit
    }

    fn points(&self) -> usize {
        self.starts.len() - 1
    }

    fn place(&self, point: usize, points: usize) -> usize {
        match self.closed {
            true if 2 * point < points => 2 * point,
            true => 2 * (points - 1 - point) + 1,
            false => point,
        }
    }

    /// The first of the two unknowns of a control point.
    pub(super) fn unknown(&self, point: usize) -> usize {
        2 * self.place(point, self.points())
    }

    /// `A^T A`, twice.
    pub(super) fn normal(&self) -> &SymmetricBand {
        &self.normal
    }

    /// Writes `A^T r`, the steepest way down, in the order of the unknowns.
    pub(super) fn descent(&self, residual: &[f64], result: &mut [f64]) {
        result.fill(0.0);
        for (j, r) in residual.chunks_exact(2).enumerate() {
            for k in self.starts[j]..self.starts[j + 1] {
                let at = self.unknown(self.columns[k]);
                result[at] += self.weights[k] * r[0];
                result[at + 1] += self.weights[k] * r[1];
            }
        }
    }

    /// Writes `A x` for a step in the order of the unknowns, in the order of the points.
    pub(super) fn apply(&self, x: &[f64], result: &mut [f64]) {
        for (j, y) in result.chunks_exact_mut(2).enumerate() {
            y.fill(0.0);
            for k in self.starts[j]..self.starts[j + 1] {
                let at = self.unknown(self.columns[k]);
                y[0] += self.weights[k] * x[at];
                y[1] += self.weights[k] * x[at + 1];
            }
        }
    }
}
