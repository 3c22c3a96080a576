//! One rule for the first steps, another for the rest: a gradual family of fits, then the limit.

use super::{Step, UpdateRule};
use crate::iteration::Termination;

/// Runs `first` for a number of steps, then `then`.
#[derive(Debug)]
pub struct Staged<A, B> {
    first: A,
    then: B,
    switch: usize,
}

impl<A: UpdateRule, B: UpdateRule> Staged<A, B> {
    /// Switches after `switch` steps.
    #[must_use]
    pub fn new(first: A, switch: usize, then: B) -> Self {
        Self { first, then, switch }
    }
}

impl<A: UpdateRule, B: UpdateRule> UpdateRule for Staged<A, B> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        match step.iteration.checked_sub(self.switch) {
            None => self.first.adjust(step, vectors),
            Some(iteration) => self.then.adjust(Step { iteration, ..step }, vectors),
        }
    }

    fn is_stuck(&self) -> bool {
        self.then.is_stuck()
    }

    fn ending(&self) -> Option<Termination> {
        self.then.ending()
    }

    fn ends_itself(&self) -> bool {
        self.then.ends_itself()
    }

    fn reset(&mut self) {
        self.first.reset();
        self.then.reset();
    }
}
