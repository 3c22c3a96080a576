//! What does a curve through points cost, how does that grow, and which method is fastest?
//! Cubics through points of three coordinates, chord length, averaged knots.

#![allow(missing_docs, clippy::unwrap_used)] // Criterion makes public functions; data are known good.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use gimfit::{CurveFit, CurveOptions, Method, PointsView, fit_curve};
use gimfit_bench::data::{helix, torus_winding};
use std::time::Duration;

const SIZES: [usize; 4] = [20, 1_000, 100_000, 1_000_000];
const METHODS_SIZE: usize = 100_000;

/// Fits, and makes sure that 1e-12 of the extent was reached.
fn fit(points: &[f64], options: &CurveOptions) -> CurveFit {
    let fit = fit_curve(PointsView::new(3, points).unwrap(), options).unwrap();
    assert!(fit.report.converged(), "{:?}", fit.report.run.termination);
    fit
}

fn sizes(criterion: &mut Criterion) {
    for (name, closed) in [("open curve", false), ("closed curve", true)] {
        let options = CurveOptions { closed, ..CurveOptions::default() };
        let mut group = criterion.benchmark_group(name);
        for count in SIZES {
            let points = if closed { torus_winding(count) } else { helix(count) };
            group.throughput(Throughput::Elements(count as u64));
            group.bench_with_input(
                BenchmarkId::from_parameter(count),
                &points,
                |bencher, points| {
                    bencher.iter_with_large_drop(|| fit(points, &options));
                },
            );
        }
        group.finish();
    }
}

fn methods(criterion: &mut Criterion) {
    let points = helix(METHODS_SIZE);
    let mut group = criterion.benchmark_group("method");
    group.throughput(Throughput::Elements(METHODS_SIZE as u64));
    for (name, method) in [
        ("pia", Method::Pia),
        ("weighted", Method::Weighted),
        ("gauss-seidel", Method::GaussSeidel),
        ("chebyshev", Method::Chebyshev),
        ("preconditioned", Method::Preconditioned { half_bandwidth: None }),
    ] {
        let options = CurveOptions { method, ..CurveOptions::default() };
        group.bench_function(name, |bencher| {
            bencher.iter_with_large_drop(|| fit(&points, &options));
        });
    }
    group.finish();
}

criterion_group! {
    name = curve;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = sizes, methods
}
criterion_main!(curve);
