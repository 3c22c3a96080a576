//! What the approximation of a grid has to meet: data points within a distance, and calm in between.

use super::cells::Cells;
use crate::fit::approximate::Measure;

/// Data and demands; coordinates are scaled and centred.
#[derive(Debug, Clone)]
pub(super) struct Problem<'a> {
    pub(super) cells: Cells<'a>,
    pub(super) degrees: [usize; 2],
    /// Parameters of rows and columns to begin with, on [0, 1]; on [0, 1) where closed.
    pub(super) lines: [Vec<f64>; 2],
    /// Whether they stay: heights over a lattice are measured where they stand.
    pub(super) kept: bool,
    pub(super) measure: Measure,
    /// The distance allowed.
    pub(super) tolerance: f64,
    /// The judged ratio that will do: 1, or 0 to get as close as can be.
    pub(super) enough: f64,
    /// How far the surface may stray from the cells between points.
    pub(super) allowance: f64,
    /// What a local interpolant of the same points strays.
    pub(super) natural: f64,
}

/// Share of the distance allowed that the surface may stray beyond what the data themselves explain.
const STRAY: f64 = 1.05;
/// Multiple of the overshoot of a local interpolant that passes for calm; a little less than the 1.5
/// reported, since the surface is watched at places.
const NATURAL: f64 = 1.4;

impl<'a> Problem<'a> {
    pub(super) fn new(
        cells: Cells<'a>,
        degrees: [usize; 2],
        lines: [Vec<f64>; 2],
        measure: Measure,
        tolerance: f64,
    ) -> Self {
        let natural = cells.natural([&lines[0], &lines[1]]);
        let kept = cells.in_place;
        let mut problem = Self {
            cells,
            degrees,
            lines,
            kept,
            measure,
            tolerance,
            enough: 1.0,
            allowance: 0.0,
            natural,
        };
        problem.allow(tolerance);
        problem
    }

    /// Sets the distance allowed, and with it how far the surface may stray.
    pub(super) fn allow(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
        self.allowance = NATURAL * self.natural + STRAY * tolerance;
    }

    pub(super) fn points(&self) -> usize {
        self.cells.shape[0] * self.cells.shape[1]
    }

    pub(super) fn dimension(&self) -> usize {
        self.cells.dimension
    }

    pub(super) fn closed(&self) -> [bool; 2] {
        self.cells.closed
    }

    /// Control points that move in direction `k` besides breakpoints.
    fn surplus(&self, k: usize) -> usize {
        if self.closed()[k] { 0 } else { self.degrees[k] + 1 }
    }

    /// Rows or columns of control points that move, for a number of breakpoints.
    pub(super) fn control_lines(&self, k: usize, breaks: usize) -> usize {
        breaks + self.surplus(k)
    }

    /// Breakpoints for a number of rows or columns of control points that move.
    pub(super) fn breaks_for(&self, k: usize, lines: usize) -> usize {
        lines.saturating_sub(self.surplus(k)).max(self.fewest_breaks(k))
    }

    /// Fewest breakpoints: inner knots of an open direction, knots in a period of a closed one.
    pub(super) fn fewest_breaks(&self, k: usize) -> usize {
        if self.closed()[k] { self.degrees[k] + 1 } else { 0 }
    }

    /// Most breakpoints: as many control points as data points.
    pub(super) fn most_breaks(&self, k: usize) -> usize {
        self.breaks_for(k, self.cells.shape[k])
    }

    /// Breakpoints of an interpolant, over means of neighbouring parameters.
    pub(super) fn dense_breaks(&self, k: usize) -> Vec<f64> {
        let (t, p) = (&self.lines[k], self.degrees[k]);
        if self.closed()[k] {
            return t.clone();
        }
        (1..t.len() - p).map(|j| t[j..j + p].iter().sum::<f64>() / p as f64).collect()
    }
}
