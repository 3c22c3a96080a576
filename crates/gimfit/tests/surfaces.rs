//! Laws of surface fits, judged by dense oracles that share no code with the library.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    Error, GridView, IterationWeight, KnotPlacement, Method, Parameterization, SurfaceFit,
    SurfaceOptions, SurfaceWeight, Termination, fit_surface,
};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::generate::Random;
use gimfit_testkit::textbook::basis_function;

/// A wavy sheet over jittered lines.
fn sheet(shape: [usize; 2], seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let lines = |count: usize, random: &mut Random| -> Vec<f64> {
        (0..count).map(|i| i as f64 + 0.5 * random.unit()).collect()
    };
    let (xs, ys) = (lines(shape[0], &mut random), lines(shape[1], &mut random));
    let mut points = Vec::new();
    for &x in &xs {
        for &y in &ys {
            points.extend([x, y + 0.1 * (0.9 * x).sin(), (0.7 * x).sin() + (0.5 * y).cos()]);
        }
    }
    points
}

fn torus(shape: [usize; 2]) -> Vec<f64> {
    let angle = |i: usize, count: usize| std::f64::consts::TAU * i as f64 / count as f64;
    let mut points = Vec::new();
    for i in 0..shape[0] {
        for j in 0..shape[1] {
            let (a, b) = (angle(i, shape[0]), angle(j, shape[1]));
            points.extend([(3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin()]);
        }
    }
    points
}

fn fit(shape: [usize; 2], points: &[f64], options: &SurfaceOptions) -> SurfaceFit {
    fit_surface(GridView::new(shape, 3, points).unwrap(), options).unwrap()
}

/// The largest distance of a data point from the surface at its parameters, by the recursion.
fn textbook_residual(points: &[f64], fit: &SurfaceFit) -> f64 {
    let knots = fit.surface.knots();
    let [p, q] = fit.surface.degrees();
    let [n_u, n_v] = fit.surface.control_net().shape();
    let mut worst: f64 = 0.0;
    for (i, &u) in fit.parameters[0].iter().enumerate() {
        let b_u: Vec<f64> = (0..n_u).map(|a| basis_function(knots[0].values(), p, a, u)).collect();
        for (j, &v) in fit.parameters[1].iter().enumerate() {
            let mut gap = points[(i * fit.parameters[1].len() + j) * 3..][..3].to_vec();
            for b in 0..n_v {
                let weight = basis_function(knots[1].values(), q, b, v);
                for (a, b_u) in b_u.iter().enumerate() {
                    let control = fit.surface.control_net().point(a, b);
                    (0..3).for_each(|c| gap[c] -= weight * b_u * control[c]);
                }
            }
            worst = worst.max(gap.iter().map(|x| x * x).sum::<f64>().sqrt());
        }
    }
    worst
}

#[test]
fn the_limit_interpolates_for_all_degrees_knots_and_boundaries() {
    let shape = [9, 8];
    let points = sheet(shape, 1);
    for degrees in [[1, 1], [2, 3], [3, 3], [4, 2], [5, 3]] {
        for closed in [[false, false], [true, false], [false, true], [true, true]] {
            for per_direction in [false, true] {
                let options =
                    SurfaceOptions { degrees, closed, per_direction, ..Default::default() };
                let found = fit(shape, &points, &options);
                let case = format!("{degrees:?} {closed:?} {per_direction}");
                assert!(found.report.converged(), "{case}: {:?}", found.report);
                assert!(textbook_residual(&points, &found) < 1e-11, "{case}");
            }
        }
    }
}

#[test]
fn iterates_are_those_of_the_dense_kronecker_product() {
    let shape = [6, 7];
    let points = sheet(shape, 2);
    let options = SurfaceOptions {
        method: Method::Pia,
        residual: Some(0.0),
        iterations: 8,
        keep: vec![0, 3, 8],
        ..Default::default()
    };
    let found = fit(shape, &points, &options);
    let knots = found.surface.knots();
    let collocation = |k: usize| -> Rows {
        found.parameters[k]
            .iter()
            .map(|&t| (0..shape[k]).map(|i| basis_function(knots[k].values(), 3, i, t)).collect())
            .collect()
    };
    let kronecker = dense::kronecker(&collocation(0), &collocation(1));
    let data: Rows = points.chunks(3).map(<[f64]>::to_vec).collect();
    let expected = dense::residual_history(&kronecker, &data, dense::pia_step, 8);
    for (entry, expected) in found.report.run.history.iter().zip(&expected) {
        assert!((entry.max_residual - expected).abs() < 1e-12);
    }
    let mut p = data.clone();
    for step in 0..=8 {
        if let Some(kept) = found.sequence.iter().find(|kept| kept.entry.iteration == step) {
            for (a, b) in kept.control_points.coordinates().iter().zip(p.concat()) {
                assert!((a - b).abs() < 1e-11, "{step}");
            }
        }
        p = dense::pia_step(&kronecker, &data, &p);
    }
    assert_eq!(found.sequence.len(), 3);
}

#[test]
fn every_method_reaches_the_same_limit() {
    let shape = [12, 10];
    // Rough heights, so that every mode has to be met.
    let mut points = sheet(shape, 3);
    let mut random = Random::new(33);
    points.chunks_mut(3).for_each(|point| point[2] += random.signed());
    for closed in [[false, false], [false, true]] {
        let base = SurfaceOptions { closed, iterations: 20_000, ..Default::default() };
        let limit = fit(shape, &points, &base);
        let mut steps = Vec::new();
        for per_direction in [false, true] {
            for method in [
                Method::Pia,
                Method::Weighted,
                Method::Jacobi,
                Method::GaussSeidel,
                Method::Sor,
                Method::Chebyshev,
                Method::Anderson { memory: None },
                Method::Preconditioned { half_bandwidth: Some(1) },
            ] {
                // Over-relaxation is refused for a whole net; Jacobi's eigenvalues reach 1.5 in each
                // direction, thus 2.25 for both, and diverge.
                if matches!(method, Method::Sor | Method::Jacobi) && !per_direction {
                    continue;
                }
                let options = SurfaceOptions { method, per_direction, ..base.clone() };
                let found = fit(shape, &points, &options);
                assert!(found.report.converged(), "{method:?} {per_direction}");
                let control = |fit: &SurfaceFit| fit.surface.control_net().points().clone();
                let gap = control(&found)
                    .coordinates()
                    .iter()
                    .zip(control(&limit).coordinates())
                    .fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
                assert!(gap < 1e-8, "{method:?} {per_direction}: {gap:e}");
                steps.push((method, per_direction, found.report.run.iterations));
            }
        }
        let count = |method, per_direction| {
            steps.iter().find(|s| s.0 == method && s.1 == per_direction).unwrap().2
        };
        // One direction after the other takes far fewer steps, each half as dear.
        assert!(count(Method::Pia, true) < count(Method::Pia, false));
        assert!(count(Method::Weighted, true) < count(Method::Weighted, false));
    }
}

#[test]
fn the_surface_of_the_2004_paper_has_its_published_errors() {
    // Lin, Wang and Dong (2004), Fig. 6 and Table 1: MATLAB's peaks on an 11 x 11 grid, knots at
    // the data with tied ends, chord lengths averaged over the grid, plain PIA. The entry for no
    // iteration is the sum of the norms, all others are their maximum.
    let mut points = Vec::new();
    for i in 0..11 {
        for j in 0..11 {
            let (x, y) = (-3.0 + 0.6 * f64::from(i), -3.0 + 0.6 * f64::from(j));
            let z = 3.0 * (1.0 - x).powi(2) * (-x * x - (y + 1.0).powi(2)).exp()
                - 10.0 * (x / 5.0 - x.powi(3) - y.powi(5)) * (-x * x - y * y).exp()
                - (-(x + 1.0).powi(2) - y * y).exp() / 3.0;
            points.extend([x, y, z]);
        }
    }
    let at_data = || Some(KnotPlacement::AtData);
    let options = |iterations| SurfaceOptions {
        knot_placements: [at_data(), at_data()],
        method: Method::Pia,
        residual: Some(0.0),
        iterations,
        ..Default::default()
    };
    let start = fit([11, 11], &points, &options(0));
    let sum: f64 = start.residuals().iter().sum();
    assert!((sum - 3.362778e1).abs() < 5e-6, "{sum}");
    let found = fit([11, 11], &points, &options(30));
    let printed = [
        (2, 3.5526e-1, 5e-6),
        (3, 2.422128e-1, 5e-8),
        (4, 1.7233e-1, 5e-6),
        (15, 1.528187e-2, 5e-9),
        (30, 1.2695e-3, 5e-7),
    ];
    for (iteration, expected, half_unit) in printed {
        let residual = found.report.run.history[iteration].max_residual;
        // The paper cuts digits off in places: one unit of the last, rather than half of one.
        assert!((residual - expected).abs() <= 2.0 * half_unit, "{iteration}: {residual:e}");
    }
    assert_eq!(found.surface.control_net().shape(), [13, 13]);
}

#[test]
fn closed_surfaces_are_smooth_across_their_seams() {
    let shape = [14, 11];
    let options = SurfaceOptions { closed: [true, true], ..Default::default() };
    let found = fit(shape, &torus(shape), &options);
    let [(u0, u1), (v0, v1)] = found.surface.domain();
    let jet = |u: f64, v: f64| {
        let mut jet = [0.0; 27];
        found.surface.derivatives_into(u, v, 2, &mut jet).unwrap();
        jet
    };
    for share in [0.1, 0.37, 0.8] {
        let (u, v) = (u0 + share * (u1 - u0), v0 + share * (v1 - v0));
        for (a, b) in [(jet(u0, v), jet(u1, v)), (jet(u, v0), jet(u, v1))] {
            for (a, b) in a.iter().zip(b) {
                assert!((a - b).abs() < 1e-7 * a.abs().max(100.0), "{a} {b}");
            }
        }
    }
    // The torus itself is met between the data too.
    for i in 0..40 {
        let point = found
            .surface
            .evaluate(
                u0 + (u1 - u0) * f64::from(i) / 40.0,
                v0 + (v1 - v0) * f64::from(i * 7 % 40) / 40.0,
            )
            .unwrap();
        let ring = point[0].hypot(point[1]) - 3.0;
        assert!((ring.hypot(point[2]) - 1.0).abs() < 0.01, "{point:?}");
    }
    // Repeating the first row and column at the end changes nothing.
    let open = torus(shape);
    let mut repeated = Vec::new();
    for i in 0..=shape[0] {
        for j in 0..=shape[1] {
            let at = (i % shape[0]) * shape[1] + j % shape[1];
            repeated.extend(&open[at * 3..][..3]);
        }
    }
    let again = fit([15, 12], &repeated, &options);
    assert_eq!(again.surface, found.surface);
}

#[test]
fn derivatives_agree_with_differences() {
    let shape = [8, 9];
    let found = fit(shape, &sheet(shape, 4), &SurfaceOptions::default());
    let at = |u, v| found.surface.evaluate(u, v).unwrap();
    let (u, v, h) = (0.41, 0.63, 1e-5);
    let mut jet = [0.0; 12];
    found.surface.derivatives_into(u, v, 1, &mut jet).unwrap();
    for c in 0..3 {
        let by_u = (at(u + h, v)[c] - at(u - h, v)[c]) / (2.0 * h);
        let by_v = (at(u, v + h)[c] - at(u, v - h)[c]) / (2.0 * h);
        assert!((jet[6 + c] - by_u).abs() < 1e-5 && (jet[3 + c] - by_v).abs() < 1e-5);
    }
}

#[test]
fn refusals_name_rows_and_columns() {
    let shape = [5, 6];
    let points = sheet(shape, 5);
    let run = |points: &[f64], options: &SurfaceOptions| {
        fit_surface(GridView::new(shape, 3, points).unwrap(), options).unwrap_err()
    };
    let mut doubled = points.clone();
    doubled.copy_within(36..54, 54);
    assert_eq!(
        run(&doubled, &SurfaceOptions::default()),
        Error::RepeatedLines { what: "row", first: 2, second: 3 }
    );
    let steep = SurfaceOptions { degrees: [3, 6], ..Default::default() };
    assert!(matches!(run(&points, &steep), Error::TooFewLines { what: "columns", .. }));
    let mut broken = points.clone();
    broken[3 * 8 + 1] = f64::NAN;
    assert!(matches!(
        run(&broken, &SurfaceOptions::default()),
        Error::NotFinite { point: 8, coordinate: 1, .. }
    ));
    assert!(GridView::new([5, 7], 3, &points).is_err());
    let sor = SurfaceOptions { method: Method::Sor, ..Default::default() };
    assert!(matches!(run(&points, &sor), Error::Incompatible { .. }));
}

#[test]
fn collapsed_edges_and_heights_are_fitted() {
    // A cap whose first row is one point, as scanners write poles.
    let mut cap = Vec::new();
    for i in 0..7 {
        for j in 0..9 {
            let (a, b) = (f64::from(i) * 0.2, f64::from(j) * 0.3);
            cap.extend([a.sin() * b.cos(), a.sin() * b.sin(), a.cos()]);
        }
    }
    let found = fit([7, 9], &cap, &SurfaceOptions::default());
    assert!(found.report.converged() && textbook_residual(&cap, &found) < 1e-12);
    let heights: Vec<f64> = (0..40).map(|i| f64::from(i * i % 17)).collect();
    let view = GridView::new([5, 8], 1, &heights).unwrap();
    let axis = |count: i32| Some(Parameterization::Given((0..count).map(f64::from).collect()));
    let options = SurfaceOptions { parameterizations: [axis(5), axis(8)], ..Default::default() };
    let found = fit_surface(view, &options).unwrap();
    assert_eq!(found.report.run.termination, Termination::Residual);
    assert!((found.surface.evaluate(2.0, 3.0).unwrap()[0] - heights[19]).abs() < 1e-12);
}

#[test]
fn the_deviation_is_measured_at_foot_points() {
    let shape = [9, 9];
    let points = sheet(shape, 6);
    let options = SurfaceOptions {
        method: Method::Pia,
        iterations: 2,
        residual: Some(0.0),
        ..Default::default()
    };
    let found = fit(shape, &points, &options);
    let report = &found.report;
    assert!(report.max_deviation > 0.0 && report.max_deviation < report.run.max_residual);
    // A fine search around the point named finds nothing nearer.
    let [i, j] = report.max_deviation_index;
    let point = &points[(i * 9 + j) * 3..][..3];
    let mut least = f64::INFINITY;
    for a in 0..=600 {
        for b in 0..=600 {
            let s = found.surface.evaluate(f64::from(a) / 600.0, f64::from(b) / 600.0).unwrap();
            let gap: f64 = s.iter().zip(point).map(|(s, q)| (s - q) * (s - q)).sum();
            least = least.min(gap.sqrt());
        }
    }
    let deviation = report.max_deviation;
    assert!(deviation <= least && least < deviation + 2e-3, "{deviation} {least}");
}

#[test]
fn a_member_of_a_family_is_the_fit_of_a_run_that_stopped_there() {
    let shape = [9, 8];
    for (closed, scale) in [([false, false], 1.0), ([true, true], 1.0), ([true, false], 1e200)] {
        let points: Vec<f64> = torus(shape).iter().map(|x| scale * x).collect();
        let options = SurfaceOptions {
            closed,
            method: Method::Pia,
            iterations: 12,
            residual: Some(0.0),
            keep: vec![0, 4, 12],
            ..Default::default()
        };
        let whole = fit(shape, &points, &options);
        for k in [0, 4, 12] {
            let short = fit(
                shape,
                &points,
                &SurfaceOptions { iterations: k, keep: vec![], ..options.clone() },
            );
            let member = whole.member(k).unwrap();
            assert_eq!(member.surface, short.surface);
            assert_eq!(member.parameters, short.parameters);
            assert!(member.sequence.is_empty());
            let (ours, theirs) = (&member.report, &short.report);
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-13 * scale * 4.0;
            assert!(near(ours.run.max_residual, theirs.run.max_residual), "{k}");
            assert!(near(ours.run.rms_residual, theirs.run.rms_residual), "{k}");
            assert!((ours.max_deviation - theirs.max_deviation).abs() <= 1e-8 * scale, "{k}");
            assert_eq!(ours.run.history, theirs.run.history);
            assert_eq!((ours.run.iterations, ours.run.iteration_returned), (k, k));
            let gaps = member.difference_vectors.coordinates().iter();
            assert!(gaps.zip(short.difference_vectors.coordinates()).all(|(a, b)| near(*a, *b)));
        }
        assert_eq!(whole.member(5), Err(Error::NotKept { iteration: 5, kept: vec![0, 4, 12] }));
    }
}

#[test]
fn weights_per_direction_are_those_of_curves() {
    let shape = [8, 9];
    let points = sheet(shape, 7);
    let run = |weight: SurfaceWeight| {
        let options = SurfaceOptions {
            method: Method::Weighted,
            per_direction: true,
            iterations: 5,
            residual: Some(0.0),
            weight,
            ..Default::default()
        };
        fit_surface(GridView::new(shape, 3, &points).unwrap(), &options)
    };
    let (u, v) = (1.3, 0.8);
    let pair = |u, v| SurfaceWeight::PerDirection([u, v]);
    let each = run(pair(IterationWeight::Same(u), IterationWeight::Same(v))).unwrap();
    let lists = run(pair(
        IterationWeight::PerPoint(vec![u; shape[0]]),
        IterationWeight::PerPoint(vec![v; shape[1]]),
    ));
    assert_eq!(each.surface, lists.unwrap().surface);
    let same = run(IterationWeight::Same(u).into()).unwrap();
    assert_eq!(
        same.surface,
        run(pair(IterationWeight::Same(u), IterationWeight::Same(u))).unwrap().surface
    );
    assert_ne!(same.surface, each.surface);
    // The columns of the first stage are curves: their history is that of one with its weight.
    let stages = each.report.stages.as_ref().unwrap();
    let column: Vec<f64> =
        (0..shape[0]).flat_map(|i| points[i * shape[1] * 3..][..3].to_vec()).collect();
    let knots = each.surface.knots()[0].clone();
    let parameters = gimfit::parameters::Parameters::open(each.parameters[0].clone()).unwrap();
    let options = gimfit::CurveOptions {
        method: Method::Weighted,
        weight: IterationWeight::Same(u),
        iterations: 5,
        residual: Some(0.0),
        ..Default::default()
    };
    let view = gimfit::PointsView::new(3, &column).unwrap();
    let curve = gimfit::fit::interpolate(view, parameters, knots, &options).unwrap();
    for (stage, curve) in stages[0].iter().zip(&curve.report.run.history) {
        assert!(stage.max_residual >= curve.max_residual - 1e-13);
    }
    assert_eq!((stages[0].len(), stages[1].len()), (6, 6));
    // A net that moves as a whole has one weight; a list is as long as its direction.
    let whole = SurfaceOptions {
        method: Method::Weighted,
        weight: pair(IterationWeight::Auto, IterationWeight::Auto),
        ..Default::default()
    };
    let view = GridView::new(shape, 3, &points).unwrap();
    assert!(matches!(fit_surface(view, &whole), Err(Error::Incompatible { .. })));
    let short = pair(IterationWeight::PerPoint(vec![1.0; shape[1]]), IterationWeight::Auto);
    assert!(matches!(run(short), Err(Error::WrongCount { given: 9, expected: 8, .. })));
}

#[test]
fn jacobi_on_a_whole_net_runs_where_its_eigenvalues_allow_it() {
    let shape = [14, 13];
    let points = sheet(shape, 8);
    let run = |degrees| {
        let options = SurfaceOptions { degrees, method: Method::Jacobi, ..Default::default() };
        fit_surface(GridView::new(shape, 3, &points).unwrap(), &options)
    };
    // Below 1.5 in each direction for cubics, 4/3 for quadratics, 1 for lines.
    for degrees in [[1, 1], [1, 3], [2, 2]] {
        assert!(run(degrees).unwrap().report.converged(), "{degrees:?}");
    }
    assert!(matches!(run([3, 3]), Err(Error::Incompatible { what: "jacobi", .. })));
    assert!(matches!(run([5, 5]), Err(Error::Incompatible { what: "jacobi", .. })));
}

#[test]
fn the_same_bytes_come_out_of_any_number_of_threads() {
    // Large enough to be shared out; neither side a multiple of what is taken at a time.
    let shape = [151, 149];
    let points = sheet(shape, 9);
    for closed in [[false, false], [true, true]] {
        for method in [Method::Auto, Method::Preconditioned { half_bandwidth: Some(1) }] {
            let options = SurfaceOptions {
                closed,
                method,
                iterations: 2,
                residual: Some(0.0),
                ..Default::default()
            };
            let run = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| fit(shape, &points, &options))
            };
            let alone = run(1);
            assert!(alone.report.run.max_residual < alone.report.run.history[0].max_residual);
            assert_eq!(run(3), alone, "{closed:?} {method:?}");
        }
    }
}

