use super::super::{GridFormat, GridLines, GridOptions, PointGrid, read_grid_from};

fn read(text: &str) -> Result<PointGrid, String> {
    read_grid_from(text.as_bytes(), "f.asc", Some("asc"), &GridOptions::default())
        .map_err(|e| e.to_string())
}

const HEAD: &str = "ncols 3\nNROWS 2\nxllcorner 100\nyllcorner 50\ncellsize 10\n";

#[test]
fn points_stand_at_the_centres_of_the_cells_from_north_to_south() {
    let grid = read(&format!("{HEAD}NODATA_value -9999\n 1 2 3\n 4 5 6\n")).unwrap();
    assert_eq!((grid.rows, grid.columns, grid.format), (2, 3, GridFormat::EsriAscii));
    assert_eq!(grid.column_abscissae, Some(vec![105.0, 115.0, 125.0]));
    assert_eq!(grid.row_abscissae, Some(vec![65.0, 55.0]));
    assert_eq!(grid.coordinates[6..12], [125.0, 65.0, 3.0, 105.0, 55.0, 4.0]);
    assert_eq!(grid.point_name(1, 0), "row 2, column 1 (line 8)");
    let text = "dx 2\ndy 4\nxllcenter 0\nyllcenter 0\nnrows 2\nncols 1\n5\n6\n";
    // A word that may name a column elsewhere does not open a grid by itself.
    assert!(read(text).is_err());
    let grid = read(&format!("nodata nan\n{text}")).unwrap();
    assert_eq!(grid.coordinates, [0.0, 4.0, 5.0, 0.0, 0.0, 6.0]);
}

#[test]
fn line_ends_among_the_heights_mean_nothing() {
    let grid = read(&format!("{HEAD}1 2\n3 4\n5 6\n")).unwrap();
    assert_eq!(grid.coordinates[15..], [125.0, 55.0, 6.0]);
    assert_eq!(grid.lines, GridLines::Unknown);
    let grid = read(&format!("{HEAD}1 2 3 4 5 6\n")).unwrap();
    assert_eq!(grid.lines, GridLines::Unknown);
}

#[test]
fn cells_without_data_are_counted_and_the_first_is_named() {
    let error = read(&format!("{HEAD}NODATA_value -9999\n1 2 3\n4 -9999.0 nan\n")).unwrap_err();
    assert!(
        error.starts_with("f.asc, line 8, column 2: 2 of 6 cells hold no data (row 2"),
        "{error}"
    );
}

#[test]
fn a_broken_header_or_count_is_refused_with_its_place() {
    for (text, words) in [
        (format!("{HEAD}1 2 3\n4 5\n"), "2 rows of 3 heights, but the file holds 5 heights"),
        (format!("{HEAD}1 2 3\n4 5 6\n7\n"), "line 8, column 1: more heights follow"),
        (format!("{HEAD}1 2 3\n4 x 6\n"), "line 7, column 2: \"x\" is not a number"),
        (format!("{HEAD}ncols 3\n1 2 3\n"), "stands on line 1 already"),
        (format!("{HEAD}colour 3\n1 2 3\n"), "\"colour\" is no word"),
        (format!("{HEAD}xllcenter 3\n1 2 3\n"), "both xllcorner and xllcenter"),
        (format!("{HEAD}NODATA_value\n1 2 3\n"), "takes one number"),
        (HEAD.to_owned(), "no heights follow"),
        ("ncols 3\nnrows 1\n1 2 3\n".to_owned(), "the header lacks cellsize or dx"),
        (HEAD.replace("cellsize 10", "cellsize 0") + "1\n", "not above 0"),
        (HEAD.replace("ncols 3", "ncols 2.5") + "1\n", "no whole number"),
        (HEAD.replace("ncols 3", "ncols 1e15") + "1\n", "the file holds 1 height"),
        (
            HEAD.replace("ncols 3", "ncols 9e15").replace("NROWS 2", "nrows 9e15") + "1\n",
            "the file holds 1 height",
        ),
        (HEAD.replace("cellsize 10", "cellsize 1e308") + "1\n", "beyond the range"),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn the_shape_asked_for_must_be_that_of_the_header() {
    let options = GridOptions { shape: Some((3, 2)), ..GridOptions::default() };
    let text = format!("{HEAD}1 2 3\n4 5 6\n");
    let error = read_grid_from(text.as_bytes(), "f", None, &options).unwrap_err().to_string();
    assert!(error.contains("the header gives 2x3"), "{error}");
}
