//! Rows near one place of a long open curve with averaged knots, without the rest of it: what an
//! edit of one data point looks at.

use std::ops::Range;

use super::{BandedCollocation, kernel};
use crate::Error;
use crate::basis::basis_functions;
use crate::knots::{MAX_DEGREE, averaged_knot};

/// The averaged knots that consecutive parameters of a curve determine.
#[derive(Debug)]
pub(crate) struct LocalKnots {
    degree: usize,
    /// Data points of the whole curve.
    points: usize,
    /// Position of the first knot held, in the whole knot vector.
    start: usize,
    values: Vec<f64>,
}

impl LocalKnots {
    /// Knots from the parameters of the points `first ..`, of `points` in all.
    pub(crate) fn new(degree: usize, t: &[f64], first: usize, points: usize) -> Self {
        let end = first + t.len();
        let start = if first == 0 { 0 } else { first + degree };
        let past = if end == points { points + degree + 1 } else { end + 1 };
        let mut highest = f64::NEG_INFINITY;
        let values = (start..past)
            .map(|k| {
                let knot = if k <= degree {
                    t[0]
                } else if k >= points {
                    t[t.len() - 1]
                } else {
                    averaged_knot(&t[k - degree - first..k - first])
                };
                // Means of ascending values ascend, but for the rounding of their sums.
                highest = highest.max(knot);
                highest
            })
            .collect();
        Self { degree, points, start, values }
    }

    fn at(&self, k: usize) -> f64 {
        self.values[k - self.start]
    }

    /// The span of `t`, which is not less than parameter `j` and less than parameter `j + 1`.
    pub(crate) fn span(&self, j: usize, t: f64) -> usize {
        let last = self.points - 1;
        let mut span = j.clamp(self.degree, last);
        while span < last.min(j + self.degree) && self.at(span + 1) <= t {
            span += 1;
        }
        while span > self.degree.max(self.start) && self.at(span) >= self.at(span + 1) {
            span -= 1;
        }
        span
    }

    /// The `p + 1` functions `span - p ..= span` at `t`.
    pub(crate) fn functions(&self, span: usize, t: f64, values: &mut [f64]) {
        // The kernel reads the 2 p knots around the span, and nothing before them.
        let before = span + 1 - self.degree - self.start;
        basis_functions(&self.values[before..], self.degree, self.degree - 1, t, values);
    }
}

/// Rows of consecutive data points over the control points near them.
#[derive(Debug)]
pub(crate) struct WindowCollocation {
    /// Data points that have a row.
    rows: Range<usize>,
    /// Control points that have a column.
    columns: Range<usize>,
    width: usize,
    /// First column of each row, counted from the first control point held.
    first: Vec<i32>,
    weights: Vec<f64>,
}

/// What moving the control points `moved` of a curve of `points` points changes: the rows that see
/// them, and the points whose parameters and control points those rows rest on.
pub(crate) fn surroundings(
    degree: usize,
    points: usize,
    moved: &Range<usize>,
) -> (Range<usize>, Range<usize>) {
    let around = |reach: usize| {
        moved.start.saturating_sub(reach)..moved.end.saturating_add(reach).min(points)
    };
    (around(degree), around(3 * degree))
}

impl WindowCollocation {
    /// Rows `rows` from the parameters `t` of the points `held`.
    ///
    /// # Errors
    /// [`Error::SchoenbergWhitney`] where rounding leaves a data point without its basis function.
    pub(crate) fn new(
        degree: usize,
        points: usize,
        rows: Range<usize>,
        held: Range<usize>,
        t: &[f64],
    ) -> Result<Self, Error> {
        let knots = LocalKnots::new(degree, t, held.start, points);
        let width = degree + 1;
        let mut first = Vec::with_capacity(rows.len());
        let mut weights = vec![0.0; rows.len() * width];
        let mut values = [0.0; MAX_DEGREE + 1];
        for (j, row) in rows.clone().zip(weights.chunks_exact_mut(width)) {
            let parameter = t[j - held.start];
            let span = knots.span(j, parameter);
            knots.functions(span, parameter, &mut values);
            row.copy_from_slice(&values[..width]);
            let own = (j + degree).checked_sub(span).and_then(|k| row.get(k));
            if own.is_none_or(|&weight| weight.is_nan() || weight <= 0.0) {
                return Err(Error::SchoenbergWhitney { point: j, parameter });
            }
            first.push((span - degree) as i32 - held.start as i32);
        }
        Ok(Self { rows, columns: held, width, first, weights })
    }

    /// Writes the difference vectors of the rows; `data` has a point per row, `control` one per
    /// column.
    pub(crate) fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) {
        let rows = kernel::Rows {
            width: self.width,
            columns: self.columns.len(),
            first: &self.first,
            weights: &self.weights,
        };
        kernel::residual(rows, data, control, dimension, result);
    }

    /// The matrix of local PIA of the points `moved`, which have rows.
    pub(crate) fn within(&self, moved: &Range<usize>) -> BandedCollocation {
        let count = moved.len();
        let width = self.width.min(count);
        let shift = self.columns.start as i32 - moved.start as i32;
        let mut first = Vec::with_capacity(count);
        let mut weights = vec![0.0; count * width];
        for (j, row) in moved.clone().zip(weights.chunks_exact_mut(width)) {
            let at = j - self.rows.start;
            let from = self.first[at] + shift;
            let start = from.clamp(0, (count - width) as i32);
            for (k, &weight) in self.weights[at * self.width..][..self.width].iter().enumerate() {
                let column = from + k as i32;
                if (0..count as i32).contains(&column) {
                    row[(column - start) as usize] = weight;
                }
            }
            first.push(start);
        }
        BandedCollocation::from_rows(width, first, weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collocation::interpolation;
    use crate::knots::{KnotPlacement, place_knots};
    use crate::parameters::Parameters;

    #[test]
    fn rows_of_a_window_are_those_of_the_whole_bit_by_bit() {
        let t: Vec<f64> =
            (0..90).map(|j| f64::from(j) + 0.4 * (1.7 * f64::from(j)).sin()).collect();
        for degree in 1..=9 {
            let parameters = Parameters::open(t.clone()).unwrap();
            let knots = place_knots(degree, &parameters, &KnotPlacement::Averaged).unwrap();
            let whole = interpolation(&parameters, &knots).unwrap().operator;
            for moved in [0..1, 0..20, 30..31, 25..60, 80..90, 0..90] {
                let (rows, held) = surroundings(degree, 90, &moved);
                let near = &t[held.clone()];
                let part =
                    WindowCollocation::new(degree, 90, rows.clone(), held.clone(), near).unwrap();
                for (at, j) in rows.enumerate() {
                    let first = (part.first[at] + held.start as i32) as usize;
                    let ours = part.weights[at * (degree + 1)..][..degree + 1].iter().enumerate();
                    let ours: Vec<_> =
                        ours.map(|(k, &w)| (first + k, w)).filter(|(_, w)| *w != 0.0).collect();
                    assert_eq!(ours, whole.row(j).collect::<Vec<_>>(), "{degree} {j}");
                }
                let restricted = whole.restricted(&moved.clone().collect::<Vec<_>>());
                let matrix = part.within(&moved);
                for row in 0..moved.len() {
                    let theirs: Vec<_> = restricted.row(row).collect();
                    assert_eq!(matrix.row(row).collect::<Vec<_>>(), theirs, "{degree} {moved:?}");
                }
            }
        }
    }
}
