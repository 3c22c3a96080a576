//! Orsi, thesis 2021, Tables 2.1 and 2.2: a lemniscate of 11 points, cubic, uniform parameters,
//! averaged knots; largest residual of plain PIA and of weighted PIA with the best weight. Table 2.4: the
//! same curve by 21 points, knots at the data; plain and adaptive PIA.

use super::measure::{open, smallest_eigenvalue};
use super::table::{Entry, Part, Source, Table};
use anyhow::Context;
use gimfit::{CurveOptions, IterationWeight, KnotPlacement, Method, Parameterization, fit_curve};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const POINTS: usize = 11;
const DIGITS: usize = 6;
/// No coordinate exceeds it.
const LARGEST: f64 = 1.0;

/// As printed: iteration, plain PIA, weighted PIA.
const PRINTED: [(usize, &str, &str); 10] = [
    (0, "1.80322e-1", "1.80322e-1"),
    (1, "7.60106e-2", "6.58704e-2"),
    (2, "3.74101e-2", "2.09819e-2"),
    (3, "2.24277e-2", "1.30520e-2"),
    (4, "1.72547e-2", "6.56173e-3"),
    (5, "1.26188e-2", "3.70432e-3"),
    (10, "2.30600e-3", "1.76206e-4"),
    (20, "7.78212e-5", "4.56456e-7"),
    (30, "2.64605e-6", "1.19103e-9"),
    (50, "3.06023e-9", "8.02918e-15"),
];

/// Below this, a printed residual consists of rounding errors.
const ROUNDING_LEVEL: f64 = 1e-14;

/// Table 2.4 as printed: largest residuals after 0, 1 and 2 steps of plain PIA, steps to the tolerance,
/// and moves of control points.
const PRINTED_2_4: [&str; 3] = ["4.46889e-2", "1.32064e-2", "5.82997e-3"];
const STEPS_2_4: &str = "15";
const MOVES_2_4: &str = "315";
const TOLERANCE_2_4: f64 = 1e-5;

/// Smallest eigenvalue, recomputed independently with 50 digits.
const SMALLEST_EIGENVALUE: &str = "0.279554368556";

pub(super) fn recompute() -> anyhow::Result<Table> {
    let parameters = (0..POINTS).map(|j| j as f64 / (POINTS - 1) as f64).collect();
    let smallest = smallest_eigenvalue(&open(3, parameters)?)?;
    let plain = residuals(Method::Pia, IterationWeight::Auto)?;
    // The best weight to all digits; `Auto` estimates it to about three.
    let best = 2.0 / (1.0 + smallest);
    let weighted = residuals(Method::Weighted, IterationWeight::Same(best))?;
    let column = |heading: &str, residuals: &[f64], printed: fn(usize) -> &'static str| {
        let entries = PRINTED.iter().enumerate().map(|(row, &(k, ..))| {
            let value = residuals.get(k).copied().unwrap_or(f64::NAN);
            let text = printed(row);
            let entry = Entry::printed(format!("k={k}"), text, DIGITS, value, LARGEST);
            match text.parse::<f64>() {
                Ok(printed) if printed < ROUNDING_LEVEL => entry.at_rounding_level(LARGEST),
                _ => entry,
            }
        });
        Part::Entries { heading: heading.into(), source: Source::Paper, entries: entries.collect() }
    };
    let reference = SMALLEST_EIGENVALUE.parse().context("smallest eigenvalue")?;
    let [plain_21, adaptive_21] = table_2_4()?;
    Ok(Table {
        title: "Orsi 2021, Tables 2.1, 2.2 and 2.4, lemniscate, cubic",
        parts: vec![
            column("Largest residual after k steps of plain PIA", &plain, |row| PRINTED[row].1),
            column(
                "Largest residual after k steps of weighted PIA, weight 2 / (1 + lambda_min)",
                &weighted,
                |row| PRINTED[row].2,
            ),
            Part::Text(
                "  The last entry lies close to rounding level (8.09726e-15 in exact arithmetic): its digits\n  \
                 depend on the order of summation, so only its size is judged.\n"
                    .into(),
            ),
            Part::Entries {
                heading: "Smallest eigenvalue of the collocation matrix".into(),
                source: Source::Independent,
                entries: vec![Entry::known(
                    "lambda_min".into(),
                    (SMALLEST_EIGENVALUE.into(), reference),
                    1e-11,
                    smallest,
                )],
            },
            plain_21,
            adaptive_21,
        ],
    })
}

/// Plain and adaptive PIA of 21 points with knots at the data.
fn table_2_4() -> anyhow::Result<[Part; 2]> {
    let points: Vec<[f64; 2]> =
        (0..21).map(|k| f64::from(k) * TAU / 20.0).map(|s| [s.cos(), s.sin() * s.cos()]).collect();
    let run = |method| -> anyhow::Result<_> {
        let options = CurveOptions {
            degree: 3,
            parameterization: Some(Parameterization::Uniform),
            knot_placement: Some(KnotPlacement::AtData),
            method,
            residual: Some(TOLERANCE_2_4),
            ..CurveOptions::default()
        };
        Ok(fit_curve(&points, &options)?.report.run)
    };
    let (plain, adaptive) = (run(Method::Pia)?, run(Method::Adaptive)?);
    let mut entries: Vec<Entry> = PRINTED_2_4
        .iter()
        .zip(&plain.history)
        .map(|(text, entry)| {
            let label = format!("k={}", entry.iteration);
            Entry::printed(label, text, DIGITS, entry.max_residual, LARGEST)
        })
        .collect();
    let (steps, moves) = (plain.iterations as f64, (plain.iterations * points.len()) as f64);
    entries.push(Entry::printed("steps to 1e-5".into(), STEPS_2_4, 2, steps, LARGEST));
    entries.push(Entry::printed("moves".into(), MOVES_2_4, 3, moves, LARGEST));
    let moves = adaptive.updates.map_or(0, |moves| moves.done);
    Ok([
        Part::Entries {
            heading: "Table 2.4: plain PIA of 21 points, knots at the data".into(),
            source: Source::Paper,
            entries,
        },
        Part::Text(format!(
            "  Adaptive PIA to the same residual: {} steps and {moves} moves here. The thesis freezes points\n  \
             in rounds: 18 steps, 150 moves.\n",
            adaptive.iterations
        )),
    ])
}

/// Largest residual before the first step and after every step.
fn residuals(method: Method, weight: IterationWeight) -> anyhow::Result<Vec<f64>> {
    let points: Vec<[f64; 2]> = (0..POINTS)
        .map(|i| -FRAC_PI_2 + i as f64 * PI / 5.0)
        .map(|s| [s.cos(), s.sin() * s.cos()])
        .collect();
    let options = CurveOptions {
        degree: 3,
        parameterization: Some(Parameterization::Uniform),
        knot_placement: Some(KnotPlacement::Averaged),
        method,
        weight,
        iterations: 50,
        residual: Some(0.0),
        ..CurveOptions::default()
    };
    let history = fit_curve(&points, &options)?.report.run.history;
    Ok(history.iter().map(|entry| entry.max_residual).collect())
}
