//! Nearest points of whole curves and surfaces against brute force, and where they are hard.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::projection::{CurveProjector, SurfaceProjector};
use gimfit::{Curve, Error, KnotVector, PointGrid, Points, PointsView, Surface};
use gimfit_testkit::generate::Random;
use gimfit_testkit::nearest::least_distance;
use gimfit_testkit::textbook::{basis_function, rational_curve_point};
use proptest::prelude::*;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// A curve from random numbers, and its parts for the oracle.
struct Made {
    curve: Curve,
    control: Vec<Vec<f64>>,
    weights: Vec<f64>,
}

fn make(seed: u64, degree: usize, count: usize, dimension: usize, kind: u8) -> Made {
    let mut random = Random::new(seed);
    let (closed, rational) = (kind & 1 == 1, kind & 2 == 2);
    let knots = if closed {
        let knots = (0..count + 2 * degree + 1).map(|i| i as f64 - degree as f64).collect();
        KnotVector::periodic(degree, knots).unwrap()
    } else {
        let mut inner: Vec<f64> = (0..count - degree - 1).map(|_| random.unit()).collect();
        inner.sort_by(f64::total_cmp);
        let knots = [vec![0.0; degree + 1], inner, vec![1.0; degree + 1]].concat();
        KnotVector::open(degree, knots).unwrap()
    };
    let mut control: Vec<Vec<f64>> =
        (0..count).map(|_| (0..dimension).map(|_| random.signed()).collect()).collect();
    let mut weights: Vec<f64> =
        (0..count).map(|_| if rational { 0.1 + 3.0 * random.unit() } else { 1.0 }).collect();
    if closed {
        control.extend_from_within(..degree);
        weights.extend_from_within(..degree);
    }
    let points = Points::new(dimension, control.concat()).unwrap();
    let curve = if rational {
        Curve::rational(knots, points, weights.clone()).unwrap()
    } else {
        Curve::new(knots, points).unwrap()
    };
    Made { curve, control, weights }
}

impl Made {
    fn at(&self, t: f64) -> Vec<f64> {
        let knots = self.curve.knots().values();
        rational_curve_point(knots, self.curve.degree(), &self.control, &self.weights, t)
    }

