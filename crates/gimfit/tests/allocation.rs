//! A step allocates nothing, whatever the rule.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::basis::WangBall;
use gimfit::collocation::{
    CollocationMatrix, DenseCollocation, LeastSquaresCollocation, interpolation,
};
use gimfit::iteration::update::{
    Adaptive, AdaptiveRows, Anderson, Chebyshev, ClosestConvex, ConjugateGradients,
    ConvexityPreserving, GaussSeidel, HeavyBall, Jacobi, Local, Nesterov, PerPoint, Pia,
    Preconditioned, Preconditioner, RandomColumns, RandomRows, SaLspia, Scaled, Sor, Staged,
    Weighted,
};
use gimfit::iteration::{IterationState, UpdateRule};
use gimfit::knots::{place_knots, place_least_squares_knots};
use gimfit::parameters::{Parameters, assign_parameters};
use gimfit::shape::Shape;
use gimfit::{KnotPlacement, Parameterization, PointsView};
use gimfit_testkit::generate::{helix, random_walk};

#[test]
fn steps_on_a_dense_matrix_allocate_nothing() {
    let basis = WangBall::new(20).unwrap();
    let t = Parameters::open((0..21).map(|j| f64::from(j) / 20.0).collect()).unwrap();
    let operator = DenseCollocation::new(&basis, &t).unwrap();
    let data = helix(21);
    let rules: [Box<dyn UpdateRule + '_>; 5] = [
        Box::new(Pia),
        Box::new(GaussSeidel::new(&operator)),
        Box::new(Anderson::new(4, 63)),
        Box::new(Preconditioned::new(&operator, None).unwrap()),
        Box::new(Preconditioned::new(&operator, Some(2)).unwrap()),
    ];
    for mut rule in rules {
        let mut state = IterationState::begin(&operator, &data, 3);
        let counted = allocation_counter::measure(|| {
            (0..9).for_each(|_| state.step(rule.as_mut()));
        });
        assert_eq!(counted.count_total, 0, "{rule:?}");
    }
}

#[test]
fn steps_allocate_nothing() {
    const COUNT: usize = 500;
    let data = helix(COUNT);
    let view = PointsView::new(3, &data).unwrap();
    for closed in [false, true] {
        let t = assign_parameters(view, closed, &Parameterization::Chord).unwrap();
        let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
        let operator = interpolation(&t, &knots).unwrap().operator;
        let whole = || Preconditioned::new(&operator, None).unwrap();
        let rules: [Box<dyn UpdateRule + '_>; 13] = [
            Box::new(Pia),
            Box::new(Weighted::new(1.2)),
            Box::new(PerPoint::new(vec![1.1; COUNT])),
            Box::new(Jacobi::new(&operator)),
            Box::new(GaussSeidel::new(&operator)),
            Box::new(Sor::new(&operator, 1.1)),
            Box::new(Chebyshev::new(0.1, 1.0, 3 * COUNT)),
            Box::new(Anderson::new(10, 3 * COUNT)),
            Box::new(Anderson::new(2, 3 * COUNT)),
            Box::new(whole()),
            Box::new(Staged::new(Pia, 2, whole())),
            Box::new(Local::new(Pia, (100..200).collect(), 3)),
            Box::new(Adaptive::new(AdaptiveRows::Curve(&operator), 1e-3)),
        ];
        for mut rule in rules {
            let mut state = IterationState::begin(&operator, &data, 3);
            let counted = allocation_counter::measure(|| {
                (0..5).for_each(|_| state.step(rule.as_mut()));
            });
            assert_eq!(counted.count_total, 0, "{rule:?}");
            assert!(state.norms().is_finite());
        }
    }
}

