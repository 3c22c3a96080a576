//! The polyline through the data, and how far curves stray from it.

/// Ordered points joined by straight legs.
#[derive(Debug, Clone, Copy)]
pub(in crate::fit) struct Polyline<'a> {
    /// Shape (points, dimension).
    pub(in crate::fit) data: &'a [f64],
    pub(in crate::fit) dimension: usize,
    pub(in crate::fit) closed: bool,
    /// Where the points are values over an abscissa: that of each point, on [0, 1]. Distances are then
    /// those at the same place.
    pub(in crate::fit) over: Option<&'a [f64]>,
}

impl<'a> Polyline<'a> {
    pub(in crate::fit) fn points(&self) -> usize {
        self.data.len() / self.dimension
    }

    /// Number of legs.
    pub(in crate::fit) fn legs(&self) -> usize {
        if self.closed { self.points() } else { self.points().saturating_sub(1) }
    }

    /// Point `j`, counted round a closed polyline.
    pub(in crate::fit) fn point(&self, j: usize) -> &'a [f64] {
        let j = if j < self.points() { j } else { j % self.points() };
        &self.data[j * self.dimension..][..self.dimension]
    }

    /// Directions across a curve: of the noise in a point, as many coordinates are seen.
    pub(super) fn across(&self) -> f64 {
        if self.over.is_some() { self.dimension as f64 } else { self.dimension.max(2) as f64 - 1.0 }
    }

    /// Length of leg `j`, from point `j` to the next.
    pub(super) fn leg_length(&self, j: usize) -> f64 {
        distance(self.point(j), self.point(j + 1))
    }

    /// How far it is along leg `j`: its length, or its part of the abscissa.
    pub(super) fn step(&self, j: usize) -> f64 {
        match self.over {
            None => self.leg_length(j),
            Some(over) => over.get(j + 1).copied().unwrap_or(1.0 + over[0]) - over[j],
        }
    }

    /// How far `x`, which belongs to a share of a leg, is from the polyline nearby; its place there is
    /// written into `nearest`.
    pub(super) fn strayed(
        &self,
        leg: usize,
        share: f64,
        reach: usize,
        x: &[f64],
        nearest: &mut [f64],
    ) -> f64 {
        if self.over.is_none() {
            return self.nearest(leg, reach, x, nearest);
        }
        let (a, b) = (self.point(leg), self.point(leg + 1));
        for (i, nearest) in nearest.iter_mut().enumerate() {
            *nearest = a[i] + share * (b[i] - a[i]);
        }
        distance(x, nearest)
    }

    /// Nearest point of leg `leg` and its neighbours to `x`, written into `nearest`; its distance.
    pub(super) fn nearest(&self, leg: usize, reach: usize, x: &[f64], nearest: &mut [f64]) -> f64 {
        let legs = self.legs();
        let (mut best, mut found) = (f64::INFINITY, (leg, 0.0));
        for offset in 0..=2 * reach {
            let leg = if self.closed {
                (leg + legs * reach + offset - reach) % legs
            } else {
                match (leg + offset).checked_sub(reach) {
                    Some(leg) if leg < legs => leg,
                    _ => continue,
                }
            };
            let (square, share) = self.along(leg, x);
            if square < best {
                (best, found) = (square, (leg, share));
            }
        }
        let (a, b) = (self.point(found.0), self.point(found.0 + 1));
        for (i, nearest) in nearest.iter_mut().enumerate() {
            *nearest = a[i] + found.1 * (b[i] - a[i]);
        }
        best.sqrt()
    }

    /// How far `x` is from a leg: no less than from the polyline.
    pub(super) fn distance_to_leg(&self, leg: usize, x: &[f64]) -> f64 {
        self.along(leg, x).0.sqrt()
    }

    /// Squared distance of `x` to a leg, and where on the leg the nearest point is, 0 to 1.
    fn along(&self, leg: usize, x: &[f64]) -> (f64, f64) {
        let (a, b) = (self.point(leg), self.point(leg + 1));
        match self.dimension {
            2 => along(&a[..2], &b[..2], &x[..2]),
            3 => along(&a[..3], &b[..3], &x[..3]),
            d => along(&a[..d], &b[..d], &x[..d]),
        }
    }
}

/// Squared distance of `x` to the leg from `a` to `b`, and the place of the nearest point.
#[inline(always)] // Into the arms above, where the length is known.
fn along(a: &[f64], b: &[f64], x: &[f64]) -> (f64, f64) {
    let (mut along, mut square) = (0.0, 0.0);
    for i in 0..x.len() {
        along += (x[i] - a[i]) * (b[i] - a[i]);
        square += (b[i] - a[i]) * (b[i] - a[i]);
    }
    let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
    let gap = (0..x.len()).map(|i| (x[i] - a[i] - share * (b[i] - a[i])).powi(2)).sum();
    (gap, share)
}

