//! The search for few control points: breakpoints are added where the error of their direction is
//! large, placed anew after what that has shown, traded between the directions, and thinned out as
//! long as all demands are met.

use super::attempt::{Attempt, Effort};
use super::layout::{additions, densities, significance};
use super::problem::Problem;
use crate::Error;
use crate::fit::approximate::breaks::Density;

/// Rounds given to a new set of breakpoints, to one placed anew, to one with a breakpoint less.
const ROUNDS_GROWING: usize = 6;
const ROUNDS_PLACED: usize = 14;
const ROUNDS_THINNED: usize = 12;
/// A ratio from which more rounds are worth it.
const CLOSE: f64 = 1.5;
/// Times that breakpoints are moved before a number is given up.
const MOVES: usize = 2;
/// A single removal is tried at this many places of each direction.
const TRIED: usize = 3;

fn met(attempt: &Attempt, problem: &Problem<'_>) -> bool {
    attempt.worst <= problem.enough
}

/// The fewest control points found that meet all demands, or the best attempt where none does.
pub(super) fn fewest(problem: &Problem<'_>, effort: &mut Effort<'_>) -> Result<Attempt, Error> {
    let total = effort.most;
    effort.most = total / 3;
    let mut start = grow(problem, effort)?;
    effort.most = total;
    if !met(&start, problem) && !effort.stopped {
        let mut dense =
            start.with_fresh_breaks(problem, [problem.dense_breaks(0), problem.dense_breaks(1)]);
        dense.refine(problem, ROUNDS_PLACED, effort)?;
        if dense.worst < start.worst {
            start = dense;
        }
        if !met(&start, problem) {
            return Ok(start);
        }
    }
    let style = Style::best(problem, &start, effort)?;
    let mut best = scaled_down(problem, start, style, effort)?;
    best = traded(problem, best, style, effort)?;
    best = thinned(problem, best, effort)?;
    Ok(best)
}

/// How breakpoints are placed: the part of each direction's density that is spread evenly. Rough data
/// show jumps everywhere, and none of them means much.
#[derive(Debug, Clone, Copy)]
struct Style([f64; 2]);

impl Style {
    /// Rounds by which styles are compared, and the share of the control points of a start that
    /// they are compared with.
    const ROUNDS: usize = 3;
    const SHARE: f64 = 0.8;

    /// The style that comes closest with fewer control points than a start has.
    fn best(
        problem: &Problem<'_>,
        start: &Attempt,
        effort: &mut Effort<'_>,
    ) -> Result<Self, Error> {
        let density = densities(start, problem)?;
        let lines = start.net_shape(problem).map(|n| (n as f64 * Self::SHARE).round() as usize);
        let breaks = [0, 1].map(|k| problem.breaks_for(k, lines[k]));
        let mut closest = |style: Self| -> Result<f64, Error> {
            let places = style.place(problem, &density, breaks);
            let mut attempt = start.with_fresh_breaks(problem, places);
            attempt.refine_closely(problem, Self::ROUNDS, effort)?;
            Ok(attempt.worst)
        };
        let mut best = Self([0.5; 2]);
        let mut least = closest(best)?;
        for k in 0..2 {
            for part in [0.0, 1.0] {
                let mut style = best;
                style.0[k] = part;
                let worst = closest(style)?;
                if worst < least {
                    (best, least) = (style, worst);
                }
            }
        }
        Ok(best)
    }

    fn place(
        self,
        problem: &Problem<'_>,
        density: &[Density; 2],
        breaks: [usize; 2],
    ) -> [Vec<f64>; 2] {
        [0, 1].map(|k| density[k].evened(self.0[k]).place(breaks[k], problem.closed()[k]))
    }
}

