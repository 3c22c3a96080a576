//! Rules that place knots for interpolation at given parameters.

use super::KnotVector;
use super::vector::check_degree;
use crate::parameters::Parameters;
use crate::{Error, memory};

/// Where the knots stand.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum KnotPlacement {
    /// Each knot is the mean of `p` consecutive parameters (de Boor; The NURBS Book, eq. 9.8). Fits
    /// any parameters. On a closed curve the means run round, so that for equal steps the knots
    /// meet the data for odd degrees and stand midway for even ones.
    #[default]
    Averaged,
    /// Knots at the data but for the `(p - 1) / 2` next to each end: for cubics, no third derivative
    /// jumps at the second and the last but one point. Odd degrees, open curves.
    NotAKnot,
    /// A knot at every parameter. Open curves then have `p - 1` control points too many, which are
    /// tied to the ends, as by Lin, Wang and Dong (2004), section 2. Odd degrees: even ones are
    /// singular on closed curves of an even number of equally spaced points.
    AtData,
    /// Knots at equal steps; for a closed curve of even degree half a step off the first parameter.
    /// Fits only parameters that are about equally spaced.
    Uniform,
    /// None inside: a Bezier curve, whose degree is one less than the number of points. Open curves.
    Bezier,
    /// The caller's full knot vector, `n + p + 1` values; for a closed curve of m points
    /// `m + 2 p + 1` values that repeat with the period.
    Given(Vec<f64>),
}

/// Places the knots of an interpolating curve: as many basis functions as there are parameters
/// (plus the tied ones of [`KnotPlacement::AtData`], or the repeated ones of a periodic curve).
///
/// # Errors
/// [`Error::TooFewPoints`], [`Error::Incompatible`] where the rule does not exist for the degree or
/// for closed curves, and what is wrong with given knots.
pub fn place_knots(
    degree: usize,
    parameters: &Parameters,
    placement: &KnotPlacement,
) -> Result<KnotVector, Error> {
    check_degree(degree)?;
    let points = parameters.values().len();
    if points < degree + 1 {
        return Err(Error::TooFewPoints { points, degree, needed: degree + 1 });
    }
    match parameters.period() {
        None => open(degree, parameters.values(), placement),
        Some(period) => periodic(degree, parameters, period, placement),
    }
}

fn open(degree: usize, t: &[f64], placement: &KnotPlacement) -> Result<KnotVector, Error> {
    let count = t.len();
    let interior: Vec<f64> = match placement {
        KnotPlacement::Averaged => {
            let mut knots = memory::with_capacity(count + degree + 1);
            knots.extend(std::iter::repeat_n(t[0], degree + 1));
            knots.extend((1..count - degree).map(|j| mean(&t[j..j + degree])));
            knots.extend(std::iter::repeat_n(t[count - 1], degree + 1));
            keep_from_falling(&mut knots);
            return KnotVector::open(degree, knots);
        }
        KnotPlacement::NotAKnot => {
            require_odd(degree, "not-a-knot knots")?;
            let skipped = degree.div_ceil(2);
            t[skipped..count - skipped].to_vec()
        }
        KnotPlacement::AtData => {
            require_odd(degree, "knots at the data")?;
            t[1..count - 1].to_vec()
        }
        KnotPlacement::Uniform => {
            let spans = (count - degree) as f64;
            let (first, length) = (t[0], t[count - 1] - t[0]);
            (1..count - degree).map(|i| first + length * (i as f64 / spans)).collect()
        }
        KnotPlacement::Bezier if count == degree + 1 => Vec::new(),
        KnotPlacement::Bezier => {
            return Err(Error::WrongCount {
                what: "points",
                given: count,
                expected: degree + 1,
                why: "degree + 1 for a Bezier curve; choose the degree points - 1, or other knots",
            });
        }
        KnotPlacement::Given(knots) => return given_open(degree, t, knots),
    };
    let mut knots = memory::with_capacity(interior.len() + 2 * (degree + 1));
    knots.extend(std::iter::repeat_n(t[0], degree + 1));
    knots.extend(interior);
    knots.extend(std::iter::repeat_n(t[count - 1], degree + 1));
    KnotVector::open(degree, knots)
}

fn given_open(degree: usize, t: &[f64], knots: &[f64]) -> Result<KnotVector, Error> {
    let expected = t.len() + degree + 1;
    if knots.len() != expected {
        return Err(Error::WrongCount {
            what: "knots",
            given: knots.len(),
            expected,
            why: if knots.len() + 2 == expected {
                "points + degree + 1 for interpolation; repeat the first and the last knot once more"
            } else {
                "points + degree + 1 for interpolation, the repeated end knots included"
            },
        });
    }
    let vector = KnotVector::open(degree, knots.to_vec())?;
    check_domain(&vector, t)?;
    Ok(vector)
}

