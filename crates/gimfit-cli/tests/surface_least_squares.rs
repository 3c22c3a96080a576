//! Least squares over grids through the program.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn gimfit(folder: &Path, line: &str) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("gimfit").unwrap();
    command.current_dir(folder).args(line.split_whitespace()).assert()
}

/// Heights of a bicubic polynomial, which any bicubic net holds.
fn polynomial(at: &Path) {
    let line = |i: i32| -> String {
        let cell = |j: i32| {
            let (u, v) = (f64::from(i) / 8.0, f64::from(j) / 10.0);
            (1.0 + u - 2.0 * u.powi(3)) * (0.5 - v + 3.0 * v * v)
        };
        (0..11).map(|j| format!("{:?}", cell(j))).collect::<Vec<_>>().join(",") + "\n"
    };
    fs::write(at.join("heights.csv"), (0..9).map(line).collect::<String>()).unwrap();
}

#[test]
fn methods_agree_and_a_polynomial_is_its_own_fit() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    polynomial(at);
    let fit = |method: &str, more: &str| -> Value {
        let line = format!(
            "surface heights.csv --parameters uniform --method {method} {more} -o fit.json -q"
        );
        gimfit(at, &line).code(0);
        serde_json::from_slice(&fs::read(at.join("fit.json")).unwrap()).unwrap()
    };
    let heights = |document: &Value| -> Vec<f64> {
        let rows = document["geometry"]["control_points"].as_array().unwrap();
        let points = rows.iter().flat_map(|row| row.as_array().unwrap());
        points.map(|point| point[2].as_f64().unwrap()).collect()
    };
    let auto = fit("least-squares", "--control-points 5x6");
    assert_eq!(auto["report"]["control_points"], serde_json::json!([5, 6]));
    assert!(auto["report"]["max_residual"].as_f64().unwrap() < 1e-12);
    for method in ["cgls", "sor-lspia", "random-columns --seed 3"] {
        let other = fit(method, "--control-points 5x6 --iterations 20000");
        let (here, there) = (heights(&auto), heights(&other));
        let gap = here.iter().zip(&there).map(|(a, b)| (a - b).abs());
        assert!(gap.fold(0.0, f64::max) < 1e-8, "{method}");
    }
    let knots: String = [0, 0, 0, 0, 1, 1, 1, 1].iter().map(|k| format!("{k}\n")).collect();
    fs::write(at.join("knots.txt"), knots).unwrap();
    let given = fit("least-squares", "--knots knots.txt,knots.txt --hold-ends");
    assert_eq!(given["report"]["control_points"], serde_json::json!([4, 4]));
    assert!(given["report"]["max_residual"].as_f64().unwrap() < 1e-12);
}

#[test]
fn what_does_not_go_together_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    polynomial(at);
    let refused = |rest: &str, part: &str| {
        let run = gimfit(at, &format!("surface heights.csv {rest}")).code(2);
        let text = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(text.contains(part), "{rest}: {text}");
    };
    refused("--method least-squares", "--control-points MxN");
    refused("--method lspia --knots uniform", "from files only");
    refused("--method lspia --control-points 5x6 --keep 2", "--keep does not go");
    refused("--method lspia --control-points 5x6 --seed 2", "random-columns");
    refused("--method lspia --control-points 3x6", "3 control points");
    refused("--method lspia --control-points 50x6", "50 control points");
    refused("--method pia --control-points 5x6", "goes through all points");
    refused("--control-points 5x6 --weight 0.5", "--weight does not go");
    refused("--hold-ends", "--hold-ends belongs to");
}
