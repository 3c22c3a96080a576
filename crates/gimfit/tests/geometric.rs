//! Laws of geometric interpolation, judged by an oracle that walks to its foot points.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::collocation::{CollocationOperator, NetLayout, TensorCollocation, interpolation};
use gimfit::iteration::IterationState;
use gimfit::iteration::update::Pia;
use gimfit::knots::place_knots;
use gimfit::parameters::assign_parameters;
use gimfit::projection::{
    FallBackReason, FootPointCollocation, SMALLEST_EIGENVALUE, SurfaceFootPointCollocation,
};
use gimfit::{
    CurveFit, CurveOptions, Error, GridView, IterationWeight, KnotPlacement, Method,
    Parameterization, Points, SurfaceFit, SurfaceOptions, Termination, fit_curve, fit_surface,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::{Random, helix, random_walk};
use gimfit_testkit::geometric::{self, Net};
use gimfit_testkit::textbook;

fn points(rows: &Rows) -> Points {
    Points::new(rows[0].len(), rows.concat()).unwrap()
}

fn rows(points: &Points) -> Rows {
    points.iter().map(<[f64]>::to_vec).collect()
}

fn geometric() -> CurveOptions {
    CurveOptions { method: Method::Geometric { global_start: false }, ..Default::default() }
}

fn fit(data: &Rows, options: &CurveOptions) -> CurveFit {
    fit_curve(&points(data), options).unwrap()
}

fn close(a: &Rows, b: &Rows, tolerance: f64) -> bool {
    a.len() == b.len()
        && a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() <= tolerance)
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

/// The lemniscate of 11 points of Orsi (2021).
fn lemniscate() -> Rows {
    (0..11)
        .map(|i| -std::f64::consts::FRAC_PI_2 + f64::from(i) * std::f64::consts::PI / 5.0)
        .map(|s| vec![s.cos(), s.sin() * s.cos()])
        .collect()
}

fn wave(count: usize) -> Rows {
    let mut random = Random::new(3);
    (0..count)
        .map(|i| 0.5 * i as f64 + 0.2 * random.unit())
        .map(|x| vec![x, x.sin(), 0.3 * (1.7 * x).cos()])
        .collect()
}

#[test]
fn iterates_are_those_of_walks_to_the_foot_points() {
    for (data, uniform) in [(lemniscate(), true), (lemniscate(), false), (wave(12), false)] {
        for degree in [2, 3, 4] {
            let parameterization =
                if uniform { Parameterization::Uniform } else { Parameterization::Chord };
            let start: Vec<f64> = if uniform {
                (0..data.len()).map(|j| j as f64 / (data.len() - 1) as f64).collect()
            } else {
                textbook::chord_parameters(&data)
            };
            let knots = textbook::averaged_knots(degree, &start);
            let expected = geometric::iterates(&knots, degree, &data, &start, 6);
            let found = fit(
                &data,
                &CurveOptions {
                    degree,
                    parameterization: Some(parameterization),
                    residual: Some(0.0),
                    iterations: 6,
                    keep: (0..=6).collect(),
                    ..geometric()
                },
            );
            assert_eq!(found.report.run.foot_points.unwrap().fall_back, None);
            for (kept, (control, _)) in found.sequence.iter().zip(&expected) {
                let case = format!("degree {degree}, iteration {}", kept.entry.iteration);
                assert!(close(&rows(&kept.control_points), control, 1e-10), "{case}");
            }
            for (t, expected) in found.parameters.iter().zip(&expected[6].1) {
                assert!((t - expected).abs() < 1e-9, "degree {degree}: {t} {expected}");
            }
        }
    }
}

#[test]
fn foot_points_halve_the_steps_on_the_lemniscate() {
    // Recomputed independently of this library, four digits.
    let run = |method| {
        let options = CurveOptions {
            method,
            parameterization: Some(Parameterization::Uniform),
            residual: Some(0.0),
            iterations: 5,
            ..Default::default()
        };
        fit(&lemniscate(), &options).report
    };
    let (plain, geometric) = (run(Method::Pia), run(Method::Geometric { global_start: false }));
    assert!((plain.run.max_residual - 1.262e-2).abs() < 5e-6, "{}", plain.run.max_residual);
    assert!((geometric.run.max_residual - 2.285e-3).abs() < 5e-7);
    let moved = geometric.run.foot_points.unwrap().largest_move;
    assert!((moved - 0.025).abs() < 5e-4, "{moved}");
    // The vectors are those from the foot points: nothing is left to be gained.
    let gap = geometric.run.max_residual - geometric.max_deviation;
    assert!((0.0..1e-12).contains(&gap), "{gap:e}");
}

#[test]
fn the_limit_interpolates() {
    for closed in [false, true] {
        for degree in 1..=5 {
            for data in [lemniscate()[..10].to_vec(), wave(30), random_walk(6, 15, 7)] {
                let found = fit(&data, &CurveOptions { closed, degree, ..geometric() });
                let case = format!("{closed} {degree} {:?}", found.report.run.foot_points);
                assert!(found.report.converged(), "{case}");
                assert!(
                    textbook_residual(&data, &found) < 2e-12 * found.report.run.extent,
                    "{case}"
                );
                let rising = found.parameters.windows(2).filter(|t| t[0] >= t[1]).count();
                assert!(rising <= usize::from(closed), "{case}: {:?}", found.parameters);
            }
        }
    }
}

/// An operator at foot points, ready to be run by hand.
fn operator(data: &Rows, degree: usize, closed: bool) -> (FootPointCollocation, Vec<f64>) {
    let view = points(data);
    let t = assign_parameters(view.as_view(), closed, &Parameterization::Chord).unwrap();
    let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
    let built = interpolation(&t, &knots).unwrap();
    let dimension = data[0].len();
    let operator = FootPointCollocation::new(built, &knots, t.values(), dimension, None).unwrap();
    (operator, knots.values().to_vec())
}

/// The smallest eigenvalue by power iteration on the dense inverse.
fn dense_smallest_eigenvalue(matrix: &Rows) -> f64 {
    let norm = |x: &Rows| x.concat().iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut x: Rows =
        (0..matrix.len()).map(|j| vec![if j % 2 == 0 { 1.0 } else { -1.0 }]).collect();
    let mut growth = 0.0;
    for _ in 0..80 {
        let y = dense::solve(matrix, &x);
        growth = norm(&y) / norm(&x);
        x = y.iter().map(|row| vec![row[0] / growth]).collect();
    }
    1.0 / growth
}

#[test]
fn residuals_fall_as_the_norm_says_and_the_eigenvalue_is_that_of_the_matrix() {
    for (degree, data) in
        [(3, lemniscate()), (3, wave(14)), (5, wave(14)), (4, random_walk(6, 12, 2))]
    {
        let (operator, knots) = operator(&data, degree, false);
        let flat = data.concat();
        let mut state = IterationState::begin(&operator, &flat, data[0].len());
        let mut least: f64 = 1.0;
        for k in 0..12 {
            assert!(!operator.is_fixed(), "degree {degree}, iteration {k}");
            let matrix = textbook::collocation_matrix(&knots, degree, &operator.parameters());
            least = least.min(dense_smallest_eigenvalue(&matrix));
            let found = operator.smallest_eigenvalue().unwrap();
            assert!((found - least).abs() < 0.03 * least, "degree {degree}: {found} {least}");
            let norm = matrix.iter().enumerate().fold(0.0, |most: f64, (i, row)| {
                let sum: f64 = row
                    .iter()
                    .enumerate()
                    .map(|(j, a)| (f64::from(u8::from(i == j)) - a).abs())
                    .sum();
                most.max(sum)
            });
            let before = state.norms().max;
            state.step(&mut Pia);
            // The distance from the foot point is at most that at the parameter before.
            let after = state.norms().max;
            assert!(
                after <= norm * before * (1.0 + 1e-12) + 1e-15,
                "{degree} {k}: {after} {before}"
            );
        }
    }
}

#[test]
fn points_on_the_curve_are_their_own_foot_points() {
    for closed in [false, true] {
        let data = wave(20);
        let options = CurveOptions { closed, ..Default::default() };
        let limit = fit(&data, &options);
        let (operator, _) = operator(&data, 3, closed);
        let control = rows(limit.curve.control_points());
        // Of a closed curve, the control points that move, in their order.
        let moving: Rows = if closed {
            let flat = data.concat();
            let built = {
                let t = assign_parameters(points(&data).as_view(), true, &Parameterization::Chord);
                let t = t.unwrap();
                let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
                interpolation(&t, &knots).unwrap()
            };
            let mut state = IterationState::begin(&built.operator, &flat, 3);
            let mut rule =
                gimfit::iteration::update::Preconditioned::new(&built.operator, None).unwrap();
            (0..3).for_each(|_| state.step(&mut rule));
            state.control().chunks(3).map(<[f64]>::to_vec).collect()
        } else {
            control
        };
        let before = operator.parameters();
        let mut vectors = vec![0.0; data.concat().len()];
        let norms = operator.difference_vectors(&data.concat(), &moving.concat(), 3, &mut vectors);
        assert!(norms.max < 1e-13, "{closed}: {:e}", norms.max);
        for (t, before) in operator.parameters().iter().zip(before) {
            assert!((t - before).abs() < 1e-13, "{closed}: {t} {before}");
        }
    }
}

#[test]
fn similarities_commute_with_the_fit() {
    let data = wave(16).iter().map(|p| p[..2].to_vec()).collect::<Rows>();
    let map = |p: &[f64]| vec![3.0 * p[0] - 4.0 * p[1] + 7.0, 4.0 * p[0] + 3.0 * p[1] - 2.0];
    let mapped: Rows = data.iter().map(|p| map(p)).collect();
    for closed in [false, true] {
        let options = CurveOptions { closed, ..geometric() };
        let (plain, image) = (fit(&data, &options), fit(&mapped, &options));
        let expected: Rows = rows(plain.curve.control_points()).iter().map(|p| map(p)).collect();
        assert!(close(&rows(image.curve.control_points()), &expected, 1e-9), "{closed}");
    }
    // Powers of two are exact, also where squares leave the range of doubles.
    let plain = fit(&data, &geometric());
    for exponent in [-900, 40, 900] {
        let factor = 2f64.powi(exponent);
        let scaled: Rows = data.iter().map(|p| p.iter().map(|x| x * factor).collect()).collect();
        let found = fit(&scaled, &geometric());
        assert_eq!(found.parameters.len(), plain.parameters.len());
        for (a, b) in found.parameters.iter().zip(&plain.parameters) {
            assert!((a - b).abs() < 1e-9, "{exponent}: {a} {b}");
        }
        assert!(found.report.converged());
    }
}

#[test]
fn reversed_points_give_the_reversed_curve() {
    let data = wave(15);
    let back: Rows = data.iter().rev().cloned().collect();
    for degree in [2, 3, 4] {
        let options = CurveOptions { degree, ..geometric() };
        let mut forward = rows(fit(&data, &options).curve.control_points());
        forward.reverse();
        assert!(close(&forward, &rows(fit(&back, &options).curve.control_points()), 1e-9));
    }
}

#[test]
fn a_run_that_falls_back_ends_at_the_interpolant_of_the_parameters_it_returns() {
    let (mut fell, mut kept_on) = (0, 0);
    for seed in 1..30 {
        for degree in [3, 5] {
            let data = random_walk(seed, 15, 2);
            let found = fit(&data, &CurveOptions { degree, iterations: 3000, ..geometric() });
            let case = format!("seed {seed}, degree {degree}");
            assert!(found.report.converged(), "{case}: {}", found.report.run.termination);
            let Some(fall_back) = found.report.run.foot_points.unwrap().fall_back else {
                kept_on += 1;
                assert!(found.report.run.smallest_eigenvalue.unwrap() >= SMALLEST_EIGENVALUE);
                continue;
            };
            fell += 1;
            assert!(found.report.run.choices.iter().any(|c| c.starts_with("fell back")), "{case}");
            let matrix = textbook::collocation_matrix(
                found.curve.knots().values(),
                degree,
                &found.parameters,
            );
            let expected = dense::solve(&matrix, &data);
            let size = dense::largest_norm(&expected);
            assert!(close(&rows(found.curve.control_points()), &expected, 1e-10 * size), "{case}");
            if fall_back.iteration == 0 {
                let start = textbook::chord_parameters(&data);
                assert!(found.parameters.iter().zip(start).all(|(a, b)| (a - b).abs() < 1e-14));
            }
        }
    }
    assert!(fell > 15 && kept_on > 15, "{fell} {kept_on}");
}

#[test]
fn what_cannot_be_combined_is_refused() {
    let why = |error: Error| error.to_string();
    let line: Rows = (0..8).map(|i| vec![f64::from(i * i)]).collect();
    let refused = why(fit_curve(&points(&line), &geometric()).unwrap_err());
    assert!(refused.contains("dimension"), "{refused}");
    let weighted = CurveOptions { weight: IterationWeight::Same(1.2), ..geometric() };
    assert!(fit_curve(&points(&wave(9)), &weighted).is_err());
    let flat: Vec<f64> = (0..36).flat_map(|k| [f64::from(k / 6), f64::from(k % 6)]).collect();
    let options =
        SurfaceOptions { method: Method::Geometric { global_start: false }, ..Default::default() };
    let plane = fit_surface(GridView::new([6, 6], 2, &flat).unwrap(), &options);
    assert!(why(plane.unwrap_err()).contains("surfaces 3"));
    let per_direction = SurfaceOptions { per_direction: true, ..options };
    let sheet = sheet([6, 6], 1);
    let refused = fit_surface(GridView::new([6, 6], 3, &sheet).unwrap(), &per_direction);
    assert!(why(refused.unwrap_err()).contains("both directions"));
}

/// A wavy sheet over jittered lines.
fn sheet(shape: [usize; 2], seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut lines =
        |count: usize| -> Vec<f64> { (0..count).map(|i| i as f64 + 0.5 * random.unit()).collect() };
    let (xs, ys) = (lines(shape[0]), lines(shape[1]));
    let mut points = Vec::new();
    for &x in &xs {
        for &y in &ys {
            points.extend([x, y + 0.1 * (0.9 * x).sin(), (0.7 * x).sin() + (0.5 * y).cos()]);
        }
    }
    points
}

fn fit_sheet(shape: [usize; 2], points: &[f64], options: &SurfaceOptions) -> SurfaceFit {
    fit_surface(GridView::new(shape, 3, points).unwrap(), options).unwrap()
}

fn geometric_surface() -> SurfaceOptions {
    SurfaceOptions { method: Method::Geometric { global_start: false }, ..Default::default() }
}

#[test]
fn iterates_of_surfaces_are_those_of_a_search_for_the_foot_points() {
    let shape = [6, 5];
    let data = sheet(shape, 2);
    let options = SurfaceOptions {
        degrees: [3, 2],
        residual: Some(0.0),
        iterations: 3,
        keep: vec![0, 1, 2, 3],
        ..geometric_surface()
    };
    let found = fit_sheet(shape, &data, &options);
    let knots = found.surface.knots();
    let data: Rows = data.chunks(3).map(<[f64]>::to_vec).collect();
    let mut net = Net {
        knots: [knots[0].values(), knots[1].values()],
        degrees: [3, 2],
        shape,
        control: data.clone(),
    };
    let mut pairs: Vec<[f64; 2]> = (0..30)
        .map(|k| [found.parameters[0][k / shape[1]], found.parameters[1][k % shape[1]]])
        .collect();
    for kept in &found.sequence {
        let case = format!("iteration {}", kept.entry.iteration);
        assert!(close(&rows(&kept.control_points), &net.control, 1e-7), "{case}");
        for (k, pair) in pairs.iter_mut().enumerate() {
            let (i, j) = (k / shape[1], k % shape[1]);
            let held = [i == 0 || i + 1 == shape[0], j == 0 || j + 1 == shape[1]];
            *pair = net.foot(&data[k], *pair, held);
        }
        let foot: Rows = pairs.iter().map(|&pair| net.point(pair)).collect();
        for (k, control) in net.control.iter_mut().enumerate() {
            (0..3).for_each(|c| control[c] += data[k][c] - foot[k][c]);
        }
    }
    let foot = found.foot_parameters.unwrap();
    for (pair, expected) in foot.iter().zip(&pairs) {
        assert!((0..2).all(|k| (pair[k] - expected[k]).abs() < 1e-6), "{pair:?} {expected:?}");
    }
}

/// The largest distance of a data point from the surface at its own parameters, by the recursion.
fn textbook_surface_residual(data: &[f64], fit: &SurfaceFit) -> f64 {
    let knots = fit.surface.knots();
    let net = Net {
        knots: [knots[0].values(), knots[1].values()],
        degrees: fit.surface.degrees(),
        shape: fit.surface.control_net().shape(),
        control: rows(fit.surface.control_net().points()),
    };
    let columns = fit.parameters[1].len();
    data.chunks(3).enumerate().fold(0.0, |worst: f64, (k, q)| {
        let pair = fit.foot_parameters.as_ref().map_or_else(
            || [fit.parameters[0][k / columns], fit.parameters[1][k % columns]],
            |pairs| pairs[k],
        );
        let square: f64 = net.point(pair).iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum();
        worst.max(square.sqrt())
    })
}

#[test]
fn limits_of_surfaces_interpolate() {
    let shape = [6, 5];
    let angle = |i: usize, count: usize| std::f64::consts::TAU * i as f64 / count as f64;
    let torus: Vec<f64> = (0..30)
        .map(|k| (angle(k / 5, 6) + 0.05 * (k % 5) as f64, angle(k % 5, 5)))
        .flat_map(|(a, b)| [(3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin()])
        .collect();
    for data in [sheet(shape, 1), torus] {
        for closed in [[false, false], [true, false], [false, true], [true, true]] {
            for degrees in [[3, 3], [1, 2]] {
                let options = SurfaceOptions { closed, degrees, ..geometric_surface() };
                let found = fit_sheet(shape, &data, &options);
                let case = format!("{closed:?} {degrees:?} {:?}", found.report.run.foot_points);
                assert!(found.report.converged(), "{case}");
                let residual = textbook_surface_residual(&data, &found);
                assert!(residual < 3e-12 * found.report.run.extent, "{case}: {residual:e}");
                let fell = found.report.run.foot_points.unwrap().fall_back.is_some();
                assert_eq!(found.foot_parameters.is_none(), fell, "{case}");
            }
        }
    }
}

#[test]
fn the_eigenvalue_of_a_surface_is_that_of_its_matrix() {
    let shape = [6, 7];
    let data = sheet(shape, 3);
    let options = SurfaceOptions { residual: Some(0.0), iterations: 40, ..geometric_surface() };
    let found = fit_sheet(shape, &data, &options);
    let knots = found.surface.knots();
    let basis = |k: usize, i: usize, t: f64| textbook::basis_function(knots[k].values(), 3, i, t);
    let matrix: Rows = found
        .foot_parameters
        .as_ref()
        .unwrap()
        .iter()
        .map(|&[u, v]| (0..42).map(|c| basis(0, c / 7, u) * basis(1, c % 7, v)).collect())
        .collect();
    // The foot points have come to rest, and the spectral radius of I - G with them.
    let mut x: Rows = (0..42).map(|k| vec![f64::from((k * k) % 11) - 4.7]).collect();
    let mut growth = 0.0;
    for _ in 0..200 {
        let y = dense::differences(&matrix, &x, &x);
        growth = y.concat().iter().map(|v| v * v).sum::<f64>().sqrt();
        x = y.iter().map(|row| vec![row[0] / growth]).collect();
    }
    let smallest = found.report.run.smallest_eigenvalue.unwrap();
    assert!((smallest - (1.0 - growth)).abs() < 0.15 * smallest, "{smallest} {}", 1.0 - growth);
}

#[test]
fn a_surface_that_falls_back_ends_at_the_interpolant_of_rows_and_columns() {
    let shape = [8, 7];
    let mut random = Random::new(11);
    // Far too rough for foot points to stay in order.
    let data: Vec<f64> = (0..56)
        .flat_map(|k| [f64::from(k / 7), f64::from(k % 7), 0.0])
        .map(|x| x + 1.5 * random.signed())
        .collect();
    let found = fit_sheet(shape, &data, &geometric_surface());
    let plain = fit_sheet(shape, &data, &SurfaceOptions::default());
    let fall_back = found.report.run.foot_points.unwrap().fall_back.unwrap();
    assert!(matches!(fall_back.reason, FallBackReason::Order { .. }), "{fall_back:?}");
    assert!(found.report.converged() && found.foot_parameters.is_none());
    let (a, b) = (found.surface.control_net().points(), plain.surface.control_net().points());
    assert!(close(&rows(a), &rows(b), 1e-9));
}

#[test]
fn shapes_that_break_the_order_end_in_an_interpolant_all_the_same() {
    let turn = std::f64::consts::TAU;
    let shapes: [(&str, Rows); 7] = [
        ("cusp", (-6..=6).map(|i| f64::from(i) / 6.0).map(|t| vec![t * t, t * t * t]).collect()),
        ("collinear", (0..9).map(|i| vec![f64::from(i * i), 2.0 * f64::from(i * i)]).collect()),
        ("turning back", [0., 3., 1., 4., 2., 5.].iter().map(|&x| vec![x, 0.0]).collect()),
        (
            "spiral",
            (0..60).map(|i| f64::from(i) * 0.3).map(|a| vec![a * a.cos(), a * a.sin()]).collect(),
        ),
        (
            "two laps",
            (0..13).map(|i| turn * f64::from(i) / 6.0).map(|a| vec![a.cos(), a.sin()]).collect(),
        ),
        (
            "wild chords",
            (0..12).map(|i| vec![10f64.powi(i % 5), if i % 2 == 0 { 0.0 } else { 1.0 }]).collect(),
        ),
        (
            "far away",
            (0..20)
                .map(|i| vec![1e9 + 1e-3 * f64::from(i), 1e9 + 1e-3 * f64::from(i * i % 7)])
                .collect(),
        ),
    ];
    for (name, data) in &shapes {
        for closed in [false, true] {
            for degree in [1, 2, 3, 5] {
                let options = CurveOptions { closed, degree, iterations: 4000, ..geometric() };
                let found = match fit_curve(&points(data), &options) {
                    Ok(found) => found,
                    Err(error) => panic!("{name} {closed} {degree}: {error}"),
                };
                let run = &found.report.run;
                let case = format!("{name} {closed} {degree}: {run:?}");
                // Where the interpolant itself swings far beyond the data, the report says so.
                let wild = run.choices.iter().any(|choice| choice.starts_with("caution"));
                assert!(wild || run.termination == Termination::Residual, "{case}");
                let data = &data[..found.report.points].to_vec();
                let largest = dense::largest_norm(&rows(found.curve.control_points()));
                let allowed = run.residual_target.max(1e-13 * largest);
                assert!(textbook_residual(data, &found) <= allowed, "{case}");
                assert!(found.report.max_deviation <= run.max_residual);
            }
        }
    }
    // Equal neighbours are refused as for every method, or taken out.
    let twice =
        vec![vec![0.0, 0.0], vec![1.0, 1.0], vec![1.0, 1.0], vec![2.0, 0.0], vec![3.0, 1.0]];
    assert!(fit_curve(&points(&twice), &geometric()).is_err());
    let dropped = CurveOptions { duplicates: gimfit::Duplicates::Drop, ..geometric() };
    assert!(fit(&twice, &dropped).report.converged());
}

#[test]
fn a_run_repeated_up_to_its_best_step_returns_what_it_reports() {
    // All iterations are run, so that rounding decides which one is the best.
    let data = wave(18);
    let options = CurveOptions { residual: Some(1e-30), ..geometric() };
    let found = fit(&data, &options);
    assert_eq!(found.report.run.termination, Termination::Stalled);
    assert!(found.report.run.iteration_returned < found.report.run.iterations);
    assert!((textbook_residual(&data, &found) - found.report.run.max_residual).abs() < 1e-14);
}

#[test]
fn steps_allocate_nothing() {
    let data = helix(400);
    let rows: Rows = data.chunks(3).map(<[f64]>::to_vec).collect();
    for closed in [false, true] {
        let (operator, _) = operator(&rows, 3, closed);
        let mut state = IterationState::begin(&operator, &data, 3);
        let counted = allocation_counter::measure(|| (0..4).for_each(|_| state.step(&mut Pia)));
        assert_eq!(counted.count_total, 0, "{closed}");
        assert!(!operator.is_fixed() && state.norms().is_finite());
    }
    let shape = [9, 8];
    let data = sheet(shape, 1);
    let lines: Vec<_> = shape
        .map(|n| {
            let t =
                gimfit::parameters::Parameters::open((0..n).map(|i| i as f64).collect()).unwrap();
            let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
            let built = interpolation(&t, &knots).unwrap();
            (t, knots, built)
        })
        .into();
    let [u, v] = [&lines[0], &lines[1]];
    let assigned = TensorCollocation::new(&u.2.operator, &v.2.operator, 3);
    let layout = NetLayout { u: u.2.layout, v: v.2.layout, columns: 8 };
    let knots = [u.1.clone(), v.1.clone()];
    let start = [u.0.values(), v.0.values()];
    let operator =
        SurfaceFootPointCollocation::new(&assigned, layout, knots, start, 3, None).unwrap();
    let mut state = IterationState::begin(&operator, &data, 3);
    let counted = allocation_counter::measure(|| (0..4).for_each(|_| state.step(&mut Pia)));
    assert_eq!(counted.count_total, 0);
    assert!(!operator.is_fixed() && state.norms().is_finite());
}

#[test]
fn a_fall_back_on_the_way_starts_with_a_step_of_pia_at_the_last_good_foot_points() {
    for (seed, count, degree) in [(203, 15, 4), (203, 10, 3), (292, 8, 5), (292, 15, 6)] {
        let data = random_walk(seed, count, 2);
        let run = |keep| fit(&data, &CurveOptions { degree, keep, ..geometric() });
        let fall_back = run(Vec::new()).report.run.foot_points.unwrap().fall_back.unwrap();
        let k = fall_back.iteration;
        assert!(k > 0 && matches!(fall_back.reason, FallBackReason::Order { .. }), "{fall_back:?}");
        let found = run(vec![k - 1, k, k + 1]);
        let knots = found.curve.knots().values();
        let matrix = textbook::collocation_matrix(knots, degree, &found.parameters);
        let [before, at, after] = &found.sequence[..] else { panic!("three fits were asked for") };
        let step = dense::pia_step(&matrix, &data, &rows(&before.control_points));
        assert!(close(&rows(&at.control_points), &step, 1e-12), "{seed}");
        // From there, the interpolant at these parameters.
        let limit = dense::solve(&matrix, &data);
        let size = dense::largest_norm(&limit);
        assert!(close(&rows(&after.control_points), &limit, 1e-11 * size), "{seed}");
        // Parameters did move before they were held.
        assert!(found.report.run.foot_points.unwrap().largest_move > 1e-3);
    }
}

/// Weights that differ by a factor of up to 3.
fn some_weights(count: usize) -> Vec<f64> {
    (0..count).map(|j| 1.0 + 2.0 * ((j * 7 % 11) as f64) / 10.0).collect()
}

#[test]
fn rational_curves_are_interpolated_at_their_foot_points() {
    for bezier in [false, true] {
        let data = wave(if bezier { 7 } else { 30 });
        let options = CurveOptions {
            degree: if bezier { 6 } else { 3 },
            knot_placement: bezier.then_some(gimfit::KnotPlacement::Bezier),
            rational_weights: Some(some_weights(data.len())),
            iterations: 20_000,
            residual: Some(1e-9),
            ..geometric()
        };
        let fit = fit(&data, &options);
        assert!(fit.report.converged(), "{:?}", fit.report.run);
        assert!(fit.curve.rational_weights().is_some());
        // By the definition of a rational curve, which shares no code.
        let weights = fit.curve.rational_weights().unwrap();
        let control: Rows = fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
        let knots = fit.curve.knots().values();
        for (q, &t) in data.iter().zip(&fit.parameters) {
            let at =
                textbook::rational_curve_point(knots, fit.curve.degree(), &control, weights, t);
            assert!(q.iter().zip(&at).all(|(q, c)| (q - c).abs() < 1e-8), "{q:?} {at:?}");
        }
    }
}

#[test]
fn rational_surfaces_are_interpolated_at_their_foot_points() {
    let shape = [7, 8];
    let points = sheet(shape, 5);
    // A product of weights of rows and of columns, and weights that are none.
    let product: Vec<f64> =
        (0..56).map(|k| (1.0 + 0.1 * (k / 8) as f64) * (1.0 + 0.05 * (k % 8) as f64)).collect();
    for weights in [product, some_weights(56)] {
        let options = SurfaceOptions {
            rational_weights: Some(weights),
            iterations: 20_000,
            residual: Some(1e-9),
            ..geometric_surface()
        };
        let fit = fit_sheet(shape, &points, &options);
        assert!(fit.report.converged(), "{:?}", fit.report.run);
        for k in 0..56 {
            let [u, v] = match &fit.foot_parameters {
                Some(pairs) => pairs[k],
                None => [fit.parameters[0][k / 8], fit.parameters[1][k % 8]],
            };
            let at = fit.surface.evaluate(u, v).unwrap();
            let gap =
                at.iter().zip(&points[3 * k..]).map(|(s, q)| (s - q).abs()).fold(0.0, f64::max);
            assert!(gap < 1e-8, "{k}: {gap}");
        }
    }
}

#[test]
fn a_global_start_ends_at_an_interpolant_and_is_the_local_one_where_nothing_is_nearer() {
    let data = wave(25);
    let near = fit(&data, &geometric());
    let options =
        CurveOptions { method: Method::Geometric { global_start: true }, ..Default::default() };
    let all = fit(&data, &options);
    assert!(all.report.converged());
    let gap = near.parameters.iter().zip(&all.parameters).map(|(a, b)| (a - b).abs());
    assert!(gap.fold(0.0, f64::max) < 1e-6);
    // A curve that crosses itself: the nearest point may be of another branch, the order is then
    // lost, and the run says so and ends at an interpolant all the same.
    let crossing = fit(&lemniscate(), &CurveOptions { closed: true, ..options });
    assert!(crossing.report.converged(), "{:?}", crossing.report.run);
    let shape = [6, 7];
    let points = sheet(shape, 3);
    let method = Method::Geometric { global_start: true };
    let surface = fit_sheet(shape, &points, &SurfaceOptions { method, ..Default::default() });
    assert!(surface.report.converged());
}
