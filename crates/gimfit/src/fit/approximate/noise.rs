//! Noise: how much there is, and parameters that it does not mislead.

use super::polyline::{Polyline, distance};

/// Differences looked at, at most.
const WINDOWS: usize = 20_000;
/// Highest order of the differences.
const ORDERS: usize = 6;
/// Standard deviations that a mean may be off by chance.
pub(super) const CHANCE: f64 = 2.0;
/// Estimates this close to each other are the same.
const CLOSE: f64 = 1.05;
/// A chord is told from noise by this many times what noise makes of it.
const ABOVE: f64 = 8.0;
/// Noise moves a point along the curve by this many standard deviations at most.
const FAR: f64 = 6.0;

/// Standard deviation of the noise in a coordinate, from differences of neighbouring points that a
/// smooth curve leaves close to zero, as medians, so that features and outliers count little.
///
/// Differences of order k of independent noise have known variance (Rice 1984; Hall, Kay and
/// Titterington 1990); the curve adds to it, the less the higher the order.
/// Differences over equal steps and divided ones over chords are looked at: the latter where steps
/// are uneven, which shows as a far smaller estimate. Steps that are uneven by about as much as the
/// noise make the estimate up to twice too large.
pub(super) fn deviation(polyline: &Polyline<'_>) -> f64 {
    let [even, divided] = [false, true].map(|divided| {
        let orders = 1..=ORDERS.min(polyline.points().saturating_sub(2));
        let all: Vec<f64> = orders.map(|order| estimate(polyline, order, divided)).collect();
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        // The least of many is too small by chance; lower orders are the more certain ones.
        all.into_iter().find(|found| *found <= CLOSE * least).unwrap_or(least)
    });
    // Chords of mere noise make divided differences up to a half too small.
    let found = if 2.0 * divided < even { divided } else { even };
    if found.is_finite() { found } else { 0.0 }
}

fn estimate(polyline: &Polyline<'_>, order: usize, divided: bool) -> f64 {
    let (points, d) = (polyline.points(), polyline.dimension);
    let starts = points - order;
    let looked_at = starts.min(WINDOWS);
    let mut weights = [0.0; ORDERS + 1];
    let mut places = [0.0; ORDERS + 1];
    let mut squares: Vec<f64> = (0..looked_at)
        .map(|window| {
            let first = window * starts / looked_at;
            for k in 1..=order {
                let step = if divided { polyline.step(first + k - 1) } else { 1.0 };
                places[k] = places[k - 1] + step;
            }
            for k in 0..=order {
                let others = (0..=order).filter(|&l| l != k);
                weights[k] = 1.0 / others.map(|l| places[k] - places[l]).product::<f64>();
            }
            let norm = weights[..=order].iter().map(|w| w * w).sum::<f64>().sqrt();
            (0..d)
                .map(|i| {
                    let terms =
                        (0..=order).map(|k| weights[k] / norm * polyline.point(first + k)[i]);
                    terms.sum::<f64>().powi(2)
                })
                .sum()
        })
        // Coinciding points have no divided difference.
        .filter(|square: &f64| square.is_finite())
        .collect();
    if squares.is_empty() {
        return f64::INFINITY;
    }
    let middle = squares.len() / 2;
    let (_, median, _) = squares.select_nth_unstable_by(middle, f64::total_cmp);
    (*median / median_of_squares(d)).sqrt()
}

/// Median of the sum of the squares of `d` normal deviates.
pub(super) fn median_of_squares(d: usize) -> f64 {
    match d {
        1 => 0.454_936,
        2 => 1.386_294,
        // Wilson and Hilferty 1931.
        _ => d as f64 * (1.0 - 2.0 / (9.0 * d as f64)).powi(3),
    }
}

/// What the mean of the squares of this many points may be by chance, over what is expected, so many
/// standard deviations above it (Wilson and Hilferty 1931); `across`: squares of normal deviates each.
pub(super) fn chance(points: f64, across: f64, deviations: f64) -> f64 {
    let part = 2.0 / (9.0 * points.max(1.0) * across);
    (1.0 - part + deviations * part.sqrt()).powi(3)
}

