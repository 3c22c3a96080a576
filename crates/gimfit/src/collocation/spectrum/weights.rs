//! Weights from all eigenvalues, where they are not real or not known to lie in (0, 1].

use super::Eigenvalue;

/// The weight of Chen, Wang and Jin (2012), Lemma 2, with which weighted PIA converges whenever all
/// eigenvalues have positive real parts: 1 if none lies at a distance of 1 or more from 1; otherwise
/// the smallest `a / (a^2 + b^2)` of those `a + i b` that do. `None` if a real part is not positive:
/// then no weight converges.
#[must_use]
pub fn lemma2_weight(eigenvalues: &[Eigenvalue]) -> Option<f64> {
    let mut omega = 1.0_f64;
    for value in eigenvalues {
        if value.re.is_nan() || value.re <= 0.0 {
            return None;
        }
        if value.distance_from_one() >= 1.0 {
            // |1 - omega lambda| < 1 exactly for omega < 2 a / (a^2 + b^2).
            omega = omega.min(value.re / value.modulus().powi(2));
        }
    }
    Some(omega)
}

/// What a step with weight `omega` leaves in the long run: the largest `|1 - omega lambda|`.
#[must_use]
pub fn rate_with_weight(eigenvalues: &[Eigenvalue], omega: f64) -> f64 {
    eigenvalues
        .iter()
        .fold(0.0, |most: f64, value| most.max((1.0 - omega * value.re).hypot(omega * value.im)))
}

/// The real weight of the smallest [`rate_with_weight`], and that rate. For real eigenvalues it is
/// `2 / (lambda_min + lambda_max)`. `None` if a real part is not positive.
#[must_use]
pub fn best_weight(eigenvalues: &[Eigenvalue]) -> Option<(f64, f64)> {
    if eigenvalues.is_empty()
        || eigenvalues.iter().any(|value| value.re.is_nan() || value.re <= 0.0)
    {
        return None;
    }
    // A maximum of convex functions is convex; each is smallest at a / (a^2 + b^2).
    let lowest = |value: &Eigenvalue| value.re / value.modulus().powi(2);
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for value in eigenvalues {
        low = low.min(lowest(value));
        high = high.max(lowest(value));
    }
    // Bisection of the slope of the largest: exact to rounding, where a search by values would stop
    // at the root of it.
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if !(low < middle && middle < high) {
            break;
        }
        let squared =
            |value: &Eigenvalue| (1.0 - middle * value.re).powi(2) + (middle * value.im).powi(2);
        let Some(largest) = eigenvalues.iter().max_by(|a, b| squared(a).total_cmp(&squared(b)))
        else {
            break;
        };
        if middle > lowest(largest) { high = middle } else { low = middle }
    }
    let omega = 0.5 * (low + high);
    Some((omega, rate_with_weight(eigenvalues, omega)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(re: f64, im: f64) -> Eigenvalue {
        Eigenvalue { re, im }
    }

    #[test]
    fn lemma2_leaves_good_spectra_alone_and_shrinks_bad_ones_into_the_disc() {
        assert_eq!(lemma2_weight(&[value(1.0, 0.0), value(0.2, 0.3), value(0.2, -0.3)]), Some(1.0));
        let bad = [value(1.0, 0.0), value(0.1, 0.52), value(0.1, -0.52), value(0.3, 0.8)];
        let omega = lemma2_weight(&bad).expect("positive real parts");
        assert!((omega - 0.1 / (0.01 + 0.2704)).abs() < 1e-15);
        assert!(rate_with_weight(&bad, 1.0) > 1.0 && rate_with_weight(&bad, omega) < 1.0);
        assert_eq!(lemma2_weight(&[value(1.0, 0.0), value(-0.1, 0.2)]), None);
        assert_eq!(lemma2_weight(&[value(0.0, 0.0)]), None);
    }

    #[test]
    fn the_best_weight_is_the_known_one_for_real_spectra_and_no_grid_beats_it() {
        let (omega, rate) =
            best_weight(&[value(1.0, 0.0), value(0.2, 0.0), value(0.7, 0.0)]).expect("positive");
        assert!((omega - 2.0 / 1.2).abs() < 1e-14 && (rate - 0.8 / 1.2).abs() < 1e-14);
        let complex = [value(0.9, 0.1), value(0.1, 0.4), value(0.3, 0.7), value(0.05, 0.0)];
        let (omega, rate) = best_weight(&complex).expect("positive");
        assert!(rate < 1.0 && (rate_with_weight(&complex, omega) - rate).abs() < 1e-16);
        for k in 1..4000 {
            assert!(rate_with_weight(&complex, f64::from(k) * 5e-4) >= rate - 1e-15);
        }
        assert_eq!(best_weight(&[value(1.0, 0.0), value(0.0, 0.5)]), None);
    }
}
