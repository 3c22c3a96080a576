//! The knot vector of a B-spline curve: `n + p + 1` values, the end knots included.

use crate::Error;

/// Largest degree; the basis kernels keep their scratch on the stack.
pub const MAX_DEGREE: usize = 25;

/// What happens at the ends of the domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boundary {
    /// The curve ends there.
    Open,
    /// The knots repeat with the length of the domain, so the curve closes smoothly when its last
    /// `p` control points repeat the first.
    Periodic,
}

/// A valid knot vector: finite, nowhere falling, no knot more often than its degree allows, with a
/// domain `[knots[p], knots[n]]` that is not empty.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotVector {
    degree: usize,
    knots: Vec<f64>,
    boundary: Boundary,
}

impl KnotVector {
    /// Takes the full knot vector of an open curve.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for the degree, [`Error::WrongCount`], [`Error::BadKnot`].
    pub fn open(degree: usize, knots: Vec<f64>) -> Result<Self, Error> {
        check_degree(degree)?;
        check_knots(degree, &knots)?;
        Ok(Self { degree, knots, boundary: Boundary::Open })
    }

    /// Takes the full knot vector of a periodic curve: `p` spans past both ends of the domain, each
    /// a period away from its likeness inside.
    ///
    /// # Errors
    /// As [`KnotVector::open`]; [`Error::BadKnot`] for a knot that does not repeat.
    pub fn periodic(degree: usize, knots: Vec<f64>) -> Result<Self, Error> {
        check_degree(degree)?;
        check_knots(degree, &knots)?;
        let vector = Self { degree, knots, boundary: Boundary::Periodic };
        let shift = vector.control_points() - degree;
        let (start, end) = vector.domain();
        let period = end - start;
        let slack = 1e-9 * period + 4.0 * f64::EPSILON * start.abs().max(end.abs());
        let broken = (0..vector.knots.len() - shift)
            .find(|&i| (vector.knots[i + shift] - vector.knots[i] - period).abs() > slack);
        if let Some(index) = broken {
            return Err(Error::BadKnot {
                index,
                value: vector.knots[index],
                problem: "does not repeat one period later, as a periodic curve needs",
            });
        }
        Ok(vector)
    }

    /// The degree `p`.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All `n + p + 1` knots.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.knots
    }

    /// The boundary kind.
    #[must_use]
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// Number `n` of basis functions, thus of stored control points. A periodic curve stores its
    /// first `p` control points again at the end.
    #[must_use]
    pub fn control_points(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// Where the curve is defined.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.control_points()])
    }

    /// Index `s` of the span `[knots[s], knots[s + 1])` that holds `t`, found by bisection; the end
    /// of the domain belongs to the last span that is not empty.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`], also for NaN.
    pub fn span(&self, t: f64) -> Result<usize, Error> {
        let (start, end) = self.domain();
        if !(start <= t && t <= end) {
            return Err(Error::OutsideDomain { parameter: t, start, end });
        }
        let inner = &self.knots[self.degree..=self.control_points()];
        let above = if t < end {
            inner.partition_point(|&knot| knot <= t)
        } else {
            inner.partition_point(|&knot| knot < t)
        };
        Ok(self.degree + above - 1)
    }

    /// The span of `t` in the domain, looked for from span `from` onwards: for parameters in
    /// ascending order this costs a step or two.
    pub(crate) fn span_from(&self, from: usize, t: f64) -> usize {
        let last = self.control_points() - 1;
        let mut span = from.clamp(self.degree, last);
        while span < last && self.knots[span + 1] <= t {
            span += 1;
        }
        // At the end of the domain, or after a repeated knot, step back to a span with length.
        while span > self.degree && self.knots[span] >= self.knots[span + 1] {
            span -= 1;
        }
        span
    }

    /// Parameters at `count` equal steps from one end of the domain to the other.
    #[must_use]
    pub fn equal_steps(&self, count: usize) -> Vec<f64> {
        let (start, end) = self.domain();
        let last = count.saturating_sub(1).max(1) as f64;
        (0..count)
            .map(|i| {
                let share = i as f64 / last;
                (start * (1.0 - share) + end * share).clamp(start, end)
            })
            .collect()
    }

    /// Greville abscissa of each stored control point: the mean of its `p` inner knots.
    #[must_use]
    pub fn greville_abscissae(&self) -> Vec<f64> {
        let p = self.degree;
        (0..self.control_points())
            .map(|i| self.knots[i + 1..=i + p].iter().map(|knot| knot / p as f64).sum())
            .collect()
    }

    /// Spans of positive length inside the domain, as indices into the knots.
    pub fn nonempty_spans(&self) -> impl Iterator<Item = usize> + '_ {
        (self.degree..self.control_points()).filter(|&s| self.knots[s] < self.knots[s + 1])
    }
}

