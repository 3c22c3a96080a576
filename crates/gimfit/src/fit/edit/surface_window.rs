//! One move: local PIA of the rows and columns near it, on wider and wider windows until the points
//! outside see no difference.

use std::ops::Range;

use super::place::distance;
use super::surface::{EditableSurface, Side, SurfaceEditReport};
use super::window::{Goal, first_reach};
use crate::Error;
use crate::collocation::{CollocationMatrix, TensorCollocation};
use crate::iteration::update::NetPreconditioned;
use crate::iteration::{IterationState, NoObserver, ROUNDING, Stopping, Termination, run};

/// Most steps on one window; one or two do.
const MOST_STEPS: usize = 20;

/// Lines of one direction: those that move, and those whose points see one of them.
struct Lines {
    /// Unrolled.
    range: Range<usize>,
    moved: Vec<usize>,
    seeing: Vec<usize>,
}

impl Side {
    /// The lines up to `reach` places from one, and those that see them, in ascending order.
    fn lines(&self, at: usize, reach: usize) -> Lines {
        let (count, degree) = (self.count(), self.knots.degree());
        let within = |reach: usize| {
            if !self.closed {
                at.saturating_sub(reach)..at.saturating_add(reach + 1).min(count)
            } else if reach >= count / 2 {
                0..count
            } else {
                let start = (at + count - reach) % count;
                start..start + 2 * reach + 1
            }
        };
        let positions = |range: &Range<usize>| {
            let past = range.end.saturating_sub(count);
            (0..past).chain(range.start..range.end.min(count)).collect()
        };
        let range = within(reach);
        let seen = within(reach.saturating_add(degree));
        Lines { moved: positions(&range), seeing: positions(&seen), range }
    }

    /// All columns of some rows, in ascending order.
    fn columns(&self, rows: &[usize]) -> Vec<usize> {
        let mut columns: Vec<usize> =
            rows.iter().flat_map(|&j| self.operator.row(j).map(|(column, _)| column)).collect();
        columns.sort_unstable();
        columns.dedup();
        columns
    }
}

/// What a move changed, to be taken back if it is refused after all: where, and what was there.
#[derive(Debug, Default)]
pub(super) struct Undo {
    pub(super) data: Option<(usize, Vec<f64>)>,
    pub(super) control: Vec<(usize, Vec<f64>)>,
}

impl EditableSurface {
    /// Local PIA on wider and wider windows until the points outside see no difference.
    pub(super) fn settle(
        &mut self,
        at: [usize; 2],
        point: &[f64],
        goal: Goal,
        undo: &mut Undo,
    ) -> Result<SurfaceEditReport, Error> {
        let place = self.at(at[0], at[1]);
        let old = self.data[place..][..self.dimension].to_vec();
        let change: Vec<f64> = point.iter().zip(&old).map(|(new, old)| new - old).collect();
        let size = distance(&old, point);
        let mut reach =
            self.degrees().map(|degree| first_reach(Goal { degree, ..goal }, size, false));
        undo.data = Some((place, old));
        self.data[place..][..self.dimension].copy_from_slice(point);
        let mut iterations = 0;
        loop {
            let lines: [Lines; 2] = [0, 1].map(|k| self.sides[k].lines(at[k], reach[k]));
            let first = iterations == 0;
            let step = if first {
                self.move_by(&change, at, &lines, undo)?
            } else {
                self.iterate(&lines, goal, undo)?
            };
            iterations += step.iterations;
            let met = self.measure(&lines, goal)?;
            let whole = (0..2).all(|k| lines[k].moved.len() == self.sides[k].count());
            // What was left of the moves before has not been looked at yet.
            let left = if first { met.inside.max(met.outside) } else { met.outside };
            if left > met.target && (first || !whole) {
                if !whole && met.outside > met.target {
                    reach = reach.map(|reach| (3 * reach).div_ceil(2));
                }
                continue;
            }
            let residual = met.inside.max(met.outside);
            let account = &mut self.account;
            account.edits += 1;
            account.iterations += iterations;
            account.termination = step.termination;
            account.residual = account.residual.max(residual);
            account.largest = account.largest.max(met.largest);
            let [u, v] = lines;
            return Ok(SurfaceEditReport {
                control_points_touched: u.moved.len() * v.moved.len(),
                window: [u.range, v.range],
                iterations,
                termination: step.termination,
                max_residual: self.scale.undo(residual),
                bound: self.bound(),
            });
        }
    }

    /// The step of preconditioned local PIA that meets the one difference vector of a point that moved:
    /// by the product of its columns of both inverses.
    fn move_by(
        &mut self,
        change: &[f64],
        at: [usize; 2],
        lines: &[Lines; 2],
        undo: &mut Undo,
    ) -> Result<Step, Error> {
        let column = |k: usize| -> Result<Vec<f64>, Error> {
            let moved = &lines[k].moved;
            let factors = self.sides[k].operator.restricted(moved).factor(None)?;
            let unit = |&j: &usize| f64::from(u8::from(j == at[k]));
            let mut column: Vec<f64> = moved.iter().map(unit).collect();
            factors.solve_in_place(&mut column, 1);
            Ok(column)
        };
        let (u, v) = (column(0)?, column(1)?);
        let deltas = u.iter().flat_map(|a| v.iter().map(move |b| a * b));
        let deltas = deltas.flat_map(|product| change.iter().map(move |x| product * x));
        self.add(lines, &deltas.collect::<Vec<_>>(), undo);
        Ok(Step { iterations: 1, termination: Termination::Residual })
    }

