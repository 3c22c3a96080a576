//! A B-spline curve in any dimension.

use super::check_buffer;
use crate::Error;
use crate::basis::{basis_derivatives, basis_functions};
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::points::Points;

/// `C(t) = sum_i B_i(t) P_i` over a checked knot vector. A periodic curve stores its first `p`
/// control points again at the end, so that nothing about its evaluation is special.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    knots: KnotVector,
    control_points: Points,
}

impl Curve {
    /// Joins knots and control points, shape (n, dimension).
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless there are `knots - degree - 1` control points;
    /// [`Error::NotFinite`]; [`Error::Incompatible`] for a periodic curve whose last `p` control
    /// points do not repeat the first.
    pub fn new(knots: KnotVector, control_points: Points) -> Result<Self, Error> {
        let expected = knots.control_points();
        if control_points.len() != expected {
            return Err(Error::WrongCount {
                what: "control points",
                given: control_points.len(),
                expected,
                why: "knots - degree - 1",
            });
        }
        let dimension = control_points.dimension();
        let values = control_points.coordinates();
        if let Some(position) = values.iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite {
                point: position / dimension,
                coordinate: position % dimension,
                value: values[position],
            });
        }
        let repeated = knots.degree() * dimension;
        let repeats = values[..repeated] == values[values.len() - repeated..];
        if knots.boundary() == Boundary::Periodic && !repeats {
            return Err(Error::Incompatible {
                what: "these control points",
                with: "a periodic curve",
                why: "its last `degree` control points must repeat the first",
            });
        }
        Ok(Self { knots, control_points })
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.knots.degree()
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.control_points.dimension()
    }

    /// The knots, `n + p + 1` values.
    #[must_use]
    pub fn knots(&self) -> &KnotVector {
        &self.knots
    }

    /// The stored control points, shape (n, dimension).
    #[must_use]
    pub fn control_points(&self) -> &Points {
        &self.control_points
    }

    /// Whether the curve closes smoothly.
    #[must_use]
    pub fn is_periodic(&self) -> bool {
        self.knots.boundary() == Boundary::Periodic
    }

    /// Control points that are free: a periodic curve's repeated ones are left out.
    #[must_use]
    pub fn free_control_points(&self) -> usize {
        let repeated = if self.is_periodic() { self.degree() } else { 0 };
        self.control_points.len() - repeated
    }

    /// Where the curve is defined.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        self.knots.domain()
    }

    /// The point at `t`, written into `point` (length: dimension).
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length.
    pub fn evaluate_into(&self, t: f64, point: &mut [f64]) -> Result<(), Error> {
        check_buffer(point, self.dimension())?;
        let span = self.knots.span(t)?;
        self.evaluate_on_span(span, t, point);
        Ok(())
    }

    /// The point at `t`.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, t: f64) -> Result<Vec<f64>, Error> {
        let mut point = vec![0.0; self.dimension()];
        self.evaluate_into(t, &mut point)?;
        Ok(point)
    }

    /// Point and derivatives up to `order` at `t`, written one after another into `derivatives`
    /// (length: (order + 1) * dimension). At a knot, derivatives are taken from the right; at the
    /// end of the domain from the left.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length.
    pub fn derivatives_into(
        &self,
        t: f64,
        order: usize,
        derivatives: &mut [f64],
    ) -> Result<(), Error> {
        check_buffer(derivatives, (order + 1) * self.dimension())?;
        let span = self.knots.span(t)?;
        self.derivatives_on_span(span, t, order, derivatives);
        Ok(())
    }

    /// Parameters at `count` equal steps from one end of the domain to the other.
    #[must_use]
    pub fn equal_steps(&self, count: usize) -> Vec<f64> {
        self.knots.equal_steps(count)
    }

    /// Exact cubic Bezier pieces, four points each, shape (pieces, 4, dimension); `None` for degrees
    /// above 3.
    #[must_use]
    pub fn bezier_pieces(&self) -> Option<Vec<f64>> {
        if self.degree() > 3 {
            return None;
        }
        let dimension = self.dimension();
        let mut pieces = Vec::new();
        let mut ends = [vec![0.0; 2 * dimension], vec![0.0; 2 * dimension]];
        for span in self.knots.nonempty_spans() {
            let (a, b) = (self.knots.values()[span], self.knots.values()[span + 1]);
            self.derivatives_on_span(span, a, 1, &mut ends[0]);
            self.derivatives_on_span(span, b, 1, &mut ends[1]);
            let third = (b - a) / 3.0;
            let [from, to] = &ends;
            pieces.extend_from_slice(&from[..dimension]);
            pieces.extend((0..dimension).map(|i| from[i] + third * from[dimension + i]));
            pieces.extend((0..dimension).map(|i| to[i] - third * to[dimension + i]));
            pieces.extend_from_slice(&to[..dimension]);
        }
        Some(pieces)
    }

    /// Evaluates the polynomial of a span, which callers found before.
    pub(crate) fn evaluate_on_span(&self, span: usize, t: f64, point: &mut [f64]) {
        let degree = self.degree();
        let mut values = [0.0; MAX_DEGREE + 1];
        basis_functions(self.knots.values(), degree, span, t, &mut values);
        self.blend(span, &values[..=degree], point);
    }

    /// Point and derivatives of the polynomial of a span.
    pub(crate) fn derivatives_on_span(
        &self,
        span: usize,
        t: f64,
        order: usize,
        derivatives: &mut [f64],
    ) {
        let (degree, dimension) = (self.degree(), self.dimension());
        derivatives.fill(0.0);
        let known = order.min(degree);
        let mut values = [0.0; (MAX_DEGREE + 1) * (MAX_DEGREE + 1)];
        basis_derivatives(self.knots.values(), degree, span, t, known, &mut values);
        for k in 0..=known {
            let row = &values[k * (degree + 1)..][..=degree];
            self.blend(span, row, &mut derivatives[k * dimension..][..dimension]);
        }
    }

    fn blend(&self, span: usize, weights: &[f64], point: &mut [f64]) {
        point.fill(0.0);
        for (k, &weight) in weights.iter().enumerate() {
            let control = self.control_points.point(span - self.degree() + k);
            for (x, p) in point.iter_mut().zip(control) {
                *x += weight * p;
            }
        }
    }
}