    /// Expects the nearest points to be those of a brute search.
    fn check(&self, queries: &[Vec<f64>]) {
        let domain = self.curve.domain();
        let count = 600;
        // The textbook's end of the domain of a closed curve lies in no span.
        let share = |i: usize| i as f64 / count as f64 * (1.0 - 1e-14);
        let samples: Vec<(Vec<f64>, Vec<f64>)> = (0..=count)
            .map(|i| domain.0 + share(i) * (domain.1 - domain.0))
            .map(|t| (vec![t], self.at(t)))
            .collect();
        let projector = CurveProjector::new(&self.curve);
        for query in queries {
            let foot = projector.project(query).unwrap();
            let expected = least_distance(
                &|t| self.at(t[0]),
                &[(domain.0, domain.0 + (domain.1 - domain.0) * (1.0 - 1e-14))],
                &samples,
                1.0 / count as f64,
                query,
            );
            assert!(
                foot.distance <= expected + 1e-11 * (1.0 + expected),
                "{} but {expected} at {query:?}",
                foot.distance
            );
            let on_curve = self.at(foot.parameter);
            let size = 1.0 + foot.distance;
            assert!(on_curve.iter().zip(&foot.point).all(|(a, b)| (a - b).abs() < 1e-11 * size));
            let back: f64 = on_curve.iter().zip(query).map(|(a, b)| (a - b).powi(2)).sum();
            assert!((back.sqrt() - foot.distance).abs() < 1e-11 * size);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_nearest_point_of_a_curve_is_that_of_a_brute_search(
        seed in any::<u64>(),
        degree in 1usize..=5,
        more in 1usize..10,
        dimension in 1usize..=4,
        kind in 0u8..4,
    ) {
        let made = make(seed, degree, degree + more + 1, dimension, kind);
        let mut random = Random::new(seed ^ 1);
        let mut queries: Vec<Vec<f64>> = (0..4)
            .map(|_| (0..dimension).map(|_| 1.5 * random.signed()).collect())
            .collect();
        // On the curve, and so far off that only its hull counts.
        let (start, end) = made.curve.domain();
        queries.push(made.curve.evaluate(start + random.unit() * (end - start)).unwrap());
        queries.push((0..dimension).map(|_| 1e3 * random.signed()).collect());
        made.check(&queries);
    }
}

#[test]
fn high_degrees_are_searched_whole() {
    for (degree, kind) in [(12, 0), (12, 2), (25, 0), (25, 2), (20, 1)] {
        let made = make(degree as u64, degree, degree + 3, 2, kind);
        let curve = &made.curve;
        let projector = CurveProjector::new(curve);
        let steps = curve.equal_steps(4001);
        let mut random = Random::new(9);
        for _ in 0..10 {
            let query = [random.signed(), random.signed()];
            let foot = projector.project(&query).unwrap();
            let sampled = steps
                .iter()
                .map(|t| curve.evaluate(*t).unwrap())
                .map(|p| (p[0] - query[0]).hypot(p[1] - query[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(foot.distance <= sampled * (1.0 + 1e-12), "degree {degree}");
        }
    }
}

fn circle() -> Curve {
    let knots = vec![0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0];
    let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
    let weights = (0..9).map(|i| if i % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 }).collect();
    let points = Points::from(&corners.map(|p| p.map(f64::from))[..]);
    Curve::rational(KnotVector::open(2, knots).unwrap(), points, weights).unwrap()
}

#[test]
fn the_centre_of_a_circle_and_its_neighbours_are_no_trap() {
    let projector = CurveProjector::new(&circle());
    for r in [0.0, 1e-18, 1e-12, 1e-9, 1e-6, 1e-3, 0.5, 1.0, 2.0, 1e6, 1e12, 1e200, 1e305] {
        for i in 0..12 {
            let a = TAU * f64::from(i) / 12.0 + 0.05;
            let query = [r * a.cos(), r * a.sin()];
            let foot = projector.project(&query).unwrap();
            let distance = (query[0].hypot(query[1]) - 1.0).abs();
            assert!((foot.distance - distance).abs() <= 1e-12 * (1.0 + distance), "{r} {a}");
            if r > 1e-5 && r < 1e5 {
                assert!((foot.point[0] - a.cos()).hypot(foot.point[1] - a.sin()) < 1e-6, "{r} {a}");
            }
        }
    }
}

#[test]
fn ends_and_seams_are_found() {
    let knots = KnotVector::open(1, vec![0.0, 0.0, 1.0, 3.0, 3.0]).unwrap();
    let line = Curve::new(knots, Points::from(&[[0.0, 0.0], [1.0, 0.0], [3.0, 0.0]][..])).unwrap();
    let projector = CurveProjector::new(&line);
    for (query, t) in [
        ([-1.0, 2.0], 0.0),
        ([9.0, -2.0], 3.0),
        ([1.0, 5.0], 1.0),
        ([2.5, 0.0], 2.5),
        ([3.0, 0.0], 3.0),
    ] {
        assert_eq!(projector.project(&query).unwrap().parameter, t, "{query:?}");
    }
    // A closed curve: the seam has one name.
    let made = make(3, 3, 8, 2, 1);
    let projector = CurveProjector::new(&made.curve);
    let seam = made.curve.evaluate(0.0).unwrap();
    let foot = projector.project(&seam).unwrap();
    assert!(foot.distance < 1e-15 && foot.parameter.min(8.0 - foot.parameter) < 1e-7);
}

#[test]
fn collapsed_and_extreme_curves_end_at_once() {
    let knots = || KnotVector::open(3, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]).unwrap();
    let point = Points::new(2, [0.5, -0.5].repeat(4)).unwrap();
    let projector = CurveProjector::new(&Curve::new(knots(), point).unwrap());
    assert_eq!(projector.project(&[0.5, 0.5]).unwrap().distance, 1.0);
    assert_eq!(projector.project(&[0.5, -0.5]).unwrap().distance, 0.0);
    for scale in [1e-300, 1e-200, 1e-30, 1e30, 1e200, 1e300] {
        let values: Vec<f64> =
            [0.0, 0.0, 1.0, 2.0, 2.0, -2.0, 3.0, 0.0].iter().map(|x| x * scale).collect();
        let curve = Curve::new(knots(), Points::new(2, values).unwrap()).unwrap();
        let projector = CurveProjector::new(&curve);
        for query in [[1.0, 0.3], [0.0, 0.0], [1.5, 0.1], [-4.0, 1.0]] {
            let foot = projector.project(&query.map(|x| x * scale)).unwrap();
            let sampled = curve
                .equal_steps(2001)
                .iter()
                .map(|t| curve.evaluate(*t).unwrap())
                .map(|p| (p[0] / scale - query[0]).hypot(p[1] / scale - query[1]))
                .fold(f64::INFINITY, f64::min);
            let distance = foot.distance / scale;
            assert!(distance <= sampled + 1e-15 && distance > sampled - 1e-3, "{scale:e}");
        }
        for far in [[1e300, 0.0], [-1e300, 1e-300], [1e-300, -1e300]] {
            let foot = projector.project(&far).unwrap();
            assert!(foot.distance.is_finite() && foot.parameter.is_finite());
        }
    }
    // Small, and far from the origin.
    let values = [0.0, 0.0, 1e-3, 2e-3, 2e-3, -2e-3, 3e-3, 0.0].map(|x| 1e9 + x).to_vec();
    let curve = Curve::new(knots(), Points::new(2, values).unwrap()).unwrap();
    let foot = CurveProjector::new(&curve).project(&[1e9, 1e9 - 1.0]).unwrap();
    assert!((foot.distance - 1.0).abs() < 1e-2);
}

#[test]
fn what_is_no_point_is_refused() {
    let projector = CurveProjector::new(&circle());
    assert!(matches!(projector.project(&[1.0]), Err(Error::WrongCount { expected: 2, .. })));
    assert!(matches!(projector.project(&[]), Err(Error::WrongCount { .. })));
    let error = projector.project(&[1.0, f64::NAN]).unwrap_err();
    assert!(matches!(error, Error::NotFinite { coordinate: 1, .. }));
    let list = [[0.0, 0.0], [f64::INFINITY, 1.0]];
    assert!(matches!(projector.project_all(&list), Err(Error::NotFinite { point: 1, .. })));
    let none = PointsView::new(2, &[]).unwrap();
    assert!(projector.project_all(none).unwrap().is_empty());
    let surfaces = SurfaceProjector::new(&sphere());
    assert!(matches!(surfaces.project(&[1.0, 2.0]), Err(Error::WrongCount { .. })));
    assert!(surfaces.project(&[1.0, 2.0, f64::NAN]).is_err());
}

#[test]
fn many_queries_are_answered_as_one_by_one() {
    let made = make(17, 3, 60, 3, 0);
    let projector = CurveProjector::new(&made.curve);
    let mut random = Random::new(4);
    let queries = Points::new(3, (0..3000).map(|_| random.signed()).collect()).unwrap();
    let all = projector.project_all(queries.as_view()).unwrap();
    for (foot, query) in all.iter().zip(queries.iter()) {
        assert_eq!(*foot, projector.project(query).unwrap());
    }
}

// Surfaces.

struct MadeSurface {
    surface: Surface,
    weights: Vec<f64>,
}

fn make_surface(seed: u64, degrees: [usize; 2], dimension: usize, rational: bool) -> MadeSurface {
    let mut random = Random::new(seed);
    let knots = degrees.map(|p| {
        let inner = vec![0.3 + 0.4 * random.unit()];
        KnotVector::open(p, [vec![0.0; p + 1], inner, vec![1.0; p + 1]].concat()).unwrap()
    });
    let shape = knots.each_ref().map(KnotVector::control_points);
    let count = shape[0] * shape[1];
    let net = (0..count * dimension).map(|_| random.signed()).collect();
    let net = PointGrid::new(shape, dimension, net).unwrap();
    let weights: Vec<f64> =
        (0..count).map(|_| if rational { 0.3 + 2.0 * random.unit() } else { 1.0 }).collect();
    let surface = if rational {
        Surface::rational(knots, net, weights.clone()).unwrap()
    } else {
        Surface::new(knots, net).unwrap()
    };
    MadeSurface { surface, weights }
}

impl MadeSurface {
    fn at(&self, u: f64, v: f64) -> Vec<f64> {
        let [rows, columns] = self.surface.control_net().shape();
        let [p, q] = self.surface.degrees();
        let [in_u, in_v] = self.surface.knots();
        let mut sum = vec![0.0; self.surface.dimension()];
        let mut weight = 0.0;
        for i in 0..rows {
            for j in 0..columns {
                let w = self.weights[i * columns + j]
                    * basis_function(in_u.values(), p, i, u)
                    * basis_function(in_v.values(), q, j, v);
                weight += w;
                let control = self.surface.control_net().point(i, j);
                sum.iter_mut().zip(control).for_each(|(x, c)| *x += w * c);
            }
        }
        sum.iter().map(|x| x / weight).collect()
    }
}

#[test]
fn the_nearest_point_of_a_surface_is_that_of_a_brute_search() {
    for (seed, degrees, dimension, rational) in [
        (1, [1, 1], 3, false),
        (2, [2, 3], 3, false),
        (3, [2, 2], 3, true),
        (4, [3, 3], 2, false),
        (5, [3, 1], 4, true),
        (6, [2, 1], 1, false),
    ] {
        let made = make_surface(seed, degrees, dimension, rational);
        let count = 60;
        let samples: Vec<(Vec<f64>, Vec<f64>)> = (0..=count * (count + 2))
            .map(|k| [k / (count + 1), k % (count + 1)].map(|i| i as f64 / count as f64))
            .map(|[u, v]| (vec![u, v], made.at(u, v)))
            .collect();
        let projector = SurfaceProjector::new(&made.surface);
        let mut random = Random::new(seed + 50);
        for k in 0..8 {
            let size = [0.5, 1.5, 30.0][k % 3];
            let mut query: Vec<f64> = (0..dimension).map(|_| size * random.signed()).collect();
            if k == 7 {
                query = made.at(0.37, 0.81);
            }
            let foot = projector.project(&query).unwrap();
            let [u, v] = foot.parameters;
            let on: f64 = made.at(u, v).iter().zip(&query).map(|(a, b)| (a - b).powi(2)).sum();
            assert!((on.sqrt() - foot.distance).abs() < 1e-12 * (1.0 + foot.distance));
            let expected = least_distance(
                &|t| made.at(t[0], t[1]),
                &[(0.0, 1.0); 2],
                &samples,
                1.0 / count as f64,
                &query,
            );
            assert!(
                foot.distance <= expected + 1e-10 * (1.0 + expected),
                "{} but {expected}, surface {seed}, query {k}",
                foot.distance
            );
        }
    }
}

fn sphere() -> Surface {
    let circle = circle();
    let half = [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let half_weights = [1.0, FRAC_1_SQRT_2, 1.0, FRAC_1_SQRT_2, 1.0];
    let (mut net, mut weights) = (Vec::new(), Vec::new());
    for (p, w) in circle.control_points().iter().zip(circle.rational_weights().unwrap()) {
        for (r, v) in half.iter().zip(half_weights) {
            net.extend([p[0] * r[0], p[1] * r[0], r[1]]);
            weights.push(w * v);
        }
    }
    let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0]).unwrap();
    let net = PointGrid::new([9, 5], 3, net).unwrap();
    Surface::rational([circle.knots().clone(), knots], net, weights).unwrap()
}

#[test]
fn a_sphere_is_met_from_everywhere() {
    let projector = SurfaceProjector::new(&sphere());
    let mut random = Random::new(21);
    let mut queries = vec![[0.0; 3], [0.0, 0.0, 3.0], [0.0, 0.0, -0.3], [0.0, 0.0, 1.0], [1e-9; 3]];
    for size in [1e-6, 0.1, 1.0, 3.0, 1e8, 1e300] {
        queries.push([0; 3].map(|_| size * random.signed()));
    }
    for query in queries {
        let foot = projector.project(&query).unwrap();
        let radius = query[0].hypot(query[1]).hypot(query[2]);
        let distance = (radius - 1.0).abs();
        assert!((foot.distance - distance).abs() <= 2e-12 * (1.0 + distance), "{query:?} {foot:?}");
    }
}

#[test]
fn collapsed_and_closed_surfaces_are_searched() {
    let knots = || KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).unwrap();
    let net = PointGrid::new([3, 3], 3, vec![0.25; 27]).unwrap();
    let point = SurfaceProjector::new(&Surface::new([knots(), knots()], net).unwrap());
    assert_eq!(point.project(&[0.25, 0.25, 1.25]).unwrap().distance, 1.0);
    assert_eq!(point.project(&[0.25; 3]).unwrap().distance, 0.0);
    // A torus of cubics, closed in both directions; its axis is nearly equidistant.
    let (count, degree) = (12, 3);
    let mut net = Vec::new();
    for i in 0..count + degree {
        for j in 0..count + degree {
            let [a, b] = [i, j].map(|k| TAU * (k % count) as f64 / count as f64);
            let r = 2.0 + 0.5 * b.cos();
            net.extend([r * a.cos(), r * a.sin(), 0.5 * b.sin()]);
        }
    }
    let closed = || {
        let knots = (0..count + 2 * degree + 1).map(|i| i as f64 - degree as f64).collect();
        KnotVector::periodic(degree, knots).unwrap()
    };
    let net = PointGrid::new([count + degree; 2], 3, net).unwrap();
    let torus = Surface::new([closed(), closed()], net).unwrap();
    let projector = SurfaceProjector::new(&torus);
    let [u, v] = torus.knots().each_ref().map(|knots| knots.equal_steps(97));
    for query in [[0.0; 3], [2.0, 0.0, 0.0], [3.0, 0.1, 0.2], [-1.0, -1.0, 2.0], [0.0, 0.0, 5.0]] {
        let foot = projector.project(&query).unwrap();
        let mut sampled = f64::INFINITY;
        for &u in &u {
            for &v in &v {
                let p = torus.evaluate(u, v).unwrap();
                let d = (p[0] - query[0]).hypot(p[1] - query[1]).hypot(p[2] - query[2]);
                sampled = sampled.min(d);
            }
        }
        assert!(foot.distance <= sampled + 1e-12 && foot.distance > sampled - 1e-2, "{query:?}");
    }
}
