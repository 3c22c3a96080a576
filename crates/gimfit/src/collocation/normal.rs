//! Least squares as a square iteration: the difference vectors of many data points, gathered at the
//! few control points that are to move.
//!
//! The loop sees one vector per control point, `S W (Q - A P)`, where W are weights of the data and
//! S is `A^T` (LSPIA and its relatives, Deng and Lin 2014) or, for extended PIA (Lin and Zhang 2011),
//! the mean over the data points that belong to a control point. How far the limit is, is told by the
//! means of the difference vectors at the control points: at the least squares fit they are 0,
//! difference vectors at the data are not.

use super::kernel::{self, Rows};
use super::symmetric_band::SymmetricBand;
use super::{BandedCollocation, CollocationOperator, DataRows, ResidualNorms, normal_kernel};
use crate::Error;
use crate::knots::KnotVector;
use crate::memory;

/// Control points whose functions the data meet by less than this, together, are met by none.
const NEXT_TO_NOTHING: f64 = 1e-100;

/// `A = [B_i(t_j)]` over data points `j` and the control points `i` that move, with what gathers
/// difference vectors. Memory: `8 (p + 1) + 4` bytes a data point.
#[derive(Debug, Clone)]
pub struct LeastSquaresCollocation {
    rows: DataRows,
    points: usize,
    /// One per data point, none larger than 1; empty: all are 1.
    data_weights: Vec<f64>,
    /// Extended PIA: the control point that each data point belongs to.
    groups: Option<Vec<u32>>,
    /// What the functions weigh at the data, `A^T W 1`; of groups, the weight of their points.
    sums: Vec<f64>,
    /// Whether a control point stays: it is held, or no data point meets it.
    stays: Vec<bool>,
    /// Points that a row of the arrays holds.
    side_by_side: usize,
}

impl LeastSquaresCollocation {
    /// Collocates at parameters in any order.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::NoPoints`]; [`Error::OutOfRange`] for more than
    /// 2 147 483 000 points.
    pub fn new(parameters: &[f64], knots: &KnotVector) -> Result<Self, Error> {
        let (start, end) = knots.domain();
        if let Some(&parameter) = parameters.iter().find(|&&t| !(start <= t && t <= end)) {
            return Err(Error::OutsideDomain { parameter, start, end });
        }
        if parameters.is_empty() {
            return Err(Error::NoPoints { needed: 1 });
        }
        if i32::try_from(parameters.len().max(knots.control_points() + knots.degree())).is_err() {
            return Err(Error::OutOfRange {
                what: "number of points".into(),
                value: parameters.len() as f64,
                rule: "at most 2 147 483 000 points can be fitted at once",
            });
        }
        let rows = DataRows::new(parameters, knots);
        let columns = rows.columns();
        let mut operator = Self {
            rows,
            points: parameters.len(),
            data_weights: Vec::new(),
            groups: None,
            sums: vec![0.0; columns],
            stays: vec![false; columns],
            side_by_side: 1,
        };
        operator.weigh();
        Ok(operator)
    }

