//! What an iteration carries from step to step; a caller may drive it by hand.

use super::{Step, UpdateRule};
use crate::collocation::{CollocationOperator, ResidualNorms};
use crate::memory;

/// Rounding errors of a row's product, in units of the largest coordinate.
pub const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Control points on their way to the data. After [`IterationState::begin`] and after every
/// [`IterationState::step`] the norms belong to the control points held.
#[derive(Debug)]
pub struct IterationState<'a> {
    operator: &'a dyn CollocationOperator,
    data: &'a [f64],
    dimension: usize,
    start: &'a [f64],
    /// Empty until the first step: before it, the control points are those of the start.
    control: Vec<f64>,
    /// Difference vectors between steps, one per control point; a rule turns them into adjusting
    /// vectors in place.
    vectors: Vec<f64>,
    norms: ResidualNorms,
    iteration: usize,
}

impl<'a> IterationState<'a> {
    /// Starts from the data themselves, `P^0 = Q`: a square iteration. `data` has shape
    /// (points, dimension).
    #[must_use]
    pub fn begin(operator: &'a dyn CollocationOperator, data: &'a [f64], dimension: usize) -> Self {
        Self::begin_at(operator, data, data, dimension)
    }

    /// Starts from given control points, of shape (control points, dimension), which may be fewer
    /// than the data points.
    #[must_use]
    pub fn begin_at(
        operator: &'a dyn CollocationOperator,
        data: &'a [f64],
        start: &'a [f64],
        dimension: usize,
    ) -> Self {
        operator.reset();
        let mut state = Self {
            operator,
            data,
            dimension,
            start,
            control: memory::with_capacity(start.len()),
            vectors: memory::zeros(start.len()),
            norms: ResidualNorms::default(),
            iteration: 0,
        };
        state.measure();
        state
    }

    /// Goes back to the start, reusing all memory.
    pub fn restart(&mut self) {
        self.control.clear();
        self.iteration = 0;
        self.operator.reset();
        self.measure();
    }

    /// One step: adjusting vectors from the rule, added to the control points; then the new
    /// difference vectors. Allocates nothing.
    pub fn step(&mut self, rule: &mut dyn UpdateRule) {
        let control = if self.control.is_empty() { self.start } else { &self.control };
        let step = Step { iteration: self.iteration, control, dimension: self.dimension };
        rule.adjust(step, &mut self.vectors);
        if self.control.is_empty() {
            self.control.extend(self.start.iter().zip(&self.vectors).map(|(q, delta)| q + delta));
        } else {
            self.control.iter_mut().zip(&self.vectors).for_each(|(p, delta)| *p += delta);
        }
        self.iteration += 1;
        self.measure();
    }

    fn measure(&mut self) {
        let control = if self.control.is_empty() { self.start } else { &self.control };
        self.norms =
            self.operator.difference_vectors(self.data, control, self.dimension, &mut self.vectors);
    }

    /// Residual that rounding alone may leave: 8 units in the last place of the largest coordinate
    /// of a control point.
    #[must_use]
    pub fn rounding_level(&self) -> f64 {
        // Several running maxima, so that none waits for the one before.
        let mut most = [0.0; 8];
        let (chunks, rest) = self.control().as_chunks::<8>();
        for chunk in chunks {
            (0..8).for_each(|k| most[k] = f64::max(most[k], chunk[k].abs()));
        }
        ROUNDING * most.iter().chain(rest).fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    /// Steps taken.
    #[must_use]
    pub fn iteration(&self) -> usize {
        self.iteration
    }

    /// Norms of the difference vectors of the control points held.
    #[must_use]
    pub fn norms(&self) -> ResidualNorms {
        self.norms
    }

    /// The control points held, shape (points, dimension).
    #[must_use]
    pub fn control(&self) -> &[f64] {
        if self.control.is_empty() { self.start } else { &self.control }
    }

    /// Their difference vectors, shape (control points, dimension): of least squares those gathered at
    /// the control points.
    #[must_use]
    pub fn difference_vectors(&self) -> &[f64] {
        &self.vectors
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Control points and difference vectors, by value.
    #[must_use]
    pub fn into_parts(mut self) -> (Vec<f64>, Vec<f64>) {
        if self.control.is_empty() {
            self.control.extend_from_slice(self.start);
        }
        (self.control, self.vectors)
    }
}
