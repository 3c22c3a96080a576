//! Collocation at foot points: the operator of geometric interpolation for surfaces (Maekawa,
//! Matsumoto and Namiki 2007; Lin 2010, section 3).
//!
//! Every point of the grid has a foot point of its own, so that there are no parameters of rows and
//! columns, and no Kronecker product. The convergence theorem is written for one, though (Lin 2010,
//! theorem 2). What it asks is watched in the form that is left of it: parameters rise along every
//! row and column, and the smallest eigenvalue is estimated. When either is lost, the run goes on at
//! the parameters that were assigned to rows and columns, for which the limit is known to exist.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::SurfaceProjector;
use super::curve::inside;
use super::fall_back::{FallBack, FallBackReason, SMALLEST_EIGENVALUE, SMALLEST_GAP, grown};
use super::surface::SurfaceWalk;
use crate::Error;
use crate::collocation::{
    CollocationOperator, EigenvalueWatch, NetLayout, ResidualNorms, ScatteredCollocation,
};
use crate::geometry::Surface;
use crate::knots::KnotVector;
use crate::points::PointGrid;

/// The collocation operator whose pairs of parameters follow the foot points of a grid.
#[derive(Debug)]
pub struct SurfaceFootPointCollocation<'a> {
    /// At the parameters assigned to rows and columns.
    assigned: &'a dyn CollocationOperator,
    moving: Mutex<Moving>,
}

impl<'a> SurfaceFootPointCollocation<'a> {
    /// Starts at the parameters of rows and columns at which `assigned` collocates the bases over
    /// `knots`. Parameters rise; those of a closed direction may lie outside the domain, within a
    /// period. `dimension`: of the data. `rational_weights`: of the control points that move, row by
    /// row, for a rational surface.
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless there are as many points in rows and columns as in `assigned`;
    /// what is wrong with the weights.
    pub fn new(
        assigned: &'a dyn CollocationOperator,
        layout: NetLayout,
        knots: [KnotVector; 2],
        parameters: [&[f64]; 2],
        dimension: usize,
        rational_weights: Option<&[f64]>,
    ) -> Result<Self, Error> {
        let shape = parameters.map(<[f64]>::len);
        if shape[0] * shape[1] != assigned.points() {
            return Err(Error::WrongCount {
                what: "pairs of parameters",
                given: shape[0] * shape[1],
                expected: assigned.points(),
                why: "one per row of the operator",
            });
        }
        let net = knots.each_ref().map(KnotVector::control_points);
        let zeros = vec![0.0; net[0] * net[1] * dimension];
        let degrees = knots.each_ref().map(KnotVector::degree);
        let start: Vec<[f64; 2]> = parameters[0]
            .iter()
            .flat_map(|&u| parameters[1].iter().map(move |&v| [u, v]))
            .collect();
        let weights = rational_weights.map(<[f64]>::to_vec);
        let zeros = PointGrid::new(net, dimension, zeros)?;
        let surface = match &weights {
            None => Surface::new(knots, zeros)?,
            Some(weights) => Surface::rational(knots, zeros, layout.expand(weights.clone(), 1))?,
        };
        let moving = Moving {
            rows: ScatteredCollocation::new(shape, degrees, layout, weights),
            surface,
            layout,
            shape,
            good: start.clone(),
            next: start.clone(),
            start,
            walk: SurfaceWalk::new(dimension),
            watch: EigenvalueWatch::new(shape[0] * shape[1]),
            calls: 0,
            global_start: false,
            least_eigenvalue: SMALLEST_EIGENVALUE,
            first_residual: f64::INFINITY,
            smallest_eigenvalue: None,
            fixed: false,
            fall_back: None,
        };
        Ok(Self { assigned, moving: Mutex::new(moving) })
    }

    /// The same with the nearest points of the whole surface as the first foot points.
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

    /// The parameters (u, v) in use, inside the domain, row by row; `None` where they are those of
    /// rows and columns.
    #[must_use]
    pub fn parameters(&self) -> Option<Vec<[f64; 2]>> {
        let moving = self.lock();
        let inside = |&pair: &[f64; 2]| reduced(&moving.surface, pair);
        (!moving.fixed).then(|| moving.good.iter().map(inside).collect())
    }

    /// How far a parameter in use is from where it started, at most.
    #[must_use]
    pub fn largest_move(&self) -> f64 {
        let moving = self.lock();
        if moving.fixed {
            return 0.0;
        }
        let pairs = moving.good.as_flattened().iter().zip(moving.start.as_flattened());
        pairs.fold(0.0, |most, (t, s)| most.max((t - s).abs()))
    }

    /// An estimate of the smallest eigenvalue met at foot points that were used.
    #[must_use]
    pub fn smallest_eigenvalue(&self) -> Option<f64> {
        self.lock().smallest_eigenvalue
    }

