//! A tensor-product B-spline surface in any dimension, polynomial or rational.

use super::check_buffer;
use super::rational::{check_finite, divide_partials, largest};
use crate::Error;
use crate::basis::{basis_derivatives, check_weights};
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::points::PointGrid;

/// `S(u, v) = sum_ij B_i(u) B_j(v) P_ij` over checked knot vectors, or with positive weights the
/// rational surface (NURBS) `sum_ij w_ij B_i(u) B_j(v) P_ij / sum_ij w_ij B_i(u) B_j(v)`. In a
/// periodic direction the first `p` rows or columns of the net are stored again at the end, so that
/// nothing about its evaluation is special.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    knots: [KnotVector; 2],
    control_net: PointGrid,
    rational_weights: Option<Vec<f64>>,
}

/// Values of the functions that do not vanish on a span, and of their derivatives.
type BasisRows = [f64; (MAX_DEGREE + 1) * (MAX_DEGREE + 1)];

impl Surface {
    /// Joins knots and control net, shape (n_u, n_v, dimension).
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless the net has `knots - degree - 1` rows and columns;
    /// [`Error::NotFinite`], where points are counted row by row; [`Error::Incompatible`] for a
    /// periodic direction whose last rows or columns do not repeat the first.
    pub fn new(knots: [KnotVector; 2], control_net: PointGrid) -> Result<Self, Error> {
        for (knots, given) in knots.iter().zip(control_net.shape()) {
            if knots.control_points() != given {
                return Err(Error::WrongCount {
                    what: "rows or columns of the control net",
                    given,
                    expected: knots.control_points(),
                    why: "knots - degree - 1",
                });
            }
        }
        let points = control_net.points();
        let dimension = points.dimension();
        if let Some(position) = points.coordinates().iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite {
                point: position / dimension,
                coordinate: position % dimension,
                value: points.coordinates()[position],
            });
        }
        if !repeats(&knots, &control_net) {
            return Err(Error::Incompatible {
                what: "this control net",
                with: "a periodic direction",
                why: "its last `degree` rows or columns must repeat the first",
            });
        }
        Ok(Self { knots, control_net, rational_weights: None })
    }

    /// Joins knots, a control net as it lies in space, and its positive weights, row by row; only
    /// the ratios of weights count.
    ///
    /// # Errors
    /// As [`Surface::new`]; [`Error::WrongCount`] unless there is one weight per control point;
    /// [`Error::OutOfRange`] for weights that are not positive and finite, or more than 1e100 times
    /// one another; [`Error::Incompatible`] for a periodic direction in which they do not repeat.
    pub fn rational(
        knots: [KnotVector; 2],
        control_net: PointGrid,
        weights: Vec<f64>,
    ) -> Result<Self, Error> {
        let surface = Self::new(knots, control_net)?;
        let shape = surface.control_net.shape();
        check_weights(&weights, shape[0] * shape[1])?;
        if !repeats(&surface.knots, &PointGrid::new(shape, 1, weights.clone())?) {
            return Err(Error::Incompatible {
                what: "these rational weights",
                with: "a periodic direction",
                why: "their last `degree` rows or columns must repeat the first",
            });
        }
        Ok(Self { rational_weights: Some(weights), ..surface })
    }

    /// The surface over the same knots, and with the same weights, that has another control net.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn with_control_net(&self, control_net: PointGrid) -> Result<Self, Error> {
        let surface = Self::new(self.knots.clone(), control_net)?;
        Ok(Self { rational_weights: self.rational_weights.clone(), ..surface })
    }

    /// Degrees in direction u and v.
    #[must_use]
    pub fn degrees(&self) -> [usize; 2] {
        [self.knots[0].degree(), self.knots[1].degree()]
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.control_net.points().dimension()
    }

    /// The knots of both directions.
    #[must_use]
    pub fn knots(&self) -> &[KnotVector; 2] {
        &self.knots
    }

    /// The stored control net, shape (n_u, n_v, dimension).
    #[must_use]
    pub fn control_net(&self) -> &PointGrid {
        &self.control_net
    }

    /// Weights of the stored control points, row by row; `None` for a polynomial surface.
    #[must_use]
    pub fn rational_weights(&self) -> Option<&[f64]> {
        self.rational_weights.as_deref()
    }

    /// The stored control net, row by row, to be moved; what repeats in a periodic direction must go
    /// on to repeat.
    pub(crate) fn control_net_mut(&mut self) -> &mut [f64] {
        self.control_net.coordinates_mut()
    }

    /// Whether the surface closes smoothly in u and in v.
    #[must_use]
    pub fn is_periodic(&self) -> [bool; 2] {
        [0, 1].map(|k| self.knots[k].boundary() == Boundary::Periodic)
    }

    /// Where the surface is defined: an interval for u and one for v.
    #[must_use]
    pub fn domain(&self) -> [(f64, f64); 2] {
        [self.knots[0].domain(), self.knots[1].domain()]
    }

    /// The point at (u, v), written into `point` (length: dimension).
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length.
    pub fn evaluate_into(&self, u: f64, v: f64, point: &mut [f64]) -> Result<(), Error> {
        self.derivatives_into(u, v, 0, point)
    }

    /// The point at (u, v).
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, u: f64, v: f64) -> Result<Vec<f64>, Error> {
        let mut point = vec![0.0; self.dimension()];
        self.evaluate_into(u, v, &mut point)?;
        Ok(point)
    }

    /// Point and partial derivatives: that of order `a` in u and `b` in v stands at
    /// `(a * (order + 1) + b) * dimension`, for `a, b = 0 ..= order` (buffer length:
    /// (order + 1)^2 * dimension). At a knot, derivatives are taken from the right; at the end of
    /// the domain from the left.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length;
    /// [`Error::LeavesDoubles`] for a rational surface that bends more sharply than doubles can
    /// tell.
    pub fn derivatives_into(
        &self,
        u: f64,
        v: f64,
        order: usize,
        derivatives: &mut [f64],
    ) -> Result<(), Error> {
        let dimension = self.dimension();
        check_buffer(derivatives, (order + 1) * (order + 1) * dimension)?;
        let (span_u, rows_u) = self.basis(0, u, order)?;
        let (span_v, rows_v) = self.basis(1, v, order)?;
        let [p, q] = self.degrees();
        let columns = self.control_net.shape()[1];
        let weight_at = |weights: &[f64], i: usize, j: usize| {
            weights[(span_u - p + i) * columns + span_v - q + j]
        };
        let weights = self.rational_weights.as_deref();
        let mut weight_sums = vec![0.0; weights.map_or(0, |_| (order + 1) * (order + 1))];
        let scale = weights.map_or(1.0, |weights| {
            largest((0..=p).flat_map(|i| (0..=q).map(move |j| weight_at(weights, i, j))))
        });
        derivatives.fill(0.0);
        for i in 0..=p {
            for j in 0..=q {
                let control = self.control_net.point(span_u - p + i, span_v - q + j);
                let rational = weights.map(|weights| weight_at(weights, i, j) / scale);
                for a in 0..=order.min(p) {
                    for b in 0..=order.min(q) {
                        let mut weight = rows_u[a * (p + 1) + i] * rows_v[b * (q + 1) + j];
                        let place = a * (order + 1) + b;
                        if let Some(rational) = rational {
                            weight *= rational;
                            weight_sums[place] += weight;
                        }
                        let target = &mut derivatives[place * dimension..][..dimension];
                        for (x, c) in target.iter_mut().zip(control) {
                            *x += weight * c;
                        }
                    }
                }
            }
        }
        if weights.is_some() {
            divide_partials(derivatives, &weight_sums, order, dimension);
            return check_finite(derivatives);
        }
        Ok(())
    }

    fn basis(&self, direction: usize, t: f64, order: usize) -> Result<(usize, BasisRows), Error> {
        let knots = &self.knots[direction];
        let span = knots.span(t)?;
        let mut rows = [0.0; (MAX_DEGREE + 1) * (MAX_DEGREE + 1)];
        let known = order.min(knots.degree());
        basis_derivatives(knots.values(), knots.degree(), span, t, known, &mut rows);
        Ok((span, rows))
    }
}

/// Whether the last `degree` rows and columns repeat the first where a direction is periodic.
fn repeats(knots: &[KnotVector; 2], net: &PointGrid) -> bool {
    let [rows, columns] = net.shape();
    let periodic = |k: usize| knots[k].boundary() == Boundary::Periodic;
    let (p, q) = (knots[0].degree(), knots[1].degree());
    let in_u =
        || (0..p).all(|i| (0..columns).all(|j| net.point(i, j) == net.point(rows - p + i, j)));
    let in_v =
        || (0..q).all(|j| (0..rows).all(|i| net.point(i, j) == net.point(i, columns - q + j)));
    (!periodic(0) || in_u()) && (!periodic(1) || in_v())
}
