//! Data in smooth pieces between corners, and the pieces joined again into one curve.

use super::attempt::Attempt;
use super::breaks::knots_of;
use super::polyline::{Polyline, natural_overshoot};
use crate::Error;
use crate::knots::{Boundary, KnotVector};

/// The data points of a piece, corners included.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Shape (points, dimension).
    pub(super) data: Vec<f64>,
    dimension: usize,
    closed: bool,
    /// The abscissa, on [0, 1], where there is one.
    over: Option<Vec<f64>>,
}

impl Piece {
    pub(super) fn polyline(&self) -> Polyline<'_> {
        let Self { data, dimension, closed, over } = self;
        Polyline { data, dimension: *dimension, closed: *closed, over: over.as_deref() }
    }
}

/// Splits at corners, of which points over an abscissa have none; a closed polyline with corners is cut
/// at the first and closes there.
pub(super) fn split(polyline: &Polyline<'_>, corners: &[usize]) -> Vec<Piece> {
    let &Polyline { data, dimension, closed, over } = polyline;
    let points = polyline.points();
    if corners.is_empty() {
        let over = over.map(<[f64]>::to_vec);
        return vec![Piece { data: data.to_vec(), dimension, closed, over }];
    }
    let mut ends: Vec<usize> = corners.to_vec();
    if closed {
        ends.push(corners[0] + points);
    } else {
        ends.insert(0, 0);
        ends.push(points - 1);
    }
    ends.windows(2)
        .map(|pair| Piece {
            data: (pair[0]..=pair[1])
                .flat_map(|j| &data[j % points * dimension..][..dimension])
                .copied()
                .collect(),
            dimension,
            closed: false,
            over: None,
        })
        .collect()
}

/// The pieces as one curve.
pub(super) struct Joined {
    pub(super) knots: KnotVector,
    /// Stored control points.
    pub(super) control: Vec<f64>,
    /// One per data point of all pieces, a corner once.
    pub(super) parameters: Vec<f64>,
    /// What a local interpolant strays.
    pub(super) natural: f64,
}

/// Joins pieces end to end. Their domains are as long as their polylines, so that the speed does not
/// jump without need, [0, 1] in all.
pub(super) fn join(
    found: &[(Piece, Attempt)],
    degree: usize,
    closed: bool,
    dimension: usize,
) -> Result<Joined, Error> {
    let natural =
        found.iter().map(|(piece, _)| natural_overshoot(&piece.polyline())).fold(0.0, f64::max);
    if closed {
        let (_, attempt) = &found[0];
        let knots = knots_of(&attempt.breaks, degree, true)?;
        debug_assert_eq!(knots.boundary(), Boundary::Periodic);
        let stored = knots.control_points() * dimension;
        let control = attempt.control.iter().copied().cycle().take(stored).collect();
        let (start, end) = knots.domain();
        let wrap = |t: &f64| (start + (t - start).rem_euclid(1.0)).clamp(start, end);
        let parameters = attempt.parameters.iter().map(wrap).collect();
        return Ok(Joined { knots, control, parameters, natural });
    }
    let lengths: Vec<f64> = found
        .iter()
        .map(|(piece, _)| {
            let polyline = piece.polyline();
            (0..polyline.legs()).map(|leg| polyline.leg_length(leg)).sum()
        })
        .collect();
    let total: f64 = lengths.iter().sum();
    let mut knots = vec![0.0; degree + 1];
    let mut control: Vec<f64> = Vec::new();
    let mut parameters: Vec<f64> = Vec::new();
    let mut start = 0.0;
    for (index, ((_, attempt), length)) in found.iter().zip(&lengths).enumerate() {
        let last = index + 1 == found.len();
        let share = length / total;
        let end = if last { 1.0 } else { start + share };
        let place = |t: f64| (start + t * (end - start)).clamp(start, end);
        knots.extend(attempt.breaks.iter().map(|&t| place(t)));
        knots.extend(std::iter::repeat_n(end, if last { degree + 1 } else { degree }));
        // The joint belongs to both.
        control.extend_from_slice(&attempt.control[if index == 0 { 0 } else { dimension }..]);
        let from = usize::from(index > 0);
        parameters.extend(attempt.parameters[from..].iter().map(|&t| place(t)));
        start = end;
    }
    Ok(Joined { knots: KnotVector::open(degree, knots)?, control, parameters, natural })
}
