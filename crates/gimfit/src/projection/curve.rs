//! Safeguarded Newton iteration on `(C(t) - Q) . C'(t) = 0`.

use crate::Error;
use crate::geometry::Curve;
use crate::points::PointsView;

/// A point of the curve near a given point.
#[derive(Debug, Clone, PartialEq)]
pub struct FootPoint {
    /// Its parameter.
    pub parameter: f64,
    /// The point itself.
    pub point: Vec<f64>,
    /// Its distance from the given point.
    pub distance: f64,
}

/// Walks downhill from `start` to a nearest point of the curve: a local minimum of the distance,
/// never farther away than `C(start)`. On a periodic curve the walk crosses the seam.
///
/// # Errors
/// [`Error::OutsideDomain`] for `start`; [`Error::WrongCount`] for a point of another dimension.
pub fn local_foot_point(curve: &Curve, point: &[f64], start: f64) -> Result<FootPoint, Error> {
    let dimension = curve.dimension();
    if point.len() != dimension {
        return Err(Error::WrongCount {
            what: "coordinates",
            given: point.len(),
            expected: dimension,
            why: "the dimension of the curve",
        });
    }
    curve.knots().span(start)?;
    let mut walk = CurveWalk::new(dimension);
    let (parameter, distance) = walk.descend(curve, point, start)?;
    let parameter = inside(parameter, curve.domain(), curve.is_periodic());
    Ok(FootPoint { parameter, point: walk.jet[..dimension].to_vec(), distance })
}

const MOST_STEPS: usize = 30;
const MOST_HALVINGS: usize = 20;

/// The way to a foot point, with the memory it needs.
#[derive(Debug, Clone)]
pub(super) struct CurveWalk {
    /// Point, first and second derivative where the walk stands, and where it may go.
    jet: Vec<f64>,
    trial: Vec<f64>,
}

impl CurveWalk {
    pub(super) fn new(dimension: usize) -> Self {
        Self { jet: vec![0.0; 3 * dimension], trial: vec![0.0; 3 * dimension] }
    }

    /// As [`local_foot_point`]; returns the parameter and the distance. On a periodic curve
    /// parameters count laps: they go on past the seam.
    pub(super) fn descend(
        &mut self,
        curve: &Curve,
        point: &[f64],
        start: f64,
    ) -> Result<(f64, f64), Error> {
        let (domain, periodic) = (curve.domain(), curve.is_periodic());
        let size = point.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut parameter = start;
        curve.derivatives_into(inside(parameter, domain, periodic), 2, &mut self.jet)?;
        let mut here = Slope::of(&self.jet, point);
        for _ in 0..MOST_STEPS {
            let Some(mut step) = here.step() else { break };
            // Rounding hides a gain this small; a last step brings the parameter to its place.
            let hidden = 4.0 * f64::EPSILON * here.distance * (here.distance + size);
            let last = (here.slope * step).abs() <= hidden;
            let mut improved = false;
            for _ in 0..if last { 1 } else { MOST_HALVINGS } {
                let beyond = parameter + step;
                let trial = if periodic { beyond } else { inside(beyond, domain, false) };
                if trial == parameter {
                    break;
                }
                curve.derivatives_into(inside(trial, domain, periodic), 2, &mut self.trial)?;
                let there = Slope::of(&self.trial, point);
                improved = if last {
                    there.distance <= here.distance + 4.0 * f64::EPSILON * (here.distance + size)
                        && there.slope.abs() < here.slope.abs()
                } else {
                    there.distance < here.distance
                };
                if improved {
                    let distance = there.distance.min(here.distance);
                    (parameter, here) = (trial, Slope { distance, ..there });
                    std::mem::swap(&mut self.jet, &mut self.trial);
                    break;
                }
                step *= 0.5;
            }
            if last || !improved {
                break;
            }
        }
        Ok((parameter, here.distance))
    }
}

/// How the distance changes along the curve.
#[derive(Debug, Clone, Copy)]
struct Slope {
    distance: f64,
    /// `(C - Q) . C'`.
    slope: f64,
    /// `C' . C'`.
    speed: f64,
    /// `(C - Q) . C''`.
    bend: f64,
}

impl Slope {
    fn of(jet: &[f64], point: &[f64]) -> Self {
        let dimension = point.len();
        let (mut square, mut slope, mut speed, mut bend) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..dimension {
            let gap = jet[i] - point[i];
            square += gap * gap;
            slope += gap * jet[dimension + i];
            speed += jet[dimension + i] * jet[dimension + i];
            bend += gap * jet[2 * dimension + i];
        }
        Self { distance: f64::sqrt(square), slope, speed, bend }
    }

