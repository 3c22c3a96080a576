//! What we are given: ordered points of any dimension, and how large they are.

mod duplicates;
mod extent;
mod grid;
mod scale;

pub use duplicates::Duplicates;
pub(crate) use duplicates::{Cleaned, clean};
pub use extent::Extent;
pub use grid::{GridView, PointGrid};
pub(crate) use scale::PowerOfTwoScale;

use crate::Error;

/// Points of one dimension, stored row by row: point `j` is
/// `coordinates[j * dimension..][..dimension]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    dimension: usize,
    coordinates: Vec<f64>,
}

impl Points {
    /// Takes a flat array of shape (m, `dimension`).
    ///
    /// # Errors
    /// [`Error::Shape`] if the length is no multiple of the dimension.
    pub fn new(dimension: usize, coordinates: Vec<f64>) -> Result<Self, Error> {
        check_shape(dimension, coordinates.len())?;
        Ok(Self { dimension, coordinates })
    }

    /// The flat array, shape (m, dimension), row-major.
    #[must_use]
    pub fn coordinates(&self) -> &[f64] {
        &self.coordinates
    }

    /// The flat array, to be written into.
    pub(crate) fn coordinates_mut(&mut self) -> &mut [f64] {
        &mut self.coordinates
    }

    /// Gives the flat array back.
    #[must_use]
    pub fn into_coordinates(self) -> Vec<f64> {
        self.coordinates
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.as_view().len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// Point `index`, counted from 0.
    #[must_use]
    pub fn point(&self, index: usize) -> &[f64] {
        &self.coordinates[index * self.dimension..][..self.dimension]
    }

    /// The points one after another.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.coordinates.chunks_exact(self.dimension.max(1))
    }

    /// A borrowed view.
    #[must_use]
    pub fn as_view(&self) -> PointsView<'_> {
        PointsView { dimension: self.dimension, coordinates: &self.coordinates }
    }
}

impl<const D: usize> From<&[[f64; D]]> for Points {
    fn from(rows: &[[f64; D]]) -> Self {
        Self { dimension: D, coordinates: rows.as_flattened().to_vec() }
    }
}

/// Borrowed [`Points`]; what every fit takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointsView<'a> {
    dimension: usize,
    coordinates: &'a [f64],
}

impl<'a> PointsView<'a> {
    /// Views a flat array of shape (m, `dimension`).
    ///
    /// # Errors
    /// [`Error::Shape`] if the length is no multiple of the dimension.
    pub fn new(dimension: usize, coordinates: &'a [f64]) -> Result<Self, Error> {
        check_shape(dimension, coordinates.len())?;
        Ok(Self { dimension, coordinates })
    }

    /// The flat array, shape (m, dimension), row-major.
    #[must_use]
    pub fn coordinates(&self) -> &'a [f64] {
        self.coordinates
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.coordinates.len().checked_div(self.dimension).unwrap_or(0)
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.coordinates.is_empty()
    }

    /// Point `index`, counted from 0.
    #[must_use]
    pub fn point(&self, index: usize) -> &'a [f64] {
        &self.coordinates[index * self.dimension..][..self.dimension]
    }
}

impl<'a> From<&'a Points> for PointsView<'a> {
    fn from(points: &'a Points) -> Self {
        points.as_view()
    }
}

impl<'a, const D: usize> From<&'a [[f64; D]]> for PointsView<'a> {
    fn from(rows: &'a [[f64; D]]) -> Self {
        Self { dimension: D, coordinates: rows.as_flattened() }
    }
}

impl<'a, const D: usize, const M: usize> From<&'a [[f64; D]; M]> for PointsView<'a> {
    fn from(rows: &'a [[f64; D]; M]) -> Self {
        Self { dimension: D, coordinates: rows.as_flattened() }
    }
}

impl<'a, const D: usize> From<&'a Vec<[f64; D]>> for PointsView<'a> {
    fn from(rows: &'a Vec<[f64; D]>) -> Self {
        Self { dimension: D, coordinates: rows.as_flattened() }
    }
}

fn check_shape(dimension: usize, length: usize) -> Result<(), Error> {
    if dimension == 0 || !length.is_multiple_of(dimension) {
        return Err(Error::Shape { length, dimension });
    }
    Ok(())
}
