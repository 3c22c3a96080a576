//! Laws of least squares fits: iterates and limits, judged by dense oracles that share no code with
//! the library.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::LeastSquaresMethod as Method;
use gimfit::collocation::LeastSquaresCollocation;
use gimfit::fit::least_squares;
use gimfit::{
    CurveFit, Error, KnotVector, LeastSquaresKnots, LeastSquaresOptions, LeastSquaresWeight,
    Parameterization, Points, Termination, fit_least_squares,
};
use gimfit_testkit::dense::{Rows, differences, largest_norm, multiply};
use gimfit_testkit::generate::{Random, random_walk};
use gimfit_testkit::{least_squares as oracle, textbook};

const ALL: [Method; 14] = [
    Method::Auto,
    Method::Lspia,
    Method::ColumnSums,
    Method::GaussSeidel,
    Method::Sor,
    Method::HeavyBall,
    Method::Nesterov,
    Method::Chebyshev,
    Method::SaLspia,
    Method::RandomColumns,
    Method::RandomRows,
    Method::Extended,
    Method::Cgls,
    Method::Pcg,
];

fn points(rows: &Rows) -> Points {
    Points::new(rows[0].len(), rows.concat()).unwrap()
}

fn rows(points: &Points) -> Rows {
    points.iter().map(<[f64]>::to_vec).collect()
}

fn fit(data: &Rows, options: &LeastSquaresOptions) -> CurveFit {
    fit_least_squares(&points(data), options).unwrap()
}

/// The matrix of a fit by the textbook, repeated control points of a closed curve added up.
fn matrix(fit: &CurveFit) -> Rows {
    let knots = fit.curve.knots();
    let all = textbook::collocation_matrix(knots.values(), knots.degree(), &fit.parameters);
    if !fit.curve.is_periodic() {
        return all;
    }
    let moving = knots.control_points() - knots.degree();
    all.iter()
        .map(|row| {
            let mut short = row[..moving].to_vec();
            row[moving..].iter().enumerate().for_each(|(k, w)| short[k % moving] += w);
            short
        })
        .collect()
}

fn moving(fit: &CurveFit, control: &Points) -> Rows {
    let mut all = rows(control);
    if fit.curve.is_periodic() {
        all.truncate(all.len() - fit.curve.degree());
    }
    all
}

fn distance(a: &Rows, b: &Rows) -> f64 {
    assert_eq!(a.len(), b.len());
    let each = a.iter().flatten().zip(b.iter().flatten());
    each.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()))
}

fn options(count: usize) -> LeastSquaresOptions {
    LeastSquaresOptions::with_control_points(count)
}

/// A fit of the first iterates, all kept.
fn iterates(data: &Rows, options: LeastSquaresOptions, steps: usize) -> (CurveFit, Vec<Rows>) {
    let options = LeastSquaresOptions {
        residual: Some(0.0),
        iterations: steps,
        keep: (0..=steps).collect(),
        ..options
    };
    let fit = fit(data, &options);
    let list = fit.sequence.iter().map(|kept| moving(&fit, &kept.control_points)).collect();
    (fit, list)
}

