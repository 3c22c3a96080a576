//! Laws that every fit obeys, judged by dense oracles that share no code with the library.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::collocation::{CollocationMatrix, interpolation, smallest_eigenvalue};
use gimfit::knots::place_knots;
use gimfit::parameters::{Parameters, assign_parameters};
use gimfit::{
    CurveFit, CurveOptions, Duplicates, Error, IterationWeight, KnotPlacement, Method,
    Parameterization, Points, Termination, fit_curve,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::{Random, graded, helix, random_walk};
use gimfit_testkit::textbook;

fn points(rows: &Rows) -> Points {
    Points::new(rows[0].len(), rows.concat()).unwrap()
}

fn rows(points: &Points) -> Rows {
    points.iter().map(<[f64]>::to_vec).collect()
}

fn fit(data: &Rows, options: &CurveOptions) -> CurveFit {
    fit_curve(&points(data), options).unwrap()
}

/// Largest distance of a data point from the curve at its parameter, by the textbook recursion.
fn textbook_residual(data: &Rows, fit: &CurveFit) -> f64 {
    let knots = fit.curve.knots().values();
    let control = rows(fit.curve.control_points());
    data.iter().zip(&fit.parameters).fold(0.0, |worst: f64, (point, &t)| {
        let on_curve = textbook::curve_point(knots, fit.curve.degree(), &control, t);
        let gap: f64 = point.iter().zip(&on_curve).map(|(a, b)| (a - b).powi(2)).sum();
        worst.max(gap.sqrt())
    })
}

fn close(a: &Rows, b: &Rows, tolerance: f64) -> bool {
    a.len() == b.len()
        && a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() <= tolerance)
}

fn placements(degree: usize, closed: bool) -> Vec<KnotPlacement> {
    let mut list = vec![KnotPlacement::Averaged];
    if degree % 2 == 1 {
        list.push(KnotPlacement::AtData);
        if !closed {
            list.push(KnotPlacement::NotAKnot);
        }
    }
    list
}

