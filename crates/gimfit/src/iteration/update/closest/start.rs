//! A start that has no straight corner where it has to keep a side.

use crate::shape::{Shape, point};

/// How far straight runs are bulged out at first, in units of their shortest leg.
const BULGE: f64 = 1e-3;
const MOST_HALVINGS: usize = 60;

/// Writes vectors that bulge the straight runs of a polygon out to the sides they have to keep, as
/// far as all other corners allow. False if doubles hold no such polygon.
pub(super) fn bulge(shape: &Shape, control: &[f64], vectors: &mut [f64]) -> bool {
    vectors.fill(0.0);
    let count = shape.len();
    let straight: Vec<bool> = (0..count).map(|k| shape.is_flat(k, control)).collect();
    // Begin behind a corner that turns, so that no run goes round the seam.
    let begin = straight.iter().position(|straight| !straight).map_or(0, |k| k + 1);
    let mut run = Vec::new();
    for k in (begin..begin + count).map(|k| k % count) {
        if straight[k] && !(run.last().is_some_and(|&last| last + 1 != k && !shape.is_closed())) {
            run.push(k);
            continue;
        }
        bulge_run(shape, control, &run, vectors);
        run.clear();
        if straight[k] {
            run.push(k);
        }
    }
    bulge_run(shape, control, &run, vectors);
    let mut share = 1.0;
    for _ in 0..MOST_HALVINGS {
        if shape.is_strict_after(control, vectors, share) {
            vectors.iter_mut().for_each(|x| *x *= share);
            return true;
        }
        share *= 0.5;
    }
    false
}

/// Bulges one run of straight corners: along the run, the slope of the offset changes at every
/// corner towards its side.
fn bulge_run(shape: &Shape, control: &[f64], run: &[usize], vectors: &mut [f64]) {
    let (Some(&first), Some(&last)) = (run.first(), run.last()) else { return };
    let mut points: Vec<usize> = run.iter().map(|&k| shape.points_of(k)[0]).collect();
    points.extend_from_slice(&shape.points_of(last)[1..]);
    let at = |k: usize| point(control, points[k]);
    let legs: Vec<[f64; 2]> =
        (1..points.len()).map(|k| [at(k)[0] - at(k - 1)[0], at(k)[1] - at(k - 1)[1]]).collect();
    let length = |leg: &[f64; 2]| leg[0].hypot(leg[1]);
    let Some(longest) = legs.iter().max_by(|a, b| length(a).total_cmp(&length(b))) else { return };
    let unit = longest.map(|x| x / length(longest));
    let along: Vec<f64> = legs.iter().map(|leg| leg[0] * unit[0] + leg[1] * unit[1]).collect();
    let (mut slope, mut offset, mut way) = (0.0, 0.0, 0.0);
    let mut offsets = vec![(0.0, 0.0)];
    for (k, &leg) in along.iter().enumerate() {
        offset += slope * leg;
        way += leg;
        offsets.push((way, offset));
        if let (Some(&corner), Some(&next)) = (run.get(k), along.get(k + 1)) {
            let forward = (leg * next).signum();
            slope += 0.5 * shape.side(corner).sign() * forward * (leg.abs() + next.abs());
        }
    }
    debug_assert_eq!(shape.points_of(first)[0], points[0]);
    let tilt = if way == 0.0 { 0.0 } else { offset / way };
    let offsets = offsets.into_iter().map(|(way, offset)| offset - tilt * way);
    let offsets: Vec<f64> = offsets.collect();
    let most = offsets.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let shortest = legs.iter().map(length).fold(f64::INFINITY, f64::min);
    if most > 0.0 {
        let scale = BULGE * shortest / most;
        for (&i, offset) in points.iter().zip(&offsets) {
            vectors[2 * i] -= scale * offset * unit[1];
            vectors[2 * i + 1] += scale * offset * unit[0];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_on_a_line_are_bulged_whatever_their_rounding() {
        // No three neighbours of the side lie exactly on a line; a corner turns at either end.
        let mut data = vec![0.59, 0.2];
        data.extend((0..9).flat_map(|i| {
            let step = f64::from(i);
            [(59.0 + step) / 100.0, (635.0 + 6.0 * step) / 10_000.0]
        }));
        data.extend([0.67, 0.2]);
        let shape = Shape::of(&data, false, 3);
        let mut vectors = vec![0.0; data.len()];
        assert!(bulge(&shape, &data, &mut vectors));
        assert!(shape.is_strict_after(&data, &vectors, 1.0));
        assert!(!shape.is_strict_after(&data, &vectors, -1.0));
    }
}
