//! A member of a family is the fit of a run that stopped there: of methods whose parameters move, and
//! of those that look at some points only.

#![allow(clippy::unwrap_used)] // A test that cannot go on has failed.

use gimfit::points::GridView;
use gimfit::{
    CurveFit, CurveOptions, KnotPlacement, Method, RunReport, SurfaceFit, SurfaceOptions,
    fit_curve, fit_surface,
};
use gimfit_testkit::generate::random_walk;

const GEOMETRIC: Method = Method::Geometric { global_start: false };

/// The lemniscate of 11 points of Orsi (2021).
fn lemniscate() -> Vec<[f64; 2]> {
    (0..11)
        .map(|i| -std::f64::consts::FRAC_PI_2 + f64::from(i) * std::f64::consts::PI / 5.0)
        .map(|s| [s.cos(), s.sin() * s.cos()])
        .collect()
}

/// A loop of `n` points, its steps uneven.
fn loop_of(n: u32) -> Vec<[f64; 2]> {
    let angle = |i: u32| {
        let s = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        s + 0.3 * (2.0 * s).sin()
    };
    (0..n).map(angle).map(|s| [s.cos() * (1.0 + 0.2 * (3.0 * s).cos()), s.sin()]).collect()
}

fn walk(seed: u64) -> Vec<[f64; 2]> {
    random_walk(seed, 15, 2).iter().map(|p| [p[0], p[1]]).collect()
}

/// What a member and a run that stopped there must say alike; sentences on the family apart.
fn same_run(ours: &RunReport, theirs: &RunReport, case: &str) {
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * b.abs().max(1.0);
    assert_eq!(ours.foot_points, theirs.foot_points, "{case}");
    assert_eq!(ours.smallest_eigenvalue, theirs.smallest_eigenvalue, "{case}");
    assert_eq!(ours.history, theirs.history, "{case}");
    assert!(near(ours.max_residual, theirs.max_residual), "{case}");
    assert!(near(ours.rms_residual, theirs.rms_residual), "{case}");
    assert!(near(ours.max_residual, ours.history.last().unwrap().max_residual), "{case}");
    match (&ours.local, &theirs.local) {
        (Some(ours), Some(theirs)) => {
            assert_eq!(ours.chosen, theirs.chosen, "{case}");
            assert!(near(ours.outside_max_residual, theirs.outside_max_residual), "{case}");
            assert_eq!(ours.outside_max_residual_index, theirs.outside_max_residual_index);
        }
        (ours, theirs) => assert_eq!(ours, theirs, "{case}"),
    }
    let mut said = ours.choices.clone();
    said.retain(|choice| !choice.starts_with("family"));
    let mut told = theirs.choices.clone();
    told.retain(|choice| !choice.starts_with("family"));
    said.sort();
    told.sort();
    assert_eq!(said, told, "{case}");
}

fn curves_agree(points: &[[f64; 2]], options: &CurveOptions, keep: &[usize], case: &str) {
    let last = *keep.last().unwrap();
    let options = CurveOptions {
        residual: Some(0.0),
        iterations: last,
        keep: keep.to_vec(),
        ..options.clone()
    };
    let whole = fit_curve(points, &options).unwrap();
    for &k in keep {
        let alone: CurveFit =
            fit_curve(points, &CurveOptions { iterations: k, keep: vec![], ..options.clone() })
                .unwrap();
        let member = whole.member(k).unwrap();
        let case = format!("{case}, step {k}");
        assert_eq!(member.curve, alone.curve, "{case}");
        assert_eq!(member.parameters, alone.parameters, "{case}");
        same_run(&member.report.run, &alone.report.run, &case);
        let (ours, theirs) = (&member.report, &alone.report);
        // Where nothing is left, rounding decides which point is the worst.
        if ours.run.max_residual > 1e-12 {
            assert_eq!(ours.max_residual_index, theirs.max_residual_index, "{case}");
        }
        assert!((ours.max_deviation - theirs.max_deviation).abs() < 1e-9, "{case}");
        assert!((ours.spacing_ratio / theirs.spacing_ratio - 1.0).abs() < 1e-12, "{case}");
    }
}

fn surfaces_agree(grid: GridView<'_>, options: &SurfaceOptions, keep: &[usize], case: &str) {
    let last = *keep.last().unwrap();
    let options = SurfaceOptions {
        residual: Some(0.0),
        iterations: last,
        keep: keep.to_vec(),
        ..options.clone()
    };
    let whole = fit_surface(grid, &options).unwrap();
    for &k in keep {
        let alone: SurfaceFit =
            fit_surface(grid, &SurfaceOptions { iterations: k, keep: vec![], ..options.clone() })
                .unwrap();
        let member = whole.member(k).unwrap();
        let case = format!("{case}, step {k}");
        assert_eq!(member.surface, alone.surface, "{case}");
        assert_eq!(member.foot_parameters, alone.foot_parameters, "{case}");
        same_run(&member.report.run, &alone.report.run, &case);
        let (ours, theirs) = (&member.report, &alone.report);
        // Where nothing is left, rounding decides which point is the worst.
        if ours.run.max_residual > 1e-12 {
            assert_eq!(ours.max_residual_index, theirs.max_residual_index, "{case}");
        }
        assert!((ours.max_deviation - theirs.max_deviation).abs() < 1e-9, "{case}");
    }
}