#[test]
fn iterates_are_those_of_the_papers() {
    const STEPS: usize = 7;
    for (degree, closed, count) in [(3, false, 12), (2, true, 9), (3, true, 4), (5, false, 11)] {
        let data = random_walk(31, 60, 3);
        let case = |method, weight| {
            let given = LeastSquaresOptions { degree, closed, method, weight, ..options(count) };
            iterates(&data, given, STEPS)
        };
        let (auto, published) = (LeastSquaresWeight::Auto, LeastSquaresWeight::Published);
        let check = |name: &str, found: &[Rows], expected: &[Rows]| {
            assert_eq!(found.len(), expected.len(), "{name}");
            for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
                let gap = distance(found, expected);
                let size = largest_norm(expected);
                assert!(gap <= 1e-10 * size, "{name} {degree} {closed} step {k}: {gap:e}");
            }
        };
        let (fit, lspia) = case(Method::Lspia, auto);
        let (a, start) = (matrix(&fit), lspia[0].clone());
        let n = start.len();
        let (low, high) = oracle::extreme_eigenvalues(&a);
        let expected = |weight: f64| oracle::lspia(&a, &data, &start, &vec![weight; n], STEPS);
        check("lspia", &lspia, &expected(2.0 / (low + high)));
        let sums = oracle::column_sums(&a);
        let most = sums.iter().copied().fold(0.0, f64::max);
        check("published", &case(Method::Lspia, published).1, &expected(2.0 / most));
        let given = LeastSquaresWeight::Same(0.7 / high);
        check("given", &case(Method::Lspia, given).1, &expected(0.7 / high));

        let weights: Vec<f64> = sums.iter().map(|sum| 1.0 / sum).collect();
        let column_sums = oracle::lspia(&a, &data, &start, &weights, STEPS);
        check("column sums", &case(Method::ColumnSums, published).1, &column_sums);
        // A scaled from the right by the roots of the weights has the eigenvalues of W A^T A.
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let scaled: Rows =
            a.iter().map(|row| row.iter().zip(&roots).map(|(x, r)| x * r).collect()).collect();
        let (l, h) = oracle::extreme_eigenvalues(&scaled);
        let best: Vec<f64> = weights.iter().map(|w| 2.0 / (l + h) * w).collect();
        let expected_best = oracle::lspia(&a, &data, &start, &best, STEPS);
        check("best column sums", &case(Method::ColumnSums, auto).1, &expected_best);
        let chebyshev = oracle::chebyshev(&a, &data, &start, &weights, (l, h), STEPS);
        let (_, found) = case(Method::Chebyshev, auto);
        // The interval of the library is wider by 1e-9.
        for (found, expected) in found.iter().zip(&chebyshev) {
            assert!(distance(found, expected) <= 1e-7 * largest_norm(expected));
        }

        let sweeps = |omega| oracle::column_sweeps(&a, &data, &start, omega, STEPS);
        check("gauss-seidel", &case(Method::GaussSeidel, auto).1, &sweeps(1.0));
        let sor = case(Method::Sor, LeastSquaresWeight::Same(1.4)).1;
        check("sor", &sor, &sweeps(1.4));
        let mlspia = oracle::mlspia(&a, &data, &start, (low, high), STEPS);
        check("mlspia", &case(Method::HeavyBall, auto).1, &mlspia);
        let (s, t) = (high.sqrt(), low.sqrt());
        let nmlspia =
            oracle::nesterov(&a, &data, &start, 1.0 / high, |_, _| (s - t) / (s + t), STEPS);
        check("nmlspia", &case(Method::Nesterov, published).1, &nmlspia);
        let mut since = 0;
        let restarted = oracle::nesterov(
            &a,
            &data,
            &start,
            1.0 / high,
            |_, slope| {
                since = if slope < 0.0 { 1 } else { since + 1 };
                f64::from(since - 1) / f64::from(since + 2)
            },
            STEPS,
        );
        check("nesterov", &case(Method::Nesterov, auto).1, &restarted);
        let salspia = oracle::salspia(&a, &data, &start, STEPS);
        check("salspia", &case(Method::SaLspia, auto).1, &salspia);
        let extended = oracle::extended(&a, &data, &start, STEPS);
        check("epia", &case(Method::Extended, auto).1, &extended);
        if n > STEPS {
            let cgls = oracle::cgls(&a, &data, &start, &vec![1.0; n], STEPS);
            check("cgls", &case(Method::Cgls, auto).1, &cgls);
            let columns = oracle::transpose(&a);
            let squares: Vec<f64> =
                columns.iter().map(|c| 1.0 / c.iter().map(|x| x * x).sum::<f64>()).collect();
            let pcg = oracle::cgls(&a, &data, &start, &squares, STEPS);
            check("pcg", &case(Method::Pcg, auto).1, &pcg);
        }
    }
}

