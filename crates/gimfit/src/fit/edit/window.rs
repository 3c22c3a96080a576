//! One edit: local PIA of the points near it, run to its limit on wider and wider windows until the
//! points outside see no difference.

use std::f64::consts::PI;
use std::ops::Range;

use super::blocks::{Blocks, ROW_SUM};
use crate::Error;
use crate::collocation::{BandedCollocation, WindowCollocation, surroundings};
use crate::iteration::update::Preconditioned;
use crate::iteration::{IterationState, NoObserver, Outcome, ROUNDING, Stopping, Termination, run};

/// What happens to one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    Move,
    Insert,
    Remove,
}

/// The points as they will be.
pub(super) struct Edited<'a> {
    pub(super) blocks: &'a Blocks,
    pub(super) change: Change,
    pub(super) index: usize,
    /// The row that is new at `index`; empty if one is removed.
    pub(super) row: &'a [f64],
    /// About how far the curve is from its data right after the change.
    pub(super) size: f64,
    /// Of a closed curve.
    pub(super) period: Option<f64>,
}

/// What the points near an edit are to reach.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    pub(super) degree: usize,
    /// Largest residual, where rounding allows it.
    pub(super) residual: f64,
    /// Most that rounding may take instead.
    pub(super) accept_rounding: f64,
}

/// Points that have settled after an edit.
pub(super) struct Settled {
    /// The points whose control points moved.
    pub(super) window: Range<usize>,
    /// Their rows.
    pub(super) rows: Vec<f64>,
    pub(super) iterations: usize,
    pub(super) termination: Termination,
    /// Largest residual of all points that see one of them.
    pub(super) max_residual: f64,
    /// The same of the row sums of the inverse, relative to 1.
    pub(super) row_sum_residual: f64,
    /// Largest coordinate met there.
    pub(super) largest: f64,
}

/// Residual of the row sums, relative to 1: they only widen the bound by as much.
const ROW_SUM_RESIDUAL: f64 = 1e-6;
/// Most steps on one window; one or two do.
const MOST_STEPS: usize = 20;

