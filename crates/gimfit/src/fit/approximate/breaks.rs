//! Where breakpoints should stand: dense where the highest derivative jumps most (de Boor 1974,
//! Burchard 1974), or where the distance is largest.

use super::attempt::Attempt;
use super::problem::{Measure, Problem};
use crate::Error;
use crate::knots::KnotVector;

/// A density over the domain, as its cumulated share at breakpoints.
#[derive(Debug)]
pub(in crate::fit) struct Density {
    places: Vec<f64>,
    shares: Vec<f64>,
}

/// Part of the density that is the same everywhere.
const EVEN_SHARE: f64 = 0.05;
/// How strongly distances move breakpoints.
const DAMPING: f64 = 0.6;
/// Distances below this part of the largest one count as this much.
const LEAST_RATIO: f64 = 0.1;

impl Density {
    fn from_spans(breaks: &[f64], amounts: &[f64]) -> Self {
        let total: f64 = amounts.iter().sum();
        let mut shares = vec![0.0];
        let mut sum = 0.0;
        for amount in amounts {
            sum += amount;
            shares.push(if total > 0.0 { sum / total } else { shares.len() as f64 });
        }
        let last = shares[amounts.len()];
        shares.iter_mut().for_each(|share| *share /= last);
        Self { places: breaks.to_vec(), shares }
    }

    /// Even density.
    pub(in crate::fit) fn even() -> Self {
        Self { places: vec![0.0, 1.0], shares: vec![0.0, 1.0] }
    }

    /// The same with a part of it spread evenly.
    pub(in crate::fit) fn evened(&self, part: f64) -> Self {
        let first = self.places[0];
        let even = |place: f64| place - first;
        let shares = self.places.iter().zip(&self.shares);
        let shares = shares.map(|(&place, share)| (1.0 - part) * share + part * even(place));
        Self { places: self.places.clone(), shares: shares.collect() }
    }

    /// `count` breakpoints with equal shares between them.
    pub(in crate::fit) fn place(&self, count: usize, closed: bool) -> Vec<f64> {
        let parts = if closed { count } else { count + 1 };
        let first = usize::from(!closed);
        let mut places: Vec<f64> = (first..first + count)
            .map(|i| {
                let wanted = i as f64 / parts as f64;
                let after = self
                    .shares
                    .partition_point(|&share| share <= wanted)
                    .clamp(1, self.shares.len() - 1);
                let (a, b) = (self.shares[after - 1], self.shares[after]);
                let part = if b > a { (wanted - a) / (b - a) } else { 0.0 };
                let (from, to) = (self.places[after - 1], self.places[after]);
                from + (to - from) * part
            })
            .collect();
        if closed {
            places.iter_mut().for_each(|place| *place = place.rem_euclid(1.0));
            places.sort_by(f64::total_cmp);
        }
        places
    }
}

/// The ends of all spans: one more than there are spans.
pub(super) fn span_ends(attempt: &Attempt, closed: bool) -> Vec<f64> {
    ends_of(&attempt.breaks, closed)
}

/// As [`span_ends`], of breakpoints alone.
pub(in crate::fit) fn ends_of(breaks: &[f64], closed: bool) -> Vec<f64> {
    if closed {
        let mut ends = breaks.to_vec();
        ends.extend(breaks.first().map(|first| first + 1.0));
        return ends;
    }
    let mut ends = vec![0.0];
    ends.extend_from_slice(breaks);
    ends.push(1.0);
    ends
}

/// Inner knots of an open curve on [0, 1], or the knots in one period of a closed one, with all
/// that belongs to them.
pub(in crate::fit) fn knots_of(
    breaks: &[f64],
    degree: usize,
    closed: bool,
) -> Result<KnotVector, Error> {
    if closed {
        let count = breaks.len() as isize;
        let around = |i: isize| breaks[i.rem_euclid(count) as usize] + i.div_euclid(count) as f64;
        let reach = degree as isize;
        return KnotVector::periodic(degree, (-reach..=count + reach).map(around).collect());
    }
    let mut knots = vec![0.0; degree + 1];
    knots.extend_from_slice(breaks);
    knots.extend(std::iter::repeat_n(1.0, degree + 1));
    KnotVector::open(degree, knots)
}

