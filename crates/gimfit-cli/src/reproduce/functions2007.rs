//! Wang J., Li Q., Jiang Y., Li J., "Approach algorithm research and theorem proof based on
//! quadratic B-spline curves" (accepted 2007), section 5.2: three test functions. The paper shows
//! figures without numbers or sampling, so the intervals are ours and errors are measured.

use super::table::{Entry, Part, ROUNDING_LEVEL, Source, Table, significant};
use gimfit::{
    CurveFit, CurveOptions, KnotPlacement, Method, Parameterization, PointsView, fit_curve,
};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A test function on an interval where its ends meet.
struct Function {
    name: &'static str,
    interval_name: &'static str,
    interval: (f64, f64),
    value: fn(f64) -> f64,
    /// Order of the error between the data, as theory has it.
    order: (&'static str, f64),
}

const FUNCTIONS: [Function; 3] = [
    Function {
        name: "x^2",
        interval_name: "[-1, 1]",
        interval: (-1.0, 1.0),
        value: |x| x * x,
        // The slope jumps where the interval closes.
        order: ("1", 1.0),
    },
    Function {
        name: "1 / (1 + x^2)",
        interval_name: "[-5, 5]",
        interval: (-5.0, 5.0),
        value: |x| 1.0 / (1.0 + x * x),
        order: ("1", 1.0),
    },
    Function {
        name: "sin x",
        interval_name: "[0, 2 pi]",
        interval: (0.0, TAU),
        value: f64::sin,
        // Degree + 1: nothing jumps.
        order: ("3", 3.0),
    },
];

/// Steps from one end of the interval to the other; the last sample closes the curve.
const STEPS: [usize; 3] = [32, 64, 128];
/// Passes shown, counted from 1 as in the paper.
const PASSES: [usize; 6] = [1, 2, 3, 5, 10, 15];
const LAST_PASS: usize = 15;
/// Places per step at which the curve is compared with the function.
const DENSITY: usize = 64;
/// How far orders between the finest samplings may be from their limit.
const ORDER_SLACK: f64 = 0.1;

pub(super) fn recompute() -> anyhow::Result<Table> {
    let mut parts = Vec::new();
    let mut orders = Vec::new();
    let mut halvings = Vec::new();
    for function in &FUNCTIONS {
        let mut block = heading(function)?;
        let mut previous = None;
        for steps in STEPS {
            let errors = at_the_data(function, steps)?;
            let between = between_the_data(function, steps)?;
            let order = previous.map(|coarser: f64| (coarser / between).log2());
            previous = Some(between);
            write!(block, "  {:>7}", steps + 1)?;
            for pass in PASSES {
                let error = errors.get(pass - 1).copied().unwrap_or(f64::NAN);
                write!(block, "  {:>9}", significant_or_rounding(error))?;
            }
            write!(block, "  {:>12}", significant(between, 3))?;
            match order {
                Some(order) => writeln!(block, "  {order:>5.2}")?,
                None => block.push('\n'),
            }
            let label = format!("{}, {} samples", function.name, steps + 1);
            halvings.push(Entry::bounded(label, ("1/2", 0.5), largest_quotient(&errors)));
            if let Some(order) = order
                && steps == STEPS[STEPS.len() - 1]
            {
                let (text, value) = function.order;
                let relative = ORDER_SLACK / value;
                let label = function.name.to_string();
                orders.push(Entry::known(label, (text.into(), value), relative, order));
            }
        }
        parts.push(Part::Text(block));
    }
    parts.push(Part::Entries {
        heading: format!(
            "Error of a pass over that of the pass before, largest of passes 2 to {LAST_PASS} above \
             rounding"
        ),
        source: Source::Theory,
        entries: halvings,
    });
    parts.push(Part::Entries {
        heading: format!("Observed order between the data, within {ORDER_SLACK} of theory"),
        source: Source::Theory,
        entries: orders,
    });
    parts.push(Part::Text(
        "  The paper prints no numbers for this experiment: there is nothing to compare them with.\n"
            .into(),
    ));
    Ok(Table {
        title: "Wang, Li, Jiang and Li 2007, section 5.2, measured: closed curves of degree 2",
        parts,
    })
}

fn heading(function: &Function) -> anyhow::Result<String> {
    let mut text = format!(
        "{} on {}: largest error at the data in pass k, and of the limit between the data\n",
        function.name, function.interval_name
    );
    write!(text, "  {:>7}", "samples")?;
    for pass in PASSES {
        write!(text, "  {:>9}", format!("k={pass}"))?;
    }
    writeln!(text, "  {:>12}  {:>5}", "between", "order")?;
    Ok(text)
}

fn fit(function: &Function, steps: usize, options: CurveOptions) -> anyhow::Result<CurveFit> {
    let (start, end) = function.interval;
    let samples: Vec<f64> = (0..=steps)
        .map(|j| (function.value)(start + (end - start) * (j as f64 / steps as f64)))
        .collect();
    let options = CurveOptions {
        degree: 2,
        closed: true,
        parameterization: Some(Parameterization::Uniform),
        knot_placement: Some(KnotPlacement::Averaged),
        ..options
    };
    Ok(fit_curve(PointsView::new(1, &samples)?, &options)?)
}

/// Largest error at the data, pass by pass.
fn at_the_data(function: &Function, steps: usize) -> anyhow::Result<Vec<f64>> {
    let options = CurveOptions {
        method: Method::Pia,
        iterations: LAST_PASS - 1,
        residual: Some(0.0),
        ..CurveOptions::default()
    };
    let history = fit(function, steps, options)?.report.run.history;
    Ok(history.iter().map(|entry| entry.max_residual).collect())
}

/// Largest difference of function and interpolating curve.
fn between_the_data(function: &Function, steps: usize) -> anyhow::Result<f64> {
    let curve = fit(function, steps, CurveOptions::default())?.curve;
    let (start, end) = function.interval;
    let mut value = [0.0];
    let mut largest = 0.0_f64;
    for t in curve.equal_steps(steps * DENSITY + 1) {
        curve.evaluate_into(t, &mut value)?;
        // The curve's domain starts half a step before the first sample.
        let x = start + (end - start) * t.rem_euclid(1.0);
        largest = largest.max((value[0] - (function.value)(x)).abs());
    }
    Ok(largest)
}

/// Of the passes above rounding level. No function here exceeds 1.
fn largest_quotient(errors: &[f64]) -> f64 {
    let pairs = errors.windows(2).filter(|pair| pair[1] > ROUNDING_LEVEL);
    pairs.map(|pair| pair[1] / pair[0]).fold(0.0, f64::max)
}

fn significant_or_rounding(error: f64) -> String {
    if error <= ROUNDING_LEVEL { "rounding".into() } else { significant(error, 3) }
}