impl Edited<'_> {
    pub(super) fn len(&self) -> usize {
        match self.change {
            Change::Move => self.blocks.len(),
            Change::Insert => self.blocks.len() + 1,
            Change::Remove => self.blocks.len() - 1,
        }
    }

    /// Rows as they will be numbered.
    pub(super) fn rows(&self, range: &Range<usize>) -> Vec<f64> {
        let mut rows = Vec::with_capacity(range.len() * self.blocks.stride());
        let copy = |old: Range<usize>, rows: &mut Vec<f64>| {
            if !old.is_empty() {
                self.blocks.rows(old).for_each(|row| rows.extend_from_slice(row));
            }
        };
        copy(range.start..range.end.min(self.index), &mut rows);
        if self.change == Change::Remove {
            copy(range.start.max(self.index) + 1..range.end + 1, &mut rows);
            return rows;
        }
        if range.contains(&self.index) {
            rows.extend_from_slice(self.row);
        }
        let after = range.start.max(self.index + 1);
        if after < range.end {
            // Past an insertion a row stood one place earlier.
            let back = usize::from(self.change == Change::Insert);
            copy(after - back..range.end - back, &mut rows);
        }
        rows
    }

    /// Runs the edit. Nothing but what is returned changes.
    pub(super) fn settle(&self, goal: Goal) -> Result<Settled, Error> {
        let count = self.len();
        let mut iterations = 0;
        let mut reach = first_reach(goal, self.size, self.change != Change::Move);
        loop {
            let window = match self.period {
                None => {
                    let end = self.index.saturating_add(reach + 1).min(count);
                    self.index.saturating_sub(reach)..end
                }
                // Where it would meet itself.
                Some(period) if 2 * (reach + 3 * goal.degree) + 1 > count => {
                    return self.settle_whole(goal, period);
                }
                Some(_) => count + self.index - reach..count + self.index + reach + 1,
            };
            let (mut settled, done) = self.settle_window(goal, window)?;
            iterations += settled.iterations;
            if done || settled.window == (0..count) {
                settled.iterations = iterations;
                return Ok(settled);
            }
            reach = (3 * reach).div_ceil(2);
        }
    }

    /// Local PIA on one window; also whether the points outside are met still.
    fn settle_window(&self, goal: Goal, window: Range<usize>) -> Result<(Settled, bool), Error> {
        let (stride, dimension) = (self.blocks.stride(), self.blocks.dimension());
        // A closed curve is unrolled, with more rounds than a window reaches into.
        let count = if self.period.is_some() { 3 * self.len() } else { self.len() };
        let (seeing, held) = surroundings(goal.degree, count, &window);
        let (mut rows, t) = match self.period {
            None => {
                let rows = self.rows(&held);
                let t = rows.chunks_exact(stride).map(|row| row[0]).collect();
                (rows, t)
            }
            Some(period) => self.unrolled(&held, period),
        };
        let column = |at: Range<usize>| -> Vec<f64> {
            rows.chunks_exact(stride).flat_map(|row| &row[at.clone()]).copied().collect()
        };
        let (data, control) = (column(2..2 + dimension), column(2 + dimension..stride));
        // The inverse has the signs of a chessboard: its row sums, without signs, are the control
        // points of data +1, -1, +1, ... but for their signs.
        let sign = |place: usize| if place.is_multiple_of(2) { 1.0 } else { -1.0 };
        let signs: Vec<f64> = (0..held.len()).map(sign).collect();
        let sums = column(ROW_SUM..ROW_SUM + 1).iter().zip(&signs).map(|(x, s)| x * s).collect();

        let operator =
            WindowCollocation::new(goal.degree, count, seeing.clone(), held.clone(), &t)?;
        let matrix = operator.within(&window);
        let rule = Preconditioned::new(&matrix, None)?;
        let view = Window { operator, matrix, rule, seeing, held: held.clone(), window };

        let largest = data.iter().chain(&control).fold(0.0, |most: f64, x| most.max(x.abs()));
        let target = goal.residual.max(ROUNDING * largest);
        let stopping = Stopping {
            residual: target,
            max_iterations: MOST_STEPS,
            accept_rounding: goal.accept_rounding.max(target),
        };
        let met = view.settle(&data, control, dimension, stopping)?;
        let mut done = met.outside <= target;
        let mut row_sums = None;
        if self.change != Change::Move {
            let stopping = Stopping { residual: ROW_SUM_RESIDUAL, ..stopping };
            let sums = view.settle(&signs, sums, 1, stopping)?;
            done &= sums.outside <= ROW_SUM_RESIDUAL;
            row_sums = Some(sums);
        }

        let inner = view.window.start - held.start..view.window.end - held.start;
        for place in inner.clone() {
            let row = &mut rows[place * stride..][..stride];
            row[2 + dimension..].copy_from_slice(&met.control[place * dimension..][..dimension]);
            if let Some(sums) = &row_sums {
                row[ROW_SUM] = sums.control[place] * signs[place];
            }
        }
        let settled = Settled {
            rows: rows[inner.start * stride..inner.end * stride].to_vec(),
            window: match self.period {
                None => view.window,
                Some(_) => {
                    let start = view.window.start % self.len();
                    start..start + view.window.len()
                }
            },
            iterations: met.outcome.iterations,
            termination: met.outcome.termination,
            max_residual: met.inside.max(met.outside),
            row_sum_residual: row_sums.map_or(0.0, |sums| sums.inside.max(sums.outside)),
            largest: met.control.iter().fold(largest, |most, x| most.max(x.abs())),
        };
        Ok((settled, done))
    }
}

/// How far the window of an edit reaches at first: to where the effect of `size` has died away by
/// the dominant pole of the inverse for equal steps, and far enough to hold all knots that change.
pub(super) fn first_reach(goal: Goal, size: f64, knots_change: bool) -> usize {
    let degree = goal.degree as f64;
    // Where the two leading terms of the symbol of the B-spline cancel.
    let decay = PI * (PI / (2.0 * degree + 2.0)).tan();
    let sums = if knots_change { -ROW_SUM_RESIDUAL.ln() } else { 0.0 };
    let digits = (size / goal.residual).ln().max(sums);
    // A size that is no number, or beyond all bounds, is met by the error of the run.
    let steps = if digits.is_finite() { (digits / decay).ceil() as usize } else { 0 };
    (steps + goal.degree).max(2 * goal.degree + 1)
}

