//! Every kind of output, read back: documents evaluate to the data, tables hold what the document
//! holds, pictures are well-formed.

#![allow(clippy::unwrap_used, clippy::panic)] // A test that cannot go on has failed.

mod common;

use common::{
    Place, all_finite, de_boor, largest_distance, numbers, points, table, testdata, wave,
};
use serde_json::Value;
use std::fmt::Write;

/// Points on a closed flower, not repeating the first.
fn flower(count: usize) -> String {
    (0..count)
        .map(|i| {
            let a = std::f64::consts::TAU * i as f64 / count as f64;
            let radius = 2.0 + (3.0 * a).cos();
            format!("{:?},{:?}\n", radius * a.cos(), radius * a.sin())
        })
        .collect()
}

/// Values of the document at its own parameters, from the program.
fn evaluated(place: &Place, document: &Value) -> Vec<Vec<f64>> {
    place.write("fit.json", document.to_string());
    let list: String =
        numbers(&document["parameters"]).iter().map(|t| format!("{t:?}\n")).collect();
    place.write("at.txt", list);
    let out = place.run("evaluate fit.json --at at.txt").code(0).out;
    table(out.split_once('\n').unwrap().1).into_iter().map(|row| row[1..].to_vec()).collect()
}

#[test]
fn a_document_at_its_own_parameters_gives_the_data_back() {
    for degree in 1..=9 {
        let place = Place::with("wave.csv", wave(25));
        let document = place.fit(&format!("wave.csv --degree {degree}"));
        all_finite(&document);
        let data = table(&wave(25));
        assert!(largest_distance(&evaluated(&place, &document), &data) < 1e-11, "degree {degree}");
        let by_recursion: Vec<Vec<f64>> = numbers(&document["parameters"])
            .iter()
            .map(|&t| de_boor(&document["geometry"], t))
            .collect();
        assert!(largest_distance(&by_recursion, &data) < 1e-11, "degree {degree}");
    }
}

#[test]
fn every_parameterization_and_knot_rule_gives_the_data_back() {
    let place = Place::with("wave.csv", wave(20));
    let data = table(&wave(20));
    for parameters in ["chord", "centripetal", "uniform"] {
        for knots in ["averaged", "not-a-knot", "at-data", "uniform"] {
            let document =
                place.fit(&format!("wave.csv --parameters {parameters} --knots {knots}"));
            assert_eq!(document["report"]["parameterization"], parameters);
            assert_eq!(document["report"]["knot_placement"], knots);
            let distance = largest_distance(&evaluated(&place, &document), &data);
            assert!(distance < 1e-11, "{parameters}, {knots}: {distance}");
        }
    }
}

#[test]
fn every_method_reaches_the_same_curve() {
    let place = Place::with("wave.csv", wave(20));
    let expected = points(&place.fit("wave.csv")["geometry"]["control_points"]);
    for method in
        ["pia", "weighted", "jacobi", "gauss-seidel", "sor", "chebyshev", "preconditioned"]
    {
        let document = place.fit(&format!("wave.csv --method {method}"));
        assert_eq!(document["report"]["method"], method);
        let control = points(&document["geometry"]["control_points"]);
        assert!(largest_distance(&control, &expected) < 1e-9, "{method}");
    }
}

#[test]
fn geometric_interpolation_tells_how_its_foot_points_fared() {
    let place = Place::with("wave.csv", wave(20));
    let document = place.fit("wave.csv --method geometric --keep 0,2");
    let report = &document["report"];
    assert_eq!(report["method"], "geometric");
    assert!(report["foot_points"]["largest_move"].as_f64().unwrap() > 0.0);
    assert!(report["foot_points"]["fall_back"].is_null());
    // Residuals are distances from the curve, up to rounding of coordinates.
    let length = |key: &str| report[key].as_f64().unwrap();
    let gap = length("max_residual") - length("max_deviation");
    assert!((0.0..1e-14 * length("extent")).contains(&gap), "{gap:e}");
    assert!(report["smallest_eigenvalue"].as_f64().unwrap() > 0.1);
    assert_eq!(document["sequence"].as_array().unwrap().len(), 2);
    // Points that hop to and fro have foot points beyond each other.
    place.write("hops.csv", "x,y\n2,9\n1,4\n1,7\n7,7\n6,3\n1,7\n0,6\n6,9\n");
    let fall_back = &place.fit("hops.csv --method geometric")["report"]["foot_points"]["fall_back"];
    assert_eq!(fall_back["condition"], "order");
    assert!(fall_back["reason"].as_str().unwrap().contains("lost their order"));
}

