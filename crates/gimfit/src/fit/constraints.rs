//! What a least squares curve shall meet exactly, as rows on its control points.

use crate::Error;
use crate::basis::basis_derivatives;
use crate::collocation::ConstraintRow;
use crate::knots::{Boundary, KnotVector};

/// Linear demands that a least squares curve meets exactly, while it is as near all other data as
/// these allow. Points are named by their position among the data, from 0, and are met at their
/// parameters.
///
/// # Examples
/// ```
/// use gimfit::{Constraints, LeastSquaresOptions, fit_least_squares};
/// let points: Vec<[f64; 2]> = (0..100)
///     .map(|i| {
///         let x = f64::from(i) / 10.0;
///         [x, x.sin() + 0.05 * f64::from(i % 3)]
///     })
///     .collect();
/// let options = LeastSquaresOptions {
///     constraints: Constraints::new().through(40).tangent(0, &[1.0, 0.0]),
///     ..LeastSquaresOptions::with_control_points(12)
/// };
/// let fit = fit_least_squares(&points, &options)?;
/// let there = fit.curve.evaluate(fit.parameters[40])?;
/// assert!((there[1] - points[40][1]).abs() < 1e-13);
/// # Ok::<(), gimfit::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Constraints {
    list: Vec<Constraint>,
}

#[derive(Debug, Clone, PartialEq)]
enum Constraint {
    Through { point: usize },
    Derivative { point: usize, order: usize, vector: Vec<f64> },
    Tangent { point: usize, direction: Vec<f64> },
    Normal { point: usize, normal: Vec<f64> },
    Pinned { control_point: usize, place: Vec<f64> },
    StraightEnd { end: CurveEnd, control_points: usize, direction: Vec<f64> },
    PlanarEnd { end: CurveEnd, control_points: usize, normal: Vec<f64> },
    Mirrored { coordinate: usize, value: f64 },
}

/// An end of an open curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveEnd {
    /// Where it starts.
    First,
    /// Where it ends.
    Last,
}

impl CurveEnd {
    fn as_str(self) -> &'static str {
        match self {
            Self::First => "first",
            Self::Last => "last",
        }
    }
}

