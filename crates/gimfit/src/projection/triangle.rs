//! Foot points on triangular patches.

use super::curve::largest_by;
use crate::Error;
use crate::geometry::TriangularPatch;
use crate::points::PointsView;

const MOST_STEPS: usize = 50;
const MOST_HALVINGS: usize = 25;

/// Walks downhill from (u, v) = `start` to a nearest point of the patch and returns its distance
/// from `point`: Gauss-Newton steps, halved until they gain, and brought back into the triangle.
/// Never farther than where it starts.
///
/// # Errors
/// [`Error::OutsideTriangle`] for `start`; [`Error::WrongCount`] for a point of another dimension.
pub fn local_triangle_distance(
    patch: &TriangularPatch,
    point: &[f64],
    start: [f64; 2],
) -> Result<f64, Error> {
    let dimension = patch.dimension();
    if point.len() != dimension {
        return Err(Error::WrongCount {
            what: "coordinates",
            given: point.len(),
            expected: dimension,
            why: "the dimension of the patch",
        });
    }
    let mut at = start;
    let mut jet = vec![0.0; 3 * dimension];
    let mut trial_jet = jet.clone();
    patch.derivatives_into(at[0], at[1], &mut jet)?;
    let mut distance = distance_between(&jet[..dimension], point);
    for _ in 0..MOST_STEPS {
        let (newton, downhill) = steps(&jet, point, dimension);
        let before = distance;
        for mut step in [newton, downhill] {
            for _ in 0..MOST_HALVINGS {
                let trial = inside([at[0] + step[0], at[1] + step[1]]);
                if trial == at || !trial.iter().all(|x| x.is_finite()) {
                    break;
                }
                patch.derivatives_into(trial[0], trial[1], &mut trial_jet)?;
                let shorter = distance_between(&trial_jet[..dimension], point);
                if shorter < distance {
                    (at, distance) = (trial, shorter);
                    jet.copy_from_slice(&trial_jet);
                    break;
                }
                step = step.map(|x| 0.5 * x);
            }
            if distance < before {
                break;
            }
        }
        if distance >= before * (1.0 - 1e-12) {
            break;
        }
    }
    Ok(distance)
}

/// The step of Gauss-Newton, and one along the gradient.
fn steps(jet: &[f64], point: &[f64], dimension: usize) -> ([f64; 2], [f64; 2]) {
    let (s, rest) = jet.split_at(dimension);
    let (s_u, s_v) = rest.split_at(dimension);
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let gap: Vec<f64> = s.iter().zip(point).map(|(s, q)| s - q).collect();
    let gradient = [dot(&gap, s_u), dot(&gap, s_v)];
    let (a, b, c) = (dot(s_u, s_u), dot(s_u, s_v), dot(s_v, s_v));
    let size = a.max(c);
    let downhill = gradient.map(|g| if size > 0.0 { -g / size } else { 0.0 });
    let determinant = a * c - b * b;
    if determinant > 1e-14 * a * c {
        let newton = [
            (b * gradient[1] - c * gradient[0]) / determinant,
            (b * gradient[0] - a * gradient[1]) / determinant,
        ];
        return (newton, downhill);
    }
    (downhill, downhill)
}

/// The nearest point of the triangle u, v >= 0, u + v <= 1, in the plane of (u, v).
fn inside([u, v]: [f64; 2]) -> [f64; 2] {
    if u + v > 1.0 {
        // On the slanted edge, or in a corner of it.
        let along = (0.5 * (1.0 + u - v)).clamp(0.0, 1.0);
        return [along, 1.0 - along];
    }
    [u.clamp(0.0, 1.0), v.clamp(0.0, 1.0)]
}

fn distance_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The largest distance of a data point from its local foot point, with the index of the point.
/// `residuals` are the distances at `parameters` (u, v).
///
/// # Errors
/// As [`local_triangle_distance`].
pub fn largest_triangle_deviation(
    patch: &TriangularPatch,
    points: PointsView<'_>,
    parameters: &[[f64; 2]],
    residuals: &[f64],
) -> Result<(f64, usize), Error> {
    largest_by(residuals, |j| local_triangle_distance(patch, points.point(j), parameters[j]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::Points;

    #[test]
    fn the_distance_agrees_with_a_fine_search() {
        // A quadratic patch, bent.
        let net = [
            [0.0, 0.0, 0.0],
            [0.5, 0.0, 0.4],
            [0.0, 0.5, 0.3],
            [1.0, 0.0, 0.0],
            [0.5, 0.5, 0.9],
            [0.0, 1.0, -0.2],
        ];
        let patch = TriangularPatch::new(2, Points::from(&net[..])).unwrap();
        for point in [[0.3, 0.3, 0.6], [-1.0, 0.2, 0.0], [0.9, 0.9, 0.1], [0.4, -0.5, 0.3]] {
            let found = local_triangle_distance(&patch, &point, [0.3, 0.4]).unwrap();
            let mut least = f64::INFINITY;
            for i in 0..=100_u32 {
                for j in 0..=100 - i {
                    let s = patch.evaluate(f64::from(i) / 100.0, f64::from(j) / 100.0).unwrap();
                    least = least.min(distance_between(&s, &point));
                }
            }
            assert!(found <= least + 1e-9 && found > least - 1e-3, "{point:?}: {found} {least}");
        }
    }
}