/// Once the file of every step told the parameters and residuals of the last.
#[test]
fn files_of_a_family_of_geometric_interpolation_hold_the_foot_points_of_their_step() {
    let place = Place::with("wave.csv", wave(20));
    let line = "curve wave.csv --method geometric --keep 0,2";
    place.run(&format!("{line} -o k-{{k}}.json -o whole.json")).code(0);
    let whole = place.document("whole.json");
    let mut seen = Vec::new();
    for (k, kept) in [0, 2].into_iter().zip(whole["sequence"].as_array().unwrap()) {
        let member = place.document(&format!("k-{k}.json"));
        assert_eq!(kept["parameters"], member["parameters"]);
        let residual = |value: &Value| value["max_residual"].as_f64().unwrap();
        let gap = residual(kept) - residual(&member["report"]);
        assert!(gap.abs() < 1e-12 * residual(kept), "{gap:e}");
        seen.push(member["report"]["foot_points"]["largest_move"].as_f64().unwrap());
    }
    assert!(seen[0] != seen[1], "{seen:?}");
}

#[test]
fn the_least_eigenvalue_of_geometric_interpolation_is_an_option() {
    let place = Place::with("wave.csv", wave(9));
    let fit = |rest: &str| place.fit(&format!("wave.csv {rest} --iterations 5 --residual 0"));
    let fell = |document: &Value| !document["report"]["foot_points"]["fall_back"].is_null();
    let line = "--method geometric --least-eigenvalue";
    assert!(fell(&fit(&format!("{line} 0.9"))));
    assert!(!fell(&fit(&format!("{line} 1e-9"))));
    for (rest, what) in [
        ("--method pia --least-eigenvalue 0.1", "belongs to --method geometric"),
        ("--method geometric --least-eigenvalue 1", "between 0 and 1"),
        ("--method geometric --least-eigenvalue nan", "--least-eigenvalue"),
        ("--method geometric --basis bernstein", "--knots bezier"),
    ] {
        place.run(&format!("curve wave.csv {rest}")).code(2).says(&[what]);
    }
}

#[test]
fn weights_given_per_point_act_like_the_same_weight_given_once() {
    let place = Place::with("wave.csv", wave(12));
    place.write("weights.txt", "1.1\n".repeat(12));
    let line = "wave.csv --method weighted --residual 0 --iterations 9 --weight";
    let once = place.fit(&format!("{line} 1.1"));
    let each = place.fit(&format!("{line} weights.txt"));
    let control = |document: &Value| points(&document["geometry"]["control_points"]);
    assert!(largest_distance(&control(&once), &control(&each)) < 1e-14);
}

#[test]
fn knots_and_parameters_of_a_document_give_the_document_again() {
    let place = Place::with("wave.csv", wave(15));
    let first = place.fit("wave.csv --knots not-a-knot --parameters centripetal");
    let list = |value: &Value| {
        numbers(value).iter().fold(String::new(), |mut text, x| {
            writeln!(text, "{x:?}").unwrap();
            text
        })
    };
    place.write("knots.txt", list(&first["geometry"]["knots"]));
    place.write("parameters.txt", list(&first["parameters"]));
    let again = place.fit("wave.csv --knots knots.txt --parameters parameters.txt");
    assert_eq!(again["geometry"], first["geometry"]);
    assert_eq!(again["parameters"], first["parameters"]);
}

#[test]
fn the_document_has_the_promised_shape() {
    let place = Place::with("wave.csv", format!("x,y\n{}", wave(12)));
    let document = place.fit("wave.csv --method pia");
    let geometry = &document["geometry"];
    assert_eq!(
        (document["format"].as_str(), document["version"].as_u64()),
        (Some("gimfit"), Some(1))
    );
    assert_eq!(
        (geometry["type"].as_str(), geometry["periodic"].as_bool()),
        (Some("curve"), Some(false))
    );
    assert_eq!((geometry["degree"].as_u64(), geometry["dimension"].as_u64()), (Some(3), Some(2)));
    assert!(geometry["weights"].is_null() && geometry.get("weights").is_some());
    assert_eq!(numbers(&geometry["knots"]).len(), 12 + 3 + 1);
    assert_eq!(numbers(&document["parameters"]).len(), 12);
    let report = &document["report"];
    assert_eq!(
        (report["points"].as_u64(), report["control_points"].as_u64()),
        (Some(12), Some(12))
    );
    assert_eq!(
        (report["parameterization"].as_str(), report["method"].as_str()),
        (Some("chord"), Some("pia"))
    );
    for name in ["read", "fit", "write"] {
        assert!(report["seconds"][name].as_f64().unwrap() >= 0.0, "{name}");
    }
    let history = report["history"].as_array().unwrap();
    assert_eq!(history.len() as u64, report["iterations"].as_u64().unwrap() + 1);
    let last = &history[history.len() - 1];
    assert_eq!(
        (&last["iteration"], &last["max_residual"]),
        (&report["iterations"], &report["max_residual"])
    );
    let index = report["max_residual_index"].as_u64().unwrap() as usize;
    let data = table(&wave(12));
    let there = de_boor(geometry, numbers(&document["parameters"])[index]);
    let residual = largest_distance(&[there], &[data[index].clone()]);
    assert!((residual - report["max_residual"].as_f64().unwrap()).abs() < 1e-14);
}

