//! `gimfit edit`.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, testdata};
use serde_json::Value;

fn airfoil() -> String {
    testdata("airfoils/sc20714.dat").display().to_string()
}

fn rows(value: &Value) -> Vec<Vec<f64>> {
    serde_json::from_value(value.clone()).unwrap()
}

fn document(place: &Place, command: &str) -> Value {
    serde_json::from_str(&place.run(command).code(0).out).unwrap()
}

#[test]
fn edits_are_done_in_order_and_give_the_fit_of_the_edited_points() {
    let place = Place::new();
    let file = airfoil();
    let edits =
        "--remove 3 --insert 40=0.6,0.081 --move 3=0.985,0.012 --remove 205 --insert 205=1,-.01";
    let run = place.run(&format!("edit {file} {edits} -o out.json")).code(0);
    assert!(run.out.contains("edits: 5") && run.out.contains("removed 3: control points 1 to"));
    assert!(run.out.contains("inserted 205"), "{}", run.out);

    // The same points at the same parameters, fitted as a whole.
    let found: Value = serde_json::from_str(&place.read("out.json")).unwrap();
    let t: Vec<f64> = serde_json::from_value(found["parameters"].clone()).unwrap();
    assert_eq!(t.len(), 205);
    let residual = found["report"]["max_residual"].as_f64().unwrap();
    assert!(residual < 1e-12, "{residual}");
    let text = t.iter().map(|t| format!("{t:?}\n")).collect::<String>();
    place.write("t.txt", text);
    let read = std::fs::read_to_string(&file).unwrap();
    let mut points: Vec<Vec<f64>> = read
        .lines()
        .filter_map(|line| {
            let cells: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
            cells.ok().filter(|cells| cells.len() == 2)
        })
        .collect();
    assert_eq!(points.len(), 205);
    points.remove(2);
    points.insert(39, vec![0.6, 0.081]);
    points[2] = vec![0.985, 0.012];
    points.remove(204);
    points.insert(204, vec![1.0, -0.01]);
    let csv: String = points.iter().map(|p| format!("{:?},{:?}\n", p[0], p[1])).collect();
    place.write("edited.csv", format!("x,y\n{csv}"));
    let whole = document(&place, "curve edited.csv --parameters t.txt -q -o -");
    let (ours, theirs) =
        (rows(&found["geometry"]["control_points"]), rows(&whole["geometry"]["control_points"]));
    assert_eq!(found["geometry"]["knots"], whole["geometry"]["knots"]);
    assert_eq!(ours.len(), theirs.len());
    for (a, b) in ours.iter().zip(&theirs) {
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12, "{a:?} {b:?}");
    }
}

#[test]
fn wrong_edits_name_the_option_and_write_nothing() {
    let place = Place::new();
    let file = airfoil();
    for (rest, words) in [
        ("", "at least one --move"),
        ("--move 0=1,2", "count from 1"),
        ("--move x=1,2", "not the number of a point"),
        ("--move 3", "a number and a place"),
        ("--move 3=1,nan", "finite"),
        ("--move 3=1,", "not a number"),
        ("--move 206=1,2", "--move 206=1,2: there are 205 points"),
        ("--insert 207=1,2", "a point at 206 goes to the end"),
        ("--remove 206", "--remove 206"),
        ("--remove 3=1", "its number only"),
        ("--move 3=1", "1 number is given, but the points have 2"),
        ("--insert 3=1,2,3", "3 numbers are given"),
        ("--move 3=1e300,0", "--move 3=1e300,0: the fit leaves the range"),
        ("--closed --remove 3", "--closed"),
        ("--knots not-a-knot --remove 3", "--knots"),
        ("--basis bernstein --remove 3", "--basis"),
        ("--residual 0 --remove 3", "--residual"),
    ] {
        place.run(&format!("edit {file} {rest} -o out.json")).code(2).says(&[words]);
        assert!(!place.path("out.json").exists(), "{rest}");
    }
    place.write("few.csv", "x,y\n0,0\n1,1\n2,0\n3,1\n");
    for (rest, words) in [
        ("--remove 1", "3 points would be left"),
        ("--move 2=2,0", "its neighbour, point 3"),
        ("--insert 2=1,1", "its neighbour, point 2"),
        ("--insert 4=2,1e-30", "too close to a neighbour"),
    ] {
        place.run(&format!("edit few.csv {rest}")).code(2).says(&[words, rest]);
    }
}

#[test]
fn values_of_dimension_1_and_files_of_other_formats() {
    let place = Place::new();
    place.write("one.csv", "y\n0\n1\n4\n9\n16\n25\n");
    let found = document(&place, "edit one.csv --columns y --insert 4=6.25 --degree 2 -q -o -");
    assert_eq!(found["parameters"][3].as_f64(), Some(0.5));
    assert_eq!(found["report"]["points"], 7);
    place.run("edit one.csv --columns y --remove 2 -o out.svg -o out.csv --samples 5").code(0);
    assert!(place.read("out.svg").contains("<svg") && place.read("out.csv").lines().count() == 6);
    place.run("edit nowhere.csv --remove 2").code(2).says(&["nowhere.csv"]);
}
