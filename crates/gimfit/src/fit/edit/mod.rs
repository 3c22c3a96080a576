//! A curve whose data points are moved, inserted and removed one by one, and a surface whose points are
//! moved: each edit touches only the control points near it, within a bound of the fit of all points.

mod blocks;
mod place;
mod ring;
mod row_sums;
mod surface;
mod surface_window;
mod whole;
mod whole_surface;
mod window;

pub use surface::{EditableSurface, SurfaceEditReport};

use std::ops::Range;

use self::blocks::Blocks;
use self::place::Spacing;
use self::window::{Change, Edited, Goal, Settled};
use super::solve::{DEFAULT_RESIDUAL, MOST_ROUNDING};
use crate::Error;
use crate::collocation::LocalKnots;
use crate::iteration::Termination;
use crate::knots::{MAX_DEGREE, averaged_knot};
use crate::points::{Extent, PowerOfTwoScale};

/// An interpolating curve with averaged knots, open or closed, that holds its data points, and follows
/// their edits by local PIA (Lin 2010) of the points nearby, run to its limit.
///
/// A point that moves keeps its parameter, and all others keep theirs whatever happens; only the up
/// to `2 p` knots that are means of a parameter inserted or removed change. Positions count from 0. A
/// closed curve keeps its period, and starts at point 0, whichever that is. An edit that is refused changes nothing.
///
/// # Examples
/// ```
/// use gimfit::{CurveOptions, EditableCurve};
/// let points: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
/// let mut curve = EditableCurve::new(&points, &CurveOptions::default())?;
/// let report = curve.move_point(500, &[500.0, 9.0])?;
/// assert!(report.control_points_touched < 100 && report.bound < 1e-9);
/// curve.insert_point(501, &[500.5, 5.0])?;
/// curve.remove_point(0)?;
/// assert_eq!(curve.fit()?.report.points, 1000);
/// # Ok::<(), gimfit::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct EditableCurve {
    degree: usize,
    /// Of a closed curve.
    period: Option<f64>,
    blocks: Blocks,
    scale: PowerOfTwoScale,
    /// Of all points met so far, scaled, as all lengths here.
    extent: Extent,
    spacing: Spacing,
    /// How parameters were assigned at first.
    parameterization: &'static str,
    /// Residual asked for, if any was.
    demanded: Option<f64>,
    account: Account,
}

/// What is known of all points together, after any number of edits.
#[derive(Debug, Clone)]
struct Account {
    edits: usize,
    iterations: usize,
    termination: Termination,
    /// Largest residual ever measured: no smaller than the largest of now.
    residual: f64,
    /// The same of the row sums of the inverse, relative to 1.
    row_sum_residual: f64,
    /// Largest coordinate ever met.
    largest: f64,
}

/// What an edit did. Lengths are in the unit of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct EditReport {
    /// Positions, after the edit, of the control points that moved; of a closed curve those beyond the
    /// last go on with the first.
    pub window: Range<usize>,
    /// How many they are.
    pub control_points_touched: usize,
    /// Steps of local PIA, on all windows tried, after the first one that moves control points by
    /// the difference vectors themselves: 0 where those do, as for degree 1.
    pub iterations: usize,
    /// Why the last of them ended.
    pub termination: Termination,
    /// Largest residual, after the edit, of the points that see one of these control points.
    pub max_residual: f64,
    /// How far a control point of the curve can now be from that of the fit of all points, over the
    /// same parameters and knots, at most: the maximum norm of the inverse collocation matrix times
    /// the largest residual that any point may have.
    pub bound: f64,
}

