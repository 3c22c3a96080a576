//! Laws of the reader of matrices of heights.

use proptest::prelude::*;

use super::{GridFormat, GridFormatChoice, GridOptions, PointGrid, read_grid_from};

fn read_with(text: &str, options: &GridOptions) -> Result<PointGrid, String> {
    read_grid_from(text.as_bytes(), "f.csv", Some("csv"), options).map_err(|e| e.to_string())
}

fn read(text: &str) -> Result<PointGrid, String> {
    read_with(text, &GridOptions::default())
}

fn axes(axes: bool) -> GridOptions {
    GridOptions { axes: Some(axes), ..GridOptions::default() }
}

fn heights(grid: &PointGrid) -> Vec<f64> {
    grid.coordinates.chunks(3).map(|p| p[2]).collect()
}

#[test]
fn without_axes_the_indices_are_x_and_y() {
    let grid = read("1,2,3,4\n5,6,7,8\n").unwrap();
    assert_eq!((grid.rows, grid.columns, grid.format), (2, 4, GridFormat::Matrix));
    assert_eq!(grid.coordinates[12..18], [0.0, 1.0, 5.0, 1.0, 1.0, 6.0]);
    assert!(grid.row_abscissae.is_none() && grid.column_abscissae.is_none());
    assert_eq!(grid.point_name(1, 3), "row 2, column 4 (line 2)");
    assert!(grid.notes.iter().any(|n| n.contains("the index of the column")), "{:?}", grid.notes);
}

#[test]
fn an_empty_named_or_absent_corner_makes_axes() {
    for text in [
        ",10,20\n1,5,6\n2,7,8\n",
        "y/x,10,20,\n1,5,6,\n2,7,8,\n",
        "\"\";10;20\n1;5;6\n2;7;8\n",
        "10,20\n1,5,6\n2,7,8\n",
        "   10 20\n1 5 6\n2 7 8\n",
        "\t10\t20\n1\t5\t6\n2\t7\t8\n",
    ] {
        let grid = read(text).unwrap();
        assert_eq!(grid.column_abscissae, Some(vec![10.0, 20.0]), "{text}");
        assert_eq!(grid.row_abscissae, Some(vec![1.0, 2.0]), "{text}");
        assert_eq!(grid.coordinates[3..9], [20.0, 1.0, 6.0, 10.0, 2.0, 7.0], "{text}");
        assert_eq!(grid.point_name(0, 0), "row 1, column 1 (line 2)");
    }
}

#[test]
fn axes_follow_the_option() {
    let text = "0,10,20\n1,5,6\n2,7,8\n";
    let grid = read_with(text, &axes(true)).unwrap();
    assert_eq!((grid.rows, grid.columns), (2, 2));
    assert_eq!(grid.column_abscissae, Some(vec![10.0, 20.0]));
    let grid = read_with(text, &axes(false)).unwrap();
    assert_eq!((grid.rows, grid.columns), (3, 3));
    let grid = read_with("y,a,b\n1,5,6\n2,7,8\n", &axes(true)).unwrap();
    assert_eq!((grid.row_abscissae, grid.column_abscissae), (Some(vec![1.0, 2.0]), None));
    let matrix = GridOptions { format: Some(GridFormatChoice::Matrix), ..GridOptions::default() };
    let grid = read_with("a,b\n5,6\n7,8\n9,9\n", &matrix).unwrap();
    assert_eq!((grid.rows, grid.columns), (3, 2));
    assert!(grid.notes.iter().any(|n| n.contains("Line 1 holds names")), "{:?}", grid.notes);
    let error = read_with(",10\n1,5\n", &axes(false)).unwrap_err();
    assert!(error.starts_with("f.csv, line 1, column 1: 1 of 4 cells holds no data"), "{error}");
}

#[test]
fn holes_are_counted_and_the_first_is_named() {
    let error = read(",0,1,2\n0,5,6,7\n1,5,,nan\n2,NA,6,-\n").unwrap_err();
    assert_eq!(
        error,
        "f.csv, line 3, column 3: 4 of 9 cells hold no data (row 2, column 2; row 2, column 3; row \
         3, column 1; row 3, column 3); holes cannot be fitted yet: fill them in or cut out a part without them"
    );
    let error = read(",0,1\n,5,6\n1,5,6\n").unwrap_err();
    assert!(error.starts_with("f.csv"), "{error}");
    let error = read(",0,1\n0,5,6\n,5,6\n").unwrap_err();
    assert!(error.starts_with("f.csv, line 3, column 1: the cell is empty"), "{error}");
}

