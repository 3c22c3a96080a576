//! Where the breakpoints of both directions should stand, and which direction an error belongs to.

use super::attempt::Attempt;
use super::problem::Problem;
use crate::Error;
use crate::collocation::{CollocationMatrix, DataRows};
use crate::fit::approximate::Measure;
use crate::fit::approximate::breaks::{
    Density, density_after, ends_of, jumps_of, significance_after, span_of,
};

/// Jumps of the highest derivative across each breakpoint line, over all of it, and the ends of the
/// spans.
fn jumps(attempt: &Attempt, problem: &Problem<'_>, k: usize) -> Result<[Vec<f64>; 2], Error> {
    let knots = attempt.knots(problem)?;
    let [rows, columns] = attempt.net_shape(problem);
    let d = problem.dimension();
    let ends = ends_of(&attempt.breaks[k], problem.closed()[k]);
    let spans = ends.len() - 1;
    let jumps = if k == 0 {
        jumps_of(&knots[0], &attempt.net, columns * d, spans)
    } else {
        let turned = turned(&attempt.net, [rows, columns], d);
        jumps_of(&knots[1], &turned, rows * d, spans)
    };
    Ok([jumps, ends])
}

/// Rows for columns.
fn turned(grid: &[f64], [rows, columns]: [usize; 2], dimension: usize) -> Vec<f64> {
    (0..columns)
        .flat_map(|j| (0..rows).map(move |i| i * columns + j))
        .flat_map(|k| &grid[k * dimension..][..dimension])
        .copied()
        .collect()
}

/// Densities of breakpoints after the jumps that an attempt shows.
pub(super) fn densities(attempt: &Attempt, problem: &Problem<'_>) -> Result<[Density; 2], Error> {
    let density = |k: usize| -> Result<Density, Error> {
        let [jumps, ends] = jumps(attempt, problem, k)?;
        Ok(density_after(&jumps, &ends, problem.degrees[k], problem.closed()[k]))
    };
    Ok([density(0)?, density(1)?])
}

/// What each breakpoint of a direction is worth: roughly how far the surface would move without it.
pub(super) fn significance(
    attempt: &Attempt,
    problem: &Problem<'_>,
    k: usize,
) -> Result<Vec<f64>, Error> {
    let [jumps, ends] = jumps(attempt, problem, k)?;
    Ok(significance_after(&jumps, &ends, problem.degrees[k], problem.closed()[k]))
}

/// Breakpoints that the spans with the largest error ask for, in u and v, worst spans first.
///
/// The difference vectors of a separable fit are a sum of what the functions in u cannot do and what
/// those in v cannot: projected onto the functions in v the first is left, in u the second.
pub(super) fn additions(attempt: &Attempt, problem: &Problem<'_>) -> Result<[Vec<f64>; 2], Error> {
    let d = problem.dimension();
    let shape = problem.cells.shape;
    let knots = attempt.knots(problem)?;
    let projected = |k: usize, vectors: &[f64], wide: usize| -> Result<Vec<f64>, Error> {
        let (start, end) = knots[k].domain();
        let inside = |t: f64| {
            let t =
                if problem.closed()[k] { start + (t - start).rem_euclid(end - start) } else { t };
            t.clamp(start, end)
        };
        let t: Vec<f64> = problem.lines[k].iter().map(|&t| inside(t)).collect();
        let rows = DataRows::new(&t, &knots[k]);
        let mut equations = rows.equations(wide);
        for (j, line) in vectors.chunks_exact(wide).enumerate() {
            rows.add_to(j, 1.0, line, &mut equations);
        }
        equations.hold(&[], 1e-9);
        let (matrix, mut control) = equations.into_parts();
        matrix.factor(None)?.solve_in_place(&mut control, wide);
        let mut out = vec![0.0; vectors.len()];
        for (j, line) in out.chunks_exact_mut(wide).enumerate() {
            rows.add_point(j, &control, line);
        }
        Ok(out)
    };
    let across = turned(&attempt.vectors, shape, d);
    let in_u = projected(1, &across, shape[0] * d)?;
    let in_v = projected(0, &attempt.vectors, shape[1] * d)?;
    // Lines of direction k, with the norms of their vectors.
    let lines = |k: usize, line: usize| -> Vec<f64> {
        let wide = shape[0] * d;
        let norm = |vector: &[f64]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        if k == 0 {
            (0..shape[1]).map(|j| norm(&in_u[j * wide + line * d..][..d])).collect()
        } else {
            (0..shape[0]).map(|i| norm(&in_v[(i * shape[1] + line) * d..][..d])).collect()
        }
    };
    let mut wanted = Vec::with_capacity(2);
    let mut top = 0.0_f64;
    for k in 0..2 {
        let closed = problem.closed()[k];
        let ends = ends_of(&attempt.breaks[k], closed);
        let spans = ends.len() - 1;
        let mut largest = vec![0.0_f64; spans];
        let mut moments = vec![(0.0, 0.0); spans];
        let mut held = vec![0_usize; spans];
        for (line, &t) in problem.lines[k].iter().enumerate() {
            let span = span_of(&ends, t, closed);
            let along = if closed { (t - ends[span]).rem_euclid(1.0) } else { t - ends[span] };
            let norms = lines(k, line);
            held[span] += 1;
            largest[span] = norms.iter().copied().fold(largest[span], f64::max);
            let square: f64 = norms.iter().map(|x| x * x).sum();
            moments[span].0 += square;
            moments[span].1 += square * along;
        }
        for s in 0..spans {
            if held[s] < 2 {
                // Nothing there for a function more.
                largest[s] = 0.0;
            }
        }
        top = largest.iter().copied().fold(top, f64::max);
        wanted.push((ends, largest, moments));
    }
    let share = if problem.measure == Measure::Rms { 0.5 } else { 0.35 };
    let mut added = [Vec::new(), Vec::new()];
    for (k, (ends, largest, moments)) in wanted.into_iter().enumerate() {
        let closed = problem.closed()[k];
        let mut order: Vec<usize> =
            (0..largest.len()).filter(|&s| largest[s] > share * top).collect();
        order.sort_by(|&a, &b| largest[b].total_cmp(&largest[a]));
        order.truncate(problem.most_breaks(k).saturating_sub(attempt.breaks[k].len()));
        added[k] = order
            .into_iter()
            .filter_map(|s| {
                let length = ends[s + 1] - ends[s];
                let along = (moments[s].1 / moments[s].0).clamp(0.15 * length, 0.85 * length);
                let place = ends[s] + along;
                let place = if closed { place.rem_euclid(1.0) } else { place };
                (along.is_finite() && (place > ends[s] || closed)).then_some(place)
            })
            .collect();
    }
    Ok(added)
}
