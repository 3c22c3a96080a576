//! Turns of planar polygons in exact arithmetic, convexity-preserving iteration as its paper writes
//! it, and a check that a fit is the closest one that keeps its turns.

use crate::dense::{self, Rows};
use crate::textbook;

/// Sum and rounding error of two numbers.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// Sign of the exact cross product of `b - a` and `c - b`: all products with their rounding errors,
/// summed into an expansion whose parts do not overlap, so that the largest one decides.
#[must_use]
pub fn turn_sign(a: &[f64], b: &[f64], c: &[f64]) -> i32 {
    let products =
        [(b[0], c[1]), (-a[0], c[1]), (a[0], b[1]), (-b[1], c[0]), (a[1], c[0]), (-a[1], b[0])];
    let mut expansion: Vec<f64> = Vec::new();
    for (x, y) in products {
        let product = x * y;
        for mut term in [x.mul_add(y, -product), product] {
            for part in &mut expansion {
                (term, *part) = two_sum(term, *part);
            }
            expansion.push(term);
        }
    }
    let largest = expansion.iter().rev().find(|part| **part != 0.0).copied().unwrap_or(0.0);
    i32::from(largest > 0.0) - i32::from(largest < 0.0)
}

/// The turns of a polygon, one per inner point, or one per point of a closed one, beginning at the
/// second.
#[must_use]
pub fn turn_signs(polygon: &Rows, closed: bool) -> Vec<i32> {
    let n = polygon.len();
    let count = if closed { n } else { n.saturating_sub(2) };
    (0..count)
        .map(|k| turn_sign(&polygon[k], &polygon[(k + 1) % n], &polygon[(k + 2) % n]))
        .collect()
}

/// Three points of a polygon, and the sign with which they are to turn.
pub type Triple = ([usize; 3], i32);

/// The corners that have a sign, as triples.
#[must_use]
pub fn corner_triples(signs: &[i32], points: usize) -> Vec<Triple> {
    let triple = |k: usize| [k, (k + 1) % points, (k + 2) % points];
    (0..signs.len()).filter(|&k| signs[k] != 0).map(|k| (triple(k), signs[k])).collect()
}

/// All triples of up to degree + 1 successive points whose corners have one sign and which are the
/// corners of a convex polygon; and whether no such points but make one.
#[must_use]
pub fn convex_triples(polygon: &Rows, signs: &[i32], degree: usize) -> (Vec<Triple>, bool) {
    let (n, closed) = (polygon.len(), signs.len() == polygon.len());
    let (mut triples, mut all) = (Vec::new(), true);
    for first in 0..signs.len() {
        let most = degree.min(n - 1).min(if closed { n } else { n - 1 - first });
        for last in first + 2..=first + most {
            let sign = signs[first];
            if sign == 0 || (first..last - 1).any(|k| signs[k % n] != sign) {
                break;
            }
            let mut found = Vec::new();
            for a in first..=last {
                for b in a + 1..=last {
                    found.extend((b + 1..=last).map(|c| ([a % n, b % n, c % n], sign)));
                }
            }
            if has_triples(polygon, &found) {
                triples.extend(found);
            } else {
                all = false;
            }
        }
    }
    (triples, all)
}

/// Whether a polygon turns as triples ask for.
#[must_use]
pub fn has_triples(polygon: &Rows, triples: &[Triple]) -> bool {
    triples
        .iter()
        .all(|&([a, b, c], sign)| turn_sign(&polygon[a], &polygon[b], &polygon[c]) == sign)
}

/// How a planar curve bends, as seen at many samples.
#[derive(Debug, Clone)]
pub struct Bends {
    /// Signs of `C' x C''` on the way, none twice in a row.
    pub signs: Vec<i32>,
    /// The angle by which the direction turns from the start to the end.
    pub turning: f64,
}