#[test]
fn ten_holes_are_named_and_the_rest_are_counted() {
    let error = read(&",,,,\n".repeat(3).replacen(",,,,", "1,2,3,4,5", 1)).unwrap_err();
    assert!(error.contains("10 of 15 cells"), "{error}");
    assert!(!error.contains("more"), "{error}");
    let error = read(&",,,,\n".repeat(4).replacen(",,,,", "1,2,3,4,5", 1)).unwrap_err();
    assert!(error.contains("15 of 20 cells"), "{error}");
    assert!(error.contains("row 3, column 5; and 5 more)"), "{error}");
}

#[test]
fn what_is_no_height_and_rows_of_other_lengths_are_refused() {
    for (text, words) in [
        ("1,2,3,4\n5,six,7,8\n", "line 2, column 2: \"six\" is not a number"),
        ("1,2,3,4\n5,inf,7,8\n", "inf is not a finite number"),
        ("1,2,3,4\n5,1e999,7,8\n", "too large"),
        ("1,2,3,4\n5,6,7\n", "line 2: there are 3 cells, but line 1 has 4"),
        (",1,2,3\n0,1,2\n", "there are 3 abscissae for 2 columns"),
        ("c,1,2,3\n0,1,2,3\n1,4,5,6,7\n", "line 3: there are 5 cells, but line 2 has 4"),
        ("1,2,3,4,\n5,6,7,8,9\n", "the cell is empty; line 2 has a value"),
        ("1,2,3,4\n5,6,7,8\n", "is asked for, but the matrix is 2x4"),
        ("# nothing\n", "every line is blank or a comment"),
    ] {
        let matrix = GridOptions {
            format: Some(GridFormatChoice::Matrix),
            shape: words.contains("asked").then_some((3, 4)),
            ..GridOptions::default()
        };
        let error = read_with(text, &matrix).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn decimal_commas_are_found_in_heights_and_in_axes() {
    let grid = read(";0,5;1\n0;5,25;6\n1,5;7;8\n").unwrap();
    assert_eq!(heights(&grid), [5.25, 6.0, 7.0, 8.0]);
    assert_eq!(grid.column_abscissae, Some(vec![0.5, 1.0]));
    assert!(grid.notes.iter().any(|n| n.contains("decimal mark")), "{:?}", grid.notes);
    let grid = read(";0,5;1\n0;5;6\n1;7;8\n").unwrap();
    assert_eq!(grid.column_abscissae, Some(vec![0.5, 1.0]));
    assert!(grid.notes.iter().any(|n| n.contains("decimal mark")), "{:?}", grid.notes);
    let error = read("1,234 2 3 4\n5 6 7 8\n").unwrap_err();
    assert!(error.contains("--decimal comma"), "{error}");
}

#[test]
fn coordinates_of_a_matrix_are_chosen_by_name() {
    let options = GridOptions { columns: Some(vec!["z".parse().unwrap()]), ..axes(false) };
    let grid = read_with("1,2,3,4\n5,6,7,8\n", &options).unwrap();
    assert_eq!(grid.coordinates, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
    let options = GridOptions { columns: Some(vec!["w".parse().unwrap()]), ..axes(false) };
    let error = read_with("1,2,3,4\n5,6,7,8\n", &options).unwrap_err();
    assert!(error.contains("the columns are x, y, z"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_finite_matrix_comes_back_bit_by_bit(
        (n, z) in (4..8_usize, 1..6_usize).prop_flat_map(|(n, m)| {
            (Just(n), prop::collection::vec(any::<f64>().prop_filter("", |v| v.is_finite()), n * m))
        })
    ) {
        let text: String = z
            .chunks(n)
            .map(|row| row.iter().map(|v| format!("{v:e}")).collect::<Vec<_>>().join(",") + "\n")
            .collect();
        let grid = read(&text).unwrap();
        let bits = |z: &[f64]| z.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        prop_assert_eq!(bits(&heights(&grid)), bits(&z));
    }
}
