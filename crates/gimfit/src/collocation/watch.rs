//! Follows the smallest eigenvalue of a collocation matrix whose rows move a little from step to
//! step: the vector of one search starts the next, so that a step or two suffice. Allocates nothing
//! after the first call.

use super::spectrum::inverse_step;
use super::{BandedCollocation, EigenvalueBounds, Factorization};

/// Steps of the first search, and of those after it.
const FIRST_STEPS: usize = 40;
const STEPS: usize = 2;
/// Steps while the bounds leave a question open.
const MOST_STEPS: usize = 60;

/// A search that goes on from matrix to matrix.
#[derive(Debug)]
pub(crate) struct EigenvalueWatch {
    vector: Vec<f64>,
    work: Vec<f64>,
    factors: Option<Factorization>,
    started: bool,
}

impl EigenvalueWatch {
    /// For matrices of `points` rows.
    pub(crate) fn new(points: usize) -> Self {
        let (vector, work) = (vec![0.0; points], vec![0.0; points]);
        Self { vector, work, factors: None, started: false }
    }

    /// Forgets the matrices met.
    pub(crate) fn reset(&mut self) {
        self.started = false;
    }

    /// Encloses the smallest eigenvalue of a totally positive band as
    /// [`smallest_eigenvalue`](super::smallest_eigenvalue) does, until it is known on which side of
    /// `floor` it lies. `None` if the matrix is singular.
    pub(crate) fn enclose(
        &mut self,
        matrix: &BandedCollocation,
        floor: f64,
    ) -> Option<EigenvalueBounds> {
        match &mut self.factors {
            Some(factors) => factors.renew(matrix).then_some(())?,
            None => {
                let mut factors = Factorization::of_band(matrix).ok()?;
                // Once more, into memory for every matrix to come.
                factors.renew(matrix).then_some(())?;
                self.factors = Some(factors);
            }
        }
        let least_steps = self.begin(1.0, 1.0);
        let factors = self.factors.as_ref()?;
        let mut bounds =
            EigenvalueBounds { lower: 0.0, estimate: 1.0, upper: 1.0, steps: 0, place: 0 };
        for step in 1..=MOST_STEPS {
            let quotients = inverse_step(factors, &mut self.vector, &mut self.work)?;
            bounds = EigenvalueBounds {
                lower: bounds.lower.max(1.0 / quotients.most).min(1.0),
                estimate: (1.0 / quotients.mean).min(1.0),
                upper: bounds.upper.min(1.0 / quotients.least.max(1.0)),
                steps: step,
                place: quotients.place,
            };
            let decided = bounds.lower >= floor || bounds.upper < floor;
            let enclosed = bounds.upper - bounds.lower <= 1e-3 * bounds.upper;
            if enclosed || (decided && step >= least_steps) {
                break;
            }
        }
        bounds.estimate = bounds.estimate.clamp(bounds.lower, bounds.upper.max(bounds.lower));
        Some(bounds)
    }

    /// Estimates the smallest eigenvalue of any matrix as 1 minus the spectral radius of `I - A`, by
    /// power iteration on a rough vector: right where the eigenvalues lie within 1 of 1 and the one
    /// farthest from 1 is real. An estimate below `floor` is looked at for longer. `apply` writes
    /// `A x` into its second argument.
    pub(crate) fn estimate(
        &mut self,
        floor: f64,
        mut apply: impl FnMut(&[f64], &mut [f64]),
    ) -> f64 {
        let least_steps = self.begin(1.0, -1.0);
        let mut growths = [1.0; STEPS];
        let mut estimate = f64::NAN;
        for step in 0..MOST_STEPS {
            let before = norm(&self.vector);
            apply(&self.vector, &mut self.work);
            self.vector.iter_mut().zip(&self.work).for_each(|(x, ax)| *x -= ax);
            let after = norm(&self.vector);
            if !(before > 0.0 && after > 0.0 && after.is_finite()) {
                // I - A took all of it away.
                return if before.is_finite() { 1.0 } else { f64::NAN };
            }
            self.vector.iter_mut().for_each(|x| *x /= after);
            growths[step % STEPS] = after / before;
            // Of several steps, since modes of opposite sign make single ones alternate.
            estimate = 1.0 - growths.iter().product::<f64>().powf(1.0 / STEPS as f64);
            if step + 1 >= least_steps && estimate >= floor {
                break;
            }
        }
        estimate
    }

    /// Sets the vector up before the first search; returns how many steps to take.
    fn begin(&mut self, even: f64, odd: f64) -> usize {
        if self.started {
            return STEPS;
        }
        self.started = true;
        // Without a period where signs alternate, so that no mode is missed.
        let rough = if odd < 0.0 { 0.1 } else { 0.0 };
        for (j, x) in self.vector.iter_mut().enumerate() {
            *x = if j % 2 == 0 { even } else { odd } + rough * (j * j % 7) as f64;
        }
        FIRST_STEPS
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
