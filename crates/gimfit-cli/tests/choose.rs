//! Fits to choose from, through the program.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;

fn gimfit(folder: &Path, line: &str) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("gimfit").unwrap();
    command.current_dir(folder).args(line.split_whitespace()).assert()
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// An arc of a spiral.
fn spiral(at: &Path) {
    let points: String = (0..60)
        .map(|i| f64::from(i) / 10.0)
        .map(|t| format!("{:?},{:?}\n", (1.0 + t) * t.cos(), (1.0 + t) * t.sin()))
        .collect();
    fs::write(at.join("spiral.csv"), points).unwrap();
}

#[test]
fn each_line_is_the_fit_within_its_distance() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    spiral(at);
    let line = "choose spiral.csv --distances 1,0.1,0.01 -o all.json -o all.csv -o all.svg -o all.png \
                -o fit-{k}.json -o fit-{k}.svg";
    gimfit(at, line).code(0);
    let all = json(&at.join("all.json"));
    let choices = all["choices"].as_array().unwrap();
    assert_eq!(choices.len(), 3);
    let mut before = 0;
    for choice in choices {
        let count = choice["control_points"].as_u64().unwrap();
        assert!(count > before);
        before = count;
        assert!(choice["met"].as_bool().unwrap());
        let tolerance = choice["tolerance"].as_f64().unwrap();
        assert!(choice["max_distance"].as_f64().unwrap() <= tolerance);
        let single = format!("curve spiral.csv --tolerance {tolerance} -o single.json -q");
        gimfit(at, &single).code(0);
        let (single, member) =
            (json(&at.join("single.json")), json(&at.join(format!("fit-{count}.json"))));
        assert_eq!(single["geometry"], member["geometry"]);
        assert!(at.join(format!("fit-{count}.svg")).exists());
    }
    let table = fs::read_to_string(at.join("all.csv")).unwrap();
    assert_eq!(table.lines().count(), 4);
    assert!(table.starts_with("tolerance,met,control_points,rows,columns,max_distance"));
    roxmltree::Document::parse(&fs::read_to_string(at.join("all.svg")).unwrap()).unwrap();
    assert!(fs::read(at.join("all.png")).unwrap().starts_with(b"\x89PNG"));
}

#[test]
fn usual_distances_give_more_and_more_control_points() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    spiral(at);
    let out = gimfit(at, "choose spiral.csv --json").code(0).get_output().stdout.clone();
    let all: Value = serde_json::from_slice(&out).unwrap();
    let column = |name: &str| -> Vec<f64> {
        let choices = all["choices"].as_array().unwrap();
        choices.iter().map(|choice| choice[name].as_f64().unwrap()).collect()
    };
    let (sizes, errors) = (column("control_points"), column("max_distance"));
    assert!(sizes.len() >= 5);
    assert!(sizes.windows(2).all(|pair| pair[0] < pair[1]));
    assert!(errors.windows(2).all(|pair| pair[0] > pair[1]));
    // The last has more than half as many as there are points, or the distances ended.
    assert!(*sizes.last().unwrap() > 30.0 || *errors.last().unwrap() < 1e-3);
}

#[test]
fn grids_are_listed_with_their_nets() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let line = |i: i32| -> String {
        let cell = |j: i32| (f64::from(i) / 4.0).sin() * (f64::from(j) / 3.0).cos();
        (0..12).map(|j| format!("{:?}", cell(j))).collect::<Vec<_>>().join(",") + "\n"
    };
    fs::write(at.join("heights.csv"), (0..14).map(line).collect::<String>()).unwrap();
    let text = gimfit(at, "choose --grid heights.csv --distances 0.1,0.01 -o all.json").code(0);
    let text = String::from_utf8_lossy(&text.get_output().stdout).into_owned();
    assert!(text.contains("gimfit surface FILE --tolerance T, such as --tolerance 0.01"), "{text}");
    for choice in json(&at.join("all.json"))["choices"].as_array().unwrap() {
        let net: Vec<u64> =
            choice["net"].as_array().unwrap().iter().map(|n| n.as_u64().unwrap()).collect();
        assert_eq!(net[0] * net[1], choice["control_points"].as_u64().unwrap());
    }
}

#[test]
fn what_cannot_be_is_refused_or_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    spiral(at);
    let error = |line: &str, part: &str| {
        let run = gimfit(at, line).code(2);
        let text = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(text.contains(part), "{line}: {text}");
    };
    error("choose spiral.csv --distances 0.1,-1", "-1 is not a distance above 0");
    error("choose spiral.csv --distances inf", "");
    error("choose spiral.csv --abscissa 1", "does not exceed");
    error("choose spiral.csv --json --geometry", "--geometry belongs to");
    error("choose spiral.csv -o nowhere/a.json", "cannot write");
    error("choose --grid spiral.csv --knots uniform", "--knots does not go with");
    fs::write(at.join("one.csv"), "1,2\n").unwrap();
    error("choose one.csv", "too few");
    fs::write(at.join("same.csv"), "1,2\n1,2\n1,2\n1,2\n1,2\n").unwrap();
    error("choose same.csv", "equal");
    // Less than rounding allows: what was found is told, and that it is not enough.
    let run = gimfit(at, "choose spiral.csv --distances 1,1e-30").code(1);
    let (out, err) = (&run.get_output().stdout, &run.get_output().stderr);
    assert!(String::from_utf8_lossy(out).contains("not kept"));
    assert!(String::from_utf8_lossy(err).contains("the distance 1e-30 was not kept"));
}