#[test]
fn every_method_but_extended_pia_ends_at_the_least_squares_fit() {
    for (degree, closed, count) in [(1, false, 9), (2, true, 8), (3, false, 14), (4, true, 11)] {
        let data = random_walk(7, 150, 2);
        for method in ALL {
            let given = LeastSquaresOptions {
                degree,
                closed,
                method,
                iterations: 20_000,
                residual: Some(1e-10),
                ..options(count)
            };
            let fit = fit(&data, &given);
            let case = format!("{method:?} {degree} {closed}");
            assert_eq!(fit.report.run.termination, Termination::Residual, "{case}");
            let (a, found) = (matrix(&fit), moving(&fit, fit.curve.control_points()));
            let expected =
                oracle::nearest_solution(&a, &data, &vec![vec![0.0; 2]; found[0].len().max(count)]);
            let gap = distance(&found, &expected);
            if method == Method::Extended {
                // Near it, but not it; there the means over the groups vanish.
                assert!(gap > 1e-4 && gap < 3.0, "{case}: {gap:e}");
                let last = &oracle::extended(&a, &data, &found, 1)[1];
                assert!(distance(&found, last) < 1e-9, "{case}");
            } else {
                assert!(gap < 1e-6 * largest_norm(&expected), "{case}: {gap:e}");
            }
        }
    }
}

#[test]
fn auto_reaches_the_dense_solution_in_a_few_steps() {
    for degree in [1, 2, 3, 5, 8] {
        for (seed, points, count) in [(1, 40, 10), (2, 120, 40), (3, 100, 30), (4, 300, degree + 1)]
        {
            let data = random_walk(seed, points, 3);
            let fit = fit(&data, &LeastSquaresOptions { degree, ..options(count.max(degree + 1)) });
            assert!(fit.report.converged(), "{degree} {points}");
            assert!(fit.report.run.iterations <= 4, "{degree} {points}: {:?}", fit.report.run);
            let a = matrix(&fit);
            let found = rows(fit.curve.control_points());
            let expected = oracle::nearest_solution(&a, &data, &found);
            let size = largest_norm(&expected);
            assert!(distance(&found, &expected) <= 1e-9 * size, "{degree} {points} {count}");
            // What is reported is what the textbook sees.
            let left = differences(&a, &data, &found);
            let rms = (left.iter().flatten().map(|x| x * x).sum::<f64>() / points as f64).sqrt();
            assert!((fit.report.run.rms_residual - rms).abs() <= 1e-12 * size);
            assert!((fit.report.run.max_residual - largest_norm(&left)).abs() <= 1e-12 * size);
            assert!(distance(&rows(&fit.difference_vectors), &left) <= 1e-12 * size);
        }
    }
}

/// A gap in the data, of six empty spans, and knots that do not mind it.
fn with_a_gap() -> (Rows, LeastSquaresOptions) {
    let mut random = Random::new(3);
    let t: Vec<f64> = (0..80).map(|j| f64::from(j) / 79.0).collect();
    let kept: Vec<f64> = t.into_iter().filter(|t| !(4.0 / 15.0..10.0 / 15.0).contains(t)).collect();
    let data = kept.iter().map(|t| vec![t.sin() + 0.01 * random.signed(), t * t]).collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=15).map(|i| f64::from(i) / 15.0));
    knots.extend([1.0; 3]);
    let options = LeastSquaresOptions {
        parameterization: Some(Parameterization::Given(kept)),
        ..LeastSquaresOptions::new(LeastSquaresKnots::Given(knots))
    };
    (data, options)
}

#[test]
fn where_data_leave_control_points_free_the_limit_is_the_fit_nearest_the_start() {
    let (data, base) = with_a_gap();
    let start: Rows = (0..18).map(|i| vec![f64::from(i), f64::from(i * i % 7)]).collect();
    for method in ALL {
        let given = LeastSquaresOptions {
            method,
            start: Some(points(&start)),
            iterations: 50_000,
            residual: Some(1e-11),
            ..base.clone()
        };
        let fit = fit(&data, &given);
        let (a, found) = (matrix(&fit), rows(fit.curve.control_points()));
        if matches!(method, Method::Extended | Method::RandomColumns | Method::RandomRows) {
            continue; // Another limit, or draws that meet the edge of the gap once in a while.
        }
        let account = fit.report.run.least_squares.unwrap();
        assert_eq!(account.unmet_control_points, 3, "{method:?}");
        assert!(fit.report.converged(), "{method:?} {:?}", fit.report.run.termination);
        // Weights W of the iteration measure nearness by W^-1.
        let sums = oracle::column_sums(&a);
        let weights: Vec<f64> = match method {
            Method::Auto | Method::ColumnSums | Method::Chebyshev => {
                sums.iter().map(|c| if *c > 0.0 { 1.0 / c } else { 0.0 }).collect()
            }
            Method::Pcg => oracle::transpose(&a)
                .iter()
                .map(|c| c.iter().map(|x| x * x).sum::<f64>())
                .map(|square| if square > 0.0 { 1.0 / square } else { 0.0 })
                .collect(),
            _ => vec![1.0; sums.len()],
        };
        let roots: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
        let scaled: Rows =
            a.iter().map(|row| row.iter().zip(&roots).map(|(x, r)| x * r).collect()).collect();
        let correction = oracle::pseudo_inverse_times(&scaled, &differences(&a, &data, &start));
        let expected = oracle::add(&start, 1.0, &oracle::scale(&roots, &correction));
        // Sweeps end at a fit that depends on their order.
        let in_order = matches!(method, Method::GaussSeidel | Method::Sor | Method::RandomColumns);
        if !in_order {
            let gap = distance(&found, &expected);
            assert!(gap < 2e-5, "{method:?}: {gap:e}");
        }
        // The curve at the data is the same whatever is left free.
        let (ours, theirs) = (multiply(&a, &found), multiply(&a, &expected));
        assert!(distance(&ours, &theirs) < 1e-7, "{method:?}");
    }
}

