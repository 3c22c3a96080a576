//! Anderson-accelerated PIA: each step combines the last few so that the difference vectors they
//! would leave are smallest in the sense of least squares (Anderson 1965; Walker and Ni 2011).
//!
//! With `F_k = Q - A P_k` and the last q differences `dP`, `dF` of control points and difference
//! vectors, `gamma = argmin ||F_k - dF gamma||` and `P_(k+1) = P_k + F_k - (dP + dF) gamma`. On a
//! linear iteration that is, step by step, the method of generalised minimal residuals (GMRES)
//! restarted softly: with a memory as long as there are different eigenvalues it ends in as many
//! steps, however small the smallest eigenvalue.
//!
//! `dF = Z R` is kept factored, columns appended and taken off one by one, so that a step costs
//! 4 q products of arrays. Columns are scaled to length 1; the oldest go while the newest depends on
//! them to rounding.

use super::{Step, UpdateRule};
use crate::memory;

/// A new column less than this share of which is new to the others makes the oldest go.
const INDEPENDENT: f64 = 1e-11;

/// PIA accelerated by the memory of a few steps.
#[derive(Debug, Clone)]
pub struct Anderson {
    memory: usize,
    length: usize,
    /// Columns in use.
    count: usize,
    /// Orthonormal columns Z of `dF`.
    orthonormal: Vec<f64>,
    /// R, row by row.
    triangle: Vec<f64>,
    /// Columns of `dP`, in the places that `order` tells.
    moves: Vec<f64>,
    order: Vec<usize>,
    /// Difference vectors and adjusting vectors of the step before.
    last_vectors: Vec<f64>,
    last_move: Vec<f64>,
    coefficients: Vec<f64>,
    started: bool,
}

impl Anderson {
    /// Remembers up to `memory` steps of arrays of `length` coordinates, points times dimension.
    #[must_use]
    pub fn new(memory: usize, length: usize) -> Self {
        let memory = memory.min(length);
        Self {
            memory,
            length,
            count: 0,
            orthonormal: memory::zeros(memory * length),
            triangle: vec![0.0; memory * memory],
            moves: memory::zeros(memory * length),
            order: (0..memory).collect(),
            last_vectors: memory::zeros(length),
            last_move: memory::zeros(length),
            coefficients: vec![0.0; memory],
            started: false,
        }
    }

    /// The memory for a number of points where none is asked for: 10, or the number of points if
    /// less. On a dense matrix 40, or twice the number of points: more than it has eigenvalues, so
    /// that rounding in the first steps can be made up for.
    #[must_use]
    pub fn default_memory(points: usize, dense: bool) -> usize {
        if dense { points.saturating_mul(2).min(40) } else { points.min(10) }
    }

    fn forget(&mut self) {
        self.count = 0;
        self.started = false;
    }

    /// Appends the difference to the step before.
    fn remember(&mut self, vectors: &[f64]) {
        if self.count == self.memory {
            self.drop_oldest();
        }
        let (length, memory) = (self.length, self.memory);
        loop {
            let column = self.count;
            let (known, rest) = self.orthonormal.split_at_mut(column * length);
            let new = &mut rest[..length];
            for ((x, now), before) in new.iter_mut().zip(vectors).zip(&self.last_vectors) {
                *x = now - before;
            }
            let size = norm(new);
            if !(size > 0.0 && size.is_finite()) {
                return;
            }
            new.iter_mut().for_each(|x| *x /= size);
            (0..column).for_each(|i| self.triangle[i * memory + column] = 0.0);
            // Twice is enough for orthogonality to rounding.
            for _ in 0..2 {
                for (i, z) in known.chunks_exact(length).enumerate() {
                    let part = dot(z, new);
                    self.triangle[i * memory + column] += part;
                    new.iter_mut().zip(z).for_each(|(x, z)| *x -= part * z);
                }
            }
            let left = norm(new);
            if left > INDEPENDENT {
                new.iter_mut().for_each(|x| *x /= left);
                self.triangle[column * memory + column] = left;
                let place = self.order[column] * length;
                let stored = &mut self.moves[place..][..length];
                stored.iter_mut().zip(&self.last_move).for_each(|(x, step)| *x = step / size);
                self.count += 1;
                return;
            }
            if column == 0 {
                return;
            }
            self.drop_oldest();
        }
    }

    /// Takes the first column out of `dF = Z R`: R without it is brought back to a triangle by
    /// rotations of neighbouring rows, and of the columns of Z.
    fn drop_oldest(&mut self) {
        let (length, memory, count) = (self.length, self.memory, self.count);
        for j in 0..count.saturating_sub(1) {
            for i in 0..=j + 1 {
                self.triangle[i * memory + j] = self.triangle[i * memory + j + 1];
            }
        }
        for j in 0..count.saturating_sub(1) {
            let (a, b) = (self.triangle[j * memory + j], self.triangle[(j + 1) * memory + j]);
            let size = a.hypot(b);
            let (c, s) = if size > 0.0 { (a / size, b / size) } else { (1.0, 0.0) };
            for k in j..count - 1 {
                let (x, y) = (self.triangle[j * memory + k], self.triangle[(j + 1) * memory + k]);
                self.triangle[j * memory + k] = c * x + s * y;
                self.triangle[(j + 1) * memory + k] = c * y - s * x;
            }
            let (left, right) = self.orthonormal[j * length..].split_at_mut(length);
            for (x, y) in left.iter_mut().zip(right) {
                (*x, *y) = (c * *x + s * *y, c * *y - s * *x);
            }
        }
        self.order[..count].rotate_left(1);
        self.count = count.saturating_sub(1);
    }

    /// Turns difference vectors into the combined step, in place.
    fn combine(&mut self, vectors: &mut [f64]) {
        let (length, memory, count) = (self.length, self.memory, self.count);
        for (gamma, z) in
            self.coefficients.iter_mut().zip(self.orthonormal.chunks_exact(length)).take(count)
        {
            // What the memory explains goes; what is left is the residual of the combination.
            *gamma = dot(z, vectors);
            vectors.iter_mut().zip(z).for_each(|(x, z)| *x -= *gamma * z);
        }
        for i in (0..count).rev() {
            let row = &self.triangle[i * memory..][..count];
            let known: f64 = (i + 1..count).map(|k| row[k] * self.coefficients[k]).sum();
            self.coefficients[i] = (self.coefficients[i] - known) / row[i];
        }
        for (gamma, &place) in self.coefficients.iter().zip(&self.order).take(count) {
            let moves = &self.moves[place * length..][..length];
            vectors.iter_mut().zip(moves).for_each(|(x, step)| *x -= gamma * step);
        }
    }
}

impl UpdateRule for Anderson {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        if step.iteration == 0 {
            self.forget();
        }
        if self.started && self.memory > 0 {
            self.remember(vectors);
        }
        self.last_vectors.copy_from_slice(vectors);
        self.combine(vectors);
        self.last_move.copy_from_slice(vectors);
        self.started = true;
    }

    fn reset(&mut self) {
        self.forget();
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}
