//! Randomised columns (RPIA, Wu and Liu 2024): control points are drawn one by one, those with more
//! data more often, and each moves to where it is best while all others stay: randomised coordinate
//! descent (Leventhal and Lewis 2010).
//!
//! A step of the loop draws as many control points as there are. A draw of i, with probability
//! `||a_i||^2 / ||A||_F^2` for the column `a_i` of A, adds `a_i^T R / ||a_i||^2` to `P_i`; how gradients
//! change is read off row i of the normal matrix, so that no data point is looked at.

use super::{Step, UpdateRule};
use crate::collocation::{CollocationMatrix, NormalMatrix};
use crate::iteration::random::{Draw, Random};
use crate::memory;

/// Single control points in random order.
#[derive(Debug, Clone)]
pub struct RandomColumns<'a> {
    normal: &'a NormalMatrix,
    diagonal: Vec<f64>,
    draw: Draw,
    random: Random,
    gradients: Vec<f64>,
}

impl<'a> RandomColumns<'a> {
    /// Draws from a seed; the same seed draws the same.
    #[must_use]
    pub fn new(normal: &'a NormalMatrix, dimension: usize, seed: u64) -> Self {
        let matrix = normal.matrix();
        let count = normal.stays().len();
        let diagonal: Vec<f64> =
            (0..count).map(|i| if normal.stays()[i] { 0.0 } else { matrix.diagonal(i) }).collect();
        Self {
            normal,
            draw: Draw::new(&diagonal),
            diagonal,
            random: Random::new(seed),
            gradients: memory::zeros(count * dimension),
        }
    }
}

impl UpdateRule for RandomColumns<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let dimension = step.dimension;
        self.gradients.copy_from_slice(vectors);
        vectors.fill(0.0);
        for _ in 0..self.diagonal.len() {
            let Some(i) = self.draw.next(&mut self.random) else { return };
            let weight = self.diagonal[i].recip();
            for c in 0..dimension {
                let moved = weight * self.gradients[i * dimension + c];
                vectors[i * dimension + c] += moved;
                self.normal.matrix().row(i).for_each(|(column, entry)| {
                    self.gradients[column * dimension + c] -= entry * moved;
                });
            }
        }
    }

    fn reset(&mut self) {
        self.random.reset();
    }
}
