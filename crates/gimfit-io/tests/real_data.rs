//! The laws of the library on the real data of `testdata/`: the limit interpolates, by the textbook
//! recursion; residual histories are those of dense iterations; documents come back bit by bit.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use gimfit::{
    CurveFit, CurveOptions, Duplicates, KnotPlacement, Method, Parameterization, PointsView,
    fit_curve,
};
use gimfit_io::document::{Geometry, document_of, parse_document};
use gimfit_io::points::{ColumnChoice, PointTable, ReadOptions, read_points};
use gimfit_testkit::dense::{self, Rows};
use gimfit_testkit::textbook;
use std::path::PathBuf;

/// File, columns if not the usual ones, and whether the points close.
const FILES: [(&str, &[&str], bool); 7] = [
    ("airfoils/rae2822.dat", &[], true),
    ("airfoils/sc20714.dat", &[], false),
    ("airfoils/naca2412.dat", &[], false),
    ("glyphs/DejaVuSans_S_points.csv", &[], true),
    ("gpx/Mojstrovka.gpx", &["east", "north", "up"], false),
    ("mocap/WRIST.csv", &[], false),
    ("signals/nist_Gauss1.csv", &[], false),
];

fn read(name: &str, columns: &[&str]) -> PointTable {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../testdata").join(name);
    let columns = columns.iter().map(|name| ColumnChoice::Name((*name).into())).collect();
    let options = ReadOptions {
        columns: Some(columns).filter(|list: &Vec<_>| !list.is_empty()),
        ..ReadOptions::default()
    };
    read_points(&path, &options).unwrap()
}

fn fit(table: &PointTable, options: &CurveOptions) -> CurveFit {
    fit_curve(PointsView::new(table.dimension(), &table.coordinates).unwrap(), options).unwrap()
}

fn rows(flat: &[f64], dimension: usize) -> Rows {
    flat.chunks_exact(dimension).map(<[f64]>::to_vec).collect()
}

#[test]
fn curves_pass_through_real_points() {
    for (name, columns, closes) in FILES {
        let table = read(name, columns);
        for degree in [1, 2, 3, 5] {
            for closed in [false, true] {
                if closed && !closes {
                    continue;
                }
                let options = CurveOptions { degree, closed, ..Default::default() };
                let found = fit(&table, &options);
                let case = format!("{name}, degree {degree}, closed {closed}");
                assert!(found.report.converged(), "{case}: {:?}", found.report);
                let knots = found.curve.knots().values();
                let control: Rows =
                    found.curve.control_points().iter().map(<[f64]>::to_vec).collect();
                let scale =
                    control.concat().iter().fold(found.report.run.extent, |m, x| m.max(x.abs()));
                let data = rows(&table.coordinates, table.dimension());
                // Every third point keeps the recursion affordable.
                for (point, &t) in data.iter().zip(&found.parameters).step_by(3) {
                    let span = found.curve.knots().span(t).unwrap();
                    let near = span - degree..=span;
                    let local = &knots[span - degree..=span + degree + 1];
                    let on_curve = textbook::curve_point(local, degree, &control[near], t);
                    for (a, b) in point.iter().zip(&on_curve) {
                        assert!((a - b).abs() < 1e-13 * scale, "{case}: {a} {b}");
                    }
                }
            }
        }
    }
}

#[test]
fn histories_on_real_points_are_those_of_dense_iterations() {
    for (name, columns, _) in FILES {
        let table = read(name, columns);
        if table.rows() > 300 {
            continue;
        }
        let data = rows(&table.coordinates, table.dimension());
        let t = textbook::chord_parameters(&data);
        let matrix = textbook::collocation_matrix(&textbook::averaged_knots(3, &t), 3, &t);
        let cases: [(Method, dense::Step); 2] =
            [(Method::Pia, dense::pia_step), (Method::GaussSeidel, dense::gauss_seidel_step)];
        for (method, step) in cases {
            let options =
                CurveOptions { method, residual: Some(0.0), iterations: 6, ..Default::default() };
            let found = fit(&table, &options);
            let expected = dense::residual_history(&matrix, &data, step, 6);
            for (entry, expected) in found.report.run.history.iter().zip(&expected) {
                let gap = (entry.max_residual - expected).abs();
                assert!(gap < 1e-11 * found.report.run.extent, "{name} {method:?}: {gap:e}");
            }
        }
    }
}

#[test]
fn an_abscissa_is_the_parameter() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../testdata");
    let options =
        ReadOptions { abscissa: Some(ColumnChoice::Name("x".into())), ..ReadOptions::default() };
    let table = read_points(&path.join("signals/nist_Gauss1.csv"), &options).unwrap();
    let x = table.abscissa.clone().unwrap();
    let found = fit(
        &table,
        &CurveOptions {
            parameterization: Some(Parameterization::Given(x.clone())),
            knot_placement: Some(KnotPlacement::NotAKnot),
            ..Default::default()
        },
    );
    assert!(found.report.converged() && found.parameters == x);
    assert_eq!(found.curve.domain(), (x[0], x[x.len() - 1]));
}

#[test]
fn documents_come_back_bit_by_bit() {
    for (name, columns, closed) in FILES {
        let table = read(name, columns);
        let options = CurveOptions {
            closed,
            method: Method::Pia,
            keep: vec![0, 3],
            duplicates: Duplicates::Drop,
            ..Default::default()
        };
        let found = fit(&table, &options);
        let document = document_of(&found);
        let text = serde_json::to_vec(&document).unwrap();
        let back = parse_document(&text, name).unwrap();
        assert_eq!(back, document, "{name}");
        let Some(Geometry::Curve(geometry)) = &back.geometry else { panic!("no curve") };
        assert_eq!(geometry.curve().unwrap(), found.curve);
        let sequence = back.sequence.unwrap();
        for (kept, fit) in sequence.iter().zip(&found.sequence) {
            let curve = geometry.curve_with(&kept.control_points).unwrap();
            assert_eq!(curve.control_points(), &fit.control_points);
        }
    }
}

#[test]
fn a_run_that_converged_is_below_the_target_it_reports() {
    for (name, columns, _) in FILES {
        let table = read(name, columns);
        for degree in [3, 7, 9] {
            let options = CurveOptions { degree, ..Default::default() };
            let report = fit(&table, &options).report;
            if report.converged() {
                assert!(report.run.max_residual <= report.run.residual_target, "{name} {degree}");
            }
        }
    }
}
