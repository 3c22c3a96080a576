//! The closest planar curve whose control polygon keeps the shape of the data: the one that
//! minimises the sum of squared residuals among all whose corners turn as those of the data do.
//!
//! The interpolant itself, if its control polygon has that shape: then the first step reaches it.
//! Otherwise a local minimum, found by a primal-dual interior-point method with a logarithmic
//! barrier at every corner (Nocedal and Wright 2006, chapter 19; Waechter and Biegler 2006): each
//! step is Newton's towards the minimum of `|Q - A P|^2 / 2 - mu sum log c_i`, where `c_i > 0` says
//! that corner i is on its side, cut where the first corner would become straight; `mu` falls by
//! and by. The matrix of such a step is banded, so a step costs as much as there are points.

mod corners;
mod least_squares;
mod normal;
mod start;

use super::{Step, UpdateRule};
use crate::Error;
use crate::collocation::{CollocationMatrix, Factorization};
use crate::iteration::Termination;
use crate::shape::Shape;
use corners::Corners;
use least_squares::LeastSquares;
use normal::SymmetricBand;

/// `mu` per corner, in units of the sum of squares: at first, and its fall from one minimum to the
/// next.
const FIRST_BARRIER: f64 = 0.1;
const BARRIER_FALL: f64 = 0.1;
/// What a step promises, in units of `mu` times the corners, where the next `mu` begins.
const CENTRED: f64 = 0.1;
/// The sum of squares is called least when no more than this share of it can be left to gain.
const LEAST: f64 = 1e-7;
/// The same where rounding ends the search.
const LEAST_AT_ROUNDING: f64 = 1e-5;
/// Share of the promised gain that a step must keep (Armijo 1966).
const ARMIJO: f64 = 1e-4;
const MOST_HALVINGS: usize = 60;
/// A step cut to less than this share of itself is followed by a cautious one.
const SHORT: f64 = 0.1;
/// So many steps in a row, each cut to less than this share or lost in rounding, lead nowhere.
const CRAWLING: f64 = 1e-3;
const MOST_CRAWLING: usize = 12;
/// What is added to the diagonal, in its own units, until the matrix is positive definite.
const RIDGES: [f64; 5] = [0.0, 1e-14, 1e-11, 1e-8, 1e-4];

/// Moves a planar control polygon to the closest fit that keeps a shape.
#[derive(Debug)]
pub struct ClosestConvex {
    shape: Shape,
    whole: Factorization,
    fit: LeastSquares,
    corners: Corners,
    matrix: SymmetricBand,
    /// Newton's step in the order of the unknowns, and its image under A.
    direction: Vec<f64>,
    image: Vec<f64>,
    mu: f64,
    /// The last step was cut short, so that the next one trusts no bend of the constraints.
    cautious: bool,
    /// Steps in a row that were next to nothing.
    crawling: usize,
    /// The sum of squares before the last step.
    squares: f64,
    phase: Phase,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Phase {
    /// Before the first step.
    Fresh,
    /// The interpolant has the shape, and is reached.
    Reached,
    /// It has not; the next step is the first one inside.
    Entering,
    /// On the way to the closest fit.
    Inside,
    Ended(Termination),
}

impl ClosestConvex {
    /// Prepares for points of dimension 2 and a start of this shape.
    ///
    /// # Errors
    /// [`Error::Singular`].
    pub fn new(operator: &dyn CollocationMatrix, shape: Shape) -> Result<Self, Error> {
        let fit = LeastSquares::new(operator, shape.is_closed(), shape.reach());
        let size = 2 * operator.points();
        Ok(Self {
            whole: operator.factor(None)?,
            corners: Corners::of(&shape),
            matrix: fit.normal().clone(),
            fit,
            shape,
            direction: vec![0.0; size],
            image: vec![0.0; size],
            mu: 0.0,
            cautious: false,
            crawling: 0,
            squares: 0.0,
            phase: Phase::Fresh,
        })
    }

    /// The whole step to the interpolant, if that has the shape.
    fn reach(&mut self, control: &[f64], vectors: &mut [f64]) -> bool {
        self.direction.copy_from_slice(vectors);
        self.whole.solve_in_place(&mut self.direction, 2);
        let reached = self.shape.is_kept_after(control, &self.direction, 1.0);
        if reached {
            vectors.copy_from_slice(&self.direction);
        }
        reached
    }

