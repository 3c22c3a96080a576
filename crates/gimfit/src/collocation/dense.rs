//! Collocation of bases without a band: every row holds all weights.

use super::{CollocationMatrix, CollocationOperator, Factorization, ResidualNorms};
use crate::basis::BlendingBasis;
use crate::parameters::Parameters;
use crate::{Error, memory};

/// Most points of a dense matrix: 200 MB.
pub const MAX_DENSE_POINTS: usize = 5000;

/// How far the sum of a basis may be from 1, and a function below 0: what rounding leaves of sums
/// of up to 5,000 values.
const BLENDING: f64 = 1e-11;

/// Square collocation matrix with all its entries. Memory: 8 bytes an entry.
#[derive(Debug, Clone, PartialEq)]
pub struct DenseCollocation {
    name: String,
    count: usize,
    /// Row by row.
    matrix: Vec<f64>,
    totally_positive: bool,
    smallest_eigenvalue: Option<f64>,
}

impl DenseCollocation {
    /// Collocates a basis at the parameters, one function per data point.
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless there are as many functions as points; [`Error::OutOfRange`]
    /// for more than [`MAX_DENSE_POINTS`]; [`Error::OutsideDomain`]; [`Error::NoBlending`] for
    /// functions that are negative, no numbers, or do not add up to one at a parameter.
    pub fn new(basis: &dyn BlendingBasis, parameters: &Parameters) -> Result<Self, Error> {
        let (t, count) = (parameters.values(), basis.functions());
        if t.len() != count {
            return Err(Error::WrongCount {
                what: "basis functions",
                given: count,
                expected: t.len(),
                why: "one per point for interpolation",
            });
        }
        let mut matrix = room(count)?;
        let (start, end) = basis.domain();
        for (&t, row) in t.iter().zip(matrix.chunks_exact_mut(count)) {
            if !(start <= t && t <= end) {
                return Err(Error::OutsideDomain { parameter: t, start, end });
            }
            row.fill(f64::NAN);
            basis.evaluate_into(t, row);
            check_blending(basis.name(), t, row)?;
        }
        let smallest_eigenvalue =
            basis.uniform_smallest_eigenvalue().filter(|_| is_uniform(t, start, end));
        Ok(Self {
            name: basis.name().into(),
            count,
            matrix,
            totally_positive: basis.is_totally_positive(),
            smallest_eigenvalue,
        })
    }

    /// The square matrix of `count` rows and columns of another from `start` on, past the last row
    /// round to the first.
    pub(crate) fn window(
        matrix: &dyn CollocationMatrix,
        start: usize,
        count: usize,
    ) -> Result<Self, Error> {
        let points = matrix.points();
        let mut entries = room(count)?;
        for (i, row) in entries.chunks_exact_mut(count).enumerate() {
            matrix.visit_row((start + i) % points, &mut |column, weight| {
                let place = (column + points - start) % points;
                if place < count {
                    row[place] += weight;
                }
            });
        }
        Ok(Self {
            name: "a part of the matrix".into(),
            count,
            matrix: entries,
            totally_positive: matrix.is_totally_positive() && start + count <= points,
            smallest_eigenvalue: None,
        })
    }

    /// All entries, row by row.
    pub(crate) fn entries(&self) -> &[f64] {
        &self.matrix
    }

    /// Takes rows that `fill` writes, of functions known to blend, which are not totally positive.
    pub(crate) fn from_rows(
        name: &str,
        count: usize,
        smallest_eigenvalue: Option<f64>,
        mut fill: impl FnMut(usize, &mut [f64]),
    ) -> Result<Self, Error> {
        let mut matrix = room(count)?;
        for (j, row) in matrix.chunks_exact_mut(count).enumerate() {
            fill(j, row);
        }
        let name = name.into();
        Ok(Self { name, count, matrix, totally_positive: false, smallest_eigenvalue })
    }

    /// Row `j`.
    #[must_use]
    pub fn row(&self, j: usize) -> &[f64] {
        &self.matrix[j * self.count..][..self.count]
    }

    /// The diagonally compensated reduction to a half bandwidth.
    fn compensated(&self, half_bandwidth: usize) -> Vec<f64> {
        let mut reduced = self.matrix.clone();
        for (j, row) in reduced.chunks_exact_mut(self.count).enumerate() {
            let mut beyond = 0.0;
            for (column, weight) in row.iter_mut().enumerate() {
                if column.abs_diff(j) > half_bandwidth {
                    beyond += std::mem::take(weight);
                }
            }
            row[j] += beyond;
        }
        reduced
    }
}