/// Looks at `samples` places in each knot span of a B-spline curve over the knots `u`, between
/// `u[p]` and the knot as far from the end. What rounding may have made of zero has no sign.
#[must_use]
pub fn bends(u: &[f64], p: usize, control: &Rows, samples: usize) -> Bends {
    // Control points of the derivative, of a curve of degree q over the knots without the outer ones.
    let derived = |u: &[f64], q: usize, control: &Rows| -> Rows {
        let quotient = |i: usize, c: usize| {
            let length = u[i + q + 1] - u[i + 1];
            if length > 0.0 { q as f64 * (control[i + 1][c] - control[i][c]) / length } else { 0.0 }
        };
        (0..control.len() - 1).map(|i| vec![quotient(i, 0), quotient(i, 1)]).collect()
    };
    let at = |u: &[f64], q: usize, control: &Rows, t: f64| -> [f64; 2] {
        let mut point = [0.0; 2];
        for (i, row) in control.iter().enumerate().filter(|(i, _)| u[*i] <= t && t <= u[i + q + 1])
        {
            let weight = textbook::basis_function(u, q, i, t);
            (0..2).for_each(|c| point[c] += weight * row[c]);
        }
        point
    };
    let (u1, u2) = (&u[1..u.len() - 1], &u[2..u.len() - 2]);
    let first = derived(u, p, control);
    let second = derived(u1, p - 1, &first);
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let (mut signs, mut turning, mut before) = (Vec::new(), 0.0, None::<[f64; 2]>);
    for span in u[p..u.len() - p].windows(2).filter(|span| span[0] < span[1]) {
        for k in 0..samples {
            let t = span[0] + (span[1] - span[0]) * (k as f64 + 0.5) / samples as f64;
            let (way, bend) = (at(u1, p - 1, &first, t), at(u2, p - 2, &second, t));
            let size = way[0].hypot(way[1]) * bend[0].hypot(bend[1]);
            let area = cross(way, bend);
            let sign = if area > 1e-10 * size { 1 } else { -i32::from(area < -1e-10 * size) };
            if sign != 0 && signs.last() != Some(&sign) {
                signs.push(sign);
            }
            if let Some(b) = before {
                turning += cross(b, way).atan2(b[0] * way[0] + b[1] * way[1]);
            }
            before = Some(way);
        }
    }
    Bends { signs, turning }
}

/// The angle by which a polygon turns from its first leg to its last; a closed one, to its first.
#[must_use]
pub fn turning(polygon: &Rows, closed: bool) -> f64 {
    let n = polygon.len();
    let leg = |i: usize| [0, 1].map(|c| polygon[(i + 1) % n][c] - polygon[i % n][c]);
    (0..if closed { n } else { n - 2 })
        .map(|k| (leg(k), leg(k + 1)))
        .map(|(a, b)| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1]))
        .sum()
}

/// `p + eps (other - p)`.
fn between(p: &Rows, other: &Rows, eps: f64) -> Rows {
    p.iter()
        .zip(other)
        .map(|(p, o)| p.iter().zip(o).map(|(p, o)| p + eps * (o - p)).collect())
        .collect()
}

/// PIA guarded by Algorithm 1 of Lin, Wang and Dong (2004), from `P = Q`: the shares of the steps
/// taken, and the largest residual before and after each.
#[must_use]
pub fn algorithm_1(a: &Rows, q: &Rows, threshold: f64, steps: usize) -> (Vec<f64>, Vec<f64>) {
    let mut p = q.clone();
    let mut shares = Vec::new();
    let mut history = vec![dense::largest_norm(&dense::differences(a, q, &p))];
    for _ in 0..steps {
        let next = dense::pia_step(a, q, &p);
        let same = |eps: f64| turn_signs(&between(&p, &next, eps), false) == turn_signs(&p, false);
        let far = dense::largest_norm(&dense::differences(a, q, &p));
        let mut share = 1.0;
        if !same(1.0) {
            share = 0.5;
            while !same(share) && share > 1e-300 {
                share /= 2.0;
            }
            let mut other = 1.0;
            while (other - share) * far > threshold && other - share > f64::EPSILON * share {
                let middle = (share + other) / 2.0;
                if same(middle) {
                    share = middle;
                } else {
                    other = middle;
                }
            }
        }
        p = between(&p, &next, share);
        shares.push(share);
        history.push(dense::largest_norm(&dense::differences(a, q, &p)));
    }
    (shares, history)
}

/// How far a planar polygon is from a stationary point of the sum of squares `|Q - A P|^2 / 2` under
/// the condition that no triple changes its sign (Karush, Kuhn and Tucker).
#[derive(Debug, Clone, Copy)]
pub struct Optimality {
    /// What no nonnegative multipliers can balance of the gradient, in units of the gradient.
    pub unbalanced: f64,
    /// Sum of multiplier times turn, in units of the sum of squares.
    pub complementarity: f64,
}

