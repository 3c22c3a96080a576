//! Uniform closed curves: the matrix is circulant, its eigenvalues are the Fourier symbol
//! `b_0 + 2 sum_j b_j cos(j theta)` of the row of weights, least at `theta = pi`, which an even
//! number of points meets.

use super::super::measure::{closed_uniform, decay_of_inverse};
use super::super::table::{Entry, Part, Source};
use gimfit::collocation::{BandedCollocation, CollocationMatrix, smallest_eigenvalue};
use gimfit::iteration::update::Weighted;

/// Even, so that the largest frequency is met; many times the reach of a data point.
const POINTS: usize = 128;
const RELATIVE: f64 = 1e-12;
/// What rounding leaves of the decay, read off entries of about 1e-5.
const RELATIVE_DECAY: f64 = 1e-9;

/// What theory says of one degree.
struct Degree {
    degree: usize,
    /// Weights from the diagonal outwards, as (numerator, denominator).
    weights: &'static [(u32, u32)],
    /// Smallest eigenvalue, the symbol at pi.
    smallest: (u32, u32),
    /// Largest root inside the unit circle of the polynomial of the weights.
    pole: f64,
    pole_text: &'static str,
}

const DEGREES: [Degree; 6] = [
    Degree {
        degree: 2,
        weights: &[(3, 4), (1, 8)],
        smallest: (1, 2),
        pole: -0.171_572_875_253_81,
        pole_text: "sqrt(8) - 3",
    },
    Degree {
        degree: 3,
        weights: &[(2, 3), (1, 6)],
        smallest: (1, 3),
        pole: -0.267_949_192_431_123,
        pole_text: "sqrt(3) - 2",
    },
    Degree {
        degree: 4,
        weights: &[(115, 192), (19, 96), (1, 384)],
        smallest: (5, 24),
        pole: -0.361_341_225_900_22,
        pole_text: "-0.361341225900",
    },
    Degree {
        degree: 5,
        weights: &[(11, 20), (13, 60), (1, 120)],
        smallest: (2, 15),
        pole: -0.430_575_347_099_974,
        pole_text: "-0.430575347100",
    },
    Degree {
        degree: 6,
        weights: &[(5887, 11520), (10543, 46080), (361, 23040), (1, 46080)],
        smallest: (61, 720),
        pole: -0.488_294_589_303_045,
        pole_text: "-0.488294589303",
    },
    Degree {
        degree: 7,
        weights: &[(151, 315), (397, 1680), (1, 42), (1, 5040)],
        smallest: (17, 315),
        pole: -0.535_280_430_796_438,
        pole_text: "-0.535280430796",
    },
];

pub(super) fn parts() -> anyhow::Result<Vec<Part>> {
    let mut weights = Vec::new();
    let mut rates = Vec::new();
    for theory in &DEGREES {
        let operator = closed_uniform(theory.degree, POINTS)?;
        weight_entries(theory, &operator, &mut weights);
        rate_entries(theory, &operator, &mut rates)?;
    }
    Ok(vec![
        Part::Entries {
            heading: "Uniform closed curves, degree p: weights, the diagonal first".into(),
            source: Source::Theory,
            entries: weights,
        },
        Part::Entries {
            heading:
                "Uniform closed curves, degree p: smallest eigenvalue and what follows from it"
                    .into(),
            source: Source::Theory,
            entries: rates,
        },
    ])
}

fn weight_entries(theory: &Degree, operator: &BandedCollocation, entries: &mut Vec<Entry>) {
    // Any row; one in the middle does not wrap round.
    let row = POINTS / 2;
    for (offset, &fraction) in theory.weights.iter().enumerate() {
        let found = operator.row(row).find(|&(column, _)| column == row + offset);
        let weight = found.map_or(0.0, |(_, weight)| weight);
        let label = format!("p={} weight {offset}", theory.degree);
        entries.push(Entry::known(label, rational(fraction), RELATIVE, weight));
    }
}

fn rate_entries(
    theory: &Degree,
    operator: &BandedCollocation,
    entries: &mut Vec<Entry>,
) -> anyhow::Result<()> {
    let (a, b) = theory.smallest;
    let found = smallest_eigenvalue(&operator.factor(None)?).estimate;
    let mut compare = |what: &str, reference: (String, f64), relative: f64, value: f64| {
        let label = format!("p={} {what}", theory.degree);
        entries.push(Entry::known(label, reference, relative, value));
    };
    compare("lambda_min", rational((a, b)), RELATIVE, found);
    compare("rate of PIA", rational((b - a, b)), RELATIVE, 1.0 - found);
    let weight = Weighted::best_for(found);
    compare("best weight", rational((2 * b, b + a)), RELATIVE, weight);
    compare("rate of weighted PIA", rational((b - a, b + a)), RELATIVE, weight - 1.0);
    let chebyshev = |root: f64| (1.0 - root) / (1.0 + root);
    let exact = chebyshev((f64::from(a) / f64::from(b)).sqrt());
    let reference = (format!("{exact:.12}"), exact);
    compare("rate of Chebyshev", reference, RELATIVE, chebyshev(found.sqrt()));
    let pole = (theory.pole_text.into(), theory.pole);
    compare("pole of the inverse", pole, RELATIVE_DECAY, decay_of_inverse(operator)?);
    Ok(())
}

/// A fraction in lowest terms and its value.
fn rational((numerator, denominator): (u32, u32)) -> (String, f64) {
    let (mut divisor, mut rest) = (numerator, denominator);
    while rest != 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    let divisor = divisor.max(1);
    let text = format!("{}/{}", numerator / divisor, denominator / divisor);
    (text, f64::from(numerator) / f64::from(denominator))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_and_alternate_to_the_smallest_eigenvalue() {
        for theory in &DEGREES {
            let value = |(a, b): (u32, u32)| f64::from(a) / f64::from(b);
            let sum = |sign: f64| {
                let terms = theory.weights.iter().enumerate();
                terms.fold(-value(theory.weights[0]), |sum, (j, &weight)| {
                    sum + 2.0 * sign.powi(j as i32) * value(weight)
                })
            };
            assert!((sum(1.0) - 1.0).abs() < 1e-15);
            assert!((sum(-1.0) - value(theory.smallest)).abs() < 1e-15);
            let at_pole = theory.weights.iter().enumerate().fold(0.0, |sum, (j, &weight)| {
                let power = theory.pole.powi(j as i32);
                sum + value(weight) * if j == 0 { 1.0 } else { power + power.recip() }
            });
            assert!(at_pole.abs() < 1e-12, "{at_pole:e}");
        }
    }

    #[test]
    fn fractions_are_in_lowest_terms() {
        assert_eq!(rational((6, 4)), ("3/2".to_string(), 1.5));
    }
}
