//! Where a matrix is bad, and what the spacing of the data is there.

use crate::collocation::CollocationMatrix;

/// A place on the curve. Positions count the points fitted, from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The point.
    pub point: usize,
    /// First point of the shortest step of the parameters nearby.
    pub shortest: usize,
    /// First point of the longest step nearby.
    pub longest: usize,
    /// That step over the shortest.
    pub ratio: f64,
    /// Value of the point's own basis function at its parameter: what the conditions of Schoenberg
    /// and Whitney demand to be positive.
    pub diagonal: f64,
}

/// Steps of the parameters, of a closed curve also that over its seam.
#[derive(Debug, Clone, Copy)]
pub struct Spacing<'a> {
    /// Parameters of the points fitted.
    pub parameters: &'a [f64],
    /// Period of a closed curve.
    pub period: Option<f64>,
    /// How many steps to each side a basis function sees.
    pub reach: usize,
}

impl Spacing<'_> {
    fn steps(&self) -> usize {
        self.parameters.len() - usize::from(self.period.is_none())
    }

    fn step(&self, j: usize) -> f64 {
        let t = self.parameters;
        match (t.get(j + 1), self.period) {
            (Some(next), _) => next - t[j],
            (None, Some(period)) => t[0] + period - t[j],
            (None, None) => f64::NAN,
        }
    }

    /// Looks at the steps around a point.
    pub(super) fn around(&self, point: usize, matrix: &dyn CollocationMatrix) -> Place {
        let steps = self.steps();
        let (reach, point_signed) = (self.reach as isize, point as isize);
        let near = (point_signed - reach..point_signed + reach).filter_map(|j| match self.period {
            Some(_) => Some(j.rem_euclid(steps as isize) as usize),
            None => usize::try_from(j).ok().filter(|&j| j < steps),
        });
        let mut place = Place {
            point,
            shortest: point,
            longest: point,
            ratio: 1.0,
            diagonal: matrix.diagonal(point),
        };
        let (mut shortest, mut longest) = (f64::INFINITY, 0.0);
        for j in near {
            let step = self.step(j);
            if step < shortest {
                (shortest, place.shortest) = (step, j);
            }
            if step > longest {
                (longest, place.longest) = (step, j);
            }
        }
        if longest > 0.0 {
            place.ratio = longest / shortest;
        }
        place
    }
}
