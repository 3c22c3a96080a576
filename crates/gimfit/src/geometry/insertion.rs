//! Knot insertion: the same curve over more knots (Boehm 1980; all at once as in The NURBS Book,
//! algorithm A5.4). The control polygon comes closer to the curve with every knot.

use super::Curve;
use crate::Error;
use crate::knots::{Boundary, KnotVector};
use crate::points::Points;

/// The way from control points over some knots to those over more knots.
#[derive(Debug, Clone)]
pub(crate) struct KnotInsertion {
    from: KnotVector,
    to: KnotVector,
    /// Ascending, inside the domain.
    added: Vec<f64>,
}

impl KnotInsertion {
    /// Adds knots to those of a vector; they may come in any order.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`] for knots at or beyond the ends; [`Error::BadKnot`] for those that
    /// would be repeated more often than the degree allows.
    pub(crate) fn new(from: &KnotVector, added: &[f64]) -> Result<Self, Error> {
        let (start, end) = from.domain();
        if let Some(&parameter) = added.iter().find(|&&t| !(start < t && t < end)) {
            return Err(Error::OutsideDomain { parameter, start, end });
        }
        let mut added = added.to_vec();
        added.sort_by(f64::total_cmp);
        let degree = from.degree();
        let to = match from.boundary() {
            Boundary::Open => {
                let mut knots = [from.values(), &added].concat();
                knots.sort_by(f64::total_cmp);
                KnotVector::open(degree, knots)?
            }
            Boundary::Periodic => {
                let mut inner = from.values()[degree..from.control_points()].to_vec();
                inner.extend_from_slice(&added);
                inner.sort_by(f64::total_cmp);
                KnotVector::periodic(degree, around(&inner, degree, end - start))?
            }
        };
        Ok(Self { from: from.clone(), to, added })
    }

    /// The knots all together.
    pub(crate) fn knots(&self) -> &KnotVector {
        &self.to
    }

    /// How many were added.
    pub(crate) fn count(&self) -> usize {
        self.added.len()
    }

    /// The stored control points over all knots for those over the old ones.
    pub(crate) fn apply(&self, control: &[f64], dimension: usize) -> Vec<f64> {
        let degree = self.from.degree();
        if self.added.is_empty() {
            return control.to_vec();
        }
        if self.from.boundary() == Boundary::Open {
            return insert(self.from.values(), degree, control, dimension, &self.added).1;
        }
        // The free control points, with enough of the laps before and after that nothing at the
        // seam is special.
        let (start, end) = self.from.domain();
        let period = end - start;
        let free = self.from.control_points() - degree;
        let margin = 2 * degree;
        let inner = &self.from.values()[degree..degree + free];
        let lap = |i: isize| i.div_euclid(free as isize) as f64 * period;
        let index = |i: isize| i.rem_euclid(free as isize) as usize;
        let margin_signed = margin as isize;
        let knots: Vec<f64> = (-margin_signed..(free + margin + degree + 1) as isize)
            .map(|i| i - degree as isize)
            .map(|i| inner[index(i)] + lap(i))
            .collect();
        let wide: Vec<f64> = (-margin_signed..(free + margin) as isize)
            .flat_map(|i| control[index(i) * dimension..][..dimension].iter().copied())
            .collect();
        let reach = (knots[degree], knots[free + 2 * margin]);
        let laps = 1 + margin / free;
        let mut added: Vec<f64> = (-(laps as isize)..=laps as isize)
            .flat_map(|k| self.added.iter().map(move |t| t + k as f64 * period))
            .filter(|&t| reach.0 < t && t < reach.1)
            .collect();
        added.sort_by(f64::total_cmp);
        let before = added.iter().filter(|&&t| t < start).count();
        let (_, wide) = insert(&knots, degree, &wide, dimension, &added);
        let count = free + self.added.len();
        let mut result = wide[(margin + before) * dimension..][..count * dimension].to_vec();
        result.extend_from_within(..degree * dimension);
        result
    }
}

/// The knots of a periodic vector from those of one lap.
fn around(inner: &[f64], degree: usize, period: f64) -> Vec<f64> {
    let (count, p) = (inner.len() as isize, degree as isize);
    (-p..=count + p)
        .map(|i| inner[i.rem_euclid(count) as usize] + i.div_euclid(count) as f64 * period)
        .collect()
}

/// Knots and control points after inserting ascending knots inside the domain.
fn insert(
    knots: &[f64],
    degree: usize,
    control: &[f64],
    dimension: usize,
    added: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let count = control.len() / dimension;
    let span = |t: f64| {
        let inner = &knots[degree..=count];
        degree + inner.partition_point(|&knot| knot <= t) - 1
    };
    let (first, last) = (span(added[0]), span(added[added.len() - 1]) + 1);
    let mut to_knots = vec![0.0; knots.len() + added.len()];
    let mut to = vec![0.0; control.len() + added.len() * dimension];
    let copy = |to: &mut [f64], i: usize, j: usize| {
        to[i * dimension..(i + 1) * dimension]
            .copy_from_slice(&control[j * dimension..(j + 1) * dimension]);
    };
    (0..=first - degree).for_each(|j| copy(&mut to, j, j));
    (last - 1..count).for_each(|j| copy(&mut to, j + added.len(), j));
    to_knots[..=first].copy_from_slice(&knots[..=first]);
    to_knots[last + degree + added.len()..].copy_from_slice(&knots[last + degree..]);
    let mut i = last + degree - 1;
    let mut k = last + degree + added.len() - 1;
    for &t in added.iter().rev() {
        while t <= knots[i] && i > first {
            copy(&mut to, k - degree - 1, i - degree - 1);
            to_knots[k] = knots[i];
            k -= 1;
            i -= 1;
        }
        to.copy_within(
            (k - degree) * dimension..(k - degree + 1) * dimension,
            (k - degree - 1) * dimension,
        );
        for l in 1..=degree {
            let at = k - degree + l;
            let ahead = to_knots[k + l] - t;
            let share =
                if ahead == 0.0 { 0.0 } else { ahead / (to_knots[k + l] - knots[i - degree + l]) };
            for c in 0..dimension {
                let (near, far) = (to[at * dimension + c], to[(at - 1) * dimension + c]);
                // In this form equal points stay equal.
                to[(at - 1) * dimension + c] = near + share * (far - near);
            }
        }
        to_knots[k] = t;
        k -= 1;
    }
    (to_knots, to)
}

