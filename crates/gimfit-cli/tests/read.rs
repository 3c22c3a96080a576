//! Formats and refusals of input, through the program: each file gives the points it means, or a
//! message that names the file, the line and the column.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{Place, numbers, points, table, testdata, wave};
use serde_json::Value;

/// The points read: a curve of degree 1 through uniform parameters has them as control points.
#[track_caller]
fn read(name: &str, content: impl AsRef<[u8]>, options: &str) -> Vec<Vec<f64>> {
    let place = Place::with(name, content);
    let document = place.fit(&format!("{name} --degree 1 --parameters uniform {options}"));
    points(&document["geometry"]["control_points"])
}

#[track_caller]
fn refused(name: &str, content: impl AsRef<[u8]>, options: &str, parts: &[&str]) {
    let place = Place::with(name, content);
    place.write("old.json", "old");
    let ran = place.run(&format!("curve {name} {options} -o old.json -o new.svg")).code(2);
    assert!(ran.out.is_empty());
    ran.says(parts).says(&[name]);
    assert_eq!(place.read("old.json"), "old");
    assert!(!place.holds("new.svg"));
}

/// A NumPy array of doubles, format 1.0, as `numpy.save` writes it.
fn npy(rows: &[[f64; 2]], fortran: bool) -> Vec<u8> {
    let order = if fortran { "True" } else { "False" };
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': {order}, 'shape': ({}, 2), }}", rows.len());
    while (10 + header.len() + 1) % 64 != 0 {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.bytes());
    let columns = (0..2).flat_map(|c| rows.iter().map(move |row| row[c]));
    let values: Vec<f64> =
        if fortran { columns.collect() } else { rows.iter().flatten().copied().collect() };
    bytes.extend(values.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

const EXPECTED: [[f64; 2]; 3] = [[1.5, -2.0], [3.0, 0.25], [4.0, 1e3]];

fn expected() -> Vec<Vec<f64>> {
    EXPECTED.iter().map(|row| row.to_vec()).collect()
}

#[test]
fn every_text_form_of_the_same_points_is_the_same_points() {
    for (name, content) in [
        ("a.csv", "1.5,-2\n3,0.25\n4,1000\n"),
        ("a.csv", "x,y\n1.5,-2\n3,0.25\n4,1e3\n"),
        ("a.csv", "\u{feff}x,y\r\n1.5,-2\r\n3,.25\r\n4.,+1E3\r\n"),
        ("a.csv", "1.5;-2\n3;0.25\n4;1000"),
        ("a.csv", "\"1.5\",\"-2\"\n\"3\",\"0.25\"\n\"4\",\"1000\"\n"),
        ("a.csv", "# a comment\n\n1.5, -2\n3 , 0.25\n\n4,1000\n# the end\n"),
        ("a.csv", "1,5;-2\n3;0,25\n4;1000\n"),
        ("a.tsv", "x\ty\n1.5\t-2\n3\t0.25\n4\t1000\n"),
        ("a.tsv", "1,5\t-2\n3\t0,25\n4\t1000\n"),
        ("a.txt", "  1.5   -2\n 3\t0.25\n4 1000\n"),
        ("a", "1.5 -2\n3 0.25\n4 1000\n"),
    ] {
        assert_eq!(read(name, content, ""), expected(), "{content:?}");
    }
}

#[test]
fn columns_are_chosen_by_name_or_number_and_in_any_order() {
    let content = "t,y,x,label\n0,-2,1.5,a\n1,0.25,3,b\n2,1e3,4,c\n";
    assert_eq!(read("a.csv", content, "--columns x,y"), expected());
    assert_eq!(read("a.csv", content, "--columns 3,2"), expected());
    refused("a.csv", content, "--columns x,z", &["z", "t, y, x, label"]);
    refused("a.csv", content, "--columns 9", &["9"]);
    refused("a.csv", content, "--columns x,x", &["twice"]);
    refused("a.csv", content, "--columns x,label", &["line 2", "label", "not a number"]);
}

#[test]
fn a_comma_that_is_a_decimal_mark_or_a_group_is_asked_about() {
    let content = "x,y\n\"1,234\",\"5\"\n\"2,345\",\"6\"\n";
    refused("a.csv", content, "", &["line 2", "column 1", "\"x\"", "--decimal comma"]);
    let rows = read("a.csv", content, "--decimal comma --delimiter comma");
    assert_eq!(rows, [[1.234, 5.0], [2.345, 6.0]]);
}

#[test]
fn xyz_takes_the_first_three_columns() {
    let rows = read("a.xyz", "0 1 2 255\n3 4 5 255\n", "");
    assert_eq!(rows, [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]);
}

#[test]
fn an_airfoil_in_either_order_is_one_loop_from_the_trailing_edge() {
    let selig = "WING\n1 0\n0.5 0.1\n0 0\n0.5 -0.1\n1 -0.01\n";
    let lednicer = "WING\n3. 3.\n\n0 0\n0.5 0.1\n1 0\n\n0 0\n0.5 -0.1\n1 -0.01\n";
    let rows = read("a.dat", selig, "");
    assert_eq!(rows.len(), 5);
    assert_eq!(rows, read("a.dat", lednicer, ""));
    assert_eq!((rows[0][0], rows[2].clone()), (1.0, vec![0.0, 0.0]));
    let short = "WING\n4. 3.\n\n0 0\n0.5 0.1\n1 0\n\n0 0\n0.5 -0.1\n1 -0.01\n";
    refused("a.dat", short, "", &["line"]);
    let place = Place::new();
    let name = testdata("airfoils/rae2822.dat");
    let ran = place.run(&format!("info {} --json", name.display())).code(0);
    assert_eq!(ran.json()["title"], "RAE 2822 AIRFOIL");
}

const TRACK: &str = "<gpx><trk><name>Up</name><trkseg>\
    <trkpt lat=\"46\" lon=\"13\"><ele>100</ele></trkpt>\
    <trkpt lat=\"46.001\" lon=\"13\"><ele>150</ele></trkpt>\
    <trkpt lat=\"46.001\" lon=\"13.001\"><ele>120</ele></trkpt></trkseg></trk></gpx>";

#[test]
fn a_gpx_track_is_degrees_or_metres_as_asked() {
    let degrees = read("a.gpx", TRACK, "");
    assert_eq!(degrees, [[13.0, 46.0], [13.0, 46.001], [13.001, 46.001]]);
    let metres = read("a.gpx", TRACK, "--columns east,north,up");
    let steps: Vec<Vec<f64>> = (1..3)
        .map(|j| metres[j].iter().zip(&metres[j - 1]).map(|(a, b)| a - b).collect())
        .collect();
    // A thousandth of a degree of latitude is 111 m; of longitude at 46 degrees, 77 m.
    assert!((steps[0][1] - 111.2).abs() < 0.5 && steps[0][0].abs() < 0.1, "{steps:?}");
    assert!((steps[1][0] - 77.3).abs() < 0.5 && steps[1][1].abs() < 0.1, "{steps:?}");
    assert!((steps[0][2] - 50.0).abs() < 1e-9 && (steps[1][2] + 30.0).abs() < 1e-9, "{steps:?}");
}

#[test]
fn a_broken_gpx_is_refused_with_its_line() {
    let wrong = TRACK.replace("lat=\"46.001\" lon=\"13\"", "lat=\"96.001\" lon=\"13\"");
    refused("a.gpx", wrong.replace("><trkpt", ">\n<trkpt"), "", &["line 3", "lat", "96.001"]);
    refused("a.gpx", TRACK.replace("</trk>", ""), "", &["line 1", "XML"]);
    refused("a.gpx", "<gpx></gpx>", "", &["no points"]);
    let entities = "<!DOCTYPE gpx [<!ENTITY a \"aaaa\">]><gpx><trk><name>&a;</name></trk></gpx>";
    refused("a.gpx", entities, "", &["XML"]);
}

#[test]
fn a_numpy_array_is_read_in_either_order() {
    assert_eq!(read("a.npy", npy(&EXPECTED, false), ""), expected());
    assert_eq!(read("a.npy", npy(&EXPECTED, true), ""), expected());
    let cut = npy(&EXPECTED, false);
    refused("a.npy", &cut[..cut.len() - 3], "", &["array"]);
    refused("a.npy", &cut[..9], "", &["header"]);
    let mut infinite = EXPECTED;
    infinite[1][0] = f64::INFINITY;
    refused(
        "a.npy",
        npy(&infinite, false),
        "",
        &["point 1 (counted from 0)", "column 1", "finite"],
    );
}

#[test]
fn an_abscissa_column_is_the_parameter() {
    let place = Place::with("a.csv", "t,v\n-1,3\n0,1\n2,4\n3,4.5\n7,0\n");
    let document = place.fit("a.csv --abscissa t");
    assert_eq!(numbers(&document["parameters"]), [-1.0, 0.0, 2.0, 3.0, 7.0]);
    assert_eq!(
        (&document["geometry"]["dimension"], &document["report"]["dimension"]),
        (&Value::from(1), &Value::from(1))
    );
    let shuffled = "t,v\n3,4.5\n-1,3\n7,0\n0,1\n2,4\n";
    refused("a.csv", shuffled, "--abscissa t", &["line 3", "--sort"]);
    place.write("b.csv", shuffled);
    assert_eq!(place.fit("b.csv --abscissa t --sort")["geometry"], document["geometry"]);
    refused("a.csv", shuffled, "--abscissa 7", &["no column 7"]);
}

#[test]
fn a_closed_curve_over_an_abscissa_needs_its_period() {
    let content = "t,v\n0,1\n1,3\n2,0\n4,-1\n5,0.5\n";
    let place = Place::with("a.csv", content);
    let ran = place.run("curve a.csv --abscissa t --closed --period 5 -o a.json").code(2);
    ran.says(&["--period 5", "too short", "from 0 to 5"]);
    place.run("curve a.csv --abscissa t --closed").code(2).says(&["--period"]);
    let given = place.fit("a.csv --abscissa t --closed --period 6");
    place.write("b.csv", format!("{content}6,1\n"));
    assert_eq!(given["geometry"], place.fit("b.csv --abscissa t --closed")["geometry"]);
}

#[test]
fn text_that_is_no_table_is_refused_where_it_breaks() {
    refused("a.csv", "", "", &["empty"]);
    refused("a.csv", "\n\n# nothing\n", "", &["no points"]);
    refused("a.csv", "x,y\n", "", &["no points", "header"]);
    refused("a.csv", "x,y\n1,2\n3\n4,5\n6,7\n", "", &["line 3", "1 cell", "2"]);
    refused("a.csv", "x,y\n1,2\n3,4,5\n4,5\n6,7\n", "", &["line 3", "3 cells"]);
    refused("a.csv", "x,y\n1,2\n3,four\n", "", &["line 3", "column 2", "\"y\"", "\"four\""]);
    refused("a.csv", "x,y\n1,2\n3,\n5,6\n", "", &["line 3", "column 2", "empty"]);
    refused("a.csv", "x,y\n1,2\n\"3,4\n", "", &["line 3", "quotation mark"]);
    refused("a.csv", b"1,2\n3,\xe9\n", "", &["line 2", "0xe9", "UTF-8"]);
    refused("a.csv", b"\xff\xfe1\x00,\x002\x00", "", &["UTF-16"]);
    refused("a.csv", b"1,2\n3,4\x00\n", "", &["binary"]);
    refused("a.csv", b"\x89PNG\r\n\x1a\n\x00\x00", "", &["text"]);
}

#[test]
fn a_missing_file_and_a_folder_are_named() {
    let place = Place::new();
    place.run("curve none.csv -o a.json").code(2).says(&["none.csv", "no such file"]);
    place.run("curve . -o a.json").code(2).says(&["cannot be read"]);
    assert!(place.names().is_empty());
}

#[test]
fn documents_that_are_none_are_refused_with_the_place() {
    for (content, parts) in [
        ("{", &["line 1", "column 1"][..]),
        ("{}", &["no gimfit document"]),
        ("{\"format\":\"other\",\"version\":1}", &["other"]),
        ("{\"format\":\"gimfit\",\"version\":2}", &["version", "2"]),
        ("{\"format\":\"gimfit\",\"version\":1}", &["no curve"]),
    ] {
        let place = Place::with("a.json", content);
        place.run("evaluate a.json --samples 3").code(2).says(&["a.json"]).says(parts);
    }
}

#[test]
fn documents_with_broken_geometry_are_refused_not_evaluated() {
    let place = Place::with("wave.csv", wave(8));
    let sound = place.fit("wave.csv");
    let broken = |change: &dyn Fn(&mut Value)| {
        let mut document = sound.clone();
        change(&mut document["geometry"]);
        place.write("a.json", document.to_string());
        for line in ["evaluate a.json --samples 3", "info a.json"] {
            place.run(line).code(2).says(&["a.json"]);
        }
    };
    broken(&|geometry| geometry["degree"] = 4.into());
    broken(&|geometry| geometry["degree"] = 1_000_000.into());
    broken(&|geometry| geometry["degree"] = 0.into());
    broken(&|geometry| geometry["degree"] = (-3).into());
    broken(&|geometry| geometry["dimension"] = 3.into());
    broken(&|geometry| geometry["periodic"] = true.into());
    broken(&|geometry| geometry["knots"][5] = 2.0.into());
    broken(&|geometry| geometry["knots"][5] = Value::Null);
    broken(&|geometry| geometry["knots"] = serde_json::json!([]));
    broken(&|geometry| geometry["control_points"] = serde_json::json!([]));
    broken(&|geometry| geometry["control_points"][2] = serde_json::json!([1.0]));
    broken(&|geometry| geometry["control_points"][2][0] = "x".into());
}

#[test]
fn the_text_of_a_table_written_is_read_again() {
    let place = Place::with("wave.csv", wave(9));
    place.run("curve wave.csv -o fit.csv -q --samples 20").code(0);
    let rows = table(place.read("fit.csv").split_once('\n').unwrap().1);
    let again = place.fit("fit.csv --columns 2,3 --degree 1 --parameters uniform");
    let expected: Vec<Vec<f64>> = rows.iter().map(|row| row[1..].to_vec()).collect();
    assert_eq!(points(&again["geometry"]["control_points"]), expected);
}
