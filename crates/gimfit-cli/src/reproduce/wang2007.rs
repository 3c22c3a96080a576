//! Wang J., Li Q., Jiang Y., Li J., "Approach algorithm research and theorem proof based on
//! quadratic B-spline curves" (accepted 2007), Table 1: a closed quadratic curve through 7 values
//! at equal steps, the values of the curve at the data in passes 1 to 15.

use super::table::{Entry, Part, Source, Table};
use anyhow::Context;
use gimfit::{
    Curve, CurveFit, CurveOptions, KnotPlacement, Method, Parameterization, PointsView, fit_curve,
};

/// The y coordinates of the design data, i = 1 to 7. x counts the points; the paper sets it aside
/// where the curve closes.
const DATA: [f64; 7] = [6.0, 4.0, 0.0, 5.0, 3.0, -4.0, -6.0];
const LARGEST: f64 = 6.0;

/// Digits of MATLAB's short g format, which drops trailing zeros.
const DIGITS: usize = 5;

/// As printed: passes k = 1 to 15, columns i = 0 to 8.
const PRINTED: [[&str; 9]; 15] = [
    ["-4.25", "4.25", "3.75", "1.125", "4.125", "2.375", "-3.375", "-4.25", "4.25"],
    ["-5.4219", "5.375", "4.0156", "0.42188", "4.7188", "2.875", "-3.9844", "-5.4219", "5.375"],
    ["-5.7793", "5.7695", "4.0293", "0.13867", "4.8926", "3.002", "-4.0527", "-5.7793", "5.7695"],
    ["-5.9094", "5.9111", "4.0188", "0.044434", "4.9556", "3.0205", "-4.041", "-5.9094", "5.9111"],
    ["-5.9611", "5.9641", "4.0103", "0.014313", "4.9808", "3.0158", "-4.0241", "-5.9611", "5.9641"],
    [
        "-5.9828",
        "5.9849",
        "4.0053",
        "0.0046997",
        "4.9914",
        "3.0094",
        "-4.0129",
        "-5.9828",
        "5.9849",
    ],
    ["-5.9922", "5.9934", "4.0026", "0.0015888", "4.9961", "3.005", "-4.0065", "-5.9922", "5.9934"],
    [
        "-5.9964",
        "5.9971",
        "4.0013",
        "0.00055784",
        "4.9982",
        "3.0026",
        "-4.0032",
        "-5.9964",
        "5.9971",
    ],
    [
        "-5.9983",
        "5.9987",
        "4.0006",
        "0.00020481",
        "4.9992",
        "3.0013",
        "-4.0016",
        "-5.9983",
        "5.9987",
    ],
    [
        "-5.9992",
        "5.9994",
        "4.0003",
        "7.8903e-005",
        "4.9996",
        "3.0006",
        "-4.0008",
        "-5.9992",
        "5.9994",
    ],
    [
        "-5.9996",
        "5.9997",
        "4.0001",
        "3.1865e-005",
        "4.9998",
        "3.0003",
        "-4.0004",
        "-5.9996",
        "5.9997",
    ],
    [
        "-5.9998",
        "5.9999",
        "4.0001",
        "1.3422e-005",
        "4.9999",
        "3.0001",
        "-4.0002",
        "-5.9998",
        "5.9999",
    ],
    ["-5.9999", "5.9999", "4", "5.8523e-006", "5", "3.0001", "-4.0001", "-5.9999", "5.9999"],
    ["-6", "6", "4", "2.6204e-006", "5", "3", "-4", "-6", "6"],
    ["-6", "6", "4", "1.1962e-006", "5", "3", "-4", "-6", "6"],
];

/// Entries the paper prints wrongly, as (k, i, why). There are none.
const MISPRINTS: &[(usize, usize, &str)] = &[];

/// The values of pass 3, which are fractions of 8^3: exact in decimals as in doubles.
const EXACT: [f64; 7] =
    [5.76953125, 4.029296875, 0.138671875, 4.892578125, 3.001953125, -4.052734375, -5.779296875];
