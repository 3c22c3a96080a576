//! A B-spline curve in any dimension, polynomial or rational.

use super::check_buffer;
use super::rational::{check_finite, make_rational, make_rational_values};
use crate::Error;
use crate::basis::{basis_derivatives, basis_functions, check_weights};
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::points::Points;

/// `C(t) = sum_i B_i(t) P_i` over a checked knot vector, or with positive weights the rational
/// curve (NURBS) `C(t) = sum_i w_i B_i(t) P_i / sum_l w_l B_l(t)`. A periodic curve stores its
/// first `p` control points again at the end, so that nothing about its evaluation is special.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    knots: KnotVector,
    control_points: Points,
    rational_weights: Option<Vec<f64>>,
}

/// The values of a B-spline basis, and of as many derivatives as the degree has.
const ROWS: usize = (MAX_DEGREE + 1) * (MAX_DEGREE + 1);

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
        Ok(Self { knots, control_points, rational_weights: None })
    }

    /// Joins knots, control points as they lie in space, and their positive weights; only the
    /// ratios of weights count.
    ///
    /// # Errors
    /// As [`Curve::new`]; [`Error::WrongCount`] unless there is one weight per control point;
    /// [`Error::OutOfRange`] for weights that are not positive and finite, or more than 1e100 times
    /// one another; [`Error::Incompatible`] for a periodic curve whose last weights do not repeat
    /// the first.
    ///
    /// # Examples
    /// ```
    /// use gimfit::{Curve, KnotVector, Points};
    /// let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0])?;
    /// let corner = Points::from(&[[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][..]);
    /// let arc = Curve::rational(knots, corner, vec![1.0, 0.5_f64.sqrt(), 1.0])?;
    /// let point = arc.evaluate(0.3)?;
    /// assert!((point[0].hypot(point[1]) - 1.0).abs() < 1e-15);
    /// # Ok::<(), gimfit::Error>(())
    /// ```
    pub fn rational(
        knots: KnotVector,
        control_points: Points,
        weights: Vec<f64>,
    ) -> Result<Self, Error> {
        let curve = Self::new(knots, control_points)?;
        check_weights(&weights, curve.control_points.len())?;
        let degree = curve.degree();
        if curve.is_periodic() && weights[..degree] != weights[weights.len() - degree..] {
            return Err(Error::Incompatible {
                what: "these rational weights",
                with: "a periodic curve",
                why: "its last `degree` weights must repeat the first",
            });
        }
        Ok(Self { rational_weights: Some(weights), ..curve })
    }

    /// The curve over the same knots, and with the same weights, that has other control points.
    ///
    /// # Errors
    /// As [`Curve::new`].
    pub fn with_control_points(&self, control_points: Points) -> Result<Self, Error> {
        let curve = Self::new(self.knots.clone(), control_points)?;
        Ok(Self { rational_weights: self.rational_weights.clone(), ..curve })
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

    /// Weights of the stored control points; `None` for a polynomial curve.
    #[must_use]
    pub fn rational_weights(&self) -> Option<&[f64]> {
        self.rational_weights.as_deref()
    }

    /// The stored control points, to be moved; those of a periodic curve must go on to repeat.
    pub(crate) fn control_points_mut(&mut self) -> &mut [f64] {
        self.control_points.coordinates_mut()
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
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length;
    /// [`Error::LeavesDoubles`] for a rational curve that bends more sharply than doubles can tell.
    pub fn derivatives_into(
        &self,
        t: f64,
        order: usize,
        derivatives: &mut [f64],
    ) -> Result<(), Error> {
        check_buffer(derivatives, (order + 1) * self.dimension())?;
        let span = self.knots.span(t)?;
        self.derivatives_on_span(span, t, order, derivatives);
        if self.rational_weights.is_some() { check_finite(derivatives) } else { Ok(()) }
    }

    /// Parameters at `count` equal steps from one end of the domain to the other.
    #[must_use]
    pub fn equal_steps(&self, count: usize) -> Vec<f64> {
        self.knots.equal_steps(count)
    }

    /// Exact cubic Bezier pieces, four points each, shape (pieces, 4, dimension); `None` for degrees
    /// above 3 and for rational curves.
    #[must_use]
    pub fn bezier_pieces(&self) -> Option<Vec<f64>> {
        if self.degree() > 3 || self.rational_weights.is_some() {
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
        if let Some(weights) = &self.rational_weights {
            make_rational_values(&mut values[..=degree], &weights[span - degree..=span]);
        }
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
        let width = degree + 1;
        let known = order.min(degree);
        let mut few = [0.0; ROWS];
        basis_derivatives(self.knots.values(), degree, span, t, known, &mut few);
        let mut many = Vec::new();
        let rows = match &self.rational_weights {
            None => &few[..(known + 1) * width],
            Some(weights) => {
                // Those of a rational curve do not end with the degree.
                let rows = if order <= MAX_DEGREE {
                    &mut few[..(order + 1) * width]
                } else {
                    many.resize((order + 1) * width, 0.0);
                    many[..(known + 1) * width].copy_from_slice(&few[..(known + 1) * width]);
                    &mut many[..]
                };
                make_rational(rows, &weights[span - degree..=span]);
                &*rows
            }
        };
        derivatives.fill(0.0);
        for (row, derivative) in
            rows.chunks_exact(width).zip(derivatives.chunks_exact_mut(dimension))
        {
            self.blend(span, row, derivative);
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
