//! The colours of the error map.
//!
//! From dark violet over blue and green to yellow, with the lightness growing
//! by the same step from colour to colour: the order of errors is seen in grey
//! and by readers who cannot tell red from green.

/// Colours at equal distances, from the smallest to the largest error.
const STOPS: [[u8; 3]; 17] = [
    [55, 0, 91],
    [56, 19, 112],
    [52, 41, 128],
    [43, 59, 142],
    [26, 78, 152],
    [1, 96, 155],
    [3, 112, 154],
    [0, 128, 156],
    [2, 143, 159],
    [4, 159, 160],
    [8, 175, 158],
    [21, 191, 150],
    [82, 203, 139],
    [125, 214, 125],
    [165, 223, 109],
    [206, 229, 92],
    [246, 234, 77],
];

/// Different colours in use.
pub(super) const STEPS: usize = 48;

/// Of errors that are 0.
pub(super) const ZERO: &str = "#e3e6ea";

/// Number of the colour at `t` between 0 and 1.
pub(super) fn step(t: f64) -> usize {
    let last = (STEPS - 1) as f64;
    ((t * last).round().max(0.0).min(last)) as usize
}

/// The colour of a step.
pub(super) fn colour(step: usize) -> String {
    let t = step.min(STEPS - 1) as f64 / (STEPS - 1) as f64 * (STOPS.len() - 1) as f64;
    let index = (t as usize).min(STOPS.len() - 2);
    let part = t - index as f64;
    let (from, to) = (STOPS[index], STOPS[index + 1]);
    let channel = |k: usize| {
        (f64::from(from[k]) + (f64::from(to[k]) - f64::from(from[k])) * part).round() as u8
    };
    format!("#{:02x}{:02x}{:02x}", channel(0), channel(1), channel(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lightness(colour: &str) -> f64 {
        let value = |k: usize| {
            let byte = u8::from_str_radix(&colour[2 * k + 1..2 * k + 3], 16).unwrap();
            let c = f64::from(byte) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        let (r, g, b) = (value(0), value(1), value(2));
        let l = (0.412_221_5 * r + 0.536_332_5 * g + 0.051_446 * b).cbrt();
        let m = (0.211_903_5 * r + 0.680_699_6 * g + 0.107_397 * b).cbrt();
        let s = (0.088_302_5 * r + 0.281_718_8 * g + 0.629_978_7 * b).cbrt();
        0.210_454_3 * l + 0.793_617_8 * m - 0.004_072 * s
    }

    #[test]
    fn lightness_grows_evenly() {
        let all: Vec<f64> = (0..STEPS).map(|k| lightness(&colour(k))).collect();
        let mean = (all[STEPS - 1] - all[0]) / (STEPS - 1) as f64;
        assert!(mean > 0.012);
        for pair in all.windows(2) {
            let grown = pair[1] - pair[0];
            assert!(grown > 0.4 * mean && grown < 1.6 * mean, "{grown} {mean}");
        }
    }

    #[test]
    fn any_number_has_a_colour() {
        for (t, expected) in [(0.0, 0), (1.0, STEPS - 1), (f64::NAN, 0), (-1.0e300, 0)] {
            assert_eq!(step(t), expected);
        }
        assert_eq!(step(f64::INFINITY), STEPS - 1);
        assert_eq!(colour(usize::MAX), "#f6ea4d");
        assert!((0..STEPS).all(|k| colour(k) != ZERO));
    }
}
