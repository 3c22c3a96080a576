//! The B-spline basis by its recursive definition (de Boor 1972; Cox 1972).

/// `B_(i, p)(t)` over the knots `u`, by recursion; quotients 0/0 count as 0. The end of the last
/// span that is not empty belongs to it.
#[must_use]
pub fn basis_function(u: &[f64], p: usize, i: usize, t: f64) -> f64 {
    if p == 0 {
        let inside = u[i] <= t && t < u[i + 1];
        let domain_end = u[u.len() - 1];
        let at_end = t == domain_end && u[i] < u[i + 1] && u[i + 1] == domain_end;
        return f64::from(u8::from(inside || at_end));
    }
    let part = |weight: f64, length: f64, j: usize| {
        if length > 0.0 { weight / length * basis_function(u, p - 1, j, t) } else { 0.0 }
    };
    part(t - u[i], u[i + p] - u[i], i) + part(u[i + p + 1] - t, u[i + p + 1] - u[i + 1], i + 1)
}

/// The derivative of `B_(i, p)` at `t`, from functions of degree `p - 1` (de Boor 1978).
#[must_use]
pub fn basis_derivative(u: &[f64], p: usize, i: usize, t: f64) -> f64 {
    let part = |length: f64, j: usize| {
        if length > 0.0 { p as f64 / length * basis_function(u, p - 1, j, t) } else { 0.0 }
    };
    part(u[i + p] - u[i], i) - part(u[i + p + 1] - u[i + 1], i + 1)
}

/// The point of a curve, from the definition; `control` holds a row per control point.
#[must_use]
pub fn curve_point(u: &[f64], p: usize, control: &[Vec<f64>], t: f64) -> Vec<f64> {
    let mut point = vec![0.0; control[0].len()];
    for (i, row) in control.iter().enumerate() {
        let weight = basis_function(u, p, i, t);
        for (x, c) in point.iter_mut().zip(row) {
            *x += weight * c;
        }
    }
    point
}

/// The point of a rational curve, from the definition; `weights` holds one per control point.
#[must_use]
pub fn rational_curve_point(
    u: &[f64],
    p: usize,
    control: &[Vec<f64>],
    weights: &[f64],
    t: f64,
) -> Vec<f64> {
    let lifted: Vec<Vec<f64>> = control
        .iter()
        .zip(weights)
        .map(|(row, w)| row.iter().map(|x| w * x).chain([*w]).collect())
        .collect();
    let mut point = curve_point(u, p, &lifted, t);
    let sum = point.pop().unwrap_or(1.0);
    point.iter().map(|x| x / sum).collect()
}

/// The collocation matrix `[B_i(t_j)]`, a row per parameter.
#[must_use]
pub fn collocation_matrix(u: &[f64], p: usize, parameters: &[f64]) -> Vec<Vec<f64>> {
    let n = u.len() - p - 1;
    parameters.iter().map(|&t| (0..n).map(|i| basis_function(u, p, i, t)).collect()).collect()
}

/// Averaged knots of an open curve (The NURBS Book, eq. 9.8).
#[must_use]
pub fn averaged_knots(p: usize, t: &[f64]) -> Vec<f64> {
    let last = t.len() - 1;
    let mut u = vec![t[0]; p + 1];
    for j in 1..=last - p {
        u.push((j..j + p).map(|i| t[i]).sum::<f64>() / p as f64);
    }
    u.extend(vec![t[last]; p + 1]);
    u
}

/// The collocation matrix of a closed curve over averaged knots: function `i` starts at the mean of the
/// `p` parameters before parameter `i`, and is met in every round.
#[must_use]
pub fn closed_collocation_matrix(p: usize, t: &[f64], period: f64) -> Vec<Vec<f64>> {
    let n = t.len() as isize;
    let round = |j: isize| t[j.rem_euclid(n) as usize] + j.div_euclid(n) as f64 * period;
    let knot = |i: isize| (i - p as isize..i).map(round).sum::<f64>() / p as f64;
    let mut rows = vec![vec![0.0; t.len()]; t.len()];
    for i in -2 * n..3 * n {
        let knots: Vec<f64> = (i..=i + p as isize + 1).map(knot).collect();
        for (row, &t) in rows.iter_mut().zip(t) {
            if knots[0] <= t && t <= knots[p + 1] {
                row[i.rem_euclid(n) as usize] += basis_function(&knots, p, 0, t);
            }
        }
    }
    rows
}

/// Cumulated chord lengths on [0, 1].
#[must_use]
pub fn chord_parameters(points: &[Vec<f64>]) -> Vec<f64> {
    let chord =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| (y - x).powi(2)).sum::<f64>().sqrt();
    let mut t = vec![0.0];
    for pair in points.windows(2) {
        t.push(t[t.len() - 1] + chord(&pair[0], &pair[1]));
    }
    let total = t[t.len() - 1];
    t.iter().map(|x| x / total).collect()
}