/// Once every member had the parameters of the last step, so that the residual of the start read
/// 0.1566 in its file and 0.1526 in the history of the same file.
#[test]
fn members_of_geometric_interpolation_have_the_foot_points_of_their_step() {
    let plain = CurveOptions { method: GEOMETRIC, ..Default::default() };
    let keep = [0, 1, 2, 5];
    curves_agree(&lemniscate(), &plain, &keep, "open");
    for n in [14, 15] {
        let closed = CurveOptions { closed: true, ..plain.clone() };
        curves_agree(&loop_of(n), &closed, &keep, "closed");
    }
    let weights = (0..11).map(|j| 1.0 + f64::from(j % 3)).collect();
    let rational = CurveOptions { rational_weights: Some(weights), ..plain.clone() };
    curves_agree(&lemniscate(), &rational, &keep, "rational");
    // Walks that fall back at once.
    for seed in 1..5 {
        curves_agree(&walk(seed), &plain, &[0, 1, 2], "walk");
    }
}

#[test]
fn members_of_geometric_surfaces_have_the_foot_points_of_their_step() {
    let dune = |i: u32, j: u32, rough: f64| {
        let (x, y) = (f64::from(i), f64::from(j));
        let (x, y) = (x + 0.3 * y.sin(), y + 0.3 * (2.0 * x).cos());
        [x, y, (0.7 * x).sin() + (0.5 * y).cos() + rough * f64::from((7 * i + 3 * j * j) % 5)]
    };
    for rough in [0.0, 1.0] {
        let points: Vec<f64> =
            (0..7).flat_map(|i| (0..6).flat_map(move |j| dune(i, j, rough))).collect();
        let grid = GridView::new([7, 6], 3, &points).unwrap();
        let options = SurfaceOptions { method: GEOMETRIC, ..Default::default() };
        surfaces_agree(grid, &options, &[0, 1, 4], &format!("rough {rough}"));
    }
    // A fall-back on the way, as the estimate of the eigenvalue comes down below one allowed: members
    // before it know nothing of it.
    let peaks: Vec<f64> = (0..36)
        .flat_map(|k| [f64::from(k / 6), f64::from(k % 6), (0.4 * f64::from(k / 6 + k % 6)).sin()])
        .collect();
    let grid = GridView::new([6, 6], 3, &peaks).unwrap();
    let bezier = SurfaceOptions {
        degrees: [5, 5],
        knot_placements: [Some(KnotPlacement::Bezier), Some(KnotPlacement::Bezier)],
        method: GEOMETRIC,
        ..Default::default()
    };
    let gradual = SurfaceOptions { iterations: 12, keep: vec![0, 12], ..bezier.clone() };
    let whole = fit_surface(grid, &gradual).unwrap();
    let met =
        |k: usize| whole.sequence[k].foot_points.as_ref().unwrap().smallest_eigenvalue.unwrap();
    let least_eigenvalue = Some(0.5 * (met(0) + met(1)));
    let strict = SurfaceOptions { least_eigenvalue, iterations: 12, ..bezier };
    let run = fit_surface(grid, &strict).unwrap().report.run;
    let fall_back = run.foot_points.unwrap().fall_back.unwrap();
    assert!(fall_back.iteration > 0, "{fall_back:?}");
    surfaces_agree(grid, &strict, &[0, 1, 4, 12], "on the way");
    let tube: Vec<f64> = (0..8)
        .flat_map(|i| {
            let s = std::f64::consts::TAU * f64::from(i) / 8.0;
            (0..5).flat_map(move |j| [s.cos(), s.sin() + 0.1 * f64::from(j), f64::from(j * j)])
        })
        .collect();
    let closed = SurfaceOptions { method: GEOMETRIC, closed: [true, false], ..Default::default() };
    surfaces_agree(GridView::new([8, 5], 3, &tube).unwrap(), &closed, &[0, 2], "tube");
}

