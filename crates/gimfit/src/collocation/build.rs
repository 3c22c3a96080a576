//! Builds the operator of an interpolating curve from parameters and knots. The kinds of boundary
//! end here: the iteration sees rows only.

use super::{BandedCollocation, ControlLayout};
use crate::basis::basis_functions;
use crate::knots::{Boundary, KnotVector, MAX_DEGREE};
use crate::parameters::Parameters;
use crate::{Error, memory};

/// A square operator and the way from its unknowns to a curve.
#[derive(Debug)]
pub struct Interpolation {
    /// One row per data point, one column per control point that moves.
    pub operator: BandedCollocation,
    /// How the moving control points are stored.
    pub layout: ControlLayout,
}

impl Interpolation {
    /// Collocates the same basis at other parameters of the domain, in place: the control points
    /// keep their meaning. A closed curve's parameters step back at the seam at most once.
    ///
    /// # Errors
    /// [`Error::SchoenbergWhitney`] if a data point no longer meets its basis function; the rows
    /// are those of the new parameters all the same.
    pub(crate) fn recollocate(&mut self, t: &[f64], knots: &KnotVector) -> Result<(), Error> {
        let mut rows = CollocationRows::of_operator(std::mem::take(&mut self.operator));
        rows.fill(t, knots);
        match self.layout {
            ControlLayout::Free => {}
            ControlLayout::Tied { per_end } => rows.tie(per_end, t.len()),
            ControlLayout::Periodic { shift, .. } => rows.shift(shift),
        }
        let met = check_diagonal(&rows, t);
        self.operator = rows.into_operator();
        met
    }
}

/// Collocates the basis at the parameters, one control point per data point.
///
/// # Errors
/// [`Error::WrongCount`] unless knots and parameters match; [`Error::OutsideDomain`];
/// [`Error::SchoenbergWhitney`] if a data point does not meet its basis function.
pub fn interpolation(parameters: &Parameters, knots: &KnotVector) -> Result<Interpolation, Error> {
    let t = parameters.values();
    let (count, degree) = (t.len(), knots.degree());
    if i32::try_from(count + 2 * degree).is_err() {
        return Err(Error::OutOfRange {
            what: "number of points".into(),
            value: count as f64,
            rule: "at most 2 147 483 000 points can be interpolated at once",
        });
    }
    match knots.boundary() {
        Boundary::Periodic => {
            let (start, end) = knots.domain();
            periodic(t, parameters.period().unwrap_or(end - start), knots)
        }
        Boundary::Open => open(t, knots),
    }
}

fn open(t: &[f64], knots: &KnotVector) -> Result<Interpolation, Error> {
    let (count, degree) = (t.len(), knots.degree());
    let (start, end) = knots.domain();
    if let Some(&parameter) = t.iter().find(|&&t| !(start <= t && t <= end)) {
        return Err(Error::OutsideDomain { parameter, start, end });
    }
    let surplus = knots.control_points().checked_sub(count);
    let per_end = match surplus {
        Some(surplus) if surplus == 0 || surplus + 1 == degree => surplus / 2,
        _ => {
            return Err(Error::WrongCount {
                what: "knots",
                given: knots.values().len(),
                expected: count + degree + 1,
                why: "points + degree + 1 for interpolation",
            });
        }
    };
    let mut rows = collocate(t, knots);
    if per_end > 0 {
        rows.tie(per_end, count);
    }
    check_diagonal(&rows, t)?;
    let layout = if per_end > 0 { ControlLayout::Tied { per_end } } else { ControlLayout::Free };
    Ok(Interpolation { operator: rows.into_operator(), layout })
}

fn periodic(t: &[f64], period: f64, knots: &KnotVector) -> Result<Interpolation, Error> {
    let (count, degree) = (t.len(), knots.degree());
    if knots.control_points() != count + degree {
        return Err(Error::WrongCount {
            what: "knots",
            given: knots.values().len(),
            expected: count + 2 * degree + 1,
            why: "points + 2 * degree + 1 for a closed curve",
        });
    }
    let wrapped: Vec<f64> = t.iter().map(|&t| wrap(t, knots.domain(), period)).collect();
    let mut rows = collocate(&wrapped, knots);
    let shift = rows.best_shift();
    rows.shift(shift);
    check_diagonal(&rows, t)?;
    let layout = ControlLayout::Periodic { shift, degree };
    Ok(Interpolation { operator: rows.into_operator(), layout })
}

/// Brings a parameter of a closed curve into its domain. The period is that of the parameters: the
/// length of the domain is the same but for rounding.
pub(crate) fn wrap(t: f64, (start, end): (f64, f64), period: f64) -> f64 {
    if t < start {
        (t + period).clamp(start, end)
    } else if t > end {
        (t - period).clamp(start, end)
    } else {
        t
    }
}

pub(super) struct CollocationRows {
    width: usize,
    first: Vec<i32>,
    weights: Vec<f64>,
}

