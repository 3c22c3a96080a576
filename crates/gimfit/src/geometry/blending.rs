//! Curves and surfaces over any blending basis, and their way to Bezier form.

use super::{Curve, Surface, check_buffer};
use crate::Error;
use crate::basis::BlendingBasis;
use crate::knots::{KnotVector, MAX_DEGREE};
use crate::points::{PointGrid, Points};
use std::sync::Arc;

/// `C(t) = sum_i f_i(t) P_i` over a blending basis.
#[derive(Debug, Clone)]
pub struct BlendingCurve {
    basis: Arc<dyn BlendingBasis>,
    control_points: Points,
}

impl BlendingCurve {
    /// Joins a basis and control points, shape (functions, dimension).
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless there are as many points as functions; [`Error::NotFinite`].
    pub fn new(basis: Arc<dyn BlendingBasis>, control_points: Points) -> Result<Self, Error> {
        check_count("control points", control_points.len(), &*basis)?;
        check_finite(&control_points)?;
        Ok(Self { basis, control_points })
    }

    /// The basis.
    #[must_use]
    pub fn basis(&self) -> &Arc<dyn BlendingBasis> {
        &self.basis
    }

    /// The control points, shape (functions, dimension).
    #[must_use]
    pub fn control_points(&self) -> &Points {
        &self.control_points
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.control_points.dimension()
    }

    /// Where the curve is defined.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        self.basis.domain()
    }

    /// The point at `t`, written into `point` (length: dimension).
    ///
    /// # Errors
    /// [`Error::OutsideDomain`]; [`Error::WrongCount`] for a buffer of another length.
    pub fn evaluate_into(&self, t: f64, point: &mut [f64]) -> Result<(), Error> {
        check_buffer(point, self.dimension())?;
        let values = values_at(&*self.basis, t)?;
        point.fill(0.0);
        for (value, control) in values.iter().zip(self.control_points.iter()) {
            point.iter_mut().zip(control).for_each(|(x, p)| *x += value * p);
        }
        Ok(())
    }

    /// The point at `t`.
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, t: f64) -> Result<Vec<f64>, Error> {
        let mut point = vec![0.0; self.dimension()];
        self.evaluate_into(t, &mut point)?;
        Ok(point)
    }

    /// The same curve in Bezier form: a B-spline curve of one piece, rational if the basis is, which
    /// any evaluator knows.
    ///
    /// # Errors
    /// [`Error::Incompatible`] for a basis that is not known to be one of polynomials or their quotients;
    /// [`Error::OutOfRange`] for degrees above [`MAX_DEGREE`].
    pub fn to_bezier(&self) -> Result<Curve, Error> {
        self.bezier_with(&self.control_points)
    }

    /// As [`BlendingCurve::to_bezier`], with other control points.
    pub(crate) fn bezier_with(&self, control_points: &Points) -> Result<Curve, Error> {
        let basis = &*self.basis;
        let (knots, form) = (bezier_knots(basis)?, BezierForm::of(basis)?);
        let dimension = self.dimension();
        let Some(weights) = basis.rational_weights() else {
            let points = form.convert(control_points.coordinates(), dimension);
            return Curve::new(knots, Points::new(dimension, points)?);
        };
        let lifted = lift(control_points, weights.iter().copied());
        let (points, weights) = project(&form.convert(&lifted, dimension + 1), dimension);
        Curve::rational(knots, Points::new(dimension, points)?, weights)
    }
}

/// `S(u, v) = sum_ij f_i(u) g_j(v) P_ij` over a blending basis in each direction.
#[derive(Debug, Clone)]
pub struct BlendingSurface {
    bases: [Arc<dyn BlendingBasis>; 2],
    control_net: PointGrid,
}

impl BlendingSurface {
    /// Joins the bases of u (rows) and v (columns) and a control net, shape (functions of u,
    /// functions of v, dimension).
    ///
    /// # Errors
    /// [`Error::WrongCount`] unless the net has as many rows and columns as there are functions;
    /// [`Error::NotFinite`], where points are counted row by row.
    pub fn new(bases: [Arc<dyn BlendingBasis>; 2], control_net: PointGrid) -> Result<Self, Error> {
        check_count("rows of the control net", control_net.shape()[0], &*bases[0])?;
        check_count("columns of the control net", control_net.shape()[1], &*bases[1])?;
        check_finite(control_net.points())?;
        Ok(Self { bases, control_net })
    }

    /// The bases of u and v.
    #[must_use]
    pub fn bases(&self) -> &[Arc<dyn BlendingBasis>; 2] {
        &self.bases
    }

    /// The control net.
    #[must_use]
    pub fn control_net(&self) -> &PointGrid {
        &self.control_net
    }

