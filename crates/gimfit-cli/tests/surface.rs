//! Surfaces through the program.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use assert_cmd::Command;
use std::fmt::Write;
use std::fs;
use std::path::Path;

fn gimfit(folder: &Path, line: &str) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("gimfit").unwrap();
    command.current_dir(folder).args(line.split_whitespace()).assert()
}

fn text(output: &[u8]) -> String {
    String::from_utf8_lossy(output).into_owned()
}

/// MATLAB's peaks on an 11 x 11 grid: the data of Lin, Wang and Dong (2004), Fig. 6.
fn peaks() -> String {
    let mut lines = String::from("row,column,x,y,z\n");
    for i in 0..11 {
        for j in 0..11 {
            let (x, y) = (-3.0 + 0.6 * f64::from(i), -3.0 + 0.6 * f64::from(j));
            let z = 3.0 * (1.0 - x).powi(2) * (-x * x - (y + 1.0).powi(2)).exp()
                - 10.0 * (x / 5.0 - x.powi(3) - y.powi(5)) * (-x * x - y * y).exp()
                - (-(x + 1.0).powi(2) - y * y).exp() / 3.0;
            writeln!(lines, "{i},{j},{x:?},{y:?},{z:?}").unwrap();
        }
    }
    lines
}

#[test]
fn the_published_surface_comes_out_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("peaks.csv"), peaks()).unwrap();
    gimfit(
        at,
        "surface peaks.csv --knots at-data --method pia --residual 0 --iterations 30 --keep 0,3,15 \
         -o fit.json -o fit.svg -o fit.png -o net.csv -q",
    )
    .code(0)
    .stdout("");
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("fit.json")).unwrap()).unwrap();
    assert_eq!(document["geometry"]["type"], "surface");
    assert_eq!(document["geometry"]["degrees"], serde_json::json!([3, 3]));
    let net = document["geometry"]["control_points"].as_array().unwrap();
    assert_eq!((net.len(), net[0].as_array().unwrap().len()), (13, 13));
    // Table 1 of the paper, iteration 15, to its seven digits.
    let residual = document["report"]["history"][15]["max_residual"].as_f64().unwrap();
    assert_eq!(format!("{residual:.6e}"), "1.528187e-2");
    assert_eq!(document["sequence"].as_array().unwrap().len(), 3);
    roxmltree::Document::parse(&fs::read_to_string(at.join("fit.svg")).unwrap()).unwrap();
    assert!(fs::read(at.join("fit.png")).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(fs::read_to_string(at.join("net.csv")).unwrap().lines().count(), 170);
    let info = gimfit(at, "info fit.json").code(0);
    assert!(text(&info.get_output().stdout).contains("open surface"));
    let refused = gimfit(at, "evaluate fit.json --samples 5").code(2);
    assert!(text(&refused.get_output().stderr).contains("holds a surface"));
}

#[test]
fn directions_have_choices_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut tube = String::from("u,v,x,y,z\n");
    for i in 0..9 {
        for j in 0..12 {
            let a = std::f64::consts::TAU * f64::from(j) / 12.0;
            let radius = 2.0 + (0.7 * f64::from(i)).sin();
            writeln!(tube, "{i},{j},{:?},{:?},{i}", radius * a.cos(), radius * a.sin()).unwrap();
        }
    }
    fs::write(at.join("tube.csv"), tube).unwrap();
    let run = gimfit(
        at,
        "surface tube.csv --degree 3,2 --closed v --parameters axes,uniform --knots \
         not-a-knot,averaged --per-direction --method gauss-seidel --json --geometry",
    )
    .code(0);
    let document: serde_json::Value = serde_json::from_slice(&run.get_output().stdout).unwrap();
    let (geometry, report) = (&document["geometry"], &document["report"]);
    assert_eq!(geometry["periodic"], serde_json::json!([false, true]));
    assert_eq!(report["parameterizations"], serde_json::json!(["given", "uniform"]));
    assert_eq!(report["knot_placements"], serde_json::json!(["not-a-knot", "averaged"]));
    assert_eq!(report["termination"], "residual");
    let row = geometry["control_points"][0].as_array().unwrap();
    assert_eq!(row.len(), 14);
    assert_eq!((&row[0], &row[1]), (&row[12], &row[13]));
    let samples = gimfit(at, "surface tube.csv --closed v -o samples.csv --samples 5x7").code(0);
    assert!(text(&samples.get_output().stdout).contains("5 x 7 samples"));
    assert_eq!(fs::read_to_string(at.join("samples.csv")).unwrap().lines().count(), 36);
}

#[test]
fn refusals_name_the_cell_the_row_or_the_option() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let refuse = |content: &str, options: &str, expected: &str| {
        fs::write(at.join("grid.csv"), content).unwrap();
        let run = gimfit(at, &format!("surface grid.csv {options} -o out.json")).code(2);
        let message = text(&run.get_output().stderr);
        assert!(message.contains(expected), "{options}: {message}");
        assert!(!at.join("out.json").exists());
    };
    let matrix = "1,2,3,4\n2,3,4,5\n3,1,4,1\n5,9,2,6\n";
    refuse("", "", "empty");
    refuse(matrix, "--degree 4", "needs 5");
    refuse(&matrix.replace("9", ""), "", "column 2");
    refuse(&matrix.replace("9", "nan"), "", "column 2");
    refuse(matrix, "--parameters axes", "abscissae");
    refuse(matrix, "--index-columns a", "two columns");
    refuse(matrix, "--method sor", "sor");
    refuse(matrix, "--samples 1x5", "--samples");
    refuse(matrix, "--per-direction --keep 1", "keeping fits");
    refuse(matrix, "--knots sometimes", "no rule");
    let run = gimfit(at, "surface grid.csv -o grid.csv").code(2);
    assert!(!text(&run.get_output().stderr).is_empty());
    assert_eq!(fs::read_to_string(at.join("grid.csv")).unwrap(), matrix);
}

#[test]
fn parameters_of_the_file_that_are_left_aside_are_told_in_print_and_document() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut grid = String::from("u,v,x,y,z\n");
    for (i, j) in (0..16).map(|k| (k / 4, k % 4)) {
        writeln!(grid, "{i},{j},{i},{j},{}", (i * j) % 3).unwrap();
    }
    fs::write(at.join("grid.csv"), grid).unwrap();
    let told = |line: &str| {
        let run = gimfit(at, line).code(0);
        text(&run.get_output().stdout).contains("--parameters axes takes them")
    };
    assert!(told("surface grid.csv") && told("surface grid.csv --json"));
    assert!(!told("surface grid.csv --parameters axes"));
}
