//! Inner loops over rows of weights. Slices in, slices out; callers check first.
//!
//! `D` is the dimension and `W` the row width when known at compile time, 0 when not; one body
//! serves both, and the compiler unrolls the former.

/// Rows of `width` weights that start at an unwrapped column each.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub(crate) width: usize,
    pub(crate) columns: usize,
    /// Column of the first weight; below 0 or past the last column it wraps round.
    pub(crate) first: &'a [i32],
    pub(crate) weights: &'a [f64],
}

impl Rows<'_> {
    /// Column of weight `k` of a row that starts at `first`.
    #[inline(always)]
    pub(crate) fn column(&self, first: i32, k: usize) -> usize {
        let column = first as isize + k as isize;
        let count = self.columns as isize;
        (if column < 0 {
            column + count
        } else if column >= count {
            column - count
        } else {
            column
        }) as usize
    }

    /// Whether no weight of a row wraps round.
    #[inline(always)]
    fn is_plain(&self, first: i32, width: usize) -> bool {
        first >= 0 && first as usize + width <= self.columns
    }
}

/// Picks the unrolled copy for the usual widths and dimensions.
macro_rules! dispatch {
    ($function:ident, $width:expr, $dimension:expr, $($argument:expr),*) => {
        match ($width, $dimension) {
            (4, 1) => $function::<4, 1>($($argument),*),
            (4, 2) => $function::<4, 2>($($argument),*),
            (4, 3) => $function::<4, 3>($($argument),*),
            (3, 2) => $function::<3, 2>($($argument),*),
            (3, 3) => $function::<3, 3>($($argument),*),
            (6, 2) => $function::<6, 2>($($argument),*),
            (6, 3) => $function::<6, 3>($($argument),*),
            (_, 1) => $function::<0, 1>($($argument),*),
            (_, 2) => $function::<0, 2>($($argument),*),
            (_, 3) => $function::<0, 3>($($argument),*),
            (_, 4) => $function::<0, 4>($($argument),*),
            _ => $function::<0, 0>($($argument),*),
        }
    };
}

/// `result = data - A x`, with the largest squared norm of a row, its index, and the sum of all.
pub(crate) fn residual(
    rows: Rows<'_>,
    data: &[f64],
    x: &[f64],
    dimension: usize,
    result: &mut [f64],
) -> (f64, usize, f64) {
    dispatch!(residual_of, rows.width, dimension, rows, data, x, dimension, result)
}

#[inline(always)]
fn residual_of<const W: usize, const D: usize>(
    rows: Rows<'_>,
    data: &[f64],
    x: &[f64],
    dimension: usize,
    result: &mut [f64],
) -> (f64, usize, f64) {
    let width = if W == 0 { rows.width } else { W };
    let dimension = if D == 0 { dimension } else { D };
    let (mut largest, mut index, mut sum) = (-1.0, 0, 0.0);
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(width));
    let points = data.chunks_exact(dimension).zip(result.chunks_exact_mut(dimension));
    for (j, ((&first, weights), (q, r))) in lines.zip(points).enumerate() {
        let mut square = 0.0;
        if D == 0 {
            r.copy_from_slice(q);
            accumulate_row::<W, D, false>(rows, first, weights, x, r);
            r.iter().for_each(|component| square += component * component);
        } else {
            let mut difference = [0.0; D];
            difference.copy_from_slice(q);
            accumulate_row::<W, D, false>(rows, first, weights, x, &mut difference);
            difference.iter().for_each(|component| square += component * component);
            r.copy_from_slice(&difference);
        }
        sum += square;
        // A NaN is caught by the sum.
        if square > largest {
            largest = square;
            index = j;
        }
    }
    (largest.max(0.0), index, sum)
}

/// Numbers that are worked on side by side where the dimension is large.
pub(super) const LANES: usize = 8;