    /// A step towards the minimum of the barrier function. False if there is none that gains.
    fn step_inside(&mut self, control: &[f64], vectors: &mut [f64]) -> bool {
        let squares = 0.5 * dot(vectors, vectors);
        // What rounding of the coordinates makes of it.
        let largest = control.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let noise = f64::EPSILON * largest * vectors.iter().map(|x| x.abs()).sum::<f64>();
        let most = squares / self.corners.len() as f64;
        if self.mu == 0.0 {
            self.mu = FIRST_BARRIER * most;
            self.corners.centre(self.mu);
        }
        if !(self.mu > 0.0 && self.factor()) {
            return false;
        }
        self.fit.descent(vectors, &mut self.image);
        self.corners.add_gradient(self.mu, &self.fit, &mut self.image);
        self.direction.copy_from_slice(&self.image);
        self.matrix.solve_in_place(&mut self.direction);
        let promise = dot(&self.image, &self.direction);
        let mut share = self.corners.look_along(&self.fit, &self.direction);
        self.fit.apply(&self.direction, &mut self.image);
        let (slope, bend) = (dot(vectors, &self.image), dot(&self.image, &self.image));
        // From the order of the unknowns to that of the points; the image has done its part.
        for i in 0..control.len() / 2 {
            let at = self.fit.unknown(i);
            self.image[2 * i..2 * i + 2].copy_from_slice(&self.direction[at..at + 2]);
        }
        let gains = |share: f64| {
            let gain = share * (slope - 0.5 * share * bend) + self.mu * self.corners.gain(share);
            gain >= ARMIJO * share * promise
        };
        let mut halvings = 0;
        while !(gains(share) && self.shape.is_strict_after(control, &self.image, share)) {
            share *= 0.5;
            halvings += 1;
            if halvings > MOST_HALVINGS {
                break;
            }
        }
        let gap = self.mu * self.corners.len() as f64;
        let left = (gap + promise) / squares;
        if halvings > MOST_HALVINGS || self.crawling > MOST_CRAWLING || !promise.is_finite() {
            let least = left <= LEAST_AT_ROUNDING.max(noise / squares);
            self.phase =
                Phase::Ended(if least { Termination::Constrained } else { Termination::Stalled });
            return false;
        }
        for (vector, direction) in vectors.iter_mut().zip(&self.image) {
            *vector = share * direction;
        }
        self.corners.move_multipliers(self.mu, share);
        self.cautious = share < SHORT;
        let stands = (self.squares - squares).abs() <= noise;
        self.squares = squares;
        self.crawling = if share < CRAWLING || stands { self.crawling + 1 } else { 0 };
        if left <= LEAST {
            self.phase = Phase::Ended(Termination::Constrained);
        } else if promise <= CENTRED * gap {
            self.mu *= BARRIER_FALL;
        }
        true
    }

    /// Factors the matrix of Newton's step; where the exact one is not positive definite, one that
    /// is.
    fn factor(&mut self) -> bool {
        let exact = [(false, 0.0)].into_iter().filter(|_| !self.cautious);
        for (convex, ridge) in exact.chain(RIDGES.map(|ridge| (true, ridge))) {
            self.matrix.copy_from(self.fit.normal());
            self.corners.add_second(convex, &self.fit, &mut self.matrix);
            self.matrix.stiffen(ridge);
            if self.matrix.factor() {
                return true;
            }
        }
        false
    }
}

impl UpdateRule for ClosestConvex {
    fn adjust(&mut self, step: Step<'_>, vectors: &mut [f64]) {
        let control = step.control;
        if matches!(self.phase, Phase::Fresh | Phase::Reached) {
            let reached = self.reach(control, vectors);
            self.phase = match (reached, self.phase) {
                (true, _) => Phase::Reached,
                (false, Phase::Fresh) => Phase::Entering,
                // Only rounding can forbid to refine a step that was allowed.
                (false, _) => Phase::Ended(Termination::Stalled),
            };
        }
        let moved = match self.phase {
            Phase::Fresh | Phase::Reached => true,
            Phase::Ended(_) => false,
            Phase::Entering if self.shape.has_flat_corner(control) => {
                self.phase = Phase::Inside;
                start::bulge(&self.shape, control, vectors)
            }
            Phase::Entering | Phase::Inside => {
                self.phase = Phase::Inside;
                self.corners.look(control) && self.step_inside(control, vectors)
            }
        };
        if !moved {
            vectors.fill(0.0);
            if !matches!(self.phase, Phase::Ended(_)) {
                self.phase = Phase::Ended(Termination::Stalled);
            }
        }
    }

    fn is_stuck(&self) -> bool {
        self.phase == Phase::Ended(Termination::Stalled)
    }

    fn ending(&self) -> Option<Termination> {
        match self.phase {
            Phase::Ended(reason) => Some(reason),
            _ => None,
        }
    }

    fn ends_itself(&self) -> bool {
        true
    }

    fn reset(&mut self) {
        self.cautious = false;
        self.crawling = 0;
        self.phase = Phase::Fresh;
        self.mu = 0.0;
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
