//! All eigenvalues of a full real matrix: balancing (Parlett and Reinsch 1969), reduction to
//! Hessenberg form by reflections, then double-shift QR steps (Francis 1961; Golub and Van Loan,
//! algorithms 7.4.2 and 7.5.1). For matrices of a few hundred rows: the cost is that of about ten
//! products of two of them.

use std::fmt;

/// An eigenvalue; complex ones come in conjugate pairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eigenvalue {
    /// Real part.
    pub re: f64,
    /// Imaginary part.
    pub im: f64,
}

impl Eigenvalue {
    /// Its absolute value.
    #[must_use]
    pub fn modulus(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// Its distance from 1: what a step of plain PIA leaves of its eigenvector.
    #[must_use]
    pub fn distance_from_one(self) -> f64 {
        (1.0 - self.re).hypot(self.im)
    }

    /// The product with another.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}

impl fmt::Display for Eigenvalue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(4);
        if self.im == 0.0 {
            write!(f, "{:.*}", digits, self.re)
        } else {
            let sign = if self.im < 0.0 { '-' } else { '+' };
            write!(f, "{:.*} {sign} {:.*} i", digits, self.re, digits, self.im.abs())
        }
    }
}

/// QR steps allowed for one eigenvalue; two or three are usual.
const MOST_STEPS: usize = 90;
/// Columns taken at once, so that rows are passed in their own order.
const SLICE: usize = 64;
/// Steps after which a stagnating block gets another shift.
const STAGNANT: usize = 10;

/// The eigenvalues of a full matrix of shape (size, size), row by row, those of largest real part
/// first. `None` if an entry is not finite, or an eigenvalue was not found.
#[must_use]
pub fn eigenvalues(mut matrix: Vec<f64>, size: usize) -> Option<Vec<Eigenvalue>> {
    if matrix.len() != size * size || !matrix.iter().all(|x| x.is_finite()) {
        return None;
    }
    balance(&mut matrix, size);
    reduce(&mut matrix, size);
    let mut found = francis(&mut matrix, size)?;
    found.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
    Some(found)
}

/// Scales rows and columns by powers of two until their norms are alike.
fn balance(a: &mut [f64], n: usize) {
    const ROUNDS: usize = 64;
    for _ in 0..ROUNDS {
        let mut settled = true;
        for i in 0..n {
            let off = |line: &mut dyn Iterator<Item = f64>| line.map(f64::abs).sum::<f64>();
            let column = off(&mut (0..n).filter(|&k| k != i).map(|k| a[k * n + i]));
            let row = off(&mut (0..n).filter(|&k| k != i).map(|k| a[i * n + k]));
            if !(column.is_normal() && row.is_normal()) {
                continue;
            }
            let exponent = (0.5 * (row / column).log2()).round().clamp(-500.0, 500.0) as i32;
            let factor = 2_f64.powi(exponent);
            if column * factor + row / factor >= 0.95 * (column + row) {
                continue;
            }
            settled = false;
            for k in 0..n {
                a[i * n + k] /= factor;
            }
            for k in 0..n {
                a[k * n + i] *= factor;
            }
        }
        if settled {
            return;
        }
    }
}

/// A reflection `I - v v^T` that carries `x` to a multiple of the first unit vector; `v` replaces
/// `x`, and the multiple is returned. `None` where nothing is to be done.
fn reflector(x: &mut [f64]) -> Option<f64> {
    let size = x.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if size == 0.0 || x[1..].iter().all(|&x| x == 0.0) {
        return None;
    }
    x.iter_mut().for_each(|x| *x /= size);
    let norm = x.iter().map(|x| x * x).sum::<f64>().sqrt();
    let norm = if x[0] > 0.0 { -norm } else { norm };
    x[0] -= norm;
    // |v|^2 = 2 norm (norm - x_0), and v is scaled to length sqrt 2.
    let scale = (-norm * x[0]).sqrt().recip();
    x.iter_mut().for_each(|x| *x *= scale);
    Some(norm * size)
}

/// Applies a reflection from the left to rows `row..`, columns `columns`.
fn reflect_rows(a: &mut [f64], n: usize, row: usize, columns: std::ops::Range<usize>, v: &[f64]) {
    let mut sums = [0.0; SLICE];
    let mut start = columns.start;
    while start < columns.end {
        let width = SLICE.min(columns.end - start);
        let sums = &mut sums[..width];
        sums.fill(0.0);
        for (i, v) in v.iter().enumerate() {
            let line = &a[(row + i) * n + start..][..width];
            sums.iter_mut().zip(line).for_each(|(sum, x)| *sum += v * x);
        }
        for (i, v) in v.iter().enumerate() {
            let line = &mut a[(row + i) * n + start..][..width];
            line.iter_mut().zip(&*sums).for_each(|(x, sum)| *x -= v * sum);
        }
        start += width;
    }
}