/// Row `j` of `A x` for wide rows of `length` numbers.
pub(super) fn combine(rows: Rows<'_>, j: usize, x: &[f64], length: usize, result: &mut [f64]) {
    match rows.width {
        2 => combine_of::<2>(rows, j, x, length, result),
        3 => combine_of::<3>(rows, j, x, length, result),
        4 => combine_of::<4>(rows, j, x, length, result),
        6 => combine_of::<6>(rows, j, x, length, result),
        _ => {
            let (first, weights) = (rows.first[j], &rows.weights[j * rows.width..][..rows.width]);
            let result = &mut result[..length];
            result.fill(0.0);
            for (k, &weight) in weights.iter().enumerate() {
                let row = &x[rows.column(first, k) * length..][..length];
                result.iter_mut().zip(row).for_each(|(sum, x)| *sum += weight * x);
            }
        }
    }
}

#[inline(always)]
fn combine_of<const W: usize>(
    rows: Rows<'_>,
    j: usize,
    x: &[f64],
    length: usize,
    result: &mut [f64],
) {
    let first = rows.first[j];
    let weights: [f64; W] = std::array::from_fn(|k| rows.weights[j * W + k]);
    let near: [&[f64]; W] = std::array::from_fn(|k| &x[rows.column(first, k) * length..][..length]);
    let result = &mut result[..length];
    for i in 0..length {
        let mut sum = 0.0;
        for k in 0..W {
            sum += weights[k] * near[k][i];
        }
        result[i] = sum;
    }
}

/// `result = A x`.
pub(crate) fn apply(rows: Rows<'_>, x: &[f64], dimension: usize, result: &mut [f64]) {
    dispatch!(apply_of, rows.width, dimension, rows, x, dimension, result);
}

#[inline(always)]
fn apply_of<const W: usize, const D: usize>(
    rows: Rows<'_>,
    x: &[f64],
    dimension: usize,
    result: &mut [f64],
) {
    let width = if W == 0 { rows.width } else { W };
    let dimension = if D == 0 { dimension } else { D };
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(width));
    for ((&first, weights), point) in lines.zip(result.chunks_exact_mut(dimension)) {
        point.fill(0.0);
        accumulate_row::<W, D, true>(rows, first, weights, x, point);
    }
}

/// Adds `sum_k weights[k] x[column k]` to a point, or takes it away.
#[inline(always)]
fn accumulate_row<const W: usize, const D: usize, const ADD: bool>(
    rows: Rows<'_>,
    first: i32,
    weights: &[f64],
    x: &[f64],
    point: &mut [f64],
) {
    let width = if W == 0 { weights.len() } else { W };
    let dimension = if D == 0 { point.len() } else { D };
    let point = &mut point[..dimension];
    let mut accumulate = |k: usize, control: &[f64]| {
        for i in 0..dimension {
            let part = weights[k] * control[i];
            point[i] = if ADD { point[i] + part } else { point[i] - part };
        }
    };
    if rows.is_plain(first, width) {
        let near = &x[first as usize * dimension..][..width * dimension];
        for k in 0..width {
            accumulate(k, &near[k * dimension..][..dimension]);
        }
    } else {
        for k in 0..width {
            accumulate(k, &x[rows.column(first, k) * dimension..][..dimension]);
        }
    }
}

/// Solves `(D / omega + L) y = r` in place, where D is the diagonal and L what stands left of it:
/// one sweep of successive over-relaxation, told in difference vectors.
pub(crate) fn sweep(rows: Rows<'_>, omega: f64, vectors: &mut [f64], dimension: usize) {
    dispatch!(sweep_of, rows.width, dimension, rows, omega, vectors, dimension);
}

#[inline(always)]
fn sweep_of<const W: usize, const D: usize>(
    rows: Rows<'_>,
    omega: f64,
    vectors: &mut [f64],
    dimension: usize,
) {
    let width = if W == 0 { rows.width } else { W };
    let dimension = if D == 0 { dimension } else { D };
    let lines = rows.first.iter().zip(rows.weights.chunks_exact(width));
    for (j, (&first, weights)) in lines.enumerate() {
        let (before, here) = vectors.split_at_mut(j * dimension);
        let here = &mut here[..dimension];
        let mut diagonal = 1.0;
        for k in 0..width {
            let column = rows.column(first, k);
            if column < j {
                let moved = &before[column * dimension..][..dimension];
                for i in 0..dimension {
                    here[i] -= weights[k] * moved[i];
                }
            } else if column == j {
                diagonal = weights[k];
            }
        }
        let scale = omega / diagonal;
        for i in 0..dimension {
            here[i] *= scale;
        }
    }
}
