//! Laws of local and adaptive PIA.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::collocation::{CollocationMatrix, interpolation, smallest_eigenvalue};
use gimfit::knots::place_knots;
use gimfit::parameters::assign_parameters;
use gimfit::{
    Convexity, CurveOptions, Duplicates, GridView, KnotPlacement, Method, Parameterization, Points,
    PointsView, SurfaceOptions, fit_curve, fit_surface,
};
use gimfit_testkit::adaptive::adaptive_pia;
use gimfit_testkit::generate::{Random, random_walk};
use gimfit_testkit::{dense, textbook};

fn subset(random: &mut Random, count: usize) -> Vec<usize> {
    let mut points: Vec<usize> = (0..count).filter(|_| random.unit() < 0.4).collect();
    points.push(count / 2);
    points
}

#[test]
fn the_local_limit_interpolates_the_chosen_points_and_moves_no_other() {
    let mut random = Random::new(5);
    for (seed, degree) in [(1, 2), (2, 3), (3, 3), (4, 4)] {
        let rows = random_walk(seed, 30, 2);
        let data = Points::new(2, rows.concat()).unwrap();
        let chosen = subset(&mut random, 30);
        for method in [Method::Local, Method::Weighted, Method::GaussSeidel, Method::Auto] {
            let options = CurveOptions {
                degree,
                method,
                local: Some(chosen.clone()),
                iterations: 50_000,
                ..Default::default()
            };
            let fit = fit_curve(&data, &options).unwrap();
            assert!(fit.report.converged(), "{method:?} {degree}");
            let control: dense::Rows =
                fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
            let knots = fit.curve.knots().values();
            let mut worst = 0.0_f64;
            for j in 0..30 {
                let at = textbook::curve_point(knots, degree, &control, fit.parameters[j]);
                let gap = (at[0] - rows[j][0]).hypot(at[1] - rows[j][1]);
                if chosen.contains(&j) {
                    assert!(gap <= 1e-10, "{method:?} {degree} point {j}: {gap:e}");
                } else {
                    worst = worst.max(gap);
                    assert_eq!(control[j], rows[j]);
                }
            }
            let local = fit.report.run.local.unwrap();
            assert!((local.outside_max_residual - worst).abs() <= 1e-12 * worst.max(1.0));
        }
    }
}

/// Weights of rational curves from `1 / most` to `most`.
fn rational_weights(count: usize, most: f64) -> Vec<f64> {
    let mut random = Random::new(21);
    (0..count).map(|_| most.powf(random.signed())).collect()
}

#[test]
fn local_pia_of_a_rational_curve_is_that_of_the_part_of_its_full_matrix() {
    let (rows, weights) = (random_walk(4, 20, 2), rational_weights(20, 3.0));
    let data = Points::new(2, rows.concat()).unwrap();
    let chosen = [2, 3, 4, 9, 10, 17];
    for degree in [2, 3, 5] {
        let options = CurveOptions {
            degree,
            method: Method::Local,
            local: Some(chosen.to_vec()),
            rational_weights: Some(weights.clone()),
            iterations: 12,
            residual: Some(0.0),
            keep: (0..=12).collect(),
            ..Default::default()
        };
        let fit = fit_curve(&data, &options).unwrap();
        let knots = fit.curve.knots().values();
        let mut matrix = textbook::collocation_matrix(knots, degree, &fit.parameters);
        for row in &mut matrix {
            row.iter_mut().zip(&weights).for_each(|(x, w)| *x *= w);
            let sum: f64 = row.iter().sum();
            row.iter_mut().for_each(|x| *x /= sum);
        }
        let mut control = rows.clone();
        for kept in &fit.sequence {
            for (ours, theirs) in kept.control_points.iter().zip(&control) {
                assert!((ours[0] - theirs[0]).hypot(ours[1] - theirs[1]) < 1e-12, "{degree}");
            }
            control = dense::local_pia_step(&matrix, &rows, &control, &chosen);
        }
        assert_eq!(fit.sequence.len(), 13);
        // To the limit, by every kind of rule.
        for method in [Method::Local, Method::Auto, Method::Sor, Method::Adaptive] {
            let long = CurveOptions {
                method,
                iterations: 100_000,
                residual: Some(1e-10),
                keep: Vec::new(),
                ..options.clone()
            };
            let fit = fit_curve(&data, &long).unwrap();
            assert!(fit.report.converged(), "{method:?} {degree}");
            let control: dense::Rows =
                fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
            for (j, row) in rows.iter().enumerate() {
                let t = fit.parameters[j];
                let at = textbook::rational_curve_point(knots, degree, &control, &weights, t);
                let gap = (at[0] - row[0]).hypot(at[1] - row[1]);
                assert!(gap <= 1.1e-10 || !chosen.contains(&j), "{method:?} {degree} {j}: {gap:e}");
                assert!(chosen.contains(&j) || control[j] == *row);
            }
        }
    }
}

