//! Measured rates of four methods on three matrices: what a step leaves of the residual.

use super::super::measure::{closed_uniform, open, rate, smallest_eigenvalue};
use super::super::table::{Entry, Part, Source};
use gimfit::collocation::BandedCollocation;
use gimfit::iteration::UpdateRule;
use gimfit::iteration::update::{GaussSeidel, Jacobi, Pia, Weighted};

const CLOSED_POINTS: usize = 40;
const OPEN_POINTS: usize = 41;

/// Spectral radii of the steps of PIA, weighted PIA, Jacobi-PIA and Gauss-Seidel PIA.
const CLOSED_CUBIC: [&str; 4] = ["0.6666666667", "0.5000000000", "0.5000000000", "0.3272424928"];
const CLOSED_QUADRATIC: [&str; 4] =
    ["0.5000000000", "0.3333333333", "0.3333333333", "0.1935782992"];
const OPEN_CUBIC: [&str; 4] = ["0.7171770367", "0.5590615830", "0.5335664231", "0.2767728895"];

/// What slower modes leave after the measured steps.
const RELATIVE: f64 = 1e-8;

pub(super) fn part() -> anyhow::Result<Part> {
    let steps = (0..OPEN_POINTS).map(|j| j as f64).collect();
    let mut entries = Vec::new();
    for (name, operator, references) in [
        ("closed cubic", closed_uniform(3, CLOSED_POINTS)?, CLOSED_CUBIC),
        ("closed quadratic", closed_uniform(2, CLOSED_POINTS)?, CLOSED_QUADRATIC),
        ("open cubic", open(3, steps)?, OPEN_CUBIC),
    ] {
        let rates = measured(&operator)?;
        for ((method, found), reference) in rates.into_iter().zip(references) {
            let label = format!("{name}, {method}");
            let reference = (reference.to_string(), reference.parse()?);
            entries.push(Entry::known(label, reference, RELATIVE, found));
        }
    }
    Ok(Part::Entries {
        heading: format!(
            "Measured rates, equal steps, averaged knots: {CLOSED_POINTS} points closed, \
             {OPEN_POINTS} open"
        ),
        source: Source::Independent,
        entries,
    })
}

fn measured(operator: &BandedCollocation) -> anyhow::Result<[(&'static str, f64); 4]> {
    let weight = Weighted::best_for(smallest_eigenvalue(operator)?);
    let measure = |mut rule: Box<dyn UpdateRule + '_>| rate(operator, rule.as_mut());
    Ok([
        ("PIA", measure(Box::new(Pia))),
        ("weighted PIA", measure(Box::new(Weighted::new(weight)))),
        ("Jacobi-PIA", measure(Box::new(Jacobi::new(operator)))),
        ("Gauss-Seidel PIA", measure(Box::new(GaussSeidel::new(operator)))),
    ])
}
