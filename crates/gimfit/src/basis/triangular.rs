//! The Bernstein basis of a triangle.

use super::bernstein::bernstein_into;

/// Writes `n! / (i! j! k!) u^i v^j w^k` for all `i + j + k = n`, in rows of equal i, from i = n down,
/// each by ascending k: `B_i(u)` of degree n times `B_k(w / (v + w))` of degree n - i, so that
/// nothing is subtracted.
pub(crate) fn triangular_into(degree: usize, [u, v, w]: [f64; 3], values: &mut [f64]) {
    let mut outer = vec![0.0; degree + 1];
    bernstein_into(u, &mut outer);
    let share = if v + w > 0.0 { w / (v + w) } else { 0.0 };
    let mut start = 0;
    for row in 0..=degree {
        let inner = &mut values[start..=start + row];
        bernstein_into(share, inner);
        let factor = outer[degree - row];
        inner.iter_mut().for_each(|value| *value *= factor);
        start += row + 1;
    }
}
