//! One attempt: breakpoints in both directions, and the best net and parameters found for them.
//!
//! A round solves the weighted least squares problem at the present parameters, moves the parameters
//! towards their foot points (parameter correction; not those of heights), and shifts weight to where
//! the distance is largest (Lawson 1961), so that the largest distance falls rather than the mean.

use super::between::Guard;
use super::problem::Problem;
use super::settle::settle;
use crate::Error;
use crate::collocation::{NetPreconditioner, NetRows, WeightedPart, solve_weighted};
use crate::fit::approximate::Measure;
use crate::fit::approximate::breaks::{ends_of, knots_of, relaxed_after, span_of};
use crate::knots::KnotVector;
use crate::projection::MovingSurface;

/// What is known of a set of breakpoints.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    /// Inner knots of an open direction on [0, 1]; the knots in one period of a closed one.
    pub(super) breaks: [Vec<f64>; 2],
    /// Control points that move, row by row; empty before the first round.
    pub(super) net: Vec<f64>,
    /// Of each point, row by row; empty where those of the lines stay.
    pub(super) parameters: Vec<[f64; 2]>,
    weights: Vec<f64>,
    pub(super) guards: Vec<Guard>,
    pub(super) guard_targets: Vec<f64>,
    /// Vectors from the surface to the data points.
    pub(super) vectors: Vec<f64>,
    /// Distances of the data points over the one allowed.
    pub(super) ratios: Vec<f64>,
    /// The judged ratio: at most 1 when all demands are met.
    pub(super) worst: f64,
}

/// Rounds of all attempts, counted and limited.
pub(super) struct Effort<'a> {
    pub(super) rounds: usize,
    pub(super) most: usize,
    /// Called after each round with the rounds so far, the attempt and the distance allowed; false
    /// stops everything.
    pub(super) watch: &'a mut dyn FnMut(usize, &Attempt, f64) -> bool,
    pub(super) stopped: bool,
}

impl Effort<'_> {
    /// Whether nothing more may be tried.
    pub(super) fn is_spent(&self) -> bool {
        self.stopped || self.rounds >= self.most
    }
}

/// A guard is given weight from this share of what is allowed on.
const ALERT: f64 = 0.9;
/// Share of the gradient that a first solution, and a later one, may keep; steps they may take.
const FIRST: (f64, usize) = (1e-5, 25);
const LATER: (f64, usize) = (1e-2, 8);

impl Attempt {
    /// Without a net, at the parameters of the lines.
    pub(super) fn new(problem: &Problem<'_>, mut breaks: [Vec<f64>; 2]) -> Self {
        for (k, breaks) in breaks.iter_mut().enumerate() {
            let lines = &problem.lines[k];
            let second = [lines[0], lines[lines.len() - 1]];
            settle(breaks, lines, second, problem.degrees[k], problem.closed()[k]);
        }
        let points = problem.points();
        let [u, v] = &problem.lines;
        let parameters = if problem.kept {
            Vec::new()
        } else {
            u.iter().flat_map(|&u| v.iter().map(move |&v| [u, v])).collect()
        };
        Self {
            breaks,
            net: Vec::new(),
            parameters,
            weights: vec![1.0; points],
            guards: Vec::new(),
            guard_targets: Vec::new(),
            vectors: vec![0.0; points * problem.dimension()],
            ratios: vec![0.0; points],
            worst: f64::INFINITY,
        }
    }

    /// The same with other breakpoints, as near as the data lines let them stand; what was learnt
    /// about parameters and weights is kept.
    pub(super) fn with_breaks(&self, problem: &Problem<'_>, mut breaks: [Vec<f64>; 2]) -> Self {
        for (k, breaks) in breaks.iter_mut().enumerate() {
            settle(
                breaks,
                &self.lines(problem, k),
                self.second_lines(problem, k),
                problem.degrees[k],
                problem.closed()[k],
            );
        }
        let weights = self.weights.iter().map(|w| w.sqrt()).collect();
        Self { breaks, net: Vec::new(), weights, worst: f64::INFINITY, ..self.clone() }
    }

    /// The same with all weights equal again.
    pub(super) fn with_fresh_breaks(&self, problem: &Problem<'_>, breaks: [Vec<f64>; 2]) -> Self {
        let mut fresh = self.with_breaks(problem, breaks);
        fresh.weights.fill(1.0);
        fresh.guards.iter_mut().for_each(|guard| guard.weight = 0.0);
        fresh
    }

