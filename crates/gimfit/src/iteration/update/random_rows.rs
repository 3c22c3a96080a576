//! Randomised rows: the randomised Kaczmarz method (Strohmer and Vershynin 2009), extended so that it
//! ends at the least squares fit (Zouzias and Freris 2013).
//!
//! A draw of data point j, with probability `||a_j||^2 / ||A||_F^2` for row `a_j` of A, moves the few
//! control points near it so that the curve passes through `q_j - z_j`. Here z are vectors at the data
//! that tend to what least squares leaves: a draw of control point i takes its part out of them,
//! `z <- z - (a_i^T z / ||a_i||^2) a_i` for the column `a_i`. Without z the curve would follow one point
//! after another and never settle unless it can pass through all of them.
//!
//! A step of the loop draws as many data points as there are, and as many control points as there
//! are, evenly in between.

use super::{Step, UpdateRule};
use crate::collocation::{CollocationOperator, LeastSquaresCollocation};
use crate::iteration::random::{Draw, Random};
use crate::memory;

/// Single data points in random order.
#[derive(Debug)]
pub struct RandomRows<'a> {
    operator: &'a LeastSquaresCollocation,
    data: &'a [f64],
    /// Squares of rows and of columns, over the control points that move.
    row_squares: Vec<f64>,
    column_squares: Vec<f64>,
    rows: Draw,
    columns: Draw,
    random: Random,
    /// The rows by the column they start at: those of start s stand at `starts[s]..starts[s + 1]`.
    order: Vec<u32>,
    starts: Vec<usize>,
    /// The vectors z, and control points under way.
    rest: Vec<f64>,
    control: Vec<f64>,
}

impl<'a> RandomRows<'a> {
    /// Draws from a seed; the same seed draws the same. `data` has shape (points, dimension).
    #[must_use]
    pub fn new(operator: &'a LeastSquaresCollocation, data: &'a [f64], seed: u64) -> Self {
        let (rows, stays) = (operator.rows(), operator.stays());
        let points = operator.points();
        let dimension = data.len() / points;
        let mut row_squares = vec![0.0; points];
        let mut column_squares = vec![0.0; rows.columns];
        let mut starts = vec![0; rows.columns + 1];
        for (j, &first) in rows.first.iter().enumerate() {
            starts[rows.column(first, 0) + 1] += 1;
            for k in 0..rows.width {
                let (column, weight) = (rows.column(first, k), rows.weights[j * rows.width + k]);
                if !stays[column] {
                    row_squares[j] += weight * weight;
                    column_squares[column] += operator.data_weight(j) * weight * weight;
                }
            }
        }
        (0..rows.columns).for_each(|s| starts[s + 1] += starts[s]);
        let mut place = starts.clone();
        let mut order = vec![0; points];
        for (j, &first) in rows.first.iter().enumerate() {
            let start = rows.column(first, 0);
            order[place[start]] = j as u32;
            place[start] += 1;
        }
        let weighted: Vec<f64> =
            (0..points).map(|j| operator.data_weight(j) * row_squares[j]).collect();
        Self {
            operator,
            data,
            rows: Draw::new(&weighted),
            columns: Draw::new(&column_squares),
            row_squares,
            column_squares,
            random: Random::new(seed),
            order,
            starts,
            rest: memory::zeros(data.len()),
            control: memory::zeros(rows.columns * dimension),
        }
    }

    /// The curve through `q_j - z_j`.
    fn meet(&mut self, j: usize, dimension: usize) {
        let (rows, stays) = (self.operator.rows(), self.operator.stays());
        let (first, row) = (rows.first[j], &rows.weights[j * rows.width..][..rows.width]);
        for c in 0..dimension {
            let at = j * dimension + c;
            let mut gap = self.data[at] - self.rest[at];
            for (k, weight) in row.iter().enumerate() {
                gap -= weight * self.control[rows.column(first, k) * dimension + c];
            }
            let scaled = gap / self.row_squares[j];
            for (k, weight) in row.iter().enumerate() {
                let column = rows.column(first, k);
                if !stays[column] {
                    self.control[column * dimension + c] += weight * scaled;
                }
            }
        }
    }

    /// The vectors z without the part of a column.
    fn take_out(&mut self, column: usize, dimension: usize) {
        let rows = self.operator.rows();
        for c in 0..dimension {
            let mut part = 0.0;
            for pass in 0..2 {
                for k in 0..rows.width {
                    let start = (column + rows.columns - k % rows.columns) % rows.columns;
                    for &j in &self.order[self.starts[start]..self.starts[start + 1]] {
                        let j = j as usize;
                        let weight = rows.weights[j * rows.width + k];
                        if pass == 0 {
                            let counts = self.operator.data_weight(j);
                            part += counts * weight * self.rest[j * dimension + c];
                        } else {
                            self.rest[j * dimension + c] -= part * weight;
                        }
                    }
                }
                if pass == 0 {
                    part /= self.column_squares[column];
                }
            }
        }
    }
}

impl UpdateRule for RandomRows<'_> {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let dimension = step.dimension;
        self.control.copy_from_slice(step.control);
        if step.iteration == 0 {
            // What control points that stay contribute is no part of what is to be met.
            self.operator.at_data(self.data, &self.control, dimension, &mut self.rest);
        }
        let (points, columns) = (self.row_squares.len(), self.column_squares.len());
        let mut drawn = 0;
        for turn in 0..points {
            while drawn * points < (turn + 1) * columns {
                drawn += 1;
                if let Some(column) = self.columns.next(&mut self.random) {
                    self.take_out(column, dimension);
                }
            }
            if let Some(j) = self.rows.next(&mut self.random) {
                self.meet(j, dimension);
            }
        }
        for (x, (new, old)) in vectors.iter_mut().zip(self.control.iter().zip(step.control)) {
            *x = new - old;
        }
    }

    fn reset(&mut self) {
        self.random.reset();
    }
}