#[test]
fn held_ends_stay_and_the_rest_is_fitted_to_what_they_leave() {
    let data = random_walk(17, 120, 2);
    for method in ALL {
        let given = LeastSquaresOptions {
            method,
            hold_ends: true,
            iterations: 20_000,
            residual: Some(1e-10),
            ..options(13)
        };
        let fit = fit(&data, &given);
        let found = rows(fit.curve.control_points());
        assert!(fit.report.converged(), "{method:?}");
        assert_eq!((&found[0], &found[12]), (&data[0], &data[119]), "{method:?}");
        if method == Method::Extended {
            continue;
        }
        let a = matrix(&fit);
        let ends: Rows =
            (0..13).map(|i| if i % 12 == 0 { found[i].clone() } else { vec![0.0; 2] }).collect();
        let rest = differences(&a, &data, &ends);
        let inner: Rows = a.iter().map(|row| row[1..12].to_vec()).collect();
        let expected = oracle::pseudo_inverse_times(&inner, &rest);
        let gap = distance(&found[1..12].to_vec(), &expected);
        assert!(gap < 1e-6, "{method:?}: {gap:e}");
    }
}

#[test]
fn weights_of_the_data_count_as_repetitions_do() {
    let data = random_walk(23, 90, 3);
    let t = textbook::chord_parameters(&data);
    let weights: Vec<f64> = (0..90).map(|j| f64::from(j % 4)).collect();
    let mut repeated = Vec::new();
    let mut places = Vec::new();
    for j in 0..90 {
        for _ in 0..j % 4 {
            repeated.push(data[j].clone());
            places.push(t[j]);
        }
    }
    let mut knots = vec![0.0; 4];
    knots.extend([0.15, 0.3, 0.5, 0.6, 0.8]);
    knots.extend([1.0; 4]);
    let base = LeastSquaresOptions {
        iterations: 20_000,
        residual: Some(1e-11),
        ..LeastSquaresOptions::new(LeastSquaresKnots::Given(knots))
    };
    for method in ALL {
        let weighted = LeastSquaresOptions {
            method,
            data_weights: Some(weights.clone()),
            parameterization: Some(Parameterization::Given(t.clone())),
            ..base.clone()
        };
        let plain = LeastSquaresOptions {
            method,
            parameterization: Some(Parameterization::Given(places.clone())),
            ..base.clone()
        };
        let (weighted, plain) = (fit(&data, &weighted), fit(&repeated, &plain));
        assert!(weighted.report.converged() && plain.report.converged(), "{method:?}");
        let gap =
            distance(&rows(weighted.curve.control_points()), &rows(plain.curve.control_points()));
        assert!(gap < 1e-8, "{method:?}: {gap:e}");
        // Point 0 has weight 0: it does not count among the residuals either.
        assert!(weighted.report.max_residual_index % 4 != 0);
    }
}

