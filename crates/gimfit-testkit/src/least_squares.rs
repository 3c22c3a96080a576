//! Least squares with full matrices: the solution nearest a start, and the iterations as the papers
//! write them, with a residual that runs along.

use crate::dense::{Rows, differences, multiply};

/// The transposed matrix.
#[must_use]
pub fn transpose(a: &Rows) -> Rows {
    (0..a[0].len()).map(|i| a.iter().map(|row| row[i]).collect()).collect()
}

/// `x + y times factor`.
#[must_use]
pub fn add(x: &Rows, factor: f64, y: &Rows) -> Rows {
    let each = x.iter().zip(y);
    each.map(|(x, y)| x.iter().zip(y).map(|(x, y)| x + factor * y).collect()).collect()
}

/// Rows times one factor each.
#[must_use]
pub fn scale(factors: &[f64], x: &Rows) -> Rows {
    factors.iter().zip(x).map(|(f, row)| row.iter().map(|x| f * x).collect()).collect()
}

fn inner(x: &Rows, y: &Rows) -> f64 {
    x.iter().flatten().zip(y.iter().flatten()).map(|(x, y)| x * y).sum()
}

fn column(x: &Rows, c: usize) -> Rows {
    x.iter().map(|row| vec![row[c]]).collect()
}

/// Sums of the columns of a matrix.
#[must_use]
pub fn column_sums(a: &Rows) -> Vec<f64> {
    transpose(a).iter().map(|column| column.iter().sum()).collect()
}

/// Singular values of a matrix, with `U S` and V: columns are rotated in pairs until all are
/// orthogonal (Hestenes 1958). The first result holds the columns of `U S`, the second those of V.
fn singular(a: &Rows) -> (Rows, Rows) {
    let mut u = transpose(a);
    let n = u.len();
    let mut v: Rows =
        (0..n).map(|i| (0..n).map(|k| f64::from(u8::from(i == k))).collect()).collect();
    let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    for _ in 0..60 {
        let mut largest = 0.0_f64;
        for i in 0..n {
            for k in i + 1..n {
                let (aa, bb, ab) = (dot(&u[i], &u[i]), dot(&u[k], &u[k]), dot(&u[i], &u[k]));
                if ab == 0.0 || ab.abs() < 1e-17 * (aa * bb).sqrt() {
                    continue;
                }
                largest = largest.max(ab.abs() / (aa * bb).sqrt());
                let zeta = (bb - aa) / (2.0 * ab);
                let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
                let c = 1.0 / (1.0 + t * t).sqrt();
                let s = c * t;
                for matrix in [&mut u, &mut v] {
                    let (left, right) = matrix.split_at_mut(k);
                    for (x, y) in left[i].iter_mut().zip(&mut right[0]) {
                        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
                    }
                }
            }
        }
        if largest < 1e-15 {
            break;
        }
    }
    (u, v)
}

/// `A^+ b`, by the singular value decomposition; values below 1e-12 of the largest count as zero.
#[must_use]
pub fn pseudo_inverse_times(a: &Rows, b: &Rows) -> Rows {
    let (us, v) = singular(a);
    let squares: Vec<f64> = us.iter().map(|u| u.iter().map(|x| x * x).sum()).collect();
    let largest = squares.iter().copied().fold(0.0, f64::max);
    let mut result = vec![vec![0.0; b[0].len()]; a[0].len()];
    for ((u, v), &square) in us.iter().zip(&v).zip(&squares) {
        if square <= 1e-24 * largest {
            continue;
        }
        for c in 0..b[0].len() {
            let part: f64 = u.iter().zip(b).map(|(u, b)| u * b[c]).sum::<f64>() / square;
            for (row, v) in result.iter_mut().zip(v) {
                row[c] += part * v;
            }
        }
    }
    result
}

/// Smallest and largest eigenvalue of `A^T A`, zeros left out.
#[must_use]
pub fn extreme_eigenvalues(a: &Rows) -> (f64, f64) {
    let squares = || singular(a).0.into_iter().map(|u| u.iter().map(|x| x * x).sum::<f64>());
    let largest = squares().fold(0.0, f64::max);
    let above = squares().filter(|square| *square > 1e-13 * largest);
    (above.fold(f64::INFINITY, f64::min), largest)
}

/// The least squares solution nearest a start: `P + A^+ (Q - A P)`.
#[must_use]
pub fn nearest_solution(a: &Rows, q: &Rows, start: &Rows) -> Rows {
    add(start, 1.0, &pseudo_inverse_times(a, &differences(a, q, start)))
}

/// Iterates of `P + W A^T (Q - A P)` for a diagonal W: the start, then `steps` more.
#[must_use]
pub fn lspia(a: &Rows, q: &Rows, start: &Rows, weights: &[f64], steps: usize) -> Vec<Rows> {
    let transposed = transpose(a);
    iterate(start, steps, |p| {
        let gradient = multiply(&transposed, &differences(a, q, p));
        add(p, 1.0, &scale(weights, &gradient))
    })
}

