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
        ("--knots not-a-knot --remove 3", "--knots"),
        ("--basis bernstein --remove 3", "--basis"),
        ("--residual 0 --remove 3", "--residual"),
        ("--remove 3 -o e-{k}.json", "name one file"),
    ] {
        place.run(&format!("edit {file} {rest} -o out.json")).code(2).says(&[words]);
        assert!(!place.path("out.json").exists(), "{rest}");
    }
    place.write("few.csv", "x,y\n0,0\n1,1\n2,0\n3,1\n");
    // Points are counted from 1 in what was asked and in what is told.
    let told = place.run("edit few.csv --move 2=1,2").code(0).out;
    assert!(told.contains(" at point ") && !told.contains("counted from 0"), "{told}");
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

/// The outline of a letter: its points on both sides of the seam are edited.
#[test]
fn closed_curves_are_edited_across_the_seam() {
    let place = Place::new();
    let round = |k: u32| (std::f64::consts::TAU * f64::from(k) / 200.0).sin_cos();
    let points: Vec<(f64, f64)> = (0..200).map(round).collect();
    let csv: String = points.iter().map(|(y, x)| format!("{x:?},{y:?}\n")).collect();
    place.write("circle.csv", format!("x,y\n{csv}"));
    let edits = "--move 1=1.05,0 --insert 201=1,-0.012 --remove 30";
    let run = place.run(&format!("edit circle.csv --closed {edits} -o out.json")).code(0);
    assert!(
        run.out.contains("closed") && run.out.contains("moved 1: control points 1"),
        "{}",
        run.out
    );
    let found: Value = serde_json::from_str(&place.read("out.json")).unwrap();
    assert_eq!(found["geometry"]["periodic"], true);
    assert!(found["report"]["max_residual"].as_f64().unwrap() < 1e-11);
    // The curve passes through the moved point at its parameter.
    let t = found["parameters"][0].as_f64().unwrap();
    place.write("t.txt", format!("{t:?}\n"));
    let at = place.run("evaluate out.json --at t.txt").code(0);
    let last = at.out.lines().last().unwrap();
    let x: f64 = last.split(',').nth(1).unwrap().parse().unwrap();
    assert!((x - 1.05).abs() < 1e-12, "{last}");
}

#[test]
fn points_of_a_grid_move_and_the_fit_is_that_of_the_moved_grid() {
    let place = Place::new();
    let cell = |i: u32, j: u32| {
        let (x, y) = (f64::from(i), f64::from(j) * 0.5);
        [x, y, (0.7 * x).sin() + y.cos()]
    };
    let grid = |moved: bool| -> String {
        let rows = (0..40_u32).flat_map(|i| {
            (0..30_u32).map(move |j| {
                let mut p = cell(i, j);
                if moved && (i, j) == (7, 4) {
                    p = [7.25, 2.0, -0.5];
                }
                format!("{i},{j},{:?},{:?},{:?}\n", p[0], p[1], p[2])
            })
        });
        format!("row,column,x,y,z\n{}", rows.collect::<String>())
    };
    place.write("grid.csv", grid(false));
    place.write("moved.csv", grid(true));
    let edit = "--move 8,5=7.25,2,-0.5 --parameters uniform";
    let run = place.run(&format!("surface grid.csv {edit} -o out.json -o out.svg")).code(0);
    assert!(run.out.contains("moved 8,5: control points of rows 1 to"), "{}", run.out);
    assert!(run.out.contains("edits: 1, each by local PIA"), "{}", run.out);
    let found: Value = serde_json::from_str(&place.read("out.json")).unwrap();
    let whole = document(&place, "surface moved.csv --parameters uniform -q -o -");
    let net = |document: &Value| -> Vec<f64> {
        let rows: Vec<Vec<Vec<f64>>> =
            serde_json::from_value(document["geometry"]["control_points"].clone()).unwrap();
        rows.concat().concat()
    };
    assert_eq!(net(&found).len(), net(&whole).len());
    for (a, b) in net(&found).iter().zip(&net(&whole)) {
        assert!((a - b).abs() < 1e-10, "{a} {b}");
    }
    for (rest, words) in [
        ("--move 8=1,2,3", "a row, a column and a place"),
        ("--move 8,5", "a row, a column and a place"),
        ("--move 0,5=1,2,3", "count from 1"),
        ("--move a,5=1,2,3", "not the number of a row"),
        ("--move 41,5=1,2,3", "no row 41"),
        ("--move 1,31=1,2,3", "no column 31"),
        ("--move 1,3=1,2", "2 numbers are given, but the points have 3"),
        ("--move 1,3=1,2,inf", "finite"),
        ("--move 1,3=1e300,2,3", "--move 1,3=1e300,2,3: the fit leaves the range"),
        ("--move 1,3=1,2,3 --only 1,1", "--only"),
        ("--move 1,3=1,2,3 --keep 0", "--keep"),
        ("--move 1,3=1,2,3 --method geometric", "foot points"),
    ] {
        place.run(&format!("surface grid.csv {rest} -o bad.json")).code(2).says(&[words]);
        assert!(!place.path("bad.json").exists(), "{rest}");
    }
}
