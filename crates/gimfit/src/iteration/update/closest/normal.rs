//! A symmetric band matrix of two unknowns per control point, factored in place.

/// Lower half of a symmetric matrix: row `i` holds columns `i - reach ..= i`.
#[derive(Debug, Clone)]
pub(super) struct SymmetricBand {
    size: usize,
    reach: usize,
    entries: Vec<f64>,
}

impl SymmetricBand {
    pub(super) fn zeros(size: usize, reach: usize) -> Self {
        let reach = reach.min(size.saturating_sub(1));
        Self { size, reach, entries: vec![0.0; size * (reach + 1)] }
    }

    pub(super) fn copy_from(&mut self, other: &Self) {
        self.entries.copy_from_slice(&other.entries);
    }

    /// Adds to an entry; those above the diagonal stand for their mirror images and are passed over.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        if column <= row {
            let width = self.reach + 1;
            self.entries[row * width + self.reach + column - row] += value;
        }
    }

    /// Raises every diagonal entry by a share of itself.
    pub(super) fn stiffen(&mut self, share: f64) {
        let width = self.reach + 1;
        for row in self.entries.chunks_exact_mut(width) {
            row[width - 1] *= 1.0 + share;
        }
    }

    /// Cholesky factors `L L^T` in place; the diagonal of L is stored as its reciprocal. False where
    /// the matrix is not positive definite in doubles.
    pub(super) fn factor(&mut self) -> bool {
        let (reach, width) = (self.reach, self.reach + 1);
        for i in 0..self.size {
            let (before, from_here) = self.entries.split_at_mut(i * width);
            let row = &mut from_here[..width];
            let diagonal = row[reach];
            let first = i.saturating_sub(reach);
            for j in first..i {
                // Columns first..j of rows i and j.
                let other = &before[j * width..][..width];
                let start = first.max(j.saturating_sub(reach));
                let mine = &row[reach + start - i..reach + j - i];
                let theirs = &other[reach + start - j..reach];
                let sum: f64 = mine.iter().zip(theirs).map(|(a, b)| a * b).sum();
                let at = reach + j - i;
                row[at] = (row[at] - sum) * other[reach];
            }
            let pivot = diagonal - row[reach + first - i..reach].iter().map(|x| x * x).sum::<f64>();
            // What cancellation leaves of a vanished pivot counts as none.
            if !(pivot > f64::EPSILON * diagonal && pivot.is_finite()) {
                return false;
            }
            row[reach] = pivot.sqrt().recip();
        }
        true
    }

    /// Solves `L L^T x = r` in place.
    pub(super) fn solve_in_place(&self, x: &mut [f64]) {
        let (reach, width) = (self.reach, self.reach + 1);
        for i in 0..self.size {
            let row = &self.entries[i * width..][..width];
            let first = i.saturating_sub(reach);
            let known = &row[reach + first - i..reach];
            let sum: f64 = known.iter().zip(&x[first..i]).map(|(a, b)| a * b).sum();
            x[i] = (x[i] - sum) * row[reach];
        }
        for i in (0..self.size).rev() {
            let row = &self.entries[i * width..][..width];
            let first = i.saturating_sub(reach);
            x[i] *= row[reach];
            let found = x[i];
            for (x, a) in x[first..i].iter_mut().zip(&row[reach + first - i..reach]) {
                *x -= a * found;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_is_solved_and_an_indefinite_one_refused() {
        // Second differences squared, plus the identity.
        let (n, reach) = (9, 2);
        let mut band = SymmetricBand::zeros(n, reach);
        let mut dense = vec![vec![0.0; n]; n];
        for i in 0..n {
            dense[i][i] += 1.0;
            band.add(i, i, 1.0);
            if i + 2 < n {
                for (a, x) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                    for (b, y) in [1.0, -2.0, 1.0].into_iter().enumerate() {
                        dense[i + a][i + b] += x * y;
                        band.add(i + a, i + b, x * y);
                    }
                }
            }
        }
        let x: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut right: Vec<f64> =
            dense.iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
        let mut factored = band.clone();
        assert!(factored.factor());
        factored.solve_in_place(&mut right);
        assert!(right.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-13));
        band.add(4, 4, -20.0);
        assert!(!band.factor());
    }
}
