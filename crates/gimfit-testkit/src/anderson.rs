//! Anderson acceleration as the textbook writes it, the least squares by modified Gram-Schmidt over
//! all columns anew in every step.

use crate::dense::{Rows, differences, largest_norm};

/// Largest residual after 0, 1, ..., `steps` steps of type-II Anderson acceleration of PIA with the
/// last `memory` differences, from `P = Q`.
#[must_use]
pub fn anderson_history(a: &Rows, q: &Rows, memory: usize, steps: usize) -> Vec<f64> {
    let dimension = q[0].len();
    let flat = |rows: &Rows| -> Vec<f64> { rows.concat() };
    let rows = |flat: &[f64]| -> Rows { flat.chunks(dimension).map(<[f64]>::to_vec).collect() };
    let mut p = flat(q);
    let mut controls: Vec<Vec<f64>> = Vec::new();
    let mut residuals: Vec<Vec<f64>> = Vec::new();
    let mut history = Vec::new();
    for step in 0..=steps {
        let f = differences(a, q, &rows(&p));
        history.push(largest_norm(&f));
        if step == steps {
            break;
        }
        controls.push(p.clone());
        residuals.push(flat(&f));
        let count = memory.min(step);
        let change = |list: &[Vec<f64>], k: usize| -> Vec<f64> {
            let last = list.len() - 1;
            list[last - k].iter().zip(&list[last - k - 1]).map(|(x, y)| x - y).collect()
        };
        let columns: Vec<Vec<f64>> = (0..count).map(|k| change(&residuals, k)).collect();
        let gamma = least_squares(&columns, &residuals[step]);
        for (i, value) in p.iter_mut().enumerate() {
            *value += residuals[step][i];
        }
        for (k, gamma) in gamma.iter().enumerate() {
            let moved = change(&controls, k);
            for (i, value) in p.iter_mut().enumerate() {
                *value -= gamma * (moved[i] + columns[k][i]);
            }
        }
    }
    history
}

/// The combination of columns nearest to a vector.
fn least_squares(columns: &[Vec<f64>], vector: &[f64]) -> Vec<f64> {
    let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    let count = columns.len();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut triangle = vec![vec![0.0; count]; count];
    for (j, column) in columns.iter().enumerate() {
        let mut rest = column.clone();
        for _ in 0..2 {
            for (i, direction) in basis.iter().enumerate() {
                let part = dot(direction, &rest);
                triangle[i][j] += part;
                rest.iter_mut().zip(direction).for_each(|(x, z)| *x -= part * z);
            }
        }
        triangle[j][j] = dot(&rest, &rest).sqrt();
        basis.push(rest.iter().map(|x| x / triangle[j][j]).collect());
    }
    let mut gamma: Vec<f64> = basis.iter().map(|direction| dot(direction, vector)).collect();
    for i in (0..count).rev() {
        for k in i + 1..count {
            gamma[i] -= triangle[i][k] * gamma[k];
        }
        gamma[i] /= triangle[i][i];
    }
    gamma
}
