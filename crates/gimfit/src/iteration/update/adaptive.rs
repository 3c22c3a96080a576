//! Adaptive PIA (Lin 2012): control points whose data points are met, and stay met, no longer move.
//!
//! With I the points that still move, D the largest of their residuals and `B_I` their matrix, all
//! moves to come add up to at most `D / (1 - ||I - B_I||_inf)`, if that norm is below 1. So a point
//! whose residual is at most `eps - ||L_j||_inf D / (1 - ||I - B_I||_inf)`, where `L_j` is its row
//! over I, stays within `eps` whatever comes, and is frozen for good.
//!
//! The bound is seldom enough: as long as a neighbour is not met, `D` exceeds `eps`, and from degree 4
//! on the norm is 1 or more. So points within half of `eps` are frozen as measured, too, and woken
//! once their residual exceeds `eps`; after many awakenings none is frozen any more, which is plain
//! PIA, so that the iteration ends.

use super::{Step, UpdateCounts, UpdateRule};
use crate::collocation::CollocationMatrix;

/// Share of the residual aimed at below which a point is frozen without proof.
const MEASURED_SHARE: f64 = 0.5;
/// Steps in which points were woken, after which none is frozen any more.
const MOST_AWAKENINGS: usize = 200;

/// The collocation matrix of a curve, or the pair that makes a surface's.
#[derive(Debug, Clone, Copy)]
pub enum AdaptiveRows<'a> {
    /// Of a curve.
    Curve(&'a dyn CollocationMatrix),
    /// Of a grid, in both directions.
    Grid([&'a dyn CollocationMatrix; 2]),
}

impl AdaptiveRows<'_> {
    fn points(&self) -> usize {
        match self {
            Self::Curve(matrix) => matrix.points(),
            Self::Grid([u, v]) => u.points() * v.points(),
        }
    }

    /// Visits column and weight of each entry of row `j`.
    fn visit(&self, j: usize, visit: &mut dyn FnMut(usize, f64)) {
        match self {
            Self::Curve(matrix) => matrix.visit_row(j, visit),
            Self::Grid([u, v]) => {
                let columns = v.points();
                u.visit_row(j / columns, &mut |row, across| {
                    v.visit_row(j % columns, &mut |column, along| {
                        visit(row * columns + column, across * along);
                    });
                });
            }
        }
    }
}

/// Progressive-iterative approximation that leaves alone what is done.
#[derive(Debug, Clone)]
pub struct Adaptive<'a> {
    rows: AdaptiveRows<'a>,
    residual: f64,
    moves: Vec<bool>,
    /// Sum over the moving columns of each moving row, and whether the bound exists.
    sums: Vec<f64>,
    contraction: f64,
    stale: bool,
    awakenings: usize,
    done: usize,
    saved: usize,
}

impl<'a> Adaptive<'a> {
    /// For a residual to be reached, in the unit of the difference vectors.
    #[must_use]
    pub fn new(rows: AdaptiveRows<'a>, residual: f64) -> Self {
        let points = rows.points();
        Self {
            rows,
            residual,
            moves: vec![true; points],
            sums: vec![0.0; points],
            contraction: 0.0,
            stale: true,
            awakenings: 0,
            done: 0,
            saved: 0,
        }
    }

    /// `||I - B_I||_inf` and the row sums over I. Both shrink with I, so that what was proved for a
    /// larger set holds.
    fn measure_rows(&mut self) {
        self.contraction = 0.0;
        for j in (0..self.moves.len()).filter(|&j| self.moves[j]) {
            let (mut sum, mut diagonal) = (0.0, 0.0);
            self.rows.visit(j, &mut |column, weight| {
                if self.moves[column] {
                    sum += weight;
                }
                if column == j {
                    diagonal += weight;
                }
            });
            self.sums[j] = sum;
            self.contraction = self.contraction.max((1.0 - diagonal) + (sum - diagonal));
        }
        self.stale = false;
    }

    /// Wakes the points that are no longer met.
    fn wake(&mut self, vectors: &[f64], dimension: usize) {
        let mut woken = false;
        for (moves, vector) in self.moves.iter_mut().zip(vectors.chunks_exact(dimension)) {
            if !*moves && length(vector) > self.residual {
                *moves = true;
                woken = true;
            }
        }
        self.stale |= woken;
        self.awakenings += usize::from(woken);
    }

    /// Freezes the points that are met, and stay so or are well within.
    fn freeze(&mut self, vectors: &[f64], dimension: usize) {
        if self.stale {
            self.measure_rows();
        }
        let moving = vectors.chunks_exact(dimension).zip(&self.moves).filter(|(_, moves)| **moves);
        let largest = moving.map(|(vector, _)| length(vector)).fold(0.0, f64::max);
        let proof = (self.contraction < 1.0).then(|| largest / (1.0 - self.contraction));
        for (j, vector) in vectors.chunks_exact(dimension).enumerate() {
            let proved = proof.map_or(0.0, |to_come| self.residual - self.sums[j] * to_come);
            let allowed = proved.max(MEASURED_SHARE * self.residual);
            if self.moves[j] && length(vector) <= allowed {
                self.moves[j] = false;
                self.stale = true;
            }
        }
    }
}

impl UpdateRule for Adaptive<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let dimension = step.dimension;
        self.wake(vectors, dimension);
        if self.awakenings < MOST_AWAKENINGS {
            self.freeze(vectors, dimension);
        } else {
            self.moves.fill(true);
        }
        for (vector, moves) in vectors.chunks_exact_mut(dimension).zip(&self.moves) {
            if *moves {
                self.done += 1;
            } else {
                self.saved += 1;
                vector.fill(0.0);
            }
        }
    }

    fn updates(&self) -> Option<UpdateCounts> {
        Some(UpdateCounts { done: self.done, saved: self.saved })
    }

    fn reset(&mut self) {
        self.moves.fill(true);
        (self.stale, self.awakenings, self.done, self.saved) = (true, 0, 0, 0);
    }
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
