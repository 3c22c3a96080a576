//! One attempt: breakpoints, and the best control points and parameters found for them.
//!
//! A round solves the weighted least squares problem at the present parameters, moves the parameters
//! towards their foot points (parameter correction), and shifts weight to where the distance is
//! largest (Lawson 1961), so that the largest distance falls rather than the mean.

use super::breaks::{knots_of, looks, relaxed};
use super::noise::CHANCE;
use super::problem::{Guard, Measure, Problem};
use super::sample::ROUND;
use crate::Error;
use crate::collocation::{CollocationMatrix, DataRows};
use crate::knots::KnotVector;
use crate::projection::MovingCurve;

/// What is known of a set of breakpoints.
#[derive(Debug, Clone)]
pub(super) struct Attempt {
    /// Inner knots of an open curve on [0, 1]; the knots in one period of a closed one.
    pub(super) breaks: Vec<f64>,
    /// Control points that move; empty before the first round.
    pub(super) control: Vec<f64>,
    pub(super) parameters: Vec<f64>,
    pub(super) weights: Vec<f64>,
    /// Weights of their own for points that are far off; empty where none is looked for.
    pub(super) trust: Vec<f64>,
    /// Places between the data where the curve is watched; more are added where it strays.
    pub(super) guards: Vec<Guard>,
    guard_weights: Vec<f64>,
    /// Distances of the data points over the one allowed.
    pub(super) ratios: Vec<f64>,
    /// How far the curve strays at the guards, over what is allowed.
    pub(super) guard_ratios: Vec<f64>,
    /// The judged ratio: at most 1 when all demands are met.
    pub(super) worst: f64,
}

/// Rounds of all attempts, counted and limited; one over very many points counts as several.
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

/// Share of the mean diagonal that holds control points which no data hold.
const HOLD: f64 = 1e-9;
/// A guard is given weight from this share of what is allowed on.
const ALERT: f64 = 0.9;

impl Attempt {
    /// Without control points, at first parameters.
    pub(super) fn new(problem: &Problem<'_>, breaks: Vec<f64>, parameters: Vec<f64>) -> Self {
        let points = problem.points();
        let mut attempt = Self {
            breaks,
            control: Vec::new(),
            parameters,
            weights: vec![1.0; points],
            trust: Vec::new(),
            guards: Vec::new(),
            guard_weights: Vec::new(),
            ratios: vec![0.0; points],
            guard_ratios: Vec::new(),
            worst: f64::INFINITY,
        };
        attempt.watch(problem);
        attempt
    }

    /// Sets the first guards.
    pub(super) fn watch(&mut self, problem: &Problem<'_>) {
        self.guards = problem.guards();
        self.guard_weights = vec![0.0; self.guards.len()];
        self.guard_ratios = vec![0.0; self.guards.len()];
    }

    /// The same with other breakpoints; what was learnt about parameters and weights is kept.
    pub(super) fn with_breaks(&self, breaks: Vec<f64>) -> Self {
        let weights = self.weights.iter().map(|w| w.sqrt()).collect();
        Self { breaks, control: Vec::new(), weights, worst: f64::INFINITY, ..self.clone() }
    }

    /// The same at some of the points.
    pub(super) fn at(&self, positions: &[usize]) -> Self {
        let pick = |values: &[f64]| positions.iter().map(|&j| values[j]).collect();
        Self {
            breaks: self.breaks.clone(),
            control: self.control.clone(),
            parameters: pick(&self.parameters),
            weights: pick(&self.weights),
            trust: Vec::new(),
            ratios: pick(&self.ratios),
            guards: Vec::new(),
            guard_weights: Vec::new(),
            guard_ratios: Vec::new(),
            worst: f64::INFINITY,
        }
    }

