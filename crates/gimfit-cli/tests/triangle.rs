//! Triangular patches through the program.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::Place;
use gimfit_testkit::blending;
use serde_json::Value;

/// A bent triangle of degree 4.
fn bent(columns: &str) -> String {
    let mut lines = format!("{columns}\n");
    for row in 0..5_i32 {
        for c in 0..=row {
            let (x, y) = (f64::from(row - c), f64::from(c));
            let cells = [x, y, (0.7 * x).sin() + 0.1 * y * y];
            let kept = columns.split(',').count();
            let text: Vec<String> = cells[3 - kept..].iter().map(|x| format!("{x:?}")).collect();
            lines += &(text.join(",") + "\n");
        }
    }
    lines
}

#[test]
fn a_patch_is_fitted_written_told_and_sampled() {
    let place = Place::with("bent.csv", bent("x,y,z"));
    let line = "triangle bent.csv --method pia --iterations 50 --residual 0 --keep 0,7 -o fit.json \
                -o fit.svg -o net.csv";
    let printed = place.run(line).code(0).out;
    assert!(printed.contains("degree 4, 15 control points in 5 rows"), "{printed}");
    let document: Value = serde_json::from_str(&place.read("fit.json")).unwrap();
    assert_eq!(document["geometry"]["type"], "triangle");
    assert_eq!(document["sequence"].as_array().unwrap().len(), 2);
    assert_eq!(place.read("net.csv").lines().count(), 16);
    assert!(place.read("net.csv").starts_with("row,column,x,y,z\n0,0,"));
    roxmltree::Document::parse(&place.read("fit.svg")).unwrap();
    let info = place.run("info fit.json").code(0).out;
    assert!(info.contains("triangular patch") && info.contains("kept iterations"), "{info}");

    // Samples by the textbook.
    let points: Vec<Vec<f64>> =
        serde_json::from_value(document["geometry"]["control_points"].clone()).unwrap();
    let out = place.run("evaluate fit.json --samples 6").code(0).out;
    let mut lines = out.lines();
    assert_eq!(lines.next(), Some("u,v,x,y,z"));
    let mut count = 0;
    for line in lines {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let (u, v) = (cells[0], cells[1]);
        let mut sum = [0.0; 3];
        let mut index = 0;
        for row in 0..=4 {
            for c in 0..=row {
                let weight = blending::triangular([4 - row, row - c, c], [u, v, 1.0 - u - v]);
                sum.iter_mut().zip(&points[index]).for_each(|(s, p)| *s += weight * p);
                index += 1;
            }
        }
        assert!(sum.iter().zip(&cells[2..]).all(|(a, b)| (a - b).abs() < 1e-12), "{line}");
        count += 1;
    }
    assert_eq!(count, 21);
    let own = place.run(
        "triangle bent.csv --samples 6 -o samples.csv -q --method pia --iterations 50 --residual 0",
    );
    own.code(0);
    assert_eq!(place.read("samples.csv"), out);
    place.write("at.txt", "0.5 0.25 1 0");
    assert_eq!(place.run("evaluate fit.json --at at.txt").code(0).out.lines().count(), 3);
    place.run("evaluate fit.json --at at.txt -o at.json").code(0);
    assert!(place.read("at.json").contains("\"parameter\":[0.5,0.25]"));
    let kept = place.run("evaluate fit.json --samples 2 --iteration 0").code(0).out;
    assert_eq!(kept.lines().nth(1), Some("1.0,0.0,0.0,0.0,0.0"));
}

#[test]
fn other_dimensions_are_drawn() {
    for columns in ["z", "y,z"] {
        let place = Place::with("bent.csv", bent(columns));
        place.run("triangle bent.csv -o fit.svg -o fit.json -q").code(0);
        roxmltree::Document::parse(&place.read("fit.svg")).unwrap();
        place.run("info fit.json").code(0);
    }
}

#[test]
fn a_report_alone_is_known_as_that_of_a_triangle() {
    let place = Place::with("bent.csv", bent("x,y,z"));
    place.write("report.json", place.run("triangle bent.csv --json").code(0).out);
    let info = place.run("info report.json").code(0).out;
    assert!(info.contains("points") && info.contains("15"), "{info}");
    place.run("evaluate report.json --samples 3").code(2).says(&["holds no patch"]);
}

#[test]
fn what_is_no_triangle_is_refused() {
    let place = Place::with("bent.csv", bent("x,y,z"));
    place.write("eleven.csv", "1,2\n".repeat(11));
    place.run("triangle eleven.csv").code(2).says(&["11 points fill no triangle", "10", "15"]);
    place.write("two.csv", "1,2\n3,4\n");
    place.run("triangle two.csv").code(2).says(&["too few"]);
    place.write("nan.csv", bent("x,y,z").replace("2.0,1.0", "2.0,nan"));
    place.run("triangle nan.csv").code(2).says(&["nan.csv"]);
    place.run("triangle bent.csv --abscissa x").code(2).says(&["--abscissa"]);
    place.run("triangle bent.csv --samples 1 -o a.csv").code(2);
    place.run("triangle bent.csv --weight 3 --method weighted").code(2).says(&["between 0 and 2"]);
    place.run("triangle bent.csv -o fit.json -q").code(0);
    place.run("evaluate fit.json --samples 1").code(2).says(&["each edge"]);
    place.run("evaluate fit.json --samples 3 --derivatives 1").code(2).says(&["--derivatives"]);
    place.run("evaluate fit.json --samples 3 --iteration 4").code(2).says(&["keeps no fit"]);
    for (numbers, says) in [("0.5 0.5 0.1", "pairs"), ("0.9 0.2", "outside the triangle")] {
        place.write("at.txt", numbers);
        place.run("evaluate fit.json --at at.txt").code(2).says(&[says]);
    }
    let cut = place.read("fit.json").replacen("\"degree\":4", "\"degree\":5", 1);
    place.write("cut.json", cut);
    place.run("info cut.json").code(2).says(&["21 expected"]);
    place.run("curve fit.json").code(2);
}