#[test]
fn a_periodic_document_means_what_it_promises_to_any_evaluator() {
    for (degree, count) in [(1, 12), (2, 13), (3, 12), (4, 13), (5, 12), (7, 20)] {
        let place = Place::with("flower.csv", flower(count));
        let document = place.fit(&format!("flower.csv --closed --degree {degree}"));
        all_finite(&document);
        let geometry = &document["geometry"];
        let (knots, control) = (numbers(&geometry["knots"]), points(&geometry["control_points"]));
        assert_eq!((geometry["periodic"].as_bool(), control.len()), (Some(true), count + degree));
        assert_eq!(knots.len(), control.len() + degree + 1);
        assert_eq!(control[..degree], control[count..], "the last control points repeat the first");
        let (start, end) = (knots[degree], knots[knots.len() - 1 - degree]);
        for k in 0..=2 * degree {
            let shift = knots[k + count] - knots[k] - (end - start);
            assert!(shift.abs() < 1e-12, "the knots repeat after a period");
        }
        let parameters = numbers(&document["parameters"]);
        assert!(parameters.iter().all(|t| (start..=end).contains(t)));
        let on_curve: Vec<_> = parameters.iter().map(|&t| de_boor(geometry, t)).collect();
        assert!(largest_distance(&on_curve, &table(&flower(count))) < 1e-11, "degree {degree}");
        let seam = [de_boor(geometry, start), de_boor(geometry, end)];
        assert!(largest_distance(&seam[..1], &seam[1..]) < 1e-11, "the curve closes");
        assert!(largest_distance(&evaluated(&place, &document), &on_curve) < 1e-12);
    }
}

#[test]
fn the_closing_point_may_be_repeated_or_not() {
    let open = Place::with("flower.csv", flower(14));
    let first = flower(14).lines().next().unwrap().to_owned();
    let closed = Place::with("flower.csv", format!("{}{first}\n", flower(14)));
    let (a, b) = (open.fit("flower.csv --closed"), closed.fit("flower.csv --closed"));
    assert_eq!(a["geometry"], b["geometry"]);
}

#[test]
fn numbers_of_a_document_are_read_back_exactly() {
    let place = Place::with("wave.csv", wave(30));
    place.run("curve wave.csv -o fit.json -o fit.csv -q").code(0);
    let document = place.document("fit.json");
    let control = points(&document["geometry"]["control_points"]);
    assert_eq!(table(place.read("fit.csv").split_once('\n').unwrap().1), control);
    let again: Value = serde_json::from_str(&document.to_string()).unwrap();
    assert_eq!(again, document);
}

#[test]
fn kept_fits_are_those_of_runs_that_stop_there() {
    let place = Place::with("wave.csv", wave(25));
    let document = place.fit("wave.csv --method pia --keep 15,0,2,4");
    let sequence = document["sequence"].as_array().unwrap();
    let kept: Vec<u64> = sequence.iter().map(|fit| fit["iteration"].as_u64().unwrap()).collect();
    assert_eq!(kept, [0, 2, 4, 15]);
    for (fit, iteration) in sequence.iter().zip(kept) {
        let line = format!("wave.csv --method pia --residual 0 --iterations {iteration}");
        let stopped = place.fit(&line);
        assert_eq!(fit["control_points"], stopped["geometry"]["control_points"]);
        assert_eq!(fit["max_residual"], stopped["report"]["max_residual"]);
    }
    assert_eq!(points(&sequence[0]["control_points"]), table(&wave(25)), "PIA starts at the data");
    place.write("fit.json", document.to_string());
    let out = place.run("evaluate fit.json --samples 2 --iteration 4").code(0).out;
    assert!(out.lines().nth(1).unwrap().starts_with("0.0,"));
    place.run("evaluate fit.json --samples 2 --iteration 5").code(2).says(&["0, 2, 4, 15"]);
}

