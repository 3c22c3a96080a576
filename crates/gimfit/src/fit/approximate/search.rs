//! The search for few control points: starts that grow or begin dense, breakpoints placed anew after
//! what a start has shown, then thinned out as long as all demands are met.

use super::attempt::{Attempt, Effort};
use super::breaks::{
    Density, density_of_jumps, for_each_ratio, scores, significance, span_ends, span_of,
};
use super::problem::{Measure, Problem};
use crate::Error;

/// Rounds given to a new set of breakpoints, to one placed anew, to one with a breakpoint less.
const ROUNDS_GROWING: usize = 8;
const ROUNDS_PLACED: usize = 12;
const ROUNDS_THINNED: usize = 10;
/// Times that breakpoints are moved before a number is given up.
const MOVES: usize = 4;
/// A single removal is tried at this many places.
const TRIED: usize = 12;

/// The fewest breakpoints found that meet all demands, or the best attempt where none does; the
/// search ends early once there are no more than `will_do`.
pub(super) fn fewest(
    problem: &Problem<'_>,
    will_do: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let points = problem.points();
    let total = effort.most;
    let met = |attempt: &Attempt| attempt.worst <= problem.enough;
    let mut starts = Vec::new();
    let mut closest: Option<Attempt> = None;
    let mut rough = false;
    let powers: &[f64] = if problem.start.is_some() { &[1.0] } else { &[1.0, 0.5] };
    for (number, &power) in powers.iter().enumerate() {
        effort.most = total * (number + 1) / 5;
        let grown = grow(problem, power, usize::MAX, effort)?;
        rough |= !met(&grown) || problem.control_points(grown.breaks.len()) * 5 > points * 2;
        if met(&grown) {
            let few = 2 * grown.breaks.len() < points;
            starts.push(if few { placed_anew(problem, grown, effort)? } else { grown });
        } else if closest.as_ref().is_none_or(|closest| grown.worst < closest.worst) {
            closest = Some(grown);
        }
    }
    // An interpolant is no start where noise is to be left out.
    rough &= problem.start.is_none();
    if rough && points > 2 * problem.degree + 2 && !effort.stopped {
        effort.most = total / 2;
        for &power in powers {
            let dense = grow_from(problem, dense(problem, power), usize::MAX, effort)?;
            if met(&dense) {
                starts.push(dense);
            } else if closest.as_ref().is_none_or(|closest| dense.worst < closest.worst) {
                closest = Some(dense);
            }
        }
    }
    let mut best: Option<Attempt> = None;
    starts.sort_by_key(|start| start.breaks.len());
    let mut left = starts.len();
    for start in starts {
        // Each start gets its part of the effort, so that none starves the others.
        effort.most = effort.rounds + (total.saturating_sub(effort.rounds)) / left;
        left -= 1;
        let thinned = thin(problem, start, will_do, effort)?;
        if best.as_ref().is_none_or(|best| thinned.breaks.len() < best.breaks.len()) {
            best = Some(thinned);
        }
        if best.as_ref().is_some_and(|best| best.breaks.len() <= will_do) {
            break;
        }
    }
    effort.most = total;
    best.or(closest).ok_or(Error::LeavesDoubles)
}

/// Starts with as few breakpoints as can be and adds some where the distance is too large.
pub(super) fn grow(
    problem: &Problem<'_>,
    power: f64,
    most_breaks: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let first = Density::even().place(problem.fewest_breaks(), problem.closed);
    let attempt = Attempt::new(problem, first, problem.first_parameters(power));
    grow_from(problem, attempt, most_breaks, effort)
}

/// Adds breakpoints until the demands are met, or there are as many as that.
pub(super) fn grow_from(
    problem: &Problem<'_>,
    mut attempt: Attempt,
    most_breaks: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    // Beyond, an interpolant would do, were it calm.
    let most_breaks = most_breaks.min(2 * problem.points());
    loop {
        let met = attempt.refine(problem, ROUNDS_GROWING, effort)?;
        if met || effort.is_spent() || attempt.breaks.len() >= most_breaks {
            return Ok(attempt);
        }
        let mut added = additions(&attempt, problem);
        added.truncate(most_breaks - attempt.breaks.len());
        if added.is_empty() {
            return Ok(attempt);
        }
        let mut breaks = attempt.breaks.clone();
        breaks.extend(added);
        breaks.sort_by(f64::total_cmp);
        attempt = attempt.with_fresh_breaks(breaks);
    }
}

