//! Nearest points by brute force: dense samples, then shrinking steps around the best one.

/// The least distance of `point` from the shape that `at` evaluates over a box of parameters: the
/// best of `samples` per side, each direction then refined by steps that halve.
#[must_use]
pub fn least_distance(
    at: &dyn Fn(&[f64]) -> Vec<f64>,
    domain: &[(f64, f64)],
    samples: &[(Vec<f64>, Vec<f64>)],
    spacing: f64,
    point: &[f64],
) -> f64 {
    let distance = |on: &[f64]| -> f64 {
        on.iter().zip(point).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let mut best = f64::INFINITY;
    let mut place = Vec::new();
    for (parameters, on) in samples {
        let d = distance(on);
        if d < best {
            best = d;
            place.clone_from(parameters);
        }
    }
    let mut step: Vec<f64> = domain.iter().map(|(a, b)| spacing * (b - a)).collect();
    for _ in 0..400 {
        let mut improved = false;
        for k in 0..place.len() {
            for sign in [-1.0, 1.0] {
                let mut trial = place.clone();
                trial[k] = (trial[k] + sign * step[k]).clamp(domain[k].0, domain[k].1);
                let d = distance(&at(&trial));
                if d < best {
                    (best, place, improved) = (d, trial, true);
                }
            }
        }
        if !improved {
            step.iter_mut().for_each(|s| *s *= 0.5);
            if step.iter().all(|s| *s < 1e-13) {
                break;
            }
        }
    }
    best
}