fn room(count: usize) -> Result<Vec<f64>, Error> {
    if count > MAX_DENSE_POINTS {
        return Err(Error::OutOfRange {
            what: "number of points".into(),
            value: count as f64,
            rule: "a basis without local support takes at most 5000 points; use B-splines for more",
        });
    }
    Ok(memory::zeros(count * count))
}

/// Refuses values that do not blend.
fn check_blending(basis: &str, parameter: f64, values: &[f64]) -> Result<(), Error> {
    let wrong = |problem| Err(Error::NoBlending { basis: basis.into(), parameter, problem });
    if let Some(i) = values.iter().position(|&value| !(value.is_finite() && value >= -BLENDING)) {
        return wrong(format!("function {i} is {:?} there", values[i]));
    }
    let sum: f64 = values.iter().sum();
    if (sum - 1.0).abs() > BLENDING {
        return wrong(format!("the sum is {sum:?}"));
    }
    Ok(())
}

/// Whether parameters go in equal steps from end to end, to rounding.
fn is_uniform(t: &[f64], start: f64, end: f64) -> bool {
    let last = t.len().saturating_sub(1).max(1) as f64;
    t.iter().enumerate().all(|(j, &t)| {
        (t - (start + (end - start) * (j as f64 / last))).abs() <= 1e-14 * (end - start)
    })
}

/// `result += sum_i row[i] x_i`, or with `sign` -1 their difference.
fn blend(row: &[f64], x: &[f64], sign: f64, result: &mut [f64]) {
    for (weight, point) in row.iter().zip(x.chunks_exact(result.len())) {
        let weight = sign * weight;
        for (r, x) in result.iter_mut().zip(point) {
            *r += weight * x;
        }
    }
}

impl CollocationOperator for DenseCollocation {
    fn points(&self) -> usize {
        self.count
    }

    fn control_points(&self) -> usize {
        self.count
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        for (j, result) in result.chunks_exact_mut(dimension).enumerate() {
            result.fill(0.0);
            blend(self.row(j), x, 1.0, result);
        }
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let (mut largest, mut max_index, mut sum) = (0.0_f64, 0, 0.0_f64);
        let vectors = result.chunks_exact_mut(dimension).zip(data.chunks_exact(dimension));
        for (j, (vector, data)) in vectors.enumerate() {
            // Of differences to the data point, which rounds less: the weights add up to 1.
            vector.fill(0.0);
            let row = self.row(j);
            for (weight, point) in row.iter().zip(control.chunks_exact(dimension)) {
                for ((r, x), q) in vector.iter_mut().zip(point).zip(data) {
                    *r += weight * (q - x);
                }
            }
            let square: f64 = vector.iter().map(|x| x * x).sum();
            sum += square;
            if square > largest {
                (largest, max_index) = (square, j);
            }
        }
        let max = if sum.is_finite() { largest.sqrt() } else { f64::NAN };
        ResidualNorms { max, max_index, rms: (sum / self.count as f64).sqrt(), normal: None }
    }
}

impl CollocationMatrix for DenseCollocation {
    fn visit_row(&self, j: usize, visit: &mut dyn FnMut(usize, f64)) {
        self.row(j).iter().enumerate().for_each(|(column, &weight)| visit(column, weight));
    }

    fn diagonal(&self, j: usize) -> f64 {
        self.matrix[j * self.count + j]
    }

    fn sweep(&self, omega: f64, vectors: &mut [f64], dimension: usize) {
        for j in 0..self.count {
            let (done, rest) = vectors.split_at_mut(j * dimension);
            let vector = &mut rest[..dimension];
            let row = self.row(j);
            blend(&row[..j], done, -1.0, vector);
            let factor = omega / row[j];
            vector.iter_mut().for_each(|x| *x *= factor);
        }
    }

    fn factor(&self, half_bandwidth: Option<usize>) -> Result<Factorization, Error> {
        let matrix = match half_bandwidth {
            Some(q) => self.compensated(q),
            None => self.matrix.clone(),
        };
        Factorization::of_dense(self.count, matrix)
            .ok_or_else(|| Error::SingularBasis { basis: self.name.clone(), points: self.count })
    }

    fn is_dense(&self) -> bool {
        true
    }

    fn factor_comparison(&self) -> Result<Factorization, Error> {
        let mut matrix = self.matrix.clone();
        for (j, row) in matrix.chunks_exact_mut(self.count).enumerate() {
            row.iter_mut().for_each(|x| *x = -x.abs());
            row[j] = -row[j];
        }
        Factorization::of_dense(self.count, matrix)
            .ok_or_else(|| Error::SingularBasis { basis: self.name.clone(), points: self.count })
    }

    fn is_totally_positive(&self) -> bool {
        self.totally_positive
    }

    fn known_smallest_eigenvalue(&self) -> Option<f64> {
        self.smallest_eigenvalue
    }
}
