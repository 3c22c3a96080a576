//! Light and colour of a facet.

/// Toward the light, which comes from the upper left before the picture.
const LIGHT: [f64; 3] = [-0.48, 0.62, 0.62];

/// Part of the light that reaches each facet from everywhere.
const AMBIENT: f64 = 0.30;

/// Steps between the darkest and the lightest colour.
const STEPS: usize = 56;

/// Colours of the two sides of a surface from shadow to full light.
const FRONT: [[f64; 3]; 3] = [[38.0, 74.0, 107.0], [112.0, 164.0, 203.0], [226.0, 240.0, 249.0]];
const BACK: [[f64; 3]; 3] = [[98.0, 90.0, 80.0], [196.0, 186.0, 168.0], [245.0, 241.0, 232.0]];

/// Colour of the front where a legend shows it.
pub(super) const SAMPLE: &str = "#8ab5d6";

/// A shade of the colours of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shade {
    step: usize,
    front: bool,
}

impl Shade {
    /// The shade of a facet with this normal; the one that turns toward the
    /// viewer shows its front, or its back if `front` is the other side.
    pub(super) fn of(normal: [f64; 3], front_is_toward: bool) -> Self {
        let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
        let toward = normal[2] >= 0.0;
        let sign = if toward { 1.0 } else { -1.0 };
        let cosine = if length > 0.0 && length.is_finite() {
            sign * (0..3).map(|k| normal[k] * LIGHT[k]).sum::<f64>() / length
        } else {
            LIGHT[2]
        };
        let light = AMBIENT + (1.0 - AMBIENT) * cosine.max(0.0);
        let step = (light * STEPS as f64).round() as usize;
        Self { step: step.min(STEPS), front: toward == front_is_toward }
    }

    /// The colour as it is written in SVG.
    pub(super) fn colour(self) -> String {
        let stops = if self.front { FRONT } else { BACK };
        let t = 2.0 * self.step as f64 / STEPS as f64;
        let (from, to, part) =
            if t < 1.0 { (stops[0], stops[1], t) } else { (stops[1], stops[2], t - 1.0) };
        let channel = |k: usize| (from[k] + (to[k] - from[k]) * part).round() as u8;
        format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
    }
}

/// A vector across the facet with the corners `a`, `b`, `c`, `d`, as long as
/// twice its area.
pub(super) fn normal(a: [f64; 3], b: [f64; 3], c: [f64; 3], d: [f64; 3]) -> [f64; 3] {
    let p = [0, 1, 2].map(|k| c[k] - a[k]);
    let q = [0, 1, 2].map(|k| d[k] - b[k]);
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_toward_the_light_are_lighter_on_both_sides() {
        for front in [true, false] {
            let lit = Shade::of(LIGHT, front);
            let turned = Shade::of([0.62, -0.48, 0.3], front);
            assert!(lit.step > turned.step && lit.front == turned.front);
            let reverse = LIGHT.map(|k| -k);
            assert_eq!(Shade::of(reverse, front).step, lit.step);
            assert_ne!(Shade::of(reverse, front).front, lit.front);
        }
    }

    #[test]
    fn facets_without_a_normal_have_a_colour() {
        for bad in [0.0, f64::NAN, f64::INFINITY, 1.0e200] {
            assert!(Shade::of([bad; 3], true).colour().starts_with('#'));
        }
    }
}
