//! Least squares with linear demands that are met exactly: `G P = R` on the control points, met by
//! a feasible start and by steps that `G` does not see.
//!
//! What the loop sees is `s - G^T lambda`, the gathered difference vectors less the multipliers that
//! make `G M^-1 (s - G^T lambda) = 0`. A rule that multiplies it by `M^-1`, or by nothing for `M = I`,
//! takes projected steps (the projected form of constrained LSPIA; Chang, Ma and Deng 2023 have the same
//! limit). It is 0 exactly where the Karush-Kuhn-Tucker conditions hold.

use super::{CollocationOperator, Factorization, LeastSquaresCollocation, ResidualNorms};
use std::cell::RefCell;

/// One demand: a weighted sum of coordinates of control points, and what it shall be.
#[derive(Debug, Clone)]
pub(crate) struct ConstraintRow {
    /// Places in the flat array of shape (control points, dimension), rising, with weights.
    pub(crate) entries: Vec<(usize, f64)>,
    pub(crate) value: f64,
    /// Which of the caller's constraints it belongs to.
    pub(crate) owner: usize,
}

impl ConstraintRow {
    fn dot(&self, x: &[f64]) -> f64 {
        self.entries.iter().map(|&(place, weight)| weight * x[place]).sum()
    }

    fn add_to(&self, factor: f64, x: &mut [f64]) {
        self.entries.iter().for_each(|&(place, weight)| x[place] += factor * weight);
    }
}

/// The matrix in whose measure steps are projected.
#[derive(Debug, Clone)]
pub(crate) enum Metric {
    Identity,
    /// Reciprocal entries of a diagonal, one per control point.
    Reciprocals(Vec<f64>),
    Factors(Factorization),
}

impl Metric {
    fn solve(&self, x: &mut [f64], dimension: usize) {
        match self {
            Self::Identity => {}
            Self::Reciprocals(factors) => {
                for (vector, factor) in x.chunks_exact_mut(dimension).zip(factors) {
                    vector.iter_mut().for_each(|x| *x *= factor);
                }
            }
            Self::Factors(factors) => factors.solve_in_place(x, dimension),
        }
    }
}

/// A lower triangle, row by row, of a symmetric positive definite matrix.
#[derive(Debug, Clone, Default)]
struct Triangle(Vec<Vec<f64>>);

impl Triangle {
    /// Appends a row of the matrix, its diagonal last; the pivot is returned.
    fn push(&mut self, mut row: Vec<f64>) -> f64 {
        let last = row.len() - 1;
        self.forward(&mut row[..last]);
        let square: f64 = row[..last].iter().map(|x| x * x).sum();
        let pivot = row[last] - square;
        row[last] = pivot.max(0.0).sqrt();
        self.0.push(row);
        pivot
    }

    fn forward(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let known: f64 = self.0[i][..i].iter().zip(&*x).map(|(l, x)| l * x).sum();
            x[i] = (x[i] - known) / self.0[i][i];
        }
    }

    fn backward(&self, x: &mut [f64]) {
        for i in (0..x.len()).rev() {
            x[i] /= self.0[i][i];
            for k in 0..i {
                x[k] -= self.0[i][k] * x[i];
            }
        }
    }
}

/// A pivot, of rows of length 1, below which a row follows from those before it.
const DEPENDENT: f64 = 1e-11;
/// How far, over the size of the values, a row may be from what those before it make of it.
const CONSISTENT: f64 = 1e-9;

/// Rows that are independent: those that follow from others are left out. The owners that
/// contradict each other, if some do.
pub(crate) fn independent(
    rows: Vec<ConstraintRow>,
    size: f64,
) -> Result<Vec<ConstraintRow>, Vec<usize>> {
    let mut kept: Vec<ConstraintRow> = Vec::new();
    let mut triangle = Triangle::default();
    for mut row in rows {
        let length = row.entries.iter().map(|(_, w)| w * w).sum::<f64>().sqrt();
        if length == 0.0 {
            if row.value.abs() > CONSISTENT * size {
                return Err(vec![row.owner]);
            }
            continue;
        }
        row.entries.iter_mut().for_each(|(_, w)| *w /= length);
        row.value /= length;
        let mut products: Vec<f64> = kept.iter().map(|other| product(other, &row)).collect();
        products.push(1.0);
        if triangle.push(products) > DEPENDENT {
            kept.push(row);
            continue;
        }
        let mut shares = triangle.0.pop().unwrap_or_default();
        shares.pop();
        triangle.backward(&mut shares);
        let follows: f64 = kept.iter().zip(&shares).map(|(other, c)| c * other.value).sum();
        if (row.value - follows).abs() > CONSISTENT * size.max(row.value.abs()) {
            let others = kept.iter().zip(&shares).filter(|(_, c)| c.abs() > 1e-6);
            let mut owners: Vec<usize> = others.map(|(other, _)| other.owner).collect();
            owners.push(row.owner);
            owners.sort_unstable();
            owners.dedup();
            return Err(owners);
        }
    }
    Ok(kept)
}

