//! Laws of the approximation of grids: what the report says is what dense sampling finds, and demands
//! that were called met are met.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::fit::approximate_surface_observed;
use gimfit::points::GridView;
use gimfit::{
    Error, SurfaceApproximationOptions, SurfaceFit, SurfaceGoal, Termination, approximate_surface,
};
use gimfit_testkit::textbook;
use proptest::prelude::*;

type Point = Vec<f64>;

/// Points of a fitted surface at all pairs of parameters by the textbook's recursion, with no code of
/// the library.
fn at(fit: &SurfaceFit, u: &[f64], v: &[f64]) -> Vec<Vec<Point>> {
    let functions = |k: usize, t: &[f64]| {
        let (knots, degree) = (fit.surface.knots()[k].values(), fit.surface.degrees()[k]);
        textbook::collocation_matrix(knots, degree, t)
    };
    let (in_u, in_v) = (functions(0, u), functions(1, v));
    let net = fit.surface.control_net();
    let [rows, columns] = net.shape();
    let dimension = fit.surface.dimension();
    let blend = |of_u: &[f64], of_v: &[f64]| {
        let mut point = vec![0.0; dimension];
        for i in (0..rows).filter(|&i| of_u[i] != 0.0) {
            for j in (0..columns).filter(|&j| of_v[j] != 0.0) {
                let control = net.point(i, j);
                point.iter_mut().zip(control).for_each(|(x, c)| *x += of_u[i] * of_v[j] * c);
            }
        }
        point
    };
    in_u.iter().map(|of_u| in_v.iter().map(|of_v| blend(of_u, of_v)).collect()).collect()
}

/// Parameters all over a direction, several in each span of knots.
fn steps(fit: &SurfaceFit, k: usize) -> Vec<f64> {
    let (knots, degree) = (fit.surface.knots()[k].values(), fit.surface.degrees()[k]);
    let n = knots.len() - degree - 1;
    let spans: Vec<usize> = (degree..n).filter(|&s| knots[s] < knots[s + 1]).collect();
    let each = 100_usize.div_ceil(spans.len());
    let mut steps = Vec::new();
    for s in spans {
        let (a, b) = (knots[s], knots[s + 1]);
        steps.extend((0..each).map(|i| a + (b - a) * (i as f64 / each as f64)));
    }
    steps.push(knots[n]);
    steps
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Distance of a point from the bilinear patch of four corners, by halving it where it is near.
fn from_patch(x: &[f64], corners: &[Point; 4], depth: usize, best: &mut f64) {
    let middle: Point =
        (0..x.len()).map(|i| 0.25 * corners.iter().map(|corner| corner[i]).sum::<f64>()).collect();
    let reach = corners.iter().map(|corner| distance(corner, &middle)).fold(0.0, f64::max);
    let here = distance(x, &middle);
    *best = best.min(here);
    for corner in corners {
        *best = best.min(distance(x, corner));
    }
    if depth == 0 || here - reach >= *best {
        return;
    }
    let half =
        |a: &Point, b: &Point| -> Point { a.iter().zip(b).map(|(x, y)| 0.5 * (x + y)).collect() };
    let [a, b, c, d] = corners;
    let (ab, ac, bd, cd) = (half(a, b), half(a, c), half(b, d), half(c, d));
    let quarters = [
        [a.clone(), ab.clone(), ac.clone(), middle.clone()],
        [ab, b.clone(), middle.clone(), bd.clone()],
        [ac, middle.clone(), c.clone(), cd.clone()],
        [middle, bd, cd, d.clone()],
    ];
    for quarter in &quarters {
        from_patch(x, quarter, depth - 1, best);
    }
}

/// Distance of a point from a grid of bilinear patches: those around the corners nearest to it.
fn from_patches(x: &[f64], grid: &[Vec<Point>], closed: [bool; 2]) -> f64 {
    let shape = [grid.len(), grid[0].len()];
    let mut near: Vec<(f64, [usize; 2])> = (0..shape[0])
        .flat_map(|i| (0..shape[1]).map(move |j| [i, j]))
        .map(|[i, j]| (distance(x, &grid[i][j]), [i, j]))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    let line = |k: usize, at: usize, back: usize| -> Option<usize> {
        let first =
            if closed[k] { (at + shape[k] - back) % shape[k] } else { at.checked_sub(back)? };
        (closed[k] || first + 1 < shape[k]).then_some(first)
    };
    let mut best = f64::INFINITY;
    for (_, [i, j]) in near.into_iter().take(4) {
        for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let (Some(i), Some(j)) = (line(0, i, a), line(1, j, b)) else { continue };
            let (k, l) = ((i + 1) % shape[0], (j + 1) % shape[1]);
            let corners =
                [grid[i][j].clone(), grid[i][l].clone(), grid[k][j].clone(), grid[k][l].clone()];
            from_patch(x, &corners, 6, &mut best);
        }
    }
    best
}

