//! A surface whose data points are moved one by one: each move touches only the control points near
//! it, within a bound of the fit of all points.

use std::ops::Range;

use super::place::{scaled, widen};
use super::surface_window::Undo;
use super::{Account, goal_of};
use crate::Error;
use crate::basis::basis_functions;
use crate::collocation::{BandedCollocation, NetLayout};
use crate::iteration::Termination;
use crate::knots::{KnotVector, MAX_DEGREE};
use crate::points::{Extent, PowerOfTwoScale};
use crate::report::SurfaceReport;

/// An interpolating surface that holds its grid of data points, and follows their moves by local PIA
/// (Lin 2010) of the rows and columns nearby, run to its limit.
///
/// Parameters and knots stay, whatever moves. Positions count from 0. A move that is refused changes
/// nothing.
///
/// # Examples
/// ```
/// use gimfit::{EditableSurface, GridView, SurfaceOptions};
/// let points: Vec<f64> =
///     (0..10_000).flat_map(|k| [f64::from(k / 100), f64::from(k % 100), 0.0]).collect();
/// let grid = GridView::new([100, 100], 3, &points)?;
/// let mut surface = EditableSurface::new(grid, &SurfaceOptions::default())?;
/// let report = surface.move_point(50, 40, &[50.0, 40.0, 1.0])?;
/// assert!(report.control_points_touched < 2500 && report.bound < 1e-8);
/// assert!(surface.fit()?.report.converged());
/// # Ok::<(), gimfit::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct EditableSurface {
    pub(super) sides: [Side; 2],
    pub(super) layout: NetLayout,
    pub(super) dimension: usize,
    /// Data points and the control points that move, row by row, scaled, as all lengths here.
    pub(super) data: Vec<f64>,
    pub(super) control: Vec<f64>,
    pub(super) scale: PowerOfTwoScale,
    /// Of all points met so far.
    pub(super) extent: Extent,
    /// Residual asked for, if any was.
    pub(super) demanded: Option<f64>,
    pub(super) account: Account,
    /// What was told of the fit taken over.
    pub(super) report: SurfaceReport,
}

/// One direction.
#[derive(Debug, Clone)]
pub(super) struct Side {
    pub(super) knots: KnotVector,
    pub(super) operator: BandedCollocation,
    pub(super) closed: bool,
    /// As stored with a fit.
    pub(super) parameters: Vec<f64>,
    /// A bound of the maximum norm of the inverse.
    pub(super) inverse_norm: f64,
}

/// What a move did. Lengths are in the unit of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceEditReport {
    /// Rows and columns of the control points that moved; in a closed direction those beyond the last
    /// go on with the first.
    pub window: [Range<usize>; 2],
    /// How many control points they are.
    pub control_points_touched: usize,
    /// Steps of local PIA, on all windows tried, after the first one.
    pub iterations: usize,
    /// Why the last of them ended.
    pub termination: Termination,
    /// Largest residual, after the move, of the points that see one of these control points.
    pub max_residual: f64,
    /// How far a control point can now be from that of the fit of all points, over the same parameters
    /// and knots, at most: the product of the maximum norms of the inverses of both collocation
    /// matrices times the largest residual that any point may have.
    pub bound: f64,
}

impl Side {
    pub(super) fn count(&self) -> usize {
        self.parameters.len()
    }
}

impl EditableSurface {
    /// Degrees.
    #[must_use]
    pub fn degrees(&self) -> [usize; 2] {
        self.sides.each_ref().map(|side| side.knots.degree())
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Rows and columns of data points.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        self.sides.each_ref().map(Side::count)
    }

    /// A data point.
    ///
    /// # Panics
    /// If there is no such point.
    #[must_use]
    pub fn point(&self, row: usize, column: usize) -> Vec<f64> {
        let [rows, columns] = self.shape();
        assert!(row < rows && column < columns, "there is no point ({row}, {column})");
        let mut point = self.data[self.at(row, column)..][..self.dimension].to_vec();
        self.scale.undo_in_place(&mut point);
        point
    }

    /// The point of the surface at `(u, v)`, in the domain of the fit taken over.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, u: f64, v: f64) -> Result<Vec<f64>, Error> {
        let (mut across, mut along) = ([0.0; MAX_DEGREE + 1], [0.0; MAX_DEGREE + 1]);
        let [p, q] = self.degrees();
        let first = |side: &Side, t: f64, values: &mut [f64]| -> Result<usize, Error> {
            let span = side.knots.span(t)?;
            basis_functions(side.knots.values(), side.knots.degree(), span, t, values);
            Ok(span - side.knots.degree())
        };
        let first_u = first(&self.sides[0], u, &mut across)?;
        let first_v = first(&self.sides[1], v, &mut along)?;
        let [rows, columns] = self.shape();
        let mut point = vec![0.0; self.dimension];
        for (i, weight_u) in across[..=p].iter().enumerate() {
            let row = self.layout.u.source(first_u + i, rows);
            for (j, weight_v) in along[..=q].iter().enumerate() {
                let column = self.layout.v.source(first_v + j, columns);
                let control = &self.control[self.at(row, column)..][..self.dimension];
                let weight = weight_u * weight_v;
                point.iter_mut().zip(control).for_each(|(x, c)| *x += weight * c);
            }
        }
        self.scale.undo_in_place(&mut point);
        Ok(point)
    }

    /// How far a control point can be from that of the fit of all points, as
    /// [`SurfaceEditReport::bound`].
    #[must_use]
    pub fn bound(&self) -> f64 {
        let [u, v] = &self.sides;
        let [p, q] = self.degrees();
        // Rows of p + 1 and q + 1 weights that add up to 1, and a difference.
        let per_coordinate = (p + q + 4) as f64 * f64::EPSILON * self.account.largest;
        let rounding = per_coordinate * (self.dimension as f64).sqrt();
        self.scale.undo(u.inverse_norm * v.inverse_norm * (self.account.residual + rounding))
    }

    /// Moves a data point; rows, columns and parameters stay.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a position that is not there, [`Error::WrongCount`] and
    /// [`Error::NotFinite`] for the coordinates, [`Error::LeavesDoubles`].
    pub fn move_point(
        &mut self,
        row: usize,
        column: usize,
        point: &[f64],
    ) -> Result<SurfaceEditReport, Error> {
        let at = [row, column];
        for (k, count) in self.shape().into_iter().enumerate() {
            if at[k] >= count {
                return Err(Error::OutOfRange {
                    what: ["row", "column"][k].to_owned() + " of the point to edit",
                    value: at[k] as f64,
                    rule: "it counts from 0 and must be less than the number of rows, or columns",
                });
            }
        }
        let number = row * self.shape()[1] + column;
        let point = scaled(self.scale, self.dimension, number, point)?;
        let mut extent = self.extent.clone();
        widen(&mut extent, &point);
        let goal = goal_of(0, &extent, self.demanded)?;
        let mut undo = Undo::default();
        let done = self.settle(at, &point, goal, &mut undo);
        if done.is_ok() {
            self.extent = extent;
        } else {
            undo.control.into_iter().rev().for_each(|(at, old)| {
                self.control[at..][..old.len()].copy_from_slice(&old);
            });
            undo.data.into_iter().for_each(|(at, old)| {
                self.data[at..][..old.len()].copy_from_slice(&old);
            });
        }
        done
    }

    /// Where a point starts in the arrays.
    pub(super) fn at(&self, row: usize, column: usize) -> usize {
        (row * self.sides[1].count() + column) * self.dimension
    }
}
