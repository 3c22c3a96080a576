//! Laws of rational curves and surfaces.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{Curve, Error, KnotVector, PointGrid, Points, Surface};
use gimfit_testkit::generate::Random;
use gimfit_testkit::textbook::rational_curve_point;
use std::f64::consts::FRAC_1_SQRT_2;

/// The square of 8 points and their weights that are a circle over these knots (The NURBS Book,
/// section 7.5), the first point repeated at the end.
fn circle_parts() -> (Vec<f64>, Vec<[f64; 2]>, Vec<f64>) {
    let knots = vec![0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0];
    let square = [
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 0.0],
        [-1.0, -1.0],
        [0.0, -1.0],
        [1.0, -1.0],
        [1.0, 0.0],
    ];
    let weights = (0..9).map(|i| if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 }).collect();
    (knots, square.to_vec(), weights)
}

fn circle() -> Curve {
    let (knots, square, weights) = circle_parts();
    Curve::rational(KnotVector::open(2, knots).unwrap(), Points::from(&square[..]), weights)
        .unwrap()
}

fn random_knots(random: &mut Random, degree: usize, count: usize) -> KnotVector {
    let mut inner: Vec<f64> = (0..count - degree - 1).map(|_| random.unit()).collect();
    inner.sort_by(f64::total_cmp);
    let knots = [vec![0.0; degree + 1], inner, vec![1.0; degree + 1]].concat();
    KnotVector::open(degree, knots).unwrap()
}

#[test]
fn a_circle_is_round_and_its_derivatives_turn() {
    let circle = circle();
    for t in circle.equal_steps(101) {
        let mut jet = [0.0; 8];
        circle.derivatives_into(t, 3, &mut jet).unwrap();
        assert!((jet[0].hypot(jet[1]) - 1.0).abs() < 4e-16, "{t}");
        // |C|^2 = 1, derived once, twice, three times.
        let dot = |a: usize, b: usize| jet[2 * a] * jet[2 * b] + jet[2 * a + 1] * jet[2 * b + 1];
        assert!(dot(0, 1).abs() < 1e-13, "{t}");
        assert!((dot(1, 1) + dot(0, 2)).abs() < 1e-11, "{t}");
        assert!((3.0 * dot(1, 2) + dot(0, 3)).abs() < 1e-9, "{t}");
    }
    assert!(circle.bezier_pieces().is_none());
}

#[test]
fn points_agree_with_the_definition_and_derivatives_with_differences() {
    let mut random = Random::new(11);
    for (degree, dimension) in [(1, 2), (2, 1), (3, 3), (4, 7), (7, 2)] {
        let count = degree + 5;
        let knots = random_knots(&mut random, degree, count);
        let control: Vec<Vec<f64>> =
            (0..count).map(|_| (0..dimension).map(|_| random.signed()).collect()).collect();
        let weights: Vec<f64> = (0..count).map(|_| 0.2 + 3.0 * random.unit()).collect();
        let values = knots.values().to_vec();
        let points = Points::new(dimension, control.concat()).unwrap();
        let curve = Curve::rational(knots, points, weights.clone()).unwrap();
        for _ in 0..20 {
            let t = random.unit();
            let expected = rational_curve_point(&values, degree, &control, &weights, t);
            let found = curve.evaluate(t).unwrap();
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-14));
            // Each derivative is the slope of the one before, on its span.
            let order = degree + 2;
            let h = 1e-6;
            let mut jets = vec![vec![0.0; (order + 1) * dimension]; 3];
            if values.iter().any(|knot| (knot - t).abs() < 1e-3) {
                continue;
            }
            for (jet, t) in jets.iter_mut().zip([t - h, t, t + h]) {
                curve.derivatives_into(t, order, jet).unwrap();
            }
            for k in 0..order {
                for i in 0..dimension {
                    let slope =
                        (jets[2][k * dimension + i] - jets[0][k * dimension + i]) / (2.0 * h);
                    let derivative = jets[1][(k + 1) * dimension + i];
                    let size = jets[1].iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                    assert!((slope - derivative).abs() < 1e-5 * size, "order {k} of {degree}");
                }
            }
        }
    }
}

#[test]
fn only_ratios_of_weights_count_and_equal_ones_do_nothing() {
    let mut random = Random::new(5);
    let knots = random_knots(&mut random, 3, 8);
    let points = Points::new(2, (0..16).map(|_| random.signed()).collect()).unwrap();
    let weights: Vec<f64> = (0..8).map(|_| 0.5 + random.unit()).collect();
    let curve = |weights| Curve::rational(knots.clone(), points.clone(), weights).unwrap();
    let plain = Curve::new(knots.clone(), points.clone()).unwrap();
    let (one, other) =
        (curve(weights.clone()), curve(weights.iter().map(|w| w * 2f64.powi(900)).collect()));
    let equal = curve(vec![3.0; 8]);
    for t in plain.equal_steps(23) {
        let mut jets = [[0.0; 8]; 4];
        for (jet, curve) in jets.iter_mut().zip([&one, &other, &plain, &equal]) {
            curve.derivatives_into(t, 3, jet).unwrap();
        }
        assert_eq!(jets[0], jets[1]);
        let size = jets[2].iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        assert!(jets[2].iter().zip(&jets[3]).all(|(a, b)| (a - b).abs() < 1e-12 * size));
    }
}

