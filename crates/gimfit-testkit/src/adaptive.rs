//! Adaptive PIA in rounds, as a thesis of 2021 retells it from a paper of 2012.

use crate::dense::{Rows, differences};

/// What a run of adaptive PIA came to.
#[derive(Debug, Clone, PartialEq)]
pub struct Trace {
    /// Steps taken.
    pub steps: usize,
    /// Moves of single control points.
    pub moves: usize,
    /// Largest residual of all points at the end.
    pub residual: f64,
}

/// Runs rounds until none has anything to do. In a round each point moves until it is met. Then points
/// that are not met make up the next round, and those that are met are looked at again later only if
/// the bound on what may happen to them leaves one of them in doubt.
///
/// `shift` takes the columns of the matrix of the moving points so many places too early for the bound, as
/// the program published with the thesis does by 1.
#[must_use]
pub fn adaptive_pia(a: &Rows, q: &Rows, tolerance: f64, shift: usize) -> Trace {
    let mut p = q.clone();
    let mut trace = Trace { steps: 0, moves: 0, residual: 0.0 };
    let norms = |p: &Rows| -> Vec<f64> {
        let left = differences(a, q, p);
        left.iter().map(|row| row.iter().map(|x| x * x).sum::<f64>().sqrt()).collect()
    };
    let mut moving: Vec<usize> = (0..q.len()).collect();
    let mut watched: Vec<usize> = Vec::new();
    while !moving.is_empty() {
        let mut round = moving.clone();
        while !round.is_empty() {
            let left = differences(a, q, &p);
            for &j in &round {
                p[j].iter_mut().zip(&left[j]).for_each(|(p, d)| *p += d);
            }
            trace.steps += 1;
            trace.moves += round.len();
            let residuals = norms(&p);
            round.retain(|&j| residuals[j] >= tolerance);
        }
        let residuals = norms(&p);
        trace.residual = residuals.iter().copied().fold(0.0, f64::max);
        let mut known = [moving, watched].concat();
        known.sort_unstable();
        known.dedup();
        let (next, met): (Vec<usize>, Vec<usize>) =
            known.into_iter().partition(|&j| residuals[j] > tolerance);
        let largest = next.iter().map(|&j| residuals[j]).fold(0.0, f64::max);
        let off = |i: usize, j: usize| {
            (f64::from(u8::from(i == j)) - a[i][j.saturating_sub(shift)]).abs()
        };
        let contraction =
            next.iter().map(|&i| next.iter().map(|&j| off(i, j)).sum::<f64>()).fold(0.0, f64::max);
        let safe = |j: usize| {
            let share: f64 = next.iter().map(|&i| a[j][i].abs()).sum();
            residuals[j] <= tolerance - share * largest / (1.0 - contraction)
        };
        watched = if met.iter().all(|&j| safe(j)) { Vec::new() } else { met };
        moving = next;
    }
    trace
}