fn iterate(start: &Rows, steps: usize, mut step: impl FnMut(&Rows) -> Rows) -> Vec<Rows> {
    let mut list = vec![start.clone()];
    for k in 0..steps {
        let next = step(&list[k]);
        list.push(next);
    }
    list
}

/// Column sweeps: each control point moves to where it is best, times omega, and the residual goes
/// along.
#[must_use]
pub fn column_sweeps(a: &Rows, q: &Rows, start: &Rows, omega: f64, steps: usize) -> Vec<Rows> {
    let columns = transpose(a);
    iterate(start, steps, |p| {
        let mut p = p.clone();
        let mut r = differences(a, q, &p);
        for (i, own) in columns.iter().enumerate() {
            let square: f64 = own.iter().map(|x| x * x).sum();
            for c in 0..p[i].len() {
                let part: f64 = own.iter().zip(&r).map(|(a, r)| a * r[c]).sum();
                let moved = omega * part / square;
                p[i][c] += moved;
                own.iter().zip(&mut r).for_each(|(a, r)| r[c] -= a * moved);
            }
        }
        p
    })
}

/// MLSPIA with its memory variable, one vector per data point, as Huang and Wang (2020) write it, at
/// its optimal weights for eigenvalues of `A^T A` in `[smallest, largest]`.
#[must_use]
pub fn mlspia(
    a: &Rows,
    q: &Rows,
    start: &Rows,
    (smallest, largest): (f64, f64),
    steps: usize,
) -> Vec<Rows> {
    let (s, t) = (largest.sqrt(), smallest.sqrt());
    let omega = 4.0 * s * t / ((s + t) * (s + t));
    let (gamma, nu) = (omega, 1.0 / (s * t));
    let transposed = transpose(a);
    let zero = vec![vec![0.0; q[0].len()]; q.len()];
    let mut memory = add(&zero, omega, &differences(a, q, start));
    iterate(start, steps, |p| {
        let back = multiply(&transposed, &memory);
        let next = add(p, nu, &back);
        let mut new = add(&zero, 1.0 - omega, &memory);
        new = add(&new, -gamma * nu, &multiply(a, &back));
        memory = add(&new, omega, &differences(a, q, p));
        next
    })
}

/// Nesterov's iteration with the gradient taken ahead; `momentum` gives eta for the step number, the
/// gradient where the iteration stands, and its last move.
pub fn nesterov(
    a: &Rows,
    q: &Rows,
    start: &Rows,
    step: f64,
    mut momentum: impl FnMut(usize, f64) -> f64,
    steps: usize,
) -> Vec<Rows> {
    let transposed = transpose(a);
    let gradient = |p: &Rows| multiply(&transposed, &differences(a, q, p));
    let mut list = vec![start.clone()];
    for k in 0..steps {
        let moved =
            if k == 0 { add(start, -1.0, start) } else { add(&list[k], -1.0, &list[k - 1]) };
        let eta = momentum(k, inner(&gradient(&list[k]), &moved));
        let ahead = add(&list[k], eta, &moved);
        let next = add(&ahead, step, &gradient(&ahead));
        list.push(next);
    }
    list
}

/// Chebyshev's iteration on `W A^T A` from its polynomial: the error after k steps is
/// `T_k((theta - W A^T A) / delta) / T_k(theta / delta)` times the first.
#[must_use]
pub fn chebyshev(
    a: &Rows,
    q: &Rows,
    start: &Rows,
    weights: &[f64],
    (low, high): (f64, f64),
    steps: usize,
) -> Vec<Rows> {
    let (theta, delta) = (0.5 * (high + low), 0.5 * (high - low));
    let transposed = transpose(a);
    let limit = nearest_solution(a, q, start);
    let apply = |x: &Rows| {
        let product = scale(weights, &multiply(&transposed, &multiply(a, x)));
        let shifted = add(&product, -theta, x);
        scale(&vec![-1.0 / delta; x.len()], &shifted)
    };
    let first = add(start, -1.0, &limit);
    let mut vectors = vec![first.clone(), apply(&first)];
    let mut numbers = vec![1.0, theta / delta];
    (0..=steps)
        .map(|k| {
            while vectors.len() <= k {
                let last = vectors.len() - 1;
                let twice = scale(&vec![2.0; first.len()], &apply(&vectors[last]));
                vectors.push(add(&twice, -1.0, &vectors[last - 1]));
                numbers.push(2.0 * theta / delta * numbers[last] - numbers[last - 1]);
            }
            add(&limit, 1.0 / numbers[k], &vectors[k])
        })
        .collect()
}