#[test]
fn samples_are_points_of_the_curve_and_derivatives_its_slopes() {
    let place = Place::with("wave.csv", format!("x,y\n{}", wave(25)));
    place.run("curve wave.csv -o fit.json -o fit.csv --samples 9 -q").code(0);
    let geometry = &place.document("fit.json")["geometry"];
    let evaluated = place.run("evaluate fit.json --samples 9 --derivatives 2").code(0).out;
    let (header, rows) = evaluated.split_once('\n').unwrap();
    assert_eq!(header, "t,x,y,d1 x,d1 y,d2 x,d2 y");
    let samples = place.read("fit.csv");
    assert!(samples.starts_with("t,x,y\n"));
    let samples = table(samples.split_once('\n').unwrap().1);
    for (row, sample) in table(rows).iter().zip(&samples) {
        assert_eq!(row[..3], sample[..]);
        assert!(largest_distance(&[de_boor(geometry, row[0])], &[row[1..3].to_vec()]) < 1e-12);
        let h = 1e-6;
        if row[0] > h && row[0] < 1.0 - h {
            let (before, after) = (de_boor(geometry, row[0] - h), de_boor(geometry, row[0] + h));
            for c in 0..2 {
                let slope = (after[c] - before[c]) / (2.0 * h);
                assert!((slope - row[3 + c]).abs() < 1e-6 * (1.0 + slope.abs()), "{row:?}");
            }
        }
    }
}

#[test]
fn evaluate_writes_json_with_the_numbers_of_its_csv() {
    let place = Place::with("wave.csv", wave(12));
    place.run("curve wave.csv -o fit.json -q").code(0);
    place.run("evaluate fit.json --samples 4 --derivatives 1 -o s.json").code(0);
    place.run("evaluate fit.json --samples 4 --derivatives 1 -o s.csv").code(0);
    let rows = table(place.read("s.csv").split_once('\n').unwrap().1);
    let document = place.document("s.json");
    for (sample, row) in document["samples"].as_array().unwrap().iter().zip(&rows) {
        assert_eq!(sample["parameter"].as_f64().unwrap(), row[0]);
        assert_eq!(numbers(&sample["point"]), row[1..3]);
        assert_eq!(numbers(&sample["derivatives"][0]), row[3..5]);
    }
    assert_eq!(rows.len(), 4);
}

#[test]
fn parameters_outside_the_domain_are_refused_by_name() {
    let place = Place::with("wave.csv", wave(12));
    place.run("curve wave.csv -o fit.json -q").code(0);
    place.write("at.txt", "0.5\n1.5\n");
    place.run("evaluate fit.json --at at.txt -o s.csv").code(2).says(&["at.txt", "1.5", "[0, 1]"]);
    assert!(!place.holds("s.csv"));
}

#[test]
fn pictures_of_every_dimension_are_well_formed() {
    for dimension in 1..=8 {
        let row = |i: usize| {
            let cells: Vec<String> =
                (0..dimension).map(|c| format!("{:?}", ((i + 2 * c) as f64).sin())).collect();
            cells.join(",") + "\n"
        };
        let place = Place::with("p.csv", (0..12).map(row).collect::<String>());
        place.run("curve p.csv -o p.svg -q --method pia --keep 0,2 --residual 1e-6").code(0);
        let text = place.read("p.svg");
        let svg = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(svg.root_element().tag_name().name(), "svg");
        let words: String =
            svg.descendants().filter_map(|n| n.text()).map(str::trim).collect::<Vec<_>>().join(" ");
        for word in ["Error at each point", "Convergence", "control polygon", "fitted curve"] {
            assert!(words.contains(word), "dimension {dimension}: no {word:?}");
        }
        assert!(!text.contains("NaN") && !text.contains("\"inf"), "dimension {dimension}");
    }
}

#[test]
fn names_with_marks_of_xml_leave_a_picture_well_formed() {
    let place =
        Place::with("a&b<c>.dat", "W<i>NG & \"x\" ]]> é\n1 0\n0.5 0.1\n0 0\n0.5 -0.1\n0.9 0\n");
    place.run("curve a&b<c>.dat -o fit.svg -q").code(0);
    let text = place.read("fit.svg");
    let svg = roxmltree::Document::parse(&text).unwrap();
    assert!(
        svg.descendants().any(|node| node.text().is_some_and(|t| t.contains("W<i>NG & \"x\"")))
    );
}

