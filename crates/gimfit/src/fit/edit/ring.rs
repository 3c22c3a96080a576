//! Closed curves, unrolled: round after round of the same points, without an end.
//!
//! Far from the ends of an open curve with averaged knots nothing tells it from an unrolled closed one,
//! so that windows are those of an open curve. Positions on the unrolled curve count from the start of
//! the round before the first.

use std::ops::Range;

use super::place::distance;
use super::row_sums::row_sums;
use super::window::{Change, Edited, Goal, Settled};
use super::{EditableCurve, blocks::ROW_SUM};
use crate::Error;
use crate::collocation::ControlLayout;
use crate::fit::{CurveOptions, interpolate};
use crate::knots::{KnotPlacement, place_knots};
use crate::parameters::Parameters;
use crate::points::PointsView;

/// Position of a point on the unrolled curve as a position and the parameter that is added.
pub(super) fn in_round(place: usize, count: usize, period: f64) -> (usize, f64) {
    (place % count, ((place / count) as f64 - 1.0) * period)
}

/// Control points in the order of the data points: that of point `j` has its middle knot, or its two
/// middle ones, next to it.
pub(super) fn layout(degree: usize, period: Option<f64>) -> ControlLayout {
    match period {
        None => ControlLayout::Free,
        Some(_) => ControlLayout::Periodic { shift: degree / 2, degree },
    }
}

impl Edited<'_> {
    /// Rows of points of the unrolled curve, with the parameters of their first round, and the
    /// parameters that they have there.
    pub(super) fn unrolled(&self, places: &Range<usize>, period: f64) -> (Vec<f64>, Vec<f64>) {
        let (count, stride) = (self.len(), self.blocks.stride());
        let mut rows = Vec::with_capacity(places.len() * stride);
        let mut start = places.start;
        while start < places.end {
            let round = start / count * count;
            let end = places.end.min(round + count);
            rows.extend(self.rows(&(start - round..end - round)));
            start = end;
        }
        let t = places.clone().zip(rows.chunks_exact(stride));
        let t = t.map(|(place, row)| row[0] + in_round(place, count, period).1).collect();
        (rows, t)
    }

    /// Fits all points anew: a window that would reach round the whole curve.
    pub(super) fn settle_whole(&self, goal: Goal, period: f64) -> Result<Settled, Error> {
        let (count, stride, dimension) =
            (self.len(), self.blocks.stride(), self.blocks.dimension());
        let mut rows = self.rows(&(0..count));
        let column = |at: Range<usize>| -> Vec<f64> {
            rows.chunks_exact(stride).flat_map(|row| &row[at.clone()]).copied().collect()
        };
        let (t, data) = (column(0..1), column(2..2 + dimension));
        let parameters = Parameters::closed(t, period)?;
        let knots = place_knots(goal.degree, &parameters, &KnotPlacement::Averaged)?;
        let layout = layout(goal.degree, Some(period));
        let mut row_sum_residual = 0.0;
        let mut sums = column(ROW_SUM..ROW_SUM + 1);
        if self.change != Change::Move {
            (sums, row_sum_residual) = row_sums(&parameters, &knots, layout)?;
        }
        let options = CurveOptions { degree: goal.degree, ..CurveOptions::default() };
        let fit = interpolate(PointsView::new(dimension, &data)?, parameters, knots, &options)?;
        let control = layout.collect(fit.curve.control_points().coordinates(), dimension);
        let each = rows.chunks_exact_mut(stride).zip(control.chunks_exact(dimension)).zip(&sums);
        for ((row, control), &sum) in each {
            row[ROW_SUM] = sum;
            row[2 + dimension..].copy_from_slice(control);
        }
        let run = fit.report.run;
        Ok(Settled {
            window: 0..count,
            rows,
            iterations: run.iterations,
            termination: run.termination,
            max_residual: run.max_residual,
            row_sum_residual,
            largest: data.iter().chain(&control).fold(0.0, |most: f64, x| most.max(x.abs())),
        })
    }
}

impl EditableCurve {
    /// Where the unrolled curve has point `j`, and its parameter there.
    pub(super) fn unrolled_point(&self, j: isize) -> (usize, f64) {
        let count = self.len() as isize;
        let place = j.rem_euclid(count) as usize;
        let rounds = j.div_euclid(count) as f64;
        (place, self.parameter(place) + rounds * self.period.unwrap_or(0.0))
    }

    /// The points around a parameter of the domain: rows, parameters, the positions they are held for,
    /// the last one not past the parameter, and how many there are in all, on the curve unrolled if it
    /// is closed.
    pub(super) fn near(&self, t: f64) -> (Vec<&[f64]>, Vec<f64>, Range<usize>, usize, usize) {
        let (count, reach) = (self.len(), 3 * self.degree);
        let Some(period) = self.period else {
            let j = self.blocks.at_parameter(t);
            let held = j.saturating_sub(reach)..(j + reach + 1).min(count);
            let rows: Vec<&[f64]> = self.blocks.rows(held.clone()).collect();
            let parameters = rows.iter().map(|row| row[0]).collect();
            return (rows, parameters, held, j, count);
        };
        // The first point comes before or after the start of the domain.
        let round = ((t - self.parameter(0)) / period).floor();
        let j =
            self.blocks.at_parameter(t - round * period) as isize + round as isize * count as isize;
        let (rows, parameters) = (j - reach as isize..=j + reach as isize)
            .map(|j| self.unrolled_point(j))
            .map(|(place, t)| (self.blocks.row(place), t))
            .unzip();
        // Enough rounds before and after for any window.
        let before = count * (reach + 2);
        let j = (before as isize + j) as usize;
        (rows, parameters, j - reach..j + reach + 1, j, 2 * before + 2 * count)
    }

    /// What rounding of the parameters of a closed curve makes of its points next to the seam: windows
    /// across it count on where a fit of all points starts again.
    pub(super) fn seam_rounding(&self) -> f64 {
        let Some(period) = self.period else { return 0.0 };
        let (p, dimension) = (self.degree as isize, self.dimension());
        let near: Vec<(&[f64], f64)> = (-3 * p..=3 * p)
            .map(|j| self.unrolled_point(j))
            .map(|(place, t)| (&self.blocks.row(place)[2 + dimension..], t))
            .collect();
        let degree = self.degree;
        let mean = |from: usize| {
            near[from..from + degree].iter().map(|(_, t)| t).sum::<f64>() / degree as f64
        };
        // Control points of the derivative.
        let steepest = (degree..near.len() - degree).map(|j| {
            let chord = distance(near[j - 1].0, near[j].0);
            degree as f64 * chord / (mean(j) - mean(j - degree))
        });
        let steepest = steepest.fold(0.0, f64::max);
        let largest = near.iter().fold(period, |most: f64, (_, t)| most.max(t.abs()));
        // A parameter and 2 p knots, each with the rounding of a mean; a knot shifts the curve by at
        // most a p-th of what the parameter does.
        3.0 * steepest * (degree + 3) as f64 * f64::EPSILON * (largest + period)
    }
}