const EXACT_PASS: usize = 3;

pub(super) fn recompute() -> anyhow::Result<Table> {
    let passes = curve_values(&fit(Parameterization::Uniform)?)?;
    let mut entries = Vec::new();
    for (pass, (printed, values)) in PRINTED.iter().zip(&passes).enumerate() {
        for (i, printed) in printed.iter().enumerate() {
            let k = pass + 1;
            // i = 0 is the last point again, i = 8 the first.
            let value = values[(i + DATA.len() - 1) % DATA.len()];
            let misprint = MISPRINTS.iter().find(|m| (m.0, m.1) == (k, i)).map(|m| m.2);
            entries.push(
                Entry::printed(format!("k={k:<2} i={i}"), printed, DIGITS, value, LARGEST)
                    .misprint(misprint),
            );
        }
    }
    // Unit steps put the knots at half-integers, where every operation is exact.
    let unit_steps = (0..=DATA.len()).map(|j| j as f64).collect();
    let exact = curve_values(&fit(Parameterization::Given(unit_steps))?)?;
    let pass = exact.get(EXACT_PASS - 1).context("pass 3 was not kept")?;
    let exact = EXACT.iter().zip(pass).enumerate().map(|(j, (&reference, &value))| {
        Entry::known(format!("k=3 i={}", j + 1), (reference.to_string(), reference), 0.0, value)
    });
    Ok(Table {
        title: "Wang, Li, Jiang and Li 2007, Table 1",
        parts: vec![
            Part::Entries {
                heading: "Curve at the data in pass k (degree 2, closed, equal steps, plain PIA)"
                    .into(),
                source: Source::Paper,
                entries,
            },
            Part::Entries {
                heading: "Pass 3 in exact binary fractions: equal to the last bit".into(),
                source: Source::Theory,
                entries: exact.collect(),
            },
        ],
    })
}

fn fit(parameterization: Parameterization) -> anyhow::Result<CurveFit> {
    let passes = PRINTED.len();
    let options = CurveOptions {
        degree: 2,
        closed: true,
        parameterization: Some(parameterization),
        knot_placement: Some(KnotPlacement::Averaged),
        method: Method::Pia,
        iterations: passes,
        residual: Some(0.0),
        // The paper counts from 1: its pass k is the fit after k - 1 steps.
        keep: (0..passes).collect(),
        ..CurveOptions::default()
    };
    Ok(fit_curve(PointsView::new(1, &DATA)?, &options)?)
}

/// Values at the data of every fit kept, pass by pass.
fn curve_values(fit: &CurveFit) -> anyhow::Result<Vec<Vec<f64>>> {
    let mut passes = Vec::new();
    for kept in &fit.sequence {
        let curve = Curve::new(fit.curve.knots().clone(), kept.control_points.clone())?;
        let mut values = vec![0.0; fit.parameters.len()];
        for (&t, value) in fit.parameters.iter().zip(&mut values) {
            curve.evaluate_into(t, std::slice::from_mut(value))?;
        }
        passes.push(values);
    }
    Ok(passes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's own recursion in integers: pass k in units of 8^-k.
    #[test]
    fn the_library_gives_what_integers_give() {
        let unit_steps = (0..=DATA.len()).map(|j| j as f64).collect();
        let passes = curve_values(&fit(Parameterization::Given(unit_steps)).unwrap()).unwrap();
        assert_eq!(passes.len(), PRINTED.len());
        let data = DATA.map(|x| x as i64);
        let mut control = data;
        let mut unit = 1;
        for values in &passes {
            let sums: [i64; 7] = std::array::from_fn(|i| {
                control[(i + 6) % 7] + 6 * control[i] + control[(i + 1) % 7]
            });
            for (sum, value) in sums.iter().zip(values) {
                assert_eq!(*sum as f64 / (8 * unit) as f64, *value);
            }
            control = std::array::from_fn(|i| 8 * control[i] + 8 * unit * data[i] - sums[i]);
            unit *= 8;
        }
    }
}