    /// Coordinates per point.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.control_net.points().dimension()
    }

    /// Where the surface is defined: an interval for u and one for v.
    #[must_use]
    pub fn domain(&self) -> [(f64, f64); 2] {
        self.bases.each_ref().map(|basis| basis.domain())
    }

    /// The point at (u, v).
    ///
    /// # Errors
    /// [`Error::OutsideDomain`].
    pub fn evaluate(&self, u: f64, v: f64) -> Result<Vec<f64>, Error> {
        let (in_u, in_v) = (values_at(&*self.bases[0], u)?, values_at(&*self.bases[1], v)?);
        let mut point = vec![0.0; self.dimension()];
        for (i, f) in in_u.iter().enumerate() {
            for (j, g) in in_v.iter().enumerate() {
                let control = self.control_net.point(i, j);
                point.iter_mut().zip(control).for_each(|(x, p)| *x += f * g * p);
            }
        }
        Ok(point)
    }

    /// The same surface in Bezier form: a B-spline surface of one patch.
    ///
    /// # Errors
    /// As [`BlendingCurve::to_bezier`].
    pub fn to_bezier(&self) -> Result<Surface, Error> {
        self.bezier_with(self.control_net.points())
    }

    /// As [`BlendingSurface::to_bezier`], with other control points, row by row.
    pub(crate) fn bezier_with(&self, control_points: &Points) -> Result<Surface, Error> {
        let [u, v] = &self.bases;
        let knots = [bezier_knots(&**u)?, bezier_knots(&**v)?];
        let forms = [BezierForm::of(&**u)?, BezierForm::of(&**v)?];
        let (shape, dimension) = (self.control_net.shape(), self.dimension());
        let convert = |points: &[f64], dimension: usize| -> Vec<f64> {
            let line = v.functions() * dimension;
            let tall = forms[0].convert(points, line);
            tall.chunks_exact(line).flat_map(|row| forms[1].convert(row, dimension)).collect()
        };
        if u.rational_weights().is_none() && v.rational_weights().is_none() {
            let net = convert(control_points.coordinates(), dimension);
            return Surface::new(knots, PointGrid::new(shape, dimension, net)?);
        }
        let weight = |basis: &dyn BlendingBasis, i: usize| {
            basis.rational_weights().map_or(1.0, |weights| weights[i])
        };
        let weights = (0..shape[0])
            .flat_map(|i| (0..shape[1]).map(move |j| weight(&**u, i) * weight(&**v, j)));
        let lifted = lift(control_points, weights);
        let (net, weights) = project(&convert(&lifted, dimension + 1), dimension);
        Surface::rational(knots, PointGrid::new(shape, dimension, net)?, weights)
    }
}

/// How control points of a basis become Bezier points: `b_j = sum_i c_ij P_i` with the Bernstein
/// coefficients of the functions. They add up to 1 for each j, as the functions do.
struct BezierForm {
    count: usize,
    coefficients: Vec<f64>,
}

impl BezierForm {
    fn of(basis: &dyn BlendingBasis) -> Result<Self, Error> {
        let count = basis.functions();
        match basis.bernstein_coefficients() {
            Some(coefficients) if coefficients.len() == count * count => {
                Ok(Self { count, coefficients })
            }
            _ => Err(Error::Incompatible {
                what: "the Bezier form",
                with: "this basis",
                why: "its functions are not known to be polynomials",
            }),
        }
    }

    /// For points of shape (functions, `dimension`).
    fn convert(&self, points: &[f64], dimension: usize) -> Vec<f64> {
        let mut bezier = vec![0.0; points.len()];
        let rows = self.coefficients.chunks_exact(self.count);
        for (row, point) in rows.zip(points.chunks_exact(dimension)) {
            for (factor, target) in row.iter().zip(bezier.chunks_exact_mut(dimension)) {
                if *factor != 0.0 {
                    target.iter_mut().zip(point).for_each(|(x, p)| *x += factor * p);
                }
            }
        }
        bezier
    }
}

/// Points times their weights, each followed by its weight: in these coordinates a rational basis
/// blends as the basis that its weights blend.
fn lift(points: &Points, weights: impl Iterator<Item = f64>) -> Vec<f64> {
    let lifted = points.iter().zip(weights);
    lifted.flat_map(|(point, w)| point.iter().map(move |x| w * x).chain([w])).collect()
}

/// The points and weights that [`lift`] makes such an array of.
fn project(lifted: &[f64], dimension: usize) -> (Vec<f64>, Vec<f64>) {
    let rows = lifted.chunks_exact(dimension + 1);
    let points = rows.clone().flat_map(|row| row[..dimension].iter().map(|x| x / row[dimension]));
    (points.collect(), rows.map(|row| row[dimension]).collect())
}

/// One span over the domain of a basis.
fn bezier_knots(basis: &dyn BlendingBasis) -> Result<KnotVector, Error> {
    let count = basis.functions();
    if !(2..=MAX_DEGREE + 1).contains(&count) {
        return Err(Error::OutOfRange {
            what: "degree of the Bezier form".into(),
            value: count as f64 - 1.0,
            rule: "it must lie between 1 and 25",
        });
    }
    let (start, end) = basis.domain();
    let knots = [vec![start; count], vec![end; count]].concat();
    KnotVector::open(count - 1, knots)
}

fn values_at(basis: &dyn BlendingBasis, t: f64) -> Result<Vec<f64>, Error> {
    let (start, end) = basis.domain();
    if !(start <= t && t <= end) {
        return Err(Error::OutsideDomain { parameter: t, start, end });
    }
    let mut values = vec![0.0; basis.functions()];
    basis.evaluate_into(t, &mut values);
    Ok(values)
}

fn check_count(what: &'static str, given: usize, basis: &dyn BlendingBasis) -> Result<(), Error> {
    let expected = basis.functions();
    if given == expected {
        return Ok(());
    }
    Err(Error::WrongCount { what, given, expected, why: "one per function of the basis" })
}

fn check_finite(points: &Points) -> Result<(), Error> {
    let dimension = points.dimension();
    let values = points.coordinates();
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(position) => Err(Error::NotFinite {
            point: position / dimension,
            coordinate: position % dimension,
            value: values[position],
        }),
    }
}