    /// The same with all weights equal again.
    pub(super) fn with_fresh_breaks(&self, breaks: Vec<f64>) -> Self {
        let mut fresh = self.with_breaks(breaks);
        fresh.weights.fill(1.0);
        fresh.trust.clear();
        fresh.guard_weights.fill(0.0);
        fresh
    }

    /// The same with breakpoints moved to where the distance is largest.
    pub(super) fn moved(&self, problem: &Problem<'_>) -> Self {
        Self { weights: self.weights.clone(), ..self.with_breaks(relaxed(self, problem)) }
    }

    /// Largest and root mean square of the ratios of the data points.
    pub(super) fn distances(&self) -> [f64; 2] {
        let largest = self.ratios.iter().copied().fold(0.0, f64::max);
        let square: f64 = self.ratios.iter().map(|ratio| ratio * ratio).sum();
        [largest, (square / self.ratios.len() as f64).sqrt()]
    }

    /// The knot vector.
    pub(super) fn knots(&self, problem: &Problem<'_>) -> Result<KnotVector, Error> {
        knots_of(&self.breaks, problem.degree, problem.closed)
    }

    /// Parameter of a guard.
    pub(super) fn guard_parameter(&self, guard: Guard) -> f64 {
        let here = self.parameters[guard.leg];
        let next = match self.parameters.get(guard.leg + 1) {
            Some(&next) => next,
            None => self.parameters[0] + 1.0,
        };
        here + guard.share * (next - here)
    }

