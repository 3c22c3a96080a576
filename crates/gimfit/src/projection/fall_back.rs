//! When geometric interpolation may go on, and why it may not.

use std::fmt;

/// Smallest eigenvalue of the collocation matrix at the foot points that geometric interpolation
/// goes on with by default: the `alpha` of Lin (2010), theorem 1. Below it a thousand steps would leave
/// more than a third of the residual. The theorem asks for some positive one.
pub const SMALLEST_EIGENVALUE: f64 = 1e-3;

/// Share of the step between two parameters, as they were assigned, that must be left of it.
pub(super) const SMALLEST_GAP: f64 = 1e-3;

/// The step at which geometric interpolation gave up moving foot points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FallBack {
    /// The iteration whose foot points could not be used.
    pub iteration: usize,
    /// What they broke.
    pub reason: FallBackReason,
}

/// A condition of the convergence theorem (Lin 2010, theorems 1 and 2) that foot points broke.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FallBackReason {
    /// The parameters no longer rise from a data point to the next, or hardly do.
    Order {
        /// The first of the two data points, from 0; of a grid, row by row.
        point: usize,
        /// The second.
        next: usize,
    },
    /// A data point does not meet its basis function: the matrix is singular (Schoenberg and
    /// Whitney).
    SchoenbergWhitney {
        /// The data point, from 0.
        point: usize,
    },
    /// The smallest eigenvalue fell below the least one allowed.
    Eigenvalue {
        /// What it was found to be.
        eigenvalue: f64,
        /// The least one allowed.
        least: f64,
    },
    /// The largest residual rose above that of the first foot points.
    Growth {
        /// How many times as large it was.
        ratio: f64,
    },
}

/// The reason where a residual exceeds that of the first foot points, by more than rounding: the
/// theorem lets no member of the sequence be worse than the first.
pub(super) fn grown(residual: f64, first: f64, data: &[f64]) -> Option<FallBackReason> {
    if residual <= first {
        return None;
    }
    let size = data.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let explained = residual <= first + 64.0 * f64::EPSILON * size;
    (!explained).then_some(FallBackReason::Growth { ratio: residual / first })
}

impl FallBackReason {
    /// The word used in documents.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Order { .. } => "order",
            Self::SchoenbergWhitney { .. } => "schoenberg-whitney",
            Self::Eigenvalue { .. } => "eigenvalue",
            Self::Growth { .. } => "growth",
        }
    }
}

impl FallBackReason {
    /// The reason as a sentence, where `name` names a data point by its index.
    pub(crate) fn sentence(&self, name: impl Fn(usize) -> String) -> String {
        match *self {
            Self::Order { point, next } => format!(
                "the foot points of the data points {} and {} lost their order",
                name(point),
                name(next)
            ),
            Self::SchoenbergWhitney { point } => format!(
                "the foot point of the data point {} left the support of its basis function",
                name(point)
            ),
            Self::Eigenvalue { eigenvalue, least } => format!(
                "the smallest eigenvalue of the collocation matrix fell to {eigenvalue:.1e}, below \
                 the least allowed, {least:.1e}"
            ),
            Self::Growth { ratio } => format!(
                "the largest residual grew to {ratio:.3} times that of the first foot points"
            ),
        }
    }
}

/// Names data points by their number, from 1; those of a grid row by row.
impl fmt::Display for FallBackReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(|point| format!("number {}", point + 1)))
    }
}