#[test]
fn wide_and_long_grids_of_any_dimension_are_met() {
    for (shape, dimension) in
        [([4, 4], 3), ([4, 300], 2), ([300, 4], 1), ([5, 9], 7), ([9, 11], 4), ([17, 8], 3)]
    {
        let mut random = Random::new(17);
        let count = shape[0] * shape[1] * dimension;
        let points: Vec<f64> = (0..count).map(|_| random.signed()).collect();
        for closed in [[false, false], [true, true]] {
            let uniform = || Some(Parameterization::Uniform);
            let options = SurfaceOptions {
                closed,
                parameterizations: [uniform(), uniform()],
                degrees: if closed[0] { [2, 2] } else { [3, 3] },
                ..Default::default()
            };
            let view = GridView::new(shape, dimension, &points).unwrap();
            let Ok(found) = fit_surface(view, &options) else { continue };
            assert!(found.report.run.max_residual < 1e-9, "{shape:?} {dimension} {closed:?}");
            for (at, point) in points.chunks(dimension).enumerate() {
                let (u, v) =
                    (found.parameters[0][at / shape[1]], found.parameters[1][at % shape[1]]);
                let s = found.surface.evaluate(u, v).unwrap();
                assert!(s.iter().zip(point).all(|(a, b)| (a - b).abs() < 1e-9), "{shape:?}");
            }
        }
    }
}