/// CGLS with a diagonal preconditioner, coordinate by coordinate, the residual running along.
#[must_use]
pub fn cgls(a: &Rows, q: &Rows, start: &Rows, preconditioner: &[f64], steps: usize) -> Vec<Rows> {
    let transposed = transpose(a);
    let mut list: Vec<Rows> = vec![vec![Vec::new(); start.len()]; steps + 1];
    for c in 0..q[0].len() {
        let mut p = column(start, c);
        let mut r = differences(a, &column(q, c), &p);
        let mut s = multiply(&transposed, &r);
        let mut d = scale(preconditioner, &s);
        let mut gamma = inner(&s, &d);
        for (k, iterate) in list.iter_mut().enumerate() {
            iterate.iter_mut().zip(&p).for_each(|(row, x)| row.push(x[0]));
            if k == steps {
                break;
            }
            let image = multiply(a, &d);
            let alpha = gamma / inner(&image, &image);
            p = add(&p, alpha, &d);
            r = add(&r, -alpha, &image);
            s = multiply(&transposed, &r);
            let z = scale(preconditioner, &s);
            let next = inner(&s, &z);
            d = add(&z, next / gamma, &d);
            gamma = next;
        }
    }
    list
}

/// SaLSPIA of Peng and Li, the sum of squares evaluated anew for every trial.
#[must_use]
pub fn salspia(a: &Rows, q: &Rows, start: &Rows, steps: usize) -> Vec<Rows> {
    let transposed = transpose(a);
    let largest_sum = column_sums(a).into_iter().fold(0.0, f64::max);
    let value = |p: &Rows| {
        let r = differences(a, q, p);
        0.5 * inner(&r, &r)
    };
    let mut before: Option<(Rows, f64)> = None;
    let mut values = Vec::new();
    iterate(start, steps, |p| {
        let gradient = multiply(&transposed, &differences(a, q, p));
        let rho = inner(&gradient, &gradient);
        values.push(value(p));
        let mut x = match &before {
            None => 1.0 / largest_sum,
            Some((old, alpha)) => {
                let (rho_old, zeta) = (inner(old, old), inner(old, &gradient));
                let b = (rho_old - zeta) / alpha;
                let c = (rho_old - 2.0 * zeta + rho) / (alpha * alpha);
                let mu = b / (largest_sum * rho_old);
                let m = (1.0 - mu.clamp(0.0, 1.0)).max(1e-8);
                let (quadratic, linear) = ((1.0 - m) * c, (2.0 * m - 1.0) * b);
                ((linear * linear + 4.0 * quadratic * m * rho_old).sqrt() - linear)
                    / (2.0 * quadratic)
            }
        };
        let from = values.len().saturating_sub(10);
        let ceiling = values[from..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
        while value(&add(p, x, &gradient)) > ceiling - 1e-4 * x * rho {
            x *= 0.5;
        }
        let next = add(p, x, &gradient);
        before = Some((gradient, x));
        next
    })
}

/// Extended PIA: every control point moves by the mean of the difference vectors of its group.
#[must_use]
pub fn extended(a: &Rows, q: &Rows, start: &Rows, steps: usize) -> Vec<Rows> {
    let groups: Vec<usize> = a
        .iter()
        .map(|row| (0..row.len()).fold(0, |best, i| if row[i] > row[best] { i } else { best }))
        .collect();
    iterate(start, steps, |p| {
        let r = differences(a, q, p);
        let mut next = p.clone();
        for (i, point) in next.iter_mut().enumerate() {
            let own: Vec<&Vec<f64>> =
                r.iter().zip(&groups).filter(|(_, g)| **g == i).map(|(r, _)| r).collect();
            for (c, x) in point.iter_mut().enumerate() {
                if !own.is_empty() {
                    *x += own.iter().map(|r| r[c]).sum::<f64>() / own.len() as f64;
                }
            }
        }
        next
    })
}

/// The least squares fit `min |A P - Q|` with `G x = r`, where x holds the rows of P one after the
/// other, from the Karush-Kuhn-Tucker system as one full matrix.
#[must_use]
pub fn constrained_solution(a: &Rows, q: &Rows, g: &Rows, r: &[f64]) -> Rows {
    let (columns, dimension, demands) = (a[0].len(), q[0].len(), g.len());
    let size = columns * dimension;
    let normal = multiply(&transpose(a), a);
    let right = multiply(&transpose(a), q);
    let mut kkt = vec![vec![0.0; size + demands]; size + demands];
    let mut b = vec![vec![0.0]; size + demands];
    for i in 0..columns {
        for c in 0..dimension {
            for k in 0..columns {
                kkt[i * dimension + c][k * dimension + c] = normal[i][k];
            }
            b[i * dimension + c][0] = right[i][c];
        }
    }
    for (k, (row, value)) in g.iter().zip(r).enumerate() {
        for (i, weight) in row.iter().enumerate() {
            kkt[size + k][i] = *weight;
            kkt[i][size + k] = *weight;
        }
        b[size + k][0] = *value;
    }
    let x = crate::dense::solve(&kkt, &b);
    (0..columns).map(|i| (0..dimension).map(|c| x[i * dimension + c][0]).collect()).collect()
}
