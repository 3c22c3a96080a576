//! What a document tells of a basis that is no B-spline. The geometry beside it is the Bezier form,
//! which any evaluator of B-splines knows.

use super::PointRows;
use super::surface::rows;
use gimfit::{BlendingCurve, BlendingSurface, Error};
use serde::{Deserialize, Serialize};

/// The basis of a curve and its control points in it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BlendingData {
    /// Its name: bernstein, wang-ball, said-ball or dp, after the word rational if it has weights.
    pub basis: String,
    /// Weights of a rational basis, one per function; only their ratios count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rational_weights: Option<Vec<f64>>,
    /// The control points.
    pub control_points: PointRows,
}

impl BlendingData {
    /// Takes a curve apart.
    #[must_use]
    pub fn of(curve: &BlendingCurve) -> Self {
        Self {
            basis: curve.basis().name().to_owned(),
            rational_weights: curve.basis().rational_weights().map(<[f64]>::to_vec),
            control_points: curve.control_points().into(),
        }
    }

    /// Refuses another number of points than the geometry has.
    pub(super) fn check(&self, expected: usize, dimension: usize) -> Result<(), Error> {
        check_count(self.control_points.values.len(), expected * dimension)
    }
}

/// The bases of a surface, of u and of v, and its net in them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SurfaceBlendingData {
    /// Their names.
    pub bases: [String; 2],
    /// The rows of the net.
    pub control_points: Vec<PointRows>,
}

impl SurfaceBlendingData {
    /// Takes a surface apart.
    #[must_use]
    pub fn of(surface: &BlendingSurface) -> Self {
        let net = surface.control_net();
        Self {
            bases: surface.bases().each_ref().map(|basis| basis.name().to_owned()),
            control_points: rows(net.points().coordinates(), net.shape()[1], surface.dimension()),
        }
    }

    /// Refuses another number of points than the geometry has.
    pub(super) fn check(&self, expected: usize, dimension: usize) -> Result<(), Error> {
        let given = self.control_points.iter().map(|row| row.values.len()).sum();
        check_count(given, expected * dimension)
    }
}

fn check_count(given: usize, expected: usize) -> Result<(), Error> {
    if given == expected {
        return Ok(());
    }
    Err(Error::WrongCount {
        what: "coordinates of blending control points",
        given,
        expected,
        why: "as many as the geometry has",
    })
}