/// The span, of those with these ends, that holds a parameter.
pub(in crate::fit) fn span_of(ends: &[f64], t: f64, closed: bool) -> usize {
    let t = if closed { ends[0] + (t - ends[0]).rem_euclid(1.0) } else { t };
    ends.partition_point(|&end| end <= t).clamp(1, ends.len() - 1) - 1
}

/// Density after the jumps of the highest derivative that an attempt shows: spans then get equal
/// parts of the integral of the `(p + 1)`-th root of the next derivative.
pub(super) fn density_of_jumps(attempt: &Attempt, problem: &Problem<'_>) -> Result<Density, Error> {
    let (jumps, ends) = jumps(attempt, problem)?;
    Ok(density_after(&jumps, &ends, problem.degree, problem.closed))
}

/// As [`density_of_jumps`], from the jumps at the start of each span and the ends of the spans.
pub(in crate::fit) fn density_after(
    jumps: &[f64],
    ends: &[f64],
    degree: usize,
    closed: bool,
) -> Density {
    let spans = ends.len() - 1;
    let root = 1.0 / (degree as f64 + 1.0);
    let length = |s: usize| ends[s + 1] - ends[s];
    // The jump between spans `s - 1` and `s`, spread over their halves.
    let strength = |before: usize, after: usize, jump: f64| {
        (jump / (0.5 * (length(before) + length(after)))).powf(root)
    };
    let mut amounts: Vec<f64> = (0..spans)
        .map(|s| {
            let mut sum = 0.0;
            let mut count = 0.0;
            if s > 0 || closed {
                let before = (s + spans - 1) % spans;
                sum += strength(before, s, jumps[s]);
                count += 1.0;
            }
            if s + 1 < spans || closed {
                let after = (s + 1) % spans;
                sum += strength(s, after, jumps[after]);
                count += 1.0;
            }
            let amount = if count > 0.0 { length(s) * sum / count } else { 1.0 };
            if amount.is_finite() { amount } else { 0.0 }
        })
        .collect();
    let mean = amounts.iter().sum::<f64>() / spans as f64;
    let floor = if mean > 0.0 { EVEN_SHARE * mean } else { 1.0 };
    amounts.iter_mut().for_each(|amount| *amount += floor);
    Density::from_spans(ends, &amounts)
}

/// Breakpoints moved so that spans with large distances shrink and calm ones grow.
pub(super) fn relaxed(attempt: &Attempt, problem: &Problem<'_>) -> Vec<f64> {
    let ends = span_ends(attempt, problem.closed);
    let mut scores = scores(attempt, problem, &ends);
    let top = scores.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    scores.iter_mut().for_each(|score| *score /= top);
    relaxed_after(&scores, &ends, problem.degree, problem.closed)
}

/// As [`relaxed`], from the largest distance of each span, over the largest of all.
pub(in crate::fit) fn relaxed_after(
    largest: &[f64],
    ends: &[f64],
    degree: usize,
    closed: bool,
) -> Vec<f64> {
    let power = DAMPING / (degree as f64 + 1.0);
    let amounts: Vec<f64> =
        largest.iter().map(|share| share.clamp(LEAST_RATIO, 1.0).powf(power)).collect();
    let count = if closed { ends.len() - 1 } else { ends.len() - 2 };
    Density::from_spans(ends, &amounts).place(count, closed)
}

/// How far each span is off: the largest ratio, or where means are judged their root, less what may
/// be chance.
pub(super) fn scores(attempt: &Attempt, problem: &Problem<'_>, ends: &[f64]) -> Vec<f64> {
    let spans = ends.len() - 1;
    let (mut largest, mut sums) = (vec![0.0_f64; spans], vec![(0.0, 0.0); spans]);
    for_each_ratio(attempt, |t, ratio, is_data| {
        let span = span_of(ends, t, problem.closed);
        if is_data && problem.measure != Measure::Largest {
            sums[span].0 += 1.0;
            sums[span].1 += ratio * ratio;
        } else if is_data || ratio > 1.0 {
            largest[span] = largest[span].max(ratio);
        }
    });
    let score = |(largest, (count, square)): (f64, (f64, f64))| {
        let count = f64::max(count, 1.0);
        let chance = match problem.measure {
            Measure::Noise => problem.chance(count, 4.0),
            Measure::Largest | Measure::Rms => 1.0,
        };
        largest.max((square / count / chance).sqrt())
    };
    largest.into_iter().zip(sums).map(score).collect()
}

