//! Points in rows and columns.

use super::{Points, PointsView};
use crate::Error;

/// A borrowed grid of m rows (direction u) of n points (direction v) each, stored row by row: point
/// (i, j) follows point (i, j - 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridView<'a> {
    shape: [usize; 2],
    points: PointsView<'a>,
}

impl<'a> GridView<'a> {
    /// Views a flat array of shape (rows, columns, dimension).
    ///
    /// # Errors
    /// [`Error::Shape`] unless the length fits.
    pub fn new(shape: [usize; 2], dimension: usize, coordinates: &'a [f64]) -> Result<Self, Error> {
        let points = PointsView::new(dimension, coordinates)?;
        if shape[0].checked_mul(shape[1]) != Some(points.len()) {
            return Err(Error::WrongCount {
                what: "points",
                given: points.len(),
                expected: shape[0].saturating_mul(shape[1]),
                why: "a grid holds rows * columns points",
            });
        }
        Ok(Self { shape, points })
    }

    /// Rows and columns: points in direction u and in direction v.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.points.dimension()
    }

    /// All points, row by row.
    #[must_use]
    pub fn points(&self) -> PointsView<'a> {
        self.points
    }

    /// Point (i, j), counted from 0.
    #[must_use]
    pub fn point(&self, i: usize, j: usize) -> &'a [f64] {
        self.points.point(i * self.shape[1] + j)
    }
}

/// An owned grid: the control net of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct PointGrid {
    shape: [usize; 2],
    points: Points,
}

impl PointGrid {
    /// Takes a flat array of shape (rows, columns, dimension).
    ///
    /// # Errors
    /// As [`GridView::new`].
    pub fn new(shape: [usize; 2], dimension: usize, coordinates: Vec<f64>) -> Result<Self, Error> {
        GridView::new(shape, dimension, &coordinates)?;
        Ok(Self { shape, points: Points::new(dimension, coordinates)? })
    }

    /// A borrowed view.
    #[must_use]
    pub fn as_view(&self) -> GridView<'_> {
        GridView { shape: self.shape, points: self.points.as_view() }
    }

    /// Rows and columns.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// All points, row by row.
    #[must_use]
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// All points, to be written into.
    pub(crate) fn coordinates_mut(&mut self) -> &mut [f64] {
        self.points.coordinates_mut()
    }

    /// Point (i, j), counted from 0.
    #[must_use]
    pub fn point(&self, i: usize, j: usize) -> &[f64] {
        self.points.point(i * self.shape[1] + j)
    }
}
