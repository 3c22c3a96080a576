//! Collocation at foot points: the operator of geometric interpolation for curves (Maekawa,
//! Matsumoto and Namiki 2007; Lin 2010, section 2).
//!
//! Before it measures, every parameter moves to the foot point of its data point on the curve at
//! hand. The rule that moves the control points stays that of PIA. What the convergence theorem asks
//! is watched: the order of the parameters, and the smallest eigenvalue of the collocation matrix
//! (Lin 2010, theorem 1). When either is lost, the parameters of the last good foot points stay for
//! good. Nothing has to be taken back for that: the control points at hand are those that a step of
//! PIA at these parameters leads to.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::CurveProjector;
use super::curve::{CurveWalk, inside};
use super::fall_back::{FallBack, FallBackReason, SMALLEST_EIGENVALUE, SMALLEST_GAP, grown};
use crate::Error;
use crate::collocation::{
    CollocationMatrix, CollocationOperator, EigenvalueWatch, Factorization, Interpolation,
    ResidualNorms,
};
use crate::geometry::Curve;
use crate::knots::KnotVector;
use crate::points::Points;

/// The collocation operator whose parameters follow the foot points of the data.
#[derive(Debug)]
pub struct FootPointCollocation {
    points: usize,
    moving: Mutex<Moving>,
}

impl FootPointCollocation {
    /// Starts at assigned parameters, at which `interpolation` collocates the basis over `knots`.
    /// `parameters` rise; those of a closed curve may lie outside the domain, within a period.
    /// `dimension`: of the data. `rational_weights`: of the control points that move, for a rational
    /// curve, by which `interpolation` has been weighed.
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless there is a parameter per row, and a weight if any; what is wrong
    /// with the weights.
    pub fn new(
        interpolation: Interpolation,
        knots: &KnotVector,
        parameters: &[f64],
        dimension: usize,
        rational_weights: Option<&[f64]>,
    ) -> Result<Self, Error> {
        let points = interpolation.operator.points();
        if parameters.len() != points {
            return Err(Error::WrongCount {
                what: "parameters",
                given: parameters.len(),
                expected: points,
                why: "one per row of the operator",
            });
        }
        let control = Points::new(dimension, vec![0.0; knots.control_points() * dimension])?;
        let curve = match rational_weights {
            None => Curve::new(knots.clone(), control)?,
            Some(weights) => {
                let stored = interpolation.layout.expand(weights.to_vec(), 1);
                Curve::rational(knots.clone(), control, stored)?
            }
        };
        let moving = Moving {
            interpolation,
            curve,
            rational_weights: rational_weights.map(<[f64]>::to_vec),
            start: parameters.to_vec(),
            good: parameters.to_vec(),
            next: parameters.to_vec(),
            reduced: parameters.to_vec(),
            walk: CurveWalk::new(dimension),
            watch: EigenvalueWatch::new(points),
            calls: 0,
            global_start: false,
            least_eigenvalue: SMALLEST_EIGENVALUE,
            first_residual: f64::INFINITY,
            smallest_eigenvalue: None,
            fixed: false,
            fall_back: None,
        };
        Ok(Self { points, moving: Mutex::new(moving) })
    }

    /// The same with the nearest points of the whole curve as the first foot points.
    #[must_use]
    pub fn with_global_start(self) -> Self {
        self.lock().global_start = true;
        self
    }

    /// The same with another alpha than [`SMALLEST_EIGENVALUE`].
    #[must_use]
    pub fn with_least_eigenvalue(self, alpha: f64) -> Self {
        self.lock().least_eigenvalue = alpha;
        self
    }

    /// The parameters in use, inside the domain.
    #[must_use]
    pub fn parameters(&self) -> Vec<f64> {
        let moving = self.lock();
        let (domain, periodic) = (moving.curve.domain(), moving.curve.is_periodic());
        moving.good.iter().map(|&t| inside(t, domain, periodic)).collect()
    }

