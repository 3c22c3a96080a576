//! `gimfit evaluate` on rational curves and on surfaces.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, numbers, table};
use serde_json::{Value, json};

/// The document of a quarter of a circle.
fn quarter() -> Value {
    json!({ "format": "gimfit", "version": 1, "geometry": {
        "type": "curve", "degree": 2, "dimension": 2, "periodic": false,
        "knots": [0, 0, 0, 1, 1, 1],
        "control_points": [[1, 0], [1, 1], [0, 1]],
        "weights": [1, std::f64::consts::FRAC_1_SQRT_2, 1],
    } })
}

/// The document of a quarter of a cylinder of height 2.
fn cylinder() -> Value {
    let w = std::f64::consts::FRAC_1_SQRT_2;
    json!({ "format": "gimfit", "version": 1, "geometry": {
        "type": "surface", "degrees": [2, 1], "dimension": 3, "periodic": [false, false],
        "knots": [[0, 0, 0, 1, 1, 1], [0, 0, 1, 1]],
        "control_points": [
            [[1, 0, 0], [1, 0, 2]], [[1, 1, 0], [1, 1, 2]], [[0, 1, 0], [0, 1, 2]],
        ],
        "weights": [[1, 1], [w, w], [1, 1]],
    }, "coordinate_names": ["x", "y", "height"] })
}

#[test]
fn weights_of_a_document_make_a_circle() {
    let place = Place::with("arc.json", quarter().to_string());
    let out = place.run("evaluate arc.json --samples 9 --derivatives 3").code(0).out;
    let rows = table(out.split_once('\n').unwrap().1);
    assert_eq!(rows.len(), 9);
    for row in &rows {
        assert!((row[1].hypot(row[2]) - 1.0).abs() < 1e-15, "{row:?}");
        assert!((row[1] * row[3] + row[2] * row[4]).abs() < 1e-14, "{row:?}");
        assert!(row[7] != 0.0, "a third derivative does not vanish: {row:?}");
    }
    place.run("info arc.json").code(0);
}

#[test]
fn weights_that_are_none_are_refused() {
    for (weights, part) in [
        (json!([1, -1, 1]), "rational weight 1"),
        (json!([1, 0, 1]), "rational weight 1"),
        (json!([1, 1]), "rational weights"),
        (json!([1, 1, "x"]), "line 1"),
        (json!([1, null, 1]), "line 1"),
        (json!([1e-200, 1, 1]), "ratio"),
    ] {
        let mut document = quarter();
        document["geometry"]["weights"] = weights;
        let place = Place::with("arc.json", document.to_string());
        place.run("evaluate arc.json --samples 3").code(2).says(&["arc.json", part]);
    }
    for weights in [json!([[1, 1], [1], [1, 1]]), json!([[1, 1]]), json!([[1, 1], [1, -2], [1, 1]])]
    {
        let mut document = cylinder();
        document["geometry"]["weights"] = weights;
        let place = Place::with("c.json", document.to_string());
        place.run("evaluate c.json --samples 3x3").code(2).says(&["c.json", "rational weight"]);
    }
}

#[test]
fn a_surface_is_sampled_with_its_partial_derivatives() {
    let place = Place::with("c.json", cylinder().to_string());
    let out = place.run("evaluate c.json --samples 5x3 --derivatives 2").code(0).out;
    let (header, rows) = out.split_once('\n').unwrap();
    let partials =
        ["du", "dv", "duu", "duv", "dvv"].map(|d| format!("{d} x,{d} y,{d} height")).join(",");
    assert_eq!(header, format!("u,v,x,y,height,{partials}"));
    let rows = table(rows);
    assert_eq!(rows.len(), 15);
    for row in &rows {
        assert!(
            (row[2].hypot(row[3]) - 1.0).abs() < 1e-15 && (row[4] - 2.0 * row[1]).abs() < 1e-15
        );
        assert!((row[2] * row[5] + row[3] * row[6]).abs() < 1e-14);
        assert!((row[10] - 2.0).abs() < 1e-14 && row[16].abs() < 1e-14);
    }
    place.run("evaluate c.json --samples 5x3 --derivatives 2 -o c.csv").code(0);
    assert_eq!(place.read("c.csv"), out);
    place.run("evaluate c.json --samples 5x3 --derivatives 2 -o s.json").code(0);
    let samples = place.document("s.json");
    for (sample, row) in samples["samples"].as_array().unwrap().iter().zip(&rows) {
        assert_eq!(numbers(&sample["parameters"]), row[..2]);
        assert_eq!(numbers(&sample["point"]), row[2..5]);
        assert_eq!(numbers(&sample["derivatives"]["uv"]), row[14..17]);
    }
}

#[test]
fn a_surface_is_sampled_at_pairs_and_at_kept_fits() {
    let mut grid = String::from("row,column,x,y,z\n");
    for i in 0..6 {
        for j in 0..5 {
            grid += &format!("{i},{j},{i},{j},{}\n", i * j % 4);
        }
    }
    let place = Place::with("grid.csv", grid);
    place.run("surface grid.csv --closed u --method pia --keep 0,3 -o fit.json -q").code(0);
    let document = place.document("fit.json");
    let [u, v] = [0, 1].map(|k| numbers(&document["parameters"][k]));
    place.write("at.csv", format!("{},{}\n{},{}\n", u[2], v[1], u[2] + 1.0, v[1]));
    let rows =
        table(place.run("evaluate fit.json --at at.csv").code(0).out.split_once('\n').unwrap().1);
    for (found, expected) in rows[0][2..].iter().zip([2.0, 1.0, 2.0]) {
        assert!((found - expected).abs() < 1e-10);
    }
    assert!(rows[0][2..].iter().zip(&rows[1][2..]).all(|(a, b)| (a - b).abs() < 1e-12));
    let kept = place.run("evaluate fit.json --at at.csv --iteration 0").code(0).out;
    assert_ne!(table(kept.split_once('\n').unwrap().1), rows);
    place.run("evaluate fit.json --at at.csv --iteration 1").code(2).says(&["0, 3"]);
    place.write("off.csv", "0.5,0.5\n0.5,1.5\n");
    place.run("evaluate fit.json --at off.csv").code(2).says(&["off.csv", "v of pair 2", "1.5"]);
    place.write("wide.csv", "0.5,0.5,1\n");
    place.run("evaluate fit.json --at wide.csv").code(2).says(&["wide.csv", "pairs u,v"]);
    place.run("evaluate fit.json --samples 9").code(2).says(&["surface", "9x9"]);
    place.run("evaluate fit.json --samples 99999999x99999999").code(2).says(&["--samples"]);
    place.run("evaluate fit.json --samples 3x0").code(2).says(&["--samples"]);
    place.write("arc.json", quarter().to_string());
    place.run("evaluate arc.json --samples 3x3").code(2).says(&["curve", "one number"]);
}