impl Curve {
    /// The same curve over more knots, those given added to its own: once each, inside its domain.
    /// Nothing but the control points changes, which come closer to the curve.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`] for knots at or beyond the ends of the domain; [`Error::BadKnot`]
    /// for knots that would be repeated more than degree times.
    ///
    /// # Examples
    /// ```
    /// use gimfit::{Curve, KnotVector, Points};
    /// let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0])?;
    /// let control = Points::new(2, vec![0.0, 0.0, 1.0, 2.0, 2.0, 0.0])?;
    /// let curve = Curve::new(knots, control)?;
    /// let same = curve.with_knots(&[0.5])?;
    /// assert_eq!(same.control_points().coordinates(), [0.0, 0.0, 0.5, 1.0, 1.5, 1.0, 2.0, 0.0]);
    /// # Ok::<(), gimfit::Error>(())
    /// ```
    pub fn with_knots(&self, added: &[f64]) -> Result<Self, Error> {
        let insertion = KnotInsertion::new(self.knots(), added)?;
        let dimension = self.dimension();
        let control = self.control_points().coordinates();
        let Some(weights) = self.rational_weights() else {
            let control = insertion.apply(control, dimension);
            return Self::new(insertion.to, Points::new(dimension, control)?);
        };
        // In homogeneous coordinates a rational curve is a polynomial one.
        let finer_weights = insertion.apply(weights, 1);
        let weighted: Vec<f64> = control
            .chunks_exact(dimension)
            .zip(weights)
            .flat_map(|(point, weight)| point.iter().map(move |x| weight * x))
            .collect();
        let mut finer = insertion.apply(&weighted, dimension);
        for (point, weight) in finer.chunks_exact_mut(dimension).zip(&finer_weights) {
            point.iter_mut().for_each(|x| *x /= weight);
        }
        Self::rational(insertion.to, Points::new(dimension, finer)?, finer_weights)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(count: usize, dimension: usize) -> Vec<f64> {
        (0..count * dimension).map(|i| (1.0 + 1.7 * i as f64).sin()).collect()
    }

    fn check(curve: &Curve, added: &[f64]) {
        let finer = curve.with_knots(added).unwrap();
        assert_eq!(finer.knots().values().len(), curve.knots().values().len() + added.len());
        for t in curve.equal_steps(101) {
            let (a, b) = (curve.evaluate(t).unwrap(), finer.evaluate(t).unwrap());
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-13), "at {t}");
        }
    }

    #[test]
    fn the_curve_stays_the_same() {
        for degree in 1..=6 {
            let spans = 9;
            let mut knots = vec![0.0; degree];
            knots.extend((0..=spans).map(|i| f64::from(i) + 0.3 * f64::from(i % 3)));
            knots.extend(vec![knots[knots.len() - 1]; degree]);
            let knots = KnotVector::open(degree, knots).unwrap();
            let control = Points::new(3, wave(knots.control_points(), 3)).unwrap();
            let curve = Curve::new(knots, control).unwrap();
            check(&curve, &[0.1, 8.9, 0.11, 4.4, 4.5, 4.6, 2.0, 2.25]);
            check(&curve, &[5.0]);
            check(&curve, &[]);
            let (knots, control) = (curve.knots().clone(), curve.control_points().clone());
            let weights = (0..control.len()).map(|i| 1.0 + 0.5 * (i as f64).sin()).collect();
            let rational = Curve::rational(knots, control, weights).unwrap();
            check(&rational, &[0.1, 8.9, 4.4, 4.5]);
        }
    }

    #[test]
    fn a_closed_curve_stays_the_same_across_its_seam() {
        for degree in 1..=5 {
            for free in [degree + 1, degree + 2, 11] {
                let inner: Vec<f64> =
                    (0..free).map(|i| i as f64 + if i % 2 == 0 { 0.0 } else { 0.4 }).collect();
                let knots = around(&inner, degree, free as f64);
                let knots = KnotVector::periodic(degree, knots).unwrap();
                let mut control = wave(free, 2);
                control.extend_from_within(..2 * degree);
                let curve = Curve::new(knots, Points::new(2, control).unwrap()).unwrap();
                let end = free as f64;
                check(&curve, &[0.01, 0.02, end - 0.01, 1.2, end - 0.2]);
                check(&curve, &[end - 0.125]);
            }
        }
    }

    #[test]
    fn knots_that_do_not_fit_are_refused() {
        let knots = KnotVector::open(1, vec![0.0, 0.0, 1.0, 2.0, 2.0]).unwrap();
        let curve = Curve::new(knots, Points::new(1, vec![0.0, 1.0, 0.0]).unwrap()).unwrap();
        assert!(matches!(curve.with_knots(&[2.0]), Err(Error::OutsideDomain { .. })));
        assert!(matches!(curve.with_knots(&[f64::NAN]), Err(Error::OutsideDomain { .. })));
        assert!(matches!(curve.with_knots(&[1.0]), Err(Error::BadKnot { .. })));
    }
}