/// The rows near an edit, and the rule of those that move.
struct Window {
    operator: WindowCollocation,
    matrix: BandedCollocation,
    rule: Preconditioned,
    /// Points that see a control point that moves.
    seeing: Range<usize>,
    /// Points at hand.
    held: Range<usize>,
    /// Points whose control points move.
    window: Range<usize>,
}

/// Control points after a run, and what it left.
struct Met {
    control: Vec<f64>,
    outcome: Outcome,
    /// Largest residual of the points whose control points moved.
    inside: f64,
    /// Of the others that see one.
    outside: f64,
}

impl Window {
    fn settle(
        &self,
        data: &[f64],
        mut control: Vec<f64>,
        dimension: usize,
        stopping: Stopping,
    ) -> Result<Met, Error> {
        let within = |points: &Range<usize>, of: &Range<usize>| {
            (points.start - of.start) * dimension..(points.end - of.start) * dimension
        };
        let data = &data[within(&self.seeing, &self.held)];
        let inner = within(&self.window, &self.seeing);
        let mut vectors = vec![0.0; data.len()];
        self.operator.difference_vectors(data, &control, dimension, &mut vectors);
        // Adjusting vectors are to meet the difference vectors: local PIA of the former.
        let mut state = IterationState::begin(&self.matrix, &vectors[inner.clone()], dimension);
        let outcome = run(&mut state, &mut self.rule.clone(), stopping, &mut NoObserver);
        let moving = &mut control[within(&self.window, &self.held)];
        moving.iter_mut().zip(state.control()).for_each(|(p, delta)| *p += delta);
        drop(state);
        self.operator.difference_vectors(data, &control, dimension, &mut vectors);
        let inside = largest(&vectors[inner.clone()], dimension);
        let outside = largest(&vectors[..inner.start], dimension)
            .max(largest(&vectors[inner.end..], dimension));
        // Every control point at hand has its part in one of these.
        if !vectors.iter().chain(&control).all(|x| x.is_finite()) || !(inside + outside).is_finite()
        {
            return Err(Error::LeavesDoubles);
        }
        Ok(Met { control, outcome, inside, outside })
    }
}

fn largest(vectors: &[f64], dimension: usize) -> f64 {
    let squares = vectors.chunks_exact(dimension).map(|v| v.iter().map(|x| x * x).sum::<f64>());
    squares.fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_those_of_the_edited_list() {
        let list: Vec<f64> = (0..40).map(f64::from).collect();
        let row = |t: f64| [t, 0.0, 0.0, 0.0];
        let all: Vec<f64> = list.iter().flat_map(|&t| row(t)).collect();
        let blocks = Blocks::new(1, &all);
        for index in [0, 1, 17, 39, 40] {
            for change in [Change::Move, Change::Insert, Change::Remove] {
                let mut plain = list.clone();
                match change {
                    Change::Insert => plain.insert(index, -1.0),
                    _ if index == 40 => continue,
                    Change::Move => plain[index] = -1.0,
                    Change::Remove => drop(plain.remove(index)),
                }
                let new = row(-1.0);
                let edited =
                    Edited { blocks: &blocks, change, index, row: &new, size: 1.0, period: None };
                assert_eq!(edited.len(), plain.len());
                for start in 0..plain.len() {
                    for end in [start, start + 1, start + 9, plain.len()] {
                        let range = start..end.clamp(start, plain.len());
                        let rows = edited.rows(&range);
                        let held: Vec<f64> = rows.chunks_exact(4).map(|row| row[0]).collect();
                        assert_eq!(held, plain[range.clone()], "{change:?} {index} {range:?}");
                    }
                }
            }
        }
    }
}