pub(crate) fn check_degree(degree: usize) -> Result<(), Error> {
    if (1..=MAX_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: "degree".into(),
        value: degree as f64,
        rule: "degrees from 1 to 25 are possible",
    })
}

fn check_knots(degree: usize, knots: &[f64]) -> Result<(), Error> {
    let least = 2 * (degree + 1);
    if knots.len() < least {
        return Err(Error::WrongCount {
            what: "knots",
            given: knots.len(),
            expected: least,
            why: "a curve of degree p has at least 2 (p + 1) knots, the end knots included",
        });
    }
    let bad = |index: usize, problem| Err(Error::BadKnot { index, value: knots[index], problem });
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return bad(index, "is not finite");
    }
    if let Some(index) = (1..knots.len()).find(|&i| knots[i] < knots[i - 1]) {
        return bad(index, "is less than the one before it; knots must not fall");
    }
    // A knot of multiplicity p + 2 would leave a basis function without support.
    if let Some(i) = (degree + 1..knots.len()).find(|&i| knots[i] == knots[i - degree - 1]) {
        return bad(i, "is repeated more than degree + 1 times");
    }
    let n = knots.len() - degree - 1;
    let inner = degree + 1..n;
    let (start, end) = (knots[degree], knots[n]);
    if start >= end {
        return bad(degree, "starts a domain of no length");
    }
    if let Some(i) = inner.clone().find(|&i| {
        i >= 2 * degree && knots[i] == knots[i - degree] && knots[i] > start && knots[i] < end
    }) {
        return bad(
            i,
            "is repeated more than degree times inside the domain, which breaks the curve",
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_end_of_the_domain_belongs_to_the_last_span() {
        let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 3.0]).unwrap();
        assert_eq!(knots.span(3.0), Ok(4));
        assert_eq!(knots.span(1.0), Ok(4));
        assert_eq!(knots.span(0.0), Ok(2));
        assert_eq!(knots.span_from(2, 3.0), 4);
        assert!(knots.span(3.1).is_err() && knots.span(f64::NAN).is_err());
    }

    #[test]
    fn bad_knots_are_named() {
        let falling = KnotVector::open(1, vec![0.0, 0.0, 1.0, 0.5, 2.0, 2.0]);
        assert!(matches!(falling, Err(Error::BadKnot { index: 3, .. })));
        let repeated = KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0, 2.0, 2.0]);
        assert!(matches!(repeated, Err(Error::BadKnot { index: 3, .. })));
        let short = KnotVector::open(3, vec![0.0, 1.0]);
        assert!(matches!(short, Err(Error::WrongCount { expected: 8, .. })));
        let empty = KnotVector::open(1, vec![0.0, 1.0, 1.0, 2.0]);
        assert!(matches!(empty, Err(Error::BadKnot { .. })));
    }

    #[test]
    fn a_periodic_vector_must_repeat() {
        let good: Vec<f64> = (-2..8).map(f64::from).collect();
        assert!(KnotVector::periodic(2, good.clone()).is_ok());
        let mut bad = good;
        bad[0] = -2.5;
        assert!(matches!(KnotVector::periodic(2, bad), Err(Error::BadKnot { index: 0, .. })));
    }
}
