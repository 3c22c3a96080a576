//! Laws of least squares surfaces, judged by full matrices of both directions.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    GridView, LeastSquaresKnots, LeastSquaresMethod as Method, LeastSquaresSurfaceOptions,
    Parameterization, SurfaceFit, Termination, fit_least_squares_surface,
};
use gimfit_testkit::dense::Rows;
use gimfit_testkit::generate::Random;
use gimfit_testkit::{least_squares as oracle, textbook};

/// A wavy sheet with noise.
fn sheet(rows: usize, columns: usize) -> Vec<f64> {
    let mut random = Random::new(5);
    let mut data = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let (x, y) = (i as f64 / 4.0, j as f64 / 5.0);
            data.extend([x, y + 0.1 * x.sin(), x.sin() * y.cos() + 0.01 * random.signed()]);
        }
    }
    data
}

/// The matrix of a direction, repeated control points of a closed one added up.
fn matrix(fit: &SurfaceFit, k: usize) -> Rows {
    let knots = fit.surface.knots()[k].clone();
    let all = textbook::collocation_matrix(knots.values(), knots.degree(), &fit.parameters[k]);
    if !fit.report.closed[k] {
        return all;
    }
    let moving = knots.control_points() - knots.degree();
    all.iter()
        .map(|row| {
            let mut short = row[..moving].to_vec();
            row[moving..].iter().enumerate().for_each(|(j, w)| short[j % moving] += w);
            short
        })
        .collect()
}

/// `A_u^+ Q (A_v^+)^T` of one coordinate.
fn solution(u: &Rows, v: &Rows, q: &Rows) -> Rows {
    let across = oracle::pseudo_inverse_times(u, q);
    oracle::transpose(&oracle::pseudo_inverse_times(v, &oracle::transpose(&across)))
}

#[test]
fn the_limit_is_the_least_squares_fit_of_the_whole_grid() {
    let (rows, columns) = (34, 41);
    let data = sheet(rows, columns);
    let grid = GridView::new([rows, columns], 3, &data).unwrap();
    for (degrees, closed, method) in [
        ([3, 3], [false, false], Method::Auto),
        ([2, 4], [false, true], Method::Auto),
        ([1, 3], [true, false], Method::Pcg),
        ([3, 2], [false, false], Method::ColumnSums),
        ([3, 3], [false, false], Method::Sor),
        ([3, 3], [true, true], Method::Cgls),
    ] {
        let options = LeastSquaresSurfaceOptions {
            degrees,
            closed,
            method,
            iterations: 5000,
            ..LeastSquaresSurfaceOptions::with_control_points([9, 11])
        };
        let fit = fit_least_squares_surface(grid, &options).unwrap();
        assert_eq!(fit.report.run.termination, Termination::Residual, "{method:?}");
        let account = fit.report.run.least_squares.unwrap();
        assert!(account.normal_residual <= fit.report.run.residual_target, "{method:?}");
        let (u, v) = (matrix(&fit, 0), matrix(&fit, 1));
        let mut square = 0.0;
        for c in 0..3 {
            let q: Rows = (0..rows)
                .map(|i| (0..columns).map(|j| data[3 * (i * columns + j) + c]).collect())
                .collect();
            let expected = solution(&u, &v, &q);
            for (i, row) in expected.iter().enumerate() {
                for (j, x) in row.iter().enumerate() {
                    let found = fit.surface.control_net().point(i, j)[c];
                    assert!((found - x).abs() < 1e-9, "{method:?} {i} {j} {c}: {found} {x}");
                }
            }
            let image = gimfit_testkit::dense::multiply(
                &gimfit_testkit::dense::multiply(&u, &expected),
                &oracle::transpose(&v),
            );
            let gaps = q.iter().flatten().zip(image.iter().flatten()).map(|(q, x)| q - x);
            square += gaps.map(|x| x * x).sum::<f64>();
        }
        let rms = (square / (rows * columns) as f64).sqrt();
        assert!((fit.report.run.rms_residual - rms).abs() < 1e-10, "{method:?}");
    }
}

#[test]
fn held_ends_meet_the_corners_and_given_knots_may_leave_gaps() {
    let (rows, columns) = (30, 32);
    let data = sheet(rows, columns);
    let grid = GridView::new([rows, columns], 3, &data).unwrap();
    let held = LeastSquaresSurfaceOptions {
        hold_ends: true,
        ..LeastSquaresSurfaceOptions::with_control_points([8, 8])
    };
    let fit = fit_least_squares_surface(grid, &held).unwrap();
    assert!(fit.report.converged());
    for (i, j) in [(0, 0), (0, columns - 1), (rows - 1, 0), (rows - 1, columns - 1)] {
        let at = fit.surface.evaluate(fit.parameters[0][i], fit.parameters[1][j]).unwrap();
        let gap = at.iter().zip(grid.point(i, j)).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(gap < 1e-12, "{gap:e}");
    }
    // All rows in the first half of the knots' domain.
    let u: Vec<f64> = (0..rows).map(|i| i as f64 / 70.0).collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=8).map(|i| f64::from(i) / 8.0));
    knots.extend([1.0; 3]);
    let gap = LeastSquaresSurfaceOptions {
        parameterizations: [Some(Parameterization::Given(u)), None],
        ..LeastSquaresSurfaceOptions::new([
            LeastSquaresKnots::Given(knots),
            LeastSquaresKnots::ControlPoints(9),
        ])
    };
    let fit = fit_least_squares_surface(grid, &gap).unwrap();
    assert!(fit.report.converged(), "{:?}", fit.report.run.termination);
    assert!(fit.report.run.least_squares.unwrap().unmet_control_points > 0);
    assert!(fit.report.run.rms_residual < 0.2);
}

#[test]
fn hostile_grids_end_in_errors_or_finite_fits() {
    let base = sheet(12, 13);
    let with = |data: &[f64], dimension: usize, counts| {
        let columns = data.len() / 12 / dimension;
        let grid = GridView::new([12, columns], dimension, data).unwrap();
        let options = LeastSquaresSurfaceOptions::with_control_points(counts);
        fit_least_squares_surface(grid, &options)
    };
    let scaled = |factor: f64, origin: f64| -> Vec<f64> {
        base.iter().map(|x| factor * x + origin).collect()
    };
    for data in [scaled(1e300, 0.0), scaled(1e-300, 0.0), scaled(1.0, 1e9), scaled(1.0, 0.0)] {
        let fit = with(&data, 3, [6, 7]).unwrap();
        assert!(fit.report.converged(), "{:?}", fit.report.run);
        let net = fit.surface.control_net().points().coordinates().to_vec();
        assert!(net.iter().all(|x| x.is_finite()));
    }
    assert!(with(&vec![1.0; 12 * 13], 1, [5, 5]).unwrap().report.converged());
    assert!(with(&base, 3, [3, 5]).is_err());
    assert!(with(&base, 3, [13, 5]).is_err());
    assert!(with(&vec![f64::NAN; base.len()], 3, [5, 5]).is_err());
    assert!(with(&vec![2.0; base.len()], 3, [5, 5]).is_err());
    assert!(with(&[], 3, [5, 5]).is_err());
}
