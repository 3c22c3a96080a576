//! The quotient rule, on top of what B-splines yield.

use crate::Error;

/// Largest of some weights: they are divided by it, so that no product leaves the range of doubles.
pub(super) fn largest(weights: impl Iterator<Item = f64>) -> f64 {
    weights.fold(0.0, f64::max)
}

/// Turns rows of values and derivatives of basis functions, `weights.len()` to a row, into those of
/// the rational functions `R_i = w_i B_i / sum_l w_l B_l`: from the product `R_i W = w_i B_i`,
/// differentiated k times by Leibniz' rule (The NURBS Book, equation 4.8).
pub(super) fn make_rational(rows: &mut [f64], weights: &[f64]) {
    let width = weights.len();
    let scale = largest(weights.iter().copied());
    let mut sums = Vec::new();
    for k in 0..rows.len() / width {
        let (known, rest) = rows.split_at_mut(k * width);
        let row = &mut rest[..width];
        row.iter_mut().zip(weights).for_each(|(x, w)| *x *= w / scale);
        sums.push(row.iter().sum::<f64>());
        let mut binomial = 1.0;
        for l in 1..=k {
            binomial *= (k + 1 - l) as f64 / l as f64;
            let factor = binomial * sums[l];
            let lower = &known[(k - l) * width..][..width];
            row.iter_mut().zip(lower).for_each(|(x, r)| *x -= factor * r);
        }
        row.iter_mut().for_each(|x| *x /= sums[0]);
    }
}

/// As [`make_rational`] for values alone.
pub(super) fn make_rational_values(values: &mut [f64], weights: &[f64]) {
    let scale = largest(weights.iter().copied());
    values.iter_mut().zip(weights).for_each(|(x, w)| *x *= w / scale);
    let sum: f64 = values.iter().sum();
    values.iter_mut().for_each(|x| *x /= sum);
}

/// Turns partial derivatives of `w S` and of `w`, each of order (a, b) at position
/// `a (order + 1) + b`, into those of S, in place (The NURBS Book, algorithm A4.4).
pub(super) fn divide_partials(
    products: &mut [f64],
    weights: &[f64],
    order: usize,
    dimension: usize,
) {
    let size = order + 1;
    for a in 0..size {
        for b in 0..size {
            let here = a * size + b;
            let (known, rest) = products.split_at_mut(here * dimension);
            let value = &mut rest[..dimension];
            let mut of_a = 1.0;
            for i in 0..=a {
                let mut of_b = 1.0;
                for j in 0..=b {
                    if i + j > 0 {
                        let factor = of_a * of_b * weights[i * size + j];
                        let lower = &known[((a - i) * size + b - j) * dimension..][..dimension];
                        value.iter_mut().zip(lower).for_each(|(x, s)| *x -= factor * s);
                    }
                    of_b *= (b - j) as f64 / (j + 1) as f64;
                }
                of_a *= (a - i) as f64 / (i + 1) as f64;
            }
            value.iter_mut().for_each(|x| *x /= weights[0]);
        }
    }
}

/// Refuses derivatives of a rational curve or surface that are no numbers in doubles.
pub(super) fn check_finite(derivatives: &[f64]) -> Result<(), Error> {
    if derivatives.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Error::LeavesDoubles) }
}
