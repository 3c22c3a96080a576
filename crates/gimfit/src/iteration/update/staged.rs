//! One rule for the first steps, another for the rest: a gradual family of fits, then the limit.

use super::UpdateRule;

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
    fn adjust(&mut self, iteration: usize, vectors: &mut [f64], dimension: usize) {
        match iteration.checked_sub(self.switch) {
            None => self.first.adjust(iteration, vectors, dimension),
            Some(later) => self.then.adjust(later, vectors, dimension),
        }
    }

    fn reset(&mut self) {
        self.first.reset();
        self.then.reset();
    }
}
