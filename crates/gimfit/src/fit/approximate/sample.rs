//! Many points: the search looks at a few of them, all are measured, and those that were missed join
//! the few.

use super::attempt::{Attempt, Effort};
use super::problem::{Measure, Problem};
use super::search;
use crate::Error;
use crate::projection::MovingCurve;

/// Points up to which all are looked at.
pub(super) const ALL: usize = 4096;
/// A round over this many points counts as one.
pub(super) const ROUND: usize = 16 * ALL;
/// Points looked at at first where there are more.
pub(super) const FEW: usize = 2048;
/// Most times that missed points join.
const PASSES: usize = 12;
/// Corrections of parameters after which all legs are looked at.
const SETTLING: usize = 6;

/// The best attempt found, with parameters of all points. `breaks`: how many are asked for, where
/// the distance is not.
pub(super) fn search(
    whole: &mut Problem<'_>,
    breaks: Option<usize>,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    if whole.points() <= ALL {
        return run(whole, breaks, effort).map(in_order);
    }
    let mut sample = first_sample(whole);
    let total = effort.most;
    let mut found: Option<Attempt> = None;
    let mut best: Option<Attempt> = None;
    for _ in 0..PASSES {
        let data = gather(whole, &sample);
        let mut problem = whole.sampled(&data, &sample);
        let attempt = match found.take() {
            None => {
                // The rest is for what the few do not show.
                effort.most = effort.rounds + (total.saturating_sub(effort.rounds)) * 3 / 4;
                let attempt = run(&mut problem, breaks, effort)?;
                effort.most = total;
                attempt
            }
            Some(mut found) => {
                found.watch(&problem);
                let most = breaks.unwrap_or(usize::MAX);
                let grown = search::grow_from(&problem, found, most, effort)?;
                if breaks.is_none() { search::thin(&problem, grown, 0, effort)? } else { grown }
            }
        };
        let all = spread(whole, &sample, &attempt)?;
        if whole.measure != Measure::Largest {
            return mean_of_more(whole, all, breaks, effort).map(in_order);
        }
        let enough = all.worst <= 1.0;
        if breaks.is_none() && !enough && is_rough(whole, &sample, &all) {
            best = Some(all);
            break;
        }
        let better = best.as_ref().is_none_or(|best| all.worst < best.worst);
        let joined = join(whole, &mut sample, &all);
        let next = all.at(&sample);
        if better {
            best = Some(all);
        }
        if enough || !joined || effort.is_spent() || (breaks.is_some() && !better) {
            break;
        }
        found = Some(next);
    }
    let best = best.ok_or(Error::LeavesDoubles)?;
    if breaks.is_some() || effort.stopped {
        return Ok(in_order(best));
    }
    // Legs between points that were not picked have not been watched.
    let mut settled = best.clone();
    if best.worst <= 1.0 && whole.long_legs().next().is_some() {
        settled.settle(whole, SETTLING)?;
    }
    if settled.worst <= 1.0 {
        return Ok(in_order(best));
    }
    let grown = grown_on_all(whole, settled, effort)?;
    // What keeps the distance counts more than what is calm.
    let kept = best.worst <= 1.0 && grown.worst > 1.0;
    Ok(in_order(if kept { best } else { grown }))
}

/// Parameters in order again, where noise let them pass each other.
fn in_order(mut attempt: Attempt) -> Attempt {
    attempt.parameters.sort_by(f64::total_cmp);
    attempt
}

/// Grown on more of the points until the mean is as demanded, then on all.
fn mean_of_more(
    whole: &Problem<'_>,
    mut all: Attempt,
    breaks: Option<usize>,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let most = breaks.unwrap_or(usize::MAX);
    let count = whole.points();
    if count > 2 * ROUND {
        let sample: Vec<usize> = (0..ROUND).map(|i| i * (count - 1) / (ROUND - 1)).collect();
        let data = gather(whole, &sample);
        let mut more = all.at(&sample);
        let problem = whole.sampled(&data, &sample);
        more.watch(&problem);
        all = spread(whole, &sample, &search::grow_from(&problem, more, most, effort)?)?;
    }
    search::grow_from(whole, all, most, effort)
}

