//! Factors of a dense matrix: LU with partial pivoting.

/// `P A = L U`, L and U in one array.
#[derive(Debug, Clone)]
pub(super) struct DenseFactors {
    count: usize,
    factors: Vec<f64>,
    /// Row exchanged with row k in step k.
    exchanges: Vec<usize>,
}

impl DenseFactors {
    /// Factors a matrix given row by row; `None` if a pivot vanishes or is no number.
    pub(super) fn new(count: usize, mut a: Vec<f64>) -> Option<Self> {
        let mut exchanges = Vec::with_capacity(count);
        for k in 0..count {
            let mut row = k;
            for i in k + 1..count {
                if a[i * count + k].abs() > a[row * count + k].abs() {
                    row = i;
                }
            }
            exchanges.push(row);
            if row != k {
                let (upper, lower) = a.split_at_mut(row * count);
                upper[k * count..][..count].swap_with_slice(&mut lower[..count]);
            }
            let (upper, lower) = a.split_at_mut((k + 1) * count);
            let pivot_row = &upper[k * count..];
            let pivot = pivot_row[k];
            if !(pivot.abs() >= f64::MIN_POSITIVE && pivot.is_finite()) {
                return None;
            }
            for line in lower.chunks_exact_mut(count) {
                let factor = line[k] / pivot;
                line[k] = factor;
                if factor != 0.0 {
                    for (x, p) in line[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                        *x -= factor * p;
                    }
                }
            }
        }
        Some(Self { count, factors: a, exchanges })
    }

    /// Solves `A x = r` in place for vectors of shape (points, dimension).
    pub(super) fn solve_in_place(&self, vectors: &mut [f64], dimension: usize) {
        let (count, d) = (self.count, dimension);
        for (k, &row) in self.exchanges.iter().enumerate() {
            if row != k {
                let (upper, lower) = vectors.split_at_mut(row * d);
                upper[k * d..][..d].swap_with_slice(&mut lower[..d]);
            }
        }
        for i in 1..count {
            let (known, rest) = vectors.split_at_mut(i * d);
            let line = &self.factors[i * count..][..i];
            subtract(line, known, &mut rest[..d]);
        }
        for i in (0..count).rev() {
            let (rest, known) = vectors.split_at_mut((i + 1) * d);
            let line = &self.factors[i * count..][..count];
            let vector = &mut rest[i * d..];
            subtract(&line[i + 1..], known, vector);
            vector.iter_mut().for_each(|x| *x /= line[i]);
        }
    }
}

/// `vector -= sum_j line[j] known_j`.
fn subtract(line: &[f64], known: &[f64], vector: &mut [f64]) {
    for (factor, other) in line.iter().zip(known.chunks_exact(vector.len())) {
        for (x, y) in vector.iter_mut().zip(other) {
            *x -= factor * y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_needs_exchanges_is_solved() {
        // x = (1, 2, 3), y = (-1, 0, 4).
        let a = vec![0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 1.0, 1.0, 0.0];
        let factors = DenseFactors::new(3, a).unwrap();
        let mut vectors = [8.0, 8.0, 6.0, 1.0, 3.0, -1.0];
        factors.solve_in_place(&mut vectors, 2);
        let expected = [1.0, -1.0, 2.0, 0.0, 3.0, 4.0];
        assert!(vectors.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-14), "{vectors:?}");
    }

    #[test]
    fn a_repeated_row_is_found() {
        assert!(DenseFactors::new(3, vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 0.0, 1.0, 1.0]).is_none());
    }
}
