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
    for (knots, t) in surface.knots().iter().zip(start) {
        knots.span(t)?;
    }
    let mut walk = SurfaceWalk::new(dimension);
    let (reached, distance) = walk.descend(surface, point, start, [false, false])?;
    let (domain, periodic) = (surface.domain(), surface.is_periodic());
    let parameters = [0, 1].map(|k| inside(reached[k], domain[k], periodic[k]));
    Ok(SurfaceFootPoint { parameters, point: walk.jet[..dimension].to_vec(), distance })
}

const MOST_STEPS: usize = 30;
const MOST_HALVINGS: usize = 20;

/// The way to a foot point, with the memory it needs.
#[derive(Debug, Clone)]
pub(super) struct SurfaceWalk {
    /// Partial derivatives where the walk stands, and where it may go.
    jet: Vec<f64>,
    trial: Vec<f64>,
}

impl SurfaceWalk {
    pub(super) fn new(dimension: usize) -> Self {
        Self { jet: vec![0.0; 9 * dimension], trial: vec![0.0; 9 * dimension] }
    }

    /// As [`local_surface_foot_point`], without moving the parameters that are `held`; returns the
    /// parameters and the distance. In a periodic direction parameters count laps: they go on past
    /// the seam.
    pub(super) fn descend(
        &mut self,
        surface: &Surface,
        point: &[f64],
        start: [f64; 2],
        held: [bool; 2],
    ) -> Result<([f64; 2], f64), Error> {
        let (domain, periodic) = (surface.domain(), surface.is_periodic());
        let reduced = |t: [f64; 2]| [0, 1].map(|k| inside(t[k], domain[k], periodic[k]));
        let size = point.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut parameters = start;
        let [u, v] = reduced(parameters);
        surface.derivatives_into(u, v, 2, &mut self.jet)?;
        let mut here = Slope::of(&self.jet, point);
        for _ in 0..MOST_STEPS {
            let free = [0, 1].map(|k| {
                let (from, to) = domain[k];
                !held[k]
                    && (periodic[k]
                        || !((parameters[k] <= from && here.gradient[k] >= 0.0)
                            || (parameters[k] >= to && here.gradient[k] <= 0.0)))
            });
            let mut step = here.step(free);
            let gain = here.gradient[0] * step[0] + here.gradient[1] * step[1];
            // Rounding hides a gain this small; a last step brings the parameters to their place.
            let hidden = 4.0 * f64::EPSILON * here.distance * (here.distance + size);
            let last = gain.abs() <= hidden;
            let mut improved = false;
            for _ in 0..if last { 1 } else { MOST_HALVINGS } {
                let trial = [0, 1].map(|k| {
                    let beyond = parameters[k] + step[k];
                    if periodic[k] { beyond } else { inside(beyond, domain[k], false) }
                });
                if trial == parameters {
                    break;
                }
                let [u, v] = reduced(trial);
                surface.derivatives_into(u, v, 2, &mut self.trial)?;
                let there = Slope::of(&self.trial, point);
                improved = if last {
                    there.distance <= here.distance + 4.0 * f64::EPSILON * (here.distance + size)
                        && there.steepness(free) < here.steepness(free)
                } else {
                    there.distance < here.distance
                };
                if improved {
                    let distance = there.distance.min(here.distance);
                    (parameters, here) = (trial, Slope { distance, ..there });
                    std::mem::swap(&mut self.jet, &mut self.trial);
                    break;
                }
                step = step.map(|x| 0.5 * x);
            }
            if last || !improved {
                break;
            }
        }
        Ok((parameters, here.distance))
    }
}

/// How the distance changes on the surface.
#[derive(Debug, Clone, Copy)]
struct Slope {
    distance: f64,
    /// `(S - Q) . S_u` and `(S - Q) . S_v`.
    gradient: [f64; 2],
    /// `S_u . S_u`, `S_u . S_v`, `S_v . S_v`.
    metric: [f64; 3],
    /// `(S - Q) . S_uu`, `(S - Q) . S_uv`, `(S - Q) . S_vv`.
    bend: [f64; 3],
}

impl Slope {
    fn of(jet: &[f64], point: &[f64]) -> Self {
        let dimension = point.len();
        // Partial derivative of order (a, b), as the surface stores them.
        let part = |a: usize, b: usize, i: usize| jet[(3 * a + b) * dimension + i];
        let mut slope =
            Self { distance: 0.0, gradient: [0.0; 2], metric: [0.0; 3], bend: [0.0; 3] };
        let mut square = 0.0;
        for (i, q) in point.iter().enumerate() {
            let gap = part(0, 0, i) - q;
            let (s_u, s_v) = (part(1, 0, i), part(0, 1, i));
            square += gap * gap;
            slope.gradient[0] += gap * s_u;
            slope.gradient[1] += gap * s_v;
            slope.metric[0] += s_u * s_u;
            slope.metric[1] += s_u * s_v;
            slope.metric[2] += s_v * s_v;
            slope.bend[0] += gap * part(2, 0, i);
            slope.bend[1] += gap * part(1, 1, i);
            slope.bend[2] += gap * part(0, 2, i);
        }
        slope.distance = f64::sqrt(square);
        slope
    }

    /// Size of the gradient in the free directions, measured along the surface.
    fn steepness(&self, free: [bool; 2]) -> f64 {
        let part = |k: usize, metric: f64| {
            if free[k] && metric > 0.0 { self.gradient[k] * self.gradient[k] / metric } else { 0.0 }
        };
        part(0, self.metric[0]) + part(1, self.metric[2])
    }

    /// Newton's step where the squared distance is convex, Gauss-Newton's elsewhere, the gradient as
    /// last resort; only free parameters move.
    fn step(&self, free: [bool; 2]) -> [f64; 2] {
        let (gradient, metric) = (self.gradient, self.metric);
        let newton = [0, 1, 2].map(|k| metric[k] + self.bend[k]);
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
}

#[cfg(test)]
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

/// As [`largest_surface_deviation`], where every point has parameters (u, v) of its own, row by row,
/// and `residuals` are the distances from the surface there.
///
/// # Errors
/// As [`local_surface_foot_point`].
pub fn largest_surface_deviation_from(
    surface: &Surface,
    points: PointsView<'_>,
    parameters: &[[f64; 2]],
    residuals: &[f64],
) -> Result<(f64, usize), Error> {
    super::curve::largest_by(residuals, |index| {
        Ok(local_surface_foot_point(surface, points.point(index), parameters[index])?.distance)
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
