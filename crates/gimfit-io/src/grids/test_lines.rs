//! Laws of the reader of grids with one point per line.

use proptest::prelude::*;

use super::{GridFormat, GridFormatChoice, GridOptions, PointGrid, read_grid_from};

fn read_with(text: &str, options: &GridOptions) -> Result<PointGrid, String> {
    read_grid_from(text.as_bytes(), "f.csv", Some("csv"), options).map_err(|e| e.to_string())
}

fn read(text: &str) -> Result<PointGrid, String> {
    read_with(text, &GridOptions::default())
}

fn shaped(rows: usize, columns: usize) -> GridOptions {
    GridOptions { shape: Some((rows, columns)), ..GridOptions::default() }
}

#[test]
fn indices_place_the_points_in_any_order_of_lines() {
    for (header, base) in [("row,column", 1), ("i,j", 0), ("Row,Col", 0)] {
        let mut text = format!("{header},x,y,z\n");
        for (i, j) in [(1, 2), (0, 0), (1, 0), (0, 2), (0, 1), (1, 1)] {
            text += &format!("{},{},{i},{j},{}\n", i + base, j + base, 10 * i + j);
        }
        let grid = read(&text).unwrap();
        assert_eq!((grid.rows, grid.columns, grid.dimension()), (2, 3, 3));
        assert_eq!(grid.column_names, ["x", "y", "z"]);
        let z: Vec<f64> = grid.coordinates.chunks(3).map(|p| p[2]).collect();
        assert_eq!(z, [0.0, 1.0, 2.0, 10.0, 11.0, 12.0]);
        assert_eq!(grid.point_name(1, 2), "row 2, column 3 (line 2)");
        assert!(grid.row_abscissae.is_none() && grid.column_abscissae.is_none());
        assert_eq!(grid.format, GridFormat::Lines);
    }
}

#[test]
fn a_missing_and_a_doubled_point_are_named_as_the_file_counts() {
    let error = read("row,column,z\n1,1,0\n1,2,0\n2,1,0\n").unwrap_err();
    assert!(
        error.starts_with("f.csv: there is no line for row = 2, column = 2 (1 of the 4"),
        "{error}"
    );
    let error = read("i,j,z\n0,0,0\n0,1,0\n0,0,5\n").unwrap_err();
    assert!(
        error.starts_with("f.csv, line 4: the point i = 0, j = 0 stands on line 2 already"),
        "{error}"
    );
    let error = read("i,j,z\n0,0,0\n0,0,5\n").unwrap_err();
    assert!(error.contains("line 3: the point i = 0, j = 0"), "{error}");
}

#[test]
fn indices_that_are_none_are_refused() {
    for (cell, words) in [
        ("1.5", "line 3: i = 1.5 is not an index"),
        ("-1", "i = -1 is not an index"),
        ("1e300", "i = 1e300 is not an index"),
        ("9007199254740992", "make no grid"),
    ] {
        let error = read(&format!("i,j,z\n0,0,0\n{cell},0,0\n")).unwrap_err();
        assert!(error.contains(words), "{error}");
    }
    let error = read("i,j,z\n5,0,0\n6,0,0\n").unwrap_err();
    assert!(error.contains("the indices i start at 5"), "{error}");
}