/// Parameters on [0, 1] from the chords between means of neighbours, wide enough that chords outgrow
/// noise; and how many places noise may shift a point along the curve.
pub(super) fn smoothed_parameters(polyline: &Polyline<'_>, deviation: f64) -> (Vec<f64>, usize) {
    let (points, d) = (polyline.points(), polyline.dimension);
    let mut width = 1;
    let (mut ends, mut lengths);
    loop {
        let blocks = (points / width).max(1);
        ends = (0..=blocks).map(|block| block * points / blocks).collect::<Vec<usize>>();
        let means: Vec<f64> = ends
            .windows(2)
            .flat_map(|pair| {
                (0..d).map(|i| {
                    let block = pair[0]..pair[1];
                    let count = block.len() as f64;
                    block.map(|j| polyline.point(j)[i]).sum::<f64>() / count
                })
            })
            .collect();
        let next = |block: usize| {
            let next = (block + 1) % blocks * d;
            distance(&means[block * d..][..d], &means[next..][..d])
        };
        let joints = if polyline.closed { blocks } else { blocks - 1 };
        lengths = (0..joints).map(next).collect::<Vec<f64>>();
        let mean = lengths.iter().sum::<f64>() / joints.max(1) as f64;
        let noise = deviation * (2.0 * d as f64 / width as f64).sqrt();
        if mean >= ABOVE * noise || blocks < 16 {
            break;
        }
        width *= 2;
    }
    // The speed over a joint of two blocks holds from middle to middle.
    let blocks = ends.len() - 1;
    let size = |block: usize| (ends[block + 1] - ends[block]) as f64;
    let speeds: Vec<f64> = (0..lengths.len())
        .map(|joint| lengths[joint] / (0.5 * (size(joint) + size((joint + 1) % blocks))))
        .collect();
    let speed = |joint: usize| speeds.get(joint).or(speeds.last()).copied().unwrap_or(1.0);
    let mut total = 0.0;
    let mut parameters = Vec::with_capacity(points);
    for block in 0..blocks {
        let before = match block.checked_sub(1) {
            Some(joint) => speed(joint),
            None if polyline.closed => speed(blocks - 1),
            None => speed(0),
        };
        let middle = 0.5 * size(block);
        for j in 0..ends[block + 1] - ends[block] {
            parameters.push(total);
            total += if (j as f64) + 0.5 < middle { before } else { speed(block) };
        }
    }
    let legs = if polyline.closed { total } else { parameters[points - 1] };
    if legs > 0.0 {
        parameters.iter_mut().for_each(|t| *t /= legs);
    }
    let step = legs / polyline.legs() as f64;
    let shift = (FAR * deviation / step).ceil();
    let most = (points / 20).max(1);
    (parameters, if shift.is_finite() { (shift as usize).clamp(1, most) } else { 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use gimfit_testkit::generate::Random;

    #[test]
    fn the_noise_of_a_helix_is_found_whatever_the_steps() {
        let mut random = Random::new(1);
        for deviation in [1e-2, 1e-3, 1e-4] {
            for count in [400, 20_000] {
                for uneven in [0.0, 0.9] {
                    let mut data = Vec::new();
                    for j in 0..count {
                        let t = (f64::from(j) + uneven * f64::from(j % 2)) / f64::from(count);
                        let point = [(6.0 * t).cos(), (6.0 * t).sin(), t];
                        data.extend(point.map(|x| x + deviation * random.normal()));
                    }
                    let polyline =
                        Polyline { data: &data, dimension: 3, closed: false, over: None };
                    let found = super::deviation(&polyline);
                    let range = if uneven > 0.0 { 0.5..2.0 } else { 0.9..1.1 };
                    assert!(
                        range.contains(&(found / deviation)),
                        "{deviation} {count} {uneven}: {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn parameters_of_noisy_points_are_those_of_the_curve() {
        let mut random = Random::new(2);
        let count = 20_000;
        // Twice as fast in the second half.
        let place = |j: i32| {
            let t = f64::from(j) / f64::from(count - 1);
            if t < 0.5 { t } else { 2.0 * t - 0.5 }
        };
        let data: Vec<f64> =
            (0..count).flat_map(|j| [place(j), 0.0].map(|x| x + 1e-3 * random.normal())).collect();
        let polyline = Polyline { data: &data, dimension: 2, closed: false, over: None };
        let (parameters, shift) = smoothed_parameters(&polyline, 1e-3);
        let off = (0..count).map(|j| (parameters[j as usize] - place(j) / 1.5).abs());
        assert!(off.fold(0.0, f64::max) < 5e-3);
        assert!((50..200).contains(&shift), "{shift}");
        assert!(parameters.windows(2).all(|pair| pair[0] <= pair[1]));
    }
}
