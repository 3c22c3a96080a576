//! Chen, Wang and Jin 2012: a quartic Wang-Ball curve by plain PIA (Table 1), and a Bezier curve of
//! degree 10 by PIA with a weight per point (Tables 2 and 3).

use super::table::{Entry, Part, Source, Table};
use anyhow::Context;
use gimfit::basis::WangBall;
use gimfit::collocation::{DenseCollocation, all_eigenvalues, interpolation};
use gimfit::diagnosis::{diagnose, dominates};
use gimfit::knots::place_knots;
use gimfit::parameters::Parameters;
use gimfit::{
    BlendingOptions, CurveOptions, IterationWeight, KnotPlacement, Method, Parameterization,
    fit_blending_curve, fit_curve,
};
use std::f64::consts::PI;
use std::fmt::Write;
use std::sync::Arc;

const EIGENVALUES: [(&str, usize); 5] =
    [("1", 4), ("1", 4), ("0.4299", 4), ("0.1875", 4), ("0.0545", 3)];
/// The scaling of columns that the paper gives.
const SCALING: [f64; 5] = [0.01, 1.0, 1.1, 1.0, 0.01];

/// Steps and printed largest residuals.
const HALF_CIRCLE: [(usize, &str); 5] =
    [(0, "5.732e-1"), (1, "3.297e-1"), (5, "3.992e-2"), (10, "9.603e-3"), (20, "2.521e-3")];