#[test]
fn a_png_is_a_png_of_the_pictures_size() {
    let place = Place::with("wave.csv", wave(10));
    place.run("curve wave.csv -o fit.png -o fit.svg -q").code(0);
    let bytes = std::fs::read(place.path("fit.png")).unwrap();
    assert_eq!(bytes[..8], [0x89, b'P', b'N', b'G', 0x0d, 0x0a, 0x1a, 0x0a]);
    assert_eq!(bytes[bytes.len() - 8..bytes.len() - 4], *b"IEND");
    let side = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    let text = place.read("fit.svg");
    let svg = roxmltree::Document::parse(&text).unwrap();
    for (name, at) in [("width", 16), ("height", 20)] {
        let length: f64 = svg.root_element().attribute(name).unwrap().parse().unwrap();
        assert_eq!(f64::from(side(at)), 2.0 * length, "{name}");
    }
}

#[test]
fn a_report_tells_a_person_what_was_done() {
    let place = Place::with("wave.csv", format!("east,north\n{}", wave(12)));
    let text = place.run("curve wave.csv -o fit.json --report fit.txt").code(0).out;
    for part in [
        "wave.csv",
        "12 points",
        "east, north",
        "CSV",
        "degree 3",
        "chord",
        "averaged",
        "iteration",
        "largest",
        "rms",
        "at line",
        "deviation",
        "time",
        "fit.json",
    ] {
        assert!(text.contains(part), "no {part:?} in\n{text}");
    }
    assert_eq!(place.read("fit.txt"), text);
    place.run("curve wave.csv --report fit.json -q").code(0);
    let report = place.document("fit.json");
    assert!(report.get("geometry").is_none() && report["report"]["points"] == 12);
}

#[test]
fn a_file_that_cannot_be_written_is_an_error_and_the_old_ones_stay() {
    let place = Place::with("wave.csv", wave(12));
    std::fs::create_dir(place.path("folder.json")).unwrap();
    place.write("old.svg", "old");
    place.run("curve wave.csv -o folder.json -o old.svg").code(2).says(&["folder.json", "folder"]);
    place.run("curve wave.csv -o old.svg -o none/fit.json").code(2).says(&["none"]);
    place.run("curve wave.csv -o old.svg --report none/fit.txt").code(2).says(&["none"]);
    assert_eq!(place.read("old.svg"), "old");
    assert_eq!(place.names(), ["folder.json", "old.svg", "wave.csv"]);
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_and_permissions_are_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let place = Place::with("wave.csv", wave(12));
    place.write("real.json", "old");
    std::fs::set_permissions(place.path("real.json"), PermissionsExt::from_mode(0o640)).unwrap();
    symlink("real.json", place.path("link.json")).unwrap();
    place.run("curve wave.csv -o link.json -q").code(0);
    assert!(std::fs::symlink_metadata(place.path("link.json")).unwrap().is_symlink());
    assert_eq!(place.document("real.json")["format"], "gimfit");
    let mode = std::fs::metadata(place.path("real.json")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o640);
}

#[test]
fn info_tells_what_a_document_holds() {
    let place = Place::with("wave.csv", wave(12));
    place.run("curve wave.csv --method pia --keep 0,2 -o fit.json -q").code(0);
    let facts = place.run("info fit.json --json").code(0).json();
    let report = &place.document("fit.json")["report"];
    for (fact, value) in [("largest_residual", "max_residual"), ("iterations", "iterations")] {
        assert_eq!(facts[fact], report[value], "{fact}");
    }
    assert_eq!(facts["kept_iterations"], serde_json::json!([0, 2]));
}

#[test]
fn real_data_of_every_kind_are_fitted_and_drawn() {
    for (name, options) in [
        ("airfoils/naca2412.dat", ""),
        ("airfoils/rae2822.dat", "--closed"),
        ("gpx/Mojstrovka.gpx", "--parameters centripetal"),
        ("glyphs/DejaVuSans_S_points.csv", "--closed --degree 5"),
        ("mocap/WRIST.csv", "--knots not-a-knot"),
        ("signals/nist_Gauss1.csv", "--abscissa x --method pia --keep 0,2,4,15,30"),
    ] {
        let place = Place::new();
        std::fs::copy(testdata(name), place.path("data.dat")).unwrap();
        let extension = name.rsplit('.').next().unwrap();
        std::fs::rename(place.path("data.dat"), place.path(&format!("data.{extension}"))).unwrap();
        place.run(&format!("curve data.{extension} {options} -o fit.json -o fit.svg -q")).code(0);
        all_finite(&place.document("fit.json"));
        roxmltree::Document::parse(&place.read("fit.svg")).unwrap();
    }
}
