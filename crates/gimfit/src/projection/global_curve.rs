//! The nearest point of a whole curve: the global minimum of the distance.

use super::bernstein::{evaluate_in_place, halve, is_convex, least_of_convex, product_factors};
use super::boxes::{BoxTree, SLACK};
use super::pieces::{bezier_points, lift, project};
use super::query::{Queries, distance_between};
use super::{FootPoint, local_foot_point};
use crate::Error;
use crate::geometry::Curve;
use crate::points::PointsView;

/// A curve prepared for nearest points: its Bezier pieces in a tree of boxes.
///
/// For a point Q at distance d from the nearest point found so far, a piece can come nearer only
/// where `|w (C - Q)|^2 - d^2 w^2` is negative. In Bernstein form, of degree 2p, this polynomial
/// lies above its least coefficient, so most pieces are ruled out at once; the others are minimised
/// where it is convex, and halved where it is not.
#[derive(Debug, Clone)]
pub struct CurveProjector {
    curve: Curve,
    /// The curve as the search sees it, where that is scaled.
    scaled: Option<Curve>,
    queries: Queries,
    /// Span of knots of each piece.
    spans: Vec<usize>,
    /// Bezier points, `degree + 1` to a piece.
    points: Vec<f64>,
    /// Their weights; empty for a polynomial curve.
    weights: Vec<f64>,
    tree: BoxTree,
    factors: Vec<f64>,
}

/// Scratch of one query after another.
#[derive(Debug, Default)]
struct Work {
    point: Vec<f64>,
    stack: Vec<(u32, f64)>,
    /// Parts of a piece yet to be looked at: points minus the query, times their weights, with the
    /// weights behind.
    parts: Vec<f64>,
    /// Their ends, in [0, 1].
    ends: Vec<[f64; 2]>,
    part: Vec<f64>,
    squares: Vec<f64>,
    weights: Vec<f64>,
    h: Vec<f64>,
}

/// The nearest point so far.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    square: f64,
    piece: usize,
    /// Where in the piece.
    s: f64,
    /// Whether it is a minimum already, or merely a place that was met.
    settled: bool,
}

/// Parts that one query may look at, beyond one for each piece of the curve: a bound that only
/// curves meet that stay at one distance from the query but for tiny wiggles.
const MOST_PARTS: usize = 100_000;

impl CurveProjector {
    /// Prepares a curve; costs about as much as evaluating it at each knot `degree` times.
    ///
    /// # Examples
    /// ```
    /// use gimfit::projection::CurveProjector;
    /// use gimfit::{Curve, KnotVector, Points};
    /// let knots = KnotVector::open(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0])?;
    /// let control = Points::from(&[[-1.0, 1.0], [0.0, -1.0], [1.0, 1.0]][..]);
    /// let parabola = CurveProjector::new(&Curve::new(knots, control)?);
    /// let foot = parabola.project(&[0.0, -2.0])?;
    /// assert_eq!((foot.parameter, foot.distance), (0.5, 2.0));
    /// # Ok::<(), gimfit::Error>(())
    /// ```
    #[must_use]
    pub fn new(curve: &Curve) -> Self {
        let (dimension, degree) = (curve.dimension(), curve.degree());
        let queries = Queries::new(curve.control_points(), curve.rational_weights().is_some());
        let coordinates = queries.scale.apply(curve.control_points().coordinates());
        let lifted = lift(&coordinates, dimension, curve.rational_weights());
        let width = queries.width();
        let spans: Vec<usize> = curve.knots().nonempty_spans().collect();
        let bezier: Vec<f64> = spans
            .iter()
            .flat_map(|&span| bezier_points(curve.knots(), span, &lifted, width))
            .collect();
        let (points, weights) = project(&bezier, dimension, queries.rational);
        let tree = BoxTree::new(&points, degree + 1, dimension);
        let factors = product_factors(degree);
        let scaled = queries
            .scaled(curve.control_points())
            .and_then(|points| curve.with_control_points(points).ok());
        Self { curve: curve.clone(), scaled, queries, spans, points, weights, tree, factors }
    }

    /// The curve.
    #[must_use]
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The nearest point of the curve. Where several are equally near, up to 1e-12 of the distance
    /// and rounding, it is one of them, always the same one; the seam of a closed curve counts as
    /// its start.
    ///
    /// # Errors
    /// [`Error::WrongCount`] for a point of another dimension; [`Error::NotFinite`].
    pub fn project(&self, point: &[f64]) -> Result<FootPoint, Error> {
        self.queries.check(PointsView::new(point.len().max(1), point)?)?;
        self.foot(point, &mut Work::default())
    }