/// Rows over the stored control points.
pub(super) fn collocate(t: &[f64], knots: &KnotVector) -> CollocationRows {
    let width = knots.degree() + 1;
    let first = memory::with_capacity(t.len());
    let weights = memory::with_capacity(t.len() * width);
    let mut rows = CollocationRows { width, first, weights };
    rows.fill(t, knots);
    rows
}

impl CollocationRows {
    /// First columns and weights.
    pub(super) fn into_parts(self) -> (Vec<i32>, Vec<f64>) {
        (self.first, self.weights)
    }

    /// Rows over the stored control points, in place of those held.
    fn fill(&mut self, t: &[f64], knots: &KnotVector) {
        let Self { width, first, weights } = self;
        let degree = knots.degree();
        first.clear();
        weights.clear();
        let mut values = [0.0; MAX_DEGREE + 1];
        let mut span = degree;
        let mut previous = f64::NEG_INFINITY;
        for &t in t {
            // Only the seam of a closed curve steps back.
            span = knots.span_from(if t < previous { degree } else { span }, t);
            previous = t;
            basis_functions(knots.values(), degree, span, t, &mut values);
            first.push((span - degree) as i32);
            // A length known at compile time spares a call per row.
            match *width {
                4 => weights.extend_from_slice(&values[..4]),
                _ => weights.extend_from_slice(&values[..*width]),
            }
        }
    }

    fn of_operator(operator: BandedCollocation) -> Self {
        let (width, first, weights) = operator.into_rows();
        Self { width, first, weights }
    }

    fn into_operator(self) -> BandedCollocation {
        BandedCollocation::from_rows(self.width, self.first, self.weights)
    }

    /// Adds the weights of tied control points up: they move as one.
    fn tie(&mut self, per_end: usize, count: usize) {
        let last = count as i32 - 1;
        for (first, weights) in self.first.iter_mut().zip(self.weights.chunks_exact_mut(self.width))
        {
            let stored = *first - per_end as i32;
            let start = stored.clamp(0, (last + 1 - self.width as i32).max(0));
            let mut old = [0.0; MAX_DEGREE + 1];
            old[..self.width].copy_from_slice(weights);
            weights.fill(0.0);
            for (k, weight) in old.iter().take(self.width).enumerate() {
                let column = (stored + k as i32).clamp(0, last);
                weights[(column - start) as usize] += weight;
            }
            *first = start;
        }
    }

    /// The stored position for data point 0 that gives the diagonal its largest smallest entry.
    fn best_shift(&self) -> usize {
        // From the middle outwards, so that the best comes early and the others are given up soon.
        let middle = self.width / 2;
        let mut candidates: Vec<usize> = (0..self.width).collect();
        candidates.sort_by_key(|shift| shift.abs_diff(middle));
        let (mut best, mut worth) = (middle, 0.0);
        for shift in candidates {
            let smallest = self.smallest_diagonal(shift, worth);
            if smallest > worth {
                (best, worth) = (shift, smallest);
            }
        }
        best
    }

    /// Smallest diagonal entry after a shift; 0 as soon as it is known not to exceed `least`.
    fn smallest_diagonal(&self, shift: usize, least: f64) -> f64 {
        let mut smallest = f64::INFINITY;
        let rows = self.first.iter().zip(self.weights.chunks_exact(self.width));
        for (j, (&first, weights)) in rows.enumerate() {
            let k = self.unwrapped(j as i32 + shift as i32 - first);
            let entry = usize::try_from(k).ok().and_then(|k| weights.get(k)).copied();
            smallest = smallest.min(entry.unwrap_or(0.0));
            if smallest <= least {
                return 0.0;
            }
        }
        smallest
    }

    /// Renumbers the columns so that control point j belongs to data point j.
    fn shift(&mut self, shift: usize) {
        for j in 0..self.first.len() {
            // Offset of the diagonal in the row, brought into one lap.
            let k = self.unwrapped(j as i32 + shift as i32 - self.first[j]);
            self.first[j] = j as i32 - k;
        }
    }

    /// An offset into a row of a closed curve, brought to the lap nearest the row's middle.
    fn unwrapped(&self, k: i32) -> i32 {
        if (0..self.width as i32).contains(&k) {
            return k;
        }
        let (count, middle) = (self.first.len() as i32, self.width as i32 / 2);
        (k - middle + count / 2).rem_euclid(count) - count / 2 + middle
    }
}

fn check_diagonal(rows: &CollocationRows, t: &[f64]) -> Result<(), Error> {
    for (j, &first) in rows.first.iter().enumerate() {
        let k = j as i32 - first;
        let weights = &rows.weights[j * rows.width..][..rows.width];
        let on_diagonal = usize::try_from(k).ok().and_then(|k| weights.get(k)).copied();
        if on_diagonal.is_none_or(|weight| weight <= 0.0) {
            return Err(Error::SchoenbergWhitney { point: j, parameter: t[j] });
        }
    }
    Ok(())
}