    /// The same, rising: those of a closed curve go on past the seam.
    pub(crate) fn rising_parameters(&self) -> Vec<f64> {
        let moving = self.lock();
        let mut parameters = moving.good.clone();
        let (start, end) = moving.curve.domain();
        let laps = ((parameters[0] - start) / (end - start)).floor();
        if moving.curve.is_periodic() && laps != 0.0 {
            parameters.iter_mut().for_each(|t| *t -= laps * (end - start));
        }
        parameters
    }

    /// How far a parameter in use is from where it started, at most.
    #[must_use]
    pub fn largest_move(&self) -> f64 {
        let moving = self.lock();
        moving.good.iter().zip(&moving.start).fold(0.0, |most: f64, (t, s)| most.max((t - s).abs()))
    }

    /// The smallest eigenvalue met at foot points that were used.
    #[must_use]
    pub fn smallest_eigenvalue(&self) -> Option<f64> {
        self.lock().smallest_eigenvalue
    }

    /// Whether the parameters stay where they are, for good.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.lock().fixed
    }

    /// When the foot points were given up, and why.
    #[must_use]
    pub fn fall_back(&self) -> Option<FallBack> {
        self.lock().fall_back
    }

    /// Factors of the matrix at the parameters in use.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub fn factor(&self) -> Result<Factorization, Error> {
        self.lock().interpolation.operator.factor(None)
    }

    fn lock(&self) -> MutexGuard<'_, Moving> {
        self.moving.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl CollocationOperator for FootPointCollocation {
    fn points(&self) -> usize {
        self.points
    }

    fn control_points(&self) -> usize {
        self.points
    }

    /// At the parameters in use.
    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        self.lock().interpolation.operator.apply(x, dimension, result);
    }

    /// Moves the parameters to the foot points on the curve of `control` first, unless they were
    /// given up.
    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let mut moving = self.lock();
        if !moving.fixed
            && let Err(reason) = moving.follow(data, control, dimension, result)
        {
            moving.give_up(reason);
        }
        moving.calls += 1;
        moving.interpolation.operator.difference_vectors(data, control, dimension, result)
    }

    fn reset(&self) {
        self.lock().reset();
    }
}

/// What changes from call to call.
#[derive(Debug)]
struct Moving {
    /// At the parameters `good`.
    interpolation: Interpolation,
    curve: Curve,
    /// Of the control points that move.
    rational_weights: Option<Vec<f64>>,
    /// As assigned.
    start: Vec<f64>,
    /// Of the last foot points that could be used. Those of a closed curve count laps.
    good: Vec<f64>,
    /// Of the foot points under way.
    next: Vec<f64>,
    /// The same inside the domain.
    reduced: Vec<f64>,
    walk: CurveWalk,
    watch: EigenvalueWatch,
    calls: usize,
    /// Whether the first foot points are the nearest of all.
    global_start: bool,
    /// The smallest eigenvalue with which foot points go on.
    least_eigenvalue: f64,
    first_residual: f64,
    smallest_eigenvalue: Option<f64>,
    /// Whether foot points were given up.
    fixed: bool,
    /// Where they were; kept when a run is repeated up to a step before.
    fall_back: Option<FallBack>,
}