/// Compares the figures of the report with dense sampling. Distances of points from the surface are
/// those from patches between samples.
fn check_figures(grid: &[Vec<Point>], fit: &SurfaceFit) {
    let account = fit.report.approximation.as_ref().unwrap();
    let samples = at(fit, &steps(fit, 0), &steps(fit, 1));
    let slack = 1e-3 * fit.report.run.extent;
    let distances: Vec<f64> =
        grid.iter().flatten().map(|q| from_patches(q, &samples, [false; 2])).collect();
    let count = distances.len() as f64;
    let largest = distances.iter().copied().fold(0.0, f64::max);
    let mean = distances.iter().sum::<f64>() / count;
    let rms = (distances.iter().map(|x| x * x).sum::<f64>() / count).sqrt();
    assert!((largest - account.max_distance).abs() <= slack, "{largest} {account:?}");
    assert!((mean - account.mean_distance).abs() <= slack, "{mean} {account:?}");
    assert!((rms - account.rms_distance).abs() <= slack, "{rms} {account:?}");
    let mut sorted = distances.clone();
    sorted.sort_by(|a, b| b.total_cmp(a));
    for (&k, expected) in account.worst.iter().zip(sorted) {
        assert!((distances[k] - expected).abs() <= 2.0 * slack, "{k}: {} {expected}", distances[k]);
    }
    let [i, j] = fit.report.max_deviation_index;
    assert_eq!(i * grid[0].len() + j, account.worst[0]);
    // From the cells, at places of our own.
    let mut strayed: f64 = 0.0;
    for row in samples.iter().step_by(8) {
        for x in row.iter().step_by(8) {
            strayed = strayed.max(from_patches(x, grid, fit.report.closed));
        }
    }
    assert!(strayed <= account.overshoot + slack, "{strayed} {}", account.overshoot);
    assert!(strayed >= 0.5 * account.overshoot - slack, "{strayed} {}", account.overshoot);
}

fn flat(grid: &[Vec<Point>]) -> Vec<f64> {
    grid.iter().flatten().flatten().copied().collect()
}

/// Options whose search is short.
fn short(goal: SurfaceGoal) -> SurfaceApproximationOptions {
    SurfaceApproximationOptions { rounds: Some(90), ..SurfaceApproximationOptions::new(goal) }
}

fn fit(grid: &[Vec<Point>], options: &SurfaceApproximationOptions) -> Result<SurfaceFit, Error> {
    let data = flat(grid);
    let view = GridView::new([grid.len(), grid[0].len()], grid[0][0].len(), &data).unwrap();
    approximate_surface(view, options)
}

/// A bent sheet with a bump.
fn sheet(rows: usize, columns: usize) -> Vec<Vec<Point>> {
    (0..rows)
        .map(|i| {
            (0..columns)
                .map(|j| {
                    let s = i as f64 / (rows - 1) as f64;
                    let t = j as f64 / (columns - 1) as f64;
                    let bump = (-40.0 * ((s - 0.6).powi(2) + (t - 0.3).powi(2))).exp();
                    let angle = 2.0 * t;
                    vec![
                        4.0 * s + 0.2 * t,
                        2.0 * angle.sin() + bump,
                        2.0 * angle.cos() + 0.5 * s * s,
                    ]
                })
                .collect()
        })
        .collect()
}

fn torus(rows: usize, columns: usize) -> Vec<Vec<Point>> {
    let turn = |k: usize, count: usize| k as f64 / count as f64 * std::f64::consts::TAU;
    (0..rows)
        .map(|i| {
            (0..columns)
                .map(|j| {
                    let (a, b) = (turn(i, rows), turn(j, columns));
                    let r = 3.0 + b.cos();
                    vec![r * a.cos(), r * a.sin(), b.sin()]
                })
                .collect()
        })
        .collect()
}

#[test]
fn a_tolerance_is_kept_and_smaller_ones_take_more_control_points() {
    let grid = sheet(13, 11);
    let mut last = 0;
    for tolerance in [0.3, 0.02] {
        let fit = fit(&grid, &short(SurfaceGoal::Tolerance(tolerance))).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && account.max_distance <= tolerance, "{account:?}");
        assert!(account.is_calm() && fit.report.converged());
        check_figures(&grid, &fit);
        let count = fit.surface.control_net().points().len();
        assert!(count >= last && count <= 100, "{count}");
        last = count;
    }
}

