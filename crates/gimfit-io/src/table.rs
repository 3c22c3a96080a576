//! CSV tables of control points and of samples.

use gimfit::{Curve, Surface};
use std::io::{self, Write};

/// Writes the stored control points, a row each, under the names of the coordinates.
///
/// # Errors
/// What the writer says.
pub fn write_control_points(
    out: &mut dyn Write,
    curve: &Curve,
    names: &[String],
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(coordinate_names(curve.dimension(), names)).map_err(io_error)?;
    for point in curve.control_points().iter() {
        table.write_record(point.iter().map(|x| format!("{x:?}"))).map_err(io_error)?;
    }
    table.flush()
}

/// Writes points and derivatives up to `order` at parameters, a row each: `t`, the coordinates,
/// then `d1 x`, `d1 y`, ..., `d2 x`, ...
///
/// # Errors
/// What the writer says; [`io::ErrorKind::InvalidInput`] for a parameter outside the domain.
pub fn write_samples(
    out: &mut dyn Write,
    curve: &Curve,
    parameters: &[f64],
    order: usize,
    names: &[String],
) -> io::Result<()> {
    let names = coordinate_names(curve.dimension(), names);
    let mut table = csv::Writer::from_writer(out);
    let derived = (1..=order).flat_map(|k| names.iter().map(move |name| format!("d{k} {name}")));
    table
        .write_record(std::iter::once("t".to_owned()).chain(names.clone()).chain(derived))
        .map_err(io_error)?;
    let mut values = vec![0.0; (order + 1) * curve.dimension()];
    for &t in parameters {
        curve
            .derivatives_into(t, order, &mut values)
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
        let row = std::iter::once(&t).chain(&values).map(|x| format!("{x:?}"));
        table.write_record(row).map_err(io_error)?;
    }
    table.flush()
}

/// Orders (a, b) of the partial derivatives up to order `order` in all, those of lower order first,
/// of one order those with more of u first.
pub fn partials(order: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..=order).flat_map(|k| (0..=k).map(move |b| (k - b, b)))
}

/// Writes points and all partial derivatives up to order `order` at pairs of parameters, a row each:
/// `u`, `v`, the coordinates, then `du x`, `du y`, ..., `dv x`, ..., `duu x`, `duv x`, ...
///
/// # Errors
/// What the writer says; [`io::ErrorKind::InvalidInput`] for a parameter outside the domain.
pub fn write_surface_samples(
    out: &mut dyn Write,
    surface: &Surface,
    parameters: impl Iterator<Item = [f64; 2]>,
    order: usize,
    names: &[String],
) -> io::Result<()> {
    let (dimension, size) = (surface.dimension(), order + 1);
    let names = coordinate_names(dimension, names);
    let mut table = csv::Writer::from_writer(out);
    let derived = partials(order).skip(1).flat_map(|(a, b)| {
        let which = "u".repeat(a) + &"v".repeat(b);
        names.iter().map(move |name| format!("d{which} {name}"))
    });
    let head = ["u".to_owned(), "v".to_owned()].into_iter().chain(names.clone()).chain(derived);
    table.write_record(head).map_err(io_error)?;
    let mut values = vec![0.0; size * size * dimension];
    for [u, v] in parameters {
        surface
            .derivatives_into(u, v, order, &mut values)
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?;
        let known =
            partials(order).flat_map(|(a, b)| &values[(a * size + b) * dimension..][..dimension]);
        let row = [&u, &v].into_iter().chain(known).map(|x| format!("{x:?}"));
        table.write_record(row).map_err(io_error)?;
    }
    table.flush()
}

/// Writes foot points, a row each: parameters under `labels`, the coordinates, and `distance`.
///
/// # Errors
/// What the writer says.
pub fn write_feet<R: Iterator<Item = f64>>(
    out: &mut dyn Write,
    labels: &[&str],
    names: &[String],
    rows: impl Iterator<Item = R>,
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let head = labels.iter().copied().chain(names.iter().map(String::as_str)).chain(["distance"]);
    table.write_record(head).map_err(io_error)?;
    for row in rows {
        table.write_record(row.map(|x| format!("{x:?}"))).map_err(io_error)?;
    }
    table.flush()
}

/// What the writer said, without the wrapping that would hide which kind of error it is.
fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// Writes points, a row each, after two labels of their own.
///
/// # Errors
/// What the writer says.
pub fn write_rows<'a>(
    out: &mut dyn Write,
    label_names: [&str; 2],
    names: &[String],
    labels: impl Iterator<Item = [String; 2]>,
    points: impl Iterator<Item = &'a [f64]>,
) -> io::Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let head = label_names.into_iter().chain(names.iter().map(String::as_str));
    table.write_record(head).map_err(io_error)?;
    for (label, point) in labels.zip(points) {
        let numbers = point.iter().map(|x| format!("{x:?}"));
        table.write_record(label.into_iter().chain(numbers)).map_err(io_error)?;
    }
    table.flush()
}

fn coordinate_names(dimension: usize, names: &[String]) -> Vec<String> {
    if names.len() == dimension {
        return names.to_vec();
    }
    (1..=dimension).map(|i| format!("x{i}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Gone;

    impl Write for Gone {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::ErrorKind::BrokenPipe.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn an_error_of_the_writer_keeps_its_kind() {
        let points = gimfit::Points::new(1, (0..5000).map(f64::from).collect()).unwrap();
        let mut knots = vec![0.0];
        knots.extend((0..5000).map(f64::from));
        knots.push(4999.0);
        let curve = Curve::new(gimfit::KnotVector::open(1, knots).unwrap(), points).unwrap();
        let error = write_control_points(&mut Gone, &curve, &[]).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
        let samples = write_samples(&mut Gone, &curve, &curve.equal_steps(5000), 0, &[]);
        assert_eq!(samples.unwrap_err().kind(), io::ErrorKind::BrokenPipe);
    }
}