/// Grown until the demands are met, at all points.
pub(super) fn grown(
    whole: &Problem<'_>,
    most_breaks: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    if whole.points() <= ALL {
        return search::grow(whole, 1.0, most_breaks, effort);
    }
    let sample = first_sample(whole);
    let data = gather(whole, &sample);
    let attempt = search::grow(&whole.sampled(&data, &sample), 1.0, most_breaks, effort)?;
    spread(whole, &sample, &attempt)
}

fn run(
    problem: &mut Problem<'_>,
    breaks: Option<usize>,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    match breaks {
        Some(breaks) => search::best_with(problem, breaks, effort),
        None => {
            let found = search::fewest(problem, 0, effort)?;
            let near = found.distances()[0] <= 1.0 && found.worst <= problem.nearly_calm();
            // To leave out noise counts more than to keep a mean of it.
            if near || found.worst <= problem.enough || problem.measure != Measure::Largest {
                Ok(found)
            } else {
                less_calm(problem, found, effort)
            }
        }
    }
}

/// Where no curve was found that meets all demands: one that keeps the distance, with as few control
/// points, and strays no farther between the points than it must.
fn less_calm(
    problem: &mut Problem<'_>,
    found: Attempt,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    /// How much farther it may stray.
    const FARTHER: [f64; 4] = [1.3, 2.5, 8.0, f64::INFINITY];
    let (allowance, total) = (problem.allowance, effort.most);
    let mut best = found;
    for factor in FARTHER {
        if effort.stopped {
            break;
        }
        problem.allowance = factor * allowance;
        effort.most = effort.rounds + total / 2;
        let attempt = search::fewest(problem, 0, effort)?;
        if attempt.worst <= problem.enough {
            // What is not calm should at least not cost more than an interpolant.
            let costly = problem.control_points(attempt.breaks.len()) > problem.points();
            best = attempt;
            if !costly {
                break;
            }
        }
    }
    effort.most = total;
    problem.allowance = allowance;
    Ok(best)
}

/// Every so many points, and the ends of long legs.
fn first_sample(whole: &Problem<'_>) -> Vec<usize> {
    let count = whole.points();
    let mut sample: Vec<usize> = (0..FEW).map(|i| i * (count - 1) / (FEW - 1)).collect();
    let mut long: Vec<usize> = whole.long_legs().collect();
    if long.len() > FEW {
        // The longest ones first; the others are met where the curve strays.
        let length = |leg: usize| whole.leg_length(leg);
        long.sort_by(|&a, &b| length(b).total_cmp(&length(a)));
        long.truncate(FEW);
    }
    sample.extend(long.into_iter().flat_map(|leg| [leg, (leg + 1) % count]));
    sample.sort_unstable();
    sample.dedup();
    sample
}

/// Coordinates of some of the points.
pub(super) fn gather(whole: &Problem<'_>, sample: &[usize]) -> Vec<f64> {
    sample.iter().flat_map(|&j| whole.point(j)).copied().collect()
}

