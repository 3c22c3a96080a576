//! Local PIA (Lin 2010): only the control points of chosen data points move.
//!
//! `P_J <- P_J + (Q - B P)_J`: the residual of the chosen set J evolves by `I - B_JJ`. For a
//! normalised totally positive basis `B_JJ` is totally positive again, so that the iteration
//! converges for every J, to control points whose curve interpolates `Q_J`. Any other rule of the
//! matrix `B_JJ` takes the place of plain PIA.

use super::{Step, UpdateCounts, UpdateRule};
use crate::iteration::Termination;

/// A rule among the control points of chosen data points; all others stay.
#[derive(Debug, Clone)]
pub struct Local<R> {
    rule: R,
    points: Vec<usize>,
    /// Difference vectors and control points of the chosen.
    vectors: Vec<f64>,
    control: Vec<f64>,
}

impl<R: UpdateRule> Local<R> {
    /// Runs a rule of `B_JJ` for the ascending positions J, on points of a dimension.
    #[must_use]
    pub fn new(rule: R, points: Vec<usize>, dimension: usize) -> Self {
        let length = points.len() * dimension;
        Self { rule, points, vectors: vec![0.0; length], control: vec![0.0; length] }
    }
}

impl<R: UpdateRule> UpdateRule for Local<R> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let dimension = step.dimension;
        let gather = |from: &[f64], into: &mut [f64]| {
            for (into, &j) in into.chunks_exact_mut(dimension).zip(&self.points) {
                into.copy_from_slice(&from[j * dimension..][..dimension]);
            }
        };
        gather(vectors, &mut self.vectors);
        gather(step.control, &mut self.control);
        self.rule.adjust(Step { control: &self.control, ..step }, &mut self.vectors);
        vectors.fill(0.0);
        for (vector, &j) in self.vectors.chunks_exact(dimension).zip(&self.points) {
            vectors[j * dimension..][..dimension].copy_from_slice(vector);
        }
    }

    fn is_stuck(&self) -> bool {
        self.rule.is_stuck()
    }

    fn ending(&self) -> Option<Termination> {
        self.rule.ending()
    }

    fn ends_itself(&self) -> bool {
        self.rule.ends_itself()
    }

    fn updates(&self) -> Option<UpdateCounts> {
        self.rule.updates()
    }

    fn reset(&mut self) {
        self.rule.reset();
    }
}
