//! Collocation seen by chosen points only: the operator of local PIA.

use super::banded::norms_of;
use super::{BandedCollocation, CollocationOperator, ResidualNorms};

/// An operator whose difference vectors are kept at chosen points and are zero at all others, so that
/// the loop moves the control points of the former only, and judges by them only (Lin 2010).
#[derive(Debug)]
pub struct LocalCollocation<'a> {
    operator: &'a dyn CollocationOperator,
    /// Whether a point is chosen, one per row.
    chosen: Vec<bool>,
    count: usize,
}

impl<'a> LocalCollocation<'a> {
    /// Looks at an operator through chosen points, given by position; positions beyond its rows are
    /// passed over.
    #[must_use]
    pub fn new(operator: &'a dyn CollocationOperator, points: &[usize]) -> Self {
        let mut chosen = vec![false; operator.points()];
        for &j in points {
            if let Some(place) = chosen.get_mut(j) {
                *place = true;
            }
        }
        let count = chosen.iter().filter(|chosen| **chosen).count();
        Self { operator, chosen, count }
    }

    /// The difference vectors of all points, with the norms of those that are not chosen.
    pub fn outside(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.operator.difference_vectors(data, control, dimension, result);
        let others = self.chosen.len() - self.count;
        norms_of(result, dimension, others, |j| !self.chosen[j])
    }
}

impl CollocationOperator for LocalCollocation<'_> {
    fn points(&self) -> usize {
        self.operator.points()
    }

    fn control_points(&self) -> usize {
        self.operator.control_points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.operator.apply(x, dimension, result);
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.operator.difference_vectors(data, control, dimension, result);
        let vectors = result.chunks_exact_mut(dimension).zip(&self.chosen);
        vectors.filter(|(_, chosen)| !**chosen).for_each(|(vector, _)| vector.fill(0.0));
        norms_of(result, dimension, self.count, |j| self.chosen[j])
    }
}

impl BandedCollocation {
    /// The rows and columns of the positions `points`, in ascending order, each once: the matrix
    /// `B_JJ` of local PIA. That of a totally positive matrix is totally positive again.
    #[must_use]
    pub fn restricted(&self, points: &[usize]) -> Self {
        let all = self.rows();
        let mut points: Vec<usize> = points.iter().copied().filter(|&j| j < all.columns).collect();
        points.sort_unstable();
        points.dedup();
        let width = all.width.min(points.len().max(1));
        let mut place = vec![usize::MAX; all.columns];
        points.iter().enumerate().for_each(|(new, &old)| place[old] = new);
        let count = points.len() as i32;
        let mut first = Vec::with_capacity(points.len());
        let mut weights = vec![0.0; points.len() * width];
        for (new, &old) in points.iter().enumerate() {
            let row = &mut weights[new * width..][..width];
            let kept = self.signed_row(old).filter_map(|(column, weight)| {
                let at = place[all.column(column, 0)];
                // Unwrapped as the old column is.
                let laps = column.div_euclid(all.columns as i32);
                (at != usize::MAX).then_some((at as i32 + laps * count, weight))
            });
            let mut start = None;
            for (column, weight) in kept {
                let start = *start.get_or_insert(column);
                row[(column - start) as usize] = weight;
            }
            first.push(start.unwrap_or(new as i32));
        }
        // Rows that end at the last column start early enough not to wrap round it.
        for (first, row) in first.iter_mut().zip(weights.chunks_exact_mut(width)) {
            let surplus = *first + width as i32 - count;
            let empty = row.iter().rev().take_while(|weight| **weight == 0.0).count() as i32;
            let back = surplus.clamp(0, empty);
            row.rotate_right(back as usize);
            *first -= back;
        }
        Self::from_rows(width, first, weights)
    }
}

/// An operator among control points that move while others are held: what those add to the curve or
/// surface is taken off the data beforehand, so that the start stays the data themselves.
#[derive(Debug)]
pub(crate) struct HeldCollocation<'a> {
    operator: Box<dyn CollocationOperator + 'a>,
    /// The data less what is held.
    target: &'a [f64],
}

impl<'a> HeldCollocation<'a> {
    /// `target` has a point per row.
    pub(crate) fn new(operator: Box<dyn CollocationOperator + 'a>, target: &'a [f64]) -> Self {
        Self { operator, target }
    }
}

impl CollocationOperator for HeldCollocation<'_> {
    fn points(&self) -> usize {
        self.operator.points()
    }

    fn control_points(&self) -> usize {
        self.operator.control_points()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.operator.apply(x, dimension, result);
    }

    fn difference_vectors(
        &self,
        _: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        self.operator.difference_vectors(self.target, control, dimension, result)
    }
}
