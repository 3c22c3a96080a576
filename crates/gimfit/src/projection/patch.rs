//! Tensor-product polynomials in Bernstein form on the unit square: jets, squares, halving, and the
//! minimum near a place.

use super::bernstein::halve;

/// Numbers of a patch: `rows` by `columns` coefficients of `width` numbers, row by row, of which
/// the first `dimension` are coordinates and the one behind, if any, is a weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Layout {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) width: usize,
    pub(super) dimension: usize,
}

/// Scratch for jets.
#[derive(Debug, Default)]
pub(super) struct JetWork {
    rows: Vec<f64>,
    line: Vec<f64>,
    /// Value and derivatives u, v, uu, uv, vv.
    pub(super) jet: [Vec<f64>; 6],
}

impl Layout {
    /// Numbers in all.
    pub(super) fn size(self) -> usize {
        self.rows * self.columns * self.width
    }

    /// Cuts a patch in two across u (`direction` 0) or v: it becomes the first half, `second`
    /// receives the other.
    pub(super) fn halve(self, patch: &mut [f64], direction: usize, second: &mut [f64]) {
        if direction == 0 {
            halve(patch, self.columns * self.width, second);
            return;
        }
        let line = self.columns * self.width;
        let rows = patch.chunks_exact_mut(line).zip(second.chunks_exact_mut(line));
        rows.for_each(|(row, second)| halve(row, self.width, second));
    }

    /// Value and partial derivatives up to order 2.
    pub(super) fn jet(self, patch: &[f64], [u, v]: [f64; 2], work: &mut JetWork) {
        let line = self.columns * self.width;
        let JetWork { rows, line: scratch, jet } = work;
        rows.resize(3 * line, 0.0);
        scratch.clear();
        scratch.extend_from_slice(patch);
        let (value, rest) = rows.split_at_mut(line);
        let (first, second) = rest.split_at_mut(line);
        line_jet(scratch, line, u, [value, first, second]);
        for part in jet.iter_mut() {
            part.resize(self.width, 0.0);
        }
        let [s, s_u, s_v, s_uu, s_uv, s_vv] = jet;
        let mut unused = [Vec::new(), Vec::new(), Vec::new()];
        for part in &mut unused {
            part.resize(self.width, 0.0);
        }
        let [a, b, c] = &mut unused;
        scratch.truncate(line);
        scratch.copy_from_slice(value);
        line_jet(scratch, self.width, v, [s, s_v, s_vv]);
        scratch.copy_from_slice(first);
        line_jet(scratch, self.width, v, [s_u, s_uv, a]);
        scratch.copy_from_slice(second);
        line_jet(scratch, self.width, v, [s_uu, b, c]);
    }

    /// Square of the length of a lifted point over the square of its weight.
    pub(super) fn square(self, point: &[f64]) -> f64 {
        let square: f64 = point[..self.dimension].iter().map(|x| x * x).sum();
        match point.get(self.dimension) {
            Some(w) if self.width > self.dimension => square / (w * w),
            _ => square,
        }
    }

    /// A square that no point of the patch undercuts: that of the box of its coefficients.
    pub(super) fn least_square(self, patch: &[f64]) -> f64 {
        let mut sum = 0.0;
        for k in 0..self.dimension {
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for point in patch.chunks_exact(self.width) {
                let x = if self.width > self.dimension {
                    point[k] / point[self.dimension]
                } else {
                    point[k]
                };
                least = x.min(least);
                most = x.max(most);
            }
            let gap = least.max(-most).max(0.0);
            sum += gap * gap;
        }
        sum
    }

    /// Walks from a place in the unit square to a minimum of `|x|^2 - best w^2` (`best` 0 without
    /// weights), where x are the coordinates and w the weight: projected Newton steps, halved until
    /// they lead down. Leaves the jet there in `work`.
    pub(super) fn walk(
        self,
        patch: &[f64],
        start: [f64; 2],
        best: f64,
        work: &mut JetWork,
    ) -> [f64; 2] {
        let product = |x: &[f64], y: &[f64]| {
            let pairs = x[..self.dimension].iter().zip(y);
            let sum: f64 = pairs.map(|(x, y)| x * y).sum();
            if self.width > self.dimension {
                sum - best * x[self.dimension] * y[self.dimension]
            } else {
                sum
            }
        };
        let mut place = start;
        self.jet(patch, place, work);
        for _ in 0..MOST_STEPS {
            let [s, s_u, s_v, s_uu, s_uv, s_vv] = &work.jet;
            let value = product(s, s);
            let gradient = [product(s, s_u), product(s, s_v)];
            let metric = [product(s_u, s_u), product(s_u, s_v), product(s_v, s_v)];
            let bend = [product(s, s_uu), product(s, s_uv), product(s, s_vv)];
            let mut step = descent(gradient, metric, bend, place);
            let before = place;
            for _ in 0..MOST_HALVINGS {
                let trial = [0, 1].map(|k| (before[k] + step[k]).clamp(0.0, 1.0));
                if trial == before {
                    break;
                }
                self.jet(patch, trial, work);
                if product(&work.jet[0], &work.jet[0]) < value {
                    place = trial;
                    break;
                }
                step = step.map(|x| 0.5 * x);
            }
            if place == before {
                break;
            }
        }
        self.jet(patch, place, work);
        place
    }
}

