//! Blending bases by powers and binomials, as the books print them. Function i of degree n at t.

/// `n! / (k! (n - k)!)`.
#[must_use]
pub fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |value, j| value * (n - j) as f64 / (j + 1) as f64)
}

/// `C(n, i) t^i (1 - t)^(n - i)`.
#[must_use]
pub fn bernstein(n: usize, i: usize, t: f64) -> f64 {
    binomial(n, i) * t.powf(i as f64) * (1.0 - t).powf((n - i) as f64)
}

/// Wang's generalised Ball functions.
#[must_use]
pub fn wang_ball(n: usize, i: usize, t: f64) -> f64 {
    let s = 1.0 - t;
    if n.is_multiple_of(2) {
        let h = n / 2;
        match i {
            _ if i < h => (2.0 * t).powf(i as f64) * s.powf(i as f64 + 2.0),
            _ if i == h => (2.0 * t * s).powf(h as f64),
            _ => (2.0 * s).powf((n - i) as f64) * t.powf((n - i) as f64 + 2.0),
        }
    } else {
        let h = (n - 1) / 2;
        match i {
            _ if i < h => (2.0 * t).powf(i as f64) * s.powf(i as f64 + 2.0),
            _ if i == h => (2.0 * t).powf(h as f64) * s.powf(h as f64 + 1.0),
            _ if i == h + 1 => (2.0 * s).powf(h as f64) * t.powf(h as f64 + 1.0),
            _ => (2.0 * s).powf((n - i) as f64) * t.powf((n - i) as f64 + 2.0),
        }
    }
}

/// Said's generalised Ball functions.
#[must_use]
pub fn said_ball(n: usize, i: usize, t: f64) -> f64 {
    let s = 1.0 - t;
    if n.is_multiple_of(2) && i == n / 2 {
        return binomial(n, i) * t.powf(i as f64) * s.powf(i as f64);
    }
    if 2 * i > n {
        return said_ball(n, n - i, s);
    }
    let h = n / 2;
    binomial(h + i, i) * t.powf(i as f64) * s.powf(h as f64 + 1.0)
}

/// The functions of Delgado and Pena.
#[must_use]
pub fn dp(n: usize, i: usize, t: f64) -> f64 {
    let s = 1.0 - t;
    if i == 0 {
        return s.powf(n as f64);
    }
    if 2 * i > n {
        return dp(n, n - i, s);
    }
    let h = n / 2;
    let rest = 1.0 - t.powf(h as f64 + 1.0) - s.powf(h as f64 + 1.0);
    if 2 * i == n {
        rest
    } else if n % 2 == 1 && i == h {
        t * s.powf(h as f64 + 1.0) + 0.5 * rest
    } else {
        t * s.powf((n - i) as f64)
    }
}

/// `n! / (i! j! k!) u^i v^j w^k` with `i + j + k = n`.
#[must_use]
pub fn triangular([i, j, k]: [usize; 3], [u, v, w]: [f64; 3]) -> f64 {
    let n = i + j + k;
    binomial(n, i) * binomial(n - i, j) * u.powf(i as f64) * v.powf(j as f64) * w.powf(k as f64)
}

/// `n! / ((n - s)! n^s)`, the eigenvalues of Bernstein collocation at `i / n`, s = 0 ..= n.
#[must_use]
pub fn bernstein_eigenvalue(n: usize, s: usize) -> f64 {
    (0..s).map(|k| (n - k) as f64 / n as f64).product()
}