    /// Step that reduces the distance: Newton's where the distance is convex, otherwise
    /// Gauss-Newton's.
    fn step(self) -> Option<f64> {
        let convex = self.speed + self.bend;
        let step = -self.slope / if convex > 0.0 { convex } else { self.speed };
        (step.is_finite() && step != 0.0).then_some(step)
    }
}

/// Brings a parameter into its domain: round a periodic one, to the end of an open one.
pub(super) fn inside(t: f64, (start, end): (f64, f64), periodic: bool) -> f64 {
    if periodic && !(start..=end).contains(&t) {
        return (start + (t - start).rem_euclid(end - start)).clamp(start, end);
    }
    t.clamp(start, end)
}

#[cfg(test)]
fn distance_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The largest deviation: the largest distance of a data point from its local foot point, with the
/// index of the point. `residuals[j]` is the distance of point `j` from the curve at `parameters[j]`
/// (inside the domain); a point whose residual is below the largest deviation so far cannot exceed
/// it and is not projected.
///
/// # Errors
/// As [`local_foot_point`].
pub fn largest_deviation(
    curve: &Curve,
    points: PointsView<'_>,
    parameters: &[f64],
    residuals: &[f64],
) -> Result<(f64, usize), Error> {
    largest_by(residuals, |j| Ok(local_foot_point(curve, points.point(j), parameters[j])?.distance))
}

/// The largest of `distance(j)`, none of which exceeds `residuals[j]`, looking only at those that
/// can.
pub(super) fn largest_by(
    residuals: &[f64],
    distance: impl Fn(usize) -> Result<f64, Error>,
) -> Result<(f64, usize), Error> {
    let worst =
        (0..residuals.len()).fold(0, |w, j| if residuals[j] > residuals[w] { j } else { w });
    let mut largest = (0.0, worst);
    for j in std::iter::once(worst).chain(0..residuals.len()) {
        if residuals[j] > largest.0 {
            // Evaluating again rounds anew; the residual stays an upper bound.
            let distance = distance(j)?.min(residuals[j]);
            if distance > largest.0 {
                largest = (distance, j);
            }
        }
    }
    Ok(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knots::KnotVector;
    use crate::points::Points;

    fn parabola() -> Curve {
        // C(t) = (t, t^2) on [0, 1].
        let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).unwrap();
        Curve::new(knots, Points::from(&[[0.0, 0.0], [0.5, 0.0], [1.0, 1.0]][..])).unwrap()
    }

    #[test]
    fn the_foot_point_is_orthogonal_or_an_end() {
        let curve = parabola();
        let foot = local_foot_point(&curve, &[0.2, 0.9], 0.1).unwrap();
        let mut jet = [0.0; 4];
        curve.derivatives_into(foot.parameter, 1, &mut jet).unwrap();
        let slope = (jet[0] - 0.2) * jet[2] + (jet[1] - 0.9) * jet[3];
        assert!(slope.abs() < 1e-7, "{slope}");
        assert_eq!(local_foot_point(&curve, &[-1.0, -0.5], 0.5).unwrap().parameter, 0.0);
        assert_eq!(local_foot_point(&curve, &[2.0, 3.0], 0.5).unwrap().parameter, 1.0);
    }

    #[test]
    fn the_deviation_never_exceeds_the_residual() {
        let curve = parabola();
        let points = [[0.1, 0.3], [0.5, 0.5], [0.9, 0.2]];
        let parameters = [0.3, 0.3, 0.6];
        let residuals: Vec<f64> = points
            .iter()
            .zip(parameters)
            .map(|(point, t)| distance_between(&curve.evaluate(t).unwrap(), point))
            .collect();
        let (largest, index) =
            largest_deviation(&curve, (&points).into(), &parameters, &residuals).unwrap();
        let dense = |point: &[f64; 2]| {
            (0..=100_000)
                .map(|i| distance_between(&curve.evaluate(f64::from(i) / 1e5).unwrap(), point))
                .fold(f64::INFINITY, f64::min)
        };
        let distances = points.map(|point| dense(&point));
        let expected = distances.iter().copied().fold(0.0, f64::max);
        assert!((largest - expected).abs() < 1e-9 && distances[index] == expected);
    }
}
