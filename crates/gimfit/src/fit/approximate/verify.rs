//! The figures of an approximation, measured on the finished curve.

use super::breaks::looks;
use super::polyline::{Polyline, distance};
use crate::Error;
use crate::geometry::Curve;
use crate::projection::local_foot_point;
use crate::report::ApproximationReport;

/// What was measured.
pub(super) struct Verified {
    /// Parameters of the foot points, in order.
    pub(super) parameters: Vec<f64>,
    /// Shape (points, dimension).
    pub(super) difference_vectors: Vec<f64>,
    pub(super) spacing_ratio: f64,
    pub(super) account: ApproximationReport,
}

/// Points named among the worst.
const WORST: usize = 5;
/// Legs on either side that a place of the curve may belong to, and the most.
const NEAR: usize = 3;
const FAR: usize = 1000;
/// A leg is looked at more closely from this part of the largest distance so far on, at so many places
/// on either side.
const NEARLY: f64 = 0.9;
const CLOSELY: usize = 8;
/// Not where the way between two points is short beside the distance: nothing hides there.
const HIDDEN: f64 = 0.1;

/// Projects all data points from their parameters, or where these stay looks at the points there, and
/// samples the curve between them. Beyond `limit` foot points are looked for farther off, too.
pub(super) fn verify(
    curve: &Curve,
    polyline: &Polyline<'_>,
    starts: &[f64],
    limit: f64,
) -> Result<Verified, Error> {
    let (count, dimension) = (polyline.points(), polyline.dimension);
    let mut parameters = Vec::with_capacity(count);
    let mut difference_vectors = Vec::with_capacity(count * dimension);
    let mut distances = Vec::with_capacity(count);
    let mut here = vec![0.0; dimension];
    for (j, &start) in starts.iter().enumerate() {
        let point = polyline.point(j);
        if polyline.over.is_some() {
            curve.evaluate_into(start, &mut here)?;
            parameters.push(start);
            distances.push(distance(point, &here));
        } else {
            let mut foot = local_foot_point(curve, point, start)?;
            if foot.distance > limit {
                for start in beside(starts, j) {
                    let other = local_foot_point(curve, point, start)?;
                    if other.distance < foot.distance {
                        foot = other;
                    }
                }
            }
            here.copy_from_slice(&foot.point);
            parameters.push(foot.parameter);
            distances.push(foot.distance);
        }
        difference_vectors.extend(point.iter().zip(&here).map(|(q, c)| q - c));
    }
    // The parameters of the search cover the whole curve; foot points may leave its ends out.
    let overshoot = overshoot(curve, polyline, starts)?;
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| distances[b].total_cmp(&distances[a]));
    order.truncate(WORST);
    let max_distance = distances[order[0]];
    let square: f64 = distances.iter().map(|x| x * x).sum();
    let account = ApproximationReport {
        met: false,
        max_distance,
        rms_distance: (square / count as f64).sqrt(),
        mean_distance: distances.iter().sum::<f64>() / count as f64,
        worst: order,
        overshoot,
        calm_limit: 0.0,
        noise: None,
        outliers: Vec::new(),
        corners: Vec::new(),
        pieces: 0,
        rounds: 0,
    };
    let steps = || parameters.windows(2).map(|t| (t[1] - t[0]).abs()).filter(|&step| step > 0.0);
    let spacing_ratio = steps().fold(0.0, f64::max) / steps().fold(f64::INFINITY, f64::min);
    Ok(Verified {
        spacing_ratio: if spacing_ratio.is_finite() { spacing_ratio } else { 1.0 },
        parameters,
        difference_vectors,
        account,
    })
}

/// Parameters of points before and after point `j`, more and more of them away.
fn beside(starts: &[f64], j: usize) -> impl Iterator<Item = f64> {
    const FARTHEST: u32 = 8;
    (0..FARTHEST).flat_map(move |k| {
        let before = j.checked_sub(1 << k).map(|i| starts[i]);
        [before, starts.get(j + (1 << k)).copied()].into_iter().flatten()
    })
}

/// How far the curve strays from the data polyline, sampled between parameters in order.
fn overshoot(curve: &Curve, polyline: &Polyline<'_>, parameters: &[f64]) -> Result<f64, Error> {
    let &Polyline { dimension, closed, over, .. } = polyline;
    let (start, end) = curve.domain();
    let inner = curve.knots().values();
    let mut worst: f64 = 0.0;
    let (mut point, mut nearest) = (vec![0.0; dimension], vec![0.0; dimension]);
    let speeds = speeds(curve);
    let degree = curve.degree();
    for leg in 0..polyline.legs() {
        let from = parameters[leg];
        let mut to = parameters[(leg + 1) % parameters.len()];
        if closed && to < from {
            to += end - start;
        }
        let mut way = f64::INFINITY;
        if to <= end {
            let (first, last) = (curve.knots().span(from)?, curve.knots().span(to)?);
            let fastest = speeds[first - degree..last].iter().copied().fold(0.0, f64::max);
            way = fastest * (to - from);
        }
        if over.is_none() && way < worst {
            // No look where the curve cannot get that far.
            curve.evaluate_into(from, &mut point)?;
            if polyline.nearest(leg, NEAR, &point, &mut nearest) + way <= worst {
                continue;
            }
        }
        let mut look = |t: f64, worst: f64| -> Result<f64, Error> {
            let share = if to > from { (t - from) / (to - from) } else { 0.0 };
            let t = if t > end { t - (end - start) } else { t };
            curve.evaluate_into(t.clamp(start, end), &mut point)?;
            // Legs farther along are asked only where the answer counts.
            let mut reach = NEAR;
            let mut off = polyline.strayed(leg, share, reach, &point, &mut nearest);
            while off > worst && over.is_none() && reach < FAR.min(polyline.legs()) {
                reach *= 4;
                off = polyline.strayed(leg, share, reach, &point, &mut nearest);
            }
            Ok(off)
        };
        let mut farthest = (0.0, from);
        for t in looks(from, to, inner, false).into_iter().chain([from, to]) {
            let off = look(t, worst)?;
            if off > farthest.0 {
                farthest = (off, t);
            }
        }
        if farthest.0 > NEARLY * worst && way > HIDDEN * farthest.0 {
            // Looked at more closely where that may count.
            let step = (to - from) / CLOSELY as f64;
            for k in 1..2 * CLOSELY {
                let t = farthest.1 + step * (k as f64 / CLOSELY as f64 - 1.0);
                worst = worst.max(look(t.clamp(from, to), worst)?);
            }
        }
        worst = worst.max(farthest.0);
    }
    Ok(worst)
}

/// Bounds of the speed: the norms of the control points of the first derivative; those of the span
/// that begins at knot `k` are `k - p .. k`.
fn speeds(curve: &Curve) -> Vec<f64> {
    let (degree, dimension) = (curve.degree(), curve.dimension());
    let knots = curve.knots().values();
    let control = curve.control_points().coordinates();
    let legs = control.chunks_exact(dimension).zip(control[dimension..].chunks_exact(dimension));
    legs.enumerate()
        .map(|(i, (a, b))| {
            let gap = knots[i + 1 + degree] - knots[i + 1];
            if gap > 0.0 { degree as f64 / gap * distance(a, b) } else { 0.0 }
        })
        .collect()
}
