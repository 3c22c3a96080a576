//! The nearest point of a whole surface: the global minimum of the distance.

use super::bernstein::product_factors;
use super::boxes::{BoxTree, SLACK};
use super::patch::{JetWork, Layout, shape};
use super::pieces::{bezier_points, lift, project};
use super::query::{Queries, distance_between};
use super::{SurfaceFootPoint, local_surface_foot_point};
use crate::Error;
use crate::geometry::Surface;
use crate::points::{PointGrid, PointsView};

/// A surface prepared for nearest points: its Bezier patches in a tree of boxes.
///
/// The search is that of [`CurveProjector`](super::CurveProjector) with polynomials of degree 2p in
/// u and 2q in v; a patch that is not ruled out, and whose polynomial is not convex, is halved in
/// the direction in which that changes more.
#[derive(Debug, Clone)]
pub struct SurfaceProjector {
    surface: Surface,
    /// The surface as the search sees it, where that is scaled.
    scaled: Option<Surface>,
    queries: Queries,
    layout: Layout,
    /// Spans of knots in u and in v; patches follow each other row by row.
    spans: [Vec<usize>; 2],
    /// Bezier points, `(p + 1) (q + 1)` to a patch, row by row.
    points: Vec<f64>,
    /// Their weights; empty for a polynomial surface.
    weights: Vec<f64>,
    tree: BoxTree,
    factors: [Vec<f64>; 2],
}

/// Scratch of one query after another.
#[derive(Debug, Default)]
struct Work {
    point: Vec<f64>,
    stack: Vec<(u32, f64)>,
    parts: Vec<f64>,
    /// Ends in u and v of each part.
    ends: Vec<[f64; 4]>,
    part: Vec<f64>,
    squares: Vec<f64>,
    weights: Vec<f64>,
    h: Vec<f64>,
    jet: JetWork,
}

/// The nearest point so far.
#[derive(Debug, Clone, Copy)]
struct Nearest {
    square: f64,
    patch: usize,
    place: [f64; 2],
    /// Whether a walk ended there.
    settled: bool,
}

/// What one query may cost, in products of numbers, beyond one look at each patch near it; and the
/// parts that it may look at in any case. Only surfaces meet this bound that stay at one distance
/// from the query but for tiny wiggles.
const MOST_PRODUCTS: usize = 200_000_000;
const PARTS: std::ops::RangeInclusive<usize> = 500..=50_000;

impl SurfaceProjector {
    /// Prepares a surface.
    ///
    /// # Examples
    /// ```
    /// use gimfit::projection::SurfaceProjector;
    /// use gimfit::{KnotVector, PointGrid, Surface};
    /// let knots = || KnotVector::open(1, vec![0.0, 0.0, 1.0, 1.0]);
    /// let net = vec![0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 2.0, 0.0, 0.0, 2.0, 2.0, 0.0];
    /// let square = Surface::new([knots()?, knots()?], PointGrid::new([2, 2], 3, net)?)?;
    /// let foot = SurfaceProjector::new(&square).project(&[0.5, 3.0, 1.0])?;
    /// assert_eq!(foot.parameters, [0.25, 1.0]);
    /// assert_eq!(foot.distance, 2f64.sqrt());
    /// # Ok::<(), gimfit::Error>(())
    /// ```
    #[must_use]
    pub fn new(surface: &Surface) -> Self {
        let (dimension, [p, q]) = (surface.dimension(), surface.degrees());
        let net = surface.control_net();
        let queries = Queries::new(net.points(), surface.rational_weights().is_some());
        let coordinates = queries.scale.apply(net.points().coordinates());
        let lifted = lift(&coordinates, dimension, surface.rational_weights());
        let width = queries.width();
        let line = net.shape()[1] * width;
        let [knots_u, knots_v] = surface.knots();
        let spans = [knots_u, knots_v].map(|knots| knots.nonempty_spans().collect::<Vec<_>>());
        let mut bezier = Vec::new();
        for &span in &spans[0] {
            let rows = bezier_points(knots_u, span, &lifted, line);
            for &span in &spans[1] {
                for row in rows.chunks_exact(line) {
                    bezier.extend(bezier_points(knots_v, span, row, width));
                }
            }
        }
        let (points, weights) = project(&bezier, dimension, queries.rational);
        let tree = BoxTree::new(&points, (p + 1) * (q + 1), dimension);
        let layout = Layout { rows: p + 1, columns: q + 1, width, dimension };
        let scaled = queries.scaled(net.points()).and_then(|points| {
            let net = PointGrid::new(net.shape(), dimension, points.into_coordinates());
            surface.with_control_net(net.ok()?).ok()
        });
        Self {
            surface: surface.clone(),
            scaled,
            queries,
            layout,
            spans,
            points,
            weights,
            tree,
            factors: [product_factors(p), product_factors(q)],
        }
    }

