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
    let message = text(&refused.get_output().stderr);
    assert!(message.contains("holds a surface") && message.contains("5x5"), "{message}");
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
    refuse(matrix, "--knots sometimes", "--knots takes averaged, not-a-knot");
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

#[test]
fn each_kept_fit_is_a_complete_file_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("peaks.csv"), peaks()).unwrap();
    gimfit(
        at,
        "surface peaks.csv --method pia --residual 0 --iterations 9 --keep 0,4 -o S-{k}.json \
         -o S-{iteration}.csv -o S-{k}.svg -o S-{k}.png -o all.json -q",
    )
    .code(0);
    let document = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(at.join(name)).unwrap()).unwrap()
    };
    for k in [0, 4] {
        gimfit(
            at,
            &format!(
                "surface peaks.csv --method pia --residual 0 --iterations {k} -o alone.json -q"
            ),
        )
        .code(0);
        let (member, alone) = (document(&format!("S-{k}.json")), document("alone.json"));
        assert_eq!(member["geometry"], alone["geometry"]);
        assert_eq!(member["parameters"], alone["parameters"]);
        for number in ["max_residual", "rms_residual", "max_deviation"] {
            let of = |d: &serde_json::Value| d["report"][number].as_f64().unwrap();
            assert!((of(&member) - of(&alone)).abs() < 1e-9 * of(&alone), "{k} {number}");
        }
        assert_eq!(member["report"]["max_residual_index"], alone["report"]["max_residual_index"]);
        let info = gimfit(at, &format!("info S-{k}.json")).code(0);
        assert!(text(&info.get_output().stdout).contains("open surface"));
        for ending in ["csv", "svg", "png"] {
            assert!(at.join(format!("S-{k}.{ending}")).exists(), "{ending}");
        }
    }
    let refused = gimfit(at, "surface peaks.csv -o X-{k}.json").code(2);
    assert!(text(&refused.get_output().stderr).contains("--keep"));
    let same = gimfit(at, "surface peaks.csv --keep 0,1 -o X-{k}.json -o X-1.json").code(2);
    assert!(text(&same.get_output().stderr).contains("one file"));
    let report = gimfit(at, "surface peaks.csv --keep 0 --report R-{k}.json").code(2);
    assert!(text(&report.get_output().stderr).contains("whole run"));
    assert!(!at.join("X-0.json").exists() && !at.join("X-1.json").exists());
}

#[test]
fn choices_for_each_direction_come_from_rules_and_files() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("peaks.csv"), peaks()).unwrap();
    let axis: String = (0..11).map(|i| format!("{}\n", f64::from(i * i))).collect();
    fs::write(at.join("t.txt"), axis).unwrap();
    fs::write(at.join("w.txt"), "1.5\n".repeat(11)).unwrap();
    gimfit(at, "surface peaks.csv --parameters uniform,t.txt -o a.json -q").code(0);
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("a.json")).unwrap()).unwrap();
    assert_eq!(document["parameters"][1][10], 100.0);
    assert_eq!(document["report"]["parameterizations"], serde_json::json!(["uniform", "given"]));
    let knots: Vec<String> = document["geometry"]["knots"][1]
        .as_array()
        .unwrap()
        .iter()
        .map(ToString::to_string)
        .collect();
    fs::write(at.join("k.txt"), knots.join("\n")).unwrap();
    gimfit(at, "surface peaks.csv --parameters uniform,t.txt --knots averaged,k.txt -o b.json -q")
        .code(0);
    let again: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("b.json")).unwrap()).unwrap();
    assert_eq!(again["geometry"], document["geometry"]);
    let weighted = "surface peaks.csv --method weighted --iterations 40 --residual 0 -q";
    gimfit(at, &format!("{weighted} --per-direction --weight w.txt,1.5 -o c.json")).code(0);
    gimfit(at, &format!("{weighted} --per-direction --weight 1.5 -o d.json")).code(0);
    let geometry = |name: &str| -> serde_json::Value {
        let document: serde_json::Value =
            serde_json::from_slice(&fs::read(at.join(name)).unwrap()).unwrap();
        document["geometry"].clone()
    };
    assert_eq!(geometry("c.json"), geometry("d.json"));
    let says = |line: &str, part: &str| {
        let refused = gimfit(at, line).code(2);
        let said = text(&refused.get_output().stderr);
        assert!(said.contains(part), "{line}: {said}");
    };
    says(&format!("{weighted} --weight 1.5,auto"), "--per-direction");
    says("surface peaks.csv --parameters none.txt", "--parameters takes chord");
    says("surface peaks.csv --parameters chord,", "a rule is missing");
    says("surface peaks.csv --parameters=-,- --knots -", "standard input");
    says("surface peaks.csv --method jacobi", "one direction after the other");
    says("surface peaks.csv --parameters k.txt", "parameters");
}