/// Steps, then the errors at points 1 to 9 as printed.
type Row = (usize, [&'static str; 9]);

/// Weights 0.3 + 0.01 i.
const TABLE_2: [Row; 3] = [
    (
        10,
        [
            "5.301e-2", "1.290e-1", "1.177e-1", "2.401e-1", "6.701e-3", "2.279e-1", "1.108e-1",
            "1.170e-2", "3.381e-2",
        ],
    ),
    (
        30,
        [
            "3.461e-2", "8.162e-2", "6.203e-3", "1.040e-1", "1.813e-3", "1.007e-1", "5.501e-3",
            "7.602e-2", "3.436e-2",
        ],
    ),
    (
        50,
        [
            "3.003e-2", "5.121e-2", "9.312e-3", "6.632e-2", "1.422e-3", "6.401e-2", "7.506e-3",
            "4.493e-2", "2.501e-2",
        ],
    ),
];

/// Weights 0.78 + 0.01 i.
const TABLE_3: [Row; 3] = [
    (
        10,
        [
            "3.171e-2", "9.522e-2", "1.912e-2", "1.279e-1", "1.002e-3", "1.259e-1", "1.810e-2",
            "9.291e-2", "3.352e-2",
        ],
    ),
    (
        30,
        [
            "1.862e-2", "2.934e-2", "1.163e-2", "4.650e-2", "5.013e-4", "4.561e-2", "1.103e-2",
            "2.671e-2", "1.642e-2",
        ],
    ),
    (
        50,
        [
            "5.011e-3", "5.123e-3", "1.321e-2", "2.415e-2", "0.001e-0", "2.372e-2", "1.332e-2",
            "3.626e-3", "4.009e-3",
        ],
    ),
];

/// Recomputed independently of this library, to the digits given: Table 2 after 30 steps, Table 3
/// after 50.
const INDEPENDENT_2: [(&str, usize); 9] = [
    ("0.034646", 5),
    ("0.081427", 5),
    ("0.0060178", 5),
    ("0.103676", 6),
    ("0.0018891", 5),
    ("0.100260", 6),
    ("0.0053246", 5),
    ("0.075663", 5),
    ("0.0342001", 6),
];
const INDEPENDENT_3: [(&str, usize); 9] = [
    ("4.9409e-3", 5),
    ("4.8461e-3", 5),
    ("1.31928e-2", 6),
    ("2.38986e-2", 6),
    ("2.537e-5", 4),
    ("2.34464e-2", 6),
    ("1.33546e-2", 6),
    ("3.3310e-3", 5),
    ("3.8936e-3", 5),
];

/// Why entries are printed wrongly, as (table, steps, point, reason).
const MISPRINTS: [(usize, usize, usize, &str); 2] = [
    (2, 10, 8, "the exponent must be -1, as at its mirror image, point 2"),
    (3, 50, 5, "no number in the form of the others; by symmetry it is almost 0"),
];

pub(super) fn recompute() -> anyhow::Result<Table> {
    let mut parts = vec![eigenvalues()?, half_circle()?, singular_value()?];
    let tables = [(2, 0.3, TABLE_2, INDEPENDENT_2, 30), (3, 0.78, TABLE_3, INDEPENDENT_3, 50)];
    let mut closest = String::from(
        "  Entries that cannot be met: no step of the method gives the digits printed. Each row beside\n  \
         the step that comes closest to it:\n",
    );
    for (table, first, printed, independent, known) in tables {
        let mut entries = Vec::new();
        for (steps, row) in printed {
            let errors = weighted(first, steps)?;
            let misprint =
                |point| MISPRINTS.iter().find(move |m| (m.0, m.1, m.2) == (table, steps, point));
            let (nearest, miss) = nearest(first, steps, &row, |point| misprint(point).is_none())?;
            writeln!(
                closest,
                "  Table {table}, k={steps}: step {nearest}, off by {:.1}% at most",
                100.0 * miss
            )?;
            for (point, (printed, error)) in (1..).zip(row.iter().zip(&errors[1..])) {
                let entry = Entry::printed(format!("k={steps} P_{point}"), printed, 4, *error, 1.0)
                    .misprint(misprint(point).map(|m| m.3));
                entries.push(if miss <= FAR { entry.cannot_be_met() } else { entry });
            }
        }
        parts.push(Part::Entries {
            heading: format!("Table {table}: errors at the points, weights {first} + 0.01 i"),
            source: Source::Paper,
            entries,
        });
        let errors = weighted(first, known)?;
        let entries = (1..).zip(independent.iter().zip(&errors[1..])).map(
            |(point, ((text, digits), error))| {
                Entry::printed(format!("k={known} P_{point}"), text, *digits, *error, 1.0)
            },
        );
        parts.push(Part::Entries {
            heading: format!("The same after {known} steps, recomputed by another program"),
            source: Source::Independent,
            entries: entries.collect(),
        });
    }
    parts.push(Part::Text(closest));
    Ok(Table {
        title: "Chen, Wang and Jin 2012, Tables 1 to 3: Wang-Ball curve; weights per point",
        parts,
    })
}

/// The step around `steps` whose errors come closest to a printed row, and the largest share by
/// which an entry that counts is off.
fn nearest(
    first: f64,
    steps: usize,
    printed: &[&str; 9],
    counts: impl Fn(usize) -> bool,
) -> anyhow::Result<(usize, f64)> {
    let mut best = (steps, f64::INFINITY);
    for k in steps.saturating_sub(2)..=steps + 2 {
        let errors = weighted(first, k)?;
        let mut miss = 0.0_f64;
        for (point, (printed, error)) in (1..).zip(printed.iter().zip(&errors[1..])) {
            let printed: f64 = printed.parse()?;
            if counts(point) {
                miss = miss.max((printed - error).abs() / error);
            }
        }
        if miss < best.1 {
            best = (k, miss);
        }
    }
    Ok(best)
}

/// Share by which the entries of a printed row may miss a step's and still be told as its.
const FAR: f64 = 0.1;

fn steps_on(count: usize) -> anyhow::Result<Parameters> {
    let last = (count - 1) as f64;
    Ok(Parameters::open((0..count).map(|i| i as f64 / last).collect())?)
}

fn eigenvalues() -> anyhow::Result<Part> {
    let matrix = DenseCollocation::new(&WangBall::new(4)?, &steps_on(5)?)?;
    let found = all_eigenvalues(&matrix)?.context("no eigenvalues")?;
    let mut entries: Vec<Entry> = (1..)
        .zip(EIGENVALUES.iter().zip(found))
        .map(|(i, ((printed, digits), value))| {
            Entry::printed(format!("lambda_{i}"), printed, *digits, value.re, 1.0)
        })
        .collect();
    let dominant = f64::from(u8::from(dominates(&matrix, &SCALING)));
    entries.push(Entry::printed("W X dominant (1: yes)".into(), "1", 1, dominant, 1.0));
    Ok(Part::Entries {
        heading: "Example 1: quartic Wang-Ball basis at i/4; X = diag(0.01, 1, 1.1, 1, 0.01)"
            .into(),
        source: Source::Paper,
        entries,
    })
}

fn half_circle() -> anyhow::Result<Part> {
    let points: Vec<[f64; 2]> =
        (0..5).map(|i| f64::from(i) * PI / 4.0).map(|s| [s.cos(), s.sin()]).collect();
    let options = BlendingOptions {
        method: Method::Pia,
        iterations: 20,
        residual: Some(0.0),
        ..Default::default()
    };
    let fit = fit_blending_curve(&points, Arc::new(WangBall::new(4)?), &options)?;
    let entries = HALF_CIRCLE.into_iter().map(|(step, printed)| {
        let found = fit.report.run.history[step].max_residual;
        let entry = Entry::printed(format!("k={step}"), printed, 4, found, 1.0);
        if step >= 10 { entry.cannot_be_met() } else { entry }
    });
    Ok(Part::Entries {
        heading: "Table 1: half circle, quartic Wang-Ball, largest error after k steps of PIA"
            .into(),
        source: Source::Paper,
        entries: entries.collect(),
    })
}

fn singular_value() -> anyhow::Result<Part> {
    let steps = steps_on(11)?;
    let knots = place_knots(10, &steps, &KnotPlacement::Averaged)?;
    let matrix = interpolation(&steps, &knots)?.operator;
    let (_, sigma) = diagnose(&matrix, None, None)?.largest_singular_value;
    Ok(Part::Entries {
        heading: "Example 2: Bernstein basis of degree 10 at i/10".into(),
        source: Source::Paper,
        entries: vec![
            Entry::printed("sigma_max".into(), "1.101", 4, sigma, 1.0),
            Entry::printed("1 / sigma_max".into(), "0.908", 3, 1.0 / sigma, 1.0),
        ],
    })
}

/// Errors at the 11 points of a lemniscate after some steps with weights `first + 0.01 i`.
fn weighted(first: f64, steps: usize) -> anyhow::Result<Vec<f64>> {
    let points: Vec<[f64; 2]> = (0..11)
        .map(|i| -PI / 2.0 + f64::from(i) * PI / 5.0)
        .map(|s| [s.cos(), s.sin() * s.cos()])
        .collect();
    // Eleven points and degree 10 leave no inner knots: a Bezier curve.
    let options = CurveOptions {
        degree: 10,
        parameterization: Some(Parameterization::Uniform),
        method: Method::Weighted,
        weight: IterationWeight::PerPoint((0..11).map(|i| first + 0.01 * f64::from(i)).collect()),
        iterations: steps,
        residual: Some(0.0),
        ..Default::default()
    };
    Ok(fit_curve(&points, &options)?.residuals())
}