#[test]
fn parameters_make_the_grid_and_become_its_abscissae() {
    let of = |order: &[(f64, f64)]| {
        let lines = order.iter().map(|(u, v)| format!("{u},{v},{},{}\n", u + 10.0, v * 2.0));
        read(&format!("u,v,x,y\n{}", lines.collect::<String>())).unwrap()
    };
    let v_fast = of(&[(0.0, 0.0), (0.0, 0.5), (0.0, 1.0), (0.3, 0.0), (0.3, 0.5), (0.3, 1.0)]);
    let u_fast = of(&[(0.0, 0.0), (0.3, 0.0), (0.0, 0.5), (0.3, 0.5), (0.0, 1.0), (0.3, 1.0)]);
    assert_eq!(v_fast.coordinates, u_fast.coordinates);
    assert_eq!(v_fast.coordinates[..6], [10.0, 0.0, 10.0, 1.0, 10.0, 2.0]);
    assert_eq!(u_fast.row_abscissae, Some(vec![0.0, 0.3]));
    assert_eq!(u_fast.column_abscissae, Some(vec![0.0, 0.5, 1.0]));
    assert_eq!(u_fast.point_name(1, 0), "row 2, column 1 (line 3)");
    let falling = of(&[(1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (0.0, 1.0)]);
    assert_eq!(falling.row_abscissae, Some(vec![1.0, 0.0]));
    let zeros = of(&[(0.0, 0.0), (-0.0, 1.0), (1.0, -0.0), (1.0, 1.0)]);
    assert_eq!((zeros.rows, zeros.columns), (2, 2));
}

#[test]
fn parameters_that_vary_along_a_row_make_no_grid() {
    let mut text = "u,v,x\n".to_owned();
    for at in 0..12 {
        text += &format!("{at},{at},0\n");
    }
    let error = read(&text).unwrap_err();
    assert!(error.contains("u has 12 values and v has 12"), "{error}");
}

#[test]
fn without_indices_the_shape_parts_the_lines_and_must_fit() {
    let text = "a,b\n1,2\n3,4\n5,6\n7,8\n9,10\n11,12\n";
    let grid = read_with(text, &shaped(3, 2)).unwrap();
    assert_eq!((grid.rows, grid.columns), (3, 2));
    assert_eq!(grid.coordinates[2..6], [3.0, 4.0, 5.0, 6.0]);
    assert_eq!(grid.point_name(2, 1), "row 3, column 2 (line 7)");
    let error = read_with(text, &shaped(4, 2)).unwrap_err();
    assert!(error.contains("takes 8 points, but the file holds 6"), "{error}");
    assert!(read_with(text, &shaped(usize::MAX, usize::MAX)).is_err());
    let error = read(text).unwrap_err();
    assert!(error.contains("each of the 6 points") && error.contains("--shape"), "{error}");
    let bare = "1 2 3\n4 5 6\n7 8 9\n0 1 2\n";
    assert!(read(bare).unwrap_err().contains("--shape 4x3"));
    assert_eq!(read_with(bare, &shaped(2, 2)).unwrap().dimension(), 3);
    assert_eq!(read_with(bare, &shaped(4, 3)).unwrap().format, GridFormat::Matrix);
    let error = read_with("u,v,x\n0,0,1\n0,1,1\n", &shaped(2, 1)).unwrap_err();
    assert!(error.contains("make a grid of 1x2"), "{error}");
}

#[test]
fn columns_and_indices_follow_the_choice() {
    let text = "s,j,p,q\n1,1,5,6\n1,2,7,8\n";
    let asked = GridOptions {
        index_columns: Some(("S".parse().unwrap(), "2".parse().unwrap())),
        columns: Some(vec!["q".parse().unwrap(), "j".parse().unwrap()]),
        ..GridOptions::default()
    };
    let grid = read_with(text, &asked).unwrap();
    assert_eq!(grid.coordinates, [6.0, 1.0, 8.0, 2.0]);
    assert_eq!(grid.column_names, ["q", "j"]);
    assert!(grid.row_abscissae.is_none());
    let asked = GridOptions { columns: None, ..asked };
    assert_eq!(read_with(text, &asked).unwrap().column_names, ["p", "q"]);
    let grid = read("i,x,j,label,y\n0,1,0,a,2\n").unwrap();
    assert_eq!(grid.notes[0], "The coordinates are x, y; left out: label.");
    let real = read_with("s,j,p\n0.5,1,5\n0.5,2,7\n", &asked).unwrap();
    assert_eq!(real.row_abscissae, Some(vec![0.5]));
    let lines = GridOptions { format: Some(GridFormatChoice::Lines), ..shaped(1, 2) };
    assert_eq!(read_with("1,2,3,4\n5,6,7,8\n", &lines).unwrap().dimension(), 4);
    let error = read("u,v\n0,0\n0,1\n").unwrap_err();
    assert!(error.contains("no column is left"), "{error}");
}

#[test]
fn a_point_without_a_value_is_named() {
    for cell in ["", "n/a", "NaN"] {
        let error = read(&format!("i,j,x\n0,0,1\n0,1,{cell}\n")).unwrap_err();
        assert!(error.starts_with("f.csv, line 3, column 3 (\"x\"): "), "{error}");
        assert!(error.contains("a grid needs every point"), "{error}");
    }
}

#[test]
fn decimal_commas_and_blank_lines_are_read_as_in_lists_of_points() {
    let grid = read("u;v;z\n0;0;1,5\n0;0,5;2\n\n1;0;3\n1;0,5;4\n").unwrap();
    assert_eq!(grid.coordinates, [1.5, 2.0, 3.0, 4.0]);
    assert!(grid.notes.iter().any(|n| n.ends_with("are one grid.")), "{:?}", grid.notes);
    assert!(grid.notes.iter().any(|n| n.contains("decimal mark")), "{:?}", grid.notes);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_shuffle_of_the_lines_gives_the_same_grid(
        (m, n, order) in (1..6_usize, 1..6_usize).prop_flat_map(|(m, n)| {
            (Just(m), Just(n), Just((0..m * n).collect::<Vec<_>>()).prop_shuffle())
        })
    ) {
        let mut text = "i,j,z\n".to_owned();
        for at in order {
            text += &format!("{},{},{at}\n", at / n, at % n);
        }
        let grid = read(&text).unwrap();
        prop_assert_eq!((grid.rows, grid.columns), (m, n));
        prop_assert_eq!(grid.coordinates, (0..m * n).map(|at| at as f64).collect::<Vec<_>>());
    }
}