/// Of two rows with rising places.
fn product(a: &ConstraintRow, b: &ConstraintRow) -> f64 {
    let (mut sum, mut k) = (0.0, 0);
    for &(place, weight) in &a.entries {
        while k < b.entries.len() && b.entries[k].0 < place {
            k += 1;
        }
        if k < b.entries.len() && b.entries[k].0 == place {
            sum += weight * b.entries[k].1;
        }
    }
    sum
}

/// Least squares whose steps leave `G P` as it is.
#[derive(Debug)]
pub(crate) struct ConstrainedCollocation<'a> {
    inner: &'a LeastSquaresCollocation,
    rows: Vec<ConstraintRow>,
    metric: Metric,
    /// Of `G M^-1 G^T`.
    schur: Triangle,
    /// Memory for gathered vectors, and for multipliers.
    memory: RefCell<(Vec<f64>, Vec<f64>)>,
}

impl<'a> ConstrainedCollocation<'a> {
    /// For independent rows, of arrays of a length. `None` if `G M^-1 G^T` is singular in doubles.
    pub(crate) fn new(
        inner: &'a LeastSquaresCollocation,
        rows: Vec<ConstraintRow>,
        metric: Metric,
        dimension: usize,
    ) -> Option<Self> {
        let mut x = vec![0.0; inner.stays().len() * dimension];
        let mut schur = Triangle::default();
        for (k, row) in rows.iter().enumerate() {
            x.fill(0.0);
            row.add_to(1.0, &mut x);
            metric.solve(&mut x, dimension);
            let products: Vec<f64> = rows[..=k].iter().map(|other| other.dot(&x)).collect();
            let whole = products[k];
            let pivot = schur.push(products);
            if pivot.is_nan() || pivot <= 1e-14 * whole {
                return None;
            }
        }
        let memory = RefCell::new((x, vec![0.0; rows.len()]));
        Some(Self { inner, rows, metric, schur, memory })
    }

    /// Moves control points, in the measure of the metric as little as can be, to where the rows hold.
    pub(crate) fn make_feasible(&self, control: &mut [f64], dimension: usize) {
        let (x, lambda) = &mut *self.memory.borrow_mut();
        for _ in 0..2 {
            for (l, row) in lambda.iter_mut().zip(&self.rows) {
                *l = row.value - row.dot(control);
            }
            self.schur.forward(lambda);
            self.schur.backward(lambda);
            x.fill(0.0);
            self.rows.iter().zip(&*lambda).for_each(|(row, l)| row.add_to(*l, x));
            self.metric.solve(x, dimension);
            control.iter_mut().zip(&*x).for_each(|(p, x)| *p += x);
        }
    }

    /// How far the rows, each of length 1, are from holding, at most.
    pub(crate) fn residual(&self, control: &[f64]) -> f64 {
        let each = self.rows.iter().map(|row| (row.value - row.dot(control)).abs());
        each.fold(0.0, f64::max)
    }
}

impl CollocationOperator for ConstrainedCollocation<'_> {
    fn points(&self) -> usize {
        self.inner.points()
    }

    fn control_points(&self) -> usize {
        self.inner.control_points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.inner.apply(x, dimension, result);
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let norms = self.inner.difference_vectors(data, control, dimension, result);
        let (x, lambda) = &mut *self.memory.borrow_mut();
        x.copy_from_slice(result);
        self.metric.solve(x, dimension);
        lambda.iter_mut().zip(&self.rows).for_each(|(l, row)| *l = row.dot(x));
        self.schur.forward(lambda);
        self.schur.backward(lambda);
        self.rows.iter().zip(&*lambda).for_each(|(row, l)| row.add_to(-l, result));
        let vectors = result.chunks_exact(dimension).zip(self.inner.column_sums());
        let moving = vectors.zip(self.inner.stays()).filter(|(_, stays)| !**stays);
        let farthest = moving.fold(0.0, |most: f64, ((vector, sum), _)| {
            let square: f64 = vector.iter().map(|x| (x / sum) * (x / sum)).sum();
            if square.is_nan() { f64::NAN } else { most.max(square) }
        });
        ResidualNorms { normal: Some(farthest.sqrt()), ..norms }
    }
}
