//! Energies of derivatives: `D_r = [integral of N_i^(r) N_l^(r)]`, what fairing pulls with.
//!
//! A band like the normal matrix of data, and laid out like it. Energies of surfaces are sums of
//! Kronecker products of these bands, one direction each, and are never assembled.

use super::least_squares::NormalEquations;
use crate::basis::basis_derivatives;
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::memory;

/// `D_r` of one direction, over the control points that move and the whole domain.
#[derive(Debug, Clone)]
pub(crate) struct EnergyBand {
    degree: usize,
    columns: usize,
    /// Row by row, from `degree` columns before the diagonal to `degree` after it, counted round a
    /// closed direction.
    band: Vec<f64>,
}

impl EnergyBand {
    /// Of derivatives of an order: 0 values, 1 stretch, 2 strain, 3 jerk; all zeros above the degree.
    /// With respect to the parameters as they are: scaling the domain by `s` divides by
    /// `s^(2 order - 1)`.
    pub(crate) fn new(knots: &KnotVector, order: usize) -> Self {
        let degree = knots.degree();
        let repeated = if knots.boundary() == Boundary::Periodic { degree } else { 0 };
        let columns = knots.control_points() - repeated;
        let width = 2 * degree + 1;
        let mut band = memory::zeros(columns * width);
        if order > degree {
            return Self { degree, columns, band };
        }
        // Exact for the products, whose degree is 2 (degree - order).
        let rule = gauss_legendre(degree - order + 1);
        let values = knots.values();
        let mut table = vec![0.0; (order + 1) * (degree + 1)];
        for span in knots.nonempty_spans() {
            let (start, length) = (values[span], values[span + 1] - values[span]);
            for (node, weight) in &rule {
                let t = start + node * length;
                basis_derivatives(values, degree, span, t, order, &mut table);
                let functions = &table[order * (degree + 1)..];
                for (k, of_row) in functions.iter().enumerate() {
                    let row = (span - degree + k) % columns;
                    let entries = &mut band[row * width + degree - k..][..=degree];
                    let factor = weight * length * of_row;
                    entries.iter_mut().zip(functions).for_each(|(x, other)| *x += factor * other);
                }
            }
        }
        Self { degree, columns, band }
    }

    /// Control points that move.
    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    /// The entries of a row: columns and values; a column may come twice where a closed direction has
    /// few.
    pub(crate) fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let width = 2 * self.degree + 1;
        // Outside an open direction entries are zero.
        let around = i + self.columns * (1 + self.degree / self.columns) - self.degree;
        let entries = self.band[i * width..][..width].iter().enumerate();
        entries.map(move |(k, &value)| ((around + k) % self.columns, value))
    }

    /// Adds `factor D x` to `result`, for vectors of shape (control points, dimension).
    pub(crate) fn add_apply(&self, factor: f64, x: &[f64], dimension: usize, result: &mut [f64]) {
        for (i, out) in result.chunks_exact_mut(dimension).enumerate() {
            for (column, value) in self.row(i) {
                let scaled = factor * value;
                let near = &x[column * dimension..][..dimension];
                out.iter_mut().zip(near).for_each(|(y, x)| *y += scaled * x);
            }
        }
    }

    /// Adds `factor D` to the matrix of normal equations over the same knots.
    pub(crate) fn add_to(&self, factor: f64, equations: &mut NormalEquations) {
        equations.add_band(factor, &self.band);
    }
}

/// Nodes and weights of Gauss and Legendre on [0, 1], by Newton's method from Chebyshev's nodes.
fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    debug_assert!((1..=MAX_DEGREE + 1).contains(&count));
    let n = count as f64;
    let node = |i: usize| {
        let mut x = f64::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut value, mut before) = (x, 1.0);
            for k in 1..count {
                let k = k as f64;
                (value, before) = (((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0), value);
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (f64::midpoint(1.0, -x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Simpson's rule on many parts of every span.
    fn simpson(knots: &KnotVector, order: usize, i: usize, l: usize, columns: usize) -> f64 {
        const PARTS: usize = 400;
        let (values, degree) = (knots.values(), knots.degree());
        let mut sum = 0.0;
        for span in knots.nonempty_spans() {
            let length = values[span + 1] - values[span];
            for part in 0..=PARTS {
                let t = values[span] + length * part as f64 / PARTS as f64;
                let mut table = vec![0.0; (order + 1) * (degree + 1)];
                basis_derivatives(values, degree, span, t, order, &mut table);
                let at = |column: usize| -> f64 {
                    (0..=degree)
                        .filter(|k| (span - degree + k) % columns == column)
                        .map(|k| table[order * (degree + 1) + k])
                        .sum()
                };
                let weight = match part {
                    0 | PARTS => 1.0,
                    odd if odd % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                sum += weight * length / (3 * PARTS) as f64 * at(i) * at(l);
            }
        }
        sum
    }

    #[test]
    fn energies_are_integrals_of_products() {
        let open =
            KnotVector::open(3, vec![0., 0., 0., 0., 0.3, 0.5, 0.5, 1., 1., 1., 1.]).unwrap();
        let closed = KnotVector::periodic(3, (-3..9).map(f64::from).collect()).unwrap();
        for knots in [open, closed] {
            for order in 0..=3 {
                let energy = EnergyBand::new(&knots, order);
                let n = energy.columns();
                for i in 0..n {
                    let mut unit = vec![0.0; n];
                    unit[i] = 1.0;
                    let mut column = vec![0.0; n];
                    energy.add_apply(1.0, &unit, 1, &mut column);
                    for (l, value) in column.iter().enumerate() {
                        let truth = simpson(&knots, order, i, l, n);
                        let size = 1.0 + truth.abs();
                        assert!(
                            (value - truth).abs() < 1e-7 * size,
                            "{order} {i} {l} {value} {truth}"
                        );
                    }
                }
            }
            assert!(EnergyBand::new(&knots, 4).row(0).all(|(_, value)| value == 0.0));
        }
    }

    #[test]
    fn polynomials_below_the_order_have_no_energy() {
        let knots = KnotVector::open(3, vec![2., 2., 2., 2., 2.5, 4., 7., 7., 7., 7.]).unwrap();
        let line = knots.greville_abscissae();
        for (order, least) in [(1, 1.0), (2, 0.0), (3, 0.0)] {
            let mut image = vec![0.0; line.len()];
            EnergyBand::new(&knots, order).add_apply(1.0, &line, 1, &mut image);
            let energy: f64 = line.iter().zip(&image).map(|(x, y)| x * y).sum();
            assert!((energy - 5.0 * least).abs() < 1e-12, "{order} {energy}");
        }
    }

    #[test]
    fn the_quadrature_is_exact_up_to_its_degree() {
        for count in 1..=MAX_DEGREE + 1 {
            let rule = gauss_legendre(count);
            for power in 0..2 * count {
                let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                let truth = (power as f64 + 1.0).recip();
                assert!((sum - truth).abs() < 1e-14, "{count} {power}");
            }
        }
    }
}