/// Applies a reflection from the right to columns `column..`, rows `rows`.
fn reflect_columns(
    a: &mut [f64],
    n: usize,
    rows: std::ops::Range<usize>,
    column: usize,
    v: &[f64],
) {
    for i in rows {
        let part = &mut a[i * n + column..][..v.len()];
        let sum: f64 = part.iter().zip(v).map(|(x, v)| x * v).sum();
        part.iter_mut().zip(v).for_each(|(x, v)| *x -= v * sum);
    }
}

/// Similar to the matrix, and zero below the first subdiagonal.
fn reduce(a: &mut [f64], n: usize) {
    let mut v = Vec::with_capacity(n);
    for k in 0..n.saturating_sub(2) {
        v.clear();
        v.extend((k + 1..n).map(|i| a[i * n + k]));
        if reflector(&mut v).is_none() {
            continue;
        }
        reflect_rows(a, n, k + 1, k..n, &v);
        reflect_columns(a, n, 0..n, k + 1, &v);
        (k + 2..n).for_each(|i| a[i * n + k] = 0.0);
    }
}

/// Eigenvalues of a Hessenberg matrix, which is destroyed.
fn francis(h: &mut [f64], n: usize) -> Option<Vec<Eigenvalue>> {
    let mut found = Vec::with_capacity(n);
    let norm = h.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let (mut end, mut steps) = (n, 0);
    while end > 0 {
        let start = block_start(h, n, end, norm);
        match end - start {
            1 => {
                found.push(Eigenvalue { re: h[(end - 1) * n + end - 1], im: 0.0 });
                (end, steps) = (start, 0);
            }
            2 => {
                let at = |i: usize, j: usize| h[(start + i) * n + start + j];
                found.extend(pair(at(0, 0), at(0, 1), at(1, 0), at(1, 1)));
                (end, steps) = (start, 0);
            }
            _ if steps == MOST_STEPS => return None,
            _ => {
                steps += 1;
                qr_step(h, n, start..end, steps.is_multiple_of(STAGNANT));
            }
        }
    }
    Some(found)
}

/// Where the last block that does not fall apart begins.
fn block_start(h: &mut [f64], n: usize, end: usize, norm: f64) -> usize {
    for k in (1..end).rev() {
        let near = h[(k - 1) * n + k - 1].abs() + h[k * n + k].abs();
        let near = if near > 0.0 { near } else { norm };
        if h[k * n + k - 1].abs() <= f64::EPSILON * near {
            h[k * n + k - 1] = 0.0;
            return k;
        }
    }
    0
}

/// Eigenvalues of `[a b; c d]`.
fn pair(a: f64, b: f64, c: f64, d: f64) -> [Eigenvalue; 2] {
    let half = 0.5 * (a - d);
    let square = half * half + b * c;
    if square < 0.0 {
        let im = (-square).sqrt();
        return [1.0, -1.0].map(|sign| Eigenvalue { re: 0.5 * (a + d), im: sign * im });
    }
    // The farther root from d without cancellation, the nearer one from the product.
    let far = half + square.sqrt().copysign(half);
    let near = if far == 0.0 { 0.0 } else { -b * c / far };
    [d + far, d + near].map(|re| Eigenvalue { re, im: 0.0 })
}