impl Moving {
    /// Moves all parameters to foot points, if what these lead to is sound.
    fn follow(
        &mut self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> Result<(), FallBackReason> {
        self.interpolation.layout.expand_into(control, dimension, self.curve.control_points_mut());
        self.project(data, dimension);
        self.check_order()?;
        self.collocate_next()?;
        let eigenvalue = self.eigenvalue();
        if eigenvalue.is_nan() || eigenvalue < self.least_eigenvalue {
            let least = self.least_eigenvalue;
            return Err(FallBackReason::Eigenvalue { eigenvalue, least });
        }
        let operator = &self.interpolation.operator;
        let residual = operator.difference_vectors(data, control, dimension, result).max;
        if self.calls == 0 {
            self.first_residual = residual;
        }
        grown(residual, self.first_residual, data).map_or(Ok(()), Err)?;
        std::mem::swap(&mut self.good, &mut self.next);
        let least = self.smallest_eigenvalue.unwrap_or(1.0).min(eigenvalue);
        self.smallest_eigenvalue = Some(least);
        Ok(())
    }

    /// The foot points of the data, each looked for from the last one.
    fn project(&mut self, data: &[f64], dimension: usize) {
        let open = !self.curve.is_periodic();
        let last = self.good.len() - 1;
        let projector =
            (self.global_start && self.calls == 0).then(|| CurveProjector::new(&self.curve));
        let (from, to) = self.curve.domain();
        for (j, point) in data.chunks_exact(dimension).enumerate() {
            self.next[j] = self.good[j];
            // The ends of an open curve stay with the ends of the data.
            if open && (j == 0 || j == last) {
                continue;
            }
            if let Some(foot) = projector.as_ref().and_then(|all| all.project(point).ok()) {
                // On the lap of a closed curve that is nearest to the parameter assigned.
                let lap = if open { 0.0 } else { to - from };
                let laps = ((self.good[j] - foot.parameter) / lap).round();
                self.next[j] = foot.parameter + if open { 0.0 } else { laps * lap };
                continue;
            }
            // A parameter in the domain is never refused.
            if let Ok((t, _)) = self.walk.descend(&self.curve, point, self.good[j]) {
                self.next[j] = t;
            }
        }
    }

    fn check_order(&self) -> Result<(), FallBackReason> {
        let (t, start) = (&self.next, &self.start);
        // Parameters are numbers: a walk takes none but finite steps.
        let lost = |now: f64, assigned: f64| now <= SMALLEST_GAP * assigned;
        for j in 1..t.len() {
            if lost(t[j] - t[j - 1], start[j] - start[j - 1]) {
                return Err(FallBackReason::Order { point: j - 1, next: j });
            }
        }
        if self.curve.is_periodic() {
            let (from, to) = self.curve.domain();
            let last = t.len() - 1;
            let across = |t: &[f64]| t[0] + (to - from) - t[last];
            if lost(across(t), across(start)) {
                return Err(FallBackReason::Order { point: last, next: 0 });
            }
        }
        Ok(())
    }

    fn collocate_next(&mut self) -> Result<(), FallBackReason> {
        let least = self.least_eigenvalue;
        self.collocate(Parameters::Next).map_err(|error| match error {
            Error::SchoenbergWhitney { point, .. } => FallBackReason::SchoenbergWhitney { point },
            _ => FallBackReason::Eigenvalue { eigenvalue: 0.0, least },
        })
    }

    /// The smallest eigenvalue of the matrix at the parameters `next`: enclosed where it is totally
    /// positive, estimated elsewhere.
    fn eigenvalue(&mut self) -> f64 {
        let operator = &self.interpolation.operator;
        if self.curve.is_periodic() {
            return self.watch.estimate(self.least_eigenvalue, |x, ax| operator.apply(x, 1, ax));
        }
        self.watch.enclose(operator, self.least_eigenvalue).map_or(0.0, |bounds| bounds.estimate)
    }

    /// Goes back to the parameters of the last good foot points, for good.
    fn give_up(&mut self, reason: FallBackReason) {
        self.fixed = true;
        self.fall_back = Some(FallBack { iteration: self.calls, reason });
        // They were collocated before.
        let _ = self.collocate(Parameters::Good);
    }

    fn reset(&mut self) {
        self.good.copy_from_slice(&self.start);
        self.watch.reset();
        self.calls = 0;
        self.first_residual = f64::INFINITY;
        self.smallest_eigenvalue = None;
        self.fixed = false;
        let _ = self.collocate(Parameters::Good);
    }

    /// Collocates the basis at other parameters.
    fn collocate(&mut self, which: Parameters) -> Result<(), Error> {
        let parameters = match which {
            Parameters::Good => &self.good,
            Parameters::Next => &self.next,
        };
        let (domain, periodic) = (self.curve.domain(), self.curve.is_periodic());
        for (reduced, &t) in self.reduced.iter_mut().zip(parameters) {
            *reduced = inside(t, domain, periodic);
        }
        let met = self.interpolation.recollocate(&self.reduced, self.curve.knots());
        if let Some(weights) = &self.rational_weights {
            self.interpolation.operator.weigh(weights);
        }
        met
    }
}

/// Which of the parameters kept.
#[derive(Debug, Clone, Copy)]
enum Parameters {
    Good,
    Next,
}