/// A breakpoint for each span whose distance is too large, at the mean place of the squares, worst
/// spans first.
fn additions(attempt: &Attempt, problem: &Problem<'_>) -> Vec<f64> {
    let ends = span_ends(attempt, problem.closed);
    let spans = ends.len() - 1;
    let scores = scores(attempt, problem, &ends);
    let mut moments = vec![(0.0, 0.0); spans];
    for_each_ratio(attempt, |t, ratio, is_data| {
        if !is_data && ratio <= 1.0 {
            return;
        }
        let span = span_of(&ends, t, problem.closed);
        let along = if problem.closed { (t - ends[span]).rem_euclid(1.0) } else { t - ends[span] };
        moments[span].0 += ratio * ratio;
        moments[span].1 += ratio * ratio * along;
    });
    let top = scores.iter().copied().fold(0.0, f64::max);
    let limit = match problem.measure {
        Measure::Largest => (0.25 * top).max(problem.enough),
        // The mean of all may be too large where that of no span is.
        Measure::Noise if top > problem.enough => (0.25 * top).max(problem.enough),
        _ if problem.start.is_some() => 0.85 * top,
        Measure::Rms | Measure::Noise => 0.5 * top,
    };
    let mut order: Vec<usize> = (0..spans).filter(|&s| scores[s] > limit).collect();
    order.sort_by(|&a, &b| scores[b].total_cmp(&scores[a]));
    order
        .into_iter()
        .filter_map(|s| {
            let length = ends[s + 1] - ends[s];
            let along = (moments[s].1 / moments[s].0).clamp(0.15 * length, 0.85 * length);
            let place = ends[s] + along;
            let place = if problem.closed { place.rem_euclid(1.0) } else { place };
            (along.is_finite() && place > ends[s] || problem.closed).then_some(place)
        })
        .collect()
}

/// As many control points as data points, over means of neighbouring parameters: an interpolant, to
/// be thinned out.
fn dense(problem: &Problem<'_>, power: f64) -> Attempt {
    let t = problem.first_parameters(power);
    let p = problem.degree;
    let breaks = if problem.closed {
        t.clone()
    } else {
        (1..t.len() - p).map(|j| t[j..j + p].iter().sum::<f64>() / p as f64).collect()
    };
    Attempt::new(problem, breaks, t)
}

/// Places breakpoints anew after the jumps that an attempt shows, with as few as bisection finds.
fn placed_anew(
    problem: &Problem<'_>,
    attempt: Attempt,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let mut best = attempt;
    let mut low = problem.fewest_breaks();
    for _ in 0..2 {
        let density = density_of_jumps(&best, problem)?;
        let mut high = best.breaks.len();
        while high > low && !effort.is_spent() {
            let middle = (low + high) / 2;
            match meet_with(problem, &best, density.place(middle, problem.closed), effort)? {
                Some(met) => {
                    high = middle;
                    if met.breaks.len() < best.breaks.len() {
                        best = met;
                    }
                }
                None => low = middle + 1,
            }
        }
        low = (best.breaks.len() * 3 / 5).max(problem.fewest_breaks());
    }
    Ok(best)
}

/// Tries breakpoints, moving them a few times.
fn meet_with(
    problem: &Problem<'_>,
    base: &Attempt,
    breaks: Vec<f64>,
    effort: &mut Effort<'_>,
) -> Result<Option<Attempt>, Error> {
    let mut attempt = base.with_fresh_breaks(breaks);
    for _ in 0..MOVES {
        if attempt.refine(problem, ROUNDS_PLACED, effort)? {
            return Ok(Some(attempt));
        }
        if attempt.worst > 3.0 || effort.is_spent() {
            break;
        }
        attempt = attempt.moved(problem);
    }
    Ok(None)
}

/// Takes breakpoints out, many at once as long as that goes, then one by one.
pub(super) fn thin(
    problem: &Problem<'_>,
    attempt: Attempt,
    will_do: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let mut best = attempt;
    let mut many = best.breaks.len() / 3;
    while many > 1 && best.breaks.len() > will_do && !effort.is_spent() {
        let worth = significance(&best, problem)?;
        let chosen = least_apart(&worth, many, problem.closed);
        match without(problem, &best, &chosen, 2, 1.7, effort)? {
            Some(thinner) => best = thinner,
            None => many /= 2,
        }
        many = many.min(best.breaks.len() / 3);
    }
    let mut needed: Vec<f64> = Vec::new();
    let least = problem.fewest_breaks().max(will_do);
    while best.breaks.len() > least && !effort.is_spent() {
        let worth = significance(&best, problem)?;
        let mut order: Vec<usize> = (0..worth.len()).collect();
        order.sort_by(|&a, &b| worth[a].total_cmp(&worth[b]));
        let mut thinner = None;
        for &i in order.iter().take(TRIED) {
            if needed.contains(&best.breaks[i]) {
                continue;
            }
            thinner = without(problem, &best, &[i], MOVES + 1, 2.0, effort)?;
            if thinner.is_some() || effort.is_spent() {
                break;
            }
            needed.push(best.breaks[i]);
        }
        match thinner {
            Some(thinner) => {
                best = thinner;
                needed.clear();
            }
            None => break,
        }
    }
    Ok(best)
}

