//! Curves that are said to keep the turns of their data bend as they do: seen in many samples of
//! their derivatives, by the textbook.

#![allow(clippy::unwrap_used)] // A test that cannot go on has failed.

use gimfit::{Convexity, CurveFit, CurveOptions, Termination, fit_curve};
use gimfit_testkit::convexity::{Bends, bends, turn_signs, turning};
use gimfit_testkit::dense::Rows;
use gimfit_testkit::generate::{Random, random_walk};
use std::f64::consts::{PI, TAU};

type Polygon = Vec<[f64; 2]>;

fn rows(polygon: &[[f64; 2]]) -> Rows {
    polygon.iter().map(|p| p.to_vec()).collect()
}

fn seen(fit: &CurveFit) -> Bends {
    let control: Rows = fit.curve.control_points().iter().map(<[f64]>::to_vec).collect();
    bends(fit.curve.knots().values(), fit.curve.degree(), &control, 12)
}

/// How often the sign changes, round the seam of a closed curve too.
fn changes(mut signs: Vec<i32>, closed: bool) -> usize {
    signs.retain(|&sign| sign != 0);
    signs.dedup();
    let round = closed && signs.first() != signs.last();
    signs.len().saturating_sub(1) + usize::from(round)
}

fn fit(data: &Polygon, degree: usize, closed: bool, convexity: Convexity) -> CurveFit {
    let convexity = Some(convexity);
    fit_curve(data, &CurveOptions { degree, closed, convexity, ..Default::default() }).unwrap()
}

/// Few points on a part of an ellipse, at random angles.
fn sparse(random: &mut Random, count: usize, part: f64) -> Polygon {
    let start = TAU * random.unit();
    let mut angles: Vec<f64> = (0..count).map(|_| start + part * random.unit()).collect();
    angles.sort_by(f64::total_cmp);
    let height = 0.3 + random.unit();
    angles.into_iter().map(|a| [3.0 * a.cos(), height * a.sin()]).collect()
}

#[test]
fn convex_points_have_convex_curves() {
    let mut random = Random::new(11);
    let (mut inserted, mut reached, mut cases) = (0, 0, 0);
    for trial in 0..90 {
        let degree = 2 + trial % 6;
        let closed = trial % 4 == 3;
        let part = if closed { TAU } else { PI * (0.8 + random.unit()) };
        let data = sparse(&mut random, degree + 1 + trial % 5, part);
        let turns = turn_signs(&rows(&data), closed);
        if turns.iter().any(|&turn| turn < 1) {
            continue; // A closed one may miss a side.
        }
        cases += 1;
        let fit = fit(&data, degree, closed, Convexity::Closest);
        let shape = fit.report.shape.unwrap();
        let case = format!("trial {trial} degree {degree} closed {closed} {:?}", fit.report.run);
        assert!(shape.kept, "{case}");
        let seen = seen(&fit);
        assert!(seen.signs.iter().all(|&sign| sign > 0), "{case}: {:?}", seen.signs);
        let most = if closed { TAU } else { turning(&rows(&data), false) + PI };
        assert!(seen.turning < most + 1e-9, "{case}: {} of {most}", seen.turning);
        let ends = [Termination::Residual, Termination::Constrained];
        assert!(ends.contains(&fit.report.run.termination), "{case}");
        inserted += usize::from(shape.inserted_knots > 0);
        reached += usize::from(fit.report.converged());
    }
    assert!(cases > 70 && inserted > 3 && reached > 20 && reached + 20 < cases);
}

#[test]
fn piecewise_convex_points_have_curves_without_further_inflections() {
    let (mut kept, mut cases) = (0, 0);
    for trial in 0..72 {
        let degree = 2 + trial % 6;
        let closed = trial % 4 == 3;
        let data: Polygon = random_walk(100 + trial as u64, degree + 3 + trial % 7, 2)
            .iter()
            .map(|p| [p[0], p[1]])
            .collect();
        let convexity = if trial % 9 == 8 {
            Convexity::Published { threshold: None }
        } else {
            Convexity::Closest
        };
        let fit = fit(&data, degree, closed, convexity);
        cases += 1;
        if !fit.report.shape.unwrap().kept {
            continue; // Points that are no control polygon of such a curve themselves.
        }
        kept += 1;
        let (seen, asked) = (seen(&fit), changes(turn_signs(&rows(&data), closed), closed));
        let case = format!("trial {trial} degree {degree} closed {closed} {:?}", fit.report.run);
        assert!(changes(seen.signs.clone(), closed) <= asked, "{case}: {:?} {asked}", seen.signs);
    }
    assert!(kept + 6 > cases, "{kept} of {cases}");
}

#[test]
fn a_polygon_that_turns_left_everywhere_may_fold_back_and_is_not_taken() {
    // Seven points whose closest polygon by the signs of its turns alone turned by 369 degrees, its
    // last leg folded back; and eight whose interpolant has a polygon that turns left everywhere,
    // thrice round, and a curve with inflections.
    let seven = vec![
        [2.1469, 0.7643],
        [1.2631, 0.9253],
        [-3.3294, -0.0073],
        [-2.7642, -0.5574],
        [-2.4034, -0.6921],
        [-2.3623, -0.7047],
        [-0.3478, -0.9945],
    ];
    let eight = vec![
        [3.0947, 0.1678],
        [0.968, 0.9513],
        [-3.0454, 0.2426],
        [-3.138, 0.0266],
        [-2.7174, -0.5006],
        [-2.3691, -0.6561],
        [-0.8035, -0.9667],
        [-0.0763, -0.9997],
    ];
    for (data, degree) in [(seven, 3), (eight, 7)] {
        let fit = fit(&data, degree, false, Convexity::Closest);
        assert!(fit.report.shape.unwrap().kept);
        assert_eq!(fit.report.run.termination, Termination::Constrained);
        let seen = seen(&fit);
        assert_eq!(seen.signs, [1]);
        assert!(seen.turning < turning(&rows(&data), false) + PI);
    }
}