    /// Runs rounds until the demands are met; the best round is kept. True if they are met.
    pub(super) fn refine(
        &mut self,
        problem: &Problem<'_>,
        rounds: usize,
        effort: &mut Effort<'_>,
    ) -> Result<bool, Error> {
        let knots = self.knots(problem)?;
        let mut best: Option<Self> = None;
        for round in 0..rounds {
            self.solve(problem, &knots)?;
            self.measure(problem, &knots);
            if best.as_ref().is_none_or(|best| self.worst < best.worst) {
                best = Some(self.clone());
            }
            effort.rounds += problem.points().div_ceil(ROUND);
            effort.stopped |= !(effort.watch)(effort.rounds, self, problem.tolerance);
            let least = best.as_ref().map_or(f64::INFINITY, |best| best.worst);
            let hopeless = round >= 5 && least > 4.0;
            if least <= problem.enough || hopeless || effort.is_spent() {
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
    fn solve(&mut self, problem: &Problem<'_>, knots: &KnotVector) -> Result<(), Error> {
        let d = problem.dimension;
        let (start, end) = knots.domain();
        let wrap = |t: f64| {
            let t = if problem.closed { start + (t - start).rem_euclid(end - start) } else { t };
            t.clamp(start, end)
        };
        let at: Vec<f64> = self.parameters.iter().map(|&t| wrap(t)).collect();
        let rows = DataRows::new(&at, knots);
        let mut equations = rows.equations(d);
        for j in 0..at.len() {
            let weight = self.weights[j] * self.trust.get(j).unwrap_or(&1.0);
            rows.add_to(j, weight, problem.point(j), &mut equations);
        }
        let known = self.control.len() == rows.columns() * d;
        if known {
            let active: Vec<usize> =
                (0..self.guards.len()).filter(|&g| self.guard_weights[g] > 0.0).collect();
            let at: Vec<f64> =
                active.iter().map(|&g| wrap(self.guard_parameter(self.guards[g]))).collect();
            let guard_rows = DataRows::new(&at, knots);
            let (mut here, mut target) = (vec![0.0; d], vec![0.0; d]);
            for (k, &g) in active.iter().enumerate() {
                here.fill(0.0);
                guard_rows.add_point(k, &self.control, &mut here);
                let Guard { leg, share } = self.guards[g];
                problem.polyline().strayed(leg, share, 1, &here, &mut target);
                guard_rows.add_to(k, self.guard_weights[g], &target, &mut equations);
            }
        } else {
            self.control = near_data(problem, knots, &at, rows.columns());
        }
        equations.hold(&self.control, HOLD);
        if problem.pinned {
            equations.pin(0, problem.point(0));
            equations.pin(rows.columns() - 1, problem.point(at.len() - 1));
        }
        let (matrix, mut solution) = equations.into_parts();
        matrix.factor(None)?.solve_in_place(&mut solution, d);
        self.control = solution;
        Ok(())
    }

    /// Corrects the parameters a few times, and measures all distances.
    pub(super) fn settle(&mut self, problem: &Problem<'_>, times: usize) -> Result<(), Error> {
        let knots = self.knots(problem)?;
        (0..times).for_each(|_| self.measure(problem, &knots));
        Ok(())
    }

    /// Corrects the parameters and measures all distances.
    fn measure(&mut self, problem: &Problem<'_>, knots: &KnotVector) {
        let control = std::mem::take(&mut self.control);
        let mut curve = MovingCurve::new(knots, &control, problem.dimension);
        if problem.over.is_some() {
            curve.distances_at(problem.data, &self.parameters, &mut self.ratios);
        } else {
            curve.correct_all(problem.data, problem.reach, &mut self.parameters, &mut self.ratios);
        }
        self.ratios.iter_mut().for_each(|ratio| *ratio /= problem.tolerance);
        if let Some(robust) = problem.robust {
            self.distrust(problem, robust);
        }
        self.judge(problem);
        let mut place = [vec![0.0; problem.dimension], vec![0.0; problem.dimension]];
        for g in 0..self.guards.len() {
            let ratio = self.strayed(problem, &mut curve, self.guards[g], &mut place);
            self.guard_ratios[g] = ratio;
            self.worst = self.worst.max(ratio);
        }
        if self.worst <= problem.enough {
            self.look_between(problem, &mut curve, &mut place);
        }
        self.control = control;
    }

    /// Sums up the ratios of the data points.
    pub(super) fn judge(&mut self, problem: &Problem<'_>) {
        let square: f64 = self.ratios.iter().map(|ratio| ratio * ratio).sum();
        self.worst = match problem.measure {
            Measure::Largest => self.ratios.iter().copied().fold(0.0, f64::max),
            Measure::Rms => {
                // Points that are met by demand do not lower the mean.
                let counted = self.ratios.len() - if problem.pinned { 2 } else { 0 };
                let mean = square / counted.max(1) as f64;
                (mean / problem.luck_of_few()).sqrt()
            }
            Measure::Noise => self.beyond_noise(problem),
        };
        if !square.is_finite() {
            self.worst = f64::INFINITY;
        }
    }

    /// The mean square, in all and in stretches of the data, over what noise makes of it.
    fn beyond_noise(&self, problem: &Problem<'_>) -> f64 {
        let points = self.ratios.len();
        let mean = |ratios: &[f64]| ratios.iter().map(|r| r * r).sum::<f64>() / ratios.len() as f64;
        // What the control points take up is missing in the mean.
        let taken = problem.control_points(self.breaks.len()) as f64 / points as f64;
        let all = mean(&self.ratios) / (1.0 - taken).max(0.1);
        let stretch = (points / 32).max(64);
        let stretches = self.ratios.chunks(stretch).filter(|part| part.len() == stretch);
        let number = (points / stretch).max(1) as f64;
        let worst = stretches.map(mean).fold(0.0, f64::max);
        // The largest of many is expected to be off by the root of twice their logarithm.
        let chance = CHANCE + (2.0 * number.ln()).sqrt();
        let all = all / problem.chance(points as f64, CHANCE);
        all.max(worst / problem.chance(stretch as f64, chance)).sqrt()
    }

    /// How far the curve is from the data polyline at a guard, over what is allowed; `place` is
    /// memory for two points.
    fn strayed(
        &self,
        problem: &Problem<'_>,
        curve: &mut MovingCurve<'_>,
        guard: Guard,
        [point, nearest]: &mut [Vec<f64>; 2],
    ) -> f64 {
        curve.point(self.guard_parameter(guard), point);
        let polyline = problem.polyline();
        if polyline.over.is_none() {
            let ratio = polyline.distance_to_leg(guard.leg, point) / problem.allowance;
            // Where all is well nobody asks whether a neighbouring leg is nearer still.
            if ratio <= ALERT {
                return ratio;
            }
        }
        polyline.strayed(guard.leg, guard.share, 1, point, nearest) / problem.allowance
    }

    /// Looks closely at all legs on which the curve could stray, and sets guards where it does.
    fn look_between(
        &mut self,
        problem: &Problem<'_>,
        curve: &mut MovingCurve<'_>,
        place: &mut [Vec<f64>; 2],
    ) {
        let polyline = problem.polyline();
        for leg in (0..polyline.legs()).filter(|&leg| problem.is_watched(leg)) {
            let from = self.parameters[leg];
            let to = self.guard_parameter(Guard { leg, share: 1.0 });
            let places = looks(from, to, &self.breaks, problem.closed);
            let short = problem.leg_length(leg) <= 0.5 * problem.allowance;
            if short && places.len() < 9 {
                // A polynomial between points this close, unless it takes its time.
                let middle = self.strayed(problem, curve, Guard { leg, share: 0.5 }, place);
                if middle <= 0.5 {
                    continue;
                }
            }
            let mut worst = (problem.enough, None);
            for t in places {
                let guard = Guard { leg, share: (t - from) / (to - from) };
                let ratio = self.strayed(problem, curve, guard, place);
                if ratio > worst.0 {
                    worst = (ratio, Some(guard));
                }
            }
            if let (ratio, Some(guard)) = worst {
                self.worst = self.worst.max(ratio);
                let near =
                    |known: &Guard| known.leg == leg && (known.share - guard.share).abs() < 1e-3;
                if !self.guards.iter().any(near) {
                    self.guards.push(guard);
                    self.guard_weights.push(0.0);
                    self.guard_ratios.push(ratio);
                }
            }
        }
    }

    /// Gives weight to what is farthest off.
    fn shift_weight(&mut self, measure: Measure) {
        let mut mean = 1.0;
        if measure == Measure::Largest {
            let worst = self.worst.max(f64::MIN_POSITIVE);
            let mut sum = 0.0;
            for (weight, ratio) in self.weights.iter_mut().zip(&self.ratios) {
                let share = ratio / worst;
                *weight = (*weight * (0.85 + 0.5 * share * share).min(1.35)).max(1e-3);
                sum += *weight;
            }
            mean = sum / self.weights.len() as f64;
            self.weights.iter_mut().for_each(|weight| *weight /= mean);
        }
        for (weight, &ratio) in self.guard_weights.iter_mut().zip(&self.guard_ratios) {
            if ratio > ALERT {
                *weight = (weight.max(0.05) * (0.6 + 0.6 * ratio).min(1.8)).min(1e4);
            } else {
                *weight *= 0.95;
                if *weight < 0.02 {
                    *weight = 0.0;
                }
            }
            *weight /= mean.clamp(0.5, 2.0);
        }
    }
}

/// Data points near the Greville abscissae: where control points stay that nothing pulls.
fn near_data(problem: &Problem<'_>, knots: &KnotVector, at: &[f64], columns: usize) -> Vec<f64> {
    let mut order: Vec<usize> = (0..at.len()).collect();
    if problem.closed || problem.reach > 1 {
        order.sort_by(|&a, &b| at[a].total_cmp(&at[b]));
    }
    let greville = knots.greville_abscissae();
    greville[..columns]
        .iter()
        .flat_map(|&g| {
            let after = order.partition_point(|&j| at[j] < g).min(at.len() - 1);
            problem.point(order[after])
        })
        .copied()
        .collect()
}
