//! Lin, Wang and Dong 2004, Table 1, column of Fig. 6: MATLAB's peaks on an 11 x 11 grid by a
//! bicubic surface with knots at the data and tied sides, plain PIA.

use super::table::{Entry, Part, Source, Table};
use gimfit::{
    Convexity, CurveOptions, GridView, KnotPlacement, Method, SurfaceOptions, fit_curve,
    fit_surface,
};

const LINES: usize = 11;
/// No coordinate exceeds it.
const LARGEST: f64 = 10.0;

/// As printed: iteration, error, digits.
const PRINTED: [(usize, &str, usize); 6] = [
    (0, "3.362778e+1", 7),
    (2, "3.5526e-1", 5),
    (3, "2.422128e-1", 7),
    (4, "1.7233e-1", 5),
    (15, "1.528187e-2", 7),
    (30, "1.2695e-3", 5),
];

/// Why an entry differs in its last digit.
const CUT: &str = "the digits that follow were cut off, not rounded";

pub(super) fn recompute() -> anyhow::Result<Table> {
    let points = peaks();
    let grid = GridView::new([LINES, LINES], 3, &points)?;
    let at_data = || Some(KnotPlacement::AtData);
    let options = |iterations| SurfaceOptions {
        knot_placements: [at_data(), at_data()],
        method: Method::Pia,
        residual: Some(0.0),
        iterations,
        ..SurfaceOptions::default()
    };
    let sum: f64 = fit_surface(grid, &options(0))?.residuals().iter().sum();
    let history = fit_surface(grid, &options(30))?.report.run.history;
    let entries = PRINTED.iter().map(|&(k, printed, digits)| {
        let largest = history.get(k).map_or(f64::NAN, |entry| entry.max_residual);
        // The paper's first entry is a sum where all others are a maximum.
        let value = if k == 0 { sum } else { largest };
        let entry = Entry::printed(format!("k={k}"), printed, digits, value, LARGEST);
        if cut_off(printed, digits, value) { entry.misprint(Some(CUT)) } else { entry }
    });
    Ok(Table {
        title: "Lin, Wang and Dong 2004, Table 1, Fig. 6: peaks on 11 x 11 points, bicubic, tied sides",
        parts: vec![
            Part::Entries {
                heading: "Error after k steps of PIA (k = 0: sum of the norms; else their maximum)"
                    .into(),
                source: Source::Paper,
                entries: entries.collect(),
            },
            Part::Entries {
                heading: "Algorithm 1 (convexity): largest residual where it freezes, knots at the data"
                    .into(),
                source: Source::Independent,
                entries: vec![
                    frozen("half an ellipse", "0.0130770053", half_ellipse())?,
                    frozen("a parabola", "0.0020324420", parabola())?,
                ],
            },
            Part::Text(
                "  The paper defines the error as the maximum; its entry for k = 0 is the sum of the norms\n  \
                 (the maximum is 1.868059). The data of Figs. 3 to 5 are not given.\n"
                    .into(),
            ),
        ],
    })
}

/// The residual at which Algorithm 1 ends on some points.
fn frozen(label: &str, reference: &str, points: Vec<[f64; 2]>) -> anyhow::Result<Entry> {
    let options = CurveOptions {
        knot_placement: Some(KnotPlacement::AtData),
        convexity: Some(Convexity::Published { threshold: None }),
        ..CurveOptions::default()
    };
    let found = fit_curve(&points, &options)?.report.run.max_residual;
    Ok(Entry::known(label.into(), (reference.into(), reference.parse()?), 1e-8, found))
}

/// Axes 3 and 1, nine points at equal angles.
fn half_ellipse() -> Vec<[f64; 2]> {
    let angle = |i| std::f64::consts::PI * f64::from(i) / 8.0;
    (0..9).map(angle).map(|a| [3.0 * a.cos(), a.sin()]).collect()
}

fn parabola() -> Vec<[f64; 2]> {
    (0..9).map(|i| -3.0 + 0.75 * f64::from(i)).map(|x| [x, x * x]).collect()
}

/// Whether a printed number is the value with further digits cut off where rounding would have
/// raised the last one.
fn cut_off(printed: &str, digits: usize, value: f64) -> bool {
    let unit = 10_f64.powi(value.abs().log10().floor() as i32 + 1 - digits as i32);
    printed.parse::<f64>().is_ok_and(|printed| {
        let ahead = (value - printed) / unit;
        ahead > 0.5 && ahead < 1.0
    })
}

/// MATLAB's function of that name on [-3, 3] x [-3, 3], row by row.
fn peaks() -> Vec<f64> {
    let step = |i: usize| -3.0 + 6.0 * i as f64 / (LINES - 1) as f64;
    let mut points = Vec::new();
    for (x, y) in (0..LINES).flat_map(|i| (0..LINES).map(move |j| (step(i), step(j)))) {
        let z = 3.0 * (1.0 - x).powi(2) * (-x * x - (y + 1.0).powi(2)).exp()
            - 10.0 * (x / 5.0 - x.powi(3) - y.powi(5)) * (-x * x - y * y).exp()
            - (-(x + 1.0).powi(2) - y * y).exp() / 3.0;
        points.extend([x, y, z]);
    }
    points
}