impl Constraints {
    /// None.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    fn with(mut self, constraint: Constraint) -> Self {
        self.list.push(constraint);
        self
    }

    /// The curve passes through this data point, at its parameter.
    #[must_use]
    pub fn through(self, point: usize) -> Self {
        self.with(Constraint::Through { point })
    }

    /// The derivative of an order, from 1 to the degree, by the parameter, at the parameter of a data
    /// point, is this vector.
    #[must_use]
    pub fn derivative(self, point: usize, order: usize, vector: &[f64]) -> Self {
        self.with(Constraint::Derivative { point, order, vector: vector.to_vec() })
    }

    /// The tangent at a data point has this direction or its opposite, whatever its length:
    /// `(I - tau tau^T) C'(t) = 0`.
    #[must_use]
    pub fn tangent(self, point: usize, direction: &[f64]) -> Self {
        self.with(Constraint::Tangent { point, direction: direction.to_vec() })
    }

    /// The tangent at a data point is perpendicular to this vector: `n . C'(t) = 0`.
    #[must_use]
    pub fn normal(self, point: usize, normal: &[f64]) -> Self {
        self.with(Constraint::Normal { point, normal: normal.to_vec() })
    }

    /// A control point, counted from 0 among those that move, stands at this place.
    #[must_use]
    pub fn pinned(self, control_point: usize, place: &[f64]) -> Self {
        self.with(Constraint::Pinned { control_point, place: place.to_vec() })
    }

    /// So many control points of an end stand on a line of this direction, wherever it lies: with more
    /// than the degree of them the curve starts, or ends, with a straight piece. Open curves only.
    #[must_use]
    pub fn straight_end(self, end: CurveEnd, control_points: usize, direction: &[f64]) -> Self {
        let direction = direction.to_vec();
        self.with(Constraint::StraightEnd { end, control_points, direction })
    }

    /// So many control points of an end stand on a plane perpendicular to this vector, wherever it
    /// lies. Open curves only.
    #[must_use]
    pub fn planar_end(self, end: CurveEnd, control_points: usize, normal: &[f64]) -> Self {
        let normal = normal.to_vec();
        self.with(Constraint::PlanarEnd { end, control_points, normal })
    }

    /// The control points are those of the curve run backwards and mirrored where a coordinate has this
    /// value: in the plane at a line, in space at a plane. Open curves over symmetric knots only.
    #[must_use]
    pub fn mirrored(self, coordinate: usize, value: f64) -> Self {
        self.with(Constraint::Mirrored { coordinate, value })
    }

    /// The constraint at a position, in words.
    pub(super) fn name(&self, owner: usize) -> String {
        match &self.list[owner] {
            Constraint::Through { point } => format!("through point {point}"),
            Constraint::Derivative { point, order, .. } => {
                format!("derivative {order} at point {point}")
            }
            Constraint::Tangent { point, .. } => format!("tangent at point {point}"),
            Constraint::Normal { point, .. } => format!("normal at point {point}"),
            Constraint::Pinned { control_point, .. } => format!("control point {control_point}"),
            Constraint::StraightEnd { end, control_points, .. } => {
                format!("straight {} {control_points} control points", end.as_str())
            }
            Constraint::PlanarEnd { end, control_points, .. } => {
                format!("planar {} {control_points} control points", end.as_str())
            }
            Constraint::Mirrored { coordinate, .. } => format!("mirrored coordinate {coordinate}"),
        }
    }

    /// The rows. `data` are scaled, and `up` scales what the constraints give.
    pub(super) fn rows(
        &self,
        data: &[f64],
        dimension: usize,
        parameters: &[f64],
        knots: &KnotVector,
        columns: usize,
        up: &dyn Fn(f64) -> f64,
    ) -> Result<Vec<ConstraintRow>, Error> {
        let mut rows = Vec::new();
        for (owner, constraint) in self.list.iter().enumerate() {
            let check = |what: &str, at: usize, count: usize, rule| {
                if at < count {
                    return Ok(());
                }
                let name = self.name(owner);
                let what = format!("{what} of the constraint {name} (points counted from 0)");
                Err(Error::OutOfRange { what, value: at as f64, rule })
            };
            let at = |point: usize, order: usize| {
                check("point", point, parameters.len(), "there is no such data point")?;
                Ok::<_, Error>(functions(knots, columns, parameters[point], order))
            };
            let mut push = |functions: &[(usize, f64)], weights: &[f64], value: f64| {
                let entries = functions.iter().flat_map(|&(i, b)| {
                    let each = weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
                    each.map(move |(c, w)| (i * dimension + c, b * w))
                });
                rows.push(ConstraintRow { entries: entries.collect(), value, owner });
            };
            let unit = |c: usize| -> Vec<f64> {
                (0..dimension).map(|k| f64::from(u8::from(k == c))).collect()
            };
            match constraint {
                Constraint::Through { point } => {
                    let functions = at(*point, 0)?;
                    for c in 0..dimension {
                        push(&functions, &unit(c), data[point * dimension + c]);
                    }
                }
                Constraint::Derivative { point, order, vector } => {
                    let vector = self.vector(owner, vector, dimension)?;
                    check("order", *order, knots.degree() + 1, "it must not exceed the degree")?;
                    if *order == 0 {
                        return Err(Error::OutOfRange {
                            what: "order of a derivative constraint".into(),
                            value: 0.0,
                            rule: "it must be 1 or more; to meet a point use `through`",
                        });
                    }
                    let functions = at(*point, *order)?;
                    (0..dimension).for_each(|c| push(&functions, &unit(c), up(vector[c])));
                }
                Constraint::Tangent { point, direction } => {
                    let tau = self.direction(owner, direction, dimension)?;
                    let functions = at(*point, 1)?;
                    // Of the rows of I - tau tau^T, that of the largest coordinate follows from the others.
                    let most = (0..dimension)
                        .fold(0, |most, c| if tau[c].abs() > tau[most].abs() { c } else { most });
                    for c in (0..dimension).filter(|&c| c != most) {
                        let mut across = vec![0.0; dimension];
                        across[c] = tau[most];
                        across[most] = -tau[c];
                        push(&functions, &across, 0.0);
                    }
                }
                Constraint::Normal { point, normal } => {
                    let normal = self.direction(owner, normal, dimension)?;
                    push(&at(*point, 1)?, &normal, 0.0);
                }
                Constraint::Pinned { control_point, place } => {
                    let place = self.vector(owner, place, dimension)?;
                    check("number", *control_point, columns, "there is no such control point")?;
                    let only = [(*control_point, 1.0)];
                    (0..dimension).for_each(|c| push(&only, &unit(c), up(place[c])));
                }
                Constraint::StraightEnd { end, control_points, direction } => {
                    let tau = self.direction(owner, direction, dimension)?;
                    check(
                        "number",
                        *control_points,
                        columns + 1,
                        "there are fewer control points",
                    )?;
                    open_only(knots)?;
                    for legs in legs(*end, *control_points, columns) {
                        across(&tau).iter().for_each(|across| push(&legs, across, 0.0));
                    }
                }
                Constraint::PlanarEnd { end, control_points, normal } => {
                    let normal = self.direction(owner, normal, dimension)?;
                    check(
                        "number",
                        *control_points,
                        columns + 1,
                        "there are fewer control points",
                    )?;
                    open_only(knots)?;
                    for leg in legs(*end, *control_points, columns) {
                        push(&leg, &normal, 0.0);
                    }
                }
                Constraint::Mirrored { coordinate, value } => {
                    check("coordinate", *coordinate, dimension, "there is no such coordinate")?;
                    let value = up(self.vector(owner, &[*value], 1)?[0]);
                    open_only(knots)?;
                    check_symmetric(knots)?;
                    for i in 0..columns.div_ceil(2) {
                        let other = columns - 1 - i;
                        for c in 0..dimension {
                            let sign = if c == *coordinate { 1.0 } else { -1.0 };
                            let sum = if c == *coordinate { 2.0 * value } else { 0.0 };
                            if i < other {
                                push(&[(i, 1.0), (other, sign)], &unit(c), sum);
                            } else if sign > 0.0 {
                                push(&[(i, 1.0)], &unit(c), value);
                            }
                        }
                    }
                }
            }
        }
        Ok(rows)
    }

    fn vector<'a>(
        &self,
        owner: usize,
        vector: &'a [f64],
        dimension: usize,
    ) -> Result<&'a [f64], Error> {
        if vector.len() != dimension {
            return Err(Error::WrongCount {
                what: "coordinates of a constraint",
                given: vector.len(),
                expected: dimension,
                why: "the dimension of the data",
            });
        }
        match vector.iter().find(|x| !x.is_finite()) {
            None => Ok(vector),
            Some(&value) => Err(Error::OutOfRange {
                what: format!("coordinate of the constraint {}", self.name(owner)),
                value,
                rule: "it must be finite",
            }),
        }
    }

    /// Of length 1.
    fn direction(&self, owner: usize, given: &[f64], dimension: usize) -> Result<Vec<f64>, Error> {
        let given = self.vector(owner, given, dimension)?;
        let largest = given.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if largest == 0.0 {
            return Err(Error::OutOfRange {
                what: format!("direction of the constraint {}", self.name(owner)),
                value: 0.0,
                rule: "a vector of length 0 has no direction",
            });
        }
        let scaled: Vec<f64> = given.iter().map(|x| x / largest).collect();
        let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
        Ok(scaled.iter().map(|x| x / length).collect())
    }
}

