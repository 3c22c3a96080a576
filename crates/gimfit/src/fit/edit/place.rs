//! Where an edited point may be, and which parameter an inserted one takes.

use super::EditableCurve;
use crate::Error;
use crate::fit::solve::norm;
use crate::points::Extent;

/// How parameters follow the points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Spacing {
    /// In proportion to chords.
    Chord,
    /// In proportion to their square roots.
    Centripetal,
    /// Not at all.
    Free,
}

impl Spacing {
    fn step(self, chord: f64) -> f64 {
        match self {
            Self::Chord => chord,
            Self::Centripetal => chord.sqrt(),
            Self::Free => 1.0,
        }
    }
}

pub(super) fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&a.iter().zip(b).map(|(a, b)| b - a).collect::<Vec<_>>())
}

/// Takes a point in.
pub(super) fn widen(extent: &mut Extent, point: &[f64]) {
    extent.lower.iter_mut().zip(point).for_each(|(low, x)| *low = low.min(*x));
    extent.upper.iter_mut().zip(point).for_each(|(high, x)| *high = high.max(*x));
}

impl EditableCurve {
    /// A data point, scaled.
    pub(super) fn data(&self, index: usize) -> &[f64] {
        &self.blocks.row(index)[2..2 + self.dimension()]
    }

    pub(super) fn check_position(&self, index: usize, count: usize) -> Result<(), Error> {
        if index < count {
            return Ok(());
        }
        Err(Error::OutOfRange {
            what: "position of the point to edit".into(),
            value: index as f64,
            rule: "it must be less than the number of points; to insert, at most that number",
        })
    }

    /// A point of the caller's, checked and scaled.
    pub(super) fn scaled(&self, index: usize, point: &[f64]) -> Result<Vec<f64>, Error> {
        if point.len() != self.dimension() {
            return Err(Error::WrongCount {
                what: "coordinates",
                given: point.len(),
                expected: self.dimension(),
                why: "as many as the other points have",
            });
        }
        if let Some(coordinate) = point.iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite { point: index, coordinate, value: point[coordinate] });
        }
        let scaled = self.scale.apply(point).into_owned();
        if scaled.iter().all(|x| x.is_finite()) { Ok(scaled) } else { Err(Error::LeavesDoubles) }
    }

    /// Refuses a point at the place of a neighbour, where parameters follow chords.
    pub(super) fn keep_apart(
        &self,
        point: &[f64],
        before: Option<usize>,
        after: usize,
    ) -> Result<(), Error> {
        let after = (after < self.len()).then_some(after);
        let met = before.into_iter().chain(after).find(|&j| self.data(j) == point);
        match met {
            Some(neighbour) if self.spacing != Spacing::Free => {
                Err(Error::MeetsNeighbour { neighbour })
            }
            _ => Ok(()),
        }
    }

    /// Distances from a point to point `index - 1` and to point `after`, as far as they exist, added
    /// up.
    pub(super) fn chords(&self, index: usize, point: &[f64], after: usize) -> f64 {
        let after = (after < self.len()).then_some(after);
        let near = index.checked_sub(1).into_iter().chain(after);
        near.map(|j| distance(self.data(j), point)).sum()
    }

    /// Whether a parameter lies between those before and at `index`.
    pub(super) fn fits_between(&self, index: usize, t: f64) -> bool {
        let above = index.checked_sub(1).is_none_or(|before| self.parameter(before) < t);
        above && (index == self.len() || t < self.parameter(index))
    }

    /// The parameter of a point inserted before point `index`.
    pub(super) fn parameter_between(&self, index: usize, point: &[f64]) -> Result<f64, Error> {
        let step = |a: &[f64], b: &[f64]| self.spacing.step(distance(a, b));
        let last = self.len() - 1;
        // Beyond an end: as long a step as the chord would be in the gap next to it.
        let beyond = |end: usize, next: usize| {
            let gap = self.parameter(next) - self.parameter(end);
            let chord = step(self.data(end), self.data(next));
            self.parameter(end) - gap * (step(self.data(end), point) / chord)
        };
        let t = if index == 0 {
            beyond(0, 1)
        } else if index > last {
            beyond(last, last - 1)
        } else {
            let (before, after) = (self.parameter(index - 1), self.parameter(index));
            let near = step(self.data(index - 1), point);
            let share = near / (near + step(point, self.data(index)));
            before + (after - before) * share
        };
        if t.is_finite() && self.fits_between(index, t) {
            return Ok(t);
        }
        let first = index.saturating_sub(1);
        Err(Error::ParametersCollide { first, second: first + 1 })
    }

    fn parameter(&self, index: usize) -> f64 {
        self.blocks.row(index)[0]
    }
}
