//! What does each step of a curve fit cost per point, and does that grow with the number of points?
//! Cubics through points of three coordinates.

#![allow(missing_docs, clippy::unwrap_used)] // Criterion makes public functions; data are known good.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gimfit::collocation::{CollocationMatrix, CollocationOperator, Interpolation, interpolation};
use gimfit::fit::interpolate;
use gimfit::iteration::update::{GaussSeidel, Step, UpdateRule};
use gimfit::knots::place_knots;
use gimfit::parameters::{Parameters, assign_parameters};
use gimfit::{CurveOptions, KnotPlacement, KnotVector, Parameterization, PointsView};
use gimfit_bench::data::helix;
use std::hint::black_box;
use std::time::{Duration, Instant};

const SIZES: [usize; 3] = [1_000, 100_000, 1_000_000];

struct Case {
    points: Vec<f64>,
    parameters: Parameters,
    knots: KnotVector,
}

impl Case {
    fn new(count: usize) -> Self {
        let points = helix(count);
        let view = PointsView::new(3, &points).unwrap();
        let parameters = assign_parameters(view, false, &Parameterization::Chord).unwrap();
        let knots = place_knots(3, &parameters, &KnotPlacement::Averaged).unwrap();
        Self { points, parameters, knots }
    }

    fn view(&self) -> PointsView<'_> {
        PointsView::new(3, &self.points).unwrap()
    }

    fn interpolation(&self) -> Interpolation {
        interpolation(&self.parameters, &self.knots).unwrap()
    }
}

/// Times work that overwrites its vectors; putting them back is not timed.
fn in_place(repeats: u64, vectors: &[f64], mut work: impl FnMut(&mut [f64])) -> Duration {
    let mut scratch = vectors.to_vec();
    let mut total = Duration::ZERO;
    for _ in 0..repeats {
        scratch.copy_from_slice(vectors);
        let start = Instant::now();
        work(black_box(&mut scratch));
        total += start.elapsed();
    }
    total
}

/// One group: `run` benchmarks a kernel at each size.
fn over_sizes(
    criterion: &mut Criterion,
    name: &str,
    mut run: impl FnMut(&mut criterion::Bencher<'_>, &Case),
) {
    let mut group = criterion.benchmark_group(name);
    for count in SIZES {
        group.throughput(Throughput::Elements(count as u64));
        let case = Case::new(count);
        group.bench_with_input(BenchmarkId::from_parameter(count), &case, &mut run);
    }
    group.finish();
}

fn parameters(criterion: &mut Criterion) {
    over_sizes(criterion, "chord-length parameters", |bencher, case| {
        bencher.iter_with_large_drop(|| {
            assign_parameters(case.view(), false, &Parameterization::Chord).unwrap()
        });
    });
}

fn knots(criterion: &mut Criterion) {
    over_sizes(criterion, "averaged knots", |bencher, case| {
        bencher.iter_with_large_drop(|| {
            place_knots(3, &case.parameters, &KnotPlacement::Averaged).unwrap()
        });
    });
}

fn rows(criterion: &mut Criterion) {
    over_sizes(criterion, "rows", |bencher, case| {
        bencher.iter_with_large_drop(|| case.interpolation());
    });
}

fn difference_vectors(criterion: &mut Criterion) {
    over_sizes(criterion, "difference vectors", |bencher, case| {
        let operator = case.interpolation().operator;
        let mut result = vec![0.0; case.points.len()];
        bencher.iter(|| {
            operator.difference_vectors(&case.points, black_box(&case.points), 3, &mut result)
        });
    });
}

fn gauss_seidel_sweep(criterion: &mut Criterion) {
    over_sizes(criterion, "Gauss-Seidel sweep", |bencher, case| {
        let operator = case.interpolation().operator;
        let mut rule = GaussSeidel::new(&operator);
        bencher.iter_custom(|repeats| {
            let step = Step { iteration: 0, control: &case.points, dimension: 3 };
            in_place(repeats, &case.points, |vectors| rule.adjust(step, vectors))
        });
    });
}

fn band_factors(criterion: &mut Criterion) {
    over_sizes(criterion, "band factors", |bencher, case| {
        let operator = case.interpolation().operator;
        bencher.iter_with_large_drop(|| operator.factor(None).unwrap());
    });
}

fn band_solve(criterion: &mut Criterion) {
    over_sizes(criterion, "band solve", |bencher, case| {
        let factors = case.interpolation().operator.factor(None).unwrap();
        bencher.iter_custom(|repeats| {
            in_place(repeats, &case.points, |vectors| factors.solve_in_place(vectors, 3))
        });
    });
}

fn evaluation(criterion: &mut Criterion) {
    over_sizes(criterion, "evaluation at sorted parameters", |bencher, case| {
        let (parameters, knots) = (case.parameters.clone(), case.knots.clone());
        let fit = interpolate(case.view(), parameters, knots, &CurveOptions::default()).unwrap();
        let mut points = vec![0.0; case.points.len()];
        bencher.iter(|| {
            for (point, &t) in points.as_chunks_mut::<3>().0.iter_mut().zip(&fit.parameters) {
                fit.curve.evaluate_into(t, point).unwrap();
            }
        });
    });
}

criterion_group! {
    name = kernels;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = parameters, knots, rows, difference_vectors, gauss_seidel_sweep, band_factors,
        band_solve, evaluation
}
criterion_main!(kernels);