    /// The same with breakpoints moved to where the distance is largest.
    pub(super) fn moved(&self, problem: &Problem<'_>) -> Self {
        let breaks = [0, 1].map(|k| {
            let closed = problem.closed()[k];
            let ends = ends_of(&self.breaks[k], closed);
            let mut largest = vec![0.0_f64; ends.len() - 1];
            self.for_each_ratio(problem, |pair, ratio| {
                let span = span_of(&ends, pair[k], closed);
                largest[span] = largest[span].max(ratio / self.worst);
            });
            relaxed_after(&largest, &ends, problem.degrees[k], closed)
        });
        Self { weights: self.weights.clone(), ..self.with_breaks(problem, breaks) }
    }

    /// Parameters of the lines of direction `k`: where points have their own, the mean.
    fn lines(&self, problem: &Problem<'_>, k: usize) -> Vec<f64> {
        if self.parameters.is_empty() {
            return problem.lines[k].clone();
        }
        let [rows, columns] = problem.cells.shape;
        let mut lines = vec![0.0; problem.cells.shape[k]];
        for (point, pair) in self.parameters.iter().enumerate() {
            lines[if k == 0 { point / columns } else { point % columns }] += pair[k];
        }
        let across = [columns, rows][k] as f64;
        lines.iter_mut().for_each(|t| *t /= across);
        lines
    }

    /// Largest parameter on the second line of direction `k`, and smallest on the last but one.
    fn second_lines(&self, problem: &Problem<'_>, k: usize) -> [f64; 2] {
        let ([rows, columns], count) = (problem.cells.shape, problem.cells.shape[k]);
        let across = [columns, rows][k];
        let at = |line: usize, other: usize| {
            let [i, j] = if k == 0 { [line, other] } else { [other, line] };
            self.pair(problem, i * columns + j)[k]
        };
        let low = (0..across).map(|other| at(1.min(count - 1), other)).fold(0.0, f64::max);
        let high = (0..across).map(|other| at(count.saturating_sub(2), other)).fold(1.0, f64::min);
        [low, high]
    }

    /// Visits parameters and ratio of all data points and guards.
    fn for_each_ratio(&self, problem: &Problem<'_>, mut visit: impl FnMut([f64; 2], f64)) {
        for (k, &ratio) in self.ratios.iter().enumerate() {
            visit(self.pair(problem, k), ratio);
        }
        for guard in &self.guards {
            visit(self.guard_pair(problem, guard), guard.ratio);
        }
    }

    /// Parameters of a data point.
    pub(super) fn pair(&self, problem: &Problem<'_>, point: usize) -> [f64; 2] {
        let columns = problem.cells.shape[1];
        match self.parameters.get(point) {
            Some(&pair) => pair,
            None => [problem.lines[0][point / columns], problem.lines[1][point % columns]],
        }
    }