/// The `count` least of `worth`, no two of them neighbours, ascending.
fn least_apart(worth: &[f64], count: usize, closed: bool) -> Vec<usize> {
    let total = worth.len();
    let mut order: Vec<usize> = (0..total).collect();
    order.sort_by(|&a, &b| worth[a].total_cmp(&worth[b]));
    let mut taken = vec![false; total];
    let mut chosen = Vec::new();
    for i in order {
        let before = if i > 0 { Some(i - 1) } else { closed.then_some(total - 1) };
        let after = if i + 1 < total { Some(i + 1) } else { closed.then_some(0) };
        if [before, after].into_iter().flatten().any(|k| taken[k]) {
            continue;
        }
        taken[i] = true;
        chosen.push(i);
        if chosen.len() == count {
            break;
        }
    }
    chosen.sort_unstable();
    chosen
}

/// The attempt without some breakpoints, if the demands can still be met.
fn without(
    problem: &Problem<'_>,
    attempt: &Attempt,
    gone: &[usize],
    moves: usize,
    hopeless: f64,
    effort: &mut Effort<'_>,
) -> Result<Option<Attempt>, Error> {
    if attempt.breaks.len() < problem.fewest_breaks() + gone.len() {
        return Ok(None);
    }
    let left = |(i, &place): (usize, &f64)| gone.binary_search(&i).is_err().then_some(place);
    let breaks = attempt.breaks.iter().enumerate().filter_map(left).collect();
    let mut thinner = attempt.with_breaks(breaks);
    for _ in 0..moves {
        if thinner.refine(problem, ROUNDS_THINNED, effort)? {
            return Ok(Some(thinner));
        }
        if thinner.worst > hopeless || effort.is_spent() {
            break;
        }
        thinner = thinner.moved(problem);
    }
    Ok(None)
}

/// The closest attempt with no more than a number of breakpoints: the tolerance is narrowed down
/// between one that this many keep and one that they do not.
pub(super) fn best_with(
    problem: &mut Problem<'_>,
    breaks: usize,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    /// Tolerances tried, and how far below the last one that was kept.
    const TRIALS: usize = 8;
    const NARROWER: f64 = 0.5;
    let total = effort.most;
    let mut best = grow(problem, 1.0, breaks, effort)?;
    let mut kept = best.worst * problem.tolerance;
    let mut missed = 0.0;
    for trial in 0..TRIALS {
        let wanted = if missed > 0.0 { (kept * missed).sqrt() } else { NARROWER * kept };
        if effort.stopped || !(wanted > 0.0 && wanted < 0.97 * kept) {
            break;
        }
        problem.allow(wanted);
        effort.most = effort.rounds + (total.saturating_sub(effort.rounds)) / (TRIALS - trial + 1);
        let attempt = fewest(problem, breaks, effort)?;
        if attempt.worst <= problem.enough && attempt.breaks.len() <= breaks {
            kept = attempt.worst * wanted;
            best = attempt;
        } else {
            missed = wanted;
        }
    }
    effort.most = total;
    // What is left of the number asked for goes where the distance is largest.
    problem.allow(kept);
    problem.enough = 0.0;
    let mut polished = best.clone();
    loop {
        polished.refine(problem, 2 * ROUNDS_PLACED, effort)?;
        if polished.worst < 1.0 || polished.breaks.len() > best.breaks.len() {
            best = polished.clone();
        }
        let mut added = additions(&polished, problem);
        added.truncate(breaks.saturating_sub(polished.breaks.len()));
        if added.is_empty() || effort.is_spent() {
            return Ok(best);
        }
        let mut more = polished.breaks.clone();
        more.extend(added);
        more.sort_by(f64::total_cmp);
        polished = polished.with_breaks(more);
    }
}