#[test]
fn abscissae_that_fall_are_counted_from_the_other_end() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let header = "ncols 5\nnrows 4\nxllcorner 100\nyllcorner 200\ncellsize 10\n";
    fs::write(at.join("dem.asc"), format!("{header}1 2 3 4 5\n2 3 5 4 3\n3 4 6 5 2\n4 4 4 4 1\n"))
        .unwrap();
    let run = gimfit(at, "surface dem.asc --parameters axes -o dem.json").code(0);
    assert!(text(&run.get_output().stdout).contains("minus the abscissae of the rows"));
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("dem.json")).unwrap()).unwrap();
    assert_eq!(document["parameters"][0], serde_json::json!([-235.0, -225.0, -215.0, -205.0]));
}

#[test]
fn info_tells_of_grids_and_of_their_missing_cells() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("peaks.csv"), peaks()).unwrap();
    let header =
        "ncols 5\nnrows 4\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n";
    let rows = "1 2 3 4 5\n2 -9999 5 4 3\n3 4 6 -9999 2\n4 4 4 4 1\n";
    fs::write(at.join("dem.asc"), format!("{header}{rows}")).unwrap();
    fs::write(at.join("m.csv"), ",0,1,2,3\n0,1,2,3,4\n1,2,,4,5\n2,1,2,3,4\n3,4,5,6,7\n").unwrap();
    let mut holed: Vec<String> = peaks().lines().map(str::to_owned).collect();
    holed.remove(20);
    fs::write(at.join("holed.csv"), holed.join("\n")).unwrap();
    fs::write(at.join("xyz.csv"), "x,y,z\n0,0,1\n1,0,2\n2,1,1\n").unwrap();
    fs::write(at.join("uv.csv"), "u,v\n0,0\n1,0\n2,1\n").unwrap();
    let told = |line: &str| -> serde_json::Value {
        let output = gimfit(at, &format!("info {line} --json")).code(0);
        serde_json::from_slice(&output.get_output().stdout).unwrap()
    };
    let peaks = told("peaks.csv");
    assert_eq!(peaks["holds"], "grid");
    assert_eq!((&peaks["rows"], &peaks["columns"]), (&11.into(), &11.into()));
    assert_eq!((&peaks["dimension"], &peaks["missing_cells"]), (&3.into(), &0.into()));
    let dem = told("dem.asc");
    assert_eq!(
        (&dem["rows"], &dem["columns"], &dem["missing_cells"]),
        (&4.into(), &5.into(), &2.into())
    );
    assert!(dem["first_missing"].as_str().unwrap().starts_with("row 2, column 2"));
    assert_eq!(dem["row_abscissae"], serde_json::json!([235.0, 205.0]));
    assert!(dem["shortest_step_u"].as_f64().unwrap() >= 10.0);
    let matrix = told("m.csv");
    assert_eq!((&matrix["missing_cells"], &matrix["rows"]), (&1.into(), &4.into()));
    let holed = told("holed.csv");
    assert_eq!((&holed["missing_cells"], &holed["rows"]), (&1.into(), &11.into()));
    assert_eq!(told("xyz.csv")["holds"], "points");
    assert_eq!(told("uv.csv")["holds"], "points");
    assert_eq!(told("xyz.csv --grid --shape 1x3")["rows"], 1);
    // To fit them, holes are an error as before.
    for file in ["dem.asc", "m.csv", "holed.csv"] {
        gimfit(at, &format!("surface {file}")).code(2);
    }
}

#[test]
fn foot_points_of_a_surface_are_in_its_document() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("peaks.csv"), peaks()).unwrap();
    gimfit(at, "surface peaks.csv --method geometric -o fit.json -o fit.svg -q").code(0);
    let document: serde_json::Value =
        serde_json::from_slice(&fs::read(at.join("fit.json")).unwrap()).unwrap();
    let fell = !document["report"]["foot_points"]["fall_back"].is_null();
    match document["foot_parameters"].as_array() {
        Some(rows) => {
            assert!(!fell && rows.len() == 11);
            assert!(rows.iter().all(|row| row.as_array().unwrap().len() == 11));
        }
        None => assert!(fell),
    }
    let refused = gimfit(at, "surface peaks.csv --method geometric --per-direction").code(2);
    assert!(text(&refused.get_output().stderr).contains("both directions at once"));
    gimfit(at, "surface peaks.csv --method geometric --weight 1.2").code(2);
}