/// Visits parameter and ratio of all data points and guards; the flag tells data points.
pub(super) fn for_each_ratio(attempt: &Attempt, mut visit: impl FnMut(f64, f64, bool)) {
    for (&t, &ratio) in attempt.parameters.iter().zip(&attempt.ratios) {
        visit(t, ratio, true);
    }
    for (&guard, &ratio) in attempt.guards.iter().zip(&attempt.guard_ratios) {
        visit(attempt.guard_parameter(guard), ratio, false);
    }
}

/// Parameters strictly between two, where a curve is looked at: several between neighbouring
/// breakpoints, so that no short span can hide a spike. `breaks` ascend; those of a closed curve
/// repeat with period 1.
pub(super) fn looks(from: f64, to: f64, breaks: &[f64], closed: bool) -> Vec<f64> {
    /// Looks between two data points, and between two breakpoints, at least.
    const IN_ALL: usize = 9;
    const EACH: usize = 4;
    let mut ends = vec![from];
    let laps: &[f64] = if closed { &[-1.0, 0.0, 1.0] } else { &[0.0] };
    for lap in laps {
        let first = breaks.partition_point(|&place| place + lap <= from);
        ends.extend(breaks[first..].iter().map(|place| place + lap).take_while(|&t| t < to));
    }
    ends.sort_by(f64::total_cmp);
    ends.push(to);
    let each = IN_ALL.div_ceil(ends.len() - 1).max(EACH);
    let mut places: Vec<f64> = ends
        .windows(2)
        .flat_map(|pair| {
            let (a, b) = (pair[0], pair[1]);
            (1..=each).map(move |i| a + (b - a) * (i as f64 / each as f64))
        })
        .collect();
    places.retain(|&t| from < t && t < to);
    places.dedup();
    places
}

/// What each breakpoint is worth: roughly how far the curve would move without it.
pub(super) fn significance(attempt: &Attempt, problem: &Problem<'_>) -> Result<Vec<f64>, Error> {
    let (jumps, ends) = jumps(attempt, problem)?;
    Ok(significance_after(&jumps, &ends, problem.degree, problem.closed))
}

/// As [`significance`], from the jumps at the start of each span and the ends of the spans.
pub(in crate::fit) fn significance_after(
    jumps: &[f64],
    ends: &[f64],
    degree: usize,
    closed: bool,
) -> Vec<f64> {
    let spans = ends.len() - 1;
    let worth = |after: usize| {
        let before = (after + spans - 1) % spans;
        let (a, b) = (ends[before + 1] - ends[before], ends[after + 1] - ends[after]);
        jumps[after] * (0.5 * (a + b)).powi(degree as i32)
    };
    (usize::from(!closed)..spans).map(worth).collect()
}

/// Norm of the jump of the `p`-th derivative at the start of each span, and the ends of the spans.
fn jumps(attempt: &Attempt, problem: &Problem<'_>) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let knots = attempt.knots(problem)?;
    let ends = span_ends(attempt, problem.closed);
    Ok((jumps_of(&knots, &attempt.control, problem.dimension, ends.len() - 1), ends))
}

/// Norm of the jump of the highest derivative at the start of each span, of which there are `spans`,
/// from the control points that move; that at the start of an open curve has no meaning.
pub(in crate::fit) fn jumps_of(
    knots: &KnotVector,
    control: &[f64],
    dimension: usize,
    spans: usize,
) -> Vec<f64> {
    let (p, d) = (knots.degree(), dimension);
    let values = knots.values();
    let stored = knots.control_points();
    let mut derivative: Vec<f64> = control.iter().copied().cycle().take(stored * d).collect();
    for order in 1..=p {
        let count = stored - order;
        for i in 0..count {
            let gap = values[i + p + 1] - values[i + order];
            let factor = if gap > 0.0 { (p + 1 - order) as f64 / gap } else { 0.0 };
            for x in 0..d {
                derivative[i * d + x] =
                    factor * (derivative[(i + 1) * d + x] - derivative[i * d + x]);
            }
        }
    }
    (0..spans)
        .map(|s| {
            let before = (s + spans - 1) % spans;
            let (a, b) = (&derivative[before * d..][..d], &derivative[s * d..][..d]);
            super::polyline::distance(a, b)
        })
        .collect()
}
