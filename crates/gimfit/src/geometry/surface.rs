//! A tensor-product B-spline surface in any dimension.

use super::check_buffer;
use crate::Error;
use crate::basis::basis_derivatives;
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::points::PointGrid;

/// `S(u, v) = sum_ij B_i(u) B_j(v) P_ij` over checked knot vectors. In a periodic direction the
/// first `p` rows or columns of the net are stored again at the end, so that nothing about its
/// evaluation is special.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    knots: [KnotVector; 2],
    control_net: PointGrid,
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
        let [rows, columns] = control_net.shape();
        let (first, second) = (knots[0].degree(), knots[1].degree());
        let repeats = [
            (0..first).all(|i| {
                (0..columns)
                    .all(|j| control_net.point(i, j) == control_net.point(rows - first + i, j))
            }),
            (0..second).all(|j| {
                (0..rows)
                    .all(|i| control_net.point(i, j) == control_net.point(i, columns - second + j))
            }),
        ];
        for (knots, repeats) in knots.iter().zip(repeats) {
            if knots.boundary() == Boundary::Periodic && !repeats {
                return Err(Error::Incompatible {
                    what: "this control net",
                    with: "a periodic direction",
                    why: "its last `degree` rows or columns must repeat the first",
                });
            }
        }
        Ok(Self { knots, control_net })
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
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length.
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
        derivatives.fill(0.0);
        for i in 0..=p {
            for j in 0..=q {
                let control = self.control_net.point(span_u - p + i, span_v - q + j);
                for a in 0..=order.min(p) {
                    for b in 0..=order.min(q) {
                        let weight = rows_u[a * (p + 1) + i] * rows_v[b * (q + 1) + j];
                        let start = (a * (order + 1) + b) * dimension;
                        for (x, c) in derivatives[start..][..dimension].iter_mut().zip(control) {
                            *x += weight * c;
                        }
                    }
                }
            }
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
