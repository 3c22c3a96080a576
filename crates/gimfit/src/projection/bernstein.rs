//! Polynomials in Bernstein form on [0, 1]: products, halving, and the minimum of a convex one.
//! Slices in, slices out; callers check first.

use crate::knots::MAX_DEGREE;

/// Factors that turn products `a_i b_j` of coefficients of degree p into coefficients of degree 2p:
/// `C(p, i) C(p, j) / C(2p, i + j)`, row by row (Farouki and Rajan 1988).
pub(super) fn product_factors(degree: usize) -> Vec<f64> {
    let of_p = binomials(degree);
    let of_2p = binomials(2 * degree);
    (0..=degree)
        .flat_map(|i| (0..=degree).map(move |j| (i, j)))
        .map(|(i, j)| of_p[i] * of_p[j] / of_2p[i + j])
        .collect()
}

fn binomials(n: usize) -> Vec<f64> {
    let mut row = vec![1.0];
    for k in 0..n {
        row.push(row[k] * (n - k) as f64 / (k + 1) as f64);
    }
    row
}

/// Cuts `count` coefficients of `width` numbers each at one half: they become those of the left
/// part, `right` receives those of the right part (de Casteljau).
pub(super) fn halve(coefficients: &mut [f64], width: usize, right: &mut [f64]) {
    let count = coefficients.len() / width;
    right.copy_from_slice(coefficients);
    for r in 1..count {
        for i in (r..count).rev() {
            let (low, high) = coefficients.split_at_mut(i * width);
            let low = &low[(i - 1) * width..];
            high[..width].iter_mut().zip(low).for_each(|(x, y)| *x = 0.5 * (*x + y));
        }
        // The last one of each round is a coefficient of the right part.
        let last = (count - 1) * width;
        right[last - r * width..][..width].copy_from_slice(&coefficients[last..]);
    }
}

/// Value at s of `count` coefficients of `width` numbers each; destroys them and leaves it in front.
pub(super) fn evaluate_in_place(coefficients: &mut [f64], width: usize, s: f64) {
    let count = coefficients.len() / width;
    for r in 1..count {
        for i in 0..(count - r) * width {
            coefficients[i] += s * (coefficients[i + width] - coefficients[i]);
        }
    }
}

/// Whether second differences tell that a polynomial is convex.
pub(super) fn is_convex(h: &[f64]) -> bool {
    h.windows(3).all(|h| h[0] - h[1] >= h[1] - h[2])
}

/// Where a convex polynomial is least on [0, 1].
pub(super) fn least_of_convex(h: &[f64]) -> f64 {
    const MOST: usize = 2 * MAX_DEGREE;
    let count = h.len() - 1;
    let mut slopes = [0.0; MOST];
    let slopes = &mut slopes[..count];
    slopes.iter_mut().zip(h.windows(2)).for_each(|(d, h)| *d = h[1] - h[0]);
    if slopes[0] >= 0.0 {
        return 0.0;
    }
    if slopes[count - 1] <= 0.0 {
        return 1.0;
    }
    // The root of the slope, which rises: Newton from where its polygon crosses zero.
    let above = slopes.iter().position(|d| *d > 0.0).unwrap_or(count - 1).max(1);
    let (low, high) = (slopes[above - 1], slopes[above]);
    let mut s = (above as f64 - 1.0 - low / (high - low)) / (count - 1) as f64;
    let (mut least, mut most) = (0.0, 1.0);
    let mut work = [0.0; MOST];
    let work = &mut work[..count];
    for _ in 0..60 {
        work.copy_from_slice(slopes);
        for r in 1..count - 1 {
            for i in 0..count - r {
                work[i] += s * (work[i + 1] - work[i]);
            }
        }
        let rise = work[1] - work[0];
        let value = work[0] + s * rise;
        if value > 0.0 {
            most = s
        } else {
            least = s
        }
        let newton = s - value / (rise * (count - 1) as f64);
        if newton > least && newton < most {
            // Digits double with each step of Newton, so that this one has reached rounding.
            let last = (newton - s).abs() <= 1e-8;
            s = newton;
            if last {
                break;
            }
        } else {
            s = 0.5 * (least + most);
            if most - least <= 1e-16 {
                break;
            }
        }
    }
    s
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(h: &[f64], s: f64) -> f64 {
        let mut work = h.to_vec();
        evaluate_in_place(&mut work, 1, s);
        work[0]
    }

    #[test]
    fn halves_are_the_polynomial() {
        let whole = [1.0, -2.0, 0.5, 3.0];
        let (mut left, mut right) = (whole, [0.0; 4]);
        halve(&mut left, 1, &mut right);
        for s in [0.0, 0.3, 0.9, 1.0] {
            assert!((value(&left, s) - value(&whole, 0.5 * s)).abs() < 1e-15);
            assert!((value(&right, s) - value(&whole, 0.5 + 0.5 * s)).abs() < 1e-15);
        }
    }

    #[test]
    fn products_multiply() {
        let (a, b) = ([1.0, -2.0, 0.5], [0.3, 4.0, -1.0]);
        let factors = product_factors(2);
        let mut product = [0.0; 5];
        for i in 0..3 {
            for j in 0..3 {
                product[i + j] += factors[3 * i + j] * a[i] * b[j];
            }
        }
        for s in [0.0, 0.2, 0.7, 1.0] {
            assert!((value(&product, s) - value(&a, s) * value(&b, s)).abs() < 1e-15);
        }
    }

    #[test]
    fn the_least_of_a_convex_polynomial_is_found() {
        // (s - 0.3)^2 in degree 2 and raised to degree 3.
        for h in [&[0.09, -0.21, 0.49][..], &[0.09, -0.11, 0.07 / 3.0, 0.49]] {
            assert!(is_convex(h));
            assert!((least_of_convex(h) - 0.3).abs() < 1e-15, "{}", least_of_convex(h));
        }
        assert_eq!(least_of_convex(&[0.0, 1.0, 2.0]), 0.0);
        assert_eq!(least_of_convex(&[2.0, 1.0, 0.0]), 1.0);
        assert!(!is_convex(&[0.0, 1.0, 0.0]));
    }
}