#[test]
fn a_part_of_the_matrix_has_no_smaller_eigenvalue() {
    let mut random = Random::new(9);
    let data = Points::new(2, random_walk(7, 25, 2).concat()).unwrap();
    let t = assign_parameters(data.as_view(), false, &Parameterization::Chord).unwrap();
    for degree in [2, 3, 5] {
        let knots = place_knots(degree, &t, &KnotPlacement::Averaged).unwrap();
        let whole = interpolation(&t, &knots).unwrap().operator;
        let least = smallest_eigenvalue(&whole.factor(None).unwrap());
        for _ in 0..20 {
            let chosen = subset(&mut random, 25);
            let part = smallest_eigenvalue(&whole.restricted(&chosen).factor(None).unwrap());
            assert!(part.upper >= least.lower * (1.0 - 1e-9), "{degree}: {part:?} {least:?}");
        }
    }
}

#[test]
fn adaptive_pia_ends_with_every_residual_met_and_spares_moves() {
    for degree in 1..=5 {
        for (closed, rational) in [(false, false), (true, false), (false, true), (true, true)] {
            let data = Points::new(2, random_walk(3, 60, 2).concat()).unwrap();
            let options = CurveOptions {
                degree,
                closed,
                // Plain PIA of rational quintics through these points would stall itself.
                rational_weights: (rational && degree < 5).then(|| rational_weights(60, 1.3)),
                method: Method::Adaptive,
                residual: Some(1e-4),
                iterations: 20_000,
                ..Default::default()
            };
            let fit = fit_curve(&data, &options).unwrap();
            assert!(fit.report.converged(), "{degree} {closed} {}", fit.report.run.termination);
            assert!(fit.residuals().iter().all(|r| *r <= 1e-4));
            let counts = fit.report.run.updates.unwrap();
            assert_eq!(counts.done + counts.saved, 60 * fit.report.run.iterations);
            assert!(degree == 1 || counts.saved > 0, "{degree} {closed} {counts:?}");
        }
    }
}

fn waves(rows: usize, columns: usize) -> Vec<f64> {
    let cell = |k: usize| {
        let (x, y) = ((k / columns) as f64, (k % columns) as f64);
        [x, y + 0.2 * (0.5 * x * y).sin(), (0.7 * x).sin() * (0.9 * y).cos()]
    };
    (0..rows * columns).flat_map(cell).collect()
}

#[test]
fn adaptive_pia_of_grids_ends_with_every_residual_met_and_spares_moves() {
    let points = waves(12, 9);
    let grid = GridView::new([12, 9], 3, &points).unwrap();
    for degrees in [[1, 3], [3, 3], [2, 5]] {
        let options = SurfaceOptions {
            degrees,
            method: Method::Adaptive,
            per_direction: false,
            residual: Some(1e-5),
            iterations: 20_000,
            ..Default::default()
        };
        let fit = fit_surface(grid, &options).unwrap();
        assert!(fit.report.converged(), "{degrees:?} {}", fit.report.run.termination);
        let plain = SurfaceOptions { method: Method::Pia, residual: Some(1e-9), ..options };
        let limit = fit_surface(grid, &plain).unwrap();
        let knots = fit.surface.knots().each_ref().map(|knots| knots.values().to_vec());
        assert_eq!(knots, limit.surface.knots().each_ref().map(|knots| knots.values().to_vec()));
        assert!(fit.residuals().iter().all(|r| *r <= 1e-5));
        let counts = fit.report.run.updates.unwrap();
        assert_eq!(counts.done + counts.saved, 108 * fit.report.run.iterations);
        assert!(counts.saved > 0, "{degrees:?} {counts:?}");
    }
}

#[test]
fn what_cannot_be_done_is_refused_with_the_reason() {
    let points = waves(6, 6);
    let grid = GridView::new([6, 6], 3, &points).unwrap();
    let options =
        SurfaceOptions { method: Method::Adaptive, per_direction: true, ..Default::default() };
    let error = fit_surface(grid, &options).unwrap_err().to_string();
    assert!(error.contains("cannot be used with"), "{error}");
    let data = Points::new(2, random_walk(1, 12, 2).concat()).unwrap();
    let refused = |options: CurveOptions| fit_curve(&data, &options).unwrap_err().to_string();
    let with = |local: Option<Vec<usize>>| CurveOptions { local, ..Default::default() };
    assert!(
        refused(CurveOptions { method: Method::Local, ..with(None) }).contains("name the points")
    );
    assert!(refused(with(Some(vec![]))).contains("at least one"));
    assert!(refused(with(Some(vec![3, 12]))).contains("12"));
    let convex = CurveOptions { convexity: Some(Convexity::Closest), ..with(Some(vec![3])) };
    assert!(refused(convex).contains("convexity"));
    let adaptive =
        CurveOptions { method: Method::Adaptive, residual: Some(0.0), ..Default::default() };
    assert!(refused(adaptive).contains("above 0"));
}

