//! Bezier pieces of curves and surfaces of any degree, by knot insertion told as blossoms.

use crate::knots::KnotVector;

/// Bezier points of the piece on a span: values of the polar form at the ends of the span, by de
/// Boor's recurrence with an argument of its own in each round (Ramshaw 1989). `points` holds
/// control points of `width` numbers; all weights lie in [0, 1], so that nothing cancels.
pub(super) fn bezier_points(
    knots: &KnotVector,
    span: usize,
    points: &[f64],
    width: usize,
) -> Vec<f64> {
    let (u, p) = (knots.values(), knots.degree());
    let (start, end) = (u[span], u[span + 1]);
    let near = &points[(span - p) * width..][..(p + 1) * width];
    let mut bezier = Vec::with_capacity(near.len());
    let mut work = near.to_vec();
    for j in 0..=p {
        work.copy_from_slice(near);
        for r in 1..=p {
            let t = if r <= p - j { start } else { end };
            for i in (r..=p).rev() {
                let (low, high) = (u[span - p + i], u[span + 1 + i - r]);
                let share = ((t - low) / (high - low)).clamp(0.0, 1.0);
                let (before, here) = work.split_at_mut(i * width);
                let before = &before[(i - 1) * width..];
                here[..width]
                    .iter_mut()
                    .zip(before)
                    .for_each(|(x, y)| *x = share * *x + (1.0 - share) * y);
            }
        }
        bezier.extend_from_slice(&work[p * width..]);
    }
    bezier
}

/// Control points with their weights behind, `w P` and `w`, or as they are without weights. Only
/// ratios of weights count; the largest becomes 1.
pub(super) fn lift(points: &[f64], dimension: usize, weights: Option<&[f64]>) -> Vec<f64> {
    let Some(weights) = weights else { return points.to_vec() };
    let largest = weights.iter().copied().fold(0.0, f64::max);
    let pairs = points.chunks_exact(dimension).zip(weights);
    pairs
        .flat_map(|(point, w)| {
            let w = w / largest;
            point.iter().map(move |x| w * x).chain([w])
        })
        .collect()
}

/// The way back: points as they lie in space, and their weights.
pub(super) fn project(lifted: &[f64], dimension: usize, rational: bool) -> (Vec<f64>, Vec<f64>) {
    if !rational {
        return (lifted.to_vec(), Vec::new());
    }
    let points = lifted.chunks_exact(dimension + 1);
    let weights = points.clone().map(|point| point[dimension]).collect();
    let flat = points.flat_map(|point| point[..dimension].iter().map(|x| x / point[dimension]));
    (flat.collect(), weights)
}