#[test]
fn the_order_of_the_data_does_not_matter() {
    let data = random_walk(29, 100, 2);
    let t = textbook::chord_parameters(&data);
    let order: Vec<usize> = (0..100).map(|j| j * 37 % 100).collect();
    let base = |t: Vec<f64>| LeastSquaresOptions {
        parameterization: Some(Parameterization::Given(t)),
        ..options(15)
    };
    let one = fit(&data, &base(t.clone()));
    let shuffled: Rows = order.iter().map(|&j| data[j].clone()).collect();
    let two = fit(&shuffled, &base(order.iter().map(|&j| t[j]).collect()));
    assert_eq!(one.curve.knots(), two.curve.knots());
    let gap = distance(&rows(one.curve.control_points()), &rows(two.curve.control_points()));
    assert!(gap < 1e-11, "{gap:e}");
    assert_eq!(order[two.report.max_residual_index], one.report.max_residual_index);
}

#[test]
fn given_parameters_and_knots_make_the_same_curve() {
    let data = random_walk(33, 80, 2);
    for closed in [false, true] {
        let one = fit(&data, &LeastSquaresOptions { closed, ..options(12) });
        let (t, knots) = (one.parameters.clone(), one.curve.knots().clone());
        let two = least_squares(&points(&data), t, knots, &options(0)).unwrap();
        assert!(two.report.converged() && two.report.closed == closed);
        let gap = distance(&rows(one.curve.control_points()), &rows(two.curve.control_points()));
        assert!(gap < 1e-11, "{gap:e}");
    }
    let knots = KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0]).unwrap();
    assert!(least_squares(&points(&data), vec![0.5; 79], knots.clone(), &options(0)).is_err());
    assert!(least_squares(&points(&data), vec![f64::NAN; 80], knots.clone(), &options(0)).is_err());
    assert!(least_squares(&points(&data), vec![2.0; 80], knots, &options(0)).is_err());
}

#[test]
fn points_that_repeat_share_a_parameter() {
    let mut data = random_walk(5, 40, 2);
    data.insert(20, data[19].clone());
    data.insert(20, data[19].clone());
    let fit = fit(&data, &options(10));
    assert_eq!(fit.parameters[19], fit.parameters[21]);
    assert!(fit.parameters[22] > fit.parameters[21] && fit.report.points == 42);
    assert!(fit.report.converged());
}

#[test]
fn eigenvalues_of_normal_matrices_are_enclosed_to_many_digits() {
    for closed in [false, true] {
        let data = random_walk(41, 80, 2);
        let fit = fit(&data, &LeastSquaresOptions { closed, ..options(20) });
        let (low, high) = oracle::extreme_eigenvalues(&matrix(&fit));
        let operator = LeastSquaresCollocation::new(&fit.parameters, fit.curve.knots()).unwrap();
        let (smallest, largest) = operator.normal_matrix().eigenvalues().unwrap();
        assert!((smallest - low).abs() < 1e-10 * low, "{closed}: {smallest} {low}");
        assert!((largest - high).abs() < 1e-11 * high, "{closed}: {largest} {high}");
    }
}

#[test]
fn randomised_methods_repeat_with_their_seed() {
    let data = random_walk(2, 60, 2);
    for method in [Method::RandomColumns, Method::RandomRows] {
        let run = |seed| {
            let given = LeastSquaresOptions { method, seed, iterations: 5, ..options(12) };
            rows(fit(&data, &given).curve.control_points())
        };
        assert_eq!(run(1), run(1));
        assert_ne!(run(1), run(2));
    }
}

#[test]
fn a_run_that_ends_early_tells_its_rate() {
    let data = random_walk(2, 300, 2);
    let given = LeastSquaresOptions { method: Method::Lspia, iterations: 200, ..options(40) };
    let fit = fit(&data, &given);
    let run = &fit.report.run;
    assert_eq!(run.termination, Termination::Iterations);
    let (low, high) = oracle::extreme_eigenvalues(&matrix(&fit));
    let expected = (high - low) / (high + low);
    let rate = run.rate().unwrap();
    assert!((rate - expected).abs() < 0.01 * (1.0 - expected) + 1e-3, "{rate} {expected}");
}