/// Once a member told the residuals of all points, and a run that stopped there those of its own.
#[test]
fn members_of_local_pia_count_the_points_that_iterate() {
    let points = loop_of(40);
    for closed in [false, true] {
        let local = Some((5..12).chain([20]).collect());
        let options = CurveOptions { closed, local, method: Method::Local, ..Default::default() };
        curves_agree(&points, &options, &[0, 3, 20], "local");
    }
    let all =
        CurveOptions { local: Some((0..40).collect()), method: Method::Pia, ..Default::default() };
    curves_agree(&points, &all, &[0, 3], "all points");
    let grid: Vec<f64> =
        (0..72).flat_map(|k| [f64::from(k / 8), f64::from(k % 8), f64::from(k * k % 11)]).collect();
    let grid = GridView::new([9, 8], 3, &grid).unwrap();
    let windows = [[2..5, 1..6], [7..8, 7..8]];
    for count in [1, 2] {
        let local = Some(windows[..count].to_vec());
        let options = SurfaceOptions { local, method: Method::Local, ..Default::default() };
        surfaces_agree(grid, &options, &[0, 4], "windows");
    }
}

/// The theorem asks for some positive bound of the smallest eigenvalue; once it was 1e-3 for all
/// bases, below which Bezier curves of degree 10 start.
#[test]
fn foot_points_of_bezier_curves_and_surfaces_go_on_by_default() {
    let arc: Vec<[f64; 2]> = (0..11).map(|i| 0.25 * f64::from(i)).map(|s| [s, s.sin()]).collect();
    let options = CurveOptions {
        degree: 10,
        knot_placement: Some(KnotPlacement::Bezier),
        method: GEOMETRIC,
        iterations: 300,
        ..Default::default()
    };
    let run = fit_curve(&arc, &options).unwrap().report.run;
    assert_eq!(run.foot_points.unwrap().fall_back, None);
    assert!(run.smallest_eigenvalue.unwrap() < 1e-3);
    assert!(run.choices.iter().any(|choice| choice.starts_with("least eigenvalue")));
    let (first, last) = (run.history[0].max_residual, run.history[300].max_residual);
    assert!(last < 1e-2 * first, "{first:e} {last:e}");
    let strict = CurveOptions { least_eigenvalue: Some(1e-3), ..options.clone() };
    let run = fit_curve(&arc, &strict).unwrap().report.run;
    let fall_back = run.foot_points.unwrap().fall_back.unwrap();
    assert_eq!((fall_back.iteration, fall_back.reason.as_str()), (0, "eigenvalue"));
    for alpha in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY] {
        let wrong = CurveOptions { least_eigenvalue: Some(alpha), ..options.clone() };
        assert!(fit_curve(&arc, &wrong).is_err(), "{alpha}");
    }
    for degree in [4, 6] {
        let n = degree as u32 + 1;
        let sheet: Vec<f64> = (0..n * n)
            .flat_map(|k| {
                let (x, y) = (f64::from(k / n) / f64::from(n), f64::from(k % n) / f64::from(n));
                [x, y, 0.3 * (2.0 * x).sin() * y.cos()]
            })
            .collect();
        let options = SurfaceOptions {
            degrees: [degree, degree],
            knot_placements: [Some(KnotPlacement::Bezier), Some(KnotPlacement::Bezier)],
            method: GEOMETRIC,
            iterations: 50,
            residual: Some(0.0),
            ..Default::default()
        };
        let grid = GridView::new([degree + 1, degree + 1], 3, &sheet).unwrap();
        let run = fit_surface(grid, &options).unwrap().report.run;
        assert_eq!(run.foot_points.unwrap().fall_back, None, "degree {degree}");
        assert!(run.max_residual < 0.1 * run.history[0].max_residual, "degree {degree}");
    }
}

/// Once only bases without a band said that total positivity is absent.
#[test]
fn methods_that_rest_on_total_positivity_say_when_a_closed_curve_has_none() {
    // Nine points, the longest step 174 times the shortest.
    let steps = [1.0, 174.0, 2.0, 60.0, 1.0, 90.0, 3.0, 1.0, 120.0];
    let whole: f64 = steps.iter().sum();
    let mut at = 0.0;
    let mut uneven = Vec::new();
    for step in steps {
        let s: f64 = std::f64::consts::TAU * at / whole;
        uneven.push([s.cos(), s.sin()]);
        at += step;
    }
    let cautions = |points: &[[f64; 2]], degree, method| {
        let options =
            CurveOptions { closed: true, degree, method, iterations: 3, ..Default::default() };
        let run = fit_curve(points, &options).unwrap().report.run;
        run.choices
            .iter()
            .filter(|choice| choice.starts_with("caution: the curve is closed"))
            .count()
    };
    for method in
        [Method::Pia, Method::Weighted, Method::GaussSeidel, Method::Sor, Method::Chebyshev]
    {
        assert_eq!(cautions(&uneven, 5, method), 1, "{method:?}");
    }
    for method in [Method::Auto, Method::Anderson { memory: None }] {
        assert_eq!(cautions(&uneven, 5, method), 0, "{method:?}");
    }
    // Even steps: the diagonal dominates, which is enough.
    assert_eq!(cautions(&loop_of(20), 3, Method::Pia), 0);
}
