//! Dense linear algebra and the iterations as the papers write them, with full matrices.

/// Rows of a full matrix, or points.
pub type Rows = Vec<Vec<f64>>;

/// `A x`.
#[must_use]
pub fn multiply(a: &Rows, x: &Rows) -> Rows {
    let dimension = x[0].len();
    a.iter()
        .map(|row| (0..dimension).map(|c| row.iter().zip(x).map(|(a, x)| a * x[c]).sum()).collect())
        .collect()
}

/// `A^-1 x` by Gaussian elimination with row pivoting.
#[must_use]
pub fn solve(a: &Rows, x: &Rows) -> Rows {
    let n = a.len();
    let mut work: Rows = a.iter().zip(x).map(|(a, x)| [a.clone(), x.clone()].concat()).collect();
    for k in 0..n {
        let pivot =
            (k..n).max_by(|&i, &j| work[i][k].abs().total_cmp(&work[j][k].abs())).unwrap_or(k);
        work.swap(k, pivot);
        let head = work[k].clone();
        for row in work.iter_mut().skip(k + 1) {
            let factor = row[k] / head[k];
            for (r, h) in row.iter_mut().zip(&head) {
                *r -= factor * h;
            }
        }
    }
    for k in (0..n).rev() {
        let pivot = work[k][k];
        work[k].iter_mut().for_each(|x| *x /= pivot);
        let tail = work[k].clone();
        for row in work.iter_mut().take(k) {
            let factor = row[k];
            for (r, t) in row.iter_mut().zip(&tail) {
                *r -= factor * t;
            }
        }
    }
    work.iter().map(|row| row[n..].to_vec()).collect()
}

/// Difference vectors `Q - A P`.
#[must_use]
pub fn differences(a: &Rows, q: &Rows, p: &Rows) -> Rows {
    let ap = multiply(a, p);
    q.iter().zip(&ap).map(|(q, y)| q.iter().zip(y).map(|(q, y)| q - y).collect()).collect()
}

/// Largest Euclidean norm of a row.
#[must_use]
pub fn largest_norm(rows: &Rows) -> f64 {
    rows.iter().map(|r| r.iter().map(|x| x * x).sum::<f64>().sqrt()).fold(0.0, f64::max)
}

/// A step of an iteration: the new control points from the matrix, the data and the old ones.
pub type Step = fn(&Rows, &Rows, &Rows) -> Rows;

/// `P + Q - A P`.
#[must_use]
pub fn pia_step(a: &Rows, q: &Rows, p: &Rows) -> Rows {
    let r = differences(a, q, p);
    p.iter().zip(&r).map(|(p, r)| p.iter().zip(r).map(|(p, r)| p + r).collect()).collect()
}

/// `P_j + (Q - A P)_j` for the chosen `j`; all others stay (Lin 2010).
#[must_use]
pub fn local_pia_step(a: &Rows, q: &Rows, p: &Rows, chosen: &[usize]) -> Rows {
    let moved = pia_step(a, q, p);
    let each = moved.into_iter().zip(p).enumerate();
    each.map(|(j, (moved, stays))| if chosen.contains(&j) { moved } else { stays.clone() })
        .collect()
}

/// The Kronecker product of two matrices.
#[must_use]
pub fn kronecker(a: &Rows, b: &Rows) -> Rows {
    let row = |x: &[f64], y: &[f64]| x.iter().flat_map(|x| y.iter().map(move |y| x * y)).collect();
    a.iter().flat_map(|x| b.iter().map(move |y| row(x, y))).collect()
}

/// `P_i + (Q - A P)_i / A_ii`, all at once.
#[must_use]
pub fn jacobi_step(a: &Rows, q: &Rows, p: &Rows) -> Rows {
    let r = differences(a, q, p);
    (0..p.len()).map(|i| p[i].iter().zip(&r[i]).map(|(p, r)| p + r / a[i][i]).collect()).collect()
}

/// The same, one control point after another, each seeing those moved before.
#[must_use]
pub fn gauss_seidel_step(a: &Rows, q: &Rows, p: &Rows) -> Rows {
    let mut p = p.clone();
    for i in 0..p.len() {
        for c in 0..p[i].len() {
            let value: f64 = a[i].iter().zip(&p).map(|(a, p)| a * p[c]).sum();
            p[i][c] += (q[i][c] - value) / a[i][i];
        }
    }
    p
}

/// Largest residual after 0, 1, ..., `steps` steps from `P = Q`.
#[must_use]
pub fn residual_history(a: &Rows, q: &Rows, step: Step, steps: usize) -> Vec<f64> {
    let mut p = q.clone();
    let mut history = vec![largest_norm(&differences(a, q, &p))];
    for _ in 0..steps {
        p = step(a, q, &p);
        history.push(largest_norm(&differences(a, q, &p)));
    }
    history
}
