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

const MOST_STEPS: usize = 30;
const MOST_HALVINGS: usize = 20;

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
    let domain = curve.domain();
    let mut parameter = start;
    let mut jet = vec![0.0; 3 * dimension];
    let mut trial_point = vec![0.0; dimension];
    curve.derivatives_into(parameter, 2, &mut jet)?;
    let mut distance = distance_between(&jet[..dimension], point);
    for _ in 0..MOST_STEPS {
        let Some(step) = newton_step(&jet, point, dimension) else { break };
        let mut step = step;
        let mut improved = false;
        for _ in 0..MOST_HALVINGS {
            let trial = inside(parameter + step, domain, curve.is_periodic());
            if trial == parameter {
                break;
            }
            curve.evaluate_into(trial, &mut trial_point)?;
            let shorter = distance_between(&trial_point, point);
            if shorter < distance {
                (parameter, distance, improved) = (trial, shorter, true);
                break;
            }
            step *= 0.5;
        }
        if !improved {
            break;
        }
        curve.derivatives_into(parameter, 2, &mut jet)?;
    }
    Ok(FootPoint { parameter, point: jet[..dimension].to_vec(), distance })
}

/// Step that reduces the distance: Newton's where the distance is convex, otherwise Gauss-Newton's.
fn newton_step(jet: &[f64], point: &[f64], dimension: usize) -> Option<f64> {
    let (mut slope, mut speed, mut bend) = (0.0, 0.0, 0.0);
    for i in 0..dimension {
        let gap = jet[i] - point[i];
        slope += gap * jet[dimension + i];
        speed += jet[dimension + i] * jet[dimension + i];
        bend += gap * jet[2 * dimension + i];
    }
    let curvature = if speed + bend > 0.0 { speed + bend } else { speed };
    let step = -slope / curvature;
    (step.is_finite() && step != 0.0).then_some(step)
}

/// Brings a parameter into its domain: round a periodic one, to the end of an open one.
pub(super) fn inside(t: f64, (start, end): (f64, f64), periodic: bool) -> f64 {
    if periodic && !(start..=end).contains(&t) {
        return (start + (t - start).rem_euclid(end - start)).clamp(start, end);
    }
    t.clamp(start, end)
}

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