impl EditableCurve {
    /// Degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.blocks.dimension()
    }

    /// Number of data points, and of control points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.blocks.len()
    }

    /// Never: a curve has points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.blocks.len() == 0
    }

    /// Data point `index`.
    ///
    /// # Panics
    /// If there is no such point.
    #[must_use]
    pub fn point(&self, index: usize) -> Vec<f64> {
        assert!(index < self.len(), "there is no point {index} of {}", self.len());
        let mut point = self.data(index).to_vec();
        self.scale.undo_in_place(&mut point);
        point
    }

    /// Where the curve is defined: from the parameter of its first point to that of its last; a closed
    /// curve once round, from the knot before its first point, or at it.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        let Some(period) = self.period else {
            return (self.parameter(0), self.parameter(self.len() - 1));
        };
        let half = (self.degree / 2) as isize;
        let near: Vec<f64> =
            (0..self.degree as isize).map(|k| self.unrolled_point(k - half).1).collect();
        let start = averaged_knot(&near);
        (start, start + period)
    }

    /// The point of the curve at `t`, from the control points nearby.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, t: f64) -> Result<Vec<f64>, Error> {
        let (start, end) = self.domain();
        if !(start <= t && t <= end) {
            return Err(Error::OutsideDomain { parameter: t, start, end });
        }
        let (degree, dimension) = (self.degree, self.dimension());
        let (near, parameters, held, j, count) = self.near(t);
        let knots = LocalKnots::new(degree, &parameters, held.start, count);
        let span = knots.span(j, t);
        let mut values = [0.0; MAX_DEGREE + 1];
        knots.functions(span, t, &mut values);
        let mut point = vec![0.0; dimension];
        for (k, weight) in values[..=degree].iter().enumerate() {
            let control = &near[span - degree + k - held.start][2 + dimension..];
            point.iter_mut().zip(control).for_each(|(x, p)| *x += weight * p);
        }
        self.scale.undo_in_place(&mut point);
        Ok(point)
    }

    /// How far a control point can be from that of the fit of all points, as
    /// [`EditReport::bound`].
    #[must_use]
    pub fn bound(&self) -> f64 {
        let Account { residual, row_sum_residual, largest, .. } = self.account;
        if row_sum_residual >= 1.0 {
            return f64::INFINITY;
        }
        let inverse_norm = self.blocks.largest_row_sum() / (1.0 - row_sum_residual);
        if !inverse_norm.is_finite() {
            return f64::INFINITY;
        }
        // A row of p + 1 weights that add up to 1, and a difference.
        let per_coordinate = (self.degree + 3) as f64 * f64::EPSILON * largest;
        let rounding = per_coordinate * (self.dimension() as f64).sqrt();
        self.scale.undo(inverse_norm * (residual + rounding + self.seam_rounding()))
    }

    /// Moves data point `index`; it keeps its parameter.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a position that is not there, [`Error::WrongCount`] and
    /// [`Error::NotFinite`] for the coordinates, [`Error::MeetsNeighbour`] where parameters follow
    /// chords, [`Error::LeavesDoubles`].
    pub fn move_point(&mut self, index: usize, point: &[f64]) -> Result<EditReport, Error> {
        self.check_position(index, self.len())?;
        let point = self.scaled(index, point)?;
        self.keep_apart(&point, index as isize - 1, index + 1)?;
        let mut row = self.blocks.row(index).to_vec();
        let size = place::distance(self.data(index), &point);
        row[2..2 + point.len()].copy_from_slice(&point);
        self.edit(Change::Move, index, &row, size)
    }

    /// Inserts a data point before point `index`; `index = len()` appends. Its parameter divides
    /// the gap between its neighbours as the chords to them do (where parameters are uniform or
    /// given, in half); beyond an end the chord counts as in the gap next to it. The gap of a closed
    /// curve from its last point to its first takes points at either position.
    ///
    /// # Errors
    /// As [`EditableCurve::move_point`]; [`Error::ParametersCollide`] where the gap is too small.
    pub fn insert_point(&mut self, index: usize, point: &[f64]) -> Result<EditReport, Error> {
        self.check_position(index, self.len() + 1)?;
        let point = self.scaled(index, point)?;
        self.keep_apart(&point, index as isize - 1, index)?;
        let parameter = self.parameter_between(index, &point)?;
        self.insert(index, parameter, &point)
    }

    /// As [`EditableCurve::insert_point`], at a parameter of the caller's.
    ///
    /// # Errors
    /// As [`EditableCurve::move_point`]; [`Error::OutOfRange`] for a parameter that is not finite or
    /// not between those of the neighbours.
    pub fn insert_point_at(
        &mut self,
        index: usize,
        parameter: f64,
        point: &[f64],
    ) -> Result<EditReport, Error> {
        self.check_position(index, self.len() + 1)?;
        let point = self.scaled(index, point)?;
        if !(parameter.is_finite() && self.fits_between(index, parameter)) {
            return Err(Error::OutOfRange {
                what: "parameter of the point to insert".into(),
                value: parameter,
                rule: "it must be finite, and lie between those of its neighbours",
            });
        }
        self.insert(index, parameter, &point)
    }

    /// Removes data point `index`, and its parameter.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a position that is not there; [`Error::TooFewPoints`] if the points
    /// left would not do for the degree.
    pub fn remove_point(&mut self, index: usize) -> Result<EditReport, Error> {
        self.check_position(index, self.len())?;
        let (points, needed) = (self.len() - 1, self.degree + 1);
        if points < needed {
            return Err(Error::TooFewPoints { points, degree: self.degree, needed });
        }
        let size = self.chords(index, self.data(index), index + 1);
        self.edit(Change::Remove, index, &[], size)
    }

    fn insert(&mut self, index: usize, t: f64, point: &[f64]) -> Result<EditReport, Error> {
        let size = self.chords(index, point, index);
        // It starts as far from its data point as its neighbours ended.
        let dimension = self.dimension();
        let near = [self.neighbour(index as isize - 1), self.neighbour(index as isize)];
        let near: Vec<&[f64]> = near.iter().flatten().map(|&(j, _)| self.blocks.row(j)).collect();
        let mean = |of: &dyn Fn(&[f64]) -> f64| {
            near.iter().map(|row| of(row)).sum::<f64>() / near.len() as f64
        };
        let mut row = vec![t, mean(&|row| row[blocks::ROW_SUM])];
        row.extend_from_slice(point);
        row.extend(
            (0..dimension).map(|i| point[i] + mean(&|row| row[2 + dimension + i] - row[2 + i])),
        );
        self.edit(Change::Insert, index, &row, size)
    }

    /// Runs an edit that was checked, and keeps what came of it.
    fn edit(
        &mut self,
        change: Change,
        index: usize,
        row: &[f64],
        size: f64,
    ) -> Result<EditReport, Error> {
        let dimension = self.dimension();
        let mut extent = self.extent.clone();
        if !row.is_empty() {
            place::widen(&mut extent, &row[2..2 + dimension]);
        }
        let goal = goal_of(self.degree, &extent, self.demanded)?;
        let edited = Edited { blocks: &self.blocks, change, index, row, size, period: self.period };
        let settled = edited.settle(goal)?;
        self.extent = extent;
        match change {
            Change::Move => {}
            Change::Insert => self.blocks.insert(index, row),
            Change::Remove => self.blocks.remove(index),
        }
        Ok(self.take(settled))
    }

    fn take(&mut self, settled: Settled) -> EditReport {
        let Settled { window, rows, iterations, termination, max_residual, .. } = settled;
        let before_the_seam = (self.len() - window.start) * self.blocks.stride();
        let (head, tail) = rows.split_at(rows.len().min(before_the_seam));
        self.blocks.write(window.start, head);
        self.blocks.write(0, tail);
        let account = &mut self.account;
        account.edits += 1;
        account.iterations += iterations;
        account.termination = termination;
        account.residual = account.residual.max(max_residual);
        account.row_sum_residual = account.row_sum_residual.max(settled.row_sum_residual);
        account.largest = account.largest.max(settled.largest);
        EditReport {
            control_points_touched: window.len(),
            window,
            iterations,
            termination,
            max_residual: self.scale.undo(max_residual),
            bound: self.bound(),
        }
    }
}

/// What the points near an edit are to reach.
fn goal_of(degree: usize, extent: &Extent, demanded: Option<f64>) -> Result<Goal, Error> {
    let diagonal = extent.diagonal();
    if !diagonal.is_finite() {
        return Err(Error::LeavesDoubles);
    }
    let residual = residual_target(extent, demanded);
    Ok(Goal { degree, residual, accept_rounding: MOST_ROUNDING * diagonal })
}

/// The residual asked for, or the default.
fn residual_target(extent: &Extent, demanded: Option<f64>) -> f64 {
    demanded.unwrap_or(DEFAULT_RESIDUAL * extent.diagonal())
}
