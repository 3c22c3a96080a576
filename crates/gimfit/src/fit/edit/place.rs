//! Where an edited point may be, and which parameter an inserted one takes.

use super::EditableCurve;
use crate::Error;
use crate::fit::solve::norm;
use crate::points::{Extent, PowerOfTwoScale};

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

/// A point of the caller's, checked and scaled.
pub(super) fn scaled(
    scale: PowerOfTwoScale,
    dimension: usize,
    index: usize,
    point: &[f64],
) -> Result<Vec<f64>, Error> {
    if point.len() != dimension {
        return Err(Error::WrongCount {
            what: "coordinates",
            given: point.len(),
            expected: dimension,
            why: "as many as the other points have",
        });
    }
    if let Some(coordinate) = point.iter().position(|x| !x.is_finite()) {
        return Err(Error::NotFinite { point: index, coordinate, value: point[coordinate] });
    }
    let scaled = scale.apply(point).into_owned();
    if scaled.iter().all(|x| x.is_finite()) { Ok(scaled) } else { Err(Error::LeavesDoubles) }
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
        scaled(self.scale, self.dimension(), index, point)
    }

    /// The point at a position that may lie past an end, and its parameter: none on an open curve, on
    /// a closed one that of another round.
    pub(super) fn neighbour(&self, j: isize) -> Option<(usize, f64)> {
        let inside = usize::try_from(j).is_ok_and(|j| j < self.len());
        (inside || self.period.is_some()).then(|| self.unrolled_point(j))
    }

    /// Refuses a point at the place of a neighbour, where parameters follow chords.
    pub(super) fn keep_apart(
        &self,
        point: &[f64],
        before: isize,
        after: usize,
    ) -> Result<(), Error> {
        let near = [before, after as isize].map(|j| self.neighbour(j));
        let met = near.into_iter().flatten().find(|&(j, _)| self.data(j) == point);
        match met {
            Some((neighbour, _)) if self.spacing != Spacing::Free => {
                Err(Error::MeetsNeighbour { neighbour })
            }
            _ => Ok(()),
        }
    }

    /// Distances from a point to point `index - 1` and to point `after`, as far as they exist, added
    /// up.
    pub(super) fn chords(&self, index: usize, point: &[f64], after: usize) -> f64 {
        let near = [index as isize - 1, after as isize].map(|j| self.neighbour(j));
        near.into_iter().flatten().map(|(j, _)| distance(self.data(j), point)).sum()
    }

    /// Whether a parameter lies between those before and at `index`.
    pub(super) fn fits_between(&self, index: usize, t: f64) -> bool {
        self.neighbour(index as isize - 1).is_none_or(|(_, before)| before < t)
            && self.neighbour(index as isize).is_none_or(|(_, after)| t < after)
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
        let gap = [index as isize - 1, index as isize].map(|j| self.neighbour(j));
        let t = match gap {
            [None, _] => beyond(0, 1),
            [_, None] => beyond(last, last - 1),
            [Some((first, before)), Some((second, after))] => {
                let near = step(self.data(first), point);
                let share = near / (near + step(point, self.data(second)));
                before + (after - before) * share
            }
        };
        if t.is_finite() && self.fits_between(index, t) {
            return Ok(t);
        }
        let first = index.saturating_sub(1);
        Err(Error::ParametersCollide { first, second: first + 1 })
    }

    pub(super) fn parameter(&self, index: usize) -> f64 {
        self.blocks.row(index)[0]
    }
}