    /// Weights of the data points: squares of residuals count so often. Only their ratios matter.
    ///
    /// # Errors
    /// [`Error::WrongCount`]; [`Error::OutOfRange`] for a weight that is negative or not finite, or if
    /// all are 0.
    pub fn with_data_weights(mut self, weights: &[f64]) -> Result<Self, Error> {
        if weights.len() != self.points {
            return Err(Error::WrongCount {
                what: "data weights",
                given: weights.len(),
                expected: self.points,
                why: "one per point",
            });
        }
        if let Some(j) = weights.iter().position(|w| !(*w >= 0.0 && w.is_finite())) {
            return Err(Error::OutOfRange {
                what: format!("data weight {j}"),
                value: weights[j],
                rule: "weights of the data must be 0 or more, and finite",
            });
        }
        let largest = weights.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return Err(Error::OutOfRange {
                what: "largest data weight".into(),
                value: 0.0,
                rule: "at least one weight of the data must be above 0",
            });
        }
        self.data_weights = weights.iter().map(|w| w / largest).collect();
        self.weigh();
        Ok(self)
    }

    /// Control points, by position among those that move, that stay where they start; positions
    /// beyond are passed over.
    #[must_use]
    pub fn with_held(mut self, held: &[usize]) -> Self {
        for &i in held {
            if let Some(stays) = self.stays.get_mut(i) {
                *stays = true;
            }
        }
        self
    }

    /// Takes a row of the arrays for so many points side by side, lines of a grid that are fitted at
    /// once: the normal residual is then that of a single one.
    #[must_use]
    pub fn with_points_side_by_side(mut self, count: usize) -> Self {
        self.side_by_side = count.max(1);
        self
    }

    /// Gathers means over groups in place of `A^T`: a data point belongs to the control point whose
    /// function is largest there (Lin and Zhang 2011).
    #[must_use]
    pub fn grouped(mut self) -> Self {
        let rows = self.rows.rows();
        let lines = rows.first.iter().zip(rows.weights.chunks_exact(rows.width));
        let groups = lines.map(|(&first, row)| {
            let largest = (0..row.len()).fold(0, |l, k| if row[k] > row[l] { k } else { l });
            rows.column(first, largest) as u32
        });
        self.groups = Some(groups.collect());
        self.weigh();
        self
    }

    /// Whether means over groups are gathered.
    pub(crate) fn is_grouped(&self) -> bool {
        self.groups.is_some()
    }

    /// Sums up what each control point is met by.
    fn weigh(&mut self) {
        self.sums.fill(0.0);
        let weight = |j: usize| self.data_weights.get(j).copied().unwrap_or(1.0);
        match &self.groups {
            Some(groups) => {
                for (j, &group) in groups.iter().enumerate() {
                    self.sums[group as usize] += weight(j);
                }
            }
            None => {
                normal_kernel::gather_sums(self.rows.rows(), &self.data_weights, &mut self.sums);
            }
        }
        for (stays, &sum) in self.stays.iter_mut().zip(&self.sums) {
            *stays |= sum <= NEXT_TO_NOTHING;
        }
    }

    pub(crate) fn rows(&self) -> Rows<'_> {
        self.rows.rows()
    }

    /// Weight of a data point.
    pub(crate) fn data_weight(&self, j: usize) -> f64 {
        self.data_weights.get(j).copied().unwrap_or(1.0)
    }

    /// Column sums `A^T W 1`: how much data weigh on each control point.
    #[must_use]
    pub fn column_sums(&self) -> &[f64] {
        &self.sums
    }

    /// How many control points no data point meets.
    #[must_use]
    pub fn unmet(&self) -> usize {
        self.sums.iter().filter(|sum| **sum <= NEXT_TO_NOTHING).count()
    }

    /// Whether a control point stays: it is held, or no data point meets its function.
    #[must_use]
    pub fn stays(&self) -> &[bool] {
        &self.stays
    }

    /// The normal matrix `A^T W A` of the control points that move.
    #[must_use]
    pub fn normal_matrix(&self) -> NormalMatrix {
        let rows = self.rows.rows();
        let (columns, width) = (rows.columns, rows.width);
        let degree = width - 1;
        let mut upper = memory::zeros(columns * width);
        let mut sums = vec![0.0; columns];
        normal_kernel::gather_band(rows, &self.data_weights, &mut upper, &mut sums);
        let whole = 2 * degree + 1;
        let mut band = memory::zeros(columns * whole);
        for i in 0..columns {
            if self.stays[i] {
                band[i * whole + degree] = 1.0;
                continue;
            }
            for offset in 0..width {
                let other = (i + offset) % columns;
                if self.stays[other] {
                    continue;
                }
                let entry = upper[i * width + offset];
                band[i * whole + degree + offset] += entry;
                if offset > 0 {
                    band[other * whole + degree - offset] += entry;
                }
            }
        }
        let first = (0..columns).map(|i| i as i32 - degree as i32).collect();
        let matrix = BandedCollocation::from_rows(whole, first, band);
        NormalMatrix { matrix, sums, stays: self.stays.clone() }
    }

    /// The difference vectors at the data, `Q - A P`, shape (points, dimension), with their norms;
    /// those of points of weight 0 do not count in the latter.
    pub fn at_data(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let (largest, max_index, sum) =
            kernel::residual(self.rows.rows(), data, control, dimension, result);
        if self.data_weights.is_empty() {
            return norms(largest, max_index, sum, self.points);
        }
        let count = self.data_weights.iter().filter(|w| **w > 0.0).count();
        super::banded::norms_of(result, dimension, count, |j| self.data_weights[j] > 0.0)
    }

    /// Gathers by groups.
    fn gather_groups(
        &self,
        groups: &[u32],
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> (f64, usize, f64, usize) {
        let rows = self.rows.rows();
        let (mut largest, mut index, mut sum, mut count) = (-1.0, 0, 0.0, 0);
        for (j, (point, &group)) in data.chunks_exact(dimension).zip(groups).enumerate() {
            let weight = self.data_weight(j);
            if weight == 0.0 {
                continue;
            }
            let row = &rows.weights[j * rows.width..][..rows.width];
            let group = group as usize;
            let mut square = 0.0;
            for (i, q) in point.iter().enumerate() {
                let near = |k: usize| control[rows.column(rows.first[j], k) * dimension + i];
                let x = row.iter().enumerate().fold(*q, |x, (k, w)| x - w * near(k));
                square += x * x;
                result[group * dimension + i] += weight / self.sums[group] * x;
            }
            sum += square;
            count += 1;
            if square > largest {
                (largest, index) = (square, j);
            }
        }
        (largest, index, sum, count)
    }
}

