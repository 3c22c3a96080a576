//! Smallest eigenvalues off the uniform case: open curves, whose ends slow the iteration down, and
//! steps that grow by a constant ratio.

use super::super::measure::{open, smallest_eigenvalue};
use super::super::table::{Entry, Part, Source};

/// Enough points for 12 digits of the limit.
const UNIFORM_POINTS: usize = 100;
/// Degree and smallest eigenvalue of an open curve, averaged knots, equal steps.
const UNIFORM: [(usize, &str); 4] =
    [(2, "0.487035217546"), (3, "0.282822963640"), (4, "0.152767725559"), (5, "0.0822195719943")];

const GRADED_POINTS: usize = 20;
/// Ratio of neighbouring steps and smallest eigenvalues for degrees 2 to 5.
const GRADED: [(f64, [&str; 4]); 3] = [
    (2.0, ["0.4090294187", "0.161728793", "0.04683934885", "0.00938360114"]),
    (3.0, ["0.3319988723", "0.08429567084", "0.01146741099", "0.000723479634"]),
    (5.0, ["0.2344584033", "0.02830976777", "0.001147840893", "1.292980676e-5"]),
];

/// The references have ten digits or more.
const RELATIVE: f64 = 1e-9;

pub(super) fn parts() -> anyhow::Result<Vec<Part>> {
    let mut uniform = Vec::new();
    for (degree, reference) in UNIFORM {
        let parameters = (0..UNIFORM_POINTS).map(|j| j as f64).collect();
        uniform.push(entry(format!("p={degree}"), degree, reference, parameters)?);
    }
    let mut graded = Vec::new();
    for (ratio, references) in GRADED {
        for (degree, reference) in (2..).zip(references) {
            let label = format!("ratio {ratio} p={degree}");
            graded.push(entry(label, degree, reference, growing_steps(ratio))?);
        }
    }
    Ok(vec![
        Part::Entries {
            heading: format!(
                "Open curves, equal steps, averaged knots: lambda_min for {UNIFORM_POINTS} points \
                 (its limit)"
            ),
            source: Source::Independent,
            entries: uniform,
        },
        Part::Entries {
            heading: format!(
                "Open curves, steps growing by a ratio, averaged knots: lambda_min for \
                 {GRADED_POINTS} points"
            ),
            source: Source::Independent,
            entries: graded,
        },
    ])
}

fn entry(
    label: String,
    degree: usize,
    reference: &str,
    parameters: Vec<f64>,
) -> anyhow::Result<Entry> {
    let found = smallest_eigenvalue(&open(degree, parameters)?)?;
    Ok(Entry::known(label, (reference.into(), reference.parse()?), RELATIVE, found))
}

fn growing_steps(ratio: f64) -> Vec<f64> {
    let mut parameters = vec![0.0];
    let (mut t, mut step) = (0.0, 1.0);
    while parameters.len() < GRADED_POINTS {
        t += step;
        step *= ratio;
        parameters.push(t);
    }
    parameters
}
