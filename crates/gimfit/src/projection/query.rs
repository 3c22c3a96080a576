//! What queries for nearest points share: checks, exact scaling, and running many of them.

use crate::Error;
use crate::points::{Points, PointsView, PowerOfTwoScale};
use rayon::prelude::*;

/// Beyond 2^400 of a scaled curve or surface, a query is pulled in along its direction: every point
/// has the same distance in doubles, and the nearest one does not change.
const FARTHEST_EXPONENT: i32 = 400;
/// Queries that a processor takes at once.
const BATCH: usize = 128;

/// How the queries of a curve or surface are read.
#[derive(Debug, Clone)]
pub(super) struct Queries {
    pub(super) scale: PowerOfTwoScale,
    pub(super) rational: bool,
    dimension: usize,
    /// Largest coordinate, scaled.
    magnitude: f64,
}

impl Queries {
    /// For a shape with these control points.
    pub(super) fn new(control_points: &Points, rational: bool) -> Self {
        let values = control_points.coordinates();
        let largest = values.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let scale = PowerOfTwoScale::for_magnitude(largest);
        let magnitude = scale.up(largest);
        Self { scale, rational, dimension: control_points.dimension(), magnitude }
    }

    /// The control points as the search sees them, where that is scaled.
    pub(super) fn scaled(&self, control_points: &Points) -> Option<Points> {
        if self.scale.is_identity() {
            return None;
        }
        let scaled = self.scale.apply(control_points.coordinates()).into_owned();
        Points::new(self.dimension, scaled).ok()
    }

    /// Numbers to a control point, with its weight.
    pub(super) fn width(&self) -> usize {
        self.dimension + usize::from(self.rational)
    }

    /// Refuses points of another dimension, and what is no number.
    pub(super) fn check(&self, points: PointsView<'_>) -> Result<(), Error> {
        if points.dimension() != self.dimension {
            return Err(Error::WrongCount {
                what: "coordinates",
                given: points.dimension(),
                expected: self.dimension,
                why: "the dimension of the curve or surface",
            });
        }
        let values = points.coordinates();
        match values.iter().position(|x| !x.is_finite()) {
            None => Ok(()),
            Some(position) => Err(Error::NotFinite {
                point: position / self.dimension,
                coordinate: position % self.dimension,
                value: values[position],
            }),
        }
    }

    /// Writes a query as the search sees it; gives back the square of a length that rounding of the
    /// coordinates alone explains.
    pub(super) fn place(&self, point: &[f64], query: &mut Vec<f64>) -> f64 {
        let limit = 2f64.powi(FARTHEST_EXPONENT);
        query.clear();
        let largest = point.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        if self.scale.up(largest) <= limit {
            query.extend(point.iter().map(|x| self.scale.up(*x)));
        } else {
            // In two steps, so that neither leaves the range.
            query.extend(point.iter().map(|x| x / largest * limit));
        }
        let size = query.iter().fold(self.magnitude, |m, x| m.max(x.abs()));
        let noise = 4.0 * f64::EPSILON * size;
        noise * noise
    }

    /// Answers all queries, in parallel where they are many.
    pub(super) fn each<W: Default, F: Send>(
        &self,
        points: PointsView<'_>,
        answer: impl Fn(&[f64], &mut W) -> Result<F, Error> + Sync,
    ) -> Result<Vec<F>, Error> {
        if points.len() <= BATCH {
            let mut work = W::default();
            return (0..points.len()).map(|j| answer(points.point(j), &mut work)).collect();
        }
        (0..points.len())
            .into_par_iter()
            .with_min_len(BATCH)
            .map_init(W::default, |work, j| answer(points.point(j), work))
            .collect()
    }
}

/// Euclidean distance; vectors whose squares leave the range are met with `hypot`.
pub(super) fn distance_between(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum();
    if square.is_normal() {
        return square.sqrt();
    }
    a.iter().zip(b).fold(0.0, |sum: f64, (x, y)| sum.hypot(x - y))
}