/// Measures [`Optimality`] with the best multipliers, found one by one in many rounds.
#[must_use]
pub fn optimality(a: &Rows, q: &Rows, p: &Rows, triples: &[Triple]) -> Optimality {
    let n = p.len();
    let r = dense::differences(a, q, p);
    // A^T (Q - A P): the way the fit would go if it could.
    let mut rest: Vec<f64> = (0..n)
        .flat_map(|i| (0..2).map(move |c| (i, c)))
        .map(|(i, c)| (0..r.len()).map(|j| a[j][i] * r[j][c]).sum())
        .collect();
    let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (whole, squares) = (norm(&rest), 0.5 * r.iter().flatten().map(|x| x * x).sum::<f64>());
    let corners: Vec<(f64, Vec<f64>)> = triples
        .iter()
        .map(|&([i, j, l], sign)| {
            let s = f64::from(sign);
            let (u, v) =
                ([p[j][0] - p[i][0], p[j][1] - p[i][1]], [p[l][0] - p[j][0], p[l][1] - p[j][1]]);
            let mut gradient = vec![0.0; 2 * n];
            let mut add = |point: usize, x: f64, y: f64| {
                gradient[2 * point] += s * x;
                gradient[2 * point + 1] += s * y;
            };
            add(i, -v[1], v[0]);
            add(j, v[1] + u[1], -v[0] - u[0]);
            add(l, -u[1], u[0]);
            (s * (u[0] * v[1] - u[1] * v[0]), gradient)
        })
        .collect();
    let columns: Vec<Vec<f64>> = corners.iter().map(|(_, gradient)| gradient.clone()).collect();
    let multipliers = nonnegative_least_squares(&columns, &rest);
    for (gradient, z) in columns.iter().zip(&multipliers) {
        rest.iter_mut().zip(gradient).for_each(|(r, g)| *r += z * g);
    }
    let products = corners.iter().zip(&multipliers).map(|((c, _), z)| (c * z).abs());
    Optimality { unbalanced: norm(&rest) / whole, complementarity: products.sum::<f64>() / squares }
}

/// The `z >= 0` that bring `target + sum z_k column_k` closest to zero, by the method of active sets
/// (Lawson and Hanson 1974, chapter 23).
fn nonnegative_least_squares(columns: &[Vec<f64>], target: &[f64]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let lengths: Vec<f64> = columns.iter().map(|c| dot(c, c).sqrt()).collect();
    let columns: Vec<Vec<f64>> =
        columns.iter().zip(&lengths).map(|(c, l)| c.iter().map(|x| x / l).collect()).collect();
    let count = columns.len();
    let mut z = vec![0.0; count];
    let mut free = vec![false; count];
    for _ in 0..20 * count {
        let mut rest = target.to_vec();
        for (column, z) in columns.iter().zip(&z) {
            rest.iter_mut().zip(column).for_each(|(r, c)| *r += z * c);
        }
        // The column that helps most.
        let pull = |k: usize| -dot(&columns[k], &rest);
        let best = (0..count).filter(|&k| !free[k]).max_by(|&a, &b| pull(a).total_cmp(&pull(b)));
        let Some(best) = best.filter(|&k| pull(k) > 1e-12 * dot(target, target).sqrt()) else {
            break;
        };
        free[best] = true;
        loop {
            let list: Vec<usize> = (0..count).filter(|&k| free[k]).collect();
            let normal: Rows = list
                .iter()
                .map(|&a| list.iter().map(|&b| dot(&columns[a], &columns[b])).collect())
                .collect();
            let right: Rows = list.iter().map(|&k| vec![-dot(&columns[k], target)]).collect();
            let wanted = dense::solve(&normal, &right);
            // As far towards it as all stay nonnegative.
            let mut share = 1.0_f64;
            for (&k, w) in list.iter().zip(&wanted) {
                if w[0] <= 0.0 {
                    share = share.min(z[k] / (z[k] - w[0]));
                }
            }
            let mut dropped = false;
            for (&k, w) in list.iter().zip(&wanted) {
                z[k] += share * (w[0] - z[k]);
                if w[0] <= 0.0 && z[k] <= 1e-15 {
                    (z[k], free[k], dropped) = (0.0, false, true);
                }
            }
            if share >= 1.0 || !dropped {
                break;
            }
        }
    }
    z.iter().zip(&lengths).map(|(z, length)| z / length).collect()
}
