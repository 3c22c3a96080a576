//! The direction from which a spatial curve is seen.

use super::rows::Rows;
use super::scale::{Interval, drawable};

/// Height of the viewer above the horizon, in degrees.
const ELEVATION: f64 = 24.0;

/// Directions tried, in degrees from the first axis; none looks along an
/// axis, which would hide it.
const AZIMUTHS: [f64; 12] =
    [-60.0, -50.0, -40.0, -70.0, -30.0, -20.0, 30.0, 40.0, 50.0, 60.0, 20.0, 70.0];

/// Points looked at to find the view; more would not change it.
const MOST_POINTS: usize = 20_000;

/// An orthographic view with the third axis upward.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Centre of the space shown, and the length drawn as one unit along each
    /// axis, such as half the longest side.
    centre: [f64; 3],
    unit: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    /// Toward the viewer.
    toward: [f64; 3],
}

impl View {
    /// The view among a few that spreads `points` most, for the space `shown`.
    pub(crate) fn of(points: Rows<'_>, shown: &[Interval; 3]) -> Self {
        let mut best = Self::from_azimuth(AZIMUTHS[0], shown);
        let mut most = best.spread(points);
        for azimuth in AZIMUTHS.into_iter().skip(1) {
            let view = Self::from_azimuth(azimuth, shown);
            let spread = view.spread(points);
            // A small gain is not worth leaving the more familiar view.
            if spread > 1.1 * most {
                (best, most) = (view, spread);
            }
        }
        best
    }

    fn from_azimuth(degrees: f64, shown: &[Interval; 3]) -> Self {
        let longest = shown.iter().map(Interval::span).fold(0.0, f64::max);
        let unit = if longest > 0.0 { 0.5 * longest } else { 1.0 };
        Self::from_angles(degrees, ELEVATION, shown.map(|values| values.centre()), [unit; 3])
    }

    /// The view from the azimuth and the elevation in degrees at `centre`,
    /// with the lengths `unit` along the axes drawn as one unit each.
    pub(crate) fn from_angles(
        azimuth: f64,
        elevation: f64,
        centre: [f64; 3],
        unit: [f64; 3],
    ) -> Self {
        let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
        let (sin_e, cos_e) = elevation.to_radians().sin_cos();
        Self {
            centre,
            unit,
            right: [-sin_a, cos_a, 0.0],
            up: [-sin_e * cos_a, -sin_e * sin_a, cos_e],
            toward: [cos_e * cos_a, cos_e * sin_a, sin_e],
        }
    }

    /// Place of `point` across and upward, about within -2 and 2.
    pub(crate) fn project(&self, point: &[f64]) -> (f64, f64) {
        let mut unit = [0.0; 3];
        for k in 0..3 {
            let value = point.get(k).copied().and_then(drawable);
            unit[k] = value.map_or(f64::NAN, |v| (v - self.centre[k]) / self.unit[k]);
        }
        (dot(&self.right, &unit), dot(&self.up, &unit))
    }

    /// `point` as its place across, upward and toward the viewer.
    pub(crate) fn turned(&self, point: &[f64; 3]) -> [f64; 3] {
        let (right, up) = self.project(point);
        let mut toward = 0.0;
        for k in 0..3 {
            let value = drawable(point[k]).unwrap_or(f64::NAN);
            toward += self.toward[k] * ((value - self.centre[k]) / self.unit[k]);
        }
        [right, up, toward]
    }

    /// Whether the viewer is on the side of growing values of coordinate `k`.
    pub(crate) fn sees_high_side(&self, k: usize) -> bool {
        self.toward[k] > 0.0
    }

    /// Area over which the projected points spread: the determinant of their
    /// covariance.
    fn spread(&self, points: Rows<'_>) -> f64 {
        let stride = points.len().div_ceil(MOST_POINTS).max(1);
        let (mut n, mut su, mut sv) = (0.0, 0.0, 0.0);
        let (mut suu, mut suv, mut svv) = (0.0, 0.0, 0.0);
        for row in points.iter().step_by(stride) {
            let (u, v) = self.project(row);
            if u.is_nan() || v.is_nan() {
                continue;
            }
            n += 1.0;
            su += u;
            sv += v;
            suu += u * u;
            suv += u * v;
            svv += v * v;
        }
        if n < 1.0 {
            return 0.0;
        }
        let (mu, mv) = (su / n, sv / n);
        let (uu, uv, vv) = (suu / n - mu * mu, suv / n - mu * mv, svv / n - mv * mv);
        (uu * vv - uv * uv).max(0.0)
    }
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Interval = Interval { low: -1.0, high: 1.0 };

    #[test]
    fn up_stays_up_and_lengths_shrink() {
        let view = View::of(Rows::new(&[], 3), &[UNIT; 3]);
        let (u, v) = view.project(&[0.0, 0.0, 1.0]);
        assert!(u.abs() < 1e-12 && v > 0.8);
        for axis in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
            let (u, v) = view.project(&axis);
            let length = u.hypot(v);
            assert!(length > 0.3 && length < 1.0);
        }
    }

    #[test]
    fn an_upright_circle_is_not_seen_from_its_edge() {
        for turn in 0..12 {
            let angle = f64::from(turn) * 0.5;
            let circle: Vec<f64> = (0..100)
                .flat_map(|i| {
                    let t = f64::from(i) * 0.0628;
                    [t.cos() * angle.cos(), t.cos() * angle.sin(), t.sin()]
                })
                .collect();
            let view = View::of(Rows::new(&circle, 3), &[UNIT; 3]);
            assert!(view.spread(Rows::new(&circle, 3)) > 0.05, "{turn}");
        }
    }
}
