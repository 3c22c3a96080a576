//! Least squares with constraints against the Karush-Kuhn-Tucker system as one full matrix.

use gimfit::{
    Constraints, CurveEnd, CurveFit, Error, LeastSquaresKnots, LeastSquaresMethod as Method,
    LeastSquaresOptions, fit_least_squares,
};
use gimfit_testkit::dense::Rows;
use gimfit_testkit::generate::Random;
use gimfit_testkit::least_squares::constrained_solution;
use gimfit_testkit::textbook::{basis_derivative, basis_function, collocation_matrix};

const METHODS: [Method; 5] =
    [Method::Auto, Method::Lspia, Method::ColumnSums, Method::Cgls, Method::Pcg];

fn data() -> Vec<[f64; 2]> {
    let mut random = Random::new(7);
    (0..60)
        .map(|i| {
            let x = f64::from(i) / 9.0;
            [x, x.sin() + 0.05 * random.signed()]
        })
        .collect()
}

fn options(constraints: Constraints) -> LeastSquaresOptions {
    LeastSquaresOptions {
        constraints,
        iterations: 20_000,
        ..LeastSquaresOptions::with_control_points(11)
    }
}

/// A row over flat control points: functions times weights of the coordinates.
fn row(functions: impl Fn(usize) -> f64, weights: [f64; 2]) -> Vec<f64> {
    (0..11).flat_map(|i| weights.map(|w| w * functions(i))).collect()
}

fn control(fit: &CurveFit) -> Rows {
    fit.curve.control_points().iter().map(<[f64]>::to_vec).collect()
}