    /// Local PIA of all points of a window.
    fn iterate(&mut self, lines: &[Lines; 2], goal: Goal, undo: &mut Undo) -> Result<Step, Error> {
        let [rows, columns] = lines;
        let (vectors, largest) = self.differences(&rows.moved, &columns.moved);
        let u = self.sides[0].operator.restricted(&rows.moved);
        let v = self.sides[1].operator.restricted(&columns.moved);
        let operator = TensorCollocation::new(&u, &v, self.dimension);
        let mut rule = NetPreconditioned::new(&u, &v, None)?;
        let target = goal.residual.max(ROUNDING * largest);
        let stopping = Stopping {
            residual: target,
            max_iterations: MOST_STEPS,
            accept_rounding: goal.accept_rounding.max(target),
        };
        // Adjusting vectors are to meet the difference vectors: local PIA of the former.
        let mut state = IterationState::begin(&operator, &vectors, self.dimension);
        let outcome = run(&mut state, &mut rule, stopping, &mut NoObserver);
        self.add(lines, state.control(), undo);
        Ok(Step { iterations: outcome.iterations.max(1), termination: outcome.termination })
    }

    /// Adds adjusting vectors of a window.
    fn add(&mut self, lines: &[Lines; 2], deltas: &[f64], undo: &mut Undo) {
        let (dimension, [rows, columns]) = (self.dimension, lines);
        let pieces = pieces(&columns.moved);
        let mut deltas = deltas;
        for &i in &rows.moved {
            for piece in &pieces {
                let from = self.at(i, piece.start);
                let (now, later) = deltas.split_at(piece.len() * dimension);
                let control = &mut self.control[from..][..now.len()];
                undo.control.push((from, control.to_vec()));
                control.iter_mut().zip(now).for_each(|(p, d)| *p += d);
                deltas = later;
            }
        }
    }

    /// What a window has left.
    fn measure(&self, lines: &[Lines; 2], goal: Goal) -> Result<Met, Error> {
        let [rows, columns] = lines;
        let (vectors, largest) = self.differences(&rows.seeing, &columns.seeing);
        let (mut inside, mut outside) = (0.0_f64, 0.0_f64);
        let line = columns.seeing.len() * self.dimension;
        let moved: Vec<bool> =
            columns.seeing.iter().map(|j| columns.moved.binary_search(j).is_ok()).collect();
        for (i, row) in rows.seeing.iter().zip(vectors.chunks_exact(line)) {
            let moves = rows.moved.binary_search(i).is_ok();
            for (&column, vector) in moved.iter().zip(row.chunks_exact(self.dimension)) {
                let square = vector.iter().map(|x| x * x).sum::<f64>();
                let most = if moves && column { &mut inside } else { &mut outside };
                // Whatever is no number is kept as such.
                if square > *most || square.is_nan() {
                    *most = square;
                }
            }
        }
        let (inside, outside) = (inside.sqrt(), outside.sqrt());
        if !(inside + outside).is_finite() {
            return Err(Error::LeavesDoubles);
        }
        Ok(Met { inside, outside, largest, target: goal.residual.max(ROUNDING * largest) })
    }

    /// Difference vectors at the crossings of rows with columns, and the largest coordinate met.
    fn differences(&self, rows: &[usize], columns: &[usize]) -> (Vec<f64>, f64) {
        let (dimension, [u, v]) = (self.dimension, &self.sides);
        let near = pieces(&v.columns(columns));
        // Column by column, its weights and where their control points start in a row.
        let mut weights = Vec::new();
        let mut ends = Vec::with_capacity(columns.len());
        for &j in columns {
            weights.extend(v.operator.row(j).map(|(k, weight)| (k * dimension, weight)));
            ends.push(weights.len());
        }
        let mut largest = 0.0_f64;
        let mut line = vec![0.0; v.count() * dimension];
        let mut vectors = Vec::with_capacity(rows.len() * columns.len() * dimension);
        for &i in rows {
            for piece in &near {
                let part = piece.start * dimension..piece.end * dimension;
                line[part.clone()].fill(0.0);
                for (row, weight) in u.operator.row(i) {
                    let control = &self.control[self.at(row, 0)..][part.clone()];
                    line[part.clone()].iter_mut().zip(control).for_each(|(x, c)| *x += weight * c);
                }
                let own = &self.control[self.at(i, 0)..][part];
                largest = own.iter().fold(largest, |most, x| most.max(x.abs()));
            }
            let mut from = 0;
            for (&j, &end) in columns.iter().zip(&ends) {
                let start = vectors.len();
                vectors.extend_from_slice(&self.data[self.at(i, j)..][..dimension]);
                let vector = &mut vectors[start..];
                largest = vector.iter().fold(largest, |most, x| most.max(x.abs()));
                for &(k, weight) in &weights[from..end] {
                    let sum = &line[k..][..dimension];
                    vector.iter_mut().zip(sum).for_each(|(x, y)| *x -= weight * y);
                }
                from = end;
            }
        }
        (vectors, largest)
    }
}

/// Ascending positions as ranges without gaps.
fn pieces(positions: &[usize]) -> Vec<Range<usize>> {
    let mut pieces: Vec<Range<usize>> = Vec::new();
    for &position in positions {
        match pieces.last_mut() {
            Some(last) if last.end == position => last.end += 1,
            _ => pieces.push(position..position + 1),
        }
    }
    pieces
}

/// What ran on a window.
struct Step {
    iterations: usize,
    termination: Termination,
}

/// What it left.
struct Met {
    inside: f64,
    outside: f64,
    /// Largest coordinate met.
    largest: f64,
    /// The residual to reach.
    target: f64,
}