#[test]
fn closed_directions_close_smoothly() {
    let plain = torus(13, 9);
    let mut repeated = plain.clone();
    repeated.push(repeated[0].clone());
    repeated.iter_mut().for_each(|row| row.push(row[0].clone()));
    for grid in [&plain, &repeated] {
        let options = SurfaceApproximationOptions {
            closed: [true; 2],
            ..short(SurfaceGoal::Tolerance(0.05))
        };
        let fit = fit(grid, &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert!(account.met && account.is_calm() && fit.surface.is_periodic() == [true; 2]);
        assert_eq!(fit.report.points, [13, 9]);
        let [rows, columns] = fit.surface.control_net().shape();
        assert!((rows - 3) * (columns - 3) <= 70, "{rows} x {columns}");
        if grid.len() > 13 {
            check_figures(&plain, &fit);
        }
    }
}

#[test]
fn heights_are_measured_at_their_places_and_the_lattice_is_reproduced() {
    let height = |x: f64, y: f64| (1.5 * x).sin() * (0.8 * y).cos() + 0.1 * x * y;
    // Uneven lines, x falling, y stored first.
    let xs: Vec<f64> =
        (0..20).map(|j| 5.0 - 0.2 * f64::from(j) + 0.05 * f64::from(j % 3)).collect();
    let ys: Vec<f64> =
        (0..18).map(|i| 1e5 + 0.2 * f64::from(i) + 0.004 * f64::from(i * i)).collect();
    let grid: Vec<Vec<Point>> =
        ys.iter().map(|&y| xs.iter().map(|&x| vec![y, x, height(x, y - 1e5)]).collect()).collect();
    let tolerance = 0.02;
    let fit = fit(&grid, &short(SurfaceGoal::Tolerance(tolerance))).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert!(account.met && account.is_calm());
    assert!(fit.foot_parameters.is_none());
    let mut largest: f64 = 0.0;
    let points = at(&fit, &fit.parameters[0], &fit.parameters[1]);
    for (i, &y) in ys.iter().enumerate() {
        for (j, &x) in xs.iter().enumerate() {
            let point = &points[i][j];
            assert!((point[0] - y).abs() < 1e-9 && (point[1] - x).abs() < 1e-12);
            largest = largest.max((point[2] - grid[i][j][2]).abs());
        }
    }
    assert!((largest - account.max_distance).abs() < 1e-9, "{largest} {account:?}");
    let count = fit.surface.control_net().points().len();
    assert!(count <= 120, "{count}");
    // Everywhere in between the surface stays a graph over x and y.
    for u in [0.03, 0.4, 0.77] {
        for v in [0.11, 0.5, 0.93] {
            let point = &at(&fit, &[u], &[v])[0][0];
            let y = ys[0] + u * (ys[17] - ys[0]);
            let x = xs[0] + v * (xs[19] - xs[0]);
            assert!((point[0] - y).abs() < 1e-9 && (point[1] - x).abs() < 1e-12);
            assert!((point[2] - height(x, y - 1e5)).abs() < 3.0 * tolerance);
        }
    }
}

#[test]
fn a_number_of_control_points_is_kept_and_more_come_closer() {
    let grid = sheet(11, 9);
    let mut last = f64::INFINITY;
    for net in [[4, 4], [6, 5], [9, 7]] {
        let options = SurfaceApproximationOptions {
            rounds: Some(24),
            ..SurfaceApproximationOptions::new(SurfaceGoal::ControlPoints(net))
        };
        let fit = fit(&grid, &options).unwrap();
        let account = fit.report.approximation.as_ref().unwrap();
        assert_eq!(fit.surface.control_net().shape(), net);
        assert!(account.max_distance < 0.7 * last, "{net:?}: {account:?}");
        last = account.max_distance;
    }
}

#[test]
fn the_root_mean_square_is_kept() {
    let grid = sheet(14, 12);
    let options = short(SurfaceGoal::Rms(0.02));
    let fit = fit(&grid, &options).unwrap();
    let account = fit.report.approximation.as_ref().unwrap();
    assert!(account.met && account.rms_distance <= 0.02 && account.max_distance > 0.02);
}

#[test]
fn bad_requests_are_named() {
    let grid = sheet(6, 5);
    let run = |options| fit(&grid, &options);
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = run(SurfaceApproximationOptions::within(tolerance));
        assert!(matches!(refused, Err(Error::OutOfRange { .. })), "{tolerance}");
    }
    let few = run(SurfaceApproximationOptions::new(SurfaceGoal::ControlPoints([4, 3])));
    assert!(matches!(few, Err(Error::WrongCount { .. })));
    let many = run(SurfaceApproximationOptions::new(SurfaceGoal::ControlPoints([6, 40])));
    assert!(matches!(many, Err(Error::OutOfRange { .. })));
    let high =
        SurfaceApproximationOptions { degrees: [3, 5], ..SurfaceApproximationOptions::within(0.1) };
    assert!(matches!(run(high), Err(Error::TooFewLines { .. })));
    let none = GridView::new([0, 5], 3, &[]).unwrap();
    let none = approximate_surface(none, &SurfaceApproximationOptions::within(1.0));
    assert!(matches!(none, Err(Error::NoPoints { .. })));
    let same = [1.0; 75];
    let same = GridView::new([5, 5], 3, &same).unwrap();
    let same = approximate_surface(same, &SurfaceApproximationOptions::within(1.0));
    assert!(matches!(same, Err(Error::AllPointsEqual { .. })));
    let mut hole = flat(&grid);
    hole[7] = f64::NAN;
    let hole = GridView::new([6, 5], 3, &hole).unwrap();
    let nan = approximate_surface(hole, &SurfaceApproximationOptions::within(0.1));
    assert!(matches!(nan, Err(Error::NotFinite { point: 2, .. })));
}