    /// Whether the parameters are those of rows and columns, for good.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.lock().fixed
    }

    /// When the foot points were given up, and why.
    #[must_use]
    pub fn fall_back(&self) -> Option<FallBack> {
        self.lock().fall_back
    }

    fn lock(&self) -> MutexGuard<'_, Moving> {
        self.moving.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl CollocationOperator for SurfaceFootPointCollocation<'_> {
    fn points(&self) -> usize {
        self.assigned.points()
    }

    fn control_points(&self) -> usize {
        self.assigned.control_points()
    }

    /// At the parameters in use.
    fn apply(&self, x: &[f64], dimension: usize, result: &mut [f64]) {
        let moving = self.lock();
        if moving.calls == 0 || moving.fixed {
            self.assigned.apply(x, dimension, result);
        } else {
            moving.rows.apply(x, dimension, result);
        }
    }

    /// Moves the parameters to the foot points on the surface of `control` first, unless they were
    /// given up.
    fn difference_vectors(
        &self,
        data: &[f64],
        control: &[f64],
        dimension: usize,
        result: &mut [f64],
    ) -> ResidualNorms {
        let mut moving = self.lock();
        let calls = moving.calls;
        moving.calls += 1;
        if !moving.fixed {
            match moving.follow(data, control, dimension, result, calls) {
                Ok(norms) => return norms,
                Err(reason) => {
                    moving.fixed = true;
                    moving.fall_back = Some(FallBack { iteration: calls, reason });
                }
            }
        }
        self.assigned.difference_vectors(data, control, dimension, result)
    }

    fn reset(&self) {
        self.lock().reset();
    }
}

/// What changes from call to call.
#[derive(Debug)]
struct Moving {
    rows: ScatteredCollocation,
    surface: Surface,
    layout: NetLayout,
    shape: [usize; 2],
    /// As assigned to rows and columns, row by row.
    start: Vec<[f64; 2]>,
    /// Of the last foot points that could be used. Those of a closed direction count laps.
    good: Vec<[f64; 2]>,
    /// Of the foot points under way.
    next: Vec<[f64; 2]>,
    walk: SurfaceWalk,
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
        calls: usize,
    ) -> Result<ResidualNorms, FallBackReason> {
        self.layout.expand_into(control, dimension, self.surface.control_net_mut());
        self.project(data, dimension, self.global_start && calls == 0);
        self.check_order()?;
        let (surface, next) = (&self.surface, &self.next);
        self.rows
            .collocate(next.iter().map(|&pair| reduced(surface, pair)), surface.knots())
            .map_err(|point| FallBackReason::SchoenbergWhitney { point })?;
        let rows = &self.rows;
        let eigenvalue = self.watch.estimate(self.least_eigenvalue, |x, ax| rows.apply(x, 1, ax));
        if eigenvalue.is_nan() || eigenvalue < self.least_eigenvalue {
            let least = self.least_eigenvalue;
            return Err(FallBackReason::Eigenvalue { eigenvalue, least });
        }
        let norms = rows.difference_vectors(data, control, dimension, result);
        if calls == 0 {
            self.first_residual = norms.max;
        }
        grown(norms.max, self.first_residual, data).map_or(Ok(()), Err)?;
        std::mem::swap(&mut self.good, &mut self.next);
        self.smallest_eigenvalue = Some(self.smallest_eigenvalue.unwrap_or(1.0).min(eigenvalue));
        Ok(norms)
    }

    /// The foot points of the grid, each looked for from the last one.
    fn project(&mut self, data: &[f64], dimension: usize, globally: bool) {
        let periodic = self.surface.is_periodic();
        let [rows, columns] = self.shape;
        let projector = globally.then(|| SurfaceProjector::new(&self.surface));
        let domain = self.surface.domain();
        for (k, point) in data.chunks_exact(dimension).enumerate() {
            // The sides of an open surface stay with the sides of the grid.
            let (i, j) = (k / columns, k % columns);
            let held = [
                !periodic[0] && (i == 0 || i + 1 == rows),
                !periodic[1] && (j == 0 || j + 1 == columns),
            ];
            self.next[k] = self.good[k];
            if held == [false, false]
                && let Some(foot) = projector.as_ref().and_then(|all| all.project(point).ok())
            {
                // On the lap of a closed direction that is nearest to the parameter assigned.
                self.next[k] = [0, 1].map(|d| {
                    let (t, lap) = (foot.parameters[d], domain[d].1 - domain[d].0);
                    let laps = ((self.good[k][d] - t) / lap).round();
                    if periodic[d] { t + laps * lap } else { t }
                });
                continue;
            }
            // Parameters in the domain are never refused.
            if let Ok((pair, _)) = self.walk.descend(&self.surface, point, self.good[k], held) {
                self.next[k] = pair;
            }
        }
    }

    /// Along every row and column, and across the seams.
    fn check_order(&self) -> Result<(), FallBackReason> {
        let [rows, columns] = self.shape;
        let (domain, periodic) = (self.surface.domain(), self.surface.is_periodic());
        let period = [0, 1].map(|k| if periodic[k] { domain[k].1 - domain[k].0 } else { 0.0 });
        for i in 0..rows {
            for j in 0..columns {
                let point = i * columns + j;
                let below = ((i + 1) % rows * columns + j, i + 1 == rows);
                let right = (i * columns + (j + 1) % columns, j + 1 == columns);
                for (k, (next, seam)) in [below, right].into_iter().enumerate() {
                    if seam && !periodic[k] {
                        continue;
                    }
                    let lap = if seam { period[k] } else { 0.0 };
                    let step = |t: &[[f64; 2]]| t[next][k] + lap - t[point][k];
                    let still = step(&self.next) > SMALLEST_GAP * step(&self.start);
                    if !still {
                        return Err(FallBackReason::Order { point, next });
                    }
                }
            }
        }
        Ok(())
    }

    fn reset(&mut self) {
        self.good.copy_from_slice(&self.start);
        self.watch.reset();
        self.calls = 0;
        self.first_residual = f64::INFINITY;
        self.smallest_eigenvalue = None;
        self.fixed = false;
    }
}

/// Parameters inside the domain.
fn reduced(surface: &Surface, pair: [f64; 2]) -> [f64; 2] {
    let (domain, periodic) = (surface.domain(), surface.is_periodic());
    [0, 1].map(|k| inside(pair[k], domain[k], periodic[k]))
}
