//! Rules of curves on grids of points: applied to the columns, to the rows, or to both.
//!
//! With a weight matrix in each direction, `P <- P + W_u R W_v^T`: the Kronecker product of two
//! rules, never formed. Its eigenvalues are products, so what converges in each direction with
//! eigenvalues in (0, 1] converges in both (Lin, Wang and Dong 2004, section 2.2, for PIA).

use super::{Step, UpdateRule};

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