fn norms(largest: f64, max_index: usize, sum: f64, count: usize) -> ResidualNorms {
    let max = if sum.is_finite() { largest.max(0.0).sqrt() } else { f64::NAN };
    ResidualNorms { max, max_index, rms: (sum / count.max(1) as f64).sqrt(), normal: None }
}

impl CollocationOperator for LeastSquaresCollocation {
    fn points(&self) -> usize {
        self.points
    }

    fn control_points(&self) -> usize {
        self.sums.len()
    }

    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        kernel::apply(self.rows.rows(), x, dimension, result);
    }

    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        result.fill(0.0);
        let (largest, index, sum, count) = match &self.groups {
            Some(groups) => self.gather_groups(groups, data, control, dimension, result),
            None => {
                let rows = self.rows.rows();
                let squares = normal_kernel::gather(
                    rows,
                    &self.data_weights,
                    data,
                    control,
                    dimension,
                    result,
                );
                (squares.largest, squares.index, squares.sum, squares.count)
            }
        };
        let own = (dimension / self.side_by_side).max(1);
        let mut farthest = 0.0_f64;
        let vectors = result.chunks_exact_mut(dimension);
        for (vector, (&stays, &weight)) in vectors.zip(self.stays.iter().zip(&self.sums)) {
            if stays {
                vector.fill(0.0);
                continue;
            }
            let share = if self.groups.is_some() { 1.0 } else { weight.recip() };
            for point in vector.chunks(own) {
                let square: f64 = point.iter().map(|x| (share * x) * (share * x)).sum();
                farthest = farthest.max(square);
            }
        }
        let normal = if sum.is_finite() { farthest.sqrt() } else { f64::NAN };
        ResidualNorms { normal: Some(normal), ..norms(largest, index, sum, count) }
    }
}

/// `A^T W A`, a symmetric band, as one more square collocation matrix: sweeps and factors of it are
/// those of least squares. The row and the column of a control point that stays are those of the
/// identity.
#[derive(Debug, Clone)]
pub struct NormalMatrix {
    matrix: BandedCollocation,
    sums: Vec<f64>,
    stays: Vec<bool>,
}

impl NormalMatrix {
    /// The matrix.
    #[must_use]
    pub fn matrix(&self) -> &BandedCollocation {
        &self.matrix
    }

    /// Whether a control point stays.
    #[must_use]
    pub fn stays(&self) -> &[bool] {
        &self.stays
    }

    /// Column sums `A^T W 1`.
    #[must_use]
    pub fn column_sums(&self) -> &[f64] {
        &self.sums
    }

    /// Reciprocal column sums, 0 for control points that stay.
    #[must_use]
    pub fn reciprocal_sums(&self) -> Vec<f64> {
        self.reciprocals(|i| self.sums[i])
    }

    /// Reciprocal diagonal, 0 for control points that stay.
    #[must_use]
    pub fn reciprocal_diagonal(&self) -> Vec<f64> {
        use super::CollocationMatrix;
        self.reciprocals(|i| self.matrix.diagonal(i))
    }

    fn reciprocals(&self, entry: impl Fn(usize) -> f64) -> Vec<f64> {
        let each = self.stays.iter().enumerate();
        each.map(|(i, &stays)| if stays { 0.0 } else { entry(i).recip() }).collect()
    }

    /// Smallest and largest eigenvalue of the control points that move, zeros left out; `None` if
    /// there are no others.
    #[must_use]
    pub fn eigenvalues(&self) -> Option<(f64, f64)> {
        SymmetricBand::new(&self.matrix, &self.stays, None).extremes()
    }

    /// The same of `C^-1 A^T W A`, where C are the column sums: none exceeds 1.
    #[must_use]
    pub fn scaled_eigenvalues(&self) -> Option<(f64, f64)> {
        SymmetricBand::new(&self.matrix, &self.stays, Some(&self.sums)).extremes()
    }

    /// With a share of the column sums added to the diagonal of control points that move.
    pub(crate) fn shifted(&self, share: f64) -> BandedCollocation {
        let (width, first, mut weights) = self.matrix.clone().into_rows();
        for (i, (&stays, &sum)) in self.stays.iter().zip(&self.sums).enumerate() {
            if !stays {
                weights[i * width + width / 2] += share * sum;
            }
        }
        BandedCollocation::from_rows(width, first, weights)
    }
}
