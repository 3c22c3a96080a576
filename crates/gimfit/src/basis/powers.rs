//! Products `t^a (1 - t)^b`, the bricks of the Ball and DP bases, in the Bernstein basis.

/// Adds `factor * t^a (1 - t)^b`, where `a + b <= n`, to Bernstein coefficients of degree n.
///
/// Times `(t + 1 - t)^(n - a - b)` the product has the coefficient `C(n - a - b, j - a) / C(n, j)`
/// at j. Nothing is subtracted.
pub(super) fn add_powers(a: usize, b: usize, factor: f64, coefficients: &mut [f64]) {
    let n = coefficients.len() - 1;
    // At j = a the quotient is 1 / C(n, a); its successors follow by their ratios.
    let mut quotient = factor * (1..=a).map(|k| k as f64 / (n - a + k) as f64).product::<f64>();
    for j in a..=n - b {
        coefficients[j] += quotient;
        // C(r, k + 1) / C(r, k) = (r - k) / (k + 1); C(n, j) / C(n, j + 1) = (j + 1) / (n - j).
        let (left, k) = ((n - a - b - (j - a)) as f64, (j - a) as f64);
        quotient *= left / (k + 1.0) * ((j + 1) as f64 / (n - j).max(1) as f64);
    }
}

/// Writes the mirror image of the first half of rows of coefficients into the second: a symmetric
/// basis has `f_(n - i)(t) = f_i(1 - t)`.
pub(super) fn mirror_rows(coefficients: &mut [f64], count: usize) {
    for i in 0..count / 2 {
        for j in 0..count {
            coefficients[(count - 1 - i) * count + count - 1 - j] = coefficients[i * count + j];
        }
    }
}