#[test]
fn what_cannot_be_fitted_is_refused_with_a_reason() {
    let data = random_walk(1, 30, 2);
    let refuse = |options: LeastSquaresOptions| {
        fit_least_squares(&points(&data), &options).unwrap_err().to_string()
    };
    let contains = |options, text: &str| {
        let error = refuse(options);
        assert!(error.contains(text), "{error}");
    };
    contains(options(3), "3 control points given, 4 expected");
    contains(options(31), "at most one per data point");
    contains(options(usize::MAX), "at most one per data point");
    contains(LeastSquaresOptions { hold_ends: true, closed: true, ..options(9) }, "closed curve");
    let weights = |list: Vec<f64>| LeastSquaresOptions { data_weights: Some(list), ..options(9) };
    contains(weights(vec![1.0; 29]), "29 data weights given, 30 expected");
    contains(weights(vec![0.0; 30]), "at least one weight");
    contains(weights([vec![1.0; 29], vec![f64::NAN]].concat()), "data weight 29");
    let weight = |method, omega| LeastSquaresOptions {
        method,
        weight: LeastSquaresWeight::Same(omega),
        ..options(9)
    };
    contains(weight(Method::Lspia, 1e3), "largest eigenvalue");
    contains(weight(Method::Sor, 2.0), "below 2");
    contains(weight(Method::Lspia, f64::NAN), "above 0");
    contains(weight(Method::Cgls, 0.5), "only lspia");
    let start = Some(Points::new(2, vec![0.0; 8]).unwrap());
    contains(LeastSquaresOptions { start, ..options(9) }, "control points of the start");
    let given = |t: Vec<f64>| LeastSquaresOptions {
        parameterization: Some(Parameterization::Given(t)),
        ..options(9)
    };
    contains(given(vec![0.5; 30]), "too few");
    contains(given(vec![f64::INFINITY; 30]), "finite");
    contains(given(vec![0.5; 4]), "parameters given");
    let knots = |list: Vec<f64>| LeastSquaresOptions::new(LeastSquaresKnots::Given(list));
    contains(knots(vec![0.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5]), "outside the domain");
    assert!(fit_least_squares(&points(&data), &knots(vec![])).is_err());
    assert_eq!(
        fit_least_squares(&[] as &[[f64; 2]], &options(9)).unwrap_err(),
        Error::NoPoints { needed: 4 }
    );
}

#[test]
fn hostile_points_end_in_errors_or_finite_fits() {
    let base = random_walk(3, 60, 2);
    let scaled = |factor: f64, origin: f64| -> Rows {
        base.iter().map(|row| row.iter().map(|x| factor * x + origin).collect()).collect()
    };
    let cases: Vec<Rows> = vec![
        scaled(1e300, 0.0),
        scaled(1e-300, 0.0),
        scaled(1.0, 1e9),
        scaled(1e-3, 1e12),
        vec![vec![1.0, 2.0]; 60],
        vec![vec![1.0, 2.0]],
        (0..60).map(|j| vec![f64::from(j % 2), 0.0]).collect(),
        (0..60).map(|j| vec![1.5f64.powi(j)]).collect(),
        (0..60).map(|j| vec![f64::from(j); 7]).collect(),
    ];
    for (case, data) in cases.iter().enumerate() {
        for method in ALL {
            for closed in [false, true] {
                let given = LeastSquaresOptions { method, closed, iterations: 12, ..options(11) };
                match fit_least_squares(&points(data), &given) {
                    Ok(fit) => {
                        let control = fit.curve.control_points().coordinates();
                        assert!(control.iter().all(|x| x.is_finite()), "{case} {method:?}");
                        assert!(fit.report.run.rms_residual.is_finite(), "{case} {method:?}");
                        if method == Method::Auto {
                            assert!(fit.report.converged(), "{case} {:?}", fit.report.run);
                        }
                    }
                    Err(error) => assert!(matches!(case, 4 | 5), "{case} {method:?}: {error}"),
                }
            }
        }
    }
    let mut broken = base.clone();
    broken[7][1] = f64::NAN;
    assert!(fit_least_squares(&points(&broken), &options(9)).is_err());
}

#[test]
fn an_operator_checks_its_parameters() {
    let knots = KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0]).unwrap();
    assert!(LeastSquaresCollocation::new(&[], &knots).is_err());
    assert!(LeastSquaresCollocation::new(&[0.5, f64::NAN], &knots).is_err());
    assert!(LeastSquaresCollocation::new(&[0.5, 1.5], &knots).is_err());
}