    /// The surface.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The nearest point of the surface. Where several are equally near, up to 1e-12 of the distance
    /// and rounding, it is one of them, always the same one; the seam of a closed direction counts
    /// as its start.
    ///
    /// # Errors
    /// [`Error::WrongCount`] for a point of another dimension; [`Error::NotFinite`].
    pub fn project(&self, point: &[f64]) -> Result<SurfaceFootPoint, Error> {
        self.queries.check(PointsView::new(point.len().max(1), point)?)?;
        self.foot(point, &mut Work::default())
    }

    /// The nearest point of the surface for each of many points, by all processors; the same as
    /// [`SurfaceProjector::project`] yields one by one.
    ///
    /// # Errors
    /// As [`SurfaceProjector::project`].
    pub fn project_all<'a>(
        &self,
        points: impl Into<PointsView<'a>>,
    ) -> Result<Vec<SurfaceFootPoint>, Error> {
        let points = points.into();
        self.queries.check(points)?;
        self.queries.each(points, |point, work: &mut Work| self.foot(point, work))
    }

    fn foot(&self, point: &[f64], work: &mut Work) -> Result<SurfaceFootPoint, Error> {
        let nearest = self.search(point, work);
        let columns = self.spans[1].len();
        let cell = [nearest.patch / columns, nearest.patch % columns];
        let (domain, periodic) = (self.surface.domain(), self.surface.is_periodic());
        let mut parameters = [0, 1].map(|k| {
            let knots = self.surface.knots()[k].values();
            let span = self.spans[k][cell[k]];
            let (a, b, s) = (knots[span], knots[span + 1], nearest.place[k]);
            if s >= 1.0 { b } else { (a + s * (b - a)).clamp(a, b) }
        });
        if !nearest.settled {
            let surface = self.scaled.as_ref().unwrap_or(&self.surface);
            parameters = local_surface_foot_point(surface, &work.point, parameters)?.parameters;
        }
        for k in 0..2 {
            if parameters[k] == domain[k].1 && periodic[k] {
                parameters[k] = domain[k].0;
            }
        }
        let foot = self.surface.evaluate(parameters[0], parameters[1])?;
        let distance = distance_between(&foot, point);
        Ok(SurfaceFootPoint { parameters, point: foot, distance })
    }

    fn search(&self, point: &[f64], work: &mut Work) -> Nearest {
        let mut query = std::mem::take(&mut work.point);
        let mut stack = std::mem::take(&mut work.stack);
        let floor = self.queries.place(point, &mut query);
        let mut nearest =
            Nearest { square: f64::INFINITY, patch: 0, place: [0.0; 2], settled: false };
        let coefficients = self.layout.rows * self.layout.columns;
        let products = coefficients * coefficients * self.layout.width;
        let mut left = (MOST_PRODUCTS / products).clamp(*PARTS.start(), *PARTS.end());
        self.tree.search(&query, &mut stack, |patch| {
            self.search_patch(patch, &query, floor, &mut nearest, &mut left, work);
            nearest.square
        });
        (work.point, work.stack) = (query, stack);
        nearest
    }

    /// Looks for a nearer point in a patch; `left` parts may be looked at yet.
    fn search_patch(
        &self,
        patch: usize,
        query: &[f64],
        floor: f64,
        nearest: &mut Nearest,
        left: &mut usize,
        work: &mut Work,
    ) {
        let layout = self.layout;
        let Work { parts, ends, part, squares, weights, h, jet, .. } = work;
        let (size, dimension) = (layout.size(), layout.dimension);
        let count = layout.rows * layout.columns;
        let grid = [2 * layout.rows - 1, 2 * layout.columns - 1];
        parts.clear();
        let points = &self.points[patch * count * dimension..][..count * dimension];
        for (k, point) in points.chunks_exact(dimension).enumerate() {
            let w = if self.queries.rational { self.weights[patch * count + k] } else { 1.0 };
            parts.extend(point.iter().zip(query).map(|(x, q)| w * (x - q)));
            if self.queries.rational {
                parts.push(w);
            }
        }
        ends.clear();
        ends.push([0.0, 1.0, 0.0, 1.0]);
        part.resize(size, 0.0);
        let mut whole = true;
        while let Some([a, b, c, d]) = ends.pop() {
            let start = parts.len() - size;
            let here = &parts[start..];
            let mut meet = |square: f64, [u, v]: [f64; 2], settled: bool| {
                if square < nearest.square {
                    let place = [a + u * (b - a), c + v * (d - c)];
                    *nearest = Nearest { square, patch, place, settled };
                }
                nearest.square
            };
            let corner = |i: usize, j: usize| {
                let at = (i * layout.columns + j) * layout.width;
                layout.square(&here[at..][..layout.width])
            };
            let (last_i, last_j) = (layout.rows - 1, layout.columns - 1);
            meet(corner(0, 0), [0.0, 0.0], false);
            meet(corner(0, last_j), [0.0, 1.0], false);
            meet(corner(last_i, 0), [1.0, 0.0], false);
            let mut best = meet(corner(last_i, last_j), [1.0, 1.0], false);
            let ruled_out = |best: f64| layout.least_square(here) >= best * (1.0 - SLACK) - floor;
            if ruled_out(best) {
                parts.truncate(start);
                continue;
            }
            self.squares(here, squares, weights);
            let weight = |k: usize| weights.get(k).copied().unwrap_or(1.0);
            // As for curves: one polynomial after another if the surface is rational.
            let halved = loop {
                let slack = SLACK * best + floor;
                h.clear();
                h.extend(squares.iter().enumerate().map(|(k, n)| n - best * weight(k)));
                if h.iter().enumerate().all(|(k, h)| *h >= -slack * weight(k)) {
                    break None;
                }
                let shape = shape(h, grid[0], grid[1]);
                if !shape.convex && !whole {
                    break Some(shape.steeper);
                }
                let least = (0..h.len()).fold(0, |l, k| if h[k] < h[l] { k } else { l });
                let from = [least / grid[1], least % grid[1]];
                let from = [0, 1].map(|k| from[k] as f64 / (grid[k] - 1) as f64);
                let shift = if self.queries.rational { best } else { 0.0 };
                let place = layout.walk(here, from, shift, jet);
                let before = best;
                best = meet(layout.square(&jet.jet[0]), place, true);
                if !shape.convex {
                    // The walk was to find a good bound early.
                    if best < before - 1e-14 * before {
                        whole = false;
                        continue;
                    }
                    break Some(shape.steeper);
                }
                if !self.queries.rational || best >= before - 1e-14 * before {
                    break None;
                }
            };
            whole = false;
            let cut = halved.filter(|_| *left > 0).and_then(|steeper| {
                let middles = [0.5 * (a + b), 0.5 * (c + d)];
                let room = [middles[0] > a && middles[0] < b, middles[1] > c && middles[1] < d];
                let direction = if room[steeper] { steeper } else { 1 - steeper };
                room[direction].then_some((direction, middles[direction]))
            });
            let Some((direction, middle)) = cut else {
                parts.truncate(start);
                continue;
            };
            *left -= 1;
            part.copy_from_slice(&parts[start..]);
            parts.resize(start + 2 * size, 0.0);
            let (second, first) = parts[start..].split_at_mut(size);
            layout.halve(part, direction, second);
            first.copy_from_slice(part);
            ends.extend(if direction == 0 {
                [[middle, b, c, d], [a, middle, c, d]]
            } else {
                [[a, b, middle, d], [a, b, c, middle]]
            });
        }
    }

    /// Coefficients of `|w (S - Q)|^2`, and of `w^2` for a rational surface.
    fn squares(&self, part: &[f64], squares: &mut Vec<f64>, weights: &mut Vec<f64>) {
        let Layout { rows, columns, width, dimension } = self.layout;
        let line = 2 * columns - 1;
        let size = (2 * rows - 1) * line;
        squares.clear();
        squares.resize(size, 0.0);
        weights.clear();
        weights.resize(if width > dimension { size } else { 0 }, 0.0);
        let [in_u, in_v] = &self.factors;
        let point = |i: usize, j: usize| &part[(i * columns + j) * width..][..width];
        for i in 0..rows {
            for k in i..rows {
                let of_u = if i == k { 1.0 } else { 2.0 } * in_u[i * rows + k];
                for j in 0..columns {
                    for l in 0..columns {
                        let factor = of_u * in_v[j * columns + l];
                        let (first, second) = (point(i, j), point(k, l));
                        let product: f64 =
                            first[..dimension].iter().zip(second).map(|(x, y)| x * y).sum();
                        let at = (i + k) * line + j + l;
                        squares[at] += factor * product;
                        if width > dimension {
                            weights[at] += factor * first[dimension] * second[dimension];
                        }
                    }
                }
            }
        }
    }
}