    /// The nearest point of the curve for each of many points, by all processors; the same as
    /// [`CurveProjector::project`] yields one by one.
    ///
    /// # Errors
    /// As [`CurveProjector::project`].
    pub fn project_all<'a>(
        &self,
        points: impl Into<PointsView<'a>>,
    ) -> Result<Vec<FootPoint>, Error> {
        let points = points.into();
        self.queries.check(points)?;
        self.queries.each(points, |point, work: &mut Work| self.foot(point, work))
    }

    fn foot(&self, point: &[f64], work: &mut Work) -> Result<FootPoint, Error> {
        let nearest = self.search(point, work);
        let span = self.spans[nearest.piece];
        let knots = self.curve.knots().values();
        let (a, b) = (knots[span], knots[span + 1]);
        let (start, end) = self.curve.domain();
        let mut t = if nearest.s >= 1.0 { b } else { (a + nearest.s * (b - a)).clamp(a, b) };
        if !nearest.settled {
            let curve = self.scaled.as_ref().unwrap_or(&self.curve);
            t = local_foot_point(curve, &work.point, t)?.parameter;
        }
        if t == end && self.curve.is_periodic() {
            t = start;
        }
        let foot = self.curve.evaluate(t)?;
        let distance = distance_between(&foot, point);
        Ok(FootPoint { parameter: t, point: foot, distance })
    }

    fn search(&self, point: &[f64], work: &mut Work) -> Nearest {
        let mut query = std::mem::take(&mut work.point);
        let mut stack = std::mem::take(&mut work.stack);
        let floor = self.queries.place(point, &mut query);
        let mut nearest = Nearest { square: f64::INFINITY, piece: 0, s: 0.0, settled: false };
        let mut left = MOST_PARTS;
        self.tree.search(&query, &mut stack, |piece| {
            self.search_piece(piece, &query, floor, &mut nearest, &mut left, work);
            nearest.square
        });
        (work.point, work.stack) = (query, stack);
        nearest
    }

    /// Looks for a nearer point in a piece; `left` parts may be looked at yet.
    fn search_piece(
        &self,
        piece: usize,
        query: &[f64],
        floor: f64,
        nearest: &mut Nearest,
        left: &mut usize,
        work: &mut Work,
    ) {
        let count = self.curve.degree() + 1;
        let (dimension, width) = (query.len(), self.queries.width());
        let size = count * width;
        let Work { parts, ends, part, squares, weights, h, .. } = work;
        parts.clear();
        ends.clear();
        ends.push([0.0, 1.0]);
        let points = &self.points[piece * count * dimension..][..count * dimension];
        if self.queries.rational {
            let of_points = &self.weights[piece * count..][..count];
            for (point, &w) in points.chunks_exact(dimension).zip(of_points) {
                parts.extend(point.iter().zip(query).map(|(x, q)| w * (x - q)));
                parts.push(w);
            }
        } else {
            for point in points.chunks_exact(dimension) {
                parts.extend(point.iter().zip(query).map(|(x, q)| x - q));
            }
        }
        part.resize(size, 0.0);
        while let Some([a, b]) = ends.pop() {
            let start = parts.len() - size;
            let here = &parts[start..];
            self.squares(here, dimension, width, squares, weights);
            let last = squares.len() - 1;
            let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
            let mut meet = |square: f64, s: f64, settled: bool| {
                if square < nearest.square {
                    *nearest = Nearest { square, piece, s, settled };
                }
                nearest.square
            };
            meet(squares[0] / weight(0), a, a == 0.0);
            let mut best = meet(squares[last] / weight(last), b, b == 1.0);
            // A rational function is minimised by one such polynomial after another (Dinkelbach
            // 1967), a polynomial by one.
            let halved = loop {
                let slack = SLACK * best + floor;
                h.clear();
                h.extend(squares.iter().enumerate().map(|(k, n)| n - best * weight(k)));
                if h.iter().enumerate().all(|(k, h)| *h >= -slack * weight(k)) {
                    break false;
                }
                if !is_convex(h) {
                    break true;
                }
                let s = least_of_convex(h);
                part.copy_from_slice(here);
                evaluate_in_place(part, width, s);
                let mut square: f64 = part[..dimension].iter().map(|x| x * x).sum();
                if self.queries.rational {
                    square /= part[dimension] * part[dimension];
                }
                let before = best;
                best = meet(square, a + s * (b - a), true);
                if !self.queries.rational || best >= before - 1e-14 * before {
                    break false;
                }
            };
            let middle = 0.5 * (a + b);
            if halved && *left > 0 && middle > a && middle < b {
                *left -= 1;
                part.copy_from_slice(&parts[start..]);
                parts.resize(start + 2 * size, 0.0);
                let (right, rest) = parts[start..].split_at_mut(size);
                // The left half is looked at first.
                halve(part, width, right);
                rest.copy_from_slice(part);
                ends.extend([[middle, b], [a, middle]]);
            } else {
                parts.truncate(start);
            }
        }
    }

    /// Coefficients of `|w (C - Q)|^2`, and of `w^2` for a rational curve.
    fn squares(
        &self,
        part: &[f64],
        dimension: usize,
        width: usize,
        squares: &mut Vec<f64>,
        weights: &mut Vec<f64>,
    ) {
        let count = part.len() / width;
        squares.clear();
        squares.resize(2 * count - 1, 0.0);
        weights.clear();
        if width > dimension {
            weights.resize(2 * count - 1, 0.0);
        }
        for i in 0..count {
            let first = &part[i * width..][..width];
            for j in i..count {
                let second = &part[j * width..][..width];
                let twice = if i == j { 1.0 } else { 2.0 };
                let factor = twice * self.factors[i * count + j];
                let product: f64 = first[..dimension].iter().zip(second).map(|(x, y)| x * y).sum();
                squares[i + j] += factor * product;
                if width > dimension {
                    weights[i + j] += factor * first[dimension] * second[dimension];
                }
            }
        }
    }
}