/// One implicit step with both eigenvalues of the last two rows as shifts; with `other` ones where
/// those have led nowhere.
fn qr_step(h: &mut [f64], n: usize, block: std::ops::Range<usize>, other: bool) {
    let (start, end) = (block.start, block.end);
    let at = |i: usize, j: usize| h[i * n + j];
    let (a, b) = (at(end - 2, end - 2), at(end - 2, end - 1));
    let (c, d) = (at(end - 1, end - 2), at(end - 1, end - 1));
    let (sum, product) = if other {
        let size = c.abs() + at(end - 2, end - 3).abs();
        (1.5 * size + 2.0 * d, size * size + (1.5 * size + d) * d)
    } else {
        (a + d, a * d - b * c)
    };
    let (h00, h10, h11) = (at(start, start), at(start + 1, start), at(start + 1, start + 1));
    // First column of the matrix less both shifts; a common factor does not matter.
    let mut v = [
        h00 * (h00 - sum) + at(start, start + 1) * h10 + product,
        h10 * (h00 + h11 - sum),
        h10 * at(start + 2, start + 1),
    ];
    for k in start..end - 1 {
        let length = (end - k).min(3);
        let v = &mut v[..length];
        if reflector(v).is_some() {
            reflect_rows(h, n, k, k.saturating_sub(1).max(start)..end, v);
            reflect_columns(h, n, start..(k + 4).min(end), k, v);
        }
        if k > start {
            (k + 1..k + length).for_each(|i| h[i * n + k - 1] = 0.0);
        }
        let length = (end - k - 1).min(3);
        for (i, v) in v.iter_mut().enumerate().take(length) {
            *v = h[(k + 1 + i) * n + k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_spectrum(matrix: Vec<f64>, mut expected: Vec<Eigenvalue>, tolerance: f64) {
        let size = expected.len();
        let found = eigenvalues(matrix, size).expect("eigenvalues");
        assert_eq!(found.len(), size);
        for value in found {
            let gap = |e: &Eigenvalue| (e.re - value.re).hypot(e.im - value.im);
            let nearest = (0..expected.len())
                .min_by(|&i, &j| gap(&expected[i]).total_cmp(&gap(&expected[j])))
                .expect("one left");
            assert!(gap(&expected[nearest]) <= tolerance, "{value:?} in {expected:?}");
            expected.swap_remove(nearest);
        }
    }

    fn real(values: &[f64]) -> Vec<Eigenvalue> {
        values.iter().map(|&re| Eigenvalue { re, im: 0.0 }).collect()
    }

    /// Collocation of the Bernstein basis of degree n at i / n has the eigenvalues
    /// n! / ((n - i)! n^i): those of the Bernstein operator.
    #[test]
    fn bernstein_collocation_has_the_eigenvalues_of_the_bernstein_operator() {
        for n in 1..=12_usize {
            let binomial = |i: usize| (0..i).fold(1.0, |b, k| b * (n - k) as f64 / (k + 1) as f64);
            let matrix = (0..=n)
                .flat_map(|j| {
                    let t = j as f64 / n as f64;
                    (0..=n).map(move |i| (i, t))
                })
                .map(|(i, t)| binomial(i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32))
                .collect();
            let expected: Vec<f64> =
                (0..=n).map(|i| (0..i).fold(1.0, |x, k| x * (n - k) as f64 / n as f64)).collect();
            assert_spectrum(matrix, real(&expected), 1e-13);
        }
    }

    #[test]
    fn roots_of_polynomials_come_from_their_companion_matrices() {
        // x^n = 1, whose roots stagnate under the usual shifts: real ones and pairs.
        for n in 2..=17_usize {
            let mut matrix = vec![0.0; n * n];
            matrix[n - 1] = 1.0;
            (1..n).for_each(|i| matrix[i * n + i - 1] = 1.0);
            let roots = (0..n).map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / n as f64;
                Eigenvalue { re: angle.cos(), im: angle.sin() }
            });
            assert_spectrum(matrix, roots.collect(), 1e-12);
        }
        // (x - 1)(x - 2)(x^2 + 2 x + 5).
        let matrix = vec![
            1.0, -1.0, 11.0, -10.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0,
        ];
        let mut roots = real(&[1.0, 2.0]);
        roots.extend([2.0, -2.0].map(|im| Eigenvalue { re: -1.0, im }));
        assert_spectrum(matrix, roots, 1e-12);
    }

    #[test]
    fn a_similarity_of_blocks_keeps_their_eigenvalues() {
        for (size, seed) in [(6, 1_u64), (20, 5), (41, 9)] {
            let mut state = seed;
            let mut random = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                (state >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
            };
            let mut matrix = vec![0.0; size * size];
            let mut expected = Vec::new();
            let mut k = 0;
            while k < size {
                let (re, im) = (2.0 * random(), random());
                if k % 3 == 0 && k + 1 < size {
                    matrix[k * size + k] = re;
                    matrix[(k + 1) * size + k + 1] = re;
                    matrix[k * size + k + 1] = im;
                    matrix[(k + 1) * size + k] = -im;
                    expected.extend([im, -im].map(|im| Eigenvalue { re, im }));
                    k += 2;
                } else {
                    matrix[k * size + k] = re;
                    expected.push(Eigenvalue { re, im: 0.0 });
                    k += 1;
                }
            }
            // Shears are inverted by their opposite, so no digits are lost on the way.
            for _ in 0..size * size {
                let row = (random().abs() * 2.0 * size as f64) as usize % size;
                let other = (row + 1 + (random().abs() * size as f64) as usize) % size;
                if row == other {
                    continue;
                }
                let factor = 0.3 * random();
                (0..size).for_each(|k| {
                    matrix[row * size + k] += factor * matrix[other * size + k];
                });
                (0..size).for_each(|k| {
                    matrix[k * size + other] -= factor * matrix[k * size + row];
                });
            }
            assert_spectrum(matrix, expected, 1e-9);
        }
    }

    #[test]
    fn badly_scaled_defective_and_empty_matrices_are_met() {
        assert_spectrum(
            vec![1.0, 1e12, 1e-12, 3.0],
            real(&[2.0 + 2_f64.sqrt(), 2.0 - 2_f64.sqrt()]),
            1e-12,
        );
        assert_spectrum(vec![0.0; 16], real(&[0.0; 4]), 0.0);
        // A Jordan block: any method finds the eigenvalue to the root of rounding.
        let jordan = vec![0.5, 1.0, 0.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.5];
        assert_spectrum(jordan, real(&[0.5; 3]), 1e-5);
        assert_eq!(eigenvalues(Vec::new(), 0), Some(Vec::new()));
        assert_eq!(eigenvalues(vec![f64::NAN], 1), None);
        assert_eq!(eigenvalues(vec![1.0, 2.0], 2), None);
    }
}
