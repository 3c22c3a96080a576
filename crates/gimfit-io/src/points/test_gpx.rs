use super::super::{PartChoice, PointFormat, PointTable, ReadError, ReadOptions, read_points_from};

fn read(text: &str, options: &ReadOptions) -> Result<PointTable, ReadError> {
    read_points_from(text.as_bytes(), "t.gpx", Some("gpx"), options)
}

fn with_columns(columns: &[&str]) -> ReadOptions {
    ReadOptions {
        columns: Some(columns.iter().map(|c| c.parse().unwrap()).collect()),
        ..ReadOptions::default()
    }
}

fn with_part(part: PartChoice) -> ReadOptions {
    ReadOptions { part: Some(part), ..ReadOptions::default() }
}

fn gpx(inner: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<gpx xmlns=\"http://www.topografix.com/GPX/1/1\">\n{inner}\n</gpx>"
    )
}

const ONE: &str = "<wpt lat='0' lon='0'/>\n<trk><name>Hill</name><trkseg/><trkseg>
<trkpt lat='45' lon='14.5'><ele>100</ele></trkpt>
<trkpt lat='45.001' lon='14.501'><ele>110.5</ele></trkpt>
</trkseg></trk>";
const TWO: &str = "<trk><trkseg><trkpt lat='1' lon='2'/></trkseg>
<trkseg><trkpt lat='3' lon='4'/><trkpt lat='5' lon='6'/></trkseg></trk>";

#[test]
fn a_track_gives_longitude_and_latitude() {
    let table = read(&gpx(ONE), &ReadOptions::default()).unwrap();
    assert_eq!(table.format, PointFormat::Gpx);
    assert_eq!(table.title.as_deref(), Some("Hill"));
    assert_eq!(table.column_names, ["lon", "lat"]);
    assert_eq!(table.coordinates, [14.5, 45.0, 14.501, 45.001]);
    assert_eq!(table.row_lines, Some(vec![5, 6]));
    for word in ["Waypoints", "Empty", "elevation"] {
        assert!(table.notes.iter().any(|n| n.contains(word)), "{word}");
    }
}

#[test]
fn the_elevation_and_the_plane_are_columns() {
    let table = read(&gpx(ONE), &with_columns(&["lon", "lat", "ele"])).unwrap();
    assert_eq!(table.coordinates, [14.5, 45.0, 100.0, 14.501, 45.001, 110.5]);
    let table = read(&gpx(ONE), &with_columns(&["east", "north", "up"])).unwrap();
    assert_eq!(table.coordinates[..3], [0.0, 0.0, 0.0]);
    let expected = [78.8468, 111.1318, 10.5];
    for (got, expected) in table.coordinates[3..].iter().zip(expected) {
        assert!((got - expected).abs() < 1e-3, "{got} {expected}");
    }
    assert!(table.notes.iter().any(|n| n.contains("WGS84")));
}

#[test]
fn a_missing_elevation_is_an_error_only_where_chosen() {
    let text = gpx(&ONE.replace("<ele>110.5</ele>", ""));
    assert!(read(&text, &ReadOptions::default()).is_ok());
    let error = read(&text, &with_columns(&["ele"])).unwrap_err().to_string();
    assert!(error.starts_with("t.gpx, line 6, column 3 (\"ele\")"), "{error}");
}

#[test]
fn several_segments_ask_for_a_choice() {
    let error = read(&gpx(TWO), &ReadOptions::default()).unwrap_err().to_string();
    assert!(
        error.contains("part 1 (1 point from line 3), part 2 (2 points from line 4)"),
        "{error}"
    );
    assert!(error.contains("--part all"), "{error}");
    let table = read(&gpx(TWO), &with_part(PartChoice::Number(2))).unwrap();
    assert_eq!(table.coordinates, [4.0, 3.0, 6.0, 5.0]);
    let table = read(&gpx(TWO), &with_part(PartChoice::All)).unwrap();
    assert_eq!(table.rows(), 3);
    assert!(read(&gpx(TWO), &with_part(PartChoice::Number(3))).is_err());
    assert!(read(&gpx(TWO), &with_part(PartChoice::Number(0))).is_err());
}

#[test]
fn a_route_is_read_where_there_is_no_track() {
    let route = "<rte><rtept lat='1' lon='2'/><rtept lat='3' lon='4'/></rte>";
    let table = read(&gpx(route), &ReadOptions::default()).unwrap();
    assert_eq!(table.rows(), 2);
    let table = read(&gpx(&format!("{route}{ONE}")), &ReadOptions::default()).unwrap();
    assert_eq!(table.coordinates[0], 14.5);
    assert!(table.notes.iter().any(|n| n.contains("Routes")));
}

#[test]
fn waypoints_alone_are_no_curve() {
    let error = read(&gpx("<wpt lat='1' lon='2'/>"), &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("no order along a curve"), "{error}");
    assert!(read(&gpx(""), &ReadOptions::default()).is_err());
}

#[test]
fn broken_files_and_points_are_named_by_line() {
    for (from, to, start) in [
        ("lat='45' ", "", "t.gpx, line 5: the point has no lat"),
        ("'45.001'", "'95'", "t.gpx, line 6, column 2 (\"lat\"): 95 is not between"),
        ("'45.001'", "'x'", "t.gpx, line 6, column 2 (\"lat\"): \"x\" is not a number"),
        ("</trkseg></trk>", "</trk>", "t.gpx, line 7: the XML is broken"),
    ] {
        let error = read(&gpx(&ONE.replacen(from, to, 1)), &ReadOptions::default()).unwrap_err();
        assert!(error.to_string().starts_with(start), "{error}");
    }
    let error = read("<kml></kml>", &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("kml, not gpx"), "{error}");
}

#[test]
fn a_jump_over_the_date_line_is_noted() {
    let text = gpx(
        "<trk><trkseg><trkpt lat='0' lon='179.9'/><trkpt lat='0' lon='-179.9'/></trkseg></trk>",
    );
    let table = read(&text, &ReadOptions::default()).unwrap();
    assert!(table.notes.iter().any(|n| n.contains("date line")), "{:?}", table.notes);
}