#[test]
fn a_closed_rational_curve_needs_weights_that_repeat() {
    let knots = KnotVector::periodic(2, (-2..8).map(f64::from).collect()).unwrap();
    let mut values = vec![0.0, 0.0, 1.0, 0.0, 2.0, 1.0, 1.0, 2.0, 0.0, 1.0];
    values.extend_from_within(..4);
    let points = Points::new(2, values).unwrap();
    let sound = vec![1.0, 2.0, 1.0, 3.0, 1.0, 1.0, 2.0];
    let curve = Curve::rational(knots.clone(), points.clone(), sound.clone()).unwrap();
    let (mut start, mut end) = ([0.0; 4], [0.0; 4]);
    curve.derivatives_into(0.0, 1, &mut start).unwrap();
    curve.derivatives_into(5.0, 1, &mut end).unwrap();
    assert!(start.iter().zip(end).all(|(a, b)| (a - b).abs() < 1e-14));
    let broken = [&sound[..6], &[9.0]].concat();
    let error = Curve::rational(knots, points, broken).unwrap_err();
    assert!(matches!(error, Error::Incompatible { .. }), "{error}");
}

#[test]
fn weights_that_are_none_are_refused_by_number() {
    let (knots, square, weights) = circle_parts();
    let make = |weights: Vec<f64>| {
        let knots = KnotVector::open(2, knots.clone()).unwrap();
        Curve::rational(knots, Points::from(&square[..]), weights)
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        let mut weights = weights.clone();
        weights[3] = bad;
        let error = make(weights).unwrap_err();
        assert!(matches!(error, Error::OutOfRange { .. }), "{bad}: {error}");
    }
    assert!(matches!(make(weights[1..].to_vec()), Err(Error::WrongCount { expected: 9, .. })));
    assert!(matches!(make(Vec::new()), Err(Error::WrongCount { .. })));
    // A curve so sharp that its sixth derivative is no double.
    let knots = KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0]).unwrap();
    let ends = Points::from(&[[0.0], [1.0]][..]);
    let curve = Curve::rational(knots, ends, vec![1e-80, 1.0]).unwrap();
    let mut jet = [0.0; 7];
    assert_eq!(curve.derivatives_into(0.0, 6, &mut jet), Err(Error::LeavesDoubles));
    assert_eq!(curve.derivatives_into(0.0, 1, &mut jet[..2]), Ok(()));
}

/// A sphere: the half circle of The NURBS Book turned about the z axis (example A8.2).
fn sphere() -> Surface {
    let (knots_u, square, weights_u) = circle_parts();
    let knots_v = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
    let half = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let weights_v = [1.0, FRAC_1_SQRT_2, 1.0, FRAC_1_SQRT_2, 1.0];
    let (mut net, mut weights) = (Vec::new(), Vec::new());
    for (p, w) in square.iter().zip(&weights_u) {
        for (r, v) in half.iter().zip(&weights_v) {
            net.extend([p[0] * r[0], p[1] * r[0], r[1]]);
            weights.push(w * v);
        }
    }
    let knots = [KnotVector::open(2, knots_u).unwrap(), KnotVector::open(2, knots_v).unwrap()];
    Surface::rational(knots, PointGrid::new([9, 5], 3, net).unwrap(), weights).unwrap()
}

#[test]
fn a_sphere_is_round_and_its_partial_derivatives_agree_with_differences() {
    let sphere = sphere();
    let h = 1e-5;
    for (u, v) in [(0.1, 0.3), (0.6, 0.9), (0.3, 0.77), (0.95, 0.2)] {
        let jet = |u: f64, v: f64| {
            let mut jet = vec![0.0; 48];
            sphere.derivatives_into(u, v, 3, &mut jet).unwrap();
            jet
        };
        let here = jet(u, v);
        let length = here[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() < 1e-15, "{length}");
        let (in_u, in_v) = ([jet(u - h, v), jet(u + h, v)], [jet(u, v - h), jet(u, v + h)]);
        for a in 0..=3 {
            for b in 0..=3 {
                for i in 0..3 {
                    let at = (4 * a + b) * 3 + i;
                    let size = here.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                    if a < 3 {
                        let slope = (in_u[1][at] - in_u[0][at]) / (2.0 * h);
                        assert!((slope - here[at + 12]).abs() < 1e-5 * size, "({a}, {b})");
                    }
                    if b < 3 {
                        let slope = (in_v[1][at] - in_v[0][at]) / (2.0 * h);
                        assert!((slope - here[at + 3]).abs() < 1e-5 * size, "({a}, {b})");
                    }
                }
            }
        }
    }
}

#[test]
fn weights_of_a_surface_are_checked() {
    let sphere = sphere();
    let (knots, net) = (sphere.knots().clone(), sphere.control_net().clone());
    let mut weights = sphere.rational_weights().unwrap().to_vec();
    weights[7] = -1.0;
    let error = Surface::rational(knots.clone(), net.clone(), weights.clone()).unwrap_err();
    assert!(error.to_string().contains("rational weight 7"), "{error}");
    weights.pop();
    let error = Surface::rational(knots, net, weights).unwrap_err();
    assert!(matches!(error, Error::WrongCount { expected: 45, .. }));
}