/// How far a local C1 interpolant of the points strays from their polyline: the cubic Hermite
/// interpolant over centripetal parameters, or over the abscissa, with modified Akima slopes (Akima 1970), which flat and
/// straight stretches keep from overshooting. What the data themselves explain is no wiggle.
pub(super) fn natural_overshoot(polyline: &Polyline<'_>) -> f64 {
    let (points, d) = (polyline.points(), polyline.dimension);
    if points < 3 {
        return 0.0;
    }
    let legs = polyline.legs();
    let along = |j: usize| match polyline.over {
        None => polyline.leg_length(j).sqrt(),
        Some(_) => polyline.step(j),
    };
    let steps: Vec<f64> = (0..legs).map(along).collect();
    let slopes = akima_slopes(polyline, &steps);
    let mut worst: f64 = 0.0;
    let (mut x, mut nearest) = (vec![0.0; d], vec![0.0; d]);
    for leg in (0..legs).filter(|&leg| steps[leg] > 0.0) {
        let (a, b) = (polyline.point(leg), polyline.point(leg + 1));
        let (from, to) = (&slopes[leg * d..][..d], &slopes[(leg + 1) % points * d..][..d]);
        // A cubic is this close to the chord that it starts and ends on.
        let off = |slope: &[f64]| {
            let away = |i: usize| steps[leg] * slope[i] - (b[i] - a[i]);
            (0..d).map(|i| away(i).powi(2)).sum::<f64>().sqrt()
        };
        if 4.0 / 27.0 * (off(from) + off(to)) <= worst {
            continue;
        }
        for share in [0.15, 0.3, 0.45, 0.6, 0.75, 0.9] {
            let (s, r): (f64, f64) = (share, 1.0 - share);
            for i in 0..d {
                x[i] = (1.0 + 2.0 * s) * r * r * a[i]
                    + s * r * r * steps[leg] * from[i]
                    + s * s * (3.0 - 2.0 * s) * b[i]
                    - s * s * r * steps[leg] * to[i];
            }
            worst = worst.max(polyline.strayed(leg, share, 2, &x, &mut nearest));
        }
    }
    worst
}

/// Slopes at the points, shape (points, dimension).
pub(in crate::fit) fn akima_slopes(polyline: &Polyline<'_>, steps: &[f64]) -> Vec<f64> {
    let (points, d, legs) = (polyline.points(), polyline.dimension, polyline.legs());
    let mut slopes = vec![0.0; points * d];
    // A leg of no length has no direction; its neighbours decide.
    let chord = |leg: usize, i: usize| {
        let h = steps[leg];
        if h > 0.0 { (polyline.point(leg + 1)[i] - polyline.point(leg)[i]) / h } else { 0.0 }
    };
    for i in 0..d {
        // Chords two before and two after each point, continued linearly past open ends.
        let at = |k: isize| -> f64 {
            let last = legs as isize - 1;
            if polyline.closed {
                return chord(k.rem_euclid(legs as isize) as usize, i);
            }
            let inner = |k: isize| chord(k.clamp(0, last) as usize, i);
            if k < 0 {
                inner(0) + k as f64 * (inner(1) - inner(0))
            } else if k > last {
                inner(last) + (k - last) as f64 * (inner(last) - inner(last - 1))
            } else {
                inner(k)
            }
        };
        for j in 0..points {
            let k = j as isize;
            let [a, b, c, e] = [at(k - 2), at(k - 1), at(k), at(k + 1)];
            let left = (e - c).abs() + 0.5 * (e + c).abs();
            let right = (b - a).abs() + 0.5 * (b + a).abs();
            let sum = left + right;
            slopes[j * d + i] = if sum > 0.0 { (left * b + right * c) / sum } else { 0.0 };
        }
    }
    slopes
}

pub(in crate::fit) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_data_have_no_natural_overshoot_and_round_ones_their_sagitta() {
        let line: Vec<f64> = (0..10).flat_map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        let polyline = Polyline { data: &line, dimension: 2, closed: false, over: None };
        assert!(natural_overshoot(&polyline) < 1e-14);
        let circle: Vec<f64> = (0..16)
            .flat_map(|i| {
                let angle = f64::from(i) * std::f64::consts::TAU / 16.0;
                [angle.cos(), angle.sin()]
            })
            .collect();
        let polyline = Polyline { data: &circle, dimension: 2, closed: true, over: None };
        let sagitta = 1.0 - (std::f64::consts::PI / 16.0).cos();
        let strayed = natural_overshoot(&polyline);
        assert!((strayed / sagitta - 1.0).abs() < 0.2, "{strayed} {sagitta}");
    }
}
