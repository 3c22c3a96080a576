//! Values over an abscissa: parameters that stay.

use super::options::{ApproximationOptions, Corners};
use super::polyline::{Polyline, distance};
use crate::Error;
use crate::knots::{Boundary, KnotVector};

/// The abscissa of the points.
#[derive(Debug, Clone)]
pub(super) struct Abscissa {
    /// One per point, never falling.
    pub(super) values: Vec<f64>,
    /// Where it ends; of a closed curve that is where it begins again.
    end: f64,
    /// What a report calls it.
    pub(super) name: &'static str,
}

impl Abscissa {
    /// On [0, 1].
    pub(super) fn unit(&self) -> Vec<f64> {
        let start = self.values[0];
        self.values.iter().map(|x| (x - start) / (self.end - start)).collect()
    }

    /// Knots over [0, 1], over the abscissa.
    pub(super) fn knots(&self, unit: &KnotVector) -> Result<KnotVector, Error> {
        let start = self.values[0];
        // Rounding keeps the order, and the ends exactly.
        let place = |&t: &f64| match unit.boundary() {
            Boundary::Open if t >= 1.0 => self.end,
            Boundary::Open => (start + t * (self.end - start)).min(self.end),
            Boundary::Periodic => start + t * (self.end - start),
        };
        let values = unit.values().iter().map(place).collect();
        match unit.boundary() {
            Boundary::Open => KnotVector::open(unit.degree(), values),
            Boundary::Periodic => KnotVector::periodic(unit.degree(), values),
        }
    }
}

/// The two points farthest apart of those that share an abscissa, and how far they are apart: half of
/// that is as close as any curve comes.
pub(super) fn widest_at_one(polyline: &Polyline<'_>) -> Option<([usize; 2], f64)> {
    let over = polyline.over?;
    let mut widest: Option<([usize; 2], f64)> = None;
    let mut first = 0;
    for j in 1..over.len() {
        if over[j] != over[first] {
            first = j;
        }
        for i in (first..j).rev().take(MOST_COMPARED) {
            let apart = distance(polyline.point(i), polyline.point(j));
            if apart > widest.map_or(0.0, |(_, apart)| apart) {
                widest = Some(([i, j], apart));
            }
        }
    }
    widest
}

/// Points before one that it is compared with, where many share an abscissa.
const MOST_COMPARED: usize = 64;

/// The abscissa of `given` points, of which the first `count` are fitted, if there is one.
pub(super) fn of(
    options: &ApproximationOptions,
    given: usize,
    count: usize,
    dimension: usize,
    closed: bool,
    choices: &mut Vec<String>,
) -> Result<Option<Abscissa>, Error> {
    let found = match &options.abscissae {
        None if dimension == 1 => {
            choices.push(
                "distances: of the values, each at its place; parameters: uniform, because values of \
                 dimension 1 have no chords"
                    .into(),
            );
            let end = if closed { count } else { count - 1 };
            let values = (0..count).map(|j| j as f64 / end as f64).collect();
            Abscissa { values, end: 1.0, name: "uniform" }
        }
        None => return Ok(None),
        Some(_) if options.closed => {
            return Err(Error::Incompatible {
                what: "a closed curve",
                with: "abscissae",
                why: "nothing says where the first point comes again",
            });
        }
        Some(abscissae) => {
            check(abscissae, given)?;
            choices.push("distances: of the values, each at its abscissa".into());
            let end = abscissae[given - 1];
            Abscissa { values: abscissae.clone(), end, name: "given" }
        }
    };
    if matches!(options.corners, Corners::Angle(_)) {
        return Err(Error::Incompatible {
            what: "corners",
            with: "values over an abscissa",
            why: "their angles depend on the units of both",
        });
    }
    Ok(Some(found))
}

fn check(abscissae: &[f64], given: usize) -> Result<(), Error> {
    if abscissae.len() != given {
        return Err(Error::WrongCount {
            what: "abscissae",
            given: abscissae.len(),
            expected: given,
            why: "one per point",
        });
    }
    if let Some(j) = abscissae.iter().position(|x| !x.is_finite()) {
        return Err(Error::OutOfRange {
            what: format!("abscissa {j}"),
            value: abscissae[j],
            rule: "abscissae must be finite",
        });
    }
    if let Some(j) = (1..given).find(|&j| abscissae[j] < abscissae[j - 1]) {
        return Err(Error::ParametersNotIncreasing {
            index: j,
            value: abscissae[j],
            previous: abscissae[j - 1],
        });
    }
    let length = abscissae[given - 1] - abscissae[0];
    if !(length > 0.0 && length.is_finite()) {
        return Err(Error::OutOfRange {
            what: "length of the abscissa".into(),
            value: length,
            rule: "abscissae must differ, by no more than doubles hold",
        });
    }
    Ok(())
}
