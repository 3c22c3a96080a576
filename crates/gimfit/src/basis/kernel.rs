//! The Cox-de Boor recurrence for the `p + 1` functions that do not vanish on a span
//! (The NURBS Book, algorithms A2.2 and A2.3). Slices in, slices out; callers check first.

use crate::knots::MAX_DEGREE;

const ORDER: usize = MAX_DEGREE + 1;

/// Writes the values of functions `span - p ..= span` at `t` into `values[..= p]`.
#[inline]
pub(crate) fn basis_functions(
    knots: &[f64],
    degree: usize,
    span: usize,
    t: f64,
    values: &mut [f64],
) {
    match degree {
        1 => values_of::<1>(knots, degree, span, t, values),
        2 => values_of::<2>(knots, degree, span, t, values),
        3 => values_of::<3>(knots, degree, span, t, values),
        4 => values_of::<4>(knots, degree, span, t, values),
        5 => values_of::<5>(knots, degree, span, t, values),
        _ => values_of::<0>(knots, degree, span, t, values),
    }
}

/// `P` is the degree known at compile time, or 0 for one known only now.
#[inline(always)]
fn values_of<const P: usize>(
    knots: &[f64],
    degree: usize,
    span: usize,
    t: f64,
    values: &mut [f64],
) {
    let p = if P == 0 { degree } else { P };
    let near = &knots[span + 1 - p..=span + p];
    let values = &mut values[..=p];
    let mut left = [0.0; ORDER];
    let mut right = [0.0; ORDER];
    values[0] = 1.0;
    for j in 1..=p {
        left[j] = t - near[p - j];
        right[j] = near[p - 1 + j] - t;
        let mut saved = 0.0;
        for r in 0..j {
            // The knots differ on a span of positive length, so this never divides by zero.
            let share = values[r] / (right[r + 1] + left[j - r]);
            values[r] = saved + right[r + 1] * share;
            saved = left[j - r] * share;
        }
        values[j] = saved;
    }
}

/// Writes derivative `k` of functions `span - p ..= span` at `t` into
/// `values[k * (p + 1)..][..= p]` for `k = 0 ..= order`; derivatives above the degree are zero.
pub(crate) fn basis_derivatives(
    knots: &[f64],
    degree: usize,
    span: usize,
    t: f64,
    order: usize,
    values: &mut [f64],
) {
    let width = degree + 1;
    values[..(order + 1) * width].fill(0.0);
    for k in 0..=order.min(degree) {
        // Values of the functions of degree p - k, then raised back k times by the derivative
        // formula N'(i, q) = q (N(i, q - 1) / (U(i + q) - U(i)) - N(i + 1, q - 1) / (...)).
        let out = &mut values[k * width..][..width];
        let mut low = [0.0; ORDER];
        if degree == k {
            low[0] = 1.0;
        } else {
            basis_functions(knots, degree - k, span, t, &mut low);
        }
        for q in degree - k + 1..=degree {
            // `low[r]` belongs to function span - (q - 1) + r of degree q - 1.
            let mut raised = [0.0; ORDER];
            for r in 0..q {
                let i = span + 1 + r - q;
                let slope = q as f64 * low[r] / (knots[i + q] - knots[i]);
                raised[r] -= slope;
                raised[r + 1] += slope;
            }
            low = raised;
        }
        out.copy_from_slice(&low[..width]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_sum_to_one_and_their_derivatives_to_zero() {
        let knots = [0.0, 0.0, 0.0, 0.0, 0.3, 0.7, 0.71, 2.0, 2.0, 2.0, 2.0];
        for (span, t) in [(3, 0.0), (3, 0.2), (4, 0.5), (5, 0.705), (6, 1.9), (6, 2.0)] {
            let mut values = [0.0; 16];
            basis_derivatives(&knots, 3, span, t, 3, &mut values);
            assert!((values[..4].iter().sum::<f64>() - 1.0).abs() < 1e-15);
            for k in 1..4 {
                let row = &values[4 * k..][..4];
                let size: f64 = row.iter().map(|x| x.abs()).sum();
                assert!(row.iter().sum::<f64>().abs() <= 1e-14 * size.max(1.0), "order {k} at {t}");
            }
        }
    }

    #[test]
    fn derivatives_agree_with_central_differences() {
        let knots = [0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 1.25, 2.0, 2.0, 2.0, 2.0, 2.0];
        let (span, t, h) = (5, 0.8, 1e-4);
        let mut at = [[0.0; 20]; 3];
        for (row, t) in at.iter_mut().zip([t - h, t, t + h]) {
            basis_derivatives(&knots, 4, span, t, 3, row);
        }
        for k in 0..3 {
            for r in 0..5 {
                let slope = (at[2][k * 5 + r] - at[0][k * 5 + r]) / (2.0 * h);
                assert!((slope - at[1][(k + 1) * 5 + r]).abs() < 1e-5, "order {k}, function {r}");
            }
        }
    }
}