#[test]
fn steps_of_least_squares_allocate_nothing() {
    const POINTS: usize = 400;
    const CONTROL: usize = 40;
    let data = helix(POINTS);
    let view = PointsView::new(3, &data).unwrap();
    for closed in [false, true] {
        let t = assign_parameters(view, closed, &Parameterization::Chord).unwrap();
        let knots = place_least_squares_knots(3, &t, CONTROL).unwrap();
        let operator = LeastSquaresCollocation::new(t.values(), &knots).unwrap();
        let grouped = operator.clone().grouped();
        let normal = operator.normal_matrix();
        let matrix = normal.matrix();
        let length = 3 * CONTROL;
        let gradients = |preconditioner| ConjugateGradients::new(matrix, preconditioner, 3);
        let factors = || matrix.factor(None).unwrap();
        let (low, high) = normal.eigenvalues().unwrap();
        let rules: [Box<dyn UpdateRule + '_>; 11] = [
            Box::new(PerPoint::new(normal.reciprocal_sums())),
            Box::new(GaussSeidel::new(matrix)),
            Box::new(HeavyBall::best_for(low, high, length)),
            Box::new(Nesterov::with_restarts(high, length)),
            Box::new(Scaled::new(normal.reciprocal_sums(), Chebyshev::new(0.1, 1.0, length))),
            Box::new(SaLspia::new(matrix, high, 3)),
            Box::new(RandomColumns::new(&normal, 3, 1)),
            Box::new(RandomRows::new(&operator, &data, 1)),
            Box::new(gradients(Preconditioner::Identity)),
            Box::new(gradients(Preconditioner::Diagonal(normal.reciprocal_diagonal()))),
            Box::new(gradients(Preconditioner::Factors(factors()))),
        ];
        let start = &data[..length];
        for mut rule in rules {
            for operator in [&operator, &grouped] {
                let mut state = IterationState::begin_at(operator, &data, start, 3);
                let counted = allocation_counter::measure(|| {
                    (0..5).for_each(|_| state.step(rule.as_mut()));
                });
                assert_eq!(counted.count_total, 0, "{rule:?}");
                rule.reset();
            }
        }
    }
}

#[test]
fn steps_on_a_grid_allocate_nothing_after_the_first() {
    use gimfit::collocation::TensorCollocation;
    use gimfit::iteration::update::NetPreconditioned;
    const COUNT: usize = 30;
    let line = helix(COUNT);
    let view = PointsView::new(3, &line).unwrap();
    let data: Vec<f64> = (0..COUNT).flat_map(|_| line.iter().copied()).collect();
    for closed in [false, true] {
        let t = assign_parameters(view, closed, &Parameterization::Chord).unwrap();
        let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
        let operator = interpolation(&t, &knots).unwrap().operator;
        let both = TensorCollocation::new(&operator, &operator, 3);
        let mut rule = NetPreconditioned::new(&operator, &operator, Some(1)).unwrap();
        let mut state = IterationState::begin(&both, &data, 3);
        state.step(&mut rule);
        let counted = allocation_counter::measure(|| (0..5).for_each(|_| state.step(&mut rule)));
        assert_eq!(counted.count_total, 0);
        assert!(state.norms().is_finite());
    }
}

#[test]
fn steps_that_keep_turns_allocate_nothing() {
    let data = random_walk(4, 300, 2).concat();
    let view = PointsView::new(2, &data).unwrap();
    for closed in [false, true] {
        let t = assign_parameters(view, closed, &Parameterization::Chord).unwrap();
        let knots = place_knots(3, &t, &KnotPlacement::Averaged).unwrap();
        let operator = interpolation(&t, &knots).unwrap().operator;
        let shape = || Shape::of(&data, closed, 3);
        let rules: [Box<dyn UpdateRule + '_>; 2] = [
            Box::new(ConvexityPreserving::new(Pia, shape(), 1e-9)),
            Box::new(ClosestConvex::new(&operator, shape()).unwrap()),
        ];
        for mut rule in rules {
            let mut state = IterationState::begin(&operator, &data, 2);
            let counted = allocation_counter::measure(|| {
                (0..5).for_each(|_| state.step(rule.as_mut()));
            });
            assert_eq!(counted.count_total, 0, "{rule:?}");
            assert!(state.norms().is_finite() && state.norms().max > 1e-9);
        }
    }
}
