//! A triangular Bernstein-Bezier patch in any dimension.

use super::check_buffer;
use crate::Error;
use crate::points::Points;

/// Largest degree: 1,891 control points.
pub const MAX_TRIANGLE_DEGREE: usize = 60;

/// How far outside the triangle rounding may put a point of its edge.
const ON_THE_EDGE: f64 = 1e-12;

/// `S(u, v, w) = sum n! / (i! j! k!) u^i v^j w^k P_ijk` over `i + j + k = n`, where `u + v + w = 1`.
///
/// Control points stand in rows of the triangle: row `r = 0 ..= n` holds `r + 1` points, that in
/// column `c` with the indices `(i, j, k) = (n - r, r - c, c)`. So the first is the corner u = 1, the
/// last row runs from the corner v = 1 to the corner w = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct TriangularPatch {
    degree: usize,
    control_points: Points,
}

impl TriangularPatch {
    /// Takes control points in rows of the triangle, shape ((n + 1) (n + 2) / 2, dimension).
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a degree outside 1 to [`MAX_TRIANGLE_DEGREE`];
    /// [`Error::WrongCount`]; [`Error::NotFinite`].
    pub fn new(degree: usize, control_points: Points) -> Result<Self, Error> {
        check_triangle_degree(degree)?;
        let expected = triangle_points(degree);
        if control_points.len() != expected {
            return Err(Error::WrongCount {
                what: "control points",
                given: control_points.len(),
                expected,
                why: "(degree + 1) (degree + 2) / 2",
            });
        }
        let (dimension, values) = (control_points.dimension(), control_points.coordinates());
        if let Some(position) = values.iter().position(|x| !x.is_finite()) {
            return Err(Error::NotFinite {
                point: position / dimension,
                coordinate: position % dimension,
                value: values[position],
            });
        }
        Ok(Self { degree, control_points })
    }

    /// The degree n.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.control_points.dimension()
    }

    /// The control points in rows of the triangle.
    #[must_use]
    pub fn control_points(&self) -> &Points {
        &self.control_points
    }

    /// The point at barycentric (u, v, 1 - u - v), by the algorithm of de Casteljau.
    ///
    /// # Errors
    /// [`Error::OutsideTriangle`].
    pub fn evaluate(&self, u: f64, v: f64) -> Result<Vec<f64>, Error> {
        let mut jet = vec![0.0; 3 * self.dimension()];
        self.derivatives_into(u, v, &mut jet)?;
        jet.truncate(self.dimension());
        Ok(jet)
    }

    /// Point and first derivatives by u and by v, where w = 1 - u - v, one after another (length:
    /// 3 * dimension).
    ///
    /// # Errors
    /// [`Error::OutsideTriangle`]; [`Error::WrongCount`] for a buffer of another length.
    pub fn derivatives_into(&self, u: f64, v: f64, jet: &mut [f64]) -> Result<(), Error> {
        let dimension = self.dimension();
        check_buffer(jet, 3 * dimension)?;
        let w = 1.0 - u - v;
        if !(u >= -ON_THE_EDGE && v >= -ON_THE_EDGE && w >= -ON_THE_EDGE) {
            return Err(Error::OutsideTriangle { u, v });
        }
        let (u, v, w) = (u.max(0.0), v.max(0.0), w.max(0.0));
        let mut points = self.control_points.coordinates().to_vec();
        for level in (1..self.degree).rev() {
            descend(&mut points, level, dimension, [u, v, w]);
        }
        // Three points are left: of a plane, which is the tangent plane.
        let n = self.degree as f64;
        for x in 0..dimension {
            let [a, b, c] = [0, 1, 2].map(|corner| points[corner * dimension + x]);
            jet[x] = u * a + v * b + w * c;
            jet[dimension + x] = n * (a - c);
            jet[2 * dimension + x] = n * (b - c);
        }
        Ok(())
    }

    /// The unit normal of a patch in space, pointing where the corners u, v, w turn to the left;
    /// `None` in other dimensions and where the patch has no tangent plane.
    ///
    /// # Errors
    /// [`Error::OutsideTriangle`].
    pub fn normal(&self, u: f64, v: f64) -> Result<Option<[f64; 3]>, Error> {
        if self.dimension() != 3 {
            return Ok(None);
        }
        let mut jet = [0.0; 9];
        self.derivatives_into(u, v, &mut jet)?;
        let [_, _, _, a, b, c, x, y, z] = jet;
        let normal = [b * z - c * y, c * x - a * z, a * y - b * x];
        let length = normal.iter().fold(0.0, |sum: f64, x| sum.hypot(*x));
        Ok((length > 0.0 && length.is_finite()).then(|| normal.map(|x| x / length)))
    }
}

/// Points of a triangle of degree n: (n + 1) (n + 2) / 2.
#[must_use]
pub fn triangle_points(degree: usize) -> usize {
    (degree + 1) * (degree + 2) / 2
}

/// The indices (i, j, k) of all points of a triangle of degree n, in rows.
pub fn triangle_indices(degree: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=degree)
        .flat_map(move |row| (0..=row).map(move |column| [degree - row, row - column, column]))
}

/// Refuses degrees that triangular patches do not have.
pub(crate) fn check_triangle_degree(degree: usize) -> Result<(), Error> {
    if (1..=MAX_TRIANGLE_DEGREE).contains(&degree) {
        return Ok(());
    }
    Err(Error::OutOfRange {
        what: "degree of the triangular patch".into(),
        value: degree as f64,
        rule: "it must lie between 1 and 60",
    })
}

/// A step of de Casteljau down to a degree, in place: each point becomes the mean of a small
/// triangle, itself and the two below it.
fn descend(points: &mut [f64], degree: usize, dimension: usize, [u, v, w]: [f64; 3]) {
    let mut place = 0;
    for row in 0..=degree {
        for _ in 0..=row {
            // Row r holds r + 1 points, so the point below stands r + 1 places on.
            let (left, right) = (place + row + 1, place + row + 2);
            for x in 0..dimension {
                points[place * dimension + x] = u * points[place * dimension + x]
                    + v * points[left * dimension + x]
                    + w * points[right * dimension + x];
            }
            place += 1;
        }
    }
}
