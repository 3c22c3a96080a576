//! Laws of the bases that are no B-splines, judged by the formulas of the books.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::Error;
use gimfit::basis::{Bernstein, BlendingBasis, Dp, Rational, SaidBall, WangBall};
use gimfit::collocation::{
    CollocationMatrix, CollocationOperator, DenseCollocation, smallest_eigenvalue_of,
};
use gimfit::parameters::Parameters;
use gimfit_testkit::blending;
use std::sync::Arc;

type Textbook = fn(usize, usize, f64) -> f64;

fn named(degree: usize) -> [(Arc<dyn BlendingBasis>, Textbook); 4] {
    [
        (Arc::new(Bernstein::new(degree).unwrap()), blending::bernstein),
        (Arc::new(WangBall::new(degree).unwrap()), blending::wang_ball),
        (Arc::new(SaidBall::new(degree).unwrap()), blending::said_ball),
        (Arc::new(Dp::new(degree).unwrap()), blending::dp),
    ]
}

fn uniform(count: usize) -> Parameters {
    let last = (count - 1) as f64;
    Parameters::open((0..count).map(|j| j as f64 / last).collect()).unwrap()
}

fn values(basis: &dyn BlendingBasis, t: f64) -> Vec<f64> {
    let mut values = vec![f64::NAN; basis.functions()];
    basis.evaluate_into(t, &mut values);
    values
}

const PARAMETERS: [f64; 9] = [0.0, 1e-9, 0.1, 1.0 / 3.0, 0.5, 0.625, 0.9, 1.0 - 1e-12, 1.0];

