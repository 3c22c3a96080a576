//! Geometric interpolation (Maekawa, Matsumoto and Namiki 2007; Lin 2010) on the lemniscate of 11
//! points of `orsi2021`. The 2010 paper prints no numbers; these were recomputed independently with
//! 40 digits, foot points by halving intervals.

use super::table::{Entry, Part, Source, Table};
use anyhow::Context;
use gimfit::{CurveOptions, KnotPlacement, Method, Parameterization, fit_curve};
use std::f64::consts::{FRAC_PI_2, PI};

const POINTS: usize = 11;

/// Iteration, largest residual from the foot points, largest move of a parameter.
const RECOMPUTED: [(usize, &str, &str); 8] = [
    (0, "0.15260093179086", "0.0329220718524"),
    (1, "0.057817621345482", "0.0289317633726"),
    (2, "0.024362567026223", "0.0267700728208"),
    (3, "0.010769106375197", "0.0257150886268"),
    (4, "4.9038593288382e-3", "0.0252232000113"),
    (5, "2.2850273680033e-3", "0.0249978951772"),
    (10, "6.5695964564174e-5", "0.0248096441737"),
    (20, "1.0964686135572e-7", "0.0248046651689"),
];

/// Rounding of coordinates near 1, in the smallest residual.
const RELATIVE: f64 = 1e-8;

pub(super) fn recompute() -> anyhow::Result<Table> {
    let (mut residuals, mut moves) = (Vec::new(), Vec::new());
    for (k, residual, largest_move) in RECOMPUTED {
        let (found, moved) = run(k)?;
        let entry = |text: &str, value| -> anyhow::Result<Entry> {
            let reference = text.parse().context("reference")?;
            Ok(Entry::known(format!("k={k}"), (text.into(), reference), RELATIVE, value))
        };
        residuals.push(entry(residual, found)?);
        moves.push(entry(largest_move, moved)?);
    }
    let part = |heading: &str, entries| Part::Entries {
        heading: heading.into(),
        source: Source::Independent,
        entries,
    };
    Ok(Table {
        title: "Lin 2010: geometric interpolation, lemniscate of 11 points, cubic",
        parts: vec![
            part("Largest residual after k steps of geometric interpolation", residuals),
            part("Largest move of a parameter from where it was assigned", moves),
        ],
    })
}

/// Largest residual and largest move after `steps` steps.
fn run(steps: usize) -> anyhow::Result<(f64, f64)> {
    let points: Vec<[f64; 2]> = (0..POINTS)
        .map(|i| -FRAC_PI_2 + i as f64 * PI / 5.0)
        .map(|s| [s.cos(), s.sin() * s.cos()])
        .collect();
    let options = CurveOptions {
        parameterization: Some(Parameterization::Uniform),
        knot_placement: Some(KnotPlacement::Averaged),
        method: Method::Geometric { global_start: false },
        iterations: steps,
        residual: Some(0.0),
        ..CurveOptions::default()
    };
    let run = fit_curve(&points, &options)?.report.run;
    Ok((run.max_residual, run.foot_points.context("no foot points")?.largest_move))
}