#[test]
fn the_limit_interpolates_for_every_degree_knots_and_boundary() {
    for degree in 1..=9 {
        for closed in [false, true] {
            for placement in placements(degree, closed) {
                for (seed, count) in [(1, degree + 1), (2, degree + 2), (3, 24), (4, 57)] {
                    let data = random_walk(seed, count, 3);
                    let options = CurveOptions {
                        degree,
                        closed,
                        knot_placement: Some(placement.clone()),
                        ..Default::default()
                    };
                    let fit = fit(&data, &options);
                    let case = format!("{degree} {closed} {placement:?} {count}");
                    assert_eq!(fit.report.run.termination, Termination::Residual, "{case}");
                    let largest = rows(fit.curve.control_points())
                        .concat()
                        .iter()
                        .fold(0.0_f64, |m, x| m.max(x.abs()));
                    let residual = textbook_residual(&data, &fit);
                    assert!(
                        residual <= 1e-13 * largest.max(fit.report.run.extent),
                        "{case}: {residual:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_limit_is_the_dense_solution() {
    let data = random_walk(11, 40, 2);
    let t = textbook::chord_parameters(&data);
    for degree in [1, 2, 3, 4, 5] {
        let knots = textbook::averaged_knots(degree, &t);
        let expected = dense::solve(&textbook::collocation_matrix(&knots, degree, &t), &data);
        let options = CurveOptions { degree, ..Default::default() };
        let found = fit(&data, &options);
        let size = dense::largest_norm(&expected);
        assert!(close(&rows(found.curve.control_points()), &expected, 1e-12 * size), "{degree}");
    }
}

#[test]
fn residual_histories_are_those_of_dense_iterations() {
    let data = random_walk(5, 30, 3);
    let t = textbook::chord_parameters(&data);
    let cases: [(Method, dense::Step); 3] = [
        (Method::Pia, dense::pia_step),
        (Method::Jacobi, dense::jacobi_step),
        (Method::GaussSeidel, dense::gauss_seidel_step),
    ];
    for degree in [2, 3, 5] {
        let knots = textbook::averaged_knots(degree, &t);
        let matrix = textbook::collocation_matrix(&knots, degree, &t);
        for (method, step) in cases {
            let options = CurveOptions {
                degree,
                method,
                residual: Some(0.0),
                iterations: 25,
                ..Default::default()
            };
            let found = fit(&data, &options);
            let expected = dense::residual_history(&matrix, &data, step, 25);
            assert_eq!(found.report.run.history.len(), 26);
            for (entry, expected) in found.report.run.history.iter().zip(&expected) {
                let gap = (entry.max_residual - expected).abs();
                assert!(
                    gap <= 1e-12 * found.report.run.extent.max(*expected),
                    "{method:?} {degree}"
                );
            }
        }
    }
}

#[test]
fn kept_fits_are_the_iterates_of_pia() {
    let data = random_walk(6, 20, 2);
    let t = textbook::chord_parameters(&data);
    let matrix = textbook::collocation_matrix(&textbook::averaged_knots(3, &t), 3, &t);
    for method in [Method::Pia, Method::Auto] {
        let keep = vec![0, 2, 4, 15];
        let found = fit(&data, &CurveOptions { method, keep, ..Default::default() });
        let mut p = data.clone();
        let mut step = 0;
        assert_eq!(found.sequence.len(), 4);
        for kept in &found.sequence {
            while step < kept.entry.iteration {
                p = dense::pia_step(&matrix, &data, &p);
                step += 1;
            }
            assert!(close(&rows(&kept.control_points), &p, 1e-12 * found.report.run.extent));
        }
        assert!(found.report.converged());
    }
}

#[test]
fn preconditioning_without_a_band_is_pia() {
    let data = random_walk(8, 33, 2);
    for closed in [false, true] {
        let run = |method| {
            let options = CurveOptions {
                method,
                closed,
                iterations: 12,
                residual: Some(0.0),
                ..Default::default()
            };
            rows(fit(&data, &options).curve.control_points())
        };
        let none = run(Method::Preconditioned { half_bandwidth: Some(0) });
        assert!(close(&none, &run(Method::Pia), 1e-12));
        let partly = run(Method::Preconditioned { half_bandwidth: Some(1) });
        assert!(!close(&partly, &none, 1e-6));
    }
}

#[test]
fn every_method_reaches_the_same_limit() {
    let data = random_walk(9, 80, 3);
    for closed in [false, true] {
        let run = |method, weight: IterationWeight| {
            let options =
                CurveOptions { method, closed, weight, iterations: 20_000, ..Default::default() };
            let found = fit(&data, &options);
            assert!(found.report.converged(), "{method:?} {}", found.report.run.termination);
            (rows(found.curve.control_points()), found.report.run.iterations)
        };
        let (limit, _) = run(Method::Auto, IterationWeight::Auto);
        let (_, plain) = run(Method::Pia, IterationWeight::Auto);
        let faster = [
            Method::Weighted,
            Method::GaussSeidel,
            Method::Sor,
            Method::Chebyshev,
            Method::Anderson { memory: None },
        ];
        for method in faster {
            let (control, iterations) = run(method, IterationWeight::Auto);
            assert!(close(&control, &limit, 1e-8), "{method:?}");
            assert!(iterations < plain, "{method:?} took {iterations}, PIA {plain}");
        }
        let uneven: Vec<f64> = (0..80).map(|j| 0.4 + 0.02 * f64::from(j % 70)).collect();
        let (control, _) = run(Method::Weighted, IterationWeight::PerPoint(uneven));
        assert!(close(&control, &limit, 1e-8));
    }
}

#[test]
fn spectra_of_uniform_closed_curves_are_the_published_ones() {
    // Smallest symbol of the uniform B-spline of degree 2 to 7 (methods of Fourier analysis).
    let published = [1.0 / 2.0, 1.0 / 3.0, 5.0 / 24.0, 2.0 / 15.0, 61.0 / 720.0, 17.0 / 315.0];
    for (degree, expected) in (2..).zip(published) {
        let t = Parameters::closed((0..64).map(f64::from).collect(), 64.0).unwrap();
        let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
        let factors = interpolation(&t, &knots).unwrap().operator.factor(None).unwrap();
        let found = smallest_eigenvalue(&factors);
        assert!((found.estimate - expected).abs() < 1e-12, "{degree}: {found:?}");
    }
}

#[test]
fn the_smallest_eigenvalue_lies_within_its_bounds() {
    // The eigenvalue by power iteration on the dense inverse, long enough to converge.
    let data = random_walk(21, 25, 2);
    let t = assign_parameters(points(&data).as_view(), false, &Parameterization::Chord).unwrap();
    for degree in [2, 3, 4] {
        let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
        let matrix = textbook::collocation_matrix(knots.values(), degree, t.values());
        let mut x: Rows = (0..25).map(|j| vec![if j % 2 == 0 { 1.0 } else { -1.0 }]).collect();
        let mut growth = 0.0;
        for _ in 0..3000 {
            let y = dense::solve(&matrix, &x);
            growth = y.concat().iter().map(|v| v * v).sum::<f64>().sqrt()
                / x.concat().iter().map(|v| v * v).sum::<f64>().sqrt();
            x = y.iter().map(|row| vec![row[0] / growth]).collect();
        }
        let found =
            smallest_eigenvalue(&interpolation(&t, &knots).unwrap().operator.factor(None).unwrap());
        let exact = 1.0 / growth;
        let slack = 1e-9 * exact;
        assert!(found.lower <= exact + slack && exact <= found.upper + slack, "{found:?} {exact}");
        assert!((found.estimate - exact).abs() < 0.02 * exact, "{found:?} {exact}");
    }
}

#[test]
fn rows_sum_to_one() {
    for degree in 1..=9 {
        for closed in [false, true] {
            let data = points(&random_walk(31, 30, 2));
            let t = assign_parameters(data.as_view(), closed, &Parameterization::Chord).unwrap();
            for placement in placements(degree, closed) {
                let knots = place_knots(degree, &t, &placement).unwrap();
                let operator = interpolation(&t, &knots).unwrap().operator;
                for j in 0..30 {
                    let sum: f64 = operator.row(j).map(|(_, weight)| weight).sum();
                    assert!((sum - 1.0).abs() < 1e-14 && operator.row(j).all(|(_, w)| w >= 0.0));
                }
            }
        }
    }
}

#[test]
fn affine_maps_commute_with_the_fit() {
    let data = random_walk(14, 30, 2);
    // A similarity, so that chord lengths keep their ratios.
    let map = |p: &[f64]| vec![3.0 * p[0] - 4.0 * p[1] + 7.0, 4.0 * p[0] + 3.0 * p[1] - 2.0];
    let mapped: Rows = data.iter().map(|p| map(p)).collect();
    for closed in [false, true] {
        let options = CurveOptions { closed, ..Default::default() };
        let image: Rows =
            rows(fit(&data, &options).curve.control_points()).iter().map(|p| map(p)).collect();
        let fitted = rows(fit(&mapped, &options).curve.control_points());
        assert!(close(&image, &fitted, 1e-10));
    }
}

#[test]
fn reversed_points_give_the_reversed_curve() {
    let data = random_walk(15, 28, 2);
    let back: Rows = data.iter().rev().cloned().collect();
    for degree in [2, 3, 4] {
        let options = CurveOptions { degree, ..Default::default() };
        let mut forward = rows(fit(&data, &options).curve.control_points());
        forward.reverse();
        assert!(close(&forward, &rows(fit(&back, &options).curve.control_points()), 1e-11));
    }
}

#[test]
fn a_closed_curve_does_not_know_where_it_starts() {
    let data = random_walk(16, 26, 2);
    let turned: Rows = (0..26).map(|j| data[(j + 9) % 26].clone()).collect();
    for degree in [2, 3, 4, 5] {
        let options = CurveOptions { degree, closed: true, ..Default::default() };
        let (a, b) = (fit(&data, &options), fit(&turned, &options));
        for (j, &t) in a.parameters.iter().enumerate() {
            // The tangent direction at each point is the same.
            let mut one = [0.0; 4];
            let mut two = [0.0; 4];
            a.curve.derivatives_into(t, 1, &mut one).unwrap();
            b.curve.derivatives_into(b.parameters[(j + 26 - 9) % 26], 1, &mut two).unwrap();
            let scale = one[2].hypot(one[3]);
            assert!((one[2] - two[2]).hypot(one[3] - two[3]) < 1e-9 * scale, "{degree} {j}");
        }
    }
}

#[test]
fn a_closed_curve_is_smooth_across_the_seam() {
    let data = random_walk(17, 23, 3);
    for degree in [2, 3, 4, 5, 7] {
        let fit = fit(&data, &CurveOptions { degree, closed: true, ..Default::default() });
        let (start, end) = fit.curve.domain();
        let order = degree - 1;
        let mut left = vec![0.0; 3 * (order + 1)];
        let mut right = left.clone();
        fit.curve.derivatives_into(end, order, &mut left).unwrap();
        fit.curve.derivatives_into(start, order, &mut right).unwrap();
        for k in 0..=order {
            let part = 3 * k..3 * (k + 1);
            let size = right[part.clone()].iter().fold(1.0_f64, |m, x| m.max(x.abs()));
            for i in part {
                assert!((left[i] - right[i]).abs() < 1e-8 * size, "degree {degree}, order {k}");
            }
        }
    }
}

#[test]
fn any_spacing_is_met_at_rounding_level() {
    for ratio in [1.0, 2.0, 3.0, 10.0] {
        let count = if ratio > 3.0 { 12 } else { 24 };
        let data = graded(count, ratio);
        for degree in [2, 3, 4, 5] {
            for parameterization in [Parameterization::Chord, Parameterization::Centripetal] {
                let options = CurveOptions {
                    degree,
                    parameterization: Some(parameterization),
                    ..Default::default()
                };
                let found = fit(&data, &options);
                // Where the interpolant itself swings far beyond the data, rounding of its control
                // points is all that can be reached, and the report says so.
                let report = &found.report;
                let largest = rows(found.curve.control_points())
                    .concat()
                    .iter()
                    .fold(0.0_f64, |m, x| m.max(x.abs()));
                if report.run.max_residual > 1e-14 * largest.max(report.run.extent) {
                    // Condition numbers beyond 1e17: no interpolant exists in doubles.
                    assert_eq!(report.run.termination, Termination::Stalled);
                    assert!(ratio >= 3.0 && degree >= 4, "{report:?}");
                    continue;
                }
                assert!(report.converged() || largest > 1e4 * report.run.extent, "{report:?}");
                let warned = report.run.choices.iter().any(|choice| choice.starts_with("caution"));
                assert_eq!(warned, largest > 1e3 * report.run.extent, "{report:?}");
            }
        }
    }
    // One step a million times shorter than its neighbours.
    let mut data = random_walk(3, 40, 2);
    data[20] = vec![data[19][0] + 1e-6, data[19][1]];
    for closed in [false, true] {
        let found = fit(&data, &CurveOptions { closed, ..Default::default() });
        assert!(found.report.converged() && found.report.spacing_ratio > 1e5);
        assert!(textbook_residual(&data, &found) < 1e-11 * found.report.run.extent);
    }
}

#[test]
fn tied_ends_give_the_published_residuals() {
    // The lemniscate of 11 points by the scheme of Lin, Wang and Dong (2004), recomputed
    // independently of this library.
    let data: Rows = (0..11)
        .map(|i| {
            let s = -std::f64::consts::FRAC_PI_2 + f64::from(i) * std::f64::consts::PI / 5.0;
            vec![s.cos(), s.sin() * s.cos()]
        })
        .collect();
    let options = CurveOptions {
        knot_placement: Some(KnotPlacement::AtData),
        method: Method::Pia,
        residual: Some(0.0),
        iterations: 30,
        ..Default::default()
    };
    let found = fit(&data, &options);
    let published = [
        (0, 0.113256),
        (1, 0.0474378),
        (2, 0.0246468),
        (4, 7.92338e-3),
        (15, 4.23449e-5),
        (30, 6.01660e-8),
    ];
    for (iteration, expected) in published {
        let residual = found.report.run.history[iteration].max_residual;
        assert!((residual - expected).abs() < 1e-5 * expected, "{iteration}: {residual:e}");
    }
    let control = rows(found.curve.control_points());
    assert_eq!(control.len(), 13);
    assert_eq!((&control[0], &control[12]), (&control[1], &control[11]));
}

#[test]
fn extreme_scales_change_nothing_but_the_scale() {
    let data = random_walk(18, 20, 2);
    let plain = fit(&data, &CurveOptions::default());
    for exponent in [-900, -600, 600, 900] {
        let factor = 2f64.powi(exponent);
        let scaled: Rows = data.iter().map(|p| p.iter().map(|x| x * factor).collect()).collect();
        let found = fit(&scaled, &CurveOptions::default());
        assert!(found.report.converged());
        for (a, b) in rows(plain.curve.control_points())
            .concat()
            .iter()
            .zip(rows(found.curve.control_points()).concat())
        {
            assert!((a * factor - b).abs() <= 1e-13 * factor, "{exponent}");
        }
    }
}

#[test]
fn data_far_from_the_origin_are_met_as_well_as_doubles_can() {
    let mut random = Random::new(5);
    let data: Rows =
        (0..50).map(|j| vec![1e9 + 1e-3 * f64::from(j), 1e9 + 1e-3 * random.signed()]).collect();
    let found = fit(&data, &CurveOptions::default());
    assert!(found.report.converged() && found.report.run.max_residual < 1e-6);
    assert!(found.report.run.choices.iter().any(|choice| choice.contains("rounding")));
}

#[test]
fn a_diverging_run_returns_its_best_fit() {
    // Undamped Jacobi diverges on strongly graded data.
    let data = graded(14, 10.0);
    let options = CurveOptions { method: Method::Jacobi, degree: 5, ..Default::default() };
    let found = fit(&data, &options);
    assert_eq!(found.report.run.termination, Termination::Diverged);
    let best =
        found.report.run.history.iter().map(|e| e.max_residual).fold(f64::INFINITY, f64::min);
    assert_eq!(found.report.run.max_residual, best);
    assert!(found.report.run.iteration_returned < found.report.run.iterations);
}

#[test]
fn the_chord_ratio_scheme_is_the_uniform_one_for_equal_steps() {
    let ring = |turn: f64| -> Rows {
        (0..12)
            .map(|j| (f64::from(j) + turn) * std::f64::consts::TAU / 12.0)
            .map(|a| vec![a.cos(), a.sin()])
            .collect()
    };
    let options = |parameterization| CurveOptions {
        degree: 2,
        closed: true,
        parameterization: Some(parameterization),
        ..Default::default()
    };
    let ratio = fit(&ring(0.3), &options(Parameterization::ChordRatio));
    let uniform = fit(&ring(0.3), &options(Parameterization::Uniform));
    let (a, b) = (rows(ratio.curve.control_points()), rows(uniform.curve.control_points()));
    assert!(close(&a, &b, 1e-13));
    // Unequal steps: the rows of the paper's matrix A, section 4.2.
    let data = random_walk(40, 9, 2);
    let view = points(&data);
    let t = assign_parameters(view.as_view(), true, &Parameterization::ChordRatio).unwrap();
    let knots = place_knots(2, &t, &KnotPlacement::Uniform).unwrap();
    let operator = interpolation(&t, &knots).unwrap().operator;
    let chord = |i: usize, j: usize| (data[i][0] - data[j][0]).hypot(data[i][1] - data[j][1]);
    for j in 0..9 {
        let (before, after) = ((j + 8) % 9, (j + 1) % 9);
        let s = chord(before, j) / (chord(before, j) + chord(j, after));
        let paper = [
            (before, (s * s - 2.0 * s + 1.0) / 2.0),
            (j, (-2.0 * s * s + 2.0 * s + 1.0) / 2.0),
            (after, s * s / 2.0),
        ];
        for (column, expected) in paper {
            let found: f64 = operator.row(j).filter(|e| e.0 == column).map(|e| e.1).sum();
            assert!((found - expected).abs() < 1e-13, "{j} {column}: {found} {expected}");
        }
    }
}

#[test]
fn closed_curves_of_uneven_spacing_are_as_well_met_as_open_ones() {
    // Cutting such a closed curve open leaves a matrix of condition 1e18 or worse, though that of
    // the whole is some thousand: elimination must exchange rows.
    for (growth, count) in [(1.02, 154), (1.1, 30), (1.2, 40)] {
        let mut x: f64 = 0.0;
        let data: Rows = (0..count)
            .map(|i| {
                let point = vec![x, x.ln_1p()];
                x += f64::powi(growth, i);
                point
            })
            .collect();
        for degree in [2, 3, 4, 5, 9] {
            let options = CurveOptions { degree, closed: true, ..Default::default() };
            let found = fit(&data, &options);
            let wild = found.report.run.choices.iter().any(|choice| choice.starts_with("caution"));
            assert!(found.report.converged() || wild, "{growth} {degree}: {:?}", found.report);
            assert!(!wild || degree >= 4, "{growth} {degree}");
            let scale = rows(found.curve.control_points())
                .concat()
                .iter()
                .fold(found.report.run.extent, |m, x| m.max(x.abs()));
            assert!(textbook_residual(&data, &found) <= 1e-13 * scale, "{growth} {degree}");
        }
    }
}

#[test]
fn a_repeated_closing_point_follows_the_policy_on_duplicates() {
    let data: Rows = [[1.0, 2.0], [4.0, 1.0], [0.0, 0.0], [7.0, 7.0], [1.0, 2.0], [1.0, 2.0]]
        .map(|point| point.to_vec())
        .to_vec();
    let run = |duplicates| {
        let options = CurveOptions { closed: true, duplicates, ..Default::default() };
        fit_curve(&points(&data), &options)
    };
    assert_eq!(
        run(Duplicates::Error).unwrap_err(),
        Error::RepeatedPoints { first: 4, second: 5, others: 0 }
    );
    for policy in [Duplicates::Drop, Duplicates::Merge] {
        let fit = run(policy).unwrap();
        assert!(fit.report.converged() && fit.report.points == 4);
    }
}

#[test]
fn closed_curves_of_million_to_one_spacing_are_met_at_every_degree() {
    for seed in 0..25 {
        let mut random = Random::new(seed);
        let mut angle: f64 = 0.0;
        let data: Rows = (0..20)
            .map(|_| {
                // Steps between 1e-6 and 1 of the largest, evenly in their logarithm.
                angle += 0.3 * 10f64.powf(-6.0 * random.unit());
                vec![angle.cos(), angle.sin()]
            })
            .collect();
        for degree in 2..=9 {
            let options = CurveOptions { degree, closed: true, ..Default::default() };
            let found = fit(&data, &options);
            let scale = rows(found.curve.control_points())
                .concat()
                .iter()
                .fold(found.report.run.extent, |m, x| m.max(x.abs()));
            let residual = textbook_residual(&data, &found);
            assert!(residual <= 1e-13 * scale, "{seed} {degree}: {residual:e} at {scale:e}");
            let wild = found.report.run.choices.iter().any(|choice| choice.starts_with("caution"));
            assert!(found.report.converged() || wild, "{seed} {degree}: {:?}", found.report);
        }
    }
}

#[test]
fn a_member_of_a_family_is_the_fit_of_a_run_that_stopped_there() {
    let open: Vec<[f64; 3]> = helix(40).chunks(3).map(|p| [p[0], p[1], p[2]]).collect();
    for closed in [false, true] {
        let options = CurveOptions {
            closed,
            method: Method::Pia,
            iterations: 9,
            residual: Some(0.0),
            keep: vec![0, 3, 9],
            ..Default::default()
        };
        let whole = fit_curve(&open, &options).unwrap();
        for k in [0, 3, 9] {
            let short =
                fit_curve(&open, &CurveOptions { iterations: k, keep: vec![], ..options.clone() })
                    .unwrap();
            let member = whole.member(k).unwrap();
            assert_eq!((&member.curve, &member.parameters), (&short.curve, &short.parameters));
            let (ours, theirs) = (&member.report, &short.report);
            assert!((ours.run.max_residual - theirs.run.max_residual).abs() < 1e-13);
            assert!((ours.run.rms_residual - theirs.run.rms_residual).abs() < 1e-13);
            assert!((ours.max_deviation - theirs.max_deviation).abs() < 1e-9);
            assert_eq!(ours.max_residual_index, theirs.max_residual_index);
            assert_eq!(ours.run.history, theirs.run.history);
        }
        assert!(whole.member(1).is_err());
    }
}
