//! Foot points on surfaces: safeguarded Newton iteration on `(S - Q) . S_u = (S - Q) . S_v = 0`.

use crate::Error;
use crate::geometry::Surface;
use crate::points::PointsView;

use super::curve::inside;

/// A point of the surface near a given point.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFootPoint {
    /// Its parameters (u, v).
    pub parameters: [f64; 2],
    /// The point itself.
    pub point: Vec<f64>,
    /// Its distance from the given point.
    pub distance: f64,
}

const MOST_STEPS: usize = 30;
const MOST_HALVINGS: usize = 20;

/// Walks downhill from `start` to a nearest point of the surface: a local minimum of the distance,
/// never farther away than `S(start)`. In a periodic direction the walk crosses the seam.
///
/// # Errors
/// [`Error::OutsideDomain`] for `start`; [`Error::WrongCount`] for a point of another dimension.
pub fn local_surface_foot_point(
    surface: &Surface,
    point: &[f64],
    start: [f64; 2],
) -> Result<SurfaceFootPoint, Error> {
    let dimension = surface.dimension();
    if point.len() != dimension {
        return Err(Error::WrongCount {
            what: "coordinates",
            given: point.len(),
            expected: dimension,
            why: "the dimension of the surface",
        });
    }
    let (domain, periodic) = (surface.domain(), surface.is_periodic());
    let mut parameters = start;
    let mut jet = vec![0.0; 9 * dimension];
    let mut trial_point = vec![0.0; dimension];
    surface.derivatives_into(start[0], start[1], 2, &mut jet)?;
    let mut distance = distance_between(&jet[..dimension], point);
    for _ in 0..MOST_STEPS {
        let mut step = downhill(&jet, point, dimension, parameters, domain, periodic);
        let mut improved = false;
        for _ in 0..MOST_HALVINGS {
            let trial = [0, 1].map(|k| inside(parameters[k] + step[k], domain[k], periodic[k]));
            if trial == parameters {
                break;
            }
            surface.evaluate_into(trial[0], trial[1], &mut trial_point)?;
            let shorter = distance_between(&trial_point, point);
            if shorter < distance {
                (parameters, distance, improved) = (trial, shorter, true);
                break;
            }
            step = step.map(|x| 0.5 * x);
        }
        if !improved {
            break;
        }
        surface.derivatives_into(parameters[0], parameters[1], 2, &mut jet)?;
    }
    Ok(SurfaceFootPoint { parameters, point: jet[..dimension].to_vec(), distance })
}

/// Newton's step where the squared distance is convex, Gauss-Newton's elsewhere, the gradient as
/// last resort; a parameter at an end of its domain that would leave stays there.
fn downhill(
    jet: &[f64],
    point: &[f64],
    dimension: usize,
    parameters: [f64; 2],
    domain: [(f64, f64); 2],
    periodic: [bool; 2],
) -> [f64; 2] {
    // Partial derivative of order (a, b), as the surface stores them.
    let part = |a: usize, b: usize| &jet[(3 * a + b) * dimension..][..dimension];
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let gap: Vec<f64> = part(0, 0).iter().zip(point).map(|(s, q)| s - q).collect();
    let (s_u, s_v) = (part(1, 0), part(0, 1));
    let gradient = [dot(&gap, s_u), dot(&gap, s_v)];
    let metric = [dot(s_u, s_u), dot(s_u, s_v), dot(s_v, s_v)];
    let bend = [dot(&gap, part(2, 0)), dot(&gap, part(1, 1)), dot(&gap, part(0, 2))];
    let free = [0, 1].map(|k| {
        let (start, end) = domain[k];
        periodic[k]
            || !((parameters[k] <= start && gradient[k] >= 0.0)
                || (parameters[k] >= end && gradient[k] <= 0.0))
    });
    let newton = [0, 1, 2].map(|k| metric[k] + bend[k]);
    for [a, b, c] in [newton, metric] {
        let step = match free {
            [true, true] => {
                let determinant = a * c - b * b;
                if !(a > 0.0 && determinant > 1e-14 * a * c) {
                    continue;
                }
                [
                    (b * gradient[1] - c * gradient[0]) / determinant,
                    (b * gradient[0] - a * gradient[1]) / determinant,
                ]
            }
            [true, false] if a > 0.0 => [-gradient[0] / a, 0.0],
            [false, true] if c > 0.0 => [0.0, -gradient[1] / c],
            [false, false] => return [0.0, 0.0],
            _ => continue,
        };
        if step.iter().all(|x| x.is_finite()) {
            return step;
        }
    }
    let size = metric[0].max(metric[2]);
    let step = [0, 1].map(|k| if free[k] && size > 0.0 { -gradient[k] / size } else { 0.0 });
    if step.iter().all(|x| x.is_finite()) { step } else { [0.0, 0.0] }
}

fn distance_between(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The largest distance of a point of a grid from its local foot point, with the index of the point.
/// `residuals` are the distances from the surface at the parameters of rows and columns.
///
/// # Errors
/// As [`local_surface_foot_point`].
pub fn largest_surface_deviation(
    surface: &Surface,
    points: PointsView<'_>,
    parameters: [&[f64]; 2],
    residuals: &[f64],
) -> Result<(f64, usize), Error> {
    let columns = parameters[1].len();
    super::curve::largest_by(residuals, |index| {
        let start = [parameters[0][index / columns], parameters[1][index % columns]];
        Ok(local_surface_foot_point(surface, points.point(index), start)?.distance)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::knots::KnotVector;
    use crate::points::PointGrid;

    #[test]
    fn the_foot_point_agrees_with_a_fine_search() {
        // A bilinear patch, twisted.
        let knots = || KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0]).unwrap();
        let net = vec![0.0, 0.0, 0.0, 0.0, 1.0, 0.5, 1.0, 0.0, 0.5, 1.0, 1.0, -0.5];
        let surface =
            Surface::new([knots(), knots()], PointGrid::new([2, 2], 3, net).unwrap()).unwrap();
        for point in [[0.4, 0.6, 0.5], [-1.0, 0.5, 0.0], [1.6, 0.5, 0.2], [0.9, 0.1, -0.3]] {
            let foot = local_surface_foot_point(&surface, &point, [0.5, 0.5]).unwrap();
            let mut least = f64::INFINITY;
            for i in 0..=400 {
                for j in 0..=400 {
                    let s = surface.evaluate(f64::from(i) / 400.0, f64::from(j) / 400.0).unwrap();
                    least = least.min(distance_between(&s, &point));
                }
            }
            assert!(foot.distance <= least + 1e-12 && foot.distance > least - 1e-4, "{foot:?}");
        }
    }
}
