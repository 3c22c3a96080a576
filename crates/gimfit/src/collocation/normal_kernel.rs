//! Inner loops of least squares: difference vectors gathered at control points, and the band of the
//! normal matrix. Slices in, slices out; callers check first.
//!
//! Neighbouring data points mostly share a span: what they add to its control points is summed up
//! beside the loop, and added once per run of such points.

use super::kernel::Rows;
use crate::knots::MAX_DEGREE;

/// Largest squared norm of a difference vector, its index, the sum of all, and how many there are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Squares {
    pub(super) largest: f64,
    pub(super) index: usize,
    pub(super) sum: f64,
    pub(super) count: usize,
}

impl Squares {
    const NONE: Self = Self { largest: -1.0, index: 0, sum: 0.0, count: 0 };

    #[inline(always)]
    fn note(&mut self, j: usize, square: f64) {
        self.sum += square;
        self.count += 1;
        // A NaN is caught by the sum.
        if square > self.largest {
            (self.largest, self.index) = (square, j);
        }
    }
}

/// Adds `A^T W (data - A control)` to `result`. `data_weights` is empty where all are 1; points of
/// weight 0 do not count.
pub(super) fn gather(
    rows: Rows<'_>,
    data_weights: &[f64],
    data: &[f64],
    control: &[f64],
    dimension: usize,
    result: &mut [f64],
) -> Squares {
    let arguments = (rows, data_weights, data, control);
    match (rows.width, dimension) {
        (4, 1) => gather_of::<4, 1>(arguments, result),
        (4, 2) => gather_of::<4, 2>(arguments, result),
        (4, 3) => gather_of::<4, 3>(arguments, result),
        (3, 2) => gather_of::<3, 2>(arguments, result),
        (3, 3) => gather_of::<3, 3>(arguments, result),
        (6, 2) => gather_of::<6, 2>(arguments, result),
        (6, 3) => gather_of::<6, 3>(arguments, result),
        _ => gather_any(arguments, dimension, result),
    }
}

type Arguments<'a> = (Rows<'a>, &'a [f64], &'a [f64], &'a [f64]);

fn gather_of<const W: usize, const D: usize>(
    (rows, data_weights, data, control): Arguments<'_>,
    result: &mut [f64],
) -> Squares {
    let mut squares = Squares::NONE;
    let (points, _) = data.as_chunks::<D>();
    let (weights, _) = rows.weights.as_chunks::<W>();
    for_each_run(rows, |first, run| {
        let columns: [usize; W] = std::array::from_fn(|k| rows.column(first, k));
        let near: [[f64; D]; W] =
            std::array::from_fn(|k| std::array::from_fn(|i| control[columns[k] * D + i]));
        let mut sums = [[0.0; D]; W];
        for j in run {
            let (row, mut vector) = (&weights[j], points[j]);
            for k in 0..W {
                for i in 0..D {
                    vector[i] -= row[k] * near[k][i];
                }
            }
            let square: f64 = vector.iter().map(|x| x * x).sum();
            if let Some(&weight) = data_weights.get(j) {
                if weight == 0.0 {
                    continue;
                }
                vector.iter_mut().for_each(|x| *x *= weight);
            }
            squares.note(j, square);
            for k in 0..W {
                for i in 0..D {
                    sums[k][i] += row[k] * vector[i];
                }
            }
        }
        for k in 0..W {
            for i in 0..D {
                result[columns[k] * D + i] += sums[k][i];
            }
        }
    });
    squares
}

fn gather_any(
    (rows, data_weights, data, control): Arguments<'_>,
    dimension: usize,
    result: &mut [f64],
) -> Squares {
    let mut squares = Squares::NONE;
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(rows.width));
    for (j, (&first, row)) in lines.enumerate() {
        let weight = data_weights.get(j).copied().unwrap_or(1.0);
        if weight == 0.0 {
            continue;
        }
        let point = &data[j * dimension..][..dimension];
        let mut square = 0.0;
        // Coordinate by coordinate: no memory is needed, whatever the dimension.
        for (i, &q) in point.iter().enumerate() {
            let mut x = q;
            for (k, w) in row.iter().enumerate() {
                x -= w * control[rows.column(first, k) * dimension + i];
            }
            square += x * x;
            x *= weight;
            for (k, w) in row.iter().enumerate() {
                result[rows.column(first, k) * dimension + i] += w * x;
            }
        }
        squares.note(j, square);
    }
    squares
}

/// Adds the upper half of `A^T W A` to `band`, whose row i holds the columns i, i + 1, ..., i + degree,
/// unwrapped; and `A^T W 1` to `sums`.
pub(super) fn gather_band(
    rows: Rows<'_>,
    data_weights: &[f64],
    band: &mut [f64],
    sums: &mut [f64],
) {
    match rows.width {
        2 => band_of::<2>(rows, data_weights, band, sums),
        3 => band_of::<3>(rows, data_weights, band, sums),
        4 => band_of::<4>(rows, data_weights, band, sums),
        5 => band_of::<5>(rows, data_weights, band, sums),
        6 => band_of::<6>(rows, data_weights, band, sums),
        _ => band_of::<{ MAX_DEGREE + 1 }>(rows, data_weights, band, sums),
    }
}

/// `W` is the width of a row, or more.
fn band_of<const W: usize>(
    rows: Rows<'_>,
    data_weights: &[f64],
    band: &mut [f64],
    sums: &mut [f64],
) {
    let width = rows.width.min(W);
    for_each_run(rows, |first, run| {
        let mut gram = [[0.0; W]; W];
        let mut totals = [0.0; W];
        for j in run {
            let row = &rows.weights[j * width..][..width];
            let weight = data_weights.get(j).copied().unwrap_or(1.0);
            for k in 0..width {
                let scaled = weight * row[k];
                totals[k] += scaled;
                for l in k..width {
                    gram[k][l] += scaled * row[l];
                }
            }
        }
        for k in 0..width {
            let column = rows.column(first, k);
            sums[column] += totals[k];
            let own = &mut band[column * width..][..width - k];
            own.iter_mut().zip(&gram[k][k..width]).for_each(|(entry, sum)| *entry += sum);
        }
    });
}

/// Adds `A^T W 1` to `sums`.
pub(super) fn gather_sums(rows: Rows<'_>, data_weights: &[f64], sums: &mut [f64]) {
    let width = rows.width;
    for_each_run(rows, |first, run| {
        let mut totals = [0.0; MAX_DEGREE + 1];
        let totals = &mut totals[..width];
        for j in run {
            let weight = data_weights.get(j).copied().unwrap_or(1.0);
            let row = &rows.weights[j * width..][..width];
            totals.iter_mut().zip(row).for_each(|(total, value)| *total += weight * value);
        }
        for (k, total) in totals.iter().enumerate() {
            sums[rows.column(first, k)] += total;
        }
    });
}

/// Calls `each` for every run of rows that start at the same column.
#[inline(always)]
fn for_each_run(rows: Rows<'_>, mut each: impl FnMut(i32, std::ops::Range<usize>)) {
    let mut start = 0;
    while let Some(&first) = rows.first.get(start) {
        let length = rows.first[start..].iter().take_while(|&&other| other == first).count();
        each(first, start..start + length);
        start += length;
    }
}