const MOST_STEPS: usize = 40;
const MOST_HALVINGS: usize = 12;

/// Newton's step, or Gauss-Newton's where that is none, or down the gradient; a parameter at an end
/// that would leave stays.
fn descent(gradient: [f64; 2], metric: [f64; 3], bend: [f64; 3], place: [f64; 2]) -> [f64; 2] {
    let free = [0, 1].map(|k| {
        !((place[k] <= 0.0 && gradient[k] >= 0.0) || (place[k] >= 1.0 && gradient[k] <= 0.0))
    });
    let newton = [0, 1, 2].map(|k| metric[k] + bend[k]);
    for [a, b, c] in [newton, metric] {
        let determinant = a * c - b * b;
        let step = match free {
            [true, true] if a > 0.0 && determinant > 1e-14 * a * c => [
                (b * gradient[1] - c * gradient[0]) / determinant,
                (b * gradient[0] - a * gradient[1]) / determinant,
            ],
            [true, false] if a > 0.0 => [-gradient[0] / a, 0.0],
            [false, true] if c > 0.0 => [0.0, -gradient[1] / c],
            [false, false] => return [0.0, 0.0],
            _ => continue,
        };
        if step.iter().all(|x| x.is_finite()) {
            return step;
        }
    }
    let size = metric[0].abs().max(metric[2].abs());
    let step = [0, 1].map(|k| if free[k] { -gradient[k] / size } else { 0.0 });
    if step.iter().all(|x| x.is_finite()) { step } else { [0.0, 0.0] }
}

/// Value, first and second derivative at t of coefficients of `width` numbers each, which are
/// destroyed.
fn line_jet(coefficients: &mut [f64], width: usize, t: f64, jet: [&mut [f64]; 3]) {
    let degree = coefficients.len() / width - 1;
    for r in 0..degree.saturating_sub(2) {
        for i in 0..(degree - r) * width {
            coefficients[i] += t * (coefficients[i + width] - coefficients[i]);
        }
    }
    let [value, first, second] = jet;
    let (n, s) = (degree as f64, 1.0 - t);
    for i in 0..width {
        let (a, b) = (coefficients[i], coefficients[i + width]);
        if degree == 1 {
            (value[i], first[i], second[i]) = (s * a + t * b, b - a, 0.0);
            continue;
        }
        let c = coefficients[i + 2 * width];
        value[i] = s * (s * a + t * b) + t * (s * b + t * c);
        first[i] = n * (s * (b - a) + t * (c - b));
        second[i] = n * (n - 1.0) * ((c - b) - (b - a));
    }
}

/// What the differences of tensor coefficients tell of a polynomial.
pub(super) struct Shape {
    /// Whether it is convex for certain.
    pub(super) convex: bool,
    /// The direction in which it changes more.
    pub(super) steeper: usize,
}

/// Looks at a polynomial with `rows` by `columns` coefficients. It is convex if its second
/// derivatives are, at their least, positive definite.
pub(super) fn shape(h: &[f64], rows: usize, columns: usize) -> Shape {
    let at = |i: usize, j: usize| h[i * columns + j];
    let (m, n) = ((rows - 1) as f64, (columns - 1) as f64);
    let (mut in_u, mut in_v) = (0.0_f64, 0.0_f64);
    let (mut uu, mut vv, mut uv) = (f64::INFINITY, f64::INFINITY, 0.0_f64);
    for i in 0..rows {
        for j in 0..columns {
            let here = at(i, j);
            if i + 1 < rows {
                in_u = in_u.max((at(i + 1, j) - here).abs());
                if j + 1 < columns {
                    uv = uv.max((at(i + 1, j + 1) - at(i + 1, j) - (at(i, j + 1) - here)).abs());
                }
            }
            if j + 1 < columns {
                in_v = in_v.max((at(i, j + 1) - here).abs());
            }
            if i + 2 < rows {
                uu = uu.min((at(i + 2, j) - at(i + 1, j)) - (at(i + 1, j) - here));
            }
            if j + 2 < columns {
                vv = vv.min((at(i, j + 2) - at(i, j + 1)) - (at(i, j + 1) - here));
            }
        }
    }
    let (uu, vv, uv) = (m * (m - 1.0) * uu, n * (n - 1.0) * vv, m * n * uv);
    Shape {
        convex: uu >= 0.0 && vv >= 0.0 && uu * vv >= uv * uv,
        steeper: usize::from(in_v > in_u),
    }
}
