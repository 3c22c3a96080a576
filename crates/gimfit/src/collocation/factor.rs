//! Factors of a collocation matrix: the preconditioner of preconditioned PIA, and the way to its
//! smallest eigenvalue.

use super::bordered::BorderedFactors;
use super::dense_factor::DenseFactors;
use super::folded::FoldedFactors;
use super::kernel::Rows;
use super::{BandedCollocation, CollocationOperator};
use crate::Error;

/// Factors `M = L U` of a collocation matrix.
#[derive(Debug, Clone)]
pub struct Factorization {
    points: usize,
    factors: Factors,
}

#[derive(Debug, Clone)]
enum Factors {
    /// Fast: no pivoting, which totally positive matrices do not need.
    Bordered(BorderedFactors),
    /// Safe: partial pivoting, for closed curves whose matrix without its wrapped part is badly
    /// conditioned though the whole is not.
    Folded(FoldedFactors),
    /// Of a matrix without a band.
    Dense(DenseFactors),
}

impl Factorization {
    /// Factors a band, open or closed.
    pub(super) fn of_band(operator: &BandedCollocation) -> Result<Self, Error> {
        let (reach, wrapped) = reach(operator.rows());
        let points = operator.points();
        let factors = match BorderedFactors::new(operator, reach, wrapped) {
            Some(factors) => Factors::Bordered(factors),
            None => FoldedFactors::new(operator, reach)
                .map(Factors::Folded)
                .ok_or(Error::Singular { points })?,
        };
        Ok(Self { points, factors })
    }

    /// Factors another band of as many rows in place of this one; false if that is singular. Open
    /// curves need new memory once at most.
    pub(super) fn renew(&mut self, operator: &BandedCollocation) -> bool {
        let (reach, wrapped) = reach(operator.rows());
        match &mut self.factors {
            Factors::Bordered(factors) if wrapped == 0 => factors.renew(operator, reach),
            _ => Self::of_band(operator).map(|factors| *self = factors).is_ok(),
        }
    }

    /// Factors a dense matrix, row by row; `None` if it is singular.
    pub(super) fn of_dense(points: usize, matrix: Vec<f64>) -> Option<Self> {
        Some(Self { points, factors: Factors::Dense(DenseFactors::new(points, matrix)?) })
    }

    /// Whether they are those of a matrix without a band.
    pub(super) fn is_dense(&self) -> bool {
        matches!(self.factors, Factors::Dense(_))
    }

    /// Number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.points
    }

    /// Solves `M x = r` in place for vectors of shape (points, dimension).
    pub fn solve_in_place(&self, vectors: &mut [f64], dimension: usize) {
        match &self.factors {
            Factors::Bordered(factors) => factors.solve_in_place(vectors, dimension),
            Factors::Folded(factors) => factors.solve_in_place(vectors, dimension),
            Factors::Dense(factors) => factors.solve_in_place(vectors, dimension),
        }
    }
}

/// How far rows reach from the diagonal, and how far those that wrap round do.
fn reach(rows: Rows<'_>) -> (usize, usize) {
    let columns = rows.columns as i64;
    let (mut reach, mut wrapped) = (0, 0);
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(rows.width));
    for (j, (&first, weights)) in lines.enumerate() {
        let (j, first) = (j as i64, i64::from(first));
        let last = first + weights.len() as i64 - 1;
        // Only a row that could widen the band, or wraps, is looked at closely.
        if (j - first).max(last - j) <= reach && first >= 0 && last < columns {
            continue;
        }
        for (column, _) in (first..).zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let offset = (column - j).abs();
            reach = reach.max(offset);
            if !(0..columns).contains(&column) {
                wrapped = wrapped.max(offset);
            }
        }
    }
    (reach as usize, wrapped as usize)
}
