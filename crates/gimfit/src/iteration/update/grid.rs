//! Rules of curves on grids of points: applied to the columns, to the rows, or to both.
//!
//! With a weight matrix in each direction, `P <- P + W_u R W_v^T`: the Kronecker product of two
//! rules, never formed. Its eigenvalues are products, so what converges in each direction with
//! eigenvalues in (0, 1] converges in both (Lin, Wang and Dong 2004, section 2.2, for PIA).

use super::{Step, UpdateRule};
use crate::collocation::NetWeights;

/// A rule that takes each column of a grid for a curve: the rows are its points, of `columns` times
/// the dimension.
#[derive(Debug, Clone)]
pub struct Across<R> {
    rule: R,
    columns: usize,
}

impl<R: UpdateRule> Across<R> {
    /// For grids with this many columns.
    #[must_use]
    pub fn new(rule: R, columns: usize) -> Self {
        Self { rule, columns }
    }
}

impl<R: UpdateRule> UpdateRule for Across<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let wide = Step { dimension: self.columns * step.dimension, ..step };
        self.rule.adjust(wide, vectors);
    }

    fn is_stuck(&self) -> bool {
        self.rule.is_stuck()
    }

    fn reset(&mut self) {
        self.rule.reset();
    }
}

/// A rule that takes each row of a grid for a curve. It must not remember vectors from step to step,
/// since it serves all rows in turn.
#[derive(Debug, Clone)]
pub struct Along<R> {
    rule: R,
    columns: usize,
}

impl<R: UpdateRule> Along<R> {
    /// For grids with this many columns.
    #[must_use]
    pub fn new(rule: R, columns: usize) -> Self {
        Self { rule, columns }
    }
}

impl<R: UpdateRule> UpdateRule for Along<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let length = self.columns * step.dimension;
        let lines = vectors.chunks_exact_mut(length).zip(step.control.chunks_exact(length));
        for (line, control) in lines {
            self.rule.adjust(Step { control, ..step }, line);
        }
    }

    fn is_stuck(&self) -> bool {
        self.rule.is_stuck()
    }

    fn reset(&mut self) {
        self.rule.reset();
    }
}

/// A rule for the columns, then one for the rows.
#[derive(Debug, Clone)]
pub struct Both<U, V> {
    across: Across<U>,
    along: Along<V>,
}

impl<U: UpdateRule, V: UpdateRule> Both<U, V> {
    /// For grids with this many columns.
    #[must_use]
    pub fn new(u: U, v: V, columns: usize) -> Self {
        Self { across: Across::new(u, columns), along: Along::new(v, columns) }
    }
}

impl<U: UpdateRule, V: UpdateRule> UpdateRule for Both<U, V> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        self.across.adjust(step, vectors);
        self.along.adjust(step, vectors);
    }

    fn is_stuck(&self) -> bool {
        self.across.is_stuck() || self.along.is_stuck()
    }

    fn reset(&mut self) {
        self.across.reset();
        self.along.reset();
    }
}

/// A rule made for `A_u (x) A_v`, carried over to the rational `D^-1 (A_u (x) A_v) W`: difference
/// vectors are multiplied by the sums D before it, and divided by the weights W behind it. What it
/// does to eigenvalues does not change with the weights.
#[derive(Debug, Clone)]
pub struct Rescaled<'a, R> {
    rule: R,
    net: &'a NetWeights,
}

impl<'a, R: UpdateRule> Rescaled<'a, R> {
    /// For a net with these weights.
    #[must_use]
    pub fn new(rule: R, net: &'a NetWeights) -> Self {
        Self { rule, net }
    }
}

impl<R: UpdateRule> UpdateRule for Rescaled<'_, R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        for (vector, sum) in vectors.chunks_exact_mut(step.dimension).zip(self.net.sums()) {
            vector.iter_mut().for_each(|x| *x *= sum);
        }
        self.rule.adjust(step, vectors);
        for (vector, w) in vectors.chunks_exact_mut(step.dimension).zip(self.net.weights()) {
            vector.iter_mut().for_each(|x| *x /= w);
        }
    }

    fn is_stuck(&self) -> bool {
        self.rule.is_stuck()
    }

    fn reset(&mut self) {
        self.rule.reset();
    }
}
