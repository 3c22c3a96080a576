use super::super::{GridLines, GridOptions, PointGrid, read_grid_from};

/// A file as numpy.save writes it.
fn file(fortran: bool, shape: &str, values: &[f64]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': '<f8', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let mut out = b"\x93NUMPY\x01\x00".to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.bytes());
    out.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    out
}

fn read(bytes: &[u8], shape: Option<(usize, usize)>) -> Result<PointGrid, String> {
    let options = GridOptions { shape, ..GridOptions::default() };
    read_grid_from(bytes, "a.npy", Some("npy"), &options).map_err(|e| e.to_string())
}

fn count(n: usize) -> Vec<f64> {
    (0..n).map(|at| at as f64).collect()
}

#[test]
fn two_axes_are_heights_over_the_indices_in_both_orders() {
    let grid = read(&file(false, "(2, 4)", &count(8)), None).unwrap();
    assert_eq!((grid.rows, grid.columns, grid.dimension()), (2, 4, 3));
    assert_eq!(grid.coordinates[12..18], [0.0, 1.0, 4.0, 1.0, 1.0, 5.0]);
    assert_eq!(grid.lines, GridLines::Binary);
    let grid = read(&file(true, "(2, 4)", &count(8)), None).unwrap();
    assert_eq!(grid.coordinates[12..18], [0.0, 1.0, 1.0, 1.0, 1.0, 3.0]);
}

#[test]
fn three_axes_are_points_in_both_orders() {
    let grid = read(&file(false, "(2, 3, 2)", &count(12)), None).unwrap();
    assert_eq!((grid.rows, grid.columns, grid.dimension()), (2, 3, 2));
    assert_eq!(grid.coordinates, count(12));
    let grid = read(&file(true, "(2, 3, 2)", &count(12)), None).unwrap();
    let expected: Vec<f64> = (0..12)
        .map(|at| {
            let (i, j, k) = (at / 6, at / 2 % 3, at % 2);
            (i + 2 * (j + 3 * k)) as f64
        })
        .collect();
    assert_eq!(grid.coordinates, expected);
}

#[test]
fn a_list_of_points_takes_the_shape_asked_for() {
    let bytes = file(false, "(6, 2)", &count(12));
    let error = read(&bytes, None).unwrap_err();
    assert!(error.contains("--shape 6x2 means heights"), "{error}");
    let grid = read(&bytes, Some((2, 3))).unwrap();
    assert_eq!((grid.rows, grid.columns, grid.dimension()), (2, 3, 2));
    assert_eq!(grid.coordinates, count(12));
    let grid = read(&bytes, Some((6, 2))).unwrap();
    assert_eq!((grid.rows, grid.columns, grid.dimension()), (6, 2, 3));
    let fortran = read(&file(true, "(4, 2)", &count(8)), Some((2, 2))).unwrap();
    assert_eq!(fortran.coordinates, [0.0, 4.0, 1.0, 5.0, 2.0, 6.0, 3.0, 7.0]);
    assert!(read(&bytes, Some((5, 2))).unwrap_err().contains("5x2 is asked for"));
}

#[test]
fn other_shapes_are_refused_with_a_way_out() {
    for shape in ["()", "(3,)", "(1, 2, 3, 4)", "(0, 4)", "(4, 0, 2)", "(1, 1, 99999)"] {
        let error = read(&file(false, shape, &[]), None).unwrap_err();
        assert!(error.contains("save heights with shape (m, n)"), "{error}");
    }
    for shape in ["(4294967296, 4294967296, 2)", "(2, 9)"] {
        assert!(read(&file(false, shape, &[1.0]), None).is_err());
    }
}

#[test]
fn values_that_are_not_finite_are_counted_and_named() {
    let mut values = count(16);
    (values[6], values[9]) = (f64::NAN, f64::NAN);
    let error = read(&file(false, "(4, 4)", &values), None).unwrap_err();
    assert!(error.contains("2 of 16 cells hold no data ([1, 2]; "), "{error}");
    let error = read(&file(false, "(2, 2, 4)", &values), None).unwrap_err();
    assert!(error.contains("2 of 4 cells hold no data ([0, 1, 2]; "), "{error}");
    values[3] = f64::INFINITY;
    let error = read(&file(false, "(4, 4)", &values), None).unwrap_err();
    assert!(error.contains("[0, 3] is inf"), "{error}");
}

#[test]
fn columns_follow_the_choice() {
    let options =
        GridOptions { columns: Some(vec!["2".parse().unwrap()]), ..GridOptions::default() };
    let mut values = count(8);
    values[0] = f64::NAN;
    let grid = read_grid_from(&file(false, "(2, 2, 2)", &values), "a", None, &options).unwrap();
    assert_eq!(grid.coordinates, [1.0, 3.0, 5.0, 7.0]);
}