/// Starts with as few breakpoints as can be and adds some where the distance is too large.
fn grow(problem: &Problem<'_>, effort: &mut Effort<'_>) -> Result<Attempt, Error> {
    let first =
        [0, 1].map(|k| Density::even().place(problem.fewest_breaks(k), problem.closed()[k]));
    let mut attempt = Attempt::new(problem, first);
    loop {
        if attempt.refine(problem, ROUNDS_GROWING, effort)? || effort.is_spent() {
            return Ok(attempt);
        }
        if attempt.worst < CLOSE && attempt.refine(problem, ROUNDS_PLACED, effort)? {
            return Ok(attempt);
        }
        let added = additions(&attempt, problem)?;
        if added.iter().all(Vec::is_empty) {
            return Ok(attempt);
        }
        let breaks = [0, 1].map(|k| {
            let mut breaks = attempt.breaks[k].clone();
            breaks.extend(&added[k]);
            breaks.sort_by(f64::total_cmp);
            breaks.dedup();
            breaks
        });
        attempt = attempt.with_fresh_breaks(problem, breaks);
    }
}

/// Tries a number of breakpoints in both directions, placed after densities and moved a few times.
fn meet_with(
    problem: &Problem<'_>,
    base: &Attempt,
    breaks: [Vec<f64>; 2],
    effort: &mut Effort<'_>,
) -> Result<Option<Attempt>, Error> {
    tried(problem, base.with_fresh_breaks(problem, breaks), ROUNDS_PLACED, effort)
}

/// Refines an attempt, moving its breakpoints a few times, until all demands are met.
fn tried(
    problem: &Problem<'_>,
    mut attempt: Attempt,
    rounds: usize,
    effort: &mut Effort<'_>,
) -> Result<Option<Attempt>, Error> {
    let mut least = f64::INFINITY;
    for _ in 0..=MOVES {
        if attempt.refine(problem, rounds, effort)? {
            return Ok(Some(attempt));
        }
        if attempt.worst > 1.3 || attempt.worst > 0.98 * least || effort.is_spent() {
            break;
        }
        least = attempt.worst;
        attempt = attempt.moved(problem);
    }
    Ok(None)
}

/// As few breakpoints, in both directions in proportion, as bisection finds.
fn scaled_down(
    problem: &Problem<'_>,
    start: Attempt,
    style: Style,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let mut best = start;
    for least in [0.5, 0.85] {
        let density = densities(&best, problem)?;
        let counts = best.net_shape(problem);
        let (mut low, mut high) = (least, 1.0);
        let mut tried: Option<[usize; 2]> = None;
        while high / low > 1.02 && !effort.is_spent() {
            let share = f64::sqrt(low * high);
            let lines = counts.map(|count| (count as f64 * share).round() as usize);
            let breaks = [0, 1].map(|k| problem.breaks_for(k, lines[k]));
            let size = problem.control_lines(0, breaks[0]) * problem.control_lines(1, breaks[1]);
            if tried == Some(breaks) || size >= best.size(problem) {
                high = share;
                continue;
            }
            tried = Some(breaks);
            let places = style.place(problem, &density, breaks);
            match meet_with(problem, &best, places, effort)? {
                Some(met) => {
                    high = share;
                    best = met;
                }
                None => low = share,
            }
        }
    }
    Ok(best)
}