/// Vectors that span what is perpendicular to one of length 1. Of the rows of `I - tau tau^T`, that of
/// the largest coordinate follows from the others.
fn across(tau: &[f64]) -> Vec<Vec<f64>> {
    let larger = |most: usize, c: usize| if tau[c].abs() > tau[most].abs() { c } else { most };
    let most = (0..tau.len()).fold(0, larger);
    let others = (0..tau.len()).filter(|&c| c != most);
    others
        .map(|c| {
            let mut across = vec![0.0; tau.len()];
            across[c] = tau[most];
            across[most] = -tau[c];
            across
        })
        .collect()
}

/// The legs of the control polygon at an end, each as the later control point less the earlier one.
fn legs(end: CurveEnd, control_points: usize, columns: usize) -> Vec<[(usize, f64); 2]> {
    let first = match end {
        CurveEnd::First => 0,
        CurveEnd::Last => columns - control_points,
    };
    (first + 1..first + control_points).map(|i| [(i - 1, -1.0), (i, 1.0)]).collect()
}

fn open_only(knots: &KnotVector) -> Result<(), Error> {
    if knots.boundary() == Boundary::Open {
        return Ok(());
    }
    Err(Error::Incompatible {
        what: "a straight or planar end, or a mirrored curve,",
        with: "a closed curve",
        why: "it has no ends; leave the constraint or `closed` out",
    })
}

fn check_symmetric(knots: &KnotVector) -> Result<(), Error> {
    let (start, end) = knots.domain();
    let values = knots.values();
    let pairs = values.iter().zip(values.iter().rev());
    if pairs.fold(0.0, |most: f64, (a, b)| most.max((a - start - (end - b)).abs()))
        <= 1e-9 * (end - start)
    {
        return Ok(());
    }
    Err(Error::Incompatible {
        what: "a mirrored curve",
        with: "these knots",
        why: "they must be the same from both ends; give symmetric knots",
    })
}

/// The control points that a derivative at a parameter takes part of, rising, with weights.
fn functions(knots: &KnotVector, columns: usize, t: f64, order: usize) -> Vec<(usize, f64)> {
    let width = knots.degree() + 1;
    let (start, end) = knots.domain();
    let span = knots.span_from(knots.degree(), t.clamp(start, end));
    let mut values = vec![0.0; (order + 1) * width];
    basis_derivatives(knots.values(), knots.degree(), span, t, order, &mut values);
    let first = span - knots.degree();
    let weights = values[order * width..].iter().enumerate();
    let mut list: Vec<(usize, f64)> =
        weights.map(|(k, &weight)| ((first + k) % columns, weight)).collect();
    list.sort_by_key(|&(i, _)| i);
    list
}
