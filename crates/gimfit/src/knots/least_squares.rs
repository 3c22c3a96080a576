//! Knots for fewer control points than data points.

use super::KnotVector;
use super::vector::check_degree;
use crate::parameters::Parameters;
use crate::{Error, memory};

/// Places the knots of a curve of `control_points` control points, at most one per parameter, so that
/// every span holds about as many parameters (The NURBS Book, eq. 9.69). A closed curve's breakpoints
/// start at its first parameter; its repeated control points are not counted.
///
/// # Errors
/// [`Error::TooFewPoints`]; [`Error::WrongCount`] for fewer control points than degree + 1 or more than
/// parameters.
pub fn place_least_squares_knots(
    degree: usize,
    parameters: &Parameters,
    control_points: usize,
) -> Result<KnotVector, Error> {
    check_degree(degree)?;
    let t = parameters.values();
    let count = t.len();
    if count < degree + 1 {
        return Err(Error::TooFewPoints { points: count, degree, needed: degree + 1 });
    }
    let given = control_points;
    if given <= degree {
        return Err(Error::WrongCount {
            what: "control points",
            given,
            expected: degree + 1,
            why: "a curve has at least degree + 1; ask for more, or lower the degree",
        });
    }
    if given > count {
        return Err(Error::WrongCount {
            what: "control points",
            given,
            expected: count,
            why: "least squares takes at most one per data point with a parameter of its own; ask for \
                  fewer, or give the knots",
        });
    }
    match parameters.period() {
        None => {
            let mut knots = memory::with_capacity(given + degree + 1);
            knots.extend(std::iter::repeat_n(t[0], degree + 1));
            let spans = given - degree;
            let d = count as f64 / spans as f64;
            knots.extend((1..spans).map(|j| {
                let place = j as f64 * d;
                let i = (place as usize).clamp(1, count - 1);
                between(t[i - 1], t[i], place - i as f64)
            }));
            knots.extend(std::iter::repeat_n(t[count - 1], degree + 1));
            KnotVector::open(degree, knots)
        }
        Some(period) => {
            let d = count as f64 / given as f64;
            let breakpoint = |j: isize| {
                let laps = j.div_euclid(given as isize);
                let place = j.rem_euclid(given as isize) as f64 * d;
                let i = (place as usize).min(count - 1);
                let next = if i + 1 < count { t[i + 1] } else { t[0] + period };
                between(t[i], next, place - i as f64) + laps as f64 * period
            };
            let p = degree as isize;
            let mut knots: Vec<f64> = (-p..=given as isize + p).map(breakpoint).collect();
            super::placement::keep_from_falling(&mut knots);
            KnotVector::periodic(degree, knots)
        }
    }
}

fn between(a: f64, b: f64, share: f64) -> f64 {
    (1.0 - share) * a + share * b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn knots_are_those_of_the_book() {
        // m + 1 = 5 points there, 2 spans: d = 5 / 2, i = 2, alpha = 1/2.
        let t = Parameters::open(vec![0.0, 1.0, 3.0, 6.0, 10.0]).unwrap();
        let knots = place_least_squares_knots(2, &t, 4).unwrap();
        assert_eq!(knots.values(), [0.0, 0.0, 0.0, 2.0, 10.0, 10.0, 10.0]);
        let whole = place_least_squares_knots(1, &t, 5).unwrap();
        assert_eq!(whole.control_points(), 5);
    }

    #[test]
    fn closed_knots_share_the_parameters_out() {
        let t = Parameters::closed((0..12).map(f64::from).collect(), 12.0).unwrap();
        let knots = place_least_squares_knots(3, &t, 4).unwrap();
        assert_eq!(knots.values()[3..8], [0.0, 3.0, 6.0, 9.0, 12.0]);
    }
}