/// Control points traded between the directions: fewer in one, or a few more in one and more fewer
/// in the other.
fn traded(
    problem: &Problem<'_>,
    start: Attempt,
    style: Style,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    /// Parts of a direction that are traded at once.
    const PARTS: [f64; 4] = [0.15, 0.08, 0.04, 0.0];
    let mut best = start;
    let mut refused: Vec<[usize; 2]> = Vec::new();
    for part in PARTS {
        'again: loop {
            let density = densities(&best, problem)?;
            let counts = best.net_shape(problem);
            let step = counts.map(|count| ((count as f64 * part).round() as usize).max(1));
            let down = |k: usize, times: usize| counts[k].checked_sub(times * step[k]);
            let up = |k: usize| Some(counts[k] + step[k]);
            let candidates = [
                [down(0, 1), Some(counts[1])],
                [Some(counts[0]), down(1, 1)],
                [down(0, 1), up(1)],
                [up(0), down(1, 1)],
                [down(0, 2), up(1)],
                [up(0), down(1, 2)],
            ];
            for candidate in candidates {
                let [Some(rows), Some(columns)] = candidate else { continue };
                let breaks = [problem.breaks_for(0, rows), problem.breaks_for(1, columns)];
                let lines = [0, 1].map(|k| problem.control_lines(k, breaks[k]));
                let fits = (0..2).all(|k| breaks[k] <= problem.most_breaks(k));
                if !fits || lines[0] * lines[1] >= best.size(problem) || refused.contains(&lines) {
                    continue;
                }
                if effort.is_spent() {
                    return Ok(best);
                }
                let places = style.place(problem, &density, breaks);
                if let Some(met) = meet_with(problem, &best, places, effort)? {
                    best = met;
                    continue 'again;
                }
                refused.push(lines);
            }
            break;
        }
    }
    Ok(best)
}

/// Takes breakpoints out one by one, those that save most first.
fn thinned(
    problem: &Problem<'_>,
    start: Attempt,
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    let mut best = start;
    let mut needed: Vec<(usize, f64)> = Vec::new();
    'again: while !effort.is_spent() {
        let shape = best.net_shape(problem);
        // A breakpoint of u saves a row of the net.
        let directions = if shape[0] <= shape[1] { [0, 1] } else { [1, 0] };
        for k in directions {
            if best.breaks[k].len() <= problem.fewest_breaks(k) {
                continue;
            }
            let worth = significance(&best, problem, k)?;
            let mut order: Vec<usize> = (0..worth.len()).collect();
            order.sort_by(|&a, &b| worth[a].total_cmp(&worth[b]));
            for &i in order.iter().take(TRIED) {
                if needed.contains(&(k, best.breaks[k][i])) {
                    continue;
                }
                let mut breaks = best.breaks.clone();
                breaks[k].remove(i);
                let attempt = best.with_breaks(problem, breaks);
                match tried(problem, attempt, ROUNDS_THINNED, effort)? {
                    Some(thinner) => {
                        best = thinner;
                        continue 'again;
                    }
                    None => needed.push((k, best.breaks[k][i])),
                }
                if effort.is_spent() {
                    break;
                }
            }
        }
        break;
    }
    Ok(best)
}

/// The closest attempt with numbers of breakpoints: placed anew and moved as long as that helps.
pub(super) fn best_with(
    problem: &mut Problem<'_>,
    breaks: [usize; 2],
    effort: &mut Effort<'_>,
) -> Result<Attempt, Error> {
    /// Times that breakpoints are placed anew, and moved.
    const PLACED: usize = 4;
    const MOVED: usize = 8;
    problem.enough = 0.0;
    let even = [0, 1].map(|k| Density::even().place(breaks[k], problem.closed()[k]));
    let mut attempt = Attempt::new(problem, even);
    attempt.refine(problem, ROUNDS_GROWING, effort)?;
    // How calm the surface must be follows the distance that is within reach.
    problem.allow(problem.tolerance * attempt.distances()[0].max(f64::MIN_POSITIVE));
    attempt.refine(problem, ROUNDS_PLACED, effort)?;
    let mut best = attempt.clone();
    for number in 0..PLACED + MOVED {
        if effort.is_spent() {
            break;
        }
        attempt = if number < PLACED {
            let density = densities(&attempt, problem)?;
            let places = [0, 1].map(|k| density[k].place(breaks[k], problem.closed()[k]));
            attempt.with_fresh_breaks(problem, places)
        } else {
            best.moved(problem)
        };
        attempt.refine(problem, ROUNDS_PLACED, effort)?;
        if attempt.worst < best.worst {
            best = attempt.clone();
        } else if number >= PLACED {
            break;
        }
    }
    Ok(best)
}