    /// Parameters of a place in a cell, between those of its corners.
    pub(super) fn place(
        &self,
        problem: &Problem<'_>,
        cell: [usize; 2],
        [s, t]: [f64; 2],
    ) -> [f64; 2] {
        let mut corners = problem.cells.corners(cell).map(|corner| self.pair(problem, corner));
        let [rows, columns] = problem.cells.shape;
        // Beyond the seam parameters go on past the period.
        if cell[0] + 1 == rows {
            corners[2][0] += 1.0;
            corners[3][0] += 1.0;
        }
        if cell[1] + 1 == columns {
            corners[1][1] += 1.0;
            corners[3][1] += 1.0;
        }
        let weights = [(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t];
        [0, 1].map(|k| corners.iter().zip(weights).map(|(corner, w)| w * corner[k]).sum())
    }

    fn guard_pair(&self, problem: &Problem<'_>, guard: &Guard) -> [f64; 2] {
        self.place(problem, guard.cell, guard.share)
    }

    /// Largest and root mean square of the ratios of the data points.
    pub(super) fn distances(&self) -> [f64; 2] {
        let largest = self.ratios.iter().copied().fold(0.0, f64::max);
        let square: f64 = self.ratios.iter().map(|ratio| ratio * ratio).sum();
        [largest, (square / self.ratios.len() as f64).sqrt()]
    }

    /// The knot vectors.
    pub(super) fn knots(&self, problem: &Problem<'_>) -> Result<[KnotVector; 2], Error> {
        let knots = |k: usize| knots_of(&self.breaks[k], problem.degrees[k], problem.closed()[k]);
        Ok([knots(0)?, knots(1)?])
    }

    /// Rows and columns of control points that move.
    pub(super) fn net_shape(&self, problem: &Problem<'_>) -> [usize; 2] {
        [0, 1].map(|k| problem.control_lines(k, self.breaks[k].len()))
    }

    /// Control points that move.
    pub(super) fn size(&self, problem: &Problem<'_>) -> usize {
        let [rows, columns] = self.net_shape(problem);
        rows * columns
    }

    /// Runs rounds until the demands are met, or will not be in that many; the best round is kept.
    /// True if they are met.
    pub(super) fn refine(
        &mut self,
        problem: &Problem<'_>,
        rounds: usize,
        effort: &mut Effort<'_>,
    ) -> Result<bool, Error> {
        self.run(problem, rounds, true, effort)
    }

    /// As [`Attempt::refine`], without giving up early.
    pub(super) fn refine_closely(
        &mut self,
        problem: &Problem<'_>,
        rounds: usize,
        effort: &mut Effort<'_>,
    ) -> Result<bool, Error> {
        self.run(problem, rounds, false, effort)
    }

    fn run(
        &mut self,
        problem: &Problem<'_>,
        rounds: usize,
        may_give_up: bool,
        effort: &mut Effort<'_>,
    ) -> Result<bool, Error> {
        let knots = self.knots(problem)?;
        let pair = knots.each_ref();
        let lines = problem.kept.then(|| {
            let inside = MovingSurface::new(pair, &[], problem.dimension());
            let [u, v] = &problem.lines;
            let u: Vec<f64> = u.iter().map(|&t| inside.inside([t, 0.0])[0]).collect();
            let v: Vec<f64> = v.iter().map(|&t| inside.inside([0.0, t])[1]).collect();
            NetRows::of_lines([&u, &v], pair)
        });
        let mut best: Option<Self> = None;
        let mut least = Vec::with_capacity(rounds);
        for round in 0..rounds {
            self.solve(problem, pair, lines.as_ref())?;
            let limit = match &best {
                Some(best) if problem.enough == 0.0 => best.worst,
                _ if problem.enough == 0.0 => 1.0,
                _ => problem.enough,
            };
            self.measure(problem, pair, lines.as_ref(), limit);
            if best.as_ref().is_none_or(|best| self.worst < best.worst) {
                best = Some(self.clone());
            }
            effort.rounds += 1;
            effort.stopped |= !(effort.watch)(effort.rounds, self, problem.tolerance);
            least.push(best.as_ref().map_or(f64::INFINITY, |best| best.worst));
            let hopeless =
                may_give_up && problem.enough > 0.0 && is_hopeless(&least, rounds, problem.kept);
            if least[round] <= problem.enough || hopeless || effort.is_spent() {
                break;
            }
            if round + 1 < rounds {
                self.shift_weight(problem.measure);
            }
        }
        if let Some(best) = best {
            *self = best;
        }
        Ok(self.worst <= problem.enough)
    }

    /// Weighted least squares at the present parameters.
    fn solve(
        &mut self,
        problem: &Problem<'_>,
        knots: [&KnotVector; 2],
        lines: Option<&NetRows>,
    ) -> Result<(), Error> {
        let d = problem.dimension();
        let own;
        let inside = MovingSurface::new(knots, &[], d);
        let rows = match lines {
            Some(lines) => lines,
            None => {
                let pairs: Vec<[f64; 2]> =
                    self.parameters.iter().map(|&pair| inside.inside(pair)).collect();
                own = NetRows::of_points(&pairs, knots);
                &own
            }
        };
        let [net_rows, net_columns] = rows.net_shape();
        let (reduction, most) = if self.net.len() == net_rows * net_columns * d {
            LATER
        } else {
            self.net = self.near_data(problem, knots, rows.net_shape());
            FIRST
        };
        let active: Vec<usize> =
            (0..self.guards.len()).filter(|&g| self.guards[g].weight > 0.0).collect();
        let places: Vec<[f64; 2]> = active
            .iter()
            .map(|&g| inside.inside(self.guard_pair(problem, &self.guards[g])))
            .collect();
        let guard_rows = NetRows::of_points(&places, knots);
        let guard_weights: Vec<f64> = active.iter().map(|&g| self.guards[g].weight).collect();
        let guard_targets: Vec<f64> =
            active.iter().flat_map(|&g| &self.guard_targets[g * d..][..d]).copied().collect();
        let preconditioner = NetPreconditioner::new(rows, &self.weights)?;
        let data = WeightedPart { rows, weights: &self.weights, targets: problem.cells.data };
        let watched =
            WeightedPart { rows: &guard_rows, weights: &guard_weights, targets: &guard_targets };
        let parts = [data, watched];
        let parts = if active.is_empty() { &parts[..1] } else { &parts[..] };
        solve_weighted(parts, &preconditioner, &mut self.net, d, reduction, most);
        Ok(())
    }

    /// Data points near the Greville abscissae: where control points stay that nothing pulls.
    fn near_data(
        &self,
        problem: &Problem<'_>,
        knots: [&KnotVector; 2],
        [rows, columns]: [usize; 2],
    ) -> Vec<f64> {
        let near = |k: usize, lines: usize| -> Vec<usize> {
            let t = &problem.lines[k];
            let place = |g: f64| if problem.closed()[k] { g.rem_euclid(1.0) } else { g };
            let greville = knots[k].greville_abscissae();
            greville[..lines]
                .iter()
                .map(|&g| t.partition_point(|&t| t < place(g)).min(t.len() - 1))
                .collect()
        };
        let (u, v) = (near(0, rows), near(1, columns));
        let (d, line) = (problem.dimension(), problem.cells.shape[1]);
        u.iter()
            .flat_map(|&i| v.iter().map(move |&j| i * line + j))
            .flat_map(|k| &problem.cells.data[k * d..][..d])
            .copied()
            .collect()
    }

    /// Corrects the parameters and measures all distances; looks closely between the points where the
    /// ratio is no more than a limit.
    fn measure(
        &mut self,
        problem: &Problem<'_>,
        knots: [&KnotVector; 2],
        lines: Option<&NetRows>,
        limit: f64,
    ) {
        let d = problem.dimension();
        let net = std::mem::take(&mut self.net);
        let mut surface = MovingSurface::new(knots, &net, d);
        let data = problem.cells.data;
        if let Some(lines) = lines {
            let (vectors, ratios) = (&mut self.vectors, &mut self.ratios);
            lines.visit(&net, d, |k, point| {
                let mut square = 0.0;
                for i in 0..d {
                    let gap = data[k * d + i] - point[i];
                    vectors[k * d + i] = gap;
                    square += gap * gap;
                }
                ratios[k] = square.sqrt();
            });
        } else {
            surface.correct_grid(
                data,
                problem.cells.shape,
                &mut self.parameters,
                &mut self.vectors,
                &mut self.ratios,
            );
        }
        let (mut square, mut largest) = (0.0, 0.0_f64);
        for ratio in &mut self.ratios {
            *ratio /= problem.tolerance;
            square += *ratio * *ratio;
            largest = largest.max(*ratio);
        }
        self.worst = match problem.measure {
            Measure::Largest => largest,
            Measure::Rms | Measure::Noise => (square / self.ratios.len() as f64).sqrt(),
        };
        if !f64::is_finite(square) {
            self.worst = f64::INFINITY;
        }
        self.guard_targets.resize(self.guards.len() * d, 0.0);
        let mut point = vec![0.0; d];
        for g in 0..self.guards.len() {
            let guard = self.guards[g];
            surface.point(self.guard_pair(problem, &guard), &mut point);
            let target = &mut self.guard_targets[g * d..][..d];
            let strayed = problem.cells.distance_nearby(guard.cell, guard.share, &point, target);
            self.guards[g].ratio = strayed / problem.allowance;
            self.worst = self.worst.max(self.guards[g].ratio);
        }
        if self.worst <= limit {
            self.look_between(problem, knots, &net, &mut surface);
        }
        self.net = net;
    }

    /// Gives weight to what is farthest off.
    fn shift_weight(&mut self, measure: Measure) {
        let mut mean = 1.0;
        if measure == Measure::Largest {
            let worst = self.distances()[0].max(f64::MIN_POSITIVE);
            let mut sum = 0.0;
            for (weight, ratio) in self.weights.iter_mut().zip(&self.ratios) {
                let share = ratio / worst;
                *weight = (*weight * (0.85 + 0.5 * share * share)).max(1e-3);
                sum += *weight;
            }
            mean = sum / self.weights.len() as f64;
            self.weights.iter_mut().for_each(|weight| *weight /= mean);
        }
        for guard in &mut self.guards {
            if guard.ratio > ALERT {
                let factor = (0.6 + 0.6 * guard.ratio).min(4.0);
                guard.weight = (guard.weight.max(0.2) * factor).min(1e4);
            } else {
                guard.weight *= 0.95;
                if guard.weight < 0.02 {
                    guard.weight = 0.0;
                }
            }
            guard.weight /= mean.clamp(0.5, 2.0);
        }
    }
}

/// Whether the least ratios so far do not fall fast enough for the rounds that are left.
fn is_hopeless(least: &[f64], rounds: usize, kept: bool) -> bool {
    /// Rounds over which the pace is taken.
    const PACE: usize = 3;
    let done = least.len();
    let last = least[done - 1];
    if done == 1 {
        return last > if kept { 2.0 } else { 8.0 };
    }
    if done <= PACE {
        return false;
    }
    let gain = (least[done - 1 - PACE] - last) / PACE as f64;
    last - gain * (rounds - done) as f64 > 1.0
}