#[test]
fn lines_that_coincide_are_approximated_all_the_same() {
    let mut grid = sheet(9, 8);
    grid.iter_mut().for_each(|row| row[4] = row[3].clone());
    let fit = fit(&grid, &short(SurfaceGoal::Tolerance(0.2))).unwrap();
    assert!(fit.report.approximation.as_ref().unwrap().met);
    assert!(fit.report.run.choices.iter().any(|choice| choice.contains("coincide")));
}

#[test]
fn an_observer_ends_the_search_with_the_best_so_far() {
    let grid = sheet(20, 20);
    let data = flat(&grid);
    let mut rounds = 0;
    let mut watch = |_: gimfit::iteration::Snapshot<'_>| {
        rounds += 1;
        if rounds == 5 { gimfit::iteration::Flow::Stop } else { gimfit::iteration::Flow::Continue }
    };
    let fit = approximate_surface_observed(
        GridView::new([20, 20], 3, &data).unwrap(),
        &SurfaceApproximationOptions::within(1e-9),
        &mut watch,
    )
    .unwrap();
    assert_eq!(fit.report.run.termination, Termination::Cancelled);
    assert!(!fit.report.approximation.unwrap().met);
}

/// Grids of any kind: walks with repeated lines, huge and tiny, far away.
fn any_grid() -> impl Strategy<Value = ([usize; 2], usize, Vec<f64>)> {
    let step = prop_oneof![4 => -1.0..1.0, 1 => Just(0.0), 1 => -1e-9..1e-9, 1 => -1e6..1e6];
    (1_usize..5, 2_usize..9, 2_usize..9).prop_flat_map(move |(dimension, rows, columns)| {
        let steps = proptest::collection::vec(step.clone(), dimension * rows * columns);
        (
            steps,
            prop_oneof![Just(1.0), Just(1e300), Just(1e-300), Just(1e150)],
            prop_oneof![Just(0.0), Just(1e9)],
        )
            .prop_map(move |(steps, scale, origin)| {
                let mut place = vec![0.0; dimension];
                let points = steps
                    .chunks_exact(dimension)
                    .flat_map(|step| {
                        place.iter_mut().zip(step).for_each(|(x, s)| *x += s);
                        place.iter().map(|x| (origin + x) * scale * 1e-7).collect::<Vec<f64>>()
                    })
                    .collect();
                ([rows, columns], dimension, points)
            })
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn hostile_grids_neither_panic_nor_give_nan(
        (shape, dimension, data) in any_grid(),
        degrees in [1_usize..5, 1_usize..5],
        closed: [bool; 2],
        share in 1e-6..0.5_f64,
        goal in 0..3,
    ) {
        let view = GridView::new(shape, dimension, &data).unwrap();
        let Ok(extent) = gimfit::points::Extent::of(view.points()) else { return Ok(()) };
        let distance = (share * extent.diagonal()).max(1e-320);
        let goal = match goal {
            0 => SurfaceGoal::Tolerance(distance),
            1 => SurfaceGoal::Rms(distance),
            _ => SurfaceGoal::ControlPoints([0, 1].map(|k| degrees[k] + 1 + data.len() % 4)),
        };
        let options = SurfaceApproximationOptions {
            degrees, closed, rounds: Some(25), ..SurfaceApproximationOptions::new(goal)
        };
        if let Ok(fit) = approximate_surface(view, &options) {
            let account = fit.report.approximation.as_ref().unwrap();
            prop_assert!(account.max_distance.is_finite() && account.overshoot.is_finite());
            prop_assert!(account.rms_distance <= account.max_distance * (1.0 + 1e-12));
            if account.met && let SurfaceGoal::Tolerance(tolerance) = options.goal {
                prop_assert!(account.max_distance <= tolerance);
            }
        }
    }
}