fn periodic(
    degree: usize,
    parameters: &Parameters,
    period: f64,
    placement: &KnotPlacement,
) -> Result<KnotVector, Error> {
    let t = parameters.values();
    let count = t.len();
    // The parameter of point j on any lap.
    let lap = |j: isize| {
        let laps = j.div_euclid(count as isize);
        t[j.rem_euclid(count as isize) as usize] + laps as f64 * period
    };
    let half = (degree / 2) as isize;
    let breakpoints: Vec<f64> = match placement {
        // Centred at point i for odd degrees, between points i - 1 and i for even ones.
        KnotPlacement::Averaged => {
            (0..count as isize).map(|i| mean_of(degree, |k| lap(i - half + k as isize))).collect()
        }
        KnotPlacement::AtData => {
            require_odd(degree, "knots at the data")?;
            t.to_vec()
        }
        KnotPlacement::Uniform => {
            let step = period / count as f64;
            let offset = if degree % 2 == 1 { 0.0 } else { 0.5 * step };
            let first = parameters.origin() - offset;
            (0..count).map(|i| first + step * i as f64).collect()
        }
        KnotPlacement::Bezier => {
            return Err(Error::Incompatible {
                what: "bezier knots",
                with: "a closed curve",
                why: "a Bezier curve is one open piece",
            });
        }
        KnotPlacement::NotAKnot => {
            return Err(Error::Incompatible {
                what: "not-a-knot knots",
                with: "a closed curve",
                why: "a closed curve has no ends; choose averaged or at-data",
            });
        }
        KnotPlacement::Given(knots) => return given_periodic(degree, t, period, knots),
    };
    let around = |i: isize| {
        let laps = i.div_euclid(count as isize);
        breakpoints[i.rem_euclid(count as isize) as usize] + laps as f64 * period
    };
    let p = degree as isize;
    let mut knots: Vec<f64> = (-p..=count as isize + p).map(around).collect();
    keep_from_falling(&mut knots);
    KnotVector::periodic(degree, knots)
}

fn given_periodic(
    degree: usize,
    t: &[f64],
    period: f64,
    knots: &[f64],
) -> Result<KnotVector, Error> {
    let expected = t.len() + 2 * degree + 1;
    if knots.len() != expected {
        return Err(Error::WrongCount {
            what: "knots",
            given: knots.len(),
            expected,
            why: "points + 2 * degree + 1 for a closed curve: degree spans past both ends",
        });
    }
    let vector = KnotVector::periodic(degree, knots.to_vec())?;
    check_period(&vector, period)?;
    Ok(vector)
}

/// The domain of a closed curve's knots is as long as the period of the parameters.
pub(crate) fn check_period(knots: &KnotVector, period: f64) -> Result<(), Error> {
    let (start, end) = knots.domain();
    if ((end - start) - period).abs() > 1e-9 * period {
        return Err(Error::OutOfRange {
            what: "length of the knots' domain".into(),
            value: end - start,
            rule: "it must equal the period of the parameters",
        });
    }
    Ok(())
}

fn check_domain(knots: &KnotVector, t: &[f64]) -> Result<(), Error> {
    let (start, end) = knots.domain();
    match t.iter().find(|&&t| t < start || t > end) {
        Some(&parameter) => Err(Error::OutsideDomain { parameter, start, end }),
        None => Ok(()),
    }
}

fn require_odd(degree: usize, what: &'static str) -> Result<(), Error> {
    if degree % 2 == 1 {
        return Ok(());
    }
    Err(Error::Incompatible {
        what,
        with: "an even degree",
        why: "they exist for odd degrees; choose averaged knots",
    })
}

/// Means of ascending values ascend, but for the rounding of their sums.
pub(super) fn keep_from_falling(knots: &mut [f64]) {
    let mut highest = f64::NEG_INFINITY;
    for knot in knots {
        highest = highest.max(*knot);
        *knot = highest;
    }
}

/// An averaged knot, from the `p` parameters it is the mean of.
pub(crate) fn mean(values: &[f64]) -> f64 {
    mean_of(values.len(), |k| values[k])
}

fn mean_of(count: usize, value: impl Fn(usize) -> f64) -> f64 {
    (0..count).map(value).sum::<f64>() / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(values: &[f64]) -> Parameters {
        Parameters::open(values.to_vec()).unwrap()
    }

    #[test]
    fn averaged_knots_are_means_of_degree_parameters() {
        let t = parameters(&[0.0, 1.0, 2.0, 4.0, 8.0]);
        let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
        assert_eq!(knots.values(), [0.0, 0.0, 0.0, 0.0, 7.0 / 3.0, 8.0, 8.0, 8.0, 8.0]);
    }

    #[test]
    fn not_a_knot_is_averaged_for_equally_spaced_cubics() {
        let t = parameters(&(0..12).map(f64::from).collect::<Vec<_>>());
        assert_eq!(
            place_knots(3, &t, &KnotPlacement::NotAKnot),
            place_knots(3, &t, &KnotPlacement::Averaged)
        );
    }

    #[test]
    fn knots_at_the_data_leave_degree_minus_one_functions_to_tie() {
        let t = parameters(&(0..9).map(f64::from).collect::<Vec<_>>());
        for degree in [1, 3, 5, 7] {
            let knots = place_knots(degree, &t, &KnotPlacement::AtData).unwrap();
            assert_eq!(knots.control_points(), 9 + degree - 1);
        }
    }

    #[test]
    fn closed_equal_steps_put_knots_at_the_data_or_midway() {
        let t = Parameters::closed((0..6).map(f64::from).collect(), 6.0).unwrap();
        let odd = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
        assert_eq!(odd.values()[3], 0.0);
        let even = place_knots(2, &t, &KnotPlacement::Averaged).unwrap();
        assert_eq!(even.values()[2], -0.5);
        assert_eq!(place_knots(2, &t, &KnotPlacement::Uniform), Ok(even));
    }
}