fn distance(a: &Rows, b: &Rows) -> f64 {
    let each = a.iter().flatten().zip(b.iter().flatten());
    each.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn every_method_reaches_the_solution_of_the_full_system() {
    let data = data();
    let constraints = Constraints::new()
        .through(23)
        .tangent(0, &[3.0, 4.0])
        .normal(40, &[1.0, -0.5])
        .derivative(59, 1, &[6.0, 1.0])
        .derivative(59, 2, &[0.0, -2.0])
        .pinned(3, &[1.75, 1.25]);
    for method in METHODS {
        let fit = fit_least_squares(
            &data,
            &LeastSquaresOptions { method, ..options(constraints.clone()) },
        )
        .unwrap();
        assert!(fit.report.converged(), "{method:?}: {:?}", fit.report.run.termination);
        let (u, t) = (fit.curve.knots().values(), &fit.parameters);
        let value = |i: usize, t: f64| basis_function(u, 3, i, t);
        let slope = |i: usize, t: f64| basis_derivative(u, 3, i, t);
        // The second derivative of a cubic is linear on a span: a quotient of slopes is exact but for
        // rounding.
        let bend = |i: usize, t: f64| {
            let h = 1e-2 * t;
            (slope(i, t) - slope(i, t - h)) * 2.0 / h
                - (slope(i, t) - slope(i, t - 2.0 * h)) / (2.0 * h)
        };
        let end = t[59];
        let g = vec![
            row(|i| value(i, t[23]), [1.0, 0.0]),
            row(|i| value(i, t[23]), [0.0, 1.0]),
            row(|i| slope(i, t[0]), [0.8, -0.6]),
            row(|i| slope(i, t[40]), [1.0, -0.5]),
            row(|i| slope(i, end), [1.0, 0.0]),
            row(|i| slope(i, end), [0.0, 1.0]),
            row(|i| bend(i, end), [1.0, 0.0]),
            row(|i| bend(i, end), [0.0, 1.0]),
            row(|i| f64::from(u8::from(i == 3)), [1.0, 0.0]),
            row(|i| f64::from(u8::from(i == 3)), [0.0, 1.0]),
        ];
        let r = [data[23][0], data[23][1], 0.0, 0.0, 6.0, 1.0, 0.0, -2.0, 1.75, 1.25];
        let a = collocation_matrix(u, 3, t);
        let q: Rows = data.iter().map(|q| q.to_vec()).collect();
        let oracle = constrained_solution(&a, &q, &g, &r);
        let off = distance(&control(&fit), &oracle);
        assert!(off < 1e-9, "{method:?} is off by {off:e}");
        // What was demanded holds to rounding, for first-order methods too.
        for (row, r) in g[..6].iter().zip(r) {
            let control = control(&fit);
            let got: f64 = row.iter().zip(control.iter().flatten()).map(|(g, p)| g * p).sum();
            assert!((got - r).abs() < 1e-12, "{method:?}: {got} for {r}");
        }
    }
}

#[test]
fn closed_curves_meet_points_and_tangents() {
    let data: Vec<[f64; 2]> = (0..50)
        .map(|i| {
            let a = f64::from(i) * std::f64::consts::TAU / 50.0;
            [a.cos() * (1.0 + 0.1 * (3.0 * a).sin()), a.sin()]
        })
        .collect();
    for point in [0, 17, 49] {
        let constraints = Constraints::new().through(point).tangent(point, &[1.0, 2.0]);
        let fit =
            fit_least_squares(&data, &LeastSquaresOptions { closed: true, ..options(constraints) })
                .unwrap();
        assert!(fit.report.converged());
        let mut jet = [0.0; 4];
        fit.curve.derivatives_into(fit.parameters[point], 1, &mut jet).unwrap();
        assert!((jet[0] - data[point][0]).hypot(jet[1] - data[point][1]) < 1e-13);
        assert!((2.0 * jet[2] - jet[3]).abs() < 1e-12 * jet[2].hypot(jet[3]));
    }
}

#[test]
fn constraints_that_follow_from_others_are_no_conflict() {
    let data = data();
    let once = options(Constraints::new().through(9).tangent(0, &[1.0, 1.0]));
    let twice = options(
        Constraints::new().through(9).tangent(0, &[1.0, 1.0]).through(9).normal(0, &[1.0, -1.0]),
    );
    let [once, twice] =
        [once, twice].map(|options| control(&fit_least_squares(&data, &options).unwrap()));
    assert!(distance(&once, &twice) < 1e-12);
}

#[test]
fn conflicts_and_nonsense_are_named() {
    let data = data();
    let told = |constraints: Constraints| {
        fit_least_squares(&data, &options(constraints)).unwrap_err().to_string()
    };
    // The first control point is the start of the curve.
    let text = told(Constraints::new().through(30).through(0).pinned(0, &[5.0, 5.0]));
    assert!(text.contains("through point 0, control point 0"), "{text}");
    assert!(!text.contains("point 30"), "{text}");
    let crowded = (20..30).fold(Constraints::new(), Constraints::through);
    assert!(told(crowded).contains("through point 2"));
    assert!(told(Constraints::new().through(60)).contains("no such data point"));
    assert!(told(Constraints::new().pinned(11, &[0.0, 0.0])).contains("no such control point"));
    assert!(told(Constraints::new().tangent(0, &[0.0, 0.0])).contains("no direction"));
    assert!(told(Constraints::new().tangent(0, &[f64::NAN, 0.0])).contains("finite"));
    assert!(told(Constraints::new().normal(0, &[1.0])).contains("coordinates"));
    assert!(told(Constraints::new().derivative(0, 4, &[1.0, 0.0])).contains("degree"));
    assert!(told(Constraints::new().derivative(0, 0, &[1.0, 0.0])).contains("through"));
    let sweeps = LeastSquaresOptions {
        method: Method::GaussSeidel,
        ..options(Constraints::new().through(1))
    };
    assert!(matches!(fit_least_squares(&data, &sweeps), Err(Error::Incompatible { .. })));
}

#[test]
fn scales_far_from_one_are_met_alike() {
    for scale in [1e-200, 1e200] {
        let data: Vec<[f64; 2]> = data().iter().map(|q| q.map(|x| x * scale)).collect();
        let fit = fit_least_squares(&data, &options(Constraints::new().through(23))).unwrap();
        assert!(fit.report.converged());
        let there = fit.curve.evaluate(fit.parameters[23]).unwrap();
        assert!((there[1] - data[23][1]).abs() < 1e-13 * scale);
    }
}

#[test]
fn straight_ends_and_mirrored_curves_are_those_of_the_full_system() {
    let data = data();
    let mut knots = vec![0.0; 4];
    knots.extend((1..8).map(|k| f64::from(k) / 8.0));
    knots.extend([1.0; 4]);
    let t: Vec<f64> = (0..60).map(|j| f64::from(j) / 59.0).collect();
    let a = collocation_matrix(&knots, 3, &t);
    let q: Rows = data.iter().map(|q| q.to_vec()).collect();
    let at = |i: usize, j: usize, s: f64| {
        row(move |k| f64::from(u8::from(k == i)) + s * f64::from(u8::from(k == j)), [1.0, 1.0])
    };
    let only = |mut row: Vec<f64>, weights: [f64; 2]| {
        row.iter_mut().enumerate().for_each(|(k, x)| *x *= weights[k % 2]);
        row
    };
    let straight = (7..10).map(|i| only(at(i + 1, i, -1.0), [2.0, 1.0])).collect::<Rows>();
    let mut mirrored = Rows::new();
    let mut sums = Vec::new();
    for i in 0..5 {
        mirrored.push(only(at(i, 10 - i, 1.0), [1.0, 0.0]));
        mirrored.push(only(at(i, 10 - i, -1.0), [0.0, 1.0]));
        sums.extend([6.0, 0.0]);
    }
    mirrored.push(only(at(5, 5, 0.0), [1.0, 0.0]));
    sums.push(3.0);
    let cases = [
        (Constraints::new().straight_end(CurveEnd::Last, 4, &[1.0, -2.0]), &straight, vec![0.0; 3]),
        (Constraints::new().planar_end(CurveEnd::Last, 4, &[2.0, 1.0]), &straight, vec![0.0; 3]),
        (Constraints::new().mirrored(0, 3.0), &mirrored, sums),
    ];
    for (constraints, g, r) in cases {
        let oracle = constrained_solution(&a, &q, g, &r);
        for method in METHODS {
            let options = LeastSquaresOptions {
                method,
                knots: LeastSquaresKnots::Given(knots.clone()),
                parameterization: Some(gimfit::Parameterization::Given(t.clone())),
                ..options(constraints.clone())
            };
            let fit = fit_least_squares(&data, &options).unwrap();
            let off = distance(&control(&fit), &oracle);
            assert!(off < 1e-9, "{method:?} is off by {off:e}");
        }
        let closed = LeastSquaresOptions { closed: true, ..options(constraints) };
        let error = fit_least_squares(&data, &closed).unwrap_err();
        assert!(error.to_string().contains("closed curve"), "{error}");
    }
    let error = fit_least_squares(&data, &options(Constraints::new().mirrored(0, 3.0)));
    assert!(error.unwrap_err().to_string().contains("symmetric knots"));
}