/// Table 2.4 of a thesis of 2021: 21 points of a lemniscate, knots at the data.
#[test]
fn the_published_trace_of_adaptive_pia() {
    let rows: dense::Rows = (0..21)
        .map(|k| std::f64::consts::TAU * f64::from(k) / 20.0)
        .map(|s| vec![s.cos(), s.sin() * s.cos()])
        .collect();
    let data = Points::new(2, rows.concat()).unwrap();
    let options = |method| CurveOptions {
        method,
        parameterization: Some(Parameterization::Uniform),
        knot_placement: Some(KnotPlacement::AtData),
        residual: Some(1e-5),
        ..Default::default()
    };
    let plain = fit_curve(&data, &options(Method::Pia)).unwrap();
    let largest: Vec<String> = plain
        .report
        .run
        .history
        .iter()
        .map(|entry| format!("{:.5e}", entry.max_residual))
        .collect();
    assert_eq!(largest[..3], ["4.46889e-2", "1.32064e-2", "5.82997e-3"]);
    assert_eq!(plain.report.run.iterations, 15);

    // Rounds take 21 steps. With the columns one place off, as in the program published with the thesis,
    // the bound is void: the 18 steps printed, 156 moves (printed 150), and points that are not looked at
    // again end at four times the residual asked for.
    let knots = plain.curve.knots().values();
    let matrix: dense::Rows = textbook::collocation_matrix(knots, 3, &plain.parameters)
        .into_iter()
        .map(|row| {
            let mut tied = row[1..22].to_vec();
            (tied[0], tied[20]) = (tied[0] + row[0], tied[20] + row[22]);
            tied
        })
        .collect();
    let rounds = |shift| adaptive_pia(&matrix, &rows, 1e-5, shift);
    assert_eq!((rounds(0).steps, rounds(0).moves), (21, 166));
    assert_eq!(format!("{:.4e}", rounds(0).residual), "8.1826e-6");
    assert_eq!((rounds(1).steps, rounds(1).moves), (18, 156));
    assert_eq!(format!("{:.4e}", rounds(1).residual), "3.9692e-5");

    let ours = fit_curve(&data, &options(Method::Adaptive)).unwrap().report.run;
    assert!(ours.converged() && ours.max_residual <= 1e-5);
    assert_eq!((ours.iterations, ours.updates.unwrap().done), (15, 182));
}

/// The same points, one of them repeated, and a closed one with its first point again at the end.
#[test]
fn positions_are_those_of_the_array_given() {
    let rows = random_walk(6, 12, 2);
    let fit = |rows: &[Vec<f64>], local: Vec<usize>, closed| {
        let options = CurveOptions {
            local: Some(local),
            closed,
            duplicates: Duplicates::Drop,
            ..Default::default()
        };
        let fit = fit_curve(&Points::new(2, rows.concat()).unwrap(), &options).unwrap();
        fit.curve.control_points().clone()
    };
    let mut repeated = rows.clone();
    repeated.insert(4, rows[3].clone());
    assert_eq!(fit(&rows, vec![3, 7], false), fit(&repeated, vec![4, 8], false));
    assert_eq!(fit(&rows, vec![11], false), fit(&repeated, vec![12], false));
    for mut seamed in [rows.clone(), repeated] {
        seamed.push(rows[0].clone());
        let last = seamed.len() - 1;
        assert_eq!(fit(&rows, vec![0], true), fit(&seamed, vec![last], true));
    }
}

#[test]
fn no_choice_of_points_makes_a_fit_panic_or_tell_no_number() {
    let hostile = [f64::NAN, 1e300, -1e300, 1e-300, 0.0, 1e9 + 0.25, 1.0, f64::INFINITY];
    let mut random = Random::new(77);
    for round in 0..400 {
        let count = (random.unit() * 9.0) as usize;
        let dimension = [1, 2, 3, 7][round % 4];
        let wild = random.unit() < 0.5;
        let value = |random: &mut Random| {
            if wild && random.unit() < 0.2 {
                hostile[(random.unit() * 7.99) as usize]
            } else {
                (random.unit() * 8.0).floor()
            }
        };
        let coordinates: Vec<f64> = (0..count * dimension).map(|_| value(&mut random)).collect();
        let Ok(data) = PointsView::new(dimension, &coordinates) else { continue };
        let local = (random.unit() < 0.7)
            .then(|| (0..3).map(|_| (random.unit() * 10.0) as usize).collect());
        let methods = [Method::Local, Method::Adaptive, Method::Auto, Method::Chebyshev];
        let options = CurveOptions {
            degree: 1 + round % 5,
            closed: random.unit() < 0.4,
            method: methods[(random.unit() * 3.99) as usize],
            local,
            iterations: 200,
            duplicates: [Duplicates::Drop, Duplicates::Error, Duplicates::Merge][round % 3],
            ..Default::default()
        };
        if let Ok(fit) = fit_curve(data, &options) {
            assert!(fit.report.run.max_residual.is_finite());
            let local = fit.report.run.local.as_ref();
            assert!(local.is_none_or(|local| local.outside_max_residual.is_finite()));
            let control = fit.curve.control_points();
            assert!(control.coordinates().iter().all(|x| x.is_finite()));
        }
    }
}