#[test]
fn named_bases_are_those_of_the_books() {
    for degree in [1, 2, 3, 4, 5, 8, 10, 13, 25] {
        for (basis, textbook) in named(degree) {
            for t in PARAMETERS {
                for (i, value) in values(&*basis, t).into_iter().enumerate() {
                    let expected = textbook(degree, i, t);
                    let error = (value - expected).abs();
                    assert!(error <= 1e-13 * expected + 1e-15, "{basis:?} {i} at {t}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn named_bases_blend_at_every_degree() {
    for degree in [1, 2, 7, 25, 60, 61, 199, 500] {
        for (basis, _) in named(degree) {
            for t in PARAMETERS {
                let values = values(&*basis, t);
                let sum: f64 = values.iter().sum();
                assert!(values.iter().all(|&x| x >= 0.0), "{basis:?} at {t}");
                assert!((sum - 1.0).abs() < 2e-13, "{basis:?} at {t}: {sum}");
            }
        }
    }
    for degree in [0, 501, usize::MAX] {
        assert!(matches!(Bernstein::new(degree), Err(Error::OutOfRange { .. })));
        assert!(matches!(WangBall::new(degree), Err(Error::OutOfRange { .. })));
        assert!(matches!(SaidBall::new(degree), Err(Error::OutOfRange { .. })));
        assert!(matches!(Dp::new(degree), Err(Error::OutOfRange { .. })));
    }
}

#[test]
fn bernstein_coefficients_give_the_functions_back() {
    for degree in [1, 2, 3, 4, 5, 9, 10, 25, 40] {
        for (basis, _) in named(degree) {
            let rows = basis.bernstein_coefficients().unwrap();
            for t in PARAMETERS {
                let of_degree = values(&Bernstein::new(degree).unwrap(), t);
                let direct = values(&*basis, t);
                for (row, direct) in rows.chunks_exact(degree + 1).zip(direct) {
                    let sum: f64 = row.iter().zip(&of_degree).map(|(a, b)| a * b).sum();
                    assert!((sum - direct).abs() < 1e-13, "{basis:?} at {t}: {sum} {direct}");
                }
            }
        }
    }
}

/// Smallest eigenvalues at i / n, beside the product law for the Bernstein basis.
#[test]
fn smallest_eigenvalues_are_the_published_ones() {
    let degrees = [3, 4, 5, 8, 10];
    let expected = [
        [0.2222, 0.0938, 0.0384, 2.40e-3, 3.63e-4],
        [0.1481, 0.0545, 0.0131, 3.15e-4, 2.11e-5],
        [0.1481, 0.0818, 0.0197, 1.43e-3, 1.80e-4],
        [0.0741, 0.0208, 2.93e-3, 1.95e-5, 5.2e-7],
    ];
    for (column, degree) in degrees.into_iter().enumerate() {
        for ((basis, _), row) in named(degree).into_iter().zip(expected) {
            let operator = DenseCollocation::new(&*basis, &uniform(degree + 1)).unwrap();
            let found = smallest_eigenvalue_of(&operator).unwrap();
            let error = (found.estimate / row[column] - 1.0).abs();
            assert!(error < 0.01, "{basis:?}: {found:?}");
            if basis.is_totally_positive() {
                assert!(found.lower <= found.estimate && found.estimate <= found.upper);
                assert!(found.estimate <= 1.01 * found.lower, "{basis:?}: {found:?}");
            } else {
                assert_eq!((found.lower, found.upper), (0.0, 1.0), "an estimate says so");
            }
        }
        let law = blending::bernstein_eigenvalue(degree, degree);
        let operator =
            DenseCollocation::new(&Bernstein::new(degree).unwrap(), &uniform(degree + 1)).unwrap();
        assert!((operator.known_smallest_eigenvalue().unwrap() - law).abs() < 1e-15);
        let enclosed = gimfit::collocation::smallest_eigenvalue(&operator.factor(None).unwrap());
        assert!(enclosed.lower <= law * 1.0001 && law <= enclosed.upper * 1.0001, "{enclosed:?}");
    }
}

#[test]
fn positive_weights_make_a_rational_basis() {
    let weights = vec![1.0, 2.0, 0.5, 3.0];
    let basis = Rational::new(Bernstein::new(3).unwrap(), weights.clone()).unwrap();
    assert_eq!(basis.name(), "rational bernstein");
    assert!(basis.is_totally_positive());
    assert!(
        !Rational::new(WangBall::new(3).unwrap(), weights.clone()).unwrap().is_totally_positive()
    );
    for t in PARAMETERS {
        let plain: Vec<f64> = (0..4).map(|i| weights[i] * blending::bernstein(3, i, t)).collect();
        let sum: f64 = plain.iter().sum();
        for (value, plain) in values(&basis, t).into_iter().zip(plain) {
            assert!((value - plain / sum).abs() < 1e-15);
        }
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let weights = vec![1.0, 1.0, bad, 1.0];
        let error = Rational::new(Bernstein::new(3).unwrap(), weights).unwrap_err();
        assert!(error.to_string().contains("rational weight 2"), "{error}");
    }
    assert!(matches!(
        Rational::new(Bernstein::new(3).unwrap(), vec![1.0; 3]),
        Err(Error::WrongCount { .. })
    ));
    assert!(matches!(Rational::new(basis, weights), Err(Error::Incompatible { .. })));
}

/// A basis of the user's that is not one.
#[derive(Debug)]
struct Broken(f64);

impl BlendingBasis for Broken {
    fn name(&self) -> &str {
        "broken"
    }

    fn functions(&self) -> usize {
        3
    }

    fn evaluate_into(&self, t: f64, values: &mut [f64]) {
        values.copy_from_slice(&[1.0 - t, t, if t > 0.3 { self.0 } else { 0.0 }]);
    }
}

#[test]
fn a_basis_that_does_not_blend_is_refused_at_its_parameter() {
    for (value, says) in
        [(f64::NAN, "function 2 is NaN"), (-0.5, "function 2 is -0.5"), (0.25, "the sum is 1.25")]
    {
        let error = DenseCollocation::new(&Broken(value), &uniform(3)).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("broken") && text.contains("0.5") && text.contains(says), "{text}");
    }
}

#[test]
fn a_dense_operator_refuses_what_does_not_fit_it() {
    let basis = Bernstein::new(4).unwrap();
    assert!(matches!(DenseCollocation::new(&basis, &uniform(4)), Err(Error::WrongCount { .. })));
    let outside = Parameters::open(vec![0.0, 0.2, 0.5, 1.0, 1.5]).unwrap();
    assert!(matches!(
        DenseCollocation::new(&basis, &outside),
        Err(Error::OutsideDomain { parameter: 1.5, .. })
    ));
    // Functions that depend on each other: no interpolant, and no factors.
    let operator = DenseCollocation::new(&Broken(0.0), &uniform(3)).unwrap();
    let error = operator.factor(None).unwrap_err();
    assert!(matches!(&error, Error::SingularBasis { points: 3, .. }), "{error}");
}

#[test]
fn the_reduction_keeps_row_sums_and_the_sweep_solves_its_triangle() {
    let operator = DenseCollocation::new(&SaidBall::new(6).unwrap(), &uniform(7)).unwrap();
    let diagonal = operator.factor(Some(0)).unwrap();
    let mut x = [1.0, -2.0, 3.0, 4.0, 0.5, 6.0, 7.0];
    let before = x;
    diagonal.solve_in_place(&mut x, 1);
    assert!(x.iter().zip(before).all(|(a, b)| (a - b).abs() < 1e-14), "half bandwidth 0 is PIA");

    operator.sweep(1.2, &mut x, 1);
    for (j, expected) in before.into_iter().enumerate() {
        let row = operator.row(j);
        let left: f64 = (0..j).map(|i| row[i] * x[i]).sum();
        assert!((left + row[j] / 1.2 * x[j] - expected).abs() < 1e-12);
    }
    let mut product = [0.0; 7];
    operator.apply(&before, 1, &mut product);
    operator.factor(None).unwrap().solve_in_place(&mut product, 1);
    assert!(product.iter().zip(before).all(|(a, b)| (a - b).abs() < 1e-12));
}