/// An attempt at the few, measured at all points.
fn spread(whole: &Problem<'_>, sample: &[usize], attempt: &Attempt) -> Result<Attempt, Error> {
    let (count, polyline) = (whole.points(), whole.polyline());
    let mut places = attempt.parameters.clone();
    places.sort_by(f64::total_cmp);
    let step = |j: usize| match &whole.start {
        // Chords of noise are no measure.
        Some(start) if j + 1 < count => start[j + 1] - start[j],
        Some(start) => start[0] + 1.0 - start[j],
        None => polyline.step(j),
    };
    let laps = if whole.closed { 1.0 } else { 0.0 };
    let mut all = Attempt::new(whole, attempt.breaks.clone(), vec![0.0; count]);
    all.control.clone_from(&attempt.control);
    sample.iter().zip(&attempt.weights).for_each(|(&j, weight)| all.weights[j] = *weight);
    let knots = all.knots(whole)?;
    let mut curve = MovingCurve::new(&knots, &all.control, whole.dimension);
    let gaps = if whole.closed { sample.len() } else { sample.len() - 1 };
    for gap in 0..gaps {
        // Between two of the few, in proportion to chords.
        let next = (gap + 1) % sample.len();
        let lap = if next == 0 { laps } else { 0.0 };
        let (from, to) = (places[gap], places[next] + lap);
        let start = sample[gap];
        let end = if next == 0 { sample[0] + count } else { sample[next] };
        let total: f64 = (start..end).map(|leg| step(leg % count)).sum();
        let mut along = 0.0;
        for j in start..end {
            let place = j % count;
            let share = if total > 0.0 { along / total } else { 0.0 };
            let t = (to - from).mul_add(share, from);
            all.parameters[place] = if j >= count { t - lap } else { t };
            along += step(place);
        }
    }
    if !whole.closed {
        all.parameters[count - 1] = places[sample.len() - 1];
    }
    if let Some(over) = &whole.over {
        all.parameters.clone_from(over);
    }
    // Places are decided by the few; distances by foot points in their neighbourhood.
    let reach = |gap: usize| {
        let before = places[gap.saturating_sub(1)];
        let after = places[(gap + 2).min(sample.len() - 1)];
        (before, after)
    };
    let mut gap = 0;
    for j in 0..count {
        while gap + 1 < sample.len() && sample[gap + 1] <= j {
            gap += 1;
        }
        let here = all.parameters[j];
        let (low, high) = reach(gap);
        let room = match whole.over {
            Some(_) => (here, here),
            None => (low.min(here), high.max(here)),
        };
        all.ratios[j] = curve.foot(whole.point(j), here, room).1 / whole.tolerance;
    }
    if let Some(robust) = whole.robust {
        all.distrust(whole, robust);
    }
    all.judge(whole);
    Ok(all)
}

/// Whether a few points cannot stand for all: many of the gaps between them hold one that was missed.
fn is_rough(whole: &Problem<'_>, sample: &[usize], all: &Attempt) -> bool {
    const MANY: f64 = 0.25;
    missed(whole, sample, all).count() as f64 > MANY * sample.len() as f64
}

/// Grown and thinned out on all points.
fn grown_on_all(
    whole: &Problem<'_>,
    all: Attempt,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    /// Rounds over all points, whatever the few have used up.
    const ROUNDS: usize = 200;
    effort.most = effort.rounds + ROUNDS * whole.points().div_ceil(ROUND);
    let grown = search::grow_from(whole, all, usize::MAX, effort)?;
    if grown.worst > 1.0 { Ok(grown) } else { search::thin(whole, grown, 0, effort) }
}

/// The worst of the missed points of each gap between two of the few.
fn missed(whole: &Problem<'_>, sample: &[usize], all: &Attempt) -> impl Iterator<Item = usize> {
    let ends = sample[1..].iter().copied().chain([whole.points()]);
    sample.iter().zip(ends).filter_map(|(&start, end)| {
        let worst = (start + 1..end).max_by(|&a, &b| all.ratios[a].total_cmp(&all.ratios[b]));
        worst.filter(|&j| all.ratios[j] > 1.0)
    })
}

/// Adds the worst of the missed points between two of the few; false if none was missed.
fn join(whole: &Problem<'_>, sample: &mut Vec<usize>, all: &Attempt) -> bool {
    let missed: Vec<usize> = missed(whole, sample, all).collect();
    sample.extend_from_slice(&missed);
    sample.sort_unstable();
    !missed.is_empty()
}
